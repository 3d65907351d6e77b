//! `cargo xtask new-deformation NAME`: writes a working deformation as a starting point.

use crate::chore::{Chore, ChoreError, at, path_option, workspace};
use clap::{Arg, ArgMatches, Command};
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) const CHORE: Chore = Chore { command, run };

/// The end of the list of entries in `deform/mod.rs`; the new entry goes before it.
const END_OF_LIST: &str = "    ]\n}\n";

fn command() -> Command {
    Command::new("new-deformation")
        .about("Write the file of a new deformation with its test, and register it")
        .arg(Arg::new("NAME").required(true).help("A name in kebab-case, such as swirl or square-wave"))
        .arg(path_option("root", "DIR").help("The workspace to write to [default: this one]"))
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let root = arguments.get_one::<PathBuf>("root").cloned().unwrap_or_else(workspace);
    create(&root, arguments.get_one::<String>("NAME").map_or("", String::as_str))
}

/// Writes the file, adds its three lines to `deform/mod.rs`, and returns a summary.
fn create(root: &Path, name: &str) -> Result<String, ChoreError> {
    let is_word = |w: &str| !w.is_empty() && w.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    if !name.split('-').all(is_word) || name.starts_with(|c: char| c.is_ascii_digit()) {
        return Err(format!("`{name}` is not in kebab-case, such as swirl or square-wave"));
    }
    let module = name.replace('-', "_");
    const KEYWORDS: &str = "abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen \
        if impl in let loop macro match mod move mut override priv pub ref return self static struct super trait true try type typeof \
        unsafe unsized use virtual where while yield";
    if KEYWORDS.split_whitespace().any(|keyword| keyword == module) {
        return Err(format!("`{name}` is a keyword of Rust; choose another name"));
    }
    let folder = root.join("crates/pathwarp/src/deform");
    let file = folder.join(format!("{module}.rs"));
    let list_file = folder.join("mod.rs");
    if file.exists() {
        return Err(format!("{} already exists", file.display()));
    }
    let read = |p: &Path| fs::read_to_string(p).map_err(at(p));
    let list = register(&read(&list_file)?, &module, &type_name(name))?;
    let text = TEMPLATE.replace("NAME", name).replace("TYPE", &type_name(name));
    fs::write(&file, text).map_err(at(&file))?;
    fs::write(&list_file, list).map_err(at(&list_file))?;
    Ok(format!(
        "wrote {}\nadded three lines to {}\n\nIt already bends artwork into a wave: try `cargo run -- {name} samples/logo.svg -o out.svg`.\n\
         Change the formula, the parameters and the cases; `cargo test -p pathwarp {module}` checks them.",
        file.display(),
        list_file.display()
    ))
}

/// Returns the text of `deform/mod.rs` with lines for the module, its public type and its entry.
fn register(list: &str, module: &str, ty: &str) -> Result<String, ChoreError> {
    let unknown =
        "deform/mod.rs has an unexpected layout: add the `mod` line, the `pub use` line and the entry by hand";
    let list = insert(list, "mod ", &format!("mod {module};")).ok_or(unknown)?;
    let list = insert(&list, "pub use ", &format!("pub use {module}::{ty};")).ok_or(unknown)?;
    let at = list.find(END_OF_LIST).ok_or(unknown)?;
    Ok(format!("{}        Arc::new({module}::ENTRY),\n{}", &list[..at], &list[at..]))
}

/// Inserts a line into the sorted block of lines that start with `start`.
fn insert(text: &str, start: &str, line: &str) -> Option<String> {
    let after = text.lines().filter(|l| l.starts_with(start)).rfind(|l| *l < line);
    let next = text.lines().find(|l| l.starts_with(start))?;
    match after {
        Some(before) => Some(text.replacen(&format!("{before}\n"), &format!("{before}\n{line}\n"), 1)),
        None => Some(text.replacen(next, &format!("{line}\n{next}"), 1)),
    }
}

/// Converts `square-wave` to `SquareWave`.
fn type_name(name: &str) -> String {
    let word = |w: &str| w[..1].to_uppercase() + &w[1..];
    name.split('-').map(word).collect()
}

const TEMPLATE: &str = r#"//! One sentence that says what NAME does to artwork: x' = x, y' = y + h·sin(2π·x/l). The source: paper and equation.

use super::entry::{Built, Case, Entry, Example, Info, Law};
use crate::error::Error;
use crate::map::{Formula, Real};
use crate::param::{Axis, parameters};
use kurbo::Rect;
use std::f64::consts::TAU;
use std::sync::Arc;

parameters! {
    /// One sentence that says what NAME does to artwork: x' = x, y' = y + h·sin(2π·x/l).
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct TYPE(s) {
        /// Height h of the wave.
        height: f64 = length("height", Axis::Y).default("10%").slider(0.0, 100.0);
        /// Length l of the wave.
        length: f64 = length("length", Axis::X).default("50%").within(1e-3, 1e9).slider(1.0, 1000.0);
    }
}

impl TYPE {
    /// Creates a wave over the artwork's box.
    #[must_use]
    pub fn new(frame: Rect) -> Self {
        Self::defaults(frame)
    }

    /// Builds the map, or refuses a length out of range.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        Ok(Built::new(Arc::new(*self)))
    }
}

impl Formula for TYPE {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        (x, y + (x / self.length * TAU).sin() * self.height)
    }
}

static INFO: Info = Info::new("NAME", "one line for the menu")
    .group("New")
    .about("Say in plain sentences what it does and when to use it.")
    .params(TYPE::PARAMS)
    .source("paper and equation")
    .examples(&[Example { what: "As it comes", command: "NAME samples/logo.svg -o out.svg" },
        Example { what: "One long wave", command: "NAME samples/lettering.svg --length 100% -o out.svg" }])
    .laws(&[Law::Identity(&[("height", "0")]), Law::Area(&[], 1.0)])
    .cases(&[Case { args: &[("length", "40"), ("height", "3")], at: (10.0, 5.0), to: (10.0, 8.0), tolerance: 1e-12 }]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| TYPE::read(s)?.build());
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_and_taken_names_are_refused() {
        let root = workspace();
        assert!(create(&root, "wave").unwrap_err().contains("already"));
        assert!(create(&root, "Square").is_err() && create(&root, "").is_err() && create(&root, "a--b").is_err());
        assert!(["use", "yield"].iter().all(|name| create(&root, name).unwrap_err().contains("keyword")));
    }
}
