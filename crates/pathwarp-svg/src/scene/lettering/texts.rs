//! Lettering of all painted texts.

use super::line::TextLine;
use super::shaped;
use crate::scene::model::{PlacedText, Scene};
use std::collections::HashMap;

/// Finds the lines of every painted text.
pub(super) fn lines(tree: &usvg::Tree, scene: &Scene) -> Vec<TextLine> {
    if scene.texts.is_empty() {
        return Vec::new();
    }
    let texts = by_address(tree);
    let mut out = Vec::new();
    for PlacedText { text, owner, frame, first } in &scene.texts {
        if let Some(text) = texts.get(text) {
            let lines = shaped::lines(text, tree.fontdb(), *frame, &scene.parts, *first);
            out.extend(lines.into_iter().map(|l| TextLine { owner: *owner, ..l }));
        }
    }
    out
}

/// All texts of a drawing and of the drawings shown in it as images, by their address. Nesting takes no stack.
fn by_address(tree: &usvg::Tree) -> HashMap<usize, &usvg::Text> {
    let mut out = HashMap::new();
    let mut groups = vec![tree.root()];
    while let Some(group) = groups.pop() {
        for node in group.children() {
            match node {
                usvg::Node::Group(g) => groups.push(g),
                usvg::Node::Text(t) => {
                    out.insert(std::ptr::from_ref::<usvg::Text>(t) as usize, &**t);
                }
                usvg::Node::Image(i) => {
                    if let usvg::ImageKind::SVG(tree) = i.kind() {
                        groups.push(tree.root());
                    }
                }
                usvg::Node::Path(_) => {}
            }
        }
    }
    out
}
