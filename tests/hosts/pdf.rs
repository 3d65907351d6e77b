//! PDF files as an independent renderer, Poppler, draws them.

use crate::support::geometry::{far, gap, outlines};
use crate::support::{artwork, expect_code, sample};
use pathwarp::kurbo::Point;
use pathwarp_oracle::on_white;
use pathwarp_raster::{Size, decode_png, render};
use pathwarp_svg::usvg_tree::parse_tree;
use pathwarp_svg::{Document, ReadOptions};
use resvg::tiny_skia::IntRect;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Runs a program of Poppler. Returns `false` if it is not installed.
fn poppler(program: &str, args: &[&str]) -> bool {
    match Command::new(program).args(args).output() {
        Ok(out) => {
            let said = String::from_utf8_lossy(&out.stderr);
            assert!(out.status.success() && said.is_empty(), "{program} {args:?}: {said}");
            true
        }
        Err(_) => {
            crate::support::skipped(format_args!(
                "PDF files are not compared with Poppler's pictures without {program}"
            ));
            false
        }
    }
}

/// Draws a PDF and an SVG. Returns the mean difference, of 255, and the fraction of pixels that differ much.
fn difference(folder: &Path, pdf: &Path, svg: &Path) -> Option<(f64, f64)> {
    const WIDTH: f32 = 600.0;
    let read = ReadOptions::default().with_base_dir(Some(folder.to_owned()));
    let tree = parse_tree(&fs::read(svg).unwrap(), "svg", &read).unwrap();
    let scale = WIDTH / tree.size().width();
    // A page is composed by itself, and then laid on white paper.
    let ours = render(&tree, Size::Scale(scale)).unwrap();
    let drawn = folder.join("drawn");
    let (pdf, to, resolution) = (pdf.to_str().unwrap(), drawn.to_str().unwrap(), (96.0 * scale).to_string());
    if !poppler("pdftocairo", &["-png", "-singlefile", "-r", &resolution, pdf, to]) {
        return None;
    }
    let theirs = decode_png(&fs::read(drawn.with_extension("png")).unwrap()).unwrap();
    // The last row and column may be missing in one of the pictures.
    let (width, height) = (ours.width().min(theirs.width()), ours.height().min(theirs.height()));
    assert!(ours.width() - width <= 1 && theirs.width() - width <= 1, "{} {}", ours.width(), theirs.width());
    assert!(ours.height() - height <= 1 && theirs.height() - height <= 1);
    let page = IntRect::from_xywh(0, 0, width, height).unwrap();
    let [ours, theirs] = [ours, theirs].map(|p| on_white(p.clone_rect(page).unwrap()));
    let d = pathwarp_oracle::difference(&ours, &theirs);
    // Both pictures are opaque now.
    Some((d.mean * 4.0 / 3.0, d.share(64)))
}

#[test]
fn warped_samples_look_as_their_svg_does() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    for name in artwork() {
        let input = sample(&name).display().to_string();
        let mut ways = vec![vec!["warp", "--style", "flag", "--fit", "page", &input]];
        ways.push(vec!["swirl", "--gradients", "exact", "--fit", "page", &input]);
        for way in ways {
            for to in ["a.svg", "a.pdf"] {
                let to = at(to).display().to_string();
                expect_code(0, &[&way[..], &["--quiet", "-o", &to]].concat());
            }
            let Some((mean, far)) = difference(dir.path(), &at("a.pdf"), &at("a.svg")) else { return };
            println!("{name} {}: mean {mean:.3}, far {far:.5}", way[0]);
            assert!(mean < 1.0 && far < 0.003, "{name} {way:?}: mean {mean}, far {far}");
        }
    }
}

/// Features of drawings, one by one.
#[test]
fn features_look_as_in_svg() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    expect_code(0, &["render", sample("icon.svg").to_str().unwrap(), "-o", at("i.png").to_str().unwrap()]);
    expect_code(0, &["render", sample("icon.svg").to_str().unwrap(), "-o", at("i.jpg").to_str().unwrap()]);
    let mut bad = Vec::new();
    for (name, body) in FEATURES {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='200' height='150' viewBox='0 0 400 300'>{body}</svg>"
        );
        fs::write(at("f.svg"), svg).unwrap();
        expect_code(0, &["convert", at("f.svg").to_str().unwrap(), "-o", at("f.pdf").to_str().unwrap()]);
        let Some((mean, far)) = difference(dir.path(), &at("f.pdf"), &at("f.svg")) else { return };
        println!("{name}: mean {mean:.3}, far {far:.5}");
        bad.extend((mean > 1.2 || far > 0.006).then(|| format!("{name}: mean {mean}, far {far}")));
    }
    assert!(bad.is_empty(), "{bad:#?}");
    // The comparison can fail.
    fs::write(at("f.svg"), "<svg xmlns='http://www.w3.org/2000/svg' width='200' height='150'/>").unwrap();
    assert!(difference(dir.path(), &at("f.pdf"), &at("f.svg")).is_none_or(|(mean, _)| mean > 5.0));
}

const FEATURES: [(&str, &str); 15] = [
    (
        "bitmaps",
        "<rect width='400' height='300' fill='#dd6'/><image href='i.png' x='20' y='20' width='170' height='170'/>\
         <image href='i.jpg' width='150' height='150' transform='translate(220 60) rotate(15)' opacity='.8'/>",
    ),
    (
        "linear gradients: spread, transform, opacity",
        "<linearGradient id='g' x1='0' x2='.2' spreadMethod='reflect' gradientTransform='rotate(30)'><stop stop-color='red'/>\
         <stop offset='1' stop-color='blue' stop-opacity='.2'/></linearGradient>\
         <linearGradient id='h' x2='.6' spreadMethod='repeat'><stop stop-color='lime'/><stop offset='.5' stop-color='black'/>\
         <stop offset='.5' stop-color='white'/><stop offset='1' stop-color='gray'/></linearGradient>\
         <rect width='180' height='280' x='10' y='10' fill='url(#g)'/><circle cx='300' cy='150' r='70' fill='none' \
         stroke-width='40' stroke='url(#h)'/>",
    ),
    (
        "radial gradients: focus, spread",
        "<radialGradient id='g' fx='.42' fy='.45' r='.3' spreadMethod='reflect'><stop stop-color='gold'/><stop offset='1' \
         stop-color='navy'/></radialGradient><radialGradient id='h' fr='.2' fx='.6'><stop stop-color='red'/><stop offset='1' \
         stop-color='red' stop-opacity='0'/></radialGradient><rect width='190' height='280' fill='url(#g)'/>\
         <rect x='200' width='190' height='280' fill='url(#h)'/>",
    ),
    (
        "several stops at one offset",
        "<linearGradient id='g' x1='.2' x2='.8'><stop stop-color='black'/><stop stop-color='red'/><stop stop-color='gray'/>\
         <stop offset='1' stop-color='white'/><stop offset='1' stop-color='blue'/></linearGradient>\
         <rect width='400' height='300' fill='url(#g)'/>",
    ),
    (
        "caps of lines without length",
        "<g stroke='green' stroke-width='60'><path stroke-linecap='square' d='M100,80h0M300,80h0'/><path \
         stroke-linecap='round' d='M100,220h0'/></g>",
    ),
    (
        "patterns",
        "<pattern id='p' width='40' height='30' x='7' y='5' patternUnits='userSpaceOnUse' patternTransform='rotate(20) scale(4)'>\
         <circle cx='12' cy='12' r='10' fill='teal'/><path d='M20,20h20v10h-20z' fill='orange'/></pattern>\
         <g transform='translate(20 10) scale(.9)'><rect width='380' height='280' fill='url(#p)' fill-opacity='.7'/></g>",
    ),
    (
        "opacity of groups",
        "<g opacity='.5'><rect width='250' height='200' fill='red'/><rect x='100' y='80' width='250' height='200' \
         fill='blue'/></g><rect x='50' y='150' width='300' height='60' fill='green' opacity='.6'/>",
    ),
    (
        "blend modes",
        "<rect width='300' height='200' fill='#fa4'/><g style='isolation:isolate'><rect x='50' y='50' width='100' height='200' \
         fill='#8cf'/><rect x='80' y='100' width='200' height='100' fill='#f8c' style='mix-blend-mode:multiply'/></g>\
         <circle cx='280' cy='150' r='90' fill='#48c' style='mix-blend-mode:difference'/>",
    ),
    (
        "clip paths: nested, of several overlapping shapes, even-odd",
        "<clipPath id='a'><circle cx='150' cy='150' r='120'/><path d='M150,20 V280 H390 V20 Z'/></clipPath>\
         <clipPath id='b' clip-path='url(#a)'><path clip-rule='evenodd' d='M20,20H380V280H20Z M100,100H300V200H100Z'/></clipPath>\
         <rect width='400' height='300' fill='purple' clip-path='url(#b)'/><g clip-path='url(#a)'><rect x='110' y='110' \
         width='180' height='80' fill='gold'/></g>",
    ),
    (
        "masks: luminance, alpha, nested",
        "<linearGradient id='g'><stop stop-color='white'/><stop offset='1'/></linearGradient>\
         <mask id='m'><rect width='400' height='300' fill='url(#g)'/></mask><mask id='n' mask-type='alpha' mask='url(#m)'>\
         <circle cx='200' cy='150' r='140' fill='black' fill-opacity='.8'/></mask>\
         <rect width='400' height='140' fill='crimson' mask='url(#m)'/><rect y='150' width='400' height='150' fill='navy' \
         mask='url(#n)'/>",
    ),
    (
        "filters",
        "<filter id='f' x='-30%' y='-30%' width='160%' height='160%'><feGaussianBlur stdDeviation='8'/></filter>\
         <g transform='rotate(20 200 150)'><rect x='100' y='80' width='200' height='120' fill='tomato' filter='url(#f)'/></g>",
    ),
    (
        "strokes: dashes, caps, joins, skewed",
        "<g fill='none' stroke='black' transform='skewX(20)'><path d='M30,40 L120,200 L200,40' stroke-width='24'/>\
         <path d='M30,250 H250' stroke-width='16' stroke-dasharray='30 20' stroke-dashoffset='-10' stroke-linecap='round'/>\
         <path d='M220,200 l30,-120 l20,120' stroke-width='14' stroke-linejoin='round' paint-order='stroke' fill='red'/></g>",
    ),
    (
        "text",
        "<text x='20' y='120' font-size='90' font-family='Noto Sans' fill='navy'>Type</text><text x='20' y='240' font-size='60' \
         font-family='Noto Sans' fill='none' stroke='red' stroke-width='2'>outlined</text>",
    ),
    (
        "embedded drawings",
        "<image x='50' y='40' width='300' height='200' href=\"data:image/svg+xml;utf8,&lt;svg xmlns='http://www.w3.org/2000/svg' \
         width='30' height='20'>&lt;rect width='30' height='20' fill='teal'/>&lt;circle cx='15' cy='10' r='9' fill='gold'/>&lt;/svg>\"/>",
    ),
    (
        "uses and symbols",
        "<symbol id='s' viewBox='0 0 10 10'><path d='M0,0H10V10Z'/></symbol><use href='#s' width='150' height='150' fill='red'/>\
         <use href='#s' x='200' y='60' width='180' height='220' opacity='.5'/>",
    ),
];

/// Circles are within a hundred-thousandth of their radius, where usvg's cubics are off by up to a tenth of a unit.
#[test]
fn arcs_are_true() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='300mm' height='300mm' viewBox='0 0 30 30'>\
               <circle cx='15' cy='15' r='14'/></svg>";
    fs::write(at("c.svg"), svg).unwrap();
    expect_code(0, &["convert", &at("c.svg"), "-o", &at("c.pdf")]);
    if !poppler("pdftocairo", &["-svg", &at("c.pdf"), &at("back.svg")]) {
        return;
    }
    let doc = Document::read(&fs::read(at("back.svg")).unwrap(), "back", &ReadOptions::default()).unwrap();
    let shape = doc.shapes().iter().find(|s| s.painted && s.outline.segs().count() >= 4).unwrap();
    let box_ = shape.outline.bounding_box().unwrap();
    let (center, radius): (Point, f64) = (box_.center(), box_.width() / 2.0);
    let points = shape.outline.segs().flat_map(|s| (0..=100).map(|i| s.eval(f64::from(i) / 100.0)));
    let off = points.map(|p| (p.distance(center) - radius).abs()).fold(0.0, f64::max) / radius;
    // Poppler writes six decimals, on a page scaled to whole px.
    assert!(off < 1e-5, "{off}");
    assert!((radius - 140.0 / 25.4 * 72.0).abs() < 0.5, "{radius}");
}

/// Drawings of maps look alike far from the origin and near it.
#[test]
fn far_drawings_keep_their_shape() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let mut shown = Vec::new();
    for [x, y] in [[0.0, 0.0], [1e6, 2e6], [3.67e7, -5.5e6]] {
        fs::write(at("far.svg"), far(x, y)).unwrap();
        expect_code(0, &["convert", &at("far.svg"), "-o", &at("far.pdf")]);
        if !poppler("pdftocairo", &["-svg", &at("far.pdf"), &at("back.svg")]) {
            return;
        }
        let back = outlines(&fs::read(at("back.svg")).unwrap());
        assert!(back.len() >= 3, "{}", back.len());
        shown.push(back);
    }
    for far in &shown[1..] {
        let (there, back) = (gap(far, &shown[0]), gap(&shown[0], far));
        assert!(there.max(back) < 1e-3, "{there} {back}");
    }
}

/// Returns Ghostscript's plates of a PDF: their names and files.
fn plates(dir: &Path, pdf: &Path) -> Option<Vec<(String, Vec<u8>)>> {
    let out = dir.join(format!("{}-plate.tif", pdf.file_stem()?.to_str()?));
    let to = format!("-sOutputFile={}", out.display());
    let device = ["-q", "-dNOPAUSE", "-dBATCH", "-dSAFER", "-sDEVICE=tiffsep", "-sCompression=none", "-r144", &to];
    let Ok(run) = Command::new("gs").args(device).arg(pdf).output() else {
        crate::support::skipped(format_args!("inks of a PDF are not separated without Ghostscript"));
        return None;
    };
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let begins = format!("{}(", out.file_stem()?.to_str()?);
    let mut found = Vec::new();
    for file in fs::read_dir(dir).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        if let Some(ink) = name.strip_prefix(&begins).and_then(|n| n.strip_suffix(").tif")) {
            found.push((ink.to_owned(), fs::read(dir.join(&name)).unwrap()));
        }
    }
    Some(found)
}

/// The line is one plate of its name, printed over the others. Those are equal to the plates without it, unless it knocks out.
#[test]
fn a_cutting_line_is_an_ink() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let source = "<svg xmlns='http://www.w3.org/2000/svg' width='60mm' height='40mm' viewBox='0 0 60 40'><rect x='5' y='5' width='50' height='30' fill='#246'/></svg>";
    fs::write(at("a.svg"), source).unwrap();
    let path = |p: &Path| p.to_str().unwrap().to_owned();
    let run = |name: &str, args: &[&str]| {
        let (from, to) = (path(&at("a.svg")), path(&at(name)));
        expect_code(0, &[&[args[0], from.as_str()][..], &args[1..], &["-o", to.as_str()]].concat());
        at(name)
    };
    let spot = ["contour", "--by=-3mm", "--spot", "CutContour"];
    let over = run("over.pdf", &spot);
    let out = run("out.pdf", &[&spot[..], &["--knockout"]].concat());
    let plain = run("plain.pdf", &["convert"]);
    for pdf in [&over, &out] {
        match Command::new("qpdf").arg("--check").arg(pdf).output() {
            Ok(run) => assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout)),
            Err(_) => crate::support::skipped(format_args!("PDF files are not checked without qpdf")),
        }
    }
    let [Some(over), Some(out), Some(plain)] = [&over, &out, &plain].map(|pdf| plates(dir.path(), pdf)) else { return };
    let names = |plates: &[(String, Vec<u8>)]| {
        let mut names: Vec<String> = plates.iter().map(|p| p.0.clone()).collect();
        names.sort();
        names
    };
    assert_eq!(names(&over), ["Black", "CutContour", "Cyan", "Magenta", "Yellow"]);
    assert_eq!(names(&plain), ["Black", "Cyan", "Magenta", "Yellow"]);
    let plate = |plates: &[(String, Vec<u8>)], name: &str| plates.iter().find(|p| p.0 == name).unwrap().1.clone();
    let differing = |a: &[(String, Vec<u8>)]| {
        let [a, b] = [plate(a, "Cyan"), plate(&plain, "Cyan")];
        a.iter().zip(&b).filter(|(a, b)| a != b).count() + a.len().abs_diff(b.len())
    };
    // A TIFF contains the time at which it was made, in 19 characters.
    assert!(differing(&over) <= 19 && differing(&out) > 500, "{} {}", differing(&over), differing(&out));
}
