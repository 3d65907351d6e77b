//! Additional files: the picture of `--preview`, and the artwork on a surface in space as OBJ (a mesh of the filled shapes, or curves).

use crate::advice;
use crate::bitmap::encode;
use crate::failure::Failure;
use crate::format::{Choice, PICTURES};
use crate::options::CommonOptions;
use pathwarp::Outline;
use pathwarp::deform::Role;
use pathwarp::engine::BuiltParts;
use pathwarp::kurbo::{Affine, BezPath, Point};
use pathwarp::map::{Map, RationalBezier, exact_images};
use pathwarp::param::Frame;
use pathwarp::recipe::BuiltRecipe;
use pathwarp_raster::{OverlayKind, Panel, Preview, PreviewOverlay};
use pathwarp_solid::artwork::{self, NamedShape};
use pathwarp_svg::{Document, ReadOptions, Selection, WarpOptions, usvg_tree};
use std::path::{Path, PathBuf};

/// Longer side of a panel that shows nodes, in pixels.
const NODES_PANEL: u32 = 1400;

/// The formats of previews.
pub const PREVIEW: Choice<'_> = Choice { what: "a preview is", among: PICTURES };

/// Draws the preview for a file, with the given quality if it is a JPEG. Bases are drawn over the source; targets and cages over the
/// result, which `back` has moved as a whole after all steps.
pub(super) fn preview(
    doc: &Document,
    (warped, back): (&str, Affine),
    built: &BuiltParts,
    read: &ReadOptions,
    (file, options): (&Path, &CommonOptions),
) -> Result<Vec<u8>, Failure> {
    let format = PREVIEW.format(Some(file), None)?;
    let after = Document::read(warped.as_bytes(), "the result", read)?;
    let tree = |doc: &Document| {
        let text = if options.show_nodes { doc.with_nodes_shown() } else { doc.text().to_owned() };
        usvg_tree::shown(&Document::read(text.as_bytes(), "the preview", read)?, read)
    };
    let trees = [tree(doc)?, tree(&after)?];
    let mut left = Panel::new(&trees[0], doc.user_to_px(), doc.view_box());
    let mut right = Panel::new(&trees[1], after.user_to_px(), after.view_box());
    let everything = Selection::default();
    // Include artwork that the warp moved off the page.
    for (panel, doc) in [(&mut left, doc), (&mut right, &after)] {
        *panel = doc.artwork_box(&everything).into_iter().fold(panel.clone(), Panel::showing);
    }
    let whole = &built.whole;
    // Guides would cover the nodes.
    for (i, step) in whole.steps.iter().enumerate().filter(|_| !options.show_nodes) {
        let is_end = |end: fn(&[usize]) -> Option<&usize>| built.parts.iter().any(|p| end(&p.indices) == Some(&i));
        let (is_first, is_last) = (is_end(<[usize]>::first), is_end(<[usize]>::last));
        let has_target = step.explanation.overlays.iter().any(|o| o.role == Role::Target);
        for o in &step.explanation.overlays {
            // Neither panel shows the plane of a middle step's guides. A cage whose result goes to a target belongs to the source.
            let (panel, kind, to) = match o.role {
                Role::Base if is_first => (&mut left, OverlayKind::Base, Affine::IDENTITY),
                Role::Cage if is_first && has_target => (&mut left, OverlayKind::Cage, Affine::IDENTITY),
                Role::Cage if is_last => (&mut right, OverlayKind::Cage, back),
                Role::Target if is_last => (&mut right, OverlayKind::Target, back),
                _ => continue,
            };
            *panel = panel.clone().with(PreviewOverlay::new(kind, to * &o.path));
        }
    }
    if !options.show_polygons.is_empty() {
        let polygons = back * polygons(doc, &options.show_polygons, &whole.map)?;
        right = right.with(PreviewOverlay::new(OverlayKind::Target, polygons));
    }
    let preview = Preview::new(left, right);
    let preview = if options.show_nodes { preview.panel_size(NODES_PANEL) } else { preview };
    encode(preview.render_within(&doc.budget().limits())?, format, options.quality)
}

/// Returns the control polygons of the exact images of the selected paths.
fn polygons(doc: &Document, selectors: &[String], map: &dyn Map) -> Result<BezPath, Failure> {
    let mut path = BezPath::new();
    let selection = Selection { select: selectors.to_vec(), ..Selection::default() };
    let mut count = 0;
    for shape in doc.selected(&selection) {
        for seg in shape.outline.segs() {
            let images = exact_images(map, seg);
            let hulls = images.and_then(|images| images.iter().map(RationalBezier::hull).collect::<Option<Vec<_>>>());
            let problem = || format!("--show-polygons: the image of {} is no Bézier curve without poles", shape.id);
            for hull in hulls.ok_or_else(|| Failure::usage(problem()))? {
                count += 1;
                path.move_to(hull[0]);
                hull[1..].iter().for_each(|p| path.line_to(*p));
            }
        }
    }
    if count == 0 {
        return Err(Failure::usage(format!("--show-polygons: {} selects no path", selectors.join(" "))));
    }
    Ok(path)
}

/// Refuses a file of one surface if other steps have bent parts of the artwork in different ways.
pub(super) fn check_surface(built: &BuiltParts) -> Result<(), Failure> {
    for (i, step) in built.whole.steps.iter().enumerate() {
        let parts = built.parts.iter().filter(|p| p.indices.contains(&i)).count();
        if let Some(file) = step.space.as_ref().and_then(|space| space.files.first()).filter(|_| parts > 1) {
            return Err(Failure::usage(format!(
                "--{} writes one surface, but step {} holds for parts that other steps bend in different ways; run it by itself",
                file.param,
                i + 1
            )));
        }
    }
    Ok(())
}

/// Returns the files that the recipe's steps ask for, with their texts.
pub(super) fn surface_files(
    doc: &Document,
    built: &BuiltRecipe,
    options: &WarpOptions,
) -> Result<Vec<(PathBuf, String)>, Failure> {
    let mut out = Vec::new();
    for (i, step) in built.steps.iter().enumerate() {
        let Some(space) = &step.space else { continue };
        let steps_before = &built.steps[..i];
        let place = |p: Point| (space.place)(steps_before.iter().fold(p, |q, s| s.map.point(q)));
        let shapes: Vec<_> = doc.selected(&options.selection).collect();
        for file in &space.files {
            let wanted = shapes.iter().filter(|s| s.filled || !file.filled);
            let wanted: Vec<NamedShape<'_>> =
                wanted.map(|s| NamedShape { name: &s.id, outline: &s.outline, even_odd: s.even_odd }).collect();
            let text = if file.filled {
                // Further surfaces show an area of the plane, or the artwork again.
                let surfaces = space.besides.iter().map(|(name, area, place)| {
                    let outline = area.map(|r| Outline::from_points(&Frame::new(r).corners(), true));
                    (*name, outline, move |p: Point| place(steps_before.iter().fold(p, |q, s| s.map.point(q))), place)
                });
                let surfaces: Vec<_> = surfaces.collect();
                let mut groups: Vec<(Vec<NamedShape<'_>>, &artwork::SurfaceFn<'_>)> = vec![(wanted, &place)];
                for (name, outline, of_artwork, place) in &surfaces {
                    groups.push(match outline {
                        Some(outline) => (vec![NamedShape { name, outline, even_odd: false }], &***place),
                        None => (groups[0].0.clone(), of_artwork),
                    });
                }
                artwork::scene(&groups, options.refit.tolerance, doc.budget())
            } else {
                artwork::outlines(&wanted, &place, options.refit.tolerance, doc.budget())
            };
            let text =
                text.map_err(|e| Failure::Geometry(format!("--{}: {}", file.param, advice::surface_message(&e))))?;
            out.push((PathBuf::from(&file.name), text));
        }
    }
    Ok(out)
}
