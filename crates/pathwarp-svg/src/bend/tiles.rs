//! Chooses the patterns whose tiles are bent one by one.

use super::options::{Patterns, Strokes, WarpOptions};
use super::paint;
use crate::scene::drawing::Drawing;
use crate::scene::resolve::Tiling;
use pathwarp::Error;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::map::Map;

/// Lays out pattern tiles as geometry if they are to be warped one by one. Returns `None` if nothing changes.
pub(crate) fn laid_out(drawing: &Drawing, map: &dyn Map, options: &WarpOptions) -> Result<Option<Drawing>, Error> {
    /// Visible error as a fraction of the page's diagonal: half a pixel if the page is drawn a thousand pixels across.
    const VISIBLE: f64 = 5e-4;
    let view = drawing.view_box();
    let visible = match options.patterns {
        Patterns::Fit | Patterns::Keep => return Ok(None),
        Patterns::Auto if options.copies.len() <= 1 => Some(VISIBLE * view.width().hypot(view.height())),
        Patterns::Auto | Patterns::Instantiate => None,
    };
    if drawing.scene().tiles.is_empty() {
        return Ok(None);
    }
    let strokes = matches!(options.strokes, Strokes::Auto | Strokes::Outline);
    let selected = options.selection.resolve(&drawing.source);
    let needed = |area: Rect, frame: Affine| {
        let follows = |v: f64| paint::fit(area, frame, Affine::IDENTITY, map).is_none_or(|f| f.miss <= v);
        !visible.is_some_and(follows)
    };
    drawing.tiled(Tiling::new(&needed, strokes, selected, options.selection.is_everything())).map(Some)
}
