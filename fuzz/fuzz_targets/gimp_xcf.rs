//! XCF, plain and compressed: any bytes are read or rejected, and paths that were read can be rewritten and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::io::Cursor;

fuzz_target!(|data: &[u8]| {
    let Ok(salvaged) = pathwarp_gimp::salvage(Cursor::new(data)) else { return };
    assert!(
        salvaged.file.paths.iter().flat_map(|p| &p.strokes).all(|s| s
            .points
            .as_flattened()
            .iter()
            .all(|v| v.is_finite()))
    );
    if salvaged.damage.is_some() || !matches!(salvaged.file.kind, pathwarp_gimp::FileKind::Xcf(_)) {
        return;
    }
    // Add an anchor to the first stroke, so that everything after it moves.
    let mut paths = salvaged.file.paths;
    // The integers of GIMP 1 may exceed single precision.
    let single = |p: &mut [f64; 2]| *p = p.map(|v| f64::from(v as f32));
    paths.iter_mut().flat_map(|p| &mut p.strokes).flat_map(|s| &mut s.points).for_each(single);
    let Some(stroke) = paths.first_mut().and_then(|p| p.strokes.first_mut()) else { return };
    stroke.points.extend([[1.5, -2.5]; 3]);
    let mut out = Vec::new();
    let strokes = vec![(0, paths[0].strokes.clone())];
    if pathwarp_gimp::rewrite(Cursor::new(data), &mut out, &strokes).is_ok() {
        let mut again = pathwarp_gimp::read(&out).expect("a written file is valid");
        again.iter_mut().flat_map(|p| &mut p.strokes).flat_map(|s| &mut s.points).for_each(single);
        assert_eq!(again, paths);
    }
});
