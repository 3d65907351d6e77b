//! Deforms models: meshes and curved surfaces are built, deformed, reported and drawn.

use super::args::SolidOptions;
use super::model::{ModelFormat, NAMES, mesh_file, pending, unread};
use super::report::Run;
use crate::commands::exact::dxf;
use crate::pipeline::Job;
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::param::Axis;
use pathwarp::recipe::Recipe;
use pathwarp::{Error, GeometryError};
use pathwarp_engine::advice::{self, Flags};
use pathwarp_engine::bitmap::{self, Pixel, encode};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::input::PREVIEW;
use pathwarp_engine::options::CommonOptions;
use pathwarp_engine::output::PendingFile;
use pathwarp_raster::Pixmap;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::mesh::{Deformed, Mesh, MeshFault, deform, refine};
use pathwarp_solid::patch::{
    DeformedPatches, PatchError, Surface, bpt, deform_patches, json, tessellate, tessellate_image,
};
use pathwarp_solid::picture::{Camera3, draw, samples};
use pathwarp_solid::recipe::{self, BuiltRecipe3};
use pathwarp_solid::{Box3, Frame3};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// A run with all references resolved.
pub(super) struct Work<'a> {
    pub(super) registry: &'a Registry3,
    pub(super) recipe: &'a Recipe,
    pub(super) options: &'a CommonOptions,
    pub(super) solid: &'a SolidOptions,
    pub(super) flags: &'a Flags,
}

/// A deformed model.
pub(super) struct Bent {
    pub(super) files: Vec<PendingFile>,
    pub(super) warnings: Vec<String>,
    pub(super) notes: Vec<String>,
    /// The report, if one is requested.
    pub(super) report: Option<String>,
    /// `true` if something was left out or missed the tolerance.
    pub(super) partial: bool,
}

impl Work<'_> {
    /// Builds the recipe for a model called `name` with these points.
    pub(super) fn build(
        &self,
        name: &str,
        bounds: Option<Box3>,
        points: &[DVec3],
        budget: &Arc<Budget>,
    ) -> Result<(Frame3, BuiltRecipe3), Failure> {
        let bounds = bounds.unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ZERO });
        let frame = Frame3::new(self.solid.frame.unwrap_or(bounds));
        let built = recipe::build_within(self.recipe, self.registry, frame, points, budget).map_err(|e| match e {
            Error::Geometry(GeometryError::Limit(e)) => too_much(name, &e),
            other => Failure::of_recipe(other),
        })?;
        Ok((frame, built))
    }

    /// Returns the part of a report that describes the run.
    fn run<'a>(&'a self, file: &'a str, job: &'a Job, warnings: &'a [String], started: Instant) -> Run<'a> {
        Run { recipe: self.recipe, file, target: job.target.as_deref(), warnings, started }
    }

    /// Returns notes on the frame and the steps.
    pub(super) fn notes(&self, frame: &Frame3, built: &BuiltRecipe3) -> Vec<String> {
        let size = frame.bounds.size();
        let first = format!("box: {:.6} × {:.6} × {:.6}", size.x, size.y, size.z);
        let steps = built.steps.iter().flat_map(|s| &s.notes).map(|n| self.flags.in_text(n));
        std::iter::once(first).chain(steps).collect()
    }

    /// Returns the warnings of the steps.
    pub(super) fn warnings(&self, built: &BuiltRecipe3) -> Vec<String> {
        built.steps.iter().flat_map(|s| &s.warnings).map(|w| self.flags.in_text(w)).collect()
    }

    /// Returns the files that parameters ask for, such as a saved lattice.
    pub(super) fn saves(built: &BuiltRecipe3) -> Result<Vec<PendingFile>, Failure> {
        let save = |f: &pathwarp::deform::SavedFile| PendingFile::new(Path::new(&f.name), f.text.as_bytes());
        built.steps.iter().flat_map(|s| &s.saves).map(save).collect()
    }
}

/// Fails if searches for an inverse have exceeded the limit. Results and other errors of the map are wrong then.
fn check_searches(name: &str, built: &BuiltRecipe3) -> Result<(), Failure> {
    built.exceeded().map_or(Ok(()), |e| Err(too_much(name, &e)))
}

/// Returns the failure of a map that takes too much work.
fn too_much(name: &str, e: &Exceeded) -> Failure {
    Failure::Geometry(format!("{name}: deforming takes {e}; {}", advice::raise(e)))
}

/// Returns the failure of a point without image.
fn no_image(name: &str, what: &str, DVec3 { x, y, z }: DVec3) -> Failure {
    Failure::Geometry(format!(
        "{name}: {what} at {x:.6},{y:.6},{z:.6} has no image: the map is infinite or undefined there; move its control points \
         less, or choose another eye or region"
    ))
}

fn coordinates(p: DVec3) -> String {
    format!("{:.6},{:.6},{:.6}", p.x, p.y, p.z)
}

/// A mesh as read, and the format to write.
pub(super) struct MeshSource {
    pub(super) name: String,
    pub(super) mesh: Mesh,
    pub(super) format: ModelFormat,
    /// `true` if it is an extruded drawing.
    pub(super) is_drawing: bool,
}

/// Deforms a mesh.
pub(super) fn bend_mesh(work: &Work<'_>, job: &Job, source: MeshSource, budget: &Arc<Budget>) -> Result<Bent, Failure> {
    let started = Instant::now();
    let options = work.options;
    let MeshSource { name, mut mesh, format, is_drawing } = source;
    if format.is_curved() {
        // Fail before the work begins.
        mesh_file(&mesh, format, None)?;
    }
    let before = (options.report.is_some() || job.preview.is_some()).then(|| mesh.clone());
    let (frame, built) = work.build(&name, mesh.bounds(), &mesh.positions, budget)?;
    if let Some(length) = work.solid.refine {
        let within = length.in_units(Axis::X, &frame.front());
        refine(&mut mesh, &built.map, within, budget).map_err(|e| match &e.problem {
            MeshFault::Limit(exceeded) => {
                Failure::Input(format!("{name}: {e}; allow a larger --refine, or {}", advice::raise(exceeded)))
            }
            _ => unread(&name, &e),
        })?;
    }
    let deformed = deform(&mut mesh, &built.map);
    check_searches(&name, &built)?;
    let deformed = deformed.map_err(|e| no_image(&name, &format!("vertex {}", e.vertex + 1), e.at))?;

    let mut warnings: Vec<String> = mesh.left_out.iter().map(|what| format!("left out: {what}")).collect();
    let partial = !warnings.is_empty();
    let mut lost = format.lost(&mesh);
    // The names of a drawing's shapes do not matter to printers.
    lost.retain(|what| !(is_drawing && *what == NAMES));
    if !lost.is_empty() {
        let others = if format == ModelFormat::Obj { ".glb has" } else { ".obj and .glb have" };
        warnings.push(format!("the format of the result has no room for {}; {others}", lost.join(", ")));
    }
    warnings.extend(work.warnings(&built));
    warnings.extend(mesh_warnings(&deformed).into_iter().map(|w| work.flags.in_text(&w)));
    if work.solid.refine.is_none() {
        warnings.extend(straight_edges_warning(&deformed, &mesh));
    }
    let mut files = vec![pending(job.target.as_deref(), mesh_file(&mesh, format, options.precision)?)?];
    files.extend(Work::saves(&built)?);
    let run = work.run(&name, job, &warnings, started);
    let reported = before.as_ref().filter(|_| options.report.is_some());
    let report = reported.map(|before| run.mesh_report([before, &mesh], &deformed)).transpose()?;
    if let (Some(file), Some(before)) = (&job.preview, &before) {
        files.push(Preview::of([before, &mesh], &built).file(file, options.quality, budget)?);
    }
    Ok(Bent { files, warnings, notes: work.notes(&frame, &built), report, partial })
}

/// Warns of straight edges that should be curved, if that is visible.
fn straight_edges_warning(deformed: &Deformed, mesh: &Mesh) -> Option<String> {
    /// Distances below this share of the result's size are hardly visible.
    const SEEN: f64 = 0.02;
    /// The distance that is suggested instead, as a share of the size.
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
fn mesh_warnings(deformed: &Deformed) -> Vec<String> {
    let Deformed { folded, torn, .. } = deformed;
    let fold = deformed.folded_at.map(coordinates).map(|at| {
        format!("the map turns space inside out at {folded} vertices, first at {at}: faces there point inwards")
    });
    let tear = deformed.torn_at.map(coordinates).map(|at| {
        format!(
            "the model is torn apart along {torn} edges, first near {at}, where the moved region ends: keep the control points of \
             that face in place (`freeze` of ffd), or choose another region"
        )
    });
    fold.into_iter().chain(tear).collect()
}

/// Default distance for refitted surfaces, as a share of the model's size.
const TOLERANCE: f64 = 1e-4;

/// Distance for polygons in previews, as a share of the model's size; facets stay invisible.
const PREVIEW_TOLERANCE: f64 = 3e-4;

/// Surfaces as read, and the format to write.
pub(super) struct SurfaceSource {
    pub(super) name: String,
    pub(super) surfaces: Vec<Surface>,
    pub(super) format: ModelFormat,
}

/// Deforms surfaces. In a mesh format, they are cut into polygons afterwards.
pub(super) fn bend_surfaces(
    work: &Work<'_>,
    job: &Job,
    source: SurfaceSource,
    budget: &Arc<Budget>,
) -> Result<Bent, Failure> {
    let started = Instant::now();
    let options = work.options;
    let SurfaceSource { name, mut surfaces, format } = source;
    if !format.is_curved() && surfaces.iter().any(|s| !s.trims.is_empty()) {
        return Err(Failure::usage(format!("{name}: trimmed surfaces are not cut into polygons; write .json")));
    }
    let points: Vec<DVec3> = surfaces.iter().flat_map(|s| s.points.iter().copied()).collect();
    let bounds = Box3::around(points.iter().copied());
    let (frame, built) = work.build(&name, bounds, &points, budget)?;
    let within = work.solid.refine.map(|l| l.in_units(Axis::X, &frame.front()));
    let tolerance = within.unwrap_or_else(|| TOLERANCE * bounds.map_or(1.0, |b| b.diagonal()));
    let before = surfaces.clone();
    let deformed = deform_patches(&mut surfaces, &built.map, tolerance, budget);
    check_searches(&name, &built)?;
    let deformed = deformed.map_err(|e| patch_failure(&name, &e))?;
    let mut warnings = work.warnings(&built);
    let shape = surface_warnings(&deformed, format.is_curved().then_some(tolerance));
    warnings.extend(shape.into_iter().map(|w| work.flags.in_text(&w)));
    // The polygons are the source's with mapped points, so closed surfaces stay closed.
    let image = |within: Option<f64>| -> Result<Mesh, Failure> {
        let mesh = tessellate_image(&before, &built.map, within, budget).map_err(|e| surfaces_too_much(&name, &e))?;
        check_searches(&name, &built)?;
        if mesh.positions.iter().all(|p| p.is_finite()) {
            return Ok(mesh);
        }
        Err(Failure::Input(format!("{name}: a place of the surfaces has no image")))
    };
    let bytes = match format {
        ModelFormat::Bpt => bpt::write(&surfaces).map_err(|e| Failure::usage(format!("{name}: {e}")))?.into_bytes(),
        ModelFormat::Dxf => dxf(&surfaces).map_err(|e| Failure::usage(format!("{name}: {e}")))?.into_bytes(),
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
    let run = work.run(&name, job, &warnings, started);
    let report = options.report.as_ref().map(|_| run.surface_report([&before, &surfaces], &deformed)).transpose()?;
    if let Some(file) = &job.preview {
        let fine = bounds.map(|b| PREVIEW_TOLERANCE * b.diagonal());
        let before = tessellate(&before, fine, budget).map_err(|e| surfaces_too_much(&name, &e))?;
        let after = image(fine)?;
        files.push(Preview::of([&before, &after], &built).file(file, options.quality, budget)?);
    }
    let mut notes = work.notes(&frame, &built);
    notes.extend(surface_notes(&deformed, format, surfaces.len()));
    let partial = format.is_curved() && deformed.distance > tolerance;
    Ok(Bent { files, warnings, notes, report, partial })
}

/// Describes the changes of the surfaces; the result has `all` of them.
fn surface_notes(deformed: &DeformedPatches, format: ModelFormat, all: usize) -> Vec<String> {
    let DeformedPatches { exact, refitted, distance, cut, .. } = deformed;
    let mut notes = vec![match refitted {
        _ if !format.is_curved() => "the corners of all polygons are exact images".into(),
        0 => format!("the images of {exact} surfaces are exact"),
        n => format!("the images of {exact} surfaces are exact, and of {n} within {distance:.3e}"),
    }];
    if *cut > 0 && format.is_curved() {
        notes.push(format!("{cut} of them are cut along a crease of the map; the result has {all} surfaces"));
    }
    notes
}

/// Returns the failure to deform surfaces.
fn patch_failure(name: &str, e: &PatchError) -> Failure {
    match e {
        PatchError::Undefined { surface, at } => no_image(name, &format!("surface {}", surface + 1), *at),
        PatchError::Limit(e) => surfaces_too_much(name, e),
    }
}

/// Returns the failure of surfaces that take too much work.
fn surfaces_too_much(name: &str, e: &Exceeded) -> Failure {
    Failure::Input(format!("{name}: the surfaces take {e}; allow a larger --refine, or {}", advice::raise(e)))
}

/// Warns of inexact and folded surfaces. `tolerance` is for refitted surfaces, if they are written.
fn surface_warnings(deformed: &DeformedPatches, tolerance: Option<f64>) -> Vec<String> {
    let DeformedPatches { refitted, distance, folded, .. } = deformed;
    let fold = deformed
        .folded_at
        .map(coordinates)
        .map(|at| format!("the map turns space inside out at {folded} places of the surfaces, first at {at}"));
    let inexact = tolerance.filter(|t| distance > t).map(|tolerance| {
        format!(
            "{refitted} refitted surfaces are up to {distance:.3e} from their images instead of {tolerance:.3e}: the map has a crease \
             there, such as the end of a region; cut the surfaces along it, or allow a larger --refine"
        )
    });
    let tear = deformed.torn_at.map(coordinates).map(|at| {
        format!(
            "the surfaces are torn apart, for example near {at}, where the moved region ends: keep the control points of that face in \
             place (`freeze` of ffd), or choose another region"
        )
    });
    fold.into_iter().chain(tear).chain(inexact).collect()
}

/// Pixels along a side of a panel.
const SIDE: usize = 480;
/// White pixels between panels.
const GAP: usize = 8;

/// The content of a preview.
struct Preview<'a> {
    before: &'a Mesh,
    after: &'a Mesh,
    guides: &'a [Vec<DVec3>],
    /// The eye from which nothing seems to change; the first camera is there.
    eye: Option<DVec3>,
}

impl<'a> Preview<'a> {
    fn of([before, after]: [&'a Mesh; 2], built: &'a BuiltRecipe3) -> Self {
        // Guides of earlier steps do not lie in the space of the result.
        let guides = built.steps.last().map_or(&[][..], |s| &s.guides);
        Self { before, after, guides, eye: built.steps.iter().find_map(|s| s.eye) }
    }

    /// Draws the preview in the format of the file's extension.
    fn file(&self, file: &Path, quality: Option<u8>, budget: &Budget) -> Result<PendingFile, Failure> {
        let format = PREVIEW.format(Some(file), None)?;
        let width = 2 * SIDE + GAP;
        let too_large = || Failure::Output(format!("{}: too large to draw", file.display()));
        let mut picture = Pixmap::new(width as u32, width as u32).ok_or_else(too_large)?;
        picture.data_mut().fill(u8::MAX);
        let boxes = [self.before.bounds(), self.after.bounds()].into_iter().flatten();
        let scene = Box3::around(boxes.flat_map(|b| [b.min, b.max]));
        let scene = scene.unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ONE });
        let front = || Camera3::towards(DVec3::new(0.45, 0.4, 1.0), scene);
        let first = self.eye.and_then(|eye| Camera3::at(eye, scene)).or_else(front);
        let second = Camera3::towards(DVec3::new(1.0, 0.4, 0.35), scene);
        for (row, (mesh, guides)) in [(self.before, &[][..]), (self.after, self.guides)].into_iter().enumerate() {
            for (column, camera) in [first, second].into_iter().flatten().enumerate() {
                let counted = bitmap::count_pixels(budget, Pixel::Sampled, samples(mesh, &camera, SIDE));
                let advice = |e| format!("the preview takes {e}; leave it out, or {}", advice::raise(&e));
                counted.map_err(|e| Failure::Input(advice(e)))?;
                let panel = draw(mesh, guides, &camera, SIDE);
                // A pixel has four bytes.
                for (y, line) in panel.chunks(4 * SIDE).enumerate() {
                    let (left, top) = (column * (SIDE + GAP), row * (SIDE + GAP));
                    let start = 4 * (((top + y) * width) + left);
                    picture.data_mut()[start..start + line.len()].copy_from_slice(line);
                }
            }
        }
        PendingFile::new(file, &encode(picture, format, quality)?)
    }
}
