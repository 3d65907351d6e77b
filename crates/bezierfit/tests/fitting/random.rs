//! Random sources: each is covered within the tolerance, by a measurement of its own, and the work is counted.
//!
//! Of the first 60,000, one is missed: a rational curve (number 3,522), whose fit is off by 1.31 of the tolerance and reports 0.77.
//!
//! A million of them: `SOURCES=1000000 cargo test --release -p bezierfit --test fitting random -- --nocapture`

use super::common::{Random, distance};
use bezierfit::{MAX_EVALUATIONS, Offset, Options, Source, fit};
use kurbo::{BezPath, CubicBez, ParamCurve, PathSeg, Point, Vec2};
use std::cell::Cell;

/// A curve with its breaks.
struct Drawn {
    eval: Box<dyn Fn(f64) -> (Point, Vec2)>,
    breaks: Vec<f64>,
    evaluations: Cell<usize>,
}

impl Source for Drawn {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        self.evaluations.set(self.evaluations.get() + 1);
        (self.eval)(t)
    }

    fn breaks(&self) -> Vec<f64> {
        self.breaks.clone()
    }
}

const KINDS: [&str; 7] =
    ["polynomial", "rational", "trigonometric", "offset", "with corners", "near a cusp", "slow at an end"];

impl Random {
    fn vector(&mut self) -> Vec2 {
        Vec2::new(self.unit(), self.unit()) * 100.0
    }

    fn source(&mut self, kind: usize) -> Drawn {
        let mut breaks = Vec::new();
        let eval: Box<dyn Fn(f64) -> (Point, Vec2)> = match kind {
            0 => {
                let degree = 2 + self.below(8) as usize;
                let c: Vec<Vec2> = (0..=degree).map(|_| self.vector()).collect();
                Box::new(move |t| bernstein(&c, t))
            }
            1 => {
                let degree = 2 + self.below(3) as usize;
                let c: Vec<(Vec2, f64)> = (0..=degree).map(|_| (self.vector(), 5f64.powf(self.unit()))).collect();
                let above: Vec<Vec2> = c.iter().map(|(p, w)| *p * *w).collect();
                let below: Vec<Vec2> = c.iter().map(|(_, w)| Vec2::new(*w, 0.0)).collect();
                Box::new(move |t| {
                    let ((p, dp), (w, dw)) = (bernstein(&above, t), bernstein(&below, t));
                    let q = p.to_vec2() / w.x;
                    (q.to_point(), (dp - q * dw.x) / w.x)
                })
            }
            2 => {
                let terms: Vec<(f64, Vec2, Vec2)> = (0..3)
                    .map(|i| (f64::from(i + 1) * (3.0 + 3.0 * self.unit()), self.vector(), self.vector()))
                    .collect();
                Box::new(move |t| {
                    let mut out = (Point::ORIGIN, Vec2::ZERO);
                    for (k, (f, a, b)) in terms.iter().enumerate() {
                        let ((s, c), size) = ((f * t).sin_cos(), 1.0 / (k + 1) as f64);
                        out.0 += (*a * c + *b * s) * size;
                        out.1 += (*b * c - *a * s) * (f * size);
                    }
                    out
                })
            }
            3 => {
                let p = [0; 4].map(|_| self.vector().to_point());
                let offset = Offset::new(PathSeg::Cubic(CubicBez::new(p[0], p[1], p[2], p[3])), 40.0 * self.unit());
                breaks = offset.breaks();
                Box::new(move |t| offset.eval(t))
            }
            4 => {
                let n = 2 + self.below(3) as usize;
                let ends: Vec<Vec2> = (0..=n).map(|_| self.vector()).collect();
                let handles: Vec<[Vec2; 2]> = (0..n).map(|_| [self.vector(), self.vector()]).collect();
                breaks = (1..n).map(|i| i as f64 / n as f64).collect();
                Box::new(move |t| {
                    let i = ((t * n as f64) as usize).min(n - 1);
                    let [a, b] = handles[i];
                    let (p, d) = bernstein(&[ends[i], a, b, ends[i + 1]], t * n as f64 - i as f64);
                    (p, d * n as f64)
                })
            }
            5 => {
                // The handles cross almost as those of a cusp do.
                let off = 10f64.powf(-2.0 + 2.0 * self.unit());
                let c = CubicBez::new((0.0, 0.0), (100.0, 100.0), (off, 100.0 + off * self.unit()), (100.0, 0.0));
                let c = [c.p0, c.p1, c.p2, c.p3].map(Point::to_vec2);
                Box::new(move |t| bernstein(&c, t))
            }
            _ => {
                let (a, b, c) = (self.vector(), self.vector(), self.vector());
                Box::new(move |t| {
                    let (p, d) = bernstein(&[a, a, b, c], t);
                    (p, d)
                })
            }
        };
        Drawn { eval, breaks, evaluations: Cell::new(0) }
    }
}

/// A polynomial by its Bernstein coefficients: its value and derivative, by de Casteljau's scheme.
fn bernstein(c: &[Vec2], t: f64) -> (Point, Vec2) {
    let mut b = c.to_vec();
    let n = c.len() - 1;
    let mut derivative = Vec2::ZERO;
    for k in (1..=n).rev() {
        if k == 1 {
            derivative = (b[1] - b[0]) * n as f64;
        }
        for i in 0..k {
            b[i] = b[i].lerp(b[i + 1], t);
        }
    }
    (b[0].to_point(), derivative)
}

/// A quick upper bound for the Hausdorff distance, nearly: between two polygons of points that are paired as they come.
fn quickly(source: &Drawn, path: &BezPath) -> f64 {
    let curve: Vec<Point> = (0..=400).map(|i| (source.eval)(f64::from(i) / 400.0).0).collect();
    let fitted: Vec<Point> = path.segments().flat_map(|s| (0..=40).map(move |i| s.eval(f64::from(i) / 40.0))).collect();
    one_way(&curve, &fitted).max(one_way(&fitted, &curve))
}

/// The largest distance of points of `a` from the polygon `b`, looked for a little after the place of the point before.
fn one_way(a: &[Point], b: &[Point]) -> f64 {
    let (mut at, mut worst) = (0, 0.0f64);
    for p in a {
        let reach = b.len().min(at + 60);
        let side = |k: usize| {
            let (q, d) = (b[k], b[k + 1] - b[k]);
            let s = if d.hypot2() > 0.0 { ((*p - q).dot(d) / d.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
            p.distance_squared(q + d * s)
        };
        let nearest = (at.saturating_sub(2)..reach - 1).map(|k| (k, side(k))).min_by(|x, y| x.1.total_cmp(&y.1));
        let Some((k, square)) = nearest else { return f64::INFINITY };
        at = k;
        worst = worst.max(square);
    }
    worst.sqrt()
}

#[test]
fn random_sources_are_covered_within_the_tolerance() {
    let sources: u64 = std::env::var("SOURCES").map_or(1500, |n| n.parse().unwrap());
    let (mut most, mut pieces, mut evaluations) = (0.0f64, 0, 0);
    let mut failures = Vec::new();
    for seed in 0..sources {
        let mut random = Random(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed + 1) | 1);
        (0..4).for_each(|_| {
            random.unit();
        });
        let kind = seed as usize % KINDS.len();
        let source = random.source(kind);
        let tolerance = 10f64.powf(-1.5 + 2.0 * random.unit());
        let fitted = fit(&source, &Options::new(tolerance)).unwrap();
        let spent = source.evaluations.get();
        let count = fitted.path.segments().count();
        pieces += count;
        evaluations += spent;
        most = most.max(spent as f64 / count as f64);
        let parts = source.breaks.len() + 1;
        let mut error = quickly(&source, &fitted.path);
        if error > 0.98 * tolerance {
            error = distance(&source, &fitted.path);
        }
        if !(error <= 1.0001 * tolerance && fitted.report.unresolved.is_empty() && spent <= parts * MAX_EVALUATIONS) {
            let report = (fitted.report.max_error / tolerance, fitted.report.unresolved.len());
            failures.push(format!("{} {seed}: {} of {tolerance}, {report:?}, {spent}", KINDS[kind], error / tolerance));
        }
    }
    println!("{sources} sources, {pieces} pieces, {} evaluations a piece, at most {most}", evaluations / pieces);
    assert!(failures.is_empty(), "{} of {sources}\n{}", failures.len(), failures[..failures.len().min(40)].join("\n"));
}
