//! The licences of pathwarp and of everything that is linked into it, as one text: most of them ask for it.

use crate::chore::{ChoreError, at};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// How the names of files with licences and copyright notices begin.
const NAMES: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"];
/// The licence of the bundled font.
const FONT: &str = "crates/pathwarp-svg/fonts/OFL.txt";
const RULE: &str = "------------------------------------------------------------------------";

/// Returns the text.
pub(super) fn all(root: &Path) -> Result<String, ChoreError> {
    let metadata = metadata(root)?;
    let mut out = String::from("pathwarp is licensed under MIT or Apache-2.0, at your option.\n\n");
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let _ = writeln!(out, "{RULE}\n{}", read(&root.join(file))?);
    }
    let _ = writeln!(out, "{RULE}\nNoto Sans, the fallback font inside the program:\n\n{}", read(&root.join(FONT))?);
    out += "These crates are linked into the program:\n\n";
    // Texts, each with the crates that have it.
    let mut texts: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in linked(&metadata)? {
        let field = |name: &str| package[name].as_str().unwrap_or_default();
        let name = format!("{} {}", field("name"), field("version"));
        let _ = writeln!(out, "  {name}: {}", field("license"));
        let folder = Path::new(field("manifest_path")).parent().unwrap_or(root);
        for file in licences(folder)? {
            texts.entry(read(&file)?).or_default().insert(name.clone());
        }
    }
    for (text, crates) in texts {
        let crates: Vec<String> = crates.into_iter().collect();
        let _ = writeln!(out, "\n{RULE}\n{}:\n\n{}", crates.join(", "), text.trim_end());
    }
    Ok(out)
}

/// The packages of the workspace and their dependencies, as cargo resolves them for this machine.
fn metadata(root: &Path) -> Result<Value, ChoreError> {
    let platform = format!("--filter-platform={}", super::build::host()?);
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--format-version=1", "--locked", &platform]).current_dir(root);
    let out = cargo.output().map_err(|e| e.to_string())?;
    if !out.status.success() {
        return Err(String::from_utf8_lossy(&out.stderr).into_owned());
    }
    serde_json::from_slice(&out.stdout).map_err(|e| e.to_string())
}

/// The packages of others that the program contains, by name: not what only builds or tests need, and no procedural macros.
fn linked(metadata: &Value) -> Result<Vec<&Value>, ChoreError> {
    let packages: BTreeMap<&str, &Value> =
        array(&metadata["packages"]).filter_map(|p| Some((p["id"].as_str()?, p))).collect();
    let nodes: BTreeMap<&str, &Value> =
        array(&metadata["resolve"]["nodes"]).filter_map(|n| Some((n["id"].as_str()?, n))).collect();
    let program =
        packages.iter().find(|(_, p)| p["name"] == "pathwarp-cli").ok_or("there is no package pathwarp-cli")?;
    let (mut seen, mut next) = (BTreeSet::new(), vec![*program.0]);
    while let Some(id) = next.pop() {
        let is_macro = |p: &Value| array(&p["targets"]).any(|t| array(&t["kind"]).any(|k| k == "proc-macro"));
        if packages.get(id).is_none_or(|p| is_macro(p)) || !seen.insert(id) {
            continue;
        }
        let deps = nodes.get(id).into_iter().flat_map(|n| array(&n["deps"]));
        let normal = deps.filter(|d| array(&d["dep_kinds"]).any(|k| k["kind"].is_null()));
        next.extend(normal.filter_map(|d| d["pkg"].as_str()));
    }
    let mut found: Vec<&Value> =
        seen.iter().filter_map(|id| packages.get(id).copied()).filter(|p| !p["source"].is_null()).collect();
    found.sort_by_key(|p| (p["name"].as_str(), p["version"].as_str()));
    Ok(found)
}

fn array(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

/// The files in a folder that state a licence. Of a choice of licences, the text of Apache-2.0 is left out.
fn licences(folder: &Path) -> Result<Vec<PathBuf>, ChoreError> {
    let upper = |p: &Path| p.file_name().map(|n| n.to_string_lossy().to_uppercase()).unwrap_or_default();
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(at(folder))? {
        let path = entry.map_err(at(folder))?.path();
        if path.is_file() && NAMES.iter().any(|n| upper(&path).starts_with(n)) {
            files.push(path);
        }
    }
    files.sort();
    if files.iter().any(|f| !upper(f).contains("APACHE")) {
        files.retain(|f| !upper(f).contains("APACHE"));
    }
    Ok(files)
}

fn read(file: &Path) -> Result<String, ChoreError> {
    fs::read(file).map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).map_err(at(file))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chore::workspace;

    #[test]
    fn names_what_is_linked_and_nothing_else() {
        let metadata = metadata(&workspace()).unwrap();
        let names: Vec<&str> = linked(&metadata).unwrap().iter().filter_map(|p| p["name"].as_str()).collect();
        for name in ["kurbo", "usvg", "tiny-skia", "clap_builder"] {
            assert!(names.contains(&name), "{name} is missing: {names:?}");
        }
        // A dependency of tests, a procedural macro, and a crate of this workspace.
        for name in ["proptest", "serde_derive", "pathwarp-svg"] {
            assert!(!names.contains(&name), "{name}: {names:?}");
        }
    }

    #[test]
    fn every_crate_states_its_licence() {
        let text = all(&workspace()).unwrap();
        assert!(text.contains("Andrew Gallant"), "the notice of memchr");
        assert!(
            text.contains("SIL OPEN FONT LICENSE") && text.lines().all(|l| !(l.starts_with("  ") && l.ends_with(": ")))
        );
    }
}
