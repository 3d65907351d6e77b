//! The common options as arguments of clap, and their values on a parsed command line.

use clap::builder::PossibleValue;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::{CommonOption, Given, LeadingMinus, OPTIONS, OptionValue, Reading};
use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

/// Returns the inputs and options of a parsed command line. The command need not declare them all.
pub(crate) fn given(m: &ArgMatches) -> Given {
    let is_declared = m.try_contains_id(INPUT).is_ok();
    let inputs = is_declared.then(|| m.get_many::<PathBuf>(INPUT)).flatten().into_iter().flatten().cloned();
    Given::new(inputs.collect(), values(OPTIONS.iter(), m))
}

/// Returns the options of [`reading_args`] on a command line.
///
/// # Errors
/// [`Failure::Usage`] if a value cannot be parsed.
pub(crate) fn reading(m: &ArgMatches) -> Result<Reading, Failure> {
    Ok(Given::new(Vec::new(), values(OPTIONS.iter().filter(|o| o.reading), m)).read()?.reading)
}

/// Returns those of the options that are typed, with their values.
fn values(
    options: impl Iterator<Item = &'static CommonOption>,
    m: &ArgMatches,
) -> Vec<(&'static CommonOption, Vec<OsString>)> {
    let is_declared = |o: &CommonOption| m.try_contains_id(o.name).is_ok();
    let is_typed = |o: &CommonOption| is_declared(o) && m.value_source(o.name) == Some(ValueSource::CommandLine);
    let typed = |option: &'static CommonOption| {
        let raw = m.get_raw(option.name).into_iter().flatten();
        let values = match option.value {
            OptionValue::Switch(_) => vec!["true".into()],
            OptionValue::Choice(_) => raw.map(OsStr::to_ascii_lowercase).collect(),
            _ => raw.map(OsStr::to_owned).collect(),
        };
        (option, values)
    };
    options.filter(|o| is_typed(o)).map(typed).collect()
}

/// The id of the positional argument for the inputs.
pub(crate) const INPUT: &str = "INPUT";

/// Returns the arguments for the inputs and the common options.
pub(crate) fn args() -> impl Iterator<Item = Arg> {
    let help = "SVG files (also .svgz), PNG, JPEG or WebP pictures, or GIMP paths (XCF, point lists; FILE or FILE#NAME); - or none \
                reads standard input";
    std::iter::once(inputs_arg().help(help)).chain(options_without_inputs())
}

/// Returns the argument for the inputs of a command that reads drawings.
pub(crate) fn inputs_arg() -> Arg {
    let help =
        "SVG files (also .svgz), or GIMP paths (XCF, point lists; FILE or FILE#NAME); - or none reads standard input";
    Arg::new(INPUT).num_args(0..).value_parser(value_parser!(PathBuf)).help(help)
}

/// Returns the common options, without the inputs.
pub(crate) fn options_without_inputs() -> impl Iterator<Item = Arg> {
    OPTIONS.iter().map(|o| arg_of(o).help_heading("Common options").conflicts_with_all(o.conflicts.iter().copied()))
}

/// The common options of commands that write a drawing without bending it.
pub(crate) const OUTPUT_OPTIONS: [&str; 8] =
    ["format", "dxf-curves", "kerf", "engrave", "duplicates", "page-width", "page-height", "tolerance"];

/// Returns the common options with these names, for a command that has only some of them.
pub(crate) fn some_options(names: &[&str]) -> impl Iterator<Item = Arg> {
    OPTIONS.iter().filter(|o| names.contains(&o.name)).map(|o| arg_of(o).help_heading("Common options"))
}

/// Returns the options for reading drawings, for commands without other common options.
pub(crate) fn reading_args() -> impl Iterator<Item = Arg> {
    OPTIONS.iter().filter(|o| o.reading).map(|o| arg_of(o).help_heading("Reading"))
}

fn arg_of(option: &CommonOption) -> Arg {
    let arg = Arg::new(option.name).long(option.name).short(option.short).visible_aliases(option.alias);
    let arg = arg.help(option.help());
    match &option.value {
        OptionValue::Switch(_) => arg.action(ArgAction::SetTrue),
        OptionValue::Choice(all) => {
            let words = option.words();
            let value = |(word, _): &(&'static str, _)| PossibleValue::new(*word).hide(!words.contains(word));
            let values: Vec<PossibleValue> = all.iter().map(value).collect();
            arg.value_name(words.join("|")).value_parser(values).ignore_case(true).hide_possible_values(true)
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
