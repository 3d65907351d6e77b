//! A map whose values come from a program.

use crate::answer::{Ask, jet, point};
use crate::fault::Fault;
use crate::session::{Instance, Program};
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::map::{Batches, Cost, Creases, Images, Jet, Map};
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

/// What a program can answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Abilities {
    pub(crate) jacobian: bool,
    pub(crate) inverse: bool,
    /// Whether it may answer NaN where its map is undefined.
    pub(crate) partial: bool,
}

/// A map that a program has built. Once the program has failed, all values are NaN.
#[derive(Clone)]
pub(crate) struct ProgramMap {
    pub(crate) program: Arc<Program>,
    pub(crate) instance: Arc<Instance>,
    pub(crate) abilities: Abilities,
    pub(crate) creases: Creases,
    pub(crate) detail: Option<f64>,
    /// The frame's diagonal.
    pub(crate) size: f64,
    pub(crate) failed: Arc<OnceLock<Fault>>,
}

impl ProgramMap {
    /// The program's answers, or `None` if it has failed.
    fn answers<T>(&self, answers: impl FnOnce(&Program) -> Result<T, Fault>) -> Option<T> {
        if self.failed.get().is_some() {
            return None;
        }
        // The first error wins.
        answers(&self.program).map_err(|fault| self.failed.set(fault)).ok()
    }

    /// Writes the answers for the finite points among `ps`. The others stay undefined, as do all once the program has failed.
    fn write<const N: usize, T: Clone>(
        &self,
        ask: Ask,
        (ps, out): (&[Point], &mut [T]),
        numbers: &[f64],
        read: impl Fn(&[f64; N]) -> T,
    ) {
        let places = ps.iter().zip(out).filter(|(p, _)| p.is_finite());
        for ((p, o), answer) in places.zip(numbers.as_chunks::<N>().0) {
            let defined = ask != Ask::Inverse && !self.abilities.partial && self.creases.defined_at(*p);
            if defined && answer.iter().any(|v| !v.is_finite()) {
                let _ = self.failed.set(Fault::NotFinite(p.x, p.y));
                return;
            }
            *o = read(answer);
        }
    }

    fn points_by(&self, ask: Ask, ps: &[Point], out: &mut [Point]) {
        out.fill(UNDEFINED);
        let finite = finite(ps);
        if let (false, Some(numbers)) =
            (finite.is_empty(), self.answers(|program| program.ask(&self.instance, ask, &finite)))
        {
            self.write(ask, (ps, out), &numbers, point);
        }
    }

    /// The map as it is on the side of `inside` of every crease.
    fn beside(&self, inside: Point) -> Beside {
        Beside { map: self.clone(), inside }
    }
}

const UNDEFINED: Point = Point::new(f64::NAN, f64::NAN);

/// The finite points. The program is not asked for others.
fn finite(ps: &[Point]) -> Cow<'_, [Point]> {
    if ps.iter().all(|p| p.is_finite()) {
        Cow::Borrowed(ps)
    } else {
        Cow::Owned(ps.iter().copied().filter(|p| p.is_finite()).collect())
    }
}

impl Map for ProgramMap {
    fn jet(&self, p: Point) -> Jet {
        let mut out = [Jet::UNDEFINED];
        self.jets(&[p], &mut out);
        out[0]
    }

    fn point(&self, p: Point) -> Point {
        let mut out = [p];
        self.points(&[p], &mut out);
        out[0]
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        if self.abilities.jacobian {
            self.points_and_jets((&[], &mut []), (ps, out));
        } else {
            out.copy_from_slice(&differences(ps, self.size, |ps, out| self.points(ps, out)));
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.points_by(Ask::Points, ps, out);
    }

    fn cost(&self) -> Cost<'_> {
        Cost::new(self.program.work()).batched(self)
    }

    fn creases(&self, out: &mut Creases) {
        for crease in self.creases.items() {
            out.push(crease.clone());
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        (!self.creases.items().is_empty()).then(|| Arc::new(self.beside(inside)) as Arc<dyn Map>)
    }

    fn detail(&self, _area: Rect) -> Option<f64> {
        self.detail
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        self.abilities.inverse.then(|| Arc::new(Inverse(self.clone())) as Arc<dyn Map>)
    }
}

impl Batches for ProgramMap {
    fn points_and_jets(&self, (ps, images): Images<'_, Point>, (qs, jets): Images<'_, Jet>) {
        if !self.abilities.jacobian {
            self.points(ps, images);
            return self.jets(qs, jets);
        }
        images.fill(UNDEFINED);
        jets.fill(Jet::UNDEFINED);
        let (points, others) = (finite(ps), finite(qs));
        let answers = self.answers(|program| match (points.is_empty(), others.is_empty()) {
            (true, true) => Ok([Vec::new(), Vec::new()]),
            (false, true) => Ok([program.ask(&self.instance, Ask::Points, &points)?, Vec::new()]),
            (true, false) => Ok([Vec::new(), program.ask(&self.instance, Ask::Jets, &others)?]),
            (false, false) => program.ask_both(&self.instance, [&points, &others]),
        });
        if let Some([values, derivatives]) = answers {
            self.write(Ask::Points, (ps, images), &values, point);
            self.write(Ask::Jets, (qs, jets), &derivatives, jet);
        }
    }

    fn differentiates(&self) -> bool {
        !self.abilities.jacobian
    }
}

/// The map on one side of its creases. The program does not know the side, so points on a crease are moved slightly towards `inside`.
struct Beside {
    map: ProgramMap,
    inside: Point,
}

impl Beside {
    /// Fraction of the way by which a point is moved, well above rounding and invisibly small.
    const AWAY: f64 = 1e-9;

    /// Distance within which rounding may put a point on either side of a crease, as a fraction of the frame.
    const NEAR: f64 = 1e-11;

    fn moved(&self, p: Point) -> Point {
        let near = self.map.creases.items().iter().any(|c| c.level.at(p).abs() <= Self::NEAR * self.map.size);
        if near { p.lerp(self.inside, Self::AWAY) } else { p }
    }
}

impl Map for Beside {
    fn jet(&self, p: Point) -> Jet {
        self.map.jet(self.moved(p))
    }

    fn point(&self, p: Point) -> Point {
        self.map.point(self.moved(p))
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        self.map.jets(&ps.iter().map(|p| self.moved(*p)).collect::<Vec<_>>(), out);
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.map.points(&ps.iter().map(|p| self.moved(*p)).collect::<Vec<_>>(), out);
    }

    fn cost(&self) -> Cost<'_> {
        self.map.cost().batched(self)
    }

    fn detail(&self, area: Rect) -> Option<f64> {
        self.map.detail(area)
    }
}

impl Batches for Beside {}

/// The inverse that a program gives. Its derivatives are those of the map, inverted.
struct Inverse(ProgramMap);

impl Map for Inverse {
    fn jet(&self, p: Point) -> Jet {
        let mut out = [Jet::UNDEFINED];
        self.jets(&[p], &mut out);
        out[0]
    }

    fn point(&self, p: Point) -> Point {
        let mut out = [p];
        self.points(&[p], &mut out);
        out[0]
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        let mut sources = vec![Point::ORIGIN; ps.len()];
        self.points(ps, &mut sources);
        self.0.jets(&sources, out);
        for (o, source) in out.iter_mut().zip(sources) {
            *o = o.inverted(source);
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.0.points_by(Ask::Inverse, ps, out);
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.0.clone()))
    }

    fn cost(&self) -> Cost<'_> {
        Cost::NET.batched(self)
    }
}

impl Batches for Inverse {}

/// Steps for differences, as fractions of the frame's diagonal. The first is best for maps that bend a few times across the frame, for
/// which truncation and rounding each contribute an error of 10⁻¹². The others are for waves of a hundredth and a thousandth of the frame.
const STEPS: [f64; 3] = [1e-3, 1e-4, 1e-5];

/// Estimate of the relative error that is good enough. Where the third derivative happens to be small, the error is a few tens of
/// times the estimate; tangents need half as many digits.
const GOOD: f64 = 3e-11;

/// A point's four neighbours at the whole step, then at half of it.
const STENCIL: [(f64, f64); 8] =
    [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)];

/// Computes the jets at `ps` by differences of `values`, which evaluates many points at once. `size` is the frame's diagonal.
fn differences(ps: &[Point], size: f64, values: impl Fn(&[Point], &mut [Point])) -> Vec<Jet> {
    let mut out: Vec<Jet> = vec![Jet::UNDEFINED; ps.len()];
    let mut least = vec![f64::INFINITY; ps.len()];
    let mut left: Vec<usize> = (0..ps.len()).collect();
    for (round, share) in STEPS.into_iter().enumerate() {
        if left.is_empty() {
            break;
        }
        let mut asked = Vec::with_capacity(9 * left.len());
        for p in left.iter().filter_map(|i| ps.get(*i)) {
            let h = step(*p, share * size);
            if round == 0 {
                asked.push(*p);
            }
            asked.extend(STENCIL.iter().map(|(x, y)| *p + Vec2::new(x * h, y * h)));
        }
        let mut images = vec![Point::ORIGIN; asked.len()];
        values(&asked, &mut images);
        let each = STENCIL.len() + usize::from(round == 0);
        let mut again = Vec::new();
        for ((i, places), images) in left.iter().zip(asked.chunks_exact(each)).zip(images.chunks_exact(each)) {
            let (Some(jet), Some(least)) = (out.get_mut(*i), least.get_mut(*i)) else { continue };
            let (mut places, mut images) = (places, images);
            if round == 0 {
                jet.p = images[0];
                (places, images) = (&places[1..], &images[1..]);
            }
            let ((dx, x_off), (dy, y_off)) = (slope(places, images, 0), slope(places, images, 2));
            let rounding = f64::EPSILON * jet.p.to_vec2().hypot() / (0.5 * (places[0] - places[1]).hypot());
            let (scale, off) = (dx.hypot().max(dy.hypot()), x_off.max(y_off) + rounding);
            if off < *least || !least.is_finite() {
                (jet.dx, jet.dy, *least) = (dx, dy, off);
            }
            // At the edge of a domain, an estimate of NaN may become finite with a smaller step.
            if off.is_nan() || off > GOOD * scale.max(f64::MIN_POSITIVE) {
                again.push(*i);
            }
        }
        left = again;
    }
    out
}

/// A power of two near `h`, so that p ± h is exact more often; larger if the coordinates are large.
fn step(p: Point, h: f64) -> f64 {
    /// Smallest step as a fraction of the coordinates, which have 53 bits.
    const MIN_STEP: f64 = 1e-8;
    let min = MIN_STEP * p.x.abs().max(p.y.abs());
    h.max(min).max(f64::MIN_POSITIVE).log2().round().exp2()
}

/// The extrapolated slope along the axis of the stencil's points `k` and `k` + 4, with an estimate of its error.
fn slope(places: &[Point], images: &[Point], k: usize) -> (Vec2, f64) {
    let central = |k: usize| (images[k] - images[k + 1]) / (places[k] - places[k + 1]).hypot();
    let (whole, half) = (central(k), central(k + 4));
    let correction = (half - whole) / 3.0;
    // The error is of fourth order after a correction of second order: about the square of the relative correction.
    let size = half.hypot().max(f64::MIN_POSITIVE);
    let off = correction.hypot() * (correction.hypot() / size).min(1.0);
    (half + correction, off)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waves from a tenth of the frame to a thousandth: exact to the digits that their steps can have.
    #[test]
    fn the_error_is_under_control() {
        for (length, most) in [(300.0, 1e-10), (10.0, 1e-9), (1.0, 1e-7), (0.1, 1e-6)] {
            let k = std::f64::consts::TAU / length;
            let f = |p: Point| Point::new(p.x + (k * p.y).sin() / k, p.y * 2.0 + 0.5 * (k * p.x).cos() / k);
            let ps: Vec<Point> = (0..50).map(|i| Point::new(3.7 * f64::from(i), 90.0 - 1.9 * f64::from(i))).collect();
            let found = differences(&ps, 100.0, |ps, out| {
                for (p, o) in ps.iter().zip(out) {
                    *o = f(*p);
                }
            });
            for (p, j) in ps.iter().zip(&found) {
                assert_eq!(j.p, f(*p));
                let (dx, dy) = (Vec2::new(1.0, -0.5 * (k * p.x).sin()), Vec2::new((k * p.y).cos(), 2.0));
                let off = (j.dx - dx).hypot().max((j.dy - dy).hypot());
                assert!(off < most, "{length}: {off:e} at {p}");
            }
        }
    }

    #[test]
    fn outside_of_the_domain_the_jet_is_undefined() {
        let found = differences(&[Point::new(1.0, 1.0)], 1.0, |_, out| out.fill(Point::new(f64::NAN, f64::NAN)));
        assert!(found[0].p.is_nan() && found[0].dx.is_nan());
    }
}
