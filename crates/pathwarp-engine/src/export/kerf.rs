//! Compensation for the width of the cut (kerf): outer contours grow by half of it and holes shrink, so that cut parts have the size drawn.

use super::contours::{self, Contour};
use super::exported::counted;
use crate::readable::listed;
use pathwarp::edit::{Offset, OpenPaths, Side, moved};
use pathwarp::kurbo::{BezPath, Join, Point, Rect, Shape as _};
use pathwarp::outline::Subpath;
use pathwarp::{Outline, refit};
use serde::Serialize;
use std::collections::BTreeSet;

/// The changes that `--kerf` made to the contours of a drawing; each contour is named by its shape.
#[derive(Debug, Clone, Default, Serialize)]
pub struct KerfReport {
    /// Outer contours, which grew.
    pub grew: Vec<String>,
    /// Holes, which shrank.
    pub shrank: Vec<String>,
    /// Open lines that enclose something and therefore stay where they are.
    pub undecided: Vec<String>,
    /// Contours that cross another one; they count as outer ones.
    pub crossing: Vec<String>,
    /// Contours that vanished, or that merged with another of their shape.
    pub lost: Vec<String>,
}

/// Most names in a message; the report lists all.
const NAMED: usize = 6;

impl KerfReport {
    /// Returns a sentence about the contours that grew and those that shrank.
    pub fn note(&self) -> String {
        let clause = |names: &[String], verb: &str| {
            let contours = counted(names.len(), "contour", "contours");
            if names.is_empty() { format!("no contour {verb}") } else { format!("{contours} {verb}: {}", list(names)) }
        };
        format!("--kerf: {}; {}", clause(&self.grew, "grew"), clause(&self.shrank, "shrank"))
    }

    /// Returns `true` if open lines were left as they are, because their inside is unknown.
    pub fn is_partial(&self) -> bool {
        !self.undecided.is_empty()
    }

    /// Returns warnings for whoever cuts the drawing.
    pub(super) fn warnings(&self) -> Vec<String> {
        let mut out = Vec::new();
        if !self.undecided.is_empty() {
            out.push(format!(
                "--kerf cannot tell in from out at open lines that enclose something, which stay: {}; close them, or name them with --engrave",
                list(&self.undecided)
            ));
        }
        if !self.crossing.is_empty() {
            out.push(format!(
                "--kerf does not treat contours that cross each other as holes: {}",
                list(&self.crossing)
            ));
        }
        if !self.lost.is_empty() {
            let contours = counted(self.lost.len(), "contour", "contours");
            let names = list(&self.lost);
            out.push(format!(
                "--kerf leaves {contours} fewer, as narrow ones close and those that meet unite: {names}"
            ));
        }
        out
    }
}

/// Lists the first of some names; neighbours that are equal count once.
fn list(names: &[String]) -> String {
    let mut different: Vec<&String> = names.iter().collect();
    different.dedup();
    listed(&different, NAMED)
}

/// Settings for moving contours.
pub(super) struct Kerf<'a> {
    /// Half the width of the cut.
    pub(super) by: f64,
    /// Distance within which ends meet, and contours are equal.
    pub(super) near: f64,
    pub(super) refit: &'a refit::Options,
    /// Charges the budget for this number of comparisons.
    pub(super) spend: &'a dyn Fn(f64) -> Result<(), pathwarp::Error>,
}

/// Moves closed contours by half the kerf, outwards if they bound a part and inwards if they bound a hole; open lines stay. A contour is a
/// hole if an odd number of other contours is around it; those that equal an earlier one (`equals`) do not count.
pub(super) fn compensate(
    all: Vec<Contour>,
    equals: &[Option<usize>],
    is_cut: impl Fn(&Contour) -> bool,
    kerf: &Kerf<'_>,
    name: impl Fn(usize) -> String,
) -> Result<(Vec<Contour>, KerfReport), pathwarp::Error> {
    let mut report = KerfReport::default();
    let loops: Vec<Loop> = all.iter().map(Loop::new).collect();
    let counts = |i: &usize| all[*i].path.closed && is_cut(&all[*i]) && equals[*i].is_none();
    let candidates: Vec<usize> = (0..all.len()).filter(counts).collect();
    let depths = depths(&loops, candidates.clone(), kerf, |i| report.crossing.push(name(all[i].shape)))?;
    let open: Vec<Contour> = all.iter().filter(|c| !c.path.closed && is_cut(c)).cloned().collect();
    for chain in contours::closed_roughly(&open, kerf.near) {
        let rough = Loop::new(&chain.contour);
        (kerf.spend)(all.len() as f64)?;
        let is_around = || candidates.iter().any(|i| rough.points_inside_and_outside(&loops[*i])[0] > 0);
        if rough.area() > kerf.near.powi(2) && (chain.gap <= 2.0 * kerf.by || is_around()) {
            report.undecided.extend(chain.members.iter().map(|member| name(open[*member].shape)));
        }
    }
    let mut out: Vec<Contour> = Vec::with_capacity(all.len());
    // Contours of one shape and depth move together, so that those that meet unite.
    let mut groups: Vec<(usize, usize, Vec<Subpath>)> = Vec::new();
    for (i, c) in all.into_iter().enumerate() {
        let depth = depths[equals[i].unwrap_or(i)];
        match groups.iter_mut().rev().take_while(|g| g.0 == c.shape).find(|g| g.1 == depth) {
            _ if !c.path.closed || !is_cut(&c) => out.push(c),
            Some((.., subpaths)) => subpaths.push(c.path),
            None => groups.push((c.shape, depth, vec![c.path])),
        }
    }
    for (shape, depth, subpaths) in groups {
        let (side, moves) = match depth % 2 {
            0 => (Side::Outside, &mut report.grew),
            _ => (Side::Inside, &mut report.shrank),
        };
        let offset = Offset { by: kerf.by, join: Join::Miter, side, even_odd: false, open: OpenPaths::Stay };
        let count = subpaths.len();
        let mut to = moved(&Outline { subpaths }, &offset, kerf.refit, &[])?.outline.subpaths;
        to.retain(|s| s.diagonal() > kerf.near);
        moves.extend(to.iter().map(|_| name(shape)));
        report.lost.extend((to.len()..count).map(|_| name(shape)));
        out.extend(to.into_iter().map(|path| Contour { shape, path }));
    }
    Ok((out, report))
}

/// Returns, for each contour, the number of `candidates` around it. Calls `crosses` for those that cross another.
fn depths(
    loops: &[Loop],
    mut candidates: Vec<usize>,
    kerf: &Kerf<'_>,
    crosses: impl FnMut(usize),
) -> Result<Vec<usize>, pathwarp::Error> {
    let mut depths = vec![0; loops.len()];
    let mut crossing = BTreeSet::new();
    // A sweep from left to right: `open` holds the contours whose right side it has not passed.
    candidates.sort_by(|a, b| loops[*a].bounds.x0.total_cmp(&loops[*b].bounds.x0));
    let mut open: Vec<usize> = Vec::new();
    for i in candidates {
        open.retain(|other| loops[*other].bounds.x1 >= loops[i].bounds.x0);
        (kerf.spend)(open.len() as f64)?;
        for (inner, outer) in open.iter().flat_map(|other| [(i, *other), (*other, i)]) {
            match loops[outer].points_inside_and_outside(&loops[inner]) {
                [_, 0] => depths[inner] += 1,
                [0, _] => {}
                _ => drop(crossing.insert(inner)),
            }
        }
        open.push(i);
    }
    crossing.into_iter().for_each(crosses);
    Ok(depths)
}

/// A contour, prepared for tests of points.
struct Loop {
    path: BezPath,
    bounds: Rect,
    /// Points just inside of it.
    points: Vec<Point>,
}

impl Loop {
    fn new(c: &Contour) -> Self {
        /// Most segments that get points, and the parameters of the points.
        const MOST: usize = 8;
        const PARAMETERS: [f64; 3] = [0.2, 0.5, 0.8];
        /// Distance of the points from the contour, as a share of its size; larger than the error of arcs as cubics.
        const BESIDE: f64 = 1e-4;
        let size = c.path.diagonal();
        let path = Outline { subpaths: vec![c.path.clone()] }.to_bez_path(BESIDE * size);
        let inwards = BESIDE * size * path.area().signum();
        let segs = c.path.segs.iter().step_by(c.path.segs.len().div_ceil(MOST).max(1));
        let beside = |s: &pathwarp::Seg, t: f64| {
            let along = s.deriv(t);
            s.eval(t) + along.turn_90() * (inwards / along.hypot().max(f64::MIN_POSITIVE))
        };
        let points = segs.flat_map(|s| PARAMETERS.map(|t| beside(s, t))).collect();
        Self { path, bounds: c.path.bounding_box(), points }
    }

    /// Returns the numbers of points of another contour that lie inside of this one and outside.
    fn points_inside_and_outside(&self, other: &Self) -> [usize; 2] {
        if self.bounds.intersect(other.bounds).is_zero_area() {
            return [0, other.points.len()];
        }
        let is_inside = |p: &&Point| self.bounds.contains(**p) && self.path.winding(**p) != 0;
        let inside = other.points.iter().filter(is_inside).count();
        [inside, other.points.len() - inside]
    }

    fn area(&self) -> f64 {
        self.path.area().abs()
    }
}
