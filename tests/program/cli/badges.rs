//! `pathwarp badge`, and paths that stay with the text on them.

use super::common::text;
use crate::support::{expect_code, root};
use pathwarp::Outline;
use pathwarp::kurbo::{BezPath, ParamCurve as _, Point, Shape};
use pathwarp_svg::{Document, ReadOptions};
use std::f64::consts::TAU;

#[track_caller]
fn badge(args: &[&str]) -> (String, String) {
    let center = root().join("samples/icons/cup.svg").display().to_string();
    expect_code(0, &[&["badge"], args, &["--center", &center, "-o", "-"]].concat())
}

/// The paths of the group with an id.
fn group(svg: &str, id: &str) -> Vec<BezPath> {
    let (_, rest) = svg.split_once(&format!(" id=\"{id}\"")).unwrap_or_else(|| panic!("no group {id}: {svg:.400}"));
    let data = rest.split("</g>").next().unwrap().split(" d=\"").skip(1);
    data.map(|d| Outline::from_svg(d.split('"').next().unwrap()).unwrap().to_bez_path(1e-6)).collect()
}

/// Points along a path, close to each other.
fn points(path: &BezPath) -> Vec<Point> {
    path.segments().flat_map(|s| (0..200).map(move |i| s.eval(f64::from(i) / 200.0))).collect()
}

/// The angles from the top where an outline crosses a circle about the origin: the first and the last.
fn span(letter: &BezPath, radius: f64) -> [f64; 2] {
    let all = points(letter);
    let crossings = all.windows(2).filter(|w| (w[0].to_vec2().hypot() < radius) != (w[1].to_vec2().hypot() < radius));
    let angle = |p: Point| p.x.atan2(-p.y).rem_euclid(TAU);
    let angles: Vec<f64> = crossings.map(|w| angle(w[0].midpoint(w[1]))).collect();
    let middle = angle(letter.bounding_box().center());
    let off = |a: &f64| (a - middle + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
    let offs: Vec<f64> = angles.iter().map(off).collect();
    [offs.iter().copied().fold(0.0, f64::min), offs.iter().copied().fold(0.0, f64::max)].map(|o| middle + o)
}

/// The radius of the middle of the band.
fn middle(svg: &str) -> f64 {
    let lines: Vec<f64> = group(svg, "ring").iter().map(|p| 0.5 * p.bounding_box().width()).collect();
    0.5 * (lines[0] + lines[1])
}

/// At half the height of the capitals, the space between neighbours is equal all around, above and below, although letters fan out above
/// and crowd below; and separators are equally far from both lines.
#[test]
fn letters_have_equal_distances_above_and_below() {
    for extra in [&["--dots"][..], &["--stars", "--font", "Noto Sans"], &["--dots", "--letter-spacing", "9%"]] {
        let (svg, said) = badge(&[&["HIHHHIH", "HHIH"], extra].concat());
        assert!(said.is_empty(), "{said}");
        let radius = middle(&svg);
        let spans = |id: &str| {
            let mut all: Vec<[f64; 2]> = group(&svg, id).iter().map(|l| span(l, radius)).collect();
            // From the beginning of a line to its end, clockwise.
            let turned = if id == "upper" { 0.5 * TAU } else { 0.0 };
            all.iter_mut().flatten().for_each(|a| *a = (*a + turned).rem_euclid(TAU) - turned);
            all.sort_by(|a, b| a[0].total_cmp(&b[0]));
            all
        };
        let (upper, lower) = (spans("upper"), spans("lower"));
        // The space between two H is equal everywhere; an I has other bearings.
        let gaps = |spans: &[[f64; 2]], i: usize| (spans[i + 1][0] - spans[i][1]) * radius;
        let (above, below) = (gaps(&upper, 2), gaps(&lower, 2));
        assert!(above > 1.0 && (above / below - 1.0).abs() < 0.02, "H and H: {above} above, {below} below");
        let (above, below) = (gaps(&upper, 0), gaps(&lower, 0));
        assert!(above > 1.0 && (above / below - 1.0).abs() < 0.02, "H and I: {above} above, {below} below");
        for dot in group(&svg, "separators") {
            let [from, to] = span(&dot, radius);
            let near = |a: f64, b: f64| ((a - b + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU).abs() * radius;
            let ends = [[from, lower[3][1]], [to, upper[0][0]], [to, lower[0][0]], [from, upper[6][1]]];
            let mut distances = ends.map(|[a, b]| near(a, b));
            distances.sort_by(f64::total_cmp);
            let [a, b, ..] = distances;
            assert!((a / b - 1.0).abs() < 0.03, "a separator is {a} from one line and {b} from the other");
        }
    }
}

/// Letters of any kind keep within the lines of any shape, and the drawing within the inner line, about the axis.
#[test]
fn everything_has_its_place_in_every_shape() {
    let lines = [
        ["HARBOUR COFFEE", "SINCE 1887"],
        ["Žluťoučký", "Ångström jgpqy"],
        ["THE ROYAL SOCIETY OF MARINERS", "GREENWICH IN THE YEAR 1740"],
    ];
    for (shape, [upper, lower]) in ["circle", "oval", "shield", "hexagon"].into_iter().zip(lines.into_iter().cycle()) {
        let (svg, said) = badge(&[upper, lower, "--shape", shape, "--separator", "diamond", "--width", "80mm"]);
        assert!(!said.contains("fold"), "{shape}: {said}");
        let ring = group(&svg, "ring");
        let [outer, inner] = &ring[..] else { panic!("{} lines", ring.len()) };
        assert!((outer.bounding_box().width() - 80.0).abs() < 1.2 && svg.contains("mm\""), "{}", outer.bounding_box());
        for id in ["upper", "lower", "separators"] {
            for path in group(&svg, id) {
                let out = points(&path).into_iter().find(|p| !outer.contains(*p) || inner.contains(*p));
                assert!(out.is_none(), "{shape}, {id}: {out:?}");
            }
        }
        let doc = Document::read(svg.as_bytes(), "svg", &ReadOptions::default()).unwrap();
        let drawing: Vec<_> = doc.shapes().iter().filter(|s| s.id.starts_with("center-")).collect();
        let ink = drawing.iter().map(|s| s.outline.bounding_box().unwrap()).reduce(|a, b| a.union(b)).unwrap();
        assert!(
            drawing.len() == 3 && drawing.iter().flat_map(|s| s.outline.segs()).all(|s| inner.contains(s.eval(0.5)))
        );
        let room = inner.bounding_box();
        assert!(
            ink.height() > 0.4 * room.height() && ink.center().x.abs() < 0.06 * room.width(),
            "{shape}: {ink} {room}"
        );
        let ends = |id: &str| group(&svg, id).iter().map(Shape::bounding_box).reduce(|a, b| a.union(b)).unwrap();
        for id in ["upper", "lower", "separators"] {
            let b = ends(id);
            assert!((b.x0 + b.x1).abs() < 0.06 * b.width(), "{shape}, {id}: {b}");
        }
    }
}

#[test]
fn what_does_not_fit_is_told() {
    let long = "A LINE OF TEXT THAT IS MUCH TOO LONG FOR A RING";
    let (_, said) = expect_code(2, &["badge", long, &long.repeat(3)]);
    assert!(said.contains("too long") && said.contains("shorten"), "{said}");
    let (_, said) = expect_code(2, &["badge", long, "SINCE 1887", "--size", "80"]);
    assert!(said.contains("--size smaller"), "{said}");
    let (_, said) = expect_code(2, &["badge", "ONE", "TWO\nLINES"]);
    assert!(said.contains("one line"), "{said}");
    // The band covers the centre.
    let center = root().join("samples/icons/cup.svg").display().to_string();
    let (_, said) = expect_code(2, &["badge", "ONE", "--size", "20", "--band", "60%", "--center", &center]);
    assert!(said.contains("no room"), "{said}");
    let (_, said) = expect_code(3, &["badge", "ONE", "--separator", "hart"]);
    assert!(said.contains("did you mean heart?"), "{said}");
    // A line alone has one separator, at the bottom.
    let (svg, _) = badge(&["ONE", "--dots", "--ring", "4"]);
    let dots = group(&svg, "separators");
    assert!(dots.len() == 1 && dots[0].bounding_box().center().x.abs() < 0.1 && dots[0].bounding_box().y0 > 0.0);
    assert!(group(&svg, "ring").len() == 4 && !svg.contains("id=\"lower\""));
}

/// The ring on which text stands stays unchanged.
#[test]
fn a_path_stays_with_its_text() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("ring.svg");
    std::fs::write(&file, "<svg xmlns='http://www.w3.org/2000/svg'><circle id='ring' cx='50' cy='60' r='40'/></svg>")
        .unwrap();
    let on = format!("{}#ring", file.display());
    let (svg, _) = expect_code(0, &["text", "AROUND", "--on", &on, "--size", "16", "--keep-path", "-o", "-"]);
    let ring = group(&svg, "path")[0].bounding_box();
    assert!((ring.center() - Point::new(50.0, 60.0)).hypot() < 1e-6 && (ring.width() - 80.0).abs() < 1e-6, "{ring}");
    assert!(text(svg.as_bytes()).contains("aria-label=\"AROUND\"") && svg.contains("fill=\"none\" stroke=\"#000\""));
}
