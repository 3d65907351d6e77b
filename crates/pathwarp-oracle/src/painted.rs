//! Painted areas as polygons (of the nonzero rule), with strokes expanded by the renderer.

use crate::polygon::Polygon;
use kurbo::{BezPath, ParamCurve as _, PathEl, Point};
use resvg::tiny_skia::{self, Path, PathBuilder, PathSegment, StrokeDash, Transform};
use resvg::usvg::{self, Node, Tree};

/// The painted area of a drawing: of each path the stroke or, if it has none, the fill.
pub fn painted(tree: &Tree) -> Polygon {
    let mut rings = Vec::new();
    collect(tree.root(), &mut rings);
    Polygon::of_rings(rings.iter().map(Vec::as_slice))
}

/// Adds the rings of all painted paths of a group.
fn collect(g: &usvg::Group, out: &mut Vec<Vec<Point>>) {
    for n in g.children() {
        match n {
            Node::Group(g) => collect(g, out),
            Node::Path(p) => {
                let painted = p.stroke().map_or_else(|| p.data().clone(), |s| stroked(p.data(), s));
                flatten(&painted.transform(p.abs_transform()).unwrap(), out);
            }
            Node::Image(_) | Node::Text(_) => {}
        }
    }
}

/// The outline of a stroke. The renderer's stroker ignores lengths below 1/4096 and works to a quarter of a unit at resolution 1, so
/// everything is enlarged. It also takes a cubic for a line if its middle is off by up to a 450th of its length, so curves are divided.
fn stroked(path: &Path, stroke: &usvg::Stroke) -> Path {
    const ENLARGEMENT: f32 = 64.0;
    const RESOLUTION: f32 = 100.0;
    let scaled = |k: f32, path: Path| path.transform(Transform::from_scale(k, k)).unwrap();
    let mut style = stroke.to_tiny_skia();
    style.width *= ENLARGEMENT;
    style.dash = None;
    let mut path = scaled(ENLARGEMENT, path.clone());
    if let Some(dashes) = stroke.dasharray() {
        let dashes = dashes.iter().map(|d| d * ENLARGEMENT).collect();
        path = path.dash(&StrokeDash::new(dashes, stroke.dashoffset() * ENLARGEMENT).unwrap(), RESOLUTION).unwrap();
    }
    scaled(1.0 / ENLARGEMENT, divided(&path).stroke(&style, RESOLUTION).unwrap())
}

fn to_bez_path(path: &Path) -> BezPath {
    let point = |p: tiny_skia::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let element = |s: PathSegment| match s {
        PathSegment::MoveTo(p) => PathEl::MoveTo(point(p)),
        PathSegment::LineTo(p) => PathEl::LineTo(point(p)),
        PathSegment::QuadTo(b, c) => PathEl::QuadTo(point(b), point(c)),
        PathSegment::CubicTo(b, c, d) => PathEl::CurveTo(point(b), point(c), point(d)),
        PathSegment::Close => PathEl::ClosePath,
    };
    path.segments().map(element).collect()
}

/// Divides each curve of a path into sixteen parts.
fn divided(path: &Path) -> Path {
    const PARTS: u32 = 16;
    let (path, mut out) = (to_bez_path(path), PathBuilder::new());
    for (i, element) in path.elements().iter().enumerate() {
        match (element, path.get_seg(i)) {
            (PathEl::MoveTo(p), _) => out.move_to(p.x as f32, p.y as f32),
            (PathEl::LineTo(p), _) => out.line_to(p.x as f32, p.y as f32),
            (PathEl::QuadTo(..) | PathEl::CurveTo(..), Some(curve)) => {
                for k in 0..PARTS {
                    let part = curve.subsegment(f64::from(k) / f64::from(PARTS)..f64::from(k + 1) / f64::from(PARTS));
                    let cubic = part.to_cubic();
                    let [b, c, d] = [cubic.p1, cubic.p2, cubic.p3].map(|p| (p.x as f32, p.y as f32));
                    out.cubic_to(b.0, b.1, c.0, c.1, d.0, d.1);
                }
            }
            _ => out.close(),
        }
    }
    out.finish().unwrap()
}

/// Samples a path so finely that, once the polygon is mapped point by point, its sides are close to the image of the path.
fn flatten(path: &Path, out: &mut Vec<Vec<Point>>) {
    /// The least number of samples of a curve.
    const MIN_SAMPLES: f64 = 16.0;
    /// The largest distance of samples, in units.
    const MAX_STEP: f64 = 0.35;
    let (path, mut ring) = (to_bez_path(path), Vec::new());
    for (i, element) in path.elements().iter().enumerate() {
        if let PathEl::MoveTo(p) = element {
            out.push(std::mem::replace(&mut ring, vec![*p]));
        } else if let Some(seg) = path.get_seg(i) {
            let c = seg.to_cubic();
            let length = (c.p1 - c.p0).hypot() + (c.p2 - c.p1).hypot() + (c.p3 - c.p2).hypot();
            let is_curve = matches!(element, PathEl::QuadTo(..) | PathEl::CurveTo(..));
            let n = (length / MAX_STEP).ceil().max(if is_curve { MIN_SAMPLES } else { 1.0 }) as u32;
            ring.extend((1..=n).map(|k| seg.eval(f64::from(k) / f64::from(n))));
        }
    }
    out.push(ring);
    out.retain(|r| r.len() > 2);
}
