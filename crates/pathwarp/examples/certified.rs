//! Proves the error bound instead of measuring the error: the map declares that it is polynomial, and of which degree.
//!
//! `cargo run --example certified`

#![allow(clippy::print_stdout)]

use pathwarp::map::{Formula, RationalDegree, Real};
use pathwarp::refit::{Options, warp_path};
use pathwarp::{Error, Outline};

/// A bulge of degree four.
struct Bulge;

impl Formula for Bulge {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (u, v) = (x / 100.0, y / 100.0);
        let k = (u * u - 1.0) * (v * v - 1.0) * 0.4 + 1.0;
        (x * k, y * k)
    }

    // x·u²·v² is of degree five.
    fn rational_degree(&self) -> Option<RationalDegree> {
        Some(RationalDegree::polynomial(5))
    }
}

fn main() -> Result<(), Error> {
    let path = Outline::from_svg("M-80 0A80 80 0 0 1 80 0A80 80 0 0 1 -80 0Z M-60 -60L60 60")?;
    for certify in [false, true] {
        let r = warp_path(&path, &Bulge, &Options::new(0.01).with_certify(certify))?.report;
        println!("{:?}: {} segments, error at most {:.6}", r.assurance, r.segments_out, r.max_error);
    }
    Ok(())
}
