//! Measurements that share nothing with the fitter.

use bezierfit::Source;
use kurbo::{BezPath, ParamCurve, ParamCurveNearest, Point, Vec2};

/// The distance of a point from a path.
pub fn off(p: Point, path: &BezPath) -> f64 {
    path.segments().map(|s| s.nearest(p, 1e-12).distance_sq).fold(f64::INFINITY, f64::min).sqrt()
}

/// The Hausdorff distance between a curve and a path, by samples of both.
pub fn distance(source: &impl Source, path: &BezPath) -> f64 {
    const SAMPLES: usize = 4000;
    let curve: Vec<Point> = (0..=SAMPLES).map(|i| source.eval(i as f64 / SAMPLES as f64).0).collect();
    let there = curve.iter().map(|p| off(*p, path)).fold(0.0, f64::max);
    // The way back: from samples that are nearer than their neighbours on to the nearest point beside them.
    let nearest = |p: Point| {
        let square: Vec<f64> = curve.iter().map(|q| q.distance_squared(p)).collect();
        let mut best = square.iter().copied().fold(f64::INFINITY, f64::min).sqrt();
        for i in 0..=SAMPLES {
            let [before, after] = [i.saturating_sub(1), (i + 1).min(SAMPLES)];
            let reach = best + curve[i].distance(curve[before]).max(curve[i].distance(curve[after]));
            if square[i] > square[before] || square[i] > square[after] || square[i] > reach * reach {
                continue;
            }
            let d = |t: f64| source.eval(t).0.distance(p);
            let [mut low, mut high] = [before, after].map(|k| k as f64 / SAMPLES as f64);
            for _ in 0..40 {
                let (a, b) = (low + 0.38 * (high - low), high - 0.38 * (high - low));
                *if d(a) < d(b) { &mut high } else { &mut low } = if d(a) < d(b) { b } else { a };
            }
            best = best.min(d(low));
        }
        best
    };
    let places = path.segments().flat_map(|s| (0..=40).map(move |i| s.eval(f64::from(i) / 40.0)));
    there.max(places.map(nearest).fold(0.0, f64::max))
}

/// A sine of so many radians.
pub fn wave(radians: f64) -> impl Fn(f64) -> (Point, Vec2) + Copy {
    move |t: f64| {
        let (s, c) = (radians * t).sin_cos();
        (Point::new(300.0 * t, 40.0 * s), Vec2::new(300.0, 40.0 * radians * c))
    }
}

/// Numbers that look random.
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        // xorshift64*
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// From −1 to 1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// From 0 to `n` − 1.
    pub fn below(&mut self, n: u64) -> u64 {
        (self.next() >> 33) % n
    }
}
