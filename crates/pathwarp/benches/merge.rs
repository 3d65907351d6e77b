//! `cargo bench -p pathwarp --bench merge`: pieces and time with merging, as the command line runs by default, next to no merging.
//!
//! Data and maps are those of the `refit` benchmark; `PATHS=FILE` measures the path data in a file instead, a path a line.
//! *flag* is the warp of that name by 40 % over all of them. Times are medians over interleaved rounds, per source segment.
//! `EVERY=n` measures each n-th path (default 8; 1 is all of them); `ONLY="strong 0.1"` one row; `MODE=merged` (or `off`,
//! `certify`) one column, for profiling.

#![allow(clippy::print_stdout, missing_docs)]

use pathwarp::Outline;
use pathwarp::deform::{Style, Warp};
use pathwarp::engine::KnownShapes;
use pathwarp::map::Map;
use pathwarp::refit::{Nodes, Options};
use pathwarp_oracle::{Bicubic, Rational};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

const ROUNDS: usize = 3;

fn median(mut v: Vec<f64>) -> f64 {
    v.sort_by(f64::total_cmp);
    v.get(v.len() / 2).copied().unwrap_or(f64::NAN)
}

fn env(name: &str) -> String {
    std::env::var(name).unwrap_or_default()
}

fn main() {
    let every = env("EVERY").parse().unwrap_or(8);
    let file = env("PATHS");
    let (all, fetched) = if file.is_empty() {
        pathwarp_oracle::corpus()
    } else {
        (std::fs::read_to_string(file).unwrap_or_default().lines().map(Outline::from_svg_lossy).collect(), true)
    };
    let outlines: Vec<Outline> = all.into_iter().step_by(if fetched { every } else { 1 }).collect();
    let n = outlines.iter().flat_map(Outline::segs).count();
    println!("{n} segments of {} paths", outlines.len());
    println!(
        "{:<16} {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} {:>7} {:>7}",
        "map, tolerance", "off", "merged", "certify", "ns off", "merged", "certify", "m/off", "c/m"
    );
    let (only, mode) = (env("ONLY"), env("MODE"));
    let around = outlines.iter().filter_map(Outline::bounding_box).reduce(|a, b| a.union(b)).unwrap_or_default();
    let flag = Style::named("flag").and_then(|s| Warp::new(around, s).bend(0.4).build().ok());
    let mut maps: Vec<(&str, Arc<dyn Map>)> = vec![
        ("mild", Arc::new(Bicubic::mild())),
        ("strong", Arc::new(Bicubic::strong())),
        ("rational", Arc::new(Rational::new())),
    ];
    maps.extend(flag.map(|built| ("flag", built.map)));
    for (name, map) in &maps {
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            let row = format!("{name} {tolerance}");
            if !only.is_empty() && only != row {
                continue;
            }
            let off = Options::new(tolerance).with_nodes(Nodes::Source);
            let merge = off.clone().with_nodes(Nodes::Fewest);
            let certify = merge.clone().with_certify(true);
            let columns = [("off", &off), ("merged", &merge), ("certify", &certify)];
            let mut times: [Vec<f64>; 3] = Default::default();
            let mut counts = [0; 3];
            for _ in 0..env("ROUNDS").parse().unwrap_or(ROUNDS) {
                for (i, (column, options)) in columns.iter().enumerate() {
                    if !mode.is_empty() && mode != *column {
                        continue;
                    }
                    let start = Instant::now();
                    let known = KnownShapes::among(&outlines, map.as_ref(), options);
                    let warp =
                        |p: &Outline| known.warp_path(p, map.as_ref(), options).map_or(0, |w| w.report.segments_out);
                    counts[i] = black_box(outlines.iter().map(warp).sum());
                    times[i].push(start.elapsed().as_nanos() as f64 / n as f64);
                }
            }
            let [a, b, c] = times.map(median);
            let [ka, kb, kc] = counts.map(|k| k as f64 / n as f64);
            println!(
                "{:<16} {ka:>8.4} {kb:>8.4} {kc:>8.4} | {a:>8.0} {b:>8.0} {c:>8.0} {:>7.2} {:>7.2}",
                row,
                b / a,
                c / b
            );
        }
    }
}
