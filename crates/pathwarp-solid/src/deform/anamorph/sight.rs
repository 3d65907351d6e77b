//! The rod that makes a sighting hole: cut out of a printed model, it leaves a hole through which only an eye at the right point sees
//! (figure 10 of the paper).

use super::Eye3;
use crate::deform::entry::Built3;
use crate::settings::{Box3, grid};
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
const SAMPLES: usize = 5;

/// Returns the rod as OBJ: a prism around the ray from the eye through the middle of the model's box, long enough for the model and
/// its image.
pub(super) fn rod(eye: Eye3, bounds: &Box3, built: &Built3, name: &str) -> SavedFile {
    let (middle, size) = (bounds.center(), bounds.diagonal());
    let along = match eye {
        Eye3::At(eye) => (middle - eye).normalize_or(DVec3::Z),
        Eye3::Infinite(towards) => -towards,
    };
    let samples = grid([SAMPLES; 3]).map(|n| DVec3::from_array(n.map(|i| i as f64 / (SAMPLES - 1) as f64)));
    let points = samples.map(|t| bounds.min + bounds.size() * t).flat_map(|p| [p, built.map.point(p)]);
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
    let mut faces: Vec<Vec<usize>> = vec![(1..=SIDES).rev().collect(), (SIDES + 1..=2 * SIDES).collect()];
    faces.extend(
        (0..SIDES).map(|k| (k, (k + 1) % SIDES)).map(|(k, l)| vec![k + 1, l + 1, l + SIDES + 1, k + SIDES + 1]),
    );
    for face in faces {
        let _ = writeln!(text, "f {}", face.iter().map(usize::to_string).collect::<Vec<_>>().join(" "));
    }
    SavedFile { name: name.to_owned(), text }
}
