//! Files written by GIMP, in `tests/gimp`, whose README names the versions and the checks. `PATHWARP_GIMP_SAMPLES` names another folder
//! with pairs of `NAME.xcf` (or `.xcf.gz`) and `NAME.expected.json`, and with `gimp1-text/NAME.txt` likewise.

use crate::support::xcf::Counted;
use crate::{MEMORY, alone};
use pathwarp_gimp::{GimpPath, open, read, rewrite, salvage};
use serde_json::Value;
use std::io::Cursor;
use std::path::{Path, PathBuf};

fn folders() -> Vec<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/gimp");
    [own].into_iter().chain(std::env::var_os("PATHWARP_GIMP_SAMPLES").map(PathBuf::from)).collect()
}

/// Name, bytes and expected content of every sample.
fn samples(part: &str, endings: &[&str]) -> Vec<(String, Vec<u8>, Value)> {
    let mut out = Vec::new();
    for folder in folders().iter().map(|f| f.join(part)) {
        let before = out.len();
        for e in std::fs::read_dir(&folder).unwrap() {
            let name = e.unwrap().file_name().into_string().unwrap();
            let Some(stem) = endings.iter().find_map(|e| name.strip_suffix(e)) else { continue };
            let expected = std::fs::read(folder.join(format!("{stem}.expected.json"))).unwrap();
            let bytes = std::fs::read(folder.join(&name)).unwrap();
            out.push((folder.join(name).display().to_string(), bytes, serde_json::from_slice(&expected).unwrap()));
        }
        assert!(out.len() > before, "{}", folder.display());
    }
    out.sort_by(|a, b| a.0.cmp(&b.0));
    out
}

#[track_caller]
fn same(name: &str, found: &[GimpPath], expected: &Value) {
    let expected = expected["paths"].as_array().unwrap();
    assert_eq!(found.len(), expected.len(), "{name}");
    for (f, e) in found.iter().zip(expected) {
        assert_eq!(f.name, e["name"], "{name}");
        if let Some(visible) = e["visible"].as_bool() {
            assert_eq!(f.visible, visible, "{name}, {}", f.name);
        }
        let strokes = e["strokes"].as_array().unwrap();
        assert_eq!(f.strokes.len(), strokes.len(), "{name}, {}", f.name);
        for (f, e) in f.strokes.iter().zip(strokes) {
            assert_eq!(f.closed, e["closed"], "{name}");
            let points: Vec<[f64; 2]> = serde_json::from_value(e["points"].clone()).unwrap();
            let bits = |p: &Vec<[f64; 2]>| p.as_flattened().iter().map(|v| v.to_bits()).collect::<Vec<u64>>();
            assert_eq!(bits(&f.points), bits(&points), "{name}");
        }
    }
}

#[test]
fn sound_files_agree_bit_for_bit_and_damaged_ones_fail() {
    let _alone = alone();
    let (mut good, mut damaged) = (0, 0);
    for (name, bytes, expected) in samples("", &[".xcf", ".xcf.gz"]) {
        MEMORY.reset_peak_usage();
        let before = MEMORY.current_usage();
        let mut file = Counted::of(&bytes);
        let found = open(&mut file);
        let peak = MEMORY.peak_usage() - before;
        file.assert_little(&name);
        assert!(
            file.bytes <= 2 * bytes.len() && peak < 50 << 20,
            "{name}: {} bytes are read, and {peak} bytes held",
            file.bytes
        );
        if expected["paths"].is_array() {
            same(&name, &found.unwrap_or_else(|e| panic!("{name}: {e}")).paths, &expected);
            good += 1;
        } else {
            let e = found.err().unwrap_or_else(|| panic!("{name} is damaged: {}", expected["expected"]));
            let salvaged = salvage(Cursor::new(&bytes)).map(|s| s.file.paths.len()).unwrap_or(0);
            eprintln!("{name}: {e}; {salvaged} paths before it\n    expected: {}", expected["expected"]);
            damaged += 1;
        }
    }
    eprintln!("{good} good, {damaged} damaged");
}

#[test]
fn texts_of_gimp_1_agree() {
    let _alone = alone();
    for (name, bytes, expected) in samples("gimp1-text", &[".txt"]) {
        same(&name, &read(&bytes).unwrap(), &expected);
    }
}

/// GIMP's exports have two decimals, its point lists ten digits.
#[test]
fn exports_and_point_lists_agree_with_the_files() {
    let _alone = alone();
    let mut seen = 0;
    for (name, bytes, _) in samples("", &[".xcf", ".xcf.gz"]) {
        let Ok(paths) = read(&bytes) else { continue };
        let stem = name.split(".xcf").next().unwrap();
        for (ending, tolerance) in [("export.svg", 0.005_001), ("pdb.json", 0.0)] {
            let Ok(other) = std::fs::read(format!("{stem}.{ending}")) else { continue };
            let other = read(&other).unwrap_or_else(|e| panic!("{stem}.{ending}: {e}"));
            // GIMP stops at an empty path, which is skipped here.
            let stops = other.len() < paths.len() && stem.contains("31-");
            assert!(stops || other.len() == paths.len(), "{stem}.{ending}");
            for (p, q) in paths.iter().zip(&other) {
                // XML readers turn a tab in an id into a space.
                assert_eq!(p.name.replace('\t', " "), q.name.replace('\t', " "));
                assert_eq!(p.strokes.len(), q.strokes.len(), "{stem}.{ending} {}", p.name);
                for (s, t) in p.strokes.iter().zip(&q.strokes) {
                    assert_eq!((s.closed, s.anchors()), (t.closed, t.anchors()), "{stem}.{ending} {}", p.name);
                    // SVG lacks the outer handles of open ends.
                    let n = s.points.len();
                    let ends = if s.closed || tolerance == 0.0 { 0 } else { 1 };
                    for (a, b) in s.points[ends..n - ends].iter().zip(&t.points[ends..n - ends]) {
                        for (a, b) in a.iter().zip(b) {
                            // Allow for ten digits or single precision.
                            let near = tolerance + a.abs() * 6e-8;
                            assert!((a - b).abs() <= near, "{stem}.{ending} {}: {a} {b}", p.name);
                        }
                    }
                    seen += 1;
                }
            }
        }
    }
    assert!(seen >= 46, "{seen} strokes");
}

/// Writing back unchanged strokes reproduces the file.
#[test]
fn files_survive_rewriting() {
    let _alone = alone();
    for (name, bytes, _) in samples("", &[".xcf"]) {
        let Ok(file) = open(Cursor::new(&bytes)) else { continue };
        let strokes: Vec<_> = file.paths.iter().map(|p| p.strokes.clone()).enumerate().collect();
        let mut out = Vec::new();
        rewrite(Cursor::new(&bytes), &mut out, &strokes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(out == bytes, "{name} has changed");
        // Longer strokes move everything after them.
        let mut wanted = file.paths;
        let single = |p: [f64; 2]| p.map(|v| f64::from(v as f32));
        for s in wanted.iter_mut().flat_map(|p| &mut p.strokes) {
            let [x, y] = s.points.last().copied().unwrap_or_default();
            s.points =
                s.points.iter().copied().map(single).chain((0..9).map(|i| single([x + f64::from(i), y]))).collect();
        }
        let strokes: Vec<_> = wanted.iter().map(|p| p.strokes.clone()).enumerate().collect();
        let mut out = Vec::new();
        rewrite(Cursor::new(&bytes), &mut out, &strokes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(open(Cursor::new(&out)).unwrap_or_else(|e| panic!("{name}: {e}")).paths, wanted, "{name}");
    }
}
