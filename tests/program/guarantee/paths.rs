//! Paths for the measurement: symmetrical shapes, nodes on creases, loops, random curves and paths of drawings, near the origin and far.

use pathwarp_oracle::Random;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::LazyLock;

/// Returns a coordinate, often a multiple of an eighth of the page.
fn coordinate(r: &mut Random) -> f64 {
    match r.below(3) {
        0 => r.below(9) as f64 * 12.5,
        1 => (r.between(0.0, 100.0) * 10.0).round() / 10.0,
        _ => r.between(0.0, 100.0),
    }
}

/// Returns a path that is symmetrical about a vertical through `x` and reaches from `x − w` to `x + w`.
fn symmetrical(r: &mut Random) -> String {
    let (x, y, w) = (50.0, coordinate(r), [50.0, 25.0, 12.5, 16.65, 33.3][r.below(5)]);
    let h = r.between(0.2, 1.5) * w;
    let (l, m) = (x - w, x + w);
    match r.below(9) {
        0 => format!(
            "M{} {y}H{}a{h} {h} 0 0 1 0 {}H{}a{h} {h} 0 0 1 0 {}Z",
            x - w / 2.0,
            x + w / 2.0,
            2.0 * h,
            x - w / 2.0,
            -2.0 * h
        ),
        1 => format!("M{m} {y}A{w} {h} 0 1 1 {l} {y}A{w} {h} 0 1 1 {m} {y}Z"),
        2 => format!("M{x} {}A{w} {h} 0 0 1 {x} {}A{w} {h} 0 0 1 {x} {}Z", y - h, y + h, y - h),
        3 => format!("M{l} {y}C{l} {} {m} {} {m} {y}L{x} {}Z", y - h, y - h, y + 2.0 * h),
        4 => {
            let k = 0.552_284_75;
            let (a, b) = (k * w, k * h);
            format!(
                "M{x} {}C{} {} {m} {} {m} {y}S{} {} {x} {}S{l} {} {l} {y}S{} {} {x} {}Z",
                y - h,
                x + a,
                y - h,
                y - b,
                x + a,
                y + h,
                y + h,
                y + b,
                x - a,
                y - h,
                y - h
            )
        }
        5 => format!("M{l} {y}Q{x} {} {m} {y}Q{x} {} {l} {y}Z", y - h, y + h),
        6 => format!("M{x} {y}L{m} {}V{}H{l}V{}Z", y + h, y + 2.0 * h, y + h),
        7 => format!("M{x} {y}C{} {} {} {} {x} {y}Z", l - w, y - 2.0 * h, m + w, y - 2.0 * h),
        _ => format!(
            "M{m} {y}A{w} {w} 0 0 1 {l} {y}A{w} {w} 0 0 1 {m} {y}ZM{} {y}A{h} {h} 0 0 0 {} {y}A{h} {h} 0 0 0 {} {y}Z",
            x + h,
            x - h,
            x + h
        ),
    }
}

/// Returns curves through nodes that often lie on creases, with some smooth joints.
fn random(r: &mut Random) -> String {
    let mut d = format!("M{} {}", coordinate(r), coordinate(r));
    for _ in 0..1 + r.below(6) {
        let mut numbers = |n: usize| (0..n).fold(String::new(), |s, _| s + &format!(" {}", coordinate(r)));
        let next = match numbers(1).len() % 7 {
            0 => format!("L{}", numbers(2)),
            1 => format!("Q{}", numbers(4)),
            2 => format!("T{}", numbers(2)),
            3 => format!("S{}", numbers(4)),
            _ => format!("C{}", numbers(6)),
        };
        d += &next;
        if r.below(5) == 0 {
            let (rx, ry) = (r.between(1.0, 60.0), r.between(1.0, 60.0));
            let _ = write!(
                d,
                "A{rx} {ry} {} {} {} {} {}",
                r.below(180),
                r.below(2),
                r.below(2),
                coordinate(r),
                coordinate(r)
            );
        }
    }
    if r.below(2) == 0 { d + "Z" } else { d }
}

/// Returns loops: petals, whole turns, curves that end where they start.
fn loops(r: &mut Random) -> String {
    let (x, y) = (coordinate(r), coordinate(r));
    let mut d = format!("M0 0H100V100H0ZM{x} {y}");
    for _ in 0..1 + r.below(3) {
        let mut c = || coordinate(r);
        let _ = write!(d, "C{} {} {} {} {x} {y}", c(), c(), c(), c());
    }
    d + "Z"
}

/// Returns a path moved elsewhere: relative commands after a first point far away.
pub fn shifted(d: &str, by: [f64; 2]) -> String {
    use svgtypes::PathSegment as S;
    let mut out = String::new();
    for s in svgtypes::PathParser::from(d).map_while(Result::ok) {
        let p = |abs: bool, x: f64, y: f64| if abs { (x + by[0], y + by[1]) } else { (x, y) };
        let name = |abs: bool, c: char| if abs { c } else { c.to_ascii_lowercase() };
        let _ = match s {
            // The first point is absolute in either notation.
            S::MoveTo { x, y, .. } if out.is_empty() => write!(out, "M{:?}", p(true, x, y)),
            S::MoveTo { abs, x, y } => write!(out, "{}{:?}", name(abs, 'M'), p(abs, x, y)),
            S::LineTo { abs, x, y } => write!(out, "{}{:?}", name(abs, 'L'), p(abs, x, y)),
            S::HorizontalLineTo { abs, x } => write!(out, "{}{:?}", name(abs, 'H'), p(abs, x, 0.0).0),
            S::VerticalLineTo { abs, y } => write!(out, "{}{:?}", name(abs, 'V'), p(abs, 0.0, y).1),
            S::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                write!(out, "{}{:?}{:?}{:?}", name(abs, 'C'), p(abs, x1, y1), p(abs, x2, y2), p(abs, x, y))
            }
            S::SmoothCurveTo { abs, x2, y2, x, y } => {
                write!(out, "{}{:?}{:?}", name(abs, 'S'), p(abs, x2, y2), p(abs, x, y))
            }
            S::Quadratic { abs, x1, y1, x, y } => {
                write!(out, "{}{:?}{:?}", name(abs, 'Q'), p(abs, x1, y1), p(abs, x, y))
            }
            S::SmoothQuadratic { abs, x, y } => write!(out, "{}{:?}", name(abs, 'T'), p(abs, x, y)),
            S::EllipticalArc { abs, rx, ry, x_axis_rotation: r, large_arc, sweep, x, y } => {
                let (l, w) = (u8::from(large_arc), u8::from(sweep));
                write!(out, "{}{rx} {ry} {r} {l} {w} {:?}", name(abs, 'A'), p(abs, x, y))
            }
            S::ClosePath { .. } => write!(out, "Z"),
        };
    }
    out.replace(['(', ')'], " ").replace(", ", " ")
}

/// Limit on the commands of a path of a drawing that is measured.
const MAX_COMMANDS: usize = 200;

/// Path data of the drawings in the folder that `PATHWARP_DRAWINGS` names, or else in the samples.
static DRAWN: LazyLock<Vec<String>> = LazyLock::new(|| {
    let folder =
        std::env::var_os("PATHWARP_DRAWINGS").map_or_else(|| crate::support::root().join("samples"), Into::into);
    let mut out = Vec::new();
    gather(&folder, &mut out);
    assert!(!out.is_empty(), "no drawing in {}", folder.display());
    out
});

fn gather(folder: &Path, out: &mut Vec<String>) {
    let mut all: Vec<_> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    all.sort();
    for path in all {
        if path.is_dir() {
            gather(&path, out);
        }
        let Some(text) = std::fs::read_to_string(&path).ok().filter(|_| path.extension().is_some_and(|e| e == "svg"))
        else {
            continue;
        };
        let options = resvg::usvg::roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
        let Ok(xml) = resvg::usvg::roxmltree::Document::parse_with_options(&text, options) else { continue };
        let paths = xml.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "path")));
        let whole = |d: &&str| svgtypes::PathParser::from(*d).all(|s| s.is_ok());
        let short = |d: &&str| (2..=MAX_COMMANDS).contains(&svgtypes::PathParser::from(*d).count());
        out.extend(
            paths.filter_map(|n| n.attribute("d")).filter(whole).filter(short).filter(closed).map(str::to_owned),
        );
    }
}

/// Returns `true` if every subpath is closed in the text. The program leaves filled open lines open, since they enclose nothing.
fn closed(d: &&str) -> bool {
    use svgtypes::PathSegment as S;
    let mut open = false;
    svgtypes::PathParser::from(*d).map_while(Result::ok).all(|s| {
        let fits = match s {
            S::MoveTo { .. } => !open,
            _ => open,
        };
        open = !matches!(s, S::ClosePath { .. });
        fits
    }) && !open
}

/// Returns a path, with the name of its kind.
pub fn path(r: &mut Random) -> (&'static str, String) {
    let made = match r.below(4) {
        0 | 1 => ("symmetrical", symmetrical(r)),
        2 => ("random", random(r)),
        _ => ("loops", loops(r)),
    };
    somewhere(r, made)
}

/// Returns a path of a drawing.
pub fn drawn(r: &mut Random) -> (&'static str, String) {
    let made = ("of drawings", DRAWN[r.below(DRAWN.len())].clone());
    somewhere(r, made)
}

/// Moves one path in four far from the origin.
fn somewhere(r: &mut Random, (kind, d): (&'static str, String)) -> (&'static str, String) {
    match r.below(8) {
        0 => ("at 1e5", shifted(&d, [1e5, 3e5])),
        1 => ("at 3e7", shifted(&d, [3e7, -3.67e7])),
        _ => (kind, d),
    }
}
