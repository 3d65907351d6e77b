//! Parsers for option values with their own syntax. Errors name the fault without the option.

use super::common::FrameChoice;
use pathwarp::kurbo::Rect;
use pathwarp_svg::LetteringFrame;

/// Parses a positive, finite number.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err(format!("`{text}` is not a positive number")),
    }
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
pub(crate) fn rect(text: &str) -> Result<Rect, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|w| w.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, w, h]) if w > 0.0 && h > 0.0 && (x + y + w + h).is_finite() => Ok(Rect::new(x, y, x + w, y + h)),
        _ => Err(format!(
            "`{text}` is not one of artwork, viewbox, X,Y,W,H (W and H positive) or, for lettering, baseline-ascent, \
             baseline-capheight, baseline-xheight, ascent-descent, ink"
        )),
    }
}
