//! Families: their fonts, by name, weight and slant, for programs that set text themselves.

use super::faces::Look;
use super::fonts::{database, load_file};
use super::read::ReadOptions;
use pathwarp::Error;
use std::collections::BTreeSet;
use std::path::PathBuf;
use usvg::FontFamily;
use usvg::fontdb::{self, Database};

/// A font file's content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FontFile {
    /// Bytes of the file.
    pub bytes: Vec<u8>,
    /// Index of the font in the file, from 0.
    pub index: u32,
}

/// Finds the installed or bundled font of a family that is nearest to `weight` (100 to 900; 400 is regular). `family` may be
/// a generic family of CSS. `read` says which fonts there are.
///
/// # Errors
/// Returns [`Error::Usage`] if there is no such family, with suggestions of similar names.
pub fn find_font(family: &str, weight: u16, italic: bool, read: &ReadOptions) -> Result<FontFile, Error> {
    let db = database(read.system_fonts, &read.fonts);
    let style = if italic { fontdb::Style::Italic } else { fontdb::Style::Normal };
    let look = Look { weight: fontdb::Weight(weight), stretch: fontdb::Stretch::Normal, style };
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

/// The fonts of a family: weight, and `true` for italic and oblique ones; sorted, without repetitions.
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
/// Returns [`Error::Input`] with the name of the first that does not.
pub fn check_fonts(paths: &[PathBuf]) -> Result<(), Error> {
    for path in paths {
        let name = path.display().to_string();
        let mut db = Database::new();
        if path.is_dir() {
            db.load_fonts_dir(path);
        } else {
            load_file(&mut db, path).map_err(|problem| Error::input(&name, problem))?;
        }
        if db.is_empty() {
            return Err(Error::input(&name, if path.is_dir() { "holds no font" } else { "is not a font" }));
        }
    }
    Ok(())
}

/// Lists families with names similar to `family`: each word of `family` resembles a word of the name.
fn similar(family: &str, db: &Database) -> String {
    /// Jaro–Winkler similarity (1 is equal) of words that differ by a letter or two; unrelated words rarely reach it.
    const ALIKE: f64 = 0.85;
    /// Longest list of suggestions.
    const SHOWN: usize = 6;
    let wanted: Vec<String> = family.split_whitespace().map(str::to_lowercase).collect();
    let likeness = |name: &str| {
        let name = name.to_lowercase();
        let best = |w: &String| name.split_whitespace().map(|n| strsim::jaro_winkler(w, n)).fold(0.0, f64::max);
        wanted.iter().map(best).sum::<f64>() / wanted.len().max(1) as f64
    };
    let mut names: Vec<&str> = db.faces().flat_map(|f| &f.families).map(|(n, _)| n.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let mut names: Vec<(f64, &str)> =
        names.into_iter().map(|n| (likeness(n), n)).filter(|(l, _)| *l >= ALIKE).collect();
    names.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.len().cmp(&b.1.len())).then(a.1.cmp(b.1)));
    if names.is_empty() {
        return "the bundled family is Noto Sans".into();
    }
    let names: Vec<&str> = names.iter().take(SHOWN).map(|(_, n)| *n).collect();
    format!("similar families: {}", names.join(", "))
}
