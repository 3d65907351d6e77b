//! Pieces and work of the refit over a fixed sample, by which its thresholds were chosen. A threshold that is moved without need makes
//! one of these figures grow.
//!
//! Work is counted in calls of the map, of one batch or one jet each. Unlike time, it is equal on every machine.

use pathwarp::kurbo::{CubicBez, Point};
use pathwarp::map::{Class, Enclosure, Formula, Jet, Map, Real};
use pathwarp::outline::EllipticArc;
use pathwarp::refit::{Nodes, Options, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use pathwarp_oracle::{Bicubic, Rational};
use std::sync::atomic::{AtomicUsize, Ordering};

const TOLERANCES: [f64; 4] = [1.0, 0.1, 0.01, 0.001];
/// Allowance for another order of rounding, as with fused multiply-add.
const MORE_PIECES: f64 = 1.002;
const MORE_WORK: f64 = 1.005;

/// Counts the calls of a map.
struct Counted<'a> {
    map: &'a dyn Map,
    calls: AtomicUsize,
}

impl Counted<'_> {
    fn count(&self) {
        self.calls.fetch_add(1, Ordering::Relaxed);
    }
}

impl Map for Counted<'_> {
    fn jet(&self, p: Point) -> Jet {
        self.count();
        self.map.jet(p)
    }
    fn points(&self, ps: &[Point], out: &mut [Point]) {
        self.count();
        self.map.points(ps, out);
    }
    fn class(&self) -> Class {
        self.map.class()
    }
    fn denominator(&self, p: Point) -> f64 {
        self.map.denominator(p)
    }
    fn enclose(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        self.map.enclose(along)
    }
}

/// A map without any declaration.
struct Waves;
impl Formula for Waves {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x + (y / 120.0).sin() * 24.0, y + (x / 150.0).sin() * 18.0)
    }
}

fn maps() -> [Box<dyn Map>; 4] {
    [Box::new(Bicubic::mild()), Box::new(Bicubic::strong()), Box::new(Rational::new()), Box::new(Waves)]
}

/// Pseudo-random numbers in [0, 1).
struct Random(u64);
impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn point(&mut self) -> Point {
        Point::new(1000.0 * self.next(), 1000.0 * self.next())
    }
}

/// Returns smooth cubics as in drawings, wild ones, cubics with a coincident handle, and arcs of flat ellipses.
fn segments() -> Vec<Seg> {
    let mut r = Random(11);
    (0..240)
        .map(|k| {
            let (p, q) = (r.point(), r.point());
            let (a, b) = (r.point(), r.point());
            let handle = |from: Point, to: Point, aside: f64, share: f64| {
                let v = (to - from) * share;
                from + v + pathwarp::kurbo::Vec2::new(-v.y, v.x) * aside
            };
            match k % 6 {
                0..3 => {
                    let (s, t) = (r.next() - 0.5, r.next() - 0.5);
                    let (l, m) = (0.25 + 0.2 * r.next(), 0.25 + 0.2 * r.next());
                    Seg::Cubic(CubicBez::new(p, handle(p, q, 2.0 * s, l), handle(q, p, 2.0 * t, m), q))
                }
                3 => Seg::Cubic(CubicBez::new(p, p, a, q)),
                4 => Seg::Cubic(CubicBez::new(p, a, b, q)),
                _ => {
                    let (w, h) = (100.0 + 300.0 * r.next(), 5.0 + 200.0 * r.next());
                    let (start, sweep) = (6.3 * r.next(), 5.0 * r.next() - 2.5);
                    Seg::Arc(EllipticArc::new(p, (w, 0.3 * w).into(), (-0.3 * h, h).into(), start, sweep))
                }
            }
        })
        .collect()
}

/// Returns closed curves of many smoothly joined segments, some much shorter than their neighbours.
fn runs() -> Vec<Outline> {
    let mut r = Random(5);
    (0..12)
        .map(|_| {
            let (c, size) = (r.point(), 80.0 + 300.0 * r.next());
            let (lobes, depth) = (2.0 + (3.0 * r.next()).floor(), 0.3 * r.next());
            let at = |t: f64| {
                let (s, d) = (size * (1.0 + depth * (lobes * t).cos()), -size * depth * lobes * (lobes * t).sin());
                let (sin, cos) = t.sin_cos();
                (
                    c + pathwarp::kurbo::Vec2::new(s * cos, s * sin),
                    pathwarp::kurbo::Vec2::new(d * cos - s * sin, d * sin + s * cos),
                )
            };
            let n = 10;
            let knots: Vec<f64> =
                (0..=n).map(|i| (f64::from(i) + if i % 3 == 1 { 0.6 } else { 0.0 }) / f64::from(n)).collect();
            let segs = knots.windows(2).map(|w| {
                let (t0, t1) = (w[0] * std::f64::consts::TAU, w[1] * std::f64::consts::TAU);
                let ((p, v), (q, u), h) = (at(t0), at(t1), (t1 - t0) / 3.0);
                Seg::Cubic(CubicBez::new(p, p + v * h, q - u * h, q))
            });
            let segs: Vec<Seg> = segs.collect();
            Outline { subpaths: vec![Subpath { start: segs[0].start(), segs, closed: false }] }
        })
        .collect()
}

/// Returns pieces and calls of the map for all outlines under all maps, at each tolerance.
fn figures(outlines: &[Outline], options: impl Fn(f64) -> Options) -> [[usize; 2]; 4] {
    TOLERANCES.map(|tolerance| {
        let (mut pieces, mut calls) = (0, 0);
        for map in &maps() {
            let counted = Counted { map: map.as_ref(), calls: AtomicUsize::new(0) };
            for outline in outlines {
                let w = warp_path(outline, &counted, &options(tolerance)).unwrap();
                assert!(w.report.unresolved.is_empty(), "{tolerance}: {outline:?}");
                pieces += w.report.segments_out;
            }
            calls += counted.calls.into_inner();
        }
        [pieces, calls]
    })
}

fn stay_at(name: &str, found: [[usize; 2]; 4], expected: [[usize; 2]; 4]) {
    for ((tolerance, [pieces, calls]), [most_pieces, most_calls]) in TOLERANCES.into_iter().zip(found).zip(expected) {
        let within = |v: usize, most: usize, share: f64| v as f64 <= most as f64 * share;
        assert!(
            within(pieces, most_pieces, MORE_PIECES),
            "{name}, {tolerance}: pieces of {found:?}, expected {expected:?}"
        );
        assert!(within(calls, most_calls, MORE_WORK), "{name}, {tolerance}: calls of {found:?}, expected {expected:?}");
    }
}

fn single(seg: Seg) -> Outline {
    Outline { subpaths: vec![Subpath { start: seg.start(), segs: vec![seg], closed: false }] }
}

#[test]
fn pieces_and_work_stay_at_their_figures() {
    let outlines: Vec<Outline> = segments().into_iter().map(single).collect();
    let found = figures(&outlines, |t| Options::new(t).with_nodes(Nodes::Source));
    stay_at("checked", found, [[1499, 15073], [2065, 24771], [2896, 39352], [4124, 63270]]);
}

#[test]
fn proven_pieces_and_work_stay_at_their_figures() {
    let outlines: Vec<Outline> = segments().into_iter().map(single).collect();
    let found = figures(&outlines, |t| Options::new(t).with_nodes(Nodes::Source).with_certify(true));
    stay_at("certified", found, [[1561, 15033], [2183, 26496], [3070, 47299], [4283, 81192]]);
}

#[test]
fn merged_pieces_and_work_stay_at_their_figures() {
    let found = figures(&runs(), |t| Options::new(t).with_nodes(Nodes::Fewest));
    stay_at("merged", found, [[251, 3652], [405, 5967], [628, 9783], [885, 12745]]);
}

#[test]
fn the_sample_stays_within_the_tolerance() {
    for map in &maps() {
        for tolerance in TOLERANCES {
            for seg in segments() {
                let w =
                    warp_path(&single(seg), map.as_ref(), &Options::new(tolerance).with_nodes(Nodes::Source)).unwrap();
                let e = pathwarp_oracle::distance(&seg, map.as_ref(), &w.path, 400, tolerance);
                assert!(e <= 1.0001 * tolerance, "{tolerance}: {} for {seg:?}", e / tolerance);
                let reported = w.report.max_error;
                assert!(e <= 1.0001 * reported.max(tolerance), "{tolerance}: {e} > {reported} for {seg:?}");
            }
            for outline in runs() {
                let w = warp_path(&outline, map.as_ref(), &Options::new(tolerance).with_nodes(Nodes::Fewest)).unwrap();
                let e = pathwarp_oracle::distance(&outline, map.as_ref(), &w.path, 400, tolerance);
                assert!(e <= 1.0001 * tolerance, "{tolerance}: merged {} for {outline:?}", e / tolerance);
            }
        }
    }
}
