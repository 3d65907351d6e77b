//! Colours that usvg does not read (CSS Color 4), as the nearest in sRGB.

use crate::value::{reference, safe_id};
use std::borrow::Cow;
use std::str::FromStr as _;

/// Display P3 in linear light to XYZ (CSS Color 4, section 10.3).
const P3_TO_XYZ: [[f64; 3]; 3] = [
    [608_311.0 / 1_250_200.0, 189_793.0 / 714_400.0, 198_249.0 / 1_000_160.0],
    [35_783.0 / 156_275.0, 247_089.0 / 357_200.0, 198_249.0 / 2_500_400.0],
    [0.0, 32_229.0 / 714_400.0, 5_220_557.0 / 5_000_800.0],
];

/// Rewrites a paint for usvg. Returns `None` if it is invalid or of an unsupported kind.
pub(super) fn paint(value: &str) -> Option<Cow<'_, str>> {
    if is_hex(value) || value == "none" {
        return Some(Cow::Borrowed(value));
    }
    if let Some(link) = reference(value) {
        let fallback = link.rest.trim();
        let new =
            if fallback.is_empty() { "".into() } else { paint(fallback).filter(|_| reference(fallback).is_none())? };
        let old = &value[..value.len() - link.rest.len()];
        let id = link.id.as_deref().map_or(Cow::Borrowed(old), |id| format!("url(#{})", safe_id(id)).into());
        let text = format!("{} {new}", id.trim());
        return Some(if text.trim() == value { Cow::Borrowed(value) } else { Cow::Owned(text.trim().to_owned()) });
    }
    for keyword in ["none", "context-fill", "context-stroke"] {
        if value.eq_ignore_ascii_case(keyword) {
            return Some(Cow::Borrowed(keyword));
        }
    }
    color(value)
}

fn is_hex(value: &str) -> bool {
    let digits = value.strip_prefix('#').unwrap_or_default();
    matches!(digits.len(), 3 | 4 | 6 | 8) && digits.bytes().all(|b| b.is_ascii_hexdigit())
}

/// Rewrites a colour for usvg. Returns `None` if it is invalid or of an unsupported kind.
pub(super) fn color(value: &str) -> Option<Cow<'_, str>> {
    if is_hex(value) {
        return Some(Cow::Borrowed(value));
    }
    if value.eq_ignore_ascii_case("currentcolor") {
        return Some(Cow::Borrowed("currentColor"));
    }
    if !value.starts_with('#') && svgtypes::Color::from_str(value).is_ok() {
        return Some(Cow::Borrowed(value));
    }
    if value.starts_with('#') || !value.contains('(') {
        return None;
    }
    let lower = value.to_ascii_lowercase();
    let [r, g, b, a] = csscolorparser::parse(&in_xyz(&lower).unwrap_or(lower)).ok()?.to_rgba8();
    Some(format!("rgba({r},{g},{b},{})", f64::from(a) / 255.0).into())
}

/// Rewrites the colours and lengths in a list of functions for usvg, whose style sheets know no functions in functions.
pub(super) fn in_functions<'v>(list: &'v str, length: impl Fn(&'v str) -> Option<Cow<'v, str>>) -> Cow<'v, str> {
    let rewritten = |word: &'v str| {
        if word.contains('(') {
            let c = svgtypes::Color::from_str(&color(word)?).ok()?;
            return Some(format!("#{:02x}{:02x}{:02x}{:02x}", c.red, c.green, c.blue, c.alpha).into());
        }
        let has_unit = !word.starts_with('#') && word.ends_with(|c: char| c.is_ascii_alphabetic());
        length(word).filter(|_| has_unit)
    };
    let (mut out, mut depth, mut start) = (String::new(), 0, 0);
    for (at, c) in list.char_indices() {
        let ends = depth == 0 || depth == 1 && (c == ')' || c.is_ascii_whitespace());
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if ends {
            let word = &list[start..at];
            out.push_str(&rewritten(word).unwrap_or(word.into()));
            out.push(c);
            start = at + c.len_utf8();
        }
    }
    out.push_str(&list[start..]);
    if out == list { list.into() } else { out.into() }
}

/// Converts a colour of Display P3 to XYZ.
fn in_xyz(color: &str) -> Option<String> {
    let arguments = color.strip_prefix("color(display-p3")?.strip_suffix(')')?;
    let (channels, alpha) = arguments.split_once('/').unwrap_or((arguments, "1"));
    let channel = |text: &str| {
        let value: f64 = match text.strip_suffix('%') {
            Some(share) => share.parse::<f64>().ok()? / 100.0,
            None => text.parse().ok()?,
        };
        // The transfer function is that of sRGB.
        let v = value.abs();
        Some(value.signum() * if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) })
    };
    let linear: Vec<f64> = channels.split_ascii_whitespace().map(channel).collect::<Option<_>>()?;
    let [x, y, z] = P3_TO_XYZ.map(|row| row.iter().zip(&linear).map(|(m, v)| m * v).sum::<f64>());
    (linear.len() == 3).then(|| format!("color(xyz {x:.9} {y:.9} {z:.9} / {})", alpha.trim()))
}

#[cfg(test)]
mod tests {
    use super::{in_functions, paint};

    #[test]
    fn what_usvg_reads_stays() {
        for css in ["#123", "url(#a) red", "context-fill", "currentColor", "hsl(120 50% 40% / 60%)"] {
            assert_eq!(paint(css).as_deref(), Some(css));
        }
    }

    #[test]
    fn functions_in_functions() {
        for (css, plain) in [
            ("drop-shadow(8px 1rem 6px rgba(0, 0, 0, .6))", "drop-shadow(8px 16px 6px #00000099)"),
            ("blur(2px) drop-shadow(rgb(255 0 0 / 50%) 1px 2px)", "blur(2px) drop-shadow(#ff000080 1px 2px)"),
            ("url(#rem) hue-rotate(90deg) grayscale(50%)", "url(#rem) hue-rotate(90deg) grayscale(50%)"),
            ("drop-shadow(1px 2px", "drop-shadow(1px 2px"),
            ("drop-shadow((()))) é", "drop-shadow((()))) é"),
        ] {
            assert_eq!(in_functions(css, |v| Some(if v == "1rem" { "16px" } else { v }.into())), plain);
        }
    }

    /// As Chromium 156 paints them, within a level.
    #[test]
    fn other_spaces() {
        for (css, wanted) in [
            ("oklch(0.7 0.1 150)", [111, 176, 125]),
            ("lab(50% 40 30)", [187, 88, 70]),
            ("color(srgb 1 .5 0)", [255, 128, 0]),
            ("color(display-p3 0.5 0.5 0.5)", [127, 128, 128]),
            ("color(display-p3 0.4 60% 0.4 / 1)", [85, 155, 97]),
        ] {
            let found = paint(css).unwrap();
            let channels = found.strip_prefix("rgba(").unwrap().split(',').take(3);
            let channels: Vec<i32> = channels.map(|c| c.parse().unwrap()).collect();
            assert!(channels.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= 1), "{css}: {found}");
        }
        for none in ["color(display-p3 1 0)", "color-mix(in srgb, red, blue)", "oklch(x)", ""] {
            assert_eq!(paint(none), None, "{none}");
        }
    }
}
