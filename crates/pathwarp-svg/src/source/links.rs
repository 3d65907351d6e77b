//! Follows the links of a drawing to files, as far as the user allows it, and rewrites them for drawings in another folder.

use super::edit::splice;
use super::images::{self, ANY, SVG, embedded};
use super::read::{self, GZIP, ReadOptions};
use pathwarp::Error;
use pathwarp::budget::Limit;
use pathwarp_reader::{percent_decoded, xml};
use std::collections::BTreeMap;
use std::fs::{File, Metadata};
use std::io::Read as _;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use usvg::roxmltree;

/// Target of a link.
pub(super) enum Target {
    /// A file that may be read.
    File(PathBuf),
    /// A file that must not be read.
    Outside,
    /// No file, or links are not followed.
    Nowhere,
}

/// The file that a link names: decoded as in browsers, or else literally. Without a base folder, links are not followed at all.
pub(super) fn target(link: &str, options: &ReadOptions) -> Target {
    let Some(base) = &options.base_dir else { return Target::Nowhere };
    let plain = path_in_link(link);
    match find_file(base, Path::new(&plain), options.external) {
        Target::Nowhere if plain != link => find_file(base, Path::new(link), options.external),
        target => target,
    }
}

/// The file at a path in a link. Unless `external` files are allowed, it must be in the base folder or below after symbolic links are
/// resolved.
fn find_file(base: &Path, link: &Path, external: bool) -> Target {
    let file = base.join(link);
    if external {
        return if file.exists() { Target::File(file) } else { Target::Nowhere };
    }
    // A path that leads elsewhere is refused without touching the file system.
    if link.has_root() || link.is_absolute() || climbs_out(link) {
        return Target::Outside;
    }
    match (file.canonicalize(), base.canonicalize()) {
        (Ok(file), Ok(base)) if file.starts_with(&base) => Target::File(file),
        (Ok(_), Ok(_)) => Target::Outside,
        // It is not revealed whether the target of a symbolic link exists.
        _ if is_through_symlink(base, link) => Target::Outside,
        _ => Target::Nowhere,
    }
}

/// Returns `true` if a relative link passes through a symbolic link.
fn is_through_symlink(base: &Path, link: &Path) -> bool {
    let mut steps = link.components().scan(base.to_owned(), |path, c| {
        path.push(c);
        Some(path.symlink_metadata())
    });
    steps.any(|m| m.is_ok_and(|m| m.is_symlink()))
}

/// Returns `true` if a relative link goes above the folder where it starts.
fn climbs_out(link: &Path) -> bool {
    let mut depth = 0_i32;
    link.components().any(|c| {
        depth += match c {
            Component::ParentDir => -1,
            Component::Normal(_) => 1,
            _ => 0,
        };
        depth < 0
    })
}

/// The path in a link: without query and fragment, without the scheme `file`, and with `%20` as a space (RFC 3986, 2.1 and 3.4).
fn path_in_link(link: &str) -> String {
    let link = link.trim();
    let path = link.split(['?', '#']).next().unwrap_or_default();
    let is_file = path.get(..7).is_some_and(|scheme| scheme.eq_ignore_ascii_case("file://"));
    let path = if is_file { path[7..].strip_prefix("localhost").unwrap_or(&path[7..]) } else { path };
    percent_decoded(path).into_owned()
}

/// Reads a linked image. A link may name any object in the file system, so only plain files up to a limit are read.
pub(super) fn read_linked(file: &Path, options: &ReadOptions) -> Option<Vec<u8>> {
    let size = std::fs::metadata(file).ok().filter(Metadata::is_file)?.len();
    // Larger files are recorded as unread.
    options.budget.check(Limit::Memory, size as f64).ok()?;
    let mut data = Vec::new();
    File::open(file).ok()?.take(size).read_to_end(&mut data).ok()?;
    Some(data)
}

/// Changes to a drawing's links to files for a drawing in another folder.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Relinking {
    /// The path put before relative links, such as `../art/`.
    pub way: String,
    /// `true` if pictures that may and can be read are embedded in the drawing.
    pub embed: bool,
}

impl Relinking {
    /// The text of a drawing with its links rewritten: links of elements, and `url()` in attributes and style sheets. `options` determine
    /// the current targets, and the files that may be read. Returns `None` if nothing changes.
    ///
    /// # Errors
    /// [`Error::Input`] if the pictures exceed the limits.
    pub fn of(&self, svg: &str, options: &ReadOptions) -> Result<Option<String>, Error> {
        let keeps_links = self.way.is_empty() && !self.embed;
        if keeps_links || !["href", "src", "url("].iter().any(|word| svg.contains(word)) {
            return Ok(None);
        }
        let options = options.begin(svg.len());
        let Ok(doc) = xml::parse(svg, "the drawing", &options.budget) else { return Ok(None) };
        let mut new = BTreeMap::new();
        for node in doc.descendants() {
            self.rewrite(node, svg, &options, &mut new)?;
        }
        if new.is_empty() {
            return Ok(None);
        }
        Ok(Some(splice(svg, new.into_iter().map(|(start, (end, link))| (start..end, link)))))
    }

    /// Adds the new links of a node, by the start of the text that they replace, with its end and the new text. The map keeps links of an
    /// entity once, which are found at each of its uses.
    fn rewrite(
        &self,
        node: roxmltree::Node<'_, '_>,
        svg: &str,
        options: &ReadOptions,
        new: &mut BTreeMap<usize, (usize, String)>,
    ) -> Result<(), Error> {
        let mut starts = Vec::new();
        if node.is_pi() || (node.is_text() && node.parent().is_some_and(|p| p.tag_name().name() == "style")) {
            starts.extend(link_starts(svg, node.range(), if node.is_pi() { "href=" } else { "url(" }));
        }
        let is_picture = matches!(node.tag_name().name(), "image" | "feImage" | "img");
        for a in node.attributes() {
            let range = a.range_value();
            if !matches!(a.name(), "href" | "src") {
                starts.extend(link_starts(svg, range, "url("));
            } else if let Some(data) = embedded_picture(a.value(), is_picture && self.embed, options)? {
                new.insert(range.start, (range.end, data));
            } else {
                starts.push(range.end - svg[range].trim_start().len());
            }
        }
        for at in starts.into_iter().filter(|at| !self.way.is_empty() && is_relative(&svg[*at..])) {
            new.insert(at, (at, self.way.clone()));
        }
        Ok(())
    }
}

/// The positions in a range at which links begin, each after a word and perhaps a quotation mark.
fn link_starts<'a>(text: &'a str, range: Range<usize>, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    text[range.clone()].match_indices(word).map(move |(at, _)| {
        let inside = text[range.start + at + word.len()..range.end].trim_start();
        let quotes = ["&quot;", "&apos;", "\"", "'"];
        let inside = quotes.iter().find_map(|q| inside.strip_prefix(q)).unwrap_or(inside);
        range.end - inside.len()
    })
}

/// Returns `true` if a link, which text may follow, is relative to the folder of its drawing.
fn is_relative(text: &str) -> bool {
    let end = text.find(|c: char| c.is_whitespace() || "\"'()<>&".contains(c)).unwrap_or(text.len());
    let link = &text[..end];
    let scheme = link.split(['/', '#', '?']).next().is_some_and(|first| first.contains(':'));
    !link.is_empty() && !link.starts_with(['#', '/', '?', '\\']) && !scheme
}

/// A link that embeds the picture to which a link leads, if that is `wanted` and can be read.
fn embedded_picture(link: &str, wanted: bool, options: &ReadOptions) -> Result<Option<String>, Error> {
    let link = link.trim();
    let is_inside =
        link.is_empty() || link.starts_with('#') || link.get(..5).is_some_and(|s| s.eq_ignore_ascii_case("data:"));
    if !wanted || is_inside {
        return Ok(None);
    }
    let Target::File(file) = target(link, options) else { return Ok(None) };
    let Some(data) = read_linked(&file, options).map(Arc::new) else { return Ok(None) };
    if images::checked(ANY, Arc::clone(&data), link, options)?.is_none() {
        return Ok(None);
    }
    let media_type = match data.as_slice() {
        [0x89, b'P', ..] => "image/png",
        [0xff, 0xd8, ..] => "image/jpeg",
        [b'G', b'I', b'F', ..] => "image/gif",
        [b'R', b'I', b'F', b'F', ..] => "image/webp",
        _ => SVG,
    };
    // Browsers do not unpack embedded drawings.
    let unpacked = data.starts_with(GZIP).then(|| read::text(&data, link, &options.budget)).transpose()?;
    Ok(Some(embedded(media_type, unpacked.as_ref().map_or(&data, |text| text.as_bytes()))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_the_same_files() {
        let svg = "<?xml-stylesheet href='s.css'?><svg xmlns:xlink='http://www.w3.org/1999/xlink'><image href=\" p.png\"/>\
                   <use xlink:href='#a' fill='url( &quot;x.svg#b&quot; )'/><text title=\"href='t'\">href='u' url(v)</text>\
                   <!-- href='w' --><image href='data:image/png;base64,AA=='/><a href='https://x.org/'/>\
                   <style>a{src:url(f/a.woff)}</style></svg>";
        let way = Relinking { way: "../in%20put/".into(), embed: false };
        let new = way.of(svg, &ReadOptions::default()).unwrap().unwrap();
        let mut wanted = svg.to_owned();
        for (old, new) in [
            ("s.css", "../in%20put/s.css"),
            ("p.png", "../in%20put/p.png"),
            ("x.svg", "../in%20put/x.svg"),
            ("f/a.woff", "../in%20put/f/a.woff"),
        ] {
            wanted = wanted.replace(old, new);
        }
        assert_eq!(new, wanted);
        assert_eq!(Relinking::default().of(svg, &ReadOptions::default()).unwrap(), None);
    }

    #[test]
    fn links_name_files_as_browsers_read_them() {
        for (link, file) in [
            ("a%20b.png?x#y", "a b.png"),
            ("%2e%2E/s.png", "../s.png"),
            ("100%.png", "100%.png"),
            ("%e4%BD%a0.png", "你.png"),
            ("%ff.png", "%ff.png"),
            ("FILE:///etc/x%20y", "/etc/x y"),
            ("file://localhost/a", "/a"),
            ("%zz%4", "%zz%4"),
        ] {
            assert_eq!(path_in_link(link), file, "{link}");
        }
    }
}
