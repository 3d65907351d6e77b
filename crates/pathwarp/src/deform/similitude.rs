//! The direct similitude that takes two points to two points.

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law, Role};
use crate::anchors::{self, Anchors};
use crate::error::{Error, GeometryError};
use crate::map::AffineMap;
use crate::param::Param;
use kurbo::Point;
use std::sync::Arc;

/// The direct similitude that takes two points A, B to two points P, Q: turn, uniform scale and shift, no mirroring.
///
/// In complex numbers z ↦ P + (z − A)·(Q − P)/(B − A).
///
/// ```
/// use pathwarp::{deform::Similitude, kurbo::Point, map::Map};
///
/// let turn = Similitude::new([(0.0, 0.0), (1.0, 0.0)], [(0.0, 0.0), (0.0, 2.0)]).build()?;
/// assert!(turn.map.point(Point::new(3.0, 5.0)).distance(Point::new(-10.0, 6.0)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similitude {
    from: [Point; 2],
    to: [Point; 2],
}

impl Similitude {
    /// Creates the similitude that takes the points `from` to the points `to`.
    pub fn new(from: [impl Into<Point>; 2], to: [impl Into<Point>; 2]) -> Self {
        Self { from: from.map(Into::into), to: to.map(Into::into) }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`GeometryError::Coincident`] when the points `from` are equal, or the points `to`.
    pub fn build(&self) -> Result<Built, Error> {
        anchors::check_distinct("base", &self.from)?;
        anchors::check_distinct("target", &self.to)?;
        let ([a, b], [p, q]) = (self.from, self.to);
        let coincident = || GeometryError::Coincident { path: "base".into(), which: [1, 2], at: a };
        let map = AffineMap::similitude(a, b, p, q).ok_or_else(coincident)?;
        let mut built = Built::new(Arc::new(map));
        for (role, points) in [(Role::Base, self.from), (Role::Target, self.to)] {
            built.overlay(role, Anchors::Two(points).outline().to_bez_path(0.0));
        }
        Ok(built)
    }
}

static INFO: Info = Info::new("similitude", "turn, scale and shift by two anchors; shapes stay the same")
    .group("Basics")
    .by_hand(ByHand {
        label: Some("Turn and scale"),
        fixed: &["target"],
        neutral: &[("target", "0%,100% 100%,100%")],
        ..ByHand::NONE
    })
    .guides(&["target", "base"], 1)
    .about("Takes the first anchor of the Base to the first of the Target and the second to the second, as drawn. Everything is \
turned, scaled evenly and shifted; nothing is bent, and no node is added.")
    .source("elementary; the wrapper of M. Koppinen, A plane transformation from 16 control points")
    .params(&[
        Param::path("base", "Two anchors in the source.").default("0%,100% 100%,100%"),
        Param::path("target", "Where the two anchors go, such as 20,200 420,90.").needed(),
    ])
    .demo(&[("target", "20,90 80,70")])
    .examples(&[
        Example {
            what: "Lay a word along a slope",
            command: "similitude samples/lettering.svg --target '20,180 300,120' -o out.svg",
        },
        Example {
            what: "Half a turn about the middle",
            command: "similitude samples/icon.svg --base '0%,50% 100%,50%' --target '100%,50% 0%,50%' -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("target", "0,100 100,100")]),
        Law::Area(&[("base", "0,0 1,0"), ("target", "5,5 5,8")], 9.0),
        Law::KeepsLines(&[("target", "20,90 80,70")]),
    ])
    .cases(&[
        // A quarter turn about the origin and doubling: (x, y) to (−2y, 2x).
        Case {
            args: &[("base", "0,0 1,0"), ("target", "0,0 0,2")],
            at: (3.0, 5.0),
            to: (-10.0, 6.0),
            tolerance: 1e-12,
        },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let two_anchors = |name: &str| -> Result<[Point; 2], Error> {
        let path = s.path_if(name)?.ok_or_else(|| Error::missing(name, "a path with two anchors"))?;
        match anchors::two_or_four(&path)? {
            Anchors::Two(p) => Ok(p),
            Anchors::Four(q) => {
                Err(GeometryError::anchor_count(&path.name, &q, "two (for four, use projective)").into())
            }
        }
    };
    Similitude { from: two_anchors("base")?, to: two_anchors("target")? }.build()
});
