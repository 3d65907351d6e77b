//! The map of a deformation: derivatives, batches, exact images, inverse, and a refit.

use super::outcome::Check;
use crate::deform::Built;
use crate::map::{CreaseKind, Creases, Jet, Map, RationalBezier};
use crate::outline::{EllipticArc, Outline, Seg};
use crate::refit;
use kurbo::{CubicBez, Line, ParamCurveNearest, Point, Shape, Vec2};

/// All checks of a map; only the first if it gives two answers for one point, since nothing else means anything then.
pub(super) fn all(built: &Built) -> Vec<Check> {
    let domain = Domain::of(built);
    if let Some(fault) = two_answers(&*built.map, &domain) {
        let mut faults = Check::new("values");
        faults.fault(fault);
        return vec![faults.unless_failed(built)];
    }
    [derivatives, exact_images, inverse, refitting].map(|check| check(&*built.map, &domain).unless_failed(built)).into()
}

/// Where a map is defined.
pub(super) struct Domain<'a> {
    creases: Creases,
    built: &'a Built,
}

impl<'a> Domain<'a> {
    pub(super) fn of(built: &'a Built) -> Self {
        let mut creases = Creases::default();
        built.map.creases(&mut creases);
        Self { creases, built }
    }

    /// The map may be undefined somewhere, so that a value there is no fault if it is not a number.
    pub(super) fn is_partial(&self) -> bool {
        self.built.undefined.is_some() || self.creases.items().iter().any(|c| c.kind == CreaseKind::Edge)
    }

    fn contains(&self, p: Point) -> bool {
        self.creases.defined_at(p) && self.built.undefined.as_ref().is_none_or(|why| why(p).is_none())
    }

    /// Points of the frame where the map is defined, away from likely creases, and the number of those where it is not.
    pub(super) fn samples(&self) -> (Vec<Point>, usize) {
        let grid =
            (0..9).flat_map(|i| (0..9).map(move |j| Point::new(3.7 + 11.3 * f64::from(i), 4.3 + 11.1 * f64::from(j))));
        let (inside, outside): (Vec<Point>, Vec<Point>) = grid.partition(|p| self.contains(*p));
        (inside, outside.len())
    }
}

/// Words for points that were skipped.
pub(super) fn skipped(count: usize) -> String {
    if count == 0 { String::new() } else { format!("; {count} outside of the domain are skipped") }
}

/// A point for which the map gives two answers: in a batch, in another batch, and alone.
fn two_answers(map: &dyn Map, domain: &Domain<'_>) -> Option<String> {
    let (ps, _) = domain.samples();
    let mut answers = [ps.clone(), ps.clone()];
    for a in &mut answers {
        map.points(&ps, a);
    }
    let [first, second] = answers;
    let differ = |p: &Point, a: Point, b: Point| {
        let size = 1.0 + a.to_vec2().hypot();
        // One is a number and the other is none, or they are apart.
        let apart = a.is_finite() != b.is_finite() || a.is_finite() && a.distance(b) > 1e-12 * size;
        apart.then(|| {
            format!("gives two answers for the point {},{}: {},{} and then {},{}", p.x, p.y, a.x, a.y, b.x, b.y)
        })
    };
    let mut pairs = ps.iter().zip(first.iter().zip(&second));
    pairs.find_map(|(p, (a, b))| differ(p, *a, *b).or_else(|| differ(p, *a, map.point(*p))))
}

fn derivatives(map: &dyn Map, domain: &Domain<'_>) -> Check {
    let mut faults = Check::new("values");
    let mut largest: f64 = 0.0;
    let (ps, mut outside) = domain.samples();
    let (mut jets, mut points) = (vec![Jet::default(); ps.len()], vec![Point::ORIGIN; ps.len()]);
    map.jets(&ps, &mut jets);
    map.points(&ps, &mut points);
    for ((p, j), q) in ps.iter().zip(&jets).zip(&points) {
        if !j.is_finite() {
            faults.fault(format!("is not finite at {p:?}"));
            continue;
        }
        let size = 1.0 + j.p.to_vec2().hypot();
        if map.jet(*p).p.distance(j.p) > 1e-12 * size || q.distance(j.p) > 1e-12 * size {
            faults.fault(format!("single and batched values differ at {p:?}"));
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
            faults.fault(format!("derivatives at {p:?}: {j:?}, differences give {dx:?} {dy:?}"));
        }
    }
    faults.detail = format!(
        "{} points are finite, alone and in batches; derivatives differ from differences by {largest:.0e}{}",
        ps.len(),
        skipped(outside)
    );
    faults
}

fn exact_images(map: &dyn Map, domain: &Domain<'_>) -> Check {
    let mut faults = Check::new("images");
    faults.detail = "it gives no exact images of curves".into();
    let segs = [
        Seg::Line(Line::new((5.0, 10.0), (60.0, 40.0))),
        Seg::Cubic(CubicBez::new((10.0, 20.0), (40.0, 0.0), (70.0, 80.0), (30.0, 90.0))),
        Seg::Arc(EllipticArc::new(Point::new(50.0, 50.0), Vec2::new(30.0, 5.0), Vec2::new(-4.0, 20.0), 0.3, 1.2)),
    ];
    for source in segs.iter().filter_map(RationalBezier::from_seg) {
        if let Some(image) = map.image(&source) {
            faults.detail = "exact images of a line, a cubic and an arc".into();
            for i in 0..=12 {
                let t = f64::from(i) / 12.0;
                let (a, b) = (image.eval(t), map.point(source.eval(t)));
                let off = a.distance(b);
                if off > 1e-9 * (1.0 + b.to_vec2().hypot()) || off.is_nan() && !domain.is_partial() {
                    faults.fault(format!("the exact image at {t} is {a:?}, the map says {b:?}"));
                }
            }
        }
    }
    faults
}

fn inverse(map: &dyn Map, domain: &Domain<'_>) -> Check {
    let mut faults = Check::new("inverse");
    let Some(back) = map.inverse() else {
        faults.detail = "it gives none; Newton's method finds it".into();
        return faults;
    };
    let mut largest: f64 = 0.0;
    let (ps, outside) = domain.samples();
    for p in ps {
        let q = back.point(map.point(p));
        largest = largest.max(q.distance(p));
        if q.distance(p).is_nan() || q.distance(p) > 1e-8 * (1.0 + p.to_vec2().hypot()) {
            faults.fault(format!("the inverse takes the image of {p:?} to {q:?}"));
        }
    }
    faults.detail = format!("it leads back, within {largest:.0e}{}", skipped(outside));
    faults
}

/// Compares a refitted circle and line with dense samples of the true image.
fn refitting(map: &dyn Map, domain: &Domain<'_>) -> Check {
    let mut faults = Check::new("refitting");
    const TOLERANCE: f64 = 0.01;
    let mut art = Outline::from_svg("M20,50 A30,30 0 1 1 80,50 A30,30 0 1 1 20,50 Z M10,10 L90,85").unwrap_or_default();
    let all = art.subpaths.len();
    art.subpaths.retain(|s| s.segs.iter().all(|g| (0..=100).all(|i| domain.contains(g.eval(f64::from(i) / 100.0)))));
    if art.subpaths.is_empty() {
        faults.detail = "a circle and a line leave the domain and are skipped".into();
        return faults;
    }
    let outside = if art.subpaths.len() < all { "; what leaves the domain is skipped" } else { "" };
    match refit::warp_path(&art, map, &refit::Options::new(TOLERANCE)) {
        Ok(w) => {
            let segs: Vec<_> = w.path.segments().collect();
            faults.detail = format!("a circle and a line become {} curves within {TOLERANCE}{outside}", segs.len());
            for seg in art.segs() {
                for i in 0..=100 {
                    let p = map.point(seg.eval(f64::from(i) / 100.0));
                    let off = segs
                        .iter()
                        .map(|s| s.nearest(p, TOLERANCE * 1e-4).distance_sq)
                        .fold(f64::INFINITY, f64::min)
                        .sqrt();
                    if off.is_nan() || off > TOLERANCE * (1.0 + 1e-6) {
                        faults.fault(format!("refitted within {TOLERANCE}, a sample at {p:?} is {off} away"));
                        return faults;
                    }
                }
            }
            if !w.path.bounding_box().is_finite() {
                faults.fault("refitting gives numbers that are not finite");
            }
        }
        Err(e) => faults.fault(format!("refitting its demo fails: {e}")),
    }
    faults
}
