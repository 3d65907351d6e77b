//! Computes the style of one element: declarations that usvg reads, attributes, and the declarations of the transform.

use super::color;
use super::shapes::shape_length;
use super::sheet::Declaration;
use super::text::{self, Letters, TextStyle};
use super::transform;
use super::value::{self, Custom, Units};
use std::collections::HashSet;
use std::rc::Rc;

/// Lengths of SVG 2's geometry properties and of attributes that hold lengths.
const GEOMETRY: [&str; 9] = ["x", "y", "width", "height", "cx", "cy", "r", "rx", "ry"];
const LENGTHS: [&str; 4] = ["x1", "y1", "x2", "y2"];

/// Attributes that stand for properties and whose values may need computing.
const PRESENTATION: [&str; 19] = [
    "fill",
    "fill-opacity",
    "stroke",
    "stroke-width",
    "stroke-dasharray",
    "stroke-dashoffset",
    "stroke-opacity",
    "opacity",
    "color",
    "stop-color",
    "stop-opacity",
    "flood-color",
    "flood-opacity",
    "lighting-color",
    "font-size",
    "letter-spacing",
    "word-spacing",
    "stroke-miterlimit",
    "display",
];

/// Properties whose value is a colour or a paint.
const PAINTS: [&str; 6] = ["fill", "stroke", "color", "stop-color", "flood-color", "lighting-color"];

/// Place of the size among the longhands of `font`.
const FONT_SIZE: usize = 4;

const DASHES: [&str; 2] = ["stroke-dasharray", "stroke-dashoffset"];

/// What an element hands on to its children.
#[derive(Debug, Clone)]
pub(super) struct Inherited {
    pub(super) custom: Rc<Custom>,
    pub(super) units: Units,
    /// Values of [`DASHES`].
    pub(super) dashes: [Option<Rc<str>>; 2],
    pub(super) text: TextStyle,
}

/// The style of an element.
#[derive(Debug, Default)]
pub(super) struct Computed {
    /// Declarations that usvg reads.
    pub(super) style: Vec<(String, String)>,
    /// New values of attributes.
    pub(super) attributes: Vec<(&'static str, String)>,
    /// Declarations of the transform.
    pub(super) transform: Vec<Declaration>,
    /// What is not supported, in words.
    pub(super) unsupported: Vec<String>,
    pub(super) letters: Letters,
}

/// The geometry properties of an element, as far as Chromium goes: nested viewports take none from style sheets, and a `use` no
/// size.
fn geometry(tag: &str) -> &'static [&'static str] {
    match tag {
        "rect" => &["x", "y", "width", "height", "rx", "ry"],
        "circle" => &["cx", "cy", "r"],
        "ellipse" => &["cx", "cy", "rx", "ry"],
        "image" => &["x", "y", "width", "height"],
        "use" => &["x", "y"],
        _ => &[],
    }
}

/// What 100 % of a property is. `font` is the font size of the parent.
fn whole(name: &str, units: &Units, font: f64) -> Option<f64> {
    let (w, h) = units.viewport;
    Some(match name {
        "x" | "width" | "cx" | "rx" | "x1" | "x2" => w,
        "y" | "height" | "cy" | "ry" | "y1" | "y2" => h,
        "r" | "stroke-width" | "stroke-dasharray" | "stroke-dashoffset" => w.hypot(h) / std::f64::consts::SQRT_2,
        "font-size" => font,
        _ => return None,
    })
}

/// Computes the style of an element from the declarations that apply, weakest first. `attr` gives its attributes. `inherited` is
/// what its parent hands on, and becomes what the element itself does.
pub(super) fn computed<'a>(
    tag: &str,
    is_root: bool,
    declarations: &[&Declaration],
    attr: impl Fn(&str) -> Option<&'a str>,
    inherited: &mut Inherited,
) -> Computed {
    let own = declarations.iter().filter(|d| d.name.starts_with("--")).map(|d| (d.name.clone(), d.value.clone()));
    let own: Vec<(String, String)> = own.collect();
    if !own.is_empty() {
        inherited.custom = Rc::new(value::custom(&own, &inherited.custom));
    }
    let font = inherited.units.font;
    let mut values = Values { custom: Rc::clone(&inherited.custom), units: inherited.units, font };
    // The font size first: other lengths refer to it.
    let size = declarations.iter().rev().find_map(|d| match d.name.as_str() {
        "font-size" => values.of("font-size", &d.value),
        "font" => values.of("font-size", &text::font(&values.of("font", &d.value)?)?[FONT_SIZE].1),
        _ => None,
    });
    let size = size.or_else(|| values.of("font-size", attr("font-size")?));
    if let Some(px) = size.and_then(|s| value::length(&s, &inherited.units, font)) {
        inherited.units.font = px;
    }
    if is_root {
        inherited.units.root_font = inherited.units.font;
    }
    values.units = inherited.units;
    let mut out = Computed::default();
    out.declare(tag, if is_root { &[] } else { geometry(tag) }, declarations, &values);
    let lengths = GEOMETRY.iter().chain(&LENGTHS).chain(&PRESENTATION).copied();
    for name in lengths {
        let raw = attr(name).filter(|_| out.new_value(name).is_none());
        let new = raw.and_then(|raw| values.of(name, raw)).filter(|new| raw != Some(new));
        out.attributes.extend(new.map(|v| (name, v)));
    }
    // usvg takes percentages of a `use` twice where it shows a symbol.
    for name in ["width", "height"].into_iter().filter(|_| tag == "use") {
        let share = attr(name).filter(|v| v.trim().ends_with('%'));
        let px = share.zip(whole(name, &values.units, font)).and_then(|(v, all)| value::length(v, &values.units, all));
        out.attributes.extend(px.map(|px| (name, px.to_string())));
    }
    let value = |name: &str| out.styled(name).or_else(|| out.new_value(name)).or_else(|| attr(name));
    for (name, dashes) in DASHES.iter().zip(&mut inherited.dashes) {
        if let Some(v) = value(name).filter(|v| v.trim() != "inherit") {
            *dashes = Some(v.into());
        }
    }
    let (changes, letters) = inherited.text.declare(tag, value);
    out.letters = letters;
    out.style.extend(changes.style);
    out.attributes.extend(changes.attributes.into_iter().filter(|(name, v)| attr(name) != Some(v)));
    out.unsupported.extend(changes.unsupported.iter().map(|d| ignored(d)));
    if let Some(dashes) = scaled_dashes(tag, &attr, &out, inherited) {
        out.style.retain(|s| !DASHES.contains(&s.0.as_str()));
        out.style.extend(DASHES.iter().zip(dashes).map(|(name, value)| ((*name).to_owned(), value)));
    }
    out.unsupported.extend(attr("clip-path").and_then(|clip| unsupported(tag, "clip-path", clip)));
    out
}

/// Dashes in user units, where `pathLength` gives their unit.
fn scaled_dashes<'a>(
    tag: &str,
    attr: impl Fn(&str) -> Option<&'a str>,
    style: &Computed,
    inherited: &Inherited,
) -> Option<[String; 2]> {
    let whole: f64 = attr("pathLength")?.trim().parse().ok().filter(|l| *l > 0.0)?;
    let [Some(array), offset] = &inherited.dashes else { return None };
    let units = &inherited.units;
    let unit = shape_length(tag, |name| style.new_value(name).or_else(|| attr(name)), units)? / whole;
    let diagonal = units.viewport.0.hypot(units.viewport.1) / std::f64::consts::SQRT_2;
    let scaled = |v: &str| Some((value::length(v, units, diagonal)? * unit).to_string());
    let array = array.split([',', ' ']).filter(|v| !v.is_empty()).map(scaled).collect::<Option<Vec<_>>>()?;
    let offset = offset.as_deref().map_or_else(|| Some("0".to_owned()), scaled)?;
    (!array.is_empty()).then(|| [array.join(","), offset])
}

/// Computes single values.
struct Values {
    custom: Rc<Custom>,
    units: Units,
    /// Font size of the parent.
    font: f64,
}

impl Values {
    /// A value without variables and expressions. `None` if it is invalid.
    fn of(&self, name: &str, raw: &str) -> Option<String> {
        let is_paint = PAINTS.contains(&name);
        if let Some(px) = Some(name).filter(|n| *n == "font-size").and_then(|_| text::size(raw, self.font)) {
            return Some(format!("{px}px"));
        }
        let is_spacing = matches!(name, "letter-spacing" | "word-spacing") && raw.contains('%');
        if value::is_plain(raw) && !is_spacing {
            return if is_paint { color::paint(raw) } else { Some(raw.to_owned()) };
        }
        // Font sizes refer to that of the parent.
        let units = if name == "font-size" { Units { font: self.font, ..self.units } } else { self.units };
        let text = value::substituted(raw, &|n| self.custom.get(n).map(ToString::to_string))?;
        let computed = value::computed(&text, &units, whole(name, &units, self.font))?;
        match is_paint {
            true => color::paint(&computed),
            false if is_spacing => value::length(&computed, &units, units.font).map(|px| px.to_string()),
            false => Some(computed),
        }
    }
}

impl Computed {
    /// All values.
    pub(super) fn values(&self) -> impl Iterator<Item = &str> {
        let declared = self.style.iter().map(|d| &d.1).chain(self.transform.iter().map(|d| &d.value));
        declared.chain(self.attributes.iter().map(|a| &a.1)).map(String::as_str)
    }

    /// The value that style declares for a property.
    fn styled(&self, name: &str) -> Option<&str> {
        self.style.iter().rev().find(|s| s.0 == name).map(|s| s.1.as_str())
    }

    /// The new value of an attribute, if it has one.
    pub(super) fn new_value(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|a| a.0 == name).map(|a| a.1.as_str())
    }

    /// Adds declarations, weakest first. Of several for a property, the last valid one counts.
    fn declare(
        &mut self,
        tag: &str,
        geometry: &'static [&'static str],
        declarations: &[&Declaration],
        values: &Values,
    ) {
        let mut seen = HashSet::new();
        for d in declarations.iter().rev().filter(|d| !d.name.starts_with("--")) {
            let name = d.name.as_str();
            if seen.contains(name) {
                continue;
            }
            let Some(value) = values.of(name, &d.value) else { continue };
            let known = geometry.iter().find(|g| **g == name);
            let is_length = || value::length(&value, &values.units, 1.0).is_some();
            if known.is_some() && !is_length() {
                continue;
            }
            if name == "font" {
                let longhands = text::font(&value).into_iter().flatten().filter(|l| seen.insert(l.0));
                self.style.extend(longhands.filter_map(|(name, v)| Some((name.to_owned(), values.of(name, &v)?))));
                continue;
            }
            seen.insert(name);
            if transform::PROPERTIES.contains(&name) {
                self.transform.push(Declaration { value, ..(*d).clone() });
            } else if let Some(known) = known {
                self.attributes.push((known, value));
            } else if !GEOMETRY.contains(&name) {
                self.unsupported.extend(unsupported(tag, name, &value));
                self.style.push((d.name.clone(), value));
            }
        }
        self.style.reverse();
    }
}

/// What has no effect in the result, in words.
fn unsupported(tag: &str, name: &str, value: &str) -> Option<String> {
    let lower = value.to_ascii_lowercase();
    let is_unset = matches!(lower.as_str(), "none" | "inherit" | "initial" | "unset" | "revert" | "auto");
    if is_unset {
        return None;
    }
    let cut = matches!(name, "clip-path" | "mask") && !lower.contains("url(");
    let letters = name == "text-transform" && !matches!(lower.as_str(), "uppercase" | "lowercase" | "capitalize");
    if name == "d" && tag == "path" {
        return Some("its outline is that of the property “d” of CSS, which overrides the result".to_owned());
    }
    (cut || letters || matches!(name, "mask-image" | "offset-path"))
        .then(|| ignored(&format!("{name}: {}", text::start(value))))
}

fn ignored(declaration: &str) -> String {
    format!("only without “{declaration}”, which is not supported")
}
