//! Boxes and lengths of shapes in their own coordinates, for `transform-box: fill-box` and `pathLength`.

use super::value::{Units, length};
use pathwarp::Outline;
use pathwarp::kurbo::{Ellipse, ParamCurveArclen as _, Point, Rect, Shape as _};

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

/// Accuracy of lengths, as a fraction of the shape's size.
const ACCURACY: f64 = 1e-7;

/// The length of a shape's outline.
pub(super) fn shape_length<'a>(tag: &str, attr: impl Fn(&str) -> Option<&'a str>, units: &Units) -> Option<f64> {
    let area = shape_box(tag, &attr, units)?;
    let accuracy = ACCURACY * area.width().hypot(area.height());
    let points = |closed: bool| {
        let numbers: Vec<f64> = svgtypes::NumberListParser::from(attr("points")?).map_while(Result::ok).collect();
        let all: Vec<Point> = numbers.chunks_exact(2).map(|p| Point::new(p[0], p[1])).collect();
        let open: f64 = all.windows(2).map(|w| w[0].distance(w[1])).sum();
        Some(open + if closed { all.first()?.distance(*all.last()?) } else { 0.0 })
    };
    let length = match tag {
        "rect" => {
            let (w, h) = units.viewport;
            let radius = |name: &str, full: f64| attr(name).and_then(|v| length(v, units, full)).filter(|r| *r >= 0.0);
            let (rx, ry) = (radius("rx", w), radius("ry", h));
            let rx = rx.or(ry).unwrap_or(0.0).min(area.width() / 2.0);
            let ry = ry.unwrap_or(rx).min(area.height() / 2.0);
            let corners = Ellipse::new((0.0, 0.0), (rx, ry), 0.0).perimeter(accuracy);
            2.0 * (area.width() + area.height() - 2.0 * (rx + ry)) + corners
        }
        "circle" | "ellipse" => {
            Ellipse::new(area.center(), (area.width() / 2.0, area.height() / 2.0), 0.0).perimeter(accuracy)
        }
        "line" => area.width().hypot(area.height()),
        "polyline" => points(false)?,
        "polygon" => points(true)?,
        "path" => {
            let path = Outline::from_svg_lossy(attr("d")?).to_bez_path(accuracy);
            path.segments().map(|s| s.arclen(accuracy)).sum()
        }
        _ => return None,
    };
    Some(length).filter(|l| l.is_finite() && *l > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const UNITS: Units = Units { font: 10.0, root_font: 10.0, window: (100.0, 100.0), viewport: (100.0, 100.0) };

    #[test]
    fn lengths() {
        for (tag, attributes, wanted) in [
            ("rect", &[("width", "30"), ("height", "20")][..], 100.0),
            ("rect", &[("width", "30"), ("height", "20"), ("rx", "5")], 60.0 + 10.0 * PI),
            ("circle", &[("r", "10%")], 20.0 * PI),
            ("line", &[("x2", "3"), ("y1", "4")], 5.0),
            ("polyline", &[("points", "0,0 3 4 3,0")], 9.0),
            ("polygon", &[("points", "0,0 3 4 3,0")], 12.0),
            ("path", &[("d", "M0 0H10V10z A5 5 0 0 1 10 0")], 10.0 + 10.0 + 200_f64.sqrt() + 5.0 * PI),
        ] {
            let attr = |name: &str| attributes.iter().find(|a| a.0 == name).map(|a| a.1);
            let found = shape_length(tag, attr, &UNITS).unwrap();
            assert!((found - wanted).abs() < 1e-4, "{tag} {attributes:?}: {found}, not {wanted}");
        }
    }
}
