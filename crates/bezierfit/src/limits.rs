//! Thresholds of the fit, each with what it does to pieces and work.
//!
//! "0.15: −0.9 % pieces, +7 % work" is the change over the sample of `tests/libraries/bending/figures.rs` at tolerances 1, 0.1, 0.01 and
//! 0.001 together if this threshold alone has that value. Work is counted in calls of the map. Numbers that change either by less than
//! 0.3 % when halved or doubled, and constants of mathematics, stand where they are used.

// Shares of the tolerance. Errors add up along the way from the source to the output; each sum below is one.

/// For errors at samples; the rest is for errors between them. 0.98: +0.2 % pieces, +3 % work; 0.5: +4 % and +68 %.
pub const ACCEPTED: f64 = 0.99;

/// For the sides of a stroke that miss each other: gaps that are closed without a join, half of it from either side.
pub(crate) const GAPS: f64 = 0.3;

/// For segments of a stroked path that are points, as a share of those gaps.
pub(crate) const POINTS: f64 = 0.07;

/// For a stroke's curves: what gaps and points leave.
pub(crate) const STROKED: f64 = 1.0 - (0.5 + POINTS) * GAPS;

/// For the places at which edges of an area cross.
#[cfg(feature = "area")]
pub(crate) const CROSSINGS: f64 = 0.02;

/// For fewer pieces of an area's edges before it grows or shrinks.
#[cfg(feature = "area")]
pub(crate) const SOURCE: f64 = 0.2;

/// For the edges of an area before fewer pieces are looked for.
#[cfg(feature = "area")]
pub(crate) const EDGES: f64 = 0.3;

/// For those pieces.
#[cfg(feature = "area")]
pub(crate) const SIMPLIFIED: f64 = 1.0 - SOURCE - 2.0 * CROSSINGS - EDGES;

/// For the cubics that a long run becomes before it is covered with quadratics, which have the rest.
pub(crate) const CUBICS_FIRST: f64 = 0.05;

/// A wider gap between parts of a source is a jump. A narrower one is closed, within what [`ACCEPTED`] leaves.
pub(crate) const JUMP: f64 = 1.0 - ACCEPTED;

/// Sagitta up to which an image is a line, so that lines leave the rest to other errors.
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

/// … and of one over several segments, whose error decides where to look next. 5: +1.1 % pieces; 20: unchanged, +0.6 % proofs.
pub(crate) const RUN_EVALUATIONS: usize = 10;

/// A step that promises to lower the sum of squares by less than this share is not taken. 0: −0.1 % pieces, +0.8 % work; 0.2: as much
/// less certified work.
pub(crate) const MIN_GAIN: f64 = 0.1;

/// Evaluations after which a step's promise predicts the residual reached. 2: +0.3 % pieces, +0.5 % work; 6: +0.4 % and −1.8 %.
pub(crate) const PROMISE_AFTER: usize = 3;

/// A fit predicted to leave more than this multiple of the tolerance is given up: it only has to predict the number of pieces. 1: −0.3 %
/// pieces, +1.3 % work; 4: 0 and −0.2 %.
pub(crate) const GIVE_UP: f64 = 2.0;

/// A fit with an error below this share of the tolerance is not improved further. 0.4: −0.2 % pieces (certified +0.7 %), −2 % work; 1.7:
/// 0 (certified +0.4 %) and +2.8 %.
pub(crate) const GOOD_ENOUGH: f64 = 0.85;

/// Restart a fit along the valley if its error is within this multiple of the tolerance. 1.5: +0.4 % pieces, +0.7 % work; 6: −0.2 % and
/// +0.3 %.
pub(crate) const RESTART_WITHIN: f64 = 3.0;

/// By how much the first handle is longer or shorter then. 1: +0.3 % pieces; 2.9: +0.2 %.
pub(crate) const RESTART_FACTOR: f64 = 1.45;

/// Try a minimax fit if the error is within this multiple of the tolerance. Least squares is within 5 % of minimax to leading
/// order, more where the error has another form. None: +0.8 % pieces, −3 % work; 2.8: 0 and +1.6 %.
pub(crate) const MINIMAX_WITHIN: f64 = 1.25;

/// A minimax fit ends where its next step would leave more than this multiple of the tolerance. 0.5: +0.8 % pieces (merged +1.2 %), −0.9 %
/// work; 2: −0.1 % and +0.3 %.
pub(crate) const MINIMAX_HOPE: f64 = 1.02;

// Acceptance by samples

/// Below this share of the tolerance an error is small: between sixteen samples, a residual of the leading form
/// s²(1−s)²((s−½)²−c) exceeds its samples by 4 %, others by little more. Such errors at eight samples are accepted if the curve is a
/// quotient of polynomials of low degree, at sixteen under any other. 0.35: +4.6 % work; 1.4: −3.4 % work and errors above the tolerance.
pub(crate) const SMALL_ERROR: f64 = 0.6;

/// Excess of an error over its samples relative to that of a parabola through them: corners and faster oscillations rise more.
/// Residuals that oscillate over six samples have peaks that rise twice as far as the parabolas. 1.25: −1 % work, errors above the
/// tolerance; 5: +2.1 % work.
pub(crate) const PEAK_FACTOR: f64 = 2.5;

/// Samples taken halfway: two batches. With more gaps in doubt than that, the dense check is not much dearer. 8: +4 % work; 18:
/// unchanged.
pub(crate) const MAX_HALFWAY: usize = 16;

/// Largest ratio of speeds along a piece, squared, for which sixteen samples suffice under a quotient of polynomials of low degree
/// (tenfold). 50: +2.4 % work; 200: −0.4 %; without:
/// errors between samples.
pub(crate) const PACE_SIXTEEN: f64 = 100.0;

/// The same for eight samples, for any other map, and for trusting peaks predicted from sixteen (two and a half times): an image that slows down more may turn
/// between two samples. 3: +1.5 % work; 12: −1 %, and errors half as high again as accepted.
pub(crate) const PACE_EIGHT: f64 = 6.25;

/// Largest distance of a foot point from its sample's own parameter; three spacings. Farther ones mean that the cubic's speed
/// differs much from the image's. 0.09: +4 % work; 0.36: −0.2 %.
pub(crate) const FOOT_LEAD: f64 = 0.18;

/// Longest step between consecutive foot points, in spacings. A longer one means that image or cubic nearly stops in between: random
/// tests found errors of up to 37 % there. 0.8: +61 % work; 3.2: −2 %.
pub(crate) const FOOT_STEP: f64 = 1.6;

// Dense checks

/// Longest step between foot points, as a share of the cubic: eight times the usual one. A longer one may cross a gap of the image, and
/// is measured both ways.
pub(crate) const FOOT_LEAP: f64 = 0.125;

/// Batches of eight samples in a dense check. 4: −5 % work; 16: +10 % work. Zooming in finds the maxima even from a single batch; the
/// others are a margin.
pub(crate) const DENSE_BATCHES: usize = 8;

/// A sample whose square is below this share of the largest (0.8 of the error) is not sampled more closely. 0.32: +0.8 % work; 1.3
/// (none is): −4 % and errors between samples.
pub(crate) const PEAK_NEAR: f64 = 0.64;

/// Zoom in on a maximum as long as each level raises the error by this factor. 1 (always): +6 % work; 2: −0.6 %.
pub(crate) const ZOOM_RISE: f64 = 1.001;

/// Samples of the thorough check in each direction, so that Newton's method starts close enough. 8: errors between the samples.
pub(crate) const THOROUGH_SAMPLES: usize = 160;

// Break points

/// Evaluations of a smooth part that may find no pieces: more would be spent on noise, and at jumps that no source declares …
pub(crate) const FUTILE_EVALUATIONS: usize = 2_000_000;

/// … and for each piece found. Usual ones take some hundreds.
pub(crate) const EVALUATIONS_PER_PIECE: usize = 10_000;

/// Shorter stretches of the parameter are not split. Bounds the attempts at a jump: 27 halvings.
pub(crate) const MIN_STRETCH: f64 = 1e-8;

/// Pieces planned at once; a stretch that needs more is divided again. 4: +5.3 % pieces, −8.8 % work; 16: −0.1 % pieces, +0.2 % work.
pub(crate) const MAX_PLANNED: usize = 8;

/// Placements of the break points tried with one number of pieces. 2: +0.2 % pieces, −0.6 % work; 6: −0.1 % and +0.5 %.
pub(crate) const PLACEMENTS: usize = 3;

/// If the difficulties add up to more than this share of the pieces, another placement does not help. 0.5: +1.2 % pieces, −1.8 %
/// work; 2: −0.9 % pieces, +17 % work.
pub(crate) const FULL: f64 = 0.995;

/// Move single break points if the difficulties add up to less than this share of the pieces: the leading term of the error
/// vanishes somewhere on many curves. 0.6 (never): +3 % pieces, −11 % work; 2.3: −0.2 % pieces, +1.6 % work.
pub(crate) const REPAIRABLE: f64 = 1.15;

/// Share of the difficulty of long pieces that is believed, for the same reason: fewer pieces are tried first. 0.4: −0.4 % pieces (of
/// spirals +15 %), +5 % work; 1.6: +26 % pieces.
pub(crate) const HOPE: f64 = 0.8;

/// Bisection steps for one break point. 3: +0.6 % pieces, −3 % work; 100: −0.3 % pieces, +2 % work.
pub(crate) const BISECTIONS: usize = 5;

/// A trial place closer than this share of the interval to one already tried is replaced by the middle. 0.05: −0.3 % work (spirals +3 %);
/// 0.2: +0.9 % work.
pub(crate) const BISECTION_MARGIN: f64 = 0.1;

// Merging: figures are those of merged pieces

/// Pieces of one stretch from which on fewer are looked for.
pub(crate) const LONG: usize = 3;

/// Pieces of one segment of a path from which on fewer are looked for. 3: +40 % time for rectangles under waves, which take four pieces a side, and no fewer.
pub(crate) const LONG_SEGMENT: usize = 6;

/// Places per piece at which those may end, with a sample at each and between them.
pub(crate) const LONG_GRID: usize = 32;

/// Stretches that are searched together, for the memory of their samples: hundreds of numbers each. Of so many, one piece is hardly one.
pub(crate) const LONGEST_RUN: usize = 4096;

/// Work of the search for each piece, with its checks, in evaluations of the source.
pub(crate) const LONG_WORK: usize = 400;

/// Joints that turn by less than this are smooth: drawings round their coordinates. Radians (half a degree). 0: +19 % pieces.
pub const SMOOTH_JOINT: f64 = 0.0087;

/// A line more than this many times as long as the next is an edge and no chord of a flattened curve. Flattened rounded rectangles keep
/// their sides; at 1, flattened ellipses keep most of their chords.
pub(crate) const LONG_EDGE: f64 = 8.0;

/// Places per segment at which a merged piece may end. 4: +2.4 % pieces, −12 % work; 16: −1.7 % pieces, +30 % work.
pub const MERGE_GRID: usize = 8;

/// Runs whose curvature jumps by no more than this share are one curve, and searched again on a finer grid. 0.1: −0.3 % pieces, +6 % work;
/// without: circles of eight cubics under strong maps have up to a sixth more pieces.
pub(crate) const EVEN_CURVATURE: f64 = 0.05;

/// Share of a cubic's grid places to which its end is searched: the last of 64 or fewer exactly, of more as a share. Without: 100,000
/// cubics round a circle take more than linear time.
pub(crate) const FINEST_STEP: usize = 128;

/// Intervals between samples of a segment in a run, under a quotient of polynomials. A multiple of eight and of [`MERGE_GRID`]. 32: −4 %
/// work of the map, twice as much of the fitter.
pub(crate) const RATIONAL_SAMPLES: usize = 16;

/// … and under any other map, whose error may swing several times within a segment. 16: errors between the samples in one of 16,000
/// random cases.
pub(crate) const OPAQUE_SAMPLES: usize = 32;

/// Error of the best cubic for a curve whose curvature jumps by 1, per square of the shorter side: that of x²/2 right of zero and
/// 0 left of it, on −1..1, in the uniform norm. A joint with a larger jump than this allows is not crossed, so no fit is wasted
/// on it. 0: −0.1 % pieces, +27 % trials; 0.014: +0.2 % pieces, −1.3 % work.
pub(crate) const JUMP_ERROR: f64 = 0.0069;

/// Error ÷ tolerance that the next guess of a reach aims at, by the sixth-order law: a little too far, as interpolation comes
/// back faster than galloping goes on. 2.5: +0.4 % work; 10: +0.1 %.
pub(crate) const REACH_TARGET: f64 = 5.0;

/// The same once a fit and a miss are known: between them the error's logarithm is taken as linear in that of the length. 0.6: +0.6 % work;
/// 2.4: +0.2 %.
pub(crate) const BETWEEN_TARGET: f64 = 1.2;

/// A stretch interpolates its samples if those of the run are off the wanted places by more than this share of the spacing. 0.3: −0.1 %
/// work, more instructions; 1.2: +0.1 % pieces, +0.5 % work.
pub(crate) const COARSE: f64 = 0.6;

/// A check samples the run more closely where two samples are further apart than this share of the cubic's length: a little more than
/// the spacing in one segment of even speed, a sixteenth, so that a cubic over a long and a short segment needs no closer look.
/// 0.03: +32 % work; 0.13: −22 % and errors above the tolerance.
pub(crate) const COARSE_CHECK: f64 = 0.065;

/// Parts of a segment with fewer intervals than this have too few samples to show how their error bends: a cubic's ends have errors of
/// zero slope, so that the error may peak close beside a joint. 2: −0.2 % work, and errors of up to 1.2 % above the tolerance in one of a
/// thousand random runs; 8: +1 % work.
pub(crate) const SHORT_PART: usize = 4;

/// In such parts it may exceed its samples by this multiple of a parabola's excess, instead of by [`PEAK_FACTOR`]. 12: +0.3 % work.
pub(crate) const SHORT_FACTOR: f64 = 6.0;

/// Between two samples at which the cubic's direction differs by more than this (as a tangent), its own distance from the image is
/// measured: elsewhere the two run side by side. 0.12: +3.4 % work; 0.5: −0.5 %; without: bulges of the cubic are missed.
pub(crate) const SHARP_TURN: f64 = 0.25;

/// Share of the tolerance above which the error of a cubic of a shape that comes again is brought down as far as possible: the error
/// grows a little when the cubic is carried.
pub(crate) const CARRY_BELOW: f64 = 0.7;

// Placed nodes

/// A node goes to an extreme if the curve turns by less than this up to there, as a sine (20°).
pub(crate) const MOVED_TURN: f64 = 0.342;

/// A direction that is off an axis by less than this is along it: rounding.
pub(crate) const ON_AXIS: f64 = 1e-7;

// Quadratics

/// Samples for each piece of a quadratic spline.
pub(crate) const SPLINE_SAMPLES: usize = 8;
