//! Style that usvg does not read: some of it stays in the file, and the rest is reported. `tests/hosts/styles.rs` compares its looks with
//! a browser.

use pathwarp::budget::Limit;
use pathwarp::kurbo::Affine;
use pathwarp::map::AffineMap;
use pathwarp_oracle::drawings::{Bend, Hidden, drawing, oblique, options, read, rendered, warp_options};
use pathwarp_svg::usvg_tree::tree;
use pathwarp_svg::{Document, Selection, Structure, TextMode, WarpedDocument};

fn bent(body: &str) -> WarpedDocument {
    read(&drawing(body)).warp(&Bend, &warp_options()).unwrap()
}

#[test]
fn what_is_not_warped_keeps_its_style() {
    let style = "<style>:root{--c:red}\n.a:not(.b){fill:var(--c);r:9px}</style>";
    let rest =
        "<circle class='a'  style='fill:var(--c);\n x:y' cx='calc(1px)'/><rect id='r' width='2rem'\n height='3'/>";
    let body = format!("{style}<path id='p' style='fill:var(--c)' d='M10 10h50v50z'/>{rest}");
    let svg = drawing(&body);
    let only = Selection { select: vec!["#p".into()], ..Selection::default() };
    let w = read(&svg).warp(&Bend, &warp_options().with_selection(only)).unwrap();
    assert!(w.svg.contains(style) && w.svg.contains(rest), "{}", w.svg);
    assert!(w.svg.contains("<path id='p' style='fill:var(--c)' d='M"), "{}", w.svg);
    // Nothing moves, so nothing changes.
    let w = read(&svg).warp(&AffineMap(Affine::IDENTITY), &warp_options()).unwrap();
    assert_eq!(w.svg, svg);
    let text = drawing(&format!("{style}<text class='a' style='direction:rtl' x='9' y='50'>abc</text>"));
    let w = read(&text).warp(&Bend, &warp_options().with_text(TextMode::Skip)).unwrap();
    assert_eq!(w.svg, text);
}

#[test]
fn shapes_with_lengths_of_style_sheets_become_paths() {
    let w = bent("<style>.a{cx:30px;cy:calc(20px * 2);r:15px}</style><circle id='c' class='a' r='3'/>");
    assert!(
        w.svg.contains("<path id='c' class='a' d='M") || w.svg.contains("<path id='c' class='a' d=\"M"),
        "{}",
        w.svg
    );
    assert_eq!(w.shapes.len(), 1);
}

/// Boxes change, so a transform about the centre of its shape would have another effect afterwards.
#[test]
fn transforms_of_style_sheets_are_frozen() {
    let body = "<style>.a{transform:rotate(90deg);transform-box:fill-box;transform-origin:center}</style>\
                <rect class='a' x='20' y='20' width='40' height='20'/>";
    let w = read(&drawing(body)).warp(&Hidden(oblique()), &warp_options()).unwrap();
    for kept in ["transform:matrix(", "transform-origin:0 0", "transform-box:view-box"] {
        assert!(w.svg.contains(kept), "{}", w.svg);
    }
    let plain = "<rect transform='rotate(90 40 30)' x='20' y='20' width='40' height='20'/>";
    let plain = read(&drawing(plain)).warp(&Hidden(oblique()), &warp_options()).unwrap();
    let area = |svg: &str| read(svg).artwork_box(&Selection::default()).unwrap();
    let (a, b) = (area(&w.svg), area(&plain.svg));
    assert!(
        (a.x0 - b.x0).abs() + (a.y0 - b.y0).abs() + (a.x1 - b.x1).abs() + (a.y1 - b.y1).abs() < 1e-3,
        "{a:?} {b:?}"
    );
}

/// A spinner turns about its centre, even where that has moved.
#[test]
fn origins_of_animations_stay() {
    let css =
        "@keyframes k{to{transform:rotate(1turn)}}.a{animation:k 3s;transform-box:fill-box;transform-origin:center}";
    let w = bent(&format!("<style>{css}</style><path class='a' d='M10 10h40v40z'/>"));
    assert!(w.svg.contains("<path class='a' d='") && !w.svg.contains("style="), "{}", w.svg);
}

#[test]
fn frozen_transforms_win_over_important_ones() {
    let css = ".a{transform:rotate(9deg)!important;transform-origin:50% 50%}";
    let w = bent(&format!("<style>{css}</style><path class='a' d='M10 10h40v40z'/>"));
    assert!(w.svg.contains("transform-origin:0 0 !important") && w.svg.contains(") !important"), "{}", w.svg);
}

#[test]
fn path_data_of_style_sheets_are_bent() {
    let w =
        bent("<style>path{d:path('M10 10H40V40z')}</style><path id='s' d='M0 0H9V8z'/><circle cx='50' cy='50' r='9'/>");
    assert!(w.skipped.is_empty() && w.svg.matches("d:path('M").count() == 3, "{}", w.svg);
}

#[test]
fn what_is_not_supported_is_reported() {
    let shape = "id='s' x='10' y='10' width='40' height='40'";
    for (content, why) in [
        (format!("<rect {shape} style='clip-path:circle(9px)'/>"), "clip-path: circle(9px)"),
        (format!("<rect {shape} clip-path='inset(2px)'/>"), "clip-path: inset(2px)"),
        (format!("<style>rect{{offset-path:path('M0 0L9 9')}}</style><rect {shape}/>"), "offset-path"),
        (format!("<rect {shape} style='transform:rotateX(40deg)'/>"), "transform"),
    ] {
        let w = bent(&content);
        let [s] = w.skipped.as_slice() else { panic!("{content}: {:?}", w.skipped) };
        assert!(s.id == "s" && s.why.contains(why), "{s:?}");
        let flat = warp_options().with_structure(Structure::Flatten);
        let w = read(&drawing(&content)).warp(&Bend, &flat).unwrap();
        assert!(w.skipped.iter().all(|s| !s.why.contains("left out")) && w.svg.contains("<path"), "{:?}", w.skipped);
    }
    let w = bent("<style>@import 'x.css'; a:foo(1){fill:red}</style><rect width='9' height='9'/>");
    let said: Vec<String> = w.warnings.iter().map(ToString::to_string).collect();
    assert!(said.iter().any(|s| s.contains("@import") && s.contains("a:foo(1)")), "{said:?}");
    // Ordinary drawings are not reported.
    let w = bent("<style>.a{fill:red}</style><rect class='a' style='clip-path:none' width='9' height='9'/>");
    assert!(w.warnings.is_empty() && w.skipped.is_empty(), "{:?}", w.warnings);
}

/// Colours that are not understood are named, and drawn in black.
#[test]
fn colours_that_are_not_understood_are_black() {
    for (content, said) in [
        (
            "<path id='s' d='M10 50h50' fill='none' stroke='future(1 2 3)' stroke-width='9'/>",
            "black in place of “stroke: future(1 2 3)”",
        ),
        (
            "<path id='s' d='M10 40h50v20h-50z' style='fill:color-mix(in nowhere, red, blue)'/>",
            "black in place of “fill: color-mix(",
        ),
        (
            "<style>#s{stroke:future(1);stroke-width:9px}</style><path id='s' d='M10 50h50'/>",
            "black in place of “stroke: future(1)”",
        ),
        (
            "<path id='s' d='M10 40h50v20h-50z' fill='#000001' style='fill:future(1)'/>",
            "another declaration in place of “fill: future(1)”",
        ),
    ] {
        let w = bent(content);
        let [s] = w.skipped.as_slice() else { panic!("{content}: {:?}", w.skipped) };
        assert!(s.id == "s" && s.why.contains(said), "{s:?}");
        let seen = rendered(tree(&read(&drawing(content))), 100, Affine::IDENTITY).pixel(30, 50).unwrap();
        let blue = u8::from(said.starts_with("another"));
        assert_eq!([seen.red(), seen.green(), seen.blue(), seen.alpha()], [0, 0, blue, 255], "{content}");
    }
    // A word that is no colour has no effect, as in browsers.
    let w = bent("<path id='s' d='M10 50h50v9z' stroke='nothing' fill='12px'/>");
    assert!(w.skipped.is_empty(), "{:?}", w.skipped);
}

#[test]
fn texts_keep_their_words() {
    let text =
        "<text id='t' x='10' y='50' style='text-transform:uppercase;direction:rtl'>one <tspan>two</tspan></text>";
    let svg = drawing(&format!("<path id='p' d='M10 10h50v50z'/>{text}"));
    let only = Selection { select: vec!["#p".into()], ..Selection::default() };
    let w = read(&svg).warp(&Bend, &warp_options().with_selection(only)).unwrap();
    assert!(w.svg.contains(text), "{}", w.svg);
    let w = read(&svg).warp(&Bend, &warp_options()).unwrap();
    assert!(w.svg.contains("aria-label=\"one two\"") && w.svg.is_ascii() && !w.svg.contains("ONE"), "{}", w.svg);
    assert!(w.skipped.is_empty(), "{:?}", w.skipped);
}

#[test]
fn fonts_go_by_their_full_names() {
    let text = |family: &str| format!("<text x='10' y='50' font-family='{family}'>Name</text>");
    for family in ["Noto Sans", "noto sans", "NotoSans-Regular", "Noto Sans Regular", "system-ui"] {
        let w = bent(&text(family));
        assert!(w.warnings.is_empty(), "{family}: {:?}", w.warnings);
    }
    let w = bent(&text("Nota Sans"));
    assert!(w.warnings.iter().any(|w| w.to_string().contains("Nota Sans")), "{:?}", w.warnings);
}

#[test]
fn style_of_text_without_effect_is_reported() {
    let small = |style: &str| bent(&format!("<g style='{style}'><text id='s' x='10' y='50'>abc</text></g>"));
    for style in [
        "font-variant:petite-caps",
        "font-feature-settings:&quot;ss01&quot;",
        "text-shadow:1px 1px red",
        "text-orientation:upright",
        "text-transform:full-width",
    ] {
        let w = small(style);
        assert!(w.skipped.iter().any(|s| s.why.contains(style.split(':').next().unwrap())), "{style}: {:?}", w.skipped);
    }
    // Properties that Inkscape writes for any text.
    let w = small(
        "font-variant-ligatures:normal;font-variant-caps:normal;font-variant-numeric:normal;text-decoration-line:none;\
                   font-feature-settings:normal;text-decoration-style:solid;text-orientation:mixed;text-transform:none;\
                   direction:ltr;white-space:normal;text-anchor:start;font-stretch:normal",
    );
    assert!(w.skipped.is_empty(), "{:?}", w.skipped);
    // Single letters have positions, which combining marks would move.
    let w = bent("<text id='s' x='10 20 30' y='50' direction='rtl'>abc</text>");
    assert!(w.skipped.iter().any(|s| s.why.contains("left to right")), "{:?}", w.skipped);
}

/// A few bytes can cause much work: selectors that try every way through the tree, variables that multiply, rules that apply to all.
#[test]
fn style_ends_by_the_budget() {
    let deep = format!("<style>x {}:not(.a){{fill:red}}</style>", "* ".repeat(20));
    let nested = format!("{deep}{}<rect/>{}", "<g>".repeat(60), "</g>".repeat(60));
    let many = format!("<style>{}</style>{}", "rect:not(.a){fill:red}".repeat(5_000), "<rect/>".repeat(5_000));
    let siblings = format!("<style>a ~ b ~ c ~ rect{{fill:red}}</style>{}", "<rect/>".repeat(20_000));
    let nth = format!(
        "<style>rect:nth-last-child(3n of .a), rect:nth-child(2){{fill:red}}</style>{}",
        "<rect/>".repeat(20_000)
    );
    for body in [nested, many, siblings, nth] {
        let read = Document::read(drawing(&body).as_bytes(), "t", &options());
        if let Err(e) = read {
            assert!(e.to_string().contains(&Limit::Work.to_string()), "{e}");
        }
    }
    let mut rules = "--0:xxxxxxxxxxxxxxxx;".to_owned();
    (1..60).for_each(|i| rules += &format!("--{i}:var(--{0})var(--{0});", i - 1));
    let svg = drawing(&format!("<style>rect{{{rules}stroke:var(--59)}}</style>{}", "<rect/>".repeat(3_000)));
    let _ = Document::read(svg.as_bytes(), "t", &options());
}
