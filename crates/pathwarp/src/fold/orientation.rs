//! The orientation of a shape under a map: signs of the Jacobian determinant.

use crate::map::Jet;
use kurbo::Point;

/// Signs of the Jacobian determinant over samples of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Orientation {
    /// Number of samples with a positive determinant.
    pub positive: usize,
    /// Number of samples with a negative determinant.
    pub negative: usize,
    /// Number of sign changes between neighbouring samples.
    pub changes: usize,
    /// The first sample with a positive determinant.
    pub first_positive: Option<Point>,
    /// The first sample with a negative determinant.
    pub first_negative: Option<Point>,
}

impl Orientation {
    /// `count` samples of the same sign, beginning at `first`.
    pub(super) fn uniform(sign: f64, count: usize, first: Option<Point>) -> Self {
        let first = first.filter(|_| count > 0);
        if sign > 0.0 {
            Self { positive: count, first_positive: first, ..Self::default() }
        } else {
            Self { negative: count, first_negative: first, ..Self::default() }
        }
    }

    /// Adds neighbouring samples.
    pub(super) fn add(&mut self, points: &[Point], jets: &[Jet]) {
        let mut last = 0.0;
        for (p, j) in points.iter().zip(jets) {
            let det = j.det();
            if !det.is_finite() || det == 0.0 {
                continue;
            }
            if det > 0.0 {
                self.positive += 1;
                self.first_positive.get_or_insert(*p);
            } else {
                self.negative += 1;
                self.first_negative.get_or_insert(*p);
            }
            if det * last < 0.0 {
                self.changes += 1;
            }
            last = det;
        }
    }

    /// The samples of both.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            positive: self.positive + other.positive,
            negative: self.negative + other.negative,
            changes: self.changes + other.changes,
            first_positive: self.first_positive.or(other.first_positive),
            first_negative: self.first_negative.or(other.first_negative),
        }
    }

    /// A point of this shape that is turned over relative to the majority of the artwork's samples, `all`.
    #[must_use]
    pub fn folded_against(&self, all: &Self) -> Option<Point> {
        if all.positive >= all.negative { self.first_negative } else { self.first_positive }
    }
}
