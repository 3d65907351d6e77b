//! Draws the line around the visible artwork.

use super::bends::Bends;
use super::options::Edit;
use super::outcome::{ShapeReport, WarpedDocument};
use super::path::warp_path;
use super::united::AREA_SHARE;
use super::visible::Visible;
use crate::scene::drawing::Drawing;
use pathwarp::edit::{Contour, around};
use pathwarp::engine::decimal::trimmed;
use pathwarp::kurbo::Rect;
use pathwarp::map::AffineMap;
use pathwarp::{Error, Outline};

/// A line around artwork, in root user space.
#[derive(Debug)]
pub(crate) struct Line {
    pub(crate) data: String,
    pub(crate) bounds: Rect,
    /// Path data and bounds of the line to which the artwork's colours are continued.
    pub(crate) bled: Option<(String, Rect)>,
}

/// Draws the line, if one is wanted, and reports it.
pub(super) fn draw(
    drawing: &Drawing,
    bends: &Bends<'_>,
    part_bends: &[Option<usize>],
    out: &mut WarpedDocument,
) -> Result<Option<Line>, Error> {
    let requested = bends.each.iter().enumerate().find_map(|(k, b)| match b.options.edit {
        Some(Edit::Contour(contour)) => Some((k, contour, &b.options)),
        _ => None,
    });
    let Some((k, contour, options)) = requested else { return Ok(None) };
    let parts: Vec<bool> = part_bends.iter().map(|bend| *bend == Some(k)).collect();
    let bitmaps: Vec<bool> =
        drawing.scene().bitmaps.iter().map(|b| b.bends && bends.bend_of(b.owner) == Some(k)).collect();
    let (painter, tolerance) = (options.painter.as_ref(), AREA_SHARE * options.refit.tolerance);
    let visible = Visible { drawing, parts: &parts, bitmaps: &bitmaps, painter, tolerance };
    let area = visible.area().map_err(Error::Geometry)?;
    if area.is_empty() {
        return Err(Error::input(&drawing.name, "there is nothing to draw a line around: nothing is visible"));
    }
    let line = |by: f64| {
        let around = around(&area, &Contour { by, ..contour }, &options.refit)?;
        let path = warp_path(&around.outline, &AffineMap::IDENTITY, &options.refit, options.precision)?;
        Ok((around, path.data))
    };
    let (around, data) = line(contour.by).map_err(Error::Geometry)?;
    let Some(bounds) = bounds(&around.outline) else {
        let by = trimmed(-contour.by, 3);
        let why = format!("nothing is left {by} units inside the edge; the artwork is narrower");
        return Err(Error::input(&drawing.name, why));
    };
    let bleed = options.line.bleed;
    let bled = (bleed > 0.0).then(|| line(contour.by + bleed)).transpose().map_err(Error::Geometry)?;
    out.shapes.push(ShapeReport::new("the contour", around.islands, around.report));
    let bled = bled.and_then(|(around, data)| Some((data, self::bounds(&around.outline)?)));
    Ok(Some(Line { data, bounds, bled }))
}

fn bounds(outline: &Outline) -> Option<Rect> {
    outline.bounding_box().filter(|_| !outline.is_empty())
}
