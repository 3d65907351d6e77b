//! The artwork at its apparent size, and the eye.

use super::surface::box_samples;
use crate::decimal::trimmed;
use crate::deform::entry::SightMark;
use crate::error::show;
use crate::map::Map;
use crate::outline::Outline;
use crate::param::Frame;
use crate::refit;
use kurbo::{Affine, BezPath, Circle, Point, Rect, Shape, Vec2};
use std::fmt;

/// The position of the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Eye {
    /// At this distance in front of a point of the drawing; 0 means in the drawing.
    At(Point, f64),
    /// At infinity, in the direction of this unit vector: x right, y down, z away from the viewer.
    Infinite([f64; 3]),
}

impl Eye {
    pub(super) fn is_infinite(self) -> bool {
        matches!(self, Self::Infinite(_))
    }

    /// Returns the distance from the eye to a point in space. At infinity it is replaced by a finite distance.
    pub(super) fn distance_to(self, [x, y, z]: [f64; 3]) -> f64 {
        /// Stands for infinity, in user units.
        const FAR: f64 = 1e3;
        match self {
            Self::At(foot, distance) => (Point::new(x, y) - foot).hypot().hypot(z + distance),
            Self::Infinite(_) => FAR,
        }
    }

    /// Returns the line of sight through the drawing, per unit of depth, of an eye at infinity in front of it.
    pub(super) fn line_of_sight(self) -> [f64; 3] {
        match self {
            Self::At(..) => [0.0, 0.0, 1.0],
            Self::Infinite([x, y, z]) => [x / z, y / z, 1.0],
        }
    }
}

impl fmt::Display for Eye {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::At(foot, distance) => write!(f, "at {}, {distance} in front", show(*foot)),
            Self::Infinite([x, y, z]) => write!(f, "at infinity towards {x:.3},{y:.3},{:.3}", -z),
        }
    }
}

/// The artwork at its apparent size, and the eye.
pub(super) struct Scene {
    /// The artwork's box.
    pub(super) frame: Rect,
    /// The scale from the artwork as drawn.
    pub(super) scale: Affine,
    pub(super) eye: Eye,
}

/// CSS pixels per metre.
const METRE: f64 = 96.0 / 0.0254;

/// Describes a length in user units as millimetres or metres.
pub(super) fn format_length(length: f64, units_per_px: [f64; 2]) -> String {
    let metres = length / (0.5 * (units_per_px[0] + units_per_px[1])) / METRE;
    if metres < 1.0 { format!("{} mm", trimmed(metres * 1e3, 1)) } else { format!("{} m", trimmed(metres, 3)) }
}

/// The end of a label to which the distance is added.
pub(super) const HERE: &str = ", from here";

/// Marks the point `at` with the words `here`. If it is far from the box `extent` of the result, draws an arrow towards it with `there`.
pub(super) fn sight_mark(at: Point, [here, there]: [String; 2], extent: Rect, units_per_px: [f64; 2]) -> SightMark {
    /// Least height of a mark, in metres.
    const SMALLEST: f64 = 0.003;
    /// Least height of a mark, as a share of the result.
    const SHARE: f64 = 0.012;
    let size = (SMALLEST * METRE * units_per_px[0]).max(SHARE * (extent.width() + extent.height()));
    let under = |p: Point| p + Vec2::new(0.0, 3.0 * size);
    let mut path = BezPath::new();
    let mut line = |a: Point, b: Point| {
        path.move_to(a);
        path.line_to(b);
    };
    let near = extent.inflate(extent.width().max(8.0 * size), extent.height().max(8.0 * size));
    if near.contains(at) {
        for v in [Vec2::new(1.5 * size, 0.0), Vec2::new(0.0, 1.5 * size)] {
            line(at - v, at + v);
        }
        path.extend(Circle::new(at, size).path_elements(1e-3 * size));
        // The label does not lie on the artwork.
        let label = if extent.contains(at) { Point::new(at.x, extent.y1 + 2.0 * size) } else { under(at) };
        return SightMark { path, label: (label, here), size };
    }
    let direction = (at - extent.center()) / (at - extent.center()).hypot();
    // The distances at which the lines of the box's sides are met.
    let [x, y] = [(extent.width(), direction.x), (extent.height(), direction.y)].map(|(side, v)| 0.5 * side / v.abs());
    let from = extent.center() + direction * (x.min(y) + 2.0 * size);
    let (to, across) = (from + direction * (6.0 * size), Vec2::new(-direction.y, direction.x));
    line(from, to);
    for side in [-1.0, 1.0] {
        line(to, to - direction * (1.5 * size) + across * (side * 0.7 * size));
    }
    let text = match there.strip_suffix(HERE) {
        Some(there) => {
            format!("{there}, {} from the tail of the arrow", format_length((at - from).hypot(), units_per_px))
        }
        None => there,
    };
    SightMark { path, label: (under(if to.y > from.y { to } else { from }), text), size }
}

impl Scene {
    /// Returns the image of the artwork's box, for the preview.
    pub(super) fn outline(&self, map: &dyn Map) -> Option<BezPath> {
        let r = self.frame;
        let tolerance = 1e-3 * (r.width() + r.height());
        let outline = Outline::from_points(&Frame::new(r).corners(), true);
        let options = refit::Options::new(tolerance).with_nodes(refit::Nodes::Source);
        refit::warp_path(&outline, map, &options).ok().map(|w| w.path)
    }

    /// Returns the box of the result.
    pub(super) fn extent(&self, map: &dyn Map) -> Rect {
        let images = box_samples(self.frame).map(|p| map.point(p)).filter(|p| p.is_finite());
        images.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b)).unwrap_or(self.frame)
    }

    /// Describes the sizes of the artwork and the result.
    pub(super) fn describe_sizes(&self, map: &dyn Map, [x, y]: [f64; 2]) -> String {
        let size = |r: Rect| {
            let metres = [r.width() / x / METRE, r.height() / y / METRE];
            let (per_metre, unit) = if metres[0].max(metres[1]) < 1.0 { (1e3, "mm") } else { (1.0, "m") };
            let [w, h] = metres.map(|v| trimmed(v * per_metre, 3));
            format!("{w} × {h} {unit}")
        };
        format!("the artwork appears to be {}; the result is {}", size(self.frame), size(self.extent(map)))
    }
}
