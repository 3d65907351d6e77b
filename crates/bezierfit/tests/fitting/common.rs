//! Curves to fit and to stroke, and their distances from the results.

use bezierfit::Source;
use kurbo::{BezPath, Point, Vec2};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Run, apart, far};
use std::cell::Cell;

/// A curve given by a function and its breaks, which counts its evaluations.
pub struct Drawn<'a> {
    eval: Box<dyn Fn(f64) -> (Point, Vec2) + 'a>,
    pub breaks: Vec<f64>,
    pub evaluations: Cell<usize>,
}

impl<'a> Drawn<'a> {
    pub fn new(eval: impl Fn(f64) -> (Point, Vec2) + 'a, breaks: Vec<f64>) -> Self {
        Self { eval: Box::new(eval), breaks, evaluations: Cell::new(0) }
    }
}

impl Source for Drawn<'_> {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        self.evaluations.set(self.evaluations.get() + 1);
        (self.eval)(t)
    }

    fn breaks(&self) -> Vec<f64> {
        self.breaks.clone()
    }
}

/// Hausdorff distance between a curve and a path, sampled for distances like `tolerance`.
pub fn distance(source: &dyn Source, path: &BezPath, tolerance: f64) -> f64 {
    let (exact, segments) = (Run::new(1, |(_, t)| source.eval(t).0), path.curves());
    let n = (100 * segments.len()).clamp(1000, 4000);
    apart(&exact.sampled(n, tolerance), &Run::of(&segments).sampled(40, tolerance)).0
}

/// Largest distance of points from a path.
pub fn off(points: &[Point], path: &BezPath) -> f64 {
    far(points, &[Run::of(&path.curves()).sampled(40, 0.01)]).0
}

/// A sine wave of a number of radians.
pub fn wave(radians: f64) -> Drawn<'static> {
    let eval = move |t: f64| {
        let (s, c) = (radians * t).sin_cos();
        (Point::new(300.0 * t, 40.0 * s), Vec2::new(300.0, 40.0 * radians * c))
    };
    Drawn::new(eval, Vec::new())
}

/// Lines, quadratics and cubics through random points, some of which coincide or nearly do; every second path is closed.
#[cfg(feature = "area")]
pub fn random_path(random: &mut pathwarp_oracle::Random, i: usize) -> BezPath {
    let point = |r: &mut pathwarp_oracle::Random| Point::new(r.between(0.0, 100.0), r.between(0.0, 100.0));
    let mut path = BezPath::new();
    let mut at = point(random);
    path.move_to(at);
    for _ in 0..=random.below(4) {
        let before = at;
        let mut next = || match random.below(12) {
            0 => before,
            1 => before + (point(random) - before) * 1e-4,
            _ => point(random),
        };
        let (a, b, c) = (next(), next(), next());
        at = c;
        match i % 5 {
            0 => path.line_to(c),
            1 => path.quad_to(a, c),
            _ => path.curve_to(a, b, c),
        }
    }
    if i.is_multiple_of(2) {
        path.close_path();
    }
    path
}

/// A path of straight lines through points.
pub fn polygon(points: &[Point], closed: bool) -> BezPath {
    let mut path = BezPath::new();
    if let Some((first, rest)) = points.split_first() {
        path.move_to(*first);
        rest.iter().for_each(|p| path.line_to(*p));
        if closed {
            path.close_path();
        }
    }
    path
}
