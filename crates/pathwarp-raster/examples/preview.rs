//! Draws a preview of two drawings with overlays: `cargo run --example preview -- BEFORE.svg AFTER.svg OUT.png [KIND=PATH…]`.
//!
//! `KIND` is `cage`, `base`, `target`, `anchors` or `grid`; the path is SVG path data. Targets are drawn on the right panel.

use kurbo::{Affine, BezPath, Rect};
use pathwarp_raster::{OverlayKind, Panel, Preview, PreviewOverlay, encode_png};
use std::{error::Error, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [before, after, out, overlays @ ..] = args.as_slice() else {
        return Err("usage: preview BEFORE.svg AFTER.svg OUT.png [KIND=PATH…]".into());
    };
    let read = |file: &str| -> Result<usvg::Tree, Box<dyn Error>> {
        Ok(usvg::Tree::from_str(&fs::read_to_string(file)?, &usvg::Options::default())?)
    };
    let (before, after) = (read(before)?, read(after)?);
    let (mut left, mut right) = (panel(&before), panel(&after));
    for overlay in overlays {
        let (kind, path) = overlay.split_once('=').ok_or("an overlay is KIND=PATH")?;
        let kind = match kind {
            "cage" => OverlayKind::Cage,
            "base" => OverlayKind::Base,
            "target" => OverlayKind::Target,
            "anchors" => OverlayKind::Anchors,
            "grid" => OverlayKind::GridLines,
            other => return Err(format!("unknown overlay: {other}").into()),
        };
        let overlay = PreviewOverlay::new(kind, BezPath::from_svg(path)?);
        if kind == OverlayKind::Target {
            right = right.with(overlay);
        } else {
            left = left.with(overlay);
        }
    }
    fs::write(out, encode_png(&Preview::new(left, right).render()?)?)?;
    Ok(())
}

// The viewBox of the samples equals their width and height, so the page is in user units.
fn panel(tree: &usvg::Tree) -> Panel<'_> {
    let page = Rect::new(0.0, 0.0, f64::from(tree.size().width()), f64::from(tree.size().height()));
    Panel::new(tree, Affine::IDENTITY, page)
}
