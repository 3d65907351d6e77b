//! Attributes from which Inkscape computes a shape: parameters of stars, spirals, arcs, offsets and 3D boxes, path effects, and
//! connectors. Inkscape trusts them more than the path data, so a warped shape must not have them.

use super::element::Attr;
use super::tags::Namespace;

/// Such attributes in Sodipodi's namespace: the kind of shape and its parameters, and the kinds of a path's nodes.
const SODIPODI: [&str; 23] = [
    "type",
    "cx",
    "cy",
    "rx",
    "ry",
    "start",
    "end",
    "open",
    "arc-type",
    "sides",
    "r1",
    "r2",
    "arg1",
    "arg2",
    "expansion",
    "revolution",
    "radius",
    "argument",
    "t0",
    "original",
    "href",
    "nodetypes",
    "linespacing",
];

/// The same in Inkscape's namespace.
const INKSCAPE: [&str; 12] = [
    "flatsided",
    "rounded",
    "randomized",
    "radius",
    "original",
    "original-d",
    "href",
    "path-effect",
    "perspectiveID",
    "box3dsidetype",
    "corner0",
    "corner7",
];

/// Beginnings of further ones in Inkscape's namespace: connectors, centres of rotation, and the places of tiled clones.
const FAMILIES: [&str; 5] = ["connector-", "connection-", "transform-center-", "tiled-clone-", "tile-"];

/// Returns `true` for an attribute that is out of date once its element has been warped.
pub(crate) fn is_live(a: &Attr, text: &str) -> bool {
    let name = a.name(text);
    match a.namespace {
        Namespace::Sodipodi => SODIPODI.contains(&name),
        Namespace::Inkscape => INKSCAPE.contains(&name) || FAMILIES.iter().any(|f| name.starts_with(f)),
        // The source and the recipe of an earlier warp.
        Namespace::Pathwarp => true,
        Namespace::None | Namespace::Xlink | Namespace::Xml | Namespace::Other => false,
    }
}
