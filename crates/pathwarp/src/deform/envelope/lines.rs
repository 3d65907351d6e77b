//! Lines of lettering in a closed shape: each is as wide as the shape at its height, and only the letters' tops and bottoms are bent.
//!
//! > (x, v) ↦ (X(x), t(X) + v·(b(X) − t(X))), X linear in each line, or in both parts of a line that is divided at a notch
//!
//! The boundaries between lines are parabolas, between the trends of the shape's top and its bottom; a boundary is named by its *level*,
//! its mean ordinate. A band between two boundaries, clipped by the outline, ends where it is too low for letters. Levels are chosen to
//! fill the shape best, about its middle, with letters of similar heights and widths: a dynamic program over the levels gives every plan
//! its worth, the area of the letters less costs, as a share of the shape's area. The top t and bottom b of a line are splines, so no
//! corner of the outline bends a letter. The constants below were chosen by eye.

use super::columns::Region;
use crate::error::Error;
use crate::map::{Lattice, LatticeMap, Map, TileRow, Tiled, bspline};
use crate::param::Letter;
use kurbo::{Affine, Point, Rect};
use std::ops::Range;
use std::sync::Arc;

/// A line of lettering.
pub(super) struct Line {
    /// Its letters, for messages.
    name: String,
    /// The box of its letters and of all other artwork between the neighbouring lines.
    rect: Rect,
    /// Indices of its letters, from left to right, and their boxes.
    letters: Vec<(usize, Rect)>,
}

/// Divides letters into lines by their baselines, from top to bottom.
pub(super) fn divide(letters: &[Letter], ink: &[Point]) -> Vec<Line> {
    /// Baselines that differ by less than this share of the letters' height are the same.
    const SAME: f64 = 0.3;
    /// A line lower than this share of the highest, such as one of dashes, keeps room above and below.
    const LOW: f64 = 0.4;
    let boxes = letters.iter().enumerate().filter_map(|(i, l)| Some((l.origin.y, i, l.outline.bounding_box()?)));
    let mut boxes: Vec<(f64, usize, Rect)> = boxes.filter(|l| l.2.area() > 0.0).collect();
    boxes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut lines: Vec<(f64, Line)> = Vec::new();
    for (y, i, b) in boxes {
        match lines.last_mut() {
            Some((first, line)) if y - *first <= SAME * line.rect.height() => {
                line.rect = line.rect.union(b);
                line.letters.push((i, b));
            }
            _ => lines.push((y, Line { name: String::new(), rect: b, letters: vec![(i, b)] })),
        }
    }
    let mut lines: Vec<Line> = lines.into_iter().map(|l| l.1).collect();
    let cuts = cuts(&lines);
    let highest = lines.iter().map(|l| l.rect.height()).fold(0.0, f64::max);
    for line in &mut lines {
        line.letters.sort_by(|a, b| a.1.x0.total_cmp(&b.1.x0));
        line.name = line.letters.iter().map(|l| letters[l.0].name.as_str()).collect();
        line.rect = line.rect.inflate(0.0, (0.5 * (LOW * highest - line.rect.height())).max(0.0));
    }
    for p in ink {
        let line = cuts.partition_point(|c| *c < p.y);
        if line < lines.len() && !lines.iter().any(|l| l.holds(*p)) {
            lines[line].rect = lines[line].rect.union_pt(*p);
        }
    }
    lines
}

/// Returns ordinates that separate the lines, from top to bottom.
fn cuts(lines: &[Line]) -> Vec<f64> {
    let mut cuts: Vec<f64> = lines.windows(2).map(|w| 0.5 * (w[0].rect.y1 + w[1].rect.y0)).collect();
    for k in 1..cuts.len() {
        cuts[k] = cuts[k].max(cuts[k - 1]);
    }
    cuts
}

/// Part of a line: some of its letters, and the range of x that they fill in the shape.
#[derive(Clone)]
struct Part {
    letters: Range<usize>,
    xs: [f64; 2],
    /// Widening of the letters: their width, spaces included, by their height, as a multiple of that ratio in the artwork.
    widening: f64,
    area: f64,
}

/// The parts of a line, and the boundaries of its band.
#[derive(Clone)]
struct Band {
    /// The levels of its boundaries; `None` where the outline is the boundary.
    levels: [Option<f64>; 2],
    parts: Vec<Part>,
}

impl Band {
    fn width(&self) -> f64 {
        self.parts.iter().map(|p| p.xs[1] - p.xs[0]).sum()
    }
}

/// Runs of columns of a band in which letters may stand: single ones, and pairs beside a notch.
type Runs = (Vec<Range<usize>>, Vec<[Range<usize>; 2]>);

/// The worth of bands, and the bands.
type Plan = (f64, Vec<Band>);

/// The parabola that fits the top or the bottom of the shape: mean height, slope and bend.
#[derive(Clone, Copy, Default)]
struct Trend {
    mean: f64,
    slope: f64,
    bend: f64,
}

/// A shape in columns of equal width.
struct ColumnedShape<'a> {
    region: &'a Region,
    bounds: Rect,
    columns: Vec<Column>,
    /// The width of a column.
    step: f64,
    area: f64,
    /// The mean height of a line.
    line_height: f64,
    /// The gap between lines.
    gap: f64,
    /// The mean x of the shape.
    middle: f64,
    /// The variance of x over the shape.
    variance: f64,
    /// The trends of the top and the bottom.
    trends: [Trend; 2],
}

/// The x of a column, and its intervals inside the shape, each from its top downwards.
type Column = (f64, Vec<[f64; 2]>);

/// The interval of a column in a band; `None` if it is empty.
type Clipped = Option<[f64; 2]>;

fn height(c: &Clipped) -> f64 {
    c.map_or(0.0, |c| c[1] - c[0])
}

/// The columns of the shape, clipped to a band.
struct BandColumns {
    columns: Vec<Clipped>,
    /// For every column, sums over the columns before it: heights, their logarithms, and fourth powers of slopes.
    sums: Vec<[f64; 3]>,
    /// Steps between columns that are higher than this are jumps.
    jump: f64,
}

impl BandColumns {
    /// Creates the columns of a band; `step` is their width.
    fn new(columns: Vec<Clipped>, step: f64) -> Self {
        /// Number of columns on both sides over which a slope is measured.
        const BESIDE: usize = 3;
        let mut sums = vec![[0.0; 3]];
        for (i, c) in columns.iter().enumerate() {
            let end = |k: usize| if columns[k].is_some() { k } else { i };
            let (a, b) = (end(i.saturating_sub(BESIDE)), end((i + BESIDE).min(columns.len() - 1)));
            let rise = columns[a].zip(columns[b]).map_or(0.0, |(p, q)| (q[0] - p[0]).abs().max((q[1] - p[1]).abs()));
            let (h, slope) = (height(c), rise / (step * (b - a).max(1) as f64));
            let log = if h > 0.0 { h.ln() } else { 0.0 };
            let terms = [h, log, (slope / STEEP_SLOPE).powi(4)];
            sums.push([0, 1, 2].map(|k| sums[i][k] + terms[k]));
        }
        Self { columns, sums, jump: JUMP * step }
    }

    /// Returns the means over a run of columns of heights, their logarithms, and fourth powers of slopes.
    fn means(&self, r: &Range<usize>) -> [f64; 3] {
        [0, 1, 2].map(|k| (self.sums[r.end][k] - self.sums[r.start][k]) / r.len() as f64)
    }

    /// Returns runs of columns without a jump, whose heights are between `least` and `most`.
    fn runs_of_height(&self, least: f64, most: f64) -> Vec<Range<usize>> {
        let joins =
            |a: &Clipped, b: &Clipped| a.zip(*b).is_some_and(|(a, b)| (0..2).all(|k| (a[k] - b[k]).abs() <= self.jump));
        let mut out: Vec<Range<usize>> = Vec::new();
        for (i, c) in self.columns.iter().enumerate().filter(|c| height(c.1) >= least) {
            match out.last_mut() {
                Some(run) if run.end == i && joins(&self.columns[i - 1], c) => run.end = i + 1,
                _ => out.push(i..i + 1),
            }
        }
        out.retain(|r| self.columns[r.clone()].iter().all(|c| height(c) <= most));
        out
    }

    /// Returns runs of columns in which letters of about `height` may stand, and pairs of runs, which may be lower at a notch between them.
    fn runs(&self, height: f64) -> Runs {
        let [low, rest @ ..] = MIN_HEIGHTS.map(|e| self.runs_of_height(e * height, MAX_HEIGHT * height));
        let low_run = |x: usize| low.iter().find(|r| r.contains(&x)).cloned().unwrap_or(x..x + 1);
        // A pair of higher runs extends outwards into the low runs around it.
        let pairs = rest.iter().flat_map(|runs| runs.windows(2));
        let pairs = pairs.map(|w| [low_run(w[0].start).start..w[0].end, w[1].start..low_run(w[1].end - 1).end]);
        let pairs = low.windows(2).map(|w| [w[0].clone(), w[1].clone()]).chain(pairs);
        let pairs = pairs.filter(|[a, b]| a.end < b.start).collect();
        (low.iter().chain(rest.iter().flatten()).cloned().collect(), pairs)
    }
}

/// The letters aimed at: the logarithms of their height and of their widening ([`Part::widening`]).
#[derive(Clone, Copy)]
struct Aim {
    height: f64,
    widening: f64,
}

/// Number of columns of a shape.
const COLUMNS: u32 = 200;
/// Number of levels at which boundaries are tried.
const LEVELS: usize = 24;
/// Heights of letters that are tried, as multiples of a line's mean height, and widenings that are tried.
const HEIGHTS: [f64; 5] = [0.6, 0.8, 1.0, 1.25, 1.6];
const WIDENINGS: [f64; 5] = [0.4, 0.65, 1.0, 1.6, 2.4];
/// Least height of a jump, in widths of a column.
const JUMP: f64 = 3.0;
/// Number of positions that are tried for a line that is narrower than its band.
const POSITIONS: usize = 16;
/// The space between lines, as a share of their mean height.
const GAP: f64 = 0.12;
/// Limits on the height of a band, as shares of the height aimed at: a line ends where it is lower than one of `MIN_HEIGHTS`.
const MIN_HEIGHTS: [f64; 3] = [0.59, 0.75, 0.9];
const MAX_HEIGHT: f64 = 1.65;
/// Share of an outline's bend that boundaries follow.
const BEND_SHARE: f64 = 0.5;
/// Limits on widening: of the letters, and further by spaces between them.
const MAX_WIDENING: f64 = 2.0;
const MAX_SPACING: f64 = 1.45;
/// The least widening, which narrows letters.
const MIN_WIDENING: f64 = 0.3;
/// Costs, as shares of the shape's area: letters of different heights and widths, slopes, and lines beside the middle. The cost of a
/// slope grows steeply above `STEEP_SLOPE`.
const UNEVENNESS_COST: f64 = 0.3;
const SLOPE_COST: f64 = 0.3;
const STEEP_SLOPE: f64 = 1.5;
const OFF_CENTRE_COST: f64 = 10.0;
/// Widest gaps at which a line may be divided, as shares of its width: within a word, and between words.
const MAX_GAPS: [f64; 2] = [0.15, 0.4];
/// Cost of dividing a word, as a share of the shape's area.
const DIVISION_COST: f64 = 0.15;
/// Gaps of more than this share of the height are word spaces.
const WORD_SPACE: f64 = 0.2;
/// Least share of a shape that letters must fill.
const MIN_FILL: f64 = 0.48;

impl<'a> ColumnedShape<'a> {
    fn new(region: &'a Region, lines: usize) -> Option<Self> {
        let bounds = region.bounds;
        let step = bounds.width() / f64::from(COLUMNS);
        let xs = (0..COLUMNS).map(|i| bounds.x0 + (f64::from(i) + 0.5) * step);
        let columns: Vec<Column> = xs.map(|x| (x, region.spans(x))).collect();
        let filled = |c: &Column| c.1.iter().map(|s| s[1] - s[0]).sum::<f64>();
        let total: f64 = columns.iter().map(filled).sum();
        if total <= 0.0 {
            return None;
        }
        let mean = |f: &dyn Fn(&Column) -> f64| columns.iter().map(|c| filled(c) * f(c)).sum::<f64>() / total;
        let middle = mean(&|c| c.0);
        let variance = mean(&|c| (c.0 - middle).powi(2));
        let trend = |end: fn(&[[f64; 2]]) -> f64| {
            let y = |c: &Column| if c.1.is_empty() { 0.0 } else { end(&c.1) };
            let m = mean(&y);
            // Least squares by polynomials u and q of x whose means are 0.
            let (u, q) = (|c: &(f64, _)| c.0 - middle, |c: &(f64, _)| (c.0 - middle).powi(2) - variance);
            let slope = mean(&|c| u(c) * (y(c) - m)) / variance;
            let rest = |c: &Column| y(c) - m - slope * u(c);
            let bend = mean(&|c| q(c) * rest(c)) / mean(&|c| q(c).powi(2));
            // A trend counts by the share of the curve's variance that it explains.
            let unexplained = mean(&|c| (rest(c) - bend * q(c)).powi(2));
            let share = 1.0 - unexplained / mean(&|c| (y(c) - m).powi(2)).max(1e-12 * variance);
            let share = share.clamp(0.0, 1.0);
            Trend { mean: m, slope: slope * share, bend: share * bend }
        };
        let mut trends = [trend(|s| s[0][0]), trend(|s| s[s.len() - 1][1])];
        // The bend that both sides share is followed in full.
        let [a, b] = trends.map(|t| t.bend);
        let common = if a * b > 0.0 { a.abs().min(b.abs()) * a.signum() } else { 0.0 };
        trends.iter_mut().for_each(|t| t.bend = common + BEND_SHARE * (t.bend - common));
        let area = total * step;
        let line_height = area / bounds.width() / lines as f64;
        let gap = GAP * line_height;
        Some(Self { region, bounds, columns, step, area, line_height, gap, middle, variance, trends })
    }

    /// Returns the ordinate at `x` of the boundary whose mean is `level`.
    fn boundary(&self, level: f64, x: f64) -> f64 {
        let [top, bottom] = self.trends;
        let t = ((level - top.mean) / (bottom.mean - top.mean)).clamp(0.0, 1.0);
        let u = x - self.middle;
        let between = |a: f64, b: f64| a + t * (b - a);
        level + between(top.slope, bottom.slope) * u + between(top.bend, bottom.bend) * (u * u - self.variance)
    }

    /// Returns the longest of the intervals of a column, clipped between the boundaries of these levels.
    fn clipped(&self, x: f64, intervals: &[[f64; 2]], levels: [Option<f64>; 2]) -> Clipped {
        let from = levels[0].map_or(f64::NEG_INFINITY, |l| self.boundary(l, x) + 0.5 * self.gap);
        let to = levels[1].map_or(f64::INFINITY, |l| self.boundary(l, x) - 0.5 * self.gap);
        let clipped = intervals.iter().map(|s| [s[0].max(from), s[1].min(to)]).filter(|c| c[1] > c[0]);
        clipped.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))
    }

    /// Returns the best position of letters in a run of columns, with its worth. `anchor` is a position in the letters, 0 at their left end
    /// and 1 at their right one, and the column on which it should lie. `share` is the letters' share of all letters.
    fn best_part(
        &self,
        columns: &BandColumns,
        (run, anchor): (&Range<usize>, [f64; 2]),
        (line, letters, share): (&Line, Range<usize>, f64),
        aim: &Aim,
    ) -> Option<(f64, Part)> {
        let natural = line.part(&letters).width() / line.rect.height();
        let width = |widening: f64| (widening * natural * columns.means(run)[0] / self.step).round().max(1.0) as usize;
        let most = run.len().min(width(max_widening(letters.len())));
        let rated = |r: Range<usize>| {
            let [h, log, slopes] = columns.means(&r);
            let width = r.len() as f64 * self.step;
            let widening = width / h / natural;
            let unevenness = (log - aim.height).powi(2) + (widening.ln() - aim.widening).powi(2);
            let off_centre = (r.start as f64 + anchor[0] * r.len() as f64 - anchor[1]) / f64::from(COLUMNS);
            let cost = UNEVENNESS_COST * unevenness + SLOPE_COST * slopes + OFF_CENTRE_COST * off_centre.powi(2);
            let xs = [r.start, r.end - 1].map(|i| self.columns[i].0);
            let part = Part { letters: letters.clone(), xs, widening, area: width * h };
            (widening >= MIN_WIDENING).then_some((part.area / self.area - share * cost, part))
        };
        let widths = [1.0, 1.5].map(|k| width(k * aim.widening.exp())).into_iter().filter(|n| *n < most).chain([most]);
        let positions = widths.flat_map(|n| {
            let step = ((run.len() - n) / POSITIONS).max(1);
            (run.start..=run.end - n).step_by(step).map(move |from| from..from + n)
        });
        positions.filter_map(rated).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Returns the best way to put a line into a band, as a whole or divided at a notch. `share` is the line's share of all lines.
    fn best_parts(
        &self,
        line: &Line,
        share: f64,
        (columns, (runs, pairs)): &(&BandColumns, Runs),
        aim: &Aim,
    ) -> Option<(f64, Vec<Part>)> {
        let n = line.letters.len();
        let middle = (self.middle - self.bounds.x0) / self.step;
        let whole = runs.iter().filter_map(|run| {
            let (worth, part) = self.best_part(columns, (run, [0.5, middle]), (line, 0..n, share), aim)?;
            Some((worth, vec![part]))
        });
        let divided = pairs.iter().flat_map(|pair| line.divisions(pair).map(move |k| (pair, k)));
        let divided = divided.filter_map(|([left, right], k)| {
            let notch = 0.5 * (left.end + right.start) as f64;
            let share = |letters: usize| share * letters as f64 / n as f64;
            let (left_worth, a) = self.best_part(columns, (left, [1.0, notch]), (line, 0..k, share(k)), aim)?;
            let (right_worth, b) = self.best_part(columns, (right, [0.0, notch]), (line, k..n, share(n - k)), aim)?;
            let gap = (b.xs[0] - a.xs[1]) / (b.xs[1] - a.xs[0]);
            let cost = if line.is_space(k) { 0.0 } else { DIVISION_COST * share(n) };
            (gap <= MAX_GAPS[usize::from(line.is_space(k))]).then(|| (left_worth + right_worth - cost, vec![a, b]))
        });
        whole.chain(divided).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Returns the best bands for all lines.
    fn plan(&self, lines: &[Line]) -> Result<Vec<Band>, Error> {
        // The first and the last level are the outline.
        let level =
            |k: usize| (k > 0 && k < LEVELS).then(|| self.bounds.y0 + self.bounds.height() * k as f64 / LEVELS as f64);
        let pairs = (0..LEVELS).flat_map(|a| (a + 1..=LEVELS).map(move |b| [a, b]));
        let clipped = |levels| self.columns.iter().map(|(x, intervals)| self.clipped(*x, intervals, levels)).collect();
        let band = |pair: [usize; 2]| (pair, BandColumns::new(clipped(pair.map(level)), self.step));
        let all: Vec<([usize; 2], BandColumns)> = pairs.map(band).collect();
        let share = 1.0 / lines.len() as f64;
        let mut best: Option<Plan> = None;
        // The number of lines that fit, for the error.
        let mut reached = 0;
        for height in HEIGHTS.map(|k| k * self.line_height) {
            let bands: Vec<_> = all.iter().map(|(p, columns)| (*p, (columns, columns.runs(height)))).collect();
            for widening in WIDENINGS {
                let aim = Aim { height: height.ln(), widening: widening.ln() };
                // For every level, the best bands above it of the lines so far.
                let mut above: Vec<Option<Plan>> = vec![Some((0.0, Vec::new())); LEVELS + 1];
                for (i, line) in lines.iter().enumerate() {
                    let mut next: Vec<Option<Plan>> = vec![None; LEVELS + 1];
                    for ([a, b], columns) in &bands {
                        let Some((worth, plan)) = &above[*a] else { continue };
                        let Some((more, parts)) = self.best_parts(line, share, columns, &aim) else { continue };
                        if next[*b].as_ref().is_none_or(|other| other.0 < worth + more) {
                            let band = Band { levels: [level(*a), level(*b)], parts };
                            next[*b] = Some((worth + more, [&plan[..], &[band]].concat()));
                        }
                    }
                    above = next;
                    if above.iter().any(Option::is_some) {
                        reached = reached.max(i + 1);
                    }
                }
                best = above.into_iter().flatten().chain(best).reduce(|a, b| if b.0 > a.0 { b } else { a });
            }
        }
        let bands = best.ok_or_else(|| lines[reached].no_room(reached + 1))?.1;
        let filled: f64 = bands.iter().flat_map(|b| &b.parts).map(|p| p.area).sum();
        if filled < MIN_FILL * self.area {
            let height = |b: &Band| b.parts.iter().map(|p| p.area).sum::<f64>() / b.width();
            let lowest = (0..bands.len()).min_by(|a, b| height(&bands[*a]).total_cmp(&height(&bands[*b]))).unwrap_or(0);
            return Err(lines[lowest].no_room(lowest + 1));
        }
        Ok(bands)
    }

    /// Returns the map of a box of the artwork into the band between these levels, for a part of a line.
    fn map(&self, part: &Part, levels: [Option<f64>; 2], from: Rect) -> Option<Arc<dyn Map>> {
        const SAMPLES: u32 = 240;
        /// Share of the least height that smooth curves must leave.
        const MIN_SHARE: f64 = 0.93;
        let cells = (3 * part.letters.len() / 2).clamp(4, 16);
        let sampled = |[x0, x1]: [f64; 2]| -> Vec<(f64, Clipped)> {
            let xs = (0..=SAMPLES).map(|i| x0 + (x1 - x0) * f64::from(i) / f64::from(SAMPLES));
            xs.map(|x| (x, self.clipped(x, &self.region.spans(x), levels))).collect()
        };
        // The ends may lie on the outline, or just outside.
        let inside: Vec<f64> = sampled(part.xs).into_iter().filter(|s| s.1.is_some()).map(|s| s.0).collect();
        let [x0, x1] = [*inside.first()?, *inside.last()?];
        let mut columns: Vec<Clipped> = sampled([x0, x1]).into_iter().map(|s| s.1).collect();
        for i in 1..columns.len() {
            columns[i] = columns[i].or(columns[i - 1]);
        }
        let least = columns.iter().map(height).fold(f64::INFINITY, f64::min);
        let side = |k: usize, sign: f64, cells: usize| {
            let ys: Vec<f64> = columns.iter().map(|c| sign * c.map_or(0.0, |c| c[k])).collect();
            spline_above(&ys, cells).map(|v| v.into_iter().map(|y| sign * y).collect::<Vec<f64>>())
        };
        // Steep outlines need more cells.
        let (cells, top, bottom) = [1, 2, 4, 8].into_iter().find_map(|k| {
            let ([top, y0], [bottom, y1]) = (side(0, 1.0, k * cells), side(1, -1.0, k * cells));
            let is_high = y0.iter().zip(&y1).all(|(a, b)| b - a >= MIN_SHARE * least);
            is_high.then_some((k * cells, top, bottom))
        })?;
        let mut lattice = Lattice::regular(from, [3, 1], [cells, 1]);
        for (i, s) in bspline::regular(3, cells).iter().enumerate() {
            let x = x0 + s * (x1 - x0);
            lattice.place(i, 0, Point::new(x, top[i]));
            lattice.place(i, 1, Point::new(x, bottom[i]));
        }
        Some(Arc::new(LatticeMap::new(&lattice, true)))
    }
}

/// Returns the largest widening of this many letters, spaces included.
fn max_widening(letters: usize) -> f64 {
    if letters > 1 { MAX_WIDENING * MAX_SPACING } else { MAX_WIDENING }
}

/// Returns the control points of a smooth spline closely above equidistant samples (of greater or equal values), and its values at them.
/// Every round raises or lowers a control point by the largest residual near it.
fn spline_above(ys: &[f64], cells: usize) -> [Vec<f64>; 2] {
    const ROUNDS: usize = 6;
    let last = (ys.len() - 1) as f64;
    // The parameters of the control points, from 0 to 1.
    let parameters = bspline::regular(3, cells);
    let pieces = bspline::extraction(3, cells);
    let bases: Vec<(usize, Vec<f64>)> = (0..ys.len()).map(|i| bspline::basis_on(&pieces, i as f64 / last)).collect();
    let max_near = |v: &[f64], s: f64| {
        let half_cell = 0.5 / cells as f64;
        let (a, b) = ((s - half_cell).max(0.0) * last, (s + half_cell).min(1.0) * last);
        v[a.ceil() as usize..=b.floor() as usize].iter().copied().fold(f64::NEG_INFINITY, f64::max)
    };
    let values = |points: &[f64]| -> Vec<f64> {
        bases.iter().map(|(first, b)| b.iter().zip(&points[*first..]).map(|(b, p)| b * p).sum()).collect()
    };
    let residuals = |points: &[f64]| -> Vec<f64> { values(points).iter().zip(ys).map(|(v, y)| y - v).collect() };
    let mut points: Vec<f64> = parameters.iter().map(|s| max_near(ys, *s)).collect();
    for _ in 0..ROUNDS {
        let residuals = residuals(&points);
        points.iter_mut().zip(&parameters).for_each(|(p, s)| *p += max_near(&residuals, *s));
    }
    // Raising all control points raises the spline by the same amount.
    let lift = residuals(&points).into_iter().fold(0.0, f64::max);
    points.iter_mut().for_each(|p| *p += lift);
    let values = values(&points);
    [points, values]
}

impl Line {
    /// Returns the box of some letters, as high as the line.
    fn part(&self, letters: &Range<usize>) -> Rect {
        let boxes = self.letters[letters.clone()].iter().map(|l| l.1);
        let b = boxes.reduce(|a, b| a.union(b)).unwrap_or(self.rect);
        Rect::new(b.x0, self.rect.y0, b.x1, self.rect.y1)
    }

    /// Returns `true` if a point is in the box of a letter.
    fn holds(&self, p: Point) -> bool {
        self.rect.contains(p) && self.letters.iter().any(|l| l.1.contains(p))
    }

    /// Returns `true` if a word begins with letter `k`.
    fn is_space(&self, k: usize) -> bool {
        self.letters[k].1.x0 - self.letters[k - 1].1.x1 > WORD_SPACE * self.rect.height()
    }

    /// Returns letters before which the line may be divided, so that both runs are filled about equally: three neighbours, which leave two
    /// letters or more on either side, and the next beginning of a word.
    fn divisions(&self, pair: &[Range<usize>; 2]) -> impl Iterator<Item = usize> {
        let [a, b] = [0, 1].map(|k| pair[k].len() as f64);
        let x = self.rect.x0 + self.rect.width() * a / (a + b);
        let nearest = self.letters.partition_point(|l| l.1.center().x < x);
        let word = (1..self.letters.len()).filter(|k| self.is_space(*k)).min_by_key(|k| k.abs_diff(nearest));
        let count = self.letters.len().max(1);
        (nearest.saturating_sub(1)..nearest + 2).filter(move |k| (2..count - 1).contains(k)).chain(word)
    }

    /// Returns the error for line `number`, counted from 1.
    fn no_room(&self, number: usize) -> Error {
        let problem = format!(
            "has no room in the shape: line {number} would be too low or too narrow; take fewer lines, words of other lengths, a shape with \
another ratio of width to height, or `together`, one map for all lines"
        );
        Error::advised("lines", self.name.clone(), problem, "")
    }
}

/// Strips of the source plane from which lines are taken. They do not overlap, so letters may be moved before the map.
pub(super) struct Strips {
    /// The tops and bottoms of the strips.
    ys: Vec<[f64; 2]>,
    /// The ordinates between the strips.
    pub(super) cuts: Vec<f64>,
    /// The map of each letter that precedes the deformation.
    letter_maps: Vec<Affine>,
}

impl Strips {
    /// Creates the strips of lines with `count` letters in all.
    pub(super) fn new(lines: &[Line], count: usize) -> Self {
        let mut out = Self { ys: Vec::new(), cuts: cuts(lines), letter_maps: vec![Affine::IDENTITY; count] };
        for (i, line) in lines.iter().enumerate() {
            let r = line.rect;
            let from = i.checked_sub(1).map_or(r.y0, |k| out.cuts[k].max(r.y0));
            let to = out.cuts.get(i).map_or(r.y1, |c| c.min(r.y1));
            let scale = (to - from) / r.height();
            let map = Affine::new([1.0, 0.0, 0.0, scale, 0.0, from - scale * r.y0]);
            if map != Affine::IDENTITY {
                line.letters.iter().for_each(|l| out.letter_maps[l.0] = map);
            }
            out.ys.push([from, to]);
        }
        out
    }

    /// Spaces letters of a line that are to be widened by more than letters themselves may be, moves them to the right of `end`, and
    /// returns their box.
    fn space_letters(&mut self, line: &Line, letters: &Range<usize>, widening: f64, end: f64) -> Rect {
        /// Distance from `end` of letters that are moved, as a share of the line's width.
        const GAP: f64 = 1e-3;
        let r = if letters.len() == line.letters.len() { line.rect } else { line.part(letters) };
        let space = r.width() * ((widening / MAX_WIDENING).max(1.0) - 1.0);
        let each = space / (letters.len().max(2) - 1) as f64;
        let shift = (end + GAP * line.rect.width() - r.x0).max(0.0);
        for (k, (letter, _)) in line.letters[letters.clone()].iter().enumerate() {
            let map = &mut self.letter_maps[*letter];
            *map = Affine::translate((shift + k as f64 * each, 0.0)) * *map;
        }
        Rect::new(r.x0 + shift, r.y0, r.x1 + shift + space, r.y1)
    }

    /// Returns the maps of all letters before the deformation; empty if none of them moves.
    pub(super) fn letter_maps(&self) -> Vec<Vec<Affine>> {
        if self.letter_maps.iter().all(|m| *m == Affine::IDENTITY) {
            return Vec::new();
        }
        self.letter_maps.iter().map(|m| vec![*m]).collect()
    }

    /// Returns, for each line, the box whose map onto a block of this width and height puts the line into its row. `None` if the lines
    /// would fill too little of the block.
    pub(super) fn frames(&mut self, lines: &[Line], [width, height]: [f64; 2]) -> Option<Vec<Rect>> {
        /// Least height of a row, as a share of the highest.
        const LOWEST: f64 = 0.5;
        let gap = GAP * height / lines.len() as f64;
        let sum_of_heights = height - gap * (lines.len() - 1) as f64;
        // A compromise between equal heights, and the heights that give letters the same widening.
        let natural: Vec<f64> = lines.iter().map(|l| l.rect.height() / l.rect.width()).collect();
        let most = natural.iter().copied().fold(0.0, f64::max);
        let rows: Vec<f64> = natural.iter().map(|h| (h / most).sqrt().max(LOWEST)).collect();
        let sum: f64 = rows.iter().sum();
        let (mut top, mut filled) = (0.0, 0.0);
        let mut frames = Vec::new();
        for (i, (line, row)) in lines.iter().zip(rows).enumerate() {
            let row = row / sum * sum_of_heights;
            let [from, to] = self.ys[i];
            let scale = (to - from) / row;
            let n = line.letters.len();
            let widening = (width / row * natural[i]).min(max_widening(n));
            let r = self.space_letters(line, &(0..n), widening, f64::NEG_INFINITY);
            let filled_width = widening * row / natural[i];
            let r = r.inflate(0.5 * (width / filled_width - 1.0) * r.width(), 0.0);
            let y0 = from - scale * top;
            frames.push(Rect::new(r.x0, y0, r.x1, y0 + scale * height));
            top += row + gap;
            filled += filled_width * row;
        }
        (filled >= MIN_FILL * width * height).then_some(frames)
    }
}

/// Fits lines into a region. Returns the map and notes.
pub(super) fn fit_lines(
    lines: &[Line],
    region: &Region,
    strips: &mut Strips,
) -> Result<(Arc<dyn Map>, Vec<String>), Error> {
    let no_room = |k: usize| lines[k].no_room(k + 1);
    let shape = ColumnedShape::new(region, lines.len()).ok_or_else(|| no_room(0))?;
    let bands = shape.plan(lines)?;
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    for (i, (line, band)) in lines.iter().zip(&bands).enumerate() {
        let [from, to] = strips.ys[i];
        let mut row = TileRow { cuts: Vec::new(), maps: Vec::new() };
        let mut end = f64::NEG_INFINITY;
        for part in &band.parts {
            let r = strips.space_letters(line, &part.letters, part.widening, end);
            if end.is_finite() {
                row.cuts.push(0.5 * (end + r.x0));
            }
            end = r.x1;
            let source = Rect::new(r.x0, from, r.x1, to);
            row.maps.push(shape.map(part, band.levels, source).ok_or_else(|| no_room(i))?);
        }
        rows.push(row);
        let xs: Vec<String> = band.parts.iter().map(|p| format!("{:.6} to {:.6}", p.xs[0], p.xs[1])).collect();
        notes.push(format!("line {}, {}: from x = {}", i + 1, line.name, xs.join(" and from ")));
    }
    let whole = lines.iter().map(|l| l.rect).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    let map = Tiled::over(whole, strips.cuts.clone(), rows).ok_or_else(|| no_room(0))?;
    Ok((map, notes))
}
