//! The refit against an independent oracle: Hausdorff distances by 2,000 samples in each direction.

use pathwarp::kurbo::{CubicBez, Point};
use pathwarp::map::{Formula, Map, Real};
use pathwarp::refit::{Assurance, Nodes, Options, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use pathwarp_oracle::{Bicubic, Fold, Rational, Ripple};

fn single(seg: Seg) -> Outline {
    Outline { subpaths: vec![Subpath { start: seg.start(), segs: vec![seg], closed: false }] }
}

fn maps() -> [(&'static str, Box<dyn Map>); 3] {
    [
        ("mild", Box::new(Bicubic::mild())),
        ("strong", Box::new(Bicubic::strong())),
        ("rational", Box::new(Rational::new())),
    ]
}

/// Returns the number of segments, and error ÷ tolerance.
fn measure(seg: Seg, map: &dyn Map, tolerance: f64) -> (usize, f64) {
    let w = warp_path(&single(seg), map, &Options::new(tolerance)).unwrap();
    assert!(w.report.unresolved.is_empty(), "{seg:?}: budget");
    (w.path.segments().count(), pathwarp_oracle::distance(&seg, map, &w.path, 2000, tolerance) / tolerance)
}

fn cubic(p: [(f64, f64); 4]) -> Seg {
    Seg::Cubic(CubicBez::new(p[0], p[1], p[2], p[3]))
}

/// Refits all icons under all maps at all tolerances. Run with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes; needs the fetched icons"]
#[allow(clippy::print_stdout)]
fn corpus_has_no_violation() {
    let (outlines, _) = pathwarp_oracle::corpus();
    let every: usize = std::env::var("EVERY").ok().and_then(|v| v.parse().ok()).unwrap_or(1);
    let segs: Vec<Seg> = outlines.iter().flat_map(Outline::segs).step_by(every).copied().collect();
    let certify = std::env::var("CERTIFY").is_ok();
    let mut bad = 0;
    for (name, map) in &maps() {
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            let (mut n, mut worst, mut over, mut turns) = (0, 0.0f64, 0, 0);
            for seg in &segs {
                let o = Options::new(tolerance).with_certify(certify);
                let w = warp_path(&single(*seg), map.as_ref(), &o).unwrap();
                let out = pathwarp_oracle::cubics(&w.path);
                if certify && w.report.unresolved.is_empty() {
                    assert!(w.report.assurance >= Assurance::Certified, "{seg:?}");
                }
                n += out.len();
                over += w.report.unresolved.len();
                let e = pathwarp_oracle::distance(seg, map.as_ref(), &w.path, 2000, tolerance) / tolerance;
                worst = worst.max(e);
                if e > 1.0001 {
                    bad += 1;
                    println!("  {name} {tolerance}: {e:.4} with {} pieces: {seg:?}", out.len());
                }
                if pathwarp_oracle::largest_turn(&out) > 0.01 {
                    turns += 1;
                    println!("  {name} {tolerance}: turn {} : {seg:?}", pathwarp_oracle::largest_turn(&out));
                }
            }
            let ratio = n as f64 / segs.len() as f64;
            println!("{name} {tolerance}: out/in {ratio:.4}, worst {worst:.4}, over budget {over}, turns {turns}");
        }
    }
    assert_eq!(bad, 0);
}

/// Refits all icons as merged paths, and measures them subpath by subpath. Run with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes; needs the fetched icons"]
#[allow(clippy::print_stdout)]
fn merged_corpus_has_no_violation() {
    let (outlines, _) = pathwarp_oracle::corpus();
    let every: usize = std::env::var("EVERY").ok().and_then(|v| v.parse().ok()).unwrap_or(1);
    let mut bad = 0;
    for (name, map) in &maps() {
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            let (mut segs, mut n, mut worst) = (0, 0, 0.0f64);
            for sub in outlines.iter().step_by(every).flat_map(|o| &o.subpaths).filter(|s| !s.segs.is_empty()) {
                let o = Options::new(tolerance).with_nodes(Nodes::Fewest);
                let w = warp_path(&Outline { subpaths: vec![sub.clone()] }, map.as_ref(), &o).unwrap();
                (segs, n) = (segs + sub.segs.len(), n + w.report.segments_out);
                let e = pathwarp_oracle::distance(&sub.segs, map.as_ref(), &w.path, 400, tolerance) / tolerance;
                worst = worst.max(e);
                if e > 1.0001 {
                    bad += 1;
                    println!(
                        "  {name} {tolerance}: {e:.4}, {} to {}: {}",
                        sub.segs.len(),
                        w.report.segments_out,
                        w.path.to_svg()
                    );
                }
            }
            println!("{name} {tolerance}: out/in {:.4}, worst {worst:.4}", n as f64 / segs as f64);
        }
    }
    assert_eq!(bad, 0);
}

#[test]
fn merging_saves_nodes_and_keeps_the_tolerance_corners_and_smoothness() {
    // A circle in sixteen pieces, and a rounded square.
    let circle = {
        use pathwarp::outline::EllipticArc;
        let d = 300.0;
        let a = |i: i32| f64::from(i) * std::f64::consts::TAU / 16.0;
        let arc =
            |i| EllipticArc::new(Point::new(500.0, 500.0), (d, 0.0).into(), (0.0, d).into(), a(i), a(1)).to_cubic();
        let segs: Vec<Seg> = (0..16).map(|i| Seg::Cubic(arc(i))).collect();
        Subpath { start: segs[0].start(), segs, closed: false }
    };
    let square =
        Outline::from_svg("M300 200H700Q800 200 800 300V700L700 800H300L200 700V300Q200 200 300 200Z").unwrap();
    for (name, map) in &maps() {
        for tolerance in [1.0, 0.01] {
            for (sub, corners) in [(&circle, 0), (&square.subpaths[0], 4)] {
                let outline = Outline { subpaths: vec![sub.clone()] };
                let w = |merge| {
                    warp_path(
                        &outline,
                        map.as_ref(),
                        &Options::new(tolerance).with_nodes(if merge { Nodes::Fewest } else { Nodes::Source }),
                    )
                    .unwrap()
                };
                let (plain, merged) = (w(false), w(true));
                assert!(merged.report.segments_out <= plain.report.segments_out);
                assert!(corners > 0 || merged.report.segments_out * 10 <= 6 * plain.report.segments_out, "{name}");
                let out = pathwarp_oracle::cubics(&merged.path);
                let e = pathwarp_oracle::distance(&sub.segs, map.as_ref(), &merged.path, 400, tolerance);
                assert!(e <= tolerance * 1.0001, "{name} {tolerance}: {e}");
                let sharp = out.windows(2).filter(|w| {
                    pathwarp_oracle::turn(pathwarp_oracle::arriving(&w[0]), pathwarp_oracle::leaving(&w[1])) > 0.01
                });
                assert_eq!(sharp.count(), corners, "{name} {tolerance}");
            }
        }
    }
}

/// A merged cubic begins to turn sharply just before the joint of a long line and a short round corner, between the line's last two
/// samples: errors of 1.27, 1.02 and 1.01 times the tolerance, in shapes of the icons. The third error peaks between the last of the
/// closer samples and the joint.
#[test]
fn errors_beside_a_joint_at_which_the_cubic_turns_are_seen() {
    let bookmark = "M125,125 C125,55.96440627115075 180.96440627115075,0 250,0 L750,0 C819.0355937288492,0 875,55.96440627115075 \
                    875,125 L875,968.75 C874.994050449237,980.2672409539377 868.6536134178767,990.8476449756297 \
                    858.5000353034068,996.2837949056419 C848.3464571889368,1001.7199448356541 836.025795302976,1001.1305538765175 \
                    826.4375,994.75 L500,818.8125";
    let card = "M369.625,0 L781.25,0 C833.026695296637,0 875,41.973304703363056 875,93.75 L875,906.25 \
                C875,958.026695296637 833.026695296637,1000 781.25,1000 L218.75,1000";
    let hook = "M252.91666666666666,502.5 C247.91666666666666,251.66666666666669 501.25,146.24999999999997 688.3333333333333,302.9166666666667 \
                C690.8333333333333,305 699.1666666666666,303.3333333333333 701.6666666666666,300.83333333333337 \
                C702.9166666666666,299.5833333333333 703.3333333333333,291.6666666666667 700.8333333333333,289.1666666666667 \
                C476.24999999999994,67.08333333333334 149.16666666666666,253.75000000000003 167.49999999999997,555.4166666666666";
    let [mild, _, rational] = maps();
    for (shape, (name, map), tolerance) in [(bookmark, &mild, 1.0), (card, &mild, 1.0), (hook, &rational, 0.1)] {
        let outline = Outline::from_svg(shape).unwrap();
        let merged = warp_path(&outline, map.as_ref(), &Options::new(tolerance).with_nodes(Nodes::Fewest)).unwrap();
        let e = pathwarp_oracle::distance(&outline, map.as_ref(), &merged.path, 400, tolerance) / tolerance;
        assert!(e <= 1.0001, "{name}: {e}");
    }
}

#[test]
fn merged_pieces_are_proven_too() {
    // A wave of many smoothly joined segments, one of them an arc.
    let outline = Outline::from_svg(
        "M100 500C120 450 140 420 170 420S220 450 240 500 290 580 320 580 390 560 390 500A60 60 0 0 1 450 440
         C470 440 490 450 510 470S560 510 590 510H700C730 510 760 490 780 470",
    )
    .unwrap();
    for (name, map) in &maps() {
        for tolerance in [1.0, 0.1, 0.01] {
            let w = |merge| {
                let o = Options::new(tolerance)
                    .with_nodes(if merge { Nodes::Fewest } else { Nodes::Source })
                    .with_certify(true);
                warp_path(&outline, map.as_ref(), &o).unwrap()
            };
            let (plain, merged) = (w(false), w(true));
            let (r, out) = (&merged.report, pathwarp_oracle::cubics(&merged.path));
            assert!(r.segments_out <= plain.report.segments_out, "{name} {tolerance}");
            assert!(tolerance < 1.0 || r.segments_out < plain.report.segments_out, "{name}: nothing merged");
            assert!(r.assurance >= Assurance::Certified && r.max_error <= tolerance, "{name} {tolerance}");
            let e = pathwarp_oracle::distance(&outline, map.as_ref(), &merged.path, 400, tolerance);
            assert!(e <= r.max_error * 1.0001 + 1e-9, "{name} {tolerance}: {e} > {}", r.max_error);
            assert!(pathwarp_oracle::largest_turn(&out) < 0.5, "{name} {tolerance}");
        }
    }
}

/// Each path is refitted independently of other threads.
#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    let paths: Vec<Outline> = pathwarp_oracle::corpus().0.into_iter().take(24).collect();
    for options in [Options::new(0.1).with_nodes(Nodes::Fewest), Options::new(0.01).with_certify(true)] {
        for (name, map) in &maps() {
            let refit = |o: &Outline| {
                let w = warp_path(o, map.as_ref(), &options).unwrap();
                let bits: Vec<[u64; 2]> =
                    w.path.elements().iter().flat_map(points).map(|p| [p.x.to_bits(), p.y.to_bits()]).collect();
                (bits, w.report.max_error.to_bits())
            };
            let alone: Vec<_> = paths.iter().map(refit).collect();
            for threads in [2, 7] {
                let next = AtomicUsize::new(0);
                let work = || {
                    let mut done = Vec::new();
                    loop {
                        let k = next.fetch_add(1, Ordering::Relaxed);
                        let Some(o) = paths.get(k) else { return done };
                        done.push((k, refit(o)));
                    }
                };
                let all: Vec<_> = std::thread::scope(|s| {
                    let hands: Vec<_> = (0..threads).map(|_| s.spawn(work)).collect();
                    hands.into_iter().flat_map(|h| h.join().unwrap()).collect()
                });
                assert_eq!(all.len(), paths.len());
                for (k, got) in all {
                    assert!(got == alone[k], "{name}: path {k} with {threads} threads");
                }
            }
        }
    }
}

fn points(el: &pathwarp::kurbo::PathEl) -> Vec<Point> {
    match *el {
        pathwarp::kurbo::PathEl::MoveTo(p) | pathwarp::kurbo::PathEl::LineTo(p) => vec![p],
        pathwarp::kurbo::PathEl::QuadTo(p, q) => vec![p, q],
        pathwarp::kurbo::PathEl::CurveTo(p, q, r) => vec![p, q, r],
        pathwarp::kurbo::PathEl::ClosePath => Vec::new(),
    }
}

#[test]
fn failure_modes_stay_within_the_tolerance() {
    let cases = [
        // A near-cusp that sixteen even samples step over.
        cubic([(200.0, 200.0), (800.0, 790.0), (205.0, 800.0), (800.0, 200.0)]),
        cubic([(492.5, 596.3), (524.6, 443.8), (479.9, 654.5), (509.9, 513.0)]),
        // Out and back along a line.
        cubic([(429.92, 717.63), (430.67, 717.63), (429.92, 717.63), (429.92, 717.63)]),
        cubic([(100.0, 500.0), (900.0, 500.0), (100.0, 500.0), (600.0, 500.0)]),
        // A closed cubic.
        cubic([(500.0, 300.0), (900.0, 900.0), (100.0, 900.0), (500.0, 300.0)]),
        // Coincident handles at one end, at both, and all but one.
        cubic([(100.0, 200.0), (100.0, 200.0), (500.0, 700.0), (800.0, 300.0)]),
        cubic([(100.0, 200.0), (100.0, 200.0), (800.0, 300.0), (800.0, 300.0)]),
        cubic([(100.0, 200.0), (100.0, 200.0), (100.0, 200.0), (800.0, 900.0)]),
        // A true cusp.
        cubic([(200.0, 200.0), (800.0, 800.0), (200.0, 800.0), (800.0, 200.0)]),
        // Shorter than the tolerance.
        cubic([(500.0, 500.0), (500.01, 500.02), (500.03, 500.0), (500.02, 499.99)]),
        // A loop.
        cubic([(200.0, 300.0), (1200.0, 900.0), (-200.0, 900.0), (800.0, 300.0)]),
    ];
    for (name, map) in &maps() {
        for seg in cases {
            for tolerance in [1.0, 0.1, 0.01, 0.001] {
                let (n, e) = measure(seg, map.as_ref(), tolerance);
                assert!(e <= 1.0001, "{name} {tolerance} {seg:?}: {e} with {n}");
                assert!(n <= 40, "{name} {tolerance} {seg:?}: {n} pieces");
            }
        }
    }
}

#[test]
fn a_segment_that_goes_nowhere_stays_one() {
    let p = (300.0, 400.0);
    let w = warp_path(&single(cubic([p; 4])), &Bicubic::strong(), &Options::new(0.01)).unwrap();
    assert_eq!(w.report.segments_out, 1);
}

struct Same;
impl Formula for Same {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x, y)
    }
}

#[test]
fn the_identity_gives_every_segment_back() {
    let outline = Outline::from_svg(
        "M10 20L300 40C400 50 500 60 520 300S100 900 700 800Q900 700 800 400C800 400 700 300 600 350C500 400 420 420 420 420Z
         M200 200C800 800 200 800 800 200C900 100 905 100 950 300 L429.92 717.63C430.67 717.63 429.92 717.63 429.92 717.63",
    )
    .unwrap();
    for tolerance in [1.0, 1e-3, 1e-6] {
        let w = warp_path(&outline, &Same, &Options::new(tolerance)).unwrap();
        assert_eq!(w.report.segments_out, w.report.segments_in);
        let ours = pathwarp_oracle::cubics(&w.path);
        let theirs = pathwarp_oracle::cubics(&outline.to_bez_path(1e-9));
        for (a, b) in ours.iter().zip(&theirs) {
            for (p, q) in [(a.p0, b.p0), (a.p1, b.p1), (a.p2, b.p2), (a.p3, b.p3)] {
                assert!(p.distance(q) < 1e-9, "{a:?} {b:?}");
            }
        }
    }
}

#[test]
fn iso_lines_of_a_bicubic_come_out_as_their_control_points() {
    let map = Bicubic::strong();
    for (a, b) in [((0.0, 250.0), (1000.0, 250.0)), ((640.0, 1000.0), (640.0, 0.0)), ((125.0, 0.0), (125.0, 500.0))] {
        let (p, q) = (Point::from(a), Point::from(b));
        let w = warp_path(&Outline::from_points(&[p, q], false), &map, &Options::new(1e-6)).unwrap();
        let out = pathwarp_oracle::cubics(&w.path);
        assert_eq!(out.len(), 1);
        // The polynomial through four points of the image.
        let c = out[0];
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            assert!(pathwarp::kurbo::ParamCurve::eval(&c, t).distance(map.point(p.lerp(q, t))) < 1e-9);
        }
    }
}

#[test]
fn images_straight_to_rounding_become_lines() {
    // A line, and a cubic along a line, between curves that join them smoothly.
    let outline =
        Outline::from_svg("M0 400C50 350 90 300 150 300H500C600 300 700 300 900 300C950 300 980 320 1000 400");
    let outline = outline.unwrap();
    for (height, lines) in [(0.0, 2), (1e-10, 2), (1e-7, 2), (1e-4, 0)] {
        for certify in [false, true] {
            let o = Options::new(0.1).with_certify(certify);
            let w = warp_path(&outline, &Ripple(height), &o).unwrap();
            let straight = w.path.elements().iter().filter(|e| matches!(e, pathwarp::kurbo::PathEl::LineTo(_))).count();
            assert_eq!(straight, lines, "{height}");
            assert!(pathwarp_oracle::largest_turn(&pathwarp_oracle::cubics(&w.path)) < 1e-3, "{height}");
        }
    }
    // An image does not become a line if that takes much of the tolerance, or makes a corner.
    let w = warp_path(&outline, &Ripple(1e-7), &Options::new(1e-6)).unwrap();
    assert!(!w.path.elements().iter().any(|e| matches!(e, pathwarp::kurbo::PathEl::LineTo(_))));
    let hook = cubic([(100.0, 100.0), (100.0, 100.0 + 1e-6), (600.0, 100.0), (900.0, 100.0)]);
    let w = warp_path(&single(hook), &Ripple(1e-12), &Options::new(0.1)).unwrap();
    assert!(!w.path.elements().iter().any(|e| matches!(e, pathwarp::kurbo::PathEl::LineTo(_))));
}

#[test]
fn reversed_edges_become_the_same_curves_reversed() {
    let outline = Outline::from_svg(
        "M100 100C300 50 400 300 700 200L900 350Q500 400 620 800A180 90 20 1 0 300 700C200 600 150 300 100 100Z
         M500 300A120 120 0 0 1 260 300A120 120 0 0 1 500 300Z",
    )
    .unwrap();
    let back = Outline { subpaths: outline.subpaths.iter().map(Subpath::reversed).collect() };
    for (name, map) in &maps() {
        for tolerance in [1.0, 0.01] {
            let options = Options::new(tolerance).with_nodes(Nodes::Source);
            let a = warp_path(&outline, map.as_ref(), &options).unwrap();
            let b = warp_path(&back, map.as_ref(), &options).unwrap();
            let mut seen: Vec<CubicBez> = pathwarp_oracle::cubics(&b.path);
            for c in pathwarp_oracle::cubics(&a.path) {
                let mirrored = CubicBez::new(c.p3, c.p2, c.p1, c.p0);
                let line = |c: &CubicBez| c.p0.lerp(c.p3, 1.0 / 3.0) == c.p1;
                let found = seen.iter().position(|d| *d == mirrored || (line(d) && d.p0 == c.p3 && d.p3 == c.p0));
                assert!(found.is_some(), "{name} {tolerance}: {c:?}");
                seen.remove(found.unwrap());
            }
        }
    }
}

#[test]
fn smooth_joints_stay_smooth_and_circles_closed() {
    let circle = Outline::from_svg("M500 250C362 250 250 362 250 500S362 750 500 750 750 638 750 500 638 250 500 250Z");
    for outline in
        [circle.unwrap(), Outline::from_svg("M250 500A250 250 0 1 1 750 500A250 250 0 1 1 250 500Z").unwrap()]
    {
        for (name, map) in &maps() {
            for tolerance in [1.0, 0.1, 0.01, 0.001] {
                let w = warp_path(&outline, map.as_ref(), &Options::new(tolerance)).unwrap();
                let mut out = pathwarp_oracle::cubics(&w.path);
                assert_eq!(out.first().unwrap().p0, out.last().unwrap().p3);
                out.push(out[0]);
                assert!(pathwarp_oracle::largest_turn(&out) < 0.01, "{name} {tolerance}");
            }
        }
    }
}

#[test]
fn a_full_turn_in_one_arc() {
    use pathwarp::outline::EllipticArc;
    use std::f64::consts::TAU;
    for axes in [((300.0, 0.0), (0.0, 300.0)), ((400.0, 100.0), (-3.0, 12.0)), ((0.0, 30.0), (450.0, 20.0))] {
        let seg = Seg::Arc(EllipticArc::new(Point::new(500.0, 500.0), axes.0.into(), axes.1.into(), 0.4, TAU));
        for (name, map) in &maps() {
            for tolerance in [1.0, 0.1, 0.01, 0.001] {
                let (n, e) = measure(seg, map.as_ref(), tolerance);
                assert!(e <= 1.0001 && n < 60, "{name} {tolerance}: {e} {n}");
            }
        }
    }
}

#[test]
fn proofs_hold_for_every_kind_of_segment() {
    let outline = Outline::from_svg(
        "M100 100C300 50 400 300 700 200L900 350Q500 400 620 800A180 90 20 1 0 300 700C200 600 150 300 100 100Z
         M500 300A120 120 0 0 1 260 300A120 60 0 1 1 500 300ZM100 200C100 200 500 700 800 300
         M200 200C800 790 205 800 800 200M300 200V800M500 500C500.01 500.02 500.03 500 500.02 499.99",
    )
    .unwrap();
    for (name, map) in &maps() {
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            for seg in outline.segs() {
                let o = Options::new(tolerance).with_certify(true);
                let w = warp_path(&single(*seg), map.as_ref(), &o).unwrap();
                let r = &w.report;
                assert!(r.unresolved.is_empty(), "{name} {tolerance} {seg:?}");
                assert!(r.assurance >= Assurance::Certified && r.max_error <= tolerance, "{name} {tolerance} {seg:?}");
                let e = pathwarp_oracle::distance(seg, map.as_ref(), &w.path, 2000, tolerance);
                assert!(e <= r.max_error * 1.0001 + 1e-9, "{name} {tolerance} {seg:?}: {e} > {}", r.max_error);
                assert!(r.segments_out < 40, "{name} {tolerance} {seg:?}: {}", r.segments_out);
            }
        }
    }
}

#[test]
fn folds_are_followed_even_along_the_kernel() {
    // J·c' = 0 at (500, ·) for the direction (1, −0.06): a cusp of the image.
    let segs = [
        "M200 518L800 482",
        "M200 300L800 320",
        "M200 300C400 500 600 100 800 300",
        "M500 100C500 300 500 600 500 900",
        "M440 503.6C480 501.2 520 498.8 560 496.4",
    ];
    for d in segs {
        let seg = *Outline::from_svg(d).unwrap().segs().next().unwrap();
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            let (n, e) = measure(seg, &Fold, tolerance);
            assert!(e <= 1.0001 && n < 40, "{d} {tolerance}: {e} {n}");
        }
    }
}
