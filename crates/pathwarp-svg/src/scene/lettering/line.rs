//! Lines of lettering and their letters.

use crate::source::tags::ElementId;
use pathwarp::kurbo::{Affine, Point, Vec2};
use std::ops::Range;

/// A letter with the subpaths that draw it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlacedLetter {
    pub(crate) name: String,
    /// Root user space.
    pub(crate) origin: Point,
    pub(crate) advance: f64,
    /// Parts, with the range of their subpaths.
    pub(crate) subpaths: Vec<(usize, Range<usize>)>,
}

/// Heights of a line's font above the baseline (the descent: below it), in the line's user units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Heights {
    pub(crate) ascent: f64,
    pub(crate) descent: f64,
    pub(crate) cap_height: f64,
    pub(crate) x_height: f64,
}

/// A line of lettering, in root user space.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextLine {
    /// Name for messages.
    pub(crate) name: String,
    /// The element of the whole text, if any.
    pub(crate) owner: Option<ElementId>,
    pub(crate) start: Point,
    pub(crate) end: Point,
    /// Root user units.
    pub(crate) heights: Heights,
    /// `true` if the baseline is horizontal and runs to the right, with upright letters.
    pub(crate) level: bool,
    pub(crate) letters: Vec<PlacedLetter>,
}

impl TextLine {
    /// Makes a line without letters between two points of a user space that `frame` maps to root user space. `straight` is
    /// `false` for text on a path.
    pub(crate) fn new(name: String, from: Point, to: Point, heights: Heights, frame: Affine, straight: bool) -> Self {
        /// Largest slope that single-precision rounding can give a horizontal line.
        const TILT: f64 = 1e-5;
        let (start, end) = (frame * from, frame * to);
        let [a, b, c, d, ..] = frame.as_coeffs();
        let up = |h: f64| (Vec2::new(-c, -d) * h).hypot();
        let heights = Heights {
            ascent: up(heights.ascent),
            descent: up(heights.descent),
            cap_height: up(heights.cap_height),
            x_height: up(heights.x_height),
        };
        let run = end.x - start.x;
        let level = straight && d > 0.0 && run > 0.0 && (end.y - start.y).abs() <= TILT * run && b.abs() <= TILT * a;
        Self { name, owner: None, start, end, heights, level, letters: Vec::new() }
    }
}
