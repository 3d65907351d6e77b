//! The image of a drawing: all parts, in parallel, with slots and bitmaps.

use super::bitmap::{self, EmbeddedImage};
use super::letters;
use super::options::{OnError, TextMode, WarpOptions};
use super::outcome::{PartOutcome, Skipped, WarpedDocument, WarpedPart};
use super::part;
use super::shading::Shading;
use super::slots::{self, PlacedSlot, written};
use super::task::{PartContext, PartTask, ROUNDING};
use super::warning::Warning;
use crate::scene::affine::is_invertible;
use crate::scene::drawing::Drawing;
use crate::scene::model::{Bitmap, Part, PartRole};
use crate::source::parallel::map_parallel;
use crate::source::tags::ElementId;
use pathwarp::kurbo::Affine;
use pathwarp::map::{Class, Gathered, Map};
use pathwarp::refit::KnownShapes;
use pathwarp::{Error, GeometryError};
use std::collections::HashMap;

/// Width of a hairline in millimetres: a quarter of a point is 0.088 mm, and laser and plotter programs take lines up to 0.1 mm for
/// paths to follow. There is room for the rounding of the page's size and the width.
const HAIRLINE: f64 = 0.1001;

/// The image of a drawing.
pub(crate) struct BentDrawing {
    /// One for each part.
    pub(crate) outcomes: Vec<PartOutcome>,
    /// One for each bitmap.
    pub(crate) images: Vec<EmbeddedImage>,
    /// One for each slot.
    pub(crate) slots: Vec<PlacedSlot>,
}

/// Returns `true` if nothing moves.
pub(crate) fn is_identity(map: &dyn Map, options: &WarpOptions) -> bool {
    map.class() == Class::Affine(Affine::IDENTITY) && options.copies.is_empty() && options.letters.places.is_empty()
}

/// Bends everything in a drawing and reports to `out`.
pub(crate) fn bend(
    drawing: &Drawing,
    map: &dyn Map,
    options: &WarpOptions,
    out: &mut WarpedDocument,
) -> Result<BentDrawing, Error> {
    let scene = drawing.scene();
    let selected = bent_parts(drawing, options);
    let slots = slots::place(drawing, map, &selected, &options.selection);
    let results = warp_parts(drawing, map, options, &selected, &slots);
    let mut outcomes = Vec::with_capacity(scene.parts.len());
    // Index of each element's report: tiles and markers may come between the parts of an element.
    let mut reports: HashMap<ElementId, usize> = HashMap::new();
    for (i, r) in results.into_iter().enumerate() {
        let part = &scene.parts[i];
        outcomes.push(match r {
            None => PartOutcome::Kept,
            Some(Ok(warped)) => {
                let id = &drawing.shapes()[i].id;
                if let Some(why) = &warped.unpainted {
                    out.warnings.push(Warning::FittedGradient { id: id.clone(), why: why.to_string() });
                }
                if let Some(error) = warped.stroke_error.filter(|_| warped.stroke_refused) {
                    out.warnings.push(Warning::SingleWidth { id: id.clone(), error });
                }
                let element = part.element();
                let known = element.and_then(|e| reports.get(&e).copied());
                let report = out.report(id.clone(), &warped, options.copies.len().max(1), known);
                reports.extend(element.map(|e| (e, report)));
                PartOutcome::Warped(Box::new(warped))
            }
            // Tiles extend past their shape, possibly out of the map's domain. The pattern then follows as a whole.
            Some(Err(e)) if part.in_tile && !matches!(e, GeometryError::Limit(_)) => PartOutcome::Kept,
            Some(Err(e)) => {
                let id = &drawing.shapes()[i].id;
                let e = e.on_shape(id);
                let limited = matches!(e, GeometryError::Limit(_));
                if limited || options.on_error == OnError::Stop && part.painted() {
                    return Err(Error::Geometry(e));
                }
                out.skipped.push(Skipped { id: id.clone(), why: e.to_string() });
                PartOutcome::Kept
            }
        });
    }
    out.skipped.extend(drawing.far().reasons.iter().map(|(id, why)| Skipped { id: id.clone(), why: why.clone() }));
    warn(drawing, options, &outcomes, &slots, out);
    let elements = options.selection.resolve(&drawing.source);
    let is_selected = |b: &Bitmap| b.owner.map_or(options.selection.is_everything(), |e| elements[e]);
    let bend = |b: &Bitmap| bitmap::bend(b, scene, &slots, is_selected(b), map, &options.images);
    let images = scene.bitmaps.iter().map(bend).collect();
    Ok(BentDrawing { outcomes, images, slots })
}

/// Warps the selected parts; `None` for the others.
fn warp_parts(
    drawing: &Drawing,
    map: &dyn Map,
    options: &WarpOptions,
    selected: &[bool],
    slots: &[PlacedSlot],
) -> Vec<Option<Result<WarpedPart, GeometryError>>> {
    /// With fewer segments, starting threads takes longer than the work.
    const WORTH_IT: usize = 1000;
    let scene = drawing.scene();
    let (parts, shapes) = (&scene.parts, drawing.shapes());
    let pieces = letters::pieces(drawing, options);
    let gradients = if options.paints_gradients() { parts.iter().map(gradients).sum() } else { 0 };
    let hairline = drawing.millimetre().map_or(0.0, |mm| HAIRLINE * mm);
    let identity = is_identity(map, options);
    let known = if identity { KnownShapes::default() } else { known_shapes(drawing, map, options, selected) };
    let context = PartContext { map, options, known: &known, to_px: scene.to_px, gradients, hairline };
    let warp = |i: usize| {
        let p = &parts[i];
        let gathered = map.prefers_batches().then(|| Gathered::new(map));
        let context = PartContext { map: gathered.as_ref().map_or(map, |g| g as &dyn Map), ..context };
        let write = written(scene, slots, p.slot, p.frame);
        (selected[i] && !identity && is_invertible(p.frame) && is_invertible(write))
            .then(|| part::warp(&PartTask::new(p, shapes[i].outline.clone(), write, &context, &pieces[i])))
    };
    let segments =
        || -> usize { parts.iter().map(|p| p.local.segs().count()).sum::<usize>() * options.copies.len().max(1) };
    if identity || segments() < WORTH_IT {
        (0..parts.len()).map(warp).collect()
    } else {
        map_parallel(parts.len(), |i| warp(i).map(|warped| warped.map(WarpedPart::with_data)))
    }
}

/// The shapes that come again from one part to the next.
fn known_shapes(drawing: &Drawing, map: &dyn Map, options: &WarpOptions, selected: &[bool]) -> KnownShapes {
    let bent = drawing.shapes().iter().zip(selected).filter(|(_, bent)| **bent);
    // Most parts have less than the whole tolerance, because they are rounded.
    let finer = options.refit.clone().with_tolerance((1.0 - ROUNDING) * options.refit.tolerance);
    KnownShapes::among(bent.map(|(s, _)| &*s.outline), map, &finer)
}

/// Number of gradients on a part.
fn gradients(p: &Part) -> usize {
    let is_gradient = |p: &usvg::Paint| usize::from(Shading::of(p).is_some());
    p.fill.as_ref().map_or(0, |f| is_gradient(f.paint())) + p.stroke.as_ref().map_or(0, |s| is_gradient(s.paint()))
}

fn warn(
    drawing: &Drawing,
    options: &WarpOptions,
    outcomes: &[PartOutcome],
    slots: &[PlacedSlot],
    out: &mut WarpedDocument,
) {
    if options.copies.len() > 1 && outcomes.iter().any(|o| o.warped().is_some_and(|d| d.fit.is_some())) {
        out.warnings.push(Warning::SharedPaints);
    }
    if options.copies.len() > 1 && slots.iter().any(|s| s.fit != Affine::IDENTITY) {
        out.warnings.push(Warning::SharedImages);
    }
    if !drawing.missed.fonts.is_empty() {
        out.warnings.push(Warning::MissingFonts(drawing.missed.fonts.clone()));
    }
}

/// Determines the parts to warp. Clip paths and masks follow the elements that refer to them.
pub(crate) fn bent_parts(drawing: &Drawing, options: &WarpOptions) -> Vec<bool> {
    let scene = drawing.scene();
    let mut selected = drawing.selected_parts(&options.selection);
    let all = options.selection.is_everything();
    let elements = options.selection.resolve(&drawing.source);
    let clips = scene.clips.iter().map(|c| (&c.parts, &c.referrers));
    let masks = scene.masks.iter().map(|m| (&m.parts, &m.referrers));
    for (parts, referrers) in clips.chain(masks) {
        let any = all || referrers.iter().any(|r| r.owner.or(r.element).is_some_and(|e| elements[e]));
        selected[parts.clone()].fill(any);
    }
    let far = drawing.far();
    for (i, (s, p)) in selected.iter_mut().zip(&scene.parts).enumerate() {
        let text = p.owner.is_some_and(|e| drawing.source.elements[e].tag == "text");
        *s &= !far.holds(i) && p.role != PartRole::Pattern && !(text && options.text == TextMode::Skip);
    }
    selected
}
