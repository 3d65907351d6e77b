//! Dialog elements for parameters and options.

use super::labels::{escaped, label, labelled};
use crate::inkscape::names::{FILE, NONE, PERCENT, UNIT, UNITS};
use crate::options::{CommonOption, OptionValue};
use pathwarp::param::{Kind, Param};
use std::fmt::Write as _;

/// Limits of numbers that have none: Inkscape's own default is 0 to 10.
const FAR: f64 = 1e6;

/// The range of a parameter's slider that its declaration leaves open.
const NO_SLIDER: (f64, f64) = (0.0, 1.0);

/// One `<param>`.
pub(super) struct Widget<'a> {
    pub(super) name: &'a str,
    pub(super) kind: &'a str,
    /// More attributes, each with a space before it.
    pub(super) more: String,
    pub(super) label: &'a str,
    pub(super) help: &'a str,
    pub(super) content: String,
}

impl Widget<'_> {
    pub(super) fn write(&self, out: &mut String) {
        let Self { name, kind, more, content, .. } = self;
        let (label, help) = (escaped(self.label), escaped(&labelled(self.help)));
        let _ = writeln!(
            out,
            "      <param name=\"{name}\" type=\"{kind}\"{more} gui-text=\"{label}\" gui-description=\"{help}\">{content}</param>"
        );
    }
}

/// A choice: pairs of value and label.
pub(super) fn choice<'a>(
    name: &str,
    title: &str,
    help: &str,
    options: impl Iterator<Item = (&'a str, String)>,
    default: &str,
) -> String {
    let mut content = String::from("\n");
    for (value, label) in options {
        let is_default = if value == default { " default=\"true\"" } else { "" };
        let _ =
            writeln!(content, "        <option value=\"{}\"{is_default}>{}</option>", escaped(value), escaped(&label));
    }
    content += "      ";
    let mut out = String::new();
    Widget { name, kind: "optiongroup", more: " appearance=\"combo\"".into(), label: title, help, content }
        .write(&mut out);
    out
}

/// The elements for a parameter of a deformation; none for files that it saves, which a preview would write again and again.
pub(super) fn of_param(p: &Param) -> String {
    let mut out = String::new();
    let default = p.default.unwrap_or_default();
    let title = label(p.name);
    let own = title.as_str();
    let widget = |name, kind, more, label, content| Widget { name, kind, more, label, help: p.help, content };
    let number = default.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '%');
    match p.kind {
        Kind::Save => {}
        Kind::Flag => widget(p.name, "bool", String::new(), own, "false".into()).write(&mut out),
        Kind::Number if default.ends_with('%') => {
            let name = format!("{}{PERCENT}", p.name);
            let more = float(p.ui, p.range, 100.0, 1);
            widget(&name, "float", more, &format!("{title} (%)"), number.into()).write(&mut out);
        }
        Kind::Number if p.default.is_some() => {
            widget(p.name, "float", float(p.ui, p.range, 1.0, 3), own, number.into()).write(&mut out);
        }
        Kind::Angle if p.default.is_some() => {
            widget(p.name, "float", float(p.ui, p.range, 1.0, 1), &format!("{title} (°)"), number.into())
                .write(&mut out);
        }
        Kind::Length(_) if p.default.is_some() => length(p, own, number, &mut out),
        Kind::Count if p.default.is_some() => {
            let (least, most) = (p.range.0.max(-1e4), p.range.1.min(1e4));
            widget(p.name, "int", format!(" min=\"{least}\" max=\"{most}\""), own, number.into()).write(&mut out);
        }
        Kind::Choice(words) | Kind::NameOrFile(words) => {
            let none = p.default.is_none() && !p.needed;
            let first = none.then(|| (NONE, "–".to_owned()));
            let all = first.into_iter().chain(words.iter().map(|w| (*w, (*w).to_owned())));
            out += &choice(p.name, own, p.help, all, if none { NONE } else { default });
            if matches!(p.kind, Kind::NameOrFile(_)) {
                let name = format!("{}{FILE}", p.name);
                widget(&name, "path", file("toml,json"), &format!("{title}: a file instead"), String::new())
                    .write(&mut out);
            }
        }
        Kind::File => widget(p.name, "path", file("json,toml,psd,svg"), own, String::new()).write(&mut out),
        Kind::Path => {
            widget(p.name, "string", String::new(), &format!("{title} (id or label)"), escaped(default))
                .write(&mut out);
        }
        _ if p.repeat => {
            let title = format!("{title}: {}, one per line", p.value_name());
            widget(p.name, "string", " appearance=\"multiline\"".into(), &title, escaped(default)).write(&mut out);
        }
        _ => {
            let title = if p.default.is_some() { title.clone() } else { format!("{title} ({})", p.value_name()) };
            widget(p.name, "string", String::new(), &title, escaped(default)).write(&mut out);
        }
    }
    out
}

/// A number with its unit beside it.
fn length(p: &Param, title: &str, number: &str, out: &mut String) {
    let least = if p.range.0 >= 0.0 { 0.0 } else { -FAR };
    let more = format!(" precision=\"3\" min=\"{least}\" max=\"{FAR}\"");
    let unit = p.default.unwrap_or_default()[number.len()..].trim();
    let unit = UNITS.iter().find(|(_, u, _)| *u == unit).map_or("user", |(name, ..)| name);
    out.push_str("      <hbox>\n");
    Widget { name: p.name, kind: "float", more, label: title, help: p.help, content: number.into() }.write(out);
    let units = UNITS.iter().map(|(name, _, label)| (*name, (*label).to_owned()));
    out.push_str(&choice(&format!("{}{UNIT}", p.name), " ", "The unit.", units, unit));
    out.push_str("      </hbox>\n");
}

/// Attributes of a float: with a slider where the declaration has one.
fn float(ui: (f64, f64), range: (f64, f64), times: f64, precision: u8) -> String {
    let (least, most) = if ui == NO_SLIDER && range != NO_SLIDER { range } else { ui };
    let (least, most) = ((least * times).max(-FAR), (most * times).min(FAR));
    let slider = if most - least < FAR { " appearance=\"full\"" } else { "" };
    format!(" precision=\"{precision}\" min=\"{least}\" max=\"{most}\"{slider}")
}

fn file(types: &str) -> String {
    format!(" mode=\"file\" filetypes=\"{types}\"")
}

/// The element for a common option; `default` is the word that is chosen at first.
pub(super) fn of_option(o: &CommonOption, default: &str) -> String {
    let title = label(o.name);
    match &o.value {
        OptionValue::Choice(_) => {
            let words = o.words().into_iter().map(|w| (w, w.to_owned()));
            choice(o.name, &title, o.help, words, default)
        }
        _ => {
            let mut out = String::new();
            Widget {
                name: o.name,
                kind: "string",
                more: String::new(),
                label: &title,
                help: &o.help(),
                content: String::new(),
            }
            .write(&mut out);
            out
        }
    }
}
