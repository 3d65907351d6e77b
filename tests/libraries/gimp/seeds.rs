//! Seeds for the fuzz targets, all of them valid files.
//!
//! `PATHWARP_FUZZ_SEEDS=fuzz/seeds cargo test --test libraries seeds` writes them.

use crate::support::xcf::{forms, paths_for, rich_paths, xcf};
use pathwarp_gimp::{read, to_json, to_svg};

fn seeds() -> Vec<(&'static str, String, Vec<u8>)> {
    let mut out = Vec::new();
    for (version, form) in forms().into_iter().step_by(3) {
        out.push(("gimp_xcf", format!("v{version}-{form:?}"), xcf(version, form, &paths_for(form))));
    }
    let some = rich_paths();
    for n in 0..=some.len() {
        let svg = to_svg([640.0, 400.0], &some[..n], Some(2));
        out.push(("gimp_svg", n.to_string(), svg.into_bytes()));
        out.push(("gimp_json", n.to_string(), to_json(Some([640.0, 400.0]), &some[..n]).into_bytes()));
    }
    let text = "Name: two\n#POINTS: 11\nCLOSED: 0\nDRAW: 0\nSTATE: 2\nTYPE: 1 X: 1 Y: 2\nTYPE: 2 X: 3 Y: 4\nTYPE: 2 X: 5 Y: 6\n\
                TYPE: 1 X: 7 Y: 8\nTYPE: 2 X: 9 Y: 10\nTYPE: 2 X: 1.5 Y: -2\nTYPE: 3 X: 1 Y: 2\nTYPE: 2 X: 3 Y: 4\nTYPE: 2 X: 5 Y: 6\n\
                TYPE: 1 X: 7 Y: 8\nTYPE: 2 X: 9 Y: 10\n";
    out.push(("gimp_text", "one".into(), text.into()));
    out.push(("gimp_text", "two".into(), text.repeat(2).into()));
    out
}

#[test]
fn seeds_are_read() {
    let folder = std::env::var_os("PATHWARP_FUZZ_SEEDS").map(|f| crate::support::root().join(f));
    for (target, name, bytes) in seeds() {
        read(&bytes).unwrap_or_else(|e| panic!("{target} {name}: {e}"));
        if let Some(folder) = &folder {
            let folder = folder.join(target);
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(folder.join(name), bytes).unwrap();
        }
    }
    // Two strokes; in GIMP 1, all but the last are closed.
    let text = read(&seeds().pop().unwrap().2).unwrap();
    assert_eq!((text.len(), text[0].strokes[0].closed, text[0].strokes[1].closed), (2, true, false));
    assert_eq!(text[0].strokes[0].points[0], [1.5, -2.0]);
    assert_eq!(text[0].strokes[1].points[..2], [[1.0, 2.0]; 2]);
}
