//! Tests of the comparison.

use super::MAX_OF_PAGE;
use super::measure::{Bend, Picture, ToPixels, compare};
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::Map as _;
use pathwarp::param::{Args, Frame};

const SIDE: usize = 400;
const SAMPLES: usize = 4;

/// A picture of a disc and a line about one pixel wide, antialiased by averaging samples.
fn painted(color: [u8; 3], bend: impl Fn(f64, f64) -> (f64, f64)) -> Picture {
    let covers = |x: f64, y: f64| (x - 150.0).hypot(y - 220.0) < 60.0 || (x + y / 3.0 - 300.0).abs() < 0.7;
    let mut data = Vec::new();
    for i in 0..SIDE * SIDE {
        let sample = |k: usize, c: usize| c as f64 + (k as f64 + 0.5) / SAMPLES as f64;
        let covered = (0..SAMPLES * SAMPLES)
            .filter(|k| {
                let (x, y) = bend(sample(k % SAMPLES, i % SIDE), sample(k / SAMPLES, i / SIDE));
                covers(x, y)
            })
            .count();
        let part = |c: u8| (f64::from(c) * covered as f64 / (SAMPLES * SAMPLES) as f64) as u8;
        data.extend([part(color[0]), part(color[1]), part(color[2]), part(255)]);
    }
    Picture { width: SIDE, height: SIDE, data }
}

fn differs(original: &Picture, found: &Picture, bend: Bend) -> bool {
    compare(original, found, bend, [SIDE, SIDE]).0.differs(MAX_OF_PAGE)
}

#[test]
fn right_results_pass_and_wrong_ones_do_not() {
    let curve = Bend::curve(SIDE, SIDE);
    let Bend::Curve { amplitude: a, wave: k } = curve else { panic!("a curve") };
    let inverse = |x: f64, y: f64| {
        let from_y = y - a * (k * x).sin();
        (x - a * (k * from_y).sin(), from_y)
    };
    let black = painted([0; 3], |x, y| (x, y));
    for color in [[0; 3], [255; 3], [120, 170, 90]] {
        let original = painted(color, |x, y| (x, y));
        for (bend, right) in [(Bend::Shift(16), painted(color, |x, y| (x - 16.0, y))), (curve, painted(color, inverse))]
        {
            assert!(!differs(&original, &right, bend), "{color:?} {bend:?}");
            assert!(differs(&original, &original, bend), "{color:?} {bend:?} left as it was");
            let nothing = Picture { data: vec![0; 4 * SIDE * SIDE], ..right };
            assert!(differs(&original, &nothing, bend), "{color:?} {bend:?} emptied");
            assert!(color == [0; 3] || differs(&black, &right, bend), "{color:?} {bend:?} in another colour");
        }
    }
}

/// A drawing that vanishes counts however small it is on its page: 20 of 160,000 pixels.
#[test]
fn small_things_count() {
    let mut original = Picture { width: SIDE, height: SIDE, data: vec![0; 4 * SIDE * SIDE] };
    let nothing = Picture { data: original.data.clone(), ..original };
    for i in 0..20 {
        let at = 4 * ((100 + i / 4) * SIDE + 100 + i % 4);
        original.data[at..at + 4].fill(255);
    }
    assert!(differs(&original, &nothing, Bend::Shift(16)) && differs(&original, &nothing, Bend::curve(SIDE, SIDE)));
}

/// The program's map has the inverse that is used for the pictures.
#[test]
fn formulas_are_the_map_of_the_pictures() {
    let to_pixels = ToPixels { scale: [2.5, 4.0], offset: [-30.0, 7.0] };
    let curve = Bend::curve(900, 700);
    let Bend::Curve { amplitude: a, wave: k } = curve else { panic!("a curve") };
    for bend in [Bend::Shift(48), curve] {
        let [x, y] = bend.formulas(to_pixels);
        let args = Args::from_pairs(&[("x", x.as_str()), ("y", y.as_str())]);
        let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
        let map = Registry::builtin().get("expr").unwrap().build_from(&args, &frame).unwrap().map;
        for i in 0..100 {
            let p = Point::new(f64::from(i % 10) * 31.0, f64::from(i / 10) * 17.0);
            let pixel = |p: Point| Point::new(2.5 * p.x - 30.0, 4.0 * p.y + 7.0);
            let (from, to) = (pixel(p), pixel(map.point(p)));
            let back = match bend {
                Bend::Shift(by) => Point::new(to.x - by as f64, to.y),
                Bend::Curve { .. } => {
                    let y = to.y - a * (k * to.x).sin();
                    Point::new(to.x - a * (k * y).sin(), y)
                }
            };
            assert!(from.distance(back) < 1e-6, "{bend:?}: {from:?} {back:?}");
        }
    }
}
