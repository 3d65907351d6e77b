//! Pictures of the guides: pages written by hand, each picture drawn by the command below it.

use crate::chore::{ChoreError, at};
use crate::shell::{pipe, stages, words};
use std::fs;
use std::path::Path;

/// The guides; their pictures are named relative to `docs/`.
const GUIDES: [&str; 2] = ["docs/lettering.md", "docs/solid.md"];
/// In the command of a picture of a model.
const PREVIEW: &str = "--preview out.png";
/// Width of a picture in pixels.
const WIDTH: &str = "800";

/// Draws the pictures of all guides.
pub(super) fn draw(root: &Path, program: &Path) -> Result<(), ChoreError> {
    for guide in GUIDES {
        let page = root.join(guide);
        let page = fs::read_to_string(&page).map_err(at(&page))?;
        for (png, command) in pictures(&page) {
            let png = root.join("docs").join(png);
            if let Some(folder) = png.parent() {
                fs::create_dir_all(folder).map_err(at(folder))?;
            }
            if command.contains(PREVIEW) {
                preview(root, program, &png, command)?;
                continue;
            }
            let mut drawing = Vec::new();
            for stage in stages(command) {
                drawing = pipe(root, program, &stage, &drawing)?;
            }
            let file = png.display().to_string();
            let render = ["render", "-", "--width", WIDTH, "--background", "white", "-o", &file].map(str::to_owned);
            pipe(root, program, &render, &drawing)?;
        }
    }
    Ok(())
}

/// The picture of a command that draws one itself, and whose result is a model.
fn preview(root: &Path, program: &Path, png: &Path, command: &str) -> Result<(), ChoreError> {
    let folder = std::env::temp_dir().join(format!("pathwarp-docs-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(at(&folder))?;
    let drawn = format!("--preview {}", png.display());
    let command = command.replace(PREVIEW, &drawn).replace(" -o out.", &format!(" -o {}/out.", folder.display()));
    // The extension of the output says what it is.
    let words = words(&command);
    let done = pipe(root, program, words.get(1..).unwrap_or_default(), &[]).map(drop);
    let _ = fs::remove_dir_all(&folder);
    done
}

/// Every picture of a page with the command that draws it: the next line that begins with `pathwarp`.
fn pictures(page: &str) -> Vec<(&str, &str)> {
    let mut out = Vec::new();
    let mut pending = None;
    for line in page.lines() {
        if let Some((_, rest)) = line.strip_prefix("![").and_then(|l| l.split_once("](")) {
            pending = rest.strip_suffix(')');
        } else if line.starts_with("pathwarp ") {
            out.extend(pending.take().map(|png| (png, line)));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chore::workspace;

    /// Every picture of a guide exists and is drawn by a command, and its folder holds no others.
    #[test]
    fn guides_have_their_pictures() {
        let root = workspace();
        for guide in GUIDES {
            let page = fs::read_to_string(root.join(guide)).unwrap();
            let all = pictures(&page);
            assert_eq!(all.len(), page.matches("![").count(), "{guide}");
            let mut expected: Vec<String> = all.iter().map(|(png, _)| (*png).to_owned()).collect();
            expected.sort();
            let folder = Path::new(&expected[0]).parent().unwrap();
            let files = fs::read_dir(root.join("docs").join(folder)).unwrap();
            let name = |f: fs::DirEntry| format!("{}/{}", folder.display(), f.file_name().into_string().unwrap());
            let mut found: Vec<String> = files.map(|f| name(f.unwrap())).collect();
            found.sort();
            assert_eq!(found, expected, "{guide}");
        }
    }
}
