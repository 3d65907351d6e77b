//! Conversions between the curves of kurbo's fitter and sources.

use crate::source::{ONE_SIDED_STEP, Source};
use kurbo::{CurveFitSample, ParamCurveFit, Point, Vec2};
use std::ops::Range;

/// Makes a [`Source`] of a [`ParamCurveFit`], and a `ParamCurveFit` of a source.
///
/// ```
/// use bezierfit::{Kurbo, Options, fit};
/// use kurbo::{Circle, Point, Shape, Vec2, fit_to_bezpath, simplify::SimplifyBezPath};
///
/// let circle = SimplifyBezPath::new(Circle::new((0.0, 0.0), 100.0).path_elements(1e-9));
/// let ours = fit(&Kurbo(circle), &Options::new(0.1))?;
/// assert!(ours.report.max_error <= 0.1 && ours.path.segments().count() < 9);
///
/// let wave = |t: f64| (Point::new(300.0 * t, (9.0 * t).sin()), Vec2::new(300.0, 9.0 * (9.0 * t).cos()));
/// let theirs = fit_to_bezpath(&Kurbo(wave), 0.01);
/// assert!(theirs.segments().count() >= fit(&wave, &Options::new(0.01))?.path.segments().count());
/// # Ok::<(), bezierfit::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Kurbo<C>(pub C);

impl<C: ParamCurveFit> Source for Kurbo<C> {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        self.0.sample_pt_deriv(t)
    }

    fn breaks(&self) -> Vec<f64> {
        /// A curve with more cusps would hang its caller.
        const MOST: usize = 10_000;
        let (mut out, mut parts) = (Vec::new(), vec![0.0..1.0]);
        while let Some(Range { start, end }) = parts.pop().filter(|_| out.len() < MOST) {
            if let Some(t) = self.0.break_cusp(start..end).filter(|t| *t > start && *t < end) {
                out.push(t);
                parts.extend([start..t, t..end]);
            }
        }
        out
    }
}

impl<S: Source> ParamCurveFit for Kurbo<S> {
    fn sample_pt_tangent(&self, t: f64, sign: f64) -> CurveFitSample {
        let (p, d) = self.0.eval(t);
        let beside = if self.0.breaks().contains(&t) { ONE_SIDED_STEP.copysign(sign) } else { 0.0 };
        let tangent = self.0.end(t + beside).map_or(d, |end| if sign < 0.0 { end.into } else { end.away });
        CurveFitSample { p, tangent }
    }

    fn sample_pt_deriv(&self, t: f64) -> (Point, Vec2) {
        self.0.eval(t)
    }

    fn break_cusp(&self, range: Range<f64>) -> Option<f64> {
        self.0.breaks().into_iter().find(|t| *t > range.start && *t < range.end)
    }
}
