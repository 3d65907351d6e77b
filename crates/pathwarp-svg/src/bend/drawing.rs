//! Bends a whole drawing: its parts, in parallel, its bitmaps, and the affine fits of its slots, the groups that move as a whole.

use super::bends::{Bend, Bends};
use super::fits::{self, EmbeddedImage, FilterOutcome, PlacedSlot, frame_in_result};
use super::line::{self, Line};
use super::options::{Edit, OnError, has_lines_that_stay};
use super::outcome::{PartOutcome, Skipped, Warning, WarpedDocument, WarpedPart};
use super::part;
use super::path::ROUNDING;
use super::pictures::BentImage;
use super::shading::Shading;
use super::task::{self, LetterPiece, PartContext, PartTask};
use super::united::{self, United};
use crate::scene::drawing::Drawing;
use crate::scene::geometry::is_invertible;
use crate::scene::model::{Bitmap, Part, Scene};
use crate::source::elements::ElementId;
use crate::source::threads::map_parallel;
use pathwarp::engine::{Gathered, KnownShapes};
use pathwarp::kurbo::Affine;
use pathwarp::map::Map;
use pathwarp::{Error, GeometryError, Outline};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// Largest width of a hairline in millimetres. A quarter of a point is 0.088 mm, and laser and plotter programs treat lines up to 0.1 mm
/// as paths to follow. The excess over 0.1 allows for rounding of the page's size and the width.
const HAIRLINE: f64 = 0.1001;

/// The image of a drawing.
pub(crate) struct BentDrawing {
    /// One for each part.
    pub(crate) outcomes: Vec<PartOutcome>,
    /// One for each bitmap.
    pub(crate) images: Vec<EmbeddedImage>,
    /// One for each slot.
    pub(crate) slots: Vec<PlacedSlot>,
    /// For each part, the index of its bend.
    pub(crate) part_bends: Vec<Option<usize>>,
    /// Results for filters, by the index of their slot. The document adds them after [`bend`].
    pub(crate) filters: BTreeMap<usize, FilterOutcome>,
    pub(crate) united: United,
    /// The line around the visible artwork, if one is wanted.
    pub(crate) line: Option<Line>,
}

/// Bends everything in a drawing and reports to `out`.
pub(crate) fn bend(drawing: &Drawing, bends: &Bends<'_>, out: &mut WarpedDocument) -> Result<BentDrawing, Error> {
    let (scene, options) = (drawing.scene(), &bends.options);
    let part_bends = bends.part_bends(drawing);
    let slots = fits::place_slots(drawing, bends, &part_bends);
    let united = united::unite_drawing(drawing, bends, &part_bends)?;
    let results = warp_parts(drawing, bends, &part_bends, (&slots, &united));
    let mut outcomes = Vec::with_capacity(scene.parts.len());
    // Index each element's report, since tiles and markers may come between the parts of an element.
    let mut reports: HashMap<ElementId, usize> = HashMap::new();
    for (i, result) in results.into_iter().enumerate() {
        let (part, id) = (&scene.parts[i], &drawing.shapes()[i].id);
        outcomes.push(match result {
            None => PartOutcome::Kept,
            Some(Ok(warped)) if united.absorbs(i) => PartOutcome::Warped(Box::new(warped)),
            Some(Ok(mut warped)) => {
                let stays = matches!(options.edit, Some(Edit::Simplify { .. })) && warped.reset_if_no_fewer();
                if let Some(why) = &warped.unpainted {
                    out.warnings.push(Warning::FittedGradient { id: id.clone(), why: why.to_string() });
                }
                if let Some(error) = warped.stroke_error.filter(|_| warped.stroke_off_domain) {
                    out.warnings.push(Warning::SingleWidth { id: id.clone(), error });
                }
                let element = part.element();
                let known = element.and_then(|e| reports.get(&e).copied());
                let copies = part_bends[i].map_or(0, |k| bends.each[k].options.copies.len());
                let report = out.report(id, &warped, copies.max(1), known);
                reports.extend(element.map(|e| (e, report)));
                if stays { PartOutcome::Kept } else { PartOutcome::Warped(Box::new(warped)) }
            }
            // Tiles extend past their shape and may leave the map's domain. The pattern then follows as a whole.
            Some(Err(e)) if part.in_tile && !matches!(e, GeometryError::Limit(_)) => PartOutcome::Kept,
            Some(Err(e)) => {
                let e = e.on_shape(id);
                let is_limit = matches!(e, GeometryError::Limit(_));
                if is_limit || (options.on_error == OnError::Stop && part.painted()) {
                    return Err(Error::Geometry(e));
                }
                out.skipped.push(Skipped { id: id.clone(), why: e.to_string() });
                PartOutcome::Kept
            }
        });
    }
    out.skipped
        .extend(drawing.out_of_range().reasons.iter().map(|(id, why)| Skipped { id: id.clone(), why: why.clone() }));
    warn(drawing, bends, &part_bends, &outcomes, &slots, out);
    united.report(drawing, &reports, out);
    let line = line::draw(drawing, bends, &part_bends, out)?;
    let bend = |b: &Bitmap| bends.bend_of(b.owner).map(|k| &bends.each[k]);
    let images: Vec<_> = scene.bitmaps.iter().map(|b| fits::bend_bitmap(b, scene, &slots, bend(b))).collect();
    for (b, image) in scene.bitmaps.iter().zip(&images) {
        if let EmbeddedImage::Bent { image: BentImage { lost: Some(text), .. }, .. } = image {
            let name = drawing.source.image_name(b.owner);
            out.warnings.push(Warning::Note { text, names: vec![name] });
        }
    }
    Ok(BentDrawing { outcomes, images, slots, part_bends, filters: BTreeMap::new(), united, line })
}

/// Warps every part by the bend whose index `part_bends` gives; `None` for parts that are not bent.
fn warp_parts(
    drawing: &Drawing,
    bends: &Bends<'_>,
    part_bends: &[Option<usize>],
    (slots, united): (&[PlacedSlot], &United),
) -> Vec<Option<Result<WarpedPart, GeometryError>>> {
    /// With fewer segments, starting threads takes longer than the work.
    const WORTH_THREADS: usize = 1000;
    let scene = drawing.scene();
    let (parts, shapes) = (&scene.parts, drawing.shapes());
    let pieces: Vec<_> = bends.each.iter().map(|b| task::placed_letters(drawing, &b.options)).collect();
    let shared = bends.each.iter().zip(&pieces).enumerate();
    let shared = shared.map(|(k, (b, pieces))| with_shared_edges(drawing, b, (part_bends, k), pieces));
    let (bends_of, contour_tolerances): (Vec<Bend<'_>>, Vec<_>) = shared.unzip();
    let known: Vec<_> = bends_of.iter().enumerate().map(|(k, b)| known_shapes(drawing, b, part_bends, k)).collect();
    let gradient_count = if bends.options.paints_gradients() { parts.iter().map(count_gradients).sum() } else { 0 };
    let hairline = drawing.millimetre().map_or(0.0, |mm| HAIRLINE * mm);
    let warp = |i: usize| {
        let k = part_bends[i].filter(|&k| !bends_of[k].is_identity())?;
        let (p, Bend { map, options }) = (&parts[i], &bends_of[k]);
        let union = united.outlines.get(&i);
        let unites = matches!(options.edit, Some(Edit::Unite { .. }));
        if (unites && union.is_none()) || options.edit.is_some_and(|e| !e.concerns(p, &drawing.source)) {
            return None;
        }
        let gathered = map.prefers_batches().then(|| Gathered::new(*map));
        let map = gathered.as_ref().map_or(*map, |g| g as &dyn Map);
        let context =
            PartContext { map, options, known: &known[k], drawing, to_px: scene.to_px, gradient_count, hairline };
        let frame_to_write = frame_in_result(scene, slots, p.slot, p.frame);
        (is_invertible(p.frame) && is_invertible(frame_to_write)).then(|| {
            let outline = match union {
                Some(union) => (union.clone(), &[][..]),
                None => (shapes[i].outline.clone(), &contour_tolerances[k][i][..]),
            };
            // In a view of a surface in space, a part may lie behind others.
            part::warp(&PartTask::new(p, outline, frame_to_write, &context, &pieces[k][i]).without_hidden()?)
        })
    };
    let copies = bends_of.iter().map(|b| b.options.copies.len()).max().unwrap_or_default();
    let segments = || -> usize { parts.iter().map(|p| p.local.segs().count()).sum::<usize>() * copies.max(1) };
    if bends.is_identity() || segments() < WORTH_THREADS {
        (0..parts.len()).map(warp).collect()
    } else {
        map_parallel(parts.len(), |i| warp(i).map(|warped| warped.map(WarpedPart::with_data)))
    }
}

/// The outlines to which bend `k` applies.
fn outlines_of<'a>(drawing: &'a Drawing, part_bends: &[Option<usize>], k: usize) -> impl Iterator<Item = &'a Outline> {
    drawing.shapes().iter().zip(part_bends).filter(move |(_, bend)| **bend == Some(k)).map(|(s, _)| &*s.outline)
}

/// A bend with the edges that its shapes share, which get equal curves in each of them, and the tolerances of the contours of every part.
/// An edge with another map on its other side is not shared.
fn with_shared_edges<'a>(
    drawing: &Drawing,
    bend: &Bend<'a>,
    (part_bends, k): (&[Option<usize>], usize),
    pieces: &[Vec<LetterPiece>],
) -> (Bend<'a>, Vec<Vec<f64>>) {
    let mut bend = bend.clone();
    bend.options.edit = edit_of(drawing, &bend, part_bends, k);
    let contours = task::contour_tolerances(drawing, &bend, part_bends, k);
    let refit = &bend.options.refit;
    let simplifies = matches!(bend.options.edit, Some(Edit::Simplify { .. }));
    // Merged nodes, and small contours with tolerances of their own (`suited`), would differ on both sides of an edge.
    if (refit.nodes.merges() || refit.suited || simplifies) && !bend.is_identity() {
        let outline =
            |i: usize| task::placed_outline(&drawing.shapes()[i].outline, &contours[i], &bend.options, &pieces[i]);
        let placed: Vec<_> = (0..part_bends.len()).filter(|&i| part_bends[i] == Some(k)).map(outline).collect();
        let all = placed.iter().map(|(o, contours)| (&**o, &contours[..]));
        if simplifies {
            // Simplifying replaces whole chains of segments, which must end where other borders meet them.
            let borders = pathwarp::engine::Borders::among(&all.collect::<Vec<_>>(), refit.tolerance);
            bend.options.refit.borders = Arc::new(borders);
        } else {
            bend.options.refit.shared = Arc::new(pathwarp::engine::SharedEdges::held(all));
        }
    }
    (bend, contours)
}

/// The edit of bend `k`, adapted to its parts.
fn edit_of(drawing: &Drawing, bend: &Bend<'_>, part_bends: &[Option<usize>], k: usize) -> Option<Edit> {
    let parts = drawing.scene().parts.iter().zip(part_bends).filter(|(_, bend)| **bend == Some(k));
    bend.options.edit.map(|edit| edit.for_parts(parts.map(|(p, _)| p)))
}

/// The images of shapes that recur in several parts.
fn known_shapes(drawing: &Drawing, bend: &Bend<'_>, part_bends: &[Option<usize>], k: usize) -> KnownShapes {
    if bend.is_identity() {
        return KnownShapes::default();
    }
    // In most parts, rounding of the written coordinates uses this share of the tolerance.
    let refit = &bend.options.refit;
    let finer = refit.clone().with_tolerance((1.0 - ROUNDING) * refit.tolerance).with_suited(false);
    KnownShapes::among(outlines_of(drawing, part_bends, k), bend.map, &finer)
}

fn count_gradients(p: &Part) -> usize {
    let is_gradient = |p: &usvg::Paint| usize::from(Shading::from_paint(p).is_some());
    p.fill.as_ref().map_or(0, |f| is_gradient(f.paint())) + p.stroke.as_ref().map_or(0, |s| is_gradient(s.paint()))
}

impl BentDrawing {
    /// The drawing without changes.
    pub(crate) fn unbent(scene: &Scene) -> Self {
        Self {
            outcomes: scene.parts.iter().map(|_| PartOutcome::Kept).collect(),
            images: scene.bitmaps.iter().map(|_| EmbeddedImage::Placed).collect(),
            slots: fits::unmoved(scene),
            part_bends: vec![None; scene.parts.len()],
            filters: BTreeMap::new(),
            united: United::default(),
            line: None,
        }
    }
}

/// Warns about paints and images that copies share, lines that an edit leaves, emoji, and missing fonts and letters.
fn warn(
    drawing: &Drawing,
    bends: &Bends<'_>,
    part_bends: &[Option<usize>],
    outcomes: &[PartOutcome],
    slots: &[PlacedSlot],
    out: &mut WarpedDocument,
) {
    let repeats = bends.each.iter().any(|b| b.options.copies.len() > 1);
    if repeats && outcomes.iter().any(|o| o.warped().is_some_and(|d| d.fit.is_some())) {
        out.warnings.push(Warning::SharedPaints);
    }
    if repeats && slots.iter().any(|s| s.fit != Affine::IDENTITY) {
        out.warnings.push(Warning::SharedImages);
    }
    for (k, bend) in bends.each.iter().enumerate() {
        let Some(edit) = edit_of(drawing, bend, part_bends, k) else { continue };
        let stays = |i: &usize| part_bends[*i] == Some(k) && has_lines_that_stay(edit, &drawing.scene().parts[*i]);
        let mut names: Vec<_> = (0..part_bends.len()).filter(stays).map(|i| drawing.shapes()[i].id.clone()).collect();
        names.dedup();
        if !names.is_empty() {
            let text = "open lines stay where they are (--lines moves them, too)";
            out.warnings.push(Warning::Note { text, names });
        }
    }
    let of_text = |b: &&Bitmap| b.owner.is_some_and(|e| drawing.source.elements[e].tag == "text");
    let bent = drawing.scene().bitmaps.iter().filter(of_text).filter(|b| bends.bend_of(b.owner).is_some());
    let names: BTreeSet<String> = bent.map(|b| drawing.source.image_name(b.owner)).collect();
    if !names.is_empty() {
        let text = "letters whose font has them as bitmaps only, such as emoji, become pictures";
        out.warnings.push(Warning::Note { text, names: names.into_iter().collect() });
    }
    let bends_text =
        || drawing.scene().texts.iter().any(|t| outcomes.get(t.first).is_some_and(|o| o.warped().is_some()));
    if !drawing.missed.fonts.is_empty() && bends_text() {
        out.warnings.push(Warning::MissingFonts(drawing.missed.fonts.clone()));
    }
    if !drawing.missed.letters.is_empty() && bends_text() {
        out.warnings.push(Warning::MissingLetters(drawing.missed.without_font()));
    }
}
