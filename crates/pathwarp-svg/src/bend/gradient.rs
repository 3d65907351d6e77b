//! Gradients as functions of the plane, and as pictures where no gradient of SVG's can follow the map. The pixels are somebody
//! else's work: a [`GradientPainter`]'s.

use crate::bend::image::BentImage;
use crate::bend::paint::Fit;
use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp::map::Map;
use usvg::{Paint, SpreadMethod};

/// Paints bent gradients.
pub trait GradientPainter: Send + Sync {
    /// The picture of a bent gradient, and where it goes: all of the target, and a few pixels around it.
    ///
    /// # Errors
    /// Why it cannot be painted; the gradient follows the best affine fit then.
    fn paint(&self, request: &GradientRequest<'_>) -> Result<BentImage, String>;
}

/// A gradient on a shape that is bent.
pub struct GradientRequest<'a> {
    /// The colour of a place in the shape's user space: red, green, blue and alpha, 0 to 1, not premultiplied.
    pub color: &'a (dyn Fn(Point) -> [f64; 4] + Sync),
    /// The shape's box in its user space.
    pub area: Rect,
    /// From there to root user space.
    pub placed: Affine,
    /// The map of root user space.
    pub map: &'a dyn Map,
    /// From root user space to the user space that the result is placed in.
    pub after: Affine,
    /// The bent shape's box there.
    pub target: Rect,
    /// Root user space to px, for resolutions.
    pub to_px: Affine,
    /// How many gradients of the drawing there are to paint at most: what they may take is shared.
    pub among: usize,
}

/// A gradient as a function of the plane.
#[derive(Debug, Clone)]
pub(crate) struct Shading {
    /// From user space to the gradient's own.
    inside: Affine,
    kind: Kind,
    /// Offsets in order, and colours, not premultiplied.
    stops: Vec<(f64, [f64; 4])>,
    spread: SpreadMethod,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Linear { from: Point, to: Point },
    Radial { centre: Point, radius: f64, focus: Point, focal_radius: f64 },
}

impl Shading {
    /// `None` for what is no gradient.
    pub(crate) fn of(paint: &Paint) -> Option<Self> {
        let p = |x: f32, y: f32| Point::new(f64::from(x), f64::from(y));
        let (base, kind): (&usvg::BaseGradient, _) = match paint {
            Paint::LinearGradient(g) => (g, Kind::Linear { from: p(g.x1(), g.y1()), to: p(g.x2(), g.y2()) }),
            Paint::RadialGradient(g) => {
                let (radius, focal_radius) = (f64::from(g.r().get()), f64::from(g.fr().get()));
                (g, Kind::Radial { centre: p(g.cx(), g.cy()), radius, focus: p(g.fx(), g.fy()), focal_radius })
            }
            Paint::Color(_) | Paint::Pattern(_) => return None,
        };
        let stop = |s: &usvg::Stop| {
            let (c, a) = (s.color(), s.opacity().get());
            let level = |v: u8| f64::from(v) / 255.0;
            (f64::from(s.offset().get()), [level(c.red), level(c.green), level(c.blue), f64::from(a)])
        };
        let inside = crate::scene::geometry::affine(base.transform());
        crate::bend::part::usable(inside).then(|| Self {
            inside: inside.inverse(),
            kind,
            stops: base.stops().iter().map(stop).collect(),
            spread: base.spread_method(),
        })
    }

    /// Where along its stops a place is; `None` where a cone of two circles does not reach.
    fn along(&self, p: Point) -> Option<f64> {
        match self.kind {
            Kind::Linear { from, to } => {
                let d = to - from;
                Some((p - from).dot(d) / d.hypot2())
            }
            // Of the circles between the focal one (0) and the outer (1), and beyond, the last that runs through the place.
            Kind::Radial { centre, radius, focus, focal_radius } => {
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

    /// The colour of a place in user space: red, green, blue, alpha, not premultiplied.
    pub(crate) fn color(&self, p: Point) -> [f64; 4] {
        let Some(t) = self.along(self.inside * p) else { return [0.0; 4] };
        let t = match self.spread {
            SpreadMethod::Pad => t.clamp(0.0, 1.0),
            SpreadMethod::Repeat => t - t.floor(),
            SpreadMethod::Reflect => 1.0 - (t.rem_euclid(2.0) - 1.0).abs(),
        };
        let next = self.stops.partition_point(|s| s.0 <= t);
        match (next.checked_sub(1).and_then(|i| self.stops.get(i)), self.stops.get(next)) {
            (Some((t0, c0)), Some((t1, c1))) => {
                let u = (t - t0) / (t1 - t0);
                std::array::from_fn(|k| c0[k] + u * (c1[k] - c0[k]))
            }
            (Some(s), None) | (None, Some(s)) => s.1,
            (None, None) => [0.0; 4],
        }
    }

    /// Whether the affine fit shows: somewhere on the shape's box the colour it brings there is another than the map's.
    pub(crate) fn shows(&self, area: Rect, placed: Affine, after: Affine, map: &dyn Map, fit: &Fit) -> bool {
        /// A level of 255 more or less is seen by nobody.
        const SEEN: f64 = 1.5 / 255.0;
        /// Places along a side, off any symmetry of the box, where stops like to lie.
        const N: u32 = 24;
        let back = fit.affine.inverse();
        let at = |k: u32| (f64::from(k) + 0.37) / f64::from(N);
        (0..N * N).any(|k| {
            let p = Point::new(area.x0 + at(k % N) * area.width(), area.y0 + at(k / N) * area.height());
            let q = back * (after * map.point(placed * p));
            let (wanted, found) = (premultiplied(self.color(p)), premultiplied(self.color(q)));
            q.is_finite() && wanted.iter().zip(found).any(|(w, f)| (w - f).abs() > SEEN)
        })
    }
}

fn premultiplied([r, g, b, a]: [f64; 4]) -> [f64; 4] {
    [r * a, g * a, b * a, a]
}
