//! Generates Inkscape's descriptions of extensions (`.inx`) from the registry and the table of common options.

use crate::inkscape::names::{
    ACTION, ADD, AGAIN, AUTOMATIC, CHANGES, DEFORMATION, DISCARD, FILE, GUIDES, NONE, PERCENT, REPLACE, SHOW, UNIT,
    UNITS, WARNINGS,
};
use pathwarp::deform::{Guides, Info, Registry};
use pathwarp::param::{Kind, Param};
use pathwarp_engine::options::{CommonOption, OPTIONS, OptionValue};
use std::fmt::Write as _;

/// Returns the name and the content of every description.
pub(crate) fn files(registry: &Registry, program: &Program) -> Vec<(String, String)> {
    let effects = registry.entries().iter().map(|e| {
        let info = e.info();
        (format!("pathwarp-{}.inx", info.name), inx(info, program))
    });
    effects.chain(others(program)).collect()
}

/// The command in the descriptions: a file beside them, a program on the search path, or a path.
pub(crate) struct Program {
    /// `inx`, `path` or `absolute`.
    pub(crate) location: &'static str,
    pub(crate) name: String,
}

/// The common options that a dialog shows, in its order. The others do not apply to a part of an open drawing.
const SHOWN: [&str; 12] = [
    "fit",
    "clones",
    "strokes",
    "text",
    "gradients",
    "filters",
    "patterns",
    "images",
    "nodes",
    "on-error",
    "tolerance",
    "frame",
];

/// Defaults that differ from the command line's: in Inkscape, clones follow their originals, and pages stay.
const DEFAULTS: [(&str, &str); 2] = [("clones", "follow"), ("fit", "none")];

/// Returns the description of a deformation.
fn inx(info: &Info, program: &Program) -> String {
    let name = format!("{} – {}", label(info.name), info.title);
    let mut settings = String::new();
    info.params.iter().for_each(|p| settings += &of_param(p));
    if !info.guides.params.is_empty() {
        settings += &guides(info.guides);
    }
    let mut options = String::new();
    for name in SHOWN {
        OPTIONS.iter().filter(|o| o.name == name).for_each(|o| options += &of_option(o, default(o)));
    }
    options += &again();
    let pages = [("settings", "Settings", settings), ("options", "Options", options), ("help", "Help", help(info))];
    let mut body =
        format!("  <param name=\"{DEFORMATION}\" type=\"string\" gui-hidden=\"true\">{}</param>\n", info.name);
    body += "  <param name=\"tab\" type=\"notebook\">\n";
    for (page, title, content) in pages {
        let _ = write!(body, "    <page name=\"{page}\" gui-text=\"{title}\">\n{content}    </page>\n");
    }
    body += "  </param>\n";
    effect(&name, info.name, info.title, &body, Some(info.group), true, program)
}

/// Returns the default of an option in a dialog.
fn default(o: &CommonOption) -> &'static str {
    let other = DEFAULTS.iter().find(|(name, _)| *name == o.name).map(|(_, value)| *value);
    other.or(o.default).unwrap_or_default()
}

/// Describes an extension, whose parameters and kind are in `body`.
fn extension(name: &str, id: &str, body: &str, program: &Program) -> String {
    let Program { location, name: file } = program;
    let (name, file) = (escaped(name), escaped(file));
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inkscape-extension \
         xmlns=\"http://www.inkscape.org/namespace/inkscape/extension\">\n  <name>{name}</name>\n  <id>org.pathwarp.{id}</id>\n  \
         <dependency type=\"executable\" location=\"{location}\">{file}</dependency>\n{body}\n  <script><command \
         location=\"{location}\">{file}</command></script>\n</inkscape-extension>\n"
    )
}

/// Describes an effect in the menu, in the submenu `group` if given.
fn effect(
    name: &str,
    id: &str,
    tip: &str,
    params: &str,
    group: Option<&str>,
    has_preview: bool,
    program: &Program,
) -> String {
    let tip = escaped(tip);
    let submenu = group.map_or_else(String::new, |g| format!("<submenu name=\"{}\"/>", escaped(g)));
    let body = format!(
        "{params}  <effect needs-live-preview=\"{has_preview}\">\n    <object-type>all</object-type>\n    \
         <menu-tip>{tip}</menu-tip>\n    <effects-menu><submenu name=\"pathwarp\">{submenu}</submenu></effects-menu>\n  </effect>"
    );
    extension(name, id, &body, program)
}

/// Returns the choice of the number of selected paths that are guides.
fn guides(guides: Guides) -> String {
    let names: Vec<String> = guides.params.iter().map(|p| format!("“{}”", label(p))).collect();
    let help = format!(
        "Selected paths that are guides: the topmost is {}. By itself: {} of them, or none if a guide is named here or by its label ({}).",
        names.join(", the next "),
        guides.usual,
        guides.params.join(", "),
    );
    let counts: Vec<String> = (0..=guides.params.len()).map(|n| n.to_string()).collect();
    let options = counts.iter().map(|n| (n.as_str(), n.clone()));
    let auto = (AUTOMATIC, "by itself".to_owned());
    choice(GUIDES, "Guides in the selection", &help, std::iter::once(auto).chain(options), AUTOMATIC)
}

/// Returns the options for warped objects and for messages.
fn again() -> String {
    let options = [
        (AUTOMATIC, "change a warp of this kind, warp other results"),
        (REPLACE, "start again from their sources"),
        (ADD, "warp the results"),
    ];
    let help = "Objects that pathwarp has warped remember their sources.";
    let options = options.into_iter().map(|(value, text)| (value, text.to_owned()));
    let mut out = choice(AGAIN, "Objects warped before", help, options, AUTOMATIC);
    let switches = [
        (
            DISCARD,
            "Give up changes by hand",
            "If the nodes of a warped object were moved, start again from its source all the same.",
        ),
        (
            WARNINGS,
            "Show warnings",
            "Say in a window what was left unchanged or may look wrong. Leave this off for the preview.",
        ),
    ];
    switches.into_iter().for_each(|(name, label, help)| out += &switch(name, label, help));
    out
}

fn help(info: &Info) -> String {
    let mut out = String::new();
    for paragraph in info.about.split("\n\n") {
        let _ = writeln!(out, "      <label>{}</label>", escaped(&labelled(paragraph)));
    }
    let _ = writeln!(out, "      <label appearance=\"url\">https://github.com/pathwarp/pathwarp</label>");
    out
}

/// Returns the name and the content of the descriptions of other calls.
fn others(program: &Program) -> impl Iterator<Item = (String, String)> {
    let all = [
        ("bend-by-hand", by_hand(program)),
        ("edit-again", edit_again(program)),
        ("release", release(program)),
        ("xcf-input", xcf(program)),
        ("dxf-output", dxf(program)),
    ];
    all.into_iter().map(|(name, text)| (format!("pathwarp-{name}.inx"), text))
}

fn action(value: &str) -> String {
    format!("  <param name=\"{ACTION}\" type=\"string\" gui-hidden=\"true\">{value}</param>\n")
}

fn by_hand(program: &Program) -> String {
    let tip = "Drag points in the browser, and see the selected objects follow";
    effect("Bend by hand…", "bend-by-hand", tip, &action("hand"), None, false, program)
}

fn edit_again(program: &Program) -> String {
    let mut body = action("edit");
    let text = "Warps the sources of the selected objects again, with the settings that they were warped with and the changes below. \
                Guides are taken as they are now.";
    body += &format!("  <label>{text}</label>\n");
    let (kind, attributes, content) = ("string", MULTILINE.into(), String::new());
    let label = "Changes, such as bend=30%";
    let help =
        "One setting per line, name=value; name= alone gives a setting its default. Nothing here: the same settings.";
    body += &Widget { name: CHANGES, kind, attributes, label, help, content }.xml();
    body += &switch(SHOW, "Only show the settings", "Shows the settings in a window.");
    body += &switch(DISCARD, "Give up changes by hand", "Also if nodes were moved since the warp.");
    body += &warnings();
    effect("Edit warp again", "edit-again", "Warp the sources of warped objects again", &body, None, true, program)
}

fn warnings() -> String {
    switch(WARNINGS, "Show warnings", "Say in a window what was left out or unchanged.")
}

/// Returns a switch, which is off at first.
fn switch(name: &str, label: &str, help: &str) -> String {
    Widget { name, kind: "bool", attributes: String::new(), label, help, content: "false".into() }.xml()
}

fn release(program: &Program) -> String {
    let tip = "Give warped objects their sources back";
    effect("Release", "release", tip, &action("release"), None, false, program)
}

fn xcf(program: &Program) -> String {
    let params = action("to-svg");
    let kind = "<input>\n    <extension>.xcf</extension>\n    <mimetype>image/x-xcf</mimetype>\n    <filetypename>Paths of a GIMP \
                image (*.xcf)</filetypename>\n    <filetypetooltip>The paths, exactly as GIMP stores them</filetypetooltip>\n  </input>";
    extension("Paths of a GIMP image", "xcf", &format!("{params}  {kind}"), program)
}

fn dxf(program: &Program) -> String {
    let mut params = action("to-dxf");
    let options = OPTIONS.iter().filter(|o| ["dxf-curves", "tolerance"].contains(&o.name));
    options.for_each(|o| params += &of_option(o, o.default.unwrap_or_default()));
    params += &warnings();
    let kind = "<output>\n    <extension>.dxf</extension>\n    <mimetype>image/vnd.dxf</mimetype>\n    <filetypename>Outlines in mm \
                with true arcs, pathwarp (*.dxf)</filetypename>\n    <filetypetooltip>Circles and arcs stay circles and arcs, curves \
                are exact splines</filetypetooltip>\n    <dataloss>true</dataloss>\n  </output>";
    extension("DXF with true arcs", "dxf", &format!("{params}  {kind}"), program)
}

/// Limits for unlimited numbers, since Inkscape's default limits are 0 and 10.
const FAR: f64 = 1e6;

/// The range of a slider that a parameter does not declare.
const NO_SLIDER: (f64, f64) = (0.0, 1.0);

/// The attribute of a text field with several lines.
const MULTILINE: &str = " appearance=\"multiline\"";

/// The attributes and content of a `<param>`.
struct Widget<'a> {
    name: &'a str,
    kind: &'a str,
    /// Further attributes, each preceded by a space.
    attributes: String,
    label: &'a str,
    help: &'a str,
    content: String,
}

impl Widget<'_> {
    fn xml(&self) -> String {
        let Self { name, kind, attributes, content, .. } = self;
        let (label, help) = (escaped(self.label), escaped(&labelled(self.help)));
        format!(
            "      <param name=\"{name}\" type=\"{kind}\"{attributes} gui-text=\"{label}\" gui-description=\"{help}\">{content}</param>\n"
        )
    }
}

/// Formats a choice of values with labels. The default comes first, since Inkscape 1.2 selects the first one regardless of marks.
fn choice<'a>(
    name: &str,
    title: &str,
    help: &str,
    options: impl Iterator<Item = (&'a str, String)>,
    default: &str,
) -> String {
    let mut content = String::from("\n");
    let (first, others): (Vec<_>, Vec<_>) = options.partition(|(value, _)| *value == default);
    for (value, label) in first.iter().chain(&others) {
        let _ = writeln!(content, "        <option value=\"{}\">{}</option>", escaped(value), escaped(label));
    }
    content += "      ";
    let attributes = " appearance=\"combo\"".into();
    Widget { name, kind: "optiongroup", attributes, label: title, help, content }.xml()
}

/// Returns the elements for a parameter of a deformation; none for files that it saves, which previews would write repeatedly.
fn of_param(p: &Param) -> String {
    let default = p.default.unwrap_or_default();
    let title = label(p.name);
    let widget = |name: &str, kind, attributes, label: &str, content: &str| {
        Widget { name, kind, attributes, label, help: p.help, content: content.into() }.xml()
    };
    let number = default.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '%');
    match p.kind {
        Kind::Save => String::new(),
        Kind::Flag if p.help.is_empty() => String::new(),
        Kind::Flag => switch(p.name, &title, p.help),
        Kind::Number if default.ends_with('%') => {
            let name = format!("{}{PERCENT}", p.name);
            widget(&name, "float", float(p.ui, p.range, 100.0, 1), &format!("{title} (%)"), number)
        }
        Kind::Number if p.default.is_some() => widget(p.name, "float", float(p.ui, p.range, 1.0, 3), &title, number),
        Kind::Angle if p.default.is_some() => {
            widget(p.name, "float", float(p.ui, p.range, 1.0, 1), &format!("{title} (°)"), number)
        }
        Kind::Length(_) if p.default.is_some() => length(p, &title, number),
        Kind::Count if p.default.is_some() => {
            let (least, most) = (p.range.0.max(-1e4), p.range.1.min(1e4));
            widget(p.name, "int", format!(" min=\"{least}\" max=\"{most}\""), &title, number)
        }
        Kind::Choice(words) | Kind::NameOrFile(words) => {
            let may_be_none = p.default.is_none() && !p.needed;
            let none = may_be_none.then(|| (NONE, "–".to_owned()));
            let all = none.into_iter().chain(words.iter().map(|w| (*w, (*w).to_owned())));
            let choice = choice(p.name, &title, p.help, all, if may_be_none { NONE } else { default });
            if matches!(p.kind, Kind::Choice(_)) {
                return choice;
            }
            let name = format!("{}{FILE}", p.name);
            choice + &widget(&name, "path", file("toml,json"), &format!("{title}: a file instead"), "")
        }
        Kind::File => widget(p.name, "path", file("json,toml,psd,svg"), &title, ""),
        Kind::Path => widget(p.name, "string", String::new(), &format!("{title} (id or label)"), &escaped(default)),
        _ if p.repeat => {
            let title = format!("{title}: {}, one per line", p.value_name());
            widget(p.name, "string", MULTILINE.into(), &title, &escaped(default))
        }
        _ => {
            let title = if p.default.is_some() { title } else { format!("{title} ({})", p.value_name()) };
            widget(p.name, "string", String::new(), &title, &escaped(default))
        }
    }
}

/// Returns the elements for a number and its unit.
fn length(p: &Param, title: &str, number: &str) -> String {
    let least = if p.range.0 >= 0.0 { 0.0 } else { -FAR };
    let attributes = format!(" precision=\"3\" min=\"{least}\" max=\"{FAR}\"");
    let unit = p.default.unwrap_or_default()[number.len()..].trim();
    let unit = UNITS.iter().find(|(_, u, _)| *u == unit).map_or("user", |(name, ..)| name);
    let number = Widget { name: p.name, kind: "float", attributes, label: title, help: p.help, content: number.into() };
    let units = UNITS.iter().map(|(name, _, label)| (*name, (*label).to_owned()));
    let unit = choice(&format!("{}{UNIT}", p.name), " ", "The unit.", units, unit);
    format!("      <hbox>\n{}{unit}      </hbox>\n", number.xml())
}

/// Returns the attributes of a float, with a slider if the parameter declares one.
fn float(ui: (f64, f64), range: (f64, f64), times: f64, precision: u8) -> String {
    let (least, most) = if ui == NO_SLIDER && range != NO_SLIDER { range } else { ui };
    let (least, most) = ((least * times).max(-FAR), (most * times).min(FAR));
    let slider = if most - least < FAR { " appearance=\"full\"" } else { "" };
    format!(" precision=\"{precision}\" min=\"{least}\" max=\"{most}\"{slider}")
}

fn file(types: &str) -> String {
    format!(" mode=\"file\" filetypes=\"{types}\"")
}

/// Returns the element for a common option; `default` is the word selected initially.
fn of_option(o: &CommonOption, default: &str) -> String {
    let title = label(o.name);
    match &o.value {
        OptionValue::Choice(_) => {
            let words = o.words().into_iter().map(|w| (w, w.to_owned()));
            choice(o.name, &title, o.help, words, default)
        }
        _ => {
            let (attributes, content) = (String::new(), String::new());
            Widget { name: o.name, kind: "string", attributes, label: &title, help: &o.help(), content }.xml()
        }
    }
}

/// Escapes text for XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Converts a name in kebab case to a label: `reverse-shaper` to “Reverse shaper”.
fn label(name: &str) -> String {
    let text = name.replace('-', " ");
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}

/// Replaces options in a text by the dialogs' labels: `--reverse-shaper` becomes “Reverse shaper”.
pub(crate) fn labelled(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("--") {
        let end = after.find(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).unwrap_or(after.len());
        let is_option = end > 0 && !before.ends_with(char::is_alphanumeric);
        let (option, behind) = after.split_at(if is_option { end } else { 0 });
        let shown = if is_option { format!("“{}”", label(option)) } else { "--".to_owned() };
        out.extend([before, &shown]);
        rest = behind;
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every description is well-formed, has a unique id, and passes only known parameters.
    #[test]
    fn descriptions_are_sound() {
        let registry = Registry::builtin();
        let program = Program { location: "inx", name: "pathwarp".into() };
        let all = files(&registry, &program);
        assert!(all.len() > registry.entries().len() + 2);
        let mut ids = std::collections::HashSet::new();
        for (name, text) in &all {
            let objects = pathwarp_svg::objects::objects(text, &pathwarp::budget::Limits::default());
            assert!(objects.is_ok(), "{name}: {objects:?}");
            let id = text.split("<id>").nth(1).and_then(|t| t.split("</id>").next()).unwrap();
            assert!(
                ids.insert(id) && id.chars().all(|c| c.is_ascii_alphanumeric() || ".-".contains(c)),
                "{name}: {id}"
            );
            let mut names: Vec<&str> =
                text.split("<param name=\"").skip(1).map(|t| t.split('"').next().unwrap()).collect();
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count, "{name}: a name occurs twice");
        }
        // Inkscape 1.2 selects the first option of a choice.
        let bend = &all.iter().find(|(name, _)| name == "pathwarp-bend.inx").unwrap().1;
        for (choice, first) in [("align", "middle"), ("clones", "follow"), ("fit", "none"), ("offset_unit", "user")] {
            let options = bend.split(&format!("name=\"{choice}\"")).nth(1).unwrap();
            assert!(options.split("<option value=\"").nth(1).unwrap().starts_with(first), "{choice}");
        }
    }

    #[test]
    fn options_read_as_in_the_dialogs() {
        assert_eq!(labelled("use --reverse-shaper, or --by."), "use “Reverse shaper”, or “By”.");
        assert_eq!(labelled("a -- b 1--2 --"), "a -- b 1--2 --");
    }
}
