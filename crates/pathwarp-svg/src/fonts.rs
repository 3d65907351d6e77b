//! Fonts for text: the system's where wanted, given files, and a bundled one for whatever is missing.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock};
use usvg::fontdb::{self, Database, Family, ID};
use usvg::{FontFamily, FontResolver};

static BUNDLED: &[u8] = include_bytes!("../fonts/NotoSans-Regular.subset.ttf");
const BUNDLED_FAMILY: &str = "Noto Sans";

/// What CSS's generic families stand for. `None`: whatever common family of that kind there is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GenericFamilies {
    /// `serif`
    pub serif: Option<String>,
    /// `sans-serif`
    pub sans_serif: Option<String>,
    /// `cursive`
    pub cursive: Option<String>,
    /// `fantasy`
    pub fantasy: Option<String>,
    /// `monospace`
    pub monospace: Option<String>,
}

/// Families that were asked for and not found.
pub(crate) type Missing = Arc<Mutex<BTreeSet<String>>>;

/// The fonts to look in. The system's are read once per process.
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
    let mut db = base.clone();
    for p in paths {
        let db = Arc::make_mut(&mut db);
        if p.is_dir() {
            db.load_fonts_dir(p);
        } else {
            // A file that is no font leaves the database as it was; the family's absence is then reported.
            let _ = db.load_font_file(p);
        }
    }
    db
}

/// Finds fonts like usvg's own resolver, but never comes back empty-handed, and notes the families it did not find.
pub(crate) fn resolver(generic: GenericFamilies, missing: Missing) -> FontResolver<'static> {
    FontResolver {
        select_font: Box::new(move |font, db| {
            let query = |family: &str| {
                db.query(&fontdb::Query {
                    families: &[Family::Name(family)],
                    weight: fontdb::Weight(font.weight()),
                    stretch: stretch(font.stretch()),
                    style: match font.style() {
                        usvg::FontStyle::Normal => fontdb::Style::Normal,
                        usvg::FontStyle::Italic => fontdb::Style::Italic,
                        usvg::FontStyle::Oblique => fontdb::Style::Oblique,
                    },
                })
            };
            let mut absent = Vec::new();
            for family in font.families() {
                let found = match family {
                    FontFamily::Named(name) => query(name),
                    other => of_kind(other, &generic, query),
                };
                if found.is_some() {
                    return found;
                }
                if let FontFamily::Named(name) = family {
                    absent.push(name.clone());
                }
            }
            if let Ok(mut m) = missing.lock() {
                m.extend(absent);
            }
            let last: Option<ID> = of_kind(&FontFamily::Serif, &generic, query);
            last.or_else(|| query(BUNDLED_FAMILY)).or_else(|| db.faces().next().map(|f| f.id))
        }),
        select_fallback: FontResolver::default_fallback_selector(),
    }
}

/// A generic family: the one that was set, else the common ones.
fn of_kind(kind: &FontFamily, set: &GenericFamilies, query: impl Fn(&str) -> Option<ID>) -> Option<ID> {
    let (own, common): (_, &[&str]) = match kind {
        FontFamily::Serif => (&set.serif, &["Times New Roman", "Noto Serif", "DejaVu Serif", "Liberation Serif"]),
        FontFamily::SansSerif => (&set.sans_serif, &["Arial", "Helvetica", "Noto Sans", "DejaVu Sans"]),
        FontFamily::Cursive => (&set.cursive, &["Comic Sans MS", "Apple Chancery"]),
        FontFamily::Fantasy => (&set.fantasy, &["Impact", "Papyrus"]),
        FontFamily::Monospace => {
            (&set.monospace, &["Courier New", "Noto Sans Mono", "Noto Mono", "DejaVu Sans Mono", "Liberation Mono"])
        }
        FontFamily::Named(_) => return None,
    };
    match own {
        Some(name) => query(name),
        None => common.iter().find_map(|n| query(n)).or_else(|| query(BUNDLED_FAMILY)),
    }
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
