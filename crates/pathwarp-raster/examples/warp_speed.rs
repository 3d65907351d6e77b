//! How long a 4000 × 4000 bitmap takes through a birational map: `cargo run --release --example warp_speed`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a measurement for the terminal")]

use kurbo::{Affine, Rect};
use pathwarp::deform::Registry;
use pathwarp::param::{Args, Frame};
use pathwarp_raster::{ImageWarp, Pixmap, extent, shown, warp_image};
use std::time::Instant;

fn main() {
    const SIDE: u32 = 4000;
    let area = Rect::new(0.0, 0.0, f64::from(SIDE), f64::from(SIDE));
    let mut source = Pixmap::new(SIDE, SIDE).unwrap();
    for (i, byte) in source.data_mut().iter_mut().enumerate() {
        *byte = if i % 4 == 3 { 255 } else { (i / 4 % 251) as u8 };
    }
    let mut args = Args::new();
    args.push("top", "0,400 1200,-1000 2800,1200 4000,200");
    args.push("bottom", "200,3600 1400,4400 2400,2800 3800,4000");
    let built = Registry::builtin().get("birational").unwrap().build_from(&args, &Frame::new(area)).unwrap();
    let inverse = built.map.inverse().unwrap();
    let bounds = extent(area, Affine::IDENTITY, &*built.map, Affine::IDENTITY).unwrap().bounds;
    let warp = ImageWarp {
        source: &source,
        placed: Affine::IDENTITY,
        map: &*built.map,
        inverse: &*inverse,
        shown: shown(bounds, (SIDE, SIDE)),
        size: (SIDE, SIDE),
    };
    for _ in 0..3 {
        let started = Instant::now();
        let out = warp_image(&warp).unwrap();
        println!("{:.3} s, {} pixels painted", started.elapsed().as_secs_f64(), {
            out.pixels().iter().filter(|p| p.alpha() > 0).count()
        });
    }
}
