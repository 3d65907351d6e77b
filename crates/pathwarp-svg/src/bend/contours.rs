//! The tolerances of contours that are small in their drawing; see [`suited`].

use super::bends::Bend;
use super::letters::{LetterPiece, placed};
use super::options::WarpOptions;
use crate::scene::drawing::Drawing;
use crate::scene::seen::reach;
use pathwarp::Outline;
use pathwarp::kurbo::Rect;
use pathwarp::refit::{RESOLUTION, suited};
use std::sync::Arc;

/// The tolerances of the contours of every part, one for each subpath; none for parts that are held to that of the drawing.
pub(super) fn of_parts(drawing: &Drawing, bend: &Bend<'_>, of: &[Option<usize>], k: usize) -> Vec<Vec<f64>> {
    let (parts, shapes) = (&drawing.scene().parts, drawing.shapes());
    let tolerance = bend.options.refit.tolerance;
    let to_px = drawing.scene().to_px;
    let own = |i: usize| {
        if of[i] != Some(k) || !bend.options.refit.suited {
            return Vec::new();
        }
        let is_text = shapes[i].element == "text";
        of_part(&shapes[i].outline, reach(&parts[i], to_px), is_text, tolerance)
    };
    let all: Vec<Vec<f64>> = (0..parts.len()).map(own).collect();
    let is_small = |t: &f64| *t < tolerance;
    if all.iter().flatten().any(is_small) { all } else { vec![Vec::new(); parts.len()] }
}

fn of_part(outline: &Outline, reach: f64, is_text: bool, tolerance: f64) -> Vec<f64> {
    // Finer than its numbers, nothing can be followed.
    let finest = (4.0 * RESOLUTION * outline.extent()).min(tolerance);
    let boxes: Vec<Rect> = outline.subpaths.iter().map(|s| s.bounding_box().inflate(reach, reach)).collect();
    let size = |b: Rect| b.size().to_vec2().hypot();
    let own = |i: usize| {
        let around = if is_text { letter(&boxes, i) } else { boxes[i] };
        suited(tolerance, size(around)).max(finest)
    };
    (0..boxes.len()).map(own).collect()
}

/// The box of the letter that a subpath of a text belongs to: its own, or that of a neighbour whose hole it is.
fn letter(boxes: &[Rect], i: usize) -> Rect {
    /// Letters have at most a few holes.
    const NEIGHBOURS: usize = 4;
    let near = &boxes[i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(boxes.len())];
    let holds = |b: &&Rect| b.union(boxes[i]) == **b;
    near.iter().filter(holds).copied().fold(boxes[i], |a, b| if b.area() > a.area() { b } else { a })
}

/// The outline that is bent of a part: all copies, or the placed letters; with the tolerances of its contours.
pub(super) fn placed_outline(
    whole: &Arc<Outline>,
    contours: &[f64],
    options: &WarpOptions,
    pieces: &[LetterPiece],
) -> (Arc<Outline>, Vec<f64>) {
    match (pieces, options.copies.as_slice()) {
        ([], []) => (Arc::clone(whole), contours.to_vec()),
        ([], copies) => (Arc::new(whole.repeated(copies)), contours.repeat(copies.len())),
        _ => (Arc::new(placed(whole, pieces)), pieces.iter().flat_map(|p| p.repeated(contours)).collect()),
    }
}
