//! Checks of any deformation: its table, derivatives, exact images, laws and known values.
//!
//! Authors of plug-ins call [`entry`] in a test:
//!
//! ```
//! let registry = pathwarp::deform::Registry::builtin();
//! let faults = pathwarp::check::entry(registry.get("projective").unwrap().as_ref());
//! assert!(faults.is_empty(), "{faults:#?}");
//! ```

use crate::deform::{Deformation, Law, Pairs};
use crate::map::{Creases, Jet, Map, RationalBezier};
use crate::outline::{EllipticArc, Outline, Seg};
use crate::param::{Args, Frame, Kind, Settings};
use crate::refit;
use kurbo::{CubicBez, Line, ParamCurveNearest, Point, Rect, Shape, Vec2};
use std::sync::Arc;

/// Returns the frame of checks, demos and cases: 0,0,100,100.
#[must_use]
pub fn frame() -> Frame {
    Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0))
}

/// Returns a message for every fault of `entry`; none if it is sound.
#[must_use]
pub fn entry(entry: &dyn Deformation) -> Vec<String> {
    let mut faults = Faults { of: entry.info().name, list: Vec::new() };
    table(entry, &mut faults);
    match build(entry, entry.info().demo) {
        Ok(map) => {
            derivatives(&*map, &mut faults);
            exact_images(&*map, &mut faults);
            inverse(&*map, &mut faults);
            refitting(&*map, &mut faults);
        }
        Err(e) => faults.add(format!("does not build from its defaults and demo: {e}")),
    }
    for law in entry.info().laws {
        check_law(entry, law, &mut faults);
    }
    for case in entry.info().cases {
        match build(entry, case.args) {
            Ok(map) => {
                let got = map.point(case.at.into());
                let off = got.distance(case.to.into());
                if off.is_nan() || off > case.tolerance {
                    faults.add(format!(
                        "{:?} takes {:?} to {got:?}, {off:e} away from {:?}",
                        case.args, case.at, case.to
                    ));
                }
            }
            Err(e) => faults.add(format!("{:?} does not build: {e}", case.args)),
        }
    }
    faults.list
}

struct Faults {
    of: &'static str,
    list: Vec<String>,
}

impl Faults {
    fn add(&mut self, what: impl AsRef<str>) {
        self.list.push(format!("{}: {}", self.of, what.as_ref()));
    }
}

fn build(entry: &dyn Deformation, pairs: Pairs) -> Result<Arc<dyn Map>, crate::Error> {
    entry.build_from(&Args::from_pairs(pairs), &frame()).map(|b| b.map)
}

fn is_kebab(name: &str) -> bool {
    !name.is_empty()
        && name.split('-').all(|w| !w.is_empty() && w.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()))
}

fn table(entry: &dyn Deformation, faults: &mut Faults) {
    let info = entry.info();
    let mut names = Vec::new();
    if !is_kebab(info.name) {
        faults.add("its name is not kebab-case");
    }
    if info.title.is_empty() || info.about.is_empty() || info.source.is_empty() || info.group.is_empty() {
        faults.add("has an empty title, group, about or source");
    }
    if info.examples.len() < 2 {
        faults.add("has fewer than two examples");
    }
    let is_path = |name: &&'static str| info.params.iter().any(|p| p.name == *name && p.kind == Kind::Path);
    if !info.guides.params.iter().all(is_path) || info.guides.usual > info.guides.params.len() {
        faults.add("its guides are not path parameters, or fewer than is usual");
    }
    for p in info.params {
        if !is_kebab(p.name) || names.contains(&p.name) {
            faults.add(format!("{} is not a new kebab-case name", p.name));
        }
        names.push(p.name);
        if !p.help.ends_with('.') {
            faults.add(format!("{}: its help does not end with a full stop", p.name));
        }
        if p.needed && p.default.is_some() {
            faults.add(format!("{} is needed and has a default", p.name));
        }
        let (least, most) = p.range;
        if p.ui.0 < least || p.ui.1 > most || p.ui.0 >= p.ui.1 {
            faults.add(format!("{}: its slider is outside its range", p.name));
        }
        if p.default.is_some() {
            let (args, frame) = (Args::new(), frame());
            // Only the getters are used, so that required parameters may be missing.
            let s = Settings::new(std::slice::from_ref(p), &args, &frame);
            let got = s.and_then(|s| match p.kind {
                Kind::Flag => s.flag(p.name).map(|_| ()),
                Kind::Numbers(_) => s.numbers_if(p.name).map(|_| ()),
                Kind::Point => s.point(p.name).map(|_| ()),
                Kind::Path => s.path_if(p.name).map(|_| ()),
                Kind::Choice(_) => s.choice(p.name).map(|_| ()),
                Kind::Text(_) | Kind::Save => Ok(()),
                Kind::File | Kind::NameOrFile(_) => s.file_if(p.name).map(|_| ()),
                Kind::Number | Kind::Length(_) | Kind::Angle | Kind::Count => s.number(p.name).map(|_| ()),
            });
            if let Err(e) = got {
                faults.add(format!("{}: its default is not valid: {e}", p.name));
            }
        }
    }
}

/// Returns points of the frame where the map is defined, away from likely creases.
fn samples(map: &dyn Map) -> Vec<Point> {
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let grid =
        (0..9).flat_map(|i| (0..9).map(move |j| Point::new(3.7 + 11.3 * f64::from(i), 4.3 + 11.1 * f64::from(j))));
    grid.filter(|p| creases.defined_at(*p)).collect()
}

fn derivatives(map: &dyn Map, faults: &mut Faults) {
    let ps = samples(map);
    let (mut jets, mut points) = (vec![Jet::default(); ps.len()], vec![Point::ORIGIN; ps.len()]);
    map.jets(&ps, &mut jets);
    map.points(&ps, &mut points);
    for ((p, j), q) in ps.iter().zip(&jets).zip(&points) {
        if !j.is_finite() {
            faults.add(format!("is not finite at {p:?}"));
            continue;
        }
        let size = 1.0 + j.p.to_vec2().hypot();
        if map.jet(*p).p.distance(j.p) > 1e-12 * size
            || q.distance(j.p) > 1e-12 * size
            || map.point(*p).distance(*q) > 1e-12 * size
        {
            faults.add(format!("single and batched values differ at {p:?}"));
        }
        // Central differences: truncation h², rounding ε/h; both near 1e-8 here.
        const H: f64 = 1e-4;
        let slope = |d: Vec2| (map.point(*p + d) - map.point(*p - d)) / (2.0 * H);
        let (dx, dy) = (slope(Vec2::new(H, 0.0)), slope(Vec2::new(0.0, H)));
        let steep = 1.0 + j.dx.hypot() + j.dy.hypot();
        if (dx - j.dx).hypot() > 1e-5 * steep || (dy - j.dy).hypot() > 1e-5 * steep {
            faults.add(format!("derivatives at {p:?}: {j:?}, differences give {dx:?} {dy:?}"));
        }
    }
}

fn exact_images(map: &dyn Map, faults: &mut Faults) {
    let segs = [
        Seg::Line(Line::new((5.0, 10.0), (60.0, 40.0))),
        Seg::Cubic(CubicBez::new((10.0, 20.0), (40.0, 0.0), (70.0, 80.0), (30.0, 90.0))),
        Seg::Arc(EllipticArc::new(Point::new(50.0, 50.0), Vec2::new(30.0, 5.0), Vec2::new(-4.0, 20.0), 0.3, 1.2)),
    ];
    for source in segs.iter().filter_map(RationalBezier::from_seg) {
        if let Some(image) = map.image(&source) {
            for i in 0..=12 {
                let t = f64::from(i) / 12.0;
                let (a, b) = (image.eval(t), map.point(source.eval(t)));
                if a.distance(b) > 1e-9 * (1.0 + b.to_vec2().hypot()) {
                    faults.add(format!("the exact image at {t} is {a:?}, the map says {b:?}"));
                }
            }
        }
    }
}

fn inverse(map: &dyn Map, faults: &mut Faults) {
    let Some(back) = map.inverse() else { return };
    for p in samples(map) {
        let q = back.point(map.point(p));
        if q.distance(p).is_nan() || q.distance(p) > 1e-8 * (1.0 + p.to_vec2().hypot()) {
            faults.add(format!("the inverse takes the image of {p:?} to {q:?}"));
        }
    }
}

/// Compares a refitted circle and line with dense samples of the true image.
fn refitting(map: &dyn Map, faults: &mut Faults) {
    const TOLERANCE: f64 = 0.01;
    let art = Outline::from_svg("M20,50 A30,30 0 1 1 80,50 A30,30 0 1 1 20,50 Z M10,10 L90,85").unwrap_or_default();
    match refit::warp_path(&art, map, &refit::Options::new(TOLERANCE)) {
        Ok(w) => {
            let segs: Vec<_> = w.path.segments().collect();
            for seg in art.segs() {
                for i in 0..=100 {
                    let p = map.point(seg.eval(f64::from(i) / 100.0));
                    let off = segs
                        .iter()
                        .map(|s| s.nearest(p, TOLERANCE * 1e-4).distance_sq)
                        .fold(f64::INFINITY, f64::min)
                        .sqrt();
                    if off > TOLERANCE * (1.0 + 1e-6) {
                        faults.add(format!("refitted within {TOLERANCE}, a sample at {p:?} is {off} away"));
                        return;
                    }
                }
            }
            if !w.path.bounding_box().is_finite() {
                faults.add("refitting gives numbers that are not finite");
            }
        }
        Err(e) => faults.add(format!("refitting its demo fails: {e}")),
    }
}

/// Returns the distance of the image of a point between `p` and `q` from the line through their images.
fn bent(m: &dyn Map, p: Point, q: Point) -> f64 {
    let (a, b, c) = (m.point(p), m.point(p.lerp(q, 0.4)), m.point(q));
    let n = (c - a).hypot();
    if n > 0.0 { ((b - a).cross(c - a) / n).abs() } else { 0.0 }
}

fn check_law(entry: &dyn Deformation, law: &Law, faults: &mut Faults) {
    const NEAR: f64 = 1e-9;
    let mut with = |pairs: Pairs| {
        let built = build(entry, pairs);
        if let Err(e) = &built {
            faults.add(format!("{pairs:?} does not build: {e}"));
        }
        built.ok()
    };
    let worst = |map: &dyn Map, f: &dyn Fn(Point) -> f64| samples(map).into_iter().map(f).fold(0.0, f64::max);
    let fault = match *law {
        Law::Identity(pairs) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| m.point(p).distance(p));
            (off > NEAR).then(|| format!("{pairs:?} should be the identity; it moves a point by {off:e}"))
        }),
        Law::Same(a, b) => with(a).zip(with(b)).and_then(|(a_map, b_map)| {
            let off = worst(&*a_map, &|p| a_map.point(p).distance(b_map.point(p)));
            (off > NEAR).then(|| format!("{a:?} and {b:?} should be one map; they differ by {off:e}"))
        }),
        Law::KeepsLines(pairs) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| bent(&*m, p, Point::new(97.0 - p.x, 0.3 * p.y + 11.0)));
            (off > NEAR).then(|| format!("{pairs:?} should keep lines straight; it bends one by {off:e}"))
        }),
        Law::KeepsLinesAlong(pairs, (x, y)) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| bent(&*m, p, p + Vec2::new(x, y) * (9.0 / x.hypot(y))));
            (off > NEAR).then(|| format!("{pairs:?} should keep lines along {x},{y} straight; it bends one by {off:e}"))
        }),
        Law::FixedOutside(pairs, [x0, y0, x1, y1]) => with(pairs).and_then(|m| {
            let inside = Rect::new(x0, y0, x1, y1);
            let off = worst(&*m, &|p| if inside.contains(p) { 0.0 } else { m.point(p).distance(p) });
            let moves = worst(&*m, &|p| m.point(p).distance(p)) > 0.0;
            let inert = format!("{pairs:?} moves nothing at all");
            (off > 0.0 || !moves).then(|| {
                if moves {
                    format!("{pairs:?} should move nothing outside {inside:?}; it moves a point by {off:e}")
                } else {
                    inert
                }
            })
        }),
        Law::Area(pairs, factor) => with(pairs).and_then(|m| {
            let off = worst(&*m, &|p| (m.jet(p).det() - factor).abs());
            (off > NEAR * (1.0 + factor.abs()))
                .then(|| format!("{pairs:?} should multiply areas by {factor}; it is off by {off:e}"))
        }),
        Law::KeepsAngles(pairs) => with(pairs).and_then(|m| {
            // Cauchy–Riemann equations: ∂F/∂y is ∂F/∂x rotated by 90°.
            let off = worst(&*m, &|p| {
                let j = m.jet(p);
                (j.dy - j.dx.turn_90()).hypot() / j.dx.hypot().max(f64::MIN_POSITIVE)
            });
            (off > NEAR).then(|| format!("{pairs:?} should keep angles; one is off by {off:e}"))
        }),
        Law::Undoes(there, back) => with(there).zip(with(back)).and_then(|(f, g)| {
            let off = worst(&*f, &|p| g.point(f.point(p)).distance(p));
            (off > NEAR).then(|| format!("{back:?} should undo {there:?}; a point ends {off:e} away"))
        }),
    };
    if let Some(f) = fault {
        faults.add(f);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::{Built, Case, Example, Info, Registry};
    use crate::map::{Formula, Real};
    use crate::param::Param;

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
    impl Map for BadMap {
        fn jet(&self, p: Point) -> Jet {
            Jet { p: (p.x + 0.001 * p.y * p.y).into_point(p.y), dx: Vec2::new(1.0, 0.0), dy: Vec2::new(0.5, 1.0) }
        }
        fn points(&self, ps: &[Point], out: &mut [Point]) {
            out.copy_from_slice(ps);
        }
        fn image(&self, c: &RationalBezier) -> Option<RationalBezier> {
            Some(c.clone())
        }
        fn inverse(&self) -> Option<Arc<dyn Map>> {
            Some(Arc::new(Shift))
        }
    }
    trait IntoPoint {
        fn into_point(self, y: f64) -> Point;
    }
    impl IntoPoint for f64 {
        fn into_point(self, y: f64) -> Point {
            Point::new(self, y)
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
}
