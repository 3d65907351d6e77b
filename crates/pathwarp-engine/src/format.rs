//! File formats of outputs: chosen by the extension, or by `--format`.

use crate::failure::Failure;
use pathwarp_raster::PictureFormat;
use std::fmt::Write as _;
use std::path::Path;

/// The format of an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the table has their names")]
pub enum Format {
    Svg,
    Svgz,
    Pdf,
    Dxf,
    Png,
    Jpeg,
    WebP,
    /// GIMP paths as JSON.
    PointList,
    Xcf,
}

/// All formats: the name in messages, and the extensions, the usual one first.
const TABLE: [(Format, &str, &[&str]); 9] = [
    (Format::Svg, "SVG", &["svg"]),
    (Format::Svgz, "SVG", &["svgz"]),
    (Format::Pdf, "PDF", &["pdf"]),
    (Format::Dxf, "DXF", &["dxf"]),
    (Format::Png, "PNG", &["png"]),
    (Format::Jpeg, "JPEG", &["jpg", "jpeg"]),
    (Format::WebP, "WebP", &["webp"]),
    (Format::PointList, "point list", &["json"]),
    (Format::Xcf, "XCF", &["xcf"]),
];

/// The formats of drawings.
pub const DRAWINGS: &[Format] = &[Format::Svg, Format::Svgz, Format::Pdf, Format::Dxf];
/// The formats of pictures.
pub const PICTURES: &[Format] = &[Format::Png, Format::Jpeg, Format::WebP];

impl Format {
    /// Returns the format of a file by its extension; `None` if that is unknown.
    pub fn of(file: &Path) -> Option<Self> {
        let extension = file.extension()?;
        let is = |known: &&str| extension.eq_ignore_ascii_case(known);
        TABLE.iter().find(|(.., extensions)| extensions.iter().any(is)).map(|(format, ..)| *format)
    }

    /// Returns the format's name and its extensions.
    fn entry(self) -> (&'static str, &'static [&'static str]) {
        let entry = TABLE.iter().find(|(format, ..)| *format == self);
        entry.map_or(("", &[]), |(_, name, extensions)| (*name, *extensions))
    }

    /// Returns the usual extension, which is also the word for `--format`.
    pub fn extension(self) -> &'static str {
        self.entry().1.first().copied().unwrap_or_default()
    }

    /// Returns the encoder's format, if this is a format of pictures.
    pub fn of_picture(self, quality: Option<u8>) -> Option<PictureFormat> {
        match self {
            Self::Png => Some(PictureFormat::Png),
            Self::Jpeg => Some(PictureFormat::Jpeg { quality: quality.unwrap_or(PictureFormat::QUALITY) }),
            Self::WebP => Some(PictureFormat::WebP),
            _ => None,
        }
    }
}

/// A kind of output, with the formats it can have; the first is that of standard output.
#[derive(Clone, Copy)]
pub struct Choice<'a> {
    /// The output with a verb: `a drawing is`.
    pub what: &'a str,
    /// The formats, the usual one first.
    pub among: &'a [Format],
}

impl Choice<'_> {
    /// Returns the format of the output `target`, `None` being standard output. `given` is the value of `--format`.
    ///
    /// # Errors
    /// [`Failure::Usage`] if the format is unknown or not among these, or if the extension contradicts it.
    pub fn format(self, target: Option<&Path>, given: Option<Format>) -> Result<Format, Failure> {
        if let Some(format) = given {
            let word = format.extension();
            if !self.among.contains(&format) {
                return Err(Failure::usage(format!("--format {word}: {} written as {}", self.what, self.list())));
            }
            return match target.and_then(|t| Some((t, Format::of(t)?))) {
                Some((t, other)) if other != format => {
                    Err(Failure::usage(format!("{}: the extension and --format {word} disagree", t.display())))
                }
                _ => Ok(format),
            };
        }
        let first = self.among.first().copied().unwrap_or(Format::Svg);
        let Some((target, extension)) = target.and_then(|t| Some((t, t.extension()?))) else { return Ok(first) };
        let extension = extension.to_string_lossy();
        let found = Format::of(target).filter(|f| self.among.contains(f));
        found.ok_or_else(|| {
            let (target, list, hint) = (target.display(), self.list(), self.hint(&extension.to_lowercase()));
            Failure::usage(format!("{target}: {} written as {list}, not as .{extension}{hint}", self.what))
        })
    }

    /// The names and extensions of the formats.
    fn list(self) -> String {
        let mut names: Vec<&str> = self.among.iter().map(|f| f.entry().0).collect();
        names.dedup();
        let extensions: Vec<String> = self.among.iter().map(|f| format!(".{}", f.extension())).collect();
        let last = names.pop().unwrap_or_default();
        let mut out = names.join(", ");
        let _ = write!(out, "{}{last} ({})", if names.is_empty() { "" } else { " or " }, extensions.join(", "));
        out
    }

    /// Suggests the command that writes files with an extension that is not among these.
    fn hint(self, extension: &str) -> &'static str {
        let has = |f: Format| self.among.contains(&f);
        match extension {
            "eps" | "ps" | "ai" if has(Format::Pdf) => {
                "; write a .pdf, which Illustrator opens and `pdftops -eps` (Poppler) converts to EPS"
            }
            "png" | "jpg" | "jpeg" | "webp" if has(Format::Svg) => {
                "; --preview and `pathwarp render` make pictures of it"
            }
            "json" | "xcf" if has(Format::Svg) => {
                "; point lists and XCF are written for GIMP inputs only, and `pathwarp convert` makes them from an SVG"
            }
            "tif" | "tiff" | "bmp" | "gif" if has(Format::Png) => "; write a .png, which has the same pixels",
            _ => "",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::OPTIONS;

    #[test]
    fn every_format_has_its_word() {
        let words = OPTIONS.iter().find(|o| o.name == "format").unwrap().words();
        let written = TABLE.iter().map(|(f, ..)| f.extension()).filter(|e| *e != "xcf");
        assert_eq!(words, std::iter::once("auto").chain(written).collect::<Vec<_>>());
    }

    #[test]
    fn the_extension_or_the_option_decides() {
        let drawing = Choice { what: "a drawing is", among: DRAWINGS };
        let format = |target: Option<&str>, given| drawing.format(target.map(Path::new), given);
        let chosen = |target, given| format(target, given).unwrap();
        assert_eq!(chosen(None, None), Format::Svg);
        assert_eq!(chosen(Some("a.PDF"), None), Format::Pdf);
        assert_eq!(chosen(Some("plain"), None), Format::Svg);
        assert_eq!(chosen(Some("plain.tmp"), Some(Format::Dxf)), Format::Dxf);
        for (target, given, part) in [
            (
                "a.eps",
                None,
                "a.eps: a drawing is written as SVG, PDF or DXF (.svg, .svgz, .pdf, .dxf), not as .eps; write a .pdf",
            ),
            ("a.png", None, "`pathwarp render`"),
            ("a.svg", Some(Format::Pdf), "disagree"),
            ("a", Some(Format::Png), "--format png: a drawing is written as SVG"),
        ] {
            let Failure::Usage(said) = format(Some(target), given).unwrap_err() else { panic!("{target}") };
            assert!(said.contains(part), "{said}");
        }
    }
}
