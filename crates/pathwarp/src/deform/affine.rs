//! The affine map, by a matrix, by three points, or by parts.
//!
//! x' = a·x + c·y + e, y' = b·x + d·y + f. By parts, about a fixed point O: first scale, then skew, then rotate, then move.

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law};
use crate::error::Error;
use crate::map::AffineMap;
use crate::param::{Axis, Kind, parameters};
use kurbo::{Affine as Matrix, Point, Rect, Vec2};
use std::sync::Arc;

parameters! {
    /// An affine map: a matrix, or scale, skew, rotation and shift, in this order, about a fixed point.
    ///
    /// ```
    /// use pathwarp::{deform::Affine, kurbo::Point, map::Map};
    ///
    /// let turn = Affine::new().about((10.0, 10.0)).rotate(90.0).build()?;
    /// assert!(turn.map.point(Point::new(12.0, 10.0)).distance(Point::new(10.0, 12.0)) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Affine(s) {
        /// The matrix a,b,c,d,e,f as in SVG's matrix(); instead of the parts.
        param = new("matrix", Kind::Numbers(6));
        /// Scale across.
        param = number("scale-x").default("1").slider(-2.0, 2.0);
        /// Scale up and down.
        param = number("scale-y").default("1").slider(-2.0, 2.0);
        /// Lean: verticals turn by this angle.
        param = angle("skew-x").default("0").slider(-60.0, 60.0);
        /// Slope: horizontals turn by this angle.
        param = angle("skew-y").default("0").slider(-60.0, 60.0);
        /// Turn, clockwise on the screen.
        rotate: f64 = angle("rotate").default("0");
        /// Shift to the right.
        param = length("move-x", Axis::X).default("0");
        /// Shift downwards.
        param = length("move-y", Axis::Y).default("0");
        /// The point that scaling, skewing and rotating leave in place.
        about: Point = new("about", Kind::Point).default("50%,50%");
        let matrix: Option<Matrix> = s.numbers_if("matrix")?.map(|v| Matrix::new(std::array::from_fn(|i| v[i])));
        let scale: Vec2 = Vec2::new(s.number("scale-x")?, s.number("scale-y")?);
        let skew: Vec2 = Vec2::new(s.number("skew-x")?, s.number("skew-y")?);
        let shift: Vec2 = Vec2::new(s.number("move-x")?, s.number("move-y")?);
    }
}

/// A determinant ad − bc below this fraction of |ad| + |bc| counts as zero, and so does the cosine of a skew.
const FLAT: f64 = 1e-14;

impl Default for Affine {
    fn default() -> Self {
        Self::new()
    }
}

impl From<Matrix> for Affine {
    /// Creates the map with this matrix. Scale, skew, rotation and shift have no effect then.
    fn from(matrix: Matrix) -> Self {
        Self { matrix: Some(matrix), ..Self::new() }
    }
}

impl Affine {
    /// Creates the identity. Scale, skew and rotation are about the origin.
    #[must_use]
    pub fn new() -> Self {
        Self::defaults(Rect::ZERO)
    }

    setters! {
        /// Sets the scale across and down.
        scale(x: f64, y: f64) => scale: Vec2::new(x, y);
        /// Sets the angles by which verticals and horizontals turn, degrees.
        skew(x: f64, y: f64) => skew: Vec2::new(x, y);
        /// Sets the shift, user units.
        shift(by: impl Into<Vec2>) => shift: by.into();
    }

    /// Returns the error for a map that leaves no area. It names the parameter to blame.
    fn flat(&self) -> Error {
        if let Some(m) = self.matrix {
            let text = m.as_coeffs().map(|c| c.to_string()).join(",");
            return Error::usage("matrix", text, "leaves the artwork without area: its determinant a·d - b·c is 0");
        }
        let scales = [("scale-x", self.scale.x, "width"), ("scale-y", self.scale.y, "height")];
        if let Some((name, _, side)) = scales.into_iter().find(|(_, scale, _)| *scale == 0.0) {
            let problem = format!("leaves the artwork without {side}; 1 keeps it, and -1 mirrors it");
            return Error::usage(name, "0", problem);
        }
        let problem = "leaves the artwork without area, together with `skew-y`";
        Error::usage("skew-x", self.skew.x.to_string(), problem)
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for a singular matrix, or a skew of 90°.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        for (name, angle) in [("skew-x", self.skew.x), ("skew-y", self.skew.y)] {
            if angle.to_radians().cos().abs() < FLAT {
                let endless = "makes the artwork endlessly long; write an angle between -90 and 90";
                return Err(Error::usage(name, angle.to_string(), endless));
            }
        }
        let m = self.matrix.unwrap_or_else(|| {
            let o = self.about.to_vec2();
            let skew = Matrix::skew(self.skew.x.to_radians().tan(), self.skew.y.to_radians().tan());
            Matrix::translate(o + self.shift)
                // Without whole turns, which are the identity to the last bit.
                * Matrix::rotate((self.rotate % 360.0).to_radians())
                * skew
                * Matrix::scale_non_uniform(self.scale.x, self.scale.y)
                * Matrix::translate(-o)
        });
        // Skews of 45° both ways are flat but for rounding.
        let [a, b, c, d, ..] = m.as_coeffs();
        if m.determinant().abs() <= FLAT * ((a * d).abs() + (b * c).abs()) {
            return Err(self.flat());
        }
        Ok(Built::new(Arc::new(AffineMap(m))))
    }
}

static INFO: Info = Info::new("affine", "scale, skew, rotate and move, or apply any matrix")
    .group("Basics")
    .by_hand(ByHand {
        label: Some("Transform"),
        ..ByHand::NONE
    })
    .about("Scales, skews, rotates and moves the artwork, in this order, about a point; or applies a matrix as SVG writes it. Control \
points are moved exactly; no node is added.")
    .source("SVG 2, section 8.5 (the transform property)")
    .params(Affine::PARAMS)
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

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    if s.given("matrix") {
        let parts = ["scale-x", "scale-y", "skew-x", "skew-y", "rotate", "move-x", "move-y", "about"];
        if let Some(part) = parts.iter().find(|p| s.given(p)) {
            return Err(Error::usage("matrix", "", format!("is the whole map; it cannot go with `{part}`")));
        }
    }
    Affine::read(s)?.build()
});
