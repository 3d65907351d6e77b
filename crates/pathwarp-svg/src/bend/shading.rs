//! Gradients as functions of the plane, for those that no gradient of SVG can follow.

use super::paint::PaintFit;
use crate::scene::affine::{affine, is_invertible};
use pathwarp::kurbo::{Affine, BezPath, Point, Rect, Shape as _};
use pathwarp::map::Map;
use usvg::{Paint, SpreadMethod};

/// A gradient as a function of the plane.
#[derive(Debug, Clone)]
pub(super) struct Shading {
    /// From user space to the gradient's space.
    inside: Affine,
    kind: GradientShape,
    stops: Vec<Stop>,
    spread: SpreadMethod,
}

#[derive(Debug, Clone, Copy)]
struct Stop {
    offset: f64,
    /// Not premultiplied.
    color: [f64; 4],
}

#[derive(Debug, Clone, Copy)]
enum GradientShape {
    Linear { from: Point, to: Point },
    Radial { centre: Point, radius: f64, focus: Point, focal_radius: f64 },
}

impl Shading {
    /// Reads a gradient. Returns `None` for other paints.
    pub(super) fn of(paint: &Paint) -> Option<Self> {
        let p = |x: f32, y: f32| Point::new(f64::from(x), f64::from(y));
        let (base, kind): (&usvg::BaseGradient, _) = match paint {
            Paint::LinearGradient(g) => (g, GradientShape::Linear { from: p(g.x1(), g.y1()), to: p(g.x2(), g.y2()) }),
            Paint::RadialGradient(g) => {
                let (radius, focal_radius) = (f64::from(g.r().get()), f64::from(g.fr().get()));
                (g, GradientShape::Radial { centre: p(g.cx(), g.cy()), radius, focus: p(g.fx(), g.fy()), focal_radius })
            }
            Paint::Color(_) | Paint::Pattern(_) => return None,
        };
        let stop = |s: &usvg::Stop| {
            let (c, a) = (s.color(), s.opacity().get());
            let level = |v: u8| f64::from(v) / 255.0;
            let color = [level(c.red), level(c.green), level(c.blue), f64::from(a)];
            Stop { offset: f64::from(s.offset().get()), color }
        };
        let inside = affine(base.transform());
        is_invertible(inside).then(|| Self {
            inside: inside.inverse(),
            kind,
            stops: base.stops().iter().map(stop).collect(),
            spread: base.spread_method(),
        })
    }

    /// Parameter along the stops at a point. Returns `None` outside of the cone of a focal gradient.
    fn along(&self, p: Point) -> Option<f64> {
        match self.kind {
            GradientShape::Linear { from, to } => {
                let d = to - from;
                Some((p - from).dot(d) / d.hypot2())
            }
            // The largest t for which the interpolated circle (0: focal, 1: outer) passes through the point.
            GradientShape::Radial { centre, radius, focus, focal_radius } => {
                let (d, grow, q) = (centre - focus, radius - focal_radius, p - focus);
                let a = d.hypot2() - grow * grow;
                let b = q.dot(d) + focal_radius * grow;
                let c = q.hypot2() - focal_radius * focal_radius;
                let reaches = |t: &f64| t.is_finite() && focal_radius + t * grow >= 0.0;
                if a.abs() <= 1e-12 * grow * grow {
                    return Some(c / (2.0 * b)).filter(reaches);
                }
                let root = (b * b - a * c).sqrt();
                let (s, t) = ((b + root) / a, (b - root) / a);
                [s.max(t), s.min(t)].into_iter().find(reaches)
            }
        }
    }

    /// Colour at a point of user space: red, green, blue, alpha, not premultiplied.
    pub(super) fn color(&self, p: Point) -> [f64; 4] {
        let Some(t) = self.along(self.inside * p) else { return [0.0; 4] };
        let t = match self.spread {
            SpreadMethod::Pad => t.clamp(0.0, 1.0),
            SpreadMethod::Repeat => t - t.floor(),
            SpreadMethod::Reflect => 1.0 - (t.rem_euclid(2.0) - 1.0).abs(),
        };
        let next = self.stops.partition_point(|s| s.offset <= t);
        match (next.checked_sub(1).and_then(|i| self.stops.get(i)), self.stops.get(next)) {
            (Some(a), Some(b)) => {
                let u = (t - a.offset) / (b.offset - a.offset);
                std::array::from_fn(|k| a.color[k] + u * (b.color[k] - a.color[k]))
            }
            (Some(s), None) | (None, Some(s)) => s.color,
            (None, None) => [0.0; 4],
        }
    }

    /// Returns `true` if the affine fit is visibly wrong: its colours differ from the map's.
    pub(super) fn differs_from(
        &self,
        fit: &PaintFit,
        seen: &Seen<'_>,
        placed: Affine,
        after: Affine,
        map: &dyn Map,
    ) -> bool {
        /// Samples along a side. They avoid the symmetry axes of the box, where stops tend to be.
        const N: u32 = 24;
        let (least, share) = if seen.strict { (SMALLEST, 0.0) } else { (NOTICED, NOTICED_SHARE) };
        let area = seen.area;
        let back = fit.affine.inverse();
        let at = |k: u32| (f64::from(k) + 0.37) / f64::from(N);
        let points =
            (0..N * N).map(|k| Point::new(area.x0 + at(k % N) * area.width(), area.y0 + at(k / N) * area.height()));
        let (mut off, mut count) = (0, 0);
        for p in points.filter(|p| seen.inside.is_none_or(|i| i.contains(*p))) {
            let q = back * (after * map.point(placed * p));
            let (expected, found) = (premultiplied(self.color(p)), premultiplied(self.color(q)));
            count += 1;
            off += u32::from(q.is_finite() && expected.iter().zip(found).any(|(w, f)| (w - f).abs() > least));
            if seen.strict && off > 0 {
                return true;
            }
        }
        f64::from(off) > share * f64::from(count)
    }
}

/// Smallest visible difference: more than one of 255 levels.
const SMALLEST: f64 = 1.5 / 255.0;
/// Smallest difference that is noticed without a comparison.
const NOTICED: f64 = 8.0 / 255.0;
/// The fraction of the shape on which it must be exceeded. Less are edges between hard stops, which move a little.
const NOTICED_SHARE: f64 = 0.01;

/// The place where colours are compared.
pub(super) struct Seen<'a> {
    /// Every visible difference counts, not only those that are noticed.
    pub(super) strict: bool,
    /// The part of the area that counts; `None` for all of it.
    pub(super) inside: Option<&'a BezPath>,
    pub(super) area: Rect,
}

fn premultiplied([r, g, b, a]: [f64; 4]) -> [f64; 4] {
    [r * a, g * a, b * a, a]
}
