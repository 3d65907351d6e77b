//! The affine map, by a matrix, by three points, or by parts.
//!
//! x' = a·x + c·y + e, y' = b·x + d·y + f. By parts, about a fixed point O: first scale, then skew, then rotate, then move.

use super::built::Built;
use super::entry::{Case, Deformation, Example, Info, Law};
use crate::error::{Error, GeometryError};
use crate::map::AffineMap;
use crate::param::{Axis, Kind, Param, Settings};
use kurbo::{Affine, Vec2};
use std::sync::Arc;

pub(super) struct AffineDeformation;

static INFO: Info = Info::new("affine", "scale, skew, rotate and move, or apply any matrix")
    .group("Basics")
    .about("Scales, skews, rotates and moves the artwork, in this order, about a point; or applies a matrix as SVG writes it. Control \
points are moved exactly; no node is added.")
    .source("SVG 2, section 8.5 (the transform property)")
    .params(&[
        Param::new("matrix", Kind::Numbers(6), "The matrix a,b,c,d,e,f as in SVG's matrix(); instead of the parts."),
        Param::number("scale-x", "Scale across.").default("1").slider(-2.0, 2.0),
        Param::number("scale-y", "Scale up and down.").default("1").slider(-2.0, 2.0),
        Param::angle("skew-x", "Lean: verticals turn by this angle.").default("0").slider(-60.0, 60.0),
        Param::angle("skew-y", "Slope: horizontals turn by this angle.").default("0").slider(-60.0, 60.0),
        Param::angle("rotate", "Turn, clockwise on the screen.").default("0"),
        Param::length("move-x", Axis::X, "Shift to the right.").default("0"),
        Param::length("move-y", Axis::Y, "Shift downwards.").default("0"),
        Param::new("about", Kind::Point, "The point that scaling, skewing and rotating leave in place.")
            .default("50%,50%"),
    ])
    .demo(&[("rotate", "20"), ("scale-x", "80%"), ("skew-x", "15")])
    .examples(&[
        Example {
            what: "Lean lettering into an oblique",
            command: "affine samples/lettering.svg --skew-x -12 --about 0%,100% -o out.svg",
        },
        Example {
            what: "A matrix as SVG writes it",
            command: "affine samples/icon.svg --matrix 0.8,0.2,-0.1,0.9,3,1 -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[]),
        Law::Identity(&[("rotate", "1turn"), ("about", "3,4")]),
        Law::Area(&[("scale-x", "2"), ("scale-y", "150%"), ("rotate", "33"), ("skew-x", "20")], 3.0),
        Law::Same(&[("scale-x", "-1"), ("scale-y", "-1")], &[("rotate", "180")]),
    ])
    .cases(&[
        Case { args: &[("matrix", "1 2 3 4 5 6")], at: (10.0, 100.0), to: (315.0, 426.0), tolerance: 1e-12 },
        Case { args: &[("rotate", "90"), ("about", "0,0")], at: (1.0, 0.0), to: (0.0, 1.0), tolerance: 1e-15 },
        Case { args: &[("skew-x", "45"), ("about", "0,0")], at: (0.0, 2.0), to: (2.0, 2.0), tolerance: 1e-14 },
    ]);

impl Deformation for AffineDeformation {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let m = match s.numbers_if("matrix")? {
            Some(v) => {
                let parts = ["scale-x", "scale-y", "skew-x", "skew-y", "rotate", "move-x", "move-y", "about"];
                if let Some(part) = parts.iter().find(|p| s.given(p)) {
                    return Err(Error::usage("matrix", "", format!("is the whole map; it cannot go with `{part}`")));
                }
                Affine::new(std::array::from_fn(|i| v[i]))
            }
            None => {
                let o = s.point("about")?.to_vec2();
                let skew = Affine::skew(s.number("skew-x")?.to_radians().tan(), s.number("skew-y")?.to_radians().tan());
                Affine::translate(o + Vec2::new(s.number("move-x")?, s.number("move-y")?))
                    * Affine::rotate(whole_turns_off(s.number("rotate")?).to_radians())
                    * skew
                    * Affine::scale_non_uniform(s.number("scale-x")?, s.number("scale-y")?)
                    * Affine::translate(-o)
            }
        };
        if m.determinant() == 0.0 {
            let corners = s.frame().corners().map(|c| m * c);
            return Err(GeometryError::Collinear {
                path: "the image of the artwork's box".into(),
                which: [1, 2, 3],
                points: corners.to_vec(),
            }
            .into());
        }
        Ok(Built::new(Arc::new(AffineMap(m))))
    }
}

/// A whole turn is no turn, to the last bit.
fn whole_turns_off(degrees: f64) -> f64 {
    degrees % 360.0
}
