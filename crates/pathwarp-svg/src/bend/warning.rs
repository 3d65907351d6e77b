//! Warnings about a warped drawing: what kind each is, which elements it names, and its sentence.

use std::fmt::{self, Display};

/// A warning for the user about a warped drawing. [`Display`] writes it as a sentence without a full stop.
///
/// Elements are named by their id in the source, or else by name and position, as in
/// [`ShapeReport::id`](crate::ShapeReport::id).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The structure of the file could not be kept, for this reason: the result is flattened.
    Flattened(String),
    /// A gradient follows the best affine fit of the map only.
    FittedGradient {
        /// The shape that it paints.
        id: String,
        /// The reason why it did not become a picture.
        why: String,
    },
    /// A stroke that should have become an outline is still a stroke, as the map is undefined beside it.
    SingleWidth {
        /// The shape.
        id: String,
        /// Largest distance from the exact stroke, in root user units; infinite if it is unknown.
        error: f64,
    },
    /// Gradients and patterns span the whole row of copies instead of each copy.
    SharedPaints,
    /// Images and filtered groups follow the row of copies as a whole.
    SharedImages,
    /// Text uses another font, as these are missing.
    MissingFonts(Vec<String>),
    /// Artwork that lay off the page has moved onto it: these elements, in the order of the file.
    Arrivals(Vec<String>),
    /// Something else that is lost or changed.
    Note {
        /// The sentence.
        text: &'static str,
        /// The elements, attributes or prefixes that it applies to, sorted.
        names: Vec<String>,
    },
}

impl Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flattened(why) => write!(f, "the file is flattened, as its structure cannot be kept: {why}"),
            Self::FittedGradient { id, why } => {
                write!(f, "a gradient of {id} only follows the best affine fit: {why}")
            }
            Self::SingleWidth { id, error } => {
                write!(f, "the stroke of {id} extends to where the map is undefined; it keeps a single width")?;
                if error.is_finite() { write!(f, ", off by up to {error:.3} units") } else { Ok(()) }
            }
            Self::SharedPaints => {
                f.write_str("gradients and patterns span the whole row of copies instead of each copy")
            }
            Self::SharedImages => {
                f.write_str("images and filtered groups are not repeated; they follow the row as a whole")
            }
            Self::MissingFonts(names) => {
                write!(f, "text uses another font, as {} is missing; install it or outline the text", names.join(", "))
            }
            Self::Note { text, names } => {
                f.write_str(text)?;
                write_names(f, names)
            }
            Self::Arrivals(names) => {
                let shapes = if names.len() == 1 {
                    "shape that lay off the page has"
                } else {
                    "shapes that lay off the page have"
                };
                write!(f, "{} {shapes} moved onto it", names.len())?;
                write_names(f, names)
            }
        }
    }
}

/// Writes the names that a warning is about.
fn write_names(f: &mut fmt::Formatter<'_>, names: &[String]) -> fmt::Result {
    /// Number of names listed; a few are enough to find the place.
    const NAMED: usize = 4;
    if let Some((first, others)) = names.split_first() {
        write!(f, ": {first}")?;
        others.iter().take(NAMED - 1).try_for_each(|name| write!(f, ", {name}"))?;
    }
    if names.len() > NAMED { write!(f, " and {} more", names.len() - NAMED) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::Warning;

    #[test]
    fn notes_name_a_few_of_many() {
        let note = |n: usize| {
            let names = ["a", "b", "c", "d", "e", "f"][..n].iter().map(|s| (*s).to_owned()).collect();
            Warning::Note { text: "dropped", names }.to_string()
        };
        assert_eq!(
            [0, 1, 4, 6].map(note),
            ["dropped", "dropped: a", "dropped: a, b, c, d", "dropped: a, b, c, d and 2 more"]
        );
    }
}
