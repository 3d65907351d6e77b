//! The author's own words about paint, for programs that write new elements in the place of others.

use std::sync::Arc;

/// A property that says how a shape is painted. All of them are inherited.
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

const NAMES: [&str; 5] = ["fill", "fill-opacity", "stroke", "stroke-opacity", "color"];

/// A declared value as it is written in the drawing.
#[derive(Debug, PartialEq)]
struct Word {
    text: String,
    /// Where the variables begin that hold for it.
    scope: usize,
}

/// The winning declarations about paint of one element, inherited ones included, before variables are replaced. Properties without any
/// have their initial values.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Words {
    /// One for each name; shared by all elements that inherit it.
    said: [Option<Arc<Word>>; 5],
    /// Where the last element around begins that declares variables; 0 if there is none.
    scope: usize,
}

impl Words {
    /// Takes down that the element that begins at `scope` declares variables.
    pub(super) fn declare_variables(&mut self, scope: usize) {
        self.scope = scope;
    }

    /// Returns `true` for the name of a property in [`PaintProperty`].
    pub(super) fn hold(name: &str) -> bool {
        NAMES.contains(&name)
    }

    /// Takes down a valid value of a property; `None` for the initial one.
    pub(super) fn say(&mut self, name: &str, value: Option<&str>) {
        let Some(k) = NAMES.iter().position(|n| *n == name) else { return };
        let text = value.map(str::trim);
        // The keyword means the inherited colour here.
        if name == "color" && text.is_some_and(|t| t.eq_ignore_ascii_case("currentcolor")) {
            return;
        }
        self.said[k] = text.map(|t| Arc::new(Word { text: t.to_owned(), scope: self.scope }));
    }

    /// These words, for an element inside with a fill of its own.
    pub(super) fn with_fill(self: &Arc<Self>, fill: Option<&str>) -> Arc<Self> {
        let mut out = Arc::clone(self);
        if fill.is_some() {
            Arc::make_mut(&mut out).say(NAMES[0], fill);
        }
        out
    }

    fn word(&self, p: PaintProperty) -> Option<&Arc<Word>> {
        self.said[p as usize].as_ref()
    }

    /// Returns `true` if a declaration of this property, own or inherited, gives it a value.
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

    /// Returns `true` if a child of an element with the words `place` would inherit the value that this property has here.
    #[must_use]
    pub fn inherits(&self, p: PaintProperty, place: &Self) -> bool {
        let same = |p| is_same(self.word(p), place.word(p));
        let text = self.word(p).map_or("", |w| &w.text);
        same(p) && !refers(text) && (same(PaintProperty::Color) || !mentions(text, "currentcolor"))
    }

    /// A value that gives an element inside of `place` the colour or opacity that is said here. `None` if nothing is said, or if it
    /// would mean another there.
    #[must_use]
    pub fn taken_over(&self, p: PaintProperty, place: &Self) -> Option<&str> {
        let word = self.word(p)?;
        let text = word.text.as_str();
        if p != PaintProperty::Color && !self.inherits(PaintProperty::Color, place) {
            if text.eq_ignore_ascii_case("currentcolor") {
                return self.taken_over(PaintProperty::Color, place);
            }
            if mentions(text, "currentcolor") {
                return None;
            }
        }
        let holds = word.scope == place.scope || !mentions(text, "var(");
        (holds && !refers(text)).then_some(text)
    }

    /// Returns the words of a copy of this element, made by a `use` with the words `copy`. The original's parent has the words `around`.
    #[must_use]
    pub fn copied(&self, around: &Self, copy: &Self) -> Self {
        let mut out = self.clone();
        for ((own, around), copy) in out.said.iter_mut().zip(&around.said).zip(&copy.said) {
            if is_same(own.as_ref(), around.as_ref()) {
                own.clone_from(copy);
            }
        }
        if self.scope == around.scope {
            out.scope = copy.scope;
        }
        out
    }
}

/// Returns `true` if two elements take a value from one and the same declaration.
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
