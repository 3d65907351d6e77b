//! Measures of fonts as browsers use them: lines at texts, and shifts of their baselines. usvg takes them from the fonts.

use skrifa::raw::TableProvider as _;
use skrifa::{FontRef, Tag};

/// The thickness of lines, in parts of the font size, and how far their middle is below the baseline: half a thickness lies between.
const THICKNESS: f64 = 0.1;
const BELOW: f64 = 0.1;
/// How far lines through letters are above the baseline, in parts of the ascent.
const THROUGH: f64 = 1.0 / 3.0;
/// How far subscripts and superscripts are shifted, in parts of the line.
const SHIFT: f64 = 0.5;

/// Changes these measures in a font file, for the face with an index.
pub(super) fn adjust(data: &mut [u8], index: u32) {
    for (at, value) in changes(data, index).unwrap_or_default() {
        if let Some(place) = data.get_mut(at..at + 2) {
            place.copy_from_slice(&value.to_be_bytes());
        }
    }
}

/// Places in the file, each with its number.
fn changes(data: &[u8], index: u32) -> Option<Vec<(usize, i16)>> {
    let font = FontRef::from_index(data, index).ok()?;
    let em = f64::from(font.head().ok()?.units_per_em());
    let hhea = font.hhea().ok()?;
    let (ascent, descent) = (f64::from(hhea.ascender().to_i16()), f64::from(hhea.descender().to_i16()));
    #[expect(clippy::cast_possible_truncation, reason = "casts saturate")]
    let rounded = |v: f64| v.round() as i16;
    let table = |tag: &[u8; 4]| {
        let records = font.table_directory().table_records();
        records.iter().find(|r| r.tag() == Tag::new(tag)).map(|r| r.offset() as usize)
    };
    let (thickness, below) = (rounded(THICKNESS * em), rounded(-BELOW * em));
    let shift = rounded(SHIFT * (ascent - descent));
    let mut out = Vec::new();
    // Fields of OpenType's tables.
    out.extend(table(b"post").into_iter().flat_map(|at| [(at + 8, below), (at + 10, thickness)]));
    out.extend(
        table(b"OS/2")
            .into_iter()
            .flat_map(|at| [(at + 16, shift), (at + 24, shift), (at + 28, rounded(THROUGH * ascent))]),
    );
    Some(out)
}
