//! The image of a curve of any kind under a map.

use crate::map::{Creases, Level, Map};
use bezierfit::{Error, Fitted, Lane, Lanes, Source};
use kurbo::{Point, Vec2};

/// The number of samples of a curve between which its crossings with creases are sought.
const SAMPLES: usize = 256;

/// Fits the image of a curve under a map. The curve is a closure from a parameter, 0 to 1, to a point and a derivative, a curve of kurbo
/// as [`Segment`](bezierfit::Segment), [`PathSource`](bezierfit::PathSource) or [`Kurbo`](bezierfit::Kurbo), or any other [`Source`].
///
/// Crossings with a crease are missed if two of them lie within a 256th of the curve's parameter. To avoid this, pass paths and segments
/// as outlines to [`warp_path`](super::warp_path).
///
/// # Errors
/// The errors of [`bezierfit::fit`], such as [`Error::NotFinite`] and [`Error::NotMet`]. Points in them belong to the source.
///
/// ```
/// use pathwarp::{deform::Swirl, fit::{Options, Segment}, kurbo::{CubicBez, PathSeg, Point, Vec2}, refit::warp_curve};
///
/// let swirl = Swirl::new((50.0, 50.0), 60.0).build()?.map;
/// let arch = PathSeg::Cubic(CubicBez::new((0.0, 0.0), (10.0, 60.0), (90.0, 60.0), (100.0, 0.0)));
/// let ray = |t: f64| (Point::new(100.0 * t, 50.0), Vec2::new(100.0, 0.0));
/// for fitted in [warp_curve(&Segment::new(arch), &swirl, &Options::new(0.01))?, warp_curve(&ray, &swirl, &Options::new(0.01))?] {
///     assert!(fitted.report.max_error <= 0.01 && fitted.path.segments().count() < 20);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn warp_curve(curve: &dyn Source, map: &dyn Map, options: &bezierfit::Options) -> Result<Fitted, Error> {
    let mut breaks = curve.breaks();
    Creases::of_map(map).items().iter().for_each(|c| crossings(curve, &c.level, &mut breaks));
    bezierfit::fit(&Image { curve, map, breaks }, options)
}

/// Adds the parameters at which a curve goes from one side of a level set to the other.
fn crossings(curve: &dyn Source, level: &Level, out: &mut Vec<f64>) {
    let side = |t: f64| level.at(curve.eval(t).0) > 0.0;
    for i in 0..SAMPLES {
        let [mut from, mut to] = [i, i + 1].map(|i| i as f64 / SAMPLES as f64);
        let (first, last) = (side(from), side(to));
        while first != last && to - from > f64::EPSILON {
            let t = 0.5 * (from + to);
            *(if side(t) == first { &mut from } else { &mut to }) = t;
        }
        out.extend((first != last).then_some(to));
    }
}

/// The image of a curve under a map.
struct Image<'a> {
    curve: &'a dyn Source,
    map: &'a dyn Map,
    breaks: Vec<f64>,
}

impl Source for Image<'_> {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let (p, d) = self.curve.eval(t);
        let jet = self.map.jet(p);
        (jet.p, jet.push(d))
    }

    fn points(&self, t: &Lane, out: &mut Lanes) {
        self.curve.points(t, out);
        let points: [Point; 8] = std::array::from_fn(|i| Point::new(out.x[i], out.y[i]));
        *out = super::source::images(self.map, &points);
    }

    fn breaks(&self) -> Vec<f64> {
        self.breaks.clone()
    }

    fn is_simple(&self) -> bool {
        self.curve.is_simple() && self.map.rational_degree().is_some_and(|d| d.degree <= super::source::LOW_DEGREE)
    }

    fn place(&self, t: f64) -> Point {
        self.curve.place(t)
    }
}
