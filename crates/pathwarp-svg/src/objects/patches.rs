//! Replacements in a text.

use std::ops::Range;

/// Applies replacements. Those inside a range replaced as a whole are dropped.
pub(super) fn apply(text: &str, mut patches: Vec<(Range<usize>, String)>) -> String {
    // Insertions at one place keep their order and precede a replacement that starts there.
    patches.sort_by_key(|(r, _)| (r.start, !r.is_empty(), std::cmp::Reverse(r.end)));
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for (range, new) in patches {
        if range.start < done {
            continue;
        }
        out.push_str(&text[done..range.start]);
        out.push_str(&new);
        done = range.end;
    }
    out.push_str(&text[done..]);
    out
}
