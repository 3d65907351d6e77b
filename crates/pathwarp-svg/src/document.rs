//! Reads documents, answers questions about them, and warps them.

use crate::bend::bends::{Bend, Bends};
use crate::bend::drawing::bend;
use crate::bend::fits::{self, FilterOutcome};
use crate::bend::options::{CutLine, Edit, OnError, PageFit, Strokes, Structure, WarpOptions};
use crate::bend::outcome::{Notes, WarpedDocument};
use crate::bend::task::placed_outlines;
use crate::scene::areas::{self, stroked};
use crate::scene::drawing::{Drawing, NamedPath, Shape, UnreadImages, named_path};
use crate::scene::geometry::stretch;
use crate::scene::model::{Bitmap, Part, PartRole};
use crate::scene::plot::{self, Plot};
use crate::scene::selected_lettering::{Lettering, lettering, objects};
use crate::source::edit::Edits;
use crate::source::elements::{ElementId, is_shape};
use crate::source::number::{rectangle, single};
use crate::source::read::ReadOptions;
use crate::source::select::{self, Division, Selection, candidates, is_named, matches_any};
use crate::source::tree::undrawn;
use crate::write;
use crate::write::input::WriteInput;
use pathwarp::budget::{Budget, Exceeded, cost};
use pathwarp::kurbo::{Affine, Rect, Size};
use pathwarp::map::{AffineMap, Map};
use pathwarp::param::Letter;
use pathwarp::{Error, Outline, refit};
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// An element that holds something painted.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct DrawingPart {
    /// Its id, or else name and position such as `path at 12:5`.
    pub name: String,
    /// The [selector](Selection::select) for this element and no other.
    pub selector: String,
    /// Inkscape's label, or else the text of the `<title>`.
    pub label: Option<String>,
    /// The element, e.g. `circle`.
    pub element: String,
    /// The number of elements around it, without the root.
    pub depth: usize,
}

/// Declares SVG's namespace for the names without a prefix on an element and inside it.
const SVG_DECLARATION: &str = " xmlns=\"http://www.w3.org/2000/svg\" ";

/// An SVG file.
#[derive(Debug)]
pub struct Document {
    drawing: Drawing,
    /// Content of the file, if it differs from the text.
    packed: Option<Box<[u8]>>,
}

impl Document {
    /// Reads an SVG or svgz file. `name` identifies it in messages.
    ///
    /// # Errors
    /// Returns [`Error::Input`] with the position if the file is not text in its encoding, not XML, not SVG, or too large.
    pub fn read(data: &[u8], name: &str, options: &ReadOptions) -> Result<Self, Error> {
        let drawing = Drawing::read(data, name, options)?;
        let packed = (drawing.source.text.as_bytes() != data).then(|| data.into());
        Ok(Self { drawing, packed })
    }

    /// The decoded text of the file. If the encoding was another than UTF-8, the XML declaration names UTF-8. Style that only browsers
    /// read is in attributes that usvg reads.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.drawing.source.text
    }

    /// The decoded text of the file with its style unchanged, which can be read again.
    #[must_use]
    pub fn decoded(&self) -> Cow<'_, str> {
        self.drawing.source.as_in_file()
    }

    /// Content of the file.
    #[must_use]
    pub fn source(&self) -> &[u8] {
        self.packed.as_deref().unwrap_or(self.drawing.source.text.as_bytes())
    }

    /// Name in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.drawing.name
    }

    /// The visible page in root user units: the viewBox, or (0, 0, width, height).
    #[must_use]
    pub fn view_box(&self) -> Rect {
        self.drawing.view_box()
    }

    /// Transform from root user units to px.
    #[must_use]
    pub fn user_to_px(&self) -> Affine {
        self.drawing.scene().to_px
    }

    /// The text of the drawing with its page moved to the origin, for readers in single precision; `None` if it lies near enough.
    ///
    /// # Errors
    /// [`Error::Input`] or [`Error::Geometry`] as for [`Document::warp`].
    pub fn moved_to_origin(&self) -> Result<Option<String>, Error> {
        /// Distance from the origin, in pages, beyond which single precision would move shapes by a hundred-thousandth of the page.
        const FAR: f64 = 64.0;
        /// Tolerance of the moved shapes, as a fraction of the page.
        const TOLERANCE: f64 = 1e-8;
        let page = self.drawing.visible_area();
        let (side, distance) = (page.width().max(page.height()), page.x0.abs().max(page.y0.abs()));
        if distance <= FAR * side || self.drawing.specified_area().is_none() {
            return Ok(None);
        }
        let refit =
            refit::Options::new(TOLERANCE * side).with_nodes(refit::Nodes::Source).with_budget(self.budget().clone());
        let options =
            WarpOptions::new(refit).with_strokes(Strokes::Keep).with_on_error(OnError::Skip).with_page(PageFit::Origin);
        let map = AffineMap(Affine::translate(-page.origin().to_vec2()));
        Ok(Some(self.warp(&map, &options)?.svg))
    }

    /// The text of the drawing with plain shapes for the markers and strokes that usvg draws differently from browsers; `None` if there
    /// are none.
    ///
    /// # Errors
    /// [`Error::Input`] or [`Error::Geometry`] as for [`Document::warp`].
    pub fn resolved(&self) -> Result<Option<String>, Error> {
        /// Tolerance of an outlined stroke, in px.
        const TOLERANCE: f64 = 0.01;
        if self.drawing.scene().parts.iter().all(|p| !p.differs_from_usvg) {
            return Ok(None);
        }
        let tolerance = TOLERANCE / stretch(self.user_to_px());
        let refit = refit::Options::new(tolerance).with_nodes(refit::Nodes::Source).with_budget(self.budget().clone());
        let options = WarpOptions::new(refit).with_on_error(OnError::Skip).with_page(PageFit::None);
        Ok(Some(self.warp(&AffineMap(Affine::IDENTITY), &options.editing(Edit::Resolve))?.svg))
    }

    /// The drawing with its page and all artwork `scale` times as large. Only the root's size and viewBox change. The size is written in
    /// `unit`, which is `px` px long.
    #[must_use]
    pub fn resized(&self, scale: f64, unit: &str, px: f64) -> String {
        let source = &self.drawing.source;
        let (page, view) = (self.size_px(), self.view_box());
        let mut edits = Edits::new(source);
        if source.attr(0, "viewBox").is_none() {
            edits.set_attr(0, "viewBox", rectangle(view).map(|side| side.1).join(" "));
        }
        for (name, side) in [("width", page.width), ("height", page.height)] {
            edits.set_page_side(name, format!("{}{unit}", single(side * scale / px)));
        }
        edits.apply().0
    }

    /// Size of the page in px.
    #[must_use]
    pub fn size_px(&self) -> Size {
        self.drawing.page
    }

    /// Returns `true` if the file gives its page a size in mm, cm, in, pt or pc.
    #[must_use]
    pub fn is_measured(&self) -> bool {
        self.drawing.is_measured()
    }

    /// Images to which the drawing links and that were not read.
    #[must_use]
    pub fn unread_images(&self) -> UnreadImages {
        UnreadImages::from_missed(&self.drawing.missed)
    }

    /// The limits on the work that the drawing causes, and the work done so far.
    #[must_use]
    pub fn budget(&self) -> &Arc<Budget> {
        &self.drawing.budget
    }

    /// Renews the limits, for programs that warp a drawing several times.
    pub fn renew_budget(&mut self) {
        self.drawing.budget = Arc::new(Budget::new(self.drawing.budget.limits()));
    }

    #[cfg(feature = "usvg")]
    pub(crate) fn drawing(&self) -> &Drawing {
        &self.drawing
    }

    /// Styles of the paths that are printed in spot inks, by their ids; the ink `All` stands for every plate.
    #[must_use]
    pub fn spots(&self) -> HashMap<String, CutLine> {
        let source = &self.drawing.source;
        let spot = |e: ElementId| {
            let spot = Some(source.attr(e, "data-spot")?.into_owned());
            let knockout = source.attr(e, "data-knockout").is_some();
            Some((source.attr(e, "id")?.into_owned(), CutLine { spot, knockout, ..CutLine::default() }))
        };
        (0..source.elements.len()).filter_map(spot).collect()
    }

    /// Font families in the drawing that were not found.
    #[must_use]
    pub fn missing_fonts(&self) -> &[String] {
        &self.drawing.missed.fonts
    }

    /// Sentences about fonts and images that were not found.
    #[must_use]
    pub fn missing(&self) -> Vec<String> {
        let missed = &self.drawing.missed;
        let fonts = missed.fonts.iter().map(|name| format!("text uses another font, as {name} is missing"));
        let fonts = fonts.chain(missed.without_font());
        fonts.chain(missed.images.iter().map(|link| format!("the image {link} cannot be read"))).collect()
    }

    /// Sentences about unsupported content and style, which a picture of the drawing lacks.
    #[must_use]
    pub fn undrawn(&self) -> Vec<String> {
        undrawn(&self.drawing.source).into_iter().chain(self.drawing.missed.without_font()).collect()
    }

    /// Sentences about content that browsers show a little differently.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        Notes::in_words(&self.drawing.source.notes)
    }

    /// All shapes that are painted, clip or mask, in painting order. Texts and `use` copies have one shape per path.
    #[must_use]
    pub fn shapes(&self) -> &[Shape] {
        self.drawing.shapes()
    }

    /// The painted elements in document order: shapes, texts and pictures, and the groups around them.
    #[must_use]
    pub fn parts(&self) -> Vec<DrawingPart> {
        let (source, scene) = (&self.drawing.source, self.drawing.scene());
        let shapes = scene.parts.iter().filter(|p| p.painted() && p.role == PartRole::Paint).filter_map(Part::element);
        let painted: HashSet<ElementId> = shapes.chain(scene.bitmaps.iter().filter_map(|b| b.owner)).collect();
        let mut depths: BTreeMap<ElementId, usize> = BTreeMap::new();
        for &e in &painted {
            depths.extend(source.ancestors(e).filter(|&a| a > 0).map(|a| (a, source.ancestors(a).count() - 2)));
        }
        // The number of elements with each name.
        let mut bearers: HashMap<String, usize> = HashMap::new();
        for (e, element) in source.elements.iter().enumerate() {
            let names = [source.attr(e, "id"), source.label(e), element.title.as_deref().map(Cow::Borrowed)];
            names.into_iter().flatten().for_each(|n| *bearers.entry(n.into_owned()).or_default() += 1);
        }
        let selector = |e: ElementId| match source.attr(e, "id").filter(|id| !id.is_empty()) {
            Some(id) if bearers[&*id] == 1 => format!("#{id}"),
            Some(id) => format!("[id={id}]"),
            None => source.display_name(e),
        };
        let part = |(e, depth): (ElementId, usize)| DrawingPart {
            name: source.display_name(e),
            selector: selector(e),
            label: source.label(e).map(Cow::into_owned).or_else(|| source.elements[e].title.clone()),
            element: source.elements[e].tag.to_string(),
            depth,
        };
        depths.into_iter().map(part).collect()
    }

    /// The drawing with an id for every element that has none: its name in [parts](Self::parts) and reports, so that a viewer can identify
    /// it. Selections by these names hold for both drawings.
    #[must_use]
    pub fn with_ids(&self) -> String {
        self.drawing.source.with_ids()
    }

    /// The drawing as in its file, with an element at the end of its root.
    #[must_use]
    pub fn with_appended(&self, element: &str) -> String {
        let source = &self.drawing.source;
        let root = &source.elements[0];
        let name = &source.text[root.qname.clone()];
        // An empty root such as `<svg/>` gets an end tag.
        let (at, skipped) = root.close.as_ref().map_or((root.open_end - 2, 2), |close| (close.start, 0));
        let at = source.positions_in_file(std::iter::once(at))[0];
        let file = source.as_in_file();
        let [start, end] = if skipped > 0 { [">", &format!("</{name}>")] } else { ["", ""] };
        // Where a prefix stands for SVG, names without one mean something else.
        let declared = if name == "svg" { element.to_owned() } else { element.replacen(' ', SVG_DECLARATION, 1) };
        [&file[..at], start, &declared, end, &file[at + skipped..]].concat()
    }

    /// Bounding box of the selected painted shapes, without stroke widths, and of pictures.
    #[must_use]
    pub fn artwork_box(&self, selection: &Selection) -> Option<Rect> {
        let shapes = self.selected(selection).filter_map(|s| s.outline.bounding_box());
        let pictures = self.selected_bitmaps(selection).filter_map(areas::picture_box);
        shapes.chain(pictures).filter(Rect::is_finite).reduce(|a, b| a.union(b))
    }

    /// The edges of the selected visible pictures, with a name for each.
    #[must_use]
    pub fn picture_edges(&self, selection: &Selection) -> Vec<(String, Outline)> {
        let name = |b: &Bitmap| self.drawing.source.image_name(b.owner);
        let edge = |b: &Bitmap| Some((name(b), Outline::from_points(&areas::picture_corners(b)?, true)));
        self.selected_bitmaps(selection).filter_map(edge).collect()
    }

    /// The selected bitmaps.
    fn selected_bitmaps(&self, selection: &Selection) -> impl Iterator<Item = &Bitmap> {
        let all = self.drawing.scene().bitmaps.iter().zip(self.are_bitmaps_selected(selection));
        all.filter_map(|(bitmap, is_selected)| is_selected.then_some(bitmap))
    }

    /// For each bitmap, `true` if it is selected.
    fn are_bitmaps_selected(&self, selection: &Selection) -> Vec<bool> {
        let elements = selection.resolve(&self.drawing.source);
        let bitmaps = self.drawing.scene().bitmaps.iter();
        bitmaps.map(|b| b.bends && b.owner.map_or(selection.is_everything(), |e| elements[e])).collect()
    }

    /// The selected artwork, without strokes.
    fn counted(&self, selection: &Selection) -> areas::Counted {
        let parts = self.drawing.selected_parts(selection);
        areas::Counted { parts, bitmaps: self.are_bitmaps_selected(selection), strokes: false }
    }

    /// Bounding box of the visible area of the selected shapes, without stroke widths, and pictures: without artwork that is off the page
    /// or hidden by clip paths, masks or zero opacity. If nothing is visible, [`Document::artwork_box`].
    #[must_use]
    pub fn seen_box(&self, selection: &Selection) -> Option<Rect> {
        self.counted_box(selection, &self.counted(selection))
    }

    /// Bounding box of the visible area of the counted artwork; if nothing is visible, of all that is selected.
    fn counted_box(&self, selection: &Selection, counted: &areas::Counted) -> Option<Rect> {
        let seen = areas::seen_box(self.drawing.scene(), self.drawing.specified_area(), counted);
        seen.or_else(|| self.artwork_box(selection))
    }

    /// The box of the visible area, [`Document::seen_box`], with strokes extended by half their width.
    #[must_use]
    pub fn painted_box(&self, selection: &Selection) -> Option<Rect> {
        self.counted_box(selection, &areas::Counted { strokes: true, ..self.counted(selection) })
    }

    /// The box of the visible area, `seen` ([`Document::seen_box`]), extended by the areas of the shapes in it that lie off the page.
    /// `None` if there are none.
    #[must_use]
    pub fn uncut_box(&self, selection: &Selection, seen: Rect) -> Option<Rect> {
        let page = self.drawing.specified_area()?;
        if seen.x0 > page.x0 && seen.y0 > page.y0 && seen.x1 < page.x1 && seen.y1 < page.y1 {
            return None;
        }
        areas::uncut_box(self.drawing.scene(), page, &self.counted(selection)).filter(|b| *b != seen)
    }

    /// The selected painted shapes, in painting order.
    pub fn selected<'a>(&'a self, selection: &Selection) -> impl Iterator<Item = &'a Shape> + use<'a> {
        self.shapes().iter().zip(self.are_selected(selection)).filter(|(s, is)| *is && s.painted).map(|(s, _)| s)
    }

    /// For each of [`Document::shapes`], `true` if it is selected.
    #[must_use]
    pub fn are_selected(&self, selection: &Selection) -> Vec<bool> {
        self.drawing.selected_parts(selection)
    }

    /// Returns `true` if the selection holds a painted shape or a bitmap.
    #[must_use]
    pub fn has_artwork(&self, selection: &Selection) -> bool {
        self.selected(selection).next().is_some() || self.selected_bitmaps(selection).next().is_some()
    }

    /// Checks that every selector matches something.
    ///
    /// # Errors
    /// Returns [`Error::Input`] with the first selector that matches no element, or selects nothing painted, and similar names.
    pub fn check_selection(&self, selection: &Selection) -> Result<(), Error> {
        /// Comparisons of an element with a selector, including the one that selects by it alone.
        const SELECTED: usize = 3;
        /// Comparisons of an element with a selector that excludes.
        const EXCLUDED: usize = 2;
        let source = &self.drawing.source;
        let each = SELECTED * selection.select.len() + EXCLUDED * selection.exclude.len();
        let counted = self.budget().spend(cost::COMPARISON * each as f64 * source.elements.len() as f64);
        counted.map_err(|e| Error::limit(self.name(), "selecting by so many names takes", e))?;
        for selector in selection.select.iter().chain(&selection.exclude) {
            if !matches_any(source, selector) {
                let hint = similar(candidates(source, selector), selector, "names");
                return Err(Error::input(self.name(), format!("nothing matches `{selector}`; {hint}")));
            }
        }
        for selector in &selection.select {
            let alone = Selection { select: vec![selector.clone()], ..Selection::default() };
            if !self.has_artwork(&alone) {
                return Err(Error::input(self.name(), format!("`{selector}` holds nothing that is painted")));
            }
        }
        Ok(())
    }

    /// The outlines of the drawing, for a plotter or cutter.
    ///
    /// # Errors
    /// [`Error::Input`] if the drawing nests too deep for the available memory.
    pub fn plot(&self) -> Result<Plot, Error> {
        let (scene, source) = (self.drawing.scene(), &self.drawing.source);
        // Not inside `with_stack`, as it may wait for other threads.
        let _ = self.drawing.shapes();
        self.drawing.with_stack(|| Ok(plot::plot(scene, source)))
    }

    /// The lettering among the selected painted shapes.
    #[must_use]
    pub fn lettering(&self, selection: &Selection) -> Lettering {
        lettering(&self.drawing, selection)
    }

    /// The objects among the selected painted shapes, from left to right, as letters without outlines: each selected element or, if the
    /// whole drawing is selected, each member of the outermost group that has several. Members whose boxes overlap are one object.
    #[must_use]
    pub fn objects(&self, selection: &Selection) -> Vec<Letter> {
        objects(&self.drawing, selection).iter().map(|o| o.with_outline(Outline::default())).collect()
    }

    /// For each shape of [`Document::selected`], the area that its stroke covers in root user space, to be filled by the nonzero rule,
    /// within `tolerance` there; `None` if it has no stroke.
    ///
    /// # Errors
    /// [`Exceeded`] if a stroke has more segments than the limit allows.
    pub fn strokes(&self, selection: &Selection, tolerance: f64) -> Result<Vec<Option<Outline>>, Exceeded> {
        let (scene, selected) = (self.drawing.scene(), self.drawing.selected_parts(selection));
        let all = scene.parts.iter().zip(self.shapes()).zip(selected);
        let painted = all.filter(|((_, s), is_selected)| *is_selected && s.painted);
        painted.map(|((p, _), _)| stroked(p, scene.to_px, tolerance, self.budget())).collect()
    }

    /// For each shape of [`Document::selected`], its outline after letters have been placed one by one; `None` if it has no placed letters.
    #[must_use]
    pub fn placed(&self, options: &WarpOptions) -> Vec<Option<Outline>> {
        placed_outlines(&self.drawing, options)
    }

    /// Every path-like element of the file in document order, painted or not.
    #[must_use]
    pub fn paths(&self) -> Vec<NamedPath> {
        let elements = &self.drawing.source.elements;
        let shapes = (0..elements.len()).filter(|&e| is_shape(&elements[e].tag));
        let groups = self.groups();
        shapes.filter_map(|e| Some(NamedPath { group: groups[e].clone(), ..self.named_path(e)? })).collect()
    }

    /// For every element without an id, the value of [`NamedPath::group`].
    fn groups(&self) -> Vec<Option<Arc<str>>> {
        let source = &self.drawing.source;
        let mut nearest: Vec<Arc<str>> = Vec::with_capacity(source.elements.len());
        let mut out = Vec::with_capacity(source.elements.len());
        // Parents precede their children.
        for (e, element) in source.elements.iter().enumerate() {
            let outer = element.parent.map_or_else(|| "".into(), |p| nearest[p].clone());
            let id = source.attr(e, "id").filter(|v| !v.is_empty());
            out.push(id.is_none().then(|| outer.clone()));
            nearest.push(id.map_or(outer, |id| id.as_ref().into()));
        }
        out
    }

    /// Finds a path by its id, or else by its Inkscape label, or else by its title; a leading `#` is ignored. The path may be invisible or
    /// in `<defs>`. The name of a group with exactly one path stands for that path.
    ///
    /// # Errors
    /// Returns [`Error::Input`] with the names of similar paths.
    pub fn path(&self, name: &str) -> Result<NamedPath, Error> {
        let source = &self.drawing.source;
        let wanted = name.strip_prefix('#').unwrap_or(name);
        let found: Vec<ElementId> = (1..source.elements.len()).filter(|&e| is_named(source, e, wanted)).collect();
        let by_id = found.iter().copied().filter(|&e| source.attr(e, "id").is_some_and(|v| v == wanted));
        let by_label = found.iter().copied().filter(|&e| source.label(e).is_some_and(|v| v == wanted));
        for e in by_id.chain(by_label).chain(found.iter().copied()) {
            let is_shape = |&e: &ElementId| is_shape(&source.elements[e].tag);
            let mut shapes = source.descendants(e).filter(is_shape);
            let only = Some(e).filter(is_shape).or_else(|| shapes.next().filter(|_| shapes.next().is_none()));
            if let Some(path) = only.and_then(|e| self.named_path(e)) {
                return Ok(path);
            }
        }
        Err(self.no_such_path(wanted, !found.is_empty()))
    }

    /// The error for a name that stands for no path. `exists` is `true` if it is the name of something else.
    fn no_such_path(&self, wanted: &str, exists: bool) -> Error {
        let names = self.paths().into_iter().map(|p| p.label.or(p.title).unwrap_or(p.id)).collect();
        let place = format!("{}#{wanted}", self.name());
        let what = if exists { "this is not a single path" } else { "there is no path of this name" };
        Error::input(place, format!("{what}; {}", similar(names, wanted, "paths")))
    }

    fn named_path(&self, e: ElementId) -> Option<NamedPath> {
        named_path(self.drawing.scene(), &self.drawing.reader(), e)
    }

    /// Bends everything selected by `options` with `map`, a map of root user space.
    ///
    /// # Errors
    /// Returns [`Error::Geometry`] with the name of a shape that the map cannot bend, unless `options` has
    /// [`OnError::Skip`](crate::OnError::Skip). Returns [`Error::Input`] if the structure must be kept and cannot be.
    pub fn warp(&self, map: &dyn Map, options: &WarpOptions) -> Result<WarpedDocument, Error> {
        self.warp_each(&[(map, options)])
    }

    /// Bends parts of the drawing, each by its map: the part that the options beside the map select. Shapes that share an edge keep sharing
    /// it if one map bends both. For the document as a whole, such as its page, the first options count.
    ///
    /// # Errors
    /// [`Error::Geometry`] with the name of a shape that its map cannot bend, unless the options have [`OnError::Skip`]; [`Error::Input`]
    /// if the structure must be kept and cannot be.
    pub fn warp_each(&self, bends: &[(&dyn Map, &WarpOptions)]) -> Result<WarpedDocument, Error> {
        let each = bends.iter().map(|(map, options)| Bend::new(*map, (*options).clone())).collect();
        bends.iter().try_for_each(|(_, options)| options.refit.check())?;
        let document = bends.first().map_or_else(|| WarpOptions::new(refit::Options::new(1.0)), |b| b.1.clone());
        let bends = &Bends::new(&self.drawing.source, each, &document);
        // If nothing moves, return the source unchanged.
        let page_stays = document.page == PageFit::None || (document.page == PageFit::Auto && document.grown.is_none());
        if bends.is_identity() && page_stays && document.structure != Structure::Flatten {
            let svg = self.drawing.source.as_in_file().into_owned();
            return Ok(WarpedDocument { svg, ..WarpedDocument::default() });
        }
        let simplifies = matches!(document.edit, Some(Edit::Simplify { .. }));
        let resolved_again = if simplifies { self.drawing.at_originals()? } else { bends.divided(&self.drawing)? };
        let drawing = resolved_again.as_ref().unwrap_or(&self.drawing);
        match fits::with_tiles(drawing, bends)? {
            Some(tiled) => warp(&tiled, bends),
            None => warp(drawing, bends),
        }
    }

    /// Divides the drawing by selections: each part holds the elements that an equal set of them selects. Elements that none selects are in
    /// no part.
    #[must_use]
    pub fn divide(&self, selections: &[Selection]) -> Vec<Division> {
        select::divide(&self.drawing.source, selections)
    }

    /// The union of some selections.
    #[must_use]
    pub fn united<'a>(&self, selections: impl Iterator<Item = &'a Selection>) -> Selection {
        Selection::union(&self.drawing.source, selections)
    }
}

/// Bends a drawing and writes the result.
fn warp(drawing: &Drawing, bends: &Bends<'_>) -> Result<WarpedDocument, Error> {
    let mut out = WarpedDocument::default();
    let mut bent = bend(drawing, bends, &mut out)?;
    bent.filters = drawing.with_stack(|| Ok(write::bent_filters::outcomes(&WriteInput::new(drawing, &bent, bends))))?;
    for (slot, outcome) in &bent.filters {
        let s = &drawing.scene().slots[*slot];
        let name = s.owner.or(s.element).map(|e| drawing.source.display_name(e)).unwrap_or_default();
        out.filters[usize::from(matches!(outcome, FilterOutcome::Fits))].push(name);
    }
    let input = WriteInput::new(drawing, &bent, bends);
    drawing.with_stack(|| write::document::write(&input, &mut out))?;
    Ok(out)
}

/// Lists the names most like `wanted`. `what` is the plural of the objects that they name.
fn similar(mut names: Vec<String>, wanted: &str, what: &str) -> String {
    /// Number of names listed, about two lines.
    const SHOWN: usize = 12;
    let all = names.len();
    names.sort_by_cached_key(|n| distance(n, wanted));
    names.truncate(SHOWN);
    match (names.is_empty(), all > SHOWN) {
        (true, _) => format!("the file has no {what}"),
        (_, true) => format!("among the {all} {what} are {}", names.join(", ")),
        _ => format!("the {what} are {}", names.join(", ")),
    }
}

/// Edit distance without regard to case, over at most 40 characters, so that long names take little time.
fn distance(a: &str, b: &str) -> usize {
    const MAX_CHARACTERS: usize = 40;
    let [a, b] = [a, b].map(|s| s.chars().take(MAX_CHARACTERS).flat_map(char::to_lowercase).collect::<String>());
    strsim::levenshtein(&a, &b)
}
