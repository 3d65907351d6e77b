//! Whether a drawing's style asks for more than usvg does: a quick look at the text, which may err on the careful side.

use memchr::{memchr, memchr_iter, memchr3_iter, memmem};

/// Functions in values that usvg does not know, or that a declaration before stands in for.
const FUNCTIONS: [&str; 24] = [
    "var",
    "calc",
    "min",
    "max",
    "clamp",
    "light-dark",
    "circle",
    "ellipse",
    "inset",
    "path",
    "polygon",
    "rect",
    "shape",
    "xywh",
    "color",
    "color-mix",
    "lab",
    "lch",
    "oklab",
    "oklch",
    "hwb",
    "env",
    "attr",
    "-webkit-calc",
];

/// Properties that usvg takes from attributes only, or not at all.
const PROPERTIES: [&str; 19] = [
    "x",
    "y",
    "width",
    "height",
    "cx",
    "cy",
    "r",
    "rx",
    "ry",
    "d",
    "transform",
    "rotate",
    "scale",
    "translate",
    "transform-origin",
    "transform-box",
    "offset-path",
    "text-transform",
    "mask-image",
];

/// Pseudo-classes that usvg does not know, as they begin.
const SELECTORS: [&str; 10] =
    ["not(", "is(", "where(", "nth-", "last-", "only-", "first-of", "root", "empty", "any-link"];

const RULES: [&str; 6] = ["media", "supports", "layer", "import", "container", "scope"];

/// Units that usvg does not know.
const UNITS: [&str; 13] = ["rem", "vw", "vh", "vmin", "vmax", "vi", "vb", "Q", "q", "ch", "ic", "lh", "cap"];

/// Returns `false` if usvg reads all style of this text as browsers do.
pub(super) fn is_needed(text: &str) -> bool {
    let bytes = text.as_bytes();
    let marked = memchr3_iter(b':', b'(', b'@', bytes).any(|at| match bytes[at] {
        b':' => {
            let after = &bytes[at + 1..];
            SELECTORS.iter().any(|s| after.starts_with(s.as_bytes())) || PROPERTIES.contains(&name_before(text, at))
        }
        b'(' => FUNCTIONS.contains(&name_before(text, at)),
        _ => RULES.iter().any(|r| bytes[at + 1..].starts_with(r.as_bytes())),
    });
    let compared = || memchr3_iter(b'^', b'$', b'*', bytes).any(|at| bytes.get(at + 1) == Some(&b'='));
    let sibling = || memchr_iter(b'~', bytes).any(|at| bytes.get(at + 1) != Some(&b'='));
    let has = |word: &str| memmem::find(bytes, word.as_bytes()).is_some();
    let unit = |unit: &&str| {
        let number = |at: usize| at.checked_sub(1).is_some_and(|b| bytes[b].is_ascii_digit() || bytes[b] == b'.');
        // None of these is in base64.
        let ends =
            |at: usize| matches!(bytes.get(at + unit.len()), Some(b'"' | b'\'' | b';' | b' ' | b')' | b',' | b'}'));
        memmem::find_iter(bytes, unit.as_bytes()).any(|at| number(at) && ends(at))
    };
    let shares = || {
        memmem::find_iter(bytes, b"<use").any(|at| {
            let tag = &bytes[at..at + memchr(b'>', &bytes[at..]).unwrap_or(0)];
            memchr(b'%', tag).is_some()
        })
    };
    marked || shares() || compared() || sibling() || has("media=") || has("pathLength=") || UNITS.iter().any(unit)
}

/// The name that ends at a place, spaces left out.
fn name_before(text: &str, at: usize) -> &str {
    let bytes = text.as_bytes();
    let is_name = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'-' | b'_');
    let spaces =
        if bytes[at] == b':' { bytes[..at].iter().rev().take_while(|b| b.is_ascii_whitespace()).count() } else { 0 };
    let end = at - spaces;
    let start = end - bytes[..end].iter().rev().take_while(|b| is_name(b)).count();
    text.get(start..end).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::is_needed;

    #[test]
    fn what_usvg_reads_as_browsers_do() {
        for plain in [
            "<path style='fill:#fff;stroke-width:2;fill:url(#a)' transform='rotate(3)' d='M1 2Q3 4 5 6' xlink:href='#r'/>",
            "<style>.a > g.b:first-child{fill:red;color:rgb(1,2,3)} @font-face{src:url(data:x)}</style>",
            "<image href='data:image/png;base64,3vwAremB+/9vhx'/>",
        ] {
            assert!(!is_needed(plain), "{plain}");
        }
    }

    #[test]
    fn what_it_does_not() {
        for css in [
            "r : 3px",
            "transform:none",
            "width:var(--a)",
            "a:nth-child(2){}",
            "a ~ b{}",
            "[id^='a']{}",
            "@media print{}",
            "font-size:2rem;",
            "x='3Q'",
            "clip-path:circle(3px)",
            "<style media='print'>",
            "a:not(.b){}",
            "stroke-width:calc(1px)",
        ] {
            assert!(is_needed(css), "{css}");
        }
    }
}
