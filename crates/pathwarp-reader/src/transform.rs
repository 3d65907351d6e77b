//! Transforms as style sheets write them (CSS Transforms 1 and 2), computed to a matrix.

use super::value::{Units, length, nested};
use cssparser::{Parser, Token};
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};

/// Computes the transform of an element. `declared` gives the values of the properties that make it; `reference` is the box that percentages
/// and the origin refer to; `is_box`: it is laid out by CSS, so that it turns about its centre. Returns `None` for what is not flat or not valid.
pub(super) fn matrix<'a>(
    declared: impl Fn(&str) -> Option<&'a str>,
    units: &Units,
    reference: Rect,
    is_box: bool,
) -> Option<Affine> {
    let set = |name: &str| declared(name).map(str::trim).filter(|v| !v.eq_ignore_ascii_case("none"));
    let size = (reference.width(), reference.height());
    let translate = set("translate").map_or(Some(Affine::IDENTITY), |v| {
        let p = lengths(v, units, size)?;
        Some(Affine::translate((p[0], p.get(1).copied().unwrap_or(0.0))))
    })?;
    let rotate = set("rotate").map_or(Some(0.0), angle)?;
    let scale = set("scale").map_or(Some(Affine::IDENTITY), |v| {
        let s = v.split_ascii_whitespace().map(factor).collect::<Option<Vec<f64>>>()?;
        let x = *s.first()?;
        Some(Affine::scale_non_uniform(x, s.get(1).copied().unwrap_or(x)))
    })?;
    let list = set("transform").map_or(Some(Affine::IDENTITY), |v| functions(v, units, size))?;
    let origin = declared("transform-origin").map_or(Some(None), |v| origin(v, units, size).map(Some))?;
    // Without a declaration, the origin of what CSS does not lay out is the corner of the box that `transform-box` names.
    let origin = origin.or(is_box.then(|| Vec2::new(size.0 / 2.0, size.1 / 2.0)));
    let origin = (reference.origin() + origin.unwrap_or_default()).to_vec2();
    let all =
        Affine::translate(origin) * translate * Affine::rotate(rotate) * scale * list * Affine::translate(-origin);
    all.is_finite().then_some(all)
}

/// `transform-origin`, from the corner of the box.
fn origin(value: &str, units: &Units, size: (f64, f64)) -> Option<Vec2> {
    let words: Vec<&str> = value.split_ascii_whitespace().collect();
    let (first, second) = match words.as_slice() {
        [] => return None,
        [one] if is_vertical(one) => ("center", *one),
        [one] => (*one, "center"),
        [y, x, ..] if is_vertical(y) || matches!(*x, "left" | "right") => (*x, *y),
        [x, y, ..] => (*x, *y),
    };
    let place = |word: &str, full: f64| match word {
        "left" | "top" => Some(0.0),
        "center" => Some(full / 2.0),
        "right" | "bottom" => Some(full),
        other => length(other, units, full),
    };
    Some(Vec2::new(place(first, size.0)?, place(second, size.1)?))
}

fn is_vertical(word: &str) -> bool {
    matches!(word, "top" | "bottom")
}

fn lengths(value: &str, units: &Units, size: (f64, f64)) -> Option<Vec<f64>> {
    let words = value.split_ascii_whitespace().enumerate();
    let all =
        words.map(|(i, w)| length(w, units, if i == 0 { size.0 } else { size.1 })).collect::<Option<Vec<f64>>>()?;
    (!all.is_empty()).then_some(all)
}

/// An angle in radians; without a unit in degrees, as in attributes.
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

/// A number or a percentage.
pub(super) fn factor(text: &str) -> Option<f64> {
    let text = text.trim();
    match text.strip_suffix('%') {
        Some(share) => share.parse::<f64>().ok().map(|s| s / 100.0),
        None => text.parse().ok(),
    }
}

/// A list of functions, of attributes or of style sheets.
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

fn function(name: &str, text: &str, units: &Units, size: (f64, f64)) -> Option<Affine> {
    // Attributes may leave commas out; inside of expressions, spaces do not separate.
    let separators: &[char] =
        if text.contains(',') || text.contains('(') { &[','] } else { &[',', ' ', '\n', '\t', '\r'] };
    let all: Vec<&str> = text.split(separators).map(str::trim).filter(|a| !a.is_empty()).collect();
    let at = |i: usize| all.get(i).copied();
    let x = |i: usize| at(i).map_or(Some(0.0), |a| length(a, units, size.0));
    let y = |i: usize| at(i).map_or(Some(0.0), |a| length(a, units, size.1));
    let turn = |i: usize| at(i).map_or(Some(0.0), angle);
    let by = |i: usize| factor(at(i)?);
    let first = at(0)?;
    Some(match name {
        "matrix" => {
            let c = all.iter().map(|a| length(a, units, 0.0)).collect::<Option<Vec<f64>>>()?;
            Affine::new(c.try_into().ok()?)
        }
        "translate" | "translate3d" => Affine::translate((x(0)?, y(1)?)),
        "translatex" => Affine::translate((x(0)?, 0.0)),
        "translatey" => Affine::translate((0.0, length(first, units, size.1)?)),
        "scale" => Affine::scale_non_uniform(by(0)?, by(1).or_else(|| by(0))?),
        "scale3d" => Affine::scale_non_uniform(by(0)?, by(1)?),
        "scalex" => Affine::scale_non_uniform(by(0)?, 1.0),
        "scaley" => Affine::scale_non_uniform(1.0, by(0)?),
        // Depth is not seen from the front.
        "translatez" | "scalez" => Affine::IDENTITY,
        "rotate" if all.len() == 3 => Affine::rotate_about(turn(0)?, Point::new(x(1)?, y(2)?)),
        "rotate" | "rotatez" => Affine::rotate(turn(0)?),
        "skew" => Affine::skew(turn(0)?.tan(), turn(1)?.tan()),
        "skewx" => Affine::skew(turn(0)?.tan(), 0.0),
        "skewy" => Affine::skew(0.0, turn(0)?.tan()),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNITS: Units = Units { font: 10.0, root_font: 20.0, window: (300.0, 200.0), viewport: (100.0, 50.0) };

    fn of(declared: &[(&str, &'static str)]) -> Option<Point> {
        let find = |name: &str| declared.iter().find(|d| d.0 == name).map(|d| d.1);
        let m = matrix(find, &UNITS, Rect::new(10.0, 20.0, 50.0, 100.0), false)?;
        let p = m * Point::new(1.0, 2.0);
        Some(Point::new((p.x * 1e9).round() / 1e9, (p.y * 1e9).round() / 1e9))
    }

    #[test]
    fn transforms() {
        let at = |x, y| Some(Point::new(x, y));
        // About the corner (10, 20).
        assert_eq!(of(&[("transform", "rotate(90deg)")]), at(28.0, 11.0));
        assert_eq!(of(&[("transform", "rotate(0.25turn)"), ("transform-origin", "-10px -20px")]), at(-2.0, 1.0));
        assert_eq!(
            of(&[("transform", "translate(50%, 1em) scale(2)"), ("transform-origin", "-10px -20px")]),
            at(22.0, 14.0)
        );
        assert_eq!(of(&[("scale", "50%"), ("transform-origin", "center")]), at(15.5, 31.0));
        assert_eq!(
            of(&[("translate", "1px 2px"), ("rotate", "180deg"), ("transform-origin", "left top")]),
            at(20.0, 40.0)
        );
        assert_eq!(of(&[("transform", "matrix(1 0 0 1 3 4), translateX(1px)")]), at(5.0, 6.0));
        assert_eq!(of(&[("transform", "none"), ("transform-origin", "top")]), at(1.0, 2.0));
        for bad in ["rotateX(3deg)", "scale(a)", "translate()", "perspective(3px)", "rotate(3xyz)", "x"] {
            assert_eq!(of(&[("transform", bad)]), None, "{bad}");
        }
    }
}
