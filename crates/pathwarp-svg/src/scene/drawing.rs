//! A drawing: its source text, usvg's tree, and the scene resolved from both.

use super::geometry::{Dimension, GeometryReader, MM_PER_INCH, stretch};
use super::lettering::{self, TextLine};
use super::model::{Group, Node, Part, PartRole, Scene};
use super::resolve::{self, Tiling};
use crate::source::elements::ElementId;
use crate::source::images::{linked_drawing, shown};
use crate::source::mesh::MeshGradient;
use crate::source::read::{self, ReadOptions, Turned};
use crate::source::select::Selection;
use crate::source::text::{SourceText, WORTH_THREADS};
use crate::source::threads::{map_parallel, with_stack};
use crate::source::tree::{self, Missed};
use pathwarp::budget::Budget;
use pathwarp::kurbo::{Affine, Rect, Size};
use pathwarp::{Error, Outline};
use pathwarp_reader::LARGEST;
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::str::FromStr as _;
use std::sync::{Arc, OnceLock};
use svgtypes::{Length, LengthUnit};

/// A drawing that has been read.
#[derive(Debug)]
pub(crate) struct Drawing {
    pub(crate) name: String,
    pub(crate) source: Arc<SourceText>,
    /// Resolved on first use; for deep drawings, which need a large stack, at once.
    scene: OnceLock<Scene>,
    shapes: OnceLock<Vec<Shape>>,
    lines: OnceLock<Vec<TextLine>>,
    far: OnceLock<Far>,
    /// Fonts, images and other content that were not found.
    pub(crate) missed: Missed,
    /// Size in px.
    pub(crate) page: Size,
    /// `true` if walking the drawing takes little stack.
    shallow: bool,
    pub(crate) tree: Arc<usvg::Tree>,
    /// The source elements of the letters in texts.
    letters: Arc<lettering::Owners>,
    /// For every element, the index of its bend; empty if the drawing is not divided. Clip paths and masks are resolved once for each bend.
    division: Vec<Option<usize>>,
    /// Resolution in px per inch.
    dpi: f64,
    /// Turns images whose metadata request it.
    pub(crate) turned: Option<Turned>,
    /// Counts the work that the drawing causes.
    pub(crate) budget: Arc<Budget>,
}

impl Drawing {
    /// Reads an SVG or svgz file. `name` identifies it in errors.
    pub(crate) fn read(data: &[u8], name: &str, options: &ReadOptions) -> Result<Self, Error> {
        let options = &options.begin(data.len());
        let text = read::text(data, name, &options.budget)?;
        let dpi = f64::from(options.dpi);
        let linked = |link: &str| linked_drawing(link, options);
        let (source, read) = SourceText::read(text, name, &options.budget, &linked, |source, xml| {
            let shallow = source.is_shallow();
            let resolve = || {
                let (tree, missed) = tree::tree(xml, name, options)?;
                let letters = lettering::owners(source, name, options)?;
                let scene = OnceLock::new();
                if !shallow {
                    scene.get_or_init(|| resolve::build(&tree, source, &letters, dpi, None, &[]));
                }
                Ok((tree, letters, missed, scene))
            };
            let read = source.reading_ahead(|| if shallow { resolve() } else { with_stack(name, resolve) });
            Ok((read?, shallow))
        })?;
        let ((tree, letters, missed, scene), shallow) = read;
        let page = page_size(&source, &tree, dpi);
        Ok(Self {
            name: name.to_owned(),
            source: Arc::new(source),
            scene,
            shapes: OnceLock::new(),
            lines: OnceLock::new(),
            far: OnceLock::new(),
            missed,
            page,
            shallow,
            tree: Arc::new(tree),
            letters: Arc::new(letters),
            division: Vec::new(),
            dpi,
            turned: options.turned,
            budget: options.budget.clone(),
        })
    }

    /// The mesh gradient that a paint stands for.
    pub(crate) fn mesh(&self, paint: &usvg::Paint) -> Option<&MeshGradient> {
        let usvg::Paint::LinearGradient(g) = paint else { return None };
        let is_defined_here = || !self.scene().foreign.contains(&(Arc::as_ptr(g) as usize));
        self.source.meshes.get(g.id()).filter(|_| is_defined_here())
    }

    /// Resolves the drawing again, with pattern tiles laid out as geometry.
    pub(crate) fn tiled(&self, tiling: Tiling<'_>) -> Result<Self, Error> {
        self.resolved_again(Some(tiling), self.division.clone())
    }

    /// Resolves the drawing again, with clip paths and masks once for each bend of the elements that refer to them.
    pub(crate) fn divided(&self, division: Vec<Option<usize>>) -> Result<Self, Error> {
        self.resolved_again(None, division)
    }

    /// Resolves the drawing with shapes instead of their copies: the largest copy of each shape that only `use` elements show stands for
    /// the shape. Returns `None` if no `use` shows anything.
    pub(crate) fn at_originals(&self) -> Result<Option<Self>, Error> {
        let is_use = |p: &Part| p.owner.is_some_and(|e| self.source.elements[e].tag == "use");
        if !self.scene().parts.iter().any(is_use) {
            return Ok(None);
        }
        let mut drawing = self.resolved_again(None, self.division.clone())?;
        let Some(scene) = drawing.scene.get_mut() else { return Ok(Some(drawing)) };
        // For each shape, its largest part with its size: a copy, or `None` if the shape itself is shown, which counts as largest.
        let mut largest: HashMap<ElementId, (f64, Option<usize>)> = HashMap::new();
        for (i, part) in scene.parts.iter().enumerate() {
            let (size, copy) = if is_use(part) { (stretch(part.frame), Some(i)) } else { (f64::INFINITY, None) };
            if let Some(drawn) = part.drawn.filter(|_| part.owner.is_none() || copy.is_some()) {
                let known = largest.entry(drawn).or_insert((size, copy));
                if size > known.0 {
                    *known = (size, copy);
                }
            }
        }
        for (drawn, copy) in largest.into_iter().filter_map(|(drawn, (_, copy))| Some((drawn, copy?))) {
            (scene.parts[copy].source, scene.parts[copy].owner) = (Some(drawn), None);
        }
        let masks = scene.masks.iter_mut().map(|m| &mut m.root);
        let clips = scene.clips.iter_mut().map(|c| &mut c.root);
        let mut groups: Vec<&mut Group> = masks.chain(clips).chain([&mut scene.root]).collect();
        while let Some(g) = groups.pop() {
            g.owner = g.owner.filter(|e| self.source.elements[*e].tag != "use");
            let children = g.children.iter_mut();
            groups.extend(children.filter_map(|n| if let Node::Group(g) = n { Some(&mut **g) } else { None }));
        }
        Ok(Some(drawing))
    }

    /// Resolves the drawing again.
    fn resolved_again(&self, tiling: Option<Tiling<'_>>, division: Vec<Option<usize>>) -> Result<Self, Error> {
        let resolve = || Ok(resolve::build(&self.tree, &self.source, &self.letters, self.dpi, tiling, &division));
        let scene = self.with_stack(resolve)?;
        Ok(Self {
            name: self.name.clone(),
            source: self.source.clone(),
            scene: scene.into(),
            shapes: OnceLock::new(),
            lines: OnceLock::new(),
            far: OnceLock::new(),
            missed: self.missed.clone(),
            page: self.page,
            shallow: self.shallow,
            tree: self.tree.clone(),
            letters: self.letters.clone(),
            division,
            dpi: self.dpi,
            turned: self.turned,
            budget: self.budget.clone(),
        })
    }

    /// Runs `f`, which walks the drawing, with enough stack. `f` must not wait for other threads, or a caller on a thread pool
    /// would wait for itself.
    pub(crate) fn with_stack<T: Send>(&self, f: impl FnOnce() -> Result<T, Error> + Send) -> Result<T, Error> {
        if self.shallow { f() } else { with_stack(&self.name, f) }
    }

    pub(crate) fn scene(&self) -> &Scene {
        let resolve = || resolve::build(&self.tree, &self.source, &self.letters, self.dpi, None, &self.division);
        self.scene.get_or_init(resolve)
    }

    /// The shapes, one for each part of the scene.
    pub(crate) fn shapes(&self) -> &[Shape] {
        if let Some(shapes) = self.shapes.get() {
            return shapes;
        }
        // Don't read inside `get_or_init`: a thread waiting for others may run a task that needs the shapes, too.
        read_outlines(self.scene(), &self.source);
        self.shapes.get_or_init(|| shapes(self.scene(), &self.source))
    }

    /// The lines of lettering with their letters: first the lines of texts, then the lines of outlines. Found on first use, because this
    /// takes longer than reading the drawing, and few deformations need it.
    pub(crate) fn lines(&self) -> &[TextLine] {
        self.lines.get_or_init(|| lettering::lines(&self.tree, &self.reader(), self.scene()))
    }

    /// A reader of geometry from the source.
    pub(crate) fn reader(&self) -> GeometryReader<'_> {
        GeometryReader { source: &self.source, dpi: self.dpi, page: self.page }
    }

    /// The visible area in root user units. It differs from the viewBox if the page has another aspect ratio.
    pub(crate) fn visible_area(&self) -> Rect {
        self.scene().to_px.inverse().transform_rect_bbox(self.page.to_rect())
    }

    /// The visible area, if the file specifies the size of its page.
    pub(crate) fn specified_area(&self) -> Option<Rect> {
        let sides = ["width", "height"].map(|name| page_length(&self.source, name));
        let specified = self.source.attr(0, "viewBox").is_some() || self.shares_window() || !sides.contains(&None);
        specified.then(|| self.visible_area())
    }

    /// Returns `true` if the page is a fraction of the window. Such a page extends to the right and downwards as far as there is artwork.
    pub(crate) fn shares_window(&self) -> bool {
        let is_share = |name| page_length(&self.source, name).is_some_and(|l| l.unit == LengthUnit::Percent);
        self.source.attr(0, "viewBox").is_none() && (is_share("width") || is_share("height"))
    }

    /// A millimetre in root user units, if the file specifies the size of its page in physical units.
    pub(crate) fn millimetre(&self) -> Option<f64> {
        self.is_measured().then(|| self.units_per_mm())
    }

    /// Root user units in a millimetre, at the drawing's dots per inch if the file specifies no physical size.
    pub(crate) fn units_per_mm(&self) -> f64 {
        self.dpi / MM_PER_INCH / stretch(self.scene().to_px)
    }

    /// Returns `true` if the file specifies the size of its page in physical units.
    pub(crate) fn is_measured(&self) -> bool {
        use LengthUnit::{Cm, In, Mm, Pc, Pt};
        let lengths = ["width", "height"].map(|name| page_length(&self.source, name));
        lengths.into_iter().flatten().any(|l| matches!(l.unit, Mm | Cm | In | Pt | Pc))
    }

    /// The visible page in root user units.
    pub(crate) fn view_box(&self) -> Rect {
        self.reader().view_box(0).unwrap_or_else(|| Rect::from_origin_size((0.0, 0.0), self.page))
    }

    /// The transform of an element, including the shift of a `use`.
    pub(crate) fn own_transform(&self, e: ElementId) -> Affine {
        self.reader().own_transform(e).unwrap_or_default()
    }

    /// For every part, `true` if it is selected and in range.
    pub(crate) fn selected_parts(&self, selection: &Selection) -> Vec<bool> {
        let elements = selection.resolve(&self.source);
        let all = selection.is_everything();
        let far = self.out_of_range();
        let is_selected = |p: &Part| p.element().map_or(all, |e| elements[e]);
        self.scene().parts.iter().enumerate().map(|(i, p)| is_selected(p) && !far.holds(i)).collect()
    }

    /// The parts whose coordinates are out of range.
    pub(crate) fn out_of_range(&self) -> &Far {
        if let Some(far) = self.far.get() {
            return far;
        }
        // Not inside `get_or_init`: see `shapes`.
        let far = Far::find(&self.source, self.scene(), self.shapes());
        self.far.get_or_init(|| far)
    }
}

/// The size of the page in px. If one side is a fraction of the window, it is the artwork's extent; usvg takes that for both sides.
fn page_size(source: &SourceText, tree: &usvg::Tree, dpi: f64) -> Size {
    let drawn = Size::new(f64::from(tree.size().width()), f64::from(tree.size().height()));
    let reader = GeometryReader { source, dpi, page: drawn };
    let length = |name, dimension| {
        page_length(source, name).filter(|l| l.unit != LengthUnit::Percent && source.attr(0, "viewBox").is_none())?;
        reader.length(0, name, dimension)?
    };
    let [w, h] = [length("width", Dimension::Width), length("height", Dimension::Height)];
    if w.is_some() == h.is_some() { drawn } else { Size::new(w.unwrap_or(drawn.width), h.unwrap_or(drawn.height)) }
}

/// The `width` or `height` of the page as written.
pub(crate) fn page_length(source: &SourceText, name: &str) -> Option<Length> {
    Length::from_str(source.attr(0, name)?.trim()).ok()
}

/// Parts that are out of range, with the reasons.
#[derive(Debug, Default)]
pub(crate) struct Far {
    /// One flag for each part; empty if none is out of range.
    parts: Vec<bool>,
    /// Names of elements with the reasons.
    pub(crate) reasons: Vec<(String, String)>,
}

impl Far {
    fn find(source: &SourceText, scene: &Scene, shapes: &[Shape]) -> Self {
        let outlines: Vec<bool> = shapes.iter().map(|s| !is_in_range(&s.outline)).collect();
        if source.far.is_empty() && !outlines.contains(&true) {
            return Self::default();
        }
        let far_elements: HashSet<ElementId> = source.far.iter().map(|n| n.0).collect();
        let has_number =
            |e: Option<ElementId>| e.is_some_and(|e| source.ancestors(e).any(|a| far_elements.contains(&a)));
        let by_number = |n: &str| format!("its number {n} is out of range, which ends at {LARGEST:e}");
        let mut reasons: Vec<(String, String)> =
            source.far.iter().map(|(e, n)| (source.display_name(*e), by_number(n))).collect();
        let (mut parts, mut reported) = (Vec::with_capacity(outlines.len()), BTreeSet::new());
        for ((p, shape), is_far) in scene.parts.iter().zip(shapes).zip(outlines) {
            let has_number = has_number(p.source) || has_number(p.owner) || has_number(p.drawn);
            if is_far && !has_number && reported.insert(&shape.id) {
                let why = format!("it extends beyond the range of coordinates, which ends at {LARGEST:e}");
                reasons.push((shape.id.clone(), why));
            }
            parts.push(is_far || has_number);
        }
        Self { parts, reasons }
    }

    /// Returns `true` if part `i` is out of range.
    pub(crate) fn holds(&self, i: usize) -> bool {
        self.parts.get(i).is_some_and(|far| *far)
    }
}

/// Returns `true` if all points of an outline are in range.
fn is_in_range(o: &Outline) -> bool {
    o.segs().all(|s| {
        let [a, b] = [s.start(), s.end()];
        // The middle stands for the control points. NaN fails the comparison, too.
        let middle = s.eval(0.5);
        [a.x, a.y, b.x, b.y, middle.x, middle.y].iter().all(|v| v.abs() < LARGEST)
    })
}

/// A shape that is painted, clips or masks.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Shape {
    /// Id in the source, or else tag and position such as `path at 12:5`. The parts of a text or `use` share it.
    pub id: String,
    /// Source element, e.g. `circle`.
    pub element: String,
    /// Outline in root user space.
    pub outline: Arc<Outline>,
    /// Line and column of the element in the source, counted from 1.
    pub at: (usize, usize),
    /// `true` if the shape is visible, has a fill or a stroke, and is not part of a clip path or mask.
    pub painted: bool,
    /// `true` if the shape has a fill, clips or masks.
    pub filled: bool,
    /// `true` if the even-odd rule determines the interior, `false` for the nonzero rule.
    pub even_odd: bool,
}

/// A path with a name, or one that could have one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NamedPath {
    /// Id in the source, or else tag and position such as `path at 12:5`.
    pub id: String,
    /// Inkscape's label.
    pub label: Option<String>,
    /// Text of the `<title>`.
    pub title: Option<String>,
    /// Source element, e.g. `circle`.
    pub element: String,
    /// Outline in root user space.
    pub outline: Outline,
    /// Line and column of the element in the source, counted from 1.
    pub at: (usize, usize),
    /// For a path without an id, as listed by [`Document::paths`](crate::Document::paths): the id of the nearest ancestor that
    /// has one, or an empty string.
    pub group: Option<Arc<str>>,
}

/// Reads the outlines of a large drawing on several threads.
fn read_outlines(scene: &Scene, source: &SourceText) {
    if source.text.len() >= WORTH_THREADS {
        map_parallel(scene.parts.len(), |i| scene.parts[i].local.segs().next().is_some());
    }
}

/// Describes the parts of a scene.
fn shapes(scene: &Scene, source: &SourceText) -> Vec<Shape> {
    let shape = |p: &Part| {
        let e = p.element();
        Shape {
            id: e.map_or_else(|| "path".to_owned(), |e| source.display_name(e)),
            element: e.map_or_else(|| "path".to_owned(), |e| source.elements[e].tag.to_string()),
            outline: p.outline(),
            at: e.map_or((1, 1), |e| source.line_column(source.elements[e].range.start)),
            painted: p.painted() && p.role == PartRole::Paint,
            filled: p.fill.is_some() || p.role != PartRole::Paint,
            even_odd: p.fill.as_ref().is_some_and(|f| f.rule() == usvg::FillRule::EvenOdd),
        }
    };
    scene.parts.iter().map(shape).collect()
}

/// Describes a shape element, painted or not. Returns `None` if it has no outline.
pub(crate) fn named_path(scene: &Scene, reader: &GeometryReader<'_>, e: ElementId) -> Option<NamedPath> {
    // Prefer the painted outline; read an element that is not painted from the source.
    let parts = scene.by_source.get(&e).map_or(&[][..], Vec::as_slice);
    let painted = parts.iter().map(|&i| &scene.parts[i]).find(|p| p.role == PartRole::Paint);
    let outline = match painted {
        Some(p) => Arc::unwrap_or_clone(p.outline()),
        None => reader.outline(e)?.transformed(reader.transform_to_root(e).unwrap_or_default()),
    };
    let source = reader.source;
    Some(NamedPath {
        id: source.display_name(e),
        label: source.label(e).map(Cow::into_owned),
        title: source.elements[e].title.clone(),
        element: source.elements[e].tag.to_string(),
        outline,
        at: source.line_column(source.elements[e].range.start),
        group: None,
    })
}

/// Links to images that were not read, in the form shown in messages.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct UnreadImages {
    /// Links that lead to nothing readable: missing, damaged, too large.
    pub unreadable: Vec<String>,
    /// Links that lead out of the folder of the drawing, and were not followed.
    pub outside: Vec<String>,
}

impl UnreadImages {
    pub(crate) fn from_missed(missed: &Missed) -> Self {
        let unreadable = missed.images.iter().filter(|l| !missed.outside.contains(l)).map(|l| shown(l).to_owned());
        Self { unreadable: unreadable.collect(), outside: missed.outside.clone() }
    }

    /// Returns `true` if every image was read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.unreadable.is_empty() && self.outside.is_empty()
    }
}
