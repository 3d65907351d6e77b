//! A summary of nodes that shows by which affine map they were moved, if by one.
//!
//! Of many nodes, the means of consecutive ones are kept: affine maps move them like the nodes, and a single node that is moved by hand
//! moves one of them.

use pathwarp::kurbo::{Affine, Point, Rect, Vec2};

/// The largest error as a share of the object's size: Inkscape rounds coordinates to eight digits.
const LARGEST: f64 = 1e-5;

/// The number of means.
const MEANS: usize = 12;

/// Nodes in short.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Nodes {
    count: usize,
    means: Vec<Point>,
}

impl Nodes {
    /// Summarises nodes.
    pub(super) fn of(nodes: &[Point]) -> Self {
        let size = nodes.len().div_ceil(MEANS).max(1);
        let mean = |part: &[Point]| {
            let sum = part.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2());
            (sum / part.len() as f64).to_point()
        };
        Self { count: nodes.len(), means: nodes.chunks(size).map(mean).collect() }
    }

    /// As text.
    pub(super) fn text(&self) -> String {
        let means = self.means.iter().map(|p| format!(" {},{}", p.x, p.y));
        std::iter::once(self.count.to_string()).chain(means).collect()
    }

    /// Reads the text. Returns `None` for other text.
    pub(super) fn read(text: &str) -> Option<Self> {
        let mut words = text.split_whitespace();
        let count = words.next()?.parse().ok()?;
        let point = |w: &str| {
            let (x, y) = w.split_once(',')?;
            Some(Point::new(x.parse().ok()?, y.parse().ok()?))
        };
        Some(Self { count, means: words.map(point).collect::<Option<_>>()? })
    }

    /// Finds the affine map that takes these nodes to others.
    pub(super) fn moved_to(&self, now: &Self) -> Move {
        if self.count == now.count { found(&self.means, &now.means) } else { Move::Otherwise }
    }
}

/// A change between two lists of nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Move {
    /// An affine map; the identity if nothing moved.
    By(Affine),
    /// No affine map takes one to the other.
    Otherwise,
}

/// Finds the affine map that takes every point of `from` to that of `to`.
fn found(from: &[Point], to: &[Point]) -> Move {
    let (Some(&p0), Some(&q0)) = (from.first(), to.first()) else {
        return if from.len() == to.len() { Move::By(Affine::IDENTITY) } else { Move::Otherwise };
    };
    if from.len() != to.len() {
        return Move::Otherwise;
    }
    let size = |points: &[Point]| {
        let b = points.iter().fold(Rect::from_points(points[0], points[0]), |b, p| b.union_pt(*p));
        b.width().hypot(b.height())
    };
    let allowed = LARGEST * size(to).max(size(from)).max(f64::MIN_POSITIVE);
    let fits = |a: Affine| from.iter().zip(to).all(|(p, q)| (a * *p).distance(*q) <= allowed);
    let candidates = [Some(Affine::IDENTITY), Some(Affine::translate(q0 - p0)), by_three(from, to)];
    let unit = size(to).log10().floor();
    let near = candidates.into_iter().flatten().map(|a| rounded(a, unit));
    near.into_iter().find(|a| fits(*a)).map_or(Move::Otherwise, Move::By)
}

/// A map with as many digits as coordinates are written with, for points of a size of ten to the power of `unit`.
fn rounded(a: Affine, unit: f64) -> Affine {
    /// Digits after those that Inkscape writes are noise.
    const DIGITS: f64 = 9.0;
    let round = |v: f64, digits: f64| {
        let k = 10_f64.powf(digits.clamp(0.0, 2.0 * DIGITS));
        (v * k).round() / k
    };
    let [a, b, c, d, e, f] = a.as_coeffs();
    let [a, b, c, d] = [a, b, c, d].map(|v| round(v, DIGITS));
    let [e, f] = [e, f].map(|v| round(v, DIGITS - unit));
    Affine::new([a, b, c, d, e, f])
}

/// The affine map that takes three points far apart to their images.
fn by_three(from: &[Point], to: &[Point]) -> Option<Affine> {
    let p0 = *from.first()?;
    let most = |value: &dyn Fn(&Point) -> f64| {
        let all = from.iter().enumerate().map(|(i, p)| (i, value(p)));
        all.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    };
    let i = most(&|p| p.distance(p0))?;
    let u = *from.get(i)? - p0;
    let j = most(&|p| u.cross(*p - p0).abs())?;
    let v = *from.get(j)? - p0;
    let frame = |o: Point, a: Point, b: Point| Affine::new([a.x - o.x, a.y - o.y, b.x - o.x, b.y - o.y, o.x, o.y]);
    let q = |i: usize| to.get(i).copied();
    (u.cross(v).abs() > 1e-9 * u.hypot2()).then_some(())?;
    Some(frame(*to.first()?, q(i)?, q(j)?) * frame(p0, p0 + u, p0 + v).inverse())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_are_found_and_other_changes_are_not() {
        let from: Vec<Point> = (0..9).map(|i| Point::new(f64::from(i * i), f64::from(i * 7 % 5))).collect();
        for a in [Affine::IDENTITY, Affine::translate((3.0, -1.0)), Affine::rotate(0.3).then_scale(2.0), Affine::FLIP_X]
        {
            let to: Vec<Point> = from.iter().map(|p| a * *p + Vec2::new(1e-7, 0.0)).collect();
            let Move::By(b) = found(&from, &to) else { panic!("{a:?}") };
            assert!(from.iter().all(|p| (b * *p).distance(a * *p) < 1e-3));
        }
        let mut bent = from.clone();
        bent[4].x += 1.0;
        assert_eq!(found(&from, &bent), Move::Otherwise);
        assert_eq!(found(&from, &from[1..]), Move::Otherwise);
        assert_eq!(found(&[], &[]), Move::By(Affine::IDENTITY));
        let many: Vec<Point> = (0..500).map(|i| Point::new(f64::from(i * i % 97), f64::from(i * 31 % 89))).collect();
        let was = Nodes::of(&many);
        assert_eq!(Nodes::read(&was.text()).as_ref(), Some(&was));
        let turned: Vec<Point> = many.iter().map(|p| Affine::rotate(1.0) * *p).collect();
        assert!(matches!(was.moved_to(&Nodes::of(&turned)), Move::By(a) if (a.determinant() - 1.0).abs() < 1e-9));
        let mut bent = many.clone();
        bent[321].y += 1.0;
        assert_eq!(was.moved_to(&Nodes::of(&bent)), Move::Otherwise);
        assert_eq!(was.moved_to(&Nodes::of(&many[1..])), Move::Otherwise);
    }
}
