//! The vocabulary of SVG: element numbers, namespaces, and classes of elements.

pub(crate) const SVG: &str = "http://www.w3.org/2000/svg";
pub(crate) const XLINK: &str = "http://www.w3.org/1999/xlink";
pub(crate) const XML: &str = "http://www.w3.org/XML/1998/namespace";
pub(crate) const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
/// The namespace of what pathwarp stores in a file.
pub(crate) const PATHWARP: &str = "https://github.com/pathwarp/pathwarp/ns/1";
/// End of the namespace of Sodipodi, whose host has changed over the years.
const SODIPODI: &str = "/DTD/sodipodi-0.dtd";

/// Returns `true` for the namespace of Sodipodi.
pub(crate) fn is_sodipodi(uri: &str) -> bool {
    uri.ends_with(SODIPODI)
}

/// An element's number in document order.
pub(crate) type ElementId = usize;

/// Namespace of an attribute, as far as this crate distinguishes them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Namespace {
    None,
    Xlink,
    Xml,
    Inkscape,
    Sodipodi,
    Pathwarp,
    Other,
}

impl Namespace {
    /// The namespace with the given URI.
    pub(crate) fn of(uri: Option<&str>) -> Self {
        match uri {
            None => Self::None,
            Some(XLINK) => Self::Xlink,
            Some(XML) => Self::Xml,
            Some(INKSCAPE) => Self::Inkscape,
            Some(PATHWARP) => Self::Pathwarp,
            Some(uri) if is_sodipodi(uri) => Self::Sodipodi,
            Some(_) => Self::Other,
        }
    }
}

/// Returns `true` for the basic shapes and `path`.
pub(crate) fn is_shape(tag: &str) -> bool {
    matches!(tag, "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon")
}

/// Returns `true` for elements whose ids usvg keeps in its tree.
pub(crate) fn is_tracked(tag: &str) -> bool {
    is_shape(tag) || matches!(tag, "g" | "a" | "use" | "text" | "image" | "svg" | "switch")
}

/// Returns `true` for animation elements.
pub(crate) fn is_animation(tag: &str) -> bool {
    matches!(tag, "animate" | "set" | "animateTransform" | "animateMotion" | "animateColor")
}
