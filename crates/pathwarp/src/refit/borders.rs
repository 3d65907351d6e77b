//! Borders that shapes share, simplified once for all of them.
//!
//! Segments are cut at nodes of others that lie on them. A node is a *junction* unless exactly two segments meet there, counting segments
//! of several outlines once. Outlines that share a segment share the whole chain of segments up to the next junctions. A chain is replaced
//! in one direction, from its segments alone, so that the result is the same for all outlines.

use super::limits::ARCS;
use super::options::Options;
use super::report::{PathReport, RefittedPath};
use super::shared::{SharedEdges, is_reversed};
use crate::error::GeometryError;
use crate::outline::{Outline, Seg, Subpath};
use kurbo::{BezPath, Line, ParamCurve, Point};
use std::cmp::Ordering;
use std::collections::HashMap;

/// The distance of a node from a line that it cuts, in tolerances: more than rounding to decimals moves it.
const NODE_ON_LINE: f64 = 1e-2;

/// The borders of a drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Borders {
    nodes: NodeGrid,
    shared: SharedEdges,
}

impl Borders {
    /// The borders among outlines whose subpaths have these tolerances, or `tolerance` if none are given.
    #[must_use]
    pub fn among<'a>(outlines: &[(&'a Outline, &'a [f64])], tolerance: f64) -> Self {
        let nodes = NodeGrid::new(outlines.iter().map(|(o, _)| *o), NODE_ON_LINE * tolerance);
        let cut: Vec<Outline> = outlines.iter().map(|(o, _)| nodes.cut(o)).collect();
        let shared = SharedEdges::held(cut.iter().zip(outlines).map(|(cut, (_, contours))| (cut, *contours)));
        Self { nodes, shared }
    }

    /// The parts of a cut subpath between junctions, in order. In a closed one, the first begins at a junction, if there is one.
    fn chains(&self, s: &Subpath) -> Vec<Vec<Seg>> {
        let mut segs = s.segs.clone();
        if s.closed
            && let Some(first) = segs.iter().position(|g| self.shared.is_junction(g.start()))
        {
            segs.rotate_left(first);
        }
        let mut out: Vec<Vec<Seg>> = Vec::new();
        for g in segs {
            match out.last_mut() {
                Some(last) if !self.shared.is_junction(g.start()) => last.push(g),
                _ => out.push(vec![g]),
            }
        }
        out
    }
}

/// The nodes of a drawing in square cells.
#[derive(Debug, Clone, Default, PartialEq)]
struct NodeGrid {
    /// The side of a cell.
    side: f64,
    /// The distance of a node from a line that it cuts.
    tolerance: f64,
    /// The nodes in each cell, with the number of the only subpath that has them, or `None` for several.
    cells: HashMap<[i64; 2], Vec<(Point, Option<usize>)>>,
}

impl NodeGrid {
    fn new<'a>(outlines: impl Iterator<Item = &'a Outline> + Clone, tolerance: f64) -> Self {
        let lines = || outlines.clone().flat_map(Outline::segs).filter(|g| matches!(g, Seg::Line(_)));
        let (length, count) = lines().fold((0.0, 0.0), |(l, n), g| (l + g.start().distance(g.end()), n + 1.0));
        let mut out = Self { side: (length / count).max(4.0 * tolerance), tolerance, cells: HashMap::new() };
        if !(count > 0.0 && out.side.is_finite()) {
            return out;
        }
        let ends = |s: &Subpath| s.segs.iter().map(Seg::end).chain([s.start]).collect::<Vec<_>>();
        for (i, s) in outlines.flat_map(|o| &o.subpaths).enumerate() {
            for p in ends(s) {
                let nodes = out.cells.entry(out.cell(p)).or_default();
                match nodes.iter_mut().find(|(q, _)| *q == p) {
                    Some((_, owner)) if *owner != Some(i) => *owner = None,
                    Some(_) => {}
                    None => nodes.push((p, Some(i))),
                }
            }
        }
        out
    }

    /// The cell of a point.
    fn cell(&self, p: Point) -> [i64; 2] {
        [p.x, p.y].map(|v| (v / self.side).floor() as i64)
    }

    /// The nodes that lie on a line of a subpath, in order, without those that only this subpath has.
    fn nodes_on(&self, line: Line, subpath: Option<usize>) -> Vec<Point> {
        /// The length in cells beyond which lines are not cut: anything that ends on them is far smaller.
        const MOST_CELLS: f64 = 1e5;
        let (along, length) = (line.p1 - line.p0, line.p0.distance(line.p1));
        let steps = (length / self.side).ceil();
        if !(length > 0.0 && steps < MOST_CELLS) || self.cells.is_empty() {
            return Vec::new();
        }
        let (mut out, mut seen): (Vec<(f64, Point)>, Vec<[i64; 2]>) = (Vec::new(), Vec::new());
        for k in 0..=steps as usize {
            let [x, y] = self.cell(line.eval((k as f64 / steps).min(1.0)));
            for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
                let cell = [x + i, y + j];
                if seen.contains(&cell) {
                    continue;
                }
                seen.push(cell);
                let all = self.cells.get(&cell).into_iter().flatten();
                for (p, _) in all.filter(|(_, owner)| owner.is_none() || *owner != subpath) {
                    let t = (*p - line.p0).dot(along) / (length * length);
                    let is_between = t * length > self.tolerance && (1.0 - t) * length > self.tolerance;
                    if is_between && (*p - line.p0).cross(along).abs() <= self.tolerance * length {
                        out.push((t, *p));
                    }
                }
            }
            // Only cells near the last ones can come again.
            let old = seen.len().saturating_sub(24);
            seen.drain(..old);
        }
        out.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.x.total_cmp(&b.1.x)));
        out.dedup_by(|a, b| a.1 == b.1);
        out.into_iter().map(|(_, p)| p).collect()
    }

    /// The outline with its lines cut at the nodes that lie on them, without segments of no length beside others.
    fn cut(&self, outline: &Outline) -> Outline {
        let parts = |g: &Seg, subpath: Option<usize>| match g {
            Seg::Line(l) => {
                let stops = [vec![l.p0], self.nodes_on(*l, subpath), vec![l.p1]].concat();
                stops.windows(2).map(|w| Seg::Line(Line::new(w[0], w[1]))).collect()
            }
            other => vec![*other],
        };
        let owner = |p: Point| self.cells.get(&self.cell(p))?.iter().find(|(q, _)| *q == p)?.1;
        let is_point = |g: &Seg| matches!(g, Seg::Line(l) if l.p0 == l.p1);
        let cut = |s: &Subpath| {
            let only_points = s.segs.iter().all(is_point);
            let subpath = s.segs.iter().find_map(|g| owner(g.start()));
            let kept = s.segs.iter().filter(|g| only_points || !is_point(g));
            let segs = kept.flat_map(|g| parts(g, subpath)).collect();
            Subpath { segs, ..s.clone() }
        };
        Outline { subpaths: outline.subpaths.iter().map(cut).collect() }
    }
}

/// Gives the subpaths of an outline the fewest nodes within a tolerance. `contours` holds their tolerances; subpaths beyond its end have
/// `options.tolerance`. [`Options::borders`] get the same curves in all outlines that share them. Corners are joints that turn by more
/// than `corner`, in radians; `None` chooses joints where no smooth curve is within the tolerance, see [`bezierfit::Options::corner`].
///
/// # Errors
/// [`GeometryError::NotFinite`] for a coordinate, [`GeometryError::Tolerance`] for a tolerance that is not positive and finite.
pub fn simplified(
    outline: &Outline,
    corner: Option<f64>,
    options: &Options,
    contours: &[f64],
) -> Result<RefittedPath, GeometryError> {
    let (mut path, mut report, borders) = (BezPath::new(), PathReport::default(), &options.borders);
    let nodes = if options.nodes == bezierfit::Nodes::Extremes { options.nodes } else { bezierfit::Nodes::Fewest };
    let mut fit = |segs: Vec<Seg>, closed: bool, tolerance: f64| -> Result<BezPath, GeometryError> {
        let arcs = if segs.iter().any(|g| matches!(g, Seg::Arc(_))) { ARCS * tolerance } else { 0.0 };
        let source = Outline { subpaths: vec![Subpath { start: segs[0].start(), segs, closed }] }.to_bez_path(arcs);
        let options = bezierfit::Options::new(tolerance - arcs).with_certify(options.certify).with_nodes(nodes);
        let fitted = bezierfit::simplify(&source, &corner.map_or(options, |c| options.with_corner(c)))?;
        report.add(PathReport::fitted(&fitted.report, tolerance));
        Ok(fitted.path)
    };
    for (i, s) in borders.nodes.cut(outline).subpaths.into_iter().enumerate() {
        if s.segs.is_empty() {
            path.extend(Outline { subpaths: vec![s] }.to_bez_path(options.tolerance));
            continue;
        }
        let contour = contours.get(i).copied().unwrap_or(options.tolerance);
        let smallest =
            |segs: &[Seg]| segs.iter().filter_map(|g| borders.shared.tolerance_of(g)).fold(contour, f64::min);
        if s.segs.iter().any(|g| borders.shared.is_junction(g.start())) {
            let chains = borders.chains(&s);
            path.move_to(chains[0][0].start());
            for chain in chains {
                let tolerance = smallest(&chain);
                let (chain, is_reversed) = directed(chain);
                let part = fit(chain, false, tolerance)?;
                path.extend(if is_reversed { part.reverse_subpaths() } else { part }.into_iter().skip(1));
            }
            if s.closed {
                path.close_path();
            }
        } else if s.closed && borders.shared.holds_any(&s.segs) {
            let tolerance = smallest(&s.segs);
            let (ring, is_reversed) = directed(from_least(s.segs));
            let part = fit(ring, true, tolerance)?;
            path.extend(if is_reversed { part.reverse_subpaths() } else { part });
        } else {
            path.extend(fit(s.segs, s.closed, contour)?);
        }
    }
    (report.segments_in, report.segments_out) = (outline.segs().count(), path.segments().count());
    Ok(RefittedPath { path, spans: Vec::new(), report })
}

/// Returns the segments in the direction that all outlines with them agree on, and `true` if it is the reverse of the given one.
fn directed(segs: Vec<Seg>) -> (Vec<Seg>, bool) {
    let reversed = is_reversed(&segs);
    (if reversed { segs.iter().rev().map(Seg::reversed).collect() } else { segs }, reversed)
}

/// The segments of a closed path from its node with the least coordinates on.
fn from_least(mut segs: Vec<Seg>) -> Vec<Seg> {
    let key = |g: &Seg| (g.start().x, g.start().y);
    let least = (0..segs.len()).min_by(|a, b| key(&segs[*a]).partial_cmp(&key(&segs[*b])).unwrap_or(Ordering::Equal));
    segs.rotate_left(least.unwrap_or(0));
    segs
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    /// Two areas on either side of a border whose nodes differ, and a line along it.
    #[test]
    fn borders_become_the_same_on_both_sides() {
        let border: Vec<Point> =
            (0..=60).map(|i| Point::new(f64::from(i), 50.0 + 0.3 * f64::from(i * 37 % 11))).collect();
        let d = |points: &[Point]| points.iter().map(|p| format!("L{},{} ", p.x, p.y)).collect::<String>();
        let back: Vec<Point> = border.iter().rev().copied().collect();
        let a = format!("M0,0 {}L60,0Z", d(&border));
        let b = format!("M60,100 {}L0,100Z", d(&back));
        let line = format!("M{},{} {}", border[20].x, border[20].y, d(&border[21..41]));
        let all: Vec<Outline> = [a, b, line].iter().map(|d| Outline::from_svg(d).unwrap()).collect();
        let pairs: Vec<(&Outline, &[f64])> = all.iter().map(|o| (o, &[][..])).collect();
        let borders = Borders::among(&pairs, 2.0);
        let options = Options::new(2.0).with_borders(Arc::new(borders));
        let done: Vec<BezPath> = all.iter().map(|o| simplified(o, None, &options, &[]).unwrap().path).collect();
        let between = |path: &BezPath| {
            let mut segs: Vec<String> = path
                .segments()
                .filter(|s| s.start().y > 49.0 && s.end().y > 49.0 && s.start().y < 60.0 && s.end().y < 60.0)
                .map(|s| if s.start().x < s.end().x { s } else { s.reverse() })
                .map(|s| format!("{s:?}"))
                .collect();
            segs.sort();
            segs
        };
        let [of_a, of_b, of_line] = [0, 1, 2].map(|i| between(&done[i]));
        assert_eq!(of_a, of_b);
        assert!(of_a.len() < 12 && of_line.iter().all(|s| of_a.contains(s)), "{of_a:?}");
    }

    #[test]
    fn lines_are_cut_where_others_end_on_them() {
        let all = ["M0,0H30V10H0Z", "M10,10V20H20V10Z", "M0,10H30V-1"].map(|d| Outline::from_svg(d).unwrap());
        let pairs: Vec<(&Outline, &[f64])> = all.iter().map(|o| (o, &[][..])).collect();
        let borders = Borders::among(&pairs, 0.1);
        let cut = borders.nodes.cut(&all[0]);
        assert_eq!(cut.segs().count(), 6);
        assert!(
            borders.shared.is_junction(Point::new(10.0, 10.0)) && borders.shared.is_junction(Point::new(20.0, 10.0))
        );
        assert!(!borders.shared.is_junction(Point::new(0.0, 0.0)));
    }
}
