//! Checks values, alone and in batches, and compares derivatives with differences.

use super::{Check, Tested, coordinates, number, skipped};
use crate::map::{Batches, Jet};
use kurbo::{Point, Vec2};
use std::f64::consts::PI;

/// Checks values and derivatives at the samples.
pub(super) fn values(t: &Tested<'_>) -> Check {
    let count = t.samples.len();
    let mut check = Check::new("values", "");
    if !t.has_values() {
        // Without samples, the whole grid lies outside the domain.
        let (places, f) = (if count == 0 { t.outside } else { count }, t.frame);
        check
            .fault(format!("has no value at any of {places} places in the box {},{} to {},{}", f.x0, f.y0, f.x1, f.y1));
        return check;
    }
    check.detail = format!("{count} points");
    if let Some(fault) = rounding(t) {
        check.fault(fault);
        return check;
    }
    let mut jets = vec![Jet::default(); count];
    t.map.jets(&t.samples, &mut jets);
    // Derivatives computed from values lack some digits for narrow waves.
    let gives_derivatives = !t.map.cost().batches.is_some_and(Batches::differentiates);
    let tolerance = if gives_derivatives { 1e-5 } else { 1e-2 };
    let mut outside = t.outside;
    let mut slopes = Slopes::default();
    // The faulty points, by the index of their fault in FAULTS.
    let mut faulty: [Vec<Point>; 3] = [const { Vec::new() }; 3];
    for (((p, j), q), found) in t.samples.iter().zip(&jets).zip(&t.images).zip(differences(t)) {
        if !q.is_finite() || !j.is_finite() {
            faulty[usize::from(q.is_finite())].push(*p);
            continue;
        }
        if differ(t.map.jet(*p).p, j.p) || differ(*q, j.p) {
            faulty[2].push(*p);
        }
        if t.allows_nan() && !(found[0] + found[1]).is_finite() {
            outside += 1;
        } else {
            slopes.add(*p, j, found, tolerance);
        }
    }
    const FAULTS: [&str; 3] = [
        "has no value, which an edge of its domain would explain,",
        "has no derivatives",
        "gives another value with derivatives than without, or alone than in a batch,",
    ];
    for (fault, points) in FAULTS.iter().zip(faulty).filter(|(_, points)| !points.is_empty()) {
        check.fault(format!("{fault} at {} of {count} places, such as {}", points.len(), coordinates(points[0])));
        check.faulty.extend(points);
    }
    check.faults.extend(slopes.faults(gives_derivatives));
    let mirrored = match slopes.mirrored {
        0 => String::new(),
        n if n == slopes.compared => "; it mirrors, as one does that swaps x and y".to_owned(),
        n => format!("; it folds: {n} of them are mirrored"),
    };
    let (error, skipped) = (slopes.largest, skipped(outside));
    check.detail = format!(
        "{count} points, alone and in batches; derivatives differ from differences by {error:.0e}{skipped}{mirrored}"
    );
    check
}

/// Returns `true` if two values for one point differ by more than rounding.
pub(super) fn differ(a: Point, b: Point) -> bool {
    a.distance(b) > 1e-12 * (1.0 + a.to_vec2().hypot())
}

/// Both partial derivatives at the samples by central differences at two steps, extrapolated: truncation h⁴, rounding ε/h.
fn differences(t: &Tested<'_>) -> Vec<[Vec2; 2]> {
    let h = 1e-6 * t.frame.width().max(t.frame.height());
    let steps = [Vec2::new(h, 0.0), Vec2::new(0.0, h)].map(|d| [d, -d, 0.5 * d, -0.5 * d]);
    let places: Vec<Point> = t.samples.iter().flat_map(|p| steps.as_flattened().iter().map(|d| *p + *d)).collect();
    let slope = |q: &[Point]| (8.0 * (q[2] - q[3]) - (q[0] - q[1])) / (6.0 * h);
    t.values(&places).chunks_exact(8).map(|q| [slope(&q[..4]), slope(&q[4..])]).collect()
}

/// The entries of a Jacobian, by columns.
const ENTRIES: [&str; 4] = ["∂x'/∂x", "∂y'/∂x", "∂x'/∂y", "∂y'/∂y"];

/// The derivatives that a map gives, compared with differences.
#[derive(Default)]
struct Slopes {
    compared: usize,
    /// The largest difference, as a fraction of the slope.
    largest: f64,
    /// For every entry, the number of points where it is wrong, and a description of the first one.
    wrong: [(usize, Option<String>); 4],
    /// The number of points where the derivatives are wrong even when the Jacobian is transposed.
    not_transposed: usize,
    /// The number of points around which all images lie on one curve, or at one point.
    flat: usize,
    /// The number of points around which the map reverses orientation.
    mirrored: usize,
}

impl Slopes {
    /// Compares the derivatives of a jet with differences, within a tolerance relative to the slope.
    fn add(&mut self, p: Point, j: &Jet, [dx, dy]: [Vec2; 2], tolerance: f64) {
        let steep = 1.0 + j.dx.hypot() + j.dy.hypot();
        self.largest = self.largest.max((dx - j.dx).hypot().max((dy - j.dy).hypot()) / steep);
        let is_wrong = |a: f64, b: f64| (a - b).abs() > tolerance * steep || (a - b).is_nan();
        let (given, found) = ([j.dx.x, j.dx.y, j.dy.x, j.dy.y], [dx.x, dx.y, dy.x, dy.y]);
        for (k, (n, first)) in self.wrong.iter_mut().enumerate().filter(|(k, _)| is_wrong(given[*k], found[*k])) {
            *n += 1;
            let (given, found) = (number(given[k]), number(found[k]));
            first.get_or_insert_with(|| format!("{given} at {}, where differences give {found}", coordinates(p)));
        }
        self.not_transposed += usize::from([0, 2, 1, 3].iter().zip(found).any(|(k, v)| is_wrong(given[*k], v)));
        self.compared += 1;
        self.flat += usize::from(dx.cross(dy).abs() <= 1e-7 * dx.hypot() * dy.hypot() + 1e-14);
        self.mirrored += usize::from(dx.cross(dy) < 0.0);
    }

    /// Describes the faults. If the map does not give derivatives itself, they were computed from its values.
    fn faults(&self, gives_derivatives: bool) -> Vec<String> {
        if self.compared > 0 && self.flat == self.compared {
            return vec!["sends all points to one, or to one curve, so artwork has no area after it".to_owned()];
        }
        let worst = self.wrong.iter().map(|(n, _)| *n).max().unwrap_or(0);
        if worst > 0 && !gives_derivatives {
            let why = "its features are so small that derivatives computed from values are wrong";
            return vec![format!("{why} at {worst} of {} places; give derivatives, too", self.compared)];
        }
        if worst > 0 && self.not_transposed == 0 {
            return vec![format!("its derivatives are transposed: {} and {} change places", ENTRIES[1], ENTRIES[2])];
        }
        let entries = self.wrong.iter().zip(ENTRIES);
        let fault = |n: usize, first: &str, entry: &str| {
            format!("{entry} is wrong at {n} of {} places: {first}", self.compared)
        };
        entries.filter_map(|((n, first), entry)| Some(fault(*n, first.as_ref()?, entry))).collect()
    }
}

/// Describes coordinates of images that are rounded although the points have all digits.
fn rounding(t: &Tested<'_>) -> Option<String> {
    // Coordinates that no decimal number of few digits equals.
    let shift = t.frame.size().to_vec2() * (0.01 / PI);
    let points: Vec<Point> = t.samples.iter().map(|p| *p + shift).filter(|p| t.is_in_domain(*p)).collect();
    let images: Vec<Point> = t.values(&points).into_iter().filter(|q| q.is_finite()).collect();
    let [xs, ys]: [Vec<f64>; 2] = [images.iter().map(|q| q.x).collect(), images.iter().map(|q| q.y).collect()];
    let is_varied = |values: &[f64]| values.len() >= 9 && values.iter().any(|v| *v != values[0]);
    [("x'", xs), ("y'", ys)].into_iter().filter(|(_, values)| is_varied(values)).find_map(|(name, values)| {
        if values.iter().all(|v| f64::from(*v as f32) == *v) {
            return Some(format!(
                "{name} has the digits of single precision (float32) only; compute in double precision"
            ));
        }
        let is_whole = |v: f64| (v - v.round()).abs() < 1e-6 * v.abs().min(1.0);
        let digits = (0..=6).find(|d| values.iter().all(|v| is_whole(v * 10_f64.powi(*d))))?;
        Some(format!("{name} is rounded to {digits} decimals; write all digits (%.17g in C and awk, repr in Python)"))
    })
}
