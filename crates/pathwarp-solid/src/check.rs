//! Checks the properties that every deformation of space must have.
//!
//! [`entry`] checks the parameter table, Jacobians against finite differences, batches, inverses, laws and cases.

use crate::deform::{Deformation3, Law3};
use crate::map::{Creases3, Jet3, Map3, NewtonInverse3};
use crate::settings::{Box3, Frame3, grid, show};
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
        let args = written(case.args);
        match build(entry, case.args) {
            Ok(map) => {
                let (at, to) = (DVec3::from_array(case.at), DVec3::from_array(case.to));
                let got = map.point(at);
                let off = got.distance(to);
                if off.is_nan() || off > case.tolerance {
                    let [at, got, to] = [at, got, to].map(show);
                    faults.push(format!("{args} takes {at} to {got}, {off:.1e} away from {to}"));
                }
            }
            Err(e) => faults.push(format!("{args} does not build: {e}")),
        }
    }
    faults.iter().map(|f| format!("{}: {f}", info.name)).collect()
}

/// Writes values for messages, as `name=value` one after another.
fn written(pairs: Pairs) -> String {
    pairs.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(" ")
}

fn build(entry: &dyn Deformation3, pairs: Pairs) -> Result<Arc<dyn Map3>, pathwarp::Error> {
    entry.build_from(&Args::from_pairs(pairs), &frame()).map(|b| b.map)
}

/// Returns points of the frame at which the map is defined: a grid of 6 by 6 by 6, whose odd coordinates avoid likely creases.
fn samples(map: &dyn Map3) -> Vec<DVec3> {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let point = |n: [usize; 3]| DVec3::from_array(n.map(|i| 4.3 + 15.1 * i as f64)) + DVec3::new(0.0, 1.1, 2.3);
    grid([6; 3]).map(point).filter(|p| creases.defined_at(*p)).collect()
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
        let at = show(*p);
        if !j.is_finite() {
            faults.push(format!("is not finite at {at}"));
            continue;
        }
        let size = 1.0 + j.p.length();
        if q.distance(j.p) > 1e-12 * size || map.point(*p).distance(*q) > 1e-12 * size {
            faults.push(format!("single and batched values differ at {at}"));
        }
        for (axis, e) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            if creases.separate(*p + e * H, *p - e * H) {
                continue;
            }
            let slope = (map.point(*p + e * H) - map.point(*p - e * H)) / (2.0 * H);
            let column = j.d.col(axis);
            if slope.distance(column) > 1e-5 * (1.0 + column.length()) {
                let [stated, measured] = [column, slope].map(show);
                faults.push(format!("derivative {axis} at {at}: {stated}, differences give {measured}"));
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
            faults.push(format!("the inverse takes the image of {} to {}", show(p), show(q)));
        }
        let both = map.jet(p).then(&back.jet(map.point(p)));
        let off = (both.d - glam::DMat3::IDENTITY).to_cols_array().into_iter().fold(0.0, |a: f64, v| a.max(v.abs()));
        if off.is_nan() || off > 1e-6 {
            faults.push(format!("the inverse's Jacobian at the image of {} is off by {off:.1e}", show(p)));
        }
    }
}

/// Returns the distance of `b` from the line through `a` and `c`.
fn off_line(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    (b - a).cross((c - a).normalize_or_zero()).length()
}

/// Returns the distance of the image of a point in a triangle with the corner `p` from the plane of the corners' images.
fn off_plane(m: &dyn Map3, p: DVec3) -> f64 {
    let corners = [p, DVec3::new(97.0 - p.x, 11.0, p.z), DVec3::new(p.y, 90.0, 45.0)];
    let [a, b, c] = corners.map(|p| m.point(p));
    let inner = 0.5 * corners[0] + 0.3 * corners[1] + 0.2 * corners[2];
    (m.point(inner) - a).dot((b - a).cross(c - a).normalize_or_zero()).abs()
}

fn check_law(entry: &dyn Deformation3, law: &Law3, faults: &mut Vec<String>) {
    const NEAR: f64 = 1e-9;
    let (name, pairs) = match *law {
        Law3::Identity(pairs) => ("identity", pairs),
        Law3::Same(pairs, _) => ("same", pairs),
        Law3::KeepsPlanes(pairs) => ("keeps planes", pairs),
        Law3::KeepsLinesAlong(pairs, _) => ("keeps lines along", pairs),
        Law3::KeepsRays(pairs, _) => ("keeps rays", pairs),
        Law3::FixedOutside(pairs, _) => ("fixed outside", pairs),
        Law3::Volume(pairs, _) => ("volume", pairs),
    };
    let mut map_of = |pairs: Pairs| {
        let built = build(entry, pairs);
        if let Err(e) = &built {
            faults.push(format!("{} does not build: {e}", written(pairs)));
        }
        built.ok()
    };
    let Some(m) = map_of(pairs) else { return };
    let worst = |f: &dyn Fn(DVec3) -> f64| {
        samples(&*m).into_iter().map(f).fold(0.0, |a: f64, v| if v.is_nan() { f64::INFINITY } else { a.max(v) })
    };
    let (off, limit) = match *law {
        Law3::Identity(_) => (worst(&|p| m.point(p).distance(p)), NEAR),
        Law3::Same(_, other) => {
            let Some(other) = map_of(other) else { return };
            (worst(&|p| m.point(p).distance(other.point(p))), NEAR)
        }
        Law3::KeepsPlanes(_) => (worst(&|p| off_plane(&*m, p)), NEAR),
        Law3::KeepsLinesAlong(_, along) => {
            let step = DVec3::from_array(along).normalize_or_zero() * 9.0;
            (worst(&|p| off_line(m.point(p), m.point(p + 0.4 * step), m.point(p + step))), NEAR)
        }
        Law3::KeepsRays(_, eye) => {
            let eye = DVec3::from_array(eye);
            (worst(&|p| off_line(eye, m.point(p), p) / (1.0 + m.point(p).length())), 1e-12)
        }
        Law3::FixedOutside(_, [a, b]) => {
            let inside = Box3::new(DVec3::from_array(a), DVec3::from_array(b));
            let moved = worst(&|p| m.point(p).distance(p));
            let outside = worst(&|p| if inside.contains(p) { 0.0 } else { m.point(p).distance(p) });
            // A map that moves nothing at all tests nothing.
            (if moved > 0.0 { outside } else { f64::INFINITY }, 0.0)
        }
        Law3::Volume(_, factor) => (worst(&|p| (m.jet(p).det() - factor).abs()), NEAR * (1.0 + factor.abs())),
    };
    if off > limit {
        faults.push(format!("{}: the law `{name}` does not hold, off by {off:.1e}", written(pairs)));
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
