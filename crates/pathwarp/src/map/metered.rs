//! An inverse that counts its searches in a budget.

use super::batch::Lane;
use super::{Class, Crease, Creases, Jet, Level, Map, RationalBezier, RationalDegree};
use crate::budget::Budget;
use crate::meter::Meter;
use kurbo::Point;
use std::sync::Arc;

/// Points passed to the map at a time, so that it ends soon after the limit.
const BATCH: usize = 16;

/// The same map, which counts what its searches take beyond [`Map::work`] and, once that is too much, is undefined everywhere. A map that
/// never exceeds the work foreseen stays as it is.
pub(crate) fn metered(map: Arc<dyn Map>, meter: &Arc<Meter>) -> Arc<dyn Map> {
    let counts = meter.counts() && map.take_overrun().is_some();
    if counts { Arc::new(Metered { map: Held::Shared(map), meter: Arc::clone(meter) }) } else { map }
}

/// The function of a level.
type Field = Arc<dyn Fn(Point) -> f64 + Send + Sync>;

/// An inverse with a meter. Its values are those of the map behind it.
pub(crate) struct Metered<'a> {
    map: Held<'a>,
    meter: Arc<Meter>,
}

enum Held<'a> {
    Shared(Arc<dyn Map>),
    Borrowed(&'a dyn Map),
}

impl<'a> Metered<'a> {
    /// As [`metered`], for a map that lives elsewhere. `None` for a map that never exceeds the work foreseen.
    pub(crate) fn borrowed(map: &'a dyn Map, budget: &Arc<Budget>) -> Option<Self> {
        map.take_overrun()?;
        Some(Self { map: Held::Borrowed(map), meter: Meter::new(Arc::clone(budget)) })
    }

    fn map(&self) -> &dyn Map {
        match &self.map {
            Held::Shared(map) => &**map,
            Held::Borrowed(map) => *map,
        }
    }

    /// What `f` makes of the map, or `over` once the limit is exceeded.
    fn counted<T>(&self, over: T, f: impl FnOnce(&dyn Map) -> T) -> T {
        if self.meter.is_over() {
            return over;
        }
        let out = f(self.map());
        self.meter.count(self.map().take_overrun());
        out
    }

    /// The level of a crease, which asks the map. It is far from zero once the limit is exceeded.
    fn metered_field(&self, field: &Field) -> Level {
        const FAR: f64 = 1.0;
        let (field, meter) = (Arc::clone(field), Arc::clone(&self.meter));
        match &self.map {
            Held::Shared(map) => {
                let own = Metered { map: Held::Shared(Arc::clone(map)), meter };
                Level::Field(Arc::new(move |p| own.counted(FAR, |_| field(p))))
            }
            // The next call of the map counts these searches.
            Held::Borrowed(_) => Level::Field(Arc::new(move |p| if meter.is_over() { FAR } else { field(p) })),
        }
    }

    /// The number of points that are passed at a time.
    fn batch(&self) -> usize {
        if self.map().prefers_batches() { usize::MAX } else { BATCH }
    }
}

impl Map for Metered<'_> {
    fn jet(&self, p: Point) -> Jet {
        self.counted(Jet::UNDEFINED, |m| m.jet(p))
    }

    fn point(&self, p: Point) -> Point {
        self.counted(Jet::UNDEFINED.p, |m| m.point(p))
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        out.fill(Jet::UNDEFINED);
        for (ps, out) in ps.chunks(self.batch()).zip(out.chunks_mut(self.batch())) {
            self.counted((), |m| m.jets(ps, out));
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        out.fill(Jet::UNDEFINED.p);
        for (ps, out) in ps.chunks(self.batch()).zip(out.chunks_mut(self.batch())) {
            self.counted((), |m| m.points(ps, out));
        }
    }

    fn class(&self) -> Class {
        self.map().class()
    }

    /// The map's creases. Most levels ask the map, as often as a path is searched for crossings.
    fn creases(&self, out: &mut Creases) {
        let mut own = Creases::default();
        self.map().creases(&mut own);
        for Crease { level, kind } in own.items() {
            let level = match level {
                Level::Field(field) => self.metered_field(field),
                other => other.clone(),
            };
            out.push(Crease { level, kind: *kind });
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        self.counted(None, |m| m.branch(inside)).map(|b| metered(b, &self.meter))
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        self.map().image(curve)
    }

    fn rational_degree(&self) -> Option<RationalDegree> {
        self.map().rational_degree()
    }

    fn denominator(&self, p: Point) -> f64 {
        self.map().denominator(p)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        self.map().inverse()
    }

    fn work(&self) -> f64 {
        self.map().work()
    }

    fn prefers_batches(&self) -> bool {
        self.map().prefers_batches()
    }

    fn differentiates(&self) -> bool {
        self.map().differentiates()
    }

    fn remembers(&self) -> bool {
        self.map().remembers()
    }

    fn prepare(&self, points: &[Point], jets: &[Point]) {
        self.counted((), |m| m.prepare(points, jets));
    }

    fn points_and_jets(&self, (ps, images): (&[Point], &mut [Point]), (qs, jets): (&[Point], &mut [Jet])) {
        if self.meter.is_over() {
            images.fill(Jet::UNDEFINED.p);
            jets.fill(Jet::UNDEFINED);
            return;
        }
        self.counted((), |m| m.points_and_jets((ps, images), (qs, jets)));
    }

    fn lanes(&self, x: &mut Lane, y: &mut Lane) {
        if self.meter.is_over() {
            x.fill(f64::NAN);
            y.fill(f64::NAN);
            return;
        }
        self.counted((), |m| m.lanes(x, y));
    }

    fn denominators(&self, x: &Lane, y: &Lane) -> Lane {
        self.map().denominators(x, y)
    }
}
