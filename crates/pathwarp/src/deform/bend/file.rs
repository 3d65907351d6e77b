//! Handles as JSON: `{"pieces": [{"levels": [[[dx, dy], …], …]}, …]}`.

use crate::error::Error;
use kurbo::Vec2;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct HandlesFile {
    pieces: Vec<PieceHandles>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PieceHandles {
    levels: Vec<Vec<[f64; 2]>>,
}

/// Reads the levels of handles of every piece.
pub(super) fn read(name: &str, text: &str) -> Result<Vec<Vec<Vec<Vec2>>>, Error> {
    let file: HandlesFile =
        serde_json::from_str(text).map_err(|e| Error::input(name, format!("is not a file of handles: {e}")))?;
    let vectors = |level: Vec<[f64; 2]>| level.into_iter().map(|[x, y]| Vec2::new(x, y)).collect();
    Ok(file.pieces.into_iter().map(|p| p.levels.into_iter().map(vectors).collect()).collect())
}
