//! The pictures of the guides. Guides are written by hand, and each picture is drawn by the command below it.

use crate::chore::{ChoreError, at};
use crate::shell::{self, pipe, stages, words};
use pathwarp::{Outline, Seg};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// The guides. They name their pictures by relative paths.
const GUIDES: [&str; 9] = [
    "README.md",
    "docs/lettering.md",
    "docs/paths.md",
    "docs/solid.md",
    "docs/cookbook.md",
    "docs/lettering-on-paths.md",
    "docs/nodes.md",
    COMPARISON,
    "docs/papers.md",
];
/// The guide of small pictures in tables.
const COMPARISON: &str = "docs/which.md";
/// Guides whose pictures show the artwork beside the result.
const COOKBOOKS: [&str; 3] = ["docs/cookbook.md", "docs/lettering-on-paths.md", "docs/nodes.md"];
/// Marks the command of a picture of a model.
const PREVIEW: &str = "--preview out.png";
/// Options of commands that make many drawings: from a folder, and from a table.
const MANY: [&str; 2] = ["--out-dir", "--data"];
/// Widths of pictures in pixels.
const WIDTH: &str = "800";
const SMALL: &str = "400";

/// Draws the pictures of all guides.
pub(super) fn draw(root: &Path, program: &Path) -> Result<(), ChoreError> {
    for guide in GUIDES {
        let page = root.join(guide);
        let page = fs::read_to_string(&page).map_err(at(&page))?;
        for (png, command) in pictures(&page) {
            let png = root.join(guide).with_file_name(png);
            if let Some(folder) = png.parent() {
                fs::create_dir_all(folder).map_err(at(folder))?;
            }
            let words = words(command);
            let photograph = words.iter().find(|w| w.ends_with(".jpg"));
            if COOKBOOKS.contains(&guide) && photograph.is_none() {
                shell::preview(root, program, command.trim_start_matches("pathwarp "), &png)?;
            } else if MANY.iter().any(|option| command.contains(option)) {
                sheet(root, program, &png, command)?;
            } else if command.contains(PREVIEW) {
                preview(root, program, &png, command)?;
            } else if words.get(1).is_some_and(|subcommand| subcommand == "simplify") && words.len() > 2 {
                nodes(root, program, &png, (&words[2], command))?;
            } else if let Some(photograph) = photograph {
                beside(root, program, &png, (photograph, &written(root, program, command)?))?;
            } else {
                let width = if guide == COMPARISON { SMALL } else { WIDTH };
                shell::render(root, program, &written(root, program, command)?, width, &png)?;
            }
        }
    }
    Ok(())
}

/// The file that a command writes. Unlike on standard output, pages of text have a margin there.
fn written(root: &Path, program: &Path, command: &str) -> Result<Vec<u8>, ChoreError> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let file = folder.path().join(words(command).last().ok_or("no output")?);
    let mut all = stages(command);
    if let Some(to) = all.last_mut().and_then(|stage| stage.last_mut()) {
        *to = file.display().to_string();
    }
    all.iter().try_fold(Vec::new(), |drawing, stage| pipe(root, program, stage, &drawing))?;
    fs::read(&file).map_err(at(&file))
}

/// Draws the picture for a command that makes many drawings: the drawings of a folder in a row above their results, or the results of a
/// table.
fn sheet(root: &Path, program: &Path, png: &Path, command: &str) -> Result<(), ChoreError> {
    /// The sides of a drawing on the sheet, and the space between drawings.
    const SQUARE: [usize; 2] = [100, 100];
    const NAME: [usize; 2] = [100, 34];
    const GAP: usize = 20;
    /// Names in a row.
    const NAMES: usize = 8;
    let made = tempfile::tempdir().map_err(|e| e.to_string())?;
    let mut words = words(command);
    let last = words.pop().ok_or("no output")?;
    let source = words.iter().find(|w| w.starts_with("samples/")).ok_or("no samples")?;
    let is_folder = root.join(source).is_dir();
    let below = |folder: &Path| shell::files_below(folder, |f| shell::ends_in(f, &["svg"]));
    let mut files = if is_folder { below(&root.join(source))? } else { Vec::new() };
    let (columns, [width, height]) = if is_folder { (files.len(), SQUARE) } else { (NAMES, NAME) };
    let name = Path::new(&last).file_name().filter(|_| !is_folder).unwrap_or_default();
    words.push(made.path().join(name).display().to_string());
    pipe(root, program, &words[1..], &[])?;
    files.extend(below(made.path())?);
    let mut sheet = String::new();
    for (i, file) in files.iter().enumerate() {
        let drawing = fs::read_to_string(file).map_err(at(file))?;
        let start = drawing.find("<svg ").ok_or("no drawing")? + "<svg ".len();
        // Nest the whole drawing in the sheet, with a new position and size.
        let inner = drawing[start..].replacen(" width=", " data-width=", 1).replacen(" height=", " data-height=", 1);
        let (x, y) = (GAP + (i % columns) * (width + GAP), GAP + (i / columns) * (height + GAP));
        let _ = write!(sheet, "<svg x='{x}' y='{y}' width='{width}' height='{height}' {inner}");
    }
    let size = [(columns, width), (files.len().div_ceil(columns), height)].map(|(n, side)| GAP + n * (side + GAP));
    let open = format!("<svg xmlns='http://www.w3.org/2000/svg' width='{}' height='{}'>", size[0], size[1]);
    shell::render(root, program, format!("{open}{sheet}</svg>").as_bytes(), WIDTH, png)
}

/// Draws a photograph and, beside it at the same height, the result of a command on it.
fn beside(root: &Path, program: &Path, png: &Path, (photograph, made): (&str, &[u8])) -> Result<(), ChoreError> {
    /// The height of both, and the space between them.
    const HEIGHT: f64 = 300.0;
    const GAP: f64 = 20.0;
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let taken = fs::read(root.join(photograph)).map_err(at(&root.join(photograph)))?;
    let (mut images, mut x) = (String::new(), 0.0);
    for (name, content) in [("before", &taken[..]), ("after", made)] {
        let (width, height) = pathwarp_raster::header_size(content).map_err(|e| e.to_string())?;
        let width = HEIGHT * f64::from(width) / f64::from(height);
        let _ = write!(images, "<image x='{x}' width='{width}' height='{HEIGHT}' href='{name}'/>");
        x += width + GAP;
        fs::write(folder.path().join(name), content).map_err(at(png))?;
    }
    let drawing = folder.path().join("drawing.svg");
    let open = format!("<svg xmlns='http://www.w3.org/2000/svg' width='{}' height='{HEIGHT}'>", x - GAP);
    fs::write(&drawing, format!("{open}{images}</svg>")).map_err(at(&drawing))?;
    let [drawing, png] = [&drawing, png].map(|file| file.display().to_string());
    pipe(root, program, &["render", &drawing, "--width", WIDTH, "-o", &png].map(str::to_owned), &[]).map(drop)
}

/// Draws the picture for a command that reduces the number of nodes: the drawing before and after, with its nodes.
fn nodes(root: &Path, program: &Path, png: &Path, (source, command): (&str, &str)) -> Result<(), ChoreError> {
    /// The radius of a node, and the offset of the second drawing downwards, as fractions of a drawing's height.
    const NODE: f64 = 0.008;
    const DOWN: f64 = 1.05;
    let before = fs::read_to_string(root.join(source)).map_err(at(&root.join(source)))?;
    let stage = stages(command).remove(0);
    let after = String::from_utf8(pipe(root, program, &stage, &[])?).map_err(|e| e.to_string())?;
    let view = before.split_once("viewBox=\"0 0 ").and_then(|v| v.1.split_once('"')).ok_or("no viewBox")?.0;
    let (width, height) = view.split_once(' ').ok_or("no viewBox")?;
    let height: f64 = height.parse().map_err(|_| "no viewBox")?;
    let mut sheet = String::new();
    for (row, drawing) in [&before, &after].into_iter().enumerate() {
        let _ = write!(sheet, "<g transform='translate(0 {})'>", row as f64 * DOWN * height);
        for data in drawing.split(" d=\"").skip(1).filter_map(|d| d.split_once('"')).map(|d| d.0) {
            let _ = write!(sheet, "<path fill='#c9d3e6' d='{data}'/>");
            let outline = Outline::from_svg(data).map_err(|e| e.to_string())?;
            for p in outline.segs().map(Seg::start) {
                let _ = write!(sheet, "<circle fill='#c2321f' cx='{}' cy='{}' r='{}'/>", p.x, p.y, NODE * height);
            }
        }
        sheet.push_str("</g>");
    }
    let open = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {}'>", (1.0 + DOWN) * height);
    shell::render(root, program, format!("{open}{sheet}</svg>").as_bytes(), WIDTH, png)
}

/// Draws the picture for a command on a model, by its option for previews.
fn preview(root: &Path, program: &Path, png: &Path, command: &str) -> Result<(), ChoreError> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    // The output needs a real name: its extension gives the format.
    let output = format!(" -o {}/out.", folder.path().display());
    let drawn = format!("--preview {}", png.display());
    let words = words(&command.replace(PREVIEW, &drawn).replace(" -o out.", &output));
    pipe(root, program, words.get(1..).unwrap_or_default(), &[]).map(drop)
}

/// Every picture of a page, with the command that draws it: the one in its table row, else the next line that starts with `pathwarp`.
fn pictures(page: &str) -> Vec<(&str, &str)> {
    let mut out = Vec::new();
    let mut pending = None;
    for line in page.lines() {
        let row = line.strip_prefix("| ");
        if let Some((_, rest)) = row.unwrap_or(line).strip_prefix("![").and_then(|l| l.split_once("](")) {
            pending = rest.split_once(')').map(|(png, _)| png);
        }
        let code = row.and_then(|row| row.split('`').find(|code| code.starts_with("pathwarp ")));
        if let Some(command) = code.or(Some(line).filter(|line| line.starts_with("pathwarp "))) {
            out.extend(pending.take().map(|png| (png, command)));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chore::workspace;

    /// Every picture of a guide exists and is drawn by a command, and there are no other files in the folder.
    #[test]
    fn guides_have_their_pictures() {
        let root = workspace();
        for guide in GUIDES {
            let page = fs::read_to_string(root.join(guide)).unwrap();
            let all = pictures(&page);
            // The first command of the README is one of cargo, not of pathwarp.
            let first = usize::from(guide == "README.md");
            assert_eq!(all.len(), page.matches("![").count() - first, "{guide}");
            let mut expected: Vec<String> = all.iter().map(|(png, _)| (*png).to_owned()).collect();
            expected.sort();
            let folder = Path::new(&expected[0]).parent().unwrap();
            let files = fs::read_dir(root.join(guide).with_file_name(folder)).unwrap();
            let name = |f: fs::DirEntry| format!("{}/{}", folder.display(), f.file_name().into_string().unwrap());
            let mut found: Vec<String> = files.map(|f| name(f.unwrap())).collect();
            found.sort();
            assert_eq!(found, expected, "{guide}");
        }
    }
}
