//! The report on a solid, `--report FILE`. The field names are the JSON's.

use crate::failure::Failure;
use crate::readable;
use pathwarp::recipe::Recipe;
use pathwarp_solid::Box3;
use pathwarp_solid::mesh::{Deformed, Mesh, Topology, topology};
use pathwarp_solid::patch::{DeformedPatches, Surface};
use serde::Serialize;

/// The whole report.
#[derive(Serialize)]
pub(super) struct SolidReport {
    tool: &'static str,
    version: &'static str,
    steps: Vec<String>,
    file: String,
    output: Option<String>,
    before: Measures,
    after: Measures,
    /// Vertices that moved.
    moved: usize,
    /// Vertices at which the map turns space inside out.
    folded: usize,
    /// Edges across which the map jumps.
    torn: usize,
    warnings: Vec<String>,
    seconds: f64,
}

/// A mesh in numbers.
#[derive(Serialize)]
struct Measures {
    vertices: usize,
    faces: usize,
    edges: usize,
    /// V − E + F.
    euler: i64,
    open_edges: usize,
    bad_edges: usize,
    closed: bool,
    /// Omitted unless the surface is closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    volume: Option<f64>,
    area: f64,
    /// Two corners.
    bounds: Option<[[f64; 3]; 2]>,
}

impl Measures {
    fn of(mesh: &Mesh) -> Self {
        let t: Topology = topology(mesh);
        Self {
            vertices: mesh.positions.len(),
            faces: t.faces,
            edges: t.edges,
            euler: t.euler(),
            open_edges: t.open_edges,
            bad_edges: t.bad_edges,
            closed: t.is_closed(),
            volume: t.is_closed().then_some(t.volume),
            area: t.area,
            bounds: mesh.bounds().map(|b| [b.min.to_array(), b.max.to_array()]),
        }
    }
}

/// A finished run, to be reported.
pub(super) struct Run<'a> {
    pub(super) recipe: &'a Recipe,
    pub(super) file: &'a str,
    pub(super) output: Option<String>,
    pub(super) before: &'a Mesh,
    pub(super) after: &'a Mesh,
    pub(super) deformed: Deformed,
    pub(super) warnings: &'a [String],
    pub(super) seconds: f64,
}

impl Run<'_> {
    /// The report as JSON.
    pub(super) fn json(self) -> Result<String, Failure> {
        let report = SolidReport {
            tool: "pathwarp",
            version: env!("CARGO_PKG_VERSION"),
            steps: self.recipe.steps.iter().map(|s| s.deformation.clone()).collect(),
            file: self.file.to_owned(),
            output: self.output,
            before: Measures::of(self.before),
            after: Measures::of(self.after),
            moved: self.deformed.moved,
            folded: self.deformed.folded,
            torn: self.deformed.torn,
            warnings: self.warnings.to_vec(),
            seconds: self.seconds,
        };
        text(&report)
    }
}

fn text(report: &impl Serialize) -> Result<String, Failure> {
    readable::json(report).map_err(|e| Failure::Output(format!("the report: {e}")))
}

/// The report on a model that could not be deformed.
pub(super) fn failed(file: &str, error: &str) -> Result<String, Failure> {
    #[derive(Serialize)]
    struct Failed<'a> {
        file: &'a str,
        error: &'a str,
    }
    text(&Failed { file, error })
}

/// The report on curved surfaces.
#[derive(Serialize)]
struct SurfacesReport {
    tool: &'static str,
    version: &'static str,
    steps: Vec<String>,
    file: String,
    output: Option<String>,
    before: SurfaceMeasures,
    after: SurfaceMeasures,
    /// Surfaces whose images are exact.
    exact: usize,
    /// Surfaces that were refitted.
    refitted: usize,
    /// Those of them that are replaced by parts, cut along creases.
    cut: usize,
    /// The largest distance of those from their images that was measured.
    distance: f64,
    /// Places of a grid on the surfaces at which the map turns space inside out.
    folded: usize,
    warnings: Vec<String>,
    seconds: f64,
}

/// Surfaces in numbers.
#[derive(Serialize)]
struct SurfaceMeasures {
    surfaces: usize,
    rational: usize,
    trimmed: usize,
    control_points: usize,
    /// The highest degrees in u and v.
    degree: [usize; 2],
    /// Two corners of the control points' box.
    bounds: Option<[[f64; 3]; 2]>,
}

impl SurfaceMeasures {
    fn of(all: &[Surface]) -> Self {
        let count = |f: &dyn Fn(&Surface) -> bool| all.iter().filter(|s| f(s)).count();
        let bounds = Box3::around(all.iter().flat_map(|s| s.points.iter().copied()));
        Self {
            surfaces: all.len(),
            rational: count(&Surface::is_rational),
            trimmed: count(&|s| !s.trims.is_empty()),
            control_points: all.iter().map(|s| s.points.len()).sum(),
            degree: [0, 1].map(|a| all.iter().map(|s| s.degree[a]).max().unwrap_or(0)),
            bounds: bounds.map(|b| [b.min.to_array(), b.max.to_array()]),
        }
    }
}

/// A finished run on surfaces, to be reported.
pub(super) struct SurfaceRun<'a> {
    pub(super) recipe: &'a Recipe,
    pub(super) file: &'a str,
    pub(super) output: Option<String>,
    pub(super) before: &'a [Surface],
    pub(super) after: &'a [Surface],
    pub(super) done: DeformedPatches,
    pub(super) warnings: &'a [String],
    pub(super) seconds: f64,
}

impl SurfaceRun<'_> {
    /// The report as JSON.
    pub(super) fn json(self) -> Result<String, Failure> {
        text(&SurfacesReport {
            tool: "pathwarp",
            version: env!("CARGO_PKG_VERSION"),
            steps: self.recipe.steps.iter().map(|s| s.deformation.clone()).collect(),
            file: self.file.to_owned(),
            output: self.output,
            before: SurfaceMeasures::of(self.before),
            after: SurfaceMeasures::of(self.after),
            exact: self.done.exact,
            refitted: self.done.refitted,
            cut: self.done.cut,
            distance: self.done.distance,
            folded: self.done.folded,
            warnings: self.warnings.to_vec(),
            seconds: self.seconds,
        })
    }
}
