//! Edits attributes, style properties, tags and whole elements of the source text. All other bytes stay unchanged.

use super::elements::{Attr, ElementId, Namespace, declared, with_declaration};
use super::text::SourceText;
use pathwarp_reader::xml::escape;
use std::collections::BTreeMap;
use std::ops::Range;

/// A text with some of its ranges replaced. The ranges ascend; one that begins inside an earlier one is skipped.
pub(crate) fn splice(text: &str, patches: impl IntoIterator<Item = (Range<usize>, String)>) -> String {
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for (range, new) in patches {
        if range.start >= done {
            out.push_str(&text[done..range.start]);
            out.push_str(&new);
            done = range.end;
        }
    }
    out + &text[done..]
}

/// Edits of one element.
#[derive(Debug, Default)]
struct Change {
    /// New values; `None` removes the attribute.
    attrs: Vec<(&'static str, Option<String>)>,
    /// New values of properties in the style attribute.
    properties: Vec<(&'static str, String)>,
    /// Ranges of attributes to remove.
    removed: Vec<Range<usize>>,
    /// Replaces the tag.
    tag: Option<&'static str>,
    /// Replaces the content.
    content: Option<String>,
    /// Replaces the whole element.
    replaced: Option<String>,
    /// Inserted after the opening tag and before the closing tag.
    around: Option<(String, String)>,
    /// Inserted before and after the element.
    before: String,
    after: String,
}

impl Change {
    /// Returns `true` if the change determines an attribute. If path data is also declared (`declares_data`), setting `d` changes `style`,
    /// too.
    fn sets(&self, name: &str, declares_data: bool) -> bool {
        let sets_data = || self.attrs.iter().any(|a| a.0 == "d" && a.1.is_some());
        let sets_style = !self.properties.is_empty() || (declares_data && sets_data());
        self.attrs.iter().any(|a| a.0 == name) || (name == "style" && sets_style)
    }

    /// Sets an attribute, or with `None` removes it.
    fn put_attr(&mut self, name: &'static str, value: Option<String>) {
        self.attrs.retain(|a| a.0 != name);
        self.attrs.push((name, value));
    }
}

/// Edits to be applied together.
#[derive(Debug)]
pub(crate) struct Edits<'a> {
    source: &'a SourceText,
    changes: BTreeMap<ElementId, Change>,
}

impl<'a> Edits<'a> {
    pub(crate) fn new(source: &'a SourceText) -> Self {
        Self { source, changes: BTreeMap::new() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.changes.is_empty()
    }

    fn change(&mut self, e: ElementId) -> &mut Change {
        self.changes.entry(e).or_default()
    }

    pub(crate) fn set_attr(&mut self, e: ElementId, name: &'static str, value: String) {
        self.change(e).put_attr(name, Some(value));
    }

    pub(crate) fn remove_attr(&mut self, e: ElementId, name: &'static str) {
        self.change(e).put_attr(name, None);
    }

    /// Removes all attributes that meet a condition.
    pub(crate) fn remove_attrs(&mut self, e: ElementId, mut condition: impl FnMut(&Attr) -> bool) {
        let source = self.source;
        for a in source.elements[e].attrs.iter().filter(|a| condition(a)) {
            self.change(e).removed.push(a.range.clone());
        }
    }

    pub(crate) fn rename(&mut self, e: ElementId, tag: &'static str) {
        self.change(e).tag = Some(tag);
    }

    pub(crate) fn set_content(&mut self, e: ElementId, content: String) {
        self.change(e).content = Some(content);
    }

    pub(crate) fn replace(&mut self, e: ElementId, text: String) {
        self.change(e).replaced = Some(text);
    }

    pub(crate) fn wrap_content(&mut self, e: ElementId, before: String, after: String) {
        self.change(e).around = Some((before, after));
    }

    pub(crate) fn insert_before(&mut self, e: ElementId, text: &str) {
        self.change(e).before.push_str(text);
    }

    pub(crate) fn insert_after(&mut self, e: ElementId, text: &str) {
        self.change(e).after.push_str(text);
    }

    /// Sets a presentation property so that it takes effect: in the style attribute if that or a style sheet declares the
    /// property, or else as an attribute.
    pub(crate) fn set_property(&mut self, e: ElementId, name: &'static str, value: String) {
        let is_styled = self.source.attr(e, "style").is_some_and(|s| declared(&s, name).is_some());
        if is_styled || self.source.css_declares(name) {
            self.set_style(e, name, value);
        } else {
            self.set_attr(e, name, value);
        }
    }

    /// Sets a property in the style attribute, which only `!important` overrides.
    pub(crate) fn set_style(&mut self, e: ElementId, name: &'static str, value: String) {
        let properties = &mut self.change(e).properties;
        properties.retain(|p| p.0 != name);
        properties.push((name, value));
    }

    /// Sets a length of the root, and in its style attribute too if a style would override the attribute.
    pub(crate) fn set_page_side(&mut self, name: &'static str, value: String) {
        if self.source.css_declares(name) || declared(&self.source.written_style(0), name).is_some() {
            let unit = if value.ends_with(|c: char| c.is_ascii_digit()) { "px" } else { "" };
            self.set_style(0, name, format!("{value}{unit}"));
        }
        self.set_attr(0, name, value);
    }

    /// Applies all edits and returns the new text. Edits inside a replaced element are dropped. Also returns the elements that
    /// were not replaced, with the positions where they begin in the new text.
    pub(crate) fn apply(self) -> (String, Vec<(ElementId, usize)>) {
        let source = self.source;
        let mut patches: Vec<(usize, usize, String)> = Vec::new();
        let changes = &self.changes;
        let is_set = |o: &pathwarp_reader::Change| {
            let declares_data = || o.name == "style" && declares_data(source, o.element);
            changes.get(&o.element).is_some_and(|c| c.sets(o.name, declares_data()))
        };
        let kept = source.originals.iter().filter(|o| !is_set(o));
        let kept: Vec<_> = kept.map(|o| (o.range.start, o.range.end, o.kept.clone())).collect();
        for (e, c) in self.changes {
            patch(source, e, c, &mut patches);
        }
        // Restored originals come after new content, which may begin at their position.
        patches.extend(kept);
        // The sort is stable, so insertions at one position keep their order. An insertion precedes a replacement that starts
        // at the same position, and an outer replacement precedes an inner one.
        patches.sort_by_key(|p| (p.0, p.0 != p.1, std::cmp::Reverse(p.1)));
        let text = &source.text;
        let mut out = String::with_capacity(text.len() * 2);
        let mut done = 0;
        let mut starts = Vec::new();
        let mut elements = source.elements.iter().map(|e| e.range.start).enumerate().peekable();
        patches.push((text.len(), text.len(), String::new()));
        for (from, to, new) in patches {
            if from < done {
                continue;
            }
            while let Some((e, start)) = elements.next_if(|(_, start)| *start < from) {
                starts.extend((start >= done).then(|| (e, out.len() + start - done)));
            }
            out.push_str(&text[done..from]);
            out.push_str(&new);
            done = to;
        }
        (out, starts)
    }
}

/// Returns `true` if a declaration would override the attribute `d`.
fn declares_data(source: &SourceText, e: ElementId) -> bool {
    source.css_declares("d") || declared(&source.written_style(e), "d").is_some()
}

/// Adds the patches that make a change: start, end and new text.
fn patch(source: &SourceText, e: ElementId, mut c: Change, out: &mut Vec<(usize, usize, String)>) {
    if let Some((_, Some(data))) = c.attrs.iter().find(|a| a.0 == "d")
        && declares_data(source, e)
    {
        c.properties.push(("d", format!("path('{data}')")));
    }
    let text = &source.text;
    let el = &source.elements[e];
    let beside = [(el.range.start, c.before), (el.range.end, c.after)].into_iter().filter(|(_, new)| !new.is_empty());
    out.extend(beside.map(|(at, new)| (at, at, new)));
    if let Some(new) = c.replaced {
        // A removed element leaves no empty line.
        let indented = text[..el.range.start].trim_end_matches([' ', '\t']);
        let line = indented.len() - usize::from(indented.ends_with('\n'));
        let start = if new.is_empty() && line < indented.len() { line } else { el.range.start };
        out.push((start, el.range.end, new));
        return;
    }
    let prefix = text[el.qname.clone()].find(':').map_or("", |i| &text[el.qname.start..=el.qname.start + i]);
    let qname = c.tag.map(|t| format!("{prefix}{t}"));
    if let Some(q) = &qname {
        out.push((el.qname.start, el.qname.end, q.clone()));
    }
    let mut added = String::new();
    let mut attrs = c.attrs;
    if !c.properties.is_empty() {
        let declare = |style: String, (name, value): &(&str, String)| with_declaration(&style, name, value);
        attrs.push(("style", Some(c.properties.iter().fold(source.written_style(e), declare))));
    }
    for (name, value) in attrs {
        // `xlink:href` counts as `href`.
        let existing = el.attrs.iter().filter(|a| {
            a.name(text) == name
                && (a.namespace == Namespace::None || (name == "href" && a.namespace == Namespace::Xlink))
        });
        let mut is_set = false;
        for a in existing {
            match &value {
                Some(v) if !is_set => {
                    out.push((a.value_range.start, a.value_range.end, quoted(v, text.as_bytes()[a.range.end - 1])));
                    is_set = true;
                }
                Some(_) => {}
                None => out.push(removal(text, &a.range)),
            }
        }
        if let (Some(v), false) = (&value, is_set) {
            added.push_str(&format!(" {name}=\"{}\"", escape(v)));
        }
    }
    out.extend(c.removed.iter().map(|r| removal(text, r)));
    if !added.is_empty() {
        let slash = usize::from(text.as_bytes().get(el.open_end.wrapping_sub(2)) == Some(&b'/'));
        let end = text[..el.open_end - 1 - slash].trim_end().len();
        out.push((end, end, added));
    }
    let name = qname.as_deref().unwrap_or(&text[el.qname.clone()]);
    match (&el.close, c.content, c.around) {
        (None, None, None) => {}
        (None, content, around) => {
            let inner = content.unwrap_or_default();
            let (before, after) = around.unwrap_or_default();
            out.push((el.open_end - 2, el.open_end, format!(">{before}{inner}{after}</{name}>")));
        }
        (Some(close), content, around) => {
            if let Some(inner) = content {
                out.push((el.open_end, close.start, inner));
            } else if let Some((before, after)) = around {
                out.push((el.open_end, el.open_end, before));
                out.push((close.start, close.start, after));
            }
            if qname.is_some() {
                out.push((close.start, close.end, format!("</{name}>")));
            }
        }
    }
}

/// The patch that removes an attribute with the space before it.
fn removal(text: &str, attr: &Range<usize>) -> (usize, usize, String) {
    (text[..attr.start].trim_end().len(), attr.end, String::new())
}

/// Escapes a value for the given kind of quotes.
fn quoted(value: &str, quote: u8) -> String {
    let v = escape(value);
    if quote == b'\'' { v.replace('\'', "&apos;") } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::budget::Budget;

    fn edited(shape: &str, edit: impl FnOnce(&mut Edits<'_>)) -> String {
        let head = "<svg xmlns='http://www.w3.org/2000/svg'>";
        let s = SourceText::read(format!("{head}{shape}</svg>"), "t", &Budget::default(), &|_| None, |_, _| Ok(()))
            .unwrap()
            .0;
        let mut e = Edits::new(&s);
        edit(&mut e);
        e.apply().0.strip_prefix(head).unwrap().strip_suffix("</svg>").unwrap().to_owned()
    }

    #[test]
    fn a_rect_becomes_a_path_and_keeps_the_rest() {
        let out = edited("<rect  x='1'\n y='2' id='a' ><title>t</title></rect >", |e| {
            e.rename(1, "path");
            e.remove_attr(1, "x");
            e.remove_attr(1, "y");
            e.set_attr(1, "d", "M0,0".into());
        });
        assert_eq!(out, "<path id='a' d=\"M0,0\" ><title>t</title></path>");
    }

    #[test]
    fn properties_go_where_they_win() {
        let set = |e: &mut Edits<'_>| e.set_property(1, "stroke-width", "2".into());
        assert_eq!(edited("<path stroke-width='1'/>", set), "<path stroke-width='2'/>");
        assert_eq!(edited("<path style='a:b; stroke-width : 1;'/>", set), "<path style='a:b;stroke-width:2'/>");
        assert_eq!(edited("<path/>", set), "<path stroke-width=\"2\"/>");
        let css = edited("<path/><style>path{stroke-width:3}</style>", set);
        assert!(css.starts_with("<path style=\"stroke-width:2\"/>"));
    }

    #[test]
    fn content_of_an_empty_element_and_replacement() {
        let out = edited("<g/><g><path/></g>", |e| {
            e.set_content(1, "<x/>".into());
            e.set_attr(3, "d", "M0,0".into());
            e.replace(2, "<y/>".into());
            e.insert_after(2, "<z/>");
        });
        assert_eq!(out, "<g><x/></g><y/><z/>");
    }
}
