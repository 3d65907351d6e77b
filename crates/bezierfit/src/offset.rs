//! Curves beside a curve.

use crate::error::Error;
use crate::options::Options;
use crate::path::{Fitted, Segment, fit};
use crate::report::Report;
use crate::source::Source;
use kurbo::{BezPath, Join, PathEl, PathSeg, Point, Vec2};

/// The path at a distance from another: to its left where y points up, to its right where y points down; on the other side if the
/// distance is negative.
///
/// # Errors
/// The path has coordinates that are not finite.
pub fn offset(path: &BezPath, distance: f64, _join: Join, options: &Options) -> Result<Fitted, Error> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    for segment in path.segments() {
        let side = fit(&Offset::new(segment, distance), options)?;
        let skip = usize::from(!out.path.is_empty());
        let linked = side.path.elements().iter().skip(skip).copied();
        if let (1, Some(PathEl::MoveTo(p))) = (skip, side.path.elements().first()) {
            out.path.line_to(*p);
        }
        out.path.extend(linked);
        out.report.add(side.report);
    }
    Ok(out)
}

/// The curve at a distance from a segment: to its left where y points up, to its right where y points down; on the other side if the
/// distance is negative.
///
/// It has cusps where the segment's radius of curvature is the distance, at which a fit breaks it.
#[derive(Debug, Clone, Copy)]
pub struct Offset {
    segment: Segment,
    distance: f64,
}

/// Samples between which the curvature reaches that of the distance once at most.
const SAMPLES: usize = 64;

impl Offset {
    /// Beside a segment of a path.
    #[must_use]
    pub fn new(segment: PathSeg, distance: f64) -> Self {
        Self { segment: Segment::new(segment), distance }
    }

    /// The derivatives of the segment, a little inside if it stops at its end.
    fn derivatives(&self, t: f64) -> [Vec2; 2] {
        let [first, second] = self.segment.derivatives(t);
        if first.hypot() > 1e-9 * second.hypot() {
            return [first, second];
        }
        self.segment.derivatives(if t < 0.5 { t + 1e-7 } else { t - 1e-7 })
    }

    /// Zero where the curve has a cusp.
    fn stop(&self, t: f64) -> f64 {
        let [first, second] = self.derivatives(t);
        first.hypot().powi(3) - self.distance * first.cross(second)
    }
}

impl Source for Offset {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let [first, _] = self.derivatives(t);
        let speed = first.hypot();
        let normal = Vec2::new(-first.y, first.x) / speed;
        (self.segment.eval(t).0 + normal * self.distance, first * (self.stop(t) / speed.powi(3)))
    }

    fn breaks(&self) -> Vec<f64> {
        let mut out = Vec::new();
        let at = |i: usize| i as f64 / SAMPLES as f64;
        for i in 0..SAMPLES {
            let (mut a, mut b) = (at(i), at(i + 1));
            let before = self.stop(a);
            if before * self.stop(b) >= 0.0 {
                continue;
            }
            for _ in 0..60 {
                let mid = 0.5 * (a + b);
                *if before * self.stop(mid) > 0.0 { &mut a } else { &mut b } = mid;
            }
            out.push(b);
        }
        out.extend(self.segment.slow_spots().all());
        out
    }
}
