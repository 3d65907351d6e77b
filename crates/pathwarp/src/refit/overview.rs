//! Bounds for a map over a part of the plane, computed once, so that short pieces of a path need no enclosures.

use crate::map::{Enclosure, Map};
use crate::outline::Seg;
use kurbo::{Point, Rect, Vec2};

/// The least number of segments for each cell.
const SEGMENTS: usize = 12;

/// Bounds for the Taylor coefficients of a map, in square cells of a box.
///
/// In a cell of side h, aₘ bounds the coefficient m of the image of p + h·(σ, σ), for each sign of the coordinates and all points p in the
/// cell and one side around it. The coefficients k of a cubic's coordinates are at most h·s·θᵏ⁻¹ for some s and θ, so that those of
/// s·τ/(1 − θτ) bound it in σ, and Σ aₘ·sᵐ·θ⁶⁻ᵐ·(5 over m−1) bounds coefficient 6 of its image. Enclosing the cubic itself would yield
/// the same or smaller bounds, since the same is computed on smaller ranges.
#[derive(Debug)]
pub(super) struct Overview {
    origin: Point,
    side: f64,
    columns: usize,
    rows: usize,
    /// The sums of both coordinates' bounds for each cell, row by row.
    cells: Vec<[f64; Enclosure::ORDER]>,
}

impl Overview {
    /// The overview for some segments. `None` if they are few, or if the map does not enclose curves.
    pub(super) fn new(map: &dyn Map, segs: &[Seg]) -> Option<Self> {
        let count = segs.len() / SEGMENTS;
        let ends = segs.iter().map(|seg| Rect::from_points(seg.start(), seg.end()));
        let area = ends.reduce(|a, b| a.union(b))?;
        let (width, height) = (area.width(), area.height());
        if count == 0 || map.detail(area).is_some() {
            return None;
        }
        let side = (width * height / count as f64).sqrt().max(width.max(height) / count as f64);
        let [columns, rows] = [width, height].map(|length| ((length / side).ceil() as usize).clamp(1, count));
        let mut out = Self { origin: area.origin(), side, columns, rows, cells: Vec::with_capacity(columns * rows) };
        for cell in 0..columns * rows {
            // The cell and one side around it, as the range of v in v + hτ and v − hτ.
            let range = |origin: f64, i: usize| Enclosure::sloped(origin + side * (i as f64 + 0.5), [1.5 * side, side]);
            let [x, y] = map.enclose([range(area.x0, cell % columns), range(area.y0, cell / columns)])?;
            out.cells.push(std::array::from_fn(|k| x.d[k] + y.d[k]));
        }
        Some(out)
    }

    /// Returns `true` if samples at `intervals` equal steps are known to determine the image of a cubic p + aτ + bτ² + cτ³, with these
    /// coefficients a, b and c, within the tolerance.
    pub(super) fn resolves(&self, p: Point, coefficients: [Vec2; 3], intervals: usize, tolerance: f64) -> bool {
        /// The binomials 5 over m − 1.
        const BINOMIALS: [f64; Enclosure::ORDER] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        let scale = 1.0 / self.side;
        let [a, b, c] = coefficients.map(|v| v.x.abs().max(v.y.abs()) * scale);
        let v = (p - self.origin) * scale;
        let stays_near = v.x >= 0.0 && v.y >= 0.0 && a + b + c <= 1.0;
        let (column, row) = (v.x as usize, v.y as usize);
        if !stays_near || column >= self.columns || row >= self.rows {
            return false;
        }
        let theta = (b / a).max((c / a).sqrt());
        let (mut sum, mut power) = (0.0, 1.0);
        for (bound, binomial) in self.cells[row * self.columns + column].iter().zip(BINOMIALS).rev() {
            // The sum of the terms from this one on, without the powers of `a` that all of them have.
            sum = sum * a + bound * binomial * power;
            power *= theta;
        }
        Enclosure::LAST_SPREAD * sum * a <= tolerance * (intervals as f64).powi(Enclosure::ORDER as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Outline;
    use crate::deform::Registry;
    use crate::map::enclose_segment;
    use crate::param::{Args, Frame};

    /// Pieces that an overview resolves are resolved by their enclosures too; and nearly all short pieces under gentle maps are.
    #[test]
    fn an_overview_tells_what_enclosures_tell() {
        const TOLERANCE: f64 = 0.01;
        let frame = Frame::new(Rect::new(0.0, 0.0, 1000.0, 1000.0));
        let all: [(&str, &[(&str, &str)]); 3] = [
            ("wave", &[("length", "300"), ("height", "40")]),
            ("polar", &[]),
            ("expr", &[("y", "y+9*sin(x/9)*exp(-((y-500)/200)^2)")]),
        ];
        // A linear congruential generator (D. E. Knuth's for MMIX).
        let mut state = 1_u64;
        let mut between = |from: f64, to: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            from + (to - from) * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for (name, args) in all {
            let map = Registry::builtin().get(name).unwrap().build_from(&Args::from_pairs(args), &frame).unwrap().map;
            let (mut told, mut count) = (0, 0);
            for size in [3.0, 20.0, 100.0] {
                let (x, y) = (between(0.0, 500.0), between(0.0, 500.0));
                let mut at = || format!("{} {} ", x + between(0.0, size), y + between(0.0, size));
                let d: String = (0..40).map(|_| format!("C{}{}{}", at(), at(), at())).collect();
                let outline = Outline::from_svg(&format!("M{}{d}", at())).unwrap();
                let segs: Vec<Seg> = outline.segs().copied().collect();
                let overview = Overview::new(&*map, &segs).unwrap();
                for (i, seg) in segs.iter().enumerate() {
                    let part = seg.part(0.01 * i as f64, 0.01 * i as f64 + 0.15).unwrap().to_cubic();
                    let (d0, d1, d2) = (part.p1 - part.p0, part.p2 - part.p1, part.p3 - part.p2);
                    let way = [d0 * 3.0, (d1 - d0) * 3.0, d2 - d1 * 2.0 + d0];
                    for intervals in [9, 17] {
                        let own = map.enclose(enclose_segment(seg, [0.01 * i as f64, 0.01 * i as f64 + 0.15])).unwrap();
                        let known = overview.resolves(part.p0, way, intervals, TOLERANCE);
                        assert!(!known || Enclosure::resolved(&own, intervals, 1.01 * TOLERANCE), "{name} {seg:?}");
                        (told, count) = (told + usize::from(known), count + 1);
                    }
                }
            }
            assert!(3 * told > 2 * count, "{name}: {told} of {count}");
        }
    }
}
