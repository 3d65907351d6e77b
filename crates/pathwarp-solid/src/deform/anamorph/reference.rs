//! The reference of an anamorphosis, its control points before any is moved, and the eye from which models look unchanged.

use super::dilation::Dilation3;
use crate::lattice::Lattice3;
use crate::settings::{Box3, grid, show};
use glam::{DVec3, DVec4};
use pathwarp::Error;
use pathwarp::engine::bspline;
use std::collections::BTreeMap;

/// The eye of an anamorphosis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Eye3 {
    /// At a point.
    At(DVec3),
    /// At infinity, in the direction of this unit vector.
    Infinite(DVec3),
}

impl From<DVec3> for Eye3 {
    fn from(eye: DVec3) -> Self {
        Self::At(eye)
    }
}

impl Eye3 {
    /// Returns the homogeneous coordinates.
    pub(super) fn homogeneous(self) -> DVec4 {
        match self {
            Self::At(eye) => eye.extend(1.0),
            Self::Infinite(towards) => towards.extend(0.0),
        }
    }

    /// Returns a point from which `p` looks unchanged: the eye, or a point far away.
    pub(super) fn before(self, p: DVec3, far: f64) -> DVec3 {
        match self {
            Self::At(eye) => eye,
            Self::Infinite(towards) => p + towards * far,
        }
    }

    pub(super) fn relative_to(self, base: DVec3) -> Self {
        match self {
            Self::At(eye) => Self::At(eye - base),
            infinite => infinite,
        }
    }

    /// Returns the image of a point that moves along its ray: O + (p − O)/δ, or p + (δ − 1)·O for O at infinity.
    pub(super) fn image(self, p: DVec3, delta: f64) -> DVec3 {
        match self {
            Self::At(_) if delta == 1.0 => p,
            Self::At(eye) => eye + (p - eye) / delta,
            Self::Infinite(towards) => p + towards * (delta - 1.0),
        }
    }
}

/// A regular net of control points, before any is moved.
#[derive(Debug, Clone, PartialEq)]
pub enum Reference3 {
    /// Points (i·A + j·B + k·C + l·D)/n with i + j + k + l = n.
    Tetrahedron([DVec3; 4], usize),
    /// A pentahedron over the triangle A, B, C, with edges parallel to A–D, by the degrees n of the triangle and m along the edges: points
    /// (i·A + j·B + k·C)/n + l·(D − A)/m with i + j + k = n and l from 0 to m.
    Prism([DVec3; 4], [usize; 2]),
    /// Control points that need not be regular, between which a rational lattice finds local coordinates.
    Hull(Lattice3),
    /// A sheet: points (i·A + j·B + k·C)/n with i + j + k = n.
    Triangle([DVec3; 3], usize),
    /// Points i, j, k of a box, by its degrees along the axes.
    Cuboid(Box3, [usize; 3]),
    /// Control points of B-splines over a box, with degrees and numbers of cells along the axes.
    Spline(Box3, [usize; 3], [usize; 3]),
    /// Points, and tetrahedra by the numbers of their corners.
    Tetrahedra(Vec<DVec3>, Vec<[usize; 4]>),
    /// A sheet: a box that is flat along the given axis, along which all points have the number 0.
    Rectangle(Box3, usize, [usize; 3]),
}

/// A reference thinner than this fraction of its size counts as flat.
const FLAT: f64 = 1e-9;

impl Reference3 {
    /// Makes a reference from its points (four corners of a tetrahedron, three of a triangle, two of a box) for an eye.
    ///
    /// # Errors
    /// [`Error::Usage`] when the points do not span such a reference, or the eye lies in the plane of a sheet.
    pub fn new(points: &[DVec3], mut degree: [usize; 3], eye: impl Into<Eye3>) -> Result<Self, Error> {
        let eye = eye.into();
        let wrong = |problem: &str| Error::usage("reference", "", problem);
        let fits = degree[0] == degree[1] && (degree[1] == degree[2] || points.len() == 6);
        if points.len() > 2 && !fits {
            let text = format!("{}x{}x{}", degree[0], degree[1], degree[2]);
            let problem = "must be one number for a tetrahedron or a triangle, NxNxM for a pentahedron";
            return Err(Error::usage("degree", text, problem));
        }
        let in_plane = || wrong("is a sheet seen edge-on: the eye lies in its plane; move the eye or the reference");
        match *points {
            [a, b, c, d, e, f] => {
                let (edge, base) = (d - a, (b - a).cross(c - a));
                let size = edge.length().max((b - a).length()).max((c - a).length());
                if (e - b - edge).length().max((f - c - edge).length()) > 1e3 * FLAT * size {
                    let problem =
                        "has six corners whose edges from the first three to the last are not parallel and equal";
                    return Err(wrong(&format!("{problem}; cut it into tetrahedra (`tetrahedra`)")));
                }
                let volume = base.dot(edge).abs();
                if volume.is_nan() || volume <= FLAT * size.powi(3) {
                    return Err(wrong("is a flat pentahedron; move one of its corners"));
                }
                Ok(Self::Prism([a, b, c, d], [degree[0], degree[2]]))
            }
            [a, b, c, d] => {
                let size = (b - a).length().max((c - a).length()).max((d - a).length());
                let volume = (b - a).cross(c - a).dot(d - a).abs();
                if volume.is_nan() || volume <= FLAT * size.powi(3) {
                    return Err(wrong("has four corners in one plane; move one of them"));
                }
                Ok(Self::Tetrahedron([a, b, c, d], degree[0]))
            }
            [a, b, c] => {
                let normal = (b - a).cross(c - a);
                let size = (b - a).length().max((c - a).length());
                if normal.length().is_nan() || normal.length() <= FLAT * size * size {
                    return Err(wrong("has three corners on one line; move one of them"));
                }
                let distance = match eye {
                    Eye3::At(eye) => (eye - a).dot(normal.normalize()) / size,
                    Eye3::Infinite(towards) => towards.dot(normal.normalize()),
                };
                if distance.abs() <= FLAT {
                    return Err(in_plane());
                }
                Ok(Self::Triangle([a, b, c], degree[0]))
            }
            [a, b] => {
                let b = Box3::new(a, b);
                let size = b.size();
                let flat: Vec<usize> = (0..3).filter(|k| size[*k] <= FLAT * b.diagonal()).collect();
                match flat[..] {
                    [] => Ok(Self::Cuboid(b, degree)),
                    [axis]
                        if matches!(eye, Eye3::At(eye) if (eye[axis] - b.min[axis]).abs() <= FLAT * b.diagonal())
                            || matches!(eye, Eye3::Infinite(v) if v[axis].abs() <= FLAT) =>
                    {
                        Err(in_plane())
                    }
                    [axis] => {
                        degree[axis] = 0;
                        Ok(Self::Rectangle(b, axis, degree))
                    }
                    _ => Err(wrong("has no area; name two opposite corners of a box or a rectangle")),
                }
            }
            _ => Err(wrong(
                "must have four points (a tetrahedron), six (a pentahedron), three (a triangle) or two (a box, or a rectangle if flat)",
            )),
        }
    }

    /// Makes a B-spline net over a box.
    ///
    /// # Errors
    /// [`Error::Usage`] when the box is flat.
    pub fn spline(region: Box3, degree: [usize; 3], cells: [usize; 3]) -> Result<Self, Error> {
        if region.size().min_element() > FLAT * region.diagonal() {
            return Ok(Self::Spline(region, degree, cells));
        }
        Err(Error::usage("cells", "", "are for a box; the `reference` is flat"))
    }

    /// Makes tetrahedra that share faces, by the numbers of their corners among `points`: one δ for every point.
    ///
    /// # Errors
    /// [`Error::Usage`] when there is no such point, a tetrahedron is flat, or the middle of one lies in another.
    pub fn tetrahedra(points: Vec<DVec3>, all: Vec<[usize; 4]>) -> Result<Self, Error> {
        const MAX_TETRAHEDRA: usize = 1000;
        let wrong =
            |t: &[usize; 4], problem: &str| Error::usage("tetrahedra", t.map(|i| i.to_string()).join(","), problem);
        if let Some(t) = all.get(MAX_TETRAHEDRA) {
            return Err(wrong(t, "is one tetrahedron too many; at most 1000 are possible"));
        }
        for t in &all {
            if t.iter().any(|i| *i >= points.len()) {
                let last = points.len().max(1) - 1;
                return Err(wrong(t, &format!("names a point that the `reference` lacks; its points are 0 to {last}")));
            }
            Self::new(&t.map(|i| points[i]), [1; 3], DVec3::ZERO)
                .map_err(|_| wrong(t, "has four corners in one plane, or one corner twice; choose other points"))?;
        }
        for (k, t) in all.iter().enumerate() {
            let middle = t.iter().map(|i| points[*i]).sum::<DVec3>() * 0.25;
            let others = Self::Tetrahedra(points.clone(), [&all[..k], &all[k + 1..]].concat());
            if Dilation3::new(&others, Eye3::At(DVec3::ZERO), &vec![2.0; points.len()]).value(middle) != 1.0 {
                return Err(wrong(t, &format!("lies in another one at {}; let them share faces", show(middle))));
            }
        }
        Ok(Self::Tetrahedra(points, all))
    }

    /// Names the faces that two tetrahedra share, and the outer ones with a corner whose δ is not 1.
    pub(super) fn faces(&self, values: &[f64]) -> Option<[String; 2]> {
        let Self::Tetrahedra(_, all) = self else { return None };
        let mut faces: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
        for (t, k) in all.iter().flat_map(|t| (0..4).map(move |k| (t, k))) {
            let mut face: Vec<usize> = (0..4).filter(|i| *i != k).map(|i| t[i]).collect();
            face.sort_unstable();
            *faces.entry(face).or_default() += 1;
        }
        let names_of = |wanted: &dyn Fn(&[usize], usize) -> bool| {
            let name = |f: &Vec<usize>| f.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
            faces.iter().filter(|(f, n)| wanted(f, **n)).map(|(f, _)| name(f)).collect::<Vec<_>>().join(" ")
        };
        Some([names_of(&|_, n| n > 1), names_of(&|f, n| n == 1 && f.iter().any(|i| values[*i] != 1.0))])
    }

    /// Returns the bounding box.
    pub(super) fn bounds(&self) -> Box3 {
        let around =
            |all: &[DVec3]| Box3::around(all.iter().copied()).unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ZERO });
        match self {
            Self::Tetrahedron(c, _) => around(c),
            Self::Triangle(c, _) => around(c),
            Self::Prism([a, b, c, d], _) => around(&[*a, *b, *c, *d, *b + (*d - *a), *c + (*d - *a)]),
            Self::Hull(lattice) => around(&lattice.nodes().map(|n| lattice.point(n)).collect::<Vec<_>>()),
            Self::Tetrahedra(points, _) => around(points),
            Self::Cuboid(b, _) | Self::Spline(b, ..) | Self::Rectangle(b, ..) => *b,
        }
    }

    /// Returns the net in coordinates relative to a point.
    pub(super) fn relative_to(self, base: DVec3) -> Self {
        let shifted = |b: Box3| Box3 { min: b.min - base, max: b.max - base };
        match self {
            Self::Tetrahedron(c, n) => Self::Tetrahedron(c.map(|p| p - base), n),
            Self::Triangle(c, n) => Self::Triangle(c.map(|p| p - base), n),
            Self::Prism(c, n) => Self::Prism(c.map(|p| p - base), n),
            Self::Hull(mut lattice) => {
                lattice.nodes().for_each(|n| lattice.shift(n, -base));
                Self::Hull(lattice)
            }
            Self::Tetrahedra(points, all) => Self::Tetrahedra(points.iter().map(|p| *p - base).collect(), all),
            Self::Cuboid(b, d) => Self::Cuboid(shifted(b), d),
            Self::Spline(b, d, c) => Self::Spline(shifted(b), d, c),
            Self::Rectangle(b, axis, d) => Self::Rectangle(shifted(b), axis, d),
        }
    }

    /// Lists the numbers of the control points. The fourth number is 0 except in a tetrahedron and a pentahedron.
    #[must_use]
    pub fn nodes(&self) -> Vec<[usize; 4]> {
        match *self {
            Self::Tetrahedron(_, n) => {
                let rows = (0..=n).flat_map(|l| (0..=n - l).map(move |k| (k, l)));
                rows.flat_map(|(k, l)| (0..=n - l - k).map(move |j| [n - j - k - l, j, k, l])).collect()
            }
            Self::Triangle(_, n) => (0..=n).flat_map(|k| (0..=n - k).map(move |j| [n - j - k, j, k, 0])).collect(),
            Self::Prism(_, [n, m]) => {
                let rows = (0..=m).flat_map(|l| (0..=n).map(move |k| (k, l)));
                rows.flat_map(|(k, l)| (0..=n - k).map(move |j| [n - j - k, j, k, l])).collect()
            }
            Self::Tetrahedra(ref points, _) => (0..points.len()).map(|i| [i, 0, 0, 0]).collect(),
            Self::Spline(..) | Self::Cuboid(..) | Self::Rectangle(..) | Self::Hull(_) => {
                grid(self.last().map(|n| n + 1)).map(|[i, j, k]| [i, j, k, 0]).collect()
            }
        }
    }

    /// Returns the highest numbers along the axes of a box.
    fn last(&self) -> [usize; 3] {
        match self {
            Self::Cuboid(_, degree) | Self::Rectangle(_, _, degree) => *degree,
            Self::Spline(_, degree, cells) => [0, 1, 2].map(|a| degree[a] + cells[a] - 1),
            Self::Hull(lattice) => lattice.size().map(|n| n - 1),
            _ => [0; 3],
        }
    }

    /// Returns the count of numbers by which users name a control point.
    pub(super) fn indices(&self) -> usize {
        match self {
            Self::Tetrahedron(..) | Self::Prism(..) => 4,
            Self::Tetrahedra(..) => 1,
            _ => 3,
        }
    }

    /// Returns a control point.
    #[must_use]
    pub fn point(&self, node: [usize; 4]) -> DVec3 {
        let weighted = |corners: &[DVec3], n: usize| {
            corners.iter().zip(node).map(|(c, i)| *c * (i as f64 / n as f64)).sum::<DVec3>()
        };
        match self {
            Self::Tetrahedron(c, n) => weighted(c, *n),
            Self::Triangle(c, n) => weighted(c, *n),
            Self::Prism(c, [n, m]) => weighted(&c[..3], *n) + (c[3] - c[0]) * (node[3] as f64 / *m as f64),
            Self::Hull(lattice) => lattice.point([node[0], node[1], node[2]]),
            Self::Tetrahedra(points, _) => points[node[0]],
            Self::Spline(b, degree, cells) => {
                let t = DVec3::from_array([0, 1, 2].map(|a| bspline::regular(degree[a], cells[a])[node[a]]));
                b.min + t * b.size()
            }
            Self::Cuboid(b, degree) | Self::Rectangle(b, _, degree) => {
                let t = DVec3::from_array([0, 1, 2].map(|a| node[a] as f64 / degree[a].max(1) as f64));
                b.min + t * b.size()
            }
        }
    }

    /// Describes the numbers of the control points.
    #[must_use]
    pub fn numbers(&self) -> String {
        match self {
            Self::Tetrahedron(_, n) => format!("I,J,K,L must add up to {n}, the degree"),
            Self::Tetrahedra(points, _) => format!("the points have the numbers 0 to {}", points.len() - 1),
            Self::Triangle(_, n) => format!("I,J,K must add up to {n}, the degree"),
            Self::Prism(_, [n, m]) => format!("I,J,K must add up to {n}, and L runs from 0 to {m}"),
            Self::Spline(..) | Self::Cuboid(..) | Self::Rectangle(..) | Self::Hull(_) => {
                let [l, m, n] = self.last();
                format!("I runs from 0 to {l}, J from 0 to {m}, K from 0 to {n}")
            }
        }
    }

    /// Returns `true` if a prescribed point must not move a control point: on the face ABC of a tetrahedron or pentahedron, on the side AB
    /// of a triangle and, if `local`, on the boundary of a box or rectangle.
    #[must_use]
    pub(super) fn is_held(&self, node: [usize; 4], local: bool) -> bool {
        match self {
            Self::Tetrahedra(..) => false,
            Self::Tetrahedron(..) | Self::Prism(..) => node[3] == 0,
            Self::Triangle(..) => node[2] == 0,
            Self::Hull(..) | Self::Spline(..) | Self::Cuboid(..) | Self::Rectangle(..) => {
                let last = self.last();
                local && (0..3).any(|a| last[a] > 0 && (node[a] == 0 || node[a] == last[a]))
            }
        }
    }
}
