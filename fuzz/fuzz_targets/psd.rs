//! Photoshop files: any bytes are rejected or give warps, each of which builds a map or is refused.

#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame};
use pathwarp::recipe::{Recipe, Step};
use pathwarp::refit::Options;
use pathwarp_fuzz::{bounded, check_built};
use std::sync::LazyLock;

/// Most layers that are tried: damaged files list thousands.
const MOST: usize = 4;

static REGISTRY: LazyLock<Registry> = LazyLock::new(Registry::builtin);
static PATH: LazyLock<Outline> = LazyLock::new(|| Outline::from_svg_lossy("M10 10C40 0 60 30 90 10V60L10 60Z"));

fn read(data: &[u8]) {
    let Ok(warps) = pathwarp_psd::warps(data) else { return };
    let text = serde_json::to_string(&warps).expect("warps are JSON");
    let params = REGISTRY.get("mesh").map_or(&[][..], |e| e.info().params);
    for layer in warps.warps.iter().take(MOST) {
        let mut args = Args::from_pairs(&[("psd", "f.psd"), ("layer", &layer.layer)]);
        args.resolve_files(params, |_| Ok(text.clone())).expect("it is given");
        let recipe = Recipe { steps: vec![Step::new("mesh", args)] };
        let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
        if let Ok(built) = recipe.build(&REGISTRY, frame, &std::iter::once(&*PATH)) {
            check_built(&PATH, &built, &Options::new(0.1));
        }
    }
}

fuzz_target!(|data: &[u8]| bounded(|| read(data)));
