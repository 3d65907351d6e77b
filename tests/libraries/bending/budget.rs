//! The work of a refit is counted by the parts of the map, and images beyond the range of numbers are errors.

use pathwarp::budget::{Budget, Limit, Limits};
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::map::{AffineMap, Map};
use pathwarp::param::{Args, Frame};
use pathwarp::recipe::{Recipe, Step};
use pathwarp::refit::{Nodes, Options, warp_path};
use pathwarp::{Error, GeometryError, Outline};
use std::sync::Arc;

fn path() -> Outline {
    Outline::from_svg("M10 10C40 0 60 30 90 10V60L10 60Z").unwrap()
}

fn recipe(steps: &[(&str, &[(&str, &str)])]) -> Recipe {
    Recipe { steps: steps.iter().map(|(name, args)| Step::new(*name, Args::from_pairs(args))).collect() }
}

fn map(recipe: &Recipe) -> Arc<dyn Map> {
    let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
    Arc::new(recipe.build(&Registry::builtin(), frame, &std::iter::once(&path())).unwrap().map)
}

/// Found by fuzzing: a point without segments became infinite under an affine map.
#[test]
fn images_out_of_range_are_errors() {
    let huge = AffineMap(Affine::new([0.0, 2.0, 1.0, 0.5, 3.0, 4.0]));
    for data in ["M1e308 1e308", "M1e308 1e308l1 1", "M0 0L1e99 1e99", "M1e99 0A1e99 1e99 0 0 1 5 9"] {
        let outline = Outline::from_svg_lossy(data);
        let warped = warp_path(&outline, &huge, &Options::new(1.0));
        assert!(warped.as_ref().map_or(true, |w| w.path.is_finite()), "{data}: {warped:?}");
        assert_eq!(warped.is_err(), data.contains("308"), "{data}: {warped:?}");
    }
}

#[test]
fn a_map_of_many_parts_counts_as_many() {
    let one = map(&recipe(&[("wave", &[])]));
    let three = map(&recipe(&[("wave", &[]), ("swirl", &[]), ("wave", &[])]));
    assert_eq!((one.work(), three.work()), (1.0, 3.0));
    let sum = (1..200).map(|i| format!("+sin(x*{i})")).collect::<String>();
    assert!(map(&recipe(&[("expr", &[("x", &format!("x{sum}"))])])).work() > 30.0);
    let flag = recipe(&[("warp", &[("style", "flag")])]);
    assert!(map(&flag.inverted()).work() > 2.0 * map(&flag).work());
}

#[test]
fn the_limit_holds_within_a_single_segment() {
    let oscillating = map(&recipe(&[("expr", &[("x", "x+20*sin(x*60)")])]));
    let line = Outline::from_svg("M0 50C30 40 60 60 100 50").unwrap();
    let budget = Arc::new(Budget::new(Limits::default().with(Limit::Work, 5000.0)));
    let e = warp_path(&line, &*oscillating, &Options::new(1e-3).with_budget(Arc::clone(&budget))).unwrap_err();
    assert!(matches!(e, GeometryError::Limit(e) if e.limit == Limit::Work), "{e:?}");
    assert!(warp_path(&line, &*oscillating, &Options::new(1e-3)).is_ok());
}

/// Returns a recipe that undoes a quilt of two by two patches, the identity except for a control point far out.
fn far_quilt() -> Recipe {
    let mut points: Vec<Vec<[f64; 2]>> =
        (0..7).map(|j| (0..7).map(|i| [f64::from(i) * 100.0 / 6.0, f64::from(j) * 100.0 / 6.0]).collect()).collect();
    points[1][1] = [1e6, -1e6];
    let json = format!("{{\"region\": [0, 0, 100, 100], \"points\": {points:?}}}");
    let registry = Registry::builtin();
    let mut args = Args::from_pairs(&[("mesh", "f.json")]);
    args.resolve_files(registry.get("mesh").unwrap().info().params, |_| Ok(json.clone())).unwrap();
    let mut step = Step::new("mesh", args);
    step.inverse = true;
    Recipe { steps: vec![step] }
}

/// Found by fuzzing: this took 20 seconds. The work counts, wherever the budget comes from and whatever uses the inverse.
#[test]
fn searching_in_vain_is_counted() {
    let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
    let small = || Arc::new(Budget::new(Limits::default().with(Limit::Work, 1e6)));
    let limited = |e: &GeometryError| matches!(e, GeometryError::Limit(e) if e.limit == Limit::Work);
    // The refit alone counts the work.
    let free = map(&far_quilt());
    let e = warp_path(&path(), &*free, &Options::new(0.01).with_budget(small())).unwrap_err();
    assert!(limited(&e), "{e:?}");
    // With the recipe's budget, every use of the map counts and is reported.
    let budget = small();
    let outline = path();
    let built =
        far_quilt().build_within(&Registry::builtin(), frame.clone(), &std::iter::once(&outline), &budget).unwrap();
    assert!(built.failure().is_none());
    let place = |i: u32| pathwarp::kurbo::Point::new(f64::from(i % 100), f64::from(i / 100 % 100));
    let asked = (0..1_000_000).take_while(|i| {
        let _ = built.map.point(place(*i));
        built.failure().is_none()
    });
    let asked = asked.count() as f64;
    // Fewer calls than if all points had a source.
    assert!(asked < 1e6 / built.map.cost().work, "{asked}");
    assert!(matches!(built.failure(), Some(Error::Geometry(e)) if limited(&e)));
    assert!(built.map.point(place(0)).is_nan());
}

/// Values are equal to those of the map without a budget, bit by bit.
#[test]
fn counting_changes_no_value() {
    let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
    let outline = path();
    let recipes = [
        far_quilt(),
        recipe(&[("warp", &[("style", "twist"), ("bend", "100%")])]).inverted(),
        recipe(&[("wordart", &[("preset", "ring-inside")]), ("wave", &[])]).inverted(),
        recipe(&[("mls", &[("pair", "50,15:60,5"), ("pin", "10,90")])]).inverted(),
    ];
    for recipe in recipes {
        let build = |budget: Budget| {
            let budget = Arc::new(budget);
            recipe.build_within(&Registry::builtin(), frame.clone(), &std::iter::once(&outline), &budget).unwrap().map
        };
        let (free, counted) = (build(Budget::new(Limits::none())), build(Budget::default()));
        for i in 0..400 {
            let p = pathwarp::kurbo::Point::new(f64::from(i % 20) * 6.0 - 10.0, f64::from(i / 20) * 6.0 - 10.0);
            let bits = |q: pathwarp::kurbo::Point| (q.x.to_bits(), q.y.to_bits());
            assert_eq!(bits(free.point(p)), bits(counted.point(p)), "{recipe:?} at {p:?}");
        }
    }
}

#[test]
fn placing_the_steps_of_a_recipe_is_counted() {
    let no_args: &[(&str, &str)] = &[];
    let waves = [("wave", no_args); 40];
    let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
    let build = |limit: f64| {
        let budget = Arc::new(Budget::new(Limits::default().with(Limit::Work, limit)));
        recipe(&waves).build_within(&Registry::builtin(), frame.clone(), &std::iter::once(&path()), &budget)
    };
    assert!(build(1e6).is_ok());
    assert!(matches!(build(1e3).err().unwrap(), Error::Geometry(GeometryError::Limit(_))));
}

/// Found by fuzzing: rounding of coordinates beyond 1e15 exceeded the tolerance, and no point was reported.
#[test]
fn a_missed_tolerance_is_always_reported() {
    let swirl = map(&recipe(&[("swirl", &[])]));
    let mut missed = 0;
    for data in [
        "M50 50A1e15 23.3 75 0 0 8755814 10",
        "M85 4.7L1e15 70Q55 -82 55 10c72 55 -100 126 -120 75",
        "M0 0C1e17 30 40 1e17 90 90",
        "M1e16 1e16h30v40q9 3 4 4z",
    ] {
        for certify in [false, true] {
            let options = Options::new(0.01).with_certify(certify).with_nodes(Nodes::Fewest);
            let Ok(w) = warp_path(&Outline::from_svg(data).unwrap(), &*swirl, &options) else { continue };
            assert!(w.report.max_error <= 0.01 || !w.report.unresolved.is_empty(), "{data}: {:?}", w.report);
            missed += usize::from(w.report.max_error > 0.01);
        }
    }
    assert!(missed > 0);
}

/// Found by fuzzing: with coordinates of 1e20 to 1e27 an error of 0.01 was reported, and the result was off by 2e7.
#[test]
fn coordinates_without_resolution_are_reported() {
    let far = "M-108 55c-78 50 108 10 174445189939777770000 30c98 1e-8 -33 100 35 60c54 10 7e-29 15 89 31\
        L66 -41248332S75 50 125 -118l65 67l-1731467919582220400000000000 4.7M50 -118l122 55";
    let bend = map(&recipe(&[("bend", &[("along", "M-10,60 Q25,35 50,45 T110,50"), ("baseline", "1mm")])]));
    let mls = map(&recipe(&[("mls", &[("pair", "50,15:60,5"), ("pin", "10,90")])]));
    let large = AffineMap(Affine::scale(1e20));
    let cases: [(&str, &dyn Map); 5] = [
        (far, &*bend),
        ("M70 15l35 85c-78 50 108 10 174445189939777770000 30", &*mls),
        ("M0 0A1e17 1e17 0 0 1 2e17 0", &large),
        // Only the image is large.
        ("M10 10C40 0 60 30 90 10V60L10 60Z", &large),
        ("M10 10h30l1e14 3", &AffineMap(Affine::IDENTITY)),
    ];
    for (data, map) in cases {
        let outline = Outline::from_svg_lossy(data);
        for options in
            [Options::new(0.01), Options::new(0.01).with_certify(true), Options::new(0.01).with_nodes(Nodes::Fewest)]
        {
            let Ok(warped) = warp_path(&outline, map, &options) else { panic!("{data}") };
            let r = &warped.report;
            let resolution = r.resolution.unwrap_or_else(|| panic!("{data}: {r:?}"));
            assert!(resolution > 0.01 && r.max_error >= resolution && !r.unresolved.is_empty(), "{data}: {r:?}");
            // The largest numbers are rounded to steps of this size; sums get some room.
            let step = outline.extent().max(Outline::from(&warped.path).extent()) * f64::EPSILON;
            assert!(resolution >= step && resolution < 1e4 * step, "{data}: {resolution}");
        }
    }
    // Where numbers are fine enough nothing is reported, even if the tolerance is missed for another reason.
    for tolerance in [1e-2, 1e-8] {
        let near = warp_path(&path(), &*bend, &Options::new(tolerance)).unwrap().report;
        assert_eq!(near.resolution, None);
    }
}
