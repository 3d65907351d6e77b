//! `--preview`: the artwork with its guides beside the result.

use crate::bitmap::encode;
use crate::failure::Failure;
use crate::format::{Choice, PICTURES};
use pathwarp::deform::Role;
use pathwarp::kurbo::{Rect, Shape};
use pathwarp::recipe::BuiltParts;
use pathwarp_raster::{OverlayKind, Panel, Preview, PreviewOverlay};
use pathwarp_svg::{Document, ReadOptions, Selection, usvg_tree};
use std::path::Path;

/// The formats of previews.
pub(crate) const PREVIEW: Choice<'_> = Choice { what: "a preview is", among: PICTURES };

/// Draws the picture for a file, with a quality if it is a JPEG. Bases are drawn over the source; targets and cages over the
/// result.
pub(super) fn draw(
    doc: &Document,
    warped: &str,
    built: &BuiltParts,
    read: &ReadOptions,
    (file, quality): (&Path, Option<u8>),
) -> Result<Vec<u8>, Failure> {
    let format = PREVIEW.format(Some(file), None)?;
    let after = Document::read(warped.as_bytes(), "the result", read)?;
    let mut left = Panel::new(usvg_tree::tree(doc), doc.user_to_px(), doc.view_box());
    let mut right = Panel::new(usvg_tree::tree(&after), after.user_to_px(), after.view_box());
    let everything = Selection::default();
    // The view holds all artwork, including what the warp moved off the page.
    let artwork = [doc, &after].into_iter().filter_map(|d| d.artwork_box(&everything));
    let whole = &built.whole;
    let guides = whole.steps.iter().flat_map(|s| s.explanation.overlays.iter().map(|o| o.path.bounding_box()));
    let seen = artwork.chain(guides).filter(Rect::is_finite);
    let view = seen.fold(doc.view_box().union(after.view_box()), |all, r| all.union(r));
    for (i, step) in whole.steps.iter().enumerate() {
        let at = |end: fn(&[usize]) -> Option<&usize>| built.parts.iter().any(|p| end(&p.indices) == Some(&i));
        let (is_first, is_last) = (at(<[usize]>::first), at(<[usize]>::last));
        let has_target = step.explanation.overlays.iter().any(|o| o.role == Role::Target);
        for o in &step.explanation.overlays {
            // The guides of a middle step lie in a plane that neither panel shows. A cage whose result goes to a target is
            // only a pattern, so it is drawn over the source.
            let (panel, kind) = match o.role {
                Role::Base if is_first => (&mut left, OverlayKind::Base),
                Role::Cage if is_first && has_target => (&mut left, OverlayKind::Cage),
                Role::Cage if is_last => (&mut right, OverlayKind::Cage),
                Role::Target if is_last => (&mut right, OverlayKind::Target),
                _ => continue,
            };
            *panel = panel.clone().with(PreviewOverlay::new(kind, o.path.clone()));
        }
    }
    encode(Preview::new(left, right).view(view).render_within(&doc.budget().limits())?, format, quality)
}
