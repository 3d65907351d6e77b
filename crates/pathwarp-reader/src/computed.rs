//! Computes the style of one element: declarations that usvg reads, attributes, and the declarations of the transform.

use crate::geometry::{shape_box, shape_length};
use crate::ids::{Ids, attribute};
use crate::sheet::{Declaration, simple};
use crate::table::{Kind, Property, Sign, attribute_property, length_attribute, property};
use crate::text::{self, Letters, TextStyle};
use crate::value::{self, Custom, Reference, Units, reference};
use crate::words::Words;
use crate::{color, range};
use csscolorparser::Color;
use pathwarp::kurbo::Affine;
use roxmltree::Node;
use std::borrow::Cow;
use std::collections::HashSet;
use std::rc::Rc;
use std::sync::Arc;

pub(super) const MARKERS: [&str; 3] = ["marker-start", "marker-mid", "marker-end"];

const PERCENT_SPACING: &str = "spacing in per cent is a share of the font's size, which Chromium takes on the screen";

const DASHES: [&str; 2] = ["stroke-dasharray", "stroke-dashoffset"];

/// Inherited properties whose values other rules need.
const TRACKED: [&str; 6] =
    [DASHES[0], DASHES[1], "fill", "stroke", "color-interpolation", "color-interpolation-filters"];

/// Values of [`TRACKED`].
pub(super) type Tracked = [Option<Rc<str>>; TRACKED.len()];

/// State passed from an element to its children.
#[derive(Debug, Clone)]
pub(super) struct Inherited {
    /// `true` inside a symbol with a viewport. Percentages refer to that viewport, which usvg doesn't know.
    pub(super) in_symbol: bool,
    /// `true` if paths have markers.
    pub(super) has_markers: bool,
    pub(super) custom: Rc<Custom>,
    pub(super) units: Units,
    pub(super) color: Color,
    pub(super) tracked: Tracked,
    pub(super) text: TextStyle,
    pub(super) words: Arc<Words>,
}

/// Properties with their values as the author wrote them; `None` for the initial value.
type Written<'a> = Vec<(Cow<'a, str>, Option<Cow<'a, str>>)>;

/// The name and the value of a declaration.
type Pair<'a> = (Cow<'a, str>, Cow<'a, str>);

impl Inherited {
    /// Records which declarations of an element are about paint. Returns all such declarations that hold for it.
    fn record_words(&mut self, written: Written<'_>) -> Arc<Words> {
        for (name, value) in written.into_iter().filter(|s| Words::records(&s.0)) {
            Arc::make_mut(&mut self.words).record(&name, value.as_deref());
        }
        Arc::clone(&self.words)
    }

    /// Takes the values of [`TRACKED`] that an element declares.
    fn track(&mut self, declared: impl Fn(&str) -> Option<String>) {
        for (name, value) in TRACKED.iter().zip(&mut self.tracked) {
            if let Some(v) = declared(name).filter(|v| v.trim() != "inherit") {
                *value = Some(v.into());
            }
        }
    }

    /// The value of a property of [`TRACKED`].
    fn tracked(&self, name: &str) -> Option<&str> {
        self.tracked[TRACKED.iter().position(|t| *t == name)?].as_deref()
    }
}

/// The style of an element.
#[derive(Debug, Default)]
pub(super) struct Computed<'a> {
    /// Declarations for usvg, unless the style attribute already holds exactly these.
    pub(super) style: Option<Vec<Pair<'a>>>,
    /// New values of attributes; `None` removes the attribute.
    pub(super) attributes: Vec<(&'static str, Option<String>)>,
    /// Declarations that make up the transform.
    pub(super) transform: Vec<Declaration<'a>>,
    /// Unsupported features, worded for people.
    pub(super) unsupported: Vec<String>,
    pub(super) letters: Letters,
    /// Small differences from what browsers show.
    pub(super) notes: Vec<&'static str>,
    /// The first number out of range.
    pub(super) far: Option<String>,
    pub(super) words: Arc<Words>,
    /// `true` if the element is a gradient whose colours are interpolated in linear light.
    pub(super) is_linear: bool,
    /// The colour of a stop in such a gradient.
    pub(super) stop: Option<Color>,
}

/// The geometry properties that Chromium takes from style sheets. Nested viewports take none, and a `use` takes no size.
fn styled_geometry(tag: &str, is_root: bool) -> &'static [&'static str] {
    match tag {
        "rect" => &["x", "y", "width", "height", "rx", "ry"],
        "circle" => &["cx", "cy", "r"],
        "ellipse" => &["cx", "cy", "rx", "ry"],
        "image" => &["x", "y", "width", "height"],
        "use" => &["x", "y"],
        "svg" if is_root => &["width", "height"],
        _ => &[],
    }
}

/// Computes the style of an element from the declarations that apply, weakest first. `inherited` comes from the parent and is
/// updated for the element's children.
pub(super) fn computed<'a>(
    node: Node<'a, '_>,
    is_root: bool,
    declarations: &[&Declaration<'a>],
    ids: &Ids<'a, '_>,
    inherited: &mut Inherited,
) -> Computed<'a> {
    let tag = node.tag_name().name();
    let variables = declarations.iter().filter(|d| d.name.starts_with("--"));
    let variables: Vec<(String, String)> = variables.map(|d| (d.name.to_string(), d.value.to_string())).collect();
    if !variables.is_empty() {
        inherited.custom = Rc::new(value::custom(&variables, &inherited.custom));
        Arc::make_mut(&mut inherited.words).declare_variables(node.range().start);
    }
    let is_resource =
        matches!(tag, "linearGradient" | "radialGradient" | "pattern" | "mask" | "filter" | "marker" | "clipPath");
    let mut values = Values {
        custom: Rc::clone(&inherited.custom),
        units: inherited.units,
        parent_font: inherited.units.font,
        color: inherited.color,
        converts_percent: inherited.in_symbol && !is_resource && !tag.starts_with("fe"),
        ids,
    };
    // Resolve the font size first; other lengths depend on it.
    if let Some(px) = font_size(node, declarations, &values) {
        inherited.units.font = px;
    }
    if is_root {
        inherited.units.root_font = inherited.units.font;
    }
    values.units = inherited.units;
    if let Some(color) = declared_color(node, declarations, &values) {
        values.color = color;
        inherited.color = color;
    }
    let geometry = styled_geometry(tag, is_root);
    let (decided, dropped) = (HashSet::new(), HashSet::new());
    let (written, unknown, style) = (Vec::new(), Vec::new(), Vec::new());
    let out = Computed::default();
    let mut collector = Collector { tag, geometry, values: &values, decided, dropped, written, unknown, style, out };
    for d in declarations.iter().rev().filter(|d| !d.name.starts_with("--")) {
        collector.declare(d);
    }
    collector.style.reverse();
    collector.take_attributes(node);
    collector.replace_unknown(node);
    collector.finish(node, inherited)
}

/// The size of an element's font in px, if it declares one.
fn font_size(node: Node<'_, '_>, declarations: &[&Declaration<'_>], values: &Values<'_, '_, '_>) -> Option<f64> {
    let size = property("font-size")?;
    let px =
        |text: &str, strict| value::length(&values.rewrite(size, text, strict)?, &values.units, values.parent_font);
    let declared = declarations.iter().rev().find_map(|d| match d.name.as_ref() {
        "font-size" => match css_wide(&d.value) {
            Some(CssWide::Initial) => Some(value::MEDIUM),
            Some(_) => Some(values.parent_font),
            None => px(&d.value, d.strict),
        },
        "font" => px(&text::font(&values.substituted(&d.value)?)?.iter().find(|l| l.0 == "font-size")?.1, true),
        _ => None,
    });
    declared.or_else(|| px(node.attribute("font-size")?, false))
}

/// The colour that an element declares as its `color`.
fn declared_color(node: Node<'_, '_>, declarations: &[&Declaration<'_>], values: &Values<'_, '_, '_>) -> Option<Color> {
    let resolve = |text: &str| match css_wide(text.trim()) {
        Some(CssWide::Initial) => Some(Color::default()),
        Some(_) => Some(values.color),
        None => {
            color::computed(value::computed(&values.substituted(text)?, &values.units, None)?.trim(), &values.color)
        }
    };
    let mut declared = declarations.iter().rev().filter(|d| d.name == "color").map(|d| d.value.as_ref());
    declared.find_map(resolve).or_else(|| resolve(node.attribute("color")?))
}

/// The meaning of a CSS-wide keyword.
#[derive(Clone, Copy, PartialEq, Eq)]
enum CssWide {
    Inherit,
    Initial,
    /// Inherits if the property is inherited by default; otherwise the initial value.
    Unset,
}

fn css_wide(value: &str) -> Option<CssWide> {
    const KEYWORDS: [(&str, CssWide); 5] = [
        ("inherit", CssWide::Inherit),
        ("initial", CssWide::Initial),
        ("unset", CssWide::Unset),
        ("revert", CssWide::Unset),
        ("revert-layer", CssWide::Unset),
    ];
    KEYWORDS.iter().find(|(word, _)| value.eq_ignore_ascii_case(word)).map(|(_, meaning)| *meaning)
}

/// The value that a CSS-wide keyword stands for; `None` if it is the parent's value.
fn css_wide_value(keyword: CssWide, p: &Property) -> Option<&'static str> {
    match keyword {
        CssWide::Inherit => None,
        CssWide::Unset if p.inherited => None,
        CssWide::Initial | CssWide::Unset => Some(p.initial),
    }
}

/// Returns `true` if browsers accept the value of a declaration. Values with variables or expressions count as accepted.
pub(super) fn is_valid(d: &Declaration<'_>, units: Units, ids: &Ids<'_, '_>) -> bool {
    let Some(p) = property(&d.name).filter(|_| css_wide(&d.value).is_none() && !value::has_functions(&d.value)) else {
        return true;
    };
    let (custom, color) = (Rc::default(), Color::default());
    let values = Values { custom, units, parent_font: units.font, color, converts_percent: false, ids };
    values.rewrite(p, &d.value, d.strict).is_some()
}

/// Computes single values.
struct Values<'d, 'a, 'i> {
    custom: Rc<Custom>,
    units: Units,
    /// Font size of the parent.
    parent_font: f64,
    /// The colour that `currentColor` stands for.
    color: Color,
    /// `true` if percentages are converted to px.
    converts_percent: bool,
    ids: &'d Ids<'a, 'i>,
}

impl Values<'_, '_, '_> {
    /// Replaces variables. Returns `None` if one has no value.
    fn substituted(&self, raw: &str) -> Option<String> {
        value::substituted(raw, &|n| self.custom.get(n).map(ToString::to_string))
    }

    /// Rewrites a value for usvg. Returns `None` if it is invalid. If `strict`, lengths other than zero need a unit.
    fn rewrite<'v>(&self, p: &Property, raw: &'v str, strict: bool) -> Option<Cow<'v, str>> {
        let raw = raw.trim();
        if value::has_functions(raw) && !matches!(p.kind, Kind::Transform | Kind::Any) {
            let text = self.substituted(raw)?;
            let text = value::computed(&text, &self.units_for(p), Some(self.percentage_base(p)))?;
            return Some(Cow::Owned(self.rewrite_simple(p, text.trim(), strict)?.into_owned()));
        }
        if matches!(p.kind, Kind::Transform | Kind::Any) && !value::is_plain(raw) {
            let text = self.substituted(raw)?;
            return Some(Cow::Owned(value::computed(&text, &self.units_for(p), None).unwrap_or(text)));
        }
        self.rewrite_simple(p, raw, strict)
    }

    /// The units for a property. For font sizes, they refer to the parent's font.
    fn units_for(&self, p: &Property) -> Units {
        let font = if matches!(p.kind, Kind::FontSize) { self.parent_font } else { self.units.font };
        Units { font, ..self.units }
    }

    /// The value that 100 % stands for.
    fn percentage_base(&self, p: &Property) -> f64 {
        match p.kind {
            Kind::FontSize => self.parent_font,
            Kind::Spacing => self.units.font,
            Kind::Share => 1.0,
            _ => self.units.percentage_base(p.name),
        }
    }

    /// Rewrites a value that holds no variables or expressions.
    fn rewrite_simple<'v>(&self, p: &Property, raw: &'v str, strict: bool) -> Option<Cow<'v, str>> {
        match p.kind {
            Kind::Keyword(words) => word(words, raw),
            Kind::Paint => color::paint(self.visible_paint(raw), &self.color),
            Kind::Color => color::color(raw, &self.color),
            Kind::Share => share(raw),
            Kind::Number => raw.parse::<f64>().ok().filter(|n| *n >= 0.0).map(|_| Cow::Borrowed(raw)),
            Kind::Length(sign) | Kind::Geometry(sign) if raw != "auto" => self.length(p, raw, sign, false),
            Kind::Spacing if raw.eq_ignore_ascii_case("normal") => Some("normal".into()),
            Kind::Spacing => self.length(p, raw, Sign::Any, strict),
            Kind::Link | Kind::Dashes if raw.eq_ignore_ascii_case("none") => Some("none".into()),
            Kind::Dashes => list(raw, |v| self.length(p, v, Sign::NotNegative, false)),
            Kind::FontSize => match text::size(raw, self.parent_font) {
                Some(px) => Some(format!("{px}px").into()),
                None => self.length(p, raw, Sign::NotNegative, strict),
            },
            Kind::AnyKeywords => (!raw.is_empty()).then(|| lower(raw)),
            Kind::FontWeight => text::weight(raw, 400).map(|_| lower(raw)),
            Kind::BaselineShift => word(&["baseline", "sub", "super"], raw)
                .or_else(|| self.length(&Property { kind: Kind::Length(Sign::Any), ..*p }, raw, Sign::Any, false)),
            // CSS shapes stay as they are.
            Kind::Link => Some(reference(raw).map_or(Cow::Borrowed(raw), |r| r.text(raw))),
            Kind::Filter => Some(self.filter(p, raw)),
            _ => (!raw.is_empty()).then_some(Cow::Borrowed(raw)),
        }
    }

    /// Rewrites a length in a unit that usvg knows.
    fn length<'v>(&self, p: &Property, raw: &'v str, sign: Sign, strict: bool) -> Option<Cow<'v, str>> {
        let converts = self.converts_percent || matches!(p.kind, Kind::FontSize | Kind::Spacing);
        let base = converts.then(|| self.percentage_base(p));
        value::known_length(raw, &self.units_for(p), base, sign == Sign::NotNegative, strict)
    }

    /// An attribute of a gradient or pattern, or of one that it refers to. Gradients and patterns have different `names` for it.
    fn server_attribute(&self, id: Option<&str>, names: [&str; 2]) -> Option<&str> {
        /// Gradients that refer to each other in a circle must end.
        const MAX_LINKS: usize = 16;
        let mut chain = std::iter::successors(self.ids.get(id?), |n| self.ids.target(*n)).take(MAX_LINKS);
        chain.find_map(|n| names.into_iter().find_map(|name| n.attribute(name)))
    }

    /// Replaces a gradient or pattern with a singular transform by its fallback colour, or by `none`.
    fn visible_paint<'v>(&self, raw: &'v str) -> &'v str {
        let Some(link) = reference(raw) else { return raw };
        let given = self.server_attribute(link.id.as_deref(), ["gradientTransform", "patternTransform"]);
        let t = given.and_then(|t| t.parse::<svgtypes::Transform>().ok());
        if t.is_some_and(|t| t.a * t.d == t.b * t.c) { fallback(&link) } else { raw }
    }

    /// The paint that replaces a gradient or pattern in box units on a shape whose box has no width or no height.
    fn paint_of_flat_shape<'v>(&self, raw: &'v str) -> Option<&'v str> {
        let link = reference(raw)?;
        let units = self.server_attribute(link.id.as_deref(), ["gradientUnits", "patternUnits"]);
        (units != Some("userSpaceOnUse")).then(|| fallback(&link))
    }

    /// Further declarations: the paint that replaces a gradient or pattern that cannot apply to a flat shape, and the colour of a drop
    /// shadow in sRGB. `declared` looks up the properties of the element.
    fn replaced_paints<'n>(
        &self,
        node: Node<'n, '_>,
        inherited: &Inherited,
        computed: &Computed<'n>,
        declared: &dyn Fn(&str) -> Option<String>,
    ) -> Vec<Pair<'n>> {
        let tag = node.tag_name().name();
        let mut out = Vec::new();
        let is_flat = || {
            let area = shape_box(tag, |name| computed.value(node, name), &self.units);
            area.is_some_and(|b| b.width() == 0.0 || b.height() == 0.0)
        };
        for name in ["fill", "stroke"] {
            let paint = inherited.tracked(name).and_then(|v| self.paint_of_flat_shape(v));
            out.extend(paint.filter(|_| is_flat()).map(|p| (name.into(), p.to_owned().into())));
        }
        if tag == "feDropShadow" && inherited.tracked("color-interpolation-filters") == Some("sRGB") {
            let flood = declared("flood-color").and_then(|c| color::computed(&c, &self.color));
            out.extend(flood.map(|c| ("flood-color".into(), color::shadow(&c).into())));
        }
        out
    }

    /// The colour of a stop.
    fn stop(&self, declared: &dyn Fn(&str) -> Option<String>) -> Color {
        let color = declared("stop-color").and_then(|c| color::computed(&c, &self.color));
        let opacity = declared("stop-opacity").and_then(|o| value::length(&o, &self.units, 1.0));
        let [r, g, b, a] = color.map_or([0.0, 0.0, 0.0, 1.0], |c| c.to_array());
        Color::new(r, g, b, a * opacity.unwrap_or(1.0) as f32)
    }

    /// Rewrites a list of filters. If one of them does not exist, browsers apply none.
    fn filter<'v>(&self, p: &Property, raw: &'v str) -> Cow<'v, str> {
        let mut links = raw.char_indices().filter_map(|(start, _)| reference(&raw[start..]));
        let is_there = |id: &str| self.ids.get(id).is_some_and(|n| n.tag_name().name() == "filter");
        if raw.eq_ignore_ascii_case("none") || links.any(|l| l.id.as_deref().is_none_or(|id| !is_there(id))) {
            return "none".into();
        }
        // Links in lists stay as they are.
        match reference(raw).filter(|l| l.rest.trim().is_empty()) {
            Some(only) => only.text(raw),
            None => color::rewritten_functions(raw, &self.color, |v| self.length(p, v, Sign::Any, false)),
        }
    }
}

/// The paint that replaces a gradient or pattern that cannot apply.
fn fallback<'v>(link: &Reference<'v>) -> &'v str {
    if link.rest.trim().is_empty() { "none" } else { link.rest.trim() }
}

/// Rewrites the items of a list separated by spaces, commas, or both. Returns `None` if any item is invalid.
fn list<'v>(raw: &'v str, rewrite: impl Fn(&'v str) -> Option<Cow<'v, str>>) -> Option<Cow<'v, str>> {
    let items = raw.split(',').flat_map(|part| {
        let mut words = part.split_ascii_whitespace().peekable();
        // Two commas in a row make an empty, invalid item.
        let empty = words.peek().is_none().then_some("");
        words.chain(empty)
    });
    let all = items.map(|v| Some((v, rewrite(v)?))).collect::<Option<Vec<_>>>()?;
    let changed = all.iter().any(|(old, new)| *old != new.as_ref());
    Some(if changed {
        all.iter().map(|v| v.1.as_ref()).collect::<Vec<_>>().join(" ").into()
    } else {
        Cow::Borrowed(raw)
    })
}

/// The keyword that a value is, in upper or lower case.
fn word<'v>(words: &'static [&'static str], raw: &'v str) -> Option<Cow<'v, str>> {
    words.iter().find(|w| w.eq_ignore_ascii_case(raw)).map(|w| Cow::Borrowed(*w))
}

fn lower(raw: &str) -> Cow<'_, str> {
    if raw.bytes().any(|b| b.is_ascii_uppercase()) { raw.to_ascii_lowercase().into() } else { Cow::Borrowed(raw) }
}

/// Accepts a number or a percentage.
fn share(raw: &str) -> Option<Cow<'_, str>> {
    let number = raw.strip_suffix('%').unwrap_or(raw);
    // CSS numbers must not end in a point.
    let valid = !number.ends_with('.') && number.parse::<f64>().is_ok_and(f64::is_finite);
    valid.then_some(Cow::Borrowed(raw))
}

/// Collects the declarations of an element for usvg.
struct Collector<'v, 'a, 'i> {
    tag: &'v str,
    /// The geometry properties that the element takes from its style.
    geometry: &'static [&'static str],
    values: &'v Values<'v, 'a, 'i>,
    /// Properties that a valid declaration sets.
    decided: HashSet<Cow<'a, str>>,
    /// Properties that inherit, but for which usvg doesn't know the keyword `inherit`. They are left out.
    dropped: HashSet<&'static str>,
    written: Written<'a>,
    /// Colours that are not understood, by property.
    unknown: Vec<(&'static str, String)>,
    /// Strongest first, until all declarations have been added.
    style: Vec<Pair<'a>>,
    out: Computed<'a>,
}

impl<'a> Collector<'_, 'a, '_> {
    /// Adds a declaration weaker than all before it. The strongest valid declaration of a property wins.
    fn declare(&mut self, d: &Declaration<'a>) {
        match d.name.as_ref() {
            "font" => {
                let Some(all) = self.values.substituted(&d.value).and_then(|v| text::font(&v)) else { return };
                for (name, value) in all {
                    if let Some(p) = property(name) {
                        self.set(p, &Declaration { name: name.into(), value: value.into(), ..d.clone() });
                    }
                }
            }
            "marker" => {
                for p in MARKERS.into_iter().filter_map(property) {
                    self.set(p, &Declaration { name: p.name.into(), ..d.clone() });
                }
            }
            name => match property(name) {
                Some(p) => self.set(p, d),
                None => {
                    if self.decided.insert(d.name.clone()) {
                        self.out.unsupported.extend(unsupported(&d.name, &d.value));
                        self.style.push((d.name.clone(), d.value.clone()));
                    }
                }
            },
        }
    }

    /// Sets a property, unless a stronger declaration has done so or this one is invalid.
    fn set(&mut self, p: &'static Property, d: &Declaration<'a>) {
        if self.decided.contains(p.name) {
            return;
        }
        self.note_percent_spacing(p, &d.value);
        let value = match css_wide(&d.value) {
            Some(keyword) => match css_wide_value(keyword, p) {
                Some(initial) => Cow::Borrowed(initial),
                None if !knows_inherit(p) => {
                    self.decided.insert(p.name.into());
                    self.dropped.insert(p.name);
                    return;
                }
                None => "inherit".into(),
            },
            None => match self.values.rewrite(p, &d.value, d.strict) {
                Some(v) if v == d.value => d.value.clone(),
                Some(v) => v.into_owned().into(),
                None => return self.note_color(p, &d.value),
            },
        };
        self.decided.insert(p.name.into());
        self.record(p, d.value.clone());
        match p.kind {
            Kind::Transform => self.out.transform.push(Declaration { value, ..d.clone() }),
            Kind::Geometry(_) if self.geometry.contains(&p.name) => {
                let value = self.in_range(&value).into_owned();
                // Attributes cannot be `auto`; leaving one out means the same.
                self.out.attributes.push((p.name, Some(value).filter(|v| v != "auto")));
            }
            Kind::Path if self.tag == "path" => {
                let data = value::path_data(&value).unwrap_or_default();
                let data = self.in_range(&data).into_owned();
                self.out.attributes.push((p.name, Some(data)));
            }
            Kind::Length(_) | Kind::Spacing | Kind::Dashes | Kind::FontSize => {
                let value = self.in_range(&value).into_owned();
                self.style.push((d.name.clone(), value.into()));
            }
            _ => {
                self.out.unsupported.extend(unsupported(p.name, &value));
                self.style.push((d.name.clone(), value));
            }
        }
    }

    /// Records a valid value if the property is about paint.
    fn record(&mut self, p: &'static Property, raw: Cow<'a, str>) {
        if Words::records(p.name) {
            match css_wide(raw.trim()).map(|keyword| css_wide_value(keyword, p)) {
                Some(None) => {}
                Some(Some(_)) => self.written.push((p.name.into(), None)),
                None => self.written.push((p.name.into(), Some(raw))),
            }
        }
    }

    /// Notes percentages that Chromium resolves against the font's size on the screen.
    fn note_percent_spacing(&mut self, p: &Property, value: &str) {
        let is_percent_spacing = matches!(p.kind, Kind::Spacing) && value.trim_end().ends_with('%');
        self.out.notes.extend(is_percent_spacing.then_some(PERCENT_SPACING));
    }

    /// Remembers a value that may be a colour, and is not understood.
    fn note_color(&mut self, p: &'static Property, value: &str) {
        if matches!(p.kind, Kind::Paint | Kind::Color) && self.unknown.iter().all(|u| u.0 != p.name) {
            let value = self.values.substituted(value).filter(|v| color::may_be_color(v));
            self.unknown.extend(value.map(|v| (p.name, v)));
        }
    }

    /// Reports the colours that are not understood. Black replaces those that have no other value.
    fn replace_unknown(&mut self, node: Node<'a, '_>) {
        for (name, value) in std::mem::take(&mut self.unknown) {
            let is_set = self.decided.contains(name) || self.out.value(node, name).is_some();
            if !is_set {
                self.style.push((name.into(), "black".into()));
            }
            let other = if is_set { "another declaration" } else { "black" };
            let value = text::excerpt(&value);
            self.out.unsupported.push(format!(
                "only with {other} in place of “{name}: {value}”, a colour that is not understood; write it as #rrggbb"
            ));
        }
    }

    /// Brings the numbers of a value into range, and remembers the first that was not.
    fn in_range<'t>(&mut self, value: &'t str) -> Cow<'t, str> {
        let (value, first_out) = range::in_range(value);
        self.out.far = self.out.far.take().or(first_out);
        value
    }

    /// Computes the attributes that no declaration overrides.
    fn take_attributes(&mut self, node: Node<'a, '_>) {
        for a in node.attributes().filter(|a| a.namespace().is_none()) {
            let (name, raw) = (a.name(), a.value());
            if let Some(p) = attribute_property(name) {
                if !self.decided.contains(p.name) {
                    self.take_attribute(p, raw);
                } else if self.dropped.contains(p.name) {
                    self.out.attributes.push((p.name, None));
                }
            } else if let Some(name) = length_attribute(name) {
                let p = Property { name, inherited: false, initial: "0", kind: Kind::Length(Sign::Any) };
                let rewritten = list(raw.trim(), |v| self.values.rewrite(&p, v, false));
                let new = rewritten.filter(|new| new != raw.trim()).unwrap_or(Cow::Borrowed(raw));
                let new = self.in_range(&new).into_owned();
                self.out.attributes.extend((new != raw).then_some((name, Some(new))));
            } else if let Some(name) = range::checked(name)
                && let Cow::Owned(new) = self.in_range(raw)
            {
                self.out.attributes.push((name, Some(new)));
            }
        }
    }

    /// Computes the attribute of a property.
    fn take_attribute(&mut self, p: &'static Property, raw: &'a str) {
        if matches!(p.kind, Kind::Transform) {
            if let Cow::Owned(new) = self.in_range(raw) {
                self.out.attributes.push((p.name, Some(new)));
            }
            return;
        }
        self.note_percent_spacing(p, raw);
        if p.name == "image-rendering" {
            // usvg reads the CSS keywords from the style attribute only.
            let new = self.values.rewrite(p, raw, false).map(|v| (p.name.into(), v.into_owned().into()));
            self.style.extend(new);
            return;
        }
        let is_geometry = matches!(p.kind, Kind::Geometry(_));
        let new = match css_wide(raw.trim()) {
            Some(keyword) => match css_wide_value(keyword, p) {
                Some(initial) => Some(Cow::Borrowed(initial)),
                None if knows_inherit(p) => Some("inherit".into()),
                None => None,
            },
            None => match self.values.rewrite(p, raw, false) {
                // A radius of `auto` in an attribute means zero.
                Some(v) if v == "auto" && matches!(p.name, "rx" | "ry") => Some("0".into()),
                // usvg handles invalid geometry as browsers do.
                None if is_geometry => return,
                None => {
                    self.note_color(p, raw);
                    None
                }
                new => new,
            },
        };
        if new.is_some() {
            self.record(p, raw.into());
        }
        let is_length =
            is_geometry || matches!(p.kind, Kind::Length(_) | Kind::Dashes | Kind::FontSize | Kind::Spacing);
        let new = new.map(|v| if is_length { self.in_range(&v).into_owned() } else { v.into_owned() });
        if new.as_deref().is_none_or(|v| v != raw.trim()) {
            self.out.attributes.push((p.name, new));
        }
    }

    /// Applies the rules specific to texts, dashes, markers and `use` elements.
    fn finish(mut self, node: Node<'a, '_>, inherited: &mut Inherited) -> Computed<'a> {
        let (tag, mut out, mut written) = (self.tag, self.out, self.written);
        let mut style = std::mem::take(&mut self.style);
        if tag == "use" {
            out.attributes.extend(size_of_use(node, &self.values.units));
        }
        let markers = MARKERS.iter().filter_map(|name| winner(&style, &out, node, name));
        let has_marker: Vec<bool> = markers.filter(|v| *v != "inherit").map(|v| v != "none").collect();
        inherited.has_markers = has_marker.contains(&true) || (inherited.has_markers && has_marker.len() < 3);
        if inherited.has_markers && matches!(tag, "rect" | "circle" | "ellipse") {
            // usvg would draw markers on these as on paths.
            out.attributes.retain(|a| !MARKERS.contains(&a.0));
            style.retain(|s| !MARKERS.contains(&s.0.as_ref()));
            style.extend(MARKERS.map(|name| (name.into(), "none".into())));
        }
        if matches!(tag, "tspan" | "textPath") {
            // The writing mode applies to whole texts.
            style.retain(|s| s.0 != "writing-mode");
            out.attributes.retain(|a| a.0 != "writing-mode");
            out.attributes.extend(node.has_attribute("writing-mode").then_some(("writing-mode", None)));
            let applies =
                |name: &&str| winner(&style, &out, node, name).is_some_and(|v| !matches!(v, "none" | "inherit"));
            let effect = ["clip-path", "mask", "filter"].into_iter().find(applies);
            out.unsupported
                .extend(effect.map(|name| format!("only without its {name}, which parts of texts cannot have")));
            if tag == "textPath" && self.values.ids.target(node).is_some_and(|n| n.tag_name().name() != "path") {
                out.attributes.push(("href", None));
            }
        }
        if tag == "use"
            && let Some(symbol) = self.values.ids.target(node).filter(|n| n.tag_name().name() == "symbol")
        {
            let new = shown_symbol(node, symbol, &out, &self.values.units);
            out.attributes.retain(|a| new.iter().all(|n| n.0 != a.0));
            out.attributes.extend(new.into_iter().map(|(name, v)| (name, Some(v))));
        }
        let declared = |name: &str| winner(&style, &out, node, name).map(ToOwned::to_owned);
        inherited.track(|name| {
            let is_declared = self.decided.contains(name) || node.attributes().any(|a| a.name() == name);
            is_declared.then(|| declared(name))?
        });
        let is_linear = inherited.tracked("color-interpolation") == Some("linearRGB");
        let stop = (is_linear && tag == "stop").then(|| self.values.stop(&declared));
        let replaced = self.values.replaced_paints(node, inherited, &out, &declared);
        style.extend(replaced);
        (out.is_linear, out.stop) = (is_linear && matches!(tag, "linearGradient" | "radialGradient"), stop);
        if inherited.text.concerns(tag)
            || style.iter().any(|s| text::concerns(&s.0))
            || node.attributes().any(|a| text::concerns(a.name()))
        {
            let (changes, letters) = inherited.text.declare(node, |name| {
                let attribute = || out.value(node, name).filter(|_| attribute_property(name).is_some());
                last_value(&style, name).or_else(attribute)
            });
            out.letters = letters;
            out.notes.extend(changes.notes);
            let attributes = changes.attributes.into_iter().filter(|(name, v)| attribute(node, name) != Some(v));
            out.attributes.extend(attributes.map(|(name, v)| (name, Some(v))));
            out.unsupported.extend(changes.unsupported.iter().map(|d| ignored(d)));
            written.extend(changes.style.iter().map(|(n, v)| (n.clone().into(), Some(v.clone().into()))));
            style.extend(changes.style.into_iter().map(|(n, v)| (n.into(), v.into())));
        }
        out.words = inherited.record_words(written);
        if let Some(dashes) = scaled_dashes(node, &out, inherited) {
            style.retain(|s| !DASHES.contains(&s.0.as_ref()));
            style.extend(DASHES.iter().zip(dashes).map(|(name, value)| (Cow::Borrowed(*name), value.into())));
        }
        out.unsupported.extend(node.attribute("clip-path").and_then(|clip| unsupported("clip-path", clip)));
        out.style = (!is_written(node, &style)).then_some(style);
        out
    }
}

/// The last value of a property in a list of declarations.
fn last_value<'s>(style: &'s [Pair<'_>], name: &str) -> Option<&'s str> {
    style.iter().rev().find(|s| s.0 == name).map(|s| s.1.as_ref())
}

/// The value of a property in a list of declarations, or else of its attribute.
fn winner<'s, 'a>(
    style: &'s [Pair<'a>],
    computed: &'s Computed<'a>,
    node: Node<'a, '_>,
    name: &str,
) -> Option<&'s str> {
    last_value(style, name).or_else(|| computed.value(node, name))
}

/// Returns `true` if the style attribute holds exactly these declarations.
fn is_written(node: Node<'_, '_>, style: &[Pair<'_>]) -> bool {
    let old = simple(node.attribute("style").unwrap_or_default());
    old.is_some_and(|old| old.len() == style.len() && old.iter().zip(style).all(|(o, s)| o.0 == s.0 && o.1 == s.1))
}

/// Converts the size of a `use` to px; usvg would apply percentages twice when it shows a symbol.
fn size_of_use(node: Node<'_, '_>, units: &Units) -> impl Iterator<Item = (&'static str, Option<String>)> {
    ["width", "height"].into_iter().filter_map(move |name| {
        let share = node.attribute(name).filter(|v| v.trim().ends_with('%'))?;
        Some((name, Some(units.length(name, share)?.to_string())))
    })
}

/// Moves the position, size and transform of a symbol, which usvg ignores, to the `use` that shows it (SVG 2, section 5.5).
fn shown_symbol(
    node: Node<'_, '_>,
    symbol: Node<'_, '_>,
    style: &Computed<'_>,
    units: &Units,
) -> Vec<(&'static str, String)> {
    let of_symbol = |name: &str| units.length(name, symbol.attribute(name)?);
    let mut out = Vec::new();
    for name in ["width", "height"] {
        let has_size = style.value(node, name).is_some_and(|v| v.trim() != "auto");
        out.extend(of_symbol(name).filter(|_| !has_size).map(|px| (name, px.to_string())));
    }
    let matrix = |n: Node<'_, '_>| {
        let t: svgtypes::Transform = n.attribute("transform")?.parse().ok()?;
        Some(Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]))
    };
    let transform = matrix(symbol);
    let corner = ["x", "y"].map(|name| of_symbol(name).unwrap_or(0.0));
    if transform.is_some() || corner != [0.0; 2] {
        let of_use = |name: &str| units.length(name, style.value(node, name)?);
        let [x, y] = ["x", "y"].map(|name| of_use(name).unwrap_or(0.0));
        let all = matrix(node).unwrap_or_default() * Affine::translate((x, y)) * transform.unwrap_or_default();
        out.push(("transform", pathwarp::engine::decimal::matrix(all)));
        out.extend(["x", "y"].into_iter().zip(corner).map(|(name, v)| (name, v.to_string())));
    }
    out
}

/// Returns `true` if usvg understands `inherit` as a value of a property.
fn knows_inherit(p: &Property) -> bool {
    #[rustfmt::skip]
    const UNKNOWN: [&str; 7] = [
        "paint-order", "mix-blend-mode", "isolation", "mask-type", "vector-effect", "white-space", "lighting-color",
    ];
    #[rustfmt::skip]
    const KNOWN_OF_TEXT: [&str; 7] = [
        "font-weight", "font-stretch", "direction", "letter-spacing", "text-anchor", "text-decoration", "font-variant",
    ];
    !matches!(p.kind, Kind::Geometry(_) | Kind::Transform | Kind::Path)
        && !UNKNOWN.contains(&p.name)
        && !p.name.starts_with("font-variant-")
        && (!text::concerns(p.name) || KNOWN_OF_TEXT.contains(&p.name))
}

/// Converts dashes from the unit that `pathLength` sets to user units.
fn scaled_dashes(node: Node<'_, '_>, style: &Computed<'_>, inherited: &Inherited) -> Option<[String; 2]> {
    let whole: f64 = node.attribute("pathLength")?.trim().parse().ok().filter(|l| *l > 0.0)?;
    let [array, offset] = DASHES.map(|name| inherited.tracked(name));
    let units = &inherited.units;
    let unit = shape_length(node.tag_name().name(), |name| style.value(node, name), units)? / whole;
    let scaled = |v: &str| Some((units.length(DASHES[0], v)? * unit).to_string());
    let array = array?.split([',', ' ']).filter(|v| !v.is_empty()).map(scaled).collect::<Option<Vec<_>>>()?;
    let offset = offset.map_or_else(|| Some("0".to_owned()), scaled)?;
    (!array.is_empty()).then(|| [array.join(","), offset])
}

impl<'a> Computed<'a> {
    /// All values, in no order.
    pub(super) fn values(&self) -> impl Iterator<Item = &str> {
        let declared =
            self.style.iter().flatten().map(|d| d.1.as_ref()).chain(self.transform.iter().map(|d| d.value.as_ref()));
        declared.chain(self.attributes.iter().filter_map(|a| a.1.as_deref()))
    }

    /// The value that an attribute will have.
    pub(super) fn value<'s>(&'s self, node: Node<'a, '_>, name: &str) -> Option<&'s str> {
        match self.attributes.iter().find(|a| a.0 == name) {
            Some(new) => new.1.as_deref(),
            None => node.attribute(name),
        }
    }
}

/// Describes a declaration that the result ignores.
fn unsupported(name: &str, value: &str) -> Option<String> {
    if !matches!(name, "clip-path" | "mask" | "text-transform" | "mask-image" | "offset-path") {
        return None;
    }
    let lower = value.to_ascii_lowercase();
    if matches!(lower.as_str(), "none" | "inherit" | "initial" | "unset" | "revert" | "auto") {
        return None;
    }
    let is_ignored = match name {
        "clip-path" | "mask" => !lower.contains("url("),
        "text-transform" => !matches!(lower.as_str(), "uppercase" | "lowercase" | "capitalize"),
        _ => true,
    };
    is_ignored.then(|| ignored(&format!("{name}: {}", text::excerpt(value))))
}

fn ignored(declaration: &str) -> String {
    format!("only without “{declaration}”, which is not supported")
}
