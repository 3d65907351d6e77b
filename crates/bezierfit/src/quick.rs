//! The two quick outcomes: a line, and the Hermite cubic, which matches the curve's end derivatives, at foot points sᵢ = τᵢ.
//!
//! Most pieces of a gentle curve end here, so this is the hot path: one evaluation at eight samples, one reduction per test.

use crate::fit::FitRequest;
use crate::limits::{
    EXACT_HERMITE, IMAGE_ROUNDING, PACE_EIGHT, PACE_SIXTEEN, SAMPLE_ROUNDING, STRAIGHT_SIZE, STRAIGHT_TOLERANCE,
    STRAIGHT_TURN,
};
use crate::sample::{
    CHECKED, FITTED, Lane, Lanes, SIDE, UNIT, fma, larger, largest, neighbours, norm_squared, residual_at,
};
use crate::source::BreakPoint;
use kurbo::{Line, Vec2};

/// Residuals of the Hermite cubic at eight samples.
pub(crate) struct HermiteResiduals {
    /// Square of the largest normal residual.
    pub(crate) worst: f64,
    /// Newton step of each foot point, and the longest of them.
    pub(crate) ds: Lane,
    pub(crate) drift: f64,
    /// Squares of the least and the largest distance between neighbouring samples.
    paces: [f64; 2],
    /// The cubic's direction at every sample is within 45° of that to the neighbouring sample.
    along: bool,
}

impl HermiteResiduals {
    /// Returns `true` if the image's speed is even enough for eight samples to resolve it.
    #[inline(always)]
    pub(crate) fn even(&self) -> bool {
        self.paces[1] < PACE_EIGHT * self.paces[0]
    }

    /// Returns `true` if eight samples, or sixteen with `other`, resolve both the cubic and the image.
    #[inline(always)]
    pub(crate) fn resolved(&self, other: Option<&Self>) -> bool {
        let mut paces = self.paces;
        let (mut along, mut drift) = (self.along, self.drift);
        if let Some(o) = other {
            paces = [-larger(-paces[0], -o.paces[0]), larger(paces[1], o.paces[1])];
            along &= o.along;
            drift = larger(drift, o.drift);
        }
        // Foot points that move by less than half the spacing each cannot change order.
        along && drift < 0.5 * UNIT && paces[1] < PACE_SIXTEEN * paces[0]
    }
}

/// Evaluates the cubic `power` at the samples `g`, which lie at `set` seventeenths. `next` are their neighbours: following
/// in the first half and preceding in the second if `side` is 1, the other way round if it is −1.
#[inline(always)]
fn evaluate(power: &[Vec2; 3], set: &Lane, g: &Lanes, next: &Lanes, side: f64) -> HermiteResiduals {
    let mut worst = [0.0; 8];
    let mut drift = [0.0; 8];
    let mut ds = [0.0; 8];
    let mut margin = [0.0; 8];
    let mut pace = [0.0; 8];
    let mut slowness = [0.0; 8];
    for i in 0..8 {
        let (rx, ry, dx, dy) = residual_at(power, set[i] * UNIT, g.x[i], g.y[i]);
        let d2 = norm_squared(dx, dy);
        let k = 1.0 / d2;
        let n = fma(rx, dy, -(ry * dx));
        worst[i] = n * n * k;
        ds[i] = -fma(rx, dx, ry * dy) * k;
        drift[i] = ds[i].abs();
        let (x, y) = (next.x[i] - g.x[i], next.y[i] - g.y[i]);
        let l2 = fma(x, x, y * y);
        let along = fma(dx, x, dy * y) * (SIDE[i] * side);
        let straight = fma(2.0 * along, along, -(d2 * l2));
        margin[i] = -(if along < straight { along } else { straight });
        pace[i] = l2;
        slowness[i] = -l2;
    }
    HermiteResiduals {
        worst: largest(&worst),
        ds,
        drift: largest(&drift),
        paces: [-largest(&slowness), largest(&pace)],
        along: largest(&margin) < 0.0,
    }
}

impl FitRequest<'_> {
    /// Evaluates the Hermite cubic at the fitted samples.
    #[inline(always)]
    pub(crate) fn hermite_at_fitted(&self) -> HermiteResiduals {
        let [a, b] = self.frame.home;
        let next = Lanes { x: neighbours(&self.g.x), y: neighbours(&self.g.y) };
        evaluate(&self.frame.power(a, b), &FITTED, self.g, &next, 1.0)
    }

    /// Evaluates the Hermite cubic at the checked samples.
    #[inline(always)]
    pub(crate) fn hermite_at_checked(&self, check: &Lanes) -> HermiteResiduals {
        let [a, b] = self.frame.home;
        evaluate(&self.frame.power(a, b), &CHECKED, check, self.g, -1.0)
    }

    /// Returns `true` if the image is the Hermite cubic to rounding. Maps that change little then return cusps and
    /// coincident handles as they were.
    #[cold]
    pub(crate) fn hermite_is_exact(&self, check: &Lanes) -> bool {
        let [c1, c2, c3] = self.frame.power(self.frame.home[0], self.frame.home[1]);
        for (g, set) in [(self.g, &FITTED), (check, &CHECKED)] {
            for i in 0..8 {
                let s = set[i] * UNIT;
                let c = (c1 + (c2 + c3 * s) * s) * s;
                if (c - Vec2::new(g.x[i], g.y[i])).hypot() > EXACT_HERMITE * self.frame.size {
                    return false;
                }
            }
        }
        true
    }
}

/// Returns the line between the ends and the largest distance of the samples from it, if the image is that line to within
/// an invisible distance, runs along it in one direction, and leaves and enters it without a corner.
#[inline(always)]
pub(crate) fn straight(
    g: &Lanes,
    from: &BreakPoint,
    to: &BreakPoint,
    size: f64,
    tolerance: f64,
) -> Option<(Line, f64)> {
    let q = to.p - from.p;
    let from_origin = larger(from.p.x.abs() + from.p.y.abs(), to.p.x.abs() + to.p.y.abs());
    let rounding = IMAGE_ROUNDING * from_origin;
    let (by_size, by_tolerance) = (STRAIGHT_SIZE * size, STRAIGHT_TOLERANCE * tolerance);
    let limit = larger(if by_size < by_tolerance { by_size } else { by_tolerance }, SAMPLE_ROUNDING * size) + rounding;
    // One sample rejects nearly all curved pieces.
    if (g.x[2] * q.y - g.y[2] * q.x).abs() > size * limit {
        return None;
    }
    all_on_line(g, from, to, limit, if size <= rounding { rounding } else { 0.0 })
}

/// `point` is the largest extent of a piece that is a single point to rounding; zero for all other pieces.
#[inline(never)]
fn all_on_line(g: &Lanes, from: &BreakPoint, to: &BreakPoint, limit: f64, point: f64) -> Option<(Line, f64)> {
    let (q, line) = (to.p - from.p, Line::new(from.p, to.p));
    if point > 0.0 {
        return g.x.iter().chain(&g.y).all(|v| v.abs() <= point).then_some((line, 0.0));
    }
    let length = q.hypot();
    let (mut last, mut worst) = (0.0, 0.0);
    for i in 0..8 {
        let along = g.x[i] * q.x + g.y[i] * q.y;
        let off = (g.x[i] * q.y - g.y[i] * q.x).abs();
        if along <= last || off > length * limit {
            return None;
        }
        last = along;
        worst = if off > worst { off } else { worst };
    }
    let turns = |t: Vec2| t.cross(q).abs() > STRAIGHT_TURN * length || t.dot(q) <= 0.0;
    (last < q.hypot2() && !turns(from.away) && !turns(to.into)).then(|| (line, worst / length))
}
