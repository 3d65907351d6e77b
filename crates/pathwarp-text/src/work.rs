//! Measures the work of reading and drawing a glyph without doing it. A font of a few kilobytes can describe endless glyphs: parts of
//! parts, subroutines of subroutines, colours over colours.

use crate::charstrings::Charstrings;
use crate::error::guarded;
use skrifa::charmap::Charmap;
use skrifa::raw::TableProvider as _;
use skrifa::raw::tables::colr::{Colr, Paint};
use skrifa::raw::tables::glyf::{Glyf, Glyph};
use skrifa::raw::tables::loca::Loca;
use skrifa::{FontRef, GlyphId};
use std::collections::HashMap;
use std::fmt;

/// Limit on the work of one glyph, in points or bytes. Ornaments and coloured glyphs in sound fonts take far less.
pub const MAX_WORK: u64 = 200_000;

/// Limit on the nesting of parts and paints, more than programs that draw fonts follow.
const MAX_DEPTH: usize = 64;

/// Measures the glyphs of a font: points of outlines including their parts, bytes of charstrings including their subroutines, and
/// layers of colour.
pub struct GlyphWork<'a> {
    charmap: Charmap<'a>,
    glyphs: u32,
    glyf: Option<(Glyf<'a>, Loca<'a>)>,
    charstrings: Option<Charstrings<'a>>,
    colr: Option<Colr<'a>>,
    // The known work of outlines and of layers of colour by glyph, and of paints by address.
    outlines: HashMap<u32, u64>,
    coloured: HashMap<u32, u64>,
    paints: HashMap<usize, u64>,
}

impl fmt::Debug for GlyphWork<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GlyphWork").field("glyphs", &self.glyphs).finish_non_exhaustive()
    }
}

impl<'a> GlyphWork<'a> {
    /// Opens a font; `index` counts the fonts of a collection from 0. Returns `None` if it cannot be read.
    #[must_use]
    pub fn new(bytes: &'a [u8], index: u32) -> Option<Self> {
        let font = FontRef::from_index(bytes, index).ok()?;
        Some(Self {
            charmap: Charmap::new(&font),
            glyphs: font.maxp().ok()?.num_glyphs().into(),
            glyf: font.glyf().ok().zip(font.loca(None).ok()),
            charstrings: Charstrings::new(&font),
            colr: font.colr().ok(),
            outlines: HashMap::new(),
            coloured: HashMap::new(),
            paints: HashMap::new(),
        })
    }

    /// Returns the work of a letter, if the shaper does not substitute it; at most [`MAX_WORK`].
    pub fn of_letter(&mut self, letter: char) -> u64 {
        let glyph = self.charmap.map(letter).unwrap_or_default();
        guarded(|| Ok(self.glyph_work(glyph))).unwrap_or(MAX_WORK)
    }

    /// Returns the first glyph that takes [`MAX_WORK`] or more.
    pub fn endless(&mut self) -> Option<u32> {
        let found = guarded(|| Ok((0..self.glyphs).find(|g| self.glyph_work(GlyphId::new(*g)) >= MAX_WORK)));
        // A font that makes its reader panic must not be used.
        found.unwrap_or(Some(0))
    }

    /// Returns the work of a glyph, which is drawn either by its outline or by its layers of colour.
    fn glyph_work(&mut self, glyph: GlyphId) -> u64 {
        self.outline_work(glyph, 0).max(self.colour_work(glyph, 0))
    }

    fn outline_work(&mut self, glyph: GlyphId, depth: usize) -> u64 {
        if let Some(known) = self.outlines.get(&glyph.to_u32()) {
            return *known;
        }
        // A glyph that contains itself is endless.
        self.outlines.insert(glyph.to_u32(), MAX_WORK);
        let work = self.measure_outline(glyph, depth).min(MAX_WORK);
        self.outlines.insert(glyph.to_u32(), work);
        work
    }

    fn measure_outline(&mut self, glyph: GlyphId, depth: usize) -> u64 {
        if depth > MAX_DEPTH {
            return MAX_WORK;
        }
        if let Some(charstrings) = &self.charstrings {
            return charstrings.work(glyph, MAX_WORK);
        }
        let found = self.glyf.as_ref().and_then(|(glyf, loca)| loca.get_glyf(glyph, glyf).ok().flatten());
        match found {
            Some(Glyph::Simple(s)) => 1 + s.num_points() as u64,
            Some(Glyph::Composite(c)) => {
                sum(c.components(), |part| 1 + self.outline_work(GlyphId::from(part.glyph), depth + 1))
            }
            None => 1,
        }
    }

    /// Returns the work of a glyph's layers of colour, including the outlines that they fill.
    fn colour_work(&mut self, glyph: GlyphId, depth: usize) -> u64 {
        let Some(colr) = self.colr.clone() else { return 0 };
        if let Some(known) = self.coloured.get(&glyph.to_u32()) {
            return *known;
        }
        self.coloured.insert(glyph.to_u32(), MAX_WORK);
        let mut work = 0;
        if let Ok(Some((paint, _))) = colr.v1_base_glyph(glyph) {
            work = self.paint_work(&colr, &paint, depth);
        }
        if let Ok(Some(layers)) = colr.v0_base_glyph(glyph) {
            let layers = layers.map_while(|i| colr.v0_layer(i).ok());
            work += sum(layers, |(filled, _)| LAYER + self.outline_work(filled.into(), 0));
        }
        let work = work.min(MAX_WORK);
        self.coloured.insert(glyph.to_u32(), work);
        work
    }

    fn paint_work(&mut self, colr: &Colr<'a>, paint: &Paint<'a>, depth: usize) -> u64 {
        let address = paint.offset_data().as_bytes().as_ptr() as usize;
        if let Some(known) = self.paints.get(&address) {
            return *known;
        }
        if depth > MAX_DEPTH {
            return MAX_WORK;
        }
        self.paints.insert(address, MAX_WORK);
        let mut below = |p: Result<Paint<'a>, _>| p.map_or(0, |p: Paint<'a>| self.paint_work(colr, &p, depth + 1));
        let inner = match paint {
            Paint::Composite(p) => below(p.source_paint()) + below(p.backdrop_paint()),
            Paint::ColrLayers(p) => {
                let first = p.first_layer_index() as usize;
                let layers = (first..first.saturating_add(p.num_layers().into())).map_while(|i| colr.v1_layer(i).ok());
                sum(layers, |(layer, _)| below(Ok(layer)))
            }
            Paint::Glyph(p) => below(p.paint()) + self.outline_work(p.glyph_id().into(), 0),
            Paint::ColrGlyph(p) => self.colour_work(p.glyph_id().into(), depth + 1),
            other => child(other).map_or(0, |p| below(Ok(p))),
        };
        let work = (LAYER + inner).min(MAX_WORK);
        self.paints.insert(address, work);
        work
    }
}

/// Work of a layer of colour, in points. The layer becomes an element of the drawing, which costs about as much as this many points.
const LAYER: u64 = 20;

/// Adds up work, stopping at the limit.
fn sum<T>(items: impl Iterator<Item = T>, mut work: impl FnMut(T) -> u64) -> u64 {
    let mut total = 0;
    for item in items {
        total += work(item);
        if total >= MAX_WORK {
            break;
        }
    }
    total
}

/// Returns the paint that another one transforms; `None` for paints that fill.
fn child<'a>(paint: &Paint<'a>) -> Option<Paint<'a>> {
    let found = match paint {
        Paint::Transform(p) => p.paint(),
        Paint::VarTransform(p) => p.paint(),
        Paint::Translate(p) => p.paint(),
        Paint::VarTranslate(p) => p.paint(),
        Paint::Scale(p) => p.paint(),
        Paint::VarScale(p) => p.paint(),
        Paint::ScaleAroundCenter(p) => p.paint(),
        Paint::VarScaleAroundCenter(p) => p.paint(),
        Paint::ScaleUniform(p) => p.paint(),
        Paint::VarScaleUniform(p) => p.paint(),
        Paint::ScaleUniformAroundCenter(p) => p.paint(),
        Paint::VarScaleUniformAroundCenter(p) => p.paint(),
        Paint::Rotate(p) => p.paint(),
        Paint::VarRotate(p) => p.paint(),
        Paint::RotateAroundCenter(p) => p.paint(),
        Paint::VarRotateAroundCenter(p) => p.paint(),
        Paint::Skew(p) => p.paint(),
        Paint::VarSkew(p) => p.paint(),
        Paint::SkewAroundCenter(p) => p.paint(),
        Paint::VarSkewAroundCenter(p) => p.paint(),
        _ => return None,
    };
    found.ok()
}
