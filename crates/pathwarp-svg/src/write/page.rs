//! The page and the warped artwork: how far that leaves it; and the root's viewBox, width and height that fit it.

use crate::bend::image::Picture;
use crate::bend::options::PageFit;
use crate::bend::part::{Done, Outcome, StrokeDone, written};
use crate::bend::stroke;
use crate::scene::model::{Group, Node, Part, Role};
use crate::source::number::short;
use crate::source::select::Selection;
use crate::write::fragment::{Job, stroke_scale};
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, BezPath, Rect, Shape as _};
use std::str::FromStr;
use svgtypes::{Length, LengthUnit};

/// Fine against any page.
const FINE: f64 = 1e-4;
/// Artwork that leaves the page by less than this share of it is not seen to: a pixel of a thousand.
const UNSEEN: f64 = 1e-3;

/// How far warped artwork leaves the page, on sides where the original did not leave it as far: left, top, right, bottom.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Overhang {
    /// In root user units; 0 on the other sides.
    pub by: [f64; 4],
    /// The largest as a share of the page's width (left, right) or height (top, bottom).
    pub share: f64,
}

/// What counts when the artwork's box is measured.
#[derive(Clone, Copy)]
struct Measure<'a> {
    /// For every element whether it counts.
    counts: &'a [bool],
    /// What is sure to lie in here need not be measured closely.
    room: Option<Rect>,
    /// Whether all of a filter's region counts, wherever it paints.
    filters: bool,
}

impl Job<'_> {
    /// New values for attributes of the root, if the page is to fit.
    pub(crate) fn page(&self) -> Option<Vec<(&'static str, String)>> {
        let document = self.document;
        let page = self.sheet();
        let shown = match self.options.page {
            PageFit::None => return None,
            PageFit::Grow => page.union(self.artwork(Some(page), true)?),
            PageFit::Page => self.artwork(None, true)?,
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

    /// How far the artwork leaves a page that stays as it is, if it did not do so before.
    pub(crate) fn overhang(&self) -> Option<Overhang> {
        // The artwork's box takes every outline; it is not asked for where nothing has moved.
        let moved = self.outcomes.iter().any(|o| o.done().is_some())
            || self.slots.iter().any(|s| s.fit != Affine::IDENTITY)
            || self.pictures.iter().any(|p| matches!(p, Picture::Bent(_)));
        if self.options.page != PageFit::None || !moved || !self.has_page() {
            return None;
        }
        let page = self.sheet();
        let sides = [page.width(), page.height(), page.width(), page.height()];
        let beyond = |b: Rect| [page.x0 - b.x0, page.y0 - b.y0, b.x1 - page.x1, b.y1 - page.y1];
        let seen = |by: &[f64; 4]| by.iter().zip(sides).any(|(by, side)| *by > UNSEEN * side);
        let after = beyond(self.artwork(Some(page), false)?);
        if !seen(&after) {
            return None;
        }
        let (outcomes, pictures): (Vec<_>, Vec<_>) = (
            self.outcomes.iter().map(|_| Outcome::Kept).collect(),
            self.pictures.iter().map(|_| Picture::Placed).collect(),
        );
        let original = Job { outcomes: &outcomes, pictures: &pictures, slots: &[], ..*self };
        let before = original.artwork(Some(page), false).map_or([0.0; 4], beyond);
        let mut out = Overhang::default();
        for i in 0..4 {
            if after[i] > before[i].max(0.0) + UNSEEN * sides[i] {
                out.by[i] = after[i];
                out.share = out.share.max(after[i] / sides[i]);
            }
        }
        (out.share > 0.0).then_some(out)
    }

    /// Whether the file says how large its page is.
    fn has_page(&self) -> bool {
        let source = &self.document.source;
        let length = |name| {
            let text = source.attr(0, name);
            text.and_then(|t| Length::from_str(t.trim()).ok()).is_some_and(|l| l.unit != LengthUnit::Percent)
        };
        source.attr(0, "viewBox").is_some() || length("width") && length("height")
    }

    /// What is seen, which may be more or less than the viewBox where the two have different proportions.
    fn sheet(&self) -> Rect {
        self.document.scene().to_px.inverse().transform_rect_bbox(self.document.page.to_rect())
    }

    /// The box of everything that is painted, strokes included, in root user space. Guides do not count.
    fn artwork(&self, room: Option<Rect>, filters: bool) -> Option<Rect> {
        let guides = Selection { guides: self.options.selection.guides.clone(), ..Selection::default() };
        let counts = guides.resolve(&self.document.source);
        self.group_box(&self.document.scene().root, Measure { counts: &counts, room, filters })
    }

    fn group_box(&self, g: &Group, m: Measure<'_>) -> Option<Rect> {
        let scene = self.document.scene();
        let one = |n: &Node, m: Measure<'_>| match n {
            Node::Group(g) => self.group_box(g, m),
            Node::Text { content, .. } => self.group_box(content, m),
            Node::Part(i) => {
                let p = &scene.parts[*i];
                let seen = p.painted() && p.role == Role::Paint && p.owner.or(p.source).is_none_or(|e| m.counts[e]);
                let frame = written(scene, self.slots, p.slot, p.frame);
                let done = self.outcomes[*i].done();
                let near = |r: Rect| Some(bound(p, done, frame)).filter(|b| r.union(*b) == r);
                seen.then(|| m.room.and_then(near).unwrap_or_else(|| painted_box(p, done, frame)))
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
        };
        let mut all: Option<Rect> = None;
        for n in &g.children {
            // Nor what lies within what there is already.
            let room = m.room.map(|room| all.map_or(room, |a| room.union(a)));
            if let Some(b) = one(n, Measure { room, ..m }).filter(Rect::is_finite) {
                all = Some(all.map_or(b, |a| a.union(b)));
            }
        }
        let mut all = all?;
        for f in g.filters.iter().filter(|_| m.filters) {
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

/// A box that holds what a part paints, at little cost.
fn bound(p: &Part, done: Option<&Done>, frame: Affine) -> Rect {
    let path = match done {
        Some(d) => d.path.control_box(),
        None => p.local.bounding_box().unwrap_or(Rect::ZERO),
    };
    let all = match (&p.stroke, done.map(|d| &d.stroke)) {
        (None, _) => path,
        (Some(_), Some(StrokeDone::Outlined(o))) => path.union(o.control_box()),
        (Some(s), _) => {
            // Miters reach furthest, but for square caps with theirs.
            let reach = f64::from(s.miterlimit().get()).max(std::f64::consts::SQRT_2);
            let reach = 0.5 * f64::from(s.width().get()) * stroke_scale(done) * reach;
            path.inflate(reach, reach)
        }
    };
    frame.transform_rect_bbox(all)
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
