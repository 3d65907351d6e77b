//! Builds content streams, with the resources that they use.

use kurbo::{Affine, BezPath, PathEl, Point, Rect, Shape as _, Vec2};
use pathwarp::engine::decimal::single;
use pdf_writer::types::ColorSpaceOperand;
use pdf_writer::writers::Resources;
use pdf_writer::{Content, Finish as _, Name, Ref};
use std::collections::BTreeSet;
use usvg::tiny_skia_path::{Path, PathSegment};

/// Coordinates beyond this are far from the page's corner: single precision resolves only hundredths there.
pub(crate) const FAR: f64 = 1e5;

/// A kind of resource.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// A graphics state: opacity, blend mode, mask.
    State,
    /// A gradient or pattern.
    Pattern,
    /// A picture or a group.
    Object,
    /// The colour space of a spot colour.
    Ink,
}

/// The resources that a content stream uses: their kinds, and the numbers of their objects.
#[derive(Debug, Default)]
pub(crate) struct Used(BTreeSet<(Kind, i32)>);

/// A content stream.
pub(crate) struct Stream {
    pub(crate) content: Content,
    used: Used,
    /// Maps the current coordinates to the coordinates at the start of the stream, to which patterns refer.
    pub(crate) to_start: Affine,
    /// The page's corner in the current coordinates if it is far from their origin, else zero. It is subtracted from coordinates before
    /// they are written, since the single precision of PDF is too coarse for maps in metres.
    pub(crate) shift: Vec2,
    /// `to_start` and `shift` of the saved graphics states.
    outer: Vec<(Affine, Vec2)>,
}

impl Stream {
    pub(crate) fn new() -> Self {
        Self::shifted(Vec2::ZERO)
    }

    /// Starts the content of an object whose coordinates are written with this shift.
    pub(crate) fn shifted(shift: Vec2) -> Self {
        let to_start = Affine::translate(-shift);
        Self { content: Content::new(), used: Used::default(), to_start, shift, outer: Vec::new() }
    }

    pub(crate) fn save(&mut self) {
        self.content.save_state();
        self.outer.push((self.to_start, self.shift));
    }

    pub(crate) fn restore(&mut self) {
        self.content.restore_state();
        (self.to_start, self.shift) = self.outer.pop().unwrap_or_default();
    }

    /// Changes the coordinates.
    pub(crate) fn transform(&mut self, m: Affine) {
        if m != Affine::IDENTITY {
            let corner = (m.inverse() * self.shift.to_point()).to_vec2();
            let shift = if corner.hypot() > FAR && corner.is_finite() { corner } else { Vec2::ZERO };
            self.content.transform(matrix(Affine::translate(-self.shift) * m * Affine::translate(shift)));
            self.to_start *= m;
            self.shift = shift;
        }
    }

    /// Draws an object that fills the unit square, transformed by `unit`.
    pub(crate) fn object_at(&mut self, object: Ref, unit: Affine) {
        self.content.save_state();
        self.content.transform(matrix(Affine::translate(-self.shift) * unit));
        self.object(object);
        self.content.restore_state();
    }

    /// Starts a path with these outlines.
    pub(crate) fn outline(&mut self, path: &BezPath) {
        if self.shift == Vec2::ZERO {
            write(&mut self.content, path);
        } else {
            write(&mut self.content, &(Affine::translate(-self.shift) * path));
        }
    }

    /// Restricts drawing to an outline.
    pub(crate) fn clip(&mut self, path: &BezPath, rule: usvg::FillRule) {
        self.outline(path);
        match rule {
            usvg::FillRule::NonZero => self.content.clip_nonzero(),
            usvg::FillRule::EvenOdd => self.content.clip_even_odd(),
        };
        self.content.end_path();
    }

    /// Fills an outline with the current paint.
    pub(crate) fn fill(&mut self, path: &BezPath, rule: usvg::FillRule) {
        self.outline(path);
        match rule {
            usvg::FillRule::NonZero => self.content.fill_nonzero(),
            usvg::FillRule::EvenOdd => self.content.fill_even_odd(),
        };
    }

    pub(crate) fn state(&mut self, state: Ref) {
        let name = self.used.name(Kind::State, state);
        self.content.set_parameters(Name(name.as_bytes()));
    }

    /// Draws a picture or a group.
    pub(crate) fn object(&mut self, object: Ref) {
        let name = self.used.name(Kind::Object, object);
        self.content.x_object(Name(name.as_bytes()));
    }

    /// Sets a pattern as the paint.
    pub(crate) fn pattern(&mut self, pattern: Ref, strokes: bool) {
        let name = self.used.name(Kind::Pattern, pattern);
        let name = Name(name.as_bytes());
        if strokes {
            self.content.set_stroke_color_space(ColorSpaceOperand::Pattern).set_stroke_pattern(None, name);
        } else {
            self.content.set_fill_color_space(ColorSpaceOperand::Pattern).set_fill_pattern(None, name);
        }
    }

    /// Sets an ink at its full tint as the paint of strokes.
    pub(crate) fn ink(&mut self, space: Ref) {
        let name = self.used.name(Kind::Ink, space);
        let space = ColorSpaceOperand::Named(Name(name.as_bytes()));
        self.content.set_stroke_color_space(space).set_stroke_color([1.0]);
    }

    /// Returns the bytes and the resources.
    pub(crate) fn finish(self) -> (Vec<u8>, Used) {
        (self.content.finish().into_vec(), self.used)
    }
}

impl Used {
    /// Records the use of a resource, and returns its name.
    fn name(&mut self, kind: Kind, r: Ref) -> String {
        self.0.insert((kind, r.get()));
        name(kind, r.get())
    }

    /// Writes the dictionary of resources.
    pub(crate) fn write(&self, out: &mut Resources<'_>) {
        for kind in [Kind::State, Kind::Pattern, Kind::Object, Kind::Ink] {
            let mut of_kind = self.0.iter().filter(|(k, _)| *k == kind).peekable();
            if of_kind.peek().is_none() {
                continue;
            }
            let mut dict = match kind {
                Kind::State => out.ext_g_states(),
                Kind::Pattern => out.patterns(),
                Kind::Object => out.x_objects(),
                Kind::Ink => out.color_spaces(),
            };
            for (_, r) in of_kind {
                dict.pair(Name(name(kind, *r).as_bytes()), Ref::new(*r));
            }
            dict.finish();
        }
    }
}

fn name(kind: Kind, r: i32) -> String {
    let letter = match kind {
        Kind::State => 'G',
        Kind::Pattern => 'P',
        Kind::Object => 'X',
        Kind::Ink => 'C',
    };
    format!("{letter}{r}")
}

/// Converts an outline of usvg to f64.
pub(crate) fn from_usvg(path: &Path) -> BezPath {
    let point = |p: usvg::tiny_skia_path::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let mut out = BezPath::new();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => out.move_to(point(p)),
            PathSegment::LineTo(p) => out.line_to(point(p)),
            PathSegment::QuadTo(p, q) => out.quad_to(point(p), point(q)),
            PathSegment::CubicTo(p, q, r) => out.curve_to(point(p), point(q), point(r)),
            PathSegment::Close => out.close_path(),
        }
    }
    out
}

/// Writes the operators that construct an outline.
fn write(out: &mut Content, path: &BezPath) {
    let mut start = Point::ORIGIN;
    for element in path.elements() {
        let cubic = |out: &mut Content, p: Point, q: Point, r: Point| {
            let [x1, y1, x2, y2, x3, y3] = [p.x, p.y, q.x, q.y, r.x, r.y].map(|v| v as f32);
            out.cubic_to(x1, y1, x2, y2, x3, y3);
        };
        match *element {
            PathEl::MoveTo(p) => drop(out.move_to(p.x as f32, p.y as f32)),
            PathEl::LineTo(p) => drop(out.line_to(p.x as f32, p.y as f32)),
            // PDF has no quadratics, but this cubic is the same curve.
            PathEl::QuadTo(p, q) => cubic(out, start + (p - start) * (2.0 / 3.0), q + (p - q) * (2.0 / 3.0), q),
            PathEl::CurveTo(p, q, r) => cubic(out, p, q, r),
            PathEl::ClosePath => drop(out.close_path()),
        }
        start = element.end_point().unwrap_or(start);
    }
}

/// Returns `true` if the outline's box has an area; the outline itself may have none, as a slanted line.
pub(crate) fn has_area(path: &BezPath) -> bool {
    let r = path.bounding_box();
    r.width() > 0.0 && r.height() > 0.0
}

/// Converts a transform to f64.
pub(crate) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// Converts a transform for PDF, without entries that are rounding errors beside others (`single`).
pub(crate) fn matrix(m: Affine) -> [f32; 6] {
    single(m).as_coeffs().map(|v| v as f32)
}

/// Converts a rectangle to f64.
pub(crate) fn rect(r: usvg::Rect) -> Rect {
    let [x0, y0, x1, y1] = [r.left(), r.top(), r.right(), r.bottom()].map(f64::from);
    Rect::new(x0, y0, x1, y1)
}

/// Converts a rectangle for PDF.
pub(crate) fn pdf_rect(r: Rect) -> pdf_writer::Rect {
    let [x0, y0, x1, y1] = [r.x0, r.y0, r.x1, r.y1].map(|v| v as f32);
    pdf_writer::Rect::new(x0, y0, x1, y1)
}

/// Inflates a rectangle to make up for rounding and antialiasing.
pub(crate) fn roomy(r: Rect) -> Rect {
    /// The margin as a fraction of the size, and in pixels.
    const MARGIN: (f64, f64) = (0.01, 1.0);
    r.inflate(MARGIN.0 * r.width() + MARGIN.1, MARGIN.0 * r.height() + MARGIN.1)
}
