//! The messages between page and server: one JSON object each.
//!
//! A page sends requests with a number, and gets one answer with the same number for each, in order. It sends the next picture
//! of a drag only when it has the last one, so nothing piles up.

use crate::host::PictureOptions;
use crate::words::Words;
use pathwarp::param::Args;
use pathwarp::recipe::{Recipe, Step};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// A step as pages and drafts have it: values as typed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct PageStep {
    pub(crate) deformation: String,
    #[serde(default)]
    pub(crate) inverse: bool,
    #[serde(default)]
    pub(crate) args: BTreeMap<String, Vec<String>>,
    /// Selectors of the part of the drawing that the step holds for, and of what it leaves out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) select: Vec<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) exclude: Vec<String>,
    /// The user's name for it, in the draft alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<String>,
    /// It bends nothing for the time being, and is in no result.
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
    /// Everything a page needs to begin.
    Hello,
    /// A picture under these steps. They are not stored.
    Bend {
        steps: Vec<PageStep>,
        draft: Option<f64>,
    },
    /// The steps as they are to be from now on, and their picture.
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
    /// The drawing without any steps.
    Before,
    /// The drawing under these steps, to lie behind a picture of fewer; `draft` is its tolerance while something is dragged.
    Ahead {
        steps: Vec<PageStep>,
        draft: Option<f64>,
    },
    /// A drawing as it is, given as base64.
    Drawn {
        name: String,
        bytes: String,
    },
    /// The background of the page, if one is kept.
    Background,
    /// Keeps the background of the page, whatever that is, until the program ends.
    KeepBackground {
        background: Value,
    },
    /// The parts of the drawing.
    Parts,
    /// How much these steps stretch the drawing.
    Stretch {
        steps: Vec<PageStep>,
    },
    /// The first values of a deformation that is put after these steps.
    Opening {
        deformation: String,
        variant: Option<String>,
        steps: Vec<PageStep>,
        #[serde(default)]
        select: Vec<String>,
    },
    /// The last of these steps for other parts of the drawing: its paths are laid onto their box.
    Scope {
        steps: Vec<PageStep>,
        select: Vec<String>,
    },
    /// A small picture of the drawing under these steps, or under a deformation, or a variant of it, as its examples show it.
    Thumbnail {
        steps: Option<Vec<PageStep>>,
        example: Option<String>,
        variant: Option<String>,
    },
    /// The families of fonts.
    Families,
    /// Makes these words the drawing; if it consists of words already, with the present steps.
    SetWords {
        words: Words,
    },
    /// Opens a file that was dropped on the page, as base64.
    Open {
        name: String,
        bytes: String,
    },
    /// Puts a file that a step is to read, as base64, beside the drawing.
    Bring {
        name: String,
        bytes: String,
    },
    /// Writes the result to a file; without a name to the usual one.
    Save {
        #[serde(flatten)]
        to: Target,
        replace: bool,
    },
    /// The bytes that *Save* would write to this file, for the browser to keep.
    Download {
        #[serde(flatten)]
        to: Target,
    },
    /// Keeps the steps for the program that waits for them.
    HandOver,
    /// The names of the sets of steps that were kept.
    Presets,
    /// Keeps the present steps under a name.
    KeepPreset {
        name: String,
    },
    ForgetPreset {
        name: String,
    },
    /// The steps of a preset for this drawing.
    Preset {
        name: String,
    },
    /// The place that the last of these steps takes to this one.
    Preimage {
        steps: Vec<PageStep>,
        at: (f64, f64),
    },
    /// The last of these steps with other values of what says how many control points its net has; it bends as before.
    Renet {
        steps: Vec<PageStep>,
        values: BTreeMap<String, Vec<String>>,
    },
    /// The command line with the same effect, for a file of this name.
    CommandLine {
        #[serde(flatten)]
        to: Target,
    },
}

/// The file that a result goes to.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Target {
    /// `None`: the usual one.
    pub(crate) name: Option<String>,
    /// `None`: that of the drawing.
    #[serde(default)]
    pub(crate) folder: Option<String>,
    /// What a picture of the result is like.
    #[serde(default)]
    pub(crate) picture: PictureOptions,
}

/// The recipe of the steps that are not hidden.
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

/// The steps of a recipe.
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
