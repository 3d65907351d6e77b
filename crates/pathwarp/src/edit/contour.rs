//! The line around an area at a distance, and necks that join islands: the edges of a minimum spanning tree, by Prim's algorithm.

use super::area::{Area, outermost};
use super::offset::{Moved, Offset, OpenPaths, Side, moved};
use crate::budget::cost;
use crate::error::GeometryError;
use crate::outline::{Outline, Seg, Subpath};
use crate::refit::{ARCS, Options, PathReport};
use kurbo::{Join, Point, Rect};

/// The settings of a line around an area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contour {
    /// Distance from the area in user units; below zero, the line is inside.
    pub by: f64,
    /// `true` if holes that remain at the distance get a line, too.
    pub holes: bool,
    /// `true` if islands that the distance leaves apart are joined by necks as wide as the distance.
    pub join: bool,
}

/// The result of [`around`].
#[derive(Debug, Clone)]
pub struct Around {
    /// Lines, arcs and curves.
    pub outline: Outline,
    /// The number of islands, each with one line around it.
    pub islands: usize,
    /// The numbers of nodes, and the error.
    pub report: PathReport,
}

/// Draws the line around an area, with arcs around corners. Every point of the line has the given distance from the area, within
/// `options.tolerance`, unless it lies on a neck.
///
/// # Errors
/// [`GeometryError::Crossings`] when crossings of edges are not found, [`GeometryError::Limit`] for too many islands to join.
///
/// ```
/// use pathwarp::edit::{Area, Contour, around};
/// use pathwarp::{Outline, refit::Options};
///
/// let two = Outline::from_svg("M0,0H10V10H0ZM15,0H25V10H15Z")?;
/// let area = Area::of(&two, false, 0.01)?;
/// let line = |by, join| around(&area, &Contour { by, holes: false, join }, &Options::new(0.01));
/// assert_eq!([line(2.0, false)?.islands, line(2.0, true)?.islands, line(3.0, false)?.islands], [2, 1, 1]);
/// # Ok::<(), pathwarp::Error>(())
/// ```
pub fn around(area: &Area, contour: &Contour, options: &Options) -> Result<Around, GeometryError> {
    let side = if contour.by < 0.0 { Side::Inside } else { Side::Outside };
    let offset = Offset { by: contour.by.abs(), join: Join::Round, side, even_odd: false, open: OpenPaths::Close };
    let Moved { mut outline, path } = moved(area.outline(), &offset, options, &[])?;
    let (mut report, arc_tolerance) = (path.report, ARCS * options.tolerance);
    let without_holes = |o: Outline| if contour.holes { o } else { outermost(&o, arc_tolerance) };
    outline = without_holes(outline);
    let mut area = Area::of(&outline, false, options.tolerance)?;
    if contour.join && area.counts()[0] > 1 {
        let necks = necks(&area, contour.by.abs(), options)?;
        let necks = Area::union(&necks, options.tolerance)?;
        area = Area::union([&area, &necks], options.tolerance)?;
        outline = without_holes(area.with_arcs_of(&outline, options.tolerance));
    }
    let islands = area.counts()[0];
    report.segments_out = outline.segs().count();
    Ok(Around { outline, islands, report })
}

/// An island of an area.
struct Island {
    /// Points on its outline.
    points: Vec<Point>,
    bounds: Rect,
}

impl Island {
    fn new(subpath: &Subpath) -> Self {
        /// Number of points on each segment.
        const PER_SEGMENT: u32 = 16;
        let samples =
            |s: &Seg| (0..PER_SEGMENT).map(|i| s.eval(f64::from(i) / f64::from(PER_SEGMENT))).collect::<Vec<_>>();
        Self { points: subpath.segs.iter().flat_map(samples).collect(), bounds: subpath.bounding_box() }
    }

    /// Returns the ends of the shortest way to another island, between points of both.
    fn shortest_way(&self, other: &Self) -> Option<[Point; 2]> {
        let pairs = self.points.iter().flat_map(|p| other.points.iter().map(move |q| [*p, *q]));
        pairs.min_by(|a, b| a[0].distance_squared(a[1]).total_cmp(&b[0].distance_squared(b[1])))
    }
}

/// Returns necks of a width that join all islands of an area along the shortest ways.
fn necks(area: &Area, width: f64, options: &Options) -> Result<Vec<Area>, GeometryError> {
    let islands: Vec<Island> = area.islands().iter().map(Island::new).collect();
    let points: usize = islands.iter().map(|i| i.points.len()).sum();
    options.budget.spend(cost::COMPARISON * (points as f64).powi(2)).map_err(GeometryError::Limit)?;
    let distance = |a: &Rect, b: &Rect| {
        let gap = |p: f64, q: f64| p.max(q).max(0.0);
        gap(a.x0 - b.x1, b.x0 - a.x1).hypot(gap(a.y0 - b.y1, b.y0 - a.y1))
    };
    // The shortest way to each island from those already joined, at first only island 0. `last` is the island joined last.
    let mut ways: Vec<Option<[Point; 2]>> = vec![None; islands.len()];
    let mut left: Vec<usize> = (1..islands.len()).collect();
    let (mut last, mut out) = (0, Vec::new());
    let length = |way: &Option<[Point; 2]>| way.map_or(f64::INFINITY, |[p, q]| p.distance(q));
    while !left.is_empty() {
        for &i in &left {
            if distance(&islands[last].bounds, &islands[i].bounds) < length(&ways[i]) {
                let way = islands[last].shortest_way(&islands[i]);
                if length(&way) < length(&ways[i]) {
                    ways[i] = way;
                }
            }
        }
        let Some(next) = (0..left.len()).min_by(|a, b| length(&ways[left[*a]]).total_cmp(&length(&ways[left[*b]])))
        else {
            break;
        };
        last = left.swap_remove(next);
        if let Some([p, q]) = ways[last].filter(|[p, q]| p.distance(*q) > 0.0) {
            // The ends reach into the islands, whose outlines may curve away beside the neck.
            let along = (q - p).normalize() * (0.5 * width);
            let across = along.turn_90();
            let corners = [p - along + across, q + along + across, q + along - across, p - along - across];
            out.push(Area::of(&Outline::from_points(&corners, true), false, options.tolerance)?);
        }
    }
    Ok(out)
}
