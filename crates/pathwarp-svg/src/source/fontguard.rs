//! Fonts that a drawing brings along, or that come from given files: their collections are checked before they are loaded, and their
//! glyphs when the first letter asks for them. Installed fonts and the bundled one are not checked. Guards skrifa 0.44
//! (<https://github.com/googlefonts/fontations>), which draws glyphs of glyphs without an end, and fontdb 0.24, which lists whatever a collection
//! announces: what a later version refuses by itself can be deleted.

use super::faces::BUNDLED;
use super::images::{self, Rejected};
use super::read::ReadOptions;
use pathwarp::Error;
use pathwarp_text::{GlyphWork, MOST_WORK};
use skrifa::FontRef;
use skrifa::raw::{FileRef, TableProvider as _};
use std::collections::{BTreeSet, HashMap};
use std::sync::{Arc, Mutex, PoisonError};
use usvg::fontdb::{Database, ID, Source};

/// What the faces of a font file take to be listed, in bytes: they may be thousands that share one long list of names.
pub(super) fn listing(data: &[u8], most: u64) -> u64 {
    /// A face without names.
    const FACE: u64 = 1000;
    let names = |font: &FontRef<'_>| {
        let Ok(names) = font.name() else { return 0 };
        names.name_record().iter().map(|r| u64::from(r.length())).sum()
    };
    let announced = data.get(8..12).and_then(|n| n.try_into().ok()).map_or(0, u32::from_be_bytes);
    if data.starts_with(b"ttcf") && announced as usize > data.len() / size_of::<u32>() {
        return u64::MAX;
    }
    let Ok(FileRef::Collection(all)) = FileRef::new(data) else { return 0 };
    let mut total = 0;
    for index in 0..all.len() {
        total += FACE + all.get(index).map_or(0, |font| names(&font));
        if total > most {
            break;
        }
    }
    total
}

/// Checks faces before they are used.
pub(super) struct FontGuard {
    options: ReadOptions,
    rejected: Rejected,
    known: Mutex<HashMap<ID, bool>>,
}

impl FontGuard {
    pub(super) fn new(options: &ReadOptions, rejected: &Rejected) -> Self {
        Self { options: options.clone(), rejected: rejected.clone(), known: Mutex::default() }
    }

    /// The face has been found good under another number.
    pub(super) fn trust(&self, face: ID) {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(face, true);
    }

    /// Returns `true` if a face may be used. Else it is the error of the drawing.
    pub(super) fn admits(&self, face: ID, db: &Database) -> bool {
        if let Some(known) = self.known.lock().unwrap_or_else(PoisonError::into_inner).get(&face) {
            return *known;
        }
        let Some(info) = db.face(face) else { return true };
        let is_given = match &info.source {
            Source::File(path) => self.options.fonts.iter().any(|given| path.starts_with(given)),
            _ => true,
        };
        let name = || info.families.first().map_or("", |(name, _)| name.as_str());
        let found = if is_given {
            db.with_face_data(face, |data, index| self.checked(data, index, name())).unwrap_or(Ok(()))
        } else {
            Ok(())
        };
        let is_good = found.is_ok();
        if let (Err(e), Ok(mut r)) = (found, self.rejected.lock()) {
            r.get_or_insert(e);
        }
        self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(face, is_good);
        is_good
    }

    fn checked(&self, data: &[u8], index: u32, name: &str) -> Result<(), Error> {
        if data == BUNDLED {
            return Ok(());
        }
        let place = format!("the font {name}");
        if let Some(glyph) = GlyphWork::new(data, index).and_then(|mut all| all.endless()) {
            let problem = format!("glyph {glyph} takes {MOST_WORK} points or more, with all of its parts and layers");
            return Err(Error::input(place, problem + "; use another font"));
        }
        // Glyphs may be drawings themselves.
        let Some(svg) = FontRef::from_index(data, index).ok().and_then(|f| f.svg().ok()) else { return Ok(()) };
        let Ok(list) = svg.svg_document_list() else { return Ok(()) };
        let options = self.options.begin(data.len());
        let records = list.document_records().iter();
        let spans: BTreeSet<_> = records.map(|r| (r.svg_doc_offset(), r.svg_doc_length())).collect();
        for (start, length) in spans {
            let end = u64::from(start) + u64::from(length);
            let drawing = list.offset_data().as_bytes().get(start as usize..end as usize);
            if let Some(drawing) = drawing {
                images::checked(images::SVG, Arc::new(drawing.to_vec()), &place, &options)?;
            }
        }
        Ok(())
    }
}
