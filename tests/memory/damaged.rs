//! Damaged files give the right error quickly and with little memory, and keep the paths before the damage.

use crate::support::xcf::{self, Counted, Form, forms, paths_for, plain_paths, rich_paths, xcf};
use crate::{MEMORY, alone};
use pathwarp::budget::Limit;
use pathwarp_gimp::{Error, open, read, salvage};
use std::io::Cursor;

/// Returns the error for a damaged file. Reading must take less than 50 MB, and few calls.
#[track_caller]
fn error_of(bytes: &[u8]) -> Error {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let mut file = Counted::of(bytes);
    let e = open(&mut file).unwrap_err();
    let peak = MEMORY.peak_usage() - before;
    file.assert_little(&e.to_string());
    assert!(peak < 50 << 20, "{e} took {peak} bytes");
    e
}

#[track_caller]
fn expect(bytes: &[u8], offset: usize, problem: &str) {
    let e = error_of(bytes);
    assert!(e.problem.contains(problem), "{e}");
    assert_eq!(e.offset, offset as u64, "{e}");
}

/// Finds `needle`, which must occur exactly once.
fn find(bytes: &[u8], needle: &[u8]) -> usize {
    let mut all = bytes.windows(needle.len()).enumerate().filter(|(_, w)| *w == needle).map(|(i, _)| i);
    let first = all.next().unwrap();
    assert!(all.next().is_none());
    first
}

fn with(bytes: &[u8], at: usize, word: u32) -> Vec<u8> {
    let mut out = bytes.to_vec();
    out[at..at + 4].copy_from_slice(&word.to_be_bytes());
    out
}

#[test]
fn counts_are_checked_against_the_bytes_left() {
    let _alone = alone();
    let file = xcf(0, Form::Vectors(2), &plain_paths());
    let name = find(&file, b"Base\0");
    // The number of paths and the length of the name come before it; tattoo, visible, linked, parasites, strokes after it.
    expect(&with(&file, name - 8, 1 << 28), name - 8, "268435456 paths");
    expect(&with(&file, name - 4, 1 << 30), name - 4, "1073741824 bytes");
    expect(&with(&file, name + 17, u32::MAX), name + 17, "parasites");
    expect(&with(&file, name + 21, 0x7fff_ffff), name + 21, "strokes");
    let stroke = name + 25 + 4 + 7 + 8 + 5;
    expect(&with(&file, stroke, 0), stroke, "type 0");
    expect(&with(&file, stroke + 8, 1), stroke + 8, "1 axes");
    expect(&with(&file, stroke + 8, 9), stroke + 8, "9 axes");
    expect(&with(&file, stroke + 12, 0x7fff_ffff), stroke + 12, "2147483647 points");
    expect(&with(&file, stroke + 12, 7), stroke + 12, "7 points");
    expect(&with(&file, stroke + 20, f32::NAN.to_bits()), stroke + 20, "NaN");
    expect(&with(&file, stroke + 24, f32::INFINITY.to_bits()), stroke + 24, "inf");
    expect(&with(&file, stroke + 16, 5), stroke + 16, "type 5");
    // The length of the property, and the version of its content.
    let start = name - 16;
    expect(&with(&file, start, 2), start, "version 2");
    expect(&with(&file, start - 4, 9), start + 8, "of the 9 bytes given for PROP_VECTORS");
    let length = u32::from_be_bytes(file[start - 4..start].try_into().unwrap());
    expect(&with(&file, start - 4, length + 8), start - 4, "length word");
    error_of(&with(&file, stroke + 12, 0));
}

#[test]
fn names_end_in_zero_and_are_utf_8() {
    let _alone = alone();
    let file = xcf(11, Form::Vectors(2), &plain_paths());
    let name = find(&file, b"Base\0");
    let mut bad = file.clone();
    bad[name + 2] = 0xff;
    expect(&bad, name + 2, "not UTF-8");
    bad.clone_from(&file);
    bad[name + 4] = b'!';
    expect(&bad, name + 4, "zero byte");
}

#[test]
fn heads_are_checked() {
    let _alone = alone();
    expect(b"", 0, "empty");
    expect(b"gimp xcf v999\0\0\0\x01\0\0\0\x01\0\0\0\0\0", 9, "version 999");
    expect(b"gimp xcf vier\0", 9, "`vier`");
    expect(b"gimp xcf file\0\0\0\x02\x80", 18, "header");
    expect(b"GIF89a", 0, "not a file of GIMP");
    let file = xcf(4, Form::Vectors(2), &plain_paths());
    expect(&with(&file, 22, 7), 22, "base type 7");
}

#[test]
fn pointers_stay_in_the_file_and_form_no_loops() {
    let _alone = alone();
    let file = xcf(18, Form::Items, &plain_paths());
    // The tables follow the last property (22, the unit) and the end marker: a layer, 0, a channel, 0, the paths.
    let tables = find(&file, &[0, 0, 0, 22, 0, 0, 0, 4, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0]) + 20;
    let path = tables + 4 * 8;
    expect(&with(&file, path + 4, file.len() as u32 + 1000), path, "outside the file");
    expect(&with(&file, path, 1), path, "outside the file");
    expect(&with(&file, path + 4, 30), path, "the file's head");
    let second = u32::from_be_bytes(file[path + 12..path + 16].try_into().unwrap());
    expect(&with(&file, path + 4, second), path + 8, "another path");
    // A table without end.
    let mut endless = file[..tables].to_vec();
    endless.extend([0, 0, 0, 0, 0, 0, 0, 40].repeat(9));
    expect(&endless, endless.len(), "the table of layer pointers");
    // An item's size.
    let name = find(&file, b"Base\0");
    let size = u32::from_be_bytes(file[name + 5..name + 9].try_into().unwrap());
    expect(&with(&file, name + 5, size + 3), name + 5, "size word");
    expect(&with(&file, name + 5, u32::MAX), name + 5, "4294967295");
    assert!(error_of(&with(&file, name + 5, 3)).problem.contains("left"));
}

#[test]
fn truncated_files_and_flipped_bits_are_harmless() {
    let _alone = alone();
    for (version, form) in
        [(0, Form::Old(1)), (1, Form::Old(3)), (8, Form::Vectors(4)), (12, Form::Vectors(2)), (18, Form::Items)]
    {
        let paths = paths_for(form);
        let file = xcf(version, form, &paths);
        let mut whole = 0;
        for cut in 0..file.len() {
            match read(&file[..cut]) {
                Ok(found) => {
                    assert_eq!(found, paths);
                    whole += 1;
                }
                Err(e) => assert!(e.offset <= cut as u64, "{e} of {cut}"),
            }
            // Salvaged paths are a prefix of the original ones.
            if let Ok(s) = salvage(Cursor::new(&file[..cut])) {
                assert!(paths.starts_with(&s.file.paths) || version >= 18, "v{version} cut at {cut}");
            }
        }
        // Only bytes after the paths may be missing.
        assert!(whole < file.len() && (version >= 18 || whole > 0));
        for i in 0..file.len() * 8 {
            let mut flipped = file.clone();
            flipped[i / 8] ^= 1 << (i % 8);
            let _ = read(&flipped);
        }
    }
}

#[test]
fn paths_before_the_damage_are_salvaged() {
    let _alone = alone();
    for (version, form) in forms() {
        let paths = paths_for(form);
        let file = xcf(version, form, &paths);
        let name = find(&file, b"a single anchor\0");
        let broken = with(&file, name - 4, 0x7000_0000);
        assert!(open(Cursor::new(&broken)).is_err());
        let s = salvage(Cursor::new(&broken)).unwrap();
        assert_eq!(s.file.paths, paths[..2], "v{version} {form:?}");
        assert_eq!(s.damage.unwrap().offset, name as u64 - 4);
    }
}

/// A kilobyte can decompress to gigabytes of path data.
#[test]
fn decompression_bombs_end_soon() {
    use std::io::Write;
    let _alone = alone();
    let mut head = xcf::head(0).0;
    head.extend(0xdead_u32.to_be_bytes());
    head.extend(0xf000_0000_u32.to_be_bytes());
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    gz.write_all(&head).unwrap();
    for _ in 0..64 {
        gz.write_all(&vec![0; 1 << 20]).unwrap();
    }
    let e = error_of(&gz.finish().unwrap());
    // The announced size is refused before any unpacking.
    assert!(e.limit.is_some(), "{e}");
    // More points than the limit for compressed data.
    let mut head = xcf::head(0).0;
    for w in [25, u32::MAX, 1, 0, 1, 2, 0x4100_0000, 1, 0, 0, 0, 1, 1, 0, 2, 300_000_000] {
        head.extend(u32::to_be_bytes(w));
        if w == 0x4100_0000 {
            head.truncate(head.len() - 2);
        }
    }
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    gz.write_all(&head).unwrap();
    let mut points = Vec::new();
    for kind in [1, 0, 1] {
        points.extend([u32::to_be_bytes(kind), [0; 4], [0; 4]].concat());
    }
    for _ in 0..64 {
        gz.write_all(&points.repeat(20_000)).unwrap();
    }
    let e = error_of(&gz.finish().unwrap());
    assert!(e.limit.is_some_and(|e| e.limit == Limit::Bytes) && e.problem.contains("`bytes`"), "{e}");
    // A string of a gigabyte, present in compressed form.
    let mut head = xcf::head(0).0;
    for w in [25, u32::MAX, 1, 0, 1, 1 << 30] {
        head.extend(u32::to_be_bytes(w));
    }
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    gz.write_all(&head).unwrap();
    for _ in 0..200 {
        gz.write_all(&vec![b'a'; 1 << 20]).unwrap();
    }
    let e = error_of(&gz.finish().unwrap());
    assert!(e.limit.is_some_and(|e| e.limit == Limit::Bytes) && e.problem.contains("`bytes`"), "{e}");
}

#[test]
fn rich_paths_are_rich() {
    // Other tests depend on this.
    assert!(rich_paths().iter().any(|p| p.strokes.is_empty()) && rich_paths()[1].strokes.len() == 3);
}
