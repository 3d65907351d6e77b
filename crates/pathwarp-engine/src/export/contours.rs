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
    /// The index of its shape.
    pub(super) of: usize,
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
    fn around(&self, p: Point) -> impl Iterator<Item = usize> {
        let [x, y] = [p.x, p.y].map(|v| (v / self.near).floor() as i64);
        let keys = (-1..=1).flat_map(move |i| (-1..=1).map(move |k| [x.saturating_add(i), y.saturating_add(k)]));
        keys.filter_map(|key| self.cells.get(&key)).flatten().copied()
    }
}

/// For each closed contour, the first earlier one equal to it within `near`, if any. Their shapes must agree in `among`.
pub(super) fn same<K: PartialEq>(
    all: &[Contour],
    among: impl Fn(usize) -> K,
    near: f64,
    budget: &Budget,
) -> Result<Vec<Option<usize>>, Exceeded> {
    let mut seen = Cells::new(near);
    let whole = |c: &Contour| Outline { subpaths: vec![c.path.clone()] };
    let mut out = vec![None; all.len()];
    for (i, c) in all.iter().enumerate().filter(|(_, c)| c.path.closed) {
        let b = c.path.bounding_box();
        let corners = |b: Rect| [b.origin(), Point::new(b.x1, b.y1)];
        for k in seen.around(b.origin()) {
            let [p, q] = corners(all[k].path.bounding_box());
            if among(all[k].of) == among(c.of)
                && [p - b.origin(), q - corners(b)[1]].iter().all(|by| by.x.abs().max(by.y.abs()) <= near)
                && distance::symmetric_within(&whole(&all[k]), &whole(c), budget)?.is_some_and(|d| d <= near)
            {
                out[i] = Some(k);
                break;
            }
        }
        if out[i].is_none() {
            seen.add(b.origin(), i);
        }
    }
    Ok(out)
}

/// Removes segments of open lines that repeat earlier lines or parts of contours within `near`. Returns their number.
pub(super) fn leave_out_lines<K: PartialEq>(all: &mut Vec<Contour>, among: impl Fn(usize) -> K, near: f64) -> usize {
    /// Parameters at which a segment is compared; the set is its own mirror image, so it serves for the reversed segment, too.
    const OF_BOTH: [f64; 2] = [0.25, 0.75];
    let (mut seen, mut segs): (_, Vec<(usize, Seg)>) = (Cells::new(near), Vec::new());
    for c in all.iter().filter(|c| c.path.closed) {
        for s in &c.path.segs {
            seen.add(s.eval(OF_BOTH[0]), segs.len());
            segs.push((c.of, *s));
        }
    }
    let mut left_out = 0;
    let lines = std::mem::take(all);
    for c in lines {
        if c.path.closed || c.path.segs.is_empty() {
            all.push(c);
            continue;
        }
        let mut runs: Vec<Vec<Seg>> = vec![Vec::new()];
        for s in c.path.segs {
            let is_known = |k: &usize| among(segs[*k].0) == among(c.of) && alike(&segs[*k].1, &s, near);
            if OF_BOTH.iter().flat_map(|t| seen.around(s.eval(*t))).any(|k| is_known(&k)) {
                left_out += 1;
                runs.push(Vec::new());
            } else {
                seen.add(s.eval(OF_BOTH[0]), segs.len());
                segs.push((c.of, s));
                runs.last_mut().into_iter().for_each(|run| run.push(s));
            }
        }
        let runs = runs.into_iter().filter_map(|segs| Some((segs.first()?.start(), segs)));
        all.extend(runs.map(|(start, segs)| Contour { of: c.of, path: Subpath { start, segs, closed: false } }));
    }
    left_out
}

/// Returns `true` if two segments are about equal within `near`, in either direction.
fn alike(a: &Seg, b: &Seg, near: f64) -> bool {
    const AT: [f64; 5] = [0.5, 0.0, 1.0, 0.25, 0.75];
    let same = |b: &dyn Fn(f64) -> Point| AT.iter().all(|t| a.eval(*t).distance(b(*t)) <= near);
    same(&|t| b.eval(t)) || same(&|t| b.eval(1.0 - t))
}

/// An end of an open line: the line's index, and `true` for its last point.
type End = (usize, bool);

/// The end that each end is joined to.
type Links = HashMap<End, End>;

/// Joins open lines whose ends meet within `near`. Several ends at one point are joined in pairs: first those of one kind (`among`), in
/// drawing order. If their number is odd, they stay apart.
pub(super) fn chained<K: Eq + Hash>(all: &[Contour], among: impl Fn(usize) -> K, near: f64) -> Vec<Contour> {
    let mut links = Links::new();
    for ends in meetings(all, near) {
        let mut kinds: Vec<(K, Vec<End>)> = Vec::new();
        for end in ends {
            let kind = among(all[end.0].of);
            match kinds.iter_mut().find(|(k, _)| *k == kind) {
                Some((_, ends)) => ends.push(end),
                None => kinds.push((kind, vec![end])),
            }
        }
        let join = |ends| paired(all, ends, near, false, &mut links);
        let alone: Vec<End> = kinds.into_iter().map(|k| k.1).flat_map(join).collect();
        paired(all, alone, near, false, &mut links);
    }
    joined(all, &links).into_iter().map(|c| c.contour).collect()
}

/// Joins open lines to contours that they may be meant as: ends up to some millimetres apart are joined, and gaps closed by lines.
pub(super) fn closed_roughly(open: &[Contour], near: f64) -> Vec<Chain> {
    /// Ends farther apart than this, in mm, are not meant to meet.
    const REACH: f64 = 2.0;
    let mut links = Links::new();
    for ends in meetings(open, near.max(REACH)) {
        paired(open, ends, near, true, &mut links);
    }
    let mut out = joined(open, &links);
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
    let (mut cells, mut places): (_, Vec<(Point, Vec<End>)>) = (Cells::new(near), Vec::new());
    for (i, c) in all.iter().enumerate().filter(|(_, c)| !c.path.closed && !c.path.segs.is_empty()) {
        for (end, p) in [((i, false), c.path.start), ((i, true), c.path.end())] {
            let known = cells.around(p).find(|k| places[*k].0.distance(p) <= near);
            let place = known.unwrap_or_else(|| {
                cells.add(p, places.len());
                places.push((p, Vec::new()));
                places.len() - 1
            });
            places[place].1.push(end);
        }
    }
    places.into_iter().map(|(_, ends)| ends)
}

/// Ends at one point, above which the lines are not meant as contours.
const MOST_ENDS: usize = 100;

/// Joins ends that meet in pairs, unless (without `forced`) an odd number of different lines meets. Returns the ends of a lone line.
fn paired(all: &[Contour], ends: Vec<End>, near: f64, forced: bool, links: &mut Links) -> Vec<End> {
    let last = |(i, at_end): End| {
        let segs = &all[i].path.segs;
        &segs[if at_end { segs.len() - 1 } else { 0 }]
    };
    if ends.len() > MOST_ENDS {
        return Vec::new();
    }
    let is_double = |a: End, b: End| a != b && alike(last(a), last(b), near);
    let different = (0..ends.len()).filter(|i| !ends[..*i].iter().any(|e| is_double(*e, ends[*i]))).count();
    if different % 2 == 1 && !forced {
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
fn joined(all: &[Contour], links: &Links) -> Vec<Chain> {
    let mut done = vec![false; all.len()];
    let mut out = Vec::with_capacity(all.len());
    for i in 0..all.len() {
        if done[i] {
            continue;
        }
        // Follow the links backwards to the beginning of the chain, or once around it.
        let mut first = (i, false);
        while let Some((k, at_end)) = links.get(&first) {
            first = (*k, !at_end);
            if *k == i {
                break;
            }
        }
        let mut path = from_end(&all[first.0].path, first.1);
        let (mut members, mut at, mut gap) = (vec![first.0], (first.0, !first.1), 0.0_f64);
        while let Some(next) = links.get(&at) {
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
            at = (next.0, !next.1);
        }
        if let Some(last) = path.segs.last_mut().filter(|_| path.closed) {
            let mut back = last.reversed();
            begin_at(&mut back, path.start);
            *last = back.reversed();
        }
        members.iter().for_each(|k| done[*k] = true);
        out.push(Chain { members, contour: Contour { of: all[i].of, path }, gap });
    }
    out
}

/// Returns a line that starts at one of its ends.
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
