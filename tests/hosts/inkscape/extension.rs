//! The extension in an installed Inkscape: its effects run on a virtual screen, on documents as Inkscape saves them.

use super::editor;
use crate::support::{inkscape_drawing, pathwarp};
use pathwarp_svg::objects::{Object, objects};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A drawing with every kind of object that can be selected. The text is in the bundled font, whatever is installed.
const BODY: &str = "<g id='layer' inkscape:groupmode='layer' inkscape:label='Layer 1'>\
    <path id='a' style='fill:#c03030' d='M 20,20 H 60 V 60 H 20 Z'/><path id='b' style='fill:#30c030' d='M 80,20 H 120 V 60 Z'/>\
    <path id='c' style='fill:#3030c0' d='M 140,20 H 180 V 60 Z'/>\
    <g id='g' transform='translate(10,0)'><rect id='r' x='20' y='80' width='40' height='30'/><circle id='e' cx='90' cy='95' r='12'/></g>\
    <use id='u' xlink:href='#a' transform='translate(110,70)'/>\
    <text id='t' x='20' y='160' style='font-size:30px;font-family:Noto Sans'>Warp</text></g>\
    <g id='upper' inkscape:groupmode='layer' inkscape:label='Layer 2'><path id='h' d='M 120,150 h 40 v 30 z'/></g>";

/// The selections, one after another.
const SELECTED: [&[&str]; 6] = [&["a"], &["b", "c"], &["g"], &["u"], &["t"], &["upper"]];

/// Numbers of all path data in a drawing, by the id around them.
pub fn numbers(svg: &str, id: &str) -> Vec<f64> {
    let doc = pathwarp_svg::Document::read(svg.as_bytes(), "drawing", &pathwarp_svg::ReadOptions::default()).unwrap();
    let select = vec![format!("[id={id}]")];
    let selection = pathwarp_svg::Selection { select, ..pathwarp_svg::Selection::default() };
    let anchors = doc
        .selected(&selection)
        .flat_map(|s| s.outline.subpaths.iter().flat_map(pathwarp::Subpath::anchors).collect::<Vec<_>>());
    anchors.flat_map(|p| [p.x, p.y]).collect()
}

pub fn assert_near(got: &[f64], wanted: &[f64], what: &str) {
    assert!(
        !wanted.is_empty() && got.len() == wanted.len(),
        "{what}: {} nodes, not {}",
        got.len() / 2,
        wanted.len() / 2
    );
    let far = got.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(far < 1e-3, "{what}: {far}");
}

pub fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()))
}

/// Installs the extension into a profile. `Edit warp again` is also installed with a change filled in, since actions cannot type.
pub fn install(profile: &Path) {
    let folder = profile.join("extensions");
    let done = pathwarp(&["install", "inkscape", "--folder", folder.to_str().unwrap()]);
    assert!(done.status.success());
    let home = folder.join("pathwarp");
    let edit = read(&home.join("pathwarp-edit-again.inx"));
    let (before, after) = edit.split_once("name=\"inkscape-changes\"").unwrap();
    let typed = after.replacen("></param>", ">bend=20%</param>", 1);
    let text =
        format!("{before}name=\"inkscape-changes\"{typed}").replace("org.pathwarp.edit-again", "org.pathwarp.edited");
    fs::write(home.join("edited.inx"), text).unwrap();
}

/// Makes a folder with a profile that has the extension, and a document with this content, which is `source.svg` there.
pub fn workplace(body: &str) -> (TempDir, String) {
    let dir = tempfile::tempdir().unwrap();
    install(&dir.path().join("profile"));
    let source = inkscape_drawing(body);
    fs::write(dir.path().join("source.svg"), &source).unwrap();
    (dir, source)
}

#[test]
fn effects_run_in_inkscape() {
    if !(editor::is_installed() && editor::has_screen()) {
        return;
    }
    let (dir, source) = workplace(BODY);
    let folder = dir.path();
    let at = |name: &str| folder.join(name);

    // Warp one selection after another, and save.
    let mut actions = String::new();
    for ids in SELECTED {
        actions += &format!("select-clear;select-by-id:{};org.pathwarp.warp.noprefs;", ids.join(","));
    }
    actions += &format!("export-filename:{};export-do;", at("warped.svg").display());
    editor::act(folder, &at("source.svg"), &actions);
    let warped = read(&at("warped.svg"));
    let wanted = by_command_line(folder, &source);
    for ids in SELECTED {
        for id in ids {
            assert_near(&numbers(&warped, id), &numbers(&wanted, id), id);
        }
    }
    let limits = pathwarp::budget::Limits::default();
    let remembers = |svg: &str| {
        let all: Vec<Object> = objects(svg, &limits).unwrap();
        all.into_iter().filter(|o| o.recipe.is_some()).map(|o| o.id).collect::<Vec<_>>()
    };
    assert_eq!(remembers(&warped), ["a", "b", "c", "g", "u", "t", "upper"], "after saving");

    // Open the saved file: release, edit, move by hand, edit again; then the whole page.
    let actions = format!(
        "select-by-id:a,g;org.pathwarp.release.noprefs;select-clear;select-by-id:b;org.pathwarp.edited.noprefs;select-clear;\
         select-by-id:c;transform-translate:10,0;org.pathwarp.edited.noprefs;export-filename:{};export-do;select-clear;\
         org.pathwarp.swirl.noprefs;export-filename:{};export-do;",
        at("edited.svg").display(),
        at("page.svg").display()
    );
    editor::act(folder, &at("warped.svg"), &actions);
    let edited = read(&at("edited.svg"));
    assert_eq!(remembers(&edited), ["b", "c", "u", "t", "upper"], "a and g are released");
    for id in ["a", "g"] {
        assert_near(&numbers(&edited, id), &numbers(&source, id), id);
    }
    let out = at("less.svg");
    let line = ["warp", "--bend=20%", "--select=#b", "--select=#c", "-q", "-o", out.to_str().unwrap()];
    run(&at("source.svg"), &line);
    let less = read(&out);
    assert_near(&numbers(&edited, "b"), &numbers(&less, "b"), "b with another bend");
    // Inkscape counts the distance in px; the page has as many units.
    let moved: Vec<f64> = numbers(&less, "c").chunks(2).flat_map(|p| [p[0] + 10.0, p[1]]).collect();
    assert_near(&numbers(&edited, "c"), &moved, "c moved, with another bend");
    // Swirling the page turns everything about its middle; the layers remember.
    let page = read(&at("page.svg"));
    assert_eq!(remembers(&page), ["layer", "upper"]);
    run(&at("edited.svg"), &["swirl", "-q", "-o", out.to_str().unwrap()]);
    assert_near(&numbers(&page, "layer"), &numbers(&read(&out), "layer"), "the page");
}

/// Returns the result of the command line.
fn by_command_line(folder: &Path, source: &str) -> String {
    let (mut from, to): (PathBuf, PathBuf) = (folder.join("step.svg"), folder.join("next.svg"));
    fs::write(&from, source).unwrap();
    for ids in SELECTED {
        let select: Vec<String> = ids.iter().map(|id| format!("--select=#{id}")).collect();
        let mut line = vec!["warp", "--clones=follow", "-q", "-o", to.to_str().unwrap()];
        line.extend(select.iter().map(String::as_str));
        run(&from, &line);
        fs::copy(&to, &from).unwrap();
    }
    from.set_extension("svg");
    read(&from)
}

pub fn run(file: &Path, line: &[&str]) {
    let done = pathwarp(&[&[line[0], file.to_str().unwrap()][..], &line[1..]].concat());
    assert!(matches!(done.status.code(), Some(0 | 1)), "{line:?}: {}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn gimp_paths_open_and_dxf_files_have_arcs() {
    if !editor::is_installed() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    install(&folder.join("profile"));
    let at = |name: &str| folder.join(name).display().to_string();
    fs::copy(crate::support::sample("paper.xcf"), at("paper.xcf")).unwrap();
    fs::write(at("round.svg"), inkscape_drawing("<circle id='c' cx='90' cy='95' r='12'/>")).unwrap();
    editor::convert(folder, &[&at("paper.xcf"), "--export-plain-svg", "-o", &at("paper.svg")]);
    let opened = read(&folder.join("paper.svg"));
    for name in ["Grid", "Base", "Target", "Shaper"] {
        assert!(opened.contains(&format!("\"{name}\"")), "{name}: {opened}");
    }
    editor::convert(folder, &[&at("round.svg"), "--export-extension=org.pathwarp.dxf", "-o", &at("round.dxf")]);
    let dxf = read(&folder.join("round.dxf"));
    assert!(dxf.lines().any(|l| l.trim() == "CIRCLE"), "{dxf}");
}
