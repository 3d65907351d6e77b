//! The default command gives small contours a smaller tolerance than the drawing, and shared edges the smallest.

use super::REGISTRY;
use pathwarp::kurbo::{Point, Rect};
use pathwarp_engine::Warper;
use pathwarp_oracle::curves::{self, Curve};
use pathwarp_oracle::{Random, Run, apart};
use std::collections::HashMap;
use std::fmt::Write as _;

fn bounds<'a>(curves: impl IntoIterator<Item = &'a Curve>) -> Rect {
    let points = curves.into_iter().flat_map(|c| (0..=256).map(|k| c.at(f64::from(k) / 256.0)));
    points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b)).unwrap_or_default()
}

fn diagonal(r: Rect) -> f64 {
    r.width().hypot(r.height())
}

/// Returns the tolerance of every subpath, by docs/refitting.md, in a drawing with the tolerance `tolerance`.
pub fn tolerances(subpaths: &[Vec<Curve>], tolerance: f64) -> Vec<f64> {
    let of_drawing = 1e4 * tolerance;
    let own = |s: &Vec<Curve>| (2e-3 * diagonal(bounds(s))).min(1e-4 * of_drawing).max(1e-7 * of_drawing);
    subpaths.iter().map(own).collect()
}

/// The paths of a drawing.
pub fn paths(svg: &str) -> Vec<Vec<Curve>> {
    svg.split("<path d=\"").skip(1).flat_map(|p| curves::read(p.split_once('"').unwrap().0)).collect()
}

/// Maps points, many at a time.
type Points = dyn Fn(&[Point], &mut [Point]);

/// A result of the default command, with its tolerance and the map.
pub fn bent(svg: &str, deformation: &str, values: &[(&str, &str)]) -> (String, f64, Box<Points>) {
    let warper = Warper::new(&REGISTRY, deformation, values).unwrap();
    let super::Done { svg, tolerance, map } = super::done(&warper, svg, "").unwrap();
    (svg, tolerance, Box::new(move |points, out| map.points(points, out)))
}

/// Returns an A0 poster in millimetres: dots of 1.2 mm and letters of 3 mm, also within one path.
fn poster() -> String {
    let mut d = String::from("M0 0H841V1189H0Z");
    let mut dots = String::new();
    for i in 0..40 {
        let (x, y) = (20.0 + f64::from(i % 8) * 101.3, 30.0 + f64::from(i / 8) * 233.7);
        let dot = format!("M{x} {y}a.6 .6 0 0 1 1.2 0a.6 .6 0 0 1 -1.2 0z");
        *if i % 2 == 0 { &mut d } else { &mut dots } += &dot;
        let (x, y) = (x + 9.0, y + 11.0);
        let _ = write!(
            d,
            "M{x} {y}c0 -1.9 2.6 -2.1 2.7 -.1c.1 2.2 -2.6 2.3 -2.7 .1zm.5 .05c.1 1.2 1.7 1.1 1.7 -.1c-.1 -1.2 -1.7 -1.1 -1.7 .1zm3 -1.6q1.9 -.4 2 1.4v1.6h-.5v-1.5q0 -1.2 -1.4 -1z"
        );
    }
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 841 1189'><path d=\"{d}\"/><path d=\"{dots}\"/></svg>"
    )
}

#[test]
fn dots_and_letters_of_a_poster_stay_round() {
    let svg = poster();
    for (name, values) in [
        ("warp", &[("style", "flag"), ("bend", "50%")][..]),
        ("swirl", &[("angle", "200")]),
        ("bulge", &[("amount", "60%")]),
        ("affine", &[("rotate", "30")]),
    ] {
        let (out, tolerance, image) = bent(&svg, name, values);
        let (source, written) = (curves::closed(paths(&svg)), curves::closed(paths(&out)));
        assert_eq!(source.len(), written.len());
        assert!((tolerance - 1e-4 * 841f64.hypot(1189.0)).abs() < 1e-9);
        let held = tolerances(&source, tolerance);
        assert!(held.iter().filter(|t| **t < 0.1 * tolerance).count() > 100);
        for ((s, w), held) in source.iter().zip(&written).zip(held) {
            let (exact, ours) = (Run::image(s, &*image), Run::of(w));
            let (a, _) = apart(&exact.sampled(200, held), &ours.sampled(200, held));
            assert!(a <= super::KEPT * held, "{name}: {a} for {held} near {:?}", s[0].at(0.0));
        }
    }
}

/// A map of countries of very different sizes, which share curved borders.
fn countries(r: &mut Random) -> String {
    const N: usize = 9;
    // Lines that crowd at one end.
    let at = |i: usize| 1000.0 * (i as f64 / (N - 1) as f64).powi(5);
    let mut nodes = vec![];
    let mut handles = vec![];
    for j in 0..N {
        for i in 0..N {
            let room = |k: usize| if k + 1 < N { at(k + 1) - at(k) } else { at(k) - at(k - 1) };
            let small = room(i).min(room(j));
            nodes.push(Point::new(at(i) + r.between(-0.2, 0.2) * small, at(j) + r.between(-0.2, 0.2) * small));
            handles.push([r.between(-0.2, 0.2), r.between(-0.2, 0.2)]);
        }
    }
    let node = |i: usize, j: usize| nodes[j * N + i];
    let mut out = String::new();
    for j in 0..N - 1 {
        for i in 0..N - 1 {
            let round = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let mut d = format!("M{} {}", node(i, j).x, node(i, j).y);
            for k in 0..4 {
                let (from, to) = (round[k], round[(k + 1) % 4]);
                // One border in either direction.
                let (a, b) = if from < to { (from, to) } else { (to, from) };
                let (p, q) = (node(a.0, a.1), node(b.0, b.1));
                let side = (q - p).turn_90();
                let [s, t] = handles[a.1 * N + a.0];
                let mut h = [p.lerp(q, 0.3) + side * s, p.lerp(q, 0.7) + side * t];
                if from > to {
                    h.reverse();
                }
                let end = node(to.0, to.1);
                let _ = write!(d, "C{} {} {} {} {} {}", h[0].x, h[0].y, h[1].x, h[1].y, end.x, end.y);
            }
            let _ = write!(out, "<path d=\"{d}Z\"/>");
        }
    }
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1000 1000'>{out}</svg>")
}

#[test]
fn borders_of_large_and_small_countries_stay_one_curve() {
    let key = |c: &Curve| {
        let p = match *c {
            Curve::Cubic(p) => p,
            Curve::Quad([a, b, c]) => [a, b, b, c],
            _ => panic!("{c:?}"),
        };
        let mut p = p.map(|p| (p.x.to_bits(), p.y.to_bits()));
        if p[0] > p[3] {
            p.reverse();
        }
        p
    };
    let count = |svg: &str| {
        let mut seen: HashMap<_, usize> = HashMap::new();
        for s in paths(svg) {
            s.iter().filter(|c| !matches!(c, Curve::Line(_))).for_each(|c| *seen.entry(key(c)).or_default() += 1);
        }
        let twice = seen.values().filter(|n| **n == 2).count();
        (twice, seen.len() - twice)
    };
    let mut r = Random::new(11);
    for (name, values) in [
        ("warp", &[("style", "flag"), ("bend", "50%")][..]),
        ("swirl", &[("angle", "200")]),
        ("polar", &[]),
        ("affine", &[("rotate", "30")]),
    ] {
        let svg = countries(&mut r);
        let (borders, coast) = count(&svg);
        assert_eq!((borders, coast), (112, 32));
        let (out, ..) = bent(&svg, name, values);
        let (shared, alone) = count(&out);
        // Only the coast, of 32 segments, is not shared.
        assert!(shared >= borders && alone <= 4 * coast, "{name}: {shared} shared, {alone} alone");
    }
}
