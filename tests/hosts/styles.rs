//! Style that usvg does not read, as Chromium shows it: a drawing moved by the browser beside the drawing moved by pathwarp.
//!
//! Skipped where the browser is not installed.

use crate::browser;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::deform::Registry;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame};
use pathwarp::refit;
use pathwarp_oracle::difference;
use pathwarp_raster::Pixmap;
use pathwarp_svg::{Document, ReadOptions, WarpOptions};
use resvg::tiny_skia::IntRect;
use std::fs;
use std::path::Path;

const MATRIX: &str = "0.8,0.2,-0.3,0.9,20,4";

/// Shapes that most cases style.
const RECT: &str = "<rect class='a' x='20' y='20' width='30' height='20'/>";
const THREE: &str = "<g><rect class='b' id='foo' x='10' y='10' width='20' height='20'/><rect class='a' x='40' y='10' width='20' \
                     height='20'/><circle cx='80' cy='50' r='12'/><rect x='10' y='50' width='20' height='30'/></g>";
const LINE: &str = "<path class='a' d='M20 20H70V60' fill='none' stroke='black'/>";

/// Style sheets, and the elements that they style.
const SHEETS: &[(&str, &str)] = &[
    // Geometry.
    (".a{x:30px;y:40px;width:45px;height:5%;rx:4px}", RECT),
    ("circle{r:20px;cx:30%}", THREE),
    (".a{rx:12px;ry:7px}", "<ellipse class='a' cx='60' cy='60' rx='5' ry='5'/>"),
    // Transforms.
    (".a{transform:rotate(20deg)}", RECT),
    (".a{transform:rotate(30deg);transform-box:fill-box;transform-origin:center}", RECT),
    (".a{transform:translate(20%,10%)}", RECT),
    (".a{rotate:20deg}", RECT),
    (".a{scale:1.5 1;translate:10px -10px}", RECT),
    (".a{transform-origin:50% 50%;transform:skewX(.1turn) scale(.5)}", RECT),
    (
        "g{transform:rotate(12deg) scale(.7);transform-box:fill-box;transform-origin:50% top}.a{transform:translateY(3px)}",
        THREE,
    ),
    // Variables and expressions.
    (":root{--c:#e00;--w:var(--v,6px)}.a{stroke:var(--c)!important;stroke-width:var(--w)}", LINE),
    (".a{stroke-width:calc(2px + 4%)}", LINE),
    (".a{stroke-width:max(2px, .5rem);stroke-dasharray:calc(1px * 8) 1rem}", LINE),
    (".a{fill:red;fill:color(display-p3 0.4 0.6 0.4)}", RECT),
    (".a{stroke:oklch(0.7 0.1 150);stroke-width:9px}", LINE),
    (".a{filter:drop-shadow(5px .5rem 2px rgba(200,0,0,.6))}", RECT),
    ("g{filter:drop-shadow(rgb(0 0 200 / 60%) 9px 4px)}", THREE),
    // Selectors.
    ("rect:nth-child(2){fill:red}", THREE),
    ("rect:nth-of-type(2n + 1){fill:red}", THREE),
    ("rect:last-child{fill:red}circle:only-of-type{fill:blue}", THREE),
    ("rect:not(.b){fill:red}", THREE),
    (":is(circle, .b){fill:red}:where(#foo){fill:blue}", THREE),
    ("rect ~ circle{fill:red}", THREE),
    ("[id^='fo']{fill:red}[class$=a]{fill:lime}", THREE),
    // Rules that apply, among others.
    (".a{fill:red}@media print{.a{display:none}}@media screen and (prefers-color-scheme:light){.a{stroke:lime}}", RECT),
    ("@supports (fill:red){.a{fill:red}}", RECT),
    ("@layer x{.a{fill:red}}@layer y{.a{fill:lime}}@layer x{.a{fill:blue}}", RECT),
    ("@layer x{#foo{fill:red!important}}.b{fill:blue!important}", THREE),
];

/// Drawings that contain style.
const DRAWINGS: &[&str] = &[
    "<style media='print'>rect{fill:red}</style><rect x='10' y='10' width='20' height='20'/>",
    "<circle style='cx:30;cy:40;r:15px;fill:red'/>",
    "<rect fill='var(--c, blue)' x='calc(10px + 5px)' y='1rem' width='calc(50% - 10px)' height='20'/>",
    "<symbol id='s' viewBox='0 0 10 10'><circle cx='5' cy='5' r='5'/></symbol><use href='#s' x='10' width='50%' height='30%'/>",
    "<path d='M10 50H90' pathLength='10' stroke='black' stroke-width='4' stroke-dasharray='1'/>",
    "<g stroke-dasharray='20 5' stroke-dashoffset='7'><circle cx='50' cy='50' r='30' pathLength='100' fill='none' stroke='red'/></g>",
    "<style>rect{stroke:red;fill:none;stroke-dasharray:.2}</style><rect x='9' y='9' width='60' height='40' rx='9' pathLength='2'/>",
    "<style>g > :nth-of-type(2){fill:red}</style><g><path d='M9 9h20v20z'/><rect x='50' width='20' height='20'/><rect y='50' \
     width='20' height='20'/><path d='M50 50h20v20z'/></g>",
    "<g style='--c:lime'><rect style='fill:var(--c);transform:rotate(10deg)' x='30' width='40' height='20'/></g>",
];

/// Texts in the font F.
const TEXTS: &[&str] = &[
    "<text class='a' x='5' y='30' font-size='9'>Hand</text><style>.a{font:14px/1.5 F,serif}</style>",
    "<text x='5' y='30'>Size</text><text x='5' y='60' font-size='large'>Size <tspan font-size='smaller'>of</tspan></text>",
    "<text x='5' y='40' font-size='20' style='text-transform:uppercase'>straße</text>",
    "<text x='5' y='40' font-size='16'><tspan style='text-transform:capitalize'>two words</tspan></text>",
    "<text x='5' y='40' font-size='14' style='white-space:pre'>a  b   c</text>",
    "<text x='95' y='40' font-size='16' direction='rtl'>abc!</text><text x='95' y='80' font-size='16' direction='rtl'>4 (5) x.</text>",
    "<text x='50' y='40' font-size='14' style='direction:rtl;unicode-bidi:bidi-override' text-anchor='middle'>Hallo!</text>",
    "<g direction='rtl'><text font-size='14'><tspan x='90' y='30'>one!</tspan><tspan x='90' y='60'>two?</tspan></text></g>",
    "<text x='5' y='40' font-size='20'>A<tspan opacity='.3'>BC<tspan style='opacity:.5'>D</tspan></tspan>E</text>",
    "<text x='5' y='40' font-size='12' style='letter-spacing:2.4px'>fifty ff</text>\
     <text x='95' y='80' font-size='12' letter-spacing='9' text-anchor='end'>end</text>",
];

/// The bundled font as F.
fn with_font(text: &str) -> String {
    let data = STANDARD.encode(pathwarp_svg::engine::bundled_font());
    format!(
        "<style>@font-face{{font-family:F;src:url(data:font/ttf;base64,{data})}}</style><g font-family='F' text-rendering='geometricPrecision'>{text}</g>"
    )
}

fn drawings() -> Vec<String> {
    let sheets = SHEETS.iter().map(|(css, body)| format!("<style>{css}</style>{body}"));
    let all = sheets.chain(DRAWINGS.iter().map(|d| (*d).to_owned())).chain(TEXTS.iter().map(|t| with_font(t)));
    let svg = |body| {
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100' width='400' height='400'>{body}</svg>")
    };
    all.map(svg).collect()
}

fn moved(svg: &str) -> String {
    warped(svg, 100.0, "affine", &[("matrix", MATRIX)])
}

fn warped(svg: &str, side: f64, deformation: &str, args: &[(&str, &str)]) -> String {
    let doc = Document::read(svg.as_bytes(), "styled.svg", &ReadOptions::default()).unwrap();
    let frame = Frame::new(Rect::new(0.0, 0.0, side, side));
    let map = Registry::builtin().get(deformation).unwrap().build_from(&Args::from_pairs(args), &frame);
    let warped = doc.warp(&map.unwrap().map, &WarpOptions::new(refit::Options::new(1e-3))).unwrap();
    assert!(warped.skipped.is_empty(), "{svg}: {:?}", warped.skipped);
    warped.svg
}

/// Pixels of a drawing's side, and of its cell among the others.
const SIDE: usize = 200;
const COLUMNS: usize = 6;

/// Shows drawings side by side in Chromium, each under a transform of the browser.
fn shown(drawings: &[String], transform: &str, name: &str, folder: &Path) -> Pixmap {
    let mut page = "<body style='margin:0;background:white'>".to_owned();
    for (i, svg) in drawings.iter().enumerate() {
        let file = format!("{name}{i}.svg");
        fs::write(folder.join(&file), svg).unwrap();
        let (x, y) = (i % COLUMNS * SIDE, i / COLUMNS * SIDE);
        page += &format!(
            "<div style='position:absolute;left:{x}px;top:{y}px;width:{SIDE}px;height:{SIDE}px;overflow:hidden'><img src='{file}' \
             style='width:{SIDE}px;transform-origin:0 0;transform:{transform}'></div>"
        );
    }
    let html = folder.join(format!("{name}.html"));
    fs::write(&html, page).unwrap();
    browser::shown(&html, [COLUMNS * SIDE, drawings.len().div_ceil(COLUMNS) * SIDE])
}

/// For each drawing, the fraction of its pixels that differ by more than antialiasing.
fn differences(a: &Pixmap, b: &Pixmap, drawings: usize) -> Vec<f64> {
    const VISIBLE: u8 = 90;
    let one = |i: usize| {
        let [x, y] = [i % COLUMNS, i / COLUMNS].map(|k| (k * SIDE) as i32);
        let place = IntRect::from_xywh(x, y, SIDE as u32, SIDE as u32).unwrap();
        let [a, b] = [a, b].map(|p| p.clone_rect(place).unwrap());
        difference(&a, &b).share(VISIBLE)
    };
    (0..drawings).map(one).collect()
}

#[test]
fn style_is_read_as_browsers_read_it() {
    if let Some(what) = browser::missing() {
        crate::support::skipped(format_args!("style is not compared with browsers without {what}"));
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let originals = drawings();
    let results: Vec<String> = originals.iter().map(|svg| moved(svg)).collect();
    // The matrix is in units of 100 to the side.
    let scale = SIDE as f64 / 100.0;
    let transform = format!("matrix(0.8,0.2,-0.3,0.9,{},{})", 20.0 * scale, 4.0 * scale);
    let expected = shown(&originals, &transform, "original", folder.path());
    let found = shown(&results, "none", "result", folder.path());
    for (i, off) in differences(&expected, &found, originals.len()).into_iter().enumerate() {
        assert!(off < 1e-3, "{:.2} % of the pixels differ:\n{}\n{}", off * 100.0, originals[i], results[i]);
    }
    // The comparison can fail: no drawing looks like its original unless it is moved.
    let still = shown(&originals, "none", "still", folder.path());
    let off = differences(&expected, &still, originals.len());
    assert!(off.iter().all(|o| *o > 0.01), "{off:?}");
}

/// Icons as icon sets write them, in `THEME`.
const ICONS: &[(&str, &str)] = &[
    (
        "fill='none' stroke='currentColor' stroke-width='2' stroke-linecap='round' stroke-linejoin='round'",
        "<circle cx='12' cy='12' r='9'/><polyline points='8 12 11 15 16 9'/><line x1='12' y1='1' x2='12' y2='3'/>",
    ),
    (
        "class='icon' fill='none' stroke='currentColor' stroke-width='1.5'",
        "<style>.icon{color:THEME}.thin{stroke-width:1;stroke-dasharray:2 1}</style><rect x='3' y='6' width='18' height='13' rx='2'/>\
         <path class='thin' d='M3 10H21'/><path d='M7 15a3 3 0 0 1 6 0' stroke-linecap='round'/>",
    ),
    (
        "fill='currentColor'",
        "<path d='M12 2L22 20H2Z'/><path d='M5 4H19' stroke='currentColor' stroke-opacity='.5' stroke-width='2'/>",
    ),
    (
        "style='fill:var(--inside, none);stroke:var(--line);stroke-width:2;--line:THEME'",
        "<ellipse cx='12' cy='12' rx='10' ry='6'/><g style='--inside:THEME'><circle cx='12' cy='12' r='3' style='fill:var(--inside)'/></g>",
    ),
    (
        "stroke='currentColor'",
        "<defs><path id='a' d='M4 12H18M13 7L18 12L13 17' fill='none' stroke-width='2'/></defs><use href='#a'/><use href='#a' y='6'/>",
    ),
];

/// Under each of three warps, an icon takes a new colour as it does before the warp.
#[test]
fn icons_can_be_themed_after_a_warp() {
    if let Some(what) = browser::missing() {
        crate::support::skipped(format_args!("themes are not compared with browsers without {what}"));
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let svg = |color: &str, (root, body): &(&str, &str)| {
        let style = if root.contains("style=") || root.contains("class=") { "" } else { "style='color:THEME'" };
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 24 24' width='24' height='24' {style} {root}>{body}</svg>")
            .replace("THEME", color)
    };
    let [old, new] = ["#0a6e31", "#ff2060"];
    let (mut before, mut after, mut plain) = (Vec::new(), Vec::new(), Vec::new());
    for (deformation, args) in
        [("warp", &[("style", "arch")]), ("warp", &[("style", "flag")]), ("swirl", &[("angle", "70")])]
    {
        for icon in ICONS {
            let bent = |color| warped(&svg(color, icon), 24.0, deformation, args);
            before.push(bent(new));
            plain.push(bent(old));
            after.push(bent(old).replace(old, new));
        }
    }
    let [before, after, plain] = [(&before, "before"), (&after, "after"), (&plain, "plain")]
        .map(|(all, name)| shown(all, "none", name, folder.path()));
    let drawings = 3 * ICONS.len();
    for (i, off) in differences(&before, &after, drawings).into_iter().enumerate() {
        assert!(off < 1e-3, "{:.2} % of the pixels differ: {:?}", off * 100.0, ICONS[i % ICONS.len()]);
    }
    // All of them have changed.
    assert!(differences(&plain, &after, drawings).into_iter().all(|off| off > 0.01));
}
