//! `pathwarp list`: the deformations, by group; as JSON with their parameters.

use crate::failure::Failure;
use crate::output;
use crate::plugins::Plugins;
use crate::readable;
use crate::status::Status;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp::deform::{Info, Registry};
use pathwarp::param::{Axis, Kind, Param};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::IsTerminal;

pub(super) const NAME: &str = "list";

pub(super) fn command() -> Command {
    Command::new(NAME)
        .about("List the deformations")
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print JSON, with every parameter"))
}

/// The deformations with their parameters, and the plug-ins that are broken.
fn json(registry: &Registry, plugins: &Plugins) -> Value {
    let param = |p: &Param| {
        let mut v =
            json!({ "name": p.name, "kind": p.kind.name(), "help": p.help, "needed": p.needed, "repeat": p.repeat });
        if let Kind::Length(axis) = p.kind {
            v["axis"] = match axis {
                Axis::X => json!("x"),
                Axis::Y => json!("y"),
                Axis::Diagonal => json!("diagonal"),
            };
        }
        if p.range.0.is_finite() || p.range.1.is_finite() {
            // JSON has no infinity: null.
            v["range"] = json!([p.range.0, p.range.1]);
        }
        match p.kind {
            Kind::Flag => v["flag"] = json!(true),
            Kind::Choice(words) => v["choices"] = json!(words),
            Kind::NameOrFile(names) => v["names"] = json!(names),
            _ => v["value"] = json!(p.value_name()),
        }
        if let Some(default) = p.default {
            v["default"] = json!(default);
        }
        v
    };
    let deformation = |i: &Info| {
        let params: Vec<Value> = i.params.iter().map(param).collect();
        let examples: Vec<&str> = i.examples.iter().map(|e| e.command).collect();
        json!({
            "name": i.name, "title": i.title, "group": i.group, "about": i.about, "source": i.source,
            "parameters": params, "examples": examples, "plug-in": plugins.file(i.name),
        })
    };
    let broken: Vec<Value> = plugins
        .broken
        .iter()
        .map(|b| json!({ "name": b.name, "file": b.path.display().to_string(), "problem": b.fault.to_string() }))
        .collect();
    let deformations: Vec<Value> = registry.entries().iter().map(|e| deformation(e.info())).collect();
    json!({ "deformations": deformations, "broken-plug-ins": broken })
}

pub(super) fn run(registry: &Registry, plugins: &Plugins, m: &ArgMatches) -> Result<Status, Failure> {
    if m.get_flag("json") {
        let text = readable::json(&json(registry, plugins)).map_err(|e| Failure::Output(e.to_string()))?;
        output::to_stdout((text + "\n").as_bytes())?;
        return Ok(Status::Complete);
    }
    let infos: Vec<&Info> = registry.entries().iter().map(|e| e.info()).collect();
    let width = infos.iter().map(|i| i.name.len()).max().unwrap_or(0);
    let mut groups: Vec<&str> = Vec::new();
    for i in &infos {
        if !groups.contains(&i.group) {
            groups.push(i.group);
        }
    }
    let mut out = String::new();
    let heading = anstyle::Style::new().bold();
    for g in groups {
        let _ = writeln!(out, "{heading}{g}{heading:#}");
        for i in infos.iter().filter(|i| i.group == g) {
            let _ = writeln!(out, "  {:width$}  {}", i.name, i.title);
        }
        out.push('\n');
    }
    if !plugins.broken.is_empty() {
        let _ = writeln!(out, "{heading}Broken plug-ins{heading:#}");
        for b in &plugins.broken {
            let _ = writeln!(out, "  {:width$}  {} {}", b.name, b.path.display(), b.fault);
        }
        out.push_str("  `pathwarp check NAME` tries one again.\n\n");
    }
    out.push_str("`pathwarp help NAME` describes one; `+` chains several.\n");
    let plain = if std::io::stdout().is_terminal() { out } else { anstream::adapter::strip_str(&out).to_string() };
    output::to_stdout(plain.as_bytes())?;
    Ok(Status::Complete)
}
