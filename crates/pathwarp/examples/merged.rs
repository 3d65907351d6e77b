//! Fewer nodes than drawn: merges pieces across smooth joints.
//!
//! `cargo run --example merged`

#![allow(clippy::print_stdout)]

use pathwarp::map::{Formula, Real};
use pathwarp::outline::EllipticArc;
use pathwarp::refit::{Options, warp_path};
use pathwarp::{Error, Outline, Seg, Subpath};
use std::f64::consts::TAU;

struct Twist;

impl Formula for Twist {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let a = x.hypot(y) / 400.0;
        (x * a.cos() - y * a.sin(), x * a.sin() + y * a.cos())
    }
}

fn main() -> Result<(), Error> {
    // An ellipse written as forty arcs.
    let step = TAU / 40.0;
    let arc = |i: i32| {
        EllipticArc::new((0.0, 0.0).into(), (200.0, 0.0).into(), (0.0, 90.0).into(), f64::from(i) * step, step)
    };
    let segs: Vec<Seg> = (0..40).map(|i| Seg::Arc(arc(i))).collect();
    let start = segs.first().map(Seg::start).unwrap_or_default();
    let path = Outline { subpaths: vec![Subpath { start, segs, closed: true }] };
    for merge in [false, true] {
        let r = warp_path(&path, &Twist, &Options::new(0.05).with_merge(merge))?.report;
        println!("merge {merge}: {} segments from {}", r.segments_out, r.segments_in);
    }
    Ok(())
}
