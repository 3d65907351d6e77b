//! Outlines of strokes.

use super::{EllipticArc, Outline, Seg, Subpath};
use bezierfit::parts::{Edge, EdgeCurve, contours, drawn_dashes};
use bezierfit::{NotFinite, Piece};
use kurbo::{Stroke, Vec2};

/// Share of the tolerance for converting arcs to cubics, whose error falls with the sixth power of their number.
const ARCS: f64 = 0.05;

/// Share of the tolerance for converting arcs of dashed paths. Cubics at a distance from an arc differ in length, which shifts dashes.
const DASHED_ARCS: f64 = 0.01;

impl Outline {
    /// Returns the area that a stroke along this path covers, within `tolerance`, to be filled by the nonzero rule. Joints whose sides are
    /// less than `gap` apart get no join, which adds up to half of `gap` to the error. If `clipped`, miters are cut off at their limit.
    ///
    /// # Errors
    /// [`NotFinite`] when a coordinate of the path is not finite.
    pub fn stroked(&self, style: &Stroke, clipped: bool, [tolerance, gap]: [f64; 2]) -> Result<Self, NotFinite> {
        let arcs = if style.dash_pattern.is_empty() { ARCS } else { DASHED_ARCS } * tolerance;
        let contours = contours(&self.to_bez_path(arcs), style, clipped, gap)?;
        let subpath = |contour: &Vec<Edge>| {
            let mut segs = Vec::with_capacity(contour.len());
            for edge in contour {
                append(edge, tolerance - arcs, &mut segs)?;
            }
            Ok(Subpath { start: contour[0].p0, segs, closed: true })
        };
        Ok(Self { subpaths: contours.iter().map(subpath).collect::<Result<_, NotFinite>>()? })
    }

    /// Returns an upper bound for the number of dashes that [`stroked`](Self::stroked) draws; 0 if there are none, or so many that it draws
    /// a solid line.
    #[must_use]
    pub fn drawn_dashes(&self, pattern: &[f64]) -> f64 {
        drawn_dashes(self.segs().map(Seg::to_cubic), pattern)
    }
}

/// Appends an edge of a stroke's outline.
fn append(edge: &Edge, tolerance: f64, out: &mut Vec<Seg>) -> Result<(), NotFinite> {
    if let EdgeCurve::Arc(arc) = edge.curve {
        let r = arc.radii.x;
        let (a, b) = (Vec2::new(r, 0.0), Vec2::new(0.0, r));
        let arc = EllipticArc::new(arc.center, a, b, arc.start_angle, arc.sweep_angle);
        out.push(Seg::Arc(EllipticArc { p0: edge.p0, p1: edge.p1, ..arc }));
        return Ok(());
    }
    let mut pieces = Vec::new();
    edge.draft(tolerance, &mut pieces)?;
    out.extend(pieces.into_iter().map(|p| match p {
        Piece::Line(l) => Seg::Line(l),
        Piece::Cubic(c) => Seg::Cubic(c),
    }));
    Ok(())
}
