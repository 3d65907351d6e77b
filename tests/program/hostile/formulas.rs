//! Maps that oscillate, tolerances that cannot be met, numbers of threads.

use super::bounded::{Folder, RECT, svg};
use crate::support::sample;
use std::fs;

#[test]
fn oscillations_end_by_the_budget() {
    let folder = Folder::with(&[("a.svg", &fs::read(sample("logo.svg")).unwrap())]);
    for args in [
        &["expr", "--x", "x+20*sin(x*200)", "--y", "y"][..],
        &["expr", "--x", "x+20*sin(x*20000)", "--y", "y+tan(x*y)", "--certify"],
        &["wave", "--length", "0.01"],
        &["wave", "--length", "0.001", "--amount", "50"],
        &["swirl", "--angle", "1e9"],
        &["swirl", "--angle", "1e6", "--strokes", "outline", "--tolerance", "1e-9", "--certify"],
    ] {
        let (code, said) = folder.run(&[args, &["a.svg", "-o", "o.svg"]].concat());
        assert_ne!(code, 0, "{args:?}");
        assert!(code == 1 || said.contains("--limit") || code == 2, "{args:?}: {said}");
    }
}

#[test]
fn a_tolerance_below_rounding_is_refused() {
    let folder = Folder::with(&[("a.svg", &svg(RECT))]);
    for tolerance in ["1e-300", "1e-15"] {
        let (code, said) = folder.run(&["swirl", "a.svg", "-o", "o.svg", "--tolerance", tolerance]);
        assert_eq!((code, said.contains("--tolerance")), (2, true), "{said}");
    }
    assert_eq!(folder.run(&["swirl", "a.svg", "-o", "o.svg", "--tolerance", "1e-9"]).0, 0);
}

#[test]
fn any_number_of_threads_is_taken() {
    let folder = Folder::with(&[("a.svg", &svg(RECT))]);
    assert_eq!(folder.run(&["swirl", "a.svg", "-o", "o.svg", "--jobs", "65535"]).0, 0);
}

#[test]
fn huge_coordinates_and_pins_end() {
    let folder = Folder::with(&[("a.svg", &svg(RECT))]);
    let long = format!("M0 0{}", "c9 9 9-9 1 1".repeat(3000));
    for args in [
        &["mls", "--pair", "1e300,0:5,5", "--pin", "0,0"][..],
        &["mls", "--pair", "1e15,0:5,5", "--pin", "0,0", "--pair", "3,3:-1e18,8"],
        &["bend", "--along", "M0 0C 1e300 0 5 5 1 1"],
        &["bend", "--along", &long],
        &["shaper", "--shaper", "M0 0L1e200 0L1e200 1e200L0 1e200Z"],
        &["affine", "--matrix", "1e200,0,0,1e200,0,0"],
        &["affine", "--matrix", "1e12,0,0,1e12,0,0", "--preview", "p.png"],
        &["projective", "--target", "0,0 1e99,0 1e99,1e99 0,1e99"],
    ] {
        folder.run(&[args, &["a.svg", "-o", "o.svg"]].concat());
    }
}

/// The work of a map is counted by its parts.
#[test]
fn long_formulas_and_chains_end_by_the_budget() {
    let folder = Folder::with(&[("a.svg", &fs::read(sample("logo.svg")).unwrap())]);
    let sum = (1..300).map(|i| format!("+sin(x*{i})")).collect::<String>();
    let pairs: Vec<String> =
        (0..990).map(|i| format!("{},{}:{},{}", i, i * 7 % 100, i * 3 % 100, i * 11 % 100)).collect();
    let mls: Vec<&str> = ["mls"].into_iter().chain(pairs.iter().flat_map(|p| ["--pair", p])).collect();
    let waves: Vec<&str> = ["wave"].into_iter().chain(["+", "wave"].repeat(60)).collect();
    for args in [
        &["expr", "--x", &format!("x{sum}"), "--y", "y"][..],
        &[&mls[..], &["--tolerance", "1e-6"]].concat(),
        &waves,
        &["warp", "--style", "twist", "--bend", "1000%", "--inverse"],
    ] {
        let (code, said) = folder.run(&[args[..1].to_vec(), vec!["a.svg", "-o", "o.svg"], args[1..].to_vec()].concat());
        assert!([0, 1, 4].contains(&code) || said.contains("--limit") || code == 2, "{}: {code} {said}", args[0]);
    }
}

#[test]
fn names_in_recipes_are_counted() {
    let recipe = |names: usize| {
        let list = "'rect',".repeat(names);
        format!("pathwarp=1\n[options]\nselect=[{list}]\n[[step]]\ndeformation='wave'\n")
    };
    let many = svg(&RECT.repeat(9000));
    let (long, short) = (recipe(100_000), recipe(3));
    let folder = Folder::with(&[
        ("long.toml", long.as_bytes()),
        ("short.toml", short.as_bytes()),
        ("few.svg", &svg(RECT)),
        ("many.svg", &many),
    ])
    .ample();
    let (code, said) = folder.run(&["run", "long.toml", "many.svg", "-o", "o.svg"]);
    assert_eq!((code, said.contains("--limit work=")), (3, true), "{said}");
    folder.run(&["run", "long.toml", "few.svg", "-o", "o.svg"]);
    assert_eq!(folder.run(&["run", "short.toml", "many.svg", "-o", "o.svg"]).0, 0);
}
