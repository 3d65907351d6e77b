//! Sources are not overwritten by accident, two outputs are not one file, and files that belong together appear together.

use super::common::{CAGE, SQUARE, files_below, text};
use crate::support::pathwarp_in;
use std::fs;
use std::path::Path;

fn drawings(folder: &Path) {
    for name in ["a.svg", "b.svg"] {
        fs::write(folder.join(name), SQUARE).unwrap();
    }
    let cage = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='c' d='{CAGE}'/></svg>");
    fs::write(folder.join("cage.svg"), cage).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("a.svg", folder.join("link.svg")).unwrap();
    #[cfg(not(unix))]
    fs::copy(folder.join("a.svg"), folder.join("link.svg")).unwrap();
}

/// Every file with its content.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    files_below(folder).into_iter().map(|f| (f.clone(), fs::read(folder.join(f)).unwrap())).collect()
}

#[test]
fn an_output_that_is_a_source_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    drawings(dir.path());
    fs::write(dir.path().join("r.toml"), "pathwarp = 1\n[[step]]\ndeformation = \"swirl\"\n").unwrap();
    let here = dir.path().file_name().unwrap().to_str().unwrap();
    let around = format!("../{here}/./a.svg");
    let before = contents(dir.path());
    let swirl = ["swirl", "a.svg"];
    for (args, named) in [
        (&[&swirl[..], &["-o", "a.svg"]].concat()[..], "a.svg"),
        (&[&swirl[..], &["-o", &around]].concat(), "a.svg"),
        #[cfg(unix)]
        (&[&swirl[..], &["-o", "link.svg"]].concat(), "a.svg"),
        #[cfg(unix)]
        (&["swirl", "link.svg", "-o", "a.svg"], "link.svg"),
        (&["swirl", "a.svg", "b.svg", "--out-dir", "."], "a.svg"),
        (&[&swirl[..], &["-o", "o.svg", "--report", "a.svg"]].concat(), "a.svg"),
        (&[&swirl[..], &["-o", "o.svg", "--preview", "a.svg"]].concat(), "a.svg"),
        (&[&swirl[..], &["-o", "o.svg", "--write-recipe", "a.svg"]].concat(), "a.svg"),
        (&["shaper", "a.svg", "--shaper", "cage.svg#c", "-o", "cage.svg"], "cage.svg"),
        // --in-place does not cover a cage.
        (&["shaper", "a.svg", "--shaper", "cage.svg#c", "-o", "cage.svg", "--in-place"], "cage.svg"),
        (&["run", "r.toml", "a.svg", "-o", "r.toml"], "r.toml"),
        (&["run", "r.toml", "a.svg", "-o", "o.svg", "--write-recipe", "r.toml"], "r.toml"),
        (&["ffd", "a.svg", "-o", "o.svg", "--save-lattice", "a.svg"], "a.svg"),
        (&["render", "a.svg", "-o", "a.svg"], "a.svg"),
        (&["convert", "a.svg", "-o", "a.svg"], "a.svg"),
        (&["unwarp", "a.svg", "-o", "a.svg"], "a.svg"),
        (&["gallery", "a.svg", "-o", "a.svg"], "a.svg"),
        (&["text", "--file", "a.svg", "-o", "a.svg"], "a.svg"),
    ] {
        let out = pathwarp_in(dir.path(), args, b"");
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains(named) && said.contains("would be overwritten"), "{args:?}: {said}");
        assert!(contents(dir.path()) == before, "{args:?}");
    }
}

#[test]
fn in_place_overwrites_the_inputs_and_keeps_links() {
    let dir = tempfile::tempdir().unwrap();
    drawings(dir.path());
    let swirled = pathwarp_in(dir.path(), &["swirl", "--fit", "none", "a.svg"], b"").stdout;
    assert!(swirled != SQUARE.as_bytes());
    for args in [&["swirl", "link.svg", "b.svg", "--in-place"][..], &["swirl", "a.svg", "-o", "link.svg", "--in-place"]]
    {
        fs::write(dir.path().join("a.svg"), SQUARE).unwrap();
        let out = pathwarp_in(dir.path(), args, b"");
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        assert!(out.stdout.is_empty());
        assert!(fs::read(dir.path().join("a.svg")).unwrap() == swirled, "{args:?}");
        #[cfg(unix)]
        assert!(fs::symlink_metadata(dir.path().join("link.svg")).unwrap().is_symlink());
    }
    assert!(fs::read(dir.path().join("b.svg")).unwrap() == swirled);
    let piped = pathwarp_in(dir.path(), &["swirl", "--in-place"], SQUARE.as_bytes());
    assert_eq!(piped.status.code(), Some(2), "{}", text(&piped.stderr));
}

#[test]
fn two_outputs_are_not_one_file() {
    let dir = tempfile::tempdir().unwrap();
    drawings(dir.path());
    fs::create_dir(dir.path().join("sub")).unwrap();
    fs::write(dir.path().join("sub/a.svg"), SQUARE).unwrap();
    let before = contents(dir.path());
    for args in [
        &["swirl", "a.svg", "-o", "o.svg", "--report", "./o.svg"][..],
        &["swirl", "a.svg", "-o", "o.svg", "--preview", "sub/../o.svg"],
        &["swirl", "a.svg", "-o", "o.svg", "--report", "r", "--write-recipe", "r"],
        &["swirl", "a.svg", "--report", "-"],
        &["swirl", "a.svg", "sub/a.svg", "--out-dir", "out"],
        &["swirl", "a.svg", "b.svg", "--out-dir", "out", "--report", "out/b.svg"],
        &["ffd", "a.svg", "-o", "o.svg", "--save-lattice", "o.svg"],
    ] {
        let out = pathwarp_in(dir.path(), args, b"");
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains("give each output its own"), "{args:?}: {said}");
        assert!(contents(dir.path()) == before, "{args:?}");
    }
}

#[test]
fn a_minus_is_standard_output_for_reports_previews_and_recipes() {
    let dir = tempfile::tempdir().unwrap();
    drawings(dir.path());
    for (option, start) in [
        ("--report", &b"{\n  \"tool\": \"pathwarp\""[..]),
        ("--write-recipe", b"pathwarp = 1"),
        ("--preview", b"\x89PNG"),
    ] {
        let out = pathwarp_in(dir.path(), &["swirl", "a.svg", "-o", "o.svg", option, "-"], b"");
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        assert!(out.stdout.starts_with(start), "{option}: {}", text(&out.stdout));
        assert!(!dir.path().join("-").exists());
    }
}

/// The name of the second file is too long for any file system, which only shows when the finished file is renamed.
#[test]
fn files_that_belong_together_appear_together() {
    let dir = tempfile::tempdir().unwrap();
    let long = "n".repeat(300);
    let svg = SQUARE.replace("</svg>", &format!("<path id='new' d='M0,0H9'/><path id='{long}' d='M0,0H9'/></svg>"));
    fs::write(dir.path().join("art.svg"), svg).unwrap();
    fs::write(dir.path().join("out-s.svg"), "precious").unwrap();
    let before = contents(dir.path());
    let out = pathwarp_in(dir.path(), &["convert", "art.svg", "-o", "out.svg", "--split"], b"");
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(5), "{said}");
    assert!(said.contains("cannot be written"), "{said}");
    assert!(contents(dir.path()) == before, "{:?}", files_below(dir.path()));
    // The result appears only with its report.
    let report = format!("{long}.json");
    let out = pathwarp_in(dir.path(), &["swirl", "art.svg", "-o", "out-s.svg", "--report", &report], b"");
    assert_eq!(out.status.code(), Some(5), "{}", text(&out.stderr));
    assert!(contents(dir.path()) == before, "{:?}", files_below(dir.path()));
}

#[test]
fn an_output_that_cannot_be_written_is_5() {
    let dir = tempfile::tempdir().unwrap();
    drawings(dir.path());
    fs::create_dir(dir.path().join("folder")).unwrap();
    for to in ["folder", "nowhere/o.svg", "a.svg/o.svg"] {
        for args in [&["swirl", "b.svg", "-o", to][..], &["text", "b", "-o", to]] {
            let out = pathwarp_in(dir.path(), args, b"");
            assert_eq!(out.status.code(), Some(5), "{args:?}: {}", text(&out.stderr));
        }
    }
    let out = pathwarp_in(dir.path(), &["swirl", "b.svg", "--out-dir", "a.svg"], b"");
    assert_eq!(out.status.code(), Some(5), "{}", text(&out.stderr));
}
