//! Warped documents in an installed Inkscape: opened, edited and saved, they must look as pathwarp left them.

mod drawings;
mod editor;
mod extension;
mod hand;
mod meshes;

use crate::support::{inkscape_drawing, pathwarp, root};
use drawings::DRAWINGS;
use pathwarp::kurbo::Affine;
use pathwarp_oracle::drawings::rendered;
use pathwarp_oracle::on_white;
use pathwarp_svg::usvg_tree::parse_tree;
use std::fs;
use std::path::{Path, PathBuf};

/// Drawings of which only a part is warped. In the others, the part that stays is live, and Inkscape may compute it again.
const IN_PART: [&str; 5] = ["3D box", "path effect of a group", "clip path and mask", "clones", "texts"];

/// Largest mean difference, of 255.
const MOST: f64 = 0.5;
/// Width and height of the pictures.
const SIZE: u32 = 400;

/// Mean difference of the channels of two files' pictures on white, of 255.
fn difference(a: &Path, b: &Path) -> f64 {
    let [a, b] = [a, b].map(|f| {
        let svg = fs::read(f).unwrap_or_else(|e| panic!("{}: {e}", f.display()));
        let tree = parse_tree(&svg, "picture", &pathwarp_oracle::drawings::options()).unwrap();
        let side = f64::from(tree.size().width().max(tree.size().height()));
        on_white(rendered(&tree, SIZE, Affine::scale(f64::from(SIZE) / side)))
    });
    // Both pictures are opaque now.
    pathwarp_oracle::difference(&a, &b).mean * 4.0 / 3.0
}

/// Warps files in several ways, given as options. Returns the names of the results in the folder.
fn warped(folder: &Path, files: &[PathBuf], ways: &[&str]) -> Vec<String> {
    let mut out = Vec::new();
    for file in files {
        for way in ways {
            let name = format!("{}{way}", file.file_stem().unwrap().display()).replace([' ', '#'], "_");
            let to = folder.join(format!("{name}.svg")).display().to_string();
            let mut args = vec!["warp", "--style", "arch", file.to_str().unwrap(), "-q", "-o", &to];
            args.extend(way.split_whitespace());
            let done = pathwarp(&args);
            // Exit code 1: something in the file cannot be warped, and is reported.
            assert!(matches!(done.status.code(), Some(0 | 1)), "{args:?}\n{}", String::from_utf8_lossy(&done.stderr));
            out.push(name);
        }
    }
    out
}

#[test]
fn inkscape_leaves_what_is_warped_alone() {
    if !editor::is_installed() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let sources = folder.join("sources");
    fs::create_dir(&sources).unwrap();
    let source = |name: &str, body: &str| {
        let file = sources.join(format!("{name}.svg"));
        fs::write(&file, inkscape_drawing(body)).unwrap();
        file
    };
    let files: Vec<PathBuf> = DRAWINGS.iter().map(|(name, body)| source(name, body)).collect();
    let ways = ["", " --structure flatten", " --strokes outline", " --strokes keep", " --select #a"];
    // A clip path is not selected by itself; it follows the object that it clips.
    let (clipping, others): (Vec<_>, Vec<_>) =
        files.iter().cloned().partition(|f| f.ends_with("clip path and mask.svg"));
    let mut names = warped(folder, &others, &ways);
    names.extend(warped(folder, &clipping, &[&ways[..4], &[" --select #g"]].concat()));
    let in_part = files.iter().filter(|f| IN_PART.iter().any(|n| f.ends_with(format!("{n}.svg"))));
    names.extend(warped(folder, &in_part.cloned().collect::<Vec<_>>(), &[" --exclude #a"]));
    // Documents that Inkscape saved, beside the project's working copies.
    if let Ok(shared) = fs::read_dir(root().join("../shared/inkscape")) {
        let saved: Vec<PathBuf> = shared.map(|f| f.unwrap().path()).collect();
        names.extend(warped(folder, &saved, &ways[..2]));
    }
    if let Some(examples) = editor::examples() {
        names.extend(warped(folder, &examples, &ways[..1]));
    }
    // The comparison can fail: a path with the attributes of a star is drawn as a star.
    let star = fs::read_to_string(folder.join("star.svg")).unwrap();
    let live = "<path sodipodi:type='star' sodipodi:sides='5' sodipodi:cx='100' sodipodi:cy='100' sodipodi:r1='80' \
                sodipodi:r2='32' sodipodi:arg1='-1.57' sodipodi:arg2='-0.94' ";
    fs::write(folder.join("live.svg"), star.replace("<path ", live)).unwrap();
    names.push("live".into());

    editor::edit(folder, &names);
    let gaps = names.iter().map(|n| {
        let gap = difference(&folder.join(format!("{n}.svg")), &folder.join(format!("{n}.edited.svg")));
        println!("{n}: {gap:.3}");
        (n.as_str(), gap)
    });
    let bad: Vec<_> = gaps.filter(|g| g.1 > MOST).collect();
    assert!(matches!(bad[..], [("live", gap)] if gap > 20.0 * MOST), "{bad:#?}");
}
