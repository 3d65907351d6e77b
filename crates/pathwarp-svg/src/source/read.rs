//! From bytes to text and to usvg's tree: unpacking, bounds, fonts, and a stack that is deep enough.

use crate::source::fontface;
use crate::source::fonts::{self, GenericFamilies, Missing};
use crate::source::text::{self as source, Source};
use crate::source::unfold;
use pathwarp::Error;
use std::borrow::Cow;
use std::fs::File;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use usvg::roxmltree;

/// How a file is read.
#[derive(Debug, Clone)]
pub struct ReadOptions {
    /// The folder that relative links to images start from; without it they are not followed.
    pub base_dir: Option<PathBuf>,
    /// Whether text may use the fonts installed on the machine (they are only read when there is text).
    pub system_fonts: bool,
    /// Further fonts: files, or folders of them.
    pub fonts: Vec<PathBuf>,
    /// What `serif`, `sans-serif` and so on stand for.
    pub generic_families: GenericFamilies,
    /// How many px make an inch.
    pub dpi: f32,
    /// The largest text, in bytes, that a compressed file may unpack to.
    pub max_size: usize,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            base_dir: None,
            system_fonts: true,
            fonts: Vec::new(),
            generic_families: GenericFamilies::default(),
            dpi: 96.0,
            max_size: 1 << 29,
        }
    }
}

/// The text of an SVG or svgz file.
pub(crate) fn text(data: &[u8], name: &str, options: &ReadOptions) -> Result<String, Error> {
    let mut bytes = Cow::Borrowed(data);
    if data.starts_with(&[0x1f, 0x8b]) {
        let mut out = Vec::new();
        let limit = options.max_size as u64 + 1;
        flate2::read::GzDecoder::new(data)
            .take(limit)
            .read_to_end(&mut out)
            .map_err(|e| Error::input(name, format!("the compressed data is damaged: {e}")))?;
        bytes = Cow::Owned(out);
    }
    if bytes.len() > options.max_size {
        return Err(Error::input(
            name,
            format!("more than {} bytes of text; that is more than is read", options.max_size),
        ));
    }
    String::from_utf8(bytes.into_owned()).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let hint = match e.as_bytes() {
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "this is UTF-16 text; save it as UTF-8",
            _ => "this is not UTF-8 text; save it as UTF-8",
        };
        Error::input(format!("{name}: byte {at}"), hint)
    })
}

/// The text of an SVG file as an svgz file: gzip, without time and name, so that equal texts give equal files.
///
/// # Errors
/// Whatever the compressor says; it writes to memory.
pub fn compressed(text: &str) -> std::io::Result<Vec<u8>> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    out.write_all(text.as_bytes())?;
    out.finish()
}

/// Whether a drawing nests so little that any stack holds it, and holds nothing that may break its readers. What is referred to may hold references in turn.
pub(crate) fn is_shallow(source: &Source) -> bool {
    /// Elements deep, references followed. A level takes a few kilobytes.
    const SHALLOW: usize = 80;
    let mut depths: Vec<usize> = Vec::with_capacity(source.elements.len());
    let mut references = 1;
    for e in &source.elements {
        depths.push(e.parent.map_or(0, |p| depths[p] + 1));
        let refers = matches!(e.tag.as_ref(), "use" | "clipPath" | "mask" | "pattern" | "marker" | "filter" | "image");
        references += usize::from(refers);
    }
    // Fonts that came with a file may be made to break what reads them; that is caught where the stack is deep.
    source.unpatchable.is_none()
        && !source.css.contains("@font-face")
        && depths.iter().max().is_none_or(|d| d * references <= SHALLOW)
}

/// Runs `f` with a stack for the deepest nesting that the parsers let through (1024 elements). A panic inside, which no known
/// file causes, becomes an error.
pub(crate) fn with_stack<T: Send>(name: &str, f: impl FnOnce() -> Result<T, Error> + Send) -> Result<T, Error> {
    const STACK: usize = 256 << 20;
    let gave_up = |why: &str| Error::input(name, format!("this drawing cannot be read: {why}"));
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, f);
        match thread {
            Ok(t) => t.join().unwrap_or_else(|_| Err(gave_up("the SVG library failed on it"))),
            Err(e) => Err(gave_up(&format!("no thread to read it on: {e}"))),
        }
    })
}

/// What a drawing asked for and did not get.
#[derive(Debug, Clone, Default)]
pub(crate) struct Missed {
    /// Font families.
    pub(crate) fonts: Vec<String>,
    /// Links to images; of embedded ones as far as their type.
    pub(crate) images: Vec<String>,
}

/// usvg's tree, and what was not found for it.
pub(crate) fn tree(
    xml: &roxmltree::Document<'_>,
    name: &str,
    options: &ReadOptions,
) -> Result<(usvg::Tree, Missed), Error> {
    let (missing, unread) = (Missing::default(), Missing::default());
    let text = xml.input_text();
    // Reading the machine's fonts takes longer than most drawings do. An embedded SVG image may hold text of its own.
    let (mut lettered, mut pictured, mut referring, mut markers) = (false, false, false, 0);
    for n in xml.descendants() {
        match n.tag_name().name() {
            "text" => lettered = true,
            "image" => pictured = true,
            "feImage" => (pictured, referring) = (true, true),
            "marker" => markers += 1,
            "use" | "pattern" | "clipPath" | "mask" => referring = true,
            _ => {}
        }
    }
    if unfold::may_be_large(xml, markers, referring) {
        unfold::check(xml, name)?;
    }
    lettered |= pictured && ["image/svg", ".svg"].iter().any(|t| text.contains(t));
    let base = if lettered {
        let fontdb = fontface::add(fonts::database(options.system_fonts, &options.fonts), text);
        let font_resolver = fonts::resolver(options.generic_families.clone(), missing.clone());
        usvg::Options { fontdb, font_resolver, ..usvg::Options::default() }
    } else {
        usvg::Options::default()
    };
    let mut usvg = usvg::Options { resources_dir: options.base_dir.clone(), dpi: options.dpi, ..base };
    let refused = Refused::default();
    if pictured {
        usvg.image_href_resolver = images(name, options, &refused, &unread);
    }
    let tree = usvg::Tree::from_xmltree(xml, &usvg).map_err(|e| {
        let problem = match e {
            usvg::Error::InvalidSize => {
                "the root <svg> has no valid size; give it a viewBox, or width and height".into()
            }
            usvg::Error::ElementsLimitReached => "it has more than a million elements".into(),
            usvg::Error::ParsingFailed(roxmltree::Error::NodesLimitReached) => {
                "with all that its uses show it has more than a million elements, or nests deeper than 1024".into()
            }
            other => other.to_string(),
        };
        Error::input(name, problem)
    })?;
    if let Some(e) = refused.lock().ok().and_then(|mut r| r.take()) {
        return Err(e);
    }
    let [fonts, images] = [missing, unread].map(|m| m.lock().map(|m| m.iter().cloned().collect()).unwrap_or_default());
    Ok((tree, Missed { fonts, images }))
}

/// Why a drawing shown as an image is not taken.
type Refused = Arc<Mutex<Option<Error>>>;

/// Images by their links and data: drawings among them are held to the same bounds as the drawing itself.
fn images<'a>(
    name: &'a str,
    options: &'a ReadOptions,
    refused: &Refused,
    unread: &Missing,
) -> usvg::ImageHrefResolver<'a> {
    let refused = refused.clone();
    let [not_this, nor_this] = [unread.clone(), unread.clone()];
    let miss = |unread: &Missing, link: String| {
        if let Ok(mut u) = unread.lock() {
            u.insert(link);
        }
    };
    let refuses = move |data: &[u8], what: &str| {
        let place = format!("{name}: {what}");
        let checked = text(data, &place, options).ok().map(|t| match source::xml(&t, &place) {
            Ok(xml) => unfold::check(&xml, &place),
            // usvg says what it thinks of it.
            Err(_) => Ok(()),
        });
        let Some(Err(e)) = checked else { return false };
        if let Ok(mut r) = refused.lock() {
            r.get_or_insert(e);
        }
        true
    };
    let known = usvg::ImageHrefResolver::default_data_resolver();
    let take = Arc::new(move |mime: &str, data: Arc<Vec<u8>>, what: &str, usvg: &usvg::Options<'_>| {
        let drawing = matches!(mime, "image/svg+xml" | ANY);
        if drawing && refuses(&data, what) { None } else { known(mime, data, usvg) }
    });
    let also = take.clone();
    usvg::ImageHrefResolver {
        resolve_data: Box::new(move |mime, data, usvg| {
            let image = also(mime, data, "the drawing in an image", usvg);
            // Of the kinds that are known, none stands for all of its kind.
            if image.is_none() && !matches!(mime, "image/svg+xml" | ANY) {
                miss(&not_this, format!("{DATA}{mime}"));
            }
            image
        }),
        resolve_string: Box::new(move |link, usvg| {
            // Without a folder of its own, a drawing's relative links would be looked for in the current one.
            let file = options.base_dir.as_ref().map(|_| usvg.get_abs_path(Path::new(link)));
            let image = file.and_then(|f| linked(&f)).and_then(|data| take(ANY, Arc::new(data), link, usvg));
            if image.is_none() {
                miss(&nor_this, link.to_owned());
            }
            image
        }),
    }
}

/// What links to embedded data begin with.
pub(crate) const DATA: &str = "data:";

/// The type of data that is told by looking at it.
const ANY: &str = "text/plain";

/// The bytes of a linked image. A link may name anything that the file system holds; what is no plain file, or larger than
/// images are, is not read.
fn linked(file: &Path) -> Option<Vec<u8>> {
    const MOST: u64 = 1 << 28;
    let plain = std::fs::metadata(file).ok()?.is_file();
    let mut data = Vec::new();
    if plain {
        File::open(file).ok()?.take(MOST + 1).read_to_end(&mut data).ok()?;
    }
    (plain && data.len() as u64 <= MOST).then_some(data)
}

/// Reads any SVG or svgz data into usvg's tree, with the same fonts and bounds as [`crate::Document::read`].
///
/// # Errors
/// [`Error::Input`] if it is not an SVG drawing; `name` is what it is called in the message.
pub fn parse_tree(data: &[u8], name: &str, options: &ReadOptions) -> Result<Arc<usvg::Tree>, Error> {
    let text = text(data, name, options)?;
    let xml = source::xml(&text, name)?;
    with_stack(name, || Ok(Arc::new(tree(&xml, name, options)?.0)))
}
