//! Pieces of the output, and the path they are written to.

use super::report::{PathReport, RefittedPath, SpanReport};
use kurbo::{BezPath, CubicBez, Line, Point};

/// One segment of the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FittedPiece {
    Line(Line),
    Cubic(CubicBez),
}

impl FittedPiece {
    fn reversed(self) -> Self {
        match self {
            Self::Line(l) => Self::Line(Line::new(l.p1, l.p0)),
            Self::Cubic(c) => Self::Cubic(CubicBez::new(c.p3, c.p2, c.p1, c.p0)),
        }
    }
}

/// Reverses the direction of a run of pieces.
pub(super) fn reverse(pieces: &mut [FittedPiece]) {
    pieces.reverse();
    for p in pieces {
        *p = p.reversed();
    }
}

/// Collects the output, subpath by subpath.
#[derive(Debug, Default)]
pub(super) struct PathWriter {
    path: BezPath,
    pub(super) report: PathReport,
    pub(super) spans: Vec<SpanReport>,
}

impl PathWriter {
    /// Writes a subpath. In a closed one, a last line is left to the close command.
    pub(super) fn subpath(&mut self, start: Point, pieces: &[FittedPiece], closed: bool) {
        self.report.segments_out += pieces.len();
        self.path.move_to(start);
        let by_close = closed && matches!(pieces.last(), Some(FittedPiece::Line(_)));
        for p in &pieces[..pieces.len() - usize::from(by_close)] {
            match p {
                FittedPiece::Line(l) => self.path.line_to(l.p1),
                FittedPiece::Cubic(c) => self.path.curve_to(c.p1, c.p2, c.p3),
            }
        }
        if closed {
            self.path.close_path();
        }
    }

    pub(super) fn finish(self) -> RefittedPath {
        RefittedPath { path: self.path, spans: self.spans, report: self.report }
    }
}
