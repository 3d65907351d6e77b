//! Polygons to triangles, by lyon. It computes in single precision: the shape is brought to the unit box for it, which leaves
//! seven digits of the shape's own size.

use crate::flatten::Polygon;
use crate::{Error, Shape};
use lyon_tessellation::geom::euclid::default::Point2D;
use lyon_tessellation::path::Path;
use lyon_tessellation::{BuffersBuilder, FillOptions, FillRule, FillTessellator, FillVertex, VertexBuffers};
use pathwarp::kurbo::{Point, Rect};

/// Triangles in the drawing's plane.
pub(crate) struct Flat {
    pub(crate) points: Vec<Point>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

pub(crate) fn fill(shape: &Shape<'_>, polygons: &[Polygon]) -> Result<Flat, Error> {
    let all = polygons.iter().flat_map(|p| &p.points);
    let bounds = all.fold(None, |r: Option<Rect>, p| Some(r.map_or(Rect::from_points(*p, *p), |r| r.union_pt(*p))));
    let empty = Flat { points: Vec::new(), triangles: Vec::new() };
    let Some(b) = bounds else { return Ok(empty) };
    let size = b.width().max(b.height());
    if size == 0.0 {
        return Ok(empty);
    }
    let c = b.center();
    let mut path = Path::builder();
    for polygon in polygons.iter().filter(|p| p.points.len() > 2) {
        let at = |p: &Point| Point2D::new(((p.x - c.x) / size) as f32, ((p.y - c.y) / size) as f32);
        path.begin(at(&polygon.points[0]));
        for p in &polygon.points[1..] {
            path.line_to(at(p));
        }
        // Filling closes every run.
        path.end(true);
    }
    let mut buffers: VertexBuffers<Point, u32> = VertexBuffers::new();
    let rule = if shape.even_odd { FillRule::EvenOdd } else { FillRule::NonZero };
    let vertex = |v: FillVertex<'_>| {
        let p = v.position();
        Point::new(f64::from(p.x) * size + c.x, f64::from(p.y) * size + c.y)
    };
    FillTessellator::new()
        .tessellate_path(
            &path.build(),
            &FillOptions::default().with_fill_rule(rule),
            &mut BuffersBuilder::new(&mut buffers, vertex),
        )
        .map_err(|e| Error::Tessellation { shape: shape.name.to_owned(), why: e.to_string() })?;
    let triangles = buffers.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Ok(Flat { points: buffers.vertices, triangles })
}
