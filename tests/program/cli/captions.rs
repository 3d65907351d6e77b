//! `caption` sets words on drawings: as a command, in recipes, and as a part that later steps select.

use super::common::text;
use crate::support::pathwarp_in;
use pathwarp::kurbo::{BezPath, Rect, Shape as _};
use resvg::usvg;
use std::path::Path;

fn run(args: &[&str], input: &str) -> (Option<i32>, String, String) {
    let out = pathwarp_in(Path::new("."), args, input.as_bytes());
    (out.status.code(), text(&out.stdout), text(&out.stderr))
}

const SHEET: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50' fill='none' stroke='red'><rect width='100' height='50' fill='#cde'/></svg>";

/// The boxes of the letters of the first caption, without the transform of its group.
fn letters(svg: &str) -> Vec<Rect> {
    let document = usvg::roxmltree::Document::parse(svg).unwrap();
    let group = document.descendants().find(|n| n.attribute("id") == Some("caption-1")).unwrap();
    let moved = group.attribute("transform").unwrap_or("translate(0 0)");
    let by: Vec<f64> = moved["translate(".len()..moved.len() - 1].split(' ').map(|v| v.parse().unwrap()).collect();
    let paths = group.descendants().filter_map(|n| n.attribute("d"));
    paths.map(|d| BezPath::from_svg(d).unwrap().bounding_box() + pathwarp::kurbo::Vec2::new(by[0], by[1])).collect()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

/// The capitals of the bundled Noto Sans are 714/1000 of the em high, and an H of a width of 741 reaches from 97 to 643 (the font's
/// tables head, hmtx and glyf).
#[test]
fn captions_stand_where_they_are_put() {
    let base =
        ["caption", "-", "--words", "H", "--words", "H", "--at", "20,40%", "--size", "10", "--line-height", "150%"];
    let of = |align: &str| letters(&run(&[&base[..], &["--align", align]].concat(), SHEET).1);
    let [left, middle, right] = ["left", "center", "right"].map(of);
    for all in [&left, &middle, &right] {
        assert!(all.len() == 2 && near(all[0].y1, 20.0) && near(all[0].height(), 7.14), "{all:?}");
        assert!(near(all[1].y1, 35.0) && near(all[1].x0, all[0].x0), "{all:?}");
    }
    let shifts = [left[0].x0 - 20.97, middle[0].center().x - 19.995, right[0].x1 - 19.02];
    assert!(shifts.iter().all(|v| near(*v, 0.0)), "{shifts:?}");
}

/// Properties that the root passes to its children do not affect the words; names and prefixes of the drawing stay.
#[test]
fn captions_are_set_on_any_drawing() {
    let words = ["caption", "-", "--words", "It's <&> \"it\"", "--fill", "#c30"];
    let (code, out, said) = run(&words, SHEET);
    assert_eq!((code, &*said), (Some(0), ""));
    let tree = usvg::Tree::from_str(&out, &usvg::Options::default()).unwrap();
    let usvg::Node::Group(group) = tree.node_by_id("caption-1").unwrap() else { panic!("{out}") };
    let mut nodes = group.children().to_vec();
    while let Some(node) = nodes.pop() {
        match node {
            usvg::Node::Group(g) => nodes.extend(g.children().iter().cloned()),
            usvg::Node::Path(p) => {
                assert!(p.stroke().is_none());
                assert!(
                    matches!(p.fill().unwrap().paint(), usvg::Paint::Color(c) if (c.red, c.green, c.blue) == (0xcc, 0x33, 0))
                );
            }
            other => panic!("{other:?}"),
        }
    }
    let own = SHEET.replace("<rect ", "<rect id=\"caption-1\" ");
    assert!(run(&words, &own).1.contains("id=\"caption--1\""));
    let prefixed =
        "<s:svg xmlns:s='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><s:rect width='9' height='9'/></s:svg>";
    let empty = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'/>";
    for drawing in [prefixed, empty] {
        let (_, out, said) = run(&words, drawing);
        let tree = usvg::Tree::from_str(&out, &usvg::Options::default()).expect(&said);
        assert!(tree.node_by_id("caption-1").is_some(), "{out}");
    }
}

/// A letter can be bent alone by its name. The recipe holds the words, and gives the same result. Captions come first in any order.
#[test]
fn captions_are_parts_and_words_in_recipes() {
    let dir = tempfile::tempdir().unwrap();
    let recipe = dir.path().join("r.toml").display().to_string();
    let line = ["caption", "-", "--words", "Fjord", "--at", "10,30", "--size", "20", "--write-recipe", &recipe];
    let moved = ["+", "affine", "--move-y", "5", "--select", "#caption-1-2"];
    let level = letters(&run(&line, SHEET).1);
    let (code, out, said) = run(&[&line[..], &moved].concat(), SHEET);
    assert_eq!(code, Some(0), "{said}");
    let down: Vec<f64> = letters(&out).iter().zip(&level).map(|(a, b)| a.y0 - b.y0).collect();
    assert!(down.iter().enumerate().all(|(i, v)| (v - if i == 1 { 5.0 } else { 0.0 }).abs() < 1e-3), "{down:?}");
    assert!(std::fs::read_to_string(&recipe).unwrap().contains("words = \"Fjord\""));
    assert_eq!(run(&["run", &recipe, "-"], SHEET).1, out);
    let later = ["unite", "-", "+", "caption", "--words", "OO", "--letter-spacing", "-20%"];
    let earlier = ["caption", "-", "--words", "OO", "--letter-spacing", "-20%", "+", "unite"];
    let later = run(&later, SHEET).1;
    assert!(later.contains("data-united") && later == run(&earlier, SHEET).1);
}

#[test]
fn errors_name_what_is_wrong() {
    for (args, expected) in [
        (&["--words", " "][..], "--words: a caption needs words"),
        (&[], "--words is needed"),
        (&["--words", "A", "--fill", "reddish"], "--fill: `reddish` is not a CSS colour"),
        (&["--words", "A", "--font", "Nope"], "--font: `Nope`"),
        (&["--words", "A", "--size", "0"], "--size"),
        (&["--words", "A", "--select", "#none"], "nothing matches `#none`"),
    ] {
        let (code, out, said) = run(&[&["caption", "-"][..], args].concat(), SHEET);
        assert!(code != Some(0) && out.is_empty() && said.contains(expected), "{args:?}: {code:?} {said}");
    }
}
