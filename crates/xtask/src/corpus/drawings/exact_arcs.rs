//! Rewrites a drawing with more precise arcs.
//!
//! usvg converts circles, ellipses, round corners and arcs to cubics within 0.1 user units before it draws or measures them.
//! This module rewrites them in the source as cubics within [`EXACT`], which usvg keeps, and changes nothing else. It is
//! independent of pathwarp's own arcs: svgtypes reads them and kurbo approximates them.

use pathwarp::kurbo::{Arc, Point, SvgArc, Vec2};
use std::fmt::Write as _;
use svgtypes::{PathParser, PathSegment};
use usvg::roxmltree::{self, Node};

/// Maximum distance between an arc and its cubics, in user units.
const EXACT: f64 = 1e-6;
const SVG: &str = "http://www.w3.org/2000/svg";

/// Returns the drawing with exact arcs; `None` if it has none or they cannot be located.
pub(super) fn with_exact_arcs(text: &str) -> Option<String> {
    // Text inside entities cannot be edited in place. usvg puts markers on the joints of its cubics, and there would be more
    // joints.
    if text.contains("<!ENTITY") || text.contains("marker-") {
        return None;
    }
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(text, options).ok()?;
    let mut edits: Vec<(std::ops::Range<usize>, String)> = Vec::new();
    for e in document.descendants().filter(|n| n.is_element() && n.tag_name().namespace() == Some(SVG)) {
        if e.tag_name().name() == "path" {
            let Some(d) = e.attribute_node("d") else { continue };
            if let Some(exact) = without_arcs(d.value()) {
                edits.push((d.range_value(), exact));
            }
        } else if let Some(exact) = shape(e).filter(|_| can_become_path(text, e.tag_name().name())) {
            edits.extend(as_path(text, e, &exact)?);
        }
    }
    if edits.is_empty() {
        return None;
    }
    edits.sort_by_key(|(range, _)| range.start);
    let mut out = text.to_owned();
    for (range, with) in edits.into_iter().rev() {
        out.replace_range(range, &with);
    }
    Some(out)
}

/// Returns `true` if no style sheet names the element, so that it looks the same as a `path`.
fn can_become_path(text: &str, tag: &str) -> bool {
    let sheets = text.match_indices("<style").filter_map(|(at, _)| text.get(at..)?.split("</style").next());
    !sheets.into_iter().any(|s| s.contains(tag))
}

/// The edits that turn an element into a `path`: its name, its data, its closing name.
fn as_path(text: &str, e: Node<'_, '_>, data: &str) -> Option<Vec<(std::ops::Range<usize>, String)>> {
    let whole = e.range();
    let tag = e.tag_name().name();
    let inside = text.get(whole.clone())?;
    // Skip a namespace prefix.
    let name = whole.start + inside.find(tag)?;
    let mut edits = vec![(name..name + tag.len(), format!("path d=\"{data}\""))];
    if let Some(close) = inside.rfind("</") {
        let name = whole.start + close + inside.get(close..)?.find(tag)?;
        edits.push((name..name + tag.len(), "path".to_owned()));
    }
    Some(edits)
}

/// The equivalent path of a circle, an ellipse or a rectangle with round corners (SVG 2, chapter 10, Basic Shapes). `None` if a
/// length is not a plain number.
fn shape(e: Node<'_, '_>) -> Option<String> {
    let length = |name: &str| match e.attribute(name) {
        None => Some(0.0),
        Some(v) => v.trim().parse::<f64>().ok().filter(|v| v.is_finite()),
    };
    let radius = |name: &str| match e.attribute(name) {
        None => Some(None),
        Some(_) => length(name).filter(|v| *v >= 0.0).map(Some),
    };
    let radii = || {
        Some(match (radius("rx")?, radius("ry")?) {
            (Some(x), Some(y)) => (x, y),
            (Some(both), None) | (None, Some(both)) => (both, both),
            (None, None) => (0.0, 0.0),
        })
    };
    let mut out = PathData::default();
    match e.tag_name().name() {
        tag @ ("circle" | "ellipse") => {
            let (rx, ry) = if tag == "circle" { (length("r")?, length("r")?) } else { radii()? };
            let (x, y) = (length("cx")?, length("cy")?);
            if rx <= 0.0 || ry <= 0.0 {
                return None;
            }
            out.move_to((x + rx, y));
            for to in [(x, y + ry), (x - rx, y), (x, y - ry), (x + rx, y)] {
                out.quarter((rx, ry), to);
            }
        }
        "rect" => {
            let (x, y, w, h) = (length("x")?, length("y")?, length("width")?, length("height")?);
            let (rx, ry) = radii()?;
            let (rx, ry) = (rx.min(0.5 * w), ry.min(0.5 * h));
            if w <= 0.0 || h <= 0.0 || rx <= 0.0 || ry <= 0.0 {
                return None;
            }
            out.move_to((x + rx, y));
            for (line, corner) in [
                ((x + w - rx, y), (x + w, y + ry)),
                ((x + w, y + h - ry), (x + w - rx, y + h)),
                ((x + rx, y + h), (x, y + h - ry)),
                ((x, y + ry), (x + rx, y)),
            ] {
                out.line_to(line);
                out.quarter((rx, ry), corner);
            }
        }
        _ => return None,
    }
    out.data.push('Z');
    Some(out.data)
}

/// Path data under construction.
#[derive(Default)]
struct PathData {
    data: String,
    at: Point,
}

impl PathData {
    fn move_to(&mut self, to: (f64, f64)) {
        let _ = write!(self.data, "M{} {}", to.0, to.1);
        self.at = to.into();
    }

    fn line_to(&mut self, to: (f64, f64)) {
        let _ = write!(self.data, "L{} {}", to.0, to.1);
        self.at = to.into();
    }

    fn quarter(&mut self, radii: (f64, f64), to: (f64, f64)) {
        self.arc(SvgArc {
            from: self.at,
            to: to.into(),
            radii: radii.into(),
            x_rotation: 0.0,
            large_arc: false,
            sweep: true,
        });
    }

    /// Appends an arc that starts at the current point.
    fn arc(&mut self, arc: SvgArc) {
        let to = arc.to;
        match Arc::from_svg_arc(&arc) {
            Some(exact) => {
                let mut pieces = Vec::new();
                exact.to_cubic_beziers(EXACT, |a, b, c| pieces.push((a, b, c)));
                // Use the end point of the source, not the one computed from angles.
                if let Some(last) = pieces.last_mut() {
                    last.2 = to;
                }
                for (a, b, c) in pieces {
                    let _ = write!(self.data, "C{} {} {} {} {} {}", a.x, a.y, b.x, b.y, c.x, c.y);
                }
                self.at = to;
            }
            None => self.line_to((to.x, to.y)),
        }
    }
}

/// Converts path data to absolute coordinates with cubics for arcs, up to the first error. `None` if there is no arc.
fn without_arcs(d: &str) -> Option<String> {
    let segments: Vec<PathSegment> = PathParser::from(d).map_while(Result::ok).collect();
    if !segments.iter().any(|s| matches!(s, PathSegment::EllipticalArc { .. })) {
        return None;
    }
    let mut out = PathData::default();
    let mut start = Point::ORIGIN;
    let mut after_arc = false;
    for s in segments {
        let base = match s {
            PathSegment::MoveTo { abs, .. }
            | PathSegment::LineTo { abs, .. }
            | PathSegment::HorizontalLineTo { abs, .. }
            | PathSegment::VerticalLineTo { abs, .. }
            | PathSegment::CurveTo { abs, .. }
            | PathSegment::SmoothCurveTo { abs, .. }
            | PathSegment::Quadratic { abs, .. }
            | PathSegment::SmoothQuadratic { abs, .. }
            | PathSegment::EllipticalArc { abs, .. }
                if !abs =>
            {
                out.at.to_vec2()
            }
            _ => Vec2::ZERO,
        };
        let p = |x: f64, y: f64| Point::new(x, y) + base;
        let was_arc = std::mem::replace(&mut after_arc, matches!(s, PathSegment::EllipticalArc { .. }));
        match s {
            PathSegment::MoveTo { x, y, .. } => {
                start = p(x, y);
                out.move_to((start.x, start.y));
            }
            PathSegment::LineTo { x, y, .. } => out.line_to(p(x, y).into()),
            PathSegment::HorizontalLineTo { x, .. } => out.line_to((x + base.x, out.at.y)),
            PathSegment::VerticalLineTo { y, .. } => out.line_to((out.at.x, y + base.y)),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => out.points('C', &[p(x1, y1), p(x2, y2), p(x, y)]),
            // A smooth curve after an arc has no reflected control point; after the arc's cubics it would get one.
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } if was_arc => {
                out.points('C', &[out.at, p(x2, y2), p(x, y)]);
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => out.points('S', &[p(x2, y2), p(x, y)]),
            PathSegment::Quadratic { x1, y1, x, y, .. } => out.points('Q', &[p(x1, y1), p(x, y)]),
            PathSegment::SmoothQuadratic { x, y, .. } => out.points('T', &[p(x, y)]),
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => out.arc(SvgArc {
                from: out.at,
                to: p(x, y),
                radii: Vec2::new(rx, ry),
                x_rotation: x_axis_rotation.to_radians(),
                large_arc,
                sweep,
            }),
            PathSegment::ClosePath { .. } => {
                out.data.push('Z');
                out.at = start;
            }
        }
    }
    Some(out.data)
}

impl PathData {
    fn points(&mut self, command: char, points: &[Point]) {
        self.data.push(command);
        for p in points {
            let _ = write!(self.data, "{} {} ", p.x, p.y);
            self.at = *p;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::kurbo::{BezPath, ParamCurve as _};

    fn data(svg: &str) -> BezPath {
        let text = with_exact_arcs(svg).expect("there is an arc");
        let document = roxmltree::Document::parse(&text).expect("well formed");
        let path = document.descendants().find(|n| n.has_tag_name((SVG, "path"))).expect("a path");
        BezPath::from_svg(path.attribute("d").expect("data")).expect("path data")
    }

    fn off_circle(path: &BezPath, middle: Point, r: f64) -> f64 {
        let looks = path.segments().flat_map(|s| (0..=32).map(move |i| s.eval(f64::from(i) / 32.0)));
        looks.map(|p| (p.distance(middle) - r).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn circles_and_arcs_are_exact() {
        let circle = data("<svg xmlns='http://www.w3.org/2000/svg'><circle cx='3' cy='4' r='500'>\n</circle></svg>");
        assert!(off_circle(&circle, Point::new(3.0, 4.0), 500.0) <= 1.1e-6);
        // usvg's own cubics are coarser.
        let arcs = data(
            "<svg xmlns='http://www.w3.org/2000/svg'><path d='m503 4a500 500 0 1 1-1000 0 500 500 0 0 1 1000 0z'/></svg>",
        );
        assert!(off_circle(&arcs, Point::new(3.0, 4.0), 500.0) <= 1.1e-6);
    }

    #[test]
    fn round_corners_lie_on_their_circles() {
        let rect =
            data("<svg xmlns='http://www.w3.org/2000/svg'><rect x='1' y='2' width='20' height='10' rx='3'/></svg>");
        let corners = [(4.0, 5.0), (18.0, 5.0), (18.0, 9.0), (4.0, 9.0)];
        for (x, y) in corners {
            let quarter = rect.segments().flat_map(|s| (0..=8).map(move |i| s.eval(f64::from(i) / 8.0)));
            let outside = |p: &Point| (p.x - 11.0).abs() >= 7.0 && (p.y - 7.0).abs() >= 2.0;
            let near = quarter.filter(outside).filter(|p| p.distance(Point::new(x, y)) < 3.5).collect::<Vec<_>>();
            assert!(near.len() > 8);
            assert!(near.iter().all(|p| (p.distance(Point::new(x, y)) - 3.0).abs() < 2e-6));
        }
    }

    #[test]
    fn curves_after_an_arc_are_unchanged() {
        let smooth = without_arcs("M0 0A5 5 0 0 1 10 0s10 10 20 0t10 0z l1 1").expect("an arc");
        let exact = BezPath::from_svg(&smooth).expect("path data");
        let plain = BezPath::from_svg("M10 0C10 0 20 10 30 0").expect("path data");
        let curve = exact.segments().find(|s| s.start() == Point::new(10.0, 0.0)).expect("the curve");
        assert_eq!(Some(curve), plain.segments().next());
        assert!(smooth.ends_with("ZL1 1"));
    }

    #[test]
    fn shapes_without_arcs_or_with_unknown_lengths_are_left_alone() {
        for body in [
            "<path d='M0 0C1 1 2 2 3 3'/>",
            "<rect width='3' height='4'/>",
            "<circle r='2em'/>",
            "<style>circle { fill: red }</style><circle r='2'/>",
        ] {
            assert_eq!(with_exact_arcs(&format!("<svg xmlns='http://www.w3.org/2000/svg'>{body}</svg>")), None);
        }
    }
}
