//! An SVG file: what it paints, what it calls things, and its text.

use crate::scene::geometry::Reader;
use crate::scene::letters;
use crate::scene::model::{self as scene, Role, Scene};
use crate::scene::resolve::{self, Tiling};
use crate::source::read::{self, Missed, ReadOptions};
use crate::source::select::{self, Selection};
use crate::source::text::{ElementId, Source, is_shape};
use pathwarp::kurbo::{Affine, Rect, Size};
use pathwarp::{Error, Outline};
use std::sync::{Arc, OnceLock};

/// An SVG file.
#[derive(Debug)]
pub struct Document {
    pub(crate) name: String,
    /// The file as it came, where it is not just the text.
    packed: Option<Arc<[u8]>>,
    pub(crate) source: Arc<Source>,
    /// What is painted; where the stack may be small, it is worked out when it is first asked for.
    scene: OnceLock<Scene>,
    shapes: OnceLock<Vec<Shape>>,
    pub(crate) missed: Missed,
    pub(crate) page: Size,
    /// Whether walking it takes little stack.
    pub(crate) shallow: bool,
    tree: Arc<usvg::Tree>,
    /// Which element each letter of a text with names inside comes from.
    letters: Arc<letters::Owners>,
    dpi: f64,
}

/// Something that is painted, clips or masks.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The source's id, or a readable stand-in such as `path at 12:5`. Parts of one text or `use` share it.
    pub id: String,
    /// The element it comes from, e.g. `circle`.
    pub element: String,
    /// In root user space.
    pub outline: Outline,
    /// Where the element starts in the source: line and column, counted from 1.
    pub at: (usize, usize),
    /// Whether it leaves a mark by itself: visible, with a fill or a stroke, and no part of a clip path or mask.
    pub painted: bool,
    /// Whether its inside is painted, clips or masks.
    pub filled: bool,
    /// Whether the even-odd rule says what its inside is (else the nonzero rule).
    pub even_odd: bool,
}

/// A path that has a name, or could have one.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPath {
    /// The source's id, or a readable stand-in such as `path at 12:5`.
    pub id: String,
    /// Inkscape's label.
    pub label: Option<String>,
    /// What its `<title>` says.
    pub title: Option<String>,
    /// The element, e.g. `circle`.
    pub element: String,
    /// In root user space.
    pub outline: Outline,
    /// Where the element starts in the source: line and column, counted from 1.
    pub at: (usize, usize),
    /// Of a path without an id, as [`Document::paths`] gives it, the id of the nearest element around it that has one, or nothing.
    pub group: Option<Arc<str>>,
}

impl Document {
    /// Reads an SVG or svgz file; `name` is what it is called in messages.
    ///
    /// # Errors
    /// [`Error::Input`] with the place, if it is not UTF-8, not XML, not SVG, or too large.
    pub fn read(data: &[u8], name: &str, options: &ReadOptions) -> Result<Self, Error> {
        let text = read::text(data, name, options)?;
        let packed = (text.len() != data.len()).then(|| Arc::from(data));
        let dpi = f64::from(options.dpi);
        let (source, read) = Source::read(text, name, |source, xml| {
            let shallow = read::is_shallow(source);
            let resolve = || {
                let (tree, missed) = read::tree(xml, name, options)?;
                let letters = letters::owners(source, name, options)?;
                let scene = OnceLock::new();
                if !shallow {
                    scene.get_or_init(|| resolve::build(&tree, source, &letters, dpi, None));
                }
                Ok((tree, letters, missed, scene))
            };
            Ok((if shallow { resolve()? } else { read::with_stack(name, resolve)? }, shallow))
        })?;
        let ((tree, letters, missed, scene), shallow) = read;
        Ok(Self {
            name: name.to_owned(),
            packed,
            source: Arc::new(source),
            scene,
            shapes: OnceLock::new(),
            missed,
            page: Size::new(f64::from(tree.size().width()), f64::from(tree.size().height())),
            shallow,
            tree: Arc::new(tree),
            letters: Arc::new(letters),
            dpi,
        })
    }

    /// The drawing as it is painted.
    pub(crate) fn scene(&self) -> &Scene {
        self.scene.get_or_init(|| resolve::build(&self.tree, &self.source, &self.letters, self.dpi, None))
    }

    /// The file's bytes.
    #[must_use]
    pub fn source(&self) -> &[u8] {
        self.packed.as_deref().unwrap_or(self.source.text.as_bytes())
    }

    /// What it is called in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The visible page in root user units: the viewBox, or (0, 0, width, height).
    #[must_use]
    pub fn view_box(&self) -> Rect {
        let reader = self.reader();
        reader.view_box(0).unwrap_or_else(|| Rect::from_origin_size((0.0, 0.0), self.page))
    }

    /// From root user units to px.
    #[must_use]
    pub fn user_to_px(&self) -> Affine {
        self.scene().to_px
    }

    /// The page in px.
    #[must_use]
    pub fn size_px(&self) -> Size {
        self.page
    }

    /// usvg's tree of the drawing, for rendering. (Elements without id carry temporary ones in it.)
    #[must_use]
    pub fn tree(&self) -> &Arc<usvg::Tree> {
        &self.tree
    }

    fn reader(&self) -> Reader<'_> {
        Reader { source: &self.source, dpi: self.dpi, page: self.page }
    }

    /// The document with its patterns' tiles laid out as geometry.
    pub(crate) fn tiled(&self, tiling: Tiling<'_>) -> Result<Self, Error> {
        // `Map`s may be used by any thread, so the tiling may go to one.
        let resolve = || Ok(resolve::build(&self.tree, &self.source, &self.letters, self.dpi, Some(tiling)));
        let scene = if self.shallow { resolve()? } else { read::with_stack(&self.name, resolve)? };
        Ok(Self {
            name: self.name.clone(),
            packed: self.packed.clone(),
            source: self.source.clone(),
            scene: scene.into(),
            shapes: OnceLock::new(),
            missed: self.missed.clone(),
            page: self.page,
            shallow: self.shallow,
            tree: self.tree.clone(),
            letters: self.letters.clone(),
            dpi: self.dpi,
        })
    }

    /// What an element's `transform` says.
    pub(crate) fn own_transform(&self, e: ElementId) -> Affine {
        self.reader().own_transform(e).unwrap_or_default()
    }

    /// Everything that is painted, clips or masks, in painting order. Texts and `use` copies count once per path.
    #[must_use]
    pub fn shapes(&self) -> &[Shape] {
        self.shapes.get_or_init(|| shapes(self.scene(), &self.source))
    }

    /// The tight box of what is painted and meant by `selection`: the filled geometry, without stroke widths.
    #[must_use]
    pub fn artwork_box(&self, selection: &Selection) -> Option<Rect> {
        let meant = self.meant(selection);
        let boxes = self.shapes().iter().zip(&meant).filter(|(s, m)| **m && s.painted);
        boxes.filter_map(|(s, _)| s.outline.bounding_box()).filter(Rect::is_finite).reduce(|a, b| a.union(b))
    }

    /// The painted shapes that `selection` means.
    pub fn selected<'a>(&'a self, selection: &Selection) -> impl Iterator<Item = &'a Shape> + use<'a> {
        let meant = self.meant(selection);
        self.shapes().iter().zip(meant).filter(|(s, meant)| *meant && s.painted).map(|(s, _)| s)
    }

    /// For every shape whether `selection` means it.
    pub(crate) fn meant(&self, selection: &Selection) -> Vec<bool> {
        let elements = selection.resolve(&self.source);
        let all = selection.is_everything();
        let parts = self.scene().parts.iter();
        parts.map(|p| p.owner.or(p.source).map_or(all, |e| elements[e])).collect()
    }

    /// Every path-like element of the file in document order, rendered or not.
    #[must_use]
    pub fn paths(&self) -> Vec<NamedPath> {
        let shapes = (0..self.source.elements.len()).filter(|&e| is_shape(&self.source.elements[e].tag));
        let groups = self.groups();
        shapes.filter_map(|e| Some(NamedPath { group: groups[e].clone(), ..self.named_path(e)? })).collect()
    }

    /// For every element without an id what [`NamedPath::group`] says.
    fn groups(&self) -> Vec<Option<Arc<str>>> {
        let mut nearest: Vec<Arc<str>> = Vec::with_capacity(self.source.elements.len());
        let mut out = Vec::with_capacity(self.source.elements.len());
        // Parents come before their children.
        for (e, element) in self.source.elements.iter().enumerate() {
            let outer = element.parent.map_or_else(|| "".into(), |p| nearest[p].clone());
            let id = self.source.attr(e, "id").filter(|v| !v.is_empty());
            out.push(id.is_none().then(|| outer.clone()));
            nearest.push(id.map_or(outer, |id| id.as_ref().into()));
        }
        out
    }

    /// The path of this name: an id, else an Inkscape label, else a title; a leading `#` is ignored. It may be invisible, or
    /// stand in `<defs>`. The name of a group that holds exactly one path means that path.
    ///
    /// # Errors
    /// [`Error::Input`] naming the paths there are.
    pub fn path(&self, name: &str) -> Result<NamedPath, Error> {
        let wanted = name.strip_prefix('#').unwrap_or(name);
        let found: Vec<ElementId> =
            (1..self.source.elements.len()).filter(|&e| select::named(&self.source, e, wanted)).collect();
        let by_id = found.iter().copied().filter(|&e| self.source.attr(e, "id").is_some_and(|v| v == wanted));
        let by_label = found.iter().copied().filter(|&e| self.source.label(e).is_some_and(|v| v == wanted));
        for e in by_id.chain(by_label).chain(found.iter().copied()) {
            if is_shape(&self.source.elements[e].tag) {
                if let Some(p) = self.named_path(e) {
                    return Ok(p);
                }
                continue;
            }
            let inside: Vec<ElementId> = (e + 1..self.source.elements.len())
                .take_while(|&c| self.source.elements[c].range.start < self.source.elements[e].range.end)
                .filter(|&c| is_shape(&self.source.elements[c].tag))
                .collect();
            if let [one] = inside.as_slice()
                && let Some(p) = self.named_path(*one)
            {
                return Ok(p);
            }
        }
        Err(self.no_such_path(wanted, !found.is_empty()))
    }

    fn no_such_path(&self, wanted: &str, exists: bool) -> Error {
        /// As many names as fit a line or two.
        const SHOWN: usize = 12;
        let mut names: Vec<String> = self.paths().into_iter().map(|p| p.label.or(p.title).unwrap_or(p.id)).collect();
        let all = names.len();
        // The likeliest slips first.
        names.sort_by_key(|n| distance(n, wanted));
        names.truncate(SHOWN);
        let place = format!("{}#{wanted}", self.name);
        let what = if exists { "that is not one path" } else { "there is no path of this name" };
        let hint = match (names.is_empty(), all > SHOWN) {
            (true, _) => "the file has no paths".to_owned(),
            (_, true) => format!("among the {all} paths are {}", names.join(", ")),
            _ => format!("the paths are {}", names.join(", ")),
        };
        Error::input(place, format!("{what}; {hint}"))
    }

    fn named_path(&self, e: ElementId) -> Option<NamedPath> {
        // What is painted is known best; the rest comes from the source alone.
        let parts = self.scene().by_source.get(&e).map_or(&[][..], Vec::as_slice);
        let painted = parts.iter().map(|&i| &self.scene().parts[i]).find(|p| p.role == Role::Paint);
        let outline = match painted {
            Some(p) => p.outline(),
            None => {
                let reader = self.reader();
                let t = reader.transform_to_root(e).unwrap_or_default();
                reader.outline(e)?.transformed(t)
            }
        };
        let source = &self.source;
        Some(NamedPath {
            id: source.display_name(e),
            label: source.label(e).map(std::borrow::Cow::into_owned),
            title: source.elements[e].title.clone(),
            element: source.elements[e].tag.to_string(),
            outline,
            at: source.line_column(source.elements[e].range.start),
            group: None,
        })
    }
}

fn shapes(scene: &Scene, source: &Source) -> Vec<Shape> {
    let shape = |p: &scene::Part| {
        let e = p.owner.or(p.source);
        Shape {
            id: e.map_or_else(|| "path".to_owned(), |e| source.display_name(e)),
            element: e.map_or_else(|| "path".to_owned(), |e| source.elements[e].tag.to_string()),
            outline: p.outline(),
            at: e.map_or((1, 1), |e| source.line_column(source.elements[e].range.start)),
            painted: p.painted() && p.role == Role::Paint,
            filled: p.fill.is_some() || p.role != Role::Paint,
            even_odd: p.fill.as_ref().is_some_and(|f| f.rule() == usvg::FillRule::EvenOdd),
        }
    };
    scene.parts.iter().map(shape).collect()
}

/// Levenshtein's distance, over at most so many characters that a hostile name costs nothing.
fn distance(a: &str, b: &str) -> usize {
    const LONGEST: usize = 40;
    let b: Vec<char> = b.chars().take(LONGEST).flat_map(char::to_lowercase).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, c) in a.chars().take(LONGEST).flat_map(char::to_lowercase).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, d) in b.iter().enumerate() {
            let next = (diagonal + usize::from(c != *d)).min(row[j] + 1).min(row[j + 1] + 1);
            diagonal = row[j + 1];
            row[j + 1] = next;
        }
    }
    row[b.len()]
}
