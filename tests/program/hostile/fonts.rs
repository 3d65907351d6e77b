//! Fonts whose glyphs have no end: parts of parts, subroutines of subroutines, layers over layers, drawings packed in them; and collections
//! that repeat one font.

use super::bounded::{Folder, svg};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write as _;

/// Tables by their tags.
type Tables = Vec<(&'static str, Vec<u8>)>;

fn short(numbers: &[u16]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_be_bytes()).collect()
}

fn long(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_be_bytes()).collect()
}

/// A font file (OpenType 1.9.1, otff) at `base` of a file.
fn sfnt(tables: &Tables, base: u32) -> Vec<u8> {
    let mut tables = tables.clone();
    tables.sort_by_key(|(tag, _)| *tag);
    let mut head = [&[0, 1, 0, 0][..], &short(&[tables.len() as u16, 0, 0, 0])].concat();
    let mut body = Vec::new();
    for (tag, content) in &tables {
        head.extend(tag.as_bytes());
        head.extend(long(&[0, base + 12 + 16 * tables.len() as u32 + body.len() as u32, content.len() as u32]));
        body.extend(content);
        body.resize(body.len().next_multiple_of(4), 0);
    }
    [head, body].concat()
}

/// The tables of a font without outlines, named E, whose letters from a on are the glyphs from 1 on.
fn tables(glyphs: u16, names: u16) -> Tables {
    let mut head = vec![0; 54];
    head[18..20].copy_from_slice(&1000_u16.to_be_bytes());
    head[51] = 1;
    let mut hhea = vec![0; 36];
    hhea[4..6].copy_from_slice(&800_u16.to_be_bytes());
    hhea[35] = 1;
    let cmap = [short(&[0, 1, 3, 10]), long(&[12]), short(&[12, 0]), long(&[28, 0, 1, 97, 122, 1])].concat();
    // The last name is the PostScript name.
    let name = (1..=names).flat_map(|i| short(&[3, 1, 0x409, if i < names { 1 } else { 6 }, 2, 0])).collect::<Vec<_>>();
    vec![
        ("cmap", cmap),
        ("head", head),
        ("hhea", hhea),
        ("hmtx", [short(&[600, 0]), vec![0; 2 * usize::from(glyphs)]].concat()),
        ("maxp", [long(&[0x0001_0000]), short(&[glyphs]), vec![0; 26]].concat()),
        ("name", [short(&[0, names, 6 + 12 * names]), name, b"\0E".to_vec()].concat()),
    ]
}

/// A font with these glyphs.
fn of_glyphs(glyphs: &[Vec<u8>], more: Tables) -> Vec<u8> {
    let mut all = tables(glyphs.len() as u16, 2);
    let mut offsets = vec![0];
    for g in glyphs {
        offsets.push(offsets.last().unwrap() + g.len() as u32);
    }
    all.extend([("glyf", glyphs.concat()), ("loca", long(&offsets))]);
    all.extend(more);
    sfnt(&all, 0)
}

/// A triangle.
fn triangle() -> Vec<u8> {
    let box_and_ends = short(&[1, 0, 0, 500, 500, 2, 0]);
    [&box_and_ends[..], &[1, 1, 1], &short(&[0, 500, 0, 0, 0, 500])].concat().into_iter().chain([0]).collect()
}

/// A glyph that shows another one several times.
fn parts(glyph: u16, count: usize) -> Vec<u8> {
    const MORE: u16 = 0x20;
    const OFFSETS: u16 = 2;
    let part = |i: usize| short(&[OFFSETS | if i + 1 < count { MORE } else { 0 }, glyph, 0]);
    [short(&[0xffff, 0, 0, 500, 500]), (0..count).flat_map(part).collect()].concat()
}

/// An index of a CFF table.
fn index(items: &[Vec<u8>]) -> Vec<u8> {
    let mut out = short(&[items.len() as u16]);
    if items.is_empty() {
        return out;
    }
    out.push(4);
    let mut end = 1;
    out.extend(long(&[end]));
    for item in items {
        end += item.len() as u32;
        out.extend(long(&[end]));
    }
    out.extend(items.concat());
    out
}

/// A font whose letter a calls subroutines nine levels deep, two hundred of each.
fn of_subroutines() -> Vec<u8> {
    const RETURN: u8 = 11;
    const END: u8 = 14;
    const CALL_GLOBAL: u8 = 29;
    // A call of subroutine k, as a number: 107 is the bias of subroutines, 139 that of numbers.
    let number = |k: u8| k + 139 - 107;
    let mut subroutines = vec![vec![RETURN]];
    for k in 0..8 {
        subroutines.push([[number(k), CALL_GLOBAL].repeat(200), vec![RETURN]].concat());
    }
    let (name, strings, subroutines) = (index(&[b"E".to_vec()]), index(&[]), index(&subroutines));
    let charstrings = index(&[vec![END], vec![number(8), CALL_GLOBAL, END]]);
    let top = |at: u32, end: u32| {
        let number = |n: u32| [vec![29], long(&[n])].concat();
        index(&[[number(at), vec![17], number(0), number(end), vec![18]].concat()])
    };
    let at = (4 + name.len() + top(0, 0).len() + strings.len() + subroutines.len()) as u32;
    let top = top(at, at + charstrings.len() as u32);
    let cff = [vec![1, 0, 4, 4], name, top, strings, subroutines, charstrings].concat();
    let mut all = tables(2, 2);
    all.push(("CFF ", cff));
    sfnt(&all, 0)
}

/// Layers that are each composed of the next one twice (OpenType 1.9.1, COLR, format 32).
fn doubled(levels: usize) -> Vec<u8> {
    let head = [short(&[1, 0]), long(&[0, 0]), short(&[0]), long(&[34, 0, 0, 0, 0])].concat();
    let list = [long(&[1]), short(&[1]), long(&[10])].concat();
    let composed = [32, 0, 0, 8, 3, 0, 0, 8].repeat(levels);
    let filled = [10, 0, 0, 6, 0, 2, 2, 0, 0, 0x40, 0];
    [head, list, composed, filled.to_vec()].concat()
}

/// A drawing with a text in an embedded font.
fn lettered(font: &[u8], text: &str) -> Folder {
    let style =
        format!("<style>@font-face{{font-family:X;src:url(data:font/ttf;base64,{})}}</style>", STANDARD.encode(font));
    let text = format!("{style}<text y='50' font-family='X' font-size='20'>{text}</text>");
    Folder::with(&[("a.svg", &svg(&text)), ("a.ttf", font)])
}

#[test]
fn glyphs_without_an_end_are_refused() {
    let mut nested: Vec<Vec<u8>> = vec![triangle()];
    nested.extend((1..30).map(|k| parts(k + 1, 2)));
    nested.push(triangle());
    let plain = || vec![triangle(), triangle(), triangle()];
    let layered = of_glyphs(&plain(), vec![("COLR", doubled(40))]);
    for font in [of_glyphs(&nested, Vec::new()), of_subroutines(), layered] {
        let folder = lettered(&font, "a").ample();
        folder.expect("a.svg", [3, 3], "takes 200000 points or more");
        let installed = Folder::with(&[("a.ttf", &font), ("a.svg", &svg("<text y='50' font-family='E'>a</text>"))]);
        for command in [["swirl", "o.svg"], ["render", "o.png"]] {
            let (code, said) = installed.run(&[command[0], "a.svg", "--font-file", "a.ttf", "-o", command[1]]);
            assert_eq!((code, said.contains("takes 200000")), (3, true), "{said}");
        }
    }
    // In a set text, only the glyphs in use count.
    let folder = lettered(&of_subroutines(), "a");
    let (code, said) = folder.run(&["text", "a", "--font", "a.ttf", "-o", "o.svg"]);
    assert_eq!((code, said.contains("with all of its subroutines")), (3, true), "{said}");
    // Such fonts with few levels are accepted.
    let few = of_glyphs(&[triangle(), parts(2, 9), triangle()], vec![("COLR", doubled(3))]);
    lettered(&few, "a").expect("a.svg", [0, 0], "");
}

#[test]
fn heavy_letters_are_counted() {
    let glyphs = [triangle(), parts(2, 3000), triangle()];
    lettered(&of_glyphs(&glyphs, Vec::new()), "a").expect("a.svg", [0, 0], "");
    lettered(&of_glyphs(&glyphs, Vec::new()), &"a".repeat(600)).is_not_read("a.svg", "--limit work=");
}

#[test]
fn drawings_in_fonts_are_counted() {
    let drawing = |inside: &str| {
        let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
        gz.write_all(b"<svg xmlns='http://www.w3.org/2000/svg'><path id='glyph1' d='M0 0H9V9z'/>").unwrap();
        gz.write_all(inside.as_bytes()).unwrap();
        gz.write_all(b"</svg>").unwrap();
        let packed = gz.finish().unwrap();
        let length = packed.len() as u32;
        [short(&[0]), long(&[10, 0]), short(&[1, 1, 1]), long(&[14, length]), packed].concat()
    };
    let font = |inside: &str| of_glyphs(&[triangle(), triangle(), triangle()], vec![("SVG ", drawing(inside))]);
    lettered(&font(""), "a").expect("a.svg", [0, 0], "");
    lettered(&font(&" ".repeat(40 << 20)), "a").expect("a.svg", [3, 3], "--limit bytes=");
}

/// A collection that announces more fonts than it has bytes, and one of many fonts that share a long list of names.
#[test]
fn crowded_collections_are_refused() {
    let collection = |announced: u32, fonts: u32| {
        let at = 12 + 4 * fonts;
        let mut all = tables(2, 5000);
        all.extend([("glyf", triangle()), ("loca", long(&[0, 0, triangle().len() as u32]))]);
        [b"ttcf\0\x01\0\0".to_vec(), long(&[announced]), long(&vec![at; fonts as usize]), sfnt(&all, at)].concat()
    };
    for (announced, fonts) in [(u32::MAX, 1), (60_000, 60_000)] {
        let folder = lettered(&collection(announced, fonts), "a");
        folder.is_not_read("a.svg", "--limit bytes=");
        let (code, said) = folder.run(&["swirl", "a.svg", "--font-file", "a.ttf", "-o", "o.svg"]);
        assert_eq!((code, said.contains("than can be listed")), (3, true), "{said}");
    }
    lettered(&collection(3, 3), "a").expect("a.svg", [0, 0], "");
}

#[test]
fn an_axis_may_run_backwards() {
    let mut font = include_bytes!("../../../crates/pathwarp-text/tests/fonts/variable.ttf").to_vec();
    let rising = |w: &[u8]| w.starts_with(b"wght") && w[4..8] < w[8..12] && w[8..12] < w[12..16];
    let at = font.windows(16).position(rising).unwrap();
    let (least, most): (Vec<u8>, Vec<u8>) = (font[at + 4..at + 8].into(), font[at + 12..at + 16].into());
    font[at + 4..at + 8].copy_from_slice(&most);
    font[at + 12..at + 16].copy_from_slice(&least);
    let (code, said) =
        Folder::with(&[("a.ttf", &font)]).run(&["text", "a", "--font", "a.ttf", "--weight", "bold", "-o", "o.svg"]);
    assert!(code == 2 && said.contains("wght"), "{code} {said}");
}
