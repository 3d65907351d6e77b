//! Painted areas as polygons (of the nonzero rule), with strokes expanded by the renderer.

use crate::polygon::Polygon;
use kurbo::{CubicBez, ParamCurve as _, Point, QuadBez};
use resvg::tiny_skia::{Path, PathBuilder, PathSegment, StrokeDash, Transform};
use resvg::usvg::{self, Node, Tree};

/// The painted area of a drawing: of each path the stroke or, if it has none, the fill.
pub fn painted(tree: &Tree) -> Polygon {
    let mut rings = Vec::new();
    collect(tree.root(), &mut rings);
    Polygon::of_rings(rings.iter().map(Vec::as_slice))
}

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

/// Divides each curve of a path into sixteen parts.
fn divided(path: &Path) -> Path {
    const PARTS: u32 = 16;
    let point = |p: resvg::tiny_skia::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let mut out = PathBuilder::new();
    let mut at = Point::ZERO;
    let curve = |out: &mut PathBuilder, c: CubicBez| {
        for i in 0..PARTS {
            let part = c.subsegment(f64::from(i) / f64::from(PARTS)..f64::from(i + 1) / f64::from(PARTS));
            let [b, c, d] = [part.p1, part.p2, part.p3].map(|p| (p.x as f32, p.y as f32));
            out.cubic_to(b.0, b.1, c.0, c.1, d.0, d.1);
        }
    };
    for s in path.segments() {
        at = match s {
            PathSegment::MoveTo(p) => {
                out.move_to(p.x, p.y);
                point(p)
            }
            PathSegment::LineTo(p) => {
                out.line_to(p.x, p.y);
                point(p)
            }
            PathSegment::QuadTo(b, c) => {
                curve(&mut out, QuadBez::new(at, point(b), point(c)).raise());
                point(c)
            }
            PathSegment::CubicTo(b, c, d) => {
                curve(&mut out, CubicBez::new(at, point(b), point(c), point(d)));
                point(d)
            }
            PathSegment::Close => {
                out.close();
                at
            }
        };
    }
    out.finish().unwrap()
}

/// Samples a path so finely that, once the polygon is mapped point by point, its sides are close to the image of the path.
fn flatten(path: &Path, out: &mut Vec<Vec<Point>>) {
    /// The least number of samples of a curve.
    const MIN_SAMPLES: f64 = 16.0;
    /// The largest distance of samples, in units.
    const MAX_STEP: f64 = 0.35;
    let point = |p: resvg::tiny_skia::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let mut ring: Vec<Point> = Vec::new();
    let line = |ring: &mut Vec<Point>, to: Point| {
        let from = *ring.last().unwrap();
        let n = ((to - from).hypot() / MAX_STEP).ceil().max(1.0);
        ring.extend((1..=n as u32).map(|i| from.lerp(to, f64::from(i) / n)));
    };
    let curve = |ring: &mut Vec<Point>, length: f64, at: &dyn Fn(f64) -> Point| {
        let n = (length / MAX_STEP).ceil().max(MIN_SAMPLES);
        ring.extend((1..=n as u32).map(|i| at(f64::from(i) / n)));
    };
    for s in path.segments() {
        match s {
            PathSegment::MoveTo(p) => {
                out.push(std::mem::replace(&mut ring, vec![point(p)]));
            }
            PathSegment::LineTo(p) => line(&mut ring, point(p)),
            PathSegment::QuadTo(b, c) => {
                let (a, b, c) = (*ring.last().unwrap(), point(b), point(c));
                curve(&mut ring, (b - a).hypot() + (c - b).hypot(), &|t| a.lerp(b, t).lerp(b.lerp(c, t), t));
            }
            PathSegment::CubicTo(b, c, d) => {
                let (a, b, c, d) = (*ring.last().unwrap(), point(b), point(c), point(d));
                curve(&mut ring, (b - a).hypot() + (c - b).hypot() + (d - c).hypot(), &|t| {
                    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
                    ab.lerp(bc, t).lerp(bc.lerp(cd, t), t)
                });
            }
            PathSegment::Close => {
                let start = ring[0];
                line(&mut ring, start);
            }
        }
    }
    out.push(ring);
    out.retain(|r| r.len() > 2);
}
