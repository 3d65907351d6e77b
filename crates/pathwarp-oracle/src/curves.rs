//! Path data as curves: svgtypes parses commands; arcs follow the formulas of SVG's appendix. No code is shared with the program's reader.

use kurbo::{BezPath, PathSeg, Point, Vec2};
use std::f64::consts::TAU;
use svgtypes::{PathParser, PathSegment};

/// A curve over [0, 1].
#[derive(Debug, Clone, Copy)]
pub enum Curve {
    Line([Point; 2]),
    Quad([Point; 3]),
    Cubic([Point; 4]),
    /// Centre, two conjugate semi-axes, first angle and sweep; with the ends as written.
    Arc {
        center: Point,
        axes: [Vec2; 2],
        from: f64,
        sweep: f64,
        ends: [Point; 2],
    },
}

impl Curve {
    /// The point at a parameter, by de Casteljau's algorithm.
    pub fn at(&self, t: f64) -> Point {
        let mix = |a: Point, b: Point| Point::new(a.x * (1.0 - t) + b.x * t, a.y * (1.0 - t) + b.y * t);
        match *self {
            Self::Line([a, b]) => mix(a, b),
            Self::Quad([a, b, c]) => mix(mix(a, b), mix(b, c)),
            Self::Cubic([a, b, c, d]) => {
                let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
                mix(mix(ab, bc), mix(bc, cd))
            }
            Self::Arc { ends, .. } if t == 0.0 || t == 1.0 => ends[t as usize],
            Self::Arc { center, axes: [a, b], from, sweep, .. } => {
                let (s, c) = (from + t * sweep).sin_cos();
                center + a * c + b * s
            }
        }
    }

    /// The directions in which the curve starts and ends, of no particular length.
    pub fn directions(&self) -> [Vec2; 2] {
        let points: &[Point] = match self {
            Self::Line(p) => p,
            Self::Quad(p) => p,
            Self::Cubic(p) => p,
            Self::Arc { .. } => return [self.at(1e-4) - self.at(0.0), self.at(1.0) - self.at(1.0 - 1e-4)],
        };
        let (first, last) = (points[0], points[points.len() - 1]);
        let away = points.iter().map(|p| *p - first).find(|v| *v != Vec2::ZERO);
        let into = points.iter().rev().map(|p| last - *p).find(|v| *v != Vec2::ZERO);
        [away.unwrap_or_default(), into.unwrap_or_default()]
    }

    /// The arc of SVG's command `A` from `p` to `q`, or a line without a radius; `None` if the ends coincide.
    fn arc(p: Point, radii: Vec2, degrees: f64, large: bool, sweep: bool, q: Point) -> Option<Self> {
        let (mut r, ends) = (Vec2::new(radii.x.abs(), radii.y.abs()), [p, q]);
        if p == q {
            return None;
        }
        if r.x == 0.0 || r.y == 0.0 {
            return Some(Self::Line(ends));
        }
        let axis = Vec2::from_angle(degrees.to_radians());
        let half = (p - q) * 0.5;
        let (x, y) = (half.dot(axis), axis.cross(half));
        // Radii that are too small to reach both ends are scaled up.
        let lambda = (x / r.x).powi(2) + (y / r.y).powi(2);
        if lambda > 1.0 {
            r *= lambda.sqrt();
        }
        let (rx2, ry2, x2, y2) = (r.x * r.x, r.y * r.y, x * x, y * y);
        let root = ((rx2 * ry2 - rx2 * y2 - ry2 * x2) / (rx2 * y2 + ry2 * x2)).max(0.0).sqrt();
        let k = if large == sweep { -root } else { root };
        let (cx, cy) = (k * r.x * y / r.y, -k * r.y * x / r.x);
        let center = p.midpoint(q) + Vec2::new(axis.x * cx - axis.y * cy, axis.y * cx + axis.x * cy);
        let angle = |x: f64, y: f64| (y / r.y).atan2(x / r.x);
        let (from, to) = (angle(x - cx, y - cy), angle(-x - cx, -y - cy));
        let angle = (to - from).rem_euclid(TAU);
        let axes = [axis * r.x, Vec2::new(-axis.y, axis.x) * r.y];
        Some(Self::Arc { center, axes, from, sweep: if sweep { angle } else { angle - TAU }, ends })
    }
}

impl From<PathSeg> for Curve {
    fn from(seg: PathSeg) -> Self {
        match seg {
            PathSeg::Line(l) => Self::Line([l.p0, l.p1]),
            PathSeg::Quad(q) => Self::Quad([q.p0, q.p1, q.p2]),
            PathSeg::Cubic(c) => Self::Cubic([c.p0, c.p1, c.p2, c.p3]),
        }
    }
}

/// An object that consists of curves.
pub trait Curved {
    /// The curves, one after the other.
    fn curves(&self) -> Vec<Curve>;
}

impl Curved for BezPath {
    fn curves(&self) -> Vec<Curve> {
        self.segments().map(Curve::from).collect()
    }
}

#[cfg(feature = "drawings")]
mod outlines {
    use super::{Curve, Curved};
    use kurbo::PathSeg;
    use pathwarp::{Outline, Seg};

    impl Curved for Seg {
        fn curves(&self) -> Vec<Curve> {
            vec![match *self {
                Seg::Line(l) => PathSeg::Line(l).into(),
                Seg::Quad(q) => PathSeg::Quad(q).into(),
                Seg::Cubic(c) => PathSeg::Cubic(c).into(),
                Seg::Arc(a) => {
                    let at = |angle: f64| a.center + a.a * angle.cos() + a.b * angle.sin();
                    let ends = [at(a.start), at(a.start + a.sweep)];
                    Curve::Arc { center: a.center, axes: [a.a, a.b], from: a.start, sweep: a.sweep, ends }
                }
            }]
        }
    }

    impl Curved for Vec<Seg> {
        fn curves(&self) -> Vec<Curve> {
            self.iter().flat_map(Curved::curves).collect()
        }
    }

    impl Curved for Outline {
        fn curves(&self) -> Vec<Curve> {
            self.segs().flat_map(Curved::curves).collect()
        }
    }
}

/// The subpaths of path data.
pub fn read(d: &str) -> Vec<Vec<Curve>> {
    let (mut out, mut run) = (Vec::new(), Vec::new());
    let (mut at, mut start) = (Point::ORIGIN, Point::ORIGIN);
    // The last control points, which smooth commands reflect.
    let (mut cubic, mut quad): (Option<Point>, Option<Point>) = (None, None);
    for s in PathParser::from(d) {
        let Ok(s) = s else { break };
        let to = |abs: bool, x: f64, y: f64| if abs { Point::new(x, y) } else { Point::new(at.x + x, at.y + y) };
        let (mut next_cubic, mut next_quad) = (None, None);
        let curve = match s {
            PathSegment::MoveTo { abs, x, y } => {
                (at, start) = (to(abs, x, y), to(abs, x, y));
                out.push(std::mem::take(&mut run));
                None
            }
            PathSegment::ClosePath { .. } => {
                if at != start {
                    run.push(Curve::Line([at, start]));
                }
                at = start;
                out.push(std::mem::take(&mut run));
                None
            }
            PathSegment::LineTo { abs, x, y } => Some(Curve::Line([at, to(abs, x, y)])),
            PathSegment::HorizontalLineTo { abs, x } => Some(Curve::Line([at, Point::new(to(abs, x, 0.0).x, at.y)])),
            PathSegment::VerticalLineTo { abs, y } => Some(Curve::Line([at, Point::new(at.x, to(abs, 0.0, y).y)])),
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                next_cubic = Some(to(abs, x2, y2));
                Some(Curve::Cubic([at, to(abs, x1, y1), to(abs, x2, y2), to(abs, x, y)]))
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                next_cubic = Some(to(abs, x2, y2));
                Some(Curve::Cubic([at, cubic.map_or(at, |h| at + (at - h)), to(abs, x2, y2), to(abs, x, y)]))
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                next_quad = Some(to(abs, x1, y1));
                Some(Curve::Quad([at, to(abs, x1, y1), to(abs, x, y)]))
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                next_quad = Some(quad.map_or(at, |h| at + (at - h)));
                Some(Curve::Quad([at, next_quad.unwrap_or(at), to(abs, x, y)]))
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                Curve::arc(at, Vec2::new(rx, ry), x_axis_rotation, large_arc, sweep, to(abs, x, y))
            }
        };
        (cubic, quad) = (next_cubic, next_quad);
        if let Some(curve) = curve {
            at = curve.at(1.0);
            run.push(curve);
        }
    }
    out.push(run);
    out.retain(|r| !r.is_empty());
    out
}

/// Subpaths as areas: an open one is closed by a line.
pub fn closed(mut all: Vec<Vec<Curve>>) -> Vec<Vec<Curve>> {
    for run in &mut all {
        let ends = [run[run.len() - 1].at(1.0), run[0].at(0.0)];
        if ends[0] != ends[1] {
            run.push(Curve::Line(ends));
        }
    }
    all
}
