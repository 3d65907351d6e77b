//! Filters with regions as tight as programs export them. The reference is the drawing without the filter, which changes nothing except
//! that its region cuts parts off.

use pathwarp::kurbo::{Affine, Rect};
use pathwarp_oracle::drawings::{Bend, drawing, options, read, rendered, warp_options};
use pathwarp_oracle::ink;
use pathwarp_svg::usvg_tree::{parse_tree, tree};
use pathwarp_svg::{PageFit, Structure};

/// Names and drawings.
const DRAWINGS: &[(&str, &str)] = &[
    (
        "a region in user space",
        "<g filter='url(#f)'><path d='M10 45H90V55H10z'/></g><filter id='f' x='10' y='45' width='80' height='10' \
         filterUnits='userSpaceOnUse'><feOffset/></filter>",
    ),
    (
        "a region in box units",
        "<path d='M10 45H90V55H10z' filter='url(#f)'/><filter id='f' x='0' y='0' width='1' height='1'><feOffset/></filter>",
    ),
    (
        "two shapes with one filter",
        "<path d='M10 20H90V30H10z' filter='url(#f)'/><path d='M70 10V90H80V10z' filter='url(#f)' fill='red'/>\
         <filter id='f' x='10' y='10' width='80' height='80' filterUnits='userSpaceOnUse'><feOffset/></filter>",
    ),
    (
        "units of another filter, a region in percent, a stroke, a transform",
        "<filter id='e' filterUnits='userSpaceOnUse'/><g transform='translate(10 -5) rotate(5)' filter='url(#f)'><path \
         d='M10 45H80' stroke='green' stroke-width='6' fill='none'/><circle cx='45' cy='60' r='9'/></g>\
         <filter id='f' href='#e' xlink:href='#e' x='10%' y='42%' width='70%' height='27%'><feOffset/></filter>",
    ),
];

/// Pixels per unit.
const FINE: f64 = 8.0;

/// Returns the box and the area that a drawing paints, in units.
fn painted(svg: &str) -> (Rect, f64) {
    let (from, side) = (-30.0, 170.0);
    let window = Affine::scale(FINE) * Affine::translate((-from, -from));
    let t = parse_tree(svg.as_bytes(), "result", &options()).unwrap();
    let (all, pixels) = ink(&rendered(&t, (side * FINE) as u32, window), 127);
    (Affine::scale(1.0 / FINE).transform_rect_bbox(all), pixels as f64 / (FINE * FINE))
}

#[test]
fn regions_cut_nothing_off_that_bends_out_of_them() {
    for (name, body) in DRAWINGS {
        for structure in [Structure::Keep, Structure::Flatten] {
            let options = warp_options().with_structure(structure);
            let bent = |body: &str| read(&drawing(body)).warp(&Bend, &options).unwrap().svg;
            let with = bent(body);
            let (found, area) = painted(&with);
            let (wanted, whole) = painted(&bent(&body.replace("filter='url(#f)'", "")));
            let off = [found.x0 - wanted.x0, found.y0 - wanted.y0, found.x1 - wanted.x1, found.y1 - wanted.y1];
            assert!(off.iter().all(|d| d.abs() <= 2.5 / FINE), "{name}: {found:?} instead of {wanted:?}\n{with}");
            assert!((area - whole).abs() < 0.01 * whole, "{name}: an area of {area} instead of {whole}\n{with}");
        }
    }
}

/// The page holds the contents of a region that has grown.
#[test]
fn the_page_grows_with_the_region() {
    let svg = drawing(DRAWINGS[0].1);
    let fitted = read(&svg).warp(&Bend, &warp_options().with_page(PageFit::Page)).unwrap();
    let plain =
        read(&svg.replace("filter='url(#f)'", "")).warp(&Bend, &warp_options().with_page(PageFit::Page)).unwrap();
    let [a, b] = [fitted, plain].map(|w| read(&w.svg).view_box());
    assert!(a.inflate(0.1, 0.1).union(b) == a.inflate(0.1, 0.1), "{a:?} does not hold {b:?}");
}

/// A region is left as written if nothing bends out of it.
#[test]
fn other_regions_stay() {
    let body = "<path d='M10 45H90V55H10z' filter='url(#f)'/><filter id='f' x='10' y='45' width='80' height='10' \
                filterUnits='userSpaceOnUse'><feOffset/></filter>";
    let options = warp_options().with_structure(Structure::Keep);
    let moved = pathwarp_oracle::drawings::Hidden(Affine::rotate_about(0.3, (50.0, 50.0)));
    let out = read(&drawing(body)).warp(&moved, &options).unwrap().svg;
    assert!(out.contains("x='10' y='45' width='80' height='10'"), "{out}");
    assert!(tree(&read(&out)).root().has_children());
}
