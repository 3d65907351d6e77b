//! Thresholds of the refit: every constant that decides what is tried, accepted or proven, with its trade-off.
//!
//! Figures are from a sweep that changed one constant at a time: pieces out per segment in over icon paths under the strong map
//! of the benchmark at tolerance 0.001, and evaluations of the fit per segment. Constants without figures were not swept.

/// A segment shorter than this fraction of its coordinates is rounding of two equal points; it stays a degenerate line. Fails
/// without it: `failure_modes_stay_within_the_tolerance` (at 1e-3).
pub(super) const POINT_SIZE: f64 = 1e-15;
/// Sides of a crease further apart than this fraction of the tolerance are torn: a line joins them. Closer ones share the node.
/// No fast test fails at its extremes.
pub(super) const TEAR: f64 = 0.01;
/// Largest sweep, in radians, of an arc that is proven as one quotient of polynomials. Below π the denominator stays positive;
/// smaller parts cost pieces. Fails without it: `proofs_hold_for_every_kind_of_segment` (at 7).
pub(super) const MAX_RATIONAL_SWEEP: f64 = 2.2;
/// A derivative below this fraction of the segment's size has no direction; the tangent is taken from one side. Fails without
/// it: `proofs_hold_for_every_kind_of_segment` (at 0.1).
pub(super) const VANISHING_DERIVATIVE: f64 = 1e-9;
/// Parameter step for one-sided tangents at a vanishing derivative: small enough for the limit, large enough for rounding. No
/// fast test fails at its extremes.
pub(super) const ONE_SIDED_STEP: f64 = 3e-7;
/// A minimum of a source cubic's speed below this fraction of the mean is a slow spot. The radius of curvature goes with the
/// cube of the speed: at a third of it, samples a sixteenth apart still see the turn. Fails without it:
/// `a_cusp_is_found_and_a_round_curve_has_none` (at 0). Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen:
/// 1.5616 and 6.07 at 0.2; 1.5624 and 6.07 at 0.45.
pub(super) const SLOW_SPEED: f64 = 0.3;
/// Slow spots closer than this to an end, in parameter, belong to the end. No fast test fails at its extremes. Pieces per
/// segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1e-8; 1.5624 and 6.07 at 1e-4.
pub(super) const SLOW_MARGIN: f64 = 1e-6;
/// An image is straight if its samples lie within this fraction of its size from the chord. Pieces per segment at 0.001 and
/// evaluations, 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1e-10; 1.5624 and 6.07 at 1e-8.
pub(super) const STRAIGHT_SIZE: f64 = 1e-9;
/// Nor may they be further from it than this fraction of the tolerance. Pieces per segment at 0.001 and evaluations, 1.5624 and
/// 6.07 as chosen: 1.5624 and 6.07 at 1e-4; 1.5624 and 6.07 at 1e-2.
pub(super) const STRAIGHT_TOLERANCE: f64 = 1e-3;
/// Rounding of an image coordinate after a map's arithmetic, relative to its magnitude. Pieces per segment at 0.001 and
/// evaluations, 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1e-15; 1.5624 and 6.07 at 1e-13.
pub(super) const IMAGE_ROUNDING: f64 = 4e-15;
/// Rounding of sample differences, relative to the size of the piece. Pieces per segment at 0.001 and evaluations, 1.5624 and
/// 6.07 as chosen: 1.5624 and 6.07 at 1e-14; 1.5624 and 6.07 at 1e-10.
pub(super) const SAMPLE_ROUNDING: f64 = 1e-12;
/// End tangents closer to the chord than this angle, in radians, make no corner. Pieces per segment at 0.001 and evaluations,
/// 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1e-8; 1.5624 and 6.07 at 1e-4.
pub(super) const STRAIGHT_TURN: f64 = 1e-6;
/// The Hermite cubic is the image if no sample is further off than this fraction of the size: it is kept without a fit. Fails
/// without it: `the_identity_gives_every_segment_back` (at 0), `errors_between_the_samples_are_seen` (at 1). Pieces per segment
/// at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1e-13; 1.5624 and 6.07 at 1e-9.
pub(super) const EXACT_HERMITE: f64 = 1e-11;
/// Shortest handle, as a fraction of the size of the piece. Fails without it:
/// `merging_saves_nodes_and_keeps_the_tolerance_corners_and_smoothness` (at 10). Pieces per segment at 0.001 and evaluations,
/// 1.5624 and 6.07 as chosen: 1.5624 and 6.08 at 1e-4; 1.5632 and 6.00 at 1e-2.
pub(super) const HANDLE_FLOOR: f64 = 1e-3;
/// The same where the Hermite handle vanishes; it starts tiny and may grow. Fails without it:
/// `proofs_hold_for_every_kind_of_segment` (at 1). Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen:
/// 1.5624 and 6.07 at 1e-7; 1.5620 and 6.06 at 1e-3.
pub(super) const HANDLE_FLOOR_STOPPED: f64 = 1e-5;
/// Weight of a handle's distance from Hermite's: off by the size of the piece, it counts like a residual of this fraction of
/// the tolerance. It keeps flat valleys of the sum of squares from running away. Fails without it:
/// `merging_saves_nodes_and_keeps_the_tolerance_corners_and_smoothness` (at 1e3). Pieces per segment at 0.001 and evaluations,
/// 1.5624 and 6.07 as chosen: 1.5624 and 6.06 at 0.02; 1.5628 and 6.07 at 0.12.
pub(super) const HANDLE_PULL: f64 = 0.05;
/// Damping relative to the diagonal: just enough to keep the 2×2 normal equations from being singular. Fails without it:
/// `merging_saves_nodes_and_keeps_the_tolerance_corners_and_smoothness` (at 1). Pieces per segment at 0.001 and evaluations,
/// 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1e-14; 1.6556 and 6.48 at 1e-3.
pub(super) const DAMPING: f64 = 1e-11;
/// A Gauss–Newton step longer than this fraction of the length of the samples is not trusted. Fails without it:
/// `a_full_turn_in_one_arc` (at 1e-6). Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5620 and 6.01
/// at 0.08; 1.5649 and 6.05 at 0.3.
pub(super) const TRUST_RADIUS: f64 = 0.15;
/// Evaluations of one fit at most. Fails without it: `merging_saves_nodes_and_keeps_the_tolerance_corners_and_smoothness` (at
/// 1). Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5772 and 6.00 at 4; 1.5620 and 6.06 at 9.
pub(super) const MAX_EVALUATIONS: usize = 6;
/// A step that promises less than this fraction of the sum of squares is not taken. Fails without it:
/// `merging_saves_nodes_and_keeps_the_tolerance_corners_and_smoothness` (at 1e9). Pieces per segment at 0.001 and evaluations,
/// 1.5624 and 6.07 as chosen: 1.5624 and 6.08 at 0.03; 1.5636 and 6.08 at 0.3.
pub(super) const MIN_GAIN: f64 = 0.1;
/// A fit that starts this many times above the tolerance counts as far off and ends early. No fast test fails at its extremes.
/// Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5620 and 6.09 at 3; 1.5620 and 6.07 at 12.
pub(super) const FAR_MISS: f64 = 6.0;
/// Evaluations after which the promise of the next step tells what can be reached. Pieces per segment at 0.001 and evaluations,
/// 1.5624 and 6.07 as chosen: 1.5636 and 6.01 at 2; 1.5640 and 6.01 at 4.
pub(super) const PROMISE_AFTER: usize = 3;
/// At that evaluation the promise counts only if it is below this fraction of the sum of squares; later, always. No fast test
/// fails at its extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5620 and 6.06 at 0.25;
/// 1.5636 and 6.04 at 0.9.
pub(super) const PROMISE_GAIN: f64 = 0.5;
/// If what can be reached is this many times the tolerance, the fit is given up. Pieces per segment at 0.001 and evaluations,
/// 1.5624 and 6.07 as chosen: 1.5620 and 6.06 at 1.4; 1.5624 and 6.01 at 4.
pub(super) const GIVE_UP: f64 = 2.0;
/// Smallest weight in Lawson's reweighting, relative to the largest. No fast test fails at its extremes. Pieces per segment at
/// 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1e-5; 1.5608 and 6.01 at 0.1.
pub(super) const LAWSON_FLOOR: f64 = 1e-3;
/// Steps of Lawson's reweighting. No fast test fails at its extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and
/// 6.07 as chosen: 1.5624 and 6.04 at 2; 1.5616 and 6.04 at 8.
pub(super) const LAWSON_STEPS: usize = 4;
/// A fit within this fraction of the tolerance is not improved further. No fast test fails at its extremes. Pieces per segment
/// at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5620 and 5.97 at 0.7; 1.5640 and 6.20 at 0.95.
pub(super) const GOOD_ENOUGH: f64 = 0.85;
/// Misses by less than this factor are fitted again from other starts along the valley of equal area. No fast test fails at its
/// extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5649 and 6.11 at 1.5; 1.5608 and 6.05 at
/// 6.
pub(super) const RESTART_WITHIN: f64 = 3.0;
/// The same for pieces that turn by more than [`RESTART_TURN`], which seldom have a second minimum. No fast test fails at its
/// extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5624 and 6.07 at 1.05; 1.5624 and 6.08
/// at 2.
pub(super) const RESTART_WITHIN_TURNED: f64 = 1.2;
/// Cosine of that turn, 50°. No fast test fails at its extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07
/// as chosen: 1.5624 and 6.08 at 0.3; 1.5632 and 6.09 at 0.9.
pub(super) const RESTART_TURN: f64 = 0.643;
/// Factor of the first handle for a restart with a longer one. No fast test fails at its extremes. Pieces per segment at 0.001
/// and evaluations, 1.5624 and 6.07 as chosen: 1.5632 and 6.07 at 1.2; 1.5640 and 6.06 at 2.
pub(super) const RESTART_LONGER: f64 = 1.45;
/// And with a shorter one. No fast test fails at its extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as
/// chosen: 1.5624 and 6.02 at 0.5; 1.5628 and 6.04 at 0.83.
pub(super) const RESTART_SHORTER: f64 = 0.69;
/// A restart must be better than this fraction of the error before it is judged. No fast test fails at its extremes. Pieces per
/// segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5632 and 5.98 at 0.9; 1.5620 and 6.06 at 1.
pub(super) const RESTART_GAIN: f64 = 0.98;
/// Misses by less than this factor are reweighted towards minimax, which gains at most about a third. Fails without it:
/// `errors_between_the_samples_are_seen` (at 1e9). Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen:
/// 1.5620 and 6.01 at 1.2; 1.5620 and 6.14 at 2.
pub(super) const MINIMAX_WITHIN: f64 = 1.4;
/// A normal residual is the distance up to κδ²/2 with δ the rest of the foot point's way; that may be this fraction of the
/// tolerance. No fast test fails at its extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen:
/// 1.5624 and 6.07 at 0.005; 1.5624 and 6.07 at 0.1.
pub(super) const FOOT_DRIFT: f64 = 0.02;
/// Errors below this fraction of the tolerance cannot rise above it between sixteen samples: a residual of the leading form
/// s²(1−s)²((s−½)²−c) rises by 4 %. No fast test fails at its extremes. Pieces per segment at 0.001 and evaluations, 1.5624 and
/// 6.07 as chosen: 1.5624 and 6.20 at 0.5; 1.5624 and 5.97 at 0.9.
pub(super) const SMALL_ERROR: f64 = 0.7;
/// Under maps of low degree, errors below this fraction are accepted by eight samples. Pieces per segment at 0.001 and
/// evaluations, 1.5624 and 6.07 as chosen: 1.5628 and 6.23 at 0.4; 1.5624 and 5.86 at 0.85.
pub(super) const EIGHT_ACCEPTED: f64 = 0.6;
/// Growth of such errors between the samples. Pieces per segment at 0.001 and evaluations, 1.5624 and 6.07 as chosen: 1.5624
/// and 6.07 at 1; 1.5624 and 6.06 at 1.3.
pub(super) const EIGHT_GROWTH: f64 = 1.1;
/// Accept a fit whose predicted peak error is below this fraction of the tolerance.
pub(super) const PEAK_ACCEPTED: f64 = 0.97;
/// Growth beside a sample, relative to the parabola through it and its neighbours; halfway samples take half of it.
pub(super) const PEAK_FACTOR: f64 = 2.5;
/// An error halfway between two samples that differs from their mean by more than this fraction of the tolerance was not
/// predictable: sample densely.
pub(super) const SURPRISE: f64 = 0.3;
/// Halfway samples at most; if more are needed, sample densely.
pub(super) const MAX_HALFWAY: usize = 16;
/// Largest ratio of squared sample distances at which sixteen samples resolve the image.
pub(super) const PACE_SIXTEEN: f64 = 100.0;
/// The same for eight samples.
pub(super) const PACE_EIGHT: f64 = 25.0;
/// The same for acceptance by eight samples alone.
pub(super) const PACE_EASY: f64 = 6.25;
/// Foot points may be this far, in parameter, from those of even pace.
pub(super) const FOOT_LEAD: f64 = 0.18;
/// Longest step between foot points, in sample spacings: a leap hides a corner of the distance.
pub(super) const FOOT_STEP: f64 = 1.6;
/// Fraction of the tolerance that densely sampled errors may reach; the rest is for what lies between 64 samples.
pub(super) const DENSE_ACCEPTED: f64 = 0.995;
/// Batches of eight samples in the dense check.
pub(super) const DENSE_BATCHES: usize = 8;
/// Subdivisions by eight where the cubic turns between foot points.
pub(super) const WALK_DEPTH: u32 = 2;
/// Foot points in order up to this rounding, in parameter.
pub(super) const FOOT_ROUNDING: f64 = 1e-9;
/// Squared samples below this fraction of the largest are not zoomed into.
pub(super) const PEAK_NEAR: f64 = 0.64;
/// A zoom continues while the maximum rises by this factor.
pub(super) const ZOOM_RISE: f64 = 1.001;
/// Zooms at most.
pub(super) const MAX_ZOOMS: usize = 4;
/// Samples each way of the thorough check.
pub(super) const THOROUGH_SAMPLES: usize = 160;
/// Growth of errors between samples of pieces over several segments, whose residual has corners.
pub(super) const JOINT_GROWTH: f64 = 1.015;
/// Factor on the measured error of a piece that the budget leaves above the tolerance.
pub(super) const REPORT_MARGIN: f64 = 1.05;
/// A piece is sharp if its pace varies by more than this factor.
pub(super) const SHARP_PACE: f64 = 6.0;
/// The image has a cusp where it is slower than this fraction of the mean.
pub(super) const CUSP_SPEED: f64 = 0.1;
/// Cusps closer to an end than this belong to the end.
pub(super) const CUSP_MARGIN: f64 = 1e-4;
/// Attempts per segment: the budget that bounds the work on hostile input.
pub(super) const MAX_ATTEMPTS: usize = 2000;
/// Stretches shorter than this, in parameter, are not split further.
pub(super) const MIN_STRETCH: f64 = 1e-8;
/// Pieces placed together at most; longer plans are split.
pub(super) const MAX_PLANNED: usize = 8;
/// Smallest error ÷ tolerance that counts as difficulty.
pub(super) const MIN_RELATIVE_ERROR: f64 = 1e-3;
/// Largest error ÷ tolerance that counts: its sixth root is eight pieces. Also assumed where nothing is known.
pub(super) const MAX_DIFFICULTY: f64 = 2.6e5;
/// Placements of break points tried before one piece more is used.
pub(super) const PLACEMENTS: usize = 3;
/// If difficulties add up to more than this fraction of the pieces, other placements do not help.
pub(super) const FULL: f64 = 0.995;
/// But break points may be moved one by one up to this fraction: the sixth order is that of the leading term, which vanishes
/// somewhere on many curves.
pub(super) const REPAIRABLE: f64 = 1.15;
/// For the same reason, only this fraction of the predicted difficulty of a long piece is believed.
pub(super) const HOPE: f64 = 0.8;
/// Bisections of a break point.
pub(super) const BISECTIONS: usize = 5;
/// A break point closer to a tried one than this fraction of the remaining interval teaches nothing.
pub(super) const BISECTION_MARGIN: f64 = 0.1;
/// Joints that turn by less than this, in radians (half a degree), are smooth: drawings round their coordinates.
pub(super) const SMOOTH_JOINT: f64 = 0.0087;
/// Places per segment at which a merged piece may begin or end.
pub(super) const MERGE_GRID: usize = 6;
/// Segments under one merged piece at most; the dense check then has ten samples in each.
pub(super) const MAX_SPAN: usize = 6;
/// Segments in one run at most.
pub(super) const MAX_RUN: usize = 64;
/// Stretches that fail in a row before longer ones are left out.
pub(super) const MERGE_PATIENCE: usize = 2;
/// Fraction of the tolerance for merged pieces: jumps of curvature at joints put corners of the error between samples.
pub(super) const MERGE_SHARE: f64 = 0.97;
/// Searches in one run.
pub(super) const MERGE_SEARCHES: usize = 4;
/// Intervals of a segment's table of lengths.
pub(super) const LENGTH_TABLE: usize = 16;
/// Samples of the dense check in each segment of a merged piece.
pub(super) const PLACES_PER_SEGMENT: usize = 64;
/// Bounds further off than this factor of the tolerance are not improved by the longest proof.
pub(super) const LONG_PROOF_WITHIN: f64 = 3.0;
/// Nor are measured errors above this fraction of the tolerance: the longest proof loses more than the rest.
pub(super) const LONG_PROOF_ERROR: f64 = 0.97;
/// A piece whose denominator is uncertain by this fraction between nodes is split instead of proven.
pub(super) const MAX_DENOMINATOR_VARIATION: f64 = 0.1;
/// Where the reparametrisation nearly stops, its correction may cost this fraction of the tolerance.
pub(super) const STOPPING_COST: f64 = 0.3;
/// Rounding of the samples of a proof, relative to their coordinates.
pub(super) const PROOF_ROUNDING: f64 = 1e-14;
/// Rounding allowed in the coefficients of the reparametrisation.
pub(super) const RANGE_ROUNDING: f64 = 1e-9;
