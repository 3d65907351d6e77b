//! Finds faces by the names that drawings use: families, generic families, full names and PostScript names.

use usvg::FontFamily;
use usvg::fontdb::{self, Database, Family, ID, Source};

pub(super) static BUNDLED: &[u8] = include_bytes!("../../fonts/NotoSans-Regular.subset.ttf");
pub(super) const BUNDLED_FAMILY: &str = "Noto Sans";
/// A heavy condensed face for lettering: Fira Sans Extra Condensed Black.
pub(super) static DISPLAY: &[u8] = include_bytes!("../../fonts/FiraSansExtraCondensed-Black.subset.ttf");
/// The family name of [`DISPLAY`].
pub(super) const DISPLAY_FAMILY: &str = "display";

/// Families for CSS's generic family names. `None` selects a common family of that kind.
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

/// Returns the bytes of the bundled font: Noto Sans (OFL) for Latin, Greek and Cyrillic.
#[must_use]
pub fn bundled_font() -> &'static [u8] {
    BUNDLED
}

/// A weight, a stretch and a style.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub(super) weight: fontdb::Weight,
    pub(super) stretch: fontdb::Stretch,
    pub(super) style: fontdb::Style,
}

impl Look {
    /// Upright or italic, of a weight from 100 to 900.
    pub(super) fn new(weight: u16, italic: bool) -> Self {
        let style = if italic { fontdb::Style::Italic } else { fontdb::Style::Normal };
        Self { weight: fontdb::Weight(weight), stretch: fontdb::Stretch::Normal, style }
    }

    /// The look that a text requests.
    pub(super) fn of_text(font: &usvg::Font) -> Self {
        let weight = fontdb::Weight(font.weight());
        Self { weight, stretch: font.stretch().into(), style: font.style().into() }
    }

    pub(super) fn of_face(face: &fontdb::FaceInfo) -> Self {
        Self { weight: face.weight, stretch: face.stretch, style: face.style }
    }

    /// The face of a family that is nearest to the look.
    pub(super) fn face_of(self, family: &str, db: &Database) -> Option<ID> {
        let Self { weight, stretch, style } = self;
        db.query(&fontdb::Query { families: &[Family::Name(family)], weight, stretch, style })
    }

    /// Finds a face by a family name in different case, or by its full or PostScript name, which Illustrator writes. The look of such a
    /// face applies where the drawing specifies none.
    pub(super) fn face_called(self, name: &str, db: &Database) -> Option<ID> {
        let family =
            |f: &fontdb::FaceInfo| f.families.iter().find(|(n, _)| n.to_lowercase() == name.to_lowercase()).cloned();
        if let Some((family, _)) = db.faces().find_map(family) {
            return self.face_of(&family, db);
        }
        let wanted = plain(name);
        let face = db.faces().find(|f| !wanted.is_empty() && plain(&f.post_script_name) == wanted)?;
        self.or(face.weight, face.style, face.stretch).face_of(&face.families.first()?.0, db)
    }

    /// Finds a face of a family whose letters are as wide as those of a missing one.
    pub(super) fn face_with_metrics_of(self, missing: &str, db: &Database) -> Option<ID> {
        let (families, weight, style) = substitutes(&METRIC_COMPATIBLE, missing)?;
        self.or(weight, style, fontdb::Stretch::Normal).first_of(families, db)
    }

    /// The face of the first of some families that is there.
    fn first_of(self, families: &[&str], db: &Database) -> Option<ID> {
        families.iter().find_map(|f| self.face_of(f, db))
    }

    /// Finds the face that Chromium uses if no family is found or specified: its standard one or one with equal metrics, or else a
    /// sans-serif.
    pub(super) fn standard_face(self, generic: &GenericFamilies, db: &Database) -> Option<ID> {
        const STANDARD: &str = "Times New Roman";
        let configured = generic.serif.as_deref().and_then(|name| self.face_of(name, db));
        let standard = || self.face_of(STANDARD, db).or_else(|| self.face_with_metrics_of(STANDARD, db));
        configured.or_else(standard).or_else(|| self.face_of_kind(&FontFamily::SansSerif, generic, db))
    }

    /// Finds a face of a family similar to one of the missing families, or of its generic family.
    pub(super) fn face_like(self, missing: &[String], generic: &GenericFamilies, db: &Database) -> Option<ID> {
        let alike = |name: &String| {
            let (families, weight, style) = substitutes(&ALIKE, name)?;
            self.or(weight, style, fontdb::Stretch::Normal).first_of(families, db)
        };
        let of_kind = |name: &String| {
            let words = plain(name);
            let weight = if words.contains("bold") { fontdb::Weight::BOLD } else { fontdb::Weight::NORMAL };
            let is_slanted = words.contains("italic") || words.contains("oblique");
            let style = if is_slanted { fontdb::Style::Italic } else { fontdb::Style::Normal };
            self.or(weight, style, fontdb::Stretch::Normal).face_of_kind(&kind_of(name)?, generic, db)
        };
        missing.iter().find_map(|name| alike(name).or_else(|| of_kind(name)))
    }

    /// The look with the given values in place of normal weight, style and stretch.
    fn or(self, weight: fontdb::Weight, style: fontdb::Style, stretch: fontdb::Stretch) -> Self {
        Self {
            weight: if self.weight == fontdb::Weight::NORMAL { weight } else { self.weight },
            stretch: if self.stretch == fontdb::Stretch::Normal { stretch } else { self.stretch },
            style: if self.style == fontdb::Style::Normal { style } else { self.style },
        }
    }

    /// Finds a face of a generic family: the configured one, or else a common installed one, or else the bundled one.
    pub(super) fn face_of_kind(self, kind: &FontFamily, generic: &GenericFamilies, db: &Database) -> Option<ID> {
        let common: &[&str] = match kind {
            FontFamily::Serif => SERIFS,
            FontFamily::SansSerif => SANS_SERIFS,
            FontFamily::Cursive => &["Comic Sans MS", "Apple Chancery"],
            FontFamily::Fantasy => &["Impact", "Papyrus"],
            FontFamily::Monospace => MONOSPACED,
            FontFamily::Named(_) => return None,
        };
        // Chromium falls back to a sans-serif.
        let last = if matches!(kind, FontFamily::Cursive | FontFamily::Fantasy) { SANS_SERIFS } else { &[] };
        // The bundled family has a single weight.
        let installed = |name: &&str| self.face_of(name, db).filter(|id| !is_bundled(*id, db));
        match configured_name(kind, generic) {
            Some(name) => self.face_of(name, db),
            None => common.iter().chain(last).find_map(installed).or_else(|| self.face_of(BUNDLED_FAMILY, db)),
        }
    }
}

/// Fonts that browsers use for `serif`: the usual one, then fonts with equal metrics, then Linux's. The lists below have this order, too.
const SERIFS: &[&str] =
    &["Times New Roman", "Liberation Serif", "Tinos", "Times", "Nimbus Roman", "Noto Serif", "DejaVu Serif"];
const SANS_SERIFS: &[&str] =
    &["Arial", "Liberation Sans", "Arimo", "Helvetica", "Nimbus Sans", "Noto Sans", "DejaVu Sans"];
const MONOSPACED: &[&str] = &[
    "Consolas",
    "Menlo",
    "Noto Sans Mono",
    "Noto Mono",
    "DejaVu Sans Mono",
    "Liberation Mono",
    "Cousine",
    "Courier New",
];

/// Beginnings of [`plain`] family names, by generic family (fontconfig's `45-latin.conf`, and others).
const KINDS: [(FontFamily, &str); 4] = [
    (FontFamily::Monospace, "andalemono consol courier lucidaconsole menlo monaco sfmono terminal lettergothic"),
    (
        FontFamily::Serif,
        "antiqua baskerville bodoni bookantiqua bookman cambria caslon century charter cochin constantia didot elephant garamond \
         georgia goudy lora merriweather minion newyork nimbusroman palatino perpetua playfair rockwell times utopia",
    ),
    (FontFamily::Cursive, "brush chalkboard comic lucidahandwriting snell zapfchancery zapfino"),
    (
        FontFamily::SansSerif,
        "albany arial avantgarde avenir bahnschrift britannic calibri candara centurygothic corbel dmsans droidsans firasans franklin \
         frutiger futura geneva gillsans haettenschweiler helvetica ibmplexsans impact inter lato lucida luxisans microsoftsans \
         montserrat mssans myriad nimbussans nunito opensans optima poppins proximanova quicksand raleway roboto segoeui sourcesans \
         sfpro tahoma trebuchet ubuntu univers verdana worksans",
    ),
];

/// Guesses the generic family of a missing one from its name.
fn kind_of(missing: &str) -> Option<FontFamily> {
    let name = plain(missing);
    // The whole name decides if it is known, then a word in it, then a known beginning.
    let words = [
        ("mono", FontFamily::Monospace),
        ("typewriter", FontFamily::Monospace),
        ("gothic", FontFamily::SansSerif),
        ("grotes", FontFamily::SansSerif),
        ("sans", FontFamily::SansSerif),
        ("slab", FontFamily::Serif),
        ("serif", FontFamily::Serif),
        ("script", FontFamily::Cursive),
        ("handwriting", FontFamily::Cursive),
    ];
    let by_word = || words.iter().find(|(word, _)| name.contains(word)).map(|(_, kind)| kind.clone());
    let known = KINDS.iter().find(|(_, names)| names.split(' ').any(|n| name.starts_with(n)));
    let whole = known.filter(|(_, names)| names.split(' ').any(|n| n == name));
    whole.map(|k| k.0.clone()).or_else(by_word).or_else(|| known.map(|k| k.0.clone()))
}

/// A name reduced to lowercase letters and digits, without `regular` at its end.
fn plain(name: &str) -> String {
    let mut letters: String = name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    letters.truncate(letters.strip_suffix("regular").unwrap_or(&letters).len());
    letters
}

/// Families with equal widths (fontconfig's `30-metric-aliases.conf`), by plain name. Chromium substitutes them before it tries the next
/// family of a list.
const METRIC_COMPATIBLE: [(&str, &[&str]); 13] = [
    ("arial", &["Liberation Sans", "Arimo", "Helvetica", "Nimbus Sans"]),
    ("helvetica", &["Nimbus Sans", "Arial", "Liberation Sans", "Arimo"]),
    ("timesnewroman", &["Liberation Serif", "Tinos", "Times", "Nimbus Roman"]),
    ("times", &["Nimbus Roman", "Times New Roman", "Liberation Serif", "Tinos"]),
    ("couriernew", &["Liberation Mono", "Cousine", "Courier", "Nimbus Mono PS"]),
    ("courier", &["Nimbus Mono PS", "Courier New", "Liberation Mono", "Cousine"]),
    ("calibri", &["Carlito"]),
    ("cambria", &["Caladea"]),
    ("georgia", &["Gelasio"]),
    ("palatino", &["P052", "URW Palladio L", "TeX Gyre Pagella"]),
    ("palatinolinotype", &["P052", "URW Palladio L", "TeX Gyre Pagella"]),
    ("newcenturyschoolbook", &["C059", "Century Schoolbook L", "TeX Gyre Schola"]),
    ("itcavantgardegothic", &["URW Gothic", "TeX Gyre Adventor"]),
];

/// Similar families, by plain name. They are substituted only if no other family of the list is found.
const ALIKE: [(&str, &[&str]); 4] = [
    ("verdana", &["DejaVu Sans", "Bitstream Vera Sans"]),
    ("segoeui", &["Selawik", "Open Sans"]),
    ("consolas", &["Inconsolata", "DejaVu Sans Mono"]),
    ("menlo", &["DejaVu Sans Mono"]),
];

/// The substitutes of a missing family, with the weight and style that its name, perhaps a PostScript name, implies.
fn substitutes(
    table: &[(&str, &'static [&'static str])],
    missing: &str,
) -> Option<(&'static [&'static str], fontdb::Weight, fontdb::Style)> {
    let name = plain(missing);
    table.iter().find_map(|(family, others)| {
        let mut rest = name.strip_prefix(family)?;
        let (mut weight, mut style) = (fontdb::Weight::NORMAL, fontdb::Style::Normal);
        while !rest.is_empty() {
            let word = ["ps", "mt", "bold", "italic", "oblique"].into_iter().find(|w| rest.starts_with(w))?;
            match word {
                "bold" => weight = fontdb::Weight::BOLD,
                "italic" | "oblique" => style = fontdb::Style::Italic,
                _ => {}
            }
            rest = &rest[word.len()..];
        }
        Some((*others, weight, style))
    })
}

/// Returns `true` for the face of [`BUNDLED`].
fn is_bundled(face: ID, db: &Database) -> bool {
    db.face(face).is_some_and(|f| matches!(&f.source, Source::Binary(data) if data.as_ref().as_ref() == BUNDLED))
}

/// The generic family of a system interface font (CSS Fonts 4, section 2.1.3).
pub(super) fn of_interface(name: &str) -> Option<FontFamily> {
    Some(match name {
        "system-ui" | "ui-sans-serif" | "ui-rounded" | "-apple-system" | "BlinkMacSystemFont" => FontFamily::SansSerif,
        "ui-serif" | "math" | "fangsong" => FontFamily::Serif,
        "ui-monospace" => FontFamily::Monospace,
        _ => return None,
    })
}

/// The name of a family, or the name configured for a generic one.
pub(super) fn configured_name<'a>(family: &'a FontFamily, generic: &'a GenericFamilies) -> Option<&'a String> {
    match family {
        FontFamily::Named(name) => Some(name),
        FontFamily::Serif => generic.serif.as_ref(),
        FontFamily::SansSerif => generic.sans_serif.as_ref(),
        FontFamily::Cursive => generic.cursive.as_ref(),
        FontFamily::Fantasy => generic.fantasy.as_ref(),
        FontFamily::Monospace => generic.monospace.as_ref(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_fonts() {
        assert_eq!(plain("Noto Sans-Regular"), "notosans");
        let of = |name| {
            substitutes(&METRIC_COMPATIBLE, name).map(|(families, weight, style)| (families[0], weight.0, style))
        };
        assert_eq!(of("Arial"), Some(("Liberation Sans", 400, fontdb::Style::Normal)));
        assert_eq!(of("Helvetica-BoldOblique"), Some(("Nimbus Sans", 700, fontdb::Style::Italic)));
        assert_eq!(of("TimesNewRomanPS-ItalicMT"), Some(("Liberation Serif", 400, fontdb::Style::Italic)));
        assert_eq!(of("Courier New"), Some(("Liberation Mono", 400, fontdb::Style::Normal)));
        assert_eq!([of("Helvetica Neue"), of("Arial Black"), of("Timeless")], [None; 3]);
        for (name, kind) in [
            ("Helvetica Neue", Some(FontFamily::SansSerif)),
            ("Segoe UI", Some(FontFamily::SansSerif)),
            ("PublicSans-Regular", Some(FontFamily::SansSerif)),
            ("Noto Serif Display", Some(FontFamily::Serif)),
            ("Century Gothic", Some(FontFamily::SansSerif)),
            ("MinionPro-Bold", Some(FontFamily::Serif)),
            ("Fira Mono", Some(FontFamily::Monospace)),
            ("Brush Script MT", Some(FontFamily::Cursive)),
            ("Nowhere", None),
        ] {
            assert_eq!(kind_of(name), kind, "{name}");
        }
    }
}
