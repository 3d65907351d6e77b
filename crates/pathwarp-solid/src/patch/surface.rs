//! A surface as data: a NURBS surface in general, a Bézier patch if it has one span.

use super::bezier::{BezierPatch, MAX_DEGREE};
use super::knots;
use crate::box3::Box3;
use glam::DVec3;

/// A NURBS surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Its name; may be empty.
    pub name: String,
    /// Degrees in u and v, 1 to [`MAX_DEGREE`].
    pub degree: [usize; 2],
    /// Clamped knots in u and v.
    pub knots: [Vec<f64>; 2],
    /// Control points; u runs fastest.
    pub points: Vec<DVec3>,
    /// A positive weight for each control point.
    pub weights: Vec<f64>,
    /// Closed loops of curves in the plane of u and v. A point belongs to the surface if an odd number of them surrounds it, or if
    /// there are none.
    pub trims: Vec<Vec<TrimCurve>>,
}

/// A NURBS curve in the plane of u and v.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrimCurve {
    /// Its degree.
    pub degree: usize,
    /// Clamped knots.
    pub knots: Vec<f64>,
    /// Control points (u, v).
    pub points: Vec<[f64; 2]>,
    /// A positive weight for each control point.
    pub weights: Vec<f64>,
}

impl Surface {
    /// A Bézier patch over 0..1 × 0..1 with weights 1; `points` must be (`degree[0]` + 1)·(`degree[1]` + 1).
    #[must_use]
    pub fn bezier(name: &str, degree: [usize; 2], points: Vec<DVec3>) -> Self {
        let weights = vec![1.0; points.len()];
        let knots = degree.map(|d| knots::single(d, [0.0, 1.0]));
        Self { name: name.to_owned(), degree, knots, points, weights, trims: Vec::new() }
    }

    /// Numbers of control points in u and v.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [0, 1].map(|a| self.knots[a].len().saturating_sub(self.degree[a] + 1))
    }

    /// Returns `true` if weights differ.
    #[must_use]
    pub fn is_rational(&self) -> bool {
        self.weights.windows(2).any(|w| w[0] != w[1])
    }

    /// Returns `true` if it is a single Bézier patch.
    #[must_use]
    pub fn is_bezier(&self) -> bool {
        self.size() == self.degree.map(|d| d + 1)
    }

    /// The box of the control points, which holds the surface.
    #[must_use]
    pub fn bounds(&self) -> Option<Box3> {
        Box3::around(self.points.iter().copied())
    }

    /// Says what is wrong with the numbers, if anything is.
    #[must_use]
    pub fn fault(&self) -> Option<String> {
        let names = ["u", "v"];
        for (a, name) in names.into_iter().enumerate() {
            if !(1..=MAX_DEGREE).contains(&self.degree[a]) {
                return Some(format!("has degree {} in {name}; degrees are 1 to {MAX_DEGREE}", self.degree[a]));
            }
            if let Some(fault) = knots::fault(self.degree[a], &self.knots[a]) {
                return Some(format!("{fault} (in {name})"));
            }
        }
        let [nu, nv] = self.size();
        if Some(self.points.len()) != nu.checked_mul(nv) {
            return Some(format!("has {} control points; its degrees and knots take {nu} × {nv}", self.points.len()));
        }
        // The square of a larger number overflows.
        if let Some(i) =
            self.points.iter().position(|p| p.abs().max_element().is_nan() || p.abs().max_element() > 1e100)
        {
            return Some(format!("control point {} is not finite", i + 1));
        }
        faulty_weights(&self.weights, self.points.len())
            .or_else(|| self.trims.iter().flatten().find_map(|t| t.fault().map(|f| format!("a trimming curve {f}"))))
    }

    /// The Bézier patches, u fastest, and the values of u and v between them.
    #[must_use]
    pub fn pieces(&self) -> (Vec<BezierPatch>, [Vec<f64>; 2]) {
        let homogeneous: Vec<_> = self.points.iter().zip(&self.weights).map(|(p, w)| (*p * *w).extend(*w)).collect();
        knots::pieces(self.degree, &self.knots, self.size(), &homogeneous)
    }
}

impl TrimCurve {
    fn fault(&self) -> Option<String> {
        if self.degree == 0 || self.degree > MAX_DEGREE {
            return Some(format!("has degree {}; degrees are 1 to {MAX_DEGREE}", self.degree));
        }
        if self.knots.len() != self.points.len() + self.degree + 1 {
            return Some(format!("has {} control points and {} knots", self.points.len(), self.knots.len()));
        }
        if self.points.iter().flatten().any(|v| !v.is_finite()) {
            return Some("has a control point that is not finite".into());
        }
        knots::fault(self.degree, &self.knots).or_else(|| faulty_weights(&self.weights, self.points.len()))
    }
}

fn faulty_weights(weights: &[f64], points: usize) -> Option<String> {
    if weights.len() != points {
        return Some(format!("has {} weights for {points} control points", weights.len()));
    }
    let bad = weights.iter().position(|w| !(*w > 0.0 && *w < 1e100))?;
    Some(format!("weight {} is not a positive number", bad + 1))
}
