//! Reads outlines of shapes, transforms and viewports from the source, in f64 and with true arcs.
//!
//! usvg works in f32 and approximates arcs by cubics within 0.1 units. Its result is authoritative, since it resolves CSS, fonts and
//! units; geometry from the source is used if it agrees with usvg's up to f32 rounding.

use crate::source::elements::{ElementId, parse_transform};
use crate::source::text::SourceText;
use pathwarp::Outline;
use pathwarp::engine::decimal::single;
use pathwarp::kurbo::{Affine, Point, Rect, Size, Vec2};
use pathwarp::outline::{Builder, EllipticArc, Seg, Subpath};
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, Length, LengthUnit};
use usvg::tiny_skia_path as ts;

/// usvg's rectangle in f64.
pub(crate) fn rect(r: usvg::Rect) -> Rect {
    Rect::new(r.left().into(), r.top().into(), r.right().into(), r.bottom().into())
}

pub(super) const MM_PER_INCH: f64 = 25.4;

/// The dimension of the viewport to which a percentage refers.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Dimension {
    Width,
    Height,
    Diagonal,
}

impl Dimension {
    /// The length of 100 % in a viewport.
    pub(crate) fn in_view(self, view: Size) -> f64 {
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
    /// The length in an attribute; `Some(None)` if it is absent, `None` if the source alone does not determine it.
    pub(super) fn length(&self, e: ElementId, name: &str, dimension: Dimension) -> Option<Option<f64>> {
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
            LengthUnit::Percent => n / 100.0 * dimension.in_view(self.viewport_size(e)?),
            // Needs the font.
            LengthUnit::Em | LengthUnit::Ex => return None,
        }))
    }

    /// The length in an attribute, 0 if it is absent; `None` if the source alone does not determine it.
    fn length_or_zero(&self, e: ElementId, name: &str, dimension: Dimension) -> Option<f64> {
        Some(self.length(e, name, dimension)?.unwrap_or(0.0))
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
        // Sides in percent of an outer viewport are left to usvg.
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

    /// The `viewBox` of an element.
    pub(crate) fn view_box(&self, e: ElementId) -> Option<Rect> {
        let text = self.source.attr(e, "viewBox")?;
        let v = svgtypes::ViewBox::from_str(&text).ok()?;
        Some(Rect::new(v.x, v.y, v.x + v.w, v.y + v.h))
    }

    /// Returns the transform from `e`'s viewBox to a viewport of the given size.
    pub(crate) fn view_box_transform(&self, e: ElementId, size: Size) -> Affine {
        let Some(v) = self.view_box(e) else { return Affine::IDENTITY };
        let aspect = self.source.attr(e, "preserveAspectRatio");
        let aspect = aspect.and_then(|t| AspectRatio::from_str(&t).ok()).unwrap_or_default();
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

    /// Returns the transform from an element's user space to its parent's: its `transform`, with the position and viewBox of a
    /// nested viewport or the shift of a `use`. Returns `None` if it cannot be read from the source alone.
    pub(crate) fn own_transform(&self, e: ElementId) -> Option<Affine> {
        let el = &self.source.elements[e];
        let t = self.source.attr(e, "transform").map_or(Some(Affine::IDENTITY), |text| parse_transform(&text))?;
        let shifted = || {
            let x = self.length_or_zero(e, "x", Dimension::Width)?;
            Some(t * Affine::translate((x, self.length_or_zero(e, "y", Dimension::Height)?)))
        };
        match el.tag.as_ref() {
            "use" => shifted(),
            "svg" if el.parent.is_some() => {
                let t = shifted()?;
                let view = self.viewport_size(e);
                // An absent side is that of the viewport around.
                let width = self.length(e, "width", Dimension::Width)?.or_else(|| Some(view?.width))?;
                let height = self.length(e, "height", Dimension::Height)?.or_else(|| Some(view?.height))?;
                Some(t * self.view_box_transform(e, Size::new(width, height)))
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

    /// Returns the outline of a shape element in its user space, or `None` if the source alone does not determine it or the shape is empty.
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

/// Adds an ellipse: four quarters from three o'clock, clockwise on screen, as in the SVG specification.
pub(super) fn ellipse(b: &mut Builder, c: Point, r: Vec2) -> Option<()> {
    if !(r.x > 0.0 && r.y > 0.0) {
        return None;
    }
    b.move_to(Point::new(c.x + r.x, c.y));
    // Exact end points, without the rounding of a computed cosine.
    let ends = [(c.x, c.y + r.y), (c.x - r.x, c.y), (c.x, c.y - r.y), (c.x + r.x, c.y)];
    for (i, end) in ends.into_iter().enumerate() {
        quarter(b, c, r, i, end.into());
    }
    b.close();
    Some(())
}

/// Adds quarter `i` of an ellipse with centre `c` and radii `r`, from the current point to `end`.
fn quarter(b: &mut Builder, c: Point, r: Vec2, i: usize, end: Point) {
    let arc = EllipticArc::new(c, Vec2::new(r.x, 0.0), Vec2::new(0.0, r.y), i as f64 * FRAC_PI_2, FRAC_PI_2);
    b.arc(EllipticArc { p0: b.at(), p1: end, ..arc });
}

/// Adds a rectangle with rounded corners, in the order of the SVG specification.
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
    // Each corner: end of the straight run, centre of the arc, number of the quarter, end of the arc.
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

/// Converts usvg's transform to f64.
pub(crate) fn affine(t: usvg::Transform) -> Affine {
    single(Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from)))
}

/// Returns `true` if `m` is finite and can be inverted.
pub(crate) fn is_invertible(m: Affine) -> bool {
    m.is_finite() && m.determinant() != 0.0 && m.inverse().is_finite()
}

/// The largest factor by which `m` stretches a length: its larger singular value.
pub(crate) fn stretch(m: Affine) -> f64 {
    let [a, b, c, d, ..] = m.as_coeffs();
    let (s, t) = ((a + d).hypot(b - c), (a - d).hypot(b + c));
    (s + t) / 2.0
}

/// Returns `true` if two transforms agree up to f32 rounding of a short product.
pub(crate) fn is_near(a: Affine, b: Affine) -> bool {
    let (a, b) = (a.as_coeffs(), b.as_coeffs());
    let linear = a[..4].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let shift = a[4].abs().max(a[5].abs()).max(linear);
    (0..4).all(|i| (a[i] - b[i]).abs() <= 1e-6 * linear) && (4..6).all(|i| (a[i] - b[i]).abs() <= 1e-6 * shift)
}

/// The map without its shift.
pub(crate) fn linear_part(m: Affine) -> Affine {
    let [a, b, c, d, ..] = m.as_coeffs();
    Affine::new([a, b, c, d, 0.0, 0.0])
}

/// The bit pattern, for use as a key.
pub(crate) fn bits(m: Affine) -> [u64; 6] {
    m.as_coeffs().map(f64::to_bits)
}

/// The bit pattern in f32, for use as a key.
pub(crate) fn f32_bits(m: Affine) -> [u32; 6] {
    // Adding zero maps -0 to 0.
    m.as_coeffs().map(|v| (v as f32 + 0.0).to_bits())
}

/// Converts usvg's path to f64.
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

/// Returns `true` if usvg's path is `outline` in f32: it has equal subpaths with equal anchors, and cubics instead of arcs.
pub(crate) fn same_path(outline: &Outline, path: &ts::Path) -> bool {
    let b = path.bounds();
    let size = [b.left(), b.right(), b.top(), b.bottom()].iter().fold(0.0_f32, |m, v| m.max(v.abs()));
    // usvg adds and halves in f32, with an error of a few units in the last place of the largest number.
    let tolerance = f64::from(size) * 2e-6 + 1e-12;
    let theirs = from_usvg(path);
    // usvg drops subpaths of one point.
    let ours: Vec<_> = outline.subpaths.iter().filter(|s| !s.segs.is_empty() || s.closed).collect();
    let theirs: Vec<_> = theirs.subpaths.iter().filter(|s| !s.segs.is_empty() || s.closed).collect();
    ours.len() == theirs.len() && ours.iter().zip(&theirs).all(|(a, b)| same_subpath(a, b, tolerance))
}

/// Returns `true` if a subpath of the source equals usvg's within `tolerance`.
fn same_subpath(ours: &Subpath, theirs: &Subpath, tolerance: f64) -> bool {
    let close = |p: Point, q: Point| (p.x - q.x).abs() <= tolerance && (p.y - q.y).abs() <= tolerance;
    let handles = |s: &Seg| {
        let c = s.to_cubic();
        [c.p1, c.p2, c.p3]
    };
    // Rounding can add and drop segments without extent.
    let is_point = |s: &Seg| !matches!(s, Seg::Arc(_)) && handles(s).iter().all(|p| close(*p, s.start()));
    let mut rest: VecDeque<&Seg> = theirs.segs.iter().filter(|s| !is_point(s)).collect();
    // usvg draws an arc to the current point as a whole ellipse if the two points differ in f32.
    let skip_full_turn = |rest: &mut VecDeque<&Seg>, at: Point| {
        if rest.front().is_some_and(|s| close(s.start(), at) && matches!(s, Seg::Cubic(_)))
            && let Some(last) = rest.iter().position(|s| close(s.end(), at))
        {
            rest.drain(..=last);
        }
    };
    let mut at = ours.start;
    let mut matched = close(at, theirs.start);
    for s in ours.segs.iter().filter(|s| !is_point(s)) {
        matched &= match s {
            // usvg's cubics share the arc's ends and stay within 0.1 of it.
            Seg::Arc(arc) => {
                let last = rest.iter().position(|t| close(t.end(), arc.p1));
                last.is_some_and(|last| rest.drain(..=last).count() > 0)
            }
            s => {
                let same = |t: &Seg| handles(s).iter().zip(handles(t)).all(|(p, q)| close(*p, q));
                if !rest.front().is_some_and(|t| same(t)) {
                    skip_full_turn(&mut rest, at);
                }
                rest.pop_front().is_some_and(same)
            }
        };
        if !matched {
            return false;
        }
        at = s.end();
    }
    skip_full_turn(&mut rest, at);
    // f32 rounding may add a closing line.
    matched && rest.iter().all(|t| close(t.start(), t.end()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::Seg;
    use pathwarp_reader::{Plain, xml};

    fn read(shape: &str) -> (SourceText, Size) {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 100'>{shape}</svg>");
        let s = SourceText::from_plain(&xml::document(&svg).unwrap(), Plain::default(), "t").unwrap();
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

    /// The path of a document's only element, as usvg reads it.
    fn theirs(d: &str) -> Option<usvg::Tree> {
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='{d}'/></svg>");
        usvg::Tree::from_str(&text, &usvg::Options::default()).ok().filter(|t| !t.root().children().is_empty())
    }

    fn agree(d: &str) {
        let Some(tree) = theirs(d) else { return };
        let [usvg::Node::Path(p)] = tree.root().children() else { panic!("{d}") };
        assert!(same_path(&Outline::from_svg_lossy(d), p.data()), "{d}");
    }

    #[test]
    fn loops_petals_and_arcs_to_the_current_point_are_recognised() {
        for d in [
            "M180 100A80 80 0 1 1 20 100A80 80 0 1 1 180 100ZM100 90C80 60 120 60 100 90Z",
            "M5 5C5 5 5 5 5 5L9 9",
            "M100 90Q80 60 100 90Z",
            "M88 15A60 50 0 0 0 100 180A45 20 30 1 0 100 180Z",
            "M88.123 15.456a60 50 0 0 0 12.3 164.7A45 20 30 1 0 100.423 180.156L3 3C9 9 4 4 3 3Z",
            "M1 1M2 2L3 3M4 4ZM5 5L5 5ZL7 7",
        ] {
            agree(d);
        }
    }

    /// The two readings agree on random paths, on a coarse grid so that points often coincide.
    #[test]
    fn random_paths_are_recognised() {
        let mut state = 7_u64;
        let mut next = move |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % n
        };
        for _ in 0..3000 {
            let mut d = String::from("M10.1 20.7");
            for _ in 0..1 + next(8) {
                let n = |next: &mut dyn FnMut(u64) -> u64| format!(" {}", next(5) as f64 * 33.3);
                let list = |k: usize, next: &mut dyn FnMut(u64) -> u64| (0..k).map(|_| n(next)).collect::<String>();
                let (name, count) =
                    [("L", 2), ("C", 6), ("Q", 4), ("S", 4), ("T", 2), ("A", 2), ("Z", 0)][next(7) as usize];
                if name == "A" {
                    d += &format!("A{} {} {} {} {}", 1 + next(90), 1 + next(90), next(180), next(2), next(2));
                } else {
                    d += name;
                }
                d += &list(count, &mut next);
            }
            agree(&d);
        }
    }
}
