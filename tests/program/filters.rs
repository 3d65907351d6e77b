//! `--filters` through the program, compared with the rendering of the original sampled through the inverse map.

use crate::support::pathwarp_in;
use pathwarp_oracle::drawings::{drawing, gap, same};
use std::fs;

/// Name, drawing, paths that stay, pictures.
const FILTERS: &[(&str, &str, usize, usize)] = &[
    (
        "a drop shadow as Figma writes it",
        "<g filter='url(#f)'><rect x='20' y='20' width='50' height='40' fill='#3a7'/></g><filter id='f' x='0' y='0' width='100' \
         height='100' filterUnits='userSpaceOnUse' color-interpolation-filters='sRGB'><feFlood flood-opacity='0' \
         result='BackgroundImageFix'/><feColorMatrix in='SourceAlpha' type='matrix' values='0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 127 0' \
         result='hardAlpha'/><feOffset dx='12' dy='14'/><feGaussianBlur stdDeviation='3'/><feComposite in2='hardAlpha' operator='out'/>\
         <feColorMatrix type='matrix' values='0 0 0 0 0.4 0 0 0 0 0 0 0 0 0 0.1 0 0 0 0.8 0'/><feBlend mode='normal' \
         in2='BackgroundImageFix' result='effect1'/><feBlend mode='normal' in='SourceGraphic' in2='effect1' result='shape'/></filter>",
        1,
        1,
    ),
    (
        "a shadow beneath and one within, on a shape",
        "<rect filter='url(#f)' id='r' x='20' y='20' width='60' height='50' fill='#fc4' transform='rotate(4)'/><filter id='f' x='-.4' y='-.4' \
         width='1.8' height='1.8' color-interpolation-filters='sRGB'><feGaussianBlur in='SourceAlpha' stdDeviation='2'/><feOffset dx='9' \
         dy='9' result='a'/><feOffset in='SourceAlpha' dx='-12' dy='-9'/><feComposite in='SourceAlpha' operator='out' result='b'/>\
         <feFlood flood-color='#036' flood-opacity='.7'/><feComposite in2='b' operator='in' result='c'/><feMerge><feMergeNode in='a'/>\
         <feMergeNode in='SourceGraphic'/><feMergeNode in='c'/></feMerge></filter>",
        1,
        2,
    ),
    (
        "the primitive for shadows, on a copy",
        "<defs><path id='p' d='M15 20h40l10 30-60 20z'/></defs><use href='#p' x='10' fill='#e83' filter='url(#f)'/><filter id='f' x='-.4' y='-.4' \
         width='2' height='2' color-interpolation-filters='sRGB'><feDropShadow dx='14' dy='10' stdDeviation='2' \
         flood-opacity='.8'/></filter>",
        1,
        1,
    ),
    (
        "a smooth shadow, of few pixels, beneath two shapes",
        "<g filter='url(#f)'><rect x='15' y='15' width='45' height='30' fill='#4af'/><circle cx='60' cy='55' r='18' fill='#fa4'/></g>\
         <filter id='f' x='-.2' y='-.2' width='1.5' height='1.5'><feDropShadow dx='3' dy='3' stdDeviation='4'/></filter>",
        2,
        1,
    ),
    (
        "a blur",
        "<g filter='url(#f)'><path d='M20 30h60v40h-60z' fill='#c30'/></g><filter id='f' x='0' y='0' width='100' height='100' \
         filterUnits='userSpaceOnUse' color-interpolation-filters='sRGB'><feGaussianBlur stdDeviation='9 1'/></filter>",
        0,
        1,
    ),
];

/// Bends a drawing by the formulas of `common::Bend`. Returns the file and the messages.
fn bent(body: &str, args: &[&str]) -> (String, String) {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("in.svg"), drawing(body)).unwrap();
    let map = ["expr", "in.svg", "-o", "out.svg", "--x", "x + 6*sin(y/30)", "--y", "y + 8*sin(x/25)"];
    let run = pathwarp_in(dir.path(), &[&map[..], args].concat(), b"");
    let told = String::from_utf8(run.stderr).unwrap();
    assert!(run.status.success(), "{told}");
    (fs::read_to_string(dir.path().join("out.svg")).unwrap(), told)
}

#[test]
fn what_filters_draw_is_the_bent_rendering() {
    for (name, body, paths, pictures) in FILTERS {
        let [keep, flatten] =
            ["keep", "flatten"].map(|s| bent(body, &["--filters", "picture", "--structure", s, "--explain"]));
        for (svg, told) in [&keep, &flatten] {
            let drawn = svg.matches("<path").count() - svg.matches("<path id='p'").count();
            assert_eq!((drawn, svg.matches("<image").count()), (*paths, *pictures), "{name}: {svg}");
            assert!(told.contains("a filter became a picture; --filters affine keeps it"), "{told}");
            assert!(told.contains("filters: pictures on ") && !told.contains("follow the warp as a whole"), "{told}");
        }
        let picture = gap(&drawing(body), &keep.0);
        println!("{name}: {:.2} / 255", picture.mean);
        assert!(picture.mean <= 1.5, "{name}: {picture:?}");
        same(name, &keep.0, &flatten.0);
    }
    let (_, body, ..) = FILTERS[0];
    let affine = gap(&drawing(body), &bent(body, &["--filters", "affine"]).0);
    assert!(affine.mean > 3.0, "{affine:?}");
}

/// A shadow that the fit shows correctly stays a filter, without a message.
#[test]
fn filters_that_look_right_stay() {
    let small =
        FILTERS[0].1.replace("dx='12' dy='14'", "dx='0' dy='1'").replace("stdDeviation='3'", "stdDeviation='1'");
    let small = small.replace("width='50' height='40'", "width='6' height='5'");
    let (svg, told) = bent(&small, &["--explain"]);
    assert!(svg.contains("filter='url(#f)'") && !svg.contains("<image"), "{told}\n{svg}");
    assert!(told.contains("note: filters: affine fits on g at 1:") && !told.contains("warning"), "{told}");
    let (svg, told) = bent(&small, &["--filters", "affine"]);
    assert!(!svg.contains("<image") && told.contains("follow the warp as a whole"), "{told}");
}

/// The renderer displaces pixels too far, so a picture would show little of the shape.
#[test]
fn roughened_shapes_stay() {
    let rough = "<rect x='20' y='20' width='60' height='50' filter='url(#f)'/><filter id='f'><feTurbulence \
                 baseFrequency='.05' result='t'/><feDisplacementMap in='SourceGraphic' in2='t' scale='8' xChannelSelector='R'/></filter>";
    for filters in ["auto", "picture"] {
        let (svg, told) = bent(rough, &["--filters", filters]);
        assert!(svg.contains("<path") && !svg.contains("<image"), "{svg}");
        assert!(told.contains("filters follow the warp as a whole"), "{told}");
    }
}

/// Layers that each stack the previous one twice double their work until a limit ends it.
#[test]
fn layers_that_double_are_bounded() {
    let twice =
        |k: usize| format!("<feMerge result='m{}'><feMergeNode in='m{k}'/><feMergeNode in='m{k}'/></feMerge>", k + 1);
    let last = "<feMerge><feMergeNode in='m60'/><feMergeNode in='SourceGraphic'/></feMerge>";
    let merges: String = (0..60).map(twice).collect();
    let firsts = ["<feFlood flood-opacity='0' result='m0'/>", "<feOffset dx='1' result='m0'/>"].into_iter().enumerate();
    let shape = |(k, first)| {
        format!("<filter id='f{k}'>{first}{merges}{last}</filter><path d='M20 20h50v30z' filter='url(#f{k})'/>")
    };
    let body: String = firsts.map(shape).collect();
    let (svg, _) = bent(&body, &["--filters", "picture", "--limit", "work=3e7"]);
    assert_eq!(svg.matches("<path").count() + svg.matches("<image").count(), 2, "{svg}");
}

/// A cutter follows the shape, not its shadow; a PDF has the shape beside the picture.
#[test]
fn no_picture_takes_a_shape_from_a_cutter() {
    let dir = tempfile::tempdir().unwrap();
    for (name, body, ..) in [FILTERS[0], FILTERS[3]] {
        fs::write(dir.path().join("in.svg"), drawing(body)).unwrap();
        let map = |to| ["expr", "in.svg", "-o", to, "--y", "y + 8*sin(x/25)", "--filters", "picture"];
        let run = pathwarp_in(dir.path(), &map("out.dxf"), b"");
        let dxf = fs::read_to_string(dir.path().join("out.dxf")).unwrap_or_default();
        assert!(dxf.contains("SPLINE") || dxf.contains("POLYLINE") || dxf.contains("LINE"), "{name}: {:?}", run.stderr);
        let run = pathwarp_in(dir.path(), &map("out.pdf"), b"");
        let told = String::from_utf8(run.stderr).unwrap();
        assert!(run.status.success() && !told.contains("PDF has no filters"), "{name}: {told}");
    }
}

/// A difference on less than .2 % of the page is not visible; that of the bar on a small page is.
#[test]
fn the_choice_is_by_what_is_seen_of_the_page() {
    let pictures = |page: [u32; 2]| {
        let bar = "<rect x='15' y='10' width='6' height='60' filter='url(#b)'/>";
        let filter = "<filter id='b'><feGaussianBlur stdDeviation='2'/></filter>";
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}'>{filter}{bar}</svg>",
            page[0], page[1]
        );
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("a.svg"), svg).unwrap();
        let line = ["warp", "a.svg", "--style", "flag", "--bend", "5%", "--fit", "none", "-o", "o.svg"];
        assert!(pathwarp_in(dir.path(), &line, b"").status.success());
        fs::read_to_string(dir.path().join("o.svg")).unwrap().matches("<image").count()
    };
    assert_eq!(pictures([400, 300]), 0);
    assert_eq!(pictures([40, 80]), 1);
}
