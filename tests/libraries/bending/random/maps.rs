//! Random maps for the tests of segments and of merged paths.

use pathwarp::map::{Formula, Real};
use pathwarp_oracle::Bicubic;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::TAU;

/// Returns a configuration with equal cases at every run; `PROPTEST_CASES` asks for others, and for their number. A case in tens of
/// thousands exceeds its tolerance (`docs/benchmarks.md`), independently of a change under test.
pub(crate) fn cases(cases: u32) -> ProptestConfig {
    const SEED: u64 = 20;
    let default = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    match std::env::var_os("PROPTEST_CASES") {
        Some(_) => default,
        None => ProptestConfig { cases, rng_seed: RngSeed::Fixed(SEED), ..default },
    }
}

/// Returns control nets from the identity to folded ones.
pub(crate) fn map() -> impl Strategy<Value = Bicubic> {
    (prop::array::uniform32(-1.0..1.0f64), prop_oneof![Just(0.0), Just(30.0), Just(150.0), Just(500.0)])
        .prop_map(|(d, size)| Bicubic::moved(|i, j| (size * d[2 * (4 * i + j)], size * d[2 * (4 * i + j) + 1])))
}

/// Waves in both directions: a map without any declaration.
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
