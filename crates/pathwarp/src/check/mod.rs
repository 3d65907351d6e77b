//! Checks of any deformation: its table, derivatives, exact images, laws and known values.
//!
//! Authors of plug-ins call [`entry`] in a test:
//!
//! ```
//! let registry = pathwarp::deform::Registry::builtin();
//! let faults = pathwarp::check::entry(registry.get("projective").unwrap().as_ref());
//! assert!(faults.is_empty(), "{faults:#?}");
//! ```
//!
//! [`report`] gives the same check by check, for people.

mod counted;
#[cfg(test)]
mod tests;

pub use counted::{Counted, operations};

use crate::deform::{Built, Deformation, Info, Law, Pairs};
use crate::error::Error;
use crate::map::{CreaseKind, Creases, Jet, Map, RationalBezier, detail_in};
use crate::outline::{EllipticArc, Outline, Seg};
use crate::param::{Args, Frame, Kind, Settings};
use crate::refit;
use kurbo::{CubicBez, Line, ParamCurveNearest, PathSeg, Point, Rect, Shape, Vec2};
use std::cell::Cell;

/// Returns a message for every fault of `entry`; none if it is sound.
#[must_use]
pub fn entry(entry: &dyn Deformation) -> Vec<String> {
    let name = entry.info().name;
    report(entry).into_iter().flat_map(|c| c.faults).map(|fault| format!("{name}: {fault}")).collect()
}

/// Runs every check of `entry`.
#[must_use]
pub fn report(entry: &dyn Deformation) -> Vec<Check> {
    let mut checks = table(entry.info()).to_vec();
    let mut build = Check::new("build");
    match entry.build_from(&Args::from_pairs(entry.info().demo), &frame()) {
        Ok(built) => {
            build.detail = "from the defaults and the demo".into();
            checks.push(build);
            checks.extend(all(&built));
            if checks.last().is_some_and(|c| !c.faults.is_empty() && c.name == "values") {
                return checks;
            }
        }
        Err(e) => {
            build.fault(format!("does not build from its defaults and demo: {e}"));
            checks.push(build);
        }
    }
    checks.extend([laws(entry), cases(entry)]);
    checks
}

/// The failure of a map that asks another program, if it has failed: values after that mean nothing.
fn failure(built: &Built) -> Option<Error> {
    built.failure.as_ref().and_then(|f| f())
}

/// One check with its outcome.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Check {
    /// A word for what is checked.
    pub name: &'static str,
    /// What was checked, and the largest error.
    pub detail: String,
    /// What is wrong; empty if nothing is.
    pub faults: Vec<String>,
}

/// Limit on listed faults of one kind: a wrong formula is wrong at every sample.
const LISTED: usize = 3;

impl Check {
    fn new(name: &'static str) -> Self {
        Self { name, detail: String::new(), faults: Vec::new() }
    }

    fn fault(&mut self, what: impl Into<String>) {
        self.faults.push(what.into());
    }

    /// Replaces the faults by the failure of the map, if it has failed: values after that mean nothing.
    fn unless_failed(mut self, built: &Built) -> Self {
        if let Some(failure) = failure(built) {
            self.faults = vec![failure.to_string()];
        }
        let more = self.faults.len().saturating_sub(LISTED);
        if more > 0 {
            self.faults.truncate(LISTED);
            self.faults.push(format!("and {more} more"));
        }
        self
    }
}

/// Returns the frame of checks, demos and cases: 0,0,100,100.
#[must_use]
pub fn frame() -> Frame {
    Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0))
}

fn is_kebab(name: &str) -> bool {
    !name.is_empty()
        && name.split('-').all(|w| !w.is_empty() && w.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()))
}

/// Checks what a deformation of the plane or of space says about itself: the texts for people, and the parameters with their defaults.
#[must_use]
pub fn table(info: &Info) -> [Check; 2] {
    [help(info), parameters(info)]
}

/// The texts for people.
fn help(info: &Info) -> Check {
    let mut check = Check::new("help");
    check.detail = format!("title, group, about, source, {} examples", info.examples.len());
    if !is_kebab(info.name) {
        check.fault("its name is not kebab-case");
    }
    if info.title.is_empty() || info.about.is_empty() || info.source.is_empty() || info.group.is_empty() {
        check.fault("has an empty title, group, about or source");
    }
    if info.examples.len() < 2 {
        check.fault("has fewer than two examples");
    }
    let is_path = |name: &&'static str| info.params.iter().any(|p| p.name == *name && p.kind == Kind::Path);
    if !info.guides.params.iter().all(is_path) || info.guides.usual > info.guides.params.len() {
        check.fault("its guides are not path parameters, or fewer than is usual");
    }
    check
}

/// The parameters and their defaults.
fn parameters(info: &Info) -> Check {
    let mut check = Check::new("parameters");
    check.detail = info.params.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
    let mut names = Vec::new();
    for p in info.params {
        if !is_kebab(p.name) || names.contains(&p.name) {
            check.fault(format!("{} is not a new kebab-case name", p.name));
        }
        names.push(p.name);
        if !p.help.ends_with('.') {
            check.fault(format!("{}: its help does not end with a full stop", p.name));
        }
        if p.needed && p.default.is_some() {
            check.fault(format!("{} is needed and has a default", p.name));
        }
        let (min, max) = p.range;
        if p.ui.0 < min || p.ui.1 > max || p.ui.0 >= p.ui.1 {
            check.fault(format!("{}: its slider is outside its range", p.name));
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
                check.fault(format!("{}: its default is not valid: {e}", p.name));
            }
        }
    }
    check
}

// The map of a deformation: derivatives, batches, exact images, inverse, and a refit.

/// Runs all checks of a map; only the first if it gives two answers for one point, which makes the others meaningless.
fn all(built: &Built) -> Vec<Check> {
    let domain = Domain::of(built);
    if let Some(fault) = two_answers(&*built.map, &domain) {
        let mut check = Check::new("values");
        check.fault(fault);
        return vec![check.unless_failed(built)];
    }
    [derivatives, exact_images, inverse, refitting].map(|check| check(&*built.map, &domain).unless_failed(built)).into()
}

/// Where a map is defined.
struct Domain<'a> {
    creases: Creases,
    built: &'a Built,
}

impl<'a> Domain<'a> {
    fn of(built: &'a Built) -> Self {
        let mut creases = Creases::default();
        built.map.creases(&mut creases);
        Self { creases, built }
    }

    /// Returns `true` if the map may be undefined somewhere, so that NaN is no fault.
    fn is_partial(&self) -> bool {
        self.built.undefined.is_some() || self.creases.items().iter().any(|c| c.kind == CreaseKind::Edge)
    }

    fn contains(&self, p: Point) -> bool {
        self.creases.defined_at(p) && self.built.undefined.as_ref().is_none_or(|why| why(p).is_none())
    }

    /// Points of the frame where the map is defined, away from likely creases, and the number of those where it is not.
    fn samples(&self) -> (Vec<Point>, usize) {
        let grid =
            (0..9).flat_map(|i| (0..9).map(move |j| Point::new(3.7 + 11.3 * f64::from(i), 4.3 + 11.1 * f64::from(j))));
        let (inside, outside): (Vec<Point>, Vec<Point>) = grid.partition(|p| self.contains(*p));
        (inside, outside.len())
    }
}

/// Words for points that were skipped.
fn skipped(count: usize) -> String {
    if count == 0 { String::new() } else { format!("; {count} outside of the domain are skipped") }
}

/// Looks for a point for which the map gives two answers: in one batch, in another, or alone.
fn two_answers(map: &dyn Map, domain: &Domain<'_>) -> Option<String> {
    let (ps, _) = domain.samples();
    let mut answers = [ps.clone(), ps.clone()];
    for a in &mut answers {
        map.points(&ps, a);
    }
    let [first, second] = answers;
    let differ = |p: &Point, a: Point, b: Point| {
        let size = 1.0 + a.to_vec2().hypot();
        // Only one is a number, or they are apart.
        let apart = a.is_finite() != b.is_finite() || a.is_finite() && a.distance(b) > 1e-12 * size;
        apart.then(|| {
            format!("gives two answers for the point {},{}: {},{} and then {},{}", p.x, p.y, a.x, a.y, b.x, b.y)
        })
    };
    let mut pairs = ps.iter().zip(first.iter().zip(&second));
    pairs.find_map(|(p, (a, b))| differ(p, *a, *b).or_else(|| differ(p, *a, map.point(*p))))
}

fn derivatives(map: &dyn Map, domain: &Domain<'_>) -> Check {
    let mut check = Check::new("values");
    let mut largest: f64 = 0.0;
    let (ps, mut outside) = domain.samples();
    let (mut jets, mut points) = (vec![Jet::default(); ps.len()], vec![Point::ORIGIN; ps.len()]);
    map.jets(&ps, &mut jets);
    map.points(&ps, &mut points);
    for ((p, j), q) in ps.iter().zip(&jets).zip(&points) {
        if !j.is_finite() {
            check.fault(format!("is not finite at {p:?}"));
            continue;
        }
        let size = 1.0 + j.p.to_vec2().hypot();
        if map.jet(*p).p.distance(j.p) > 1e-12 * size || q.distance(j.p) > 1e-12 * size {
            check.fault(format!("single and batched values differ at {p:?}"));
        }
        // Central differences: truncation h², rounding ε/h; both near 1e-8 here.
        const H: f64 = 1e-4;
        let slope = |d: Vec2| (map.point(*p + d) - map.point(*p - d)) / (2.0 * H);
        let (dx, dy) = (slope(Vec2::new(H, 0.0)), slope(Vec2::new(0.0, H)));
        if domain.is_partial() && !(dx + dy).is_finite() {
            outside += 1;
            continue;
        }
        let steep = 1.0 + j.dx.hypot() + j.dy.hypot();
        largest = largest.max((dx - j.dx).hypot() / steep).max((dy - j.dy).hypot() / steep);
        let off = |d: Vec2, own: Vec2| (d - own).hypot() > 1e-5 * steep || (d - own).is_nan();
        if off(dx, j.dx) || off(dy, j.dy) {
            check.fault(format!("derivatives at {p:?}: {j:?}, differences give {dx:?} {dy:?}"));
        }
    }
    check.detail = format!(
        "{} points are finite, alone and in batches; derivatives differ from differences by {largest:.0e}{}",
        ps.len(),
        skipped(outside)
    );
    check
}

fn exact_images(map: &dyn Map, domain: &Domain<'_>) -> Check {
    let mut check = Check::new("images");
    check.detail = "it gives no exact images of curves".into();
    let segs = [
        Seg::Line(Line::new((5.0, 10.0), (60.0, 40.0))),
        Seg::Cubic(CubicBez::new((10.0, 20.0), (40.0, 0.0), (70.0, 80.0), (30.0, 90.0))),
        Seg::Arc(EllipticArc::new(Point::new(50.0, 50.0), Vec2::new(30.0, 5.0), Vec2::new(-4.0, 20.0), 0.3, 1.2)),
    ];
    for source in segs.iter().filter_map(RationalBezier::from_seg) {
        if let Some(image) = map.image(&source) {
            check.detail = "exact images of a line, a cubic and an arc".into();
            for i in 0..=12 {
                let t = f64::from(i) / 12.0;
                let (a, b) = (image.eval(t), map.point(source.eval(t)));
                let off = a.distance(b);
                if off > 1e-9 * (1.0 + b.to_vec2().hypot()) || off.is_nan() && !domain.is_partial() {
                    check.fault(format!("the exact image at {t} is {a:?}, the map says {b:?}"));
                }
            }
        }
    }
    check
}

fn inverse(map: &dyn Map, domain: &Domain<'_>) -> Check {
    let mut check = Check::new("inverse");
    let Some(back) = map.inverse() else {
        check.detail = "it gives none; Newton's method finds it".into();
        return check;
    };
    let mut largest: f64 = 0.0;
    let (ps, outside) = domain.samples();
    for p in ps {
        let q = back.point(map.point(p));
        largest = largest.max(q.distance(p));
        if q.distance(p).is_nan() || q.distance(p) > 1e-8 * (1.0 + p.to_vec2().hypot()) {
            check.fault(format!("the inverse takes the image of {p:?} to {q:?}"));
        }
    }
    check.detail = format!("it leads back, within {largest:.0e}{}", skipped(outside));
    check
}

/// Compares what a circle and lines become with dense samples of the true image. The lines are from 1 to 400 of the map's details long, of
/// which none counts as larger than a hundredth of the frame, or as smaller than a hundredth of that.
fn refitting(map: &dyn Map, domain: &Domain<'_>) -> Check {
    const TOLERANCE: f64 = 0.01;
    const DETAILS: [u32; 12] = [1, 3, 8, 17, 34, 51, 68, 85, 102, 144, 233, 400];
    /// Samples of a detail, to which a prime number is added for each line.
    const SAMPLES: u32 = 12;
    let mut check = Check::new("refitting");
    let frame = frame().rect;
    let (size, hundredth) = (detail_in(map, frame).unwrap_or(f64::INFINITY), 0.01 * frame.size().to_vec2().hypot());
    let size = size.clamp(0.01 * hundredth, hundredth);
    let mut art = vec![(Outline::from_svg("M20,50 A30,30 0 1 1 80,50 A30,30 0 1 1 20,50 Z").unwrap_or_default(), 101)];
    art.extend(DETAILS.iter().enumerate().map(|(i, n)| {
        let half = Vec2::from_angle(0.618 * i as f64) * (0.5 * size * f64::from(*n));
        (Outline::from_points(&[frame.center() - half, frame.center() + half], false), SAMPLES * n + 97)
    }));
    let all = art.len();
    art.retain(|(art, _)| art.segs().all(|g| (0..=100).all(|i| domain.contains(g.eval(f64::from(i) / 100.0)))));
    let mut pieces = 0;
    for (art, samples) in &art {
        let w = match refit::warp_path(art, map, &refit::Options::new(TOLERANCE).with_nodes(refit::Nodes::Source)) {
            Ok(w) => w,
            Err(e) => {
                check.fault(format!("refitting its demo fails: {e}"));
                return check;
            }
        };
        pieces += w.report.segments_out;
        let segs: Vec<_> = w.path.segments().collect();
        let off = art.segs().find_map(|seg| away(map, seg, &segs, *samples, TOLERANCE));
        if let (Some((p, off)), true) = (off, w.report.unresolved.is_empty()) {
            check.fault(format!("refitted within {TOLERANCE}, a sample at {p:?} is {off} away"));
        }
        if !w.path.bounding_box().is_finite() {
            check.fault("refitting gives numbers that are not finite");
        }
    }
    let (fitted, lines) = (art.len(), all - 1);
    check.detail = format!("{fitted} of a circle and {lines} lines become {pieces} curves within {TOLERANCE}");
    if fitted < all {
        check.detail += "; the others leave the domain and are skipped";
    }
    check
}

/// The first of evenly spaced samples of the true image that is further than `tolerance` from a path, and its distance.
fn away(map: &dyn Map, seg: &Seg, path: &[PathSeg], samples: u32, tolerance: f64) -> Option<(Point, f64)> {
    let mut at = 0;
    (0..=samples).find_map(|i| {
        let p = map.point(seg.eval(f64::from(i) / f64::from(samples)));
        let off = |k: &usize| path[*k].nearest(p, tolerance * 1e-4).distance_sq.sqrt();
        // Samples follow each other, so the nearest piece is that of the one before, or comes soon after it.
        match (at..path.len()).chain(0..at).find(|k| off(k) <= tolerance * (1.0 + 1e-6)) {
            Some(k) => at = k,
            None => return Some((p, (0..path.len()).map(|k| off(&k)).fold(f64::INFINITY, f64::min))),
        }
        None
    })
}

// The laws that a deformation states about itself, and values known from elsewhere.

/// Differences up to this are rounding.
const NEAR: f64 = 1e-9;

/// The laws.
fn laws(entry: &dyn Deformation) -> Check {
    let mut check = Check::new("laws");
    check.detail = format!("{} of them", entry.info().laws.len());
    let outside: usize = entry.info().laws.iter().map(|law| check_law(entry, law, &mut check)).sum();
    check.detail += &skipped(outside);
    check
}

/// The known values.
fn cases(entry: &dyn Deformation) -> Check {
    let mut check = Check::new("cases");
    check.detail = format!("{} known values", entry.info().cases.len());
    for case in entry.info().cases {
        match build(entry, case.args) {
            Ok(built) => {
                let got = built.map.point(case.at.into());
                let off = got.distance(case.to.into());
                if let Some(failure) = failure(&built) {
                    check.fault(format!("{:?}: {failure}", case.args));
                } else if off.is_nan() || off > case.tolerance {
                    check.fault(format!(
                        "{:?} takes {:?} to {got:?}, {off:e} away from {:?}",
                        case.args, case.at, case.to
                    ));
                }
            }
            Err(e) => check.fault(format!("{:?} does not build: {e}", case.args)),
        }
    }
    check
}

fn build(entry: &dyn Deformation, pairs: Pairs) -> Result<Built, Error> {
    entry.build_from(&Args::from_pairs(pairs), &frame())
}

/// Returns the distance of the image of a point between `p` and `q` from the line through their images.
fn bent(m: &dyn Map, p: Point, q: Point) -> f64 {
    let (a, b, c) = (m.point(p), m.point(p.lerp(q, 0.4)), m.point(q));
    let n = (c - a).hypot();
    if n == 0.0 { 0.0 } else { ((b - a).cross(c - a) / n).abs() }
}

/// Checks a law, and returns the number of samples that were skipped.
fn check_law(entry: &dyn Deformation, law: &Law, check: &mut Check) -> usize {
    let values = match *law {
        Law::Same(a, b) | Law::Undoes(a, b) => vec![a, b],
        Law::Identity(a)
        | Law::KeepsLines(a)
        | Law::KeepsLinesAlong(a, _)
        | Law::FixedOutside(a, _)
        | Law::Area(a, _)
        | Law::KeepsAngles(a) => vec![a],
    };
    let mut built = Vec::with_capacity(values.len());
    for pairs in &values {
        match build(entry, pairs) {
            Ok(b) => built.push(b),
            Err(e) => check.fault(format!("{pairs:?} does not build: {e}")),
        }
    }
    let (Some(first), Some(last)) = (built.first(), built.last().filter(|_| built.len() == values.len())) else {
        return 0;
    };
    let domain = Domain::of(first);
    let (samples, outside) = domain.samples();
    let is_partial = domain.is_partial() || Domain::of(last).is_partial();
    let skips = Cell::new(outside);
    // The place of the largest value of the last call of `worst`.
    let place = Cell::new(None);
    let worst = |f: &dyn Fn(Point) -> f64| {
        place.set(None);
        let mut largest = 0.0_f64;
        for &p in &samples {
            let off = f(p);
            if off.is_nan() && is_partial {
                skips.set(skips.get() + 1);
            } else if off > largest || off.is_nan() {
                place.set(Some(p));
                largest = if off.is_nan() { f64::INFINITY } else { off };
            }
        }
        largest
    };
    let fault = broken(law, values[0], [&*first.map, &*last.map], &worst);
    // Values after a failure mean nothing.
    if let Some((pairs, e)) = values.iter().zip(&built).find_map(|(pairs, b)| Some((pairs, failure(b)?))) {
        check.fault(format!("{pairs:?}: {e}"));
    } else if let Some(fault) = fault {
        let place = place.get().map(|p: Point| format!(", worst at {},{}", p.x, p.y)).unwrap_or_default();
        check.fault(fault + &place);
    }
    skips.get()
}

/// The largest value of a function at the samples.
type Worst<'a> = &'a dyn Fn(&dyn Fn(Point) -> f64) -> f64;

/// Says how `f` and `g` break a law, if they do. A law about one map gets it twice.
fn broken(law: &Law, pairs: Pairs, [f, g]: [&dyn Map; 2], worst: Worst<'_>) -> Option<String> {
    let by = |off: f64| if off.is_finite() { format!("{off:e}") } else { "what is no number".to_owned() };
    match *law {
        Law::Identity(_) => {
            let off = worst(&|p| f.point(p).distance(p));
            (off > NEAR).then(|| format!("{pairs:?} should be the identity; it moves a point by {}", by(off)))
        }
        Law::Same(a, b) => {
            let off = worst(&|p| f.point(p).distance(g.point(p)));
            (off > NEAR).then(|| format!("{a:?} and {b:?} should be one map; they differ by {}", by(off)))
        }
        Law::KeepsLines(_) => {
            let off = worst(&|p| bent(f, p, Point::new(97.0 - p.x, 0.3 * p.y + 11.0)));
            (off > NEAR).then(|| format!("{pairs:?} should keep lines straight; it bends one by {}", by(off)))
        }
        Law::KeepsLinesAlong(_, (x, y)) => {
            let off = worst(&|p| bent(f, p, p + Vec2::new(x, y) * (9.0 / x.hypot(y))));
            (off > NEAR)
                .then(|| format!("{pairs:?} should keep lines along {x},{y} straight; it bends one by {}", by(off)))
        }
        Law::FixedOutside(_, [x0, y0, x1, y1]) => {
            let inside = Rect::new(x0, y0, x1, y1);
            if worst(&|p| f.point(p).distance(p)) > 0.0 {
                let off = worst(&|p| if inside.contains(p) { 0.0 } else { f.point(p).distance(p) });
                (off > 0.0).then(|| {
                    format!("{pairs:?} should move nothing outside {inside:?}; it moves a point by {}", by(off))
                })
            } else {
                Some(format!("{pairs:?} moves nothing at all"))
            }
        }
        Law::Area(_, factor) => {
            let off = worst(&|p| (f.jet(p).det() - factor).abs());
            (off > NEAR * (1.0 + factor.abs()))
                .then(|| format!("{pairs:?} should multiply areas by {factor}; it is off by {}", by(off)))
        }
        Law::KeepsAngles(_) => {
            // Cauchy–Riemann equations: ∂F/∂y is ∂F/∂x rotated by 90°.
            let off = worst(&|p| {
                let j = f.jet(p);
                (j.dy - j.dx.turn_90()).hypot() / j.dx.hypot().max(f64::MIN_POSITIVE)
            });
            (off > NEAR).then(|| format!("{pairs:?} should keep angles; one is off by {}", by(off)))
        }
        Law::Undoes(there, back) => {
            let off = worst(&|p| g.point(f.point(p)).distance(p));
            (off > NEAR).then(|| format!("{back:?} should undo {there:?}; a point ends {} away", by(off)))
        }
    }
}
