//! Draws images. A JPEG stays as it is; other bitmaps are stored without loss.

use crate::file::{File, deflated};
use crate::group;
use crate::stream::Stream;
use kurbo::{Affine, Rect};
use pathwarp::budget::cost;
use pathwarp_raster::{Error, Picture, Pixmap, header_size};
use pdf_writer::{Filter, Finish as _, Name, Ref};
use std::sync::Arc;
use usvg::{FillRule, Image, ImageKind, ImageRendering};

/// Draws an image.
pub(crate) fn draw(file: &mut File<'_>, stream: &mut Stream, image: &Image) {
    if !image.is_visible() {
        return;
    }
    let area = Rect::new(0.0, 0.0, f64::from(image.size().width()), f64::from(image.size().height()));
    let smooth = !matches!(
        image.rendering_mode(),
        ImageRendering::OptimizeSpeed | ImageRendering::Pixelated | ImageRendering::CrispEdges
    );
    let object = match image.kind() {
        ImageKind::SVG(tree) => {
            let size = Rect::new(0.0, 0.0, f64::from(tree.size().width()), f64::from(tree.size().height()));
            let object = file.group(size, stream.shift, |file, stream| {
                stream.clip(&kurbo::Shape::to_path(&size, 1.0), FillRule::NonZero);
                group::draw(file, stream, tree.root());
            });
            stream.object(object);
            return;
        }
        ImageKind::JPEG(data) | ImageKind::PNG(data) | ImageKind::GIF(data) | ImageKind::WEBP(data) => {
            embed(file, data, smooth)
        }
    };
    if let Some(object) = object {
        draw_over(stream, object, area);
    }
}

/// Returns the object of a picture, adding it if it is new.
fn embed(file: &mut File<'_>, data: &Arc<Vec<u8>>, smooth: bool) -> Option<Ref> {
    let key = (Arc::clone(data), smooth);
    if let Some(known) = file.embedded.get(&key) {
        return Some(*known);
    }
    let object = add_jpeg(file, data, smooth).or_else(|| add_pixels(file, data, smooth))?;
    file.embedded.insert(key, object);
    Some(object)
}

/// Draws a bitmap over an area.
pub(crate) fn draw_over(stream: &mut Stream, object: Ref, area: Rect) {
    // A bitmap fills the unit square, with its first row on top.
    let unit = Affine::new([area.width(), 0.0, 0.0, -area.height(), area.x0, area.y1]);
    stream.object_at(object, unit);
}

/// Adds the pixels of a picture as stored, not turned. If it cannot be decoded, it is not drawn, as in browsers; if too large, this fails.
fn add_pixels(file: &mut File<'_>, data: &[u8], smooth: bool) -> Option<Ref> {
    if file.failed.is_some() {
        return None;
    }
    let added = spend(file, header_size(data).ok()?, DECODING)
        .and_then(|()| Picture::read_stored_within(data, &file.options.limits.for_input(data.len())))
        .and_then(|picture| add_bitmap(file, &picture.pixmap, smooth));
    match added {
        Err(e @ (Error::TooLarge { .. } | Error::TooMuch(_))) => {
            file.failed = Some(e);
            None
        }
        other => other.ok(),
    }
}

/// Work of decoding a pixel, in pixels painted.
const DECODING: f64 = 4.0;
/// Work of compressing a pixel, in pixels painted.
const COMPRESSING: f64 = 20.0;

fn spend(file: &File<'_>, (width, height): (u32, u32), work: f64) -> Result<(), Error> {
    Ok(file.budget.spend(cost::PIXEL * work * f64::from(width) * f64::from(height))?)
}

/// Adds a bitmap, with its transparency if it has any.
pub(crate) fn add_bitmap(file: &mut File<'_>, pixmap: &Pixmap, smooth: bool) -> Result<Ref, Error> {
    let (width, height) = (pixmap.width(), pixmap.height());
    spend(file, (width, height), COMPRESSING)?;
    let mut colors = Vec::with_capacity(pixmap.pixels().len() * 3);
    let mut opacities = Vec::with_capacity(pixmap.pixels().len());
    for p in pixmap.pixels() {
        let c = p.demultiply();
        colors.extend([c.red(), c.green(), c.blue()]);
        opacities.push(c.alpha());
    }
    let mut add_plane = |bytes: &[u8], space: Name<'_>, mask: Option<Ref>| {
        let object = file.new_ref();
        let bytes = deflated(bytes);
        let mut out = file.pdf.image_xobject(object, &bytes);
        out.filter(Filter::FlateDecode);
        out.width(width as i32).height(height as i32).bits_per_component(8).interpolate(smooth);
        out.color_space_name(space);
        if let Some(mask) = mask {
            out.s_mask(mask);
        }
        object
    };
    let is_opaque = opacities.iter().all(|a| *a == u8::MAX);
    let mask = (!is_opaque).then(|| add_plane(&opacities, Name(b"DeviceGray"), None));
    Ok(add_plane(&colors, Name(b"DeviceRGB"), mask))
}

/// Adds a JPEG as it is, if it has one or three components of 8 bits. Others look different in PDF programs and in browsers.
fn add_jpeg(file: &mut File<'_>, data: &[u8], smooth: bool) -> Option<Ref> {
    let frame = JpegFrame::find(data)?;
    let space = match frame.components {
        1 => Name(b"DeviceGray"),
        3 => Name(b"DeviceRGB"),
        _ => return None,
    };
    let object = file.new_ref();
    let mut out = file.pdf.image_xobject(object, data);
    out.filter(Filter::DctDecode);
    out.width(frame.width.into()).height(frame.height.into()).bits_per_component(8).interpolate(smooth);
    out.color_space_name(space);
    out.finish();
    Some(object)
}

/// The header of a JPEG's frame (ISO 10918-1, B.2.2).
struct JpegFrame {
    width: u16,
    height: u16,
    components: u8,
}

impl JpegFrame {
    /// Finds a frame of 8 bits in a mode that PDF allows: baseline, extended or progressive.
    fn find(data: &[u8]) -> Option<Self> {
        let mut rest = data.strip_prefix(b"\xff\xd8")?;
        loop {
            let &[0xff, marker, high, low, ..] = rest else { return None };
            let length = usize::from(u16::from_be_bytes([high, low]));
            if matches!(marker, 0xc0..=0xc2) {
                let &[8, h1, h0, w1, w0, components, ..] = rest.get(4..)? else { return None };
                let [height, width] = [[h1, h0], [w1, w0]].map(u16::from_be_bytes);
                return (height > 0 && width > 0).then_some(Self { width, height, components });
            }
            rest = rest.get(2 + length..)?;
        }
    }
}
