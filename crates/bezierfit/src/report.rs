//! Pieces, and reports on their error.

use kurbo::{BezPath, CubicBez, Line, ParamCurveNearest, Point};

/// One segment of the output. Quadratics, which only splines have, are no pieces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// A line.
    Line(Line),
    /// A cubic.
    Cubic(CubicBez),
}

impl Piece {
    /// Distance of a point from the piece.
    pub(crate) fn distance(&self, p: Point) -> f64 {
        let nearest = match self {
            Self::Line(l) => l.nearest(p, 0.0),
            Self::Cubic(c) => c.nearest(p, 1e-9 * (c.p3 - c.p0).hypot()),
        };
        nearest.distance_sq.sqrt()
    }

    /// First point.
    #[must_use]
    pub fn start(&self) -> Point {
        match self {
            Self::Line(l) => l.p0,
            Self::Cubic(c) => c.p0,
        }
    }

    /// The piece in the other direction.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Line(l) => Self::Line(Line::new(l.p1, l.p0)),
            Self::Cubic(c) => Self::Cubic(CubicBez::new(c.p3, c.p2, c.p1, c.p0)),
        }
    }
}

/// Basis of the reported error, from the weakest to the strongest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assurance {
    /// Measured by sampling a curve of which nothing else is known. Errors may hide between the samples.
    Sampled,
    /// Measured by sampling as densely as the curve needs. The error between samples is estimated.
    Checked,
    /// A proven bound.
    Certified,
    /// Nothing was approximated; the error is rounding.
    Exact,
}

/// A checked error is reported times this factor, for what lies between the samples; that of an accepted piece at most as the tolerance.
pub(crate) const REPORT_MARGIN: f64 = 1.05;

/// Error of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PieceReport {
    /// Largest distance between the piece and its part of the curve.
    pub error: f64,
    /// Basis of `error`.
    pub assurance: Assurance,
}

/// Error of a fit, as a whole and by pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Largest distance between the curve and the output.
    pub max_error: f64,
    /// Basis of `max_error`: the weakest of all pieces.
    pub assurance: Assurance,
    /// Points at which the tolerance was not met, as the source [names them](crate::Source::place).
    pub unresolved: Vec<Point>,
    /// The pieces, in order.
    pub pieces: Vec<PieceReport>,
}

impl Default for Report {
    fn default() -> Self {
        Self { max_error: 0.0, assurance: Assurance::Exact, unresolved: Vec::new(), pieces: Vec::new() }
    }
}

impl Report {
    /// Accounts for a piece with this error.
    #[inline]
    pub fn add_error(&mut self, error: f64, assurance: Assurance) {
        self.pieces.push(PieceReport { error, assurance });
        self.add_bound(error, assurance);
    }

    fn add_bound(&mut self, error: f64, assurance: Assurance) {
        self.max_error = self.max_error.max(error);
        self.assurance = self.assurance.min(assurance);
    }

    /// Removes the entries of the pieces from number `first` on. Returns their report. Unresolved points, which belong to no piece, stay.
    pub(crate) fn split_off(&mut self, first: usize) -> Self {
        let [before, mut after] = [std::mem::take(self), Self::default()];
        for (i, p) in before.pieces.iter().enumerate() {
            if i < first { &mut *self } else { &mut after }.add_error(p.error, p.assurance);
        }
        self.unresolved = before.unresolved;
        after
    }

    /// Adds an error to the pieces from number `first` on.
    pub(crate) fn widen(&mut self, first: usize, by: f64) {
        self.pieces[first..].iter_mut().for_each(|p| p.error += by);
        self.max_error = self.pieces[first..].iter().map(|p| p.error).fold(self.max_error, f64::max);
    }

    /// Adds the report of another part.
    pub fn add(&mut self, part: &Self) {
        self.add_bound(part.max_error, part.assurance);
        self.unresolved.extend(&part.unresolved);
        self.pieces.extend(&part.pieces);
    }
}

/// A path with the report on its error.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Fitted {
    /// Lines, and cubics or quadratics.
    pub path: BezPath,
    /// Distance of the path from the source.
    pub report: Report,
}
