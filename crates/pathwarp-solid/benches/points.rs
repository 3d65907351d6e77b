//! Measures points per second of the maps in batches on one thread, and the deformation of a model of a million vertices from OBJ to
//! OBJ: `cargo bench -p pathwarp-solid`. Each figure is the best of several rounds over a million points. It is processor time, which
//! other programs on the machine disturb least, and stands beside the bytes read and written per second and the time of a plain copy
//! of the points.

#![allow(clippy::print_stdout)]

use cpu_time::{ProcessTime, ThreadTime};
use pathwarp::deform::Pairs;
use pathwarp::param::Args;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::mesh::{deform, obj};
use pathwarp_solid::{Box3, Frame3, map::Map3};
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::hint::black_box;

const POINTS: usize = 1_000_000;
const ROUNDS: usize = 40;

/// Returns the best time of a batch, in seconds.
fn best(points: &[DVec3], work: impl Fn(&mut [DVec3])) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let mut own = points.to_vec();
        let start = ThreadTime::now();
        work(black_box(&mut own));
        best = best.min(start.elapsed().as_secs_f64());
        black_box(own);
    }
    best
}

fn show(name: &str, seconds: f64) {
    let bytes = 2.0 * (POINTS * size_of::<DVec3>()) as f64;
    println!("{name:32} {:8.1} M points/s {:8.2} GB/s", POINTS as f64 / seconds / 1e6, bytes / seconds / 1e9);
}

/// Name, deformation and parameters of each case.
const CASES: [(&str, &str, Pairs); 11] = [
    (
        "collineation",
        "anamorph",
        &[("eye", "50,50,400"), ("reference", "0,0,0 100,0,0 0,100,0 0,0,100"), ("push", "0,0,0,1:1.5")],
    ),
    ("anamorphosis 2x2x2", "anamorph", &[("eye", "50,50,400"), ("push", "1,1,1:1.5")]),
    ("lattice 2x2x2", "ffd", &[("degree", "1"), ("move", "1,1,1:5,5,5")]),
    ("lattice 3x3x3", "ffd", &[("degree", "2"), ("move", "1,1,1:5,5,5")]),
    ("lattice 4x4x4", "ffd", &[("degree", "3"), ("move", "1,2,1:5,5,5")]),
    ("lattice 3x2x2", "ffd", &[("degree", "2x1x1"), ("move", "1,1,1:5,5,5")]),
    ("lattice 4x2x2", "ffd", &[("degree", "3x1x1"), ("move", "1,1,1:5,5,5")]),
    ("rational lattice 4x4x4", "ffd", &[("degree", "3"), ("move", "1,2,1:5,5,5"), ("weight", "1,2,1:2")]),
    ("bend of degree 1", "bend", &[("skeleton", "0,50,50 100,70,40")]),
    ("bend of degree 2", "bend", &[("skeleton", "0,50,50 50,50,50 100,70,40")]),
    ("bend of degree 3", "bend", &[("skeleton", "0,50,50 33,50,50 66,55,45 100,70,40")]),
];

/// Returns a bumpy ball of a million vertices and quads, as OBJ.
fn ball() -> String {
    const SIDE: usize = 1000;
    let mut out = String::new();
    for k in 0..SIDE * SIDE {
        let (a, b) = ((k % SIDE) as f64 * TAU / SIDE as f64, ((k / SIDE) as f64 + 0.5) * PI / SIDE as f64);
        let r = 50.0 + 2.0 * (9.0 * a).sin() * (7.0 * b).sin();
        let _ = writeln!(out, "v {:.6} {:.6} {:.6}", r * b.sin() * a.cos(), r * b.cos(), r * b.sin() * a.sin());
    }
    for k in 0..SIDE * (SIDE - 1) {
        let next = k - k % SIDE + (k + 1) % SIDE;
        let _ = writeln!(out, "f {} {} {} {}", k + 1, next + 1, next + SIDE + 1, k + SIDE + 1);
    }
    out
}

/// Reads, deforms and writes a model, and prints the processor time of all threads.
fn whole() {
    let text = ball();
    let mut best = [f64::INFINITY; 3];
    for _ in 0..7 {
        let start = ProcessTime::now();
        let Ok(mut mesh) = obj::read(text.as_bytes()) else { return };
        let read = start.elapsed().as_secs_f64();
        let frame = Frame3::new(mesh.bounds().unwrap_or(Box3::new(DVec3::ZERO, DVec3::ONE)));
        let registry = Registry3::builtin();
        let built = registry
            .get("ffd")
            .map(|e| e.build_from(&Args::from_pairs(&[("degree", "3"), ("move", "1,2,1:5,5,5")]), &frame));
        let Some(Ok(built)) = built else { return };
        let _ = black_box(deform(&mut mesh, &built.map));
        let deformed = start.elapsed().as_secs_f64();
        black_box(obj::write(&mesh, 7));
        let all = start.elapsed().as_secs_f64();
        for (b, t) in best.iter_mut().zip([read, deformed - read, all - deformed]) {
            *b = b.min(t);
        }
    }
    let [read, deformed, written] = best;
    println!(
        "OBJ of {} MB: read {read:.2} s, deformed {deformed:.2} s, written {written:.2} s of processor time",
        text.len() >> 20
    );
}

fn main() {
    whole();
    let frame = Frame3::new(Box3::new(DVec3::ZERO, DVec3::splat(100.0)));
    let at = |i: usize| DVec3::new((i % 97) as f64, (i % 89) as f64, (i % 83) as f64);
    let points: Vec<DVec3> = (0..POINTS).map(at).collect();
    show("copy", best(&points, |ps| ps.copy_from_slice(&points)));
    for (name, deformation, pairs) in CASES {
        let registry = Registry3::builtin();
        let built = registry.get(deformation).map(|e| e.build_from(&Args::from_pairs(pairs), &frame));
        if let Some(Ok(built)) = built {
            show(name, best(&points, |ps| built.map.points(ps)));
        }
    }
}
