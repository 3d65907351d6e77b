//! Loads the images of a drawing: bitmaps and drawings, embedded and linked. All share the budget of the drawing, and links are followed
//! only if the user allows it.

use super::check;
use super::links::{Target, read_linked, target};
use super::read::{self, ReadOptions};
use super::text::to_plain;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Crc;
use flate2::read::ZlibDecoder;
use pathwarp::Error;
use pathwarp::budget::{Exceeded, Limit};
use std::collections::BTreeSet;
use std::io::{self, Read as _};
use std::sync::{Arc, Mutex};

const DATA: &str = "data:";
const BASE64: &str = ";base64,";

/// Bytes of a decoded pixel. A file is charged only for its bytes in excess of its decoded pixels.
const PIXEL: f64 = 4.0;

/// Names that were requested and not found.
pub(crate) type Missing = Arc<Mutex<BTreeSet<String>>>;

/// Links that were not followed.
#[derive(Debug, Clone, Default)]
pub(super) struct Unread {
    pub(super) images: Missing,
    /// The links out of the folder.
    pub(super) outside: Missing,
}

/// Media type of data whose format is detected from its content.
pub(super) const ANY: &str = "text/plain";
/// Media type given to embedded data without one (usvg: `text/plain`). Its format is detected, but a drawing has to declare its type.
const EMBEDDED: &str = "";

/// A transparent pixel in place of a picture that was not read, so that its element is still warped.
const NOTHING: &[u8] =
    b"\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x01\x00\x00\x00\x01\x08\x06\x00\x00\
    \x00\x1f\x15\xc4\x89\x00\x00\x00\x0b\x49\x44\x41\x54\x78\xda\x63\x60\x00\x02\x00\x00\x05\x00\x01\xe9\xfa\xdc\xd8\
    \x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82";

/// Returns `true` if an image is the placeholder for one that was not read.
pub(crate) fn is_unread(image: &usvg::ImageKind) -> bool {
    matches!(image, usvg::ImageKind::PNG(data) if data.as_slice() == NOTHING)
}

/// The placeholder for an image that was not read.
fn nothing() -> usvg::ImageKind {
    usvg::ImageKind::PNG(Arc::new(NOTHING.to_vec()))
}

/// The error of the first image that exceeds the limits.
pub(super) type Rejected = Arc<Mutex<Option<Error>>>;

/// A resolver of images within the limits of the drawing.
pub(super) fn resolver<'a>(
    name: &'a str,
    options: &'a ReadOptions,
    rejected: &Rejected,
    unread: &Unread,
) -> usvg::ImageHrefResolver<'a> {
    let [unread_data, unread_files] = [unread.clone(), unread.clone()];
    let record = |unread: &Missing, link: String| {
        if let Ok(mut links) = unread.lock() {
            links.insert(link);
        }
    };
    let rejected = rejected.clone();
    let decode = usvg::ImageHrefResolver::default_data_resolver();
    let load = Arc::new(move |mime: &str, data: Arc<Vec<u8>>, what: &str, usvg: &usvg::Options<'_>| {
        match checked(mime, data, &format!("{name}: {what}"), options) {
            // As in browsers, the content determines the format, and metadata may turn the pixels.
            Ok(data) if mime == SVG => decode(mime, data?, usvg),
            Ok(data) => {
                let data = data?;
                let turned = options.turned.and_then(|turned| turned(&data, &options.budget.limits()));
                decode(ANY, turned.map_or(data, Arc::new), usvg)
            }
            Err(e) => {
                if let Ok(mut r) = rejected.lock() {
                    r.get_or_insert(e);
                }
                None
            }
        }
    });
    let load_file = load.clone();
    usvg::ImageHrefResolver {
        resolve_data: Box::new(move |mime, data, usvg| {
            let known = if mime == ANY { EMBEDDED } else { mime };
            // Browsers do not decompress embedded drawings.
            let packed = data.starts_with(read::GZIP);
            let image = if packed { None } else { load(known, data.clone(), "the picture in an image", usvg) };
            image.or_else(|| {
                record(&unread_data.images, embedded(mime, &data));
                Some(nothing())
            })
        }),
        resolve_string: Box::new(move |link, usvg| {
            let found = target(link, options);
            if matches!(found, Target::Outside) {
                record(&unread_files.outside, link.to_owned());
            }
            let data = if let Target::File(file) = found { read_linked(&file, options) } else { None };
            let image = data.and_then(|data| load_file(ANY, Arc::new(data), link, usvg));
            image.or_else(|| {
                record(&unread_files.images, link.to_owned());
                Some(nothing())
            })
        }),
    }
}

/// Media type of drawings.
pub(super) const SVG: &str = "image/svg+xml";

/// Charges an image to the budget, and returns it; a drawing is resolved into plain SVG for usvg. Returns `None` for damaged images.
pub(super) fn checked(
    mime: &str,
    data: Arc<Vec<u8>>,
    place: &str,
    options: &ReadOptions,
) -> Result<Option<Arc<Vec<u8>>>, Error> {
    let budget = &options.budget;
    let profile = unpacked_profile(&data, budget.room(Limit::Bytes) as u64);
    let take = |bytes: f64| {
        let counted = budget.take(Limit::Bytes, bytes.max(0.0) + profile as f64).map_err(Exceeded::cut_short);
        counted.map_err(|e| Error::limit(place, "with the images before it, it takes", e))
    };
    if mime != SVG {
        match imagesize::blob_size(&data) {
            Ok(_) if is_png_without_header(&data) => return Ok(None),
            Ok(size) => {
                let what = format!("with a picture of {} x {} pixels, its pictures take", size.width, size.height);
                let pixels = size.width as f64 * size.height as f64;
                budget.take(Limit::Pixels, pixels).map_err(|e| Error::limit(place, what, e))?;
                take(data.len() as f64 - PIXEL * pixels)?;
                return Ok(Some(data).filter(|data| !is_unreadable(data)));
            }
            Err(_) if mime != ANY => return Ok(None),
            Err(_) => {}
        }
    }
    take(0.0)?;
    let text = match read::text(&data, place, budget) {
        Ok(text) => text,
        Err(e @ Error::Input { limit: Some(_), .. }) => return Err(e),
        Err(_) => return Ok(None),
    };
    // Undeclared prefixes are errors, and drawings that this one links to are not read.
    let checked = to_plain(text, place, budget, None, &|_| None, |_, doc, _| {
        Ok(check::check_drawing(doc, place, budget).map(|_| Arc::new(doc.input_text().as_bytes().to_vec())))
    });
    match checked {
        Ok(checked) => checked.map(Some),
        Err(e @ Error::Input { limit: Some(_), .. }) => Err(e),
        Err(_) => Ok(None),
    }
}

/// Returns `true` if a PNG does not begin with its header, so that a size would be read from other bytes.
fn is_png_without_header(data: &[u8]) -> bool {
    data.starts_with(b"\x89PNG") && data.get(12..16) != Some(b"IHDR")
}

/// Reads the drawing to which an image links. As a file has no type, its name decides. Links in it are not followed.
pub(crate) fn linked_drawing(link: &str, options: &ReadOptions) -> Option<String> {
    let Target::File(file) = target(link, options) else { return None };
    file.extension().filter(|extension| extension.eq_ignore_ascii_case("svg"))?;
    read::decoded(read_linked(&file, options)?.into()).ok()
}

/// A link that embeds data.
pub(super) fn embedded(mime: &str, data: &[u8]) -> String {
    format!("{DATA}{mime}{BASE64}{}", STANDARD.encode(data))
}

/// Returns `true` if a link of the source is the one that was recorded. Embedded data may contain spaces.
pub(crate) fn is_same_link(link: &str, recorded: &str) -> bool {
    if link == recorded {
        return true;
    }
    let Some((head, _)) = recorded.split_once(BASE64).filter(|_| recorded.starts_with(DATA)) else { return false };
    if link.contains(BASE64) {
        return link.split_ascii_whitespace().collect::<String>() == recorded;
    }
    // Other encodings have many forms, so only the type is compared. That says too little about drawings, which often use them.
    link.starts_with(head) && !head.ends_with(SVG)
}

/// A link shortened for messages: embedded data to its type.
pub(crate) fn shown(link: &str) -> &str {
    link.split_once(BASE64).filter(|_| link.starts_with(DATA)).map_or(link, |(head, _)| head)
}

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Bytes of a chunk's length and name.
const HEAD: usize = 8;
/// Bytes of a chunk's checksum.
const CHECKSUM: usize = 4;

/// A chunk of a PNG.
struct Chunk<'a> {
    name: [u8; 4],
    content: &'a [u8],
    /// As stored; `None` if the file ends before the chunk does.
    checksum: Option<u32>,
}

impl Chunk<'_> {
    fn is_intact(&self) -> bool {
        let mut computed = Crc::new();
        computed.update(&self.name);
        computed.update(self.content);
        self.checksum == Some(computed.sum())
    }
}

/// The chunks of a PNG, of which the last may be incomplete; none of other data.
fn chunks(png: &[u8]) -> impl Iterator<Item = Chunk<'_>> {
    let mut rest = png.strip_prefix(SIGNATURE).unwrap_or_default();
    std::iter::from_fn(move || {
        let (&[a, b, c, d, e, f, g, h], after) = rest.split_first_chunk::<HEAD>()?;
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        let (content, next) = after.split_at(length.min(after.len()));
        let checksum = next.split_first_chunk::<CHECKSUM>();
        rest = checksum.map_or(&[], |(_, rest)| rest);
        Some(Chunk { name: [e, f, g, h], content, checksum: checksum.map(|(sum, _)| u32::from_be_bytes(*sum)) })
    })
}

/// The unpacked size of a PNG's colour profile in bytes, counted up to one more than `max`. Decoders unpack the profile whenever they
/// open the file.
pub(super) fn unpacked_profile(png: &[u8], max: u64) -> u64 {
    let mut before_pixels = chunks(png).take_while(|c| &c.name != b"IDAT");
    let Some(Chunk { content, .. }) = before_pixels.find(|c| &c.name == b"iCCP") else { return 0 };
    // The name, a zero byte and the compression method precede the data.
    let Some(end) = content.iter().position(|b| *b == 0) else { return 0 };
    unpacked_size(content.get(end + 2..).unwrap_or_default(), max.saturating_add(1))
}

/// The number of bytes that can be unpacked before an error or the end, up to `max`.
fn unpacked_size(packed: &[u8], max: u64) -> u64 {
    let mut unpacked = ZlibDecoder::new(packed).take(max);
    let _ = io::copy(&mut unpacked, &mut io::sink());
    max - unpacked.limit()
}

/// Returns `true` if a PNG is damaged or lacks pixels, or the first frame of a GIF is larger than its page. The renderer silently shows
/// nothing of these. Takes time in proportion to the number of pixels that the header states.
pub(super) fn is_unreadable(data: &[u8]) -> bool {
    let is_damaged = || chunks(data).any(|c| matches!(&c.name, b"IHDR" | b"PLTE" | b"IDAT") && !c.is_intact());
    let pixels = || chunks(data).filter(|c| &c.name == b"IDAT").flat_map(|c| c.content).copied().collect::<Vec<u8>>();
    let lacks_pixels = || pixel_bytes(data).is_some_and(|needed| unpacked_size(&pixels(), needed) < needed);
    (data.starts_with(SIGNATURE) && (is_damaged() || cuts_colors(data) || lacks_pixels()))
        || is_beyond_page(data).unwrap_or(false)
}

/// Returns `true` if the palette of an indexed PNG ends within a colour, which makes the decoder (png 0.18) panic.
fn cuts_colors(png: &[u8]) -> bool {
    let find = |name: &[u8; 4]| chunks(png).find(|c| &c.name == name).map(|c| c.content);
    let is_indexed = find(b"IHDR").is_some_and(|header| header.get(9) == Some(&3));
    is_indexed && find(b"PLTE").is_some_and(|colors| colors.len() % 3 != 0)
}

/// A lower bound on the size of a PNG's pixels in bytes, without the filter bytes of rows. `None` if the header is invalid.
fn pixel_bytes(png: &[u8]) -> Option<u64> {
    let header = chunks(png).find(|c| &c.name == b"IHDR")?.content;
    let (width, rest) = header.split_first_chunk::<4>()?;
    let (height, rest) = rest.split_first_chunk::<4>()?;
    let [depth, color_type, ..] = *rest else { return None };
    let channels = match color_type {
        0 | 3 => 1,
        4 => 2,
        2 => 3,
        6 => 4,
        _ => return None,
    };
    let [width, height] = [*width, *height].map(|n| u64::from(u32::from_be_bytes(n)));
    Some(width.checked_mul(height)?.checked_mul(u64::from(depth) * channels)? / 8)
}

/// Returns `true` if the first frame of a GIF is larger than its page; `None` for other files, and if there is no frame.
fn is_beyond_page(gif: &[u8]) -> Option<bool> {
    let size = |at: &[u8]| Some([0, 2].map(|i| u16::from_le_bytes([at[i], at[i + 1]]))).filter(|_| at.len() >= 4);
    let (head, mut rest) = gif.strip_prefix(b"GIF8")?.get(2..)?.split_at_checked(7)?;
    let page = size(head)?;
    // A palette follows, with its size in the flags.
    if head[4] & 0x80 != 0 {
        rest = rest.get(3 << ((head[4] & 7) + 1)..)?;
    }
    // Extensions, each of blocks with their lengths up to an empty one.
    while let Some(blocks) = rest.strip_prefix(b"!") {
        rest = blocks.get(1..)?;
        while *rest.first()? > 0 {
            rest = rest.get(usize::from(rest[0]) + 1..)?;
        }
        rest = &rest[1..];
    }
    let frame = size(rest.strip_prefix(b",")?.get(4..8)?)?;
    Some(frame[0] > page[0] || frame[1] > page[1])
}

#[cfg(test)]
mod tests;
