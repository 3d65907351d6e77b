//! Gradients and patterns under a map: the best affine fit over the painted shape.

use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::Map;

/// An affine stand-in for a map over a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fit {
    /// Between the two user spaces.
    pub(crate) affine: Affine,
    /// The largest distance between it and the map over the samples, relative to the box's image.
    pub(crate) residual: f64,
    /// That distance in the units of the space fitted into.
    pub(crate) miss: f64,
}

/// The best affine fit of `map` over `area`, from a user space that `read` takes to root user space to one that `write` does.
/// `None` where the map is not finite, or all is one point.
pub(crate) fn fit(area: Rect, read: Affine, write: Affine, map: &dyn Map) -> Option<Fit> {
    let back = write.inverse();
    let pairs: Vec<(Point, Point)> =
        grid(area).map(|p| (p, back * map.point(read * p))).filter(|(_, q)| q.is_finite()).collect();
    let n = pairs.len() as f64;
    if pairs.len() < 3 {
        return None;
    }
    let mean = |f: fn(&(Point, Point)) -> Point| {
        (pairs.iter().map(|p| f(p).to_vec2()).fold(Vec2::ZERO, |a, b| a + b) / n).to_point()
    };
    let (p0, q0) = (mean(|p| p.0), mean(|p| p.1));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    let (mut ux, mut uy) = (Vec2::ZERO, Vec2::ZERO);
    for (p, q) in &pairs {
        let (d, w) = (*p - p0, *q - q0);
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
        ux += w * d.x;
        uy += w * d.y;
    }
    let det = xx * yy - xy * xy;
    // A box without area, such as a straight line's: the map's own derivative has to do.
    let (cx, cy) = if det > 1e-12 * (xx + yy).powi(2) {
        ((ux * yy - uy * xy) / det, (uy * xx - ux * xy) / det)
    } else {
        let centre = read * area.center();
        let jet = map.jet(centre);
        if !jet.is_finite() {
            return None;
        }
        let local = back * Affine::new([jet.dx.x, jet.dx.y, jet.dy.x, jet.dy.y, 0.0, 0.0]) * read;
        let [a, b, c, d, ..] = local.as_coeffs();
        (Vec2::new(a, b), Vec2::new(c, d))
    };
    let shift = q0.to_vec2() - cx * p0.x - cy * p0.y;
    let affine = Affine::new([cx.x, cx.y, cy.x, cy.y, shift.x, shift.y]);
    let miss = pairs.iter().map(|(p, q)| (affine * *p).distance(*q)).fold(0.0, f64::max);
    let size = (cx * area.width()).hypot() + (cy * area.height()).hypot();
    affine.is_finite().then_some(Fit { affine, residual: if size > 0.0 { miss / size } else { 0.0 }, miss })
}

/// As [`fit`], over the box of all copies: what was laid over one of them is stretched over the row. Where no affine map
/// comes near the row's image, as round a ring, it is stretched over that image's box, `result`.
pub(crate) fn fit_copies(
    area: Rect,
    read: Affine,
    write: Affine,
    map: &dyn Map,
    copies: &[Affine],
    result: Rect,
) -> Option<Fit> {
    /// Beyond this share of the fitted size an affine fit says nothing.
    const LOST: f64 = 0.25;
    let back = read.inverse();
    let Some(whole) = copies.iter().map(|m| (back * *m * read).transform_rect_bbox(area)).reduce(|a, b| a.union(b))
    else {
        return fit(area, read, write, map);
    };
    // A box without width or height keeps its size there.
    let scale = |own: f64, all: f64| if own > 0.0 && all > 0.0 { all / own } else { 1.0 };
    let onto = |all: Rect| {
        Affine::translate(all.origin().to_vec2())
            * Affine::scale_non_uniform(scale(area.width(), all.width()), scale(area.height(), all.height()))
            * Affine::translate(-area.origin().to_vec2())
    };
    let over = fit(whole, read, write, map).filter(|f| f.residual <= LOST);
    Some(match over {
        Some(over) => Fit { affine: over.affine * onto(whole), ..over },
        None => Fit { affine: onto(result), residual: 1.0, miss: f64::INFINITY },
    })
}

impl Fit {
    /// Whether it moves nothing on `area` by more than a hair of its size.
    pub(crate) fn is_identity(&self, area: Rect) -> bool {
        let size = area.width().hypot(area.height());
        let corners = [(area.x0, area.y0), (area.x1, area.y0), (area.x1, area.y1), (area.x0, area.y1)];
        corners.into_iter().map(Point::from).all(|p| (self.affine * p).distance(p) <= 1e-9 * size)
    }
}

fn grid(r: Rect) -> impl Iterator<Item = Point> {
    const N: u32 = 8;
    let at = |i: u32| f64::from(i) / f64::from(N);
    (0..=N).flat_map(move |i| (0..=N).map(move |j| Point::new(r.x0 + r.width() * at(i), r.y0 + r.height() * at(j))))
}
