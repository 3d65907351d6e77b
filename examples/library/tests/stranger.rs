//! What programs do that know kurbo and not pathwarp: each checked against formulas.

use pathwarp::engine::KnownShapes;
use pathwarp::kurbo::{Affine, BezPath, Circle, Ellipse, ParamCurve, Point, Rect, RoundedRect, Shape, Vec2};
use pathwarp::map::{AffineMap, Chain, Map, NewtonInverse, from_fn, from_fn_with};
use pathwarp::outline::Seg;
use pathwarp::refit::{self, Nodes, Options};
use pathwarp::{Error, GeometryError, Outline};
use pathwarp_svg::{Document, ReadOptions, WarpOptions};
use std::sync::Arc;

fn wave(p: Point) -> Point {
    Point::new(p.x, p.y + (p.x / 20.0).sin() * 5.0)
}

fn slopes(p: Point) -> [Vec2; 2] {
    [Vec2::new(1.0, (p.x / 20.0).cos() / 4.0), Vec2::new(0.0, 1.0)]
}

/// The largest distance of a path from the graph of the wave over the line y = `at`.
fn off(path: &BezPath, at: f64) -> f64 {
    let points = path.segments().flat_map(|s| (0..=50).map(move |i| s.eval(f64::from(i) / 50.0)));
    points.map(|p| (p.y - wave(Point::new(p.x, at)).y).abs()).fold(0.0, f64::max)
}

#[test]
fn closures_are_maps_with_and_without_derivatives() {
    let line = Outline::from_svg("M0,30 H300").unwrap();
    let (differences, exact) = (from_fn(wave), from_fn_with(wave, slopes));
    let maps: [&dyn Map; 2] = [&differences, &exact];
    let warped = maps.map(|map| refit::warp_path(&line, map, &Options::new(1e-3)).unwrap());
    for w in &warped {
        assert!(w.report.max_error <= 1e-3 && off(&w.path, 30.0) <= 1.02e-3);
    }
    assert_eq!(warped[0].report.segments_out, warped[1].report.segments_out);
}

/// A function of a caller's own, for any map.
fn moved(map: impl Map, p: Point) -> Point {
    map.point(p)
}

#[test]
#[expect(clippy::needless_borrows_for_generic_args, reason = "references to maps are what is tested")]
fn pointers_to_maps_are_maps() {
    let p = Point::new(3.0, 4.0);
    let (map, shared, boxed) = (from_fn(wave), Arc::new(from_fn(wave)), Box::new(from_fn(wave)) as Box<dyn Map>);
    let lent: &dyn Map = &map;
    assert_eq!([moved(lent, p), moved(&*shared as &dyn Map, p), moved(&*boxed, p)], [wave(p); 3]);
    assert_eq!([moved(&map, p), moved(&&map, p), moved(Box::new(&map), p), moved(&shared, p)], [wave(p); 4]);
    assert_eq!([moved(Arc::clone(&shared), p), moved(shared as Arc<dyn Map>, p), moved(boxed, p)], [wave(p); 3]);
    let boxed: Box<dyn Map> = Box::new(AffineMap(Affine::rotate(1.0)));
    assert_eq!(format!("{:?}", Chain::default().then(boxed).then(AffineMap(Affine::rotate(-1.0))).steps().len()), "0");
}

#[test]
fn outlines_come_from_shapes() {
    let path = Circle::new((9.0, 9.0), 5.0).to_path(1e-3);
    assert_eq!(Outline::from(path.clone()), Outline::from(&path));
    assert_eq!(Outline::from(Rect::new(0.0, 1.0, 2.0, 3.0)), Outline::from_svg("M0,1 H2 V3 H0 Z").unwrap());
    let ellipse = Ellipse::new((10.0, 20.0), (30.0, 5.0), 0.4);
    for (outline, shape) in [
        (Outline::from(ellipse), ellipse),
        (Circle::new((1.0, 2.0), 3.0).into(), Ellipse::new((1.0, 2.0), (3.0, 3.0), 0.0)),
        (Outline::from_shape(&Circle::new((1.0, 2.0), 3.0), 1.0), Ellipse::new((1.0, 2.0), (3.0, 3.0), 0.0)),
    ] {
        let (radii, turn) = shape.radii_and_rotation();
        for p in outline.segs().flat_map(|s| (0..9).map(|i| s.eval(f64::from(i) / 8.0))) {
            let local = Affine::rotate(-turn) * (p - shape.center()).to_point();
            assert!(((local.x / radii.x).hypot(local.y / radii.y) - 1.0).abs() < 1e-14);
        }
        assert!(outline.segs().all(|s| matches!(s, Seg::Arc(_))) && outline.subpaths[0].closed);
        let area: f64 = outline.to_bez_path(1e-9).area();
        assert!((area - shape.area()).abs() < 1e-4);
    }
    let button = Outline::from_shape(&RoundedRect::new(0.0, 0.0, 90.0, 30.0, 8.0), 1e-6);
    assert!((button.to_bez_path(1e-9).area() - (90.0 * 30.0 - (4.0 - std::f64::consts::PI) * 64.0)).abs() < 1e-3);
}

#[test]
fn a_chain_of_any_links_has_an_inverse() {
    let area = Rect::new(0.0, 0.0, 100.0, 100.0);
    let bulge = pathwarp::deform::Bulge::new((50.0, 50.0), 40.0).build().unwrap().map;
    let chain = Chain::default().then(from_fn(wave)).then(bulge).then(AffineMap(Affine::skew(0.2, 0.0)));
    // A closure has no closed form; Newton's method over a box is one link, or all.
    assert!(chain.inverse().is_none());
    let newton: Arc<dyn Map> = Arc::new(NewtonInverse::over(Arc::new(from_fn(wave)), area, 0.3));
    let back = Chain::new([newton]).inverse().expect("the inverse of an inverse is the map");
    assert_eq!(back.point(Point::new(7.0, 8.0)), wave(Point::new(7.0, 8.0)));
    let back = chain.inverse_over(area);
    for i in 0..400 {
        let p = Point::new(f64::from(i % 20) * 5.0 + 1.0, f64::from(i / 20) * 5.0 + 1.0);
        assert!(back.point(chain.point(p)).distance(p) < 1e-8, "{p}");
    }
}

#[test]
fn impossible_tolerances_are_errors_of_their_own() {
    let (line, map) = (Outline::from_svg("M0,30 H300").unwrap(), from_fn(wave));
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='M0,0H9'/></svg>";
    let document = Document::read(svg.as_bytes(), "a.svg", &ReadOptions::default()).unwrap();
    for t in [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let same = |e: &Error| matches!(e, Error::Tolerance(v) if v.to_bits() == t.to_bits());
        for options in [Options::new(t), Options::new(t).with_nodes(Nodes::Fewest), Options::new(t).with_suited(true)] {
            let errors: [Result<(), GeometryError>; 3] = [
                refit::warp_path(&line, &map, &options).map(drop),
                KnownShapes::default().warp_path(&line, &map, &options).map(drop),
                pathwarp_svg::warp_path(&line, &map, &options, None).map(drop),
            ];
            assert!(errors.into_iter().all(|e| same(&e.unwrap_err().into())), "{t}");
            let e = document.warp(&map, &WarpOptions::new(options)).unwrap_err();
            assert!(same(&e) && e.to_string().contains("not a positive, finite number"), "{e}");
        }
    }
    // What suits a contour is found without a panic, too.
    assert!(
        refit::suited(-1.0, 1.0) < 0.0 && refit::suited(0.0, 1.0) == 0.0 && !refit::suited(f64::NAN, 1.0).is_infinite()
    );
}

/// A formula may use a map that is none itself, and has its derivatives: those of F(F(p)).
#[test]
fn a_map_within_a_formula_keeps_its_derivatives() {
    use pathwarp::map::{Formula, Real};
    struct Twice<M>(M);
    impl<M: Map> Formula for Twice<M> {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            let map = &self.0;
            let (x, y) = Formula::f(&map, x, y);
            Formula::f(&map, x, y)
        }
    }
    let p = Point::new(3.0, 4.0);
    let jet = Twice(from_fn_with(wave, slopes)).jet(p);
    assert_eq!(jet.p, wave(wave(p)));
    assert!((jet.dx - Vec2::new(1.0, 2.0 * (p.x / 20.0).cos() / 4.0)).hypot() < 1e-15 && jet.dy == Vec2::new(0.0, 1.0));
}

/// The image of a slanted line under the wave, from a closure, and under a fold with a crease, whose image has one corner.
#[test]
fn one_curve_goes_under_a_map() {
    use pathwarp::map::{Crease, Creases, Jet, Level};
    struct Fold;
    impl Map for Fold {
        fn jet(&self, p: Point) -> Jet {
            let side = if p.x < 40.0 { -1.0 } else { 1.0 };
            Jet { p: Point::new(p.x, p.y + (p.x - 40.0).abs()), dx: Vec2::new(1.0, side), dy: Vec2::new(0.0, 1.0) }
        }
        fn creases(&self, out: &mut Creases) {
            out.push(Crease::kink(Level::Line { a: 1.0, b: 0.0, c: -40.0 }));
        }
    }
    let line = |t: f64| (Point::new(300.0 * t, 30.0), Vec2::new(300.0, 0.0));
    let options = pathwarp::fit::Options::new(1e-3);
    let waved = refit::warp_curve(&line, &from_fn(wave), &options).unwrap();
    assert!(off(&waved.path, 30.0) <= 1.02e-3 && waved.report.unresolved.is_empty());
    let folded = refit::warp_curve(&line, &Fold, &options).unwrap();
    assert_eq!(folded.path.segments().count(), 2);
    let corner = folded.path.segments().next().unwrap().eval(1.0);
    assert!(corner.distance(Point::new(40.0, 30.0)) < 1e-9);
    let half = from_fn(|p| Point::new(p.x, (150.0 - p.x).sqrt()));
    let Err(pathwarp::fit::Error::NotFinite(e)) = refit::warp_curve(&line, &half, &options) else { panic!("no error") };
    assert!(e.at.x > 150.0 && e.at.y == 30.0, "{e:?}");
}
