//! Requests, answers and descriptions of built maps, shared by the binary and the text form of the protocol.

use pathwarp::engine::Ask;
use pathwarp::map::Creases;

/// Returns the command of the text protocol for a kind of question.
pub(crate) fn word(ask: Ask) -> &'static str {
    match ask {
        Ask::Points => "points",
        Ask::Jets => "jets",
        Ask::Inverse => "inverse",
    }
}

/// A program's description of the map that it has built.
#[derive(Debug, Default)]
pub(crate) struct BuildAnswer {
    pub(crate) notes: Vec<String>,
    pub(crate) warnings: Vec<String>,
    pub(crate) creases: Creases,
    /// The size of the map's smallest feature; see [`Map::detail`](pathwarp::map::Map::detail).
    pub(crate) detail: Option<f64>,
}
