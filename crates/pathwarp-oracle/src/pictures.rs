//! Differences of pictures.

use kurbo::Rect;
use resvg::tiny_skia::Pixmap;

/// The difference of two pictures of the same size, by premultiplied channels.
pub struct Difference {
    /// Mean over all channels of all pixels, of 255.
    pub mean: f64,
    /// The fraction of the pixels with any paint, in one picture or the other.
    pub painted: f64,
    /// The number of pixels for each value of the largest difference among their channels.
    pixels: [usize; 256],
}

impl Difference {
    /// The fraction of pixels with a channel that differs by more than `visible`.
    pub fn share(&self, visible: u8) -> f64 {
        let over: usize = self.pixels[usize::from(visible) + 1..].iter().sum();
        over as f64 / self.pixels.iter().sum::<usize>() as f64
    }

    /// The largest difference of a channel.
    pub fn most(&self) -> usize {
        self.pixels.iter().rposition(|n| *n > 0).unwrap_or_default()
    }
}

/// Compares two pictures.
pub fn difference(a: &Pixmap, b: &Pixmap) -> Difference {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()), "pictures of different sizes");
    let (mut pixels, mut sum, mut painted) = ([0; 256], 0, 0);
    for (p, q) in a.data().chunks_exact(4).zip(b.data().chunks_exact(4)) {
        let differences = [0, 1, 2, 3].map(|k| usize::from(p[k].abs_diff(q[k])));
        sum += differences.iter().sum::<usize>();
        pixels[differences.into_iter().fold(0, usize::max)] += 1;
        painted += usize::from(p[3] > 0 || q[3] > 0);
    }
    let all = a.pixels().len() as f64;
    Difference { mean: sum as f64 / (4.0 * all), painted: painted as f64 / all, pixels }
}

/// The box of the pixels that are painted with an alpha above `least`, and their number.
pub fn ink(picture: &Pixmap, least: u8) -> (Rect, usize) {
    let width = picture.width() as usize;
    let marked = picture.pixels().iter().enumerate().filter(|p| p.1.alpha() > least).map(|p| p.0);
    let pixels = marked.map(|i| (Rect::from_origin_size(((i % width) as f64, (i / width) as f64), (1.0, 1.0)), 1));
    pixels.reduce(|(a, n), (b, m)| (a.union(b), n + m)).unwrap_or_default()
}

/// The picture on white paper: transparent pixels have no colour.
pub fn on_white(mut picture: Pixmap) -> Pixmap {
    for p in picture.data_mut().chunks_exact_mut(4) {
        let rest = 255 - p[3];
        p.iter_mut().for_each(|c| *c = c.saturating_add(rest));
    }
    picture
}

/// The number of pixels that are painted in one picture and bare in the other, as are all their neighbours.
pub fn beyond_edges(a: &Pixmap, b: &Pixmap) -> usize {
    let (w, h) = (a.width() as usize, a.height() as usize);
    let is_painted = |p: &Pixmap, x: usize, y: usize| p.data()[4 * (y * w + x) + 3] > 127;
    // Painted or bare, with all neighbours.
    let is_inner = |p: &Pixmap, x: usize, y: usize| {
        (y - 1..=y + 1).all(|j| (x - 1..=x + 1).all(|i| is_painted(p, i, j) == is_painted(p, x, y)))
    };
    let differs =
        |x: usize, y: usize| is_painted(a, x, y) != is_painted(b, x, y) && is_inner(a, x, y) && is_inner(b, x, y);
    (1..h - 1).map(|y| (1..w - 1).filter(|x| differs(*x, y)).count()).sum()
}
