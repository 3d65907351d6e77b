//! Recipes as files.
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
//! ```

use crate::failure::Failure;
use pathwarp::deform::Registry;
use pathwarp::param::{Args, Kind, Param};
use pathwarp::recipe::{Recipe, Step};
use serde::{Deserialize, Serialize};
use std::path::Path;
use toml::Value;

/// The version of the format.
const VERSION: i64 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    pathwarp: i64,
    #[serde(default, skip_serializing_if = "toml::Table::is_empty")]
    options: toml::Table,
    #[serde(default)]
    step: Vec<toml::Table>,
}

/// A recipe with the common options it was saved with.
pub(crate) struct Saved {
    pub(crate) recipe: Recipe,
    /// As words of a command line.
    pub(crate) options: Vec<String>,
}

/// Reads a recipe file.
pub(crate) fn read(registry: &Registry, file: &Path) -> Result<Saved, Failure> {
    let text = std::fs::read_to_string(file).map_err(|e| Failure::file(file, format!("cannot be read: {e}")))?;
    parse(registry, &text, file.parent().unwrap_or(Path::new(""))).map_err(|e| Failure::file(file, e))
}

/// Reads a recipe's text; its files lie relative to `folder`.
pub(crate) fn parse(registry: &Registry, text: &str, folder: &Path) -> Result<Saved, String> {
    let file: File = toml::from_str(text).map_err(|e| e.to_string())?;
    if file.pathwarp != VERSION {
        return Err(format!("is of version {}; this program knows version {VERSION}", file.pathwarp));
    }
    if file.step.is_empty() {
        return Err("has no [[step]]".into());
    }
    let mut options = Vec::new();
    for (name, value) in &file.options {
        for v in texts(value).ok_or_else(|| format!("[options] {name}: is no value of a command-line option"))? {
            match v.as_str() {
                "true" => options.push(format!("--{name}")),
                "false" => {}
                v => options.extend([format!("--{name}"), v.to_owned()]),
            }
        }
    }
    let step = |(i, t): (usize, &toml::Table)| step(registry, t, folder).map_err(|e| format!("step {}: {e}", i + 1));
    let steps: Result<Vec<Step>, String> = file.step.iter().enumerate().map(step).collect();
    Ok(Saved { recipe: Recipe { steps: steps? }, options })
}

fn step(registry: &Registry, table: &toml::Table, folder: &Path) -> Result<Step, String> {
    let name = table.get("deformation").and_then(Value::as_str).ok_or("has no `deformation = \"NAME\"`")?;
    let entry = registry.get(name).ok_or_else(|| format!("there is no deformation `{name}`"))?;
    let mut step = Step::new(name, Args::new());
    for (key, value) in table {
        match key.as_str() {
            "deformation" => {}
            "inverse" => step.inverse = value.as_bool().ok_or("inverse is true or false")?,
            key => {
                let params = entry.info().params;
                let param = params.iter().find(|p| p.name == key).ok_or_else(|| {
                    let known: Vec<_> = params.iter().map(|p| p.name).collect();
                    format!("{name} has no parameter `{key}`; it has {}", known.join(", "))
                })?;
                for v in texts(value).ok_or_else(|| format!("{key}: is no text, number, switch or list of them"))? {
                    if param.kind == Kind::Flag && v == "false" {
                        continue;
                    }
                    step.args.push(key, from_folder(param, v, folder));
                }
            }
        }
    }
    Ok(step)
}

/// A value as it would be typed.
fn texts(value: &Value) -> Option<Vec<String>> {
    let one = |v: &Value| match v {
        Value::String(s) => Some(s.clone()),
        Value::Integer(i) => Some(i.to_string()),
        Value::Float(f) => Some(f.to_string()),
        Value::Boolean(b) => Some(b.to_string()),
        _ => None,
    };
    match value {
        Value::Array(list) => list.iter().map(one).collect(),
        v => one(v).map(|v| vec![v]),
    }
}

/// Whether a value names a file whose place matters.
fn names_file(param: &Param, value: &str) -> bool {
    match param.kind {
        Kind::File | Kind::Save => true,
        Kind::NameOrFile(_) => param.reads_file(value),
        Kind::Path => !value.starts_with('#') && !pathwarp::param::is_inline(value),
        _ => false,
    }
}

fn from_folder(param: &Param, value: String, folder: &Path) -> String {
    if names_file(param, &value) && !Path::new(&value).is_absolute() {
        folder.join(value).display().to_string()
    } else {
        value
    }
}

/// The text of a recipe file in `folder` for these steps and common options.
pub(crate) fn write(
    registry: &Registry,
    recipe: &Recipe,
    options: &[(String, Vec<String>)],
    folder: &Path,
) -> Result<String, String> {
    let here = std::env::current_dir().map_err(|e| e.to_string())?;
    let same_place = folder.as_os_str().is_empty()
        || matches!((folder.canonicalize(), here.canonicalize()), (Ok(a), Ok(b)) if a == b);
    let value = |mut v: Vec<String>| match v.pop() {
        Some(only) if v.is_empty() => {
            if only == "true" {
                Value::Boolean(true)
            } else {
                Value::String(only)
            }
        }
        last => Value::Array(v.into_iter().chain(last).map(Value::String).collect()),
    };
    let mut file = File { pathwarp: VERSION, options: toml::Table::new(), step: Vec::new() };
    for (name, values) in options {
        file.options.insert(name.clone(), value(values.clone()));
    }
    for s in &recipe.steps {
        let mut t = toml::Table::new();
        t.insert("deformation".into(), Value::String(s.deformation.clone()));
        if s.inverse {
            t.insert("inverse".into(), Value::Boolean(true));
        }
        let params = registry.get(&s.deformation).map_or(&[][..], |e| e.info().params);
        for (name, values) in s.args.iter() {
            let param = params.iter().find(|p| p.name == name);
            let placed = values.iter().map(|v| match param {
                Some(p) if !same_place && names_file(p, v) => here.join(v).display().to_string(),
                _ => v.clone(),
            });
            t.insert(name.to_owned(), value(placed.collect()));
        }
        file.step.push(t);
    }
    toml::to_string(&file).map_err(|e| e.to_string())
}
