//! Maps whose values come from another program or from a function of another language, many points at a time.

use super::{Batches, Cost, Creases, Images, Jet, Map};
use crate::Error;
use kurbo::{Point, Rect, Vec2};
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// The kind of a question to a [`Callee`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// Values: x' and y' for each point.
    Points,
    /// Values with both partial derivatives: x', y', ∂x'/∂x, ∂y'/∂x, ∂x'/∂y and ∂y'/∂y for each point.
    Jets,
    /// Values of the inverse: x and y for each point.
    Inverse,
}

impl Ask {
    /// Returns the number of numbers in the answer for one point.
    #[must_use]
    pub fn numbers(self) -> usize {
        if self == Self::Jets { 6 } else { 2 }
    }
}

/// A program or function that gives the values of a map.
pub trait Callee: Send + Sync {
    /// Answers for some points, all of them finite: [`Ask::numbers`] numbers for each. Only questions within its [`Abilities`] are asked.
    ///
    /// # Errors
    /// Any [`Error`] by which the callee fails. The map is undefined everywhere from then on, and reports this error.
    fn ask(&self, ask: Ask, points: &[Point]) -> Result<Vec<f64>, Error>;

    /// Answers for the values at `points` and the jets at `jets_at`, neither of them empty.
    ///
    /// # Errors
    /// Any [`Error`] by which the callee fails.
    fn ask_both(&self, points: &[Point], jets_at: &[Point]) -> Result<[Vec<f64>; 2], Error> {
        Ok([self.ask(Ask::Points, points)?, self.ask(Ask::Jets, jets_at)?])
    }

    /// Returns the error for an answer at `at`, within the domain, that is not finite.
    fn not_finite(&self, at: Point) -> Error;

    /// Returns the work of asking for one point, in evaluations of a bicubic net.
    fn work(&self) -> f64 {
        2.0
    }
}

/// The abilities of a [`Callee`], and the known properties of its map.
#[derive(Debug, Clone, Default)]
pub struct Abilities {
    /// `true` if it answers [`Ask::Jets`]. Otherwise derivatives are differences of values.
    pub jacobian: bool,
    /// `true` if it answers [`Ask::Inverse`].
    pub inverse: bool,
    /// `true` if it may answer NaN where its map is undefined.
    pub partial: bool,
    /// The creases of its map.
    pub creases: Creases,
    /// The size of the smallest feature of its map; see [`Map::detail`].
    pub detail: Option<f64>,
}

/// The map of a [`Callee`]. Once the callee has failed, all values are NaN.
#[derive(Clone)]
pub struct Called {
    callee: Arc<dyn Callee>,
    abilities: Abilities,
    /// The frame's diagonal.
    size: f64,
    failed: Arc<OnceLock<Error>>,
}

impl fmt::Debug for Called {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Called")
            .field("abilities", &self.abilities)
            .field("failed", &self.failed)
            .finish_non_exhaustive()
    }
}

impl Called {
    /// Returns the map of a callee for artwork whose box has the diagonal `size`, in user units.
    #[must_use]
    pub fn new(callee: Arc<dyn Callee>, abilities: Abilities, size: f64) -> Self {
        Self { callee, abilities, size: size.max(f64::MIN_POSITIVE), failed: Arc::default() }
    }

    /// Returns the error with which the callee failed; `None` while it has not.
    #[must_use]
    pub fn failure(&self) -> Option<Error> {
        self.failed.get().cloned()
    }

    /// Returns `true` if the map may be undefined at points that no declared crease excludes, which only its values show.
    #[must_use]
    pub fn is_partial(&self) -> bool {
        self.abilities.partial
    }

    /// Returns the callee's answers, or `None` if it has failed.
    fn answers<T>(&self, answers: impl FnOnce(&dyn Callee) -> Result<T, Error>) -> Option<T> {
        if self.failed.get().is_some() {
            return None;
        }
        // The first error is kept.
        answers(self.callee.as_ref()).map_err(|error| self.failed.set(error)).ok()
    }

    /// Writes the answers for the finite points among `ps`. The others stay undefined, as do all points once the callee has failed.
    fn write<const N: usize, T: Clone>(
        &self,
        ask: Ask,
        (ps, out): (&[Point], &mut [T]),
        numbers: &[f64],
        read: impl Fn(&[f64; N]) -> T,
    ) {
        let finite = ps.iter().zip(out).filter(|(p, _)| p.is_finite());
        for ((p, o), answer) in finite.zip(numbers.as_chunks::<N>().0) {
            let must_be_finite =
                ask != Ask::Inverse && !self.abilities.partial && self.abilities.creases.defined_at(*p);
            if must_be_finite && answer.iter().any(|v| !v.is_finite()) {
                let _ = self.failed.set(self.callee.not_finite(*p));
                return;
            }
            *o = read(answer);
        }
    }

    /// Writes the values at `ps` by the answers to `ask`, which are points.
    fn points_by(&self, ask: Ask, ps: &[Point], out: &mut [Point]) {
        out.fill(UNDEFINED);
        let finite = finite(ps);
        if let (false, Some(numbers)) = (finite.is_empty(), self.answers(|callee| callee.ask(ask, &finite))) {
            self.write(ask, (ps, out), &numbers, point);
        }
    }
}

/// Reads a point from two numbers of an answer.
fn point(&[x, y]: &[f64; 2]) -> Point {
    Point::new(x, y)
}

/// Reads a jet from six numbers of an answer: F, ∂F/∂x, ∂F/∂y.
fn jet(&[x, y, xx, xy, yx, yy]: &[f64; 6]) -> Jet {
    Jet { p: Point::new(x, y), dx: Vec2::new(xx, xy), dy: Vec2::new(yx, yy) }
}

const UNDEFINED: Point = Point::new(f64::NAN, f64::NAN);

/// Returns the finite points, the only ones that the callee is asked for.
fn finite(ps: &[Point]) -> Cow<'_, [Point]> {
    if ps.iter().all(|p| p.is_finite()) {
        Cow::Borrowed(ps)
    } else {
        Cow::Owned(ps.iter().copied().filter(|p| p.is_finite()).collect())
    }
}

impl Map for Called {
    single_by_batch!();

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        if self.abilities.jacobian {
            self.points_and_jets((&[], &mut []), (ps, out));
        } else {
            out.copy_from_slice(&jets_by_differences(ps, self.size, |ps, out| self.points(ps, out)));
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.points_by(Ask::Points, ps, out);
    }

    fn cost(&self) -> Cost<'_> {
        Cost::new(self.callee.work()).batched(self)
    }

    fn creases(&self, out: &mut Creases) {
        for crease in self.abilities.creases.items() {
            out.push(crease.clone());
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        (!self.abilities.creases.items().is_empty()).then(|| Arc::new(OneSided { map: self.clone(), inside }) as _)
    }

    fn detail(&self, _area: Rect) -> Option<f64> {
        self.abilities.detail
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        self.abilities.inverse.then(|| Arc::new(Inverse(self.clone())) as Arc<dyn Map>)
    }
}

impl Batches for Called {
    fn points_and_jets(&self, (ps, images): Images<'_, Point>, (qs, jets): Images<'_, Jet>) {
        if !self.abilities.jacobian {
            self.points(ps, images);
            return self.jets(qs, jets);
        }
        images.fill(UNDEFINED);
        jets.fill(Jet::UNDEFINED);
        let (points, jets_at) = (finite(ps), finite(qs));
        let answers = self.answers(|callee| match (points.is_empty(), jets_at.is_empty()) {
            (true, true) => Ok([Vec::new(), Vec::new()]),
            (false, true) => Ok([callee.ask(Ask::Points, &points)?, Vec::new()]),
            (true, false) => Ok([Vec::new(), callee.ask(Ask::Jets, &jets_at)?]),
            (false, false) => callee.ask_both(&points, &jets_at),
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

/// The map on one side of its creases. The callee does not know the side, so points on a crease are moved slightly towards `inside`, and
/// differences beside one are one-sided.
struct OneSided {
    map: Called,
    inside: Point,
}

impl OneSided {
    /// The level, taken for a distance, at which rounding may put a point on either side of a crease, as a share of the frame's diagonal.
    const NEAR: f64 = 1e-11;

    /// Moves a point on a crease slightly towards `inside`.
    fn off_creases(&self, p: Point) -> Point {
        let is_near =
            self.map.abilities.creases.items().iter().any(|c| c.level.at(p).abs() <= Self::NEAR * self.map.size);
        if is_near { p + (self.inside - p).normalize() * (4.0 * Self::NEAR * self.map.size) } else { p }
    }

    /// Returns `true` if `p` is on the side of `inside` of every crease.
    fn is_on_side(&self, p: Point) -> bool {
        self.map.abilities.creases.items().iter().all(|c| c.level.at(p) * c.level.at(self.inside) > 0.0)
    }

    /// Returns two directions from `p` in which one-sided differences cross no crease; `None` if central ones cross none, or all cross one.
    fn directions(&self, p: Point) -> Option<[Vec2; 2]> {
        let crosses_none = |d: &Vec2, share: f64| self.is_on_side(p + *d * (share * self.map.size));
        let around = (0..16).map(|k| Vec2::from_angle(f64::from(k) * (TAU / 16.0)));
        if around.clone().all(|d| crosses_none(&d, STEPS[0])) {
            return None;
        }
        let mut candidates: Vec<Vec2> = around.filter(|d| crosses_none(d, 4.0 * ONE_SIDED_STEP)).collect();
        let first = candidates.pop()?;
        candidates.into_iter().max_by(|a, b| a.cross(first).abs().total_cmp(&b.cross(first).abs())).map(|d| [first, d])
    }

    /// Returns the jet at `p` by one-sided differences of fourth order along two directions.
    fn one_sided(&self, p: Point, directions: [Vec2; 2]) -> Jet {
        const WEIGHTS: [f64; 5] = [-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25];
        let h = ONE_SIDED_STEP * self.map.size;
        let asked: Vec<Point> =
            directions.iter().flat_map(|d| (0..5).map(move |k| p + *d * (f64::from(k) * h))).collect();
        let mut images = vec![UNDEFINED; asked.len()];
        self.map.points(&asked, &mut images);
        let slope = |images: &[Point]| {
            images.iter().zip(WEIGHTS).fold(Vec2::ZERO, |sum, (image, w)| sum + (*image - images[0]) * w) / h
        };
        let ([a, b], [along_a, along_b]) = (directions, [slope(&images[..5]), slope(&images[5..])]);
        let det = a.cross(b);
        Jet { p: images[0], dx: (along_a * b.y - along_b * a.y) / det, dy: (along_b * a.x - along_a * b.x) / det }
    }
}

impl Map for OneSided {
    single_by_batch!();

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        let ps: Vec<Point> = ps.iter().map(|p| self.off_creases(*p)).collect();
        self.map.jets(&ps, out);
        if self.map.abilities.jacobian {
            return;
        }
        for (p, out) in ps.iter().zip(out) {
            if let Some(directions) = self.directions(*p) {
                *out = self.one_sided(*p, directions);
            }
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.map.points(&ps.iter().map(|p| self.off_creases(*p)).collect::<Vec<_>>(), out);
    }

    fn cost(&self) -> Cost<'_> {
        self.map.cost().batched(self)
    }

    fn detail(&self, area: Rect) -> Option<f64> {
        self.map.detail(area)
    }
}

impl Batches for OneSided {}

/// The inverse by the callee's answers. Its derivatives are the inverted Jacobians of the map.
struct Inverse(Called);

impl Map for Inverse {
    single_by_batch!();

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

/// The step of one-sided differences beside a crease, as a fraction of the frame's diagonal.
const ONE_SIDED_STEP: f64 = 2e-4;

/// An estimate of the relative error that is good enough. Where the third derivative happens to be small, the error is a few tens of
/// times the estimate; tangents need half as many digits.
const GOOD: f64 = 3e-11;

/// A point's four neighbours at the whole step, then at half of it.
const STENCIL: [(f64, f64); 8] =
    [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)];

/// Computes the jets at `ps` by differences of `values`, which evaluates many points at once. `size` is the frame's diagonal.
fn jets_by_differences(ps: &[Point], size: f64, values: impl Fn(&[Point], &mut [Point])) -> Vec<Jet> {
    let mut out: Vec<Jet> = vec![Jet::UNDEFINED; ps.len()];
    let mut errors = vec![f64::INFINITY; ps.len()];
    let mut pending: Vec<usize> = (0..ps.len()).collect();
    for (round, share) in STEPS.into_iter().enumerate() {
        if pending.is_empty() {
            break;
        }
        let mut asked = Vec::with_capacity(9 * pending.len());
        for p in pending.iter().filter_map(|i| ps.get(*i)) {
            let h = step(*p, share * size);
            if round == 0 {
                asked.push(*p);
            }
            asked.extend(STENCIL.iter().map(|(x, y)| *p + Vec2::new(x * h, y * h)));
        }
        let mut images = vec![Point::ORIGIN; asked.len()];
        values(&asked, &mut images);
        let per_point = STENCIL.len() + usize::from(round == 0);
        let mut again = Vec::new();
        for ((i, stencil), images) in
            pending.iter().zip(asked.chunks_exact(per_point)).zip(images.chunks_exact(per_point))
        {
            let (Some(jet), Some(least)) = (out.get_mut(*i), errors.get_mut(*i)) else { continue };
            let (mut stencil, mut images) = (stencil, images);
            if round == 0 {
                jet.p = images[0];
                (stencil, images) = (&stencil[1..], &images[1..]);
            }
            let ((dx, x_error), (dy, y_error)) = (slope(stencil, images, 0), slope(stencil, images, 2));
            let rounding = f64::EPSILON * jet.p.to_vec2().hypot() / (0.5 * (stencil[0] - stencil[1]).hypot());
            let (scale, error) = (dx.hypot().max(dy.hypot()), x_error.max(y_error) + rounding);
            if error < *least || !least.is_finite() {
                (jet.dx, jet.dy, *least) = (dx, dy, error);
            }
            // At the edge of a domain, an estimate of NaN may become finite with a smaller step.
            if error.is_nan() || error > GOOD * scale.max(f64::MIN_POSITIVE) {
                again.push(*i);
            }
        }
        pending = again;
    }
    out
}

/// A power of two near `h`, so that p ± h is exact more often; larger if the coordinates are large.
fn step(p: Point, h: f64) -> f64 {
    /// The smallest step as a fraction of the coordinates, which have 53 bits.
    const MIN_STEP: f64 = 1e-8;
    let min = MIN_STEP * p.x.abs().max(p.y.abs());
    h.max(min).max(f64::MIN_POSITIVE).log2().round().exp2()
}

/// The slope along the axis of the stencil's points `k` and `k` + 4, extrapolated from both steps, with an estimate of its error.
fn slope(stencil: &[Point], images: &[Point], k: usize) -> (Vec2, f64) {
    let central = |k: usize| (images[k] - images[k + 1]) / (stencil[k] - stencil[k + 1]).hypot();
    let (whole, half) = (central(k), central(k + 4));
    let correction = (half - whole) / 3.0;
    // The error is of fourth order after a correction of second order: about the square of the relative correction.
    let size = half.hypot().max(f64::MIN_POSITIVE);
    (half + correction, correction.hypot() * (correction.hypot() / size).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Crease, CreaseKind, Level};

    /// Waves from a tenth of the frame to a thousandth: derivatives are exact to the digits that the steps allow.
    #[test]
    fn the_error_is_under_control() {
        for (length, most) in [(300.0, 1e-10), (10.0, 1e-9), (1.0, 1e-7), (0.1, 1e-6)] {
            let k = TAU / length;
            let f = |p: Point| Point::new(p.x + (k * p.y).sin() / k, p.y * 2.0 + 0.5 * (k * p.x).cos() / k);
            let ps: Vec<Point> = (0..50).map(|i| Point::new(3.7 * f64::from(i), 90.0 - 1.9 * f64::from(i))).collect();
            let found = jets_by_differences(&ps, 100.0, |ps, out| {
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

    /// A map that is folded along x = 50: the derivatives beside and on the fold belong to the side of `inside`.
    #[test]
    fn differences_cross_no_crease() {
        struct Fold;
        impl Callee for Fold {
            fn ask(&self, _: Ask, points: &[Point]) -> Result<Vec<f64>, Error> {
                let wave =
                    |p: &Point| [p.x + 3.0 * (p.y / 9.0).sin(), p.y + 0.5 * (p.x - 50.0).abs() + (p.x / 20.0).cos()];
                Ok(points.iter().flat_map(wave).collect())
            }

            fn not_finite(&self, _: Point) -> Error {
                Error::input("fold", "not finite")
            }
        }
        let mut creases = Creases::default();
        creases.push(Crease { level: Level::Line { a: 2.0, b: 0.0, c: -100.0 }, kind: CreaseKind::Kink });
        let map = Called::new(Arc::new(Fold), Abilities { creases, ..Abilities::default() }, 140.0);
        for (inside, side) in [(Point::new(10.0, 7.0), -1.0), (Point::new(90.0, 7.0), 1.0)] {
            let branch = map.branch(inside).unwrap();
            for distance in [0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.13, 0.15, 5.0] {
                let p = Point::new(50.0 + side * distance, 33.0);
                let jet = branch.jet(p);
                let dx = Vec2::new(1.0, 0.5 * side - (p.x / 20.0).sin() / 20.0);
                let off = (jet.dx - dx).hypot().max((jet.dy - Vec2::new((p.y / 9.0).cos() / 3.0, 1.0)).hypot());
                assert!(off < 1e-9, "{off:e} at {p}");
            }
        }
    }

    #[test]
    fn outside_of_the_domain_the_jet_is_undefined() {
        let found =
            jets_by_differences(&[Point::new(1.0, 1.0)], 1.0, |_, out| out.fill(Point::new(f64::NAN, f64::NAN)));
        assert!(found[0].p.is_nan() && found[0].dx.is_nan());
    }
}
