//! Recipe files: steps with their parameters, and common options, in TOML.
//!
//! ```toml
//! pathwarp = 1
//!
//! [options]            # common options of the command line, without the dashes
//! tolerance = "0.01"
//!
//! [[step]]
//! deformation = "shaper"
//! shaper = "cage.svg#flag"   # relative to the recipe's own folder
//! reverse-shaper = true
//! select = ["#banner"]       # also exclude: this step holds for a part of the drawing only
//! ```
//!
//! A recipe for solids has `solid = true` below the version.

use crate::advice;
use crate::catalogue::Catalogue;
use crate::embed::preset;
use crate::failure::Failure;
use crate::input::{split_reference, unreadable};
use crate::options::Given;
use crate::references;
use crate::steps::INVERSE;
use pathwarp::param::{Args, Kind, Param};
use pathwarp::recipe::{Recipe, Step};
use serde::{Deserialize, Serialize};
use std::path::{Component, Path, PathBuf};
use toml::Value;

const VERSION: i64 = 1;

/// Keys of a step that, like [`INVERSE`], are not parameters of its deformation.
const DEFORMATION: &str = "deformation";
const SELECT: &str = "select";
const EXCLUDE: &str = "exclude";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecipeFile {
    pathwarp: i64,
    /// `true` if the steps deform solids instead of drawings.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    solid: bool,
    #[serde(default, skip_serializing_if = "toml::Table::is_empty")]
    options: toml::Table,
    #[serde(default)]
    step: Vec<toml::Table>,
}

/// A recipe with the common options stored in its file.
pub struct SavedRecipe {
    /// The steps.
    pub recipe: Recipe,
    /// The options beside them.
    pub options: Given,
}

/// Reads a recipe file. Relative paths in it refer to the file's folder; absolute ones are allowed only if `external`.
pub fn read(catalogue: &dyn Catalogue, file: &Path, external: bool) -> Result<SavedRecipe, Failure> {
    let bytes = std::fs::read(file).map_err(|e| Failure::file(file, unreadable(file, &e)))?;
    if bytes.trim_ascii_start().starts_with(b"<") {
        let name = file.display();
        return Err(Failure::Input(format!("{name} is a drawing, not a recipe; write: run RECIPE.toml {name}")));
    }
    let text = String::from_utf8(bytes).map_err(|_| Failure::file(file, "is not a recipe: it is not text"))?;
    from_text(catalogue, &text, file.parent().unwrap_or(Path::new("")), external).map_err(|e| Failure::file(file, e))
}

/// Reads a recipe embedded in a drawing's file. Relative paths refer to `folder`; absolute ones are allowed only if `external`.
pub fn from_text(catalogue: &dyn Catalogue, text: &str, folder: &Path, external: bool) -> Result<SavedRecipe, String> {
    parse(catalogue, text, &Folder { path: folder, external })
}

/// The folder that paths in a recipe refer to.
struct Folder<'a> {
    path: &'a Path,
    /// `true` if absolute paths are allowed; relative ones may lead out of the folder in any case.
    external: bool,
}

fn parse(catalogue: &dyn Catalogue, text: &str, folder: &Folder<'_>) -> Result<SavedRecipe, String> {
    let file: RecipeFile = toml::from_str(text).map_err(|e| e.to_string())?;
    if file.pathwarp != VERSION {
        return Err(format!("has version {}; this program reads version {VERSION}", file.pathwarp));
    }
    match (file.solid, catalogue.is_solid()) {
        (true, false) => return Err("deforms solids (solid = true); run it with `pathwarp solid run`".into()),
        (false, true) => {
            return Err("deforms drawings; run it with `pathwarp run` (one for solids has solid = true)".into());
        }
        _ => {}
    }
    if file.step.is_empty() {
        return Err("has no [[step]]".into());
    }
    let mut options = Given::default();
    for (name, value) in &file.options {
        let words = as_typed(value).ok_or_else(|| format!("[options] {name} {MUST_BE_TYPED}"))?;
        // `false` leaves an option at its default.
        for word in words.iter().filter(|word| *word != "false") {
            options.push(name, word).map_err(|e| format!("[options] {e}"))?;
        }
    }
    let step =
        |(i, t): (usize, &toml::Table)| parse_step(catalogue, t, folder).map_err(|e| format!("step {}: {e}", i + 1));
    let steps: Result<Vec<Step>, String> = file.step.iter().enumerate().map(step).collect();
    Ok(SavedRecipe { recipe: Recipe { steps: steps? }, options })
}

fn parse_step(catalogue: &dyn Catalogue, table: &toml::Table, folder: &Folder<'_>) -> Result<Step, String> {
    let name = table.get(DEFORMATION).and_then(Value::as_str).ok_or("has no `deformation = \"NAME\"`")?;
    let infos = catalogue.infos();
    let known = infos.iter().map(|i| i.name);
    let plain = catalogue.info(name).map(|info| (info, None));
    let preset = || preset(catalogue, name).map(|(info, param, value)| (info, Some((param, value))));
    let (info, preset) = plain.or_else(preset).ok_or_else(|| advice::unknown("deformation", name, known))?;
    let mut step = Step::new(info.name, Args::new());
    if let Some((param, value)) = preset {
        if table.contains_key(param) {
            return Err(format!("{param}: `{name}` is one already"));
        }
        step.args.push(param, value);
    }
    for (key, value) in table {
        match key.as_str() {
            DEFORMATION => {}
            INVERSE => step.inverse = value.as_bool().ok_or("inverse must be true or false")?,
            SELECT | EXCLUDE if catalogue.is_solid() => {
                return Err(format!("{key} is for drawings; a step holds for the whole of a solid"));
            }
            SELECT | EXCLUDE => {
                let selectors = if key == SELECT { &mut step.select } else { &mut step.exclude };
                *selectors = as_typed(value).ok_or_else(|| format!("{key} must be a text or a list of them"))?;
            }
            key => {
                let params = info.params;
                let param = params.iter().find(|p| p.name == key).ok_or_else(|| {
                    let known: Vec<_> = params.iter().map(|p| p.name).collect();
                    format!("{name} has no parameter `{key}`; its parameters are {}", known.join(", "))
                })?;
                for v in as_typed(value).ok_or_else(|| format!("{key} {MUST_BE_TYPED}"))? {
                    if param.kind == Kind::Flag && v == "false" {
                        continue;
                    }
                    if param.kind == Kind::Save {
                        let advice = "give it on the command line";
                        return Err(format!("{key} is not for recipes, which write no files; {advice}"));
                    }
                    step.args.push(key, path_from_here(folder, param, v).map_err(|e| format!("{key}: {e}"))?);
                }
            }
        }
    }
    Ok(step)
}

/// The problem of a value for which [`as_typed`] returns `None`.
const MUST_BE_TYPED: &str = "must be a text, a number, true, false or a list of them";

/// Converts the values of a key to words as typed on a command line; `None` if that is impossible.
fn as_typed(value: &Value) -> Option<Vec<String>> {
    let word = |v: &Value| match v {
        Value::String(s) => Some(s.clone()),
        Value::Integer(i) => Some(i.to_string()),
        Value::Float(f) => Some(f.to_string()),
        Value::Boolean(b) => Some(b.to_string()),
        _ => None,
    };
    match value {
        Value::Array(list) => list.iter().map(word).collect(),
        v => word(v).map(|v| vec![v]),
    }
}

/// Returns `true` if a value names a file, so that its meaning depends on the folder. A path parameter takes path data, too.
fn names_file(param: &Param, value: &str, folder: &Path) -> bool {
    match param.kind {
        Kind::File | Kind::Save => true,
        Kind::NameOrFile(_) => param.reads_file(value),
        Kind::Path => references::names_file(value, folder),
        _ => false,
    }
}

/// Turns a path relative to the recipe's folder into one relative to the current folder; other values stay. Refuses what is not a regular
/// file, and an absolute path unless `external`.
fn path_from_here(folder: &Folder<'_>, param: &Param, value: String) -> Result<String, String> {
    if !names_file(param, &value, folder.path) {
        return Ok(value);
    }
    let path = Path::new(&value);
    if (path.is_absolute() || path.has_root()) && !folder.external {
        let advice = "name it relative to the recipe, or allow it with --allow-external";
        return Err(format!("`{value}` is absolute; {advice}"));
    }
    let from_here = folder.path.join(path);
    let file = if from_here.exists() { from_here.clone() } else { split_reference(&from_here.to_string_lossy()).0 };
    // A missing file is reported where it is read.
    if file.exists() && !file.is_file() {
        return Err(format!("`{value}` is not a regular file"));
    }
    Ok(from_here.display().to_string())
}

/// Returns the text of a recipe file in `folder` with these steps and the options that recipes store.
pub fn write(catalogue: &dyn Catalogue, recipe: &Recipe, given: &Given, folder: &Path) -> Result<String, Failure> {
    let here = std::env::current_dir().map_err(|e| Failure::Input(e.to_string()))?;
    let same_place = folder.as_os_str().is_empty()
        || matches!((folder.canonicalize(), here.canonicalize()), (Ok(a), Ok(b)) if a == b);
    let mut file =
        RecipeFile { pathwarp: VERSION, solid: catalogue.is_solid(), options: toml::Table::new(), step: Vec::new() };
    for (name, values) in given.stored() {
        file.options.insert(name.to_owned(), toml_value(values));
    }
    for step in &recipe.steps {
        let mut table = toml::Table::new();
        table.insert(DEFORMATION.into(), Value::String(step.deformation.clone()));
        if step.inverse {
            table.insert(INVERSE.into(), Value::Boolean(true));
        }
        for (key, selectors) in [(SELECT, &step.select), (EXCLUDE, &step.exclude)] {
            if !selectors.is_empty() {
                table.insert(key.into(), Value::Array(selectors.iter().cloned().map(Value::String).collect()));
            }
        }
        let params = catalogue.info(&step.deformation).map_or(&[][..], |i| i.params);
        for (name, values) in step.args.iter() {
            let param = params.iter().find(|p| p.name == name);
            if param.is_some_and(|p| p.kind == Kind::Save) {
                continue;
            }
            let placed = values.iter().map(|v| match param {
                Some(p) if (!same_place || Path::new(v).is_absolute()) && names_file(p, v, &here) => {
                    relative(&here.join(v), &here.join(folder))
                }
                _ => v.clone(),
            });
            table.insert(name.to_owned(), toml_value(placed.collect()));
        }
        file.step.push(table);
    }
    toml::to_string(&file).map_err(|e| Failure::Input(e.to_string()))
}

/// Returns the path of a file relative to the current folder, as steps name files.
pub fn from_here(file: &Path) -> String {
    std::env::current_dir().map_or_else(|_| file.display().to_string(), |here| relative(&here.join(file), &here))
}

/// Returns the path of a file relative to a folder, as recipes name files; an absolute path if the file is on another drive. A reference
/// `FILE#NAME` keeps its name.
fn relative(file: &Path, folder: &Path) -> String {
    let (path, name) = if file.exists() {
        (file.to_owned(), None)
    } else {
        let text = file.to_string_lossy();
        let (path, name) = split_reference(&text);
        (path, name.map(ToOwned::to_owned))
    };
    let (path, folder) = (path.canonicalize().unwrap_or(path), folder.canonicalize().unwrap_or(folder.to_owned()));
    let common = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    let relative: PathBuf = up.chain(path.components().skip(common)).collect();
    let shown = if common == 0 { path.display().to_string() } else { relative.display().to_string() };
    name.map_or_else(|| shown.clone(), |n| format!("{shown}#{n}"))
}

/// Converts typed values to TOML: a single one to a string or `true`, several to a list.
fn toml_value(values: Vec<String>) -> Value {
    match &values[..] {
        [only] if only == "true" => Value::Boolean(true),
        [only] => Value::String(only.clone()),
        _ => Value::Array(values.into_iter().map(Value::String).collect()),
    }
}
