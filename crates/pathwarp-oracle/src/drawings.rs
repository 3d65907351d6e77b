//! Helpers for the tests: affine maps that are treated as nonlinear, drawings as text, and comparison of renderings.

use crate::pictures::difference;
use kurbo::{Affine, Point, Vec2};
use pathwarp::map::{Formula, Real};
use pathwarp::refit;
use pathwarp_svg::usvg_tree::{self, parse_tree};
use pathwarp_svg::{Document, ReadOptions, WarpOptions, WarpedDocument};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::Tree;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

/// An affine map that does not report its class, and is therefore treated like any smooth map.
pub struct Hidden(pub Affine);

impl Formula for Hidden {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let [a, b, c, d, e, f] = self.0.as_coeffs();
        (x * a + y * c + e, x * b + y * d + f)
    }
}

/// A curved map of the square from 0 to 100.
pub struct Bend;

impl Formula for Bend {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x + (y / 30.0).sin() * 6.0, y + (x / 25.0).sin() * 8.0)
    }
}

/// Rotation, skew and two scales about the centre of the square.
pub fn oblique() -> Affine {
    Affine::translate((50.0, 50.0))
        * Affine::new([0.80, 0.15, -0.22, 0.62, 0.0, 0.0])
        * Affine::translate((-50.0, -50.0))
}

/// Options for reading without the machine's fonts.
pub fn options() -> ReadOptions {
    ReadOptions::default().with_system_fonts(false)
}

/// Makes a drawing of the square with the given content.
pub fn drawing(body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 100 100\">{body}</svg>"
    )
}

/// Reads a drawing.
pub fn read(svg: &str) -> Document {
    Document::read(svg.as_bytes(), "test.svg", &options()).unwrap()
}

/// A fine tolerance, with the nodes of the source.
pub fn warp_options() -> WarpOptions {
    WarpOptions::new(refit::Options::new(1e-4).with_nodes(refit::Nodes::Source))
}

/// Warps a drawing by a hidden affine map.
pub fn warp(svg: &str, map: Affine) -> WarpedDocument {
    read(svg).warp(&Hidden(map), &warp_options()).unwrap()
}

/// Renders a drawing, transformed, in a square of `size` pixels.
pub fn rendered(tree: &Tree, size: u32, t: Affine) -> Pixmap {
    let mut out = Pixmap::new(size, size).unwrap();
    let [a, b, c, d, e, f] = t.as_coeffs().map(|v| v as f32);
    resvg::render(tree, Transform::from_row(a, b, c, d, e, f), &mut out.as_mut());
    out
}

/// Renders at four times the size and averages. The renderer's antialiasing has few levels, and an edge on the border of
/// two levels flips between them at the slightest change (the renderer's arcs are correct to a tenth of a unit).
fn picture(tree: &Tree, size: u32, t: Affine) -> Pixmap {
    const OVER: usize = 4;
    let large = rendered(tree, size * OVER as u32, Affine::scale(OVER as f64) * t);
    let mut out = Pixmap::new(size, size).unwrap();
    let bytes = 4 * size as usize;
    for (row, lines) in out.data_mut().chunks_exact_mut(bytes).zip(large.data().chunks_exact(OVER * OVER * bytes)) {
        let mut sums = vec![0u32; bytes];
        for line in lines.chunks_exact(OVER * bytes) {
            for (sum, pixels) in sums.chunks_exact_mut(4).zip(line.chunks_exact(4 * OVER)) {
                pixels.iter().enumerate().for_each(|(i, v)| sum[i % 4] += u32::from(*v));
            }
        }
        row.iter_mut().zip(sums).for_each(|(v, sum)| *v = (sum / (OVER * OVER) as u32) as u8);
    }
    out
}

/// A pixel differs if a channel is off by more than this.
const VISIBLE: u8 = 16;

/// Asserts that at most a thousandth of the pixels differ.
pub fn alike(what: &str, expected: &Pixmap, found: &Pixmap) {
    let d = difference(expected, found);
    assert!(d.painted > 0.0, "{what}: nothing to compare");
    assert!(d.share(VISIBLE) <= 0.001, "{what}: {:.3} % of pixels differ", d.share(VISIBLE) * 100.0);
}

/// Warps `svg` by a hidden affine map and compares with the original as the renderer transforms it.
pub fn check(what: &str, svg: &str, map: Affine, options: &WarpOptions) -> WarpedDocument {
    const SIZE: u32 = 300;
    let document = read(svg);
    let warped = document.warp(&Hidden(map), options).unwrap();
    let scale = Affine::scale(f64::from(SIZE) / document.size_px().width);
    let px = document.user_to_px();
    let expected = picture(usvg_tree::tree(&document), SIZE, scale * px * map * px.inverse());
    let tree = parse_tree(warped.svg.as_bytes(), what, &self::options()).unwrap();
    let found = picture(&tree, SIZE, scale);
    alike(&format!("{what}\n{}", warped.svg), &expected, &found);
    warped
}

/// Pixels per unit of an original that is bent pixel by pixel.
pub const FINE: u32 = 16;

/// Difference between a drawing warped by [`Bend`] and its rendering bent pixel by pixel.
#[derive(Debug, Clone, Copy)]
pub struct Gap {
    /// Mean difference of channels, of 255, over all pixels with any paint.
    pub mean: f64,
    /// Fraction of the pixels with any paint that differ by more than 16 of 255.
    pub share: f64,
}

/// Warps `svg` by [`Bend`] and compares the result with the original bent pixel by pixel.
pub fn curved(svg: &str, options: &WarpOptions) -> (WarpedDocument, Gap) {
    let warped = read(svg).warp(&Bend, options).unwrap();
    let gap = gap(svg, &warped.svg);
    (warped, gap)
}

/// Pixels per unit of the comparison.
const SCALE: u32 = 4;
/// Samples per pixel of the comparison, across and down.
const OVER: u32 = 4;
/// The visible area: its corner and its size in units.
const FROM: f64 = -20.0;
const SIDE: u32 = 140;

/// The points whose images under [`Bend`] are the samples of the comparison, pixel by pixel. The inverse is a fixed-point iteration, which
/// contracts by 0.2 · 0.32.
fn sources() -> &'static [Point] {
    static ALL: OnceLock<Vec<Point>> = OnceLock::new();
    ALL.get_or_init(|| {
        let width = SIDE * SCALE;
        let samples = (0..width.pow(2) * OVER * OVER).map(|n| {
            let (pixel, k) = (n / (OVER * OVER), n % (OVER * OVER));
            let coordinate =
                |c: u32, k: u32| FROM + (f64::from(c) + (f64::from(k) + 0.5) / f64::from(OVER)) / f64::from(SCALE);
            let q = Point::new(coordinate(pixel % width, k % OVER), coordinate(pixel / width, k / OVER));
            let mut p = q;
            for _ in 0..4 {
                p.x = q.x - (p.y / 30.0).sin() * 6.0;
                p.y = q.y - (p.x / 25.0).sin() * 8.0;
            }
            p
        });
        samples.collect()
    })
}

/// A drawing's picture bent by [`Bend`]: its rendering at four times the resolution, sampled through the inverse map. (The renderer
/// rounds a pattern's tile to whole pixels, which moves the tiles apart. Tiles must therefore be whole at [`FINE`] pixels per unit.)
fn warped_picture(svg: &str) -> Arc<Pixmap> {
    static KNOWN: Mutex<BTreeMap<String, Arc<Pixmap>>> = Mutex::new(BTreeMap::new());
    if let Some(known) = KNOWN.lock().unwrap().get(svg) {
        return Arc::clone(known);
    }
    let document = read(svg);
    let original = rendered(usvg_tree::tree(&document), SIDE * FINE, window(FINE) * document.user_to_px().inverse());
    let (width, data) = ((SIDE * FINE) as usize, original.data());
    // The bilinear interpolation of the four pixels about a point.
    let color = |p: Point| {
        let q = window(FINE) * p - Vec2::new(0.5, 0.5);
        let [x, y] = [q.x, q.y].map(|v| v.clamp(0.0, width as f64 - 1.001));
        let (i, j) = (x as usize, y as usize);
        let [u, v] = [x - i as f64, y - j as f64].map(|v| v as f32);
        let [above, below] = [j, j + 1].map(|j| &data[(j * width + i) * 4..][..8]);
        let mix = |a: u8, b: u8, t: f32| f32::from(a) + (f32::from(b) - f32::from(a)) * t;
        [0, 1, 2, 3].map(|k| {
            let [a, b] = [mix(above[k], above[k + 4], u), mix(below[k], below[k + 4], u)];
            a + (b - a) * v
        })
    };
    let mut out = Pixmap::new(SIDE * SCALE, SIDE * SCALE).unwrap();
    for (samples, out) in sources().chunks((OVER * OVER) as usize).zip(out.data_mut().chunks_exact_mut(4)) {
        let mut sums = [0.0; 4];
        for p in samples {
            sums.iter_mut().zip(color(*p)).for_each(|(sum, c)| *sum += c);
        }
        out.iter_mut().zip(sums).for_each(|(out, sum)| *out = (sum / (OVER * OVER) as f32).round() as u8);
    }
    let out = Arc::new(out);
    KNOWN.lock().unwrap().insert(svg.to_owned(), Arc::clone(&out));
    out
}

/// Maps the units of a drawing to pixels of its visible area.
fn window(scale: u32) -> Affine {
    Affine::scale(f64::from(scale)) * Affine::translate((-FROM, -FROM))
}

/// Compares a drawing warped by [`Bend`] with the picture of the original, bent.
pub fn gap(svg: &str, warped: &str) -> Gap {
    let tree = parse_tree(warped.as_bytes(), "warped", &options()).unwrap();
    let found = picture(&tree, SIDE * SCALE, window(SCALE) * read(svg).user_to_px().inverse());
    let d = difference(&warped_picture(svg), &found);
    assert!(d.painted * f64::from((SIDE * SCALE).pow(2)) > 1000.0, "nothing to compare");
    Gap { mean: d.mean / d.painted, share: d.share(VISIBLE) / d.painted }
}

/// Asserts that two drawings look the same.
pub fn same(what: &str, a: &str, b: &str) {
    const SIZE: u32 = 300;
    let pictures = [a, b].map(|svg| {
        let tree = parse_tree(svg.as_bytes(), what, &options()).unwrap();
        picture(&tree, SIZE, Affine::scale(f64::from(SIZE) / f64::from(tree.size().width())))
    });
    alike(&format!("{what}\n{a}"), &pictures[0], &pictures[1]);
}
