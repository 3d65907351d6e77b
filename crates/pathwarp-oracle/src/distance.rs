//! Distances and angles between curves, measured without the engine.

use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, Point, Vec2};
use pathwarp::Seg;
use pathwarp::map::Map;

/// The symmetric distance between the image of `seg` and the cubics, from `samples` points in either direction, whose foot points
/// are found by Newton steps from the nearest sample. Distances below `enough` are not refined.
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

/// As [`distance`], for the image of several consecutive segments.
pub fn distance_of_run(segs: &[Seg], map: &dyn Map, out: &[CubicBez], per: usize, enough: f64) -> f64 {
    // A segment without length would put many samples at one point.
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

/// The minimum between `lo` and `hi` by golden-section search: slow, but robust at cusps.
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
        // Descend from the previous nearest sample. Search everywhere if the result is not good enough.
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
            // Refine near the nearest chords between samples. The samples themselves may be further apart than the branches of
            // a hairpin.
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

/// The sharpest turn between consecutive cubics, in degrees.
pub fn largest_turn(out: &[CubicBez]) -> f64 {
    out.windows(2).map(|w| turn(arriving(&w[0]), leaving(&w[1]))).fold(0.0, f64::max)
}

/// The angle between two directions, in degrees.
pub fn turn(a: Vec2, b: Vec2) -> f64 {
    a.cross(b).atan2(a.dot(b)).abs().to_degrees()
}

/// The direction in which a cubic starts.
pub fn leaving(c: &CubicBez) -> Vec2 {
    [c.p1, c.p2, c.p3].iter().map(|p| *p - c.p0).find(|v| v.hypot() > 1e-9).unwrap_or_default()
}

/// The direction in which a cubic ends.
pub fn arriving(c: &CubicBez) -> Vec2 {
    [c.p2, c.p1, c.p0].iter().map(|p| c.p3 - *p).find(|v| v.hypot() > 1e-9).unwrap_or_default()
}
