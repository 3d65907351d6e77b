//! Geometry read from the source in f64 and with true arcs: outlines of shapes, transforms, viewports.
//!
//! usvg works in f32 and approximates arcs by cubics within 0.1 units. Its result is authoritative (it knows CSS, fonts and
//! units); geometry from the source is used if it agrees with usvg's up to f32 rounding.

use super::basic_shapes::{ellipse, rounded_rect};
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point, Rect, Size, Vec2};
use pathwarp::outline::Builder;
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, Length, LengthUnit};

pub(super) const MM_PER_INCH: f64 = 25.4;

/// The dimension of the viewport that a percentage refers to.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Dimension {
    Width,
    Height,
    Diagonal,
}

impl Dimension {
    /// 100 % of a viewport.
    pub(crate) fn of(self, view: Size) -> f64 {
        match self {
            Self::Width => view.width,
            Self::Height => view.height,
            Self::Diagonal => ((view.width.powi(2) + view.height.powi(2)) / 2.0).sqrt(),
        }
    }
}

/// Reads geometry from the source.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GeometryReader<'a> {
    pub(crate) source: &'a SourceText,
    pub(crate) dpi: f64,
    /// Size of the page in px, as resolved by usvg. Percentages refer to it if the root has no viewBox.
    pub(crate) page: Size,
}

impl GeometryReader<'_> {
    fn length(&self, e: ElementId, name: &str, of: Dimension) -> Option<Option<f64>> {
        let Some(text) = self.source.attr(e, name) else { return Some(None) };
        // An invalid value counts as absent.
        let Ok(l) = Length::from_str(text.trim()) else { return Some(None) };
        let n = l.number;
        Some(Some(match l.unit {
            LengthUnit::None | LengthUnit::Px => n,
            LengthUnit::In => n * self.dpi,
            LengthUnit::Cm => n * self.dpi / 2.54,
            LengthUnit::Mm => n * self.dpi / MM_PER_INCH,
            LengthUnit::Pt => n * self.dpi / 72.0,
            LengthUnit::Pc => n * self.dpi / 6.0,
            LengthUnit::Percent => n / 100.0 * of.of(self.viewport_size(e)?),
            // Needs the font.
            LengthUnit::Em | LengthUnit::Ex => return None,
        }))
    }

    fn length_or_zero(&self, e: ElementId, name: &str, of: Dimension) -> Option<f64> {
        Some(self.length(e, name, of)?.unwrap_or(0.0))
    }

    /// Returns the size of the nearest enclosing viewport. `None` if it cannot be read from the source alone.
    fn viewport_size(&self, e: ElementId) -> Option<Size> {
        let Some(svg) = self.source.viewport(e) else { return Some(self.page) };
        if self.source.elements[svg].parent.is_none() {
            return Some(self.root_size());
        }
        if let Some(v) = self.view_box(svg) {
            return Some(v.size());
        }
        // Percentages of an outer viewport are left to usvg.
        let side = |name| {
            let text = self.source.attr(svg, name)?;
            let l = Length::from_str(text.trim()).ok()?;
            matches!(l.unit, LengthUnit::None | LengthUnit::Px).then_some(l.number)
        };
        Some(Size::new(side("width")?, side("height")?))
    }

    /// Returns the size of the root's viewport, in its user units.
    pub(crate) fn root_size(&self) -> Size {
        self.view_box(0).map_or(self.page, |v| v.size())
    }

    /// Returns an element's `viewBox`.
    pub(crate) fn view_box(&self, e: ElementId) -> Option<Rect> {
        let text = self.source.attr(e, "viewBox")?;
        let v = svgtypes::ViewBox::from_str(&text).ok()?;
        Some(Rect::new(v.x, v.y, v.x + v.w, v.y + v.h))
    }

    /// Returns the transform from `e`'s viewBox to a viewport of the given size.
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

    /// Returns the transform from an element's user space to its parent's: its `transform`, the position and viewBox of a
    /// nested viewport, the shift of a `use`. Returns `None` if it cannot be read from the source alone.
    pub(crate) fn own_transform(&self, e: ElementId) -> Option<Affine> {
        let el = &self.source.elements[e];
        let mut t = Affine::IDENTITY;
        if let Some(text) = self.source.attr(e, "transform") {
            t = transform(&text)?;
        }
        match el.tag.as_ref() {
            "use" => {
                let shift =
                    (self.length_or_zero(e, "x", Dimension::Width)?, self.length_or_zero(e, "y", Dimension::Height)?);
                Some(t * Affine::translate(shift))
            }
            "svg" if el.parent.is_some() => {
                let shift =
                    (self.length_or_zero(e, "x", Dimension::Width)?, self.length_or_zero(e, "y", Dimension::Height)?);
                t *= Affine::translate(shift);
                let view = self.viewport_size(e);
                let side = |name, of, full: fn(Size) -> f64| match self.length(e, name, of)? {
                    Some(l) => Some(l),
                    None => view.map(full),
                };
                let size = Size::new(
                    side("width", Dimension::Width, |s| s.width)?,
                    side("height", Dimension::Height, |s| s.height)?,
                );
                Some(t * self.view_box_transform(e, size))
            }
            _ => Some(t),
        }
    }

    /// Returns the transform from an element's user space to the root's, if the source alone determines it.
    pub(crate) fn transform_to_root(&self, e: ElementId) -> Option<Affine> {
        let mut t = Affine::IDENTITY;
        for a in self.source.ancestors(e) {
            if self.source.elements[a].parent.is_some() {
                t = self.own_transform(a)? * t;
            }
        }
        Some(t)
    }

    /// Returns the outline of a shape element in its user space, or `None` if the source alone does not determine it or the
    /// shape is empty.
    pub(crate) fn outline(&self, e: ElementId) -> Option<Outline> {
        let x = |name| self.length_or_zero(e, name, Dimension::Width);
        let y = |name| self.length_or_zero(e, name, Dimension::Height);
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
                let r = self.length_or_zero(e, "r", Dimension::Diagonal)?;
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

    /// Returns `rx` and `ry`. If one is missing or negative, it equals the other.
    fn radii(&self, e: ElementId) -> Option<(f64, f64)> {
        let rx = self.length(e, "rx", Dimension::Width)?.filter(|v| !v.is_sign_negative());
        let ry = self.length(e, "ry", Dimension::Height)?.filter(|v| !v.is_sign_negative());
        let both = rx.or(ry).unwrap_or(0.0);
        Some((rx.unwrap_or(both), ry.unwrap_or(both)))
    }
}

/// Parses a transform list and multiplies it out.
pub(crate) fn transform(text: &str) -> Option<Affine> {
    let t = svgtypes::Transform::from_str(text).ok()?;
    Some(Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::Seg;

    fn read(shape: &str) -> (SourceText, Size) {
        let s = SourceText::parse(
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 100'>{shape}</svg>"),
            "t",
        )
        .unwrap();
        (s, Size::new(200.0, 100.0))
    }

    fn outline(shape: &str) -> Option<Outline> {
        let (source, page) = read(shape);
        GeometryReader { source: &source, dpi: 96.0, page }.outline(1)
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
