//! Bends a path with a custom map and prints statistics.
//!
//! `cargo run --example refit`

#![allow(clippy::print_stdout)]

use pathwarp::map::{Formula, Real};
use pathwarp::refit::{Options, warp_path};
use pathwarp::{Error, Outline};

/// A flag in the wind. The formula is evaluated with dual numbers, so its derivatives come for free.
struct Flag;

impl Formula for Flag {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x, y + (x / 40.0).sin() * 8.0)
    }
}

fn main() -> Result<(), Error> {
    let path = Outline::from_svg("M10 10H190V110H10Z M100 30A30 30 0 0 1 100 90A30 30 0 0 1 100 30Z")?;
    for tolerance in [1.0, 0.1, 0.01] {
        let warped = warp_path(&path, &Flag, &Options::new(tolerance))?;
        let r = &warped.report;
        println!("within {tolerance}: {} segments from {}, error {:.2e}", r.segments_out, r.segments_in, r.max_error);
    }
    println!("{}", warp_path(&path, &Flag, &Options::new(0.1))?.path.to_svg());
    Ok(())
}
