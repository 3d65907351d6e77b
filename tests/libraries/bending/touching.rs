//! Paths that touch the creases of a map, in a node or between nodes, without crossing them, as symmetrical logos do.

use pathwarp::Outline;
use pathwarp::deform::{Bend, Stretch};
use pathwarp::kurbo::Point;
use pathwarp::map::{Crease, Creases, Formula, Jet, Level, Map, Real};
use pathwarp::refit::{Options, warp_path};
use std::sync::Arc;

/// Returns the distance between the image and the result.
fn apart(source: &Outline, map: &dyn Map, tolerance: f64, certify: bool) -> f64 {
    let w = warp_path(source, map, &Options::new(tolerance).with_certify(certify)).unwrap();
    pathwarp_oracle::distance(source, map, &w.path, 500, tolerance)
}

/// Shapes whose leftmost and rightmost points are the ends of the skeleton, to the last bit or nearly.
#[test]
fn shapes_that_touch_the_ends_of_a_skeleton_follow_it() {
    let along = Outline::from_svg("M20,170C180,60 356,60 516,170").unwrap();
    for d in [
        "M30,10H70a16.65,16.65 0 0 1 0,33.3H30a16.65,16.65 0 0 1 0,-33.3Z",
        "M50 10A33.3 21 0 0 1 50 52A33.3 21 0 0 1 50 10Z",
        "M10 10C-20 30 -20 40 10 60H90C120 40 120 30 90 10Z",
        "M10 10Q-20 35 10 60H90Q120 35 90 10Z",
        "M0 30C0 10 30 0 50 0S100 10 100 30S70 60 50 60S0 50 0 30Z",
    ] {
        for shift in [0.0, 1e-13, 0.1 + 0.2, 1e5] {
            let mut source = Outline::from_svg(d).unwrap();
            source = source.transformed(pathwarp::kurbo::Affine::translate((shift, 0.0)));
            let frame = source.bounding_box().unwrap();
            let map = Bend::new(frame, &along).stretch(Stretch::Fit).build().unwrap().map;
            for certify in [false, true] {
                let off = apart(&source, &map, 0.008, certify);
                assert!(off <= 0.008, "{d} moved by {shift}: {off}");
            }
        }
    }
}

/// Moves everything to the right of a line that it declares, and below a line that it does not declare.
struct Torn(f64);

impl Torn {
    fn moved(&self, p: Point, right: bool) -> Jet {
        let (x, y) = (p.x - self.0, p.y);
        let f = |a: f64| {
            Point::new(p.x + if right { a * x * x } else { 0.0 }, y + if y > 40.0 { (y - 40.0) * 0.5 } else { 0.0 })
        };
        let dx = if right { 1.0 + 0.02 * x } else { 1.0 };
        Jet { p: f(0.01), dx: (dx, 0.0).into(), dy: (0.0, if y > 40.0 { 1.5 } else { 1.0 }).into() }
    }
}

impl Map for Torn {
    fn jet(&self, p: Point) -> Jet {
        self.moved(p, p.x > self.0)
    }

    fn creases(&self, out: &mut Creases) {
        out.push(Crease::kink(Level::Line { a: 1.0, b: 0.0, c: -self.0 }));
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Branch { x: self.0, right: inside.x > self.0, below: inside.y > 40.0 }))
    }
}

struct Branch {
    x: f64,
    right: bool,
    below: bool,
}

impl Formula for Branch {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let d = x - self.x;
        let moved = if self.right { x + d * d * 0.01 } else { x };
        (moved, if self.below { y + (y - 40.0) * 0.5 } else { y })
    }
}

/// A crease that the map does not declare is found where its branch and the map begin to differ.
#[test]
fn results_are_judged_against_the_map() {
    let source = Outline::from_svg("M10 20C90 -10 90 90 15 75L80 10A30 30 0 0 1 20 60").unwrap();
    for x in [50.0, 80.0, 20.0] {
        assert!(apart(&source, &Torn(x), 1e-3, false) <= 1e-3);
    }
}

#[test]
fn a_level_is_crossed_where_sides_change_and_not_where_it_is_touched() {
    let count = |d: &str, level: &Level| {
        let mut ts = Vec::new();
        for s in Outline::from_svg(d).unwrap().segs() {
            level.crossings(s, &mut ts);
        }
        ts.len()
    };
    let line = |x: f64| Level::Line { a: 1.0, b: 0.0, c: -x };
    let field = |x: f64| Level::Field(Arc::new(move |p: Point| (p.x - x) * (1.0 + 0.001 * p.y * p.y)));
    for level in [line, field as fn(f64) -> Level] {
        assert_eq!(count("M30,10a16.65,16.65 0 0 0 0,33.3", &level(30.0 - 16.65)), 0);
        assert_eq!(count("M30,10a16.65,16.65 0 0 0 0,33.3", &level(30.0 - 16.6)), 2);
        assert_eq!(count("M30,10a16.65,16.65 0 0 0 0,33.3", &level(30.0 - 16.65 + 1e-5)), 2);
        assert_eq!(count("M0 0Q20 10 0 20", &level(10.0)), 0);
        assert_eq!(count("M0 0Q20 10 0 20", &level(10.0 - 1e-6)), 2);
        assert_eq!(count("M0 0C20 10 20 10 0 20", &level(15.0)), 0);
        assert_eq!(count("M10 0C10 10 0 30 20 40", &level(10.0)), 1);
        assert_eq!(count("M10 0V50", &level(10.0)), 0);
    }
}
