//! Chooses the patterns whose tiles are bent one by one.

use super::bends::{Bend, Bends};
use super::options::{Patterns, Strokes};
use super::paint;
use crate::scene::drawing::Drawing;
use crate::scene::resolve::{Painted, Tiling};
use pathwarp::Error;
use pathwarp::kurbo::{Affine, Rect};

/// Lays out pattern tiles as geometry if they are to be warped one by one. Returns `None` if nothing changes.
pub(crate) fn laid_out(drawing: &Drawing, bends: &Bends<'_>) -> Result<Option<Drawing>, Error> {
    /// Visible error as a fraction of the page's diagonal: half a pixel if the page is drawn a thousand pixels across.
    const VISIBLE: f64 = 5e-4;
    let patterns = bends.options.patterns;
    if matches!(patterns, Patterns::Fit | Patterns::Keep) || drawing.scene().tiles.is_empty() {
        return Ok(None);
    }
    let view = drawing.view_box();
    let visible = VISIBLE * view.width().hypot(view.height());
    let shows = |bend: &Bend<'_>, area: Rect, frame: Affine| {
        let follows = || paint::fit(area, frame, Affine::IDENTITY, bend.map).is_some_and(|f| f.miss <= visible);
        patterns == Patterns::Instantiate || bend.options.copies.len() > 1 || !follows()
    };
    let needed = |painted: Painted, area: Rect, frame: Affine| {
        let bend = match painted {
            Painted::Element(e) => bends.of(e),
            Painted::Mask(bend) => bend.or(Some(0)),
        };
        bend.and_then(|k| bends.each.get(k)).is_some_and(|bend| shows(bend, area, frame))
    };
    let strokes = matches!(bends.options.strokes, Strokes::Auto | Strokes::Outline);
    drawing.tiled(Tiling::new(&needed, strokes)).map(Some)
}
