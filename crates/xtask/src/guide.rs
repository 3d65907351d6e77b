//! Guides: pages written by hand, whose pictures are drawn by the commands below them.

use crate::{Fault, docs};
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// The pages; their pictures are named from `docs/`.
const GUIDES: [&str; 1] = ["docs/lettering.md"];
/// Pixels across a picture.
const WIDTH: &str = "800";

/// Draws the pictures of all guides; gives their number.
pub(crate) fn run(root: &Path, program: &Path) -> Result<usize, Fault> {
    let mut count = 0;
    for guide in GUIDES {
        let page = fs::read_to_string(root.join(guide)).map_err(|e| format!("{guide}: {e}"))?;
        for (png, command) in pictures(&page) {
            let png = root.join("docs").join(png);
            if let Some(folder) = png.parent() {
                fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
            }
            let mut drawing = Vec::new();
            for stage in stages(command) {
                drawing = pipe(root, program, &stage, &drawing)?;
            }
            let file = png.display().to_string();
            let render = ["render", "-", "--width", WIDTH, "--background", "white", "-o", &file].map(str::to_owned);
            pipe(root, program, &render, &drawing)?;
            count += 1;
        }
    }
    Ok(count)
}

/// Every picture of a page, with the command that draws it: the next line that begins with `pathwarp`.
fn pictures(page: &str) -> Vec<(&str, &str)> {
    let mut out = Vec::new();
    let mut wanted = None;
    for line in page.lines() {
        if let Some((_, rest)) = line.strip_prefix("![").and_then(|l| l.split_once("](")) {
            wanted = rest.strip_suffix(')');
        } else if line.starts_with("pathwarp ") {
            out.extend(wanted.take().map(|png| (png, line)));
        }
    }
    out
}

/// The commands of a pipeline, each without its first word; what the last one writes to a file goes to standard output.
pub(crate) fn stages(line: &str) -> Vec<Vec<String>> {
    let words = docs::words(line);
    let stages = words.split(|w| w == "|").map(|stage| {
        let mut stage: Vec<String> = stage.iter().skip(1).cloned().collect();
        if let Some(i) = stage.iter().position(|w| w == "-o") {
            stage.drain(i..(i + 2).min(stage.len()));
            stage.extend(["-o".to_owned(), "-".to_owned()]);
        }
        stage
    });
    stages.collect()
}

pub(crate) fn pipe(root: &Path, program: &Path, args: &[String], input: &[u8]) -> Result<Vec<u8>, Fault> {
    let fault = |e: std::io::Error| format!("{}: {e}", program.display());
    let mut command = Command::new(program);
    command.args(args).current_dir(root).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(fault)?;
    if let Some(mut stdin) = child.stdin.take() {
        // Who does not read closes the pipe; that is no fault.
        let _ = stdin.write_all(input);
    }
    let out = child.wait_with_output().map_err(fault)?;
    if out.status.success() && out.stderr.is_empty() {
        return Ok(out.stdout);
    }
    Err(format!("pathwarp {}: {}", args.join(" "), String::from_utf8_lossy(&out.stderr)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every picture of a guide is there, is drawn by a command, and there are none besides.
    #[test]
    fn guides_have_their_pictures() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for guide in GUIDES {
            let page = fs::read_to_string(root.join(guide)).unwrap();
            let all = pictures(&page);
            assert_eq!(all.len(), page.matches("![").count(), "{guide}");
            let mut wanted: Vec<String> = all.iter().map(|(png, _)| (*png).to_owned()).collect();
            wanted.sort();
            let folder = Path::new(&wanted[0]).parent().unwrap();
            let files = fs::read_dir(root.join("docs").join(folder)).unwrap();
            let name = |f: fs::DirEntry| format!("{}/{}", folder.display(), f.file_name().into_string().unwrap());
            let mut found: Vec<String> = files.map(|f| name(f.unwrap())).collect();
            found.sort();
            assert_eq!(found, wanted, "{guide}");
        }
    }

    #[test]
    fn pipelines_are_taken_apart() {
        let all = stages("pathwarp text 'a | b' | pathwarp bend - -o out.svg");
        assert_eq!(all, [vec!["text", "a | b"], vec!["bend", "-", "-o", "-"]]);
    }
}
