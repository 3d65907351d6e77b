//! Reports content that cannot be warped, and repairs small faults of a file.

use pathwarp_oracle::drawings::{Bend, drawing, options, read, same, warp_options};
use pathwarp_svg::{Document, Selection, Structure, WarpedDocument};

fn bent(body: &str) -> WarpedDocument {
    read(&drawing(body)).warp(&Bend, &warp_options()).unwrap()
}

const REST: &str = "<path id='p' d='M10 10h50v50z'/>";
const MESH: &str = "<defs><meshgradient id='m' gradientUnits='userSpaceOnUse' x='20' y='20'><meshrow><meshpatch><stop \
                    path='c 20,0 40,0 60,0' stop-color='red'/><stop path='c 0,20 0,40 0,60' stop-color='white'/><stop \
                    path='c -20,0 -40,0 -60,0' stop-color='blue'/><stop path='c 0,-20 0,-40 0,-60' \
                    stop-color='green'/></meshpatch></meshrow></meshgradient><meshgradient id='broken'><meshrow/></meshgradient><hatch id='h'/></defs>";

#[test]
fn what_the_renderer_does_not_know_is_reported() {
    for (content, id, why) in [
        (
            "<flowRoot id='f'><flowRegion><rect width='50' height='50'/></flowRegion><flowPara>A</flowPara></flowRoot>",
            "f",
            "flow",
        ),
        (
            "<foreignObject id='o' width='9' height='9'><p xmlns='http://www.w3.org/1999/xhtml'>p</p></foreignObject>",
            "o",
            "HTML",
        ),
        ("<rect id='r' width='9' height='9' style='fill:url(#broken)'/>", "r", "its fill, a mesh gradient"),
        (
            "<g stroke='url(\"#broken\")'><rect id='r' width='9' height='9' fill='red'/></g>",
            "r",
            "its stroke, a mesh gradient",
        ),
        ("<rect id='r' width='9' height='9' class='k'/><style>.k{fill:url(#h)}</style>", "r", "its fill, a hatch"),
    ] {
        let body = format!("{MESH}{content}{REST}");
        for structure in [Structure::Auto, Structure::Flatten] {
            let w = read(&drawing(&body)).warp(&Bend, &warp_options().with_structure(structure)).unwrap();
            let [s] = w.skipped.as_slice() else { panic!("{content}: {:?}", w.skipped) };
            assert!(s.id == id && s.why.contains(why), "{s:?}");
            assert_eq!(s.why.contains("left out"), structure == Structure::Flatten);
            assert!(!w.svg.contains("M10 10h50"), "{}", w.svg);
        }
        // Content that is not selected is not reported.
        let only = Selection { select: vec!["#p".into()], ..Selection::default() };
        let w = read(&drawing(&body)).warp(&Bend, &warp_options().with_selection(only)).unwrap();
        assert!(w.skipped.is_empty(), "{:?}", w.skipped);
    }
    // Private data of an editor, and definitions, are not shown.
    let body = "<switch><foreignObject requiredExtensions='urn:x' width='1' height='1'/><path d='M0 0h9v9z'/></switch>";
    let w = bent(&format!("{MESH}<defs><rect fill='url(#h)' width='9' height='9'/></defs>{body}{REST}"));
    assert!(w.skipped.is_empty(), "{:?}", w.skipped);
}

/// Illustrator would show the private data that it stored beside the artwork.
#[test]
fn private_data_of_illustrator_is_reported() {
    let namespace = "http://ns.adobe.com/AdobeIllustrator/10.0/";
    let body =
        format!("<switch><foreignObject requiredExtensions='{namespace}' width='1' height='1'/><g>{REST}</g></switch>");
    let told = |w: &WarpedDocument| w.warnings.iter().filter(|w| w.to_string().contains("i:pgf")).count();
    assert_eq!(told(&bent(&body)), 1);
    assert_eq!(told(&bent(&body.replace(namespace, "urn:x"))), 0);
    // Nothing has changed.
    let none = Selection { exclude: vec!["#p".into()], ..Selection::default() };
    let kept = read(&drawing(&body)).warp(&Bend, &warp_options().with_selection(none)).unwrap();
    assert_eq!(told(&kept), 0);
}

/// Editors know their prefixes; the result declares them.
#[test]
fn undeclared_prefixes_are_declared() {
    let body = "<g id='g' inkscape:label='Layer' foo:bar='1'><path id='p' sodipodi:type='star' d='M10 10h50v50z'/><use \
                xlink:href='#p' x='20'/></g>";
    let bare = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>");
    let d = Document::read(bare.as_bytes(), "bare.svg", &options()).unwrap();
    let w = d.warp(&Bend, &warp_options()).unwrap();
    assert!(w.warnings.iter().any(|w| w.to_string().contains("foo, inkscape, sodipodi, xlink")), "{:?}", w.warnings);
    assert!(w.svg.contains("inkscape:label='Layer'") && !w.svg.contains("sodipodi:type"), "{}", w.svg);
    let declared =
        drawing(body).replace("<svg ", "<svg xmlns:foo='urn:x' xmlns:inkscape='urn:y' xmlns:sodipodi='urn:z' ");
    same("prefixes", &w.svg, &read(&declared).warp(&Bend, &warp_options()).unwrap().svg);
    // Anything else stays an error.
    assert!(Document::read(bare.replace("</g>", "").as_bytes(), "bad.svg", &options()).is_err());
}

#[test]
fn lines_of_a_text_stay_words_apart() {
    let role = "xmlns:sodipodi='http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd' sodipodi:role='line'";
    for (text, words) in [
        (
            format!("<tspan {role} x='1'>Hello</tspan><tspan {role} x='1'>my <tspan>w</tspan>orld</tspan>"),
            "Hello my world",
        ),
        ("<tspan x='1' y='9'>Hello</tspan><tspan x='1' y='19'>world</tspan>".into(), "Hello world"),
        ("Hello<tspan x='1' dy='1.2em'>world</tspan>".into(), "Hello world"),
        ("<tspan x='1' y='9'>H</tspan><tspan x='9' y='9'>i</tspan><tspan dy='-2'>2</tspan>".into(), "Hi2"),
        ("A<tspan x='9' dy='0'>B</tspan><title>not this</title><tspan x='1' y='20'>C</tspan>".into(), "AB C"),
    ] {
        let w = bent(&format!("<text id='t' y='9' font-size='9'>{text}</text>"));
        assert!(w.svg.contains(&format!("aria-label=\"{words}\"")), "{words}: {}", w.svg);
    }
}

/// Differences in Chromium are reported for results, and for drawings that are only drawn or converted.
#[test]
fn what_browsers_show_otherwise_is_said() {
    const LINES: &str = "a tspan with y";
    for (text, note, is_said) in [
        ("<text id='t' y='30' text-decoration='overline'>a</text>", "overlines", true),
        ("<text y='30'>a<tspan id='t' xml:space='preserve'> b</tspan></text>", "spaces", true),
        ("<text id='t' y='30' letter-spacing='5%'>a b</text>", "spacing in per cent", true),
        ("<text y='30' text-anchor='end'>a<tspan id='t' y='60'>b</tspan></text>", LINES, true),
        ("<text y='30'>a<tspan id='t' y='60'>b</tspan></text>", LINES, false),
        ("<text y='30' text-anchor='end'>a<tspan id='t' x='9' y='60'>b</tspan></text>", LINES, false),
    ] {
        let body = format!("{text}{REST}");
        let warnings: Vec<String> = bent(&body).warnings.iter().map(ToString::to_string).collect();
        for all in [read(&drawing(&body)).notes(), warnings] {
            let found = all.iter().any(|w| w.starts_with(note) && w.ends_with(": t"));
            assert_eq!(found, is_said, "{text}: {all:?}");
        }
    }
    let svg = drawing(&format!("<text id='t' y='30' baseline-shift='super'>a</text>{REST}"));
    assert!(
        matches!(read(&svg).undrawn().as_slice(), [why] if why.starts_with("t is drawn only without “baseline-shift"))
    );
}
