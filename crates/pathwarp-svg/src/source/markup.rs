//! Writes elements, with their values escaped.

use pathwarp_reader::xml::escape;
use std::fmt::Write as _;

/// An element whose start tag is being written.
pub(crate) struct Tag {
    name: String,
    out: String,
}

impl Tag {
    /// Begins an element. `name` includes its prefix.
    pub(crate) fn new(name: impl Into<String>) -> Self {
        let name = name.into();
        Self { out: format!("<{name}"), name }
    }

    /// Adds an attribute.
    pub(crate) fn with(mut self, name: &str, value: &str) -> Self {
        let _ = write!(self.out, " {name}=\"{}\"", escape(value));
        self
    }

    pub(crate) fn with_all<V: AsRef<str>>(self, attributes: impl IntoIterator<Item = (&'static str, V)>) -> Self {
        attributes.into_iter().fold(self, |tag, (name, value)| tag.with(name, value.as_ref()))
    }

    /// Adds attributes that are already markup, each with a space before it.
    pub(crate) fn raw(mut self, attributes: &str) -> Self {
        self.out.push_str(attributes);
        self
    }

    /// Finishes the element without content.
    pub(crate) fn empty(self) -> String {
        self.out + "/>"
    }

    /// Finishes the element around content that is already markup.
    pub(crate) fn around(mut self, content: &str) -> String {
        self.out.reserve(content.len() + self.name.len() + "></>".len());
        let _ = write!(self.out, ">{content}</{}>", self.name);
        self.out
    }
}
