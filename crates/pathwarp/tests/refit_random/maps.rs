//! Random maps for the tests of segments and of merged paths.

use crate::support::Bicubic;
use pathwarp::map::{Formula, Real};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Control nets from the identity to folded over.
pub(crate) fn map() -> impl Strategy<Value = Bicubic> {
    (prop::array::uniform32(-1.0..1.0f64), prop_oneof![Just(0.0), Just(30.0), Just(150.0), Just(500.0)])
        .prop_map(|(d, size)| Bicubic::moved(|i, j| (size * d[2 * (4 * i + j)], size * d[2 * (4 * i + j) + 1])))
}

/// Waves in both directions: a map that declares nothing about itself.
#[derive(Debug, Clone)]
pub(crate) struct Waves {
    pub(crate) length: [f64; 2],
    pub(crate) height: [f64; 2],
    pub(crate) phase: [f64; 2],
}

impl Formula for Waves {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let wave = |i: usize, t: S| (t * (TAU / self.length[i]) + self.phase[i]).sin() * self.height[i];
        (x + wave(0, y), y + wave(1, x))
    }
}
