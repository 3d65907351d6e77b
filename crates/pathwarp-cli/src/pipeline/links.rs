//! Relative links of a drawing that is written to another folder: they lead to the same files as before.

use memchr::memmem;
use std::borrow::Cow;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The drawing with its links, if any leads from the folder of `from` and `to` is in another one.
pub(super) fn moved<'a>(svg: &'a [u8], from: &Path, to: &Path) -> Cow<'a, [u8]> {
    let (Ok(text), Some(way)) = (std::str::from_utf8(svg), way(from, to)) else { return Cow::Borrowed(svg) };
    let (mut out, mut done) = (String::new(), 0);
    for at in links(text) {
        out.push_str(&text[done..at]);
        out.push_str(&way);
        done = at;
    }
    if done == 0 { Cow::Borrowed(svg) } else { Cow::Owned((out + &text[done..]).into_bytes()) }
}

/// The way from the folder of one file to that of another, as the beginning of a link. `None` if it is the same.
fn way(from: &Path, to: &Path) -> Option<String> {
    let folder = |file: &Path| {
        let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::canonicalize(folder).or_else(|_| std::path::absolute(folder)).ok()
    };
    let (from, to): (PathBuf, PathBuf) = (folder(from)?, folder(to)?);
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 || from == to {
        return None;
    }
    let mut out = "../".repeat(to.components().count() - shared);
    for part in from.components().skip(shared) {
        let Component::Normal(name) = part else { return None };
        for b in name.to_str()?.bytes() {
            // What ends a link, or begins something else in one.
            if b.is_ascii_alphanumeric() || b"-_.~+@,=!$*".contains(&b) {
                out.push(char::from(b));
            } else {
                out.push_str(&format!("%{b:02X}"));
            }
        }
        out.push('/');
    }
    Some(out)
}

/// Where relative links to files begin: in attributes and in `url()`.
fn links(text: &str) -> Vec<usize> {
    let after = |mark: &'static str| memmem::find_iter(text.as_bytes(), mark).map(move |at| at + mark.len());
    let attributes = after("href").filter_map(|at| {
        let value = text[at..].trim_start().strip_prefix('=')?.trim_start();
        Some(text.len() - value.strip_prefix(['"', '\''])?.trim_start().len())
    });
    let functions = after("url(").map(|at| {
        let inside = text[at..].trim_start();
        let inside = ["&quot;", "&apos;", "\"", "'"].iter().find_map(|q| inside.strip_prefix(q)).unwrap_or(inside);
        text.len() - inside.len()
    });
    let mut all: Vec<usize> = attributes.chain(functions).filter(|at| is_relative(&text[*at..])).collect();
    all.sort_unstable();
    all
}

/// Whether a link leads from the folder of its drawing.
fn is_relative(link: &str) -> bool {
    let end = link.find(|c: char| c.is_whitespace() || "\"'()<>&".contains(c)).unwrap_or(link.len());
    let link = &link[..end];
    let scheme = link.split(['/', '#', '?']).next().is_some_and(|first| first.contains(':'));
    !link.is_empty() && !link.starts_with(['#', '/', '?', '\\']) && !scheme
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_the_same_files() {
        let dir = tempfile::tempdir().unwrap();
        for name in ["in put", "out/deep"] {
            fs::create_dir_all(dir.path().join(name)).unwrap();
        }
        let svg = "<?xml-stylesheet href='s.css'?><image href=\"p.png\"/><use xlink:href='#a' fill='url( \"x.svg#b\" )'/>\
                   <image href='data:image/png;base64,AA=='/><a href='https://x.org/'/><style>a{src:url(f/a.woff)}</style>";
        let at = |name: &str| dir.path().join(name);
        let new = moved(svg.as_bytes(), &at("in put/a.svg"), &at("out/deep/b.svg"));
        let way = "../../in%20put/";
        assert_eq!(
            String::from_utf8(new.into_owned()).unwrap(),
            format!(
                "<?xml-stylesheet href='{way}s.css'?><image href=\"{way}p.png\"/>\
                 <use xlink:href='#a' fill='url( \"{way}x.svg#b\" )'/>\
                 <image href='data:image/png;base64,AA=='/><a href='https://x.org/'/><style>a{{src:url({way}f/a.woff)}}</style>"
            )
        );
        assert!(matches!(moved(svg.as_bytes(), &at("in put/a.svg"), &at("in put/b.svg")), Cow::Borrowed(_)));
    }
}
