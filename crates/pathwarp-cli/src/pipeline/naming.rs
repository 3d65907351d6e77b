//! Names of output files: under the input's own name in a folder, or by a pattern with `{stem}`.

use crate::input::svg_name;
use std::path::{Component, Path, PathBuf};

/// The part of a name that stands for the input's file name without extension.
const STEM: &str = "{stem}";

/// Returns `true` if `name` gives every input an output of its own.
pub(super) fn is_pattern(name: &Path) -> bool {
    name.to_string_lossy().contains(STEM)
}

/// The first `{word}` in a name that stands for nothing.
pub(super) fn unknown_placeholder(name: &Path) -> Option<String> {
    let name = name.to_string_lossy();
    let inner = name.split('{').skip(1).filter_map(|rest| Some(rest.split_once('}')?.0));
    let is_word = |w: &&str| w.chars().all(|c| c.is_alphanumeric() || "_-.:".contains(c));
    inner.filter(is_word).find(|w| format!("{{{w}}}") != STEM).map(|w| format!("{{{w}}}"))
}

/// The folders of a pattern before the first with `{stem}`: the same for every input.
pub(super) fn fixed_folder(pattern: &Path) -> PathBuf {
    let is_fixed = |c: &Component<'_>| !is_pattern(Path::new(c.as_os_str()));
    pattern.components().take_while(is_fixed).collect()
}

/// The output of `input` by the file name `pattern`. `below` is the input's folder below one given with `--recursive`; it is
/// repeated. `None` if the input has no name.
pub(super) fn by_pattern(pattern: &Path, input: &Path, below: &Path) -> Option<PathBuf> {
    let named = PathBuf::from(pattern.to_string_lossy().replace(STEM, &stem(input)?));
    let file = named.file_name()?;
    Some(named.parent().unwrap_or(Path::new("")).join(below).join(file))
}

/// The output of `input` in the folder `dir`, which may be a pattern: of a folder, or of a file with an extension. In a folder it
/// has the input's name, with `extension` if given. `None` if the input has no name.
pub(super) fn in_folder(dir: &Path, input: &Path, below: &Path, extension: Option<&str>) -> Option<PathBuf> {
    let last = dir.file_name().unwrap_or_default();
    if is_pattern(Path::new(last)) && dir.extension().is_some() {
        return by_pattern(dir, input, below);
    }
    let name = own_name(input)?;
    let name = extension.map_or(name.clone(), |e| name.with_extension(e));
    let dir = if is_pattern(dir) { dir.to_string_lossy().replace(STEM, &stem(input)?).into() } else { dir.to_owned() };
    Some(dir.join(below).join(name))
}

/// The file name of an input's result: its own, or that of the SVG made from a GIMP file.
fn own_name(input: &Path) -> Option<PathBuf> {
    if let Some(name) = svg_name(input) {
        return Some(name.into());
    }
    input.file_name().filter(|name| *name != "-").map(PathBuf::from)
}

fn stem(input: &Path) -> Option<String> {
    Some(own_name(input)?.file_stem()?.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_and_folders() {
        let input = Path::new("art/sub/cat.svg");
        let named =
            |dir: &str, below: &str, extension| in_folder(Path::new(dir), input, Path::new(below), extension).unwrap();
        let name = |dir: &str, below: &str| named(dir, below, None);
        assert_eq!(name("out", ""), Path::new("out/cat.svg"));
        assert_eq!(name("out", "sub"), Path::new("out/sub/cat.svg"));
        assert_eq!(name("out/{stem}", ""), Path::new("out/cat/cat.svg"));
        assert_eq!(name("out/{stem}-bent.svg", "sub"), Path::new("out/sub/cat-bent.svg"));
        assert_eq!(name("out/v1.2", ""), Path::new("out/v1.2/cat.svg"));
        assert_eq!(by_pattern(Path::new("{stem}.png"), input, Path::new("")).unwrap(), Path::new("cat.png"));
        assert_eq!(named("out", "sub", Some("pdf")), Path::new("out/sub/cat.pdf"));
        assert_eq!(named("out/{stem}", "", Some("pdf")), Path::new("out/cat/cat.pdf"));
        assert_eq!(named("out/{stem}.dxf", "", Some("pdf")), Path::new("out/cat.dxf"));
        assert_eq!(in_folder(Path::new("out"), Path::new("-"), Path::new(""), None), None);
        assert_eq!(fixed_folder(Path::new("out/a/{stem}/x.svg")), Path::new("out/a"));
    }
}
