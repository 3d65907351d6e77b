//! Thresholds of the refit.
//!
//! Each entry says what the threshold trades, the figure it was chosen by, and the test that fails if it is moved too far.
//! Constants that are pure mathematics (nodes, growth factors of polynomials) stay where they are used.
//!
//! Unless a figure names its source, it is the change over the sample of `tests/geometry/figures.rs` at tolerances 1, 0.1, 0.01 and
//! 0.001 together, if this threshold alone is set to the value given: "0.3: +1.1 % pieces, −0.2 % work". Work is counted in
//! calls of the map. An unchanged output at both ends of the range is reported as such.
//!
//! *Figures* stands for the tests `…stay_at_their_figures` of that file, *sample* for `the_sample_stays_within_the_tolerance`
//! there. Other tests are named: those of `tests/geometry/random.rs` as `random::…`, of `tests/geometry/limits.rs` as `limits::…`, of
//! `refit.rs` and `report.rs` beside them as `refit::…` and `report::…`.

// Subpaths

// Segments

/// Below this share of its usual size a derivative is rounding and gives no direction. Figures are unchanged from 0 to 1e-7.
/// Tests: `limits::a_handle_of_rounding_length_has_no_direction` (at 0); *figures* (at 0.1).
pub const VANISHING_DERIVATIVE: f64 = 1e-9;

/// Distance, as a share of the segment, at which a one-sided tangent is taken where all derivatives vanish. Far above rounding;
/// the direction is off by about the same number of radians, a five-hundredth of the 0.01° to which joints are kept smooth.
/// Test: `limits::the_tangent_at_a_cusp_of_the_image_is_its_limit` (at 1e-15 and 0.5).
pub(crate) const ONE_SIDED_STEP: f64 = 3e-7;

/// A minimum of the source's speed counts as a slow spot below this share of the mean. The radius of curvature goes with the
/// cube of the speed; at a third of it, samples a sixteenth apart still resolve the turn. Higher: more splits (0.45: +1.1 %
/// pieces). Lower: more dense checks and searches (0.2: −0.5 % pieces, +4.6 % work).
/// Tests: *figures* (at 0.2 and 0.45); `split::tests::a_cusp_is_found_and_a_round_curve_has_none` (at 0).
pub(crate) const SLOW_SPEED: f64 = 0.3;

/// A slow spot closer than this share to an end of the stretch is not split off: the part would be lost in rounding. Unchanged
/// from 1e-8 to 1e-4.
/// Test: *figures* (at 0 and 0.4).
pub(crate) const SLOW_MARGIN: f64 = 1e-6;

// Lines

/// An image is straight if it stays within this share of its size of its chord: invisible at any scale. Figures are unchanged
/// from 1e-10 to 1e-8.
/// Test: `refit::images_straight_to_rounding_become_lines` (at 0 and 1).
pub(crate) const STRAIGHT_SIZE: f64 = 1e-9;

/// … and within this share of the tolerance, so that lines leave the rest to other errors. Figures are unchanged from 1e-4 to
/// 1e-2.
/// Test: `refit::images_straight_to_rounding_become_lines` (at 0 and 1).
pub const STRAIGHT_TOLERANCE: f64 = 1e-3;

/// Rounding of a coordinate after a map's arithmetic, relative to the coordinate: some twenty operations. Added to the distance
/// allowed for a line.
/// Tests: `limits::lines_far_from_the_origin_remain_lines` (at 0); `refit::images_straight_to_rounding_become_lines` (at 1e-6).
pub(crate) const IMAGE_ROUNDING: f64 = 4e-15;

/// Rounding of sample differences relative to the piece's size, for maps with more arithmetic than [`IMAGE_ROUNDING`] covers.
/// Tests: `limits::rounding_inside_a_map_keeps_lines` (at 0); `refit::images_straight_to_rounding_become_lines` (at 1e-6).
pub(crate) const SAMPLE_ROUNDING: f64 = 1e-12;

/// Tangents within this many radians of the chord make no corner with it: far below the 0.01° to which joints are kept smooth.
/// Tests: `refit::images_straight_to_rounding_become_lines` (at 0); `report::misfits_are_reported_with_their_place` (at 10).
pub const STRAIGHT_TURN: f64 = 1e-6;

// Fit

/// Within this share of its size, an image is its Hermite cubic to rounding. Unchanged from 1e-13 to 1e-9.
/// Tests: `refit::the_identity_gives_every_segment_back` (at 0); *sample* (at 1).
pub(crate) const EXACT_HERMITE: f64 = 1e-11;

/// Shortest handle of a fit, as a share of the piece's size. A handle of zero length loses the tangent; a high floor excludes
/// good fits (1e-2: +0.04 % pieces).
/// Test: *figures* (at 0, by a hair, and at 10).
pub(crate) const HANDLE_FLOOR: f64 = 1e-3;

/// The same where the image stops at the end, so that Hermite's handle is zero and the fit starts from here. 1e-3: +0.3 %
/// certified pieces.
/// Tests: `limits::the_tangent_at_a_cusp_of_the_image_is_its_limit` (at 1e-300); *figures* (at 1).
pub(crate) const HANDLE_FLOOR_STOPPED: f64 = 1e-5;

/// A handle that differs from Hermite's by the piece's size counts like a residual of this share of the tolerance. Without the
/// pull, nearly straight pieces leave the handles undetermined; a strong one raises the error. 0.02 and 0.12: within 0.1 % of
/// pieces.
/// Test: *figures* (at 1e3; at 0 nothing fails).
pub(crate) const HANDLE_PULL: f64 = 0.05;

/// Relative damping of the normal equations: just enough to keep the two by two system from being singular. 1e-3: +6.5 %
/// pieces. At 0, where [`HANDLE_PULL`] alone keeps it regular, no test fails: a safeguard without a measured effect.
/// Test: *figures* (at 1).
pub(crate) const DAMPING: f64 = 1e-11;

/// Longest Gauss–Newton step, as a share of the piece's size. Longer ones overshoot the valley; shorter ones need more
/// evaluations. Without a limit: +0.9 % pieces, +1.7 % work.
/// Test: *figures* (at 1e-6 and 1e6).
pub(crate) const TRUST_RADIUS: f64 = 0.15;

/// Evaluations of one fit. Each costs 445 instructions (docs/benchmarks.md). Fits take 3.2 on average there; 4: up to 0.8 %
/// more pieces; 100: −0.1 %.
/// Test: *figures* (at 1; at 100 for certified work).
pub(crate) const MAX_EVALUATIONS: usize = 6;

/// A step that promises to lower the sum of squares by less than this share is not taken. 0: −0.1 % pieces, +0.8 % work, with
/// merging +3.1 %.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const MIN_GAIN: f64 = 0.1;

/// After four evaluations, a fit above this multiple of the tolerance ends: it only has to predict the number of pieces. 0:
/// +0.1 % pieces; without a limit: −0.1 % pieces, +0.1 % work.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const FAR_MISS: f64 = 6.0;

/// Evaluations after which the next step's promise predicts the residual reached, if it is below [`PROMISE_GAIN`]; one
/// evaluation later it always does. Giving up after two instead of five saved an eighth of the time at 0.001 and cost up to 1 %
/// of segments (docs/benchmarks.md, first version); after three with the condition on the promise it saved 4 to 10 % of
/// instructions and cost none. 1: +1.7 % pieces.
/// Test: *figures* (at 1 and 100).
pub(crate) const PROMISE_AFTER: usize = 3;

/// See [`PROMISE_AFTER`]: larger promises are not yet reliable. 0.25 and 0.9: −0.03 % and +0.2 % pieces on icons at 0.01.
/// Test: *figures* (at 0 for proven work, and at 1e9).
pub(crate) const PROMISE_GAIN: f64 = 0.5;

/// A fit predicted to leave more than this multiple of the tolerance is given up. On the strong map: instructions per segment
/// from 12,338 to 11,547 at 0.001 and from 7,415 to 6,645 at 0.01, no row with more segments (docs/benchmarks.md, first
/// version). Never: +0.4 % pieces; at once: +1.1 % pieces, +4.1 % work.
/// Test: *figures* (at 0.01 and 1e9).
pub(crate) const GIVE_UP: f64 = 2.0;

/// A fit with an error below this share of the tolerance is not improved further. Lower: more evaluations, less to check;
/// higher: more that are rejected and fitted again. 0: −0.4 % pieces checked, +0.9 % certified; without: +0.15 % and +0.4 %.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const GOOD_ENOUGH: f64 = 0.85;

// Fits over several segments: figures are those of merging

/// Evaluations of a fit over several segments, which does not give up early: its error decides where to look next. 6: +0.1 to 0.2 %
/// pieces; 20: −0.05 %.
pub(crate) const RUN_EVALUATIONS: usize = 10;

/// The trust radius of such a fit; see [`TRUST_RADIUS`]. 0.15: +0.4 % pieces at 1.
pub(crate) const RUN_TRUST_RADIUS: f64 = 1.0;

// Further attempts

/// Restart a fit along the valley if its error is within this multiple of the tolerance. Restarts within 2 instead of 3 saved
/// up to a tenth of the time and cost a quarter of a percent of segments (docs/benchmarks.md, first version). None: +0.6 %
/// pieces; always: −0.9 % pieces, +0.1 % work.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const RESTART_WITHIN: f64 = 3.0;

/// The same for pieces that turn by more than [`RESTART_TURN`], on which restarts seldom find another minimum. None: +0.1 %
/// pieces; always: −0.4 % pieces, +0.7 % work.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const RESTART_WITHIN_TURNED: f64 = 1.2;

/// Cosine of the turn from end to end, 50°, beyond which a piece turns much. −2 (all pieces turn little): −0.2 % pieces, +0.2 %
/// work; 2: +0.45 % pieces.
/// Test: *figures* (at −2 and 2).
pub(crate) const RESTART_TURN: f64 = 0.643;

/// Factors of the first handle in restarts, the one towards even handles first. 1 or 100 instead: +0.2 and +0.3 % pieces.
/// Test: *figures* (at 1 and 100).
pub(crate) const RESTART_LONGER: f64 = 1.45;

/// See [`RESTART_LONGER`]. 0.01 or 1 instead: +0.3 and +0.2 % pieces.
/// Test: *figures* (at 0.01 and 1).
pub(crate) const RESTART_SHORTER: f64 = 0.69;

/// A restart must reach less than this share of the best error to be judged, which may take a dense check. 0 (none succeeds):
/// +0.75 % pieces; 1e9 (all are judged): +0.4 % work, with merging +3.4 %.
/// Test: *figures* (at 0; at 1e9 for work).
pub(crate) const RESTART_GAIN: f64 = 0.98;

/// Try a minimax fit if the error is within this multiple of the tolerance. Least squares is within 5 % of minimax to leading
/// order, more where the error has another form. None: +0.4 % pieces, −2.3 % work; always: −0.5 % pieces, +5.3 % work.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const MINIMAX_WITHIN: f64 = 1.4;

/// Steps of a minimax fit, which converges quadratically. 2: +0.06 % pieces of smooth paths, −0.8 % work with merging; 4: unchanged.
pub(crate) const MINIMAX_STEPS: usize = 3;

/// A minimax fit ends where its next step would leave more than this multiple of the tolerance. 1.1: unchanged, +0.9 % work with
/// merging.
pub(crate) const MINIMAX_HOPE: f64 = 1.02;

/// Exchanges of one sample in a step, which usually ends by itself after two or three.
pub(crate) const MAX_EXCHANGES: usize = 8;

// Acceptance by samples

/// A normal residual is the distance up to κδ²/2, with δ the way that the foot point still has to go. Below this share of the
/// tolerance the difference is ignored (κ taken as the inverse of the piece's size, δ as a share of it). Only Hermite cubics
/// depend on it much; 0: unchanged to 0.02 %.
/// Test: *figures* (at 1e9).
pub(crate) const FOOT_DRIFT: f64 = 0.02;

/// Below this share of the tolerance an error is small: between sixteen samples, a residual of the leading form
/// s²(1−s)²((s−½)²−c) exceeds its samples by 4 %, others by little more. Limits the predicted peak of uneven or opaque maps,
/// and Hermite cubics. 0: +37 % work; 1: −3.4 % work and errors above the tolerance.
/// Tests: *figures* (at 0); *sample* (at 1).
pub(crate) const SMALL_ERROR: f64 = 0.7;

/// Accept by eight samples alone an error below this share of the tolerance, if the map is a quotient of polynomials of low
/// degree. 0: +4.6 % work; 10: −6.3 % work and errors above the tolerance.
/// Tests: *figures* (at 0); *sample* (at 10).
pub(crate) const EIGHT_ACCEPTED: f64 = 0.6;

/// Factor from the error at eight samples to the one reported. It must stay below 1/[`EIGHT_ACCEPTED`].
/// Test: *figures* (at 100). At 0 no test fails: it decides nothing, and the oracle is exact only above 0.9 of the tolerance.
pub(crate) const EIGHT_GROWTH: f64 = 1.1;

/// Accept a fit whose predicted peak error is below this fraction of the tolerance. 0: +62 % work, from dense checks; 1e9: −2.6
/// % work, and +0.6 % pieces, as the prediction itself exceeds the tolerance.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const PEAK_ACCEPTED: f64 = 0.97;

/// Excess of an error over its samples relative to that of a parabola through them: corners and faster oscillations rise more.
/// Raised from 1.7 when a random test found a residual that oscillates over six samples: its peaks rise twice as far as the
/// parabolas. 0: −2 % work; 1e3: +63 % work.
/// Tests: *sample* (at 0); *figures* (at 1e3).
pub(crate) const PEAK_FACTOR: f64 = 2.5;

/// An error halfway between two samples that is farther from their mean than this share of the tolerance shows that sixteen
/// samples do not resolve the error. 0: +14 % work; without: unchanged on the sample. Found necessary by random tests.
/// Tests: *figures* (at 0); `halfway::tests::an_error_halfway_that_its_neighbours_do_not_predict_resolves_nothing` (at 1e9).
pub(crate) const SURPRISE: f64 = 0.3;

/// Samples taken halfway: two batches. With more gaps in doubt than that, the dense check is not much dearer. 8: +4 % work; 18:
/// unchanged.
/// Test: *figures* (at 8).
pub(crate) const MAX_HALFWAY: usize = 16;

/// Largest ratio of speeds along a piece, squared, for which sixteen samples suffice (tenfold). 1: +63 % work; without: −0.6 %
/// work and errors between samples.
/// Tests: *figures* (at 1); `random::errors_between_the_samples_are_seen` (at 1e18).
pub(crate) const PACE_SIXTEEN: f64 = 100.0;

/// The same for eight samples, and for trusting peaks predicted from sixteen (fivefold): an image that slows down more may turn
/// between two samples. 1: +34 % work; without: −2.7 %.
/// Tests: *figures* (at 1); `resolution::tests::uneven_speed_is_seen` (at 1e18).
pub(crate) const PACE_EIGHT: f64 = 25.0;

/// The same for a least-squares fit accepted by eight samples (two and a half times). 1: +4.4 % work; without: −1.2 % and
/// errors between samples.
/// Tests: *figures* (at 1); `random::errors_between_the_samples_are_seen` (at 1e18).
pub(crate) const PACE_EASY: f64 = 6.25;

/// Largest distance of a foot point from its sample's own parameter; three spacings. Farther ones mean that the cubic's speed
/// differs much from the image's. 0: +103 % work; without: −0.2 %.
/// Tests: *figures* (at 0); `resolution::tests::foot_points_far_from_even_ones_are_not_resolved` (at 1e9).
pub(crate) const FOOT_LEAD: f64 = 0.18;

/// Longest step between consecutive foot points, in spacings. A longer one means that image or cubic nearly stops in between.
/// 0: +62 % work; without: −2.1 %. Found necessary by random tests: with the other closer checks it lowered their failures from
/// one in 30,000 to 60,000 cases, by up to 37 %, to one in 200,000, by 3 %, for 4 to 10 % of the time at 1 and 0.1
/// (docs/benchmarks.md).
/// Tests: *figures* (at 0); `resolution::tests::foot_points_that_leap_are_not_steady` (at 1e9).
pub(crate) const FOOT_STEP: f64 = 1.6;

// Dense checks

/// Accept a densely measured error up to this share of the tolerance; the rest is for errors between 64 samples with parabolas
/// through them. 0.5: +4.2 % pieces. Without, the largest error on the sample would be the tolerance itself: −0.03 % pieces,
/// and no test fails. The largest error over 23,596 icon segments is 0.995 of the tolerance (docs/benchmarks.md).
/// Test: *figures* (at 0.5).
pub(crate) const DENSE_ACCEPTED: f64 = 0.995;

/// Batches of eight samples in a dense check. 4: −5 % work; 16: +10 % work. With a single batch no test fails, since zooming in
/// finds the maxima; the others are a margin for maps unlike the tested ones.
/// Test: *figures* (at 16).
pub(crate) const DENSE_BATCHES: usize = 8;

/// Batches of eight more samples in a dense check, where the cubic turns by more than 60° between two. Beyond it the thorough check
/// decides, which takes as long as about a hundred batches.
pub(crate) const MAX_CLOSER: usize = 24;

/// Foot points this close count as in order. −1 (never in order): +2.7 % work, from thorough checks. 1 (always): −0.1 % work
/// and no test fails, as a cubic that runs back turns by more than 60° too.
/// Test: *figures* (at −1).
pub const FOOT_ROUNDING: f64 = 1e-9;

/// A sample whose square is below this share of the largest (0.8 of the error) is not sampled more closely. 0: +1.6 % work; 2
/// (none is): −4 % and errors between samples.
/// Tests: *figures* (at 0); `random::errors_between_the_samples_are_seen` (at 2).
pub(crate) const PEAK_NEAR: f64 = 0.64;

/// Zoom in on a maximum as long as each level raises the error by this factor. 0 (always): +5 % work; 1e9 (once only): −0.5 %
/// work and no test fails.
/// Test: *figures* (at 0).
pub(crate) const ZOOM_RISE: f64 = 1.001;

/// Levels of that zoom, each four times as close: 1/16,384 of the piece. 0: −4 % work and errors between samples; 30: +0.01 %
/// work.
/// Test: `random::errors_between_the_samples_are_seen` (at 0).
pub(crate) const MAX_ZOOMS: usize = 4;

/// Samples of the thorough check in each direction, so that Newton's method starts close enough. 8: errors between the samples;
/// 2000: more work.
/// Tests: `random::errors_between_the_samples_are_seen` (at 8); *figures* (at 2000).
pub(crate) const THOROUGH_SAMPLES: usize = 160;

/// Factor from a checked error to the one reported, up to the tolerance, for errors between samples. It decides no acceptance.
/// Test: *sample* (at 0.5 and 1), which compares reported with true errors.
pub(crate) const REPORT_MARGIN: f64 = 1.05;

// Cusps

/// Search for a cusp if the speed along a piece that misses varies by this factor. 0 (always): +96 % work; 1e9 (turns of 60°
/// only): −2.7 %, pieces unchanged.
/// Test: *figures* (at 0).
pub(crate) const SHARP_PACE: f64 = 6.0;

/// The image has a cusp where its speed falls below this share of the mean. Splitting there costs a piece that nothing else
/// needs if it is none (1e9: +0.7 % pieces). 0 (no search): −26 % work with unchanged pieces on the sample: without a split,
/// bisection approaches the cusp.
/// Test: *figures* (at 1e9).
pub(crate) const CUSP_SPEED: f64 = 0.1;

/// A cusp closer than this share to an end is that end's own. 0: endless splits; 0.5: no split at all, +0.2 % work.
/// Tests: *sample* and *figures* (at 0).
pub(crate) const CUSP_MARGIN: f64 = 1e-4;

// Break points

/// Attempts on one smooth part of a segment. Lower: parts that could be fitted go over budget; higher: more time at a jump that
/// no map declares. The sample needs less; 200,000: unchanged.
/// Tests: *sample* and *figures* (at 1); `report::the_budget_ends` bounds the pieces.
pub(crate) const MAX_ATTEMPTS: usize = 2000;

/// Shorter stretches of the parameter are not split. Bounds the attempts at a jump: 27 halvings.
/// Tests: `report::misfits_are_reported_with_their_place` (at 0); *sample* (at 0.5).
pub(crate) const MIN_STRETCH: f64 = 1e-8;

/// Pieces planned at once; a stretch that needs more is divided again. 4: +5.3 % pieces, −8.8 % work; 16: −0.1 % pieces, +0.2 %
/// work (certified −0.8 %, +1.3 %).
/// Test: *figures* (at 4 and 16).
pub(crate) const MAX_PLANNED: usize = 8;

/// Least error relative to the tolerance in a difficulty: a sixth root of 0.32, so that a piece never counts as free. 1: +3.2 %
/// pieces; 0: unchanged.
/// Test: *figures* (at 1).
pub(crate) const MIN_RELATIVE_ERROR: f64 = 1e-3;

/// Largest error relative to the tolerance in a difficulty: a sixth root of 8, [`MAX_PLANNED`] pieces; also if no error is
/// known. 1.5: +17 % work; without: +1 % certified pieces.
/// Test: *figures* (at 1.5; at 1e300 for proofs).
pub(crate) const MAX_DIFFICULTY: f64 = 2.6e5;

/// Placements of the break points tried with one number of pieces. 1: +1.2 % pieces, −2.3 % work; 100: −0.1 % pieces, +4.2 %
/// work. With one placement, no restarts and no bisection the time at 0.001 falls by a third and segments rise by 8 %
/// (docs/benchmarks.md).
/// Test: *figures* (at 1 and 100).
pub(crate) const PLACEMENTS: usize = 3;

/// If the difficulties add up to more than this share of the pieces, another placement does not help. 0: +1.2 % pieces, −2.3 %
/// work; 1e9: −0.9 % pieces, +16 % work.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const FULL: f64 = 0.995;

/// Move single break points if the difficulties add up to less than this share of the pieces: the leading term of the error
/// vanishes somewhere on many curves. 0 (never): +3 % pieces, −10 % work; 1e9: −0.2 % pieces, +1.5 % work.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const REPAIRABLE: f64 = 1.15;

/// Share of the difficulty of long pieces that is believed, for the same reason: fewer pieces are tried first. 0.01: −0.35 %
/// pieces, +5.6 % work; 10: +144 % pieces.
/// Test: *figures* (at 0.01 and 10).
pub(crate) const HOPE: f64 = 0.8;

/// Bisection steps for one break point. 0: +3 % pieces, −10 % work; 100: −0.3 % pieces, +2.2 % work.
/// Test: *figures* (at 0 and 100).
pub(crate) const BISECTIONS: usize = 5;

/// A trial place closer than this share of the interval to one already tried is replaced by the middle. 0: −0.1 % pieces, −0.8
/// % work, but more pieces at single tolerances; 0.5 (always the middle): +1.3 % work.
/// Test: *figures* (at 0 and 0.5).
pub(crate) const BISECTION_MARGIN: f64 = 0.1;

// Proofs: figures are those of certified pieces

/// Skip the longest proof of a polynomial image if the bound by thirty-two samples is above this multiple of the tolerance.
/// Always: +0.2 % pieces and work, as proofs of pieces near their limit are worth less than smaller pieces; 0 (never try it):
/// −1.6 % pieces, −0.8 % work.
/// Test: *figures* (at 1e300).
pub(crate) const LONG_PROOF_WITHIN: f64 = 3.0;

/// … or if the measured error is above this share of the tolerance: the longest proof loses more than the rest. 1e9: +0.3 %
/// pieces, +0.9 % work; 0: as for [`LONG_PROOF_WITHIN`].
/// Test: *figures* (at 1e9).
pub(crate) const LONG_PROOF_ERROR: f64 = 0.97;

/// Largest |VW − 1| of a cleared denominator; the bound is divided by one minus this. A denominator that varies more is split
/// instead. 0: no rational proof; 0.999: −0.2 % pieces, −0.8 % work. A limit for speed; the bound holds for any value below
/// one.
/// Test: *figures* (at 0).
pub(crate) const MAX_DENOMINATOR_VARIATION: f64 = 0.1;

/// Share of the tolerance that may be spent on a cubic's slope at an end at which the image stops. 0: +0.9 % work; 1e9: +2.2 %
/// pieces. The bound holds for any value.
/// Test: *figures* (at 0 and 1e9).
pub(crate) const STOPPING_COST: f64 = 0.3;

/// Rounding of samples, ends and slopes relative to their coordinates: 45 units in the last place. Added to every bound. 1e-3:
/// no proof succeeds. At 0 no test fails: the random proofs allow for 1e-12 of rounding in their own reference.
/// Test: *figures* (at 1e-3).
pub(crate) const PROOF_ROUNDING: f64 = 1e-14;

/// Margin by which φ's Bernstein coefficients must lie inside [0, 1], far above their rounding. 0.4: +6.1 % pieces. At −1, so
/// that φ may leave [0, 1], no test fails, since a fit close enough to be proven has foot points in order; but the bound would
/// no longer be a proof.
/// Test: *figures* (at 0.4).
pub(crate) const RANGE_ROUNDING: f64 = 1e-9;

/// Joints that turn by less than this are smooth: drawings round their coordinates. Radians (half a degree). 0: +19 % pieces.
/// Tests: *figures* (at 0); `limits::merging_keeps_corners_that_the_tolerance_would_hide` (at 10).
pub const SMOOTH_JOINT: f64 = 0.0087;

/// Joints that turn by more than this (as a tangent, a little above [`SMOOTH_JOINT`]) are corners at first sight, so that their
/// segments are not sampled. 0: +20 % pieces. At 1e9 nothing changes but the time.
/// Test: *figures* (at 0).
pub const SURE_CORNER: f64 = 0.009;

/// A line more than this many times as long as the next is an edge and no chord of a flattened curve. Flattened rounded rectangles keep
/// their sides; at 1, flattened ellipses keep most of their chords.
pub(crate) const LONG_EDGE: f64 = 8.0;

/// Places per segment at which a merged piece may end. 1: +7.6 % pieces, −56.9 % work; 4: +2.0 % pieces, −25.4 % work; 16: −1.7 % pieces, +29.6 % work.
/// Test: *figures* (at 1).
pub const MERGE_GRID: usize = 8;

/// A run of at least this many segments is searched again on a finer grid if it is one curve …
pub(crate) const LEAST_REFINED: usize = 6;

/// … whose curvature jumps by no more than this share, …
pub(crate) const EVEN_CURVATURE: f64 = 0.05;

/// … and if its pieces have fewer grid places than this. Circles of eight cubics under strong maps have up to a sixth fewer pieces.
pub(crate) const FEW_PLACES: usize = 24;

/// Share of a cubic's grid places to which its end is searched: the last of 64 or fewer exactly, of more as a share.
pub(crate) const FINEST_STEP: usize = 128;

/// Share of the tolerance for merged pieces, which leaves room between the samples. 0.1: +15 % pieces; 1: −0.05 %; 2: errors above
/// the tolerance.
/// Tests: *figures* (at 0.1); *sample* (at 2).
pub const MERGE_SHARE: f64 = 0.99;

/// Intervals between samples of a segment in a run, under a quotient of polynomials. A multiple of eight and of [`MERGE_GRID`].
pub(crate) const RATIONAL_SAMPLES: usize = 16;

/// … and under any other map, whose error may swing several times within a segment. 16: errors between the samples in one of 16,000
/// random cases.
/// Test: `merge_random::waves_shorter_than_a_segment_are_seen` (at 16).
pub(crate) const OPAQUE_SAMPLES: usize = 32;

/// Error of the best cubic for a curve whose curvature jumps by 1, per square of the shorter side: that of x²/2 right of zero and
/// 0 left of it, on −1..1, in the uniform norm. A joint with a larger jump than this allows is not crossed, so no fit is wasted
/// on it. 0: −0.03 % pieces, +27 % trials; 0.03: +0.5 % pieces, −15 % trials.
/// Test: *figures* (at 0.03 and 0).
pub(crate) const JUMP_ERROR: f64 = 0.0069;

/// Error ÷ tolerance that the next guess of a reach aims at, by the sixth-order law: a little too far, as interpolation comes
/// back faster than galloping goes on. Only the order of trials depends on it. 1.2: unchanged, +1.6 % trials; 3: unchanged, but text
/// takes 2 % longer.
/// Test: *figures* (at 0.3).
pub(crate) const REACH_TARGET: f64 = 5.0;

/// The same once a fit and a miss are known: between them the error's logarithm is taken as linear in that of the length.
/// A little too far again, as a fit ends once its error is small enough. 1 and 2: unchanged, within 0.5 % of trials.
pub(crate) const BETWEEN_TARGET: f64 = 1.2;

/// Steps of that kind before the interval is halved.
pub(crate) const INTERPOLATIONS: usize = 6;

/// Errors below this share of the tolerance are rounding to the guess of a reach, which then grows at most fivefold. 0.1: +0.2 %
/// work; 1e-12: unchanged.
pub(crate) const SMALLEST_REACH_ERROR: f64 = 1e-4;

/// A stretch interpolates its samples if those of the run are off the wanted places by more than this share of the spacing. 0
/// (always): −0.01 % pieces.
pub(crate) const COARSE: f64 = 0.6;

/// A check samples the run more closely where two samples are further apart than this share of the cubic's length: a little more than
/// the spacing in one segment of even speed, a sixteenth, so that a cubic over a long and a short segment needs no closer look.
/// Test: *sample* (at 1).
pub(crate) const COARSE_CHECK: f64 = 0.065;

/// Parts of a segment with fewer intervals than this have too few samples to show how their error bends: a cubic's ends have errors of
/// zero slope, so that the error may peak close beside a joint.
pub(crate) const SHORT_PART: usize = 4;

/// In such parts it may exceed its samples by this multiple of a parabola's excess, instead of by [`PEAK_FACTOR`]. At that one, one in a
/// thousand random runs had a piece with errors of up to 1.2 % above the tolerance.
/// Test: `merge_random::errors_between_a_joint_and_the_end_of_a_cubic_are_seen` (at 2.5).
///
/// [`PEAK_FACTOR`]: crate::refit::limits::PEAK_FACTOR
pub(crate) const SHORT_FACTOR: f64 = 6.0;

/// Between two samples at which the cubic's direction differs by more than this (as a tangent), its own distance from the image is
/// measured: elsewhere the two run side by side. 0: a check takes three times as long.
/// Test: `merge_random::bulges_of_the_cubic_between_foot_points_are_seen` (at 1e9).
pub(crate) const SHARP_TURN: f64 = 0.25;

/// Try a minimax fit over several segments if the error is within this multiple of the tolerance. 1.4, as for single segments: −0.02 %
/// pieces, on curves of evenly spaced nodes −0.2 %, and +5 % time; 1.15: +0.3 % pieces there, −2.4 % work.
pub(crate) const RUN_MINIMAX_WITHIN: f64 = 1.25;

/// Longer stretches are tried after a miss by less than this factor. 3: +0.04 % pieces, −4 % trials; 10: unchanged, +3.5 % trials.
/// Test: *figures* (at 1).
pub(crate) const LEAP_WITHIN: f64 = 5.0;

/// Number of places tried beyond the one that misses nearly. 3: −0.1 % pieces, but on curves of evenly spaced nodes +10 % work.
/// Test: *figures* (at 0).
pub(crate) const LEAPS: usize = 1;

/// Error recorded for a piece that failed the final check: a miss, but a near one. 1e9: unchanged.
pub(crate) const REFUSED_ERROR: f64 = 1.2;

/// Share of the tolerance above which the error of a cubic of a shape that comes again is brought down as far as possible: the error
/// grows a little when the cubic is carried.
pub(crate) const CARRY_BELOW: f64 = 0.7;

/// Segments for which eight samples of a carried cubic are taken.
pub(crate) const SEGMENTS_PER_BATCH: usize = 4;

// Quadratics

/// Samples for each piece of a quadratic spline, and twice as many for the shortest run.
pub(crate) const SPLINE_SAMPLES: usize = 16;

/// Rounds of a spline's fit, …
pub(crate) const SPLINE_ROUNDS: usize = 30;

/// … after this many of which the largest residual is brought down.
pub(crate) const SPLINE_WEIGHTED: usize = 5;

/// Share of the tolerance for errors of splines at and between their samples.
pub(crate) const SPLINE_ACCEPTED: f64 = 0.99;

/// Runs of more curves than this become few cubics first, so that circles of 100,000 cubics take linear time, …
pub(crate) const SPLINE_CURVES: usize = 16;

/// … within this share of the tolerance.
pub(crate) const SPLINE_FIRST: f64 = 0.05;
