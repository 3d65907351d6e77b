//! Shapes that are united. The truth is the area that each shape covers by itself.

use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point};
use pathwarp::map::AffineMap;
use pathwarp::refit;
use pathwarp_oracle::drawings::{drawing, read};
use pathwarp_oracle::{Polygon, Random, flat};
use pathwarp_svg::{Edit, Structure, WarpOptions, WarpedDocument};

const TOLERANCE: f64 = 0.01;

fn united(svg: &str, by_fill: bool) -> WarpedDocument {
    united_by(svg, &WarpOptions::new(refit::Options::new(TOLERANCE)).editing(Edit::Unite { by_fill }))
}

fn united_by(svg: &str, options: &WarpOptions) -> WarpedDocument {
    read(svg).warp(&AffineMap(Affine::IDENTITY), options).unwrap()
}

/// Returns the outline of each filled shape, with its fill rule.
fn areas(svg: &str) -> Vec<(Polygon, bool)> {
    let closed = |o: &Outline| {
        let mut o = o.clone();
        for s in o.subpaths.iter_mut().filter(|s| s.end() != s.start) {
            s.segs.push(pathwarp::Seg::Line(pathwarp::kurbo::Line::new(s.end(), s.start)));
        }
        flat(&o, 0.01 * TOLERANCE)
    };
    read(svg).shapes().iter().filter(|s| s.filled && s.painted).map(|s| (closed(&s.outline), s.even_odd)).collect()
}

fn covers((area, even_odd): &(Polygon, bool), p: Point) -> bool {
    if *even_odd { area.winding(p) % 2 != 0 } else { area.covers(p) }
}

/// Squares, rings, discs, stars that cross themselves, open curves, copies and strokes, in groups that scale and turn.
#[test]
fn one_outline_covers_what_all_shapes_cover() {
    let kinds = [
        "<rect width='20' height='12'/>",
        "<rect width='16' height='16' rx='5'/>",
        "<path fill-rule='evenodd' d='M0,0H20V20H0ZM5,5H15V15H5Z'/>",
        "<circle r='9'/>",
        "<path d='M10,0L16,19L0,7H20L4,19Z'/>",
        "<path fill-rule='evenodd' d='M10,0L16,19L0,7H20L4,19Z'/>",
        "<path d='M0,0C30,0 -5,20 20,14'/>",
        "<use href='#drop'/>",
    ];
    let mut random = Random::new(64);
    for round in 0..12 {
        let shape = |k: usize, random: &mut Random| {
            let [x, y, turn] = [random.between(10.0, 70.0), random.between(10.0, 70.0), random.between(0.0, 90.0)];
            format!("<g transform='translate({x} {y}) rotate({turn}) scale(1.2 .9)'>{}</g>", kinds[k])
        };
        let count = 3 + round % 6;
        let body: String = (0..count).map(|_| shape(random.below(kinds.len()), &mut random)).collect();
        let defs = "<defs><path id='drop' d='M0,0Q20,0 20,20Q0,20 0,0Z'/></defs>";
        let source = drawing(&format!("{defs}{body}"));
        let result = united(&source, false).svg;
        let (before, after) = (areas(&source), areas(&result));
        assert_eq!((before.len(), after.len()), (count, 1), "{result}");
        for _ in 0..1500 {
            let p = Point::new(random.between(0.0, 100.0), random.between(0.0, 100.0));
            let expected = before.iter().any(|area| covers(area, p));
            if before.iter().all(|(area, _)| area.distance(p) > TOLERANCE) {
                assert_eq!(covers(&after[0], p), expected, "{p:?}\n{source}\n{result}");
            }
        }
        let flat = united_by(
            &source,
            &WarpOptions::new(refit::Options::new(TOLERANCE))
                .with_structure(Structure::Flatten)
                .editing(Edit::Unite { by_fill: false }),
        );
        assert_eq!(areas(&flat.svg).len(), 1, "{}", flat.svg);
    }
}

/// The united shape has the paint of the uppermost one, and each source is named. Curves keep their kinds.
#[test]
fn what_goes_in_is_named() {
    let source = drawing(
        "<path id='bar' class='a' fill='red' d='M10,60H90V70H10Z'/><circle id='c' class='b' cx='30' cy='55' r='15' fill='#00f'><title>Ball</title></circle>\
         <path id='d' fill='red' d='M50,30V65H70V30ZM55,35H65V50H55Z'/><line id='l' x2='50' y2='10' stroke='black'/>",
    );
    let WarpedDocument { svg, shapes, warnings, .. } = united(&source, false);
    assert!(svg.contains("<path id='d' fill='red'") && svg.contains("data-united=\"bar c d\""), "{svg}");
    assert!(svg.contains("class=\"a b\"") && svg.contains("<title>Ball</title>"), "{svg}");
    assert!(svg.contains("A15 15") && svg.contains("<line id='l'") && !svg.contains("<circle"), "{svg}");
    assert_eq!(shapes[0].united, ["bar", "c", "d"]);
    assert!(warnings.iter().any(|w| w.to_string().ends_with("no area to unite: l")), "{warnings:?}");
    let by_fill = united(&source, true).svg;
    assert!(by_fill.contains("data-united=\"bar d\"") && by_fill.contains("<circle id='c'"), "{by_fill}");
    // The second time, nothing is left to unite.
    let again = united(&by_fill, true);
    assert!(again.svg == by_fill && again.warnings.iter().any(|w| w.to_string().contains("nothing to unite")));
    // A clip path keeps its contents.
    let clipped = drawing(
        "<clipPath id='k'><rect width='50' height='99'/></clipPath><g clip-path='url(#k)'><rect id='p' width='60' height='30'/>\
         <rect id='q' y='20' width='60' height='30'/></g><rect id='r' y='40' width='80' height='20'/>",
    );
    let clipped = united(&clipped, false).svg;
    assert!(clipped.contains("data-united=\"p q\"") && clipped.contains("<rect id='r'"), "{clipped}");
}

/// Gaps narrower than the tolerance close without a trace; wider ones stay.
#[test]
fn gaps_below_the_tolerance_close() {
    let rings = |gap: f64| {
        let body = format!("<path d='M10,10H40V60H10Z'/><path d='M{0},10H80V60H{0}Z'/>", 40.0 + gap);
        read(&united(&drawing(&body), false).svg).shapes()[0].outline.clone()
    };
    for share in [0.9, 0.5, 0.1] {
        let one = rings(share * TOLERANCE);
        let corners = one.subpaths[0].anchors();
        assert!(one.subpaths.len() == 1 && corners.len() == 4, "{share}: {one:?}");
    }
    assert_eq!(rings(3.0 * TOLERANCE).subpaths.len(), 2);
}
