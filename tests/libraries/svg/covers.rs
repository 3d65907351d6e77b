//! Outlines of strokes cover the strokes' pixels, as the renderer draws them.

use pathwarp::kurbo::Affine;
use pathwarp::refit;
use pathwarp_oracle::beyond_edges;
use pathwarp_oracle::drawings::{Hidden, drawing, options, read, rendered};
use pathwarp_svg::usvg_tree::parse_tree;
use pathwarp_svg::{Strokes, WarpOptions};

const SHAPES: [&str; 24] = [
    // Leaves, petals, and closed paths of one, two and three segments.
    "M50 20C80 40 80 60 50 80C20 60 20 40 50 20Z",
    "M50 80C10 10 90 10 50 80Z",
    "M50 20C3 31 20 88 50 20Z",
    "M20 50Q50 10 80 50Q50 90 20 50Z",
    "M20 50L80 50Q50 90 20 50Z",
    "M20 50A40 40 0 0 1 80 50A40 40 0 0 1 20 50Z",
    "M20 30L80 70Z",
    "M30 70L50 30L75 65Z",
    "M30,70L40,33 75,60 30,70.00001Z",
    // A star, polygons, and edges shorter than widths.
    "M50 15L58 40H84L63 56L71 81L50 66L29 81L37 56L16 40H42Z",
    "M20 20H80V80H20Z",
    "M20 50L24 30L28 50L32 30L36 50L70 50L71 48L72 51L80 50",
    // Hooks, spirals, crossings, loops.
    "M20 30C80 30 80 45 20 45",
    "M20 50C80 50 80 52 20 52",
    "M50 50C55 50 55 58 48 58C36 58 36 40 52 40C72 40 72 70 46 70C16 70 16 25 54 25",
    "M20 20L80 80L80 20L20 80Z",
    "M20 75C110 0 -10 0 80 75",
    "M30 40C60 90 80 20 55 30S20 60 70 70",
    // Cusps and near cusps, handles without length, and arcs.
    "M30 30C80 75 20 75 70 30",
    "M30 30C70 80 30 80 70.1 30",
    "M20 30C20 30 60 80 80 30L50 30C40 80 80 60 80 60",
    "M30 60A20 20 0 1 1 60 70A8 14 20 0 1 50 50",
    "M50 50A8 8 0 1 1 50 50.01Z",
    "M30 30L70 30L30 30.5",
];

const STYLES: [&str; 8] = [
    "",
    "stroke-linejoin='round' stroke-linecap='round'",
    "stroke-linejoin='bevel' stroke-linecap='square'",
    "stroke-linejoin='miter' stroke-miterlimit='12'",
    "stroke-linejoin='miter-clip' stroke-miterlimit='1.5'",
    "stroke-dasharray='9 5'",
    "stroke-dasharray='7 3 1 4' stroke-dashoffset='2' stroke-linecap='square' stroke-linejoin='bevel'",
    "stroke-dasharray='0 6' stroke-linecap='round' stroke-linejoin='round'",
];

fn check(size: u32, shapes: &[&str], styles: &[&str]) {
    let outlines = WarpOptions::new(refit::Options::new(100.0 / 8000.0)).with_strokes(Strokes::Outline);
    let scale = Affine::scale(f64::from(size) / 100.0);
    let mut faults = Vec::new();
    for d in shapes {
        for style in styles {
            for width in ["0.05", "1", "6", "18"] {
                let svg = drawing(&format!("<path d='{d}' fill='none' stroke='#000' stroke-width='{width}' {style}/>"));
                let document = read(&svg);
                let warped = document.warp(&Hidden(Affine::IDENTITY), &outlines).unwrap();
                let tree = |svg: &str| parse_tree(svg.as_bytes(), "test.svg", &options()).unwrap();
                let (expected, found) = (rendered(&tree(&svg), size, scale), rendered(&tree(&warped.svg), size, scale));
                let off = beyond_edges(&expected, &found);
                if off as f64 > f64::from(size * size) * 1e-5 {
                    faults.push(format!("{off} pixels: {d}, {width} wide, {style}\n{}", warped.svg));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}\n{} faults", faults.join("\n"), faults.len());
}

#[test]
fn outlines_cover_what_strokes_cover() {
    check(400, &SHAPES, &STYLES);
}

#[test]
#[ignore = "takes minutes: cargo test --release -p pathwarp-cli --test libraries covers -- --ignored"]
fn outlines_cover_what_strokes_cover_at_four_thousand_pixels() {
    check(4000, &SHAPES, &STYLES);
}

/// United outlines cover the same pixels, and wind once around them.
#[test]
fn united_outlines_cover_the_same_once() {
    let outlines = WarpOptions::new(refit::Options::new(0.02)).with_strokes(Strokes::Outline).with_union(true);
    for d in SHAPES {
        for style in &STYLES[..3] {
            let svg = drawing(&format!("<path d='{d}' fill='none' stroke='#000' stroke-width='5' {style}/>"));
            let warped = read(&svg).warp(&Hidden(Affine::IDENTITY), &outlines).unwrap();
            // Where the winding number is at most 1, both fill rules paint the same.
            let even = warped.svg.replace("<path ", "<path fill-rule='evenodd' ");
            let tree = |svg: &str| parse_tree(svg.as_bytes(), "test.svg", &options()).unwrap();
            let [once, all, stroke] =
                [&even, &warped.svg, &svg].map(|svg| rendered(&tree(svg), 400, Affine::scale(4.0)));
            for other in [&all, &stroke] {
                let off = beyond_edges(&once, other);
                assert!(off <= 1, "{off} pixels: {d}, {style}\n{}", warped.svg);
            }
        }
    }
}
