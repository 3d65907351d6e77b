//! The shaper with the refitting: iso-lines, identity, and a great many random shapers.

use pathwarp::deform::Registry;
use pathwarp::kurbo::{BezPath, CubicBez, ParamCurve, PathEl, Point, Rect, Shape};
use pathwarp::map::{Formula, Map, Real};
use pathwarp::outline::Outline;
use pathwarp::param::{Args, Frame};
use pathwarp::recipe::{Recipe, Step};
use pathwarp::refit::{self, Options};
use pathwarp::{Error, GeometryError};
use proptest::prelude::*;
use std::sync::Arc;

const CAGE: &str = "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z";

fn shaper(pairs: &[(&str, &str)]) -> Result<Arc<dyn Map>, Error> {
    let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
    let recipe = Recipe { steps: vec![Step::new("shaper", Args::from_pairs(pairs))] };
    let built = recipe.build(&Registry::builtin(), frame, &std::iter::empty())?;
    Ok(Arc::new(built.map))
}

/// A straight line on an iso-line becomes exactly one cubic with the exact control points. These come from de Casteljau's algorithm on
/// the completed net, whose inner points follow from equation (7) as printed.
#[test]
fn iso_lines_are_exactly_one_cubic() {
    let map = shaper(&[("shaper", CAGE)]).unwrap();
    let net = net();
    let column = |v: f64| -> [Point; 4] {
        std::array::from_fn(|s| CubicBez::new(net[0][s], net[1][s], net[2][s], net[3][s]).eval(v))
    };
    let row = |u: f64| -> [Point; 4] {
        std::array::from_fn(|r| CubicBez::new(net[r][0], net[r][1], net[r][2], net[r][3]).eval(u))
    };
    for i in 0..=8 {
        let k = f64::from(i) / 8.0;
        let across = format!("M0,{} H100", 100.0 - 100.0 * k);
        let up = format!("M{},100 V0", 100.0 * k);
        let down = format!("M{},0 V100", 100.0 * k);
        let mut reversed = row(k);
        reversed.reverse();
        for (line, want) in [(across, column(k)), (up, row(k)), (down, reversed)] {
            let w = refit::warp_path(&Outline::from_svg(&line).unwrap(), &map, &Options::new(1e-6)).unwrap();
            let els: Vec<PathEl> = w.path.iter().collect();
            let [PathEl::MoveTo(a), PathEl::CurveTo(b, c, d)] = els[..] else { panic!("{line}: {els:?}") };
            for (got, want) in [a, b, c, d].iter().zip(want) {
                assert!(got.distance(want) < 1e-9, "{line}: {got:?} {want:?}");
            }
        }
    }
}

/// Returns the net of `CAGE`, with inner points by the paper's equation (7).
fn net() -> [[Point; 4]; 4] {
    let p = |x: f64, y: f64| Point::new(x, y);
    let mut n = [
        [p(10.0, 90.0), p(40.0, 110.0), p(60.0, 70.0), p(95.0, 85.0)],
        [p(0.0, 60.0), p(0.0, 0.0), p(0.0, 0.0), p(85.0, 60.0)],
        [p(15.0, 40.0), p(0.0, 0.0), p(0.0, 0.0), p(105.0, 40.0)],
        [p(5.0, 10.0), p(40.0, 35.0), p(60.0, -5.0), p(90.0, 15.0)],
    ];
    let v = |r: usize, s: usize| n[r][s].to_vec2();
    let p11 =
        v(0, 0) * -4.0 - (v(0, 3) + v(3, 0)) * 2.0 - v(3, 3) + (v(1, 0) + v(0, 1)) * 6.0 + (v(1, 3) + v(3, 1)) * 3.0;
    let p12 =
        v(0, 3) * -4.0 - (v(0, 0) + v(3, 3)) * 2.0 - v(3, 0) + (v(1, 3) + v(0, 2)) * 6.0 + (v(1, 0) + v(3, 2)) * 3.0;
    let p21 =
        v(3, 0) * -4.0 - (v(0, 0) + v(3, 3)) * 2.0 - v(0, 3) + (v(2, 0) + v(3, 1)) * 6.0 + (v(2, 3) + v(0, 1)) * 3.0;
    let p22 =
        v(3, 3) * -4.0 - (v(0, 3) + v(3, 0)) * 2.0 - v(0, 0) + (v(2, 3) + v(3, 2)) * 6.0 + (v(2, 0) + v(0, 2)) * 3.0;
    (n[1][1], n[1][2], n[2][1], n[2][2]) =
        ((p11 / 9.0).to_point(), (p12 / 9.0).to_point(), (p21 / 9.0).to_point(), (p22 / 9.0).to_point());
    n
}

/// The identity, in a form that no shortcut recognises.
struct Plain;
impl Formula for Plain {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x, y)
    }
}

/// The identity adds no segment, keeps lines lines, and moves nothing: both that of the shaper, which is recognised as affine, and one
/// that passes through the whole fitter.
#[test]
fn identity_gives_the_path_back() {
    let d = "M10,10 L40,10 C60,10 70,30 70,50 Q70,80 30,80 L10,60 Z M20,20 L30,20 30,30 Z M80,80 C80,80 90,85 95,95";
    let source = Outline::from_svg(d).unwrap();
    let straight = shaper(&[("shaper", "M0,100 L100,100 L100,0 L0,0 Z")]).unwrap();
    for map in [straight, Arc::new(Plain)] {
        let w = refit::warp_path(&source, &map, &Options::new(1e-4)).unwrap();
        assert_eq!(w.report.segments_in, w.report.segments_out);
        let kinds = |p: &BezPath| -> String {
            p.iter()
                .map(|e| match e {
                    PathEl::MoveTo(_) => 'M',
                    PathEl::LineTo(_) => 'L',
                    PathEl::QuadTo(..) | PathEl::CurveTo(..) => 'C',
                    PathEl::ClosePath => 'Z',
                })
                .collect()
        };
        assert_eq!(kinds(&w.path), "MLCCLZMLLZMC");
        let back = Outline::from(&w.path);
        for (a, b) in source.segs().zip(back.segs()) {
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                assert!(a.eval(t).distance(b.eval(t)) < 1e-9);
            }
        }
    }
}

fn point() -> impl Strategy<Value = Point> {
    // On a coarse grid, coincident and collinear points occur now and then.
    prop_oneof![
        3 => (-200.0..300.0f64, -200.0..300.0f64).prop_map(|(x, y)| Point::new(x, y)),
        1 => (0..4i32, 0..4i32).prop_map(|(x, y)| Point::new(f64::from(x) * 30.0, f64::from(y) * 30.0)),
    ]
}

fn cage() -> impl Strategy<Value = String> {
    prop_oneof![
        // A bent square, mostly valid.
        3 => prop::collection::vec((-25.0..25.0f64, -25.0..25.0f64), 12).prop_map(|d| {
            let corner = [(0.0, 100.0), (100.0, 100.0), (100.0, 0.0), (0.0, 0.0)];
            let p = |i: usize, k: f64| {
                let (a, b) = (corner[i / 3], corner[(i / 3 + 1) % 4]);
                let (dx, dy) = d[i];
                format!("{},{}", a.0 + (b.0 - a.0) * k + dx, a.1 + (b.1 - a.1) * k + dy)
            };
            let side = |i: usize| format!("C{} {} {}", p(3 * i + 1, 1.0 / 3.0), p(3 * i + 2, 2.0 / 3.0), p((3 * i + 3) % 12, 0.0));
            format!("M{} {} {} {} {} Z", p(0, 0.0), side(0), side(1), side(2), side(3))
        }),
        // Any points.
        1 => prop::collection::vec(point(), 3..14).prop_map(|p| {
            let s: Vec<String> = p.iter().map(|p| format!("{},{}", p.x, p.y)).collect();
            format!("M{} Z", s.join(" L"))
        }),
    ]
}

fn anchors() -> impl Strategy<Value = Option<String>> {
    let some = prop::collection::vec(point(), 1..6)
        .prop_map(|p| Some(p.iter().map(|p| format!("{},{}", p.x, p.y)).collect::<Vec<_>>().join(" ")));
    prop_oneof![1 => Just(None), 2 => some]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Random shapers, bases and targets never panic, loop or give numbers that are not finite; every failure has a name.
    #[test]
    fn random_shapers_warp_or_fail_by_name(cage in cage(), base in anchors(), target in anchors(), drawn in any::<bool>()) {
        let mut pairs = vec![("shaper", cage.as_str())];
        pairs.extend(base.iter().map(|b| ("base", b.as_str())));
        pairs.extend(target.iter().map(|t| ("target", t.as_str())));
        if drawn {
            pairs.extend([("base-as-drawn", "true"), ("target-as-drawn", "true")]);
        }
        let art = Outline::from_svg(
            "M20,50 A30,30 0 1 1 80,50 A30,30 0 1 1 20,50 Z M0,0 L100,100 M5,5 L95,5 95,95 Z M10,90 C30,-40 70,140 90,10 M50,50",
        ).unwrap();
        match shaper(&pairs) {
            Err(Error::Geometry(
                GeometryError::NotClosed { .. }
                | GeometryError::AnchorCount { .. }
                | GeometryError::Collinear { .. }
                | GeometryError::Coincident { .. }
                | GeometryError::NotConvex { .. },
            )) => {}
            Err(e) => prop_assert!(false, "{e}"),
            Ok(map) => match refit::warp_path(&art, &map, &Options::new(0.01)) {
                Err(GeometryError::Infinity { .. }) => {}
                Err(e) => prop_assert!(false, "{e}"),
                Ok(w) => {
                    prop_assert!(w.path.is_finite() && w.path.bounding_box().is_finite());
                    prop_assert_eq!(w.path.iter().filter(|e| matches!(e, PathEl::MoveTo(_))).count(), art.subpaths.len());
                    prop_assert!(w.report.max_error <= 0.01 || !w.report.unresolved.is_empty());
                }
            },
        }
    }
}
