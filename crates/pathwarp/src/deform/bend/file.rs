//! Handles as JSON: `{"pieces": [{"levels": [[[dx, dy], …], …]}, …]}`, or `{"points": [[dx, dy], null, …]}`.

use super::Handles;
use crate::error::Error;
use kurbo::Vec2;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct HandlesFile {
    pieces: Option<Vec<PieceHandles>>,
    points: Option<Vec<Option<[f64; 2]>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PieceHandles {
    levels: Vec<Vec<[f64; 2]>>,
}

/// Reads the levels of handles of every piece, or the handles at points. Handles of deeper levels may vanish.
pub(super) fn read(name: &str, text: &str) -> Result<Handles, Error> {
    let error = |problem: String| Error::input(name, problem);
    let file: HandlesFile = serde_json::from_str(text).map_err(|e| error(format!("is not a file of handles: {e}")))?;
    let vector = |[x, y]: [f64; 2]| Vec2::new(x, y);
    let first_level_vanishes = |p: &PieceHandles| p.levels.first().is_some_and(|l| l.contains(&[0.0; 2]));
    let (kind, vanishes) = match (&file.pieces, &file.points) {
        (Some(pieces), None) => ("piece", pieces.iter().position(first_level_vanishes)),
        (None, Some(points)) => ("point", points.iter().position(|h| *h == Some([0.0; 2]))),
        _ => return Err(error("is not a file of handles: it needs either `pieces` or, for a spline, `points`".into())),
    };
    if let Some(i) = vanishes {
        let number = i + 1;
        return Err(error(format!(
            "has a handle without length at {kind} {number}, where the artwork would collapse; make it longer"
        )));
    }
    let vectors = |level: Vec<[f64; 2]>| level.into_iter().map(vector).collect();
    let piece = |p: PieceHandles| p.levels.into_iter().map(vectors).collect();
    Ok(match file.points {
        Some(points) => Handles::Points(points.into_iter().map(|h| h.map(vector)).collect()),
        None => Handles::Pieces(file.pieces.into_iter().flatten().map(piece).collect()),
    })
}
