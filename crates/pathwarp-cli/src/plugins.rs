//! Plug-ins that are programs: from the user's folder and from `--plugin`, added to the registry.

use crate::{interruption, terminal};
use clap::Arg;
use pathwarp::deform::{Deformation, Registry};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::format::Format;
use pathwarp_engine::reserved_names;
use pathwarp_plugin::{Broken, Plugin, Reserved};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// The option for a plug-in's file.
const OPTION: &str = "plugin";

pub(crate) fn option() -> Arg {
    let option = Arg::new(OPTION).long(OPTION).value_name("FILE").global(true).hide_short_help(true);
    option.help("Use the plug-in in this file, too (docs/plugin-protocol.md)")
}

/// Commands that need no plug-ins of the folder.
const WITHOUT_INSTALLED: [&str; 8] =
    ["unwarp", "text", "paths", "convert", "render", "gallery", "compare", "new-plugin"];

/// The plug-ins of a run.
#[derive(Default)]
pub(crate) struct Plugins {
    plugins: Vec<Plugin>,
    /// The files named on the command line.
    given: Vec<PathBuf>,
    broken: Vec<Broken>,
}

impl Plugins {
    /// Returns the registry with the plug-ins added.
    pub(crate) fn added_to(&self, registry: &Registry) -> Registry {
        self.plugins.iter().fold(registry.clone(), |all, p| all.with(p.clone()))
    }

    /// Adds the plug-in in `file`, which replaces one with the same name.
    fn add(&mut self, file: &Path, reserved: Reserved<'_>) -> Result<(), Failure> {
        let plugin = pathwarp_plugin::by_file(file, reserved).map_err(|fault| Failure::from(fault.of(file)))?;
        self.plugins.retain(|p| p.info().name != plugin.info().name);
        self.broken.retain(|b| b.name != plugin.info().name);
        self.plugins.push(plugin);
        Ok(())
    }

    /// Shows the messages that the programs have written to standard error.
    pub(crate) fn show_messages(&self) {
        for (plugin, message) in self.plugins.iter().filter_map(|p| Some((p, p.said()?))) {
            terminal::note(&format!("plug-in {} said: {message}", plugin.path().display()));
        }
    }

    /// Returns the plug-in called `name`.
    pub(crate) fn get(&self, name: &str) -> Option<&Plugin> {
        self.plugins.iter().find(|p| p.info().name == name)
    }

    /// Returns the plug-in whose file was named last.
    pub(crate) fn last_given(&self) -> Option<&Plugin> {
        self.plugins.last()
    }

    /// Returns the file of the plug-in called `name`.
    pub(crate) fn file(&self, name: &str) -> Option<String> {
        self.get(name).map(|p| p.path().display().to_string())
    }

    /// Returns the options that name the files again.
    pub(crate) fn options(&self) -> Vec<(String, String)> {
        self.given.iter().map(|file| (OPTION.to_owned(), file.display().to_string())).collect()
    }

    /// Returns name, file and fault of each broken plug-in.
    pub(crate) fn broken(&self) -> impl Iterator<Item = [String; 3]> {
        self.broken.iter().map(|b| [b.name.clone(), b.path.display().to_string(), b.fault.to_string()])
    }

    /// Returns the failure of the plug-in called `name`, if it is broken.
    pub(crate) fn failure(&self, name: &str) -> Option<Failure> {
        self.broken.iter().find(|b| b.name == name).map(|b| b.fault.of(&b.path).into())
    }
}

/// Removes `--plugin FILE` from the arguments, and loads plug-ins that the rest may need, whose names must not be among `commands`.
pub(crate) fn load(
    registry: &Registry,
    args: &[OsString],
    commands: &[&str],
) -> Result<(Vec<OsString>, Plugins), Failure> {
    let (args, files) = split(args)?;
    let mut names: Vec<&str> = registry.entries().iter().map(|e| e.info().name).collect();
    names.extend(commands);
    names.push("help");
    let parameters: Vec<&str> = reserved_names().collect();
    let reserved = Reserved { names: &names, parameters: &parameters };
    let mut plugins = Plugins::default();
    let wanted = need_installed(registry, &args);
    if wanted || !files.is_empty() {
        // Programs run from here on, and an interruption must end them.
        interruption::handle();
    }
    // `check NAME` starts a plug-in anew, and `check FILE` needs no `--plugin`.
    let checked = args.get(2).filter(|_| args.get(1).is_some_and(|a| a == "check"));
    if wanted {
        let found = pathwarp_plugin::installed(reserved, checked.and_then(|name| name.to_str()));
        (plugins.plugins, plugins.broken) = (found.plugins, found.broken);
    }
    for file in &files {
        plugins.add(file, reserved)?;
    }
    plugins.given = files;
    if let Some(file) = checked.map(Path::new).filter(|f| is_file_name(f) && Format::of(f).is_none()) {
        plugins.add(file, reserved)?;
    }
    Ok((args, plugins))
}

/// Returns `true` if a word names a file rather than a deformation.
pub(crate) fn is_file_name(word: &Path) -> bool {
    word.components().count() > 1 || word.extension().is_some() || word.is_absolute()
}

/// Returns the arguments without `--plugin FILE`, and the files.
fn split(args: &[OsString]) -> Result<(Vec<OsString>, Vec<PathBuf>), Failure> {
    let (mut rest, mut files) = (Vec::with_capacity(args.len()), Vec::new());
    let mut words = args.iter();
    while let Some(word) = words.next() {
        if word == "--" {
            rest.push(word.clone());
            rest.extend(words.by_ref().cloned());
        } else if word == "--plugin" {
            let file = words.next().ok_or_else(|| Failure::usage("--plugin needs the file of a plug-in"))?;
            files.push(file.into());
        } else if let Some(file) = word.to_str().and_then(|w| w.strip_prefix("--plugin=")) {
            files.push(file.into());
        } else {
            rest.push(word.clone());
        }
    }
    Ok((rest, files))
}

/// Returns `true` if the arguments may name a deformation that is not built in, or list all.
fn need_installed(registry: &Registry, args: &[OsString]) -> bool {
    let is_built_in = |word: &OsStr| word.to_str().is_some_and(|w| registry.get(w).is_some());
    match args.get(1) {
        None => false,
        // Every deformation gets a dialog.
        Some(word) if word == "install" => args.get(2).is_some_and(|what| what == "inkscape"),
        Some(word) if WITHOUT_INSTALLED.iter().any(|w| *w == word.as_os_str()) => false,
        // Skip plug-ins if the whole chain is built in.
        Some(word) if is_built_in(word) => args.windows(2).any(|w| w[0] == "+" && !is_built_in(&w[1])),
        Some(word) => !word.to_string_lossy().starts_with('-') || word == "--help" || word == "-h",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<OsString> {
        line.split(' ').map(Into::into).collect()
    }

    #[test]
    fn plug_ins_are_taken_out_of_the_arguments() {
        let (rest, files) = split(&words("pathwarp a --plugin x.py b --plugin=y -- --plugin z")).unwrap();
        assert_eq!(rest, words("pathwarp a b -- --plugin z"));
        assert_eq!(files, [Path::new("x.py"), Path::new("y")]);
        assert!(split(&words("pathwarp --plugin")).is_err());
    }

    #[test]
    fn commands_without_plug_ins_do_not_look_for_them() {
        let registry = Registry::builtin();
        let need = |line: &str| need_installed(&registry, &words(line));
        for line in [
            "pathwarp shaper a.svg",
            "pathwarp shaper a.svg + wave --height 3",
            "pathwarp render a.svg",
            "pathwarp install gimp",
        ] {
            assert!(!need(line), "{line}");
        }
        for line in [
            "pathwarp list",
            "pathwarp ripple a.svg",
            "pathwarp install inkscape",
            "pathwarp shaper a.svg + ripple",
            "pathwarp run a.toml",
        ] {
            assert!(need(line), "{line}");
        }
    }
}
