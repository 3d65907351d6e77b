//! A mesh on its way through a run.

use super::format::{ModelFormat, NAMES};
use super::model::{mesh_file, pending, unread};
use super::preview::Preview;
use super::report::Run;
use super::work::{Done, Work, check, shown, undefined};
use crate::failure::Failure;
use crate::output::PendingFile;
use crate::pipeline::Job;
use pathwarp::budget::Budget;
use pathwarp::param::Axis;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::mesh::{Deformed, Mesh, MeshFault, deform, refine};
use std::sync::Arc;
use std::time::Instant;

/// A mesh as read, and the format to write.
pub(super) struct Source {
    pub(super) name: String,
    pub(super) mesh: Mesh,
    pub(super) format: ModelFormat,
    /// It was a drawing.
    pub(super) drawn: bool,
}

/// Deforms a mesh.
pub(super) fn run(work: &Work<'_>, job: &Job, source: Source, budget: &Arc<Budget>) -> Result<Done, Failure> {
    let started = Instant::now();
    let options = work.options;
    let Source { name, mut mesh, format, drawn } = source;
    if format.is_curved() {
        // Says so before the work.
        mesh_file(&mesh, format, None)?;
    }
    let before = (options.report.is_some() || job.preview.is_some()).then(|| mesh.clone());
    let (frame, built) = work.build(&name, mesh.bounds(), &mesh.positions, budget)?;
    if let Some(length) = work.own.refine {
        let within = length.in_units(Axis::X, &frame.front());
        refine(&mut mesh, &built.map, within, budget).map_err(|e| match &e.problem {
            MeshFault::Limit(_) => match unread(&name, &e) {
                Failure::Input(m) => Failure::Input(m.replacen("; if", "; allow a larger --refine, or if", 1)),
                other => other,
            },
            _ => unread(&name, &e),
        })?;
    }
    let deformed = deform(&mut mesh, &built.map);
    check(&name, &built)?;
    let deformed = deformed.map_err(|e| undefined(&name, &format!("vertex {}", e.vertex + 1), e.at))?;

    let mut warnings: Vec<String> = mesh.left_out.iter().map(|what| format!("left out: {what}")).collect();
    let partial = !warnings.is_empty();
    let mut lost = format.lost(&mesh);
    // Nobody misses the names of a drawing's shapes in a file for a printer.
    lost.retain(|what| !(drawn && *what == NAMES));
    if !lost.is_empty() {
        warnings.push(format!("the format of the result has no room for {}; .obj and .glb have", lost.join(", ")));
    }
    warnings.extend(work.warnings(&built));
    warnings.extend(shape_warnings(&deformed).into_iter().map(|w| work.flags.in_text(&w)));
    if work.own.refine.is_none() {
        warnings.extend(coarse(&deformed, &mesh));
    }
    let mut files = vec![pending(job.target.as_deref(), mesh_file(&mesh, format, options.precision)?)?];
    files.extend(Work::saves(&built)?);
    let mut report = None;
    if let (Some(_), Some(before)) = (&options.report, &before) {
        let run = Run {
            recipe: work.recipe,
            file: &name,
            output: job.target.as_ref().map(|t| t.display().to_string()),
            before,
            after: &mesh,
            deformed,
            warnings: &warnings,
            seconds: started.elapsed().as_secs_f64(),
        };
        report = Some(run.json()?);
    }
    if let (Some(file), Some(before)) = (&job.preview, &before) {
        let guides: Vec<Vec<DVec3>> = built.steps.last().map(|s| s.guides.clone()).unwrap_or_default();
        let eye = built.steps.iter().find_map(|s| s.eye);
        let preview = Preview { before, after: &mesh, guides: &guides, eye };
        files.push(PendingFile::new(file, &preview.file(file, options.quality, budget)?)?);
    }
    Ok(Done { files, warnings, notes: work.notes(&frame, &built), report, partial })
}

/// Warns of edges that should be curved, where that can be seen.
fn coarse(deformed: &Deformed, mesh: &Mesh) -> Option<String> {
    /// Distances below this share of the result's size are hardly seen.
    const SEEN: f64 = 0.02;
    /// The distance that is proposed instead, as a share of the size.
    const FINE: f64 = 1e-3;
    let size = mesh.bounds()?.diagonal();
    let fine = 10f64.powf((FINE * size).log10().floor());
    (deformed.bulge > SEEN * size).then(|| {
        format!(
            "edges stay straight, and their middles are up to {:.3} from where the map takes them: --refine {fine} subdivides them",
            deformed.bulge
        )
    })
}

/// Warns of folds and tears.
fn shape_warnings(deformed: &Deformed) -> Vec<String> {
    let fold = deformed.folded_at.map(|at| {
        let (count, at) = (deformed.folded, shown(at));
        format!("the map turns space inside out at {count} vertices, first at {at}: faces there point inwards")
    });
    let tear = deformed.torn_at.map(|at| {
        let (count, at) = (deformed.torn, shown(at));
        format!(
            "the model is torn apart along {count} edges, first near {at}, where the moved region ends: keep the control points of \
             that face in place (`freeze` of ffd), or choose another region"
        )
    });
    fold.into_iter().chain(tear).collect()
}
