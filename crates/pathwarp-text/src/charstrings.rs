//! Measures the work of the charstrings of CFF and CFF2 fonts, the programs that draw glyphs. Subroutines that call others a hundred
//! times, ten levels deep, would occupy the reader forever.

use skrifa::raw::TableProvider as _;
use skrifa::raw::ps::cff::CffFontRef;
use skrifa::raw::ps::cff::blend::BlendState;
use skrifa::raw::ps::cff::index::Index;
use skrifa::raw::ps::cs::{CharstringContext, CharstringKind, CommandSink, evaluate};
use skrifa::raw::ps::error::Error;
use skrifa::raw::types::Fixed;
use skrifa::{FontRef, GlyphId};
use std::cell::Cell;

/// The charstrings of a font.
#[derive(Clone)]
pub(crate) struct Charstrings<'a>(CffFontRef<'a>);

impl<'a> Charstrings<'a> {
    /// Returns `None` if the font has no charstrings.
    pub(crate) fn new(font: &FontRef<'a>) -> Option<Self> {
        let cff = || CffFontRef::new_cff(font.cff().ok()?.offset_data().as_bytes(), 0, None).ok();
        let cff2 = || CffFontRef::new_cff2(font.cff2().ok()?.offset_data().as_bytes(), None).ok();
        cff2().or_else(cff).map(Self)
    }

    /// Returns the number of bytes that the reader evaluates for a glyph, counting subroutines at each call. Stops counting at `max`.
    pub(crate) fn work(&self, glyph: GlyphId, max: u64) -> u64 {
        let used = Cell::new(0);
        // A damaged charstring counts up to the damage.
        let _ = self.evaluate_counting(glyph, max, &used);
        used.get()
    }

    fn evaluate_counting(&self, glyph: GlyphId, max: u64, used: &Cell<u64>) -> Result<(), Error> {
        let Self(font) = self;
        let subfont = font.subfont(font.subfont_index(glyph).ok_or(Error::MissingFdArray)?, &[])?;
        let local = match subfont.subrs_offset() {
            0 => Index::Empty,
            offset => {
                let data = font.data().get(offset as usize..).ok_or(Error::MissingSubroutines)?;
                Index::new(data, font.version() == 2)?
            }
        };
        let blend = font.var_store().and_then(|s| BlendState::new(s.clone(), &[], subfont.vs_index()).ok());
        let all = font.charstrings();
        let context = Counting { inner: (font.data(), all, font.global_subrs(), &local), used, max };
        let charstring = context.counted(all.get(glyph.to_u32() as usize)?)?;
        evaluate(&context, blend, charstring, &mut NullSink)?;
        Ok(())
    }
}

/// Counts the charstrings that the evaluator looks up.
struct Counting<'a> {
    /// The table's bytes, the charstrings, and the global and the local subroutines: skrifa's context that does not count.
    inner: (&'a [u8], &'a Index<'a>, &'a Index<'a>, &'a Index<'a>),
    used: &'a Cell<u64>,
    max: u64,
}

impl Counting<'_> {
    /// Counts the bytes of a charstring, and 1 for the call. Any error stops the evaluator at the limit.
    fn counted<'b>(&self, charstring: &'b [u8]) -> Result<&'b [u8], Error> {
        self.used.set(self.used.get() + 1 + charstring.len() as u64);
        if self.used.get() < self.max { Ok(charstring) } else { Err(Error::CharstringNestingDepthLimitExceeded) }
    }
}

impl CharstringContext for Counting<'_> {
    fn kind(&self) -> CharstringKind {
        CharstringKind::Type2
    }

    fn seac_components(&self, base: i32, accent: i32) -> Result<[&[u8]; 2], Error> {
        let [base, accent] = self.inner.seac_components(base, accent)?;
        Ok([self.counted(base)?, self.counted(accent)?])
    }

    fn global_subr(&self, index: i32) -> Result<&[u8], Error> {
        self.counted(self.inner.global_subr(index)?)
    }

    fn subr(&self, index: i32) -> Result<&[u8], Error> {
        self.counted(self.inner.subr(index)?)
    }
}

/// Discards an outline.
struct NullSink;

impl CommandSink for NullSink {
    fn move_to(&mut self, _: Fixed, _: Fixed) {}

    fn line_to(&mut self, _: Fixed, _: Fixed) {}

    fn curve_to(&mut self, _: Fixed, _: Fixed, _: Fixed, _: Fixed, _: Fixed, _: Fixed) {}

    fn close(&mut self) {}
}
