//! Formulas for single numbers, as presets keep them.

use super::error::FormulaError;
use super::parse::{self, Names};
use super::program::Program;

/// Named values, and formulas over them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Calculator {
    values: Vec<(String, f64)>,
}

impl Calculator {
    /// Creates a calculator with these names.
    pub(crate) fn new(values: &[(&str, f64)]) -> Self {
        Self { values: values.iter().map(|(n, v)| ((*n).to_owned(), *v)).collect() }
    }

    /// Sets the value of `name`.
    pub(crate) fn set(&mut self, name: &str, value: f64) {
        match self.values.iter_mut().find(|(n, _)| n == name) {
            Some((_, v)) => *v = value,
            None => self.values.push((name.to_owned(), value)),
        }
    }

    /// Defines a name by `NAME = FORMULA` or `NAME = TEST ? FORMULA : FORMULA`, which takes the first formula if the test is
    /// positive.
    pub(crate) fn define(&mut self, text: &str) -> Result<(), FormulaError> {
        let (name, formula) = text.split_once('=').ok_or(FormulaError::NoDefinition)?;
        let name = name.trim();
        if !parse::is_name(name) || parse::is_function(name) {
            return Err(FormulaError::BadName(name.to_owned()));
        }
        let value = match formula.split_once('?').map(|(test, rest)| (test, rest.split_once(':'))) {
            None => self.value(formula)?,
            Some((test, Some((yes, no)))) => self.value(if self.value(test)? > 0.0 { yes } else { no })?,
            Some((_, None)) => return Err(FormulaError::OneOutcome),
        };
        self.set(name, value);
        Ok(())
    }

    /// Evaluates a formula. The result is finite.
    pub(crate) fn value(&self, formula: &str) -> Result<f64, FormulaError> {
        let mut program = Program::default();
        let mut names = Names::new();
        for (name, v) in self.values.iter().map(|(n, v)| (n.as_str(), *v)).chain([("pi", std::f64::consts::PI)]) {
            names.set(name, program.constant(v).ok_or(FormulaError::TooLong)?);
        }
        let at =
            parse::parse(formula, &names, &mut program).map_err(|e| FormulaError::Syntax(formula.to_owned(), e))?;
        let value = program.run([0.0], [0.0]).get(at as usize).map_or(f64::NAN, |v| v[0]);
        if value.is_finite() { Ok(value) } else { Err(FormulaError::NotFinite(formula.to_owned())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_defined_one_after_another() {
        let mut c = Calculator::new(&[("w", 40.0), ("h", 8.0)]);
        c.define("d = w/h").unwrap();
        c.define("e = max(d, 2)^2 - pi/pi").unwrap();
        c.define("f = -d ? 1 : e").unwrap();
        assert_eq!(c.value("f"), c.value("e"));
        assert_eq!((c.value("e"), c.value("e + 1")), (Ok(24.0), Ok(25.0)));
        for (text, part) in [
            ("x", "NAME = FORMULA"),
            ("sin = 2", "not a valid name"),
            ("a = 1/0", "finite"),
            ("a = q", "q"),
            ("a = 1 ? 2", "only one outcome"),
        ] {
            assert!(c.define(text).unwrap_err().to_string().contains(part), "{text}");
        }
    }
}
