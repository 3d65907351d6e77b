//! The available deformations and options, as JSON for the Python half.

use pathwarp::deform::{Info, Registry};
use pathwarp::param::{Kind, Param};
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The deformations with their parameters, as JSON.
#[pyfunction]
pub(crate) fn catalog() -> String {
    let registry = Registry::builtin();
    let all: Vec<Value> = registry.entries().iter().map(|e| deformation(&registry, e.info())).collect();
    Value::from(all).to_string()
}

/// The names of the options of a warp, with their help and the words that they can be.
#[pyfunction]
pub(crate) fn option_help() -> Vec<(&'static str, String, Vec<&'static str>)> {
    pathwarp_engine::option_names().map(|(name, help)| (name, help, pathwarp_engine::option_words(name))).collect()
}

fn deformation(registry: &Registry, info: &Info) -> Value {
    let params: Vec<Value> = info.params.iter().filter(|p| p.kind != Kind::Save).map(param).collect();
    let kind = info.gallery.and_then(|g| info.params.iter().find(|p| p.name == g.presets)).map(|p| p.kind);
    let names = match kind {
        Some(Kind::NameOrFile(names) | Kind::Choice(names)) => names,
        _ => &[],
    };
    // The name of a preset may be that of a deformation, or of another deformation's preset.
    let is_preset = |name: &&&str| {
        let is_of_this = pathwarp_engine::preset(registry, name).is_some_and(|(i, ..)| i.name == info.name);
        registry.get(name).is_none() && is_of_this
    };
    let presets: Vec<&&str> = names.iter().filter(is_preset).collect();
    let examples: Vec<&str> = info.examples.iter().map(|e| e.command).collect();
    json!({
        "name": info.name, "title": info.title, "group": info.group, "about": info.about, "source": info.source,
        "parameters": params, "presets": presets, "examples": examples,
        "preset_parameter": info.gallery.filter(|_| !presets.is_empty()).map(|g| g.presets),
    })
}

fn param(p: &Param) -> Value {
    let kind = if p.kind == Kind::Save { Kind::File } else { p.kind };
    let limit = |v: f64| v.is_finite().then_some(v);
    json!({
        "name": p.name, "kind": kind.name(), "notation": p.value_name(), "choices": p.names(), "default": p.default,
        "needed": p.needed, "repeat": p.repeat, "help": p.help,
        "range": [limit(p.range.0), limit(p.range.1)], "slider": [p.ui.0, p.ui.1],
    })
}
