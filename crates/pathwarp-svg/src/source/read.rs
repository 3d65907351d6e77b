//! File content to text and back: encoding, compression, limits.

use super::encoding::decoded;
use super::faces::GenericFamilies;
use pathwarp::Error;
use pathwarp::budget::{Budget, Exceeded, Limit, Limits};
use std::borrow::Cow;
use std::io::{Read as _, Write as _};
use std::path::PathBuf;
use std::sync::Arc;

/// Options for reading a file.
///
/// ```
/// use pathwarp_svg::{Document, ReadOptions, Selection};
///
/// let options = ReadOptions::default().with_dpi(72.0).with_system_fonts(false);
/// let svg = "<svg xmlns='http://www.w3.org/2000/svg'><rect width='2in' height='1in'/></svg>";
/// let artwork = Document::read(svg.as_bytes(), "inches.svg", &options)?.artwork_box(&Selection::default());
/// assert_eq!(artwork.map(|b| b.width()), Some(144.0));
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Folder that relative links to images start from. Without it, links are not followed.
    pub base_dir: Option<PathBuf>,
    /// Use the fonts installed on the machine for text. They are read only if there is text.
    pub system_fonts: bool,
    /// Additional fonts: files, or folders of them.
    pub fonts: Vec<PathBuf>,
    /// Families for `serif`, `sans-serif` and so on.
    pub generic_families: GenericFamilies,
    /// Resolution in px per inch.
    pub dpi: f32,
    /// Limits on the work to read and warp the drawing; those that are not set grow with the size of the file.
    pub limits: Limits,
    /// Follow links out of [`base_dir`](Self::base_dir): absolute ones, `..`, and symbolic links.
    pub external: bool,
    /// The budget of the file that is being read.
    pub(crate) budget: Arc<Budget>,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            base_dir: None,
            system_fonts: true,
            fonts: Vec::new(),
            generic_families: GenericFamilies::default(),
            dpi: 96.0,
            limits: Limits::default(),
            external: false,
            budget: Arc::default(),
        }
    }
}

impl ReadOptions {
    /// The options for a file of `bytes`, with a budget of which nothing is used.
    pub(crate) fn begin(&self, bytes: usize) -> Self {
        Self { budget: Arc::new(Budget::new(self.limits.for_input(bytes))), ..self.clone() }
    }

    /// The same options with a budget of which nothing is used.
    pub(crate) fn begin_again(&self) -> Self {
        Self { budget: Arc::new(Budget::new(self.budget.limits())), ..self.clone() }
    }

    /// Sets [`base_dir`](Self::base_dir).
    #[must_use]
    pub fn with_base_dir(self, base_dir: Option<PathBuf>) -> Self {
        Self { base_dir, ..self }
    }

    /// Sets [`system_fonts`](Self::system_fonts).
    #[must_use]
    pub fn with_system_fonts(self, system_fonts: bool) -> Self {
        Self { system_fonts, ..self }
    }

    /// Sets [`fonts`](Self::fonts).
    #[must_use]
    pub fn with_fonts(self, fonts: Vec<PathBuf>) -> Self {
        Self { fonts, ..self }
    }

    /// Sets [`generic_families`](Self::generic_families).
    #[must_use]
    pub fn with_generic_families(self, generic_families: GenericFamilies) -> Self {
        Self { generic_families, ..self }
    }

    /// Sets [`dpi`](Self::dpi).
    #[must_use]
    pub fn with_dpi(self, dpi: f32) -> Self {
        Self { dpi, ..self }
    }

    /// Sets [`limits`](Self::limits).
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    /// Sets the limit on the text, in bytes, before and after decompression.
    #[must_use]
    pub fn with_max_size(self, max_size: usize) -> Self {
        let limits = self.limits.with(Limit::Bytes, max_size as f64);
        Self { limits, ..self }
    }

    /// Sets [`external`](Self::external).
    #[must_use]
    pub fn with_external(self, external: bool) -> Self {
        Self { external, ..self }
    }
}

/// Decodes an SVG or svgz file. `name` identifies it in errors.
pub(crate) fn text(data: &[u8], name: &str, budget: &Budget) -> Result<String, Error> {
    let bytes = match unpacked(data, name, budget)? {
        Some(unpacked) => Cow::Owned(unpacked),
        None => {
            let counted = budget.take(Limit::Bytes, data.len() as f64);
            counted.map_err(|e| Error::limit(name, "its text takes", e))?;
            Cow::Borrowed(data)
        }
    };
    decoded(bytes).map_err(|(at, problem)| Error::input(format!("{name}: byte {at}"), problem))
}

/// What gzip data begins with.
pub(super) const GZIP: &[u8] = &[0x1f, 0x8b];

/// Unpacks gzip data. Returns `None` for other data. `name` identifies it in errors.
pub(crate) fn unpacked(data: &[u8], name: &str, budget: &Budget) -> Result<Option<Vec<u8>>, Error> {
    if !data.starts_with(GZIP) {
        return Ok(None);
    }
    let mut out = Vec::new();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    let limit = (budget.room(Limit::Bytes) as u64).saturating_add(1);
    let read = flate2::read::GzDecoder::new(data).take(limit).read_to_end(&mut out);
    read.map_err(|e| Error::input(name, format!("the compressed data is damaged: {e}")))?;
    // Unpacking stopped at the limit.
    let counted = budget.take(Limit::Bytes, out.len() as f64).map_err(Exceeded::cut_short);
    counted.map_err(|e| Error::limit(name, "unpacked, it takes", e))?;
    Ok(Some(out))
}

/// Compresses an SVG file to an svgz file: gzip without time and name, so that equal texts give equal files.
///
/// # Errors
/// Passes on errors of the compressor, which writes to memory.
pub fn compressed(text: &str) -> std::io::Result<Vec<u8>> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    out.write_all(text.as_bytes())?;
    out.finish()
}
