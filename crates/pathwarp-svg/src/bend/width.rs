//! Computes the factor that scales a stroke under a map, and the distance of the scaled stroke from the exact one.
//!
//! Let h be half the width. To first order, the map turns the circle of radius h about a point of the path into an ellipse. Along
//! the tangent and normal of the path and of its image, the derivative is
//!
//! > \[\[α, σ\], \[0, β\]\]
//!
//! α stretches along the path, β across it, and σ shears. A stroke scaled by s has a circle of radius s·h, so its edges are off by
//! |β − s|·h. At ends, corners and dashes, other points of the edge count as well. Each is a [`Pair`]: its exact position and the drawn
//! one, relative to the path and in units of h. The error is the largest |exact − s·drawn|·h. It bounds the distance between the painted
//! areas, not between their borders: a narrow gap between two edges may close faster than the edges move.

use super::task::PartTask;
use crate::scene::areas::is_point;
use crate::scene::geometry::stretch;
use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::map::{AffineMap, Chain, Jet, Map};
use pathwarp::outline::Subpath;
use pathwarp::{Outline, Seg};
use std::sync::Arc;
use usvg::{LineCap, LineJoin, Stroke};

/// Largest relative error of a width that hardly varies: edges are then off by at most a hundredth of the width. The eye tells lines
/// side by side apart if their widths differ by about a twentieth.
const WIDTH_ERROR: f64 = 0.02;

/// Factor for errors between samples, about 1/cos(π/8): widths under an affine map vary as a sinusoid whose period is half a turn.
const SAMPLING_FACTOR: f64 = 1.08;
/// Largest turn of a path between samples, in radians: an eighth of that period.
const MAX_TURN: f64 = std::f64::consts::PI / 8.0;
/// Smallest turn of a corner, in radians. At smaller ones, joins don't extend past the edges by more than a millionth.
const MIN_CORNER: f64 = 2e-3;
/// Largest distance along the path between the image of an edge point and that of its point of the path, as a fraction of its distance
/// across, up to which that point counts as the nearest one. The distance from the path is then right within 0.2 % (½·0.05²).
const MAX_SLANT: f64 = 0.05;

/// A corner of a dashed path.
#[derive(Debug, Clone, Copy)]
struct DashedCorner {
    /// Lengths of the path and of its image up to the corner.
    source: f64,
    image: f64,
    /// Largest distance of the join from the corner at the factor 1.
    extent: f64,
}

/// Samples of a stroke's width along a path.
#[derive(Debug)]
pub(super) struct StrokeWidth<'a> {
    stroke: &'a Stroke,
    /// Half the width, in the stroke's user space in the source.
    half: f64,
    /// From the stroke's user space in the source to root user space.
    to_root: Affine,
    /// From root user space to the stroke's user space in the result.
    from_root: Affine,
    /// Largest number of root units per unit of the stroke's user space in the result.
    unit: f64,
    pairs: Vec<Pair>,
    /// Integral of the local scale along the path, and the path's length.
    scale_integral: f64,
    length: f64,
    /// For dashes, at each sample: the lengths of the path and of its image so far, and the factor by which the outer edge is
    /// longer than the path.
    lengths: Vec<[f64; 3]>,
    corners: Vec<DashedCorner>,
    /// `true` if part of the edge lies outside the map's domain.
    leaves_domain: bool,
    /// Largest factor by which lengths are stretched on the path, from the stroke's user space to root user space.
    pub(super) stretch: f64,
    /// For dashes: the sum of the path's turns, in radians.
    turns: f64,
}

/// An end of a segment.
#[derive(Debug, Clone, Copy)]
struct Node {
    p: Point,
    frame: LocalFrame,
    /// Lengths of the path and of its image so far.
    lengths: [f64; 2],
}

impl<'a> StrokeWidth<'a> {
    /// Samples the stroke of a part, or of all copies of its letters, `t.pieces`. `pieces` is the number of segments of the bent path,
    /// which letters share equally. Returns `None` if the map's derivative is not finite on the path.
    pub(super) fn sample(t: &PartTask<'_>, stroke: &'a Stroke, pieces: usize) -> Option<Self> {
        let mut out = Self {
            stroke,
            half: 0.5 * f64::from(stroke.width().get()),
            to_root: t.part.frame,
            from_root: t.back,
            unit: stretch(t.write),
            pairs: Vec::new(),
            scale_integral: 0.0,
            length: 0.0,
            lengths: Vec::new(),
            corners: Vec::new(),
            leaves_domain: false,
            stretch: 0.0,
            turns: 0.0,
        };
        if t.pieces.is_empty() {
            out.add_outline(&t.outline, t.context.map, pieces)?;
        }
        for (piece, m) in t.pieces.iter().flat_map(|piece| piece.copies.iter().map(move |m| (piece, *m))) {
            let mut map = Chain::new([Arc::new(AffineMap(m)) as Arc<dyn Map>]);
            map.push(Arc::new(t.options().letters.after.clone()));
            out.add_outline(&piece.cut_from(&t.whole), &map, pieces / t.pieces.len())?;
        }
        Some(out)
    }

    /// The mean local scale along the path.
    pub(super) fn mean(&self) -> f64 {
        if self.length > 0.0 { self.scale_integral / self.length } else { self.middle() }
    }

    /// The middle of the range of factors that suit the pairs one by one, which nearly minimizes the largest error.
    pub(super) fn middle(&self) -> f64 {
        let scales = self.pairs.iter().map(|p| p.exact.dot(p.drawn) / p.drawn.hypot2());
        let (low, high) = scales.fold((f64::INFINITY, 0.0_f64), |(low, high), s| (low.min(s), high.max(s)));
        if low <= high { 0.5 * (low + high) } else { 1.0 }
    }

    /// Largest distance between the stroke scaled by `s` and the exact one, in root user units, as if the path were exact.
    pub(super) fn error(&self, s: f64) -> f64 {
        let edges = self.pairs.iter().map(|p| (p.exact - p.drawn * s).hypot2()).fold(0.0, f64::max).sqrt();
        SAMPLING_FACTOR * (edges * self.half + self.dash_shift(s)) * self.unit
    }

    /// Factor by which an error of the bent path, of `pieces` segments, moves the corners of a dash's outline; 1 without dashes. A cubic
    /// fitted to sixth order oscillates about the curve in three waves. So an error ε on a segment of length l tilts it by up to 6π·ε/l,
    /// and on a path that turns by θ it changes the length by up to ε·θ.
    pub(super) fn leverage(&self, pieces: usize) -> f64 {
        let tilt = 3.0 * std::f64::consts::TAU * pieces as f64 / self.length;
        if self.stroke.dasharray().is_some() && self.length > 0.0 { 1.0 + self.half * tilt + self.turns } else { 1.0 }
    }

    /// Returns `true` if the stroke scaled by `s` is right: its edges are within `tolerance`, or wrong by at most [`WIDTH_ERROR`].
    pub(super) fn is_right(&self, s: f64, tolerance: f64) -> bool {
        let looks_right = |p: &Pair| (p.exact - p.drawn * s).hypot() <= WIDTH_ERROR * s * p.drawn.hypot();
        !self.leaves_domain && (self.error(s) <= tolerance || self.pairs.iter().all(looks_right))
    }

    /// Largest shift of a dash along the path, in user units of the result. It counts up to half a gap, since no point of a gap is farther
    /// from a dash. The entries of odd index are gaps; usvg gives an even number of entries.
    fn dash_shift(&self, s: f64) -> f64 {
        let Some(dashes) = self.stroke.dasharray() else { return 0.0 };
        let gap = dashes.iter().skip(1).step_by(2).fold(0.0_f32, |m, g| m.max(*g));
        let shifts = self.lengths.iter().map(|[source, image, outer]| (image - s * source).abs() * outer);
        let shift = shifts.fold(0.0, f64::max).min(0.5 * f64::from(gap) * s);
        // A dash that ends at a corner may be shifted across it, and show its join.
        let crosses = |c: &&DashedCorner| (c.image - s * c.source).abs() >= s * self.to_nearest_end(c.source, dashes);
        self.corners.iter().filter(crosses).map(|c| c.extent * s).fold(shift, f64::max)
    }

    /// Distance along the path from the point at `length` to the nearest end of a dash.
    fn to_nearest_end(&self, length: f64, dashes: &[f32]) -> f64 {
        let period: f64 = dashes.iter().map(|d| f64::from(*d)).sum();
        let mut phase = (length + f64::from(self.stroke.dashoffset())).rem_euclid(period);
        let mut nearest = f64::INFINITY;
        for d in dashes {
            nearest = nearest.min(phase.abs());
            phase -= f64::from(*d);
        }
        nearest.min(phase.abs())
    }

    fn add_outline(&mut self, outline: &Outline, map: &dyn Map, pieces: usize) -> Option<()> {
        /// Up to this many segments, each gets at least four intervals.
        const FEW: usize = 64;
        /// Up to this many segments, each gets at least two intervals. In longer paths, each gets one sample.
        const MANY: usize = 4096;
        let segments = outline.segs().count();
        let least = if segments <= FEW { 4 } else { 2 * usize::from(segments <= MANY) };
        // Take two samples for each fitted piece, which covers less than half a period of any variation of the map.
        let of_pieces = if segments <= MANY { (2 * pieces) / segments.max(1) } else { 0 };
        for sub in &outline.subpaths {
            if sub.segs.iter().all(|s| is_point(s, sub.start)) {
                self.add_dot(sub, &map.jet(sub.start));
            } else {
                self.add_subpath(sub, map, least.max(of_pieces))?;
            }
        }
        Some(())
    }

    /// Adds the caps of a subpath of zero length, which extend in all directions.
    fn add_dot(&mut self, sub: &Subpath, jet: &Jet) {
        let [x, y] = columns(jet, self.to_root, self.from_root);
        if !(x.is_finite() && y.is_finite()) || (sub.segs.is_empty() && !sub.closed) {
            return;
        }
        match self.stroke.linecap() {
            LineCap::Butt => {}
            LineCap::Round => self.pairs.extend(ellipse([x, y])),
            LineCap::Square => self.pairs.extend(square_corners(x, y)),
        }
    }

    fn add_subpath(&mut self, sub: &Subpath, map: &dyn Map, least: usize) -> Option<()> {
        let dashed = self.stroke.dasharray().is_some();
        let mut ends: Vec<[Node; 2]> = Vec::with_capacity(sub.segs.len());
        let mut lengths = [0.0; 2];
        for seg in sub.segs.iter().filter(|s| !is_point(s, s.start())) {
            let lengths_at_start = lengths;
            let samples = self.sample_segment(seg, map, least)?;
            let &[(_, first), .., (_, last)] = samples.as_slice() else {
                // Segments among very many have one sample, in the middle.
                if let [(_, s)] = samples.as_slice() {
                    self.integrate(s, s, 1.0, &mut lengths);
                }
                continue;
            };
            for pair in samples.windows(2) {
                let [(t0, a), (t1, b)] = [pair[0], pair[1]];
                self.integrate(&a, &b, t1 - t0, &mut lengths);
                if dashed {
                    self.add_cap(&b);
                }
            }
            let start = Node { p: seg.start(), frame: first, lengths: lengths_at_start };
            ends.push([start, Node { p: seg.end(), frame: last, lengths }]);
        }
        for joint in ends.windows(2) {
            self.add_join(map, &joint[0][1], &joint[1][0].frame);
        }
        if let (Some(first), Some(last)) = (ends.first(), ends.last()) {
            if sub.closed {
                self.add_join(map, &last[1], &first[0].frame);
            } else {
                self.add_cap(&first[0].frame);
                self.add_cap(&last[1].frame);
            }
        }
        Some(())
    }

    /// Adds the path between two samples to the integrals, by the trapezoidal rule.
    fn integrate(&mut self, a: &LocalFrame, b: &LocalFrame, dt: f64, lengths: &mut [f64; 2]) {
        let integral = |f: &dyn Fn(&LocalFrame) -> f64| 0.5 * dt * (f(a) + f(b));
        let length = integral(&|s| s.speed);
        self.scale_integral += integral(&|s| s.scale() * s.speed);
        self.length += length;
        lengths[0] += length;
        lengths[1] += integral(&|s| s.image_speed);
        if self.stroke.dasharray().is_some() {
            let turn = a.tangent.cross(b.tangent).atan2(a.tangent.dot(b.tangent)).abs();
            self.turns += turn;
            self.lengths.push([lengths[0], lengths[1], 1.0 + self.half * turn / length]);
        }
    }

    /// Samples a segment and its edges. Returns the samples with their parameters; `None` if the map's derivative is not finite.
    fn sample_segment(&mut self, seg: &Seg, map: &dyn Map, least: usize) -> Option<Vec<(f64, LocalFrame)>> {
        // Shifts of dashes are integrals, which need more samples.
        let finer = if self.stroke.dasharray().is_some() { 4 } else { 1 };
        let n = if least == 0 { 0 } else { finer * least.max((turn(seg) / MAX_TURN).ceil() as usize) };
        let ts: Vec<f64> = if n == 0 { vec![0.5] } else { (0..=n).map(|i| i as f64 / n as f64).collect() };
        let ps: Vec<Point> = ts.iter().map(|t| seg.eval(*t)).collect();
        let mut jets = vec![Jet::default(); ps.len()];
        map.jets(&ps, &mut jets);
        let mut samples = Vec::with_capacity(ts.len());
        let mut centres = Vec::with_capacity(ts.len());
        let mut edges = Vec::with_capacity(2 * ts.len());
        for ((t, p), jet) in ts.iter().zip(&ps).zip(&jets) {
            let v = seg.deriv(*t);
            if !(jet.det().is_finite() && jet.push(v).is_finite()) {
                return None;
            }
            // Skip cusps; there are samples beside them.
            let Some(frame) = LocalFrame::new(jet, v, self.to_root, self.from_root) else { continue };
            let to_edge = linear(self.to_root, frame.normal * self.half);
            edges.extend([*p + to_edge, *p - to_edge]);
            let [x, y] = frame.columns;
            self.stretch = self.stretch.max(stretch(Affine::new([x.x, x.y, y.x, y.y, 0.0, 0.0])) * self.unit);
            centres.push(jet.p);
            samples.push((*t, frame));
        }
        let mut images = vec![Point::ORIGIN; edges.len()];
        map.points(&edges, &mut images);
        for (((t, frame), centre), both) in samples.iter().zip(&centres).zip(images.chunks(2)) {
            for q in both {
                let exact = self.distance(seg, *t, frame, map, *centre, *q);
                self.pairs.push(Pair { exact: Vec2::new(exact, 0.0), drawn: Vec2::new(1.0, 0.0) });
            }
        }
        Some(samples)
    }

    /// Distance of the image `q` of an edge point from the image of the path, in units of half the width. `centre` is the image of the
    /// point of the path.
    fn distance(&mut self, seg: &Seg, t: f64, frame: &LocalFrame, map: &dyn Map, centre: Point, q: Point) -> f64 {
        if !q.is_finite() {
            self.leaves_domain = true;
            return frame.in_image(frame.push(frame.normal)).y.abs();
        }
        let relative = frame.in_image(linear(self.from_root, q - centre)) / self.half;
        let nearest = t + relative.x * self.half / frame.image_speed;
        if relative.x.abs() <= MAX_SLANT * relative.y.abs() || !(0.0..=1.0).contains(&nearest) {
            return relative.y.abs();
        }
        linear(self.from_root, q - map.point(seg.eval(nearest))).hypot() / self.half
    }

    /// Adds the outermost points of a cap.
    fn add_cap(&mut self, at: &LocalFrame) {
        let [along, across] = [at.tangent, at.normal].map(|v| at.in_image(at.push(v)));
        match self.stroke.linecap() {
            LineCap::Butt => self.pairs.push(Pair { exact: across, drawn: Vec2::new(0.0, 1.0) }),
            LineCap::Round => self.pairs.extend(ellipse(at.columns)),
            LineCap::Square => self.pairs.extend(square_corners(along, across)),
        }
    }

    /// Adds a corner of a dashed path whose join extends to `extent` times half the width.
    fn add_corner(&mut self, at: &Node, extent: f64) {
        if self.stroke.dasharray().is_some() {
            let [source, image] = at.lengths;
            self.corners.push(DashedCorner { source, image, extent: extent * self.half });
        }
    }

    /// Adds the outermost points of the join of two segments, the second of which begins with the frame `b`.
    fn add_join(&mut self, map: &dyn Map, at: &Node, b: &LocalFrame) {
        let (p, a) = (at.p, &at.frame);
        let turn = a.tangent.cross(b.tangent).atan2(a.tangent.dot(b.tangent));
        if turn.abs() < MIN_CORNER {
            return;
        }
        if self.stroke.linejoin() == LineJoin::Round {
            self.pairs.extend(ellipse(a.columns));
            self.add_corner(at, 1.0);
            return;
        }
        let mitered = !matches!(self.stroke.linejoin(), LineJoin::Bevel);
        let limit = if mitered { f64::from(self.stroke.miterlimit().get()) } else { 0.0 };
        let outer = -turn.signum();
        let (exact, exact_is_miter) = join_tip(a.normal * outer, b.normal * outer, limit);
        let (drawn, drawn_is_miter) = join_tip(a.image[1] * outer, b.image[1] * outer, limit);
        self.add_corner(at, exact.hypot().max(drawn.hypot()).max(1.0));
        let to_tip = linear(self.to_root, exact * self.half);
        let image = [p, p + to_tip].map(|p| map.point(p));
        let image = linear(self.from_root, image[1] - image[0]) / self.half;
        if exact_is_miter || drawn_is_miter {
            self.leaves_domain |= !image.is_finite();
            self.pairs.push(Pair { exact: if image.is_finite() { image } else { a.push(exact) }, drawn });
        }
        if !(exact_is_miter && drawn_is_miter) {
            let edge = |s: &LocalFrame| Pair { exact: s.in_image(s.push(s.normal)), drawn: Vec2::new(0.0, 1.0) };
            self.pairs.extend([edge(a), edge(b)]);
        }
    }
}

/// A point of a stroke's edge relative to the path, in units of half the width, along any axes that both positions share.
#[derive(Debug, Clone, Copy)]
struct Pair {
    exact: Vec2,
    /// For the factor 1.
    drawn: Vec2,
}

/// The tangent and normal of a path at a point, and of its image, in the stroke's user space in the source and in the result.
#[derive(Debug, Clone, Copy)]
struct LocalFrame {
    /// Columns of the map's derivative between the two spaces.
    columns: [Vec2; 2],
    /// Unit tangent and normal of the path.
    tangent: Vec2,
    normal: Vec2,
    /// Unit tangent and normal of the image, with the normal on the side to which the path's is mapped.
    image: [Vec2; 2],
    /// Speeds along the path and along its image.
    speed: f64,
    image_speed: f64,
}

/// The image of a vector under the linear part of `m`.
fn linear(m: Affine, v: Vec2) -> Vec2 {
    let [a, b, c, d, ..] = m.as_coeffs();
    Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
}

fn perpendicular(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// Pairs the corners of a square cap; `along` and `across` are the images of the tangent and the normal.
fn square_corners(along: Vec2, across: Vec2) -> [Pair; 2] {
    [1.0, -1.0].map(|k| Pair { exact: along + across * k, drawn: Vec2::new(1.0, k) })
}

impl LocalFrame {
    /// `v` is the path's derivative in root user space. Returns `None` where the path or its image stands still.
    fn new(jet: &Jet, v: Vec2, to_root: Affine, from_root: Affine) -> Option<Self> {
        let (derivative, columns) = (linear(to_root.inverse(), v), columns(jet, to_root, from_root));
        let image_derivative = columns[0] * derivative.x + columns[1] * derivative.y;
        let (speed, image_speed) = (derivative.hypot(), image_derivative.hypot());
        if !(speed > 0.0 && image_speed > 0.0) {
            return None;
        }
        let (tangent, image_tangent) = (derivative / speed, image_derivative / image_speed);
        let side = if columns[0].cross(columns[1]) < 0.0 { -1.0 } else { 1.0 };
        let image = [image_tangent, perpendicular(image_tangent) * side];
        Some(Self { columns, tangent, normal: perpendicular(tangent), image, speed, image_speed })
    }

    /// The image of a vector under the map's derivative.
    fn push(&self, v: Vec2) -> Vec2 {
        self.columns[0] * v.x + self.columns[1] * v.y
    }

    /// The components of a vector along the image's tangent and normal.
    fn in_image(&self, v: Vec2) -> Vec2 {
        Vec2::new(v.dot(self.image[0]), v.dot(self.image[1]))
    }

    /// The local scale: the square root of the factor by which areas grow.
    fn scale(&self) -> f64 {
        self.columns[0].cross(self.columns[1]).abs().sqrt()
    }
}

/// The columns of the map's derivative, from the stroke's user space in the source to that in the result.
fn columns(jet: &Jet, to_root: Affine, from_root: Affine) -> [Vec2; 2] {
    [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)].map(|e| linear(from_root, jet.push(linear(to_root, e))))
}

/// Pairs each semi-axis of the ellipse that the matrix with these columns makes of the unit circle with the circle's radius.
fn ellipse([x, y]: [Vec2; 2]) -> [Pair; 2] {
    let long = stretch(Affine::new([x.x, x.y, y.x, y.y, 0.0, 0.0]));
    let short = if long > 0.0 { x.cross(y).abs() / long } else { 0.0 };
    let drawn = Vec2::new(1.0, 0.0);
    [long, short].map(|r| Pair { exact: drawn * r, drawn })
}

/// The outermost point of a join between edges with these normals; `true` if it is a miter.
fn join_tip(a: Vec2, b: Vec2, limit: f64) -> (Vec2, bool) {
    let bisector = a + b;
    // The miter's length is 1 / cos(turn / 2), and |a + b| = 2 cos(turn / 2).
    let mitered = limit * bisector.hypot() >= 2.0;
    (if mitered { bisector * (2.0 / bisector.hypot2()) } else { bisector * 0.5 }, mitered)
}

/// The turn of a segment's control polygon in radians, an upper bound on the segment's turn.
fn turn(seg: &Seg) -> f64 {
    let angle = |a: Vec2, b: Vec2| a.cross(b).atan2(a.dot(b)).abs();
    match seg {
        Seg::Line(_) => 0.0,
        Seg::Quad(q) => angle(q.p1 - q.p0, q.p2 - q.p1),
        Seg::Cubic(c) => angle(c.p1 - c.p0, c.p2 - c.p1) + angle(c.p2 - c.p1, c.p3 - c.p2),
        Seg::Arc(a) => a.sweep.abs(),
    }
}
