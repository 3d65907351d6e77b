//! Pieces, times and errors beside kurbo's, on curves of its own making: `cargo run --release -p bezierfit --example kurbo`
//!
//! Offsets of 500 random arches, and paths of many cubics that few would do for. Times are the least of five runs; errors are
//! measured by 100 points of each piece, for offsets against the distance from the arch itself, and as shares of the tolerance.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

use bezierfit::{Offset, Options, fit, simplify};
use kurbo::offset::offset_cubic;
use kurbo::simplify::{SimplifyOptLevel, SimplifyOptions, simplify_bezpath};
use kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveNearest, PathSeg, Point, Vec2};
use std::f64::consts::TAU;
use std::time::Instant;

fn main() {
    let arches = arches(500);
    for tolerance in [1.0, 0.1, 0.01, 0.001] {
        let error = |out: &[BezPath]| {
            let off = |(arch, path): (&CubicBez, &BezPath)| {
                points(path).map(|p| (arch.nearest(p, 1e-12).distance_sq.sqrt() - 10.0).abs()).fold(0.0, f64::max)
            };
            arches.iter().zip(out).map(off).fold(0.0, f64::max) / tolerance
        };
        let ours = || {
            let one =
                |c: &CubicBez| fit(&Offset::new(PathSeg::Cubic(*c), 10.0), &Options::new(tolerance)).unwrap().path;
            arches.iter().map(one).collect::<Vec<_>>()
        };
        let theirs = || {
            let one = |c: &CubicBez| {
                let mut path = BezPath::new();
                offset_cubic(*c, 10.0, tolerance, &mut path);
                path
            };
            arches.iter().map(one).collect::<Vec<_>>()
        };
        row(&format!("offsets, {tolerance}"), &[("ours", timed(ours)), ("offset_cubic", timed(theirs))], error);
    }
    for (name, path) in
        [("circle of 40", ring(40, 0.0)), ("circle of 1000", ring(1000, 0.0)), ("waves of 400", ring(400, 0.2))]
    {
        for tolerance in [1.0, 0.1, 0.01] {
            let error = |out: &[BezPath]| distance(&out[0], &path).max(distance(&path, &out[0])) / tolerance;
            let ours = || vec![simplify(&path, &Options::new(tolerance)).unwrap().path];
            let theirs = |optimize: bool| {
                let level = if optimize { SimplifyOptLevel::Optimize } else { SimplifyOptLevel::Subdivide };
                vec![simplify_bezpath(path.iter(), tolerance, &SimplifyOptions::default().opt_level(level))]
            };
            let [subdivide, optimize] = [false, true].map(|optimize| timed(|| theirs(optimize)));
            let columns = [("ours", timed(ours)), ("Subdivide", subdivide), ("Optimize", optimize)];
            row(&format!("{name}, {tolerance}"), &columns, error);
        }
    }
}

/// Prints pieces, microseconds and error of each.
fn row(name: &str, columns: &[(&str, (Vec<BezPath>, f64))], error: impl Fn(&[BezPath]) -> f64) {
    print!("{name:<22}");
    for (who, (paths, micros)) in columns {
        let pieces: usize = paths.iter().map(|p| p.segments().count()).sum();
        print!(" | {who}: {pieces} pieces, {micros:.0} µs, error {:.3}", error(paths));
    }
    println!();
}

fn timed(mut f: impl FnMut() -> Vec<BezPath>) -> (Vec<BezPath>, f64) {
    let mut least = f64::INFINITY;
    let mut out = Vec::new();
    for _ in 0..5 {
        let start = Instant::now();
        out = f();
        least = least.min(start.elapsed().as_secs_f64() * 1e6);
    }
    (out, least)
}

/// Arches without cusps of their offsets at 10.
fn arches(n: usize) -> Vec<CubicBez> {
    let mut state = 1u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    let arch = |_| {
        let (a, b) = (40.0 + 40.0 * random(), 40.0 + 40.0 * random());
        let (u, v) = (Vec2::from_angle(-1.2 * random()), Vec2::from_angle(1.2 * random()));
        CubicBez::new(Point::ORIGIN, (u * a).to_point(), Point::new(200.0, 0.0) - v * b, Point::new(200.0, 0.0))
    };
    (0..n).map(arch).collect()
}

/// A closed path of `n` Hermite cubics around the origin, with waves of this share of the radius.
fn ring(n: usize, waves: f64) -> BezPath {
    let at = |t: f64| (Vec2::from_angle(t) * (1000.0 * (1.0 + waves * (5.0 * t).sin()))).to_point();
    let slope = |t: f64| (at(t + 1e-5) - at(t - 1e-5)) / 2e-5;
    let step = TAU / n as f64;
    let mut path = BezPath::new();
    path.move_to(at(0.0));
    for i in 0..n {
        let [t, u] = [i, i + 1].map(|i| step * (i % n) as f64);
        path.curve_to(at(t) + slope(t) * (step / 3.0), at(u) - slope(u) * (step / 3.0), at(u));
    }
    path.close_path();
    path
}

fn points(path: &BezPath) -> impl Iterator<Item = Point> + '_ {
    path.segments().flat_map(|s| (0..=100).map(move |i| s.eval(f64::from(i) / 100.0)))
}

/// The largest distance of points of `a` from `b`.
fn distance(a: &BezPath, b: &BezPath) -> f64 {
    let every = (a.segments().count() / 50).max(1);
    let off = |p: Point| b.segments().map(|s| s.nearest(p, 1e-9).distance_sq).fold(f64::INFINITY, f64::min);
    points(a).step_by(every).map(off).fold(0.0, f64::max).sqrt()
}
