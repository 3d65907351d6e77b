//! Messages for people, on standard error; colour only on a terminal.

use crate::flags::dashed;
use anstyle::{AnsiColor, Style};

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const NOTE: Style = AnsiColor::Cyan.on_default().bold();

fn say(style: Style, label: &str, message: &str) {
    anstream::eprintln!("{style}{label}{style:#}: {}", dashed(message));
}

pub(crate) fn error(message: &str) {
    say(ERROR, "error", message);
}

pub(crate) fn warning(message: &str) {
    say(WARNING, "warning", message);
}

pub(crate) fn note(message: &str) {
    say(NOTE, "note", message);
}
