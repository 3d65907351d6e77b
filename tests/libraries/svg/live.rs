//! Attributes from which Inkscape computes a shape: warped shapes lose them, everything else keeps them.

use pathwarp_oracle::drawings::{Bend, read, warp_options};
use pathwarp_svg::{Selection, Strokes, Structure, WarpOptions};

fn document(body: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' xmlns:ink=\
         'http://www.inkscape.org/namespaces/inkscape' xmlns:old='http://inkscape.sourceforge.net/DTD/sodipodi-0.dtd' \
         xmlns:other='urn:other' viewBox='0 0 100 100'>{body}</svg>"
    )
}

fn bent(body: &str, options: &WarpOptions) -> String {
    read(&document(body)).warp(&Bend, options).unwrap().svg
}

fn only(name: &str) -> WarpOptions {
    warp_options().with_selection(Selection { select: vec![name.into()], ..Selection::default() })
}

/// Every attribute of a live shape, as on a star that is also a connector with a path effect, and attributes that only look alike.
const LIVE: &str = "old:type='star' old:cx='5' old:sides='5' old:arg1='.5' old:nodetypes='ccc' ink:flatsided='true' \
                    ink:path-effect='#e' ink:original-d='M0 0' ink:connector-type='polyline' \
                    ink:connection-start='#k' ink:transform-center-x='3' ink:tiled-clone-of='#k' ink:box3dsidetype='6'";
const KEPT: [&str; 5] = [
    "ink:label='sides'",
    "old:insensitive='true'",
    "ink:export-xdpi='96'",
    "other:type='star'",
    "other:path-effect='#e'",
];

#[track_caller]
fn is_plain(svg: &str) {
    let live = svg.contains("old:") && svg.replace("old:insensitive", "").replace("xmlns:old", "").contains("old:");
    let words =
        ["path-effect='#e' ink", "ink:path", "original-d", "connect", "center", "clone-of", "box3d", "flatsided"];
    assert!(!live && !words.iter().any(|w| svg.contains(w)), "{svg}");
}

#[test]
fn a_warped_shape_is_a_plain_path() {
    let all = KEPT.join(" ");
    let shape = format!("<path id='a' {LIVE} {all} d='M10 10H90V60z' fill='red' stroke='blue' stroke-width='9'/>");
    let rect = format!("<rect id='r' {LIVE} {all} width='50' height='40'/>");
    let clip = format!("<clipPath id='c'>{shape}</clipPath><rect id='r' width='90' height='80' clip-path='url(#c)'/>");
    let mask = format!("<mask id='m'>{shape}</mask><rect id='r' width='90' height='80' mask='url(#m)'/>");
    let copy = format!("<defs><path id='d' d='M0 0h40v40z'/></defs><use id='u' xlink:href='#d' {LIVE} {all}/>");
    let text = format!("<text id='t' y='50' {LIVE} {all}>A<tspan id='s' {LIVE} {all}>B</tspan></text>");
    let marker = "<marker id='k' markerWidth='3' markerHeight='3'><path d='M0 0h3v3z'/></marker>";
    let marked = format!("{marker}{}", shape.replace("fill", "marker-start='url(#k)' fill"));
    for body in [shape.clone(), rect, clip, mask, copy, text, marked] {
        for strokes in [Strokes::Auto, Strokes::Outline, Strokes::Keep] {
            let options = warp_options().with_strokes(strokes);
            let svg = bent(&body, &options);
            is_plain(&svg);
            assert!(KEPT[..3].iter().all(|k| svg.contains(k)), "{svg}");
            is_plain(&bent(&body, &options.with_structure(Structure::Flatten)));
        }
    }
    // In place, even attributes that merely look alike stay.
    let svg = bent(&shape, &warp_options().with_strokes(Strokes::Outline));
    assert!(svg.contains("<g id='a'") && KEPT.iter().all(|k| svg.contains(k)), "{svg}");
}

/// A rectangle with a path effect is a `path` with the attributes of a `rect`, and a linked offset has a link.
#[test]
fn attributes_of_the_live_shape_go_with_it() {
    let body = "<path id='a' old:type='rect' x='1' y='2' width='50' height='40' rx='3' d='M1 2H51V42z'/><path id='b' \
                old:type='inkscape:offset' xlink:href='#a' ink:href='#a' ink:radius='3' d='M0 0H51V42z'/>";
    let svg = bent(body, &warp_options());
    assert!(svg.contains("<path id='a' d='M") && svg.contains("<path id='b' d='M"), "{svg}");
}

#[test]
fn groups_around_what_is_warped_are_plain_too() {
    let body = "<g id='g' ink:path-effect='#e' ink:label='layer' ink:groupmode='layer'><g id='b' \
                old:type='inkscape:box3d' ink:perspectiveID='#p' ink:corner0='0'><path id='a' \
                old:type='inkscape:box3dside' ink:box3dsidetype='6' d='M10 10H90V60z'/><path id='c' \
                old:type='inkscape:box3dside' ink:box3dsidetype='5' d='M0 0H9V60z'/></g><path id='d' ink:original-d='M0 0' \
                d='M0 0H9V6z'/><path id='f' ink:path-effect='#f' ink:original-d='M0 0' d='M0 0H9V6z'/></g><path id='h' \
                old:type='star' d='M0 0H9V6z'/>";
    let svg = bent(body, &only("#a"));
    for kept in [
        "<g id='g' ink:label='layer' ink:groupmode='layer'>",
        "<g id='b'>",
        "<path id='a' d='M",
        // Not warped, but meaningless without the group.
        "<path id='c' d='M0 0H9V60z'/>",
        "<path id='d' d='M0 0H9V6z'/>",
        // Not warped, with a separate effect.
        "<path id='f' ink:path-effect='#f' ink:original-d='M0 0' d='M0 0H9V6z'/>",
        "<path id='h' old:type='star' d='M0 0H9V6z'/>",
    ] {
        assert!(svg.contains(kept), "{kept}\n{svg}");
    }
    assert!(!svg.contains("M10 10H90"), "{svg}");
}

#[test]
fn what_is_not_warped_keeps_everything() {
    let body = format!(
        "<g id='g' ink:path-effect='#e'><path id='a' {LIVE} d='M10 10H90V60z'/></g><path id='b' d='M0 0H9V9z'/>"
    );
    let svg = bent(&body, &only("#b"));
    assert!(svg.contains(body.strip_suffix("<path id='b' d='M0 0H9V9z'/>").unwrap()), "{svg}");
    assert!(!svg.contains("M0 0H9"), "{svg}");
}
