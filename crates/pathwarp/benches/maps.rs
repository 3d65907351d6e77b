//! Nanoseconds per point and per jet of every deformation, built from its demo, compared with de Casteljau's algorithm.
//!
//! Run with `cargo bench -p pathwarp --bench maps`. Every figure is the best of 25 runs over 4096 points of the frame, in batches.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

use kurbo::{Point, Vec2};
use pathwarp::check;
use pathwarp::deform::Registry;
use pathwarp::map::{Creases, Jet, Map};
use pathwarp::param::Args;
use std::hint::black_box;
use std::time::Instant;

/// The best of several runs, in nanoseconds per item.
fn best(count: usize, mut f: impl FnMut()) -> f64 {
    const RUNS: usize = 25;
    let mut least = f64::INFINITY;
    for _ in 0..RUNS {
        let start = Instant::now();
        f();
        least = least.min(start.elapsed().as_secs_f64());
    }
    least * 1e9 / count as f64
}

/// A 3×3 lattice over the frame as rows of four control points, all of them moved.
fn net() -> Vec<Vec<Point>> {
    let at = |i: usize, j: usize| {
        let k = (i * 7 + j * 5) as f64;
        Point::new(100.0 * i as f64 / 3.0, 100.0 * j as f64 / 3.0) + Vec2::new(10.0 * k.sin(), 10.0 * (1.7 * k).cos())
    };
    (0..4).map(|j| (0..4).map(|i| at(i, j)).collect()).collect()
}

/// De Casteljau's algorithm of any degree, straight from the definition.
fn curve(mut c: Vec<Point>, t: f64) -> Point {
    for n in (1..c.len()).rev() {
        for i in 0..n {
            c[i] = c[i].lerp(c[i + 1], t);
        }
    }
    c[0]
}

/// The point of a net: rows first, then the column.
fn casteljau(net: &[Vec<Point>], p: Point) -> Point {
    let column = net.iter().map(|row| curve(row.clone(), p.x / 100.0)).collect();
    curve(column, p.y / 100.0)
}

/// As [`casteljau`], with derivatives from the differences of control points.
fn casteljau_jet(net: &[Vec<Point>], p: Point) -> Jet {
    let (s, t) = (p.x / 100.0, p.y / 100.0);
    let slopes =
        |c: &[Point]| c.windows(2).map(|w| ((w[1] - w[0]) * (c.len() - 1) as f64 / 100.0).to_point()).collect();
    let column: Vec<Point> = net.iter().map(|row| curve(row.clone(), s)).collect();
    let across: Vec<Point> = net.iter().map(|row| curve(slopes(row), s)).collect();
    let dy = curve(slopes(&column), t).to_vec2();
    Jet { p: curve(column, t), dx: curve(across, t).to_vec2(), dy }
}

/// De Casteljau's algorithm for degree 3×3 only, without allocation.
fn unrolled(net: &[[Point; 4]; 4], p: Point) -> Point {
    let curve = |mut c: [Point; 4], t: f64| {
        for n in (1..4).rev() {
            for i in 0..n {
                c[i] = c[i].lerp(c[i + 1], t);
            }
        }
        c[0]
    };
    curve(net.map(|row| curve(row, p.x / 100.0)), p.y / 100.0)
}

/// As [`unrolled`], with derivatives from the last step but one.
fn unrolled_jet(net: &[[Point; 4]; 4], p: Point) -> Jet {
    let (s, t) = (p.x / 100.0, p.y / 100.0);
    let curve = |mut c: [Point; 4], t: f64| {
        for n in [3, 2] {
            for i in 0..n {
                c[i] = c[i].lerp(c[i + 1], t);
            }
        }
        (c[0].lerp(c[1], t), (c[1] - c[0]) * 0.03)
    };
    let rows = net.map(|row| curve(row, s));
    let (p, dy) = curve(rows.map(|r| r.0), t);
    let (dx, _) = curve(rows.map(|r| r.1.to_point()), t);
    Jet { p, dx: dx.to_vec2(), dy }
}

fn timed(map: &dyn Map, ps: &[Point]) -> [f64; 2] {
    let (mut points, mut jets) = (vec![Point::ORIGIN; ps.len()], vec![Jet::default(); ps.len()]);
    [
        best(ps.len(), || map.points(black_box(ps), black_box(&mut points))),
        best(ps.len(), || map.jets(black_box(ps), black_box(&mut jets))),
    ]
}

fn row(name: &str, [point, jet]: [f64; 2]) {
    println!("| {name} | {point:.1} | {jet:.1} |");
}

fn main() {
    let frame = check::frame();
    let all: Vec<Point> =
        (0..4096).map(|k| Point::new(f64::from(k % 64) * 1.5 + 1.7, f64::from(k / 64) * 1.5 + 1.3)).collect();
    let registry = Registry::builtin();
    println!("| map | ns/point | ns/jet |\n|---|---|---|");
    for entry in registry.entries() {
        let info = entry.info();
        let map = entry.build_from(&Args::from_pairs(info.demo), &frame).unwrap().map;
        let mut creases = Creases::default();
        map.creases(&mut creases);
        let defined: Vec<Point> = all.iter().copied().filter(|p| creases.defined_at(*p)).collect();
        row(info.name, timed(&*map, &defined));
    }

    let net = net();
    let fixed: [[Point; 4]; 4] = std::array::from_fn(|j| std::array::from_fn(|i| net[j][i]));
    let mut args = Args::from_pairs(&[("degree", "3x3")]);
    for (j, points) in net.iter().enumerate() {
        for (i, p) in points.iter().enumerate() {
            args.push("at", format!("{i},{j}:{},{}", p.x, p.y));
        }
    }
    let ffd = registry.get("ffd").unwrap().build_from(&args, &frame).unwrap().map;
    for p in &all {
        let (a, b, c) = (ffd.jet(*p), casteljau_jet(&net, *p), unrolled_jet(&fixed, *p));
        for j in [b, c] {
            assert!(a.p.distance(j.p) + (a.dx - j.dx).hypot() + (a.dy - j.dy).hypot() < 1e-10, "{a:?} {j:?}");
        }
        assert!(casteljau(&net, *p).distance(unrolled(&fixed, *p)) < 1e-12);
    }
    let (mut points, mut jets) = (vec![Point::ORIGIN; all.len()], vec![Jet::default(); all.len()]);
    let mut plain = |point: &dyn Fn(&[Point], &mut [Point]), jet: &dyn Fn(&[Point], &mut [Jet])| {
        [
            best(all.len(), || point(black_box(&all), black_box(&mut points))),
            best(all.len(), || jet(black_box(&all), black_box(&mut jets))),
        ]
    };
    let any =
        plain(&|ps, out| ps.iter().zip(out).for_each(|(p, o)| *o = casteljau(black_box(&net), *p)), &|ps, out| {
            ps.iter().zip(out).for_each(|(p, o)| *o = casteljau_jet(black_box(&net), *p));
        });
    let small =
        plain(&|ps, out| ps.iter().zip(out).for_each(|(p, o)| *o = unrolled(black_box(&fixed), *p)), &|ps, out| {
            ps.iter().zip(out).for_each(|(p, o)| *o = unrolled_jet(black_box(&fixed), *p));
        });
    let ours = timed(&*ffd, &all);
    println!();
    println!("| lattice 3×3, unit weights | ns/point | ns/jet |\n|---|---|---|");
    row("`ffd`", ours);
    row("de Casteljau, any degree", any);
    row("de Casteljau, for 3×3 alone", small);
    let times = |other: [f64; 2]| format!("{:.1} and {:.1}", other[0] / ours[0], other[1] / ours[1]);
    println!("\n`ffd` is {} times as fast as the former, {} times as the latter.", times(any), times(small));
}
