//! Fewer pieces across smooth joints of the source.
//!
//! A drawing often has more nodes than its shape needs. Where segments follow each other smoothly, their images are one smooth
//! curve, parametrised here by its own length; one cubic is tried over every stretch between places on a grid (the joints, and
//! points between them), and dynamic programming finds the fewest cubics that cover the chain. It is taken only if it has fewer
//! pieces than the segments' own, every piece having passed the dense check, and where proofs are wanted been proven, segment by
//! segment.

use super::certify::{self, Algebra};
use super::source::{Curve, End, Lane, Lanes, Source};
use super::split::{self, Slow};
use super::step::{Outcome, Stepper};
use super::{Assurance, Options, PathReport, Piece};
use crate::map::Map;
use crate::outline::Seg;
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, Point, Vec2};

/// Joints that turn by less than this are smooth: drawings round their coordinates. Radians (half a degree).
const SMOOTH: f64 = 0.0087;
/// Places of the grid in one segment.
const GRID: usize = 6;
/// Segments under one cubic at most: the dense check then has ten samples in each.
const MOST_SPANNED: usize = 6;
/// Segments handled in one table at most.
const MOST_IN_CHAIN: usize = 64;
/// Stretches that fail in a row before longer ones are not tried any more.
const PATIENCE: usize = 2;
/// Share of the tolerance that merged pieces may use: where curvature jumps at a joint, the error has corners that lie between
/// samples.
const SHARE: f64 = 0.97;
/// Searches in one chain.
const SEARCHES: usize = 4;
/// Intervals of a segment's table of lengths.
const TABLE: usize = 16;

/// A stretch between two places of the grid, and whether one cubic covers it or a segment's own pieces do.
type Leg = (usize, usize, bool);

/// Merges the pieces of one subpath.
pub(super) struct Merger<'a> {
    pub(super) map: &'a dyn Map,
    /// What kind of quotient of polynomials the map is.
    pub(super) algebra: Option<crate::map::RationalDegree>,
    pub(super) options: &'a Options,
}

impl Merger<'_> {
    /// The pieces of `segs`, merged where that saves some; `bounds[i]..bounds[i + 1]` are those of segment i.
    pub(super) fn merged(
        &self,
        segs: &[Seg],
        pieces: &[Piece],
        bounds: &[usize],
        report: &mut PathReport,
    ) -> Result<Vec<Piece>, Point> {
        let mut out = Vec::with_capacity(pieces.len());
        let mut i = 0;
        while i < segs.len() {
            let mut chain = Chain::default();
            let mut j = i;
            while j < segs.len() && j - i < MOST_IN_CHAIN && !self.options.shared.has(&segs[j]) {
                let Some(part) = self.part(&segs[j])? else { break };
                if let Some(last) = chain.parts.last()
                    && last.to.into.cross(part.from.away).atan2(last.to.into.dot(part.from.away)).abs() > SMOOTH
                {
                    break;
                }
                chain.push(part);
                j += 1;
            }
            // A segment that cannot be in a chain stands alone.
            let end = j.max(i + 1);
            let own = &pieces[bounds[i]..bounds[end]];
            let better = if end - i > 1 { self.fewest(&chain, pieces, &bounds[i..=end])? } else { None };
            match better {
                Some((merged, error)) => {
                    report.max_error = report.max_error.max(error);
                    let assurance = if self.options.certify { Assurance::Certified } else { Assurance::Checked };
                    report.assurance = report.assurance.min(assurance);
                    out.extend_from_slice(&merged);
                }
                None => out.extend_from_slice(own),
            }
            i = end;
        }
        Ok(out)
    }

    /// The fewest pieces found for a chain, and their largest error. `None`: not fewer than its segments have.
    fn fewest(
        &self,
        chain: &Chain<'_>,
        pieces: &[Piece],
        bounds: &[usize],
    ) -> Result<Option<(Vec<Piece>, f64)>, Point> {
        let own = bounds[bounds.len() - 1] - bounds[0];
        let n = GRID * chain.parts.len();
        let mut ends = Vec::with_capacity(n + 1);
        for k in 0..=n {
            ends.push(chain.end(chain.place(k))?);
        }
        let slow = Slow::default();
        let mut stepper = Stepper {
            source: chain,
            slow: &slow,
            tolerance: SHARE * self.options.tolerance,
            algebra: None,
            known: None,
            careful: false,
            attempts: 0,
        };
        // A quick search, then a close look at the pieces found; those that do not pass are left out of the next search.
        let mut refused = Vec::new();
        for _ in 0..SEARCHES {
            stepper.careful = false;
            let Some(way) = self.search(chain, &mut stepper, &ends, bounds, &refused)? else { return Ok(None) };
            stepper.careful = true;
            let (mut out, mut worst) = (Vec::with_capacity(own), 0.0f64);
            let known = refused.len();
            for (from, to, single) in way {
                if !single {
                    out.extend_from_slice(&pieces[bounds[from / GRID]..bounds[to / GRID]]);
                    continue;
                }
                match stepper.attempt(&ends[from], &ends[to])? {
                    Outcome::Fits { piece, mut error, .. } => {
                        if self.options.certify {
                            error = self.proven(chain, &ends[from], &ends[to], piece)?;
                            if error > self.options.tolerance {
                                refused.push((from, to));
                                continue;
                            }
                        }
                        worst = worst.max(error);
                        out.push(piece);
                    }
                    Outcome::Misses { .. } => refused.push((from, to)),
                }
            }
            if refused.len() == known {
                return Ok(Some((out, worst)));
            }
        }
        Ok(None)
    }

    /// A segment of a chain. `None`: it must stand alone, also because nothing could be proven of it.
    fn part<'s>(&self, seg: &'s Seg) -> Result<Option<Part<'s>>, Point>
    where
        Self: 's,
    {
        let certify = self.options.certify;
        let source = Source::for_proof(seg, self.map, certify);
        let algebra = if certify { Algebra::of(&source, self.algebra) } else { None };
        if certify && algebra.is_none() { Ok(None) } else { Part::new(source, algebra) }
    }

    /// The proven distance of a piece that runs over several segments: each segment's part of it is proven for itself, between
    /// the feet of the joints.
    fn proven(&self, chain: &Chain<'_>, from: &End, to: &End, piece: Piece) -> Result<f64, Point> {
        let cubic = match piece {
            Piece::Line(l) => CubicBez::new(l.p0, l.p0.lerp(l.p1, 1.0 / 3.0), l.p0.lerp(l.p1, 2.0 / 3.0), l.p1),
            Piece::Cubic(c) => c,
        };
        let (mut s, mut worst) = (0.0, 0.0f64);
        for (k, part) in chain.parts.iter().enumerate() {
            let (first, last) = (chain.starts[k], chain.starts[k + 1]);
            let (a, b) = (from.t.max(first), to.t.min(last));
            let Some(algebra) = &part.algebra else { return Ok(f64::INFINITY) };
            if a >= b {
                continue;
            }
            let next = if b == to.t { 1.0 } else { foot(&cubic, part.to.p, s + (1.0 - s) * (b - a) / (to.t - a)) };
            if next <= s {
                return Ok(f64::INFINITY);
            }
            let t0 = if a == first { 0.0 } else { part.param(a - first).0 };
            let t1 = if b == last { 1.0 } else { part.param(b - first).0 };
            let own = cubic.subsegment(s..next);
            worst = worst.max(certify::stretch(&part.source, algebra, [t0, t1], &own, self.options.tolerance)?);
            s = next;
        }
        Ok(worst)
    }

    /// The way through the grid with the fewest pieces: (from, to, whether by one cubic or by a segment's own pieces). `None`: not
    /// fewer than the segments have.
    fn search(
        &self,
        chain: &Chain<'_>,
        stepper: &mut Stepper<'_, Chain<'_>>,
        ends: &[End],
        bounds: &[usize],
        refused: &[(usize, usize)],
    ) -> Result<Option<Vec<Leg>>, Point> {
        let own = bounds[bounds.len() - 1] - bounds[0];
        let n = GRID * chain.parts.len();
        // cost[k]: pieces up to place k; how[k]: where the last of them starts, and what it is.
        let mut cost = vec![usize::MAX; n + 1];
        let mut how = vec![(0, false); n + 1];
        cost[0] = 0;
        for k in 0..n {
            if cost[k] == usize::MAX || cost[k] >= own {
                continue;
            }
            // The segment's own pieces lead from joint to joint.
            if k % GRID == 0 {
                let seg = k / GRID;
                let with = cost[k] + bounds[seg + 1] - bounds[seg];
                if with < cost[k + GRID] {
                    (cost[k + GRID], how[k + GRID]) = (with, (k, false));
                }
            }
            let mut failed = 0;
            for m in k + 1..=n.min(k + GRID * MOST_SPANNED) {
                // Of no use if that place is reached as cheaply already.
                if cost[k] + 1 >= cost[m] || refused.contains(&(k, m)) {
                    continue;
                }
                match stepper.attempt(&ends[k], &ends[m])? {
                    Outcome::Fits { .. } => {
                        failed = 0;
                        (cost[m], how[m]) = (cost[k] + 1, (k, true));
                    }
                    Outcome::Misses { .. } => {
                        failed += 1;
                        if failed > PATIENCE {
                            break;
                        }
                    }
                }
            }
        }
        if cost[n] >= own {
            return Ok(None);
        }
        let mut way = Vec::with_capacity(cost[n]);
        let mut k = n;
        while k > 0 {
            let (from, single) = how[k];
            way.push((from, k, single));
            k = from;
        }
        way.reverse();
        Ok(Some(way))
    }
}

/// The parameter of the point of `c` nearest to `p`, by Newton steps from `s`.
fn foot(c: &CubicBez, p: Point, mut s: f64) -> f64 {
    let slope = c.deriv();
    for _ in 0..8 {
        let (r, v) = (c.eval(s) - p, slope.eval(s).to_vec2());
        s = (s - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    }
    s
}

/// One segment of a chain.
struct Part<'a> {
    source: Source<'a>,
    /// What proofs need, if there are to be any.
    algebra: Option<Algebra>,
    from: End,
    to: End,
    /// Lengths of the image up to i/16 of the parameter.
    table: [f64; TABLE + 1],
}

impl<'a> Part<'a> {
    /// `None` for a segment that must stand alone: one without length, or with sharp spots.
    fn new(source: Source<'a>, algebra: Option<Algebra>) -> Result<Option<Self>, Point> {
        if source.size() == 0.0 || !split::slow(source.seg).all().is_empty() {
            return Ok(None);
        }
        let (from, to) = (source.end(0.0)?, source.end(1.0)?);
        let mut table = [0.0; TABLE + 1];
        let mut last = from.p;
        for half in 0..2 {
            let t: Lane = std::array::from_fn(|i| (8 * half + i + 1) as f64 / TABLE as f64);
            let g = source.images(&t)?;
            for i in 0..8 {
                let p = Point::new(g.x[i], g.y[i]);
                let k = 8 * half + i + 1;
                table[k] = table[k - 1] + (p - last).hypot();
                last = p;
            }
        }
        // A stretch whose image stands still has no direction to be merged by.
        let moves = table.windows(2).all(|w| w[1] > w[0]);
        Ok(moves.then_some(Self { source, algebra, from, to, table }))
    }

    fn length(&self) -> f64 {
        self.table[TABLE]
    }

    /// The segment's parameter at a length, and its derivative.
    fn param(&self, length: f64) -> (f64, f64) {
        let k = self.table.partition_point(|l| *l <= length).clamp(1, TABLE);
        let (a, b) = (self.table[k - 1], self.table[k]);
        let slope = 1.0 / ((b - a) * TABLE as f64);
        (((k - 1) as f64 / TABLE as f64 + (length - a) * slope).clamp(0.0, 1.0), slope)
    }
}

/// Segments in a row as one curve, its parameter being about the length of its image.
#[derive(Default)]
struct Chain<'a> {
    parts: Vec<Part<'a>>,
    /// Where each part begins, and the last ends.
    starts: Vec<f64>,
}

impl<'a> Chain<'a> {
    fn push(&mut self, part: Part<'a>) {
        let at = self.starts.last().copied().unwrap_or_default();
        if self.starts.is_empty() {
            self.starts.push(0.0);
        }
        self.starts.push(at + part.length());
        self.parts.push(part);
    }

    /// The parameter of the grid's place `k`.
    fn place(&self, k: usize) -> f64 {
        let (seg, i) = (k / GRID, k % GRID);
        if i == 0 { self.starts[seg] } else { self.starts[seg] + self.parts[seg].length() * i as f64 / GRID as f64 }
    }

    /// The part at `u`, and the length from its start.
    fn find(&self, u: f64) -> (&Part<'a>, f64) {
        let last = self.parts.len() - 1;
        let k = self.starts.partition_point(|s| *s <= u).saturating_sub(1).min(last);
        (&self.parts[k], u - self.starts[k])
    }
}

impl Curve for Chain<'_> {
    fn images_into(&self, t: &Lane, out: &mut Lanes) -> Result<(), Point> {
        for i in 0..8 {
            let p = self.at(t[i]);
            (out.x[i], out.y[i]) = (p.x, p.y);
        }
        let Some(first) = self.parts.first() else { return Ok(()) };
        first.source.map.lanes(&mut out.x, &mut out.y);
        match (0..8).find(|&i| !(out.x[i] + out.y[i]).is_finite()) {
            Some(i) => Err(self.at(t[i])),
            None => Ok(()),
        }
    }

    fn image(&self, t: f64) -> (Point, Vec2) {
        let (part, length) = self.find(t);
        let (s, slope) = part.param(length);
        let (p, d) = part.source.image(s);
        (p, d * slope)
    }

    fn end(&self, t: f64) -> Result<End, Point> {
        let joint = self.starts.iter().position(|s| *s == t);
        let mut end = match joint {
            // A joint has the tangents of both its segments.
            Some(k) => match (k.checked_sub(1).map(|k| &self.parts[k]), self.parts.get(k)) {
                (Some(a), Some(b)) => End { into: a.to.into, ..b.from },
                (Some(a), None) => a.to,
                (None, Some(b)) => b.from,
                (None, None) => return Err(Point::ORIGIN),
            },
            None => {
                let (part, length) = self.find(t);
                part.source.end(part.param(length).0)?
            }
        };
        // The parameter is the length.
        (end.t, end.speed) = (t, 1.0);
        Ok(end)
    }

    /// Short segments between long ones would fall between even samples.
    fn places(&self, t0: f64, t1: f64) -> Vec<f64> {
        /// In each segment.
        const PLACES: usize = 64;
        let mut out = Vec::new();
        for (part, start) in self.parts.iter().zip(&self.starts) {
            let spread = (0..PLACES).map(|i| start + part.length() * i as f64 / PLACES as f64);
            out.extend(spread.filter(|u| *u > t0 && *u < t1));
        }
        out
    }

    fn at(&self, t: f64) -> Point {
        let (part, length) = self.find(t);
        part.source.at(part.param(length).0)
    }

    fn single(&self) -> Option<&Source<'_>> {
        None
    }
}
