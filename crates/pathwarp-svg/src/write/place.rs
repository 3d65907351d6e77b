//! Places for new elements that keep what the drawing says about paint in its author's words.

use crate::scene::lettering::inside;
use crate::scene::model::Part;
use crate::source::elements::ElementId;
use crate::source::text::SourceText;
use pathwarp_reader::Words;
use std::borrow::Cow;

/// Where new elements go, and which elements they stand for.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    /// What is said of the element around them.
    pub(super) words: &'a Words,
    /// Whether they are inside of it for good: what it says is inherited.
    pub(super) is_parent: bool,
    /// The element of a text that they stand for, and the `use` that shows what they stand for.
    speaker: Option<ElementId>,
    copy: Option<ElementId>,
}

impl<'a> Place<'a> {
    /// Inside of an element that keeps its attributes.
    pub(super) fn inside(source: &'a SourceText, e: ElementId) -> Option<Self> {
        let words = source.words.get(e)?;
        Some(Self { words, is_parent: true, speaker: None, copy: None })
    }

    /// In the place of a `use`.
    pub(super) fn of_copy(source: &'a SourceText, copy: ElementId) -> Option<Self> {
        let parent = source.elements[copy].parent?;
        Some(Self { is_parent: false, copy: Some(copy), ..Self::inside(source, parent)? })
    }

    /// For what an element of a text says.
    pub(super) fn spoken_by(self, speaker: ElementId) -> Self {
        Self { speaker: Some(speaker), ..self }
    }

    /// For a whole text, if all of its elements say the same.
    pub(super) fn of_text(self, source: &SourceText, text: Option<ElementId>) -> Self {
        let text = text.filter(|&t| inside(source, t).all(|e| source.words.get(e) == source.words.get(t)));
        Self { speaker: text, ..self }
    }

    /// What is said of a part.
    pub(super) fn words_of(&self, source: &'a SourceText, p: &Part) -> Option<Cow<'a, Words>> {
        let e = p.source.or(p.drawn).or(self.speaker)?;
        let own: &Words = source.words.get(e)?;
        let Some(copy) = self.copy else { return Some(Cow::Borrowed(own)) };
        let target = source.by_id().get(&source.href(copy)?)?.first().copied()?;
        let parent = source.elements[target].parent?;
        let is_direct = source.ancestors(e).take_while(|&a| a != parent).all(|a| source.elements[a].tag != "use");
        let is_inside = source.ancestors(e).any(|a| a == target);
        (is_direct && is_inside).then(|| Cow::Owned(own.copied(&source.words[parent], &source.words[copy])))
    }
}
