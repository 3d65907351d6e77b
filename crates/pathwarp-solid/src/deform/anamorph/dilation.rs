//! Computes δ, the factor by which a point comes closer to the eye, a polynomial over a reference.
//!
//! Over a tetrahedron δ(u) = Σ δᵢ·n!/(i!j!k!l!)·u₀ⁱu₁ʲu₂ᵏu₃ˡ in barycentric coordinates, over a box the tensor product of
//! Bernstein polynomials. A *sheet*, a triangle or a rectangle, gives every point the δ of its ray: the barycentric coordinates of
//! a point's projection from O onto a triangle are u'ᵢ/Σu' with (p, 1) = Σ u'ᵢ·(bᵢ, 1) + t·O, which are linear in p.
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016), equations 6, 8 and 10.

use super::reference::{Eye3, Reference3};
use crate::map::{Chart, Local, Poly3, Tensor};
use glam::{DMat4, DVec3, DVec4};

/// Highest degree.
pub(super) const MAX_DEGREE: usize = 10;

/// δ as a function on space.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Dilation3 {
    /// Over a tetrahedron: the barycentric coordinates as linear forms in (x, y, z, 1).
    Tetrahedron { forms: [DVec4; 4], terms: Simplex },
    /// Over a triangle seen from the eye: linear forms in (x, y, z, 1) that vanish at the eye. The fourth is their sum.
    Triangle { forms: [DVec4; 4], terms: Simplex },
    /// Over a box.
    Cuboid { local: Local, tensor: Tensor<1> },
    /// Over a rectangle seen from the eye: on the plane where coordinate `axis` is `at`.
    Rectangle { eye: Eye3, axis: usize, at: f64, local: Local, tensor: Tensor<1> },
}

/// A polynomial in barycentric coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Simplex {
    degree: usize,
    /// Exponents, and δ times the multinomial coefficient.
    terms: Vec<([usize; 4], f64)>,
}

impl Simplex {
    pub(super) fn new(degree: usize, values: impl Iterator<Item = ([usize; 4], f64)>) -> Self {
        let factorial = |n: usize| (1..=n).fold(1.0, |f, k| f * k as f64);
        let coefficient = |node: &[usize; 4]| factorial(degree) / node.iter().map(|n| factorial(*n)).product::<f64>();
        Self { degree, terms: values.map(|(node, delta)| (node, delta * coefficient(&node))).collect() }
    }

    /// Substitutes polynomials for the barycentric coordinates.
    fn in_terms_of(&self, u: &[Poly3; 4]) -> Poly3 {
        let powers = u.each_ref().map(|u| u.powers(self.degree));
        let term = |node: &[usize; 4]| {
            (0..4).map(|a| &powers[a][node[a]]).fold(Poly3::constant(1.0), |product, p| product.times(p))
        };
        let mut out = Poly3::default();
        self.terms.iter().for_each(|(node, c)| out.add(*c, &term(node)));
        out
    }

    /// The value and its four partial derivatives.
    fn jet(&self, u: [f64; 4]) -> (f64, [f64; 4]) {
        let mut powers = [[1.0; MAX_DEGREE + 1]; 4];
        for (row, u) in powers.iter_mut().zip(u) {
            for k in 1..=self.degree {
                row[k] = row[k - 1] * u;
            }
        }
        let (mut value, mut slope) = (0.0, [0.0; 4]);
        for (node, c) in &self.terms {
            let factor: [f64; 4] = std::array::from_fn(|a| powers[a][node[a]]);
            value += c * factor.iter().product::<f64>();
            for a in (0..4).filter(|a| node[*a] > 0) {
                let others: f64 = (0..4).filter(|b| *b != a).map(|b| factor[b]).product();
                slope[a] += c * node[a] as f64 * powers[a][node[a] - 1] * others;
            }
        }
        (value, slope)
    }
}

impl Dilation3 {
    /// Makes δ over a reference from its values at the control points, in the order of the reference's nodes.
    pub(super) fn new(reference: &Reference3, eye: Eye3, values: &[f64]) -> Self {
        let simplex = |n: usize| Simplex::new(n, reference.nodes().into_iter().zip(values.iter().copied()));
        let tensor = |size: [usize; 3]| Tensor::bernstein(size, values.iter().map(|v| [*v]).collect());
        match *reference {
            Reference3::Tetrahedron(corners, n) => {
                let columns = corners.map(|b| b.extend(1.0));
                let inverse = DMat4::from_cols(columns[0], columns[1], columns[2], columns[3]).inverse();
                Self::Tetrahedron { forms: [0, 1, 2, 3].map(|i| inverse.row(i)), terms: simplex(n) }
            }
            Reference3::Triangle([a, b, c], n) => {
                // p = Σ u'ᵢ·bᵢ + t·O in homogeneous coordinates.
                let inverse =
                    DMat4::from_cols(a.extend(1.0), b.extend(1.0), c.extend(1.0), eye.homogeneous()).inverse();
                let [f, g, h] = [0, 1, 2].map(|i| inverse.row(i));
                Self::Triangle { forms: [f, g, h, f + g + h], terms: simplex(n) }
            }
            // Its map is that of a rational lattice; here only its box counts.
            Reference3::Spline(b, ..) => {
                let local = Local { middle: b.center(), scale: 2.0 / b.size() };
                Self::Cuboid { local, tensor: Tensor::bernstein([1; 3], vec![[1.0]]) }
            }
            Reference3::Cuboid(b, degree) => {
                let local = Local { middle: b.center(), scale: 2.0 / b.size() };
                Self::Cuboid { local, tensor: tensor(degree.map(|d| d + 1)) }
            }
            Reference3::Rectangle(b, axis, degree) => {
                let mut scale = 2.0 / b.size();
                scale[axis] = 0.0;
                let mut size = degree.map(|d| d + 1);
                size[axis] = 1;
                let local = Local { middle: b.center(), scale };
                Self::Rectangle { eye, axis, at: b.min[axis], local, tensor: tensor(size) }
            }
        }
    }

    /// δ and its gradient at `p`; not finite where the ray of a point does not meet the plane of a sheet.
    pub(super) fn jet(&self, p: DVec3) -> (f64, DVec3) {
        match self {
            Self::Tetrahedron { forms, terms } => {
                let (value, slope) = terms.jet(forms.map(|f| f.dot(p.extend(1.0))));
                (value, (0..4).map(|a| forms[a].truncate() * slope[a]).sum())
            }
            Self::Triangle { forms, terms } => {
                let [u, v, w, sum] = forms.map(|f| f.dot(p.extend(1.0)));
                if sum.is_nan() || sum <= 0.0 {
                    return (f64::NAN, DVec3::NAN);
                }
                let (value, slope) = terms.jet([u / sum, v / sum, w / sum, 0.0]);
                // ∂(u'ᵢ/Σ) = (∇u'ᵢ − uᵢ·∇Σ)/Σ.
                let g = forms.map(DVec4::truncate);
                let part = |a: usize, u: f64| (g[a] - u / sum * g[3]) * (slope[a] / sum);
                (value, part(0, u) + part(1, v) + part(2, w))
            }
            Self::Cuboid { local, tensor } => {
                let [[value, x, y, z]] = tensor.jet((p - local.middle) * local.scale);
                (value, DVec3::new(x, y, z) * local.scale)
            }
            Self::Rectangle { eye, axis, at, local, tensor } => {
                let eye = match *eye {
                    Eye3::At(eye) => eye,
                    Eye3::Infinite(v) => {
                        // q = p − v·(pₐ − at)/vₐ.
                        let q = p - v * ((p[*axis] - at) / v[*axis]);
                        let [[value, x, y, z]] = tensor.jet((q - local.middle) * local.scale);
                        let mut gradient = DVec3::new(x, y, z) * local.scale;
                        gradient[*axis] -= gradient.dot(v) / v[*axis];
                        return (value, gradient);
                    }
                };
                let (ray, depth) = (p - eye, p[*axis] - eye[*axis]);
                let t = (at - eye[*axis]) / depth;
                if t.is_nan() || t <= 0.0 {
                    return (f64::NAN, DVec3::NAN);
                }
                let [[value, x, y, z]] = tensor.jet((eye + ray * t - local.middle) * local.scale);
                let slope = DVec3::new(x, y, z) * local.scale;
                // q = O + t·(p − O) with ∇t = −t/(p − O)ₐ along the axis.
                let mut gradient = slope * t;
                gradient[*axis] -= slope.dot(ray) * t / depth;
                (value, gradient)
            }
        }
    }

    /// The degree of δ over the reference.
    pub(super) fn degree(&self) -> usize {
        match self {
            Self::Tetrahedron { terms, .. } | Self::Triangle { terms, .. } => terms.degree,
            Self::Cuboid { tensor, .. } | Self::Rectangle { tensor, .. } => tensor.degrees().iter().sum(),
        }
    }

    /// δ as a quotient of two polynomials.
    pub(super) fn fraction(&self, chart: &Chart) -> (Poly3, Poly3) {
        match self {
            Self::Tetrahedron { forms, terms } => {
                (terms.in_terms_of(&forms.map(|f| chart.linear(f))), Poly3::constant(1.0))
            }
            Self::Triangle { forms, terms } => {
                let [u, v, w, sum] = forms.map(|f| chart.linear(f));
                let below = sum.powers(terms.degree).swap_remove(terms.degree);
                (terms.in_terms_of(&[u, v, w, Poly3::default()]), below)
            }
            Self::Cuboid { local, tensor } => {
                let [delta] = tensor.in_terms_of(&chart.local(local));
                (delta, Poly3::constant(1.0))
            }
            Self::Rectangle { eye, axis, at, local, tensor } => {
                let eye = match *eye {
                    Eye3::At(eye) => eye,
                    Eye3::Infinite(v) => {
                        let coordinate = |a: usize| {
                            let k = v[a] / v[*axis];
                            let form = (DVec3::AXES[a] - DVec3::AXES[*axis] * k).extend(at * k - local.middle[a]);
                            chart.linear(form * local.scale[a])
                        };
                        let [delta] = tensor.in_terms_of(&[0, 1, 2].map(coordinate));
                        return (delta, Poly3::constant(1.0));
                    }
                };
                // A ray meets the plane at O + (p − O)·d/(p − O)ₐ. Multiplying by the depth (p − O)ₐ makes this homogeneous.
                let depth = chart.linear(DVec3::AXES[*axis].extend(-eye[*axis]));
                let d = at - eye[*axis];
                let coordinate = |a: usize| {
                    let ray = chart.linear(DVec3::AXES[a].extend(-eye[a]));
                    let start = (eye[a] - local.middle[a]) * local.scale[a];
                    Poly3::default().plus(start, &depth).plus(d * local.scale[a], &ray)
                };
                let degrees = tensor.degrees();
                let total: usize = degrees.iter().sum();
                let below = depth.powers(total);
                let powers = [0, 1, 2].map(|a| coordinate(a).powers(degrees[a]));
                let mut delta = Poly3::default();
                for ([i, j, k], [c]) in tensor.terms() {
                    let product = powers[0][i].times(&powers[1][j]).times(&powers[2][k]);
                    delta.add(*c, &product.times(&below[total - i - j - k]));
                }
                (delta, below[total].clone())
            }
        }
    }

    /// δ alone.
    pub(super) fn at(&self, p: DVec3) -> f64 {
        match self {
            Self::Cuboid { local, tensor } => tensor.at((p - local.middle) * local.scale)[0],
            _ => self.jet(p).0,
        }
    }

    /// Linear forms in (x, y, z, 1) that are nonnegative inside the reference, or inside the pyramid of a sheet's rays.
    pub(super) fn sides(&self, reference: &Reference3) -> Vec<DVec4> {
        match self {
            Self::Tetrahedron { forms, .. } => forms.to_vec(),
            Self::Triangle { forms, .. } => forms[..3].to_vec(),
            Self::Cuboid { .. } => {
                let (Reference3::Cuboid(b, _) | Reference3::Spline(b, ..)) = reference else { return Vec::new() };
                let side = |a: usize, sign: f64, at: f64| (DVec3::AXES[a] * sign).extend(-sign * at);
                (0..3).flat_map(|a| [side(a, 1.0, b.min[a]), side(a, -1.0, b.max[a])]).collect()
            }
            Self::Rectangle { eye, axis, at, .. } => {
                let Reference3::Rectangle(b, ..) = reference else { return Vec::new() };
                let eye = match eye {
                    Eye3::At(eye) => eye,
                    Eye3::Infinite(v) => {
                        let mut out = Vec::new();
                        for a in (0..3).filter(|a| a != axis) {
                            let k = v[a] / v[*axis];
                            let form = (DVec3::AXES[a] - DVec3::AXES[*axis] * k).extend(at * k);
                            out.push(form - DVec4::W * b.min[a]);
                            out.push(DVec4::W * b.max[a] - form);
                        }
                        return out;
                    }
                };
                let d = at - eye[*axis];
                // (p − O)ₐ·d ≥ 0 and, for the other axes, (min − O)·(p − O)ₐ/d ≤ p − O ≤ (max − O)·(p − O)ₐ/d.
                let form = |g: DVec3| g.extend(-g.dot(*eye));
                let depth = DVec3::AXES[*axis];
                let mut out = vec![form(depth * d)];
                for a in (0..3).filter(|a| a != axis) {
                    out.push(form(DVec3::AXES[a] - depth * ((b.min[a] - eye[a]) / d)));
                    out.push(form(depth * ((b.max[a] - eye[a]) / d) - DVec3::AXES[a]));
                }
                out
            }
        }
    }

    /// δ as a linear form in (x, y, z, 1), if its degree makes it one.
    pub(super) fn linear(&self) -> Option<DVec4> {
        match self {
            Self::Tetrahedron { forms, terms } if terms.degree == 1 => {
                let corner = |(node, delta): &([usize; 4], f64)| {
                    forms.iter().zip(node).filter(|(_, n)| **n == 1).map(|(f, _)| *f * *delta).sum::<DVec4>()
                };
                Some(terms.terms.iter().map(corner).sum())
            }
            _ => None,
        }
    }

    /// Whether δ is constant along rays.
    pub(super) fn is_sheet(&self) -> bool {
        matches!(self, Self::Triangle { .. } | Self::Rectangle { .. })
    }
}
