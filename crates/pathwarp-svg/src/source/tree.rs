//! Resolves a drawing with usvg, with its fonts and images, within limits on its size.

use super::check;
use super::elements::{ElementId, is_shape};
use super::fontface;
use super::fonts::{self, Chooser, FontGuard};
use super::images::{self, Missing, Rejected, Unread};
use super::pieces::{self, Divided};
use super::read::{self, ReadOptions};
use super::text::{SourceText, to_plain};
use super::threads::with_stack;
use pathwarp::Error;
use pathwarp_reader::xml;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use usvg::roxmltree;

/// Fonts, letters and images that usvg's tree of a drawing lacks, and content and style that a picture of it does not show.
#[derive(Debug, Clone, Default)]
pub(crate) struct Missed {
    pub(crate) fonts: Vec<String>,
    /// Letters that no font has, each with the text around it.
    pub(crate) letters: BTreeSet<(String, String)>,
    /// Links to images that were not read.
    pub(crate) images: Vec<String>,
    /// The links among `images` that lead out of the folder of the drawing.
    pub(crate) outside: Vec<String>,
    /// Sentences about content and style that are not drawn. Only [`with_undrawn`](Self::with_undrawn) adds them.
    #[cfg_attr(not(feature = "usvg"), allow(dead_code))]
    pub(crate) undrawn: Vec<String>,
    /// The reader's notes on small differences from browsers. Only [`with_undrawn`](Self::with_undrawn) adds them.
    #[cfg_attr(not(feature = "usvg"), allow(dead_code))]
    pub(crate) notes: BTreeSet<(&'static str, String)>,
}

impl Missed {
    /// Sentences about letters that no font has.
    pub(crate) fn without_font(&self) -> Vec<String> {
        /// Letters shown of a text.
        const MAX_SHOWN: usize = 40;
        let shortened = |text: &str| match text.char_indices().nth(MAX_SHOWN) {
            Some((end, _)) => format!("{}…", &text[..end]),
            None => text.to_owned(),
        };
        let name = |(letters, text): &(String, String)| match letters == text {
            true => format!("no font has the letters “{}”", shortened(text)),
            false => format!("no font has the letters “{}” of “{}”", shortened(letters), shortened(text)),
        };
        self.letters.iter().map(name).collect()
    }

    /// Adds the content and style that a picture of the drawing lacks, and the reader's notes.
    pub(crate) fn with_undrawn(self, source: &SourceText) -> Self {
        let undrawn = undrawn(source).into_iter().chain(undrawn_meshes(source)).chain(self.without_font()).collect();
        Self { undrawn, notes: source.notes.clone(), ..self }
    }
}

/// The initial font size, in px, as in browsers.
const INITIAL_FONT_SIZE: f32 = 16.0;

/// Resolves a drawing with usvg. `name` identifies it in errors.
pub(crate) fn tree(
    xml: &roxmltree::Document<'_>,
    name: &str,
    options: &ReadOptions,
) -> Result<(usvg::Tree, Missed), Error> {
    let features = check::check_drawing(xml, name, &options.budget)?;
    let (missing, unread, rejected) = (Missing::default(), Unread::default(), Rejected::default());
    // The installed fonts are read only for text, as this takes longer than reading most drawings.
    let mut usvg = usvg::Options { resources_dir: options.base_dir.clone(), dpi: options.dpi, ..Default::default() };
    if features.images {
        usvg.image_href_resolver = images::resolver(name, options, &rejected, &unread);
    }
    let mut letters = BTreeSet::new();
    let tree = if features.text {
        let installed = fonts::database(options.system_fonts, &options.fonts);
        usvg.fontdb = fontface::add(installed, xml, &options.budget)
            .map_err(|e| Error::limit(name, "with its text, its fonts take", e))?;
        let guard = FontGuard::new(options, &rejected);
        let chooser = Chooser::new(options.generic_families.clone(), missing.clone(), guard);
        usvg.font_size = INITIAL_FONT_SIZE;
        fonts::NO_FAMILY.clone_into(&mut usvg.font_family);
        let (tree, missing) = tree_with_texts(xml, name, &mut usvg, &chooser)?;
        letters = missing;
        tree
    } else {
        usvg_tree(xml, name, &usvg)?
    };
    if let Some(e) = rejected.lock().ok().and_then(|mut r| r.take()) {
        return Err(e);
    }
    let listed = |m: Missing| m.lock().map(|m| m.iter().cloned().collect()).unwrap_or_default();
    let [fonts, images, outside] = [missing, unread.images, unread.outside].map(listed);
    Ok((tree, Missed { fonts, images, outside, letters, ..Missed::default() }))
}

/// Resolves a drawing with texts, which are divided into pieces where usvg would shape them differently from browsers. Also returns the
/// letters that no font has, each with the text around it.
fn tree_with_texts(
    xml: &roxmltree::Document<'_>,
    name: &str,
    usvg: &mut usvg::Options<'_>,
    chooser: &Arc<Chooser>,
) -> Result<(usvg::Tree, BTreeSet<(String, String)>), Error> {
    usvg.font_resolver = chooser.resolver(Vec::new());
    let marked = pieces::with_ids(xml);
    let marked = marked.as_deref().map(|text| xml::parse_checked(text, name)).transpose()?;
    let xml = marked.as_ref().unwrap_or(xml);
    let whole = usvg_tree(xml, name, usvg)?;
    let Divided { text, fonts, db, missing } = pieces::divided(xml, &whole, chooser);
    let Some(text) = text else { return Ok((whole, missing)) };
    usvg.fontdb = db;
    usvg.font_resolver = chooser.resolver(fonts);
    Ok((usvg_tree(&xml::parse_checked(&text, name)?, name, usvg)?, missing))
}

/// Runs usvg, which panics on some damaged fonts and images.
fn usvg_tree(xml: &roxmltree::Document<'_>, name: &str, options: &usvg::Options<'_>) -> Result<usvg::Tree, Error> {
    let resolved = catch_unwind(AssertUnwindSafe(|| usvg::Tree::from_xmltree(xml, options)));
    let failed = |_| Error::input(name, "the library that reads SVG fails on it; please report it");
    resolved.map_err(failed)?.map_err(|e| match e {
        usvg::Error::InvalidSize => {
            Error::input(name, "the root <svg> has no valid size; give it a viewBox, or width and height")
        }
        usvg::Error::ElementsLimitReached => Error::input(name, "it has more than a million elements"),
        usvg::Error::ParsingFailed(roxmltree::Error::NodesLimitReached) => {
            let problem = "with its references expanded, it has more than a million elements or nests deeper than 1024";
            Error::input(name, problem)
        }
        other => Error::input(name, other.to_string()),
    })
}

/// Reads SVG or svgz data into usvg's tree, with the list of all that it lacks and a new budget.
pub(crate) fn parse(data: &[u8], name: &str, options: &ReadOptions) -> Result<(Arc<usvg::Tree>, Missed), Error> {
    parse_counted(data, name, &options.begin(data.len()))
}

/// Reads SVG or svgz data into usvg's tree, with the list of all that it lacks, within the rest of the options' budget.
pub(crate) fn parse_counted(
    data: &[u8],
    name: &str,
    options: &ReadOptions,
) -> Result<(Arc<usvg::Tree>, Missed), Error> {
    let text = read::text(data, name, &options.budget)?;
    let linked = |link: &str| images::linked_drawing(link, options);
    to_plain(text, name, &options.budget, None, &linked, |plain, doc, _| {
        let (tree, missed) = with_stack(name, || tree(doc, name, options))?;
        Ok((Arc::new(tree), missed.with_undrawn(&SourceText::from_plain(doc, plain, name)?)))
    })
}

/// Content that usvg does not support.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unsupported {
    /// Inkscape's text that flows in a frame.
    FlowedText,
    /// HTML.
    Foreign,
    /// A reference to another file.
    Elsewhere,
}

/// Classifies an element that usvg does not render.
pub(crate) fn unsupported(source: &SourceText, e: ElementId) -> Option<Unsupported> {
    match source.elements[e].tag.as_ref() {
        "flowRoot" => Some(Unsupported::FlowedText),
        // Browsers don't show the private data of editors. HTML beside a text in a `switch` is drawn as that text.
        "foreignObject" if source.attr(e, "requiredExtensions").is_none() => {
            source.foreign.binary_search_by_key(&e, |f| f.0).is_err().then_some(Unsupported::Foreign)
        }
        "use" | "textPath" | "tref" if source.link(e).is_some_and(|link| is_elsewhere(&link)) => {
            Some(Unsupported::Elsewhere)
        }
        _ => None,
    }
}

/// Returns `true` if an element is in `<defs>`, so that it is only drawn by reference.
pub(crate) fn is_definition(source: &SourceText, e: ElementId) -> bool {
    source.ancestors(e).any(|a| source.elements[a].tag == "defs")
}

/// Returns `true` if a link leads to another file.
fn is_elsewhere(link: &str) -> bool {
    let link = link.trim_start();
    !link.is_empty() && !link.starts_with('#')
}

/// Sentences about elements whose mesh gradients a picture lacks.
fn undrawn_meshes(source: &SourceText) -> impl Iterator<Item = String> {
    let all = if source.meshes.is_empty() { 0..0 } else { 0..source.elements.len() };
    let painted = |&e: &ElementId| {
        (is_shape(&source.elements[e].tag) || source.elements[e].tag == "text") && !is_definition(source, e)
    };
    all.filter(painted).filter_map(|e| {
        let is_mesh = |p: &&str| source.paint_server(e, p).is_some_and(|s| source.mesh(s).is_some());
        let paint = ["fill", "stroke"].into_iter().find(is_mesh)?;
        Some(format!("the {paint} of {} is not drawn: a mesh gradient, for Inkscape and PDF", source.display_name(e)))
    })
}

/// Sentences about content and style that a picture of the drawing lacks.
pub(crate) fn undrawn(source: &SourceText) -> Vec<String> {
    let shown = |e: &ElementId| !is_definition(source, *e);
    let content = (0..source.elements.len()).filter(shown).filter_map(|e| {
        let problem = match unsupported(source, e)? {
            Unsupported::FlowedText => "text that flows in a frame (flowRoot), which only Inkscape lays out",
            Unsupported::Foreign => "foreign content (HTML in a foreignObject)",
            Unsupported::Elsewhere => "what it refers to is in another file",
        };
        Some(format!("{} is not drawn: {problem}", source.display_name(e)))
    });
    let style = source.unsupported_style.iter().filter(|(e, _)| e.as_ref().is_none_or(shown)).map(|(e, why)| match e {
        Some(e) => {
            let joined = if why.starts_with("only ") { " is drawn" } else { ":" };
            format!("{}{joined} {why}", source.display_name(*e))
        }
        None => format!("the style sheets ask for more than is supported: {why}"),
    });
    content.chain(style).collect()
}
