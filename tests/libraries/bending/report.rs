//! Reports: exact images are reported as exact, and points at which the work budget ran out are listed.

use pathwarp::budget::{Budget, Limit, Limits};
use pathwarp::engine::RESOLUTION;
use pathwarp::kurbo::{Affine, ParamCurve, PathEl, Point, Vec2};
use pathwarp::map::{AffineMap, Formula, Homography, Jet, Map, Real};
use pathwarp::refit::{Assurance, Nodes, Options, warp_path};
use pathwarp::{GeometryError, Outline, Seg};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Bicubic, Run, distance, far};
use std::sync::Arc;

const DRAWING: &str =
    "M100 100L700 200C750 300 800 300 900 350Q500 400 620 800L300 700C200 600 150 300 100 100ZM200 500L400 650";

#[test]
fn affine_maps_move_control_points() {
    let m = Affine::new([1.2, 0.3, -0.4, 0.9, 30.0, -20.0]);
    let outline = Outline::from_svg(DRAWING).unwrap();
    for certify in [false, true] {
        let w = warp_path(&outline, &AffineMap(m), &Options::new(1e-6).with_certify(certify)).unwrap();
        assert_eq!(w.report.assurance, Assurance::Exact);
        assert_eq!(w.report.segments_out, w.report.segments_in);
        let want: Vec<_> = pathwarp_oracle::cubics(&outline.to_bez_path(1e-9)).into_iter().map(|c| m * c).collect();
        for (a, b) in pathwarp_oracle::cubics(&w.path).iter().zip(&want) {
            for (p, q) in [(a.p0, b.p0), (a.p1, b.p1), (a.p2, b.p2), (a.p3, b.p3)] {
                assert!(p.distance(q) < 1e-9, "{a:?} {b:?}");
            }
        }
    }
}

#[test]
fn projective_maps_keep_lines() {
    let corners = |w: f64| [(0.0, 0.0), (w, 0.0), (w, 1000.0), (0.0, 1000.0)].map(Point::from);
    let target = [(100.0, 0.0), (800.0, 150.0), (950.0, 900.0), (0.0, 700.0)].map(Point::from);
    let map = Homography::from_points(corners(1000.0), target).unwrap();
    let outline = Outline::from_svg(DRAWING).unwrap();
    let w = warp_path(&outline, &map, &Options::new(0.01)).unwrap();
    let lines: Vec<Point> =
        w.path.elements().iter().filter_map(|e| if let PathEl::LineTo(p) = e { Some(*p) } else { None }).collect();
    let want: Vec<Point> =
        outline.segs().filter_map(|s| if let Seg::Line(l) = s { Some(map.point(l.p1)) } else { None }).collect();
    assert_eq!(want.len(), 3);
    assert_eq!(lines.len(), want.len());
    assert!(lines.iter().zip(&want).all(|(p, q)| p.distance(*q) < 1e-9), "{lines:?} {want:?}");
}

#[test]
fn without_merging_every_node_of_the_source_stays_a_node() {
    let map = Bicubic::strong();
    let outline = Outline::from_svg(
        "M100 500C120 450 140 420 170 420S220 450 240 500 290 580 320 580 390 560 390 500H700C730 510 760 490 780 470",
    )
    .unwrap();
    for tolerance in [10.0, 1.0, 0.01] {
        let w = warp_path(&outline, &map, &Options::new(tolerance).with_nodes(Nodes::Source)).unwrap();
        let out = pathwarp_oracle::cubics(&w.path);
        // The nodes come in the order of the path.
        let mut nodes = out.iter().map(|c| c.p3);
        for s in outline.segs() {
            let want = map.point(s.end());
            assert!(nodes.any(|p| p.distance(want) < 1e-9), "{tolerance}: {want:?}");
        }
        assert_eq!(nodes.next(), None);
    }
}

/// A map torn along x = 500, without declaring a crease.
struct Torn;
impl Map for Torn {
    fn jet(&self, p: Point) -> Jet {
        let u = p.x / 300.0;
        let jump = if p.x > 500.0 { 100.0 } else { 0.0 };
        let dx = Vec2::new(1.0, 20.0 / 300.0 * u.cos());
        Jet { p: Point::new(p.x, p.y + 20.0 * u.sin() + jump), dx, dy: Vec2::new(0.0, 1.0) }
    }
}

#[test]
fn misfits_are_reported_with_their_place() {
    for d in ["M200 500L800 520", "M200 300C400 700 600 100 800 300", "M800 300Q500 100 200 900"] {
        let outline = Outline::from_svg(d).unwrap();
        let seg = *outline.segs().next().unwrap();
        for tolerance in [1.0, 0.01] {
            for (certify, merge) in [(false, false), (true, false), (false, true)] {
                let o = Options::new(tolerance).with_certify(certify).with_nodes(if merge {
                    Nodes::Fewest
                } else {
                    Nodes::Source
                });
                let w = warp_path(&outline, &Torn, &o).unwrap();
                let r = &w.report;
                assert!(!r.unresolved.is_empty(), "{d} {tolerance}");
                assert!(r.unresolved.iter().all(|p| (p.x - 500.0).abs() < 1e-3), "{d}: {:?}", r.unresolved);
                assert!(r.max_error > tolerance && r.assurance == Assurance::Sampled, "{d} {tolerance}: {r:?}");
                // The reported error is that of the line across the tear: half of its length, unless it comes near the image elsewhere.
                let image: Vec<Point> = (0..=4000).map(|i| Torn.point(seg.eval(f64::from(i) / 4000.0))).collect();
                let off = |p: Point| image.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min).sqrt();
                let places = w.path.segments().flat_map(|s| (0..=40).map(move |i| s.eval(f64::from(i) / 40.0)));
                let truth = places.map(off).fold(0.0, f64::max);
                assert!(r.max_error >= truth - 0.3 && r.max_error <= 1.1 * 50.0, "{d} {tolerance}: {truth} {r:?}");
                assert!(w.path.is_finite() && r.segments_out < 200, "{d} {tolerance}: {}", r.segments_out);
                // The rest of the image is within the tolerance.
                let image: Vec<Point> = (0..=500).map(|i| Torn.point(seg.eval(f64::from(i) / 500.0))).collect();
                let (e, p) = far(&image, &[Run::of(&w.path.curves()).sampled(40, tolerance)]);
                assert!(e <= tolerance, "{d} {tolerance}: {e} at {p:?}");
            }
        }
    }
}

/// More waves than the budget has pieces for.
struct Noise;
impl Formula for Noise {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x, y + (x * 1e4).sin() * 5.0)
    }
}

#[test]
fn the_budget_ends() {
    let outline = Outline::from_svg("M100 500C300 300 600 700 900 500").unwrap();
    for (certify, merge) in [(false, false), (true, true)] {
        let budget = Arc::new(Budget::new(Limits::default().with(Limit::Work, 5e6)));
        let options = Options::new(0.01)
            .with_certify(certify)
            .with_nodes(if merge { Nodes::Fewest } else { Nodes::Source })
            .with_budget(budget);
        let w = match warp_path(&outline, &Noise, &options) {
            Ok(w) => w,
            Err(e) => {
                assert!(matches!(&e, GeometryError::Limit(e) if e.limit == Limit::Work), "{e:?}");
                continue;
            }
        };
        assert!(!w.report.unresolved.is_empty());
        let truth = distance(&outline, &Noise, &w.path, 30_000, 1.0);
        assert!(w.report.max_error >= truth && w.report.max_error < 100.0, "{truth} {:?}", w.report);
        assert!(w.path.is_finite() && w.report.segments_out < 20_000, "{}", w.report.segments_out);
    }
}

/// Found by fuzzing: with a tolerance that rounding exceeds by less than a billionth, no point was named.
#[test]
fn a_tolerance_below_rounding_names_a_place() {
    let far = Outline::from_svg("M11e9 3h2v5").unwrap();
    let quarter_turn = AffineMap(Affine::rotate(std::f64::consts::FRAC_PI_2));
    let resolution = RESOLUTION * far.extent();
    let report = |tolerance: f64| warp_path(&far, &quarter_turn, &Options::new(tolerance)).unwrap().report;
    let missed = report(resolution * (1.0 - 1e-10));
    assert!(missed.resolution.is_some() && missed.unresolved.len() == 1, "{missed:?}");
    let met = report(resolution * (1.0 + 1e-10));
    assert!(met.resolution.is_none() && met.unresolved.is_empty(), "{met:?}");
}

/// A cone on the plane: the tip of √(x² + y²) has a value and no derivative.
struct Cone;
impl Formula for Cone {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let r = (x * x + y * y).sqrt();
        (x * (r * 0.01 + 1.0), y + r * 0.5)
    }
}

#[test]
fn a_formula_is_followed_through_the_tip_of_a_root() {
    for d in ["M0 0L80 30", "M-60 -20L0 0L50 5", "M0 0C20 40 60 -20 90 10", "M-70 1C-20 0 0 0 0 0"] {
        let outline = Outline::from_svg(d).unwrap();
        let w = warp_path(&outline, &Cone, &Options::new(0.01)).unwrap();
        assert!(w.report.unresolved.is_empty() && w.report.max_error <= 0.01, "{d}: {:?}", w.report);
        let image = |p: Point| {
            let r = p.to_vec2().hypot();
            Point::new(p.x * (r * 0.01 + 1.0), p.y + r * 0.5)
        };
        let places = outline.segs().flat_map(|s| (0..=997).map(move |i| s.eval(f64::from(i) / 997.0)));
        let images: Vec<Point> = places.map(image).collect();
        let (off, at) = far(&images, &[Run::of(&w.path.curves()).sampled(40, 0.01)]);
        assert!(off <= 0.01001, "{d}: {off} at {at}");
    }
}

/// √x has a value at 0, and an endless derivative.
struct Root;
impl Formula for Root {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x.sqrt(), y)
    }
}

#[test]
fn an_endless_derivative_at_an_end_is_an_error() {
    for d in ["M0 0L80 30", "M80 30L0 0", "M0 0C20 40 60 20 90 10"] {
        for merge in [false, true] {
            let refused = warp_path(
                &Outline::from_svg(d).unwrap(),
                &Root,
                &Options::new(0.01).with_nodes(if merge { Nodes::Fewest } else { Nodes::Source }),
            );
            assert!(
                matches!(refused, Err(pathwarp::GeometryError::Infinity { at, .. }) if at == Point::ORIGIN),
                "{d}: {refused:?}"
            );
        }
    }
}

#[test]
fn the_share_is_that_of_the_stated_error() {
    // Ten million units away, a tolerance of 1e-9 is below the rounding of coordinates.
    let outline = Outline::from_svg("M1e7 1e7h10v10").unwrap();
    let report = warp_path(&outline, &AffineMap(Affine::translate((5.0, 3.0))), &Options::new(1e-9)).unwrap().report;
    assert!(report.resolution.is_some());
    assert_eq!(report.share, report.max_error / 1e-9);
}

/// A pole along x = 90 + 2⁻³⁵, of first and of second order.
struct Pole;
impl Formula for Pole {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let w = (x * 0.0 + 1.0) / (x - 90.0 - 2f64.powi(-35));
        (w + x, w * w * (y - x) * 1e-9 + y)
    }
}

/// Near a pole, the rounding of the source is magnified, and the reported error covers it. Closer and closer to the pole, points of lines
/// that need no rounding have images that are exact to a few digits.
#[test]
fn the_error_near_a_pole_is_at_least_the_true_one() {
    for d in ["M26 7L90 11", "M26 64L90 0", "M90 90L26 -38", "M26 7Q58 8 90 11"] {
        let outline = Outline::from_svg(d).unwrap();
        let w = warp_path(&outline, &Pole, &Options::new(0.01)).unwrap();
        let seg = outline.segs().next().unwrap();
        let at = |t: f64| seg.eval(if seg.start().x == 90.0 { t } else { 1.0 - t });
        let images: Vec<Point> =
            (0..90).map(|k| Pole.point(at(2f64.powi(-k / 2) * if k % 2 == 0 { 1.0 } else { 0.75 }))).collect();
        let truth = far(&images, &[Run::of(&w.path.curves()).sampled(40, 0.01)]).0;
        println!("{d}: {truth}, {} stated", w.report.max_error);
        assert!(w.report.max_error >= truth, "{d}: {truth} {:?}", w.report);
    }
}
