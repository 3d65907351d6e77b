//! Fits with a given number of pieces: the tolerance that leads to them is searched for.

use crate::error::Error;
use crate::options::{Options, Pieces};
use crate::report::Fitted;
use kurbo::{BezPath, ParamCurve, PathEl, PathSeg};

/// Fits tried on the way to the least error: it is then known to about a hundredth.
const TRIALS: usize = 40;
/// Ratio of tolerances between which the search ends.
const CLOSE: f64 = 1.01;
/// Further fits, each with this share of the error of the one before.
const POLISHED: usize = 20;
const CLOSER: f64 = 0.96;
/// Of these in a row, so many may need more pieces.
const MISSES: i32 = 4;

/// Fits with the tolerance of the options, or with the one that leads to the wanted number of pieces.
pub(crate) fn limited(options: &Options, fit: impl Fn(&Options) -> Result<Fitted, Error>) -> Result<Fitted, Error> {
    options.checked()?;
    let with = |tolerance: f64| fit(&Options { tolerance, pieces: Pieces::Fewest, ..*options });
    let first = with(options.tolerance)?;
    let (allowed, exactly) = match options.pieces {
        Pieces::Fewest => return Ok(first),
        Pieces::AtMost(n) => (n, false),
        Pieces::Exactly(n) => (n, true),
    };
    let mut least = count(&first);
    if least <= allowed && !exactly {
        return Ok(first);
    }
    let mut best = None;
    // Tolerances that need too many pieces, and that need few enough.
    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut tolerance = options.tolerance;
    let mut fitted = first;
    for _ in 0..TRIALS {
        let found = count(&fitted);
        least = least.min(found);
        // The error goes with the sixth power of the length.
        let factor = (found as f64 / allowed.max(1) as f64).powi(6);
        if found > allowed {
            low = tolerance;
        } else {
            high = tolerance;
            let error = |f: &Fitted| f.report.max_error;
            if best.as_ref().is_none_or(|b| error(&fitted) < error(b)) {
                best = Some(fitted);
            }
        }
        if low * CLOSE >= high {
            break;
        }
        tolerance = match (low > 0.0, high.is_finite()) {
            (true, true) => (low * high).sqrt(),
            (true, false) => low * factor.clamp(2.0, 1e6),
            _ => high * factor.clamp(1e-6, 0.5),
        };
        if !(tolerance > f64::MIN_POSITIVE && tolerance.is_finite()) {
            break;
        }
        fitted = with(tolerance)?;
    }
    // What was found may be closer than its tolerance asked for, and smaller tolerances do not always need more pieces.
    let mut misses = 0;
    for _ in 0..POLISHED {
        let Some(b) = best.as_ref().filter(|_| misses < MISSES) else { break };
        misses += 1;
        let closer = CLOSER.powi(misses) * b.report.max_error;
        if closer < f64::MIN_POSITIVE {
            break;
        }
        let fitted = with(closer)?;
        if count(&fitted) <= allowed && fitted.report.max_error < b.report.max_error {
            (best, misses) = (Some(fitted), 0);
        }
    }
    let Some(mut best) = best else { return Err(Error::TooFewPieces { allowed, least }) };
    if exactly {
        divide(&mut best, allowed);
    } else if best.report.max_error > options.tolerance {
        let worst = best.report.pieces.iter().enumerate().max_by(|a, b| a.1.error.total_cmp(&b.1.error));
        best.report.unresolved.extend(worst.and_then(|(i, _)| Some(best.path.segments().nth(i)?.eval(0.5))));
    }
    Ok(best)
}

fn count(fitted: &Fitted) -> usize {
    fitted.report.pieces.len()
}

/// Divides pieces, the longest most, until there are `wanted`.
fn divide(fitted: &mut Fitted, wanted: usize) {
    let segs: Vec<PathSeg> = fitted.path.segments().collect();
    let length = |s: &PathSeg| s.start().distance(s.eval(0.5)) + s.eval(0.5).distance(s.end());
    let total: f64 = segs.iter().map(length).sum();
    if segs.len() != count(fitted) || segs.len() >= wanted || total <= 0.0 {
        return;
    }
    let extra = (wanted - segs.len()) as f64;
    let (mut path, mut each) = (BezPath::new(), Vec::with_capacity(wanted));
    let (mut along, mut next) = (0.0, 0);
    for e in fitted.path.elements() {
        if let PathEl::MoveTo(p) = e {
            path.move_to(*p);
            continue;
        }
        // A close command has a line of its own unless the subpath is back at its start.
        let start = path.elements().iter().rev().find_map(|e| if let PathEl::MoveTo(p) = e { Some(*p) } else { None });
        let is_back = path.elements().last().and_then(PathEl::end_point) == start;
        if !(matches!(e, PathEl::ClosePath) && is_back) {
            let (seg, report) = (segs[next], fitted.report.pieces[next]);
            let before = (extra * along / total).round();
            along += length(&seg);
            let parts = 1 + ((extra * along / total).round() - before) as usize;
            for i in 0..parts {
                let [t0, t1] = [i, i + 1].map(|k| k as f64 / parts as f64);
                path.push(if parts == 1 { element(seg) } else { element(seg.subsegment(t0..t1)) });
            }
            each.resize(each.len() + parts, report);
            next += 1;
        }
        if let PathEl::ClosePath = e {
            path.close_path();
        }
    }
    (fitted.path, fitted.report.pieces) = (path, each);
}

fn element(seg: PathSeg) -> PathEl {
    match seg {
        PathSeg::Line(l) => PathEl::LineTo(l.p1),
        PathSeg::Quad(q) => PathEl::QuadTo(q.p1, q.p2),
        PathSeg::Cubic(c) => PathEl::CurveTo(c.p1, c.p2, c.p3),
    }
}
