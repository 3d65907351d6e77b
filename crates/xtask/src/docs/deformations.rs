//! The pages of `docs/deformations`: one per deformation, generated from its [`Info`] and illustrated by its first example.

use crate::chore::{ChoreError, at};
use crate::shell;
use pathwarp::deform::{Info, Registry};
use pathwarp::param::Kind;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Folder of the pages.
const PAGES: &str = "docs/deformations";

/// Writes all pages and returns how many there are.
pub(super) fn write(root: &Path) -> Result<usize, ChoreError> {
    let folder = root.join(PAGES);
    fs::create_dir_all(&folder).map_err(at(&folder))?;
    let pages = pages();
    for (name, text) in &pages {
        let file = folder.join(name);
        fs::write(&file, text).map_err(at(&file))?;
    }
    Ok(pages.len())
}

/// Draws the picture of every page.
pub(super) fn draw(root: &Path, program: &Path) -> Result<(), ChoreError> {
    let folder = root.join(PAGES);
    for entry in Registry::builtin().entries() {
        let Some(example) = entry.info().examples.first() else { continue };
        shell::preview(root, program, example.command, &folder.join(format!("{}.png", entry.info().name)))?;
    }
    Ok(())
}

/// The file name and text of every page.
fn pages() -> Vec<(String, String)> {
    let registry = Registry::builtin();
    let infos: Vec<&Info> = registry.entries().iter().map(|e| e.info()).collect();
    let mut all: Vec<(String, String)> = infos.iter().map(|info| (format!("{}.md", info.name), page(info))).collect();
    all.push(("README.md".into(), index(&infos)));
    all
}

fn index(infos: &[&Info]) -> String {
    let mut out = String::from("# Deformations\n\nMade by `cargo xtask docs` from the deformations' own tables.\n");
    for group in infos.chunk_by(|a, b| a.group == b.group) {
        let _ = write!(out, "\n## {}\n\n| | |\n|---|---|\n", group[0].group);
        for info in group {
            let _ = writeln!(out, "| [{0}]({0}.md) | {1} |", info.name, info.title);
        }
    }
    out
}

fn page(info: &Info) -> String {
    let mut out = format!("# {}: {}\n\n", info.name, info.title);
    if let Some(first) = info.examples.first() {
        let _ = write!(out, "![{}]({}.png)\n\n", first.what, info.name);
    }
    let _ = write!(out, "{}\n\n## Examples\n", info.about);
    for example in info.examples {
        let _ = write!(out, "\n{}:\n\n```sh\npathwarp {}\n```\n", example.what, example.command);
    }
    out.push_str("\n## Options\n\n| option | value | default | |\n|---|---|---|---|\n");
    for param in info.params {
        let value = match param.kind {
            Kind::Flag => String::new(),
            Kind::Choice(words) => words.join(", "),
            Kind::NameOrFile(words) => format!("{}, or a file", words.join(", ")),
            _ => param.value_name(),
        };
        let default = param.default.map(|d| format!("`{d}`")).unwrap_or_default();
        let default = if param.needed { "needed".to_owned() } else { default };
        let times = if param.repeat { " May be given several times." } else { "" };
        let _ = writeln!(out, "| `--{}` | {value} | {default} | {}{times} |", param.name, cell(param.help));
    }
    out.push_str("| `--inverse` | | | The inverse map, where there is one. |\n");
    let _ = write!(
        out,
        "\nThe options that all deformations share are in `pathwarp help options`.\n\n## Source\n\n{}\n",
        info.source
    );
    out
}

/// Escapes text for a cell of a Markdown table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pages in the repository match the registry.
    #[test]
    fn pages_are_up_to_date() {
        let folder = crate::chore::workspace().join(PAGES);
        for (name, text) in pages() {
            let stored = fs::read_to_string(folder.join(&name)).unwrap_or_default();
            assert!(stored == text, "{PAGES}/{name} is out of date: run `cargo xtask docs`");
        }
        for e in Registry::builtin().entries() {
            assert!(folder.join(format!("{}.png", e.info().name)).is_file(), "{} has no picture", e.info().name);
        }
    }
}
