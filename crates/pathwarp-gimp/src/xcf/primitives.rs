//! Reads strings, counts and coordinates, and writes words and points.

use crate::error::Error;
use crate::source::ByteSource;

/// Length of the longest plausible name in bytes.
const MAX_NAME: u64 = 1 << 20;

/// Reads a string: its length including a final NUL, then its bytes. GIMP writes an empty string as length 0.
pub(super) fn string(input: &mut ByteSource<'_>, what: &str) -> Result<String, Error> {
    let at = input.offset();
    let length = u64::from(input.u32(what)?);
    input.need(length, at, || format!("{what} needs {length} bytes"))?;
    if length > MAX_NAME {
        return Err(Error::damaged(at, format!("{what} of {length} bytes is longer than any name")));
    }
    let mut bytes = input.vec(length, what)?;
    if let Some(last) = bytes.pop()
        && last != 0
    {
        return Err(Error::damaged(at + 3 + length, format!("{what} does not end with a zero byte")));
    }
    let text = String::from_utf8(bytes);
    text.map_err(|e| Error::damaged(at + 4 + e.utf8_error().valid_up_to() as u64, format!("{what} is not UTF-8")))
}

/// Reads the number of things that take at least `min_size` bytes each, and checks that so many can follow.
pub(super) fn count(input: &mut ByteSource<'_>, min_size: u64, what: &str) -> Result<u32, Error> {
    let at = input.offset();
    let n = input.u32(what)?;
    let size = u64::from(n) * min_size;
    input.need(size, at, || format!("{n} {what} need {size} bytes or more"))?;
    Ok(n)
}

/// Decodes a coordinate. NaN and infinities are errors.
pub(super) fn coordinate(bytes: [u8; 4], at: u64) -> Result<f64, Error> {
    let v = f32::from_be_bytes(bytes);
    if v.is_finite() {
        Ok(f64::from(v))
    } else {
        Err(Error::damaged(at, format!("a coordinate is {v}, not a finite number")))
    }
}

pub(super) fn push_words(out: &mut Vec<u8>, words: &[u32]) {
    words.iter().for_each(|w| out.extend(w.to_be_bytes()));
}

/// Appends a point's type and its coordinates, rounded to single precision.
pub(super) fn push_point(out: &mut Vec<u8>, kind: u32, [x, y]: [f64; 2]) {
    push_words(out, &[kind, (x as f32).to_bits(), (y as f32).to_bits()]);
}
