use crate::scene::expand::stroke_outline;
use pathwarp::kurbo::{ParamCurveNearest as _, Point, Shape as _};
use pathwarp::{Outline, Seg};
use usvg::{Node, Options, Tree};

/// Paths with every kind of degenerate segment, at the start, inside, at the end, and before `Z`.
const DEGENERATE: [&str; 22] = [
    "M20 20C20 20 60 80 80 20",
    "M20 20C40 80 80 20 80 20",
    "M20 20C20 20 80 70 80 70",
    "M20 20C20 20 20 20 80 60",
    "M20 20C80 60 80 60 80 60",
    "M20 20L20 20C30 40 60 80 80 20",
    "M20 20C20 20 20 20 20 20L80 60",
    "M20 20L20 20L80 20L50 70Z",
    "M20 20C20 20 20 20 20 20C30 50 60 60 80 20Z",
    "M20 20L50 50C50 50 50 50 50 50L80 20",
    "M20 20L50 50L80 20C80 20 80 20 80 20",
    "M20 20Q20 20 80 60",
    "M20 20Q80 60 80 60",
    "M20 20Q20 20 20 20L80 60",
    "M20 20C90 20 -20 20 80 20",
    "M20 70C90 10 10 10 80 70",
    "M50 20C90 90 90 90 50 20",
    "M20 50A30 0 0 0 1 80 50",
    "M20 20L20.0000001 20L80 60",
    "M20 20C20.0000001 20 79.99999999 60 80 60",
    "M81.87 28.24C77.17 29.34 77.57 30.04 77.57 30.04C77.87 30.54 79.17 29.84 79.17 29.84C82.87 28.64 81.87 28.24 81.87 28.24Z",
    "M50 20C3 31 7 38 7 38C10 43 23 36 23 36C60 24 50 20 50 20Z",
];

fn stroke(style: &str) -> usvg::Stroke {
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><path d='M0 0H9' stroke='red' {style}/></svg>"
    );
    let tree = Tree::from_str(&svg, &Options::default()).unwrap();
    let Some(Node::Path(p)) = tree.root().children().first() else { panic!("{svg}") };
    p.stroke().unwrap().clone()
}

/// A stroke with round caps and joins covers the points within half its width of the curve.
#[test]
fn degenerate_segments_have_strokes() {
    for d in DEGENERATE {
        let path = Outline::from_svg_lossy(d);
        // Wider ones leave holes in small loops, as in all renderers.
        for width in [0.2, 4.0] {
            let round = format!("stroke-width='{width}' stroke-linecap='round' stroke-linejoin='round'");
            let covered = stroke_outline(&path, &stroke(&round), 1e-3).to_bez_path(1e-4);
            let segs: Vec<_> = path.segs().map(Seg::to_cubic).collect();
            for i in 0..60 * 60 {
                let p = Point::new(f64::from(i % 60) * 1.7, f64::from(i / 60) * 1.7);
                let off = segs.iter().map(|s| s.nearest(p, 1e-6).distance_sq.sqrt()).fold(f64::INFINITY, f64::min);
                if (off - 0.5 * width).abs() > 0.02 {
                    assert_eq!(covered.winding(p) != 0, off < 0.5 * width, "{d}, {width} wide, at {p:?}");
                }
            }
        }
    }
}

#[test]
fn degenerate_segments_have_finite_strokes() {
    for d in DEGENERATE {
        for cap in ["butt", "round", "square"] {
            for join in ["miter", "round", "bevel"] {
                for (width, dashes) in [(0.2, "none"), (8.0, "none"), (8.0, "5 4"), (0.2, "0 .3"), (30.0, "1 9 4")] {
                    let style = format!(
                        "stroke-width='{width}' stroke-linecap='{cap}' stroke-linejoin='{join}' stroke-dasharray='{dashes}'"
                    );
                    let out = stroke_outline(&Outline::from_svg_lossy(d), &stroke(&style), 1e-3);
                    let reach = out.bounding_box().unwrap();
                    assert!(reach.is_finite() && reach.width() < 300.0, "{d}, {style}: {reach:?}");
                    assert!(out.to_bez_path(1e-3).is_finite(), "{d}, {style}");
                }
            }
        }
    }
}
