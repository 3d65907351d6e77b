//! Drawings whose colours can be changed afterwards: warping and then changing a colour gives the same picture as changing it and then
//! warping.

use pathwarp::kurbo::Affine;
use pathwarp_oracle::drawings::{Bend, drawing, options, read, rendered, warp_options};
use pathwarp_svg::usvg_tree::parse_tree;
use pathwarp_svg::{Edit, WarpOptions};

/// The colour that is changed, and the new one.
const COLORS: [&str; 2] = ["#0a6e31", "#d21f5c"];

const LINE: &str = "d='M20 20C30 0 60 50 80 20V70' stroke-width='9'";

/// Bodies of drawings; `THEME` stands for the colour.
const BODIES: &[&str] = &[
    // Icons, with the colour of the page around them.
    "<g color='THEME' fill='none' stroke='currentColor'><path LINE/><circle cx='30' cy='70' r='12' stroke-width='5'/></g>",
    "<g style='color:THEME;stroke:currentcolor;fill:none'><g stroke-linecap='round'><polyline points='9,9 80,30 40,80' LINE/></g></g>",
    "<g color='THEME'><path LINE fill='currentColor' stroke='blue'/><path LINE fill='none' style='stroke:CurrentColor'/></g>",
    "<g color='THEME'><path LINE stroke='currentColor' stroke-opacity='.5' fill='none' fill-opacity='.2'/></g>",
    "<g color='THEME' opacity='.7'><path LINE stroke='currentColor' stroke-dasharray='7 3' fill='none'/></g>",
    // Variables.
    "<style>:root{--brand:THEME}</style><path LINE style='stroke:var(--brand);fill:none'/>",
    "<style>:root{--brand:THEME}.i{stroke:var(--other, var(--brand));fill:gold}</style><path LINE class='i'/>",
    "<style>:root{--brand:THEME;--faint:.4}.i{stroke:var(--brand);stroke-opacity:var(--faint);fill:none}</style><path LINE class='i'/>",
    "<g style='--brand:THEME'><path LINE fill='none' stroke='var(--brand)'/></g>",
    "<g style='--brand:blue;stroke:var(--brand)'><path LINE fill='none' style='--brand:THEME;stroke:var(--brand)'/></g>",
    "<g style='--brand:THEME;stroke:var(--brand)'><path LINE fill='none' style='--brand:blue'/></g>",
    // Rules for one half of a pair.
    "<style>.i{fill:THEME;stroke:blue}</style><path LINE class='i'/>",
    "<style>path{fill:THEME;stroke:blue}</style><path LINE/><rect x='60' y='60' width='30' height='20' stroke-width='6'/>",
    "<style>rect{fill:THEME!important;stroke:blue}</style><rect x='20' y='30' width='60' height='50' stroke-width='9'/>",
    "<style>g > .i{stroke:currentColor}path{fill:lime;stroke:gold}</style><g color='THEME'><path LINE class='i'/></g>",
    // Texts, and parts of them.
    "<text x='9' y='60' font-size='40' fill='currentColor' color='THEME'>Abc</text>",
    "<style>.t{fill:THEME}</style><text x='9' y='60' font-size='40' class='t'>Abc</text>",
    "<style>text{fill:THEME;stroke:blue}</style><text x='9' y='60' font-size='40' stroke-width='4'>Abc</text>",
    "<style>:root{--brand:THEME}tspan{fill:var(--brand)}</style><text x='9' y='60' font-size='40'>A<tspan>b</tspan>c</text>",
    "<g color='THEME'><text x='9' y='60' font-size='40' fill='currentColor'>A<tspan fill='blue'>b</tspan>c</text></g>",
    "<text x='9' y='60' font-size='40' fill='currentColor'>A<tspan id='b' color='THEME' opacity='.5'>b</tspan>c</text>",
    "<style>:root{--brand:THEME}</style><text x='9' y='60' font-size='40' fill='currentColor'>A<tspan style='color:var(--brand)'>b\
     </tspan>c</text>",
    // Copies.
    "<defs><path id='p' LINE fill='none' stroke='currentColor'/></defs><g color='THEME'><use href='#p'/></g>",
    "<defs><path id='p' LINE fill='none' stroke='currentColor'/></defs><use href='#p' color='THEME'/><use href='#p' y='20'/>",
    "<style>:root{--brand:THEME}</style><symbol id='s'><g stroke='var(--brand)'><path LINE fill='none'/></g></symbol><use href='#s'/>",
    "<style>.c{fill:currentColor;color:THEME}</style><defs><path id='p' LINE stroke='blue'/></defs><use href='#p' class='c'/>",
    "<g color='blue'><path id='p' LINE fill='none' stroke='currentColor'/></g><g color='THEME'><use href='#p' y='20'/></g>",
    // Markers, gradients, patterns.
    "<marker id='m' markerWidth='4' markerHeight='4' refX='2' refY='2' viewBox='0 0 4 4'><circle cx='2' cy='2' r='2' fill='currentColor'/>\
     </marker><g color='THEME'><path LINE fill='none' stroke='currentColor' marker-end='url(#m)'/></g>",
    "<linearGradient id='g' color='THEME'><stop stop-color='currentColor'/><stop offset='1' stop-color='white'/></linearGradient>\
     <path LINE fill='none' stroke='url(#g)'/>",
    "<g color='THEME'><pattern id='q' width='20' height='20' patternUnits='userSpaceOnUse'><path d='M0 0H9V9H0Z' fill='currentColor'/>\
     </pattern></g><path d='M10 10H90V90H10Z' stroke='url(#q) red' stroke-width='4' fill='url(#q)'/>",
];

/// Returns the picture of a drawing in which a colour was changed before or after it was warped.
fn picture(body: &str, warp: &WarpOptions, [before, after]: [&str; 2]) -> Vec<u8> {
    let warped = read(&drawing(&body.replace("LINE", LINE).replace("THEME", before))).warp(&Bend, warp).unwrap();
    let tree = parse_tree(warped.svg.replace(before, after).as_bytes(), "themed", &options()).unwrap();
    rendered(&tree, 100, Affine::IDENTITY).data().to_vec()
}

#[test]
fn changing_a_colour_commutes_with_warping() {
    for warp in [warp_options(), warp_options().editing(Edit::Outline)] {
        for body in BODIES {
            let [old, new] = COLORS;
            let wanted = picture(body, &warp, [new, new]);
            assert_ne!(picture(body, &warp, [old, old]), wanted, "{body}");
            let found = picture(body, &warp, [old, new]);
            // The outlines are equal, so at most rounding differs.
            let off = found.iter().zip(&wanted).filter(|(a, b)| a.abs_diff(**b) > 2).count();
            assert!(off == 0, "{body}: {off} of {} values differ", wanted.len());
        }
    }
}

/// A colour that can be changed nowhere else keeps its words, too.
#[test]
fn a_new_fill_says_what_the_stroke_said() {
    for (said, words) in [
        ("stroke='currentColor'", "currentColor"),
        ("style='stroke: var(--brand, #c0392b)'", "var(--brand, #c0392b)"),
        ("stroke='hsl(200, 50%, 40%)'", "hsl(200, 50%, 40%)"),
    ] {
        let body = format!("<path {LINE} fill='none' {said}/>");
        let warped = read(&drawing(&body)).warp(&Bend, &warp_options()).unwrap();
        assert!(warped.svg.contains(&format!("fill=\"{words}\"")), "{}", warped.svg);
    }
}
