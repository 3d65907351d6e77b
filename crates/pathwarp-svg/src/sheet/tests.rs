use super::*;

const ONE: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50\"><defs><linearGradient id=\"g\">\
    <stop stop-color=\"red\"/><stop offset=\"1\" stop-color=\"blue\"/></linearGradient></defs>\
    <rect width=\"100\" height=\"50\" fill=\"url(#g)\"/></svg>";

/// Ids are unique, labels are outlines, and drawings are inside their cells.
#[test]
fn drawings_lie_in_their_cells_and_keep_to_themselves() {
    let half = ONE.replace("<rect width=\"100\"", "<rect width=\"50\"").replace("red", "lime");
    let cells =
        [(ONE, "whole & all"), (&half, "half"), (ONE, "again")].map(|(s, l)| Cell { svg: s.into(), label: l.into() });
    let options = SheetOptions { columns: 2, cell: (124.0, 96.0), title: "Title".into() };
    let svg = sheet(&cells, &options, &ReadOptions::default()).unwrap();
    assert!(!svg.contains("<text") && svg.contains("<title>whole &amp; all</title>"));
    let doc = usvg::roxmltree::Document::parse(&svg).unwrap();
    let mut ids: Vec<&str> = doc.descendants().filter_map(|n| n.attribute("id")).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
    for k in 0..3 {
        assert!(svg.contains(&format!("url(#s{k}-")), "{k}");
    }
    let tree = tree::parse(svg.as_bytes(), "sheet", &ReadOptions::default()).unwrap().0;
    assert_eq!((tree.size().width(), tree.size().height()), (296.0, 274.0));
    let gradients: Vec<usvg::Rect> = filled(tree.root());
    // 124 − 24 = 100 wide: the largest fits exactly; the half one has half the width and is centred.
    let sizes: Vec<(f32, f32, f32)> = gradients.iter().map(|r| (r.x(), r.width(), r.height())).collect();
    let near =
        |a: (f32, f32, f32), b: (f32, f32, f32)| (a.0 - b.0).abs() + (a.1 - b.1).abs() + (a.2 - b.2).abs() < 1e-2;
    assert!(
        near(sizes[0], (28.0, 100.0, 50.0)) && near(sizes[1], (193.0, 50.0, 50.0)) && near(sizes[2], sizes[0]),
        "{sizes:?}"
    );
}

/// Bounding boxes of the paths with a gradient.
fn filled(g: &usvg::Group) -> Vec<usvg::Rect> {
    let of = |n: &usvg::Node| match n {
        usvg::Node::Group(g) => filled(g),
        usvg::Node::Path(p) if p.fill().is_some_and(|f| matches!(f.paint(), usvg::Paint::LinearGradient(_))) => {
            vec![p.abs_bounding_box()]
        }
        _ => Vec::new(),
    };
    g.children().iter().flat_map(of).collect()
}
