//! Writes outlines as DXF, the format that laser cutters, plotters and CAD programs read.
//!
//! Every subpath is one entity, as cutters need it. Lines, circles and circular arcs are exact: `LINE`, `CIRCLE`, `ARC`, or an
//! `LWPOLYLINE` with bulges where they follow one another. An ellipse or an arc of one is an exact `ELLIPSE`. Any other subpath is a
//! `SPLINE` of degree 3 with triple knots at the joints, exact except for arcs in it. For programs without splines,
//! [`Curves::Polylines`] makes it an `LWPOLYLINE` within a tolerance. [`write_splines`] writes curves of any degree with weights.
//!
//! Files are of version AC1018 (AutoCAD 2004), the first with true colours: plain text with characters beyond ASCII escaped.
//! The unit is the millimetre. They hold neither dates nor random ids: equal outlines always give equal text.
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
mod model;

pub use model::{Curves, MAX_DEGREE, Options, Shape, Spline};

use entities::Pen;
use file::{Codes, Layers};
use pathwarp::Outline;
use pathwarp::budget::{Budget, Exceeded, cost};

/// Returns a DXF file with the outlines of these shapes.
///
/// # Errors
/// [`Exceeded`] when polylines within the tolerance have more segments than the limits allow.
pub fn write(shapes: &[Shape<'_>], options: &Options) -> Result<String, Exceeded> {
    let layers = Layers::from_shapes(shapes);
    if options.curves == Curves::Polylines {
        let subpaths = shapes.iter().flat_map(|s| &s.outline.subpaths);
        let segs = subpaths.flat_map(|s| s.segs.iter().map(|seg| (seg, options.tolerance_for(s))));
        let lines: f64 = segs.map(|(seg, tolerance)| entities::max_lines(seg, tolerance)).sum();
        Budget::new(options.limits).spend(cost::SEGMENT * lines)?;
    }
    let mut out = Codes::new();
    file::start(&mut out, &layers, options);
    for shape in shapes {
        let pen = Pen { layer: layers.name(shape.layer), color: shape.color };
        for subpath in &shape.outline.subpaths {
            let write = match options.curves {
                Curves::Splines => entities::exact,
                Curves::Polylines => entities::polyline,
            };
            write(&mut out, &pen, subpath, options.tolerance_for(subpath));
        }
    }
    Ok(file::finish(out))
}

/// Returns a DXF file with these curves, each an entity `SPLINE` with its degree, knots and weights.
#[must_use]
pub fn write_splines(splines: &[Spline<'_>]) -> String {
    let none = Outline::default();
    let shapes: Vec<Shape<'_>> =
        splines.iter().map(|s| Shape { layer: s.layer, color: None, outline: &none }).collect();
    let layers = Layers::from_shapes(&shapes);
    let mut out = Codes::new();
    file::start(&mut out, &layers, &Options::default());
    for s in splines {
        entities::nurbs(&mut out, &Pen { layer: layers.name(s.layer), color: None }, s);
    }
    file::finish(out)
}
