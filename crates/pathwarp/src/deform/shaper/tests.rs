//! The shaper against the paper, its rules and its faults.

use super::*;
use crate::deform::Deformation as _;
use crate::outline::Seg;
use crate::param::Args;
use kurbo::ParamCurve;

const CAGE: &str = "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z";

fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
    ENTRY.build_from(&Args::from_pairs(pairs), &Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0)))
}

/// The box's sides land on the sides of the shaper to 1e-9.
#[test]
fn sides_land_on_sides() {
    let m = build(&[("shaper", CAGE)]).unwrap().map;
    let sides: Vec<CubicBez> = Outline::from_svg(CAGE).unwrap().segs().map(Seg::to_cubic).collect();
    for i in 0..=100 {
        let t = f64::from(i) / 100.0;
        let on = [(100.0 * t, 100.0), (100.0, 100.0 - 100.0 * t), (100.0 - 100.0 * t, 0.0), (0.0, 100.0 * t)];
        for (side, p) in sides.iter().zip(on) {
            assert!(m.point(p.into()).distance(side.eval(t)) < 1e-9);
        }
    }
}

/// The Base's anchors land on the Target's to 1e-9, for two or four anchors of either.
#[test]
fn base_lands_on_target() {
    let bases: [(&str, &[usize]); 2] = [("12,80 77,88", &[0, 1]), ("0,100 90,95 100,5 10,10", &[0, 1, 2, 3])];
    let targets = ["200,150 320,110", "210,160 300,170 330,40 190,60"];
    for (base, which) in bases {
        for target in targets {
            let m = build(&[("shaper", CAGE), ("base", base), ("target", target)]).unwrap().map;
            let parse = |t: &str| -> Vec<Point> {
                t.split(' ')
                    .map(|w| {
                        w.split_once(',').map(|(x, y)| Point::new(x.parse().unwrap(), y.parse().unwrap())).unwrap()
                    })
                    .collect()
            };
            let (b, t) = (parse(base), parse(target));
            for &i in which.iter().filter(|i| **i < t.len()) {
                assert!(m.point(b[i]).distance(t[i]) < 1e-9, "{base} {target} {i}: {:?}", m.point(b[i]));
            }
        }
    }
}

/// Cages with three or four corners on a line bend by F₀ alone (equation 6). With four targets, which need a projective map
/// (equation 10), they are refused by name.
#[test]
fn corners_on_a_line_are_refused_only_with_four_targets() {
    let four = "200,150 320,150 320,40 200,40";
    for cage in [
        "M0,100 C30,120 70,80 100,100 C110,80 90,60 100,50 C80,-10 60,10 100,0 C60,10 40,60 0,100 Z",
        "M0,0 C10,40 20,40 30,0 C35,20 55,20 60,0 C70,30 85,30 90,0 C60,-90 30,-90 0,0 Z",
    ] {
        let sides: Vec<CubicBez> = Outline::from_svg(cage).unwrap().segs().map(Seg::to_cubic).collect();
        let pairs = [("shaper", cage), ("bottom", "1"), ("base", "0,100 100,100")];
        for target in [None, Some("0,0 10,10")] {
            let map = build(&pairs.into_iter().chain(target.map(|t| ("target", t))).collect::<Vec<_>>()).unwrap().map;
            let (from, to) = (sides[0].p0, sides[0].p3);
            for i in 0..=20 {
                let t = f64::from(i) / 20.0;
                let side = sides[0].eval(t);
                let want = target.map_or(side, |_| {
                    // The similitude that takes the ends of the bottom side to (0, 0) and (10, 10).
                    let (p, along) = (side - from, to - from);
                    let (u, v) = (p.dot(along) / along.hypot2(), along.cross(p) / along.hypot2());
                    Point::new(10.0 * (u - v), 10.0 * (u + v))
                });
                assert!(map.point(Point::new(100.0 * t, 100.0)).distance(want) < 1e-9, "{cage} {t}");
            }
        }
        let error = build(&pairs.into_iter().chain([("target", four)]).collect::<Vec<_>>()).unwrap_err();
        assert!(
            matches!(&error, Error::Geometry(GeometryError::Collinear { path, .. }) if path == "shaper"),
            "{error}"
        );
    }
}

#[test]
fn the_net_given_in_full_equals_the_cage() {
    let by_cage = build(&[("shaper", CAGE)]).unwrap();
    let sides: Vec<CubicBez> = Outline::from_svg(CAGE).unwrap().segs().map(Seg::to_cubic).collect();
    let ring: [CubicBez; 4] = [sides[0], sides[1], sides[2], sides[3]];
    let net = complete_net(outer_net(&ring, &Arrangement { bottom: 0, reversed: false }));
    let points: Vec<String> = net.iter().flatten().map(|p| format!("{},{}", p.x, p.y)).collect();
    let rows: Vec<String> = net
        .iter()
        .map(|r| format!("M{},{} C{},{} {},{} {},{}", r[0].x, r[0].y, r[1].x, r[1].y, r[2].x, r[2].y, r[3].x, r[3].y))
        .collect();
    for by_net in [
        build(&[("net", &points.join(" "))]),
        build(&[("net", &rows.join(" "))]),
        build(&[("net", &rows[0]), ("net", &rows[1]), ("net", &rows[2]), ("net", &rows[3])]),
    ] {
        let by_net = by_net.unwrap();
        for p in [(0.0, 0.0), (30.0, 70.0), (110.0, -5.0)] {
            assert!(by_net.map.point(p.into()).distance(by_cage.map.point(p.into())) < 1e-10);
        }
    }
}

#[test]
fn the_lowest_side_is_the_bottom_and_can_be_overruled() {
    let m = |extra: &[(&str, &str)]| {
        let mut pairs = vec![("shaper", "M 0,0 L 100,0 L 100,100 L 0,100 Z")];
        pairs.extend(extra);
        build(&pairs).unwrap().map.point((10.0, 80.0).into())
    };
    let near = |p: Point, q: (f64, f64)| p.distance(q.into()) < 1e-12;
    assert!(near(m(&[]), (10.0, 80.0)));
    assert!(near(m(&[("reverse-shaper", "true")]), (90.0, 80.0)));
    // Side 1 is the top edge: the picture is turned upside down, not mirrored left to right.
    assert!(near(m(&[("bottom", "1")]), (10.0, 20.0)));
}

/// A box of 4 by 1 in a tilted cage of the same shape goes to its similar image, even at angles at which the paper's rule would
/// take a short side for the bottom.
#[test]
fn a_tilted_cage_does_not_turn_wide_artwork_on_its_side() {
    for degrees in [-80.0, -45.0, -15.0, 0.0, 10.0, 20.0, 45.0, 80.0_f64] {
        let turn = kurbo::Affine::translate((300.0, 100.0)) * kurbo::Affine::rotate(degrees.to_radians());
        let corners = [(0.0, 0.0), (200.0, 0.0), (200.0, 50.0), (0.0, 50.0)].map(|(x, y)| turn * Point::new(x, y));
        let cage: Vec<String> = corners.iter().map(|p| format!("{},{}", p.x, p.y)).collect();
        let build = |extra: &[(&str, &str)]| {
            let path = format!("M {} Z", cage.join(" L "));
            let mut pairs = vec![("shaper", path.as_str())];
            pairs.extend(extra);
            let args = Args::from_pairs(&pairs);
            ENTRY.build_from(&args, &Frame::new(Rect::new(0.0, 0.0, 80.0, 20.0))).unwrap()
        };
        let built = build(&[]);
        for p in [(0.0, 20.0), (80.0, 0.0), (30.0, 5.0)] {
            let (p, scaled) = (Point::from(p), Point::new(p.0 * 2.5, p.1 * 2.5));
            let q = built.map.point(p);
            assert!(q.distance(turn * scaled) < 1e-9, "{degrees}°: {p:?} goes to {q:?}, not {:?}", turn * scaled);
        }
        // The paper's rule takes the side with the lowest middle.
        let lowest = (0..4).map(|i| corners[i].y + corners[(i + 1) % 4].y).fold(f64::MIN, f64::max);
        let bottom = build(&[("bottom", "lowest")]).map.point(Point::new(40.0, 20.0));
        assert!((2.0 * bottom.y - lowest).abs() < 1e-9, "{degrees}°");
        assert!(built.explanation.warnings.is_empty() == (degrees.abs() < 60.0), "{:?}", built.explanation.warnings);
    }
}

#[test]
fn every_fault_is_named() {
    let fault = |pairs: &[(&str, &str)]| build(pairs).err().unwrap().to_string();
    let square = "0,0 100,0 100,100 0,100";
    assert!(fault(&[("shaper", "M0,0 L1,0 L1,1 L0,1 L0,0.5")]).contains("shaper is not closed"));
    assert!(fault(&[("shaper", "M0,0 L1,0 L1,1 Z")]).contains("has 3 anchors (0,0 1,0 1,1)"));
    let flat = ("shaper", "M0,0 L1,0 L2,0 L0,1 Z");
    assert!(fault(&[flat, ("target", square)]).contains("shaper: anchors 1, 2 and 3"));
    assert!(fault(&[("shaper", square), ("base", "5,5 5,5")]).contains("base: anchors 1 and 2 coincide at 5,5"));
    assert!(fault(&[("shaper", square), ("target", "0,0 1,0 2,0 0,1")]).contains("target: anchors 1, 2 and 3"));
    assert!(fault(&[("shaper", square), ("base", "1,1 2,2 3,5")]).contains("base has 3 anchors"));
    assert!(fault(&[("shaper", square), ("bottom", "5")]).contains("bottom: `5` is out of range"));
    assert!(fault(&[("shaper", square), ("base", "0,0 10,0 2,2 0,10")]).contains("hits infinity"));
    assert!(fault(&[]).contains("shaper is needed"));
    assert!(fault(&[("shaper", "M0,0 L1,0 L1,1 L0,1 Z M5,5 L6,6")]).contains("has 6 anchors"));
}
