//! JSON files of deformations: lattices, meshes, handles, styles, text shapes, Photoshop's warps. Any text is rejected or builds a
//! map that a path can be warped by.
//!
//! The first byte chooses the parameter that reads the file.

#![no_main]

use pathwarp::refit::Nodes;
use libfuzzer_sys::fuzz_target;
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame, Param};
use pathwarp::recipe::{Recipe, Step};
use pathwarp::refit::Options;
use pathwarp_fuzz::{bounded, check_built};
use std::sync::LazyLock;

/// A name that stands for the text, also for parameters that take names.
const FILE: &str = "f.json";

static REGISTRY: LazyLock<Registry> = LazyLock::new(Registry::builtin);
static PATH: LazyLock<Outline> =
    LazyLock::new(|| Outline::from_svg_lossy("M10 10C40 0 60 30 90 10V60A20 10 0 0 1 50 70L10 60Z"));

/// All parameters that read files, with their deformations' tables.
static READERS: LazyLock<Vec<(&'static str, &'static [Param], &'static str)>> = LazyLock::new(|| {
    let of = |name: &'static str, params: &'static [Param]| {
        params.iter().filter(|p| p.reads_file(FILE)).map(move |p| (name, params, p.name))
    };
    REGISTRY.entries().iter().flat_map(|e| of(e.info().name, e.info().params)).collect()
});

fn build(choice: u8, text: &str) {
    let (name, params, file) = READERS[usize::from(choice & 31) % READERS.len()];
    let mut args = Args::from_pairs(&[(file, FILE)]);
    if params.iter().any(|p| p.name == "along") {
        args.push("along", "M0 80C30 0 60 0 100 80");
    }
    if args.resolve_files(params, |_| Ok(text.to_owned())).is_err() {
        return;
    }
    let mut step = Step::new(name, args);
    step.inverse = choice & 128 != 0;
    let recipe = Recipe { steps: vec![step] };
    let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
    if let Ok(built) = recipe.build(&REGISTRY, frame, &std::iter::once(&*PATH)) {
        check_built(&PATH, &built, &Options::new(0.1).with_certify(choice & 32 != 0).with_nodes(if choice & 64 != 0 { Nodes::Fewest } else { Nodes::Source }));
    }
}

fuzz_target!(|data: &[u8]| {
    if let Some((&choice, text)) = data.split_first()
        && let Ok(text) = std::str::from_utf8(text)
    {
        bounded(|| build(choice, text));
    }
});
