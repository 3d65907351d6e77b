//! Nodes as a type designer puts them: at extremes, with handles along the axes, and alike on both sides of an axis of symmetry.

use pathwarp::deform::Registry;
use pathwarp::kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveExtrema, PathSeg, Point, Rect, Vec2};
use pathwarp::map::Map;
use pathwarp::param::{Args, Frame};
use pathwarp::refit::{Nodes, Options, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use pathwarp_oracle::Random;
use std::sync::Arc;

/// The frame of all maps, symmetrical about both axes.
const SIZE: f64 = 100.0;

/// Builds a deformation of the registry, in a frame.
pub(super) fn built_in(name: &str, args: &[(&str, &str)], frame: Rect) -> Arc<dyn Map> {
    Registry::builtin().get(name).unwrap().build_from(&Args::from_pairs(args), &Frame::new(frame)).unwrap().map
}

fn built(name: &str, args: &[(&str, &str)]) -> Arc<dyn Map> {
    built_in(name, args, Rect::new(-SIZE, -SIZE, SIZE, SIZE))
}

/// Returns maps that are symmetrical about x = 0.
fn symmetrical() -> [Arc<dyn Map>; 8] {
    let style = |style: &str, bend: &str| built("warp", &[("style", style), ("bend", bend)]);
    [
        style("inflate", "50%"),
        style("arch", "40%"),
        style("bulge", "60%"),
        style("fisheye", "50%"),
        style("shell-lower", "30%"),
        style("squeeze", "40%"),
        built("projective", &[("target", "-60,-100 60,-100 100,100 -100,100")]),
        built("bulge", &[("amount", "0.5")]),
    ]
}

fn mirrored(p: Point) -> Point {
    Point::new(-p.x, p.y)
}

/// Returns half of a contour, from a point at the top of the axis to one at its bottom: smooth joints and corners, extremes with handles
/// along the axes, lines, and nodes anywhere.
fn half(random: &mut Random) -> Vec<Seg> {
    let count = 1 + random.below(5);
    let mut nodes: Vec<(Point, Vec2)> = Vec::new();
    for i in 0..=count {
        let y = -70.0 + 140.0 * i as f64 / count as f64;
        let (x, tangent) = if i == 0 || i == count {
            (0.0, Vec2::new(if i == 0 { 1.0 } else { -1.0 }, 0.0))
        } else {
            let along = [Vec2::new(0.0, 1.0), Vec2::from_angle(random.between(0.3, 2.8))];
            (random.between(15.0, 75.0), random.one_of(&along))
        };
        nodes.push((Point::new(x, y + random.between(-8.0, 8.0)), tangent));
    }
    let mut out = Vec::new();
    for w in nodes.windows(2) {
        let ([(p, t), (q, u)], far) = ([w[0], w[1]], w[0].0.distance(w[1].0));
        let mut handle = || far * random.between(0.2, 0.5);
        let cubic = CubicBez::new(p, p + t * handle(), q - u * handle(), q);
        if random.below(6) == 0 {
            out.push(Seg::Line(pathwarp::kurbo::Line::new(p, q)));
        } else if random.below(4) == 0 {
            // Cut in two, with a node anywhere.
            let t = random.between(0.2, 0.8);
            out.extend([cubic.subsegment(0.0..t), cubic.subsegment(t..1.0)].map(Seg::Cubic));
        } else {
            out.push(Seg::Cubic(cubic));
        }
    }
    // Each segment begins where the one before ends, to the last bit.
    let mut joined: Vec<Seg> = Vec::new();
    for s in out {
        joined.push(match (joined.last(), s) {
            (Some(last), Seg::Cubic(c)) => Seg::Cubic(CubicBez { p0: last.end(), ..c }),
            (_, s) => s,
        });
    }
    joined
}

fn mirror(s: &Seg) -> Seg {
    match s.reversed() {
        Seg::Line(l) => Seg::Line(pathwarp::kurbo::Line::new(mirrored(l.p0), mirrored(l.p1))),
        other => {
            let c = other.to_cubic();
            Seg::Cubic(CubicBez::new(mirrored(c.p0), mirrored(c.p1), mirrored(c.p2), mirrored(c.p3)))
        }
    }
}

/// Returns a contour that is symmetrical about x = 0.
fn drawing(random: &mut Random) -> Outline {
    let mut segs = half(random);
    segs.extend(segs.clone().iter().rev().map(mirror));
    Outline { subpaths: vec![Subpath { start: segs[0].start(), segs, closed: true }] }
}

fn cubics(path: &BezPath) -> Vec<CubicBez> {
    path.segments().map(|s| s.to_cubic()).collect()
}

/// Returns the largest distance between a control point and its counterpart in the nearest mirrored piece.
fn asymmetry(all: &[CubicBez]) -> f64 {
    let off = |a: &CubicBez, b: &CubicBez| {
        let b = [b.p3, b.p2, b.p1, b.p0].map(mirrored);
        [a.p0, a.p1, a.p2, a.p3].iter().zip(b).map(|(p, q)| p.distance(q)).fold(0.0, f64::max)
    };
    all.iter().map(|a| all.iter().map(|b| off(a, b)).fold(f64::INFINITY, f64::min)).fold(0.0, f64::max)
}

#[test]
fn a_circle_keeps_its_extremes_and_its_symmetry() {
    let k = 55.228475;
    let d = format!(
        "M100,0C100,{k} {k},100 0,100C-{k},100 -100,{k} -100,0C-100,-{k} -{k},-100 0,-100C{k},-100 100,-{k} 100,0Z"
    );
    let map = &symmetrical()[0];
    for nodes in [Nodes::Auto, Nodes::Extremes] {
        let warped = warp_path(&Outline::from_svg(&d).unwrap(), map, &Options::new(0.028).with_nodes(nodes)).unwrap();
        let all = cubics(&warped.path);
        let turned = |p: Point| Point::new(p.y, p.x);
        let swapped: Vec<_> =
            all.iter().map(|c| CubicBez::new(turned(c.p3), turned(c.p2), turned(c.p1), turned(c.p0))).collect();
        let same = |c: &CubicBez| swapped.iter().any(|s| s.p0.distance(c.p0) < 3e-4 && s.p1.distance(c.p1) < 3e-4);
        assert!(all.len() <= 12 && asymmetry(&all) < 3e-4 && all.iter().all(same), "{}", warped.path.to_svg());
        let (beyond, off) = missed(&warped.path);
        assert!(beyond <= 1e-9 && off == 0.0, "{beyond} {off}");
    }
}

#[test]
fn symmetrical_drawings_stay_symmetrical_node_by_node() {
    let (mut random, tolerance) = (Random::new(63), 0.02);
    let (mut failed, all) = (Vec::new(), 300);
    for i in 0..all {
        let outline = drawing(&mut random);
        for (k, map) in symmetrical().iter().enumerate() {
            for nodes in [Nodes::Auto, Nodes::Extremes] {
                let warped = warp_path(&outline, map, &Options::new(tolerance).with_nodes(nodes)).unwrap();
                let off = asymmetry(&cubics(&warped.path));
                if off > 0.01 * tolerance {
                    failed.push((i, k, nodes, off, warped.report.segments_out, outline.to_bez_path(0.0).to_svg()));
                }
            }
        }
    }
    assert!(failed.is_empty(), "{} of {}: {:#?}", failed.len(), 16 * all, &failed[..failed.len().min(12)]);
}

/// Returns the distance by which pieces pass both of their ends along an axis, and the distance of handles at smooth extremes from it.
fn missed(path: &BezPath) -> (f64, f64) {
    let all: Vec<CubicBez> = cubics(path);
    let (mut beyond, mut off) = (0.0f64, 0.0f64);
    for (i, c) in all.iter().enumerate() {
        for t in c.extrema() {
            let p = c.eval(t);
            for v in [|p: Point| p.x, |p: Point| p.y] {
                let [a, b] = [v(c.p0), v(c.p3)];
                beyond = beyond.max(v(p) - a.max(b)).max(a.min(b) - v(p));
            }
        }
        let next = &all[(i + 1) % all.len()];
        if matches!(path.segments().nth(i), Some(PathSeg::Line(_))) || next.p0 != c.p3 {
            continue;
        }
        let (u, v) = (c.p3 - c.p2, next.p1 - next.p0);
        if u.cross(v).abs() > 1e-3 * u.hypot() * v.hypot() {
            continue;
        }
        for (a, b) in [
            (u.x * v.x, (c.eval(0.9).x - c.p3.x) * (next.eval(0.1).x - c.p3.x)),
            (u.y * v.y, (c.eval(0.9).y - c.p3.y) * (next.eval(0.1).y - c.p3.y)),
        ] {
            // Both neighbours lie on one side.
            if b > 0.0 {
                off = off.max(a.abs());
            }
        }
    }
    (beyond, off)
}

/// Between its nodes the image is monotone in either coordinate, so a piece within the tolerance of it passes its ends by the tolerance at
/// most. A missed extreme would pass them by more.
#[test]
fn every_extreme_of_the_result_has_a_node_with_handles_along_the_axis() {
    let (mut random, tolerance) = (Random::new(7), 0.02);
    for i in 0..60 {
        let outline = drawing(&mut random);
        for (k, map) in symmetrical().iter().enumerate() {
            let warped = warp_path(&outline, map, &Options::new(tolerance).with_nodes(Nodes::Extremes)).unwrap();
            let (beyond, off) = missed(&warped.path);
            let d = outline.to_bez_path(0.0).to_svg();
            assert!(
                beyond <= tolerance && off == 0.0,
                "{i} under {k}: {beyond} beyond, {off} off {d} {}",
                warped.path.to_svg()
            );
            let error = pathwarp_oracle::distance(&outline, &**map, &warped.path, 200, tolerance);
            assert!(error <= 1.0001 * tolerance, "{i} under {k}: {}", error / tolerance);
        }
    }
}
