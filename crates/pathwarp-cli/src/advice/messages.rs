//! The messages of library errors and warnings, with advice for every kind.

use super::flags::Flags;
use crate::decimals::three_figures;
use pathwarp::budget::Exceeded;
use pathwarp::kurbo::Rect;
use pathwarp::{Error, GeometryError};
use pathwarp_svg::{LetteringFrameError, UnreadImages, Warning};

/// The message of an error of the libraries: parameters as flags, with the options that help.
pub(crate) fn error(e: &Error, flags: &Flags) -> String {
    match e {
        // The value is quoted as the user typed it, so only the problem is searched for parameters.
        Error::Usage { param, value, problem } => {
            // A likely name says more than the list of all.
            let problem = match (flags.likely(param, value), problem.split_once("; ")) {
                (Some(name), Some((fault, _))) => format!("{fault}; did you mean {name}?"),
                _ => flags.in_text(problem),
            };
            Error::usage(&format!("--{param}"), value, problem).to_string()
        }
        Error::Missing { param, hint } => Error::missing(&format!("--{param}"), flags.in_text(hint)).to_string(),
        Error::Input { limit: Some(exceeded), .. } => format!("{e}; {}", raise(exceeded)),
        Error::Input { place, problem, .. } => Error::input(place, flags.in_text(problem)).to_string(),
        Error::Geometry(g) => geometry(g, flags),
        _ => flags.in_text(&e.to_string()),
    }
}

fn geometry(e: &GeometryError, flags: &Flags) -> String {
    let message = flags.in_text(&flags.in_front(&e.to_string()));
    match e {
        GeometryError::Limit(exceeded) => format!("{message}; allow a larger --tolerance, or {}", raise(exceeded)),
        GeometryError::Infinity { .. } => format!("{message} (--on-error skip)"),
        GeometryError::FlatFrame { .. } => format!("{message} (--frame X,Y,W,H, or --base where there is one)"),
        _ => message,
    }
}

/// Names the option that raises a limit.
pub(crate) fn raise(exceeded: &Exceeded) -> String {
    let enough = exceeded.enough();
    let value = if enough.is_finite() { format!("{enough:.0}") } else { "none".to_owned() };
    let guess = if exceeded.cut { ", ten times as much, as the whole amount is not known" } else { "" };
    format!("if you trust the file, raise the limit with --limit {}={value}{guess}", exceeded.limit)
}

/// The message of an error about a picture, with advice.
pub(crate) fn picture(e: &pathwarp_raster::Error) -> String {
    match e {
        pathwarp_raster::Error::TooLarge { exceeded, .. } | pathwarp_raster::Error::TooMuch(exceeded) => {
            format!("{e}; {}", raise(exceeded))
        }
        _ => e.to_string(),
    }
}

/// The message of an error about a surface in space, with advice.
pub(crate) fn surface(e: &pathwarp_mesh::Error) -> String {
    match e {
        pathwarp_mesh::Error::TooMany { exceeded, .. } => {
            format!("{e}; allow a larger --tolerance, or {}", raise(exceeded))
        }
        _ => e.to_string(),
    }
}

/// Describes artwork that the page cuts off and the map stretches, with the frame that prevents it.
pub(crate) fn stretched(uncut: Rect, stretch: f64) -> String {
    // Three figures, rounded outwards.
    let digits = (2.0 - uncut.width().max(uncut.height()).log10().floor()).clamp(0.0, 9.0) as usize;
    let unit = 0.1f64.powi(digits as i32);
    let [x0, y0] = [uncut.x0, uncut.y0].map(|v| (v / unit).floor() * unit);
    let [x1, y1] = [uncut.x1, uncut.y1].map(|v| (v / unit).ceil() * unit);
    format!(
        "the page cuts shapes off, and the map, whose frame is what the page shows, stretches the hidden parts {} times as much as the \
         rest; --frame {x0:.digits$},{y0:.digits$},{:.digits$},{:.digits$} has room for them",
        three_figures(stretch),
        x1 - x0,
        y1 - y0
    )
}

/// A warning about fonts that are missing.
fn missing_fonts(families: &[String]) -> Option<String> {
    (!families.is_empty()).then(|| Warning::MissingFonts(families.to_vec()).to_string())
}

/// Lists what a picture of a drawing lacks: fonts, images, and what else is not drawn, of which the first are named; and what browsers
/// show a little otherwise.
pub(crate) fn lacking(fonts: &[String], images: &UnreadImages, undrawn: &[String], notes: &[String]) -> Vec<String> {
    const NAMED: usize = 10;
    let mut out: Vec<String> = missing_fonts(fonts).into_iter().chain(unread(images)).collect();
    out.extend(undrawn.iter().take(NAMED).cloned());
    let more = undrawn.len().saturating_sub(NAMED);
    out.extend((more > 0).then(|| format!("and {more} more")));
    out.extend_from_slice(notes);
    out
}

/// Describes images that were not read because they lie outside of the drawing's folder.
pub(crate) fn outside(unread: &UnreadImages) -> Option<String> {
    let n = unread.outside.len();
    let what = if n == 1 { "1 linked image lies".to_owned() } else { format!("{n} linked images lie") };
    (n > 0).then(|| format!("{what} outside of the drawing's folder; --allow-external reads images from anywhere"))
}

/// Lists the images that were not read.
fn unread(unread: &UnreadImages) -> Vec<String> {
    let unreadable = unread.unreadable.iter().map(|link| format!("the image {link} cannot be read"));
    let outside_links = unread.outside.iter().map(|link| format!("the image {link} was not read"));
    unreadable.chain(outside_links).chain(outside(unread)).collect()
}

/// Describes why there is no frame around lettering, with the options that help.
pub(crate) fn lettering_frame(error: &LetteringFrameError) -> String {
    let advice = match error {
        LetteringFrameError::NoLettering => "write it with `pathwarp text`, or use --frame X,Y,W,H or artwork",
        LetteringFrameError::NotLevel { .. } => "rotate it first, or use --frame artwork",
        LetteringFrameError::NoHeight => "use --frame baseline-ascent, ink or artwork",
        _ => "use --frame artwork",
    };
    format!("cannot make a frame: {error}; {advice}")
}
