//! Lines of lettering in shapes: stems, folds, heights, gaps and the outline of the shape, measured on the results.

use pathwarp::deform::{Built, Envelope, Lines};
use pathwarp::kurbo::{Affine, BezPath, ParamCurve, ParamCurveNearest, Point, Rect, Shape};
use pathwarp::param::Letter;
use pathwarp::{Outline, refit};

const SHAPES: &str = include_str!("../../../samples/shapes.svg");

/// Returns the names and paths of the sample shapes.
fn shapes() -> Vec<(&'static str, Outline)> {
    let attribute = |line: &'static str, name: &str| Some(line.split_once(name)?.1.split_once('"')?.0);
    let named = SHAPES.lines().filter_map(|l| Some((attribute(l, "<path id=\"")?, attribute(l, " d=\"")?)));
    named.map(|(name, d)| (name, Outline::from_svg(d).unwrap())).collect()
}

/// Returns blocks as high as capitals and about as wide, line by line.
fn letters(lines: &[&str]) -> Vec<(usize, Letter)> {
    let mut out = Vec::new();
    for (row, line) in lines.iter().enumerate() {
        let (mut x, y) = (0.0, 130.0 * row as f64 + 72.0);
        for c in line.chars() {
            let width = match c {
                'I' => 28.0,
                'M' | 'W' => 92.0,
                _ => 62.0,
            };
            let d = format!("M{x},{y} V{} H{} V{y} Z", y - 72.0, x + width);
            let outline = Outline::from_svg(&d).unwrap();
            out.push((row, Letter { name: c.into(), origin: Point::new(x, y), advance: width + 8.0, outline }));
            x += width + 8.0;
        }
    }
    out
}

fn put(letters: &[(usize, Letter)], shape: &Outline, lines: Lines) -> Result<Built, pathwarp::Error> {
    let boxes = letters.iter().filter_map(|l| l.1.outline.bounding_box());
    let frame = boxes.reduce(|a, b| a.union(b)).unwrap();
    let all: Vec<Letter> = letters.iter().map(|l| l.1.clone()).collect();
    Envelope::new(frame, shape).letters(all).lines(lines).build()
}

/// Returns the outlines of all letters at their positions in the map's source.
fn sources(built: &Built, letters: &[(usize, Letter)]) -> Vec<(usize, Outline, Rect)> {
    let place = |k: usize| built.placement.letters.get(k).map_or(Affine::IDENTITY, |p| p[0]);
    let one = |(k, (row, l)): (usize, &(usize, Letter))| {
        let outline = l.outline.transformed(place(k));
        let bounds = outline.bounding_box().unwrap();
        (*row, outline, bounds)
    };
    letters.iter().enumerate().map(one).collect()
}

const WORDS: [&[&str]; 4] = [
    &["LOVE", "MUSIC"],
    &["LOVE", "MUSIC", "ALWAYS"],
    &["I", "EXTRAORDINARY", "YOU"],
    &["EAT", "SLEEP", "SURF", "REPEAT"],
];

/// In every shape nothing folds, stems stand, and at its lowest point the lowest letter is at least a third as high as the highest.
#[test]
fn letters_stand_and_are_alike() {
    let all = shapes();
    assert_eq!(all.len(), 24);
    for words in WORDS {
        let letters = letters(words);
        for (name, shape) in &all {
            let built = put(&letters, shape, Lines::Fit).unwrap_or_else(|e| panic!("{name} {words:?}: {e}"));
            let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
            for (_, _, b) in sources(&built, &letters) {
                let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
                for i in 0..=12 {
                    let x = b.x0 + b.width() * f64::from(i) / 12.0;
                    let ends = [b.y0, b.y1].map(|y| built.map.point(Point::new(x, y)));
                    let h = ends[1].y - ends[0].y;
                    (least, most) = (least.min(h), most.max(h));
                    for j in 0..=12 {
                        let jet = built.map.jet(Point::new(x, b.y0 + b.height() * f64::from(j) / 12.0));
                        assert!(jet.det() > 0.0, "{name} {words:?}: folds at {:?}", jet.p);
                        assert!((jet.p.x - ends[0].x).abs() < 1e-9, "{name} {words:?}: leans at {:?}", jet.p);
                    }
                }
                (low, high) = (low.min(least), high.max(most));
            }
            assert!(low >= high / 3.0, "{name} {words:?}: letters from {low} to {high}");
        }
    }
}

/// Fitted letters lie in the shape, and the lines keep one distance.
#[test]
fn letters_fill_the_shape_and_keep_their_distance() {
    let letters = letters(&["LOVE", "MUSIC", "ALWAYS"]);
    for (name, shape) in shapes() {
        let built = put(&letters, &shape, Lines::Fit).unwrap();
        let (path, size): (BezPath, f64) = (shape.to_bez_path(1e-4), shape.bounding_box().unwrap().size().max_side());
        let sources = sources(&built, &letters);
        for (_, outline, _) in &sources {
            let bent = refit::warp_path(outline, &built.map, &refit::Options::new(1e-3)).unwrap().path;
            for p in bent.segments().flat_map(|s| [0.0, 0.21, 0.47, 0.74].map(|t| s.eval(t))) {
                let off =
                    || path.segments().map(|s| s.nearest(p, 1e-6).distance_sq.sqrt()).fold(f64::INFINITY, f64::min);
                assert!(path.winding(p) != 0 || off() < 2e-3 * size, "{name}: {p:?} is {} outside", off());
            }
        }
        // The bottom of a line and the top of the next one at equal x.
        let at = |row: usize, x: f64, top: bool| {
            sources.iter().filter(|s| s.0 == row).find_map(|(_, _, b)| {
                let [x0, x1] = [b.x0, b.x1].map(|x| built.map.point(Point::new(x, b.y0)).x);
                (x0..=x1).contains(&x).then(|| {
                    let x = b.x0 + (x - x0) / (x1 - x0) * b.width();
                    built.map.point(Point::new(x, if top { b.y0 } else { b.y1 })).y
                })
            })
        };
        let bounds = shape.bounding_box().unwrap();
        let xs = || (0..200).map(|i| bounds.x0 + bounds.width() * (f64::from(i) + 0.5) / 200.0);
        let gaps = [0, 1].map(|row| {
            let mut gaps: Vec<f64> = xs().filter_map(|x| Some(at(row + 1, x, true)? - at(row, x, false)?)).collect();
            gaps.sort_by(f64::total_cmp);
            assert!(gaps.first().is_some_and(|g| *g > 0.0), "{name}: lines {row} and the next touch");
            gaps[gaps.len() / 2]
        });
        let (a, b) = (gaps[0].min(gaps[1]), gaps[0].max(gaps[1]));
        assert!(b <= 1.35 * a, "{name}: gaps of {gaps:?}");
    }
}

/// More lines than a shape can hold are refused by name; one map for all still accepts them.
#[test]
fn a_line_without_room_is_named() {
    let shapes = shapes();
    let shape = &shapes.iter().find(|s| s.0 == "drop").unwrap().1;
    let letters = letters(&["A"; 30]);
    let error = put(&letters, shape, Lines::Fit).unwrap_err().to_string();
    assert!(error.contains("has no room") && error.contains("line"), "{error}");
    // Lines that would leave most of the shape empty.
    let bar = Outline::from_svg("M0,0 H1000 V60 H0 Z").unwrap();
    let words = self::letters(&["LOVE", "MUSIC", "ALWAYS"]);
    assert!(put(&words, &bar, Lines::Fit).unwrap_err().to_string().contains("has no room"));
    assert!(put(&words, &Outline::from_svg("M0,0 H200 V60 H0 Z").unwrap(), Lines::Fit).is_ok());
    let together = put(&letters, shape, Lines::Together).unwrap();
    assert!(together.explanation.notes.iter().any(|n| n.contains("columns")) && together.placement.letters.is_empty());
}
