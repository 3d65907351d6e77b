//! The protocol as length-prefixed little-endian numbers.
//!
//! A message is its length in bytes without this prefix (u32), one byte for its kind, and a body.

use crate::fault::{Fault, MAX_MESSAGE_BYTES, beginning};
use pathwarp::engine::Ask;
use pathwarp::kurbo::Point;

// Kinds of requests.
const BUILD: u8 = 1;
const POINTS: u8 = 2;
const JETS: u8 = 3;
const INVERSE: u8 = 4;

// Kinds of answers.
const DONE: u8 = 0;
const REFUSED: u8 = 1;

/// Size in bytes of the length prefix and the kind.
const HEAD: usize = 5;

/// Writes the length of a message and its kind. Fails for a long message, since a step's values may be paths of any length.
fn head(kind: u8, body: usize, out: &mut Vec<u8>) -> Result<(), Fault> {
    let length = u32::try_from(body + 1).map_err(|_| Fault::TooLong(body))?;
    out.extend_from_slice(&length.to_le_bytes());
    out.push(kind);
    Ok(())
}

/// Encodes the request to build a map from `lines`.
pub(crate) fn build(lines: &[String]) -> Result<Vec<u8>, Fault> {
    let body = lines.concat();
    let mut out = Vec::with_capacity(body.len() + HEAD);
    head(BUILD, body.len(), &mut out)?;
    out.extend_from_slice(body.as_bytes());
    Ok(out)
}

/// Encodes the request for a batch.
pub(crate) fn batch(ask: Ask, points: &[Point], out: &mut Vec<u8>) -> Result<(), Fault> {
    let kind = match ask {
        Ask::Points => POINTS,
        Ask::Jets => JETS,
        Ask::Inverse => INVERSE,
    };
    out.reserve(HEAD + 16 * points.len());
    head(kind, 16 * points.len(), out)?;
    let start = out.len();
    out.resize(start + 16 * points.len(), 0);
    let numbers = points.iter().flat_map(|p| [p.x, p.y]);
    for (slot, number) in out[start..].as_chunks_mut::<8>().0.iter_mut().zip(numbers) {
        *slot = number.to_le_bytes();
    }
    Ok(())
}

/// Returns the length of the message at the beginning of `bytes`, once its head has arrived. `body` is the length of the body if known;
/// an error message instead of it may have up to [`MAX_MESSAGE_BYTES`].
pub(crate) fn length(bytes: &[u8], body: Option<usize>, expected: &dyn Fn() -> String) -> Result<Option<usize>, Fault> {
    let Some((head, _)) = bytes.split_first_chunk::<HEAD>() else { return Ok(None) };
    let [a, b, c, d, kind] = *head;
    let length = u32::from_le_bytes([a, b, c, d]) as usize;
    match (kind, body) {
        (DONE, Some(body)) if length == body + 1 => Ok(Some(length + 4)),
        // Pairs of numbers, and not absurdly many: a wrong count, not text that was taken for a length.
        (DONE, Some(body)) if length % 16 == 1 && length < 100 * (body + 16) => Err(Fault::Count {
            expected: expected(),
            found: format!("has {} bytes of numbers instead of {body}", length - 1),
        }),
        (DONE, None) | (REFUSED, _) if (1..=MAX_MESSAGE_BYTES).contains(&length) => Ok(Some(length + 4)),
        _ => Err(Fault::Garbage { expected: expected(), found: beginning(bytes) }),
    }
}

/// Returns the body of a whole message, which [`length`] has measured.
pub(crate) fn body(bytes: &[u8]) -> Result<&[u8], Fault> {
    let (head, body) = bytes.split_at(HEAD);
    match head[HEAD - 1] {
        REFUSED => Err(Fault::Refused(String::from_utf8_lossy(body).into_owned())),
        _ => Ok(body),
    }
}

/// Reads the numbers of an answer to a batch.
pub(crate) fn read_batch(bytes: &[u8], out: &mut Vec<f64>) -> Result<(), Fault> {
    out.extend(body(bytes)?.as_chunks::<8>().0.iter().map(|c| f64::from_le_bytes(*c)));
    Ok(())
}
