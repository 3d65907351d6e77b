//! Where the pieces end: as few as the tolerance allows, of equal difficulty.
//!
//! The error of a piece goes with the sixth power of its length, so a piece with error e uses the share (e/tolerance)^(1/6)
//! of what one piece can do: its difficulty. Difficulties add up along the curve. One attempt on the whole tells how many
//! pieces are needed; the breaks then go to the quantiles of the difficulty measured so far, until every piece fits.
//!
//! That is the leading term. Its coefficient changes sign along many curves, and a piece across such a place has a much smaller
//! error. So fewer pieces than the difficulty says are tried first, and near the limit single breaks are mended by bisection.

use super::fit;
use super::source::{Curve, End, Lanes};
use super::step::{Outcome, Stepper};
use super::{Assurance, PathReport, Piece};
use kurbo::Point;

/// Attempts on one smooth part at most.
const MOST_ATTEMPTS: usize = 2000;
/// Shorter stretches of the parameter than this are not split any more.
const SHORTEST: f64 = 1e-8;
/// Pieces planned at once.
const MOST_PLANNED: usize = 8;

impl Outcome {
    /// The share of one piece's capacity that the stretch takes.
    fn difficulty(&self, tolerance: f64) -> f64 {
        /// Eight pieces; also where nothing is known.
        const MOST: f64 = 2.6e5;
        let (Self::Fits { reach, .. } | Self::Misses { reach, .. }) = self;
        sixth_root((reach / tolerance).clamp(1e-3, MOST))
    }
}

/// x^(1/6) to some 1e-4: the exponent's sixth as a start, two Newton steps.
fn sixth_root(x: f64) -> f64 {
    /// Five sixths of the bits of 1.0, which hold the exponent's bias.
    const BIAS: u64 = 0x3FF0_0000_0000_0000 / 6 * 5;
    let mut y = f64::from_bits(x.to_bits() / 6 + BIAS);
    for _ in 0..2 {
        let y2 = y * y;
        y = (5.0 * y + x / (y2 * y2 * y)) * (1.0 / 6.0);
    }
    y
}
impl<C: Curve> Stepper<'_, C> {
    /// Appends pieces for the stretch between two break points. `Err`: a source place where the map is not finite.
    #[inline(always)]
    pub(super) fn cover(
        &mut self,
        from: &End,
        to: &End,
        out: &mut Vec<Piece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        // As `attempt`, but what most segments end with is not handed round.
        let mut g = Lanes::default();
        let mut job = self.start(from, to, &mut g)?;
        let first = match self.straight(&job)? {
            Some(line) => line,
            None => {
                if let Some(error) = self.glance(&mut job)? {
                    self.accept(Piece::Cubic(job.hermite()), error, out, report);
                    return Ok(());
                }
                self.improve(&mut job)?
            }
        };
        if let Outcome::Fits { piece, error, .. } = first {
            self.accept(piece, error, out, report);
            return Ok(());
        }
        self.divide(from, to, first, out, report)
    }

    /// Covers a stretch that one piece does not.
    #[inline(never)]
    fn divide(
        &mut self,
        from: &End,
        to: &End,
        first: Outcome,
        out: &mut Vec<Piece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let mut stack = vec![(*from, *to, Some(first))];
        while let Some((from, to, known)) = stack.pop() {
            let outcome = match known {
                Some(o) => o,
                None => self.attempt(&from, &to)?,
            };
            let (piece, error, sharp) = match outcome {
                Outcome::Fits { piece, error, .. } => {
                    self.accept(piece, error, out, report);
                    continue;
                }
                Outcome::Misses { piece, error, sharp, .. } => (piece, error, sharp),
            };
            let h = to.t - from.t;
            if self.attempts >= MOST_ATTEMPTS || h < SHORTEST {
                report.over_budget.push(self.source.at(0.5 * (from.t + to.t)));
                report.max_error = report.max_error.max(error);
                report.assurance = report.assurance.min(Assurance::Checked);
                out.push(piece);
                continue;
            }
            let split = self.slow.inside(from.t, to.t).or(sharp);
            if let Some(t) = split {
                let mid = self.source.end(t)?;
                stack.push((mid, to, None));
                stack.push((from, mid, None));
                continue;
            }
            self.plan(from, to, &outcome, &mut stack)?;
        }
        Ok(())
    }

    /// Moves break points between a piece that misses and one beside it that fits, until both fit: near its limit a piece's
    /// error is no smooth function of its length, and no quantile finds the place. `true`: now all pieces fit.
    fn repair(&mut self, ends: &mut [End], got: &mut [Option<Outcome>]) -> Result<bool, Point> {
        let fits = |o: &Option<Outcome>| matches!(o, Some(Outcome::Fits { .. }));
        for i in 0..got.len() {
            for k in i.saturating_sub(1)..=i {
                if !fits(&got[i]) && k + 1 < got.len() && fits(&got[k]) != fits(&got[k + 1]) {
                    self.balance(&mut ends[k..k + 3], &mut got[k..k + 2])?;
                }
            }
            if !fits(&got[i]) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Moves the break point between two pieces, one of which fits, until both do or it is clear that they cannot.
    fn balance(&mut self, ends: &mut [End], got: &mut [Option<Outcome>]) -> Result<(), Point> {
        /// Places tried.
        const BISECTIONS: usize = 5;
        let tol = self.tolerance;
        let [from, mid, to] = *ends else { return Ok(()) };
        let [Some(a), Some(b)] = *got else { return Ok(()) };
        let (mut lo, mut hi, mut t) = (from.t, to.t, mid.t);
        let mut now = [a, b];
        for _ in 0..BISECTIONS {
            // What fits may grow.
            if matches!(now[0], Outcome::Fits { .. }) {
                lo = t;
            } else {
                hi = t;
            }
            let [da, db] = [now[0].difficulty(tol), now[1].difficulty(tol)];
            let half = 0.5 * (da + db);
            t = if half < da { from.t + (t - from.t) * half / da } else { to.t - (to.t - t) * half / db };
            /// Nearer to a place already tried than this share of what is left there is nothing to learn.
            const NEAR: f64 = 0.1;
            let room = NEAR * (hi - lo);
            if !(t > lo + room && t < hi - room) {
                t = 0.5 * (lo + hi);
            }
            let mid = self.source.end(t)?;
            now = [self.attempt(&from, &mid)?, self.attempt(&mid, &to)?];
            match now.map(|o| matches!(o, Outcome::Fits { .. })) {
                [false, false] => return Ok(()),
                [true, true] => {
                    ends[1] = mid;
                    (got[0], got[1]) = (Some(now[0]), Some(now[1]));
                    return Ok(());
                }
                _ => {}
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn accept(&self, piece: Piece, error: f64, out: &mut Vec<Piece>, report: &mut PathReport) {
        if self.algebra.is_some() {
            report.max_error = report.max_error.max(error);
            report.assurance = report.assurance.min(Assurance::Certified);
        } else {
            // What may hide between the samples.
            let bound = error * 1.05;
            let bound = fit::larger(error, if bound < self.tolerance { bound } else { self.tolerance });
            report.max_error = fit::larger(bound, report.max_error);
            report.assurance = report.assurance.min(Assurance::Checked);
        }
        out.push(piece);
    }

    /// Covers a stretch that one piece does not fit by several of equal difficulty, and puts them on the stack.
    fn plan(
        &mut self,
        from: End,
        to: End,
        whole: &Outcome,
        stack: &mut Vec<(End, End, Option<Outcome>)>,
    ) -> Result<(), Point> {
        /// Placements tried with one number of pieces.
        const ROUNDS: usize = 3;
        /// Where the difficulties add up to more than this share of the pieces, other placements do not help.
        const FULL: f64 = 0.995;
        /// But the break points may be mended one by one up to this share: the sixth order is that of the leading term, which
        /// vanishes somewhere on many curves.
        const REPAIRED: f64 = 1.15;
        /// For the same reason so much of what the difficulty of long pieces says is believed.
        const HOPE: f64 = 0.8;
        let tol = self.tolerance;
        let d = whole.difficulty(tol);
        let mut n = ((d * HOPE).ceil() as usize).clamp(2, MOST_PLANNED);
        let mut ends = [from; MOST_PLANNED + 1];
        let mut got: [Option<Outcome>; MOST_PLANNED] = [None; MOST_PLANNED];
        ends[n] = to;
        for (i, end) in ends.iter_mut().enumerate().take(n).skip(1) {
            *end = self.source.end(from.t + (to.t - from.t) * i as f64 / n as f64)?;
        }
        let mut round = 0;
        loop {
            let mut total = 0.0;
            let mut good = true;
            let mut sums = [0.0; MOST_PLANNED + 1];
            for i in 0..n {
                let o = match got[i] {
                    Some(o) => o,
                    None => self.attempt(&ends[i], &ends[i + 1])?,
                };
                got[i] = Some(o);
                total += o.difficulty(tol);
                sums[i + 1] = total;
                good &= matches!(o, Outcome::Fits { .. });
            }
            round += 1;
            let stuck = got[..n].iter().flatten().any(|o| matches!(o, Outcome::Misses { sharp: Some(_), .. }));
            if good || stuck || self.attempts >= MOST_ATTEMPTS {
                break;
            }
            let mut next = n;
            if total > n as f64 * FULL || round >= ROUNDS {
                if total <= n as f64 * REPAIRED && self.repair(&mut ends[..=n], &mut got[..n])? {
                    break;
                }
                next = (n + 1).max((total * HOPE).ceil() as usize);
                round = 0;
            }
            if next > MOST_PLANNED {
                break;
            }
            // Break points at the quantiles of the difficulty.
            let old = ends;
            let mut at = 0;
            for (i, end) in ends.iter_mut().enumerate().take(next).skip(1) {
                let want = total * i as f64 / next as f64;
                while at + 1 < n && sums[at + 1] < want {
                    at += 1;
                }
                let share = (want - sums[at]) / (sums[at + 1] - sums[at]);
                *end = self.source.end(old[at].t + (old[at + 1].t - old[at].t) * share.clamp(0.0, 1.0))?;
            }
            ends[next] = to;
            got = [None; MOST_PLANNED];
            n = next;
        }
        for i in (0..n).rev() {
            stack.push((ends[i], ends[i + 1], got[i]));
        }
        Ok(())
    }
}
