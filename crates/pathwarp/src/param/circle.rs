//! Circles and arcs as path references: `circle:r=60mm`, `arc:r=60mm,from=180,to=360`.
//!
//! The centre is that of the frame, unless `cx` and `cy` give it, as lengths; percentages of them count from the left and top of
//! the frame, those of `r` refer to its width. Angles count clockwise on the screen from the right (three o'clock); an arc runs
//! from `from` to `to`, clockwise if `to` is larger. The outlines are true arcs.

use super::number::ValueError;
use super::{Axis, Frame, value};
use crate::outline::{EllipticArc, Outline, Seg, Subpath};
use kurbo::{Point, Vec2};
use std::f64::consts::PI;

/// Returns `true` if a path reference is a circle or an arc.
pub(super) fn is_circle(text: &str) -> bool {
    split(text).is_some()
}

/// The word before the colon, and the values after it.
fn split(text: &str) -> Option<(&str, &str)> {
    text.trim().split_once(':').filter(|(word, _)| matches!(*word, "circle" | "arc"))
}

/// Reads a circle or an arc; `None` if the text is neither. The error continues a sentence about the text.
pub(super) fn circle(text: &str, frame: &Frame) -> Option<Result<Outline, String>> {
    let (word, values) = split(text)?;
    Some(read(word, values, frame))
}

fn read(word: &str, values: &str, frame: &Frame) -> Result<Outline, String> {
    let names: &[&str] = if word == "arc" { &["r", "from", "to", "cx", "cy"] } else { &["r", "cx", "cy"] };
    let mut given: Vec<(&str, &str)> = Vec::new();
    for part in values.split(',').map(str::trim).filter(|p| !p.is_empty()) {
        let Some((name, value)) = part.split_once('=').map(|(n, v)| (n.trim(), v.trim())) else {
            return Err(format!("contains `{part}`, which is not NAME=VALUE"));
        };
        if !names.contains(&name) {
            return Err(format!("has a value for `{name}`; {word} takes {}", names.join(", ")));
        }
        if given.iter().any(|(n, _)| *n == name) {
            return Err(format!("has two values for {name}"));
        }
        given.push((name, value));
    }
    let typed = |name: &str| given.iter().find(|(n, _)| *n == name).map(|(_, v)| *v);
    let wrong = |name: &str, e: ValueError| format!("has a wrong {name}: `{}` {e}", typed(name).unwrap_or_default());
    let needed = |name: &str| typed(name).ok_or_else(|| format!("has no {name}: write {word}:{}", example(word)));
    let length = |name: &str, axis| value::length(needed(name)?, axis, frame).map_err(|e| wrong(name, e));
    let angle = |name: &str| value::angle(needed(name)?).map_err(|e| wrong(name, e));

    let radius = length("r", Axis::X)?;
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(format!("has the radius {radius}; it must be larger than 0"));
    }
    // A percentage is a place in the frame, a length one on the page.
    let place = |name: &str, axis, start: f64, middle: f64| match typed(name) {
        None => Ok(middle),
        Some(v) => length(name, axis).map(|d| if v.ends_with('%') { start + d } else { d }),
    };
    let (rect, middle) = (frame.rect, frame.rect.center());
    let centre = Point::new(place("cx", Axis::X, rect.x0, middle.x)?, place("cy", Axis::Y, rect.y0, middle.y)?);
    let (from, to) = if word == "arc" { (angle("from")?, angle("to")?) } else { (0.0, 360.0) };
    let sweep = to - from;
    if !(sweep.abs() > 0.0 && sweep.abs() <= 360.0) {
        return Err(format!("runs through {sweep}°; from and to must differ by at most 360°"));
    }
    let seg = |first: f64, sweep: f64| {
        let (u, v) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
        Seg::Arc(EllipticArc::new(centre, u, v, first * PI / 180.0, sweep * PI / 180.0))
    };
    let start = centre + Vec2::from_angle(from.to_radians()) * radius;
    let subpath = Subpath { start, segs: vec![seg(from, sweep)], closed: word == "circle" };
    Ok(Outline { subpaths: vec![subpath] })
}

fn example(word: &str) -> &'static str {
    if word == "arc" { "r=60mm,from=180,to=360" } else { "r=60mm" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Rect;

    fn read(text: &str) -> Result<Outline, String> {
        let frame = Frame::new(Rect::new(100.0, 0.0, 300.0, 50.0)).with_units_per_px([2.0; 2]);
        circle(text, &frame).unwrap()
    }

    #[test]
    fn circles_and_arcs_have_their_measures() {
        let inch = read("circle:r=1in").unwrap();
        let b = inch.bounding_box().unwrap();
        // An inch is 96 px, and a px two units.
        assert!((b.width() - 384.0).abs() < 1e-9 && b.center().distance(Point::new(200.0, 25.0)) < 1e-9, "{b:?}");
        assert!(inch.subpaths[0].closed && matches!(inch.subpaths[0].segs[..], [Seg::Arc(_)]));
        let arc = read("arc: r=10%, from=180, to=1.5PI, cx=25%, cy=7");
        assert!(arc.is_err());
        let arc = read("arc:r=10%,from=180,to=0.75turn,cx=25%,cy=7").unwrap();
        let (a, b) = (arc.subpaths[0].start, arc.subpaths[0].end());
        assert!(
            a.distance(Point::new(130.0, 7.0)) < 1e-9 && b.distance(Point::new(150.0, -13.0)) < 1e-9,
            "{a:?} {b:?}"
        );
        assert!(circle("circles.svg#a", &Frame::new(Rect::ZERO)).is_none() && !is_circle("M0,0"));
    }

    #[test]
    fn errors_name_the_value() {
        for (text, part) in [
            ("circle:", "no r"),
            ("circle:r=-3", "larger than 0"),
            ("circle:r=3,from=4", "circle takes r, cx, cy"),
            ("circle:60mm", "`60mm`"),
            ("circle:r=wide", "wrong r: `wide`"),
            ("arc:r=3,from=0", "no to"),
            ("arc:r=3,from=0,to=400", "at most 360"),
            ("arc:r=3,r=4", "two values for r"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
