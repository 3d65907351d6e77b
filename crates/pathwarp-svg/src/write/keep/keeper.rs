//! State for patching the source in place: edits, and the writer for replaced content.

use crate::bend::bitmap::EmbeddedImage;
use crate::scene::model::Node;
use crate::source::edit::Edits;
use crate::source::live::is_live;
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use crate::write::defs::Replaced;
use crate::write::fragment::Writer;
use crate::write::input::WriteInput;
use pathwarp::kurbo::Affine;
use std::collections::BTreeSet;

/// Geometry attributes, which a shape loses when it becomes a path.
pub(super) const GEOMETRY: [&str; 15] =
    ["d", "x", "y", "width", "height", "rx", "ry", "cx", "cy", "r", "x1", "y1", "x2", "y2", "points"];

/// Data attributes of lettering.
const LETTERING: [&str; 6] =
    ["data-glyph", "data-baseline", "data-ascent", "data-descent", "data-cap-height", "data-x-height"];

pub(super) struct Keeper<'a, 'w> {
    pub(super) input: WriteInput<'a>,
    pub(super) source: &'a SourceText,
    pub(super) edits: Edits<'a>,
    pub(super) writer: &'w mut Writer<'a>,
    /// Elements that have become groups.
    pub(super) fragments: BTreeSet<ElementId>,
}

impl<'a, 'w> Keeper<'a, 'w> {
    pub(super) fn new(input: WriteInput<'a>, writer: &'w mut Writer<'a>) -> Self {
        let source = input.source;
        Self { input, source, edits: Edits::new(source), writer, fragments: BTreeSet::new() }
    }

    pub(super) fn tag(&self, e: ElementId) -> &'a str {
        &self.source.elements[e].tag
    }

    /// Returns `true` if anything in a node is warped or moved.
    pub(super) fn changed(&self, n: &Node) -> bool {
        match n {
            Node::Part(i) => self.input.warped(*i).is_some(),
            Node::Group(g) => g.children.iter().any(|n| self.changed(n)),
            Node::Text { content, .. } => content.children.iter().any(|n| self.changed(n)),
            Node::Image(i) => {
                let slot = self.input.scene.bitmaps[*i].slot;
                let moved = slot.is_some_and(|s| self.input.slots[s].fit != Affine::IDENTITY);
                moved || matches!(self.input.images[*i], EmbeddedImage::Bent(_))
            }
        }
    }

    /// Writes the replacement of an element. The ids inside become free, unless style sheets or animations refer to them:
    /// the replacement specifies its appearance and position itself.
    pub(super) fn replacement(&mut self, e: ElementId, write: impl FnOnce(&mut Writer<'a>) -> String) -> String {
        let free = !self.source.has_css() && !self.source.animated;
        self.writer.defs.replaced = free.then(|| Replaced::new(self.source.elements[e].range.clone()));
        let text = write(self.writer);
        self.writer.defs.replaced = None;
        text
    }

    /// The definition with the given id and tag; the last one counts.
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

    pub(super) fn remove_geometry(&mut self, e: ElementId) {
        for name in GEOMETRY {
            self.edits.remove_attr(e, name);
        }
    }

    /// Removes the data attributes of a letter that is no longer where they say, and those of its line and text.
    pub(super) fn remove_lettering(&mut self, e: ElementId) {
        if self.source.attr(e, "data-glyph").is_none() {
            return;
        }
        for a in self.source.ancestors(e) {
            for name in LETTERING {
                if self.source.attr(a, name).is_some() {
                    self.edits.remove_attr(a, name);
                }
            }
        }
    }

    /// Turns a shape element into a group. Its attributes and children stay, and `content` replaces its geometry.
    pub(super) fn make_group(&mut self, e: ElementId, content: String) {
        self.remove_lettering(e);
        self.fragments.insert(e);
        self.edits.rename(e, "g");
        self.remove_geometry(e);
        self.edits.wrap_content(e, String::new(), content);
    }
}
