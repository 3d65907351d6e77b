//! Triangulates polygons with lyon. Since lyon computes in single precision, shapes are scaled to the unit box first, which leaves
//! seven digits relative to their size.

use crate::error::Error;
use crate::flatten::Polygon;
use crate::shape::NamedShape;
use lyon_tessellation::geom::euclid::default::Point2D;
use lyon_tessellation::path::Path;
use lyon_tessellation::{BuffersBuilder, FillOptions, FillRule, FillTessellator, FillVertex, VertexBuffers};
use pathwarp::kurbo::{Point, Rect};

/// Triangles in the plane of the drawing.
#[derive(Debug)]
pub struct FlatMesh {
    /// Vertices.
    pub points: Vec<Point>,
    /// Indices of the corners of triangles, all of one orientation.
    pub triangles: Vec<[u32; 3]>,
}

/// Triangulates a filled shape.
pub(crate) fn fill(shape: &NamedShape<'_>, polygons: &[Polygon]) -> Result<FlatMesh, Error> {
    let all = polygons.iter().flat_map(|p| &p.points);
    let bounds = all.fold(None, |r: Option<Rect>, p| Some(r.map_or(Rect::from_points(*p, *p), |r| r.union_pt(*p))));
    let empty = FlatMesh { points: Vec::new(), triangles: Vec::new() };
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
        // Filling closes every subpath.
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
    Ok(FlatMesh { points: buffers.vertices, triangles })
}
