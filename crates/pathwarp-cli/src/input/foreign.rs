//! Files that are not drawings, and names that are not files: what they are, and what to do instead.

use std::io::{Error, ErrorKind};
use std::path::Path;

/// Advice for pictures that are not warped as they are.
const AS_PICTURE: &str = "save it as PNG, JPEG or WebP, whose pixels are warped; for curves, trace it (Inkscape: Path › Trace Bitmap) and \
                          save that as SVG";
const AS_DRAWING: &str = "export it as SVG from the program that made it";
const AS_MODEL: &str = "`pathwarp solid` deforms models: STL, OBJ, PLY and glTF";
const PDF: &str = "export SVG instead, from Illustrator (File › Export › SVG) or Inkscape, or convert it: pdftocairo -svg FILE OUT.svg";
const POSTSCRIPT: &str = "export SVG instead, or open it in Inkscape and save it as SVG";
const FONT: &str = "set words in it: pathwarp text 'Words' --font FILE -o words.svg";

/// Kinds of files by bytes at a place: what such a file is, and what to do instead.
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

/// What a file is that cannot be read as SVG, and what to do about it; `None` if it is text that might be meant as SVG.
pub(crate) fn described(bytes: &[u8], name: &Path) -> Option<String> {
    let extension = name.extension().map(|e| e.to_ascii_lowercase().to_string_lossy().into_owned());
    let extension = extension.as_deref().unwrap_or_default();
    let starts = |at: usize, magic: &[u8]| bytes.get(at..).is_some_and(|rest| rest.starts_with(magic));
    // Documents of drawing programs are PDF or archives inside.
    let known =
        MAGIC.iter().find(|(at, magic, ..)| starts(*at, magic)).map(|(_, magic, what, advice)| match extension {
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

/// Bytes at the beginning of a text that show what it is.
const HEAD: usize = 200;

/// The problem with a name that cannot be opened as a file.
pub(crate) fn unreadable(name: &Path, e: &Error) -> String {
    if e.kind() != ErrorKind::NotFound {
        return format!("cannot be read: {e}");
    }
    "there is no such file".to_owned() + &absent(name).map(|advice| format!("; {advice}")).unwrap_or_default()
}

/// What may be meant by a name that is no file.
fn absent(name: &Path) -> Option<String> {
    let text = name.to_str()?;
    let lower = text.to_lowercase();
    if let Some(path) = lower.starts_with("file://").then(|| &text["file://".len()..]) {
        return Some(format!("write the path itself: {}", path.replace("%20", " ")));
    }
    if ["http:", "https:", "ftp:"].iter().any(|s| lower.starts_with(s)) || lower.starts_with("www.") {
        return Some(format!("it is an address; download the drawing first: curl -O '{}'", address(text)));
    }
    if text.starts_with("~/") {
        return Some("the shell replaces ~ only outside of quotes; write \"$HOME/…\"".to_owned());
    }
    if text.starts_with('%') && text[1..].contains('%') || text.starts_with("$env:") || text.starts_with('$') {
        return Some("the variable in it was not replaced; this shell may write it in another way".to_owned());
    }
    let drive = text.as_bytes().get(1) == Some(&b':') && text.as_bytes()[0].is_ascii_alphabetic();
    if !cfg!(windows) && drive {
        let rest = text[2..].replace('\\', "/");
        let below = lower.chars().next().unwrap_or('c');
        return Some(format!("it is a path of Windows, which WSL calls /mnt/{below}{rest}"));
    }
    let slashes = text.replace('\\', "/");
    if slashes != text && Path::new(&slashes).exists() {
        return Some(format!("write {slashes}"));
    }
    if text.contains(['*', '?']) {
        return Some("no file matches the pattern, or quotes keep the shell from replacing it; -r takes all drawings of a folder".to_owned());
    }
    near(name)
}

/// The address with its scheme, as MSYS and shells may have squeezed it.
fn address(text: &str) -> String {
    if text.contains("://") || !text.contains(':') { text.to_owned() } else { text.replacen(":/", "://", 1) }
}

/// A file beside `name` that differs in case, extension or a letter.
fn near(name: &Path) -> Option<String> {
    /// Entries of a folder that are looked at.
    const MOST: usize = 2000;
    /// Least likeness of names.
    const LIKELY: f64 = 0.9;
    let wanted = name.file_name()?.to_string_lossy().to_lowercase();
    let folder = name.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Some(format!("the folder {} does not exist either", folder.display()));
    }
    let names = std::fs::read_dir(folder).ok()?.take(MOST).filter_map(|e| e.ok()?.file_name().into_string().ok());
    let stem = |name: &str| Path::new(name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let likeness = |n: &str| {
        let n = n.to_lowercase();
        if stem(&n) == stem(&wanted) { 1.0 } else { strsim::jaro_winkler(&n, &wanted) }
    };
    let mut all: Vec<(f64, String)> = names.filter(|n| !n.starts_with('.')).map(|n| (likeness(&n), n)).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    let (_, best) = all.into_iter().next().filter(|(likeness, _)| *likeness >= LIKELY)?;
    Some(format!("did you mean {}?", name.with_file_name(best).display()))
}
