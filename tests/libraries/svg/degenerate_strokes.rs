//! Outlines of strokes along random degenerate paths, with every join and cap and with dashes.

use pathwarp::kurbo::Affine;
use pathwarp::{Outline, refit};
use pathwarp_oracle::drawings::{Hidden, drawing, options, read};
use pathwarp_oracle::{Polygon, Random, flat, painted as area_of};
use pathwarp_svg::usvg_tree::parse_tree;
use pathwarp_svg::{Strokes, WarpOptions};

fn coordinate(r: &mut Random) -> f64 {
    20.0 + r.below(6000) as f64 / 100.0
}

/// Returns path data of one to four segments whose control points often coincide, lie on one line, or nearly so.
fn path(r: &mut Random) -> String {
    let mut at = [coordinate(r), coordinate(r)];
    let mut d = format!("M{} {}", at[0], at[1]);
    for _ in 0..=r.below(4) {
        let kind = r.below(3);
        let mut points = Vec::new();
        let through = [coordinate(r), coordinate(r)];
        for _ in 0..=kind {
            let earlier = points.last().copied().unwrap_or(at);
            points.push(match r.below(6) {
                0 => at,
                1 => earlier,
                2 => [earlier[0] + 1e-7, earlier[1]],
                3 => {
                    let t = r.below(300) as f64 / 100.0 - 1.0;
                    [at[0] + t * (through[0] - at[0]), at[1] + t * (through[1] - at[1])]
                }
                _ => [coordinate(r), coordinate(r)],
            });
        }
        at = *points.last().unwrap();
        let all: Vec<String> = points.iter().map(|p| format!("{} {}", p[0], p[1])).collect();
        d += &format!("{}{}", ["L", "Q", "C"][kind], all.join(" "));
    }
    if r.below(4) == 0 { d + "Z" } else { d }
}

/// Returns the largest distance of a point of the outline from the path, and of a point of the path from the area.
fn extent(d: &str, area: &Polygon) -> (f64, f64) {
    let line = flat(&Outline::from_svg_lossy(d), 1e-4);
    let out = area.edges.iter().map(|e| line.distance(e[0])).fold(0.0, f64::max);
    (out, line.edges.iter().map(|e| area.outside(e[0])).fold(0.0, f64::max))
}

#[test]
fn two_thousand_degenerate_paths_have_outlines() {
    const TOLERANCE: f64 = 0.01;
    let o = WarpOptions::new(refit::Options::new(TOLERANCE)).with_strokes(Strokes::Outline);
    let map = Hidden(Affine::new([1.0, 0.0, 1e-9, 1.0, 0.0, 0.0]));
    let mut r = Random::new(7);
    let mut painted = 0;
    for _ in 0..2000 {
        let d = path(&mut r);
        let width = r.one_of(&[0.3, 2.0, 9.0]);
        let cap = r.one_of(&["butt", "round", "square"]);
        let join = r.one_of(&["miter", "round", "bevel"]);
        let dashes = r.one_of(&["none", "none", "4 3", "0 2", "7 1 2"]);
        let style = format!(
            "stroke-width='{width}' stroke-linecap='{cap}' stroke-linejoin='{join}' stroke-dasharray='{dashes}'"
        );
        let svg = drawing(&format!("<path id='p' d='{d}' fill='none' stroke='red' {style}/>"));
        let w = read(&svg).warp(&map, &o).unwrap();
        assert!(!w.svg.contains("NaN") && !w.svg.contains("inf"), "{d} {style}: {}", w.svg);
        let tree = parse_tree(w.svg.as_bytes(), "the outline", &options()).unwrap();
        let area = area_of(&tree);
        if area.edges.is_empty() {
            continue;
        }
        painted += 1;
        let (out, inside) = extent(&d, &area);
        let reach = 0.5 * width * if join == "miter" { 4.0 } else { 2.0_f64.sqrt() };
        // The renderer works in single precision.
        assert!(out <= reach + TOLERANCE + 1e-3, "{d} {style}: {out} of {reach}");
        // A stroke without dashes covers its centre line, except in turns tighter than half the width, as in the renderer.
        if dashes == "none" && inside > TOLERANCE + 1e-3 {
            let (_, bare) = extent(&d, &area_of(&parse_tree(svg.as_bytes(), "the stroke", &options()).unwrap()));
            assert!(width > 2.0 && inside <= bare + 0.01 * width, "{d} {style}: {inside} is bare\n{}", w.svg);
        }
    }
    assert!(painted > 1800, "{painted}");
}
