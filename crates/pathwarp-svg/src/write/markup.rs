//! Markup: prefixes, attributes and styles as they must be written in the surrounding file.

use crate::source::text::SourceText;
use pathwarp_reader::xml::escape;
use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt::Write as _;

/// Presentation properties in order.
pub(super) type Properties = Vec<(&'static str, String)>;

/// Conventions of the file that elements are written to.
pub(super) struct Markup<'a> {
    source: &'a SourceText,
    /// Namespace prefix of elements with its colon; usually empty.
    pub(super) prefix: String,
    /// `true` if the result is part of the source, whose definitions can be referred to.
    pub(super) in_source: bool,
    /// Write properties to style attributes, which style sheets cannot override.
    pub(super) styled: bool,
    /// Cache: properties that occur in the source.
    mentioned: RefCell<HashMap<&'static str, bool>>,
}

impl<'a> Markup<'a> {
    pub(super) fn new(source: &'a SourceText, in_source: bool) -> Self {
        Self {
            source,
            prefix: if in_source { source.prefix().to_owned() } else { String::new() },
            in_source,
            styled: in_source && source.has_css(),
            mentioned: RefCell::default(),
        }
    }

    /// Returns `true` if an ancestor in the source may set a property, so that its default must be written out.
    pub(super) fn may_inherit(&self, name: &'static str) -> bool {
        let is_mentioned = || self.source.text.contains(name);
        self.in_source && *self.mentioned.borrow_mut().entry(name).or_insert_with(is_mentioned)
    }

    pub(super) fn tag(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    /// Name of the attribute for links.
    pub(super) fn link(&self) -> &'static str {
        let root = self.source.elements.first().map(|root| &self.source.text[root.range.start..root.open_end]);
        let declared = root.is_some_and(|root| root.contains("xmlns:xlink="));
        if self.in_source && !declared { "href" } else { "xlink:href" }
    }

    /// Writes a `<title>`.
    pub(super) fn title(&self, text: &str) -> String {
        let tag = self.tag("title");
        format!("<{tag}>{}</{tag}>", escape(text))
    }

    /// Wraps content in a group with an id attribute, if there is one.
    pub(super) fn named_group(&self, id: &str, content: String) -> String {
        if id.is_empty() { content } else { format!("<{0}{id}>{content}</{0}>", self.tag("g")) }
    }

    pub(super) fn attributes(&self, properties: &Properties) -> String {
        let mut out = String::new();
        self.push_attributes(properties, &mut out);
        out
    }

    fn push_attributes(&self, properties: &Properties, out: &mut String) {
        if self.styled {
            if !properties.is_empty() {
                let all: Vec<String> = properties.iter().map(|(n, v)| format!("{n}:{v}")).collect();
                let _ = write!(out, " style=\"{}\"", escape(&all.join(";")));
            }
        } else {
            for (n, v) in properties {
                // These properties have no presentation attribute.
                if matches!(*n, "mix-blend-mode" | "isolation") {
                    let _ = write!(out, " style=\"{n}:{v}\"");
                } else {
                    push_all(out, [" ", n, "=\"", &escape(v), "\""]);
                }
            }
        }
    }

    /// Writes a path with the attribute `id` (empty for none).
    pub(super) fn path(&self, d: &str, id: &str, properties: &Properties) -> String {
        /// Typical length of the attributes, for the capacity.
        const USUAL: usize = 64;
        let mut out = String::with_capacity(d.len() + id.len() + USUAL);
        push_all(&mut out, ["<", &self.prefix, "path", id, " d=\"", d, "\""]);
        self.push_attributes(properties, &mut out);
        out.push_str("/>");
        out
    }
}

pub(super) fn push_all<const N: usize>(out: &mut String, parts: [&str; N]) {
    for p in parts {
        out.push_str(p);
    }
}
