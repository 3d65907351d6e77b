//! The author's declarations about paint as written, for programs that replace elements by new ones.

use std::sync::Arc;

/// An inherited property that determines the paint of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PaintProperty {
    /// `fill`
    Fill,
    /// `fill-opacity`
    FillOpacity,
    /// `stroke`
    Stroke,
    /// `stroke-opacity`
    StrokeOpacity,
    /// `color`, which `currentColor` stands for.
    Color,
}

/// The names of the properties, in the order of [`PaintProperty`].
const NAMES: [&str; 5] = ["fill", "fill-opacity", "stroke", "stroke-opacity", "color"];

/// A declared value as it is written in the drawing.
#[derive(Debug, PartialEq)]
struct Word {
    text: String,
    /// The `scope` of the [`Words`] that it was declared in.
    scope: usize,
}

/// The winning declarations about paint of one element, inherited ones included, before variables are replaced. Properties without any
/// have their initial values.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Words {
    /// The value of each property in [`NAMES`]; shared by all elements that inherit it.
    declared: [Option<Arc<Word>>; NAMES.len()],
    /// Offset of the innermost element around that declares variables; 0 if there is none.
    scope: usize,
}

impl Words {
    /// Records that the element at offset `scope` declares variables.
    pub(super) fn declare_variables(&mut self, scope: usize) {
        self.scope = scope;
    }

    /// Returns `true` for the name of a property in [`PaintProperty`].
    pub(super) fn records(name: &str) -> bool {
        NAMES.contains(&name)
    }

    /// Records a valid value of a property; `None` for the initial one.
    pub(super) fn record(&mut self, name: &str, value: Option<&str>) {
        let Some(property) = NAMES.iter().position(|n| *n == name) else { return };
        let text = value.map(str::trim);
        // The keyword means the inherited colour here.
        if name == "color" && text.is_some_and(|t| t.eq_ignore_ascii_case("currentcolor")) {
            return;
        }
        self.declared[property] = text.map(|t| Arc::new(Word { text: t.to_owned(), scope: self.scope }));
    }

    /// These words for a child with another fill, if one is given.
    pub(super) fn with_fill(self: &Arc<Self>, fill: Option<&str>) -> Arc<Self> {
        let mut out = Arc::clone(self);
        if fill.is_some() {
            Arc::make_mut(&mut out).record(NAMES[0], fill);
        }
        out
    }

    fn word(&self, p: PaintProperty) -> Option<&Arc<Word>> {
        self.declared[p as usize].as_ref()
    }

    /// Returns `true` if a declaration, on the element or inherited, gives this property a value.
    #[must_use]
    pub fn says(&self, p: PaintProperty) -> bool {
        self.word(p).is_some()
    }

    /// Returns `true` if the fill or the stroke depends on variables or on `color`.
    #[must_use]
    pub fn depends(&self) -> bool {
        let text = |p| self.word(p).map_or("", |w| w.text.as_str());
        let depends = |text| mentions(text, "currentcolor") || mentions(text, "var(");
        depends(text(PaintProperty::Fill)) || depends(text(PaintProperty::Stroke))
    }

    /// Returns `true` if a child of an element with the words `parent` would inherit the value that this property has here.
    #[must_use]
    pub fn inherits(&self, p: PaintProperty, parent: &Self) -> bool {
        let same = |p| is_same(self.word(p), parent.word(p));
        let text = self.word(p).map_or("", |w| &w.text);
        same(p) && !refers(text) && (same(PaintProperty::Color) || !mentions(text, "currentcolor"))
    }

    /// A value that gives a child of an element with the words `parent` the colour or opacity declared here. `None` if none is declared,
    /// or if the value would mean something else there.
    #[must_use]
    pub fn taken_over(&self, p: PaintProperty, parent: &Self) -> Option<&str> {
        let word = self.word(p)?;
        let text = word.text.as_str();
        if p != PaintProperty::Color && !self.inherits(PaintProperty::Color, parent) {
            if text.eq_ignore_ascii_case("currentcolor") {
                return self.taken_over(PaintProperty::Color, parent);
            }
            if mentions(text, "currentcolor") {
                return None;
            }
        }
        let holds = word.scope == parent.scope || !mentions(text, "var(");
        (holds && !refers(text)).then_some(text)
    }

    /// Returns the words of a copy of this element, made by a `use` with the words `copy`. The original's parent has the words `around`.
    #[must_use]
    pub fn copied(&self, around: &Self, copy: &Self) -> Self {
        let mut out = self.clone();
        for ((word, around), copy) in out.declared.iter_mut().zip(&around.declared).zip(&copy.declared) {
            if is_same(word.as_ref(), around.as_ref()) {
                word.clone_from(copy);
            }
        }
        if self.scope == around.scope {
            out.scope = copy.scope;
        }
        out
    }
}

/// Returns `true` if two elements take a value from the same declaration.
fn is_same(a: Option<&Arc<Word>>, b: Option<&Arc<Word>>) -> bool {
    a.map(Arc::as_ptr) == b.map(Arc::as_ptr)
}

/// Returns `true` if a value refers to other elements, such as gradients.
fn refers(value: &str) -> bool {
    ["url(", "context-"].iter().any(|other| mentions(value, other))
}

/// Returns `true` if a value contains a word, in upper or lower case.
fn mentions(value: &str, word: &str) -> bool {
    value.as_bytes().windows(word.len()).any(|w| w.eq_ignore_ascii_case(word.as_bytes()))
}
