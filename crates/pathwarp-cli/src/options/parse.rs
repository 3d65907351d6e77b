//! Parsers for option values with their own syntax. Errors name the fault without the option.

use super::common::FrameChoice;
use super::typed_box::TypedBox;
use pathwarp::budget::{Limit, Limits};
use pathwarp::param::{Length, LengthUnit};
use pathwarp_svg::LetteringFrame;

/// Parses a positive, finite number.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err(format!("`{text}` is not a positive number")),
    }
}

/// Parses a limit, `NAME=N` or `NAME=none`.
pub(super) fn limit(text: &str, limits: &mut Limits) -> Result<(), String> {
    let (name, value) = text.split_once('=').ok_or_else(|| format!("`{text}` is not NAME=N, such as work=1e9"))?;
    let limit = Limit::named(name.trim()).ok_or_else(|| match name.trim() {
        old @ ("comparisons" | "segments" | "letters" | "painting" | "evaluations") => {
            format!(
                "`{old}` is now part of the limit `work`: --limit work=N, of which a default run has {:.0e}",
                Limits::default().of(Limit::Work)
            )
        }
        "image-bytes" => "`image-bytes` is now part of the limit `bytes`: --limit bytes=N".to_owned(),
        other => crate::advice::unknown("limit", other, Limit::ALL.into_iter().map(Limit::name)),
    })?;
    let most = if value.trim() == "none" { f64::INFINITY } else { positive(value.trim())? };
    *limits = limits.with(limit, most);
    Ok(())
}

/// Parses a positive length.
pub(super) fn positive_length(text: &str) -> Result<Length, String> {
    let length: Length = text.parse().map_err(|e| format!("`{text}` {e}"))?;
    if length.value > 0.0 { Ok(length) } else { Err(format!("`{text}` is not positive")) }
}

/// Parses a size in pixels, `W` or `WxH`.
pub(super) fn image_size(text: &str) -> Result<(u32, Option<u32>), String> {
    let number = |t: &str| t.trim().parse::<u32>().ok().filter(|n| *n > 0);
    let size = match text.split_once(['x', 'X', '×']) {
        None => number(text).map(|w| (w, None)),
        Some((w, h)) => number(w).zip(number(h)).map(|(w, h)| (w, Some(h))),
    };
    size.ok_or_else(|| format!("`{text}` is neither W nor WxH in whole pixels"))
}

/// Parses a frame: one of its names, or a box.
pub(super) fn frame(text: &str) -> Result<FrameChoice, String> {
    Ok(match text {
        "artwork" => FrameChoice::Artwork,
        "viewbox" => FrameChoice::ViewBox,
        "ink" => FrameChoice::Lettering(LetteringFrame::Ink),
        "baseline-ascent" => FrameChoice::Lettering(LetteringFrame::BaselineAscent),
        "baseline-capheight" => FrameChoice::Lettering(LetteringFrame::BaselineCapHeight),
        "baseline-xheight" => FrameChoice::Lettering(LetteringFrame::BaselineXHeight),
        "ascent-descent" => FrameChoice::Lettering(LetteringFrame::AscentDescent),
        t => FrameChoice::Rect(rect(t)?),
    })
}

/// Parses a box, `X,Y,W,H`.
pub(crate) fn rect(text: &str) -> Result<TypedBox, String> {
    let lengths: Result<Vec<Length>, _> = text.split(',').map(str::parse).collect();
    match lengths.as_deref() {
        Ok(&[x, y, w, h])
            if w.value > 0.0 && h.value > 0.0 && [x, y, w, h].iter().all(|l| l.unit != LengthUnit::Percent) =>
        {
            Ok(TypedBox([x, y, w, h]))
        }
        _ => Err(format!(
            "`{text}` is not one of artwork, viewbox, X,Y,W,H (lengths; W and H positive) or, for lettering, \
             baseline-ascent, baseline-capheight, baseline-xheight, ascent-descent, ink"
        )),
    }
}
/// Parses a family's name.
pub(super) fn family(text: &str) -> Result<String, String> {
    let name = text.trim().trim_matches(['"', '\'']);
    if name.is_empty() { Err("the name is empty".into()) } else { Ok(name.to_owned()) }
}
