//! Temporary ids. They are inserted into the text before parsing, so that a single parse serves both usvg, whose nodes are
//! identified by id, and our own table of elements.

use super::tags::{ElementId, is_tracked};
use memchr::{memchr, memmem};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::ops::Range;

/// The text to parse in place of the source.
#[derive(Debug)]
pub(crate) struct Marked {
    pub(crate) text: String,
    pub(crate) marks: Marks,
    /// Number of elements.
    pub(crate) elements: usize,
    pub(crate) patches: Vec<TextPatch>,
}

/// The elements with a temporary id, which is the stem followed by the element's number.
#[derive(Debug, Default, Clone)]
pub(crate) struct Marks {
    pub(crate) stem: String,
    /// In document order.
    pub(crate) elements: Vec<ElementId>,
}

/// A difference between the parsed text and the source: an inserted attribute, or a replaced attribute value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextPatch {
    pub(crate) element: ElementId,
    /// Range in the source; empty for an insertion.
    from: usize,
    to: usize,
    /// Range in the parsed text.
    start: usize,
    end: usize,
    /// `true` for an inserted attribute, `false` for a replaced value.
    new: bool,
}

impl TextPatch {
    /// Returns `true` if `value`, a range of the parsed text, lies inside the patch.
    pub(crate) fn is(&self, value: &Range<usize>) -> bool {
        value.end <= self.end && value.start >= self.start
    }

    /// Range in the source of the replaced value; `None` for an inserted attribute.
    pub(crate) fn replaced(&self) -> Option<Range<usize>> {
        (!self.new).then_some(self.from..self.to)
    }

    /// Shift of everything after the patch, modulo 2^64: a new value may be shorter than the old one.
    pub(crate) fn shift(&self) -> usize {
        self.end.wrapping_sub(self.to)
    }
}

/// Translates a position in the parsed text, outside of all patches, to the source.
pub(crate) fn in_source(patches: &[TextPatch], at: usize) -> usize {
    let before = patches.partition_point(|p| p.end <= at);
    let shift = before.checked_sub(1).and_then(|i| patches.get(i)).map_or(0, TextPatch::shift);
    at.wrapping_sub(shift)
}

/// An opening tag.
struct Tag<'a> {
    /// Local name.
    name: &'a str,
    name_end: usize,
    /// Range of the value of `id` or `xml:id`.
    id: Option<(usize, usize)>,
    /// `true` if the attribute is `id` rather than `xml:id`.
    plain: bool,
}

/// Inserts temporary ids. Returns `None` if the tags cannot be found without a full parser, or the text is not XML.
pub(crate) fn mark(text: &str) -> Option<Marked> {
    let tags = tags(text)?;
    let value = |t: &Tag<'_>| t.id.and_then(|(a, b)| text.get(a..b)).filter(|v| !v.is_empty());
    let mut ids: Vec<&str> = tags.iter().filter(|t| t.plain).filter_map(value).collect();
    ids.sort_unstable();
    let shared: Vec<&str> = ids.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
    let links = if shared.is_empty() { HashSet::new() } else { links(text) };
    let marks = Marks { stem: stem(text), elements: Vec::new() };
    let mut out = Marked {
        text: String::with_capacity(text.len() + 16 * tags.len()),
        marks,
        elements: tags.len(),
        patches: Vec::new(),
    };
    let mut done = 0;
    for (i, t) in tags.iter().enumerate().filter(|(_, t)| is_tracked(t.name)) {
        if value(t).is_some_and(|v| shared.binary_search(&v).is_err() || links.contains(v)) {
            continue;
        }
        let (from, to) = t.id.unwrap_or((t.name_end, t.name_end));
        let new = t.id.is_none();
        out.text.push_str(text.get(done..from)?);
        let start = out.text.len();
        if new {
            out.text.push_str(" id=\"");
        }
        out.text.push_str(&out.marks.stem);
        let _ = write!(out.text, "{i}");
        if new {
            out.text.push('"');
        }
        out.patches.push(TextPatch { element: i, from, to, start, end: out.text.len(), new });
        out.marks.elements.push(i);
        done = to;
    }
    out.text.push_str(text.get(done..)?);
    Some(out)
}

/// Finds a prefix that occurs nowhere in the text.
pub(crate) fn stem(text: &str) -> String {
    let mut stem = "warp-".to_owned();
    while text.contains(&stem) {
        stem.push('x');
    }
    stem
}

/// Collects everything that looks like a reference. False positives do no harm.
pub(crate) fn links(text: &str) -> HashSet<&str> {
    text.match_indices('#')
        .map(|(i, _)| {
            let rest = &text[i + 1..];
            &rest[..rest.find(|c: char| !(c.is_alphanumeric() || "-_.:".contains(c))).unwrap_or(rest.len())]
        })
        .collect()
}

/// Lists all opening tags in order.
fn tags(text: &str) -> Option<Vec<Tag<'_>>> {
    /// Typical bytes per tag in small files, for the capacity.
    const TAG: usize = 48;
    let bytes = text.as_bytes();
    let past = |from: usize, end: &str| Some(from + memmem::find(bytes.get(from..)?, end.as_bytes())? + end.len());
    let mut out = Vec::with_capacity(text.len() / TAG);
    let mut at = 0;
    while let Some(i) = memchr(b'<', bytes.get(at..)?) {
        at += i;
        match bytes.get(at + 1)? {
            b'/' => at += memchr(b'>', bytes.get(at..)?)? + 1,
            b'?' => at = past(at, "?>")?,
            b'!' if bytes[at..].starts_with(b"<!--") => at = past(at + 4, "-->")?,
            b'!' if bytes[at..].starts_with(b"<![CDATA[") => at = past(at + 9, "]]>")?,
            b'!' => {
                let end = past(at, ">")?;
                // A DTD subset may declare entities, which can contain tags.
                if bytes[at..end].contains(&b'[') {
                    return None;
                }
                at = end;
            }
            _ => {
                let (tag, end) = tag(text, at + 1)?;
                out.push(tag);
                at = end;
            }
        }
    }
    Some(out)
}

/// Parses the opening tag whose name starts at `from`; returns it with its end.
fn tag(text: &str, from: usize) -> Option<(Tag<'_>, usize)> {
    let bytes = text.as_bytes();
    let skip = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_whitespace) {
            at += 1;
        }
        at
    };
    let mut local = from;
    let mut at = from;
    loop {
        match bytes.get(at)? {
            b'/' | b'>' => break,
            b':' => local = at + 1,
            b if b.is_ascii_whitespace() => break,
            _ => {}
        }
        at += 1;
    }
    let mut out = Tag { name: text.get(local..at)?, name_end: at, id: None, plain: false };
    loop {
        at = skip(at);
        match bytes.get(at)? {
            b'>' => return Some((out, at + 1)),
            b'/' => at += 1,
            _ => {
                let start = at;
                while !matches!(bytes.get(at)?, b'=' | b' ' | b'\t' | b'\n' | b'\r') {
                    at += 1;
                }
                let name = &bytes[start..at];
                at = skip(at);
                if bytes.get(at)? != &b'=' {
                    return None;
                }
                at = skip(at + 1);
                let quote = *bytes.get(at)?;
                if !matches!(quote, b'"' | b'\'') {
                    return None;
                }
                let value = at + 1;
                at = value + memchr(quote, bytes.get(value..)?)?;
                if matches!(name, b"id" | b"xml:id") && out.id.is_none() {
                    // The parsed value would differ from the raw text.
                    if bytes[value..at].iter().any(|b| matches!(b, b'&' | b'\t' | b'\n' | b'\r')) {
                        return None;
                    }
                    (out.id, out.plain) = (Some((value, at)), name == b"id");
                }
                at += 1;
            }
        }
    }
}
