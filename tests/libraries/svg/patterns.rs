//! Patterns as geometry. The reference is the rendering of the original, resampled through the inverse of a curved map.

use pathwarp::kurbo::Affine;
use pathwarp_oracle::drawings::{Bend, Hidden, curved, drawing, oblique, read, warp_options};
use pathwarp_svg::{Patterns, Strokes, Structure, WarpOptions};

/// Names and drawings.
const PATTERNS: &[(&str, &str)] = &[
    (
        "box units",
        "<pattern id='p' width='.25' height='.2'><circle cx='6' cy='6' r='5' fill='red'/><rect width='4' height='9' \
         fill='blue' opacity='.5'/></pattern><rect x='10' y='10' width='70' height='70' fill='url(#p)'/>",
    ),
    (
        "user space, slanted and moved, cut at the cell",
        "<pattern id='p' x='3' y='2' width='14' height='11' patternUnits='userSpaceOnUse' patternTransform='translate(4 1) \
         matrix(1 0 .75 1 0 0)'><path d='M-3 5C10 -9 8 22 18 6' fill='none' stroke='teal' stroke-width='3'/><circle \
         cx='14' cy='11' r='4' fill='orange'/></pattern><circle cx='50' cy='50' r='40' fill='url(#p)'/>",
    ),
    (
        "content in box units",
        "<pattern id='p' width='.2' height='.25' patternContentUnits='objectBoundingBox'><rect x='.02' y='.03' width='.1' \
         height='.15' rx='.03' fill='purple'/></pattern><rect x='10' y='20' width='80' height='60' fill='url(#p)'/>",
    ),
    (
        "a viewBox, even-odd shape, opacity",
        "<pattern id='p' width='16' height='12' patternUnits='userSpaceOnUse' viewBox='0 0 8 8'><path d='M0 4L4 0L8 4L4 8z' \
         fill='navy'/></pattern><path d='M5 5H95V95H5zM30 30H70V70H30z' fill='url(#p)' fill-rule='evenodd' \
         fill-opacity='.6'/>",
    ),
    (
        "on a stroke, above a plain fill",
        "<pattern id='p' width='9' height='9' patternUnits='userSpaceOnUse'><rect width='9' height='9' fill='gold'/><circle \
         cx='4.5' cy='4.5' r='3' fill='black'/></pattern><path d='M20 25C60 -5 90 60 70 80L30 70z' fill='pink' \
         stroke='url(#p)' stroke-width='14' stroke-linejoin='round'/>",
    ),
    (
        "stroke first, both painted",
        "<pattern id='p' width='8' height='8' patternUnits='userSpaceOnUse'><rect width='5' height='5' \
         fill='green'/></pattern><circle cx='50' cy='50' r='30' fill='url(#p)' stroke='url(#p)' stroke-opacity='.5' \
         stroke-width='12' paint-order='stroke'/>",
    ),
    (
        "nested frames, a copy and a text",
        "<pattern id='p' width='6' height='6' patternUnits='userSpaceOnUse'><circle cx='3' cy='3' r='2' fill='crimson'/>\
         </pattern><defs><rect id='r' width='30' height='30' fill='url(#p)'/></defs><g transform='translate(10 5) \
         rotate(10) scale(1.25)'><use href='#r' x='5'/><text x='5' y='75' font-size='44' font-family='sans-serif' fill='url(#p)' \
         stroke='black'>Wo</text></g>",
    ),
    (
        "tiles with groups, clips, gradients and patterns of their own",
        "<linearGradient id='g'><stop stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient><clipPath \
         id='c'><circle cx='10' cy='10' r='8'/></clipPath><pattern id='q' width='3' height='3' \
         patternUnits='userSpaceOnUse'><rect width='1.5' height='3' fill='black'/></pattern><pattern id='p' width='24' \
         height='24' patternUnits='userSpaceOnUse'><g opacity='.7' clip-path='url(#c)'><rect width='20' height='20' \
         fill='url(#g)'/><path d='M0 10H30' stroke='white' stroke-width='3'/></g><rect x='14' y='14' width='9' height='9' \
         fill='url(#q)'/></pattern><rect x='8' y='8' width='80' height='80' fill='url(#p)'/>",
    ),
];

fn instantiate() -> WarpOptions {
    warp_options().with_patterns(Patterns::Instantiate)
}

#[test]
fn under_a_curved_map_tiles_bend() {
    for (name, body) in PATTERNS {
        let (_, fitted) = curved(&drawing(body), &warp_options().with_patterns(Patterns::Fit));
        // By default, the affine fit of the pattern is recognised as visibly wrong.
        let (w, bent) = curved(&drawing(body), &warp_options());
        println!("{name}: {:.2} / 255 bent, {:.2} / 255 fitted", bent.mean, fitted.mean);
        assert!(bent.mean <= 1.0, "{name}: {} of 255", bent.mean);
        assert!(fitted.mean > 10.0 * bent.mean, "{name}: {} and {} of 255", fitted.mean, bent.mean);
        // A pattern within the last, small tile may follow the affine fit without a visible error.
        assert!(w.warnings.iter().all(|w| w.to_string().ends_with("their tiles are not bent: q")), "{:?}", w.warnings);
        assert!(!w.svg.contains("fill=\"url(#p") && w.svg.contains("-edge"), "{name}: {}", w.svg);
    }
}

#[test]
fn flattened_patterns_bend_as_well() {
    let options = instantiate().with_structure(Structure::Flatten);
    for (name, body) in &PATTERNS[5..] {
        let (w, bent) = curved(&drawing(body), &options);
        assert!(bent.mean <= 1.0, "{name}: {} of 255", bent.mean);
        assert!(!w.svg.contains("<pattern"), "{name}: {}", w.svg);
    }
}

#[test]
fn the_file_keeps_its_names() {
    let body = "<pattern id='p' width='.1' height='.1'><circle r='3'/></pattern><rect id='r' class='k' width='90' \
                height='90' fill='url(#p)'><title>dots</title></rect>";
    let w = read(&drawing(body)).warp(&Bend, &warp_options()).unwrap();
    assert!(w.svg.contains("<g id='r' class='k' fill='url(#p)'><title>dots</title>"), "{}", w.svg);
    assert!(w.svg.contains("<clipPath id=\"r-edge\">"), "{}", w.svg);
    assert!(w.svg.contains("<pattern id='p'"), "{}", w.svg);
    assert_eq!(w.shapes.len(), 1);
}

/// A pattern stays a pattern if the map bends less than is visible.
#[test]
fn what_no_one_sees_is_not_done() {
    let body = PATTERNS[0].1;
    let w = read(&drawing(body)).warp(&Hidden(oblique()), &warp_options()).unwrap();
    assert!(w.svg.contains("fill='url(#p-2)'"), "{}", w.svg);
}

#[test]
fn too_much_follows_as_a_whole_and_says_so() {
    let tiny = "<pattern id='tiny' width='.2' height='.2' patternUnits='userSpaceOnUse'><circle r='.1'/></pattern><rect \
                width='90' height='90' fill='url(#tiny)'/>";
    let masked = "<mask id='m'><rect width='5' height='5' fill='white'/></mask><pattern id='masked' width='20' height='20' \
                  patternUnits='userSpaceOnUse'><circle r='9' mask='url(#m)'/></pattern><rect width='90' height='90' \
                  fill='url(#masked)'/>";
    for (id, body, why) in [("tiny", tiny, "too many"), ("masked", masked, "masks")] {
        let w = read(&drawing(body)).warp(&Bend, &instantiate()).unwrap();
        assert!(
            w.warnings.iter().any(|w| w.to_string().contains(why) && w.to_string().contains(id)),
            "{:?}",
            w.warnings
        );
        assert!(w.svg.contains("<pattern id=\""), "{}", w.svg);
    }
}

#[test]
fn copies_repeat_their_tiles() {
    let body = "<pattern id='p' width='5' height='5' patternUnits='userSpaceOnUse'><circle cx='2' cy='2' r='2'/></pattern>\
                <rect width='20' height='20' fill='url(#p)'/>";
    let copies = vec![Affine::IDENTITY, Affine::translate((30.0, 0.0))];
    let w = read(&drawing(body)).warp(&Hidden(Affine::IDENTITY), &warp_options().with_copies(copies)).unwrap();
    let twice =
        drawing(&format!("{body}<g transform='translate(30 0)'><rect width='20' height='20' fill='url(#p)'/></g>"));
    pathwarp_oracle::drawings::same("copies", &w.svg, &twice);
}

#[test]
fn centre_lines_keep_their_patterns() {
    let body = PATTERNS[4].1;
    let options = warp_options().with_strokes(Strokes::Keep);
    let w = read(&drawing(body)).warp(&Bend, &options).unwrap();
    assert!(w.svg.contains("stroke='url(#p-2)'"), "{}", w.svg);
}

/// The report contains the error of a pattern's affine fit, and no error where tiles are bent.
#[test]
fn the_residual_is_told() {
    let svg = drawing(PATTERNS[0].1);
    let residual = |patterns| {
        let w = read(&svg).warp(&Bend, &warp_options().with_patterns(patterns)).unwrap();
        w.shapes.iter().filter_map(|s| s.paint_residual).reduce(f64::max)
    };
    let fitted = residual(Patterns::Fit).unwrap();
    assert!((0.5..10.0).contains(&fitted), "{fitted}");
    assert_eq!((residual(Patterns::Instantiate), residual(Patterns::Keep)), (None, None));
}
