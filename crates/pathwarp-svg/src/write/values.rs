//! Attribute values: path data, dashes, links, positions.

use crate::bend::outcome::WarpedPart;
use crate::bend::picture::BentImage;
use crate::scene::model::Part;
use crate::source::number::{outline_data, short};
use crate::source::text::SourceText;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::kurbo::{Affine, Rect, Shape as _};
use pathwarp_reader::xml::escape;

/// Position of a bent bitmap as attributes of its element.
pub(super) fn bent_attributes(bent: &BentImage, to: Affine) -> [(&'static str, String); 5] {
    let r = to.transform_rect_bbox(bent.area);
    [
        ("x", short(r.x0)),
        ("y", short(r.y0)),
        ("width", short(r.width())),
        ("height", short(r.height())),
        ("preserveAspectRatio", "none".into()),
    ]
}

/// A file as a `data:` URL.
pub(super) fn data_url(media_type: &str, data: &[u8]) -> String {
    format!("data:{media_type};base64,{}", STANDARD.encode(data))
}

/// A bent bitmap as a `data:` URL.
pub(super) fn bent_url(bent: &BentImage) -> String {
    data_url("image/png", &bent.png)
}

/// Bounding box of a part's path in its user space.
pub(super) fn part_box(p: &Part, warped: Option<&WarpedPart>) -> Rect {
    match warped {
        Some(w) => w.fill.iter().fold(w.path.bounding_box(), |b, f| b.union(f.bounding_box())),
        None => p.local.bounding_box().unwrap_or_default(),
    }
}

/// Path data of a part. If it is unchanged, its original text is used where possible.
pub(super) fn part_data(p: &Part, warped: Option<&WarpedPart>, source: &SourceText) -> String {
    let own = |e| source.attr(e, "d").filter(|_| source.elements[e].tag == "path");
    match (warped, p.drawn.and_then(own)) {
        (Some(w), _) => w.data.clone().unwrap_or_else(|| w.text(&w.path)),
        (None, Some(d)) => escape(&d),
        (None, None) => outline_data(&p.local),
    }
}

/// Factor for the width and dashes of a part's stroke.
pub(super) fn stroke_scale(warped: Option<&WarpedPart>) -> f64 {
    warped.map_or(1.0, |w| w.stroke.scale())
}

/// Value of `stroke-dasharray`.
pub(super) fn dashes(s: &usvg::Stroke, scale: f64) -> String {
    s.dasharray()
        .map_or("none".into(), |list| list.iter().map(|d| short(f64::from(*d) * scale)).collect::<Vec<_>>().join(","))
}

/// A colour as `#rrggbb`.
pub(super) fn color(c: usvg::Color) -> String {
    format!("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue)
}
