//! The map: pieces one after another along an axis of the model.

use super::strip::{Stand, Strip};
use crate::box3::Box3;
use crate::map::{Chart, Creases3, Fraction3, Jet3, Local, Map3, Poly3, Swept, Tensor, for_all};
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
    /// The curves of the only piece, if they are polynomials.
    swept: Option<Tensor<9>>,
}

impl BendMap3 {
    pub(super) fn new(pieces: Arc<[Strip]>, axis: usize, start: f64, length: f64, through: DVec3) -> Self {
        let only = if let [only] = &*pieces { only.bernstein() } else { None };
        let swept = only.map(|c| Tensor::bernstein([c.len(), 1, 1], c));
        Self { pieces, axis, start, length, through, swept }
    }

    /// The other two axes.
    fn sides(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// The piece for a whole box, if it is one.
    fn piece_on(&self, on: &Box3) -> Option<usize> {
        let last = self.pieces.len() - 1;
        let place = |at: f64| (at - self.start) * self.pieces.len() as f64 / self.length;
        // Rounding may put a joint on either side of the box's end.
        let slack = 1e-9 * (1.0 + place(on.max[self.axis]).abs());
        let from = ((place(on.min[self.axis]) + slack) as usize).min(last);
        let to = ((place(on.max[self.axis]) - slack) as usize).min(last);
        // A flat box may lie in a joint, where both pieces agree.
        (from >= to).then_some(from)
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

    fn points(&self, ps: &mut [DVec3]) {
        let Some(tensor) = &self.swept else {
            ps.iter_mut().for_each(|p| *p = self.point(*p));
            return;
        };
        // −1 to 1 along the axis; the other coordinates are lengths.
        let (mut middle, mut scale) = (self.through, DVec3::ONE);
        middle[self.axis] = self.start + 0.5 * self.length;
        scale[self.axis] = 2.0 / self.length;
        for_all(&Swept { axis: self.axis, local: Local { middle, scale }, tensor }, ps);
    }

    fn point(&self, p: DVec3) -> DVec3 {
        let (Stand { at, .. }, v, w, _) = self.stand(p);
        at[0] + at[1] * v + at[2] * w
    }

    fn fraction(&self, on: &Box3, _most: usize) -> Option<Fraction3> {
        let (chart, from) = (Chart::on(on), self.piece_on(on)?);
        let rate = self.pieces.len() as f64 / self.length;
        let axis = DVec3::AXES[self.axis];
        let u = chart.linear((axis * rate).extend(-self.start * rate - from as f64));
        let [v, w] = self.sides().map(|a| chart.linear(DVec3::AXES[a].extend(-self.through[a])));
        let curves = self.pieces[from].polynomials(&u)?;
        let part = |k: usize| curves[0][k].plus(1.0, &curves[1][k].times(&v)).plus(1.0, &curves[2][k].times(&w));
        Some(Fraction3 { chart, parts: [part(0), part(1), part(2), Poly3::constant(1.0)] })
    }

    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        let (piece, length) = (self.piece_on(on)?, self.length / self.pieces.len() as f64);
        let (pieces, start) = ([self.pieces[piece].clone()].into(), self.start + length * piece as f64);
        Some(Arc::new(Self::new(pieces, self.axis, start, length, self.through)))
    }

    fn creases(&self, out: &mut Creases3) {
        for i in 1..self.pieces.len() {
            let (axis, at) = (self.axis, self.start + self.length * i as f64 / self.pieces.len() as f64);
            out.kink(move |p| p[axis] - at);
        }
    }
}
