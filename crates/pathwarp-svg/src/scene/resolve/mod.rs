//! Builds the scene: walks usvg's tree, finds the source element, the true outline and the exact transform of everything in it.

mod cut;
mod tiles;
mod vector_image;

pub(crate) use tiles::Tiling;

use crate::scene::geometry::{self, Reader};
use crate::scene::lettering::{self, Line};
use crate::scene::letters::Owners;
use crate::scene::model::{Bitmap, Clip, Group, Local, Mask, Node, Part, Referrer, Role, Scene, Slot, Tile};
use crate::source::cascade;
use crate::source::text::{ElementId, Source, is_shape};
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point, Rect, Size};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use usvg::{Fill, Stroke};
use vector_image::holds_vector;

struct Builder<'a> {
    reader: Reader<'a>,
    /// What the ids of usvg's tree stand for.
    ids: &'a HashMap<String, Vec<ElementId>>,
    letters: &'a Owners,
    /// The source's transforms by what they are in f32; `None` where two different ones round to the same.
    exact: HashMap<[u32; 6], Option<Affine>>,
    /// The source's shapes by roughly where they start: for copies, which carry no id. Filled when first needed.
    starts: Option<HashMap<[i64; 2], Vec<ElementId>>>,
    outlines: HashMap<ElementId, Outline>,
    parts: Vec<Part>,
    clips: Vec<Clip>,
    masks: Vec<Mask>,
    tiles: Vec<Tile>,
    pictures: HashMap<usize, Group>,
    clip_index: HashMap<DefKey, usize>,
    mask_index: HashMap<DefKey, usize>,
    unkeepable: Option<String>,
    taken: HashSet<ElementId>,
    slots: Vec<Slot>,
    bitmaps: Vec<Bitmap>,
    lines: Vec<Line>,
    fonts: &'a usvg::fontdb::Database,
    /// Whether the source speaks of a page background.
    backed: bool,
    /// The group that holds root user space; its own transform leads out of it.
    top: Option<*const usvg::Group>,
    /// Which patterns become geometry.
    tiling: Option<Tiling<'a>>,
    /// How deep in drawings shown as images; ids are none of the source's there.
    abroad: usize,
    foreign: HashSet<usize>,
    /// Elements whose strokes never scale.
    fixed_widths: HashSet<ElementId>,
}

/// A definition as one frame sees it: which, from where, in which slot.
type DefKey = (usize, [u64; 6], Option<usize>);

#[derive(Clone, Copy)]
struct Context {
    owner: Option<ElementId>,
    role: Role,
    slot: Option<usize>,
    /// The `image` element around.
    image: Option<ElementId>,
}

/// Resolves the drawing. `tiling` says which patterns become geometry.
pub(crate) fn build(
    tree: &usvg::Tree,
    source: &Source,
    letters: &Owners,
    dpi: f64,
    tiling: Option<Tiling<'_>>,
) -> Scene {
    let page = Size::new(f64::from(tree.size().width()), f64::from(tree.size().height()));
    let reader = Reader { source, dpi, page };
    let mut b = Builder {
        reader,
        ids: source.ids(),
        letters,
        exact: exact_transforms(&reader),
        starts: None,
        outlines: HashMap::new(),
        parts: Vec::new(),
        clips: Vec::new(),
        masks: Vec::new(),
        tiles: Vec::new(),
        pictures: HashMap::new(),
        clip_index: HashMap::new(),
        mask_index: HashMap::new(),
        unkeepable: source.unpatchable.clone(),
        taken: HashSet::new(),
        slots: Vec::new(),
        bitmaps: Vec::new(),
        lines: Vec::new(),
        fonts: tree.fontdb(),
        backed: source.text.contains("background-color"),
        top: None,
        tiling,
        abroad: 0,
        foreign: HashSet::new(),
        fixed_widths: fixed_widths(source),
    };
    let (top, to_px) = b.root_group(tree, page);
    b.top = Some(std::ptr::from_ref(top));
    let root = b.group(top, Affine::IDENTITY, Context { owner: None, role: Role::Paint, slot: None, image: None });
    let Builder {
        parts, clips, masks, tiles, pictures, slots, bitmaps, mut lines, unkeepable, tiling, foreign, ..
    } = b;
    let notes = tiling.map(Tiling::notes).unwrap_or_default();
    let mut by_source: HashMap<_, Vec<_>> = HashMap::new();
    for (i, p) in parts.iter().enumerate() {
        if let Some(e) = p.source {
            by_source.entry(e).or_default().push(i);
        }
    }
    lines.extend(lettering::marked_lines(&reader, &parts, &by_source));
    Scene {
        root,
        parts,
        clips,
        masks,
        tiles,
        pictures,
        slots,
        bitmaps,
        lines,
        by_source,
        to_px,
        unkeepable,
        notes,
        foreign,
    }
}

/// The elements with `vector-effect: non-scaling-stroke`.
fn fixed_widths(source: &Source) -> HashSet<ElementId> {
    const FIXED: &str = "non-scaling-stroke";
    if !source.text.contains(FIXED) {
        return HashSet::new();
    }
    let values = cascade::values(source, "vector-effect").into_iter().enumerate();
    values.filter(|(_, v)| v.as_deref() == Some(FIXED)).map(|(e, _)| e).collect()
}

fn bits(m: Affine) -> [u64; 6] {
    m.as_coeffs().map(f64::to_bits)
}

fn f32_bits(m: Affine) -> [u32; 6] {
    // Adding zero makes -0 and 0 one.
    m.as_coeffs().map(|v| (v as f32 + 0.0).to_bits())
}

fn exact_transforms(reader: &Reader<'_>) -> HashMap<[u32; 6], Option<Affine>> {
    let mut out: HashMap<[u32; 6], Option<Affine>> = HashMap::new();
    for e in 0..reader.source.elements.len() {
        let moved = reader.source.attr(e, "transform").is_some()
            || matches!(reader.source.elements[e].tag.as_ref(), "use" | "svg");
        if moved && let Some(t) = reader.own_transform(e) {
            out.entry(f32_bits(t)).and_modify(|v| *v = v.filter(|v| *v == t)).or_insert(Some(t));
        }
    }
    out
}

/// Whether `b` is `a` up to f32 rounding of a short product.
fn near(a: Affine, b: Affine) -> bool {
    let (a, b) = (a.as_coeffs(), b.as_coeffs());
    let linear = a[..4].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let shift = a[4].abs().max(a[5].abs()).max(linear);
    (0..4).all(|i| (a[i] - b[i]).abs() <= 1e-6 * linear) && (4..6).all(|i| (a[i] - b[i]).abs() <= 1e-6 * shift)
}

impl Builder<'_> {
    /// The group that holds root user space, and the transform from there to px.
    fn root_group<'t>(&self, tree: &'t usvg::Tree, page: Size) -> (&'t usvg::Group, Affine) {
        let by_source = self.reader.view_box_transform(0, page);
        let [usvg::Node::Group(g)] = tree.root().children() else { return (tree.root(), by_source) };
        // usvg wraps everything in a group exactly when the root has a transform or a background of its own.
        let moved =
            f32_bits(by_source) != f32_bits(Affine::IDENTITY) || self.reader.source.attr(0, "transform").is_some();
        let backed = self.backed
            && g.id().is_empty()
            && g.transform().is_identity()
            && matches!(g.children().first(), Some(usvg::Node::Path(p)) if p.id().is_empty());
        if !moved && !backed {
            return (tree.root(), by_source);
        }
        let t = geometry::affine(g.transform());
        // usvg centres the drawing in f32, where numbers of the page's size cancel.
        let slack = 1e-6 * (page.width + page.height + 1.0);
        let (a, b) = (by_source.as_coeffs(), t.as_coeffs());
        let agree =
            near(Affine::new([a[0], a[1], a[2], a[3], 0.0, 0.0]), Affine::new([b[0], b[1], b[2], b[3], 0.0, 0.0]));
        let agree = agree && (a[4] - b[4]).abs() <= slack && (a[5] - b[5]).abs() <= slack;
        // A page as large as its viewBox up to rounding has no such group.
        let [.., x, y] = a;
        let rounding = near(Affine::new([a[0], a[1], a[2], a[3], 0.0, 0.0]), Affine::IDENTITY)
            && x.abs().max(y.abs()) <= slack
            && self.reader.source.attr(0, "transform").is_none();
        if rounding && !agree && !backed {
            return (tree.root(), by_source);
        }
        (g, if agree { by_source } else { t })
    }

    /// The one element that an id stands for.
    fn element(&self, id: &str) -> Option<ElementId> {
        match self.ids.get(id).filter(|_| self.abroad == 0)?.as_slice() {
            [one] => Some(*one),
            _ => None,
        }
    }

    fn tag(&self, e: ElementId) -> &str {
        &self.reader.source.elements[e].tag
    }

    /// A group's transform in f64: its element's, or the only one in the source that is the same in f32.
    fn refine(&self, t: usvg::Transform, element: Option<ElementId>) -> Affine {
        let rough = geometry::affine(t);
        if t.is_identity() {
            return rough;
        }
        if let Some(own) = element.and_then(|e| self.reader.own_transform(e))
            && near(own, rough)
        {
            return own;
        }
        self.exact.get(&f32_bits(rough)).copied().flatten().unwrap_or(rough)
    }

    /// The element that a group without id belongs to: the one shape or text it was made for.
    fn only_child(&self, g: &usvg::Group) -> Option<ElementId> {
        let mut found = None;
        for c in g.children() {
            let leaf = match c {
                usvg::Node::Path(_) | usvg::Node::Text(_) => self.element(c.id()),
                usvg::Node::Group(_) => self.element(c.id()).filter(|&e| self.tag(e) == "image"),
                usvg::Node::Image(_) => None,
            };
            if let Some(e) = leaf
                && found.replace(e).is_some()
            {
                return None;
            }
        }
        found
    }

    fn group(&mut self, g: &usvg::Group, parent: Affine, mut context: Context) -> Group {
        let source = self.element(g.id());
        let element = source.or_else(|| self.only_child(g));
        let top = self.top.is_some_and(|t| std::ptr::eq(t, g));
        let transform = if top { Affine::IDENTITY } else { self.refine(g.transform(), element) };
        let frame = parent * transform;
        let vector = holds_vector(g);
        let owner = context.owner.or(source.filter(|&e| self.tag(e) == "use" || vector && self.tag(e) == "image"));
        let slot = self.slot(g, source, element, parent, frame, Context { owner, ..context });
        context.slot = slot.or(context.slot);
        let referrer = Referrer { element, owner: context.owner };
        let clip = g.clip_path().map(|c| self.clip(c, frame, referrer, context.slot));
        let mask = g.mask().map(|m| self.mask(m, frame, referrer, context.slot));
        context.owner = owner;
        context.image = source.filter(|&e| self.tag(e) == "image").or(context.image);
        for p in g.filters().iter().flat_map(|f| f.primitives()) {
            if let usvg::filter::Kind::Image(image) = p.kind() {
                self.picture(image.root());
            }
        }
        let markers = if context.owner.is_none() { self.marker_groups(g) } else { Vec::new() };
        let mut children = Vec::with_capacity(g.children().len());
        for (i, c) in g.children().iter().enumerate() {
            let marked = markers.iter().find(|m| m.0 == i).map(|m| m.1);
            let context = Context { owner: context.owner.or(marked), ..context };
            children.push(match c {
                usvg::Node::Group(c) => Node::Group(Box::new(self.group(c, frame, context))),
                usvg::Node::Path(p) => Node::Part(self.part(p, frame, context)),
                usvg::Node::Image(image) if matches!(image.kind(), usvg::ImageKind::SVG(_)) => {
                    let usvg::ImageKind::SVG(tree) = image.kind() else { continue };
                    let own = source.or(element).filter(|&e| self.tag(e) == "image");
                    let context = Context { owner: context.owner.or(own), ..context };
                    Node::Group(Box::new(self.vector_image(image, tree, frame, context)))
                }
                usvg::Node::Image(image) => {
                    let own = source.or(element).filter(|&e| self.tag(e) == "image").or(context.image);
                    let aspect = own.or(context.owner).and_then(|e| self.reader.source.attr(e, "preserveAspectRatio"));
                    self.bitmaps.push(Bitmap {
                        image: image.clone(),
                        frame,
                        placing: transform,
                        slot: context.slot,
                        owner: context.owner.or(own),
                        bends: context.role != Role::Pattern,
                        // Without an element to ask, an image that is cut cannot be told.
                        sliced: own.is_none() && context.owner.is_none() || aspect.is_some_and(|a| a.contains("slice")),
                    });
                    Node::Image(self.bitmaps.len() - 1)
                }
                usvg::Node::Text(t) => self.text(t, frame, context),
            });
        }
        if let Some(s) = slot {
            self.slots[s].parts.end = self.parts.len();
        }
        Group {
            source,
            owner,
            transform,
            opacity: g.opacity().get(),
            blend: g.blend_mode(),
            isolate: g.isolate(),
            clip,
            mask,
            filters: g.filters().to_vec(),
            slot,
            children,
        }
    }

    /// A new slot, if the group holds what cannot be bent and there is a transform to take the slot up.
    fn slot(
        &mut self,
        g: &usvg::Group,
        source: Option<ElementId>,
        element: Option<ElementId>,
        parent: Affine,
        frame: Affine,
        context: Context,
    ) -> Option<usize> {
        let image = element.filter(|&e| self.tag(e) == "image");
        let vector = holds_vector(g);
        let raster = !vector && g.children().iter().any(|c| matches!(c, usvg::Node::Image(_)));
        // The root has no transform of its own to take a slot up; an only image in it has.
        let top = self.top.is_some_and(|t| std::ptr::eq(t, g));
        if g.filters().is_empty() && (top || vector || image.is_none() && !raster)
            || matches!(context.role, Role::Clip | Role::Pattern)
            || context.slot.is_some_and(|s| image.is_some() && self.slots[s].element == element)
        {
            return None;
        }
        let owned = context.owner.is_some();
        let free = |e: ElementId| {
            self.tag(e) != "svg"
                && self.reader.source.attr(e, "transform-origin").is_none()
                && !self.reader.source.attr(e, "style").is_some_and(|s| s.contains("transform"))
                && !self.reader.source.css_mentions("transform")
        };
        // In a fragment the group's own transform is written; elsewhere it is an element's.
        let takes = element.is_some_and(|e| {
            free(e)
                && (source == Some(e) && image.is_some()
                    || self.reader.own_transform(e).is_some_and(|t| near(t, geometry::affine(g.transform()))))
        });
        if !owned && !takes && self.unkeepable.is_none() {
            return None;
        }
        // An image's own group holds its placing, which is no transform of the element's.
        let before = image.is_some() && source == image || image.is_none() && raster;
        let b = g.bounding_box();
        let corners = Rect::new(f64::from(b.left()), f64::from(b.top()), f64::from(b.right()), f64::from(b.bottom()));
        let (frame, area) = if before {
            (parent, geometry::affine(g.transform()).transform_rect_bbox(corners))
        } else {
            (frame, corners)
        };
        let parts = self.parts.len()..self.parts.len();
        self.slots.push(Slot { outer: context.slot, frame, area, before, element, owner: context.owner, parts });
        Some(self.slots.len() - 1)
    }

    /// The children that belong to a shape with markers (the shape itself and the copies beside it), with its element.
    fn marker_groups(&self, g: &usvg::Group) -> Vec<(usize, ElementId)> {
        let mut out = Vec::new();
        let path = |i: usize| match g.children().get(i) {
            Some(usvg::Node::Path(p)) => self.element(p.id()).filter(|&e| is_shape(self.tag(e))),
            _ => None,
        };
        for (i, c) in g.children().iter().enumerate() {
            let usvg::Node::Group(c) = c else { continue };
            let anonymous = c.id().is_empty() && c.transform().is_identity() && c.opacity().get() == 1.0;
            if !anonymous || c.clip_path().is_some() || c.children().is_empty() {
                continue;
            }
            // Copies hang in groups of their own and carry no ids.
            let copies = c.children().iter().all(|m| matches!(m, usvg::Node::Group(m) if m.id().is_empty()));
            if !copies || has_known(c, self.ids) {
                continue;
            }
            for j in [i.wrapping_sub(1), i + 1] {
                if let Some(e) = path(j) {
                    out.push((i, e));
                    out.push((j, e));
                    break;
                }
            }
        }
        out
    }

    fn text(&mut self, t: &usvg::Text, frame: Affine, context: Context) -> Node {
        let element = self.element(t.id());
        if element.is_none() && context.owner.is_none() {
            self.unkept("a text cannot be told from another with the same id");
        }
        let context = Context { owner: context.owner.or(element), ..context };
        let first = self.parts.len();
        let content = self.group(t.flattened(), frame, context);
        if context.role == Role::Paint {
            let lines = lettering::shaped_lines(t, self.fonts, frame, &self.parts, first);
            self.lines.extend(lines.into_iter().map(|l| Line { owner: context.owner, ..l }));
        }
        let owners = element.and_then(|e| self.letters.get(&e)).cloned().unwrap_or_default();
        Node::Text { element, content: Box::new(content), owners }
    }

    fn unkept(&mut self, why: &str) {
        self.unkeepable.get_or_insert_with(|| why.to_owned());
    }

    fn part(&mut self, p: &usvg::Path, frame: Affine, context: Context) -> usize {
        let mut source = None;
        let mut copied = None;
        let mut outline = None;
        let candidates = self.ids.get(p.id()).filter(|_| self.abroad == 0).map_or(&[][..], Vec::as_slice);
        let shared = candidates.len() > 1;
        let only = self.element(p.id()).filter(|&e| self.tag(e) == "path");
        let later = only.and_then(|e| self.path_later(e, p.data()));
        if later.is_some() {
            source = only;
        }
        for &e in candidates.iter().filter(|_| later.is_none()) {
            if !is_shape(self.tag(e)) || (shared && self.taken.contains(&e)) {
                continue;
            }
            let exact = self.reader.outline(e).filter(|o| geometry::same_path(o, p.data()));
            if exact.is_some() || !shared {
                source = Some(e);
                outline = exact;
                if shared {
                    self.taken.insert(e);
                }
                break;
            }
        }
        let mut drawn = source.filter(|_| outline.is_some() || later.is_some());
        if source.is_none() {
            (copied, outline) = self.copy_of(p.data()).unzip();
            drawn = copied;
            // The page's own background is no artwork; it is the first thing of all.
            let background = self.parts.is_empty() && self.backed;
            if context.owner.is_none() && p.is_visible() && !background {
                self.unkept("a painted path cannot be traced to one element of the source");
            }
        }
        for paint in [p.fill().map(Fill::paint), p.stroke().map(Stroke::paint)] {
            if let Some(usvg::Paint::Pattern(pattern)) = paint {
                self.tile(pattern);
            }
        }
        let fixed_width = source.or(copied).is_some_and(|e| self.fixed_widths.contains(&e));
        let fill_tiles = self.tiles(p, false, frame, context, source);
        let stroke_tiles = if fixed_width { None } else { self.tiles(p, true, frame, context, source) };
        self.parts.push(Part {
            source,
            owner: context.owner,
            role: context.role,
            drawn,
            local: later.unwrap_or_else(|| outline.unwrap_or_else(|| geometry::from_usvg(p.data())).into()),
            frame,
            fill: p.fill().cloned(),
            stroke: p.stroke().cloned(),
            paint_order: p.paint_order(),
            rendering: p.rendering_mode(),
            visible: p.is_visible(),
            fixed_width,
            slot: context.slot,
            in_tile: false,
            fill_tiles,
            stroke_tiles,
        });
        self.parts.len() - 1
    }

    /// The outline of a `path` element that usvg has made `path` of: not worked out before it is asked for.
    fn path_later(&self, e: ElementId, path: &usvg::tiny_skia_path::Path) -> Option<Local> {
        let d = self.reader.source.attr(e, "d")?.into_owned();
        let path = path.clone();
        Some(Local::later(move || {
            let exact = Outline::from_svg_lossy(&d);
            if geometry::same_path(&exact, &path) { exact } else { geometry::from_usvg(&path) }
        }))
    }

    /// The element that a path (in a `use`, in a marker) is a copy of, and its own outline.
    /// A path's outline, the source's own where it is known.
    fn known_outline(&mut self, p: &usvg::Path) -> Outline {
        let own = self.element(p.id()).filter(|&e| is_shape(self.tag(e))).and_then(|e| self.reader.outline(e));
        let own = own.filter(|o| geometry::same_path(o, p.data()));
        own.or_else(|| self.copy_of(p.data()).map(|c| c.1)).unwrap_or_else(|| geometry::from_usvg(p.data()))
    }

    /// The source's own element and outline of a copied path (in a `use`, in a marker).
    fn copy_of(&mut self, path: &usvg::tiny_skia_path::Path) -> Option<(ElementId, Outline)> {
        /// Cells of the size of f32's rounding would miss neighbours; these are coarse enough, and three by three are asked.
        fn cell(p: Point) -> [i64; 2] {
            [p.x, p.y].map(|v| (v * 16.0).floor() as i64)
        }
        if self.starts.is_none() {
            let mut starts: HashMap<_, Vec<_>> = HashMap::new();
            for (e, el) in self.reader.source.elements.iter().enumerate() {
                if is_shape(&el.tag)
                    && let Some(o) = self.reader.outline(e)
                    && let Some(first) = o.subpaths.iter().find(|s| !s.segs.is_empty() || s.closed)
                {
                    starts.entry(cell(first.start)).or_default().push(e);
                    self.outlines.insert(e, o);
                }
            }
            self.starts = Some(starts);
        }
        let start = path.points().first()?;
        let [x, y] = cell(Point::new(f64::from(start.x), f64::from(start.y)));
        let starts = self.starts.as_ref()?;
        /// Enough for any drawing made by a person; a file of a million equal copies must not take forever.
        const TRIES: usize = 64;
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x.saturating_add(i), y.saturating_add(j)]));
        around
            .filter_map(|c| starts.get(&c))
            .flatten()
            .take(TRIES)
            .filter_map(|e| Some((*e, self.outlines.get(e)?)))
            .find(|(_, o)| geometry::same_path(o, path))
            .map(|(e, o)| (e, o.clone()))
    }

    fn clip(&mut self, c: &usvg::ClipPath, frame: Affine, referrer: Referrer, slot: Option<usize>) -> usize {
        let key = (std::ptr::from_ref(c) as usize, bits(frame), slot);
        if let Some(&i) = self.clip_index.get(&key) {
            self.clips[i].referrers.push(referrer);
            return i;
        }
        let first = self.parts.len();
        let def = self.element_of_def(c.id(), "clipPath");
        let transform = self.refine(c.transform(), def);
        let chained = Referrer { element: def, owner: None };
        let clip = c.clip_path().map(|c| self.clip(c, frame, chained, slot));
        // What is inside replaces nothing of the drawing's own tree.
        let inside = Context { owner: None, role: Role::Clip, slot, image: None };
        let kept = self.unkeepable.take();
        let root = self.group(c.root(), frame * transform, inside);
        self.unkeepable = kept;
        self.clips.push(Clip {
            id: c.id().to_owned(),
            transform,
            clip,
            root,
            referrers: vec![referrer],
            parts: first..self.parts.len(),
            foreign: self.abroad > 0,
        });
        self.clip_index.insert(key, self.clips.len() - 1);
        self.clips.len() - 1
    }

    fn mask(&mut self, m: &usvg::Mask, frame: Affine, referrer: Referrer, slot: Option<usize>) -> usize {
        let key = (std::ptr::from_ref(m) as usize, bits(frame), slot);
        if let Some(&i) = self.mask_index.get(&key) {
            self.masks[i].referrers.push(referrer);
            return i;
        }
        let first = self.parts.len();
        let chained = Referrer { element: self.element_of_def(m.id(), "mask"), owner: None };
        let mask = m.mask().map(|m| self.mask(m, frame, chained, slot));
        let kept = self.unkeepable.take();
        let root = self.group(m.root(), frame, Context { owner: None, role: Role::Mask, slot, image: None });
        self.unkeepable = kept;
        let (r, c) = (m.rect(), m.root().stroke_bounding_box());
        let rect = |l, t, r, b| Rect::new(f64::from(l), f64::from(t), f64::from(r), f64::from(b));
        self.masks.push(Mask {
            id: m.id().to_owned(),
            rect: rect(r.left(), r.top(), r.right(), r.bottom()),
            kind: m.kind(),
            mask,
            root,
            frame,
            slot,
            referrers: vec![referrer],
            parts: first..self.parts.len(),
            foreign: self.abroad > 0,
            content: rect(c.left(), c.top(), c.right(), c.bottom()),
        });
        self.mask_index.insert(key, self.masks.len() - 1);
        self.masks.len() - 1
    }

    fn tile(&mut self, pattern: &Arc<usvg::Pattern>) {
        if self.tiles.iter().any(|t| Arc::ptr_eq(&t.pattern, pattern)) {
            return;
        }
        let kept = self.unkeepable.take();
        let root = self.group(
            pattern.root(),
            Affine::IDENTITY,
            Context { owner: None, role: Role::Pattern, slot: None, image: None },
        );
        self.unkeepable = kept;
        self.tiles.push(Tile { pattern: pattern.clone(), root });
    }

    fn picture(&mut self, root: &usvg::Group) {
        let key = std::ptr::from_ref(root) as usize;
        if !self.pictures.contains_key(&key) {
            let kept = self.unkeepable.take();
            let group = self.group(
                root,
                Affine::IDENTITY,
                Context { owner: None, role: Role::Pattern, slot: None, image: None },
            );
            self.unkeepable = kept;
            self.pictures.insert(key, group);
        }
    }

    fn element_of_def(&self, id: &str, tag: &str) -> Option<ElementId> {
        let all = self.reader.source.by_id().get(id).filter(|_| self.abroad == 0)?;
        all.iter().copied().rfind(|&e| self.tag(e) == tag)
    }
}

/// Whether anything in `g` comes from an element of its own.
fn has_known(g: &usvg::Group, ids: &HashMap<String, Vec<ElementId>>) -> bool {
    g.children().iter().any(|c| {
        ids.contains_key(c.id()) && !c.id().is_empty() || matches!(c, usvg::Node::Group(g) if has_known(g, ids))
    })
}
