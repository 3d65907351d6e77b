//! `cargo bench -p pathwarp --bench refit`: pieces and time against kurbo's `fit_to_bezpath` and `fit_to_bezpath_opt`, which get
//! exact derivatives, in the same run on the same segments.
//!
//! Data: `corpus/icons.txt`, written by `cargo xtask corpus`; without it a few paths of the project's own. Every number is per
//! source segment; times are medians over interleaved rounds, so that a slow spell of the machine hits all alike.
//! `EVERY=n` measures each n-th path (default 8; 1 is all of them), `OPT=0` leaves `fit_to_bezpath_opt` out.

#![allow(clippy::print_stdout, missing_docs)]

mod support;

use kurbo::{CurveFitSample, ParamCurveFit, Point, Vec2, fit_to_bezpath, fit_to_bezpath_opt};
use pathwarp::map::Map;
use pathwarp::refit::{Options, warp_path};
use pathwarp::{Outline, Seg};
use std::hint::black_box;
use std::ops::Range;
use std::time::Instant;
use support::{BOX, Bicubic, Rational};

/// A segment's image, as kurbo wants it: points and exact derivatives.
struct Image<'a> {
    seg: &'a Seg,
    map: &'a dyn Map,
}

impl ParamCurveFit for Image<'_> {
    fn sample_pt_tangent(&self, t: f64, sign: f64) -> CurveFitSample {
        let (p, mut tangent) = self.sample_pt_deriv(t);
        if tangent.hypot2() < 1e-18 {
            tangent = self.sample_pt_deriv((t + sign * 1e-6).clamp(0.0, 1.0)).1;
        }
        CurveFitSample { p, tangent }
    }

    fn sample_pt_deriv(&self, t: f64) -> (Point, Vec2) {
        let j = self.map.jet(self.seg.eval(t));
        (j.p, j.push(self.seg.deriv(t)))
    }

    fn break_cusp(&self, _: Range<f64>) -> Option<f64> {
        None
    }
}

/// Nanoseconds `f` takes for each of `n`.
fn timed(n: usize, mut f: impl FnMut() -> usize) -> (f64, usize) {
    let start = Instant::now();
    let out = black_box(f());
    (start.elapsed().as_nanos() as f64 / n as f64, out)
}

fn median(mut v: Vec<f64>) -> f64 {
    v.sort_by(f64::total_cmp);
    v.get(v.len() / 2).copied().unwrap_or(f64::NAN)
}

fn env(name: &str, default: usize) -> usize {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

fn determinants(map: &dyn Map) -> (f64, f64) {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..=100 {
        for j in 0..=100 {
            let d = map.jet(Point::new(BOX * f64::from(i) / 100.0, BOX * f64::from(j) / 100.0)).det();
            range = (range.0.min(d), range.1.max(d));
        }
    }
    range
}

fn main() {
    let (all, fetched) = support::corpus();
    let outlines: Vec<Outline> = all.into_iter().step_by(if fetched { env("EVERY", 8) } else { 1 }).collect();
    let segs: Vec<Seg> = outlines.iter().flat_map(Outline::segs).copied().collect();
    let n = segs.len();
    let source = if fetched { "icons" } else { "own samples (run `cargo xtask corpus` for the icons)" };
    println!("{n} segments of {} {source}", outlines.len());
    let maps: [(&str, Box<dyn Map>); 3] = [
        ("mild", Box::new(Bicubic::mild())),
        ("strong", Box::new(Bicubic::strong())),
        ("rational", Box::new(Rational::new())),
    ];
    println!(
        "{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} | {:>7} {:>7} {:>9} {:>9} {:>7} {:>7} {:>6} | {:>6} {:>6}",
        "map, tolerance",
        "ours",
        "cert",
        "merged",
        "kurbo",
        "opt",
        "ns ours",
        "cert",
        "kurbo",
        "opt",
        "k/ours",
        "k/cert",
        "opt/o",
        "n/k",
        "n/opt"
    );
    let with_opt = env("OPT", 1) == 1;
    for (name, map) in &maps {
        let map: &dyn Map = map.as_ref();
        let (lo, hi) = determinants(map);
        println!("-- {name}: det J {lo:.3}..{hi:.3}");
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            let ours = |o: &Options| {
                outlines.iter().map(|p| warp_path(p, map, o).map_or(0, |w| w.report.segments_out)).sum::<usize>()
            };
            let plain = Options::new(tolerance);
            let certify = plain.clone().with_certify(true);
            let merge = plain.clone().with_merge(true);
            let theirs = |f: &dyn Fn(&Image<'_>) -> kurbo::BezPath| {
                segs.iter().map(|seg| f(&Image { seg, map }).elements().len() - 1).sum::<usize>()
            };
            let kurbo = |i: &Image<'_>| fit_to_bezpath(i, tolerance);
            let opt = |i: &Image<'_>| fit_to_bezpath_opt(i, tolerance);
            let mut times: [Vec<f64>; 3] = Default::default();
            let mut counts = [0; 5];
            for _ in 0..7 {
                // Ours is short: several passes make a measurement as long as kurbo's.
                let (a, k0) = timed(5 * n, || (0..5).fold(0, |_, _| ours(&plain)));
                let (b, k1) = timed(2 * n, || (0..2).fold(0, |_, _| ours(&certify)));
                let (c, k2) = timed(n, || theirs(&kurbo));
                for (t, v) in times.iter_mut().zip([a, b, c]) {
                    t.push(v);
                }
                (counts[0], counts[1], counts[3]) = (k0, k1, k2);
            }
            counts[2] = ours(&merge);
            let mut opt_ns = f64::NAN;
            if with_opt {
                (opt_ns, counts[4]) = timed(n, || theirs(&opt));
            }
            let [a, b, c] = times.map(median);
            let per = |k: usize| k as f64 / n as f64;
            println!(
                "{:<16} {:>7.4} {:>7.4} {:>7.4} {:>7.4} {:>7.4} | {a:>7.0} {b:>7.0} {c:>9.0} {opt_ns:>9.0} {:>7.1} {:>7.1} {:>6.0} | {:>6.3} {:>6.3}",
                format!("{name} {tolerance}"),
                per(counts[0]),
                per(counts[1]),
                per(counts[2]),
                per(counts[3]),
                per(counts[4]),
                c / a,
                c / b,
                opt_ns / a,
                counts[0] as f64 / counts[3] as f64,
                counts[0] as f64 / counts[4] as f64,
            );
        }
    }
}
