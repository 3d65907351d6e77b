//! Files of every version and form, plain and compressed, are read bit for bit, and rewritten without a change to any other byte.

use crate::support::xcf::{self, Counted, Form, forms, item, paths_for, plain_paths, rich_paths, tiles, xcf};
use pathwarp_gimp::{FileKind, GimpPath, Stroke, new_xcf, open, read, rewrite};
use std::io::{Cursor, Read, Seek, SeekFrom, Write};

#[test]
fn every_version_and_form_gives_its_paths() {
    for (version, form) in forms() {
        let paths = paths_for(form);
        let file = open(Cursor::new(xcf(version, form, &paths))).unwrap_or_else(|e| panic!("v{version} {form:?}: {e}"));
        assert_eq!(file.paths, paths, "v{version} {form:?}");
        assert_eq!((file.kind, file.size), (FileKind::Xcf(version), Some([640.0, 400.0])));
    }
    // A future version with the same layout.
    assert_eq!(read(&xcf(25, Form::Items, &rich_paths())).unwrap(), rich_paths());
}

#[test]
fn both_properties_in_one_file_add_up() {
    let (old, new) = (plain_paths(), rich_paths());
    let mut head = xcf::head(0);
    head.property(23, &xcf::old_paths(&old, 3)).property(25, &xcf::vectors(&new, 2)).property(0, &[]);
    assert_eq!(read(&xcf::rest(head.0, 0, &[])).unwrap(), [old, new].concat());
}

#[test]
fn old_paths_with_a_wrong_length_or_without_points_are_read_on() {
    let mut head = xcf::head(0);
    let paths = plain_paths();
    let content = xcf::old_paths(&paths, 2);
    head.words(&[23, 5]).raw(&content).property(0, &[]);
    assert_eq!(read(&xcf::rest(head.0, 0, &[])).unwrap(), paths);
    let mut with_empty = paths.clone();
    with_empty.insert(1, GimpPath { name: "nothing".into(), ..GimpPath::default() });
    let mut head = xcf::head(1);
    head.property(23, &xcf::old_paths(&with_empty, 3)).property(0, &[]);
    assert_eq!(read(&xcf::rest(head.0, 1, &[])).unwrap(), paths);
}

#[test]
fn compressed_files_are_read() {
    for (version, form) in [(0, Form::Old(3)), (11, Form::Vectors(2)), (18, Form::Items)] {
        let paths = paths_for(form);
        let plain = xcf(version, form, &paths);
        let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        gz.write_all(&plain).unwrap();
        let mut bz = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::default());
        bz.write_all(&plain).unwrap();
        let mut packed = vec![("gz", gz.finish().unwrap()), ("bz2", bz.finish().unwrap())];
        packed.extend(xz(&plain).map(|x| ("xz", x)));
        for (how, bytes) in packed {
            let file = open(Cursor::new(&bytes)).unwrap_or_else(|e| panic!("{how} v{version}: {e}"));
            assert_eq!((file.kind, &file.paths), (FileKind::PackedXcf(version), &paths), "{how}");
            assert!(pathwarp_gimp::sniff(Cursor::new(&bytes)));
            // Damaged compressed data is an error, not a panic.
            for cut in [3, bytes.len() / 2] {
                read(&bytes[..cut]).unwrap_err();
            }
        }
    }
}

/// Compresses with the program `xz`; `None` if it is not installed.
fn xz(plain: &[u8]) -> Option<Vec<u8>> {
    let mut child = std::process::Command::new("xz")
        .arg("-c")
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .inspect_err(|_| {
            // Tests do not capture this; the gate lists such lines.
            let _ = std::io::stderr().write_all(b"skipped: compressed XCF files are not tested without `xz`\n");
        })
        .ok()?;
    child.stdin.take()?.write_all(plain).ok()?;
    Some(child.wait_with_output().ok()?.stdout)
}

#[test]
fn little_is_read_of_a_file_of_two_gigabytes() {
    const SIZE: u64 = 2 << 30;
    let folder = tempfile::tempdir().unwrap();
    let paths = rich_paths();
    // Vectors are near the start; items can be at the very end.
    let mut early = std::fs::File::create(folder.path().join("early.xcf")).unwrap();
    early.write_all(&xcf(11, Form::Vectors(2), &paths)).unwrap();
    early.set_len(SIZE).unwrap();
    let mut head = xcf::head(18).0;
    head.extend([0; 8]);
    head.extend([0; 16]);
    let mut late = std::fs::File::create(folder.path().join("late.xcf")).unwrap();
    let mut at = SIZE;
    for p in &paths {
        head.extend(at.to_be_bytes());
        at += item(p).len() as u64;
    }
    head.extend([0; 8]);
    late.write_all(&head).unwrap();
    late.seek(SeekFrom::Start(SIZE)).unwrap();
    for p in &paths {
        late.write_all(&item(p)).unwrap();
    }
    for name in ["early.xcf", "late.xcf"] {
        let mut file = Counted::new(std::fs::File::open(folder.path().join(name)).unwrap());
        assert_eq!(open(&mut file).unwrap().paths, paths);
        assert!(file.bytes < 1 << 20, "{name}: {} bytes are read", file.bytes);
    }
}

fn rewritten(file: &[u8], strokes: &[(usize, Vec<Stroke>)]) -> Vec<u8> {
    let mut out = Vec::new();
    rewrite(Cursor::new(file), &mut out, strokes).unwrap();
    out
}

#[test]
fn the_same_strokes_give_the_same_bytes() {
    for (version, form) in forms() {
        let file = xcf(version, form, &paths_for(form));
        let all: Vec<(usize, Vec<Stroke>)> = read(&file).unwrap().into_iter().map(|p| p.strokes).enumerate().collect();
        assert!(rewritten(&file, &all) == file, "v{version} {form:?}");
    }
}

#[test]
fn new_strokes_leave_the_rest_unchanged() {
    for (version, form) in forms() {
        let before = paths_for(form);
        let file = xcf(version, form, &before);
        for grow in [true, false] {
            let mut wanted = before.clone();
            let s = &mut wanted[1].strokes[0];
            if grow {
                let more: Vec<[f64; 2]> = (0..60).map(|i| [f64::from(i) * 0.5, 3.25]).collect();
                s.points.extend(more);
            } else {
                s.points.truncate(3);
            }
            let out = rewritten(&file, &[(1, wanted[1].strokes.clone())]);
            assert_eq!(read(&out).unwrap(), wanted, "v{version} {form:?}");
            assert_eq!(tiles(&out), tiles(&file), "v{version} {form:?}");
            assert_eq!(&tiles(&out)[1][..5], b"mask ");
            // Writing back the old strokes restores the file in forms that keep everything and can shrink.
            if matches!(form, Form::Old(3) | Form::Vectors(2)) {
                assert!(rewritten(&out, &[(1, before[1].strokes.clone())]) == file, "v{version} {form:?}");
            }
        }
    }
}

#[test]
fn impossible_rewrites_are_errors() {
    let file = xcf(0, Form::Old(3), &plain_paths());
    let open_first = rich_paths()[1].strokes.clone();
    let e = rewrite(Cursor::new(&file), &mut Vec::new(), &[(1, open_first)]).unwrap_err();
    assert!(e.to_string().contains("only the last stroke may be open"), "{e}");
    assert!(
        rewrite(Cursor::new(b"<svg/>"), &mut Vec::new(), &[]).unwrap_err().problem.contains("not an uncompressed XCF")
    );
    assert!(rewrite(Cursor::new(&file), &mut Vec::new(), &[(9, Vec::new())]).unwrap_err().problem.contains("number 9"));
    // A pointer table that points into itself soon ends in an error.
    let mut looped = xcf(0, Form::Vectors(2), &rich_paths());
    let size = looped.len();
    let tile = looped.windows(6).position(|w| w == b"layer ").unwrap();
    let inside = (tile as u32 - 12).to_be_bytes();
    for w in looped[tile..].chunks_exact_mut(4).take((size - tile) / 4) {
        w.copy_from_slice(&inside);
    }
    let strokes = vec![(0, rich_paths()[1].strokes.clone())];
    let mut file = Counted::of(&looped);
    rewrite(&mut file, &mut Vec::new(), &strokes).unwrap_err();
    file.assert_little("pointers into their own table");
}

#[test]
fn a_new_file_holds_its_paths() {
    let paths = rich_paths();
    let mut bytes = Vec::new();
    Cursor::new(new_xcf([640, 400], &paths)).read_to_end(&mut bytes).unwrap();
    let file = open(Cursor::new(bytes)).unwrap();
    assert_eq!((file.paths, file.size), (paths, Some([640.0, 400.0])));
}
