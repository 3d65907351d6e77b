//! Areas enclosed by outlines, with their union, intersection and difference.

use super::exact_edges;
use crate::error::GeometryError;
use crate::outline::{Outline, Seg, Subpath};
use crate::refit::ARCS;
use bezierfit::union_even_odd;
use kurbo::{BezPath, Join, ParamCurve as _, ParamCurveNearest as _, PathSeg, Point, Rect, Shape as _, Vec2};

/// Tolerance of outlines that close a gap, as a fraction of its width.
const FIT_TOLERANCE: f64 = 0.1;
/// Distance within which outlines that close a gap follow lines and arcs of the sources, as a fraction of its width.
const SNAP_DISTANCE: f64 = 0.8;
/// Distance of exact edges beside the sources.
const ON_SOURCES: f64 = 0.0;

/// Parameters at which segments of outlines that close gaps are compared with the original outlines.
const SAMPLES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// An area of the plane, with outlines that meet neither themselves nor each other.
///
/// ```
/// use pathwarp::{Outline, edit::Area};
///
/// let area = |d: &str| Area::of(&Outline::from_svg(d).unwrap(), false, 0.01);
/// // One turns to the left, one to the right.
/// let (a, b) = (area("M0,0H60V60H0Z")?, area("M40,40V100H100V40Z")?);
/// assert_eq!(Area::union([&a, &b], 0.01)?.outline().segs().count(), 8);
/// assert!((a.intersection(&b, 0.01)?.outline().bounding_box().unwrap().area() - 400.0).abs() < 1e-9);
/// # Ok::<(), pathwarp::GeometryError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Area(Outline);

impl Area {
    /// Returns the area of a fill, within `tolerance`. Open subpaths are closed.
    ///
    /// # Errors
    /// [`GeometryError::NotFinite`] for a coordinate that is not finite, [`GeometryError::Crossings`] when edges' crossings are not found.
    pub fn of(outline: &Outline, even_odd: bool, tolerance: f64) -> Result<Self, GeometryError> {
        let arc_tolerance = ARCS * tolerance;
        let unite = if even_odd { union_even_odd } else { bezierfit::union };
        Ok(Self(Outline::from(&unite(&outline.to_bez_path(arc_tolerance), tolerance - arc_tolerance)?)))
    }

    /// Returns the union of the areas.
    ///
    /// # Errors
    /// [`GeometryError::Crossings`] when crossings of edges are not found.
    pub fn union<'a>(all: impl IntoIterator<Item = &'a Self>, tolerance: f64) -> Result<Self, GeometryError> {
        // All outlines turn around their area in the same direction, so one path can hold them all.
        let paths: Vec<BezPath> = all.into_iter().filter(|a| !a.is_empty()).map(Self::path).collect();
        let path: BezPath = paths.iter().flatten().collect();
        Ok(Self(Outline::from(&if paths.len() < 2 { path } else { bezierfit::union(&path, tolerance)? })))
    }

    /// Returns the intersection of both areas.
    ///
    /// # Errors
    /// [`GeometryError::Crossings`] when crossings of edges are not found.
    pub fn intersection(&self, other: &Self, tolerance: f64) -> Result<Self, GeometryError> {
        Ok(Self(Outline::from(&bezierfit::intersection(&self.path(), &other.path(), tolerance)?)))
    }

    /// Returns this area without the other.
    ///
    /// # Errors
    /// [`GeometryError::Crossings`] when crossings of edges are not found.
    pub fn difference(&self, other: &Self, tolerance: f64) -> Result<Self, GeometryError> {
        if self.is_empty() || other.is_empty() {
            return Ok(self.clone());
        }
        Ok(Self(Outline::from(&bezierfit::difference(&self.path(), &other.path(), tolerance)?)))
    }

    /// Returns the parts of lines that lie outside this area, cut within `tolerance` of its edges. A closed line that is cut is open.
    ///
    /// ```
    /// # use pathwarp::{Outline, edit::Area};
    /// let area = Area::of(&Outline::from_svg("M10,-9H20V9H10Z")?, false, 0.01)?;
    /// let seen = area.lines_outside(&Outline::from_svg("M0,0H30")?, 1e-9);
    /// assert_eq!(seen.subpaths.len(), 2);
    /// assert!((seen.subpaths[0].end().x - 10.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn lines_outside(&self, lines: &Outline, tolerance: f64) -> Outline {
        let path = self.path();
        let edges: Vec<(PathSeg, Rect)> = path.segments().map(|s| (s, s.bounding_box())).collect();
        let mut out = Outline::default();
        for line in &lines.subpaths {
            let mut parts = vec![Vec::new()];
            for seg in &line.segs {
                let (mut from, mut pieces) = (0.0, Vec::new());
                let distance = |t: f64| signed_distance(&path, &edges, seg.eval(t));
                cut_by_sign(&distance, largest_speed(seg), [0.0, 1.0], tolerance, &mut pieces);
                for (to, is_outside) in pieces {
                    match parts.last_mut().filter(|_| is_outside) {
                        Some(part) => part.push(subsegment(seg, from, to)),
                        None => parts.push(Vec::new()),
                    }
                    from = to;
                }
            }
            let closed = line.closed && parts.len() == 1;
            if line.closed
                && !closed
                && let Some(last) = parts.pop()
            {
                parts[0].splice(0..0, last);
            }
            let parts = parts.into_iter().filter(|segs| !segs.is_empty());
            out.subpaths.extend(parts.map(|segs| Subpath { start: segs[0].start(), segs, closed }));
        }
        out
    }

    /// Returns `true` if the area is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the outlines, of lines and cubics.
    #[must_use]
    pub fn outline(&self) -> &Outline {
        &self.0
    }

    /// Returns the outlines, with lines and arcs of the sources, not lengthened, where the outlines follow them within `tolerance`.
    #[must_use]
    pub fn with_arcs_of(&self, sources: &Outline, tolerance: f64) -> Outline {
        exact_edges::insert(self.0.clone(), sources, ON_SOURCES, Some(0.0), tolerance)
    }

    /// Returns the numbers of islands and of holes.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        let outer = outer(&self.0, 1.0).count();
        [outer, self.0.subpaths.len() - outer]
    }

    pub(super) fn islands(&self) -> Vec<Subpath> {
        outer(&self.0, 1.0).cloned().collect()
    }

    /// Closes gaps and holes narrower than `width`, but only where that joins islands or fills holes. Lines and circular arcs of the
    /// sources stay exact. Where the crossings of the grown outlines are not found, the gaps stay.
    #[must_use]
    pub fn with_gaps_closed(&self, width: f64, sources: &Outline) -> Self {
        let boxes: Vec<Rect> = self.0.subpaths.iter().map(|s| s.bounding_box().inflate(width, width)).collect();
        let mut out = Outline::default();
        for group in separate(&boxes) {
            let area = Self(Outline { subpaths: group.iter().map(|i| self.0.subpaths[*i].clone()).collect() });
            out.subpaths.extend(area.close_gaps(width, sources).unwrap_or(area.0).subpaths);
        }
        Self(out)
    }

    /// Closes the gaps of outlines near each other by growing and shrinking the area; `None` if none is closed.
    fn close_gaps(&self, width: f64, sources: &Outline) -> Option<Outline> {
        if !self.has_gap(width) {
            return None;
        }
        let options = bezierfit::Options::new(FIT_TOLERANCE * width);
        let offset = |path: &BezPath, by: f64| Some(bezierfit::offset(path, by, Join::Round, &options).ok()?.path);
        let grown = offset(&self.path(), 0.5 * width)?;
        if Self(Outline::from(&grown)).counts() == self.counts() {
            return None;
        }
        let closed = Outline::from(&offset(&grown, -0.5 * width)?);
        // Lines of the sources may continue across gaps.
        let exact = exact_edges::insert(closed, sources, ON_SOURCES, Some(f64::INFINITY), SNAP_DISTANCE * width);
        let exact = exact.to_bez_path(ARCS * width);
        // The result must run along the original outlines.
        let original: Vec<(Rect, PathSeg)> =
            self.path().segments().map(|s| (s.bounding_box().inflate(width, width), s)).collect();
        let is_near = |p: Point| {
            let near = |s: &PathSeg| s.nearest(p, FIT_TOLERANCE * width).distance_sq <= width * width;
            original.iter().any(|(b, s)| b.contains(p) && near(s))
        };
        let follows = exact.segments().all(|s| SAMPLES.iter().all(|t| is_near(s.eval(*t))));
        (follows && exact.area().abs() >= self.path().area().abs()).then(|| Outline::from(&exact))
    }

    /// Returns `true` if segments without a common end are nearer than `width`.
    fn has_gap(&self, width: f64) -> bool {
        let mut segs: Vec<(Rect, PathSeg)> = self.path().segments().map(|s| (s.bounding_box(), s)).collect();
        segs.sort_by(|a, b| a.0.x0.total_cmp(&b.0.x0));
        let meet = |a: &PathSeg, b: &PathSeg| a.end() == b.start() || b.end() == a.start();
        segs.iter().enumerate().any(|(i, (bounds, a))| {
            let near = segs[i + 1..].iter().take_while(|(b, _)| b.x0 <= bounds.x1 + width);
            near.filter(|(_, b)| !meet(a, b)).any(|(_, b)| are_near(a, b, width))
        })
    }

    fn path(&self) -> BezPath {
        // There are no arcs, so the tolerance does not matter.
        self.0.to_bez_path(1.0)
    }
}

/// Returns `true` if two segments are nearer than `width`, or slightly farther apart: their boxes are compared, and the longer one is
/// halved until both are small.
fn are_near(a: &PathSeg, b: &PathSeg, width: f64) -> bool {
    let [a_box, b_box] = [a, b].map(PathSeg::bounding_box);
    let [a_side, b_side] = [a_box, b_box].map(|b| b.size().max_side());
    if !a_box.inflate(width, width).overlaps(b_box) {
        return false;
    }
    if a_side.max(b_side) <= width {
        return true;
    }
    let (long, short) = if a_side >= b_side { (a, b) } else { (b, a) };
    [0.0..0.5, 0.5..1.0].into_iter().any(|half| are_near(&long.subsegment(half), short, width))
}

/// Returns the subpaths around islands, not those around holes: they turn in the direction of the whole area. Arcs become cubics within a
/// tolerance.
fn outer(outline: &Outline, arc_tolerance: f64) -> impl Iterator<Item = &Subpath> {
    let areas: Vec<f64> = outline.subpaths.iter().map(|s| path(s, arc_tolerance).area()).collect();
    let total: f64 = areas.iter().sum();
    outline.subpaths.iter().zip(areas).filter_map(move |(s, area)| (area * total > 0.0).then_some(s))
}

/// Returns the outlines of an area that lie in no other.
pub(super) fn outermost(outline: &Outline, arc_tolerance: f64) -> Outline {
    let islands: Vec<(&Subpath, Rect, BezPath)> =
        outer(outline, arc_tolerance).map(|s| (s, s.bounding_box(), path(s, arc_tolerance))).collect();
    let is_inside = |(s, b, _): &(&Subpath, Rect, BezPath)| {
        islands.iter().any(|(_, around, path)| around != b && around.union(*b) == *around && path.contains(s.start))
    };
    Outline { subpaths: islands.iter().filter(|i| !is_inside(i)).map(|i| i.0.clone()).collect() }
}

fn path(subpath: &Subpath, arc_tolerance: f64) -> BezPath {
    Outline { subpaths: vec![subpath.clone()] }.to_bez_path(arc_tolerance)
}

/// Divides boxes into groups, separated by lines along the axes. Returns the indices of each group, in the order of their first boxes.
pub(super) fn separate(boxes: &[Rect]) -> Vec<Vec<usize>> {
    /// Limit on the depth of alternate cuts along x and y. Only staircases need as many.
    const MAX_CUTS: usize = 64;
    let spans: [fn(&Rect) -> [f64; 2]; 2] = [|b| [b.x0, b.x1], |b| [b.y0, b.y1]];
    // Groups, with the number of cuts so far and the number of cuts without effect at the end.
    let (mut open, mut done) = (vec![((0..boxes.len()).collect::<Vec<usize>>(), 0, 0)], Vec::new());
    while let Some((mut group, cuts, without_effect)) = open.pop() {
        if without_effect == spans.len() || cuts == MAX_CUTS || group.len() < 2 {
            group.sort_unstable();
            done.push(group);
            continue;
        }
        let span = |i: usize| spans[cuts % spans.len()](&boxes[i]);
        group.sort_by(|a, b| span(*a)[0].total_cmp(&span(*b)[0]));
        let mut end = f64::NEG_INFINITY;
        let mut parts: Vec<Vec<usize>> = Vec::new();
        for i in group {
            match parts.last_mut().filter(|_| span(i)[0] <= end) {
                Some(part) => part.push(i),
                None => parts.push(vec![i]),
            }
            end = end.max(span(i)[1]);
        }
        let without_effect = if parts.len() == 1 { without_effect + 1 } else { 0 };
        open.extend(parts.into_iter().map(|part| (part, cuts + 1, without_effect)));
    }
    done.retain(|group| !group.is_empty());
    done.sort_unstable();
    done
}

/// Returns the area of a fill as outlines that meet neither themselves nor each other, within `tolerance`; `None` if that holds already.
///
/// # Errors
/// [`GeometryError::NotFinite`] for a coordinate that is not finite, [`GeometryError::Crossings`] when edges' crossings are not found.
///
/// ```
/// use pathwarp::{Outline, edit::united};
///
/// let cross = Outline::from_svg("M20,0H40V60H20ZM0,20H60V40H0Z")?;
/// assert_eq!(united(&cross, false, 0.01)?.unwrap().segs().count(), 12);
/// let ring = Outline::from_svg("M0,0H60V60H0ZM20,20V40H40V20Z")?;
/// assert_eq!(united(&ring, false, 0.01)?, None);
/// # Ok::<(), pathwarp::Error>(())
/// ```
pub fn united(outline: &Outline, even_odd: bool, tolerance: f64) -> Result<Option<Outline>, GeometryError> {
    let arc_tolerance = ARCS * tolerance;
    let path = outline.to_bez_path(arc_tolerance);
    let unite = if even_odd { union_even_odd } else { bezierfit::union };
    let area = unite(&path, tolerance - arc_tolerance)?;
    let united = Outline::from(&area);
    // Overlaps change the area or the number of outlines. An open outline has no area.
    let max_change = tolerance * path.perimeter(tolerance);
    let is_closed = outline.subpaths.iter().all(|s| s.closed || s.start == s.end());
    let is_simple = is_closed && united.subpaths.len() == outline.subpaths.len();
    Ok((!is_simple || (area.area().abs() - path.area().abs()).abs() > max_change).then_some(united))
}
fn subsegment(seg: &Seg, from: f64, to: f64) -> Seg {
    match seg {
        Seg::Arc(arc) => Seg::Arc(arc.subsegment(from, to)),
        other => other.part(from, to).unwrap_or(*other),
    }
}

/// Returns an upper bound for the length of a segment's derivative.
fn largest_speed(seg: &Seg) -> f64 {
    if let Seg::Arc(arc) = seg {
        return arc.major() * arc.sweep.abs();
    }
    let c = seg.to_cubic();
    3.0 * [c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2].map(Vec2::hypot).into_iter().fold(0.0, f64::max)
}

/// Returns the distance of a point from the edges of an area, negative inside. Edges come with their bounding boxes.
fn signed_distance(path: &BezPath, edges: &[(PathSeg, Rect)], p: Point) -> f64 {
    const ACCURACY: f64 = 1e-9;
    let mut nearest = f64::INFINITY;
    for (edge, bounds) in edges {
        let apart = Vec2::new(p.x - p.x.clamp(bounds.x0, bounds.x1), p.y - p.y.clamp(bounds.y0, bounds.y1));
        if apart.hypot2() < nearest {
            nearest = edge.nearest(p, ACCURACY).distance_sq.min(nearest);
        }
    }
    if path.winding(p) == 0 { nearest.sqrt() } else { -nearest.sqrt() }
}

/// Divides the interval `[from, to]` where `distance` changes its sign: adds the ends of pieces, with `true` for positive ones. The
/// distance changes by at most `speed` per unit. Pieces shorter than `min` are not divided.
fn cut_by_sign(distance: &dyn Fn(f64) -> f64, speed: f64, [from, to]: [f64; 2], min: f64, out: &mut Vec<(f64, bool)>) {
    let middle = 0.5 * (from + to);
    let at_middle = distance(middle);
    if at_middle.abs() < 0.5 * speed * (to - from) && speed * (to - from) > min {
        cut_by_sign(distance, speed, [from, middle], min, out);
        cut_by_sign(distance, speed, [middle, to], min, out);
        return;
    }
    match out.last_mut() {
        Some((end, is_positive)) if *is_positive == (at_middle > 0.0) => *end = to,
        _ => out.push((to, at_middle > 0.0)),
    }
}
