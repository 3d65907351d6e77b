//! Fits one piece to one stretch of a curve: a line if the samples are on one, the Hermite cubic if it fits, else the best cubic found.
//! Samples lie at seventeenths ([`UNIT`]) of a stretch: eight ([`FITTED`]) are fitted, the eight others ([`CHECKED`]) check the fit. With
//! the ends, they are [`IN_ORDER`].

use crate::fit::{ChordFrame, DRIFT, Fit, FitRequest, FitState, Fitting, USUAL, best_fit, size};
use crate::limits::{
    CUSP_SPEED, EVALUATIONS_PER_PIECE, FUTILE_EVALUATIONS, MAX_PLANNED, PACE_EIGHT, PACE_SIXTEEN, SLOW_SPEED,
    SMALL_ERROR, STRAIGHT,
};
use crate::proof;
use crate::report::Piece;
use crate::sample::{
    CHECKED, FITTED, IN_ORDER, Lane, Lanes, SIDE, UNEVEN, UNIT, clamp_unit, feet_between, fma, larger, largest,
    neighbours, norm_squared, residual_at, spaced,
};
use crate::source::{BreakPoint, Quotient, Result, SlowSpots, Source, images, images_into};
use kurbo::{Line, Point, Vec2};
use std::cell::Cell;

/// Evaluations counted for a thorough check, including an allowance for its search.
pub(crate) const THOROUGH_WORK: usize = 800;

/// Factor from the error at eight samples to the reported error.
pub(crate) const EIGHT_GROWTH: f64 = 1.1;

/// Evaluations of the source for an attempt at a piece with its usual checks.
const USUAL_WORK: usize = 32;

/// Even intervals that the eight fitted samples, which alone show a line, are taken to resolve.
const LINE_INTERVALS: usize = 5;
/// Intervals between eight evenly spaced samples inside a stretch and its ends.
const NINTHS: usize = 9;

/// Shortest part of a piece that is searched further, as a share of the piece. On shorter ones the curve has no derivative.
const SHORTEST: f64 = 1e-6;

/// Most parts of a piece that are searched, and the evaluations that count for each.
const MAX_PARTS: usize = 2_000;
const PART_WORK: usize = 8;

/// After this many attempts, each counts as a thorough check: a curve that takes so many may oscillate too fast for its samples.
const HARD_ATTEMPTS: usize = 64;

/// Fits pieces to stretches of one smooth curve.
pub struct StretchFitter<'a, S> {
    pub(crate) source: &'a S,
    pub(crate) slow: &'a SlowSpots,
    pub(crate) tolerance: f64,
    /// The curve as a quotient of polynomials; `None` if proofs are not wanted or not possible.
    pub(crate) form: Option<Quotient>,
    /// Set if the curve is [simple](Source::is_simple) and the ends of the pieces lie on it.
    pub(crate) simple: bool,
    pub(crate) attempts: usize,
    /// Evaluations so far besides those of attempts with their usual checks.
    pub(crate) extra: Cell<usize>,
    /// Set if the curve cannot tell whether samples resolve it.
    pub(crate) sampled: bool,
    /// Number of attempts at which the work ends.
    most_attempts: usize,
    /// Counter of evaluations, if they are counted one by one, and the number at which the work ends.
    pub(crate) counted: Option<(&'a Cell<usize>, usize)>,
    /// Place break points alike from either end.
    pub evenly: bool,
    /// Last end of each piece found so far, if one piece was not enough.
    pub(crate) joints: Vec<BreakPoint>,
}

impl<'a, S: Source> StretchFitter<'a, S> {
    /// Makes a fitter for pieces whose ends are at most `blur` from the curve. The work ends when the attempts of this fitter alone
    /// exceed `left` evaluations, so that the result does not depend on other threads.
    #[inline(always)]
    pub fn new(source: &'a S, slow: &'a SlowSpots, tolerance: f64, (certify, blur): (bool, f64), left: f64) -> Self {
        let (usual, hard) = (left / USUAL_WORK as f64, left / THOROUGH_WORK as f64);
        let most = if usual < HARD_ATTEMPTS as f64 { usual } else { hard.max(HARD_ATTEMPTS as f64) };
        let most_attempts = (most as usize).saturating_add(1);
        let form = if certify { source.quotient().and_then(Quotient::provable) } else { None };
        let form = form.map(|f| Quotient { blur, ..f });
        let simple = blur == 0.0 && source.is_simple();
        Self {
            source,
            slow,
            tolerance,
            form,
            simple,
            attempts: 0,
            extra: Cell::new(0),
            sampled: false,
            most_attempts,
            counted: None,
            evenly: false,
            joints: Vec::new(),
        }
    }

    /// Returns `true` if the allowed work is done.
    pub(crate) fn is_spent(&self) -> bool {
        let (spent, most) = self.counted.map_or((self.evaluations(), usize::MAX), |(calls, most)| (calls.get(), most));
        let earned = FUTILE_EVALUATIONS + EVALUATIONS_PER_PIECE * self.joints.len();
        self.attempts >= self.most_attempts || spent >= most.min(earned)
    }

    /// Upper bound for the evaluations so far.
    #[inline(always)]
    pub fn evaluations(&self) -> usize {
        let each = if self.attempts > HARD_ATTEMPTS { THOROUGH_WORK } else { USUAL_WORK };
        (self.attempts * each).max(self.attempts * USUAL_WORK + self.extra.get())
    }

    /// Takes the fitted samples, to `g`, and sets up the frame.
    #[inline(always)]
    fn request<'r>(&mut self, from: &'r BreakPoint, to: &'r BreakPoint, g: &'r mut Lanes) -> Result<FitRequest<'r>> {
        self.attempts += 1;
        let h = to.t - from.t;
        self.sample(from, h, &FITTED, g)?;
        let q = to.p - from.p;
        let third = h * (1.0 / 3.0);
        let home = [from.speed * third, to.speed * third];
        let frame = ChordFrame::new(q, [from.away, to.into], size(q, g, self.evenly), home, self.tolerance);
        let careful = !self.slow.all().is_empty() && self.slow.middlemost(from.t, to.t).is_some();
        Ok(FitRequest { from, to, frame, g, check: None, careful })
    }

    /// A line, if the image is straight to rounding.
    #[inline(always)]
    fn line(&self, request: &FitRequest<'_>) -> Result<Option<FitOutcome>> {
        let size = request.frame.size;
        let Some((line, off)) = straight(request.g, [request.from, request.to], size, self.tolerance) else {
            return Ok(None);
        };
        let error = match &self.form {
            Some(form) if size > 0.0 => proof::line(self.source, form, [request.from, request.to], size)?,
            _ => off,
        };
        Ok(Some(FitOutcome { piece: Piece::Line(line), error, predicted: error, cusp: None }))
    }

    /// The checked samples, taken on first use.
    #[inline(always)]
    pub(crate) fn checked(&self, request: &mut FitRequest<'_>) -> Result<Lanes> {
        if let Some(check) = request.check {
            return Ok(check);
        }
        let mut check = Lanes::default();
        self.sample(request.from, request.to.t - request.from.t, &CHECKED, &mut check)?;
        request.check = Some(check);
        Ok(check)
    }

    /// Proven error of a state with these foot points; the measured `error` if no proof is wanted or possible.
    #[inline(never)]
    pub(crate) fn proven(
        &self,
        request: &mut FitRequest<'_>,
        state: &FitState,
        feet: [&Lane; 2],
        error: f64,
    ) -> Result<f64> {
        let Some(form) = &self.form else { return Ok(error) };
        let check = self.checked(request)?;
        proof::piece(self.source, form, &request.candidate(state), [request.g, &check], feet, self.tolerance)
    }

    /// Writes the images at the samples `set` of a stretch whose parameter has the length `h`, relative to its first point.
    #[inline(always)]
    fn sample(&self, from: &BreakPoint, h: f64, set: &Lane, g: &mut Lanes) -> Result<()> {
        images_into(self.source, &spaced(from.t, h, set), g)?;
        for i in 0..8 {
            g.x[i] -= from.p.x;
            g.y[i] -= from.p.y;
        }
        Ok(())
    }

    /// Fits one piece to a stretch. If it fits, makes sure that nothing hides between the samples.
    #[inline]
    pub(crate) fn attempt(&mut self, from: &BreakPoint, to: &BreakPoint) -> Result<FitOutcome> {
        let outcome = self.fit_piece(from, to)?;
        if self.form.is_some() || !outcome.fits(self.tolerance) {
            return Ok(outcome);
        }
        let intervals = if matches!(outcome.piece, Piece::Line(_)) { LINE_INTERVALS } else { IN_ORDER - 1 };
        match self.source.resolved([from.t, to.t], intervals, self.tolerance) {
            Some(true) => Ok(outcome),
            known => {
                self.sampled |= known.is_none();
                self.sample_closer(outcome, [from.t, to.t], known.is_some())
            }
        }
    }

    /// The outcome, with a larger error if closer samples contradict it. If the curve knows at which spacing nothing can hide (`is_known`),
    /// the stretch is halved until its samples are as close; else eight samples are taken at uneven parameters.
    #[cold]
    fn sample_closer(&self, outcome: FitOutcome, [from, to]: [f64; 2], is_known: bool) -> Result<FitOutcome> {
        let largest_distance = |t: &Lane| -> Result<f64> {
            self.extra.set(self.extra.get() + 8);
            let g = images(self.source, t)?;
            let distance = |i: usize| outcome.piece.distance(Point::new(g.x[i], g.y[i]));
            Ok((0..8).map(distance).fold(0.0, larger))
        };
        let missed = |error: f64| FitOutcome { error, predicted: error, cusp: None, ..outcome };
        if !is_known {
            let error = largest_distance(&spaced(from, to - from, &UNEVEN))?;
            return Ok(if error > self.tolerance { missed(error) } else { outcome });
        }
        let (mut worst, mut parts) = (outcome.error, 0);
        let mut stretches = vec![[from, to]];
        while let Some([t0, t1]) = stretches.pop() {
            parts += 1;
            self.extra.set(self.extra.get() + PART_WORK);
            let resolved = self.source.resolved([t0, t1], NINTHS, self.tolerance) == Some(true);
            if !resolved && t1 - t0 > SHORTEST * (to - from) && parts < MAX_PARTS {
                let mid = 0.5 * (t0 + t1);
                stretches.extend([[mid, t1], [t0, mid]]);
                continue;
            }
            let ninths = std::array::from_fn(|i| t0 + (t1 - t0) * (i + 1) as f64 / NINTHS as f64);
            worst = larger(worst, largest_distance(&ninths)?);
            if worst > self.tolerance {
                return Ok(missed(worst));
            }
            if parts >= MAX_PARTS {
                return Ok(missed(worst.max(self.tolerance * 2.0)));
            }
        }
        Ok(FitOutcome { error: worst, ..outcome })
    }

    /// A line, the Hermite cubic, or the best cubic found from the Hermite cubic on.
    #[inline(never)]
    fn fit_piece(&mut self, from: &BreakPoint, to: &BreakPoint) -> Result<FitOutcome> {
        let mut g = Lanes::default();
        let mut request = self.request(from, to, &mut g)?;
        if let Some(line) = self.line(&request)? {
            return Ok(line);
        }
        let frame = request.frame;
        let [a, b] = frame.home;
        let next = Lanes { x: neighbours(&request.g.x), y: neighbours(&request.g.y) };
        let first = HermiteResiduals::new(&frame, &FITTED, request.g, &next, 1.0);
        let hermite = if request.careful || a == 0.0 || b == 0.0 {
            self.exact_hermite(&mut request)?
        } else {
            self.hermite(&mut request, &first)?
        };
        if let Some(outcome) = hermite {
            return Ok(outcome);
        }
        let start = FitState { a: larger(a, frame.floor[0]), b: larger(b, frame.floor[1]), s: first.feet(&FITTED) };
        let mut attempt = Attempt { fitter: self, request };
        let best = best_fit(&mut attempt, &USUAL, start, self.tolerance)?;
        // `best.error` is the judged error, or a prediction above the tolerance; `best.fit.error` is the error at the fitted samples.
        let (piece, error) = (Piece::Cubic(attempt.request.cubic(&best.fit.state)), best.error);
        if error <= self.tolerance {
            return Ok(FitOutcome { piece, error, predicted: best.fit.error, cusp: None });
        }
        let cusp = attempt.fitter.cusp(&attempt.request);
        Ok(FitOutcome { piece, error: error.max(best.fit.error), predicted: error, cusp })
    }

    /// The Hermite cubic, if few samples suffice to show that it fits.
    #[inline(always)]
    fn hermite(&self, request: &mut FitRequest<'_>, first: &HermiteResiduals) -> Result<Option<FitOutcome>> {
        let pace = if self.simple { PACE_SIXTEEN } else { PACE_EIGHT };
        if !first.suffice(request.frame.size, self.tolerance, pace) {
            return Ok(None);
        }
        let eight_may_suffice = self.simple && self.form.is_none();
        let error = if eight_may_suffice && first.suffice(request.frame.size, self.tolerance, PACE_EIGHT) {
            EIGHT_GROWTH * first.worst.sqrt()
        } else {
            self.hermite_by_sixteen(request, first, pace)?
        };
        let [a, b] = request.frame.home;
        let piece = Piece::Cubic(request.frame.cubic(request.from.p, request.to.p, a, b));
        Ok((error <= self.tolerance).then_some(FitOutcome { piece, error, predicted: error, cusp: None }))
    }

    /// Error of the Hermite cubic; infinite if sixteen samples leave it in doubt.
    #[inline(never)]
    fn hermite_by_sixteen(&self, request: &mut FitRequest<'_>, first: &HermiteResiduals, pace: f64) -> Result<f64> {
        let check = self.checked(request)?;
        let second = HermiteResiduals::new(&request.frame, &CHECKED, &check, request.g, -1.0);
        let both = first.and(&second);
        if !both.suffice(request.frame.size, self.tolerance, pace) {
            return Ok(f64::INFINITY);
        }
        let ([a, b], s) = (request.frame.home, first.feet(&FITTED));
        self.proven(request, &FitState { a, b, s }, [&s, &second.feet(&CHECKED)], both.worst.sqrt())
    }

    /// The Hermite cubic, if the image is identical to rounding (1e-11 of its size at every sample), so that maps that change little
    /// preserve cusps and coincident handles.
    #[cold]
    fn exact_hermite(&self, request: &mut FitRequest<'_>) -> Result<Option<FitOutcome>> {
        let check = self.checked(request)?;
        let [a, b] = request.frame.home;
        let [c1, c2, c3] = request.frame.power(a, b);
        let is_near = |s: f64, x: f64, y: f64| {
            ((c1 + (c2 + c3 * s) * s) * s - Vec2::new(x, y)).hypot() <= 1e-11 * request.frame.size
        };
        let [s0, s1] = [FITTED, CHECKED].map(|set| set.map(|j| j * UNIT));
        if !(0..8).all(|i| is_near(s0[i], request.g.x[i], request.g.y[i]) && is_near(s1[i], check.x[i], check.y[i])) {
            return Ok(None);
        }
        let state = FitState { a, b, s: s0 };
        let error = self.proven(request, &state, [&s0, &s1], 0.0)?;
        let piece = Piece::Cubic(request.cubic(&state));
        Ok((error <= self.tolerance).then_some(FitOutcome { piece, error, predicted: error, cusp: None }))
    }

    /// The parameter inside a stretch at which the image nearly stops, if there is one.
    #[inline(never)]
    fn cusp(&self, request: &FitRequest<'_>) -> Option<f64> {
        let FitRequest { from, to, frame, g, .. } = request;
        // Find the slowest step of the polygon through the samples, except at the ends, where a short handle slows the image down.
        let tau = |i: usize| if i == 0 { 0.0 } else { FITTED.get(i - 1).map_or(1.0, |j| j * UNIT) };
        let point = |i: usize| match i {
            0 => Vec2::ZERO,
            9 => frame.q,
            _ => Vec2::new(g.x[i - 1], g.y[i - 1]),
        };
        let (mut length, mut slowest) = (0.0, (0, f64::INFINITY));
        for i in 0..9 {
            let step = (point(i + 1) - point(i)).hypot();
            length += step;
            let pace = step / (tau(i + 1) - tau(i));
            if pace < slowest.1 && (1..8).contains(&i) {
                slowest = (i, pace);
            }
        }
        if slowest.1 > SLOW_SPEED * length {
            return None;
        }
        self.extra.set(self.extra.get() + 3 * MAX_PARABOLAS);
        let h = to.t - from.t;
        let squared_speed = |tau: f64| (self.source.eval(from.t + h * tau).1 * h).hypot2();
        // Towards a cusp the speed falls linearly, and its square is a parabola.
        let (mut mid, mut step) = (0.5 * (tau(slowest.0) + tau(slowest.0 + 1)), UNIT);
        let mut least = f64::INFINITY;
        for _ in 0..MAX_PARABOLAS {
            let [before, at_mid, after] = [mid - step, mid, mid + step].map(squared_speed);
            least = at_mid;
            let bend = before - 2.0 * at_mid + after;
            if bend.is_nan() || bend <= 0.0 {
                return None;
            }
            let shift = (0.5 * step * (before - after) / bend).clamp(-2.0 * step, 2.0 * step);
            mid += shift;
            step = (0.5 * shift.abs()).clamp(0.125 * step, 0.5 * step);
            // A minimum at an end is the effect of a short handle.
            if mid <= step || mid >= 1.0 - step {
                return None;
            }
            if step < 1e-6 {
                break;
            }
        }
        (least < (CUSP_SPEED * length).powi(2) && mid > 1e-3 && mid < 1.0 - 1e-3).then_some(from.t + h * mid)
    }
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct FitOutcome {
    /// The best piece found.
    pub(crate) piece: Piece,
    /// Error of the piece, proven where a proof is wanted and possible.
    pub(crate) error: f64,
    /// Error at the fitted samples, or a prediction after more iterations, from which the number of pieces is predicted.
    pub(crate) predicted: f64,
    /// A parameter at which the image nearly stops, if the piece misses.
    pub(crate) cusp: Option<f64>,
}

impl FitOutcome {
    pub(crate) fn fits(&self, tolerance: f64) -> bool {
        self.error <= tolerance
    }

    /// Number of pieces that the stretch needs, as a fraction: the sixth root of error ÷ tolerance.
    pub(crate) fn difficulty(&self, tolerance: f64) -> f64 {
        // Limited to what can be planned at once, and above zero.
        (self.predicted / tolerance).clamp(1e-3, (MAX_PLANNED as f64).powi(6)).powf(1.0 / 6.0)
    }
}

/// A stretch and the fitter that judges its fits.
struct Attempt<'f, 'r, 'a, S> {
    fitter: &'f StretchFitter<'a, S>,
    request: FitRequest<'r>,
}

impl<S: Source> Fitting for Attempt<'_, '_, '_, S> {
    /// The fits of single stretches are not carried to copies of a shape.
    type Mark = ();

    #[inline(always)]
    fn samples(&self) -> (&ChordFrame, &Lanes) {
        (&self.request.frame, self.request.g)
    }

    fn checked(&mut self) -> Result<Lanes> {
        self.fitter.checked(&mut self.request)
    }

    fn feet_between(&self, s: &Lane) -> Lane {
        feet_between(s)
    }

    fn evenly(&self) -> bool {
        self.fitter.evenly
    }

    #[inline(always)]
    fn judge(&mut self, fit: &Fit) -> Result<(f64, ())> {
        Ok((self.fitter.judge(&mut self.request, fit)?, ()))
    }
}

/// Most parabolas through three squared speeds in the search for the slowest point; six are usual.
const MAX_PARABOLAS: usize = 16;

/// Residuals of the Hermite cubic, which has the curve's end derivatives, at eight samples. Most pieces of a gentle curve end with it.
/// As this is the hot path, foot points are the parameters of the samples, and each test takes one reduction.
struct HermiteResiduals {
    /// Square of the largest normal residual.
    worst: f64,
    /// Newton steps of the foot points, and the length of the longest.
    ds: Lane,
    drift: f64,
    /// Squares of the least and the largest distance between neighbouring samples.
    paces: [f64; 2],
    /// Set if the cubic's direction at every sample is within 45° of the direction to the neighbouring sample.
    along: bool,
}

impl HermiteResiduals {
    /// Measures at the samples `set` with images `g`. `next` are their neighbours' images: following in the first half and preceding in the
    /// second if `side` is 1, the other way round if it is −1.
    #[inline(always)]
    fn new(frame: &ChordFrame, set: &Lane, g: &Lanes, next: &Lanes, side: f64) -> Self {
        let power = frame.power(frame.home[0], frame.home[1]);
        let (mut worst, mut drift, mut ds) = ([0.0; 8], [0.0; 8], [0.0; 8]);
        let (mut margin, mut pace, mut slowness) = ([0.0; 8], [0.0; 8], [0.0; 8]);
        for i in 0..8 {
            let (rx, ry, dx, dy) = residual_at(&power, set[i] * UNIT, g.x[i], g.y[i]);
            let speed2 = norm_squared(dx, dy);
            let inverse = 1.0 / speed2;
            let n = fma(rx, dy, -(ry * dx));
            worst[i] = n * n * inverse;
            ds[i] = -fma(rx, dx, ry * dy) * inverse;
            drift[i] = ds[i].abs();
            let (x, y) = (next.x[i] - g.x[i], next.y[i] - g.y[i]);
            let pace2 = fma(x, x, y * y);
            let along = fma(dx, x, dy * y) * (SIDE[i] * side);
            let straight = fma(2.0 * along, along, -(speed2 * pace2));
            margin[i] = -(if along < straight { along } else { straight });
            pace[i] = pace2;
            slowness[i] = -pace2;
        }
        Self {
            worst: largest(&worst),
            ds,
            drift: largest(&drift),
            paces: [-largest(&slowness), largest(&pace)],
            along: largest(&margin) < 0.0,
        }
    }

    /// Both sets of residuals together, with the Newton steps of the first.
    fn and(&self, other: &Self) -> Self {
        Self {
            worst: larger(self.worst, other.worst),
            ds: self.ds,
            drift: larger(self.drift, other.drift),
            paces: [-larger(-self.paces[0], -other.paces[0]), larger(self.paces[1], other.paces[1])],
            along: self.along && other.along,
        }
    }

    /// Returns `true` if the residuals are small, the image's squared speeds differ by a factor of less than `pace`, and the samples
    /// resolve cubic and image.
    #[inline(always)]
    fn suffice(&self, size: f64, tolerance: f64, pace: f64) -> bool {
        // Foot points that move by less than half the spacing keep their order.
        self.worst <= (SMALL_ERROR * tolerance).powi(2)
            && self.drift * self.drift * size <= DRIFT * tolerance
            && self.along
            && self.drift < 0.5 * UNIT
            && self.paces[1] < pace * self.paces[0]
    }

    /// The foot points after their Newton steps.
    #[inline(always)]
    fn feet(&self, set: &Lane) -> Lane {
        let mut s = [0.0; 8];
        for i in 0..8 {
            s[i] = clamp_unit(set[i] * UNIT + self.ds[i]);
        }
        s
    }
}

/// Angle in radians up to which tangents count as along the chord: far below the 0.01° to which joints are kept smooth.
pub const STRAIGHT_TURN: f64 = 1e-6;

/// Returns the line between the ends and the largest distance of the samples from it, if the image is that line to within
/// an invisible distance, runs along it in one direction, and has end tangents along it.
#[inline(always)]
pub(crate) fn straight(g: &Lanes, [from, to]: [&BreakPoint; 2], size: f64, tolerance: f64) -> Option<(Line, f64)> {
    let q = to.p - from.p;
    let from_origin = larger(from.p.x.abs() + from.p.y.abs(), to.p.x.abs() + to.p.y.abs());
    // The rounding of some twenty operations on coordinates, and of differences between samples.
    let (rounding, of_samples) = (4e-15 * from_origin, 1e-12 * size);
    // Distances that are invisible at any scale.
    let (by_size, by_tolerance) = (1e-9 * size, STRAIGHT * tolerance);
    let limit = larger(if by_size < by_tolerance { by_size } else { by_tolerance }, of_samples) + rounding;
    // One sample rejects nearly all curved pieces.
    if (g.x[2] * q.y - g.y[2] * q.x).abs() > size * limit {
        return None;
    }
    all_on_line(g, from, to, limit, if size <= rounding { rounding } else { 0.0 })
}

/// Tests all samples. `point` is the largest extent of a piece that is a single point to rounding; zero for all other pieces.
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
