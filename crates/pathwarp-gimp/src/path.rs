//! GIMP's paths and strokes, as outlines and in files.

use crate::error::Error;
use pathwarp::Outline;
use pathwarp::kurbo::{CubicBez, Line, Point};
use pathwarp::outline::{Seg, Subpath};

/// A named list of strokes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GimpPath {
    /// The name, unique in an image.
    pub name: String,
    /// Visibility in GIMP.
    pub visible: bool,
    /// The strokes, in order.
    pub strokes: Vec<Stroke>,
}

/// A connected sequence of anchors with their handles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stroke {
    /// `true` if the last anchor connects to the first.
    pub closed: bool,
    /// Control points in pixels, with y pointing down: for every anchor its incoming handle, the anchor, and its outgoing handle.
    /// Points from an XCF keep their single precision.
    pub points: Vec<[f64; 2]>,
}

impl GimpPath {
    /// Returns the bounding box of the curves (left, top, right, bottom); `None` for a path without anchors.
    #[must_use]
    pub fn bounds(&self) -> Option<[f64; 4]> {
        self.outline().bounding_box().map(|b| [b.x0, b.y0, b.x1, b.y1])
    }

    /// Returns the curves that GIMP draws. A segment whose handles coincide with their anchors is a line.
    #[must_use]
    pub fn outline(&self) -> Outline {
        Outline { subpaths: self.strokes.iter().filter_map(Stroke::subpath).collect() }
    }
}

impl Stroke {
    /// Returns the number of anchors.
    #[must_use]
    pub fn anchors(&self) -> usize {
        self.points.len() / 3
    }

    /// Returns the curve; `None` if there is no anchor.
    #[must_use]
    pub fn subpath(&self) -> Option<Subpath> {
        let triples: Vec<[Point; 3]> = self.triples().collect();
        let (first, last) = (triples.first()?, triples.last()?);
        let mut segs: Vec<Seg> = triples.windows(2).map(|w| segment(w[0], w[1])).collect();
        // Drop a closing segment without length, from a single anchor or from a last anchor on top of the first.
        let closing = segment(*last, *first);
        if self.closed && !matches!(closing, Seg::Line(l) if l.p0 == l.p1) {
            segs.push(closing);
        }
        Some(Subpath { start: first[1], segs, closed: self.closed })
    }

    /// Iterates over the anchors, each with its incoming handle before and its outgoing handle after it.
    pub fn triples(&self) -> impl Iterator<Item = [Point; 3]> + '_ {
        self.points.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|[x, y]| Point::new(x, y)))
    }

    /// Converts a curve to GIMP's form; see [`Subpath::with_handles`].
    #[must_use]
    pub fn from_subpath(s: &Subpath) -> Self {
        Self { closed: s.closed, points: s.with_handles().as_flattened().iter().map(|p| [p.x, p.y]).collect() }
    }
}

fn segment([_, p0, p1]: [Point; 3], [p2, p3, _]: [Point; 3]) -> Seg {
    if p1 == p0 && p2 == p3 { Seg::Line(Line::new(p0, p3)) } else { Seg::Cubic(CubicBez::new(p0, p1, p2, p3)) }
}

/// The formats in which GIMP stores paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileKind {
    /// An XCF of this version.
    Xcf(u32),
    /// An XCF of this version, compressed with gzip, bzip2 or xz.
    PackedXcf(u32),
    /// SVG as GIMP exports it.
    Svg,
    /// Point lists in JSON.
    Json,
    /// The text format of GIMP 1.
    Text,
}

/// The paths of a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathFile {
    /// The format of the file.
    pub kind: FileKind,
    /// Width and height of the canvas in pixels, if the file contains them.
    pub size: Option<[f64; 2]>,
    /// The paths, topmost first.
    pub paths: Vec<GimpPath>,
}

/// The readable part of a file that may be damaged.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Salvaged {
    /// The file with the paths before the damage.
    pub file: PathFile,
    /// The damage; `None` if the file is sound.
    pub damage: Option<Error>,
}

/// Returns the shortest text that parses to `v`: as an `f32` if `v` is one, as in GIMP's files, else as an `f64`.
pub(crate) fn shortest_number(v: f64) -> String {
    let single = v as f32;
    // Adding 0.0 turns -0 into 0.
    if f64::from(single) == v { (single + 0.0).to_string() } else { (v + 0.0).to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_and_curves_convert_both_ways() {
        let d = "M10,20 C30,5 40,60 50,50 L80,50 C90,50 5,5 10,20 Z M0,0 L5,5 L9,0";
        let outline = Outline::from_svg(d).unwrap();
        let strokes: Vec<Stroke> = outline.subpaths.iter().map(Stroke::from_subpath).collect();
        // The first handle of the closed stroke is the last control point of its closing segment.
        assert_eq!((strokes[0].anchors(), strokes[0].points[0]), (3, [5.0, 5.0]));
        assert_eq!((strokes[1].anchors(), strokes[1].closed), (3, false));
        let path = GimpPath { strokes, ..GimpPath::default() };
        assert_eq!(path.outline(), outline);
    }

    #[test]
    fn a_single_anchor_is_a_point_or_a_loop() {
        let dot = Stroke { closed: true, points: vec![[3.0, 4.0]; 3] };
        assert!(dot.subpath().unwrap().segs.is_empty());
        assert_eq!(Stroke::from_subpath(&dot.subpath().unwrap()), dot);
        let ring = Stroke { closed: true, points: vec![[0.0, 9.0], [3.0, 4.0], [9.0, 0.0]] };
        assert_eq!(Stroke::from_subpath(&ring.subpath().unwrap()), ring);
        // A symmetric hump; its top is at 3/4 of the height of its handles.
        let hump = Stroke { closed: false, points: vec![[0., 0.], [0., 0.], [0., 8.], [4., 8.], [4., 0.], [4., 0.]] };
        let path = GimpPath { strokes: vec![hump], ..GimpPath::default() };
        assert_eq!(path.bounds(), Some([0.0, 0.0, 4.0, 6.0]));
    }

    #[test]
    fn numbers_survive_a_round_trip() {
        for v in [0.0, 112.277_374_267_578_12, 1e7, -0.1, f64::from(f32::MIN_POSITIVE), 1.0 / 3.0, 34_002_432.0] {
            let back: f64 = shortest_number(v).parse().unwrap();
            assert_eq!(back as f32, v as f32);
            assert!(back == v || f64::from(v as f32) == v, "{v}");
        }
        assert_eq!(shortest_number(f64::from(12.55f32)), "12.55");
    }
}
