//! The common options as given on a command line or in a recipe, and their conversion to typed values.

use super::common::CommonOptions;
use super::table::{CommonOption, OPTIONS, OptionValue};
use crate::failure::Failure;
use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

/// Common options and their values, as given.
#[derive(Clone, Default)]
pub struct Given {
    inputs: Vec<PathBuf>,
    /// In the order of the table. A switch has the value `true`.
    values: Vec<(&'static CommonOption, Vec<OsString>)>,
}

impl Given {
    /// Creates the options for these inputs from values in the order of the table.
    pub fn new(inputs: Vec<PathBuf>, values: Vec<(&'static CommonOption, Vec<OsString>)>) -> Self {
        Self { inputs, values }
    }

    /// Adds the value of an option named in a recipe. Of several values for an option that does not repeat, the last wins.
    pub(crate) fn push(&mut self, name: &str, value: &str) -> Result<(), String> {
        if !CommonOption::named(name).ok_or_else(|| unknown(name))?.stored {
            let advice = "which describe the deformation only; give it on the command line";
            return Err(format!("{name} is not for recipes, {advice}"));
        }
        self.set(name, value)
    }

    /// Adds the value of any option. Of several values for an option that does not repeat, the last wins.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        let option = CommonOption::named(name).ok_or_else(|| unknown(name))?;
        option.check(value).map_err(|e| format!("{name}: {e}"))?;
        match self.values.iter_mut().find(|(o, _)| o.name == option.name) {
            Some((_, values)) if option.repeats() => values.push(value.into()),
            Some((_, values)) => *values = vec![value.into()],
            None => {
                self.values.push((option, vec![value.into()]));
                self.values.sort_by_key(|(o, _)| OPTIONS.iter().position(|other| other.name == o.name));
            }
        }
        Ok(())
    }

    /// Leaves pages as they are unless `fit` is given: for programs with open drawings.
    pub fn keeping_pages(&self) -> Self {
        let mut kept = Self::default();
        // Cannot fail: the option and its value are in the table.
        let _ = kept.set("fit", "none");
        kept.overridden_by(self)
    }

    /// Returns the files to read.
    pub fn inputs(&self) -> &[PathBuf] {
        &self.inputs
    }

    /// Returns `true` if the option is given.
    pub fn gives(&self, name: &str) -> bool {
        self.values.iter().any(|(o, _)| o.name == name)
    }

    /// Removes an option and returns its values.
    pub fn take(&mut self, name: &str) -> Vec<String> {
        let taken = self.values.extract_if(.., |(o, _)| o.name == name).flat_map(|(_, values)| values);
        taken.map(|v| v.to_string_lossy().into_owned()).collect()
    }

    /// Returns the names of the options given.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.values.iter().map(|(o, _)| o.name)
    }

    /// Merges the options of two parts of a chain.
    ///
    /// # Errors
    /// [`Failure::Usage`] if both parts have an option that does not repeat, or two options conflict.
    pub fn joined(&self, other: &Self) -> Result<Self, Failure> {
        if let Some((twice, _)) = other.values.iter().find(|(o, _)| !o.repeats() && self.gives(o.name)) {
            let problem = "cannot be used multiple times: give it in one part of the chain";
            return Err(Failure::usage(format!("--{} {problem}", twice.name)));
        }
        let merged = self.overridden_by(other);
        merged.check_conflicts().map_err(Failure::Usage)?;
        Ok(merged)
    }

    /// Merges two sets of options: lists are concatenated, and other values of `other` take precedence.
    pub fn overridden_by(&self, other: &Self) -> Self {
        let find = |given: &Self, option: &CommonOption| -> Vec<OsString> {
            let all = given.values.iter().filter(|(o, _)| o.name == option.name);
            let mut values = all.map(|(_, v)| v.clone());
            if option.repeats() { values.flatten().collect() } else { values.next_back().unwrap_or_default() }
        };
        let merge = |option: &'static CommonOption| {
            let (first, later) = (find(self, option), find(other, option));
            let replaces = !option.repeats() && !later.is_empty();
            (option, if replaces { later } else { [first, later].concat() })
        };
        let values = OPTIONS.iter().map(merge).filter(|(_, v)| !v.is_empty()).collect();
        let inputs = self.inputs.iter().chain(&other.inputs).cloned().collect();
        Self { inputs, values }
    }

    /// Checks that no two options conflict.
    pub fn check_conflicts(&self) -> Result<(), String> {
        for (option, _) in &self.values {
            if let Some((other, _)) = self.values.iter().find(|(o, _)| option.conflicts.contains(&o.name)) {
                return Err(format!("--{} cannot be used with --{}", option.name, other.name));
            }
        }
        Ok(())
    }

    /// Returns the options that recipes store, by name.
    pub fn stored(&self) -> impl Iterator<Item = (&'static str, Vec<String>)> {
        let stored = self.values.iter().filter(|(o, _)| o.stored);
        stored.map(|(o, values)| (o.name, values.iter().map(|v| v.to_string_lossy().into_owned()).collect()))
    }

    /// Returns the typed values: the defaults of the table, overridden by the values given.
    ///
    /// # Errors
    /// [`Failure::Usage`] if a value cannot be parsed.
    pub fn read(&self) -> Result<CommonOptions, Failure> {
        let mut options = defaults();
        options.inputs.clone_from(&self.inputs);
        for (option, values) in &self.values {
            for value in values {
                let set = set_from(option, value, &mut options);
                set.map_err(|problem| Failure::usage(format!("--{}: {problem}", option.name)))?;
            }
        }
        Ok(options)
    }
}

/// Returns the values that hold if no option is given.
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

/// Sets an option from one value.
fn set_from(option: &CommonOption, value: &OsStr, options: &mut CommonOptions) -> Result<(), String> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::refit::Nodes;

    #[test]
    fn the_default_of_every_choice_is_one_of_its_words() {
        for o in OPTIONS {
            if let OptionValue::Choice(words) = &o.value {
                let default = o.default.unwrap_or_default();
                assert!(words.iter().any(|(word, _)| *word == default), "{}: {default}", o.name);
            }
        }
        let d = defaults();
        assert!(d.nodes == Nodes::Auto && d.warp_images, "{d:?}");
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
            (o.tolerance.map(|l| l.value), o.select, o.nodes),
            (Some(3.0), vec!["a".to_owned(), "b".to_owned()], Nodes::Source)
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
