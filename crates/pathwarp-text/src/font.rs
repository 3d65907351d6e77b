//! Reads fonts and sets their axes.

use crate::error::{Error, guarded};
use crate::glyph::{Outlines, Synthesis};
use crate::itemize::Writing;
use crate::metrics::{FontAxis, FontMetrics};
use crate::style::Variation;
use harfrust::{ShaperData, ShaperInstance};
use kurbo::Shape as _;
use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::raw::{FileRef, ReadError, TableProvider as _};
use skrifa::string::StringId;
use skrifa::{FontRef, GlyphId, MetadataProvider as _};
use std::fmt;

/// A font with a position on its variation axes.
pub struct Font<'a> {
    pub(crate) font: FontRef<'a>,
    pub(crate) data: ShaperData,
    pub(crate) instance: ShaperInstance,
    pub(crate) outlines: Outlines<'a>,
    charmap: Charmap<'a>,
    units_per_em: f64,
    metrics: FontMetrics,
    pub(crate) synthesis: Synthesis,
    /// The only writing that may use the font, if there is such a restriction.
    pub(crate) only: Option<Writing>,
}

impl Clone for Font<'_> {
    fn clone(&self) -> Self {
        Self {
            font: self.font.clone(),
            data: ShaperData::new(&self.font),
            instance: self.instance.clone(),
            outlines: self.outlines.clone(),
            charmap: self.charmap.clone(),
            ..*self
        }
    }
}

impl fmt::Debug for Font<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Font").field("name", &self.name()).field("metrics", &self.metrics).finish_non_exhaustive()
    }
}

impl<'a> Font<'a> {
    /// Reads a TrueType or OpenType font with `glyf`, CFF or CFF2 outlines. `index` counts the fonts of a collection from 0.
    ///
    /// # Errors
    /// [`Error::NotAFont`] when the bytes are not such a font, [`Error::NoSuchFace`] when the file has fewer fonts, [`Error::Failed`] when
    /// a damaged font makes its reader panic.
    pub fn new(bytes: &'a [u8], index: u32) -> Result<Self, Error> {
        guarded(|| Self::read(bytes, index, Outlines::new))
    }

    /// Reads a font with any outlines or none, to shape text. Glyphs are empty.
    ///
    /// # Errors
    /// [`Error::NotAFont`] when the bytes are not a font, [`Error::NoSuchFace`] when the file has fewer fonts, [`Error::Failed`] when a
    /// damaged font makes its reader panic.
    pub fn for_shaping(bytes: &'a [u8], index: u32) -> Result<Self, Error> {
        guarded(|| Self::read(bytes, index, |_| Ok(Outlines::default())))
    }

    fn read(
        bytes: &'a [u8],
        index: u32,
        outlines: impl FnOnce(&FontRef<'a>) -> Result<Outlines<'a>, Error>,
    ) -> Result<Self, Error> {
        let font = match FileRef::new(bytes) {
            Ok(FileRef::Font(font)) if index == 0 => font,
            Ok(FileRef::Font(_)) => return Err(Error::NoSuchFace { index, count: 1 }),
            Ok(FileRef::Collection(all)) if index < all.len() => all.get(index).map_err(|e| not_a_font(bytes, &e))?,
            Ok(FileRef::Collection(all)) => return Err(Error::NoSuchFace { index, count: all.len() }),
            Err(e) => return Err(not_a_font(bytes, &e)),
        };
        let missing = |table: &str, e: &ReadError| Error::NotAFont(format!("table {table}: {e}"));
        let units_per_em = f64::from(font.head().map_err(|e| missing("head", &e))?.units_per_em());
        // The specification allows 16 to 16384 (OpenType 1.9.1, head). Real fonts use other values, but not zero.
        if units_per_em < 1.0 {
            return Err(Error::NotAFont("the em has zero units".into()));
        }
        font.maxp().map_err(|e| missing("maxp", &e))?;
        font.hmtx().map_err(|e| missing("hmtx", &e))?;
        font.cmap().map_err(|e| missing("cmap", &e))?;
        let mut out = Self {
            data: ShaperData::new(&font),
            instance: ShaperInstance::default(),
            outlines: outlines(&font)?,
            charmap: Charmap::new(&font),
            units_per_em,
            metrics: FontMetrics::default(),
            synthesis: Synthesis::default(),
            only: None,
            font,
        };
        out.measure();
        Ok(out)
    }

    /// Returns the font at another position on its axes. Axes that are not given take their defaults.
    ///
    /// # Errors
    /// [`Error::NoSuchAxis`] when the font lacks an axis, [`Error::OutsideAxis`] when a value is out of range, [`Error::Failed`] when a
    /// damaged font makes its reader panic.
    pub fn with_variations(mut self, variations: &[Variation]) -> Result<Self, Error> {
        guarded(|| {
            let axes = self.axes();
            for v in variations {
                let tag = v.tag.to_string();
                let Some(axis) = axes.iter().find(|a| a.tag == tag) else {
                    return Err(Error::NoSuchAxis { tag, axes });
                };
                if !(axis.min..=axis.max).contains(&v.value) {
                    return Err(Error::OutsideAxis { tag, value: v.value, min: axis.min, max: axis.max });
                }
            }
            let location = self.font.axes().location(variations.iter().map(|v| (v.tag, v.value as f32)));
            self.instance = ShaperInstance::from_coords(&self.font, location.coords().iter().copied());
            self.measure();
            Ok(self)
        })
    }

    /// Restricts the font to one writing: text of other writings does not use it, and emoji prefer it to fonts without a restriction.
    #[must_use]
    pub fn only_for(mut self, writing: Writing) -> Self {
        self.only = Some(writing);
        self
    }

    /// Synthesizes a bold font: thickens the stems of every letter by a fraction of the em, and widens its advance by as much.
    #[must_use]
    pub fn emboldened(mut self, share: f64) -> Self {
        self.synthesis.bold = share;
        self
    }

    /// Synthesizes an italic font: slants every letter to the right, in degrees.
    #[must_use]
    pub fn slanted(mut self, degrees: f64) -> Self {
        self.synthesis.slant = degrees;
        self
    }

    /// Returns the design weight of the font, such as 400 for a regular and 700 for a bold one.
    #[must_use]
    pub fn weight(&self) -> f64 {
        f64::from(self.font.attributes().weight.value())
    }

    /// Returns `true` if the font is italic or oblique.
    #[must_use]
    pub fn is_italic(&self) -> bool {
        self.font.attributes().style != skrifa::attribute::Style::Normal
    }

    /// Returns the axes of a variable font; empty for other fonts.
    #[must_use]
    pub fn axes(&self) -> Vec<FontAxis> {
        let axis = |a: skrifa::Axis| FontAxis {
            tag: a.tag().to_string(),
            name: self.string(a.name_id()).unwrap_or_default(),
            min: f64::from(a.min_value()),
            default: f64::from(a.default_value()),
            max: f64::from(a.max_value()),
        };
        self.font.axes().iter().map(axis).collect()
    }

    /// Returns the full name of the font; empty if it has none.
    #[must_use]
    pub fn name(&self) -> String {
        self.string(StringId::FULL_NAME).or_else(|| self.string(StringId::FAMILY_NAME)).unwrap_or_default()
    }

    fn string(&self, id: StringId) -> Option<String> {
        self.font.localized_strings(id).english_or_first().map(|s| s.to_string())
    }

    /// Returns the number of font units per em.
    #[must_use]
    pub fn units_per_em(&self) -> f64 {
        self.units_per_em
    }

    /// Returns the heights of the font at an em of `size`.
    #[must_use]
    pub fn metrics(&self, size: f64) -> FontMetrics {
        self.metrics.scaled(size / self.units_per_em)
    }

    /// Returns `true` if the font has a glyph for a character.
    #[must_use]
    pub fn has(&self, c: char) -> bool {
        self.charmap.map(c).is_some_and(|g| g.to_u32() != 0)
    }

    pub(crate) fn location(&self) -> LocationRef<'_> {
        LocationRef::new(self.instance.coords())
    }

    /// Computes the heights in font units.
    fn measure(&mut self) {
        let m = self.font.metrics(Size::unscaled(), self.location());
        let positive = |v: Option<f32>| v.map(f64::from).filter(|v| *v > 0.0 && v.is_finite());
        let or_zero = |v: f32| if v.is_finite() { f64::from(v) } else { 0.0 };
        let ascent = or_zero(m.ascent);
        let cap_height = positive(m.cap_height).or_else(|| self.top_of('H')).unwrap_or(ascent);
        self.metrics = FontMetrics {
            ascent,
            descent: -or_zero(m.descent),
            line_gap: or_zero(m.leading).max(0.0),
            cap_height,
            x_height: positive(m.x_height).or_else(|| self.top_of('x')).unwrap_or(cap_height),
        };
    }

    /// Returns the height of a character's outline above the baseline, in font units.
    fn top_of(&self, c: char) -> Option<f64> {
        let glyph: GlyphId = self.charmap.map(c)?;
        let outline = self.outlines.draw(glyph, self.location()).ok()?;
        // Outlines have y pointing down.
        Some(-outline.bounding_box().y0).filter(|top| !outline.is_empty() && *top > 0.0)
    }
}

/// Returns the error for bytes that are not a readable font, which names kinds of fonts that people try (by their first four bytes).
fn not_a_font(bytes: &[u8], e: &ReadError) -> Error {
    Error::NotAFont(match bytes.get(..4) {
        Some(b"wOFF" | b"wOF2") => "it is a web font (WOFF); convert it to .ttf or .otf first".into(),
        Some(b"%!PS" | [0x80, 0x01, ..]) => {
            "it is a Type 1 font; only .ttf, .otf, .ttc and .otc files can be read".into()
        }
        _ => format!("{e}; only .ttf, .otf, .ttc and .otc files can be read"),
    })
}
