//! Room for the width of the cut: parts grow by half of it and their holes shrink, so that what is cut has the size drawn.

use pathwarp::edit::{Offset, OpenPaths, Side, moved};
use pathwarp::kurbo::{BezPath, Join, Point, Rect, Shape as _};
use pathwarp::outline::Subpath;
use pathwarp::{GeometryError, Outline, refit};

/// Rounding, as a share of a radius.
const SLACK: f64 = 1e-6;

/// An outline to cut.
pub(super) struct Cut {
    pub(super) outline: Outline,
    /// The fill rule of an area; `None` for lines.
    pub(super) even_odd: Option<bool>,
}

/// Moves closed contours by `by` to the outside of what they enclose; open lines stay. The areas of a fill follow its rule. Contours
/// of lines alone are holes if an odd number of the others is around them; `among` says which lines belong together. Returns by how many
/// there are fewer contours.
pub(super) fn widen<K: PartialEq>(
    cuts: &mut [Cut],
    among: impl Fn(usize) -> K,
    by: f64,
    options: &refit::Options,
) -> Result<usize, GeometryError> {
    let loops: Vec<(usize, Loop)> =
        cuts.iter().enumerate().filter(|(_, c)| c.even_odd.is_none()).flat_map(loops).collect();
    let is_hole = |i: usize, s: &Subpath| {
        let within = Within::new(s);
        let around = |(k, l): &&(usize, Loop)| among(*k) == among(i) && l.is_around(&within);
        loops.iter().filter(around).count() % 2 == 1
    };
    let mut fewer = 0;
    for (i, cut) in cuts.iter_mut().enumerate() {
        let (closed, open): (Vec<Subpath>, Vec<Subpath>) = cut.outline.subpaths.drain(..).partition(|s| s.closed);
        let areas: Vec<(Outline, Side)> = match cut.even_odd {
            Some(_) if closed.is_empty() => Vec::new(),
            Some(_) => vec![(Outline { subpaths: closed }, Side::Outside)],
            None => closed
                .into_iter()
                .map(|s| {
                    let side = if is_hole(i, &s) { Side::Inside } else { Side::Outside };
                    (Outline { subpaths: vec![s] }, side)
                })
                .collect(),
        };
        for (area, side) in areas {
            let even_odd = cut.even_odd == Some(true);
            let offset = Offset { by, join: Join::Miter, side, even_odd, open: OpenPaths::Stay };
            let to = moved(&area, &offset, options, &[])?.outline;
            fewer += area.subpaths.len().saturating_sub(to.subpaths.len());
            cut.outline.subpaths.extend(to.subpaths);
        }
        cut.outline.subpaths.extend(open);
    }
    Ok(fewer)
}

/// A contour of lines, to be looked up.
struct Loop {
    path: BezPath,
    bounds: Rect,
    start: Point,
}

impl Loop {
    /// Returns `true` if a contour lies inside of this one and does not cross it.
    fn is_around(&self, s: &Within) -> bool {
        let reach = SLACK * (s.bounds.width() + s.bounds.height());
        self.start != s.start
            && self.bounds.inflate(reach, reach).contains_rect(s.bounds)
            && s.points.iter().all(|p| self.path.winding(*p) != 0)
    }
}

/// A contour that may lie inside of others.
struct Within {
    bounds: Rect,
    start: Point,
    points: Vec<Point>,
}

impl Within {
    fn new(s: &Subpath) -> Self {
        /// Most segments looked at, and how far from edges that contours may share, against the contour's size.
        const MOST: usize = 8;
        const BESIDE: f64 = 1e-3;
        let bounds = s.bounding_box();
        let beside = |p: Point| p.lerp(bounds.center(), BESIDE);
        let middles = s.segs.iter().step_by(s.segs.len().div_ceil(MOST).max(1)).map(|seg| seg.eval(0.5));
        Self { bounds, start: s.start, points: middles.chain([s.start]).map(beside).collect() }
    }
}

fn loops((i, cut): (usize, &Cut)) -> impl Iterator<Item = (usize, Loop)> {
    /// Arcs as cubics, against the contour's size: enough to tell inside from outside.
    const ROUGH: f64 = 1e-4;
    let closed = cut.outline.subpaths.iter().filter(|s| s.closed);
    closed.map(move |s| {
        let path = Outline { subpaths: vec![s.clone()] }.to_bez_path(ROUGH * s.diagonal());
        (i, Loop { path, bounds: s.bounding_box(), start: s.start })
    })
}
