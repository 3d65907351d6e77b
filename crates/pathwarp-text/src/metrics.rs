//! Heights and variation axes of fonts.

/// Heights of a font, measured from the baseline and all positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct FontMetrics {
    /// Distance from the baseline up to the top of the line box.
    pub ascent: f64,
    /// Distance from the baseline down to the bottom of the line box.
    pub descent: f64,
    /// Recommended distance between line boxes.
    pub line_gap: f64,
    /// Height of capitals from the OS/2 table, else of the H, else the ascent.
    pub cap_height: f64,
    /// Height of small letters from the OS/2 table, else of the x, else the cap height.
    pub x_height: f64,
}

impl FontMetrics {
    /// Scales the heights.
    #[must_use]
    pub fn scaled(self, by: f64) -> Self {
        Self {
            ascent: self.ascent * by,
            descent: self.descent * by,
            line_gap: self.line_gap * by,
            cap_height: self.cap_height * by,
            x_height: self.x_height * by,
        }
    }
}

/// An axis of a variable font.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FontAxis {
    /// Four characters such as `wght`.
    pub tag: String,
    /// Name in the font.
    pub name: String,
    /// Smallest value.
    pub min: f64,
    /// Default value.
    pub default: f64,
    /// Largest value.
    pub max: f64,
}
