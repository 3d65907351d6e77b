//! Shapes that share an edge share it after the warp, to the last digit, even if pieces are merged.

use crate::support::sample;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{CubicBez, Point, Rect};
use pathwarp::map::Map;
use pathwarp::param::{Args, Frame};
use pathwarp::refit::Nodes;
use pathwarp::{Outline, Seg, refit};
use pathwarp_svg::{Document, ReadOptions, Selection, WarpOptions};
use std::collections::HashMap;
use std::fs;
use std::sync::Arc;

const CAGE: &str = "M 10,90 C 60,130 60,60 95,85 C 75,60 115,40 90,15 C 60,-25 40,45 5,10 C 25,40 -10,60 10,90 Z";

/// The cubics of an outline, each from its lexicographically smaller end.
fn edges(o: &Outline) -> Vec<[(u64, u64); 4]> {
    let canonical = |c: CubicBez| {
        let forwards = (c.p0.x, c.p0.y) <= (c.p3.x, c.p3.y);
        let p = if forwards { [c.p0, c.p1, c.p2, c.p3] } else { [c.p3, c.p2, c.p1, c.p0] };
        p.map(|p: Point| (p.x.to_bits(), p.y.to_bits()))
    };
    o.segs().filter(|s| !matches!(s, Seg::Line(_))).map(|s| canonical(s.to_cubic())).collect()
}

/// The shaper's map over `frame`.
fn shaper(frame: Rect) -> Arc<dyn Map> {
    let entry = Registry::builtin().get("shaper").unwrap().clone();
    entry.build_from(&Args::from_pairs(&[("shaper", CAGE)]), &Frame::new(frame)).unwrap().map
}

#[test]
fn stained_glass_has_no_gaps() {
    let doc = Document::read(&fs::read(sample("tiles.svg")).unwrap(), "tiles", &ReadOptions::default()).unwrap();
    let map = shaper(doc.artwork_box(&Selection::default()).unwrap());
    let count = |o: &mut dyn Iterator<Item = &Outline>| {
        let mut seen: HashMap<[(u64, u64); 4], usize> = HashMap::new();
        o.flat_map(edges).for_each(|e| *seen.entry(e).or_default() += 1);
        seen.values().filter(|n| **n == 2).count()
    };
    let shared_before = count(&mut doc.shapes().iter().map(|s| &*s.outline));
    assert!(shared_before > 20, "the sample has shared edges: {shared_before}");
    let shared = pathwarp::engine::SharedEdges::among(doc.shapes().iter().map(|s| &*s.outline));
    assert_ne!(shared, pathwarp::engine::SharedEdges::default());
    for nodes in [Nodes::Source, Nodes::Fewest, Nodes::Auto, Nodes::Extremes] {
        let options = refit::Options::new(1e-3).with_nodes(nodes);
        let warped = doc.warp(&map, &WarpOptions::new(options)).unwrap();
        let after = Document::read(warped.svg.as_bytes(), "out", &ReadOptions::default()).unwrap();
        // Every shared source edge gives one or more pieces, each found on both sides.
        let shared_after = count(&mut after.shapes().iter().map(|s| &*s.outline));
        assert!(shared_after >= shared_before, "{nodes:?}: {shared_before} before, {shared_after} after");
    }
}

/// Merging would join the shared edge with the following segment on one side only. It does so without a shared edge, so the test can
/// fail.
#[test]
fn a_shared_edge_is_not_merged_with_what_follows_it() {
    const WITH_REST: &str = "<path d='M0,50 C10,30 20,40 30,50 C40,60 50,70 60,50 L60,90 0,90 Z'/>";
    const NEIGHBOUR: &str = "<path d='M30,50 C20,40 10,30 0,50 L0,0 30,0 Z'/>";
    let warp = |shapes: &str| {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 60 90'>{shapes}</svg>");
        let doc = Document::read(svg.as_bytes(), "t", &ReadOptions::default()).unwrap();
        let map = shaper(Rect::new(0.0, 0.0, 60.0, 90.0));
        let options = refit::Options::new(0.2).with_nodes(Nodes::Fewest);
        let out = doc.warp(&map, &WarpOptions::new(options)).unwrap().svg;
        let after = Document::read(out.as_bytes(), "out", &ReadOptions::default()).unwrap();
        after.shapes().iter().map(|s| edges(&s.outline)).collect::<Vec<_>>()
    };
    let both = warp(&[WITH_REST, NEIGHBOUR].concat());
    let common = both[0].iter().filter(|e| both[1].contains(e)).count();
    assert!(common > 0, "the edge is the same on both sides");
    assert!(warp(WITH_REST)[0].len() < both[0].len(), "alone, it is merged with what follows");
}

/// Nearly a quadratic shear: a vertical line becomes x + a·y² + b·y³.
struct Nearly(f64);
impl pathwarp::map::Formula for Nearly {
    fn f<S: pathwarp::map::Real>(&self, x: S, y: S) -> (S, S) {
        (x + y * y * 4e-3 + y * y * y * self.0, y + x * 0.1)
    }
}

/// Every second column is drawn half as large, under `scale(2)`. An edge is written with the same kinds of curves on both sides, however
/// near it is to the limit at which a quadratic is as good as a cubic.
#[test]
fn neighbours_under_different_transforms_write_their_edge_alike() {
    let mut kinds = HashMap::new();
    for scale in [2.0, 3.0, 0.3] {
        let cell = |i: u32| {
            let k = if i % 2 == 1 { 1.0 / scale } else { 1.0 };
            let [x0, x1, y1] = [f64::from(i) * 12.0, f64::from(i + 1) * 12.0, 60.0].map(|v| v * k);
            let d = format!("<path d='M{x0},0 V{y1} H{x1} V0 Z'/>");
            if i % 2 == 1 { format!("<g transform='scale({scale})'>{d}</g>") } else { d }
        };
        let cells: String = (0..5).map(cell).collect();
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 60 60'>{cells}</svg>");
        let doc = Document::read(svg.as_bytes(), "t", &ReadOptions::default()).unwrap();
        for step in 0..36 {
            let map: Arc<dyn Map> = Arc::new(Nearly(1e-13 * 1.6f64.powi(step)));
            let options = refit::Options::new(0.02).with_nodes(Nodes::Fewest);
            let out = doc.warp(&map, &WarpOptions::new(options)).unwrap().svg;
            let after = Document::read(out.as_bytes(), "out", &ReadOptions::default()).unwrap();
            let outlines: Vec<&Outline> = after.shapes().iter().map(|s| &*s.outline).collect();
            for pair in outlines.windows(2) {
                // The right side of one column, and the left side of the next.
                let top = |o: &Outline, x: f64| -> Vec<char> {
                    // The cubic term is less than 3.
                    let on = |p: Point| {
                        let y = p.y - 0.1 * x;
                        (p.x - x - y * y * 4e-3).abs() < 3.0 && y > -1.0
                    };
                    let kind = |s: &Seg| match s {
                        Seg::Line(_) => 'L',
                        Seg::Quad(_) => 'Q',
                        _ => 'C',
                    };
                    let mut own: Vec<(f64, char)> = o
                        .segs()
                        .filter(|s| on(s.start()) && on(s.end()) && (s.start().y - s.end().y).abs() > 4.0)
                        .map(|s| (s.start().y.min(s.end().y), kind(s)))
                        .collect();
                    own.sort_by(|a, b| a.0.total_cmp(&b.0));
                    own.into_iter().map(|k| k.1).collect()
                };
                let i = outlines.iter().position(|o| std::ptr::eq(*o, pair[0])).unwrap();
                let x = (i + 1) as f64 * 12.0;
                let [left, right] = [top(pair[0], x), top(pair[1], x)];
                assert!(!left.is_empty() && left == right, "scale {scale}, step {step}, edge {x}: {left:?} {right:?}");
                left.into_iter().for_each(|k| *kinds.entry(k).or_insert(0) += 1);
            }
        }
    }
    let count = |k| kinds.get(&k).copied().unwrap_or(0);
    assert!(count('Q') > 20 && count('C') > 20, "the sweep crosses the limit: {kinds:?}");
}
