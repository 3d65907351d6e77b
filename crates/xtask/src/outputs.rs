//! `cargo xtask outputs`: fingerprints everything the program writes, to show that a refactoring changes no output.
//!
//! `--store FILE` runs every command in the guides and help pages that needs only samples, and one command on each drawing in the given
//! folders. For each it writes a line to `FILE`: a hash of all output, and the command. `--check FILE` runs the same commands again and lists
//! those whose hash differs.
//!
//! Wording is not compared: standard error is ignored, messages and times are removed from reports, and descriptions from the schema.

use crate::chore::{Chore, ChoreError, at, count_option, hex, path_option, paths, program_option, workspace};
use crate::shell;
use clap::{ArgAction, ArgMatches, Command};
use pathwarp::deform::Registry;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process;

pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("outputs")
        .about("Store a hash of everything the program writes, or compare with stored hashes")
        .arg(
            path_option("store", "FILE")
                .conflicts_with("check")
                .required_unless_present("check")
                .help("Run every example and write the hashes to FILE"),
        )
        .arg(path_option("check", "FILE").help("Run the commands of FILE again and list those with other output"))
        .arg(
            path_option("drawings", "FOLDER")
                .action(ArgAction::Append)
                .help("Also warp drawings from this folder; may be given several times"),
        )
        .arg(count_option("count", "300").help("Take at most N drawings from each folder"))
        .arg(count_option("every", "1").help("Check every Nth command only"))
        .arg(program_option())
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = &workspace();
    let program = &shell::program(root, arguments)?;
    let number = |name: &str| arguments.get_one(name).copied().unwrap_or(1);
    match (arguments.get_one::<PathBuf>("store"), arguments.get_one::<PathBuf>("check")) {
        (Some(file), _) => store(root, program, file, &paths(arguments, "drawings"), number("count")),
        (None, Some(file)) => check(root, program, file, number("every")),
        (None, None) => Err("neither --store nor --check is given".into()),
    }
}

/// Writes the hash and the text of every command to `file`.
fn store(root: &Path, program: &Path, file: &Path, drawings: &[PathBuf], count: usize) -> Result<String, ChoreError> {
    let lines = all_commands(root, program, drawings, count)?;
    let hashes = hashes_of(root, program, &lines)?;
    let text: String = hashes.iter().zip(&lines).map(|(h, l)| format!("{h} {l}\n")).collect();
    fs::write(file, text).map_err(at(file))?;
    Ok(format!("stored the hashes of {} commands", lines.len()))
}

/// Runs every `every`th command in `file` and compares the hashes.
fn check(root: &Path, program: &Path, file: &Path, every: usize) -> Result<String, ChoreError> {
    let text = fs::read_to_string(file).map_err(at(file))?;
    let stored: Vec<(&str, &str)> = text.lines().filter_map(|l| l.split_once(' ')).step_by(every.max(1)).collect();
    let lines: Vec<String> = stored.iter().map(|(_, line)| (*line).to_owned()).collect();
    let found = hashes_of(root, program, &lines)?;
    let mut differing = String::new();
    for ((hash, line), new) in stored.iter().zip(&found) {
        if hash != new {
            let _ = write!(differing, "\n  pathwarp {line}");
        }
    }
    if differing.is_empty() {
        Ok(format!("{} commands wrote the same bytes", lines.len()))
    } else {
        Err(format!("of {} commands, these wrote other bytes:{differing}", lines.len()))
    }
}

/// Commands for the drawings, used in turn.
const WARPS: [&str; 8] = [
    "warp FILE --style flag --bend 40%",
    "shaper FILE --shaper samples/cages.svg#arch --strokes outline --gradients exact",
    "projective FILE --target '0%,100% 100%,90% 80%,0% 15%,5%' --fit grow",
    "bend FILE --along 'M0,100 Q150,20 300,100' --fit page --structure flatten",
    "envelope FILE --bottom 'M0,100 H400' --top 'M0,40 Q200,-60 400,40' --keep verticals --certify",
    "wave FILE --tolerance 0.05 --nodes source + affine --rotate 10",
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

/// The pages written by hand. (The pages of the deformations show the examples in the registry.)
const GUIDES: [&str; 6] = [
    "README.md",
    "docs/tour.md",
    "docs/gimp.md",
    "docs/lettering.md",
    "docs/lettering-on-paths.md",
    "docs/cookbook.md",
];

/// All command lines, without the leading `pathwarp`; the stages of a pipeline are separated by ` | `.
fn all_commands(root: &Path, program: &Path, drawings: &[PathBuf], count: usize) -> Result<Vec<String>, ChoreError> {
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    let mut add = |line: String| {
        if seen.insert(line.clone()) {
            all.push(line);
        }
    };
    MORE.map(str::to_owned).into_iter().for_each(&mut add);
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
    // Help wraps long lines, so the examples in the registry are taken from there, above.
    for line in help_examples(program)? {
        add(line);
    }
    for folder in drawings {
        let folder = folder.canonicalize().map_err(at(folder))?;
        // A quote in the path would end the word.
        let plain = |path: &Path| shell::ends_in(path, &["svg"]) && !path.display().to_string().contains('\'');
        let files = shell::files_below(&folder, plain)?;
        let step = (files.len() / count.max(1)).max(1);
        for (i, file) in files.iter().step_by(step).take(count).enumerate() {
            let warp = WARPS[i % WARPS.len()].replace("FILE", &format!("'{}'", file.display()));
            add(format!("{warp} -o out.svg --report report.json --on-error skip"));
        }
    }
    Ok(all)
}

/// The commands in the code blocks of a page that need only samples.
fn guide_commands(page: &str) -> impl Iterator<Item = &str> {
    // Code and prose alternate. A block starts with the name of its language.
    let blocks = page.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    blocks.flat_map(str::lines).filter_map(|l| l.strip_prefix("pathwarp ")).filter(|l| is_self_contained(l))
}

/// Returns `true` if a command works on samples or sets the text in it.
fn is_self_contained(command: &str) -> bool {
    command.contains("samples/") || command.starts_with("text ")
}

/// The self-contained examples in the help of every subcommand that is not a deformation.
fn help_examples(program: &Path) -> Result<Vec<String>, ChoreError> {
    let help = |args: &[&str]| -> Result<String, ChoreError> {
        let out = process::Command::new(program).args(args).output().map_err(at(program))?;
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

/// The hash of every command's output, in order.
fn hashes_of(root: &Path, program: &Path, lines: &[String]) -> Result<Vec<String>, ChoreError> {
    shell::in_parallel(lines, |line| hash_of(root, program, line)).into_iter().collect()
}

/// Folders of the workspace that commands may read.
const INPUTS: [&str; 2] = ["samples", "crates/pathwarp-text/tests/fonts"];

/// Runs a command line in a folder that holds only its inputs, and hashes its exit codes, standard output and files.
fn hash_of(root: &Path, program: &Path, line: &str) -> Result<String, ChoreError> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let inputs: Vec<&str> = INPUTS.into_iter().filter(|input| line.contains(input)).collect();
    for input in &inputs {
        shell::copy_folder(&root.join(input), &folder.path().join(input))?;
    }
    let mut hash = Sha256::new();
    let mut piped = Vec::new();
    let words = shell::words(line);
    for stage in words.split(|w| w == "|") {
        let stage = if stage.first().is_some_and(|w| w == "pathwarp") { &stage[1..] } else { stage };
        let mut command = process::Command::new(program);
        command.args(stage).current_dir(folder.path()).env("RAYON_NUM_THREADS", "1");
        let output = shell::feed(&mut command, &piped).map_err(at(program))?;
        hash.update(output.status.code().unwrap_or(-1).to_le_bytes());
        piped = if stage.first().is_some_and(|w| w == "schema") { wordless(&output.stdout)? } else { output.stdout };
    }
    hash.update(&piped);
    for file in
        shell::files_below(folder.path(), |file| !inputs.iter().any(|i| file.starts_with(folder.path().join(i))))?
    {
        let bytes = fs::read(&file).map_err(at(&file))?;
        let name = file.strip_prefix(folder.path()).unwrap_or(&file);
        hash.update(name.as_os_str().as_encoded_bytes());
        if name == Path::new("report.json") {
            hash.update(numbers(&bytes)?);
        } else {
            hash.update(&bytes);
        }
    }
    Ok(hex(&hash.finalize()))
}

/// A report without messages, times and version.
fn numbers(report: &[u8]) -> Result<Vec<u8>, ChoreError> {
    without(report, |name, _| ["warnings", "why", "seconds", "version"].contains(&name))
}

/// A schema without descriptions and titles. Properties may also have these names, but their values are not strings.
fn wordless(schema: &[u8]) -> Result<Vec<u8>, ChoreError> {
    without(schema, |name, value| value.is_string() && ["description", "title"].contains(&name))
}

/// A JSON document without some members of its objects.
fn without(json: &[u8], dropped: impl Fn(&str, &Value) -> bool) -> Result<Vec<u8>, ChoreError> {
    fn strip(value: &mut Value, dropped: &dyn Fn(&str, &Value) -> bool) {
        match value {
            Value::Object(map) => {
                map.retain(|name, value| !dropped(name, value));
                map.values_mut().for_each(|value| strip(value, dropped));
            }
            Value::Array(list) => list.iter_mut().for_each(|value| strip(value, dropped)),
            _ => {}
        }
    }
    let mut value: Value = serde_json::from_slice(json).map_err(|e| e.to_string())?;
    strip(&mut value, &dropped);
    serde_json::to_vec(&value).map_err(|e| e.to_string())
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

    #[cfg(unix)]
    #[test]
    fn samples_in_subfolders_are_read() {
        let hash = |line: &str| hash_of(&workspace(), Path::new("/bin/cat"), line).unwrap();
        assert_ne!(hash("samples/icons/sun.svg"), hash("samples/icons/cup.svg"));
    }

    #[test]
    fn only_messages_and_times_of_a_report_may_change() {
        let report = |why: &str, error: &str| {
            numbers(
                format!(r#"{{"totals":{{"seconds":{error}}},"shapes":[{{"why":"{why}","max_error":{error}}}]}}"#)
                    .as_bytes(),
            )
        };
        assert_eq!(report("a", "0.5"), report("b", "0.5"));
        assert_ne!(report("a", "0.5"), report("a", "0.25"));
    }

    #[test]
    fn only_the_words_of_a_schema_may_change() {
        let schema = |words: &str, kind: &str| {
            wordless(
                format!(
                    r#"{{"title":"{words}","properties":{{"title":{{"type":"{kind}","description":"{words}"}}}}}}"#
                )
                .as_bytes(),
            )
        };
        assert_eq!(schema("a", "string"), schema("b", "string"));
        assert_ne!(schema("a", "string"), schema("a", "number"));
    }
}
