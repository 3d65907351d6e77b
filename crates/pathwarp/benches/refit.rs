//! `cargo bench -p pathwarp --bench refit`: pieces and time compared with kurbo's `fit_to_bezpath` and `fit_to_bezpath_opt`, with
//! exact derivatives, on the same segments in the same run.
//!
//! Data: `corpus/icons.txt`, written by `cargo xtask corpus`, or else a few built-in paths. All figures are per source segment.
//! Times are medians over interleaved rounds, so that a slow spell of the machine affects all alike.
//! `EVERY=n` measures every n-th path (default 8; 1 measures all), `OPT=0` skips `fit_to_bezpath_opt`.

#![allow(clippy::print_stdout, missing_docs)]

use kurbo::{CurveFitSample, ParamCurveFit, Point, Vec2, fit_to_bezpath, fit_to_bezpath_opt};
use pathwarp::map::Map;
use pathwarp::refit::{Nodes, Options, warp_path};
use pathwarp::{Outline, Seg};
use pathwarp_oracle::{BOX, Bicubic, Rational};
use std::hint::black_box;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// A segment's image with exact derivatives, for kurbo.
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

/// Runs `f`. Returns the nanoseconds it takes divided by `n`, and its result.
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

/// Heading of the table.
const HEADING: [&str; 15] = [
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
    "n/opt",
];

fn main() {
    let (all, fetched) = pathwarp_oracle::corpus();
    let outlines: Vec<Outline> = all.into_iter().step_by(if fetched { env("EVERY", 8) } else { 1 }).collect();
    let segs: Vec<Seg> = outlines.iter().flat_map(Outline::segs).copied().collect();
    let source = if fetched { "icons" } else { "built-in samples (run `cargo xtask corpus` for the icons)" };
    println!("{} segments of {} {source}", segs.len(), outlines.len());
    let maps: [(&str, Box<dyn Map>); 3] = [
        ("mild", Box::new(Bicubic::mild())),
        ("strong", Box::new(Bicubic::strong())),
        ("rational", Box::new(Rational::new())),
    ];
    let [name, counts @ .., c0, c1, c2, c3, r0, r1, r2, n0, n1] = HEADING;
    print!("{name:<16}");
    counts.iter().for_each(|c| print!(" {c:>7}"));
    println!(" | {c0:>7} {c1:>7} {c2:>9} {c3:>9} {r0:>7} {r1:>7} {r2:>6} | {n0:>6} {n1:>6}");
    for (name, map) in &maps {
        let map: &dyn Map = map.as_ref();
        let (lo, hi) = determinants(map);
        println!("-- {name}: det J {lo:.3}..{hi:.3}");
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            BenchRow::measure(&outlines, &segs, map, tolerance).print(&format!("{name} {tolerance}"));
        }
    }
}

/// Figures per source segment: ours, certified, merged, kurbo's, and kurbo's optimum.
struct BenchRow {
    pieces: [f64; 5],
    /// Nanoseconds; merging is not timed.
    ns: [f64; 5],
}

impl BenchRow {
    fn measure(outlines: &[Outline], segs: &[Seg], map: &dyn Map, tolerance: f64) -> Self {
        let n = segs.len();
        let ours = |o: &Options| {
            // What all passes take together is more than one run may.
            let o = &o.clone().with_budget(Arc::default());
            outlines.iter().map(|p| warp_path(p, map, o).map_or(0, |w| w.report.segments_out)).sum::<usize>()
        };
        let plain = Options::new(tolerance).with_nodes(Nodes::Source);
        let certify = plain.clone().with_certify(true);
        let theirs = |f: &dyn Fn(&Image<'_>) -> kurbo::BezPath| {
            segs.iter().map(|seg| f(&Image { seg, map }).elements().len() - 1).sum::<usize>()
        };
        let mut times: [Vec<f64>; 3] = Default::default();
        let mut counts = [0; 5];
        for _ in 0..7 {
            // Several passes of ours take about as long as one of kurbo's.
            let (a, k0) = timed(5 * n, || (0..5).fold(0, |_, _| ours(&plain)));
            let (b, k1) = timed(2 * n, || (0..2).fold(0, |_, _| ours(&certify)));
            let (c, k3) = timed(n, || theirs(&|i| fit_to_bezpath(i, tolerance)));
            for (t, v) in times.iter_mut().zip([a, b, c]) {
                t.push(v);
            }
            (counts[0], counts[1], counts[3]) = (k0, k1, k3);
        }
        counts[2] = ours(&plain.clone().with_nodes(Nodes::Fewest));
        let mut opt = f64::NAN;
        if env("OPT", 1) == 1 {
            (opt, counts[4]) = timed(n, || theirs(&|i| fit_to_bezpath_opt(i, tolerance)));
        }
        let [a, b, c] = times.map(median);
        Self { pieces: counts.map(|k| k as f64 / n as f64), ns: [a, b, f64::NAN, c, opt] }
    }

    fn print(&self, name: &str) {
        let [a, b, _, c, opt] = self.ns;
        let [ours, .., kurbo, best] = self.pieces;
        print!("{name:<16}");
        self.pieces.iter().for_each(|p| print!(" {p:>7.4}"));
        println!(
            " | {a:>7.0} {b:>7.0} {c:>9.0} {opt:>9.0} {:>7.1} {:>7.1} {:>6.0} | {:>6.3} {:>6.3}",
            c / a,
            c / b,
            opt / a,
            ours / kurbo,
            ours / best,
        );
    }
}
