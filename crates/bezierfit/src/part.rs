//! Stretches of a curve as sources: the smooth parts between its breaks, and the stretches that single pieces of a fit cover.

use crate::limits::JUMP;
use crate::sample::{Lane, Lanes};
use crate::source::{BreakPoint, NotFinite, ONE_SIDED_STEP, Quotient, Result, Source};
use kurbo::{Point, Vec2};
use std::cell::Cell;

/// A smooth stretch of a curve, with a parameter from 0 to 1.
pub(crate) struct Part<'a, S> {
    source: &'a S,
    t: [f64; 2],
    /// Ends, at 0 and 1.
    pub(crate) ends: [BreakPoint; 2],
    /// Set if the part does not begin where the part before ends.
    pub(crate) jumps: bool,
    /// Counter of evaluations of the source.
    calls: Option<&'a Cell<usize>>,
}

impl<S> Clone for Part<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Part<'_, S> {}

impl<'a, S> Part<'a, S> {
    /// The stretch between two break points of a source.
    pub(crate) fn between(source: &'a S, [from, to]: [BreakPoint; 2]) -> Self {
        let scaled = |end: BreakPoint, t: f64| BreakPoint { t, speed: end.speed * (to.t - from.t), ..end };
        let ends = [scaled(from, 0.0), scaled(to, 1.0)];
        Self { source, t: [from.t, to.t], ends, jumps: false, calls: None }
    }

    /// The stretch between two break points of this part.
    pub(crate) fn sub_part(&self, [from, to]: [BreakPoint; 2]) -> Self {
        let t = [from.t, to.t].map(|t| self.source_parameter(t));
        Self { t, calls: self.calls, ..Part::between(self.source, [from, to]) }
    }

    fn source_parameter(&self, t: f64) -> f64 {
        let [t0, t1] = self.t;
        if t == 1.0 { t1 } else { t0 + (t1 - t0) * t }
    }

    fn count(&self, evaluations: usize) {
        if let Some(calls) = self.calls {
            calls.set(calls.get() + evaluations);
        }
    }
}

impl<S: Source> Source for Part<'_, S> {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        self.count(1);
        let (p, d) = self.source.eval(self.source_parameter(t));
        (p, d * (self.t[1] - self.t[0]))
    }

    fn points(&self, t: &Lane, out: &mut Lanes) {
        self.count(t.len());
        self.source.points(&t.map(|t| self.source_parameter(t)), out);
    }

    fn is_simple(&self) -> bool {
        self.source.is_simple()
    }

    fn resolved(&self, between: [f64; 2], intervals: usize, tolerance: f64) -> Option<bool> {
        self.source.resolved(between.map(|t| self.source_parameter(t)), intervals, tolerance)
    }

    fn quotient(&self) -> Option<Quotient> {
        // Drop the weights: they are Bernstein coefficients over the whole source.
        self.source.quotient().map(|q| Quotient { weights: None, ..q })
    }

    fn denominators(&self, t: &Lane) -> Lane {
        let t = t.map(|t| self.source_parameter(t));
        // Use the weights of the source, if it has any, which the part's quotient lacks.
        self.source.quotient().map_or_else(|| self.source.denominators(&t), |q| q.denominators(self.source, &t))
    }

    fn place(&self, t: f64) -> Point {
        self.source.place(self.source_parameter(t))
    }

    fn end(&self, t: f64) -> Result<BreakPoint> {
        if t == 0.0 || t == 1.0 {
            return Ok(self.ends[usize::from(t == 1.0)]);
        }
        self.count(2); // The source is also evaluated aside, to see if its derivative vanishes.
        let end = self.source.end(self.source_parameter(t))?;
        Ok(BreakPoint { t, speed: end.speed * (self.t[1] - self.t[0]), ..end })
    }

    fn announce<'s>(points: &mut dyn Iterator<Item = (&'s Self, Lane)>, ends: &mut dyn Iterator<Item = (&'s Self, f64)>)
    where
        Self: 's,
    {
        let mut points = points.map(|(part, t)| (part.source, t.map(|t| part.source_parameter(t))));
        let mut ends =
            ends.filter(|(_, t)| *t != 0.0 && *t != 1.0).map(|(part, t)| (part.source, part.source_parameter(t)));
        S::announce(&mut points, &mut ends);
    }
}

/// The parts between the breaks of a source. Each counts its evaluations in `calls`.
pub(crate) fn parts<'a, S: Source>(source: &'a S, tolerance: f64, calls: &'a Cell<usize>) -> Result<Vec<Part<'a, S>>> {
    let mut ends = source.breaks();
    ends.retain(|t| *t > 0.0 && *t < 1.0);
    ends.push(1.0);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let is_broken = ends.len() > 1; // Then all tangents are taken inside the parts, at the outer ends, too.
    let mut out: Vec<Part<'_, S>> = Vec::with_capacity(ends.len());
    let mut t0 = 0.0;
    for t1 in ends {
        let [mut from, to] = if is_broken {
            [one_sided_end(source, t0, 1.0)?, one_sided_end(source, t1, -1.0)?]
        } else {
            [source.end(t0)?, source.end(t1)?]
        };
        let mut jumps = false;
        if let Some(last) = out.last() {
            jumps = last.ends[1].p.distance(from.p) > JUMP * tolerance;
            if !jumps {
                from.p = last.ends[1].p;
            }
        }
        out.push(Part { jumps, calls: Some(calls), ..Part::between(source, [from, to]) });
        t0 = t1;
    }
    Ok(out)
}

/// The end of a smooth part at `t`, with the tangent and the speed a little further inside: after `t` if `side` is 1, before it if −1.
fn one_sided_end<S: Source>(source: &S, t: f64, side: f64) -> Result<BreakPoint> {
    // Where the curve jumps, take the limit from the left.
    let (p, _) = source.eval(if side < 0.0 && t < 1.0 { t.next_down() } else { t });
    let near = source.end(t + side * ONE_SIDED_STEP)?;
    let along = if side > 0.0 { near.away } else { near.into };
    if !p.is_finite() {
        return Err(NotFinite { t, at: source.place(t) });
    }
    Ok(BreakPoint { t, p, speed: near.speed, into: along, away: along })
}
