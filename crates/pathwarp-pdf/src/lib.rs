//! Writes a resolved SVG drawing as a PDF of one page.
//!
//! Shapes, strokes, gradients, patterns, clip paths, masks, opacity and blend modes become their counterparts in PDF. Letters are written
//! as outlines, and JPEG images byte for byte. Only groups with filters become pictures, as PDF has no filters. The page has the physical
//! size of the drawing: 1 px is ¾ pt.
//!
//! The output holds neither dates nor random ids: the same drawing always gives the same bytes.
//!
//! ```
//! let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="210mm" height="297mm"><circle cx="90" cy="90" r="40"/></svg>"#;
//! let tree = usvg::Tree::from_str(svg, &usvg::Options::default())?;
//! let written = pathwarp_pdf::write(&tree, &pathwarp_pdf::Options::default())?;
//! assert!(written.bytes.starts_with(b"%PDF-1.7"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod file;
mod gradient;
mod group;
mod image;
mod options;
mod paint;
mod stream;

pub use options::{ExactOutline, MeshOf, MeshPatch, Options, Spot, SpotOf};
pub use pathwarp_raster::Error;

use file::File;
use kurbo::Affine;
use pdf_writer::{Name, Rect, TextStr};
use stream::Stream;

/// Points per px. An inch is 72 points or 96 px.
const POINTS_PER_PX: f64 = 0.75;

/// Longest side of a page in its units (PDF 32000-1, annex C.2). The unit of a larger page is a multiple of a point.
const MAX_SIDE: f64 = 14_400.0;

/// A PDF.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The file.
    pub bytes: Vec<u8>,
    /// Number of groups that became pictures because of a filter.
    pub pictures: usize,
    /// Number of these pictures that have fewer pixels than requested, to stay within the limits.
    pub coarser: usize,
}

/// Writes a drawing as a PDF of one page.
///
/// # Errors
/// [`Error::TooLarge`] and [`Error::TooMuch`] when its pictures exceed the limits; other variants when the renderer fails on a filter.
pub fn write(tree: &usvg::Tree, options: &Options<'_>) -> Result<Written, Error> {
    let mut file = File::new(options);
    let [catalog, pages, page, info, content] = [(); 5].map(|()| file.new_ref());
    let (width, height) = (f64::from(tree.size().width()), f64::from(tree.size().height()));
    let unit = (width.max(height) * POINTS_PER_PX / MAX_SIDE).ceil().max(1.0);
    let scale = POINTS_PER_PX / unit;

    let mut stream = Stream::new();
    stream.transform(Affine::new([scale, 0.0, 0.0, -scale, 0.0, height * scale]));
    group::draw(&mut file, &mut stream, tree.root());
    let (bytes, used) = stream.finish();
    file.compressed(content, &bytes);

    file.pdf.catalog(catalog).pages(pages);
    file.pdf.document_info(info).producer(TextStr("pathwarp"));
    file.pdf.pages(pages).kids([page]).count(1);
    let mut out = file.pdf.page(page);
    out.parent(pages).media_box(Rect::new(0.0, 0.0, (width * scale) as f32, (height * scale) as f32)).contents(content);
    if unit > 1.0 {
        out.user_unit(unit as f32);
    }
    used.write(&mut out.resources());
    let mut blending = out.group();
    blending.transparency().isolated(true).pair(Name(b"CS"), Name(b"DeviceRGB"));
    drop(blending);
    drop(out);
    match file.failed.take() {
        Some(e) => Err(e),
        None => Ok(Written { pictures: file.pictures, coarser: file.coarser, bytes: file.pdf.finish() }),
    }
}
