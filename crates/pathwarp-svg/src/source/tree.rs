//! usvg's tree of a drawing: its fonts and images, and limits on its size.

use super::fonts::{self, Missing};
use super::read::{self, ReadOptions};
use super::stack::with_stack;
use super::{fontface, unfold, xml};
use pathwarp::Error;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::sync::{Arc, Mutex};
use usvg::roxmltree;

/// Resources that a drawing asked for and did not get.
#[derive(Debug, Clone, Default)]
pub(crate) struct Missed {
    /// Font families.
    pub(crate) fonts: Vec<String>,
    /// Links to images; of `data:` URLs only the type.
    pub(crate) images: Vec<String>,
}

/// Features of a drawing that decide about fonts, images and limits.
#[derive(Default)]
struct Features {
    text: bool,
    images: bool,
    references: bool,
    markers: usize,
}

impl Features {
    fn of(xml: &roxmltree::Document<'_>) -> Self {
        let mut out = Self::default();
        for n in xml.descendants() {
            match n.tag_name().name() {
                "text" => out.text = true,
                "image" => out.images = true,
                "feImage" => (out.images, out.references) = (true, true),
                "marker" => out.markers += 1,
                "use" | "pattern" | "clipPath" | "mask" => out.references = true,
                _ => {}
            }
        }
        // An embedded SVG image may contain text.
        out.text |= out.images && ["image/svg", ".svg"].iter().any(|t| xml.input_text().contains(t));
        out
    }
}

/// Resolves a drawing with usvg. `name` identifies it in errors.
pub(crate) fn tree(
    xml: &roxmltree::Document<'_>,
    name: &str,
    options: &ReadOptions,
) -> Result<(usvg::Tree, Missed), Error> {
    let (missing, unread) = (Missing::default(), Missing::default());
    let features = Features::of(xml);
    if unfold::may_be_large(xml, features.markers, features.references) {
        unfold::check(xml, name)?;
    }
    // Reading the installed fonts takes longer than most drawings do.
    let base = if features.text {
        let fontdb = fontface::add(fonts::database(options.system_fonts, &options.fonts), xml.input_text());
        let font_resolver = fonts::resolver(options.generic_families.clone(), missing.clone());
        usvg::Options { fontdb, font_resolver, ..usvg::Options::default() }
    } else {
        usvg::Options::default()
    };
    let mut usvg = usvg::Options { resources_dir: options.base_dir.clone(), dpi: options.dpi, ..base };
    let rejected = Rejected::default();
    if features.images {
        usvg.image_href_resolver = images(name, options, &rejected, &unread);
    }
    let tree = usvg::Tree::from_xmltree(xml, &usvg).map_err(|e| {
        let problem = match e {
            usvg::Error::InvalidSize => {
                "the root <svg> has no valid size; give it a viewBox, or width and height".into()
            }
            usvg::Error::ElementsLimitReached => "it has more than a million elements".into(),
            usvg::Error::ParsingFailed(roxmltree::Error::NodesLimitReached) => {
                "with its references expanded, it has more than a million elements or nests deeper than 1024".into()
            }
            other => other.to_string(),
        };
        Error::input(name, problem)
    })?;
    if let Some(e) = rejected.lock().ok().and_then(|mut r| r.take()) {
        return Err(e);
    }
    let [fonts, images] = [missing, unread].map(|m| m.lock().map(|m| m.iter().cloned().collect()).unwrap_or_default());
    Ok((tree, Missed { fonts, images }))
}

/// The error of the first embedded drawing that exceeds the limits.
type Rejected = Arc<Mutex<Option<Error>>>;

/// Resolves images. Embedded drawings are held to the same limits as the drawing itself.
fn images<'a>(
    name: &'a str,
    options: &'a ReadOptions,
    rejected: &Rejected,
    unread: &Missing,
) -> usvg::ImageHrefResolver<'a> {
    let rejected = rejected.clone();
    let [unread_data, unread_files] = [unread.clone(), unread.clone()];
    let record = |unread: &Missing, link: String| {
        if let Ok(mut u) = unread.lock() {
            u.insert(link);
        }
    };
    let is_rejected = move |data: &[u8], what: &str| {
        let place = format!("{name}: {what}");
        let checked = read::text(data, &place, options).ok().map(|t| match xml::parse(&t, &place) {
            Ok(xml) => unfold::check(&xml, &place),
            // Leave the error to usvg.
            Err(_) => Ok(()),
        });
        let Some(Err(e)) = checked else { return false };
        if let Ok(mut r) = rejected.lock() {
            r.get_or_insert(e);
        }
        true
    };
    let decode = usvg::ImageHrefResolver::default_data_resolver();
    let load = Arc::new(move |mime: &str, data: Arc<Vec<u8>>, what: &str, usvg: &usvg::Options<'_>| {
        let may_be_drawing = matches!(mime, "image/svg+xml" | ANY);
        if may_be_drawing && is_rejected(&data, what) { None } else { decode(mime, data, usvg) }
    });
    let load_file = load.clone();
    usvg::ImageHrefResolver {
        resolve_data: Box::new(move |mime, data, usvg| {
            let image = load(mime, data, "the drawing in an image", usvg);
            // The type identifies the link, so one that several images share must not be recorded.
            if image.is_none() && !matches!(mime, "image/svg+xml" | ANY) {
                record(&unread_data, format!("{DATA}{mime}"));
            }
            image
        }),
        resolve_string: Box::new(move |link, usvg| {
            // Without a base folder, usvg would resolve relative links against the current folder.
            let file = options.base_dir.as_ref().map(|_| usvg.get_abs_path(Path::new(link)));
            let image = file.and_then(|f| linked(&f)).and_then(|data| load_file(ANY, Arc::new(data), link, usvg));
            if image.is_none() {
                record(&unread_files, link.to_owned());
            }
            image
        }),
    }
}

/// Scheme of embedded data.
pub(crate) const DATA: &str = "data:";

/// Media type of data whose format is detected from its content.
const ANY: &str = "text/plain";

/// Reads a linked image. A link may name anything in the file system, so only plain files up to a limit are read.
fn linked(file: &Path) -> Option<Vec<u8>> {
    const MOST: u64 = 1 << 28;
    let is_file = std::fs::metadata(file).ok()?.is_file();
    let mut data = Vec::new();
    if is_file {
        File::open(file).ok()?.take(MOST + 1).read_to_end(&mut data).ok()?;
    }
    (is_file && data.len() as u64 <= MOST).then_some(data)
}

/// Reads SVG or svgz data into usvg's tree.
pub(crate) fn parse(data: &[u8], name: &str, options: &ReadOptions) -> Result<Arc<usvg::Tree>, Error> {
    let text = read::text(data, name, options)?;
    let xml = xml::parse(&text, name)?;
    with_stack(name, || Ok(Arc::new(tree(&xml, name, options)?.0)))
}
