//! The maps that drawings are warped by.

use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, BezPath, Point, Rect, Shape as _, Vec2};
use pathwarp::map::{Class, Jet, Map};
use pathwarp::param::{Args, Frame};
use std::sync::Arc;

/// An affine map that hides its class, so that the fitter treats it as any other map.
pub(super) struct HiddenAffine(pub(super) Affine);

impl Map for HiddenAffine {
    fn jet(&self, p: Point) -> Jet {
        let [a, b, c, d, ..] = self.0.as_coeffs();
        Jet { p: self.0 * p, dx: Vec2::new(a, b), dy: Vec2::new(c, d) }
    }
}

/// The identity, declared as affine.
pub(super) struct Identity;

impl Map for Identity {
    fn jet(&self, p: Point) -> Jet {
        Jet { p, dx: Vec2::new(1.0, 0.0), dy: Vec2::new(0.0, 1.0) }
    }

    fn class(&self) -> Class {
        Class::Affine(Affine::IDENTITY)
    }
}

/// A shaper whose sides all swing by a fifth of the page.
pub(super) fn shaper(page: Rect) -> Option<Arc<dyn Map>> {
    const CAGE: &str = "M0.04,0.92 C0.3,0.7 0.6,1.12 0.95,0.84 C1.12,0.6 0.82,0.36 0.96,0.1 C0.7,-0.04 0.34,0.26 0.06,0.08 \
                        C-0.08,0.36 0.2,0.66 0.04,0.92 Z";
    let mut cage = BezPath::from_svg(CAGE).ok()?;
    cage.apply_affine(
        Affine::translate(page.origin().to_vec2()) * Affine::scale_non_uniform(page.width(), page.height()),
    );
    debug_assert!(cage.bounding_box().area() > 0.0);
    let args = Args::from_pairs(&[("shaper", &cage.to_svg())]);
    Some(Registry::builtin().get("shaper")?.build_from(&args, &Frame::new(page)).ok()?.map)
}
