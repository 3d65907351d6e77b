//! The report on a solid, `--report FILE`. The field names are the JSON's.

use pathwarp::recipe::Recipe;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::readable;
use pathwarp_solid::Box3;
use pathwarp_solid::mesh::{Deformed, Mesh, Topology, topology};
use pathwarp_solid::patch::{DeformedPatches, Surface};
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

/// The report on a model: measures before and after, and counts.
#[derive(Serialize)]
struct SolidReport<'a, M, C> {
    tool: &'static str,
    version: &'static str,
    steps: Vec<&'a str>,
    file: &'a str,
    output: Option<String>,
    before: M,
    after: M,
    #[serde(flatten)]
    counts: C,
    warnings: &'a [String],
    seconds: f64,
}

/// A finished run.
pub(super) struct Run<'a> {
    pub(super) recipe: &'a Recipe,
    pub(super) file: &'a str,
    /// The output; `None` for standard output.
    pub(super) target: Option<&'a Path>,
    pub(super) warnings: &'a [String],
    pub(super) started: Instant,
}

impl Run<'_> {
    fn json<M: Serialize>(&self, [before, after]: [M; 2], counts: impl Serialize) -> Result<String, Failure> {
        text(&SolidReport {
            tool: "pathwarp",
            version: env!("CARGO_PKG_VERSION"),
            steps: self.recipe.steps.iter().map(|s| s.deformation.as_str()).collect(),
            file: self.file,
            output: self.target.map(|t| t.display().to_string()),
            before,
            after,
            counts,
            warnings: self.warnings,
            seconds: self.started.elapsed().as_secs_f64(),
        })
    }

    /// Returns the report on a mesh.
    pub(super) fn mesh_report(&self, meshes: [&Mesh; 2], deformed: &Deformed) -> Result<String, Failure> {
        /// Vertices that moved, vertices at which the map turns space inside out, and edges across which it jumps.
        #[derive(Serialize)]
        struct Counts {
            moved: usize,
            folded: usize,
            torn: usize,
        }
        let Deformed { moved, folded, torn, .. } = *deformed;
        self.json(meshes.map(Measures::of), Counts { moved, folded, torn })
    }

    /// Returns the report on curved surfaces.
    pub(super) fn surface_report(&self, all: [&[Surface]; 2], deformed: &DeformedPatches) -> Result<String, Failure> {
        #[derive(Serialize)]
        struct Counts {
            /// Surfaces whose images are exact.
            exact: usize,
            /// Surfaces that were refitted.
            refitted: usize,
            /// Refitted surfaces that parts replace, cut along creases.
            cut: usize,
            /// The largest measured distance of refitted surfaces from their images.
            distance: f64,
            /// Points of a grid on the surfaces at which the map turns space inside out.
            folded: usize,
        }
        let DeformedPatches { exact, refitted, cut, distance, folded, .. } = *deformed;
        self.json(all.map(SurfaceMeasures::of), Counts { exact, refitted, cut, distance, folded })
    }
}

/// Measures of a mesh.
#[derive(Serialize)]
struct Measures {
    vertices: usize,
    faces: usize,
    edges: usize,
    /// The Euler characteristic V − E + F.
    euler: i64,
    open_edges: usize,
    bad_edges: usize,
    closed: bool,
    /// `None` unless the surface is closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    volume: Option<f64>,
    area: f64,
    /// Two corners of the bounding box.
    bounds: Option<[[f64; 3]; 2]>,
}

impl Measures {
    fn of(mesh: &Mesh) -> Self {
        let topology = topology(mesh);
        let Topology { faces, edges, open_edges, bad_edges, area, volume, .. } = topology;
        let closed = topology.is_closed();
        Self {
            vertices: mesh.positions.len(),
            faces,
            edges,
            euler: topology.euler(),
            open_edges,
            bad_edges,
            closed,
            volume: closed.then_some(volume),
            area,
            bounds: mesh.bounds().map(|b| [b.min.to_array(), b.max.to_array()]),
        }
    }
}

fn text(report: &impl Serialize) -> Result<String, Failure> {
    readable::json(report).map_err(|e| Failure::Output(format!("the report: {e}")))
}

/// Returns the report on a model that could not be deformed.
pub(super) fn failed(file: &str, error: &str) -> Result<String, Failure> {
    #[derive(Serialize)]
    struct Failed<'a> {
        file: &'a str,
        error: &'a str,
    }
    text(&Failed { file, error })
}

/// Measures of surfaces.
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
