//! Compares proven signs with independent, dense samples of det J.

use super::*;
use crate::map::{
    BicubicNet, Chain, Formula, Homography, Lattice, LatticeMap, Net, Plane, Quotient, Real, complete_net,
};
use kurbo::{Affine, Vec2};

/// Enough samples for any proof here.
const ENOUGH: usize = 1 << 16;

/// Numbers in [−1, 1) by a linear congruential generator (Knuth's MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn shift(&mut self, by: f64) -> Vec2 {
        Vec2::new(self.next(), self.next()) * by
    }
}

const BOX: Rect = Rect::new(-20.0, 30.0, 100.0, 90.0);

/// Returns the smallest and the largest determinant over a dense grid, by central differences of values.
fn dense(map: &dyn Map) -> (f64, f64) {
    const N: usize = 80;
    let h = 1e-4;
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for k in 0..=N * N + 2 * N {
        let (i, j) = (k % (N + 1), k / (N + 1));
        let at = |from: f64, size: f64, i: usize| from + size * i as f64 / N as f64;
        let p = Point::new(at(BOX.x0, BOX.width(), i), at(BOX.y0, BOX.height(), j));
        let slope = |d: Vec2| (map.point(p + d) - map.point(p - d)) / (2.0 * h);
        let det = slope(Vec2::new(h, 0.0)).cross(slope(Vec2::new(0.0, h)));
        (least, most) = (least.min(det), most.max(det));
    }
    (least, most)
}

/// Checks a family of maps, from gentle to wild: proven signs are right, gentle maps are proven, and no fold is missed.
fn check(family: &str, make: impl Fn(&mut Random, f64) -> Arc<dyn Map>) {
    let mut random = Random(7);
    let (mut proven_count, mut unfolded, mut folded) = (0, 0, 0);
    for k in 0..200 {
        let strength = 0.02 + 0.6 * f64::from(k) / 200.0;
        let mirrored = k % 3 == 0;
        let mut map = make(&mut random, strength);
        if mirrored {
            let mirror = Arc::new(crate::map::AffineMap(Affine::new([1.0, 0.0, 0.3, -1.0, 5.0, 0.0])));
            map = Arc::new(Chain::new([map, mirror as Arc<dyn Map>]));
        }
        let (least, most) = dense(&*map);
        // Differences of values are good to about 1e-7 here.
        let (positive, negative) = (least > 1e-5, most < -1e-5);
        match proven(&*map, BOX, ENOUGH) {
            Some(1.0) => assert!(least > -1e-5, "{family} {k}: {least}"),
            Some(-1.0) => assert!(most < 1e-5, "{family} {k}: {most}"),
            other => assert!(other.is_none(), "{family} {k}: {other:?}"),
        }
        if least < -1e-5 && most > 1e-5 {
            folded += 1;
            assert!(proven(&*map, BOX, ENOUGH).is_none(), "{family} {k} folds");
        }
        // If the determinant varies less than eightfold, the map is clearly unfolded.
        if (positive && least > most / 8.0) || (negative && most < least / 8.0) {
            unfolded += 1;
            proven_count += usize::from(proven(&*map, BOX, ENOUGH) == Some(if negative { -1.0 } else { 1.0 }));
        }
    }
    assert!(folded > 10 && unfolded > 10, "{family}: {folded} folded, {unfolded} unfolded");
    assert_eq!(proven_count, unfolded, "{family}");
}

fn net(random: &mut Random, strength: f64) -> Net {
    let at = |r: usize, s: usize| Point::new(s as f64 * 40.0, r as f64 * 20.0);
    std::array::from_fn(|r| std::array::from_fn(|s| at(r, s) + random.shift(strength * 40.0)))
}

fn to_unit() -> Affine {
    Affine::scale_non_uniform(1.0 / BOX.width(), 1.0 / BOX.height()) * Affine::translate(-BOX.origin().to_vec2())
}

fn tilt(random: &mut Random, strength: f64) -> Homography {
    let from = [(BOX.x0, BOX.y0), (BOX.x1, BOX.y0), (BOX.x1, BOX.y1), (BOX.x0, BOX.y1)].map(Point::from);
    let moved = from.map(|p| p + random.shift(strength * 40.0));
    Homography::from_points(from, moved).unwrap_or(Homography::from(Affine::IDENTITY))
}

#[test]
fn bicubic_nets() {
    check("net", |r, s| Arc::new(BicubicNet::new(&net(r, s), to_unit())));
    check("completed", |r, s| Arc::new(BicubicNet::new(&complete_net(net(r, s)), to_unit())));
}

#[test]
fn chains_with_denominators() {
    check("tilted", |r, s| {
        let step = Arc::new(BicubicNet::new(&complete_net(net(r, s)), to_unit())) as Arc<dyn Map>;
        Arc::new(Chain::new([Arc::new(tilt(r, 0.2)) as Arc<dyn Map>, step, Arc::new(tilt(r, 0.2))]))
    });
}

#[test]
fn quotients() {
    check("quotient", |r, s| {
        // The first three coefficients are given, those of second degree are random.
        let mut plane = |linear: [f64; 3]| {
            let mut random = |size: f64| s * size * r.next();
            let [c, x, y] = linear;
            Plane::new(vec![vec![c, x, random(60.0)], vec![y, random(60.0)], vec![random(60.0)]])
        };
        let (x, y) = (plane([0.0, 120.0, 0.0]), plane([0.0, 0.0, 60.0]));
        let w = plane([1.0, 0.0, 0.0]).scaled(0.02).plus(0.98, &Plane::linear([1.0, 0.0, 0.0]));
        Arc::new(Quotient::rational(to_unit(), Point::ORIGIN, x, y, w, BOX))
    });
}

#[test]
fn lattices_are_proven_piece_by_piece() {
    check("lattice", |r, s| {
        let mut lattice = Lattice::regular(BOX.inflate(5.0, 5.0), [2, 3], [3, 2]);
        for j in 0..lattice.rows() {
            for i in 0..lattice.columns() {
                lattice.shift(i, j, r.shift(s * 25.0));
            }
        }
        Arc::new(LatticeMap::new(&lattice, true))
    });
}

struct Smooth;
impl Formula for Smooth {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x + (y * 0.1).sin(), y)
    }
}

#[test]
fn nothing_is_claimed_without_algebra_or_samples_or_beyond_a_pole() {
    assert_eq!(proven(&Smooth, BOX, ENOUGH), None);
    let net = BicubicNet::new(&net(&mut Random(1), 0.02), to_unit());
    assert_eq!(proven(&net, BOX, ENOUGH), Some(1.0));
    assert_eq!(proven(&net, BOX, 20), None);
    // The horizon x = 40 crosses the box; the determinant, 1/W³, is positive on one side only.
    let horizon = Homography::new([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-0.025, 0.0, 1.0]]);
    assert_eq!(proven(&horizon, BOX, ENOUGH), None);
    assert_eq!(proven(&horizon, Rect { x1: 30.0, ..BOX }, ENOUGH), Some(1.0));
    // A map onto a line has no orientation.
    let flat = BicubicNet::new(&std::array::from_fn(|r| [Point::new(r as f64, 0.0); 4]), to_unit());
    assert_eq!(proven(&flat, BOX, ENOUGH), None);
}
