//! Shared by the benchmark and the tests of the refit: three maps, the icon paths, and an oracle independent of the engine.

#![allow(dead_code, missing_docs, unreachable_pub, clippy::unwrap_used)]

use kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveDeriv, PathSeg, Point, Vec2};
use pathwarp::map::batch::Lane;
use pathwarp::map::{Jet, Map, RationalDegree};
use pathwarp::{Outline, Seg};

/// Side of the box of the icons and the maps.
pub const BOX: f64 = 1000.0;

/// A bicubic map of the box in the power basis: c[i][j] is the coefficient of uⁱvʲ, u = x/1000, v = y/1000.
#[derive(Debug, Clone)]
pub struct Bicubic {
    pub x: [[f64; 4]; 4],
    pub y: [[f64; 4]; 4],
}

/// Bernstein to power basis, degree 3.
const POWER: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [-3.0, 3.0, 0.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]];

fn tensor_power(net: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (0..4).map(|k| (0..4).map(|l| POWER[i][k] * POWER[j][l] * net[k][l]).sum::<f64>()).sum()
        })
    })
}

impl Bicubic {
    /// From a control net: `net[i][j]` is the control point at (i/3, j/3) of the box.
    pub fn from_net(net: &[[Point; 4]; 4]) -> Self {
        Self { x: tensor_power(&net.map(|r| r.map(|p| p.x))), y: tensor_power(&net.map(|r| r.map(|p| p.y))) }
    }

    /// The identity with each control point moved by `f(i, j)`.
    pub fn moved(f: impl Fn(usize, usize) -> (f64, f64)) -> Self {
        let net = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let (dx, dy) = f(i, j);
                Point::new(BOX * i as f64 / 3.0 + dx, BOX * j as f64 / 3.0 + dy)
            })
        });
        Self::from_net(&net)
    }

    /// Control points moved by at most 5 % of the box.
    pub fn mild() -> Self {
        const D: [[(f64, f64); 4]; 4] = [
            [(25.0, 25.0), (40.0, -50.0), (-20.0, -35.0), (-5.0, 50.0)],
            [(-20.0, 30.0), (45.0, 40.0), (45.0, 45.0), (-10.0, 50.0)],
            [(-15.0, 10.0), (50.0, -15.0), (20.0, -20.0), (-50.0, -50.0)],
            [(45.0, 15.0), (-25.0, 40.0), (-50.0, 0.0), (15.0, -30.0)],
        ];
        Self::moved(|i, j| D[i][j])
    }

    /// A strong bulge with a twist, whose Jacobian determinant just touches zero.
    pub fn strong() -> Self {
        Self::moved(|i, j| {
            let (u, v) = (i as f64 / 3.0 - 0.5, j as f64 / 3.0 - 0.5);
            let inner = (1..3).contains(&i) && (1..3).contains(&j);
            let k = if inner { 2.1 } else { -0.1 };
            let w = if inner { 1.6 } else { 0.0 };
            (BOX * (k * u - w * v), BOX * (k * v + w * u))
        })
    }

    fn tables(&self, u: f64) -> [[f64; 4]; 4] {
        let f = |c: &[[f64; 4]; 4], j: usize| ((c[3][j] * u + c[2][j]) * u + c[1][j]) * u + c[0][j];
        let d = |c: &[[f64; 4]; 4], j: usize| (3.0 * c[3][j] * u + 2.0 * c[2][j]) * u + c[1][j];
        [
            std::array::from_fn(|j| f(&self.x, j)),
            std::array::from_fn(|j| f(&self.y, j)),
            std::array::from_fn(|j| d(&self.x, j)),
            std::array::from_fn(|j| d(&self.y, j)),
        ]
    }
}

#[inline(always)]
fn horner(r: &[f64; 4], v: f64) -> f64 {
    ((r[3] * v + r[2]) * v + r[1]) * v + r[0]
}

#[inline(always)]
fn slope(r: &[f64; 4], v: f64) -> f64 {
    (3.0 * r[3] * v + 2.0 * r[2]) * v + r[1]
}

impl Map for Bicubic {
    fn rational_degree(&self) -> Option<RationalDegree> {
        Some(RationalDegree::polynomial(6))
    }

    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        let [x, y, dx, dy] = self.tables(u);
        Jet {
            p: Point::new(horner(&x, v), horner(&y, v)),
            dx: Vec2::new(horner(&dx, v), horner(&dy, v)) / BOX,
            dy: Vec2::new(slope(&x, v), slope(&y, v)) / BOX,
        }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        let row = |c: &[[f64; 4]; 4], j: usize| ((c[3][j] * u + c[2][j]) * u + c[1][j]) * u + c[0][j];
        let at = |c: &[[f64; 4]; 4]| ((row(c, 3) * v + row(c, 2)) * v + row(c, 1)) * v + row(c, 0);
        Point::new(at(&self.x), at(&self.y))
    }

    fn lanes(&self, x: &mut Lane, y: &mut Lane) {
        for (x, y) in x.iter_mut().zip(y) {
            let p = self.point(Point::new(*x, *y));
            (*x, *y) = (p.x, p.y);
        }
    }
}

/// A rational map of degree 1 in x and 3 in y, like an envelope between two cubics with weights.
#[derive(Clone)]
pub struct Rational {
    /// x·w, y·w and w in the power basis: `c[k][i][j]` is the coefficient of uⁱvʲ.
    pub c: [[[f64; 4]; 2]; 3],
}

impl Rational {
    pub fn new() -> Self {
        let points = [
            [(30.0, -20.0), (160.0, 330.0), (-120.0, 640.0), (20.0, 1010.0)],
            [(980.0, 40.0), (840.0, 300.0), (1130.0, 700.0), (1000.0, 980.0)],
        ];
        let weights = [[1.0, 1.6, 0.7, 1.0], [1.1, 0.8, 2.0, 0.9]];
        let net = |f: &dyn Fn(usize, usize) -> f64| -> [[f64; 4]; 2] {
            let rows: [[f64; 4]; 2] =
                std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|l| POWER[j][l] * f(i, l)).sum()));
            [rows[0], std::array::from_fn(|j| rows[1][j] - rows[0][j])]
        };
        Self {
            c: [
                net(&|i, j| points[i][j].0 * weights[i][j]),
                net(&|i, j| points[i][j].1 * weights[i][j]),
                net(&|i, j| weights[i][j]),
            ],
        }
    }
}

impl Default for Rational {
    fn default() -> Self {
        Self::new()
    }
}

impl Map for Rational {
    fn rational_degree(&self) -> Option<RationalDegree> {
        Some(RationalDegree::rational(4))
    }

    fn denominator(&self, p: Point) -> f64 {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        horner(&self.c[2][0], v) + u * horner(&self.c[2][1], v)
    }

    #[inline]
    fn jet(&self, p: Point) -> Jet {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        let f: [(f64, f64, f64); 3] = std::array::from_fn(|k| {
            let [r, s] = &self.c[k];
            let e = horner(s, v);
            (horner(r, v) + u * e, e, slope(r, v) + u * slope(s, v))
        });
        let k = 1.0 / f[2].0;
        let (x, y) = (f[0].0 * k, f[1].0 * k);
        let d = k / BOX;
        Jet {
            p: Point::new(x, y),
            dx: Vec2::new((f[0].1 - x * f[2].1) * d, (f[1].1 - y * f[2].1) * d),
            dy: Vec2::new((f[0].2 - x * f[2].2) * d, (f[1].2 - y * f[2].2) * d),
        }
    }

    #[inline]
    fn point(&self, p: Point) -> Point {
        let (u, v) = (p.x * (1.0 / BOX), p.y * (1.0 / BOX));
        let f = |k: usize| horner(&self.c[k][0], v) + u * horner(&self.c[k][1], v);
        let w = f(2);
        Point::new(f(0) / w, f(1) / w)
    }

    fn lanes(&self, x: &mut Lane, y: &mut Lane) {
        for (x, y) in x.iter_mut().zip(y) {
            let p = self.point(Point::new(*x, *y));
            (*x, *y) = (p.x, p.y);
        }
    }
}

/// The icon paths fetched by `cargo xtask corpus` and `true`, or else a few built-in paths and `false`.
pub fn corpus() -> (Vec<Outline>, bool) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../corpus/icons.txt");
    match std::fs::read_to_string(file) {
        Ok(text) => (text.lines().map(Outline::from_svg_lossy).collect(), true),
        Err(_) => (OWN.iter().map(|d| Outline::from_svg_lossy(d)).collect(), false),
    }
}

/// Substitutes for the icons.
const OWN: &[&str] = &[
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

/// The Hausdorff distance between the image of `seg` and the cubics: `samples` points in each direction, foot points by Newton
/// steps from the nearest sample. Distances below `enough` are not refined.
pub fn distance(seg: &Seg, map: &dyn Map, out: &[CubicBez], samples: usize, enough: f64) -> f64 {
    let image = |t: f64| map.point(seg.eval(t));
    let image_d = |t: f64| map.jet(seg.eval(t)).push(seg.deriv(t));
    let n = samples;
    let g: Vec<Point> = (0..=n).map(|i| image(i as f64 / n as f64)).collect();
    let per = (n / out.len().max(1)).max(8);
    let m = per * out.len();
    let curve =
        |k: usize| out[(k / per).min(out.len() - 1)].eval((k - per * (k / per).min(out.len() - 1)) as f64 / per as f64);
    let c: Vec<Point> = (0..=m).map(curve).collect();
    let a = one_sided(&g, &c, enough, |k, p| {
        let mut best = f64::INFINITY;
        for piece in [k.saturating_sub(1) / per, (k / per).min(out.len() - 1)] {
            let cb = &out[piece.min(out.len() - 1)];
            let d = cb.deriv();
            let mut s = ((k as f64 - (piece * per) as f64) / per as f64).clamp(0.0, 1.0);
            for _ in 0..8 {
                let (r, v) = (cb.eval(s) - p, d.eval(s).to_vec2());
                best = best.min(r.hypot());
                s = (s - r.dot(v) / (v.hypot2() + 1e-300)).clamp(0.0, 1.0);
            }
            let lo = ((k as f64 - (piece * per) as f64 - 1.0) / per as f64).clamp(0.0, 1.0);
            let hi = ((k as f64 - (piece * per) as f64 + 1.0) / per as f64).clamp(0.0, 1.0);
            best = best.min(cb.eval(s).distance(p));
            if best > enough {
                best = best.min(golden(lo, hi, |s| cb.eval(s).distance(p)));
            }
        }
        best
    });
    let b = one_sided(&c, &g, enough, |k, p| {
        let mut best = f64::INFINITY;
        let mut t = k as f64 / n as f64;
        for _ in 0..8 {
            let (r, v) = (image(t) - p, image_d(t));
            best = best.min(r.hypot());
            t = (t - r.dot(v) / (v.hypot2() + 1e-300)).clamp(0.0, 1.0);
        }
        best = best.min(image(t).distance(p));
        if best > enough {
            let (lo, hi) = ((k as f64 - 1.0) / n as f64, (k as f64 + 1.0) / n as f64);
            best = best.min(golden(lo.max(0.0), hi.min(1.0), |t| image(t).distance(p)));
        }
        best
    });
    a.max(b)
}

/// As [`distance`], for the image of several segments in a row.
pub fn distance_of_run(segs: &[Seg], map: &dyn Map, out: &[CubicBez], per: usize, enough: f64) -> f64 {
    // Segments of no length would put many samples in one place.
    let segs: Vec<Seg> = segs.iter().filter(|s| extent(&s.to_cubic()) > 1e-9).copied().collect();
    let out: Vec<CubicBez> = out.iter().filter(|c| extent(c) > 1e-9).copied().collect();
    let image = |t: f64| {
        let k = (t as usize).min(segs.len() - 1);
        map.point(segs[k].eval(t - k as f64))
    };
    let curve = |t: f64| {
        let k = (t as usize).min(out.len() - 1);
        out[k].eval(t - k as f64)
    };
    let g: Vec<Point> = (0..=per * segs.len()).map(|i| image(i as f64 / per as f64)).collect();
    let c: Vec<Point> = (0..=per * out.len()).map(|i| curve(i as f64 / per as f64)).collect();
    let near =
        |k: usize, n: usize| ((k as f64 - 1.0).max(0.0) / per as f64, ((k as f64 + 1.0) / per as f64).min(n as f64));
    let a = one_sided(&g, &c, enough, |k, p| {
        let (lo, hi) = near(k, out.len());
        golden(lo, hi, |t| curve(t).distance(p))
    });
    let b = one_sided(&c, &g, enough, |k, p| {
        let (lo, hi) = near(k, segs.len());
        golden(lo, hi, |t| image(t).distance(p))
    });
    a.max(b)
}

fn extent(c: &CubicBez) -> f64 {
    [c.p1, c.p2, c.p3].iter().map(|p| p.distance(c.p0)).fold(0.0, f64::max)
}

/// The minimum between `lo` and `hi` by golden sections: slow, but reliable at cusps.
fn golden(mut lo: f64, mut hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    const G: f64 = 0.381_966_011_250_105;
    let (mut a, mut b) = (lo + G * (hi - lo), hi - G * (hi - lo));
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..50 {
        if fa < fb {
            (hi, b, fb) = (b, a, fa);
            a = lo + G * (hi - lo);
            fa = f(a);
        } else {
            (lo, a, fa) = (a, b, fb);
            b = hi - G * (hi - lo);
            fb = f(b);
        }
    }
    fa.min(fb)
}

fn one_sided(from: &[Point], to: &[Point], enough: f64, refine: impl Fn(usize, Point) -> f64) -> f64 {
    let mut at = 0;
    let mut worst = 0.0f64;
    for p in from {
        // Downhill from the last nearest sample; a full search if that is not good enough.
        let d = |k: usize| to[k].distance_squared(*p);
        loop {
            let here = d(at);
            if at + 1 < to.len() && d(at + 1) < here {
                at += 1;
            } else if at > 0 && d(at - 1) < here {
                at -= 1;
            } else {
                break;
            }
        }
        let mut e = d(at).sqrt();
        if e > enough.min(worst) {
            e = e.min(refine(at, *p));
        }
        if e > enough && e > worst {
            // The nearest chords between samples: samples may be far apart, and the branches of a hairpin closer to each other
            // than samples are.
            let chord = |k: usize| {
                let (a, v) = (to[k], to[k + 1] - to[k]);
                let s = ((*p - a).dot(v) / (v.hypot2() + 1e-300)).clamp(0.0, 1.0);
                (a + v * s).distance(*p)
            };
            let mut near: Vec<(f64, usize)> = (0..to.len() - 1).map(|k| (chord(k), k)).collect();
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (_, k) in near.into_iter().take(8) {
                if e > enough {
                    e = e.min(refine(k, *p)).min(refine(k + 1, *p));
                }
            }
        }
        worst = worst.max(e);
    }
    worst
}

/// The largest angle between consecutive cubics, degrees.
pub fn largest_turn(out: &[CubicBez]) -> f64 {
    out.windows(2).map(|w| turn(arriving(&w[0]), leaving(&w[1]))).fold(0.0, f64::max)
}

/// The angle between two directions, degrees.
pub fn turn(a: Vec2, b: Vec2) -> f64 {
    a.cross(b).atan2(a.dot(b)).abs().to_degrees()
}

pub fn leaving(c: &CubicBez) -> Vec2 {
    [c.p1, c.p2, c.p3].iter().map(|p| *p - c.p0).find(|v| v.hypot() > 1e-9).unwrap_or_default()
}

pub fn arriving(c: &CubicBez) -> Vec2 {
    [c.p2, c.p1, c.p0].iter().map(|p| c.p3 - *p).find(|v| v.hypot() > 1e-9).unwrap_or_default()
}
