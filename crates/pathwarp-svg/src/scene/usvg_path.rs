//! usvg's paths: conversion to f64, and comparison with outlines read from the source.

use pathwarp::Outline;
use pathwarp::kurbo::Point;
use pathwarp::outline::{Builder, Seg, Subpath};
use std::collections::VecDeque;
use usvg::tiny_skia_path as ts;

/// Converts usvg's path to f64.
pub(crate) fn from_usvg(path: &ts::Path) -> Outline {
    let p = |p: ts::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let mut b = Builder::default();
    for s in path.segments() {
        match s {
            ts::PathSegment::MoveTo(a) => b.move_to(p(a)),
            ts::PathSegment::LineTo(a) => b.line_to(p(a)),
            ts::PathSegment::QuadTo(a, c) => b.quad_to(p(a), p(c)),
            ts::PathSegment::CubicTo(a, c, d) => b.curve_to(p(a), p(c), p(d)),
            ts::PathSegment::Close => b.close(),
        }
    }
    b.finish()
}

/// Returns `true` if usvg's path is `outline` in f32: the same subpaths with the same anchors, and cubics in place of arcs.
pub(crate) fn same_path(outline: &Outline, path: &ts::Path) -> bool {
    let b = path.bounds();
    let size = [b.left(), b.right(), b.top(), b.bottom()].iter().fold(0.0_f32, |m, v| m.max(v.abs()));
    // usvg adds and halves in f32, with an error of a few units in the last place of the largest number.
    let tolerance = f64::from(size) * 2e-6 + 1e-12;
    let theirs = from_usvg(path);
    // usvg drops subpaths of one point.
    let ours: Vec<_> = outline.subpaths.iter().filter(|s| !s.segs.is_empty() || s.closed).collect();
    let theirs: Vec<_> = theirs.subpaths.iter().filter(|s| !s.segs.is_empty() || s.closed).collect();
    ours.len() == theirs.len() && ours.iter().zip(&theirs).all(|(a, b)| same_subpath(a, b, tolerance))
}

/// Compares a subpath of the source with usvg's.
fn same_subpath(ours: &Subpath, theirs: &Subpath, tolerance: f64) -> bool {
    let close = |p: Point, q: Point| (p.x - q.x).abs() <= tolerance && (p.y - q.y).abs() <= tolerance;
    let handles = |s: &Seg| {
        let c = s.to_cubic();
        [c.p1, c.p2, c.p3]
    };
    // Rounding makes and drops segments without extent.
    let is_point = |s: &Seg| !matches!(s, Seg::Arc(_)) && handles(s).iter().all(|p| close(*p, s.start()));
    let mut rest: VecDeque<&Seg> = theirs.segs.iter().filter(|s| !is_point(s)).collect();
    // usvg draws an arc to the point where it is as a whole ellipse if the points differ in f32.
    let skip_turn = |rest: &mut VecDeque<&Seg>, at: Point| {
        if rest.front().is_some_and(|s| close(s.start(), at) && matches!(s, Seg::Cubic(_)))
            && let Some(last) = rest.iter().position(|s| close(s.end(), at))
        {
            rest.drain(..=last);
        }
    };
    let mut at = ours.start;
    let mut matched = close(at, theirs.start);
    for s in ours.segs.iter().filter(|s| !is_point(s)) {
        matched &= match s {
            // usvg's cubics share the arc's ends and stay within 0.1 of it.
            Seg::Arc(arc) => match rest.iter().position(|t| close(t.end(), arc.p1)) {
                Some(last) => rest.drain(..=last).count() > 0,
                None => false,
            },
            s => {
                let same = |t: &Seg| handles(s).iter().zip(handles(t)).all(|(p, q)| close(*p, q));
                if !rest.front().is_some_and(|t| same(t)) {
                    skip_turn(&mut rest, at);
                }
                rest.pop_front().is_some_and(same)
            }
        };
        if !matched {
            return false;
        }
        at = s.end();
    }
    skip_turn(&mut rest, at);
    // f32 rounding may add a closing line.
    matched && rest.iter().all(|t| close(t.start(), t.end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The path of a document's only element, as usvg reads it.
    fn theirs(d: &str) -> Option<usvg::Tree> {
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='{d}'/></svg>");
        usvg::Tree::from_str(&text, &usvg::Options::default()).ok().filter(|t| !t.root().children().is_empty())
    }

    fn agree(d: &str) {
        let Some(tree) = theirs(d) else { return };
        let [usvg::Node::Path(p)] = tree.root().children() else { panic!("{d}") };
        assert!(same_path(&Outline::from_svg_lossy(d), p.data()), "{d}");
    }

    #[test]
    fn loops_petals_and_arcs_to_the_current_point_are_recognised() {
        for d in [
            "M180 100A80 80 0 1 1 20 100A80 80 0 1 1 180 100ZM100 90C80 60 120 60 100 90Z",
            "M5 5C5 5 5 5 5 5L9 9",
            "M100 90Q80 60 100 90Z",
            "M88 15A60 50 0 0 0 100 180A45 20 30 1 0 100 180Z",
            "M88.123 15.456a60 50 0 0 0 12.3 164.7A45 20 30 1 0 100.423 180.156L3 3C9 9 4 4 3 3Z",
            "M1 1M2 2L3 3M4 4ZM5 5L5 5ZL7 7",
        ] {
            agree(d);
        }
    }

    /// The two readings agree on random paths, on a coarse grid so that points often coincide.
    #[test]
    fn random_paths_are_recognised() {
        let mut state = 7_u64;
        let mut next = move |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % n
        };
        for _ in 0..3000 {
            let mut d = String::from("M10.1 20.7");
            for _ in 0..1 + next(8) {
                let n = |next: &mut dyn FnMut(u64) -> u64| format!(" {}", next(5) as f64 * 33.3);
                let list = |k: usize, next: &mut dyn FnMut(u64) -> u64| (0..k).map(|_| n(next)).collect::<String>();
                let (name, count) =
                    [("L", 2), ("C", 6), ("Q", 4), ("S", 4), ("T", 2), ("A", 2), ("Z", 0)][next(7) as usize];
                if name == "A" {
                    d += &format!("A{} {} {} {} {}", 1 + next(90), 1 + next(90), next(180), next(2), next(2));
                } else {
                    d += name;
                }
                d += &list(count, &mut next);
            }
            agree(&d);
        }
    }
}
