//! Segments in a row as one curve.

use crate::refit::curve::{ImageCurve, PartSamples};
use crate::refit::lanes::{Lane, Lanes};
use crate::refit::limits::{LENGTH_TABLE, MERGE_GRID, OPAQUE_BATCHES, RATIONAL_BATCHES};
use crate::refit::proof::RationalForm;
use crate::refit::source::{BreakPoint, SourceCurve};
use crate::refit::split;
use kurbo::{Point, Vec2};

/// One segment of a run.
pub(super) struct RunSegment<'a> {
    pub(super) source: SourceCurve<'a>,
    /// Set if proofs are wanted.
    pub(super) form: Option<RationalForm>,
    pub(super) from: BreakPoint,
    pub(super) to: BreakPoint,
    /// Lengths of the image up to i/16 of the parameter.
    table: [f64; LENGTH_TABLE + 1],
    /// Parameter per length in each interval of the table.
    slopes: [f64; LENGTH_TABLE],
    /// The curvature at both ends.
    curvature: [Curvature; 2],
}

/// A curvature and how far it may be off.
#[derive(Debug, Clone, Copy)]
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

impl<'a> RunSegment<'a> {
    /// `None` for a segment that cannot be in a run: one without length or with slow spots.
    pub(super) fn new(source: SourceCurve<'a>, form: Option<RationalForm>) -> Result<Option<Self>, Point> {
        if source.size() == 0.0 || !split::slow_spots(source.seg).all().is_empty() {
            return Ok(None);
        }
        let (from, to) = (source.end(0.0)?, source.end(1.0)?);
        let mut table = [0.0; LENGTH_TABLE + 1];
        let mut images = [from.p; LENGTH_TABLE + 1];
        for half in 0..2 {
            let t: Lane = std::array::from_fn(|i| (8 * half + i + 1) as f64 / LENGTH_TABLE as f64);
            let g = source.images(&t)?;
            for i in 0..8 {
                let p = Point::new(g.x[i], g.y[i]);
                let k = 8 * half + i + 1;
                table[k] = table[k - 1] + (p - images[k - 1]).hypot();
                images[k] = p;
            }
        }
        // A stretch without length has no direction to be merged along.
        let moves = table.windows(2).all(|w| w[1] > w[0]);
        let n = LENGTH_TABLE;
        let first = Curvature::new(from.away, from.p, [images[1], images[2]]);
        let last = Curvature::new(-to.into, images[n], [images[n - 1], images[n - 2]]);
        // Seen backwards, a curve bends to the other side.
        let curvature = [first, Curvature { value: -last.value, ..last }];
        let slopes = std::array::from_fn(|i| 1.0 / ((table[i + 1] - table[i]) * LENGTH_TABLE as f64));
        Ok(moves.then_some(Self { source, form, from, to, table, slopes, curvature }))
    }

    pub(super) fn length(&self) -> f64 {
        self.table[LENGTH_TABLE]
    }

    /// The length up to the segment's parameter `t`: the inverse of [`param`](Self::param).
    fn length_to(&self, t: f64) -> f64 {
        let at = t * LENGTH_TABLE as f64;
        let k = (at as usize).min(LENGTH_TABLE - 1);
        self.table[k] + (self.table[k + 1] - self.table[k]) * (at - k as f64)
    }

    /// The segment's parameter at a length, and its derivative.
    pub(super) fn param(&self, length: f64) -> (f64, f64) {
        // As if the speed were even; then the neighbouring intervals.
        let mut k = ((length / self.length() * LENGTH_TABLE as f64) as usize).min(LENGTH_TABLE - 1);
        while k + 1 < LENGTH_TABLE && self.table[k + 1] <= length {
            k += 1;
        }
        while k > 0 && self.table[k] > length {
            k -= 1;
        }
        let slope = self.slopes[k];
        ((k as f64 / LENGTH_TABLE as f64 + (length - self.table[k]) * slope).clamp(0.0, 1.0), slope)
    }
}

/// Smoothly joined segments as one curve. Its parameter is approximately the length of the image.
pub(super) struct SegmentRun<'a> {
    /// Batches of eight samples that a check takes in each segment.
    batches: usize,
    pub(super) segments: Vec<RunSegment<'a>>,
    /// Parameters at which the segments begin, and the end of the last.
    pub(super) starts: Vec<f64>,
}

impl<'a> SegmentRun<'a> {
    /// A run without segments, under a map that is a quotient of polynomials or any other.
    pub(super) fn new(rational: bool) -> Self {
        let batches = if rational { RATIONAL_BATCHES } else { OPAQUE_BATCHES };
        Self { batches, segments: Vec::new(), starts: Vec::new() }
    }

    pub(super) fn push(&mut self, segment: RunSegment<'a>) {
        let at = self.starts.last().copied().unwrap_or_default();
        if self.starts.is_empty() {
            self.starts.push(0.0);
        }
        self.starts.push(at + segment.length());
        self.segments.push(segment);
    }

    /// Number of grid intervals.
    pub(super) fn grid(&self) -> usize {
        MERGE_GRID * self.segments.len()
    }

    /// The parameter of grid place `k`.
    pub(super) fn place(&self, k: usize) -> f64 {
        let (seg, i) = (k / MERGE_GRID, k % MERGE_GRID);
        if i == 0 {
            self.starts[seg]
        } else {
            self.starts[seg] + self.segments[seg].length() * i as f64 / MERGE_GRID as f64
        }
    }

    /// The break point at grid place `k`.
    pub(super) fn end_at(&self, k: usize) -> Result<BreakPoint, Point> {
        self.end(self.place(k))
    }

    /// The jump of the curvature at the start of segment `j`, as far as it is certain; 0 at the ends of the run.
    pub(super) fn curvature_jump(&self, j: usize) -> f64 {
        let before = j.checked_sub(1).and_then(|i| self.segments.get(i));
        let (Some(before), Some(after)) = (before, self.segments.get(j)) else { return 0.0 };
        let (a, b) = (before.curvature[1], after.curvature[0]);
        ((a.value - b.value).abs() - a.uncertainty - b.uncertainty).max(0.0)
    }

    /// The segment at `u`, and the length from its start.
    fn find(&self, u: f64) -> (&RunSegment<'a>, f64) {
        let last = self.segments.len() - 1;
        let k = self.starts.partition_point(|s| *s <= u).saturating_sub(1).min(last);
        (&self.segments[k], u - self.starts[k])
    }
}

impl ImageCurve for SegmentRun<'_> {
    fn images_into(&self, t: &Lane, out: &mut Lanes) -> Result<(), Point> {
        let last = self.segments.len() - 1;
        let mut k = 0;
        for i in 0..8 {
            // Parameters ascend, except that a batch may begin anywhere.
            while k < last && self.starts[k + 1] <= t[i] {
                k += 1;
            }
            while k > 0 && self.starts[k] > t[i] {
                k -= 1;
            }
            let segment = &self.segments[k];
            let p = segment.source.point(segment.param(t[i] - self.starts[k]).0);
            (out.x[i], out.y[i]) = (p.x, p.y);
        }
        let Some(first) = self.segments.first() else { return Ok(()) };
        first.source.map.lanes(&mut out.x, &mut out.y);
        match (0..8).find(|&i| !(out.x[i] + out.y[i]).is_finite()) {
            Some(i) => Err(self.at(t[i])),
            None => Ok(()),
        }
    }

    fn image(&self, t: f64) -> (Point, Vec2) {
        let (segment, length) = self.find(t);
        let (s, slope) = segment.param(length);
        let (p, d) = segment.source.image(s);
        (p, d * slope)
    }

    fn end(&self, t: f64) -> Result<BreakPoint, Point> {
        let joint = self.starts.iter().position(|s| *s == t);
        let mut end = match joint {
            // A joint has the tangents of both its segments.
            Some(k) => match (k.checked_sub(1).map(|k| &self.segments[k]), self.segments.get(k)) {
                (Some(a), Some(b)) => BreakPoint { into: a.to.into, ..b.from },
                (Some(a), None) => a.to,
                (None, Some(b)) => b.from,
                (None, None) => return Err(Point::ORIGIN),
            },
            None => {
                let (segment, length) = self.find(t);
                segment.source.end(segment.param(length).0)?
            }
        };
        // The parameter is the length.
        (end.t, end.speed) = (t, 1.0);
        Ok(end)
    }

    fn parts(&self, t0: f64, t1: f64) -> Option<Vec<PartSamples>> {
        let ends = self.segments.iter().zip(self.starts.windows(2));
        let inside = ends.filter(|(_, w)| w[1] > t0 && w[0] < t1);
        let samples = inside.map(|(segment, w)| {
            let (start, from, to) = (w[0], t0.max(w[0]), t1.min(w[1]));
            let (s0, s1) = (segment.param(from - start).0, segment.param(to - start).0);
            let n = 8 * self.batches;
            let at = |i: usize| start + segment.length_to(s0 + (s1 - s0) * i as f64 / n as f64);
            let lane = |k: usize| std::array::from_fn(|i| if 8 * k + i + 1 < n { at(8 * k + i + 1) } else { to });
            (0..self.batches).map(lane).collect()
        });
        Some(samples.collect())
    }

    fn at(&self, t: f64) -> Point {
        let (segment, length) = self.find(t);
        segment.source.at(segment.param(length).0)
    }

    fn single(&self) -> Option<&SourceCurve<'_>> {
        None
    }
}
