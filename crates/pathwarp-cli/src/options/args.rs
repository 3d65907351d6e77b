//! The table of common options as clap arguments.

use super::definition::{CommonOption, LeadingMinus, OptionValue};
use super::table::OPTIONS;
use clap::{Arg, ArgAction, value_parser};
use std::path::PathBuf;

/// The id of the positional argument for the inputs.
pub(crate) const INPUT: &str = "INPUT";

/// The inputs and the common options.
pub(crate) fn args() -> impl Iterator<Item = Arg> {
    let help = "SVG files (also .svgz), PNG, JPEG or WebP pictures, or GIMP paths (XCF, point lists; FILE or FILE#NAME); - or none \
                reads standard input";
    std::iter::once(inputs_arg().help(help)).chain(options_without_inputs())
}

/// The inputs of a command that reads drawings.
pub(crate) fn inputs_arg() -> Arg {
    let help =
        "SVG files (also .svgz), or GIMP paths (XCF, point lists; FILE or FILE#NAME); - or none reads standard input";
    Arg::new(INPUT).num_args(0..).value_parser(value_parser!(PathBuf)).help(help)
}

/// The common options, without the inputs.
pub(crate) fn options_without_inputs() -> impl Iterator<Item = Arg> {
    OPTIONS.iter().map(|o| arg(o).help_heading("Common options").conflicts_with_all(o.conflicts.iter().copied()))
}

/// Those of the common options that a command shares, with these names.
pub(crate) fn some_options(names: &[&str]) -> impl Iterator<Item = Arg> {
    OPTIONS.iter().filter(|o| names.contains(&o.name)).map(arg)
}

/// The options about reading drawings, for commands that have no other common options.
pub(crate) fn reading_args() -> impl Iterator<Item = Arg> {
    OPTIONS.iter().filter(|o| o.reading).map(|o| arg(o).help_heading("Reading"))
}

fn arg(option: &CommonOption) -> Arg {
    let mut arg = Arg::new(option.name).long(option.name).help(option.help());
    if let Some(c) = option.short {
        arg = arg.short(c);
    }
    match &option.value {
        OptionValue::Switch(_) => arg.action(ArgAction::SetTrue),
        OptionValue::Choice(_) => {
            let words = option.words();
            arg.value_name(words.join("|")).value_parser(words).ignore_case(true).hide_possible_values(true)
        }
        OptionValue::Whole { name, range, .. } => {
            let (least, most) = (i64::from(*range.start()), i64::from(*range.end()));
            arg.value_name(*name).value_parser(value_parser!(u16).range(least..=most))
        }
        OptionValue::Text { name, minus, .. } => arg
            .value_name(*name)
            .allow_negative_numbers(*minus == LeadingMinus::Number)
            .allow_hyphen_values(*minus == LeadingMinus::Any),
        OptionValue::List { name, .. } => arg.value_name(*name).action(ArgAction::Append),
        OptionValue::File { name, .. } => arg.value_name(*name).value_parser(value_parser!(PathBuf)),
    }
}
