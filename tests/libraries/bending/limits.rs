//! Cases that a single threshold of the refit decides.

use pathwarp::kurbo::{CubicBez, ParamCurveNearest, PathEl, Point, Vec2};
use pathwarp::map::{Crease, Creases, Formula, Jet, Level, Map, Real};
use pathwarp::refit::{Nodes, Options, RefittedPath, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use pathwarp_oracle::{Fold, Ripple};
use std::sync::Arc;

fn warp(d: &str, map: &dyn Map, tolerance: f64) -> RefittedPath {
    warp_path(&Outline::from_svg(d).unwrap(), map, &Options::new(tolerance).with_nodes(Nodes::Source)).unwrap()
}

fn single(seg: Seg) -> Outline {
    Outline { subpaths: vec![Subpath { start: seg.start(), segs: vec![seg], closed: false }] }
}

fn only_lines(w: &RefittedPath) -> bool {
    w.path.elements().iter().all(|e| matches!(e, PathEl::MoveTo(_) | PathEl::LineTo(_)))
}

/// Bends the plane on both sides of x = 500, and lifts the right side by a height.
struct Step(f64);

/// One side of a [`Step`].
struct Side(f64);
impl Formula for Side {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x, y + (x / 200.0).sin() * 30.0 + self.0)
    }
}

impl Map for Step {
    fn jet(&self, p: Point) -> Jet {
        Side(if p.x > 500.0 { self.0 } else { 0.0 }).jet(p)
    }
    fn creases(&self, out: &mut Creases) {
        out.push(Crease::kink(Level::Line { a: 1.0, b: 0.0, c: -500.0 }));
    }
    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Side(if inside.x > 500.0 { self.0 } else { 0.0 })))
    }
}

#[test]
fn a_tear_is_bridged_by_a_line_unless_it_is_rounding() {
    let pieces = |height: f64| warp("M400 300L600 310", &Step(height), 0.1).report.segments_out;
    let smooth = pieces(0.0);
    // A hundredth of the tolerance is the limit.
    assert_eq!(pieces(0.0005), smooth);
    assert_eq!(pieces(0.002), smooth + 1);
}

/// Smoothly joined segments on both sides of a tear are merged; a line joins the limits of the two sides.
#[test]
fn a_tear_between_merged_segments_is_bridged_by_a_line() {
    let d = "M400 300C420 300 440 300 460 300S520 300 540 300S580 300 600 300";
    for d in [
        d.to_owned(),
        Outline::from_svg(d).unwrap().subpaths[0].segs.iter().rev().fold(String::new(), |d, s| {
            let s = s.reversed().to_cubic();
            let start = if d.is_empty() { format!("M{} {}", s.p0.x, s.p0.y) } else { d };
            format!("{start}C{} {} {} {} {} {}", s.p1.x, s.p1.y, s.p2.x, s.p2.y, s.p3.x, s.p3.y)
        }),
    ] {
        let torn = warp(&d, &Step(40.0), 0.1);
        let edge = Side(0.0).point(Point::new(500.0, 300.0));
        let mut last = Point::ORIGIN;
        let lines = torn.path.elements().iter().filter_map(|e| {
            let from = std::mem::replace(&mut last, e.end_point().unwrap());
            matches!(e, PathEl::LineTo(_)).then_some([from, last])
        });
        let [[mut a, mut b]] = lines.collect::<Vec<_>>()[..] else { panic!("{:?}", torn.path) };
        if a.y > b.y {
            (a, b) = (b, a);
        }
        assert!(a.distance(edge) < 1e-9 && b.distance(edge + Vec2::new(0.0, 40.0)) < 1e-9, "{a:?} {b:?}");
    }
}

/// Segments on one side of a tear that touch it in a node have an image without a gap.
#[test]
fn a_tear_that_is_touched_in_a_node_is_not_crossed() {
    for d in ["M600 300L500 310L600 340", "M600 280C560 280 500 290 500 310S560 340 600 340"] {
        let outline = Outline::from_svg(d).unwrap();
        let touching = warp_path(&outline, &Step(40.0), &Options::new(0.1).with_nodes(Nodes::Fewest)).unwrap();
        let [beyond, node] = [0.0, 40.0].map(|side| Side(side).point(Point::new(500.0, 310.0)));
        let near = |p: Point| touching.path.segments().any(|s| s.nearest(p, 1e-9).distance_sq < 0.011);
        assert!(near(node) && !near(beyond), "{:?}", touching.path);
    }
}

struct Same;
impl Formula for Same {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x * 0.8 - y * 0.6, x * 0.6 + y * 0.8)
    }
}

#[test]
fn a_handle_of_rounding_length_has_no_direction() {
    // The handle at (100, 500) is 1e-11 long and points down, but the curve leaves to the right: the joint is smooth.
    let outline = "M0 500H100C100 500.00000000001 300 500 500 700";
    for map in [&Same as &dyn Map, &pathwarp_oracle::Bicubic::mild()] {
        let w = warp(outline, map, 0.01);
        let out = pathwarp_oracle::cubics(&w.path);
        assert!(pathwarp_oracle::largest_turn(&out) < 0.01, "{}", pathwarp_oracle::largest_turn(&out));
    }
}

#[test]
fn the_tangent_at_a_cusp_of_the_image_is_its_limit() {
    // The fold runs through p, and the curve leaves along the kernel of the Jacobian.
    let p = Point::new(503.75, 500.0);
    let seg =
        Seg::Cubic(CubicBez::new(p, p + Vec2::new(100.0, -6.0), Point::new(700.0, 600.0), Point::new(800.0, 700.0)));
    let image = |t: f64| Fold.point(seg.eval(t));
    let limit = image(1e-4) - image(0.0);
    for tolerance in [1.0, 0.01] {
        let w = warp_path(&single(seg), &Fold, &Options::new(tolerance)).unwrap();
        let leaving = pathwarp_oracle::leaving(&pathwarp_oracle::cubics(&w.path)[0]);
        assert!(pathwarp_oracle::turn(leaving, limit) < 0.1, "{tolerance}: {leaving:?}, {limit:?}");
    }
}

#[test]
fn lines_far_from_the_origin_remain_lines() {
    assert!(only_lines(&warp("M1000000000 1000000000L1000000100 1000000033", &Same, 0.1)));
}

/// The identity, with as much rounding as coordinates of two million have.
struct Rounding;
impl Formula for Rounding {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x + 2e6 - 2e6, y + 2e6 - 2e6)
    }
}

#[test]
fn rounding_inside_a_map_keeps_lines() {
    assert!(only_lines(&warp("M10.1 20.3L910.7 333.3L20.2 910.4", &Rounding, 1e-7)));
}

#[test]
fn handles_of_nearly_straight_pieces_stay_even() {
    for height in [1e-3, 1e-2, 0.05] {
        let w = warp("M0 300H200H600H900", &Ripple(height), 0.1);
        for c in pathwarp_oracle::cubics(&w.path) {
            let chord = (c.p3 - c.p0).hypot();
            for handle in [c.p1 - c.p0, c.p3 - c.p2] {
                let share = handle.hypot() / chord;
                assert!((0.2..0.45).contains(&share), "{height}: {share} in {c:?}");
            }
        }
    }
}

#[test]
fn merging_keeps_corners_that_the_tolerance_would_hide() {
    // Two arcs that meet at 2°: their ends are within the tolerance of a smooth curve.
    let outline = Outline::from_svg("M100 500C200 480 300 470 400 470C500 473.5 600 487 700 510").unwrap();
    let options = Options::new(1.0).with_nodes(Nodes::Fewest);
    let w = warp_path(&outline, &pathwarp_oracle::Bicubic::mild(), &options).unwrap();
    assert_eq!(w.report.segments_out, 2);
    assert!(pathwarp_oracle::largest_turn(&pathwarp_oracle::cubics(&w.path)) > 1.0);
}
