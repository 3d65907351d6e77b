//! Finds the declarations of paint in the source that new elements can keep, such as `currentColor` or a variable.

use crate::scene::lettering::text_content;
use crate::scene::model::Part;
use crate::source::elements::ElementId;
use crate::source::text::SourceText;
use pathwarp_reader::Words;
use std::borrow::Cow;

/// The surroundings of new elements, and the elements that they replace.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a> {
    /// The declarations of the element around them.
    pub(super) words: &'a Words,
    /// `true` if they inherit these declarations.
    pub(super) is_parent: bool,
    /// The element of a text that they replace.
    text_element: Option<ElementId>,
    /// The `use` that shows the elements that they replace.
    copy: Option<ElementId>,
}

impl<'a> Surroundings<'a> {
    /// The inside of an element that keeps its attributes.
    pub(super) fn inside(source: &'a SourceText, e: ElementId) -> Option<Self> {
        let words = source.words.get(e)?;
        Some(Self { words, is_parent: true, text_element: None, copy: None })
    }

    /// The surroundings of elements that replace a `use`.
    pub(super) fn of_copy(source: &'a SourceText, copy: ElementId) -> Option<Self> {
        let parent = source.elements[copy].parent?;
        Some(Self { is_parent: false, copy: Some(copy), ..Self::inside(source, parent)? })
    }

    /// The surroundings of elements that replace an element of a text.
    pub(super) fn for_text_element(self, text_element: ElementId) -> Self {
        Self { text_element: Some(text_element), ..self }
    }

    /// The surroundings of elements that replace a whole text; they keep its declarations if all elements in it have equal ones.
    pub(super) fn for_text(self, source: &SourceText, text: Option<ElementId>) -> Self {
        let text = text.filter(|&t| text_content(source, t).all(|e| source.words.get(e) == source.words.get(t)));
        Self { text_element: text, ..self }
    }

    /// The declarations of paint that a part has in the source. Returns `None` if they cannot be told.
    pub(super) fn words_of(&self, source: &'a SourceText, p: &Part) -> Option<Cow<'a, Words>> {
        let e = p.source.or(p.drawn).or(self.text_element)?;
        let words: &Words = source.words.get(e)?;
        let Some(copy) = self.copy else { return Some(Cow::Borrowed(words)) };
        let target = source.by_id().get(&source.href(copy)?)?.first().copied()?;
        let parent = source.elements[target].parent?;
        let is_direct = source.ancestors(e).take_while(|&a| a != parent).all(|a| source.elements[a].tag != "use");
        let is_inside = source.ancestors(e).any(|a| a == target);
        (is_direct && is_inside).then(|| Cow::Owned(words.copied(&source.words[parent], &source.words[copy])))
    }
}
