//! Outputs: the files under their names, and the files that may be written at all.
#![cfg(unix)]

use super::bounded::{Folder, RECT, svg};
use crate::support::pathwarp_program;
use std::fs;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::process::{Command, Output};

fn folder() -> Folder {
    Folder::with(&[("a.svg", &svg(RECT))])
}

/// Runs a command line of the shell, in which `pathwarp` is the program.
fn shell(folder: &Folder, line: &str) -> Output {
    let line = line.replace("pathwarp", &pathwarp_program().display().to_string());
    Command::new("sh").arg("-c").arg(line).current_dir(folder.path()).output().unwrap()
}

#[test]
fn private_files_stay_private() {
    let folder = folder();
    let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode() & 0o7777;
    let set =
        |name: &str, mode| fs::set_permissions(folder.path().join(name), fs::Permissions::from_mode(mode)).unwrap();
    fs::write(folder.path().join("o.svg"), "old").unwrap();
    for (before, after) in [(0o600, 0o600), (0o444, 0o444), (0o4755, 0o755)] {
        set("a.svg", before);
        set("o.svg", before);
        assert_eq!(folder.run(&["swirl", "a.svg", "-o", "o.svg", "--report", "r.json"]).0, 0);
        assert_eq!(folder.run(&["swirl", "a.svg", "--in-place"]).0, 0);
        assert_eq!([mode("a.svg"), mode("o.svg")], [after; 2], "{before:o}");
    }
}

/// `-o /dev/stdout` appends to the file behind standard output; it does not replace it.
#[cfg(target_os = "linux")]
#[test]
fn standard_output_is_added_to() {
    let folder = folder();
    for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        let done =
            shell(&folder, &format!("(echo first; pathwarp swirl a.svg -o {name} --format svg; echo last) > log"));
        let log = fs::read_to_string(folder.path().join("log")).unwrap();
        assert!(
            done.status.success() && log.starts_with("first\n<svg") && log.ends_with("</svg>last\n"),
            "{name}: {log}"
        );
    }
}

#[test]
fn links_are_kept_where_they_lead_to_nothing_yet() {
    let folder = folder();
    symlink("new.svg", folder.path().join("link.svg")).unwrap();
    symlink("link.svg", folder.path().join("far.svg")).unwrap();
    let (code, said) = folder.run(&["swirl", "a.svg", "-o", "new.svg", "--report", "far.svg"]);
    assert_eq!((code, said.contains("would be the same file")), (2, true), "{said}");
    assert_eq!(folder.run(&["swirl", "a.svg", "-o", "far.svg"]).0, 0);
    assert!(folder.path().join("new.svg").symlink_metadata().unwrap().is_file());
    assert!(["link.svg", "far.svg"].iter().all(|l| folder.path().join(l).is_symlink()));
}

/// Of a folder only the files in it are read and written.
#[test]
fn links_out_of_a_folder_are_not_followed() {
    let folder = Folder::with(&[("f/a.svg", &svg(RECT)), ("f/b.svg", &svg(RECT)), ("secret.svg", &svg(RECT))]);
    let text = |name: &str| fs::read(folder.path().join(name)).unwrap();
    symlink("../secret.svg", folder.path().join("f/link.svg")).unwrap();
    symlink("b.svg", folder.path().join("f/inside.svg")).unwrap();
    symlink("nowhere.svg", folder.path().join("f/broken.svg")).unwrap();
    let (code, said) = folder.run(&["swirl", "-r", "f", "--out-dir", "o"]);
    assert_eq!((code, said.contains("f/link.svg: is a symbolic link that leads out")), (1, true), "{said}");
    assert!(said.contains("f/broken.svg: is not a regular file"), "{said}");
    let written = |name: &str| folder.path().join("o").join(name).exists();
    assert_eq!(["a.svg", "inside.svg", "link.svg", "broken.svg"].map(written), [true, true, false, false]);
    fs::remove_file(folder.path().join("f/inside.svg")).unwrap();
    let before = text("secret.svg");
    assert_eq!(folder.run(&["swirl", "-r", "f", "--in-place"]).0, 1);
    assert_eq!(text("secret.svg"), before);
    fs::remove_file(folder.path().join("f/broken.svg")).unwrap();
    assert_eq!(folder.run(&["swirl", "-r", "f", "--out-dir", "o", "--allow-external"]).0, 0);
}

#[test]
fn printed_names_are_fit_for_a_terminal() {
    let name = "f/\u{1b}[31m\u{9b}2J\u{202e}\n.svg";
    let shape = "<path id='a&#x9b;b&#x7f;' d='M0 0L9 9'/>";
    let folder = Folder::with(&[(name, &svg(shape)), ("a.svg", &svg(shape))]);
    for line in [
        "pathwarp swirl -r f --out-dir o --dry-run",
        "pathwarp paths --json a.svg",
        "pathwarp compare --json a.svg a.svg",
        "pathwarp swirl a.svg -o o.svg --report -",
        "pathwarp swirl -r f --out-dir o --explain 2>&1",
    ] {
        let out = String::from_utf8(shell(&folder, line).stdout).unwrap();
        let harmful = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(!out.is_empty() && !out.contains(harmful), "{line}: {out:?}");
    }
}

/// A drawing in a pipe can be read once.
#[test]
fn solids_take_drawings_from_pipes() {
    let folder = folder();
    let done = shell(
        &folder,
        "mkfifo p.svg && (cat a.svg > p.svg &) && timeout 1000 pathwarp solid ffd p.svg --extrude 5 -o o.obj",
    );
    assert!(done.status.success(), "{done:?}");
}

#[test]
fn packed_drawings_give_their_source_back() {
    let folder = folder();
    for name in ["w.svgz", "w.svg"] {
        assert_eq!(folder.run(&["swirl", "a.svg", "-o", name, "--embed-recipe"]).0, 0);
        assert_eq!(folder.run(&["unwarp", name, "-o", "back.svg"]).0, 0, "{name}");
        assert_eq!(fs::read(folder.path().join("back.svg")).unwrap(), svg(RECT));
    }
    let text = fs::read_to_string(folder.path().join("w.svg")).unwrap();
    let (start, end) = (text.find("<recipe>").unwrap(), text.find("</recipe>").unwrap());
    fs::write(folder.path().join("w.svg"), format!("{}{}", &text[..start], &text[end + 9..])).unwrap();
    assert_eq!(folder.run(&["unwarp", "w.svg", "-o", "back.svg"]).0, 0);
    let (code, said) = folder.run(&["unwarp", "w.svg", "--recipe", "-o", "r.toml"]);
    assert_eq!((code, said.contains("holds no recipe")), (3, true), "{said}");
}

/// Plug-ins that write to the terminal, or start themselves.
#[test]
fn plug_ins_do_nothing_to_the_terminal_and_start_no_others() {
    let entry = |title: &str| {
        format!(
            "{{\"pathwarp-plugin\":1,\"name\":\"evil\",\"title\":\"{title}\",\"about\":\"Evil.\",\"protocol\":\"text\",\"parameters\":[],\
             \"examples\":[\"evil samples/grid.svg -o out.svg\",\"evil samples/logo.svg -o out.svg\"]}}"
        )
    };
    let script = |entry: &str, rest: &str| format!("#!/bin/sh\necho '{entry}'\n{rest}\n").into_bytes();
    let red = entry("\\u001b[31mred");
    let answers = "while read c n; do for i in $(seq $n); do read l; done; printf 'error \\033[31mred\\n'; done";
    let again = format!("#!/bin/sh\n'{}' --plugin \"$0\" list\n", pathwarp_program().display());
    let folder = Folder::with(&[
        ("a.svg", &svg(RECT)),
        ("red", &script(&red, answers)),
        ("answers", &script(&entry("Evil"), answers)),
        ("again", again.as_bytes()),
    ]);
    for name in ["red", "answers", "again"] {
        fs::set_permissions(folder.path().join(name), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let said = |line: &str| {
        let done = shell(&folder, &format!("{line} 2>&1"));
        let text = String::from_utf8(done.stdout).unwrap();
        assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{line}: {text:?}");
        (done.status.code(), text)
    };
    let (code, text) = said("pathwarp --plugin ./red help evil");
    assert_eq!((code, text.contains("holds control characters")), (Some(3), true), "{text}");
    assert_eq!(said("pathwarp check ./answers").0, Some(1));
    let (code, text) = said("pathwarp --plugin ./again list");
    assert_eq!((code, text.contains("without end")), (Some(3), true), "{text}");
}
