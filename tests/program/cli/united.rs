//! `unite` as a command, in recipes and chains, and by `text --unite`.

use super::common::text;
use crate::support::{pathwarp_in, root};
use std::path::Path;

fn run(args: &[&str], input: &str) -> (Option<i32>, String, String) {
    let out = pathwarp_in(Path::new("."), args, input.as_bytes());
    (out.status.code(), text(&out.stdout), text(&out.stderr))
}

const CROSS: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 90 90'><path id='a' d='M30,0H60V90H30Z'/><path id='b' d='M0,30H90V60H0Z'/></svg>";

#[test]
fn a_command_a_step_and_a_recipe_unite_alike() {
    let (code, one, said) = run(&["unite", "-"], CROSS);
    assert_eq!((code, said.as_str()), (Some(0), "note: 2 shapes became 1: a, b\n"), "{one}");
    assert!(one.contains("data-united=\"a b\"") && one.matches("<path").count() == 1, "{one}");
    let dir = tempfile::tempdir().unwrap();
    let recipe = dir.path().join("r.toml").display().to_string();
    let (_, bent, _) = run(&["unite", "-", "--write-recipe", &recipe, "+", "offset", "--by", "2"], CROSS);
    assert_eq!(run(&["offset", "-", "--by", "2"], &one).1, bent);
    assert_eq!(run(&["run", &recipe, "-"], CROSS).1, bent);
    let (_, report, _) =
        run(&["unite", "-", "-o", &dir.path().join("o.svg").display().to_string(), "--report", "-"], CROSS);
    assert!(report.replace([' ', '\n'], "").contains("\"united\":[\"a\",\"b\"]"), "{report}");
    for (wrong, input, part) in [
        (
            &["unite", "-"][..],
            CROSS.replace("path id", "path fill='none' stroke='red' id"),
            "nothing to unite: no shape has a fill",
        ),
        (&["unite", "-", "--select", "#a"], CROSS.to_owned(), "nothing to unite: each shape stands alone"),
        (&["unite", "-", "--by", "colour"], CROSS.to_owned(), "fill"),
    ] {
        let (_, _, said) = run(wrong, &input);
        assert!(said.contains(part) && said.lines().count() <= 2, "{wrong:?}: {said}");
    }
}

/// Letters of a script join, and the word stays readable.
#[test]
fn letters_become_a_word() {
    let font = root().join("crates/pathwarp-text/tests/fonts/arabic.ttf").display().to_string();
    let set = |more: &[&str]| run(&[&["text", "سلام", "--font", &font, "--size", "20mm"], more].concat(), "");
    let (apart, one) = (set(&[]).1, set(&["--unite"]));
    assert!(apart.matches("<path").count() > 1, "{apart}");
    assert_eq!((one.0, one.1.matches("<path").count()), (Some(0), 1), "{}", one.2);
    assert!(one.1.contains("aria-label=\"سلام\"") && one.1.contains("mm\""), "{}", one.1);
    let dxf = set(&["--unite", "--format", "dxf"]).1;
    assert!(dxf.matches("\nSPLINE").count() + dxf.matches("\nLWPOLYLINE").count() < 6, "{dxf}");
}
