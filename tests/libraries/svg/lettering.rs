//! Lettering is recognised in text and in outlines with data attributes.

use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp_oracle::drawings::{Bend, drawing, read, warp_options};
use pathwarp_svg::Selection;
use pathwarp_svg::engine::{LetterPlaces, LetteringFrame, LetteringFrameError};

const ALL: [LetteringFrame; 5] = [
    LetteringFrame::BaselineAscent,
    LetteringFrame::BaselineCapHeight,
    LetteringFrame::BaselineXHeight,
    LetteringFrame::AscentDescent,
    LetteringFrame::Ink,
];

/// Noto Sans, 1000 units per em: ascent 1069, descent 293, capitals 714, x-height 536; H has an advance of 741 and a left side
/// bearing of 97, I an advance of 339.
const HI: &str = "<text x='10' y='80' font-size='40' font-family='Noto Sans'>HI</text>";

fn near(a: Rect, b: Rect) -> bool {
    // usvg works in single precision.
    (a.x0 - b.x0).abs() + (a.x1 - b.x1).abs() + (a.y0 - b.y0).abs() + (a.y1 - b.y1).abs() < 1e-4
}

#[test]
fn frames_of_text_are_the_fonts_own_figures() {
    let lettering = read(&drawing(HI)).lettering(&Selection::default());
    assert!(lettering.is_level() && lettering.is_all());
    let names: Vec<&str> = lettering.letters().iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["H", "I"]);
    let i = &lettering.letters()[1];
    assert!((i.origin.x - (10.0 + 0.741 * 40.0)).abs() < 1e-4 && (i.advance - 0.339 * 40.0).abs() < 1e-4, "{i:?}");
    let right = 10.0 + 1.08 * 40.0;
    let expected = [
        Rect::new(10.0, 80.0 - 1.069 * 40.0, right, 80.0),
        Rect::new(10.0, 80.0 - 0.714 * 40.0, right, 80.0),
        Rect::new(10.0, 80.0 - 0.536 * 40.0, right, 80.0),
        Rect::new(10.0, 80.0 - 1.069 * 40.0, right, 80.0 + 0.293 * 40.0),
    ];
    for (kind, rect) in ALL.into_iter().zip(expected) {
        let frame = lettering.frame(kind).unwrap();
        assert!(near(frame.rect, rect), "{kind:?}: {:?} {rect:?}", frame.rect);
        assert!((frame.baseline.unwrap() - 80.0).abs() < 1e-5);
    }
    let ink = lettering.frame(LetteringFrame::Ink).unwrap().rect;
    assert!((ink.x0 - (10.0 + 0.097 * 40.0)).abs() < 1e-3 && (ink.y0 - (80.0 - 0.714 * 40.0)).abs() < 1e-3, "{ink:?}");
}

/// A word as outlines with data attributes, in other units, is recognised like text.
#[test]
fn outlines_that_tell_of_themselves_are_like_text() {
    let text = read(&drawing(HI));
    let of_text = text.lettering(&Selection::default());
    let marked = "<g aria-label='HI' data-ascent='1069' data-descent='293' data-cap-height='714' data-x-height='536' \
transform='translate(10 80) scale(.04)'><g data-baseline='0 0 1080 0'>\
<path aria-label='H' data-glyph='0 0 741' d='M97,0V-714H187V-412H553V-714H643V0H553V-333H187V0Z'/>\
<path aria-label='I' data-glyph='741,0 339' d='M769,0V-53L853,-72V-642L769,-661V-714H1052V-661L967,-642V-72L1052,-53V0Z'/></g></g>";
    let outlines = read(&drawing(marked)).lettering(&Selection::default());
    assert!(outlines.is_level() && outlines.is_all());
    for kind in &ALL[..4] {
        let (a, b) = (of_text.frame(*kind).unwrap(), outlines.frame(*kind).unwrap());
        assert!(near(a.rect, b.rect), "{kind:?}: {a:?} {b:?}");
    }
    for (a, b) in of_text.letters().iter().zip(outlines.letters()) {
        assert_eq!(a.name, b.name);
        assert!(a.origin.distance(b.origin) < 1e-4 && (a.advance - b.advance).abs() < 1e-4);
    }
    // Bent outlines have no data attributes.
    let bent = read(&drawing(marked)).warp(&Bend, &warp_options()).unwrap().svg;
    assert!(!bent.contains("data-") && bent.contains("aria-label='H'"), "{bent}");
}

#[test]
fn lines_are_told_apart_and_raised_letters_belong_to_theirs() {
    let two = "<text font-size='20' font-family='Noto Sans'><tspan x='10' y='40'>HI</tspan><tspan x='20' y='70'>HIH</tspan></text>";
    let lettering = read(&drawing(two)).lettering(&Selection::default());
    let frame = lettering.frame(LetteringFrame::BaselineCapHeight).unwrap();
    assert!(near(frame.rect, Rect::new(10.0, 40.0 - 0.714 * 20.0, 20.0 + 1.821 * 20.0, 70.0)), "{frame:?}");
    let raised =
        "<text x='10' y='40' font-size='20' font-family='Noto Sans'>HI<tspan dy='-5' font-size='12'>H</tspan></text>";
    let lettering = read(&drawing(raised)).lettering(&Selection::default());
    assert!(lettering.letters().iter().all(|l| (l.origin.y - 40.0).abs() < 1e-5), "{:?}", lettering.letters());
}

#[test]
fn lettering_without_a_frame_gives_the_reason() {
    let fault = |body: &str| {
        let lettering = read(&drawing(body)).lettering(&Selection::default());
        assert!(!lettering.is_level());
        lettering.frame(LetteringFrame::BaselineAscent).unwrap_err()
    };
    assert_eq!(fault("<rect width='40' height='20'/>"), LetteringFrameError::NoLettering);
    for turned in [
        HI.replace("x='10'", "transform='rotate(5)' x='10'"),
        HI.replace("x='10'", "rotate='10' x='10'"),
        HI.replace("x='10'", "writing-mode='tb' x='10'"),
        HI.replace("x='10'", "transform='matrix(-1 0 0 1 90 0)' x='10'"),
        "<path id='p' d='M5,50 Q50,10 95,50' fill='none'/><text font-size='20' font-family='Noto Sans'>\
<textPath href='#p'>HIH</textPath></text>"
            .to_owned(),
    ] {
        let found = fault(&turned);
        assert!(matches!(&found, LetteringFrameError::NotLevel { line } if line.contains("HI")), "{turned}: {found}");
    }
    let mixed = read(&drawing(&format!("{HI}<rect width='9' height='9'/>"))).lettering(&Selection::default());
    assert!(mixed.is_level() && !mixed.is_all());
}

/// Letters are placed, each in all its copies, and then bent by the remaining steps, strokes included.
#[test]
fn letters_are_placed_one_by_one() {
    let stroked = HI.replace("<text", "<text fill='none' stroke='red' stroke-width='2'");
    for (body, stroke) in [(HI, false), (&*stroked, true)] {
        let doc = read(&drawing(body));
        let turn = Affine::rotate_about(0.5, Point::new(20.0, 80.0));
        let places = vec![vec![turn], vec![Affine::translate((5.0, -9.0)), Affine::scale(0.5)]];
        let letters = doc.lettering(&Selection::default()).letters().to_vec();
        let options = warp_options().with_letters(LetterPlaces { places: places.clone(), ..LetterPlaces::default() });
        let out = read(&doc.warp(&Bend, &options).unwrap().svg);
        let found: Vec<Point> = out.shapes().iter().flat_map(|s| s.outline.subpaths.iter().map(|p| p.start)).collect();
        let wanted = letters
            .iter()
            .zip(&places)
            .flat_map(|(l, p)| p.iter().flat_map(move |m| l.outline.subpaths.iter().map(move |s| *m * s.start)));
        if stroke {
            // One copy is half as large, so no single width fits, and the stroke is expanded.
            assert!(out.shapes().iter().all(|s| s.filled), "the stroke is outlined");
            continue;
        }
        for w in wanted {
            assert!(found.iter().any(|f| f.distance(w) < 1e-4), "{w:?} is not among {found:?}");
        }
        assert_eq!(found.len(), 3);
    }
}
