//! State of the walk over usvg's tree, with lookups of source elements and exact transforms.

use crate::scene::geometry::{GeometryReader, affine, f32_bits, from_usvg, is_near, rect, same_path};
use crate::scene::lettering::Owners;
use crate::scene::model::{Clip, LazyOutline, PartRole, Referrer, Scene, SceneNote, Slot};
use crate::source::elements::{ElementId, Unpatchable, is_shape};
use crate::source::text::SourceText;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point, Rect};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use usvg::tiny_skia_path as ts;

/// Key of a definition in one frame: its address, the frame, the slot, and the bend of its referrers.
type DefKey = (usize, [u64; 6], Option<usize>, Option<usize>);

/// A scene under construction.
pub(super) struct SceneBuilder<'a> {
    pub(super) scene: Scene,
    pub(super) reader: GeometryReader<'a>,
    pub(super) letters: &'a Owners,
    /// The patterns to lay out as geometry, if any.
    pub(super) tiling: Option<Tiling<'a>>,
    /// For every element, the index of its bend; empty if the drawing is not divided.
    division: &'a [Option<usize>],
    /// Source elements by their id in usvg's tree.
    ids: &'a HashMap<String, Vec<ElementId>>,
    /// Transforms in the source by their f32 values; `None` for a value to which two different transforms round.
    exact: HashMap<[u32; 6], Option<Affine>>,
    /// Shapes in the source by their approximate start, to find the originals of copies, which have no id. Filled on first use.
    starts: Option<HashMap<[i64; 2], Vec<ElementId>>>,
    /// Outlines of the elements in `starts`.
    outlines: HashMap<ElementId, Outline>,
    /// Indices of the clip paths and masks resolved so far.
    pub(super) clip_index: HashMap<DefKey, usize>,
    pub(super) mask_index: HashMap<DefKey, usize>,
    /// Elements with a shared id that have been assigned to a part.
    taken: HashSet<ElementId>,
    /// `true` if the source may set a page background.
    pub(super) may_have_background: bool,
    /// The group whose content is in root user space, and whose transform leads from there to px.
    pub(super) top: Option<*const usvg::Group>,
    /// Nesting depth in drawings shown as images, whose ids are not the source's.
    pub(super) foreign_depth: usize,
    /// Transforms of markers by the addresses of their groups; `None` for hidden markers.
    pub(super) markers: HashMap<usize, Option<Affine>>,
    /// Shapes whose markers have other transforms than in usvg's tree.
    pub(super) marked: HashSet<ElementId>,
    /// Elements with `vector-effect: non-scaling-stroke`.
    pub(super) fixed_widths: HashSet<ElementId>,
}

/// Properties inherited in the walk.
#[derive(Clone, Copy)]
pub(super) struct Context {
    /// The enclosing element that is replaced as a whole if something inside changes.
    pub(super) owner: Option<ElementId>,
    pub(super) role: PartRole,
    /// Index of the innermost slot.
    pub(super) slot: Option<usize>,
    /// The enclosing `image` element.
    pub(super) image: Option<ElementId>,
    /// The viewport that clips an image inside, in the coordinates of the enclosing group.
    pub(super) viewport: Option<Rect>,
    /// In a definition, the index of the bend of its referrers.
    pub(super) bend: Option<usize>,
}

impl Context {
    /// The context outside all owners, slots and images.
    pub(super) fn top(role: PartRole) -> Self {
        Self { owner: None, role, slot: None, image: None, viewport: None, bend: None }
    }
}

impl<'a> SceneBuilder<'a> {
    pub(super) fn new(
        reader: GeometryReader<'a>,
        letters: &'a Owners,
        tiling: Option<Tiling<'a>>,
        division: &'a [Option<usize>],
    ) -> Self {
        let source = reader.source;
        Self {
            scene: Scene { unpatchable: source.unpatchable.clone(), ..Scene::default() },
            reader,
            letters,
            tiling,
            division,
            ids: source.by_tree_id(),
            exact: exact_transforms(&reader),
            starts: None,
            outlines: HashMap::new(),
            clip_index: HashMap::new(),
            mask_index: HashMap::new(),
            taken: HashSet::new(),
            may_have_background: source.text.contains("background-color"),
            top: None,
            foreign_depth: 0,
            markers: HashMap::new(),
            marked: HashSet::new(),
            fixed_widths: fixed_widths(source),
        }
    }

    /// The index of the bend that applies to a referrer: its element's, or within a definition, the one of the definition's referrers.
    pub(super) fn bend_of(&self, referrer: Referrer, context: Context) -> Option<usize> {
        if matches!(context.role, PartRole::Clip | PartRole::Mask) {
            return context.bend;
        }
        referrer.owner.or(referrer.element).and_then(|e| self.division.get(e).copied().flatten())
    }

    /// The source elements with an id of usvg's tree.
    fn elements(&self, id: &str) -> &'a [ElementId] {
        self.ids.get(id).filter(|_| self.foreign_depth == 0).map_or(&[][..], Vec::as_slice)
    }

    /// The source element with an id of usvg's tree, if there is exactly one.
    pub(super) fn element(&self, id: &str) -> Option<ElementId> {
        match self.elements(id) {
            [e] => Some(*e),
            _ => None,
        }
    }

    /// The last definition with the given id and tag.
    pub(super) fn definition(&self, id: &str, tag: &str) -> Option<ElementId> {
        let all = self.reader.source.by_id().get(id).filter(|_| self.foreign_depth == 0)?;
        all.iter().copied().rfind(|&e| self.tag(e) == tag)
    }

    pub(super) fn tag(&self, e: ElementId) -> &'a str {
        &self.reader.source.elements[e].tag
    }

    /// Returns `true` if anything inside a group has an id of the source.
    pub(super) fn has_ids(&self, g: &usvg::Group) -> bool {
        g.children().iter().any(|c| {
            (self.ids.contains_key(c.id()) && !c.id().is_empty())
                || matches!(c, usvg::Node::Group(g) if self.has_ids(g))
        })
    }

    /// Returns `true` for the group whose content is in root user space.
    pub(super) fn is_top(&self, g: &usvg::Group) -> bool {
        self.top.is_some_and(|t| std::ptr::eq(t, g))
    }

    /// A group's transform in f64: its element's if that agrees, or else the only one in the source with an equal value in f32.
    pub(super) fn exact_transform(&self, t: usvg::Transform, element: Option<ElementId>) -> Affine {
        let rounded = affine(t);
        if t.is_identity() {
            return rounded;
        }
        if let Some(exact) = element.and_then(|e| self.reader.own_transform(e))
            && is_near(exact, rounded)
        {
            return exact;
        }
        self.exact.get(&f32_bits(rounded)).copied().flatten().unwrap_or(rounded)
    }

    /// Records the reason why the source cannot be patched in place, unless there is one already.
    pub(super) fn unpatchable(&mut self, why: Unpatchable) {
        self.scene.unpatchable.get_or_insert(why);
    }

    /// Adds a clip path. Returns its index.
    pub(super) fn push_clip(&mut self, clip: Clip) -> usize {
        self.scene.clips.push(clip);
        self.scene.clips.len() - 1
    }
}

/// Finds the elements whose stroke width is in px.
fn fixed_widths(source: &SourceText) -> HashSet<ElementId> {
    const FIXED: &str = "non-scaling-stroke";
    if !source.text.contains(FIXED) {
        return HashSet::new();
    }
    (0..source.elements.len()).filter(|&e| source.property(e, "vector-effect").as_deref() == Some(FIXED)).collect()
}

/// Transforms in the source by their f32 values; `None` for a value to which two different transforms round.
fn exact_transforms(reader: &GeometryReader<'_>) -> HashMap<[u32; 6], Option<Affine>> {
    let mut out: HashMap<[u32; 6], Option<Affine>> = HashMap::new();
    for e in 0..reader.source.elements.len() {
        let may_transform = reader.source.attr(e, "transform").is_some()
            || matches!(reader.source.elements[e].tag.as_ref(), "use" | "svg");
        if may_transform && let Some(t) = reader.own_transform(e) {
            out.entry(f32_bits(t)).and_modify(|v| *v = v.filter(|v| *v == t)).or_insert(Some(t));
        }
    }
    out
}

/// Limit on the segments in all tiles of a drawing, since more would make the result slow to open.
const MAX_SEGMENTS: usize = 250_000;

/// Decides which patterns to lay out as geometry, within a limit on its size.
pub(crate) struct Tiling<'a> {
    /// Returns `true` if the pattern over an area must be laid out. The arguments are the element that is painted, the area in its
    /// user space, and the transform from there to root user space.
    pub(super) is_needed: &'a (dyn Fn(Painted, Rect, Affine) -> bool + Sync),
    /// `true` if patterns on strokes are laid out, too.
    pub(super) strokes: bool,
    /// Remaining number of segments.
    pub(super) budget: usize,
    /// Patterns that could not be laid out.
    pub(super) notes: Vec<SceneNote>,
}

/// The object that a pattern paints.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Painted {
    Element(Option<ElementId>),
    /// Content of a mask, with the index of the bend of its referrers if the drawing is divided.
    Mask(Option<usize>),
}

impl<'a> Tiling<'a> {
    pub(crate) fn new(is_needed: &'a (dyn Fn(Painted, Rect, Affine) -> bool + Sync), strokes: bool) -> Self {
        Self { is_needed, strokes, budget: MAX_SEGMENTS, notes: Vec::new() }
    }
}

/// Origin of a path.
pub(super) struct Traced {
    /// The shape element with the path's id.
    pub(super) source: Option<ElementId>,
    /// The original of a copy.
    pub(super) copied: Option<ElementId>,
    /// The element from which `outline` was read; `None` if it was converted from usvg's path.
    pub(super) drawn: Option<ElementId>,
    pub(super) outline: LazyOutline,
}

/// Finds the element and the outline of a path.
pub(super) fn trace(b: &mut SceneBuilder<'_>, p: &usvg::Path) -> Traced {
    let candidates = b.elements(p.id());
    let only = b.element(p.id()).filter(|&e| b.tag(e) == "path");
    if let Some((e, outline)) = only.and_then(|e| Some((e, path_outline(b, e)?))) {
        return Traced { source: Some(e), copied: None, drawn: Some(e), outline };
    }
    // Of several elements with the id, the outline decides.
    let shared = candidates.len() > 1;
    for &e in candidates {
        if !is_shape(b.tag(e)) || (shared && b.taken.contains(&e)) {
            continue;
        }
        let exact = b.reader.outline(e).filter(|o| !shared || same_path(o, p.data()));
        if exact.is_some() || !shared {
            if shared {
                b.taken.insert(e);
            }
            let drawn = exact.is_some().then_some(e);
            let outline = exact.unwrap_or_else(|| from_usvg(p.data())).into();
            return Traced { source: Some(e), copied: None, drawn, outline };
        }
    }
    let (copied, outline) = original(b, p.data()).unzip();
    let outline = outline.unwrap_or_else(|| from_usvg(p.data())).into();
    Traced { source: None, copied, drawn: copied, outline }
}

/// The outline of a `path` element; computed on first use.
fn path_outline(b: &SceneBuilder<'_>, e: ElementId) -> Option<LazyOutline> {
    let d = b.reader.source.attr(e, "d")?.into_owned();
    let read_ahead = Arc::clone(&b.reader.source.ahead);
    Some(LazyOutline::new(move || {
        let known = read_ahead.get().and_then(|known| known.get(&e).cloned());
        known.unwrap_or_else(|| Arc::new(Outline::from_svg_lossy(&d)))
    }))
}

/// A path's outline, read from the source if possible.
pub(super) fn known_outline(b: &mut SceneBuilder<'_>, p: &usvg::Path) -> Outline {
    let source = b.element(p.id()).filter(|&e| is_shape(b.tag(e)));
    let outline = source.and_then(|e| b.reader.outline(e)).or_else(|| Some(original(b, p.data())?.1));
    outline.unwrap_or_else(|| from_usvg(p.data()))
}

/// Finds the original of a copied path (in a `use`, in a marker), with its outline.
fn original(b: &mut SceneBuilder<'_>, path: &ts::Path) -> Option<(ElementId, Outline)> {
    /// The cell of a point in a grid that is coarse against f32 rounding. The eight neighbouring cells are searched, too.
    fn cell(p: Point) -> [i64; 2] {
        [p.x, p.y].map(|v| (v * 16.0).floor() as i64)
    }
    /// Limit on comparisons, so that a million equal copies don't take quadratic time.
    const MAX_TRIES: usize = 64;
    if b.starts.is_none() {
        let mut starts: HashMap<_, Vec<_>> = HashMap::new();
        for (e, el) in b.reader.source.elements.iter().enumerate() {
            if is_shape(&el.tag)
                && let Some(o) = b.reader.outline(e)
                && let Some(first) = o.subpaths.iter().find(|s| !s.segs.is_empty() || s.closed)
            {
                starts.entry(cell(first.start)).or_default().push(e);
                b.outlines.insert(e, o);
            }
        }
        b.starts = Some(starts);
    }
    let start = path.points().first()?;
    let [x, y] = cell(Point::new(f64::from(start.x), f64::from(start.y)));
    let starts = b.starts.as_ref()?;
    let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x.saturating_add(i), y.saturating_add(j)]));
    around
        .filter_map(|c| starts.get(&c))
        .flatten()
        .take(MAX_TRIES)
        .filter_map(|e| Some((*e, b.outlines.get(e)?)))
        .find(|(_, o)| same_path(o, path))
        .map(|(e, o)| (e, o.clone()))
}

/// A group about to be resolved.
pub(super) struct GroupAt<'g> {
    pub(super) group: &'g usvg::Group,
    /// The element with the group's id.
    pub(super) source: Option<ElementId>,
    /// The element with the group's id, or else the only shape, text or image for which usvg made the group.
    pub(super) element: Option<ElementId>,
    /// From outside the group to root user space.
    pub(super) parent: Affine,
    /// From inside the group to root user space.
    pub(super) frame: Affine,
}

/// Adds a slot if the group holds content that cannot be bent, and there is a transform to take the fit.
pub(super) fn add_slot(b: &mut SceneBuilder<'_>, at: &GroupAt<'_>, context: Context) -> Option<usize> {
    let g = at.group;
    let image = at.element.filter(|&e| b.tag(e) == "image");
    let is_drawing = holds_drawing(g);
    let has_bitmap = !is_drawing && g.children().iter().any(|c| matches!(c, usvg::Node::Image(_)));
    // The root has no transform that could take the fit, but a single image in it has.
    if (g.filters().is_empty() && (b.is_top(g) || is_drawing || (image.is_none() && !has_bitmap)))
        || matches!(context.role, PartRole::Clip | PartRole::Pattern)
        || context.slot.is_some_and(|s| image.is_some() && b.scene.slots[s].element == at.element)
    {
        return None;
    }
    // In a fragment, the group's transform is written; elsewhere, an element's.
    if context.owner.is_none() && b.scene.unpatchable.is_none() && !takes_fit(b, at, image.is_some()) {
        return None;
    }
    // The group of an image holds its placing, which is not the element's transform.
    let fits_outside = (image.is_some() && at.source == image) || (image.is_none() && has_bitmap);
    let content = rect(g.bounding_box());
    let outside = || (at.parent, affine(g.transform()).transform_rect_bbox(content));
    let (frame, area) = if fits_outside { outside() } else { (at.frame, content) };
    // The walk sets the end once it has seen all parts inside.
    let parts = b.scene.parts.len()..b.scene.parts.len();
    let (outer, element, owner) = (context.slot, at.element, context.owner);
    b.scene.slots.push(Slot { outer, frame, area, fits_outside, element, owner, parts });
    Some(b.scene.slots.len() - 1)
}

/// Returns `true` if the fit can be written to the `transform` of the group's element.
fn takes_fit(b: &SceneBuilder<'_>, at: &GroupAt<'_>, is_image: bool) -> bool {
    let source = b.reader.source;
    let only_transform_attribute = |e: ElementId| {
        b.tag(e) != "svg"
            && source.attr(e, "transform-origin").is_none()
            && !source.attr(e, "style").is_some_and(|s| s.contains("transform"))
            && !source.css_declares("transform")
    };
    at.element.is_some_and(|e| {
        only_transform_attribute(e)
            && ((at.source == Some(e) && is_image)
                || b.reader.own_transform(e).is_some_and(|t| is_near(t, affine(at.group.transform()))))
    })
}

/// Returns `true` if a group's only content is a drawing shown as an image.
pub(super) fn holds_drawing(g: &usvg::Group) -> bool {
    match g.children() {
        [usvg::Node::Image(i)] => matches!(i.kind(), usvg::ImageKind::SVG(_)),
        [usvg::Node::Group(g)] => g.id().is_empty() && holds_drawing(g),
        _ => false,
    }
}
