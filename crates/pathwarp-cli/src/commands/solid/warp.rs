//! `pathwarp solid DEFORMATION MODEL …`: deforms a model by one deformation or a chain.

use super::args::{self, Own};
use super::model::{Model, ModelFormat};
use super::preview::Preview;
use super::report::Run;
use crate::advice::{self, Flags};
use crate::catalogue::Catalogue;
use crate::commands::deformation;
use crate::failure::Failure;
use crate::options::{CommonOptions, Given};
use crate::output::PendingFile;
use crate::sources::Files;
use crate::status::Status;
use crate::{recipe_file, references, terminal, watch};
use clap::Command;
use pathwarp::budget::Budget;
use pathwarp::deform::Info;
use pathwarp::param::Axis;
use pathwarp::recipe::Recipe;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::mesh::{Deformed, MeshError, MeshFault, Undefined3, deform, refine};
use pathwarp_solid::{Box3, Frame3, recipe};
use std::path::Path;
use std::time::Instant;

pub(super) fn command(info: &Info) -> Command {
    deformation::described(info).args(args::all())
}

/// Deforms a model by a recipe, which was read from the file `from` if there is one.
pub(super) fn run(
    registry: &Registry3,
    recipe: &Recipe,
    given: &Given,
    own: &Own,
    from: Option<&Path>,
) -> Result<Status, Failure> {
    let options = given.read()?;
    watch::begin(options.reading.limits);
    let input = options.inputs.first().cloned().unwrap_or_else(|| "-".into());
    check_outputs(registry, recipe, &options, &input, from)?;
    let mut resolved = recipe.clone();
    references::resolve_files(registry, &mut resolved, &options.reading)?;
    let work = Work { registry, recipe: &resolved, given, options: &options, own };
    match options.jobs {
        Some(n) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            pool.map_err(|e| Failure::usage(format!("--jobs: {e}")))?.install(|| work.run(&input))
        }
        None => work.run(&input),
    }
}

/// Checks that no source and no other output is overwritten.
fn check_outputs(
    registry: &Registry3,
    recipe: &Recipe,
    options: &CommonOptions,
    input: &Path,
    from: Option<&Path>,
) -> Result<(), Failure> {
    let mut files = Files::default();
    references::files_read(registry, recipe).iter().for_each(|f| files.read(f));
    from.iter().for_each(|f| files.read(f));
    files.read(input);
    files.write(options.out.as_deref().unwrap_or(Path::new("-")), "")?;
    let others = [("report", &options.report), ("write-recipe", &options.write_recipe), ("preview", &options.preview)];
    for (option, file) in others {
        if let Some(file) = file {
            files.write(file, option)?;
        }
    }
    for (option, file) in references::files_written(registry, recipe) {
        files.write(file, option)?;
    }
    Ok(())
}

/// A run with everything looked up.
struct Work<'a> {
    registry: &'a Registry3,
    recipe: &'a Recipe,
    given: &'a Given,
    options: &'a CommonOptions,
    own: &'a Own,
}

impl Work<'_> {
    fn run(&self, input: &Path) -> Result<Status, Failure> {
        let started = Instant::now();
        let options = self.options;
        let flags = Flags::of(self.registry as &dyn Catalogue);
        // A wrong extension must not cost a long run.
        ModelFormat::of_output(options.out.as_deref(), ModelFormat::Obj)?;
        let mut model = Model::read(input, &options.reading, self.own.depth)?;
        let source = (options.report.is_some() || options.preview.is_some()).then(|| model.mesh.clone());
        let bounds = model.mesh.bounds().unwrap_or(Box3 { min: DVec3::ZERO, max: DVec3::ZERO });
        let frame = Frame3::new(self.own.frame.unwrap_or(bounds));
        let built =
            recipe::build(self.recipe, self.registry, frame, &model.mesh.positions).map_err(Failure::of_recipe)?;
        if let Some(length) = self.own.refine {
            let budget = Budget::new(options.reading.limits.for_input(model.bytes));
            let within = length.in_units(Axis::X, &frame.front());
            refine(&mut model.mesh, &built.map, within, &budget).map_err(|e| too_much(&model.name, &e))?;
        }
        let deformed = deform(&mut model.mesh, &built.map).map_err(|e| undefined(&model.name, &e))?;

        let mut warnings: Vec<String> = model.mesh.left_out.iter().map(|what| format!("left out: {what}")).collect();
        let partial = !warnings.is_empty();
        warnings.extend(built.steps.iter().flat_map(|s| &s.warnings).map(|w| flags.in_text(w)));
        warnings.extend(shape_warnings(&deformed).into_iter().map(|w| flags.in_text(&w)));
        let mut files = vec![model.write(options.out.as_deref(), options.precision)?];
        for file in built.steps.iter().flat_map(|s| &s.saves) {
            files.push(PendingFile::new(Path::new(&file.name), file.text.as_bytes())?);
        }
        if let Some(file) = &options.write_recipe {
            let text =
                recipe_file::write(self.registry, self.recipe, self.given, file.parent().unwrap_or(Path::new("")))?;
            files.push(PendingFile::new(file, text.as_bytes())?);
        }
        if let (Some(file), Some(source)) = (&options.report, &source) {
            let report = Run {
                recipe: self.recipe,
                file: &model.name,
                output: options.out.as_ref().map(|t| t.display().to_string()),
                before: source,
                after: &model.mesh,
                deformed,
                warnings: &warnings,
                seconds: started.elapsed().as_secs_f64(),
            };
            files.push(PendingFile::new(file, report.json()?.as_bytes())?);
        }
        if let (Some(file), Some(source)) = (&options.preview, &source) {
            let guides: Vec<Vec<DVec3>> = built.steps.last().map(|s| s.guides.clone()).unwrap_or_default();
            let eye = built.steps.iter().find_map(|s| s.eye);
            let preview = Preview { before: source, after: &model.mesh, guides: &guides, eye };
            files.push(PendingFile::new(file, &preview.file(file, options.quality)?)?);
        }
        PendingFile::commit_all(files)?;
        if options.explain {
            let size = frame.bounds.size();
            terminal::note(&format!("box: {:.6} × {:.6} × {:.6}", size.x, size.y, size.z));
            built.steps.iter().flat_map(|s| &s.notes).for_each(|n| terminal::note(&flags.in_text(n)));
        }
        if !options.quiet {
            warnings.iter().for_each(|w| terminal::warning(&format!("{}: {w}", model.name)));
        }
        Ok(Status::partial_if(partial))
    }
}

/// The failure of a vertex without image.
fn undefined(name: &str, e: &Undefined3) -> Failure {
    let DVec3 { x, y, z } = e.at;
    Failure::Geometry(format!(
        "{name}: vertex {} at {x:.6},{y:.6},{z:.6} has no image: the map is infinite or undefined there; move its control points \
         less, or choose another eye or region",
        e.vertex + 1
    ))
}

/// The failure of a refinement.
fn too_much(name: &str, e: &MeshError) -> Failure {
    Failure::Input(match &e.problem {
        MeshFault::Limit(exceeded) => format!("{name}: {e}; allow a larger --refine, or {}", advice::raise(exceeded)),
        _ => format!("{name}: {e}"),
    })
}

/// Warns of folds and tears.
fn shape_warnings(deformed: &Deformed) -> Vec<String> {
    let shown = |p: DVec3| format!("{:.6},{:.6},{:.6}", p.x, p.y, p.z);
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
