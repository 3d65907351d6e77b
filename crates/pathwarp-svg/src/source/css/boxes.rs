//! Bounding boxes of shapes and groups in their own coordinates, for `transform-box: fill-box`.

use super::value::{Units, length};
use pathwarp::Outline;
use pathwarp::kurbo::{Point, Rect};

/// The box of a shape whose attributes `attr` gives. `None` for what is no shape, or has no size.
pub(super) fn shape_box<'a>(tag: &str, attr: impl Fn(&str) -> Option<&'a str>, units: &Units) -> Option<Rect> {
    let (w, h) = units.viewport;
    let optional = |name: &str, full: f64| attr(name).and_then(|v| length(v, units, full));
    let get = |name: &str, full: f64| optional(name, full).unwrap_or(0.0);
    let points = || {
        let numbers: Vec<f64> = svgtypes::NumberListParser::from(attr("points")?).map_while(Result::ok).collect();
        let all = numbers.chunks_exact(2).map(|p| Rect::from_points((p[0], p[1]), (p[0], p[1])));
        all.reduce(|a, b| a.union(b))
    };
    match tag {
        "rect" | "image" => {
            let corner = Point::new(get("x", w), get("y", h));
            Some(Rect::from_origin_size(corner, (get("width", w), get("height", h))))
        }
        "circle" => {
            let r = get("r", w.hypot(h) / std::f64::consts::SQRT_2);
            Some(Rect::from_center_size((get("cx", w), get("cy", h)), (2.0 * r, 2.0 * r)))
        }
        "ellipse" => {
            let (rx, ry) = (optional("rx", w), optional("ry", h));
            let (rx, ry) = (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
            Some(Rect::from_center_size((get("cx", w), get("cy", h)), (2.0 * rx, 2.0 * ry)))
        }
        "line" => Some(Rect::from_points((get("x1", w), get("y1", h)), (get("x2", w), get("y2", h)))),
        "polyline" | "polygon" => points(),
        "path" => Outline::from_svg_lossy(attr("d")?).bounding_box(),
        _ => None,
    }
    .filter(Rect::is_finite)
}
