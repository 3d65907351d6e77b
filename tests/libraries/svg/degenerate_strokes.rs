//! Outlines of strokes along random degenerate paths, with every join and cap and with dashes.

use pathwarp::kurbo::{Affine, ParamCurve as _, ParamCurveNearest as _, Point};
use pathwarp::{Outline, Seg, refit};
use pathwarp_oracle::area::Area;
use pathwarp_oracle::drawings::{Hidden, drawing, options, read};
use pathwarp_svg::usvg_tree::parse_tree;
use pathwarp_svg::{Strokes, WarpOptions};

/// Numbers that look random and are the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u64) as usize]
    }

    fn coordinate(&mut self) -> f64 {
        20.0 + self.below(6000) as f64 / 100.0
    }
}

/// Path data of one to four segments whose control points often coincide, lie on one line, or nearly so.
fn path(r: &mut Random) -> String {
    let mut at = [r.coordinate(), r.coordinate()];
    let mut d = format!("M{} {}", at[0], at[1]);
    for _ in 0..=r.below(4) {
        let kind = r.below(3);
        let mut points = Vec::new();
        let through = [r.coordinate(), r.coordinate()];
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
                _ => [r.coordinate(), r.coordinate()],
            });
        }
        at = *points.last().unwrap();
        let all: Vec<String> = points.iter().map(|p| format!("{} {}", p[0], p[1])).collect();
        d += &format!("{}{}", ["L", "Q", "C"][kind as usize], all.join(" "));
    }
    if r.below(4) == 0 { d + "Z" } else { d }
}

/// Largest distance of a point of the outline from the path, and of a point of the path from the area.
fn extent(d: &str, area: &Area) -> (f64, f64) {
    let segs: Vec<_> = Outline::from_svg_lossy(d).segs().map(Seg::to_cubic).collect();
    let off = |p: &Point| segs.iter().map(|s| s.nearest(*p, 1e-6).distance_sq.sqrt()).fold(f64::INFINITY, f64::min);
    let out = area.0.iter().flatten().step_by(5).map(off).fold(0.0, f64::max);
    let inside = segs.iter().flat_map(|s| (0..=20).map(|i| s.eval(f64::from(i) / 20.0)));
    (out, inside.map(|p| area.distance(p)).fold(0.0, f64::max))
}

#[test]
fn two_thousand_degenerate_paths_have_outlines() {
    const TOLERANCE: f64 = 0.01;
    let o = WarpOptions::new(refit::Options::new(TOLERANCE)).with_strokes(Strokes::Outline);
    let map = Hidden(Affine::new([1.0, 0.0, 1e-9, 1.0, 0.0, 0.0]));
    let mut r = Random(7);
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
        let area = Area::of(&tree);
        if area.0.is_empty() {
            continue;
        }
        painted += 1;
        let (out, inside) = extent(&d, &area);
        let reach = 0.5 * width * if join == "miter" { 4.0 } else { 2.0_f64.sqrt() };
        // The picture has single precision.
        assert!(out <= reach + TOLERANCE + 1e-3, "{d} {style}: {out} of {reach}");
        // A stroke without dashes covers its centre line, except in turns tighter than half the width, as in the renderer.
        if dashes == "none" && inside > TOLERANCE + 1e-3 {
            let (_, bare) = extent(&d, &Area::of(&parse_tree(svg.as_bytes(), "the stroke", &options()).unwrap()));
            assert!(width > 2.0 && inside <= bare + 0.01 * width, "{d} {style}: {inside} is bare\n{}", w.svg);
        }
    }
    assert!(painted > 1800, "{painted}");
}
