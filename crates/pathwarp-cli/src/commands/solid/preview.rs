//! `--preview` of a solid: before (above) and after (below), each from two cameras.

use crate::advice;
use crate::bitmap::encode;
use crate::bitmap::work::{self, Pixel};
use crate::failure::Failure;
use crate::input::PREVIEW;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp_raster::Pixmap;
use pathwarp_solid::Box3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::mesh::Mesh;
use pathwarp_solid::picture::{Camera3, draw, samples};
use std::path::Path;

/// Pixels along a side of a panel.
const SIDE: usize = 480;
/// White pixels between panels.
const GAP: usize = 8;

/// What a preview shows.
pub(super) struct Preview<'a> {
    pub(super) before: &'a Mesh,
    pub(super) after: &'a Mesh,
    pub(super) guides: &'a [Vec<DVec3>],
    /// The place from which nothing seems to change: the first camera.
    pub(super) eye: Option<DVec3>,
}

impl Preview<'_> {
    /// The picture, in the format of the file's extension.
    pub(super) fn file(&self, file: &Path, quality: Option<u8>, budget: &Budget) -> Result<Vec<u8>, Failure> {
        let format = PREVIEW.format(Some(file), None)?;
        let whole = 2 * SIDE + GAP;
        let size = u32::try_from(whole).unwrap_or(u32::MAX);
        let too_large = || Failure::Output(format!("{}: too large to draw", file.display()));
        let mut picture = Pixmap::new(size, size).ok_or_else(too_large)?;
        picture.data_mut().fill(u8::MAX);
        let boxes = [self.before.bounds(), self.after.bounds()].into_iter().flatten();
        let scene = Box3::around(boxes.flat_map(|b| [b.min, b.max]));
        let scene = scene.unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ONE });
        let front = || Camera3::towards(DVec3::new(0.45, 0.4, 1.0), scene);
        let first = self.eye.and_then(|eye| Camera3::at(eye, scene)).or_else(front);
        let second = Camera3::towards(DVec3::new(1.0, 0.4, 0.35), scene);
        for (row, (mesh, guides)) in [(self.before, &[][..]), (self.after, self.guides)].into_iter().enumerate() {
            for (column, camera) in [first, second].into_iter().flatten().enumerate() {
                let counted = work::spend(budget, Pixel::Sampled, samples(mesh, &camera, SIDE));
                counted.map_err(|e| too_much(&e))?;
                let panel = draw(mesh, guides, &camera, SIDE);
                for (y, line) in panel.chunks(4 * SIDE).enumerate() {
                    let at = 4 * ((row * (SIDE + GAP) + y) * whole + column * (SIDE + GAP));
                    picture.data_mut()[at..at + line.len()].copy_from_slice(line);
                }
            }
        }
        encode(picture, format, quality)
    }
}

fn too_much(e: &Exceeded) -> Failure {
    Failure::Input(format!("the preview takes {e}; leave it out, or {}", advice::raise(e)))
}
