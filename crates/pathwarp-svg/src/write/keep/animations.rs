//! Animations under a warp: they stay unless they move what is warped, or what has become another element.

use super::{GEOMETRY, Keeper};
use crate::bend::image::Picture;
use crate::source::text::ElementId;

const OF_GEOMETRY: &str = "animations of a shape's geometry are dropped, as the shape is warped";
const OF_PLACE: &str = "animations that move warped shapes along straight lines are dropped";
const OF_PAINT: &str =
    "animations of fill and stroke are dropped where a shape, text or copy has become a group of several";

/// Whether this is the name of an element that animates.
pub(crate) fn is_animation(tag: &str) -> bool {
    matches!(tag, "animate" | "set" | "animateTransform" | "animateMotion" | "animateColor")
}

impl Keeper<'_, '_> {
    /// Takes out the animations that no longer fit.
    pub(super) fn animations(&mut self) {
        if !self.source.animated {
            return;
        }
        let scene = &self.job.document.scene();
        let count = self.source.elements.len();
        let (mut warped, mut around) = (vec![false; count], vec![false; count]);
        let parts = scene.parts.iter().enumerate().filter(|p| self.done(p.0)).filter_map(|p| p.1.owner.or(p.1.source));
        let bitmaps = scene.bitmaps.iter().zip(self.job.pictures);
        let bitmaps = bitmaps.filter(|b| matches!(b.1, Picture::Bent(_))).filter_map(|b| b.0.owner);
        for e in parts.chain(bitmaps) {
            warped[e] = true;
            for a in self.source.ancestors(e) {
                if std::mem::replace(&mut around[a], true) {
                    break;
                }
            }
        }
        let source = self.source;
        for a in (0..count).filter(|&a| is_animation(&source.elements[a].tag)) {
            let target = match self.source.href(a) {
                Some(id) => self.source.by_id().get(&id).and_then(|all| all.first().copied()),
                None => self.source.elements[a].parent,
            };
            let Some(target) = target else { continue };
            let why = match self.animates(a) {
                Animates::Geometry if warped[target] => OF_GEOMETRY,
                Animates::Place if around[target] => OF_PLACE,
                Animates::Paint if self.fragments.contains(&target) => OF_PAINT,
                _ => continue,
            };
            self.edits.replace(a, String::new());
            self.writer.notes.add(why, &self.source.display_name(target));
        }
    }

    /// The animations right inside an element whose content is written anew, but for those that no longer fit.
    pub(crate) fn kept_animations(&self, e: ElementId) -> String {
        let inside = self.source.elements[e].range.end;
        let children = (e + 1..self.source.elements.len())
            .take_while(|&c| self.source.elements[c].range.start < inside)
            .filter(|&c| self.source.elements[c].parent == Some(e) && is_animation(self.tag(c)));
        let kept = children.filter(|&c| matches!(self.animates(c), Animates::Other));
        kept.map(|c| &self.source.text[self.source.elements[c].range.clone()]).collect()
    }

    fn animates(&self, a: ElementId) -> Animates {
        if matches!(self.tag(a), "animateTransform" | "animateMotion") {
            return Animates::Place;
        }
        match self.source.attr(a, "attributeName").as_deref().map(str::trim) {
            Some("transform") => Animates::Place,
            Some("points" | "dx" | "dy" | "rotate" | "textLength" | "font-size" | "href" | "xlink:href") => {
                Animates::Geometry
            }
            Some(n) if GEOMETRY.contains(&n) => Animates::Geometry,
            Some(n) if n.starts_with("fill") || n.starts_with("stroke") => Animates::Paint,
            _ => Animates::Other,
        }
    }
}

/// What an animation changes.
enum Animates {
    Geometry,
    Place,
    Paint,
    Other,
}
