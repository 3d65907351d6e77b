//! An open path is filled as if closed by a line (SVG 2, §13.4.1), and a map bends that line like any other. The reference is the drawing
//! with that line.

use pathwarp_oracle::drawings::{Bend, alike, drawing, options, read, warp_options};
use pathwarp_svg::usvg_tree::parse_tree;
use pathwarp_svg::{Strokes, Structure, WarpOptions};
use resvg::tiny_skia::{Pixmap, Transform};

fn bent(body: &str, options: &WarpOptions) -> String {
    read(&drawing(body)).warp(&Bend, options).unwrap().svg
}

fn picture(svg: &str) -> Pixmap {
    let tree = parse_tree(svg.as_bytes(), "the result", &options()).unwrap();
    let mut out = Pixmap::new(400, 400).unwrap();
    resvg::render(&tree, Transform::from_scale(4.0, 4.0), &mut out.as_mut());
    out
}

fn ways() -> Vec<WarpOptions> {
    let mut out = Vec::new();
    for structure in [Structure::Auto, Structure::Flatten] {
        for strokes in [Strokes::Auto, Strokes::Outline, Strokes::Scale, Strokes::Keep] {
            out.push(warp_options().with_structure(structure).with_strokes(strokes));
        }
    }
    out
}

/// Checks that both drawings look alike when bent, and that the fill is visible.
fn same(open: &str, drawn: &str) {
    same_in(&ways(), open, drawn);
}

fn same_in(ways: &[WarpOptions], open: &str, drawn: &str) {
    for o in ways {
        let (found, expected) = (bent(open, o), bent(drawn, o));
        alike(&format!("{:?} {:?}\n{found}", o.structure, o.strokes), &picture(&expected), &picture(&found));
    }
}

#[test]
fn the_line_that_closes_a_fill_bends() {
    same("<path d='M10 20L90 50L20 90' fill='red'/>", "<path d='M10 20L90 50L20 90Z' fill='red'/>");
    same("<polyline points='10,20 90,50 20,90' fill='red'/>", "<path d='M10 20L90 50L20 90Z' fill='red'/>");
}

#[test]
fn and_is_still_not_stroked() {
    // Centre lines without a fill never appear twice.
    let ways: Vec<_> = ways().into_iter().filter(|o| o.strokes != Strokes::Keep).collect();
    same_in(
        &ways,
        "<path id='p' d='M10 20L90 50L20 90' fill='red' stroke='blue' stroke-width='4'/>",
        "<path d='M10 20L90 50L20 90Z' fill='red'/><path d='M10 20L90 50L20 90' fill='none' stroke='blue' stroke-width='4'/>",
    );
    same_in(
        &ways,
        "<path d='M10 20L90 50L20 90' fill='red' stroke='blue' stroke-width='4' paint-order='stroke'/>",
        "<path d='M10 20L90 50L20 90' fill='none' stroke='blue' stroke-width='4'/><path d='M10 20L90 50L20 90Z' fill='red'/>",
    );
}

#[test]
fn a_line_encloses_nothing() {
    let (filled, empty) = ("stroke='blue' stroke-width='2'", "stroke='blue' stroke-width='2' fill='none'");
    same(&format!("<path d='M5 30H95' {filled}/>"), &format!("<path d='M5 30H95' {empty}/>"));
    same(
        &format!("<line id='l' style='fill:red' x1='50' y1='5' x2='50' y2='95' {filled}/>"),
        &format!("<path d='M50 5V95' {empty}/>"),
    );
    assert!(bent("<path id='p' d='M5 30H95'/>", &warp_options()).contains("fill=\"none\""));
}

#[test]
fn clip_paths_are_closed_as_well() {
    let clip = |d: &str| {
        format!(
            "<clipPath id='c'><path d='{d}'/></clipPath><rect width='100' height='100' fill='red' clip-path='url(#c)'/>"
        )
    };
    same(&clip("M10 20L90 50L20 90"), &clip("M10 20L90 50L20 90Z"));
}
