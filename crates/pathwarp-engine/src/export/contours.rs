//! Paths for a machine that cuts or draws: lines are chained where their ends meet, and repeated ones are left out.

use pathwarp::budget::{Budget, Exceeded};
use pathwarp::kurbo::{Line, Point, Rect};
use pathwarp::outline::Subpath;
use pathwarp::{Outline, Seg, distance};
use std::collections::HashMap;
use std::hash::Hash;

/// A contour or an open line, in mm.
#[derive(Debug, Clone)]
pub(super) struct Contour {
    /// The index of its shape in the drawing.
    pub(super) shape: usize,
    pub(super) path: Subpath,
}

/// An index of points by square cells, whose side is the distance `near`.
struct Cells {
    near: f64,
    cells: HashMap<[i64; 2], Vec<usize>>,
}

impl Cells {
    fn new(near: f64) -> Self {
        Self { near, cells: HashMap::new() }
    }

    fn add(&mut self, p: Point, item: usize) {
        self.cells.entry([p.x, p.y].map(|v| (v / self.near).floor() as i64)).or_default().push(item);
    }

    /// Returns the items in the cell of a point and in the eight around it; these include all within `near`.
    fn candidates_near(&self, p: Point) -> impl Iterator<Item = usize> {
        let [x, y] = [p.x, p.y].map(|v| (v / self.near).floor() as i64);
        let keys = (-1..=1).flat_map(move |dx| (-1..=1).map(move |dy| [x.saturating_add(dx), y.saturating_add(dy)]));
        keys.filter_map(|key| self.cells.get(&key)).flatten().copied()
    }
}

/// Returns, for each closed contour, the first earlier one equal to it within `near`, if any. `kind` tells for the index of a shape
/// what the machine does with it, such as its layer and colour; only contours of one kind are equal.
pub(super) fn equal_earlier<K: PartialEq>(
    all: &[Contour],
    kind: impl Fn(usize) -> K,
    near: f64,
    budget: &Budget,
) -> Result<Vec<Option<usize>>, Exceeded> {
    let mut corners_seen = Cells::new(near);
    let whole = |c: &Contour| Outline { subpaths: vec![c.path.clone()] };
    let mut out = vec![None; all.len()];
    for (i, c) in all.iter().enumerate().filter(|(_, c)| c.path.closed) {
        let corners = |r: Rect| [r.origin(), Point::new(r.x1, r.y1)];
        let [low, high] = corners(c.path.bounding_box());
        for earlier in corners_seen.candidates_near(low) {
            let [p, q] = corners(all[earlier].path.bounding_box());
            if kind(all[earlier].shape) == kind(c.shape)
                && [p - low, q - high].iter().all(|by| by.x.abs().max(by.y.abs()) <= near)
                && distance::symmetric_within(&whole(&all[earlier]), &whole(c), budget)?.is_some_and(|d| d <= near)
            {
                out[i] = Some(earlier);
                break;
            }
        }
        if out[i].is_none() {
            corners_seen.add(low, i);
        }
    }
    Ok(out)
}

/// Removes segments of open lines that repeat earlier lines or contours of their shape's `kind` within `near`. Returns their number.
pub(super) fn leave_out_lines<K: PartialEq>(all: &mut Vec<Contour>, kind: impl Fn(usize) -> K, near: f64) -> usize {
    /// A segment is indexed by its point at the first parameter; a reversed one has that point at the second.
    const INDEXED: [f64; 2] = [0.25, 0.75];
    let (mut seen, mut segs): (_, Vec<(usize, Seg)>) = (Cells::new(near), Vec::new());
    for c in all.iter().filter(|c| c.path.closed) {
        for s in &c.path.segs {
            seen.add(s.eval(INDEXED[0]), segs.len());
            segs.push((c.shape, *s));
        }
    }
    let mut left_out = 0;
    for c in std::mem::take(all) {
        if c.path.closed || c.path.segs.is_empty() {
            all.push(c);
            continue;
        }
        let mut runs: Vec<Vec<Seg>> = vec![Vec::new()];
        for s in c.path.segs {
            let repeats = |i: usize| kind(segs[i].0) == kind(c.shape) && are_equal(&segs[i].1, &s, near);
            if INDEXED.iter().flat_map(|t| seen.candidates_near(s.eval(*t))).any(repeats) {
                left_out += 1;
                runs.push(Vec::new());
            } else {
                seen.add(s.eval(INDEXED[0]), segs.len());
                segs.push((c.shape, s));
                runs.last_mut().into_iter().for_each(|run| run.push(s));
            }
        }
        let runs = runs.into_iter().filter_map(|segs| Some((segs.first()?.start(), segs)));
        all.extend(runs.map(|(start, segs)| Contour { shape: c.shape, path: Subpath { start, segs, closed: false } }));
    }
    left_out
}

/// Returns `true` if five points of two segments are equal within `near`, in either direction.
fn are_equal(a: &Seg, b: &Seg, near: f64) -> bool {
    const COMPARED: [f64; 5] = [0.5, 0.0, 1.0, 0.25, 0.75];
    let equals = |b: &dyn Fn(f64) -> Point| COMPARED.iter().all(|t| a.eval(*t).distance(b(*t)) <= near);
    equals(&|t| b.eval(t)) || equals(&|t| b.eval(1.0 - t))
}

/// An end of an open line: the line's index, and `true` for its last point.
type End = (usize, bool);

/// The end that each end is joined to.
type Links = HashMap<End, End>;

/// Joins open lines whose ends meet within `near`. Several ends at one point are joined in pairs: first those of shapes of one `kind`, in
/// drawing order. If their number is odd, they stay apart.
pub(super) fn chained<K: Eq + Hash>(all: &[Contour], kind: impl Fn(usize) -> K, near: f64) -> Vec<Contour> {
    let mut links = Links::new();
    for ends in meetings(all, near) {
        let mut kinds: Vec<(K, Vec<End>)> = Vec::new();
        for end in ends {
            let of_end = kind(all[end.0].shape);
            match kinds.iter_mut().find(|(known, _)| *known == of_end) {
                Some((_, ends)) => ends.push(end),
                None => kinds.push((of_end, vec![end])),
            }
        }
        let join = |ends| link_in_pairs(all, ends, near, false, &mut links);
        let alone: Vec<End> = kinds.into_iter().map(|(_, ends)| ends).flat_map(join).collect();
        link_in_pairs(all, alone, near, false, &mut links);
    }
    chains(all, &links).into_iter().map(|c| c.contour).collect()
}

/// Closes open lines that may be meant as contours: ends up to `REACH` apart are joined, and what is still open is closed by a line.
pub(super) fn closed_roughly(open: &[Contour], near: f64) -> Vec<Chain> {
    /// Ends farther apart than this, in mm, are not meant to meet.
    const REACH: f64 = 2.0;
    let mut links = Links::new();
    for ends in meetings(open, near.max(REACH)) {
        link_in_pairs(open, ends, near, true, &mut links);
    }
    let mut out = chains(open, &links);
    for c in &mut out {
        let path = &mut c.contour.path;
        if !path.closed {
            c.gap = c.gap.max(path.end().distance(path.start));
            path.segs.push(Seg::Line(Line::new(path.end(), path.start)));
            path.closed = true;
        }
    }
    out
}

/// Groups the ends of open lines that meet within `near`.
fn meetings(all: &[Contour], near: f64) -> impl Iterator<Item = Vec<End>> {
    let (mut cells, mut points): (_, Vec<(Point, Vec<End>)>) = (Cells::new(near), Vec::new());
    for (i, c) in all.iter().enumerate().filter(|(_, c)| !c.path.closed && !c.path.segs.is_empty()) {
        for (end, p) in [((i, false), c.path.start), ((i, true), c.path.end())] {
            let known = cells.candidates_near(p).find(|i| points[*i].0.distance(p) <= near);
            let known = known.unwrap_or_else(|| {
                cells.add(p, points.len());
                points.push((p, Vec::new()));
                points.len() - 1
            });
            points[known].1.push(end);
        }
    }
    points.into_iter().map(|(_, ends)| ends)
}

/// Links ends that meet in pairs, unless (without `even_if_odd`) an odd number of different lines meets. A line of one segment is not
/// linked to itself. Returns the ends of a lone line.
fn link_in_pairs(all: &[Contour], ends: Vec<End>, near: f64, even_if_odd: bool, links: &mut Links) -> Vec<End> {
    /// Ends at one point, above which the lines are not meant as contours.
    const MOST_ENDS: usize = 100;
    let last = |(i, at_end): End| {
        let segs = &all[i].path.segs;
        &segs[if at_end { segs.len() - 1 } else { 0 }]
    };
    if ends.len() > MOST_ENDS {
        return Vec::new();
    }
    let is_double = |a: End, b: End| a != b && are_equal(last(a), last(b), near);
    let different = (0..ends.len()).filter(|i| !ends[..*i].iter().any(|e| is_double(*e, ends[*i]))).count();
    if different % 2 == 1 && !even_if_odd {
        return if different == 1 { ends } else { Vec::new() };
    }
    for (i, a) in ends.iter().enumerate() {
        if !links.contains_key(a)
            && let Some(b) = ends[i + 1..].iter().find(|b| !links.contains_key(b) && !is_double(*a, **b))
        {
            links.extend([(*a, *b), (*b, *a)]);
        }
    }
    Vec::new()
}

/// Lines joined end to end.
pub(super) struct Chain {
    /// The indices of the lines.
    pub(super) members: Vec<usize>,
    pub(super) contour: Contour,
    /// The largest distance between ends that were joined.
    pub(super) gap: f64,
}

/// Returns the chains of linked lines, in the order of their first members. A chain that returns to its start is closed.
fn chains(all: &[Contour], links: &Links) -> Vec<Chain> {
    let mut done = vec![false; all.len()];
    let mut out = Vec::with_capacity(all.len());
    for i in 0..all.len() {
        if done[i] {
            continue;
        }
        // Follow the links backwards to the beginning of the chain, or once around it.
        let mut first = (i, false);
        while let Some((before, at_end)) = links.get(&first) {
            first = (*before, !at_end);
            if *before == i {
                break;
            }
        }
        let mut path = from_end(&all[first.0].path, first.1);
        let (mut members, mut last, mut gap) = (vec![first.0], (first.0, !first.1), 0.0_f64);
        while let Some(next) = links.get(&last) {
            let onward = from_end(&all[next.0].path, next.1);
            gap = gap.max(path.end().distance(onward.start));
            if *next == first {
                path.closed = true;
                break;
            }
            let mut more = onward.segs;
            more.iter_mut().take(1).for_each(|s| begin_at(s, path.end()));
            path.segs.extend(more);
            members.push(next.0);
            last = (next.0, !next.1);
        }
        if let Some(closing) = path.segs.last_mut().filter(|_| path.closed) {
            let mut reversed = closing.reversed();
            begin_at(&mut reversed, path.start);
            *closing = reversed.reversed();
        }
        members.iter().for_each(|member| done[*member] = true);
        out.push(Chain { members, contour: Contour { shape: all[i].shape, path }, gap });
    }
    out
}

/// Returns a line in the direction away from one of its ends.
fn from_end(path: &Subpath, at_end: bool) -> Subpath {
    if at_end { path.reversed() } else { path.clone() }
}

/// Moves the start of a segment to `p`, which is close to it.
fn begin_at(s: &mut Seg, p: Point) {
    let by = p - s.start();
    match s {
        Seg::Line(l) => l.p0 = p,
        Seg::Quad(q) => q.p0 = p,
        Seg::Cubic(c) => (c.p0, c.p1) = (p, c.p1 + by),
        Seg::Arc(a) => a.p0 = p,
    }
}
