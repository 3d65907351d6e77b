//! Bent mesh gradients in an installed Inkscape, the only program that draws them, and in PDF, which has them too.

use super::editor;
use crate::support::pathwarp_in;
use std::fs;
use std::path::Path;
use std::process::Command;

/// A mesh of curved patches, one with colours that change smoothly, one that refers to another, on a stroke, on a text, and on a copy.
const DRAWING: &str = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='400' height='300' \
    viewBox='0 0 400 300'><defs><meshgradient id='curved' gradientUnits='userSpaceOnUse' x='20' y='40'><meshrow><meshpatch><stop \
    path='c 30,-25 40,25 80,0' style='stop-color:#f00'/><stop path='c 0,33 20,67 0,100' style='stop-color:#ff0'/><stop \
    path='c -23,20 -57,0 -80,0' style='stop-color:#00f'/><stop path='c 0,-33 0,-67 0,-100' style='stop-color:#0f0;stop-opacity:.2'/>\
    </meshpatch></meshrow></meshgradient><meshgradient id='smooth' type='bicubic' gradientUnits='userSpaceOnUse' x='150' y='20'><meshrow>\
    <meshpatch><stop path='l 40,0' style='stop-color:#f00'/><stop path='l 0,100' style='stop-color:#ff0'/><stop path='l -40,0' \
    style='stop-color:#000'/><stop path='l 0,-100' style='stop-color:#0f0'/></meshpatch><meshpatch><stop path='l 40,0'/><stop \
    path='l 0,100' style='stop-color:#00f'/><stop path='l -40,0' style='stop-color:#fff'/></meshpatch><meshpatch><stop path='l 40,0'/>\
    <stop path='l 0,100' style='stop-color:#f0f'/><stop path='l -40,0' style='stop-color:#000'/></meshpatch></meshrow></meshgradient>\
    <meshgradient id='again' xlink:href='#smooth' x='30' y='160' gradientTransform='translate(-30 0) scale(2 1)'/></defs>\
    <path d='M20 20h80v140l-40-20-40 20z' style='fill:url(#curved)' id='a'/>\
    <rect x='150' y='20' width='120' height='100' style='fill:url(#smooth);stroke:#000;stroke-width:3'/>\
    <g fill='url(#again)'><ellipse cx='110' cy='220' rx='70' ry='50'/></g>\
    <use xlink:href='#a' transform='translate(270 20) rotate(8)'/>\
    <path d='M200 220q40-60 80 0t80 0' style='fill:none;stroke:url(#again);stroke-width:24' transform='translate(-170 20)'/></svg>";

/// A map with a simple inverse: a sine along x, and then one along y.
const THERE: [&str; 2] = ["x + 6*sin(y/30)", "y + 8*sin((x + 6*sin(y/30))/25)"];

fn back([x, y]: [f64; 2]) -> [f64; 2] {
    let y = y - 8.0 * (x / 25.0).sin();
    [x - 6.0 * (y / 30.0).sin(), y]
}

/// A picture on white, with its width.
struct Picture {
    data: Vec<u8>,
    width: usize,
}

impl Picture {
    fn read(file: &Path) -> Self {
        let picture = resvg::tiny_skia::Pixmap::load_png(file).unwrap();
        let on_white =
            |p: &resvg::tiny_skia::PremultipliedColorU8| [p.red(), p.green(), p.blue()].map(|c| c + (255 - p.alpha()));
        Self { data: picture.pixels().iter().flat_map(on_white).collect(), width: picture.width() as usize }
    }

    fn at(&self, x: usize, y: usize) -> &[u8] {
        &self.data[3 * (y * self.width + x)..][..3]
    }

    fn height(&self) -> usize {
        self.data.len() / 3 / self.width
    }

    /// Returns the largest difference from any pixel around a point in px, since edges are smoothed; `None` beyond the picture.
    fn off(&self, wanted: &[u8], [x, y]: [f64; 2], scale: f64) -> Option<u8> {
        let [i, k] = [x * scale, y * scale].map(|v| v.floor() as isize);
        let around = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [i + a, k + b]));
        let inside =
            |p: &[isize; 2]| (0..self.width as isize).contains(&p[0]) && (0..self.height() as isize).contains(&p[1]);
        let apart = |p: [isize; 2]| {
            let own = self.at(p[0] as usize, p[1] as usize);
            own.iter().zip(wanted).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or_default()
        };
        around.filter(inside).map(apart).min()
    }
}

/// Returns the fraction of pixels of the result that differ by more than 3 % from the pixels of the source from which they come.
fn wrong(source: &Picture, result: &Picture, scale: f64) -> f64 {
    const MOST: u8 = 8;
    let all: Vec<bool> = (0..result.height())
        .flat_map(|y| (0..result.width).map(move |x| (x, y)))
        .filter_map(|(x, y)| {
            let from = back([(x as f64 + 0.5) / scale, (y as f64 + 0.5) / scale]);
            Some(source.off(result.at(x, y), from, scale)? > MOST)
        })
        .collect();
    all.iter().filter(|w| **w).count() as f64 / all.len() as f64
}

#[test]
fn inkscape_and_pdf_show_bent_meshes() {
    if !editor::is_installed() {
        return;
    }
    const SCALE: f64 = 2.0;
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("in.svg"), DRAWING).unwrap();
    let bend = |more: &[&str]| {
        let map = ["expr", "in.svg", "--fit", "none", "--x", THERE[0], "--y", THERE[1]];
        let run = pathwarp_in(dir.path(), &[&map[..], more].concat(), b"");
        assert_eq!((run.status.code(), String::from_utf8_lossy(&run.stderr)), (Some(0), "".into()), "{more:?}");
    };
    let draw = |svg: &str, png: &str| {
        let width = (400.0 * SCALE).to_string();
        editor::convert(dir.path(), &[svg, "-o", png, "-w", &width]);
        Picture::read(&at(png))
    };
    let source = draw("in.svg", "in.png");
    for structure in ["keep", "flatten"] {
        bend(&["-o", "out.svg", "--structure", structure]);
        let share = wrong(&source, &draw("out.svg", "out.png"), SCALE);
        println!("{structure}: {:.3} % of the pixels differ", 100.0 * share);
        assert!(share < 0.01, "{structure}: {share}");
    }
    // The comparison can fail.
    let unbent = wrong(&source, &source, SCALE);
    assert!(unbent > 0.1, "{unbent}");
    bend(&["-o", "out.pdf"]);
    let resolution = (96.0 * SCALE).to_string();
    let drawn = Command::new("pdftocairo")
        .args(["-png", "-singlefile", "-r", &resolution, "out.pdf", "pdf"])
        .current_dir(dir.path())
        .status();
    if drawn.is_ok_and(|s| s.success()) {
        let share = wrong(&source, &Picture::read(&at("pdf.png")), SCALE);
        println!("PDF: {:.3} % of the pixels differ", 100.0 * share);
        assert!(share < 0.01, "PDF: {share}");
    }
}
