//! Thresholds of the refit of paths. Figures are explained in the `limits` of the crate `bezierfit`, with the thresholds of the fit.

/// The number of segments refitted as one chunk. Memory for the jets and samples of a chunk is released after it.
pub(super) const CHUNK: usize = 1024;

/// Joints of the source that turn by more than this (as a tangent, ten degrees) are corners at which a chunk may end.
pub(super) const CHUNK_CORNER: f64 = 0.18;

/// The number of segments of a subpath for which several threads are started: two milliseconds of work.
#[cfg(feature = "parallel")]
pub(super) const WORTH_THREADS: usize = 4 * CHUNK;

/// A contour that an affine map moves keeps its nodes, unless it has more than this many times as many as it needs. 1: letters beside a
/// swirl lose nodes; without a limit, outlines of dashes there have twice as many pieces as elsewhere.
/// Test: `few_nodes::what_is_only_moved_keeps_its_nodes_unless_they_are_far_too_many` (at 1 and 1000).
pub(super) const MANY_NODES: usize = 2;

/// A segment whose control polygon is shorter than this, relative to its coordinates, is a point: differences of equal coordinates after
/// rounding. It becomes a line. Set to 0, no test changes, as `straight` recognises such segments too; set too high, it drops visible ones.
/// Test: `refit::the_identity_gives_every_segment_back` (at 1e-3).
pub(super) const POINT_SIZE: f64 = 1e-15;

/// Two sides of a crease closer than this share of the tolerance are joined, which spends that share; a wider gap is a tear and is bridged
/// by a line, which adds a piece. Test: `limits::a_tear_is_bridged_by_a_line_unless_it_is_rounding` (at 0 and 1e9).
pub(super) const TEAR: f64 = 0.01;

/// For a proof, arcs are cut into parts of at most this angle (a little over a third of a turn). As rational quadratics, longer arcs have
/// denominators that vary more, so that fewer bounds succeed; shorter ones cost pieces. Certified: 1.6: +0.2 % pieces, −1.6 % work; 2.9:
/// +1.3 % work. Tests: *figures* (at 0.2 and 7); `random::within_the_tolerance_under_bicubic_maps` (at 7).
pub(super) const MAX_RATIONAL_SWEEP: f64 = 2.2;

/// Derivatives above this share of their segment's chord, times the size of the Jacobian, decide whether a joint is smooth. Far above
/// `VANISHING_DERIVATIVE`, below which one-sided tangents decide. Unchanged at 0 and 1e9: the sample has no joint in between.
pub(super) const CLEAR_DERIVATIVE: f64 = 1e-6;

/// The number of segments of the longest run whose shape is remembered: some letters in one stroke.
pub(super) const MAX_SHAPE: usize = 64;

/// The number of shapes of runs that are remembered, in case they come again: two or three for each letter of an alphabet.
pub(super) const MAX_SHAPES: usize = 256;

/// The number of ways that are remembered for a shape: a map magnifies some sites more than others, which then need more pieces.
pub(super) const MAX_WAYS: usize = 3;

/// Where no cubics can be carried, a known shape is searched at one of this many sites, in case there is a better way by now. Text under a
/// gentle flag: 2: −1.1 % pieces, +7 % work; but where the map changes much along a line, twice the time.
pub(super) const SEARCH_AGAIN: usize = 8;

/// Control points of runs of the same shape differ by less than this share of the tolerance; letters are placed in single precision.
pub(super) const SAME_SHAPE: f64 = 0.05;

/// The number of ways of a shape that are remembered with their cubics, each for one Jacobian of the map.
pub(super) const MAX_CARRIED: usize = 24;

/// The number of sites from which cubics are carried to another, one after the other, until they suffice there.
pub(super) const CARRY_TRIALS: usize = 3;

/// Cubics are carried to another site if lengths there are at most this many times as long, in every direction …
pub(super) const CARRY_UP: f64 = 2.0;

/// … and at least this many times: where they are shorter, fewer cubics may do. 0.8: fewer sites are similar, pieces unchanged.
pub(super) const CARRY_DOWN: f64 = 0.5;

/// The turn (as a tangent) that tangents of a carried cubic may have beyond the change of the map where the run begins.
pub(super) const CARRIED_TURN: f64 = 0.2;

/// The assumed ratio of the largest difference between the samples of a carried cubic to that at the samples. 1: 5 % fewer runs are
/// fitted anew.
pub(super) const CARRY_MARGIN: f64 = 2.0;

/// The share of the tolerance by which an image may differ from the interpolation of its samples, by its enclosure.
pub(super) const HIDDEN: f64 = 0.25;

/// The share of the tolerance spent on turning arcs into cubics before an edit.
pub(crate) const ARCS: f64 = 0.05;
