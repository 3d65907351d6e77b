//! Fonts for text: installed ones if wanted, given files, and a bundled fallback.

use super::faces::{BUNDLED, BUNDLED_FAMILY, GenericFamilies, Look, asked_for, of_interface};
use super::fontguard::{FontGuard, listing};
use super::images::Missing;
use super::metrics;
use skrifa::{FontRef, MetadataProvider as _};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;
use std::io::Read as _;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use usvg::fontdb::{self, Database, ID, Source};
use usvg::{FontFamily, FontResolver};

/// The given files and folders whose fonts were loaded last: a batch reads them once.
type Loaded = (bool, Vec<PathBuf>, Arc<Database>);

/// Loads the fonts. The installed ones are read once per process.
pub(crate) fn database(system: bool, paths: &[PathBuf]) -> Arc<Database> {
    static SYSTEM: OnceLock<Arc<Database>> = OnceLock::new();
    static BARE: OnceLock<Arc<Database>> = OnceLock::new();
    let load = |system| {
        let mut db = Database::new();
        if system {
            db.load_system_fonts();
        }
        db.load_font_data(BUNDLED.to_vec());
        Arc::new(db)
    };
    let base = if system { SYSTEM.get_or_init(|| load(true)) } else { BARE.get_or_init(|| load(false)) };
    static LAST: Mutex<Option<Loaded>> = Mutex::new(None);
    if paths.is_empty() {
        return base.clone();
    }
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((of_system, of, db)) = &*last
        && (*of_system, of.as_slice()) == (system, paths)
    {
        return db.clone();
    }
    let mut db = base.clone();
    for p in paths {
        let db = Arc::make_mut(&mut db);
        if p.is_dir() {
            db.load_fonts_dir(p);
        } else {
            // A file that is not a font leaves the database unchanged; its family is then reported as missing.
            let _ = load_file(db, p);
        }
    }
    *last = Some((system, paths.to_vec(), db.clone()));
    db
}

/// Loads a font file.
pub(super) fn load_file(db: &mut Database, path: &Path) -> Result<(), String> {
    /// Far more than the collections of any maker.
    const MOST: u64 = 32_000_000;
    let unreadable = |e: std::io::Error| format!("cannot be read: {e}");
    let is_collection = |file: &Path| -> std::io::Result<bool> {
        let mut tag = Vec::new();
        fs::File::open(file)?.take(4).read_to_end(&mut tag)?;
        Ok(tag == b"ttcf")
    };
    if is_collection(path).map_err(unreadable)? && listing(&fs::read(path).map_err(unreadable)?, MOST) > MOST {
        return Err("has more fonts, or longer names, than can be listed".into());
    }
    let before = db.len();
    db.load_font_file(path).map_err(unreadable)?;
    if db.len() == before && !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ttc")) {
        let data = fs::read(path).map_err(unreadable)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let _ = load_unnamed(db, &(Arc::new(data) as Bytes), name);
    }
    Ok(())
}

/// Loads a font without names, as subsets are, by a name from elsewhere. `None` for what is no font.
pub(super) fn load_unnamed(db: &mut Database, data: &Bytes, family: String) -> Option<ID> {
    let font = FontRef::new(data.as_ref().as_ref()).ok()?;
    let about = font.attributes();
    let style = match about.style {
        skrifa::attribute::Style::Normal => fontdb::Style::Normal,
        skrifa::attribute::Style::Italic => fontdb::Style::Italic,
        skrifa::attribute::Style::Oblique(_) => fontdb::Style::Oblique,
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 1000")]
    let weight = fontdb::Weight(about.weight.value().clamp(1.0, 1000.0) as u16);
    font.charmap().mappings().next()?;
    Some(db.push_face_info(fontdb::FaceInfo {
        id: ID::dummy(),
        source: Source::Binary(data.clone()),
        index: 0,
        families: vec![(family.clone(), fontdb::Language::English_UnitedStates)],
        post_script_name: family,
        style,
        weight,
        stretch: fontdb::Stretch::Normal,
        monospaced: false,
    }))
}

/// Finds fonts like usvg's own resolver, but always returns one, and records the families that were not found.
pub(super) fn resolver(generic: GenericFamilies, missing: Missing, guard: FontGuard) -> FontResolver<'static> {
    let held = Arc::new((Held::default(), guard));
    let also_held = held.clone();
    let absent = Mutex::default();
    let admitted = |(held, guard): &(Held, FontGuard), face: ID, db: &mut Arc<Database>| {
        let face = guard.admits(face, db).then(|| held.face(face, db))?;
        guard.trust(face);
        Some(face)
    };
    FontResolver {
        select_font: Box::new(move |font, db| {
            let face = select(font, db, &generic, &missing)?;
            admitted(&held, face, db)
        }),
        select_fallback: Box::new(move |c, used, db| {
            let face = fallback(c, used, db, &absent)?;
            let face = admitted(&also_held, face, db)?;
            (!used.contains(&face)).then_some(face)
        }),
    }
}

/// The font for a letter that the fonts `used` so far lack: one that looks like the first of them, if there is one. usvg's own choice
/// may be bold in a text that is not. `absent` are the letters that no font has: there may be hundreds of fonts to ask.
fn fallback(letter: char, used: &[ID], db: &Database, absent: &Mutex<HashSet<char>>) -> Option<ID> {
    let mut absent = absent.lock().unwrap_or_else(PoisonError::into_inner);
    if absent.contains(&letter) {
        return None;
    }
    let first = db.face(*used.first()?)?;
    let off = |f: &fontdb::FaceInfo| {
        (f.style != first.style, f.stretch != first.stretch, f.weight.0.abs_diff(first.weight.0))
    };
    let mut others: Vec<_> = db.faces().filter(|f| !used.contains(&f.id)).map(|f| (off(f), f.id)).collect();
    // The sort is stable: of equals, the first counts.
    others.sort_by_key(|(off, _)| *off);
    let found = others.into_iter().map(|(_, id)| id).find(|id| has_letter(*id, letter, db));
    if found.is_none() && !used.iter().any(|id| has_letter(*id, letter, db)) {
        absent.insert(letter);
    }
    found
}

/// Ranges of the letters that a font has, in order.
type Letters = Vec<RangeInclusive<u32>>;

fn has_letter(face: ID, letter: char, db: &Database) -> bool {
    let asked = |data: &[u8], index: u32| Some(FontRef::from_index(data, index).ok()?.charmap().map(letter).is_some());
    match db.face(face).map(|f| (&f.source, f.index)) {
        Some((Source::File(path), index)) => {
            let letters = letters_of(path, index, || db.with_face_data(face, letters_in).unwrap_or_default());
            let (letter, after) = (u32::from(letter), letters.partition_point(|r| *r.start() <= u32::from(letter)));
            after > 0 && letters[after - 1].contains(&letter)
        }
        _ => db.with_face_data(face, asked).flatten().unwrap_or(false),
    }
}

/// What `read` finds in a font file: a drawing may ask all fonts for thousands of letters, and opening a file takes longer than asking.
fn letters_of(path: &Path, index: u32, read: impl FnOnce() -> Letters) -> Arc<Letters> {
    static KNOWN: Mutex<BTreeMap<(PathBuf, u32), Arc<Letters>>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry((path.to_owned(), index)).or_insert_with(|| Arc::new(read())).clone()
}

fn letters_in(data: &[u8], index: u32) -> Letters {
    let Ok(font) = FontRef::from_index(data, index) else { return Letters::new() };
    let mut all: Vec<u32> = font.charmap().mappings().map(|(letter, _)| letter).collect();
    all.sort_unstable();
    let mut out = Letters::new();
    for letter in all {
        match out.last_mut() {
            Some(last) if letter <= last.end() + 1 => *last = *last.start()..=letter,
            _ => out.push(letter..=letter),
        }
    }
    out
}

/// Bytes of a font.
type Bytes = Arc<dyn AsRef<[u8]> + Send + Sync>;

/// Font files in memory, with their faces in the database that was used last; pictures have databases besides the drawing's. From a file,
/// usvg would read each letter up to four times.
#[derive(Default)]
struct Held(Mutex<HashMap<PathBuf, (Bytes, Vec<ID>)>>);

impl Held {
    /// The face in memory, or the given one if it cannot be read.
    fn face(&self, id: ID, db: &mut Arc<Database>) -> ID {
        let Some((Source::File(path), index)) = db.face(id).map(|f| (f.source.clone(), f.index)) else { return id };
        let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !files.contains_key(&path) {
            let Ok(mut data) = fs::read(&path) else { return id };
            metrics::adjust(&mut data, index);
            files.insert(path.clone(), (Arc::new(data), Vec::new()));
        }
        let Some((data, faces)) = files.get_mut(&path) else { return id };
        let of_data = |db: &Database, id: ID| match db.face(id) {
            Some(f) if f.index == index => matches!(&f.source, Source::Binary(d) if Arc::ptr_eq(d, data)),
            _ => false,
        };
        if !faces.iter().any(|f| of_data(db, *f)) {
            *faces = Arc::make_mut(db).load_font_source(Source::Binary(data.clone())).to_vec();
        }
        faces.iter().copied().find(|f| of_data(db, *f)).unwrap_or(id)
    }
}

/// Stands for the family of text that asks for none.
pub(super) const NO_FAMILY: &str = "a family";

/// The face for a font of the drawing.
fn select(font: &usvg::Font, db: &Database, generic: &GenericFamilies, missing: &Missing) -> Option<ID> {
    let style = match font.style() {
        usvg::FontStyle::Normal => fontdb::Style::Normal,
        usvg::FontStyle::Italic => fontdb::Style::Italic,
        usvg::FontStyle::Oblique => fontdb::Style::Oblique,
    };
    let look = Look { weight: fontdb::Weight(font.weight()), stretch: stretch(font.stretch()), style };
    let query = |family: &str| look.face_of(family, db);
    let (mut absent, mut similar) = (Vec::new(), None);
    for family in font.families() {
        let found = match family {
            FontFamily::Named(name) => match of_interface(name) {
                Some(kind) => look.face_of_kind(&kind, generic, db),
                None => query(name).or_else(|| look.face_called(name, db)),
            },
            other => look.face_of_kind(other, generic, db),
        };
        if found.is_some() {
            return found;
        }
        let Some(name) = asked_for(family, generic).filter(|name| *name != NO_FAMILY) else { continue };
        absent.push(name.clone());
        similar = look.face_with_metrics_of(name, db);
        if similar.is_some() {
            break;
        }
    }
    if let Ok(mut m) = missing.lock() {
        m.extend(absent.iter().cloned());
    }
    let last = similar.or_else(|| look.face_like(&absent, generic, db));
    let last = last.or_else(|| look.standard_face(generic, db));
    last.or_else(|| query(BUNDLED_FAMILY)).or_else(|| db.faces().next().map(|f| f.id))
}

fn stretch(s: usvg::FontStretch) -> fontdb::Stretch {
    use fontdb::Stretch as D;
    use usvg::FontStretch as S;
    match s {
        S::UltraCondensed => D::UltraCondensed,
        S::ExtraCondensed => D::ExtraCondensed,
        S::Condensed => D::Condensed,
        S::SemiCondensed => D::SemiCondensed,
        S::Normal => D::Normal,
        S::SemiExpanded => D::SemiExpanded,
        S::Expanded => D::Expanded,
        S::ExtraExpanded => D::ExtraExpanded,
        S::UltraExpanded => D::UltraExpanded,
    }
}
