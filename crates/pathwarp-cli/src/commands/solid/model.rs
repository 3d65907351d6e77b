//! Models: reading and writing their files, their formats, and drawings as models, true to size in millimetres.

use pathwarp::Outline;
use pathwarp::budget::Budget;
use pathwarp::kurbo::Affine;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::Reading;
use pathwarp_engine::output::PendingFile;
use pathwarp_engine::units::MM_PER_PX;
use pathwarp_engine::{advice, input};
use pathwarp_solid::artwork::{self, NamedShape};
use pathwarp_solid::mesh::{
    FlatShape, Mark, Mesh, MeshError, MeshFault, NONE, PolygonKind, extrude, gltf, obj, ply, stl,
};
use pathwarp_solid::patch::{Surface, bpt, json};
use pathwarp_svg::Selection;
use std::path::Path;
use std::sync::Arc;

/// A model that was read.
pub(super) struct Model {
    /// The name in messages and reports.
    pub(super) name: String,
    pub(super) content: Content,
    /// Counts the work for the file.
    pub(super) budget: Arc<Budget>,
    /// The format of the file, or OBJ for a drawing; the result has it, too, unless its file is named otherwise.
    pub(super) format: ModelFormat,
    /// `true` for a drawing, whose objects are named after shapes.
    pub(super) is_drawing: bool,
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
            let mesh = read_drawing(&bytes, file, reading, depth.unwrap_or(0.0))?;
            return Ok(Self { name, content: Content::Mesh(mesh), budget, format: ModelFormat::Obj, is_drawing: true });
        }
        if depth.is_some() {
            return Err(Failure::usage(format!("--extrude is for drawings (SVG); {name} is a model already")));
        }
        let about = |e: MeshError| unread(&name, &e);
        let format = ModelFormat::of(file).unwrap_or_else(|| ModelFormat::sniffed(&bytes));
        let content = match format {
            ModelFormat::Bpt => Content::Surfaces(bpt::read(&bytes).map_err(about)?),
            ModelFormat::Surfaces => Content::Surfaces(json::read(&bytes).map_err(about)?),
            ModelFormat::Dxf => {
                let advice = "write its curves as JSON (`pathwarp help solid` names the formats)";
                return Err(Failure::Input(format!("{name}: DXF files are written, not read; {advice}")));
            }
            ModelFormat::Obj => Content::Mesh(obj::read(&bytes).map_err(about)?),
            ModelFormat::Stl => Content::Mesh(stl::read(&bytes).map_err(about)?),
            ModelFormat::Ply => Content::Mesh(ply::read(&bytes).map_err(about)?),
            ModelFormat::Glb | ModelFormat::Gltf => Content::Mesh(gltf::read(&bytes, &budget).map_err(about)?),
        };
        Ok(Self { name, content, budget, format, is_drawing: false })
    }
}

/// Returns the failure of reading or refining a model.
pub(super) fn unread(name: &str, e: &MeshError) -> Failure {
    Failure::Input(match &e.problem {
        MeshFault::Limit(exceeded) => format!("{name}: {e}; {}", advice::raise(exceeded)),
        _ => format!("{name}: {e}"),
    })
}

/// Prepares an output; without a target, it is standard output.
pub(super) fn pending(target: Option<&Path>, bytes: Vec<u8>) -> Result<PendingFile, Failure> {
    match target {
        Some(target) => PendingFile::new(target, &bytes),
        None => Ok(PendingFile::stdout(bytes)),
    }
}

/// Writes a mesh in a format.
pub(super) fn mesh_file(mesh: &Mesh, format: ModelFormat, precision: Option<u8>) -> Result<Vec<u8>, Failure> {
    let failed = |e: MeshError| Failure::Output(format!("the result {e}"));
    match format {
        ModelFormat::Obj => Ok(obj::write(mesh, precision.unwrap_or_else(|| decimals(mesh)))),
        ModelFormat::Stl => stl::write(mesh).map_err(failed),
        ModelFormat::Ply => ply::write(mesh).map_err(failed),
        ModelFormat::Glb => gltf::write_binary(mesh).map_err(failed),
        ModelFormat::Gltf => gltf::write_text(mesh).map_err(failed),
        ModelFormat::Bpt | ModelFormat::Surfaces | ModelFormat::Dxf => Err(Failure::usage(
            "polygons are not curved surfaces: write .obj, .stl, .ply, .glb or .gltf, not .bpt, .json or .dxf",
        )),
    }
}

/// Returns `true` for an SVG, compressed or not.
fn is_drawing(bytes: &[u8]) -> bool {
    /// Length of a prologue before the root element, which is rarely exceeded.
    const PROLOGUE: usize = 4096;
    const GZIP: [u8; 2] = [0x1f, 0x8b];
    let start = &bytes[..bytes.len().min(PROLOGUE)];
    let is_xml = start.trim_ascii_start().starts_with(b"<");
    start.starts_with(&GZIP) || (is_xml && start.windows(4).any(|w| w == b"<svg"))
}

/// Returns the decimals that resolve a billionth of the model's size.
fn decimals(mesh: &Mesh) -> u8 {
    /// Significant figures of the size.
    const FIGURES: f64 = 9.0;
    /// The maximum of `--precision`.
    const MOST: f64 = 15.0;
    let size = mesh.bounds().map_or(1.0, |b| b.diagonal());
    let decimals = FIGURES - size.log10().floor();
    // A cast turns NaN into 0.
    decimals.clamp(0.0, MOST) as u8
}

/// The format of a model's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ModelFormat {
    Obj,
    Stl,
    Ply,
    /// Binary glTF.
    Glb,
    /// glTF as JSON.
    Gltf,
    /// Bézier patches as text.
    Bpt,
    /// Surfaces as JSON.
    Surfaces,
    /// Curves in space as splines; written only.
    Dxf,
}

/// The word for names in [`ModelFormat::lost`]. For a drawing they are no loss.
pub(super) const NAMES: &str = "names";

/// The extensions and their formats.
const EXTENSIONS: [(&str, ModelFormat); 8] = [
    ("obj", ModelFormat::Obj),
    ("stl", ModelFormat::Stl),
    ("ply", ModelFormat::Ply),
    ("glb", ModelFormat::Glb),
    ("gltf", ModelFormat::Gltf),
    ("bpt", ModelFormat::Bpt),
    ("json", ModelFormat::Surfaces),
    ("dxf", ModelFormat::Dxf),
];

impl ModelFormat {
    /// Returns the format of a file by its extension.
    pub(super) fn of(file: &Path) -> Option<Self> {
        let extension = file.extension()?;
        EXTENSIONS.into_iter().find(|(e, _)| extension.eq_ignore_ascii_case(e)).map(|(_, f)| f)
    }

    /// Detects the format of a file by its content, for other extensions.
    pub(super) fn sniffed(bytes: &[u8]) -> Self {
        let json = || bytes.trim_ascii_start().starts_with(b"{");
        if gltf::sniff(bytes) {
            if json() { Self::Gltf } else { Self::Glb }
        } else if ply::sniff(bytes) {
            Self::Ply
        } else if stl::sniff(bytes) {
            Self::Stl
        } else if json() {
            Self::Surfaces
        } else {
            Self::Obj
        }
    }

    /// Returns the format of an output; for standard output, the input's.
    ///
    /// # Errors
    /// [`Failure::Usage`] if the extension is not a model's.
    pub(super) fn of_output(target: Option<&Path>, input: Self) -> Result<Self, Failure> {
        let Some(target) = target else { return Ok(input) };
        match (Self::of(target), target.extension()) {
            (Some(format), _) => Ok(format),
            (None, None) => Ok(input),
            (None, Some(other)) => {
                let all: Vec<String> = EXTENSIONS.iter().map(|(e, _)| format!(".{e}")).collect();
                Err(Failure::usage(format!(
                    "{}: a model is written as {}, not as .{}",
                    target.display(),
                    all.join(", "),
                    other.to_string_lossy()
                )))
            }
        }
    }

    /// Returns `true` for curved surfaces and curves.
    pub(super) fn is_curved(self) -> bool {
        matches!(self, Self::Bpt | Self::Surfaces | Self::Dxf)
    }

    /// Returns the properties of a mesh that the format cannot store.
    pub(super) fn lost(self, mesh: &Mesh) -> Vec<&'static str> {
        let has_mark = |f: fn(&Mark) -> bool| mesh.marks.iter().any(|(_, m)| f(m));
        let has_kind = |k: PolygonKind| mesh.polygons.iter().any(|p| p.kind == k);
        let has_corner = |f: fn(&pathwarp_solid::mesh::Corner) -> u32| mesh.corners.iter().any(|c| f(c) != NONE);
        let mut out = Vec::new();
        if matches!(self, Self::Stl | Self::Ply) {
            let has_names = has_mark(|m| matches!(m, Mark::Object(t) | Mark::Group(t) if !t.is_empty()));
            out.extend(has_names.then_some(NAMES));
            let has_materials = has_mark(|m| matches!(m, Mark::Material(t) if !t.is_empty() && t != "none"));
            out.extend(has_materials.then_some("materials"));
        }
        if self == Self::Stl {
            out.extend(has_corner(|c| c.uv).then_some("texture coordinates"));
            out.extend(has_corner(|c| c.normal).then_some("normals of vertices"));
            out.extend((!mesh.colors.is_empty()).then_some("colours"));
            let is_cloud = mesh.polygons.is_empty() && !mesh.positions.is_empty();
            let has_others = is_cloud || has_kind(PolygonKind::Line) || has_kind(PolygonKind::Points);
            out.extend(has_others.then_some("lines and points"));
        }
        if self == Self::Obj {
            out.extend(mesh.is_translucent().then_some("the opacity of vertices"));
            let has_assets = mesh.assets.as_deref().is_some_and(|a| !a.is_empty());
            out.extend(has_assets.then_some("materials, except for their names"));
        }
        out
    }
}

/// Distance in millimetres within which outlines are followed, smaller than the precision of printers and cutters.
const TOLERANCE: f64 = 0.01;

/// Reads a drawing: x is measured from the left edge of the page, y from its bottom edge.
fn read_drawing(bytes: &[u8], file: &Path, reading: &Reading, depth: f64) -> Result<Mesh, Failure> {
    let doc = input::document_of(bytes, file, reading)?;
    let page = doc.user_to_px().transform_rect_bbox(doc.view_box());
    let to_mm =
        Affine::scale_non_uniform(MM_PER_PX, -MM_PER_PX) * Affine::translate((-page.x0, -page.y1)) * doc.user_to_px();
    let tolerance = TOLERANCE / to_mm.determinant().abs().sqrt();
    let mut shapes = Vec::new();
    let mut add = |name: &str, outline: &Outline, even_odd: bool| -> Result<(), Failure> {
        let flat = artwork::flat(&NamedShape { name, outline, even_odd }, tolerance, doc.budget())
            .map_err(|e| Failure::Geometry(format!("{}: {}", input::display(file), advice::surface_message(&e))))?;
        if !flat.triangles.is_empty() {
            let points = flat.points.iter().map(|p| to_mm * *p).map(|p| [p.x, p.y]).collect();
            shapes.push(FlatShape { name: name.to_owned(), points, triangles: flat.triangles });
        }
        Ok(())
    };
    let all = Selection::default();
    let strokes = doc.strokes(&all, tolerance);
    let strokes = strokes.map_err(|e| {
        Failure::Input(format!("{}: the strokes take {e}; {}", input::display(file), advice::raise(&e)))
    })?;
    for (shape, stroke) in doc.selected(&all).zip(strokes) {
        if shape.filled {
            add(&shape.id, &shape.outline, shape.even_odd)?;
        }
        if let Some(stroke) = stroke {
            let name = if shape.filled { format!("{} stroke", shape.id) } else { shape.id.clone() };
            add(&name, &stroke, false)?;
        }
    }
    if shapes.is_empty() {
        return Err(Failure::file(file, "the drawing has no shapes with an area"));
    }
    let mut mesh = Mesh::default();
    extrude(&mut mesh, &shapes, depth);
    Ok(mesh)
}
