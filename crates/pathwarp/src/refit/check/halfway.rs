//! Samples halfway beside those that may be too far off.

use super::probe::{Probe, probe};
use crate::refit::candidate::Candidate;
use crate::refit::limits::{MAX_HALFWAY, PEAK_ACCEPTED, PEAK_FACTOR, SMALL_ERROR, SURPRISE};
use crate::refit::peaks::predicted_peak;
use crate::refit::samples::{ALL, Evenly};
use crate::refit::source::SourceCurve;
use kurbo::Point;

/// The highest error predicted between sixteen samples, with eight to sixteen more wherever a sample or its prediction is
/// above its limit. `errors` are signed by their side and go with `feet`.
///
/// `None` if nearly all samples are in doubt, or if an error halfway is far from the mean of its neighbours: then sixteen
/// samples do not resolve the error.
pub(in crate::refit) fn halfway(
    source: &SourceCurve<'_>,
    c: &Candidate,
    feet: &Evenly,
    errors: &Evenly,
    tolerance: f64,
) -> Result<Option<f64>, Point> {
    let mut all = [0.0; 2 * ALL - 1];
    let mut in_doubt = [false; ALL];
    let mut highest = 0.0f64;
    for j in 1..ALL - 1 {
        let peak = predicted_peak([errors[j - 1], errors[j], errors[j + 1]], PEAK_FACTOR);
        in_doubt[j] = errors[j].abs() > SMALL_ERROR * tolerance || peak > PEAK_ACCEPTED * tolerance;
        highest = highest.max(if in_doubt[j] { 0.0 } else { peak });
        all[2 * j] = errors[j];
    }
    let mut gaps = [0; MAX_HALFWAY];
    let mut n = 0;
    for j in 0..ALL - 1 {
        if in_doubt[j] || in_doubt[j + 1] {
            if n == MAX_HALFWAY {
                return Ok(None);
            }
            gaps[n] = j;
            n += 1;
        }
    }
    let gaps = &gaps[..n];
    for gaps in gaps.chunks(8) {
        let tau = std::array::from_fn(|i| (gaps[i.min(gaps.len() - 1)] as f64 + 0.5) / (ALL - 1) as f64);
        let Probe { g, s, squares } = probe(source, c, feet, &tau, 2)?;
        let signed = c.frame.signed_distances(&g, c.a, c.b, &s, &squares);
        for (j, e) in gaps.iter().zip(signed) {
            all[2 * j + 1] = e;
            if (e - 0.5 * (errors[*j] + errors[j + 1])).abs() > SURPRISE * tolerance {
                return Ok(None);
            }
        }
    }
    // Between neighbours half as far apart, errors exceed the parabola half as much.
    let peak = |k: usize| predicted_peak([all[k - 1], all[k], all[k + 1]], 0.5 * PEAK_FACTOR);
    let doubtful = (1..ALL - 1).filter(|j| in_doubt[*j]).map(|j| 2 * j);
    Ok(Some(gaps.iter().map(|j| 2 * j + 1).chain(doubtful).map(peak).fold(highest, f64::max)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, Real};
    use crate::outline::Seg;
    use crate::refit::frame::ChordFrame;
    use crate::refit::source::SourceCurve;
    use kurbo::{Line, Vec2};

    /// A line beside the x axis.
    struct Beside(f64);
    impl Formula for Beside {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y + self.0)
        }
    }

    #[test]
    fn an_error_halfway_that_its_neighbours_do_not_predict_resolves_nothing() {
        let seg = Seg::Line(Line::new((0.0, 0.0), (1.0, 0.0)));
        let unit = Vec2::new(1.0, 0.0);
        let third = [1.0 / 3.0; 2];
        let frame = ChordFrame { q: unit, t0: unit, t1: unit, floor: [0.0; 2], size: 1.0, home: third, pull: 0.0 };
        let c = Candidate { t0: 0.0, t1: 1.0, p0: Point::ZERO, frame, a: third[0], b: third[1] };
        let feet = std::array::from_fn(|j| j as f64 / 17.0);
        // One sample above the limit; the error halfway beside it is `beside` of the tolerance.
        let mut errors = [0.65; ALL];
        (errors[0], errors[8], errors[ALL - 1]) = (0.0, 0.75, 0.0);
        let found = |beside: f64| halfway(&SourceCurve::new(&seg, &Beside(beside)), &c, &feet, &errors, 1.0).unwrap();
        assert!(found(0.7).is_some_and(|e| (0.7..1.0).contains(&e)), "{:?}", found(0.7));
        assert!(found(0.45).is_some() && found(0.35).is_none());
    }
}
