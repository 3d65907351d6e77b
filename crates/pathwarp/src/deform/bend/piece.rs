//! One piece of a bent strip: a piece of the skeleton, and the sides that stand on it.

use super::casteljau::Ribbon;
use crate::map::Dual;
use crate::map::curves::ArcLength;
use crate::outline::Seg;
use kurbo::{Point, Vec2};

/// The strip along a piece of skeleton.
#[derive(Debug, Clone)]
pub(super) enum Strip {
    /// F = p + s·t + d·n.
    Straight { p: Point, t: Vec2, n: Vec2 },
    /// F = C(u(s)) + d·S with S the unit normal, blended into the mitre of a corner at the ends. s is the length of the offset
    /// curve at height `even`.
    Normals { spine: Spine, table: ArcLength, mitres: [Vec2; 2], even: f64 },
    /// The paper's polynomial F(u, v), v = d / unit; u by arc length if there is a table, else s / length.
    Ribbon { ribbon: Ribbon, unit: f64, table: Option<ArcLength> },
}

/// A piece of the skeleton and its strip.
#[derive(Debug, Clone)]
pub(super) struct SkeletonPiece {
    /// The distance from which it applies; −∞ for the first of an open skeleton.
    pub(super) from: f64,
    /// The distance of its start.
    pub(super) anchor: f64,
    /// Its length.
    pub(super) length: f64,
    pub(super) strip: Strip,
}

impl SkeletonPiece {
    /// The work of a point: one on an arc takes several sines and cosines, and the de Casteljau steps of a ribbon take twice as long as a net.
    pub(super) fn work(&self) -> f64 {
        match &self.strip {
            Strip::Normals { spine, .. } if matches!(spine.seg, Seg::Arc(_)) => 2.0,
            Strip::Straight { .. } | Strip::Normals { .. } => 1.0,
            Strip::Ribbon { .. } => 2.0,
        }
    }

    /// Returns F at distance `s` from the piece's start and height `d`.
    pub(super) fn point(&self, s: f64, d: f64) -> Point {
        match &self.strip {
            Strip::Straight { p, t, n } => *p + *t * s + *n * d,
            Strip::Normals { spine, table, mitres: [a, b], .. } => {
                let (p, t) = spine.frame(table.parameter(s));
                p + self.side(t, *a, *b, s) * d
            }
            Strip::Ribbon { .. } => self.jet(s, d).0,
        }
    }

    /// Returns the side at distance `s`: the normal of `t`, blended into the mitres.
    fn side(&self, t: Vec2, start: Vec2, end: Vec2, s: f64) -> Vec2 {
        let share = s / self.length;
        normal(t) + start * (1.0 - share) + end * share
    }

    /// Returns F, ∂F/∂s and ∂F/∂d at distance `s` from the piece's start and height `d`.
    pub(super) fn jet(&self, s: f64, d: f64) -> (Point, Vec2, Vec2) {
        match &self.strip {
            Strip::Straight { p, t, n } => (*p + *t * s + *n * d, *t, *n),
            Strip::Normals { spine, table, mitres: [a, b], even } => {
                let Moving { p, t, bend } = spine.moving(table.parameter(s));
                let side = self.side(t, *a, *b, s);
                let along = t * ((1.0 + bend * d) / (1.0 + bend * even)) + (*b - *a) * (d / self.length);
                (p + side * d, along, side)
            }
            Strip::Ribbon { ribbon, unit, table } => {
                let u = table.as_ref().map_or(s / self.length, |t| t.parameter(s));
                let [x, y] = ribbon.at(Dual { v: u, x: 1.0, y: 0.0 }, Dual { v: d / unit, x: 0.0, y: 1.0 });
                let slope = match table {
                    None => 1.0 / self.length,
                    Some(_) => {
                        let [x, y] = ribbon.at(Dual { v: u, x: 1.0, y: 0.0 }, Dual::from(0.0));
                        1.0 / x.x.hypot(y.x).max(f64::MIN_POSITIVE)
                    }
                };
                (Point::new(x.v, y.v), Vec2::new(x.x, y.x) * slope, Vec2::new(x.y, y.y) / *unit)
            }
        }
    }
}

/// Returns the normal that points up on the screen for a tangent to the right.
pub(super) fn normal(t: Vec2) -> Vec2 {
    Vec2::new(t.y, -t.x)
}

/// A piece of the skeleton's curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spine {
    pub(super) seg: Seg,
    /// The speed that counts as zero.
    still: f64,
}

/// The moving frame of a piece. With N the [`normal`], dT/ds = −bend·N, dN/ds = bend·T.
pub(super) struct Moving {
    pub(super) p: Point,
    /// Unit tangent.
    pub(super) t: Vec2,
    /// Curvature, positive where the curve turns clockwise on the screen: away from the normal.
    pub(super) bend: f64,
}

impl Spine {
    pub(super) fn new(seg: Seg) -> Self {
        /// The speed that counts as zero, as a share of the piece's size.
        const STILL: f64 = 1e-9;
        let b = seg.bounding_box();
        Self { seg, still: STILL * (b.width() + b.height()) }
    }

    /// Returns the point and the unit tangent at a parameter.
    fn frame(&self, u: f64) -> (Point, Vec2) {
        let (_, v, speed) = self.velocity(u);
        (self.seg.eval(u), v / speed)
    }

    /// Returns the moving frame at a parameter.
    pub(super) fn moving(&self, u: f64) -> Moving {
        let (at, v, speed) = self.velocity(u);
        Moving { p: self.seg.eval(u), t: v / speed, bend: v.cross(second(&self.seg, at)) / speed.powi(3) }
    }

    /// Returns the derivative and its length at a parameter, which comes first. Where the curve stands still, that is a little further in.
    fn velocity(&self, u: f64) -> (f64, Vec2, f64) {
        /// How much further in.
        const ASIDE: f64 = 1e-5;
        let v = self.seg.deriv(u);
        let speed = v.hypot();
        if speed > self.still {
            return (u, v, speed);
        }
        let at = if u < 0.5 { u + ASIDE } else { u - ASIDE };
        let v = self.seg.deriv(at);
        (at, v, v.hypot())
    }
}

/// Returns the second derivative.
fn second(seg: &Seg, u: f64) -> Vec2 {
    match seg {
        Seg::Line(_) => Vec2::ZERO,
        Seg::Quad(q) => ((q.p2 - q.p1) - (q.p1 - q.p0)) * 2.0,
        Seg::Cubic(c) => {
            let (d0, d1, d2) = (c.p1 - c.p0, c.p2 - c.p1, c.p3 - c.p2);
            ((d1 - d0) * (1.0 - u) + (d2 - d1) * u) * 6.0
        }
        Seg::Arc(a) => {
            let (sin, cos) = (a.start + a.sweep * u).sin_cos();
            (a.a * cos + a.b * sin) * -(a.sweep * a.sweep)
        }
    }
}
