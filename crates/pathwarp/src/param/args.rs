//! Values as typed.

use super::{Kind, Param, unit};
use crate::error::Error;
use crate::outline::Outline;
use std::collections::BTreeMap;

/// A path that a user named.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPath {
    /// The reference as typed, for messages.
    pub name: String,
    /// The geometry, root user units.
    pub outline: Outline,
}

/// A file that a user named.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedText {
    /// The file as typed, for messages.
    pub name: String,
    /// What it holds.
    pub text: String,
}

/// What was typed for each parameter, and the paths that path references turned out to be.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Args {
    typed: BTreeMap<String, Vec<String>>,
    paths: BTreeMap<String, NamedPath>,
    files: BTreeMap<String, NamedText>,
}

impl Args {
    /// Nothing given.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a value; a flag's value is `true`.
    pub fn push(&mut self, name: &str, value: impl Into<String>) {
        self.typed.entry(name.to_owned()).or_default().push(value.into());
    }

    /// From pairs of name and value.
    #[must_use]
    pub fn from_pairs(pairs: &[(&str, &str)]) -> Self {
        let mut a = Self::new();
        for (n, v) in pairs {
            a.push(n, *v);
        }
        a
    }

    /// The values typed for `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> &[String] {
        self.typed.get(name).map_or(&[], Vec::as_slice)
    }

    /// Everything typed, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &[String])> {
        self.typed.iter().map(|(n, v)| (n.as_str(), v.as_slice()))
    }

    /// Looks up every path reference that is not written out in place (`M …`, `x,y …`) with `look_up`, so that building a
    /// deformation needs no files.
    ///
    /// # Errors
    /// Whatever `look_up` says.
    pub fn resolve_paths(
        &mut self,
        params: &[Param],
        mut look_up: impl FnMut(&str) -> Result<Outline, Error>,
    ) -> Result<(), Error> {
        for p in params.iter().filter(|p| p.kind == Kind::Path) {
            for text in self.typed.get(p.name).into_iter().flatten() {
                if !is_inline(text) && !self.paths.contains_key(text) {
                    let outline = look_up(text)?;
                    self.paths.insert(text.clone(), NamedPath { name: text.clone(), outline });
                }
            }
        }
        Ok(())
    }

    /// Reads every file that a parameter of kind [`Kind::File`] or [`Kind::NameOrFile`] names, with `read`.
    ///
    /// # Errors
    /// Whatever `read` says.
    pub fn resolve_files(
        &mut self,
        params: &[Param],
        mut read: impl FnMut(&str) -> Result<String, Error>,
    ) -> Result<(), Error> {
        for p in params {
            let typed = self.typed.get(p.name).into_iter().flatten();
            for name in typed.filter(|v| p.reads_file(v)) {
                if !self.files.contains_key(name) {
                    let text = read(name)?;
                    self.files.insert(name.clone(), NamedText { name: name.clone(), text });
                }
            }
        }
        Ok(())
    }

    pub(super) fn file(&self, name: &str) -> Option<&NamedText> {
        self.files.get(name)
    }

    pub(super) fn looked_up(&self, reference: &str) -> Option<&NamedPath> {
        self.paths.get(reference)
    }
}

/// Whether a path reference holds the path itself: path data or points, rather than a name.
#[must_use]
pub fn is_inline(text: &str) -> bool {
    is_path_data(text) || unit::looks_like_points(text)
}

/// Whether `text` is SVG path data: it starts with a move command and coordinates follow.
pub(super) fn is_path_data(text: &str) -> bool {
    let rest = text.trim_start().strip_prefix(['M', 'm']);
    rest.is_some_and(|r| r.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)))
}
