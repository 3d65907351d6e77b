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

/// Reads the levels of handles of every piece, or the handles at points. Those of deeper levels may vanish.
pub(super) fn read(name: &str, text: &str) -> Result<Handles, Error> {
    let wrong = |problem: String| Error::input(name, problem);
    let file: HandlesFile = serde_json::from_str(text).map_err(|e| wrong(format!("is not a file of handles: {e}")))?;
    let vector = |[x, y]: [f64; 2]| Vec2::new(x, y);
    let vanishes = |what: String| {
        wrong(format!("{what} vanishes: the artwork would collapse onto the skeleton there; make it longer"))
    };
    match (file.pieces, file.points) {
        (Some(pieces), None) => {
            for (i, piece) in pieces.iter().enumerate() {
                if let Some(k) = piece.levels.first().and_then(|l| l.iter().position(|h| *h == [0.0; 2])) {
                    return Err(vanishes(format!("handle {} on the first level of piece {}", k + 1, i + 1)));
                }
            }
            let vectors = |level: Vec<[f64; 2]>| level.into_iter().map(vector).collect();
            Ok(Handles::Pieces(pieces.into_iter().map(|p| p.levels.into_iter().map(vectors).collect()).collect()))
        }
        (None, Some(points)) => match points.iter().position(|h| *h == Some([0.0; 2])) {
            Some(k) => Err(vanishes(format!("the handle at point {}", k + 1))),
            None => Ok(Handles::Points(points.into_iter().map(|h| h.map(vector)).collect())),
        },
        _ => Err(wrong("is not a file of handles: it needs either `pieces` or, for a spline, `points`".into())),
    }
}
