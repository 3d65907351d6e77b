//! Tests of the checks: built-in deformations pass them, and a deformation with every fault fails each of them.

use super::{entry, frame, map};
use crate::deform::{Built, Case, Deformation, Example, Info, Law, Registry};
use crate::map::{Creases, Formula, Jet, Map, RationalBezier, Real, from_fn, from_fn_with};
use crate::param::{Args, Frame, Param, Settings};
use kurbo::{Point, Rect, Vec2};
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

#[test]
fn every_builtin_entry_is_sound() {
    for e in Registry::builtin().entries() {
        let faults = entry(e.as_ref());
        assert!(faults.is_empty(), "{faults:#?}");
    }
}

/// Artwork without width or height, and huge artwork, gives a map or an error, never a panic.
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

/// A deformation with every kind of fault that `entry` looks for.
struct Bad;
struct BadMap;
/// A map whose batches differ from its single values.
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
    let mut checks = Vec::new();
    assert!(!map(&Built::new(Arc::new(Fickle)), frame().rect, |check| checks.push(check)));
    let [check] = checks.try_into().unwrap();
    assert!(
        check.faults[0]
            .starts_with("gives two answers for the point 3.7,4.3: 3.7,4.3 and then 3.71849,4.3, asked for alone")
    );
}

#[test]
fn every_kind_of_fault_is_found() {
    let faults = entry(&Bad).join("\n");
    for part in [
        "fewer than two",
        "kebab-case",
        "full stop",
        "default is not valid",
        "gives another value with derivatives",
        "differences give",
        "exact image",
        "inverse does not lead back",
        "identity",
        "straight",
        "along 1,2 straight",
        "nothing outside",
        "areas",
        "keep angles",
        "should undo",
        "takes 0,0 to",
    ] {
        assert!(faults.contains(part), "`{part}` not in:\n{faults}");
    }
}

/// The faults of a map, with the names of their checks.
fn faults_of(map: impl Map + 'static) -> String {
    let mut faults = String::new();
    super::map(&Built::new(Arc::new(map)), frame().rect, |check| {
        check.faults.iter().for_each(|fault| faults += &format!("{}: {fault}\n", check.name));
    });
    faults
}

/// The faults of a map by its formula.
fn faults_by(f: impl Fn(f64, f64) -> (f64, f64) + Send + Sync + 'static) -> String {
    faults_of(from_fn(move |p| f(p.x, p.y).into()))
}

/// Every kink and jump is named by the curve to declare; smooth maps with waves, bumps and jumps of curvature have none.
#[test]
fn undeclared_kinks_are_named() {
    let ring = |x: f64, y: f64, r: f64| (x - 40.0).hypot(y - 50.0).min(r);
    for (faults, curves) in [
        (faults_by(|x, y| (x, y + 0.3 * (x - 50.0).abs())), vec!["has a kink", "declare a crease at line 1 0 -50"]),
        (faults_by(|x, y| (x, y + 0.3 * (0.6 * x + 0.8 * y - 50.0).abs())), vec!["line 0.75 1 -62.5"]),
        (faults_by(move |x, y| (x, y - 0.2 * ring(x, y, 25.0))), vec!["circle 40 50 25"]),
        (faults_by(move |x, y| (x, y - 0.2 * ring(x, y, 6.0))), vec!["circle 40 50 6"]),
        (faults_by(|x, y| (x + 0.2 * (y - 30.0).abs(), y + 0.2 * (x - y).abs())), vec!["line 0 1 -30", "line 1 -1 0"]),
        (faults_by(|x, y| (x + 10.0 * f64::from(u8::from(x > 50.0)), y)), vec!["jumps by 10 at 50", "line 1 0 -50"]),
        (faults_by(|x, y| (x, y + 0.3 * (y - 0.01 * x * x).abs())), vec!["31 other places", "declare a crease there"]),
    ] {
        assert!(curves.iter().all(|c| faults.contains(c)) && faults.lines().count() < 3, "{curves:?}: {faults}");
        assert!(faults.lines().all(|line| line.starts_with("creases: ")), "{faults}");
    }
    for wave in [0.7, 2.0, 100.0 / 48.0, 10.0, 300.0] {
        let k = 2.0 * PI / wave;
        assert_eq!(faults_by(move |x, y| (x + (k * y).sin() / k, y + (k * (x + y)).cos() / k)), "", "{wave}");
    }
    assert_eq!(faults_by(|x, y| (x, y + 0.01 * (x - 50.0).max(0.0).powi(2))), "");
}

/// Values to which no curve can be fitted are reported with the cause.
#[test]
fn bad_values_are_told_by_their_kind() {
    let wave = |x: f64, y: f64| (x + 3.0 * (y / 9.0).sin(), y);
    let transposed = |p: Point| [Vec2::new(1.0, (p.y / 9.0).cos() / 3.0), Vec2::new(0.0, 1.0)];
    let count = AtomicU32::new(0);
    for (faults, words) in [
        (faults_by(|_, _| (f64::NAN, f64::NAN)), "values: has no value at any of 81 places in the box 0,0 to 100,100"),
        (faults_by(|x, _| (x, f64::NAN)), "has no value at any"),
        (
            faults_by(|x, y| (if x > 50.0 { f64::NAN } else { x }, y)),
            "values: has no value, which an edge of its domain would explain, at 36 of 81 places, such as 60.2,4.3",
        ),
        (faults_by(|_, _| (7.0, 7.0)), "values: sends all points to one, or to one curve, so"),
        (faults_by(|x, y| (x + y, x + y)), "values: sends all points to one, or to one curve, so"),
        (faults_by(move |x, y| (x, (wave(y, x).0 * 1e3).round() / 1e3)), "values: y' is rounded to 3 decimals"),
        (faults_by(move |x, y| (f64::from(wave(x, y).0 as f32), y)), "values: x' has the digits of single precision"),
        (faults_of(from_fn_with(move |p| wave(p.x, p.y).into(), transposed)), "values: its derivatives are transposed"),
        (
            faults_of(from_fn_with(move |p| wave(p.x, p.y).into(), |_| [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)])),
            "values: ∂x'/∂y is wrong at 81 of 81 places: 0 at 3.7,4.3, where differences give 0.296006",
        ),
        (
            faults_by(move |x, y| (x, y + f64::from(count.fetch_add(1, Relaxed)))),
            "values: gives two answers for the point 3.7,4.3: 3.7,4.3 and then 3.7,85.3; its answer may depend on nothing",
        ),
    ] {
        assert!(faults.starts_with(words) || faults.contains(&format!(": {words}")), "{words}: {faults}");
        assert!(faults.lines().all(|line| line.starts_with("values: ")), "{faults}");
    }
}

/// Answers that change late are reported by whatever check fails then.
#[test]
fn answers_that_change_late_are_told() {
    let count = AtomicU32::new(0);
    let late = move |x: f64, y: f64| (x, y + f64::from(count.fetch_add(1, Relaxed) / 5000));
    let faults = faults_by(late);
    assert!(faults.lines().count() == 1 && faults.contains("gives two answers for the point"), "{faults}");
}

/// An inverse that holds in a part, and one that a fold makes impossible.
#[test]
fn wrong_inverses_are_counted() {
    struct Square<const FOLDS: bool>;
    impl<const FOLDS: bool> Map for Square<FOLDS> {
        fn jet(&self, p: Point) -> Jet {
            let vertex = if FOLDS { 50.0 } else { -1.0 };
            Jet { p: self.point(p), dx: Vec2::new((p.x - vertex) / 25.0, 0.0), dy: Vec2::new(0.0, 1.0) }
        }
        fn point(&self, p: Point) -> Point {
            let vertex = if FOLDS { 50.0 } else { -1.0 };
            Point::new((p.x - vertex).powi(2) / 50.0, p.y)
        }
        fn inverse(&self) -> Option<Arc<dyn Map>> {
            Some(Arc::new(from_fn(|q| {
                let root = (50.0 * q.x).sqrt();
                Point::new(if FOLDS { 50.0 + root } else { (root - 1.0).min(50.0) }, q.y)
            })))
        }
    }
    let faults = faults_of(Square::<false>);
    assert!(faults.contains("does not lead back at 36 of 81 places: it takes the image of 60.2,4.3"), "{faults}");
    let faults = faults_of(Square::<true>);
    assert!(faults.contains("at 45 of 81 places"), "{faults}");
    assert!(faults.contains("96.3,4.3, which has the same image: the map folds"), "{faults}");
}

/// If the declared detail is larger than the waves, the check names one that is not.
#[test]
fn a_wrong_detail_is_corrected() {
    const K: f64 = 2.0 * PI / 0.02;
    struct Ripples;
    impl Map for Ripples {
        fn jet(&self, p: Point) -> Jet {
            Jet { p: self.point(p), dx: Vec2::new(1.0, 0.02 * K * (K * p.x).cos()), dy: Vec2::new(0.0, 1.0) }
        }
        fn point(&self, p: Point) -> Point {
            Point::new(p.x, p.y + 0.02 * (K * p.x).sin())
        }
        fn detail(&self, _: Rect) -> Option<f64> {
            Some(1.0)
        }
    }
    let faults = faults_of(Ripples);
    let advice = "its waves are down to 0.02 long there: declare a detail of 0.005 (1 is declared)";
    assert!(faults.contains("a curve fitted within 0.01 is 0.01") && faults.contains(advice), "{faults}");
}
