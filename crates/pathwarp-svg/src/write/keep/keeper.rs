//! State for patching the source in place: edits, and the writer for replaced content.

use crate::bend::fits::EmbeddedImage;
use crate::scene::model::Node;
use crate::source::edit::Edits;
use crate::source::elements::{Attr, ElementId, Namespace, is_animation, is_live, is_shape};
use crate::source::text::SourceText;
use crate::write::defs::Replaced;
use crate::write::fragment::Writer;
use crate::write::input::WriteInput;
use crate::write::surroundings::Surroundings;
use pathwarp::kurbo::Affine;
use std::collections::{BTreeSet, HashMap};

/// Geometry attributes, which a shape loses when it becomes a path. The first alone is that of a path.
pub(super) const GEOMETRY: [&str; 15] =
    ["d", "x", "y", "width", "height", "rx", "ry", "cx", "cy", "r", "x1", "y1", "x2", "y2", "points"];

/// Data attributes of lettering.
const LETTERING: [&str; 6] =
    ["data-glyph", "data-baseline", "data-ascent", "data-descent", "data-cap-height", "data-x-height"];

/// A source being patched.
pub(super) struct Keeper<'a, 'w> {
    pub(super) input: WriteInput<'a>,
    pub(super) source: &'a SourceText,
    pub(super) edits: Edits<'a>,
    pub(super) writer: &'w mut Writer<'a>,
    /// Elements that have become groups. Animations of their paint are removed.
    pub(super) new_groups: BTreeSet<ElementId>,
    /// Pictures beneath and above the content of elements that become groups.
    pub(super) pictures: HashMap<ElementId, [String; 2]>,
}

impl<'a, 'w> Keeper<'a, 'w> {
    pub(super) fn new(input: WriteInput<'a>, writer: &'w mut Writer<'a>) -> Self {
        let source = input.source;
        let (new_groups, pictures) = (BTreeSet::new(), HashMap::new());
        Self { input, source, edits: Edits::new(source), writer, new_groups, pictures }
    }

    pub(super) fn tag(&self, e: ElementId) -> &'a str {
        &self.source.elements[e].tag
    }

    /// Returns `true` if anything in a node is warped or moved.
    pub(super) fn changed(&self, n: &Node) -> bool {
        match n {
            Node::Part(i) => self.input.warped(*i).is_some(),
            Node::Group(g) | Node::Text { content: g, .. } => g.children.iter().any(|n| self.changed(n)),
            Node::Image(i) => {
                let slot = self.input.scene.bitmaps[*i].slot;
                let is_moved = slot.is_some_and(|s| self.input.slots[s].fit != Affine::IDENTITY);
                is_moved || matches!(self.input.images[*i], EmbeddedImage::Bent { .. })
            }
        }
    }

    /// Writes the replacement of an element. The ids inside become free, unless style sheets or animations refer to them:
    /// the replacement specifies its appearance and position itself.
    pub(super) fn replacement(&mut self, e: ElementId, write: impl FnOnce(&mut Writer<'a>) -> String) -> String {
        let frees_ids = !self.source.has_css() && !self.source.animated;
        let range = self.source.elements[e].range.clone();
        self.writer.defs.replaced = frees_ids.then_some(Replaced { range, named: BTreeSet::new() });
        let text = write(self.writer);
        self.writer.defs.replaced = None;
        text
    }

    /// The last definition with the given id and tag.
    pub(super) fn definition(&self, id: &str, tag: &str) -> Option<ElementId> {
        self.source.by_id().get(id)?.iter().copied().rfind(|&e| self.tag(e) == tag)
    }

    /// An element's attributes except `omitted`, as written in the source.
    pub(super) fn attributes_without(&self, e: ElementId, omitted: &[&str]) -> String {
        let el = &self.source.elements[e];
        let text = &self.source.text;
        let kept = el.attrs.iter().filter(|a| !omitted.contains(&a.name(text)) && !is_live(a, text));
        kept.map(|a| format!(" {}", &self.source.text[a.range.clone()])).collect()
    }

    /// The content of an element between its pictures.
    pub(super) fn between_pictures(&self, e: ElementId, content: String) -> String {
        match self.pictures.get(&e) {
            Some([beneath, above]) => format!("{beneath}{content}{above}"),
            None => content,
        }
    }

    /// The content that `write` writes for an element that becomes the group around it.
    pub(super) fn written_inside(&mut self, e: ElementId, write: impl FnOnce(&mut Writer<'a>) -> String) -> String {
        self.writer.surroundings = Surroundings::inside(self.source, e);
        let text = write(self.writer);
        self.writer.surroundings = None;
        text
    }

    pub(super) fn remove_attributes(&mut self, e: ElementId, names: &[&'static str]) {
        for name in names {
            self.edits.remove_attr(e, name);
        }
    }

    /// Removes the data attributes of a letter that has moved, and of its line and text.
    pub(super) fn remove_lettering(&mut self, e: ElementId) {
        if self.source.attr(e, "data-glyph").is_none() {
            return;
        }
        for a in self.source.ancestors(e) {
            for name in LETTERING.into_iter().filter(|name| self.source.attr(a, name).is_some()) {
                self.edits.remove_attr(a, name);
            }
        }
    }

    /// Turns a shape element into a group. Its attributes and children stay, and `content` replaces its geometry.
    pub(super) fn make_group(&mut self, e: ElementId, content: String) {
        self.remove_lettering(e);
        self.new_groups.insert(e);
        self.edits.rename(e, "g");
        self.remove_attributes(e, &GEOMETRY);
        self.edits.wrap_content(e, String::new(), content);
    }
}

/// Flags for every element of the source.
pub(super) struct Warped {
    /// `true` if the element is warped.
    itself: Vec<bool>,
    /// `true` if it is warped or contains anything warped.
    within: Vec<bool>,
}

impl Warped {
    pub(super) fn new(input: &WriteInput<'_>) -> Self {
        let (scene, source) = (input.scene, input.source);
        let count = source.elements.len();
        let mut out = Self { itself: vec![false; count], within: vec![false; count] };
        let parts = scene.parts.iter().zip(input.outcomes);
        let parts = parts.filter(|(_, o)| o.warped().is_some()).filter_map(|(p, _)| p.element());
        let bitmaps = scene.bitmaps.iter().zip(input.images);
        let bitmaps = bitmaps.filter(|b| matches!(b.1, EmbeddedImage::Bent { .. })).filter_map(|b| b.0.owner);
        for e in parts.chain(bitmaps) {
            out.itself[e] = true;
            for a in source.ancestors(e) {
                if std::mem::replace(&mut out.within[a], true) {
                    break;
                }
            }
        }
        out
    }
}

/// Removes live attributes, from which Inkscape computes shapes anew, from all elements that are warped or contain warped ones. The other
/// elements of a live group lose the attributes that mean nothing without the group.
pub(super) fn remove_live_attributes(k: &mut Keeper<'_, '_>, warped: &Warped) {
    let source = k.source;
    // No element is live without a declared namespace, and most drawings have none.
    if !source.elements.iter().any(|e| e.attrs.iter().any(|a| is_live(a, &source.text))) {
        return;
    }
    for e in (0..source.elements.len()).filter(|&e| warped.within[e]) {
        if is_shape(k.tag(e)) && source.attr_in(e, Namespace::Sodipodi, "type").is_some() {
            // A rectangle with a path effect is a `path` with the attributes of a `rect`; a linked offset has a link.
            k.remove_attributes(e, &GEOMETRY[1..]);
            k.edits.remove_attr(e, "href");
        }
        k.edits.remove_attrs(e, |a| is_live(a, &source.text));
        release_orphans(k, e, warped);
    }
}

/// Releases the unwarped shapes of a 3D box, or of a group with a path effect.
fn release_orphans(k: &mut Keeper<'_, '_>, group: ElementId, warped: &Warped) {
    let source = k.source;
    let is_box = source.attr_in(group, Namespace::Sodipodi, "type").is_some_and(|t| t == "inkscape:box3d");
    let has_effect = |e: ElementId| source.attr_in(e, Namespace::Inkscape, "path-effect").is_some();
    if is_shape(k.tag(group)) || !(is_box || has_effect(group)) {
        return;
    }
    for e in source.descendants(group).filter(|&e| !warped.within[e]) {
        let is_orphaned = |a: &Attr| match (a.namespace, a.name(&source.text)) {
            (Namespace::Sodipodi, "type") | (Namespace::Inkscape, "box3dsidetype") => is_box,
            (Namespace::Inkscape, "original-d") => !has_effect(e),
            _ => false,
        };
        k.edits.remove_attrs(e, is_orphaned);
    }
}

const DROPPED_GEOMETRY: &str = "animations of a shape's geometry are dropped, as the shape is warped";
const DROPPED_POSITION: &str = "animations that move warped shapes along straight lines are dropped";
const DROPPED_PAINT: &str =
    "animations of fill and stroke are dropped where a shape, text or copy has become a group of several";

/// Kind of property that an animation changes.
enum Animated {
    Geometry,
    Position,
    Paint,
    Other,
}

/// Removes animations that no longer fit their elements.
pub(super) fn remove_outdated_animations(k: &mut Keeper<'_, '_>, warped: &Warped) {
    let source = k.source;
    if !source.animated {
        return;
    }
    for a in (0..source.elements.len()).filter(|&a| is_animation(&source.elements[a].tag)) {
        let target = match source.href(a) {
            Some(id) => source.by_id().get(&id).and_then(|all| all.first().copied()),
            None => source.elements[a].parent,
        };
        let Some(target) = target else { continue };
        let why = match animated(source, a) {
            Animated::Geometry if warped.itself[target] => DROPPED_GEOMETRY,
            Animated::Position if warped.within[target] => DROPPED_POSITION,
            Animated::Paint if k.new_groups.contains(&target) => DROPPED_PAINT,
            _ => continue,
        };
        k.edits.replace(a, String::new());
        k.writer.notes.add(why, &source.display_name(target));
    }
}

/// The animations among the children of an element whose content is replaced, except the ones that no longer fit.
pub(super) fn kept_animations(source: &SourceText, e: ElementId) -> String {
    let is_animating = |&c: &ElementId| source.elements[c].parent == Some(e) && is_animation(&source.elements[c].tag);
    let children = source.descendants(e).filter(is_animating);
    let kept = children.filter(|&c| matches!(animated(source, c), Animated::Other));
    kept.map(|c| &source.text[source.elements[c].range.clone()]).collect()
}

/// The kind of property that animation `a` changes.
fn animated(source: &SourceText, a: ElementId) -> Animated {
    if matches!(source.elements[a].tag.as_ref(), "animateTransform" | "animateMotion") {
        return Animated::Position;
    }
    match source.attr(a, "attributeName").as_deref().map(str::trim) {
        Some("transform") => Animated::Position,
        Some("dx" | "dy" | "rotate" | "textLength" | "font-size" | "href" | "xlink:href") => Animated::Geometry,
        Some(n) if GEOMETRY.contains(&n) => Animated::Geometry,
        Some(n) if n.starts_with("fill") || n.starts_with("stroke") => Animated::Paint,
        _ => Animated::Other,
    }
}
