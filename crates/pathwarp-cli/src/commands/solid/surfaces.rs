//! Curved surfaces on their way through a run.

use super::format::ModelFormat;
use super::model::{mesh_file, pending};
use super::preview::Preview;
use super::report::SurfaceRun;
use super::work::{Done, Work, check, shown, undefined};
use crate::advice;
use crate::failure::Failure;
use crate::output::PendingFile;
use crate::pipeline::Job;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::param::Axis;
use pathwarp_solid::Box3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::mesh::Mesh;
use pathwarp_solid::patch::{
    DeformedPatches, PatchError, Surface, bpt, deform_patches, json, tessellate, tessellate_image,
};
use std::sync::Arc;
use std::time::Instant;

/// The largest distance of a refitted surface, as a share of the model's size, unless one is given.
const TOLERANCE: f64 = 1e-4;

/// The distance of polygons in previews, as a share of the model's size: facets are not seen.
const SEEN: f64 = 3e-4;

/// Surfaces as read, and the format to write.
pub(super) struct Source {
    pub(super) name: String,
    pub(super) surfaces: Vec<Surface>,
    pub(super) format: ModelFormat,
}

/// Deforms surfaces; written as a mesh, they are cut into polygons after that.
pub(super) fn run(work: &Work<'_>, job: &Job, source: Source, budget: &Arc<Budget>) -> Result<Done, Failure> {
    let started = Instant::now();
    let options = work.options;
    let Source { name, mut surfaces, format } = source;
    if !format.is_curved() && surfaces.iter().any(|s| !s.trims.is_empty()) {
        return Err(Failure::usage(format!("{name}: trimmed surfaces are not cut into polygons; write .json")));
    }
    let points: Vec<DVec3> = surfaces.iter().flat_map(|s| s.points.iter().copied()).collect();
    let bounds = Box3::around(points.iter().copied());
    let (frame, built) = work.build(&name, bounds, &points, budget)?;
    let within = work.own.refine.map(|l| l.in_units(Axis::X, &frame.front()));
    let tolerance = within.unwrap_or_else(|| TOLERANCE * bounds.map_or(1.0, |b| b.diagonal()));
    let before = surfaces.clone();
    let done = deform_patches(&mut surfaces, &built.map, tolerance, budget);
    check(&name, &built)?;
    let done = done.map_err(|e| failed(&name, &e))?;
    let mut warnings = work.warnings(&built);
    let shape = shape_warnings(&done, format.is_curved().then_some(tolerance));
    warnings.extend(shape.into_iter().map(|w| work.flags.in_text(&w)));
    // Polygons are those of the source, with the images of its points: surfaces that are closed stay closed.
    let image = |within: Option<f64>| -> Result<Mesh, Failure> {
        let mesh = tessellate_image(&before, &built.map, within, budget).map_err(|e| too_much(&name, &e))?;
        check(&name, &built)?;
        match mesh.positions.iter().all(|p| p.is_finite()) {
            true => Ok(mesh),
            false => Err(Failure::Input(format!("{name}: a place of the surfaces has no image"))),
        }
    };
    let bytes = match format {
        ModelFormat::Bpt => bpt::write(&surfaces).map_err(|e| Failure::usage(format!("{name}: {e}")))?.into_bytes(),
        ModelFormat::Surfaces => {
            json::write(&surfaces).map_err(|e| Failure::Output(format!("{name}: {e}")))?.into_bytes()
        }
        _ => {
            let mesh = image(within)?;
            let lost = format.lost(&mesh);
            if !lost.is_empty() {
                warnings.push(format!("the format of the result has no room for {}", lost.join(", ")));
            }
            mesh_file(&mesh, format, options.precision)?
        }
    };
    let mut files = vec![pending(job.target.as_deref(), bytes)?];
    files.extend(Work::saves(&built)?);
    let mut report = None;
    if options.report.is_some() {
        let run = SurfaceRun {
            recipe: work.recipe,
            file: &name,
            output: job.target.as_ref().map(|t| t.display().to_string()),
            before: &before,
            after: &surfaces,
            done,
            warnings: &warnings,
            seconds: started.elapsed().as_secs_f64(),
        };
        report = Some(run.json()?);
    }
    if let Some(file) = &job.preview {
        let guides: Vec<Vec<DVec3>> = built.steps.last().map(|s| s.guides.clone()).unwrap_or_default();
        let eye = built.steps.iter().find_map(|s| s.eye);
        let fine = bounds.map(|b| SEEN * b.diagonal());
        let before = tessellate(&before, fine, budget).map_err(|e| too_much(&name, &e))?;
        let after = image(fine)?;
        let preview = Preview { before: &before, after: &after, guides: &guides, eye };
        files.push(PendingFile::new(file, &preview.file(file, options.quality, budget)?)?);
    }
    let mut notes = work.notes(&frame, &built);
    notes.push(match done.refitted {
        _ if !format.is_curved() => "the corners of all polygons are exact images".into(),
        0 => format!("the images of {} surfaces are exact", done.exact),
        n => format!("the images of {} surfaces are exact, and of {n} within {:.3e}", done.exact, done.distance),
    });
    if done.cut > 0 && format.is_curved() {
        let (cut, all) = (done.cut, surfaces.len());
        notes.push(format!("{cut} of them are cut along a crease of the map; the result has {all} surfaces"));
    }
    let partial = format.is_curved() && done.distance > tolerance;
    Ok(Done { files, warnings, notes, report, partial })
}

fn failed(name: &str, e: &PatchError) -> Failure {
    match e {
        PatchError::Undefined { surface, at } => undefined(name, &format!("surface {}", surface + 1), *at),
        PatchError::Limit(e) => too_much(name, e),
    }
}

fn too_much(name: &str, e: &Exceeded) -> Failure {
    Failure::Input(format!("{name}: the surfaces take {e}; allow a larger --refine, or {}", advice::raise(e)))
}

/// `tolerance` is that of refitted surfaces, if they are written.
fn shape_warnings(done: &DeformedPatches, tolerance: Option<f64>) -> Vec<String> {
    let fold = done.folded_at.map(|at| {
        let (count, at) = (done.folded, shown(at));
        format!("the map turns space inside out at {count} places of the surfaces, first at {at}")
    });
    let far = tolerance.filter(|t| done.distance > *t).map(|tolerance| {
        format!(
            "{} refitted surfaces are up to {:.3e} from their images instead of {tolerance:.3e}: the map has a crease there, such as \
             the end of a region; cut the surfaces along it, or allow a larger --refine",
            done.refitted, done.distance
        )
    });
    let tear = done.torn_at.map(|at| {
        format!(
            "the surfaces are torn apart, for example near {}, where the moved region ends: keep the control points of that face in \
             place (`freeze` of ffd), or choose another region",
            shown(at)
        )
    });
    fold.into_iter().chain(tear).chain(far).collect()
}
