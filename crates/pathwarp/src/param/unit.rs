//! Text to numbers with units.

use super::{Axis, Frame};
use kurbo::{Point, Rect, Size};

/// CSS: 96 px to the inch; one user unit is one px.
const PX_PER_INCH: f64 = 96.0;

/// Splits `12.5mm` into 12.5 and `mm`.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    // The longest prefix that is a number: an exponent's `e` is part of it, a unit's is not.
    (1..=text.len())
        .rev()
        .filter(|&n| text.is_char_boundary(n))
        .find_map(|n| text[..n].parse::<f64>().ok().filter(|v| v.is_finite()).map(|v| (v, text[n..].trim_start())))
}

/// A plain number or a percentage.
pub(super) fn number(text: &str) -> Result<f64, String> {
    match split(text) {
        Some((v, "")) => Ok(v),
        Some((v, "%")) => Ok(v / 100.0),
        Some((_, unit)) => Err(format!("has the unit `{unit}`, but a plain number (or %) is wanted here")),
        None => Err("is not a number".into()),
    }
}

/// A whole number.
pub(super) fn count(text: &str) -> Result<f64, String> {
    match split(text) {
        Some((v, "")) if v.fract() == 0.0 => Ok(v),
        _ => Err("is not a whole number".into()),
    }
}

/// A length in user units.
pub(super) fn length(text: &str, axis: Axis, frame: &Frame) -> Result<f64, String> {
    let Some((v, unit)) = split(text) else {
        return Err("is not a length, such as 12, 3mm or 50%".into());
    };
    let per = match unit {
        "" | "px" => 1.0,
        "%" => frame.extent(axis) / 100.0,
        "in" => PX_PER_INCH,
        "mm" => PX_PER_INCH / 25.4,
        "cm" => PX_PER_INCH / 2.54,
        "m" => PX_PER_INCH / 0.0254,
        "q" | "Q" => PX_PER_INCH / 101.6,
        "pt" => PX_PER_INCH / 72.0,
        "pc" => PX_PER_INCH / 6.0,
        _ => return Err(format!("has the unknown unit `{unit}`; known are px, mm, cm, m, in, pt, pc, q and %")),
    };
    Ok(v * per)
}

/// An angle in degrees.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    let Some((v, unit)) = split(text) else {
        return Err("is not an angle, such as 30 or 0.5turn".into());
    };
    match unit {
        "" | "deg" | "°" => Ok(v),
        "rad" => Ok(v.to_degrees()),
        "grad" => Ok(v * 0.9),
        "turn" => Ok(v * 360.0),
        _ => Err(format!("has the unknown unit `{unit}`; known are deg, rad, grad and turn")),
    }
}

/// Numbers separated by commas, white space or both.
pub(super) fn numbers(text: &str, wanted: usize) -> Result<Vec<f64>, String> {
    let out: Result<Vec<f64>, String> = words(text)
        .map(|w| match split(w) {
            Some((v, "")) => Ok(v),
            _ => Err(format!("holds `{w}`, which is not a number")),
        })
        .collect();
    let out = out?;
    if out.len() == wanted { Ok(out) } else { Err(format!("holds {} numbers; {wanted} are wanted", out.len())) }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty())
}

/// A place: percentages count from the frame's left and top.
pub(super) fn point(text: &str, frame: &Frame) -> Result<Point, String> {
    let parts: Vec<&str> = words(text).collect();
    let [x, y] = parts[..] else {
        return Err("is not a place x,y".into());
    };
    let at = |t: &str, axis, origin: f64| length(t, axis, frame).map(|v| if t.ends_with('%') { origin + v } else { v });
    Ok(Point::new(at(x, Axis::X, frame.rect.x0)?, at(y, Axis::Y, frame.rect.y0)?))
}

/// A box `x,y,w,h`: percentages count from the frame's left and top, and of its width and height.
pub(super) fn rect(text: &str, frame: &Frame) -> Result<Rect, String> {
    let parts: Vec<&str> = words(text).collect();
    let [x, y, w, h] = parts[..] else {
        return Err("is neither a box x,y,w,h nor the word artwork".into());
    };
    let origin = point(&format!("{x},{y}"), frame)?;
    let (w, h) = (length(w, Axis::X, frame)?, length(h, Axis::Y, frame)?);
    if w > 0.0 && h > 0.0 { Ok(Rect::from_origin_size(origin, Size::new(w, h))) } else { Err("has no area".into()) }
}

/// Whether a path reference is plain points `x,y x,y …` rather than a name: it starts like a number, and every word is a
/// pair of coordinates.
pub(super) fn looks_like_points(text: &str) -> bool {
    let unit = Frame::new(Rect::new(0.0, 0.0, 1.0, 1.0));
    text.contains(',') && points(text, &unit).is_ok()
}

/// Plain points: `x,y x,y …`, or semicolons between the pairs.
pub(super) fn points(text: &str, frame: &Frame) -> Result<Vec<Point>, String> {
    text.split(|c: char| c == ';' || c.is_whitespace())
        .filter(|w| !w.is_empty())
        .map(|w| point(w, frame).map_err(|e| format!("holds `{w}`, which {e}")))
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
        assert!(length("3 parsecs", Axis::X, &f).unwrap_err().contains("parsecs"));
        assert!(number("nan").is_err() && number("inf").is_err() && number("").is_err());
        assert!(count("1.5").is_err());
    }

    #[test]
    fn points_are_told_from_names() {
        assert!(looks_like_points("0,0 10%,5mm"));
        assert!(!looks_like_points("cage.svg") && !looks_like_points("4,5.svg") && !looks_like_points("M0,0 L1,1"));
    }
}
