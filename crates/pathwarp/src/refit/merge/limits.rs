//! Thresholds of merging. As in `refit::limits`, each entry says what it trades; figures are those of the merged runs of
//! `tests/geometry/figures.rs`. *Trials* are fits of one cubic to one stretch; figures beside them are those of every fourth icon of
//! docs/benchmarks.md under its strong map.

/// Joints that turn by less than this are smooth: drawings round their coordinates. Radians (half a degree). 0: +19 % pieces.
/// Tests: *figures* (at 0); `limits::merging_keeps_corners_that_the_tolerance_would_hide` (at 10).
pub(super) const SMOOTH_JOINT: f64 = 0.0087;

/// Joints that turn by more than this (as a tangent, a little above [`SMOOTH_JOINT`]) are corners at first sight, so that their
/// segments are not sampled. 0: +20 % pieces. At 1e9 nothing changes but the time.
/// Test: *figures* (at 0).
pub(super) const SURE_CORNER: f64 = 0.009;

/// … if both derivatives are above this share of their segment's chord, times the size of the Jacobian: far above
/// `VANISHING_DERIVATIVE`, below which one-sided tangents decide. Unchanged at 0 and 1e9: the sample has no joint in between.
pub(super) const CLEAR_DERIVATIVE: f64 = 1e-6;

/// Places per segment at which a merged piece may end. 1: +7.6 % pieces, −56.9 % work; 4: +2.0 % pieces, −25.4 % work; 16: −1.7 % pieces, +29.6 % work.
/// Test: *figures* (at 1).
pub(super) const MERGE_GRID: usize = 8;

/// Segments under one cubic, which bounds the table of errors. 1: +19.1 % pieces, −40.7 % work; 6: unchanged here, on icons 0.1 % more pieces at 1; 30:
/// unchanged.
/// Test: *figures* (at 1).
pub(super) const MAX_SPAN: usize = 12;

/// Segments in one table, which bounds its memory. 1: no merging; 1000: unchanged.
/// Test: *figures* (at 1).
pub(super) const MAX_RUN: usize = 64;

/// Share of the tolerance for merged pieces, which leaves room between the samples. 0.1: +15 % pieces; 1: −0.05 %; 2: errors above
/// the tolerance.
/// Tests: *figures* (at 0.1); *sample* (at 2).
pub(super) const MERGE_SHARE: f64 = 0.99;

/// Intervals between samples of a segment in a run, under a quotient of polynomials. A multiple of eight and of [`MERGE_GRID`].
pub(super) const RATIONAL_SAMPLES: usize = 16;

/// … and under any other map, whose error may swing several times within a segment. 16: errors between the samples in one of 16,000
/// random cases.
/// Test: `merge_random::waves_shorter_than_a_segment_are_seen` (at 16).
pub(super) const OPAQUE_SAMPLES: usize = 32;

/// Searches over one run, each without the pieces that the last one's checks refused. 1: +5.7 % pieces, −8.7 % work; 4: +0.5 %
/// pieces, −2.4 % work; 100: unchanged.
/// Test: *figures* (at 1).
pub(super) const MERGE_SEARCHES: usize = 12;

/// Error of the best cubic for a curve whose curvature jumps by 1, per square of the shorter side: that of x²/2 right of zero and
/// 0 left of it, on −1..1, in the uniform norm. A joint with a larger jump than this allows is not crossed, so no fit is wasted
/// on it. 0: −0.03 % pieces, +27 % trials; 0.03: +0.5 % pieces, −15 % trials.
/// Test: *figures* (at 0.03 and 0).
pub(super) const JUMP_ERROR: f64 = 0.0069;

/// Error ÷ tolerance that the next guess of a reach aims at, by the sixth-order law: a little too far, as interpolation comes
/// back faster than galloping goes on. Only the order of trials depends on it. 1.2: unchanged, +1.6 % trials; 3: unchanged, but text
/// takes 2 % longer.
/// Test: *figures* (at 0.3).
pub(super) const REACH_TARGET: f64 = 5.0;

/// The same once a fit and a miss are known: between them the error's logarithm is taken as linear in that of the length.
/// A little too far again, as a fit ends once its error is small enough. 1 and 2: unchanged, within 0.5 % of trials.
pub(super) const BETWEEN_TARGET: f64 = 1.2;

/// Steps of that kind before the interval is halved.
pub(super) const INTERPOLATIONS: usize = 6;

/// Errors below this share of the tolerance are rounding to the guess of a reach, which then grows at most fivefold. 0.1: +0.2 %
/// work; 1e-12: unchanged.
pub(super) const SMALLEST_REACH_ERROR: f64 = 1e-4;

/// A stretch interpolates its samples if those of the run are off the wanted places by more than this share of the spacing. 0
/// (always): −0.01 % pieces.
pub(super) const COARSE: f64 = 0.6;

/// A check samples the run more closely where two samples are further apart than this share of the cubic's length: a little more than
/// the spacing in one segment of even speed, a sixteenth, so that a cubic over a long and a short segment needs no closer look.
/// Test: *sample* (at 1).
pub(super) const COARSE_CHECK: f64 = 0.065;

/// Parts of a segment with fewer intervals than this have too few samples to show how their error bends: a cubic's ends have errors of
/// zero slope, so that the error may peak close beside a joint.
pub(super) const SHORT_PART: usize = 4;

/// In such parts it may exceed its samples by this multiple of a parabola's excess, instead of by [`PEAK_FACTOR`]. At that one, one in a
/// thousand random runs had a piece with errors of up to 1.2 % above the tolerance.
/// Test: `merge_random::errors_between_a_joint_and_the_end_of_a_cubic_are_seen` (at 2.5).
///
/// [`PEAK_FACTOR`]: crate::refit::limits::PEAK_FACTOR
pub(super) const SHORT_FACTOR: f64 = 6.0;

/// Between two samples at which the cubic's direction differs by more than this (as a tangent), its own distance from the image is
/// measured: elsewhere the two run side by side. 0: a check takes three times as long.
/// Test: `merge_random::bulges_of_the_cubic_between_foot_points_are_seen` (at 1e9).
pub(super) const SHARP_TURN: f64 = 0.25;

/// Places past the next joint at which the first trial ends, unless the last cubic reached further: half a segment, the least that is
/// likely to save a piece.
pub(super) const LEAST_PAST_JOINT: usize = MERGE_GRID / 2;

/// Try a minimax fit over several segments if the error is within this multiple of the tolerance. 1.4, as for single segments: −0.02 %
/// pieces, on curves of evenly spaced nodes −0.2 %, and +5 % time; 1.15: +0.3 % pieces there, −2.4 % work.
pub(super) const RUN_MINIMAX_WITHIN: f64 = 1.25;

/// Longer stretches are tried after a miss by less than this factor. 3: +0.04 % pieces, −4 % trials; 10: unchanged, +3.5 % trials.
/// Test: *figures* (at 1).
pub(super) const LEAP_WITHIN: f64 = 5.0;

/// Number of places tried beyond the one that misses nearly. 3: −0.1 % pieces, but on curves of evenly spaced nodes +10 % work.
/// Test: *figures* (at 0).
pub(super) const LEAPS: usize = 1;

/// Error recorded for a piece that failed the final check: a miss, but a near one. 1e9: unchanged.
pub(super) const REFUSED_ERROR: f64 = 1.2;

/// Shapes of runs that are remembered, in case they come again: two or three for each letter of an alphabet.
pub(super) const MAX_SHAPES: usize = 256;

/// Ways that are remembered for a shape: a map magnifies some places more than others, which then need more pieces.
pub(super) const MAX_WAYS: usize = 3;

/// Where no cubics can be carried, a known shape is searched each time this many such places have come, in case there is a better way
/// by now. Text under a gentle flag: 2: −1.1 % pieces, +7 % work; but where the map changes much along a line, twice the time.
pub(super) const SEARCH_AGAIN: usize = 8;

/// Control points of runs of the same shape differ by less than this share of the tolerance; letters are placed in single precision.
pub(super) const SAME_SHAPE: f64 = 0.05;

/// Ways of a shape that are remembered with their cubics, each for one Jacobian of the map.
pub(super) const MAX_CARRIED: usize = 24;

/// Sites from which cubics are carried to another, one after the other, until they suffice there.
pub(super) const CARRY_TRIALS: usize = 3;

/// Share of the tolerance above which the error of a cubic of a shape that comes again is brought down as far as possible: the error
/// grows a little when the cubic is carried.
pub(super) const CARRY_BELOW: f64 = 0.7;

/// Cubics are carried to another place if lengths there are at most this many times as long, in every direction …
pub(super) const CARRY_UP: f64 = 2.0;

/// … and at least this many times: where they are shorter, fewer cubics may do. 0.8: fewer places are alike, pieces unchanged.
pub(super) const CARRY_DOWN: f64 = 0.5;

/// Tangents of a carried cubic may turn by this much (as a tangent) beside the change of the map where the run begins.
pub(super) const CARRIED_TURN: f64 = 0.2;

/// Factor from the largest difference at the samples of a carried cubic to that between them, a smooth function. 1: 5 % fewer runs are
/// fitted anew.
pub(super) const CARRY_MARGIN: f64 = 2.0;

/// Segments for which eight samples of a carried cubic are taken.
pub(super) const SEGMENTS_PER_BATCH: usize = 4;
