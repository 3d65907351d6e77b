//! Input and output: standard streams, devices, folders, formats.

use super::common::{CAGE, SQUARE, text};
use crate::support::{artwork, expect_code, pathwarp_in, sample};
use std::fs;
use std::path::Path;

#[test]
fn standard_input_to_standard_output() {
    let dir = tempfile::tempdir().unwrap();
    for args in [&["shaper", "--shaper", CAGE][..], &["shaper", "--shaper", CAGE, "-", "-o", "-"]] {
        let out = pathwarp_in(dir.path(), args, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        assert!(text(&out.stdout).contains("id='s'"));
        assert!(out.stderr.is_empty(), "silent on success: {}", text(&out.stderr));
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn a_drawing_is_not_written_under_a_pictures_name() {
    let dir = tempfile::tempdir().unwrap();
    let out = pathwarp_in(dir.path(), &["affine", "-o", "out.png", "--rotate", "30"], SQUARE.as_bytes());
    assert_eq!(out.status.code(), Some(2), "{}", text(&out.stderr));
    assert!(text(&out.stderr).contains("out.png: a drawing is written as SVG"), "{}", text(&out.stderr));
    assert!(!dir.path().join("out.png").exists());
}

/// The extension selects the format; one that cannot be written is an error.
#[test]
fn unknown_extensions_are_errors() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), SQUARE).unwrap();
    fs::write(dir.path().join("a.drawing"), SQUARE).unwrap();
    for (args, part) in [
        (&["affine", "a.svg", "-o", "o.doc"][..], "SVG, PDF or DXF (.svg, .svgz, .pdf, .dxf)"),
        (&["affine", "a.svg", "-o", "o.svg", "--preview", "o.bmp"], ".png"),
        (&["render", "a.svg", "-o", "o.tiff"], ".png"),
        (&["gallery", "a.svg", "-o", "o.dxf"], "SVG, PDF, PNG, JPEG or WebP"),
        (&["text", "a", "-o", "o.ttf"], ".svg"),
        (&["convert", "a.svg", "-o", "o.doc"], ".json, .xcf"),
    ] {
        let out = pathwarp_in(dir.path(), args, b"");
        assert_eq!(out.status.code(), Some(2), "{args:?}: {}", text(&out.stderr));
        assert!(text(&out.stderr).contains(part), "{args:?}: {}", text(&out.stderr));
    }
    for args in [
        &["affine", "a.svg", "-o", "plain"][..],
        &["affine", "a.svg", "-o", "o.SVG"],
        &["affine", "a.drawing", "--out-dir", "out"],
    ] {
        let out = pathwarp_in(dir.path(), args, b"");
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 5);
}

/// Renaming a file over a device such as `/dev/null` would replace the device.
#[cfg(unix)]
#[test]
fn pipes_and_links_stay_what_they_are() {
    use std::os::unix::fs::FileTypeExt;
    let folder = tempfile::tempdir().unwrap();
    let (pipe, link, file) =
        (folder.path().join("pipe"), folder.path().join("link.svg"), folder.path().join("file.svg"));
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || fs::read(pipe).unwrap()
    });
    let warp = |to: &Path| {
        let (input, to) = (sample("icon.svg"), to.to_str().unwrap());
        let out = pathwarp_in(folder.path(), &["swirl", input.to_str().unwrap(), "-o", to], b"");
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    };
    warp(&pipe);
    let piped = reader.join().unwrap();
    assert!(piped.starts_with(b"<"));
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    fs::write(&file, "old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    warp(&link);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&file).unwrap(), piped);
}

#[test]
fn several_inputs_go_to_a_folder_and_threads_change_nothing() {
    let inputs: Vec<String> = artwork().iter().map(|n| sample(n).display().to_string()).collect();
    let cage = sample("cages.svg").display().to_string() + "#flag";
    let run = |jobs: &str, dir: &Path| {
        let mut args: Vec<&str> =
            vec!["shaper", "--shaper", &cage, "--jobs", jobs, "--quiet", "--out-dir", dir.to_str().unwrap()];
        args.extend(inputs.iter().map(String::as_str));
        // The flag leaves the pages of small drawings without artwork.
        expect_code(1, &args);
    };
    let dir = tempfile::tempdir().unwrap();
    let (one, four) = (dir.path().join("one"), dir.path().join("four"));
    run("1", &one);
    run("4", &four);
    for name in artwork() {
        let bytes = fs::read(one.join(&name)).unwrap();
        assert!(!bytes.is_empty() && bytes == fs::read(four.join(&name)).unwrap(), "{name}");
    }
    let (_, said) = expect_code(2, &["shaper", &inputs[0], &inputs[1], "--shaper", &cage]);
    assert!(said.contains("--out-dir"), "{said}");
}
