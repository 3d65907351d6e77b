//! Computes matrices from CSS transforms (CSS Transforms 1 and 2), and the boxes and lengths of shapes.

use crate::value::{Units, length, nested};
use cssparser::{Parser, Token};
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Ellipse, ParamCurveArclen as _, Point, Rect, Shape as _, Vec2};

/// Computes the transform of an element. `declared` looks up the properties that make it up; percentages and the origin refer to
/// the box `reference`. If `is_box`, CSS lays the element out, and it turns about its centre. Returns `None` if the transform is
/// invalid or leaves the plane.
pub(super) fn matrix<'a>(
    declared: impl Fn(&str) -> Option<&'a str>,
    units: &Units,
    reference: Rect,
    is_box: bool,
) -> Option<Affine> {
    let set = |name: &str| declared(name).map(str::trim).filter(|v| !v.eq_ignore_ascii_case("none"));
    let size = (reference.width(), reference.height());
    let translate = set("translate").map_or(Some(Affine::IDENTITY), |v| {
        let shift = lengths(v, units, size)?;
        Some(Affine::translate((*shift.first()?, shift.get(1).copied().unwrap_or(0.0))))
    })?;
    let rotate = set("rotate").map_or(Some(0.0), angle)?;
    let scale = set("scale").map_or(Some(Affine::IDENTITY), |v| {
        let factors = v.split_ascii_whitespace().map(factor).collect::<Option<Vec<f64>>>()?;
        let x = *factors.first()?;
        Some(Affine::scale_non_uniform(x, factors.get(1).copied().unwrap_or(x)))
    })?;
    let list = set("transform").map_or(Some(Affine::IDENTITY), |v| functions(v, units, size))?;
    let origin = declared("transform-origin").map_or(Some(None), |v| origin(v, units, size).map(Some))?;
    // The origin defaults to the centre of CSS boxes, and to the corner of the reference box otherwise.
    let origin = origin.or(is_box.then(|| Vec2::new(size.0 / 2.0, size.1 / 2.0)));
    let origin = (reference.origin() + origin.unwrap_or_default()).to_vec2();
    let all =
        Affine::translate(origin) * translate * Affine::rotate(rotate) * scale * list * Affine::translate(-origin);
    all.is_finite().then_some(all)
}

/// Reads `transform-origin`, relative to the corner of the box.
fn origin(value: &str, units: &Units, size: (f64, f64)) -> Option<Vec2> {
    let words: Vec<&str> = value.split_ascii_whitespace().collect();
    let (first, second) = match words.as_slice() {
        [] => return None,
        [one] if is_vertical(one) => ("center", *one),
        [one] => (*one, "center"),
        [y, x, ..] if is_vertical(y) || matches!(*x, "left" | "right") => (*x, *y),
        [x, y, ..] => (*x, *y),
    };
    let offset = |word: &str, full: f64| match word {
        "left" | "top" => Some(0.0),
        "center" => Some(full / 2.0),
        "right" | "bottom" => Some(full),
        other => length(other, units, full),
    };
    Some(Vec2::new(offset(first, size.0)?, offset(second, size.1)?))
}

fn is_vertical(word: &str) -> bool {
    matches!(word, "top" | "bottom")
}

/// Reads lengths; percentages refer to the width in the first, and to the height in the others.
fn lengths(value: &str, units: &Units, (width, height): (f64, f64)) -> Option<Vec<f64>> {
    let words = value.split_ascii_whitespace().enumerate();
    words.map(|(i, w)| length(w, units, if i == 0 { width } else { height })).collect()
}

/// Reads an angle and returns it in radians. Without a unit, as in attributes, it is in degrees.
fn angle(text: &str) -> Option<f64> {
    let text = text.trim();
    let split = text.find(|c: char| c.is_ascii_alphabetic() && c != 'e').unwrap_or(text.len());
    let number: f64 = text[..split].parse().ok()?;
    Some(match text[split..].to_ascii_lowercase().as_str() {
        "" | "deg" => number.to_radians(),
        "rad" => number,
        "grad" => (number * 0.9).to_radians(),
        "turn" => number * std::f64::consts::TAU,
        _ => return None,
    })
}

/// Reads a number or a percentage.
pub(super) fn factor(text: &str) -> Option<f64> {
    let text = text.trim();
    match text.strip_suffix('%') {
        Some(share) => share.parse::<f64>().ok().map(|s| s / 100.0),
        None => text.parse().ok(),
    }
}

/// Reads a list of transform functions, in the syntax of attributes or of style sheets.
fn functions(value: &str, units: &Units, size: (f64, f64)) -> Option<Affine> {
    let mut input = Parser::new(value);
    let mut out = Affine::IDENTITY;
    loop {
        let name = match input.next() {
            Err(_) => return Some(out),
            Ok(Token::Comma) => continue,
            Ok(Token::Function(name)) => name.to_ascii_lowercase(),
            Ok(_) => return None,
        };
        out *= function(&name, nested(&mut input), units, size)?;
    }
}

/// The matrix of a transform function. Its name is in lower case.
fn function(name: &str, text: &str, units: &Units, size: (f64, f64)) -> Option<Affine> {
    // Attributes may leave out commas. Spaces within expressions do not separate arguments.
    let separators: &[char] =
        if text.contains(',') || text.contains('(') { &[','] } else { &[',', ' ', '\n', '\t', '\r'] };
    let all: Vec<&str> = text.split(separators).map(str::trim).filter(|a| !a.is_empty()).collect();
    let argument = |i: usize| all.get(i).copied();
    let x = |i: usize| argument(i).map_or(Some(0.0), |a| length(a, units, size.0));
    let y = |i: usize| argument(i).map_or(Some(0.0), |a| length(a, units, size.1));
    let turn = |i: usize| argument(i).map_or(Some(0.0), angle);
    let scale = |i: usize| factor(argument(i)?);
    // No function goes without arguments.
    let first = argument(0)?;
    Some(match name {
        "matrix" => {
            let c = all.iter().map(|a| length(a, units, 0.0)).collect::<Option<Vec<f64>>>()?;
            Affine::new(c.try_into().ok()?)
        }
        "translate" | "translate3d" => Affine::translate((x(0)?, y(1)?)),
        "translatex" => Affine::translate((x(0)?, 0.0)),
        "translatey" => Affine::translate((0.0, length(first, units, size.1)?)),
        "scale" => Affine::scale_non_uniform(scale(0)?, scale(1).or_else(|| scale(0))?),
        "scale3d" => Affine::scale_non_uniform(scale(0)?, scale(1)?),
        "scalex" => Affine::scale_non_uniform(scale(0)?, 1.0),
        "scaley" => Affine::scale_non_uniform(1.0, scale(0)?),
        // Depth is invisible from the front.
        "translatez" | "scalez" => Affine::IDENTITY,
        "rotate" if all.len() == 3 => Affine::rotate_about(turn(0)?, Point::new(x(1)?, y(2)?)),
        "rotate" | "rotatez" => Affine::rotate(turn(0)?),
        "skew" => Affine::skew(turn(0)?.tan(), turn(1)?.tan()),
        "skewx" => Affine::skew(turn(0)?.tan(), 0.0),
        "skewy" => Affine::skew(0.0, turn(0)?.tan()),
        _ => return None,
    })
}

/// Reads a list of points up to the first that is invalid.
fn points(list: &str) -> Vec<Point> {
    let numbers: Vec<f64> = svgtypes::NumberListParser::from(list).map_while(Result::ok).collect();
    numbers.chunks_exact(2).map(|p| Point::new(p[0], p[1])).collect()
}

/// The bounding box of a shape; `attr` looks up its attributes. `None` for other elements and for shapes without a size.
pub(super) fn shape_box<'a>(tag: &str, attr: impl Fn(&str) -> Option<&'a str>, units: &Units) -> Option<Rect> {
    let optional = |name: &str| attr(name).and_then(|v| units.length(name, v));
    let get = |name: &str| optional(name).unwrap_or(0.0);
    match tag {
        "rect" | "image" => Some(Rect::from_origin_size((get("x"), get("y")), (get("width"), get("height")))),
        "circle" => Some(Rect::from_center_size((get("cx"), get("cy")), (2.0 * get("r"), 2.0 * get("r")))),
        "ellipse" => {
            let (rx, ry) = (optional("rx"), optional("ry"));
            let (rx, ry) = (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
            Some(Rect::from_center_size((get("cx"), get("cy")), (2.0 * rx, 2.0 * ry)))
        }
        "line" => Some(Rect::from_points((get("x1"), get("y1")), (get("x2"), get("y2")))),
        "polyline" | "polygon" => {
            points(attr("points")?).into_iter().map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))
        }
        "path" => Outline::from_svg_lossy(attr("d")?).bounding_box(),
        _ => None,
    }
    .filter(Rect::is_finite)
}

/// The length of a shape's outline.
pub(super) fn shape_length<'a>(tag: &str, attr: impl Fn(&str) -> Option<&'a str>, units: &Units) -> Option<f64> {
    /// As a fraction of the shape's size.
    const ACCURACY: f64 = 1e-7;
    let area = shape_box(tag, &attr, units)?;
    let accuracy = ACCURACY * area.width().hypot(area.height());
    let length = match tag {
        "rect" => {
            let radius = |name: &str| attr(name).and_then(|v| units.length(name, v)).filter(|r| *r >= 0.0);
            let (rx, ry) = (radius("rx"), radius("ry"));
            let rx = rx.or(ry).unwrap_or(0.0).min(area.width() / 2.0);
            let ry = ry.unwrap_or(rx).min(area.height() / 2.0);
            let corners = Ellipse::new((0.0, 0.0), (rx, ry), 0.0).perimeter(accuracy);
            2.0 * (area.width() + area.height() - 2.0 * (rx + ry)) + corners
        }
        "circle" | "ellipse" => {
            Ellipse::new(area.center(), (area.width() / 2.0, area.height() / 2.0), 0.0).perimeter(accuracy)
        }
        "line" => area.width().hypot(area.height()),
        "polyline" | "polygon" => {
            let all = points(attr("points")?);
            let open: f64 = all.windows(2).map(|w| w[0].distance(w[1])).sum();
            open + if tag == "polygon" { all.first()?.distance(*all.last()?) } else { 0.0 }
        }
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

    const UNITS: Units = Units { font: 10.0, root_font: 20.0, window: (300.0, 200.0), viewport: (100.0, 50.0) };

    /// The image of (1, 2) under the declared transform.
    fn image(declared: &[(&str, &'static str)]) -> Option<Point> {
        let find = |name: &str| declared.iter().find(|d| d.0 == name).map(|d| d.1);
        let m = matrix(find, &UNITS, Rect::new(10.0, 20.0, 50.0, 100.0), false)?;
        let p = m * Point::new(1.0, 2.0);
        Some(Point::new((p.x * 1e9).round() / 1e9, (p.y * 1e9).round() / 1e9))
    }

    #[test]
    fn transforms() {
        let at = |x, y| Some(Point::new(x, y));
        // About the corner (10, 20).
        assert_eq!(image(&[("transform", "rotate(90deg)")]), at(28.0, 11.0));
        assert_eq!(image(&[("transform", "rotate(0.25turn)"), ("transform-origin", "-10px -20px")]), at(-2.0, 1.0));
        assert_eq!(
            image(&[("transform", "translate(50%, 1em) scale(2)"), ("transform-origin", "-10px -20px")]),
            at(22.0, 14.0)
        );
        assert_eq!(image(&[("scale", "50%"), ("transform-origin", "center")]), at(15.5, 31.0));
        assert_eq!(
            image(&[("translate", "1px 2px"), ("rotate", "180deg"), ("transform-origin", "left top")]),
            at(20.0, 40.0)
        );
        assert_eq!(image(&[("transform", "matrix(1 0 0 1 3 4), translateX(1px)")]), at(5.0, 6.0));
        assert_eq!(image(&[("transform", "none"), ("transform-origin", "top")]), at(1.0, 2.0));
        for bad in ["rotateX(3deg)", "scale(a)", "translate()", "perspective(3px)", "rotate(3xyz)", "x"] {
            assert_eq!(image(&[("transform", bad)]), None, "{bad}");
        }
    }

    const SMALL: Units = Units { font: 10.0, root_font: 10.0, window: (100.0, 100.0), viewport: (100.0, 100.0) };

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
            let found = shape_length(tag, attr, &SMALL).unwrap();
            assert!((found - wanted).abs() < 1e-4, "{tag} {attributes:?}: {found}, not {wanted}");
        }
    }
}
