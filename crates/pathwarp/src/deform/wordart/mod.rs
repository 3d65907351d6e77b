//! Text warps: the forty shapes that office programs put words into.
//!
//! Each is two guide curves, or several pairs, between which the artwork is spanned (`map::ruled`), or guides
//! that it stands on. The curves and their adjust values are those of ECMA-376, Part 1, *presetTextWarpDefinitions* (the preset
//! text warps of DrawingML, `prstTxWarp`), written anew as data in `presets.json` ([`preset`]).

mod entry;
mod shape;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;
pub use shape::TextShape;

use super::bend::{Bend, Stretch};
use super::built::{Built, Role};
use crate::anchors;
use crate::error::{Error, GeometryError};
use crate::map::{AffineMap, Along, Class, Guide, Map, TileRow, Tiled, ruled};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::Frame;
use kurbo::{Affine, BezPath, Rect};
use shape::Guides;
use std::sync::Arc;

/// A text shape of office programs over the artwork's box: wave, chevron, arch, inflate, …
///
/// The box is spanned between the shape's guides by ruled maps, or stands on them, in one band or several.
///
/// ```
/// use pathwarp::{deform::{TextShape, WordArt}, kurbo::{Point, Rect}, map::Map};
///
/// let roof = WordArt::new(TextShape::named("triangle").unwrap(), Rect::new(0.0, 0.0, 100.0, 100.0)).build()?;
/// assert!(roof.map.point(Point::new(75.0, 50.0)).distance(Point::new(75.0, 62.5)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct WordArt {
    frame: Rect,
    shape: TextShape,
    /// A value for each of the shape's adjust values.
    adjusted: Vec<f64>,
    by_parameter: bool,
    split: Option<Vec<f64>>,
}

/// A point on a guide's curve is drawn within this share of the box's width and height.
const GUIDE_TOLERANCE: f64 = 1e-4;

impl WordArt {
    /// Creates the text shape with its default adjust values over the box `frame`.
    #[must_use]
    pub fn new(shape: TextShape, frame: Rect) -> Self {
        let adjusted = shape.adj.iter().map(|a| a.default).collect();
        Self { frame, shape, adjusted, by_parameter: false, split: None }
    }

    /// Sets the first adjust values, in the shape's order: lengths in 1/100000 of the box, angles in 1/60000 degree.
    #[must_use]
    pub fn adjust(mut self, values: &[f64]) -> Self {
        let missing = self.adjusted.get(values.len()..).unwrap_or_default();
        self.adjusted = values.iter().chain(missing).copied().collect();
        self
    }

    /// Runs by the guides' parameters, instead of evenly by length.
    #[must_use]
    pub fn by_parameter(self, by_parameter: bool) -> Self {
        Self { by_parameter, ..self }
    }

    /// Sets the y of the lines between bands, rising, one less than there are bands. Default: even.
    #[must_use]
    pub fn split(self, heights: &[f64]) -> Self {
        Self { split: Some(heights.to_vec()), ..self }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a flat box; [`Error::Usage`] for adjust values out of range, a wrong split, a wrong formula, or
    /// a guide that has no length in this box.
    pub fn build(&self) -> Result<Built, Error> {
        let Self { frame: rect, shape, adjusted, .. } = self;
        if !(rect.width() > 0.0 && rect.height() > 0.0) {
            return Err(GeometryError::FlatFrame { width: rect.width(), height: rect.height() }.into());
        }
        if let Some(extra) = adjusted.get(shape.adj.len()) {
            return Err(no_adjust_value(shape, &extra.to_string()));
        }
        for (a, value) in shape.adj.iter().zip(adjusted) {
            a.check(*value, &shape.name)?;
        }
        let wrong = |problem: String| Error::usage("preset", shape.name.clone(), problem);
        let guides = shape.guides(rect.width(), rect.height(), adjusted).map_err(|e| wrong(e.to_string()))?;
        let bands = match &guides {
            Guides::Between(b) => b.len(),
            Guides::Along(p) => p.len(),
        };
        let cuts = self.cuts(bands)?;
        let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
        let values = shape.adj.iter().zip(adjusted).map(|(a, v)| format!("{} {v}", a.name)).collect::<Vec<_>>();
        built.note(format!("text shape {}: {}, {bands} band(s)", shape.name, values.join(", ")));
        let rows = self.rows(guides, &cuts, &mut built)?;
        let map = rows.and_then(|rows| Tiled::over(*rect, cuts, rows));
        let map = map.ok_or_else(|| wrong("has a guide without length in this box: adjust it less far".into()))?;
        built.map = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(anchors::settled(m, &Frame::new(*rect)))),
            Class::Projective(_) | Class::Smooth => map,
        };
        Ok(built)
    }

    /// Returns the maps of the bands; `None` if a guide has no length.
    fn rows(&self, guides: Guides, cuts: &[f64], built: &mut Built) -> Result<Option<Vec<TileRow>>, Error> {
        let rect = self.frame;
        let place = Affine::translate(rect.origin().to_vec2());
        let moved = |segs: &[Seg]| -> Vec<Seg> { segs.iter().map(|g| g.transformed(place)).collect() };
        let band = |k: usize| {
            let y0 = if k == 0 { rect.y0 } else { cuts[k - 1] };
            Rect { y0, y1: cuts.get(k).copied().unwrap_or(rect.y1), ..rect }
        };
        let drawn =
            |segs: &[Seg]| -> BezPath { outline(segs).to_bez_path(GUIDE_TOLERANCE * (rect.width() + rect.height())) };
        match guides {
            Guides::Between(pairs) => {
                let along = if self.by_parameter { Along::Parameter } else { Along::ArcLength };
                let one = |(k, [top, bottom]): (usize, &[Vec<Seg>; 2])| {
                    let (top, bottom) = (moved(top), moved(bottom));
                    built.overlay(Role::Cage, drawn(&top));
                    built.overlay(Role::Cage, drawn(&bottom));
                    ruled::row(band(k), &Guide::new(&top, along)?, &Guide::new(&bottom, along)?)
                };
                Ok(pairs.iter().enumerate().map(one).collect())
            }
            Guides::Along(paths) => {
                let mut rows = Vec::with_capacity(paths.len());
                for (k, path) in paths.iter().enumerate() {
                    let path = moved(path);
                    built.overlay(Role::Cage, drawn(&path));
                    let bent = standing(&path, band(k))?;
                    built.explanation.warnings.extend(bent.explanation.warnings);
                    rows.push(TileRow { cuts: Vec::new(), maps: vec![bent.map] });
                }
                Ok(Some(rows))
            }
        }
    }

    /// Returns the heights between bands.
    fn cuts(&self, bands: usize) -> Result<Vec<f64>, Error> {
        let rect = self.frame;
        let Some(split) = &self.split else {
            return Ok((1..bands).map(|k| rect.y0 + rect.height() * (k as f64 / bands as f64)).collect());
        };
        let inside = split.iter().all(|y| *y > rect.y0 && *y < rect.y1) && split.windows(2).all(|w| w[0] < w[1]);
        if split.len() + 1 == bands && inside {
            return Ok(split.clone());
        }
        let most = bands - 1;
        let text = split.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let problem = format!("must be {most} height(s) between {} and {}, rising, for this shape", rect.y0, rect.y1);
        Err(Error::usage("split", text, problem))
    }
}

/// The error about an adjust value that the shape does not have.
fn no_adjust_value(shape: &TextShape, text: &str) -> Error {
    let known: Vec<&str> = shape.adj.iter().map(|a| a.name.as_str()).collect();
    Error::usage("adj", text, format!("is not an adjust value of {}: {}", shape.name, known.join(", ")))
}

/// Stands the band of artwork in `frame` on `path`, scaled to its length.
fn standing(path: &[Seg], frame: Rect) -> Result<Built, Error> {
    Bend::new(frame, &outline(path)).stretch(Stretch::Scale).baseline(frame.y1).as_drawn(true).build()
}

fn outline(segs: &[Seg]) -> Outline {
    let start = segs.first().map(Seg::start).unwrap_or_default();
    Outline { subpaths: vec![Subpath { start, segs: segs.to_vec(), closed: false }] }
}
