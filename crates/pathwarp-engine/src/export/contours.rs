//! The lines that a machine follows: chained where their ends meet, and each of them once.

use pathwarp::budget::{Budget, Exceeded};
use pathwarp::kurbo::{Line, Point};
use pathwarp::outline::Subpath;
use pathwarp::{Outline, Seg, distance};
use std::collections::HashMap;
use std::hash::Hash;

/// A contour or an open line, in mm.
#[derive(Debug, Clone)]
pub(super) struct Contour {
    /// The index of the shape that it belongs to.
    pub(super) of: usize,
    pub(super) path: Subpath,
}

/// Coordinates by cells, so that what is near is found without looking at everything.
struct Cells<const N: usize> {
    near: f64,
    cells: HashMap<[i64; N], Vec<usize>>,
}

impl<const N: usize> Cells<N> {
    fn new(near: f64) -> Self {
        Self { near, cells: HashMap::new() }
    }

    fn cell(&self, v: f64) -> i64 {
        /// Width of a cell: few places are near to several.
        const WIDTH: f64 = 8.0;
        (v / (WIDTH * self.near)).floor() as i64
    }

    fn add(&mut self, at: [f64; N], item: usize) {
        self.cells.entry(at.map(|v| self.cell(v))).or_default().push(item);
    }

    /// What lies in the cells that are near to a place.
    fn around(&self, at: [f64; N]) -> Vec<usize> {
        let mut keys = vec![[0; N]];
        for (k, v) in at.iter().enumerate() {
            let [low, high] = [v - self.near, v + self.near].map(|v| self.cell(v));
            keys = keys
                .into_iter()
                .flat_map(|key| (low..=high).map(move |c| std::array::from_fn(|i| if i == k { c } else { key[i] })))
                .collect();
        }
        keys.iter().filter_map(|key| self.cells.get(key)).flatten().copied().collect()
    }
}

/// For each closed contour, the first one that is the same within `near`, if there is one before it. `among` tells which are compared.
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
        let at = [b.x0, b.y0, b.x1, b.y1];
        for k in seen.around(at) {
            if among(all[k].of) == among(c.of)
                && (all[k].path == c.path
                    || distance::symmetric_within(&whole(&all[k]), &whole(c), budget)?.is_some_and(|d| d <= near))
            {
                out[i] = Some(k);
                break;
            }
        }
        if out[i].is_none() {
            seen.add(at, i);
        }
    }
    Ok(out)
}

/// Leaves out the segments of open lines that are drawn before, within `near`, also as parts of contours. Returns their number.
pub(super) fn leave_out_lines<K: PartialEq>(all: &mut Vec<Contour>, among: impl Fn(usize) -> K, near: f64) -> usize {
    let (mut seen, mut segs): (_, Vec<(usize, Seg)>) = (Cells::new(near), Vec::new());
    let middle = |s: &Seg| -> [f64; 2] { <(f64, f64)>::from(s.eval(0.5)).into() };
    for c in all.iter().filter(|c| c.path.closed) {
        for s in &c.path.segs {
            seen.add(middle(s), segs.len());
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
            if seen.around(middle(&s)).iter().any(is_known) {
                left_out += 1;
                runs.push(Vec::new());
            } else {
                seen.add(middle(&s), segs.len());
                segs.push((c.of, s));
                runs.last_mut().into_iter().for_each(|run| run.push(s));
            }
        }
        let runs = runs.into_iter().filter_map(|segs| Some((segs.first()?.start(), segs)));
        all.extend(runs.map(|(start, segs)| Contour { of: c.of, path: Subpath { start, segs, closed: false } }));
    }
    left_out
}

/// Whether two segments are the same within about `near`, in either direction.
fn alike(a: &Seg, b: &Seg, near: f64) -> bool {
    const AT: [f64; 5] = [0.5, 0.0, 1.0, 0.25, 0.75];
    let same = |b: &dyn Fn(f64) -> Point| AT.iter().all(|t| a.eval(*t).distance(b(*t)) <= near);
    same(&|t| b.eval(t)) || same(&|t| b.eval(1.0 - t))
}

/// An end of an open line: its place among all lines, and `true` for the last point.
type End = (usize, bool);

/// The end that each end is joined to.
type Links = HashMap<End, End>;

/// Joins open lines whose ends meet within `near`: two at one place, and several in pairs, those of one kind (`among`) first and in the
/// order in which they are drawn. Where an odd number meets, they stay apart.
pub(super) fn chained<K: Eq + Hash>(all: Vec<Contour>, among: impl Fn(usize) -> K, near: f64) -> Vec<Contour> {
    let (mut cells, mut places): (_, Vec<(Point, Vec<End>)>) = (Cells::new(near), Vec::new());
    for (end, p) in ends(&all) {
        let at = [p.x, p.y];
        let known = cells.around(at).into_iter().find(|k| places[*k].0.distance(p) <= near);
        let place = known.unwrap_or_else(|| {
            cells.add(at, places.len());
            places.push((p, Vec::new()));
            places.len() - 1
        });
        places[place].1.push(end);
    }
    let last = |(i, at_end): End| {
        let segs = &all[i].path.segs;
        if at_end { segs[segs.len() - 1] } else { segs[0] }
    };
    let is_double = |a: End, b: End| a != b && alike(&last(a), &last(b), near);
    let mut links = Links::new();
    for (_, ends) in places {
        let mut kinds: Vec<(K, Vec<End>)> = Vec::new();
        for end in ends {
            let kind = among(all[end.0].of);
            match kinds.iter_mut().find(|(k, _)| *k == kind) {
                Some((_, ends)) => ends.push(end),
                None => kinds.push((kind, vec![end])),
            }
        }
        let alone: Vec<End> = kinds.into_iter().flat_map(|(_, ends)| paired(ends, is_double, &mut links)).collect();
        paired(alone, is_double, &mut links);
    }
    joined(&all, &links).into_iter().map(|c| c.contour).collect()
}

/// Joins ends at one place in pairs, unless an odd number of different lines ends there. Returns the ends of a line that is alone there.
fn paired(ends: Vec<End>, is_double: impl Fn(End, End) -> bool, links: &mut Links) -> Vec<End> {
    let different = (0..ends.len()).filter(|i| !ends[..*i].iter().any(|e| is_double(*e, ends[*i]))).count();
    if different % 2 == 1 {
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

/// The ends of the open lines.
fn ends(all: &[Contour]) -> impl Iterator<Item = (End, Point)> {
    let open = all.iter().enumerate().filter(|(_, c)| !c.path.closed && !c.path.segs.is_empty());
    open.flat_map(|(i, c)| [((i, false), c.path.start), ((i, true), c.path.end())])
}

/// Lines that follow each other.
pub(super) struct Chain {
    /// The lines, by their place among all.
    pub(super) members: Vec<usize>,
    pub(super) contour: Contour,
    /// The largest distance between ends that were joined.
    pub(super) gap: f64,
}

/// The lines along the links, in the order of their first members; those that come round are closed.
fn joined(all: &[Contour], links: &Links) -> Vec<Chain> {
    let mut done = vec![false; all.len()];
    let mut out = Vec::with_capacity(all.len());
    for i in 0..all.len() {
        if done[i] {
            continue;
        }
        // Back to where the line begins, or once around.
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

/// A line from one of its ends.
fn from_end(path: &Subpath, at_end: bool) -> Subpath {
    if at_end { path.reversed() } else { path.clone() }
}

/// Moves the first point of a segment by a hair.
fn begin_at(s: &mut Seg, p: Point) {
    let by = p - s.start();
    match s {
        Seg::Line(l) => l.p0 = p,
        Seg::Quad(q) => q.p0 = p,
        Seg::Cubic(c) => (c.p0, c.p1) = (p, c.p1 + by),
        Seg::Arc(a) => a.p0 = p,
    }
}

/// Open lines as contours, to find what they may be meant to enclose: joined where the nearest end of each is the other, no farther away
/// than a tenth of their lengths, and closed by lines.
pub(super) fn closed_roughly(open: &[Contour]) -> Vec<Chain> {
    /// Of the size of the shorter of two lines.
    const GAP: f64 = 0.1;
    let mut sorted: Vec<(End, Point)> = ends(open).collect();
    sorted.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
    let nearest = |k: usize| -> Option<usize> {
        let p = sorted[k].1;
        let mut best: Option<(f64, usize)> = None;
        let mut look = |j: usize| {
            let reach = best.map_or(GAP * open[sorted[k].0.0].path.diagonal(), |b| b.0);
            let d = sorted[j].1.distance(p);
            if d <= reach && best.is_none_or(|b| d < b.0) {
                best = Some((d, j));
            }
            (sorted[j].1.x - p.x).abs() <= reach
        };
        let _ = (0..k).rev().all(&mut look);
        let _ = (k + 1..sorted.len()).all(&mut look);
        best.map(|b| b.1)
    };
    let all: Vec<Option<usize>> = (0..sorted.len()).map(nearest).collect();
    let mut links = Links::new();
    for (k, near) in all.iter().enumerate() {
        if let Some(j) = near.filter(|j| all[*j] == Some(k)) {
            links.insert(sorted[k].0, sorted[j].0);
        }
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
