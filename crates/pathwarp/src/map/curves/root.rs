//! Roots of increasing functions.

/// Steps of an iteration; as many bisections exhaust double precision.
const MAX_STEPS: usize = 60;

/// Finds the root of an increasing function between `lo` and `hi`, from `start`, by Newton iteration that halves the bracket where a step
/// would leave it. `f` returns the value and the slope; `is_close` is asked with the place, the value there and the next step.
pub(crate) fn increasing_root(
    (mut lo, mut hi): (f64, f64),
    start: f64,
    f: impl Fn(f64) -> (f64, f64),
    is_close: impl Fn(f64, f64, f64) -> bool,
) -> f64 {
    let mut x = start;
    for _ in 0..MAX_STEPS {
        let (value, slope) = f(x);
        let step = value / slope;
        // Test for convergence before updating the bracket, which rounding would make too small.
        if is_close(x, value, step) {
            break;
        }
        if value > 0.0 {
            hi = x;
        } else {
            lo = x;
        }
        x = if x - step > lo && x - step < hi { x - step } else { 0.5 * (lo + hi) };
    }
    x
}
