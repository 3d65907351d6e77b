//! Segments in a row as one curve.

use crate::refit::curve::ImageCurve;
use crate::refit::lanes::{Lane, Lanes};
use crate::refit::limits::{LENGTH_TABLE, MERGE_GRID, PLACES_PER_SEGMENT};
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
}

impl<'a> RunSegment<'a> {
    /// `None` for a segment that cannot be in a run: one without length or with slow spots.
    pub(super) fn new(source: SourceCurve<'a>, form: Option<RationalForm>) -> Result<Option<Self>, Point> {
        if source.size() == 0.0 || !split::slow_spots(source.seg).all().is_empty() {
            return Ok(None);
        }
        let (from, to) = (source.end(0.0)?, source.end(1.0)?);
        let mut table = [0.0; LENGTH_TABLE + 1];
        let mut last = from.p;
        for half in 0..2 {
            let t: Lane = std::array::from_fn(|i| (8 * half + i + 1) as f64 / LENGTH_TABLE as f64);
            let g = source.images(&t)?;
            for i in 0..8 {
                let p = Point::new(g.x[i], g.y[i]);
                let k = 8 * half + i + 1;
                table[k] = table[k - 1] + (p - last).hypot();
                last = p;
            }
        }
        // A stretch without length has no direction to be merged along.
        let moves = table.windows(2).all(|w| w[1] > w[0]);
        Ok(moves.then_some(Self { source, form, from, to, table }))
    }

    pub(super) fn length(&self) -> f64 {
        self.table[LENGTH_TABLE]
    }

    /// The segment's parameter at a length, and its derivative.
    pub(super) fn param(&self, length: f64) -> (f64, f64) {
        let k = self.table.partition_point(|l| *l <= length).clamp(1, LENGTH_TABLE);
        let (a, b) = (self.table[k - 1], self.table[k]);
        let slope = 1.0 / ((b - a) * LENGTH_TABLE as f64);
        (((k - 1) as f64 / LENGTH_TABLE as f64 + (length - a) * slope).clamp(0.0, 1.0), slope)
    }
}

/// Smoothly joined segments as one curve. Its parameter is approximately the length of the image.
#[derive(Default)]
pub(super) struct SegmentRun<'a> {
    pub(super) segments: Vec<RunSegment<'a>>,
    /// Parameters at which the segments begin, and the end of the last.
    pub(super) starts: Vec<f64>,
}

impl<'a> SegmentRun<'a> {
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

    /// The segment at `u`, and the length from its start.
    fn find(&self, u: f64) -> (&RunSegment<'a>, f64) {
        let last = self.segments.len() - 1;
        let k = self.starts.partition_point(|s| *s <= u).saturating_sub(1).min(last);
        (&self.segments[k], u - self.starts[k])
    }
}

impl ImageCurve for SegmentRun<'_> {
    fn images_into(&self, t: &Lane, out: &mut Lanes) -> Result<(), Point> {
        for i in 0..8 {
            let p = self.at(t[i]);
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

    /// Places spread evenly over each segment: short segments between long ones would fall between even samples of the run.
    fn places(&self, t0: f64, t1: f64) -> Vec<f64> {
        let mut out = Vec::new();
        for (segment, start) in self.segments.iter().zip(&self.starts) {
            let spread =
                (0..PLACES_PER_SEGMENT).map(|i| start + segment.length() * i as f64 / PLACES_PER_SEGMENT as f64);
            out.extend(spread.filter(|u| *u > t0 && *u < t1));
        }
        out
    }

    fn at(&self, t: f64) -> Point {
        let (segment, length) = self.find(t);
        segment.source.at(segment.param(length).0)
    }

    fn single(&self) -> Option<&SourceCurve<'_>> {
        None
    }
}
