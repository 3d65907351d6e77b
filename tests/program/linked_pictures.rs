//! Pictures beside a drawing: visible wherever the drawing is shown, and found or embedded wherever it goes.

use crate::support::editor::{Editor, ask};
use crate::support::{pathwarp_in, pathwarp_program};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp_raster::{Pixmap, Size, decode_png, render};
use pathwarp_svg::{Document, ReadOptions, usvg_tree};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const BLUE: &str =
    "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='40'><path fill='#00f' d='M0,0h40v40h-40z'/></svg>";
const NAMES: [&str; 3] = ["photo.png", "in/my photo.png", "pic.svg"];

/// A picture of 40 × 20 pixels: green at the left, red at the right.
fn photo() -> Vec<u8> {
    let mut picture = resvg::tiny_skia::Pixmap::new(40, 20).unwrap();
    for (i, p) in picture.pixels_mut().iter_mut().enumerate() {
        let [r, g] = if i % 40 < 20 { [0, 255] } else { [255, 0] };
        *p = resvg::tiny_skia::ColorU8::from_rgba(r, g, 0, 255).premultiply();
    }
    picture.encode_png().unwrap()
}

/// Makes a folder with the folder `art` of the drawing `d.svg`, whose shape `c` is bent, and of its pictures.
fn folder(links: [&str; 3]) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (name, content) in [
        ("photo.png", photo()),
        ("in/my photo.png", photo()),
        ("pic.svg", BLUE.into()),
        ("d.svg", drawing(links).into()),
    ] {
        let file = dir.path().join("art").join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, content).unwrap();
    }
    fs::create_dir_all(dir.path().join("out put")).unwrap();
    dir
}

fn drawing([a, b, c]: [&str; 3]) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 100 100' width='100' height='100'>\
         <image width='40' height='20' href='{a}'/><image x='50' width='40' height='20' xlink:href='{b}'/>\
         <image y='40' width='40' height='40' href='{c}'/><path id='c' d='M60,60h30v30h-30z'/>\
         <desc>href='photo.png'</desc></svg>"
    )
}

fn usual() -> TempDir {
    folder(["photo.png", "in/my%20photo.png?v=1#top", "./pic.svg"])
}

/// Returns the links of a drawing's images.
fn links(svg: &str) -> Vec<String> {
    let values = svg.split("<image ").skip(1).map(|image| {
        let value = &image[image.find("href=").unwrap() + 5..];
        value[1..].split(&value[..1]).next().unwrap().to_owned()
    });
    values.collect()
}

/// The file that a link leads to from a folder.
fn file(folder: &Path, link: &str) -> PathBuf {
    let path = link.split(['?', '#']).next().unwrap().replace("%20", " ");
    folder.join(path).canonicalize().unwrap_or_else(|e| panic!("{link}: {e}"))
}

/// The data in a link.
fn data(link: &str) -> Option<Vec<u8>> {
    Some(STANDARD.decode(link.strip_prefix("data:")?.split_once(";base64,")?.1.trim()).unwrap())
}

/// Asserts that the three pictures are visible where the drawing shows them.
#[track_caller]
fn is_shown(picture: &Pixmap) {
    let at = |x: u32, y: u32| {
        let scale = picture.width() as f32 / 100.0;
        let p = picture.pixel((x as f32 * scale) as u32, (y as f32 * scale) as u32).unwrap();
        [p.red(), p.green(), p.blue(), p.alpha()]
    };
    let seen = [at(10, 10), at(30, 10), at(60, 10), at(80, 10), at(20, 60), at(75, 75)];
    let [green, red, blue, black] = [[0, 255, 0, 255], [255, 0, 0, 255], [0, 0, 255, 255], [0, 0, 0, 255]];
    assert_eq!(seen, [green, red, green, red, blue, black]);
}

fn drawn(svg: &str) -> Pixmap {
    let tree = usvg_tree::parse_tree(svg.as_bytes(), "the result", &ReadOptions::default()).unwrap();
    render(&tree, Size::Native).unwrap()
}

/// A wave of the shape alone, so low that it is not visible.
const BENT: [&str; 5] = ["wave", "--height", "0.1", "--select", "#c"];

#[test]
fn links_lead_to_the_same_files_wherever_the_result_is() {
    let dir = usual();
    let art = dir.path().join("art");
    let own: Vec<PathBuf> = NAMES.iter().map(|n| art.join(n).canonicalize().unwrap()).collect();
    for steps in [&BENT[..], &["affine", "--rotate", "10"], &["contour", "--by", "2"]] {
        for to in ["art/r.svg", "art/in/r.svg", "r.svg", "out put/r.svg", "out put/r.svgz"] {
            let args = [&steps[..1], &["art/d.svg", "-o", to], &steps[1..]].concat();
            let out = pathwarp_in(dir.path(), &args, b"");
            assert!(out.status.success(), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
            let bytes = fs::read(dir.path().join(to)).unwrap();
            let text = Document::read(&bytes, to, &ReadOptions::default()).unwrap().decoded().into_owned();
            let place = dir.path().join(to);
            let found = links(&text).into_iter().filter(|l| data(l).is_none());
            let found: Vec<PathBuf> = found.map(|l| file(place.parent().unwrap(), &l)).collect();
            // A drawing that is turned becomes a group.
            assert!(found == own || steps[0] == "affine" && found == own[..2], "{args:?}: {found:?}");
            // Text that only looks like a link stays.
            assert!(text.contains(">href='photo.png'<"), "{text}");
        }
    }
}

#[test]
fn results_without_a_place_hold_their_pictures() {
    let dir = usual();
    let art = dir.path().join("art");
    let contents = NAMES.map(|n| fs::read(art.join(n)).unwrap());
    let drawing = fs::read(art.join("d.svg")).unwrap();
    for (args, input) in [
        (bent(&["d.svg"], &[]), &b""[..]),
        (bent(&["d.svg"], &["-o", "/dev/stdout"]), b""),
        (bent(&["-"], &["-o", "-"]), &drawing),
        (bent(&["-"], &["--base-dir", "../art"]), &drawing),
    ] {
        let out = pathwarp_in(&art, &args, input);
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        let text = String::from_utf8(out.stdout).unwrap();
        assert_eq!(links(&text).iter().map(|l| data(l).unwrap()).collect::<Vec<_>>(), contents, "{args:?}");
        is_shown(&drawn(&text));
    }
    // A result holds its pictures if the source could not read them from there.
    for (to, holds) in [("r.svg", false), ("../r.svg", false), ("../out put/r.svg", true)] {
        assert!(pathwarp_in(&art, &bent(&["d.svg"], &["--embed-recipe", "-o", to]), b"").status.success());
        let source = pathwarp_in(&art, &["unwarp", to], b"").stdout;
        assert_eq!(source == drawing, to == "r.svg", "{to}");
        let text = String::from_utf8(source).unwrap();
        assert_eq!(links(&text).iter().all(|l| data(l).is_some()), holds, "{to}");
        let back = pathwarp_in(&art, &["unwarp", to, "-o", "in/back.svg"], b"");
        assert!(back.status.success(), "{}", String::from_utf8_lossy(&back.stderr));
        let back = fs::read_to_string(art.join("in/back.svg")).unwrap();
        let found =
            links(&back).into_iter().map(|l| data(&l).unwrap_or_else(|| fs::read(file(&art.join("in"), &l)).unwrap()));
        assert_eq!(found.collect::<Vec<_>>(), contents, "{to}");
    }
}

/// The arguments that bend one shape.
fn bent<'a>(before: &[&'a str], after: &[&'a str]) -> Vec<&'a str> {
    [&["wave"], before, &BENT[1..], after].concat()
}

fn asked(editor: &Editor, request: &Value) -> Value {
    let mut request = request.clone();
    request["id"] = json!(1);
    ask(&mut editor.socket(), &request.to_string())
}

/// The canvas, the original, a small picture, and the PNG of a drawing of which one shape is bent; the copied command gives that PNG, too.
#[test]
fn the_editor_shows_them() {
    let dir = usual();
    let art = dir.path().join("art");
    let editor = Editor::open(&art, "d.svg");
    let step = json!({ "deformation": "wave", "args": { "height": ["0.1"] }, "select": ["#c"] });
    let shown = asked(&editor, &json!({ "do": "commit", "steps": [step], "shown": null }));
    assert_eq!(shown["warnings"], json!([]));
    is_shown(&drawn(shown["picture"]["whole"].as_str().unwrap()));
    is_shown(&drawn(asked(&editor, &json!({ "do": "before" }))["svg"].as_str().unwrap()));
    let small = asked(&editor, &json!({ "do": "thumbnail", "steps": [step] }));
    assert_eq!(links(small["svg"].as_str().unwrap()).iter().filter(|l| data(l).is_some()).count(), 3);
    let download = |name: &str| {
        let answer = asked(&editor, &json!({ "do": "download", "name": name, "picture": { "width": 100 } }));
        STANDARD.decode(answer["bytes"].as_str().unwrap_or_else(|| panic!("{answer}"))).unwrap()
    };
    is_shown(&decode_png(&download("p.png")).unwrap());
    is_shown(&drawn(&String::from_utf8(download("p.svg")).unwrap()));
    let told = asked(&editor, &json!({ "do": "command-line", "name": "told.png", "picture": { "width": 100 } }));
    let line = told["text"].as_str().unwrap().replace("pathwarp ", &format!("{} ", pathwarp_program().display()));
    let ran =
        std::process::Command::new("sh").args(["-c", &format!("set -e; {line}")]).current_dir(&art).output().unwrap();
    assert!(ran.status.success() && ran.stderr.is_empty(), "{line}: {}", String::from_utf8_lossy(&ran.stderr));
    is_shown(&decode_png(&fs::read(art.join("told.png")).unwrap()).unwrap());
    // Saved elsewhere and opened there, and downloaded and opened where there are no pictures.
    let save = json!({ "do": "save", "name": "kept.svg", "folder": "../out put", "replace": false });
    assert_eq!(asked(&editor, &save)["error"], Value::Null);
    let lone = tempfile::tempdir().unwrap();
    fs::write(lone.path().join("kept.svg"), download("kept.svg")).unwrap();
    for there in [dir.path().join("out put"), lone.path().to_owned()] {
        let again = Editor::open(&there, "kept.svg");
        let shown = asked(&again, &json!({ "do": "bend", "steps": [step], "draft": null }));
        assert_eq!(shown["warnings"], json!([]));
        is_shown(&drawn(shown["picture"]["whole"].as_str().unwrap()));
    }
}

/// No file outside of the drawing's folder gets into a result, unless that is allowed.
#[test]
fn no_other_file_is_put_in() {
    let secret = tempfile::tempdir().unwrap();
    fs::write(secret.path().join("s.png"), photo()).unwrap();
    let absolute = secret.path().join("s.png").display().to_string();
    let (url, local) = (format!("file://{absolute}"), format!("FILE://localhost{}", absolute.replace('s', "%73")));
    let dir = usual();
    let art = dir.path().join("art");
    fs::write(dir.path().join("s.png"), photo()).unwrap();
    fs::remove_file(art.join("photo.png")).unwrap();
    let mut outside =
        vec![&*absolute, &url, &local, "../s.png", "%2e%2e/s.png", "..%2Fs.png", "in/../../s.png", "%2E./s.png?a.png"];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(secret.path().join("s.png"), art.join("link.png")).unwrap();
        std::os::unix::fs::symlink(secret.path(), art.join("there")).unwrap();
        outside.extend(["link.png", "there/s.png", "there%2fs.png"]);
    }
    for (link, allowed) in outside.iter().map(|l| (*l, true)).chain([("d.txt", false), ("in", false), ("%00", false)]) {
        fs::write(art.join("d.txt"), "words").unwrap();
        fs::write(art.join("d.svg"), drawing([link, "%69n/my photo.png", "pic.svg"])).unwrap();
        let run = |more: &[&str]| {
            let out = pathwarp_in(&art, &bent(&["d.svg"], more), b"");
            let said = String::from_utf8(out.stderr).unwrap();
            (out.status.code().unwrap(), data(&links(&String::from_utf8(out.stdout).unwrap())[0]), said)
        };
        let (code, first, said) = run(&[]);
        assert!(code == 1 && first.is_none() && said.contains(link), "{link}: {code} {said}");
        let (code, first, said) = run(&["--allow-external"]);
        assert_eq!((code, first), if allowed { (0, Some(photo())) } else { (1, None) }, "{link}: {said}");
        let stopped =
            pathwarp_in(&art, &["wave", "d.svg", "--select", "#c", "--on-error", "stop", "-o", "no.svg"], b"");
        assert!(stopped.status.code() == Some(3) && String::from_utf8_lossy(&stopped.stderr).contains(link), "{link}");
        assert!(!art.join("no.svg").exists());
        let editor = Editor::open(&art, "d.svg");
        let step = json!({ "deformation": "wave", "args": {}, "select": ["#c"] });
        let shown = asked(&editor, &json!({ "do": "commit", "steps": [step], "shown": null }));
        assert!(shown["warnings"].to_string().contains(link), "{link}: {}", shown["warnings"]);
        for name in ["p.svg", "p.svgz"] {
            let answer = asked(&editor, &json!({ "do": "download", "name": name }));
            let bytes = STANDARD.decode(answer["bytes"].as_str().unwrap()).unwrap();
            let text = Document::read(&bytes, name, &ReadOptions::default()).unwrap().decoded().into_owned();
            let found = links(&text).into_iter().map(|l| data(&l).is_some());
            assert_eq!(found.collect::<Vec<_>>(), [false, true, true], "{link}");
        }
    }
}

/// A file name with a percent sign or a number sign, as programs write it that do not encode links.
#[test]
fn names_are_taken_as_they_stand_where_no_other_file_is_meant() {
    let dir = folder(["100%25.png", "a%20b.png", "pic.svg"]);
    let art = dir.path().join("art");
    fs::copy(art.join("photo.png"), art.join("100%.png")).unwrap();
    fs::copy(art.join("photo.png"), art.join("a%20b.png")).unwrap();
    let out = pathwarp_in(&art, &bent(&["d.svg"], &[]), b"");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    is_shown(&drawn(&String::from_utf8(out.stdout).unwrap()));
}
