//! The sixteen samples of a piece: which they are, and what they tell at a glance.

use super::fit::{self, Frame, State, at, fma, square};
use super::source::{End, Lane, Lanes};
use super::verify::{Candidate, Feet, turns_little};
use kurbo::{Line, Vec2};

/// Samples j/17 that are fitted (both sets symmetric about the middle).
pub(super) const FITTED: Lane = [1.0, 3.0, 5.0, 7.0, 10.0, 12.0, 14.0, 16.0];
/// Samples j/17 that check the fit, between them.
pub(super) const CHECKED: Lane = [2.0, 4.0, 6.0, 8.0, 9.0, 11.0, 13.0, 15.0];
/// Whether the checked sample follows (1) or precedes (−1) the fitted one of the same number.
const SIDE: Lane = [1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0];
/// Paces along a piece may differ by this factor (squared) before its samples are thought too few.
const PACE: f64 = 100.0;
/// Where only eight are looked at, by this (squared): an image that slows down more may turn between two of them.
const EVEN_PACE: f64 = 25.0;
/// Where a fit to the eight that are looked at is taken by them alone, by this (squared).
const EASY_PACE: f64 = 6.25;
/// What residuals at the fitted samples make of those at 8/17 and 9/17, in the widest gap between them, if they are v²·(polynomial
/// of degree seven), v = τ(1−τ). The second is the first read backwards.
const AMID: Lane = {
    let mut out = [0.0; 8];
    let mut i = 0;
    while i < 8 {
        let (at, from) = (8.0, FITTED[i]);
        let v = at * (17.0 - at) / (from * (17.0 - from));
        let mut x = v * v;
        let mut k = 0;
        while k < 8 {
            if k != i {
                x *= (at - FITTED[k]) / (from - FITTED[k]);
            }
            k += 1;
        }
        out[i] = x;
        i += 1;
    }
    out
};
/// What errors rise by between these samples is taken for so many times what a parabola rises; halfway between, half as many.
pub(super) const STEEPER: f64 = 2.5;
/// Spacing.
pub(super) const UNIT: f64 = 1.0 / 17.0;

/// The Hermite cubic, if the image is that to rounding: so maps that change little give cusps and coincident handles back as
/// they were.
#[cold]
pub(super) fn hermite_exact(job: &Job<'_>, check: &Lanes) -> bool {
    /// Exact to rounding.
    const EXACT: f64 = 1e-11;
    let [c1, c2, c3] = job.frame.power(job.frame.home[0], job.frame.home[1]);
    for (g, set) in [(job.g, &FITTED), (check, &CHECKED)] {
        for i in 0..8 {
            let s = set[i] * UNIT;
            let c = (c1 + (c2 + c3 * s) * s) * s;
            if (c - Vec2::new(g.x[i], g.y[i])).hypot() > EXACT * job.frame.size {
                return false;
            }
        }
    }
    true
}

/// One attempt's data.
pub(super) struct Job<'a> {
    pub(super) from: &'a End,
    pub(super) to: &'a End,
    pub(super) frame: Frame,
    pub(super) g: &'a Lanes,
    /// The checked samples, once they are wanted.
    pub(super) check: Option<Lanes>,
    /// The Newton steps of the feet at a glance.
    pub(super) ds: Lane,
    pub(super) careful: bool,
}

/// What eight samples tell of a cubic at the feet that go with an even pace.
pub(super) struct Glance {
    /// The largest normal residual, squared.
    pub(super) worst: f64,
    /// The Newton step of each foot, and the longest.
    pub(super) ds: Lane,
    pub(super) drift: f64,
    /// Least and largest distance between neighbours, squared.
    paces: [f64; 2],
    /// Whether the cubic runs from neighbour to neighbour as the samples do.
    along: bool,
}

impl Glance {
    /// Whether the image's pace is even enough for eight samples to have seen all of it.
    #[inline(always)]
    pub(super) fn even(&self) -> bool {
        self.paces[1] < EVEN_PACE * self.paces[0]
    }

    /// Whether eight samples, or with `other` sixteen, have seen all of the cubic and the image.
    #[inline(always)]
    pub(super) fn sound(&self, other: Option<&Self>) -> bool {
        let mut paces = self.paces;
        let (mut along, mut drift) = (self.along, self.drift);
        if let Some(o) = other {
            paces = [-fit::larger(-paces[0], -o.paces[0]), fit::larger(paces[1], o.paces[1])];
            along &= o.along;
            drift = fit::larger(drift, o.drift);
        }
        // Half the spacing each: feet cannot change order.
        along && drift < 0.5 * UNIT && paces[1] < PACE * paces[0]
    }
}

/// Looks at the samples `g`, `set` in seventeenths, beside their neighbours, which follow (`side` = 1) in the first half and precede
/// in the second, or the other way round (−1).
#[inline(always)]
fn glance(power: &[Vec2; 3], set: &Lane, g: &Lanes, next: &Lanes, side: f64) -> Glance {
    let mut worst = [0.0; 8];
    let mut drift = [0.0; 8];
    let mut ds = [0.0; 8];
    let mut margin = [0.0; 8];
    let mut pace = [0.0; 8];
    let mut slowness = [0.0; 8];
    for i in 0..8 {
        let (rx, ry, dx, dy) = at(power, set[i] * UNIT, g.x[i], g.y[i]);
        let d2 = square(dx, dy);
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
    Glance {
        worst: fit::largest(&worst),
        ds,
        drift: fit::largest(&drift),
        paces: [-fit::largest(&slowness), fit::largest(&pace)],
        along: fit::largest(&margin) < 0.0,
    }
}

/// Each fitted sample's neighbour towards the middle, and past it for the two beside it.
#[inline(always)]
fn neighbours(v: &Lane) -> Lane {
    [v[1], v[2], v[3], v[4], v[3], v[4], v[5], v[6]]
}

impl Job<'_> {
    pub(super) fn cubic(&self, z: &State) -> kurbo::CubicBez {
        self.frame.cubic(self.from.p, self.to.p, z.a, z.b)
    }

    pub(super) fn candidate(&self, z: &State) -> Candidate {
        Candidate { t0: self.from.t, t1: self.to.t, p0: self.from.p, frame: self.frame, a: z.a, b: z.b }
    }

    /// The Hermite cubic.
    #[inline(always)]
    pub(super) fn hermite(&self) -> kurbo::CubicBez {
        let [a, b] = self.frame.home;
        self.frame.cubic(self.from.p, self.to.p, a, b)
    }

    /// The fitted samples beside the Hermite cubic.
    #[inline(always)]
    pub(super) fn glance(&self) -> Glance {
        let [a, b] = self.frame.home;
        let next = Lanes { x: neighbours(&self.g.x), y: neighbours(&self.g.y) };
        glance(&self.frame.power(a, b), &FITTED, self.g, &next, 1.0)
    }

    /// The checked ones.
    #[inline(always)]
    pub(super) fn second_glance(&self, check: &Lanes) -> Glance {
        let [a, b] = self.frame.home;
        glance(&self.frame.power(a, b), &CHECKED, check, self.g, -1.0)
    }

    /// Whether the sixteen samples have seen all there is, and if so, whether the pace is even besides.
    #[inline(always)]
    pub(super) fn sound(&self, check: &Lanes, z: &State, s0: &Lane, s1: &Lane) -> (bool, bool) {
        let paces = self.seen(z, s0, (check, s1, &CHECKED));
        (paces < PACE, paces < EVEN_PACE)
    }

    /// The largest error in the widest gap between the fitted samples, as they foresee it, where they have seen all there is; else
    /// infinite. `squares` are theirs.
    #[inline(always)]
    pub(super) fn amid(&self, z: &State, s0: &Lane, squares: &Lane) -> f64 {
        let next = Lanes { x: neighbours(&self.g.x), y: neighbours(&self.g.y) };
        if self.seen(z, s0, (&next, &neighbours(s0), &neighbours(&FITTED))) >= EASY_PACE {
            return f64::INFINITY;
        }
        let n = self.frame.sided(self.g, z.a, z.b, s0, squares);
        let (mut left, mut right) = ([0.0; 8], [0.0; 8]);
        for i in 0..8 {
            left[i] = n[i] * AMID[i];
            right[i] = n[i] * AMID[7 - i];
        }
        fit::larger(fit::sum(&left).abs(), fit::sum(&right).abs())
    }

    /// How many times as fast as where it is slowest the image gets (squared), if the feet advance evenly enough for the samples to
    /// have seen all of the cubic and its direction at every foot is that of the image there; else infinite. Beside each fitted
    /// sample another is given, with its foot and its place: the next one towards the middle.
    #[inline(always)]
    fn seen(&self, z: &State, s0: &Lane, (next, s1, set): (&Lanes, &Lane, &Lane)) -> f64 {
        /// Feet may be this far from where an even pace would put them.
        const UNEVEN: f64 = 0.18;
        let [c1, c2, c3] = self.frame.power(z.a, z.b);
        let mut margin = [0.0; 8];
        let mut pace = [0.0; 8];
        let mut slowness = [0.0; 8];
        for i in 0..8 {
            let a = UNEVEN - (s0[i] - FITTED[i] * UNIT).abs();
            let b = UNEVEN - (s1[i] - set[i] * UNIT).abs();
            let s = s0[i];
            let (dx, dy) = ((c3.x * 3.0 * s + c2.x * 2.0) * s + c1.x, (c3.y * 3.0 * s + c2.y * 2.0) * s + c1.y);
            let (x, y) = (next.x[i] - self.g.x[i], next.y[i] - self.g.y[i]);
            let (d2, l2) = (dx * dx + dy * dy, x * x + y * y);
            // The other sample follows the fitted one in the first half and precedes it in the second.
            let along = (dx * x + dy * y) * SIDE[i];
            let order = (s1[i] - s0[i]) * SIDE[i];
            let straight = 2.0 * along * along - d2 * l2;
            // The least of all these, negated, for the one reduction there is.
            let m = if a < b { a } else { b };
            let m = if m < order { m } else { order };
            let m = if m < along { m } else { along };
            margin[i] = -(if m < straight { m } else { straight });
            pace[i] = l2;
            slowness[i] = -l2;
        }
        // Nor may the cubic turn back between the outermost feet and its ends.
        let slope = |s: f64| c1 + (c2 * 2.0 + c3 * (3.0 * s)) * s;
        let all = fit::largest(&margin) < 0.0
            && turns_little(self.frame.t0, slope(s0[0]))
            && turns_little(slope(s0[7]), self.frame.t1);
        if all { fit::largest(&pace) / -fit::largest(&slowness) } else { f64::INFINITY }
    }
}

/// Feet of the checked samples from those of the fitted ones, by linear interpolation.
#[inline(always)]
pub(super) fn between(s: &Lane) -> Lane {
    let third = (s[4] - s[3]) / 3.0;
    [
        0.5 * (s[0] + s[1]),
        0.5 * (s[1] + s[2]),
        0.5 * (s[2] + s[3]),
        s[3] + third,
        s[4] - third,
        0.5 * (s[4] + s[5]),
        0.5 * (s[5] + s[6]),
        0.5 * (s[6] + s[7]),
    ]
}

/// What goes with the fitted and the checked samples, in their order along the piece, with the ends: zero and `last`.
pub(super) fn interleaved(fitted: &Lane, checked: &Lane, last: f64) -> Feet {
    let mut v = [0.0; 18];
    v[17] = last;
    for i in 0..8 {
        v[FITTED[i] as usize] = fitted[i];
        v[CHECKED[i] as usize] = checked[i];
    }
    v
}

/// Whether the feet step from sample to sample about as the samples do. Where one leaps, image or cubic nearly stops in between,
/// and the distance has a corner there that may be far higher than the errors on both sides.
#[inline(always)]
pub(super) fn steady(feet: &Feet) -> bool {
    /// The longest step, in spacings.
    const LONGEST: f64 = 1.6;
    let (mut first, mut second) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        first[i] = feet[i + 1] - feet[i];
        second[i] = feet[i + 9] - feet[i + 8];
    }
    let longest = fit::larger(fit::largest(&first), fit::largest(&second));
    fit::larger(feet[17] - feet[16], longest) < LONGEST * UNIT
}

/// The most that [`foreseen`] says of sixteen samples.
#[inline(always)]
pub(super) fn most_foreseen(errors: &Feet) -> f64 {
    let (mut first, mut second) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        first[i] = foreseen([errors[i], errors[i + 1], errors[i + 2]], STEEPER);
        second[i] = foreseen([errors[i + 8], errors[i + 9], errors[i + 10]], STEEPER);
    }
    fit::larger(fit::largest(&first), fit::largest(&second))
}

/// What an error may rise to beside a sample where it is larger than at both neighbours; elsewhere nothing. Errors have the sign
/// of the side they are on. A parabola through a top and its neighbours rises by an eighth of its second difference at most;
/// corners and faster swings rise more, `steeper` times as much.
#[inline(always)]
pub(super) fn foreseen([before, top, after]: [f64; 3], steeper: f64) -> f64 {
    let side = 1.0f64.copysign(top);
    let (a, b, c) = (before * side, top * side, after * side);
    let rises = b + (steeper / 8.0) * (2.0 * b - a - c);
    // Comparisons in this form become no jumps.
    if (b >= a) & (b >= c) { rises } else { 0.0 }
}

/// What the polyline through the samples looks like.
pub(super) struct Shape {
    pub(super) length: f64,
    /// It turns by more than 60° at a sample, or its pace varies more than sixfold.
    pub(super) sharp: bool,
}

impl Shape {
    #[inline(always)]
    pub(super) fn of(g: &Lanes, q: Vec2) -> Self {
        let mut dx = [0.0; 9];
        let mut dy = [0.0; 9];
        dx[0] = g.x[0];
        dy[0] = g.y[0];
        for i in 1..8 {
            dx[i] = g.x[i] - g.x[i - 1];
            dy[i] = g.y[i] - g.y[i - 1];
        }
        dx[8] = q.x - g.x[7];
        dy[8] = q.y - g.y[7];
        let mut l = [0.0; 9];
        for i in 0..9 {
            l[i] = dx[i] * dx[i] + dy[i] * dy[i];
        }
        let mut bent = [false; 8];
        for i in 0..8 {
            let dot = dx[i] * dx[i + 1] + dy[i] * dy[i + 1];
            bent[i] = dot <= 0.0 || 4.0 * dot * dot < l[i] * l[i + 1];
        }
        let mut length = 0.0;
        let (mut least, mut most) = ((0, f64::INFINITY), 0.0f64);
        for (i, l2) in l.iter().enumerate() {
            let l = l2.sqrt();
            length += l;
            // Lengths per unit of the parameter: the end stretches are half as long, the middle one half as long again.
            let pace = l * [2.0, 1.0, 1.0, 1.0, 2.0 / 3.0, 1.0, 1.0, 1.0, 2.0][i];
            if pace < least.1 {
                least = (i, pace);
            }
            most = most.max(pace);
        }
        // At the ends it slows down where a handle is short, which is no sharp turn.
        let slows = 6.0 * least.1 < most && (1..8).contains(&least.0);
        Self { length, sharp: bent.iter().any(|b| *b) || slows }
    }
}

/// Farther than this share of its size from its chord nothing is straight.
const STRAIGHT: f64 = 1e-9;
/// Nor farther than this share of the tolerance.
const UNSEEN: f64 = 1e-3;
/// Rounding of a coordinate after a map's arithmetic, relative to its size.
const ROUNDING: f64 = 4e-15;
/// Rounding of the samples' differences, relative to the size.
const BLUR: f64 = 1e-12;

/// The line between the ends and how far the samples are from it, if the image is that line but for what nobody sees, runs along
/// it one way and leaves it in no direction.
#[inline(always)]
pub(super) fn straight(g: &Lanes, from: &End, to: &End, size: f64, tolerance: f64) -> Option<(Line, f64)> {
    let q = to.p - from.p;
    let from_origin = fit::larger(from.p.x.abs() + from.p.y.abs(), to.p.x.abs() + to.p.y.abs());
    let rounding = ROUNDING * from_origin;
    let (far, unseen) = (STRAIGHT * size, UNSEEN * tolerance);
    let most = fit::larger(if far < unseen { far } else { unseen }, BLUR * size) + rounding;
    // One sample tells nearly all bent pieces.
    if (g.x[2] * q.y - g.y[2] * q.x).abs() > size * most {
        return None;
    }
    straight_at_all(g, from, to, most, if size <= rounding { rounding } else { 0.0 })
}

/// `nothing`: what a piece that is a point by rounding may extend to; zero for all others.
#[inline(never)]
fn straight_at_all(g: &Lanes, from: &End, to: &End, most: f64, nothing: f64) -> Option<(Line, f64)> {
    /// Directions this far apart, in radians, make no corner.
    const TURN: f64 = 1e-6;
    let (q, line) = (to.p - from.p, Line::new(from.p, to.p));
    if nothing > 0.0 {
        return g.x.iter().chain(&g.y).all(|v| v.abs() <= nothing).then_some((line, 0.0));
    }
    let length = q.hypot();
    let (mut last, mut worst) = (0.0, 0.0);
    for i in 0..8 {
        let along = g.x[i] * q.x + g.y[i] * q.y;
        let off = (g.x[i] * q.y - g.y[i] * q.x).abs();
        if along <= last || off > length * most {
            return None;
        }
        last = along;
        worst = if off > worst { off } else { worst };
    }
    let turns = |t: Vec2| t.cross(q).abs() > TURN * length || t.dot(q) <= 0.0;
    (last < q.hypot2() && !turns(from.away) && !turns(to.into)).then(|| (line, worst / length))
}
