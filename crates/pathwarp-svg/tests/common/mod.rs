//! What the tests share: maps that look nonlinear and are not, drawings as text, and pictures to compare.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use pathwarp::kurbo::Affine;
use pathwarp::map::{Formula, Real};
use pathwarp::refit;
use pathwarp_svg::{Document, ReadOptions, WarpOptions, Warped, parse_tree};
use resvg::tiny_skia::{Pixmap, Transform};

/// An affine map that does not say it is one, and so takes the way of any smooth map.
pub struct Hidden(pub Affine);

impl Formula for Hidden {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let [a, b, c, d, e, f] = self.0.as_coeffs();
        (x * a + y * c + e, x * b + y * d + f)
    }
}

/// Something curved over the unit-hundred square.
pub struct Bend;

impl Formula for Bend {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x + (y / 30.0).sin() * 6.0, y + (x / 25.0).sin() * 8.0)
    }
}

/// Rotation, skew and two scales about the middle of a hundred square.
pub fn oblique() -> Affine {
    Affine::translate((50.0, 50.0))
        * Affine::new([0.80, 0.15, -0.22, 0.62, 0.0, 0.0])
        * Affine::translate((-50.0, -50.0))
}

pub fn options() -> ReadOptions {
    ReadOptions { system_fonts: false, ..ReadOptions::default() }
}

/// A hundred square with this in it.
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

pub fn warp(svg: &str, map: Affine) -> Warped {
    read(svg).warp(&Hidden(map), &warp_options()).unwrap()
}

/// Drawn four times as large and averaged: the renderer's own edges come in four shades only, and an edge that lies on the
/// border of two flips between them at a hair's breadth (the renderer's arcs are good to a tenth of a unit).
fn picture(tree: &usvg::Tree, size: u32, t: Affine) -> Pixmap {
    const OVER: u32 = 4;
    let mut large = Pixmap::new(size * OVER, size * OVER).unwrap();
    let [a, b, c, d, e, f] = (Affine::scale(f64::from(OVER)) * t).as_coeffs().map(|v| v as f32);
    resvg::render(tree, Transform::from_row(a, b, c, d, e, f), &mut large.as_mut());
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

/// The share of pixels that differ by more than 16 of 255.
pub fn difference(a: &Pixmap, b: &Pixmap) -> f64 {
    let off = |p: &[u8], q: &[u8]| p.iter().zip(q).any(|(x, y)| x.abs_diff(*y) > 16);
    let n = a.data().chunks(4).zip(b.data().chunks(4)).filter(|(p, q)| off(p, q)).count();
    n as f64 / f64::from(a.width() * a.height())
}

/// Warps `svg` by a hidden affine map and compares with the renderer's own transform of the original.
pub fn check(what: &str, svg: &str, map: Affine, options: &WarpOptions) -> Warped {
    const SIZE: u32 = 300;
    let document = read(svg);
    let warped = document.warp(&Hidden(map), options).unwrap();
    let scale = Affine::scale(f64::from(SIZE) / document.size_px().width);
    let px = document.user_to_px();
    let expected = picture(document.tree(), SIZE, scale * px * map * px.inverse());
    let tree = parse_tree(warped.svg.as_bytes(), what, &self::options()).unwrap();
    let found = picture(&tree, SIZE, scale);
    assert!(expected.data().iter().any(|v| *v != 0), "{what}: nothing to compare");
    let share = difference(&expected, &found);
    assert!(share <= 0.001, "{what}: {:.3} % of pixels differ\n{}", share * 100.0, warped.svg);
    warped
}
