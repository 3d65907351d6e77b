//! Runs of segments in a row as one curve, known by samples at even parameters of each segment, and cubics over stretches of a run.
//!
//! Samples are numbered from the start of the run, and so are *grid points* (`k`), at which pieces may end: some of the samples, among them
//! both ends of every segment. The run's parameter is the length of the polygon through the samples. A cubic is fitted like one over a
//! single segment, to the samples nearest to seventeenths of its stretch, or to points interpolated between samples that are too coarse.

use crate::fit::{BestFit, ChordFrame, Fit, FitState, Fitting, THOROUGH, best_fit, fit, settled, size};
use crate::limits::{COARSE, EVEN_CURVATURE, LONG_EDGE, MERGE_GRID, OPAQUE_SAMPLES, PEAK_NEAR, RATIONAL_SAMPLES};
use crate::report::{Assurance, Piece};
use crate::sample::{
    CHECKED, FITTED, IN_ORDER, InOrder, Lane, Lanes, UNIT, interleaved, larger, largest, parabola_extreme,
};
use crate::source::{BreakPoint, NotFinite, Quotient, Result, SlowSpots, Source, images};
use crate::stretch::{STRAIGHT_TURN, straight};
use kurbo::{CubicBez, Line, Point, Vec2};

/// Kind of a segment, by its form in the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A curve in the drawing.
    Curve,
    /// A line in the drawing that a map has bent.
    Bent,
    /// A line that is still straight. No curve covers a part of it.
    Straight,
}

/// One segment of a run.
#[derive(Clone)]
pub struct RunSegment<S> {
    pub(crate) source: S,
    /// Set if proofs are wanted.
    pub(crate) form: Option<Quotient>,
    /// First point.
    pub from: BreakPoint,
    /// Last point.
    pub to: BreakPoint,
    kind: Kind,
    /// Curvature at both ends.
    curvature: [Curvature; 2],
    /// Set if the segment begins at a node of the source's structure (`is_structure`), which placed nodes repeat.
    pub kept: bool,
    /// Slow spots. Only a segment that is the whole run may have any.
    pub slow: SlowSpots,
}

/// A curvature and its uncertainty.
#[derive(Debug, Clone, Copy, Default)]
struct Curvature {
    value: f64,
    uncertainty: f64,
}

impl Curvature {
    /// Estimates the curvature at `p` with unit tangent `t` from the next two samples `q` and `r`, at single and double distance:
    /// chords give 2·(t × d)/|d|², with an error of first order in the distance, which extrapolation removes.
    fn new(t: Vec2, p: Point, [q, r]: [Point; 2]) -> Self {
        let chord = |d: Vec2| 2.0 * t.cross(d) / d.hypot2();
        let (near, far) = (chord(q - p), chord(r - p));
        Self { value: 2.0 * near - far, uncertainty: (near - far).abs() }
    }
}

impl<S> RunSegment<S> {
    /// Makes a segment without slow spots. `form` is given if proofs are wanted.
    pub fn new(source: S, form: Option<Quotient>, [from, to]: [BreakPoint; 2], is_line: bool) -> Self {
        let kind = if is_line { Kind::Straight } else { Kind::Curve };
        let (curvature, slow) = ([Curvature::default(); 2], SlowSpots::default());
        Self { source, form, from, to, kind, curvature, kept: false, slow }
    }

    /// Marks the segment as a line that a map has bent.
    #[must_use]
    pub fn bent(self) -> Self {
        Self { kind: Kind::Bent, ..self }
    }

    /// The segment with another source, form and ends.
    pub(crate) fn with_source<T>(
        &self,
        source: T,
        form: Option<Quotient>,
        [from, to]: [BreakPoint; 2],
    ) -> RunSegment<T> {
        let Self { kind, curvature, kept, slow, .. } = *self;
        RunSegment { source, form, from, to, kind, curvature, kept, slow }
    }

    /// Returns `true` if proofs are wanted and possible.
    pub fn is_provable(&self) -> bool {
        self.form.is_some()
    }

    /// Returns `true` if no piece runs from this segment into the next: at corners, and where a straight edge ends. Short chords in a row
    /// are a flattened curve, so lines go on into lines unless one of them is much longer.
    fn is_parted_from(&self, next: &Self, corner: f64) -> bool {
        let turn = self.to.into.cross(next.from.away).atan2(self.to.into.dot(next.from.away)).abs();
        let edge = match (self.kind, next.kind) {
            (Kind::Straight, Kind::Curve) | (Kind::Curve, Kind::Straight) => true,
            (Kind::Straight, Kind::Straight) if turn > STRAIGHT_TURN => {
                let [a, b] = [self, next].map(|s| s.from.p.distance(s.to.p));
                a.max(b) > LONG_EDGE * a.min(b)
            }
            _ => false,
        };
        edge || turn > corner || self.form.is_some() != next.form.is_some()
    }
}

/// Smoothly joined segments as one curve. Samples lie at even parameters of each segment. The last sample of one segment is the first
/// of the next.
pub struct SegmentRun<S> {
    /// The segments.
    pub segments: Vec<RunSegment<S>>,
    /// Intervals between samples of a segment.
    pub(crate) per_segment: usize,
    /// Grid points per segment, at which pieces may end.
    pub(crate) grid: usize,
    /// Images of the samples.
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// Length of the polygon through the samples, up to each.
    pub(crate) length: Vec<f64>,
}

impl<S: Source> SegmentRun<S> {
    /// Makes an empty run, of [simple](Source::is_simple) curves or of any others.
    pub fn new(simple: bool, capacity: usize) -> Self {
        let per_segment = per_segment(simple);
        let samples = || Vec::with_capacity(capacity * per_segment + 1);
        let (segments, grid) = (Vec::with_capacity(capacity), MERGE_GRID);
        Self { segments, per_segment, grid, x: samples(), y: samples(), length: samples() }
    }

    /// Samples a segment and appends it. Returns `false` if consecutive samples coincide: a stretch without length has no direction.
    pub fn push(&mut self, segment: RunSegment<S>) -> Result<bool> {
        self.push_sampled(segment, None)
    }

    /// Appends a segment by [`push`](Self::push), or by its `samples` if they are known.
    pub(crate) fn push_sampled(&mut self, mut segment: RunSegment<S>, samples: Option<[&[f64]; 2]>) -> Result<bool> {
        let n = self.per_segment;
        if self.x.is_empty() {
            self.x.push(segment.from.p.x);
            self.y.push(segment.from.p.y);
            self.length.push(0.0);
        }
        let start = self.x.len() - 1;
        if let Some([x, y]) = samples {
            self.x.extend(x);
            self.y.extend(y);
        } else {
            for t in sample_lanes(n) {
                let g = images(&segment.source, &t)?;
                self.x.extend(g.x);
                self.y.extend(g.y);
            }
        }
        let mut moves = true;
        for k in start..start + n {
            let (dx, dy) = (self.x[k + 1] - self.x[k], self.y[k + 1] - self.y[k]);
            let step = (dx * dx + dy * dy).sqrt();
            moves &= step > 0.0;
            self.length.push(self.length[k] + step);
        }
        if !moves {
            for samples in [&mut self.x, &mut self.y, &mut self.length] {
                samples.truncate(start + 1);
            }
            return Ok(false);
        }
        let at = |i: usize| Point::new(self.x[start + i], self.y[start + i]);
        let first = Curvature::new(segment.from.away, at(0), [at(1), at(2)]);
        let last = Curvature::new(-segment.to.into, at(n), [at(n - 1), at(n - 2)]);
        // Seen backwards, a curve bends to the other side.
        segment.curvature = [first, Curvature { value: -last.value, ..last }];
        self.segments.push(segment);
        Ok(true)
    }

    /// Samples of segment `i` except the first.
    pub(crate) fn samples_of(&self, i: usize) -> [&[f64]; 2] {
        let range = i * self.per_segment + 1..=(i + 1) * self.per_segment;
        [&self.x[range.clone()], &self.y[range]]
    }

    /// Returns `true` if the run ends at its start, and pieces may run on there.
    pub fn closes(&self, corner: f64) -> bool {
        let ends = [self.segments.last(), self.segments.first()];
        matches!(ends, [Some(last), Some(first)] if last.to.p == first.from.p && !last.is_parted_from(first, corner))
    }

    /// Appends the first of `items` as long as `segment` makes segments of them that join with turns of at most `corner` radians.
    /// Returns their number.
    ///
    /// # Errors
    /// [`NotFinite`] if a segment is not finite.
    pub fn extend<'t, T>(
        &mut self,
        items: &'t [T],
        corner: f64,
        mut segment: impl FnMut(&'t T) -> Result<Option<RunSegment<S>>>,
    ) -> Result<usize> {
        for (i, item) in items.iter().enumerate() {
            let Some(next) = segment(item)? else { return Ok(i) };
            let parts = self.segments.last().is_some_and(|last| last.is_parted_from(&next, corner));
            if parts || !self.push(next)? {
                return Ok(i);
            }
        }
        Ok(items.len())
    }

    /// Assurance of the checked error of pieces of this run.
    pub fn assurance(&self, tolerance: f64) -> Assurance {
        let cannot_tell = |s: &RunSegment<S>| s.source.resolved([0.0, 1.0], self.per_segment, tolerance).is_none();
        match self.segments.first() {
            Some(s) if s.is_provable() => Assurance::Certified,
            Some(s) if cannot_tell(s) => Assurance::Sampled,
            _ => Assurance::Checked,
        }
    }

    /// Number of the last grid point.
    pub(crate) fn last_grid_point(&self) -> usize {
        self.grid * self.segments.len()
    }

    /// A copy with `by` times as many samples and grid points, for one curve with more nodes than it needs. `None` if its curvature jumps
    /// or there are fewer than six segments.
    pub(crate) fn finer(&self, by: usize) -> Result<Option<Self>>
    where
        S: Clone,
    {
        let joints = self.segments.windows(2);
        let even = |w: &[RunSegment<S>]| {
            let (a, b) = (w[0].curvature[1].value, w[1].curvature[0].value);
            (a - b).abs() <= EVEN_CURVATURE * a.abs().max(b.abs())
        };
        if self.segments.len() < 6 || !joints.clone().all(even) {
            return Ok(None);
        }
        let mut out = Self::new(true, 0);
        (out.per_segment, out.grid) = (by * self.per_segment, by * self.grid);
        for segment in &self.segments {
            if !out.push(segment.clone())? {
                return Ok(None);
            }
        }
        Ok(Some(out))
    }

    /// Index of the sample at grid point `k`.
    pub(crate) fn sample_at(&self, k: usize) -> usize {
        k * (self.per_segment / self.grid)
    }

    /// Length up to grid point `k`.
    pub(crate) fn length_at(&self, k: usize) -> f64 {
        self.length[self.sample_at(k)]
    }

    /// The break point at grid point `k`, with the length as its parameter.
    pub(crate) fn end_at(&self, k: usize) -> Result<BreakPoint> {
        let (i, part) = (k / self.grid, k % self.grid);
        let end = match (self.segments.get(i), i.checked_sub(1).and_then(|i| self.segments.get(i))) {
            (Some(segment), _) if part > 0 => segment.source.end(part as f64 / self.grid as f64)?,
            // A joint has the tangents of both its segments.
            (Some(after), Some(before)) => BreakPoint { into: before.to.into, ..after.from },
            (Some(after), None) => after.from,
            (None, Some(before)) => before.to,
            (None, None) => return Err(NotFinite { t: 0.0, at: Point::ORIGIN }),
        };
        Ok(BreakPoint { t: self.length_at(k), speed: 1.0, ..end })
    }

    /// The last grid point between two at which the length is at most `length`; the first of them if there is none.
    pub(crate) fn grid_point_before(&self, length: f64, [first, last]: [usize; 2]) -> usize {
        let step = self.per_segment / self.grid;
        let (mut low, mut high) = (first, last.max(first) + 1);
        // Search with doubled strides, as it is usually near the start.
        let mut stride = 1;
        while low + stride < high && self.length[(low + stride) * step] <= length {
            low += stride;
            stride *= 2;
        }
        high = high.min(low + stride);
        while low + 1 < high {
            let mid = low.midpoint(high);
            *if self.length[mid * step] <= length { &mut low } else { &mut high } = mid;
        }
        low
    }

    /// Length of the shorter segment beside the start of segment `j`.
    pub(crate) fn shorter_beside(&self, j: usize) -> f64 {
        let length = |i: usize| self.length[(i + 1) * self.per_segment] - self.length[i * self.per_segment];
        if j == 0 || j >= self.segments.len() { f64::INFINITY } else { length(j - 1).min(length(j)) }
    }

    /// Jump of the curvature at the start of segment `j`, as far as it is certain; 0 at the ends of the run.
    pub(crate) fn curvature_jump(&self, j: usize) -> f64 {
        let before = j.checked_sub(1).and_then(|i| self.segments.get(i));
        let (Some(before), Some(after)) = (before, self.segments.get(j)) else { return 0.0 };
        let (a, b) = (before.curvature[1], after.curvature[0]);
        ((a.value - b.value).abs() - a.uncertainty - b.uncertainty).max(0.0)
    }

    /// Interpolates points at shares of the length between two samples, by polynomials of degree five through six samples of one segment.
    pub(crate) fn interpolate(&self, [first, last]: [usize; 2], shares: &InOrder, [x, y]: [&mut InOrder; 2]) {
        let (start, length) = (self.length[first], self.length[last] - self.length[first]);
        let n = self.per_segment;
        let mut k = first;
        for j in 1..shares.len() - 1 {
            let wanted = start + length * shares[j];
            k += self.length[k + 1..last].partition_point(|l| *l <= wanted);
            let part = (wanted - self.length[k]) / (self.length[k + 1] - self.length[k]);
            // First of the six samples: two before sample `k`, but all in its segment.
            let base = k - k % n + (k % n).saturating_sub(2).min(n - 5);
            let w = lagrange((k - base) as f64 + part);
            (x[j], y[j]) = (0.0, 0.0);
            for (i, w) in w.into_iter().enumerate() {
                x[j] += w * self.x[base + i];
                y[j] += w * self.y[base + i];
            }
        }
    }

    /// Images at eight parameters of segment `i`.
    pub(crate) fn images(&self, i: usize, t: &Lane) -> Result<Lanes> {
        self.segments.get(i).map_or(Ok(Lanes::default()), |s| images(&s.source, t))
    }
}

/// Number of samples of a segment.
pub fn per_segment(simple: bool) -> usize {
    if simple { RATIONAL_SAMPLES } else { OPAQUE_SAMPLES }
}

/// Parameters of a segment's samples.
pub fn sample_lanes(per_segment: usize) -> impl Iterator<Item = Lane> + Clone {
    let n = per_segment;
    (0..n / 8).map(move |batch| std::array::from_fn(|i| (8 * batch + i + 1) as f64 / n as f64))
}

/// Lagrange's weights, with which the values at 0, 1, …, 5 give the value at `u`.
fn lagrange(u: f64) -> [f64; 6] {
    const SCALE: [f64; 6] = [-1.0 / 120.0, 1.0 / 24.0, -1.0 / 12.0, 1.0 / 12.0, -1.0 / 24.0, 1.0 / 120.0];
    let mut w = SCALE;
    let mut below = 1.0;
    for (i, w) in w.iter_mut().enumerate() {
        *w *= below;
        below *= u - i as f64;
    }
    let mut above = 1.0;
    for (i, w) in w.iter_mut().enumerate().rev() {
        *w *= above;
        above *= u - i as f64;
    }
    w
}

/// A cubic over a stretch of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RunCubic {
    pub(crate) frame: ChordFrame,
    /// First and last point.
    pub(crate) ends: [Point; 2],
    /// Lengths of the first and the last handle.
    pub(crate) a: f64,
    pub(crate) b: f64,
    /// Set if the image is a line to rounding.
    is_line: bool,
    /// Numbers of the run's samples at the ends.
    pub(crate) samples: [usize; 2],
    /// Lengths up to the sixteen samples and the ends, as shares of the whole, and their foot points.
    pub(crate) shares: InOrder,
    pub(crate) feet: InOrder,
}

impl RunCubic {
    pub(crate) fn piece(&self) -> Piece {
        let [p, q] = self.ends;
        if self.is_line { Piece::Line(Line::new(p, q)) } else { Piece::Cubic(self.cubic()) }
    }

    pub(crate) fn cubic(&self) -> CubicBez {
        self.frame.cubic(self.ends[0], self.ends[1], self.a, self.b)
    }
}

/// The best cubic found for a stretch.
pub(crate) struct Trial {
    /// Error at the samples; above the tolerance, an estimate of the least possible error.
    pub(crate) error: f64,
    /// Set if the error is within the tolerance.
    pub(crate) cubic: Option<RunCubic>,
}

/// A stretch of a run with its sixteen samples, relative to its first point.
pub(crate) struct Stretch {
    pub(crate) tolerance: f64,
    /// Set if the fit must be the same from either end.
    evenly: bool,
    ends: [BreakPoint; 2],
    samples: [usize; 2],
    frame: ChordFrame,
    fitted_samples: Lanes,
    checked_samples: Lanes,
    shares: InOrder,
}

impl Stretch {
    /// Picks the run's samples nearest to seventeenths of the length between two samples, or interpolates if these are too coarse.
    pub(crate) fn new(
        run: &SegmentRun<impl Source>,
        ends: [BreakPoint; 2],
        samples: [usize; 2],
        (tolerance, evenly): (f64, bool),
    ) -> Self {
        let [from, to] = ends;
        let ([first, last], length) = (samples, to.t - from.t);
        let mut shares = [0.0; IN_ORDER];
        let (mut x, mut y) = ([0.0; IN_ORDER], [0.0; IN_ORDER]);
        let inner = first + 1..last;
        let (lengths, xs, ys) = (&run.length[inner.clone()], &run.x[inner.clone()], &run.y[inner]);
        let scale = 1.0 / length;
        let (mut i, mut furthest_off) = (0, 0.0);
        for j in 1..IN_ORDER - 1 {
            let share = UNIT * j as f64;
            let twice = 2.0 * (from.t + length * share);
            i = nearest(lengths, i, twice);
            shares[j] = (lengths[i] - from.t) * scale;
            (x[j], y[j]) = (xs[i] - from.p.x, ys[i] - from.p.y);
            furthest_off = larger(furthest_off, (shares[j] - share).abs());
        }
        shares[IN_ORDER - 1] = 1.0;
        if furthest_off > COARSE * UNIT {
            for j in 1..IN_ORDER - 1 {
                shares[j] = UNIT * j as f64;
            }
            run.interpolate(samples, &shares, [&mut x, &mut y]);
            for j in 1..IN_ORDER - 1 {
                (x[j], y[j]) = (x[j] - from.p.x, y[j] - from.p.y);
            }
        }
        let fitted_samples = Lanes { x: picked(&x, &FITTED), y: picked(&y, &FITTED) };
        let checked_samples = Lanes { x: picked(&x, &CHECKED), y: picked(&y, &CHECKED) };
        let q = to.p - from.p;
        let size = size(q, &fitted_samples, evenly);
        let third = length * (1.0 / 3.0);
        let frame = ChordFrame::new(q, [from.away, to.into], size, [third; 2], tolerance);
        Self { tolerance, evenly, ends, samples, frame, fitted_samples, checked_samples, shares }
    }

    /// Fits a cubic: by least squares, and by further methods as long as the error is above the tolerance.
    pub(crate) fn fitted(mut self) -> Result<Trial> {
        let [from, to] = &self.ends;
        if let Some((line, error)) = straight(&self.fitted_samples, [from, to], self.frame.size, self.tolerance) {
            let third = line.p0.distance(line.p1) / 3.0;
            return Ok(Trial { error, cubic: Some(self.run_cubic([third; 2], self.shares, true)) });
        }
        let [a, b] = self.frame.home;
        let mut start = FitState { a, b, s: picked(&self.shares, &FITTED) };
        self.frame.settle(&self.fitted_samples, a, b, &mut start.s);
        let tolerance = self.tolerance;
        let best = best_fit(&mut self, &THOROUGH, start, tolerance)?;
        Ok(self.trial(&best))
    }

    /// Fits a cubic with the least error that can be reached, starting from `from`.
    pub(crate) fn fitted_closely(mut self, from: &RunCubic) -> Result<Trial> {
        let (state, tolerance) = (FitState { a: from.a, b: from.b, s: picked(&from.feet, &FITTED) }, self.tolerance);
        let fit = fit(&THOROUGH, &self.frame, &self.fitted_samples, state, [0.0, tolerance]);
        let mut best = BestFit::judged(fit, &mut self, tolerance)?;
        best.minimise(&mut self, [0.0, tolerance])?;
        Ok(self.trial(&best))
    }

    fn trial(&self, best: &BestFit<InOrder>) -> Trial {
        let BestFit { fit, error, mark } = best;
        let fits = *error <= self.tolerance;
        Trial { error: *error, cubic: fits.then(|| self.run_cubic([fit.state.a, fit.state.b], *mark, false)) }
    }

    /// Returns `true` if a handle of a curve that turns one way extends beyond the crossing of both handles.
    fn crosses(&self, a: f64, b: f64) -> bool {
        let [from, to] = &self.ends;
        let (u, v, q) = (from.away, to.into, to.p - from.p);
        let turn = u.cross(v);
        let [most_a, most_b] = [q.cross(v) / turn, u.cross(q) / turn];
        most_a > 0.0 && most_b > 0.0 && (a > CROSSING * most_a || b > CROSSING * most_b)
    }

    fn run_cubic(&self, [a, b]: [f64; 2], feet: InOrder, is_line: bool) -> RunCubic {
        let ends = [self.ends[0].p, self.ends[1].p];
        RunCubic { frame: self.frame, ends, a, b, is_line, samples: self.samples, shares: self.shares, feet }
    }
}

impl Fitting for Stretch {
    /// Foot points of all samples.
    type Mark = InOrder;

    fn samples(&self) -> (&ChordFrame, &Lanes) {
        (&self.frame, &self.fitted_samples)
    }

    fn checked(&mut self) -> Result<Lanes> {
        Ok(self.checked_samples)
    }

    fn evenly(&self) -> bool {
        self.evenly
    }

    /// Foot points of the checked samples between those of the fitted ones.
    fn feet_between(&self, s: &Lane) -> Lane {
        let (fitted, checked) = (picked(&self.shares, &FITTED), picked(&self.shares, &CHECKED));
        let mut out = [0.0; 8];
        for i in 0..8 {
            // Two checked samples lie in the gap between the fitted samples 3 and 4, and one in every other gap.
            let before = [0, 1, 2, 3, 3, 4, 5, 6][i];
            let (step, rest) = (fitted[before + 1] - fitted[before], checked[i] - fitted[before]);
            out[i] = s[before] + if step > 0.0 { (s[before + 1] - s[before]) * (rest / step) } else { 0.0 };
        }
        out
    }

    fn judge(&mut self, fit: &Fit) -> Result<(f64, InOrder)> {
        let (state, fitted) = (&fit.state, settled(&self.frame, &self.fitted_samples, fit, self.tolerance));
        let mut s = self.feet_between(&fitted.s);
        let squares = self.frame.distances(&self.checked_samples, state.a, state.b, &mut s, 1);
        let mut error = larger(fitted.error, largest(&squares).sqrt());
        if error <= self.tolerance {
            let e0 = self.frame.signed_distances(&self.fitted_samples, state.a, state.b, &fitted.s, &fitted.squares);
            let e1 = self.frame.signed_distances(&self.checked_samples, state.a, state.b, &s, &squares);
            error = highest_parabola(&interleaved(&e0, &e1, 0.0), error);
        }
        // Between placed nodes, where fits are even, handles end at their crossing.
        if self.evenly && self.crosses(state.a, state.b) {
            error = larger(error, MISSED * self.tolerance);
        }
        Ok((error, interleaved(&fitted.s, &s, 1.0)))
    }
}

/// Index of the length nearest to half of `twice`, at or after `from`.
#[inline(always)]
fn nearest(lengths: &[f64], from: usize, twice: f64) -> usize {
    let is_before = |i: usize| i + 1 < lengths.len() && lengths[i] + lengths[i + 1] < twice;
    let (mut low, mut stride) = (from, 1);
    if !is_before(low) {
        return low;
    }
    // The index is after `low`, up to `low + stride`.
    while is_before(low + stride) {
        low += stride;
        stride *= 2;
    }
    while stride > 1 {
        stride /= 2;
        if is_before(low + stride) {
            low += stride;
        }
    }
    low + 1
}

/// Height of the highest parabola through three neighbours whose middle one is an extreme, and nearly as far from zero as `most`.
fn highest_parabola(errors: &InOrder, most: f64) -> f64 {
    let is_top = |w: &[f64]| {
        let side = 1.0f64.copysign(w[1]);
        w[1].abs() >= PEAK_NEAR * most && w[1] * side >= w[0] * side && w[1] * side >= w[2] * side
    };
    errors.windows(3).filter(|w| is_top(w)).map(|w| parabola_extreme([w[0], w[1], w[2]])).fold(most, larger)
}

/// Values at the fitted or the checked samples.
#[inline(always)]
fn picked(v: &InOrder, set: &Lane) -> Lane {
    let mut out = [0.0; 8];
    for i in 0..8 {
        out[i] = v[set[i] as usize];
    }
    out
}

/// Factor by which a handle may extend beyond the crossing of both, so that rounding does not reject a cubic.
const CROSSING: f64 = 1.01;
/// Error ÷ tolerance that is recorded for a cubic whose handles cross: a near miss.
const MISSED: f64 = 1.05;

#[cfg(test)]
mod tests {
    use super::lagrange;

    #[test]
    fn polynomials_of_degree_five_are_reproduced() {
        let f = |u: f64| ((((0.3 * u - 1.0) * u + 2.0) * u - 0.7) * u + 1.5) * u - 4.0;
        for u in [-0.2, 0.0, 0.4, 1.0, 2.5, 4.9, 5.0] {
            let sum: f64 = lagrange(u).iter().enumerate().map(|(i, w)| w * f(i as f64)).sum();
            assert!((sum - f(u)).abs() < 1e-12, "{u}: {sum}");
        }
    }
}
