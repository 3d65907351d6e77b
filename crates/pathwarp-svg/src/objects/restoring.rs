//! Replaces warped objects by their sources.

use super::nodes::{
    Guides, MADE, NAMESPACE, NODES, RECIPE, SOURCE, apply, by_id, parse, references, referred, renaming,
};
use super::remembering::{Package, unpack};
use crate::source::elements::SVG;
use pathwarp::Error;
use pathwarp::budget::Limits;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use usvg::roxmltree::{Document, Node};

/// A file whose warped objects have been replaced by their sources.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Restored {
    /// Its text.
    pub svg: String,
    /// The objects that have been replaced.
    pub objects: Vec<RestoredObject>,
}

/// An object that has been replaced by its source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RestoredObject {
    /// Its id in the warped file.
    pub id: String,
    /// The recipe by which it was warped.
    pub recipe: String,
    /// The paths to which the recipe refers, at the time of the warp.
    pub guides: Guides,
    /// The summary of its nodes ([`Memory::nodes`](super::Memory::nodes)).
    pub nodes: String,
}

/// Replaces the objects with these ids by their sources, byte for byte. Ids in a source that are in use elsewhere, as after copying
/// the object, are changed. Definitions that the warp or an editor changed or removed come back; definitions that the warp added are
/// removed unless something else uses them. An object without a source stays, and is not in the list.
///
/// # Errors
/// [`Error::Input`] if the file is not XML, a source is damaged, or either takes more work than the limits allow.
pub fn restore(svg: &str, ids: &[String], limits: &Limits) -> Result<Restored, Error> {
    let doc = parse(svg, limits)?;
    let found = by_id(&doc);
    let targets: Vec<Node<'_, '_>> = ids.iter().filter_map(|id| found.get(id.as_str()).copied()).collect();
    let packages = targets.iter().filter_map(|n| Some((*n, n.attribute((NAMESPACE, SOURCE))?)));
    let packages: Vec<(Node<'_, '_>, String)> =
        packages.map(|(n, v)| Ok((n, unpack(v, &limits.for_input(svg.len()))?))).collect::<Result<_, Error>>()?;
    let around =
        Surroundings { text: svg, doc: &doc, by_id: found, replaced: packages.iter().map(|(n, _)| *n).collect() };
    let (taken, removed) = (HashSet::new(), HashSet::new());
    let mut restoration = Restoration { around, taken, patches: Vec::new(), defs: String::new(), removed };
    let mut objects = Vec::new();
    for (n, text) in &packages {
        let package = parse(text, limits)?;
        let damaged = || Error::input("the source of a warped object", "is damaged: it has no element");
        let package = Package::find(&package).ok_or_else(damaged)?;
        restoration.replace(*n, text, &package);
        objects.push(RestoredObject {
            id: n.attribute("id").unwrap_or_default().to_owned(),
            recipe: n.attribute((NAMESPACE, RECIPE)).unwrap_or_default().to_owned(),
            nodes: n.attribute((NAMESPACE, NODES)).unwrap_or_default().to_owned(),
            guides: Guides { markup: inner_markup(text, package.guides) },
        });
    }
    let Restoration { around, mut patches, defs, .. } = restoration;
    if !defs.is_empty() {
        patches.push(around.insertion(defs));
    }
    Ok(Restored { svg: apply(svg, patches), objects })
}

/// The text between the tags of an element.
fn inner_markup(text: &str, n: Node<'_, '_>) -> String {
    let ends = n.first_child().zip(n.last_child());
    ends.map_or_else(String::new, |(first, last)| text[first.range().start..last.range().end].to_owned())
}

/// The file around the objects to be replaced.
struct Surroundings<'a, 'i> {
    text: &'a str,
    doc: &'a Document<'i>,
    by_id: HashMap<&'a str, Node<'a, 'i>>,
    replaced: HashSet<Node<'a, 'i>>,
}

impl<'a, 'i> Surroundings<'a, 'i> {
    /// Returns `true` for an element that stays.
    fn stays(&self, n: Node<'a, 'i>) -> bool {
        !n.ancestors().any(|a| self.replaced.contains(&a))
    }

    /// Returns `true` if an element that stays, outside the definition `n` and the definitions with the ids `except`, refers to `name`.
    fn is_used(&self, name: &str, n: Node<'a, 'i>, except: &HashSet<String>) -> bool {
        let counts = |o: &Node<'a, 'i>| {
            self.stays(*o) && !o.ancestors().any(|a| a == n || a.attribute("id").is_some_and(|id| except.contains(id)))
        };
        let refers = |o: Node<'a, 'i>| o.attributes().any(|a| references(a.value()).any(|r| &a.value()[r] == name));
        self.doc.descendants().filter(Node::is_element).filter(counts).any(refers)
    }

    /// The insertion of definitions into the file.
    fn insertion(&self, defs: String) -> (Range<usize>, String) {
        let root = self.doc.root_element();
        let home = root.children().find(|n| {
            n.tag_name().name() == "defs" && n.tag_name().namespace() == Some(SVG) && n.last_child().is_some()
        });
        if let Some(last) = home.and_then(|h| h.last_child()) {
            let end = last.range().end;
            return (end..end, defs);
        }
        let end = self.text[..root.range().end].rfind("</").unwrap_or(root.range().end);
        (end..end, format!("<defs>{defs}</defs>"))
    }
}

/// Edits that replace objects by their sources.
struct Restoration<'a, 'i> {
    around: Surroundings<'a, 'i>,
    /// Ids in the sources and definitions that have been inserted.
    taken: HashSet<String>,
    patches: Vec<(Range<usize>, String)>,
    /// Definitions to be added.
    defs: String,
    /// Ids of the definitions removed or replaced.
    removed: HashSet<String>,
}

impl<'a, 'i> Restoration<'a, 'i> {
    /// Replaces an object by the element of a package, whose text is `text`.
    fn replace(&mut self, n: Node<'a, 'i>, text: &str, package: &Package<'_, '_>) {
        // New ids by the ids in the package.
        let mut names: HashMap<String, String> = HashMap::new();
        let made: HashSet<String> =
            n.attribute((NAMESPACE, MADE)).unwrap_or_default().split_whitespace().map(ToOwned::to_owned).collect();
        // The object keeps the id it has now.
        if let (Some(old), Some(now)) = (package.element.attribute("id"), n.attribute("id"))
            && old != now
        {
            names.insert(old.to_owned(), now.to_owned());
        }
        for id in package.element.descendants().skip(1).filter_map(|d| d.attribute("id")) {
            let stays = self.around.by_id.get(id).is_some_and(|o| self.around.stays(*o));
            if (stays && !made.contains(id)) || self.taken.contains(id) {
                names.insert(id.to_owned(), self.free_id(id));
            }
        }
        let mut added = Vec::new();
        for d in &package.definitions {
            let Some(id) = d.attribute("id") else { continue };
            match self.around.by_id.get(id).copied().filter(|o| self.around.stays(*o)) {
                // Another source has brought it.
                None if self.taken.contains(id) => {}
                None => added.push(*d),
                Some(old) if same_words(&self.around.text[old.range()], &text[d.range()]) => {}
                Some(old) if self.removed.contains(id) || !self.around.is_used(id, old, &made) => {
                    if self.removed.insert(id.to_owned()) {
                        self.patches.push((old.range(), text[d.range()].to_owned()));
                    }
                }
                Some(_) => {
                    names.insert(id.to_owned(), self.free_id(id));
                    added.push(*d);
                }
            }
        }
        let new_id = |id: &str| names.get(id).map_or(id, String::as_str).to_owned();
        for d in added {
            self.taken.insert(new_id(d.attribute("id").unwrap_or_default()));
            self.defs += &renamed(text, d, &names);
        }
        self.remove_made(&made);
        self.taken.extend(package.element.descendants().filter_map(|d| d.attribute("id")).map(new_id));
        self.patches.push((n.range(), renamed(text, package.element, &names)));
    }

    /// Removes the definitions that the warp added, unless another element uses them.
    fn remove_made(&mut self, made: &HashSet<String>) {
        for id in made {
            let Some(&d) = self.around.by_id.get(id.as_str()) else { continue };
            if self.around.stays(d) && !self.around.is_used(id, d, made) && self.removed.insert(id.clone()) {
                let range = d.range();
                self.patches.push((self.around.text[..range.start].trim_end().len()..range.end, String::new()));
            }
        }
    }

    /// An id like `id` that is not in use.
    fn free_id(&self, id: &str) -> String {
        let is_free = |new: &String| !self.around.by_id.contains_key(new.as_str()) && !self.taken.contains(new);
        (2..).map(|n: u64| format!("{id}-{n}")).find(is_free).unwrap_or_else(|| id.to_owned())
    }
}

/// The text of an element with new ids, which `names` gives by the old ones.
fn renamed(text: &str, n: Node<'_, '_>, names: &HashMap<String, String>) -> String {
    let refers = || referred(n).iter().any(|r| names.contains_key(r));
    let has_id = || n.descendants().any(|d| d.attribute("id").is_some_and(|id| names.contains_key(id)));
    if names.is_empty() || !(refers() || has_id()) {
        return text[n.range()].to_owned();
    }
    let start = n.range().start;
    let patches = renaming(text, n, names).into_iter().map(|(r, new)| (r.start - start..r.end - start, new));
    apply(&text[n.range()], patches.collect())
}

/// Returns `true` if two texts differ at most in white space, which editors change.
fn same_words(a: &str, b: &str) -> bool {
    a.split_ascii_whitespace().eq(b.split_ascii_whitespace())
}
