//! A paint bent by a map: every pixel of the result asks the inverse map where it comes from, and the paint what colour that
//! place has.

use super::trace::Basis;
use super::{Area, SMALLEST, TILE};
use crate::{Error, render::new_pixmap};
use kurbo::{Affine, Point};
use pathwarp::map::Map;
use rayon::prelude::*;
use tiny_skia::{ColorU8, Pixmap, PremultipliedColorU8};

/// Pixels by which colours go on beyond where the inverse says anything: as far as an edge's antialiasing and a renderer's
/// interpolation reach.
const BEYOND: usize = 4;

/// A paint, and onto what it goes.
#[derive(Clone, Copy)]
pub struct Shade<'a> {
    /// The colour of a place in the paint's own space: red, green, blue and alpha, 0 to 1, not premultiplied.
    pub color: &'a (dyn Fn(Point) -> [f64; 4] + Sync),
    /// Where the paint lies: from its space to the plane.
    pub placed: Affine,
    /// The inverse of the map of the plane; values that are not finite mean "from nowhere".
    pub inverse: &'a dyn Map,
    /// What the result shows: from its pixels (its box is 0, 0, width, height) to the plane.
    pub shown: Affine,
    /// The result's pixels.
    pub size: (u32, u32),
}

/// Paints the picture.
///
/// # Errors
/// [`Error::Empty`] and [`Error::TooLarge`] for impossible sizes of the result.
pub fn shade(shade: &Shade<'_>) -> Result<Pixmap, Error> {
    let (width, height) = shade.size;
    let mut out = new_pixmap(f64::from(width), f64::from(height))?;
    // In this unit a trace's tolerance is a part of a pixel, if the map does not squeeze.
    let unit = shade.shown.determinant().abs().sqrt();
    let painter = Painter { shade, basis: Basis::new(), to_pixels: Affine::scale(1.0 / unit) };
    let columns = width as usize;
    let mut known = vec![false; columns * height as usize];
    let rows = out.pixels_mut().par_chunks_mut(columns * TILE).zip(known.par_chunks_mut(columns * TILE));
    rows.enumerate().for_each(|(band, (pixels, known))| {
        let mut band = Band { top: band * TILE, columns, pixels, known };
        let height = band.pixels.len() / columns;
        let top = band.top;
        for left in (0..columns).step_by(TILE) {
            painter.tile(&mut band, Area { left, top, width: TILE.min(columns - left), height });
        }
    });
    if known.contains(&false) {
        go_on(&mut out, &mut known);
    }
    Ok(out)
}

/// Whole rows of the result.
struct Band<'a> {
    top: usize,
    columns: usize,
    pixels: &'a mut [PremultipliedColorU8],
    known: &'a mut [bool],
}

struct Painter<'a> {
    shade: &'a Shade<'a>,
    basis: Basis,
    to_pixels: Affine,
}

impl Painter<'_> {
    fn tile(&self, band: &mut Band<'_>, area: Area) {
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

    fn paint(&self, band: &mut Band<'_>, area: Area, from: impl Fn(usize, usize) -> Point) {
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

/// Pixels from nowhere take a neighbour's colour, so that no edge that cuts the picture to shape shows what lies beyond.
fn go_on(out: &mut Pixmap, known: &mut [bool]) {
    let (width, height) = (out.width() as usize, out.height() as usize);
    for _ in 0..BEYOND {
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

    /// x and y from the result's place: curved, and from nowhere left of x = 3.
    struct Back;

    impl Formula for Back {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            let nowhere = if x.value() < 3.0 { f64::NAN } else { 1.0 };
            (x * nowhere + (y / 9.0).sin() * 2.0, y + (x / 7.0).cos())
        }
    }

    #[test]
    fn colours_are_those_of_where_pixels_come_from() {
        let placed = Affine::new([2.0, 0.1, -0.3, 1.5, 4.0, -2.0]);
        let color = |p: Point| {
            [(p.x / 20.0).sin().abs(), (p.y / 10.0).fract().abs(), 0.5, 0.25 + 0.5 * (p.x / 9.0).cos().abs()]
        };
        let shown = Affine::new([0.2, 0.0, 0.0, 0.25, 1.0, -3.0]);
        let picture = shade(&Shade { color: &color, placed, inverse: &Back, shown, size: (150, 90) }).unwrap();
        let mut nowhere = 0;
        for (at, found) in picture.pixels().iter().enumerate() {
            let p = shown * Point::new((at % 150) as f64 + 0.5, (at / 150) as f64 + 0.5);
            if p.x < 3.0 {
                nowhere += 1;
                // Four more pixels, and nothing beyond.
                assert_eq!(found.alpha() > 0, p.x > 3.0 - 4.0 * 0.2, "{p:?}");
                continue;
            }
            let from = Point::new(p.x + (p.y / 9.0).sin() * 2.0, p.y + (p.x / 7.0).cos());
            let [r, g, b, a] = color(placed.inverse() * from);
            let found = [found.red(), found.green(), found.blue(), found.alpha()].map(f64::from);
            for (k, (w, f)) in [r * a, g * a, b * a, a].into_iter().zip(found).enumerate() {
                // The second channel leaps; a place a thousandth of a pixel off may fall on the other side.
                assert!(
                    (w * 255.0 - f).abs() <= 1.6 || k == 1 && (from.y * 1e3).fract() < 2.0,
                    "{k} at {p:?}: {w} {f}"
                );
            }
        }
        assert!(nowhere > 500);
    }
}
