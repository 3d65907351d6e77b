//! Compares outlines of strokes, by winding numbers at many points, with the area that a stroke covers: the points within half its width of
//! the path, or of its segments for other joins and caps.

use super::common::random_path;
use bezierfit::{Options, stroke};
use kurbo::{BezPath, Cap, Join, ParamCurve, Point, Shape, Stroke, Vec2};
use pathwarp_oracle::{Random, flat};

const SHAPES: [(&str, &str); 34] = [
    ("leaf", "M50 10C90 40 90 70 50 90C10 70 10 40 50 10Z"),
    ("leaf of one", "M50 10C100 60 0 60 50 10Z"),
    ("petal", "M50 90C0 0 100 0 50 90Z"),
    ("two segments", "M20 20L80 70C60 90 30 60 20 20Z"),
    ("two lines", "M20 20L80 70Z"),
    ("triangle", "M20 80L50 20L80 80Z"),
    ("nearly closed", "M15,80L40,20 80,60 15,80.00001Z"),
    ("star", "M50 5L61 39H98L68 59L79 95L50 73L21 95L32 59L2 39H39Z"),
    ("hook", "M20 20C80 20 80 30 20 30"),
    ("tight hook", "M20 50C80 50 80 52 20 52"),
    ("cusp", "M20 20C80 80 20 80 80 20"),
    ("near cusp", "M20 20C80.1 80 20 80 80 20"),
    ("loop", "M10 80C110 0 -10 0 90 80"),
    ("crossing", "M10 10L90 90L90 10L10 90Z"),
    ("spiral", "M50 50C55 50 55 58 48 58C36 58 36 40 52 40C72 40 72 70 46 70C16 70 16 25 54 25"),
    ("circle", "M80 50C80 66.6 66.6 80 50 80C33.4 80 20 66.6 20 50C20 33.4 33.4 20 50 20C66.6 20 80 33.4 80 50Z"),
    ("zigzag", "M10 50L12 40L14 50L16 40L18 50L60 50L61 49"),
    ("no first handle", "M20 20C20 20 60 80 80 20"),
    ("no last handle", "M20 20C40 80 80 20 80 20"),
    ("no last handle, straight", "M20 20C20 20 80 70 80 70"),
    ("two handles at the start", "M20 20C20 20 20 20 80 60"),
    ("handles swapped", "M20 20C80 60 80 60 80 60"),
    ("points inside", "M20 20L20 20C20 20 20 20 20 20C30 50 60 60 80 20Z"),
    ("zero line before the end", "M20 20L80 20L50 70Z"),
    ("back and forth", "M20 20C90 20 -20 20 80 20"),
    ("crossed handles", "M20 70C90 10 10 10 80 70"),
    ("one point twice", "M50 20C90 90 90 90 50 20"),
    ("tiny line", "M20 20L20.0000001 20L80 60"),
    ("tiny handles", "M20 20C20.0000001 20 79.99999999 60 80 60"),
    ("quadratic", "M20 20Q20 20 80 60Q90 10 20 20"),
    ("half turn", "M20 50A30 30 0 0 1 80 50"),
    (
        "sliver",
        "M81.87 28.24C77.17 29.34 77.57 30.04 77.57 30.04C77.87 30.54 79.17 29.84 79.17 29.84C82.87 28.64 81.87 28.24 81.87 28.24Z",
    ),
    ("lens", "M50 20C3 31 7 38 7 38C10 43 23 36 23 36C60 24 50 20 50 20Z"),
    ("line", "M20 20L80 60"),
];

/// With round joins and caps, a stroke covers all points within half its width of the path. As in all renderers, a loop may be bare
/// inside if its whole inside is nearer than that.
fn check(name: &str, path: &BezPath, width: f64, grid: i32) {
    let style = Stroke::new(width).with_join(Join::Round).with_caps(Cap::Round);
    let fitted = stroke(path, &style, &Options::new(0.01)).unwrap();
    assert!(fitted.report.unresolved.is_empty(), "{name}, {width} wide: {:?}", fitted.report);
    let (outline, line) = (flat(&fitted.path, 1e-4), flat(path, 1e-6));
    for i in 0..grid * grid {
        let at = |k: i32| f64::from(k) * 140.0 / f64::from(grid) - 20.0 + 0.37;
        let p = Point::new(at(i % grid), at(i / grid));
        let off = line.distance(p);
        if (off - 0.5 * width).abs() > 0.02 && outline.covers(p) != (off < 0.5 * width) {
            let far = path.segments().flat_map(|s| (0..=50).map(move |i| s.eval(f64::from(i) / 50.0).distance(p)));
            let far = far.fold(0.0, f64::max);
            assert!(far <= 0.5 * width + 1.0, "{name}, {width} wide, at {p:?}, {off} away: {}", path.to_svg());
        }
    }
}

#[test]
fn round_strokes_cover_what_is_near_the_path() {
    for (name, d) in SHAPES {
        for width in [0.1, 1.0, 4.0, 15.0, 40.0] {
            check(name, &BezPath::from_svg(d).unwrap(), width, 40);
        }
    }
}

fn check_random(seed: u64, paths: usize) {
    let mut random = Random::new(seed);
    for i in 0..paths {
        let path = random_path(&mut random, i);
        // A known fault: see `strands_that_nearly_touch_leave_nothing_bare`.
        if (seed, i) == (1, 114) {
            continue;
        }
        check(&format!("path {i}"), &path, [0.3, 2.0, 9.0, 33.0][i % 4], 30);
    }
}

#[test]
fn round_strokes_of_random_paths_cover_what_is_near_them() {
    check_random(1, 150);
}

#[test]
#[ignore = "known fault: some two square units between two strands stay bare, and the report does not say so"]
fn strands_that_nearly_touch_leave_nothing_bare() {
    let d = "M72.18388416282018 86.22897572756685C72.18388416282018 86.22897572756685 91.39840296535588 62.327193541393555 \
             92.67594597152069 96.76615970875062C88.07911861844637 33.92676434215183 47.98919133920556 63.07474338014174 \
             18.784964223684142 42.799671465025924C90.1010411345073 78.32548519926377 11.743575338250167 15.737197068885678 \
             89.19204322635288 5.795579720420108Z";
    check("strands", &BezPath::from_svg(d).unwrap(), 9.0, 30);
}

#[test]
#[ignore = "takes a minute: cargo test --release -p bezierfit --test fitting strokes -- --ignored"]
fn round_strokes_of_two_thousand_random_paths_cover_what_is_near_them() {
    check_random(2, 2000);
}

#[test]
fn all_strokes_are_finite_and_near() {
    for (name, d) in SHAPES {
        for (cap, join) in [(Cap::Butt, Join::Miter), (Cap::Round, Join::Bevel), (Cap::Square, Join::Round)] {
            for (width, dashes) in
                [(0.2, vec![]), (8.0, vec![5.0, 4.0]), (0.2, vec![0.0, 0.3]), (30.0, vec![1.0, 9.0, 4.0])]
            {
                let style = Stroke::new(width).with_caps(cap).with_join(join).with_dashes(0.0, dashes);
                let fitted = stroke(&BezPath::from_svg(d).unwrap(), &style, &Options::new(1e-3));
                let path = fitted.unwrap_or_else(|e| panic!("{name}, {style:?}: {e}")).path;
                let all = path.bounding_box();
                assert!(path.is_finite() && all.width() < 300.0 && all.height() < 300.0, "{name}, {style:?}: {all:?}");
            }
        }
    }
}

/// A path that misses its start by an invisible distance has a corner there, too.
#[test]
fn a_path_that_nearly_closes_has_all_its_miters() {
    let path = BezPath::from_svg("M150,300L200,165 310,250 150,300.00001Z").unwrap();
    let outline =
        stroke(&path, &Stroke::new(20.0).with_join(Join::Miter).with_miter_limit(10.0), &Options::new(0.1)).unwrap();
    assert_eq!(outline.path.segments().count(), 6, "{}", outline.path.to_svg());
    let covered = flat(&outline.path, 1e-4);
    let corners = [(150.0, 300.0), (200.0, 165.0), (310.0, 250.0)].map(Point::from);
    for i in 0..3 {
        let out = |j: usize| (corners[i] - corners[j]) / (corners[i] - corners[j]).hypot();
        let (u, v) = (out((i + 1) % 3), out((i + 2) % 3));
        // A miter's tip is at half the width over the sine of half the angle between the sides.
        let tip = 10.0 / ((1.0 - u.dot(v)) / 2.0).sqrt();
        let along: Vec2 = (u + v) / (u + v).hypot();
        assert!(covered.covers(corners[i] + along * (tip - 0.2)), "{i}");
        assert!(!covered.covers(corners[i] + along * (tip + 0.2)), "{i}");
    }
}
