//! Converts between GIMP's strokes and outlines.

use crate::path::{GimpPath, Stroke};
use pathwarp::Outline;
use pathwarp::kurbo::{CubicBez, Line, Point};
use pathwarp::outline::{Seg, Subpath};

impl GimpPath {
    /// Returns the curves that GIMP draws. A segment whose handles coincide with their anchors is a line.
    #[must_use]
    pub fn outline(&self) -> Outline {
        Outline { subpaths: self.strokes.iter().filter_map(Stroke::subpath).collect() }
    }
}

impl Stroke {
    /// Returns the curve; `None` if there is no anchor.
    #[must_use]
    pub fn subpath(&self) -> Option<Subpath> {
        let triples: Vec<[Point; 3]> = self.triples().collect();
        let (first, last) = (triples.first()?, triples.last()?);
        let mut segs: Vec<Seg> = triples.windows(2).map(|w| segment(w[0], w[1])).collect();
        // Drop a closing segment without length: of a single anchor, or of a last anchor on top of the first.
        let closing = segment(*last, *first);
        if self.closed && !matches!(closing, Seg::Line(l) if l.p0 == l.p1) {
            segs.push(closing);
        }
        Some(Subpath { start: first[1], segs, closed: self.closed })
    }

    /// Iterates over the anchors: incoming handle, anchor, outgoing handle.
    pub fn triples(&self) -> impl Iterator<Item = [Point; 3]> + '_ {
        self.points.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|[x, y]| Point::new(x, y)))
    }

    /// Converts a curve to GIMP's form: the handles of lines coincide with their anchors, and arcs become cubics.
    #[must_use]
    pub fn from_subpath(s: &Subpath) -> Self {
        let cubics: Vec<CubicBez> = s
            .segs
            .iter()
            .flat_map(|g| match g {
                Seg::Line(l) => vec![CubicBez::new(l.p0, l.p0, l.p1, l.p1)],
                Seg::Arc(a) => a.to_cubics(a.a.hypot().max(a.b.hypot()) * 1e-3).collect(),
                other => vec![other.to_cubic()],
            })
            .collect();
        let mut points: Vec<Point> = Vec::with_capacity(3 * cubics.len() + 3);
        for (i, c) in cubics.iter().enumerate() {
            let incoming = match i.checked_sub(1) {
                Some(before) => cubics[before].p2,
                None if s.closed => cubics.last().map_or(c.p0, |l| l.p2),
                None => c.p0,
            };
            points.extend([incoming, c.p0, c.p1]);
        }
        match cubics.last() {
            None => points.extend([s.start; 3]),
            Some(l) if !s.closed => points.extend([l.p2, l.p3, l.p3]),
            Some(_) => {}
        }
        Self { closed: s.closed, points: points.iter().map(|p| [p.x, p.y]).collect() }
    }
}

fn segment([_, p0, p1]: [Point; 3], [p2, p3, _]: [Point; 3]) -> Seg {
    if p1 == p0 && p2 == p3 { Seg::Line(Line::new(p0, p3)) } else { Seg::Cubic(CubicBez::new(p0, p1, p2, p3)) }
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
}
