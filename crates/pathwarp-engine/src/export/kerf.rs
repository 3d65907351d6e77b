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
        let said = |names: &[String], done: &str| {
            let contours = counted(names.len(), "contour", "contours");
            if names.is_empty() { format!("no contour {done}") } else { format!("{contours} {done}: {}", named(names)) }
        };
        format!("--kerf: {}; {}", said(&self.grew, "grew"), said(&self.shrank, "shrank"))
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
                named(&self.undecided)
            ));
        }
        if !self.crossing.is_empty() {
            out.push(format!("contours that cross each other are no holes to --kerf: {}", named(&self.crossing)));
        }
        if !self.lost.is_empty() {
            let contours = counted(self.lost.len(), "contour", "contours");
            let names = named(&self.lost);
            out.push(format!(
                "--kerf leaves {contours} fewer, as narrow ones close and those that meet unite: {names}"
            ));
        }
        out
    }
}

fn named(names: &[String]) -> String {
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

/// Moves closed contours by half the kerf, away from the material they enclose; open lines stay. A contour is a hole if an odd number of
/// other contours is around it; equal ones (`same`) count once.
pub(super) fn widen(
    all: Vec<Contour>,
    same: &[Option<usize>],
    is_cut: impl Fn(&Contour) -> bool,
    kerf: &Kerf<'_>,
    name: impl Fn(usize) -> String,
) -> Result<(Vec<Contour>, KerfReport), pathwarp::Error> {
    let mut report = KerfReport::default();
    let loops: Vec<Loop> = all.iter().map(Loop::new).collect();
    let counts = |i: &usize| all[*i].path.closed && is_cut(&all[*i]) && same[*i].is_none();
    let depths =
        depths(&loops, (0..all.len()).filter(counts).collect(), kerf, |i| report.crossing.push(name(all[i].of)))?;
    let open: Vec<Contour> = all.iter().filter(|c| !c.path.closed && is_cut(c)).cloned().collect();
    for chain in contours::closed_roughly(&open, kerf.near) {
        let rough = Loop::new(&chain.contour);
        (kerf.spend)(all.len() as f64)?;
        let is_around = || (0..all.len()).filter(counts).any(|i| rough.places(&loops[i])[0] > 0);
        if rough.area() > kerf.near.powi(2) && (chain.gap <= 2.0 * kerf.by || is_around()) {
            report.undecided.extend(chain.members.iter().map(|k| name(open[*k].of)));
        }
    }
    let mut out: Vec<Contour> = Vec::with_capacity(all.len());
    let mut groups: Vec<(usize, usize, Vec<Subpath>)> = Vec::new();
    for (i, c) in all.into_iter().enumerate() {
        let depth = depths[same[i].unwrap_or(i)];
        match groups.iter_mut().rev().take_while(|g| g.0 == c.of).find(|g| g.1 == depth) {
            _ if !c.path.closed || !is_cut(&c) => out.push(c),
            Some(group) => group.2.push(c.path),
            None => groups.push((c.of, depth, vec![c.path])),
        }
    }
    for (of, depth, subpaths) in groups {
        let (side, moves) = match depth % 2 {
            0 => (Side::Outside, &mut report.grew),
            _ => (Side::Inside, &mut report.shrank),
        };
        let offset = Offset { by: kerf.by, join: Join::Miter, side, even_odd: false, open: OpenPaths::Stay };
        let count = subpaths.len();
        let mut to = moved(&Outline { subpaths }, &offset, kerf.refit, &[])?.outline.subpaths;
        to.retain(|s| s.diagonal() > kerf.near);
        moves.extend(to.iter().map(|_| name(of)));
        report.lost.extend((to.len()..count).map(|_| name(of)));
        out.extend(to.into_iter().map(|path| Contour { of, path }));
    }
    Ok((out, report))
}

/// For each contour, the number of others (`among`) around it. Calls `crosses` for those that cross another.
fn depths(
    loops: &[Loop],
    mut among: Vec<usize>,
    kerf: &Kerf<'_>,
    mut crosses: impl FnMut(usize),
) -> Result<Vec<usize>, pathwarp::Error> {
    let mut depths = vec![0; loops.len()];
    let mut crossing = BTreeSet::new();
    among.sort_by(|a, b| loops[*a].bounds.x0.total_cmp(&loops[*b].bounds.x0));
    // Contours that extend as far to the right as the next one's left side.
    let mut beside: Vec<usize> = Vec::new();
    for i in among {
        beside.retain(|k| loops[*k].bounds.x1 >= loops[i].bounds.x0);
        (kerf.spend)(beside.len() as f64)?;
        for (inner, outer) in beside.iter().flat_map(|k| [(i, *k), (*k, i)]) {
            match loops[outer].places(&loops[inner]) {
                [_, 0] => depths[inner] += 1,
                [0, _] => {}
                _ => drop(crossing.insert(inner)),
            }
        }
        beside.push(i);
    }
    crossing.into_iter().for_each(&mut crosses);
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
        const AT: [f64; 3] = [0.2, 0.5, 0.8];
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
        let points = segs.flat_map(|s| AT.map(|t| beside(s, t))).collect();
        Self { path, bounds: c.path.bounding_box(), points }
    }

    /// Returns the numbers of points of another contour that lie inside of this one and outside.
    fn places(&self, other: &Self) -> [usize; 2] {
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
