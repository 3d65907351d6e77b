//! Before the fit: the direction in which a segment is fitted, and the places where its image may be sharp.

use crate::outline::Seg;
use bezierfit::SlowSpots;
use kurbo::Point;
use std::cmp::Ordering;

/// Returns the segment in the direction in which every copy of it is fitted, and `true` if that is the reverse of the given
/// one.
///
/// Two shapes that share an edge run along it in opposite directions. Fitting one of them and mirroring the result gives
/// both the same curves to the last bit.
#[inline]
pub(super) fn canonical(seg: &Seg) -> (Seg, bool) {
    if is_backwards(seg) { (seg.reversed(), true) } else { (*seg, false) }
}

/// Returns `true` if [`canonical`] reverses the segment.
#[inline]
pub(super) fn is_backwards(seg: &Seg) -> bool {
    let order = match seg {
        Seg::Line(s) => compare(s.p0, s.p1),
        Seg::Quad(s) => compare(s.p0, s.p2),
        Seg::Cubic(s) => compare(s.p0, s.p3).then_with(|| compare(s.p1, s.p2)),
        Seg::Arc(s) => compare(s.p0, s.p1).then_with(|| 0.0f64.total_cmp(&s.sweep)),
    };
    order == Ordering::Greater
}

#[inline]
fn compare(a: Point, b: Point) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// The slow spots of `seg`.
#[inline]
pub(super) fn slow_spots(seg: &Seg) -> SlowSpots {
    match seg {
        Seg::Line(_) => SlowSpots::default(),
        Seg::Quad(s) => SlowSpots::of_quad(s),
        Seg::Cubic(s) => SlowSpots::of_cubic(s),
        Seg::Arc(s) => SlowSpots::of_arc([s.a, s.b], s.start, s.sweep),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::EllipticArc;
    use kurbo::CubicBez;

    #[test]
    fn both_directions_have_one_canonical_form() {
        let segs = [
            Seg::Cubic(CubicBez::new((0.0, 0.0), (3.0, 1.0), (2.0, 5.0), (0.0, 0.0))),
            Seg::Cubic(CubicBez::new((5.0, 0.1), (3.0, 1.0), (2.0, 5.0), (0.0, 0.3))),
            Seg::Arc(EllipticArc::new(Point::new(3.0, 4.0), (5.0, 1.0).into(), (0.3, 2.0).into(), 0.7, 1.9)),
            Seg::Arc(EllipticArc::new(
                Point::new(3.0, 4.0),
                (5.0, 1.0).into(),
                (0.3, 2.0).into(),
                0.7,
                -std::f64::consts::TAU,
            )),
        ];
        for s in &segs {
            let (a, fa) = canonical(s);
            let (b, fb) = canonical(&s.reversed());
            assert_eq!(a, b);
            assert_ne!(fa, fb);
        }
    }
}
