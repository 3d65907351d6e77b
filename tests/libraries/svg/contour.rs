//! The line around all that is visible. The truth is the distance from outlines of the visible artwork, written by hand.

use base64::Engine as _;
use pathwarp::edit::Contour;
use pathwarp::kurbo::{Affine, Point};
use pathwarp::map::AffineMap;
use pathwarp::{Outline, refit};
use pathwarp_engine::Warper;
use pathwarp_oracle::drawings::{drawing, read};
use pathwarp_oracle::{Polygon, Random, flat};
use pathwarp_raster::{Pixmap, encode_png};
use pathwarp_svg::engine::CutLine;
use pathwarp_svg::{Edit, PageFit, WarpOptions, WarpedDocument};

const TOLERANCE: f64 = 0.01;

fn contoured(svg: &str, contour: Contour, line: CutLine) -> WarpedDocument {
    let options = WarpOptions::new(refit::Options::new(TOLERANCE)).with_line(line).with_page(PageFit::Auto);
    read(svg).warp(&AffineMap(Affine::IDENTITY), &options.editing(Edit::Contour(contour))).unwrap()
}

fn around(by: f64) -> Contour {
    Contour { by, holes: false, join: false }
}

/// Returns the outline of the line in a result.
fn line(svg: &str) -> Outline {
    let read = read(svg);
    let line = read.path("Contour-line").unwrap();
    line.outline
}

fn polygon(paths: &[&str]) -> Vec<Polygon> {
    paths.iter().map(|d| flat(&Outline::from_svg(d).unwrap(), 0.01 * TOLERANCE)).collect()
}

/// Checks that points nearer than the distance lie inside of the line, and others do not.
fn check(what: &str, line: &Outline, visible: &[Polygon], (by, tolerance): (f64, f64)) {
    let (line, mut random) = (flat(line, 0.01 * TOLERANCE), Random::new(7));
    for _ in 0..4000 {
        let p = Point::new(random.between(-20.0, 120.0), random.between(-20.0, 120.0));
        let distance = visible.iter().map(|v| v.outside(p)).fold(f64::INFINITY, f64::min);
        if (distance - by).abs() > tolerance {
            assert_eq!(line.covers(p), distance < by, "{what}: {p:?} is {distance} away");
        }
    }
}

const DISC: &str = "M38,50A12,12 0 1 1 62,50A12,12 0 1 1 38,50Z";

#[test]
fn the_line_has_its_distance_from_all_that_is_visible() {
    let cases = [
        ("a fill", "<path d='M20,20H50V60Z'/>", "M20,20H50V60Z"),
        ("an open fill", "<path d='M20,20H50V60'/>", "M20,20H50V60Z"),
        ("a stroke", "<circle cx='50' cy='50' r='10' fill='none' stroke='#000' stroke-width='4'/>", DISC),
        (
            "a stroke of fixed width",
            "<g transform='scale(2)'><circle cx='25' cy='25' r='5' fill='none' stroke='#000' stroke-width='4' vector-effect='non-scaling-stroke'/></g>",
            DISC,
        ),
        ("a copy", "<defs><circle id='c' r='12'/></defs><use href='#c' x='50' y='50'/>", DISC),
        (
            "what is hidden",
            "<circle cx='50' cy='50' r='12'/><rect width='9' height='9' opacity='0'/><rect width='9' height='9' visibility='hidden'/><rect width='9' height='9' fill='none'/>",
            DISC,
        ),
        (
            "a clip path",
            "<clipPath id='k'><rect x='40' y='30' width='20' height='10'/></clipPath><rect width='99' height='99' clip-path='url(#k)'/>",
            "M40,30H60V40H40Z",
        ),
        (
            "a clipped clip path",
            "<clipPath id='j'><rect x='50' width='50' height='99'/></clipPath><clipPath id='k' clip-path='url(#j)'><rect x='40' y='30' width='20' height='10'/></clipPath><g clip-path='url(#k)'><rect width='99' height='99'/></g>",
            "M50,30H60V40H50Z",
        ),
        (
            "a mask",
            "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='99' height='99'><rect x='20' y='20' width='40' height='20' fill='#888'/><rect x='10' y='10' width='30' height='40'/></mask><rect width='99' height='99' mask='url(#m)'/>",
            "M40,20H60V40H40Z",
        ),
        (
            "a mask by opacity",
            "<mask id='m' style='mask-type:alpha'><rect x='20' y='20' width='40' height='20'/></mask><rect width='99' height='99' mask='url(#m)'/>",
            "M20,20H60V40H20Z",
        ),
    ];
    for (what, body, visible) in cases {
        for by in [2.0, 7.0] {
            let result = contoured(&drawing(body), around(by), CutLine::default());
            check(what, &line(&result.svg), &polygon(&[visible]), (by, 1.5 * TOLERANCE));
        }
    }
}

/// With a negative distance, the line is inside: its points are farther than the distance from everything outside.
#[test]
fn a_line_may_be_inside() {
    let result = contoured(&drawing("<rect x='20' y='20' width='60' height='40'/>"), around(-5.0), CutLine::default());
    let found = line(&result.svg).bounding_box().unwrap();
    assert!((found.x0 - 25.0).abs() + (found.y1 - 55.0).abs() < TOLERANCE, "{found:?}");
    let options = WarpOptions::new(refit::Options::new(TOLERANCE)).editing(Edit::Contour(around(-30.0)));
    let error =
        read(&drawing("<rect width='60' height='40'/>")).warp(&AffineMap(Affine::IDENTITY), &options).unwrap_err();
    assert!(error.to_string().contains("narrower"), "{error}");
    let error =
        read(&drawing("<rect width='60' height='40' fill='none'/>")).warp(&AffineMap(Affine::IDENTITY), &options);
    assert!(error.unwrap_err().to_string().contains("nothing is visible"));
}

/// Islands nearer than twice the distance share a line; necks join others. Holes are filled, with their contents.
#[test]
fn islands_and_holes() {
    let islands = |gap: f64, join: bool| {
        let body = format!(
            "<rect x='10' y='10' width='20' height='20'/><rect x='{0}' y='10' width='20' height='20'/><circle cx='20' cy='{0}' r='5'/>",
            30.0 + gap
        );
        let result = contoured(&drawing(&body), Contour { join, ..around(3.0) }, CutLine::default());
        (result.shapes[0].copies, line(&result.svg))
    };
    // The disc is nearer by its radius.
    assert_eq!([5.9, 6.1, 11.1].map(|gap| islands(gap, false).0), [1, 2, 3]);
    let (count, joined) = islands(20.0, true);
    assert_eq!((count, joined.subpaths.len()), (1, 1));
    // A neck between the two squares, 3 wide and 14 long.
    let area = flat(&joined, 0.01 * TOLERANCE);
    let across = (0..2000).filter(|i| area.covers(Point::new(40.0, 5.0 + f64::from(*i) * 0.015))).count();
    assert!((f64::from(across as u32) * 0.015 - 3.0).abs() < 0.05, "{across}");
    let ring =
        drawing("<path fill-rule='evenodd' d='M10,10H90V90H10ZM30,30H70V70H30Z'/><circle cx='50' cy='50' r='4'/>");
    let of = |holes| line(&contoured(&ring, Contour { holes, ..around(2.0) }, CutLine::default()).svg).subpaths.len();
    assert_eq!([of(false), of(true)], [1, 3]);
}

/// The layer lies above everything, the page holds it, and the rest of the file is unchanged.
#[test]
fn the_line_is_a_layer() {
    let source = drawing("<title>t</title><rect id='r' width='100' height='100'/>");
    let cut = CutLine { spot: Some("Cut Contour".into()), bleed: 0.0, marks: true, ..CutLine::default() };
    let WarpedDocument { svg, page, .. } = contoured(&source, around(2.0), cut);
    let layer = svg.find("<g id=\"Cut-Contour\" data-contour=\"Cut Contour\"").unwrap();
    assert!(
        svg.find("id='r' width='100' height='100'/>").unwrap() < layer
            && svg.contains("inkscape:label=\"Cut Contour\""),
        "{svg}"
    );
    assert!(svg.contains("data-spot=\"Cut Contour\"") && svg.contains("data-spot=\"All\""), "{svg}");
    assert!(page.unwrap()[1].width() > 104.0);
    let only = contoured(&source, around(2.0), CutLine { only: true, ..CutLine::default() }).svg;
    assert!(!only.contains("<rect") && line(&only).subpaths.len() == 1, "{only}");
}

/// A PNG with an opaque disc; half a pixel is uncertain.
#[test]
fn pictures_count_by_their_opacity() {
    let mut disc = Pixmap::new(100, 100).unwrap();
    for (i, p) in disc.data_mut().chunks_exact_mut(4).enumerate() {
        let [x, y] = [i % 100, i / 100].map(|v| v as f64 + 0.5 - 50.0);
        let opacity = (24.5 - x.hypot(y)).clamp(0.0, 1.0);
        p.copy_from_slice(&[0, 0, 0, (255.0 * opacity).round() as u8]);
    }
    let png = base64::engine::general_purpose::STANDARD.encode(encode_png(&disc).unwrap());
    // A pixel is half a unit.
    let body = format!("<image x='25' y='25' width='50' height='50' href='data:image/png;base64,{png}'/>");
    let mut warper =
        Warper::edit(&pathwarp::deform::Registry::builtin(), "contour", &[("by", "3"), ("only", "true")]).unwrap();
    warper.set_option("tolerance", "0.01").unwrap();
    let result = warper.warp_drawing(drawing(&body).as_bytes(), None).unwrap();
    let line = line(&String::from_utf8(result.bytes).unwrap());
    check("a picture", &line, &polygon(&[DISC]), (3.0, 0.25));
    assert!(line.segs().count() < 30, "{}", line.segs().count());
}
