//! Only named files are read and written.

use super::bounded::{Folder, RECT, svg};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::fs;

/// A picture of one pixel.
fn pixel() -> Vec<u8> {
    let mut picture = resvg::tiny_skia::Pixmap::new(1, 1).unwrap();
    picture.fill(resvg::tiny_skia::Color::BLACK);
    picture.encode_png().unwrap()
}

#[test]
fn linked_pictures_are_read_beside_the_drawing_only() {
    let outside = Folder::with(&[("secret.png", &pixel()), ("secret.svg", &svg(RECT))]);
    let absolute = outside.path().join("secret.png").display().to_string();
    let folder = Folder::with(&[
        ("art/a.svg", b""),
        ("art/beside.png", &pixel()),
        ("art/in/below.png", &pixel()),
        ("above.png", &pixel()),
    ]);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&absolute, folder.path().join("art/link.png")).unwrap();
        std::os::unix::fs::symlink(outside.path(), folder.path().join("art/folder")).unwrap();
    }
    let secret = STANDARD.encode(pixel());
    let holds = |link: &str, more: &[&str]| {
        fs::write(folder.path().join("art/a.svg"), svg(&format!("<image width='9' height='9' href='{link}'/>{RECT}")))
            .unwrap();
        let (code, said) = folder.run(
            &[&["wave", "art/a.svg", "-o", "out.svg", "--structure", "flatten", "--images", "keep"], more].concat(),
        );
        let (drawn, _) = folder.run(&[&["render", "art/a.svg", "-o", "out.png"], more].concat());
        let read = fs::read_to_string(folder.path().join("out.svg")).unwrap().contains(&secret);
        // Both commands report the files that they do not read.
        assert_eq!((code == 1, drawn == 1), (true, !read), "{link}: {said}");
        (read, said)
    };
    for inside in ["beside.png", "in/below.png", "./in/../beside.png"] {
        assert!(holds(inside, &[]).0, "{inside}");
    }
    for link in [&absolute, "../above.png", "in/../../above.png", "link.png", "folder/secret.png"] {
        let (read, said) = holds(link, &[]);
        assert!(!read && said.contains("--allow-external"), "{link}: {said}");
        assert!(holds(link, &["--allow-external"]).0, "{link} with --allow-external");
    }
    for link in ["/dev/zero", "file:///etc/passwd", "https://example.org/a.png", "missing.png", "in"] {
        assert!(!holds(link, &[]).0, "{link}");
    }
}

#[test]
fn recipes_set_deformations_only() {
    let cage = "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z";
    let folder = Folder::with(&[("a.svg", &svg(RECT)), ("r/cage.svg", &svg(&format!("<path d='{cage}'/>")))]);
    let run = |recipe: &str, more: &[&str]| {
        fs::write(folder.path().join("r/r.toml"), format!("pathwarp=1\n{recipe}")).unwrap();
        folder.run(&[&["run", "r/r.toml", "a.svg", "-o", "o.svg"], more].concat())
    };
    let swirl = "[[step]]\ndeformation=\"swirl\"\n";
    for option in [
        "out=\"../evil.svg\"",
        "out-dir=\"..\"",
        "report=\"r.json\"",
        "preview=\"p.png\"",
        "write-recipe=\"w.toml\"",
        "into=\"c.xcf\"",
        "jobs=65535",
        "in-place=true",
        "recursive=true",
        "embed-recipe=true",
        "limit=\"bytes=1e99\"",
        "allow-external=true",
        "quiet=true",
    ] {
        let (code, said) = run(&format!("[options]\n{option}\n{swirl}"), &[]);
        assert_eq!(code, 3, "{option}: {said}");
        assert!(said.contains("is not for recipes") && said.contains("r.toml"), "{option}: {said}");
    }
    let (code, said) = run("[[step]]\ndeformation=\"ffd\"\nsave-lattice=\"evil.json\"\n", &[]);
    assert_eq!((code, said.contains("is not for recipes")), (3, true), "{said}");
    let shaper = |path: &str| format!("[[step]]\ndeformation=\"shaper\"\nshaper=\"{path}\"\n");
    let absolute = folder.path().join("r/cage.svg").display().to_string();
    let (code, said) = run(&shaper(&absolute), &[]);
    assert_eq!((code, said.contains("--allow-external")), (3, true), "{said}");
    assert_eq!(run(&shaper(&absolute), &["--allow-external"]).0, 0);
    assert_eq!(run(&shaper("cage.svg"), &["--tolerance", "0.1"]).0, 0);
    for other in ["../r", "."] {
        assert_eq!(run(&shaper(other), &[]).0, 3, "{other}");
    }
    let mut files: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["a.svg", "o.svg", "r"]);
}

#[test]
fn split_files_stay_in_their_folder() {
    let split = |ids: &[&str]| {
        let paths: String = ids.iter().map(|id| format!("<path id='{id}' d='M0 0L1 1'/>")).collect();
        let folder = Folder::with(&[("a.svg", &svg(&paths))]);
        let (code, said) = folder.run(&["convert", "a.svg", "--split", "-o", "x.svg"]);
        (code, fs::read_dir(folder.path()).unwrap().count() - 1, said)
    };
    let ids = ["../../../var/EVIL", "/var/EVIL", "..\\..\\x", "q"];
    assert_eq!(split(&ids).1, ids.len());
    // No file can have this name, so no other file is left either.
    let long = "n".repeat(300);
    let (code, left, said) = split(&[ids[0], ids[1], &long, ids[2]]);
    assert_eq!((code, left), (5, 0), "{said}");
}

#[test]
fn an_embedded_source_larger_than_the_limit_is_refused_whole() {
    let folder = Folder::with(&[("a.svg", &svg(&format!("{RECT}<!--{}-->", "x".repeat(9000))))]);
    assert_eq!(folder.run(&["swirl", "a.svg", "-o", "w.svg", "--embed-recipe"]).0, 0);
    assert_eq!(folder.run(&["unwarp", "w.svg", "-o", "back.svg"]).0, 0);
    assert_eq!(fs::read(folder.path().join("back.svg")).unwrap(), fs::read(folder.path().join("a.svg")).unwrap());
    let (code, said) = folder.run(&["unwarp", "w.svg", "-o", "cut.svg", "--limit", "bytes=5e3"]);
    assert_eq!((code, said.contains("bytes")), (3, true), "{said}");
    assert!(!folder.path().join("cut.svg").exists());
}

/// Elements, paths and texts of other files are not read, and filters show no pictures from elsewhere. Each of these is reported.
#[test]
fn parts_of_other_files_are_reported() {
    let outside = Folder::with(&[("b.svg", &svg("<path id='p' d='M0 0H9'/>")), ("p.png", &pixel())]);
    let file = |name: &str| outside.path().join(name).display().to_string();
    let other = file("b.svg");
    for body in [
        format!("<use href='{other}#p'/>"),
        "<use href='c.svg#p'/>".into(),
        format!("<text y='9'><textPath href='{other}#p'>abc</textPath></text>"),
        format!("<filter id='f'><feImage href='{}'/></filter><g filter='url(#f)'>{RECT}</g>", file("p.png")),
    ] {
        let folder =
            Folder::with(&[("a.svg", &svg(&format!("{body}{RECT}"))), ("c.svg", &svg("<path id='p' d='M0 0H9'/>"))]);
        for args in [
            &["wave", "a.svg", "-o", "o.svg"][..],
            &["wave", "a.svg", "-o", "o.svg", "--structure", "flatten"],
            &["render", "a.svg", "-o", "o.png"],
            &["convert", "a.svg", "-o", "o.pdf"],
        ] {
            let (code, said) = folder.run(args);
            assert_eq!(code, 1, "{body} {args:?}: {said}");
        }
    }
}

/// Results do not depend on the existence of a file behind a symbolic link.
#[cfg(unix)]
#[test]
fn links_do_not_tell_what_is_elsewhere() {
    let outside = Folder::with(&[("there.png", &pixel())]);
    let folder = Folder::with(&[]);
    std::os::unix::fs::symlink(outside.path(), folder.path().join("f")).unwrap();
    let said = |name: &str| {
        let body = format!("<image width='9' height='9' href='f/{name}.png'/>{RECT}");
        fs::write(folder.path().join("a.svg"), svg(&body)).unwrap();
        ["swirl", "render"].map(|c| folder.run(&[c, "a.svg", "-o", if c == "swirl" { "o.svg" } else { "o.png" }]))
    };
    let absent = said("absent").map(|(code, text)| (code, text.replace("absent", "there")));
    assert_eq!(said("there"), absent);
}
