//! Reading files: names, boxes, errors, and malicious files.

use pathwarp::Error;
use pathwarp::budget::{Limit, Limits};
use pathwarp::kurbo::Rect;
use pathwarp::outline::Seg;
use pathwarp_oracle::drawings::{Bend, drawing, options, read, warp_options};
use pathwarp_svg::{Document, Selection};

fn fault(data: &[u8]) -> String {
    let read = Document::read(data, "f.svg", &options());
    assert!(matches!(read, Err(Error::Input { .. })), "{read:?}");
    read.err().map(|e| e.to_string()).unwrap_or_default()
}

#[test]
fn faults_say_where_and_what() {
    assert!(fault(b"<svg xmlns='http://www.w3.org/2000/svg'>\n<g></svg>").starts_with("f.svg:2:"));
    assert!(fault(b"<html/>").contains("<html>"));
    assert!(fault(b"\xff\xfe<\0s\0\x35\xd8").contains("UTF-16"));
    assert!(fault(b"<svg>\xff</svg>").contains("byte 5"));
    assert!(fault(b"\x1f\x8b\x08rubbish").contains("compressed"));
    assert!(fault(b"").starts_with("f.svg:"));
    assert!(fault(b"<svg xmlns='http://www.w3.org/2000/svg' width='0' height='5'/>").contains("size"));
}

#[test]
fn names_are_found_wherever_they_are() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
               viewBox='0 0 100 100'><defs><path id='hidden' d='M0 0L1 1'/></defs><g transform='translate(5 0)'><path \
               id='a' inkscape:label='Cage 1' d='M0 0L10 0' display='none'/><circle id='b' cx='9' cy='9' r='3'><title>Sun\
               </title></circle></g><g id='one'><path d='M0 0L7 0'/></g></svg>";
    let d = read(svg);
    assert_eq!(d.path("#hidden").unwrap().id, "hidden");
    assert_eq!(d.path("Cage 1").unwrap().outline.subpaths[0].end().x, 15.0);
    assert!(matches!(d.path("Sun").unwrap().outline.subpaths[0].segs[0], Seg::Arc(_)));
    assert_eq!(d.path("one").unwrap().outline.subpaths[0].end().x, 7.0);
    let names: Vec<String> = d.paths().into_iter().map(|p| p.id).collect();
    assert_eq!(names[..3], ["hidden", "a", "b"]);
    assert!(names[3].starts_with("path at 1:"));
    let e = d.path("Cgae 1").unwrap_err().to_string();
    assert!(e.contains("f.svg") || e.contains("test.svg#Cgae 1"), "{e}");
    assert!(e.find("Cage 1").unwrap() < e.find("hidden").unwrap(), "{e}");
}

#[test]
fn boxes_are_tight_and_in_user_units() {
    let d = read(
        "<svg xmlns='http://www.w3.org/2000/svg' width='50mm' viewBox='10 0 90 40'><circle cx='50' cy='20' r='10' \
         stroke='red' stroke-width='9'/><path d='M0 0h24v24H0z' fill='none'/><rect width='900' height='9' \
         visibility='hidden'/></svg>",
    );
    assert_eq!(d.view_box(), Rect::new(10.0, 0.0, 100.0, 40.0));
    let b = d.artwork_box(&Selection::default()).unwrap();
    assert!((b.x0 - 40.0).abs() < 1e-12 && (b.y1 - 30.0).abs() < 1e-12, "{b:?}");
    assert!((d.user_to_px().as_coeffs()[0] - 50.0 * 96.0 / 25.4 / 90.0).abs() < 1e-6);
}

#[test]
fn arcs_are_true_also_in_copies() {
    let d = read(&drawing(
        "<defs><circle id='c' r='10'/></defs><use href='#c' x='30' y='30'/><g transform='scale(.1)'><use href='#c'/></g>",
    ));
    assert_eq!(d.shapes().len(), 2);
    for s in d.shapes() {
        assert!(s.outline.segs().all(|g| matches!(g, Seg::Arc(_))), "{:?}", s.outline);
        assert_eq!(s.element, "use");
    }
}

#[test]
fn compressed_files_are_read() {
    use std::io::Write as _;
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gz.write_all(drawing("<path d='M0 0h9v9z'/>").as_bytes()).unwrap();
    let data = gz.finish().unwrap();
    assert_eq!(Document::read(&data, "f.svgz", &options()).unwrap().shapes().len(), 1);
    let small = options().with_max_size(20);
    assert!(Document::read(&data, "f.svgz", &small).is_err());
}

#[test]
fn a_missing_font_is_named() {
    let d = read(&drawing("<text y='50' font-family='Nowhere Sans'>x</text>"));
    let w = d.warp(&Bend, &warp_options()).unwrap();
    assert!(w.warnings.iter().any(|w| w.to_string().contains("Nowhere Sans")), "{:?}", w.warnings);
}

#[test]
fn files_made_to_hurt_end_in_an_error_or_a_drawing() {
    let deep = drawing(&format!("{}<path d='M0 0h9v9z'/>{}", "<g opacity='.9'>".repeat(900), "</g>".repeat(900)));
    let deeper = drawing(&format!("{}{}", "<g>".repeat(100_000), "</g>".repeat(100_000)));
    let bomb: String =
        (0..20).map(|i| format!("<g id='g{}'><use href='#g{i}'/><use href='#g{i}'/></g>", i + 1)).collect();
    let bomb = drawing(&format!("<defs><path id='g0' d='M0 0h9v9z'/>{bomb}</defs><use href='#g20'/>"));
    let loops = drawing(
        "<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g><clipPath id='c' clip-path='url(#c)'><use href='#a'/>\
         </clipPath><rect width='9' height='9' clip-path='url(#c)' mask='url(#m)'/><mask id='m'><rect mask='url(#m)' \
         width='5' height='5'/></mask><linearGradient id='l' href='#l'/><path d='M0 0h9v9z' fill='url(#l)'/>",
    );
    let odd = drawing(
        "<path d='M0 0L1e40 1e40L-1e300 5z'/><path d='M0 0Lnan 5'/><rect width='1e-30' height='1e38'/><g \
         transform='scale(0)'><path d='M0 0h9v9z'/></g><path id='' d='M0 0h9v9z'/><path id='d' d='M0 0h9v9z'/><path \
         id='d' d='M5 0h9v9z'/><use href='#d'/><path/><circle r='-5'/>",
    );
    let circle = drawing(
        "<linearGradient id='a' href='#b'><stop stop-color='red'/><stop offset='1'/></linearGradient><linearGradient id='b' \
         href='#a'><stop stop-color='red'/><stop offset='1'/></linearGradient><path d='M0 0h90v90z' fill='url(#a)'/>",
    );
    for svg in [deep, deeper, bomb, loops, odd, circle] {
        if let Ok(d) = Document::read(svg.as_bytes(), "f.svg", &options()) {
            let options = warp_options().with_on_error(pathwarp_svg::OnError::Skip);
            let w = d.warp(&Bend, &options).unwrap();
            assert!(Document::read(w.svg.as_bytes(), "again.svg", &self::options()).is_ok());
        }
    }
}

/// Each level shows the next one ten times, in all possible ways. It is refused after little work, where usvg alone would take hours.
#[test]
fn what_unfolds_without_end_is_refused_at_once() {
    const LEVELS: usize = 12;
    let fault = |svg: &[u8]| {
        let little = Limits::default().with(Limit::Work, 1e-2 * Limits::default().of(Limit::Work));
        Document::read(svg, "f.svg", &options().with_limits(little)).unwrap_err().to_string()
    };
    let svg = |body: &str| format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>\n{body}</svg>");
    let nest = |open: &str, show: &str, close: &str| {
        let level = |i: usize| {
            let inside = show.replace('#', &format!("#n{}", i + 1)).repeat(10);
            format!("{}{inside}{close}\n", open.replace("id=''", &format!("id='n{i}'")))
        };
        let levels: String = (0..LEVELS).map(level).collect();
        let last = open.replace("id=''", &format!("id='n{LEVELS}'"));
        svg(&format!("{levels}{last}<path d='M0 0L5 5L9 0'/>{close}{}", show.replace('#', "#n0")))
    };
    let pattern = "<pattern id='' width='1' height='1'>";
    let shape = "<path d='M0 0L5 5L9 0' ";
    let nests = [
        nest(pattern, &format!("{shape} fill='url(#)'/>"), "</pattern>"),
        nest(pattern, &format!("{shape} style='stroke:url(#)'/>"), "</pattern>"),
        nest("<symbol id=''>", "<use href='#'/>", "</symbol>"),
        nest("<mask id=''>", &format!("{shape} mask='url(#)'/>"), "</mask>"),
        nest("<clipPath id=''>", &format!("{shape} clip-path='url(#)'/>"), "</clipPath>"),
        nest("<marker id=''>", &format!("{shape} marker-mid='url(#)'/>"), "</marker>"),
    ];
    for n in &nests {
        let e = fault(n.as_bytes());
        assert!(e.contains("expands to more than") && e.contains("`elements`") && e.starts_with("f.svg:"), "{e}");
        // The limits apply to drawings inside drawings, too.
        let coded =
            n.replace('#', "%23").replace('<', "%3c").replace('>', "%3e").replace('\'', "%27").replace('\n', "%0a");
        let e = fault(svg(&format!("<image width='9' height='9' href='data:image/svg+xml,{coded}'/>")).as_bytes());
        assert!(e.contains("expands to more than") && e.contains("`elements`") && e.contains("image"), "{e}");
    }
    // A few levels are an ordinary drawing.
    let few = nests[0].replace("fill='url(#n3)'", "fill='red'");
    assert!(Document::read(few.as_bytes(), "f.svg", &options()).is_ok());
}

#[test]
fn many_deep_drawings_at_once_do_not_wait_for_each_other() {
    use rayon::prelude::*;
    let shapes = "<path d='M0 0C9 9 0 20 30 30z'/>".repeat(120);
    let deep = drawing(&format!("{}{shapes}{}", "<g>".repeat(120), "</g>".repeat(120)));
    let sizes: Vec<usize> =
        (0..16).into_par_iter().map(|_| read(&deep).warp(&Bend, &warp_options()).unwrap().svg.len()).collect();
    assert!(sizes.iter().all(|s| *s == sizes[0]));
}
