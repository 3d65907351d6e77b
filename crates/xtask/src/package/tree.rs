//! The files of a package, laid out as they will be installed below `/`.

use super::notices;
use crate::chore::{ChoreError, at};
use crate::files;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Completion scripts: the shell, and the file.
const COMPLETIONS: [(&str, &str); 3] = [
    ("bash", "usr/share/bash-completion/completions/pathwarp"),
    ("zsh", "usr/share/zsh/vendor-completions/_pathwarp"),
    ("fish", "usr/share/fish/vendor_completions.d/pathwarp.fish"),
];
/// Sizes of the icon as a picture, for desktops that do not draw SVG.
const ICON_SIZES: [u32; 3] = [48, 128, 256];
/// Documentation; the README's relative links to it stay valid.
const DOCS: &str = "usr/share/doc/pathwarp";

/// A folder laid out as below `/`.
pub(super) struct Tree {
    /// The workspace.
    root: PathBuf,
    pub(super) folder: PathBuf,
    program: PathBuf,
}

impl Tree {
    /// Writes all files to `folder`, which is emptied first. `program` writes those that follow from its options.
    pub(super) fn lay_out(root: &Path, program: &Path, folder: &Path) -> Result<Self, ChoreError> {
        if folder.exists() {
            fs::remove_dir_all(folder).map_err(at(folder))?;
        }
        let tree = Self { root: root.to_owned(), folder: folder.to_owned(), program: program.to_owned() };
        tree.copy(program, "usr/bin/pathwarp")?;
        tree.run(&["man", "--out-dir", &tree.at("usr/share/man/man1")?.display().to_string()])?;
        for (shell, file) in COMPLETIONS {
            let script = tree.run(&["completions", shell])?;
            tree.write(file, &script)?;
        }
        tree.desktop()?;
        tree.plug_ins()?;
        tree.documentation()?;
        Ok(tree)
    }

    /// The icon, and the entry that opens a drawing in the editor.
    fn desktop(&self) -> Result<(), ChoreError> {
        const ICONS: &str = "usr/share/icons/hicolor";
        let icon = self.root.join("packaging/pathwarp.svg");
        self.copy(&icon, &format!("{ICONS}/scalable/apps/pathwarp.svg"))?;
        for size in ICON_SIZES {
            let picture = self.at(&format!("{ICONS}/{size}x{size}/apps/pathwarp.png"))?;
            let (icon, picture) = (icon.display().to_string(), picture.display().to_string());
            self.run(&["render", &icon, "--width", &size.to_string(), "-o", &picture])?;
        }
        self.copy(&self.root.join("packaging/pathwarp.desktop"), "usr/share/applications/pathwarp.desktop")
    }

    /// The plug-ins for other programs, where these look for what is installed for all users. They find the program on the PATH.
    fn plug_ins(&self) -> Result<(), ChoreError> {
        let gimp = self.at(&format!("usr/lib/{}-linux-gnu/gimp/3.0/plug-ins", std::env::consts::ARCH))?;
        self.run(&["install", "gimp", "--dir", &gimp.display().to_string()])?;
        let copy = gimp.join("pathwarp-gimp/bin");
        fs::remove_dir_all(&copy).map_err(at(&copy))?;
        let inkscape = self.at("usr/share/inkscape/extensions")?;
        self.run(&["install", "inkscape", "--dir", &inkscape.display().to_string(), "--program", "pathwarp"]).map(drop)
    }

    fn documentation(&self) -> Result<(), ChoreError> {
        for file in ["README.md", "CHANGELOG.md"] {
            self.copy(&self.root.join(file), &format!("{DOCS}/{file}"))?;
        }
        for folder in ["docs", "samples"] {
            for file in files::below(&self.root.join(folder), |_| true)? {
                let name = file.strip_prefix(&self.root).map_err(|e| e.to_string())?;
                self.copy(&file, &format!("{DOCS}/{}", name.display()))?;
            }
        }
        self.write(&format!("{DOCS}/copyright"), notices::all(&self.root)?.as_bytes())
    }

    /// A file of the tree; its folder is made.
    fn at(&self, file: &str) -> Result<PathBuf, ChoreError> {
        let path = self.folder.join(file);
        let folder = path.parent().unwrap_or(&self.folder);
        fs::create_dir_all(folder).map_err(at(folder))?;
        Ok(path)
    }

    fn copy(&self, from: &Path, to: &str) -> Result<(), ChoreError> {
        fs::copy(from, self.at(to)?).map(drop).map_err(at(from))
    }

    fn write(&self, to: &str, bytes: &[u8]) -> Result<(), ChoreError> {
        let to = self.at(to)?;
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
