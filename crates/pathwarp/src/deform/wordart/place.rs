//! The box that a text shape is drawn in, laid to the artwork's proportion, and the lines of lettering.
//!
//! On a single guide, letters keep their size and the box is a square. Artwork of width w and height h, measured at half its
//! height, is as long as a guide of length L that turns by θ (positive: outwards) if L = w − θh/2, because the length of an
//! offset is linear in its height. Between two guides the box has the proportion whose map distorts the artwork least, and the
//! size that keeps the artwork's area.

use crate::map::Map;
use crate::map::curves::ArcLength;
use crate::outline::Seg;
use crate::param::Letter;
use kurbo::{Point, Rect, Size};

/// The box that a text shape is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum ShapeBox {
    /// For round shapes, the box that suits the artwork's proportion; for all others, the artwork's own.
    #[default]
    Fit,
    /// The artwork's own.
    Artwork,
    /// This box.
    Given(Rect),
}

/// A guide, or artwork, that returns to its start within this share of its size is closed.
const CLOSED: f64 = 1e-3;
/// Letters outside a guide become at most 1 + this times as wide at the top as at the foot.
const WIDEST: f64 = 1.0;
/// Letters inside a guide become at most 1 − this times as wide at the top as at the foot.
const NARROWEST: f64 = 0.5;

/// The box is larger by this, so that rounding makes no artwork longer than its guide.
const SLACK: f64 = 1.0 + 1e-6;

/// Returns `true` if a guide ends where it starts.
pub(super) fn is_closed(guide: &[Seg]) -> bool {
    let ends = guide.first().zip(guide.last());
    ends.is_some_and(|(a, b)| a.start().distance(b.end()) < CLOSED * length(guide))
}

/// Returns the side of the square box in which `width` × `height` stands on a guide, true to size. `guide` is drawn in the unit
/// square.
pub(super) fn side(guide: &[Seg], width: f64, height: f64) -> f64 {
    let turn = turn(guide);
    let least = if turn > 0.0 { turn * height / WIDEST } else { -turn * height / NARROWEST };
    (width - 0.5 * turn * height).max(least) * SLACK / length(guide)
}

/// Returns the distance along a guide of its highest point on the screen, as a share of its length.
pub(super) fn top(guide: &[Seg]) -> f64 {
    let (mut best, mut before) = ((f64::INFINITY, 0.0), 0.0);
    for s in guide {
        if let Some((u, y)) = samples().map(|(u, _)| (u, s.eval(u).y)).min_by(|a, b| a.1.total_cmp(&b.1))
            && y < best.0
        {
            best = (y, before + ArcLength::new(&|t| s.deriv(t * u).hypot() * u).length());
        }
        before += length(std::slice::from_ref(s));
    }
    best.1 / before
}

/// Returns `true` if artwork leaves more of a guide free than `space`.
pub(super) fn is_loose(guide: &[Seg], width: f64, height: f64, space: f64) -> bool {
    mid_length(guide, height) > (width + space) * (1.0 + CLOSED)
}

/// The length of a guide, measured at half the height of the artwork that stands on it.
pub(super) fn mid_length(guide: &[Seg], height: f64) -> f64 {
    length(guide) + 0.5 * turn(guide) * height
}

/// Samples of a guide's piece, between which its tangent turns by less than half a circle.
const SAMPLES: u32 = 256;

fn samples() -> impl Iterator<Item = (f64, f64)> {
    (0..SAMPLES).map(|i| (f64::from(i) / f64::from(SAMPLES), f64::from(i + 1) / f64::from(SAMPLES)))
}

fn length(guide: &[Seg]) -> f64 {
    guide.iter().map(|s| ArcLength::of(s).length()).sum()
}

/// The total turn of the tangent, radians, clockwise on the screen.
fn turn(guide: &[Seg]) -> f64 {
    let between = |s: &Seg, (a, b): (f64, f64)| {
        let (a, b) = (s.deriv(a), s.deriv(b));
        a.cross(b).atan2(a.dot(b))
    };
    guide.iter().flat_map(|s| samples().map(move |ends| between(s, ends))).sum()
}

/// Returns the box about the middle of `rect` in which `map` distorts the artwork least and keeps its area. `map` builds the map
/// for a box; `None` if a guide has no length there.
pub(super) fn least_distorting<E>(
    rect: Rect,
    map: impl Fn(Rect) -> Result<Option<std::sync::Arc<dyn Map>>, E>,
) -> Result<Rect, E> {
    /// Logarithms of the proportions tried: between 1:20 and 20:1.
    const RANGE: f64 = 3.0;
    /// Steps of golden section: the proportion is found to a millionth, since where rounding ends a search it must not show.
    const STEPS: usize = 32;
    let of = |log: f64| {
        let area = (rect.width() * rect.height()).sqrt();
        Rect::from_center_size(rect.center(), Size::new(area * (0.5 * log).exp(), area * (-0.5 * log).exp()))
    };
    let cost = |log: f64| Ok(map(of(log))?.map_or((f64::INFINITY, 1.0), |m| distortion(rect, &*m)));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (-RANGE, RANGE);
    let tried = |log: f64| Ok((log, cost(log)?.0));
    let (mut x, mut y) = (tried(b - golden * (b - a))?, tried(a + golden * (b - a))?);
    for _ in 0..STEPS {
        if x.1 <= y.1 {
            (b, y) = (y.0, x);
            x = tried(b - golden * (b - a))?;
        } else {
            (a, x) = (x.0, y);
            y = tried(a + golden * (b - a))?;
        }
    }
    let best = 0.5 * (a + b);
    let scale = cost(best)?.1.sqrt().recip();
    let found = of(best);
    Ok(Rect::from_center_size(found.center(), found.size() * scale))
}

/// The mean squared logarithm of the ratio of the singular values over a box, and the mean factor of areas.
fn distortion(rect: Rect, map: &dyn Map) -> (f64, f64) {
    /// Columns and rows of sampled points.
    const GRID: [u32; 2] = [24, 3];
    /// The square of the logarithm for a collapsed or mirrored point.
    const WORST: f64 = 50.0;
    let share = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    let (mut cost, mut area) = (0.0, 0.0);
    for (i, j) in (0..GRID[0]).flat_map(|i| (0..GRID[1]).map(move |j| (i, j))) {
        let p = Point::new(rect.x0 + rect.width() * share(i, GRID[0]), rect.y0 + rect.height() * share(j, GRID[1]));
        let jet = map.jet(p);
        // σ₁/σ₂ + σ₂/σ₁ = (|Fx|² + |Fy|²)/det = 2 cosh ln(σ₁/σ₂).
        let cosh = 0.5 * (jet.dx.hypot2() + jet.dy.hypot2()) / jet.det();
        cost += if cosh >= 1.0 { cosh.acosh().powi(2).min(WORST) } else { WORST };
        area += jet.det().abs();
    }
    let count = f64::from(GRID[0] * GRID[1]);
    (cost / count, area / count)
}

/// A line of lettering: the top and the bottom of its letters.
pub(super) type Line = (f64, f64);

/// The lines of the letters within `rect`, from top to bottom.
pub(super) fn lines(letters: &[Letter], rect: Rect) -> Vec<Line> {
    let mut rows: Vec<(f64, Line)> = Vec::new();
    for l in letters.iter().filter(|l| rect.contains(l.middle()) || rect.y0 < l.origin.y && l.origin.y <= rect.y1) {
        let Some(b) = l.outline.bounding_box() else { continue };
        let same = |y: f64| (y - l.origin.y).abs() < 0.5 * b.height().max(l.advance);
        match rows.iter_mut().find(|(y, _)| same(*y)) {
            Some((_, (top, bottom))) => (*top, *bottom) = (top.min(b.y0), bottom.max(b.y1)),
            None => rows.push((l.origin.y, (b.y0, b.y1))),
        }
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|(_, line)| line).collect()
}

/// Returns the heights in the middle of the gaps between lines; `None` unless they rise and lie inside `rect`.
pub(super) fn gaps(lines: &[Line], rect: Rect) -> Option<Vec<f64>> {
    let cuts: Vec<f64> = lines.windows(2).map(|w| 0.5 * (w[0].1 + w[1].0)).collect();
    let rising = cuts.windows(2).all(|w| w[0] < w[1]);
    (rising && cuts.iter().all(|y| *y > rect.y0 && *y < rect.y1)).then_some(cuts)
}
