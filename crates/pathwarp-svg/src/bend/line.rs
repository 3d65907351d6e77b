//! Draws the line around the visible artwork.

use super::bends::Bends;
use super::options::Edit;
use super::outcome::{ShapeReport, WarpedDocument};
use super::path::warp_path;
use super::visible::SelectedArt;
use crate::scene::drawing::Drawing;
use pathwarp::edit::{Contour, around};
use pathwarp::engine::decimal::trimmed;
use pathwarp::kurbo::Rect;
use pathwarp::map::AffineMap;
use pathwarp::{Error, Outline};

/// Fraction of the tolerance within which the visible area is found; the rest is for the line.
const FINE: f64 = 0.1;

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
    let wanted = bends.each.iter().enumerate().find_map(|(k, b)| match b.options.edit {
        Some(Edit::Contour(contour)) => Some((k, contour, &b.options)),
        _ => None,
    });
    let Some((k, contour, options)) = wanted else { return Ok(None) };
    let parts: Vec<bool> = part_bends.iter().map(|bend| *bend == Some(k)).collect();
    let bitmaps: Vec<bool> =
        drawing.scene().bitmaps.iter().map(|b| b.bends && bends.bend_of(b.owner) == Some(k)).collect();
    let fine = FINE * options.refit.tolerance;
    let art = SelectedArt { drawing, parts: &parts, bitmaps: &bitmaps, painter: options.painter.as_ref(), fine };
    let area = art.area().map_err(Error::Geometry)?;
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
        return Err(Error::input(
            &drawing.name,
            format!("nothing is left {by} units inside the edge; the artwork is narrower"),
        ));
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
