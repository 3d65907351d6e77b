//! Checks of a deformation: its table, derivatives, exact images, laws and known values.
//!
//! Authors of plug-ins call [`entry`] in a test:
//!
//! ```
//! let registry = pathwarp::deform::Registry::builtin();
//! let faults = pathwarp::check::entry(registry.get("projective").unwrap().as_ref());
//! assert!(faults.is_empty(), "{faults:#?}");
//! ```
//!
//! [`report`] hands over the checks one by one, to be shown to people.

mod breaks;
mod counted;
#[cfg(test)]
mod tests;
mod values;

pub use counted::{Counted, operations};

use crate::deform::{Built, Deformation, Info, Law, Pairs};
use crate::error::Error;
use crate::map::{CreaseKind, Creases, Map, RationalBezier, detail_in};
use crate::outline::{EllipticArc, Outline, Seg};
use crate::param::{Args, Frame, Kind, Settings};
use crate::refit;
use kurbo::{CubicBez, Line, ParamCurveNearest, PathSeg, Point, Rect, Shape, Vec2};
use std::cell::Cell;
use std::f64::consts::PI;

/// Returns a message for every fault of `entry`; none if it is sound.
#[must_use]
pub fn entry(entry: &dyn Deformation) -> Vec<String> {
    let name = entry.info().name;
    let mut faults = Vec::new();
    report(entry, |check| faults.extend(check.faults.into_iter().map(|fault| format!("{name}: {fault}"))));
    faults
}

/// Runs every check of `entry`, and hands over each one as soon as it is done.
pub fn report(entry: &dyn Deformation, mut done: impl FnMut(Check)) {
    table(entry.info()).into_iter().for_each(&mut done);
    match entry.build_from(&Args::from_pairs(entry.info().demo), &frame()) {
        Ok(built) => {
            done(Check::new("build", "from the defaults and the demo"));
            if !map(&built, frame().rect, &mut done) {
                return;
            }
        }
        Err(e) => {
            let fault = format!("does not build from its defaults and demo: {e}");
            done(Check { faults: vec![fault], ..Check::new("build", "") });
        }
    }
    done(laws(entry));
    done(cases(entry));
}

/// The failure of a map that asks another program, if it has failed. Values after a failure mean nothing.
fn failure(built: &Built) -> Option<Error> {
    built.failure.as_ref().and_then(|f| f())
}

/// One check with its outcome.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Check {
    /// A word for the property that is checked.
    pub name: &'static str,
    /// A description of the samples, and the largest error.
    pub detail: String,
    /// The faults; empty if there are none.
    pub faults: Vec<String>,
    /// Points at which faults were seen.
    faulty: Vec<Point>,
}

/// The limit on listed faults of one kind: a wrong formula is wrong at every sample.
const LISTED: usize = 3;

impl Check {
    fn new(name: &'static str, detail: impl Into<String>) -> Self {
        Self { name, detail: detail.into(), faults: Vec::new(), faulty: Vec::new() }
    }

    fn fault(&mut self, what: impl Into<String>) {
        self.faults.push(what.into());
    }

    /// Replaces the faults by the failure of the map, if it has failed, or else limits their number.
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

/// Checks the description of a deformation of the plane or of space: the texts for people, and the parameters with their defaults.
#[must_use]
pub fn table(info: &Info) -> [Check; 2] {
    [help(info), parameters(info)]
}

/// Checks the texts for people, and the guides, of which `usual` is the default number.
fn help(info: &Info) -> Check {
    let detail = format!("title, group, about, source, {} examples", info.examples.len());
    let mut check = Check::new("help", detail);
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

/// Checks the parameters and their defaults.
fn parameters(info: &Info) -> Check {
    let mut check = Check::new("parameters", info.params.iter().map(|p| p.name).collect::<Vec<_>>().join(", "));
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
            // Only getters are called, so that required parameters may be missing.
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

// The map of a deformation: values, derivatives, creases, exact images, inverse, and a refit.

/// Runs the checks of a map over a box, and hands over each one as soon as it is done. Returns `false` if the map gives two answers for one
/// point, so that no other check makes sense.
pub fn map(built: &Built, frame: Rect, mut done: impl FnMut(Check)) -> bool {
    let tested = Tested::new(built, frame);
    if let Some(fault) = tested.two_answers(&[]) {
        let detail = format!("{} points", tested.samples.len());
        done(Check { faults: vec![fault], ..Check::new("values", detail) }.unless_failed(built));
        return false;
    }
    let mut is_sound = |check: fn(&Tested<'_>) -> Check| {
        let mut check = check(&tested);
        let is_sound = check.faults.is_empty();
        if let Some(fault) = (!is_sound).then(|| tested.two_answers(&check.faulty)).flatten() {
            check.faults = vec![fault];
        }
        done(check.unless_failed(built));
        is_sound
    };
    let has_right_values = is_sound(values::values);
    if tested.has_values() {
        // Wrong values would also be seen as kinks, and both as errors of the refit.
        let is_smooth = has_right_values && is_sound(creases);
        is_sound(exact_images);
        is_sound(inverse);
        if is_smooth {
            is_sound(refitting);
        }
    }
    true
}

/// A map over a box.
struct Tested<'a> {
    built: &'a Built,
    map: &'a dyn Map,
    frame: Rect,
    creases: Creases,
    /// Points in the box where the map is defined.
    samples: Vec<Point>,
    /// The images of the samples when the map was asked first.
    images: Vec<Point>,
    /// The number of sampled points outside the domain.
    outside: usize,
}

impl<'a> Tested<'a> {
    fn new(built: &'a Built, frame: Rect) -> Self {
        let mut creases = Creases::default();
        built.map.creases(&mut creases);
        let (map, samples, images) = (&*built.map, Vec::new(), Vec::new());
        let mut tested = Self { built, map, frame, creases, samples, images, outside: 0 };
        // A grid of 9 × 9 points, in percent of the box, that avoids likely creases.
        let grid = (0..81).map(|n| (3.7 + 11.3 * f64::from(n / 9), 4.3 + 11.1 * f64::from(n % 9)));
        let sample = |(u, v)| Point::new(frame.x0 + u * frame.width() / 100.0, frame.y0 + v * frame.height() / 100.0);
        tested.samples = grid.map(sample).filter(|p| tested.is_in_domain(*p)).collect();
        tested.outside = 81 - tested.samples.len();
        tested.images = tested.values(&tested.samples);
        tested
    }

    /// Returns `true` if the map may be undefined somewhere, so that NaN is no fault.
    fn allows_nan(&self) -> bool {
        self.built.undefined.is_some() || self.creases.items().iter().any(|c| c.kind == CreaseKind::Edge)
    }

    /// Returns `true` if the map is declared to be defined at a point.
    fn is_in_domain(&self, p: Point) -> bool {
        self.creases.defined_at(p) && self.built.undefined.as_ref().is_none_or(|why| why(p).is_none())
    }

    /// Returns `true` if a declared crease lies between `p` − 2·`step` and `p` + 2·`step`.
    fn has_crease_near(&self, p: Point, step: Vec2) -> bool {
        self.creases.items().iter().any(|c| c.level.at(p - step * 2.0) * c.level.at(p + step * 2.0) <= 0.0)
    }

    fn has_values(&self) -> bool {
        self.images.iter().any(|q| q.is_finite())
    }

    /// The images of some points, computed in one batch.
    fn values(&self, ps: &[Point]) -> Vec<Point> {
        let mut out = ps.to_vec();
        self.map.points(ps, &mut out);
        out
    }

    /// Looks for a point for which the map gives two answers: at first and now, in a batch or alone. `more` are points besides the samples.
    fn two_answers(&self, more: &[Point]) -> Option<String> {
        let fault = |p: Point, a: Point, b: Point, why: &str| {
            // Either only one of them is a number, or their distance exceeds rounding.
            let differ = a.is_finite() != b.is_finite() || (a.is_finite() && values::differ(a, b));
            let [p, a, b] = [coordinates(p), format!("{},{}", a.x, a.y), format!("{},{}", b.x, b.y)];
            differ.then(|| format!("gives two answers for the point {p}: {a} and then {b}{why}"))
        };
        const CHANGED: &str = "; its answer may depend on nothing but the point: no random numbers, no counters";
        const ALONE: &str = ", asked for alone; its answer may not depend on the other points of a batch";
        let compare = |ps: &[Point], first: &[Point]| {
            let again = self.values(ps);
            let changed = ps.iter().zip(first).zip(&again).find_map(|((p, a), b)| fault(*p, *a, *b, CHANGED));
            changed.or_else(|| ps.iter().zip(first).find_map(|(p, a)| fault(*p, *a, self.map.point(*p), ALONE)))
        };
        compare(&self.samples, &self.images).or_else(|| compare(more, &self.values(more)))
    }
}

/// Formats a point for a message.
fn coordinates(p: Point) -> String {
    format!("{},{}", number(p.x), number(p.y))
}

/// Formats a number with six digits.
fn number(v: f64) -> String {
    let short = format!("{v:.5e}").parse().unwrap_or(v) + 0.0;
    if short == 0.0 || (1e-4..1e9).contains(&short.abs()) { short.to_string() } else { format!("{short:e}") }
}

/// The end of a detail about the samples that were skipped.
fn skipped(count: usize) -> String {
    if count == 0 { String::new() } else { format!("; {count} outside of the domain are skipped") }
}

/// Looks for kinks and jumps that the map does not declare.
fn creases(t: &Tested<'_>) -> Check {
    let declared = t.creases.items().len();
    let detail = format!("{declared} are declared; others were looked for on lines across the box");
    let mut check = Check::new("creases", detail);
    (check.faults, check.faulty) = breaks::undeclared(t).into_iter().unzip();
    check
}

fn exact_images(tested: &Tested<'_>) -> Check {
    let map = tested.map;
    let mut check = Check::new("images", "it gives no exact images of curves");
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
                let distance = a.distance(b);
                if distance > 1e-9 * (1.0 + b.to_vec2().hypot()) || (distance.is_nan() && !tested.allows_nan()) {
                    let [a, b] = [a, b].map(coordinates);
                    check.fault(format!("the exact image at {} is {a}, the map says {b}", number(t)));
                }
            }
        }
    }
    check
}

fn inverse(t: &Tested<'_>) -> Check {
    let mut check = Check::new("inverse", "it gives none; Newton's method finds it");
    let Some(back) = t.map.inverse() else { return check };
    let mut largest: f64 = 0.0;
    let (mut wrong, mut first) = (0, None);
    for (p, image) in t.samples.iter().zip(&t.images) {
        let q = back.point(*image);
        let distance = q.distance(*p);
        largest = largest.max(distance);
        if distance.is_nan() || distance > 1e-8 * (1.0 + p.to_vec2().hypot()) {
            wrong += 1;
            check.faulty.push(*p);
            // If two points have one image, the map folds.
            let folds = t.map.point(q).distance(*image) < 1e-8 * (1.0 + image.to_vec2().hypot());
            let why = if folds {
                ", which has the same image: the map folds, so no inverse leads back everywhere"
            } else {
                ""
            };
            let back = if q.is_finite() { coordinates(q) } else { "no point".to_owned() };
            let [p, image] = [*p, *image].map(coordinates);
            first.get_or_insert_with(|| format!("it takes the image of {p}, {image}, to {back}{why}"));
        }
    }
    if let Some(first) = first {
        check.fault(format!("the inverse does not lead back at {wrong} of {} places: {first}", t.samples.len()));
    }
    check.detail = format!("it leads back, within {largest:.0e}{}", skipped(t.outside));
    check
}

/// Compares the refitted images of a circle and of lines with dense samples of the true images. The lengths of the lines are multiples of
/// the map's detail. The detail is the size of its smallest feature, a quarter of its shortest wave, taken as at most a hundredth of the
/// frame's diagonal and at least a ten-thousandth. For a map that declares none, reports say that errors are `sampled` and may be larger
/// in between.
fn refitting(t: &Tested<'_>) -> Check {
    const DETAILS: [u32; 12] = [1, 3, 8, 17, 34, 51, 68, 85, 102, 144, 233, 400];
    /// The number of samples of a detail, to which a prime number is added for each line.
    const SAMPLES: u32 = 12;
    let mut check = Check::new("refitting", "a circle and 12 lines");
    let (map, frame) = (t.map, t.frame);
    // A point inside the domain, so that short lines lie in it.
    let inner = t.samples.get(t.samples.len() / 2).copied();
    let center = inner.filter(|_| !t.is_in_domain(frame.center())).unwrap_or(frame.center());
    let hundredth = 0.01 * frame.size().to_vec2().hypot();
    // In the box of checks, a hundredth of a unit.
    let tolerance = hundredth / 2_f64.sqrt() * 0.01;
    let declared = detail_in(map, frame);
    let detail = declared.unwrap_or(f64::INFINITY).clamp(0.01 * hundredth, hundredth);
    let (r, y) = (0.3 * frame.width().min(frame.height()), center.y);
    let (from, to) = (center.x - r, center.x + r);
    let circle = Outline::from_svg(&format!("M{from},{y} A{r},{r} 0 1 1 {to},{y} A{r},{r} 0 1 1 {from},{y} Z"));
    // Each outline with its number of samples. The lines go in many directions.
    let mut art = vec![(circle.unwrap_or_default(), 101)];
    art.extend(DETAILS.iter().enumerate().map(|(i, n)| {
        let half = Vec2::from_angle(0.618 * i as f64) * (0.5 * detail * f64::from(*n));
        (Outline::from_points(&[center - half, center + half], false), SAMPLES * n + 97)
    }));
    let all = art.len();
    art.retain(|(art, _)| art.segs().all(|g| (0..=100).all(|i| t.is_in_domain(g.eval(f64::from(i) / 100.0)))));
    let mut pieces = 0;
    for (art, samples) in &art {
        let fitted = refit::warp_path(art, map, &refit::Options::new(tolerance).with_nodes(refit::Nodes::Source));
        let fitted = match fitted {
            Ok(fitted) => fitted,
            Err(e) => {
                check.fault(format!("no curves could be fitted: {e}"));
                return check;
            }
        };
        pieces += fitted.report.segments_out;
        let segs: Vec<_> = fitted.path.segments().collect();
        let miss = art.segs().find_map(|seg| Some((seg, first_miss(map, seg, &segs, *samples, tolerance)?)));
        // A larger error is no fault if the refit reports it as unresolved.
        if let (Some((seg, (p, distance))), true) = (miss, fitted.report.unresolved.is_empty()) {
            let told = declared.map_or_else(|| "none is declared".to_owned(), |d| format!("{} is declared", number(d)));
            let length = seg.eval(0.0).distance(seg.eval(1.0));
            let advice = shortest_wave(map, p, length).map_or_else(String::new, |wave| {
                let (wave, detail) = (number(wave), number(0.25 * wave));
                format!("; its waves are down to {wave} long there: declare a detail of {detail} ({told})")
            });
            check.faulty.push(p);
            let [tolerance, distance] = [tolerance, distance].map(number);
            let p = coordinates(p);
            check.fault(format!("a curve fitted within {tolerance} is {distance} away from the image of {p}{advice}"));
            return check;
        }
        if !fitted.path.bounding_box().is_finite() {
            check.fault("refitting gives numbers that are not finite");
        }
    }
    let (fitted, lines) = (art.len(), all - 1);
    check.detail =
        format!("{fitted} of a circle and {lines} lines become {pieces} curves within {}", number(tolerance));
    if fitted < all {
        check.detail += "; the others leave the domain and are skipped";
    }
    if declared.is_none() {
        check.detail += "; it declares no detail, so reports say sampled";
    }
    check
}

/// The length of the shortest wave of a map on lines of a length through a point, from the numbers of inflections of their images; `None`
/// if ever finer samples do not agree on these numbers.
fn shortest_wave(map: &dyn Map, p: Point, length: f64) -> Option<f64> {
    let inflections = |along: Vec2, n: usize| {
        let samples: Vec<Point> = (0..=n).map(|i| p + along * (i as f64 / n as f64 - 0.5)).collect();
        let mut q = samples.clone();
        map.points(&samples, &mut q);
        let bends = q.windows(3).map(|q| q[0].to_vec2() + q[2].to_vec2() - 2.0 * q[1].to_vec2());
        let bends: Vec<Vec2> = bends.filter(|b| b.is_finite()).collect();
        let largest = bends.iter().copied().reduce(|a, b| if b.hypot() > a.hypot() { b } else { a })?;
        let sides = bends.iter().map(|b| b.dot(largest)).filter(|d| d.abs() > 0.01 * largest.hypot2());
        let sides: Vec<bool> = sides.map(|d| d > 0.0).collect();
        Some(sides.windows(2).filter(|s| s[0] != s[1]).count())
    };
    let wave_along = |along: Vec2| {
        let counts: Vec<Option<usize>> = (8..=15).map(|k| inflections(along, 1 << k)).collect();
        // The number settles if twice the samples give the same, and there are more than eight samples for each inflection.
        let mut pairs = counts.windows(2).enumerate().filter(|(_, c)| c[0] == c[1]);
        let settled = pairs.find_map(|(k, c)| c[0].filter(|n| *n > 1 && *n < 32 << k))?;
        Some(2.0 * length / settled as f64)
    };
    (0..8).filter_map(|k| wave_along(Vec2::from_angle(f64::from(k) * PI / 8.0) * length)).reduce(f64::min)
}

/// The first of evenly spaced samples whose image is further than `tolerance` from a path, and its distance.
fn first_miss(map: &dyn Map, seg: &Seg, path: &[PathSeg], samples: u32, tolerance: f64) -> Option<(Point, f64)> {
    // Samples follow each other, so the nearest piece is that of the sample before, or comes soon after it.
    let mut last = 0;
    (0..=samples).find_map(|i| {
        let source = seg.eval(f64::from(i) / f64::from(samples));
        let p = map.point(source);
        let distance = |k: usize| path[k].nearest(p, tolerance * 1e-4).distance_sq.sqrt();
        match (last..path.len()).chain(0..last).find(|k| distance(*k) <= tolerance * (1.0 + 1e-6)) {
            Some(k) => last = k,
            None => return Some((source, (0..path.len()).map(distance).fold(f64::INFINITY, f64::min))),
        }
        None
    })
}

// The laws that a deformation states, and values known from elsewhere.

/// Differences up to this are rounding.
const ROUNDING: f64 = 1e-9;

/// Checks the laws.
fn laws(entry: &dyn Deformation) -> Check {
    let mut check = Check::new("laws", format!("{} of them", entry.info().laws.len()));
    let outside: usize = entry.info().laws.iter().map(|law| check_law(entry, law, &mut check)).sum();
    check.detail += &skipped(outside);
    check
}

/// Checks the known values.
fn cases(entry: &dyn Deformation) -> Check {
    let mut check = Check::new("cases", format!("{} known values", entry.info().cases.len()));
    for case in entry.info().cases {
        let args = json(case.args);
        match build(entry, case.args) {
            Ok(built) => {
                let (at, to) = (Point::from(case.at), Point::from(case.to));
                let got = built.map.point(at);
                let distance = got.distance(to);
                if let Some(failure) = failure(&built) {
                    check.fault(format!("{args}: {failure}"));
                } else if distance.is_nan() || distance > case.tolerance {
                    let changed = Tested::new(&built, frame().rect).two_answers(&[at]);
                    let [at, got, to] = [at, got, to].map(coordinates);
                    let wrong = || format!("takes {at} to {got}, {} away from {to}", number(distance));
                    check.fault(format!("{args} {}", changed.unwrap_or_else(wrong)));
                }
            }
            Err(e) => check.fault(format!("{args} does not build: {e}")),
        }
    }
    check
}

/// Writes values as in the entry of a plug-in, as JSON.
fn json(pairs: Pairs) -> String {
    let value = |v: &str| if v.parse::<f64>().is_ok() { v.to_owned() } else { format!("\"{v}\"") };
    let pairs: Vec<String> = pairs.iter().map(|(name, v)| format!("\"{name}\": {}", value(v))).collect();
    format!("{{{}}}", pairs.join(", "))
}

fn build(entry: &dyn Deformation, pairs: Pairs) -> Result<Built, Error> {
    entry.build_from(&Args::from_pairs(pairs), &frame())
}

/// Returns the distance of the image of a point between `p` and `q` from the line through their images.
fn bending(m: &dyn Map, p: Point, q: Point) -> f64 {
    let (a, b, c) = (m.point(p), m.point(p.lerp(q, 0.4)), m.point(q));
    let n = (c - a).hypot();
    if n == 0.0 { 0.0 } else { ((b - a).cross(c - a) / n).abs() }
}

/// Checks a law, and returns the number of samples that were skipped.
fn check_law(entry: &dyn Deformation, law: &Law, check: &mut Check) -> usize {
    // The keys are named as in the entry of a plug-in.
    let (key, values) = match *law {
        Law::Identity(a) => ("identity", vec![a]),
        Law::Same(a, b) => ("same", vec![a, b]),
        Law::KeepsLines(a) => ("keeps-lines", vec![a]),
        Law::KeepsLinesAlong(a, _) => ("keeps-lines-along", vec![a]),
        Law::FixedOutside(a, _) => ("fixed-outside", vec![a]),
        Law::Area(a, _) => ("area", vec![a]),
        Law::KeepsAngles(a) => ("keeps-angles", vec![a]),
        Law::Undoes(a, b) => ("undoes", vec![a, b]),
    };
    let mut built = Vec::with_capacity(values.len());
    for pairs in &values {
        match build(entry, pairs) {
            Ok(b) => built.push(b),
            Err(e) => check.fault(format!("{} does not build: {e}", json(pairs))),
        }
    }
    let (Some(first), Some(last)) = (built.first(), built.last().filter(|_| built.len() == values.len())) else {
        return 0;
    };
    let (tested, later) = (Tested::new(first, frame().rect), Tested::new(last, frame().rect));
    let allows_nan = tested.allows_nan() || later.allows_nan();
    let skips = Cell::new(tested.outside);
    let tried = Cell::new(0);
    // The sample with the largest value in the last call of `worst`.
    let worst_sample = Cell::new(None);
    let worst = |f: &dyn Fn(Point) -> f64| {
        worst_sample.set(None);
        let (mut largest, mut undefined) = (0.0_f64, tested.outside);
        for &p in &tested.samples {
            let value = f(p);
            if value.is_nan() && allows_nan {
                undefined += 1;
                continue;
            }
            tried.set(tried.get() + 1);
            if value > largest || value.is_nan() {
                worst_sample.set(Some(p));
                largest = if value.is_nan() { f64::INFINITY } else { value };
            }
        }
        // A law may ask twice about the samples.
        skips.set(skips.get().max(undefined));
        largest
    };
    let fault = violation(law, values[0], [&*first.map, &*last.map], &worst);
    let more = Vec::from_iter(worst_sample.get());
    // Values after a failure mean nothing, and values that change mean nothing either.
    if let Some((pairs, e)) = values.iter().zip(&built).find_map(|(pairs, b)| Some((pairs, failure(b)?))) {
        check.fault(format!("{}: {e}", json(pairs)));
    } else if tried.get() == 0 {
        check.fault(format!("{key} {}: the map has no value at any place", json(values[0])));
    } else if let Some(fault) = fault {
        let changed = tested.two_answers(&more).map(|fault| (values[0], fault));
        let changed = changed.or_else(|| Some((*values.last()?, later.two_answers(&more)?)));
        let worst = more.first().map(|p| format!(", worst at {}", coordinates(*p))).unwrap_or_default();
        check.fault(changed.map_or(fault + &worst, |(pairs, fault)| format!("{} {fault}", json(pairs))));
    }
    skips.get()
}

/// The largest value of a function at the samples.
type Worst<'a> = &'a dyn Fn(&dyn Fn(Point) -> f64) -> f64;

/// Describes how `f` and `g` break a law, if they do. A law about one map gets it twice.
fn violation(law: &Law, pairs: Pairs, [f, g]: [&dyn Map; 2], worst: Worst<'_>) -> Option<String> {
    let args = json(pairs);
    let moved = |m: &dyn Map, p: Point| m.point(p).distance(p);
    let (error, allowed, fault) = match *law {
        Law::Identity(_) => {
            (worst(&|p| moved(f, p)), ROUNDING, format!("{args} should be the identity; it moves a point by"))
        }
        Law::Same(a, b) => {
            let error = worst(&|p| f.point(p).distance(g.point(p)));
            (error, ROUNDING, format!("{} and {} should be one map; they differ by", json(a), json(b)))
        }
        Law::KeepsLines(_) => {
            let error = worst(&|p| bending(f, p, Point::new(97.0 - p.x, 0.3 * p.y + 11.0)));
            (error, ROUNDING, format!("{args} should keep lines straight; it bends one by"))
        }
        Law::KeepsLinesAlong(_, (x, y)) => {
            let error = worst(&|p| bending(f, p, p + Vec2::new(x, y) * (9.0 / x.hypot(y))));
            (error, ROUNDING, format!("{args} should keep lines along {x},{y} straight; it bends one by"))
        }
        Law::FixedOutside(_, [x0, y0, x1, y1]) => {
            if worst(&|p| moved(f, p)) <= 0.0 {
                return Some(format!("{args} moves nothing at all"));
            }
            let inside = Rect::new(x0, y0, x1, y1);
            let error = worst(&|p| if inside.contains(p) { 0.0 } else { moved(f, p) });
            let area = format!("{x0},{y0} to {x1},{y1}");
            (error, 0.0, format!("{args} should move nothing outside {area}; it moves a point by"))
        }
        Law::Area(_, factor) => {
            let error = worst(&|p| (f.jet(p).det() - factor).abs());
            let allowed = ROUNDING * (1.0 + factor.abs());
            (error, allowed, format!("{args} should multiply areas by {factor}; it is off by"))
        }
        Law::KeepsAngles(_) => {
            // By the Cauchy–Riemann equations, ∂F/∂y is ∂F/∂x rotated by 90°.
            let error = worst(&|p| {
                let j = f.jet(p);
                (j.dy - j.dx.turn_90()).hypot() / j.dx.hypot().max(f64::MIN_POSITIVE)
            });
            (error, ROUNDING, format!("{args} should keep angles; one is off by"))
        }
        Law::Undoes(there, back) => {
            let error = worst(&|p| g.point(f.point(p)).distance(p));
            (error, ROUNDING, format!("{} should undo {}; a point ends", json(back), json(there)))
        }
    };
    let end = if matches!(law, Law::Undoes(..)) { " away" } else { "" };
    let amount = if error.is_finite() { number(error) } else { "what is no number".to_owned() };
    (error > allowed).then(|| format!("{fault} {amount}{end}"))
}
