//! XCF, plain and packed: any bytes are read or refused, and what is read can be written back and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::io::Cursor;

fuzz_target!(|data: &[u8]| {
    let Ok(found) = pathwarp_gimp::salvage(Cursor::new(data)) else { return };
    assert!(found.file.paths.iter().flat_map(|p| &p.strokes).all(|s| s.points.as_flattened().iter().all(|v| v.is_finite())));
    if found.damage.is_some() || !matches!(found.file.kind, pathwarp_gimp::Kind::Xcf(_)) {
        return;
    }
    // One anchor more in the first stroke, so that everything behind it moves.
    let mut paths = found.file.paths;
    // GIMP 1's whole numbers may be larger than single precision tells apart.
    let single = |p: &mut [f64; 2]| *p = p.map(|v| f64::from(v as f32));
    paths.iter_mut().flat_map(|p| &mut p.strokes).flat_map(|s| &mut s.points).for_each(single);
    let Some(stroke) = paths.first_mut().and_then(|p| p.strokes.first_mut()) else { return };
    stroke.points.extend([[1.5, -2.5]; 3]);
    let mut out = Vec::new();
    let strokes = vec![(0, paths[0].strokes.clone())];
    if pathwarp_gimp::rewrite(Cursor::new(data), &mut out, &strokes).is_ok() {
        let mut again = pathwarp_gimp::read(&out).expect("what was written is sound");
        again.iter_mut().flat_map(|p| &mut p.strokes).flat_map(|s| &mut s.points).for_each(single);
        assert_eq!(again, paths);
    }
});
