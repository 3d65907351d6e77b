//! Artwork that lay off the page before the warp and shows on it afterwards, such as notes beside a drawing.

use super::boxes::{bound, painted_box};
use super::input::WriteInput;
use super::page::shown;
use crate::bend::outcome::Notes;
use crate::scene::model::{Group, Node, PartRole};
use crate::scene::seen::{clip_box, is_seen, overlap};
use pathwarp::kurbo::Rect;
use std::cell::LazyCell;

/// Extent of an arrival on the page to be seen, as a fraction of the page.
const VISIBLE: f64 = 1e-3;

/// Notes the elements that have come onto the page.
pub(super) fn note(input: &WriteInput<'_>, notes: &mut Notes) {
    let Some(page) = input.drawing.specified_area() else { return };
    let shown = LazyCell::new(|| shown(input));
    in_group(input, &input.scene.root, &mut Vec::new(), &mut |i, clips| {
        let p = input.part(i);
        if overlap(bound(p, None, p.frame), page).is_some() {
            return;
        }
        let clipped = clips.iter().try_fold(*shown, |room, clip| overlap(room, warped_clip(input, *clip)?));
        let after = painted_box(p, input.warped(i), input.written(p.slot, p.frame));
        let came = clipped.and_then(|room| overlap(after, room)).is_some_and(|o| {
            let deep = VISIBLE * shown.width().max(shown.height());
            o.width().max(o.height()) > deep
        });
        if let Some(e) = p.owner.or(p.source).filter(|_| came) {
            notes.add("artwork that lay off the page has moved onto it", &input.source.display_name(e));
        }
    });
}

/// Visits the warped parts that are seen, with the clip paths around them.
fn in_group(input: &WriteInput<'_>, g: &Group, clips: &mut Vec<usize>, visit: &mut dyn FnMut(usize, &[usize])) {
    if g.opacity <= 0.0 || g.mask.is_some() {
        return;
    }
    clips.extend(g.clip);
    for n in &g.children {
        match n {
            Node::Group(g) => in_group(input, g, clips, visit),
            Node::Text { content, .. } => in_group(input, content, clips, visit),
            Node::Image(_) => {}
            Node::Part(i) => {
                let p = input.part(*i);
                if is_seen(p) && p.role == PartRole::Paint && input.warped(*i).is_some() {
                    visit(*i, clips);
                }
            }
        }
    }
    clips.truncate(clips.len() - usize::from(g.clip.is_some()));
}

fn warped_clip(input: &WriteInput<'_>, clip: usize) -> Option<Rect> {
    clip_box(input.scene, clip, &|i| {
        let p = input.part(i);
        Some(painted_box(p, input.warped(i), input.written(p.slot, p.frame)))
    })
}
