//! Checks a cubic over several segments of a run: its distance from the run, and a proven bound for it.
//!
//! Samples of the run are numbered from its start; `first` is the number of the cubic's first sample, and every segment has a sample at
//! either end. The error is smooth along each segment and may have corners at the joints. So peaks are predicted segment by segment, and
//! the run is sampled more closely where a predicted peak, a wide gap between samples, or a turn at a joint leaves the error in doubt.
//! Where the cubic turns sharply between two samples, it may bulge away from the image, and distances are measured both ways.

use crate::fit::FOOT_ROUNDING;
use crate::limits::{COARSE_CHECK, PEAK_FACTOR, PEAK_NEAR, SHARP_TURN, SHORT_FACTOR, SHORT_PART};
use crate::proof;
use crate::report::Piece;
use crate::run::{RunCubic, SegmentRun};
use crate::sample::{
    IN_ORDER, InOrder, Lane, Lanes, larger, largest, parabola_extreme, parabola_peak, predicted_end_peak,
    predicted_peak, turns_little,
};
use crate::source::{Result, Source};
use kurbo::{CubicBez, Line, ParamCurve, ParamCurveDeriv, ParamCurveNearest, Point, Vec2};

/// Distances and foot points of a cubic's samples, the first of which has index 0.
#[derive(Default)]
pub(crate) struct Distances {
    /// Distances, signed by the side of the cubic.
    pub(crate) errors: Vec<f64>,
    /// Foot points: parameters of the points of the cubic nearest to the samples.
    pub(crate) feet: Vec<f64>,
}

/// A cubic over several segments that has passed its check, with some of its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkedCubic {
    /// Handle lengths.
    pub handles: [f64; 2],
    /// The checked error.
    pub error: f64,
    /// Samples, in batches of eight.
    pub batches: Vec<MarkBatch>,
}

/// Eight samples of a [`MarkedCubic`].
#[derive(Debug, Clone, PartialEq)]
pub struct MarkBatch {
    /// Segment in the run and parameter of each sample.
    pub at: [(usize, f64); 8],
    /// Distances, signed by the side of the cubic.
    pub errors: Lane,
    /// Foot points.
    pub feet: Lane,
    /// Unit tangents of the cubic at the foot points.
    pub tangents: [Vec2; 8],
}

/// A segment's number in the run, and the numbers of two of its samples.
type Gap = (usize, [usize; 2]);

impl Distances {
    /// Distance between the cubic and the run, by the run's samples, and by closer ones where it may exceed `enough` between them.
    /// `None` if samples may miss something: the foot points do not advance along the cubic, or it may turn by more than 60° from one to
    /// the next.
    pub(crate) fn measure(&mut self, run: &SegmentRun<impl Source>, c: &RunCubic, enough: f64) -> Result<Option<f64>> {
        let mut worst = self.at_samples(run, c, enough);
        if worst > enough {
            return Ok(Some(worst));
        }
        if self.feet.windows(2).any(|w| w[1] < w[0] - FOOT_ROUNDING) || !self.advances(run, c) {
            return Ok(None);
        }
        let doubtful = self.doubtful_gaps(run, c, enough);
        if doubtful.len() > 1 {
            let mut lanes =
                doubtful.iter().filter_map(|gap| Some((&run.segments.get(gap.0)?.source, inside(run, *gap))));
            Source::announce(&mut lanes, &mut std::iter::empty());
        }
        for gap in doubtful {
            worst = worst.max(self.error_in_gap(c, run.images(gap.0, &inside(run, gap))?, gap.1));
        }
        for gap in self.bulging_gaps(run, c, enough) {
            if worst <= enough {
                worst = worst.max(self.error_both_ways(run, c, gap)?);
            }
        }
        Ok(Some(worst))
    }

    /// Gaps between neighbouring samples in which the cubic turns so sharply that it may leave the image by more than `enough`. An arc
    /// that turns by θ bulges by θ/8 of its chord.
    fn bulging_gaps(&self, run: &SegmentRun<impl Source>, c: &RunCubic, enough: f64) -> Vec<Gap> {
        let power = c.frame.power(c.a, c.b);
        let first = c.samples[0];
        // Angles between samples are less than 60°; their tangents are upper bounds for them.
        let turn = |feet: [f64; 2]| {
            let [u, v, w] = controls(&power, feet);
            let little = u.dot(v) > 0.0 && v.dot(w) > 0.0;
            if little { u.cross(v).abs() / u.dot(v) + v.cross(w).abs() / v.dot(w) } else { f64::INFINITY }
        };
        let mut out = Vec::new();
        for (i, [from, to]) in parts(run.per_segment, c.samples) {
            if turn([self.feet[from - first], self.feet[to - first]]) <= SHARP_TURN {
                continue;
            }
            for k in from..to {
                let (j, chord) = (k - first, run.length[k + 1] - run.length[k]);
                let turn = turn([self.feet[j], self.feet[j + 1]]);
                let error = self.errors[j].abs().max(self.errors[j + 1].abs());
                if turn > SHARP_TURN && error + 0.125 * chord * turn > enough {
                    out.push((i, [k, k + 1]));
                }
            }
        }
        out
    }

    /// Hausdorff distance between cubic and image in a gap.
    fn error_both_ways(&self, run: &SegmentRun<impl Source>, c: &RunCubic, (i, [a, b]): Gap) -> Result<f64> {
        let g = run.images(i, &inside(run, (i, [a, b])))?;
        let sample = |k: usize| Point::new(run.x[k], run.y[k]);
        let mut image = [sample(a); 10];
        for k in 0..8 {
            image[k + 1] = Point::new(g.x[k], g.y[k]);
        }
        image[9] = sample(b);
        let cubic = c.cubic();
        let feet = spread([self.feet[a - c.samples[0]], self.feet[b - c.samples[0]]]);
        let squared = |q: Point| {
            let sides = image.windows(2).map(|w| Line::new(w[0], w[1]).nearest(q, 0.0).distance_sq);
            sides.fold(f64::INFINITY, f64::min)
        };
        let worst = feet.into_iter().map(|s| squared(cubic.eval(s))).fold(0.0, f64::max).sqrt();
        Ok(worst.max(self.error_in_gap(c, g, [a, b])))
    }

    /// Gaps in which the error may exceed `enough`. Those around a predicted peak span two intervals.
    fn doubtful_gaps(&self, run: &SegmentRun<impl Source>, c: &RunCubic, enough: f64) -> Vec<Gap> {
        let mut out = Vec::new();
        let [first, last] = c.samples;
        let coarse = COARSE_CHECK * (run.length[last] - run.length[first]);
        for (i, [from, to]) in parts(run.per_segment, [first, last]) {
            let far = |k: &usize| run.length[k + 1] - run.length[*k] > coarse;
            out.extend((from..to).filter(far).map(|k| (i, [k, k + 1])));
            let errors = &self.errors[from - first..=to - first];
            let end = errors.len() - 1;
            let factor = if end < SHORT_PART { SHORT_FACTOR } else { PEAK_FACTOR };
            let may_peak = |near: [f64; 3], joint: usize, next: usize| {
                predicted_end_peak(near, factor) > enough
                    || (first < joint && joint < last)
                        && near[0].abs().max(near[1].abs()) + self.parting(run, c, joint, next) > enough
            };
            if may_peak([errors[0], errors[1], errors[2]], from, from + 1) {
                out.push((i, [from, from + 1]));
            }
            for (k, w) in errors.windows(3).enumerate() {
                if predicted_peak([w[0], w[1], w[2]], factor) > enough {
                    out.push((i, [from + k, from + k + 2]));
                }
            }
            if may_peak([errors[end], errors[end - 1], errors[end - 2]], to, to - 1) {
                out.push((i, [to - 1, to]));
            }
        }
        out
    }

    /// Possible rise of the error between the sample at a joint and its neighbour `next` if cubic and image turn by different angles:
    /// a difference of θ moves them apart by θ/8 of the chord. The image's angle is that of the polygon at `next`. Beside a joint, the
    /// errors do not show a turn that begins there.
    fn parting(&self, run: &SegmentRun<impl Source>, c: &RunCubic, joint: usize, next: usize) -> f64 {
        let k = joint.min(next);
        let j = k - c.samples[0];
        let [u, _, v] = controls(&c.frame.power(c.a, c.b), [self.feet[j], self.feet[j + 1]]);
        let chord = |k: usize| Vec2::new(run.x[k + 1] - run.x[k], run.y[k + 1] - run.y[k]);
        let turn = |u: Vec2, v: Vec2| u.cross(v) / u.dot(v);
        let apart = turn(u, v) - turn(chord(next - 1), chord(next));
        0.125 * chord(k).hypot() * apart.abs()
    }

    /// A cubic that has passed its check, with some of its samples. `None` for a line.
    pub(crate) fn marked(&self, run: &SegmentRun<impl Source>, c: &RunCubic, error: f64) -> Option<MarkedCubic> {
        let Piece::Cubic(_) = c.piece() else { return None };
        let [first, last] = c.samples;
        let [c1, c2, c3] = c.frame.power(c.a, c.b);
        let n = run.per_segment;
        // Two samples for each segment, evenly from end to end.
        let count = (last - first).div_ceil(4 * n);
        let batch = |b: usize| {
            let chosen: [usize; 8] = std::array::from_fn(|i| (8 * b + i + 1) * (last - first) / (8 * count + 1));
            let at = chosen.map(|k| ((first + k) / n, ((first + k) % n) as f64 / n as f64));
            let picked = |v: &[f64]| chosen.map(|k| v.get(k).copied().unwrap_or_default());
            let feet = picked(&self.feet);
            let tangents = feet.map(|s| (c1 + (c2 * 2.0 + c3 * (3.0 * s)) * s).normalize());
            MarkBatch { at, errors: picked(&self.errors), feet, tangents }
        };
        // Copies of the cubic are later judged by differences from these samples, so the error must hold between them, too.
        let error = error.max(self.highest_parabola(run, c));
        Some(MarkedCubic { handles: [c.a, c.b], error, batches: (0..count).map(batch).collect() })
    }

    /// Height of the highest parabola through three neighbouring errors in a segment: about the largest error between samples.
    pub(crate) fn highest_parabola(&self, run: &SegmentRun<impl Source>, c: &RunCubic) -> f64 {
        let first = c.samples[0];
        parts(run.per_segment, c.samples)
            .flat_map(|(_, [from, to])| self.errors[from - first..=to - first].windows(3))
            .map(|w| parabola_extreme([w[0], w[1], w[2]]))
            .fold(0.0, larger)
    }

    /// Largest distance of a sample, after measuring all of them. If it exceeds `enough`, only some were measured.
    fn at_samples(&mut self, run: &SegmentRun<impl Source>, c: &RunCubic, enough: f64) -> f64 {
        let [first, last] = c.samples;
        let origin = c.ends[0];
        let scale = 1.0 / (run.length[last] - run.length[first]);
        self.errors.clear();
        self.feet.clear();
        self.errors.push(0.0);
        self.feet.push(0.0);
        let (mut worst, mut knot) = (0.0, 0);
        for start in (first + 1..last).step_by(8) {
            let (mut g, mut s) = (Lanes::default(), [0.0; 8]);
            for i in 0..8 {
                let k = (start + i).min(last - 1);
                (g.x[i], g.y[i]) = (run.x[k] - origin.x, run.y[k] - origin.y);
                s[i] = interpolated(c, (run.length[k] - run.length[first]) * scale, &mut knot);
            }
            let mut squares = c.frame.distances(&g, c.a, c.b, &mut s, 1);
            if largest(&squares) > enough * enough {
                squares = c.frame.distances(&g, c.a, c.b, &mut s, 2);
            }
            worst = larger(worst, largest(&squares));
            if worst > enough * enough {
                break;
            }
            let count = (last - start).min(8);
            self.errors.extend(&c.frame.signed_distances(&g, c.a, c.b, &s, &squares)[..count]);
            self.feet.extend(&s[..count]);
        }
        self.errors.push(0.0);
        self.feet.push(1.0);
        worst.sqrt()
    }

    /// Returns `true` if the cubic turns by less than 60° between neighbouring samples.
    fn advances(&self, run: &SegmentRun<impl Source>, c: &RunCubic) -> bool {
        let power = c.frame.power(c.a, c.b);
        let first = c.samples[0];
        parts(run.per_segment, c.samples).all(|(_, [from, to])| {
            let feet = &self.feet[from - first..=to - first];
            let whole = [feet[0], feet[feet.len() - 1]];
            turns_little_between(&power, whole) || feet.windows(2).all(|w| turns_little_between(&power, [w[0], w[1]]))
        })
    }

    /// Largest distance between two samples, by eight images `g` evenly between them and the parabolas through all ten.
    fn error_in_gap(&self, c: &RunCubic, mut g: Lanes, [a, b]: [usize; 2]) -> f64 {
        let first = c.samples[0];
        for i in 0..8 {
            g.x[i] -= c.ends[0].x;
            g.y[i] -= c.ends[0].y;
        }
        let mut feet = spread([self.feet[a - first], self.feet[b - first]]);
        let squares = c.frame.distances(&g, c.a, c.b, &mut feet, 3);
        let mut errors = [self.errors[a - first].abs(); 10];
        for (error, square) in errors[1..].iter_mut().zip(squares) {
            *error = square.sqrt();
        }
        errors[9] = self.errors[b - first].abs();
        let top = largest(&squares).sqrt();
        let tops = errors.windows(3).filter(|w| w[1] >= PEAK_NEAR * top && w[1] >= w[0] && w[1] >= w[2]);
        tops.map(|w| parabola_peak(w[0], w[1], w[2])).fold(top, f64::max)
    }
}

/// Parameters of a gap's ends in its segment.
fn parameters(run: &SegmentRun<impl Source>, (i, gap): Gap) -> [f64; 2] {
    gap.map(|k| (k - i * run.per_segment) as f64 / run.per_segment as f64)
}

/// Eight parameters evenly inside a gap.
fn inside(run: &SegmentRun<impl Source>, gap: Gap) -> Lane {
    spread(parameters(run, gap))
}

/// Eight parameters evenly between two.
fn spread([a, b]: [f64; 2]) -> Lane {
    std::array::from_fn(|i| a + (b - a) * (i as f64 + 1.0) / 9.0)
}

/// Segments between two samples, each with its first and last sample.
pub(crate) fn parts(per_segment: usize, [first, last]: [usize; 2]) -> impl Iterator<Item = Gap> {
    let n = per_segment;
    (first / n..last.div_ceil(n)).map(move |i| (i, [first.max(i * n), last.min((i + 1) * n)]))
}

/// Piecewise linear interpolation of the known foot points at a share of the length. `knot` is the index of the interval, kept from the
/// share before.
#[inline(always)]
fn interpolated(c: &RunCubic, share: f64, knot: &mut usize) -> f64 {
    let (shares, feet): (&InOrder, &InOrder) = (&c.shares, &c.feet);
    while *knot + 2 < IN_ORDER && shares[*knot + 1] < share {
        *knot += 1;
    }
    let (k, step) = (*knot, shares[*knot + 1] - shares[*knot]);
    if step > 0.0 { feet[k] + (feet[k + 1] - feet[k]) * ((share - shares[k]) / step) } else { feet[k] }
}

/// Returns `true` if the cubic C(s) = ((c₃s + c₂)s + c₁)s turns little between two parameters: if the three control vectors of its
/// derivative are pairwise less than 60° apart. The tangents at both ends alone would miss a hook between them.
fn turns_little_between(c: &[Vec2; 3], between: [f64; 2]) -> bool {
    let [first, middle, last] = controls(c, between);
    turns_little(first, middle) && turns_little(middle, last) && turns_little(first, last)
}

/// Control vectors of the derivative of ((c₃s + c₂)s + c₁)s between two parameters.
#[inline(always)]
fn controls([c1, c2, c3]: &[Vec2; 3], [s, t]: [f64; 2]) -> [Vec2; 3] {
    let control = |u: f64, v: f64| *c1 + *c2 * (u + v) + *c3 * (3.0 * u * v);
    [control(s, s), control(s, t), control(t, t)]
}

/// Proven distance of a cubic from the run; infinite if none can be proven. The cubic is divided at the foot points of the joints.
/// `feet` are the foot points of its samples.
pub(crate) fn proven(run: &SegmentRun<impl Source>, c: &RunCubic, feet: &[f64], tolerance: f64) -> Result<f64> {
    let cubic = c.cubic();
    let [first, last] = c.samples;
    let (mut s, mut worst) = (0.0, 0.0f64);
    for (i, [a, b]) in parts(run.per_segment, c.samples) {
        let Some((segment, form)) = run.segments.get(i).and_then(|r| Some((r, r.form.as_ref()?))) else {
            return Ok(f64::INFINITY);
        };
        let next = if b == last { 1.0 } else { foot_point(&cubic, segment.to.p, feet[b - first]) };
        if next <= s {
            return Ok(f64::INFINITY);
        }
        let part = cubic.subsegment(s..next);
        worst = worst.max(proof::stretch(&segment.source, form, parameters(run, (i, [a, b])), &part, tolerance)?);
        if worst > tolerance {
            break;
        }
        s = next;
    }
    Ok(worst)
}

/// Parameter of the point of `c` nearest to `p`, by Newton steps from `s`.
fn foot_point(c: &CubicBez, p: Point, mut s: f64) -> f64 {
    let slope = c.deriv();
    for _ in 0..8 {
        let (r, v) = (c.eval(s) - p, slope.eval(s).to_vec2());
        s = (s - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    }
    s
}
