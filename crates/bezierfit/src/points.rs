//! Curves through points.

use crate::limits::LONG_EDGE;
use crate::options::{Error, Options};
use crate::path::simplify;
use crate::report::Fitted;
use crate::source::NotFinite;
use kurbo::{Affine, BezPath, Point, Vec2};

/// Neighbours that give a point its tangent are at least this many tolerances away, so that noise does not turn it.
const WINDOW: f64 = 8.0;
/// Neighbours on each side that are looked at for that, at most.
const MOST_NEIGHBOURS: usize = 64;

/// Fits a curve through points, within `options.tolerance` of each. Points at which the polygon turns by more than `options.corner` are
/// corners; between them the curve runs smoothly, in arcs where the points lie on circles, and in lines along edges much longer than their
/// neighbours. The default corner of half a degree makes nearly all points corners: for drawn polygons, some 30° are usual.
///
/// The report's errors are distances from the smooth curve through all points.
///
/// # Errors
/// A point is not finite, or the options make no sense.
///
/// ```
/// use bezierfit::{Options, fit_points};
/// use kurbo::{Point, Vec2};
///
/// let round: Vec<Point> = (0..48).map(|i| (Vec2::from_angle(f64::from(i) / 48.0 * std::f64::consts::TAU) * 100.0).to_point()).collect();
/// let fitted = fit_points(&round, true, &Options::new(0.1).with_corner(30.0_f64.to_radians()))?;
/// assert_eq!(fitted.path.segments().count(), 4);
/// # Ok::<(), bezierfit::Error>(())
/// ```
pub fn fit_points(points: &[Point], closed: bool, options: &Options) -> Result<Fitted, Error> {
    options.checked()?;
    if let Some(at) = points.iter().find(|p| !p.is_finite()) {
        return Err(NotFinite { t: 0.0, at: *at }.into());
    }
    simplify(&through(points, closed, options), &Options { corner: JOINED, ..*options })
}

/// Joints of the curve through the points turn by less than this if they are smooth.
const JOINED: f64 = 1e-6;

/// A path of arcs and lines through the points.
fn through(points: &[Point], closed: bool, options: &Options) -> BezPath {
    let mut p = points.to_vec();
    p.dedup();
    if closed && p.len() > 1 && p.first() == p.last() {
        p.pop();
    }
    let mut path = BezPath::new();
    let Some(first) = p.first().copied() else { return path };
    path.move_to(first);
    let polygon = Polygon { closed: closed && p.len() > 2, corner: options.corner, p };
    let edges: Vec<bool> = (0..polygon.edges()).map(|i| polygon.is_edge(i)).collect();
    let joint = |i: usize| polygon.tangents(i, WINDOW * options.tolerance, &edges);
    let tangents: Vec<[Vec2; 2]> = (0..polygon.p.len()).map(joint).collect();
    for i in 0..polygon.edges() {
        let j = (i + 1) % polygon.p.len();
        let (a, b) = (polygon.p[i], polygon.p[j]);
        let ([_, from], [to, _]) = (tangents[i], tangents[j]);
        let chord = b - a;
        let turn = |u: Vec2, v: Vec2| u.cross(v).atan2(u.dot(v));
        let [before, after] = [turn(from, chord), turn(chord, to)];
        if edges[i] || (before.abs() < JOINED && after.abs() < JOINED) {
            path.line_to(b);
            continue;
        }
        // A third of the chord, and more the more an arc turns.
        let handle = |by: f64| chord.hypot() / (3.0 * (0.5 * by).cos().powi(2)).max(0.6);
        path.curve_to(a + from * handle(before), b - to * handle(after), b);
    }
    if closed {
        path.close_path();
    }
    path
}

struct Polygon {
    p: Vec<Point>,
    closed: bool,
    corner: f64,
}

impl Polygon {
    /// Number of edges.
    fn edges(&self) -> usize {
        if self.closed { self.p.len() } else { self.p.len() - 1 }
    }

    /// The edge from point `i` on, if there is one.
    fn edge(&self, i: usize) -> Option<Vec2> {
        (i < self.edges()).then(|| self.p[(i + 1) % self.p.len()] - self.p[i])
    }

    /// The number before `i`.
    fn before(&self, i: usize) -> Option<usize> {
        if i > 0 { Some(i - 1) } else { self.closed.then(|| self.p.len() - 1) }
    }

    /// The number after `i`.
    fn after(&self, i: usize) -> Option<usize> {
        if i + 1 < self.p.len() { Some(i + 1) } else { self.closed.then_some(0) }
    }

    /// The turn at point `i`; `None` at an end.
    fn turn(&self, i: usize) -> Option<f64> {
        let (u, v) = (self.edge(self.before(i)?)?, self.edge(i)?);
        Some(u.cross(v).atan2(u.dot(v)))
    }

    fn is_corner(&self, i: usize) -> bool {
        self.turn(i).is_none_or(|t| t.abs() > self.corner)
    }

    /// Returns `true` if the edge from point `i` on is a straight one: far longer than the edges that go on from it, or between corners.
    fn is_edge(&self, i: usize) -> bool {
        let length = |i: Option<usize>| i.and_then(|i| self.edge(i)).map_or(0.0, Vec2::hypot);
        let own = length(Some(i));
        let beside = |at: usize, edge: Option<usize>| self.is_corner(at) || own > LONG_EDGE * length(edge);
        beside(i, self.before(i)) && self.after(i).is_none_or(|next| beside(next, Some(next)))
    }

    /// Unit tangents into and out of point `i`. Those of a smooth point are the same: along a straight edge, or that of the circle through
    /// the point and neighbours on either side, some of `window` away.
    fn tangents(&self, i: usize, window: f64, edges: &[bool]) -> [Vec2; 2] {
        let is_straight = |k: Option<usize>| k.is_some_and(|k| edges.get(k) == Some(&true));
        let along = |k: usize| self.edge(k).map_or(Vec2::ZERO, Vec2::normalize);
        let (before, after) = (self.before(i), (i < self.edges()).then_some(i));
        let [reach_back, reach_on] = [self.reach(i, window, edges, false), self.reach(i, window, edges, true)];
        if self.is_corner(i) {
            let end = |reach: &[Point], sign: f64| match reach {
                [] => Vec2::ZERO,
                [q] => (*q - self.p[i]).normalize() * sign,
                [.., r] => circle_tangent([self.p[i], reach[(reach.len() - 1) / 2], *r]) * sign,
            };
            let into = if is_straight(before) { before.map_or(Vec2::ZERO, along) } else { end(&reach_back, -1.0) };
            let out = if is_straight(after) { along(i) } else { end(&reach_on, 1.0) };
            return [into, out];
        }
        if let Some(k) = [before, after].into_iter().flatten().find(|k| edges.get(*k) == Some(&true)) {
            return [along(k); 2];
        }
        let (Some(a), Some(b)) = (reach_back.last(), reach_on.last()) else { return [Vec2::ZERO; 2] };
        let (u, v) = (self.p[i] - *a, *b - self.p[i]);
        // Weighted by the other side's length, as on a circle.
        [(u * (v.hypot2() / u.hypot()) + v * (u.hypot2() / v.hypot())).normalize(); 2]
    }

    /// The points after (or before) point `i` up to the first that is `window` away, the next corner, or a straight edge.
    fn reach(&self, i: usize, window: f64, edges: &[bool], on: bool) -> Vec<Point> {
        let mut out = Vec::new();
        let mut at = i;
        while let Some(next) = if on { self.after(at) } else { self.before(at) } {
            if edges.get(if on { at } else { next }) == Some(&true) && !out.is_empty() || next == i {
                break;
            }
            out.push(self.p[next]);
            let far = self.p[next].distance(self.p[i]) >= window && out.len() > usize::from(self.is_corner(i));
            at = next;
            if far || self.is_corner(next) || out.len() == MOST_NEIGHBOURS {
                break;
            }
        }
        out
    }
}

/// The tangent at `p` of the circle through it and the next two points.
fn circle_tangent([p, q, r]: [Point; 3]) -> Vec2 {
    let (u, v) = (q - p, r - q);
    // The two chords differ by half of both arcs, and the first from the tangent by half of its own.
    let turn = u.cross(v).atan2(u.dot(v)) * u.hypot() / (u.hypot() + v.hypot()).max(f64::MIN_POSITIVE);
    (Affine::rotate(-turn) * u.normalize().to_point()).to_vec2()
}
