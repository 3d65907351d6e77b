//! Warp styles: ready-made bends of a box, each one bicubic net.
//!
//! The fifteen styles that drawing programs share, as data ([`style`], `styles.json`): each makes a net of sixteen points from the
//! artwork's box. The numbers were measured on the most widely used drawing program and published with the OPuller editor
//! (AnatomikPerq, 2026). The arcs are the usual cubics for circular arcs, and the inner points of the families with bent sides
//! follow equation (7) of M. Koppinen, *A plane transformation from 16 control points*, the bilinear Coons patch.

mod entry;
mod style;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;
pub use style::Style;
pub(super) use style::StyleParams;

use super::built::{Built, Role};
use super::envelope::{self, Keep, Ring};
use super::shaper::rows_path;
use crate::error::{Error, GeometryError, within};
use crate::map::{AffineMap, BicubicNet, Class, Map, Net};
use crate::outline::Seg;
use crate::param::Frame;
use kurbo::{Affine, CubicBez, Point, Rect};
use std::sync::Arc;

/// A warp style over the artwork's box: arc, flag, fisheye, …
///
/// The map is the bicubic Bézier patch of the style's net, or the envelope of its sides if lines are [kept](Self::keep).
///
/// ```
/// use pathwarp::{deform::{Style, Warp}, kurbo::{Point, Rect}, map::Map};
///
/// let arch = Warp::new(Style::named("arch").unwrap(), Rect::new(0.0, 0.0, 100.0, 100.0)).bend(1.0).build()?;
/// assert!(arch.map.point(Point::new(50.0, 0.0)).distance(Point::new(50.0, -50.0)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Warp {
    frame: Rect,
    style: Style,
    bend: f64,
    horizontal: f64,
    vertical: f64,
    sideways: bool,
    keep: Keep,
}

impl Warp {
    /// Creates a warp of the box `frame` by 50 %.
    #[must_use]
    pub fn new(style: Style, frame: Rect) -> Self {
        Self { frame, style, bend: 0.5, horizontal: 0.0, vertical: 0.0, sideways: false, keep: Keep::Nothing }
    }

    /// Sets the bend, 1 for 100 %; negative bends the other way. Bends beyond 1 continue by the same formula, up to the style's
    /// [limit](Style::limit).
    #[must_use]
    pub fn bend(self, bend: f64) -> Self {
        Self { bend, ..self }
    }

    /// Sets the horizontal and the vertical distortion, −1 to 1: the right (lower) side grows by this share, the left (upper)
    /// one shrinks.
    #[must_use]
    pub fn distort(self, horizontal: f64, vertical: f64) -> Self {
        Self { horizontal, vertical, ..self }
    }

    /// Turns the style sideways.
    #[must_use]
    pub fn sideways(self, sideways: bool) -> Self {
        Self { sideways, ..self }
    }

    /// Sets the lines that stay straight: the artwork is put between the style's sides then.
    #[must_use]
    pub fn keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a flat box; [`Error::Usage`] for a bend or distortion out of range, a style with a wrong
    /// formula, and lines that the style cannot keep.
    pub fn build(&self) -> Result<Built, Error> {
        let Self { frame, style, bend, .. } = self;
        if let Some(limit) = style.limit().filter(|l| bend.abs() > *l) {
            let most = limit * 100.0;
            let problem = format!("is out of range: {} bends from -{most}% to {most}%", style.name);
            return Err(Error::usage("bend", bend.to_string(), problem));
        }
        let params = StyleParams {
            bend: *bend,
            distortion: [
                within("horizontal", self.horizontal, -1.0, 1.0)?,
                within("vertical", self.vertical, -1.0, 1.0)?,
            ],
            vertical: self.sideways,
        };
        let net = style.net(frame.width(), frame.height(), &params);
        let net = net.map_err(|e| Error::usage("style", style.name.clone(), e.to_string()))?;
        let mut built = if self.keep == Keep::Nothing { over(*frame, &net)? } else { self.kept(&net, &params)? };
        built.note(format!(
            "style {}: bend {}%, {}{}",
            style.name,
            bend * 100.0,
            if self.sideways { "vertical" } else { "horizontal" },
            if style.title.is_empty() { String::new() } else { format!("; {}", style.title) }
        ));
        Ok(built)
    }

    /// Puts the box between the sides of the style's net. If the lines cannot be kept, the error lists the styles that can.
    fn kept(&self, net: &Net, params: &StyleParams) -> Result<Built, Error> {
        let frame = self.frame;
        let put = |style: &Style, net: &Net| -> Result<Built, Error> {
            // A style that moves only the inside has nothing left between its sides.
            let flat = style.net(frame.width(), frame.height(), &StyleParams { bend: 0.0, ..*params });
            if params.bend != 0.0 && flat.is_ok_and(|flat| same_sides(&flat, net)) {
                return Err(Error::usage("keep", self.keep.name(), "its sides do not bend, only its inside"));
            }
            let ring = sides(&net.map(|row| row.map(|p| p + frame.origin().to_vec2())));
            envelope::fit(frame, &ring, self.keep, None)
        };
        put(&self.style, net).map_err(|e| {
            let possible = |style: &Style| {
                let net = style.net(frame.width(), frame.height(), params).ok();
                net.is_some_and(|n| put(style, &n).is_ok())
            };
            let names: Vec<String> = Style::builtin().into_iter().filter(possible).map(|style| style.name).collect();
            let others = if names.is_empty() {
                "no style can at this bend".into()
            } else {
                format!("it can with {}", names.join(", "))
            };
            let Error::Usage { problem, .. } = e else { return e };
            // The envelope's advice is for drawn curves.
            Error::usage("keep", self.keep.name(), format!("is impossible with this style ({problem}); {others}"))
        })
    }
}

/// Returns `true` if two nets have the same outermost rows and columns.
fn same_sides(a: &Net, b: &Net) -> bool {
    let outer = |j: usize, c: usize| j == 0 || j == 3 || c == 0 || c == 3;
    (0..16).all(|k| !outer(k / 4, k % 4) || a[k / 4][k % 4] == b[k / 4][k % 4])
}

/// Returns a net's four sides: bottom to the right, right side upwards, top to the left, left side downwards.
fn sides(net: &Net) -> Ring {
    let row = |r: usize| net[r];
    let column = |c: usize| [net[0][c], net[1][c], net[2][c], net[3][c]];
    let seg = |[a, b, c, d]: [Point; 4]| vec![Seg::Cubic(CubicBez::new(a, b, c, d))];
    let back = |[a, b, c, d]: [Point; 4]| [d, c, b, a];
    Ring {
        sides: [seg(row(3)), seg(back(column(3))), seg(back(row(0))), seg(column(0))],
        notes: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Builds the map of one net over a box; the net's origin is the box's top left corner.
pub(super) fn over(rect: Rect, net: &Net) -> Result<Built, Error> {
    if !(rect.width() > 0.0 && rect.height() > 0.0) {
        return Err(GeometryError::FlatFrame { width: rect.width(), height: rect.height() }.into());
    }
    let net: Net = net.map(|row| row.map(|p| p + rect.origin().to_vec2()));
    let pre = Affine::new([
        1.0 / rect.width(),
        0.0,
        0.0,
        1.0 / rect.height(),
        -rect.x0 / rect.width(),
        -rect.y0 / rect.height(),
    ]);
    let map = BicubicNet::new(&net, pre);
    let map: Arc<dyn Map> = match map.class() {
        Class::Affine(m) => Arc::new(AffineMap(crate::anchors::settled(m, &Frame::new(rect)))),
        _ => Arc::new(map),
    };
    let mut built = Built::new(map);
    built.overlay(Role::Base, kurbo::Shape::to_path(&rect, 0.1));
    built.overlay(Role::Cage, rows_path(&net));
    Ok(built)
}
