//! Errors in formulas. Their messages continue a sentence about the formula or the file it is in.

use thiserror::Error;

/// A definition or formula of a [`Calculator`](super::Calculator) that has no value.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum FormulaError {
    #[error("is not NAME = FORMULA")]
    NoDefinition,
    #[error("defines `{0}`, which is not a valid name: use letters, digits and _, starting with a letter")]
    BadName(String),
    #[error("has a test with only one outcome: write TEST ? FORMULA : FORMULA")]
    OneOutcome,
    #[error("has too many operations")]
    TooLong,
    #[error("has a formula that is not finite here: `{0}`")]
    NotFinite(String),
    #[error("{}", .1.show(.0))]
    Syntax(String, SyntaxError),
}

/// A syntax error, at a byte of the formula.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SyntaxError {
    pub(crate) at: usize,
    pub(crate) problem: Problem,
}

impl SyntaxError {
    pub(super) fn new(at: usize, problem: Problem) -> Self {
        Self { at, problem }
    }

    /// Returns the message, the formula and a caret below the error.
    pub(crate) fn show(&self, text: &str) -> String {
        let column = text.get(..self.at).unwrap_or(text).chars().count();
        // Tabs would misalign the caret.
        let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        format!("is not a valid formula: {}\n  {line}\n  {}^", self.problem, " ".repeat(column))
    }
}

#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum Problem {
    #[error("it is longer than {0} bytes")]
    TooLong(usize),
    #[error("it is nested more than {0} deep")]
    TooDeep(usize),
    #[error("it has too many operations")]
    TooManyOperations,
    #[error("this bracket was never opened")]
    NeverOpened,
    #[error("this bracket is never closed")]
    NeverClosed,
    #[error("an operator is missing here (write products with *)")]
    MissingOperator,
    #[error("an operator or a closing bracket is missing here")]
    MissingOperatorOrBracket,
    #[error("`{0}` has no meaning here")]
    Meaningless(char),
    #[error("a value is missing at the end")]
    EndsEarly,
    #[error("expected a value, found `{0}`")]
    NoValue(char),
    #[error("this comma is outside a function's arguments, or one argument too many precedes it")]
    StrayComma,
    #[error("this is not a number")]
    NotANumber,
    #[error("this number is too large")]
    TooLarge,
    #[error("there is no `{word}`; names are {names}; functions are {functions}")]
    Unknown { word: String, names: String, functions: &'static str },
    #[error("`{0}` is a function: put its argument in brackets")]
    NoArguments(String),
    #[error("`{0}` takes two arguments, separated by a comma")]
    OneArgument(String),
}
