//! The laws that a deformation states about itself, and values known from elsewhere.

use super::frame::frame;
use super::maps::samples;
use super::outcome::Check;
use crate::deform::{Deformation, Law, Pairs};
use crate::map::Map;
use crate::param::Args;
use kurbo::{Point, Rect, Vec2};
use std::cell::Cell;
use std::sync::Arc;

/// The laws.
pub(super) fn laws(entry: &dyn Deformation) -> Check {
    let mut faults = Check::new("laws");
    faults.detail = format!("{} of them", entry.info().laws.len());
    for law in entry.info().laws {
        check_law(entry, law, &mut faults);
    }
    faults
}

/// The known values.
pub(super) fn cases(entry: &dyn Deformation) -> Check {
    let mut faults = Check::new("cases");
    faults.detail = format!("{} known values", entry.info().cases.len());
    for case in entry.info().cases {
        match build(entry, case.args) {
            Ok(map) => {
                let got = map.point(case.at.into());
                let off = got.distance(case.to.into());
                if off.is_nan() || off > case.tolerance {
                    faults.fault(format!(
                        "{:?} takes {:?} to {got:?}, {off:e} away from {:?}",
                        case.args, case.at, case.to
                    ));
                }
            }
            Err(e) => faults.fault(format!("{:?} does not build: {e}", case.args)),
        }
    }
    faults
}

fn build(entry: &dyn Deformation, pairs: Pairs) -> Result<Arc<dyn Map>, crate::Error> {
    entry.build_from(&Args::from_pairs(pairs), &frame()).map(|b| b.map)
}

/// Returns the distance of the image of a point between `p` and `q` from the line through their images.
fn bent(m: &dyn Map, p: Point, q: Point) -> f64 {
    let (a, b, c) = (m.point(p), m.point(p.lerp(q, 0.4)), m.point(q));
    let n = (c - a).hypot();
    if n > 0.0 { ((b - a).cross(c - a) / n).abs() } else { 0.0 }
}

fn check_law(entry: &dyn Deformation, law: &Law, faults: &mut Check) {
    const NEAR: f64 = 1e-9;
    let mut with = |pairs: Pairs| {
        let built = build(entry, pairs);
        if let Err(e) = &built {
            faults.fault(format!("{pairs:?} does not build: {e}"));
        }
        built.ok()
    };
    // The place of the largest value of the last call of `worst`.
    let place = Cell::new(None);
    let worst = |map: &dyn Map, f: &dyn Fn(Point) -> f64| {
        place.set(None);
        samples(map).into_iter().fold(0.0_f64, |most, p| {
            let off = f(p);
            if off > most {
                place.set(Some(p));
            }
            most.max(off)
        })
    };
    let fault = match *law {
        Law::Identity(pairs) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| m.point(p).distance(p));
            (off > NEAR).then(|| format!("{pairs:?} should be the identity; it moves a point by {off:e}"))
        }),
        Law::Same(a, b) => with(a).zip(with(b)).and_then(|(a_map, b_map)| {
            let off = worst(&*a_map, &|p| a_map.point(p).distance(b_map.point(p)));
            (off > NEAR).then(|| format!("{a:?} and {b:?} should be one map; they differ by {off:e}"))
        }),
        Law::KeepsLines(pairs) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| bent(&*m, p, Point::new(97.0 - p.x, 0.3 * p.y + 11.0)));
            (off > NEAR).then(|| format!("{pairs:?} should keep lines straight; it bends one by {off:e}"))
        }),
        Law::KeepsLinesAlong(pairs, (x, y)) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| bent(&*m, p, p + Vec2::new(x, y) * (9.0 / x.hypot(y))));
            (off > NEAR).then(|| format!("{pairs:?} should keep lines along {x},{y} straight; it bends one by {off:e}"))
        }),
        Law::FixedOutside(pairs, [x0, y0, x1, y1]) => with(pairs).and_then(|m| {
            let inside = Rect::new(x0, y0, x1, y1);
            let moves = worst(&*m, &|p| m.point(p).distance(p)) > 0.0;
            let off = worst(&*m, &|p| if inside.contains(p) { 0.0 } else { m.point(p).distance(p) });
            let inert = format!("{pairs:?} moves nothing at all");
            (off > 0.0 || !moves).then(|| {
                if moves {
                    format!("{pairs:?} should move nothing outside {inside:?}; it moves a point by {off:e}")
                } else {
                    inert
                }
            })
        }),
        Law::Area(pairs, factor) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| (m.jet(p).det() - factor).abs());
            (off > NEAR * (1.0 + factor.abs()))
                .then(|| format!("{pairs:?} should multiply areas by {factor}; it is off by {off:e}"))
        }),
        Law::KeepsAngles(pairs) => with(pairs).and_then(|m| {
            // Cauchy–Riemann equations: ∂F/∂y is ∂F/∂x rotated by 90°.
            let off = worst(&*m, &|p| {
                let j = m.jet(p);
                (j.dy - j.dx.turn_90()).hypot() / j.dx.hypot().max(f64::MIN_POSITIVE)
            });
            (off > NEAR).then(|| format!("{pairs:?} should keep angles; one is off by {off:e}"))
        }),
        Law::Undoes(there, back) => with(there).zip(with(back)).and_then(|(f, g)| {
            let off = worst(&*f, &|p| g.point(f.point(p)).distance(p));
            (off > NEAR).then(|| format!("{back:?} should undo {there:?}; a point ends {off:e} away"))
        }),
    };
    if let Some(f) = fault {
        let place = place.get().map(|p: Point| format!(", worst at {},{}", p.x, p.y)).unwrap_or_default();
        faults.fault(f + &place);
    }
}
