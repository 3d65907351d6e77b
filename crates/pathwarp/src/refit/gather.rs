//! Samples announced in batches, for maps of which each call is expensive, such as those of another program.
//!
//! The fitter asks for eight values or one jet at a time. Most of its questions are known long before: the jets at all nodes and
//! sixteen samples of each segment, the samples of a run to be merged, and those of all parts of a stretch once its break points are
//! placed. They are announced here to the memory in front of the map (`map::Gathered`), which asks for them in one batch. The points
//! are the ones that the fitter asks for, bit by bit, so that the result is the same as without; what was not announced is asked
//! singly.

use super::lanes::Lane;
use super::options::Options;
use super::samples::{CHECKED, FITTED, spaced};
use super::source::SourceCurve;
use super::split;
use crate::map::Map;
use crate::outline::Seg;
use kurbo::Point;

/// Announces the nodes and the sixteen samples of every segment.
pub(super) fn announce_segments<'a>(segs: impl Iterator<Item = &'a Seg>, map: &dyn Map, options: &Options) {
    let (mut points, mut jets) = (Vec::new(), Vec::new());
    for seg in segs.filter(|s| s.is_finite()) {
        jets.extend([seg.start(), seg.end()]);
        let (canonical, _) = split::canonical(seg);
        let source = SourceCurve::for_proof(&canonical, map, options.certify);
        samples(&source, [&FITTED, &CHECKED].map(|set| spaced(0.0, 1.0, set)), &mut points);
    }
    // Each segment begins where the one before ends.
    jets.dedup();
    map.prepare(&points, &jets);
}

/// Announces values of one curve at `lanes`, and jets at `ends`.
pub(super) fn announce(
    source: &SourceCurve<'_>,
    lanes: &(impl Iterator<Item = Lane> + Clone),
    ends: &(impl Iterator<Item = f64> + Clone),
) {
    if source.map.prefers_batches() {
        announce_all(source.map, std::slice::from_ref(source), lanes, ends);
    }
}

/// The same for each of several curves.
pub(super) fn announce_all(
    map: &dyn Map,
    sources: &[SourceCurve<'_>],
    lanes: &(impl Iterator<Item = Lane> + Clone),
    ends: &(impl Iterator<Item = f64> + Clone),
) {
    let (mut points, mut jets) = (Vec::new(), Vec::new());
    for source in sources {
        samples(source, lanes.clone(), &mut points);
        jets.extend(ends.clone().map(|t| source.at(t)));
    }
    map.prepare(&points, &jets);
}

/// Announces values at eight parameters of each of several curves.
pub(super) fn announce_each<'a, 's: 'a>(map: &dyn Map, lanes: impl Iterator<Item = (&'a SourceCurve<'s>, Lane)>) {
    let mut points = Vec::new();
    lanes.for_each(|(source, t)| samples(source, [t], &mut points));
    map.prepare(&points, &[]);
}

/// Announces the break points `places` of the stretch from `first` to `last`, and sixteen samples of each part.
pub(super) fn announce_parts(
    source: &SourceCurve<'_>,
    first: f64,
    places: &(impl Iterator<Item = f64> + Clone),
    last: f64,
) {
    if !source.map.prefers_batches() {
        return;
    }
    let starts = std::iter::once(first).chain(places.clone());
    let ends = places.clone().chain([last]);
    let parts = starts.zip(ends).flat_map(|(a, b)| [&FITTED, &CHECKED].map(|set| spaced(a, b - a, set)));
    announce(source, &parts, places);
}

fn samples(source: &SourceCurve<'_>, lanes: impl IntoIterator<Item = Lane>, out: &mut Vec<Point>) {
    for t in lanes {
        let g = source.points(&t);
        out.extend(g.x.iter().zip(&g.y).map(|(x, y)| Point::new(*x, *y)));
    }
}
