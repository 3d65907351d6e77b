//! Gradients as functions of the plane: colours at points, and bounds on their change.

use crate::scene::geometry::{affine, is_invertible, stretch};
use pathwarp::kurbo::{Affine, Point, Vec2};
use usvg::{Paint, SpreadMethod};

/// Number of points whose colours are computed together.
const BATCH: usize = 32;
/// Stops closer than this coincide; usvg moves them apart by a rounding error.
pub(super) const SAME_OFFSET: f64 = 1e-4;

/// A gradient as a function of the plane.
#[derive(Debug, Clone)]
pub(crate) struct Shading {
    /// Leads from user space to the gradient's space.
    pub(crate) to_gradient: Affine,
    pub(crate) kind: GradientShape,
    pub(crate) stops: Vec<Stop>,
    pub(super) spread: SpreadMethod,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Stop {
    pub(crate) offset: f64,
    /// Not premultiplied.
    pub(crate) color: [f64; 4],
}

/// The colours between two neighbouring stops, before the first or beyond the last: `color` at the parameter `from`, changing at
/// `rate`. The default is empty.
#[derive(Debug, Clone, Copy, Default)]
struct Band {
    from: f64,
    to: f64,
    color: [f64; 4],
    rate: [f64; 4],
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum GradientShape {
    /// The parameter at `from` is 0, and grows by `slope`.
    Linear {
        from: Point,
        slope: Vec2,
    },
    Radial {
        centre: Point,
        radius: f64,
        focus: Point,
        focal_radius: f64,
    },
}

impl Shading {
    /// Reads a gradient. Returns `None` for other paints, and for transforms that cannot be inverted.
    pub(super) fn from_paint(paint: &Paint) -> Option<Self> {
        let p = |x: f32, y: f32| Point::new(f64::from(x), f64::from(y));
        let (base, kind): (&usvg::BaseGradient, _) = match paint {
            Paint::LinearGradient(g) => {
                let (from, to) = (p(g.x1(), g.y1()), p(g.x2(), g.y2()));
                (g, GradientShape::Linear { from, slope: (to - from) / (to - from).hypot2() })
            }
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
        let transform = affine(base.transform());
        is_invertible(transform).then(|| Self {
            to_gradient: transform.inverse(),
            kind,
            stops: base.stops().iter().map(stop).collect(),
            spread: base.spread_method(),
        })
    }

    /// The tag and the attributes of its geometry.
    pub(crate) fn geometry(&self) -> (&'static str, Vec<(&'static str, f64)>) {
        match self.kind {
            GradientShape::Linear { from, slope } => {
                let to = from + slope / slope.hypot2();
                ("linearGradient", vec![("x1", from.x), ("y1", from.y), ("x2", to.x), ("y2", to.y)])
            }
            GradientShape::Radial { centre, radius, focus, .. } => {
                let mut all = vec![("cx", centre.x), ("cy", centre.y), ("r", radius)];
                if focus != centre {
                    all.extend([("fx", focus.x), ("fy", focus.y)]);
                }
                ("radialGradient", all)
            }
        }
    }

    /// The image of the gradient under an affine map.
    pub(super) fn transformed(&self, by: Affine) -> Self {
        Self { to_gradient: self.to_gradient * by.inverse(), ..self.clone() }
    }

    /// Parameters along the stops at points of user space; NaN outside the cone of a focal gradient.
    fn parameters(&self, points: &[Point], out: &mut [f64]) {
        let pairs = out.iter_mut().zip(points);
        match self.kind {
            GradientShape::Linear { from, slope } => {
                pairs.for_each(|(t, p)| *t = (self.to_gradient * *p - from).dot(slope));
            }
            GradientShape::Radial { centre, radius, focus, focal_radius } if centre == focus => {
                let per_unit = 1.0 / (radius - focal_radius);
                pairs.for_each(|(t, p)| {
                    *t = ((self.to_gradient * *p - focus).hypot2().sqrt() - focal_radius) * per_unit;
                });
            }
            GradientShape::Radial { .. } => {
                pairs.for_each(|(t, p)| *t = self.cone(self.to_gradient * *p).unwrap_or(f64::NAN));
            }
        }
    }

    /// The parameter along the stops at one point.
    pub(super) fn parameter_at(&self, p: Point) -> f64 {
        let mut t = [0.0];
        self.parameters(&[p], &mut t);
        t[0]
    }

    /// Parameter of a radial gradient at a point of its space. Returns `None` outside the cone of a focal gradient.
    fn cone(&self, p: Point) -> Option<f64> {
        match self.kind {
            GradientShape::Linear { .. } => None,
            // The largest t for which the circle interpolated between the focal (0) and the outer one (1) passes through the point: the
            // larger root of a·t² − 2b·t + c with a radius that is not negative.
            GradientShape::Radial { centre, radius, focus, focal_radius } => {
                let (shift, grow, q) = (centre - focus, radius - focal_radius, p - focus);
                let a = shift.hypot2() - grow * grow;
                let b = q.dot(shift) + focal_radius * grow;
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

    /// Colours at points of user space: red, green, blue, alpha, not premultiplied.
    pub(super) fn colors(&self, points: &[Point], out: &mut [[f64; 4]]) {
        let (mut parameters, mut band) = ([0.0; BATCH], Band::default());
        for (points, out) in points.chunks(BATCH).zip(out.chunks_mut(BATCH)) {
            self.parameters(points, &mut parameters);
            for (color, t) in out.iter_mut().zip(parameters) {
                *color = self.color(t, &mut band);
            }
        }
    }

    /// The colour at a parameter. `band` caches the stops of the previous parameter, since neighbours mostly share them.
    #[inline]
    fn color(&self, t: f64, band: &mut Band) -> [f64; 4] {
        let t = match self.spread {
            SpreadMethod::Pad => t.clamp(0.0, 1.0),
            SpreadMethod::Repeat => t - t.floor(),
            SpreadMethod::Reflect => 1.0 - (t.rem_euclid(2.0) - 1.0).abs(),
        };
        if t.is_nan() {
            return [0.0; 4];
        }
        if !(band.from <= t && t < band.to) {
            *band = self.band(t);
        }
        std::array::from_fn(|k| band.color[k] + (t - band.from) * band.rate[k])
    }

    fn band(&self, t: f64) -> Band {
        let next = self.stops.partition_point(|s| s.offset <= t);
        match (next.checked_sub(1).and_then(|i| self.stops.get(i)), self.stops.get(next)) {
            (Some(a), Some(b)) => {
                let per_unit = 1.0 / (b.offset - a.offset);
                let rate = std::array::from_fn(|k| (b.color[k] - a.color[k]) * per_unit);
                Band { from: a.offset, to: b.offset, color: a.color, rate }
            }
            (Some(s), None) => Band { from: s.offset, to: f64::INFINITY, color: s.color, rate: [0.0; 4] },
            (None, Some(s)) => Band { from: 0.0, to: s.offset, color: s.color, rate: [0.0; 4] },
            (None, None) => Band::default(),
        }
    }

    /// The premultiplied colour at a point of user space.
    pub(super) fn premultiplied(&self, p: Point) -> [f64; 4] {
        premultiplied(self.color(self.parameter_at(p), &mut Band::default()))
    }

    /// An upper bound on the change of a premultiplied channel per unit of user space; infinite if colours jump or no bound is known.
    pub(super) fn steepest(&self) -> f64 {
        let parameter_slope = match self.kind {
            GradientShape::Linear { slope, .. } => slope.hypot(),
            // The circles are closest on the side to which the focus is shifted.
            GradientShape::Radial { centre, radius, focus, focal_radius } => {
                1.0 / (radius - focal_radius - (centre - focus).hypot()).max(0.0)
            }
        };
        self.steps().map(|(_, rate, _)| rate).fold(0.0, f64::max) * parameter_slope * stretch(self.to_gradient)
    }

    /// Returns `true` if the colour jumps by more than `least` between stops in the range of the given points.
    pub(super) fn jumps(&self, points: impl Iterator<Item = Point>, least: f64) -> bool {
        /// Margin for the gaps between points, as a fraction of the range.
        const BETWEEN: f64 = 0.05;
        let range = points
            .map(|p| self.parameter_at(p))
            .filter(|t| !t.is_nan())
            .fold(None, |r: Option<(f64, f64)>, t| Some(r.map_or((t, t), |(a, b)| (a.min(t), b.max(t)))));
        let Some((from, to)) = range else { return false };
        let margin = BETWEEN * (to - from);
        let is_seen = |t: f64| self.spread != SpreadMethod::Pad || (from - margin..=to + margin).contains(&t);
        self.steps().any(|(t, rate, change)| change > least && rate * SAME_OFFSET >= change && is_seen(t))
    }

    /// For each pair of neighbouring stops, its offset, and the rate and amount by which a premultiplied channel changes at most.
    fn steps(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let wrap = match (self.spread, self.stops.first(), self.stops.last()) {
            (SpreadMethod::Repeat, Some(first), Some(last)) => Some((0.0, first, last, 0.0)),
            _ => None,
        };
        let pairs = self.stops.iter().zip(self.stops.iter().skip(1));
        pairs.map(|(a, b)| (a.offset, a, b, b.offset - a.offset)).chain(wrap).map(|(t, a, b, apart)| {
            let (p, q) = (premultiplied(a.color), premultiplied(b.color));
            let change = p.iter().zip(q).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max);
            let alpha = (a.color[3] - b.color[3]).abs();
            // The product rule for colour times alpha.
            let most = |k: usize, c: [f64; 4]| (a.color[k] - b.color[k]).abs() * c[3] + c[k] * alpha;
            let larger: [f64; 4] = std::array::from_fn(|k| a.color[k].max(b.color[k]));
            let rate = (0..3).map(|k| most(k, larger)).fold(alpha, f64::max);
            (t, if rate > 0.0 { rate / apart.max(0.0) } else { 0.0 }, change)
        })
    }
}

pub(super) fn premultiplied([r, g, b, a]: [f64; 4]) -> [f64; 4] {
    [r * a, g * a, b * a, a]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(crate) fn shading(gradient: &str) -> Shading {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>{gradient}<rect width='100' height='80' \
         fill='url(#a)'/></svg>"
        );
        let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
        let usvg::Node::Path(path) = &tree.root().children()[0] else { panic!("{svg}") };
        Shading::from_paint(path.fill().unwrap().paint()).unwrap()
    }

    const SMOOTH: &[&str] = &[
        "<linearGradient id='a' x2='.3' y2='.4'><stop stop-color='red'/><stop offset='.7' stop-color='#0f8'/><stop offset='1' \
     stop-color='blue' stop-opacity='.2'/></linearGradient>",
        "<radialGradient id='a' cx='.4' fx='.5' r='.4' gradientTransform='rotate(20) scale(1 .6)'><stop stop-color='red'/>\
     <stop offset='1' stop-color='#080' stop-opacity='0'/></radialGradient>",
        "<linearGradient id='a' spreadMethod='reflect' x2='.3'><stop stop-color='red'/><stop offset='1'/></linearGradient>",
    ];

    #[test]
    fn no_colour_changes_faster_than_the_bound() {
        for gradient in SMOOTH {
            let shading = shading(gradient);
            let (bound, mut fastest) = (shading.steepest(), 0.0_f64);
            for k in 0..20_000 {
                let p = Point::new(0.5 * f64::from(k % 200), 0.8 * f64::from(k / 200));
                for step in [Vec2::new(0.05, 0.0), Vec2::new(0.0, 0.05), Vec2::new(0.03, 0.04)] {
                    let (a, b) = (shading.premultiplied(p), shading.premultiplied(p + step));
                    fastest = a.iter().zip(b).map(|(a, b)| (a - b).abs() / 0.05).fold(fastest, f64::max);
                }
            }
            assert!(fastest <= bound * 1.001 && fastest > 0.2 * bound, "{gradient}: {fastest} {bound}");
        }
    }

    #[test]
    fn jumps_count_if_they_are_shown() {
        let hard = "<linearGradient id='a'><stop offset='.5' stop-color='red'/><stop offset='.5' stop-color='blue'/>\
                </linearGradient>";
        let repeated = "<linearGradient id='a' spreadMethod='repeat' x2='.2'><stop stop-color='red'/><stop offset='1' \
                    stop-color='blue'/></linearGradient>";
        let points = |from: f64, to: f64| [Point::new(from, 5.0), Point::new(to, 50.0)].into_iter();
        assert!(shading(hard).steepest() > 1e3 && shading(repeated).steepest() == f64::INFINITY);
        assert!(shading(hard).jumps(points(0.0, 100.0), 0.05));
        assert!(!shading(hard).jumps(points(0.0, 40.0), 0.05));
        assert!(!shading(&hard.replace("blue", "#fe0000")).jumps(points(0.0, 100.0), 0.05));
        assert!(shading(repeated).jumps(points(0.0, 100.0), 0.05));
        for gradient in SMOOTH {
            assert!(!shading(gradient).jumps(points(0.0, 100.0), 0.05));
        }
    }
}
