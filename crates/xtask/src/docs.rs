//! `cargo xtask docs`: a page for every deformation, from its own table, with a picture made by its first example; and the
//! cookbook; and the pictures of the guides.

use crate::{Fault, cookbook, guide};
use pathwarp::deform::{Info, Registry};
use pathwarp::param::Kind;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Where the pages lie.
const PAGES: &str = "docs/deformations";

/// What docs/gimp.md and the README show, and the command that draws it.
const GIMP_PICTURE: &str = "docs/images/gimp-paper.png";
const GIMP_EXAMPLE: &str = "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper'";

/// The sheet of styles that the README shows, and its artwork.
const SHEET: &str = "docs/images/styles.png";
const SHEET_OF: &str = "samples/logo.svg";

/// Writes all pages and pictures, drawn by `program` if one is named, else by one built for it.
pub(crate) fn run(root: &Path, program: Option<&Path>) -> Result<String, Fault> {
    let folder = root.join(PAGES);
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let pages = pages();
    for (name, text) in &pages {
        let file = folder.join(name);
        fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    let program = match program {
        Some(p) => p.to_owned(),
        None => build(root)?,
    };
    for e in Registry::builtin().entries() {
        let Some(example) = e.info().examples.first() else { continue };
        picture(root, &program, example.command, &folder.join(format!("{}.png", e.info().name)))?;
    }
    picture(root, &program, GIMP_EXAMPLE, &root.join(GIMP_PICTURE))?;
    guide::pipe(root, &program, &["gallery", SHEET_OF, "-o", SHEET].map(str::to_owned), &[])?;
    guide::run(root, &program)?;
    let jobs = cookbook::run(root, &program)?;
    Ok(format!(
        "wrote {} pages to {} and {jobs} jobs to the cookbook and its like; look at every picture before you commit it",
        pages.len(),
        folder.display()
    ))
}

/// The program that draws the pictures.
pub(crate) fn build(root: &Path) -> Result<std::path::PathBuf, Fault> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--release", "--package", "pathwarp-cli", "--target-dir"]).arg(root.join("target"));
    let done = cargo.current_dir(root).status().map_err(|e| e.to_string())?;
    if !done.success() {
        return Err("the program does not build".into());
    }
    Ok(root.join("target/release/pathwarp").with_extension(std::env::consts::EXE_EXTENSION))
}

/// Draws what a command makes of its artwork.
pub(crate) fn picture(root: &Path, program: &Path, command: &str, png: &Path) -> Result<(), Fault> {
    let mut stages = guide::stages(&format!("pathwarp {command}"));
    let Some(mut last) = stages.pop() else { return Ok(()) };
    let mut drawing = Vec::new();
    for stage in stages {
        drawing = guide::pipe(root, program, &stage, &drawing)?;
    }
    // A preview of the example's own is not wanted here.
    if let Some(i) = last.iter().position(|w| w == "--preview") {
        last.drain(i..(i + 2).min(last.len()));
    }
    last.retain(|w| w != "--explain");
    last.extend(["--quiet", "--preview"].map(str::to_owned));
    last.push(png.display().to_string());
    guide::pipe(root, program, &last, &drawing).map(drop)
}

/// Words of a shell command line with single quotes.
pub(crate) fn words(line: &str) -> Vec<String> {
    let mut out = Vec::new();
    for (i, part) in line.split('\'').enumerate() {
        if i % 2 == 1 {
            out.push(part.to_owned());
        } else {
            out.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    out
}

/// Every page: file name and text.
fn pages() -> Vec<(String, String)> {
    let registry = Registry::builtin();
    let infos: Vec<&Info> = registry.entries().iter().map(|e| e.info()).collect();
    let mut all: Vec<(String, String)> = infos.iter().map(|i| (format!("{}.md", i.name), page(i))).collect();
    all.push(("README.md".into(), index(&infos)));
    all
}

fn index(infos: &[&Info]) -> String {
    let mut out = String::from("# Deformations\n\nMade by `cargo xtask docs` from the deformations' own tables.\n");
    let mut groups: Vec<&str> = Vec::new();
    for i in infos {
        if !groups.contains(&i.group) {
            groups.push(i.group);
        }
    }
    for g in groups {
        let _ = write!(out, "\n## {g}\n\n| | |\n|---|---|\n");
        for i in infos.iter().filter(|i| i.group == g) {
            let _ = writeln!(out, "| [{0}]({0}.md) | {1} |", i.name, i.title);
        }
    }
    out
}

fn page(i: &Info) -> String {
    let mut out = format!("# {}: {}\n\n", i.name, i.title);
    if let Some(first) = i.examples.first() {
        let _ = write!(out, "![{}]({}.png)\n\n", first.what, i.name);
    }
    let _ = write!(out, "{}\n\n## Examples\n", i.about);
    for e in i.examples {
        let _ = write!(out, "\n{}:\n\n```sh\npathwarp {}\n```\n", e.what, e.command);
    }
    out.push_str("\n## Options\n\n| option | value | default | |\n|---|---|---|---|\n");
    for p in i.params {
        let value = match p.kind {
            Kind::Flag => String::new(),
            Kind::Choice(words) => words.join(", "),
            Kind::NameOrFile(words) => format!("{}, or a file", words.join(", ")),
            _ => p.value_name(),
        };
        let default =
            if p.needed { "needed".to_owned() } else { p.default.map(|d| format!("`{d}`")).unwrap_or_default() };
        let times = if p.repeat { " May be given several times." } else { "" };
        let _ = writeln!(out, "| `--{}` | {value} | {default} | {}{times} |", p.name, cell(p.help));
    }
    out.push_str("| `--inverse` | | | The inverse map, where there is one. |\n");
    let _ = write!(
        out,
        "\nThe options that all deformations share are in `pathwarp help {}`.\n\n## Source\n\n{}\n",
        i.name, i.source
    );
    out
}

/// Text that may stand in a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pages in the repository are the ones that would be made now.
    #[test]
    fn pages_are_up_to_date() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(PAGES);
        for (name, text) in pages() {
            let there = fs::read_to_string(folder.join(&name)).unwrap_or_default();
            assert!(there == text, "{PAGES}/{name} is out of date: run `cargo xtask docs`");
        }
        for e in Registry::builtin().entries() {
            assert!(folder.join(format!("{}.png", e.info().name)).is_file(), "{} has no picture", e.info().name);
        }
    }
}
