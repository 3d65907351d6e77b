//! `pathwarp schema`: the JSON schema of recipe files, from the registry.

use crate::failure::Failure;
use crate::options::OPTIONS;
use crate::output;
use crate::status::Status;
use clap::Command;
use pathwarp::deform::{Info, Registry};
use pathwarp::param::{Kind, Param};
use serde_json::{Map, Value, json};

pub(super) const NAME: &str = "schema";

pub(super) fn command() -> Command {
    Command::new(NAME).about("Print the JSON schema of recipe files")
}

pub(super) fn run(registry: &Registry) -> Result<Status, Failure> {
    let text = serde_json::to_string_pretty(&schema(registry)).map_err(|e| Failure::usage(e.to_string()))? + "\n";
    output::to_stdout(text.as_bytes())?;
    Ok(Status::Complete)
}

fn schema(registry: &Registry) -> Value {
    let steps: Vec<Value> = registry.entries().iter().map(|e| step(e.info())).collect();
    let stored = OPTIONS.iter().filter(|o| o.stored);
    let options: Map<String, Value> = stored.map(|o| (o.name.to_owned(), json!({ "description": o.help() }))).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "pathwarp recipe",
        "type": "object",
        "required": ["pathwarp", "step"],
        "additionalProperties": false,
        "properties": {
            "pathwarp": { "const": 1, "description": "The version of the format." },
            "options": { "type": "object", "additionalProperties": false, "properties": options },
            "step": { "type": "array", "minItems": 1, "items": { "oneOf": steps } },
        },
    })
}

fn step(info: &Info) -> Value {
    let mut properties = Map::new();
    properties.insert("deformation".into(), json!({ "const": info.name, "description": info.title }));
    properties.insert("inverse".into(), json!({ "type": "boolean", "description": "The inverse map." }));
    properties.extend(info.params.iter().map(|p| (p.name.to_owned(), property(p))));
    let mut required = vec!["deformation"];
    required.extend(info.params.iter().filter(|p| p.needed).map(|p| p.name));
    json!({ "type": "object", "required": required, "additionalProperties": false, "properties": properties })
}

fn property(p: &Param) -> Value {
    let single = match p.kind {
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Number | Kind::Length(_) | Kind::Angle => json!({ "type": ["number", "string"] }),
        Kind::Count => json!({ "type": ["integer", "string"] }),
        Kind::Choice(words) => json!({ "enum": words }),
        // The value may also be a file, so the names are only examples.
        Kind::NameOrFile(names) => json!({ "type": "string", "examples": names }),
        _ => json!({ "type": "string" }),
    };
    let mut v = if p.repeat { json!({ "anyOf": [single, { "type": "array", "items": single }] }) } else { single };
    v["description"] = json!(p.help);
    if let Some(d) = p.default {
        v["default"] = json!(d);
    }
    for (key, limit) in [("minimum", p.range.0), ("maximum", p.range.1)] {
        // A length or angle may be given in other units than its limits, so only plain numbers carry them.
        if limit.is_finite() && matches!(p.kind, Kind::Number | Kind::Count) {
            v[key] = json!(limit);
        }
    }
    v
}
