//! Parsing of values: numbers, lengths and angles with units, points and boxes.

use super::length::parse;
use super::number::{ValueError, split};
use super::{Axis, Frame};
use kurbo::{Point, Rect, Size};

/// A plain number or a percentage.
pub(super) fn number(text: &str) -> Result<f64, ValueError> {
    match split(text) {
        Some((v, "")) => Ok(v),
        Some((v, "%")) => Ok(v / 100.0),
        Some((_, unit)) => Err(ValueError::UnexpectedUnit(unit.to_owned())),
        None => Err(ValueError::NotANumber),
    }
}

/// A whole number.
pub(super) fn count(text: &str) -> Result<f64, ValueError> {
    match split(text) {
        Some((v, "")) if v.fract() == 0.0 => Ok(v),
        _ => Err(ValueError::NotWhole),
    }
}

/// A length in user units.
pub(super) fn length(text: &str, axis: Axis, frame: &Frame) -> Result<f64, ValueError> {
    Ok(parse(text)?.in_units(axis, frame))
}

/// An angle in degrees.
pub(super) fn angle(text: &str) -> Result<f64, ValueError> {
    let Some((v, unit)) = split(text) else {
        return Err(ValueError::NotAnAngle);
    };
    match unit {
        "" | "deg" | "°" => Ok(v),
        "rad" => Ok(v.to_degrees()),
        "grad" => Ok(v * 0.9),
        "turn" => Ok(v * 360.0),
        _ => Err(ValueError::UnknownAngleUnit(unit.to_owned())),
    }
}

/// `expected` numbers separated by commas, white space or both.
pub(super) fn numbers(text: &str, expected: usize) -> Result<Vec<f64>, ValueError> {
    let parse = |word: &str| match split(word) {
        Some((v, "")) => Ok(v),
        _ => Err(within(word, ValueError::NotANumber)),
    };
    let out: Vec<f64> = words(text).map(parse).collect::<Result<_, _>>()?;
    if out.len() == expected { Ok(out) } else { Err(ValueError::WrongCount { found: out.len(), expected }) }
}

fn within(word: &str, error: ValueError) -> ValueError {
    ValueError::In { word: word.to_owned(), error: Box::new(error) }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty())
}

/// A point. Percentages count from the left and top of the frame.
pub(super) fn point(text: &str, frame: &Frame) -> Result<Point, ValueError> {
    let parts: Vec<&str> = words(text).collect();
    let [x, y] = parts[..] else {
        return Err(ValueError::NotAPoint);
    };
    let at = |t: &str, axis, origin: f64| length(t, axis, frame).map(|v| if t.ends_with('%') { origin + v } else { v });
    Ok(Point::new(at(x, Axis::X, frame.rect.x0)?, at(y, Axis::Y, frame.rect.y0)?))
}

/// A box `x,y,w,h`. Percentages count from the left and top of the frame, and of its width and height.
pub(super) fn rect(text: &str, frame: &Frame) -> Result<Rect, ValueError> {
    let parts: Vec<&str> = words(text).collect();
    let [x, y, w, h] = parts[..] else {
        return Err(ValueError::NotABox);
    };
    let origin = point(&format!("{x},{y}"), frame)?;
    let (w, h) = (length(w, Axis::X, frame)?, length(h, Axis::Y, frame)?);
    if w > 0.0 && h > 0.0 { Ok(Rect::from_origin_size(origin, Size::new(w, h))) } else { Err(ValueError::NoArea) }
}

/// Returns `true` if a path reference consists of points `x,y x,y …` and is not a name: every word is a pair of coordinates.
pub(super) fn looks_like_points(text: &str) -> bool {
    let unit = Frame::new(Rect::new(0.0, 0.0, 1.0, 1.0));
    text.contains(',') && points(text, &unit).is_ok()
}

/// Points `x,y x,y …`, separated by white space or semicolons.
pub(super) fn points(text: &str, frame: &Frame) -> Result<Vec<Point>, ValueError> {
    text.split(|c: char| c == ';' || c.is_whitespace())
        .filter(|w| !w.is_empty())
        .map(|w| point(w, frame).map_err(|e| within(w, e)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units() {
        let f = Frame::new(Rect::new(10.0, 20.0, 110.0, 70.0));
        assert_eq!(length("25.4mm", Axis::X, &f), Ok(96.0));
        assert_eq!(length("50%", Axis::Y, &f), Ok(25.0));
        assert_eq!(length("1e1", Axis::Y, &f), Ok(10.0));
        assert_eq!(angle("0.25turn"), Ok(90.0));
        assert_eq!(number("-20%"), Ok(-0.2));
        assert_eq!(point("50%,100%", &f), Ok(Point::new(60.0, 70.0)));
        assert_eq!(points("1,2 3,4;5,6", &f).unwrap().len(), 3);
        assert_eq!(rect("50%,20,10%,10%", &f), Ok(Rect::new(60.0, 20.0, 70.0, 25.0)));
        assert!(rect("0,0,0,5", &f).is_err() && rect("1,2,3", &f).is_err());
        assert!(length("3 parsecs", Axis::X, &f).unwrap_err().to_string().contains("parsecs"));
        assert!(number("nan").is_err() && number("inf").is_err() && number("").is_err());
        assert!(count("1.5").is_err());
    }

    #[test]
    fn points_differ_from_names() {
        assert!(looks_like_points("0,0 10%,5mm"));
        assert!(!looks_like_points("cage.svg") && !looks_like_points("4,5.svg") && !looks_like_points("M0,0 L1,1"));
    }
}
