//! SVG path data: any text is read or rejected, strict and lossy reading agree, and the path can be warped.
//!
//! The first byte chooses the map and the options.

#![no_main]

use pathwarp::refit::Nodes;
use libfuzzer_sys::fuzz_target;
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::distance::symmetric;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::map::AffineMap;
use pathwarp::param::{Args, Frame};
use pathwarp::refit::Options;
use pathwarp_fuzz::{bounded, check_map};

/// Most segments of a path that is warped and measured.
const MOST: usize = 40;

fn check(choice: u8, text: &str) {
    let lossy = Outline::from_svg_lossy(text);
    if let Ok(strict) = Outline::from_svg(text) {
        assert_eq!(format!("{strict:?}"), format!("{lossy:?}"));
    }
    for sub in &lossy.subpaths {
        let mut at = sub.start;
        for seg in &sub.segs {
            if seg.is_finite() && at.is_finite() {
                assert!(seg.start().distance(at) <= 1e-9 * (1.0 + at.to_vec2().hypot()), "{sub:?} is torn at {at:?}");
            }
            at = seg.end();
        }
    }
    let _ = (lossy.bounding_box(), lossy.subpaths.first().map(|s| s.reversed().anchors()));
    if lossy.segs().count() > MOST || !lossy.segs().all(pathwarp::Seg::is_finite) {
        return;
    }
    if let Some(d) = symmetric(&lossy, &lossy) {
        let size = lossy.bounding_box().map_or(0.0, |b| b.origin().to_vec2().hypot() + b.size().to_vec2().hypot());
        assert!(d <= 1e-6 * size || size > 1e100, "{d} from itself: {lossy:?}");
    }
    let frame = Frame::new(lossy.bounding_box().filter(Rect::is_finite).unwrap_or(Rect::new(0.0, 0.0, 100.0, 100.0)));
    let size = frame.rect.size().to_vec2().hypot().max(1e-3);
    let options = Options::new(size * [1e-2, 1e-4][usize::from(choice & 1)])
        .with_certify(choice & 2 != 0)
        .with_nodes(if choice & 4 != 0 { Nodes::Fewest } else { Nodes::Source });
    let name = ["swirl", "wave", "warp", "lens"][usize::from(choice >> 3) % 4];
    check_map(&lossy, &AffineMap(Affine::new([0.0, 2.0, 1.0, 0.5, 3.0, 4.0])), &options);
    let registry = Registry::builtin();
    let Some(entry) = registry.get(name) else { return };
    if let Ok(built) = entry.build_from(&Args::new(), &frame) {
        check_map(&lossy, &*built.map, &options);
    }
}

fuzz_target!(|data: &[u8]| {
    if let Some((&choice, text)) = data.split_first()
        && let Ok(text) = std::str::from_utf8(text)
    {
        bounded(|| check(choice, text));
    }
});
