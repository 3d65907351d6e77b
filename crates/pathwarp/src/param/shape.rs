//! Shapes by name as path references: `heart`, `heart,ratio=1.2`, `heart,width=80mm`.
//!
//! A shape is centred in the frame, usually the artwork's box. It is as wide as the frame, unless `width` gives a length (percentages refer
//! to the frame's width), and keeps the proportions of its drawing, unless `ratio` gives its width divided by its height.

use super::value;
use super::{Axis, Frame};
use crate::outline::Outline;
use kurbo::Affine;
use std::sync::OnceLock;

/// The drawing of all shapes, one per line.
const DRAWING: &str = include_str!("shapes.svg");
/// The names of a shape's values.
const VALUES: [&str; 2] = ["ratio", "width"];
/// Largest ratio of a shape's width to its height, and of its height to its width.
const MAX_RATIO: f64 = 1000.0;

/// Returns the names and the path data of all shapes.
fn drawings() -> impl Iterator<Item = (&'static str, &'static str)> {
    let attribute = |line: &'static str, name: &str| Some(line.split_once(name)?.1.split_once('"')?.0);
    DRAWING.lines().filter_map(move |l| Some((attribute(l, "<path id=\"")?, attribute(l, " d=\"")?)))
}

/// Returns the names of the shapes for path references, in the order of the drawing.
#[must_use]
pub fn shape_names() -> &'static [&'static str] {
    static NAMES: OnceLock<Vec<&'static str>> = OnceLock::new();
    NAMES.get_or_init(|| drawings().map(|(name, _)| name).collect())
}

/// Returns `true` if a path reference begins with the name of a shape. A file or an object may have that name, too.
#[must_use]
pub fn is_shape(text: &str) -> bool {
    shape_names().contains(&split(text).0)
}

/// Returns the name, and the values after it.
fn split(text: &str) -> (&str, &str) {
    let (name, values) = text.split_once(',').unwrap_or((text, ""));
    (name.trim(), values)
}

/// Reads a shape; `None` for other texts. The error continues a sentence about the text.
pub(super) fn shape(text: &str, frame: &Frame) -> Option<Result<Outline, String>> {
    let (name, values) = split(text);
    let (_, data) = drawings().find(|(n, _)| *n == name)?;
    Some(place(name, data, values, frame))
}

/// Places the drawing of a shape in the frame, according to its values.
fn place(name: &str, data: &str, values: &str, frame: &Frame) -> Result<Outline, String> {
    let mut given = [None; VALUES.len()];
    for part in values.split(',').map(str::trim).filter(|p| !p.is_empty()) {
        let (key, value) = part.split_once('=').map(|(k, v)| (k.trim(), v.trim())).unwrap_or((part, ""));
        let i = VALUES.iter().position(|v| *v == key);
        let i = i.ok_or_else(|| format!("has a value `{part}`; write {name},ratio=1.2 or {name},width=80mm"))?;
        let read = if key == "width" { value::length(value, Axis::X, frame) } else { value::number(value) };
        let read = read.map_err(|e| format!("has a wrong {key}: `{value}` {e}"))?;
        let range = if key == "width" { f64::MIN_POSITIVE..=f64::MAX } else { 1.0 / MAX_RATIO..=MAX_RATIO };
        if !range.contains(&read) {
            return Err(format!("has the {key} {value}; it must be larger than 0, and a ratio at most {MAX_RATIO}"));
        }
        given[i] = Some(read);
    }
    let [ratio, width] = given;
    let width = width.unwrap_or(frame.rect.width());
    if width.is_nan() || width <= 0.0 {
        return Err(format!("would be as wide as the artwork, which has no width: write {name},width=80mm"));
    }
    let outline = Outline::from_svg(data).map_err(|e| e.to_string())?;
    let bounds = outline.bounding_box().ok_or("is empty")?;
    let ratio = ratio.unwrap_or(bounds.width() / bounds.height());
    let onto = Affine::translate(frame.rect.center().to_vec2())
        * Affine::scale_non_uniform(width / bounds.width(), width / ratio / bounds.height())
        * Affine::translate(-bounds.center().to_vec2());
    Ok(outline.transformed(onto))
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Rect;

    #[test]
    fn shapes_are_as_wide_as_the_frame_and_have_their_ratio() {
        let frame = Frame::new(Rect::new(10.0, 20.0, 210.0, 60.0)).with_units_per_px([2.0, 2.0]);
        let bounds = |text: &str| shape(text, &frame).unwrap().unwrap().bounding_box().unwrap();
        assert_eq!(shape_names().len(), 24);
        for name in shape_names() {
            let b = bounds(name);
            assert!((b.width() - 200.0).abs() < 1e-6 && b.center().distance((110.0, 40.0).into()) < 1e-6, "{name} {b}");
        }
        // The circle, drawn as two arcs, is round; a ratio makes it an ellipse.
        assert!((bounds("circle").height() - 200.0).abs() < 1e-6);
        let wide = bounds("heart, ratio=1.25 ,width=50px");
        assert!((wide.width() - 100.0).abs() < 1e-6 && (wide.height() - 80.0).abs() < 1e-6);
    }

    #[test]
    fn mistakes_in_values_are_told() {
        let frame = Frame::new(Rect::new(0.0, 0.0, 200.0, 50.0));
        for (text, said) in [
            ("heart,1.2", "`1.2`"),
            ("heart,ratio=wide", "wrong ratio"),
            ("heart,ratio=0", "larger than 0"),
            ("heart,width=-3mm", "larger than 0"),
            ("heart,ratio=inf", "ratio"),
        ] {
            let error = shape(text, &frame).unwrap().unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
        assert!(shape("hart", &frame).is_none() && shape("circle:r=3", &frame).is_none());
        assert!(shape("heart", &Frame::new(Rect::ZERO)).unwrap().unwrap_err().contains("width=80mm"));
    }
}
