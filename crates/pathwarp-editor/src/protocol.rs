//! The messages between page and server, each a JSON object.
//!
//! A page numbers its requests and gets one answer with the same number for each, in order. While something is dragged, it requests the
//! next picture only after the last one has arrived, so that requests do not pile up.

use crate::host::PictureOptions;
use crate::words::Words;
use pathwarp::param::Args;
use pathwarp::recipe::{Recipe, Step};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// A step in pages and drafts, with values as typed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct PageStep {
    pub(crate) deformation: String,
    #[serde(default)]
    pub(crate) inverse: bool,
    #[serde(default)]
    pub(crate) args: BTreeMap<String, Vec<String>>,
    /// Selectors of the parts of the drawing that the step applies to, and of those that it leaves out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) select: Vec<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) exclude: Vec<String>,
    /// The user's name for the step; only drafts store it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<String>,
    /// `true` if the step is switched off and in no result.
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) hidden: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_false(value: &bool) -> bool {
    !value
}

/// A request.
#[derive(Debug, Deserialize)]
pub(crate) struct Message {
    pub(crate) id: u64,
    #[serde(flatten)]
    pub(crate) request: Request,
}

#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
pub(crate) enum Request {
    /// Requests everything that a page needs at its start.
    Hello,
    /// Requests a picture under these steps, without storing them.
    Bend {
        steps: Vec<PageStep>,
        draft: Option<f64>,
    },
    /// Stores these steps, and requests their picture.
    Commit {
        steps: Vec<PageStep>,
        shown: Option<usize>,
    },
    Undo {
        shown: Option<usize>,
    },
    Redo {
        shown: Option<usize>,
    },
    /// Requests the drawing without steps.
    Before,
    /// Requests the drawing under these steps, shown behind a picture of fewer steps; `draft` is its tolerance while something is dragged.
    Ahead {
        steps: Vec<PageStep>,
        draft: Option<f64>,
    },
    /// Requests the picture of a drawing given as base64.
    Drawn {
        name: String,
        bytes: String,
    },
    /// Requests the background of the page, if one is stored.
    Background,
    /// Stores the background of the page until the program ends; only pages know its format.
    KeepBackground {
        background: Value,
    },
    /// Requests the list of the drawing's parts.
    Parts,
    /// Requests the stretch of the drawing under these steps.
    Stretch {
        steps: Vec<PageStep>,
    },
    /// Requests the first values of a deformation that follows these steps.
    Opening {
        deformation: String,
        variant: Option<String>,
        steps: Vec<PageStep>,
        #[serde(default)]
        select: Vec<String>,
    },
    /// Requests the last of these steps for other parts of the drawing, with its paths mapped onto their box.
    Scope {
        steps: Vec<PageStep>,
        select: Vec<String>,
    },
    /// Requests a small picture of the drawing under these steps, or under an example of a deformation or a variant.
    Thumbnail {
        steps: Option<Vec<PageStep>>,
        example: Option<String>,
        variant: Option<String>,
    },
    /// Requests the families of fonts.
    Families,
    /// Sets words as the drawing. If it consists of words already, the present steps stay.
    SetWords {
        words: Words,
    },
    /// Opens a file, given as base64, that was dropped on the page.
    Open {
        name: String,
        bytes: String,
    },
    /// Writes a file, given as base64, that a step reads, beside the drawing.
    Bring {
        name: String,
        bytes: String,
    },
    /// Writes the result to a file; without a name, to the usual one.
    Save {
        #[serde(flatten)]
        to: Target,
        replace: bool,
    },
    /// Requests the contents that *Save* would write to this file, for a download.
    Download {
        #[serde(flatten)]
        to: Target,
    },
    /// Confirms the steps for the program that waits for them.
    HandOver,
    /// Requests the names of the presets.
    Presets,
    /// Stores the present steps as a preset.
    KeepPreset {
        name: String,
    },
    ForgetPreset {
        name: String,
    },
    /// Requests the steps of a preset, adapted to this drawing.
    Preset {
        name: String,
    },
    /// Requests the point that the last of these steps maps to `at`.
    Preimage {
        steps: Vec<PageStep>,
        at: (f64, f64),
    },
    /// Requests the last of these steps with other values that determine the size of its net, which bends as before.
    Renet {
        steps: Vec<PageStep>,
        values: BTreeMap<String, Vec<String>>,
    },
    /// Requests the command line with the same effect, for a file of this name.
    CommandLine {
        #[serde(flatten)]
        to: Target,
    },
}

/// The file of a result.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Target {
    /// `None` for the usual name.
    pub(crate) name: Option<String>,
    /// `None` for the drawing's folder.
    #[serde(default)]
    pub(crate) folder: Option<String>,
    /// The properties of a picture of the result.
    #[serde(default)]
    pub(crate) picture: PictureOptions,
}

/// Returns the recipe of the steps that are not hidden.
pub(crate) fn recipe(steps: &[PageStep]) -> Recipe {
    let step = |s: &PageStep| {
        let mut args = Args::new();
        for (name, values) in s.args.iter().filter(|(_, values)| !values.is_empty()) {
            args.set(name, values.clone());
        }
        let (select, exclude) = (s.select.clone(), s.exclude.clone());
        Step { inverse: s.inverse, select, exclude, ..Step::new(s.deformation.clone(), args) }
    };
    Recipe { steps: steps.iter().filter(|s| !s.hidden).map(step).collect() }
}

/// Returns the steps of a recipe.
pub(crate) fn steps(recipe: &Recipe) -> Vec<PageStep> {
    let step = |s: &Step| PageStep {
        deformation: s.deformation.clone(),
        inverse: s.inverse,
        args: s.args.iter().map(|(name, values)| (name.to_owned(), values.to_vec())).collect(),
        select: s.select.clone(),
        exclude: s.exclude.clone(),
        ..PageStep::default()
    };
    recipe.steps.iter().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read() {
        let text = r#"{"id":7,"do":"bend","steps":[{"deformation":"wave","args":{"height":["5%"]},"select":[".a"]}],"draft":0.5}"#;
        let message: Message = serde_json::from_str(text).unwrap();
        let Request::Bend { steps: given, draft } = message.request else { panic!() };
        assert_eq!((message.id, draft), (7, Some(0.5)));
        assert_eq!(steps(&recipe(&given)), given);
        assert!(serde_json::from_str::<Message>(r#"{"id":1,"do":"format-disk"}"#).is_err());
    }
}
