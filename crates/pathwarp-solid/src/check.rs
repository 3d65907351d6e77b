//! Checks the properties that every deformation of space must have.
//!
//! [`entry`] checks the parameter table, Jacobians against finite differences, batches, inverses, laws and cases.

use crate::deform::{Deformation3, Law3};
use crate::map::{Creases3, Jet3, Map3, NewtonInverse3};
use crate::settings::{Box3, Frame3};
use glam::DVec3;
use pathwarp::deform::Pairs;
use pathwarp::param::Args;
use std::sync::Arc;

/// The frame of demos, laws and cases: the box from 0,0,0 to 100,100,100.
#[must_use]
pub fn frame() -> Frame3 {
    Frame3::new(Box3::new(DVec3::ZERO, DVec3::splat(100.0)))
}

/// Checks an entry, and returns its faults.
#[must_use]
pub fn entry(entry: &dyn Deformation3) -> Vec<String> {
    let info = &entry.about().info;
    let mut faults: Vec<String> = pathwarp::check::table(info).into_iter().flat_map(|c| c.faults).collect();
    match build(entry, info.demo) {
        Ok(map) => {
            derivatives(&*map, &mut faults);
            inverse(&map, &mut faults);
        }
        Err(e) => faults.push(format!("its demo does not build: {e}")),
    }
    for law in entry.about().laws {
        check_law(entry, law, &mut faults);
    }
    for case in entry.about().cases {
        match build(entry, case.args) {
            Ok(map) => {
                let got = map.point(DVec3::from_array(case.at));
                let off = got.distance(DVec3::from_array(case.to));
                if off.is_nan() || off > case.tolerance {
                    faults
                        .push(format!("{:?} takes {:?} to {got}, {off:e} away from {:?}", case.args, case.at, case.to));
                }
            }
            Err(e) => faults.push(format!("{:?} does not build: {e}", case.args)),
        }
    }
    faults.iter().map(|f| format!("{}: {f}", info.name)).collect()
}

fn build(entry: &dyn Deformation3, pairs: Pairs) -> Result<Arc<dyn Map3>, pathwarp::Error> {
    entry.build_from(&Args::from_pairs(pairs), &frame()).map(|b| b.map)
}

/// Returns points of the frame at which the map is defined, away from likely creases.
fn samples(map: &dyn Map3) -> Vec<DVec3> {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let at = |i: u32| 4.3 + 15.1 * f64::from(i);
    let grid = (0..216).map(|n| DVec3::new(at(n % 6), at(n / 6 % 6) + 1.1, at(n / 36) + 2.3));
    grid.filter(|p| creases.defined_at(*p)).collect()
}

fn derivatives(map: &dyn Map3, faults: &mut Vec<String>) {
    /// Step of central differences: their truncation error h² and rounding error ε/h are both near 1e-8 here.
    const H: f64 = 1e-4;
    let ps = samples(map);
    let (mut jets, mut points) = (vec![Jet3::default(); ps.len()], ps.clone());
    map.jets(&ps, &mut jets);
    map.points(&mut points);
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    for ((p, j), q) in ps.iter().zip(&jets).zip(&points) {
        if !j.is_finite() {
            faults.push(format!("is not finite at {p}"));
            continue;
        }
        let size = 1.0 + j.p.length();
        if q.distance(j.p) > 1e-12 * size || map.point(*p).distance(*q) > 1e-12 * size {
            faults.push(format!("single and batched values differ at {p}"));
        }
        for (axis, e) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            if creases.separate(*p + e * H, *p - e * H) {
                continue;
            }
            let slope = (map.point(*p + e * H) - map.point(*p - e * H)) / (2.0 * H);
            let own = j.d.col(axis);
            if slope.distance(own) > 1e-5 * (1.0 + own.length()) {
                faults.push(format!("derivative {axis} at {p}: {own}, differences give {slope}"));
            }
        }
    }
}

fn inverse(map: &Arc<dyn Map3>, faults: &mut Vec<String>) {
    let newton = || Arc::new(NewtonInverse3::new(Arc::clone(map), frame().bounds, 1.0, [4; 3])) as Arc<dyn Map3>;
    let back = map.inverse().unwrap_or_else(newton);
    for p in samples(&**map) {
        let q = back.point(map.point(p));
        if q.distance(p).is_nan() || q.distance(p) > 1e-8 * (1.0 + p.length()) {
            faults.push(format!("the inverse takes the image of {p} to {q}"));
        }
        let there = map.jet(p).then(&back.jet(map.point(p)));
        let off = (there.d - glam::DMat3::IDENTITY).to_cols_array().into_iter().fold(0.0, |a: f64, v| a.max(v.abs()));
        if off.is_nan() || off > 1e-6 {
            faults.push(format!("the inverse's Jacobian at the image of {p} is off by {off:e}"));
        }
    }
}

/// Returns the distance of `b` from the line through `a` and `c`.
fn off_line(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    (b - a).cross((c - a).normalize_or_zero()).length()
}

/// Returns the distance of the image of a point in a triangle from the plane of the corners' images.
fn off_plane(m: &dyn Map3, p: DVec3) -> f64 {
    let [a, b, c] = [p, DVec3::new(97.0 - p.x, 11.0, p.z), DVec3::new(p.y, 90.0, 45.0)].map(|p| m.point(p));
    let inner = 0.5 * p + 0.3 * DVec3::new(97.0 - p.x, 11.0, p.z) + 0.2 * DVec3::new(p.y, 90.0, 45.0);
    (m.point(inner) - a).dot((b - a).cross(c - a).normalize_or_zero()).abs()
}

fn check_law(entry: &dyn Deformation3, law: &Law3, faults: &mut Vec<String>) {
    const NEAR: f64 = 1e-9;
    let mut maps = |pairs: Pairs| {
        let built = build(entry, pairs);
        if let Err(e) = &built {
            faults.push(format!("{pairs:?} does not build: {e}"));
        }
        built.ok()
    };
    let worst = |map: &dyn Map3, f: &dyn Fn(DVec3) -> f64| {
        samples(map).into_iter().map(f).fold(0.0, |a: f64, v| if v.is_nan() { f64::INFINITY } else { a.max(v) })
    };
    let (off, limit) = match *law {
        Law3::Identity(pairs) => {
            let Some(m) = maps(pairs) else { return };
            (worst(&*m, &|p| m.point(p).distance(p)), NEAR)
        }
        Law3::Same(a, b) => {
            let Some((a, b)) = maps(a).zip(maps(b)) else { return };
            (worst(&*a, &|p| a.point(p).distance(b.point(p))), NEAR)
        }
        Law3::KeepsPlanes(pairs) => {
            let Some(m) = maps(pairs) else { return };
            (worst(&*m, &|p| off_plane(&*m, p)), NEAR)
        }
        Law3::KeepsLinesAlong(pairs, along) => {
            let Some(m) = maps(pairs) else { return };
            let step = DVec3::from_array(along).normalize_or_zero() * 9.0;
            (worst(&*m, &|p| off_line(m.point(p), m.point(p + 0.4 * step), m.point(p + step))), NEAR)
        }
        Law3::KeepsRays(pairs, eye) => {
            let Some(m) = maps(pairs) else { return };
            let eye = DVec3::from_array(eye);
            (worst(&*m, &|p| off_line(eye, m.point(p), p) / (1.0 + m.point(p).length())), 1e-12)
        }
        Law3::FixedOutside(pairs, [a, b]) => {
            let Some(m) = maps(pairs) else { return };
            let inside = Box3::new(DVec3::from_array(a), DVec3::from_array(b));
            let moved = worst(&*m, &|p| m.point(p).distance(p));
            let outside = worst(&*m, &|p| if inside.contains(p) { 0.0 } else { m.point(p).distance(p) });
            (if moved > 0.0 { outside } else { f64::INFINITY }, 0.0)
        }
        Law3::Volume(pairs, factor) => {
            let Some(m) = maps(pairs) else { return };
            (worst(&*m, &|p| (m.jet(p).det() - factor).abs()), NEAR * (1.0 + factor.abs()))
        }
    };
    if off > limit {
        faults.push(format!("{law:?} does not hold: off by {off:e}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Registry3;

    #[test]
    fn every_builtin_entry_is_sound() {
        for e in Registry3::builtin().entries() {
            let faults = entry(e.as_ref());
            assert!(faults.is_empty(), "{faults:#?}");
        }
    }

    /// On flat and huge models, every deformation gives a map or an error, and never panics.
    #[test]
    fn degenerate_frames_are_survived() {
        for size in [DVec3::ZERO, DVec3::new(100.0, 0.0, 50.0), DVec3::splat(1e-200), DVec3::splat(1e99)] {
            let frame = Frame3::new(Box3::new(DVec3::splat(5.0), DVec3::splat(5.0) + size));
            for e in Registry3::builtin().entries() {
                let Ok(b) = e.build_from(&Args::from_pairs(e.about().info.demo), &frame) else { continue };
                let mut creases = Creases3::default();
                b.map.creases(&mut creases);
                for p in [DVec3::ZERO, frame.bounds.max, DVec3::new(1e30, -1e30, 0.0)] {
                    let _ = (b.map.jet(p), b.map.point(p), creases.defined_at(p));
                    let _ = b.map.inverse().map(|m| m.jet(p));
                }
            }
        }
    }
}
