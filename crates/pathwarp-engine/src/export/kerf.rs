//! Room for the width of the cut: parts grow by half of it and their holes shrink, so that what is cut has the size drawn.

use pathwarp::edit::{Offset, Side, moved};
use pathwarp::kurbo::{BezPath, CubicBez, Join, ParamCurve as _, Point, Rect, Shape as _, Vec2};
use pathwarp::outline::{EllipticArc, Subpath};
use pathwarp::{GeometryError, Outline, Seg, refit};
use std::f64::consts::TAU;

/// Rounding, as a share of a radius.
const SLACK: f64 = 1e-6;

/// An outline to cut.
pub(super) struct Cut {
    pub(super) outline: Outline,
    /// The fill rule of an area; `None` for lines.
    pub(super) even_odd: Option<bool>,
}

/// Moves closed contours by `by` to the outside of what they enclose; open lines stay. The areas of a fill follow its rule. Contours
/// of lines alone are holes if an odd number of the others is around them; `among` says which lines belong together. Returns by how many
/// there are fewer contours.
pub(super) fn widen<K: PartialEq>(
    cuts: &mut [Cut],
    among: impl Fn(usize) -> K,
    by: f64,
    options: &refit::Options,
) -> Result<usize, GeometryError> {
    let loops: Vec<(usize, Loop)> =
        cuts.iter().enumerate().filter(|(_, c)| c.even_odd.is_none()).flat_map(loops).collect();
    let is_hole = |i: usize, s: &Subpath| {
        let within = Within::new(s);
        let around = |(k, l): &&(usize, Loop)| among(*k) == among(i) && l.is_around(&within);
        loops.iter().filter(around).count() % 2 == 1
    };
    let mut fewer = 0;
    for (i, cut) in cuts.iter_mut().enumerate() {
        let (closed, open): (Vec<Subpath>, Vec<Subpath>) = cut.outline.subpaths.drain(..).partition(|s| s.closed);
        let areas: Vec<(Outline, Side)> = match cut.even_odd {
            Some(_) if closed.is_empty() => Vec::new(),
            Some(_) => vec![(Outline { subpaths: closed }, Side::Outside)],
            None => closed
                .into_iter()
                .map(|s| {
                    let side = if is_hole(i, &s) { Side::Inside } else { Side::Outside };
                    (Outline { subpaths: vec![s] }, side)
                })
                .collect(),
        };
        for (area, side) in areas {
            let to = widened(&area, side, by, cut.even_odd == Some(true), options)?;
            fewer += area.subpaths.len().saturating_sub(to.subpaths.len());
            cut.outline.subpaths.extend(to.subpaths);
        }
        cut.outline.subpaths.extend(open);
    }
    Ok(fewer)
}

/// The area whose edge is `by` away. A circle stays one; corners stay sharp.
fn widened(
    area: &Outline,
    side: Side,
    by: f64,
    even_odd: bool,
    options: &refit::Options,
) -> Result<Outline, GeometryError> {
    if let [only] = area.subpaths.as_slice()
        && let Some(circle) = circle(only)
    {
        let radius = circle.a.hypot();
        let wanted = if side == Side::Inside { radius - by } else { radius + by };
        let scaled = |v| v * (wanted / radius);
        let arc = EllipticArc::new(circle.center, scaled(circle.a), scaled(circle.b), circle.start, circle.sweep);
        let larger = Subpath { start: arc.p0, segs: vec![Seg::Arc(arc)], closed: true };
        return Ok(Outline { subpaths: (wanted > 0.0).then_some(larger).into_iter().collect() });
    }
    let offset = Offset { by, join: Join::Miter, side, even_odd };
    let path = moved(area, &offset, options, &[])?.path;
    Ok(with_arcs(Outline::from(&path), area, by, options))
}

/// The outline with arcs for what runs `by` beside circular arcs of its source.
fn with_arcs(mut outline: Outline, source: &Outline, by: f64, options: &refit::Options) -> Outline {
    /// Limit on comparisons of segments with arcs.
    const MOST: usize = 10_000_000;
    let arcs = source.subpaths.iter().flat_map(|s| &s.segs);
    let circles: Vec<(Point, f64)> = arcs
        .filter_map(|s| match s {
            Seg::Arc(a) if is_round(a) => Some((a.center, a.a.hypot())),
            _ => None,
        })
        .collect();
    let segs = outline.subpaths.iter().map(|s| s.segs.len()).sum::<usize>();
    if circles.len().saturating_mul(segs) > MOST {
        return outline;
    }
    let held = outline.subpaths.iter_mut().map(|s| (options.of_contour(s), s));
    for (tolerance, seg) in held.flat_map(|(tolerance, s)| s.segs.iter_mut().map(move |seg| (tolerance, seg))) {
        if let Seg::Cubic(c) = *seg {
            let beside = circles.iter().flat_map(|&(center, r)| [(center, r - by), (center, r + by)]);
            let arc =
                beside.filter(|(_, r)| *r > tolerance).find_map(|(center, r)| on_circle(&c, center, r, tolerance));
            *seg = arc.map_or(*seg, Seg::Arc);
        }
    }
    outline
}

/// The arc of a circle that a cubic follows, if it does.
fn on_circle(c: &CubicBez, center: Point, radius: f64, tolerance: f64) -> Option<EllipticArc> {
    let is_on = |t: f64| (c.eval(t).distance(center) - radius).abs() <= tolerance;
    if ![0.0, 1.0, 0.5, 0.25, 0.75].into_iter().all(is_on) {
        return None;
    }
    let turn = |a: Point, b: Point| {
        let (a, b) = (a - center, b - center);
        a.cross(b).atan2(a.dot(b))
    };
    let sweep = turn(c.p0, c.eval(0.5)) + turn(c.eval(0.5), c.p3);
    let arc = EllipticArc::new(center, Vec2::new(radius, 0.0), Vec2::new(0.0, radius), (c.p0 - center).angle(), sweep);
    Some(EllipticArc { p0: c.p0, p1: c.p3, ..arc })
}

/// Returns `true` for an arc of a circle.
fn is_round(a: &EllipticArc) -> bool {
    let (size, slack) = (a.a.hypot(), SLACK * a.a.hypot());
    (size - a.b.hypot()).abs() <= slack && a.a.dot(a.b).abs() <= slack * size
}

/// The circle that a contour is, if it is one.
fn circle(s: &Subpath) -> Option<EllipticArc> {
    let Some(Seg::Arc(first)) = s.segs.first() else { return None };
    let slack = SLACK * first.a.hypot();
    let mut sweep = 0.0;
    for seg in &s.segs {
        let Seg::Arc(a) = seg else { return None };
        let same = a.center.distance(first.center) <= slack && (a.a.hypot() - first.a.hypot()).abs() <= slack;
        if !same || a.sweep * first.sweep < 0.0 {
            return None;
        }
        sweep += a.sweep;
    }
    let whole = (sweep.abs() - TAU).abs() <= SLACK;
    (is_round(first) && whole)
        .then(|| EllipticArc::new(first.center, first.a, first.b, first.start, TAU.copysign(sweep)))
}

/// A contour of lines, to be looked up.
struct Loop {
    path: BezPath,
    bounds: Rect,
    start: Point,
}

impl Loop {
    /// Returns `true` if a contour lies inside of this one and does not cross it.
    fn is_around(&self, s: &Within) -> bool {
        let reach = SLACK * (s.bounds.width() + s.bounds.height());
        self.start != s.start
            && self.bounds.inflate(reach, reach).contains_rect(s.bounds)
            && s.points.iter().all(|p| self.path.winding(*p) != 0)
    }
}

/// A contour that may lie inside of others.
struct Within {
    bounds: Rect,
    start: Point,
    points: Vec<Point>,
}

impl Within {
    fn new(s: &Subpath) -> Self {
        /// Most segments looked at, and how far from edges that contours may share, against the contour's size.
        const MOST: usize = 8;
        const BESIDE: f64 = 1e-3;
        let bounds = s.bounding_box();
        let beside = |p: Point| p.lerp(bounds.center(), BESIDE);
        let middles = s.segs.iter().step_by(s.segs.len().div_ceil(MOST).max(1)).map(|seg| seg.eval(0.5));
        Self { bounds, start: s.start, points: middles.chain([s.start]).map(beside).collect() }
    }
}

fn loops((i, cut): (usize, &Cut)) -> impl Iterator<Item = (usize, Loop)> {
    /// Arcs as cubics, against the contour's size: enough to tell inside from outside.
    const ROUGH: f64 = 1e-4;
    let closed = cut.outline.subpaths.iter().filter(|s| s.closed);
    closed.map(move |s| {
        let path = Outline { subpaths: vec![s.clone()] }.to_bez_path(ROUGH * s.diagonal());
        (i, Loop { path, bounds: s.bounding_box(), start: s.start })
    })
}
