//! Text shapes and rings of lettering: the distortion of letters, and the space between the ends.

use crate::support::{pathwarp_in, root};
use pathwarp::deform::Registry;
use pathwarp::kurbo::{ParamCurve as _, Point, Rect, Shape as _};
use pathwarp::map::Map;
use pathwarp::param::{Args, Frame};
use pathwarp_svg::{Document, ReadOptions, Selection};

fn lettering(words: &str) -> Vec<u8> {
    let out = pathwarp_in(&root(), &["text", words, "--align", "center"], b"");
    assert!(out.status.success());
    out.stdout
}

/// The largest ratio of the singular values of the Jacobian at the middles and corners of letters; infinite if one is mirrored.
fn distortion(drawing: &[u8], pairs: &[(&str, &str)]) -> f64 {
    let doc = Document::read(drawing, "text", &ReadOptions::default()).unwrap();
    let letters = doc.lettering(&Selection::default()).letters().to_vec();
    let boxes: Vec<_> = letters.iter().filter_map(|l| l.outline.bounding_box()).collect();
    assert!(boxes.len() > 1);
    let frame = Frame::new(doc.seen_box(&Selection::default()).unwrap()).with_letters(letters.into());
    let map = Registry::builtin().get("wordart").unwrap().build_from(&Args::from_pairs(pairs), &frame).unwrap().map;
    let ratio = |p: Point| {
        let j = map.jet(p);
        let (sum, det) = (j.dx.hypot2() + j.dy.hypot2(), j.det());
        let (most, least) = ((sum + 2.0 * det).sqrt(), (sum - 2.0 * det).max(0.0).sqrt());
        if det > 0.0 { (most + least) / (most - least) } else { f64::INFINITY }
    };
    let points = |b: &Rect| [b.center(), b.origin(), (b.x1, b.y0).into(), (b.x0, b.y1).into(), (b.x1, b.y1).into()];
    boxes.iter().flat_map(points).map(ratio).fold(0.0, f64::max)
}

/// On every shape with a single guide, letters keep their proportion in a box that is fitted to the text; in the artwork's box, those of
/// wide lines do not. No letter folds.
#[test]
fn letters_keep_their_proportion_on_arches() {
    let texts = [("Hi", 1.5), ("Welcome", 1.5), ("A rather long single line of text", 1.3)];
    for (words, most) in texts {
        let drawing = lettering(words);
        for preset in ["arch-up", "arch-down", "circle", "button"] {
            let fitted = distortion(&drawing, &[("preset", preset)]);
            let own = distortion(&drawing, &[("preset", preset), ("box", "artwork")]);
            assert!(fitted < most && own > 1.5 * fitted, "{words}, {preset}: {fitted}, was {own}");
            let out = pathwarp_in(&root(), &["wordart", "-", "--preset", preset, "--fit", "page"], &drawing);
            assert_eq!((out.status.code(), out.stderr.as_slice()), (Some(0), &b""[..]), "{words}, {preset}");
        }
    }
}

/// Three lines stand on the three guides of button, one each.
#[test]
fn lines_take_the_guides_one_by_one() {
    let drawing = lettering("Three\\nlines of\\nlettering");
    for preset in ["arch-up", "arch-down", "circle", "button"] {
        let fitted = distortion(&drawing, &[("preset", preset)]);
        assert!(fitted < 1.6, "{preset}: {fitted}");
    }
    let out = pathwarp_in(&root(), &["wordart", "-", "--preset", "button", "--explain"], &drawing);
    let said = String::from_utf8(out.stderr).unwrap();
    assert!(said.contains("3 band(s)") && !said.contains("folds"), "{said}");
    let out = pathwarp_in(&root(), &["wordart", "-", "--preset", "button", "--explain"], &lettering("Hi"));
    assert!(String::from_utf8(out.stderr).unwrap().contains("1 band(s)"));
}

/// Outlines that are not lettering have no known lines, and stand on the first guide of button in one piece.
#[test]
fn artwork_without_lines_is_not_divided() {
    for (options, bands) in
        [(&[][..], "1 band(s)"), (&["--split", "40%,60%"], "3 band(s)"), (&["--box", "artwork"], "3 band(s)")]
    {
        let args = [&["wordart", "samples/lettering.svg", "--preset", "button", "--explain"], options].concat();
        let said = String::from_utf8(pathwarp_in(&root(), &args, b"").stderr).unwrap();
        assert!(said.contains(bands), "{options:?}: {said}");
    }
}

/// A box given in user units or % is used as it is; text on a single guide is scaled to its length.
#[test]
fn a_box_can_be_given() {
    let drawing = lettering("Welcome");
    let run = |of: &str| {
        let args = ["wordart", "-", "--preset", "arch-up", "--box", of, "--explain"];
        let out = pathwarp_in(&root(), &args, &drawing);
        (out.status.code(), String::from_utf8(out.stderr).unwrap())
    };
    let (code, said) = run("10,20,300,310");
    assert!(code == Some(0) && said.contains("box of the shape: 10.000000,20.000000,300.000000,310.000000"), "{said}");
    let (code, said) = run("wide");
    assert!(code == Some(2) && said.contains("--box"), "{said}");
}

/// `polar --sweep 360` leaves a word space: of the bundled font, 260/1000 of the em. Another gap can be given.
#[test]
fn a_ring_of_words_has_a_word_space_between_its_ends() {
    const SPACE: f64 = 0.26 * 72.0;
    let drawing = lettering("round and round it goes");
    let outline = |svg: &[u8]| {
        let doc = Document::read(svg, "ring", &ReadOptions::default()).unwrap();
        doc.shapes()
            .iter()
            .flat_map(|s| s.outline.to_bez_path(1e-6).elements().to_vec())
            .collect::<pathwarp::kurbo::BezPath>()
    };
    let width = outline(&drawing).bounding_box().width();
    for (gap, space) in [(None, SPACE), (Some("3"), 3.0), (Some("10%"), 0.1 * width)] {
        let mut args = vec!["polar", "-", "--sweep", "360", "--center", "0,0", "-q"];
        args.extend(gap.iter().flat_map(|g| ["--gap", g]));
        let ring = pathwarp_in(&root(), &args, &drawing).stdout;
        // Degrees clockwise from the top, where the middle of the words lies.
        let angles = outline(&ring)
            .segments()
            .flat_map(|s| (0..=20).map(move |i| s.eval(f64::from(i) / 20.0)))
            .map(|p| p.x.atan2(-p.y).to_degrees())
            .collect::<Vec<_>>();
        let (least, most) = angles.iter().fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        let left = 360.0 - (most - least);
        assert!((left - 360.0 * space / (width + space)).abs() < 0.1, "{gap:?}: {left}");
    }
    // Other artwork goes all the way round.
    let out = pathwarp_in(&root(), &["polar", "samples/grid.svg", "--sweep", "360", "--explain"], b"");
    assert!(!String::from_utf8(out.stderr).unwrap().contains("gap"));
}
