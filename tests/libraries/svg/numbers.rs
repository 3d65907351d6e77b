//! Numbers in results have as many digits as they need.

use pathwarp::kurbo::Affine;
use pathwarp::map::{AffineMap, Map};
use pathwarp_oracle::drawings::{Bend, drawing, read, warp_options};
use pathwarp_svg::{PageFit, Structure};
use std::f64::consts::FRAC_PI_2;

const DRAWING: &str = "<linearGradient id='g' gradientTransform='rotate(90 .5 .5)'><stop stop-color='red'/><stop offset='1'/></linearGradient>\
    <radialGradient id='r' gradientUnits='userSpaceOnUse' cx='30' cy='30' r='20'><stop/><stop offset='.3' stop-opacity='.7'/></radialGradient>\
    <pattern id='q' width='7' height='7' patternUnits='userSpaceOnUse' patternTransform='rotate(30)'><path d='M0 0h3v3z'/></pattern>\
    <filter id='f' x='-.1' y='-.2' width='1.3' height='1.4'><feGaussianBlur stdDeviation='.1'/></filter>\
    <mask id='m'><circle cx='50' cy='50' r='30' fill='white'/></mask><symbol id='s' viewBox='0 0 10 10'><circle cx='5' cy='5' r='5'/></symbol>\
    <rect x='10' y='10' width='30' height='20' fill='url(#g)' stroke='url(#r)' stroke-width='.3' stroke-dasharray='1.1 .7'/>\
    <circle cx='60' cy='40' r='9' fill='url(#q)' opacity='.35'/><g filter='url(#f)'><ellipse cx='30' cy='70' rx='9' ry='4'/></g>\
    <g mask='url(#m)' transform='rotate(90)'><path d='M20-60h30v30z' fill='url(#r)' fill-opacity='.6'/></g>\
    <use href='#s' x='60' y='60' width='20' height='20'/><image x='70' y='10' width='20' height='15' href='data:image/png;base64,\
    iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=='/>\
    <text x='20' y='90' font-size='9'>Ab</text>";

/// Returns the digits of a number from the first that is not zero, and its decimals.
fn digits(number: &str) -> (usize, usize) {
    let decimals = number.split_once('.').map_or(0, |n| n.1.len());
    let all: String = number.chars().filter(char::is_ascii_digit).collect();
    (all.trim_start_matches('0').len(), decimals)
}

#[test]
fn numbers_have_the_digits_they_need() {
    let source = drawing(DRAWING);
    let turned = AffineMap(Affine::rotate_about(FRAC_PI_2, (50.0, 50.0)));
    let moved = AffineMap(Affine::translate((0.1 + 0.2, 1.0 / 3.0)) * Affine::rotate(0.3));
    let maps: [&dyn Map; 3] = [&Bend, &turned, &moved];
    for (k, map) in maps.into_iter().enumerate() {
        for structure in [Structure::Keep, Structure::Flatten] {
            let options = warp_options().with_structure(structure).with_page(PageFit::Grow);
            let svg = read(&source).warp(map, &options).unwrap().svg;
            // Embedded pictures contain digits that are no numbers.
            let mut parts = svg.split("base64,");
            let first = parts.next().unwrap_or_default();
            let rest: String = parts.filter_map(|part| Some(part.split_once(['"', '\''])?.1)).collect();
            let text = format!("{first} {rest}");
            for number in text.split(|c: char| !c.is_ascii_digit() && c != '.').filter(|n| !n.is_empty()) {
                let (digits, decimals) = digits(number);
                assert!(digits <= 12 && decimals <= 13, "map {k}, {structure:?}: {number}\n{svg}");
            }
        }
    }
}
