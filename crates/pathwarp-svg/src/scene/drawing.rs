//! A drawing: its source text, usvg's tree, and the scene resolved from both.

use super::affine::stretch;
use super::far::Far;
use super::geometry::{GeometryReader, MM_PER_INCH};
use super::lettering::{self, line::TextLine};
use super::letters;
use super::model::{Group, Node, Part, Scene};
use super::resolve::{self, Tiling};
use super::shape::{self, Shape};
use crate::source::read::{self, ReadOptions};
use crate::source::select::Selection;
use crate::source::stack::{is_shallow, with_stack};
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use crate::source::tree::{self, Missed};
use pathwarp::Error;
use pathwarp::budget::Budget;
use pathwarp::kurbo::{Affine, Rect, Size};
use std::collections::HashMap;
use std::str::FromStr as _;
use std::sync::{Arc, OnceLock};
use svgtypes::{Length, LengthUnit};

#[derive(Debug)]
pub(crate) struct Drawing {
    pub(crate) name: String,
    pub(crate) source: Arc<SourceText>,
    /// Computed on first use, except for deep drawings, which need a large stack.
    scene: OnceLock<Scene>,
    shapes: OnceLock<Vec<Shape>>,
    lines: OnceLock<Vec<TextLine>>,
    far: OnceLock<Far>,
    pub(crate) missed: Missed,
    /// Size in px.
    pub(crate) page: Size,
    /// `true` if walking the drawing takes little stack.
    shallow: bool,
    pub(crate) tree: Arc<usvg::Tree>,
    letters: Arc<letters::Owners>,
    /// For every element, the index of what bends it, if clip paths and masks are there once for each.
    division: Vec<Option<usize>>,
    dpi: f64,
    /// Counts the work that the drawing causes.
    pub(crate) budget: Arc<Budget>,
}

impl Drawing {
    /// Reads an SVG or svgz file. `name` identifies it in errors.
    pub(crate) fn read(data: &[u8], name: &str, options: &ReadOptions) -> Result<Self, Error> {
        let options = &options.begin(data.len());
        let text = read::text(data, name, &options.budget)?;
        let dpi = f64::from(options.dpi);
        let (source, read) = SourceText::read(text, name, &options.budget, |source, xml| {
            let shallow = is_shallow(source);
            let resolve = || {
                let (tree, missed) = tree::tree(xml, name, options)?;
                let letters = letters::owners(source, name, options)?;
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
        Ok(Self {
            name: name.to_owned(),
            source: Arc::new(source),
            scene,
            shapes: OnceLock::new(),
            lines: OnceLock::new(),
            far: OnceLock::new(),
            missed,
            page: Size::new(f64::from(tree.size().width()), f64::from(tree.size().height())),
            shallow,
            tree: Arc::new(tree),
            letters: Arc::new(letters),
            division: Vec::new(),
            dpi,
            budget: options.budget.clone(),
        })
    }

    /// Resolves the drawing again, with pattern tiles laid out as geometry.
    pub(crate) fn tiled(&self, tiling: Tiling<'_>) -> Result<Self, Error> {
        self.resolved_again(Some(tiling), self.division.clone())
    }

    /// Resolves the drawing again, with clip paths and masks for each of the bends that their users have.
    pub(crate) fn divided(&self, division: Vec<Option<usize>>) -> Result<Self, Error> {
        self.resolved_again(None, division)
    }

    /// The drawing in which the shapes that `use` elements show are those that they copy, once each: the largest copy stands for all.
    /// Shapes that are drawn themselves as well are no copies. `None` if there are no copies.
    pub(crate) fn at_originals(&self) -> Result<Option<Self>, Error> {
        let is_use = |p: &Part| p.owner.is_some_and(|e| self.source.elements[e].tag == "use");
        if !self.scene().parts.iter().any(is_use) {
            return Ok(None);
        }
        let mut drawing = self.resolved_again(None, self.division.clone())?;
        let Some(scene) = drawing.scene.get_mut() else { return Ok(Some(drawing)) };
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
            groups.extend(
                g.children.iter_mut().filter_map(|n| if let Node::Group(g) = n { Some(&mut **g) } else { None }),
            );
        }
        Ok(Some(drawing))
    }

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
            budget: self.budget.clone(),
        })
    }

    /// Runs `f`, which walks the drawing, with enough stack. `f` must not wait for other threads: a caller on a thread pool
    /// would wait for itself.
    pub(crate) fn with_stack<T: Send>(&self, f: impl FnOnce() -> Result<T, Error> + Send) -> Result<T, Error> {
        if self.shallow { f() } else { with_stack(&self.name, f) }
    }

    pub(crate) fn scene(&self) -> &Scene {
        self.scene
            .get_or_init(|| resolve::build(&self.tree, &self.source, &self.letters, self.dpi, None, &self.division))
    }

    /// The shapes, one for each part of the scene.
    pub(crate) fn shapes(&self) -> &[Shape] {
        if let Some(shapes) = self.shapes.get() {
            return shapes;
        }
        // Not inside of `get_or_init`: while a thread of a pool waits for others, it may run a task that needs the shapes, too.
        shape::read_outlines(self.scene(), &self.source);
        self.shapes.get_or_init(|| shape::shapes(self.scene(), &self.source))
    }

    /// The lines of lettering, each with its letters: those of texts, then those of outlines. Computed on first use, because it
    /// takes longer than reading the drawing, and few deformations ask for it.
    pub(crate) fn lines(&self) -> &[TextLine] {
        self.lines.get_or_init(|| lettering::lines(&self.tree, &self.reader(), self.scene()))
    }

    pub(crate) fn reader(&self) -> GeometryReader<'_> {
        GeometryReader { source: &self.source, dpi: self.dpi, page: self.page }
    }

    /// The visible area in root user units. It differs from the viewBox if the page has another aspect ratio.
    pub(crate) fn visible_area(&self) -> Rect {
        self.scene().to_px.inverse().transform_rect_bbox(self.page.to_rect())
    }

    /// The visible area, if the file specifies the size of its page.
    pub(crate) fn specified_area(&self) -> Option<Rect> {
        let length = |name| {
            let text = self.source.attr(0, name);
            text.and_then(|t| Length::from_str(t.trim()).ok()).is_some_and(|l| l.unit != LengthUnit::Percent)
        };
        let specified = self.source.attr(0, "viewBox").is_some() || length("width") && length("height");
        specified.then(|| self.visible_area())
    }

    /// A millimetre in root user units, if the file specifies the size of its page in physical units.
    pub(crate) fn millimetre(&self) -> Option<f64> {
        use LengthUnit::{Cm, In, Mm, Pc, Pt};
        let physical = |name| {
            let length = Length::from_str(self.source.attr(0, name)?.trim()).ok()?;
            Some(matches!(length.unit, Mm | Cm | In | Pt | Pc))
        };
        let measured = ["width", "height"].into_iter().any(|name| physical(name) == Some(true));
        measured.then(|| self.dpi / MM_PER_INCH / stretch(self.scene().to_px))
    }

    /// The visible page in root user units.
    pub(crate) fn view_box(&self) -> Rect {
        self.reader().view_box(0).unwrap_or_else(|| Rect::from_origin_size((0.0, 0.0), self.page))
    }

    /// The transform of an element, including the shift of a `use`.
    pub(crate) fn own_transform(&self, e: ElementId) -> Affine {
        self.reader().own_transform(e).unwrap_or_default()
    }

    /// Determines for every part whether it is selected.
    pub(crate) fn selected_parts(&self, selection: &Selection) -> Vec<bool> {
        let elements = selection.resolve(&self.source);
        let all = selection.is_everything();
        let parts = self.scene().parts.iter();
        let far = self.far();
        let selected = |p: &Part| p.element().map_or(all, |e| elements[e]);
        parts.enumerate().map(|(i, p)| selected(p) && !far.holds(i)).collect()
    }

    /// The parts whose coordinates are out of range.
    pub(crate) fn far(&self) -> &Far {
        if let Some(far) = self.far.get() {
            return far;
        }
        // As for the shapes.
        let far = Far::of(&self.source, self.scene(), self.shapes());
        self.far.get_or_init(|| far)
    }
}
