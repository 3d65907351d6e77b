//! The interface that a curve must have to be fitted.

use super::lanes::{Lane, Lanes};
use super::source::{BreakPoint, SourceCurve};
use kurbo::{Point, Vec2};

/// Parameters of the samples of a smooth part.
pub(super) type PartSamples = Vec<Lane>;

/// A curve that can be fitted: the image of one segment, or of several in a row.
pub(super) trait ImageCurve {
    /// Writes the images at eight parameters. `Err`: the source point at which the map is not finite.
    fn images_into(&self, t: &Lane, out: &mut Lanes) -> Result<(), Point>;

    /// Returns the images at eight parameters. `Err`: the source point at which the map is not finite.
    #[inline(always)]
    fn images(&self, t: &Lane) -> Result<Lanes, Point> {
        let mut out = Lanes::default();
        self.images_into(t, &mut out)?;
        Ok(out)
    }

    /// The image's point and derivative at one parameter.
    fn image(&self, t: f64) -> (Point, Vec2);

    /// The break point at `t`. `Err`: the source point, if the map is not finite there.
    fn end(&self, t: f64) -> Result<BreakPoint, Point>;

    /// If the curve consists of several segments: for each of its smooth parts between t0 and t1, samples evenly spaced in the
    /// segment's parameter, the last one at the part's end.
    fn parts(&self, _t0: f64, _t1: f64) -> Option<Vec<PartSamples>> {
        None
    }

    /// The source's point at `t`, for messages.
    fn at(&self, t: f64) -> Point;

    /// The curve as the image of a single segment, which proofs need.
    fn single(&self) -> Option<&SourceCurve<'_>>;
}

impl ImageCurve for SourceCurve<'_> {
    #[inline(always)]
    fn images_into(&self, t: &Lane, out: &mut Lanes) -> Result<(), Point> {
        SourceCurve::images_into(self, t, out)
    }

    fn image(&self, t: f64) -> (Point, Vec2) {
        SourceCurve::image(self, t)
    }

    fn end(&self, t: f64) -> Result<BreakPoint, Point> {
        SourceCurve::end(self, t)
    }

    fn at(&self, t: f64) -> Point {
        SourceCurve::at(self, t)
    }

    fn single(&self) -> Option<&SourceCurve<'_>> {
        Some(self)
    }
}
