//! One piece over one stretch of a curve: samples, fit, checks, and what else can be tried where the first fit does not do.

use super::Piece;
use super::certify::{self, Algebra};
use super::fit::{self, Fit, Frame, State, fma};
use super::sampled::Sampled;
use super::samples::{CHECKED, FITTED, Job, Shape, UNIT, between, hermite_exact, straight};
use super::source::{Curve, End, Lane, Lanes};
use super::split::Slow;
use super::verify::{self, Candidate};
use kurbo::{Line, Point, Vec2};

/// Sampled errors up to this share of the tolerance are taken as they are: between sixteen samples a residual of the
/// leading form s²(1−s)²((s−½)²−c) grows by four percent at most, others by little more.
const PLAIN: f64 = 0.9;
/// The errors at 2/17 and 15/17 of a piece are at most this share of the largest, or it is looked at closer. The leading form
/// has an eighth.
const OUTER: f64 = 0.6;
/// PLAIN for the dense check, whose samples are four times as many, with parabolas through them: what those leave out.
const DENSE: f64 = 0.995;
/// The longest proof loses more than the rest of the tolerance.
const MOST_PROVEN: f64 = 0.97;
/// What errors of pieces over several segments grow by between the samples.
const CORNERS: f64 = 1.015;
/// A normal residual is the distance up to κδ²/2, δ the way its foot has still to go: less than this share of the tolerance
/// is let pass (κ about the inverse of the piece's size, δ a share of that size).
const FLAT: f64 = 0.02;
/// A fit this good is not improved further.
const ENOUGH: f64 = 0.85;

/// A handle longer or shorter than Hermite's by the piece's size counts like a residual of this share of the tolerance.
const PULL: f64 = 0.05;

/// What came of fitting one piece to a stretch.
#[derive(Debug, Clone, Copy)]
pub(super) enum Outcome {
    Fits {
        piece: Piece,
        /// Proven, if there is something to prove it with.
        error: f64,
    },
    Misses {
        /// The best try, if the budget ends here.
        piece: Piece,
        error: f64,
        /// The error there would be with more work, as it was estimated: what tells how many pieces are needed.
        reach: f64,
        /// A place where the image nearly stops.
        sharp: Option<f64>,
    },
}

/// Fits one smooth part of a segment.
pub(super) struct Stepper<'a, C> {
    pub(super) source: &'a C,
    pub(super) slow: &'a Slow,
    pub(super) tolerance: f64,
    /// What proofs need, if there are to be any.
    pub(super) algebra: Option<Algebra>,
    /// Whether to look at every piece closely.
    pub(super) careful: bool,
    pub(super) attempts: usize,
}

impl<C: Curve> Stepper<'_, C> {
    /// Fits one piece to a stretch.
    #[inline(never)]
    pub(super) fn attempt(&mut self, from: &End, to: &End) -> Result<Outcome, Point> {
        self.try_stretch(from, to)
    }

    #[inline(always)]
    pub(super) fn try_stretch(&mut self, from: &End, to: &End) -> Result<Outcome, Point> {
        self.attempts += 1;
        let (t0, h) = (from.t, to.t - from.t);
        let tol = self.tolerance;
        let (mut g, mut check) = (Lanes::default(), Lanes::default());
        self.samples(from, h, &FITTED, &mut g)?;
        let q = to.p - from.p;
        let far = |i: usize| g.x[i] * g.x[i] + g.y[i] * g.y[i];
        let size = q.hypot2().max(far(3)).max(far(6)).sqrt();
        if let Some(line) = straight(&g, from, to, size, tol) {
            return self.line(from, to, line, size);
        }
        // The handles of the Hermite cubic; a vanishing one starts tiny and may grow.
        let third = h * (1.0 / 3.0);
        let hermite = [from.speed * third, to.speed * third];
        let least = |a: f64| if a > 0.0 { a.min(1e-3 * size) } else { 1e-5 * size };
        let floor = [least(hermite[0]), least(hermite[1])];
        let pull = (PULL * tol / size).powi(2);
        let frame = Frame { q, t0: from.away, t1: to.into, floor, size, home: hermite, pull };
        let mut z = State { a: hermite[0].max(floor[0]), b: hermite[1].max(floor[1]), s: [0.0; 8] };
        for i in 0..8 {
            z.s[i] = FITTED[i] * UNIT;
        }
        let careful = self.careful || !self.slow.all().is_empty() && self.slow.inside(t0, to.t).is_some();
        self.samples(from, h, &CHECKED, &mut check)?;
        let job = Job { from, to, frame, g: &g, check: &check, careful };
        // Most pieces end here: the Hermite cubic does.
        let (first, drift) = job.glance(&z);
        if first <= PLAIN * tol
            && !careful
            && drift * drift * size <= FLAT * tol
            && hermite[0] > 0.0
            && hermite[1] > 0.0
        {
            let error = if self.algebra.is_some() { self.proven(&job, &z, first)? } else { first };
            if error <= tol {
                return Ok(Outcome::Fits { piece: Piece::Cubic(job.cubic(&z)), error });
            }
        }
        self.improve(&job, z, hermite)
    }

    /// A stretch whose image is straight to rounding.
    #[cold]
    fn line(&self, from: &End, to: &End, (line, off): (Line, f64), size: f64) -> Result<Outcome, Point> {
        let line = Piece::Line(line);
        if self.algebra.is_none() || size == 0.0 {
            return Ok(Outcome::Fits { piece: line, error: off });
        }
        let q = to.p - from.p;
        let length = q.hypot();
        let unit = if length > 0.0 { q / length } else { Vec2::ZERO };
        let frame = Frame { q, t0: unit, t1: unit, floor: [0.0; 2], size, home: [length / 3.0; 2], pull: 0.0 };
        let error = match (&self.algebra, self.source.single()) {
            (None, _) | (_, None) => 0.0,
            (Some(algebra), Some(source)) => {
                let c = Candidate { t0: from.t, t1: to.t, p0: from.p, frame, a: length / 3.0, b: length / 3.0 };
                certify::line(source, algebra, &c, self.tolerance)?
            }
        };
        if error <= self.tolerance {
            return Ok(Outcome::Fits { piece: line, error });
        }
        Ok(Outcome::Misses { piece: line, error, reach: error, sharp: None })
    }

    /// The proven error of a state that was measured to have `error`; what it was measured at where there is nothing to prove
    /// it with.
    #[inline(never)]
    fn proven(&self, job: &Job<'_>, z: &State, error: f64) -> Result<f64, Point> {
        let (Some(algebra), Some(source)) = (&self.algebra, self.source.single()) else { return Ok(error) };
        let c = Candidate { t0: job.from.t, t1: job.to.t, p0: job.from.p, frame: job.frame, a: z.a, b: z.b };
        let mut sampled = Sampled::new(source, algebra, &c, job.frame.home, [job.g, job.check], self.tolerance);
        let even = sampled.even()?;
        if even <= self.tolerance {
            return Ok(even);
        }
        let mut s0 = z.s;
        job.frame.settle(job.g, z.a, z.b, &mut s0);
        let mut s1 = between(&s0);
        job.frame.settle(job.check, z.a, z.b, &mut s1);
        let few = sampled.few([&s0, &s1])?;
        if few <= self.tolerance {
            return Ok(few);
        }
        job.frame.distances(job.g, z.a, z.b, &mut s0, 2);
        job.frame.distances(job.check, z.a, z.b, &mut s1, 2);
        let many = sampled.many([&s0, &s1])?;
        if many <= self.tolerance {
            return Ok(many);
        }
        /// Where they are farther off, no proof succeeds.
        const NEAR: f64 = 3.0;
        let polynomial = algebra.below == 0;
        if polynomial && many.is_finite() && (many > NEAR * self.tolerance || error > MOST_PROVEN * self.tolerance) {
            return Ok(many);
        }
        let mut feet = [0.0; 16];
        for i in 0..8 {
            feet[FITTED[i] as usize - 1] = s0[i];
            feet[CHECKED[i] as usize - 1] = s1[i];
        }
        if !polynomial {
            let quick = certify::quick(source, algebra, &c, &feet)?;
            if quick <= self.tolerance {
                return Ok(quick);
            }
        }
        certify::bound(source, algebra, &c, &feet)
    }

    /// The measured error, and if that will do, the proven one.
    fn judge(&self, job: &Job<'_>, f: &Fit) -> Result<f64, Point> {
        let error = self.check(job, f)?;
        if error <= self.tolerance { self.proven(job, &f.z, error) } else { Ok(error) }
    }

    /// Images at the given samples of the stretch, relative to its first point.
    #[inline(always)]
    fn samples(&self, from: &End, h: f64, set: &Lane, g: &mut Lanes) -> Result<(), Point> {
        let mut t = [0.0; 8];
        for i in 0..8 {
            t[i] = fma(h, set[i] * UNIT, from.t);
        }
        self.source.images_into(&t, g)?;
        for i in 0..8 {
            g.x[i] -= from.p.x;
            g.y[i] -= from.p.y;
        }
        Ok(())
    }

    /// What else can be done where the first fit does not do.
    #[inline(never)]
    fn improve(&mut self, job: &Job<'_>, z: State, hermite: [f64; 2]) -> Result<Outcome, Point> {
        let tol = self.tolerance;
        let frame = &job.frame;
        let (from, to) = (job.from, job.to);
        if (job.careful || hermite[0] == 0.0 || hermite[1] == 0.0) && hermite_exact(job, hermite) {
            let error = self.proven(job, &State { a: hermite[0], b: hermite[1], s: z.s }, 0.0)?;
            let z = State { a: hermite[0], b: hermite[1], ..z };
            if error <= tol {
                return Ok(Outcome::Fits { piece: Piece::Cubic(job.cubic(&z)), error });
            }
        }
        let mut f = fit::fit(frame, job.g, z, [ENOUGH * tol, tol]);
        // Of fits that miss, what they would reach.
        let mut error = f.reach;
        if error <= tol {
            error = self.judge(job, &f)?;
            if error > tol && f.error <= ENOUGH * tol {
                f = fit::fit(frame, job.g, f.z, [0.0, tol]);
                error = f.reach;
                if error <= tol {
                    error = self.judge(job, &f)?;
                }
            }
        }
        // The sum of squares has up to three minima along the valley, as Levien's quartic has roots: where this one nearly
        // does, two others are tried.
        const NEARLY: f64 = 5.0;
        if error > tol && error < NEARLY * tol {
            for k in [1.45, 0.69] {
                let a = f.z.a * k;
                let b = frame.slide(&f.z, a);
                if !(b > frame.floor[1] && b < frame.size) {
                    continue;
                }
                let g = fit::fit(frame, job.g, State { a, b, s: f.z.s }, [ENOUGH * tol, tol]);
                if g.reach < 0.98 * error {
                    let e = if g.reach <= tol { self.judge(job, &g)? } else { g.reach };
                    if e < error {
                        error = e;
                        f = g;
                    }
                    if error <= tol {
                        break;
                    }
                }
            }
        }
        // Minimax: worth it only where it can bring the error below the tolerance.
        const REACH: f64 = 1.4;
        if error > tol && error <= REACH * tol {
            let other = State { s: between(&f.z.s), ..f.z };
            let (z, e) = fit::lawson(frame, [job.g, job.check], [f.z, other], 4);
            if e < error {
                f = Fit { z: z[0], error: e, reach: e, ds: [1.0; 8] };
                error = e;
                if e <= tol {
                    error = self.judge(job, &f)?;
                }
            }
        }
        let piece = Piece::Cubic(job.cubic(&f.z));
        if error <= tol {
            return Ok(Outcome::Fits { piece, error });
        }
        let shape = Shape::of(job.g, frame.q);
        let sharp = if shape.sharp { self.sharpest(from, to, shape.length) } else { None };
        Ok(Outcome::Misses { piece, error: error.max(f.error), reach: error, sharp })
    }

    /// The error of a fit: at all sixteen samples, finer where that is close to the tolerance or the image may be sharp.
    #[inline(always)]
    fn check(&self, job: &Job<'_>, f: &Fit) -> Result<f64, Point> {
        let frame = &job.frame;
        let z = &f.z;
        let mut s0 = [0.0; 8];
        let mut drift = [0.0; 8];
        for i in 0..8 {
            s0[i] = fit::unit(z.s[i] + f.ds[i]);
            drift[i] = f.ds[i].abs();
        }
        let drift = fit::largest(&drift);
        let mut error = f.error;
        if drift * drift * frame.size > FLAT * self.tolerance {
            s0 = z.s;
            error = fit::largest(&frame.distances(job.g, z.a, z.b, &mut s0, 2)).sqrt();
        }
        let mut s1 = between(&s0);
        let d1 = frame.distances(job.check, z.a, z.b, &mut s1, 1);
        let error = error.max(fit::largest(&d1).sqrt());
        if error > self.tolerance {
            return Ok(error);
        }
        // Of the leading form, little is left that near the ends; more of it swings faster than the samples follow.
        let regular = d1[0].max(d1[7]) <= (OUTER * error).powi(2);
        if regular && job.sound(z, &s0, &s1) && !job.careful && error <= PLAIN * self.tolerance {
            return Ok(error);
        }
        self.dense(job, z, &s0, &s1, error)
    }

    #[inline(never)]
    fn dense(&self, job: &Job<'_>, z: &State, s0: &Lane, s1: &Lane, error: f64) -> Result<f64, Point> {
        let c = Candidate { t0: job.from.t, t1: job.to.t, p0: job.from.p, frame: job.frame, a: z.a, b: z.b };
        let mut feet = [0.0; 18];
        feet[17] = 1.0;
        for i in 0..8 {
            feet[FITTED[i] as usize] = s0[i];
            feet[CHECKED[i] as usize] = s1[i];
        }
        let mut e = verify::dense(self.source, &c, &feet, self.slow, self.tolerance)?.max(error);
        if self.source.single().is_none() && self.careful {
            // Joints have corners in their curvature, which no parabola follows.
            e = (e * CORNERS).max(verify::thorough(self.source, &c, self.slow, self.tolerance)?);
        }
        Ok(if e > DENSE * self.tolerance { e / DENSE } else { e })
    }

    /// Where the image is slowest within the stretch, if it nearly stops there.
    #[cold]
    fn sharpest(&self, from: &End, to: &End, length: f64) -> Option<f64> {
        /// Samples of the search; a cusp is then closed in on by golden sections.
        const SAMPLES: usize = 48;
        let h = to.t - from.t;
        let speed = |tau: f64| self.source.image(from.t + h * tau).1.hypot() * h;
        let mut best = (0, f64::INFINITY);
        for i in 1..SAMPLES {
            let v = speed(i as f64 / SAMPLES as f64);
            if v < best.1 {
                best = (i, v);
            }
        }
        let (mut lo, mut hi) = ((best.0 as f64 - 1.0) / SAMPLES as f64, (best.0 as f64 + 1.0) / SAMPLES as f64);
        const GOLD: f64 = 0.381_966_011_250_105;
        for _ in 0..60 {
            let (a, b) = (lo + GOLD * (hi - lo), hi - GOLD * (hi - lo));
            if speed(a) <= speed(b) { hi = b } else { lo = a }
        }
        let tau = 0.5 * (lo + hi);
        /// Faster than this share of the mean is no cusp.
        const STOPS: f64 = 0.1;
        /// Nearer to an end it is that end's own.
        const INSIDE: f64 = 1e-4;
        (speed(tau) < STOPS * length && tau > INSIDE && tau < 1.0 - INSIDE).then_some(from.t + h * tau)
    }
}
