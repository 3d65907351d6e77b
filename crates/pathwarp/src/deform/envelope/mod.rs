//! Artwork put into a shape: an envelope of four sides, each a curve of any number of pieces.
//!
//! The map is the Coons patch of the sides ([`Coons`](crate::map::Coons)), which for sides of one cubic is the shaper's
//! (Koppinen, *A plane transformation from 16 control points*, equation 7).

mod choice;
mod columns;
mod corners;
mod curves;
mod distortion;
mod entry;
mod faults;
mod fit;
mod ring;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;
pub(super) use fit::fit;
pub use fit::{Keep, Spread};
use ring::Corners;
pub(super) use ring::Ring;

use super::built::Built;
use crate::error::{Error, show, within};
use crate::outline::{Outline, Subpath};
use crate::param::NamedPath;
use columns::Room;
use kurbo::{Point, Rect};
use std::sync::Arc;

/// The share of the greatest height at which lettering ends.
const ENDS: f64 = 0.25;

/// An envelope: the artwork's box put into a shape with four sides, each a curve of any number of pieces.
///
/// The map is the Coons patch of the sides, F(u, v) = (1−v)·B(u) + v·T(u) + (1−u)·L(v) + u·R(v) less the bilinear map of the
/// corners, or a ruled or projective map if lines are [kept](Self::keep).
///
/// ```
/// use pathwarp::{Outline, deform::Envelope, kurbo::{Point, Rect}, map::Map};
///
/// let hill = Outline::from_svg("M0,100 A50,50 0 0 1 100,100")?;
/// let arch = Envelope::between(Rect::new(0.0, 0.0, 100.0, 100.0)).bottom(&hill).height(40.0).build()?;
/// assert!(arch.map.point(Point::new(50.0, 0.0)).distance(Point::new(50.0, 10.0)) < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Envelope {
    frame: Rect,
    shape: Option<NamedPath>,
    /// Bottom, right, top, left.
    curves: [Option<NamedPath>; 4],
    height: Option<f64>,
    square: bool,
    spread: Option<Spread>,
    corners: Option<Corners>,
    bottom_side: Option<usize>,
    reverse: bool,
    keep: Keep,
    room: Room,
    lettering: bool,
    ink: Arc<[Point]>,
}

impl Envelope {
    /// Puts the box `frame` into a closed path. Its corners and its bottom are found, unless they are set.
    #[must_use]
    pub fn new(frame: Rect, shape: &Outline) -> Self {
        let shape = NamedPath { name: "envelope".into(), outline: shape.clone() };
        Self { shape: Some(shape), ..Self::between(frame) }
    }

    /// Puts the box `frame` between curves: [`bottom`](Self::bottom) and [`top`](Self::top), [`left`](Self::left) and
    /// [`right`](Self::right), all four, or bottom or top alone.
    #[must_use]
    pub fn between(frame: Rect) -> Self {
        Self {
            frame,
            shape: None,
            curves: Default::default(),
            height: None,
            square: false,
            spread: None,
            corners: None,
            bottom_side: None,
            reverse: false,
            keep: Keep::Auto,
            room: Room::default(),
            lettering: false,
            ink: Arc::new([]),
        }
    }

    fn side(mut self, k: usize, curve: &Outline) -> Self {
        self.curves[k] = Some(NamedPath { name: ring::SIDES[k].into(), outline: curve.clone() });
        self
    }

    /// Sets the bottom side, an open curve.
    #[must_use]
    pub fn bottom(self, curve: &Outline) -> Self {
        self.side(0, curve)
    }

    /// Sets the right side, an open curve.
    #[must_use]
    pub fn right(self, curve: &Outline) -> Self {
        self.side(1, curve)
    }

    /// Sets the top side, an open curve.
    #[must_use]
    pub fn top(self, curve: &Outline) -> Self {
        self.side(2, curve)
    }

    /// Sets the left side, an open curve.
    #[must_use]
    pub fn left(self, curve: &Outline) -> Self {
        self.side(3, curve)
    }

    /// Sets the distance of the facing side, user units, if bottom or top is drawn alone: it is the same curve again.
    /// Default: the height of the box.
    #[must_use]
    pub fn height(self, height: f64) -> Self {
        Self { height: Some(height), ..self }
    }

    /// Joins the ends of two curves by curves that meet both at right angles, instead of straight lines.
    #[must_use]
    pub fn square(self, square: bool) -> Self {
        Self { square, ..self }
    }

    /// Sets the spacing along the sides. Default: even by length.
    #[must_use]
    pub fn spread(self, spread: Spread) -> Self {
        Self { spread: Some(spread), ..self }
    }

    /// Sets the corners of a closed path: the points nearest to these.
    #[must_use]
    pub fn corners(self, points: [impl Into<Point>; 4]) -> Self {
        Self { corners: Some(Corners::Points(points.map(Into::into))), ..self }
    }

    /// Sets the corners of a closed path by the numbers of its nodes, from 1.
    #[must_use]
    pub fn corner_nodes(self, nodes: [usize; 4]) -> Self {
        Self { corners: Some(Corners::Nodes(nodes)), ..self }
    }

    /// Sets the bottom side of a closed path: 1 to 4, from its first corner on as drawn.
    #[must_use]
    pub fn bottom_side(self, side: usize) -> Self {
        Self { bottom_side: Some(side), ..self }
    }

    /// Runs the bottom the other way, so that the result is mirrored.
    #[must_use]
    pub fn reverse(self, reverse: bool) -> Self {
        Self { reverse, ..self }
    }

    /// Sets the lines that stay straight. Default: [`Keep::Auto`].
    #[must_use]
    pub fn keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// In columns or rows, ends the artwork where the shape is still this share of its greatest height (width), 0 to below 1.
    /// Default: 0.25 for lettering, else 0.
    #[must_use]
    pub fn ends(self, ends: f64) -> Self {
        Self { room: Room { ends: Some(ends), ..self.room }, ..self }
    }

    /// Keeps the artwork this far off the outline, user units. Default: 0.
    #[must_use]
    pub fn padding(self, padding: f64) -> Self {
        Self { room: Room { padding, ..self.room }, ..self }
    }

    /// Says that the artwork is lettering, which has stems to be kept upright.
    #[must_use]
    pub fn lettering(self, lettering: bool) -> Self {
        Self { lettering, ..self }
    }

    /// Gives points of the artwork, where its distortion is visible. Default: the whole box.
    #[must_use]
    pub fn artwork(self, ink: impl Into<Arc<[Point]>>) -> Self {
        Self { ink: ink.into(), ..self }
    }

    /// Builds the map. Sides that cross, and folds, give warnings.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a shape that is not closed or a flat box; [`Error::Usage`] for curves that do not meet, corners
    /// that cannot be found, sides too curved for the lines to be kept, and values that contradict each other.
    pub fn build(&self) -> Result<Built, Error> {
        within("ends", self.room.ends.unwrap_or(0.0), 0.0, 0.99)?;
        within("padding", self.room.padding, 0.0, 1e9)?;
        self.check()?;
        let shape =
            self.shape.as_ref().map(|path| Ok::<_, Error>((&*path.name, corners::closed(path)?))).transpose()?;
        let divided = self.corners.is_some() || self.bottom_side.is_some() || self.reverse || self.spread.is_some();
        let whole = divided || matches!(self.keep, Keep::Nothing | Keep::Lines);
        let (shape, tips) = match shape {
            Some((name, path)) if !whole => {
                let (path, tips) = corners::trimmed(&path);
                (Some((name, path)), tips)
            }
            shape => (shape, Vec::new()),
        };
        let choice = choice::Choice {
            frame: self.frame,
            keep: self.keep,
            spread: self.spread,
            room: Room { ends: Some(self.room.ends.unwrap_or(if self.lettering { ENDS } else { 0.0 })), ..self.room },
            lettering: self.lettering,
            ink: &self.ink,
        };
        let ring = self.ring(shape.as_ref());
        let mut built = choice.build(shape.map(|s| s.1).filter(|_| !divided), ring)?;
        if !tips.is_empty() {
            built.note(format!(
                "left free: what sticks out at {}",
                tips.into_iter().map(show).collect::<Vec<_>>().join(" ")
            ));
        }
        Ok(built)
    }

    /// Returns where the artwork is, in the unit square with v upwards: a few places, as every choice of corners looks at all.
    fn places(&self) -> Vec<Point> {
        /// Places along an axis, and in all.
        const PLACES: u32 = 5;
        let step = (self.ink.len() / (2 * PLACES * PLACES) as usize).max(1);
        let places: Vec<Point> = self.ink.iter().step_by(step).map(|p| fit::to_unit(self.frame) * *p).collect();
        if places.is_empty() { distortion::grid(PLACES).collect() } else { places }
    }

    /// Refuses values that contradict each other.
    fn check(&self) -> Result<(), Error> {
        let drawn = self.curves.iter().any(Option::is_some);
        if let Some(height) = self.height {
            within("height", height, 1e-9, 1e9)?;
        }
        if let Some(n) = self.bottom_side {
            within("bottom-side", n as f64, 1.0, 4.0)?;
        }
        match &self.shape {
            Some(path) if drawn => {
                let problem = "cannot go with `bottom`, `top`, `left` and `right`: a closed path has all four";
                Err(Error::usage("envelope", path.name.clone(), problem))
            }
            Some(_) => match self.height {
                Some(height) => Err(Error::usage("height", height.to_string(), "goes with `bottom` or `top` alone")),
                None => Ok(()),
            },
            None if drawn => {
                let given = [("corners", self.corners.is_some()), ("bottom-side", self.bottom_side.is_some())];
                let problem = "goes with `envelope`: here the sides are drawn one by one";
                given.iter().find(|g| g.1).map_or(Ok(()), |g| Err(Error::usage(g.0, "", problem)))
            }
            None => {
                let hint =
                    "the closed path to put the artwork into (or `bottom` and `top`: the curves below and above)";
                Err(Error::missing("envelope", hint))
            }
        }
    }

    /// Returns the four sides as drawn.
    fn ring(&self, shape: Option<&(&str, Subpath)>) -> Result<Ring, Error> {
        if let Some((name, path)) = shape {
            return corners::ring(name, path, self.corners.as_ref(), self.bottom_side, self.reverse, &self.places());
        }
        let curves = curves::Curves {
            drawn: &self.curves,
            height: self.height,
            frame_height: self.frame.height(),
            square: self.square,
            reverse: self.reverse,
        };
        curves.ring()
    }
}
