//! usvg's paths: conversion to f64, and comparison with outlines read from the source.

use pathwarp::Outline;
use pathwarp::kurbo::Point;
use pathwarp::outline::{Builder, Seg, Subpath};
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
    let mut rest = theirs.segs.iter().filter(|s| s.start() != s.end()).peekable();
    let mut matched = close(ours.start, theirs.start);
    for s in &ours.segs {
        match s {
            // usvg's cubics share the arc's ends and stay within 0.1 of it.
            Seg::Arc(arc) => matched &= rest.by_ref().any(|t| close(t.end(), arc.p1)),
            s if close(s.start(), s.end()) && matches!(s, Seg::Line(_)) => {
                // usvg may have dropped a line that has no length in f32.
                if rest.peek().is_some_and(|t| matches!(t, Seg::Line(_)) && close(t.start(), t.end())) {
                    rest.next();
                }
            }
            s => {
                matched &= rest.next().is_some_and(|t| {
                    let (c, d) = (s.to_cubic(), t.to_cubic());
                    close(c.p1, d.p1) && close(c.p2, d.p2) && close(c.p3, d.p3)
                });
            }
        }
        if !matched {
            return false;
        }
    }
    // f32 rounding may add a closing line.
    matched && rest.all(|t| close(t.start(), t.end()))
}
