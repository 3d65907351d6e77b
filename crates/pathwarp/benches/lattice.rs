//! Nanoseconds per point and per jet of the lattice maps, compared with de Casteljau's algorithm.
//!
//! Run with `cargo bench -p pathwarp --bench lattice`. Every figure is the best of 15 runs over 4096 points.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

use kurbo::{Point, Rect, Vec2};
use pathwarp::map::{Birational, Jet, Lattice, LatticeMap, Map, Rows};
use std::hint::black_box;
use std::time::Instant;

const REGION: Rect = Rect::new(0.0, 0.0, 100.0, 100.0);

fn best(count: usize, mut f: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..15 {
        let start = Instant::now();
        f();
        least = least.min(start.elapsed().as_secs_f64());
    }
    least * 1e9 / count as f64
}

fn lattice(m: usize, n: usize, weighted: bool) -> Lattice {
    let mut l = Lattice::regular(REGION, [m, n], [1, 1]);
    for j in 0..=n {
        for i in 0..=m {
            let k = (i * 7 + j * 5) as f64;
            l.shift(i, j, Vec2::new(10.0 * k.sin(), 10.0 * (1.7 * k).cos()));
            if weighted {
                l.set_weight(i, j, 1.0 + 0.3 * (2.1 * k).sin());
            }
        }
    }
    l
}

/// De Casteljau's algorithm for 4×4 points on the stack, without weights: rows first, then the column.
fn casteljau(net: &[[Point; 4]; 4], p: Point) -> Point {
    let (s, t) = (p.x / 100.0, p.y / 100.0);
    let curve = |mut c: [Point; 4], t: f64| {
        for n in (1..4).rev() {
            for i in 0..n {
                c[i] = c[i].lerp(c[i + 1], t);
            }
        }
        c[0]
    };
    curve(net.map(|row| curve(row, s)), t)
}

/// De Casteljau's algorithm straight from the definition: any degree, homogeneous coordinates, a division at the end.
fn definition(net: &[Vec<[f64; 3]>], p: Point) -> Point {
    let curve = |mut c: Vec<[f64; 3]>, t: f64| {
        for n in (1..c.len()).rev() {
            for i in 0..n {
                c[i] = [0, 1, 2].map(|k| c[i][k] + t * (c[i + 1][k] - c[i][k]));
            }
        }
        c[0]
    };
    let row = |row: &Vec<[f64; 3]>| curve(row.clone(), p.x / 100.0);
    let [x, y, w] = curve(net.iter().map(row).collect(), p.y / 100.0);
    Point::new(x / w, y / w)
}

/// As [`casteljau`], with derivatives from the last step but one.
fn casteljau_jet(net: &[[Point; 4]; 4], p: Point) -> Jet {
    let (s, t) = (p.x / 100.0, p.y / 100.0);
    let curve = |mut c: [Point; 4], t: f64| {
        for n in [3, 2] {
            for i in 0..n {
                c[i] = c[i].lerp(c[i + 1], t);
            }
        }
        (c[0].lerp(c[1], t), (c[1] - c[0]) * 3.0)
    };
    let rows = net.map(|row| curve(row, s));
    let (p, dt) = curve(rows.map(|r| r.0), t);
    let (ds, _) = curve(rows.map(|r| r.1.to_point()), t);
    Jet { p, dx: ds.to_vec2() / 100.0, dy: dt / 100.0 }
}

fn main() {
    let ps: Vec<Point> =
        (0..4096).map(|k| Point::new(f64::from(k % 64) * 1.5 + 1.0, f64::from(k / 64) * 1.5 + 1.0)).collect();
    let (mut out, mut jets) = (vec![Point::ORIGIN; ps.len()], vec![Jet::default(); ps.len()]);

    let l = lattice(3, 3, false);
    let net: [[Point; 4]; 4] = std::array::from_fn(|j| std::array::from_fn(|i| l.point(i, j)));
    let plain = [
        best(ps.len(), || ps.iter().zip(&mut out).for_each(|(p, o)| *o = casteljau(black_box(&net), *p))),
        best(ps.len(), || ps.iter().zip(&mut jets).for_each(|(p, o)| *o = casteljau_jet(black_box(&net), *p))),
    ];
    println!("{:34}{:>12}{:>12}", "", "ns/point", "ns/jet");
    let rows: Vec<Vec<[f64; 3]>> = net.iter().map(|row| row.iter().map(|p| [p.x, p.y, 1.0]).collect()).collect();
    let slow = best(ps.len(), || ps.iter().zip(&mut out).for_each(|(p, o)| *o = definition(black_box(&rows), *p)));
    println!("{:34}{:12.2}", "de Casteljau, any degree, weights", slow);
    println!("{:34}{:12.2}{:12.2}", "de Casteljau 3x3, unit weights", plain[0], plain[1]);

    let corners = |v: &[(f64, f64)]| v.iter().map(|p| Point::from(*p)).collect::<Vec<_>>();
    let top = corners(&[(0.0, 10.0), (30.0, -25.0), (70.0, 30.0), (100.0, 5.0)]);
    let bottom = corners(&[(5.0, 90.0), (35.0, 110.0), (60.0, 70.0), (95.0, 100.0)]);
    let birational = Birational::new(REGION, Rows::TopBottom, [&top, &bottom], None, false, ["", ""]).unwrap();
    let mut spline = Lattice::regular(REGION, [3, 3], [4, 4]);
    spline.shift(3, 3, Vec2::new(5.0, 3.0));
    let ffd = |m, n, weighted| LatticeMap::new(&lattice(m, n, weighted), false);
    let mut frozen = Lattice::regular(REGION, [3, 3], [1, 1]);
    frozen.shift(1, 1, Vec2::new(12.0, 9.0));
    frozen.shift(2, 2, Vec2::new(-9.0, 7.0));
    let entries: Vec<(&str, Box<dyn Map>)> = vec![
        ("ffd 3x3, unit weights", Box::new(ffd(3, 3, false))),
        ("ffd 3x3, unit weights, extended", Box::new(LatticeMap::new(&lattice(3, 3, false), true))),
        ("ffd 3x3, weights", Box::new(ffd(3, 3, true))),
        ("ffd 2x2, unit weights", Box::new(ffd(2, 2, false))),
        ("ffd 5x5, unit weights", Box::new(ffd(5, 5, false))),
        ("ffd 10x10, weights", Box::new(ffd(10, 10, true))),
        ("ffd 3x3, 4x4 cells", Box::new(LatticeMap::new(&spline, false))),
        ("ffd 3x3, inverse (Newton)", Box::new(LatticeMap::new(&frozen, false).inverse().unwrap())),
        ("birational 3x1", Box::new(birational.clone())),
        ("birational 3x1, inverse", Box::new(birational.inverted())),
    ];
    for (name, map) in &entries {
        let map: &dyn Map = map.as_ref();
        let point = best(ps.len(), || map.points(black_box(&ps), &mut out));
        let jet = best(ps.len(), || map.jets(black_box(&ps), &mut jets));
        let times = if name.starts_with("ffd 3x3, unit") {
            format!("   {:.1}x ({:.1}x) and {:.1}x as fast", plain[0] / point, slow / point, plain[1] / jet)
        } else {
            String::new()
        };
        println!("{name:34}{point:12.2}{jet:12.2}{times}");
    }
}
