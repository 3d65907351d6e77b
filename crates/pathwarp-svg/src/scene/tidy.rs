//! Cleaner outlines of strokes. On the inner side of a corner, the two edges cross and run on; here they end where they cross. If
//! they are too short for that, they are joined by way of the corner itself: a straight line would leave part of the stroke bare.
//! Collinear lines, as at miters between lines, become one.

use pathwarp::kurbo::{Line, Point, Vec2};
use pathwarp::{Outline, Seg, Subpath};
use std::collections::HashMap;

/// Largest sine of the angle between lines that become one.
const COLLINEAR: f64 = 1e-10;

/// Relative precision of lengths and crossings.
const PRECISION: f64 = 1e-9;

/// The outline of a stroke of half width `half` along `path`, to be filled by the nonzero rule.
pub(super) fn tidy(outline: Outline, path: &Subpath, half: f64) -> Outline {
    let corners = Corners::of(path, half);
    Outline { subpaths: outline.subpaths.into_iter().map(|s| tidy_subpath(s, half, &corners)).collect() }
}

/// The nodes of a path in cells of a grid.
struct Corners {
    half: f64,
    cells: HashMap<[i64; 2], Point>,
}

impl Corners {
    /// Cells per half width of the stroke.
    const CELLS: f64 = 1e6;

    fn of(path: &Subpath, half: f64) -> Self {
        let mut all = Self { half, cells: HashMap::new() };
        all.cells = path.segs.iter().map(|g| (all.cell(g.start()), g.start())).collect();
        all
    }

    fn cell(&self, p: Point) -> [i64; 2] {
        [p.x, p.y].map(|v| (v / self.half * Self::CELLS).floor() as i64)
    }

    /// The corner at half the width from both ends of an edge's line, to the right of it, where the inside of turns is.
    fn inside(&self, l: &Line) -> Option<Point> {
        let along = l.p1 - l.p0;
        let length = along.hypot();
        let height = (self.half * self.half - 0.25 * length * length).max(0.0).sqrt();
        let at = l.midpoint() + Vec2::new(along.y, -along.x) * (height / length);
        // Rounding may put it into a cell beside its own.
        let near = 0.25 * self.half / Self::CELLS;
        let shifts = [(near, near), (near, -near), (-near, near), (-near, -near)];
        shifts.iter().find_map(|d| self.cells.get(&self.cell(at + *d)).copied())
    }
}

fn tidy_subpath(s: Subpath, half: f64, corners: &Corners) -> Subpath {
    let cyclic = s.closed || s.end() == s.start;
    let mut segs = s.segs;
    segs.retain(|g| !matches!(g, Seg::Line(l) if l.p0 == l.p1));
    if !cyclic || segs.len() < 3 {
        return Subpath { segs, ..s };
    }
    // Start with the longest segment, which is the least likely to vanish.
    let length = |g: &Seg| g.start().distance(g.end());
    let longest = (0..segs.len()).max_by(|i, j| length(&segs[*i]).total_cmp(&length(&segs[*j]))).unwrap_or(0);
    segs.rotate_left(longest);
    // The only curve of an edge meets itself at its corner.
    if let [only, rest @ ..] = &segs[..]
        && rest.iter().all(|g| matches!(g, Seg::Line(_)))
        && let Some(halves) = only.part(0.0, 0.5).zip(only.part(0.5, 1.0))
        && !matches!(only, Seg::Line(_))
    {
        segs.splice(..1, [halves.0, halves.1]);
    }
    let mut out: Vec<Seg> = Vec::with_capacity(segs.len() + 1);
    for g in segs {
        push(&mut out, g, half, corners);
    }
    // The first segment again, for the corner at its start.
    let first = out[0];
    let count = out.len();
    push(&mut out, first, half, corners);
    if out.len() > 2 {
        out.remove(0);
    } else {
        out.truncate(count);
    }
    Subpath { start: out[0].start(), segs: out, closed: true }
}

/// Appends a segment, and removes what lies between it and the last one it crosses.
fn push(out: &mut Vec<Seg>, mut next: Seg, half: f64, corners: &Corners) {
    if let (Some(Seg::Line(last)), Seg::Line(l)) = (out.last(), &next)
        && let Some(one) = as_one(*last, *l)
    {
        next = Seg::Line(one);
        out.pop();
    }
    let between =
        |g: &Seg, least: f64, most: f64| matches!(g, Seg::Line(l) if (least..=most).contains(&(l.length() / half)));
    let pivot = |g: &Seg| between(g, 1.0 - PRECISION, 1.0 + PRECISION);
    let lines = match out.as_slice() {
        // By way of the corner.
        [.., _, a, b] if pivot(a) && pivot(b) => 2,
        // Straight. A butt cap is longer.
        [.., _, a] if between(a, 0.0, 1.99) => 1,
        _ => 0,
    };
    if lines > 0
        && let Some((before, after)) = crossing(&out[out.len() - 1 - lines], &next)
    {
        out.truncate(out.len() - 1 - lines);
        out.push(before);
        next = after;
    } else if let (1, Some(Seg::Line(l))) = (lines, out.last().copied())
        && let Some(corner) = corners.inside(&l)
    {
        out.pop();
        out.extend([Line::new(l.p0, corner), Line::new(corner, l.p1)].map(Seg::Line));
    }
    out.push(next);
}

/// Two consecutive lines as one, if they have the same direction.
fn as_one(a: Line, b: Line) -> Option<Line> {
    let (u, v) = (a.p1 - a.p0, b.p1 - b.p0);
    let same = u.dot(v) > 0.0 && u.cross(v).abs() <= COLLINEAR * u.hypot() * v.hypot();
    same.then_some(Line::new(a.p0, b.p1))
}

/// Cuts two segments of an inner edge where the last half of one crosses the first half of the other. Both strokes then cover
/// what is cut off.
fn crossing(a: &Seg, b: &Seg) -> Option<(Seg, Seg)> {
    /// Newton steps; each doubles the digits.
    const STEPS: usize = 12;
    let (mut s, mut t) = (1.0_f64, 0.0_f64);
    let size = a.start().distance(a.end()) + b.start().distance(b.end());
    for _ in 0..STEPS {
        let (gap, u, v) = (b.eval(t) - a.eval(s), a.deriv(s), b.deriv(t));
        if gap.hypot() <= 1e-14 * size {
            break;
        }
        let det = v.cross(u);
        s += v.cross(gap) / det;
        t += u.cross(gap) / det;
        if !(0.0..=2.0).contains(&s) || !(-1.0..=1.0).contains(&t) {
            return None;
        }
    }
    let at = a.eval(s);
    let met = b.eval(t).distance(at) <= PRECISION * size;
    // The area between the segments is on the inner side of the outline, as that of kurbo's outlines.
    let inner = loop_area(at, a.end(), b.start()) > 0.0;
    if !(met && inner && (0.5..1.0).contains(&s) && t > 0.0 && t <= 0.5) {
        return None;
    }
    Some((with_ends(a.part(0.0, s)?, None, Some(at)), with_ends(b.part(t, 1.0)?, Some(at), None)))
}

fn loop_area(a: Point, b: Point, c: Point) -> f64 {
    (b - a).cross(c - a)
}

/// The same segment with other end points.
fn with_ends(g: Seg, start: Option<Point>, end: Option<Point>) -> Seg {
    let shift = |p: &mut Point, to: Option<Point>| {
        let by = to.map_or(Vec2::ZERO, |to| to - *p);
        *p = to.unwrap_or(*p);
        by
    };
    match g {
        Seg::Line(mut l) => {
            shift(&mut l.p0, start);
            shift(&mut l.p1, end);
            Seg::Line(l)
        }
        Seg::Quad(mut q) => {
            shift(&mut q.p0, start);
            shift(&mut q.p2, end);
            Seg::Quad(q)
        }
        Seg::Cubic(mut c) => {
            c.p1 += shift(&mut c.p0, start);
            c.p2 += shift(&mut c.p3, end);
            Seg::Cubic(c)
        }
        Seg::Arc(_) => g,
    }
}
