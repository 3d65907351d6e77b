//! Limits on the work that a text and its fonts may cause.

use crate::error::{Error, Quantity};

/// Glyphs allowed for each letter on average, several times as many as sound fonts use.
const GLYPHS_PER_LETTER: usize = 16;

/// Limits on a text.
///
/// ```
/// use pathwarp_text::{Error, Font, Quantity, TextLimits, TextStyle, layout_within};
///
/// # let bytes = include_bytes!("../../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf");
/// let (fonts, style) = ([Font::new(bytes, 0)?], TextStyle::default());
/// let few = TextLimits { letters: 4, ..TextLimits::default() };
/// let error = layout_within("words", &fonts, &style, &few).unwrap_err();
/// assert_eq!(error, Error::TooLarge { quantity: Quantity::Letters, needed: 5, most: 4 });
/// # Ok::<(), Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TextLimits {
    /// Maximum number of letters. A font may use up to sixteen glyphs for each on average.
    pub letters: usize,
    /// Maximum number of segments of all outlines.
    pub segments: usize,
}

impl Default for TextLimits {
    /// Limits that keep a text below about a second and 200 MB.
    fn default() -> Self {
        Self { letters: 30_000, segments: 2_000_000 }
    }
}

impl TextLimits {
    pub(crate) fn letters(&self, needed: usize) -> Result<(), Error> {
        check_limit(Quantity::Letters, needed, self.letters)
    }

    pub(crate) fn glyphs(&self, needed: usize) -> Result<(), Error> {
        check_limit(Quantity::Glyphs, needed, self.letters.saturating_mul(GLYPHS_PER_LETTER))
    }

    pub(crate) fn segments(&self, needed: usize) -> Result<(), Error> {
        check_limit(Quantity::Segments, needed, self.segments)
    }
}

fn check_limit(quantity: Quantity, needed: usize, most: usize) -> Result<(), Error> {
    if needed <= most { Ok(()) } else { Err(Error::TooLarge { quantity, needed, most }) }
}
