//! Tests of the checks: built-in deformations pass them, and a deformation with every fault fails each.

use super::entry;
use crate::deform::{Built, Case, Deformation, Example, Info, Law, Registry};
use crate::map::{Creases, Formula, Jet, Map, RationalBezier, Real};
use crate::param::{Args, Frame, Param, Settings};
use kurbo::{Point, Rect, Vec2};
use std::sync::Arc;

#[test]
fn every_builtin_entry_is_sound() {
    for e in Registry::builtin().entries() {
        let faults = entry(e.as_ref());
        assert!(faults.is_empty(), "{faults:#?}");
    }
}

/// Artwork without width or height, and huge artwork: a map or an error, never a panic.
#[test]
fn degenerate_frames_are_survived() {
    for (w, h) in [(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (1e-200, 1e-200), (1e99, 1e99)] {
        let frame = Frame::new(Rect::new(5.0, 5.0, 5.0 + w, 5.0 + h));
        for e in Registry::builtin().entries() {
            let Ok(b) = e.build_from(&Args::from_pairs(e.info().demo), &frame) else { continue };
            let mut creases = Creases::default();
            b.map.creases(&mut creases);
            for p in [(5.0, 5.0), (0.0, 0.0), (5.0 + w, 5.0 + h), (1e30, -1e30)].map(Point::from) {
                let _ = (b.map.jet(p), b.map.point(p), creases.defined_at(p));
                let _ = b.map.branch(p).map(|m| m.jet(p));
                let _ = b.map.inverse().map(|m| m.jet(p));
            }
        }
    }
}

/// A deformation with a fault of every kind that `entry` looks for.
struct Bad;
struct BadMap;
/// Its batches differ from its single values.
struct Fickle;
impl Map for BadMap {
    fn jet(&self, p: Point) -> Jet {
        Jet { p: Point::new(p.x + 0.001 * p.y * p.y, p.y), dx: Vec2::new(1.0, 0.0), dy: Vec2::new(0.5, 1.0) }
    }
    fn point(&self, p: Point) -> Point {
        Point::new(p.x + 0.002 * p.y * p.y, p.y)
    }
    fn image(&self, c: &RationalBezier) -> Option<RationalBezier> {
        Some(c.clone())
    }
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Shift))
    }
}
impl Map for Fickle {
    fn jet(&self, p: Point) -> Jet {
        BadMap.jet(p)
    }
    fn points(&self, ps: &[Point], out: &mut [Point]) {
        out.copy_from_slice(ps);
    }
}
struct Shift;
impl Formula for Shift {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x + 1.0, y)
    }
}
static BAD: Info = Info::new("bad", "bad")
    .group("Bad")
    .about("Bad.")
    .source("none")
    .params(&[Param::number("Loud", "No full stop").default("many")])
    .demo(&[])
    .examples(&[Example { what: "one only", command: "bad" }])
    .laws(&[
        Law::Identity(&[]),
        Law::KeepsLines(&[]),
        Law::KeepsLinesAlong(&[], (1.0, 2.0)),
        Law::FixedOutside(&[], [0.0, 0.0, 50.0, 50.0]),
        Law::Area(&[], 7.0),
        Law::KeepsAngles(&[]),
        Law::Undoes(&[], &[]),
    ])
    .cases(&[Case { args: &[], at: (0.0, 0.0), to: (1.0, 1.0), tolerance: 0.1 }]);
impl Deformation for Bad {
    fn info(&self) -> &Info {
        &BAD
    }
    fn build(&self, _: &Settings<'_>) -> Result<Built, crate::Error> {
        Ok(Built::new(Arc::new(BadMap)))
    }
}

#[test]
fn two_answers_for_a_point_end_the_check() {
    let [check] = crate::check::all(&Built::new(Arc::new(Fickle))).try_into().unwrap();
    assert_eq!(check.faults, ["gives two answers for the point 3.7,4.3: 3.7,4.3 and then 3.71849,4.3"]);
}

#[test]
fn every_kind_of_fault_is_found() {
    let faults = entry(&Bad).join("\n");
    for part in [
        "fewer than two",
        "kebab-case",
        "full stop",
        "default is not valid",
        "differ at",
        "differences give",
        "exact image",
        "inverse takes",
        "identity",
        "straight",
        "along 1,2 straight",
        "nothing outside",
        "areas",
        "keep angles",
        "should undo",
        "takes (0.0, 0.0)",
    ] {
        assert!(faults.contains(part), "`{part}` not in:\n{faults}");
    }
}
