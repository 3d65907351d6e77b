//! Back to Béziers: the image of a path under a map, as lines and cubics within a stated distance.
//!
//! One entry, [`warp_path`]. Affine maps move control points; elsewhere each source segment is split where the map is not
//! smooth, and every part's image is fitted adaptively.

mod fit;

use crate::error::GeometryError;
use crate::map::{Class, Creases, Map};
use crate::outline::{Outline, Seg, Subpath};
use kurbo::{Affine, BezPath, CubicBez, Line, Point};

/// How a path is refitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The largest allowed distance, in root user units, between the true image and the output, measured both ways.
    pub tolerance: f64,
    /// Prove the bound where the map allows it, instead of checking it densely.
    pub certify: bool,
    /// Join consecutive pieces across smooth joints where that saves nodes.
    pub merge: bool,
}

impl Options {
    /// Checked against `tolerance`, without merging.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, certify: false, merge: false }
    }
}

/// How the reported error is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assurance {
    /// Sampled densely; true up to what happens between samples.
    Checked,
    /// A proven bound.
    Certified,
    /// No approximation was made; the error is rounding.
    Exact,
}

/// What refitting a path did.
#[derive(Debug, Clone, PartialEq)]
pub struct PathReport {
    /// Segments in the source, closing lines included.
    pub segments_in: usize,
    /// Segments in the output, closing lines included.
    pub segments_out: usize,
    /// The largest distance between true image and output, root user units.
    pub max_error: f64,
    /// How `max_error` is known: the weakest of all segments.
    pub assurance: Assurance,
    /// Places in the source where the work budget ended before the tolerance was met.
    pub over_budget: Vec<Point>,
}

/// A warped path.
#[derive(Debug, Clone, PartialEq)]
pub struct Warped {
    /// The image.
    pub path: BezPath,
    /// What was done.
    pub report: PathReport,
}

/// The image of `outline` under `map`, within `options.tolerance`.
///
/// Sub-paths keep their order, direction and closedness; source nodes stay nodes; smooth joints stay smooth. Affine maps
/// move control points (arcs become cubics within the tolerance); under projective maps lines stay lines.
///
/// # Errors
/// [`GeometryError::Infinity`] if the path meets a place where the map is undefined or not finite,
/// [`GeometryError::NotFinite`] if the path itself has such coordinates. The shape's name in them is "path"; see
/// [`GeometryError::on_shape`].
///
/// ```
/// use pathwarp::{Outline, map::Formula, map::Real, refit};
///
/// struct Wave;
/// impl Formula for Wave {
///     fn f<S: Real>(&self, x: S, y: S) -> (S, S) { (x, y + (x / 20.0).sin() * 5.0) }
/// }
/// let square = Outline::from_svg("M0 0H100V100H0Z").unwrap();
/// let warped = refit::warp_path(&square, &Wave, &refit::Options::new(0.01)).unwrap();
/// assert!(warped.report.max_error <= 0.01);
/// ```
pub fn warp_path(outline: &Outline, map: &dyn Map, options: &Options) -> Result<Warped, GeometryError> {
    if let Some(bad) = outline.segs().find(|s| !s.is_finite()) {
        return Err(GeometryError::NotFinite { shape: PATH.into(), at: bad.start() });
    }
    let mut out = Output::default();
    if let Class::Affine(m) = map.class() {
        affine(outline, m, options, &mut out);
    } else {
        let mut creases = Creases::default();
        map.creases(&mut creases);
        for sub in &outline.subpaths {
            warp_subpath(sub, map, &creases, options, &mut out)?;
        }
    }
    out.report.segments_in = outline.segs().count();
    Ok(Warped { path: out.path, report: out.report })
}

/// What a shape is called until its owner names it.
const PATH: &str = "path";

/// One output piece.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    Line(Line),
    Cubic(CubicBez),
}

#[derive(Debug)]
struct Output {
    path: BezPath,
    report: PathReport,
}

impl Default for Output {
    fn default() -> Self {
        let report = PathReport {
            segments_in: 0,
            segments_out: 0,
            max_error: 0.0,
            assurance: Assurance::Exact,
            over_budget: Vec::new(),
        };
        Self { path: BezPath::new(), report }
    }
}

impl Output {
    fn note(&mut self, error: f64, assurance: Assurance) {
        self.report.max_error = self.report.max_error.max(error);
        self.report.assurance = self.report.assurance.min(assurance);
    }

    /// Writes a subpath; a closed one's last line is drawn by the close command.
    fn subpath(&mut self, start: Point, pieces: &[Piece], closed: bool) {
        self.report.segments_out += pieces.len();
        self.path.move_to(start);
        let by_close = closed && matches!(pieces.last(), Some(Piece::Line(_)));
        for p in &pieces[..pieces.len() - usize::from(by_close)] {
            match p {
                Piece::Line(l) => self.path.line_to(l.p1),
                Piece::Cubic(c) => self.path.curve_to(c.p1, c.p2, c.p3),
            }
        }
        if closed {
            self.path.close_path();
        }
    }
}

/// Control points move exactly; only arcs need approximating, which is done after the map, so that the tolerance counts there.
fn affine(outline: &Outline, m: Affine, options: &Options, out: &mut Output) {
    for sub in &outline.subpaths {
        let mut pieces = Vec::with_capacity(sub.segs.len());
        for seg in &sub.segs {
            match seg.transformed(m) {
                Seg::Line(l) => pieces.push(Piece::Line(l)),
                Seg::Arc(a) => {
                    pieces.extend(a.to_cubics(options.tolerance).map(Piece::Cubic));
                    out.note(options.tolerance, Assurance::Certified);
                }
                other => pieces.push(Piece::Cubic(other.to_cubic())),
            }
        }
        out.subpath(m * sub.start, &pieces, sub.closed);
    }
}

fn warp_subpath(
    sub: &Subpath,
    map: &dyn Map,
    creases: &Creases,
    options: &Options,
    out: &mut Output,
) -> Result<(), GeometryError> {
    let projective = matches!(map.class(), Class::Projective(_));
    let infinity = |at| GeometryError::Infinity { shape: PATH.into(), at };
    if !creases.defined_at(sub.start) || !map.point(sub.start).is_finite() {
        return Err(infinity(sub.start));
    }
    let mut pieces = Vec::with_capacity(sub.segs.len());
    for seg in &sub.segs {
        if let Some(at) = creases.first_undefined(seg) {
            return Err(infinity(at));
        }
        if projective && let Seg::Line(l) = seg {
            pieces.push(Piece::Line(Line::new(map.point(l.p0), map.point(l.p1))));
            continue;
        }
        let mut from = 0.0;
        for to in creases.splits(seg).into_iter().chain([1.0]) {
            let branch = map.branch(seg.eval(0.5 * (from + to)));
            let map: &dyn Map = branch.as_ref().map_or(map, |b| b);
            fit::fit(seg, from, to, map, options.tolerance, &mut pieces, &mut out.report).map_err(infinity)?;
            from = to;
        }
    }
    out.subpath(map.point(sub.start), &pieces, sub.closed);
    Ok(())
}
