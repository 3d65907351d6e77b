//! Reports: exact images are reported as exact, and places at which the work budget ran out are listed.

use pathwarp::kurbo::{Affine, PathEl, Point, Vec2};
use pathwarp::map::{AffineMap, Formula, Homography, Jet, Map, Real};
use pathwarp::refit::{Assurance, Options, RESOLUTION, warp_path};
use pathwarp::{Outline, Seg};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Bicubic, Run, far};

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
        let w = warp_path(&outline, &map, &Options::new(tolerance)).unwrap();
        let out = pathwarp_oracle::cubics(&w.path);
        // In the order of the path.
        let mut nodes = out.iter().map(|c| c.p3);
        for s in outline.segs() {
            let want = map.point(s.end());
            assert!(nodes.any(|p| p.distance(want) < 1e-9), "{tolerance}: {want:?}");
        }
        assert_eq!(nodes.next(), None);
    }
}

/// Torn along x = 500, without declaring a crease.
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
                let o = Options::new(tolerance).with_certify(certify).with_merge(merge);
                let w = warp_path(&outline, &Torn, &o).unwrap();
                let r = &w.report;
                assert!(!r.over_budget.is_empty(), "{d} {tolerance}");
                assert!(r.over_budget.iter().all(|p| (p.x - 500.0).abs() < 1e-3), "{d}: {:?}", r.over_budget);
                assert!(r.max_error > tolerance && r.assurance == Assurance::Checked, "{d} {tolerance}: {r:?}");
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
        let w = warp_path(&outline, &Noise, &Options::new(0.01).with_certify(certify).with_merge(merge)).unwrap();
        assert!(!w.report.over_budget.is_empty() && w.report.max_error > 0.01);
        assert!(w.path.is_finite() && w.report.segments_out < 4000, "{}", w.report.segments_out);
    }
}

/// Found by fuzzing: with a tolerance that rounding exceeds by less than a billionth, no place was named.
#[test]
fn a_tolerance_below_rounding_names_a_place() {
    let far = Outline::from_svg("M11e9 3h2v5").unwrap();
    let quarter_turn = AffineMap(Affine::rotate(std::f64::consts::FRAC_PI_2));
    let resolution = RESOLUTION * far.extent();
    let report = |tolerance: f64| warp_path(&far, &quarter_turn, &Options::new(tolerance)).unwrap().report;
    let missed = report(resolution * (1.0 - 1e-10));
    assert!(missed.unresolved.is_some() && missed.over_budget.len() == 1, "{missed:?}");
    let met = report(resolution * (1.0 + 1e-10));
    assert!(met.unresolved.is_none() && met.over_budget.is_empty(), "{met:?}");
}
