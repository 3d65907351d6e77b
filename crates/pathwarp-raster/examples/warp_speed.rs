//! Times warping a 4000 × 4000 bitmap by birational maps of degree 1×3. Can also write the inverse maps to files, for other programs
//! to sample by:
//!
//! `cargo run --release -p pathwarp-raster --example warp_speed [FOLDER]`
//!
//! With FOLDER, writes `source.rgba` and two files per map: `NAME.rgba`, the result, and `NAME.f32`, the source point of each pixel, by
//! rows from the top: x and y as little-endian 32-bit floats, with pixel centres at integers. `warp_opencv.py` beside this file reads
//! them. Times are CPU times where `/proc` has them; `RAYON_NUM_THREADS=1` uses one thread.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a benchmark that prints to the terminal")]

use kurbo::{Affine, Point, Rect};
use pathwarp::deform::Registry;
use pathwarp::map::Map;
use pathwarp::param::{Args, Frame};
use pathwarp_raster::{ImageWarp, Pixmap, shown, warp_image};
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;

const SIDE: u32 = 4000;
const RUNS: usize = 7;

/// Names, points of both rows, and the part of the plane that the result shows.
const MAPS: [(&str, &str, &str, Rect); 3] = [
    (
        "grows",
        "-600,-400 1600,-1300 3400,1200 5200,-300",
        "-400,5000 1300,5600 3000,4000 5000,5200",
        Rect::new(0.0, 0.0, 4000.0, 4000.0),
    ),
    (
        "shrinks a little",
        "0,300 1300,100 2700,600 4000,200",
        "100,3800 1350,4000 2650,3500 3900,3900",
        Rect::new(0.0, 0.0, 4000.0, 4000.0),
    ),
    (
        "strong",
        "0,400 1200,-1000 2800,1200 4000,200",
        "200,3600 1400,4400 2400,2800 3800,4000",
        Rect::new(0.0, -200.0, 4000.0, 3900.0),
    ),
];

fn main() {
    let area = Rect::new(0.0, 0.0, f64::from(SIDE), f64::from(SIDE));
    let mut source = Pixmap::new(SIDE, SIDE).unwrap();
    for (i, byte) in source.data_mut().iter_mut().enumerate() {
        *byte = if i % 4 == 3 { 255 } else { rings(i / 4, i % 4) };
    }
    let folder = std::env::args().nth(1);
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder).unwrap();
        std::fs::write(Path::new(folder).join("source.rgba"), source.data()).unwrap();
    }
    for (name, top, bottom, target) in MAPS {
        let mut args = Args::new();
        args.push("top", top);
        args.push("bottom", bottom);
        let built = Registry::builtin().get("birational").unwrap().build_from(&args, &Frame::new(area)).unwrap();
        let inverse = built.map.inverse().unwrap();
        let warp = ImageWarp {
            source: &source,
            placed: Affine::IDENTITY,
            map: &*built.map,
            inverse: &*inverse,
            shown: shown(target, (SIDE, SIDE)),
            size: (SIDE, SIDE),
        };
        let mut times: Vec<f64> = (0..RUNS)
            .map(|_| {
                let started = cpu_time();
                let out = warp_image(&warp).unwrap();
                let elapsed = cpu_time() - started;
                assert!(out.pixels().iter().any(|p| p.alpha() > 0));
                elapsed
            })
            .collect();
        times.sort_by(f64::total_cmp);
        println!("{name}: {:.3} s (least {:.3})", times[RUNS / 2], times[0]);
        if let Some(folder) = &folder {
            write_points(&Path::new(folder).join(format!("{name}.f32")), &*inverse, warp.shown);
            std::fs::write(Path::new(folder).join(format!("{name}.rgba")), warp_image(&warp).unwrap().data()).unwrap();
        }
    }
}

/// Rings whose period falls to two pixels in the far corner, different in each channel, so that sparse sampling shows. `r2` counts periods.
fn rings(pixel: usize, channel: usize) -> u8 {
    let (x, y) = ((pixel % SIDE as usize) as f64, (pixel / SIDE as usize) as f64);
    let r2 = (x * x + y * y) / (4.0 * f64::from(SIDE) * std::f64::consts::SQRT_2);
    (127.5 + 120.0 * (2.0 * std::f64::consts::PI * r2 + channel as f64).cos()) as u8
}

/// CPU time of this process in seconds; elapsed time where that is unknown.
fn cpu_time() -> f64 {
    /// Clock ticks per second, on every Linux.
    const TICKS: f64 = 100.0;
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let stat = std::fs::read_to_string("/proc/self/stat").ok();
    let ticks = stat.and_then(|s| {
        let mut fields = s.rsplit(')').next()?.split_whitespace().skip(11);
        Some(fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?)
    });
    ticks.map_or_else(|| START.get_or_init(Instant::now).elapsed().as_secs_f64(), |t| t / TICKS)
}

/// Writes the source point of every pixel.
fn write_points(file: &Path, inverse: &dyn Map, shown: Affine) {
    let mut out = BufWriter::new(std::fs::File::create(file).unwrap());
    for (j, i) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (j, i))) {
        let p = inverse.point(shown * Point::new(f64::from(i) + 0.5, f64::from(j) + 0.5));
        for v in [p.x, p.y] {
            out.write_all(&((v - 0.5) as f32).to_le_bytes()).unwrap();
        }
    }
}
