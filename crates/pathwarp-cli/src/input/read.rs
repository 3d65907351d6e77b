//! Reads input files, and standard input for `-`.

use super::foreign::{described, unreadable};
use super::gimp_file::is_named_xcf;
use crate::failure::Failure;
use crate::options::Reading;
use crate::watch;
use pathwarp_svg::{Document, ReadOptions};
use std::fmt::Display;
use std::fs::{File, Metadata};
use std::io::Read;
use std::path::{Path, PathBuf};

/// The first bytes of an XCF.
const XCF_MAGIC: &[u8] = b"gimp xcf ";

/// Returns `true` if `input` stands for standard input.
fn is_stdin(input: &Path) -> bool {
    input.as_os_str() == "-"
}

/// The name of an input in messages and reports. A drawing in memory may have none.
pub(crate) fn display(input: &Path) -> String {
    match input.to_str() {
        Some("-") => "standard input".into(),
        Some("") => "the drawing".into(),
        _ => input.display().to_string(),
    }
}

/// Reads all bytes of a file or of standard input.
pub(crate) fn bytes(input: &Path) -> Result<Vec<u8>, Failure> {
    if !is_stdin(input) {
        let bytes = std::fs::read(input).map_err(|e| Failure::file(input, unreadable(input, &e)))?;
        watch::count_input(bytes.len());
        return Ok(bytes);
    }
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes).map_err(|e| Failure::Input(format!("standard input: {e}")))?;
    watch::count_input(bytes.len());
    if bytes.starts_with(XCF_MAGIC) {
        return Err(Failure::Input("standard input: reading an XCF requires seeking; name the file instead".into()));
    }
    Ok(bytes)
}

/// The bytes of a file that begins unlike any of GIMP's, as nearly all drawings and pictures do; opened and read once. `None`: of
/// a file that needs a closer look, of standard input, and of a name that is no file.
pub(crate) fn ordinary_bytes(input: &Path) -> Result<Option<Vec<u8>>, Failure> {
    /// Room to find the end without another allocation.
    const ROOM: usize = 64;
    if is_stdin(input) || is_named_xcf(input) {
        return Ok(None);
    }
    let Ok(mut file) = File::open(input) else { return Ok(None) };
    let size = file.metadata().ok().filter(Metadata::is_file).map(|m| m.len());
    let unreadable = |e: &dyn Display| Failure::file(input, format!("cannot be read: {e}"));
    let room = usize::try_from(size.unwrap_or_default()).unwrap_or(usize::MAX).saturating_add(ROOM);
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(room).map_err(|e| unreadable(&e))?;
    // A pipe is not probed: it can be read only once.
    if size.is_some() {
        let head = file.by_ref().take(pathwarp_gimp::HEAD as u64).read_to_end(&mut bytes);
        if head.is_err() || pathwarp_gimp::may_begin(&bytes) {
            return Ok(None);
        }
    }
    // Without a limit, the size would be asked for again.
    file.take(u64::MAX).read_to_end(&mut bytes).map_err(|e| unreadable(&e))?;
    watch::count_input(bytes.len());
    Ok(Some(bytes))
}

/// Reads an SVG document. Linked images are looked up relative to its folder.
pub(crate) fn document(input: &Path, reading: &Reading) -> Result<Document, Failure> {
    document_of(&bytes(input)?, input, reading)
}

/// Reads an SVG document with this content. `input` is its name.
pub(crate) fn document_of(bytes: &[u8], input: &Path, reading: &Reading) -> Result<Document, Failure> {
    if bytes.starts_with(XCF_MAGIC) {
        let advice =
            "an XCF holds paths, not a drawing; `pathwarp paths` lists them, `pathwarp convert` copies them to an SVG";
        return Err(Failure::file(input, advice));
    }
    let read = Document::read(bytes, &display(input), &read_options(input, reading));
    read.map_err(|e| not_a_drawing(bytes, input, e.into()))
}

/// The failure to read a drawing: what the file is instead, if that is known.
pub(crate) fn not_a_drawing(bytes: &[u8], input: &Path, failure: Failure) -> Failure {
    described(bytes, input).map_or(failure, |what| Failure::Input(format!("{}: {what}", display(input))))
}

/// Options for reading `input` as SVG: linked images are looked up relative to its folder.
pub(crate) fn read_options(input: &Path, reading: &Reading) -> ReadOptions {
    let own = || match input.parent() {
        Some(p) if p.as_os_str().is_empty() => Some(PathBuf::from(".")),
        other => other.map(Path::to_path_buf),
    };
    let folder = reading.base.clone().or_else(own);
    reading.read_options().with_base_dir(folder)
}
