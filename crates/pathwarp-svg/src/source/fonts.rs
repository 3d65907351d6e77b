//! Finds fonts for text: among installed ones on request, given files, and a bundled fallback.

use super::faces::{
    BUNDLED, BUNDLED_FAMILY, DISPLAY, DISPLAY_FAMILY, GenericFamilies, Look, configured_name, of_interface,
};
use super::fallback::{Wanted, fallback};
use super::images::{self, Missing, Rejected};
use super::read::ReadOptions;
use pathwarp::Error;
use pathwarp_text::{GlyphWork, MAX_WORK, runs};
use skrifa::raw::{FileRef, TableProvider as _};
use skrifa::{FontRef, MetadataProvider as _, Tag};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use usvg::fontdb::{self, Database, ID, Source};
use usvg::{FontFamily, FontResolver};

/// The arguments of the last call of [`database`] with its fonts, so that a batch reads them once.
type Loaded = (bool, Vec<PathBuf>, Arc<Database>);

/// Loads the bundled fonts, the files and folders at `paths`, and, if `system` is `true`, the installed fonts, which are read once per
/// process.
pub(crate) fn database(system: bool, paths: &[PathBuf]) -> Arc<Database> {
    static SYSTEM: OnceLock<Arc<Database>> = OnceLock::new();
    static BARE: OnceLock<Arc<Database>> = OnceLock::new();
    let load = |system| {
        let mut db = Database::new();
        if system {
            db.load_system_fonts();
        }
        db.load_font_data(BUNDLED.to_vec());
        load_unnamed(&mut db, &(Arc::new(DISPLAY) as Bytes), DISPLAY_FAMILY.to_owned());
        Arc::new(db)
    };
    let base = if system { SYSTEM.get_or_init(|| load(true)) } else { BARE.get_or_init(|| load(false)) };
    static LAST: Mutex<Option<Loaded>> = Mutex::new(None);
    if paths.is_empty() {
        return base.clone();
    }
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((known_system, known_paths, db)) = &*last
        && (*known_system, known_paths.as_slice()) == (system, paths)
    {
        return db.clone();
    }
    let mut db = base.clone();
    for path in paths {
        // A file that is not a font leaves the database unchanged; its family is then reported as missing.
        let _ = load_fonts(Arc::make_mut(&mut db), path);
    }
    *last = Some((system, paths.to_vec(), db.clone()));
    db
}

/// Loads a font file, or the font files in a folder.
fn load_fonts(db: &mut Database, path: &Path) -> Result<(), String> {
    /// Limit on the bytes of memory for listing a collection, far above that of real ones.
    const MAX_LISTING: u64 = 32_000_000;
    let unreadable = |e: std::io::Error| format!("cannot be read: {e}");
    let is_collection = || -> std::io::Result<bool> {
        let mut tag = Vec::new();
        fs::File::open(path)?.take(4).read_to_end(&mut tag)?;
        Ok(tag == b"ttcf")
    };
    if path.is_dir() {
        db.load_fonts_dir(path);
        return Ok(());
    }
    if is_collection().map_err(unreadable)?
        && size_of_listing(&fs::read(path).map_err(unreadable)?, MAX_LISTING) > MAX_LISTING
    {
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

/// Loads a font without names, as subsets often are, under the name `family`. Returns `None` if it is not a font.
pub(super) fn load_unnamed(db: &mut Database, data: &Bytes, family: String) -> Option<ID> {
    let font = FontRef::new(data.as_ref().as_ref()).ok()?;
    let attributes = font.attributes();
    let style = match attributes.style {
        skrifa::attribute::Style::Normal => fontdb::Style::Normal,
        skrifa::attribute::Style::Italic => fontdb::Style::Italic,
        skrifa::attribute::Style::Oblique(_) => fontdb::Style::Oblique,
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 1000")]
    let weight = fontdb::Weight(attributes.weight.value().clamp(1.0, 1000.0) as u16);
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

/// Chooses fonts for a drawing's texts.
pub(super) struct Chooser {
    generic: GenericFamilies,
    missing: Missing,
    guard: FontGuard,
    held: Held,
    /// Letters that are in no other font than the ones used so far, since a search may take hundreds of fonts.
    absent: Mutex<HashSet<(String, Vec<ID>)>>,
}

/// The start of the family names of pieces of text, before the number of the piece.
pub(super) const PIECE: &str = "pathwarp-piece-";

/// The fonts of a piece of text: first for the heights, then for the letters.
pub(super) type PieceFonts = (ID, ID);

impl Chooser {
    pub(super) fn new(generic: GenericFamilies, missing: Missing, guard: FontGuard) -> Arc<Self> {
        Arc::new(Self { generic, missing, guard, held: Held::default(), absent: Mutex::default() })
    }

    /// A font resolver that, unlike usvg's, always finds a font, and records missing families. `pieces` are the fonts for the families that
    /// begin with [`PIECE`].
    pub(super) fn resolver(self: &Arc<Self>, pieces: Vec<PieceFonts>) -> FontResolver<'static> {
        let (chooser, fallback_chooser) = (self.clone(), self.clone());
        let piece_fonts: HashMap<ID, ID> = pieces.iter().copied().collect();
        FontResolver {
            select_font: Box::new(move |font, db| {
                let piece = match font.families() {
                    [FontFamily::Named(name)] => name.strip_prefix(PIECE).and_then(|n| n.parse::<usize>().ok()),
                    _ => None,
                };
                piece.and_then(|n| Some(pieces.get(n)?.0)).or_else(|| chooser.first(font, db))
            }),
            select_fallback: Box::new(move |c, used, db| {
                if let Some(face) = used.first().and_then(|first| piece_fonts.get(first)) {
                    return (!used.contains(face)).then_some(*face);
                }
                let letter = c.to_string();
                let writing = runs(&letter).first()?.writing;
                let look = Look::of_face(db.face(*used.first()?)?);
                fallback_chooser.fallback(&Wanted { letters: &letter, writing, language: "", look }, used, db)
            }),
        }
    }

    /// The first font of a text.
    fn first(&self, font: &usvg::Font, db: &mut Arc<Database>) -> Option<ID> {
        let face = find_face(font, db, &self.generic, &self.missing)?;
        self.admitted(face, db)
    }

    /// The fonts for a text: its first font, the others that it names, in order, and Chromium's standard font.
    pub(super) fn candidates(&self, font: &usvg::Font, db: &mut Arc<Database>) -> Vec<ID> {
        let look = Look::of_text(font);
        let found = font.families().iter().filter_map(|f| face_of_family(f, look, &self.generic, db));
        let found: Vec<ID> = found.chain(look.standard_face(&self.generic, db)).collect();
        let mut all: Vec<ID> = self.first(font, db).into_iter().collect();
        for face in found {
            all.extend(self.admitted(face, db).filter(|f| !all.contains(f)));
        }
        all
    }

    /// The font for letters that the fonts used so far lack.
    pub(super) fn fallback(&self, wanted: &Wanted<'_>, used: &[ID], db: &mut Arc<Database>) -> Option<ID> {
        let key = (wanted.letters.to_owned(), used.to_vec());
        let mut absent = self.absent.lock().unwrap_or_else(PoisonError::into_inner);
        if absent.contains(&key) {
            return None;
        }
        let Some(face) = fallback(wanted, used, db) else {
            absent.insert(key);
            return None;
        };
        self.admitted(face, db).filter(|f| !used.contains(f))
    }

    /// A face held in memory, if it may be used.
    fn admitted(&self, face: ID, db: &mut Arc<Database>) -> Option<ID> {
        let held = self.guard.admits(face, db).then(|| self.held.face(face, db))?;
        self.guard.trust(held);
        Some(held)
    }
}

/// Content of a font file, as fontdb holds it.
pub(super) type Bytes = Arc<dyn AsRef<[u8]> + Send + Sync>;

/// Font files held in memory, since usvg would read a file up to four times for each letter. Each has its faces in the database
/// used last, as pictures have other databases than the drawing.
#[derive(Default)]
struct Held(Mutex<HashMap<PathBuf, (Bytes, Vec<ID>)>>);

impl Held {
    /// Replaces a face by one in memory. Returns the given face if its file cannot be read.
    fn face(&self, id: ID, db: &mut Arc<Database>) -> ID {
        let Some((Source::File(path), index)) = db.face(id).map(|f| (f.source.clone(), f.index)) else { return id };
        let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !files.contains_key(&path) {
            let Ok(mut data) = fs::read(&path) else { return id };
            set_browser_metrics(&mut data, index);
            files.insert(path.clone(), (Arc::new(data), Vec::new()));
        }
        let Some((data, faces)) = files.get_mut(&path) else { return id };
        let is_held = |db: &Database, id: ID| match db.face(id) {
            Some(f) if f.index == index => matches!(&f.source, Source::Binary(d) if Arc::ptr_eq(d, data)),
            _ => false,
        };
        if !faces.iter().any(|f| is_held(db, *f)) {
            *faces = Arc::make_mut(db).load_font_source(Source::Binary(data.clone())).to_vec();
        }
        faces.iter().copied().find(|f| is_held(db, *f)).unwrap_or(id)
    }
}

/// The family that text without one is given, which no font has.
pub(super) const NO_FAMILY: &str = "a family";

/// Finds the face for a font of the drawing, and records its missing families.
fn find_face(font: &usvg::Font, db: &Database, generic: &GenericFamilies, missing: &Missing) -> Option<ID> {
    let look = Look::of_text(font);
    let (mut absent, mut similar) = (Vec::new(), None);
    for family in font.families() {
        let found = face_of_family(family, look, generic, db);
        if found.is_some() {
            return found;
        }
        let Some(name) = configured_name(family, generic).filter(|name| *name != NO_FAMILY) else { continue };
        absent.push(name.clone());
        similar = look.face_with_metrics_of(name, db);
        if similar.is_some() {
            break;
        }
    }
    if let Ok(mut missing) = missing.lock() {
        missing.extend(absent.iter().cloned());
    }
    let found = similar.or_else(|| look.face_like(&absent, generic, db)).or_else(|| look.standard_face(generic, db));
    found.or_else(|| look.face_of(BUNDLED_FAMILY, db)).or_else(|| db.faces().next().map(|f| f.id))
}

/// The face of a family, given by any of its names or as a generic family.
fn face_of_family(family: &FontFamily, look: Look, generic: &GenericFamilies, db: &Database) -> Option<ID> {
    match family {
        FontFamily::Named(name) => match of_interface(name) {
            Some(kind) => look.face_of_kind(&kind, generic, db),
            None => look.face_of(name, db).or_else(|| look.face_called(name, db)),
        },
        other => look.face_of_kind(other, generic, db),
    }
}

/// A font file's content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FontFile {
    /// Bytes of the file.
    pub bytes: Vec<u8>,
    /// Index of the font in the file, from 0.
    pub index: u32,
}

/// Finds the installed or bundled font of a family that is nearest to `weight` (100 to 900; 400 is regular). `family` may be
/// a generic family of CSS. `read` determines the available fonts.
///
/// # Errors
/// [`Error::Usage`] with similar names if there is no such family.
pub fn find_font(family: &str, weight: u16, italic: bool, read: &ReadOptions) -> Result<FontFile, Error> {
    let db = database(read.system_fonts, &read.fonts);
    let look = Look::new(weight, italic);
    let generic = match family.to_ascii_lowercase().as_str() {
        "serif" => Some(FontFamily::Serif),
        "sans-serif" => Some(FontFamily::SansSerif),
        "cursive" => Some(FontFamily::Cursive),
        "fantasy" => Some(FontFamily::Fantasy),
        "monospace" => Some(FontFamily::Monospace),
        _ => None,
    };
    let found = match generic {
        Some(kind) => look.face_of_kind(&kind, &read.generic_families, &db),
        None => look.face_of(family, &db).or_else(|| look.face_called(family, &db)),
    };
    let file = found.and_then(|id| db.with_face_data(id, |bytes, index| FontFile { bytes: bytes.to_vec(), index }));
    file.ok_or_else(|| {
        Error::usage("font", family, format!("is neither a file nor an installed family; {}", similar(family, &db)))
    })
}

/// The families of the available fonts, in alphabetical order.
#[must_use]
pub fn families(read: &ReadOptions) -> Vec<String> {
    let db = database(read.system_fonts, &read.fonts);
    let names = db.faces().filter_map(|f| f.families.first()).map(|(name, _)| name.clone());
    names.filter(|name| !name.starts_with('.')).collect::<BTreeSet<_>>().into_iter().collect()
}

/// The fonts of a family: their weight, and `true` for italic and oblique fonts; sorted, without repetitions.
#[must_use]
pub fn family_styles(family: &str, read: &ReadOptions) -> Vec<(u16, bool)> {
    let db = database(read.system_fonts, &read.fonts);
    let of_family = |f: &&fontdb::FaceInfo| f.families.iter().any(|(n, _)| n.eq_ignore_ascii_case(family));
    let styles = db.faces().filter(of_family).map(|f| (f.weight.0, f.style != fontdb::Style::Normal));
    styles.collect::<BTreeSet<_>>().into_iter().collect()
}

/// Checks that every file is a font, and that every folder holds one.
///
/// # Errors
/// [`Error::Input`] with the name of the first file that is none, or folder that holds none.
pub fn check_fonts(paths: &[PathBuf]) -> Result<(), Error> {
    for path in paths {
        let name = path.display().to_string();
        let mut db = Database::new();
        load_fonts(&mut db, path).map_err(|problem| Error::input(&name, problem))?;
        if db.is_empty() {
            return Err(Error::input(&name, if path.is_dir() { "holds no font" } else { "is not a font" }));
        }
    }
    Ok(())
}

/// Lists families with names similar to `family`: each word of `family` resembles a word of the name.
fn similar(family: &str, db: &Database) -> String {
    /// Least Jaro–Winkler similarity (1 is equal) of similar words, which differ by a letter or two. Unrelated words rarely reach it.
    const ALIKE: f64 = 0.85;
    const MAX_SUGGESTIONS: usize = 6;
    let wanted: Vec<String> = family.split_whitespace().map(str::to_lowercase).collect();
    let similarity = |name: &str| {
        let name = name.to_lowercase();
        let best = |w: &String| name.split_whitespace().map(|n| strsim::jaro_winkler(w, n)).fold(0.0, f64::max);
        wanted.iter().map(best).sum::<f64>() / wanted.len().max(1) as f64
    };
    let mut names: Vec<&str> = db.faces().flat_map(|f| &f.families).map(|(n, _)| n.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let mut names: Vec<(f64, &str)> =
        names.into_iter().map(|n| (similarity(n), n)).filter(|(s, _)| *s >= ALIKE).collect();
    names.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.len().cmp(&b.1.len())).then(a.1.cmp(b.1)));
    if names.is_empty() {
        return format!("the bundled families are {BUNDLED_FAMILY} and {DISPLAY_FAMILY}");
    }
    let names: Vec<&str> = names.iter().take(MAX_SUGGESTIONS).map(|(_, n)| *n).collect();
    format!("similar families: {}", names.join(", "))
}

/// The memory needed to list the faces of a font file, in bytes. Counts no further than `max`. A file may have thousands of faces
/// that share one long list of names.
pub(super) fn size_of_listing(data: &[u8], max: u64) -> u64 {
    /// Bytes of a face without names.
    const FACE: u64 = 1000;
    let size_of_names =
        |font: FontRef<'_>| font.name().map_or(0, |n| n.name_record().iter().map(|r| u64::from(r.length())).sum());
    let announced = data.get(8..12).and_then(|n| n.try_into().ok()).map_or(0, u32::from_be_bytes);
    if data.starts_with(b"ttcf") && announced as usize > data.len() / size_of::<u32>() {
        return u64::MAX;
    }
    let Ok(FileRef::Collection(all)) = FileRef::new(data) else { return 0 };
    let mut total = 0;
    for index in 0..all.len() {
        total += FACE + all.get(index).map_or(0, size_of_names);
        if total > max {
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

    /// Marks a face that was checked under another id as good.
    fn trust(&self, face: ID) {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(face, true);
    }

    /// Returns `true` if a face may be used; otherwise records the reason as the drawing's error.
    fn admits(&self, face: ID, db: &Database) -> bool {
        if let Some(known) = self.known.lock().unwrap_or_else(PoisonError::into_inner).get(&face) {
            return *known;
        }
        let Some(info) = db.face(face) else { return true };
        let is_given = match &info.source {
            Source::File(path) => self.options.fonts.iter().any(|given| path.starts_with(given)),
            _ => true,
        };
        let name = || info.families.first().map_or("", |(name, _)| name.as_str());
        // Installed fonts are trusted.
        let check = || db.with_face_data(face, |data, index| self.check(data, index, name())).unwrap_or(Ok(()));
        let found = if is_given { check() } else { Ok(()) };
        let is_good = found.is_ok();
        if let (Err(e), Ok(mut r)) = (found, self.rejected.lock()) {
            r.get_or_insert(e);
        }
        self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(face, is_good);
        is_good
    }

    /// Checks that the glyphs of a font take a bounded time.
    fn check(&self, data: &[u8], index: u32, name: &str) -> Result<(), Error> {
        if data == BUNDLED {
            return Ok(());
        }
        let place = format!("the font {name}");
        if let Some(glyph) = GlyphWork::new(data, index).and_then(|mut all| all.endless()) {
            let problem = format!("glyph {glyph} takes {MAX_WORK} points or more, with all of its parts and layers");
            return Err(Error::input(place, problem + "; use another font"));
        }
        // Glyphs may be SVG drawings.
        let Some(svg) = FontRef::from_index(data, index).ok().and_then(|f| f.svg().ok()) else { return Ok(()) };
        let Ok(list) = svg.svg_document_list() else { return Ok(()) };
        let options = self.options.begin(data.len());
        let records = list.document_records().iter();
        let spans: BTreeSet<_> = records.map(|r| (r.svg_doc_offset(), r.svg_doc_length())).collect();
        for (start, length) in spans {
            let end = u64::from(start) + u64::from(length);
            if let Some(drawing) = list.offset_data().as_bytes().get(start as usize..end as usize) {
                images::checked(images::SVG, Arc::new(drawing.to_vec()), &place, &options)?;
            }
        }
        Ok(())
    }
}

/// Thickness of lines, as a fraction of the font size.
const THICKNESS: f64 = 0.1;
/// Distance of an underline's middle below the baseline, as a fraction of the font size.
const BELOW: f64 = 0.1;
/// Height of a strike-through line above the baseline, as a fraction of the ascent.
const THROUGH: f64 = 1.0 / 3.0;
/// Shift of subscripts and superscripts, as a fraction of the line's height.
const SHIFT: f64 = 0.5;

/// Sets the metrics of lines, subscripts and superscripts in a font file to the ones of browsers, for the face at `index`.
pub(super) fn set_browser_metrics(data: &mut [u8], index: u32) {
    for (at, value) in browser_metrics(data, index).unwrap_or_default() {
        if let Some(bytes) = data.get_mut(at..at + 2) {
            bytes.copy_from_slice(&value.to_be_bytes());
        }
    }
}

/// The metrics of browsers, with their positions in a font file.
fn browser_metrics(data: &[u8], index: u32) -> Option<Vec<(usize, i16)>> {
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
    // `post`: underlinePosition and underlineThickness.
    let post = table(b"post").into_iter().flat_map(|at| [(at + 8, below), (at + 10, thickness)]);
    // `OS/2`: ySubscriptYOffset, ySuperscriptYOffset and yStrikeoutPosition.
    let through = rounded(THROUGH * ascent);
    let os2 = table(b"OS/2").into_iter().flat_map(|at| [(at + 16, shift), (at + 24, shift), (at + 28, through)]);
    Some(post.chain(os2).collect())
}
