//! The laws that a deformation states about itself, and values known from elsewhere.

use super::frame::frame;
use super::maps::{Domain, skipped};
use super::outcome::{Check, failure};
use crate::deform::{Built, Deformation, Law, Pairs};
use crate::map::Map;
use crate::param::Args;
use kurbo::{Point, Rect, Vec2};
use std::cell::Cell;

/// Differences up to this are rounding.
const NEAR: f64 = 1e-9;

/// The laws.
pub(super) fn laws(entry: &dyn Deformation) -> Check {
    let mut faults = Check::new("laws");
    faults.detail = format!("{} of them", entry.info().laws.len());
    let outside: usize = entry.info().laws.iter().map(|law| check_law(entry, law, &mut faults)).sum();
    faults.detail += &skipped(outside);
    faults
}

/// The known values.
pub(super) fn cases(entry: &dyn Deformation) -> Check {
    let mut faults = Check::new("cases");
    faults.detail = format!("{} known values", entry.info().cases.len());
    for case in entry.info().cases {
        match build(entry, case.args) {
            Ok(built) => {
                let got = built.map.point(case.at.into());
                let off = got.distance(case.to.into());
                if let Some(failure) = failure(&built) {
                    faults.fault(format!("{:?}: {failure}", case.args));
                } else if off.is_nan() || off > case.tolerance {
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

fn build(entry: &dyn Deformation, pairs: Pairs) -> Result<Built, crate::Error> {
    entry.build_from(&Args::from_pairs(pairs), &frame())
}

/// Returns the distance of the image of a point between `p` and `q` from the line through their images.
fn bent(m: &dyn Map, p: Point, q: Point) -> f64 {
    let (a, b, c) = (m.point(p), m.point(p.lerp(q, 0.4)), m.point(q));
    let n = (c - a).hypot();
    if n == 0.0 { 0.0 } else { ((b - a).cross(c - a) / n).abs() }
}

/// Checks a law, and returns the number of samples that were skipped.
fn check_law(entry: &dyn Deformation, law: &Law, faults: &mut Check) -> usize {
    let values = match *law {
        Law::Same(a, b) | Law::Undoes(a, b) => vec![a, b],
        Law::Identity(a)
        | Law::KeepsLines(a)
        | Law::KeepsLinesAlong(a, _)
        | Law::FixedOutside(a, _)
        | Law::Area(a, _)
        | Law::KeepsAngles(a) => vec![a],
    };
    let mut built = Vec::with_capacity(values.len());
    for pairs in &values {
        match build(entry, pairs) {
            Ok(b) => built.push(b),
            Err(e) => faults.fault(format!("{pairs:?} does not build: {e}")),
        }
    }
    let (Some(first), Some(last)) = (built.first(), built.last().filter(|_| built.len() == values.len())) else {
        return 0;
    };
    let domain = Domain::of(first);
    let (samples, outside) = domain.samples();
    let is_partial = domain.is_partial() || Domain::of(last).is_partial();
    let skips = Cell::new(outside);
    // The place of the largest value of the last call of `worst`.
    let place = Cell::new(None);
    let worst = |f: &dyn Fn(Point) -> f64| {
        place.set(None);
        let mut most = 0.0_f64;
        for &p in &samples {
            let off = f(p);
            if off.is_nan() && is_partial {
                skips.set(skips.get() + 1);
            } else if off > most || off.is_nan() {
                place.set(Some(p));
                most = if off.is_nan() { f64::INFINITY } else { off };
            }
        }
        most
    };
    let fault = broken(law, values[0], [&*first.map, &*last.map], &worst);
    // Values after a failure mean nothing.
    if let Some((pairs, e)) = values.iter().zip(&built).find_map(|(pairs, b)| Some((pairs, failure(b)?))) {
        faults.fault(format!("{pairs:?}: {e}"));
    } else if let Some(fault) = fault {
        let place = place.get().map(|p: Point| format!(", worst at {},{}", p.x, p.y)).unwrap_or_default();
        faults.fault(fault + &place);
    }
    skips.get()
}

/// The largest value of a function at the samples.
type Worst<'a> = &'a dyn Fn(&dyn Fn(Point) -> f64) -> f64;

/// What of a law does not hold for its maps `f` and `g`, which are one for most.
fn broken(law: &Law, pairs: Pairs, [f, g]: [&dyn Map; 2], worst: Worst<'_>) -> Option<String> {
    let by = |off: f64| if off.is_finite() { format!("{off:e}") } else { "what is no number".to_owned() };
    match *law {
        Law::Identity(_) => {
            let off = worst(&|p| f.point(p).distance(p));
            (off > NEAR).then(|| format!("{pairs:?} should be the identity; it moves a point by {}", by(off)))
        }
        Law::Same(a, b) => {
            let off = worst(&|p| f.point(p).distance(g.point(p)));
            (off > NEAR).then(|| format!("{a:?} and {b:?} should be one map; they differ by {}", by(off)))
        }
        Law::KeepsLines(_) => {
            let off = worst(&|p| bent(f, p, Point::new(97.0 - p.x, 0.3 * p.y + 11.0)));
            (off > NEAR).then(|| format!("{pairs:?} should keep lines straight; it bends one by {}", by(off)))
        }
        Law::KeepsLinesAlong(_, (x, y)) => {
            let off = worst(&|p| bent(f, p, p + Vec2::new(x, y) * (9.0 / x.hypot(y))));
            (off > NEAR)
                .then(|| format!("{pairs:?} should keep lines along {x},{y} straight; it bends one by {}", by(off)))
        }
        Law::FixedOutside(_, [x0, y0, x1, y1]) => {
            let inside = Rect::new(x0, y0, x1, y1);
            if worst(&|p| f.point(p).distance(p)) > 0.0 {
                let off = worst(&|p| if inside.contains(p) { 0.0 } else { f.point(p).distance(p) });
                (off > 0.0).then(|| {
                    format!("{pairs:?} should move nothing outside {inside:?}; it moves a point by {}", by(off))
                })
            } else {
                Some(format!("{pairs:?} moves nothing at all"))
            }
        }
        Law::Area(_, factor) => {
            let off = worst(&|p| (f.jet(p).det() - factor).abs());
            (off > NEAR * (1.0 + factor.abs()))
                .then(|| format!("{pairs:?} should multiply areas by {factor}; it is off by {}", by(off)))
        }
        Law::KeepsAngles(_) => {
            // Cauchy–Riemann equations: ∂F/∂y is ∂F/∂x rotated by 90°.
            let off = worst(&|p| {
                let j = f.jet(p);
                (j.dy - j.dx.turn_90()).hypot() / j.dx.hypot().max(f64::MIN_POSITIVE)
            });
            (off > NEAR).then(|| format!("{pairs:?} should keep angles; one is off by {}", by(off)))
        }
        Law::Undoes(there, back) => {
            let off = worst(&|p| g.point(f.point(p)).distance(p));
            (off > NEAR).then(|| format!("{back:?} should undo {there:?}; a point ends {} away", by(off)))
        }
    }
}
