//! A drawing is read, warped and drawn: any bytes are rejected or give a drawing that can be read and drawn again.
//!
//! The first byte chooses the map and the options, the others are the file.

#![no_main]

use pathwarp::refit::Nodes;
use libfuzzer_sys::fuzz_target;
use pathwarp::deform::Registry;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame};
use pathwarp::recipe::{BuiltRecipe, Recipe, Step};
use pathwarp::refit;
use pathwarp_engine::bitmap::Bender;
use pathwarp_fuzz::{bounded, let_libraries_panic, limits};
use pathwarp_raster::{RenderOptions, Size};
use pathwarp_svg::{
    Document, Gradients, Images, OnError, PageFit, Painter, Patterns, ReadOptions, Selection, Strokes, Structure, WarpOptions,
    usvg_tree,
};
use std::sync::Arc;

/// Deformations of all kinds: affine, lines kept, exact, smooth, with creases, with poles, repeating.
const STEPS: [(&str, &[(&str, &str)]); 8] = [
    ("swirl", &[]),
    ("affine", &[("rotate", "30"), ("scale-x", "-2")]),
    ("projective", &[("target", "0%,100% 100%,80% 90%,20% 0%,0%")]),
    ("warp", &[("style", "flag")]),
    ("wave", &[]),
    ("expr", &[("x", "x+100/(y-31)"), ("y", "y+abs(x-20)")]),
    ("bend", &[("along", "circle:r=40"), ("repeat", "2")]),
    ("mls", &[("pair", "10,10:20,30"), ("pin", "80,80")]),
];

fn built(choice: u8, document: &Document) -> Option<BuiltRecipe> {
    let (name, args) = STEPS[usize::from(choice) % STEPS.len()];
    let recipe = Recipe { steps: vec![Step::new(name, Args::from_pairs(args))] };
    let rect = document.seen_box(&Selection::default()).unwrap_or(Rect::new(0.0, 0.0, 100.0, 100.0));
    let outlines: Vec<_> = document.selected(&Selection::default()).map(|s| &*s.outline).collect();
    recipe.build(&Registry::builtin(), Frame::new(rect), &outlines.iter().copied()).ok()
}

fn options(choice: u8, built: &BuiltRecipe, document: &Document) -> WarpOptions {
    let bender = Arc::new(Bender::new(Arc::new(built.map.clone()), None).with_limits(limits()));
    let size = document.view_box().size().to_vec2().hypot();
    let refit = refit::Options::new(1e-3 * size.clamp(1.0, 1e6))
        .with_nodes(if choice & 8 != 0 { Nodes::Fewest } else { Nodes::Source })
        .with_budget(document.budget().clone());
    let bit = |n: u8| choice & n != 0;
    WarpOptions::new(refit)
        .with_on_error(OnError::Skip)
        .with_strokes(if bit(16) { Strokes::Outline } else { Strokes::Auto })
        .with_structure(if bit(32) { Structure::Flatten } else { Structure::Auto })
        .with_gradients(if bit(64) { Gradients::Exact } else { Gradients::Fit })
        .with_painter(Some(Painter::new(bender.clone())))
        .with_patterns(if bit(64) { Patterns::Instantiate } else { Patterns::Auto })
        .with_page(if bit(128) { PageFit::Grow } else { PageFit::None })
        .with_images(if bit(64) { Images::Warp(bender) } else { Images::Keep })
        .with_copies(built.placement.copies.clone())
}

fn draw(document: &Document) {
    let options = RenderOptions { size: Size::Width(48), background: None };
    let _ = usvg_tree::with_stack(document, || Ok(options.render_within(usvg_tree::tree(document), &limits()).is_ok()));
}

fn warp(choice: u8, data: &[u8]) {
    let reading = ReadOptions::default().with_limits(limits()).with_system_fonts(false);
    let Ok(document) = Document::read(data, "in.svg", &reading) else { return };
    draw(&document);
    let _ = (document.paths().len(), document.plot().is_ok());
    let Some(built) = built(choice, &document) else { return };
    let Ok(warped) = document.warp(&built.map, &options(choice, &built, &document)) else { return };
    for shape in &warped.shapes {
        assert!(shape.max_error >= 0.0, "{shape:?}");
    }
    // The result may hold more than the small limits allow.
    let larger = ReadOptions::default().with_system_fonts(false);
    match Document::read(warped.svg.as_bytes(), "out.svg", &larger) {
        Ok(again) => draw(&again),
        Err(e) => assert!(e.to_string().contains("limit"), "the result cannot be read: {e}\n{}", warped.svg),
    }
}

fuzz_target!(
    init: let_libraries_panic(),
    |data: &[u8]| {
        if let Some((&choice, drawing)) = data.split_first() {
            bounded(|| warp(choice, drawing));
        }
    }
);
