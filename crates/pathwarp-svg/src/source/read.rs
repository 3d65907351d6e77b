//! Decodes, decompresses and compresses files, within limits.

use super::faces::GenericFamilies;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE};
use pathwarp::Error;
use pathwarp::budget::{Budget, Exceeded, Limit, Limits};
use std::borrow::Cow;
use std::io::{Read as _, Write as _};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

options! {
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
    pub struct ReadOptions() {
        /// Folder of relative links to images. Without it, links are not followed.
        pub base_dir: Option<PathBuf> = None, with_base_dir;
        /// Use the fonts installed on the machine for text. They are read only if there is text.
        pub system_fonts: bool = true, with_system_fonts;
        /// Additional fonts: files, or folders of them.
        pub fonts: Vec<PathBuf> = Vec::new(), with_fonts;
        /// Families for `serif`, `sans-serif` and so on.
        pub generic_families: GenericFamilies = GenericFamilies::default(), with_generic_families;
        /// Resolution in px per inch.
        pub dpi: f32 = 96.0, with_dpi;
        /// Limits on the work of reading and warping the drawing. Defaults grow with the size of the file.
        pub limits: Limits = Limits::default(), with_limits;
        /// Follow links out of [`base_dir`](Self::base_dir): absolute ones, `..`, and symbolic links.
        pub external: bool = false, with_external;
        /// Turns the pixels of images as their metadata request, as browsers do. Without it, images are taken as stored.
        pub turned: Option<Turned> = None, with_turned;
        /// The budget of the file being read.
        pub(crate) budget: Arc<Budget> = Arc::default();
    }
}

/// A function that returns an image with its pixels turned, within limits; `None` if they stay. It is applied again to images that are
/// written unchanged, so a function that only prepares images for turning them when they are bent has to undo this.
pub type Turned = fn(&[u8], &Limits) -> Option<Vec<u8>>;

impl Default for ReadOptions {
    fn default() -> Self {
        Self::defaults()
    }
}

impl ReadOptions {
    /// The options for a file of `bytes`, with a new budget.
    pub(crate) fn begin(&self, bytes: usize) -> Self {
        Self { budget: Arc::new(Budget::new(self.limits.for_input(bytes))), ..self.clone() }
    }

    /// The options with a new budget of the current limits.
    pub(crate) fn begin_again(&self) -> Self {
        Self { budget: Arc::new(Budget::new(self.budget.limits())), ..self.clone() }
    }

    /// Sets the limit on the size of the file in bytes, before and after decompression.
    #[must_use]
    pub fn with_max_size(self, max_size: usize) -> Self {
        let limits = self.limits.with(Limit::Bytes, max_size as f64);
        Self { limits, ..self }
    }
}

/// Decodes an SVG or svgz file. `name` identifies it in errors.
pub(crate) fn text(data: &[u8], name: &str, budget: &Budget) -> Result<String, Error> {
    let bytes = if let Some(unpacked) = unpacked(data, name, budget)? {
        Cow::Owned(unpacked)
    } else {
        budget.take(Limit::Bytes, data.len() as f64).map_err(|e| Error::limit(name, "its text takes", e))?;
        Cow::Borrowed(data)
    };
    decoded(bytes).map_err(|(at, problem)| Error::input(format!("{name}: byte {at}"), problem))
}

/// The signature of gzip data.
pub(super) const GZIP: &[u8] = &[0x1f, 0x8b];

/// Unpacks gzip data. Returns `None` for other data. `name` identifies it in errors.
fn unpacked(data: &[u8], name: &str, budget: &Budget) -> Result<Option<Vec<u8>>, Error> {
    if !data.starts_with(GZIP) {
        return Ok(None);
    }
    let mut out = Vec::new();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    let limit = (budget.room(Limit::Bytes) as u64).saturating_add(1);
    let read = flate2::read::GzDecoder::new(data).take(limit).read_to_end(&mut out);
    read.map_err(|e| Error::input(name, format!("the compressed data is damaged: {e}")))?;
    // Unpacking stopped at the limit, so more may have followed.
    let counted = budget.take(Limit::Bytes, out.len() as f64).map_err(Exceeded::cut_short);
    counted.map_err(|e| Error::limit(name, "unpacked, it takes", e))?;
    Ok(Some(out))
}

/// Packs data with gzip and base64, for an attribute or an element.
pub(crate) fn packed(data: &[u8]) -> Result<String, Error> {
    let failed = |e: std::io::Error| Error::input("the source", format!("cannot be packed: {e}"));
    Ok(STANDARD.encode(gzipped(data).map_err(failed)?))
}

/// Reverses [`packed`]. The base64 may contain white space. `name` identifies the data in errors.
pub(crate) fn unpacked_text(packed: &str, name: &str, budget: &Budget) -> Result<Vec<u8>, Error> {
    let damaged = |e: &dyn std::fmt::Display| Error::input(name, format!("is damaged: {e}"));
    let packed: String = packed.split_ascii_whitespace().collect();
    let bytes = STANDARD.decode(packed).map_err(|e| damaged(&e))?;
    unpacked(&bytes, name, budget)?.ok_or_else(|| damaged(&"it is not compressed"))
}

/// Compresses an SVG file to an svgz file. The header of the gzip data has no time or name, so that equal texts give equal files.
///
/// # Errors
/// The errors of the compressor, which writes to memory.
pub fn compressed(text: &str) -> std::io::Result<Vec<u8>> {
    gzipped(text.as_bytes())
}

/// Packs data with gzip.
fn gzipped(data: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    out.write_all(data)?;
    out.finish()
}

/// Number of bytes within which the XML declaration must end.
const MAX_DECLARATION: usize = 256;

/// Decodes `bytes`. If they are not UTF-8, the declaration in the text is changed to UTF-8.
///
/// # Errors
/// Returns the position of the first malformed byte, and a message.
pub(super) fn decoded(bytes: Cow<'_, [u8]>) -> Result<String, (usize, String)> {
    let Some(encoding) = foreign_encoding(&bytes)? else {
        return String::from_utf8(bytes.into_owned()).map_err(|e| {
            let hint = "this is not UTF-8 text, and no XML declaration names another encoding; save it as UTF-8";
            (e.utf8_error().valid_up_to(), hint.to_owned())
        });
    };
    let (text, malformed) = encoding.decode_with_bom_removal(&bytes);
    if malformed {
        let problem = format!("this is not {} text; save it as UTF-8", encoding.name());
        return Err((malformed_at(encoding, &bytes), problem));
    }
    let mut text = text.into_owned();
    if let Some(name) = declared_encoding(text.as_bytes()) {
        text.replace_range(name, "UTF-8");
    }
    Ok(text)
}

/// Determines the encoding of a file from its first bytes or the XML declaration. Returns `None` for UTF-8.
fn foreign_encoding(bytes: &[u8]) -> Result<Option<&'static Encoding>, (usize, String)> {
    match bytes {
        [0xff, 0xfe, ..] | [b'<', 0, ..] => return Ok(Some(UTF_16LE)),
        [0xfe, 0xff, ..] | [0, b'<', ..] => return Ok(Some(UTF_16BE)),
        _ => {}
    }
    let Some(range) = declared_encoding(bytes) else { return Ok(None) };
    let label = &bytes[range.clone()];
    let encoding = Encoding::for_label(label).ok_or_else(|| {
        (range.start, format!("the encoding `{}` is unknown; save the file as UTF-8", String::from_utf8_lossy(label)))
    })?;
    // A declaration in single bytes is not UTF-16, although some drawing programs declare that.
    Ok(Some(encoding).filter(|e| ![UTF_8, UTF_16LE, UTF_16BE].contains(e)))
}

/// The range of the encoding's name in the XML declaration.
fn declared_encoding(bytes: &[u8]) -> Option<Range<usize>> {
    const BEGIN: &[u8] = b"<?xml";
    let head = &bytes[..bytes.len().min(MAX_DECLARATION)];
    // A byte order mark may precede the declaration.
    let start = head.strip_prefix(b"\xef\xbb\xbf").map_or(0, |_| 3);
    let end = start + memchr::memmem::find(head.get(start..)?.strip_prefix(BEGIN)?, b"?>")? + BEGIN.len();
    let key = start + memchr::memmem::find(&head[start..end], b"encoding")? + b"encoding".len();
    let rest = &head[key..end];
    let open = rest.iter().position(|b| matches!(b, b'"' | b'\''))?;
    if rest[..open].iter().any(|b| !b.is_ascii_whitespace() && *b != b'=') {
        return None;
    }
    let length = rest[open + 1..].iter().position(|b| *b == rest[open])?;
    Some(key + open + 1..key + open + 1 + length)
}

/// The position of the first malformed byte.
fn malformed_at(encoding: &'static Encoding, bytes: &[u8]) -> usize {
    let mut decoder = encoding.new_decoder_with_bom_removal();
    let mut out = String::with_capacity(decoder.max_utf8_buffer_length(bytes.len()).unwrap_or_default());
    decoder.decode_to_string_without_replacement(bytes, &mut out, true).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<String, (usize, String)> {
        decoded(Cow::Borrowed(bytes))
    }

    fn utf16(text: &str, unit: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(unit).collect()
    }

    #[test]
    fn utf16_with_and_without_a_mark() {
        let (source, mended) =
            ("<?xml version='1.0' encoding='UTF-16'?><t>ä€𝔘</t>", "<?xml version='1.0' encoding='UTF-8'?><t>ä€𝔘</t>");
        for unit in [u16::to_le_bytes, u16::to_be_bytes] {
            for mark in ["\u{feff}", ""] {
                assert_eq!(read(&utf16(&format!("{mark}{source}"), unit)).unwrap(), mended);
            }
        }
        // Half a pair.
        let mut broken = utf16("<t>", u16::to_le_bytes);
        broken.extend([0x35, 0xd8, b'<', 0]);
        let (at, what) = read(&broken).unwrap_err();
        assert!(at >= 6 && what.contains("UTF-16LE"), "{at} {what}");
    }

    #[test]
    fn the_declared_encoding_is_read() {
        for (label, byte, letter) in
            [("ISO-8859-1", 0xe4, 'ä'), ("windows-1251", 0xc6, 'Ж'), ("iso-8859-15", 0xa4, '€'), ("KOI8-R", 0xf6, 'Ж')]
        {
            for quote in ['"', '\''] {
                let mut source = format!("<?xml version=\"1.0\"  encoding = {quote}{label}{quote} ?><t>").into_bytes();
                source.extend([byte, b'<', b'/', b't', b'>']);
                let wanted = format!("<?xml version=\"1.0\"  encoding = {quote}UTF-8{quote} ?><t>{letter}</t>");
                assert_eq!(read(&source).unwrap(), wanted, "{label}");
            }
        }
        for text in [
            "<t>ä</t>",
            "<?xml version='1.0' encoding='utf-8'?><t>ä</t>",
            "<?xml version='1.0' encoding='UTF-16'?><t>ä</t>",
        ] {
            assert_eq!(read(text.as_bytes()).unwrap(), text);
        }
        assert!(read(b"<?xml version='1.0' encoding='klingon'?><t/>").unwrap_err().1.contains("klingon"));
        assert_eq!(read(b"<t>\xe4</t>").unwrap_err().0, 3);
    }
}
