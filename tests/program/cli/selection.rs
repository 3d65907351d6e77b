//! `--select` and `--exclude` without a match, and drawings with nothing to warp, are reported.

use super::common::{SQUARE, text};
use crate::support::{pathwarp_in, sample};

const DRAWING: &str = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
                       viewBox='0 0 100 100'><defs><path id='spare' d='M0,0H9'/></defs><g id='empty'/><g id='logo' \
                       class='brand main' inkscape:label='The logo'><rect width='9' height='9'/></g><circle id='dot' r='9'/></svg>";

#[test]
fn selectors_without_a_match_are_errors_with_likely_names() {
    let dir = tempfile::tempdir().unwrap();
    let run = |options: &[&str]| {
        let out = pathwarp_in(dir.path(), &[&["swirl", "-o", "out.svg"][..], options].concat(), DRAWING.as_bytes());
        (out.status.code(), text(&out.stderr))
    };
    for (options, parts) in [
        (["--select", "#lego"], ["nothing matches `#lego`", "names are #logo"]),
        (["--exclude", "#lego"], ["nothing matches `#lego`", "names are #logo"]),
        (["--select", "The lgo"], ["nothing matches `The lgo`", "names are The logo"]),
        (["--select", ".brend"], ["nothing matches `.brend`", "names are .brand, .main"]),
        (["--select", "polygon"], ["nothing matches `polygon`", "names are "]),
        (["--select", "#empty"], ["`#empty`", "holds nothing that is painted"]),
        (["--select", "#spare"], ["`#spare`", "holds nothing that is painted"]),
    ] {
        let (code, said) = run(&options);
        assert_eq!(code, Some(3), "{options:?}: {said}");
        assert!(parts.iter().all(|p| said.contains(p)), "{options:?}: {said}");
        assert!(!dir.path().join("out.svg").exists());
    }
    for options in [["--select", "#logo"], ["--select", "The logo"], ["--select", ".main"], ["--exclude", "#spare"]] {
        let (code, said) = run(&options);
        assert_eq!(code, Some(0), "{options:?}: {said}");
    }
}

#[test]
fn paths_of_a_gimp_file_too() {
    let dir = tempfile::tempdir().unwrap();
    let made = pathwarp_in(dir.path(), &["convert", sample("cages.svg").to_str().unwrap(), "-o", "c.xcf"], b"");
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    let out = pathwarp_in(dir.path(), &["swirl", "c.xcf", "--select", "flog", "-o", "out.svg"], b"");
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(3), "{said}");
    assert!(said.contains("flog") && said.contains("flag"), "{said}");
}

#[test]
fn a_drawing_with_nothing_to_warp_is_1() {
    let dir = tempfile::tempdir().unwrap();
    let empty = SQUARE.replace("<path id='s' d='M0,0H100V100H0Z'/>", "<defs><path id='s' d='M0,0H9'/></defs>");
    assert_ne!(empty, SQUARE);
    let out = pathwarp_in(dir.path(), &["warp", "--style", "flag"], empty.as_bytes());
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    assert!(text(&out.stderr).contains("nothing to warp"), "{}", text(&out.stderr));
    assert_eq!(text(&out.stdout), empty);
    // An image is artwork, too.
    let pixel = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==";
    let image = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><image id='i' width='9' height='9' href='{pixel}'/></svg>"
    );
    for options in [&[][..], &["--select", "#i"]] {
        let out =
            pathwarp_in(dir.path(), &[&["warp", "--style", "flag", "-q"][..], options].concat(), image.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{options:?}: {}", text(&out.stderr));
    }
}
