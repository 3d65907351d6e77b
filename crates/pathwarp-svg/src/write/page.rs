//! Fits the page to the warped artwork, and measures how far the artwork extends past it.

use super::boxes::{self, box_under, painted_box, paints_in, path, quick_box};
use super::input::WriteInput;
use super::line;
use crate::bend::bends::Bend;
use crate::bend::fits::EmbeddedImage;
use crate::bend::options::PageFit;
use crate::bend::outcome::{Overhang, PartOutcome, WarpedPart};
use crate::scene::areas::{self, clip_box, is_seen, overlap};
use crate::scene::drawing::page_length;
use crate::scene::model::{Group, Node, PartRole};
use crate::source::elements::ElementId;
use crate::source::number::{rectangle, short};
use crate::source::select::Selection;
use pathwarp::kurbo::{Affine, Point, Rect, Size};
use std::collections::BTreeSet;
use svgtypes::LengthUnit;

/// Smallest visible overhang as a fraction of the page: one pixel in a thousand.
const VISIBLE: f64 = 1e-3;
/// Overhang as a fraction of the page that is ignored, since rounding causes as much in icons.
const SLIVER: f64 = 0.1 * VISIBLE;

/// Rules for measuring the artwork's bounding box.
#[derive(Clone, Copy)]
struct Measure<'a> {
    /// For every element, `true` if it counts.
    counts: &'a [bool],
    /// Parts certain to be inside this area need no exact measurement.
    covered: Option<Rect>,
    /// The page on which artwork was shown before the warp, if only such artwork counts.
    page: Option<Rect>,
}

/// The visible area of the result, if the page is to be adapted and changes.
fn adapted_page(input: &WriteInput<'_>) -> Option<Rect> {
    let page = input.drawing.visible_area();
    let shown = match input.options.page {
        PageFit::None | PageFit::Shrink => return None,
        PageFit::Origin => Rect::from_origin_size(Point::ORIGIN, page.size()),
        PageFit::Auto => auto_page(input, page)?,
        PageFit::Grow => page.union(artwork(input, Some(page))?),
        PageFit::Page => artwork(input, None)?,
        PageFit::PageWithMargin => {
            let margin = margin(input, page);
            artwork(input, None)?.inflate(margin, margin)
        }
        PageFit::Sheet(sides) => sheet(input, sides, artwork(input, None)?),
    };
    (shown.width() > 0.0 && shown.height() > 0.0 && shown.is_finite() && shown != page).then_some(shown)
}

/// A sheet of paper with sides in mm around the artwork, turned as the artwork needs.
fn sheet(input: &WriteInput<'_>, [a, b]: [f64; 2], all: Rect) -> Rect {
    let is_wide = all.width() > all.height();
    let sides = if is_wide { (a.max(b), a.min(b)) } else { (a.min(b), a.max(b)) };
    Rect::from_center_size(all.center(), Size::from(sides) * input.drawing.units_per_mm())
}

/// The page of [`PageFit::Auto`]. Returns `None` if it does not change.
fn auto_page(input: &WriteInput<'_>, page: Rect) -> Option<Rect> {
    if !has_moved(input) || input.drawing.specified_area().is_none() {
        return None;
    }
    let all = artwork(input, Some(page))?;
    let slack = SLIVER * page.width().max(page.height());
    let margin = margin(input, page);
    let outwards = |r: Rect| {
        let r = r.inflate(margin, margin);
        let [x0, y0] = [r.x0, r.y0].map(|v| (v + slack).floor());
        let [x1, y1] = [r.x1, r.y1].map(|v| (v - slack).ceil());
        Rect::new(x0, y0, x1, y1)
    };
    if !shows(input, &input.scene.root, seen_part(page), &guideless(input)) {
        return Some(outwards(artwork(input, None)?));
    }
    let tolerated = tolerated(input, page);
    if tolerated.contains_rect(all) {
        return None;
    }
    // Only the sides that the artwork with its margin passes move.
    let (needed, whole) = (all.inflate(margin, margin), outwards(all));
    let out = Rect::new(
        if needed.x0 < tolerated.x0 { whole.x0 } else { page.x0 },
        if needed.y0 < tolerated.y0 { whole.y0 } else { page.y0 },
        if needed.x1 > tolerated.x1 { whole.x1 } else { page.x1 },
        if needed.y1 > tolerated.y1 { whole.y1 } else { page.y1 },
    );
    // A page that is a fraction of the window extends to the right and downwards as far as there is artwork.
    (out.origin() != page.origin() || !input.drawing.shares_window()).then_some(out)
}

/// The area that the artwork of a page may cover: the page with a sliver and the curves' tolerance around it.
fn tolerated(input: &WriteInput<'_>, page: Rect) -> Rect {
    let slack = SLIVER * page.width().max(page.height()) + input.options.refit.tolerance;
    page.inflate(slack, slack)
}

/// The transform that takes the artwork back onto its page, if it leaves it.
pub(super) fn back(input: &WriteInput<'_>) -> Option<Affine> {
    let page = input.drawing.specified_area().filter(|_| input.options.page == PageFit::Shrink && has_moved(input))?;
    let all = artwork(input, Some(page))?;
    if tolerated(input, page).contains_rect(all) {
        return None;
    }
    let margin = margin(input, page);
    let room = page.inflate(-margin, -margin);
    let scale = (room.width() / all.width()).min(room.height() / all.height()).min(1.0);
    let (center, half) = (all.center(), all.size() * (0.5 * scale));
    let x = center.x.clamp(room.x0 + half.width, (room.x1 - half.width).max(room.x0 + half.width));
    let y = center.y.clamp(room.y0 + half.height, (room.y1 - half.height).max(room.y0 + half.height));
    let back = Affine::translate((x, y)) * Affine::scale(scale) * Affine::translate(-center.to_vec2());
    (scale > 0.0 && back.is_finite()).then_some(back)
}

/// The page without a border in which artwork is too small to be seen.
fn seen_part(page: Rect) -> Rect {
    let edge = VISIBLE * page.width().min(page.height());
    page.inflate(-edge, -edge)
}

/// Returns `true` if nothing of the drawing lies on its page `shown`, if it specifies one.
pub(super) fn is_blank(input: &WriteInput<'_>, shown: Rect) -> bool {
    input.drawing.specified_area().is_some() && !shows(input, &input.scene.root, seen_part(shown), &guideless(input))
}

/// Returns `true` if anything of the drawing is not where it was.
fn has_moved(input: &WriteInput<'_>) -> bool {
    input.options.grown.is_some()
        || input.line.is_some()
        || input.outcomes.iter().any(|o| o.warped().is_some())
        || input.slots.iter().any(|s| s.fit != Affine::IDENTITY)
        || input.images.iter().any(|p| matches!(p, EmbeddedImage::Bent { .. }))
}

/// Returns new attributes of the root for a [`change`] of the page.
pub(super) fn attributes(input: &WriteInput<'_>, (page, shown): (Rect, Rect)) -> Vec<(&'static str, String)> {
    let source = input.source;
    let view = rectangle(shown).map(|side| side.1).join(" ");
    let mut out = vec![("viewBox", view)];
    if matches!(input.options.page, PageFit::Sheet(_)) {
        let sides = [("width", shown.width()), ("height", shown.height())];
        out.extend(sides.map(|(name, side)| (name, format!("{}mm", short(side / input.drawing.units_per_mm())))));
        return out;
    }
    let sides = [("width", shown.width(), page.width()), ("height", shown.height(), page.height())];
    for (name, after, before) in sides {
        let Some(l) = page_length(source, name) else { continue };
        if l.unit != LengthUnit::Percent {
            out.push((name, format!("{}{}", short(l.number * after / before), unit(l.unit))));
        } else if source.attr(0, "viewBox").is_none() {
            // With a viewBox, a percentage scales the page to the window, and stays.
            out.push((name, short(after)));
        }
    }
    out
}

/// The visible area before and after, if the page changes. Measures the artwork.
pub(super) fn change(input: &WriteInput<'_>) -> Option<(Rect, Rect)> {
    Some((input.drawing.visible_area(), adapted_page(input)?))
}

/// Measures the overhang over a sheet of paper, or over a page that is not adapted, compared to the original.
pub(super) fn overhang(input: &WriteInput<'_>) -> Option<Overhang> {
    if let PageFit::Sheet(sides) = input.options.page {
        let all = artwork(input, None)?;
        let page = sheet(input, sides, all);
        let [x, y] = [page.x0 - all.x0, page.y0 - all.y0].map(|v| v.max(0.0));
        let share = (x / page.width()).max(y / page.height());
        return (share > VISIBLE).then_some(Overhang { by: [x, y, x, y], share });
    }
    // Measuring needs every outline, so skip it if nothing has moved.
    if input.options.page != PageFit::None || !has_moved(input) || input.drawing.specified_area().is_none() {
        return None;
    }
    let page = input.drawing.visible_area();
    let sides = [page.width(), page.height(), page.width(), page.height()];
    let beyond = |b: Rect| [page.x0 - b.x0, page.y0 - b.y0, b.x1 - page.x1, b.y1 - page.y1];
    let is_visible = |by: &[f64; 4]| by.iter().zip(sides).any(|(by, side)| *by > VISIBLE * side);
    let after = beyond(artwork(input, Some(page))?);
    if !is_visible(&after) {
        return None;
    }
    let before = original(input, Some(page)).map_or([0.0; 4], beyond);
    let mut out = Overhang::default();
    for i in 0..4 {
        if after[i] > before[i].max(0.0) + VISIBLE * sides[i] {
            out.by[i] = after[i];
            out.share = out.share.max(after[i] / sides[i]);
        }
    }
    (out.share > 0.0).then_some(out)
}

/// The least distance between the original artwork and the edge of its page; 0 if it has no page or extends past it.
fn margin(input: &WriteInput<'_>, page: Rect) -> f64 {
    let Some(b) = original(input, None).filter(|_| input.drawing.specified_area().is_some()) else { return 0.0 };
    let page = input.options.grown.unwrap_or(page);
    let sides = [b.x0 - page.x0, b.y0 - page.y0, page.x1 - b.x1, page.y1 - b.y1];
    sides.into_iter().fold(f64::INFINITY, f64::min).max(0.0)
}

/// Bounding box of the artwork before the warp.
fn original(input: &WriteInput<'_>, covered: Option<Rect>) -> Option<Rect> {
    let outcomes: Vec<_> = input.outcomes.iter().map(|_| PartOutcome::Kept).collect();
    let images: Vec<_> = input.images.iter().map(|_| EmbeddedImage::Placed).collect();
    drawn(&WriteInput { outcomes: &outcomes, images: &images, slots: &[], ..*input }, covered)
}

/// Bounding box of the warped artwork, with the line of a contour and the marks for the viewer's position, which are drawn beside it.
fn artwork(input: &WriteInput<'_>, covered: Option<Rect>) -> Option<Rect> {
    let line = input.line.map(|l| line::bounds(input, l));
    let sight = input.options.sight.as_ref().map(line::sight_bounds);
    drawn(input, covered).into_iter().chain(line).chain(sight).reduce(|a, b| a.union(b))
}

/// Bounding box of everything painted, strokes included, in root user space. Guides do not count. Artwork inside the area `covered` is
/// not measured exactly.
fn drawn(input: &WriteInput<'_>, covered: Option<Rect>) -> Option<Rect> {
    let (counts, page) = (guideless(input), input.options.grown.or(input.drawing.specified_area()));
    group_box(input, &input.scene.root, Measure { counts: &counts, covered, page })
}

/// For every element, `true` unless it is a guide.
fn guideless(input: &WriteInput<'_>) -> Vec<bool> {
    Selection { guides: input.options.selection.guides.clone(), ..Selection::default() }.resolve(input.source)
}

/// A bound on the image of the area of a part that the page showed, unbounded if it showed all of it. `frame` is the part's frame in the
/// result. Returns `None` if the page showed nothing.
fn part_from_page(input: &WriteInput<'_>, i: usize, frame: Affine, page: Rect) -> Option<Rect> {
    let p = input.part(i);
    let slivered = with_slivers(page);
    let quick = quick_box(p, None, p.frame);
    let painted = if slivered.contains_rect(quick) { quick } else { painted_box(p, None, p.frame) };
    // Letters placed one by one do not go through the whole map.
    let bend = input.bend(i..i + 1).filter(|_| input.warped(i).is_some());
    let is_whole = slivered.contains_rect(painted) || bend.is_some_and(|b| !b.options.letters.places.is_empty());
    image_from_page(bend, painted, is_whole, page, frame * p.frame.inverse())
}

/// A bound on the image of the area of an object that the page showed, unbounded if it showed the whole object (`is_whole`). `painted` is
/// the object's box before the warp. The map of `bend` moves it or, without one, `fit`.
fn image_from_page(bend: Option<&Bend<'_>>, painted: Rect, is_whole: bool, page: Rect, fit: Affine) -> Option<Rect> {
    let everything = Rect::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY);
    let shown = overlap(painted, page)?;
    match bend {
        _ if is_whole => Some(everything),
        Some(bend) => image_box(bend, shown),
        None => Some(fit.transform_rect_bbox(shown)),
    }
}

/// The page with the slivers around it that are ignored.
fn with_slivers(page: Rect) -> Rect {
    page.inflate(SLIVER * page.width(), SLIVER * page.height())
}

/// Bounding box of the image of an area of root user space.
fn image_box(bend: &Bend<'_>, area: Rect) -> Option<Rect> {
    /// Intervals between samples along a side. The image hardly bulges between them.
    const INTERVALS: u32 = 64;
    /// Intervals from one sample to the next inside, where images can be extreme only if the map folds.
    const INNER_STEP: u32 = 4;
    let share = |k: u32| f64::from(k) / f64::from(INTERVALS);
    let point = |(i, j): (u32, u32)| Point::new(area.x0 + share(i) * area.width(), area.y0 + share(j) * area.height());
    let is_sampled = |(i, j): &(u32, u32)| {
        let is_edge = |k: u32| k == 0 || k == INTERVALS;
        is_edge(*i) || is_edge(*j) || (i % INNER_STEP == 0 && j % INNER_STEP == 0)
    };
    let copies = |p: Point| {
        let all = &bend.options.copies;
        let only = all.is_empty().then_some(Affine::IDENTITY);
        all.iter().copied().chain(only).map(move |c| c * p)
    };
    let grid = (0..=INTERVALS).flat_map(|j| (0..=INTERVALS).map(move |i| (i, j))).filter(is_sampled);
    let points: Vec<Point> = grid.flat_map(|node| copies(point(node))).collect();
    let mut images = points.clone();
    bend.map.points(&points, &mut images);
    images.into_iter().filter(|q| q.is_finite()).map(|q| Rect::from_points(q, q)).reduce(|a, b| a.union(b))
}

/// The boxes of a visible bitmap before and after the warp.
fn image_boxes(input: &WriteInput<'_>, i: usize) -> Option<(Rect, Rect)> {
    let b = &input.scene.bitmaps[i];
    let pixels = b.image.size();
    let area = Rect::new(0.0, 0.0, pixels.width().into(), pixels.height().into());
    let frame = input.written(b.slot, b.frame);
    let after = match &input.images[i] {
        // The area is in the element's user space, and the frame leads from pixels.
        EmbeddedImage::Bent { image, .. } => (frame * b.placing.inverse()).transform_rect_bbox(image.area),
        _ => frame.transform_rect_bbox(area),
    };
    b.image.is_visible().then(|| (b.frame.transform_rect_bbox(area), after))
}

/// Returns `true` if anything of a group is seen in an area. `counts` is `true` for every element that counts.
fn shows(input: &WriteInput<'_>, g: &Group, area: Rect, counts: &[bool]) -> bool {
    if g.opacity <= 0.0 {
        return false;
    }
    if !g.filters.is_empty() || g.mask.is_some() {
        let all = group_box(input, g, Measure { counts, covered: None, page: None });
        return all.is_some_and(|b| overlap(b, area).is_some());
    }
    let Some(area) = g.clip.map_or(Some(area), |i| overlap(area, warped_clip(input, i)?)) else { return false };
    g.children.iter().any(|n| match n {
        Node::Group(g) | Node::Text { content: g, .. } => shows(input, g, area, counts),
        Node::Image(i) => image_boxes(input, *i).is_some_and(|(_, after)| overlap(after, area).is_some()),
        Node::Part(i) => {
            let p = input.part(*i);
            let paints = is_seen(p) && p.role == PartRole::Paint && p.element().is_none_or(|e| counts[e]);
            paints && paints_in(p, input.warped(*i), input.written(p.slot, p.frame), area)
        }
    })
}

/// The box of a clip path after the warp.
fn warped_clip(input: &WriteInput<'_>, clip: usize) -> Option<Rect> {
    clip_box(input.scene, clip, &|i| {
        let p = input.part(i);
        Some(box_under(input.written(p.slot, p.frame), &path(p, input.warped(i))))
    })
}

/// Bounding box of what a group paints, in root user space.
fn group_box(input: &WriteInput<'_>, g: &Group, m: Measure<'_>) -> Option<Rect> {
    let scene = input.scene;
    if g.opacity <= 0.0 {
        return None;
    }
    let node_box = |n: &Node, m: Measure<'_>| match n {
        Node::Group(g) | Node::Text { content: g, .. } => group_box(input, g, m),
        Node::Part(i) => {
            let p = &scene.parts[*i];
            let counts = is_seen(p) && p.role == PartRole::Paint && p.element().is_none_or(|e| m.counts[e]);
            let frame = input.written(p.slot, p.frame);
            let warped = input.warped(*i);
            let is_painted = counts && warped.is_none_or(WarpedPart::draws);
            let covered = |r: Rect| Some(quick_box(p, warped, frame)).filter(|b| r.contains_rect(*b));
            let all =
                is_painted.then(|| m.covered.and_then(covered).unwrap_or_else(|| painted_box(p, warped, frame)))?;
            m.page.map_or(Some(all), |page| overlap(all, part_from_page(input, *i, frame, page)?))
        }
        Node::Image(i) => {
            let (before, after) = image_boxes(input, *i)?;
            let Some(page) = m.page else { return Some(after) };
            let is_bent = matches!(input.images[*i], EmbeddedImage::Bent { .. });
            let b = &scene.bitmaps[*i];
            let bend = input.bends.bend_of(b.owner).map(|i| &input.bends.each[i]).filter(|_| is_bent);
            let fit = input.written(b.slot, b.frame) * b.frame.inverse();
            overlap(after, image_from_page(bend, before, with_slivers(page).contains_rect(before), page, fit)?)
        }
    };
    let mut all: Option<Rect> = None;
    for n in &g.children {
        // Parts inside the box so far need no exact measurement either.
        let covered = m.covered.map(|covered| all.map_or(covered, |a| covered.union(a)));
        if let Some(b) = node_box(n, Measure { covered, ..m }).filter(Rect::is_finite) {
            all = Some(all.map_or(b, |a| a.union(b)));
        }
    }
    let mut all = all?;
    let growth = boxes::growth(input, g);
    if let Some((outcome, slot)) = input.filter_outcome(g).zip(g.slot) {
        let frame = input.written(g.slot, scene.slots[slot].frame);
        let pictures = outcome.pictures().into_iter().flatten().map(|p| frame.transform_rect_bbox(p.area));
        all = pictures.fold(all, |all, p| all.union(p));
    }
    for f in g.filters.iter().filter(|_| input.keeps_filters(g)) {
        if let Some(s) = g.slot {
            let frame = input.written(g.slot, scene.slots[s].frame);
            let region = boxes::grown(f, growth);
            all = frame.transform_rect_bbox(areas::filter_box(f, region, frame.inverse().transform_rect_bbox(all))?);
        }
    }
    if let Some(i) = g.clip {
        all = overlap(all, warped_clip(input, i)?)?;
    }
    if let Some(mask) = g.mask.map(|i| &scene.masks[i]) {
        let boxes = mask.parts.clone().map(|i| {
            let p = &scene.parts[i];
            painted_box(p, input.warped(i), input.written(p.slot, p.frame))
        });
        all = overlap(all, boxes.reduce(|a, b| a.union(b))?)?;
        let region = mask.frame.transform_rect_bbox(mask.rect);
        let bend = input.bend(mask.parts.clone()).filter(|_| input.changes(mask.parts.clone()));
        all = overlap(all, bend.map_or(Some(region), |bend| image_box(bend, region))?)?;
    }
    (all.width() >= 0.0 && all.height() >= 0.0).then_some(all)
}

/// The unit in the page's width and height.
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

/// The names of the elements that have moved onto the page `shown` of the result.
pub(super) fn arrivals(input: &WriteInput<'_>, shown: Rect) -> Vec<String> {
    let Some(page) = input.drawing.specified_area() else { return Vec::new() };
    let mut found = BTreeSet::new();
    add_arrivals(input, &input.scene.root, (page, shown), &mut found);
    found.into_iter().map(|e| input.source.display_name(e)).collect()
}

/// Adds the elements of a group that lay off the page and now show in an area.
fn add_arrivals(input: &WriteInput<'_>, g: &Group, (page, shown): (Rect, Rect), found: &mut BTreeSet<ElementId>) {
    // The visible part of masked content is not known.
    if g.opacity <= 0.0 || g.mask.is_some() {
        return;
    }
    let Some(visible) = g.clip.map_or(Some(shown), |i| overlap(shown, warped_clip(input, i)?)) else { return };
    let least = VISIBLE * page.width().max(page.height());
    let shows = |after| overlap(after, visible).is_some_and(|o| o.width().max(o.height()) > least);
    let is_off = |before| overlap(before, page).is_none();
    for n in &g.children {
        match n {
            Node::Group(g) | Node::Text { content: g, .. } => add_arrivals(input, g, (page, visible), found),
            Node::Image(i) => {
                let arrived = image_boxes(input, *i).is_some_and(|(before, after)| is_off(before) && shows(after));
                found.extend(input.scene.bitmaps[*i].owner.filter(|_| arrived));
            }
            Node::Part(i) => {
                let p = input.part(*i);
                let quick = quick_box(p, None, p.frame);
                let was_off = || is_off(quick) || is_off(painted_box(p, None, p.frame));
                let after = || painted_box(p, input.warped(*i), input.written(p.slot, p.frame));
                let may_arrive = is_seen(p) && p.role == PartRole::Paint && !page.contains_rect(quick);
                found.extend(p.element().filter(|_| may_arrive && was_off() && shows(after())));
            }
        }
    }
}
