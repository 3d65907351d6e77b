//! The arguments that Inkscape passes.

use super::names::{ACTION, DEFORMATION};
use crate::failure::Failure;
use std::ffi::OsString;
use std::path::PathBuf;

/// A call by Inkscape.
pub(super) struct Call {
    pub(super) job: Job,
    /// The selected objects, in the order of selection; empty if nothing is selected.
    pub(super) ids: Vec<String>,
    /// Parameters of the dialog, in its order.
    pub(super) values: Vec<(String, String)>,
    /// A copy of the drawing.
    pub(super) file: PathBuf,
}

/// What Inkscape asks for.
pub(super) enum Job {
    Deformation(String),
    Edit,
    Release,
    /// Opens the editor's page.
    Hand,
    /// Converts the file to this format, or opens it if that is `svg`.
    Convert(String),
}

impl Call {
    /// Reads the arguments. The first is the program.
    pub(super) fn read(args: &[OsString]) -> Result<Self, Failure> {
        let mut job = None;
        let (mut ids, mut values, mut file) = (Vec::new(), Vec::new(), None);
        for arg in args.iter().skip(1) {
            let text = arg.to_string_lossy();
            let Some((name, value)) = text.strip_prefix("--").and_then(|a| a.split_once('=')) else {
                file = Some(PathBuf::from(arg));
                continue;
            };
            match name {
                "id" => ids.push(value.to_owned()),
                // Of the whole dialog and of the node tool.
                "tab" | "selected-nodes" => {}
                DEFORMATION => job = Some(Job::Deformation(value.to_owned())),
                ACTION => job = Some(action(value)?),
                _ => values.push((name.to_owned(), value.to_owned())),
            }
        }
        let missing = |what: &str| Failure::usage(format!("a call by Inkscape must name {what}"));
        let file = file.ok_or_else(|| missing("a file"))?;
        Ok(Self { job: job.ok_or_else(|| missing("an effect"))?, ids, values, file })
    }

    /// The value of a parameter; `None` if it is empty.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        let value = self.values.iter().find(|(n, _)| n == name).map(|(_, v)| v.trim());
        value.filter(|v| !v.is_empty())
    }

    /// Returns `true` if a switch is on.
    pub(super) fn is_on(&self, name: &str) -> bool {
        self.value(name) == Some("true")
    }
}

fn action(value: &str) -> Result<Job, Failure> {
    match value {
        "edit" => Ok(Job::Edit),
        "release" => Ok(Job::Release),
        "hand" => Ok(Job::Hand),
        _ => match value.strip_prefix("to-") {
            Some(format) => Ok(Job::Convert(format.to_owned())),
            None => Err(Failure::usage(format!("there is no effect `{value}` for Inkscape"))),
        },
    }
}
