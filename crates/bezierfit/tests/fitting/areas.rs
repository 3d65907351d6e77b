//! Offsets are at their distance from the source, and unions cover the area of their parts without crossing themselves.

use super::common::random_path;
use bezierfit::{Options, offset, stroke, union};
use kurbo::{BezPath, Cap, Join, ParamCurve, PathSeg, Point, Shape, Stroke, Vec2};
use pathwarp_oracle::{Polygon, Random, flat};
use std::f64::consts::PI;

const TOLERANCE: f64 = 0.02;

const CLOSED: [&str; 9] = [
    "M20 20H80V80H20Z",
    "M50 15L58 40H84L63 56L71 81L50 66L29 81L37 56L16 40H42Z",
    "M50 20C80 40 80 60 50 80C20 60 20 40 50 20Z",
    "M50 20C3 31 20 88 50 20Z",
    "M80 50C80 66.6 66.6 80 50 80C33.4 80 20 66.6 20 50C20 33.4 33.4 20 50 20C66.6 20 80 33.4 80 50Z",
    // A neck that parts, a hole, an area that crosses itself, one that is drawn the other way round.
    "M10 10H45V45H55V10H90V60H55V52H45V60H10Z",
    "M10 10H90V90H10ZM30 30V70H70V30Z",
    "M20 20L80 80L80 20L20 80Z",
    "M20 80H80L50 20Z",
];

const OPEN: [&str; 8] = [
    "M10 50C30 0 60 100 90 50",
    "M10 80L50 20L90 80",
    "M10 20H80V60H30V40H60",
    "M20 30C80 30 80 45 20 45",
    "M50 50C55 50 55 58 48 58C36 58 36 40 52 40C72 40 72 70 46 70C16 70 16 25 54 25",
    "M20 75C110 0 -10 0 80 75",
    "M20 20L80 20L20 25",
    "M30 30C80 75 20 75 70 30",
];

/// Largest distance of polygons from the curves for which they stand.
const FLAT: f64 = 1e-4;

fn samples(path: &BezPath) -> impl Iterator<Item = Point> + '_ {
    path.segments().flat_map(|s| (0..=20).map(move |i| s.eval(f64::from(i) / 20.0)))
}

fn grid() -> impl Iterator<Item = Point> {
    (0..70 * 70).map(|i| Point::new(f64::from(i % 70) * 2.3 - 29.7, f64::from(i / 70) * 2.3 - 29.7))
}

/// Checks offsets by several distances. Returns the number of those that report unresolved points.
fn check_area(path: &BezPath) -> usize {
    let mut unresolved = 0;
    let area = flat(path, FLAT);
    // Only edges between inside and outside count, and no cracks that are narrower than the tolerance.
    let parts = |[a, b]: &[Point; 2]| {
        let (middle, along) = (a.midpoint(*b), *b - *a);
        let aside = Vec2::new(-along.y, along.x) * (TOLERANCE / along.hypot());
        along.hypot() > 0.0 && area.covers(middle + aside) != area.covers(middle - aside)
    };
    let edges = Polygon::new(area.edges.iter().copied().filter(parts).collect());
    for by in [-26.0, -9.0, -2.0, -0.1, 0.1, 2.0, 9.0, 26.0] {
        let moved = offset(path, by, Join::Round, &Options::new(TOLERANCE)).unwrap();
        if !moved.report.unresolved.is_empty() {
            unresolved += 1;
            continue;
        }
        let what = format!("{} by {by}: {}", path.to_svg(), moved.path.to_svg());
        for p in samples(&moved.path) {
            let off = (edges.distance(p) - by.abs()).abs();
            assert!(off <= 1.02 * TOLERANCE, "{what}\n{p:?} is off by {off}");
        }
        let outline = flat(&moved.path, FLAT);
        for p in grid() {
            let to_edge = edges.distance(p);
            let inside = if by > 0.0 { area.covers(p) || to_edge < by } else { area.covers(p) && to_edge > -by };
            // The remaining area may be a sliver.
            let near = (to_edge - by.abs()).abs() < 3.0 * TOLERANCE || area.distance(p) < 1e-3;
            assert!(near || outline.covers(p) == inside, "{what}\n{p:?}, {to_edge} from the edge");
        }
    }
    unresolved
}

#[test]
fn areas_grow_and_shrink_by_their_distance() {
    for d in CLOSED {
        assert_eq!(check_area(&BezPath::from_svg(d).unwrap()), 0, "{d}");
    }
}

/// None of the cases that are hardest for a sweep panics: needles, edges along the axes, and edges on each other.
#[test]
fn degenerate_areas_are_swept() {
    let mut random = Random::new(5);
    for _ in 0..60 {
        let mut corner = || Point::new(random.below(6) as f64 * 20.0, random.below(6) as f64 * 20.0);
        let mut path = BezPath::new();
        for _ in 0..4 {
            path.move_to(corner());
            path.line_to(corner());
            path.curve_to(corner(), corner(), corner());
            path.line_to(corner());
            path.close_path();
        }
        assert!(union(&path, TOLERANCE).is_ok(), "{}", path.to_svg());
        for by in [-20.0, -1.0, 1.0, 20.0] {
            assert!(offset(&path, by, Join::Miter, &Options::new(TOLERANCE)).is_ok(), "{} by {by}", path.to_svg());
        }
    }
    assert!(union(&BezPath::new(), TOLERANCE).unwrap().is_empty());
}

#[test]
#[ignore = "known fault: an area that has a needle, shrunk by 9, is off by 2.4 tolerances at one place, and the report does not say so"]
fn random_areas_grow_and_shrink_by_their_distance() {
    let mut random = Random::new(3);
    let unresolved: usize = (0..16).map(|i| check_area(&random_path(&mut random, 2 * i))).sum();
    assert!(unresolved <= 3, "{unresolved} of 128");
}

#[test]
fn open_paths_run_beside_themselves() {
    for d in OPEN {
        let path = BezPath::from_svg(d).unwrap();
        let (segs, line): (Vec<PathSeg>, _) = (path.segments().collect(), flat(&path, 1e-7));
        for by in [-12.0, -2.0, -0.1, 0.1, 2.0, 12.0] {
            let beside = offset(&path, by, Join::Round, &Options::new(TOLERANCE)).unwrap().path;
            let what = format!("{d} by {by}: {}", beside.to_svg());
            for p in samples(&beside) {
                let off = (line.distance(p) - by.abs()).abs();
                assert!(off <= 1.02 * TOLERANCE, "{what}\n{p:?} is off by {off}");
            }
            // The result passes every point at the distance beside the path that is no nearer to another part of it.
            let result = flat(&beside, FLAT);
            for (s, i) in segs.iter().flat_map(|s| (1..40).map(move |i| (s, i))) {
                let t = f64::from(i) / 40.0;
                let along = (s.eval(t + 1e-6) - s.eval(t - 1e-6)) / s.eval(t + 1e-6).distance(s.eval(t - 1e-6));
                let p = s.eval(t) + Vec2::new(-along.y, along.x) * by;
                if line.distance(p) > by.abs() - 1e-6 {
                    let off = result.distance(p);
                    assert!(off <= 3.0 * TOLERANCE, "{what}\n{p:?} is not reached by {off}");
                }
            }
        }
    }
}

/// Winding numbers of the union are 0 where those of the parts are, else 1; and no two of its segments cross.
#[test]
fn unions_are_simple() {
    let mut random = Random::new(5);
    for i in 0..60 {
        let path = random_path(&mut random, i);
        let join = [Join::Miter, Join::Round, Join::Bevel][i % 3];
        let style = Stroke::new([1.0, 6.0, 20.0][i % 3]).with_join(join).with_caps(Cap::Square);
        let parts = stroke(&path, &style, &Options::new(TOLERANCE)).unwrap().path;
        let whole = union(&parts, TOLERANCE).unwrap();
        let what = format!("{}, {style:?}", path.to_svg());
        let (before, after) = (flat(&parts, FLAT), flat(&whole, FLAT));
        let sign = grid().map(|p| after.winding(p)).find(|w| *w != 0).unwrap_or(1);
        for p in grid().filter(|p| before.distance(*p) > 2.0 * TOLERANCE && after.distance(*p) > 1e-3) {
            assert_eq!(after.winding(p), if before.covers(p) { sign } else { 0 }, "{what}\n{p:?}");
        }
        // Crossings that flattening may cause do not count.
        assert_eq!(after.crossings(1e-3), 0, "{what}\n{}", whole.to_svg());
    }
}

/// However sharp a tip is, the edges around it run at the distance: a miter that would reach too far is cut off.
#[test]
fn tips_keep_their_distance() {
    const BY: f64 = 5.0;
    for degrees in [4.0, 15.0, 28.0, 30.0, 60.0_f64] {
        let half = (0.5 * degrees).to_radians();
        let tip = Point::new(200.0, 0.0);
        let mut needle = BezPath::new();
        needle.move_to(tip);
        needle.line_to((0.0, 200.0 * half.tan()));
        needle.line_to((0.0, -200.0 * half.tan()));
        needle.close_path();
        let grown = offset(&needle, BY, Join::Miter, &Options::new(TOLERANCE)).unwrap().path;
        let far = grown.bounding_box().x1 - tip.x;
        let wanted = (BY / half.sin()).min(4.0 * BY);
        assert!((far - wanted).abs() < 2.0 * TOLERANCE, "{degrees}°: {far} for {wanted}");
        let nearest = flat(&grown, FLAT).distance(tip);
        assert!((nearest - BY).abs() < 2.0 * TOLERANCE, "{degrees}°: {nearest}");
    }
}

/// Rough outlines of which most become bevels do not vanish, although bevels are nearer than the distance.
#[test]
fn rough_outlines_grow_by_bevels() {
    let points = (0..120).map(|i| {
        let (angle, r) = (f64::from(i) * PI / 60.0, if i % 2 == 0 { 30.0 } else { 31.2 });
        Point::new(r * angle.cos(), r * angle.sin())
    });
    let mut path = BezPath::new();
    for (i, p) in points.enumerate() {
        if i == 0 { path.move_to(p) } else { path.line_to(p) }
    }
    path.close_path();
    let grown = offset(&path, 12.0, Join::Bevel, &Options::new(0.05)).unwrap().path;
    let area = grown.area().abs();
    // The area is between those of the circles up to the edges at inner corners and up to the tips at outer corners.
    assert!((PI * 40.0_f64.powi(2)..PI * 43.3_f64.powi(2)).contains(&area), "{area}");
}

/// Rough outlines with many nodes within the distance of each other keep it: a flower with a hole whose middle closes.
#[test]
fn rough_outlines_keep_their_distance() {
    const POINTS: u32 = 1500;
    const TOLERANCE: f64 = 0.05;
    let mut random = Random::new(62);
    let mut path = BezPath::new();
    for (radius, lobes) in [(90.0, 9.0), (20.0, 5.0)] {
        for i in 0..POINTS {
            let angle = f64::from(i) * 2.0 * PI / f64::from(POINTS) * if lobes == 9.0 { 1.0 } else { -1.0 };
            let r = radius + 0.1 * radius * (lobes * angle).cos() + random.between(-0.3, 0.3);
            let p = Point::new(r * angle.cos(), r * angle.sin());
            if i == 0 { path.move_to(p) } else { path.line_to(p) }
        }
        path.close_path();
    }
    let source = flat(&path, FLAT);
    for by in [-25.0, -6.0, 6.0, 17.0, 25.0_f64] {
        let moved = offset(&path, by, Join::Round, &Options::new(TOLERANCE)).unwrap();
        assert!(moved.report.unresolved.is_empty(), "{by}: {:?}", moved.report.unresolved);
        let result = flat(&moved.path, FLAT);
        for _ in 0..1500 {
            let p = Point::new(random.between(-130.0, 130.0), random.between(-130.0, 130.0));
            let apart = source.distance(p) * if source.covers(p) { -1.0 } else { 1.0 };
            if (apart - by).abs() > 2.0 * TOLERANCE {
                assert_eq!(result.covers(p), apart < by, "{by}: {p:?} at {apart}");
            }
        }
        let least = samples(&moved.path).map(|p| source.distance(p)).fold(f64::INFINITY, f64::min);
        assert!(least > by.abs() - 1.5 * TOLERANCE, "{by}: {least}");
    }
}
