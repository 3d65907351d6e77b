//! The workspace's chores, run as `cargo xtask NAME`.

mod browser;
mod chore;
mod corpus;
mod docs;
mod heavy;
mod hostile;
mod new_deformation;
mod outputs;
mod package;
mod process;
mod public;
mod refit_report;
mod shadows;
mod shell;
mod speed;

use chore::Chore;
use clap::Command;
use std::process::ExitCode;

/// All chores. Each module declares the options of its chore.
const CHORES: [Chore; 13] = [
    new_deformation::CHORE,
    corpus::CHORE,
    refit_report::CHORE,
    outputs::CHORE,
    speed::CHORE,
    hostile::CHORE,
    heavy::CHORE,
    package::CHORE,
    package::REPRODUCIBLE,
    docs::CHORE,
    public::CHORE,
    browser::CHORE,
    shadows::CHORE,
];

fn main() -> ExitCode {
    let matches = Command::new("cargo xtask")
        .about("The workspace's chores")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(CHORES.iter().map(|chore| (chore.command)()))
        .get_matches();
    // clap refuses all but these names.
    let Some((name, arguments)) = matches.subcommand() else { return ExitCode::FAILURE };
    let chosen = CHORES.iter().find(|chore| (chore.command)().get_name() == name);
    let result = chosen.map_or_else(|| Err("unknown".into()), |chore| (chore.run)(arguments));
    let (text, code) = match result {
        Ok(summary) => (summary, ExitCode::SUCCESS),
        Err(failure) => (format!("error: {failure}"), ExitCode::FAILURE),
    };
    #[expect(clippy::print_stderr, reason = "messages of a program")]
    {
        eprintln!("{text}");
    }
    code
}
