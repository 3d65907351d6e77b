//! The measures used by other tests: each finds a known error.

use pathwarp::kurbo::{Point, Vec2};
use pathwarp_oracle::curves::{Curve, read};
use pathwarp_oracle::{Polygon, Run, apart, difference, kink, on_white};
use resvg::tiny_skia::{Color, Pixmap, PremultipliedColorU8};

/// Returns the distance between two paths.
fn between(a: &[Curve], b: &[Curve], n: usize, height: f64) -> f64 {
    apart(&Run::of(a).sampled(n, height), &Run::of(b).sampled(n, height)).0
}

/// An arc and its cubic have the distance given in textbooks.
#[test]
fn a_quarter_circle_has_its_error() {
    let k = 4.0 / 3.0 * std::f64::consts::FRAC_PI_8.tan();
    let (arc, cubic) = (&read("M1 0A1 1 0 0 1 0 1")[0], &read(&format!("M1 0C1 {k} {k} 1 0 1"))[0]);
    for n in [50, 400] {
        let found = between(arc, cubic, n, 1e-4);
        assert!((found - 2.7253e-4).abs() < 1e-6, "{n}: {found}");
    }
}

/// A needle that is much narrower than the spacing of samples, a cusp and a loop: the error is on one of the branches, at the tip, or
/// before a jump to the next piece.
#[test]
fn errors_at_hairpins_cusps_and_jumps_are_found() {
    let needle = |by: f64, tip: f64| read(&format!("M0 0C130 0 {tip} {by} 0 {by}"))[0].clone();
    for (by, tip, wanted) in [(0.01, 130.0, 0.0), (0.013, 130.0, 3e-3), (0.01, 130.4, 0.15)] {
        let found = between(&needle(0.01, 130.0), &needle(by, tip), 30, 1e-4);
        assert!((found - wanted).abs() <= 0.2 * wanted + 1e-12, "{by} {tip}: {found}");
    }
    let cusp = &read("M20 20C80 80 20 80 80 20")[0];
    // The needle without its last hundredth before the tip, on either side.
    let cut =
        |t: f64| Run::new(2, move |(i, u)| cusp[0].at(if i == 0 { u * (0.5 - t) } else { 0.5 + t + u * (0.5 - t) }));
    let whole = Run::of(cusp);
    for t in [0.01, 0.001] {
        let found = apart(&whole.sampled(100, 1e-5), &cut(t).sampled(100, 1e-5)).0;
        let wanted = cusp[0].at(0.5).distance(cusp[0].at(0.5 - t));
        assert!((found - wanted).abs() <= 0.02 * wanted, "{t}: {found} for {wanted}");
    }
    // A turn back at the very start, which the first two samples do not show.
    let [there, back] = ["M29 23C19 23 112 23 112 23", "M29 23L112 23"].map(|d| read(d).concat());
    assert!((between(&there, &back, 8, 1e-3) - 0.7523).abs() < 1e-3);
    let [two, one] = ["M0 0H10M12 0H20", "M0 0H20"].map(|d| read(d).concat());
    assert!((between(&two, &one, 64, 1e-3) - 1.0).abs() < 0.1);
}

/// Where a map tears, the line between the limits of both sides counts as part of the image, wherever the tear is.
#[test]
fn a_jump_is_a_line() {
    for tear in [0.0, 0.3711, 0.5, 1.0] {
        let torn = Run::new(1, move |(_, t)| Point::new(if t > tear { t + 5.0 } else { t }, 0.0));
        let whole = [Curve::Line([Point::ORIGIN, torn.at((0, 1.0))])];
        let found = apart(&torn.sampled(30, 1e-3), &Run::of(&whole).sampled(500, 1e-3)).0;
        assert!(found < 1e-9, "{tear}: {found}");
    }
}

#[test]
fn no_number_is_no_distance() {
    let hole = Run::new(1, |(_, t)| Point::new(t, if t > 0.5 { f64::NAN } else { 0.0 }));
    let line = [Curve::Line([Point::ORIGIN, Point::new(1.0, 0.0)])];
    assert!(apart(&hole.sampled(9, 0.1), &Run::of(&line).sampled(9, 0.1)).0.is_nan());
}

#[test]
fn polygons_wind_and_have_distances() {
    let square = |x: f64, side: f64| {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        Polygon::of_rings([&corners.map(|(a, b)| Point::new(x, 0.0) + Vec2::new(a, b) * side)[..]])
    };
    assert_eq!(square(0.0, 1.0).apart(&square(0.0, 1.0)), 0.0);
    assert!((square(0.0, 1.0).apart(&square(0.3, 1.0)) - 0.3).abs() < 1e-12);
    assert!((square(0.0, 1.0).apart(&square(0.0, 2.0)) - 2.0_f64.sqrt()).abs() < 1e-12);
    // A star of {n/2} winds twice around its middle and once in its tips. Compare with all edges, one by one.
    let n = 101;
    let corner = |i: usize| Vec2::from_angle(std::f64::consts::TAU * (2 * i % n) as f64 / n as f64).to_point();
    let star = Polygon::of_rings([&(0..n).map(corner).collect::<Vec<_>>()[..]]);
    assert_eq!([0.0, 0.9994, 1.1].map(|x| star.winding(Point::new(x, 1e-5))), [2, 1, 0]);
    for i in 0..60 {
        let p = Point::ORIGIN.lerp(corner(i), (i % 7) as f64 * 0.2);
        let to =
            |[a, b]: &[Point; 2]| (0..=100).map(|k| a.lerp(*b, f64::from(k) / 100.0).distance(p)).fold(9.0, f64::min);
        let slowly = star.edges.iter().map(to).fold(9.0, f64::min);
        assert!((star.distance(p) - slowly).abs() < 1e-3, "{p:?}");
    }
    assert_eq!(square(0.0, 1.0).crossings(0.0), 0);
    assert_eq!(
        Polygon::of_rings([&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(Point::from)[..]]).crossings(0.1),
        1
    );
}

#[test]
fn a_corner_where_the_image_is_smooth_is_found() {
    let exact = &read("M0 0C10 0 20 0 30 0C40 0 50 0 60 0")[0];
    for (up, degrees) in [(0.0, 0.0), (0.5, 5.71)] {
        let written = &read(&format!("M0 0C10 0 20 {up} 30 {up}C35 {up} 50 0 60 0").replace("20 0.5", "25 0"))[0];
        let (turn, at) = kink(&Run::of(exact).sampled(64, 0.1), written, (false, 1.0));
        assert!((turn - degrees).abs() < 0.1, "{turn} at {at:?}");
    }
}

#[test]
fn pictures_differ_by_what_was_changed() {
    let mut a = Pixmap::new(10, 10).unwrap();
    a.fill(Color::BLACK);
    let mut b = a.clone();
    // Three pixels differ by 7 in one channel, one by 200 in all colours.
    for pixel in &mut b.pixels_mut()[..3] {
        *pixel = PremultipliedColorU8::from_rgba(0, 7, 0, 255).unwrap();
    }
    b.pixels_mut()[99] = PremultipliedColorU8::from_rgba(200, 200, 200, 255).unwrap();
    let d = difference(&a, &b);
    assert_eq!([0, 6, 7, 199, 200].map(|t| d.share(t)), [0.04, 0.04, 0.01, 0.01, 0.0]);
    assert_eq!((d.most(), d.mean, d.painted), (200, (3.0 * 7.0 + 600.0) / 400.0, 1.0));
    let clear = Pixmap::new(10, 10).unwrap();
    assert_eq!((difference(&clear, &clear).painted, difference(&clear, &a).most()), (0.0, 255));
    assert_eq!(difference(&on_white(clear), &a).mean, 0.75 * 255.0);
}
