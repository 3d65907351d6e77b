//! Skeletons given as B-splines: the anchors of a path are control points.
//!
//! An open path is a uniform clamped B-spline, a closed one a uniform periodic one; every cell becomes a Bézier piece
//! ([`bspline`]; W. Boehm, *Inserting new knots into B-spline curves*, CAD 12, 1980). Pieces meet with degree − 1 continuous
//! derivatives.

use crate::anchors;
use crate::error::Error;
use crate::map::nets::bspline;
use crate::outline::{Outline, Seg, Subpath};
use crate::param::NamedPath;
use kurbo::{CubicBez, Line, Point, QuadBez, Vec2};

/// Returns the spline of this degree, 1 to 3, over the anchors of `path`.
pub(super) fn through(path: &NamedPath, degree: usize) -> Result<NamedPath, Error> {
    let sub = anchors::only_subpath(path, "a single connected run of them")?;
    let points = sub.anchors();
    let fewest = if sub.closed { 3 } else { degree + 1 };
    if points.len() < fewest {
        let problem = format!("needs at least {fewest} anchors; the skeleton has {}", points.len());
        return Err(Error::usage("spline", degree.to_string(), problem));
    }
    let mut pieces: Vec<Vec<Point>> = if sub.closed {
        // The middle cell of a long clamped spline has only uniform knots. The first piece begins near the first anchor.
        let uniform = &bspline::extraction(degree, 2 * degree - 1)[degree - 1];
        let n = points.len();
        let first = n - (degree - 1) / 2;
        (0..n).map(|i| bezier(uniform, &|l| points[(first + i + l) % n])).collect()
    } else {
        let cells = bspline::extraction(degree, points.len() - degree);
        cells.iter().enumerate().map(|(i, rows)| bezier(rows, &|l| points[i + l])).collect()
    };
    // Rounding must not separate the ends at a joint.
    for i in 1..pieces.len() {
        pieces[i][0] = pieces[i - 1][degree];
    }
    if sub.closed {
        let (start, last) = (pieces[0][0], pieces.len() - 1);
        pieces[last][degree] = start;
    }
    let segs = pieces.iter().filter_map(|p| match p[..] {
        [a, b] => Some(Seg::Line(Line::new(a, b))),
        [a, b, c] => Some(Seg::Quad(QuadBez::new(a, b, c))),
        [a, b, c, d] => Some(Seg::Cubic(CubicBez::new(a, b, c, d))),
        _ => None,
    });
    let spline = Subpath { start: pieces[0][0], segs: segs.collect(), closed: sub.closed };
    Ok(NamedPath { name: path.name.clone(), outline: Outline { subpaths: vec![spline] } })
}

/// Returns Bézier points: a cell's matrix times its control points.
fn bezier(rows: &[Vec<f64>], control: &dyn Fn(usize) -> Point) -> Vec<Point> {
    let sum = |row: &Vec<f64>| row.iter().enumerate().fold(Vec2::ZERO, |s, (l, c)| s + control(l).to_vec2() * *c);
    rows.iter().map(|row| sum(row).to_point()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline(d: &str, degree: usize) -> Result<Subpath, Error> {
        let path = NamedPath { name: d.into(), outline: Outline::from_svg(d).unwrap() };
        Ok(through(&path, degree)?.outline.subpaths.remove(0))
    }

    /// Against the textbook's values at the knots, with all continuous derivatives.
    #[test]
    fn pieces_are_the_spline() {
        let p = [(0.0, 0.0), (10.0, 30.0), (50.0, 20.0), (60.0, -10.0), (20.0, -40.0)].map(Point::from);
        let v = |i: usize| p[i % 5].to_vec2();
        let near = |a: Point, b: Vec2| a.distance(b.to_point()) < 1e-12;
        let closed = "M0,0 L10,30 50,20 60,-10 20,-40 Z";
        let cubic = spline(closed, 3).unwrap();
        let quadratic = spline(closed, 2).unwrap();
        assert!(cubic.closed && cubic.segs.len() == 5 && quadratic.segs.len() == 5);
        for i in 0..5 {
            assert!(near(cubic.segs[i].start(), (v(i + 4) + 4.0 * v(i) + v(i + 1)) / 6.0));
            assert!(near(quadratic.segs[i].start(), (v(i) + v(i + 1)) / 2.0));
            assert_eq!(cubic.segs[i].end(), cubic.segs[(i + 1) % 5].start());
        }
        let open = spline("M0,0 L10,30 50,20 60,-10 20,-40", 3).unwrap();
        assert!(!open.closed && open.segs.len() == 2 && open.start == p[0] && open.segs[1].end() == p[4]);
        for (s, a, b) in [(&cubic, 0, 1), (&cubic, 2, 3), (&cubic, 4, 0), (&open, 0, 1)] {
            let (a, b) = (s.segs[a].to_cubic(), s.segs[b].to_cubic());
            let off = |a: Vec2, b: Vec2| (a - b).hypot();
            // The second derivative of the open one jumps nowhere either: its inner knot is simple and its cells equally wide.
            assert!(off(a.p3 - a.p2, b.p1 - b.p0) < 1e-12);
            assert!(off((a.p3 - a.p2) - (a.p2 - a.p1), (b.p2 - b.p1) - (b.p1 - b.p0)) < 1e-12);
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
