//! Thresholds of the fit, each with its effect on pieces and work. Pieces are of the result, segments of the source. A stretch is
//! an interval of the parameter that is fitted at once, a run a chain of smoothly joined segments that is fitted like one curve.
//!
//! "0.15: −0.9 % pieces, +7 % work" is the change over the sample of `tests/libraries/bending/figures.rs` at tolerances 1, 0.1, 0.01 and
//! 0.001 together if this threshold alone has the value 0.15. Work is counted in calls of the map. Figures are "certified" if errors are
//! proved ([`Options::certify`](crate::Options::certify)), "merged" after merging. Numbers that change both by less than 0.3 % when halved
//! or doubled, and constants of mathematics, are defined where they are used.

// Shares of the tolerance. Errors add up from the source to the output, and so the shares of each task add up to one.

/// Share for errors at samples; the rest is for errors between them. 0.98: +0.2 % pieces, +3 % work; 0.5: +4 % and +68 %.
pub const ACCEPTED: f64 = 0.99;

/// Share for gaps between the sides of a stroke that are closed without a join, half of it from either side.
pub(crate) const GAPS: f64 = 0.3;

/// Longest segment of a stroked path that counts as a point, as a share of [`GAPS`].
pub(crate) const POINTS: f64 = 0.07;

/// Share for a stroke's curves: the rest that gaps and points leave.
pub(crate) const STROKED: f64 = 1.0 - (0.5 + POINTS) * GAPS;

/// Share for the points at which edges of an area cross, found once before the area grows or shrinks and once after.
#[cfg(feature = "area")]
pub(crate) const CROSSINGS: f64 = 0.02;

/// Share for simplifying an area's edges before it grows or shrinks.
#[cfg(feature = "area")]
pub(crate) const SOURCE: f64 = 0.2;

/// Share for fitting the edges of an area before they are simplified.
#[cfg(feature = "area")]
pub(crate) const EDGES: f64 = 0.3;

/// Share for simplifying the edges of the result.
#[cfg(feature = "area")]
pub(crate) const SIMPLIFIED: f64 = 1.0 - SOURCE - 2.0 * CROSSINGS - EDGES;

/// Share for the cubics that a long run becomes before it is covered with quadratics, which have the rest.
pub(crate) const CUBICS_FIRST: f64 = 0.05;

/// A wider gap between consecutive parts of a segment is a jump. A narrower one is closed, within what [`ACCEPTED`] leaves.
pub(crate) const JUMP: f64 = 1.0 - ACCEPTED;

/// Sagitta up to which an image counts as a line, as a share of the tolerance.
pub const STRAIGHT: f64 = 1e-3;

// Segments

/// A minimum of the source's speed counts as a slow spot below this share of the mean. The radius of curvature goes with the
/// cube of the speed; at a third of it, samples a sixteenth apart still resolve the turn. 0.15: −0.9 % pieces, +7 % work; 0.6: +1.7 %
/// and −1.6 %.
pub(crate) const SLOW_SPEED: f64 = 0.3;

/// The image has a cusp where its speed falls below this share of the mean. 0 (no search): −0.4 % pieces, −21 % work; but hairpins take
/// twice the work, with errors between samples.
pub(crate) const CUSP_SPEED: f64 = 0.1;

// Fit

/// Longest Gauss–Newton step, as a share of the piece's size. Longer ones overshoot the valley. 0.075: +0.1 % pieces, −0.5 % work; 0.3:
/// +0.3 % and +0.6 %.
pub(crate) const TRUST_RADIUS: f64 = 0.15;

/// Evaluations of one fit. 3: +6 % pieces, +0.9 % work; 12: −0.1 % and 0.
pub(crate) const MAX_EVALUATIONS: usize = 6;

/// Evaluations of a fit over several segments, whose error decides where to look next. 5: +1.1 % pieces; 20: unchanged, +0.6 % proofs.
pub(crate) const RUN_EVALUATIONS: usize = 10;

/// A step that promises to lower the sum of squares by less than this share is not taken. 0: −0.1 % pieces, +0.8 % work; 0.2: −0.8 %
/// certified work.
pub(crate) const MIN_GAIN: f64 = 0.1;

/// Evaluations after which a step's promised gain predicts the final residual. 2: +0.3 % pieces, +0.5 % work; 6: +0.4 % and −1.8 %.
pub(crate) const PROMISE_AFTER: usize = 3;

/// A fit predicted to leave more than this multiple of the tolerance is given up: its error only predicts the number of pieces. 1: −0.3 %
/// pieces, +1.3 % work; 4: 0 and −0.2 %.
pub(crate) const GIVE_UP: f64 = 2.0;

/// A fit with an error below this share of the tolerance is not improved further. 0.4: −0.2 % pieces (certified +0.7 %), −2 % work; 1.7:
/// 0 (certified +0.4 %) and +2.8 %.
pub(crate) const GOOD_ENOUGH: f64 = 0.85;

/// Restart a fit along the valley if its error is within this multiple of the tolerance. 1.5: +0.4 % pieces, +0.7 % work; 6: −0.2 % and
/// +0.3 %.
pub(crate) const RESTART_WITHIN: f64 = 3.0;

/// Factor by which a restart lengthens or shortens the first handle. 1: +0.3 % pieces; 2.9: +0.2 %.
pub(crate) const RESTART_FACTOR: f64 = 1.45;

/// Try a minimax fit if the error is within this multiple of the tolerance. Least squares is within 5 % of minimax to leading
/// order, more where the error has another form. None: +0.8 % pieces, −3 % work; 2.8: 0 and +1.6 %.
pub(crate) const MINIMAX_WITHIN: f64 = 1.25;

/// A minimax fit ends where its next step would leave more than this multiple of the tolerance. 0.5: +0.8 % pieces (merged +1.2 %), −0.9 %
/// work; 2: −0.1 % and +0.3 %.
pub(crate) const MINIMAX_HOPE: f64 = 1.02;

// Acceptance by samples

/// Errors below this share of the tolerance are small: between sixteen samples, a residual of the leading form s²(1−s)²((s−½)²−c)
/// exceeds its samples by 4 %, others by little more. Small errors are accepted at eight samples if the curve is a quotient of
/// polynomials of low degree, else at sixteen. 0.35: +4.6 % work; 1.4: −3.4 % work and errors above the tolerance.
pub(crate) const SMALL_ERROR: f64 = 0.6;

/// Rise of an error above its samples, as a multiple of the rise of the parabola through them. Corners and fast oscillations rise more
/// than parabolas: residuals that oscillate over six samples rise twice as far. 1.25: −1 % work, errors above the tolerance; 5: +2.1 %
/// work.
pub(crate) const PEAK_FACTOR: f64 = 2.5;

/// Most samples taken halfway: two batches. If more gaps are in doubt, the dense check costs little more. 8: +4 % work; 18: unchanged.
pub(crate) const MAX_HALFWAY: usize = 16;

/// Largest squared ratio of speeds along a piece (here tenfold) for which sixteen samples suffice under a quotient of polynomials of low
/// degree. 50: +2.4 % work; 200: −0.4 %; without: errors between samples.
pub(crate) const PACE_SIXTEEN: f64 = 100.0;

/// Largest squared ratio of speeds (here two and a half times) for which eight samples suffice, or sixteen under any other map, and
/// for trusting peaks predicted from sixteen. An image that slows down more may turn between two samples. 3: +1.5 % work; 12: −1 %, and
/// errors half as high again as accepted.
pub(crate) const PACE_EIGHT: f64 = 6.25;

/// Largest difference between a foot point and its sample's parameter: three spacings. A larger one means that the cubic's speed
/// differs much from the image's. 0.09: +4 % work; 0.36: −0.2 %.
pub(crate) const FOOT_LEAD: f64 = 0.18;

/// Longest step between consecutive foot points, in spacings. A longer one means that image or cubic nearly stops in between, where
/// errors are missed. 0.8: +61 % work; 3.2: −2 %.
pub(crate) const FOOT_STEP: f64 = 1.6;

// Dense checks

/// Longest step between foot points of a dense check, as a share of the cubic: eight times the usual one. A longer one may cross a gap of
/// the image, and the thorough check follows.
pub(crate) const FOOT_LEAP: f64 = 0.125;

/// Batches of eight samples in a dense check. Zooming in finds the maxima even from a single batch; the others are a margin.
/// 4: −5 % work; 16: +10 % work.
pub(crate) const DENSE_BATCHES: usize = 8;

/// A sample whose square is below this share of the largest (0.8 of the error) is not sampled more closely. 0.32: +0.8 % work; 1.3
/// (none is): −4 % and errors between samples.
pub(crate) const PEAK_NEAR: f64 = 0.64;

/// Zoom in on a maximum as long as each level raises the error by this factor. 1 (always): +6 % work; 2: −0.6 %.
pub(crate) const ZOOM_RISE: f64 = 1.001;

/// Samples of the thorough check in each direction, so that Newton's method starts close enough. 8: errors between the samples.
pub(crate) const THOROUGH_SAMPLES: usize = 160;

// Break points

/// Most evaluations of a stretch that may be in vain, to limit the work on noise and at undeclared jumps.
pub(crate) const FUTILE_EVALUATIONS: usize = 2_000_000;

/// Evaluations that are allowed in addition for each piece found. Most pieces take some hundreds.
pub(crate) const EVALUATIONS_PER_PIECE: usize = 10_000;

/// Shorter stretches of the parameter are not split. Bounds the attempts at a jump: 27 halvings.
pub(crate) const MIN_STRETCH: f64 = 1e-8;

/// Most pieces planned at once; a stretch that needs more is divided again. 4: +5.3 % pieces, −8.8 % work; 16: −0.1 % pieces, +0.2 % work.
pub(crate) const MAX_PLANNED: usize = 8;

/// Placements of the break points tried with one number of pieces. 2: +0.2 % pieces, −0.6 % work; 6: −0.1 % and +0.5 %.
pub(crate) const PLACEMENTS: usize = 3;

/// If the [difficulties](crate::breaks) add up to more than this share of the pieces, another placement does not help. 0.5: +1.2 % pieces,
/// −1.8 % work; 2: −0.9 % pieces, +17 % work.
pub(crate) const HOPELESS: f64 = 0.995;

/// Move single break points if the difficulties add up to less than this share of the pieces. On many curves the leading term of the
/// error vanishes somewhere, so that difficulties mislead. 0.6 (never): +3 % pieces, −11 % work; 2.3: −0.2 % pieces, +1.6 % work.
pub(crate) const REPAIRABLE: f64 = 1.15;

/// The search starts with as many pieces as this share of the difficulty, which may overrate long stretches. 0.4: −0.4 % pieces (of
/// spirals +15 %), +5 % work; 1.6: +26 % pieces.
pub(crate) const TRUSTED: f64 = 0.8;

/// Bisection steps for one break point. 3: +0.6 % pieces, −3 % work; 100: −0.3 % pieces, +2 % work.
pub(crate) const BISECTIONS: usize = 5;

/// A trial break point closer than this share of the interval to an end is replaced by the middle. 0.05: −0.3 % work (spirals +3 %);
/// 0.2: +0.9 % work.
pub(crate) const BISECTION_MARGIN: f64 = 0.1;

// Merging (figures count merged pieces)

/// Pieces of one stretch from which on fewer are searched for.
pub(crate) const LONG_STRETCH: usize = 3;

/// Pieces of one segment of a path from which on fewer are searched for. 3: +40 % time for rectangles under waves, in vain.
pub(crate) const LONG_SEGMENT: usize = 6;

/// Grid points per piece at which the fewer pieces may end, with a sample at each and between them.
pub(crate) const LONG_GRID: usize = 32;

/// Most stretches that are searched together: the samples of each take hundreds of numbers of memory.
pub(crate) const LONGEST_RUN: usize = 4096;

/// Work of the search for each piece, with its checks, in evaluations of the source.
pub(crate) const LONG_WORK: usize = 400;

/// Joints that turn by less than this are smooth: drawings round their coordinates. Radians (half a degree). 0: +19 % pieces.
pub const SMOOTH_JOINT: f64 = 0.0087;

/// A line more than this many times as long as the next is an edge, not a chord of a flattened curve, so that flattened rounded
/// rectangles keep their sides. 1: flattened ellipses keep most of their chords.
pub(crate) const LONG_EDGE: f64 = 8.0;

/// Grid points per segment at which a merged piece may end. 4: +2.4 % pieces, −12 % work; 16: −1.7 % pieces, +30 % work.
pub const MERGE_GRID: usize = 8;

/// Runs whose curvature jumps by no more than this share are one curve and are searched again on a finer grid. 0.1: −0.3 % pieces, +6 %
/// work; without: circles of eight cubics under strong maps have up to a sixth more pieces.
pub(crate) const EVEN_CURVATURE: f64 = 0.05;

/// The end of a cubic is located to within its length in grid points divided by this, but at least to one grid point.
/// Without: 100,000 cubics round a circle take more than linear time.
pub(crate) const FINEST_STEP: usize = 128;

/// Intervals between samples of a segment in a run, under a quotient of polynomials. A multiple of eight and of [`MERGE_GRID`]. 32: −4 %
/// calls of the map, twice the work of the fitter.
pub(crate) const RATIONAL_SAMPLES: usize = 16;

/// Intervals under any other map, whose error may swing several times within a segment. 16: errors between the samples in
/// rare random cases.
pub(crate) const OPAQUE_SAMPLES: usize = 32;

/// Error of the best cubic for a curve whose curvature jumps by 1, per square of the shorter side: for the function that is x²/2 right
/// of zero and 0 left of it, on −1..1, in the uniform norm. No fit is tried across a joint with a larger jump than this allows.
/// 0: −0.1 % pieces, +27 % trials; 0.014: +0.2 % pieces, −1.3 % work.
pub(crate) const JUMP_ERROR: f64 = 0.0069;

/// Error ÷ tolerance that the next guess of a cubic's reach aims at, by the sixth-order law: a little too far, because
/// interpolation between a fit and a miss is faster than galloping. 2.5: +0.4 % work; 10: +0.1 %.
pub(crate) const REACH_TARGET: f64 = 5.0;

/// Error ÷ tolerance aimed at once a fit and a miss are known. Between these, log(error) is taken as linear in log(length).
/// 0.6: +0.6 % work; 2.4: +0.2 %.
pub(crate) const BETWEEN_TARGET: f64 = 1.2;

/// A stretch interpolates its samples if the samples of the run are off the wanted parameters by more than this share of the spacing.
/// 0.3: −0.1 % work, more instructions; 1.2: +0.1 % pieces, +0.5 % work.
pub(crate) const COARSE: f64 = 0.6;

/// A check samples the run more closely where two samples are further apart than this share of the cubic's length: a little more than
/// the spacing in one segment of even speed, a sixteenth, so that a cubic over a long and a short segment needs no closer look.
/// 0.03: +32 % work; 0.13: −22 % and errors above the tolerance.
pub(crate) const COARSE_CHECK: f64 = 0.065;

/// Parts of a segment with fewer intervals than this have too few samples to show the shape of their error, which starts with zero slope
/// at a cubic's ends and may peak close beside a joint. 2: −0.2 % work, and errors above the tolerance in rare random runs;
/// 8: +1 % work.
pub(crate) const SHORT_PART: usize = 4;

/// Replaces [`PEAK_FACTOR`] in short parts. 12: +0.3 % work.
pub(crate) const SHORT_FACTOR: f64 = 6.0;

/// If the cubic's direction differs by more than this (as a tangent) between two samples, its distance from the image is measured
/// in between; elsewhere the two run side by side. 0.12: +3.4 % work; 0.5: −0.5 %; without: bulges of the cubic are missed.
pub(crate) const SHARP_TURN: f64 = 0.25;

/// Share of the tolerance above which the error of a cubic that will be carried to other copies of its shape is brought down as far as
/// possible, because it grows a little when carried.
pub(crate) const CARRY_BELOW: f64 = 0.7;

// Nodes placed by `Nodes::Auto` and `Nodes::Extremes`

/// A node moves to an extreme if the curve turns by less than this up to the extreme, as a sine (20°).
pub(crate) const MOVED_TURN: f64 = 0.342;

/// A direction counts as along an axis if it is off by less than this, which is rounding.
pub(crate) const ON_AXIS: f64 = 1e-7;

// Quadratics

/// Samples for each piece of a quadratic spline.
pub(crate) const SPLINE_SAMPLES: usize = 8;
