//! Maps of space one after another.

use super::collineation::Collineation;
use super::crease::{Crease3, Creases3};
use super::jet::Jet3;
use super::traits::Map3;
use glam::DVec3;
use pathwarp::budget::Budget;
use std::fmt;
use std::sync::Arc;

/// Maps one after another; the first is applied first. Neighbouring collineations are folded into one.
#[derive(Clone, Default)]
pub struct Chain3 {
    steps: Vec<Arc<dyn Map3>>,
}

impl fmt::Debug for Chain3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Chain3").field("steps", &self.steps.len()).finish_non_exhaustive()
    }
}

impl Chain3 {
    /// Appends a map.
    pub fn push(&mut self, map: Arc<dyn Map3>) {
        let folded = match (self.steps.last().and_then(|m| m.collineation()), map.collineation()) {
            (Some(last), Some(next)) => Some(last.then(next)),
            _ => None,
        };
        match folded {
            Some(both) => {
                self.steps.pop();
                self.steps.push(Arc::new(both));
            }
            None => self.steps.push(map),
        }
    }

    /// The maps that are left after folding.
    #[must_use]
    pub fn steps(&self) -> &[Arc<dyn Map3>] {
        &self.steps
    }
}

impl Map3 for Chain3 {
    fn jet(&self, p: DVec3) -> Jet3 {
        self.steps.iter().fold(Jet3::identity(p), |jet, s| jet.then(&s.jet(jet.p)))
    }

    fn point(&self, p: DVec3) -> DVec3 {
        self.steps.iter().fold(p, |p, s| s.point(p))
    }

    fn points(&self, ps: &mut [DVec3]) {
        for s in &self.steps {
            s.points(ps);
        }
    }

    fn collineation(&self) -> Option<&Collineation> {
        match &self.steps[..] {
            [only] => only.collineation(),
            _ => None,
        }
    }

    fn creases(&self, out: &mut Creases3) {
        let mut before = Self::default();
        for s in &self.steps {
            let mut own = Creases3::default();
            s.creases(&mut own);
            for Crease3 { level, kind } in own.items().iter().cloned() {
                let first = before.clone();
                out.push(Crease3 { level: Arc::new(move |p| level(first.point(p))), kind });
            }
            before.steps.push(Arc::clone(s));
        }
    }

    fn work(&self) -> f64 {
        self.steps.iter().map(Map3::work).sum::<f64>().max(1.0)
    }

    fn within(&self, budget: &Arc<Budget>) -> Option<Arc<dyn Map3>> {
        let within: Vec<Option<Arc<dyn Map3>>> = self.steps.iter().map(|s| s.within(budget)).collect();
        within.iter().any(Option::is_some).then(|| {
            let steps = within.into_iter().zip(&self.steps).map(|(within, s)| within.unwrap_or_else(|| Arc::clone(s)));
            Arc::new(Self { steps: steps.collect() }) as Arc<dyn Map3>
        })
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        let mut out = Self::default();
        for s in self.steps.iter().rev() {
            out.push(s.inverse()?);
        }
        Some(Arc::new(out))
    }
}
