//! Models: read from a file and written to one.

use super::drawing;
use crate::failure::Failure;
use crate::input;
use crate::options::Reading;
use crate::output::PendingFile;
use pathwarp_solid::mesh::{Mesh, MeshError, obj, stl};
use std::path::Path;

/// A model that was read.
pub(super) struct Model {
    /// The name in messages and reports.
    pub(super) name: String,
    pub(super) mesh: Mesh,
    /// Size of the file.
    pub(super) bytes: usize,
    format: ModelFormat,
}

/// The format of a model's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ModelFormat {
    Obj,
    Stl,
}

impl ModelFormat {
    /// The format that an extension says.
    fn of(file: &Path) -> Option<Self> {
        let extension = file.extension()?;
        let is = |known: &str| extension.eq_ignore_ascii_case(known);
        if is("obj") {
            Some(Self::Obj)
        } else if is("stl") {
            Some(Self::Stl)
        } else {
            None
        }
    }

    /// The format of an output; of standard output that of the input.
    ///
    /// # Errors
    /// The extension says another one.
    pub(super) fn of_output(target: Option<&Path>, input: Self) -> Result<Self, Failure> {
        let Some(target) = target else { return Ok(input) };
        match (Self::of(target), target.extension()) {
            (Some(format), _) => Ok(format),
            (None, None) => Ok(input),
            (None, Some(other)) => Err(Failure::usage(format!(
                "{}: a model is written as OBJ or STL (.obj, .stl), not as .{}",
                target.display(),
                other.to_string_lossy()
            ))),
        }
    }
}

impl Model {
    /// Reads a model, or a drawing that is extruded by `depth` millimetres; `-` is standard input.
    pub(super) fn read(file: &Path, reading: &Reading, depth: Option<f64>) -> Result<Self, Failure> {
        let name = input::display(file);
        let bytes = input::bytes(file)?;
        if is_drawing(&bytes) {
            if file.as_os_str() == "-" {
                return Err(Failure::Input(format!("{name}: a drawing must be a file; name it instead")));
            }
            let mesh = drawing::read(file, reading, depth.unwrap_or(0.0))?;
            return Ok(Self { name, mesh, bytes: bytes.len(), format: ModelFormat::Obj });
        }
        if depth.is_some() {
            return Err(Failure::usage(format!("--extrude is for drawings (SVG); {name} is a model already")));
        }
        let about = |e: MeshError| Failure::Input(format!("{name}: {e}"));
        let named = ModelFormat::of(file);
        let (mesh, format) = if named == Some(ModelFormat::Stl) || named.is_none() && stl::sniff(&bytes) {
            (stl::read(&bytes).map_err(about)?, ModelFormat::Stl)
        } else if let Some(other) = other_format(&bytes) {
            return Err(Failure::Input(format!("{name}: is {other}; convert it to OBJ or STL first")));
        } else {
            (obj::read(&bytes).map_err(about)?, ModelFormat::Obj)
        };
        Ok(Self { name, mesh, bytes: bytes.len(), format })
    }

    /// The file, not yet in its place; without a target, standard output.
    pub(super) fn write(&self, target: Option<&Path>, precision: Option<u8>) -> Result<PendingFile, Failure> {
        let bytes = match ModelFormat::of_output(target, self.format)? {
            ModelFormat::Obj => obj::write(&self.mesh, precision.unwrap_or_else(|| decimals(&self.mesh))),
            ModelFormat::Stl => stl::write(&self.mesh).map_err(|e| Failure::Output(format!("{}: {e}", self.name)))?,
        };
        match target {
            Some(target) => PendingFile::new(target, &bytes),
            None => Ok(PendingFile::stdout(bytes)),
        }
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

/// The name of a format that is not read.
fn other_format(bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"glTF") {
        Some("a binary glTF file")
    } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        Some("a PLY file")
    } else if bytes.trim_ascii_start().starts_with(b"{") {
        Some("JSON, perhaps glTF")
    } else {
        None
    }
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
