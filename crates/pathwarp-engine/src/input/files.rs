//! Input files: reading them, splitting references to parts of them, and describing files that are not drawings.

use super::gimp;
use crate::failure::Failure;
use crate::meter;
use crate::options::Reading;
use crate::output::folder;
use pathwarp::Error;
use pathwarp_svg::{Document, ReadOptions};
use std::fmt::Display;
use std::fs::{File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The first bytes of an XCF.
const XCF_MAGIC: &[u8] = b"gimp xcf ";

/// Returns `true` if `input` stands for standard input.
fn is_stdin(input: &Path) -> bool {
    input.as_os_str() == "-"
}

/// Returns the name of an input in messages and reports. A drawing in memory may have none.
pub fn display(input: &Path) -> String {
    match input.to_str() {
        Some("-") => "standard input".into(),
        Some("") => "the drawing".into(),
        _ => input.display().to_string(),
    }
}

/// Reads all bytes of a file or of standard input.
pub fn bytes(input: &Path) -> Result<Vec<u8>, Failure> {
    if !is_stdin(input) {
        let bytes = std::fs::read(input).map_err(|e| Failure::file(input, unreadable(input, &e)))?;
        meter::count_input(bytes.len());
        return Ok(bytes);
    }
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes).map_err(|e| Failure::Input(format!("standard input: {e}")))?;
    meter::count_input(bytes.len());
    if bytes.starts_with(XCF_MAGIC) {
        return Err(Failure::Input("standard input: an XCF cannot be read from it; name the file instead".into()));
    }
    Ok(bytes)
}

/// Reads a file once, if it begins unlike GIMP's files, as nearly all drawings and pictures do. `None` stands for a file that needs a
/// closer look, for standard input, and for a name that is no file.
pub(crate) fn ordinary_bytes(input: &Path) -> Result<Option<Vec<u8>>, Failure> {
    /// Spare capacity, so that the end is found without another allocation.
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
    // A pipe can be read only once, so it is not probed.
    if size.is_some() {
        let head = file.by_ref().take(gimp::HEAD as u64).read_to_end(&mut bytes);
        if head.is_err() || gimp::may_begin(&bytes) {
            return Ok(None);
        }
    }
    // Without `take`, `read_to_end` would ask for the size again.
    file.take(u64::MAX).read_to_end(&mut bytes).map_err(|e| unreadable(&e))?;
    meter::count_input(bytes.len());
    Ok(Some(bytes))
}

/// Reads an SVG document. Linked images are looked up relative to its folder.
pub fn document(input: &Path, reading: &Reading) -> Result<Document, Failure> {
    document_of(&bytes(input)?, input, reading)
}

/// Parses an SVG document. `input` is its name.
pub fn document_of(bytes: &[u8], input: &Path, reading: &Reading) -> Result<Document, Failure> {
    if bytes.starts_with(XCF_MAGIC) {
        let advice =
            "an XCF holds paths, not a drawing; `pathwarp paths` lists them, `pathwarp convert` copies them to an SVG";
        return Err(Failure::file(input, advice));
    }
    let read = Document::read(bytes, &display(input), &read_options(input, reading));
    read.map_err(|e| not_a_drawing(bytes, input, e.into()))
}

/// Replaces the failure to read a drawing by the file's actual kind, if that is known.
pub fn not_a_drawing(bytes: &[u8], input: &Path, failure: Failure) -> Failure {
    described(bytes, input).map_or(failure, |what| Failure::Input(format!("{}: {what}", display(input))))
}

/// Returns options for reading `input` as SVG: linked images are looked up relative to the folder `reading.base`, or else to its own.
pub fn read_options(input: &Path, reading: &Reading) -> ReadOptions {
    // A drawing in memory may have neither name nor folder.
    let folder_of_input = || input.parent().map(|_| folder(input).to_path_buf());
    reading.read_options().with_base_dir(reading.base.clone().or_else(folder_of_input))
}

/// Advice on what to do with files that are not SVG.
const AS_PICTURE: &str = "save it as PNG, JPEG or WebP, whose pixels are warped; for curves, trace it (Inkscape: Path › Trace Bitmap) and \
                          save that as SVG";
const AS_DRAWING: &str = "export it as SVG from the program that made it";
const AS_MODEL: &str = "`pathwarp solid` deforms models: STL, OBJ, PLY and glTF";
const PDF: &str = "export SVG instead, from Illustrator (File › Export › SVG) or Inkscape, or convert it: pdftocairo -svg FILE OUT.svg";
const POSTSCRIPT: &str = "export SVG instead, or open it in Inkscape and save it as SVG";
const FONT: &str = "set words in it: pathwarp text 'Words' --font FILE -o words.svg";

/// Kinds of files by bytes at an offset: a description, and advice. The first match counts.
const MAGIC: [(usize, &[u8], &str, &str); 39] = [
    (0, b"%PDF", "a PDF", PDF),
    (0, b"%!PS", "PostScript (EPS)", POSTSCRIPT),
    (0, b"\xc5\xd0\xd3\xc6", "an EPS with a preview", POSTSCRIPT),
    (0, b"\x89PNG", "a PNG picture", "this command takes drawings; deformations warp pictures, too"),
    (0, b"\xff\xd8\xff", "a JPEG picture", "this command takes drawings; deformations warp pictures, too"),
    (8, b"WEBP", "a WebP picture", "this command takes drawings; deformations warp pictures, too"),
    (0, b"GIF8", "a GIF picture", AS_PICTURE),
    (0, b"II*\0", "a TIFF picture", AS_PICTURE),
    (0, b"MM\0*", "a TIFF picture", AS_PICTURE),
    (0, b"8BPS", "a Photoshop document", AS_PICTURE),
    (4, b"ftyphei", "a HEIC photograph", AS_PICTURE),
    (4, b"ftypmif1", "a HEIC photograph", AS_PICTURE),
    (4, b"ftypavif", "an AVIF picture", AS_PICTURE),
    (4, b"ftyp", "a video", "save one of its pictures as PNG"),
    (0, b"\xff\x0a", "a JPEG XL picture", AS_PICTURE),
    (0, b"\0\0\0\x0cJXL ", "a JPEG XL picture", AS_PICTURE),
    (0, b"\0\0\x01\0", "an icon (ICO)", AS_PICTURE),
    (0, b"\0\x01\0\0", "a font", FONT),
    (0, b"OTTO", "a font", FONT),
    (0, b"true\0", "a font", FONT),
    (0, b"ttcf", "a collection of fonts", FONT),
    (
        0,
        b"wOF",
        "a font for web pages",
        "set words in it as .ttf or .otf: pathwarp text 'Words' --font FILE -o words.svg",
    ),
    (8, b"CDR", "a CorelDRAW document", AS_DRAWING),
    (8, b"cdr", "a CorelDRAW document", AS_DRAWING),
    (0, b"\0\xffKA", "an Affinity document", AS_DRAWING),
    (0, b"AC10", "an AutoCAD drawing (DWG)", AS_DRAWING),
    (0, b"AutoCAD Binary DXF", "a DXF", AS_DRAWING),
    (0, b"fig-kiwi", "a Figma document", AS_DRAWING),
    (40, b" EMF", "a Windows metafile (EMF)", AS_DRAWING),
    (0, b"\xd7\xcd\xc6\x9a", "a Windows metafile (WMF)", AS_DRAWING),
    (0, b"glTF", "a 3D model (glTF)", AS_MODEL),
    (0, b"ply\n", "a 3D model (PLY)", AS_MODEL),
    (0, b"ply\r", "a 3D model (PLY)", AS_MODEL),
    (0, b"solid ", "a 3D model (STL)", AS_MODEL),
    (0, b"PK\x03\x04", "an archive (ZIP)", "unpack it and name the drawing in it"),
    (0, b"7z\xbc\xaf", "an archive (7z)", "unpack it and name the drawing in it"),
    (0, b"Rar!", "an archive (RAR)", "unpack it and name the drawing in it"),
    (257, b"ustar", "an archive (tar)", "unpack it and name the drawing in it"),
    (0, b"BM", "a BMP picture", AS_PICTURE),
];

/// Describes a file that cannot be read as SVG, with advice; `None` for text that might be meant as SVG.
pub fn described(bytes: &[u8], name: &Path) -> Option<String> {
    let extension = name.extension().map(|e| e.to_ascii_lowercase().to_string_lossy().into_owned());
    let extension = extension.as_deref().unwrap_or_default();
    let has = |offset: usize, magic: &[u8]| bytes.get(offset..).is_some_and(|rest| rest.starts_with(magic));
    // Documents of drawing programs contain PDF or archives.
    let known =
        MAGIC.iter().find(|(offset, magic, ..)| has(*offset, magic)).map(|(_, magic, what, advice)| match extension {
            "ai" if magic.starts_with(b"%") => ("an Illustrator document", PDF),
            "cdr" | "sketch" | "odg" | "odt" | "docx" | "pptx" | "xd" | "kra" | "afdesign" | "fig"
                if magic.starts_with(b"PK") =>
            {
                ("a document of another program", AS_DRAWING)
            }
            _ => (*what, *advice),
        });
    if let Some((what, advice)) = known {
        return Some(format!("is {what}, not an SVG drawing; {advice}"));
    }
    let text = bytes.trim_ascii_start();
    if text.is_empty() {
        return Some("is empty; it has to hold a drawing (SVG)".to_owned());
    }
    let head = String::from_utf8_lossy(&text[..text.len().min(HEAD)]);
    let lines: Vec<&str> = head.lines().map(str::trim).take(2).collect();
    let lower = head.to_lowercase();
    if lines == ["0", "SECTION"] || lines.first() == Some(&"999") {
        return Some(format!("is a DXF, not an SVG drawing; {AS_DRAWING}, or open it in Inkscape and save it as SVG"));
    }
    if lower.starts_with("<!doctype html") || lower.starts_with("<html") {
        return Some(
            "is a web page, not an SVG drawing; download the drawing itself (its address ends in .svg)".to_owned(),
        );
    }
    if ["png", "jpg", "jpeg", "webp"].contains(&extension) && !text.starts_with(b"<") {
        return Some(
            "does not begin as a PNG, JPEG or WebP picture: it is damaged, or something else; get a whole copy of it"
                .to_owned(),
        );
    }
    if text.starts_with(b"<") || bytes.contains(&b'<') || bytes.contains(&0) {
        return None;
    }
    std::str::from_utf8(bytes).ok()?;
    let advice = match extension {
        "txt" | "md" => "set it as outlines: pathwarp text --file FILE -o words.svg",
        "toml" => "a recipe is run: pathwarp run FILE DRAWING.svg -o OUT.svg",
        "obj" => AS_MODEL,
        _ => "a drawing begins with <svg",
    };
    Some(format!("is plain text, not an SVG drawing; {advice}"))
}

/// Number of bytes at the beginning of a text that show its kind.
const HEAD: usize = 200;

/// Describes why a name cannot be opened as a file.
pub fn unreadable(name: &Path, e: &io::Error) -> String {
    if e.kind() != ErrorKind::NotFound {
        return format!("cannot be read: {e}");
    }
    "there is no such file".to_owned() + &likely_meaning(name).map(|advice| format!("; {advice}")).unwrap_or_default()
}

/// Guesses what a name that is no file was meant to be.
fn likely_meaning(name: &Path) -> Option<String> {
    let text = name.to_str()?;
    let lower = text.to_lowercase();
    if lower.starts_with("file://") {
        return Some(format!("write the path itself: {}", text["file://".len()..].replace("%20", " ")));
    }
    if ["http:", "https:", "ftp:"].iter().any(|s| lower.starts_with(s)) || lower.starts_with("www.") {
        return Some(format!("it is an address; download the drawing first: curl -O '{}'", address(text)));
    }
    if text.starts_with("~/") {
        return Some("the shell replaces ~ only outside of quotes; write \"$HOME/…\"".to_owned());
    }
    if text.starts_with('$') || (text.starts_with('%') && text[1..].contains('%')) {
        return Some("the variable in it was not replaced; this shell may write it in another way".to_owned());
    }
    if let (false, [letter @ (b'a'..=b'z' | b'A'..=b'Z'), b':', ..]) = (cfg!(windows), text.as_bytes()) {
        let (drive, rest) = (char::from(letter.to_ascii_lowercase()), text[2..].replace('\\', "/"));
        return Some(format!("it is a path of Windows; in WSL, write /mnt/{drive}{rest}"));
    }
    let slashes = text.replace('\\', "/");
    if slashes != text && Path::new(&slashes).exists() {
        return Some(format!("write {slashes}"));
    }
    if text.contains(['*', '?']) {
        return Some("no file matches the pattern, or quotes keep the shell from replacing it; -r takes all drawings of a folder".to_owned());
    }
    similar_file(name)
}

/// Restores the scheme of an address that MSYS or a shell has squeezed.
fn address(text: &str) -> String {
    if text.contains("://") || !text.contains(':') { text.to_owned() } else { text.replacen(":/", "://", 1) }
}

/// Finds a file beside `name` that differs in case, extension or a letter.
fn similar_file(name: &Path) -> Option<String> {
    /// Most entries of a folder that are compared.
    const MOST: usize = 2000;
    /// Least similarity of names, from 0 to 1.
    const LEAST: f64 = 0.9;
    let wanted = name.file_name()?.to_string_lossy().to_lowercase();
    let folder = folder(name);
    if !folder.is_dir() {
        return Some(format!("the folder {} does not exist either", folder.display()));
    }
    let names = std::fs::read_dir(folder).ok()?.take(MOST).filter_map(|e| e.ok()?.file_name().into_string().ok());
    let stem = |name: &str| Path::new(name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let similarity = |name: &str| {
        let name = name.to_lowercase();
        if stem(&name) == stem(&wanted) { 1.0 } else { strsim::jaro_winkler(&name, &wanted) }
    };
    let all = names.filter(|n| !n.starts_with('.')).map(|n| (similarity(&n), n));
    let best = all.min_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    let (_, best) = best.filter(|(similarity, _)| *similarity >= LEAST)?;
    Some(format!("did you mean {}?", name.with_file_name(best).display()))
}

/// Reads the text of a file for a parameter of kind `File` or `NameOrFile`: TOML becomes JSON, a Photoshop file becomes its warps in JSON,
/// and any other text stays.
pub fn read_data_file(file: &str) -> Result<String, Error> {
    let wrong = |what: String| Error::input(file, what);
    let bytes = std::fs::read(file).map_err(|e| wrong(unreadable(Path::new(file), &e)))?;
    let extension = Path::new(file).extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    if matches!(extension.as_deref(), Some("psd" | "psb")) {
        let warps = pathwarp_psd::warps(&bytes).map_err(|e| wrong(e.to_string()))?;
        return serde_json::to_string(&warps).map_err(|e| wrong(e.to_string()));
    }
    let text = String::from_utf8(bytes)
        .map_err(|e| wrong(format!("is not UTF-8 text (byte {})", e.utf8_error().valid_up_to())))?;
    if extension.as_deref() == Some("toml") {
        let table: toml::Table = toml::from_str(&text).map_err(|e| wrong(format!("is not valid TOML: {e}")))?;
        return serde_json::to_string(&table).map_err(|e| wrong(e.to_string()));
    }
    Ok(text)
}

/// Splits `FILE#NAME`, both of which may contain a `#`. The name starts after the first `#` that an existing file precedes, else after the
/// last one.
pub fn split_reference(reference: &str) -> (PathBuf, Option<&str>) {
    if Path::new(reference).is_file() {
        return (reference.into(), None);
    }
    let cuts: Vec<usize> = reference.match_indices('#').map(|(i, _)| i).collect();
    let cut = cuts.iter().find(|&&i| Path::new(&reference[..i]).is_file()).or(cuts.last());
    match cut {
        Some(&i) => (reference[..i].into(), Some(&reference[i + 1..])),
        None => (reference.into(), None),
    }
}

/// Returns the error for `#NAME` where no input document can hold it.
pub fn no_document(name: &str) -> Error {
    Error::input(format!("#{name}"), "there is no input document to find the path in")
}

/// Returns `true` if `path` has the name of an XCF, packed or not.
pub(super) fn is_named_xcf(path: &Path) -> bool {
    let name = path.to_string_lossy().to_ascii_lowercase();
    [".xcf", ".xcf.gz", ".xcf.bz2", ".xcf.xz"].iter().any(|e| name.ends_with(e))
}
