//! Replaces gradients that would look wrong under an affine fit: by another gradient, or else by a picture.

use super::fits::PaintFit;
use super::gradient_fit::{Moved, SEARCH_WORK, nearest};
use super::meshes;
use super::options::Gradients;
use super::pictures::{BentImage, GradientRequest, PictureError, SeenColor};
use super::shading::Shading;
use super::task::PartTask;
use crate::scene::geometry::stretch;
use crate::source::mesh::MeshGradient;
use pathwarp::Outline;
use pathwarp::kurbo::{self, BezPath, ParamCurve as _, ParamCurveArclen as _, Point, Rect, Shape as _, Vec2};
use pathwarp::outline::boundary;
use usvg::{FillRule, Paint};

/// Smallest visible difference: more than one of 255 levels.
const VISIBLE: f64 = 1.5 / 255.0;
/// Smallest difference that is noticeable without a comparison.
const NOTICEABLE: f64 = 8.0 / 255.0;
/// Fraction of the shape on which a difference must be noticeable to count. Edges between hard stops that shift a little cover less.
const NOTICEABLE_SHARE: f64 = 0.01;
/// An affine fit's largest error over a shape is at most this many times its largest error at the samples.
const SAMPLING_FACTOR: f64 = 1.25;

/// A gradient that an affine fit would show wrong.
pub(super) enum BentGradient {
    /// Another gradient looks right.
    Near(NewGradient),
    Picture(PaintedGradient),
    /// A mesh gradient that cannot be bent.
    Unbent(PictureError),
}

/// A gradient that replaces one of the source.
#[derive(Debug)]
pub(crate) enum NewGradient {
    /// A linear or radial gradient.
    Plain(Shading),
    Mesh(MeshGradient),
}

/// A gradient that must become a picture to look right.
pub(super) struct PaintedGradient {
    shading: Shading,
    /// The box to paint, in the part's user space.
    area: Rect,
    /// Exact colours at points spread over the shape.
    seen: Vec<SeenColor>,
    /// `true` if no difference may be visible; `false` if none may be noticeable.
    strict: bool,
    /// `true` if colours jump.
    sharp: bool,
}

impl BentGradient {
    /// Returns a replacement for the gradient of a paint of the part if the affine fit would look wrong; a picture only if the paint
    /// can be `pictured`.
    pub(super) fn replacing(t: &PartTask<'_>, paint: &Paint, fit: Option<PaintFit>, pictured: bool) -> Option<Self> {
        let (p, options) = (t.part, t.options());
        // A gradient spans all copies, which the map does not describe. In tiles, errors are too small to see.
        let repeated = options.copies.len() > 1 || !options.letters.places.is_empty();
        if repeated || p.in_tile || !p.painted() {
            return None;
        }
        if let Some(mesh) = t.context.drawing.mesh(paint) {
            let bent = options.moves(paint).then(|| meshes::bend_mesh(t, mesh))?;
            return Some(bent.map_or_else(Self::Unbent, |m| Self::Near(NewGradient::Mesh(m))));
        }
        if !options.paints_gradients() {
            return None;
        }
        let shading = Shading::from_paint(paint)?;
        let strict = options.gradients == Gradients::Exact;
        let (least, share) = if strict { (VISIBLE, 0.0) } else { (NOTICEABLE, NOTICEABLE_SHARE) };
        let fill = p.fill.as_ref().filter(|f| std::ptr::eq(f.paint(), paint));
        let width = p.stroke.as_ref().map_or(0.0, |s| f64::from(s.width().get()));
        let opacity = fill.map(usvg::Fill::opacity).or(p.stroke.as_ref().map(usvg::Stroke::opacity));
        let opacity = opacity.map_or(1.0, |o| f64::from(o.get()));
        let error_bound =
            |f: PaintFit| opacity * shading.steepest() * f.miss * stretch(f.affine.inverse()) * SAMPLING_FACTOR;
        if fit.is_some_and(|f| error_bound(f) <= least) {
            return None;
        }
        let points = match fill {
            Some(f) => points_inside(&p.local, f.rule(), strict),
            None => points_along(&p.local, width),
        };
        let moved = with_images(t, &points);
        let color = |(p, at): &Moved| SeenColor { at: *at, color: shading.premultiplied(*p) };
        let seen: Vec<SeenColor> = moved.iter().map(color).collect();
        let fitted = fit.map(|f| shading.transformed(f.affine));
        if fitted.as_ref().is_some_and(|fitted| opacity * largest_difference(fitted, &seen, share) <= least) {
            return None;
        }
        // An edge between hard stops must lie right, so a gradient with one is accepted only if it is right everywhere.
        let sharp = shading.jumps(points.iter().copied(), NOTICEABLE);
        let share = if sharp { 0.0 } else { share };
        let error = |s: &Shading| opacity * largest_difference(s, &seen, share) / least;
        if t.options().refit.budget.spend(SEARCH_WORK).is_ok()
            && let Some(near) = nearest(&shading, fitted.as_ref(), &moved, error)
        {
            return Some(Self::Near(NewGradient::Plain(near)));
        }
        if !pictured {
            return None;
        }
        let half_width = if fill.is_some() { 0.0 } else { 0.5 * width };
        let area = p.local.bounding_box().unwrap_or_default().inflate(half_width, half_width);
        Some(Self::Picture(PaintedGradient { shading, area, seen, strict, sharp }))
    }
}

/// The largest difference of a gradient from the exact colours, except at the fraction `share` of points.
fn largest_difference(shading: &Shading, seen: &[SeenColor], share: f64) -> f64 {
    let difference = |s: &SeenColor| {
        let found = shading.premultiplied(s.at);
        s.color.iter().zip(found).map(|(wanted, f)| (wanted - f).abs()).fold(0.0, f64::max)
    };
    let mut all: Vec<f64> = seen.iter().map(difference).collect();
    all.sort_by(f64::total_cmp);
    let counted = all.len() - (share * all.len() as f64) as usize;
    counted.checked_sub(1).map_or(0.0, |last| all[last])
}

impl PaintedGradient {
    /// A picture of the gradient over the box of `target`. If it cannot be painted, records the reason in `unpainted`.
    pub(super) fn painted(
        &self,
        t: &PartTask<'_>,
        target: &BezPath,
        unpainted: &mut Option<PictureError>,
    ) -> Option<BentImage> {
        let painter = t.options().painter.as_ref()?;
        let request = GradientRequest {
            colors: &|points, colors| self.shading.colors(points, colors),
            area: self.area,
            placed: t.part.frame,
            map: t.context.map,
            after: t.back,
            target: target.bounding_box(),
            shape: target,
            to_px: t.context.to_px,
            among: t.context.gradient_count,
            seen: &self.seen,
            strict: self.strict,
            sharp: self.sharp,
        };
        painter.gradient(&request).map_err(|why| *unpainted = Some(why)).ok()
    }
}

/// Points of the part with their images in the user space of the result, where those are finite.
fn with_images(t: &PartTask<'_>, points: &[Point]) -> Vec<Moved> {
    let roots: Vec<Point> = points.iter().map(|p| t.part.frame * *p).collect();
    let mut images = vec![Point::ORIGIN; roots.len()];
    t.context.map.points(&roots, &mut images);
    points.iter().zip(images).map(|(p, q)| (*p, t.back * q)).filter(|(_, q)| q.is_finite()).collect()
}

/// Number of lattice points over the box of a fill. The lattice is most even for Fibonacci numbers.
const POINTS: usize = 610;
/// Number of lattice points if every point counts, and for thin shapes, which contain few of [`POINTS`].
const DENSE_POINTS: usize = 6765;
/// Least number of points inside a shape that suffices to judge a gradient by.
const ENOUGH_POINTS: usize = 128;
/// Number of points along a stroke.
const STROKE_POINTS: usize = 377;
/// Flattening tolerance, relative to the box.
const FLATNESS: f64 = 1e-3;

/// Points spread evenly inside an outline. No two share a coordinate, so that bands in any direction contain some.
pub(super) fn points_inside(outline: &Outline, rule: FillRule, densely: bool) -> Vec<Point> {
    let Some(bounds) = outline.bounding_box() else { return Vec::new() };
    let tolerance = FLATNESS * bounds.width().hypot(bounds.height());
    // The lines of the flattened outline, with subpaths closed.
    let mut lines = Vec::new();
    boundary(outline.to_bez_path(tolerance), tolerance, |a, b| lines.push((a, b)));
    let found = if densely { Vec::new() } else { lattice(&lines, bounds, rule, POINTS) };
    if found.len() >= ENOUGH_POINTS { found } else { lattice(&lines, bounds, rule, DENSE_POINTS) }
}

/// Points on a stroke of the given width around an outline, without caps and dashes.
pub(super) fn points_along(outline: &Outline, width: f64) -> Vec<Point> {
    let Some(bounds) = outline.bounding_box() else { return Vec::new() };
    let tolerance = FLATNESS * bounds.width().hypot(bounds.height());
    let mut path = BezPath::new();
    kurbo::flatten(outline.to_bez_path(tolerance), tolerance, |e| path.push(e));
    let lengths: Vec<(kurbo::PathSeg, f64)> = path.segments().map(|s| (s, s.arclen(bounds.width()))).collect();
    let total: f64 = lengths.iter().map(|l| l.1).sum();
    let mut out = Vec::with_capacity(STROKE_POINTS);
    let mut before = 0.0;
    for (segment, length) in lengths.iter().filter(|l| l.1 > 0.0) {
        let normal = (segment.end() - segment.start()).turn_90() / *length;
        while ((out.len() as f64 + 0.5) / STROKE_POINTS as f64) * total < before + length && out.len() < STROKE_POINTS {
            let n = out.len() as f64;
            let t = (((n + 0.5) / STROKE_POINTS as f64) * total - before) / length;
            out.push(segment.eval(t) + normal * width * (golden(n) - 0.5));
        }
        before += length;
    }
    out
}

/// The fractional part of n times the golden ratio.
fn golden(n: f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    (n * RATIO).fract()
}

/// The points of a Fibonacci lattice of `n` points over a box that lie inside the closed lines. Every line adds to the winding numbers of
/// the points to its right, which are ordered by y.
fn lattice(lines: &[(Point, Point)], bounds: Rect, rule: FillRule, n: usize) -> Vec<Point> {
    let size = Vec2::new(bounds.width(), bounds.height());
    let row = |k: usize| bounds.y0 + (size.y * (k as f64 + 0.5)) / n as f64;
    let point = |k: usize| Point::new(bounds.x0 + size.x * golden(k as f64 + 0.5), row(k));
    let first_from = |y: f64| ((((y - bounds.y0) / size.y) * n as f64 - 0.5).ceil().max(0.0) as usize).min(n);
    let mut windings = vec![0_i32; n];
    for (a, b) in lines.iter().filter(|(a, b)| a.y != b.y) {
        let (top, bottom, direction) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let from = first_from(top.y);
        for (k, winding) in windings[..first_from(bottom.y)].iter_mut().enumerate().skip(from) {
            let p = point(k);
            if top.x + slope * (p.y - top.y) <= p.x {
                *winding += direction;
            }
        }
    }
    let filled = |w: i32| if rule == FillRule::EvenOdd { w % 2 != 0 } else { w != 0 };
    windings.into_iter().enumerate().filter(|(_, w)| filled(*w)).map(|(k, _)| point(k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::kurbo::Vec2;

    /// Agrees with kurbo's winding numbers, computed point by point.
    #[test]
    fn points_inside_are_inside_and_evenly_spread() {
        for data in [
            "M0,0 H100 V80 H0 Z M20,20 V60 H80 V20 Z",
            "M50,0 C110,10 90,100 40,90 S-20,10 50,0 Z M30,30 h20 v20 h-20 Z",
            "M0,50 A50,50 0 1 1 100,50 A50,50 0 1 1 0,50 Z",
            "M0,0 L100,0 L0,70 L100,70",
        ] {
            let outline = Outline::from_svg(data).unwrap();
            let path = Outline::from_svg(&format!("{data} Z")).unwrap().to_bez_path(1e-6);
            for rule in [FillRule::NonZero, FillRule::EvenOdd] {
                let filled = |p: Point| {
                    let w = path.winding(p);
                    if rule == FillRule::EvenOdd { w % 2 != 0 } else { w != 0 }
                };
                let bounds = outline.bounding_box().unwrap();
                let every = lattice(&[], bounds, rule, POINTS);
                assert!(every.is_empty());
                let found = points_inside(&outline, rule, false);
                let wrong = found.iter().filter(|p| !filled(**p)).count();
                assert!(wrong <= found.len() / 100, "{data}: {wrong} of {}", found.len());
                // Their share is that of the area.
                let fine = 200 * 200;
                let at = |k: u32| {
                    bounds.origin()
                        + Vec2::new(
                            bounds.width() * (f64::from(k % 200) + 0.5) / 200.0,
                            bounds.height() * (f64::from(k / 200) + 0.5) / 200.0,
                        )
                };
                let area = f64::from((0..fine).filter(|k| filled(at(*k))).count() as u32) / f64::from(fine);
                let share = found.len() as f64 / POINTS as f64;
                assert!((share - area).abs() < 0.02, "{data}: {share} for {area}");
            }
        }
    }

    #[test]
    fn thin_shapes_are_sampled_more_densely() {
        let sliver = Outline::from_svg("M0,0 L100,100 L100,101 L0,1 Z").unwrap();
        let found = points_inside(&sliver, FillRule::NonZero, false);
        assert!(found.len() > 40, "{}", found.len());
        assert!(found.iter().all(|p| p.y - p.x > -0.01 && p.y - p.x < 1.01));
    }

    #[test]
    fn strokes_are_sampled_along_their_path() {
        let path = Outline::from_svg("M0,0 H100 V50").unwrap();
        let found = points_along(&path, 4.0);
        assert_eq!(found.len(), STROKE_POINTS);
        assert!(found.iter().all(|p| (p.y.abs() <= 2.0 && p.x <= 100.0) || (p.x - 100.0).abs() <= 2.0));
        let down = found.iter().filter(|p| p.y > 2.0).count();
        assert!((down as f64 / STROKE_POINTS as f64 - 48.0 / 150.0).abs() < 0.03, "{down}");
        assert!(points_along(&Outline::from_svg("M5,5").unwrap(), 1.0).is_empty());
    }
}
