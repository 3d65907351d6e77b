use super::sample::{add, channels, color};
use super::*;
use crate::compare;
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::Map;
use pathwarp::map::{AffineMap, Chain, Formula, Homography, NewtonInverse, Real};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;
use tiny_skia::{Pixmap, PremultipliedColorU8};

fn grey(width: u32, height: u32, f: impl Fn(u32, u32) -> f64) -> Pixmap {
    let mut out = Pixmap::new(width, height).unwrap();
    for (i, p) in (0..).zip(out.pixels_mut()) {
        let v = (f(i % width, i / width) * 255.0).round() as u8;
        *p = PremultipliedColorU8::from_rgba(v, v, v, 255).unwrap();
    }
    out
}

/// Random colours and transparency.
fn noise(width: u32, height: u32) -> Pixmap {
    let mut out = Pixmap::new(width, height).unwrap();
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 24
    };
    for p in out.pixels_mut() {
        let a = next();
        let mut c = || (next() * a / 255) as u8;
        *p = PremultipliedColorU8::from_rgba(c(), c(), c(), a as u8).unwrap();
    }
    out
}

fn level(p: &Pixmap, x: u32, y: u32) -> f64 {
    f64::from(p.pixel(x, y).unwrap().red())
}

fn warped(source: &Pixmap, map: &dyn Map, target: Rect, size: (u32, u32)) -> Pixmap {
    let inverse = map.inverse().unwrap();
    warp_image(&ImageWarp {
        source,
        placed: Affine::IDENTITY,
        map,
        inverse: &*inverse,
        shown: shown(target, size),
        size,
    })
    .unwrap()
}

fn affine(source: &Pixmap, a: Affine, size: (u32, u32)) -> Pixmap {
    warped(source, &AffineMap(a), Rect::new(0.0, 0.0, f64::from(size.0), f64::from(size.1)), size)
}

/// Warps by brute force: averages the nearest source pixels at 16 × 16 points of every pixel.
fn truth(source: &Pixmap, inverse: &dyn Map, target: Rect, size: (u32, u32)) -> Pixmap {
    const N: u32 = 16;
    let mut out = Pixmap::new(size.0, size.1).unwrap();
    out.pixels_mut().par_iter_mut().enumerate().for_each(|(i, pixel)| {
        let (i, mut sum) = (i as u32, [0.0; 4]);
        for k in 0..N * N {
            let at = |p: u32, k: u32, size: u32| (f64::from(p) + (f64::from(k) + 0.5) / f64::from(N)) / f64::from(size);
            let q = Point::new(
                target.x0 + target.width() * at(i % size.0, k % N, size.0),
                target.y0 + target.height() * at(i / size.0, k / N, size.1),
            );
            let p = inverse.point(q);
            if p.x >= 0.0 && p.y >= 0.0 && p.x < f64::from(source.width()) && p.y < f64::from(source.height()) {
                add(&mut sum, channels(source.pixel(p.x as u32, p.y as u32).unwrap()), 1.0 / (N * N) as f32);
            }
        }
        *pixel = color(sum);
    });
    out
}

#[test]
fn the_identity_changes_nothing() {
    let source = noise(150, 97);
    assert!(compare(&source, &affine(&source, Affine::IDENTITY, (150, 97))).unwrap().is_same());
    // An undeclared identity inverted by Newton's method, with pixels that differ from the units of the plane.
    struct Still;
    impl Formula for Still {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y)
        }
    }
    let area = Rect::new(10.0, 20.0, 85.0, 68.5);
    let inverse = NewtonInverse::new(Arc::new(Still), area, 5.0, [1, 1]);
    let placed = Affine::translate((10.0, 20.0)) * Affine::scale(0.5);
    let warp = ImageWarp {
        source: &source,
        placed,
        map: &Still,
        inverse: &inverse,
        shown: shown(area, (150, 97)),
        size: (150, 97),
    };
    assert!(compare(&source, &warp_image(&warp).unwrap()).unwrap().is_same());
}

#[test]
fn whole_turns_and_shifts_move_pixels() {
    let source = noise(40, 30);
    let turned = affine(&source, Affine::new([0.0, 1.0, -1.0, 0.0, 32.0, 3.0]), (34, 50));
    for (x, y) in (0..34).flat_map(|x| (0..50).map(move |y| (x, y))) {
        // (u, v) maps to (32 − v, u + 3), and pixel centres to pixel centres.
        let (u, v) = (i64::from(y) - 3, 31 - i64::from(x));
        let expected = (0..40).contains(&u) && (0..30).contains(&v);
        let expected = expected.then(|| source.pixel(u as u32, v as u32).unwrap());
        assert_eq!(turned.pixel(x, y).unwrap(), expected.unwrap_or(PremultipliedColorU8::TRANSPARENT), "{x},{y}");
    }
}

#[test]
fn half_a_pixel_gives_the_average_of_the_cubic() {
    let source = grey(64, 5, |x, _| f64::from(x * 37 % 64) / 63.0);
    let shifted = affine(&source, Affine::translate((0.5, 0.0)), (65, 5));
    for x in 2..63 {
        let [a, b, c, d] = [2, 1, 0, -1].map(|k: i64| level(&source, (i64::from(x) - k) as u32, 2));
        let expected = ((-a + 9.0 * b + 9.0 * c - d) / 16.0).clamp(0.0, 255.0);
        assert!((level(&shifted, x, 2) - expected).abs() <= 0.5 + 1e-3, "{x}");
    }
    // Edge pixels are half covered.
    for x in [0, 64] {
        assert_eq!(shifted.pixel(x, 2).unwrap().alpha(), 128);
    }
}

#[test]
fn shrinking_does_not_alias() {
    // A zone plate: rings that get finer outwards, down to two pixels per ring at the middle of the sides.
    const SIZE: u32 = 1024;
    let middle = Point::new(0.5 * f64::from(SIZE), 0.5 * f64::from(SIZE));
    let plate = |p: Point| 0.5 + 0.5 * (PI / f64::from(SIZE) * (p - middle).hypot2()).cos();
    let source = grey(SIZE, SIZE, |x, y| plate(Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5)));
    for (shrink, angle) in [(8.0, 0.0), (3.0, 0.0), (5.3, 0.4), (10.0, 1.0)] {
        let size = (f64::from(SIZE) * 1.5 / shrink) as u32;
        let shift = Vec2::new(0.5, 0.5) * f64::from(size);
        let a = Affine::translate(shift)
            * Affine::rotate(angle)
            * Affine::scale(1.0 / shrink)
            * Affine::translate(-middle.to_vec2());
        let shrunk = affine(&source, a, (size, size));
        let (mut alias, mut points, mut coarse) = (Vec::new(), Vec::new(), Vec::new());
        for (x, y) in (0..size).flat_map(|x| (0..size).map(move |y| (x, y))) {
            let p = a.inverse() * Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let r = (p - middle).hypot();
            // Rings per pixel of the result. The limit is half a ring; beyond 0.75 only grey is right.
            let frequency = r / f64::from(SIZE) * shrink;
            let seen = level(&shrunk, x, y);
            if r > 0.5 * f64::from(SIZE) - 2.0 * shrink {
                continue;
            } else if frequency > 0.75 {
                alias.push(seen - 127.5);
                points.push(255.0 * plate(p) - 127.5);
            } else if frequency < 1.0 / 6.0 {
                coarse.push(seen - 255.0 * plate(p));
            }
        }
        let rms = |v: &[f64]| (v.iter().map(|v| v * v).sum::<f64>() / v.len() as f64).sqrt();
        let (alias, points, coarse) = (rms(&alias), rms(&points), rms(&coarse));
        println!(
            "1/{shrink} at {angle}: aliases {alias:.2}, without a filter {points:.1}; coarse rings off by {coarse:.2}"
        );
        assert!(points > 80.0, "without a filter it would alias: {points}");
        // At most a thirtieth of the aliasing is left, from rings just above the limit.
        assert!(alias < points / 30.0, "1/{shrink}: {alias}");
        assert!(coarse < 5.0, "1/{shrink}: {coarse}");
    }
}

#[test]
fn growing_keeps_edges_sharp_and_waves_whole() {
    // A step edge, enlarged eight times, rises from 10 to 90 % within a source pixel.
    let source = grey(40, 40, |x, _| if x < 20 { 0.2 } else { 0.8 });
    let large = affine(&source, Affine::scale(8.0), (320, 320));
    let row: Vec<f64> = (0..320).map(|x| (level(&large, x, 160) / 255.0 - 0.2) / 0.6).collect();
    let rise = row.iter().filter(|v| (0.1..0.9).contains(*v)).count();
    assert!((5..=8).contains(&rise), "{rise}");
    // Waves of eight pixels keep their amplitude.
    let wave = |x: f64| 0.5 + 0.4 * (2.0 * PI * x / 8.0).cos();
    let source = grey(64, 8, |x, _| wave(f64::from(x) + 0.5));
    let large = affine(&source, Affine::scale(4.0), (256, 32));
    for x in 16..240 {
        let off = (level(&large, x, 16) / 255.0 - wave((f64::from(x) + 0.5) / 4.0)).abs();
        assert!(off < 0.012, "{x}: {off}");
    }
    // The outline is sharp: all pixels up to the edge are opaque.
    assert!(large.pixels().iter().all(|p| p.alpha() == 255));
}

fn tilt() -> Homography {
    let unit = [(0.0, 0.0), (256.0, 0.0), (256.0, 256.0), (0.0, 256.0)].map(Point::from);
    let to = [(60.0, 20.0), (190.0, 35.0), (250.0, 240.0), (5.0, 215.0)].map(Point::from);
    Homography::from_points(unit, to).unwrap()
}

fn checkers() -> Pixmap {
    grey(256, 256, |x, y| f64::from((x / 16 + y / 16) % 2))
}

#[test]
fn a_checkerboard_in_perspective_matches_brute_force() {
    let (source, map) = (checkers(), tilt());
    let inverse = map.inverse().unwrap();
    for (target, size) in [
        (Rect::new(0.0, 0.0, 256.0, 256.0), (256, 256)),
        (Rect::new(-20.0, 0.0, 300.0, 256.0), (80, 64)),
        (Rect::new(60.0, 20.0, 124.0, 84.0), (200, 200)),
    ] {
        let (ours, brute) = (warped(&source, &map, target, size), truth(&source, &*inverse, target, size));
        let difference = compare(&ours, &brute).unwrap();
        println!("{size:?}: mean {:.3}/255, over 64: {:.4}", difference.mean_abs, difference.share_over(64));
        // Box and cubic averages differ only along the edges of the squares.
        assert!(difference.mean_abs < 2.5, "{size:?}: {}", difference.mean_abs);
        assert!(difference.share_over(64) < 0.01, "{size:?}: {}", difference.share_over(64));
        // The comparison is sensitive: an offset of half a pixel is detected.
        let off = Rect::new(target.x0 + 0.5 * target.width() / f64::from(size.0), target.y0, target.x1, target.y1);
        let shifted = compare(&warped(&source, &map, off, size), &brute).unwrap();
        assert!(shifted.mean_abs > 1.2 * difference.mean_abs, "{} {}", shifted.mean_abs, difference.mean_abs);
    }
}

#[test]
fn a_long_footprint_blurs_in_one_direction_only() {
    // Shrinking 8 times in x only leaves stripes along x unchanged.
    let stripes = grey(256, 64, |_, y| f64::from(y % 2));
    let out = affine(&stripes, Affine::scale_non_uniform(0.125, 1.0), (32, 64));
    for (x, y) in (0..32).flat_map(|x| (0..64).map(move |y| (x, y))) {
        assert!((level(&out, x, y) - 255.0 * f64::from(y % 2)).abs() <= 1.0, "{x},{y}");
    }
    let posts = grey(256, 64, |x, _| f64::from(x % 2));
    let out = affine(&posts, Affine::scale_non_uniform(0.125, 1.0), (32, 64));
    assert!((1..31).all(|x| (level(&out, x, 32) - 127.5).abs() <= 2.0));
}

#[test]
fn a_picture_bent_by_newton_matches_brute_force() {
    struct Bend;
    impl Formula for Bend {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x + (y / 40.0).sin() * 12.0, y * 0.8 + x * x * 0.001)
        }
    }
    let source = checkers();
    let area = Rect::new(0.0, 0.0, 256.0, 256.0);
    let inverse = NewtonInverse::new(Arc::new(Bend), area, 10.0, [6, 6]);
    let target = extent(area, Affine::IDENTITY, &Bend, Affine::IDENTITY).unwrap().bounds.expand();
    let size = (0.4 * target.width(), 0.4 * target.height());
    let size = (size.0 as u32, size.1 as u32);
    let warp = ImageWarp {
        source: &source,
        placed: Affine::IDENTITY,
        map: &Bend,
        inverse: &inverse,
        shown: shown(target, size),
        size,
    };
    let ours = warp_image(&warp).unwrap();
    let difference = compare(&ours, &truth(&source, &inverse, target, size)).unwrap();
    println!("mean {:.3}/255", difference.mean_abs);
    assert!(difference.mean_abs < 2.5, "{}", difference.mean_abs);
}

#[test]
fn edges_are_antialiased_even_where_the_inverse_ends() {
    struct Still;
    impl Formula for Still {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y)
        }
    }
    // The edge is at 0.75 of the outer pixels, whose centres have no inverse: a quarter of each is covered.
    let source = grey(70, 70, |_, _| 1.0);
    let inverse = NewtonInverse::new(Arc::new(Still), Rect::new(0.0, 0.0, 70.0, 70.0), 1e-9, [1, 1]);
    let target = Rect::new(-0.75, -0.75, 71.25, 71.25);
    let warp = ImageWarp {
        source: &source,
        placed: Affine::IDENTITY,
        map: &Still,
        inverse: &inverse,
        shown: shown(target, (72, 72)),
        size: (72, 72),
    };
    let out = warp_image(&warp).unwrap();
    let alpha = |x, y| out.pixel(x, y).unwrap().alpha();
    for k in 1..70 {
        assert_eq!([alpha(k, 0), alpha(0, k)], [64, 64], "{k}");
        // The far sides end three quarters into the last pixel but one.
        assert_eq!([alpha(k, 70), alpha(70, k)], [191, 191], "{k}");
    }
}

#[test]
fn nothing_is_drawn_beyond_the_horizon() {
    // The picture shrinks without bound towards the horizon; beyond it the inverse still has values.
    let map = Homography::new([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0 / 260.0, 1.0]]);
    let out = warped(&checkers(), &map, Rect::new(-500.0, -500.0, 500.0, 500.0), (400, 400));
    for (x, y) in (0..400).flat_map(|x| (0..150).map(move |y| (x, y))) {
        assert_eq!(out.pixel(x, y).unwrap().alpha(), 0, "{x},{y}");
    }
    assert!(out.pixel(250, 250).unwrap().alpha() > 0);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let (source, map) = (noise(300, 200), tilt());
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| warped(&source, &map, Rect::new(0.0, 0.0, 256.0, 256.0), (120, 333)))
    };
    assert!(compare(&run(1), &run(3)).unwrap().is_same());
}

#[test]
fn an_extent_is_the_bounding_box_of_the_image() {
    let area = Rect::new(0.0, 0.0, 256.0, 256.0);
    let e = extent(area, Affine::IDENTITY, &tilt(), Affine::IDENTITY).unwrap();
    let off = |a: Rect, b: Rect| (a.origin() - b.origin()).hypot() + (a.size().to_vec2() - b.size().to_vec2()).hypot();
    assert!(off(e.bounds, Rect::new(5.0, 20.0, 250.0, 240.0)) < 1e-9, "{:?}", e.bounds);
    assert!(e.undefined.is_none() && e.stretch > 1.0 && e.stretch < 2.0, "{}", e.stretch);
    let e = extent(
        area,
        Affine::IDENTITY,
        &AffineMap(Affine::rotate(0.3) * Affine::scale_non_uniform(3.0, 0.5)),
        Affine::IDENTITY,
    )
    .unwrap();
    assert!((e.stretch - 3.0).abs() < 1e-12);
    let cut = Homography::new([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -0.01, 1.0]]);
    assert!(extent(area, Affine::IDENTITY, &cut, Affine::IDENTITY).unwrap().undefined.is_some_and(|p| p.y >= 100.0));
    assert_eq!(extent(area, Affine::IDENTITY, &Chain::default(), Affine::IDENTITY).unwrap().bounds, area);
}
