//! `pathwarp list`: the deformations, by group.

use crate::failure::Failure;
use crate::output;
use crate::status::Status;
use clap::Command;
use pathwarp::deform::{Info, Registry};
use std::fmt::Write as _;
use std::io::IsTerminal;

pub(super) const NAME: &str = "list";

pub(super) fn command() -> Command {
    Command::new(NAME).about("List the deformations")
}

pub(super) fn run(registry: &Registry) -> Result<Status, Failure> {
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
    out.push_str("`pathwarp help NAME` describes one; `+` chains several.\n");
    let plain = if std::io::stdout().is_terminal() { out } else { anstream::adapter::strip_str(&out).to_string() };
    output::to_stdout(plain.as_bytes())?;
    Ok(Status::Complete)
}
