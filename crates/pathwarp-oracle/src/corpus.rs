//! Paths of icons to measure with.

use kurbo::{BezPath, CubicBez, PathSeg};
use pathwarp::Outline;

/// The icon paths fetched by `cargo xtask corpus` and `true`, or a few built-in paths and `false`.
pub fn corpus() -> (Vec<Outline>, bool) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../corpus/icons.txt");
    match std::fs::read_to_string(file) {
        Ok(text) => (text.lines().map(Outline::from_svg_lossy).collect(), true),
        Err(_) => (BUILT_IN.iter().map(|d| Outline::from_svg_lossy(d)).collect(), false),
    }
}

/// Paths to use if the icons were not fetched.
const BUILT_IN: &[&str] = &[
    "M500 80C732 80 920 268 920 500S732 920 500 920 80 732 80 500 268 80 500 80ZM500 250C362 250 250 362 250 500S362 750 500 750 750 638 750 500 638 250 500 250Z",
    "M120 880V120H380C560 120 640 200 640 340 640 450 590 520 500 550L720 880H580L390 570H250V880ZM250 460H370C460 460 510 420 510 345S460 230 370 230H250Z",
    "M100 600C150 300 350 200 500 420 650 640 850 540 900 240L930 260C880 600 640 780 480 560 340 380 200 420 140 640Z",
    "M200 200H800A60 60 0 0 1 860 260V740A60 60 0 0 1 800 800H200A60 60 0 0 1 140 740V260A60 60 0 0 1 200 200Z",
    "M500 100Q900 100 900 500T500 900 100 500 500 100Z",
];

/// The segments of a path as cubics.
pub fn cubics(path: &BezPath) -> Vec<CubicBez> {
    path.segments()
        .map(|s| match s {
            PathSeg::Line(l) => CubicBez::new(l.p0, l.p0.lerp(l.p1, 1.0 / 3.0), l.p0.lerp(l.p1, 2.0 / 3.0), l.p1),
            other => other.to_cubic(),
        })
        .collect()
}
