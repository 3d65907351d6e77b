//! The ruled map between two guide curves: straight lines from the top guide to the bottom one.
//!
//! > F(u, v) = (1 − v)·T(u) + v·B(u)
//!
//! with u and v from 0 to 1 over a box of the source. u is proportional to arc length along a guide, or the guide's own
//! parameter with an equal share for every segment. The vertical lines through the joints of either guide are creases.
//!
//! On a strip between creases on which both guides are polynomials in u, the map is a bicubic net. Being linear in v, its rows
//! divide the lines between the guides evenly.

use super::tiled::TileRow;
use crate::map::curves::{Guide, GuidePiece};
use crate::map::nets::{BicubicNet, Net};
use crate::map::{Jet, Map};
use kurbo::{Affine, CubicBez, Point, Rect};
use std::sync::Arc;

/// The ruled map that takes the upper side of `frame` to `top` and its lower side to `bottom`, as a row of tiles between creases.
/// `None` if the frame has no area.
#[must_use]
pub(crate) fn row(frame: Rect, top: &Guide, bottom: &Guide) -> Option<TileRow> {
    /// Joints closer than this coincide up to rounding, as in guides of equal proportions.
    const MIN_DISTANCE: f64 = 1e-12;
    if !(frame.width() > 0.0 && frame.height() > 0.0) {
        return None;
    }
    let mut cuts: Vec<f64> = top.joints().chain(bottom.joints()).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < MIN_DISTANCE);
    let ends: Vec<f64> = [0.0].into_iter().chain(cuts.iter().copied()).chain([1.0]).collect();
    let maps = ends.windows(2).map(|w| strip(frame, top, bottom, w[0], w[1])).collect();
    let cuts = cuts.iter().map(|u| frame.x0 + u * frame.width()).collect();
    Some(TileRow { cuts, maps })
}

/// The map from the source to (u, v), with u from 0 to 1 over [`u0`, `u1`] of the frame.
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

/// The net of the ruled map between two cubics.
fn between(top: CubicBez, bottom: CubicBez) -> Net {
    let (t, b) = ([top.p0, top.p1, top.p2, top.p3], [bottom.p0, bottom.p1, bottom.p2, bottom.p3]);
    std::array::from_fn(|j| std::array::from_fn(|i| if j == 3 { b[i] } else { t[i].lerp(b[i], j as f64 / 3.0) }))
}

/// The map over a strip whose guides are not both polynomials in u.
#[derive(Debug, Clone)]
struct Strip {
    pre: Affine,
    top: GuidePiece,
    bottom: GuidePiece,
}

impl Map for Strip {
    fn jet(&self, p: Point) -> Jet {
        let Point { x: u, y: v } = self.pre * p;
        let ((t, dt), (b, db)) = (self.top.at(u), self.bottom.at(u));
        let [a, _, _, d, ..] = self.pre.as_coeffs();
        Jet { p: t.lerp(b, v), dx: (dt * (1.0 - v) + db * v) * a, dy: (b - t) * d }
    }

    fn point(&self, p: Point) -> Point {
        let Point { x: u, y: v } = self.pre * p;
        self.top.point(u).lerp(self.bottom.point(u), v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Tiled;
    use crate::map::curves::Along;
    use crate::map::{Creases, RationalDegree};
    use crate::outline::{EllipticArc, Outline, Seg};
    use kurbo::{ParamCurve, ParamCurveArclen, Vec2};

    fn guide(d: &str, along: Along) -> Guide {
        let segs: Vec<Seg> = Outline::from_svg(d).unwrap().segs().copied().collect();
        Guide::new(&segs, along).unwrap()
    }

    const FRAME: Rect = Rect::new(10.0, 20.0, 110.0, 70.0);

    fn ruled(top: &Guide, bottom: &Guide) -> Arc<dyn Map> {
        Tiled::over(FRAME, Vec::new(), vec![row(FRAME, top, bottom).unwrap()]).unwrap()
    }

    fn source(u: f64, v: f64) -> Point {
        Point::new(FRAME.x0 + u * FRAME.width(), FRAME.y0 + v * FRAME.height())
    }

    /// The map reproduces both guides, and divides straight lines between them evenly.
    #[test]
    fn sides_are_the_guides_and_verticals_are_straight() {
        let top = "M0,0 C30,-40 70,40 100,0 L150,-20";
        let bottom = "M-10,60 L40,80 Q90,90 160,50";
        for along in [Along::ArcLength, Along::Parameter] {
            let (t, b) = (guide(top, along), guide(bottom, along));
            let m = ruled(&t, &b);
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

    /// u is the share of the arc length, measured by an independent integration.
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
        // Segments share [0, 1] by length, so one without length has no share.
        let g = guide("M0,0 L30,0 L30,0 L30,10", Along::ArcLength);
        assert_eq!(g.joints().collect::<Vec<_>>(), [0.75]);
        assert!(g.eval(0.875).distance((30.0, 5.0).into()) < 1e-12);
        assert!(Guide::new(&[], Along::ArcLength).is_none());
        let dot = Seg::Line(kurbo::Line::new((3.0, 3.0), (3.0, 3.0)));
        assert!(Guide::new(&[dot], Along::ArcLength).is_none() && Guide::new(&[dot], Along::Parameter).is_none());
    }

    /// Strips between polynomial guides are nets, so that images are exact and certified. Joints are vertical creases.
    #[test]
    fn polynomial_strips_are_nets() {
        let roof = guide("M0,20 L50,0 L100,20", Along::ArcLength);
        let floor = guide("M0,50 Q50,70 100,50", Along::Parameter);
        let m = ruled(&roof, &floor);
        let mut creases = Creases::default();
        m.creases(&mut creases);
        assert_eq!(creases.items().len(), 1);
        assert!(creases.items()[0].level.at(source(0.5, 0.3)).abs() < 1e-12);
        for u in [0.2, 0.8] {
            let piece = m.branch(source(u, 0.5)).unwrap();
            assert!(matches!(piece.rational_degree(), Some(RationalDegree { rational: false, .. })));
            assert!(piece.point(source(u, 0.4)).distance(m.point(source(u, 0.4))) < 1e-12);
        }
        // On a circle, angle and arc length give the same guide.
        let arc =
            [Seg::Arc(EllipticArc::new(Point::new(50.0, 0.0), Vec2::new(40.0, 0.0), Vec2::new(0.0, 40.0), 3.2, 2.9))];
        let [a, b] = [Along::ArcLength, Along::Parameter].map(|l| Guide::new(&arc, l).unwrap());
        assert!((0..=10).all(|i| a.eval(f64::from(i) / 10.0).distance(b.eval(f64::from(i) / 10.0)) < 1e-9));
    }

    #[test]
    fn the_inverse_returns_in_every_strip() {
        let (t, b) =
            (guide("M0,20 L50,0 L100,20", Along::ArcLength), guide("M0,50 C30,80 60,30 100,60", Along::ArcLength));
        let m = ruled(&t, &b);
        let back = m.inverse().unwrap();
        for (u, v) in [(0.1, 0.1), (0.49, 0.9), (0.5, 0.5), (0.51, 0.2), (0.97, 0.99), (1.2, 0.5)] {
            let p = source(u, v);
            assert!(back.point(m.point(p)).distance(p) < 1e-8, "{u} {v}");
        }
    }
}
