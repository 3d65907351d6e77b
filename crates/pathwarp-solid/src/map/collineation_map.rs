//! Implements [`Map3`] for collineations. The domain is where the forms `positive` are positive.

use super::collineation::Collineation;
use crate::map::{Creases3, Jet3, Map3};
use glam::{DMat3, DVec3, DVec4};
use std::sync::Arc;

impl Map3 for Collineation {
    #[inline]
    fn point(&self, p: DVec3) -> DVec3 {
        let q = self.matrix * (p - self.about).extend(1.0);
        q.truncate() / q.w + self.about
    }

    fn jet(&self, p: DVec3) -> Jet3 {
        let q = self.matrix * (p - self.about).extend(1.0);
        let image = q.truncate() / q.w;
        // M·(p, 1) = (N, W) makes the image N/W, and d(N/W) = (dN − image·dW)/W.
        let column = |c: DVec4| (c.truncate() - image * c.w) / q.w;
        let m = &self.matrix;
        Jet3 { p: image + self.about, d: DMat3::from_cols(column(m.x_axis), column(m.y_axis), column(m.z_axis)) }
    }

    fn points(&self, ps: &mut [DVec3]) {
        if self.about == DVec3::ZERO {
            return crate::map::tensor::collineation(&self.matrix, ps);
        }
        ps.iter_mut().for_each(|p| *p = self.point(*p));
    }

    fn collineation(&self) -> Option<&Collineation> {
        Some(self)
    }

    fn creases(&self, out: &mut Creases3) {
        for form in &self.positive {
            let (form, about) = (*form, self.about);
            out.edge(move |p| form.dot((p - about).extend(1.0)));
        }
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        let back = self.matrix.inverse();
        if !back.is_finite() {
            return None;
        }
        // The image q of p has M⁻¹·(q, 1) = (p, 1)/W with W > 0. So at q, f(M⁻¹·(q, 1)) is positive where f(p, 1) is, and the last
        // coordinate, 1/W, is positive, too.
        let forms = self.positive.iter().map(|f| back.transpose() * *f);
        let last = back.row(3);
        let affine = last == DVec4::new(0.0, 0.0, 0.0, 1.0);
        let positive = if affine { forms.collect() } else { std::iter::once(last).chain(forms).collect() };
        Some(Arc::new(Self { matrix: back, positive, about: self.about }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;

    /// A perspective collineation [I 0; d d₀] about the origin.
    fn perspective(d: DVec3, d0: f64) -> Collineation {
        Collineation::new(DMat4::from_cols(
            DVec4::new(1.0, 0.0, 0.0, d.x),
            DVec4::new(0.0, 1.0, 0.0, d.y),
            DVec4::new(0.0, 0.0, 1.0, d.z),
            DVec4::new(0.0, 0.0, 0.0, d0),
        ))
    }

    #[test]
    fn composition_inverse_and_domain() {
        let (a, b) = (perspective(DVec3::new(0.1, 0.0, 0.05), 1.0), perspective(DVec3::new(-0.02, 0.3, 0.0), 0.7));
        let both = a.then(&b);
        let back = both.inverse().unwrap();
        let mut creases = Creases3::default();
        both.creases(&mut creases);
        assert_eq!(creases.items().len(), 2);
        for p in [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, 0.5, 0.1)] {
            let q = b.point(a.point(p));
            assert!((both.point(p) - q).length() < 1e-14 && (back.point(q) - p).length() < 1e-13);
            assert!(creases.defined_at(p));
            let j = both.jet(p);
            assert!((j.d - a.jet(p).then(&b.jet(a.point(p))).d).to_cols_array().iter().all(|v| v.abs() < 1e-14));
        }
        // Both denominators are negative at this point, so their product is positive although neither map is defined.
        let beyond = DVec3::new(-11.0, -1e3, 0.0);
        assert!(a.matrix.row(3).dot(beyond.extend(1.0)) < 0.0 && !creases.defined_at(beyond));
    }

    #[test]
    fn batches_agree_with_single_points() {
        let map = perspective(DVec3::new(0.1, -0.03, 0.05), 1.3);
        let ps: Vec<DVec3> =
            (0..37).map(|i| DVec3::new(f64::from(i), 0.3 * f64::from(i % 5), -0.1 * f64::from(i))).collect();
        let mut out = ps.clone();
        map.points(&mut out);
        assert!(ps.iter().zip(&out).all(|(p, q)| (map.point(*p) - *q).length() <= 1e-15 * (1.0 + q.length())));
    }
}
