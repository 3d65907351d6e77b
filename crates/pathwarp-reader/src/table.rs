//! A table of the properties that determine how a drawing looks, with the values that browsers accept, spelled as usvg 0.49 reads
//! them.
//!
//! The facts are Chromium's computed values. Values of a [`Kind`] other than [`Any`] are rewritten, as usvg reads them differently.

use Kind::{
    Any, AnyKeywords, BaselineShift, Color, Dashes, Filter, FontSize, FontWeight, Geometry, Keyword, Length, Link,
    Number, Paint, Path, Share, Spacing, Transform,
};

/// A CSS property, which style sheets, style attributes, and mostly an attribute of the same name set.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: &'static str,
    /// `true` if children inherit the value by default.
    pub(super) inherited: bool,
    pub(super) initial: &'static str,
    pub(super) kind: Kind,
}

/// The values that a property takes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// One of these keywords, in upper or lower case.
    Keyword(&'static [&'static str]),
    Paint,
    Color,
    /// A number, or a percentage of 1.
    Share,
    /// A number that is not negative.
    Number,
    Length(Sign),
    /// `normal`, or a length; percentages refer to the font size.
    Spacing,
    /// `none`, or lengths.
    Dashes,
    /// `none`, or a reference to an element in the drawing.
    Link,
    /// References and functions; `none` if an element that is referred to is missing.
    Filter,
    FontSize,
    FontWeight,
    BaselineShift,
    /// A part of the transform.
    Transform,
    /// A length of SVG 2's geometry. Some elements don't take it from style sheets.
    Geometry(Sign),
    /// Path data, as `path("…")`.
    Path,
    /// Any keywords, in upper or lower case.
    AnyKeywords,
    /// Anything: usvg and browsers agree, or neither shows it.
    Any,
}

/// The signs that a length may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    Any,
    NotNegative,
}

#[rustfmt::skip]
const DISPLAY: &[&str] = &[
    "none", "inline", "block", "inline-block", "contents", "flex", "grid", "inline-flex", "inline-grid", "list-item",
    "flow-root", "run-in", "table", "inline-table", "table-row", "table-cell", "table-column", "table-caption",
    "table-row-group", "table-column-group", "table-header-group", "table-footer-group",
];
#[rustfmt::skip]
const BASELINES: &[&str] = &[
    "auto", "baseline", "before-edge", "text-before-edge", "middle", "central", "after-edge", "text-after-edge", "ideographic",
    "alphabetic", "hanging", "mathematical", "use-script", "no-change", "reset-size", "text-top", "text-bottom",
];
#[rustfmt::skip]
const BLENDS: &[&str] = &[
    "normal", "multiply", "screen", "overlay", "darken", "lighten", "color-dodge", "color-burn", "hard-light", "soft-light",
    "difference", "exclusion", "hue", "saturation", "color", "luminosity", "plus-lighter",
];

/// An inherited property.
const fn inherited(name: &'static str, initial: &'static str, kind: Kind) -> Property {
    Property { name, inherited: true, initial, kind }
}

/// A property that is not inherited.
const fn local(name: &'static str, initial: &'static str, kind: Kind) -> Property {
    Property { name, inherited: false, initial, kind }
}

/// The properties, sorted by name.
static PROPERTIES: [Property; 85] = [
    local("alignment-baseline", "baseline", Keyword(BASELINES)),
    local("baseline-shift", "baseline", BaselineShift),
    local("clip-path", "none", Link),
    inherited("clip-rule", "nonzero", Keyword(&["nonzero", "evenodd"])),
    inherited("color", "black", Color),
    inherited("color-interpolation", "sRGB", Keyword(&["auto", "sRGB", "linearRGB"])),
    inherited("color-interpolation-filters", "linearRGB", Keyword(&["auto", "sRGB", "linearRGB"])),
    local("cx", "0", Geometry(Sign::Any)),
    local("cy", "0", Geometry(Sign::Any)),
    local("d", "none", Path),
    inherited("direction", "ltr", Keyword(&["ltr", "rtl"])),
    local("display", "inline", Keyword(DISPLAY)),
    inherited("dominant-baseline", "auto", Keyword(BASELINES)),
    inherited("fill", "black", Paint),
    inherited("fill-opacity", "1", Share),
    inherited("fill-rule", "nonzero", Keyword(&["nonzero", "evenodd"])),
    local("filter", "none", Filter),
    local("flood-color", "black", Color),
    local("flood-opacity", "1", Share),
    inherited("font-family", "serif", Any),
    inherited("font-feature-settings", "normal", Any),
    inherited("font-kerning", "auto", Keyword(&["auto", "normal", "none"])),
    inherited("font-size", "16px", FontSize),
    inherited("font-size-adjust", "none", Any),
    inherited("font-stretch", "normal", AnyKeywords),
    inherited("font-style", "normal", AnyKeywords),
    inherited("font-variant", "normal", AnyKeywords),
    inherited("font-variant-caps", "normal", AnyKeywords),
    inherited("font-variant-east-asian", "normal", AnyKeywords),
    inherited("font-variant-ligatures", "normal", AnyKeywords),
    inherited("font-variant-numeric", "normal", AnyKeywords),
    inherited("font-variant-position", "normal", AnyKeywords),
    inherited("font-variation-settings", "normal", Any),
    inherited("font-weight", "400", FontWeight),
    local("height", "auto", Geometry(Sign::NotNegative)),
    inherited(
        "image-rendering",
        "auto",
        Keyword(&["auto", "optimizeQuality", "optimizeSpeed", "crisp-edges", "pixelated"]),
    ),
    local("isolation", "auto", Keyword(&["auto", "isolate"])),
    inherited("letter-spacing", "0", Spacing),
    local("lighting-color", "white", Color),
    inherited("marker-end", "none", Link),
    inherited("marker-mid", "none", Link),
    inherited("marker-start", "none", Link),
    local("mask", "none", Link),
    local("mask-type", "luminance", Keyword(&["luminance", "alpha"])),
    local("mix-blend-mode", "normal", Keyword(BLENDS)),
    local("opacity", "1", Share),
    local("overflow", "visible", Keyword(&["visible", "hidden", "scroll", "auto", "clip"])),
    inherited("paint-order", "normal", AnyKeywords),
    local("r", "0", Geometry(Sign::NotNegative)),
    local("rotate", "none", Transform),
    local("rx", "auto", Geometry(Sign::NotNegative)),
    local("ry", "auto", Geometry(Sign::NotNegative)),
    local("scale", "none", Transform),
    inherited("shape-rendering", "auto", Keyword(&["auto", "optimizeSpeed", "crispEdges", "geometricPrecision"])),
    local("stop-color", "black", Color),
    local("stop-opacity", "1", Share),
    inherited("stroke", "none", Paint),
    inherited("stroke-dasharray", "none", Dashes),
    inherited("stroke-dashoffset", "0", Length(Sign::Any)),
    inherited("stroke-linecap", "butt", Keyword(&["butt", "round", "square"])),
    inherited("stroke-linejoin", "miter", Keyword(&["miter", "round", "bevel"])),
    inherited("stroke-miterlimit", "4", Number),
    inherited("stroke-opacity", "1", Share),
    inherited("stroke-width", "1", Length(Sign::NotNegative)),
    inherited("text-anchor", "start", Keyword(&["start", "middle", "end"])),
    local("text-decoration", "none", AnyKeywords),
    local("text-decoration-style", "solid", AnyKeywords),
    local("text-decoration-thickness", "auto", Any),
    inherited("text-orientation", "mixed", AnyKeywords),
    inherited(
        "text-rendering",
        "auto",
        Keyword(&["auto", "optimizeSpeed", "optimizeLegibility", "geometricPrecision"]),
    ),
    inherited("text-shadow", "none", Any),
    inherited("text-transform", "none", AnyKeywords),
    local("transform", "none", Transform),
    local("transform-box", "view-box", Transform),
    local("transform-origin", "0 0", Transform),
    local("translate", "none", Transform),
    local("unicode-bidi", "normal", AnyKeywords),
    local("vector-effect", "none", Keyword(&["none", "non-scaling-stroke"])),
    inherited("visibility", "visible", Keyword(&["visible", "hidden", "collapse"])),
    inherited("white-space", "normal", AnyKeywords),
    local("width", "auto", Geometry(Sign::NotNegative)),
    inherited("word-spacing", "0", Spacing),
    inherited("writing-mode", "horizontal-tb", AnyKeywords),
    local("x", "0", Geometry(Sign::Any)),
    local("y", "0", Geometry(Sign::Any)),
];

/// Attributes that hold lengths and are not properties.
#[rustfmt::skip]
const LENGTHS: [&str; 15] = [
    "dx", "dy", "fr", "fx", "fy", "markerHeight", "markerWidth", "refX", "refY", "startOffset", "textLength", "x1", "x2", "y1",
    "y2",
];

/// Properties that no attribute sets.
#[rustfmt::skip]
const STYLE_ONLY: [&str; 17] = [
    "d", "font-feature-settings", "font-kerning", "font-variant-caps", "font-variant-east-asian", "font-variant-ligatures",
    "font-variant-numeric", "font-variant-position", "font-variation-settings", "isolation", "mix-blend-mode", "rotate",
    "scale", "text-shadow", "text-transform", "translate", "white-space",
];

/// Looks up a property by its name in lower case.
pub(super) fn property(name: &str) -> Option<&'static Property> {
    PROPERTIES.binary_search_by(|p| p.name.cmp(name)).ok().map(|i| &PROPERTIES[i])
}

/// The property that an attribute sets.
pub(super) fn attribute_property(name: &str) -> Option<&'static Property> {
    property(name).filter(|p| !STYLE_ONLY.contains(&p.name))
}

/// Returns the static name of an attribute that holds lengths and is not a property.
pub(super) fn length_attribute(name: &str) -> Option<&'static str> {
    LENGTHS.iter().copied().find(|n| *n == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn properties_are_found() {
        assert!(PROPERTIES.windows(2).all(|w| w[0].name < w[1].name));
        assert!(PROPERTIES.iter().all(|p| std::ptr::eq(property(p.name).unwrap(), p)));
        assert!(STYLE_ONLY.iter().all(|n| property(n).is_some() && attribute_property(n).is_none()));
        assert!(property("class").is_none());
    }
}
