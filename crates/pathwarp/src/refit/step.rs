//! One piece over one stretch of a curve: samples, fit, checks, and what else can be tried where the first fit does not do.

use super::Piece;
use super::certify::{self, Algebra};
use super::fit::{self, Fit, Frame, State, fma};
use super::sampled::Sampled;
use super::samples::{
    CHECKED, FITTED, Glance, Job, Shape, UNIT, between, hermite_exact, interleaved, most_foreseen, steady, straight,
};
use super::source::{Curve, End, Lane, Lanes};
use super::split::Slow;
use super::verify::{self, Candidate, Feet};
use kurbo::{Line, Point, Vec2};

/// Below this share of the tolerance errors are small: between sixteen samples a residual of the leading form s²(1−s)²((s−½)²−c)
/// rises by four percent at most, others by little more.
const SURE: f64 = 0.7;
/// Up to this share of the tolerance what errors are foreseen to rise to is let pass; up to the other where the
/// pace is uneven or nothing is known of the map.
const RISEN: f64 = 0.97;
/// An error halfway between two samples that is farther than this share from their mean was not to be foreseen by them.
const ASTRAY: f64 = 0.3;
/// The same for the dense check, whose samples are four times as many, with parabolas through them: what those leave out.
const DENSE: f64 = 0.995;
/// The longest proof loses more than the rest of the tolerance.
const MOST_PROVEN: f64 = 0.97;
/// What errors of pieces over several segments grow by between the samples.
const CORNERS: f64 = 1.015;
/// A normal residual is the distance up to κδ²/2, δ the way its foot has still to go: less than this share of the tolerance
/// is let pass (κ about the inverse of the piece's size, δ a share of that size).
const FLAT: f64 = 0.02;
/// With fewer samples, where the map is a quotient of polynomials of low degree and nothing swings faster than eight samples see:
/// errors up to this share of the tolerance are taken by the fitted ones alone.
const EASY: f64 = 0.6;
/// What their errors grow by in between.
const EIGHT: f64 = 1.1;
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
        /// As the fitted samples say, which is what the errors of other pieces are to be compared with.
        reach: f64,
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
    /// What the map says of itself, where the ends of the pieces lie on its image.
    pub(super) known: Option<crate::map::RationalDegree>,
    /// Whether to look at every piece closely.
    pub(super) careful: bool,
    pub(super) attempts: usize,
}

impl<C: Curve> Stepper<'_, C> {
    /// Fits one piece to a stretch.
    #[inline(never)]
    pub(super) fn attempt(&mut self, from: &End, to: &End) -> Result<Outcome, Point> {
        let mut g = Lanes::default();
        let mut job = self.start(from, to, &mut g)?;
        if let Some(outcome) = self.straight(&job)? {
            return Ok(outcome);
        }
        if let Some(error) = self.glance(&mut job)? {
            return Ok(Outcome::Fits { piece: Piece::Cubic(job.hermite()), error, reach: error });
        }
        self.improve(&mut job)
    }

    /// What an attempt starts from.
    #[inline(always)]
    pub(super) fn start<'j>(&mut self, from: &'j End, to: &'j End, g: &'j mut Lanes) -> Result<Job<'j>, Point> {
        self.attempts += 1;
        let (t0, h) = (from.t, to.t - from.t);
        let tol = self.tolerance;
        self.samples(from, h, &FITTED, g)?;
        let q = to.p - from.p;
        let far = |i: usize| g.x[i] * g.x[i] + g.y[i] * g.y[i];
        let size = fit::larger(fit::larger(q.hypot2(), far(3)), far(6)).sqrt();
        // The handles of the Hermite cubic; a vanishing one starts tiny and may grow.
        let third = h * (1.0 / 3.0);
        let hermite = [from.speed * third, to.speed * third];
        let least = |a: f64| if a > 0.0 { a.min(1e-3 * size) } else { 1e-5 * size };
        let floor = [least(hermite[0]), least(hermite[1])];
        let pull = (PULL * tol / size).powi(2);
        let frame = Frame { q, t0: from.away, t1: to.into, floor, size, home: hermite, pull };
        let careful = self.careful || !self.slow.all().is_empty() && self.slow.inside(t0, to.t).is_some();
        Ok(Job { from, to, frame, g, check: None, ds: [0.0; 8], careful })
    }

    /// The Hermite cubic, which most pieces end with: its error, if it does.
    #[inline(always)]
    pub(super) fn glance(&self, job: &mut Job<'_>) -> Result<Option<f64>, Point> {
        let (tol, size) = (self.tolerance, job.frame.size);
        let first = job.glance();
        job.ds = first.ds;
        let [a, b] = job.frame.home;
        let may = |worst: f64, share: f64| worst <= (share * tol).powi(2) && a > 0.0 && b > 0.0 && !job.careful;
        let still = |drift: f64| drift * drift * size <= FLAT * tol;
        if !(may(first.worst, SURE) && still(first.drift) && first.sound(None)) {
            return Ok(None);
        }
        if may(first.worst, EASY) && first.even() && self.algebra.is_none() && !self.opaque() {
            return Ok(Some(EIGHT * first.worst.sqrt()));
        }
        self.second_glance(job, &first)
    }

    /// As [`Stepper::glance`], with all samples.
    #[inline(never)]
    fn second_glance(&self, job: &mut Job<'_>, first: &Glance) -> Result<Option<f64>, Point> {
        let (tol, size) = (self.tolerance, job.frame.size);
        let check = *self.checked(job)?;
        let second = job.second_glance(&check);
        let worst = fit::larger(first.worst, second.worst).sqrt();
        if !(worst <= SURE * tol && second.drift * second.drift * size <= FLAT * tol && first.sound(Some(&second))) {
            return Ok(None);
        }
        if self.algebra.is_none() {
            return Ok(Some(worst));
        }
        let [a, b] = job.frame.home;
        let (mut s0, mut s1) = ([0.0; 8], [0.0; 8]);
        for i in 0..8 {
            s0[i] = fit::unit(FITTED[i] * UNIT + first.ds[i]);
            s1[i] = fit::unit(CHECKED[i] * UNIT + second.ds[i]);
        }
        let error = self.proven(job, &State { a, b, s: s0 }, [&s0, &s1], worst)?;
        Ok((error <= tol).then_some(error))
    }

    /// The outcome, if the image is straight to rounding.
    #[inline(always)]
    pub(super) fn straight(&self, job: &Job<'_>) -> Result<Option<Outcome>, Point> {
        let size = job.frame.size;
        match straight(job.g, job.from, job.to, size, self.tolerance) {
            None => Ok(None),
            Some(line) => self.line(job.from, job.to, line, size).map(Some),
        }
    }

    /// Nothing is known of the map's degree.
    fn opaque(&self) -> bool {
        self.known.is_none()
    }

    /// The checked samples, taken when first wanted.
    #[inline(always)]
    fn checked<'j>(&self, job: &'j mut Job<'_>) -> Result<&'j Lanes, Point> {
        if job.check.is_none() {
            let mut check = Lanes::default();
            self.samples(job.from, job.to.t - job.from.t, &CHECKED, &mut check)?;
            job.check = Some(check);
        }
        Ok(job.check.get_or_insert_default())
    }

    /// A stretch whose image is straight to rounding.
    #[cold]
    fn line(&self, from: &End, to: &End, (line, off): (Line, f64), size: f64) -> Result<Outcome, Point> {
        let line = Piece::Line(line);
        if self.algebra.is_none() || size == 0.0 {
            return Ok(Outcome::Fits { piece: line, error: off, reach: off });
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
            return Ok(Outcome::Fits { piece: line, error, reach: error });
        }
        Ok(Outcome::Misses { piece: line, error, reach: error, sharp: None })
    }

    /// The proven error of a state that was measured to have `error`, with these feet of its samples.
    #[inline(never)]
    fn proven(&self, job: &mut Job<'_>, z: &State, feet: [&Lane; 2], error: f64) -> Result<f64, Point> {
        let (Some(algebra), Some(source)) = (&self.algebra, self.source.single()) else { return Ok(error) };
        let check = *self.checked(job)?;
        let c = job.candidate(z);
        let mut sampled = Sampled::new(source, algebra, &c, job.frame.home, [job.g, &check], self.tolerance);
        let even = sampled.even()?;
        if even <= self.tolerance {
            return Ok(even);
        }
        let few = sampled.few(feet)?;
        if few <= self.tolerance {
            return Ok(few);
        }
        let (mut s0, mut s1) = (*feet[0], *feet[1]);
        job.frame.distances(job.g, z.a, z.b, &mut s0, 2);
        job.frame.distances(&check, z.a, z.b, &mut s1, 2);
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
    pub(super) fn improve(&mut self, job: &mut Job<'_>) -> Result<Outcome, Point> {
        let tol = self.tolerance;
        let frame = &{ job.frame };
        let (from, to) = (job.from, job.to);
        let [a, b] = frame.home;
        if job.careful || a == 0.0 || b == 0.0 {
            let check = *self.checked(job)?;
            if hermite_exact(job, &check) {
                let mut z = State { a, b, s: [0.0; 8] };
                for i in 0..8 {
                    z.s[i] = FITTED[i] * UNIT;
                }
                let error = self.proven(job, &z, [&z.s, &CHECKED.map(|j| j * UNIT)], 0.0)?;
                if error <= tol {
                    return Ok(Outcome::Fits { piece: Piece::Cubic(job.cubic(&z)), error, reach: error });
                }
            }
        }
        let mut z = State { a: fit::larger(a, frame.floor[0]), b: fit::larger(b, frame.floor[1]), s: [0.0; 8] };
        for i in 0..8 {
            z.s[i] = fit::unit(FITTED[i] * UNIT + job.ds[i]);
        }
        let mut f = fit::fit(frame, job.g, z, [ENOUGH * tol, tol]);
        // Of fits that miss, what they would reach.
        let mut error = f.reach;
        if error <= tol {
            error = self.judge(job, &f)?;
            if error > tol && f.error <= ENOUGH * tol {
                let mut start = f.z;
                frame.settle(job.g, start.a, start.b, &mut start.s);
                f = fit::fit(frame, job.g, start, [0.0, tol]);
                error = f.reach;
                if error <= tol {
                    error = self.judge(job, &f)?;
                }
            }
        }
        // The sum of squares has up to three minima along the valley, as Levien's quartic has roots: where this one nearly
        // does, two others are tried. Seldom is one of them lower on a piece that turns much, or by much; more often the one with
        // more even handles is.
        const NEARLY: f64 = 1.2;
        const LESS_SO: f64 = 3.0;
        /// Cosine of the turn from end to end, 50°.
        const TURNS: f64 = 0.643;
        let within = if frame.t0.dot(frame.t1) > TURNS { LESS_SO } else { NEARLY };
        if error > tol && error < within * tol {
            for k in if f.z.a < f.z.b { [1.45, 0.69] } else { [0.69, 1.45] } {
                let a = f.z.a * k;
                let b = frame.slide(&f.z, a);
                if !(b > frame.floor[1] && b < frame.size) {
                    continue;
                }
                let mut start = State { a, b, s: f.z.s };
                frame.settle(job.g, a, b, &mut start.s);
                let g = fit::fit(frame, job.g, start, [ENOUGH * tol, tol]);
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
            let check = *self.checked(job)?;
            let (z, e) = fit::lawson(frame, [job.g, &check], [f.z, other], 4);
            if e < error {
                f = Fit { z: z[0], error: e, reach: e, ds: [1.0; 8], squares: [0.0; 8] };
                error = e;
                if e <= tol {
                    error = self.judge(job, &f)?;
                }
            }
        }
        let piece = Piece::Cubic(job.cubic(&f.z));
        if error <= tol {
            return Ok(Outcome::Fits { piece, error, reach: f.error });
        }
        let shape = Shape::of(job.g, frame.q);
        let sharp = if shape.sharp { self.sharpest(from, to, shape.length) } else { None };
        Ok(Outcome::Misses { piece, error: error.max(f.error), reach: error, sharp })
    }

    /// The error of a fit: at all sixteen samples; if that will do, the proven one, or where nothing is to be proven a closer look
    /// at what is near the tolerance or may be sharp.
    #[inline(never)]
    fn judge(&self, job: &mut Job<'_>, f: &Fit) -> Result<f64, Point> {
        let frame = &job.frame;
        let z = &f.z;
        let mut s0 = [0.0; 8];
        let mut drift = [0.0; 8];
        for i in 0..8 {
            s0[i] = fit::unit(z.s[i] + f.ds[i]);
            drift[i] = f.ds[i].abs();
        }
        let drift = fit::largest(&drift);
        let (mut error, mut d0) = (f.error, f.squares);
        if drift * drift * frame.size > FLAT * self.tolerance {
            s0 = z.s;
            d0 = frame.distances(job.g, z.a, z.b, &mut s0, 2);
            error = fit::largest(&d0).sqrt();
        }
        let trusted = self.algebra.is_none() && !job.careful;
        if trusted && error <= EASY * self.tolerance && !self.opaque() {
            let error = fit::larger(job.amid(z, &s0, &d0), error);
            if error <= EASY * self.tolerance {
                return Ok(EIGHT * error);
            }
        }
        let check = *self.checked(job)?;
        let frame = &job.frame;
        let mut s1 = between(&s0);
        let d1 = frame.distances(&check, z.a, z.b, &mut s1, 1);
        let error = error.max(fit::largest(&d1).sqrt());
        if error > self.tolerance {
            return Ok(error);
        }
        if self.algebra.is_some() {
            return self.proven(job, z, [&s0, &s1], error);
        }
        let feet = interleaved(&s0, &s1, 1.0);
        let (sound, even) = job.sound(&check, z, &s0, &s1);
        if trusted && sound && steady(&feet) && error <= RISEN * self.tolerance {
            let frame = &job.frame;
            let [e0, e1] = [(job.g, &s0, &d0), (&check, &s1, &d1)].map(|(g, s, d)| frame.sided(g, z.a, z.b, s, d));
            let errors = interleaved(&e0, &e1, 0.0);
            let sixteen = fit::larger(most_foreseen(&errors), error);
            if sixteen <= if even && !self.opaque() { RISEN } else { SURE } * self.tolerance {
                return Ok(sixteen);
            }
            let limits = [SURE, RISEN, ASTRAY].map(|share| share * self.tolerance);
            if even
                && let Some(closer) = verify::halfway(self.source, &job.candidate(z), &feet, &errors, limits)?
                && closer <= DENSE * self.tolerance
            {
                return Ok(closer.max(error));
            }
        }
        self.dense(job, z, &feet, error)
    }

    #[inline(never)]
    fn dense(&self, job: &Job<'_>, z: &State, feet: &Feet, error: f64) -> Result<f64, Point> {
        let c = job.candidate(z);
        let mut e = verify::dense(self.source, &c, feet, self.slow, self.tolerance)?.max(error);
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
        /// Faster than this share of the mean is no cusp.
        const STOPS: f64 = 0.1;
        // Towards a cusp the speed falls linearly: half a sample off it is far below this.
        if best.1 > 2.0 * STOPS * length {
            return None;
        }
        let (mut lo, mut hi) = ((best.0 as f64 - 1.0) / SAMPLES as f64, (best.0 as f64 + 1.0) / SAMPLES as f64);
        const GOLD: f64 = 0.381_966_011_250_105;
        for _ in 0..60 {
            let (a, b) = (lo + GOLD * (hi - lo), hi - GOLD * (hi - lo));
            if speed(a) <= speed(b) { hi = b } else { lo = a }
        }
        let tau = 0.5 * (lo + hi);
        /// Nearer to an end it is that end's own.
        const INSIDE: f64 = 1e-4;
        (speed(tau) < STOPS * length && tau > INSIDE && tau < 1.0 - INSIDE).then_some(from.t + h * tau)
    }
}
