//! The definition of one common option: what the table holds.

use super::common::CommonOptions;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// One common option.
pub(crate) struct CommonOption {
    /// Long name, and the key in a recipe's `[options]`.
    pub(crate) name: &'static str,
    pub(crate) short: Option<char>,
    pub(crate) value: OptionValue,
    /// Default, in words for help. The default of a [`Choice`](OptionValue::Choice) is one of its words.
    pub(crate) default: Option<&'static str>,
    /// Recipes store the option: it shapes the result, rather than naming files or changing what is printed.
    pub(crate) stored: bool,
    /// Every command that reads drawings has the option.
    pub(crate) reading: bool,
    /// Options that cannot be given together with this one.
    pub(crate) conflicts: &'static [&'static str],
    pub(crate) help: &'static str,
}

/// Sets an option whose value needs no parsing.
pub(crate) type Set = fn(&mut CommonOptions);

/// The kind of value an option takes, and how it updates [`CommonOptions`].
pub(crate) enum OptionValue {
    /// Present or absent; takes no value.
    Switch(Set),
    /// One of these words.
    Choice(&'static [(&'static str, Set)]),
    /// A whole number in a range.
    Whole { name: &'static str, range: RangeInclusive<u16>, set: fn(&mut CommonOptions, u16) },
    /// Text with its own syntax. The error names the fault without the option.
    Text { name: &'static str, minus: LeadingMinus, set: fn(&mut CommonOptions, &str) -> Result<(), String> },
    /// Text; may be given several times.
    List { name: &'static str, push: fn(&mut CommonOptions, &str) -> Result<(), String> },
    /// A file or folder.
    File { name: &'static str, set: fn(&mut CommonOptions, PathBuf) },
}

/// Values that may start with a minus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LeadingMinus {
    No,
    /// If it is a number.
    Number,
    Any,
}

impl CommonOption {
    /// The help text with the default.
    pub(crate) fn help(&self) -> String {
        match self.default {
            Some(d) => format!("{} [default: {d}]", self.help),
            None => self.help.to_owned(),
        }
    }

    /// Returns `true` if the option may be given several times.
    pub(crate) fn repeats(&self) -> bool {
        matches!(self.value, OptionValue::List { .. })
    }

    /// The words of a choice.
    pub(crate) fn words(&self) -> Vec<&'static str> {
        match &self.value {
            OptionValue::Choice(words) => words.iter().map(|(word, _)| *word).collect(),
            _ => Vec::new(),
        }
    }

    /// Checks a value as far as the kind alone decides: `Ok` if it is one of the words, in the range, or `true` for a switch.
    pub(crate) fn check(&self, value: &str) -> Result<(), String> {
        match &self.value {
            OptionValue::Switch(_) if value != "true" => Err(format!("`{value}` is neither true nor false")),
            OptionValue::Choice(words) if !words.iter().any(|(word, _)| *word == value) => {
                Err(format!("`{value}` is not one of {}", self.words().join(", ")))
            }
            OptionValue::Whole { range, .. } if !value.parse().is_ok_and(|n| range.contains(&n)) => {
                Err(format!("`{value}` is not a whole number from {} to {}", range.start(), range.end()))
            }
            _ => Ok(()),
        }
    }
}
