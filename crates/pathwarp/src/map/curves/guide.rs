//! Guide curves of ruled maps: consecutive segments with one parameter from 0 to 1.

use super::ArcLength;
use crate::outline::Seg;
use kurbo::{CubicBez, ParamCurve, Point, Vec2};

/// The parameter of a guide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Along {
    /// Proportional to arc length.
    ArcLength,
    /// The segments' own parameters, each segment with an equal share of [0, 1].
    Parameter,
}

/// A guide curve with parameter u from 0 to 1.
#[derive(Debug, Clone)]
pub(crate) struct Guide {
    pieces: Vec<GuidePiece>,
}

/// One segment of a guide, over a range of u.
#[derive(Debug, Clone)]
pub(in crate::map) struct GuidePiece {
    seg: Seg,
    /// Parameters at the ends.
    from: f64,
    to: f64,
    /// Inverse arc length; `None` if u is proportional to the segment's own parameter.
    table: Option<ArcLength>,
}

impl Guide {
    /// A guide of consecutive segments. `None` if there are no segments, or they have no length.
    #[must_use]
    pub(crate) fn new(segs: &[Seg], along: Along) -> Option<Self> {
        let mut lengths = Vec::with_capacity(segs.len());
        let mut tables = Vec::with_capacity(segs.len());
        for seg in segs {
            let table = ArcLength::of(seg);
            lengths.push(if along == Along::ArcLength { table.length() } else { 1.0 });
            // The parameter of a line is proportional to its length.
            let even = along == Along::Parameter || matches!(seg, Seg::Line(_));
            tables.push((!even).then_some(table));
        }
        let total: f64 = lengths.iter().sum();
        let flat = segs.iter().all(|s| s.bounding_box().size().max_side() == 0.0);
        if flat || !total.is_finite() || total <= 0.0 {
            return None;
        }
        let mut at = 0.0;
        let mut pieces: Vec<GuidePiece> = Vec::with_capacity(segs.len());
        for ((seg, length), table) in segs.iter().zip(lengths).zip(tables) {
            let from = at / total;
            at += length;
            // A segment without length covers no u.
            if length > 0.0 {
                pieces.push(GuidePiece { seg: *seg, from, to: at / total, table });
            }
        }
        if let Some(last) = pieces.last_mut() {
            last.to = 1.0;
        }
        Some(Self { pieces })
    }

    /// The point at `u`. The outermost pieces continue beyond the ends.
    #[cfg(test)]
    pub(in crate::map) fn eval(&self, u: f64) -> Point {
        self.piece(u).at(u).0
    }

    /// The parameters between 0 and 1 at which pieces meet.
    pub(crate) fn joints(&self) -> impl Iterator<Item = f64> + '_ {
        self.pieces.iter().skip(1).map(|p| p.from)
    }

    /// The piece at `u`.
    pub(in crate::map) fn piece(&self, u: f64) -> &GuidePiece {
        let k = self.pieces.partition_point(|p| p.to < u).min(self.pieces.len() - 1);
        &self.pieces[k]
    }
}

impl GuidePiece {
    /// Point and derivative with respect to u.
    pub(in crate::map) fn at(&self, u: f64) -> (Point, Vec2) {
        let share = self.share(u);
        let (t, dt) = match &self.table {
            None => (share, 1.0),
            Some(table) => {
                let length = table.length();
                let inside = share.clamp(0.0, 1.0);
                let t = table.parameter(inside * length);
                let dt = length / self.seg.deriv(t).hypot().max(f64::MIN_POSITIVE);
                (if share == inside { t } else { t + (share - inside) * dt }, dt)
            }
        };
        (self.seg.eval(t), self.seg.deriv(t) * (dt / (self.to - self.from)))
    }

    /// The point of [`at`](Self::at).
    pub(in crate::map) fn point(&self, u: f64) -> Point {
        let share = self.share(u);
        match &self.table {
            None => self.seg.eval(share),
            Some(table) if (0.0..=1.0).contains(&share) => self.seg.eval(table.parameter(share * table.length())),
            Some(_) => self.at(u).0,
        }
    }

    /// The share of the piece that is before u.
    fn share(&self, u: f64) -> f64 {
        (u - self.from) / (self.to - self.from)
    }

    /// The piece over [u0, u1] as a cubic in u; `None` if it is not polynomial in u.
    pub(in crate::map) fn cubic(&self, u0: f64, u1: f64) -> Option<CubicBez> {
        if self.table.is_some() || matches!(self.seg, Seg::Arc(_)) {
            return None;
        }
        let c = self.seg.to_cubic();
        let whole = u0 == self.from && u1 == self.to;
        Some(if whole { c } else { c.subsegment(self.share(u0)..self.share(u1)) })
    }
}
