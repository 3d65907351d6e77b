//! A part to be warped, with everything that determines its image.

use super::arcs::with_arcs;
use super::letters::{LetterPiece, placed};
use super::options::WarpOptions;
use super::stubs;
use crate::scene::affine::stretch;
use crate::scene::model::Part;
use crate::source::number::{MOST_DECIMALS, arcs_data};
use pathwarp::kurbo::{Affine, BezPath};
use pathwarp::map::Map;
use pathwarp::refit::{self, KnownShapes, PathReport};
use pathwarp::{GeometryError, Outline};
use std::sync::Arc;

/// The fraction of the tolerance that rounding may use.
pub(super) const ROUNDING: f64 = 0.01;

/// The number of decimals of coordinates: as given, or enough for [`ROUNDING`]. A unit as written is `size` units of root user
/// space.
pub(super) fn decimals(size: f64, tolerance: f64, given: Option<u8>) -> u8 {
    given.unwrap_or_else(|| {
        let needed = (size * std::f64::consts::FRAC_1_SQRT_2 / (ROUNDING * tolerance)).log10().ceil();
        if needed.is_finite() { needed.clamp(0.0, f64::from(MOST_DECIMALS)) as u8 } else { MOST_DECIMALS }
    })
}

/// Largest error from rounding to `decimals`, in root user units.
pub(super) fn rounding(size: f64, decimals: u8) -> f64 {
    size * std::f64::consts::FRAC_1_SQRT_2 * 0.1_f64.powi(i32::from(decimals))
}

/// The tolerance less the room for rounding.
pub(super) fn allowed(tolerance: f64, rounding: f64) -> f64 {
    (tolerance - rounding).max(0.5 * tolerance)
}

/// The surroundings of a part.
#[derive(Clone, Copy)]
pub(super) struct PartContext<'a> {
    pub(super) map: &'a dyn Map,
    pub(super) options: &'a WarpOptions,
    /// Shapes that come again in the drawing.
    pub(super) known: &'a KnownShapes,
    /// Root user space to px.
    pub(super) to_px: Affine,
    /// Number of gradients in the drawing that may become pictures.
    pub(super) gradients: usize,
    /// Largest width of a hairline, in root user units; 0 if the page is not measured in physical units.
    pub(super) hairline: f64,
}

/// The image of an outline in the part's user space as written.
pub(super) struct BentPath {
    pub(super) path: BezPath,
    /// The text of the path if it has arcs, which `path` approximates.
    pub(super) data: Option<String>,
    pub(super) report: PathReport,
}

/// A part to be warped.
pub(super) struct PartTask<'a> {
    pub(super) part: &'a Part,
    pub(super) context: &'a PartContext<'a>,
    /// From the part's user space as written to root user space.
    pub(super) write: Affine,
    /// From root user space to the part's user space as written.
    pub(super) back: Affine,
    /// The placed letters of the part.
    pub(super) pieces: &'a [LetterPiece],
    /// The part's outline in root user space.
    pub(super) whole: Arc<Outline>,
    /// The outline to bend: all copies, or the placed letters.
    pub(super) outline: Arc<Outline>,
    /// The map that bends `outline`.
    pub(super) map: &'a dyn Map,
    pub(super) decimals: u8,
    /// Largest error from rounding, in root user units.
    pub(super) rounding: f64,
}

impl<'a> PartTask<'a> {
    /// `whole` is the part's outline in root user space.
    pub(super) fn new(
        part: &'a Part,
        whole: Arc<Outline>,
        write: Affine,
        context: &'a PartContext<'a>,
        pieces: &'a [LetterPiece],
    ) -> Self {
        let options = context.options;
        // Placed letters skip the first step; everything else goes through the whole map.
        let (mut outline, map): (Arc<Outline>, &dyn Map) = match (pieces, options.copies.as_slice()) {
            ([], []) => (whole.clone(), context.map),
            ([], copies) => (Arc::new(whole.repeated(copies)), context.map),
            _ => (Arc::new(placed(&whole, pieces)), &options.letters.after),
        };
        let size = stretch(write);
        let tolerance = options.refit.tolerance;
        let decimals = decimals(size, tolerance, options.precision);
        let rounding = rounding(size, decimals);
        if outline.subpaths.iter().any(|s| stubs::has_closing_stub(s, rounding)) {
            let subpaths = &mut Arc::make_mut(&mut outline).subpaths;
            subpaths.iter_mut().for_each(|s| stubs::drop_closing_stub(s, rounding));
        }
        Self { part, context, write, back: write.inverse(), pieces, whole, outline, map, decimals, rounding }
    }

    pub(super) fn options(&self) -> &'a WarpOptions {
        self.context.options
    }

    /// Bends an outline.
    pub(super) fn bend(&self, outline: &Outline) -> Result<BentPath, GeometryError> {
        let options = self.options().refit.clone().with_tolerance(self.allowed());
        if let Some((image, report)) = with_arcs(self.map, outline, &options)? {
            let image = if self.back == Affine::IDENTITY { image } else { image.transformed(self.back) };
            let fine = ROUNDING * self.allowed() / stretch(self.write).max(f64::MIN_POSITIVE);
            let data = arcs_data(&image, self.decimals);
            return Ok(BentPath { path: image.to_bez_path(fine), data: Some(data), report });
        }
        self.bend_with(outline, &options)
    }

    /// Bends the part's outline for measures of it. Merging would take most of the time.
    pub(super) fn draft(&self) -> Result<BentPath, GeometryError> {
        let options = self.options().refit.clone().with_tolerance(self.allowed());
        self.bend_with(&self.outline, &options.with_merge(false).with_certify(false))
    }

    fn bend_with(&self, outline: &Outline, options: &refit::Options) -> Result<BentPath, GeometryError> {
        let warped = self.context.known.warp_path(outline, self.map, options)?;
        Ok(BentPath { path: self.to_local(warped.path), data: None, report: warped.report })
    }

    /// The tolerance less the room for rounding.
    pub(super) fn allowed(&self) -> f64 {
        allowed(self.options().refit.tolerance, self.rounding)
    }

    /// Transforms a path from root user space to the part's user space as written.
    pub(super) fn to_local(&self, mut path: BezPath) -> BezPath {
        if self.back != Affine::IDENTITY {
            path.apply_affine(self.back);
        }
        path
    }
}
