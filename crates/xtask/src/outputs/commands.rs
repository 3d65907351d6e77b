//! The commands whose output is compared.

use crate::chore::{ChoreError, at};
use crate::{docs, files};
use pathwarp::deform::Registry;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Commands for the drawings, taken in turn.
const WARPS: [&str; 8] = [
    "warp FILE --style flag --bend 40%",
    "shaper FILE --shaper samples/cages.svg#arch --strokes outline --gradients exact",
    "projective FILE --target '0%,100% 100%,90% 80%,0% 15%,5%' --fit grow",
    "bend FILE --along 'M0,100 Q150,20 300,100' --fit page --structure flatten",
    "envelope FILE --bottom 'M0,100 H400' --top 'M0,40 Q200,-60 400,40' --keep verticals --certify",
    "wave FILE --tolerance 0.05 --merge off + affine --rotate 10",
    "swirl FILE --patterns instantiate --strokes auto --text skip",
    "warp FILE --style arc --bend 60% --gradients keep --images keep --precision 3",
];

/// Commands that no page shows.
const MORE: [&str; 7] = [
    "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper' -o out.svg --report report.json",
    "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper' -o out.json",
    "shaper samples/paper.xcf --base '#Base' --target '#Target' --shaper '#Shaper' --into bent.xcf",
    "convert samples/paper.xcf -o out.svg",
    "warp samples/logo.svg --style flag -o out.svg --write-recipe out.toml --embed-recipe --preview out.png",
    "gallery samples/logo.svg -o out.svg",
    "schema",
];

/// Pages written by hand. The pages of the deformations show the registry's examples.
const GUIDES: [&str; 5] =
    ["README.md", "docs/tour.md", "docs/gimp.md", "docs/lettering.md", "docs/lettering-on-paths.md"];

/// All command lines, without the leading `pathwarp`; the stages of a pipeline are separated by ` | `.
pub(super) fn all(root: &Path, program: &Path, drawings: &[PathBuf], count: usize) -> Result<Vec<String>, ChoreError> {
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    let mut add = |line: String| {
        if seen.insert(line.clone()) {
            all.push(line);
        }
    };
    for line in docs::cookbook_commands().chain(MORE) {
        add(line.to_owned());
    }
    for guide in GUIDES.map(|guide| root.join(guide)) {
        for command in guide_commands(&fs::read_to_string(&guide).map_err(at(&guide))?) {
            add(command.to_owned());
        }
    }
    for entry in Registry::builtin().entries() {
        for example in entry.info().examples {
            add(example.command.to_owned());
        }
    }
    // Help wraps long lines, so the registry's examples come from its table above.
    for line in help_examples(program)? {
        add(line);
    }
    for folder in drawings {
        let folder = folder.canonicalize().map_err(at(folder))?;
        // A quote would end the word.
        let plain = |path: &Path| files::ends_in(path, &["svg"]) && !path.display().to_string().contains('\'');
        let files = files::below(&folder, plain)?;
        let step = (files.len() / count.max(1)).max(1);
        for (i, file) in files.iter().step_by(step).take(count).enumerate() {
            let warp = WARPS[i % WARPS.len()].replace("FILE", &format!("'{}'", file.display()));
            add(format!("{warp} -o out.svg --report report.json --on-error skip"));
        }
    }
    Ok(all)
}

/// The commands in the code blocks of a page that need no file of the reader's.
fn guide_commands(page: &str) -> impl Iterator<Item = &str> {
    // Code and prose alternate; a block opens with the name of its language.
    let blocks = page.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    blocks.flat_map(str::lines).filter_map(|l| l.strip_prefix("pathwarp ")).filter(|l| is_self_contained(l))
}

/// Returns `true` for a command on samples or on words that it sets itself.
fn is_self_contained(command: &str) -> bool {
    command.contains("samples/") || command.starts_with("text ")
}

/// The examples on samples in the help of every subcommand that is not a deformation.
fn help_examples(program: &Path) -> Result<Vec<String>, ChoreError> {
    let help = |args: &[&str]| -> Result<String, ChoreError> {
        let out = Command::new(program).args(args).output().map_err(at(program))?;
        Ok(String::from_utf8_lossy(&out.stdout).into_owned())
    };
    let names = help(&["help"])?;
    let names = names.lines().skip_while(|l| !l.starts_with("Commands:")).skip(1).take_while(|l| !l.is_empty());
    let mut out = Vec::new();
    let names = names.filter_map(|l| l.strip_prefix("  ")?.split_whitespace().next());
    for name in names.filter(|n| Registry::builtin().get(n).is_none()) {
        for line in help(&["help", name])?.lines() {
            if let Some(command) = line.trim().strip_prefix("pathwarp ")
                && is_self_contained(command)
            {
                out.push(command.to_owned());
            }
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_of_a_guide_need_no_other_files() {
        let page = "pathwarp samples/ is prose\n```sh\npathwarp warp mine.svg\npathwarp warp samples/logo.svg\n```\n\
                    pathwarp text, too\n```json\npathwarp text json\n```\n```sh\npathwarp install gimp\npathwarp text word\n```\n";
        assert_eq!(guide_commands(page).collect::<Vec<_>>(), ["warp samples/logo.svg", "text word"]);
    }
}
