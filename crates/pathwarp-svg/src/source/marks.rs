//! Temporary ids: they are put into the text before it is parsed, so that one parse serves usvg, whose tree is told apart by
//! ids, and the table of the source's own elements.

use crate::source::text::{ElementId, is_tracked};
use memchr::{memchr, memmem};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::ops::Range;

/// The text that is parsed in the source's place.
#[derive(Debug)]
pub(crate) struct Marked {
    pub(crate) text: String,
    pub(crate) marks: Marks,
    /// How many elements there are.
    pub(crate) elements: usize,
    pub(crate) patches: Vec<Patch>,
}

/// Which elements carry a temporary id: the stem and the element's number.
#[derive(Debug, Default)]
pub(crate) struct Marks {
    pub(crate) stem: String,
    /// In document order.
    pub(crate) elements: Vec<ElementId>,
}

/// A place where the parsed text differs from the source: an attribute more, or another value between the quotes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch {
    pub(crate) element: ElementId,
    /// In the source: a place, or the value that was there.
    from: usize,
    to: usize,
    /// In the parsed text.
    start: usize,
    end: usize,
    /// Whether it is a whole attribute.
    new: bool,
}

impl Patch {
    /// Whether a value of the parsed text is this one, which the source says otherwise or not at all.
    pub(crate) fn is(&self, value: &Range<usize>) -> bool {
        value.end <= self.end && value.start >= self.start
    }

    /// The value that is replaced, in the source; `None` for a new attribute.
    pub(crate) fn replaced(&self) -> Option<Range<usize>> {
        (!self.new).then_some(self.from..self.to)
    }

    /// What all that follows is shifted by, modulo a word: a new value may be shorter than the old one.
    pub(crate) fn shift(&self) -> usize {
        self.end.wrapping_sub(self.to)
    }
}

/// Where something of the parsed text, none of it new, stands in the source.
pub(crate) fn in_source(patches: &[Patch], at: usize) -> usize {
    let before = patches.partition_point(|p| p.end <= at);
    let shift = before.checked_sub(1).and_then(|i| patches.get(i)).map_or(0, Patch::shift);
    at.wrapping_sub(shift)
}

/// An opening tag.
struct Tag<'a> {
    /// Without its prefix.
    name: &'a str,
    name_end: usize,
    /// Between the quotes of its `id` or `xml:id`.
    id: Option<(usize, usize)>,
    /// Whether that is a plain `id`.
    plain: bool,
}

/// The text with temporary ids; `None` where the tags cannot be told without a parser, and where the text is no XML at all.
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
        out.patches.push(Patch { element: i, from, to, start, end: out.text.len(), new });
        out.marks.elements.push(i);
        done = to;
    }
    out.text.push_str(text.get(done..)?);
    Some(out)
}

/// What no id begins with.
pub(crate) fn stem(text: &str) -> String {
    let mut stem = "warp-".to_owned();
    while text.contains(&stem) {
        stem.push('x');
    }
    stem
}

/// Everything that looks like a reference; more than there are does no harm.
pub(crate) fn links(text: &str) -> HashSet<&str> {
    text.match_indices('#')
        .map(|(i, _)| {
            let rest = &text[i + 1..];
            &rest[..rest.find(|c: char| !(c.is_alphanumeric() || "-_.:".contains(c))).unwrap_or(rest.len())]
        })
        .collect()
}

/// All opening tags in order.
fn tags(text: &str) -> Option<Vec<Tag<'_>>> {
    /// About as many bytes as a tag has in small files.
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
                // Entities may be declared, which hold anything.
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

/// The tag whose name starts at `from`, and where it ends.
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
                    // What it says may be other than what is written.
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
