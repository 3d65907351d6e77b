//! Drawings in UTF-16 and in declared single-byte encodings are read, and written as UTF-8.

use super::common::text;
use crate::support::pathwarp_in;

const DRAWING: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\
                       <title>Größe</title><path id='größe' d='M10,10H90V90Z'/></svg>";

#[test]
fn encodings_give_the_result_of_utf8() {
    let dir = tempfile::tempdir().unwrap();
    let run = |args: &[&str], input: &[u8]| {
        let out = pathwarp_in(dir.path(), args, input);
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        out.stdout
    };
    let declaring = |name: &str| DRAWING.replace("UTF-8", name);
    let utf16 = |unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
        format!("\u{feff}{}", declaring("UTF-16")).encode_utf16().flat_map(unit).collect()
    };
    let latin: Vec<u8> = declaring("ISO-8859-1").chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    let commands: [&[&str]; 3] =
        [&["warp", "--style", "flag", "-q", "--select", "#größe"], &["affine"], &["render", "-"]];
    for args in commands {
        let wanted = run(args, DRAWING.as_bytes());
        assert!(!wanted.is_empty());
        for source in [utf16(u16::to_le_bytes), utf16(u16::to_be_bytes), latin.clone()] {
            assert!(run(args, &source) == wanted, "{args:?}: {}", text(&source));
        }
    }
    // The source comes back unchanged.
    let embedded = run(&["swirl", "--embed-recipe", "-q"], &latin);
    assert!(run(&["unwarp", "-"], &embedded) == latin);
}

#[test]
fn an_undeclared_encoding_is_an_error_with_the_byte() {
    let dir = tempfile::tempdir().unwrap();
    for (declaration, part) in [("", "UTF-8"), ("<?xml version='1.0' encoding='klingon'?>", "klingon")] {
        let mut bytes = format!("{declaration}<svg xmlns='http://www.w3.org/2000/svg'><!--").into_bytes();
        bytes.extend(b"\xe4--></svg>");
        let out = pathwarp_in(dir.path(), &["swirl"], &bytes);
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(3) && said.contains(part) && said.contains("byte"), "{said}");
    }
}
