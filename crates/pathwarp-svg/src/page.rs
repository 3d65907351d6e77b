//! The page made to fit the warped artwork: its box, and the root's viewBox, width and height for it.

use crate::image::Picture;
use crate::number::short;
use crate::options::PageFit;
use crate::scene::{Group, Node, Part, Role};
use crate::select::Selection;
use crate::stroke;
use crate::warp::{Done, StrokeDone, written};
use crate::write::{Job, stroke_scale};
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, BezPath, Rect, Shape as _};
use std::str::FromStr;
use svgtypes::{Length, LengthUnit};

/// Fine against any page.
const FINE: f64 = 1e-4;

impl Job<'_> {
    /// New values for attributes of the root, if the page is to fit.
    pub(crate) fn page(&self) -> Option<Vec<(&'static str, String)>> {
        // The artwork's box takes every outline; it is not asked for in vain.
        if self.options.page == PageFit::None {
            return None;
        }
        let document = self.document;
        let to_px = document.scene().to_px;
        let size = document.page;
        // What is seen, which may be more or less than the viewBox where the two have different proportions.
        let page = to_px.inverse().transform_rect_bbox(size.to_rect());
        let artwork = self.artwork()?;
        let shown = match self.options.page {
            PageFit::None => return None,
            PageFit::Grow => page.union(artwork),
            PageFit::Page => artwork,
        };
        if !(shown.width() > 0.0 && shown.height() > 0.0 && shown.is_finite()) || shown == page {
            return None;
        }
        let view = [shown.x0, shown.y0, shown.width(), shown.height()].map(short).join(" ");
        let mut out = vec![("viewBox", view)];
        let sides = [("width", shown.width() / page.width()), ("height", shown.height() / page.height())];
        for (name, ratio) in sides {
            let text = document.source.attr(0, name);
            if let Some(l) = text.and_then(|t| Length::from_str(t.trim()).ok())
                && l.unit != LengthUnit::Percent
            {
                out.push((name, format!("{}{}", short(l.number * ratio), unit(l.unit))));
            }
        }
        Some(out)
    }

    /// The box of everything that is painted, strokes included, in root user space. Guides do not count.
    fn artwork(&self) -> Option<Rect> {
        let guides = Selection { guides: self.options.selection.guides.clone(), ..Selection::default() };
        let counts = guides.resolve(&self.document.source);
        self.group_box(&self.document.scene().root, &counts)
    }

    fn group_box(&self, g: &Group, counts: &[bool]) -> Option<Rect> {
        let scene = &self.document.scene();
        let boxes = g.children.iter().filter_map(|n| match n {
            Node::Group(g) => self.group_box(g, counts),
            Node::Text { content, .. } => self.group_box(content, counts),
            Node::Part(i) => {
                let p = &scene.parts[*i];
                let seen = p.painted() && p.role == Role::Paint && p.owner.or(p.source).is_none_or(|e| counts[e]);
                let frame = written(scene, self.slots, p.slot, p.frame);
                seen.then(|| painted_box(p, self.outcomes[*i].done(), frame))
            }
            Node::Image(i) => {
                let b = &scene.bitmaps[*i];
                let frame = written(scene, self.slots, b.slot, b.frame);
                let pixels = b.image.size();
                b.image.is_visible().then(|| match &self.pictures[*i] {
                    Picture::Bent(bent) => (frame * b.placing.inverse()).transform_rect_bbox(bent.area),
                    _ => frame.transform_rect_bbox(Rect::new(0.0, 0.0, pixels.width().into(), pixels.height().into())),
                })
            }
        });
        let mut all = boxes.filter(Rect::is_finite).reduce(|a, b| a.union(b))?;
        for f in &g.filters {
            // Where a filter may paint; measured from its region before the warp.
            let r = f.rect();
            let region = Rect::new(r.left().into(), r.top().into(), r.right().into(), r.bottom().into());
            if let Some(s) = g.slot {
                let frame = written(scene, self.slots, g.slot, scene.slots[s].frame);
                all = all.union(frame.transform_rect_bbox(region));
            }
        }
        if let Some(c) = g.clip.map(|i| &scene.clips[i]) {
            let boxes = c.parts.clone().map(|i| {
                let p = &scene.parts[i];
                let frame = written(scene, self.slots, p.slot, p.frame);
                (frame * path(p, self.outcomes[i].done())).bounding_box()
            });
            all = all.intersect(boxes.reduce(|a, b| a.union(b))?);
        }
        (all.width() >= 0.0 && all.height() >= 0.0).then_some(all)
    }
}

/// What is written of a part, near enough.
fn path(p: &Part, done: Option<&Done>) -> BezPath {
    if let Some(d) = done {
        return d.path.clone();
    }
    let size = p.local.bounding_box().map_or(1.0, |b| b.width().max(b.height()));
    p.local.to_bez_path((size * FINE).max(1e-12))
}

fn painted_box(p: &Part, done: Option<&Done>, frame: Affine) -> Rect {
    let path = path(p, done);
    let inside = (frame * &path).bounding_box();
    match (&p.stroke, done.map(|d| &d.stroke)) {
        (None, _) => inside,
        (Some(_), Some(StrokeDone::Outlined(o))) => inside.union((frame * o).bounding_box()),
        (Some(s), _) => {
            // The expansion is linear in the width, so a scaled stroke is a plain one on a path scaled back.
            let scale = stroke_scale(done);
            let size = path.bounding_box();
            let size = size.width().max(size.height()) / scale;
            let back = Outline::from(&path).transformed(Affine::scale(1.0 / scale));
            let outline = stroke::outline(&back, s, (FINE * size).max(1e-9)).transformed(frame * Affine::scale(scale));
            outline.bounding_box().map_or(inside, |b| inside.union(b))
        }
    }
}

fn unit(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::None | LengthUnit::Percent => "",
        LengthUnit::Em => "em",
        LengthUnit::Ex => "ex",
        LengthUnit::Px => "px",
        LengthUnit::In => "in",
        LengthUnit::Cm => "cm",
        LengthUnit::Mm => "mm",
        LengthUnit::Pt => "pt",
        LengthUnit::Pc => "pc",
    }
}
