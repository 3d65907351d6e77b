//! State of the walk over usvg's tree, with lookups of source elements and exact transforms.

use crate::scene::affine::{affine, f32_bits, is_near};
use crate::scene::geometry::GeometryReader;
use crate::scene::letters::Owners;
use crate::scene::model::{Clip, PartRole, Referrer, Scene};
use crate::scene::resolve::tiling::Tiling;
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use crate::source::unpatchable::Unpatchable;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Rect};
use std::collections::{HashMap, HashSet};

/// Key of a definition in one frame: its address, the frame, the slot, and what bends those who refer to it.
pub(super) type DefKey = (usize, [u64; 6], Option<usize>, Option<usize>);

/// A scene under construction.
pub(super) struct SceneBuilder<'a> {
    pub(super) scene: Scene,
    pub(super) reader: GeometryReader<'a>,
    pub(super) letters: &'a Owners,
    /// The patterns to lay out as geometry, if any.
    pub(super) tiling: Option<Tiling<'a>>,
    /// For every element, the index of what bends it; empty if the drawing is not divided.
    division: &'a [Option<usize>],
    /// Source elements by their id in usvg's tree.
    ids: &'a HashMap<String, Vec<ElementId>>,
    /// Transforms in the source by their f32 value; `None` where two different ones round to the same value.
    exact: HashMap<[u32; 6], Option<Affine>>,
    /// Shapes in the source by their approximate start, to find the originals of copies, which have no id. Filled on first use.
    pub(super) starts: Option<HashMap<[i64; 2], Vec<ElementId>>>,
    /// Outlines of the elements in `starts`.
    pub(super) outlines: HashMap<ElementId, Outline>,
    pub(super) clip_index: HashMap<DefKey, usize>,
    pub(super) mask_index: HashMap<DefKey, usize>,
    /// Elements with a shared id that have been assigned to a part.
    pub(super) taken: HashSet<ElementId>,
    /// `true` if the source may set a page background.
    pub(super) may_have_background: bool,
    /// The group whose content is in root user space; its own transform leads from there to px.
    pub(super) top: Option<*const usvg::Group>,
    /// Nesting depth in drawings shown as images, whose ids are not the source's.
    pub(super) foreign_depth: usize,
    /// Transforms of markers, by the addresses of their groups; none for those that are not shown.
    pub(super) markers: HashMap<usize, Option<Affine>>,
    /// Elements with `vector-effect: non-scaling-stroke`.
    pub(super) fixed_widths: HashSet<ElementId>,
}

/// Properties inherited in the walk.
#[derive(Clone, Copy)]
pub(super) struct Context {
    pub(super) owner: Option<ElementId>,
    pub(super) role: PartRole,
    pub(super) slot: Option<usize>,
    /// The enclosing `image` element.
    pub(super) image: Option<ElementId>,
    /// The viewport that cuts the image inside, in the coordinates of the group around it.
    pub(super) viewport: Option<Rect>,
    /// In a definition, the index of what bends those who refer to it.
    pub(super) bend: Option<usize>,
}

impl Context {
    /// Outside of owners, slots and images.
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
            scene: Scene::empty(source.unpatchable.clone()),
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
            fixed_widths: fixed_widths(source),
        }
    }

    /// The index of what bends a reference: that of its element, or in a definition that of those who refer to it.
    pub(super) fn bend_of(&self, referrer: Referrer, context: Context) -> Option<usize> {
        if matches!(context.role, PartRole::Clip | PartRole::Mask) {
            return context.bend;
        }
        referrer.owner.or(referrer.element).and_then(|e| self.division.get(e).copied().flatten())
    }

    /// The source elements with an id of usvg's tree.
    pub(super) fn elements(&self, id: &str) -> &'a [ElementId] {
        self.ids.get(id).filter(|_| self.foreign_depth == 0).map_or(&[][..], Vec::as_slice)
    }

    /// The source element with an id of usvg's tree, if there is exactly one.
    pub(super) fn element(&self, id: &str) -> Option<ElementId> {
        match self.elements(id) {
            [e] => Some(*e),
            _ => None,
        }
    }

    /// The definition with the given id and tag; the last one counts.
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
            self.ids.contains_key(c.id()) && !c.id().is_empty() || matches!(c, usvg::Node::Group(g) if self.has_ids(g))
        })
    }

    /// Returns `true` for the group whose content is in root user space.
    pub(super) fn is_top(&self, g: &usvg::Group) -> bool {
        self.top.is_some_and(|t| std::ptr::eq(t, g))
    }

    /// A group's transform in f64: its element's, or else the only one in the source with the same value in f32.
    pub(super) fn exact_transform(&self, t: usvg::Transform, element: Option<ElementId>) -> Affine {
        let rounded = affine(t);
        if t.is_identity() {
            return rounded;
        }
        if let Some(own) = element.and_then(|e| self.reader.own_transform(e))
            && is_near(own, rounded)
        {
            return own;
        }
        self.exact.get(&f32_bits(rounded)).copied().flatten().unwrap_or(rounded)
    }

    /// Records that the source cannot be patched in place. The first reason counts.
    pub(super) fn unpatchable(&mut self, why: Unpatchable) {
        self.scene.unpatchable.get_or_insert(why);
    }

    pub(super) fn push_clip(&mut self, clip: Clip) -> usize {
        self.scene.clips.push(clip);
        self.scene.clips.len() - 1
    }
}

/// Elements with `vector-effect: non-scaling-stroke`.
fn fixed_widths(source: &SourceText) -> HashSet<ElementId> {
    const FIXED: &str = "non-scaling-stroke";
    if !source.text.contains(FIXED) {
        return HashSet::new();
    }
    (0..source.elements.len()).filter(|&e| source.property(e, "vector-effect").as_deref() == Some(FIXED)).collect()
}

fn exact_transforms(reader: &GeometryReader<'_>) -> HashMap<[u32; 6], Option<Affine>> {
    let mut out: HashMap<[u32; 6], Option<Affine>> = HashMap::new();
    for e in 0..reader.source.elements.len() {
        let moves = reader.source.attr(e, "transform").is_some()
            || matches!(reader.source.elements[e].tag.as_ref(), "use" | "svg");
        if moves && let Some(t) = reader.own_transform(e) {
            out.entry(f32_bits(t)).and_modify(|v| *v = v.filter(|v| *v == t)).or_insert(Some(t));
        }
    }
    out
}
