//! Text that expands: entities, packed text, references, style sheets, attributes, letters.

use super::bounded::{Folder, RECT, expect, svg};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write as _;

fn with_doctype(declarations: &str, body: &str) -> Folder {
    let svg = svg(body);
    let text = format!("<?xml version='1.0'?><!DOCTYPE svg [{declarations}]>").into_bytes();
    Folder::with(&[("a.svg", &[text, svg].concat())])
}

fn packed(text: &[u8]) -> Vec<u8> {
    let mut out = GzEncoder::new(Vec::new(), Compression::fast());
    out.write_all(text).unwrap();
    out.finish().unwrap()
}

#[test]
fn entities_are_counted_before_they_expand() {
    let quadratic = format!("<!ENTITY a '{}'>", "a".repeat(60_000));
    with_doctype(&quadratic, &format!("<text>{}</text>", "&a;".repeat(20_000))).expect("a.svg", [3, 3], "bytes");
    let tens: String = (1..10).map(|i| format!("<!ENTITY e{i} '{}'>", format!("&e{};", i - 1).repeat(10))).collect();
    with_doctype(&format!("<!ENTITY e0 '{}'>{tens}", "x".repeat(10)), "<text>&e9;</text>").expect(
        "a.svg",
        [3, 3],
        "bytes",
    );
    let elements = format!("<!ENTITY e \"{}\">", RECT.repeat(20));
    with_doctype(&elements, &"&e;".repeat(9000)).expect("a.svg", [3, 3], "elements");
    let names: String = (0..20_000).map(|i| format!("<!ENTITY e{i} 'a'>")).collect();
    with_doctype(&names, &format!("<text>{}</text>", "&e19999;".repeat(30_000))).expect("a.svg", [3, 3], "work");
    // Likewise in a file that may be an export from GIMP.
    let gimp = "<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 20010904//EN' 'd.dtd' [";
    let text = format!(
        "{gimp}{quadratic}]><svg xmlns='http://www.w3.org/2000/svg'><text>{}</text></svg>",
        "&a;".repeat(20_000)
    );
    Folder::with(&[("a.svg", text.as_bytes())]).expect("a.svg", [3, 3], "bytes");
    // An outside entity is not read.
    let outside = with_doctype("<!ENTITY x SYSTEM 'file:///etc/hostname'>", "<text>&x;</text>");
    outside.expect("a.svg", [3, 3], "unknown entity");
    with_doctype("<!ENTITY ok 'fill=\"red\"'>", RECT).expect("a.svg", [0, 0], "");
}

#[test]
fn packed_text_is_unpacked_up_to_the_limit() {
    let spaces = packed(&svg(&" ".repeat(60_000_000)));
    Folder::with(&[("a.svgz", &spaces)]).expect("a.svgz", [3, 3], "bytes");
    let rects = packed(&svg(&"<rect width='9' height='9'/>".repeat(200_000)));
    Folder::with(&[("a.svgz", &rects)]).expect("a.svgz", [3, 3], "elements");
    let inside = packed(&svg(&"<a/>".repeat(4_000_000)));
    let folder = Folder::with(&[("in.svgz", &inside), ("a.svg", &svg("<image width='9' height='9' href='in.svgz'/>"))]);
    folder.expect("a.svg", [3, 3], "elements");
    Folder::with(&[("a.svgz", &packed(&svg(RECT)))]).expect("a.svgz", [0, 0], "");
}

#[test]
fn what_references_show_is_counted() {
    let level = |i: usize| format!("<g id='a{i}'>{}</g>", format!("<use href='#a{}'/>", i - 1).repeat(10));
    let nest: String = (1..6).map(level).collect();
    expect(&format!("<defs><g id='a0'>{RECT}</g>{nest}</defs><use href='#a5'/>"), [3, 3], "elements");
    // Few elements, many segments.
    let long = format!("<path id='p' d='M0 0{}'/>", "c1 9 9-1 2 1".repeat(20_000));
    expect(&format!("<defs>{long}</defs>{}", "<use href='#p'/>".repeat(500)), [3, 3], "work");
    let clips = "<rect width='9' height='9' clip-path='url(#c)'/>".repeat(300);
    expect(&format!("<clipPath id='c'>{long}</clipPath>{clips}"), [3, 3], "work");
    let marked = format!("<path marker-mid='url(#m)' d='M0 0{}'/>", "l1 1".repeat(20_000));
    expect(&format!("<marker id='m'><circle r='3'/>{RECT}</marker>{marked}"), [3, 3], "elements");
    expect(&"<x/>".repeat(200_000), [3, 3], "elements");
    // The limit can be raised, and content below it is drawn.
    let folder = Folder::with(&[("a.svg", &svg(&format!("<g id='g'>{}</g><use href='#g'/>", RECT.repeat(100))))]);
    assert_eq!(folder.run(&["swirl", "a.svg", "-o", "o.svg", "--limit", "elements=100"]).0, 3);
    assert_eq!(folder.run(&["swirl", "a.svg", "-o", "o.svg", "--limit", "elements=1e3"]).0, 0);
    assert_eq!(folder.run(&["render", "a.svg", "-o", "o.png", "--limit", "elements=100"]).0, 3);
    assert_eq!(folder.run(&["swirl", "a.svg", "-o", "o.svg", "--limit", "elments=100"]).0, 2);
}

#[test]
fn style_sheets_are_matched_within_bounds() {
    // Each part takes the nearest ancestor, so none is left for the first; other choices of ancestors are not tried.
    let deep = format!("x {}{{fill:red}}", "* ".repeat(500));
    let groups = ("<g>".repeat(60), "</g>".repeat(60));
    expect(&format!("<style>{deep}</style>{}{RECT}{}", groups.0, groups.1), [0, 0], "");
    // Rules for classes are looked up.
    let classes: String = (0..20_000).map(|i| format!(".c{i}{{fill:red}}")).collect();
    expect(&format!("<style>{classes}</style>{}", RECT.repeat(500)), [0, 0], "");
    let rules: String = (0..20_000).map(|i| format!("[c{i}]{{fill:red}}")).collect();
    expect(&format!("<style>{rules}</style>{}", RECT.repeat(9000)), [3, 3], "work");
    expect(&format!("<rect width='3' height='4' style='{}'/>", "fill:red;".repeat(90_000)), [3, 3], "work");
    let attributes: String = (0..100_000).map(|i| format!(" a{i}=''")).collect();
    expect(&format!("<rect{attributes}/>"), [3, 3], "work");
    expect(&format!("<style>svg g g rect{{fill:red}}</style><g><g>{RECT}</g></g>"), [0, 0], "");
}

#[test]
fn letters_are_counted() {
    let drawing = |texts: &str| Folder::with(&[("a.svg", &svg(texts))]).whole();
    drawing(&format!("<text y='20'>{}</text>", "Abc ".repeat(30_000))).expect("a.svg", [3, 3], "work");
    expect(&format!("<text y='20'>{}</text>", "<tspan fill='red'>A</tspan>".repeat(28_000)), [3, 3], "work");
    // Below the limits: one long text, and marks stacked on one letter.
    for text in ["Abc ".repeat(5000), format!("A{}", "\u{301}".repeat(29_000))] {
        let folder = drawing(&format!("<text y='20'>{text}</text>"));
        folder.run(&["swirl", "a.svg", "-o", "o.svg"]);
        folder.run(&["render", "a.svg", "-o", "o.png"]);
    }
    let folder = Folder::with(&[]);
    assert_eq!(folder.run(&["text", &"a".repeat(100_000), "-o", "o.svg"]).0, 3);
    folder.run(&["text", &format!("A{}", "\u{301}".repeat(19_000)), "-o", "o.svg"]);
}

#[test]
fn text_that_is_named_again_shows_nothing() {
    let expect =
        |body: &str, codes, words| Folder::with(&[("a.svg", &svg(body))]).ample().expect("a.svg", codes, words);
    let text = |letters: usize| format!("<text id='t' y='9'>{}</text>", "abc".repeat(letters / 3));
    let again = |n: usize| format!("<text y='20'>{}</text>", "<tref href='#t'/>".repeat(n));
    expect(&format!("{}{}", text(900), again(3000)), [0, 0], "");
    expect(&format!("{}{}", text(3000), again(1).repeat(30)), [0, 0], "");
    expect(&format!("{}{}{}", RECT.repeat(9000), text(3), again(1).repeat(3000)), [0, 0], "");
    let used = "<use href='#u'/>".repeat(200);
    expect(&format!("{}<g id='u'>{}</g>{used}", text(300), again(1)), [0, 0], "");
}

/// Fonts are searched once for each of the letters, and none has them.
#[test]
fn letters_that_no_font_has_are_looked_up_once() {
    let letters = ('\u{a000}'..'\u{a400}').cycle().take(9000);
    let texts: String = letters.map(|c| format!("<text>{c}</text>")).collect();
    let folder = Folder::with(&[("a.svg", &svg(&texts))]);
    folder.run(&["swirl", "a.svg", "-o", "o.svg"]);
    folder.run(&["render", "a.svg", "-o", "o.png"]);
}
