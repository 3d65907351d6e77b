//! Offsets: outlines at a distance.

use super::area::separate;
use super::exact_edges;
use crate::error::GeometryError;
use crate::outline::{Outline, Seg};
use crate::refit::{ARCS, Options, PathReport, RefittedPath};
use bezierfit::{Fitted, union_even_odd};
use kurbo::{BezPath, Join, Line, Rect};

/// Largest reach of an offset's miters, in multiples of its distance.
const MITERS: f64 = 4.0;

/// Fraction of the tolerance within which cubics replace the arcs of a finished result; [`ARCS`] is the fraction for arcs of the source.
const RESULT_ARCS: f64 = 0.99;

/// The side to which [`moved`] moves outlines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Areas grow; open paths move to their right, seen along them.
    Outside,
    /// Areas shrink; open paths move to their left.
    Inside,
    /// Both, as a stroke does.
    Both,
}

/// The treatment of open subpaths by [`moved`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenPaths {
    /// They stay as they are.
    Stay,
    /// They become the paths beside them.
    Move,
    /// They enclose areas, as fills do.
    Close,
}

/// The distance and the direction in which [`moved`] moves outlines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offset {
    /// Distance in user units, above zero.
    pub by: f64,
    /// The join at corners that open. Miters reach up to four times the distance; longer ones are cut off on areas, left out on paths.
    pub join: Join,
    /// The side to which outlines move.
    pub side: Side,
    /// `true` if closed subpaths enclose an area by the even-odd rule instead of the nonzero rule.
    pub even_odd: bool,
    /// The treatment of open subpaths.
    pub open: OpenPaths,
}

/// The result of [`moved`].
#[derive(Debug, Clone)]
pub struct Moved {
    /// The offset, with exact lines and arcs beside lines and arcs of the source.
    pub outline: Outline,
    /// The offset with cubics instead of arcs, and a report.
    pub path: RefittedPath,
}

/// Offsets an outline: each point of the result has the given distance from it, within `options.tolerance`. Closed subpaths enclose an
/// area, which grows or shrinks, and vanishes where it is too narrow; loops are removed. The result is exact beside lines and circular
/// arcs and around corners. Closed subpaths begin near the first points of the source. `contours` holds tolerances of the subpaths;
/// others have the tolerance of the options. Subpaths close together have the smallest of their tolerances.
///
/// # Errors
/// [`GeometryError::NotFinite`] for a coordinate that is not finite, [`GeometryError::Crossings`] when crossings of edges are not found.
///
/// ```
/// use pathwarp::edit::{Offset, OpenPaths, Side, moved};
/// use pathwarp::kurbo::{Join, Shape};
/// use pathwarp::{Outline, refit::Options};
///
/// let square = Outline::from_svg("M0,0H60V60H0Z")?;
/// let by = Offset { by: 10.0, join: Join::Miter, side: Side::Outside, even_odd: false, open: OpenPaths::Move };
/// let larger = moved(&square, &by, &Options::new(0.01), &[])?;
/// assert_eq!(larger.path.path.to_svg(), "M-10,-10 L70,-10 L70,70 L-10,70 Z");
/// # Ok::<(), pathwarp::Error>(())
/// ```
pub fn moved(outline: &Outline, offset: &Offset, options: &Options, contours: &[f64]) -> Result<Moved, GeometryError> {
    let reach = if offset.join == Join::Miter { MITERS } else { 1.0 } * offset.by;
    let segments_in = outline.segs().count();
    let (outline, staying) = &moving_and_staying(outline, offset.open);
    let boxes: Vec<Rect> = outline.subpaths.iter().map(|s| s.bounding_box().inflate(reach, reach)).collect();
    let (mut out, mut path, mut report) = (Outline::default(), BezPath::new(), PathReport::default());
    // Groups that lines along the axes separate cannot meet.
    for group in separate(&boxes) {
        let tolerance_of =
            |i: &usize| contours.get(*i).copied().unwrap_or_else(|| options.of_contour(&outline.subpaths[*i]));
        let tolerance = group.iter().map(tolerance_of).fold(f64::INFINITY, f64::min);
        let group = Outline { subpaths: group.iter().map(|i| outline.subpaths[*i].clone()).collect() };
        for fitted in moved_group(&group, offset, tolerance)? {
            let miters = (offset.join != Join::Round).then_some(reach);
            let moved = exact_edges::insert(Outline::from(&fitted.path), &group, offset.by, miters, tolerance);
            let arc_tolerance = RESULT_ARCS * tolerance;
            let mut group_report = PathReport::fitted(&fitted.report, tolerance);
            for seg in moved.segs() {
                if let Seg::Arc(a) = seg {
                    let error = a.cubics_error(a.cubics_needed(arc_tolerance));
                    group_report.max_error = group_report.max_error.max(error);
                }
            }
            report.add(group_report);
            path.extend(moved.to_bez_path(arc_tolerance));
            out.subpaths.extend(moved.subpaths);
        }
    }
    path.extend(staying.to_bez_path(ARCS * options.tolerance));
    out.subpaths.extend(staying.subpaths.iter().cloned());
    (report.segments_in, report.segments_out) = (segments_in, path.segments().count());
    Ok(Moved { outline: out, path: RefittedPath { path, spans: Vec::new(), report } })
}

/// Returns the subpaths that move, and those that stay.
fn moving_and_staying(outline: &Outline, open: OpenPaths) -> (Outline, Outline) {
    let (mut moving, mut staying) = (outline.clone(), Outline::default());
    match open {
        OpenPaths::Move => {}
        OpenPaths::Stay => {
            (moving.subpaths, staying.subpaths) = moving.subpaths.into_iter().partition(|s| s.closed);
        }
        OpenPaths::Close => {
            for s in moving.subpaths.iter_mut().filter(|s| !s.closed) {
                if s.end() != s.start {
                    s.segs.push(Seg::Line(Line::new(s.end(), s.start)));
                }
                s.closed = true;
            }
        }
    }
    (moving, staying)
}

/// Offsets subpaths together, to each of the wanted sides.
fn moved_group(outline: &Outline, offset: &Offset, tolerance: f64) -> Result<Vec<Fitted>, GeometryError> {
    let arc_tolerance = ARCS * tolerance;
    let fitter = bezierfit::Options::new(tolerance - arc_tolerance);
    let mut source = outline.to_bez_path(arc_tolerance);
    if offset.even_odd {
        let open = outline.subpaths.iter().filter(|s| !s.closed).cloned().collect();
        // This moves edges by a few hundredths of `arc_tolerance`.
        let mut area = union_even_odd(&source, arc_tolerance)?;
        area.extend(Outline { subpaths: open }.to_bez_path(arc_tolerance));
        source = area;
    }
    let signs: &[f64] = match offset.side {
        Side::Outside => &[1.0],
        Side::Inside => &[-1.0],
        Side::Both => &[1.0, -1.0],
    };
    let moved = |sign: &f64| bezierfit::offset(&source, sign * offset.by, offset.join, &fitter);
    Ok(signs.iter().map(moved).collect::<Result<_, _>>()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::united;

    /// The miter of a tip of 31° reaches 3.7 times the distance, into a bar at three times the distance.
    #[test]
    fn miters_unite_with_what_they_reach() {
        let outline = Outline::from_svg("M0,0L36,10L0,20ZM39,0H49V20H39Z").unwrap();
        let by = Offset { by: 1.0, join: Join::Miter, side: Side::Outside, even_odd: false, open: OpenPaths::Move };
        let grown = moved(&outline, &by, &Options::new(0.01), &[]).unwrap();
        assert_eq!(grown.outline.subpaths.len(), 1);
        assert_eq!(united(&grown.outline, false, 0.01).unwrap(), None);
    }
}
