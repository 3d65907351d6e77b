//! One drawing per feature, warped by the identity and by an oblique affine map, both of which are treated as nonlinear. The result must
//! look like the original, transformed by the renderer.

use pathwarp::kurbo::Affine;
use pathwarp_oracle::drawings::{check, drawing, oblique, warp_options};
use pathwarp_svg::{Strokes, Structure};

/// Names and drawings.
const FEATURES: &[(&str, &str)] = &[
    (
        "shapes",
        "<rect x='5' y='5' width='30' height='20' rx='4'/><circle cx='60' cy='20' r='15' fill='red'/>\
         <ellipse cx='30' cy='60' rx='20' ry='10' fill='blue'/><polygon points='60,50 90,60 70,90' fill='green'/>\
         <polyline points='5,80 20,95 35,80' fill='orange'/><path d='M40 80q10-20 20 0t20 0a5 8 30 0 1-9 9z' fill='teal'/>",
    ),
    (
        "nested transforms",
        "<g transform='translate(10 5) rotate(10)'><g transform='scale(1.5 .8) skewX(10)'><rect id='r' width='30' height='40' \
         fill='purple'/><g transform='matrix(.5 .1 -.2 .9 40 10)'><circle r='20' cx='10' cy='20'/></g></g></g>",
    ),
    (
        "strokes",
        "<g fill='none' stroke='black' stroke-width='5'><path d='M10 20C30 0 60 50 90 20'/>\
         <path d='M10 50H90' stroke-linecap='round' stroke-dasharray='12 9' stroke-dashoffset='4' stroke='red'/>\
         <rect x='20' y='65' width='50' height='25' stroke-linejoin='round' stroke='blue' fill='yellow'/></g>",
    ),
    (
        "stroke under a transform of its own",
        "<g transform='scale(3 .7)'><path d='M5 30L20 110L30 40' stroke='navy' stroke-width='4' fill='none'/></g>",
    ),
    (
        "paint order",
        "<circle cx='50' cy='50' r='30' fill='gold' stroke='black' stroke-width='14' paint-order='stroke'/>",
    ),
    (
        "use",
        "<defs><path id='p' d='M0 0h20v10a10 10 0 0 1-20 0z'/><g id='g'><use href='#p' fill='red'/><circle r='4' cx='30' \
         cy='8'/></g></defs><use id='a' xlink:href='#p' x='10' y='10'/><use href='#g' transform='rotate(20 50 50)' x='40' \
         y='40' opacity='.7'/>",
    ),
    (
        "symbol",
        "<symbol id='s' viewBox='0 0 10 10'><circle cx='5' cy='5' r='6'/></symbol><use href='#s' x='10' y='10' width='30' \
         height='30'/><use href='#s' x='50' y='40' width='40' height='45' fill='red'/>",
    ),
    (
        "nested svg",
        "<svg x='10' y='10' width='50' height='40' viewBox='0 0 20 20' preserveAspectRatio='xMinYMin slice'><circle cx='10' \
         cy='10' r='12' fill='green'/></svg><svg x='60' y='60' width='30' height='30'><rect width='10' height='10'/></svg>",
    ),
    (
        "clip path",
        "<clipPath id='c'><circle cx='50' cy='50' r='30'/><rect x='5' y='5' width='20' height='20'/></clipPath>\
         <rect width='100' height='100' fill='tomato' clip-path='url(#c)'/>",
    ),
    (
        "clip path seen from two frames",
        "<clipPath id='c'><circle cx='20' cy='20' r='15'/></clipPath><rect width='40' height='40' fill='tomato' \
         clip-path='url(#c)'/><g transform='translate(45 40) scale(1.2)' clip-path='url(#c)'><rect width='40' height='40' \
         fill='navy'/></g>",
    ),
    (
        "clip path in box units, clipped in turn",
        "<clipPath id='d'><rect x='0' y='20' width='100' height='40'/></clipPath><clipPath id='c' clip-path='url(#d)' \
         clipPathUnits='objectBoundingBox'><circle cx='.5' cy='.5' r='.5'/></clipPath><rect x='10' y='10' width='60' \
         height='70' clip-path='url(#c)'/><rect x='75' y='10' width='20' height='70' fill='red' clip-path='url(#c)'/>",
    ),
    (
        "clip path with text and use",
        "<path id='p' d='M5 5h50v50z' fill='none'/><clipPath id='c'><use href='#p'/><text x='40' y='90' \
         font-size='40'>ok</text></clipPath><rect width='100' height='100' fill='green' clip-path='url(#c)'/>",
    ),
    (
        "mask",
        "<linearGradient id='g'><stop offset='0' stop-color='white'/><stop offset='1'/></linearGradient><mask id='m'>\
         <rect x='10' y='10' width='80' height='80' fill='url(#g)'/></mask><circle cx='50' cy='50' r='40' fill='crimson' \
         mask='url(#m)'/><mask id='n' maskContentUnits='objectBoundingBox'><circle cx='.5' cy='.5' r='.6' fill='white'/>\
         </mask><rect y='80' width='20' height='20' mask='url(#n)'/>",
    ),
    (
        "mask in box units on a line without a box",
        "<mask id='m'><rect width='100' height='100' fill='white'/></mask><path d='M10 50H70' stroke='red' stroke-width='9' \
         mask='url(#m)'/><rect y='60' width='50' height='30' fill='green'/>",
    ),
    (
        "mask in box units on a shape and on a line without a box",
        "<mask id='m'><rect width='100' height='100' fill='white'/></mask><rect width='90' height='90' fill='green' \
         mask='url(#m)'/><path d='M10 50H70' stroke='red' stroke-width='9' mask='url(#m)'/>",
    ),
    (
        "mask whose region cuts",
        "<mask id='m' maskUnits='userSpaceOnUse' x='20' y='20' width='50' height='40'><rect width='100' height='100' \
         fill='white'/></mask><rect width='90' height='90' fill='darkgreen' mask='url(#m)'/>",
    ),
    (
        "gradients",
        "<linearGradient id='a' x1='.2'><stop offset='0' stop-color='red'/><stop offset='1' stop-color='blue'/>\
         </linearGradient><radialGradient id='b' fx='.3' spreadMethod='reflect' r='.3' xlink:href='#a'/><linearGradient \
         id='c' gradientUnits='userSpaceOnUse' x1='10' x2='60' gradientTransform='rotate(30)' xlink:href='#a'/>\
         <rect x='5' y='5' width='40' height='30' fill='url(#a)'/><rect x='50' y='5' width='20' height='40' fill='url(#a)'/>\
         <circle cx='25' cy='70' r='20' fill='url(#b)'/><rect x='55' y='55' width='40' height='40' fill='none' \
         stroke='url(#c)' stroke-width='8'/>",
    ),
    (
        "gradient on a line without a box",
        "<linearGradient id='a'><stop offset='0' stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient>\
         <path d='M10 50H90' stroke='url(#a) green' stroke-width='10'/>",
    ),
    (
        "pattern",
        "<pattern id='p' width='.25' height='10' patternContentUnits='userSpaceOnUse' patternTransform='rotate(20)'><circle \
         cx='4' cy='4' r='4' fill='red'/></pattern><rect x='10' y='10' width='70' height='70' fill='url(#p)'/>",
    ),
    (
        "filter",
        "<filter id='f'><feGaussianBlur stdDeviation='2 4'/></filter><g filter='url(#f)'><rect x='20' y='20' width='50' \
         height='40' fill='blue'/></g><circle cx='70' cy='70' r='15' style='filter:drop-shadow(4px 4px 2px red)'/>",
    ),
    (
        "a filter that shows what is drawn as well",
        "<filter id='f' x='0' y='0' width='1' height='1'><feImage xlink:href='#s'/></filter><rect x='10' y='10' width='80' \
         height='80' fill='red' filter='url(#f)'/><path id='s' d='M30 20h40l10 50z' fill='green' opacity='.5'/>",
    ),
    (
        "markers",
        "<marker id='m' markerWidth='4' markerHeight='4' refX='2' refY='2' orient='auto'><path d='M0 0L4 2L0 4z' \
         fill='red'/></marker><path id='p' d='M20 80L50 30L80 70' fill='none' stroke='black' stroke-width='4' \
         marker-start='url(#m)' marker-mid='url(#m)' marker-end='url(#m)'/>",
    ),
    (
        "text",
        "<text id='t' x='10' y='40' font-size='30' fill='navy' font-family='No Such Font, sans-serif'>Cat <tspan \
         fill='red' dy='20'>b&amp;c</tspan></text><g transform='rotate(-20)'><text x='5' y='90' font-size='20' stroke='red' \
         fill='none'>edge</text></g>",
    ),
    (
        "text along a path",
        "<path id='p' d='M10 70Q50 10 90 70' fill='none'/><text font-size='18' fill='darkred'><textPath href='#p'>along \
         it</textPath></text>",
    ),
    (
        "type selectors",
        "<style>rect{fill:green;stroke:black;stroke-width:4} path{fill:orange} .k{opacity:.5}</style><rect x='10' y='10' \
         width='40' height='30'/><circle class='k' cx='70' cy='60' r='20'/><path d='M10 60h20v30z'/>",
    ),
    (
        "attribute selectors and inherited style",
        "<style>[x]{fill:purple} use{opacity:.4} .w{stroke:red;stroke-width:6}</style><g class='w' fill='teal'><rect x='10' \
         y='10' width='40' height='30'/><path id='q' d='M60 60h20v30z'/><use class='w' href='#q' x='-40'/></g>",
    ),
    (
        "switch, link, hidden",
        "<switch><g systemLanguage='xx'><rect width='50' height='50'/></g><a href='http://example.org'><rect x='20' y='20' \
         width='50' height='50' fill='red'/></a></switch><rect width='100' height='10' display='none'/><rect width='10' \
         height='100' visibility='hidden'/>",
    ),
    (
        "an image",
        "<image x='10' y='20' width='60' height='30' preserveAspectRatio='none' xlink:href='data:image/png;base64,\
         iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='/><rect x='40' \
         y='60' width='20' height='20'/>",
    ),
    (
        "opacity and blending",
        "<rect width='60' height='60' fill='red'/><g opacity='.5' style='mix-blend-mode:multiply'>\
      <circle cx='60' cy='60' r='30' fill='blue'/><circle cx='70' cy='50' r='20' fill='lime'/></g>",
    ),
    ("an entity in an attribute", "<path fill='&#x72;ed' d='M10,10&#10;h50v50z'/>"),
];

#[test]
fn identity_looks_the_same() {
    for (name, body) in FEATURES {
        let w = check(name, &drawing(body), Affine::IDENTITY, &warp_options());
        assert!(!w.warnings.iter().any(|w| w.to_string().contains("flattened")), "{name}: {:?}", w.warnings);
    }
}

#[test]
fn oblique_looks_like_the_renderers_transform() {
    for (name, body) in FEATURES {
        let _ = check(name, &drawing(body), oblique(), &warp_options());
    }
}

#[test]
fn flattened_it_looks_the_same() {
    let options = warp_options().with_structure(Structure::Flatten);
    for (name, body) in FEATURES {
        let _ = check(name, &drawing(body), Affine::IDENTITY, &options);
        let _ = check(name, &drawing(body), oblique(), &options);
    }
}

#[test]
fn outlined_strokes_look_the_same() {
    let options = warp_options().with_strokes(Strokes::Outline);
    for (name, body) in FEATURES.iter().filter(|f| f.1.contains("stroke")) {
        let _ = check(name, &drawing(body), oblique(), &options);
    }
}

#[test]
fn page_size_and_view_box_make_a_frame_of_their_own() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='30mm' height='60' viewBox='-20 5 90 50' \
               preserveAspectRatio='xMaxYMin'><circle cx='20' cy='30' r='15' stroke='red'/></svg>";
    for map in [Affine::IDENTITY, oblique()] {
        let _ = check("viewBox", svg, map, &warp_options());
    }
}

#[test]
fn prefixed_elements() {
    let svg = "<s:svg xmlns:s='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><s:rect x='20' width='50' height='30'/>\
               <s:g id='g'><s:circle id='c' r='10' cx='50' cy='60'/></s:g><s:path d='M5 90L70 50' stroke='red' \
               stroke-width='5'/></s:svg>";
    let w = check("prefix", svg, oblique(), &warp_options());
    assert!(w.svg.contains("<s:path d="), "{}", w.svg);
}
