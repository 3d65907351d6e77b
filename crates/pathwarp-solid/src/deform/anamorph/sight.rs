//! The rod that makes a sighting hole: cut out of a printed model, it leaves a hole through which only an eye at the right point sees
//! (figure 10 of the paper).

use super::Eye3;
use crate::deform::entry::Built3;
use crate::settings::Box3;
use glam::DVec3;
use pathwarp::deform::SavedFile;
use std::fmt::Write as _;

/// Diameter of the rod, as a fraction of the model's diagonal.
const DIAMETER: f64 = 0.02;
/// Length of the rod before and behind the model and its image, as a fraction of the model's diagonal.
const BEYOND: f64 = 0.1;
/// Sides of the rod.
const SIDES: usize = 24;
/// Samples of the model's box along each axis.
const SAMPLES: u32 = 5;

/// Returns the rod as OBJ: a prism around the ray from the eye through the middle of the model's box, long enough for the model and
/// its image.
pub(super) fn rod(eye: Eye3, bounds: &Box3, built: &Built3, name: &str) -> SavedFile {
    let (middle, size) = (bounds.center(), bounds.diagonal());
    let along = match eye {
        Eye3::At(eye) => (middle - eye).normalize_or(DVec3::Z),
        Eye3::Infinite(towards) => -towards,
    };
    let share = |i: u32| f64::from(i) / f64::from(SAMPLES - 1);
    let grid =
        (0..SAMPLES.pow(3)).map(|i| DVec3::from([i, i / SAMPLES, i / SAMPLES.pow(2)].map(|k| share(k % SAMPLES))));
    let points = grid.map(|t| bounds.min + bounds.size() * t).flat_map(|p| [p, built.map.point(p)]);
    let depths = points.filter(|p| p.is_finite()).map(|p| (p - middle).dot(along));
    let (near, far) = depths.fold((0.0, 0.0), |(a, b): (f64, f64), d| (a.min(d), b.max(d)));
    let (across, up) = along.any_orthonormal_pair();
    let mut text = String::from("o sighting-hole\n");
    for depth in [near - BEYOND * size, far + BEYOND * size] {
        for k in 0..SIDES {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / SIDES as f64).sin_cos();
            let DVec3 { x, y, z } = middle + along * depth + (across * cos + up * sin) * (0.5 * DIAMETER * size);
            let _ = writeln!(text, "v {x} {y} {z}");
        }
    }
    let face = |corners: &mut dyn Iterator<Item = usize>| {
        format!("f{}\n", corners.map(|k| format!(" {k}")).collect::<String>())
    };
    text += &face(&mut (1..=SIDES).rev());
    text += &face(&mut (SIDES + 1..=2 * SIDES));
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        text += &face(&mut [k + 1, next + 1, next + SIDES + 1, k + SIDES + 1].into_iter());
    }
    SavedFile { name: name.to_owned(), text }
}
