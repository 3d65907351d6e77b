//! Quadratics for cubics, counted beside those of fontTools' cu2qu, whose numbers and outlines `quadratics.py` writes:
//!
//! `python3 quadratics.py FONT.ttf | cargo run --release -p bezierfit --example quadratics`
//!
//! Prints off-curve points for each tolerance: cu2qu's, those with every cubic on its own, and those with pieces across smooth joints,
//! with the points on the curve that have to be stored; and the largest error, measured by 200 points of each side. Then the time for a
//! circle of six cubics, as a multiple of that for cubics.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

use bezierfit::{Degree, Nodes, Options, simplify};
use kurbo::{BezPath, ParamCurve, ParamCurveNearest, PathSeg, Point, Vec2};
use std::f64::consts::TAU;
use std::time::Instant;

fn main() {
    let lines: Vec<String> = std::io::stdin().lines().map(Result::unwrap).collect();
    let contours: Vec<([usize; 3], BezPath)> = lines
        .iter()
        .map(|l| {
            let mut words = l.splitn(4, ' ');
            let counts = std::array::from_fn(|_| words.next().unwrap().parse().unwrap());
            (counts, BezPath::from_svg(words.next().unwrap()).unwrap())
        })
        .collect();
    let is_cubic = |s: &PathSeg| matches!(s, PathSeg::Cubic(_));
    let cubics: usize = contours.iter().map(|(_, p)| p.segments().filter(is_cubic).count()).sum();
    println!("{} contours, {cubics} cubics", contours.len());
    println!("tolerance    cu2qu    alone  merged  on the curve   µs a cubic   largest error ÷ tolerance");
    for (i, tolerance) in [1.0, 0.1, 0.01].into_iter().enumerate() {
        let theirs: usize = contours.iter().map(|(n, _)| n[i]).sum();
        let options = Options::new(tolerance).with_degree(Degree::Quadratic);
        let mut alone = 0;
        for (_, path) in &contours {
            alone += counts(&simplify(path, &options.with_nodes(Nodes::Source)).unwrap().path).0;
        }
        let start = Instant::now();
        let merged: Vec<BezPath> = contours.iter().map(|(_, p)| simplify(p, &options).unwrap().path).collect();
        let micros = start.elapsed().as_secs_f64() * 1e6 / cubics as f64;
        let (off, on) = merged.iter().map(counts).fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        let errors = contours.iter().zip(&merged).step_by(7).map(|((_, p), q)| distance(p, q).max(distance(q, p)));
        let worst = errors.fold(0.0, f64::max) / tolerance;
        println!("{tolerance:>9} {theirs:>8} {alone:>8} {off:>7} {on:>13} {micros:>12.1} {worst:>27.3}");
    }
    let ring = ring(6, 300.0);
    for tolerance in [1.0, 0.3, 0.1, 0.01] {
        let [cubics, quadratics] = [Degree::Cubic, Degree::Quadratic].map(|degree| {
            let (options, start) = (Options::new(tolerance).with_degree(degree), Instant::now());
            (0..500).for_each(|_| drop(simplify(&ring, &options).unwrap()));
            start.elapsed().as_secs_f64()
        });
        println!("circle within {tolerance}: {:.1} times the time of cubics", quadratics / cubics);
    }
}

/// A circle of `n` cubics.
fn ring(n: usize, radius: f64) -> BezPath {
    let angle = TAU / n as f64;
    let on = |i: usize| Vec2::from_angle(angle * i as f64) * radius;
    let along = |i: usize| on(i).turn_90() * (4.0 / 3.0 * (0.25 * angle).tan());
    let mut path = BezPath::new();
    path.move_to(on(0).to_point());
    for i in 0..n {
        path.curve_to((on(i) + along(i)).to_point(), (on(i + 1) - along(i + 1)).to_point(), on(i + 1).to_point());
    }
    path.close_path();
    path
}

/// Control points, and points on the curve that are not halfway between two of them.
fn counts(path: &BezPath) -> (usize, usize) {
    let segs: Vec<PathSeg> = path.segments().collect();
    let implied = |w: &[PathSeg]| match (w[0], w[1]) {
        (PathSeg::Quad(a), PathSeg::Quad(b)) => a.p2.distance(a.p1.midpoint(b.p1)) < 1e-9,
        _ => false,
    };
    let off = segs.iter().filter(|s| matches!(s, PathSeg::Quad(_))).count();
    (off, segs.len() - segs.windows(2).filter(|w| implied(w)).count())
}

/// The largest distance of points of `a` from `b`.
fn distance(a: &BezPath, b: &BezPath) -> f64 {
    let off = |p: Point| b.segments().map(|s| s.nearest(p, 1e-12).distance_sq).fold(f64::INFINITY, f64::min);
    let points = a.segments().flat_map(|s| (0..=200).map(move |i| s.eval(f64::from(i) / 200.0)));
    points.map(off).fold(0.0, f64::max).sqrt()
}
