//! The descriptions besides the deformations: bend by hand, edit, release, GIMP paths, DXF.

use super::deformation::effect;
use super::labels::escaped;
use super::program::Program;
use super::widgets::{Widget, of_option};
use crate::inkscape::names::{ACTION, CHANGES, DISCARD, SHOW, WARNINGS};
use crate::options::OPTIONS;

/// File name and content of each.
pub(super) fn all(program: &Program) -> [(String, String); 5] {
    [
        ("pathwarp-bend-by-hand.inx".into(), by_hand(program)),
        ("pathwarp-edit-again.inx".into(), edit(program)),
        ("pathwarp-release.inx".into(), release(program)),
        ("pathwarp-xcf-input.inx".into(), xcf(program)),
        ("pathwarp-dxf-output.inx".into(), dxf(program)),
    ]
}

fn action(value: &str) -> String {
    format!("  <param name=\"{ACTION}\" type=\"string\" gui-hidden=\"true\">{value}</param>\n")
}

fn by_hand(program: &Program) -> String {
    let tip = "Drag points in the browser, and see the selected objects follow";
    effect("Bend by hand…", "bend-by-hand", tip, &action("hand"), None, false, program)
}

fn edit(program: &Program) -> String {
    let mut body = action("edit");
    let text = "Warps the sources of the selected objects again, with the settings that they were warped with and the changes below. \
                Guides are taken as they are now.";
    body += &format!("  <label>{text}</label>\n");
    let widget = |name, kind, more: &str, label, help, content: &str| {
        let mut out = String::new();
        Widget { name, kind, more: more.into(), label, help, content: content.into() }.write(&mut out);
        out
    };
    body += &widget(
        CHANGES,
        "string",
        " appearance=\"multiline\"",
        "Changes, such as bend=30%",
        "One setting per line, name=value; name= alone gives a setting its default. Nothing here: the same settings.",
        "",
    );
    body += &widget(SHOW, "bool", "", "Only show the settings", "Shows the settings in a window.", "false");
    body +=
        &widget(DISCARD, "bool", "", "Give up changes by hand", "Also if nodes were moved since the warp.", "false");
    body += &warnings();
    effect("Edit warp again", "edit-again", "Warp the sources of warped objects again", &body, None, true, program)
}

fn warnings() -> String {
    let mut out = String::new();
    let help = "Say in a window what was left out or unchanged.";
    Widget { name: WARNINGS, kind: "bool", more: String::new(), label: "Show warnings", help, content: "false".into() }
        .write(&mut out);
    out
}

fn release(program: &Program) -> String {
    let tip = "Give warped objects their sources back";
    effect("Release", "release", tip, &action("release"), None, false, program)
}

fn xcf(program: &Program) -> String {
    let body = action("to-svg");
    let kind = "<input>\n    <extension>.xcf</extension>\n    <mimetype>image/x-xcf</mimetype>\n    <filetypename>Paths of a GIMP \
                image (*.xcf)</filetypename>\n    <filetypetooltip>The paths, exactly as GIMP stores them</filetypetooltip>\n  </input>";
    file_type("Paths of a GIMP image", "xcf", &body, kind, program)
}

fn dxf(program: &Program) -> String {
    let mut body = action("to-dxf");
    OPTIONS
        .iter()
        .filter(|o| ["dxf-curves", "tolerance"].contains(&o.name))
        .for_each(|o| body += &of_option(o, o.default.unwrap_or_default()));
    body += &warnings();
    let kind = "<output>\n    <extension>.dxf</extension>\n    <mimetype>image/vnd.dxf</mimetype>\n    <filetypename>Outlines in mm \
                with true arcs, pathwarp (*.dxf)</filetypename>\n    <filetypetooltip>Circles and arcs stay circles and arcs, curves \
                are exact splines</filetypetooltip>\n    <dataloss>true</dataloss>\n  </output>";
    file_type("DXF with true arcs", "dxf", &body, kind, program)
}

/// A type of files to open or save.
fn file_type(name: &str, id: &str, body: &str, kind: &str, program: &Program) -> String {
    let Program { location, name: file } = program;
    let file = escaped(file);
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inkscape-extension \
         xmlns=\"http://www.inkscape.org/namespace/inkscape/extension\">\n  <name>{name}</name>\n  <id>org.pathwarp.{id}</id>\n  \
         <dependency type=\"executable\" location=\"{location}\">{file}</dependency>\n{body}  {kind}\n  <script><command \
         location=\"{location}\">{file}</command></script>\n</inkscape-extension>\n"
    )
}
