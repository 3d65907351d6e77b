//! The 16-point shaper: artwork bent into a four-sided curved path.
//!
//! F = h₂ ∘ F₀ ∘ h₁ (Markku Koppinen, *A plane transformation from 16 control points*, equation 8). F₀ is the bicubic map of a
//! 4×4 net (equation 3); the user draws its outer twelve points as a closed path of four cubic sides, and the inner four follow
//! by equation 7 ([`complete_net`](crate::map::complete_net)). h₁ brings the base to the standard position, h₂ the shaper's corners
//! to the target: direct similitudes for two anchors, projective maps for four.

mod entry;
mod laying;
mod net;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;
pub(super) use net::rows_path;

use self::net::Bottom;
use super::built::{Built, Explanation, Role};
use crate::anchors::{self, Anchors};
use crate::error::{Error, GeometryError, within};
use crate::map::{AffineMap, BicubicNet, Chain, Class, Map, Net};
use crate::outline::Outline;
use crate::param::{Frame, NamedPath};
use kurbo::{Point, Rect};
use std::sync::Arc;

/// The 16-point shaper: the artwork's box, or a base, bent into a closed path of four curved sides.
///
/// F = h₂ ∘ F₀ ∘ h₁ with F₀ the bicubic map of a 4×4 net whose outer twelve points are the path's, h₁ the map of the base to
/// the unit square and h₂ the map of the shaper's corners to the target: similitudes for two anchors, projective for four.
///
/// ```
/// use pathwarp::{Outline, deform::Shaper, kurbo::{Point, Rect}, map::Map};
///
/// let cage = Outline::from_svg("M10,90 Q40,110 95,85 L90,15 5,10 Z")?;
/// let built = Shaper::new(&cage).frame(Rect::new(0.0, 0.0, 100.0, 100.0)).build()?;
/// assert!(built.map.point(Point::new(50.0, 50.0)).distance(Point::new(46.875, 55.625)) < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Shaper {
    cage: Cage,
    bottom: Bottom,
    reverse: bool,
    base: Option<NamedPath>,
    base_as_drawn: bool,
    target: Option<NamedPath>,
    target_as_drawn: bool,
    frame: Option<Rect>,
}

/// The source of the net.
#[derive(Debug, Clone, PartialEq)]
enum Cage {
    Path(NamedPath),
    /// All 16 points, and a name for them.
    Net(Box<Net>, String),
}

impl Shaper {
    /// Creates a shaper from a closed path of four lines, curves or arcs. Of the eight ways to lay the base's corners on its
    /// own, the one that is nearest to a similitude is chosen; among near ties the paper's: the bottom is the side that lies
    /// lowest on the screen, run left to right.
    #[must_use]
    pub fn new(cage: &Outline) -> Self {
        Self::with(Cage::Path(NamedPath { name: "shaper".into(), outline: cage.clone() }))
    }

    /// Creates a shaper from all 16 control points, row by row, the bottom row first, each left to right.
    #[must_use]
    pub fn from_net(net: [[Point; 4]; 4]) -> Self {
        Self::with(Cage::Net(Box::new(net), "net".into()))
    }

    fn with(cage: Cage) -> Self {
        Self {
            cage,
            bottom: Bottom::LeastDistorting,
            reverse: false,
            base: None,
            base_as_drawn: false,
            target: None,
            target_as_drawn: false,
            frame: None,
        }
    }

    /// Sets the bottom side of the closed path: 1 to 4, in the order they were drawn.
    #[must_use]
    pub fn bottom(self, side: usize) -> Self {
        Self { bottom: Bottom::Side(side), ..self }
    }

    /// Takes the side that lies lowest on the screen for the bottom, however much that distorts.
    #[must_use]
    pub fn lowest_bottom(self) -> Self {
        Self { bottom: Bottom::Lowest, ..self }
    }

    /// Runs the bottom side the other way, so that the result is mirrored.
    #[must_use]
    pub fn reverse(self, reverse: bool) -> Self {
        Self { reverse, ..self }
    }

    /// Sets the box that is laid onto the shaper, corner on corner, if there is no [`base`](Self::base).
    #[must_use]
    pub fn frame(self, frame: Rect) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Sets two or four anchors in the source: they are laid onto the shaper's bottom corners, or all four.
    #[must_use]
    pub fn base(self, base: &Outline) -> Self {
        Self { base: Some(NamedPath { name: "base".into(), outline: base.clone() }), ..self }
    }

    /// Sets two or four anchors that the shaper's bottom corners, or all four, are taken to. Default: they stay.
    #[must_use]
    pub fn target(self, target: &Outline) -> Self {
        Self { target: Some(NamedPath { name: "target".into(), outline: target.clone() }), ..self }
    }

    /// Takes the anchors of base and target in the order they were drawn, instead of left to right, the lowest side first.
    #[must_use]
    pub fn as_drawn(self, base: bool, target: bool) -> Self {
        Self { base_as_drawn: base, target_as_drawn: target, ..self }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Geometry`] if the path does not close or has other than four sides, or if anchors coincide or three of them
    /// lie on a line; [`Error::Missing`] without base and frame; [`Error::Usage`] for a bottom side out of range.
    pub fn build(&self) -> Result<Built, Error> {
        let mut explanation = Explanation::default();
        if let Bottom::Side(n) = self.bottom {
            within("bottom", n as f64, 1.0, 4.0)?;
        }
        let base = self.base_anchors();
        let (net, path, name) = match &self.cage {
            Cage::Path(path) => {
                let corners = match &base {
                    Ok(Anchors::Four(corners)) if self.target.is_none() => Some(corners),
                    _ => None,
                };
                let net = net::from_cage(path, self.bottom, self.reverse, corners, &mut explanation)?;
                (net, net::sides_path(&net), &path.name)
            }
            Cage::Net(net, name) => (**net, rows_path(net), name),
        };
        let corners = [net[0][0], net[0][3], net[3][3], net[3][0]];
        if matches!(self.cage, Cage::Net(..)) {
            anchors::general(name, &corners)?;
        }
        let notes = &mut explanation.notes;
        notes.push(format!("corners of {name}: {} (bottom left, bottom right, top right, top left)", list(&corners)));

        let base = base?;
        let target = self.target.as_ref().map(|t| anchors::of_path(t, self.target_as_drawn)).transpose()?;
        notes.push(format!("base: {} ({})", list(base.points()), wrapper(&base)));
        let after = match &target {
            None => {
                notes.push("target: none, the result lies where the shaper lies".into());
                None
            }
            Some(t) => {
                notes.push(format!("target: {} ({})", list(t.points()), wrapper(t)));
                Some(to_target(name, &corners, t)?)
            }
        };
        let map = compose(&anchors::to_standard("base", &base)?, net, after);
        let map = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(anchors::settled(m, &Frame::new(self.extent(&base))))),
            _ => map,
        };

        let mut built = Built::new(map);
        built.explanation.notes = explanation.notes;
        built.explanation.warnings = explanation.warnings;
        built.overlay(Role::Cage, path);
        built.overlay(Role::Base, base.outline().to_bez_path(0.0));
        if let Some(t) = target {
            built.overlay(Role::Target, t.outline().to_bez_path(0.0));
        }
        Ok(built)
    }

    fn base_anchors(&self) -> Result<Anchors, Error> {
        match (&self.base, self.frame) {
            (Some(path), _) => anchors::of_path(path, self.base_as_drawn),
            (None, Some(frame)) => anchors::frame_corners(&Frame::new(frame)),
            (None, None) => Err(Error::missing("base", "two or four anchors, or the artwork's box")),
        }
    }

    /// Returns the artwork's box, or the base's.
    fn extent(&self, base: &Anchors) -> Rect {
        let p = base.points();
        self.frame.unwrap_or_else(|| p.iter().fold(Rect::from_points(p[0], p[0]), |r, p| r.union_pt(*p)))
    }
}

/// Composes h₂ ∘ F₀ ∘ h₁, with affine wrappers folded into the net.
fn compose(h1: &Arc<dyn Map>, net: Net, h2: Option<Arc<dyn Map>>) -> Arc<dyn Map> {
    let (net, h2) = match h2.as_ref().map(Map::class) {
        Some(Class::Affine(m)) => (net.map(|row| row.map(|p| m * p)), None),
        _ => (net, h2),
    };
    let (before, pre) = match h1.class() {
        Class::Affine(m) => (None, m),
        _ => (Some(h1.clone()), kurbo::Affine::IDENTITY),
    };
    let f0 = Arc::new(BicubicNet::new(&net, pre)) as Arc<dyn Map>;
    if before.is_none() && h2.is_none() {
        return f0;
    }
    Arc::new(Chain::new(before.into_iter().chain([f0]).chain(h2)))
}

/// Returns the map of the shaper's corners to the target.
fn to_target(name: &str, corners: &[Point; 4], target: &Anchors) -> Result<Arc<dyn Map>, Error> {
    match *target {
        Anchors::Two([p, q]) => {
            let m = AffineMap::similitude(corners[0], corners[1], p, q).ok_or_else(|| GeometryError::Coincident {
                path: name.to_owned(),
                which: [1, 2],
                at: corners[0],
            })?;
            Ok(Arc::new(m))
        }
        Anchors::Four(q) => Ok(Arc::new(anchors::projective("target", *corners, q)?)),
    }
}

fn wrapper(a: &Anchors) -> &'static str {
    match a {
        Anchors::Two(_) => "two anchors: a similitude",
        Anchors::Four(_) => "four anchors: a projective map",
    }
}

fn list(points: &[Point]) -> String {
    points.iter().map(|p| crate::error::show(*p)).collect::<Vec<_>>().join(" ")
}
