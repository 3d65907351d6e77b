//! Requests, answers and descriptions of built maps, which the binary and the text form of the protocol share.

use pathwarp::engine::Ask;
use pathwarp::map::Creases;

/// Returns the command of the text protocol that asks so.
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
