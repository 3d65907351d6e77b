//! A rational Bézier patch in homogeneous coordinates.

use crate::box3::Box3;
use glam::{DVec3, DVec4, Vec4Swizzles as _};

/// Highest degree of a surface, read or made by exact composition.
pub const MAX_DEGREE: usize = 12;

/// A rational Bézier patch over 0..1 × 0..1.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierPatch {
    /// Degrees in u and v.
    pub degree: [usize; 2],
    /// Control points (x·w, y·w, z·w, w); u runs fastest.
    pub points: Vec<DVec4>,
}

impl BezierPatch {
    /// Work of a point, in evaluations of a map.
    pub(super) fn work(&self) -> usize {
        2 + (self.degree[0] + 1) * (self.degree[1] + 1) / 2
    }

    /// The value in homogeneous coordinates and its derivatives by u and v.
    #[must_use]
    pub fn homogeneous(&self, u: f64, v: f64) -> [DVec4; 3] {
        let rows = self.points.chunks(self.degree[0] + 1).map(|row| curve(row.iter().copied(), u));
        let (mut at, mut slope) = ([DVec4::ZERO; MAX_DEGREE + 1], [DVec4::ZERO; MAX_DEGREE + 1]);
        for ((p, d), row) in at.iter_mut().zip(&mut slope).zip(rows) {
            (*p, *d) = row;
        }
        let n = self.degree[1] + 1;
        let (value, dv) = curve(at[..n].iter().copied(), v);
        [value, curve(slope[..n].iter().copied(), v).0, dv]
    }

    /// The point.
    #[must_use]
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let [p, ..] = self.homogeneous(u, v);
        p.xyz() / p.w
    }

    /// The point and its derivatives by u and v.
    #[must_use]
    pub fn jet(&self, u: f64, v: f64) -> [DVec3; 3] {
        let [p, du, dv] = self.homogeneous(u, v);
        let at = p.xyz() / p.w;
        [at, (du.xyz() - at * du.w) / p.w, (dv.xyz() - at * dv.w) / p.w]
    }

    /// The box of the control points.
    #[must_use]
    pub fn bounds(&self) -> Option<Box3> {
        Box3::around(self.points.iter().map(|p| p.xyz() / p.w))
    }
}

/// A Bézier curve and its derivative. The same arithmetic runs from both ends, so that patches with a common edge agree on it to
/// the last bit at parameters t and 1 − t.
pub(super) fn curve(points: impl Iterator<Item = DVec4>, t: f64) -> (DVec4, DVec4) {
    let mut row = [DVec4::ZERO; MAX_DEGREE + 1];
    let mut n = 0;
    for (slot, p) in row.iter_mut().zip(points) {
        *slot = p;
        n += 1;
    }
    let mut slope = DVec4::ZERO;
    for level in (1..n).rev() {
        slope = (row[1] - row[0]) * (n - 1) as f64;
        for i in 0..level {
            row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
        }
    }
    (row[0], slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a cylinder: a circle to the last bits, and derivatives as by differences.
    #[test]
    fn a_quarter_of_a_cylinder() {
        let h = 0.5f64.sqrt();
        let ring = [(1.0, 0.0, 1.0), (1.0, 1.0, h), (0.0, 1.0, 1.0)];
        let points = [0.0, 5.0].iter().flat_map(|z| ring.map(|(x, y, w)| DVec4::new(x * w, y * w, z * w, w)));
        let patch = BezierPatch { degree: [2, 1], points: points.collect() };
        for (u, v) in [(0.0, 0.0), (0.3, 0.6), (0.5, 0.1), (0.9, 1.0)] {
            let [p, du, dv] = patch.jet(u, v);
            assert!((p.x.hypot(p.y) - 1.0).abs() < 1e-15 && (p.z - 5.0 * v).abs() < 1e-14);
            const H: f64 = 1e-6;
            let by_u = (patch.point(u + H, v) - patch.point(u - H, v)) / (2.0 * H);
            assert!((du - by_u).length() < 1e-8 && (dv - DVec3::Z * 5.0).length() < 1e-13);
        }
    }
}
