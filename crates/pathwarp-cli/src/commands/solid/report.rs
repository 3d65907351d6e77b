//! The report on a solid, `--report FILE`. The field names are the JSON's.

use crate::failure::Failure;
use pathwarp::recipe::Recipe;
use pathwarp_solid::mesh::{Deformed, Mesh, Topology, topology};
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
        let text = serde_json::to_string_pretty(&report).map_err(|e| Failure::Output(format!("the report: {e}")))?;
        Ok(text + "\n")
    }
}
