//! Unions, intersections and differences of areas, and areas that grow or shrink.
//!
//! linesweeper finds the crossings of edges and the winding numbers on both sides; results are simplified. To move the outlines of an area,
//! the curves beside them are fitted, with joins at corners. What they enclose in the outlines' direction belongs to the grown area, and is
//! all that is left of a shrunken one. Where outlines are so rough that most of these curves would cross, strips beside them (`strips`)
//! are united instead.

use crate::limits::{CROSSINGS, EDGES, SIMPLIFIED, SMOOTH_JOINT, SOURCE};
use crate::options::{Error, Options};
use crate::path::{Segment, simplify, subpaths};
use crate::report::{Assurance, Fitted, Report};
use crate::scale::turn;
use crate::source::NotFinite;
use crate::strips::{Neighbors, cell_of, strips};
use crate::stroke::{Edge, beside_area, beside_path, edges_beside_area, fit_contours, stroke};
use kurbo::{
    Affine, BezPath, Cap, Join, ParamCurve, ParamCurveArclen, ParamCurveNearest, PathEl, PathSeg, Point, Shape, Stroke,
};
use linesweeper::topology::{BinaryWindingNumber, Topology};
use std::collections::HashMap;
use std::panic::{self, AssertUnwindSafe};

/// Angles in radians by which paths are turned before the sweep, one after the other until it succeeds. linesweeper 0.5 rarely panics,
/// and mostly where edges lie along the axes, as they do in drawings.
const SWEEP_ANGLES: [f64; 6] = [0.3, 1.1, 0.7, 2.0, 2.6, 1.4];

/// Largest mean number of neighbours of a node within the distance; beyond it, outlines are moved in strips.
const MOST_NEIGHBORS: usize = 4;
/// Areas with fewer nodes are taken to have this many.
const FEW_NODES: usize = 3000;

/// Most pairs of segments of a result and its source that are compared.
const MAX_COMPARED: usize = 2_000_000;

/// Share of the distance that bevels keep at corners that turn by up to 120°: the cosine of half the turn.
const BEVELS: f64 = 0.5;

/// Limit of miters, the usual one in SVG.
const MITER_LIMIT: f64 = 4.0;

/// The area that a path covers under the nonzero rule, with outlines that meet neither themselves nor each other, within
/// `tolerance`. Slivers that are narrower are dropped.
///
/// # Errors
/// [`Error::NotFinite`] if a coordinate is not finite, [`Error::Crossings`] if the crossings of edges are not found.
///
/// ```
/// use kurbo::{BezPath, Shape};
///
/// let two = BezPath::from_svg("M0 0H60V60H0ZM40 40H100V100H40Z").unwrap();
/// let one = bezierfit::union(&two, 0.01)?;
/// assert_eq!(one.segments().count(), 8);
/// assert!((one.area().abs() - 6800.0).abs() < 1e-3);
/// # Ok::<(), bezierfit::Error>(())
/// ```
pub fn union(path: &BezPath, tolerance: f64) -> Result<BezPath, Error> {
    area_where(path, &BezPath::new(), tolerance, |w| w.shape_a != 0)
}

/// The area that a path covers under the even-odd rule: that inside an odd number of outlines.
///
/// # Errors
/// [`Error::NotFinite`] if a coordinate is not finite, [`Error::Crossings`] if the crossings of edges are not found.
pub fn union_even_odd(path: &BezPath, tolerance: f64) -> Result<BezPath, Error> {
    area_where(path, &BezPath::new(), tolerance, |w| w.shape_a % 2 != 0)
}

/// The area that lies in both of two areas, each covered under the nonzero rule.
///
/// # Errors
/// [`Error::NotFinite`] if a coordinate is not finite, [`Error::Crossings`] if the crossings of edges are not found.
pub fn intersection(a: &BezPath, b: &BezPath, tolerance: f64) -> Result<BezPath, Error> {
    area_where(a, b, tolerance, |w| w.shape_a != 0 && w.shape_b != 0)
}

/// The area that lies in the first of two areas and not in the second.
///
/// # Errors
/// [`Error::NotFinite`] if a coordinate is not finite, [`Error::Crossings`] if the crossings of edges are not found.
pub fn difference(a: &BezPath, b: &BezPath, tolerance: f64) -> Result<BezPath, Error> {
    area_where(a, b, tolerance, |w| w.shape_a != 0 && w.shape_b == 0)
}

/// Moves outlines by a distance. Closed subpaths are outlines of an area under the nonzero rule, which grows, or shrinks if the distance
/// is negative. Open subpaths become the path beside them: to their left where y points up, to their right where y points down; on
/// the other side if the distance is negative. Parts nearer to the source than the distance are removed. Corners are joined as in strokes.
/// Miters longer than four times the distance are cut off on areas and left out on open subpaths.
///
/// # Errors
/// [`Error::NotFinite`] if a coordinate is not finite, [`Error::Crossings`] if crossings are not found, and the errors of [`simplify`].
///
/// ```
/// use bezierfit::{Options, offset};
/// use kurbo::{BezPath, Join, Shape};
///
/// let square = BezPath::from_svg("M0 0H60V60H0Z").unwrap();
/// let larger = offset(&square, 10.0, Join::Miter, &Options::new(0.01))?;
/// assert!((larger.path.area().abs() - 6400.0).abs() < 1.0);
/// let smaller = offset(&square, -10.0, Join::Miter, &Options::new(0.01))?;
/// assert!((smaller.path.area().abs() - 1600.0).abs() < 1.0);
/// assert!(offset(&square, -31.0, Join::Miter, &Options::new(0.01))?.path.is_empty());
/// # Ok::<(), bezierfit::Error>(())
/// ```
pub fn offset(path: &BezPath, distance: f64, join: Join, options: &Options) -> Result<Fitted, Error> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    if !path.is_finite() || !distance.is_finite() {
        return Err(NotFinite { t: 0.0, at: Point::new(f64::NAN, f64::NAN) }.into());
    }
    if distance == 0.0 {
        out.path = path.clone();
        return Ok(out);
    }
    let style = Stroke::new(2.0 * distance.abs()).with_join(join).with_caps(Cap::Round).with_miter_limit(MITER_LIMIT);
    // The shares of the tolerance have the sum 1. With `best`, the report lists where one is not met.
    let fine = Options { tolerance: EDGES * options.tolerance, ..*options };
    let rest = Options { tolerance: SIMPLIFIED * options.tolerance, best: true, ..*options };
    let starts: Vec<Point> = subpaths(path).filter_map(|s| s.segments().next().map(|s| s.start())).collect();
    let path = &lighter_path(path, &Options { tolerance: SOURCE * options.tolerance, best: true, ..*options })?;
    let mut area = BezPath::new();
    for subpath in subpaths(path) {
        if matches!(subpath.elements().last(), Some(PathEl::ClosePath)) {
            area.extend(&subpath);
            continue;
        }
        // The outline of the stroke's area has no loops. Its parts on the wanted side are kept.
        let edge = stroke(&subpath, &style, &fine)?;
        let near = area_where(&edge.path, &BezPath::new(), options.tolerance, |w| w.shape_a != 0)?;
        let side = beside_path(&subpath, &style, distance, &fine)?;
        for chain in chains_along(&near, &side, options.tolerance) {
            append_part(&mut out, &simplify(&chain, &rest)?, edge.report.clone(), (distance.abs(), options));
        }
    }
    // The union removes edges inside the area.
    let area = union(&area, options.tolerance)?;
    if !area.is_empty() {
        let moved = grow(&area, distance, &style, &starts, options)?;
        out.path.extend(&moved.path);
        out.report.add(&moved.report);
    }
    if !out.path.is_empty() {
        let before = (SOURCE + EDGES + 2.0 * CROSSINGS) * options.tolerance;
        out.report.add_error(before + out.report.max_error, Assurance::Checked);
    }
    Ok(out)
}

/// The path, or a simplified one if that has less than half as many segments.
fn lighter_path(path: &BezPath, options: &Options) -> Result<BezPath, Error> {
    let simple = simplify(path, options)?.path;
    Ok(if 2 * simple.segments().count() < path.segments().count() { simple } else { path.clone() })
}

/// Moves the outlines of an area. The results begin near one of `starts`.
fn grow(area: &BezPath, distance: f64, style: &Stroke, starts: &[Point], options: &Options) -> Result<Fitted, Error> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    let fine = Options { tolerance: EDGES * options.tolerance, ..*options };
    let rest = Options { tolerance: SIMPLIFIED * options.tolerance, best: true, ..*options };
    // All outlines have the area on one side. Distances are positive to the left where y points up.
    let (outside, turn) = if area.area() > 0.0 { (-distance, 1) } else { (distance, -1) };
    let turns_with = |w: &BinaryWindingNumber| w.shape_b * turn > 0;
    let (edge, moved) = if style.join == Join::Round && is_crowded(area, distance) {
        let edges = edges_beside_area(area, style, outside, &fine);
        let neighbors = Neighbors::new(area, distance);
        let strips: Vec<Vec<Edge>> =
            edges.iter().flat_map(|e| strips(e, outside, fine.tolerance, &neighbors)).collect();
        let edge = fit_contours(&strips, &fine)?;
        let around = area_where(&BezPath::new(), &edge.path, options.tolerance, |w| w.shape_b != 0)?;
        // Strips unite to a band, whose side on the source `without_near_outlines` drops. Outlines of a shrunken area are its holes: turn them round.
        let around = if distance > 0.0 { around } else { around.reverse_subpaths() };
        (edge, around)
    } else {
        let edge = beside_area(area, style, outside, &fine)?;
        let moved = area_where(area, &edge.path, options.tolerance, |w| match distance > 0.0 {
            true => w.shape_a != 0 || turns_with(w),
            false => w.shape_a != 0 && turns_with(w),
        })?;
        (edge, moved)
    };
    let segs: Vec<PathSeg> = area.segments().collect();
    // Bevels are nearer than the distance; outlines to be removed are nearer still.
    let least = if style.join == Join::Bevel { BEVELS * distance.abs() } else { distance.abs() - options.tolerance };
    let (moved, near) = without_near_outlines(least, &segs, &moved);
    if style.join != Join::Bevel {
        out.report.unresolved.extend(near);
    }
    let moved: BezPath = subpaths(&moved).flat_map(|s| start_near(&s, starts)).collect();
    append_part(&mut out, &simplify(&moved, &rest)?, edge.report, (distance.abs(), options));
    Ok(out)
}

/// Returns `true` if so many nodes lie within the distance of others that most edges beside the outlines would cross.
fn is_crowded(area: &BezPath, distance: f64) -> bool {
    let nodes: Vec<Point> = area.segments().map(|s| s.start()).collect();
    let mut cells = HashMap::new();
    for p in &nodes {
        *cells.entry(cell_of(*p, 2.0 * distance.abs())).or_insert(0_usize) += 1;
    }
    cells.values().map(|n| n * n).sum::<usize>() > MOST_NEIGHBORS * nodes.len().max(FEW_NODES)
}

/// The closed contour, made to begin at the corner nearest to one of `starts`, or at the nearest point if it has no corners.
fn start_near(contour: &BezPath, starts: &[Point]) -> BezPath {
    let mut segs: Vec<PathSeg> = contour.segments().collect();
    let distance = |p: Point| starts.iter().map(|s| s.distance_squared(p)).fold(f64::INFINITY, f64::min);
    let joint = |i: usize| [segs[(i + segs.len() - 1) % segs.len()], segs[i]].map(Segment::new);
    let corners = (0..segs.len()).filter(|i| {
        let [before, after] = joint(*i);
        turn(&before, &after) > SMOOTH_JOINT
    });
    let nearest = corners.min_by(|a, b| distance(segs[*a].start()).total_cmp(&distance(segs[*b].start())));
    if let Some(corner) = nearest {
        segs.rotate_left(corner);
    } else {
        let nearest = segs.iter().enumerate().flat_map(|(i, s)| {
            starts.iter().map(move |p| (s.nearest(*p, 1e-9 * s.bounding_box().size().max_side()), i))
        });
        let Some((near, i)) = nearest.min_by(|a, b| a.0.distance_sq.total_cmp(&b.0.distance_sq)) else {
            return contour.clone();
        };
        segs.rotate_left(i);
        let first = segs[0];
        if near.t > 1e-6 {
            segs[0] = first.subsegment(near.t..1.0);
            if near.t < 1.0 - 1e-6 {
                segs.push(first.subsegment(0.0..near.t));
            } else {
                segs[0] = first;
                segs.rotate_left(1);
            }
        }
    }
    let mut out = BezPath::from_path_segments(segs.into_iter());
    out.close_path();
    out
}

/// Appends a part, with the unresolved points of its `edges`.
fn append_part(out: &mut Fitted, part: &Fitted, edges: Report, (distance, options): (f64, &Options)) {
    out.path.extend(&part.path);
    out.report.add(&part.report);
    // Points further from the result than the distance do not matter to it.
    let limit = (distance + options.tolerance).powi(2);
    let is_near = |p: &Point| part.path.segments().any(|s| s.nearest(*p, options.tolerance).distance_sq <= limit);
    out.report.unresolved.extend(edges.unresolved.into_iter().filter(is_near));
}

/// Outlines of the area that is `inside` by the winding numbers of two paths.
fn area_where(
    a: &BezPath,
    b: &BezPath,
    tolerance: f64,
    inside: impl Fn(&BinaryWindingNumber) -> bool,
) -> Result<BezPath, Error> {
    if let Some(at) = [a, b].into_iter().find(|p| !p.is_finite()) {
        return Err(NotFinite { t: 0.0, at: at.control_box().center() }.into());
    }
    // Differences below this are rounding of the coordinates.
    let fine = (CROSSINGS * tolerance).max(64.0 * f64::EPSILON * extent(a).max(extent(b)));
    let swept = |turn: &f64| {
        let turned = [a, b].map(|p| Affine::rotate(*turn) * closed(p));
        let sweep = || Some(Topology::from_paths_binary(&turned[0], &turned[1], fine).ok()?.contours(&inside));
        let contours = panic::catch_unwind(AssertUnwindSafe(sweep)).ok()??;
        let (mut out, back) = (BezPath::new(), Affine::rotate(-turn));
        for contour in contours.contours() {
            let around = contour.path.segments().map(|s| s.arclen(tolerance)).sum::<f64>();
            if contour.path.area().abs() > 0.5 * tolerance * around {
                out.extend(back * contour.path.clone());
                if !matches!(contour.path.elements().last(), Some(PathEl::ClosePath)) {
                    out.close_path();
                }
            }
        }
        Some(out)
    };
    // Very rarely the sweep replaces a piece of a curve by its chord, which is not on an edge of the source.
    let mut all = SWEEP_ANGLES.iter().filter_map(swept);
    let first = all.next().ok_or(Error::Crossings)?;
    let sources: Vec<PathSeg> = [a, b].into_iter().flat_map(|p| closed(p).segments().collect::<Vec<_>>()).collect();
    let follows =
        |out: &BezPath| out.segments().count() * sources.len() > MAX_COMPARED || along_edges(out, &sources, tolerance);
    let out = if follows(&first) { first } else { all.find(|out| follows(out)).unwrap_or(first) };
    // Crossings leave tiny segments, and nodes on lines.
    Ok(simplify(&without_dust(&out, fine), &Options::new(fine).with_corner(SMOOTH_JOINT))?.path)
}

/// Returns `true` if the middles of all segments of a result lie on edges of its sources, within a tolerance.
fn along_edges(path: &BezPath, edges: &[PathSeg], tolerance: f64) -> bool {
    let edges: Vec<_> = edges.iter().map(|e| (e.bounding_box().inflate(tolerance, tolerance), e)).collect();
    let is_near = |p: Point| {
        let mut near = edges.iter().filter(|(b, _)| b.contains(p));
        near.any(|(_, e)| e.nearest(p, 0.1 * tolerance).distance_sq <= tolerance * tolerance)
    };
    path.segments().all(|s| is_near(s.eval(0.5)))
}

/// The closed path without segments that are shorter than a length.
fn without_dust(path: &BezPath, length: f64) -> BezPath {
    let mut out = BezPath::new();
    for subpath in subpaths(path) {
        let is_dust = |s: &PathSeg| {
            let c = s.to_cubic();
            c.p0.distance(c.p1).max(c.p0.distance(c.p2)).max(c.p0.distance(c.p3)) < length
        };
        let kept: Vec<PathSeg> = subpath.segments().filter(|s| !is_dust(s)).collect();
        let Some(last) = kept.last() else { continue };
        out.move_to(last.end());
        for s in kept {
            out.push(s.as_path_el());
        }
        out.close_path();
    }
    out
}

/// Drops outlines that are mostly nearer to the source than `distance`: a stroke that is wider than the area it encloses leaves such ones
/// inside. Returns the others, with points of theirs that are nearer.
fn without_near_outlines(distance: f64, source: &[PathSeg], outlines: &BezPath) -> (BezPath, Vec<Point>) {
    let boxes: Vec<_> = source.iter().map(Shape::bounding_box).collect();
    let is_near = |p: &Point| {
        let mut near = boxes.iter().zip(source).filter(|(b, _)| b.inflate(distance, distance).contains(*p));
        near.any(|(_, s)| s.nearest(*p, 1e-3 * distance).distance_sq < distance * distance)
    };
    let (mut out, mut too_near) = (BezPath::new(), Vec::new());
    for contour in subpaths(outlines) {
        let middles: Vec<Point> = contour.segments().map(|s| s.eval(0.5)).collect();
        let near: Vec<Point> = middles.iter().copied().filter(|p| distance > 0.0 && is_near(p)).collect();
        if 2 * near.len() <= middles.len() {
            out.extend(&contour);
            too_near.extend(near);
        }
    }
    (out, too_near)
}

/// The largest magnitude of a path's coordinates.
fn extent(path: &BezPath) -> f64 {
    let b = path.control_box();
    [b.x0, b.y0, b.x1, b.y1].into_iter().fold(0.0, |most, v| most.max(v.abs()))
}

/// The path with all subpaths closed.
fn closed(path: &BezPath) -> BezPath {
    let mut out = BezPath::new();
    for mut subpath in subpaths(path) {
        if subpath.elements().len() > 1 {
            subpath.close_path();
            out.extend(&subpath);
        }
    }
    out
}

/// The parts of closed outlines that run along an open path, in its direction.
fn chains_along(outlines: &BezPath, side: &BezPath, tolerance: f64) -> Vec<BezPath> {
    let side: Vec<PathSeg> = side.segments().collect();
    // The squared distance of a point from the side, and the parameter of the nearest point.
    let nearest = |p: Point| {
        let each = side.iter().enumerate().map(|(i, s)| {
            let near = s.nearest(p, 1e-3 * tolerance);
            (near.distance_sq, i as f64 + near.t)
        });
        each.fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a })
    };
    // Two fits of one edge, one of them with crossings, differ by at most 2·(EDGES + CROSSINGS) = 0.64 of the tolerance.
    let is_along = |s: &PathSeg| [0.1, 0.5, 0.9].into_iter().all(|t| nearest(s.eval(t)).0.sqrt() <= 0.8 * tolerance);
    let mut out = Vec::new();
    for contour in subpaths(outlines) {
        let mut segs: Vec<PathSeg> = contour.segments().collect();
        let kept: Vec<bool> = segs.iter().map(is_along).collect();
        // Begin after a segment that is left out.
        let first = kept.iter().position(|k| !k).unwrap_or(0);
        segs.rotate_left(first);
        let mut runs: Vec<Vec<PathSeg>> = vec![Vec::new()];
        for (i, s) in segs.iter().enumerate() {
            match (kept[(first + i) % kept.len()], runs.last_mut()) {
                (true, Some(run)) => run.push(*s),
                (false, Some(run)) if !run.is_empty() => runs.push(Vec::new()),
                _ => {}
            }
        }
        for mut run in runs.into_iter().filter(|r| !r.is_empty()) {
            let middle = run[run.len() / 2];
            if nearest(middle.eval(0.75)).1 < nearest(middle.eval(0.25)).1 {
                run = run.iter().rev().map(PathSeg::reverse).collect();
            }
            out.push((nearest(run[0].eval(0.5)).1, BezPath::from_path_segments(run.into_iter())));
        }
    }
    out.sort_by(|a, b| a.0.total_cmp(&b.0));
    out.into_iter().map(|(_, chain)| chain).collect()
}
