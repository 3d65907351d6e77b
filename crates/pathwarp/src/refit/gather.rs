//! Samples announced in batches, for maps of which each call is expensive, such as those of another program.
//!
//! The fitter asks for eight values or one jet at a time. Most of its questions are known long before: the jets at all nodes and
//! sixteen samples of each segment, the samples of a run to be merged, and those of all parts of a stretch once its break points are
//! placed. They are announced to the memory in front of the map (`map::Gathered`), which asks for them in one batch. The points
//! are the ones that the fitter asks for, bit by bit, so that the result is the same as without; what was not announced is asked
//! singly.

use super::options::Options;
use super::source::SourceCurve;
use super::split;
use crate::map::Map;
use crate::outline::Seg;
use bezierfit::parts::{CHECKED, FITTED, spaced};

/// Announces the nodes and the sixteen samples of every segment.
pub(super) fn announce_segments<'a>(segs: impl Iterator<Item = &'a Seg>, map: &dyn Map, options: &Options) {
    let degree = map.rational_degree();
    let (mut points, mut jets) = (Vec::new(), Vec::new());
    for seg in segs.filter(|s| s.is_finite()) {
        jets.extend([seg.start(), seg.end()]);
        let (canonical, _) = split::canonical(seg);
        let source = SourceCurve::for_proof(&canonical, map, degree, options.certify);
        points.extend([&FITTED, &CHECKED].iter().flat_map(|set| source.sampled(&spaced(0.0, 1.0, set))));
    }
    // Each segment begins where the one before ends.
    jets.dedup();
    map.prepare(&points, &jets);
}
