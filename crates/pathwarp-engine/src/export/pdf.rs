//! Drawings as PDF.

use super::exported::{Exported, counted};
use crate::failure::Failure;
use crate::options::CommonOptions;
use pathwarp_svg::Document;
use pathwarp_svg::usvg_tree::{self, ExactOutlines};

/// Writes the drawing as PDF.
pub(super) fn write(doc: &Document, options: &CommonOptions, _: Option<f64>) -> Result<Exported, Failure> {
    let (exact, spots) = (ExactOutlines::of(doc), doc.spots());
    let written = usvg_tree::with_stack(doc, || {
        let outline = |path: &_| exact.get(path).cloned();
        let mesh = |paint: &_, bounds| usvg_tree::mesh(doc, paint, bounds);
        let spot: &pathwarp_pdf::SpotOf<'_> = &|path| {
            let line = spots.get(path.id())?;
            Some(pathwarp_pdf::Spot { name: line.spot.clone()?, knockout: line.knockout })
        };
        let limits = doc.budget().limits();
        let options =
            pathwarp_pdf::Options { exact: &outline, mesh: &mesh, spot, picture_dpi: options.image_dpi, limits };
        Ok(pathwarp_pdf::write(usvg_tree::tree(doc), &options))
    })??;
    let (pictures, coarser) = (written.pictures, written.coarser);
    let warning = format!(
        "PDF has no filters: {} a filter {} a picture in it",
        counted(pictures, "group with", "groups with"),
        if pictures == 1 { "is" } else { "are" },
    );
    let less = format!(
        "{} fewer pixels than the resolution asks for, within the limits; --limit work and --limit memory raise them",
        counted(coarser, "of these pictures has", "of these pictures have")
    );
    let warnings = [(pictures > 0).then_some(warning), (coarser > 0).then_some(less)];
    Ok(Exported { bytes: written.bytes, warnings: warnings.into_iter().flatten().collect(), kerf: None })
}
