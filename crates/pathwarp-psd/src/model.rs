//! The warps of layers.

use serde::Serialize;

/// All warps of a file in the order of its layers, from bottom to top.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LayerWarps {
    /// A warp for each smart object and text layer; its style is `warpNone` if the layer is not warped.
    pub warps: Vec<LayerWarp>,
}

/// The warp of a layer.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LayerWarp {
    /// Name of the layer.
    pub layer: String,
    /// Name of the style, such as `warpArc`; `warpCustom` for control points.
    pub style: String,
    /// Bend in percent.
    pub value: f64,
    /// Horizontal distortion in percent.
    pub perspective: f64,
    /// Vertical distortion in percent.
    pub perspective_other: f64,
    /// `true` if the style acts vertically.
    pub vertical: bool,
    /// Control points of a custom warp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<WarpMesh>,
}

/// Control points of bicubic patches.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WarpMesh {
    /// x, y, width and height of the warped box, in the units of the points.
    pub region: [f64; 4],
    /// Always `true`: the mesh is fitted to the artwork, whatever its place.
    pub fit: bool,
    /// Boundaries between patches along x, as fractions of the width; `None` if they are even.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<Vec<f64>>,
    /// Boundaries between patches along y, as fractions of the height.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<Vec<f64>>,
    /// Rows of control points from the top.
    pub points: Vec<Vec<[f64; 2]>>,
}
