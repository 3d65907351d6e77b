//! A map that its tangents continue beyond a box where it folds or is not defined.

use kurbo::{Point, Rect};
use pathwarp::engine::{Batches, Cost};
use pathwarp::map::{Creases, Jet, Map};

/// The corners of a box divided into cells, of which `cells` lie along each side.
pub(crate) fn lattice(r: Rect, cells: usize) -> impl Iterator<Item = Point> {
    let share = move |k: usize| k as f64 / cells as f64;
    let shares = (0..=cells).flat_map(move |j| (0..=cells).map(move |i| (share(i), share(j))));
    shares.map(move |(u, v)| Point::new(r.x0 + u * r.width(), r.y0 + v * r.height()))
}

/// A map, continued beyond a box by its tangents if it folds there or is not defined.
///
/// Deformations are made for the box of the artwork; its shadows lie around it.
#[derive(Debug)]
pub struct Continued<'a> {
    map: &'a dyn Map,
    /// The box beyond which tangents continue the map; `None` if the map itself does.
    inner: Option<Rect>,
}

impl<'a> Continued<'a> {
    /// Continues `map` from `inner` to `outer` if necessary.
    #[must_use]
    pub fn new(map: &'a dyn Map, inner: Rect, outer: Rect) -> Self {
        /// Cells along a side of `outer`, at whose corners the map is sampled.
        const CELLS: usize = 24;
        let samples: Vec<Point> = lattice(outer, CELLS).chain([inner.center()]).collect();
        let mut jets = vec![Jet::default(); samples.len()];
        map.jets(&samples, &mut jets);
        let mut creases = Creases::default();
        map.creases(&mut creases);
        let sign = jets.last().map_or(0.0, |jet| jet.det().signum());
        let is_sound = |(p, jet): (&Point, &Jet)| jet.det() * sign > 0.0 && creases.defined_at(*p);
        let is_sound_everywhere = samples.iter().zip(&jets).all(is_sound);
        Self { map, inner: (!is_sound_everywhere).then_some(inner) }
    }

    /// The nearest point of the inner box.
    fn nearest_inner(&self, p: Point) -> Point {
        self.inner.map_or(p, |r| Point::new(p.x.clamp(r.x0, r.x1), p.y.clamp(r.y0, r.y1)))
    }
}

impl Map for Continued<'_> {
    fn jet(&self, p: Point) -> Jet {
        let inner = self.nearest_inner(p);
        let jet = self.map.jet(inner);
        Jet { p: jet.p + jet.push(p - inner), ..jet }
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        let inner: Vec<Point> = ps.iter().map(|p| self.nearest_inner(*p)).collect();
        self.map.jets(&inner, out);
        for ((p, inner), jet) in ps.iter().zip(&inner).zip(out) {
            jet.p += jet.push(*p - *inner);
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        if self.inner.is_none() {
            return self.map.points(ps, out);
        }
        let mut jets = vec![Jet::default(); ps.len()];
        self.jets(ps, &mut jets);
        out.iter_mut().zip(jets).for_each(|(o, jet)| *o = jet.p);
    }

    fn creases(&self, out: &mut Creases) {
        if self.inner.is_none() {
            self.map.creases(out);
        }
    }

    fn cost(&self) -> Cost<'_> {
        let cost = Cost::new(self.map.work());
        if self.map.prefers_batches() { cost.batched(self) } else { cost }
    }
}

impl Batches for Continued<'_> {}
