//! The map: pieces one after another along an axis of the model.

use super::strip::{Stand, Strip};
use crate::map::{Creases3, Jet3, Map3};
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// The model's coordinates on the skeleton: u runs along `axis` from 0 at `start` to the number of pieces at `start` + `length`;
/// v and w are measured from `through` along the two axes that follow it in cyclic order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BendMap3 {
    pub(super) pieces: Arc<[Strip]>,
    pub(super) axis: usize,
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) through: DVec3,
}

impl BendMap3 {
    /// The other two axes.
    fn sides(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// The curves at a point, v, w, and the pieces per unit along the axis. The first and the last piece continue outside.
    fn stand(&self, p: DVec3) -> (Stand, f64, f64, f64) {
        let n = self.pieces.len();
        let rate = n as f64 / self.length;
        let s = (p[self.axis] - self.start) * rate;
        // A cast of a negative number gives 0.
        let i = (s as usize).min(n - 1);
        let [b, c] = self.sides();
        (self.pieces[i].stand(s - i as f64), p[b] - self.through[b], p[c] - self.through[c], rate)
    }
}

impl Map3 for BendMap3 {
    fn jet(&self, p: DVec3) -> Jet3 {
        let (Stand { at, slope }, v, w, rate) = self.stand(p);
        let mut columns = [DVec3::ZERO; 3];
        let [b, c] = self.sides();
        columns[self.axis] = (slope[0] + slope[1] * v + slope[2] * w) * rate;
        (columns[b], columns[c]) = (at[1], at[2]);
        Jet3 { p: at[0] + at[1] * v + at[2] * w, d: DMat3::from_cols(columns[0], columns[1], columns[2]) }
    }

    fn point(&self, p: DVec3) -> DVec3 {
        let (Stand { at, .. }, v, w, _) = self.stand(p);
        at[0] + at[1] * v + at[2] * w
    }

    fn creases(&self, out: &mut Creases3) {
        for i in 1..self.pieces.len() {
            let (axis, at) = (self.axis, self.start + self.length * i as f64 / self.pieces.len() as f64);
            out.kink(move |p| p[axis] - at);
        }
    }
}
