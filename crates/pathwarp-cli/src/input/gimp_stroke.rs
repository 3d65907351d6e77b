//! GIMP strokes under a map.

use pathwarp::edit::{self, Offset};
use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::map::{Class, Map};
use pathwarp::refit::{self, PathReport};
use pathwarp::{GeometryError, Outline};
use pathwarp_gimp::{GimpPath, Stroke};

/// A path's strokes under a map.
pub(super) struct WarpedStrokes {
    pub(super) strokes: Vec<Stroke>,
    pub(super) report: PathReport,
}

impl WarpedStrokes {
    /// The strokes of `path`, unless these have fewer segments.
    pub(super) fn or_fewer(self, path: &GimpPath) -> Self {
        let segments = self.report.segments_in;
        if self.report.segments_out < segments {
            return self;
        }
        let mut report = PathReport::default();
        (report.segments_in, report.segments_out) = (segments, segments);
        Self { strokes: path.strokes.clone(), report }
    }
}

/// Warps the strokes of `path`, one copy for each of `places`.
pub(super) fn warp_strokes(
    path: &GimpPath,
    places: &[Affine],
    map: &dyn Map,
    options: &refit::Options,
) -> Result<WarpedStrokes, GeometryError> {
    let mut out = WarpedStrokes { strokes: Vec::new(), report: PathReport::default() };
    let segments = |s: &Stroke| if s.closed { s.anchors() } else { s.anchors().saturating_sub(1) };
    for (place, stroke) in places.iter().flat_map(|p| path.strokes.iter().map(move |s| (*p, s))) {
        if let Class::Affine(m) = map.class() {
            // Every control point is kept, including handles that belong to no segment.
            let m = m * place;
            out.strokes.push(if m == Affine::IDENTITY { stroke.clone() } else { transformed(stroke, m) });
            out.report.segments_in += segments(stroke);
            out.report.segments_out += segments(stroke);
            continue;
        }
        let placed = transformed(stroke, place);
        let Some(subpath) = placed.subpath() else { continue };
        if subpath.segs.is_empty() {
            out.strokes.push(warp_single_anchors(&placed, map)?);
            continue;
        }
        let result = refit::warp_path(&Outline { subpaths: vec![subpath] }, map, options)?;
        let outline = Outline::from(&result.path);
        out.strokes.extend(outline.subpaths.iter().map(Stroke::from_subpath));
        let r = result.report;
        out.report.segments_in += r.segments_in;
        out.report.segments_out += r.segments_out;
        out.report.add(r);
    }
    Ok(out)
}

/// The strokes at a distance from an outline.
pub(super) fn moved_strokes(
    outline: &Outline,
    offset: &Offset,
    options: &refit::Options,
) -> Result<WarpedStrokes, GeometryError> {
    let moved = edit::moved(outline, offset, options)?;
    let strokes = Outline::from(&moved.path).subpaths.iter().map(Stroke::from_subpath).collect();
    Ok(WarpedStrokes { strokes, report: moved.report })
}

fn transformed(stroke: &Stroke, m: Affine) -> Stroke {
    let points = stroke.points.iter().map(|&[x, y]| m * Point::new(x, y));
    Stroke { closed: stroke.closed, points: points.map(|p| [p.x, p.y]).collect() }
}

/// Maps anchors that have no segment, and their handles by the map's derivative.
fn warp_single_anchors(stroke: &Stroke, map: &dyn Map) -> Result<Stroke, GeometryError> {
    let mut points = Vec::with_capacity(stroke.points.len());
    for [incoming, anchor, outgoing] in stroke.triples() {
        let j = map.jet(anchor);
        let along = |v: Vec2| j.p + j.dx * v.x + j.dy * v.y;
        let image = [along(incoming - anchor), j.p, along(outgoing - anchor)];
        if image.iter().any(|p| !p.is_finite()) {
            return Err(GeometryError::Infinity { shape: "path".to_owned(), at: anchor });
        }
        points.extend(image.map(|p| [p.x, p.y]));
    }
    Ok(Stroke { closed: stroke.closed, points })
}

/// Largest distance by which single precision, in which an XCF stores coordinates, moves a point of the stroke.
pub(super) fn single_precision_error(s: &Stroke) -> f64 {
    let off = |v: f64| f64::from(v as f32) - v;
    s.points.iter().map(|&[x, y]| off(x).hypot(off(y))).fold(0.0, f64::max)
}
