//! The direct similitude that takes two points to two points: turn, scale and shift, no mirroring.
//!
//! In complex numbers z ↦ P + (z − A)·(Q − P)/(B − A).

use super::built::{Built, Explanation, Overlay, Role};
use super::entry::{Case, Deformation, Example, Info, Law};
use crate::anchors::{self, Anchors};
use crate::error::{Error, GeometryError};
use crate::map::AffineMap;
use crate::param::{Param, Settings};
use kurbo::Point;
use std::sync::Arc;

pub(super) struct Similitude;

static INFO: Info = Info::new("similitude", "turn, scale and shift by two anchors; shapes stay what they are")
    .group("Basics")
    .about("Takes the first anchor of the Base to the first of the Target and the second to the second, as drawn. Everything is \
turned, scaled evenly and shifted; nothing is bent, and no node is added.")
    .source("elementary; the wrapper of M. Koppinen, A plane transformation from 16 control points")
    .params(&[
        Param::path("base", "Two anchors in the source.").default("0%,100% 100%,100%"),
        Param::path("target", "Two anchors where they are to land.").needed(),
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

impl Deformation for Similitude {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let two = |name: &str| -> Result<[Point; 2], Error> {
            let path = s
                .path_if(name)?
                .ok_or_else(|| Error::Missing { param: name.to_owned(), hint: "a path with two anchors".into() })?;
            match anchors::two_or_four(&path)? {
                Anchors::Two(p) => Ok(p),
                Anchors::Four(q) => Err(GeometryError::AnchorCount {
                    path: path.name,
                    found: 4,
                    anchors: q.to_vec(),
                    expected: "two (for four, use projective)",
                }
                .into()),
            }
        };
        let ([a, b], [p, q]) = (two("base")?, two("target")?);
        let map = AffineMap::similitude(a, b, p, q).ok_or_else(|| GeometryError::Coincident {
            path: "base".into(),
            which: [1, 2],
            at: a,
        })?;
        let overlay = |role, p: [Point; 2]| Overlay { role, path: Anchors::Two(p).outline().to_bez_path(0.0) };
        let overlays = vec![overlay(Role::Base, [a, b]), overlay(Role::Target, [p, q])];
        Ok(Built::new(Arc::new(map)).explained(Explanation { overlays, ..Explanation::default() }))
    }
}
