//! The projective map from four points to four points (P. Heckbert, *Fundamentals of Texture Mapping and Image Warping*, 1989, §2.2).

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law};
use crate::anchors::{self, FourToFour};
use crate::error::Error;
use crate::param::Param;
use kurbo::Point;
use std::sync::Arc;

/// The projective map that takes four points to four points: a picture in perspective. Straight lines stay straight.
///
/// (x, y) ↦ (X/W, Y/W), (X, Y, W) = M·(x, y, 1), with M from the four pairs.
///
/// ```
/// use pathwarp::{deform::Projective, kurbo::Point, map::Map};
///
/// let base = [(0.0, 100.0), (100.0, 100.0), (100.0, 0.0), (0.0, 0.0)];
/// let floor = Projective::new(base, [(0.0, 100.0), (100.0, 100.0), (75.0, 0.0), (25.0, 0.0)]).build()?;
/// assert!(floor.map.point(Point::new(50.0, 50.0)).distance(Point::new(50.0, 100.0 / 3.0)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Projective {
    corners: FourToFour,
}

impl Projective {
    /// Creates the map that takes the points `from` to the points `to`, in the order given.
    pub fn new(from: [impl Into<Point>; 4], to: [impl Into<Point>; 4]) -> Self {
        Self { corners: FourToFour::new(from.map(Into::into), to.map(Into::into)) }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Geometry`] when points coincide or three lie on a line, or when only one of the quadrilaterals is convex.
    pub fn build(&self) -> Result<Built, Error> {
        let FourToFour { from, to, frame } = self.corners;
        self.corners.check()?;
        let map = anchors::projective("target", from, to)?;
        let map = anchors::simplified(Arc::new(map), frame);
        Ok(self.corners.shown_on(Built::new(map)))
    }
}

static INFO: Info = Info::new("projective", "put artwork in perspective: four points to four points, lines stay straight")
    .group("Perspective and anamorphosis")
    .by_hand(ByHand {
        label: Some("Perspective"),
        fixed: &["target", "base"],
        neutral: &[("target", "0%,100% 100%,100% 100%,0% 0%,0%")],
        ..ByHand::NONE
    })
    .guides(&["target", "base"], 1)
    .about("Takes the four anchors of the Base (by default the corners of the artwork's box) to the four anchors of the Target. \
Straight lines stay straight and keep their two nodes.\n\nBoth start with the side that lies lowest on the screen, left to right, \
unless --base-as-drawn or --target-as-drawn say otherwise.")
    .source("P. Heckbert, Fundamentals of Texture Mapping and Image Warping, 1989, section 2.2")
    .params(&[
        Param::path("base", "Four anchors in the source. Default: the corners of the artwork's box."),
        Param::path("target", "Where the four anchors go: for those of the box from its bottom left over the right, such as 0%,100% 100%,85% 100%,15% 0%,0%.").needed(),
        Param::flag("base-as-drawn", "Take the Base's anchors in the order they were drawn."),
        Param::flag("target-as-drawn", "Take the Target's anchors in the order they were drawn."),
    ])
    .demo(&[("target", "0,100 100,90 75,20 15,5")])
    .examples(&[
        Example {
            what: "Lettering on a floor",
            command: "projective samples/lettering.svg --target '0%,100% 100%,100% 75%,0% 25%,0%' -o out.svg",
        },
        Example {
            what: "Straighten a photographed sign",
            command: "projective samples/badge.svg --base '2%,90% 95%,98% 90%,5% 8%,10%' --target '0%,100% 100%,100% 100%,0% 0%,0%' -o out.svg",
        },
        Example {
            what: "Straighten a photographed label and cut it out",
            command: "projective samples/label.jpg --target '150,475 640,520 685,160 235,95' --inverse --crop -o out.jpg",
        },
    ])
    .laws(&[
        Law::Identity(&[("target", "0,0 100,0 100,100 0,100")]),
        Law::KeepsLines(&[("target", "0,100 100,90 75,20 15,5")]),
        Law::Area(&[("target", "0,200 200,200 200,0 0,0")], 4.0),
    ])
    .cases(&[
        // The crossing of the diagonals goes to that of a symmetric trapezoid: (0,100)-(75,0) and (100,100)-(25,0).
        Case {
            args: &[("target", "0,100 100,100 75,0 25,0")],
            at: (50.0, 50.0),
            to: (50.0, 100.0 / 3.0),
            tolerance: 1e-12,
        },
        Case { args: &[("target", "0,100 100,100 75,0 25,0")], at: (100.0, 0.0), to: (75.0, 0.0), tolerance: 1e-12 },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Projective { corners: anchors::four_to_four(s)? }.build());
