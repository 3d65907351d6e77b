//! `pathwarp new-plugin LANGUAGE NAME`: writes a plug-in to start from, which passes `pathwarp check`.

use crate::failure::Failure;
use crate::output::{self, PendingFile};
use crate::status::Status;
use clap::{Arg, ArgMatches, Command, value_parser};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

pub(super) const NAME: &str = "new-plugin";

/// The words that stand for the name in the templates.
const PLACEHOLDER: &str = "@NAME@";

const PYTHON: &str = include_str!("../../plug-ins/new/plugin.py");
const RUST: &str = include_str!("../../plug-ins/new/main.rs");
const MANIFEST: &str = include_str!("../../plug-ins/new/Cargo.toml.in");

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("Write a plug-in to start from: a deformation that is a program")
        .arg(
            Arg::new("LANGUAGE")
                .required(true)
                .value_parser(["python", "rust"])
                .help("python: one file that speaks lines of text; rust: a crate without dependencies that speaks binary"),
        )
        .arg(Arg::new("NAME").required(true).help("Name of the deformation: lower-case words joined by hyphens"))
        .arg(
            Arg::new("dir")
                .long("dir")
                .value_name("DIR")
                .default_value(".")
                .value_parser(value_parser!(PathBuf))
                .help("Folder to write to"),
        )
        .after_help(
            "Existing files are not overwritten.\n\nExamples:\n  pathwarp new-plugin python ripple\n  pathwarp check \
             ./pathwarp-ripple.py\n  pathwarp ripple logo.svg -o out.svg --plugin ./pathwarp-ripple.py\n\ndocs/writing-deformations.md \
             goes on from there.",
        )
}

/// Writes it. `taken` tells whether a name is that of a command.
pub(super) fn run(m: &ArgMatches, taken: impl Fn(&str) -> bool) -> Result<Status, Failure> {
    let word = |name: &str| m.get_one::<String>(name).map_or("", String::as_str);
    let (language, name) = (word("LANGUAGE"), word("NAME"));
    let is_word = |w: &str| !w.is_empty() && w.bytes().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    if !name.split('-').all(is_word) || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        return Err(Failure::usage(format!("NAME: `{name}` is not lower-case words joined by hyphens")));
    }
    if taken(name) {
        return Err(Failure::usage(format!("NAME: `{name}` is a command already; choose another name")));
    }
    let folder = m.get_one::<PathBuf>("dir").map_or(Path::new("."), PathBuf::as_path);
    let program = format!("pathwarp-{name}");
    let files = match language {
        "python" => vec![(folder.join(program).with_extension("py"), PYTHON)],
        _ => {
            let home = folder.join(program);
            vec![(home.join("Cargo.toml"), MANIFEST), (home.join("src/main.rs"), RUST)]
        }
    };
    write(&files, name)?;
    let first = files[0].0.display().to_string();
    let home = folder.join(format!("pathwarp-{name}"));
    let built = home.join("target/release").join(format!("pathwarp-{name}")).display().to_string();
    let (build, file) = match language {
        "python" => (String::new(), first),
        _ => (format!("  cargo build --release --manifest-path {first}\n"), built),
    };
    let mut text = String::new();
    for (file, _) in &files {
        let _ = writeln!(text, "wrote {}", file.display());
    }
    let _ =
        write!(text, "next:\n{build}  pathwarp check {file}\n  pathwarp {name} IN.svg -o OUT.svg --plugin {file}\n");
    if let Some(folder) = pathwarp_plugin::folder() {
        let _ = writeln!(text, "to install it, copy {file} to {}", folder.display());
    }
    output::to_stdout(text.as_bytes())?;
    Ok(Status::Complete)
}

/// Writes the files, none of which may exist; scripts can be executed.
fn write(files: &[(PathBuf, &str)], name: &str) -> Result<(), Failure> {
    let mut pending = Vec::new();
    for (file, template) in files {
        if file.exists() {
            return Err(Failure::output(file, "exists already"));
        }
        let folder = file.parent().unwrap_or(Path::new(""));
        fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))?;
        pending.push(PendingFile::new(file, template.replace(PLACEHOLDER, name).as_bytes())?);
    }
    PendingFile::commit_all(pending)?;
    #[cfg(unix)]
    for (file, _) in files.iter().filter(|(f, _)| f.extension().is_some_and(|e| e == "py")) {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(file, fs::Permissions::from_mode(0o755)).map_err(|e| Failure::output(file, e))?;
    }
    Ok(())
}
