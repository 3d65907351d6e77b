//! `pathwarp solid list`: the deformations of space.

use crate::failure::Failure;
use crate::output;
use crate::status::Status;
use clap::Command;
use pathwarp_solid::deform::Registry3;
use std::fmt::Write as _;

pub(super) fn command() -> Command {
    Command::new("list").about("List the deformations of space")
}

pub(super) fn run(registry: &Registry3) -> Result<Status, Failure> {
    let width = registry.entries().iter().map(|e| e.about().info.name.len()).max().unwrap_or(0);
    let mut out = String::new();
    for e in registry.entries() {
        let _ = writeln!(out, "{:width$}  {}", e.about().info.name, e.about().info.title);
    }
    out.push_str("\n`pathwarp help solid NAME` describes one; `+` chains several.\n");
    output::to_stdout(out.as_bytes())?;
    Ok(Status::Complete)
}
