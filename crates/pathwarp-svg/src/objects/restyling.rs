//! Keeps changes of appearance that were made by hand: differences between an object after its warp and the object now are repeated on
//! the object after another warp.

use super::nodes::{apply, by_id, parse};
use crate::source::elements::{INKSCAPE, declarations, parse_transform, with_declaration};
use pathwarp::Error;
use pathwarp::budget::Limits;
use pathwarp::engine::decimal::matrix;
use pathwarp::kurbo::Affine;
use pathwarp_reader::xml::{escape, name_end};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use usvg::roxmltree::Node;

/// Presentation attributes that editors write.
const PROPERTIES: &str = "fill fill-opacity fill-rule stroke stroke-opacity stroke-width stroke-linecap stroke-linejoin \
                          stroke-miterlimit stroke-dasharray stroke-dashoffset opacity display visibility paint-order color \
                          mix-blend-mode";

/// Copies to the object `id` of `new`, and to the elements in it, the properties and labels that differ between `then` and `now`.
/// References to gradients, patterns and the like, and the properties in `except`, are not copied.
///
/// # Errors
/// Returns [`Error::Input`] if one of the files is not XML, or takes more work than the limits allow.
pub fn restyled([then, now, new]: [&str; 3], id: &str, except: &[&str], limits: &Limits) -> Result<String, Error> {
    let docs = [parse(then, limits)?, parse(now, limits)?, parse(new, limits)?];
    let [thens, nows, news] = docs.each_ref().map(by_id);
    let mut patches: Vec<(Range<usize>, String)> = Vec::new();
    let inside = nows.get(id).into_iter().flat_map(Node::descendants);
    for n in inside.filter(Node::is_element) {
        let Some(name) = n.attribute("id") else { continue };
        if let (Some(before), Some(target)) = (thens.get(name), news.get(name)) {
            patches.extend(changes(*before, n, *target, new, except));
        }
    }
    Ok(if patches.is_empty() { new.to_owned() } else { apply(new, patches) })
}

/// The edits to `target` that repeat the changes from `before` to `after`.
fn changes(
    before: Node<'_, '_>,
    after: Node<'_, '_>,
    target: Node<'_, '_>,
    text: &str,
    except: &[&str],
) -> Vec<(Range<usize>, String)> {
    let mut out = Vec::new();
    let (old, now) = (properties(before), properties(after));
    let names: BTreeSet<&String> = old.keys().chain(now.keys()).collect();
    let refers = |v: Option<&String>| v.is_some_and(|v| v.contains("url("));
    let differs = |name: &&&String| {
        let (a, b) = (old.get(**name), now.get(**name));
        a != b && !refers(a) && !refers(b) && !except.contains(&name.as_str())
    };
    let style = target.attribute("style").unwrap_or_default();
    // A removed property becomes inherited.
    let value = |name: &String| now.get(name).map_or("inherit", String::as_str);
    let changed = names.iter().filter(differs);
    let new = changed.fold(style.to_owned(), |style, name| with_declaration(&style, name, value(name)));
    if new != style {
        out.push(set_attribute(target, text, None, "style", &new));
    }
    let label = |n: Node<'_, '_>| n.attribute((INKSCAPE, "label")).map(ToOwned::to_owned);
    if let Some(label) = label(after).filter(|l| Some(l) != label(before).as_ref()) {
        out.push(set_attribute(target, text, Some(INKSCAPE), "label", &label));
    }
    out
}

/// The properties of an element, from its attributes and its style.
fn properties(n: Node<'_, '_>) -> BTreeMap<String, String> {
    let plain = PROPERTIES.split(' ').filter_map(|p| Some((p.to_owned(), n.attribute(p)?.to_owned())));
    let mut out: BTreeMap<String, String> = plain.collect();
    let style = n.attribute("style").unwrap_or_default();
    out.extend(declarations(style).map(|(name, value)| (name.to_owned(), value.to_owned())));
    out
}

/// The edit that sets an attribute. Inkscape's is the only `namespace` whose prefix can be declared.
fn set_attribute(
    n: Node<'_, '_>,
    text: &str,
    namespace: Option<&str>,
    name: &str,
    value: &str,
) -> (Range<usize>, String) {
    let found = n.attributes().find(|a| a.name() == name && a.namespace() == namespace);
    if let Some(a) = found {
        // Escaped for either kind of quotes.
        return (a.range_value(), escape(value).replace('\'', "&apos;"));
    }
    let end = name_end(text, n);
    let prefix = namespace.map_or_else(String::new, |uri| match n.lookup_prefix(uri) {
        Some(prefix) => format!("{prefix}:"),
        None => format!("xmlns:inkscape=\"{uri}\" inkscape:"),
    });
    (end..end, format!(" {prefix}{name}=\"{}\"", escape(value)))
}

/// Moves the object with an id by `by`, a transform of root user space, with its `transform` attribute.
///
/// # Errors
/// Returns [`Error::Input`] if `svg` is not XML, or takes more work than the limits allow.
pub fn moved(svg: &str, id: &str, by: Affine, limits: &Limits) -> Result<String, Error> {
    let doc = parse(svg, limits)?;
    let Some(&n) = by_id(&doc).get(id) else { return Ok(svg.to_owned()) };
    let around: Vec<Affine> = n.ancestors().skip(1).map(own_transform).collect();
    let around = around.into_iter().rev().fold(Affine::IDENTITY, std::ops::Mul::mul);
    let new = matrix(around.inverse() * by * around * own_transform(n));
    Ok(apply(svg, vec![set_attribute(n, svg, None, "transform", &new)]))
}

fn own_transform(n: Node<'_, '_>) -> Affine {
    n.attribute("transform").and_then(parse_transform).unwrap_or_default()
}
