//! Anchors of user-drawn paths, and the rules that give them an order.
//!
//! Users seldom know the direction of a path or the start of a closed one. The rule is that of the paper (see `deform::shaper`): the
//! side that lies lowest on the screen is the bottom, and it runs left to right.

use crate::deform::{Built, Role};
use crate::error::{Error, GeometryError};
use crate::map::{AffineMap, Class, Homography, Map};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Frame, NamedPath, Settings};
use kurbo::{Affine, Line, Point, Rect};
use std::sync::Arc;

/// Anchors closer than this fraction of their spread coincide; three anchors whose triangle is smaller than this fraction of their
/// spread squared lie on a line. Well above rounding, well below intentional distances.
const NEAR: f64 = 1e-9;
/// A closing line shorter than this fraction of the path's box is a drawing program's rounding, not a side.
const STRAY: f64 = 1e-5;

/// Two or four anchors, in the order the deformation uses them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Anchors {
    Two([Point; 2]),
    Four([Point; 4]),
}

impl Anchors {
    pub(crate) fn points(&self) -> &[Point] {
        match self {
            Self::Two(p) => p,
            Self::Four(p) => p,
        }
    }

    /// Returns the path through the anchors, for a preview.
    pub(crate) fn outline(&self) -> Outline {
        Outline::from_points(self.points(), matches!(self, Self::Four(_)))
    }
}

/// Returns the only connected run of a path, without a stray closing line.
pub(crate) fn only_subpath(path: &NamedPath, expected: &'static str) -> Result<Subpath, Error> {
    let [sub] = path.outline.subpaths.as_slice() else {
        return Err(GeometryError::anchor_count(&path.name, &path.outline.anchors(), expected).into());
    };
    let mut sub = sub.clone();
    let size = path.outline.bounding_box().map_or(0.0, |b| b.width().hypot(b.height()));
    let is_stray = |s: &Seg| s.start().distance(s.end()) <= STRAY * size;
    if sub.closed && sub.segs.len() > 1 && matches!(sub.segs.last(), Some(s @ Seg::Line(_)) if is_stray(s)) {
        sub.segs.pop();
        if let Some(last) = sub.segs.last_mut() {
            *last = ending_at(last, sub.start);
        }
    }
    Ok(sub)
}

/// Returns the only run of a path, closed. A run that returns to its start counts as closed; plain points, which cannot be closed
/// explicitly, are closed if `is_polygon` accepts their number of lines.
pub(crate) fn closed_subpath(
    path: &NamedPath,
    expected: &'static str,
    is_polygon: impl Fn(usize) -> bool,
) -> Result<Subpath, Error> {
    let mut sub = only_subpath(path, expected)?;
    let is_polyline = !sub.closed && sub.segs.iter().all(|g| matches!(g, Seg::Line(_)));
    if is_polyline && is_polygon(sub.segs.len()) && sub.start != sub.end() {
        let closed = Outline::from_points(&sub.anchors(), true);
        sub = only_subpath(&NamedPath { name: path.name.clone(), outline: closed }, expected)?;
    }
    // A path that returns to its start counts as closed.
    let returns = sub.end().distance(sub.start) <= 1e-9 * sub.start.to_vec2().hypot().max(1.0);
    sub.closed |= returns && sub.segs.len() > 1;
    if !sub.closed {
        return Err(GeometryError::NotClosed { path: path.name.clone(), start: sub.start, end: sub.end() }.into());
    }
    Ok(sub)
}

/// Moves the last point of a piece to `end`, by no more than rounding.
pub(crate) fn ending_at(seg: &Seg, end: Point) -> Seg {
    match *seg {
        Seg::Line(l) => Seg::Line(Line::new(l.p0, end)),
        Seg::Quad(mut q) => {
            q.p2 = end;
            Seg::Quad(q)
        }
        Seg::Cubic(mut c) => {
            c.p3 = end;
            Seg::Cubic(c)
        }
        Seg::Arc(mut a) => {
            a.p1 = end;
            Seg::Arc(a)
        }
    }
}

/// Returns the two or four anchors of a path, as drawn.
pub(crate) fn two_or_four(path: &NamedPath) -> Result<Anchors, Error> {
    let sub = only_subpath(path, "two or four")?;
    let a = sub.anchors();
    match a[..] {
        [p, q] => {
            check_distinct(&path.name, &a)?;
            Ok(Anchors::Two([p, q]))
        }
        [p, q, r, s] => {
            check_general(&path.name, &a)?;
            Ok(Anchors::Four([p, q, r, s]))
        }
        _ => Err(GeometryError::anchor_count(&path.name, &a, "two or four").into()),
    }
}

/// Refuses coincident anchors.
pub(crate) fn check_distinct(path: &str, a: &[Point]) -> Result<(), GeometryError> {
    let near = NEAR * spread(a);
    for (i, p) in a.iter().enumerate() {
        for (j, q) in a.iter().enumerate().take(i) {
            if p.distance(*q) <= near {
                return Err(GeometryError::Coincident { path: path.to_owned(), which: [j + 1, i + 1], at: *p });
            }
        }
    }
    Ok(())
}

/// Refuses coincident anchors, and three on a line.
pub(crate) fn check_general(path: &str, a: &[Point]) -> Result<(), GeometryError> {
    check_distinct(path, a)?;
    let flat = NEAR * spread(a).powi(2);
    for k in 0..a.len() {
        for j in 0..k {
            for i in 0..j {
                if (a[j] - a[i]).cross(a[k] - a[i]).abs() <= flat {
                    let which = [i + 1, j + 1, k + 1];
                    return Err(GeometryError::Collinear { path: path.to_owned(), which, points: a.to_vec() });
                }
            }
        }
    }
    Ok(())
}

fn spread(a: &[Point]) -> f64 {
    a.iter().flat_map(|p| a.iter().map(move |q| p.distance(*q))).fold(0.0, f64::max)
}

/// An order of four corners that begins with one end of the bottom side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Arrangement {
    /// The bottom side: 0 to 3, counted as drawn.
    pub(crate) bottom: usize,
    /// `true` to run the path against its drawn direction.
    pub(crate) reversed: bool,
}

impl Arrangement {
    /// Arranges corners by the paper's rule. `heights[i]` is the mean y of the side from corner i to corner i+1.
    pub(crate) fn by_rule(corners: &[Point; 4], heights: &[f64; 4]) -> Self {
        let bottom = (0..4).fold(0, |best, i| if heights[i] > heights[best] { i } else { best });
        Self::from_bottom(corners, bottom)
    }

    /// Arranges corners with side `bottom` as the bottom, left to right.
    pub(crate) fn from_bottom(corners: &[Point; 4], bottom: usize) -> Self {
        Self { bottom, reversed: corners[bottom].x > corners[(bottom + 1) % 4].x }
    }

    /// Returns the corners' indices in order: the bottom's start and end, and the other two on the way around.
    pub(crate) fn order(&self) -> [usize; 4] {
        let b = self.bottom;
        if self.reversed {
            [(b + 1) % 4, b, (b + 3) % 4, (b + 2) % 4]
        } else {
            [b, (b + 1) % 4, (b + 2) % 4, (b + 3) % 4]
        }
    }
}

/// Arranges anchors by the rule: two left to right; of four the lowest side first, left to right.
pub(crate) fn arranged(a: Anchors) -> Anchors {
    match a {
        Anchors::Two([p, q]) if p.x > q.x => Anchors::Two([q, p]),
        Anchors::Two(_) => a,
        Anchors::Four(q) => {
            let heights = std::array::from_fn(|i| 0.5 * (q[i].y + q[(i + 1) % 4].y));
            Anchors::Four(Arrangement::by_rule(&q, &heights).order().map(|i| q[i]))
        }
    }
}

/// Returns the anchors of a path, arranged by the rule or as drawn.
pub(crate) fn of_path(path: &NamedPath, as_drawn: bool) -> Result<Anchors, Error> {
    let a = two_or_four(path)?;
    Ok(if as_drawn { a } else { arranged(a) })
}

/// Reads the anchors of parameter `name`, arranged unless the flag `as_drawn` is set; `None` if not given.
fn from_settings(s: &Settings<'_>, name: &str, as_drawn: &str) -> Result<Option<Anchors>, Error> {
    s.path_if(name)?.map(|path| of_path(&path, s.flag(as_drawn)?)).transpose()
}

/// Returns the frame's corners as anchors, the default base: bottom left, bottom right, top right, top left.
pub(crate) fn frame_corners(frame: &Frame) -> Result<Anchors, Error> {
    let c = frame.corners();
    if check_general("", &c).is_err() {
        let (width, height) = (frame.rect.width(), frame.rect.height());
        return Err(GeometryError::FlatFrame { width, height }.into());
    }
    Ok(Anchors::Four(c))
}

/// Base and target of four anchors each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FourToFour {
    pub(crate) from: [Point; 4],
    pub(crate) to: [Point; 4],
    /// The artwork's box.
    pub(crate) frame: Rect,
}

impl FourToFour {
    /// Maps these points in order; the artwork's box is the base's.
    pub(crate) fn new(from: [Point; 4], to: [Point; 4]) -> Self {
        let frame = from.iter().fold(Rect::from_points(from[0], from[1]), |r, p| r.union_pt(*p));
        Self { from, to, frame }
    }

    /// Refuses coincident anchors, and three on a line.
    pub(crate) fn check(&self) -> Result<(), GeometryError> {
        check_general("base", &self.from)?;
        check_general("target", &self.to)
    }

    /// Adds the preview's guides.
    pub(crate) fn shown_on(&self, mut built: Built) -> Built {
        for (role, points) in [(Role::Base, self.from), (Role::Target, self.to)] {
            built.overlay(role, Anchors::Four(points).outline().to_bez_path(0.0));
        }
        built
    }
}

/// Reads `base` and `target` with four anchors each. Without a base, the frame's corners are taken.
pub(crate) fn four_to_four(s: &Settings<'_>) -> Result<FourToFour, Error> {
    let base = from_settings(s, "base", "base-as-drawn")?.map_or_else(|| frame_corners(s.frame()), Ok)?;
    let missing = || Error::missing("target", "four anchors, the images of the base's");
    let target = from_settings(s, "target", "target-as-drawn")?.ok_or_else(missing)?;
    Ok(FourToFour { from: four("base", &base)?, to: four("target", &target)?, frame: s.frame().rect })
}

fn four(name: &str, a: &Anchors) -> Result<[Point; 4], Error> {
    match a {
        Anchors::Four(q) => Ok(*q),
        Anchors::Two(p) => Err(GeometryError::anchor_count(name, p, "four (for two, use similitude)").into()),
    }
}

/// Returns the map to the standard position: two anchors to (0,0), (1,0) by a direct similitude, four to the unit square's corners
/// by a projective map. In the standard position v grows *upwards* on the screen.
pub(crate) fn to_standard(name: &str, a: &Anchors) -> Result<Arc<dyn Map>, Error> {
    match *a {
        Anchors::Two([p, q]) => {
            // The points are mirrored first, so that the similitude is direct in the sense of the screen.
            let mirrored = |p: Point| Point::new(p.x, -p.y);
            let m = AffineMap::similitude(mirrored(p), mirrored(q), Point::ORIGIN, Point::new(1.0, 0.0))
                .ok_or_else(|| GeometryError::Coincident { path: name.to_owned(), which: [1, 2], at: p })?;
            Ok(Arc::new(AffineMap(m.0 * Affine::FLIP_Y)))
        }
        Anchors::Four(q) => {
            const UNIT: [Point; 4] =
                [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(1.0, 1.0), Point::new(0.0, 1.0)];
            Ok(Arc::new(projective(name, q, UNIT)?))
        }
    }
}

/// Reduces an affine map to its matrix, or to the identity if only rounding moves the corners of `frame`; leaves other maps alone.
pub(crate) fn simplified(map: Arc<dyn Map>, frame: Rect) -> Arc<dyn Map> {
    /// The rounding error of a few dozen operations on numbers of the corners' size.
    const ROUNDING: f64 = 1e-14;
    let Class::Affine(m) = map.class() else { return map };
    let corners = Frame::new(frame).corners();
    let size = corners.iter().map(|p| p.to_vec2().hypot()).fold(0.0, f64::max);
    let moves = corners.iter().any(|p| (m * *p).distance(*p) > ROUNDING * size);
    Arc::new(AffineMap(if moves || frame.area() == 0.0 { m } else { Affine::IDENTITY }))
}

/// Returns the projective map from four points to four points; an error names `name`.
pub(crate) fn projective(name: &str, from: [Point; 4], to: [Point; 4]) -> Result<Homography, GeometryError> {
    Homography::from_points(from, to).ok_or_else(|| GeometryError::NotConvex {
        path: name.to_owned(),
        from: from.to_vec(),
        to: to.to_vec(),
    })
}
