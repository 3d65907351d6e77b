//! Long curves get no more pieces than by a greedy search, in work proportional to the number of pieces.

use super::common::{Drawn, distance, wave};
use bezierfit::{Degree, Error, Nodes, Options, Pieces, Source, fit, simplify};
use kurbo::{BezPath, ParamCurve, Point, Vec2};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Run, apart};
use std::f64::consts::TAU;

/// An Archimedean spiral with a number of turns, out to a radius.
fn spiral(turns: f64, radius: f64) -> Drawn<'static> {
    let eval = move |t: f64| {
        let u = Vec2::from_angle(TAU * turns * t);
        ((u * (radius * t)).to_point(), (u + Vec2::new(-u.y, u.x) * (TAU * turns * t)) * radius)
    };
    Drawn::new(eval, Vec::new())
}

/// A curve of radius r(φ) for one turn, given r and its derivative.
fn polar(radius: impl Fn(f64) -> (f64, f64) + 'static) -> Drawn<'static> {
    let eval = move |t: f64| {
        let ((r, dr), d) = (radius(TAU * t), Vec2::from_angle(TAU * t));
        ((d * r).to_point(), (d * dr + Vec2::new(-d.y, d.x) * r) * TAU)
    };
    Drawn::new(eval, Vec::new())
}

fn lissajous(a: f64, b: f64) -> Drawn<'static> {
    let eval = move |t: f64| {
        let ((sa, ca), (sb, cb)) = ((a * TAU * t).sin_cos(), (b * TAU * t).sin_cos());
        (Point::new(100.0 * sa, 100.0 * cb), Vec2::new(a * ca, -b * sb) * (100.0 * TAU))
    };
    Drawn::new(eval, Vec::new())
}

/// A line under a wave with decreasing amplitude.
fn dying() -> Drawn<'static> {
    let eval = |t: f64| {
        let ((s, c), k) = ((40.0 * t).sin_cos(), (-2.0 * t).exp() * 30.0);
        (Point::new(300.0 * t, k * s), Vec2::new(300.0, k * (40.0 * c - 2.0 * s)))
    };
    Drawn::new(eval, Vec::new())
}

fn curves() -> Vec<(&'static str, Drawn<'static>)> {
    vec![
        ("wave", wave(25.0)),
        ("long wave", wave(200.0)),
        ("spiral", spiral(4.0, 100.0)),
        ("Lissajous 3:2", lissajous(3.0, 2.0)),
        ("Lissajous 5:4", lissajous(5.0, 4.0)),
        ("dying wave", dying()),
        ("flower", polar(|u| (100.0 + 20.0 * (7.0 * u).cos(), -140.0 * (7.0 * u).sin()))),
    ]
}

fn count(source: &Drawn<'_>, options: &Options) -> usize {
    fit(source, options).unwrap().path.segments().count()
}

/// Largest distance of a path from a curve. Fails unless the path runs along all of the curve in order. `guess` gives the approximate
/// parameter of the nearest point.
fn along(source: &Drawn<'_>, path: &BezPath, guess: impl Fn(Point) -> f64) -> f64 {
    let (mut worst, mut last, mut longest) = (0.0f64, 0.0, 0.0f64);
    for p in path.segments().flat_map(|s| (0..=24).map(move |i| s.eval(f64::from(i) / 24.0))) {
        let mut t = guess(p);
        for _ in 0..6 {
            let (q, d) = source.eval(t);
            t = (t + (p - q).dot(d) / d.hypot2().max(1e-300)).clamp(0.0, 1.0);
        }
        worst = worst.max(source.eval(t).0.distance(p));
        (longest, last) = (longest.max((t - last).abs()), t);
    }
    assert!(longest < 0.01 && last > 1.0 - 1e-9, "leaves out {longest} of the curve, and what follows {last}");
    worst
}

#[test]
fn long_curves_are_covered_in_proportion_to_their_pieces() {
    let waves = wave(1000.0 * TAU);
    let [long, short] = [spiral(200.0, 1000.0), spiral(20.0, 1000.0)];
    let turns = |p: Point| p.to_vec2().hypot() / 1000.0;
    type Row<'a> = (&'a Drawn<'static>, Degree, &'a dyn Fn(Point) -> f64, f64);
    let rows: [Row<'_>; 3] = [
        (&long, Degree::Cubic, &turns, 0.01),
        (&short, Degree::Quadratic, &turns, 0.1),
        (&waves, Degree::Cubic, &|p| p.x / 300.0, 0.01),
    ];
    for (source, degree, guess, tolerance) in rows {
        source.evaluations.set(0);
        let fitted = fit(source, &Options::new(tolerance).with_degree(degree)).unwrap();
        let (pieces, spent) = (fitted.path.segments().count(), source.evaluations.get());
        println!("{degree:?}: {pieces} pieces, {} evaluations each", spent / pieces);
        assert!(fitted.report.max_error <= tolerance && spent < 700 * pieces, "{spent} for {pieces}");
        let error = along(source, &fitted.path, guess);
        assert!(error <= tolerance, "{error}");
    }
}

#[test]
fn what_cannot_be_fitted_is_an_error_with_the_true_distance() {
    for (jump, merge) in [(50.0, true), (0.5, true), (50.0, false), (-3e4, true)] {
        let torn =
            |t: f64| (Point::new(100.0 * t, if t < 0.4567 { 0.0 } else { jump } + 5.0 * t), Vec2::new(100.0, 5.0));
        let (torn, options) = (
            Drawn::new(torn, Vec::new()),
            Options::new(0.01).with_nodes(if merge { Nodes::Fewest } else { Nodes::Source }),
        );
        let Err(Error::NotMet { at, error }) = fit(&torn, &options) else { panic!() };
        assert!((at.x - 45.67).abs() < 1.0, "{at}");
        let best = fit(&torn, &options.with_best(true)).unwrap();
        // Treat either side of the jump as a separate curve.
        let sides = |(i, t): (usize, f64)| [0.4567f64.next_down() * t, 0.4567 + 0.5433 * t][i];
        let sides = Run::new(2, |place| torn.eval(sides(place)).0);
        let truth = apart(&sides.sampled(500, 0.01), &Run::of(&best.path.curves()).sampled(40, 0.01)).0;
        assert!(error >= truth && error <= 1.1 * truth, "{error} for {truth}");
        assert_eq!(best.report.max_error, error);
    }
}

#[test]
fn endless_derivatives_at_an_end_are_errors() {
    let from = |slope: fn(f64) -> f64| move |t: f64| (Point::new(t, t.sqrt()), Vec2::new(1.0, slope(t)));
    let steep = Drawn::new(from(|t| 0.5 / t.sqrt()), Vec::new());
    let huge = Drawn::new(from(|t| if t == 0.0 { 1e300 } else { 0.5 / t.sqrt() }), Vec::new());
    let backwards = |t: f64| (Point::new(t, (1.0 - t).sqrt()), Vec2::new(1.0, -0.5 / (1.0 - t).sqrt()));
    let backwards = Drawn::new(backwards, Vec::new());
    for degree in [Degree::Cubic, Degree::Quadratic] {
        let options = Options::new(0.01).with_degree(degree);
        for endless in [&steep, &backwards] {
            assert!(matches!(fit(endless, &options), Err(Error::NotFinite(_))));
        }
        let fitted = fit(&huge, &options);
        assert!(fitted.as_ref().map_or(true, |f| distance(&huge, &f.path, 0.01) <= 0.01), "{fitted:?}");
    }
}

/// Number of pieces if each extends as far as possible.
fn greedy(source: &Drawn<'_>, tolerance: f64) -> usize {
    let fits = |from: f64, to: f64| {
        let part = |t: f64| {
            let (p, d) = source.eval(from + (to - from) * t);
            (p, d * (to - from))
        };
        let options = Options::new(tolerance).with_nodes(Nodes::Source).with_evaluations(0).with_best(true);
        fit(&Drawn::new(part, Vec::new()), &options).unwrap().report.unresolved.is_empty()
    };
    let (mut from, mut pieces, mut step) = (0.0, 0, 0.1);
    while from < 1.0 {
        // Gallop until a piece misses, and bisect.
        let (mut low, mut high) = (from, f64::INFINITY);
        while low < 1.0 && high - low > 1e-3 * step {
            let to = if high.is_finite() { 0.5 * (low + high) } else { (low + step).min(1.0) };
            *if fits(from, to) { &mut low } else { &mut high } = to;
        }
        (step, from, pieces) = (0.4 * (low - from), low, pieces + 1);
    }
    pieces
}

#[test]
fn long_curves_take_hardly_more_pieces_than_a_greedy_search() {
    let (mut all, mut least, mut wrong) = (0, 0, Vec::new());
    for (name, curve) in curves() {
        for tolerance in [1.0, 0.1, 0.01] {
            let (found, greedy) = (count(&curve, &Options::new(tolerance)), greedy(&curve, tolerance));
            if found as f64 > (1.25 * greedy as f64).max(greedy as f64 + 1.0) {
                wrong.push(format!("{name} within {tolerance}: {found}, greedy {greedy}"));
            }
            (all, least) = (all + found, least + greedy);
        }
    }
    println!("{all} pieces, greedy {least}");
    assert!(wrong.is_empty() && all as f64 <= 1.05 * least as f64, "{all}, greedy {least}; {wrong:#?}");
}

/// Tests some 700 pairs of neighbouring tolerances. Where break points happen to suit the symmetry of a curve, a smaller tolerance may take
/// fewer pieces.
#[test]
fn larger_tolerances_take_hardly_ever_more_than_one_piece_more() {
    let (mut more, mut all) = (Vec::new(), 0);
    for (name, curve) in curves() {
        let mut least = usize::MAX;
        for k in 0..100 {
            let tolerance = 1e-3 * 1.1f64.powi(k);
            let found = count(&curve, &Options::new(tolerance));
            assert!(
                found as f64 <= 1.0 + 1.15 * least as f64,
                "{name} within {tolerance}: {found}, within less {least}"
            );
            if found > least.saturating_add(1) {
                more.push(format!("{name} within {tolerance}: {found}, within less {least}"));
            }
            (least, all) = (least.min(found), all + 1);
        }
    }
    println!("{} of {all} take more: {more:#?}", more.len());
    assert!(12 * more.len() <= all, "{} of {all}: {more:#?}", more.len());
}

#[test]
fn a_fit_knows_what_simplification_knows() {
    let mut wrong = Vec::new();
    for (name, curve) in curves() {
        for tolerance in [0.5, 0.1, 0.05] {
            let direct = count(&curve, &Options::new(tolerance));
            let fine = fit(&curve, &Options::new(0.01 * tolerance)).unwrap();
            let simple = simplify(&fine.path, &Options::new(0.99 * tolerance)).unwrap().path.segments().count();
            if direct > simple {
                wrong.push(format!("{name} within {tolerance}: {direct}, by way of a finer fit {simple}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// An exception is a curve that runs back on itself: only with a narrow range of tolerances do pieces end where it turns.
#[test]
fn a_given_number_of_pieces_is_about_as_close_as_any_tolerance_leads_to() {
    const MOST: usize = 10;
    let mut wrong = Vec::new();
    for (name, curve) in curves().into_iter().filter(|c| c.0 != "long wave") {
        // Least error of fits with each number of pieces.
        let mut least = [f64::INFINITY; MOST + 1];
        for k in 0..120 {
            let fitted = fit(&curve, &Options::new(1e-2 * 1.08f64.powi(k))).unwrap();
            let error = fitted.report.max_error;
            least.iter_mut().skip(fitted.path.segments().count()).for_each(|e| *e = e.min(error));
        }
        for (n, least) in least.into_iter().enumerate().skip(1) {
            let Ok(fitted) = fit(&curve, &Options::new(1.0).with_pieces(Pieces::Exactly(n))) else { continue };
            let error = fitted.report.max_error;
            assert!(distance(&curve, &fitted.path, error) <= 1.001 * error && fitted.path.segments().count() == n);
            if error > 1.3 * least && (name != "Lissajous 3:2" || error > 9.0 * least) {
                wrong.push(format!("{name} in {n}: {error}, some tolerance {least}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
