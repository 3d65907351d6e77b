//! The map of a program.

use crate::answer::{Ask, jet};
use crate::differences;
use crate::fault::Fault;
use crate::instance::Instance;
use crate::pool::Program;
use pathwarp::kurbo::{Point, Vec2};
use pathwarp::map::{Creases, Jet, Map};
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
    /// The numbers that the program answers for `ps`, of which all are finite. `None` if it has failed.
    fn ask(&self, ask: Ask, ps: &[Point]) -> Option<Vec<f64>> {
        if self.failed.get().is_some() {
            return None;
        }
        match self.program.ask(&self.instance, ask, ps) {
            Ok(numbers) => Some(numbers),
            Err(fault) => {
                // Of several threads, the first one tells.
                let _ = self.failed.set(fault);
                None
            }
        }
    }

    /// Asks for the points of `ps` that are finite, and gives each answer to `take` with its index.
    fn answers(&self, ask: Ask, ps: &[Point], mut take: impl FnMut(usize, &[f64])) {
        let finite: Vec<usize> = (0..ps.len()).filter(|i| ps[*i].is_finite()).collect();
        if finite.is_empty() {
            return;
        }
        let numbers = if finite.len() == ps.len() {
            self.ask(ask, ps)
        } else {
            self.ask(ask, &finite.iter().map(|i| ps[*i]).collect::<Vec<_>>())
        };
        let Some(numbers) = numbers else { return };
        for (i, answer) in finite.iter().zip(numbers.chunks_exact(ask.numbers())) {
            let p = ps[*i];
            let defined = ask != Ask::Inverse && !self.abilities.partial && self.creases.defined_at(p);
            if defined && answer.iter().any(|v| !v.is_finite()) {
                let _ = self.failed.set(Fault::NotFinite(p.x, p.y));
                return;
            }
            take(*i, answer);
        }
    }

    fn points_by(&self, ask: Ask, ps: &[Point], out: &mut [Point]) {
        out.fill(Point::new(f64::NAN, f64::NAN));
        self.answers(ask, ps, |i, answer| {
            if let (Some(o), &[x, y]) = (out.get_mut(i), answer) {
                *o = Point::new(x, y);
            }
        });
    }

    /// The same map, as it is on the side of `inside` of every crease.
    fn beside(&self, inside: Point) -> Beside {
        Beside { map: self.clone(), inside }
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
            out.fill(Jet::UNDEFINED);
            self.answers(Ask::Jets, ps, |i, answer| {
                if let (Some(o), Some(jet)) = (out.get_mut(i), jet(answer)) {
                    *o = jet;
                }
            });
        } else {
            out.copy_from_slice(&differences::jets(ps, self.size, |ps, out| self.points(ps, out)));
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.points_by(Ask::Points, ps, out);
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

    fn prefers_batches(&self) -> bool {
        true
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

    fn prefers_batches(&self) -> bool {
        true
    }
}

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

    fn prefers_batches(&self) -> bool {
        true
    }
}
