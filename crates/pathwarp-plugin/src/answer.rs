//! Requests, answers and descriptions of built maps, which the binary and the text form of the protocol share.

use crate::fault::Fault;
use pathwarp::engine::Ask;
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::{Crease, CreaseKind, Creases, Level};

/// Returns the command of the text protocol that asks so.
pub(crate) fn word(ask: Ask) -> &'static str {
    match ask {
        Ask::Points => "points",
        Ask::Jets => "jets",
        Ask::Inverse => "inverse",
    }
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
    pub(crate) fn crease(&self) -> Option<Crease> {
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
