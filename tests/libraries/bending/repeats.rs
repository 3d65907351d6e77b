//! Shapes that come again, as letters do: their cubics are moved from one to the next, and stay within the tolerance.

use pathwarp::Outline;
use pathwarp::engine::KnownShapes;
use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::map::{Class, Jet, Map};
use pathwarp::refit::{Nodes, Options, RefittedPath, warp_path};
use pathwarp_oracle::{Bicubic, Rational, Ripple};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Outlines of letters, with more nodes than they need: some joints are smooth, others corners.
const LETTERS: [&str; 3] = [
    "M6 5Q5.5 4.4 4.2 4.4 2.7 4.4 1.9 5.6 1 6.9 1 9.3 1 11.6 1.9 12.9 2.8 14.2 4.3 14.2 5.8 14.2 6.7 12.9 7.6 11.6 7.6 9.3 7.6 6.9 6.7 5.6 6.4 5.2 6 5Z",
    "M1 1L2.6 1 2.6 6Q3.4 4.9 4.8 4.7 6.2 4.5 7 5.4 7.8 6.3 7.8 8L7.8 14 6.2 14 6.2 8.1Q6.2 7 5.7 6.5 5.3 6 4.5 6 3.6 6 3.1 6.6 2.6 7.2 2.6 8.3L2.6 14 1 14Z",
    "M1 4C3 1 5 1 6 4 6.5 5.5 7 7 8 8 8.7 8.7 9 9.5 8.8 10.5 8.5 12 7 13 5 13 3.5 13 2.2 12.4 1.5 11.5 1.1 11 0.9 10 1 9Z",
];

/// Returns lines of text, one outline each. Positions are rounded as in single precision.
fn lines(count: usize) -> Vec<Outline> {
    let line = |k: usize| {
        let letters = (0..60).map(|i| {
            let at = Vec2::new(
                f64::from((20.0 + 16.0 * i as f64) as f32 * 1.000_1),
                20.0 + 24.0 * k as f64 + (i % 3) as f64,
            );
            Outline::from_svg(LETTERS[(i * 7 + k + i / 5) % 3]).unwrap().transformed(Affine::translate(at))
        });
        Outline { subpaths: letters.flat_map(|o| o.subpaths).collect() }
    };
    (0..count).map(line).collect()
}

fn maps() -> [Box<dyn Map>; 4] {
    [Box::new(Bicubic::mild()), Box::new(Bicubic::strong()), Box::new(Rational::new()), Box::new(Ripple(40.0))]
}

/// Compares every subpath of the result with the image of its source.
fn assert_within(line: &Outline, w: &RefittedPath, map: &dyn Map, tolerance: f64) {
    assert!(w.report.max_error <= tolerance && w.report.unresolved.is_empty());
    let out = Outline::from(&w.path);
    assert_eq!(out.subpaths.len(), line.subpaths.len());
    for (from, to) in line.subpaths.iter().zip(out.subpaths) {
        let written = Outline { subpaths: vec![to] }.to_bez_path(1e-9);
        let e = pathwarp_oracle::distance(&from.segs, map, &written, 60, tolerance);
        assert!(e <= 1.0001 * tolerance, "{tolerance}: {} for {from:?}", e / tolerance);
    }
}

#[test]
fn letters_stay_within_the_tolerance() {
    for map in &maps() {
        for tolerance in [1.0, 0.3, 0.1, 0.02] {
            let options = Options::new(tolerance).with_nodes(Nodes::Fewest);
            let lines = lines(40);
            let known = KnownShapes::among(&lines, map.as_ref(), &options);
            for line in lines.iter().skip(4).step_by(17) {
                assert_within(line, &warp_path(line, map.as_ref(), &options).unwrap(), map.as_ref(), tolerance);
                let with = known.warp_path(line, map.as_ref(), &options).unwrap();
                assert_within(line, &with, map.as_ref(), tolerance);
            }
        }
    }
}

/// A map that counts values and jets.
struct Counted<'a>(&'a dyn Map, AtomicUsize);

impl Map for Counted<'_> {
    fn jet(&self, p: Point) -> Jet {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.jet(p)
    }
    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.points(ps, out);
    }
    fn class(&self) -> Class {
        self.0.class()
    }
}

/// Compares letters refitted with known shapes to letters refitted one by one, in work and in pieces.
#[test]
fn letters_that_come_again_take_little_work_and_no_more_pieces() {
    let options = Options::new(0.3).with_nodes(Nodes::Fewest);
    // The strong map changes from letter to letter.
    for (map, less) in [(Bicubic::mild(), 3.0), (Bicubic::strong(), 1.5)] {
        let lines = lines(40);
        let counted = Counted(&map, AtomicUsize::new(0));
        let mut alone = 0;
        for sub in lines.iter().flat_map(|l| &l.subpaths) {
            let letter = Outline { subpaths: vec![sub.clone()] };
            alone += warp_path(&letter, &counted, &options).unwrap().report.segments_out;
        }
        let work_alone = counted.1.swap(0, Ordering::Relaxed);
        let unmerged = options.clone().with_nodes(Nodes::Source);
        for line in &lines {
            let _ = warp_path(line, &counted, &unmerged).unwrap();
        }
        let work_unmerged = counted.1.swap(0, Ordering::Relaxed);
        let known = KnownShapes::among(&lines, &counted, &options);
        let pieces = |l: &Outline| known.warp_path(l, &counted, &options).unwrap().report.segments_out;
        let together: usize = lines.iter().map(pieces).sum();
        let work = counted.1.into_inner();
        assert!(together as f64 <= 1.02 * alone as f64, "{together} pieces, alone {alone}");
        let merging = |work: usize| work.saturating_sub(work_unmerged) as f64;
        assert!(
            less * merging(work) <= merging(work_alone),
            "{work} calls, alone {work_alone}, {work_unmerged} unmerged"
        );
    }
}

/// The known shapes depend neither on the caller nor on the order.
#[test]
fn knowledge_is_the_same_every_time() {
    let (map, options, lines) = (Bicubic::strong(), Options::new(0.1).with_nodes(Nodes::Fewest), lines(40));
    let known = KnownShapes::among(&lines, &map, &options);
    assert_ne!(known, KnownShapes::default());
    assert_eq!(known, KnownShapes::among(&lines, &map, &options));
    let first = known.warp_path(&lines[3], &map, &options).unwrap();
    for line in &lines {
        let _ = known.warp_path(line, &map, &options).unwrap();
    }
    assert_eq!(first, known.warp_path(&lines[3], &map, &options).unwrap());
    assert_eq!(KnownShapes::among(&lines[..8], &map, &options), KnownShapes::default());
}
