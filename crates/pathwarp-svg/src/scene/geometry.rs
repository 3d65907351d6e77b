//! Geometry straight from the source, in f64 and with true arcs: shapes' outlines, transforms, viewports.
//!
//! usvg keeps f32 and turns arcs into cubics within 0.1 units. Its result is what decides (it knows CSS, fonts and units);
//! what is read here is used where it agrees with usvg's to f32 rounding.

use crate::source::text::{ElementId, Source};
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point, Rect, Size, Vec2};
use pathwarp::outline::{Builder, EllipticArc, Seg};
use std::f64::consts::FRAC_PI_2;
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, Length, LengthUnit};
use usvg::tiny_skia_path as ts;

/// Which side of the viewport a percentage refers to.
#[derive(Debug, Clone, Copy)]
enum Side {
    Width,
    Height,
    Diagonal,
}

/// Reads geometry from the source.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reader<'a> {
    pub(crate) source: &'a Source,
    pub(crate) dpi: f64,
    /// The page in px, as usvg resolved it: what percentages on a root without viewBox refer to.
    pub(crate) page: Size,
}

impl Reader<'_> {
    fn length(&self, e: ElementId, name: &str, side: Side) -> Option<Option<f64>> {
        let Some(text) = self.source.attr(e, name) else { return Some(None) };
        // An unreadable value counts as absent.
        let Ok(l) = Length::from_str(text.trim()) else { return Some(None) };
        let n = l.number;
        Some(Some(match l.unit {
            LengthUnit::None | LengthUnit::Px => n,
            LengthUnit::In => n * self.dpi,
            LengthUnit::Cm => n * self.dpi / 2.54,
            LengthUnit::Mm => n * self.dpi / 25.4,
            LengthUnit::Pt => n * self.dpi / 72.0,
            LengthUnit::Pc => n * self.dpi / 6.0,
            LengthUnit::Percent => {
                let view = self.viewport_size(e)?;
                n / 100.0
                    * match side {
                        Side::Width => view.width,
                        Side::Height => view.height,
                        Side::Diagonal => ((view.width.powi(2) + view.height.powi(2)) / 2.0).sqrt(),
                    }
            }
            // These need the font.
            LengthUnit::Em | LengthUnit::Ex => return None,
        }))
    }

    fn length_or_zero(&self, e: ElementId, name: &str, side: Side) -> Option<f64> {
        Some(self.length(e, name, side)?.unwrap_or(0.0))
    }

    fn viewport_size(&self, e: ElementId) -> Option<Size> {
        let Some(svg) = self.source.viewport(e) else { return Some(self.page) };
        if let Some(v) = self.view_box(svg) {
            return Some(v.size());
        }
        if self.source.elements[svg].parent.is_none() {
            return Some(self.page);
        }
        // A nested viewport given in percent of another would need this again; that is left to usvg.
        let side = |name| {
            let text = self.source.attr(svg, name)?;
            let l = Length::from_str(text.trim()).ok()?;
            matches!(l.unit, LengthUnit::None | LengthUnit::Px).then_some(l.number)
        };
        Some(Size::new(side("width")?, side("height")?))
    }

    /// An element's `viewBox`.
    pub(crate) fn view_box(&self, e: ElementId) -> Option<Rect> {
        let text = self.source.attr(e, "viewBox")?;
        let v = svgtypes::ViewBox::from_str(&text).ok()?;
        Some(Rect::new(v.x, v.y, v.x + v.w, v.y + v.h))
    }

    /// The transform by which `e`'s viewBox is shown in a viewport of `size`.
    pub(crate) fn view_box_transform(&self, e: ElementId, size: Size) -> Affine {
        let Some(v) = self.view_box(e) else { return Affine::IDENTITY };
        let aspect = self.source.attr(e, "preserveAspectRatio").and_then(|t| AspectRatio::from_str(&t).ok());
        let aspect = aspect.unwrap_or_default();
        let (mut sx, mut sy) = (size.width / v.width(), size.height / v.height());
        if aspect.align != Align::None {
            let s = if aspect.slice { sx.max(sy) } else { sx.min(sy) };
            (sx, sy) = (s, s);
        }
        let (x, y) = (-v.x0 * sx, -v.y0 * sy);
        let (w, h) = (size.width - v.width() * sx, size.height - v.height() * sy);
        let dx = match aspect.align {
            Align::None | Align::XMinYMin | Align::XMinYMid | Align::XMinYMax => 0.0,
            Align::XMidYMin | Align::XMidYMid | Align::XMidYMax => w / 2.0,
            Align::XMaxYMin | Align::XMaxYMid | Align::XMaxYMax => w,
        };
        let dy = match aspect.align {
            Align::None | Align::XMinYMin | Align::XMidYMin | Align::XMaxYMin => 0.0,
            Align::XMinYMid | Align::XMidYMid | Align::XMaxYMid => h / 2.0,
            Align::XMinYMax | Align::XMidYMax | Align::XMaxYMax => h,
        };
        Affine::new([sx, 0.0, 0.0, sy, x + dx, y + dy])
    }

    /// The transform between an element's own user space and its parent's, as far as the source says: its `transform`, a
    /// nested viewport's place and viewBox, the shift of a `use`.
    pub(crate) fn own_transform(&self, e: ElementId) -> Option<Affine> {
        let el = &self.source.elements[e];
        let mut t = Affine::IDENTITY;
        if let Some(text) = self.source.attr(e, "transform") {
            t = transform(&text)?;
        }
        match el.tag.as_ref() {
            "use" => {
                let shift = (self.length_or_zero(e, "x", Side::Width)?, self.length_or_zero(e, "y", Side::Height)?);
                Some(t * Affine::translate(shift))
            }
            "svg" if el.parent.is_some() => {
                let shift = (self.length_or_zero(e, "x", Side::Width)?, self.length_or_zero(e, "y", Side::Height)?);
                t *= Affine::translate(shift);
                let view = self.viewport_size(e);
                let side = |name, side, full: fn(Size) -> f64| match self.length(e, name, side)? {
                    Some(l) => Some(l),
                    None => view.map(full),
                };
                let size =
                    Size::new(side("width", Side::Width, |s| s.width)?, side("height", Side::Height, |s| s.height)?);
                Some(t * self.view_box_transform(e, size))
            }
            _ => Some(t),
        }
    }

    /// The transform from an element's user space to the root's, as far as the source says.
    pub(crate) fn transform_to_root(&self, e: ElementId) -> Option<Affine> {
        let mut t = Affine::IDENTITY;
        for a in self.source.ancestors(e) {
            if self.source.elements[a].parent.is_some() {
                t = self.own_transform(a)? * t;
            }
        }
        Some(t)
    }

    /// The outline of a shape element in its own user space; `None` where the source alone does not tell, or there is nothing
    /// to draw.
    pub(crate) fn outline(&self, e: ElementId) -> Option<Outline> {
        let x = |name| self.length_or_zero(e, name, Side::Width);
        let y = |name| self.length_or_zero(e, name, Side::Height);
        let mut b = Builder::default();
        match self.source.elements[e].tag.as_ref() {
            "path" => return Some(Outline::from_svg_lossy(&self.source.attr(e, "d")?)).filter(|o| !o.is_empty()),
            "rect" => {
                let (x0, y0) = (x("x")?, y("y")?);
                let r = Rect::new(x0, y0, x0 + x("width")?, y0 + y("height")?);
                if r.width() <= 0.0 || r.height() <= 0.0 {
                    return None;
                }
                let (rx, ry) = self.radii(e)?;
                rounded_rect(&mut b, r, Vec2::new(rx.min(r.width() / 2.0), ry.min(r.height() / 2.0)));
            }
            "circle" => {
                let r = self.length_or_zero(e, "r", Side::Diagonal)?;
                ellipse(&mut b, Point::new(x("cx")?, y("cy")?), Vec2::new(r, r))?;
            }
            "ellipse" => {
                let (rx, ry) = self.radii(e)?;
                ellipse(&mut b, Point::new(x("cx")?, y("cy")?), Vec2::new(rx, ry))?;
            }
            "line" => {
                b.move_to(Point::new(x("x1")?, y("y1")?));
                b.line_to(Point::new(x("x2")?, y("y2")?));
            }
            "polyline" | "polygon" => {
                let text = self.source.attr(e, "points")?;
                let points: Vec<Point> = svgtypes::PointsParser::from(&*text).map(Point::from).collect();
                if points.len() < 2 {
                    return None;
                }
                return Some(Outline::from_points(&points, self.source.elements[e].tag == "polygon"));
            }
            _ => return None,
        }
        Some(b.finish())
    }

    /// `rx` and `ry`: one stands for both, negative ones are absent.
    fn radii(&self, e: ElementId) -> Option<(f64, f64)> {
        let rx = self.length(e, "rx", Side::Width)?.filter(|v| !v.is_sign_negative());
        let ry = self.length(e, "ry", Side::Height)?.filter(|v| !v.is_sign_negative());
        let both = rx.or(ry).unwrap_or(0.0);
        Some((rx.unwrap_or(both), ry.unwrap_or(both)))
    }
}

/// A transform list, multiplied out.
pub(crate) fn transform(text: &str) -> Option<Affine> {
    let t = svgtypes::Transform::from_str(text).ok()?;
    Some(Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]))
}

/// Four quarters from three o'clock, clockwise on screen, as the SVG specification draws it.
fn ellipse(b: &mut Builder, c: Point, r: Vec2) -> Option<()> {
    if !(r.x > 0.0 && r.y > 0.0) {
        return None;
    }
    b.move_to(Point::new(c.x + r.x, c.y));
    // The ends are written down rather than computed, so that no cosine of a right angle leaks in.
    let ends = [(c.x, c.y + r.y), (c.x - r.x, c.y), (c.x, c.y - r.y), (c.x + r.x, c.y)];
    for (i, end) in ends.into_iter().enumerate() {
        quarter(b, c, r, i, end.into());
    }
    b.close();
    Some(())
}

fn quarter(b: &mut Builder, c: Point, r: Vec2, i: usize, end: Point) {
    let arc = EllipticArc::new(c, Vec2::new(r.x, 0.0), Vec2::new(0.0, r.y), i as f64 * FRAC_PI_2, FRAC_PI_2);
    b.arc(EllipticArc { p0: b.at(), p1: end, ..arc });
}

fn rounded_rect(b: &mut Builder, r: Rect, radii: Vec2) {
    let Vec2 { x: rx, y: ry } = radii;
    if rx <= 0.0 || ry <= 0.0 {
        b.move_to(Point::new(r.x0, r.y0));
        for p in [(r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)] {
            b.line_to(p.into());
        }
        b.close();
        return;
    }
    // Per corner: where its straight run ends, the arc's centre, the quarter, and where the arc ends.
    let corners = [
        ((r.x1 - rx, r.y0), (r.x1 - rx, r.y0 + ry), 3, (r.x1, r.y0 + ry)),
        ((r.x1, r.y1 - ry), (r.x1 - rx, r.y1 - ry), 0, (r.x1 - rx, r.y1)),
        ((r.x0 + rx, r.y1), (r.x0 + rx, r.y1 - ry), 1, (r.x0, r.y1 - ry)),
        ((r.x0, r.y0 + ry), (r.x0 + rx, r.y0 + ry), 2, (r.x0 + rx, r.y0)),
    ];
    b.move_to(Point::new(r.x0 + rx, r.y0));
    for (run, centre, i, end) in corners {
        if b.at() != Point::from(run) {
            b.line_to(run.into());
        }
        quarter(b, centre.into(), radii, i, end.into());
    }
    b.close();
}

/// usvg's path in f64.
pub(crate) fn from_usvg(path: &ts::Path) -> Outline {
    let p = |p: ts::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let mut b = Builder::default();
    for s in path.segments() {
        match s {
            ts::PathSegment::MoveTo(a) => b.move_to(p(a)),
            ts::PathSegment::LineTo(a) => b.line_to(p(a)),
            ts::PathSegment::QuadTo(a, c) => b.quad_to(p(a), p(c)),
            ts::PathSegment::CubicTo(a, c, d) => b.curve_to(p(a), p(c), p(d)),
            ts::PathSegment::Close => b.close(),
        }
    }
    b.finish()
}

/// usvg's transform in f64.
pub(crate) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// Whether usvg's path is `outline` in f32: the same subpaths with the same anchors, arcs cut anyhow.
pub(crate) fn same_path(outline: &Outline, path: &ts::Path) -> bool {
    let b = path.bounds();
    let size = [b.left(), b.right(), b.top(), b.bottom()].iter().fold(0.0_f32, |m, v| m.max(v.abs()));
    // usvg adds and halves in f32 before we compare; a few units in the last place of the largest number.
    let near = f64::from(size) * 2e-6 + 1e-12;
    let theirs = from_usvg(path);
    // usvg drops subpaths of one point.
    let ours: Vec<_> = outline.subpaths.iter().filter(|s| !s.segs.is_empty() || s.closed).collect();
    let theirs: Vec<_> = theirs.subpaths.iter().filter(|s| !s.segs.is_empty() || s.closed).collect();
    ours.len() == theirs.len()
        && ours.iter().zip(&theirs).all(|(a, b)| {
            let close = |p: Point, q: Point| (p.x - q.x).abs() <= near && (p.y - q.y).abs() <= near;
            let mut rest = b.segs.iter().filter(|s| s.start() != s.end()).peekable();
            let mut matched = close(a.start, b.start);
            for s in &a.segs {
                match s {
                    Seg::Arc(arc) => {
                        // usvg's cubics share the arc's ends and stay within 0.1 of it.
                        let mut found = false;
                        for t in rest.by_ref() {
                            if close(t.end(), arc.p1) {
                                found = true;
                                break;
                            }
                        }
                        matched &= found;
                    }
                    s if close(s.start(), s.end()) && matches!(s, Seg::Line(_)) => {
                        // In f32 it may have shrunk to nothing.
                        if rest.peek().is_some_and(|t| matches!(t, Seg::Line(_)) && close(t.start(), t.end())) {
                            rest.next();
                        }
                    }
                    s => {
                        matched &= rest.next().is_some_and(|t| {
                            let (c, d) = (s.to_cubic(), t.to_cubic());
                            close(c.p1, d.p1) && close(c.p2, d.p2) && close(c.p3, d.p3)
                        });
                    }
                }
                if !matched {
                    return false;
                }
            }
            // A closing line that only f32 rounding opened may be left over.
            matched && rest.all(|t| close(t.start(), t.end()))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(shape: &str) -> (Source, Size) {
        let s =
            Source::parse(format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 100'>{shape}</svg>"), "t")
                .unwrap();
        (s, Size::new(200.0, 100.0))
    }

    fn outline(shape: &str) -> Option<Outline> {
        let (source, page) = read(shape);
        Reader { source: &source, dpi: 96.0, page }.outline(1)
    }

    #[test]
    fn circles_are_four_true_quarters_from_three_oclock() {
        let o = outline("<circle cx='50%' cy='5mm' r='10'/>").unwrap();
        let segs: Vec<_> = o.segs().collect();
        assert_eq!(segs.len(), 4);
        assert!(segs.iter().all(|s| matches!(s, Seg::Arc(_))));
        assert_eq!(segs[0].start(), Point::new(110.0, 5.0 * 96.0 / 25.4));
        assert!(segs[0].end().y > segs[0].start().y);
    }

    #[test]
    fn rect_corners_follow_the_specification() {
        let o = outline("<rect width='40' height='20' rx='30' ry='5'/>").unwrap();
        assert_eq!(o.subpaths[0].start, Point::new(20.0, 0.0));
        let b = o.bounding_box().unwrap();
        assert!((b.x0 + b.y0).abs() < 1e-12 && (b.x1 - 40.0).abs() < 1e-12 && (b.y1 - 20.0).abs() < 1e-12);
        assert_eq!(o.segs().filter(|s| matches!(s, Seg::Arc(_))).count(), 4);
        assert!(outline("<rect width='40' height='-1'/>").is_none());
        assert!(outline("<rect width='4em' height='1'/>").is_none());
    }
}
