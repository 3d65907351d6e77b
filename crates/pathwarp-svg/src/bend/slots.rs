//! Slots under a map, and frames in the result.

use super::bends::Bends;
use super::paint;
use crate::scene::affine::is_invertible;
use crate::scene::drawing::Drawing;
use crate::scene::model::{PartRole, Scene};
use pathwarp::kurbo::Affine;

/// A slot under a map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlacedSlot {
    /// Factor of the slot's transform.
    pub(crate) fit: Affine,
    /// From the slot's coordinates to root user space, as written.
    write: Affine,
}

/// Maps a frame to the result: inside a slot, it moves along.
pub(crate) fn written(scene: &Scene, placed: &[PlacedSlot], slot: Option<usize>, frame: Affine) -> Affine {
    match slot.and_then(|s| Some((placed.get(s)?, scene.slots.get(s)?))) {
        Some((p, s)) if p.write != s.frame => p.write * s.frame.inverse() * frame,
        _ => frame,
    }
}

/// Places filtered groups and images by the affine fit over each of the map that bends all of it. `of` has the index of what bends
/// each part.
pub(super) fn place(drawing: &Drawing, bends: &Bends<'_>, of: &[Option<usize>]) -> Vec<PlacedSlot> {
    let scene = drawing.scene();
    let mut out: Vec<PlacedSlot> = Vec::with_capacity(scene.slots.len());
    for s in &scene.slots {
        let outer = written(scene, &out, s.outer, s.frame);
        // Parts of tiles and of filters' pictures are never bent and do not count.
        let mut own = s.parts.clone().filter(|&i| scene.parts[i].role != PartRole::Pattern);
        let bend = match own.next() {
            Some(first) => of[first].filter(|k| own.all(|i| of[i] == Some(*k))),
            None => bends.of(s.owner.or(s.element)),
        };
        let fit = bend
            .filter(|_| is_invertible(s.frame) && is_invertible(outer))
            .and_then(|k| paint::fit(s.area, s.frame, outer, bends.each[k].map))
            .filter(|f| is_invertible(f.affine) && !f.is_identity(s.area));
        let fit = fit.map_or(Affine::IDENTITY, |f| f.affine);
        out.push(PlacedSlot { fit, write: outer * fit });
    }
    out
}
