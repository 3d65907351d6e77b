//! Chooses the break points, so that as few pieces as possible, of equal difficulty, meet the tolerance.
//!
//! To leading order, the error of a piece goes with the sixth power of its length. The *difficulty* of a stretch is therefore
//! (e/tolerance)^(1/6), where e is its error with a single piece: it adds up along the curve, and one piece fits up to 1. One attempt
//! on the whole stretch predicts the number of pieces; the break points then go to the quantiles of the difficulty measured so far, until
//! every piece fits.
//!
//! Along many curves the coefficient of the leading term changes sign, and a piece across such a point has a much smaller error. So
//! fewer pieces than the difficulty predicts are tried first, and near the limit single break points are moved by bisection.

use crate::fit::{Candidate, ChordFrame};
use crate::judge::thorough;
use crate::limits::{
    BISECTION_MARGIN, BISECTIONS, HOPELESS, MAX_PLANNED, MIN_STRETCH, PLACEMENTS, REPAIRABLE, TRUSTED,
};
use crate::path::Segment;
use crate::report::{Assurance, Piece, REPORT_MARGIN, Report};
use crate::sample::{CHECKED, FITTED, UNEVEN, larger, spaced};
use crate::source::{BreakPoint, Result, Source};
use crate::stretch::{FitOutcome, StretchFitter};
use kurbo::Line;

/// Stretches that are still to be covered, the first on top, each with the outcome of a single piece if it is known.
type Stack = Vec<(BreakPoint, BreakPoint, Option<FitOutcome>)>;

/// A division of a stretch into `n` parts, with the outcomes of those that were attempted.
struct Plan {
    n: usize,
    /// Ends of the parts: the first n + 1 count.
    ends: [BreakPoint; MAX_PLANNED + 1],
    outcomes: [Option<FitOutcome>; MAX_PLANNED],
}

impl<S: Source> StretchFitter<'_, S> {
    /// Appends pieces for the stretch between two break points.
    ///
    /// # Errors
    /// [`NotFinite`](crate::NotFinite) if the curve is not finite somewhere.
    #[inline(always)]
    pub fn cover(
        &mut self,
        from: &BreakPoint,
        to: &BreakPoint,
        out: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<()> {
        let first = self.attempt(from, to)?;
        if first.fits(self.tolerance) {
            self.accept(&first, out, report);
            return Ok(());
        }
        self.divide(from, to, first, out, report)
    }

    /// Covers a stretch that one piece does not fit.
    #[inline(never)]
    fn divide(
        &mut self,
        from: &BreakPoint,
        to: &BreakPoint,
        first: FitOutcome,
        out: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<()> {
        let mut stack: Stack = vec![(*from, *to, Some(first))];
        while let Some((from, to, known)) = stack.pop() {
            let outcome = match known {
                Some(o) => o,
                None => self.attempt(&from, &to)?,
            };
            if outcome.fits(self.tolerance) {
                self.accept(&outcome, out, report);
                self.joints.push(to);
                continue;
            }
            let h = to.t - from.t;
            if self.is_spent() || h < MIN_STRETCH {
                report.unresolved.push(self.source.place(0.5 * (from.t + to.t)));
                // Where the curve swings too fast for its derivatives to be of use, a line is nearer.
                let line = Piece::Line(Line::new(from.p, to.p));
                let fitted = larger(outcome.error, self.distance(&from, &to, outcome.piece)?);
                let straight = self.distance(&from, &to, line)?;
                let (piece, error) = if straight < fitted { (line, straight) } else { (outcome.piece, fitted) };
                report.add_error(error * REPORT_MARGIN, Assurance::Checked);
                out.push(piece);
                continue;
            }
            if let Some(t) = self.slow.middlemost(from.t, to.t).or(outcome.cusp) {
                let mid = self.source.end(t)?;
                stack.push((mid, to, None));
                stack.push((from, mid, None));
                continue;
            }
            self.plan([from, to], &outcome, &mut stack)?;
        }
        Ok(())
    }

    /// Hausdorff distance between a stretch and a piece that misses it.
    #[cold]
    fn distance(&self, from: &BreakPoint, to: &BreakPoint, piece: Piece) -> Result<f64> {
        let c = Segment::from(piece).segment().to_cubic();
        let [t0, t1, q] = [c.p1 - c.p0, c.p3 - c.p2, c.p3 - c.p0];
        // Handles of length one along unnormalised tangents serve also where a handle vanishes.
        let frame = ChordFrame { q, t0, t1, floor: [0.0; 2], size: q.hypot(), home: [1.0; 2], pull: 0.0 };
        let candidate = Candidate { t0: from.t, t1: to.t, p0: c.p0, frame, a: 1.0, b: 1.0 };
        thorough(self.source, &candidate, self.slow, self.tolerance)
    }

    #[inline(always)]
    fn accept(&self, outcome: &FitOutcome, out: &mut Vec<Piece>, report: &mut Report) {
        let error = outcome.error;
        if self.form.is_some() {
            report.add_error(error, Assurance::Certified);
        } else {
            let bound = error * REPORT_MARGIN;
            let bound = larger(error, if bound < self.tolerance { bound } else { self.tolerance });
            report.add_error(bound, if self.sampled { Assurance::Sampled } else { Assurance::Checked });
        }
        out.push(outcome.piece);
    }

    /// Divides a stretch that one piece does not fit into parts of equal difficulty, and puts them on the stack. Some may not fit. Parts
    /// are added until all fit, there are [`MAX_PLANNED`], the work is spent, or a cusp is found.
    fn plan(&mut self, [from, to]: [BreakPoint; 2], whole: &FitOutcome, stack: &mut Stack) -> Result<()> {
        let tol = self.tolerance;
        // Begin with fewer parts than the difficulty predicts, of equal length.
        let n = ((whole.difficulty(tol) * TRUSTED).ceil() as usize).clamp(2, MAX_PLANNED);
        let mut plan = Plan { n, ends: [from; MAX_PLANNED + 1], outcomes: [None; MAX_PLANNED] };
        plan.ends[n] = to;
        let parameter = |i: usize| from.t + (to.t - from.t) * i as f64 / n as f64;
        self.announce(from.t, &(1..n).map(parameter), to.t);
        for (i, end) in plan.ends.iter_mut().enumerate().take(n).skip(1) {
            *end = self.source.end(parameter(i))?;
        }
        let mut placements = 0;
        loop {
            let n = plan.n;
            let mut total = 0.0;
            let mut fits = true;
            // Sums of the difficulties up to each break point.
            let mut sums = [0.0; MAX_PLANNED + 1];
            for i in 0..n {
                let outcome = match plan.outcomes[i] {
                    Some(o) => o,
                    None => self.attempt(&plan.ends[i], &plan.ends[i + 1])?,
                };
                plan.outcomes[i] = Some(outcome);
                total += outcome.difficulty(tol);
                sums[i + 1] = total;
                fits &= outcome.fits(tol);
            }
            placements += 1;
            if fits || self.is_spent() || plan.outcomes[..n].iter().flatten().any(|o| o.cusp.is_some()) {
                break;
            }
            let mut next = n;
            if total > n as f64 * HOPELESS || placements >= PLACEMENTS {
                if !self.evenly && total <= n as f64 * REPAIRABLE && self.repair(&mut plan)? {
                    break;
                }
                next = (n + 1).max((total * TRUSTED).ceil() as usize);
                placements = 0;
            }
            if next > MAX_PLANNED {
                break;
            }
            self.place_at_quantiles(&mut plan, next, &sums)?;
        }
        for i in (0..plan.n).rev() {
            stack.push((plan.ends[i], plan.ends[i + 1], plan.outcomes[i]));
        }
        Ok(())
    }

    /// Divides the plan's stretch into `next` parts at quantiles of the difficulty, whose sums up to the old break points are `sums`.
    fn place_at_quantiles(&self, plan: &mut Plan, next: usize, sums: &[f64; MAX_PLANNED + 1]) -> Result<()> {
        let (n, old) = (plan.n, plan.ends);
        let mut part = 0;
        let mut parameters = [0.0; MAX_PLANNED + 1];
        for (i, parameter) in parameters.iter_mut().enumerate().take(next).skip(1) {
            let quantile = sums[n] * i as f64 / next as f64;
            while part + 1 < n && sums[part + 1] < quantile {
                part += 1;
            }
            let share = (quantile - sums[part]) / (sums[part + 1] - sums[part]);
            *parameter = old[part].t + (old[part + 1].t - old[part].t) * share.clamp(0.0, 1.0);
        }
        self.announce(old[0].t, &parameters[1..next].iter().copied(), old[n].t);
        for (end, parameter) in plan.ends[1..next].iter_mut().zip(&parameters[1..next]) {
            *end = self.source.end(*parameter)?;
        }
        plan.ends[next] = old[n];
        (plan.n, plan.outcomes) = (next, [None; MAX_PLANNED]);
        Ok(())
    }

    /// Announces the break points at some parameters in the stretch from `first` to `last`, and the samples of each part.
    fn announce(&self, first: f64, breaks: &(impl Iterator<Item = f64> + Clone), last: f64) {
        let starts = std::iter::once(first).chain(breaks.clone());
        let parts = starts.zip(breaks.clone().chain([last]));
        let lanes = parts.flat_map(|(a, b)| [&FITTED, &CHECKED, &UNEVEN].map(|set| spaced(a, b - a, set)));
        S::announce(&mut lanes.map(|t| (self.source, t)), &mut breaks.clone().map(|t| (self.source, t)));
    }

    /// Moves break points between a piece that misses and a neighbour that fits until both fit. Near its limit, a piece's
    /// error is not a smooth function of its length, so that quantiles fail. Returns `true` if all pieces fit now.
    fn repair(&mut self, plan: &mut Plan) -> Result<bool> {
        let tol = self.tolerance;
        let fits = |o: &Option<FitOutcome>| o.is_some_and(|o| o.fits(tol));
        let (ends, outcomes) = (&mut plan.ends[..=plan.n], &mut plan.outcomes[..plan.n]);
        for i in 0..outcomes.len() {
            for k in i.saturating_sub(1)..=i {
                if !fits(&outcomes[i]) && k + 1 < outcomes.len() && fits(&outcomes[k]) != fits(&outcomes[k + 1]) {
                    self.balance(&mut ends[k..k + 3], &mut outcomes[k..k + 2])?;
                }
            }
            if !fits(&outcomes[i]) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Moves the break point between two pieces, one of which fits, until both fit or clearly cannot.
    fn balance(&mut self, ends: &mut [BreakPoint], outcomes: &mut [Option<FitOutcome>]) -> Result<()> {
        let tol = self.tolerance;
        let [from, mid, to] = *ends else { return Ok(()) };
        let [Some(first), Some(second)] = *outcomes else { return Ok(()) };
        let (mut lo, mut hi, mut t) = (from.t, to.t, mid.t);
        let mut now = [first, second];
        for _ in 0..BISECTIONS {
            // Let the piece that fits grow.
            *if now[0].fits(tol) { &mut lo } else { &mut hi } = t;
            // Move the break point to half of the difficulty.
            let [before, after] = now.map(|o| o.difficulty(tol));
            let half = 0.5 * (before + after);
            t = if half < before { from.t + (t - from.t) * half / before } else { to.t - (to.t - t) * half / after };
            let margin = BISECTION_MARGIN * (hi - lo);
            if !(t > lo + margin && t < hi - margin) {
                t = 0.5 * (lo + hi);
            }
            self.announce(from.t, &std::iter::once(t), to.t);
            let mid = self.source.end(t)?;
            now = [self.attempt(&from, &mid)?, self.attempt(&mid, &to)?];
            match now.map(|o| o.fits(tol)) {
                [false, false] => return Ok(()),
                [true, true] => {
                    ends[1] = mid;
                    (outcomes[0], outcomes[1]) = (Some(now[0]), Some(now[1]));
                    return Ok(());
                }
                _ => {}
            }
        }
        Ok(())
    }
}
