//! Helpers for the tests: affine maps that are treated as nonlinear, drawings as text, and comparison of renderings.

use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::map::{Formula, Real};
use pathwarp::refit;
use pathwarp_svg::usvg_tree::{self, parse_tree};
use pathwarp_svg::{Document, ReadOptions, WarpOptions, WarpedDocument};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::Tree;
use std::sync::OnceLock;

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

pub fn options() -> ReadOptions {
    ReadOptions::default().with_system_fonts(false)
}

/// Makes a drawing of the square with the given content.
pub fn drawing(body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 100 100\">{body}</svg>"
    )
}

pub fn read(svg: &str) -> Document {
    Document::read(svg.as_bytes(), "test.svg", &options()).unwrap()
}

pub fn warp_options() -> WarpOptions {
    WarpOptions::new(refit::Options::new(1e-4))
}

pub fn warp(svg: &str, map: Affine) -> WarpedDocument {
    read(svg).warp(&Hidden(map), &warp_options()).unwrap()
}

pub fn rendered(tree: &Tree, size: u32, t: Affine) -> Pixmap {
    let mut out = Pixmap::new(size, size).unwrap();
    let [a, b, c, d, e, f] = t.as_coeffs().map(|v| v as f32);
    resvg::render(tree, Transform::from_row(a, b, c, d, e, f), &mut out.as_mut());
    out
}

/// Renders at four times the size and averages. The renderer's own antialiasing has few levels, and an edge on the border of
/// two levels flips between them at the slightest change (the renderer's arcs are correct to a tenth of a unit).
fn picture(tree: &Tree, size: u32, t: Affine) -> Pixmap {
    const OVER: u32 = 4;
    let large = rendered(tree, size * OVER, Affine::scale(f64::from(OVER)) * t);
    let mut out = Pixmap::new(size, size).unwrap();
    let (n, wide) = (size as usize, (size * OVER) as usize);
    for (i, v) in out.data_mut().iter_mut().enumerate() {
        let (x, y, k) = (i / 4 % n * OVER as usize, i / 4 / n * OVER as usize, i % 4);
        let over = 0..OVER as usize;
        let sum: u32 = over
            .clone()
            .flat_map(|dy| over.clone().map(move |dx| ((y + dy) * wide + x + dx) * 4 + k))
            .map(|at| u32::from(large.data()[at]))
            .sum();
        *v = (sum / (OVER * OVER)) as u8;
    }
    out
}

/// Fraction of pixels that differ by more than 16 of 255.
pub fn difference(a: &Pixmap, b: &Pixmap) -> f64 {
    let off = |p: &[u8], q: &[u8]| p.iter().zip(q).any(|(x, y)| x.abs_diff(*y) > 16);
    let n = a.data().chunks(4).zip(b.data().chunks(4)).filter(|(p, q)| off(p, q)).count();
    n as f64 / f64::from(a.width() * a.height())
}

/// Warps `svg` by a hidden affine map and compares with the renderer's own transform of the original.
pub fn check(what: &str, svg: &str, map: Affine, options: &WarpOptions) -> WarpedDocument {
    const SIZE: u32 = 300;
    let document = read(svg);
    let warped = document.warp(&Hidden(map), options).unwrap();
    let scale = Affine::scale(f64::from(SIZE) / document.size_px().width);
    let px = document.user_to_px();
    let expected = picture(usvg_tree::tree(&document), SIZE, scale * px * map * px.inverse());
    let tree = parse_tree(warped.svg.as_bytes(), what, &self::options()).unwrap();
    let found = picture(&tree, SIZE, scale);
    assert!(expected.data().iter().any(|v| *v != 0), "{what}: nothing to compare");
    let share = difference(&expected, &found);
    assert!(share <= 0.001, "{what}: {:.3} % of pixels differ\n{}", share * 100.0, warped.svg);
    warped
}

/// Pixels per unit of an original that is bent pixel by pixel.
pub const FINE: u32 = 16;

/// Difference between a drawing warped by [`Bend`] and its rendering bent pixel by pixel.
#[derive(Debug, Clone, Copy)]
pub struct Gap {
    /// Mean difference of channels, of 255, over all pixels with any paint.
    pub mean: f64,
    /// Fraction of these pixels that differ by more than 16 of 255.
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

/// The places whose images under [`Bend`] are the samples of the comparison, pixel by pixel. The inverse is a fixed-point
/// iteration, which contracts by 0.2 · 0.32.
fn sources() -> &'static [Point] {
    static ALL: OnceLock<Vec<Point>> = OnceLock::new();
    ALL.get_or_init(|| {
        let wide = SIDE * SCALE;
        let samples = (0..wide.pow(2) * OVER * OVER).map(|n| {
            let (pixel, k) = (n / (OVER * OVER), n % (OVER * OVER));
            let sub =
                |c: u32, k: u32| FROM + (f64::from(c) + (f64::from(k) + 0.5) / f64::from(OVER)) / f64::from(SCALE);
            let to = Point::new(sub(pixel % wide, k % OVER), sub(pixel / wide, k / OVER));
            let mut p = to;
            for _ in 0..12 {
                p = Point::new(to.x - (p.y / 30.0).sin() * 6.0, to.y - (p.x / 25.0).sin() * 8.0);
            }
            p
        });
        samples.collect()
    })
}

/// Compares a drawing warped by [`Bend`] with the original's rendering, sampled at four times the resolution through the
/// inverse map. (The renderer rounds a pattern's tile to whole pixels, which moves the tiles apart. Tiles must therefore be whole
/// at [`FINE`] pixels per unit here.)
pub fn gap(svg: &str, warped: &str) -> Gap {
    let document = read(svg);
    let window = |scale: u32| Affine::scale(f64::from(scale)) * Affine::translate((-FROM, -FROM));
    let px = document.user_to_px();
    let original = rendered(usvg_tree::tree(&document), SIDE * FINE, window(FINE) * px.inverse());
    let tree = parse_tree(warped.as_bytes(), "warped", &options()).unwrap();
    let found = picture(&tree, SIDE * SCALE, window(SCALE) * px.inverse());
    let wide = (SIDE * FINE) as usize;
    let data = original.data();
    let at = |p: Point| {
        let q = window(FINE) * p - Vec2::new(0.5, 0.5);
        let (i, j) = (q.x.floor().clamp(0.0, wide as f64 - 2.0), q.y.floor().clamp(0.0, wide as f64 - 2.0));
        let (u, v) = ((q.x - i).clamp(0.0, 1.0), (q.y - j).clamp(0.0, 1.0));
        let [above, below] = [j as usize, j as usize + 1].map(|j| &data[(j * wide + i as usize) * 4..][..8]);
        let row = |row: &[u8], k: usize| f64::from(row[k]) * (1.0 - u) + f64::from(row[k + 4]) * u;
        [0, 1, 2, 3].map(|k| row(above, k) * (1.0 - v) + row(below, k) * v)
    };
    let (mut sum, mut off, mut count) = (0.0, 0, 0);
    for (samples, found) in sources().chunks((OVER * OVER) as usize).zip(found.data().chunks(4)) {
        let mut wanted = [0.0; 4];
        for p in samples {
            for (w, c) in wanted.iter_mut().zip(at(*p)) {
                *w += c / f64::from(OVER * OVER);
            }
        }
        let differences = [0, 1, 2, 3].map(|k| (wanted[k] - f64::from(found[k])).abs());
        if wanted[3] > 0.0 || found[3] > 0 {
            sum += differences.iter().sum::<f64>() / 4.0;
            off += u32::from(differences.iter().any(|d| *d > 16.0));
            count += 1;
        }
    }
    assert!(count > 1000, "nothing to compare");
    Gap { mean: sum / f64::from(count), share: f64::from(off) / f64::from(count) }
}

/// Asserts that two drawings look the same.
pub fn same(what: &str, a: &str, b: &str) {
    const SIZE: u32 = 300;
    let pictures = [a, b].map(|svg| {
        let tree = parse_tree(svg.as_bytes(), what, &options()).unwrap();
        picture(&tree, SIZE, Affine::scale(f64::from(SIZE) / f64::from(tree.size().width())))
    });
    let share = difference(&pictures[0], &pictures[1]);
    assert!(share <= 0.001, "{what}: {:.3} % of pixels differ\n{a}", share * 100.0);
}
