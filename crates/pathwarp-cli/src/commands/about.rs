//! The commands that describe the program: `list`, `schema`, `man` and `completions`.

use crate::commands::args::{option, switch};
use crate::ending::Status;
use crate::plugins::Plugins;
use clap::{Arg, ArgMatches, Command, value_parser};
use clap_complete::Shell;
use pathwarp::deform::{Info, Registry};
use pathwarp::param::{Axis, Kind, Param};
use pathwarp_engine::catalogue::Catalogue as _;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::OPTIONS;
use pathwarp_engine::output::{self, PendingFile};
use pathwarp_engine::{advice, readable};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::fs;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

pub(super) fn list_command() -> Command {
    Command::new("list").about("List the deformations").arg(switch("json", "Print JSON, with every parameter"))
}

/// Returns the deformations with their parameters, and the plug-ins that are broken, as JSON.
fn catalogue_json(registry: &Registry, plugins: &Plugins) -> Value {
    let param = |p: &Param| {
        let mut json =
            json!({ "name": p.name, "kind": p.kind.name(), "help": p.help, "needed": p.needed, "repeat": p.repeat });
        if let Kind::Length(axis) = p.kind {
            json["axis"] = match axis {
                Axis::X => json!("x"),
                Axis::Y => json!("y"),
                Axis::Diagonal => json!("diagonal"),
            };
        }
        if p.range.0.is_finite() || p.range.1.is_finite() {
            // JSON has no infinity; `json!` writes null.
            json["range"] = json!([p.range.0, p.range.1]);
        }
        match p.kind {
            Kind::Flag => json["flag"] = json!(true),
            Kind::Choice(words) => json["choices"] = json!(words),
            Kind::NameOrFile(names) => json["names"] = json!(names),
            _ => json["value"] = json!(p.value_name()),
        }
        if let Some(default) = p.default {
            json["default"] = json!(default);
        }
        json
    };
    let deformation = |i: &Info| {
        let params: Vec<Value> = i.params.iter().map(param).collect();
        let examples: Vec<&str> = i.examples.iter().map(|e| e.command).collect();
        json!({
            "name": i.name, "title": i.title, "group": i.group, "about": i.about, "source": i.source,
            "parameters": params, "examples": examples, "plug-in": plugins.file(i.name),
        })
    };
    let broken = plugins.broken().map(|[name, file, fault]| json!({ "name": name, "file": file, "problem": fault }));
    let broken: Vec<Value> = broken.collect();
    let deformations: Vec<Value> = registry.entries().iter().map(|e| deformation(e.info())).collect();
    json!({ "deformations": deformations, "broken-plug-ins": broken })
}

pub(super) fn list(registry: &Registry, plugins: &Plugins, m: &ArgMatches) -> Result<Status, Failure> {
    if m.get_flag("json") {
        let text = readable::json(&catalogue_json(registry, plugins)).map_err(|e| Failure::Output(e.to_string()))?;
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
    let mut broken = plugins.broken().peekable();
    if broken.peek().is_some() {
        let _ = writeln!(out, "{heading}Broken plug-ins{heading:#}");
        for [name, file, fault] in broken {
            let _ = writeln!(out, "  {name:width$}  {file} {fault}");
        }
        out.push_str("  `pathwarp check NAME` tries one again.\n\n");
    }
    out.push_str("`pathwarp help NAME` describes one; `+` chains several.\n");
    let plain = if std::io::stdout().is_terminal() { out } else { anstream::adapter::strip_str(&out).to_string() };
    output::to_stdout(plain.as_bytes())?;
    Ok(Status::Complete)
}

pub(super) fn schema_command() -> Command {
    Command::new("schema").about("Print the JSON schema of recipe files")
}

pub(super) fn print_schema(registry: &Registry) -> Result<Status, Failure> {
    let text = serde_json::to_string_pretty(&schema(registry)).map_err(|e| Failure::usage(e.to_string()))? + "\n";
    output::to_stdout(text.as_bytes())?;
    Ok(Status::Complete)
}

fn schema(registry: &Registry) -> Value {
    let steps: Vec<Value> = registry.entries().iter().map(|e| step_schema(e.info())).collect();
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

fn step_schema(info: &Info) -> Value {
    let mut properties = Map::new();
    properties.insert("deformation".into(), json!({ "const": info.name, "description": info.title }));
    properties.insert("inverse".into(), json!({ "type": "boolean", "description": "The inverse map." }));
    properties.extend(info.params.iter().map(|p| (p.name.to_owned(), property(p))));
    let mut required = vec!["deformation"];
    required.extend(info.params.iter().filter(|p| p.needed).map(|p| p.name));
    json!({ "type": "object", "required": required, "additionalProperties": false, "properties": properties })
}

/// Returns the schema of a parameter.
fn property(p: &Param) -> Value {
    let single = match p.kind {
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Number | Kind::Length(_) | Kind::Angle => json!({ "type": ["number", "string"] }),
        Kind::Count => json!({ "type": ["integer", "string"] }),
        Kind::Choice(words) => json!({ "enum": words }),
        // The value may be a file instead, so the names are only examples.
        Kind::NameOrFile(names) => json!({ "type": "string", "examples": names }),
        _ => json!({ "type": "string" }),
    };
    let mut schema = if p.repeat { json!({ "anyOf": [single, { "type": "array", "items": single }] }) } else { single };
    schema["description"] = json!(p.help);
    if let Some(default) = p.default {
        schema["default"] = json!(default);
    }
    for (key, limit) in [("minimum", p.range.0), ("maximum", p.range.1)] {
        // A length or angle may be in other units than its limits, so only plain numbers have limits in the schema.
        if limit.is_finite() && matches!(p.kind, Kind::Number | Kind::Count) {
            schema[key] = json!(limit);
        }
    }
    schema
}

/// The id of the argument.
const PAGE: &str = "PAGE";

pub(super) fn man_command() -> Command {
    Command::new("man")
        .about("Print the manual page of the program, or of one command")
        .arg(Arg::new(PAGE).value_name("NAME").help("A command or deformation [default: the program]"))
        .arg(
            option("out-dir", "DIR", "Write the pages of the program and of all commands to this folder: pathwarp.1, pathwarp-NAME.1")
                .value_parser(value_parser!(PathBuf))
                .conflicts_with(PAGE),
        )
        .after_help(
            "Examples:\n  pathwarp man | man -l -\n  pathwarp man shaper | man -l -\n  pathwarp man --out-dir ~/.local/share/man/man1",
        )
}

/// Prints the manual page of `whole`, the program's command line, or of a part of it.
pub(super) fn man(whole: Command, m: &ArgMatches) -> Result<Status, Failure> {
    if let Some(folder) = m.get_one::<PathBuf>("out-dir") {
        return write_all(&whole, folder);
    }
    let page = match m.get_one::<String>(PAGE) {
        None => page(whole)?,
        Some(name) => {
            let known = whole.get_subcommands().map(Command::get_name);
            let part = whole.find_subcommand(name);
            page(subcommand(part.ok_or_else(|| Failure::usage(advice::unknown("command", name, known)))?))?
        }
    };
    output::to_stdout(&page)?;
    Ok(Status::Complete)
}

/// Writes all pages to a folder, or none.
fn write_all(whole: &Command, folder: &Path) -> Result<Status, Failure> {
    fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))?;
    let all = std::iter::once(whole.clone()).chain(whole.get_subcommands().map(subcommand));
    let files = all.map(|command| {
        let file = folder.join(command.get_name()).with_extension("1");
        PendingFile::new(&file, &page(command)?)
    });
    PendingFile::commit_all(files.collect::<Result<_, Failure>>()?)?;
    Ok(Status::Complete)
}

/// Renames a part of the program after its page.
fn subcommand(part: &Command) -> Command {
    let name = part.get_name();
    part.clone().name(format!("pathwarp-{name}")).bin_name(format!("pathwarp {name}"))
}

/// Returns the text of a page.
fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut out = Vec::new();
    clap_mangen::Man::new(command).render(&mut out).map_err(|e| Failure::stdout(&e))?;
    Ok(out)
}

pub(super) fn completions_command() -> Command {
    Command::new("completions")
        .about("Print completions for a shell")
        .arg(Arg::new("SHELL").required(true).value_parser(value_parser!(Shell)))
}

/// Prints the completions of `whole`, the program's command line, with the values that parameters may have.
pub(super) fn completions(registry: &Registry, mut whole: Command, m: &ArgMatches) -> Result<Status, Failure> {
    for info in registry.infos() {
        for p in info.params {
            let names = p.names();
            if !names.is_empty() {
                whole = whole.mut_subcommand(info.name, |c| c.mut_arg(p.name, |a| a.value_parser(names.to_vec())));
            }
        }
    }
    let mut out = Vec::new();
    if let Some(shell) = m.get_one::<Shell>("SHELL") {
        clap_complete::generate(*shell, &mut whole, "pathwarp", &mut out);
    }
    output::to_stdout(&out)?;
    Ok(Status::Complete)
}
