//! Requests, answers and descriptions of built maps, which the binary and the text form of the protocol share.

use crate::fault::Fault;
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::map::{Crease, CreaseKind, Creases, Jet, Level};

/// The kind of a batch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ask {
    /// Values.
    Points,
    /// Values with both partial derivatives.
    Jets,
    /// Values of the inverse.
    Inverse,
}

impl Ask {
    /// The command of the text protocol.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Jets => "jets",
            Self::Inverse => "inverse",
        }
    }

    /// The number of numbers in the answer for one point.
    pub(crate) fn numbers(self) -> usize {
        if self == Self::Jets { 6 } else { 2 }
    }
}

/// Reads a point from two numbers of an answer.
pub(crate) fn point(&[x, y]: &[f64; 2]) -> Point {
    Point::new(x, y)
}

/// Reads a jet from six numbers of an answer: F, ∂F/∂x, ∂F/∂y.
pub(crate) fn jet(&[x, y, xx, xy, yx, yy]: &[f64; 6]) -> Jet {
    Jet { p: Point::new(x, y), dx: Vec2::new(xx, xy), dy: Vec2::new(yx, yy) }
}

/// A program's description of the map that it has built.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct BuildAnswer {
    pub(crate) notes: Vec<String>,
    pub(crate) warnings: Vec<String>,
    pub(crate) creases: Vec<CreaseAnswer>,
    /// The size of the map's smallest feature; see [`Map::detail`](pathwarp::map::Map::detail).
    pub(crate) detail: Option<f64>,
}

/// A crease, or an edge of the domain. The domain is where the level is positive.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CreaseAnswer {
    /// a·x + b·y + c.
    pub(crate) line: Option<[f64; 3]>,
    /// x0, y0, x1, y1: only the part of the line within this box.
    pub(crate) within: Option<[f64; 4]>,
    /// cx, cy, r: the distance from the center less r; if r is negative, |r| less the distance.
    pub(crate) circle: Option<[f64; 3]>,
    pub(crate) edge: bool,
}

impl CreaseAnswer {
    fn crease(&self) -> Option<Crease> {
        let level = match (self.line, self.circle, self.within) {
            (Some([a, b, c]), None, None) if a.hypot(b) > 0.0 => Level::Line { a, b, c },
            (Some([a, b, c]), None, Some([x0, y0, x1, y1])) if a.hypot(b) > 0.0 && !self.edge => {
                Level::Stretch { a, b, c, within: Rect::new(x0, y0, x1, y1) }
            }
            (None, Some([x, y, r]), None) if r != 0.0 => Level::Circle { center: Point::new(x, y), radius: r },
            _ => return None,
        };
        Some(Crease { level, kind: if self.edge { CreaseKind::Edge } else { CreaseKind::Kink } })
    }
}

/// The creases that a program declares.
pub(crate) fn creases(answers: &[CreaseAnswer]) -> Result<Creases, Fault> {
    let mut out = Creases::default();
    for answer in answers {
        let wrong = || Fault::Garbage { expected: "a crease".into(), found: format!("{answer:?}") };
        out.push(answer.crease().ok_or_else(wrong)?);
    }
    Ok(out)
}
