//! Numbers that are out of range: no program below this one computes with them, and some never return from the attempt.
//!
//! They are replaced by a large number before usvg sees them. The elements that hold them are named in the report and stay
//! as they are.

use super::tags::ElementId;
use super::text::SourceText;
use memchr::{memchr, memchr2};
use pathwarp::Error;
use std::borrow::Cow;
use std::ops::Range;
use usvg::roxmltree;

/// Numbers from here on are out of range. Coordinates of real drawings stay below a million; from 1e12 on, coordinates of
/// single precision are farther apart than a page.
pub(crate) const LARGEST: f64 = 1e9;

/// Stands for a number out of range: as short as the shortest of them, and in range.
const INSTEAD: &str = "9e8";

/// Fewest digits before the point of a number out of range without exponent.
const DIGITS: usize = 10;

/// Attributes that hold lengths, coordinates, transforms or declarations of them.
fn is_checked(name: &str) -> bool {
    matches!(
        name,
        "d" | "points"
            | "x"
            | "y"
            | "x1"
            | "y1"
            | "x2"
            | "y2"
            | "dx"
            | "dy"
            | "z"
            | "cx"
            | "cy"
            | "r"
            | "rx"
            | "ry"
            | "fx"
            | "fy"
            | "fr"
            | "width"
            | "height"
            | "viewBox"
            | "transform"
            | "gradientTransform"
            | "patternTransform"
            | "style"
            | "stroke-width"
            | "stroke-dasharray"
            | "stroke-dashoffset"
            | "stroke-miterlimit"
            | "font-size"
            | "letter-spacing"
            | "word-spacing"
            | "textLength"
            | "startOffset"
            | "baseline-shift"
            | "rotate"
            | "markerWidth"
            | "markerHeight"
            | "refX"
            | "refY"
            | "stdDeviation"
            | "radius"
            | "baseFrequency"
            | "scale"
            | "surfaceScale"
            | "kernelUnitLength"
            | "pointsAtX"
            | "pointsAtY"
            | "pointsAtZ"
            | "limitingConeAngle"
            | "kernelMatrix"
            | "divisor"
            | "bias"
            | "k1"
            | "k2"
            | "k3"
            | "k4"
    )
}

/// Returns the text of a document with numbers in range, or `None` if all are.
///
/// # Errors
/// Returns [`Error::Input`] if such a number comes from an entity, where it cannot be replaced.
pub(crate) fn replaced(xml: &roxmltree::Document<'_>, name: &str) -> Result<Option<String>, Error> {
    let text = xml.input_text();
    let mut found: Vec<Range<usize>> = Vec::new();
    for node in xml.descendants() {
        if node.is_text() && node.parent().is_some_and(|p| p.tag_name().name() == "style") {
            let at = node.range();
            let inside = text.get(at.clone()).map_or(Vec::new(), |t| far(t, true));
            found.extend(inside.into_iter().map(|r| at.start + r.start..at.start + r.end));
        }
        for a in node.attributes().filter(|a| is_checked(a.name()) && may_be_far(a.value())) {
            let css = a.name() == "style";
            let at = a.range_value();
            let inside = text.get(at.clone()).map_or(Vec::new(), |t| far(t, css));
            if inside.len() != far(a.value(), css).len() {
                let line = xml.text_pos_at(a.range().start).row;
                let problem = format!("`{}` has a number beyond {LARGEST:e}; correct it", a.name());
                return Err(Error::input(format!("{name}:{line}"), problem));
            }
            found.extend(inside.into_iter().map(|r| at.start + r.start..at.start + r.end));
        }
    }
    if found.is_empty() {
        return Ok(None);
    }
    Ok(Some(with_instead(text, found)))
}

/// Returns `false` if all numbers of path data are certainly below 10⁴ and, unless they are zero, at least 10⁻³: no exponent, no five
/// digits before a point, no three zeros after it.
pub(super) fn is_uneven(data: &str) -> bool {
    let (mut digits, mut zeros, mut fraction) = (0, 0, false);
    for byte in data.bytes() {
        match byte {
            b'e' | b'E' => return true,
            b'.' => (zeros, fraction) = (0, true),
            b'0' if fraction => zeros += 1,
            // The digits after the first one that is not zero do not count.
            b'0'..=b'9' if fraction => zeros = i32::MIN,
            b'0'..=b'9' => digits += 1,
            _ => (digits, fraction) = (0, false),
        }
        if digits > 4 || fraction && zeros > 2 {
            return true;
        }
    }
    false
}

/// A number, list or path data with all numbers in range, as usvg is going to see it.
pub(super) fn in_range(value: &str) -> Cow<'_, str> {
    let found = if may_be_far(value) { far(value, false) } else { Vec::new() };
    if found.is_empty() { Cow::Borrowed(value) } else { Cow::Owned(with_instead(value, found)) }
}

/// Replaces numbers. The replacement has the same length, so that positions stay.
fn with_instead(text: &str, found: Vec<Range<usize>>) -> String {
    let mut out = text.to_owned();
    for r in found {
        // A width in a format string ends at 65,535.
        let zeros = r.end - INSTEAD.len();
        out.replace_range(r.start..zeros, &"0".repeat(zeros - r.start));
        out.replace_range(zeros..r.end, INSTEAD);
    }
    out
}

/// The elements with numbers out of range, each with the first of them. A style sheet may concern any element, so its numbers are
/// the root's.
pub(crate) fn elements(source: &SourceText) -> Vec<(ElementId, String)> {
    if let Some(r) = far(&source.css, true).into_iter().next() {
        return vec![(0, source.css[r].to_owned())];
    }
    let first = |e: ElementId| {
        source.elements[e].attrs.iter().find_map(|a| {
            let (name, value) = (a.name(&source.text), a.value(&source.text));
            let r = far(&value, name == "style").into_iter().next().filter(|_| is_checked(name))?;
            Some((e, value.get(r)?.to_owned()))
        })
    };
    (0..source.elements.len()).filter_map(first).collect()
}

/// Returns `false` if a text certainly holds no number out of range.
fn may_be_far(text: &str) -> bool {
    let bytes = text.as_bytes();
    let digits = || {
        // A run of ten digits has one at a multiple of ten.
        let places = (0..bytes.len()).step_by(DIGITS).filter(|&i| bytes[i].is_ascii_digit());
        let mut runs = places.map(|i| {
            let before = bytes[..i].iter().rev().take_while(|b| b.is_ascii_digit()).count();
            before + bytes[i..].iter().take_while(|b| b.is_ascii_digit()).count()
        });
        runs.any(|run| run >= DIGITS)
    };
    memchr2(b'e', b'E', bytes).is_some() || digits()
}

/// The numbers out of range in a text, without their signs. In CSS, digits in names, colours and links are no numbers.
fn far(text: &str, css: bool) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
    let digits = |mut i: usize| {
        while digit(i) {
            i += 1;
        }
        i
    };
    let mut out = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        let start = i;
        if css && bytes[i..].starts_with(b"url(") {
            // Names and embedded data.
            i += memchr(b')', &bytes[i..]).unwrap_or(bytes.len() - i);
            continue;
        }
        if !digit(i) {
            i += 1;
            continue;
        }
        i = digits(i);
        if bytes.get(i) == Some(&b'.') {
            i = digits(i + 1);
        }
        if matches!(bytes.get(i), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(i + 1), Some(b'+' | b'-')));
            if digit(i + 1 + sign) {
                i = digits(i + 1 + sign);
            }
        }
        let before = start.checked_sub(1).and_then(|p| bytes.get(p)).copied().unwrap_or(b' ');
        let in_name = css && (before.is_ascii_alphanumeric() || matches!(before, b'#' | b'_' | b'/'));
        let value: f64 = text.get(start..i).and_then(|t| t.parse().ok()).unwrap_or(0.0);
        if value >= LARGEST && !in_name {
            out.push(start..i);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_out_of_range_are_found_and_others_are_not() {
        let found = |t: &str, css| -> Vec<String> { far(t, css).into_iter().map(|r| t[r].to_owned()).collect() };
        assert_eq!(found("M0 0L1e308-3.4e38H1e+9 999999999 1e8z", false), ["1e308", "3.4e38", "1e+9"]);
        assert_eq!(found("M.5.1234567890123 1e-20 12345678901.5", false), ["12345678901.5"]);
        assert_eq!(found("fill:#1e9999;stroke-width:1e20px;marker:url(#a12345678901)", true), ["1e20"]);
        for t in ["M0 0L1e308 1", "0.5 12345678901", "1234567890"] {
            assert!(may_be_far(t), "{t}");
        }
        assert!(!may_be_far("M10 20.123456L-5 1234567 z"));
    }

    #[test]
    fn they_are_replaced_in_place() {
        let svg = "<svg><path d='M0 0L1e308,1' stroke-width='1e20px' data-n='1e99'/><style>a{r:1e12}</style></svg>";
        let xml = roxmltree::Document::parse(svg).unwrap();
        let text = replaced(&xml, "t").unwrap().unwrap();
        assert_eq!(
            text,
            "<svg><path d='M0 0L009e8,1' stroke-width='09e8px' data-n='1e99'/><style>a{r:09e8}</style></svg>"
        );
        assert_eq!(replaced(&roxmltree::Document::parse(&text).unwrap(), "t").unwrap(), None);
    }
}
