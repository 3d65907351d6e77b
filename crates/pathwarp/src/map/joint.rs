//! Joints of strips F = C + v·S (+ w·T in space), checked by equations 4 and 5 of Y.-K. Chang and A. Rockwood, *A generalized de Casteljau
//! approach to 3D free-form deformation* (SIGGRAPH 1994).

/// A joint between pieces of a skeleton, and the kinks there of the skeleton and of lines beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The position of the joint, in words.
    position: String,
    /// The angle of the skeleton's kink, in radians.
    skeleton_kink: f64,
    /// The angle of the worst kink of a line beside the skeleton, in radians.
    worst_kink: f64,
    /// `true` if derivatives are continuous, not only directions.
    is_c1: bool,
}

impl Joint {
    /// Up to this angle, in radians, a kink is invisible.
    const INVISIBLE: f64 = 5e-3;

    /// Compares derivatives along lines before and after a joint. `lines` begins with the skeleton, followed by lines beside it; lines
    /// that run backwards lie on a fold and are left out.
    #[must_use]
    pub fn new<const D: usize>(position: String, lines: &[[[f64; D]; 2]]) -> Self {
        let dot = |p: &[f64; D], q: &[f64; D]| p.iter().zip(q).map(|(a, b)| a * b).sum::<f64>();
        let distance = |p: &[f64; D], q: &[f64; D]| p.iter().zip(q).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let unit = |p: &[f64; D]| p.map(|v| v / dot(p, p).sqrt());
        let kink = |[p, q]: &[[f64; D]; 2]| 2.0 * (0.5 * distance(&unit(p), &unit(q))).min(1.0).asin();
        let runs_forward = |l: &&[[f64; D]; 2]| l.iter().all(|p| dot(p, &lines[0][0]) > 0.0);
        let forward = || lines.iter().filter(runs_forward);
        let is_equal = |[p, q]: &[[f64; D]; 2]| distance(p, q) <= 1e-6 * (dot(p, p).sqrt() + dot(q, q).sqrt());
        let worst_kink = forward().map(kink).fold(0.0, f64::max);
        Self { position, skeleton_kink: kink(&lines[0]), worst_kink, is_c1: forward().all(is_equal) }
    }

    /// Returns `true` if the skeleton is smooth and lines beside it are not.
    fn kinks(&self) -> bool {
        self.skeleton_kink <= Self::INVISIBLE && self.worst_kink > Self::INVISIBLE
    }

    /// Describes the joint in a sentence.
    #[must_use]
    pub fn described(&self) -> String {
        let what = match self {
            _ if self.skeleton_kink > Self::INVISIBLE => "C⁰: a corner",
            _ if self.kinks() => {
                "G¹ on the skeleton only: beside it, lines along the skeleton have a kink (handles condition)"
            }
            _ if self.is_c1 => "C¹: smooth",
            _ => "G¹: directions are continuous, but lengths are stretched differently on both sides",
        };
        format!("joint at {} is {what}", self.position)
    }

    /// Returns a warning about the joints with kinks beside a smooth skeleton, if there are any.
    #[must_use]
    pub fn warning(joints: &[Self]) -> Option<String> {
        let kinks = || joints.iter().filter(|j| j.kinks());
        let worst = kinks().reduce(|a, b| if b.worst_kink > a.worst_kink { b } else { a })?;
        Some(format!(
            "bend: beside the skeleton, lines along it have kinks at {} of {} joints, the worst of {:.1}° at {}: the handles \
on both sides of a smooth joint must change alike (equations 4 and 5 of the paper); default handles do",
            kinks().count(),
            joints.len(),
            worst.worst_kink.to_degrees(),
            worst.position
        ))
    }
}
