//! Colours of bent gradients, pixel by pixel: the program's result, rendered, against the gradient's definition evaluated at the exact
//! inverse of each pixel. The map is a pair of shears, whose inverse has a closed form.

use crate::support::pathwarp_in;
use pathwarp::kurbo::{Affine, Point};
use pathwarp_oracle::drawings::{options, rendered};
use pathwarp_svg::usvg_tree::parse_tree;
use std::fs;

/// Pixels per unit of the comparison: the drawing is enlarged, which shows the pixels of a picture.
const SCALE: u32 = 8;
/// Units by which the page exceeds the drawing on each side.
const MARGIN: f64 = 20.0;

const MAP: [&str; 4] = ["--x", "x + 6*sin(y/30)", "--y", "y + 8*sin((x + 6*sin(y/30))/25)"];

fn back(q: Point) -> Point {
    let y = q.y - 8.0 * (q.x / 25.0).sin();
    Point::new(q.x - 6.0 * (y / 30.0).sin(), y)
}

type Rgba = [f64; 4];

/// A gradient as markup, as a formula for its parameter, and its stops.
struct Case {
    name: &'static str,
    markup: &'static str,
    along: fn(Point) -> f64,
    stops: &'static [(f64, Rgba)],
    /// `true` if the gradient becomes a picture, with `exact` and by default; else it becomes another gradient.
    pictured: [bool; 2],
    /// Largest accepted error of a channel, of 255, with `exact` and by default.
    most: [f64; 2],
    /// Most bytes that the picture may add to the file by default.
    bytes: usize,
}

const CASES: &[Case] = &[
    Case {
        name: "two colours",
        markup: "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='10' y1='20' x2='80' y2='70'><stop \
                 stop-color='#f40'/><stop offset='1' stop-color='#03c'/></linearGradient>",
        along: |p| ((p.x - 10.0) * 70.0 + (p.y - 20.0) * 50.0) / (70.0 * 70.0 + 50.0 * 50.0),
        stops: &[(0.0, [255.0, 68.0, 0.0, 255.0]), (1.0, [0.0, 51.0, 204.0, 255.0])],
        pictured: [true, false],
        most: [2.5, 8.0],
        bytes: 2000,
    },
    Case {
        name: "a soft shadow",
        markup: "<radialGradient id='g' gradientUnits='userSpaceOnUse' cx='50' cy='50' r='45'><stop stop-opacity='.8'/><stop \
                 offset='1' stop-opacity='0'/></radialGradient>",
        along: |p| (p.x - 50.0).hypot(p.y - 50.0) / 45.0,
        stops: &[(0.0, [0.0, 0.0, 0.0, 204.0]), (1.0, [0.0; 4])],
        pictured: [true, true],
        most: [2.5, 9.0],
        bytes: 2000,
    },
    Case {
        name: "kinks",
        markup: "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='0' y1='0' x2='0' y2='100'><stop \
                 stop-color='#000'/><stop offset='.4' stop-color='#fff'/><stop offset='.5' stop-color='#fff'/><stop \
                 offset='1' stop-color='#f00'/></linearGradient>",
        along: |p| p.y / 100.0,
        stops: &[(0.0, [0.0, 0.0, 0.0, 255.0]), (0.4, [255.0; 4]), (0.5, [255.0; 4]), (1.0, [255.0, 0.0, 0.0, 255.0])],
        pictured: [true, true],
        most: [2.5, 7.0],
        bytes: 2000,
    },
    Case {
        name: "a jump",
        markup: "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='0' y1='0' x2='0' y2='100'><stop offset='.5' \
                 stop-color='#f00'/><stop offset='.5' stop-color='#00f'/></linearGradient>",
        along: |p| p.y / 100.0,
        stops: &[
            (0.0, [255.0, 0.0, 0.0, 255.0]),
            (0.5, [255.0, 0.0, 0.0, 255.0]),
            (0.5, [0.0, 0.0, 255.0, 255.0]),
            (1.0, [0.0, 0.0, 255.0, 255.0]),
        ],
        pictured: [true, true],
        most: [1.0, 1.0],
        bytes: 3000,
    },
];

/// The premultiplied colour at a parameter, by the definition in SVG.
fn color(stops: &[(f64, Rgba)], t: f64) -> Rgba {
    let t = t.clamp(0.0, 1.0);
    let k = stops.iter().position(|s| s.0 > t).unwrap_or(stops.len() - 1).max(1);
    let ((a, from), (b, to)) = (stops[k - 1], stops[k]);
    let u = if b > a { ((t - a) / (b - a)).min(1.0) } else { 1.0 };
    let straight: Rgba = std::array::from_fn(|c| from[c] + u * (to[c] - from[c]));
    std::array::from_fn(|c| if c < 3 { straight[c] * straight[3] / 255.0 } else { straight[3] })
}

/// Warps a square painted with the gradient. Returns the result's text.
fn warped(case: &Case, gradients: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    let page = 100.0 + 2.0 * MARGIN;
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{page}' height='{page}' viewBox='-{MARGIN} -{MARGIN} {page} {page}'>{}\
         <rect x='2' y='2' width='96' height='96' fill='url(#g)'/></svg>",
        case.markup
    );
    fs::write(dir.path().join("in.svg"), svg).unwrap();
    let args = ["expr", "in.svg", "-o", "out.svg", "--gradients", gradients];
    let run = pathwarp_in(dir.path(), &[&args[..], &MAP].concat(), b"");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    fs::read_to_string(dir.path().join("out.svg")).unwrap()
}

/// Returns the largest error of a channel over all pixels inside the image of the square, at least a unit from its edge and `jump` units
/// from any jump of the colour. `moved` shifts the truth.
fn worst(case: &Case, svg: &str, moved: f64) -> f64 {
    const JUMP: f64 = 0.8;
    let tree = parse_tree(svg.as_bytes(), case.name, &options()).unwrap();
    let side = (100 + 2 * MARGIN as u32) * SCALE;
    let picture = rendered(&tree, side, Affine::scale(f64::from(SCALE)));
    let jump = case.stops.windows(2).find(|w| w[0].0 == w[1].0).map(|w| w[0].0);
    let (mut worst, mut count) = (0.0_f64, 0);
    for n in 0..side * side {
        let at = |v: u32| (f64::from(v) + 0.5) / f64::from(SCALE) - MARGIN;
        let p = back(Point::new(at(n % side), at(n / side)));
        let t = (case.along)(Point::new(p.x + moved, p.y + moved));
        let near_jump = jump.is_some_and(|j| (t - j).abs() * 100.0 < JUMP);
        if !(3.0..97.0).contains(&p.x) || !(3.0..97.0).contains(&p.y) || near_jump {
            continue;
        }
        count += 1;
        let found = &picture.data()[n as usize * 4..][..4];
        let wanted = color(case.stops, t);
        worst = wanted.iter().zip(found).map(|(w, f)| (w - f64::from(*f)).abs()).fold(worst, f64::max);
    }
    assert!(count > 400_000, "{}: nothing to compare", case.name);
    worst
}

#[test]
fn colours_are_those_of_the_definition() {
    for case in CASES {
        let (exact, auto, fit) = (warped(case, "exact"), warped(case, "auto"), warped(case, "fit"));
        let [in_exact, in_auto, in_fit] = [&exact, &auto, &fit].map(|svg| worst(case, svg, 0.0));
        let bytes = auto.len().saturating_sub(fit.len());
        println!(
            "{}: largest error {in_exact:.1} exact, {in_auto:.1} by default, {in_fit:.1} fitted; {bytes} bytes more",
            case.name
        );
        assert_eq!([&exact, &auto].map(|svg| svg.contains("<image")), case.pictured, "{}", case.name);
        assert!(in_exact <= case.most[0] && in_auto <= case.most[1], "{}: {in_exact} {in_auto}", case.name);
        assert!(bytes <= case.bytes, "{}: {bytes}", case.name);
        // The comparison can fail: on the affine fit, and on a truth that is a unit away.
        assert!(in_fit > 2.0 * case.most[1], "{}: {in_fit}", case.name);
        let moved = worst(case, &exact, 1.0);
        assert!(moved > 1.2 * case.most[0], "{}: {moved}", case.name);
    }
}

/// A gradient that is not visible needs no picture.
#[test]
fn what_is_not_seen_is_not_painted() {
    let invisible = [
        // Transparent, by its stops or by its fill.
        "<linearGradient id='g'><stop stop-opacity='0'/><stop offset='1' stop-color='red' stop-opacity='0'/></linearGradient>",
        "<linearGradient id='g' gradientUnits='userSpaceOnUse' x2='5000' y2='9000'><stop stop-color='red'/><stop offset='1' \
         stop-color='blue'/></linearGradient>",
        // One colour throughout the shape.
        "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='-60' x2='-50'><stop stop-color='red'/><stop offset='1' \
         stop-color='blue'/></linearGradient>",
    ];
    for markup in invisible {
        let case = Case { markup, ..CASES[0] };
        assert!(!warped(&case, "auto").contains("<image"), "{markup}");
    }
}
