//! Checks that every sample matches its description in the README of the samples, and is visible.

use pathwarp::kurbo::{BezPath, PathSeg, Shape};
use pathwarp_oracle::difference;
use pathwarp_raster::{Color, RenderOptions, Size};
use resvg::usvg;
use std::{collections::HashSet, fs, path::PathBuf};

fn folder() -> PathBuf {
    crate::support::root().join("samples")
}

/// Returns the names and contents of all samples.
fn samples() -> Vec<(String, String)> {
    let files = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let drawings = files.filter(|file| file.extension().is_some_and(|ext| ext == "svg"));
    drawings
        .map(|file| (file.file_name().unwrap().to_string_lossy().into(), fs::read_to_string(file).unwrap()))
        .collect()
}

fn options() -> usvg::Options<'static> {
    let mut options = usvg::Options::default();
    let font = folder().join("../crates/pathwarp-svg/fonts/NotoSans-Regular.subset.ttf");
    options.fontdb_mut().load_font_file(font).unwrap();
    options
}

#[test]
fn all_have_a_title_a_size_and_unique_ids() {
    for (name, text) in samples() {
        let document = usvg::roxmltree::Document::parse(&text).unwrap();
        let root = document.root_element();
        for attribute in ["width", "height", "viewBox"] {
            assert!(root.has_attribute(attribute), "{name} has no {attribute}");
        }
        let title =
            root.first_element_child().filter(|child| child.has_tag_name(("http://www.w3.org/2000/svg", "title")));
        assert!(title.is_some_and(|t| t.text().is_some()), "{name} does not begin with a title");
        let mut seen = HashSet::new();
        for id in document.descendants().filter_map(|node| node.attribute("id")) {
            assert!(seen.insert(id), "{name} has the id {id} twice");
        }
        assert!(!seen.is_empty(), "{name} has no ids");
    }
}

#[test]
fn all_are_visible() {
    let options = options();
    let samples = samples();
    assert!(samples.len() >= 13, "{}", samples.len());
    for (name, text) in samples {
        let tree = usvg::Tree::from_str(&text, &options).unwrap();
        let picture = RenderOptions { size: Size::Width(300), background: Some(Color::WHITE) }.render(&tree).unwrap();
        let mut blank = picture.clone();
        blank.fill(Color::WHITE);
        let inked = difference(&picture, &blank).share(64);
        assert!(inked > 0.01, "{name}: only {inked} of the picture is drawn on");
    }
}

#[test]
fn the_readme_lists_all() {
    let readme = fs::read_to_string(folder().join("README.md")).unwrap();
    for (name, _) in samples() {
        assert!(readme.contains(&format!("[{name}]({name})")), "{name} is missing in the README");
    }
}

/// Adjacent tiles share every edge that is not on the frame, with equal numbers in opposite directions.
#[test]
fn tiles_share_their_edges() {
    let text = fs::read_to_string(folder().join("tiles.svg")).unwrap();
    let document = usvg::roxmltree::Document::parse(&text).unwrap();
    let data = document.descendants().filter_map(|node| node.attribute("d"));
    let edges: Vec<PathSeg> = data.flat_map(|d| BezPath::from_svg(d).unwrap().segments().collect::<Vec<_>>()).collect();
    let on_frame = |edge: &PathSeg| {
        let bounds = edge.bounding_box();
        (bounds.width() == 0.0 || bounds.height() == 0.0) && matches!(edge, PathSeg::Line(_))
    };
    // Parsing converts arcs to cubics, whose last digits depend on the direction.
    let same = |a: &PathSeg, b: &PathSeg| {
        let (a, b) = (a.to_cubic(), b.to_cubic());
        [(a.p0, b.p0), (a.p1, b.p1), (a.p2, b.p2), (a.p3, b.p3)].into_iter().all(|(a, b)| a.distance(b) < 0.01)
    };
    let inner: Vec<&PathSeg> = edges.iter().filter(|edge| !on_frame(edge)).collect();
    assert!(inner.len() > 40, "{}", inner.len());
    for edge in inner {
        let partners = edges.iter().filter(|other| same(edge, &other.reverse())).count();
        assert_eq!(partners, 1, "{edge:?}");
    }
}
