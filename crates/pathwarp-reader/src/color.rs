//! Colours that usvg does not read (CSS Color 4 and 5), as the nearest in sRGB.

use crate::value::{arguments, reference, safe_id, split_outside};
use csscolorparser::Color;
use std::borrow::Cow;
use std::f32::consts::TAU;
use std::str::FromStr as _;

/// Display P3 in linear light to XYZ (CSS Color 4, section 10.3).
const P3_TO_XYZ: [[f64; 3]; 3] = [
    [608_311.0 / 1_250_200.0, 189_793.0 / 714_400.0, 198_249.0 / 1_000_160.0],
    [35_783.0 / 156_275.0, 247_089.0 / 357_200.0, 198_249.0 / 2_500_400.0],
    [0.0, 32_229.0 / 714_400.0, 5_220_557.0 / 5_000_800.0],
];

/// Rewrites a paint for usvg. `current` is the colour that `currentColor` stands for. Returns `None` if it is invalid or of an
/// unsupported kind.
pub(super) fn paint<'v>(value: &'v str, current: &Color) -> Option<Cow<'v, str>> {
    if is_hex(value) || value == "none" {
        return Some(Cow::Borrowed(value));
    }
    // `url(#…)`, or a link to another file without `id`, and its fallback.
    if let Some(link) = reference(value) {
        let fallback = link.rest.trim();
        let solid = || paint(fallback, current).filter(|_| reference(fallback).is_none());
        let fallback = if fallback.is_empty() { "".into() } else { solid()? };
        let old_link = &value[..value.len() - link.rest.len()];
        let link = link.id.as_deref().map_or(Cow::Borrowed(old_link), |id| format!("url(#{})", safe_id(id)).into());
        let text = format!("{} {fallback}", link.trim());
        return Some(if text.trim() == value { Cow::Borrowed(value) } else { Cow::Owned(text.trim().to_owned()) });
    }
    for keyword in ["none", "context-fill", "context-stroke"] {
        if value.eq_ignore_ascii_case(keyword) {
            return Some(Cow::Borrowed(keyword));
        }
    }
    color(value, current)
}

fn is_hex(value: &str) -> bool {
    let digits = value.strip_prefix('#').unwrap_or_default();
    matches!(digits.len(), 3 | 4 | 6 | 8) && digits.bytes().all(|b| b.is_ascii_hexdigit())
}

/// Rewrites a colour for usvg. `current` is the colour that `currentColor` stands for. Returns `None` if it is invalid or of an
/// unsupported kind.
pub(super) fn color<'v>(value: &'v str, current: &Color) -> Option<Cow<'v, str>> {
    if is_hex(value) {
        return Some(Cow::Borrowed(value));
    }
    if value.eq_ignore_ascii_case("currentcolor") {
        return Some(Cow::Borrowed("currentColor"));
    }
    // Other values with `#`, such as with spaces around, are rewritten.
    if !value.starts_with('#') && svgtypes::Color::from_str(value).is_ok() {
        return Some(Cow::Borrowed(value));
    }
    Some(text(&resolved(value, current, MAX_LEVELS)?).into())
}

/// The colour that a value stands for.
pub(super) fn computed(value: &str, current: &Color) -> Option<Color> {
    resolved(value, current, MAX_LEVELS)
}

/// Returns `true` if a value that is not understood may still be a colour: a function that later standards may define.
pub(super) fn may_be_color(value: &str) -> bool {
    let name = value.split('(').next().unwrap_or_default();
    value.ends_with(')') && !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphabetic() || b == b'-')
}

fn text(color: &Color) -> String {
    let [r, g, b, a] = color.to_rgba8();
    format!("rgba({r},{g},{b},{})", f64::from(a) / 255.0)
}

/// Depth to which colours may refer to others.
const MAX_LEVELS: usize = 8;

/// Colours of the user interface (CSS Color 4, section 6.2 and appendix A) with their values in Chromium on a light background, and names
/// that usvg does not know.
#[rustfmt::skip]
const NAMES: [(&str, &[&str]); 13] = [
    ("#000", &["canvastext", "buttonborder", "buttontext", "fieldtext", "marktext", "activeborder", "captiontext", "inactiveborder",
        "infotext", "menutext", "threeddarkshadow", "threedhighlight", "threedlightshadow", "threedshadow", "windowframe", "windowtext"]),
    ("#fff", &["canvas", "field", "highlighttext", "selecteditemtext", "accentcolortext", "activecaption", "appworkspace", "background",
        "inactivecaption", "infobackground", "menu", "scrollbar", "window"]),
    ("#efefef", &["buttonface", "buttonhighlight", "buttonshadow", "threedface"]),
    ("#808080", &["graytext", "inactivecaptiontext"]),
    ("#0075ff", &["accentcolor"]),
    ("#f00", &["activetext"]),
    ("#0041c6cc", &["highlight"]),
    ("#00e", &["linktext", "-webkit-link"]),
    ("#ff0", &["mark"]),
    ("#1967d2", &["selecteditem"]),
    ("#551a8b", &["visitedtext"]),
    ("#639", &["rebeccapurple"]),
    ("#0000", &["transparent"]),
];

/// Resolves a colour by name or function.
fn resolved(value: &str, current: &Color, levels: usize) -> Option<Color> {
    let lower = value.trim().to_ascii_lowercase();
    if lower == "currentcolor" {
        return Some(*current);
    }
    let Some((name, rest)) = lower.split_once('(') else {
        let known = NAMES.iter().find(|(_, names)| names.contains(&lower.as_str())).map(|n| n.0);
        let c = svgtypes::Color::from_str(known.unwrap_or(&lower)).ok()?;
        return Some(Color::from_rgba8(c.red, c.green, c.blue, c.alpha));
    };
    let list = rest.strip_suffix(')')?;
    let levels = levels.checked_sub(1)?;
    match name {
        "color-mix" => mix(list, |c| resolved(c, current, levels)),
        "light-dark" => resolved(arguments(list).next()?, current, levels),
        _ => {
            // The parser knows neither `currentColor` nor mixtures in relative colours.
            let words = list.strip_prefix("from ").map(|_| words(list));
            let base = words.as_ref().and_then(|w| Some((*w.get(1)?, resolved(w.get(1)?, current, levels)?)));
            let plain = base.map(|(word, c)| lower.replacen(word, &c.to_css_hex().to_string(), 1));
            // In relative colours the parser takes no percentages. In these functions, 30% means the same as 30.
            let plain = plain.map(|p| if matches!(name, "hsl" | "hsla" | "hwb") { without_percent(&p) } else { p });
            let plain = plain.unwrap_or(lower);
            csscolorparser::parse(&to_xyz(&plain).unwrap_or(plain)).ok()
        }
    }
}

/// A colour without the per cent signs of its channels. Alpha, behind a slash, keeps its sign.
fn without_percent(color: &str) -> String {
    let (channels, alpha) = color.split_at(color.find('/').unwrap_or(color.len()));
    channels.replace('%', "") + alpha
}

/// Splits at white space outside parentheses.
fn words(text: &str) -> Vec<&str> {
    split_outside(text, |c| c.is_ascii_whitespace()).filter(|w| !w.is_empty()).collect()
}

/// Mixes two colours (CSS Color 5, section 3): "in oklch longer hue, red 30%, blue".
fn mix(list: &str, resolved: impl Fn(&str) -> Option<Color>) -> Option<Color> {
    let mut parts: Vec<&str> = arguments(list).collect();
    let method = parts.first()?.strip_prefix("in ").map(words);
    if method.is_some() {
        parts.remove(0);
    }
    let method = method.unwrap_or_else(|| vec!["oklab"]);
    let [first, second] = parts[..] else { return None };
    let part = |text: &str| {
        let (shares, color): (Vec<&str>, Vec<&str>) = words(text).into_iter().partition(|w| w.ends_with('%'));
        let share: Option<f32> = shares.first().map(|s| s.trim_end_matches('%').parse()).transpose().ok()?;
        let is_valid = shares.len() < 2 && share.is_none_or(|s| (0.0..=100.0).contains(&s));
        Some((resolved(&color.join(" ")).filter(|_| is_valid)?, share.map(|s| s / 100.0)))
    };
    let ((a, p), (b, q)) = (part(first)?, part(second)?);
    let (p, q) = match (p, q) {
        (None, None) => (0.5, 0.5),
        (Some(p), None) => (p, 1.0 - p),
        (None, Some(q)) => (1.0 - q, q),
        (Some(p), Some(q)) => (p, q),
    };
    let (space, arc, sum) = (*method.first()?, method.get(1).copied(), p + q);
    let [x, y, z, alpha] = interpolated(space, arc, [&a, &b], [p / sum, q / sum])?;
    // Shares that sum to less than 100 % make the mixture transparent.
    let alpha = alpha * sum.min(1.0);
    let color = match space {
        "srgb-linear" => Color::from_linear_rgba(x, y, z, alpha),
        "oklab" => Color::from_oklaba(x, y, z, alpha),
        "oklch" => Color::from_oklcha(x, y, z, alpha),
        "lab" => Color::from_laba(x, y, z, alpha),
        "lch" => Color::from_lcha(x, y, z, alpha),
        "xyz-d50" => Color::from_xyz_d50(x, y, z, alpha),
        "xyz" | "xyz-d65" => Color::from_xyz_d65(x, y, z, alpha),
        "hsl" => Color::from_hsla(x, y, z, alpha),
        "hwb" => Color::from_hwba(x, y, z, alpha),
        _ => Color::new(x, y, z, alpha),
    };
    (sum > 0.0).then_some(color)
}

/// Interpolates coordinates in a colour space with premultiplied alpha, and hues along an arc (CSS Color 4, section 12). Returns `None` for
/// an unsupported space.
fn interpolated(space: &str, arc: Option<&str>, colors: [&Color; 2], [p, q]: [f32; 2]) -> Option<[f32; 4]> {
    // The coordinates, and the index of the hue with the value of a full turn.
    let coordinates = |c: &Color| match space {
        "srgb" => Some((c.to_array(), None)),
        "srgb-linear" => Some((c.to_linear_rgba(), None)),
        "oklab" => Some((c.to_oklaba(), None)),
        "lab" => Some((c.to_laba(), None)),
        "xyz-d50" => Some((c.to_xyz_d50(), None)),
        "xyz" | "xyz-d65" => Some((c.to_xyz_d65(), None)),
        "oklch" => Some((c.to_oklcha(), Some((2, TAU)))),
        "lch" => Some((c.to_lcha(), Some((2, TAU)))),
        "hsl" => Some((c.to_hsla(), Some((0, 360.0)))),
        "hwb" => Some((c.to_hwba(), Some((0, 360.0)))),
        _ => None,
    };
    let ((mut a, hue), (mut b, _)) = (coordinates(colors[0])?, coordinates(colors[1])?);
    let alpha = p * a[3] + q * b[3];
    let mut out = [0, 1, 2].map(|i| if alpha > 0.0 { (p * a[i] * a[3] + q * b[i] * b[3]) / alpha } else { 0.0 });
    if let Some((hue, turn)) = hue {
        // Greys have no hue.
        let is_grey = |c: &Color| {
            let [r, g, b, _] = c.to_array();
            r.max(g).max(b) - r.min(g).min(b) < 1e-4
        };
        match colors.map(is_grey) {
            [true, false] => a[hue] = b[hue],
            [false, true] => b[hue] = a[hue],
            _ => {}
        }
        let step = (b[hue] - a[hue]).rem_euclid(turn);
        let step = match arc {
            Some("increasing") => step,
            Some("longer") if step > 0.5 * turn => step,
            Some("decreasing" | "longer") => step - turn,
            _ if step > 0.5 * turn => step - turn,
            _ => step,
        };
        out[hue] = a[hue] + q * step;
    }
    Some([out[0], out[1], out[2], alpha])
}

/// Rewrites the colours and lengths in a list of filter functions for usvg, whose style sheets know no functions in functions.
pub(super) fn rewritten_functions<'v>(
    list: &'v str,
    current: &Color,
    length: impl Fn(&'v str) -> Option<Cow<'v, str>>,
) -> Cow<'v, str> {
    let has_unit = |w: &str| !w.starts_with('#') && w.ends_with(|c: char| c.is_ascii_alphabetic());
    let rewritten = |w: &'v str| length(w).filter(|_| has_unit(w)).unwrap_or(Cow::Borrowed(w));
    let (mut out, mut left) = (String::new(), list);
    while let Some((name, inside, after)) = function(left) {
        let is = |word: &str| name.trim().eq_ignore_ascii_case(word);
        let mut arguments: Vec<Cow<'_, str>> = words(inside).into_iter().map(rewritten).collect();
        if is("drop-shadow") {
            let mut color = *current;
            if let Some((i, given)) = arguments.iter().enumerate().find_map(|(i, w)| Some((i, computed(w, current)?))) {
                arguments.remove(i);
                color = given;
            }
            arguments.push(shadow(&color).into());
        }
        let arguments = if is("url") { inside.to_owned() } else { arguments.join(" ") };
        out.extend([name, "(", &arguments, ")"]);
        left = after;
    }
    out.push_str(left);
    if out == list { list.into() } else { out.into() }
}

/// Splits a list at its first function: the text before the parenthesis, inside, and after it.
fn function(list: &str) -> Option<(&str, &str, &str)> {
    let (name, rest) = list.split_once('(')?;
    let mut depth = 0_usize;
    let end = rest.find(|c| {
        depth = match c {
            '(' => depth + 1,
            ')' if depth > 0 => depth - 1,
            _ => return c == ')',
        };
        false
    })?;
    Some((name, &rest[..end], &rest[end + 1..]))
}

/// The colour that resvg 0.49 shows as `color` in a drop shadow in sRGB, since it takes it as linear light and converts it.
pub(super) fn shadow(color: &Color) -> String {
    let [r, g, b, a] = color.to_linear_rgba().map(|v| (255.0 * v).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}{a:02x}")
}

/// Converts a colour of Display P3 to XYZ.
fn to_xyz(color: &str) -> Option<String> {
    let arguments = color.strip_prefix("color(display-p3")?.strip_suffix(')')?;
    let (channels, alpha) = arguments.split_once('/').unwrap_or((arguments, "1"));
    let channel = |text: &str| {
        let value: f64 = match text.strip_suffix('%') {
            Some(share) => share.parse::<f64>().ok()? / 100.0,
            None => text.parse().ok()?,
        };
        // Display P3 has the transfer function of sRGB.
        let v = value.abs();
        Some(value.signum() * if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) })
    };
    let linear: Vec<f64> = channels.split_ascii_whitespace().map(channel).collect::<Option<_>>()?;
    let [x, y, z] = P3_TO_XYZ.map(|row| row.iter().zip(&linear).map(|(m, v)| m * v).sum::<f64>());
    (linear.len() == 3).then(|| format!("color(xyz {x:.9} {y:.9} {z:.9} / {})", alpha.trim()))
}

#[cfg(test)]
mod tests {
    use super::{Color, paint, rewritten_functions};

    const CURRENT: Color = Color::new(170.0 / 255.0, 187.0 / 255.0, 204.0 / 255.0, 1.0);

    #[test]
    fn colours_that_usvg_reads_stay() {
        for css in ["#123", "url(#a) red", "context-fill", "currentColor", "hsl(120 50% 40% / 60%)"] {
            assert_eq!(paint(css, &CURRENT).as_deref(), Some(css));
        }
    }

    #[test]
    fn filter_functions_are_rewritten() {
        for (css, plain) in [
            ("drop-shadow(8px 1rem 6px rgba(0, 0, 0, .6))", "drop-shadow(8px 16px 6px #00000099)"),
            ("blur(2px) drop-shadow(rgb(255 0 0 / 50%) 1px 2px)", "blur(2px) drop-shadow(1px 2px #ff000080)"),
            // In linear light, by the formula of CSS Color 4, section 10.2: 170, 187 and 204 of 255.
            ("drop-shadow(1px 2px)", "drop-shadow(1px 2px #677f9aff)"),
            ("url(#rem) hue-rotate(90deg) grayscale(50%)", "url(#rem) hue-rotate(90deg) grayscale(50%)"),
            ("drop-shadow(1px 2px", "drop-shadow(1px 2px"),
            ("blur((()))) é", "blur((()))) é"),
        ] {
            let length = |v| Some(if v == "1rem" { "16px" } else { v }.into());
            assert_eq!(rewritten_functions(css, &CURRENT, length), plain);
        }
    }

    /// The expected colours are those of Chromium 156, within a level. `currentColor` is #abc.
    #[test]
    fn other_spaces() {
        for (css, wanted) in [
            ("oklch(0.7 0.1 150)", [111, 176, 125]),
            ("lab(50% 40 30)", [187, 88, 70]),
            ("color(srgb 1 .5 0)", [255, 128, 0]),
            ("color(display-p3 0.5 0.5 0.5)", [127, 128, 128]),
            ("color(display-p3 0.4 60% 0.4 / 1)", [85, 155, 97]),
            ("RebeccaPurple", [102, 51, 153]),
            ("ButtonFace", [239, 239, 239]),
            ("color-mix(in srgb, red, blue)", [128, 0, 128]),
            ("color-mix(in srgb, red 20%, blue 30%)", [102, 0, 153]),
            ("color-mix(in srgb,currentColor 30%,blue)", [51, 56, 240]),
            ("color-mix(in hsl, white, blue)", [159, 159, 223]),
            ("color-mix(in hsl, red, blue)", [255, 0, 255]),
            ("color-mix(in hsl longer hue, red, blue 25%)", [255, 255, 0]),
            ("color-mix(in hwb, red, #0f08)", [255, 255, 0]),
            ("color-mix(in oklab, light-dark(red, lime), color-mix(in srgb, blue, blue))", [140, 83, 162]),
            ("rgb(from currentColor r g b)", [170, 187, 204]),
            ("hsl(from #369 h s calc(l + 20))", [102, 153, 204]),
            ("hsl(from red h s 30%)", [153, 0, 0]),
        ] {
            let found = paint(css, &CURRENT).unwrap();
            let channels = found.strip_prefix("rgba(").unwrap().split(',').take(3);
            let channels: Vec<i32> = channels.map(|c| c.parse().unwrap()).collect();
            assert!(channels.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= 1), "{css}: {found}");
        }
        let alpha = |css| paint(css, &CURRENT).unwrap().trim_end_matches(')').rsplit(',').next().unwrap().to_owned();
        for (css, wanted) in
            [("color-mix(in srgb, red 20%, blue 30%)", 0.5), ("rgb(from currentColor r g b / .5)", 0.5)]
        {
            assert!((alpha(css).parse::<f64>().unwrap() - wanted).abs() < 0.01, "{css}");
        }
        let none = [
            "color(display-p3 1 0)",
            "color-mix(in srgb, red, blue, lime)",
            "color-mix(in srgb, red 150%, blue)",
            "oklch(x)",
            "",
        ];
        for none in none {
            assert_eq!(paint(none, &CURRENT), None, "{none}");
        }
    }
}
