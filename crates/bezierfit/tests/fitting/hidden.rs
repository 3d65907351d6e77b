//! Waves that fit the spacing of samples, measured densely at parameters that are independent of it.

use crate::common::{Drawn, off};
use bezierfit::{Assurance, Degree, Options, Source as _, fit};
use kurbo::{Point, Vec2};
use std::f64::consts::TAU;

/// Asserts that a fit is within its tolerance or reports that it is not.
#[track_caller]
fn honest(what: &str, source: &Drawn<'_>, n: u32) {
    const TOLERANCE: f64 = 0.05;
    let fitted = fit(source, &Options::new(TOLERANCE)).unwrap();
    let samples = 24 * n + 101;
    let place = |i: u32| (f64::from(i) + (f64::from(i) * 0.754_877_666_2).fract()) / f64::from(samples);
    let points: Vec<Point> = (0..samples).map(|i| source.eval(place(i)).0).collect();
    let r = &fitted.report;
    let off = off(&points, &fitted.path);
    assert!(off <= TOLERANCE || !r.unresolved.is_empty(), "{n} {what}: {off} is {}", r.max_error);
    assert_eq!(r.assurance, Assurance::Sampled, "{n} {what}");
}

fn cosine(n: f64) -> Drawn<'static> {
    let eval = move |t: f64| {
        let (s, c) = (TAU * n * t).sin_cos();
        (Point::new(400.0 * t, 5.0 * c), Vec2::new(400.0, -5.0 * TAU * n * s))
    };
    Drawn::new(eval, Vec::new())
}

fn flower(n: f64) -> Drawn<'static> {
    let eval = move |t: f64| {
        let (u, (s, c)) = (Vec2::from_angle(TAU * t), (n * TAU * t).sin_cos());
        ((u * (100.0 + 10.0 * c)).to_point(), (u * (-10.0 * n * s) + u.turn_90() * (100.0 + 10.0 * c)) * TAU)
    };
    Drawn::new(eval, Vec::new())
}

fn all_honest(numbers: impl Iterator<Item = u32>) {
    for n in numbers {
        honest("waves", &cosine(f64::from(n)), n);
        honest("petals", &flower(f64::from(n)), n);
    }
}

#[test]
fn waves_that_fit_the_samples_are_not_missed() {
    all_honest([2, 9, 16, 17, 33, 34, 35, 51, 66, 67, 68, 85, 102, 136, 153, 272].into_iter());
}

/// Quadratics are measured at closer samples, but there is no guarantee that they suffice.
#[test]
fn quadratics_of_unknown_curves_are_sampled() {
    let options = Options::new(0.05).with_degree(Degree::Quadratic);
    assert_eq!(fit(&cosine(9.0), &options).unwrap().report.assurance, Assurance::Sampled);
}

/// Run it with `cargo test --release -p bezierfit --test fitting hidden -- --ignored`.
#[test]
#[ignore = "all numbers take a minute"]
fn no_number_of_waves_is_missed() {
    all_honest(2..=300);
}
