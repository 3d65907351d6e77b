//! The map of a program.

use crate::answer::{Ask, jet, point};
use crate::differences;
use crate::fault::Fault;
use crate::instance::Instance;
use crate::pool::Program;
use pathwarp::kurbo::{Point, Vec2};
use pathwarp::map::Cost;
use pathwarp::map::{Batches, Creases, Images, Jet, Map};
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

/// What a program can answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Abilities {
    pub(crate) jacobian: bool,
    pub(crate) inverse: bool,
    /// It may answer NaN, where its map is undefined.
    pub(crate) partial: bool,
}

/// A map that a program has built. Once the program has failed, all values are NaN.
#[derive(Clone)]
pub(crate) struct ProgramMap {
    pub(crate) program: Arc<Program>,
    pub(crate) instance: Arc<Instance>,
    pub(crate) abilities: Abilities,
    pub(crate) creases: Creases,
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
        // Of several threads, the first one tells.
        answers(&self.program).map_err(|fault| self.failed.set(fault)).ok()
    }

    /// Writes the answers for those of `ps` that are finite. All others are undefined, and so are all once the program has failed.
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

    /// The same map, as it is on the side of `inside` of every crease.
    fn beside(&self, inside: Point) -> Beside {
        Beside { map: self.clone(), inside }
    }
}

const UNDEFINED: Point = Point::new(f64::NAN, f64::NAN);

/// The points that are finite: others are not asked for.
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
            out.copy_from_slice(&differences::jets(ps, self.size, |ps, out| self.points(ps, out)));
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

/// The map on one side of its creases. The program does not know the side, so points on a crease are moved towards `inside` a little.
struct Beside {
    map: ProgramMap,
    inside: Point,
}

impl Beside {
    /// Share of the way by which a point is moved: well above rounding and invisibly small.
    const AWAY: f64 = 1e-9;

    /// Points nearer to a crease than this share of the frame may be on either side of it by rounding.
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
            let (dx, dy, det) = (o.dx, o.dy, o.det());
            *o = Jet { p: source, dx: Vec2::new(dy.y, -dx.y) / det, dy: Vec2::new(-dy.x, dx.x) / det };
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
