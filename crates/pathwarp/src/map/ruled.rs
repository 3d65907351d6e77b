//! The ruled map between two guide curves: straight lines from the top guide to the bottom one.
//!
//! F(u, v) = (1 − v)·T(u) + v·B(u), u and v from 0 to 1 over a box of the source. u runs along a guide evenly by arc length, or
//! by the guide's own parameter, every piece of it an equal share. Where pieces of either guide meet are creases: uprights.
//!
//! Over an upright strip between creases where both guides are polynomials of u, the map is a bicubic net: its third row points
//! are even divisions of the lines between, because it is linear in v.

use super::arclength::ArcLength;
use super::tiled::{Row, Tiled};
use super::{BicubicNet, Jet, Map, net::Net};
use crate::outline::Seg;
use kurbo::{Affine, CubicBez, ParamCurve, Point, Rect, Vec2};
use std::sync::Arc;

/// How a guide is run along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// Evenly by arc length.
    ArcLength,
    /// By its own parameter, every piece an equal share.
    Parameter,
}

/// A guide curve over u from 0 to 1.
#[derive(Debug, Clone)]
pub struct Guide {
    pieces: Vec<Piece>,
}

#[derive(Debug, Clone)]
struct Piece {
    seg: Seg,
    /// The u at its ends.
    from: f64,
    to: f64,
    /// From a share of the piece's length to its parameter; `None`: they are the same.
    table: Option<ArcLength>,
}

impl Guide {
    /// A guide of these pieces, head to tail. `None`: there are none, or they have no length.
    #[must_use]
    pub fn new(segs: &[Seg], along: Along) -> Option<Self> {
        let mut lengths = Vec::with_capacity(segs.len());
        let mut tables = Vec::with_capacity(segs.len());
        for seg in segs {
            let table = ArcLength::new(&|t| seg.deriv(t).hypot());
            lengths.push(if along == Along::ArcLength { table.length() } else { 1.0 });
            // Lines, and circles, are run evenly by their own parameter.
            let even = along == Along::Parameter || matches!(seg, Seg::Line(_));
            tables.push((!even).then_some(table));
        }
        let total: f64 = lengths.iter().sum();
        let flat = segs.iter().all(|s| s.bounding_box().size().max_side() == 0.0);
        if flat || !total.is_finite() || total <= 0.0 {
            return None;
        }
        let mut at = 0.0;
        let mut pieces: Vec<Piece> = Vec::with_capacity(segs.len());
        for ((seg, length), table) in segs.iter().zip(lengths).zip(tables) {
            let from = at / total;
            at += length;
            // A piece without length holds for no u.
            if length > 0.0 {
                pieces.push(Piece { seg: *seg, from, to: at / total, table });
            }
        }
        if let Some(last) = pieces.last_mut() {
            last.to = 1.0;
        }
        Some(Self { pieces })
    }

    /// The place at `u`; beyond the ends the outermost pieces run on.
    #[must_use]
    pub fn eval(&self, u: f64) -> Point {
        let k = self.pieces.partition_point(|p| p.to < u).min(self.pieces.len() - 1);
        self.pieces[k].at(u).0
    }

    /// The u between 0 and 1 where pieces meet.
    pub fn joints(&self) -> impl Iterator<Item = f64> + '_ {
        self.pieces.iter().skip(1).map(|p| p.from)
    }

    fn piece(&self, u: f64) -> &Piece {
        let k = self.pieces.partition_point(|p| p.to < u).min(self.pieces.len() - 1);
        &self.pieces[k]
    }
}

impl Piece {
    /// Place and derivative by u.
    fn at(&self, u: f64) -> (Point, Vec2) {
        let share = (u - self.from) / (self.to - self.from);
        let (t, dt) = match &self.table {
            None => (share, 1.0),
            Some(table) => {
                let length = table.length();
                let inside = share.clamp(0.0, 1.0);
                let t = table.parameter(inside * length);
                let dt = length / self.seg.deriv(t).hypot().max(f64::MIN_POSITIVE);
                (t + (share - inside) * dt, dt)
            }
        };
        (self.seg.eval(t), self.seg.deriv(t) * (dt / (self.to - self.from)))
    }

    /// The piece over [u0, u1] as a cubic in u, where it is one.
    fn cubic(&self, u0: f64, u1: f64) -> Option<CubicBez> {
        if self.table.is_some() || matches!(self.seg, Seg::Arc(_)) {
            return None;
        }
        let share = |u: f64| (u - self.from) / (self.to - self.from);
        let c = self.seg.to_cubic();
        let whole = u0 == self.from && u1 == self.to;
        Some(if whole { c } else { c.subsegment(share(u0)..share(u1)) })
    }
}

/// The ruled map that takes `frame`'s upper side to `top` and its lower side to `bottom`. `None`: the frame has no area.
#[must_use]
pub fn ruled(frame: Rect, top: &Guide, bottom: &Guide) -> Option<Arc<dyn Map>> {
    Tiled::over(frame, Vec::new(), vec![row(frame, top, bottom)?])
}

/// The same as a row of tiles, to stand above and below others.
#[must_use]
pub fn row(frame: Rect, top: &Guide, bottom: &Guide) -> Option<Row> {
    /// Joints nearer than this are one: guides of like proportions meet there up to rounding.
    const APART: f64 = 1e-12;
    if !(frame.width() > 0.0 && frame.height() > 0.0) {
        return None;
    }
    let mut cuts: Vec<f64> = top.joints().chain(bottom.joints()).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < APART);
    let ends: Vec<f64> = [0.0].into_iter().chain(cuts.iter().copied()).chain([1.0]).collect();
    let maps = ends.windows(2).map(|w| strip(frame, top, bottom, w[0], w[1])).collect();
    let cuts = cuts.iter().map(|u| frame.x0 + u * frame.width()).collect();
    Some(Row { cuts, maps })
}

/// (u, v) from the source.
fn unit(frame: Rect, u0: f64, u1: f64) -> Affine {
    let (w, h) = (frame.width() * (u1 - u0), frame.height());
    Affine::new([1.0 / w, 0.0, 0.0, 1.0 / h, -(frame.x0 + u0 * frame.width()) / w, -frame.y0 / h])
}

/// The map over one strip.
fn strip(frame: Rect, top: &Guide, bottom: &Guide, u0: f64, u1: f64) -> Arc<dyn Map> {
    let middle = 0.5 * (u0 + u1);
    let (top, bottom) = (top.piece(middle), bottom.piece(middle));
    if let (Some(t), Some(b)) = (top.cubic(u0, u1), bottom.cubic(u0, u1)) {
        return Arc::new(BicubicNet::new(&between(t, b), unit(frame, u0, u1)));
    }
    Arc::new(Strip { pre: unit(frame, 0.0, 1.0), top: top.clone(), bottom: bottom.clone() })
}

/// The net that rules between two cubics.
#[must_use]
pub fn between(top: CubicBez, bottom: CubicBez) -> Net {
    let (t, b) = ([top.p0, top.p1, top.p2, top.p3], [bottom.p0, bottom.p1, bottom.p2, bottom.p3]);
    std::array::from_fn(|j| std::array::from_fn(|i| if j == 3 { b[i] } else { t[i].lerp(b[i], j as f64 / 3.0) }))
}

/// The map over a strip whose guides are no polynomials of u.
#[derive(Debug, Clone)]
struct Strip {
    pre: Affine,
    top: Piece,
    bottom: Piece,
}

impl Map for Strip {
    fn jet(&self, p: Point) -> Jet {
        let Point { x: u, y: v } = self.pre * p;
        let ((t, dt), (b, db)) = (self.top.at(u), self.bottom.at(u));
        let [a, _, _, d, ..] = self.pre.as_coeffs();
        Jet { p: t.lerp(b, v), dx: (dt * (1.0 - v) + db * v) * a, dy: (b - t) * d }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Creases, RationalDegree};
    use crate::outline::{EllipticArc, Outline};
    use kurbo::ParamCurveArclen;

    fn guide(d: &str, along: Along) -> Guide {
        let segs: Vec<Seg> = Outline::from_svg(d).unwrap().segs().copied().collect();
        Guide::new(&segs, along).unwrap()
    }

    const FRAME: Rect = Rect::new(10.0, 20.0, 110.0, 70.0);

    fn source(u: f64, v: f64) -> Point {
        Point::new(FRAME.x0 + u * FRAME.width(), FRAME.y0 + v * FRAME.height())
    }

    /// Both guides are reproduced, and lines between them are straight and even.
    #[test]
    fn sides_are_the_guides_and_uprights_are_straight() {
        let top = "M0,0 C30,-40 70,40 100,0 L150,-20";
        let bottom = "M-10,60 L40,80 Q90,90 160,50";
        for along in [Along::ArcLength, Along::Parameter] {
            let (t, b) = (guide(top, along), guide(bottom, along));
            let m = ruled(FRAME, &t, &b).unwrap();
            for i in -2..=22 {
                let u = f64::from(i) / 20.0;
                let (p, q) = (m.point(source(u, 0.0)), m.point(source(u, 1.0)));
                assert!(p.distance(t.eval(u)) < 1e-9 && q.distance(b.eval(u)) < 1e-9, "{along:?} {u}");
                for v in [-0.3, 0.25, 0.5, 0.9] {
                    assert!(m.point(source(u, v)).distance(p.lerp(q, v)) < 1e-10);
                }
            }
            let h = 1e-5;
            for (u, v) in [(0.1, 0.2), (0.45, 0.7), (0.93, 1.2), (-0.1, 0.5), (1.07, 0.5)] {
                let (p, j) = (source(u, v), m.jet(source(u, v)));
                let dx = (m.point(p + (h, 0.0)) - m.point(p - (h, 0.0))) / (2.0 * h);
                let dy = (m.point(p + (0.0, h)) - m.point(p - (0.0, h))) / (2.0 * h);
                assert!((dx - j.dx).hypot() < 1e-6 && (dy - j.dy).hypot() < 1e-6, "{along:?} {u} {v}: {j:?} {dx} {dy}");
            }
        }
    }

    /// u is the share of the length gone, measured by another integration.
    #[test]
    fn arc_length_is_the_share_of_the_length() {
        let c = CubicBez::new((0.0, 0.0), (10.0, 60.0), (20.0, -30.0), (120.0, 10.0));
        let g = Guide::new(&[Seg::Cubic(c)], Along::ArcLength).unwrap();
        let total = c.arclen(1e-12);
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            let u = c.subsegment(0.0..t).arclen(1e-12) / total;
            assert!(g.eval(u).distance(c.eval(t)) < 1e-8, "{t}");
        }
        // Pieces take their share too, and one without length takes none.
        let g = guide("M0,0 L30,0 L30,0 L30,10", Along::ArcLength);
        assert_eq!(g.joints().collect::<Vec<_>>(), [0.75]);
        assert!(g.eval(0.875).distance((30.0, 5.0).into()) < 1e-12);
        assert!(Guide::new(&[], Along::ArcLength).is_none());
        let dot = Seg::Line(kurbo::Line::new((3.0, 3.0), (3.0, 3.0)));
        assert!(Guide::new(&[dot], Along::ArcLength).is_none() && Guide::new(&[dot], Along::Parameter).is_none());
    }

    /// Strips between polynomial guides are nets, so that images are exact and certified; joints are upright creases.
    #[test]
    fn polynomial_strips_are_nets() {
        let roof = guide("M0,20 L50,0 L100,20", Along::ArcLength);
        let floor = guide("M0,50 Q50,70 100,50", Along::Parameter);
        let m = ruled(FRAME, &roof, &floor).unwrap();
        let mut creases = Creases::default();
        m.creases(&mut creases);
        assert_eq!(creases.items().len(), 1);
        assert!(creases.items()[0].level.at(source(0.5, 0.3)).abs() < 1e-12);
        for u in [0.2, 0.8] {
            let piece = m.branch(source(u, 0.5)).unwrap();
            assert!(matches!(piece.rational_degree(), Some(RationalDegree { rational: false, .. })));
            assert!(piece.point(source(u, 0.4)).distance(m.point(source(u, 0.4))) < 1e-12);
        }
        // A circle by its angle and by its length is the same guide.
        let arc =
            [Seg::Arc(EllipticArc::new(Point::new(50.0, 0.0), Vec2::new(40.0, 0.0), Vec2::new(0.0, 40.0), 3.2, 2.9))];
        let [a, b] = [Along::ArcLength, Along::Parameter].map(|l| Guide::new(&arc, l).unwrap());
        assert!((0..=10).all(|i| a.eval(f64::from(i) / 10.0).distance(b.eval(f64::from(i) / 10.0)) < 1e-9));
    }

    #[test]
    fn the_inverse_returns_in_every_strip() {
        let (t, b) =
            (guide("M0,20 L50,0 L100,20", Along::ArcLength), guide("M0,50 C30,80 60,30 100,60", Along::ArcLength));
        let m = ruled(FRAME, &t, &b).unwrap();
        let back = m.inverse().unwrap();
        for (u, v) in [(0.1, 0.1), (0.49, 0.9), (0.5, 0.5), (0.51, 0.2), (0.97, 0.99), (1.2, 0.5)] {
            let p = source(u, v);
            assert!(back.point(m.point(p)).distance(p) < 1e-8, "{u} {v}");
        }
    }
}
