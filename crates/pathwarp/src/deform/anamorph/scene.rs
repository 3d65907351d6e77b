//! The artwork at its apparent size, and the eye.

use crate::decimal::trimmed;
use crate::map::Map;
use crate::outline::Outline;
use crate::param::Frame;
use crate::refit;
use kurbo::{Affine, BezPath, Point, Rect};

/// The artwork at its apparent size, and the eye.
pub(super) struct Scene {
    /// The artwork's box.
    pub(super) frame: Rect,
    /// The scale from the drawing.
    pub(super) scale: Affine,
    /// The eye, or its foot in the drawing.
    pub(super) eye: Point,
}

impl Scene {
    /// Returns the image of the artwork's box, for the preview.
    pub(super) fn outline(&self, map: &dyn Map) -> Option<BezPath> {
        let r = self.frame;
        let tolerance = 1e-3 * (r.width() + r.height());
        let outline = Outline::from_points(&Frame::new(r).corners(), true);
        refit::warp_path(&outline, map, &refit::Options::new(tolerance)).ok().map(|w| w.path)
    }

    /// Describes the sizes of the artwork and the result.
    pub(super) fn size(&self, map: &dyn Map, [x, y]: [f64; 2]) -> String {
        const METRE: f64 = 96.0 / 0.0254;
        let r = self.frame;
        let grid = (0..=8).flat_map(|i| (0..=8).map(move |j| (f64::from(i) / 8.0, f64::from(j) / 8.0)));
        let at = |(u, v): (f64, f64)| map.point(Point::new(r.x0 + u * r.width(), r.y0 + v * r.height()));
        let all = grid.map(at).filter(|p| p.is_finite()).map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b));
        let all = all.unwrap_or(r);
        let say = |r: Rect| {
            let metres = [r.width() / x / METRE, r.height() / y / METRE];
            let (per_metre, unit) = if metres[0].max(metres[1]) < 1.0 { (1e3, "mm") } else { (1.0, "m") };
            let [w, h] = metres.map(|v| trimmed(v * per_metre, 3));
            format!("{w} × {h} {unit}")
        };
        format!("the artwork appears to be {}; the result is {}", say(r), say(all))
    }
}
