//! Styles, text shapes, meshes and the gallery through the program: user files, Photoshop files, sheets.

use crate::support::expect_code;
use std::fs;

/// A style in a TOML file equals the built-in one, and errors name the file.
#[test]
fn styles_and_shapes_come_from_toml_files() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let flag = "name = \"mine\"\nfamily = \"points\"\n\n[[moves]]\nat = \"*,1\"\ny = \"2*b*h\"\n[[moves]]\nat = \"*,2\"\ny = \"-2*b*h\"\n";
    fs::write(at("mine.toml"), flag).unwrap();
    let (own, _) =
        expect_code(0, &["warp", "samples/logo.svg", "--style", &at("mine.toml"), "--bend", "30%", "-o", "-"]);
    let (ours, _) = expect_code(0, &["warp", "samples/logo.svg", "--style", "warpFlag", "--bend", "30%", "-o", "-"]);
    assert!(own == ours && own.contains("<svg"));

    let hill = "name = \"hill\"\nadj = [{ name = \"adj\", default = 50000, least = 0, most = 100000 }]\n\
                bands = [[\"M 0,adj*h/100000 L w/2,0 w,adj*h/100000\", \"M 0,h L w,h\"]]\n";
    fs::write(at("hill.toml"), hill).unwrap();
    let (own, _) =
        expect_code(0, &["wordart", "samples/icon.svg", "--preset", &at("hill.toml"), "--adj", "70%", "-o", "-"]);
    let (ours, _) =
        expect_code(0, &["wordart", "samples/icon.svg", "--preset", "Triangle Up", "--adj", "70%", "-o", "-"]);
    assert!(own == ours && own.contains("<svg"));

    fs::write(at("bad.toml"), "name = ").unwrap();
    for (code, style, part) in
        [(3, at("bad.toml"), "bad.toml"), (3, at("none.toml"), "none.toml"), (2, "nonsense".into(), "arc-lower")]
    {
        let (_, err) = expect_code(code, &["warp", "samples/logo.svg", "--style", &style, "-o", &at("never.svg")]);
        assert!(err.contains(part), "{err}");
        assert!(!dir.path().join("never.svg").exists());
    }
    // A recipe finds the file relative to its folder.
    expect_code(
        0,
        &["warp", "samples/logo.svg", "--style", &at("mine.toml"), "-o", &at("a.svg"), "--write-recipe", &at("r.toml")],
    );
    expect_code(0, &["run", &at("r.toml"), "samples/logo.svg", "-o", &at("b.svg")]);
    assert_eq!(fs::read(at("a.svg")).unwrap(), fs::read(at("b.svg")).unwrap());
}

/// The warp of a Photoshop layer gives the style of that name, or its points.
#[test]
fn photoshop_files_bend_as_their_layers() {
    use crate::support::psd::{block, layer, object, placed, points, smart, tagged, warp};
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let arch =
        layer(false, "Arch", &[block("SoLd", smart(&[("warp", tagged("Objc", warp("warpArch", 40.0, vec![])))]))]);
    let (x, y): (Vec<f64>, Vec<f64>) = (0..16)
        .map(|k| (20.0 + 40.0 * f64::from(k % 4), 10.0 + 20.0 * f64::from(k / 4) + if k == 6 { 12.0 } else { 0.0 }))
        .unzip();
    let custom = object("customEnvelopeWarp", &[("meshPoints", points(&x, &y))]);
    let custom = warp("warpCustom", 0.0, vec![("customEnvelopeWarp", tagged("Objc", custom))]);
    let custom = layer(false, "Points", &[block("PlLd", placed(custom))]);
    fs::write(at("both.psd"), crate::support::psd::file(false, &[arch, custom])).unwrap();

    let run = |more: &[&str]| {
        [&["mesh", "samples/logo.svg", "--psd", &at("both.psd"), "-o", "-"], more]
            .concat()
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
    };
    let (_, err) = expect_code(3, &run(&[]));
    assert!(err.contains("--layer") && err.contains("`Points`"), "{err}");
    let (ours, _) = expect_code(0, &run(&["--layer", "Arch"]));
    let style =
        ["--style", "arch", "--bend", "40%", "--axis", "vertical", "--horizontal", "5%", "--vertical=-7%", "-o", "-"];
    let (theirs, _) = expect_code(0, &[&["warp", "samples/logo.svg"][..], &style].concat());
    assert!(ours == theirs && ours.contains("<svg"));
    // One inner point moved down by a fifth of the height equals a lattice of degree 3 by 3 with that point moved.
    let (ours, _) = expect_code(0, &run(&["--layer", "Points"]));
    fs::write(at("a.svg"), ours).unwrap();
    expect_code(0, &["ffd", "samples/logo.svg", "--degree", "3x3", "--move", "2,1:0,20%", "-o", &at("b.svg")]);
    let (json, _) = expect_code(0, &["compare", "--json", &at("a.svg"), &at("b.svg")]);
    let off = serde_json::from_str::<serde_json::Value>(&json).unwrap()["max_distance"].as_f64().unwrap();
    // Both are within the default tolerance, 1e-4 of the diagonal of 605.
    assert!(off < 0.13, "{off}");

    fs::write(at("broken.psd"), b"8BPS\0\x01oh").unwrap();
    let (_, err) = expect_code(3, &["mesh", "samples/logo.svg", "--psd", &at("broken.psd")]);
    assert!(err.contains("broken.psd") && err.contains("byte"), "{err}");
}

/// A sheet has a cell for the artwork and one per style or shape, is reproducible, and is written completely or not at all.
#[test]
fn the_gallery_shows_every_style() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let (svg, _) = expect_code(0, &["gallery", "samples/badge.svg"]);
    assert_eq!(svg.matches("<g id=\"cell-").count(), 16);
    assert!(!svg.contains("<text") && svg.contains("<title>shell-lower</title>"));
    assert_eq!(svg, expect_code(0, &["gallery", "samples/badge.svg"]).0);
    expect_code(
        0,
        &["gallery", "samples/icon.svg", "--all", "--columns", "8", "--cell", "80x70", "-o", &at("all.svg")],
    );
    let all = fs::read_to_string(at("all.svg")).unwrap();
    assert_eq!(all.matches("<g id=\"cell-").count(), 80);
    assert!(all.contains("width=\"784\""), "{}", &all[..200]);
    for bad in [&["--bend", "300%"][..], &["--cell", "5x5"], &["--columns", "0"], &["--bend", "much"]] {
        let never = at("never.svg");
        let args = [&["gallery", "samples/icon.svg", "-o", &never], bad].concat();
        expect_code(2, &args);
        assert!(!dir.path().join("never.svg").exists());
    }
}

/// Words stand in every family that has all their letters, each under its name.
#[test]
fn words_in_every_font() {
    let font = "crates/pathwarp-text/tests/fonts/hebrew.ttf";
    let labels = |words: &str| {
        let args = ["gallery", "--fonts", words, "--no-system-fonts", "--font-file", font];
        let (sheet, said) = expect_code(0, &args);
        assert_eq!(said, "");
        let titles = sheet.split("<title>").skip(1).map(|t| t.split('<').next().unwrap().to_owned());
        titles.collect::<Vec<String>>()
    };
    assert_eq!(labels("Old Bakery"), ["Noto Sans", "display"]);
    assert_eq!(labels("שלום").len(), 1);
    assert!(expect_code(2, &["gallery", "--fonts", "日本", "--no-system-fonts"]).1.contains("no installed family has"));
    expect_code(2, &["gallery", "--fonts", "a", "samples/logo.svg"]);
    expect_code(2, &["gallery"]);
}
