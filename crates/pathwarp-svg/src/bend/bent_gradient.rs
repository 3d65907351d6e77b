//! Gradients on a part that must become pictures: the decision, and the request to paint them.

use super::gradient::{GradientRequest, SeenColor};
use super::options::Gradients;
use super::paint::PaintFit;
use super::picture::{BentImage, PictureError};
use super::places;
use super::shading::Shading;
use super::task::PartTask;
use crate::scene::affine::stretch;
use pathwarp::kurbo::{BezPath, Point, Rect, Shape as _};
use usvg::Paint;

/// Smallest visible difference: more than one of 255 levels.
const SMALLEST: f64 = 1.5 / 255.0;
/// Smallest difference that is noticed without a comparison.
const NOTICED: f64 = 8.0 / 255.0;
/// The fraction of the shape on which it must be exceeded. Less are edges between hard stops, which move a little.
const NOTICED_SHARE: f64 = 0.01;
/// The largest error of an affine fit over a shape, relative to that at the places where it was measured.
const BETWEEN: f64 = 1.25;

/// A gradient that must become a picture to look right.
pub(super) struct BentGradient {
    shading: Shading,
    /// The box on which it is painted, in the part's user space.
    area: Rect,
    seen: Vec<SeenColor>,
    strict: bool,
    sharp: bool,
}

impl BentGradient {
    /// Returns the gradient of a paint of the part if the affine fit would be seen to be wrong.
    pub(super) fn of(t: &PartTask<'_>, paint: &Paint, fit: Option<PaintFit>) -> Option<Self> {
        let (p, options) = (t.part, t.options());
        // A gradient spans all copies, which the map does not describe. In tiles, errors are too small to see.
        let repeated = options.copies.len() > 1 || !options.letters.places.is_empty();
        if !options.paints_gradients() || repeated || p.in_tile || !p.painted() {
            return None;
        }
        let shading = Shading::of(paint)?;
        let strict = matches!(options.gradients, Gradients::Exact(_));
        let (least, share) = if strict { (SMALLEST, 0.0) } else { (NOTICED, NOTICED_SHARE) };
        let fill = p.fill.as_ref().filter(|f| std::ptr::eq(f.paint(), paint));
        let width = p.stroke.as_ref().map_or(0.0, |s| f64::from(s.width().get()));
        let opacity = fill.map(usvg::Fill::opacity).or(p.stroke.as_ref().map(usvg::Stroke::opacity));
        let opacity = opacity.map_or(1.0, |o| f64::from(o.get()));
        // Colours change at most this much over the largest error of the fit.
        let off = |f: PaintFit| opacity * shading.steepest() * f.miss * stretch(f.affine.inverse()) * BETWEEN;
        if fit.is_some_and(|f| off(f) <= least) {
            return None;
        }
        let places = match fill {
            Some(f) => places::inside(&p.local, f.rule(), strict),
            None => places::along(&p.local, width),
        };
        let seen = seen(t, &shading, &places);
        let back = fit.map(|f| f.affine.inverse());
        let differs = |s: &&SeenColor| {
            let found = back.map(|back| shading.premultiplied(back * s.at));
            found.is_none_or(|found| s.color.iter().zip(found).any(|(w, f)| (w - f).abs() * opacity > least))
        };
        if seen.iter().filter(differs).count() as f64 <= share * seen.len() as f64 {
            return None;
        }
        let reach = if fill.is_some() { 0.0 } else { 0.5 * width };
        let area = p.local.bounding_box().unwrap_or_default().inflate(reach, reach);
        let sharp = shading.jumps(places.into_iter(), NOTICED);
        Some(Self { shading, area, seen, strict, sharp })
    }

    /// Paints the gradient over the box of `target`. Records the error if there is one.
    pub(super) fn painted(
        &self,
        t: &PartTask<'_>,
        target: &BezPath,
        unpainted: &mut Option<PictureError>,
    ) -> Option<BentImage> {
        let (Gradients::Exact(painter) | Gradients::Auto(painter)) = &t.options().gradients else { return None };
        let request = GradientRequest {
            colors: &|places, colors| self.shading.colors(places, colors),
            area: self.area,
            placed: t.part.frame,
            map: t.context.map,
            after: t.back,
            target: target.bounding_box(),
            shape: target,
            to_px: t.context.to_px,
            among: t.context.gradients,
            seen: &self.seen,
            strict: self.strict,
            sharp: self.sharp,
        };
        painter.paint(&request).map_err(|why| *unpainted = Some(why)).ok()
    }
}

/// The exact colours of the bent gradient at the images of `places`.
fn seen(t: &PartTask<'_>, shading: &Shading, places: &[Point]) -> Vec<SeenColor> {
    let roots: Vec<Point> = places.iter().map(|p| t.part.frame * *p).collect();
    let mut images = vec![Point::ORIGIN; roots.len()];
    t.context.map.points(&roots, &mut images);
    let pairs = places.iter().zip(images).map(|(p, q)| (p, t.back * q)).filter(|(_, q)| q.is_finite());
    pairs.map(|(p, at)| SeenColor { at, color: shading.premultiplied(*p) }).collect()
}
