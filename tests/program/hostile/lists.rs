//! Long names, many equal names, embedded fonts, many segments: work that grows with the square of a file's size.

use super::bounded::{Folder, RECT, svg};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fs;
use std::io::Write as _;

#[test]
fn a_long_name_does_not_pad_all_lines() {
    let body = format!("<path id='{}' d='M0 0L1 1'/>{}", "n".repeat(300_000), "<path d='M0 0L1 1'/>".repeat(20_000));
    let folder = Folder::with(&[("a.svg", &svg(&body))]).ample();
    for command in [&["paths", "a.svg"][..], &["compare", "a.svg", "a.svg"]] {
        assert_eq!(folder.run(command).0, 0, "{command:?}");
    }
}

#[test]
fn a_file_larger_than_the_memory_is_an_error() {
    let folder = Folder::with(&[]);
    fs::File::create(folder.path().join("a.svg")).unwrap().set_len(3 << 30).unwrap();
    for command in [&["warp", "a.svg", "--style", "flag", "-o", "o.svg"][..], &["paths", "a.svg"]] {
        let (code, said) = folder.run(command);
        assert_eq!(code, 3, "{command:?}: {said}");
        assert!(said.contains("a.svg: cannot be read"), "{said}");
    }
}

#[test]
fn many_paths_of_one_name_are_numbered() {
    let folder = Folder::with(&[("a.svg", &svg(&"<path d='M0 0L1 1'><title>a</title></path>".repeat(8000)))]).ample();
    assert_eq!(folder.run(&["convert", "a.svg", "--split", "-o", "s.svg"]).0, 0);
    for name in ["s-a.svg", "s-a-2.svg", "s-a-8000.svg"] {
        assert!(folder.path().join(name).exists(), "{name}");
    }
}

/// A WOFF file with one table, which announces `length` bytes, and a count of tables.
fn woff(length: u32, table: &[u8], count: u16) -> Vec<u8> {
    let mut out = b"wOFF\0\x01\0\0\0\0\0\0".to_vec();
    out.extend(count.to_be_bytes());
    out.resize(44, 0);
    out.extend(b"glyf");
    for n in [64, u32::try_from(table.len()).unwrap(), length, 0] {
        out.extend(n.to_be_bytes());
    }
    out.extend(table);
    out
}

#[test]
fn embedded_fonts_are_counted() {
    const MANY: usize = 60 << 20;
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&vec![0; MANY]).unwrap();
    let font = woff(MANY as u32, &packed.finish().unwrap(), 1);
    let face = |family: usize, font: &[u8]| {
        format!("@font-face{{font-family:a{family};src:url(data:font/woff;base64,{})}}", STANDARD.encode(font))
    };
    let text = "<text y='20' font-family='a1'>a</text>";
    let faces: String = (0..8).map(|i| face(i, &font)).collect();
    let folder = Folder::with(&[("a.svg", &svg(&format!("<style>{faces}</style>{text}")))]);
    folder.expect("a.svg", [3, 3], "bytes");
    // A directory of more tables than an sfnt file can announce.
    let mut crowded = woff(9, &[0; 9], u16::MAX);
    crowded.resize(700_000, 0);
    let folder = Folder::with(&[("a.svg", &svg(&format!("<style>{}</style>{text}{RECT}", face(1, &crowded))))]);
    folder.expect("a.svg", [0, 0], "");
    for style in ["@font-face".repeat(90_000), format!("@font-face{{font-family:a;src:{}}}", "data:".repeat(150_000))] {
        Folder::with(&[("a.svg", &svg(&format!("<style>{style}</style>{text}{RECT}")))]).run_all("a.svg");
    }
}

#[test]
fn distances_of_many_segments_are_counted() {
    let star = format!("<path id='p' d='M0 0{}'/>", "L100 50L-100 50".repeat(30_000));
    let line = format!("<path id='p' d='M0 0{}'/>", "l1 1h-1".repeat(60_000));
    let folder = Folder::with(&[("a.svg", &svg(&star)), ("b.svg", &svg(&line))]);
    for (a, b) in [("a.svg", "a.svg"), ("b.svg", "b.svg"), ("a.svg", "b.svg")] {
        let (code, said) = folder.run(&["compare", a, b]);
        assert!(code == 0 || code == 3 && said.contains("--limit work="), "{a} {b}: {code} {said}");
    }
}
