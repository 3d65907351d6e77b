//! Estimates the work of rendering a drawing beforehand: pixels painted, pixels held, and how far geometry extends.
//!
//! The renderer, resvg 0.49 (<https://github.com/linebender/resvg/tree/v0.49.0/crates/resvg>), has no limits. It paints
//! every isolated group, mask and filter on layers that may be larger than the picture, evaluates filters at any size, decodes
//! pictures of any stated size, and aborts on coordinates that its fixed-point numbers cannot hold.
//!
//! A unit of work is the time to composite a pixel with a little arithmetic.

use crate::error::Error;
use crate::picture::header_size;
use pathwarp::budget::{Budget, Exceeded, Limit, Limits, cost};
use std::collections::HashMap;
use std::sync::Arc;
use tiny_skia::{PathSegment, Rect, Transform};
use usvg::filter::Kind;
use usvg::{Group, ImageKind, LineCap, LineJoin, Node, Paint, Stroke};

/// Largest distance of geometry from the picture's origin, in pixels, including stroke widths. The renderer's edges hold 16 bits
/// before the point after clipping, and its clipping breaks down from about 1e9 on.
pub(crate) const MAX_COORDINATE: f32 = 1e8;

/// The renderer's layers extend up to twice the picture's size past it on every side.
const LAYER_REACH: f32 = 2.0;

/// Work for a pixel of a layer.
const LAYER: f64 = 4.0;
/// Work for a pixel of a gradient, and for each stop, since the renderer checks them all for each pixel.
const GRADIENT: f64 = 2.0;
const STOP: f64 = 0.03;
/// Work for a pixel of an interpolated picture, and for one that is decoded.
const BICUBIC: f64 = 8.0;
const DECODED: f64 = 4.0;
/// Work for a pixel of a filter's primitive, and more for a blur, lighting, an octave of turbulence, and a pixel in the window of
/// `feMorphology`.
const PRIMITIVE: f64 = 6.0;
const BLURRED: f64 = 20.0;
const LIT: f64 = 20.0;
const OCTAVE: f64 = 24.0;
const WINDOW: f64 = 0.4;
/// Work for a path.
const PATH: f64 = 50.0;
/// Work for a dash.
const DASH: f64 = 200.0;

/// Bytes of a pixel.
const PIXEL_BYTES: f64 = 4.0;

/// Further octaves of turbulence change no colour of eight bits, and overflow in the renderer.
const MAX_OCTAVES: u32 = 24;

/// Charges `budget` for drawing a group with `transform` on a picture of `width` × `height` pixels.
///
/// # Errors
/// [`Error::TooMuch`] when the work or memory exceeds the limits, [`Error::TooFar`] when geometry extends too far, [`Error::Octaves`].
pub(crate) fn charge_group(
    group: &Group,
    transform: Transform,
    [width, height]: [f32; 2],
    budget: &Budget,
) -> Result<(), Error> {
    let mut load = Load { limits: budget.limits(), work: 0.0, sizes: HashMap::new() };
    let held = f64::from(width) * f64::from(height);
    load.group(group, transform, &Canvas { width, height, held })?;
    Ok(budget.spend(cost::PIXEL * load.work)?)
}

/// The surface to paint on.
#[derive(Clone, Copy)]
struct Canvas {
    width: f32,
    height: f32,
    /// Pixels held by this surface and all below it.
    held: f64,
}

impl Canvas {
    /// Width and height, in pixels, of the part of a box on the canvas and up to `reach` times its size past it on every side.
    fn clipped_size(&self, r: Rect, reach: f32) -> [f64; 2] {
        let side = |start: f32, end: f32, size: f32| {
            let (min, max) = (-reach * size, (1.0 + reach) * size);
            f64::from(end.min(max) - start.max(min)).max(0.0)
        };
        [side(r.left(), r.right(), self.width), side(r.top(), r.bottom(), self.height)]
    }
}

/// The work of a drawing, added up. Counting is cut short where it exceeds the limit.
struct Load {
    limits: Limits,
    work: f64,
    /// Sizes of pictures by the address of their data.
    sizes: HashMap<usize, f64>,
}

impl Load {
    fn add(&mut self, work: f64) -> Result<(), Error> {
        self.work += work;
        Ok(self.limits.check(Limit::Work, cost::PIXEL * self.work).map_err(Exceeded::cut_short)?)
    }

    /// Adds a surface of `area` pixels to those held. Callers count a mask, which takes one byte for a pixel, as a quarter of its area.
    fn hold(&self, canvas: &Canvas, area: f64) -> Result<Canvas, Error> {
        let held = canvas.held + area;
        self.limits.check(Limit::Memory, PIXEL_BYTES * held)?;
        Ok(Canvas { held, ..*canvas })
    }

    fn group(&mut self, group: &Group, outer: Transform, canvas: &Canvas) -> Result<(), Error> {
        let transform = outer.pre_concat(group.transform());
        if !group.should_isolate() {
            return group.children().iter().try_for_each(|node| self.node(node, transform, canvas));
        }
        let Some(bounds) = group.layer_bounding_box().to_rect().transform(transform) else { return Ok(()) };
        let [w, h] = canvas.clipped_size(bounds, LAYER_REACH);
        let area = w * h;
        self.add(LAYER * area)?;
        let layer = self.hold(canvas, area)?;
        group.children().iter().try_for_each(|node| self.node(node, transform, &layer))?;
        for f in group.filters() {
            self.filter(f, transform, area, &layer)?;
        }
        if let Some(clip) = group.clip_path() {
            self.clip(clip, transform, area, &layer)?;
        }
        if let Some(mask) = group.mask() {
            self.mask(mask, transform, area, &layer)?;
        }
        Ok(())
    }

    fn node(&mut self, node: &Node, transform: Transform, canvas: &Canvas) -> Result<(), Error> {
        match node {
            Node::Group(g) => self.group(g, transform, canvas),
            Node::Text(t) => self.group(t.flattened(), transform, canvas),
            Node::Path(p) => self.path(p, transform, canvas),
            Node::Image(i) if i.is_visible() => self.image(i.kind(), i.bounding_box(), transform, canvas),
            Node::Image(_) => Ok(()),
        }
    }

    fn path(&mut self, path: &usvg::Path, transform: Transform, canvas: &Canvas) -> Result<(), Error> {
        if !path.is_visible() {
            return Ok(());
        }
        let bounds = path.stroke_bounding_box().transform(transform).filter(is_near).ok_or(Error::TooFar)?;
        let ([w, h], picture) = (canvas.clipped_size(bounds, 0.0), [canvas.width, canvas.height]);
        let edges = Edges::of_fill(path.data(), transform, picture);
        if let Some(fill) = path.fill() {
            self.add(w * h * paint_work(fill.paint()) + edges.work([w, h]))?;
            self.pattern(fill.paint(), transform, canvas)?;
        }
        if let Some(stroke) = path.stroke() {
            let scale = f64::from(transform.sx.hypot(transform.ky).max(transform.kx.hypot(transform.sy)));
            let width = f64::from(stroke.width().get()) * scale;
            if width > f64::from(MAX_COORDINATE) {
                return Err(Error::TooFar);
            }
            let edges = edges.stroked(path.data().len(), stroke, width, picture);
            self.add(w * h * paint_work(stroke.paint()) + edges.work([w, h]))?;
            if let Some(dashes) = stroke.dasharray() {
                self.add(DASH * dashes_along(path.data(), dashes))?;
            }
            self.pattern(stroke.paint(), transform, canvas)?;
        }
        self.add(PATH)
    }

    /// Adds the tile of a pattern, which the renderer paints anew for every shape.
    fn pattern(&mut self, paint: &Paint, transform: Transform, canvas: &Canvas) -> Result<(), Error> {
        let Paint::Pattern(pattern) = paint else { return Ok(()) };
        let (sx, sy) = transform.pre_concat(pattern.transform()).get_scale();
        let rect = pattern.rect();
        let (width, height) = (rect.width() * sx, rect.height() * sy);
        let area = f64::from(width) * f64::from(height);
        self.add(LAYER * area)?;
        let held = self.hold(canvas, area)?.held;
        self.group(pattern.root(), Transform::from_scale(sx, sy), &Canvas { width, height, held })
    }

    /// Adds an image: a drawing, or a picture that is decoded.
    fn image(&mut self, kind: &ImageKind, bounds: Rect, transform: Transform, canvas: &Canvas) -> Result<(), Error> {
        let data = match kind {
            ImageKind::SVG(tree) => {
                let area = f64::from(canvas.width) * f64::from(canvas.height);
                self.add(2.0 * LAYER * area)?;
                let inner = self.hold(canvas, area)?;
                return self.group(tree.root(), transform, &inner);
            }
            ImageKind::JPEG(d) | ImageKind::PNG(d) | ImageKind::GIF(d) | ImageKind::WEBP(d) => d,
        };
        let limits = &mut self.limits;
        let pixels = *self.sizes.entry(Arc::as_ptr(data) as usize).or_insert_with(|| {
            // The renderer skips pictures that it cannot decode.
            let pixels = header_size(data).map_or(0.0, |(w, h)| f64::from(w) * f64::from(h));
            // The size was checked when the picture was read, so that the limits grow by the picture and the decoder's buffer.
            *limits = limits.for_pixels(2.0 * pixels);
            pixels
        });
        // The decoder's buffer becomes the picture, or is copied to it.
        self.hold(canvas, 2.0 * pixels)?;
        let [w, h] = bounds.transform(transform).map_or([0.0; 2], |b| canvas.clipped_size(b, 0.0));
        self.add(DECODED * pixels + BICUBIC * w * h)
    }

    fn clip(&mut self, clip: &usvg::ClipPath, transform: Transform, area: f64, canvas: &Canvas) -> Result<(), Error> {
        self.add(LAYER * area)?;
        let inner = self.hold(canvas, 1.25 * area)?;
        self.clipped(clip.root(), transform.pre_concat(clip.transform()), area, &inner)?;
        clip.clip_path().map_or(Ok(()), |clip| self.clip(clip, transform, area, &inner))
    }

    /// Adds the content of a clip path, whose groups are not isolated, but may be clipped in turn.
    fn clipped(&mut self, group: &Group, outer: Transform, area: f64, canvas: &Canvas) -> Result<(), Error> {
        let transform = outer.pre_concat(group.transform());
        let mut surface = *canvas;
        if let Some(clip) = group.clip_path() {
            self.add(LAYER * area)?;
            surface = self.hold(canvas, area)?;
            self.clip(clip, transform, area, &surface)?;
        }
        group.children().iter().try_for_each(|n| match n {
            Node::Group(group) => self.clipped(group, transform, area, &surface),
            Node::Text(t) => self.clipped(t.flattened(), transform, area, &surface),
            Node::Path(p) => self.path(p, transform, &surface),
            Node::Image(_) => Ok(()),
        })
    }

    fn mask(&mut self, mask: &usvg::Mask, transform: Transform, area: f64, canvas: &Canvas) -> Result<(), Error> {
        self.add(2.0 * LAYER * area)?;
        let inner = self.hold(canvas, 1.25 * area)?;
        self.group(mask.root(), transform, &inner)?;
        mask.mask().map_or(Ok(()), |mask| self.mask(mask, transform, area, &inner))
    }

    /// Adds a filter on a layer of `area` pixels. Each primitive holds its result until the filter is done, and a copy of its input.
    fn filter(
        &mut self,
        filter: &usvg::filter::Filter,
        transform: Transform,
        area: f64,
        canvas: &Canvas,
    ) -> Result<(), Error> {
        let (sx, sy) = transform.get_scale();
        let mut layer = *canvas;
        for primitive in filter.primitives() {
            layer = self.hold(&layer, 2.0 * area)?;
            let offset = match primitive.kind() {
                Kind::Offset(o) => [o.dx() * sx, o.dy() * sy],
                Kind::DropShadow(s) => [s.dx() * sx, s.dy() * sy],
                _ => [0.0; 2],
            };
            // The renderer computes the end of a shifted picture in 32 bits.
            if !offset.iter().all(|v| v.abs() <= MAX_COORDINATE) {
                return Err(Error::TooFar);
            }
            let extra = match primitive.kind() {
                Kind::Turbulence(t) if t.num_octaves() > MAX_OCTAVES => return Err(Error::Octaves(t.num_octaves())),
                Kind::Turbulence(t) => OCTAVE * f64::from(t.num_octaves()),
                Kind::Morphology(m) => {
                    let side = |radius: f32, scale: f32| 2.0 * f64::from(radius * scale) + 1.0;
                    let window = side(m.radius_x().get(), sx) * side(m.radius_y().get(), sy);
                    WINDOW * window.min(area)
                }
                Kind::ConvolveMatrix(c) => f64::from(c.matrix().columns()) * f64::from(c.matrix().rows()),
                Kind::GaussianBlur(_) | Kind::DropShadow(_) => BLURRED,
                Kind::Merge(m) => LAYER * m.inputs().len() as f64,
                Kind::DiffuseLighting(_) | Kind::SpecularLighting(_) => LIT,
                Kind::Image(i) => {
                    self.group(i.root(), transform, &layer)?;
                    0.0
                }
                _ => 0.0,
            };
            self.add((PRIMITIVE + extra) * area)?;
        }
        Ok(())
    }
}

/// Work for a pixel of a paint.
fn paint_work(paint: &Paint) -> f64 {
    match paint {
        Paint::Color(_) => 1.0,
        Paint::LinearGradient(g) => GRADIENT + STOP * g.stops().len() as f64,
        Paint::RadialGradient(g) => GRADIENT + STOP * g.stops().len() as f64,
        Paint::Pattern(_) => BICUBIC,
    }
}

/// Returns `true` if the renderer can handle these coordinates.
fn is_near(area: &Rect) -> bool {
    [area.left(), area.top(), area.right(), area.bottom()].iter().all(|v| v.abs() <= MAX_COORDINATE)
}

/// Estimates the number of dashes along a path.
fn dashes_along(path: &tiny_skia::Path, dashes: &[f32]) -> f64 {
    let period: f64 = dashes.iter().map(|d| f64::from(*d)).sum();
    let length: f64 = path.points().windows(2).map(|p| f64::from(p[0].distance(p[1]))).sum();
    if period > 0.0 { (length / period) * dashes.len() as f64 } else { 0.0 }
}

/// Work for a row of pixels that an edge crosses, in four scan lines.
const CROSSED_ROW: f64 = 4.0;
/// Work for two edges in the same row, since they may cross.
const EDGE_PAIR: f64 = 0.4;
/// Work for an edge.
const EDGE: f64 = 10.0;

/// Edges of an outline, with the rows and columns that they cross.
struct Edges {
    count: f64,
    /// Sums over all edges, in pixels.
    rows: f64,
    columns: f64,
}

impl Edges {
    fn of_fill(path: &tiny_skia::Path, transform: Transform, [width, height]: [f32; 2]) -> Self {
        let mut edges = Self { count: 0.0, rows: 0.0, columns: 0.0 };
        // The renderer first cuts off the parts outside the picture.
        let clipped = |v: f32, size: f32| if v > 0.0 { f64::from(v.min(size)) } else { 0.0 };
        let pixel = |mut p: tiny_skia::Point| {
            transform.map_point(&mut p);
            [clipped(p.x, width), clipped(p.y, height)]
        };
        let (mut start, mut last) = ([0.0; 2], [0.0; 2]);
        for segment in path.segments() {
            // The control polygon crosses at least as many rows as the curve.
            match segment {
                PathSegment::MoveTo(p) => {
                    // Filling closes open subpaths.
                    edges.add(&[last, start]);
                    start = pixel(p);
                    last = start;
                    continue;
                }
                PathSegment::LineTo(p) => last = edges.add(&[last, pixel(p)]),
                PathSegment::QuadTo(a, p) => last = edges.add(&[last, pixel(a), pixel(p)]),
                PathSegment::CubicTo(a, b, p) => last = edges.add(&[last, pixel(a), pixel(b), pixel(p)]),
                PathSegment::Close => last = edges.add(&[last, start]),
            }
            edges.count += 1.0;
        }
        edges.add(&[last, start]);
        edges
    }

    /// Adds a polyline, and returns its end.
    fn add<const N: usize>(&mut self, polygon: &[[f64; 2]; N]) -> [f64; 2] {
        for p in polygon.windows(2) {
            self.columns += (p[1][0] - p[0][0]).abs();
            self.rows += (p[1][1] - p[0][1]).abs();
        }
        polygon[N - 1]
    }

    /// The edges of a stroke of `width` pixels along these edges: two sides, and a join or a cap at every node, which is as high as
    /// the stroke is wide.
    fn stroked(&self, nodes: usize, stroke: &Stroke, width: f64, picture: [f32; 2]) -> Self {
        let nodes = nodes as f64;
        let is_round = stroke.linejoin() == LineJoin::Round || stroke.linecap() == LineCap::Round;
        let (edges, crossings) = if is_round { (8.0, 4.0) } else { (2.0, 2.0) };
        let at_nodes = |size: f32| crossings * width.min(f64::from(size)) * nodes;
        Self {
            count: 2.0 * self.count + edges * nodes,
            rows: 2.0 * self.rows + at_nodes(picture[1]),
            columns: 2.0 * self.columns + at_nodes(picture[0]),
        }
    }

    /// The work of filling the outline, whose visible part has this width and height.
    fn work(&self, [width, height]: [f64; 2]) -> f64 {
        let edges_per_row = self.rows / height.max(1.0);
        // Two edges cross at most once, and only in a row that both reach, where their columns overlap.
        let overlap = (2.0 * self.columns / (self.count.max(1.0) * width.max(1.0))).min(1.0);
        EDGE * self.count + CROSSED_ROW * self.rows + EDGE_PAIR * self.count.min(self.rows) * edges_per_row * overlap
    }
}
