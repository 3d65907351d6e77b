//! Help for reading: one screen for `-h`, a page of a few screens for `--help` and `help NAME`, and the page `help options` for options
//! that most commands share. Manual pages and completions are complete.

use clap::builder::PossibleValue;
use clap::{Arg, ArgAction, Command};
use std::ffi::OsString;
use std::fmt::Write as _;

/// The common options by task. A command's page explains those in `COMMON`, and `help options` explains all.
const TASKS: [(&str, &[&str]); 9] = [
    ("Files", &["out", "out-dir", "format", "in-place", "recursive", "dry-run", "on-error", "into", "salvage"]),
    ("What is bent", &["select", "exclude", "frame", "simplify", "outset", "clones", "text", "images"]),
    ("Curves", &["tolerance", "nodes", "certify", "precision"]),
    ("Paint", &["strokes", "union", "gradients", "patterns", "filters", "image-dpi"]),
    ("Page and document", &["fit", "page-width", "page-height", "structure", "embed-recipe"]),
    ("Photographs", &["crop", "ratio", "image-size", "quality", "keep-location"]),
    ("Cutting (DXF)", &["kerf", "engrave", "duplicates", "dxf-curves"]),
    ("Reports", &["preview", "show-nodes", "show-polygons", "explain", "report", "write-recipe", "quiet"]),
    (
        "Fonts and limits",
        &[
            "font-file",
            "fonts-dir",
            "no-system-fonts",
            "serif-family",
            "sans-serif-family",
            "cursive-family",
            "fantasy-family",
            "monospace-family",
            "jobs",
            "limit",
            "allow-external",
            "base-dir",
        ],
    ),
];

/// The heading of options that most commands have.
const SHARED: &str = "Common options";
/// Width of a page.
const PAGE: usize = 100;
/// Most lines of a page; examples are left out to achieve that.
const LONGEST: usize = 130;
/// Column at which the texts of a page begin.
const TEXT: usize = 30;
/// Length of a common option's text on the page of a command: two lines.
const BRIEF: usize = 2 * (PAGE - TEXT) - 10;

/// Sets a page as the help of the subcommand that `words` name.
pub(super) fn paged(command: Command, words: &[OsString]) -> Command {
    let name = words.iter().find_map(|w| Some(command.find_subcommand(w)?.get_name().to_owned()));
    let Some(name) = name else { return command };
    let line = format!("{} {name}", command.get_bin_name().unwrap_or("pathwarp"));
    command.mut_subcommand(name, |c| {
        let goes_on = words.iter().skip(1).any(|w| c.find_subcommand(w).is_some());
        let c = c.bin_name(line);
        if goes_on {
            return paged(c, &words[1..]);
        }
        let page = page(c.clone());
        c.override_help(page)
    })
}

/// Returns the page of a command.
fn page(mut command: Command) -> String {
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let name = command.get_name();
    let mut out = match command.get_long_about().map(ToString::to_string) {
        Some(long) if long.starts_with(&about) => wrapped(&format!("{name} — {long}"), 0),
        Some(long) => wrapped(&long, 0),
        None => wrapped(&format!("{name} — {about}"), 0),
    };
    let usage = command.render_usage().to_string();
    let _ = write!(out, "\n{}\n", usage.trim_end());
    // The reader knows the help option already.
    let is_shown = |a: &&Arg| !a.is_hide_set() && !a.is_hide_long_help_set() && a.get_id() != "help";
    let args: Vec<&Arg> = command.get_arguments().filter(is_shown).collect();
    let mut headings = vec!["Arguments"];
    for a in &args {
        let heading = heading(a);
        if !headings.contains(&heading) && !is_shared(a) {
            headings.push(heading);
        }
    }
    headings.push(SHARED);
    let is_brief = |a: &Arg| is_shared(a) && !COMMON.contains(&a.get_id().as_str());
    for heading in headings {
        let rows = args.iter().filter(|a| self::heading(a) == heading && !is_brief(a));
        out.push_str(&section(heading, rows.copied(), false));
    }
    out.push_str(&other_options(&args.iter().copied().filter(|a| is_brief(a)).collect::<Vec<_>>()));
    let after = command.get_after_long_help().or(command.get_after_help()).map(ToString::to_string);
    let mut after = after.map(|a| wrapped(&a, 0)).unwrap_or_default();
    while out.lines().count() + after.lines().count() >= LONGEST && without_last_example(&mut after) {}
    format!("{out}\n{after}")
}

/// Removes the last of several examples. Returns `false` if there is only one.
fn without_last_example(after: &mut String) -> bool {
    let begins: Vec<usize> = after.match_indices("\n    pathwarp ").map(|(i, _)| i).collect();
    let [_, .., last] = begins[..] else { return false };
    // The line before is its title.
    let start = after[..last].rfind('\n').map_or(0, |i| i + 1);
    let end = after[last + 1..].find('\n').map_or(after.len(), |i| last + i + 2);
    after.replace_range(start..end, "");
    true
}

/// Returns `true` for an option that most commands have.
fn is_shared(arg: &Arg) -> bool {
    matches!(arg.get_help_heading(), Some("Reading" | SHARED))
}

fn heading(arg: &Arg) -> &str {
    match arg.get_help_heading() {
        _ if arg.is_positional() => "Arguments",
        _ if is_shared(arg) => SHARED,
        heading => heading.unwrap_or("Options"),
    }
}

/// Formats options under a heading, with all of their texts if `is_whole`; empty without options.
fn section<'a>(heading: &str, args: impl Iterator<Item = &'a Arg>, is_whole: bool) -> String {
    let rows: String = args.map(|a| row(a, is_whole)).collect();
    if rows.is_empty() { rows } else { format!("\n{heading}:\n{rows}") }
}

/// Lists the options that `help options` explains, by task.
fn other_options(args: &[&Arg]) -> String {
    let options = |names: &[&str]| -> Vec<String> {
        let is_there = |name: &&&str| args.iter().any(|a| a.get_id() == **name);
        names.iter().filter(is_there).map(|name| format!("--{name}")).collect()
    };
    let rows = TASKS.iter().map(|(task, names)| (*task, options(names))).filter(|(_, options)| !options.is_empty());
    let rows: String = rows.map(|(task, options)| beside(task, &options.join(" "))).collect();
    if rows.is_empty() { rows } else { format!("\nMore options (pathwarp help options):\n{rows}") }
}

/// Returns the page of the options that most commands share.
pub(super) fn options(args: impl Iterator<Item = Arg>) -> String {
    let mut command = Command::new("options").args(args);
    command.build();
    let args: Vec<&Arg> = command.get_arguments().collect();
    let mut out = String::from("The options that most commands share, by task.\n");
    for (task, names) in TASKS {
        let find = |name: &&str| args.iter().find(|a| a.get_id() == *name);
        out.push_str(&section(task, names.iter().filter_map(find).copied(), true));
    }
    out
}

/// Formats an option or argument with its text, which is shortened for a common option unless `is_whole`.
fn row(arg: &Arg, is_whole: bool) -> String {
    let mut text = arg.get_long_help().or(arg.get_help()).map(ToString::to_string).unwrap_or_default();
    if is_shared(arg) && !is_whole {
        text = clipped(&text, BRIEF);
    }
    let values = arg.get_possible_values();
    if !values.is_empty() && !arg.is_hide_possible_values_set() && arg.get_action().takes_values() {
        let names: Vec<&str> = values.iter().filter(|v| !v.is_hide_set()).map(PossibleValue::get_name).collect();
        let _ = write!(text, " [possible values: {}]", names.join(", "));
    }
    let defaults: Vec<_> = arg.get_default_values().iter().map(|v| v.to_string_lossy()).collect();
    if !defaults.is_empty() && arg.get_action().takes_values() {
        let _ = write!(text, " [default: {}]", defaults.join(" "));
    }
    for alias in arg.get_visible_aliases().into_iter().flatten() {
        let _ = write!(text, " [also: --{alias}]");
    }
    let short = arg.get_short().map_or(String::from("    "), |c| format!("-{c}, "));
    let short = if arg.is_positional() { String::new() } else { short };
    beside(&format!("{short}{arg}"), &text)
}

/// Formats a name with its text beside it.
fn beside(name: &str, text: &str) -> String {
    let text = wrapped(text, TEXT);
    match TEXT.checked_sub(name.chars().count() + 4) {
        Some(_) => format!("  {name:<width$}{}", text.trim_start(), width = TEXT - 2),
        None => format!("  {name}\n{text}"),
    }
}

/// Wraps a text into indented lines that fit a page. A line that begins with spaces continues below its text; commands stay whole.
fn wrapped(text: &str, indent: usize) -> String {
    let mut out = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("pathwarp ") {
            let _ = writeln!(out, "{:indent$}{line}", "");
            continue;
        }
        let indent = indent + line.len() - line.trim_start().len();
        let mut width = indent;
        let _ = write!(out, "{:width$}", "");
        for (i, word) in line.trim_start().split(' ').enumerate() {
            let length = word.chars().count();
            if i > 0 && width + 1 + length > PAGE {
                width = indent;
                let _ = write!(out, "\n{:width$}", "");
            } else if i > 0 {
                out.push(' ');
                width += 1;
            }
            out.push_str(word);
            width += length;
        }
        out.truncate(out.trim_end_matches(' ').len());
        out.push('\n');
    }
    out
}

/// Lines and columns of a screen.
const LINES: usize = 40;
const COLUMNS: usize = 80;

/// The common options that every page explains; a screen has as many of them as fit.
const COMMON: [&str; 10] =
    ["out", "out-dir", "format", "select", "tolerance", "nodes", "strokes", "fit", "preview", "explain"];
/// The common options for which a screen always has room.
const ALWAYS: [&str; 6] = ["out", "out-dir", "select", "tolerance", "fit", "preview"];

/// Shortens the help of the subcommand that `words` name. `line` is the name of the program.
pub(super) fn shortened(command: Command, words: &[OsString], line: &str) -> Command {
    let name = words.first().and_then(|w| Some(command.find_subcommand(w)?.get_name().to_owned()));
    let Some(name) = name else { return command };
    let line = format!("{line} {name}");
    command.mut_subcommand(name, |c| {
        let goes_on = words.get(1).is_some_and(|w| c.find_subcommand(w).is_some());
        if goes_on { shortened(c, &words[1..], &line) } else { fit_to_screen(c, &line) }
    })
}

/// Shortens a command's help to a screen: a line for each option, and one example.
fn fit_to_screen(command: Command, line: &str) -> Command {
    let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let lines: Vec<&str> = after.lines().map(str::trim).collect();
    let example = lines.iter().position(|l| l.starts_with("pathwarp ") && !l.contains(" = ")).map(|i| {
        let what = lines[..i].last().filter(|l| l.ends_with(':') && **l != "Examples:").unwrap_or(&"Example:");
        format!("{what}\n  {}\n\n", lines[i])
    });
    let shown = command.get_arguments().filter(|a| is_wanted(a)).map(|a| a.get_id().to_string());
    let mut shown: Vec<String> = shown.collect();
    // The reader knows `-h` already.
    let help = Arg::new("help").short('h').long("help").action(ArgAction::HelpShort).hide(true);
    let after = format!("{}All options: {line} --help", example.unwrap_or_default());
    let command = command.disable_help_flag(true).arg(help).term_width(COLUMNS).after_help(after);
    loop {
        let values = |a: &Arg| value_of(a).map_or(0, |v| v.len() + 3);
        let width = |a: &Arg| a.get_long().map_or(0, |l| "      --".len() + l.len() + values(a));
        let is_shown = |a: &Arg| shown.iter().any(|s| *a.get_id() == s.as_str());
        let widest = command.get_arguments().filter(|a| is_shown(a)).map(width).max().unwrap_or_default();
        // With less room, clap puts a help text on a separate line.
        let room = COLUMNS - widest.min(COLUMNS / 2) - 12;
        let mut short = command.clone().mut_args(|a| {
            let (hidden, help) = (!is_shown(&a), brief(&a, room));
            let a = match value_of(&a) {
                Some(name) if !a.is_positional() => a.value_name(name).hide_possible_values(true),
                _ => a,
            };
            a.help(help).hide_short_help(hidden)
        });
        let too_long = short.render_help().to_string().lines().count() > LINES;
        let stays = |s: &str| ALWAYS.contains(&s) || command.get_positionals().any(|a| *a.get_id() == s);
        match shown.iter().rposition(|s| !stays(s)).filter(|_| too_long) {
            Some(last) => drop(shown.remove(last)),
            None => return short,
        }
    }
}

/// Returns `true` for an option that a screen shows if there is room.
fn is_wanted(arg: &Arg) -> bool {
    let wanted = match arg.get_help_heading() {
        Some("Reading") => false,
        Some(SHARED) => COMMON.contains(&arg.get_id().as_str()),
        _ => true,
    };
    wanted && !arg.is_hide_set() && !arg.is_hide_short_help_set()
}

/// Returns the name of an option's value; `WORD` if it has many words.
fn value_of(arg: &Arg) -> Option<String> {
    const LONG: usize = 16;
    let name = arg.get_value_names().filter(|_| arg.get_action().takes_values())?.first()?;
    Some(if name.len() > LONG { "WORD".to_owned() } else { name.to_string() })
}

/// Returns the words of an option's value, or the beginning of its text, with the default, in `room` columns.
fn brief(arg: &Arg, room: usize) -> String {
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let words = arg.get_value_names().and_then(|n| n.first()).filter(|n| value_of(arg).is_some_and(|v| v != **n));
    let default = default_in(&help, room);
    let words = words.map(|n| n.replace('|', ", ") + &default).filter(|w| w.chars().count() <= room);
    words.unwrap_or_else(|| clipped(&help, room))
}

/// Returns the default, in brackets, at the end of an option's text, unless it takes more than a third of the room.
fn default_in(help: &str, room: usize) -> String {
    let default = help.split_once(" [default: ").map_or("", |(_, default)| default.trim_end_matches(']'));
    if default.is_empty() || default.len() > room / 3 { String::new() } else { format!(" [{default}]") }
}

/// Cuts an option's text to `room` columns, and keeps its default.
fn clipped(help: &str, room: usize) -> String {
    let text = help.split_once(" [default: ").map_or(help, |(text, _)| text);
    let default = default_in(help, room);
    let room = room - default.chars().count();
    let last_cut = |signs: &[&str]| {
        let all = signs.iter().flat_map(|s| text.match_indices(s)).map(|(i, _)| i);
        all.filter(|i| text[..*i].chars().count() < room).max().unwrap_or_default()
    };
    let sentence = last_cut(&[". ", "; ", ": "]);
    let text = if text.chars().count() <= room {
        text.trim_end_matches('.').to_owned()
    } else if sentence > room / 2 {
        text[..sentence].to_owned()
    } else {
        text[..last_cut(&[" "])].trim_end_matches([',', ':', '(']).to_owned() + "…"
    };
    text + &default
}
