//! Advice that names flags, added to the errors and warnings of the libraries, which know no command line.

use crate::catalogue::Catalogue;
use crate::readable::{listed, three_figures};
use pathwarp::budget::Exceeded;
use pathwarp::kurbo::Rect;
use pathwarp::param::Kind;
use pathwarp::{Error, GeometryError};
use pathwarp_svg::engine::{LetteringFrameError, UnreadImages};
use pathwarp_svg::{ShapeReport, Skipped, Warning};
use std::collections::{BTreeMap, BTreeSet};

/// The error of edits of a picture.
pub(crate) const NO_PATHS_TO_EDIT: &str = "edits (caption, simplify, offset, unite, contour, outline, --simplify, --outset) work on paths; a picture has none";

/// Warns of characters that no font has.
pub fn missing_letters(chars: &[char]) -> String {
    /// Number of characters that fit in two lines.
    const SHOWN: usize = 12;
    let shown: Vec<String> = chars.iter().map(|c| format!("{c} (U+{:04X})", u32::from(*c))).collect();
    format!("no font has {}; install one that has them, or name it with --font", listed(&shown, SHOWN))
}

/// Warns of shapes of which an edit leaves nothing.
pub(crate) fn vanished<'a>(shapes: impl Iterator<Item = &'a ShapeReport>) -> Option<String> {
    const NAMED: usize = 5;
    let gone = shapes.filter(|s| s.path.segments_in > 0 && s.path.segments_out == 0);
    let gone: Vec<&str> = gone.map(|s| s.id.as_str()).collect();
    (!gone.is_empty()).then(|| format!("nothing is left of {}: narrower than the distance", listed(&gone, NAMED)))
}

/// Returns the message of an error of the libraries, with parameters as flags and advice on options.
pub(crate) fn error_message(e: &Error, flags: &Flags) -> String {
    match e {
        // The value is the user's text, so only the problem is searched for parameters.
        Error::Usage { param, value, problem, advice } => {
            // A likely name helps more than the list of all, which is the advice if a name is unknown.
            let likely = flags.likely(param, value).filter(|_| !advice.is_empty());
            let advice = likely.map_or_else(|| flags.in_text(advice), |name| format!("; did you mean {name}?"));
            Error::usage(&format!("--{param}"), value, flags.in_text(problem) + &advice).to_string()
        }
        Error::Missing { param, hint } => Error::missing(&format!("--{param}"), flags.in_text(hint)).to_string(),
        Error::Input { limit: Some(exceeded), .. } => format!("{e}; {}", raise(exceeded)),
        Error::Input { place, problem, .. } => Error::input(place, flags.in_text(problem)).to_string(),
        Error::Geometry(g) => geometry_message(g, flags),
        _ => flags.in_text(&e.to_string()),
    }
}

fn geometry_message(e: &GeometryError, flags: &Flags) -> String {
    let message = flags.in_text(&flags.in_front(&e.to_string()));
    match e {
        GeometryError::Limit(exceeded) => format!("{message}; allow a larger --tolerance, or {}", raise(exceeded)),
        GeometryError::Infinity { .. } => format!("{message} (--on-error skip)"),
        GeometryError::FlatFrame { .. } => format!("{message} (--frame X,Y,W,H, or --base where there is one)"),
        _ => message,
    }
}

/// Names the option that raises a limit.
pub fn raise(exceeded: &Exceeded) -> String {
    let enough = exceeded.enough();
    let value = if enough.is_finite() { format!("{enough:.0}") } else { "none".to_owned() };
    let guess = if exceeded.cut { ", ten times as much, as the whole amount is not known" } else { "" };
    format!("if you trust the file, raise the limit with --limit {}={value}{guess}", exceeded.limit)
}

/// Returns the message of an error about a picture, with advice.
pub(crate) fn picture_message(e: &pathwarp_raster::Error) -> String {
    match e {
        pathwarp_raster::Error::TooLarge { exceeded, .. } | pathwarp_raster::Error::TooMuch(exceeded) => {
            format!("{e}; {}", raise(exceeded))
        }
        _ => e.to_string(),
    }
}

/// Returns the message of an error about a surface in space, with advice.
pub fn surface_message(e: &pathwarp_solid::artwork::Error) -> String {
    match e {
        pathwarp_solid::artwork::Error::TooMany { exceeded, .. } => {
            format!("{e}; allow a larger --tolerance, or {}", raise(exceeded))
        }
        _ => e.to_string(),
    }
}

/// Warns of artwork beyond the page's edge that the map stretches, and names the frame that has room for it.
pub(crate) fn stretched(uncut: Rect, stretch: f64) -> String {
    // Round outwards to three figures.
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

/// Lists what a picture of a drawing lacks (fonts, images, and other content, the first of it by name), and how browsers differ.
pub fn lacking(fonts: &[String], images: &UnreadImages, undrawn: &[String], notes: &[String]) -> Vec<String> {
    const NAMED: usize = 10;
    let missing_fonts = (!fonts.is_empty()).then(|| Warning::MissingFonts(fonts.to_vec()).to_string());
    let mut out: Vec<String> = missing_fonts.into_iter().chain(unread(images)).collect();
    out.extend(undrawn.iter().take(NAMED).cloned());
    let more = undrawn.len().saturating_sub(NAMED);
    out.extend((more > 0).then(|| format!("and {more} more")));
    out.extend_from_slice(notes);
    out
}

/// Counts the images that were not read because they lie outside the drawing's folder.
fn outside_of_folder(unread: &UnreadImages) -> Option<String> {
    let n = unread.outside.len();
    let what = if n == 1 { "1 linked image lies".to_owned() } else { format!("{n} linked images lie") };
    (n > 0).then(|| format!("{what} outside of the drawing's folder; --allow-external reads images from anywhere"))
}

/// Lists the images that were not read, except those among `skipped`, and counts those outside the drawing's folder.
pub(crate) fn unread_besides(images: &UnreadImages, skipped: &[Skipped]) -> Vec<String> {
    let besides = |link: &&String| !skipped.iter().any(|s| s.why.contains(link.as_str()));
    let named = images.unreadable.iter().chain(&images.outside).filter(besides);
    named.map(|link| format!("the image {link} was not read")).chain(outside_of_folder(images)).collect()
}

/// Lists the images that were not read.
pub(crate) fn unread(unread: &UnreadImages) -> Vec<String> {
    let unreadable = unread.unreadable.iter().map(|link| format!("the image {link} cannot be read"));
    let outside_links = unread.outside.iter().map(|link| format!("the image {link} was not read"));
    unreadable.chain(outside_links).chain(outside_of_folder(unread)).collect()
}

/// Describes why no frame around lettering exists, and the options that help.
pub(crate) fn lettering_frame(error: &LetteringFrameError) -> String {
    let advice = match error {
        LetteringFrameError::NoLettering => "write it with `pathwarp text`, or use --frame X,Y,W,H or artwork",
        LetteringFrameError::NotLevel { .. } => "rotate it first, or use --frame artwork",
        LetteringFrameError::NoHeight => "use --frame baseline-ascent, ink or artwork",
        _ => "use --frame artwork",
    };
    format!("cannot make a frame: {error}; {advice}")
}

/// The parameters that messages may turn into flags.
pub struct Flags {
    params: BTreeSet<&'static str>,
    /// The names allowed as values of a parameter.
    names: BTreeMap<&'static str, Vec<&'static str>>,
}

impl Flags {
    /// Collects the parameters of all deformations.
    pub fn of(catalogue: &dyn Catalogue) -> Self {
        let params = || catalogue.infos().into_iter().flat_map(|i| i.params);
        let mut names: BTreeMap<&'static str, Vec<&'static str>> = BTreeMap::new();
        for p in params() {
            if let Kind::NameOrFile(values) | Kind::Choice(values) = p.kind {
                names.entry(p.name).or_default().extend(values);
            }
        }
        Self { params: params().map(|p| p.name).collect(), names }
    }

    /// Adds the parameters of `other`.
    pub fn with(mut self, other: Self) -> Self {
        self.params.extend(other.params);
        for (name, values) in other.names {
            self.names.entry(name).or_default().extend(values);
        }
        self
    }

    /// Returns the name that was most likely meant by a wrong value of the parameter `param`.
    pub fn likely(&self, param: &str, value: &str) -> Option<&'static str> {
        likely(&value.to_lowercase(), self.names.get(param)?.iter().copied())
    }

    /// Puts dashes before a message that begins with a parameter: `base: …`, `base file.svg has …`.
    pub(crate) fn in_front(&self, message: &str) -> String {
        let name = message.split([' ', ':']).next().unwrap_or_default();
        if self.params.contains(name) { format!("--{message}") } else { message.to_owned() }
    }

    /// Replaces `` `name` `` and `` `name value` `` by `--name` and `--name value` where `name` is a parameter of several letters.
    pub fn in_text(&self, message: &str) -> String {
        let is_param = |span: &str| {
            let mut words = span.split(' ');
            let known = words.next().is_some_and(|w| w.len() > 1 && self.params.contains(w));
            known && words.count() < 2 && !span.ends_with(' ')
        };
        let parts: Vec<&str> = message.split('`').collect();
        // Every second part is quoted, except behind an unpaired last quote.
        let (is_quoted, is_closed) = (|i: usize| i % 2 == 1, |i: usize| i + 1 < parts.len());
        let restored = |(i, part): (usize, &&str)| match (is_quoted(i), is_closed(i)) {
            (true, true) if is_param(part) => format!("--{part}"),
            (true, true) => format!("`{part}`"),
            (true, false) => format!("`{part}"),
            (false, _) => (*part).to_owned(),
        };
        parts.iter().enumerate().map(restored).collect()
    }
}

/// Returns the message that no `what` is called `name`, with the known name that is most like it.
pub fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let advice = likely(name, known).map(|likely| format!("; did you mean `{likely}`?")).unwrap_or_default();
    format!("there is no {what} `{name}`{advice}")
}

/// Returns the known name that is most like `name`, if any is similar.
pub fn likely<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    /// Least similarity of a suggestion, from 0 to 1.
    const LEAST: f64 = 0.8;
    let similar = known.map(|k| (strsim::jaro_winkler(name, k), k)).filter(|(similarity, _)| *similarity >= LEAST);
    similar.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, likely)| likely)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::deform::Registry;

    #[test]
    fn parameters_become_flags() {
        let flags = Flags::of(&Registry::builtin());
        assert_eq!(flags.in_text("use `by length`; see `stretch`"), "use --by length; see --stretch");
        assert_eq!(flags.in_front("base: anchors 1 and 2 coincide"), "--base: anchors 1 and 2 coincide");
        assert_eq!(flags.in_front("#based has 3 anchors"), "#based has 3 anchors");
        let unknown = "there is no `wobble`, `along the way` or `by";
        assert_eq!(flags.in_text(unknown), unknown);
    }

    #[test]
    fn likely_names_are_suggested_and_others_are_not() {
        let known = ["tolerance", "strokes", "select"];
        let message = |name: &str| unknown("option", name, known.into_iter());
        assert!(message("tolerence").ends_with("did you mean `tolerance`?"), "{}", message("tolerence"));
        assert_eq!(message("xyz"), "there is no option `xyz`");
    }
}
