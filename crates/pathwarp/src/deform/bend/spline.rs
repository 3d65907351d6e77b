//! Skeletons given by points: B-splines that the anchors of a path control, and cubic splines that run through them.
//!
//! Every point has a handle, the image of the artwork's height there. Points and handles together are control points in four
//! dimensions, to which the algorithm of de Boor, or interpolation, applies: S has the degree, the knots and the continuity of C, and
//! every parallel C + v·S is as smooth as the skeleton. At a joint of Bézier pieces this is equation 4 of the paper of Chang and
//! Rockwood, s₃ = (s₂ + s₄)/2.
//!
//! The default handle of a B-spline's point is the mitre of the polygon's sides, so that the control points of a parallel are the
//! corners of the polygon's offset (W. Tiller and E. G. Hanson, *Offsets of two-dimensional profiles*, IEEE CG&A 4, 1984). On an
//! interpolated skeleton it is the unit normal, and S is the C¹ cubic with S' = −(S·C″)/|C'|²·C' at the points, as for normals: `eased`
//! returns the inner control point for that slope at an end, from the handle there and the sides of the curve's control polygon.

use super::map::{Curve, normal};
use crate::error::{Error, show};
use crate::map::bspline;
use crate::outline::Subpath;
use kurbo::{Point, Vec2};

/// The kind of spline that the anchors of a path make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Spline {
    /// A uniform B-spline of this degree runs near them: they are its control points.
    Near(usize),
    /// A C² cubic spline runs through them, with centripetal parameters.
    Through,
}

/// A piece of a skeleton before it is measured.
pub(super) struct Part {
    pub(super) curve: Curve,
    /// The handles at the curve's control points; empty if they follow from the curve.
    pub(super) handles: Vec<Vec2>,
    /// The piece's share of the parameter; 0 if it follows from the length.
    pub(super) width: f64,
}

impl Part {
    /// Returns the piece in the opposite direction, with the artwork on the other side.
    pub(super) fn reversed(mut self) -> Self {
        self.handles.reverse();
        self.handles.iter_mut().for_each(|h| *h = -*h);
        Self { curve: self.curve.reversed(), ..self }
    }
}

impl Spline {
    /// Returns the pieces of the spline of a subpath's anchors. `given` has a handle for every anchor, or `None` for the default one,
    /// `unit` long; if empty, all are defaults.
    pub(super) fn parts(self, sub: &Subpath, given: &[Option<Vec2>], unit: f64) -> Result<Vec<Part>, Error> {
        let (points, closed) = (sub.anchors(), sub.closed);
        let n = points.len();
        let degree = if let Self::Near(degree) = self { degree } else { 1 };
        let min = if closed { 3 } else { degree + 1 };
        if n < min {
            let problem = format!("has {n} anchors; such a spline needs at least {min} anchors");
            return Err(Error::usage("along", "", problem));
        }
        if !given.is_empty() && given.len() != n {
            let problem = format!("has handles for {} points; the skeleton has {n}", given.len());
            return Err(Error::input("handles", problem));
        }
        let handle = |i: usize, side: Vec2| given.get(i).copied().flatten().unwrap_or(side * unit);
        if let Self::Near(degree) = self {
            let with_handle = |(i, side): (usize, Vec2)| (points[i], handle(i, side));
            let controls = mitres(&points, closed).into_iter().enumerate().map(with_handle);
            let controls: Vec<[f64; 4]> = controls.map(|(p, h)| [p.x, p.y, h.x, h.y]).collect();
            let part = |c: Vec<[f64; 4]>| {
                let (points, handles) = c.iter().map(|c| (Point::new(c[0], c[1]), Vec2::new(c[2], c[3]))).unzip();
                Part { curve: Curve::bezier(points), handles, width: 1.0 }
            };
            return Ok(bspline::pieces(degree, &controls, closed).into_iter().map(part).collect());
        }
        let legs = if closed { n } else { n - 1 };
        let distances: Vec<f64> = (0..legs).map(|i| points[i].distance(points[(i + 1) % n])).collect();
        if let Some(i) = distances.iter().position(|d| *d <= 0.0) {
            let problem = format!("has two equal points in a row at {}; remove one", show(points[i]));
            return Err(Error::usage("along", "", problem));
        }
        let widths = bspline::centripetal(&distances);
        let flat: Vec<[f64; 2]> = points.iter().map(|p| [p.x, p.y]).collect();
        let part = |(i, (cubic, width)): (usize, (Vec<[f64; 2]>, f64))| {
            let p: Vec<Point> = cubic.into_iter().map(|[x, y]| Point::new(x, y)).collect();
            let [a, b, c] = [p[1] - p[0], p[2] - p[1], p[3] - p[2]];
            let side = |t: Vec2| normal(if t.hypot() > 0.0 { t / t.hypot() } else { (p[3] - p[0]).normalize() });
            let (start, end) = (handle(i, side(a)), handle((i + 1) % n, side(c)));
            let eased = |h: Vec2, leg: Vec2| h - leg * (h.dot(b - leg) / (1.5 * leg.hypot2()).max(1e-18 * b.hypot2()));
            Part { curve: Curve::bezier(p), handles: vec![start, eased(start, a), eased(end, c), end], width }
        };
        let pieces = bspline::through(&flat, &widths, closed);
        Ok(pieces.into_iter().zip(widths).enumerate().map(part).collect())
    }
}

/// Returns the directions of a polygon's sides. A side without length has the direction of the side before it.
pub(super) fn directions(points: &[Point], closed: bool) -> Vec<Vec2> {
    let n = points.len();
    let legs: Vec<Vec2> = (0..if closed { n } else { n - 1 }).map(|i| points[(i + 1) % n] - points[i]).collect();
    let size = legs.iter().map(|l| l.hypot()).fold(0.0, f64::max);
    let unit = |l: &Vec2| (l.hypot() > 1e-9 * size).then(|| *l / l.hypot());
    let mut last = legs.iter().find_map(unit).unwrap_or(Vec2::new(1.0, 0.0));
    let direction = |l: &Vec2| {
        last = unit(l).unwrap_or(last);
        last
    };
    legs.iter().map(direction).collect()
}

/// Returns the mitre of two unit normals: the vector whose component along either is 1. At turns over a right angle its length stays √2;
/// where the polygon turns back, it is the first normal.
pub(super) fn mitre(n: Vec2, m: Vec2) -> Vec2 {
    let c = 1.0 + n.dot(m);
    if c < 1e-9 { n } else { (n + m) / c.max(c.sqrt()) }
}

/// Returns the mitres at the corners of a polygon, with normals at open ends.
fn mitres(points: &[Point], closed: bool) -> Vec<Vec2> {
    let sides: Vec<Vec2> = directions(points, closed).into_iter().map(normal).collect();
    let (n, last) = (points.len(), sides.len() - 1);
    let before = |i: usize| if closed { sides[(i + n - 1) % n] } else { sides[i.saturating_sub(1)] };
    (0..n).map(|i| mitre(before(i), sides[i.min(last)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Outline;

    fn spline(d: &str, degree: usize) -> Result<Vec<Vec<Point>>, Error> {
        let sub = Outline::from_svg(d).unwrap().subpaths.remove(0);
        Ok(Spline::Near(degree).parts(&sub, &[], 1.0)?.into_iter().map(|p| p.curve.points()).collect())
    }

    /// Compares the spline with the textbook's values and continuous derivatives at the knots.
    #[test]
    fn pieces_are_the_spline() {
        let p = [(0.0, 0.0), (10.0, 30.0), (50.0, 20.0), (60.0, -10.0), (20.0, -40.0)].map(Point::from);
        let v = |i: usize| p[i % 5].to_vec2();
        let near = |a: Point, b: Vec2| a.distance(b.to_point()) < 1e-12;
        let closed = "M0,0 L10,30 50,20 60,-10 20,-40 Z";
        let cubic = spline(closed, 3).unwrap();
        let quadratic = spline(closed, 2).unwrap();
        assert!(cubic.len() == 5 && quadratic.len() == 5);
        for i in 0..5 {
            assert!(near(cubic[i][0], (v(i + 4) + 4.0 * v(i) + v(i + 1)) / 6.0));
            assert!(near(quadratic[i][0], (v(i) + v(i + 1)) / 2.0));
            assert_eq!(cubic[i][3], cubic[(i + 1) % 5][0]);
        }
        let open = spline("M0,0 L10,30 50,20 60,-10 20,-40", 3).unwrap();
        assert!(open.len() == 2 && open[0][0] == p[0] && open[1][3] == p[4]);
        for (s, a, b) in [(&cubic, 0, 1), (&cubic, 2, 3), (&cubic, 4, 0), (&open, 0, 1)] {
            let (a, b) = (&s[a], &s[b]);
            let off = |a: Vec2, b: Vec2| (a - b).hypot();
            // The second derivative of the open spline is continuous, too: its inner knot is simple and its cells are equally wide.
            assert!(off(a[3] - a[2], b[1] - b[0]) < 1e-12);
            assert!(off((a[3] - a[2]) - (a[2] - a[1]), (b[2] - b[1]) - (b[1] - b[0])) < 1e-12);
        }
    }

    #[test]
    fn too_few_points_are_an_error() {
        for (d, degree) in [("M0,0 L5,5 Z", 2), ("M0,0 L9,0", 2)] {
            assert!(spline(d, degree).is_err(), "{d}");
        }
        assert!(spline("M0,0 L1,1 5,0", 3).err().unwrap().to_string().contains("at least 4 anchors"));
    }
}
