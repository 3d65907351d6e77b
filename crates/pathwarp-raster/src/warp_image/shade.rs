//! Warps a paint: every pixel of the result asks the inverse map for its place in the paint, and the paint for its colour.

use super::area::{PixelArea, SMALLEST, TILE};
use super::trace::ChebyshevBasis;
use crate::error::Error;
use crate::parallel::for_each_chunk_pair;
use crate::pixmap::new_pixmap;
use kurbo::{Affine, Point};
use pathwarp::budget::Limits;
use pathwarp::map::Map;
use tiny_skia::{ColorU8, Pixmap, PremultipliedColorU8};

/// Number of pixels by which colours extend beyond the domain of the inverse: the reach of antialiasing and of a renderer's
/// interpolation.
const BLEED: usize = 4;

/// A paint, a map, and the part of the plane that the result shows.
#[derive(Clone, Copy)]
pub struct Shade<'a> {
    /// The colour at a point of the paint's coordinates: red, green, blue and alpha, 0 to 1, not premultiplied.
    pub color: &'a (dyn Fn(Point) -> [f64; 4] + Sync),
    /// Placement of the paint: maps its coordinates to the plane.
    pub placed: Affine,
    /// The inverse of the map; values that are not finite mark points outside its image.
    pub inverse: &'a dyn Map,
    /// The view of the result: maps its pixels (the box 0, 0, width, height) to the plane.
    pub shown: Affine,
    /// Width and height of the result in pixels.
    pub size: (u32, u32),
}

/// Warps a paint.
///
/// # Errors
/// [`Error::Empty`] and [`Error::TooLarge`] for impossible sizes of the result.
pub fn shade(shade: &Shade<'_>) -> Result<Pixmap, Error> {
    let (width, height) = shade.size;
    let mut out = new_pixmap(f64::from(width), f64::from(height), &Limits::default())?;
    // In this unit the tolerance of a trace is a fraction of a pixel, unless the map compresses.
    let unit = shade.shown.determinant().abs().sqrt();
    let painter = ShadePainter { shade, basis: ChebyshevBasis::new(), to_pixels: Affine::scale(1.0 / unit) };
    let columns = width as usize;
    let mut known = vec![false; columns * height as usize];
    for_each_chunk_pair(out.pixels_mut(), &mut known, columns * TILE, |band, pixels, known| {
        let mut band = ShadeBand { top: band * TILE, columns, pixels, known };
        let height = band.pixels.len() / columns;
        let top = band.top;
        for left in (0..columns).step_by(TILE) {
            painter.tile(&mut band, PixelArea { left, top, width: TILE.min(columns - left), height });
        }
    });
    if known.contains(&false) {
        extend(&mut out, &mut known);
    }
    Ok(out)
}

/// A band of whole rows of the result.
struct ShadeBand<'a> {
    top: usize,
    columns: usize,
    pixels: &'a mut [PremultipliedColorU8],
    known: &'a mut [bool],
}

/// The data shared by all tiles.
struct ShadePainter<'a> {
    shade: &'a Shade<'a>,
    basis: ChebyshevBasis,
    to_pixels: Affine,
}

impl ShadePainter<'_> {
    /// Paints a tile, dividing it until the inverse is close to a cubic.
    fn tile(&self, band: &mut ShadeBand<'_>, area: PixelArea) {
        match area.trace(&self.basis, self.shade.shown, self.shade.inverse, self.to_pixels) {
            Some(trace) => self.paint(band, area, |i, j| trace.pixel(i, j).p),
            None if area.width.max(area.height) > SMALLEST => {
                area.quarters().for_each(|quarter| self.tile(band, quarter));
            }
            None => self.paint(band, area, |i, j| {
                let at = Point::new((area.left + i) as f64 + 0.5, (area.top + j) as f64 + 0.5);
                self.to_pixels * self.shade.inverse.point(self.shade.shown * at)
            }),
        }
    }

    fn paint(&self, band: &mut ShadeBand<'_>, area: PixelArea, from: impl Fn(usize, usize) -> Point) {
        let to_paint = self.shade.placed.inverse() * self.to_pixels.inverse();
        for j in 0..area.height {
            let start = (area.top - band.top + j) * band.columns + area.left;
            for i in 0..area.width {
                let place = to_paint * from(i, j);
                if place.is_finite() {
                    let [r, g, b, a] = (self.shade.color)(place).map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
                    band.pixels[start + i] = ColorU8::from_rgba(r, g, b, a).premultiply();
                    band.known[start + i] = true;
                }
            }
        }
    }
}

/// Gives pixels without an inverse the colour of a neighbour, so that a clip along the edge shows no gap.
fn extend(out: &mut Pixmap, known: &mut [bool]) {
    let (width, height) = (out.width() as usize, out.height() as usize);
    for _ in 0..BLEED {
        let before = known.to_vec();
        let pixels = out.pixels_mut();
        for at in (0..width * height).filter(|at| !before[*at]) {
            let (i, j) = (at % width, at / width);
            let beside = [
                (i > 0).then(|| at - 1),
                (i + 1 < width).then(|| at + 1),
                (j > 0).then(|| at - width),
                (j + 1 < height).then(|| at + width),
            ];
            if let Some(from) = beside.into_iter().flatten().find(|from| before[*from]) {
                pixels[at] = pixels[from];
                known[at] = true;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::map::{Formula, Real};

    /// A curved inverse map that is undefined for x < 3.
    struct PartialInverse;

    impl Formula for PartialInverse {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            let domain = if x.value() < 3.0 { f64::NAN } else { 1.0 };
            (x * domain + (y / 9.0).sin() * 2.0, y + (x / 7.0).cos())
        }
    }

    #[test]
    fn pixels_have_the_colour_of_their_source() {
        let placed = Affine::new([2.0, 0.1, -0.3, 1.5, 4.0, -2.0]);
        let color = |p: Point| {
            [(p.x / 20.0).sin().abs(), (p.y / 10.0).fract().abs(), 0.5, 0.25 + 0.5 * (p.x / 9.0).cos().abs()]
        };
        let shown = Affine::new([0.2, 0.0, 0.0, 0.25, 1.0, -3.0]);
        let picture =
            shade(&Shade { color: &color, placed, inverse: &PartialInverse, shown, size: (150, 90) }).unwrap();
        let mut undefined = 0;
        for (at, found) in picture.pixels().iter().enumerate() {
            let p = shown * Point::new((at % 150) as f64 + 0.5, (at / 150) as f64 + 0.5);
            if p.x < 3.0 {
                undefined += 1;
                // The colour extends by four pixels and no further.
                assert_eq!(found.alpha() > 0, p.x > 3.0 - 4.0 * 0.2, "{p:?}");
                continue;
            }
            let from = Point::new(p.x + (p.y / 9.0).sin() * 2.0, p.y + (p.x / 7.0).cos());
            let [r, g, b, a] = color(placed.inverse() * from);
            let found = [found.red(), found.green(), found.blue(), found.alpha()].map(f64::from);
            for (k, (w, f)) in [r * a, g * a, b * a, a].into_iter().zip(found).enumerate() {
                // The second channel jumps, and an error of a thousandth of a pixel may cross the jump.
                assert!(
                    (w * 255.0 - f).abs() <= 1.6 || k == 1 && (from.y * 1e3).fract() < 2.0,
                    "{k} at {p:?}: {w} {f}"
                );
            }
        }
        assert!(undefined > 500);
    }
}
