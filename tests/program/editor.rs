//! `pathwarp edit`: the state that it keeps, as seen through its socket.

use crate::support::editor::{Editor, ask};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::fs;
use std::net::TcpListener;
use std::path::Path;
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

/// A photograph is framed as a drawing, upright; a copied command line finds that drawing beside it.
#[test]
fn pictures_are_drawings_of_themselves() {
    // An APP1 segment with orientation (0x0112) = 6: the first row is the right side.
    const TURNED: &[u8] = b"\xff\xe1\x00\x22Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
    let folder = tempfile::tempdir().unwrap();
    let here = |args: &[&str], input: &str| crate::support::pathwarp_in(folder.path(), args, input.as_bytes());
    let wide = LOGO.replace("0 0 90 90", "0 0 90 60");
    for extension in ["png", "jpg", "webp"] {
        let name = format!("photo.{extension}");
        assert!(here(&["render", "-", "--background", "white", "--width", "90", "-o", &name], &wide).status.success());
    }
    let mut turned = fs::read(folder.path().join("photo.jpg")).unwrap();
    turned.splice(2..2, TURNED.iter().copied());
    fs::write(folder.path().join("turned.jpg"), turned).unwrap();
    for (name, page) in
        [("photo.png", [90, 60]), ("photo.webp", [90, 60]), ("photo.jpg", [90, 60]), ("turned.jpg", [60, 90])]
    {
        let editor = Editor::open(folder.path(), name);
        let state = state(&editor);
        assert_eq!(
            (&state["file"], &state["page"]),
            (&json!(name), &json!([0.0, 0.0, f64::from(page[0]), f64::from(page[1])]))
        );
        commit(&editor, "flag");
        asked(&editor, &json!({ "do": "save", "name": "own.svg", "replace": true }));
        let told = || asked(&editor, &json!({ "do": "command-line", "name": "told.svg" }));
        let (told, again) = (told(), told());
        let line = told["text"].as_str().unwrap();
        let source = line.split(' ').nth(2).unwrap();
        assert_eq!(
            (&told["written"], &again["written"], &again["text"]),
            (&json!(source), &Value::Null, &told["text"])
        );
        assert!(here(&line.split(' ').skip(1).collect::<Vec<_>>(), "").status.success(), "{line}");
        let [own, told] = ["own.svg", "told.svg"].map(|n| fs::read(folder.path().join(n)).unwrap());
        assert!(own == told, "{name}: other bytes by {line}");
    }
    fs::write(folder.path().join("bad.png"), &fs::read(folder.path().join("photo.png")).unwrap()[..60]).unwrap();
    let out = here(&["edit", "--no-open", "bad.png"], "");
    assert_eq!(out.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&out.stderr).contains("bad.png: not a readable picture"), "{out:?}");
}

#[test]
fn what_cannot_be_edited_is_said() {
    let out = crate::support::pathwarp(&["edit", "-"]);
    assert_eq!(out.status.code(), Some(2));
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.svg");
    std::fs::write(&bad, "<svg").unwrap();
    let out = crate::support::pathwarp(&["edit", "--no-open", bad.to_str().unwrap()]);
    assert_eq!(out.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&out.stderr).contains("bad.svg"), "{out:?}");
    assert!(out.stdout.is_empty(), "the address is printed before the drawing is read");
}

/// Two drawings that differ.
const LOGO: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 90 90'><path d='M10,10 H80 V80 Z'/></svg>";
const OTHER: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 90 90'><path d='M20,10 H80 V80 Z'/></svg>";

fn logo() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("logo.svg"), LOGO).unwrap();
    folder
}

/// Asks on a new connection.
fn asked(editor: &Editor, request: &Value) -> Value {
    let mut request = request.clone();
    request["id"] = json!(1);
    ask(&mut editor.socket(), &request.to_string())
}

fn state(editor: &Editor) -> Value {
    asked(editor, &json!({ "do": "hello" }))["state"].take()
}

fn commit(editor: &Editor, style: &str) {
    let step = json!({ "deformation": "warp", "args": { "style": [style] } });
    let answer = asked(editor, &json!({ "do": "commit", "steps": [step], "shown": null }));
    assert_eq!(answer["error"], Value::Null);
}

/// Opens another drawing on the page.
fn drop_on(editor: &Editor, name: &str, text: &str) {
    let answer = asked(editor, &json!({ "do": "open", "name": name, "bytes": STANDARD.encode(text) }));
    assert_eq!((&answer["error"], &answer["state"]["file"]), (&Value::Null, &json!(name)));
}

/// The file on show, and the style of its step.
fn shown(editor: &Editor) -> (String, Value) {
    let state = state(editor);
    let steps = state["steps"].as_array().unwrap().len();
    assert!(steps < 2 && state["restored"] == (steps == 1), "{state}");
    (state["file"].as_str().unwrap().to_owned(), state.pointer("/steps/0/args/style/0").cloned().unwrap_or_default())
}

fn files(folder: &Path) -> Vec<String> {
    let mut all: Vec<_> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    all.sort();
    all
}

/// Small pictures of a large drawing are bitmaps, and look like those of a drawing without the bulk.
#[test]
fn small_pictures_of_large_drawings_are_small() {
    let body = "<path fill='#06c' d='M-30,20 H60 V50 H-30Z'/><circle cx='20' cy='35' r='9' fill='#fc0'/>";
    let svg = |bulk: &str| {
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='-40 0 120 60' width='30'>{bulk}{body}</svg>")
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), svg("")).unwrap();
    fs::write(folder.path().join("large.svg"), svg(&format!("<!--{}-->", "bulk ".repeat(60_000)))).unwrap();
    let [a, large] = ["a.svg", "large.svg"].map(|name| Editor::open(folder.path(), name));
    let pixels = |svg: &str| {
        let args = ["render", "-", "--width", "64", "--background", "white"];
        let out = crate::support::pathwarp_in(folder.path(), &args, svg.as_bytes());
        pathwarp_raster::decode_png(&out.stdout).unwrap()
    };
    let of = |editor: &Editor, example: &str| {
        let answer = asked(editor, &json!({ "do": "thumbnail", "steps": null, "example": example, "variant": null }));
        answer["svg"].as_str().unwrap_or_else(|| panic!("{answer}")).to_owned()
    };
    let mut seen = Vec::new();
    for example in ["shaper", "projective", "wave", "bend"] {
        let (plain, small) = (of(&a, example), of(&large, example));
        assert!(!plain.contains("<image") && small.contains("<image") && small.len() < 100_000, "{example}");
        let [plain, small] = [plain, small].map(|svg| pixels(&svg));
        assert!(plain.height().abs_diff(small.height()) <= 1, "{example}: {plain:?}, {small:?}");
        // A bitmap has soft edges, which move everything by up to a pixel.
        let unlike = |other: &pathwarp_raster::Pixmap| {
            let (width, height) = (plain.width(), plain.height());
            let color = |p: &pathwarp_raster::Pixmap, (x, y): (u32, u32)| p.pixel(x, y).map(|p| [p.red(), p.green()]);
            let is_like = |&(x, y): &(u32, u32)| {
                let near =
                    (y.saturating_sub(1)..=y + 1).flat_map(|y| (x.saturating_sub(1)..=x + 1).map(move |x| (x, y)));
                let alike = |a: [u8; 2], b: [u8; 2]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) < 128);
                near.filter_map(|at| color(other, at)).any(|b| color(&plain, (x, y)).is_some_and(|a| alike(a, b)))
            };
            let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            places.filter(|at| !is_like(at)).count()
        };
        assert!(unlike(&small) < 10, "{example}: {} pixels differ", unlike(&small));
        assert!(seen.iter().all(|other| unlike(other) > 30), "{example} looks like another deformation");
        seen.push(plain.clone());
    }
}

#[test]
fn a_draft_belongs_to_the_drawing_it_was_made_from() {
    let folder = logo();
    let editor = Editor::open(folder.path(), "logo.svg");
    commit(&editor, "flag");
    drop_on(&editor, "other.svg", OTHER);
    assert_eq!(state(&editor)["steps"], json!([]));
    commit(&editor, "arc");
    drop(editor);
    let editor = Editor::open(folder.path(), "./logo.svg");
    assert_eq!(shown(&editor), ("logo.svg".into(), json!("flag")));
    drop_on(&editor, "other.svg", OTHER);
    assert_eq!(shown(&editor), ("other.svg".into(), json!("arc")));
    for (name, wrong) in [("logo.svg", "open first"), ("other.svg", "the drawing itself")] {
        let answer = asked(&editor, &json!({ "do": "save", "name": name, "replace": true }));
        assert!(answer["error"].as_str().is_some_and(|e| e.contains(wrong)), "{answer}");
    }
    assert!(asked(&editor, &json!({ "do": "save", "name": null, "replace": false }))["written"].is_string());
    assert_eq!(files(folder.path()), ["logo.svg", "other-bent.svg", "state"]);
    assert_eq!(fs::read_to_string(folder.path().join("logo.svg")).unwrap(), LOGO);
    drop(editor);
    // Another drawing under that name, and then the old one.
    fs::write(folder.path().join("logo.svg"), OTHER).unwrap();
    assert_eq!(shown(&Editor::open(folder.path(), "logo.svg")), ("logo.svg".into(), Value::Null));
    fs::write(folder.path().join("logo.svg"), LOGO).unwrap();
    assert_eq!(shown(&Editor::open(folder.path(), "logo.svg")), ("logo.svg".into(), json!("flag")));
}

/// A result changes when it is saved to its source file; later changes belong to the new content.
#[test]
fn what_comes_after_saving_is_kept() {
    let folder = logo();
    let editor = Editor::open(folder.path(), "logo.svg");
    commit(&editor, "flag");
    asked(&editor, &json!({ "do": "save", "name": "flag.svg", "replace": false }));
    assert_eq!(files(&folder.path().join("state/pathwarp/drafts")), [] as [&str; 0], "a draft is left");
    drop(editor);
    let editor = Editor::open(folder.path(), "flag.svg");
    commit(&editor, "arc");
    assert_eq!(asked(&editor, &json!({ "do": "save", "name": null, "replace": false }))["exists"], Value::Null);
    commit(&editor, "wave");
    drop(editor);
    assert_eq!(shown(&Editor::open(folder.path(), "flag.svg")), ("flag.svg".into(), json!("wave")));
}

#[test]
fn the_hundred_newest_drafts_are_kept() {
    let folder = logo();
    let drafts = folder.path().join("state/pathwarp/drafts");
    fs::create_dir_all(&drafts).unwrap();
    for age in 1..=120 {
        let file = fs::File::create(drafts.join(format!("{age:03}.json"))).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(age)).unwrap();
    }
    let editor = Editor::open(folder.path(), "logo.svg");
    commit(&editor, "flag");
    let left = files(&drafts);
    assert_eq!(left.len(), 100);
    assert!(left.contains(&"099.json".to_owned()) && !left.contains(&"100.json".to_owned()), "{left:?}");
    commit(&editor, "arc");
    drop(editor);
    assert_eq!(shown(&Editor::open(folder.path(), "logo.svg")), ("logo.svg".into(), json!("arc")));
}

#[test]
fn without_a_folder_for_state_it_is_said_that_nothing_is_kept() {
    let folder = logo();
    let editor = Editor::with(folder.path(), "logo.svg", |command| {
        command.env_remove("HOME").env_remove("XDG_STATE_HOME").env_remove("LOCALAPPDATA");
    });
    for _ in 0..2 {
        let problem = state(&editor)["problem"].take();
        assert!(problem.as_str().is_some_and(|p| p.contains("HOME is not set")), "{problem}");
        commit(&editor, "flag");
    }
    assert_eq!(files(folder.path()), ["logo.svg"]);
}

/// A page that is still open finds the next run, unless another program has taken its port: then the old token is invalid.
#[test]
fn the_next_run_is_found_at_the_same_address() {
    let folder = logo();
    let address = |editor: &Editor| (editor.port, editor.query.clone());
    let first = address(&Editor::open(folder.path(), "logo.svg"));
    let editor = Editor::open(folder.path(), "logo.svg");
    assert_eq!(address(&editor), first);
    let second = address(&Editor::open(folder.path(), "logo.svg"));
    assert!(second.0 != first.0 && second.1 != first.1, "two programs at one address");
    drop(editor);
    let taken = TcpListener::bind(("127.0.0.1", second.0)).unwrap();
    let third = address(&Editor::open(folder.path(), "logo.svg"));
    assert!(third.0 != second.0 && third.1 != second.1, "the token goes on beside a stranger");
    drop(taken);
    // Half a file does not make a token that anybody could guess.
    let addresses = folder.path().join("state/pathwarp/addresses");
    let file = addresses.join(&files(&addresses)[0]);
    fs::write(file, format!("{{\"token\":\"\",\"port\":{}}}", third.0)).unwrap();
    assert!(Editor::open(folder.path(), "logo.svg").query.len() > 30);
}

/// Folders from anywhere may hold files that look like drafts; no file beside a drawing is read.
#[test]
fn files_beside_the_drawing_are_no_drafts() {
    let folder = logo();
    let draft = "{\"pathwarp\":1,\"steps\":[{\"deformation\":\"wave\",\"args\":{}}],\"undo\":[],\"redo\":[]}";
    fs::write(folder.path().join(".logo.svg.pathwarp-edit"), draft).unwrap();
    assert_eq!(shown(&Editor::open(folder.path(), "logo.svg")), ("logo.svg".into(), Value::Null));
}
