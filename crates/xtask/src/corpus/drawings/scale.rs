//! The scales at which pictures are drawn.

use pathwarp_svg::{Document, usvg_tree};

/// Longest side of a picture in pixels.
pub(super) const SIDE: f64 = 300.0;
/// Longest side of an unreduced picture of a whole drawing, in pixels.
const LARGE: f64 = 2400.0;
/// Least width of a stroke, in drawn pixels, for the renderer to draw it by coverage; it pales thinner strokes instead.
const WIDE: f64 = 1.1;
/// A lower bound of the smallest stretch of the affine map.
const SQUEEZE: f64 = 0.6;
/// Oversampling of pictures of a bent drawing. The renderer divides a pixel's edge into four and draws a stroke's edge to a
/// quarter of a pixel, so edges in the same place may differ by a fifth of all levels.
const OVERSAMPLING: u32 = 3;
/// Oversampling of pictures that must agree pixel by pixel. It averages out aliased edges of circles and the corners of dashes,
/// which the renderer also draws to a quarter of a pixel, to within a few levels.
const FINE_OVERSAMPLING: u32 = 8;
/// Largest magnification before single precision becomes visible.
const MOST_MAGNIFICATION: f64 = 400.0;

/// Scales in pixels per px.
pub(super) struct Scales {
    /// Scale of the whole picture.
    pub(super) whole: f64,
    /// Scale at which the thinnest stroke is wide enough.
    pub(super) needed: f64,
    /// Oversampling of both.
    pub(super) oversampling: u32,
}

impl Scales {
    /// The scales for a drawing that is drawn at `least` or larger.
    pub(super) fn new(document: &Document, least: f64) -> Self {
        let size = document.size_px();
        let oversampling = if has_filters(document) { OVERSAMPLING } else { FINE_OVERSAMPLING };
        let largest = LARGE / f64::from(oversampling) / size.width.max(size.height);
        let thinnest = thinnest(usvg_tree::tree(document).root()).unwrap_or(f64::INFINITY);
        let needed = (WIDE / (SQUEEZE * thinnest) / f64::from(oversampling)).max(least);
        Self { whole: needed.min(largest), needed: needed.min(MOST_MAGNIFICATION * largest), oversampling }
    }
}

/// Oversampling of pictures of a bent drawing. Filters take too long on large pictures.
pub(super) fn oversampling(document: &Document) -> u32 {
    if has_filters(document) { 1 } else { OVERSAMPLING }
}

fn has_filters(document: &Document) -> bool {
    !usvg_tree::tree(document).filters().is_empty()
}

/// The width of the thinnest stroke in px.
fn thinnest(group: &usvg::Group) -> Option<f64> {
    let of = |node: &usvg::Node| match node {
        usvg::Node::Group(g) => thinnest(g),
        usvg::Node::Text(t) => thinnest(t.flattened()),
        usvg::Node::Path(p) => p.stroke().map(|s| {
            let (x, y) = p.abs_transform().get_scale();
            f64::from(s.width().get() * x.min(y))
        }),
        usvg::Node::Image(_) => None,
    };
    group.children().iter().filter_map(of).filter(|w| *w > 0.0).min_by(f64::total_cmp)
}
