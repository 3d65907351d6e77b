//! Which kind of file it is, unpacked if need be, and its paths.

use crate::error::Error;
use crate::input::{Input, ReadSeek};
use crate::path::GimpPath;
use crate::{pdb, svg, text, xcf};
use std::io::{Read, Seek, SeekFrom};

/// The kinds of files that hold GIMP's paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// XCF of this version.
    Xcf(u32),
    /// An XCF of this version, packed by gzip, bzip2 or xz.
    PackedXcf(u32),
    /// SVG as GIMP exports it.
    Svg,
    /// Point lists as JSON.
    Json,
    /// GIMP 1's text.
    Text,
}

/// A file's paths.
#[derive(Debug, Clone, PartialEq)]
pub struct File {
    /// What it is.
    pub kind: Kind,
    /// Width and height of the canvas in pixels, where the file says.
    pub size: Option<[f64; 2]>,
    /// The paths, the topmost first.
    pub paths: Vec<GimpPath>,
}

/// What could be read of a file, and what is wrong with the rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Salvaged {
    /// The file, with the paths before the damage.
    pub file: File,
    /// The damage.
    pub damage: Option<Error>,
}

/// The most that packed data may unpack to before its paths have been read: a quarter of a minute of work.
const MOST_UNPACKED: u64 = 1 << 32;

/// Reads the paths of a file, seeking to what is needed.
///
/// # Errors
/// What is wrong with the file, and at which byte.
pub fn open(mut file: impl Read + Seek) -> Result<File, Error> {
    let found = dispatch(&mut file)?;
    found.damage.map_or(Ok(found.file), Err)
}

/// As [`open`], but a damaged XCF or text gives the paths before the damage.
///
/// # Errors
/// Nothing can be read at all: it is no file of GIMP's, or its head is damaged.
pub fn salvage(mut file: impl Read + Seek) -> Result<Salvaged, Error> {
    dispatch(&mut file)
}

/// How a file is packed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Packing {
    None,
    Gzip,
    Bzip2,
    Xz,
}

fn packing(head: &[u8]) -> Packing {
    match head {
        [0x1f, 0x8b, ..] => Packing::Gzip,
        [b'B', b'Z', b'h', ..] => Packing::Bzip2,
        [0xfd, b'7', b'z', b'X', b'Z', 0, ..] => Packing::Xz,
        _ => Packing::None,
    }
}

fn unpacked<'a>(file: &'a mut dyn ReadSeek, packing: Packing) -> Result<Input<'a>, Error> {
    Ok(match packing {
        Packing::None => Input::file(file)?,
        Packing::Gzip => Input::stream(flate2::read::MultiGzDecoder::new(file), MOST_UNPACKED),
        Packing::Bzip2 => Input::stream(bzip2::read::MultiBzDecoder::new(file), MOST_UNPACKED),
        Packing::Xz => Input::stream(lzma_rust2::XzReader::new_mem_limit(file, true, XZ_MEMORY_KIB), MOST_UNPACKED),
    })
}

fn head(file: &mut dyn ReadSeek) -> Result<Vec<u8>, Error> {
    Input::file(file)?.peek(HEAD)
}

/// As many bytes as tell what a file is: an SVG's declarations included.
const HEAD: usize = 512;

fn dispatch(file: &mut dyn ReadSeek) -> Result<Salvaged, Error> {
    let packing = packing(&head(file)?);
    file.seek(SeekFrom::Start(0)).map_err(|e| Error::at(0, e.to_string()))?;
    let mut input = unpacked(file, packing)?;
    let head = input.peek(HEAD)?;
    if head.is_empty() {
        return Err(Error::at(0, "the file is empty"));
    }
    if head.starts_with(xcf::MAGIC) {
        let mut xcf = xcf::Xcf::new();
        let damage = xcf::read(&mut input, &mut xcf).err();
        let kind = if packing == Packing::None { Kind::Xcf } else { Kind::PackedXcf };
        // Where not even the size was read, there is nothing to salvage.
        if let (Some(e), 0) = (&damage, xcf.width) {
            return Err(e.clone());
        }
        let size = Some([f64::from(xcf.width), f64::from(xcf.height)]);
        let paths = xcf.records.into_iter().map(|r| r.path).collect();
        return Ok(Salvaged { file: File { kind: kind(xcf.version), size, paths }, damage });
    }
    let whole = |file| Salvaged { file, damage: None };
    match first_sign(&head) {
        Some(b'<') => svg::read(&input.text()?).map(whole),
        Some(b'{') => pdb::read(&input.text()?).map(whole),
        _ if head.starts_with(text::FIRST) => {
            let mut file = File { kind: Kind::Text, size: None, paths: Vec::new() };
            let damage = text::read(&input.text()?, &mut file.paths).err();
            Ok(Salvaged { file, damage })
        }
        _ => Err(Error::at(0, "this is no file of GIMP's: neither XCF, nor SVG, nor JSON, nor a path of GIMP 1")),
    }
}

/// What xz may take to unpack: its highest preset needs 65 MiB.
const XZ_MEMORY_KIB: u32 = 96 << 10;

/// The first byte that is not a blank or a byte-order mark.
fn first_sign(head: &[u8]) -> Option<u8> {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    head.iter().copied().find(|b| !b.is_ascii_whitespace())
}

/// Whether a file holds GIMP's paths, by its first bytes; an SVG only if it is as GIMP exports it.
#[must_use]
pub fn sniff(mut file: impl Read + Seek) -> bool {
    let file: &mut dyn ReadSeek = &mut file;
    let Ok(start) = head(file) else { return false };
    if file.seek(SeekFrom::Start(0)).is_err() {
        return false;
    }
    let Ok(mut input) = unpacked(file, packing(&start)) else { return false };
    let Ok(head) = input.peek(HEAD) else { return false };
    if head.starts_with(xcf::MAGIC) || head.starts_with(text::FIRST) {
        return true;
    }
    match first_sign(&head) {
        Some(b'<') => svg::may_be_gimps(&head) && input.text().is_ok_and(|t| svg::is_gimps(&t)),
        Some(b'{') => input.text().is_ok_and(|t| pdb::read(&t).is_ok()),
        _ => false,
    }
}
