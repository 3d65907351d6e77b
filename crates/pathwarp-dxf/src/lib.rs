//! Writes outlines as DXF, the format that laser cutters, plotters and CAD programs read.
//!
//! Lines, circles and circular arcs are exact: `LINE`, `CIRCLE`, `ARC`, or an `LWPOLYLINE` where they follow one another.
//! Ellipses and their arcs are exact `ELLIPSE`s, Bézier curves exact `SPLINE`s of degree 3, split at corners. For programs that
//! know no splines, [`Curves::Polylines`] makes every subpath one `LWPOLYLINE` within a tolerance.
//!
//! Files are of version AC1018 (AutoCAD 2004), the first with true colours: plain text with characters beyond ASCII escaped.
//! The unit is the millimetre. They hold neither dates nor random ids: the same outlines always give the same text.
//!
//! Source: Autodesk, *DXF Reference* (2011).
//!
//! ```
//! use pathwarp::Outline;
//! use pathwarp_dxf::{Options, Shape, write};
//!
//! let outline = Outline::from_svg("M0,0 H50 V20 A10,10 0 0 1 40,30 H0 Z").unwrap();
//! let dxf = write(&[Shape { layer: "cut", color: Some([255, 0, 0]), outline: &outline }], &Options::default())?;
//! assert!(dxf.contains("LWPOLYLINE"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod entities;
mod file;

use entities::Pen;
use file::{Codes, Layers};
use pathwarp::Outline;
use pathwarp::budget::{Budget, Exceeded, Limits, cost};

/// Returns a DXF file with the outlines of these shapes.
///
/// # Errors
/// Polylines within the tolerance have more segments than the limits allow.
pub fn write(shapes: &[Shape<'_>], options: &Options) -> Result<String, Exceeded> {
    let layers = Layers::of(shapes);
    if options.curves == Curves::Polylines {
        let segs = shapes.iter().flat_map(|s| s.outline.segs());
        let lines: f64 = segs.map(|s| entities::most_lines(s, options.tolerance)).sum();
        Budget::new(options.limits).spend(cost::SEGMENT * lines)?;
    }
    let mut out = Codes::new();
    file::start(&mut out, &layers, options);
    for shape in shapes {
        let pen = Pen { layer: layers.name(shape.layer), color: shape.color };
        for subpath in &shape.outline.subpaths {
            match options.curves {
                Curves::Splines => entities::exact(&mut out, &pen, subpath, options.tolerance),
                Curves::Polylines => entities::polyline(&mut out, &pen, subpath, options.tolerance),
            }
        }
    }
    Ok(file::finish(out))
}

/// An outline with its layer and colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape<'a> {
    /// Name of the layer. Characters that DXF forbids become underscores; names that differ only in case are one layer.
    pub layer: &'a str,
    /// Red, green and blue; `None`: the colour of the layer, black or white by the background.
    pub color: Option<[u8; 3]>,
    /// The outline in millimetres, x to the right and y up.
    pub outline: &'a Outline,
}

/// The form of Bézier curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Curves {
    /// Exact splines of degree 3.
    #[default]
    Splines,
    /// Polylines, one for every subpath.
    Polylines,
}

/// Options for writing a DXF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The form of Bézier curves.
    pub curves: Curves,
    /// Largest distance of polylines from curves, in mm. Arcs that are this close to circular ones, within a tenth, are written as
    /// such.
    pub tolerance: f64,
    /// Width and height of the page in mm.
    pub page: [f64; 2],
    /// Limits on the number of segments.
    pub limits: Limits,
}

impl Default for Options {
    /// Splines on an A4 page, with a tolerance of 0.01 mm.
    fn default() -> Self {
        Self { curves: Curves::Splines, tolerance: 0.01, page: [210.0, 297.0], limits: Limits::default() }
    }
}
