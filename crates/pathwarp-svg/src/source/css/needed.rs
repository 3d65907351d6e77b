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
const PROPERTIES: [&str; 18] = [
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
    "mask-image",
];

/// Properties of text that usvg does not know or reads otherwise, unless their value is one of [`PLAIN`]. Some programs write them
/// all.
const TEXT: [&str; 21] = [
    "font",
    "white-space",
    "direction",
    "unicode-bidi",
    "font-stretch",
    "font-variant",
    "font-variant-caps",
    "font-variant-east-asian",
    "font-variant-ligatures",
    "font-variant-numeric",
    "font-variant-position",
    "font-feature-settings",
    "font-size-adjust",
    "letter-spacing",
    "text-decoration",
    "text-decoration-style",
    "text-decoration-thickness",
    "text-orientation",
    "text-shadow",
    "text-transform",
    "word-spacing",
];

const PLAIN: [&str; 10] =
    ["normal", "none", "ltr", "mixed", "auto", "solid", "underline", "overline", "line-through", "start"];

/// What marks values of text in attributes.
const VALUES: [&str; 11] = [
    "lighter",
    "bolder",
    "=\"rtl",
    "='rtl",
    "-override",
    "white-space=",
    "font-stretch=",
    "text-transform=",
    "font-variant=",
    "text-decoration=",
    "-spacing=",
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
            let name = name_before(text, at);
            SELECTORS.iter().any(|s| after.starts_with(s.as_bytes()))
                || PROPERTIES.contains(&name)
                || TEXT.contains(&name) && !is_plain_text(name, after)
                || name == "font-size" && is_keyword(after)
                || name == "font-weight" && is_odd(after)
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
    let any = |attribute: &str, is: fn(&[u8]) -> bool| {
        let mut places = memmem::find_iter(bytes, attribute.as_bytes());
        // After the sign and the quote.
        places.any(|at| is(bytes.get(at + attribute.len() + 1..).unwrap_or_default()))
    };
    let shares = || {
        memmem::find_iter(bytes, b"<use").any(|at| {
            let tag = &bytes[at..at + memchr(b'>', &bytes[at..]).unwrap_or(0)];
            memchr(b'%', tag).is_some()
        })
    };
    marked
        || any("font-size=", is_keyword)
        || any("font-weight=", is_odd)
        || shares()
        || fades(bytes)
        || VALUES.iter().any(|v| has(v))
        || compared()
        || sibling()
        || has("media=")
        || has("pathLength=")
        || UNITS.iter().any(unit)
}

/// Whether the value of a property of text, at the start of what is given, means to usvg what it means to browsers.
fn is_plain_text(name: &str, value: &[u8]) -> bool {
    let value = value.trim_ascii_start();
    let end = value.iter().position(|b| matches!(b, b';' | b'}' | b'"' | b'\'')).unwrap_or(value.len());
    let value = value[..end].trim_ascii();
    // Spacing separates ligatures.
    let is_zero = || {
        let digits = value.iter().position(|b| !b.is_ascii_digit() && *b != b'.').unwrap_or(value.len());
        digits > 0 && value[..digits].iter().all(|b| matches!(b, b'0' | b'.'))
    };
    name.ends_with("-spacing") && is_zero() || PLAIN.iter().any(|p| value == p.as_bytes())
}

/// Whether the value of a font size, at the start of what is given, is a keyword of which usvg has another idea.
fn is_keyword(value: &[u8]) -> bool {
    let value = value.trim_ascii_start();
    value.first().is_some_and(u8::is_ascii_alphabetic)
        && !value.starts_with(b"inherit")
        && !value.starts_with(b"medium")
}

/// Whether a weight, at the start of what is given, is a number that usvg does not know.
fn is_odd(value: &[u8]) -> bool {
    let value = value.trim_ascii_start();
    let digits = value.iter().take_while(|b| b.is_ascii_digit()).count();
    digits > 0 && (digits != 3 || &value[1..3] != b"00")
}

/// Returns `true` if a `tspan` is not opaque.
fn fades(bytes: &[u8]) -> bool {
    memmem::find_iter(bytes, b"<tspan").any(|at| {
        let tag = &bytes[at..at + memchr(b'>', &bytes[at..]).unwrap_or(0)];
        memmem::find_iter(tag, b"opacity").any(|o| {
            let value = tag[o + "opacity".len()..].trim_ascii_start();
            tag[o - 1] != b'-'
                && ![&b":1;"[..], b":1\"", b":1'", b"=\"1\"", b"='1'"].iter().any(|one| value.starts_with(one))
        })
    })
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
            "<text style='direction:ltr;font-variant:normal;letter-spacing:0px;font-weight:500'><tspan style='opacity:1;fill-opacity:.5'/></text>",
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
            "font:12px/2 Arial",
            "white-space:pre",
            "letter-spacing:5%",
            "letter-spacing:0.5px",
            "text-shadow:1px 1px red",
            "font-size:large",
            "font-weight:350",
            "<text font-weight='1000'>",
            "<text font-size='small'>",
            "text-decoration: underline wavy",
            "<tspan style='opacity:.5'>",
            "<text direction='rtl'>",
        ] {
            assert!(is_needed(css), "{css}");
        }
    }
}
