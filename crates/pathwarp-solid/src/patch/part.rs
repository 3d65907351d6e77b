//! Parts of a Bézier patch, as Bézier patches, and maps as they act on one patch.

use super::surface::BezierPatch;
use crate::map::{Chain3, Collineation, Creases3, Map3};
use crate::settings::Box3;
use glam::DVec4;
use pathwarp::map::CreaseKind;
use std::sync::Arc;

impl BezierPatch {
    /// Returns the part over `from[0]`..`to[0]` × `from[1]`..`to[1]`, with parameters 0..1 × 0..1.
    #[must_use]
    pub(super) fn part(&self, from: [f64; 2], to: [f64; 2]) -> Self {
        let rows = self.points.chunks(self.degree[0] + 1);
        let points = rows.flat_map(|row| section(row, from[0], to[0])).collect();
        let Self { degree, points } = Self { degree: self.degree, points }.transposed();
        let columns = points.chunks(degree[0] + 1);
        let points = columns.flat_map(|column| section(column, from[1], to[1])).collect();
        Self { degree, points }.transposed()
    }

    /// Returns the patch with u and v exchanged.
    #[must_use]
    pub(super) fn transposed(&self) -> Self {
        let width = self.degree[0] + 1;
        let points = (0..width).flat_map(|i| self.points.iter().skip(i).step_by(width).copied()).collect();
        Self { degree: [self.degree[1], self.degree[0]], points }
    }
}

/// Returns the control points of a Bézier curve between two parameters. The k-th is the polar form at n − k times `from` and k times `to`.
pub(super) fn section(points: &[DVec4], from: f64, to: f64) -> Vec<DVec4> {
    let n = points.len().saturating_sub(1);
    let polar = |k: usize| {
        let mut row = points.to_vec();
        for r in 0..n {
            let t = if r < n - k { from } else { to };
            for i in 0..n - r {
                row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
            }
        }
        row[0]
    };
    (0..=n).map(polar).collect()
}

/// A map as it acts on one patch: a step with a crease that the patch at most touches is replaced by its branch on the patch's side.
pub(super) struct LocalMap {
    pub(super) map: Chain3,
    /// `true` if no crease crosses or touches the patch, as far as its bounding box shows.
    pub(super) is_smooth: bool,
}

impl LocalMap {
    pub(super) fn new(patch: &BezierPatch, map: &Chain3) -> Self {
        let mut out = Self { map: Chain3::default(), is_smooth: true };
        let mut bounds = patch.bounds();
        for step in map.steps() {
            let branch = bounds.and_then(|b| step.branch(&b));
            out.is_smooth &= branch.is_some() || !has_kinks(&**step);
            let local = branch.unwrap_or_else(|| Arc::clone(step));
            // The box of the image is only known for collineations.
            bounds = bounds.zip(local.collineation()).and_then(|(b, c)| image_box(&b, c));
            out.map.push(local);
        }
        out
    }
}

fn has_kinks(map: &dyn Map3) -> bool {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    creases.items().iter().any(|c| c.kind == CreaseKind::Kink)
}

/// Returns the bounding box of a box's image, if the box is all in front of the vanishing plane.
fn image_box(bounds: &Box3, map: &Collineation) -> Option<Box3> {
    let is_in_front = bounds.corners().iter().all(|p| map.homogeneous(*p).w > 0.0);
    if is_in_front { Box3::around(bounds.corners().map(|p| map.point(p))) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_the_patch_there() {
        let points = (0..12).map(|k| {
            let k = f64::from(k);
            DVec4::new((3.0 * k) % 7.0, (5.0 * k) % 11.0, k, 1.0 + (k % 3.0))
        });
        let patch = BezierPatch { degree: [3, 2], points: points.collect() };
        let part = patch.part([0.2, 0.5], [0.7, 0.9]);
        for (s, t) in [(0.0, 0.0), (0.3, 0.8), (1.0, 0.4)] {
            let off = part.homogeneous(s, t)[0] - patch.homogeneous(0.2 + 0.5 * s, 0.5 + 0.4 * t)[0];
            assert!(off.length() < 1e-12, "{off}");
            let off = patch.transposed().homogeneous(t, s)[0] - patch.homogeneous(s, t)[0];
            assert!(off.length() < 1e-12, "{off}");
        }
        assert_eq!(patch.part([0.0; 2], [1.0; 2]), patch);
    }
}
