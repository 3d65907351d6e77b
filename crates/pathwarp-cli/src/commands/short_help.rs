//! `-h`: as much of a command's help as fits a screen. `--help` says all.

use clap::{Arg, ArgAction, Command};
use std::ffi::OsString;

/// The screen.
const LINES: usize = 40;
const COLUMNS: usize = 80;

/// The common options that are shown; those about reading are not.
const COMMON: [&str; 6] = ["out", "out-dir", "select", "tolerance", "fit", "preview"];

/// The command line, with the help of the subcommand that `words` name made short. `line` is the name of the program.
pub(super) fn shortened(command: Command, words: &[OsString], line: &str) -> Command {
    let named = words.first().and_then(|w| Some(command.find_subcommand(w)?.get_name().to_owned()));
    let Some(name) = named else { return command };
    let line = format!("{line} {name}");
    command.mut_subcommand(name, |c| {
        let further = words[1..].first().is_some_and(|w| c.find_subcommand(w).is_some());
        if further { shortened(c, &words[1..], &line) } else { fitted(c, &line) }
    })
}

/// A command whose help has at most so many lines: a line for each option, and one example.
fn fitted(command: Command, line: &str) -> Command {
    let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let lines: Vec<&str> = after.lines().map(str::trim).collect();
    let example = lines.iter().position(|l| l.starts_with("pathwarp ") && !l.contains(" = ")).map(|i| {
        let what = lines[..i].last().filter(|l| l.ends_with(':') && **l != "Examples:").unwrap_or(&"Example:");
        format!("{what}\n  {}\n\n", lines[i])
    });
    let mut shown: Vec<String> =
        command.get_arguments().filter(|a| is_wanted(a)).map(|a| a.get_id().to_string()).collect();
    // Who has found `-h` needs no line about it.
    let help = Arg::new("help").short('h').long("help").action(ArgAction::HelpShort).hide(true);
    let after = format!("{}All options: {line} --help", example.unwrap_or_default());
    let command = command.disable_help_flag(true).arg(help).term_width(COLUMNS).after_help(after);
    loop {
        let values = |a: &Arg| value(a).map_or(0, |v| v.len() + 3);
        let width = |a: &Arg| a.get_long().map_or(0, |l| "      --".len() + l.len() + values(a));
        let is_shown = |a: &Arg| shown.iter().any(|s| *a.get_id() == s.as_str());
        let widest = command.get_arguments().filter(|a| is_shown(a)).map(width).max().unwrap_or_default();
        // The parser of command lines puts a help that has less room on a line of its own.
        let room = COLUMNS - widest.min(COLUMNS / 2) - 12;
        let mut short = command.clone().mut_args(|a| {
            let (hidden, help) = (!is_shown(&a), brief(&a, room));
            let a = match value(&a) {
                Some(name) if !a.is_positional() => a.value_name(name).hide_possible_values(true),
                _ => a,
            };
            a.help(help).hide_short_help(hidden)
        });
        let too_long = short.render_help().to_string().lines().count() > LINES;
        let stays = |s: &str| COMMON.contains(&s) || command.get_positionals().any(|a| *a.get_id() == s);
        match shown.iter().rposition(|s| !stays(s)).filter(|_| too_long) {
            Some(last) => drop(shown.remove(last)),
            None => return short,
        }
    }
}

fn is_wanted(arg: &Arg) -> bool {
    let wanted = match arg.get_help_heading() {
        Some("Reading") => false,
        Some("Common options") => COMMON.contains(&arg.get_id().as_str()),
        _ => true,
    };
    wanted && !arg.is_hide_set() && !arg.is_hide_short_help_set()
}

/// The name of an option's value; of many words `WORD`.
fn value(arg: &Arg) -> Option<String> {
    const LONG: usize = 16;
    let name = arg.get_value_names().filter(|_| arg.get_action().takes_values())?.first()?;
    Some(if name.len() > LONG { "WORD".to_owned() } else { name.to_string() })
}

/// What fits in `room` columns of an option's help: its words, or the beginning of the text, with the default.
fn brief(arg: &Arg, room: usize) -> String {
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let (text, default) = help.split_once(" [default: ").unwrap_or((&help, ""));
    let default = default.trim_end_matches(']');
    let default = if default.is_empty() || default.len() > room / 3 { String::new() } else { format!(" [{default}]") };
    let room = room - default.chars().count();
    let words = arg.get_value_names().and_then(|n| n.first()).filter(|n| value(arg).is_some_and(|v| v != **n));
    if let Some(words) = words.map(|n| n.replace('|', ", ")).filter(|w| w.len() <= room) {
        return words + &default;
    }
    let ends = |signs: &[&str]| {
        let all = signs.iter().flat_map(|s| text.match_indices(s)).map(|(i, _)| i);
        all.filter(|i| text[..*i].chars().count() < room).max().unwrap_or_default()
    };
    let text = if text.chars().count() <= room {
        text.trim_end_matches('.').to_owned()
    } else if ends(&[". ", "; ", ": "]) > room / 2 {
        text[..ends(&[". ", "; ", ": "])].to_owned()
    } else {
        text[..ends(&[" "])].trim_end_matches([',', ':', '(']).to_owned() + "…"
    };
    text + &default
}
