//! Bends bitmaps and gradients pixel by pixel, and encodes pictures as files.

use crate::failure::Failure;
use crate::format::Format;
use crate::{advice, edges, meter};
use pathwarp::budget::{Budget, Exceeded, Limit, Limits, cost};
use pathwarp::engine::{Batches, Cost};
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Jet, Map, NewtonInverse};
use pathwarp_raster::{
    Color, ImageWarp, IntRect, Picture, PictureFormat, Pixmap, SeenColor, ShadeTolerance, SmoothShade, encode_png,
    encode_smooth_png, enlarged, extent, header_size, shown, warp_image,
};
use pathwarp_svg::engine::{BentImage, GradientPainter, GradientRequest, ImageRequest, ImageWarper, PictureError};
use std::borrow::Cow;
use std::str::FromStr as _;
use std::sync::{Arc, OnceLock};

/// Pixels per inch of a drawing shown at 100 %.
pub(crate) const PX_PER_INCH: f64 = 96.0;

/// Evaluations of the map for one picture besides those for its pixels, which find its box; and for the resolution of one gradient.
const PICTURE_EVALUATIONS: f64 = 40e3;
const GRADIENT_EVALUATIONS: f64 = 24e3;

/// Pictures with at most this many pixels (QR codes, pixel art, swatches) are enlarged to the size of the result if their pixels are larger
/// than [`LARGE_PIXEL`], in px. Otherwise, their bent edges would be as coarse as their pixels.
const FEW_PIXELS: f64 = 65_536.0;
const LARGE_PIXEL: f64 = 2.0;
/// Most pixels of an enlarged picture.
const MOST_ENLARGED: f64 = 4e6;

/// Pixels of a gradient that are painted to find its resolution; the second number holds where no difference may be visible.
const SEARCH_PIXELS: f64 = 500.0;
const STRICT_SEARCH_PIXELS: f64 = 2000.0;

/// Bends the bitmaps and gradients of drawings by one map.
#[derive(Debug)]
pub struct Bender {
    pub(crate) map: Arc<dyn Map>,
    /// Pixels per inch; `None` keeps every detail.
    pub(crate) dpi: Option<f64>,
    pub(crate) budget: Arc<Budget>,
    /// The work that filters leave to everything else; set before the first of them is painted.
    pub(crate) filters_leave: OnceLock<f64>,
}

impl Bender {
    /// Creates a bender for `map` at `dpi` pixels per inch of the drawing; `None` keeps every detail.
    #[must_use]
    pub fn new(map: Arc<dyn Map>, dpi: Option<f64>) -> Self {
        Self { map, dpi, budget: Arc::default(), filters_leave: OnceLock::new() }
    }

    /// Sets limits on the bitmaps.
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Self {
        self.with_budget(Arc::new(Budget::new(limits)))
    }

    /// Returns the pixels per unit of a result of this size, in units, beyond which nobody sees a difference.
    pub(crate) fn seen_density(&self, px_per_unit: f64, (width, height): (f64, f64)) -> f64 {
        /// Pixels per px of the drawing in each direction: the resolution of a screen of twice the density.
        const DENSITY: f64 = 2.0;
        /// Pixels along the longer side of a small drawing, which is often shown enlarged.
        const LEAST: f64 = 256.0;
        match self.dpi {
            Some(dpi) => dpi / PX_PER_INCH * px_per_unit,
            None => (DENSITY * px_per_unit).max(LEAST / width.max(height)),
        }
    }

    /// Counts the work on all bitmaps in a budget.
    #[must_use]
    pub fn with_budget(self, budget: Arc<Budget>) -> Self {
        Self { budget, ..self }
    }
}

/// Returns the pixels that are shown of a picture of this size, with a margin of one, which interpolation needs.
fn shown_part((width, height): (u32, u32), crop: Option<Rect>) -> Option<IntRect> {
    let whole = Rect::new(0.0, 0.0, width.into(), height.into());
    let part = crop.map_or(whole, |c| c.inflate(1.0, 1.0).expand().intersect(whole));
    IntRect::from_xywh(part.x0 as i32, part.y0 as i32, part.width() as u32, part.height() as u32)
}

impl ImageWarper for Bender {
    fn warp(&self, r: &ImageRequest<'_>) -> Result<BentImage, PictureError> {
        /// Largest growth of the pixel count. Where the map compresses the image, keeping every detail takes more pixels.
        const GROWTH: f64 = 4.0;
        /// Largest pixel count: the file holds the pixels as text.
        const MOST: f64 = 16e6;
        count_evaluations(&self.budget, &*self.map, PICTURE_EVALUATIONS).map_err(too_much)?;
        let (width, height) = header_size(r.data).map_err(|e| e.to_string())?;
        count_pixels(&self.budget, Pixel::Decoded, f64::from(width) * f64::from(height)).map_err(too_much)?;
        let picture = Picture::read_sized_within(r.data, &self.budget.limits()).map_err(|e| e.to_string())?;
        let size = (picture.pixmap.width(), picture.pixmap.height());
        let part = shown_part(size, r.crop).ok_or("nothing of it is shown")?;
        let is_whole = (part.width(), part.height()) == size;
        let [x0, y0, x1, y1] = [part.left(), part.top(), part.right(), part.bottom()].map(f64::from);
        let area = Rect::new(x0, y0, x1, y1);
        let image = extent(area, r.placed, r.map, r.after).filter(|image| image.undefined.is_none());
        let image = image.ok_or("the map is undefined on part of it")?;
        let (width, height) = (image.bounds.width(), image.bounds.height());
        if !(width > 0.0 && height > 0.0) {
            return Err("its image has no area".into());
        }
        let most = (GROWTH * area.area()).clamp(1.0, MOST);
        let finest = |most: f64| (most / (width * height)).sqrt();
        let px_per_unit = (r.to_px * r.after.inverse()).determinant().abs().sqrt();
        let has_large_pixels = image.stretch * px_per_unit > if r.pixelated { 1.0 } else { LARGE_PIXEL };
        // Each pixel of the source becomes `factor` by `factor` pixels before it is bent.
        let factor = if has_large_pixels && (r.pixelated || area.area() <= FEW_PIXELS) {
            let most = (MOST_ENLARGED / area.area()).sqrt();
            (image.stretch * self.seen_density(px_per_unit, (width, height))).min(most).ceil().max(1.0)
        } else {
            1.0
        };
        let density = match self.dpi {
            Some(dpi) => (dpi / PX_PER_INCH * px_per_unit).min(finest(MOST)),
            None if factor > 1.0 => (factor / image.stretch).min(finest(MOST)),
            None => (1.0 / image.squeeze).min(finest(most)),
        };
        let pixels = |length: f64| (length * density - ROUNDING).ceil().clamp(1.0, MOST);
        let size = (pixels(width), pixels(height));
        count_picture(&self.budget, Pixel::Warped, size).map_err(too_much)?;
        let size = (size.0 as u32, size.1 as u32);
        let inverse = inverse(&self.map, r.placed.transform_rect_bbox(area), &self.budget);
        let (source, placed) = if factor == 1.0 && is_whole {
            (Cow::Borrowed(&picture.pixmap), r.placed)
        } else {
            let larger = enlarged(&picture.pixmap, part, factor as u32, r.pixelated, &self.budget.limits());
            let in_part = Affine::translate(area.origin().to_vec2()) * Affine::scale(1.0 / factor);
            (Cow::Owned(larger.map_err(|e| e.to_string())?), r.placed * in_part)
        };
        let warp = ImageWarp {
            source: &source,
            placed,
            map: r.map,
            inverse: &inverse,
            shown: r.after.inverse() * shown(image.bounds, size),
            size,
        };
        let mut pixmap = warp_image(&warp).map_err(|e| e.to_string())?;
        self.budget.exceeded().map_or(Ok(()), |e| Err(too_much(e)))?;
        if r.clipped {
            // The clip path follows the picture's edge, where pixels are partly transparent.
            let are_opaque: Vec<bool> = pixmap.pixels().iter().map(|p| p.alpha() == u8::MAX).collect();
            edges::continue_colors(&mut pixmap, &are_opaque);
        }
        let bent = picture.remade(pixmap, false);
        let lost = if Picture::is_of_inks(r.data) {
            Some("pictures in CMYK become RGB")
        } else {
            (picture.profile.is_some() && bent.profile.is_none())
                .then_some("pictures lose a colour profile that is not one for RGB")
        };
        let like = if r.clipped { r.data } else { &[] };
        Ok(BentImage { file: bent.write_like(like).map_err(|e| e.to_string())?, area: image.bounds, lost })
    }
}

/// Returns the error about a bitmap that takes too much work.
pub(crate) fn too_much(e: Exceeded) -> PictureError {
    format!("bending it takes {e}; {}", advice::raise(&e)).into()
}

impl GradientPainter for Bender {
    fn paint(&self, r: &GradientRequest<'_>) -> Result<BentImage, PictureError> {
        /// Most samples in a picture: the file holds them as text.
        const MOST: f64 = 2e6;
        /// Most samples in all pictures of a drawing.
        const MOST_TOGETHER: f64 = 64e6;
        let (width, height) = (r.target.width(), r.target.height());
        if !(width > 0.0 && height > 0.0 && (width + height).is_finite()) {
            return Err("the image of the shape has no area".into());
        }
        let px_per_unit = (r.to_px * r.after.inverse()).determinant().abs().sqrt();
        let finest = self.seen_density(px_per_unit, (width, height));
        let most = MOST.min(MOST_TOGETHER / r.among.max(1) as f64);
        let finest = finest.min((most / (width * height)).sqrt()).min(most / width.max(height));
        let seen: Vec<_> = r.seen.iter().map(|s| SeenColor { at: s.at, color: s.color }).collect();
        let shade = SmoothShade {
            colors: r.colors,
            source: r.area,
            placed: r.placed,
            map: r.map,
            after: r.after,
            target: r.target,
            shape: Some(r.shape),
            seen: if r.sharp { &[] } else { &seen },
            tolerance: if r.strict { ShadeTolerance::INVISIBLE } else { ShadeTolerance::UNNOTICED },
            coarsest: coarsest((width * px_per_unit, height * px_per_unit), r.among),
            finest,
        };
        count_evaluations(&self.budget, &*self.map, GRADIENT_EVALUATIONS).map_err(too_much)?;
        // The number of pixels is known only after painting. Nothing is painted once the limit is reached.
        let search = if r.strict { STRICT_SEARCH_PIXELS } else { SEARCH_PIXELS };
        count_pixels(&self.budget, Pixel::Shaded, search).map_err(too_much)?;
        let (pixmap, area) = shade.paint().map_err(|e| e.to_string())?;
        let pixels = f64::from(pixmap.width()) * f64::from(pixmap.height());
        count_pixels(&self.budget, Pixel::Shaded, pixels).map_err(too_much)?;
        Ok(BentImage::new(encode_smooth_png(&pixmap).map_err(|e| e.to_string())?, area))
    }
}

/// Returns the fewest pixels across and down for one of `among` pictures of gradients with this size in px. Some programs show pixels
/// unsmoothed.
fn coarsest((width, height): (f64, f64), among: usize) -> Vec2 {
    /// Fewest pixels along a side, and per px.
    const SIDE: f64 = 64.0;
    const DENSITY: f64 = 0.25;
    /// Most pixels in all pictures of a drawing that exist for such programs.
    const MAX_TOGETHER: f64 = 4e6;
    let least = Vec2::new((DENSITY * width).max(SIDE), (DENSITY * height).max(SIDE));
    least * (MAX_TOGETHER / among.max(1) as f64 / (least.x * least.y)).sqrt().min(1.0)
}

/// A length that exceeds whole pixels by less than this is rounding error.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Returns the map's own inverse if it holds on all of `area`, or leads to a part of it that lies in front; else Newton's method over it.
/// Both count their evaluations.
pub(crate) fn inverse(map: &Arc<dyn Map>, area: Rect, budget: &Arc<Budget>) -> CountedInverse {
    /// Reach beyond the area, as a fraction of its diagonal: the footprint of the pixels along its edge.
    const REACH: f64 = 0.02;
    /// Number of test points per side, and the distance, as a fraction of the diagonal, within which they have to return.
    const TRIED: usize = 9;
    const RETURNED: f64 = 1e-3;
    let near = RETURNED * area.width().hypot(area.height());
    let leads_back = |inverse: &Arc<dyn Map>, p: Point| {
        let image = map.point(p);
        let q = inverse.point(image);
        q.distance(p) < near || (area.inflate(near, near).contains(q) && map.point(q).distance(image) < near)
    };
    let is_inverse = |inverse: &Arc<dyn Map>| {
        let share = |i: usize| (i as f64 + 0.5) / TRIED as f64;
        let samples = (0..TRIED * TRIED).map(|i| (share(i % TRIED), share(i / TRIED)));
        let samples = samples.map(|(u, v)| area.origin() + Vec2::new(u * area.width(), v * area.height()));
        samples.filter(|p| map.point(*p).is_finite()).all(|p| leads_back(inverse, p))
    };
    let analytic = map.inverse().filter(is_inverse);
    let newton = || Arc::new(NewtonInverse::over(Arc::clone(map), area, REACH)) as Arc<dyn Map>;
    let inverse = analytic.unwrap_or_else(newton);
    CountedInverse { map: inverse.within(budget).unwrap_or(inverse), budget: Arc::clone(budget) }
}

/// The work on one pixel, in units of painting one.
#[derive(Clone, Copy)]
pub enum Pixel {
    /// Sampled for a face of a model, once for every face in front of or behind it.
    Sampled = 2,
    /// Decoded from a compressed picture or from the text of a drawing.
    Decoded = 4,
    /// Sampled and compressed.
    Warped = 60,
    /// Shaded by a gradient.
    Shaded = 40,
}

/// Counts work on pixels.
pub fn count_pixels(budget: &Budget, pixel: Pixel, pixels: f64) -> Result<(), Exceeded> {
    budget.spend(cost::PIXEL * f64::from(pixel as u8) * pixels)
}

/// Counts a picture that is read or made in the budget, and for the limits on the program's time and memory.
pub(crate) fn count_picture(budget: &Budget, pixel: Pixel, (width, height): (f64, f64)) -> Result<(), Exceeded> {
    budget.take(Limit::Pixels, width * height)?;
    meter::count_pixels(width * height);
    count_pixels(budget, pixel, width * height)
}

/// Counts evaluations of a map.
pub(crate) fn count_evaluations(budget: &Budget, map: &dyn Map, n: f64) -> Result<(), Exceeded> {
    budget.spend(n * map.work())
}

/// An inverse that counts its evaluations and is undefined everywhere once the budget is spent.
pub(crate) struct CountedInverse {
    map: Arc<dyn Map>,
    budget: Arc<Budget>,
}

impl CountedInverse {
    /// Counts evaluations. Returns `true` if the budget allows them.
    fn count(&self, n: usize) -> bool {
        count_evaluations(&self.budget, &*self.map, n as f64).is_ok()
    }
}

impl Map for CountedInverse {
    fn jet(&self, p: Point) -> Jet {
        if self.count(1) { self.map.jet(p) } else { Jet::UNDEFINED }
    }

    fn point(&self, p: Point) -> Point {
        if self.count(1) { self.map.point(p) } else { Jet::UNDEFINED.p }
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        if self.count(ps.len()) { self.map.jets(ps, out) } else { out.fill(Jet::UNDEFINED) }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        if self.count(ps.len()) { self.map.points(ps, out) } else { out.fill(Jet::UNDEFINED.p) }
    }

    fn cost(&self) -> Cost<'_> {
        let cost = Cost::new(self.map.work());
        if self.map.prefers_batches() { cost.batched(self) } else { cost }
    }
}

impl Batches for CountedInverse {
    fn differentiates(&self) -> bool {
        self.map.cost().batches.is_some_and(Batches::differentiates)
    }
}

/// A colour behind the drawing; `None` for transparency.
#[derive(Clone)]
pub struct Background(pub Option<Color>);

/// Parses a colour as in CSS, or `none`.
pub fn background(text: &str) -> Result<Background, String> {
    if matches!(text, "none" | "transparent") {
        return Ok(Background(None));
    }
    let color = svgtypes::Color::from_str(text);
    let c = color.map_err(|_| "is not a colour; write white, #fff8e0, rgb(0 0 0 / 50%) or none")?;
    Ok(Background(Some(Color::from_rgba8(c.red, c.green, c.blue, c.alpha))))
}

/// Encodes a picture in a format; formats of drawings become PNG.
pub fn encode(pixmap: Pixmap, format: Format, quality: Option<u8>) -> Result<Vec<u8>, Failure> {
    match format.of_picture(quality) {
        None | Some(PictureFormat::Png) => Ok(encode_png(&pixmap)?),
        Some(other) => Ok(Picture::from(pixmap).write(other)?),
    }
}
