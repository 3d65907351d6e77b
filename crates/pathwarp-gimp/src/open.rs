//! Detects the format of a file, decompresses it if needed, and reads its paths.

use crate::error::{Error, ErrorKind};
use crate::path::{FileKind, PathFile, Salvaged};
use crate::source::{ByteSource, ReadSeek, length};
use crate::{point_list, svg, text, xcf};
use pathwarp::budget::Limits;
use std::io::{Read, Seek};

/// Reads the paths of a file, seeking past everything else, within the default limits.
///
/// # Errors
/// [`ErrorKind::UnknownFormat`], [`ErrorKind::Damaged`] or [`ErrorKind::Io`], for instance; the error contains the byte offset.
pub fn open(file: impl Read + Seek) -> Result<PathFile, Error> {
    let salvaged = salvage(file)?;
    salvaged.damage.map_or(Ok(salvaged.file), Err)
}

/// Reads the paths of a file within the default limits. If an XCF or a text is damaged, returns the paths before the damage.
///
/// # Errors
/// [`ErrorKind::UnknownFormat`] for other files, [`ErrorKind::Damaged`] and others when nothing can be read.
pub fn salvage(file: impl Read + Seek) -> Result<Salvaged, Error> {
    salvage_within(file, &Limits::default())
}

/// Reads the paths of a file, or those before any damage, within limits for its size. They apply to the bytes of text and of paths,
/// and to the unpacked bytes of compressed files, in which paths lie among pictures.
///
/// # Errors
/// [`ErrorKind::UnknownFormat`] for other files, [`ErrorKind::Damaged`] and others when nothing can be read.
pub fn salvage_within(mut file: impl Read + Seek, limits: &Limits) -> Result<Salvaged, Error> {
    let file: &mut dyn ReadSeek = &mut file;
    let packing = packing(&head(file)?);
    let mut input = unpacked(file, packing, limits)?;
    let head = input.peek(HEAD)?;
    if head.is_empty() {
        return Err(Error::new(ErrorKind::UnknownFormat, 0, "the file is empty"));
    }
    if head.starts_with(xcf::MAGIC) {
        let mut xcf = xcf::Xcf::default();
        let damage = xcf::read(&mut input, &mut xcf).err();
        let kind = if packing == Packing::None { FileKind::Xcf } else { FileKind::PackedXcf };
        // Without even a size there is nothing to salvage.
        if let (Some(e), 0) = (&damage, xcf.width) {
            return Err(e.clone());
        }
        let size = Some([f64::from(xcf.width), f64::from(xcf.height)]);
        let paths = xcf.records.into_iter().map(|r| r.path).collect();
        return Ok(Salvaged { file: PathFile { kind: kind(xcf.version), size, paths }, damage });
    }
    let undamaged = |file| Salvaged { file, damage: None };
    match first_byte(&head) {
        Some(b'<') => svg::read(&input.text()?).map(undamaged),
        Some(b'{') => point_list::read(&input.text()?).map(undamaged),
        _ if head.starts_with(text::FIRST) => {
            let mut file = PathFile { kind: FileKind::Text, size: None, paths: Vec::new() };
            let damage = text::read(&input.text()?, &mut file.paths).err();
            Ok(Salvaged { file, damage })
        }
        _ => Err(Error::new(ErrorKind::UnknownFormat, 0, "not a file of GIMP: neither XCF, SVG, JSON nor GIMP 1 text")),
    }
}

/// The compression of a file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Packing {
    None,
    Gzip,
    Bzip2,
    Xz,
}

/// Detects the compression from the first bytes.
fn packing(head: &[u8]) -> Packing {
    match head {
        [0x1f, 0x8b, ..] => Packing::Gzip,
        [b'B', b'Z', b'h', ..] => Packing::Bzip2,
        [0xfd, b'7', b'z', b'X', b'Z', 0, ..] => Packing::Xz,
        _ => Packing::None,
    }
}

/// Wraps a file in the decoder it needs.
fn unpacked<'a>(file: &'a mut dyn ReadSeek, packing: Packing, limits: &Limits) -> Result<ByteSource<'a>, Error> {
    let limits = limits.for_input(usize::try_from(length(file)?).unwrap_or(usize::MAX));
    Ok(match packing {
        Packing::None => ByteSource::file(file, limits)?,
        Packing::Gzip => ByteSource::stream(flate2::read::MultiGzDecoder::new(file), limits),
        Packing::Bzip2 => ByteSource::stream(bzip2::read::MultiBzDecoder::new(file), limits),
        Packing::Xz => ByteSource::stream(lzma_rust2::XzReader::new_mem_limit(file, true, XZ_MEMORY_KIB), limits),
    })
}

/// Returns the first bytes of a file.
fn head(file: &mut dyn ReadSeek) -> Result<Vec<u8>, Error> {
    ByteSource::file(file, Limits::none())?.peek(HEAD)
}

/// Number of bytes that identify a file, including the declarations of an SVG.
pub const HEAD: usize = 512;

/// Memory limit for xz in KiB; its highest preset needs 65 MiB.
const XZ_MEMORY_KIB: u32 = 96 << 10;

/// Returns the first byte after white space and a byte-order mark.
fn first_byte(head: &[u8]) -> Option<u8> {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    head.iter().copied().find(|b| !b.is_ascii_whitespace())
}

/// A quick test for [`sniff`]: returns `false` if a file that begins with `head` certainly holds no paths of GIMP. `head` is the first
/// [`HEAD`] bytes, or the whole file.
#[must_use]
pub fn may_begin(head: &[u8]) -> bool {
    packing(head) != Packing::None
        || head.starts_with(xcf::MAGIC)
        || head.starts_with(text::FIRST)
        || match first_byte(head) {
            Some(b'<') => svg::may_be_export(head),
            first => first == Some(b'{'),
        }
}

/// Returns `true` if a file holds paths of GIMP: an XCF, GIMP 1 text, a valid point list, or an SVG as GIMP exports it.
#[must_use]
pub fn sniff(mut file: impl Read + Seek) -> bool {
    let file: &mut dyn ReadSeek = &mut file;
    let Ok(start) = head(file) else { return false };
    let Ok(mut input) = unpacked(file, packing(&start), &Limits::default()) else { return false };
    let Ok(head) = input.peek(HEAD) else { return false };
    if head.starts_with(xcf::MAGIC) || head.starts_with(text::FIRST) {
        return true;
    }
    match first_byte(&head) {
        Some(b'<') => svg::may_be_export(&head) && input.text().is_ok_and(|t| svg::is_export(&t)),
        Some(b'{') => input.text().is_ok_and(|t| point_list::read(&t).is_ok()),
        _ => false,
    }
}
