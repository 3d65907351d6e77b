//! A map as it is on one patch: at sides that lie in a crease, the patch's own side of it counts.

use super::bezier::BezierPatch;
use crate::box3::Box3;
use crate::map::{Chain3, Collineation, Creases3, Map3};
use pathwarp::map::CreaseKind;
use std::sync::Arc;

/// The map on a patch.
pub(super) struct Sided {
    pub(super) map: Chain3,
    /// No crease of it crosses or touches the patch, as far as the patch's box tells.
    pub(super) smooth: bool,
}

impl Sided {
    pub(super) fn new(patch: &BezierPatch, map: &Chain3) -> Self {
        let mut out = Self { map: Chain3::default(), smooth: true };
        let mut on = patch.bounds();
        for step in map.steps() {
            let own = on.and_then(|on| step.branch(&on));
            out.smooth &= own.is_some() || !has_kinks(&**step);
            let own = own.unwrap_or_else(|| Arc::clone(step));
            // The images of other steps are not known as boxes.
            on = on.zip(own.collineation()).and_then(|(on, c)| image(&on, c));
            out.map.push(own);
        }
        out
    }
}

fn has_kinks(map: &dyn Map3) -> bool {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    creases.items().iter().any(|c| c.kind == CreaseKind::Kink)
}

/// The box of a box's image.
fn image(on: &Box3, map: &Collineation) -> Option<Box3> {
    let ahead = on.corners().iter().all(|p| map.matrix().row(3).dot(p.extend(1.0)) > 0.0);
    if ahead { Box3::around(on.corners().map(|p| map.point(p))) } else { None }
}
