//! Elements that usvg shows otherwise than browsers do, whatever their style.

use super::value::percent_decoded;
use super::xml;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use roxmltree::Node;

/// The attributes that change, each with its new value; `None` takes it away.
pub(super) fn attributes(node: Node<'_, '_>) -> impl Iterator<Item = (&'static str, Option<String>)> + use<> {
    let root = ["display", "systemLanguage"].into_iter().filter(|name| {
        // A drawing of its own is shown.
        node.parent_element().is_none() && node.has_attribute(*name)
    });
    // No browser knows `tref`.
    let tref = (node.tag_name().name() == "tref" && link(node).is_some()).then_some("href");
    let aspect = (node.tag_name().name() == "image").then(|| picture_aspect(node)).flatten();
    let aspect = aspect.map(|value| ("preserveAspectRatio", Some(value)));
    // A list with anything else draws nothing.
    let is_list =
        |b: u8| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b',' | b'e' | b'E') || b.is_ascii_whitespace();
    let damaged = node.attribute("points").is_some_and(|list| !list.bytes().all(is_list));
    let gone: Vec<_> = root.chain(tref).chain(damaged.then_some("points")).map(|name| (name, None)).collect();
    gone.into_iter().chain(aspect)
}

fn link<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    node.attributes().find(|a| a.name() == "href").map(|a| a.value())
}

/// How an embedded drawing without a size of its own fits into its image: as it says itself (CSS Images 3, section 4.2).
fn picture_aspect(image: Node<'_, '_>) -> Option<String> {
    let data = link(image)?.trim().strip_prefix("data:")?;
    let (kind, data) = data.split_once(',').filter(|(kind, _)| kind.starts_with("image/svg+xml"))?;
    let text = if kind.ends_with("base64") {
        let data: String = data.split_ascii_whitespace().collect();
        String::from_utf8(STANDARD.decode(data).ok()?).ok()?
    } else {
        percent_decoded(data).into_owned()
    };
    let drawing = xml::document(&text).ok()?;
    let root = drawing.root_element();
    let sized = ["width", "height"].iter().any(|name| root.attribute(*name).is_some_and(|v| !v.contains('%')));
    (root.has_attribute("viewBox") && !sized)
        .then(|| root.attribute("preserveAspectRatio").unwrap_or("xMidYMid").to_owned())
}
