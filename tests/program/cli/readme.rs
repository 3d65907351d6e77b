//! Every block of commands on samples in the README, in the pages of docs/ and in the table of other programs' words runs word for word in
//! a shell, in a folder with the contents of a copy of the repository.
#![cfg(unix)]

use crate::support::{expect_code, pathwarp_program, root};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Runs a block as pasted, and returns its messages.
fn paste(folder: &Path, block: &str) -> String {
    for name in ["samples", "crates"] {
        let link = folder.join(name);
        if !link.exists() {
            std::os::unix::fs::symlink(root().join(name), link).unwrap();
        }
    }
    let programs = pathwarp_program().parent().unwrap().display().to_string();
    let path = format!("{programs}:{}", std::env::var("PATH").unwrap());
    let shell = Command::new("sh").args(["-e", "-c", block]).current_dir(folder).env("PATH", &path).output().unwrap();
    let said = String::from_utf8_lossy(&shell.stderr).into_owned();
    assert!(shell.status.success(), "{block}\n{said}");
    said
}

/// Returns `true` if there are no warnings; notes, for instance of a page that grew, are allowed.
fn is_quiet(said: &str) -> bool {
    // Messages about gradients that become pictures are no fault of the command.
    said.lines().all(|l| l.starts_with("note: ") || l.contains("became a picture") || l.contains("became pictures"))
}

/// Returns the blocks of commands of a page that need no files except samples. The editor would wait for its reader.
fn blocks(page: &str) -> impl Iterator<Item = &str> {
    let blocks = page.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    blocks.filter(|b| {
        let runs = b.starts_with("pathwarp ") || b.starts_with("# ");
        runs && !b.starts_with("pathwarp edit ") && (b.contains("samples/") || b.contains("pathwarp text "))
    })
}

#[test]
fn every_block_of_commands_runs() {
    let mut pages = vec![root().join("README.md")];
    // The pages of deformations show the registry's examples, which run in `every_example_in_help_runs`.
    pages.extend(fs::read_dir(root().join("docs")).unwrap().map(|f| f.unwrap().path()).filter(|p| p.is_file()));
    let mut run = 0;
    for page in pages {
        let dir = tempfile::tempdir().unwrap();
        // Commands on the front page and in the cookbook give no warnings.
        let quiet = page.ends_with("README.md") || page.ends_with("docs/cookbook.md");
        for block in blocks(&fs::read_to_string(&page).unwrap()) {
            let said = paste(dir.path(), block);
            assert!(is_quiet(&said) || !quiet, "{block}\n{said}");
            run += 1;
        }
    }
    assert!(run >= 50, "{run} blocks");
}

/// The pages that compare similar deformations, and that of the papers' figures, have their commands in tables.
#[test]
fn every_command_in_a_table_runs() {
    let dir = tempfile::tempdir().unwrap();
    for (page, least) in [("docs/which.md", 25), ("docs/papers.md", 25)] {
        let page = fs::read_to_string(root().join(page)).unwrap();
        let commands: Vec<&str> = page.split('`').filter(|code| code.contains(" -o out.")).collect();
        assert!(commands.len() > least);
        for command in commands {
            let said = paste(dir.path(), command);
            assert!(is_quiet(&said), "{command}: {said}");
        }
    }
}

/// Help finds words of the papers, and words that only the help of a deformation has.
#[test]
fn help_knows_words_of_the_papers() {
    let words = "base|target|anchor|16 points|inner points|completion|infinity|Koppinen|FFD|Bernstein|freeze|continuity|weight|EFFD|\
                 direct manipulation|monoid|Cremona|preimage|moving line|implicit|general position|backward mapping|de Casteljau|\
                 handle|skeleton|taper|swell|Barr|B-spline|Coons|Bézier|anamorphosis|AFFD|collineation|stereographic|Ames room|\
                 viewpoint|dilation|tetrahedron|NURBS|trimmed|Steiner|catoptric|hyperpatch";
    for word in words.split('|') {
        assert!(expect_code(0, &["help", word]).0.contains("pathwarp"), "{word}");
    }
    expect_code(2, &["help", "no word of any paper"]);
    assert!(expect_code(0, &["help", "Wolberg"]).0.contains("bilinear — "));
    assert!(expect_code(0, &["help", "catoptric"]).0.contains("--mirror"));
}

#[test]
fn help_knows_words_of_the_trade() {
    for word in [
        "tumbler",
        "weld",
        "unite",
        "die line",
        "rainbow text",
        "circular text",
        "isometric",
        "T-shirt",
        "mug",
        "sticker",
        "comic",
        "speech bubble",
        "dewarp",
        "book page",
        "tile",
        "wrap",
        "warp text",
        "curve text",
        "arch",
        "roughen",
        "halftone",
    ] {
        let (said, _) = expect_code(0, &["help", word]);
        let has_none = ["roughen", "halftone"].contains(&word);
        let needed = if has_none { "Not there: pathwarp " } else { "pathwarp " };
        assert!(said.contains(needed) && (!has_none || said.contains("Illustrator")), "{word}: {said}");
    }
    assert!(expect_code(0, &["help", "arch"]).0.contains("docs/which.md"));
    assert!(expect_code(0, &["help", "dewarp"]).0.contains("pathwarp shaper IN.jpg --shaper "));
}

/// The page of other programs' words promises a picture for each, without a warning.
#[test]
fn every_command_for_a_word_of_another_program_runs() {
    let dir = tempfile::tempdir().unwrap();
    for word in pathwarp_engine::coming_from::all() {
        // The editor would wait for its reader, and nothing is installed here.
        let runs = |c: &&str| !c.starts_with("edit ") && !c.starts_with("install ") && !c.contains("IN.svg");
        if let Some(command) = word.command.filter(runs) {
            let said = paste(dir.path(), &format!("pathwarp {command}"));
            assert!(is_quiet(&said), "{command}: {said}");
        }
    }
    let (said, _) = expect_code(0, &["help", "puppet", "warp"]);
    assert!(said.contains("Adobe Illustrator, Puppet Warp: mls — ") && said.contains("Photoshop"), "{said}");
    let (said, _) = expect_code(0, &["help", "Zipper"]);
    assert!(said.contains("Not there yet"), "{said}");
    assert!(expect_code(2, &["help", "pupet warp"]).1.contains("did you mean `puppet warp`?"));
    assert!(expect_code(0, &["help", "mesh"]).0.contains("Usage: pathwarp mesh"));
    for (word, name) in
        [("FFD", "ffd"), ("Ffd", "ffd"), ("PROJ\u{e9}CTIVE", "projective"), ("me\u{301}sh", "mesh"), ("Text", "text")]
    {
        let (said, _) = expect_code(0, &["help", word]);
        assert!(said.contains(&format!("Usage: pathwarp {name}")), "{word}: {said}");
    }
}

/// A front page is short.
#[test]
fn the_front_page_is_short() {
    let page = fs::read_to_string(root().join("README.md")).unwrap();
    assert!(page.split_whitespace().count() <= 700);
}
