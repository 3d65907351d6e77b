//! Advice in flags: adds the options that help to the errors and warnings of the libraries, which know no command line.

use crate::decimals::three_figures;
use pathwarp::{Error, GeometryError};
use pathwarp_svg::{LetteringFrameError, Overhang};

/// The message of an error with advice.
pub(crate) fn error(e: &Error) -> String {
    match e {
        Error::Geometry(GeometryError::Infinity { .. }) => format!("{e} (--on-error skip)"),
        _ => e.to_string(),
    }
}

/// The message of an error about a surface in space, with advice.
pub(crate) fn surface(e: &pathwarp_mesh::Error) -> String {
    match e {
        pathwarp_mesh::Error::TooMany { .. } => format!("{e}; allow a larger --tolerance"),
        _ => e.to_string(),
    }
}

/// Describes artwork that extends past the page, with the options that change it.
pub(crate) fn overhang(o: Overhang) -> String {
    let names = ["left", "top", "right", "bottom"];
    let sides: Vec<&str> = names.iter().zip(o.by).filter(|(_, by)| *by > 0.0).map(|(name, _)| *name).collect();
    let most = o.by.into_iter().fold(0.0, f64::max);
    format!(
        "the artwork extends past the page by up to {} units ({} %; {}); --fit grow enlarges the page, --fit page fits it to the artwork",
        three_figures(most),
        three_figures(100.0 * o.share),
        sides.join(", ")
    )
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

/// Says that there is no `what` called `name`, and which of the known names is most like it.
pub(crate) fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    /// Names less alike than this have nothing to do with each other.
    const LIKELY: f64 = 0.8;
    let likeness = known.map(|k| (strsim::jaro_winkler(name, k), k)).filter(|(l, _)| *l >= LIKELY);
    match likeness.max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((_, likely)) => format!("there is no {what} `{name}`; did you mean `{likely}`?"),
        None => format!("there is no {what} `{name}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn likely_names_are_suggested_and_others_are_not() {
        let known = ["tolerance", "strokes", "select"];
        let said = |name: &str| unknown("option", name, known.into_iter());
        assert!(said("tolerence").ends_with("did you mean `tolerance`?"), "{}", said("tolerence"));
        assert_eq!(said("xyz"), "there is no option `xyz`");
    }
}
