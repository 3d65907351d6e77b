//! Runs the words of a command line on a drawing in memory, by way of temporary files.

use super::inx::labelled;
use super::names::{ACTION, CHAIN, DEFORMATION, WARNINGS};
use crate::advice::Flags;
use crate::failure::{Failure, Status};
use crate::options::{Given, options_without_inputs};
use crate::temporaries::Temporary;
use crate::{input, pipeline, steps, terminal, watch};
use pathwarp::budget::Limits;
use pathwarp::deform::Registry;
use serde::Deserialize;
use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Runs a command line.
pub(super) type Dispatch = fn(&Registry, &[OsString]) -> Result<Status, Failure>;

/// What a call needs to run command lines.
pub(super) struct Stage<'a> {
    pub(super) registry: &'a Registry,
    pub(super) dispatch: Dispatch,
    pub(super) call: &'a Call,
}

/// The elements that a command line is to warp.
pub(super) struct Scope<'a> {
    /// Ids; empty for the whole page.
    pub(super) ids: &'a [String],
}

/// The result of a command line.
pub(super) struct Outcome {
    pub(super) svg: String,
    /// x, y, width and height of the frame.
    pub(super) frame: Option<[f64; 4]>,
    /// The height of the lettering's baseline, if the frame has one.
    pub(super) baseline: Option<f64>,
    /// Warnings, and what was not warped.
    pub(super) remarks: Vec<String>,
    /// Something was left out.
    pub(super) partial: bool,
}

/// The part of a report that is of use here.
#[derive(Deserialize)]
struct Report {
    inputs: Vec<Input>,
}

#[derive(Deserialize)]
struct Input {
    #[serde(default)]
    frame: Option<[f64; 4]>,
    #[serde(default)]
    baseline: Option<f64>,
    warnings: Vec<String>,
    skipped: Vec<Skipped>,
}

#[derive(Deserialize)]
struct Skipped {
    id: String,
    why: String,
}

impl Stage<'_> {
    /// The drawing as Inkscape passes it.
    pub(super) fn drawing(&self) -> Result<String, Failure> {
        let bytes = input::bytes(&self.call.file)?;
        String::from_utf8(bytes).map_err(|_| Failure::file(&self.call.file, "is not UTF-8 text"))
    }

    /// The limits on work; Inkscape has read the drawing already.
    pub(super) fn limits(&self) -> Limits {
        Limits::default()
    }

    /// Warps a part of a drawing by a recipe, given as words.
    pub(super) fn warp(&self, svg: &str, words: &[String], scope: &Scope<'_>) -> Result<Outcome, Failure> {
        let source = temporary(svg.as_bytes())?;
        let (result, report) = (temporary(b"")?, temporary(b"")?);
        let words: Vec<OsString> = words.iter().map(OsString::from).collect();
        let parts: Vec<&[OsString]> = words.split(|w| w == CHAIN).collect();
        let parts = steps::parts(self.registry, &parts, &options_without_inputs().collect::<Vec<_>>())?;
        let (mut recipe, mut own) = steps::chained(parts)?;
        // What the recipe selects, it selects in this scope.
        let selected = own.take("select");
        recipe.steps.iter_mut().for_each(|step| step.select.extend(selected.iter().cloned()));
        // The drawing is open on the page that it has.
        let mut given = Given::default().keeping_pages().of_file(source.path());
        let mut set = |name: &str, value: &str| given.set(name, value).map_err(Failure::Usage);
        set("quiet", "true")?;
        set("format", "svg")?;
        set("out", &result.path().display().to_string())?;
        set("report", &report.path().display().to_string())?;
        if let Some(folder) = folder() {
            set("base-dir", &folder.display().to_string())?;
        }
        scope.ids.iter().try_for_each(|id| set("select", &format!("[id={id}]")))?;
        let given = given.overridden_by(&own);
        watch::begin(given.read()?.reading.limits);
        let status = pipeline::run(self.registry, &recipe, &given, None);
        let status = status.map_err(|f| self.without_file(&f, source.path()))?;
        let svg = text(result.path())?;
        let report: Report =
            serde_json::from_str(&text(report.path())?).map_err(|e| Failure::Input(format!("the report: {e}")))?;
        let mut outcome =
            Outcome { svg, frame: None, baseline: None, remarks: Vec::new(), partial: status == Status::Partial };
        for input in report.inputs {
            outcome.frame = input.frame;
            outcome.baseline = input.baseline;
            outcome.remarks.extend(input.warnings);
            outcome.remarks.extend(input.skipped.into_iter().map(|s| format!("{} is not warped: {}", s.id, s.why)));
        }
        Ok(outcome)
    }

    /// Reports what was left out: as an error if nothing else happened, else if the user wants to see it.
    pub(super) fn check(&self, before: &str, outcome: &Outcome) -> Result<(), Failure> {
        if outcome.partial && outcome.svg == before {
            return Err(Failure::Geometry(outcome.remarks.join("\n")));
        }
        if self.call.is_on(WARNINGS) {
            outcome.remarks.iter().for_each(|r| terminal::warning(&labelled(r)));
        }
        Ok(())
    }

    /// The failure without the name of a temporary file.
    pub(super) fn without_file(&self, failure: &Failure, file: &Path) -> Failure {
        let file = file.display().to_string();
        let message = failure.message(&Flags::of(self.registry));
        Failure::Input(message.replace(&format!("{file}: "), "").replace(&file, "the drawing"))
    }

    /// Converts the file to another format on standard output.
    pub(super) fn convert(&self, format: &str) -> Result<Status, Failure> {
        let mut all: Vec<OsString> = ["pathwarp", "convert"].map(OsString::from).into();
        all.push(self.call.file.clone().into());
        all.push(format!("--format={format}").into());
        if !self.call.is_on(WARNINGS) {
            all.push("--quiet".into());
        }
        let own = self.call.values.iter().filter(|(n, v)| n != WARNINGS && !v.is_empty());
        all.extend(own.map(|(n, v)| format!("--{n}={v}").into()));
        (self.dispatch)(self.registry, &all)
    }
}

/// A temporary file with this content.
pub(super) fn temporary(content: &[u8]) -> Result<Temporary, Failure> {
    let folder = std::env::temp_dir();
    let failed = |e: std::io::Error| Failure::output(&folder, format!("a temporary file cannot be written: {e}"));
    let (temporary, mut file) = Temporary::create_in(&folder).map_err(failed)?;
    file.write_all(content).map_err(failed)?;
    Ok(temporary)
}

fn text(file: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(file).map_err(|e| Failure::file(file, format!("cannot be read: {e}")))
}

/// The folder of the drawing on the screen, which linked pictures are relative to.
pub(super) fn folder() -> Option<PathBuf> {
    let path = PathBuf::from(std::env::var_os("DOCUMENT_PATH").filter(|p| !p.is_empty())?);
    path.parent().filter(|p| p.is_dir()).map(Path::to_path_buf)
}

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
