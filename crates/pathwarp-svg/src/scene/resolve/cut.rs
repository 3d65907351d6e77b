//! Clips filled outlines to boxes.
//!
//! Geometry outside of a border is replaced by lines along the border. This does not change winding numbers inside, so the
//! interior stays the same by either fill rule (I. E. Sutherland and G. W. Hodgman, *Reentrant Polygon Clipping*, 1974,
//! applied to curves).

use pathwarp::Outline;
use pathwarp::kurbo::common::{solve_cubic, solve_quadratic};
use pathwarp::kurbo::{Line, Point, Rect};
use pathwarp::outline::{Seg, Subpath};

/// Clips a filled outline to a box. Arcs across its border become cubics within `tolerance`.
pub(super) fn within(outline: &Outline, area: Rect, tolerance: f64) -> Outline {
    if outline.bounding_box().is_none_or(|b| area.union(b) == area) {
        return outline.clone();
    }
    let borders = [
        Border { across: 0, at: area.x0, side: 1.0 },
        Border { across: 0, at: area.x1, side: -1.0 },
        Border { across: 1, at: area.y0, side: 1.0 },
        Border { across: 1, at: area.y1, side: -1.0 },
    ];
    let loops = outline.subpaths.iter().map(|s| {
        let mut segs = s.segs.clone();
        join(&mut segs, s.start);
        borders.iter().fold(segs, |segs, b| b.cut(segs, tolerance))
    });
    let subpath = |segs: Vec<Seg>| Some(Subpath { start: segs.first()?.start(), segs, closed: true });
    Outline { subpaths: loops.filter_map(subpath).collect() }
}

/// Closes a run of segments with a line.
fn join(segs: &mut Vec<Seg>, start: Point) {
    if let Some(end) = segs.last().map(Seg::end).filter(|e| *e != start) {
        segs.push(Seg::Line(Line::new(end, start)));
    }
}

/// A line parallel to an axis, with the side to keep.
#[derive(Debug, Clone, Copy)]
struct Border {
    /// 0 for a vertical border at an x, 1 for a horizontal one at a y.
    across: usize,
    at: f64,
    /// 1 to keep larger coordinates, -1 to keep smaller ones.
    side: f64,
}

impl Border {
    fn coordinate(self, p: Point) -> f64 {
        if self.across == 0 { p.x } else { p.y }
    }

    /// Distance of a point from the border, positive inside.
    fn inside(self, p: Point) -> f64 {
        (self.coordinate(p) - self.at) * self.side
    }

    /// Projects a point onto the border.
    fn onto(self, p: Point) -> Point {
        if self.across == 0 { Point::new(self.at, p.y) } else { Point::new(p.x, self.at) }
    }

    fn cut(self, segs: Vec<Seg>, tolerance: f64) -> Vec<Seg> {
        let extent = |s: &Seg| {
            let b = s.bounding_box();
            let (p, q) = (Point::new(b.x0, b.y0), Point::new(b.x1, b.y1));
            (self.inside(p).min(self.inside(q)), self.inside(p).max(self.inside(q)))
        };
        let mut kept: Vec<Seg> = Vec::with_capacity(segs.len());
        for s in segs {
            match (extent(&s), s) {
                ((least, _), s) if least >= 0.0 => kept.push(s),
                ((_, most), _) if most <= 0.0 => {}
                (_, Seg::Arc(arc)) => {
                    for c in arc.to_cubics(tolerance) {
                        self.split(Seg::Cubic(c), &mut kept);
                    }
                }
                (_, s) => self.split(s, &mut kept),
            }
        }
        // Replace the parts outside by lines along the border.
        let mut out: Vec<Seg> = Vec::with_capacity(kept.len() + 2);
        for s in kept {
            if let Some(end) = out.last().map(Seg::end).filter(|e| *e != s.start()) {
                out.push(Seg::Line(Line::new(end, s.start())));
            }
            out.push(s);
        }
        if let Some(start) = out.first().map(Seg::start) {
            join(&mut out, start);
        }
        out
    }

    /// Parameters at which a segment, extended past its ends, crosses the border.
    fn crossings(self, s: &Seg) -> Vec<f64> {
        /// Treat the cubic coefficient as zero below this fraction of the others; its rounding errors would spoil the roots.
        const NEGLIGIBLE: f64 = 1e-11;
        let c = s.to_cubic();
        let [a, b, c, d] = [c.p0, c.p1, c.p2, c.p3].map(|p| self.inside(p));
        let [linear, square, cubic] = [3.0 * (b - a), 3.0 * (a - 2.0 * b + c), d - a + 3.0 * (b - c)];
        match s {
            // Exact for lines.
            Seg::Line(_) => vec![a / (a - d)],
            _ if cubic.abs() <= NEGLIGIBLE * (a.abs() + linear.abs() + square.abs()) => {
                solve_quadratic(a, linear, square).into_iter().collect()
            }
            _ => solve_cubic(a, linear, square, cubic).into_iter().collect(),
        }
    }

    /// Splits a segment at the border and keeps the parts inside.
    fn split(self, s: Seg, kept: &mut Vec<Seg>) {
        /// Crossings closer than this to an end parameter are ignored.
        const END: f64 = 1e-12;
        let mut at = self.crossings(&s);
        at.retain(|t| *t > END && *t < 1.0 - END);
        at.sort_by(f64::total_cmp);
        at.push(1.0);
        let mut from = 0.0;
        for to in at {
            if self.inside(s.eval(0.5 * (from + to))) >= 0.0
                && let Some(mut piece) = s.part(from, to)
            {
                if from > 0.0 {
                    let p = self.onto(piece.start());
                    move_end(&mut piece, true, p);
                }
                if to < 1.0 {
                    let p = self.onto(piece.end());
                    move_end(&mut piece, false, p);
                }
                kept.push(piece);
            }
            from = to;
        }
    }
}

fn move_end(s: &mut Seg, start: bool, p: Point) {
    let end = match s {
        Seg::Line(l) => [&mut l.p0, &mut l.p1],
        Seg::Quad(q) => [&mut q.p0, &mut q.p2],
        Seg::Cubic(c) => [&mut c.p0, &mut c.p3],
        Seg::Arc(a) => [&mut a.p0, &mut a.p1],
    };
    let [first, last] = end;
    *(if start { first } else { last }) = p;
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::kurbo::Shape as _;

    /// Winding numbers are unchanged inside and zero outside.
    #[test]
    fn the_inside_keeps_its_windings() {
        let area = Rect::new(2.0, 1.0, 9.0, 8.0);
        for d in [
            "M5,4 m-6,0 a6,6 0 1 1 12,0 a6,6 0 1 1 -12,0 Z",
            "M0,0 L10,0 L10,10 L0,10 Z M3,3 L3,20 L20,20 L20,3 Z M4,4 L5,4 L5,5 Z",
            "M-3,5 C20,-30 -12,40 14,4 Q4,20 5,-5 L-9,2",
            "M2,1 L9,1 L9,8 L2,8 Z M0,1 L12,1 L12,8 L0,8 Z",
            "M20,20 L30,20 L30,30 Z",
        ] {
            let outline = Outline::from_svg(d).unwrap();
            let cut = within(&outline, area, 1e-9).to_bez_path(1e-9);
            let mut whole = outline.to_bez_path(1e-9);
            if !d.ends_with('Z') {
                whole.close_path();
            }
            let mut seen = 0;
            for k in 0..60 * 60 {
                let p = Point::new(f64::from(k % 60) * 0.2031 - 1.0, f64::from(k / 60) * 0.1973 - 1.0);
                let wanted = if area.contains(p) { whole.winding(p) } else { 0 };
                assert_eq!(cut.winding(p), wanted, "{d} at {p:?}");
                seen += usize::from(wanted != 0);
            }
            assert!(seen > 50 || d.starts_with("M20"), "{d}");
            let b = cut.bounding_box();
            assert!(
                cut.elements().is_empty()
                    || area.union(b) == area
                    || area.inflate(1e-9, 1e-9).union(b) == area.inflate(1e-9, 1e-9)
            );
        }
    }

    /// Outlines inside the box are unchanged, arcs included.
    #[test]
    fn nothing_to_cut() {
        let o = Outline::from_svg("M4,4 a2,2 0 1 1 4,0 Z").unwrap();
        assert_eq!(within(&o, Rect::new(0.0, 0.0, 10.0, 10.0), 1e-9), o);
    }
}
