//! Lines of lettering in a closed shape: each as wide as the shape at its height, only its tops and bottoms bent.
//!
//! > (x, v) ↦ (X(x), t(X) + v·(b(X) − t(X))), X linear in each line, or in the parts of a line that parts around a notch
//!
//! The boundaries between lines are parabolas that lead from the top of the shape over to its bottom. A band between two of them, clipped by
//! the outline, ends where it is too low for letters. Of all heights of the boundaries, those are taken that fill the shape best with
//! letters that are widened evenly. t and b are splines within the band, so no letter has a corner of the outline in it.

use super::columns::Region;
use crate::error::Error;
use crate::map::{Lattice, LatticeMap, Map, TileRow, Tiled, bspline};
use crate::param::Letter;
use kurbo::{Affine, Point, Rect};
use std::ops::Range;
use std::sync::Arc;

/// A line of the artwork.
pub(super) struct Line {
    /// Its letters, for messages.
    name: String,
    /// The box of its letters, and of what else lies between its neighbours.
    rect: Rect,
    /// Indices of its letters, from left to right, and their boxes.
    letters: Vec<(usize, Rect)>,
}

/// Divides letters into lines by their baselines, downwards.
pub(super) fn lines(letters: &[Letter], ink: &[Point]) -> Vec<Line> {
    /// Baselines that differ by less than this share of the letters' height are one.
    const SAME: f64 = 0.3;
    /// Lines lower than this share of the highest, such as a dash, keep room above and below.
    const LOW: f64 = 0.4;
    let boxes = letters.iter().enumerate().filter_map(|(i, l)| Some((l.origin.y, i, l.outline.bounding_box()?)));
    let mut all: Vec<(f64, usize, Rect)> = boxes.filter(|l| l.2.area() > 0.0).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut out: Vec<(f64, Line)> = Vec::new();
    for (y, i, b) in all {
        match out.last_mut() {
            Some((first, line)) if y - *first <= SAME * line.rect.height() => {
                line.rect = line.rect.union(b);
                line.letters.push((i, b));
            }
            _ => out.push((y, Line { name: String::new(), rect: b, letters: vec![(i, b)] })),
        }
    }
    let mut out: Vec<Line> = out.into_iter().map(|l| l.1).collect();
    let cuts = cuts(&out);
    let most = out.iter().map(|l| l.rect.height()).fold(0.0, f64::max);
    for line in &mut out {
        line.letters.sort_by(|a, b| a.1.x0.total_cmp(&b.1.x0));
        line.name = line.letters.iter().map(|l| letters[l.0].name.as_str()).collect();
        line.rect = line.rect.inflate(0.0, (0.5 * (LOW * most - line.rect.height())).max(0.0));
    }
    for p in ink {
        let line = cuts.partition_point(|c| *c < p.y);
        if line < out.len() && !out.iter().any(|l| l.holds(*p)) {
            out[line].rect = out[line].rect.union_pt(*p);
        }
    }
    out
}

/// The ordinates between lines.
fn cuts(lines: &[Line]) -> Vec<f64> {
    let mut cuts: Vec<f64> = lines.windows(2).map(|w| 0.5 * (w[0].rect.y1 + w[1].rect.y0)).collect();
    for k in 1..cuts.len() {
        cuts[k] = cuts[k].max(cuts[k - 1]);
    }
    cuts
}

/// Part of a line: some of its letters, and the range of x that they fill.
#[derive(Clone)]
struct Part {
    letters: Range<usize>,
    xs: [f64; 2],
    /// How much wider the letters are drawn than in the artwork, in relation to their height, space between them included.
    ratio: f64,
}

/// A line in its band.
#[derive(Clone)]
struct Band {
    /// The levels of its boundaries; `None` where the outline is the boundary.
    levels: [Option<f64>; 2],
    parts: Vec<Part>,
}

/// Where letters may stand in a band: runs, and pairs of them for a line that parts.
struct Runs {
    whole: Vec<Run>,
    pairs: Vec<[Run; 2]>,
}

/// How a curve of the shape runs: its mean height, its slope and its bend.
#[derive(Clone, Copy, Default)]
struct Trend {
    mean: f64,
    slope: f64,
    bend: f64,
}

/// A shape in columns of equal width.
struct Room<'a> {
    region: &'a Region,
    bounds: Rect,
    /// The middle of a column, and its intervals inside the shape, each from its top downwards.
    columns: Vec<Column>,
    area: f64,
    /// The share of a line.
    share: f64,
    /// The distance between lines.
    gap: f64,
    /// The middle and the spread of the shape along x.
    middle: f64,
    spread: f64,
    trends: [Trend; 2],
}

/// The x of a column, and its intervals inside the shape.
type Column = (f64, Vec<[f64; 2]>);

/// The clipped interval of a column.
type Cut = Option<[f64; 2]>;

fn height(c: &Cut) -> f64 {
    c.map_or(0.0, |c| c[1] - c[0])
}

/// The columns of a band, and sums over all before each: of the heights, and of what letters on them are worth.
struct Cuts {
    all: Vec<Cut>,
    sums: [Vec<f64>; 2],
    most: f64,
    /// The mean number of a column.
    middle: f64,
}

/// Columns that follow one another: their numbers, what a notch takes from their heights, and the greatest of these.
#[derive(Clone)]
struct Run {
    columns: Range<usize>,
    dips: f64,
    most: f64,
}

impl Cuts {
    /// `step` is the width of a column.
    fn new(all: Vec<Cut>, step: f64) -> Self {
        /// Slopes are measured over so many columns to both sides.
        const REACH: usize = 3;
        let (mut sums, mut middle) = ([vec![0.0], vec![0.0]], 0.0);
        for (i, c) in all.iter().enumerate() {
            let (a, b) = (i.saturating_sub(REACH), (i + REACH).min(all.len() - 1));
            let (a, b) = (if all[a].is_some() { a } else { i }, if all[b].is_some() { b } else { i });
            let rise = all[a].zip(all[b]).map_or(0.0, |(p, q)| (q[0] - p[0]).abs().max((q[1] - p[1]).abs()));
            let worth = (1.0 - (rise / (step * (b - a).max(1) as f64) / STEEP).powi(2)).max(-3.0);
            middle += i as f64 * height(c);
            for (sums, v) in sums.iter_mut().zip([height(c), worth * height(c)]) {
                sums.push(sums[i] + v);
            }
        }
        let most = all.iter().map(height).fold(0.0, f64::max);
        middle /= sums[0][all.len()];
        Self { all, sums, most, middle }
    }

    fn mean(&self, r: &Range<usize>, of: usize) -> f64 {
        (self.sums[of][r.end] - self.sums[of][r.start]) / r.len() as f64
    }

    /// The heights of a run, and for each the lower of the greatest on its left and on its right.
    fn filled(&self, r: &Range<usize>) -> (Vec<f64>, Vec<f64>) {
        let heights: Vec<f64> = self.all[r.clone()].iter().map(height).collect();
        let rising = |most: &mut f64, h: &f64| {
            *most = most.max(*h);
            Some(*most)
        };
        let right: Vec<f64> = heights.iter().rev().scan(0.0, rising).collect();
        let filled = heights.iter().scan(0.0, rising).zip(right.iter().rev()).map(|(l, r)| l.min(*r)).collect();
        (heights, filled)
    }

    fn run(&self, columns: Range<usize>) -> Run {
        let (heights, filled) = self.filled(&columns);
        let dips = filled.iter().zip(&heights).map(|(f, h)| f - h).sum();
        Run { dips, most: filled.iter().copied().fold(0.0, f64::max), columns }
    }

    /// Runs that are high enough for letters.
    fn runs(&self, ends: f64, tallest: f64) -> Vec<Run> {
        let least = (ends * self.most).max(LEAST * tallest);
        let mut out: Vec<Range<usize>> = Vec::new();
        for (i, c) in self.all.iter().enumerate().filter(|c| height(c.1) >= least) {
            let on = |a: &Cut, b: &Cut| a.zip(*b).is_some_and(|(a, b)| a[1].min(b[1]) > a[0].max(b[0]));
            match out.last_mut() {
                Some(run) if run.end == i && on(&self.all[i - 1], c) => run.end = i + 1,
                _ => out.push(i..i + 1),
            }
        }
        out.into_iter().flat_map(|r| self.without_waist(r)).map(|r| self.run(r)).collect()
    }

    /// Divides a run at a waist.
    fn without_waist(&self, r: Range<usize>) -> Vec<Range<usize>> {
        const WAIST: f64 = 0.65;
        let (heights, filled) = self.filled(&r);
        let narrow = |i: usize| heights[i] / filled[i];
        let waist = (1..r.len()).min_by(|a, b| narrow(*a).total_cmp(&narrow(*b))).filter(|i| narrow(*i) < WAIST);
        waist.map_or_else(|| vec![r.clone()], |i| vec![r.start..r.start + i, r.start + i..r.end])
    }

    /// Two runs at both sides of a notch, without what is too low beside it.
    fn inner(&self, pair: &[Run]) -> [Run; 2] {
        let [a, b] = [0, 1].map(|k| (pair[k].columns.clone(), INNER * pair[k].most));
        let end = a.0.clone().rev().find(|i| height(&self.all[*i]) >= a.1).map_or(a.0.end, |i| i + 1);
        let start = b.0.clone().find(|i| height(&self.all[*i]) >= b.1).unwrap_or(b.0.start);
        [self.run(a.0.start..end), self.run(start..b.0.end)]
    }
}

/// What a plan is measured by.
#[derive(Clone, Copy)]
struct Aim {
    /// Letters are no taller than this.
    tallest: f64,
    /// The logarithm of how much wider letters are drawn than in the artwork, in relation to their height.
    width: f64,
}

const COLUMNS: u32 = 200;
/// Heights at which boundaries are tried.
const LEVELS: usize = 24;
/// Greatest heights of letters that are tried, by the mean height of a line, and widenings.
const TALLEST: [f64; 5] = [0.85, 1.1, 1.4, 1.85, 2.4];
const WIDTHS: [f64; 4] = [0.4, 0.65, 1.0, 1.6];
/// The space between lines, as a share of their mean height.
const GAP: f64 = 0.12;
/// A line ends where its band is lower than one of these shares of its greatest height,
const ENDS: [f64; 2] = [0.5, 0.7];
/// or of the greatest height of a letter.
const LEAST: f64 = 0.42;
/// Beside a notch at which a line parts, letters have at least this share of the greatest height.
const INNER: f64 = 0.75;
/// How far boundaries follow the bend of the outline.
const BEND: f64 = 0.5;
/// Letters are widened by no more than this. Further widening is space between them, by no more than this.
const WIDEST: f64 = 1.8;
const SPACED: f64 = 1.35;
/// Lines are widened by no more than this in relation to the mean.
const WIDER: f64 = 1.6;
/// Letters are narrowed to no less than this, and by no more than this in relation to the mean.
const NARROWEST: f64 = 0.3;
const NARROWER: f64 = 2.0;

impl<'a> Room<'a> {
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
        let spread = mean(&|c| (c.0 - middle).powi(2));
        let trend = |end: fn(&[[f64; 2]]) -> f64| {
            let y = |c: &Column| if c.1.is_empty() { 0.0 } else { end(&c.1) };
            let m = mean(&y);
            let (u, q) = (|c: &(f64, _)| c.0 - middle, |c: &(f64, _)| (c.0 - middle).powi(2) - spread);
            let slope = mean(&|c| u(c) * (y(c) - m)) / spread;
            let rest = |c: &Column| y(c) - m - slope * u(c);
            let bend = mean(&|c| q(c) * rest(c)) / mean(&|c| q(c).powi(2));
            // Trends count as far as they explain the curve.
            let share =
                1.0 - mean(&|c| (rest(c) - bend * q(c)).powi(2)) / mean(&|c| (y(c) - m).powi(2)).max(1e-12 * spread);
            let share = share.clamp(0.0, 1.0);
            Trend { mean: m, slope: slope * share, bend: share * bend }
        };
        let mut trends = [trend(|s| s[0][0]), trend(|s| s[s.len() - 1][1])];
        // What both sides have in common is followed in full.
        let [a, b] = trends.map(|t| t.bend);
        let common = if a * b > 0.0 { a.abs().min(b.abs()) * a.signum() } else { 0.0 };
        trends.iter_mut().for_each(|t| t.bend = common + BEND * (t.bend - common));
        let area = total * step;
        let share = 1.0 / lines as f64;
        let gap = GAP * share * area / bounds.width();
        Some(Self { region, bounds, columns, area, share, gap, middle, spread, trends })
    }

    /// The height at `x` of the boundary with this mean height.
    fn boundary(&self, level: f64, x: f64) -> f64 {
        let [top, bottom] = self.trends;
        let t = ((level - top.mean) / (bottom.mean - top.mean)).clamp(0.0, 1.0);
        let u = x - self.middle;
        let between = |a: f64, b: f64| a + t * (b - a);
        level + between(top.slope, bottom.slope) * u + between(top.bend, bottom.bend) * (u * u - self.spread)
    }

    /// The highest interval of a column between two boundaries.
    fn cut(&self, x: f64, spans: &[[f64; 2]], levels: [Option<f64>; 2]) -> Cut {
        let above = levels[0].map_or(f64::NEG_INFINITY, |l| self.boundary(l, x) + 0.5 * self.gap);
        let below = levels[1].map_or(f64::INFINITY, |l| self.boundary(l, x) - 0.5 * self.gap);
        let cut = spans.iter().map(|s| [s[0].max(above), s[1].min(below)]).filter(|c| c[1] > c[0]);
        cut.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))
    }

    fn cuts(&self, levels: [Option<f64>; 2]) -> Cuts {
        let all = self.columns.iter().map(|(x, spans)| self.cut(*x, spans, levels)).collect();
        Cuts::new(all, self.bounds.width() / f64::from(COLUMNS))
    }

    /// Puts letters into a run of columns, and says what they are worth there.
    fn put(&self, cuts: &Cuts, run: &Run, (line, letters): (&Line, Range<usize>), aim: &Aim) -> Option<(f64, Part)> {
        let step = self.bounds.width() / f64::from(COLUMNS);
        let shape = line.part(&letters).width() / line.rect.height();
        let most = widest(letters.len()).min(WIDER * aim.width.exp());
        let widest = |r: &Range<usize>| most * shape * cuts.mean(r, 0);
        let most = widest(&run.columns);
        let run = if most < run.columns.len() as f64 * step {
            // Where it is high, and near the middle.
            let (r, n) = (&run.columns, (most / step).round().max(1.0));
            let off = |from: usize| (from as f64 + 0.5 * n - cuts.middle).abs() / r.len() as f64;
            let columns = |from: usize| from..from + n as usize;
            let value = |from: usize| cuts.mean(&columns(from), 0) * (1.0 - ASIDE * off(from));
            let best = (r.start..=r.end - n as usize).max_by(|a, b| value(*a).total_cmp(&value(*b)))?;
            &cuts.run(columns(best))
        } else {
            run
        };
        let (r, tall) = (&run.columns, cuts.mean(&run.columns, 0));
        let width = widest(r).min(r.len() as f64 * step);
        let ratio = width / tall / shape;
        if ratio < NARROWEST.max(aim.width.exp() / NARROWER) || run.most > aim.tallest {
            return None;
        }
        let middle = self.columns[r.start].0 + 0.5 * (r.len() - 1) as f64 * step;
        let (uneven, low) = ((ratio.ln() - aim.width).powi(2), (1.0 - tall / aim.tallest).powi(2));
        let worth = (width * cuts.mean(r, 1) - DIP * step * run.dips) / self.area;
        let share = letters.len() as f64 / line.letters.len() as f64;
        let worth = worth - share * (EVEN * uneven + LOW * low) * self.share;
        Some((worth, Part { letters, xs: [middle - 0.5 * width, middle + 0.5 * width], ratio }))
    }

    /// The best way to put a line into runs of a band: as a whole, or parted.
    fn band(&self, line: &Line, (cuts, runs): (&Cuts, &Runs), aim: &Aim) -> Option<(f64, Vec<Part>)> {
        let n = line.letters.len();
        let middle = self.columns[0].0 + cuts.middle * self.bounds.width() / f64::from(COLUMNS);
        let aside = |a: f64, b: f64| BESIDE * ((0.5 * (a + b) - middle) / self.bounds.width()).powi(2);
        let whole = runs.whole.iter().filter_map(|run| {
            let (worth, part) = self.put(cuts, run, (line, 0..n), aim)?;
            Some((worth - aside(part.xs[0], part.xs[1]), vec![part]))
        });
        let parted = runs.pairs.iter().flat_map(|pair| line.divisions(pair).map(move |k| (pair, k)));
        let parted = parted.filter_map(|(pair, k)| {
            let (worth, a) = self.put(cuts, &pair[0], (line, 0..k), aim)?;
            let (more, b) = self.put(cuts, &pair[1], (line, k..n), aim)?;
            let scale = |part: &Part| (part.xs[1] - part.xs[0]) / line.part(&part.letters).width();
            let ([x0, x1], [x2, x3]) = (a.xs, b.xs);
            let (apart, most) = ((x2 - x1) / (x3 - x0), if line.is_space(k) { 0.4 } else { 0.22 });
            let cost = APART * apart / most + UNLIKE * (scale(&a) / scale(&b)).ln().powi(2) + aside(x0, x3);
            (apart <= most).then(|| (worth + more - cost, vec![a, b]))
        });
        whole.chain(parted).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The best bands for all lines, or the number of the first line without room.
    fn plan(&self, lines: &[Line]) -> Result<Vec<Band>, usize> {
        let mean = self.share * self.area / self.bounds.width();
        let at =
            |k: usize| (k > 0 && k < LEVELS).then(|| self.bounds.y0 + self.bounds.height() * k as f64 / LEVELS as f64);
        let pairs = (0..LEVELS).flat_map(|a| (a + 1..=LEVELS).map(move |b| [a, b]));
        let all: Vec<([usize; 2], Cuts)> = pairs.map(|p| (p, self.cuts(p.map(at)))).collect();
        let mut best: Option<(f64, Vec<Band>)> = None;
        let mut reached = 0;
        for tallest in TALLEST.map(|k| k * mean) {
            let high = all.iter().filter(|c| (LEAST * tallest..=tallest).contains(&c.1.most));
            let runs = |cuts: &Cuts| {
                let whole: Vec<Vec<Run>> = ENDS.iter().map(|e| cuts.runs(*e, tallest)).collect();
                let pairs = whole.iter().flat_map(|r| r.windows(2)).map(|p| cuts.inner(p)).collect();
                Runs { whole: whole.concat(), pairs }
            };
            let high: Vec<_> = high.map(|(p, cuts)| (p, (cuts, runs(cuts)))).collect();
            for width in WIDTHS.map(f64::ln) {
                let aim = Aim { tallest, width };
                // For every level, the best bands of the lines so far above it.
                let mut above = vec![Some((-NATURAL * width * width, Vec::new())); LEVELS + 1];
                for (i, line) in lines.iter().enumerate() {
                    let mut next: Vec<Option<(f64, Vec<Band>)>> = vec![None; LEVELS + 1];
                    for ([a, b], (cuts, runs)) in &high {
                        let Some((score, bands)) = &above[*a] else { continue };
                        let Some((more, parts)) = self.band(line, (cuts, runs), &aim) else { continue };
                        if next[*b].as_ref().is_none_or(|o| o.0 < score + more) {
                            let band = Band { levels: [at(*a), at(*b)], parts };
                            next[*b] = Some((score + more, [&bands[..], &[band]].concat()));
                        }
                    }
                    above = next;
                    if above.iter().any(Option::is_some) {
                        reached = reached.max(i + 1);
                    }
                }
                for found in above.into_iter().flatten() {
                    if best.as_ref().is_none_or(|b| b.0 < found.0) {
                        best = Some(found);
                    }
                }
            }
        }
        best.map(|b| b.1).ok_or(reached)
    }

    /// The map of a part of a line, from a box of the artwork.
    fn map(&self, part: &Part, levels: [Option<f64>; 2], from: Rect) -> Option<Arc<dyn Map>> {
        const SAMPLES: u32 = 240;
        /// The share of the least height that smooth curves may take.
        const LIFTED: f64 = 0.2;
        let cells = (3 * part.letters.len() / 2).clamp(4, 16);
        let sampled = |[x0, x1]: [f64; 2]| -> Vec<(f64, Cut)> {
            let xs = (0..=SAMPLES).map(|i| x0 + (x1 - x0) * f64::from(i) / f64::from(SAMPLES));
            xs.map(|x| (x, self.cut(x, &self.region.spans(x), levels))).collect()
        };
        // The ends may lie on the outline, or just outside.
        let inside: Vec<f64> = sampled(part.xs).into_iter().filter(|s| s.1.is_some()).map(|s| s.0).collect();
        let [x0, x1] = [*inside.first()?, *inside.last()?];
        let mut cuts: Vec<Cut> = sampled([x0, x1]).into_iter().map(|s| s.1).collect();
        for i in 1..cuts.len() {
            cuts[i] = cuts[i].or(cuts[i - 1]);
        }
        let lowest = cuts.iter().map(height).fold(f64::INFINITY, f64::min);
        let side = |k: usize, sign: f64, cells: usize| {
            let ys: Vec<f64> = cuts.iter().map(|c| sign * c.map_or(0.0, |c| c[k])).collect();
            let (points, lift) = above(&ys, cells);
            (points.into_iter().map(|y| sign * y).collect::<Vec<f64>>(), lift)
        };
        // Steep outlines need more cells.
        let (cells, top, bottom) = [1, 2, 4].into_iter().find_map(|k| {
            let ((top, a), (bottom, b)) = (side(0, 1.0, k * cells), side(1, -1.0, k * cells));
            let is_close = a + b < LIFTED * lowest && top.iter().zip(&bottom).all(|(t, b)| t < b);
            is_close.then_some((k * cells, top, bottom))
        })?;
        let mut lattice = Lattice::regular(from, [3, 1], [cells, 1]);
        let places = bspline::regular(3, cells);
        for (i, s) in places.iter().enumerate() {
            let x = x0 + s * (x1 - x0);
            lattice.place(i, 0, Point::new(x, top[i]));
            lattice.place(i, 1, Point::new(x, bottom[i]));
        }
        Some(Arc::new(LatticeMap::new(&lattice, true)))
    }
}

/// Tops and bottoms of letters with this slope are worth nothing.
const STEEP: f64 = 1.7;
/// How often the area of a notch counts that letters follow.
const DIP: f64 = 7.0;
/// Costs, as shares of the shape's area: of letters that are widened unevenly, or unlike those of the artwork; of a line away from the
/// middle of its band; of parts whose letters are unlike.
const EVEN: f64 = 0.35;
const NATURAL: f64 = 0.03;
const BESIDE: f64 = 2.0;
const UNLIKE: f64 = 0.4;
/// Of letters lower than the tallest, and of a gap in a line.
const LOW: f64 = 0.6;
const APART: f64 = 0.07;
/// What a line loses that is as far from the middle of its band as it may be.
const ASIDE: f64 = 0.3;
/// Gaps of more than this share of the height are word spaces.
const WORD: f64 = 0.2;

/// The most that letters are widened, with the space between them.
fn widest(letters: usize) -> f64 {
    if letters > 1 { WIDEST * SPACED } else { WIDEST }
}

/// The control points of a smooth spline above samples at equal distances, close to them, and by how much all had to be lifted.
fn above(ys: &[f64], cells: usize) -> (Vec<f64>, f64) {
    const ROUNDS: usize = 6;
    let last = (ys.len() - 1) as f64;
    let places = bspline::regular(3, cells);
    let pieces = bspline::extraction(3, cells);
    let bases: Vec<(usize, Vec<f64>)> = (0..ys.len()).map(|i| bspline::basis_on(&pieces, i as f64 / last)).collect();
    let near = |s: f64| {
        let reach = 0.5 / cells as f64;
        let (a, b) = ((s - reach).max(0.0) * last, (s + reach).min(1.0) * last);
        a.ceil() as usize..=b.floor() as usize
    };
    let most = |v: &[f64], s: f64| v[near(s)].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut points: Vec<f64> = places.iter().map(|s| most(ys, *s)).collect();
    let short = |points: &[f64]| -> Vec<f64> {
        let value = |(first, b): &(usize, Vec<f64>)| b.iter().zip(&points[*first..]).map(|(b, p)| b * p).sum::<f64>();
        bases.iter().zip(ys).map(|(b, y)| y - value(b)).collect()
    };
    for _ in 0..ROUNDS {
        let short = short(&points);
        for (p, s) in points.iter_mut().zip(&places) {
            *p += most(&short, *s);
        }
    }
    let lift = short(&points).into_iter().fold(0.0, f64::max);
    (points.iter().map(|p| p + lift).collect(), lift)
}

impl Line {
    /// The box of some letters, as high as the line.
    fn part(&self, letters: &Range<usize>) -> Rect {
        let boxes = self.letters[letters.clone()].iter().map(|l| l.1);
        let b = boxes.reduce(|a, b| a.union(b)).unwrap_or(self.rect);
        Rect::new(b.x0, self.rect.y0, b.x1, self.rect.y1)
    }

    /// Whether a point is in the box of a letter.
    fn holds(&self, p: Point) -> bool {
        self.rect.contains(p) && self.letters.iter().any(|l| l.1.contains(p))
    }

    /// Whether a word begins with this letter.
    fn is_space(&self, k: usize) -> bool {
        self.letters[k].1.x0 - self.letters[k - 1].1.x1 > WORD * self.rect.height()
    }

    /// Letters before which the line may part, to fill two runs alike.
    fn divisions(&self, pair: &[Run; 2]) -> impl Iterator<Item = usize> {
        let [a, b] = [0, 1].map(|k| pair[k].columns.len() as f64);
        let x = self.rect.x0 + self.rect.width() * a / (a + b);
        let k = self.letters.partition_point(|l| l.1.center().x < x);
        let word = (1..self.letters.len()).filter(|k| self.is_space(*k)).min_by_key(|w| w.abs_diff(k));
        let last = self.letters.len();
        (k.max(1)..(k + 2).min(last)).chain(k.checked_sub(1)).chain(word).filter(move |k| (1..last).contains(k))
    }

    fn refused(&self, number: usize) -> Error {
        let problem = format!(
            "has no room in the shape: line {number} would be too low, or too narrow; take fewer or shorter lines, another shape, or one \
map for all lines"
        );
        Error::advised("lines", self.name.clone(), problem, "")
    }
}

/// Where lines are taken from in the source plane, so that none overlaps another.
pub(super) struct Strips {
    /// Their tops and bottoms.
    ys: Vec<[f64; 2]>,
    /// The ordinates between them.
    pub(super) cuts: Vec<f64>,
    /// Where each letter is put before the map.
    places: Vec<Affine>,
}

impl Strips {
    /// `count` is the number of letters.
    pub(super) fn new(lines: &[Line], count: usize) -> Self {
        let cuts = cuts(lines);
        let mut out = Self { ys: Vec::new(), cuts, places: vec![Affine::IDENTITY; count] };
        for (i, line) in lines.iter().enumerate() {
            let r = line.rect;
            let from = i.checked_sub(1).map_or(r.y0, |k| out.cuts[k].max(r.y0));
            let to = out.cuts.get(i).map_or(r.y1, |c| c.min(r.y1));
            let scale = (to - from) / r.height();
            let place = Affine::new([1.0, 0.0, 0.0, scale, 0.0, from - scale * r.y0]);
            if place != Affine::IDENTITY {
                line.letters.iter().for_each(|l| out.places[l.0] = place);
            }
            out.ys.push([from, to]);
        }
        out
    }

    /// Spaces letters of a line that are to be widened by `ratio`, moves them to the right of `end`, and returns their box.
    fn spaced(&mut self, line: &Line, letters: &Range<usize>, ratio: f64, end: f64) -> Rect {
        /// What is moved does not touch what it is moved away from.
        const APART: f64 = 1e-3;
        let r = if letters.len() == line.letters.len() { line.rect } else { line.part(letters) };
        let space = r.width() * ((ratio / WIDEST).max(1.0) - 1.0);
        let each = space / (letters.len().max(2) - 1) as f64;
        let shift = (end + APART * line.rect.width() - r.x0).max(0.0);
        for (k, (letter, _)) in line.letters[letters.clone()].iter().enumerate() {
            let place = &mut self.places[*letter];
            *place = Affine::translate((shift + k as f64 * each, 0.0)) * *place;
        }
        Rect::new(r.x0 + shift, r.y0, r.x1 + shift + space, r.y1)
    }

    /// The places of all letters; empty if the map takes them from where they are.
    pub(super) fn places(&self) -> Vec<Vec<Affine>> {
        if self.places.iter().all(|p| *p == Affine::IDENTITY) {
            return Vec::new();
        }
        self.places.iter().map(|p| vec![*p]).collect()
    }

    /// For each line, the box that must be laid onto a block, as wide and high as given, to put the line into a row of its own.
    pub(super) fn frames(&mut self, lines: &[Line], [width, height]: [f64; 2]) -> Vec<Rect> {
        /// Rows are no lower than this share of the highest.
        const LOWEST: f64 = 0.4;
        let gap = GAP * height / lines.len() as f64;
        let room = height - gap * (lines.len() - 1) as f64;
        // As high as the letters would be at an even width.
        let natural: Vec<f64> = lines.iter().map(|l| l.rect.height() / l.rect.width()).collect();
        let most = natural.iter().copied().fold(0.0, f64::max);
        let rows: Vec<f64> = natural.iter().map(|h| h.max(LOWEST * most)).collect();
        let sum: f64 = rows.iter().sum();
        let mut top = 0.0;
        let mut frames = Vec::new();
        for (i, (line, row)) in lines.iter().zip(rows).enumerate() {
            let row = row / sum * room;
            let [from, to] = self.ys[i];
            let scale = (to - from) / row;
            let n = line.letters.len();
            let ratio = (width / row * natural[i]).min(widest(n));
            let r = self.spaced(line, &(0..n), ratio, f64::NEG_INFINITY);
            let wide = ratio * row / natural[i];
            let r = r.inflate(0.5 * (width / wide - 1.0) * r.width(), 0.0);
            let y0 = from - scale * top;
            frames.push(Rect::new(r.x0, y0, r.x1, y0 + scale * height));
            top += row + gap;
        }
        frames
    }
}

/// Fits lines into a region: the map, and notes.
pub(super) fn fitted(
    lines: &[Line],
    region: &Region,
    strips: &mut Strips,
) -> Result<(Arc<dyn Map>, Vec<String>), Error> {
    let refused = |k: usize| lines[k].refused(k + 1);
    let room = Room::new(region, lines.len()).ok_or_else(|| refused(0))?;
    let bands = room.plan(lines).map_err(refused)?;
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    for (i, (line, band)) in lines.iter().zip(&bands).enumerate() {
        let [from, to] = strips.ys[i];
        let mut row = TileRow { cuts: Vec::new(), maps: Vec::new() };
        let mut end = f64::NEG_INFINITY;
        for part in &band.parts {
            let own = strips.spaced(line, &part.letters, part.ratio, end);
            if end.is_finite() {
                row.cuts.push(0.5 * (end + own.x0));
            }
            end = own.x1;
            let own = Rect::new(own.x0, from, own.x1, to);
            row.maps.push(room.map(part, band.levels, own).ok_or_else(|| refused(i))?);
        }
        rows.push(row);
        let xs: Vec<String> = band.parts.iter().map(|p| format!("{:.6} to {:.6}", p.xs[0], p.xs[1])).collect();
        notes.push(format!("line {}, {}: from x = {}", i + 1, line.name, xs.join(" and from ")));
    }
    let whole = lines.iter().map(|l| l.rect).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    let map = Tiled::over(whole, strips.cuts.clone(), rows).ok_or_else(|| refused(0))?;
    Ok((map, notes))
}
