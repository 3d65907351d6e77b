//! The description of a deformation's dialog: settings, options, help.

use super::labels::{escaped, label, labelled};
use super::program::Program;
use super::widgets::{Widget, choice, of_option, of_param};
use crate::inkscape::names::{ADD, AGAIN, AUTOMATIC, DEFORMATION, DISCARD, GUIDES, REPLACE, WARNINGS};
use crate::options::{CommonOption, OPTIONS};
use pathwarp::deform::{Guides, Info};
use std::fmt::Write as _;

/// The common options that a dialog shows, in its order. The others make no sense for a part of an open drawing.
const SHOWN: [&str; 11] =
    ["fit", "clones", "strokes", "text", "gradients", "patterns", "images", "merge", "on-error", "tolerance", "frame"];

/// Other defaults than the command line has: in Inkscape, clones show what happens to their original, and pages stay.
const DEFAULTS: [(&str, &str); 2] = [("clones", "follow"), ("fit", "none")];

/// Describes the effect.
pub(super) fn inx(info: &Info, program: &Program) -> String {
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

/// The default of an option in a dialog.
fn default(o: &CommonOption) -> &'static str {
    let other = DEFAULTS.iter().find(|(name, _)| *name == o.name).map(|(_, value)| *value);
    other.or(o.default).unwrap_or_default()
}

/// An effect in the menu, in a submenu of ours if `group` names one.
pub(super) fn effect(
    name: &str,
    id: &str,
    tip: &str,
    body: &str,
    group: Option<&str>,
    preview: bool,
    program: &Program,
) -> String {
    let (name, tip) = (escaped(name), escaped(tip));
    let inner = group.map_or_else(String::new, |g| format!("<submenu name=\"{}\"/>", escaped(g)));
    let Program { location, name: file } = program;
    let file = escaped(file);
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inkscape-extension \
         xmlns=\"http://www.inkscape.org/namespace/inkscape/extension\">\n  <name>{name}</name>\n  <id>org.pathwarp.{id}</id>\n  \
         <dependency type=\"executable\" location=\"{location}\">{file}</dependency>\n{body}  <effect \
         needs-live-preview=\"{preview}\">\n    <object-type>all</object-type>\n    <menu-tip>{tip}</menu-tip>\n    \
         <effects-menu><submenu name=\"pathwarp\">{inner}</submenu></effects-menu>\n  </effect>\n  <script><command \
         location=\"{location}\">{file}</command></script>\n</inkscape-extension>\n"
    )
}

/// The choice of how many selected paths are guides.
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

/// Options for objects that are warped already, and for messages.
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
    for (name, label, help) in switches {
        Widget { name, kind: "bool", more: String::new(), label, help, content: "false".into() }.write(&mut out);
    }
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
