//! Words and numbers of an OBJ file's lines.

use glam::DVec3;

/// The words of a line, without a comment.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let end = line.iter().position(|b| *b == b'#').unwrap_or(line.len());
    line[..end].split(u8::is_ascii_whitespace).filter(|w| !w.is_empty())
}

/// A finite number, and not so large that its square overflows.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    let v: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    (v.abs() < 1e100).then_some(v)
}

/// Three numbers and the words after them.
pub(super) fn vector<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Option<DVec3> {
    let mut next = || number(words.next()?);
    Some(DVec3::new(next()?, next()?, next()?))
}

/// An index: from 1, or negative from the end.
pub(super) fn index(word: &[u8]) -> Option<i64> {
    let (sign, digits) = match word.strip_prefix(b"-") {
        Some(rest) => (-1, rest),
        None => (1, word),
    };
    if digits.is_empty() || digits.len() > 10 {
        return None;
    }
    let mut n: i64 = 0;
    for d in digits {
        if !d.is_ascii_digit() {
            return None;
        }
        n = 10 * n + i64::from(d - b'0');
    }
    (n != 0).then_some(sign * n)
}

/// Text for messages, cut where it is long.
pub(super) fn shown(text: &[u8]) -> String {
    /// A longer quotation would not be read.
    const SHOWN: usize = 40;
    String::from_utf8_lossy(text).trim().chars().take(SHOWN).collect()
}
