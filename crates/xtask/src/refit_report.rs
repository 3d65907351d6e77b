//! `cargo xtask refit-report`: draws the pieces, nodes, handles and error of a refitted path.

use crate::chore::{Chore, ChoreError, at, path_option};
use clap::{Arg, ArgMatches, Command, value_parser};
use pathwarp::deform::Registry;
use pathwarp::kurbo::{ParamCurve, ParamCurveArclen as _, ParamCurveDeriv, PathSeg, Point, Rect, Vec2};
use pathwarp::map::Map;
use pathwarp::param::{Args, Frame};
use pathwarp::refit::{self, Options};
use pathwarp::{Outline, Seg};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) const CHORE: Chore = Chore { command, run };

/// The default path: a line, a full turn, a sharp bend and an inflection.
const PATH: &str = "M8,88 L88,92 C104,93 96,60 70,66 A16,16 0 1 1 70,34 C100,40 20,-10 30,40 S60,10 10,14";
/// The cage of the shaper that warps the path.
const CAGE: &str = "M 10,92 C 45,125 60,60 98,85 C 80,60 112,40 92,10 C 60,-20 40,45 4,8 C 20,40 -8,60 10,92 Z";
/// Samples per piece in the chart of the error.
const SAMPLES: usize = 60;
/// Side of the square above the chart.
const SIDE: f64 = 640.0;
/// Height of the chart of the error.
const CHART: f64 = 200.0;
/// Colours of the pieces, used in turn.
const COLOURS: [&str; 2] = ["#0072b2", "#d55e00"];

fn command() -> Command {
    Command::new("refit-report")
        .about("Draw the pieces, nodes and error of a refitted path")
        .arg(Arg::new("path").long("path").value_name("DATA").default_value(PATH).help("SVG path data"))
        .arg(
            Arg::new("tolerance")
                .long("tolerance")
                .value_name("D")
                .value_parser(value_parser!(f64))
                .default_value("0.05")
                .help("Maximum distance from the true image, in user units"),
        )
        .arg(path_option("out", "FILE.svg").default_value("docs/images/refit.svg").help("The drawing to write"))
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    match (
        arguments.get_one::<String>("path"),
        arguments.get_one::<f64>("tolerance"),
        arguments.get_one::<PathBuf>("out"),
    ) {
        (Some(path), Some(tolerance), Some(out)) if *tolerance > 0.0 => draw(path, *tolerance, out),
        _ => Err("the tolerance must be a positive number".into()),
    }
}

/// Refits the path, writes the drawing to `out`, and returns a summary.
fn draw(path: &str, tolerance: f64, out: &Path) -> Result<String, ChoreError> {
    let source = Outline::from_svg(path).map_err(|e| e.to_string())?;
    let frame = Frame::new(source.bounding_box().ok_or("the path is empty")?);
    let registry = Registry::builtin();
    let shaper = registry.get("shaper").ok_or("the registry has no shaper")?;
    let map = shaper.build_from(&Args::from_pairs(&[("shaper", CAGE)]), &frame).map_err(|e| e.to_string())?.map;
    let warped = refit::warp_path(&source, &map, &Options::new(tolerance).with_nodes(refit::Nodes::Source))
        .map_err(|e| e.to_string())?;
    let pieces: Vec<PathSeg> = warped.path.segments().collect();

    let mut svg = String::new();
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {SIDE} {}\" width=\"{SIDE}\" height=\"{}\">\n<title>Refitting: {} segments within {tolerance}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        SIDE + CHART,
        SIDE + CHART,
        pieces.len()
    );
    let controls = pieces.iter().map(PathSeg::to_cubic).flat_map(|c| [c.p0, c.p1, c.p2, c.p3]);
    let first = pieces[0].start();
    let bounds = controls.fold(Rect::from_points(first, first), |r, p| r.union_pt(p));
    // A margin of 40 around the drawing.
    let scale = (SIDE - 80.0) / bounds.width().max(bounds.height());
    let to_page = |p: Point| Point::new(40.0 + (p.x - bounds.x0) * scale, 40.0 + (p.y - bounds.y0) * scale);
    draw_truth(&mut svg, &source, &*map, &to_page);
    for (i, p) in pieces.iter().enumerate() {
        draw_piece(&mut svg, p, COLOURS[i % 2], &to_page);
    }
    let worst = draw_error(&mut svg, &pieces, &source, &*map, tolerance);
    svg.push_str("</svg>\n");
    fs::write(out, svg).map_err(at(out))?;
    Ok(format!(
        "{} segments in, {} out; largest sampled error {worst:.3e} of {tolerance:e} ({:.3e} reported); wrote {}",
        warped.report.segments_in,
        warped.report.segments_out,
        warped.report.max_error,
        out.display()
    ))
}

/// Draws the exact image as a wide pale line.
fn draw_truth(svg: &mut String, source: &Outline, map: &dyn Map, to_page: &impl Fn(Point) -> Point) {
    for seg in source.segs() {
        let points = (0..=400).map(|i| to_page(map.point(seg.eval(f64::from(i) / 400.0))));
        let points: Vec<String> = points.map(coordinates).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"#d8dce3\" stroke-width=\"9\" stroke-linecap=\"round\" stroke-linejoin=\"round\"/>",
            points.join(" ")
        );
    }
}

/// A point in path data.
fn coordinates(p: Point) -> String {
    format!("{:.2},{:.2}", p.x, p.y)
}

/// Draws one piece with its end nodes and handles.
fn draw_piece(svg: &mut String, piece: &PathSeg, colour: &str, to_page: &impl Fn(Point) -> Point) {
    let c = piece.to_cubic();
    let points = [c.p0, c.p1, c.p2, c.p3].map(to_page);
    let [p0, p1, p2, p3] = points.map(coordinates);
    if matches!(piece, PathSeg::Cubic(_)) {
        for (node, handle, Point { x, y }) in [(&p0, &p1, points[1]), (&p3, &p2, points[2])] {
            let _ = writeln!(
                svg,
                "<path d=\"M{node} L{handle}\" stroke=\"#8a93a3\" stroke-width=\"0.8\"/><circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"2.4\" fill=\"#fff\" stroke=\"#8a93a3\"/>"
            );
        }
    }
    let _ = writeln!(svg, "<path d=\"M{p0} C{p1} {p2} {p3}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2.2\"/>");
    for Point { x, y } in [points[0], points[3]].map(|p| p - Vec2::new(3.5, 3.5)) {
        let _ = writeln!(svg, "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"7\" height=\"7\" fill=\"#2b2f36\"/>");
    }
}

/// Draws the chart of the signed error along the output, in units of the tolerance, and returns the largest absolute error.
fn draw_error(svg: &mut String, pieces: &[PathSeg], source: &Outline, map: &dyn Map, tolerance: f64) -> f64 {
    let lengths: Vec<f64> = pieces.iter().map(|p| p.arclen(1e-6)).collect();
    let total: f64 = lengths.iter().sum();
    // An error of the tolerance has this height, so that a quarter of the chart is left for larger ones.
    let (left, width, middle, height) = (40.0, SIDE - 80.0, SIDE + CHART / 2.0, CHART * 0.38);
    for (k, colour, dash) in [(-1.0, "#cc3344", "5 4"), (0.0, "#8a93a3", "none"), (1.0, "#cc3344", "5 4")] {
        let y = middle - k * height;
        let _ = writeln!(
            svg,
            "<path d=\"M{left},{y} H{}\" stroke=\"{colour}\" stroke-dasharray=\"{dash}\"/>",
            left + width
        );
    }
    let mut from = 0.0;
    let mut worst: f64 = 0.0;
    for (i, (p, l)) in pieces.iter().zip(&lengths).enumerate() {
        let mut points = Vec::with_capacity(SAMPLES + 1);
        for k in 0..=SAMPLES {
            let t = k as f64 / SAMPLES as f64;
            let e = signed_error(p, t, source, map);
            worst = worst.max(e.abs());
            let x = left + ((from + l * t) / total) * width;
            points.push(format!("{x:.2},{:.2}", middle - (e / tolerance) * height));
        }
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>",
            points.join(" "),
            COLOURS[i % 2]
        );
        from += l;
        let x = left + (from / total) * width;
        let _ = writeln!(svg, "<path d=\"M{x:.2},{} V{}\" stroke=\"#e3e6eb\"/>", middle - height, middle + height);
    }
    worst
}

/// The signed distance of the output at `t` from the exact image.
fn signed_error(piece: &PathSeg, t: f64, source: &Outline, map: &dyn Map) -> f64 {
    let p = piece.eval(t);
    let tangent: Vec2 = match piece {
        PathSeg::Line(l) => l.p1 - l.p0,
        PathSeg::Quad(q) => q.deriv().eval(t).to_vec2(),
        PathSeg::Cubic(c) => c.deriv().eval(t).to_vec2(),
    };
    let foot =
        source.segs().map(|s| nearest(s, map, p)).fold((f64::INFINITY, p), |a, b| if b.0 < a.0 { b } else { a }).1;
    (p - foot).cross(tangent) / tangent.hypot().max(f64::MIN_POSITIVE)
}

/// The distance to the nearest point of a segment's exact image, and that point, by dense sampling and golden-section search.
fn nearest(seg: &Seg, map: &dyn Map, p: Point) -> (f64, Point) {
    const COARSE: usize = 200;
    let at = |t: f64| map.point(seg.eval(t));
    let coarse = (0..=COARSE).map(|i| i as f64 / COARSE as f64);
    let best = coarse.min_by(|a, b| at(*a).distance(p).total_cmp(&at(*b).distance(p))).unwrap_or(0.0);
    let (mut lo, mut hi) = ((best - 1.0 / COARSE as f64).max(0.0), (best + 1.0 / COARSE as f64).min(1.0));
    // Each step keeps 1/φ = 0.618 of the interval.
    for _ in 0..50 {
        let (a, b) = (lo + 0.382 * (hi - lo), hi - 0.382 * (hi - lo));
        if at(a).distance(p) < at(b).distance(p) { hi = b } else { lo = a }
    }
    let q = at(0.5 * (lo + hi));
    (q.distance(p), q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_in_the_picture_is_within_the_tolerance() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("r.svg");
        let summary = draw(PATH, 0.05, &out).unwrap();
        let worst: f64 = summary.split("sampled error ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!(worst <= 0.05 && worst > 1e-4, "{summary}");
        assert!(fs::read_to_string(out).unwrap().contains("polyline"));
        assert!(draw("M0 0", 0.05, dir.path()).is_err() && draw("nonsense", 0.05, dir.path()).is_err());
    }
}
