//! Adapting the page to the warped artwork. The reference is the set of pixels the renderer paints.

use pathwarp::kurbo::{Affine, Rect};
use pathwarp_oracle::drawings::{Hidden, read, rendered, warp_options};
use pathwarp_oracle::ink;
use pathwarp_svg::{Document, PageFit, Selection};

/// Pixels per unit of a rendering.
const FINE: f64 = 8.0;

fn fitted(svg: &str, map: Affine, page: PageFit) -> Document {
    let w = read(svg).warp(&Hidden(map), &warp_options().with_page(page)).unwrap();
    read(&w.svg)
}

/// Returns the box of everything that a document paints between -60 and 200, in user units, to a pixel.
fn marks(d: &Document) -> Rect {
    let (from, side) = (-60.0, 260.0);
    let window = Affine::scale(FINE) * Affine::translate((-from, -from)) * d.user_to_px().inverse();
    let (all, _) = ink(&rendered(pathwarp_svg::usvg_tree::tree(d), (side * FINE) as u32, window), 0);
    (Affine::translate((from, from)) * Affine::scale(1.0 / FINE)).transform_rect_bbox(all)
}

fn near(a: Rect, b: Rect) -> bool {
    let d = [a.x0 - b.x0, a.y0 - b.y0, a.x1 - b.x1, a.y1 - b.y1];
    d.iter().all(|d| d.abs() <= 1.5 / FINE)
}

/// Names and drawings.
const DRAWINGS: &[(&str, &str)] = &[
    ("a fill", "<path d='M20 20C90 0 80 70 30 60z'/>"),
    ("a stroke with miters", "<path d='M20 70L50 20L60 75' fill='none' stroke='red' stroke-width='8'/>"),
    (
        "markers and a copy",
        "<marker id='m' markerWidth='4' markerHeight='4' refX='2' refY='2'><circle cx='2' cy='2' r='2'/></marker><path id='p' \
         d='M20 70L50 40' stroke='black' stroke-width='5' marker-end='url(#m)'/><use href='#p' x='20' y='-12'/>",
    ),
    (
        "clipped, and nested frames",
        "<clipPath id='c'><circle cx='50' cy='50' r='20'/></clipPath><g transform='translate(5) rotate(12)'><rect \
         width='100' height='100' clip-path='url(#c)'/></g>",
    ),
    ("text", "<text x='20' y='60' font-size='30' stroke='red'>Wig</text>"),
    (
        "an image",
        "<image x='10' y='20' width='60' height='30' preserveAspectRatio='none' xlink:href='data:image/png;base64,\
         iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='/>",
    ),
];

#[test]
fn the_page_becomes_the_marks_box() {
    for (name, body) in DRAWINGS {
        for map in [pathwarp_oracle::drawings::oblique(), Affine::translate((40.0, -30.0)) * Affine::scale(1.3)] {
            let d = fitted(&pathwarp_oracle::drawings::drawing(body), map, PageFit::Page);
            let (page, marks) = (d.view_box(), marks(&d));
            assert!(near(page, marks), "{name}: {page:?} is not {marks:?}");
            assert!(!near(page, Rect::new(0.0, 0.0, 100.0, 100.0)), "{name}");
        }
    }
}

#[test]
fn it_grows_to_hold_them_and_no_further() {
    let whole = Rect::new(0.0, 0.0, 100.0, 100.0);
    for (name, body) in DRAWINGS {
        let d = fitted(&pathwarp_oracle::drawings::drawing(body), Affine::translate((45.0, -35.0)), PageFit::Grow);
        let (page, marks) = (d.view_box(), marks(&d));
        assert!(near(page, whole.union(marks)) && !near(page, whole), "{name}: {page:?} for {marks:?}");
        let svg = pathwarp_oracle::drawings::drawing(body);
        let d = fitted(&svg, Affine::rotate_about(0.1, (50.0, 50.0)), PageFit::Grow);
        assert_eq!(d.view_box(), whole, "{name}");
    }
}

/// A filter may paint anywhere in its region. Only the renderer's pixels show how much of it is needed.
#[test]
fn what_a_filter_paints_is_held() {
    let body = "<filter id='f'><feGaussianBlur stdDeviation='3'/></filter><rect x='30' y='30' width='30' height='30' \
                filter='url(#f)'/>";
    let d = fitted(&pathwarp_oracle::drawings::drawing(body), pathwarp_oracle::drawings::oblique(), PageFit::Page);
    let (page, marks) = (d.view_box(), marks(&d));
    assert!(near(page.union(marks), page), "{page:?} does not hold {marks:?}");
}

#[test]
fn lengths_follow_and_the_scale_stays() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='50mm' height='100mm' viewBox='0 0 100 200'><rect x='20' y='30' \
               width='60' height='40'/></svg>";
    let page =
        |svg: &str, page| read(svg).warp(&Hidden(Affine::scale(2.0)), &warp_options().with_page(page)).unwrap().svg;
    let out = page(svg, PageFit::Page);
    assert!(out.contains("width='60mm' height='40mm' viewBox='40 60 120 80'"), "{out}");
    let out = page(svg, PageFit::Grow);
    assert!(out.contains("width='80mm' height='100mm' viewBox='0 0 160 200'"), "{out}");
    assert!(page(svg, PageFit::None).contains("width='50mm' height='100mm' viewBox='0 0 100 200'"));
    let out = page(&svg.replace("50mm", "100%").replace("100mm", "100%"), PageFit::Page);
    assert!(out.contains("width='100%' height='100%' viewBox='40 60 120 80'"), "{out}");
    // The page of a file without viewBox is its width and height.
    let plain =
        "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='2in'><rect x='20' width='60' height='40'/></svg>";
    let out = page(plain, PageFit::Page);
    assert!(out.contains("width='120'") && out.contains("viewBox=\"40 0 120 80\""), "{out}");
    let d = read(&out);
    assert!((d.size_px().width - 120.0).abs() < 1e-3 && (d.size_px().height - 80.0).abs() < 1e-3, "{:?}", d.size_px());
}

#[test]
fn guides_and_what_is_hidden_do_not_count() {
    let body = "<rect x='20' y='30' width='60' height='40'/><path id='cage' d='M-50 0H150'/><rect x='-90' width='9' \
                height='9' visibility='hidden'/><path d='M-80 0h9v9z' fill='none'/>";
    let selection = Selection { guides: vec!["cage".into()], ..Selection::default() };
    let options = warp_options().with_page(PageFit::Page).with_selection(selection);
    let w =
        read(&pathwarp_oracle::drawings::drawing(body)).warp(&Hidden(Affine::translate((5.0, 0.0))), &options).unwrap();
    assert!(w.svg.contains("viewBox=\"25 30 60 40\""), "{}", w.svg);
}

/// Returns the distances by which pixels extend past the page of 0 to 100: left, top, right, bottom.
fn beyond(marks: Rect) -> [f64; 4] {
    [-marks.x0, -marks.y0, marks.x1 - 100.0, marks.y1 - 100.0]
}

#[test]
fn what_leaves_the_page_is_measured() {
    for (name, body) in DRAWINGS {
        let svg = pathwarp_oracle::drawings::drawing(body);
        for map in [Affine::translate((45.0, -35.0)), Affine::translate((-50.0, 52.0))] {
            let w = read(&svg).warp(&Hidden(map), &warp_options()).unwrap();
            let out = beyond(marks(&read(&w.svg)));
            let by = w.overhang.unwrap_or_else(|| panic!("{name}: {out:?} is not seen")).by;
            for (told, true_one) in by.iter().zip(out) {
                assert!((told - true_one.max(0.0)).abs() < 1.5 / FINE, "{name}: {by:?} is not {out:?}");
            }
            let share = out.into_iter().fold(0.0, f64::max) / 100.0;
            assert!((w.overhang.unwrap().share - share).abs() < 0.01, "{name}");
            let grown = warp_options().with_page(PageFit::Grow);
            assert_eq!(read(&svg).warp(&Hidden(map), &grown).unwrap().overhang, None, "{name}");
        }
        let still = read(&svg).warp(&Hidden(Affine::rotate_about(0.1, (50.0, 50.0))), &warp_options()).unwrap();
        assert_eq!(still.overhang, None, "{name}");
    }
}

#[test]
fn what_left_the_page_before_is_not_told() {
    let moved = |svg: &str, x: f64, y: f64| {
        let w = read(svg).warp(&Hidden(Affine::translate((x, y))), &warp_options()).unwrap();
        w.overhang.map(|o| o.by.map(|v| (v * 1e6).round() / 1e6))
    };
    // It extends 30 past the left side, strokes included, and ends 10 inside the right side.
    let body = "<path d='M-28,40H88' stroke='black' stroke-width='4' stroke-linecap='square'/>";
    let svg = pathwarp_oracle::drawings::drawing(body);
    assert_eq!(moved(&svg, 5.0, 0.0), None);
    assert_eq!(moved(&svg, 10.0, 3.0), None);
    assert_eq!(moved(&svg, 17.0, 0.0), Some([0.0, 0.0, 7.0, 0.0]));
    // Only artwork that the page showed counts: 5 units of it leave the page.
    assert_eq!(moved(&svg, -5.0, 0.0), Some([5.0, 0.0, 0.0, 0.0]));
    assert_eq!(moved(&svg, 0.0, -50.0), Some([0.0, 12.0, 0.0, 0.0]));
    // Less than a thousandth of the pixels.
    assert_eq!(moved(&svg, 10.05, 0.0), None);
    // A file that does not specify the size of its page has no overhang.
    let endless = format!("<svg xmlns='http://www.w3.org/2000/svg'>{body}</svg>");
    assert_eq!(moved(&endless, 60.0, 0.0), None);
    assert!(moved(&endless.replace("<svg", "<svg width='100' height='100'"), 60.0, 0.0).is_some());
}

/// The page is adapted even if nothing moves.
#[test]
fn the_identity_fits_the_page() {
    let svg = pathwarp_oracle::drawings::drawing("<rect x='20' y='30' width='60' height='40'/>");
    let map = pathwarp::map::AffineMap(Affine::IDENTITY);
    let options = warp_options().with_page(PageFit::Page);
    let w = read(&svg).warp(&map, &options).unwrap();
    assert!(w.svg.contains("viewBox=\"20 30 60 40\""), "{}", w.svg);
}

/// Lengths in percent of the page, explicit and by default.
const IN_PERCENT: &str = "<svg x='25%' y='10%' width='20%' height='30%'><rect width='100%' height='50%' fill='green'/></svg>\
    <svg y='60%'><circle cx='50%' cy='15' r='10%' fill='teal'/></svg>\
    <linearGradient id='a' gradientUnits='userSpaceOnUse' x1='10%'><stop stop-color='red'/><stop offset='1'/></linearGradient>\
    <rect x='60%' y='5%' width='30%' height='20%' fill='url(#a)'/>\
    <radialGradient id='b' gradientUnits='userSpaceOnUse'><stop stop-color='gold'/><stop offset='1'/></radialGradient>\
    <rect x='5' y='50' width='30' height='5%' fill='url(#b)'/>\
    <path d='M10 90H70' stroke='blue' stroke-width='4%'/><path d='M10 80H70' style='stroke:navy;stroke-width:2%'/>\
    <style>.wide{stroke:purple;stroke-width:3%}</style><path class='wide' d='M10 70H70'/><path d='M10 75H70' stroke='lime'/>\
    <mask id='m' maskUnits='userSpaceOnUse' x='50%' y='50%' width='30%' height='30%'><rect width='100%' height='100%' \
    fill='white'/></mask><rect x='40' y='40' width='55' height='50' fill='orange' mask='url(#m)'/>\
    <rect x='10%' y='10%' width='10%' height='10%' fill='url(#box)'/><linearGradient id='box' x2='50%'><stop \
    stop-color='red'/><stop offset='1'/></linearGradient>\
    <symbol id='s' viewBox='0 0 10 10'><circle cx='50%' cy='5' r='5'/></symbol><use href='#s' x='20' opacity='.2'/>\
    <text x='5%, 10%' y='40%' font-size='12'>AB</text>\
    <foreignObject width='1' height='1'><p xmlns='http://www.w3.org/1999/xhtml' width='50%'/></foreignObject>";

/// Percentages of the page are converted, so that lengths stay when the page changes.
#[test]
fn percentages_refer_to_the_page_as_it_was() {
    let svg = pathwarp_oracle::drawings::drawing(&format!(
        "{IN_PERCENT}<rect id='moved' x='80' y='80' width='9' height='9'/>"
    ));
    let svg = svg.replacen("<svg ", "<svg stroke-width='1%' ", 1);
    let shown = |page: PageFit| {
        let selection = Selection { select: vec!["#moved".into()], ..Selection::default() };
        let options = warp_options().with_page(page).with_selection(selection);
        let w = read(&svg).warp(&Hidden(Affine::translate((70.0, 60.0))), &options).unwrap();
        let d = read(&w.svg);
        let window = Affine::scale(4.0) * d.user_to_px().inverse();
        (d.view_box(), rendered(pathwarp_svg::usvg_tree::tree(&d), 400, window), w.svg)
    };
    let (page, before, _) = shown(PageFit::None);
    let (grown, after, text) = shown(PageFit::Grow);
    assert!(grown.width() > 1.4 * page.width() && grown.height() > 1.3 * page.height(), "{grown:?}");
    pathwarp_oracle::drawings::alike(&text, &before, &after);
    // HTML has separate viewports.
    assert!(text.contains("width='50%'"), "{text}");
}

/// A page whose viewBox equals its size up to rounding has no transform, so no transform of a group may be taken for the page's.
#[test]
fn a_page_of_odd_size_is_no_group() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 108.51184 100'><g transform='translate(5) rotate(12)'>\
               <rect x='20' y='10' width='50' height='40'/></g></svg>";
    let d = read(svg);
    let b = d.artwork_box(&Selection::default()).unwrap();
    let (sin, cos) = 12_f64.to_radians().sin_cos();
    assert!((b.x0 - (5.0 + 20.0 * cos - 50.0 * sin)).abs() < 1e-9, "{b:?}");
    assert!((b.y1 - (70.0 * sin + 50.0 * cos)).abs() < 1e-9, "{b:?}");
}

/// Names and drawings with filters whose regions are larger than their paint, or painted in full.
const FILTERS: &[(&str, &str)] = &[
    (
        "a shadow in a generous region",
        "<filter id='f' x='-.5' y='-.5' width='2' height='2'><feOffset dx='2' dy='9'/><feGaussianBlur stdDeviation='.4'/>\
         <feColorMatrix values='0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 .5 0'/><feMerge><feMergeNode/><feMergeNode \
         in='SourceGraphic'/></feMerge></filter><rect x='30' y='20' width='40' height='30' filter='url(#f)'/>",
    ),
    (
        "a flood over a region",
        "<filter id='f' x='-.1' y='-.2' width='1.1' height='1.3'><feFlood flood-color='red' result='r'/><feComposite \
         in='SourceGraphic' in2='r'/></filter><rect x='30' y='20' width='40' height='30' filter='url(#f)'/>",
    ),
];

/// The whole region of a filter does not count, only its paint, up to the invisible end of a blur.
#[test]
fn the_page_follows_what_filters_paint() {
    for (name, body) in FILTERS {
        for map in [Affine::translate((40.0, -30.0)) * Affine::scale(1.3), Affine::translate((45.0, 5.0))] {
            let d = fitted(&pathwarp_oracle::drawings::drawing(body), map, PageFit::Page);
            let (page, marks) = (d.view_box(), marks(&d));
            assert!(
                page.inflate(0.1, 0.1).union(marks) == page.inflate(0.1, 0.1),
                "{name}: {page:?} lacks of {marks:?}"
            );
            assert!(
                marks.inflate(0.5, 0.5).union(page) == marks.inflate(0.5, 0.5),
                "{name}: {page:?} is more than {marks:?}"
            );
        }
    }
}
