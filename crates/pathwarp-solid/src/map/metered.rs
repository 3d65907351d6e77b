//! An inverse that counts its searches in a budget.

use super::collineation::Collineation;
use super::crease::{Crease3, Creases3};
use super::jet::Jet3;
use super::poly::Fraction3;
use super::traits::Map3;
use crate::box3::Box3;
use glam::DVec3;
use pathwarp::meter::Meter;
use std::sync::Arc;

/// Points passed to the map at a time, so that it ends soon after the limit.
const BATCH: usize = 16;

/// The same map, which counts what its searches take beyond [`Map3::work`] and, once that is too much, is undefined everywhere. A map
/// that never exceeds the work foreseen stays as it is.
pub(crate) fn metered(map: Arc<dyn Map3>, meter: &Arc<Meter>) -> Arc<dyn Map3> {
    let counts = meter.counts() && map.take_overrun().is_some();
    if counts { Arc::new(Metered { map, meter: Arc::clone(meter) }) } else { map }
}

/// An inverse with a meter. Its values are those of the map behind it.
#[derive(Clone)]
struct Metered {
    map: Arc<dyn Map3>,
    meter: Arc<Meter>,
}

impl Metered {
    /// What `f` makes of the map, or `over` once the limit is exceeded.
    fn counted<T>(&self, over: T, f: impl FnOnce(&dyn Map3) -> T) -> T {
        if self.meter.is_over() {
            return over;
        }
        let out = f(&*self.map);
        self.meter.count(self.map.take_overrun());
        out
    }
}

impl Map3 for Metered {
    fn jet(&self, p: DVec3) -> Jet3 {
        self.counted(Jet3::UNDEFINED, |m| m.jet(p))
    }

    fn point(&self, p: DVec3) -> DVec3 {
        self.counted(Jet3::UNDEFINED.p, |m| m.point(p))
    }

    fn jets(&self, ps: &[DVec3], out: &mut [Jet3]) {
        out.fill(Jet3::UNDEFINED);
        for (ps, out) in ps.chunks(BATCH).zip(out.chunks_mut(BATCH)) {
            self.counted((), |m| m.jets(ps, out));
        }
    }

    fn points(&self, ps: &mut [DVec3]) {
        for ps in ps.chunks_mut(BATCH) {
            if self.meter.is_over() {
                ps.fill(Jet3::UNDEFINED.p);
            } else {
                self.counted((), |m| m.points(ps));
            }
        }
    }

    fn collineation(&self) -> Option<&Collineation> {
        self.map.collineation()
    }

    fn fraction(&self, on: &Box3, most: usize) -> Option<Fraction3> {
        self.map.fraction(on, most)
    }

    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        self.map.branch(on).map(|b| metered(b, &self.meter))
    }

    /// The map's creases. Levels may ask the map.
    fn creases(&self, out: &mut Creases3) {
        let mut own = Creases3::default();
        self.map.creases(&mut own);
        for Crease3 { level, kind } in own.items().iter().cloned() {
            let own = self.clone();
            out.push(Crease3 { level: Arc::new(move |p| own.counted(1.0, |_| level(p))), kind });
        }
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        self.map.inverse()
    }

    fn work(&self) -> f64 {
        self.map.work()
    }
}
