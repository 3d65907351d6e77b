//! *Bend by hand…* in an installed Inkscape, with a program in the role of the user and the browser.

use super::editor;
use super::extension::{assert_near, numbers, read, run, workplace};
use crate::browser;
use crate::support::root;
use pathwarp_svg::objects::objects;
use std::fs;
use std::path::Path;

const BODY: &str = "<path id='a' d='M 20,20 H 60 V 60 H 20 Z'/><path id='b' d='M 80,20 H 120 V 60 Z'/>";

/// Plays the user and the browser: `keep`s the result, or closes the page.
fn user(folder: &Path, does: &str) {
    let opener = folder.join("browser");
    let web = root().join("crates/pathwarp-editor/web");
    fs::write(&opener, format!("#!/bin/sh\ncd '{}' && exec node tests/hand.mjs {does} \"$1\"\n", web.display()))
        .unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&opener, fs::Permissions::from_mode(0o755)).unwrap();
    }
}

#[test]
fn bending_by_hand_comes_back_to_inkscape() {
    if !(editor::is_installed() && editor::has_screen()) {
        return;
    }
    if let Some(what) = browser::missing() {
        crate::support::skipped(format_args!("bending by hand in Inkscape is not tested without {what}"));
        return;
    }
    let (dir, source) = workplace(BODY);
    let folder = dir.path();
    let at = |name: &str| folder.join(name);
    let act = |from: &str, to: &str| {
        let to = at(to);
        let actions =
            format!("select-by-id:b;org.pathwarp.bend-by-hand.noprefs;export-filename:{};export-do;", to.display());
        editor::act(folder, &at(from), &actions);
        read(&to)
    };

    user(folder, "keep");
    let bent = act("source.svg", "bent.svg");
    let recipe = |svg: &str, id: &str| {
        let all = objects(svg, &pathwarp::budget::Limits::default()).unwrap();
        all.into_iter().find(|o| o.id == id).and_then(|o| o.recipe)
    };
    let line = recipe(&bent, "b").expect("the object remembers its steps");
    assert_eq!(recipe(&bent, "a"), None, "what is not selected stays");
    assert_near(&numbers(&bent, "a"), &numbers(&source, "a"), "a");
    // The words of the effect, typed on a command line, give its result.
    let words: Vec<String> = line
        .split('\'')
        .enumerate()
        .flat_map(|(i, part)| {
            if i % 2 == 1 { vec![part.to_owned()] } else { part.split_whitespace().map(ToOwned::to_owned).collect() }
        })
        .collect();
    let out = at("wanted.svg");
    let words: Vec<&str> =
        words.iter().map(String::as_str).chain(["--select=#b", "-q", "-o", out.to_str().unwrap()]).collect();
    assert_eq!(words[0], "shaper");
    run(&at("source.svg"), &words);
    let wanted = read(&out);
    assert_near(&numbers(&bent, "b"), &numbers(&wanted, "b"), "b");
    let moved = numbers(&bent, "b").iter().zip(numbers(&source, "b")).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(moved > 5.0, "the corner was dragged by 50 px, and b moved by {moved}");

    // A page that is closed changes nothing, and Inkscape shows no message, which would stop it.
    user(folder, "close");
    let same = act("bent.svg", "same.svg");
    assert_eq!(recipe(&same, "b").as_deref(), Some(line.as_str()));
    assert_near(&numbers(&same, "b"), &numbers(&bent, "b"), "b after closing the page");
}
