//! Several tetrahedra in one step: continuous free-form deformation (D. Bechmann, Y. Bertrand, S. Thery, 1997).
//!
//! Every corner has one δ for all tetrahedra that share it, and δ is linear in each of them, so that it is continuous across their
//! common faces. Outside nothing moves: there the map tears unless the corners of the outer faces stay.

use super::dilation::Dilation3;
use super::{Eye3, RadialInverse, RadialMap, Reference3};
use crate::deform::entry::Built3;
use crate::map::{Chart, Collineation, Creases3, Fraction3, Jet3, Map3};
use crate::settings::{Box3, show};
use glam::DVec3;
use pathwarp::Error;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Highest number of tetrahedra.
const MAX_TETRAHEDRA: usize = 1000;

/// Tetrahedra, each with the map inside of it.
#[derive(Debug, Clone)]
struct Tetrahedra(Arc<[RadialMap]>);

/// Builds the map of tetrahedra, whose corners are numbers of `points`, for δ at the points.
pub(super) fn build(
    eye: Eye3,
    base: DVec3,
    points: &[DVec3],
    tetrahedra: &[[usize; 4]],
    values: &[f64],
) -> Result<Built3, Error> {
    let text = |t: &[usize; 4]| t.map(|i| i.to_string()).join(",");
    if tetrahedra.len() > MAX_TETRAHEDRA {
        return Err(Error::usage("tetrahedra", "", format!("are more than {MAX_TETRAHEDRA}")));
    }
    let mut maps: Vec<RadialMap> = Vec::new();
    let mut faces: BTreeMap<[usize; 3], usize> = BTreeMap::new();
    for t in tetrahedra {
        let reference = Reference3::new(&t.map(|i| points[i]), [1; 3], eye)
            .map_err(|_| Error::usage("tetrahedra", text(t), "has its four corners in one plane, or one twice"))?;
        // The order of the nodes is that of the corners.
        let own = t.map(|i| values[i]);
        let dilation = Dilation3::new(&reference, eye, &own);
        let within = Some(dilation.sides(&reference).into());
        let range = own.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        maps.push(RadialMap { eye, base, dilation, within, range });
        for k in 0..4 {
            let mut face: Vec<usize> = (0..4).filter(|i| *i != k).map(|i| t[i]).collect();
            face.sort_unstable();
            *faces.entry([face[0], face[1], face[2]]).or_default() += 1;
        }
    }
    for (i, t) in tetrahedra.iter().enumerate() {
        let middle = t.iter().map(|k| points[*k]).sum::<DVec3>() * 0.25 + base;
        if let Some(k) = (0..maps.len()).find(|k| *k != i && maps[*k].moves(middle)) {
            let problem = format!("lies in {}, at {}; let them share faces", text(&tetrahedra[k]), show(middle));
            return Err(Error::usage("tetrahedra", text(t), problem));
        }
    }
    let named = |wanted: &dyn Fn(&[usize; 3], usize) -> bool| {
        let found = faces.iter().filter(|(f, n)| wanted(f, **n));
        found.map(|(f, _)| f.map(|i| i.to_string()).join(",")).collect::<Vec<_>>().join(" ")
    };
    let shared = named(&|_, n| n > 1);
    let torn = named(&|face, n| n == 1 && face.iter().any(|i| values[*i] != 1.0));
    let mut built = Built3::new(Arc::new(Tetrahedra(maps.into())));
    built.note(format!("{} tetrahedra, continuous across the faces {shared}", tetrahedra.len()));
    if !torn.is_empty() {
        built.note(format!("outer faces with corners that move, at which a model that crosses them is torn: {torn}"));
    }
    for (p, delta) in points.iter().zip(values).filter(|(_, v)| **v != 1.0) {
        built.guides.push([eye.before(*p, 0.0), *p, eye.moved(*p, *delta)].map(|q| q + base).to_vec());
    }
    Ok(built)
}

impl Tetrahedra {
    fn around(&self, p: DVec3) -> Option<&RadialMap> {
        self.0.iter().find(|t| t.moves(p))
    }

    /// Returns the tetrahedron that contains a box, or `None` in it if all are outside; `None` if a face may cross it.
    fn around_box(&self, on: &Box3) -> Option<Option<&RadialMap>> {
        let mut out = true;
        for t in self.0.iter() {
            match t.moves_on(on) {
                Some(true) => return Some(Some(t)),
                Some(false) => {}
                None => out = false,
            }
        }
        out.then_some(None)
    }
}

impl Map3 for Tetrahedra {
    fn jet(&self, p: DVec3) -> Jet3 {
        self.around(p).map_or_else(|| Jet3::identity(p), |t| t.jet(p))
    }

    fn point(&self, p: DVec3) -> DVec3 {
        self.around(p).map_or(p, |t| t.point(p))
    }

    fn fraction(&self, on: &Box3, most: usize) -> Option<Fraction3> {
        self.around_box(on)?.map_or_else(|| Some(Fraction3::identity(Chart::on(on))), |t| t.fraction(on, most))
    }

    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        self.around_box(on)?.map_or_else(|| Some(Arc::new(Collineation::IDENTITY) as _), |t| t.branch(on))
    }

    fn creases(&self, out: &mut Creases3) {
        self.0.iter().for_each(|t| t.creases(out));
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(Back(self.clone())))
    }

    fn work(&self) -> f64 {
        self.0.len() as f64
    }
}

/// The inverse.
#[derive(Debug, Clone)]
struct Back(Tetrahedra);

impl Back {
    fn source(&self, q: DVec3) -> Option<DVec3> {
        let inner = self.0.0.iter().find_map(|t| RadialInverse(t.clone()).inner(q));
        inner.or_else(|| self.0.around(q).is_none().then_some(q))
    }
}

impl Map3 for Back {
    fn jet(&self, q: DVec3) -> Jet3 {
        self.source(q).map_or(Jet3::UNDEFINED, |p| Jet3 { p, d: self.0.jet(p).d.inverse() })
    }

    fn point(&self, q: DVec3) -> DVec3 {
        self.source(q).unwrap_or(DVec3::NAN)
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(self.0.clone()))
    }

    fn work(&self) -> f64 {
        8.0 * self.0.0.len() as f64
    }
}
