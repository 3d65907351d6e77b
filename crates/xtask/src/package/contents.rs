//! The files of a package, in the layout they are installed in below `/`.

use crate::chore::{ChoreError, at};
use crate::shell;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The shells with completion scripts, and their files.
const COMPLETIONS: [(&str, &str); 3] = [
    ("bash", "usr/share/bash-completion/completions/pathwarp"),
    ("zsh", "usr/share/zsh/vendor-completions/_pathwarp"),
    ("fish", "usr/share/fish/vendor_completions.d/pathwarp.fish"),
];
/// Sizes of the icon as a bitmap, for desktops that do not draw SVG.
const ICON_SIZES: [u32; 3] = [48, 128, 256];
/// The folder of the documentation, laid out so that relative links in the README stay valid.
const DOCS: &str = "usr/share/doc/pathwarp";

/// A folder with the layout of `/`.
pub(super) struct Tree {
    /// The workspace.
    root: PathBuf,
    pub(super) folder: PathBuf,
    program: PathBuf,
}

impl Tree {
    /// Writes all files to `folder`, after emptying it. `program` writes its manual pages, completions and plug-ins.
    pub(super) fn lay_out(root: &Path, program: &Path, folder: &Path) -> Result<Self, ChoreError> {
        if folder.exists() {
            fs::remove_dir_all(folder).map_err(at(folder))?;
        }
        let tree = Self { root: root.to_owned(), folder: folder.to_owned(), program: program.to_owned() };
        tree.copy(program, "usr/bin/pathwarp")?;
        tree.run(&["man", "--out-dir", &tree.prepared("usr/share/man/man1")?.display().to_string()])?;
        for (shell, file) in COMPLETIONS {
            let script = tree.run(&["completions", shell])?;
            tree.write(file, &script)?;
        }
        tree.desktop()?;
        tree.plug_ins()?;
        tree.documentation()?;
        Ok(tree)
    }

    /// Adds the icon, and the desktop entry that opens a drawing in the editor.
    fn desktop(&self) -> Result<(), ChoreError> {
        const ICONS: &str = "usr/share/icons/hicolor";
        let icon = self.root.join("packaging/pathwarp.svg");
        self.copy(&icon, &format!("{ICONS}/scalable/apps/pathwarp.svg"))?;
        for size in ICON_SIZES {
            let picture = self.prepared(&format!("{ICONS}/{size}x{size}/apps/pathwarp.png"))?;
            let (icon, picture) = (icon.display().to_string(), picture.display().to_string());
            self.run(&["render", &icon, "--width", &size.to_string(), "-o", &picture])?;
        }
        self.copy(&self.root.join("packaging/pathwarp.desktop"), "usr/share/applications/pathwarp.desktop")
    }

    /// Adds the plug-ins for other programs, in the folders for plug-ins of all users. They find the program on the PATH.
    fn plug_ins(&self) -> Result<(), ChoreError> {
        let gimp = self.prepared(&format!("usr/lib/{}-linux-gnu/gimp/3.0/plug-ins", std::env::consts::ARCH))?;
        self.run(&["install", "gimp", "--dir", &gimp.display().to_string()])?;
        let copy = gimp.join("pathwarp-gimp/bin");
        fs::remove_dir_all(&copy).map_err(at(&copy))?;
        let inkscape = self.prepared("usr/share/inkscape/extensions")?;
        self.run(&["install", "inkscape", "--dir", &inkscape.display().to_string(), "--program", "pathwarp"]).map(drop)
    }

    fn documentation(&self) -> Result<(), ChoreError> {
        for file in ["README.md", "CHANGELOG.md"] {
            self.copy(&self.root.join(file), &format!("{DOCS}/{file}"))?;
        }
        for folder in ["docs", "samples"] {
            for file in shell::files_below(&self.root.join(folder), |_| true)? {
                let name = file.strip_prefix(&self.root).map_err(|e| e.to_string())?;
                self.copy(&file, &format!("{DOCS}/{}", name.display()))?;
            }
        }
        self.write(&format!("{DOCS}/copyright"), licences_text(&self.root)?.as_bytes())
    }

    /// The path of a file in the tree. Creates its folder.
    fn prepared(&self, file: &str) -> Result<PathBuf, ChoreError> {
        let path = self.folder.join(file);
        let folder = path.parent().unwrap_or(&self.folder);
        fs::create_dir_all(folder).map_err(at(folder))?;
        Ok(path)
    }

    fn copy(&self, from: &Path, to: &str) -> Result<(), ChoreError> {
        fs::copy(from, self.prepared(to)?).map(drop).map_err(at(from))
    }

    fn write(&self, to: &str, bytes: &[u8]) -> Result<(), ChoreError> {
        let to = self.prepared(to)?;
        fs::write(&to, bytes).map_err(at(&to))
    }

    /// Runs the program and returns its standard output.
    fn run(&self, args: &[&str]) -> Result<Vec<u8>, ChoreError> {
        let out = Command::new(&self.program).args(args).current_dir(&self.root).output().map_err(at(&self.program))?;
        if out.status.success() {
            return Ok(out.stdout);
        }
        Err(format!("pathwarp {}: {}", args.join(" "), String::from_utf8_lossy(&out.stderr)))
    }
}

/// Beginnings of the names of files with licences and copyright notices.
const NAMES: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"];
/// The bundled fonts with their licences.
const FONTS: [(&str, &str); 2] = [
    ("Noto Sans, the fallback font", "crates/pathwarp-svg/fonts/OFL-Noto.txt"),
    ("Fira Sans Extra Condensed Black, the font `display`", "crates/pathwarp-svg/fonts/OFL-Fira.txt"),
];
const RULE: &str = "------------------------------------------------------------------------";

/// The licences and copyright notices of the program and of everything linked into it.
pub(super) fn licences_text(root: &Path) -> Result<String, ChoreError> {
    let metadata = metadata(root)?;
    let mut out = String::from("pathwarp is licensed under MIT or Apache-2.0, at your option.\n\n");
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let _ = writeln!(out, "{RULE}\n{}", read(&root.join(file))?);
    }
    for (font, licence) in FONTS {
        let _ = writeln!(out, "{RULE}\n{font} inside the program:\n\n{}", read(&root.join(licence))?);
    }
    out += "These crates are linked into the program:\n\n";
    // Each text, with the crates that include it.
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
    let platform = format!("--filter-platform={}", host()?);
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--format-version=1", "--locked", &platform]).current_dir(root);
    let out = cargo.output().map_err(|e| e.to_string())?;
    if !out.status.success() {
        return Err(String::from_utf8_lossy(&out.stderr).into_owned());
    }
    serde_json::from_slice(&out.stdout).map_err(|e| e.to_string())
}

/// The third-party packages linked into the program, by name: without dependencies of builds or tests only, and without procedural macros.
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

/// The licence files in a folder. Where there is a choice of licences, the text of Apache-2.0 is left out.
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

/// The target triple of this machine.
pub(super) fn host() -> Result<String, ChoreError> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let out = Command::new(&rustc).arg("-vV").output().map_err(at(Path::new(&rustc)))?;
    let text = String::from_utf8_lossy(&out.stdout).into_owned();
    let host = text.lines().find_map(|l| l.strip_prefix("host: ")).ok_or("rustc -vV names no host")?;
    Ok(host.to_owned())
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
        let text = licences_text(&workspace()).unwrap();
        assert!(text.contains("Andrew Gallant"), "the notice of memchr");
        assert!(
            text.contains("SIL OPEN FONT LICENSE") && text.lines().all(|l| !(l.starts_with("  ") && l.ends_with(": ")))
        );
    }
}
