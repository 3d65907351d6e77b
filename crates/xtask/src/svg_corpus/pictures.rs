//! Pictures of drawings, and how far they differ.

use super::checks::LEVELS;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, BezPath, Point, Rect, Shape as _};
use pathwarp::map::{Map, NewtonInverse};
use pathwarp::param::{Args, Frame};
use pathwarp_raster::{ImageWarp, Pixmap, Size, compare, diff_image, render, shown, warp_image};
use pathwarp_svg::Document;
use resvg::tiny_skia::{Color, PixmapPaint, PremultipliedColorU8, Transform};
use std::path::Path;
use std::sync::Arc;
use usvg::Tree;

/// Side of the largest picture of a whole drawing, pixels as drawn.
const LARGE: f64 = 2400.0;
/// The width that a stroke must have, pixels as drawn, to be drawn by the area it covers; thinner ones are paled.
const WIDE: f64 = 1.1;
/// The smallest stretch of the affine map, a little less.
const SQUEEZE: f64 = 0.6;
/// How many times as large pictures are drawn before their pixels are averaged. The renderer cuts a pixel's edge into four and
/// draws a stroke's edge to a quarter of a pixel, so that edges in the same place may differ by a fifth of all levels.
const FINER: u32 = 3;
/// The same for pictures that must agree pixel by pixel. A circle's edge drawn without smoothing, and the corners of dashes, which
/// the renderer draws to a quarter of a pixel as well, are averaged to within a few levels then.
const FINEST: u32 = 8;
/// How much larger still is the picture that is bent.
const SHARPER: f64 = 2.0;

/// Scales, pixels per px.
pub(super) struct Fine {
    /// Of the whole picture.
    pub(super) whole: f64,
    /// At which the thinnest stroke is wide enough.
    pub(super) needed: f64,
    /// How many times as large they are drawn.
    pub(super) n: u32,
}

/// The scales for a drawing that is at least drawn at `least`.
pub(super) fn fine(document: &Document, least: f64) -> Fine {
    /// Beyond this magnification f32 shows its grain.
    const MOST: f64 = 400.0;
    let size = document.size_px();
    let n = finest(document);
    let largest = LARGE / f64::from(n) / size.width.max(size.height);
    let thinnest = thinnest(document.tree().root()).unwrap_or(f64::INFINITY);
    let needed = (WIDE / (SQUEEZE * thinnest) / f64::from(n)).max(least);
    Fine { whole: needed.min(largest), needed: needed.min(MOST * largest), n }
}

/// The width of the thinnest stroke, px.
fn thinnest(group: &usvg::Group) -> Option<f64> {
    let of = |node: &usvg::Node| match node {
        usvg::Node::Group(g) => thinnest(g),
        usvg::Node::Text(t) => thinnest(t.flattened()),
        usvg::Node::Path(p) => p.stroke().map(|s| {
            let (x, y) = p.abs_transform().get_scale();
            f64::from(s.width().get() * x.min(y))
        }),
        usvg::Node::Image(_) => None,
    };
    group.children().iter().filter_map(of).filter(|w| *w > 0.0).min_by(f64::total_cmp)
}

#[expect(clippy::cast_possible_truncation, reason = "the renderer's own precision")]
fn transform(m: Affine) -> Transform {
    let [a, b, c, d, e, f] = m.as_coeffs().map(|v| v as f32);
    Transform::from_row(a, b, c, d, e, f)
}

/// How many times as large pictures of a bent drawing are drawn. Filters take too long on large ones.
pub(super) fn finer(document: &Document) -> u32 {
    if document.tree().filters().is_empty() { FINER } else { 1 }
}

/// How many times as large pictures under the affine map are drawn.
fn finest(document: &Document) -> u32 {
    if document.tree().filters().is_empty() { FINEST } else { FINER }
}

/// The whole page.
#[expect(clippy::cast_possible_truncation, reason = "the renderer's own precision")]
pub(super) fn whole(tree: &Tree, scale: f64) -> Option<Pixmap> {
    render(tree, Size::Scale(scale as f32)).ok()
}

/// Two drawings that should look the same: `a` moved by an affine map of its px, and `b`.
pub(super) struct Pair<'a> {
    pub(super) a: &'a Tree,
    pub(super) moved: Affine,
    pub(super) b: &'a Tree,
}

impl Pair<'_> {
    /// Both, whole.
    pub(super) fn pictures(&self, fine: &Fine) -> Option<(Pixmap, Pixmap)> {
        let drawn = fine.whole * f64::from(fine.n);
        let b = whole(self.b, drawn)?;
        let mut a = Pixmap::new(b.width(), b.height())?;
        resvg::render(self.a, transform(Affine::scale(drawn) * self.moved), &mut a.as_mut());
        Some((smaller(&a, fine.n)?, smaller(&b, fine.n)?))
    }

    /// The share of pixels that differ. Where the whole picture is too small for the thinnest stroke, the places where it
    /// differs most are looked at again, as large as needed.
    pub(super) fn share(&self, fine: &Fine) -> (f64, String) {
        let Some((a, b)) = self.pictures(fine) else { return (1.0, "no picture".into()) };
        let difference = match compare(&a, &b) {
            Ok(d) => d,
            Err(e) => return (1.0, e.to_string()),
        };
        let share = difference.share_over(LEVELS);
        let word = format!("{:.2} % of pixels", 100.0 * share);
        if share == 0.0 || fine.whole == fine.needed {
            return (share, word);
        }
        let closer = fine.needed / fine.whole;
        let windows = worst(&a, &b);
        let (mut off, mut of) = (0, 0);
        for at in &windows {
            let Some((a, b)) = self.window(*at, fine) else { continue };
            let Ok(d) = compare(&a, &b) else { continue };
            off += d.pixels_over(LEVELS);
            of += u64::from(d.width) * u64::from(d.height);
        }
        let near = off as f64 / (of as f64).max(1.0);
        (share.min(near), format!("{word}, {:.2} % where they differ most at {closer:.0} times the size", 100.0 * near))
    }

    /// Both as they look around a place of the whole picture.
    fn window(&self, at: Point, fine: &Fine) -> Option<(Pixmap, Pixmap)> {
        const SIDE: u32 = 320;
        let half = f64::from(SIDE) / 2.0;
        let place = Affine::scale(f64::from(fine.n))
            * Affine::translate((half, half))
            * Affine::scale(fine.needed / fine.whole)
            * Affine::translate(-at.to_vec2())
            * Affine::scale(fine.whole);
        let draw = |tree, m| {
            let mut out = Pixmap::new(SIDE * fine.n, SIDE * fine.n)?;
            resvg::render(tree, transform(m), &mut out.as_mut());
            smaller(&out, fine.n)
        };
        Some((draw(self.a, place * self.moved)?, draw(self.b, place)?))
    }
}

/// The places where two pictures differ most: the middles of the differing pixels of the blocks that have most of them.
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

/// A shaper whose sides all swing by a fifth of the page.
pub(super) fn shaper(page: Rect) -> Option<Arc<dyn Map>> {
    const CAGE: &str = "M0.04,0.92 C0.3,0.7 0.6,1.12 0.95,0.84 C1.12,0.6 0.82,0.36 0.96,0.1 C0.7,-0.04 0.34,0.26 0.06,0.08 \
                        C-0.08,0.36 0.2,0.66 0.04,0.92 Z";
    let mut cage = BezPath::from_svg(CAGE).ok()?;
    cage.apply_affine(
        Affine::translate(page.origin().to_vec2()) * Affine::scale_non_uniform(page.width(), page.height()),
    );
    debug_assert!(cage.bounding_box().area() > 0.0);
    let args = Args::from_pairs(&[("shaper", &cage.to_svg())]);
    Some(Registry::builtin().get("shaper")?.build_from(&args, &Frame::new(page)).ok()?.map)
}

/// The bent drawing's picture, the drawing's picture bent, and one that is solid where the page's image is.
pub(super) fn bent(
    document: &Document,
    after: &Tree,
    map: &Arc<dyn Map>,
    scale: f64,
) -> Option<(Pixmap, Pixmap, Pixmap)> {
    /// How far beyond the page answers count: its pixels' edges.
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
    let n = finer(document);
    let fine = f64::from(n) * scale;
    let ours = whole(after, fine)?;
    let size = (ours.width(), ours.height());
    let expected = bend(&whole(document.tree(), SHARPER * fine)?, SHARPER * fine, fine, size)?;
    let (ours, expected) = (smaller(&ours, n)?, smaller(&expected, n)?);
    let mut solid = whole(document.tree(), scale)?;
    solid.fill(Color::BLACK);
    let inside = bend(&solid, scale, scale, (ours.width(), ours.height()))?;
    Some((ours, expected, inside))
}

/// Every so many pixels, along either side, averaged into one.
fn smaller(p: &Pixmap, n: u32) -> Option<Pixmap> {
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

/// The mean difference over the artwork: where either picture shows anything, and all of the pixel comes from the page.
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

/// Writes two pictures and their difference on white.
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
    // Only for looking at; the figures do not depend on it.
    let _ = draw();
}
