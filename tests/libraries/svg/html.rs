//! Labels in HTML with a text beside them in a `switch`, as draw.io writes them. A browser shows how they look in `tests/browser`.

use pathwarp::kurbo::Affine;
use pathwarp_oracle::drawings::{Bend, Hidden, drawing, oblique, read, rendered, warp_options};
use pathwarp_svg::usvg_tree::tree;
use pathwarp_svg::{Selection, Structure};

/// Returns a label with this HTML.
fn label(html: &str) -> String {
    format!(
        "<switch><foreignObject id='h' width='100%' height='100%' style='overflow:visible'><div \
         xmlns='http://www.w3.org/1999/xhtml' style='display:flex;align-items:center;justify-content:center;width:80px;height:1px;\
         padding-top:40px;margin-left:10px'><div style='font-size:0;text-align:center'><div style='display:inline-block;font-size:12px;\
         color:#a00'>{html}</div></div></div></foreignObject><text id='t' x='50' y='44' fill='#0000ff' font-size='12' \
         text-anchor='middle'>Lamp...</text></switch>"
    )
}

/// The text holds all words, and replaces both.
#[test]
fn bent_labels_are_text() {
    let body = label("Lamp<br/>plugged <b>in</b>?");
    for structure in [Structure::Keep, Structure::Flatten] {
        let w = read(&drawing(&body)).warp(&Bend, &warp_options().with_structure(structure)).unwrap();
        assert!(w.skipped.is_empty(), "{:?}", w.skipped);
        assert!(!w.svg.contains("foreignObject") && !w.svg.contains("Lamp..."), "{}", w.svg);
        let seen = rendered(tree(&read(&w.svg)), 100, Affine::IDENTITY);
        let colors = seen.pixels().iter().filter(|p| p.alpha() > 200);
        assert!(colors.clone().count() > 20 && colors.clone().all(|p| p.red() > 100 && p.blue() == 0), "{}", w.svg);
    }
    let w = read(&drawing(&body)).warp(&Bend, &warp_options().with_structure(Structure::Keep)).unwrap();
    assert!(w.svg.contains("Lamp plugged in?"), "{}", w.svg);
    // Two lines of twelve px about the middle of the label, (50, 40).
    let bounds = read(&drawing(&body)).artwork_box(&Selection::default()).unwrap();
    let [center, height] = [bounds.center().distance((50.0, 40.0).into()), bounds.height()];
    assert!(center < 3.0 && (17.0..28.0).contains(&height), "{bounds:?}");
}

#[test]
fn affine_maps_transform_the_html() {
    let w = read(&drawing(&format!("<g transform='scale(2)'>{}</g>", label("Lamp"))))
        .warp(&Hidden(oblique()), &warp_options().with_structure(Structure::Keep));
    assert!(!w.unwrap().svg.contains("foreignObject"), "a map that may be any");
    let map = pathwarp::map::AffineMap(oblique());
    let doc = read(&drawing(&format!("<g transform='scale(2)'>{}</g>", label("Lamp"))));
    let w = doc.warp(&map, &warp_options().with_structure(Structure::Keep)).unwrap();
    let tag = w.svg.split("<foreignObject").nth(1).and_then(|t| t.split('>').next()).unwrap();
    let list = tag.split("matrix(").nth(1).and_then(|t| t.split(')').next()).unwrap();
    let list: Vec<f64> = list.split(' ').map(|v| v.parse().unwrap()).collect();
    let wanted = Affine::scale(0.5) * oblique() * Affine::scale(2.0);
    let near = wanted.as_coeffs().iter().zip(&list).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near && w.skipped.is_empty(), "{tag}: {wanted:?}");
    assert!(w.svg.contains("plugged") || w.svg.contains("Lamp"), "{}", w.svg);
}

#[test]
fn what_html_has_beyond_text_is_named() {
    for (html, what) in [
        ("a <img src='x.png'/> b", "<img>"),
        ("<span style='background-color:#ff0'>a</span>", "background-color: #ff0"),
        ("<ul><li>a</li></ul>", "marks of a list"),
        ("<table><tr><td>a</td></tr></table> b", "<table>"),
    ] {
        let w = read(&drawing(&label(html))).warp(&Bend, &warp_options()).unwrap();
        assert!(w.skipped.iter().any(|s| s.id == "t" && s.why.contains(what)), "{html}: {:?}", w.skipped);
    }
    // HTML without words, or without a text beside it, is left unchanged.
    let alone = "<path d='M10 10h50v50z'/><foreignObject id='h' width='9' height='9'><p xmlns='http://www.w3.org/1999/xhtml'>a</p>\
                 </foreignObject>";
    let w = read(&drawing(alone)).warp(&Bend, &warp_options()).unwrap();
    assert!(w.skipped.iter().any(|s| s.id == "h" && s.why.contains("HTML")), "{:?}", w.skipped);
}

#[test]
fn what_is_not_selected_stays() {
    let body = format!("<path id='p' d='M10 10h50v50z'/>{}", label("Lamp<br/>plugged in?"));
    let only = Selection { select: vec!["#p".into()], ..Selection::default() };
    let w = read(&drawing(&body)).warp(&Bend, &warp_options().with_selection(only)).unwrap();
    assert!(w.svg.contains(&label("Lamp<br/>plugged in?")), "{}", w.svg);
}

/// The text written for HTML is in proportion to it, though each element inherits properties of all around it.
#[test]
fn labels_do_not_grow_without_end() {
    let wide = format!("font-family:{}", "A".repeat(2000));
    let nested = "<span style='color:red;font-weight:bold'>".repeat(60);
    let inside = format!("<b style='{wide}'>a</b><i>b</i> ").repeat(100);
    let html = format!("{nested}{inside}{}", "</span>".repeat(60));
    let doc = read(&drawing(&label(&html)));
    assert!(doc.text().len() < 2 * html.len(), "{} for {}", doc.text().len(), html.len());
}
