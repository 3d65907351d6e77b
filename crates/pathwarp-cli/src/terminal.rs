//! Messages on standard error; coloured only on a terminal.

use crate::readable;
use anstyle::{AnsiColor, Style};

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const NOTE: Style = AnsiColor::Cyan.on_default().bold();

fn print(style: Style, label: &str, message: &str) {
    anstream::eprintln!("{style}{label}{style:#}: {}", readable::message(message));
}

pub(crate) fn error(message: &str) {
    print(ERROR, "error", message);
}

pub(crate) fn warning(message: &str) {
    print(WARNING, "warning", message);
}

pub(crate) fn note(message: &str) {
    print(NOTE, "note", message);
}
