//! The common options that a command line or a recipe gives, before and after they are read.

use super::common::{CommonOptions, Reading};
use super::table::{CommonOption, LeadingMinus, OPTIONS, OptionValue};
use crate::edits::EditChoice;
use crate::failure::Failure;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

/// Common options with their values as given.
#[derive(Clone, Default)]
pub(crate) struct Given {
    inputs: Vec<PathBuf>,
    /// In the order of the table. A switch has the value `true`.
    values: Vec<(&'static CommonOption, Vec<OsString>)>,
    /// What is done to the artwork instead of bending it.
    pub(crate) edit: Option<EditChoice>,
}

impl Given {
    /// The inputs and options of a parsed command line.
    pub(crate) fn inputs_and_options(m: &ArgMatches) -> Self {
        let inputs = m.get_many::<PathBuf>(INPUT).into_iter().flatten().cloned().collect();
        Self { inputs, ..Self::options(m) }
    }

    /// The options of a parsed command line without inputs. The command may have only some of them.
    pub(crate) fn options(m: &ArgMatches) -> Self {
        Self::of(OPTIONS.iter(), m)
    }

    fn of(options: impl Iterator<Item = &'static CommonOption>, m: &ArgMatches) -> Self {
        let mut values = Vec::new();
        for option in options {
            let is_declared = m.try_contains_id(option.name).is_ok();
            if !is_declared || m.value_source(option.name) != Some(ValueSource::CommandLine) {
                continue;
            }
            let typed = match option.value {
                OptionValue::Switch(_) => vec!["true".into()],
                OptionValue::Choice(_) => {
                    m.get_raw(option.name).into_iter().flatten().map(OsStr::to_ascii_lowercase).collect()
                }
                _ => m.get_raw(option.name).into_iter().flatten().map(OsStr::to_owned).collect(),
            };
            values.push((option, typed));
        }
        Self { values, ..Self::default() }
    }

    /// The options about reading that a command line of [`reading_args`](super::reading_args) gives.
    ///
    /// # Errors
    /// A value with its own syntax cannot be parsed.
    pub(crate) fn reading(m: &ArgMatches) -> Result<Reading, Failure> {
        Ok(Self::of(OPTIONS.iter().filter(|o| o.reading), m).read()?.reading)
    }

    /// Adds the value of an option named in a recipe. Of several values for an option that does not repeat, the last wins.
    pub(crate) fn push(&mut self, name: &str, value: &str) -> Result<(), String> {
        let option = OPTIONS.iter().find(|o| o.name == name).ok_or_else(|| unknown(name))?;
        if !option.stored {
            return Err(format!(
                "{name} is not for recipes, which describe the deformation only; give it on the command line"
            ));
        }
        self.set(name, value)
    }

    /// Adds the value of any option. Of several values for an option that does not repeat, the last wins.
    pub(crate) fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        let option = OPTIONS.iter().find(|o| o.name == name).ok_or_else(|| unknown(name))?;
        option.check(value).map_err(|e| format!("{name}: {e}"))?;
        match self.values.iter_mut().find(|(o, _)| o.name == option.name) {
            Some((_, values)) if option.repeats() => values.push(value.into()),
            Some((_, values)) => *values = vec![value.into()],
            None => {
                let place = |o: &CommonOption| OPTIONS.iter().position(|other| other.name == o.name);
                self.values.push((option, vec![value.into()]));
                self.values.sort_by_key(|(o, _)| place(o));
            }
        }
        Ok(())
    }

    /// Leaves pages as they are unless `fit` is given: for programs that have drawings of their own open.
    pub(crate) fn keeping_pages(&self) -> Self {
        let mut kept = Self::default();
        // The option and its value are in the table.
        let _ = kept.set("fit", "none");
        kept.overridden_by(self)
    }

    pub(crate) fn inputs(&self) -> &[PathBuf] {
        &self.inputs
    }

    /// Returns `true` if the option is given.
    pub(crate) fn gives(&self, name: &str) -> bool {
        self.values.iter().any(|(o, _)| o.name == name)
    }

    /// Removes an option and returns its values.
    pub(crate) fn take(&mut self, name: &str) -> Vec<String> {
        let taken = self.values.extract_if(.., |(o, _)| o.name == name).flat_map(|(_, values)| values);
        taken.map(|v| v.to_string_lossy().into_owned()).collect()
    }

    /// The names of the options given.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.values.iter().map(|(o, _)| o.name)
    }

    /// Merges the options of two parts of a chain.
    ///
    /// # Errors
    /// An option that does not repeat is in both parts, or two options conflict.
    pub(crate) fn joined(&self, other: &Self) -> Result<Self, Failure> {
        let has = |option: &CommonOption| self.values.iter().any(|(o, _)| o.name == option.name);
        if let Some((twice, _)) = other.values.iter().find(|(o, _)| !o.repeats() && has(o)) {
            let name = twice.name;
            return Err(Failure::usage(format!(
                "--{name} cannot be used multiple times: give it in one part of the chain"
            )));
        }
        let merged = self.overridden_by(other);
        merged.check_conflicts().map_err(Failure::Usage)?;
        Ok(merged)
    }

    /// Replaces the options that `other` gives too. Lists are joined.
    pub(crate) fn overridden_by(&self, other: &Self) -> Self {
        let find = |given: &Self, option: &CommonOption| -> Vec<OsString> {
            let all = given.values.iter().filter(|(o, _)| o.name == option.name);
            let mut values = all.map(|(_, v)| v.clone());
            if option.repeats() { values.flatten().collect() } else { values.next_back().unwrap_or_default() }
        };
        let merge = |option: &'static CommonOption| {
            let (mut mine, others) = (find(self, option), find(other, option));
            if option.repeats() || others.is_empty() {
                mine.extend(others);
                (option, mine)
            } else {
                (option, others)
            }
        };
        let values = OPTIONS.iter().map(merge).filter(|(_, v)| !v.is_empty()).collect();
        let inputs = self.inputs.iter().chain(&other.inputs).cloned().collect();
        Self { inputs, values, edit: other.edit.clone().or_else(|| self.edit.clone()) }
    }

    /// Checks that no two options conflict.
    pub(crate) fn check_conflicts(&self) -> Result<(), String> {
        for (option, _) in &self.values {
            if let Some((other, _)) = self.values.iter().find(|(o, _)| option.conflicts.contains(&o.name)) {
                return Err(format!("--{} cannot be used with --{}", option.name, other.name));
            }
        }
        Ok(())
    }

    /// The options that recipes store, by name.
    pub(crate) fn stored(&self) -> impl Iterator<Item = (&'static str, Vec<String>)> {
        let stored = self.values.iter().filter(|(o, _)| o.stored);
        stored.map(|(o, values)| (o.name, values.iter().map(|v| v.to_string_lossy().into_owned()).collect()))
    }

    /// The typed values: the defaults of the table, overridden by what is given.
    ///
    /// # Errors
    /// A value with its own syntax cannot be parsed.
    pub(crate) fn read(&self) -> Result<CommonOptions, Failure> {
        let mut options = defaults();
        options.inputs.clone_from(&self.inputs);
        options.edit.clone_from(&self.edit);
        for (option, values) in &self.values {
            for value in values {
                apply(option, value, &mut options)
                    .map_err(|problem| Failure::usage(format!("--{}: {problem}", option.name)))?;
            }
        }
        Ok(options)
    }
}

/// The values when no option is given.
fn defaults() -> CommonOptions {
    let mut options = CommonOptions::default();
    for option in OPTIONS {
        if let (OptionValue::Choice(words), Some(default)) = (&option.value, option.default)
            && let Some((_, set)) = words.iter().find(|(word, _)| *word == default)
        {
            set(&mut options);
        }
    }
    options
}

/// Sets one value.
fn apply(option: &CommonOption, value: &OsStr, options: &mut CommonOptions) -> Result<(), String> {
    let text = value.to_string_lossy();
    option.check(&text)?;
    match &option.value {
        OptionValue::Switch(set) => set(options),
        OptionValue::Choice(words) => {
            if let Some((_, set)) = words.iter().find(|(word, _)| *word == text) {
                set(options);
            }
        }
        OptionValue::Whole { set, .. } => {
            if let Ok(n) = text.parse() {
                set(options, n);
            }
        }
        OptionValue::Text { set, .. } => set(options, &text)?,
        OptionValue::List { push, .. } => push(options, &text)?,
        OptionValue::File { set, .. } => set(options, value.into()),
    }
    Ok(())
}

fn unknown(name: &str) -> String {
    crate::advice::unknown("option", name, OPTIONS.iter().map(|o| o.name))
}

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
    let is_there = |name: &&str| OPTIONS.iter().any(|o| o.name == *name);
    OPTIONS.iter().map(move |o| {
        let conflicts = o.conflicts.iter().copied().filter(is_there);
        arg(o).help_heading("Common options").conflicts_with_all(conflicts)
    })
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
    let mut arg = Arg::new(option.name).long(option.name).visible_aliases(option.alias).help(option.help());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_of_every_choice_is_one_of_its_words() {
        for o in OPTIONS {
            if let OptionValue::Choice(words) = &o.value {
                let default = o.default.unwrap_or_default();
                assert!(words.iter().any(|(word, _)| *word == default), "{}: {default}", o.name);
            }
        }
        let d = defaults();
        assert!(d.merge && d.warp_images, "{d:?}");
    }

    #[test]
    fn conflicts_name_options_of_the_table() {
        for o in OPTIONS {
            for c in o.conflicts {
                assert!(OPTIONS.iter().any(|other| other.name == *c), "{}: {c}", o.name);
            }
        }
    }

    #[test]
    fn the_command_line_overrides_a_recipe_and_lists_are_joined() {
        let mut recipe = Given::default();
        for (name, value) in [("tolerance", "1"), ("tolerance", "2"), ("select", "a"), ("merge", "off")] {
            recipe.push(name, value).unwrap();
        }
        let mut line = Given::default();
        line.push("tolerance", "3").unwrap();
        line.push("select", "b").unwrap();
        let o = recipe.overridden_by(&line).read().unwrap();
        assert_eq!(
            (o.tolerance.map(|l| l.value), o.select, o.merge),
            (Some(3.0), vec!["a".to_owned(), "b".to_owned()], false)
        );
        assert_eq!(recipe.read().unwrap().tolerance.map(|l| l.value), Some(2.0));
        assert!(recipe.joined(&line).is_err(), "--tolerance in both parts of a chain");
    }

    #[test]
    fn wrong_values_and_conflicts_are_found() {
        let mut given = Given::default();
        for (name, value) in [
            ("wobble", "1"),
            ("merge", "maybe"),
            ("precision", "16"),
            ("jobs", "2"),
            ("certify", "yes"),
            ("out", "a.svg"),
            ("limit", "bytes=1e99"),
            ("allow-external", "true"),
        ] {
            assert!(given.push(name, value).is_err(), "{name} {value}");
        }
        given.push("tolerance", "-1").unwrap();
        assert!(given.read().is_err());
        let option = |name: &str| OPTIONS.iter().find(|o| o.name == name).unwrap();
        let mut both = Given { values: vec![(option("out"), vec!["a.svg".into()])], ..Given::default() };
        assert!(both.check_conflicts().is_ok());
        both.values.push((option("into"), vec!["b.xcf".into()]));
        assert!(both.check_conflicts().is_err());
    }
}
