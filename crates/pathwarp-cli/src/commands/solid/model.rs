//! Models: read from a file and written to one.

use super::drawing;
use super::format::ModelFormat;
use crate::advice;
use crate::failure::Failure;
use crate::input;
use crate::options::Reading;
use crate::output::PendingFile;
use pathwarp::budget::Budget;
use pathwarp_solid::mesh::{Mesh, MeshError, MeshFault, gltf, obj, ply, stl};
use pathwarp_solid::patch::{Surface, bpt, json};
use std::path::Path;
use std::sync::Arc;

/// A model that was read.
pub(super) struct Model {
    /// The name in messages and reports.
    pub(super) name: String,
    pub(super) content: Content,
    /// Counts the work that the file causes.
    pub(super) budget: Arc<Budget>,
    pub(super) format: ModelFormat,
    /// A drawing, the names of whose objects are those of shapes.
    pub(super) drawn: bool,
}

/// Polygons or curved surfaces.
pub(super) enum Content {
    Mesh(Mesh),
    Surfaces(Vec<Surface>),
}

impl Model {
    /// Reads a model, or a drawing that is extruded by `depth` millimetres; `-` is standard input.
    pub(super) fn read(file: &Path, reading: &Reading, depth: Option<f64>) -> Result<Self, Failure> {
        let name = input::display(file);
        let bytes = input::bytes(file)?;
        let budget = Arc::new(Budget::new(reading.limits.for_input(bytes.len())));
        if is_drawing(&bytes) {
            if file.as_os_str() == "-" {
                return Err(Failure::Input(format!("{name}: a drawing must be a file; name it instead")));
            }
            let mesh = drawing::read(&bytes, file, reading, depth.unwrap_or(0.0))?;
            return Ok(Self { name, content: Content::Mesh(mesh), budget, format: ModelFormat::Obj, drawn: true });
        }
        if depth.is_some() {
            return Err(Failure::usage(format!("--extrude is for drawings (SVG); {name} is a model already")));
        }
        let about = |e: MeshError| unread(&name, &e);
        let format = ModelFormat::of(file).unwrap_or_else(|| ModelFormat::sniffed(&bytes));
        let content = match format {
            ModelFormat::Bpt => Content::Surfaces(bpt::read(&bytes).map_err(about)?),
            ModelFormat::Surfaces => Content::Surfaces(json::read(&bytes).map_err(about)?),
            ModelFormat::Obj => Content::Mesh(obj::read(&bytes).map_err(about)?),
            ModelFormat::Stl => Content::Mesh(stl::read(&bytes).map_err(about)?),
            ModelFormat::Ply => Content::Mesh(ply::read(&bytes).map_err(about)?),
            ModelFormat::Glb | ModelFormat::Gltf => Content::Mesh(gltf::read(&bytes, &budget).map_err(about)?),
        };
        Ok(Self { name, content, budget, format, drawn: false })
    }
}

/// The failure of reading or refining a model.
pub(super) fn unread(name: &str, e: &MeshError) -> Failure {
    Failure::Input(match &e.problem {
        MeshFault::Limit(exceeded) => format!("{name}: {e}; {}", advice::raise(exceeded)),
        _ => format!("{name}: {e}"),
    })
}

/// A file, not yet in its place; without a target, standard output.
pub(super) fn pending(target: Option<&Path>, bytes: Vec<u8>) -> Result<PendingFile, Failure> {
    match target {
        Some(target) => PendingFile::new(target, &bytes),
        None => Ok(PendingFile::stdout(bytes)),
    }
}

/// The file of a mesh.
pub(super) fn mesh_file(mesh: &Mesh, format: ModelFormat, precision: Option<u8>) -> Result<Vec<u8>, Failure> {
    let failed = |e: MeshError| Failure::Output(format!("the result {e}"));
    match format {
        ModelFormat::Obj => Ok(obj::write(mesh, precision.unwrap_or_else(|| decimals(mesh)))),
        ModelFormat::Stl => stl::write(mesh).map_err(failed),
        ModelFormat::Ply => ply::write(mesh).map_err(failed),
        ModelFormat::Glb => gltf::write_binary(mesh).map_err(failed),
        ModelFormat::Gltf => gltf::write_text(mesh).map_err(failed),
        ModelFormat::Bpt | ModelFormat::Surfaces => Err(Failure::usage(
            "polygons are not curved surfaces: write .obj, .stl, .ply, .glb or .gltf, not .bpt or .json",
        )),
    }
}

/// Returns `true` for an SVG, also a compressed one.
fn is_drawing(bytes: &[u8]) -> bool {
    /// The root element of a drawing comes after a prologue that is rarely longer.
    const PROLOGUE: usize = 4096;
    const GZIP: [u8; 2] = [0x1f, 0x8b];
    let start = &bytes[..bytes.len().min(PROLOGUE)];
    start.starts_with(&GZIP) || start.trim_ascii_start().starts_with(b"<") && start.windows(4).any(|w| w == b"<svg")
}

/// The decimals for a billionth of the model's size.
fn decimals(mesh: &Mesh) -> u8 {
    /// Figures of the size that are written.
    const FIGURES: f64 = 9.0;
    /// As for the option.
    const MOST: f64 = 15.0;
    let size = mesh.bounds().map_or(1.0, |b| b.diagonal());
    let decimals = FIGURES - size.log10().floor();
    // A cast of NaN gives 0.
    decimals.clamp(0.0, MOST) as u8
}
