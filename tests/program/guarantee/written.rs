//! Rounding: smooth joints stay smooth, flat arcs keep their positions, and artwork far away has the shape that it has near the origin.

use super::contours::{bent, paths};
use super::paths::path;
use pathwarp::kurbo::{Point, Vec2};
use pathwarp_oracle::curves::{self, Curve};
use pathwarp_oracle::{Random, Run, apart, far};
use std::fmt::Write as _;

/// Returns a chain of cubics that is smooth at every node, with handles of any length.
fn chain(r: &mut Random) -> String {
    let mut at = Point::new(r.between(0.0, 100.0), r.between(0.0, 100.0));
    let turn = |r: &mut Random| Vec2::from_angle(r.between(0.0, std::f64::consts::TAU));
    let length = |r: &mut Random| 10f64.powf(r.between(-4.0, 1.5));
    let mut away = turn(r);
    let mut d = format!("M0 0H100V100H0ZM{} {}", at.x, at.y);
    for _ in 0..8 {
        let into = turn(r);
        let end = Point::new(r.between(0.0, 100.0), r.between(0.0, 100.0));
        let (a, b) = (at + away * length(r), end - into * length(r));
        let _ = write!(d, "C{} {} {} {} {} {}", a.x, a.y, b.x, b.y, end.x, end.y);
        (at, away) = (end, into);
    }
    d
}

#[test]
fn short_handles_keep_smooth_joints_smooth() {
    let mut r = Random::new(5);
    let (mut joints, mut short) = (0, 0);
    for i in 0..60 {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d=\"{}\"/></svg>",
            chain(&mut r)
        );
        let angle = format!("{}", 7 * i);
        let (out, ..) = bent(&svg, "affine", &[("rotate", &angle)]);
        for run in paths(&out).iter().skip(1) {
            for w in run.windows(2) {
                let (into, away) = (w[0].directions()[1], w[1].directions()[0]);
                let turn = into.cross(away).atan2(into.dot(away)).abs().to_degrees();
                assert!(turn < 0.5, "{turn}° at {:?}: {svg}", w[1].at(0.0));
                joints += 1;
                short += usize::from(matches!(w[1], Curve::Cubic(p) if p[0].distance(p[1]) < 0.02));
            }
        }
    }
    assert!(joints > 400 && short > 100, "{joints} {short}");
}

#[test]
fn flat_arcs_stay_in_place() {
    let mut r = Random::new(3);
    for flat in [50.0, 800.0, 8e3, 1e5] {
        for _ in 0..10 {
            let (w, h) = (r.between(20.0, 50.0), r.between(20.0, 50.0));
            let (a, b) = (r.between(0.0, 6.0), r.between(0.5, 5.5));
            let at = |t: f64| format!("{} {}", 50.0 + w * t.cos(), 50.0 + h * t.sin());
            let d =
                format!("M0 0H100V100H0ZM{}A{w} {h} 0 {} 1 {}", at(a), u8::from(b > std::f64::consts::PI), at(a + b));
            let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d=\"{d}\"/></svg>");
            let turned = r.between(0.0, 90.0);
            let matrix = {
                let (s, c) = f64::to_radians(turned).sin_cos();
                format!("{c},{s},{},{},0,0", -s / flat, c / flat)
            };
            let (out, tolerance, image) = bent(&svg, "affine", &[("matrix", &matrix)]);
            let (source, written) = (curves::closed(paths(&svg)), curves::closed(paths(&out)));
            let fine = 0.01 * tolerance;
            let (exact, ours) = (Run::image(&source[1], &*image), Run::of(&written[1]));
            let (off, _) = apart(&exact.sampled(200, fine), &ours.sampled(200, fine));
            assert!(off < 0.05 * tolerance, "1 : {flat}: {off} of {tolerance}: {d} {matrix}");
        }
    }
}

/// The cage maps relative to the frame, so that artwork has the same image when it is moved.
#[test]
fn a_cage_far_away_bends_as_it_does_near() {
    let cage = |x: f64, y: f64| {
        let p = |u: f64, v: f64| format!("{},{} ", x + u, y + v);
        let mut d = format!("M{}", p(10.0, 90.0));
        for c in [
            [(60.0, 130.0), (60.0, 60.0), (95.0, 85.0)],
            [(75.0, 60.0), (115.0, 40.0), (90.0, 15.0)],
            [(60.0, -25.0), (40.0, 45.0), (5.0, 10.0)],
            [(25.0, 40.0), (-10.0, 60.0), (10.0, 90.0)],
        ] {
            d += &format!("C{}", c.map(|(u, v)| p(u, v)).concat());
        }
        d + "Z"
    };
    let mut r = Random::new(9);
    for far_away in [1e6, 3.67e7] {
        for _ in 0..60 {
            let d = path(&mut r).1;
            // The centre of half a turn is known only to the root of the last digit, and some paths are far from the origin by themselves.
            if d.contains(['A', 'a']) || d.contains("00000") {
                continue;
            }
            let drawn = |x: f64, y: f64, d: &str| {
                format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='{x} {y} 100 100'><path d=\"{d}\"/></svg>")
            };
            let moved = super::paths::shifted(&d, [far_away, -far_away]);
            let (_, tolerance, image) = bent(&drawn(0.0, 0.0, &d), "shaper", &[("shaper", &cage(0.0, 0.0))]);
            let there = [("shaper", &*cage(far_away, -far_away))];
            let (out, ..) = bent(&drawn(far_away, -far_away, &moved), "shaper", &there);
            let (source, written) = (curves::closed(curves::read(&moved)), curves::closed(paths(&out)));
            let away = Vec2::new(far_away, -far_away);
            let near = |ps: &[Point]| ps.iter().map(|p| *p - away).collect::<Vec<_>>();
            let image = |ps: &[Point], out: &mut [Point]| image(&near(ps), out);
            let back = |ps: &[Point], out: &mut [Point]| out.copy_from_slice(&near(ps));
            for (s, w) in source.iter().zip(&written) {
                let (exact, ours) = (Run::image(s, &image), Run::image(w, &back));
                let (off, _) = far(&exact.sampled(100, tolerance).points, &[ours.sampled(100, tolerance)]);
                // The numbers of the source are known to a ten-millionth there.
                assert!(off < 1.01 * tolerance + 1e-15 * far_away * 10.0, "{far_away}: {off} of {tolerance}: {d}");
            }
        }
    }
}
