//! Outlines of the basic shapes, with true arcs.

use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::outline::{Builder, EllipticArc};
use std::f64::consts::FRAC_PI_2;

/// Adds an ellipse: four quarters from three o'clock, clockwise on screen, as in the SVG specification.
pub(super) fn ellipse(b: &mut Builder, c: Point, r: Vec2) -> Option<()> {
    if !(r.x > 0.0 && r.y > 0.0) {
        return None;
    }
    b.move_to(Point::new(c.x + r.x, c.y));
    // Exact end points, without the rounding of a computed cosine.
    let ends = [(c.x, c.y + r.y), (c.x - r.x, c.y), (c.x, c.y - r.y), (c.x + r.x, c.y)];
    for (i, end) in ends.into_iter().enumerate() {
        quarter(b, c, r, i, end.into());
    }
    b.close();
    Some(())
}

/// Adds quarter `i` of an ellipse.
fn quarter(b: &mut Builder, c: Point, r: Vec2, i: usize, end: Point) {
    let arc = EllipticArc::new(c, Vec2::new(r.x, 0.0), Vec2::new(0.0, r.y), i as f64 * FRAC_PI_2, FRAC_PI_2);
    b.arc(EllipticArc { p0: b.at(), p1: end, ..arc });
}

/// Adds a rectangle with rounded corners, in the order of the SVG specification.
pub(super) fn rounded_rect(b: &mut Builder, r: Rect, radii: Vec2) {
    let Vec2 { x: rx, y: ry } = radii;
    if rx <= 0.0 || ry <= 0.0 {
        b.move_to(Point::new(r.x0, r.y0));
        for p in [(r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)] {
            b.line_to(p.into());
        }
        b.close();
        return;
    }
    // Each corner: end of the straight run, centre of the arc, number of the quarter, end of the arc.
    let corners = [
        ((r.x1 - rx, r.y0), (r.x1 - rx, r.y0 + ry), 3, (r.x1, r.y0 + ry)),
        ((r.x1, r.y1 - ry), (r.x1 - rx, r.y1 - ry), 0, (r.x1 - rx, r.y1)),
        ((r.x0 + rx, r.y1), (r.x0 + rx, r.y1 - ry), 1, (r.x0, r.y1 - ry)),
        ((r.x0, r.y0 + ry), (r.x0 + rx, r.y0 + ry), 2, (r.x0 + rx, r.y0)),
    ];
    b.move_to(Point::new(r.x0 + rx, r.y0));
    for (run, centre, i, end) in corners {
        if b.at() != Point::from(run) {
            b.line_to(run.into());
        }
        quarter(b, centre.into(), radii, i, end.into());
    }
    b.close();
}
