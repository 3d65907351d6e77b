//! Shapes by name as path references, and words set in them.

use super::common::text;
use crate::support::{expect_code, pathwarp_in};
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point, Rect, Shape as _};
use pathwarp_svg::{Document, ReadOptions};
use std::fs;
use std::path::Path;

/// A block without letters, 200 by 40.
const BLOCK: &str =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 300'><path id='b' d='M20,30H220V70H20Z'/></svg>";
/// A file with one path, a square.
const SQUARE: &str =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='s' d='M10,10H60V60H10Z'/></svg>";

/// The outlines of a drawing without guides.
#[track_caller]
fn drawn(svg: &[u8]) -> Outline {
    let doc = Document::read(svg, "svg", &ReadOptions::default()).unwrap();
    let subpaths = doc.shapes().iter().filter(|s| s.id != "heart").flat_map(|s| s.outline.subpaths.clone());
    Outline { subpaths: subpaths.collect() }
}

/// Returns the box of the block put into a shape, with the messages.
#[track_caller]
fn put(folder: &Path, shape: &str, artwork: &str) -> (Rect, String) {
    let out = pathwarp_in(folder, &["envelope", "-", "--envelope", shape], artwork.as_bytes());
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{shape}: {said}");
    (drawn(&out.stdout).bounding_box().unwrap(), said)
}

fn is_near(a: Rect, b: Rect) -> bool {
    [a.x0 - b.x0, a.y0 - b.y0, a.x1 - b.x1, a.y1 - b.y1].iter().all(|d| d.abs() < 0.1)
}

/// A block fills its shape, whose box is known: as wide as the block, about its middle, and as high as the ratio requires.
#[test]
fn a_shape_is_as_wide_as_the_artwork_and_has_its_ratio() {
    let dir = tempfile::tempdir().unwrap();
    for (shape, [w, h]) in [
        ("circle", [200.0, 200.0]),
        ("leaf,ratio=2.5", [200.0, 80.0]),
        ("diamond,width=1in", [96.0, 76.8]),
        ("egg,width=50%,ratio=0.5", [100.0, 200.0]),
    ] {
        let (is, _) = put(dir.path(), shape, BLOCK);
        assert!(is_near(is, Rect::from_center_size((120.0, 50.0), (w, h))), "{shape}: {is}");
    }
}

/// A file or a path of that name takes precedence.
#[test]
fn files_and_ids_win_over_names() {
    let dir = tempfile::tempdir().unwrap();
    let own = BLOCK.replace("<path", "<path id='heart' d='M0,0H30V60H0Z'/><path");
    let (is, _) = put(dir.path(), "heart", &own);
    // The guide stays in the drawing, and the block is put into it.
    assert!(is_near(is, Rect::new(0.0, 0.0, 30.0, 60.0)), "{is}");
    fs::write(dir.path().join("heart"), SQUARE).unwrap();
    let (is, _) = put(dir.path(), "heart", BLOCK);
    assert!(is_near(is, Rect::new(10.0, 10.0, 60.0, 60.0)), "{is}");
    let (is, _) = put(dir.path(), "circle:r=30,cx=50,cy=60", BLOCK);
    assert!(is_near(is, Rect::new(20.0, 30.0, 80.0, 90.0)), "{is}");
}

/// A recipe keeps the name, in any folder.
#[test]
fn recipes_hold_the_name_of_a_shape() {
    let dir = tempfile::tempdir().unwrap();
    let recipe = dir.path().join("recipes/egg.toml");
    fs::create_dir(recipe.parent().unwrap()).unwrap();
    let write = ["envelope", "-", "--envelope", "egg", "--write-recipe", recipe.to_str().unwrap()];
    let first = pathwarp_in(dir.path(), &write, BLOCK.as_bytes());
    assert!(first.status.success() && fs::read_to_string(&recipe).unwrap().contains("\"egg\""));
    let second = pathwarp_in(dir.path(), &["run", "recipes/egg.toml", "-"], BLOCK.as_bytes());
    assert_eq!(text(&first.stdout), text(&second.stdout));
}

/// Lists and messages give the names, and misspelt ones are corrected.
#[test]
fn names_are_told() {
    let (help, _) = expect_code(0, &["help", "heart"]);
    assert!(help.contains("--envelope heart"), "{help}");
    let (completions, _) = expect_code(0, &["completions", "bash"]);
    assert!(completions.contains("semicircle crescent"));
    let (all, _) = expect_code(0, &["--help"]);
    assert!(all.contains("heart,ratio=1.2") && all.contains("crescent badge"), "{all}");
    let slip = |shape| expect_code(3, &["text", "A", "--in", shape]).1;
    assert!(slip("hart").contains("did you mean heart?") && slip("Sheild").contains("did you mean shield?"));
    assert!(!slip("hart.svg").contains("did you mean"));
    let (_, said) = expect_code(2, &["text", "A", "--in", "heart,size=3"]);
    assert!(said.contains("write heart,ratio=1.2"), "{said}");
}

/// Letters set in a shape lie in it and reach its sides; the page holds them and the margin, and has the unit of the size.
#[test]
fn words_are_set_in_a_shape() {
    let dir = tempfile::tempdir().unwrap();
    let margin = 5.0;
    for shape in ["circle", "leaf", "egg"] {
        let named = format!("{shape},width=90mm,ratio=1.2");
        let args = ["text", "MUSIC", "--in", &named, "--size", "20mm", "--margin", "5mm", "-o", "-"];
        let out = pathwarp_in(dir.path(), &args, b"");
        assert!(out.status.success(), "{}", text(&out.stderr));
        let svg = text(&out.stdout);
        let letters = drawn(svg.as_bytes());
        let page: Vec<f64> = svg
            .split("viewBox=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .split(' ')
            .map(|n| n.parse().unwrap())
            .collect();
        assert!(svg.contains(&format!("width=\"{}mm\"", page[2])), "{svg:.200}");
        let ink = letters.bounding_box().unwrap();
        let held = Rect::from_origin_size((page[0], page[1]), (page[2], page[3])).inset(-margin);
        assert!(is_near(ink, held), "{shape}: {ink} {held}");
        assert!((ink.height() - 75.0).abs() < 3.0 && ink.width() > 75.0 && ink.width() < 90.1, "{shape}: {ink}");
        let sheet = fs::read_to_string(crate::support::sample("shapes.svg")).unwrap();
        let data = sheet.split(&format!("id=\"{shape}\" d=\"")).nth(1).unwrap().split('"').next().unwrap();
        let path = Outline::from_svg(data).unwrap();
        let bounds = path.bounding_box().unwrap();
        // The middle of the shape is that of the word, whose ink touches the top and the bottom of the shape.
        let onto = Affine::translate(Point::new(0.5 * (ink.x0 + ink.x1), 0.5 * (ink.y0 + ink.y1)).to_vec2())
            * Affine::scale_non_uniform(91.0 / bounds.width(), 76.5 / bounds.height())
            * Affine::translate(-bounds.center().to_vec2());
        let path = path.transformed(onto).to_bez_path(1e-3);
        let outside = letters.segs().flat_map(|s| [0.0, 0.5].map(|t| s.eval(t))).filter(|p| !path.contains(*p)).count();
        assert_eq!(outside, 0, "{shape}");
    }
}
