//! Writes gradients as PDF's axial and radial shadings, and mesh gradients as Coons patch meshes (PDF 32000-1, 8.7.4.5).
//!
//! A shading cannot repeat or reflect its colours. The range of such a gradient is extended until it covers the painted area, and the
//! colours are listed once for each period.

use crate::file::{File, deflated};
use crate::options::MeshPatch;
use crate::stream::{FAR, affine, matrix};
use kurbo::{Affine, Point, Rect, Vec2};
use pdf_writer::types::FunctionShadingType;
use pdf_writer::writers::StreamShadingType;
use pdf_writer::{Filter, Finish as _, Name, Ref};
use std::ops::Range;
use usvg::{Paint, SpreadMethod, Stop};

/// Limit on the periods of a repeating gradient. Finer ones look like their average.
const MAX_PERIODS: i32 = 256;

/// Stops closer than this make a sharp change.
const SHARP: f64 = 1e-6;

/// Fraction of the range over which to show a colour that only holds at the very end.
const EDGE: f64 = 1e-4;

/// A gradient over the range of offsets that covers the painted area.
pub(crate) struct Gradient {
    /// Maps the gradient's coordinates to the user space of the painted path.
    transform: Affine,
    shape: Shape,
    /// Offset over the range from 0 to 1, colour and opacity.
    stops: Vec<(f64, [f32; 3], f32)>,
}

/// The coordinates of a shading, for the ends of the range.
enum Shape {
    Axial([Point; 2]),
    Radial([(Point, f64); 2]),
    /// Has no stops.
    Mesh(Vec<MeshPatch>),
}

impl Gradient {
    /// Makes a mesh gradient in user space.
    pub(crate) fn mesh(patches: Vec<MeshPatch>) -> Self {
        Self { transform: Affine::IDENTITY, shape: Shape::Mesh(patches), stops: Vec::new() }
    }

    /// Reads the gradient of a paint, for painting `area`. Returns `None` for other paints.
    pub(crate) fn from_paint(paint: &Paint, area: Rect) -> Option<Self> {
        let point = |x: f32, y: f32| Point::new(f64::from(x), f64::from(y));
        match paint {
            Paint::LinearGradient(g) => {
                let (p, q) = (point(g.x1(), g.y1()), point(g.x2(), g.y2()));
                let transform = affine(g.transform());
                let range = match g.spread_method() {
                    SpreadMethod::Pad => (0, 1),
                    _ => periods_of_line(p, q, corners(transform, area)?),
                };
                let point_at = |t: i32| p + (q - p) * f64::from(t);
                let shape = Shape::Axial([point_at(range.0), point_at(range.1)]);
                Some(Self { transform, shape, stops: stops(g.stops(), g.spread_method(), range) })
            }
            Paint::RadialGradient(g) => {
                let (focus, center) = (point(g.fx(), g.fy()), point(g.cx(), g.cy()));
                let (inner, outer) = (f64::from(g.fr().get()), f64::from(g.r().get()));
                let transform = affine(g.transform());
                let circle = |t: i32| (focus + (center - focus) * f64::from(t), inner + (outer - inner) * f64::from(t));
                let range = match g.spread_method() {
                    SpreadMethod::Pad => (0, 1),
                    _ => {
                        let corners = corners(transform, area)?;
                        let holds = |(c, r): (Point, f64)| corners.iter().all(|p| p.distance(c) <= r);
                        (0, (1..MAX_PERIODS).find(|t| holds(circle(*t))).unwrap_or(MAX_PERIODS))
                    }
                };
                let shape = Shape::Radial([circle(range.0), circle(range.1)]);
                Some(Self { transform, shape, stops: stops(g.stops(), g.spread_method(), range) })
            }
            Paint::Color(_) | Paint::Pattern(_) => None,
        }
    }

    /// Returns `true` if any colour is translucent.
    pub(crate) fn is_translucent(&self) -> bool {
        let in_mesh = || matches!(&self.shape, Shape::Mesh(all) if all.iter().any(|p| p.1.iter().any(|c| c[3] < 1.0)));
        self.stops.iter().any(|(_, _, opacity)| *opacity < 1.0) || in_mesh()
    }

    /// Adds the colours as a pattern. `to_start` maps the user space of the painted path to the coordinates at the start of the
    /// content stream.
    pub(crate) fn colors(&self, file: &mut File<'_>, to_start: Affine) -> Ref {
        if let Shape::Mesh(patches) = &self.shape {
            return mesh(file, to_start, patches, 0..3, Name(b"DeviceRGB"));
        }
        let stops: Vec<_> = self.stops.iter().map(|(at, color, _)| (*at, color.to_vec())).collect();
        self.shading(file, to_start, &stops, Name(b"DeviceRGB"))
    }

    /// Adds the opacities as shades of grey.
    pub(crate) fn opacities(&self, file: &mut File<'_>, to_start: Affine) -> Ref {
        if let Shape::Mesh(patches) = &self.shape {
            return mesh(file, to_start, patches, 3..4, Name(b"DeviceGray"));
        }
        let stops: Vec<_> = self.stops.iter().map(|(at, _, opacity)| (*at, vec![*opacity])).collect();
        self.shading(file, to_start, &stops, Name(b"DeviceGray"))
    }

    /// Returns the position of a gradient far from the origin, to be subtracted from its coordinates; zero for others.
    fn shift(&self) -> Vec2 {
        let (Shape::Axial([start, _]) | Shape::Radial([(start, _), _])) = self.shape else { return Vec2::ZERO };
        if start.to_vec2().hypot() > FAR { start.to_vec2() } else { Vec2::ZERO }
    }

    fn shading(&self, file: &mut File<'_>, to_start: Affine, stops: &[(f64, Vec<f32>)], space: Name<'_>) -> Ref {
        let function = add_function(file, stops);
        let object = file.new_ref();
        let mut pattern = file.pdf.shading_pattern(object);
        let shift = self.shift();
        pattern.matrix(matrix(to_start * self.transform * Affine::translate(shift)));
        let mut shading = pattern.function_shading();
        match &self.shape {
            Shape::Axial(ends) => {
                shading.shading_type(FunctionShadingType::Axial);
                shading.coords(ends.iter().map(|p| *p - shift).flat_map(|p| [p.x as f32, p.y as f32]));
            }
            Shape::Radial(circles) => {
                shading.shading_type(FunctionShadingType::Radial);
                let circles = circles.iter().map(|(c, r)| (*c - shift, *r));
                shading.coords(circles.flat_map(|(c, r)| [c.x, c.y, r].map(|v| v as f32)));
            }
            Shape::Mesh(_) => {}
        }
        shading.pair(Name(b"ColorSpace"), space);
        shading.extend([true, true]).function(function);
        shading.finish();
        object
    }
}

/// Adds a mesh of Coons patches, with some components of the colours, as a pattern.
fn mesh(
    file: &mut File<'_>,
    to_start: Affine,
    patches: &[MeshPatch],
    components: Range<usize>,
    space: Name<'_>,
) -> Ref {
    let points = patches.iter().flat_map(|p| p.0);
    let bounds = points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b)).unwrap_or_default();
    // Coordinates are counted from the corner, in whole numbers of 32 bits.
    let share = |v: f64, size: f64| if size > 0.0 { ((v / size) * f64::from(u32::MAX)).round() as u32 } else { 0 };
    let mut data = Vec::new();
    for (points, colors) in patches {
        // This patch shares no side with the one before.
        data.push(0);
        for p in points {
            data.extend(share(p.x - bounds.x0, bounds.width()).to_be_bytes());
            data.extend(share(p.y - bounds.y0, bounds.height()).to_be_bytes());
        }
        for level in colors.iter().flat_map(|c| &c[components.clone()]) {
            data.extend(((level * f64::from(u16::MAX)).round() as u16).to_be_bytes());
        }
    }
    let [shading, object] = [file.new_ref(), file.new_ref()];
    let bytes = deflated(&data);
    let mut out = file.pdf.stream_shading(shading, &bytes);
    out.filter(Filter::FlateDecode);
    out.shading_type(StreamShadingType::CoonsPatch).pair(Name(b"ColorSpace"), space);
    out.bits_per_coordinate(32).bits_per_component(16).bits_per_flag(8);
    let sides = [0.0, bounds.width() as f32, 0.0, bounds.height() as f32];
    out.decode(sides.into_iter().chain(components.flat_map(|_| [0.0, 1.0])));
    out.finish();
    let mut pattern = file.pdf.shading_pattern(object);
    pattern.matrix(matrix(to_start * Affine::translate(bounds.origin().to_vec2())));
    pattern.shading_ref(shading);
    pattern.finish();
    object
}

/// Returns the corners of an area in the coordinates of a gradient; `None` if the gradient has no area.
fn corners(transform: Affine, area: Rect) -> Option<[Point; 4]> {
    let back = transform.inverse();
    let all = [(area.x0, area.y0), (area.x1, area.y0), (area.x1, area.y1), (area.x0, area.y1)];
    back.is_finite().then(|| all.map(|p| back * Point::from(p)))
}

/// Returns the range of whole periods of a repeating axis from `p` to `q` that covers these points.
fn periods_of_line(p: Point, q: Point, points: [Point; 4]) -> (i32, i32) {
    let axis: Vec2 = q - p;
    let offsets = points.map(|c| (c - p).dot(axis) / axis.hypot2());
    let half = f64::from(MAX_PERIODS / 2);
    let first = offsets.iter().copied().fold(f64::INFINITY, f64::min).floor().clamp(-half, half - 1.0);
    let last = offsets.into_iter().fold(f64::NEG_INFINITY, f64::max).ceil();
    (first as i32, last.clamp(first + 1.0, half.max(first + 1.0)) as i32)
}

/// Returns the stops of all periods, with offsets over the whole range.
fn stops(stops: &[Stop], spread: SpreadMethod, (first, last): (i32, i32)) -> Vec<(f64, [f32; 3], f32)> {
    let one = |s: &Stop| {
        let c = s.color();
        let color = [c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0);
        (f64::from(s.offset().get()), color, s.opacity().get())
    };
    let mut period: Vec<(f64, [f32; 3], f32)> = stops.iter().map(one).collect();
    // The colour does not change before the first stop and after the last.
    if let (Some(a), Some(z)) = (period.first().copied(), period.last().copied()) {
        period.insert(0, (0.0, a.1, a.2));
        period.push((1.0, z.1, z.2));
    }
    let mut out = Vec::new();
    let span = f64::from(last - first);
    for index in first..last {
        let offset = |at: f64| (f64::from(index - first) + at) / span;
        if spread == SpreadMethod::Reflect && index.rem_euclid(2) == 1 {
            out.extend(period.iter().rev().map(|(at, color, opacity)| (offset(1.0 - at), *color, *opacity)));
        } else {
            out.extend(period.iter().map(|(at, color, opacity)| (offset(*at), *color, *opacity)));
        }
    }
    out
}

/// Adds the function that interpolates these stops.
fn add_function(file: &mut File<'_>, stops: &[(f64, Vec<f32>)]) -> Ref {
    let span = 1.0 / stops.len().max(1) as f64;
    let pairs = stops.iter().zip(stops.iter().skip(1));
    let mut pieces: Vec<[(f64, Vec<f32>); 2]> =
        pairs.filter(|(a, b)| b.0 - a.0 > SHARP * span).map(|(a, b)| [a.clone(), b.clone()]).collect();
    // The colours at the very ends extend outside, even if a sharp change follows at once.
    if let (Some(first), Some([start, _])) = (stops.first(), pieces.first_mut())
        && first.1 != start.1
    {
        start.0 = EDGE;
        pieces.insert(0, [(0.0, first.1.clone()), (EDGE, first.1.clone())]);
    }
    if let (Some(last), Some([_, end])) = (stops.last(), pieces.last_mut())
        && last.1 != end.1
    {
        end.0 = 1.0 - EDGE;
        pieces.push([(1.0 - EDGE, last.1.clone()), (1.0, last.1.clone())]);
    }
    let mut refs = Vec::with_capacity(pieces.len());
    for [(_, from), (_, to)] in &pieces {
        let piece = file.new_ref();
        let mut f = file.pdf.exponential_function(piece);
        f.domain([0.0, 1.0]).c0(from.iter().copied()).c1(to.iter().copied()).n(1.0);
        refs.push(piece);
    }
    if let [only] = refs.as_slice() {
        return *only;
    }
    let function = file.new_ref();
    let mut f = file.pdf.stitching_function(function);
    f.domain([0.0, 1.0]).functions(refs.iter().copied());
    f.bounds(pieces.iter().skip(1).map(|[(start, _), _]| *start as f32));
    f.encode(refs.iter().flat_map(|_| [0.0, 1.0]));
    function
}
