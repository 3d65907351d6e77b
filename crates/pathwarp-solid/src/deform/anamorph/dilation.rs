//! The dilation δ, the factor by which a point comes closer to the eye: a polynomial over a reference.
//!
//! Over a tetrahedron δ(u) = Σ δᵢ·n!/(i!j!k!l!)·u₀ⁱu₁ʲu₂ᵏu₃ˡ in barycentric coordinates, over a box the tensor product of
//! Bernstein polynomials. A *sheet*, a triangle or a rectangle, gives every point the δ of its ray: the barycentric coordinates of
//! a point's projection from O onto a triangle are u'ᵢ/Σu' with (p, 1) = Σ u'ᵢ·(bᵢ, 1) + t·O, which are linear in p.
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016), equations 6, 8 and 10.

use super::reference::{Eye3, Reference3};
use super::signed_side;
use crate::map::{Chart, Local, Poly3, Tensor};
use glam::{DMat4, DVec3, DVec4};
use std::sync::Arc;

/// Highest degree of a reference.
pub(super) const MAX_DEGREE: usize = 10;

/// δ as a function on space.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Dilation3 {
    /// Over a tetrahedron: the barycentric coordinates as linear forms in (x, y, z, 1). Over a pentahedron: the barycentric coordinates in
    /// its triangle and, as the fourth form, the coordinate along its edges.
    Tetrahedron { forms: [DVec4; 4], terms: Simplex },
    /// Over a box.
    Cuboid { local: Local, tensor: Tensor<1> },
    /// Over a triangle or rectangle seen from the eye: its coordinates are quotients of linear forms that vanish at the eye, with
    /// the fourth as denominator.
    Sheet { forms: [DVec4; 4], net: Net },
    /// Over tetrahedra that share faces: for each, its barycentric coordinates, and δ as a linear form; elsewhere δ is 1.
    Tetrahedra(Arc<[([DVec4; 4], DVec4)]>),
}

/// δ over a sheet, in the sheet's coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Net {
    Triangle(Simplex),
    Rectangle(Tensor<1>),
}

impl Net {
    /// Returns the value and its three partial derivatives.
    fn jet(&self, u: [f64; 3]) -> (f64, [f64; 3]) {
        match self {
            Self::Triangle(terms) => {
                let (value, [x, y, z, _]) = terms.jet([u[0], u[1], u[2], 0.0]);
                (value, [x, y, z])
            }
            Self::Rectangle(tensor) => {
                let [[value, x, y, z]] = tensor.jet(u.into());
                (value, [x, y, z])
            }
        }
    }
}

/// A polynomial in barycentric coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Simplex {
    degree: usize,
    /// Exponents and coefficients, which are δ times the multinomial coefficient.
    terms: Vec<([usize; 4], f64)>,
}

impl Simplex {
    pub(super) fn new(degree: usize, values: impl Iterator<Item = ([usize; 4], f64)>) -> Self {
        let factorial = |n: usize| (1..=n).fold(1.0, |f, k| f * k as f64);
        let coefficient = |node: &[usize; 4]| factorial(degree) / node.iter().map(|n| factorial(*n)).product::<f64>();
        Self { degree, terms: values.map(|(node, delta)| (node, delta * coefficient(&node))).collect() }
    }

    /// Makes the tensor product of Bernstein polynomials of degree `n` over a triangle and of degree `m` over 0..1, whose variable w is
    /// the fourth: (1 − w)^(m−l)·w^l is expanded in powers of w.
    fn prism([n, m]: [usize; 2], values: impl Iterator<Item = ([usize; 4], f64)>) -> Self {
        let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
        let mut out = Self { degree: n + m, terms: Vec::new() };
        for ([i, j, k, l], delta) in values {
            let c = delta * choose(n, i) * choose(n - i, j) * choose(m, l);
            let power =
                |e: usize| ([i, j, k, l + e], c * choose(m - l, e) * if e.is_multiple_of(2) { 1.0 } else { -1.0 });
            out.terms.extend((0..=m - l).map(power));
        }
        out
    }

    /// Substitutes polynomials for the barycentric coordinates.
    fn in_terms_of(&self, u: &[Poly3; 4]) -> Poly3 {
        let powers = u.each_ref().map(|u| u.powers(self.degree.min(MAX_DEGREE)));
        let term = |node: &[usize; 4]| {
            (0..4).map(|a| &powers[a][node[a]]).fold(Poly3::constant(1.0), |product, p| product.times(p))
        };
        let mut out = Poly3::default();
        self.terms.iter().for_each(|(node, c)| out.add(*c, &term(node)));
        out
    }

    /// Returns the value and its four partial derivatives.
    fn jet(&self, u: [f64; 4]) -> (f64, [f64; 4]) {
        let mut powers = [[1.0; MAX_DEGREE + 1]; 4];
        for (row, u) in powers.iter_mut().zip(u) {
            for k in 1..=self.degree.min(MAX_DEGREE) {
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

/// Returns the barycentric coordinates of a tetrahedron as linear forms. Its last corner may be at infinity.
fn barycentric(corners: [DVec4; 4]) -> [DVec4; 4] {
    let [a, b, c, d] = corners;
    let inverse = DMat4::from_cols(a, b, c, d).inverse();
    [0, 1, 2, 3].map(|i| inverse.row(i))
}

impl Dilation3 {
    /// Makes δ over a reference from its values at the control points, in the order of the reference's nodes.
    pub(super) fn new(reference: &Reference3, eye: Eye3, values: &[f64]) -> Self {
        let simplex = |n: usize| Simplex::new(n, reference.nodes().into_iter().zip(values.iter().copied()));
        let tensor = |size: [usize; 3]| Tensor::bernstein(size, values.iter().map(|v| [*v]).collect());
        match reference {
            Reference3::Tetrahedron(corners, n) => {
                Self::Tetrahedron { forms: barycentric(corners.map(|b| b.extend(1.0))), terms: simplex(*n) }
            }
            Reference3::Prism([a, b, c, d], degree) => {
                // p = Σ uᵢ·bᵢ + w·(D − A).
                let forms = barycentric([a.extend(1.0), b.extend(1.0), c.extend(1.0), (*d - *a).extend(0.0)]);
                let values = reference.nodes().into_iter().zip(values.iter().copied());
                Self::Tetrahedron { forms, terms: Simplex::prism(*degree, values) }
            }
            Reference3::Triangle([a, b, c], n) => {
                // (p, 1) = Σ u'ᵢ·(bᵢ, 1) + t·O.
                let [f, g, h, _] = barycentric([a.extend(1.0), b.extend(1.0), c.extend(1.0), eye.homogeneous()]);
                Self::Sheet { forms: [f, g, h, f + g + h], net: Net::Triangle(simplex(*n)) }
            }
            // B-splines and a hull are mapped by a rational lattice; only their box counts here.
            Reference3::Cuboid(..) | Reference3::Spline(..) | Reference3::Hull(_) => {
                let b = reference.bounds();
                let local = Local { middle: b.center(), scale: 2.0 / b.size() };
                let tensor = match reference {
                    Reference3::Cuboid(_, degree) => tensor(degree.map(|d| d + 1)),
                    _ => Tensor::bernstein([1; 3], vec![[1.0]]),
                };
                Self::Cuboid { local, tensor }
            }
            Reference3::Rectangle(b, axis, degree) => {
                // Coordinates from −1 to 1 along both sides.
                let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |k: usize| (b.min + DVec3::AXES[k] * b.size()[k]).extend(1.0);
                let [f, g, h, _] = barycentric([b.min.extend(1.0), corner(x), corner(y), eye.homogeneous()]);
                let mut forms = [DVec4::ZERO, DVec4::ZERO, DVec4::ZERO, f + g + h];
                (forms[x], forms[y]) = (g * 2.0 - forms[3], h * 2.0 - forms[3]);
                let mut size = degree.map(|d| d + 1);
                size[*axis] = 1;
                Self::Sheet { forms, net: Net::Rectangle(tensor(size)) }
            }
            Reference3::Tetrahedra(points, all) => {
                let forms = |t: &[usize; 4]| barycentric(t.map(|i| points[i].extend(1.0)));
                let delta = |t: &[usize; 4]| (0..4).map(|k| forms(t)[k] * values[t[k]]).sum();
                Self::Tetrahedra(all.iter().map(|t| (forms(t), delta(t))).collect())
            }
        }
    }

    /// Returns δ and its gradient at `p`. They are not finite where the ray of a point does not meet the plane of a sheet.
    pub(super) fn jet(&self, p: DVec3) -> (f64, DVec3) {
        match self {
            Self::Tetrahedron { forms, terms } => {
                let (value, slope) = terms.jet(forms.map(|f| f.dot(p.extend(1.0))));
                (value, (0..4).map(|a| forms[a].truncate() * slope[a]).sum())
            }
            Self::Sheet { forms, net } => {
                let [u, v, w, sum] = forms.map(|f| f.dot(p.extend(1.0)));
                if sum.is_nan() || sum <= 0.0 {
                    return (f64::NAN, DVec3::NAN);
                }
                let u = [u, v, w].map(|u| u / sum);
                let (value, slope) = net.jet(u);
                // ∂(u'ᵢ/Σ) = (∇u'ᵢ − uᵢ·∇Σ)/Σ.
                let g = forms.map(DVec4::truncate);
                (value, (0..3).map(|a| (g[a] - g[3] * u[a]) * (slope[a] / sum)).sum())
            }
            Self::Cuboid { local, tensor } => {
                let [[value, x, y, z]] = tensor.jet(local.coordinates(p));
                (value, DVec3::new(x, y, z) * local.scale)
            }
            Self::Tetrahedra(all) => {
                let around = all.iter().find(|t| t.0.iter().all(|f| signed_side(f, p) >= 0.0));
                around.map_or((1.0, DVec3::ZERO), |(_, delta)| (delta.dot(p.extend(1.0)), delta.truncate()))
            }
        }
    }

    /// Returns the degree of δ over the reference.
    pub(super) fn degree(&self) -> usize {
        match self {
            Self::Tetrahedron { terms, .. } | Self::Sheet { net: Net::Triangle(terms), .. } => terms.degree,
            Self::Cuboid { tensor, .. } | Self::Sheet { net: Net::Rectangle(tensor), .. } => {
                tensor.degrees().iter().sum()
            }
            Self::Tetrahedra(_) => 1,
        }
    }

    /// Returns δ as a quotient of two polynomials.
    pub(super) fn fraction(&self, chart: &Chart) -> (Poly3, Poly3) {
        match self {
            Self::Tetrahedron { forms, terms } => {
                (terms.in_terms_of(&forms.map(|f| chart.linear(f))), Poly3::constant(1.0))
            }
            Self::Sheet { forms, net } => {
                let [u, v, w, sum] = forms.map(|f| chart.linear(f));
                let total = self.degree();
                let denominators = sum.powers(total);
                let delta = match net {
                    Net::Triangle(terms) => terms.in_terms_of(&[u, v, w, Poly3::default()]),
                    Net::Rectangle(tensor) => {
                        let powers = [u, v, w].map(|u| u.powers(total));
                        let mut delta = Poly3::default();
                        for ([i, j, k], [c]) in tensor.terms() {
                            let product = powers[0][i].times(&powers[1][j]).times(&powers[2][k]);
                            delta.add(*c, &product.times(&denominators[total - i - j - k]));
                        }
                        delta
                    }
                };
                (delta, denominators[total].clone())
            }
            Self::Cuboid { local, tensor } => {
                let [delta] = tensor.in_terms_of(&chart.local(local));
                (delta, Poly3::constant(1.0))
            }
            // Not used: the map takes the linear form of the tetrahedron that contains a part.
            Self::Tetrahedra(_) => (Poly3::constant(1.0), Poly3::constant(1.0)),
        }
    }

    /// Returns δ at `p`.
    pub(super) fn value(&self, p: DVec3) -> f64 {
        match self {
            Self::Cuboid { local, tensor } => tensor.value(local.coordinates(p).to_array())[0],
            _ => self.jet(p).0,
        }
    }

    /// Returns linear forms in (x, y, z, 1) that are nonnegative inside the reference, or inside the pyramid of a sheet's rays.
    pub(super) fn sides(&self, reference: &Reference3) -> Vec<DVec4> {
        match self {
            Self::Tetrahedron { forms, .. } if matches!(reference, Reference3::Prism(..)) => {
                forms.iter().copied().chain([DVec4::W - forms[3]]).collect()
            }
            Self::Tetrahedron { forms, .. } => forms.to_vec(),
            Self::Sheet { forms, net: Net::Triangle(_) } => forms[..3].to_vec(),
            Self::Sheet { forms, .. } => (0..3).flat_map(|a| [forms[3] + forms[a], forms[3] - forms[a]]).collect(),
            Self::Cuboid { .. } => {
                let (Reference3::Cuboid(b, _) | Reference3::Spline(b, ..)) = reference else { return Vec::new() };
                let side = |a: usize, sign: f64, at: f64| (DVec3::AXES[a] * sign).extend(-sign * at);
                (0..3).flat_map(|a| [side(a, 1.0, b.min[a]), side(a, -1.0, b.max[a])]).collect()
            }
            Self::Tetrahedra(_) => Vec::new(),
        }
    }

    /// Returns δ of the tetrahedron that contains a box, or 1 if none touches it. `None` if a face may cross it, or for another kind of δ.
    pub(super) fn around(&self, corners: &[DVec3; 8]) -> Option<DVec4> {
        let Self::Tetrahedra(all) = self else { return None };
        let inside = |f: &DVec4| corners.iter().all(|p| signed_side(f, *p) >= 0.0);
        let behind = |f: &DVec4| corners.iter().all(|p| signed_side(f, *p) <= 0.0);
        match all.iter().find(|t| t.0.iter().all(inside)) {
            Some((_, delta)) => Some(*delta),
            None => all.iter().all(|t| t.0.iter().any(behind)).then_some(DVec4::W),
        }
    }

    /// Returns δ as a linear form in (x, y, z, 1), if its degree makes it one.
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

    /// Returns `true` if δ is constant along rays.
    pub(super) fn is_sheet(&self) -> bool {
        matches!(self, Self::Sheet { .. })
    }
}
