//! Pictures of drawings and their differences.

use super::scale::{self, Scales};
use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp::map::{Map, NewtonInverse};
use pathwarp_raster::{ImageWarp, Pixmap, Size, compare, diff_image, render, shown, warp_image};
use pathwarp_svg::{Document, usvg_tree};
use resvg::tiny_skia::{Color, PixmapPaint, PremultipliedColorU8, Transform};
use std::path::Path;
use std::sync::Arc;
use usvg::Tree;

/// Pixels differ if a channel differs by more than this.
pub(super) const LEVELS: u8 = 16;
/// Extra scale of the picture that is bent, relative to its result.
const SHARPER: f64 = 2.0;

#[expect(clippy::cast_possible_truncation, reason = "the renderer's own precision")]
fn transform(m: Affine) -> Transform {
    let [a, b, c, d, e, f] = m.as_coeffs().map(|v| v as f32);
    Transform::from_row(a, b, c, d, e, f)
}

/// Draws the whole page.
#[expect(clippy::cast_possible_truncation, reason = "the renderer's own precision")]
pub(super) fn whole(tree: &Tree, scale: f64) -> Option<Pixmap> {
    render(tree, Size::Scale(scale as f32)).ok()
}

/// Two drawings that should look the same: `a` under an affine map of its px, and `b`.
pub(super) struct Pair<'a> {
    pub(super) a: &'a Tree,
    pub(super) moved: Affine,
    pub(super) b: &'a Tree,
}

impl Pair<'_> {
    /// Draws both as whole pictures.
    pub(super) fn pictures(&self, scales: &Scales) -> Option<(Pixmap, Pixmap)> {
        let drawn = scales.whole * f64::from(scales.oversampling);
        let b = whole(self.b, drawn)?;
        let mut a = Pixmap::new(b.width(), b.height())?;
        resvg::render(self.a, transform(Affine::scale(drawn) * self.moved), &mut a.as_mut());
        Some((reduced(&a, scales.oversampling)?, reduced(&b, scales.oversampling)?))
    }

    /// The share of pixels that differ, with a remark. If the whole picture is too small for the thinnest stroke, draws the
    /// places that differ most again at the scale they need.
    pub(super) fn share(&self, scales: &Scales) -> (f64, String) {
        let Some((a, b)) = self.pictures(scales) else { return (1.0, "no picture".into()) };
        let difference = match compare(&a, &b) {
            Ok(d) => d,
            Err(e) => return (1.0, e.to_string()),
        };
        let share = difference.share_over(LEVELS);
        let remark = format!("{:.2} % of pixels", 100.0 * share);
        if share == 0.0 || scales.whole == scales.needed {
            return (share, remark);
        }
        let closer = scales.needed / scales.whole;
        let windows = worst(&a, &b);
        let (mut off, mut of) = (0, 0);
        for at in &windows {
            let Some((a, b)) = self.window(*at, scales) else { continue };
            let Ok(d) = compare(&a, &b) else { continue };
            off += d.pixels_over(LEVELS);
            of += u64::from(d.width) * u64::from(d.height);
        }
        let near = off as f64 / (of as f64).max(1.0);
        (
            share.min(near),
            format!("{remark}, {:.2} % in the places that differ most, {closer:.0} times as large", 100.0 * near),
        )
    }

    /// Draws both around a point of the whole picture.
    fn window(&self, at: Point, scales: &Scales) -> Option<(Pixmap, Pixmap)> {
        const SIDE: u32 = 320;
        let half = f64::from(SIDE) / 2.0;
        let place = Affine::scale(f64::from(scales.oversampling))
            * Affine::translate((half, half))
            * Affine::scale(scales.needed / scales.whole)
            * Affine::translate(-at.to_vec2())
            * Affine::scale(scales.whole);
        let draw = |tree, m| {
            let mut out = Pixmap::new(SIDE * scales.oversampling, SIDE * scales.oversampling)?;
            resvg::render(tree, transform(m), &mut out.as_mut());
            reduced(&out, scales.oversampling)
        };
        Some((draw(self.a, place * self.moved)?, draw(self.b, place)?))
    }
}

/// Finds the places where two pictures differ most: the centroids of differing pixels in the blocks with most of them.
fn worst(a: &Pixmap, b: &Pixmap) -> Vec<Point> {
    const BLOCK: usize = 48;
    const MOST: usize = 12;
    let width = a.width() as usize;
    let columns = width.div_ceil(BLOCK);
    let mut blocks = vec![(0_u32, 0.0, 0.0); columns * (a.height() as usize).div_ceil(BLOCK)];
    for (i, (p, q)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        if (0..4).any(|c| channels(*p)[c].abs_diff(channels(*q)[c]) > LEVELS) {
            let (x, y) = (i % width, i / width);
            let block = &mut blocks[y / BLOCK * columns + x / BLOCK];
            *block = (block.0 + 1, block.1 + x as f64 + 0.5, block.2 + y as f64 + 0.5);
        }
    }
    blocks.sort_by_key(|b| std::cmp::Reverse(b.0));
    let full = blocks.into_iter().take(MOST).filter(|b| b.0 > 0);
    full.map(|(n, x, y)| Point::new(x / f64::from(n), y / f64::from(n))).collect()
}

fn channels(p: PremultipliedColorU8) -> [u8; 4] {
    [p.red(), p.green(), p.blue(), p.alpha()]
}

/// Draws the bent drawing, bends a picture of the drawing, and draws a mask that is solid where the image of the page is.
pub(super) fn bent(
    document: &Document,
    after: &Tree,
    map: &Arc<dyn Map>,
    scale: f64,
) -> Option<(Pixmap, Pixmap, Pixmap)> {
    /// Margin around the page in which the inverse is accepted: the pixels at its edges reach outside.
    const REACH: f64 = 0.02;
    let inverse = NewtonInverse::over(Arc::clone(map), document.view_box(), REACH);
    let to_user = document.user_to_px().inverse();
    let bend = |source: &Pixmap, source_scale: f64, scale: f64, size: (u32, u32)| {
        let pixels = Rect::new(0.0, 0.0, f64::from(size.0), f64::from(size.1));
        let warp = ImageWarp {
            source,
            placed: to_user * Affine::scale(1.0 / source_scale),
            map: &**map,
            inverse: &inverse,
            shown: to_user * Affine::scale(1.0 / scale) * shown(pixels, size),
            size,
        };
        warp_image(&warp).ok()
    };
    let n = scale::oversampling(document);
    let fine = f64::from(n) * scale;
    let ours = whole(after, fine)?;
    let size = (ours.width(), ours.height());
    let expected = bend(&whole(usvg_tree::tree(document), SHARPER * fine)?, SHARPER * fine, fine, size)?;
    let (ours, expected) = (reduced(&ours, n)?, reduced(&expected, n)?);
    let mut solid = whole(usvg_tree::tree(document), scale)?;
    solid.fill(Color::BLACK);
    let inside = bend(&solid, scale, scale, (ours.width(), ours.height()))?;
    Some((ours, expected, inside))
}

/// Averages blocks of `n` by `n` pixels into one.
fn reduced(p: &Pixmap, n: u32) -> Option<Pixmap> {
    if n == 1 {
        return Some(p.clone());
    }
    let mut out = Pixmap::new((p.width() / n).max(1), (p.height() / n).max(1))?;
    let (width, from) = (out.width(), p.width());
    for (i, to) in (0_u32..).zip(out.pixels_mut()) {
        let (x, y) = (i % width * n, i / width * n);
        let mut sum = [0_u32; 4];
        let cells = (0..n).flat_map(|j| (0..n).map(move |k| ((y + j) * from + x + k) as usize));
        for c in cells.filter_map(|k| p.pixels().get(k)).map(|c| channels(*c)) {
            for (s, v) in sum.iter_mut().zip(c) {
                *s += u32::from(v);
            }
        }
        let [r, g, b, a] = sum.map(|s| u8::try_from((s + n * n / 2) / (n * n)).unwrap_or(u8::MAX));
        *to = PremultipliedColorU8::from_rgba(r.min(a), g.min(a), b.min(a), a)?;
    }
    Some(out)
}

/// The mean difference over pixels that lie wholly on the page and where either picture shows something.
pub(super) fn mean_inside(a: &Pixmap, b: &Pixmap, inside: &Pixmap) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for ((a, b), inside) in a.pixels().iter().zip(b.pixels()).zip(inside.pixels()) {
        if inside.alpha() == u8::MAX && (a.alpha() > 0 || b.alpha() > 0) {
            let pairs = channels(*a).into_iter().zip(channels(*b));
            sum += pairs.map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>();
            count += 4.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// Writes two pictures and their difference side by side on white.
pub(super) fn side_by_side(a: &Pixmap, b: &Pixmap, file: &Path) {
    let draw = || {
        let third = a.width() + 4;
        let mut out = Pixmap::new(third * 3, a.height())?;
        out.fill(Color::WHITE);
        let difference = diff_image(a, b).ok()?;
        for (i, p) in [(0, a), (1, b), (2, &difference)] {
            let x = i32::try_from(third * i).ok()?;
            out.draw_pixmap(x, 0, p.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
        }
        out.save_png(file).ok()
    };
    // The picture is for inspection only; ignore a failure to write it.
    let _ = draw();
}
