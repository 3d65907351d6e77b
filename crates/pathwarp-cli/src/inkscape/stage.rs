//! The context of a call by Inkscape, which applies words of a command line to its drawing.

use super::inx::labelled;
use super::names::{ACTION, CHAIN, DEFORMATION, WARNINGS};
use crate::arguments::options_without_inputs;
use crate::ending::{Ending, Status};
use crate::{steps, terminal, watch};
use pathwarp::Error;
use pathwarp::budget::Limits;
use pathwarp::deform::Registry;
use pathwarp::recipe::Recipe;
use pathwarp_engine::advice::Flags;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::links::Destination;
use pathwarp_engine::meter;
use pathwarp_engine::options::{CommonOptions, Given};
use pathwarp_engine::report::FileReport;
use pathwarp_engine::session::warp_bytes;
use pathwarp_engine::{input, references};
use pathwarp_raster::Picture;
use pathwarp_svg::objects::Guides;
use pathwarp_svg::{Document, ReadOptions};
use std::cell::LazyCell;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Converts a file with these options; without a target, to standard output.
pub(super) type Convert = fn(&Path, Option<&Path>, &CommonOptions, bool, bool) -> Result<Status, Failure>;

/// The context of a call.
pub(super) struct Stage<'a> {
    pub(super) registry: &'a Registry,
    pub(super) convert: Convert,
    pub(super) call: &'a Call,
}

/// The elements that a command line warps.
pub(super) struct Scope<'a> {
    /// Ids; empty for the whole page.
    pub(super) ids: &'a [String],
}

/// The result of a command line.
pub(super) struct Outcome {
    pub(super) svg: String,
    /// The frame's x, y, width and height.
    pub(super) frame: Option<[f64; 4]>,
    /// The height of the lettering's baseline, if the frame has one.
    pub(super) baseline: Option<f64>,
    /// Warnings, and objects that were not warped.
    pub(super) remarks: Vec<String>,
    /// `true` if something was left out.
    pub(super) partial: bool,
}

impl Stage<'_> {
    /// Reads the drawing that Inkscape passes.
    pub(super) fn drawing(&self) -> Result<String, Failure> {
        let bytes = input::bytes(&self.call.file)?;
        String::from_utf8(bytes).map_err(|_| Failure::file(&self.call.file, "is not UTF-8 text"))
    }

    /// Returns the limits on work: the default ones, since Inkscape has already read the drawing.
    pub(super) fn limits(&self) -> Limits {
        Limits::default()
    }

    /// Warps a part of a drawing by a recipe, given as words. Paths that `guides` contains are taken from there.
    pub(super) fn warp(
        &self,
        svg: &str,
        words: &[String],
        scope: &Scope<'_>,
        guides: Option<&GuidePaths<'_>>,
    ) -> Result<Outcome, Failure> {
        let words: Vec<OsString> = words.iter().map(OsString::from).collect();
        let parts: Vec<&[OsString]> = words.split(|w| w == CHAIN).collect();
        let parts = steps::parts(self.registry, &parts, &options_without_inputs().collect::<Vec<_>>());
        let (mut recipe, mut stored) = steps::chained(parts.map_err(Ending::into_failure)?)?;
        // The recipe's selection applies within this scope.
        let selected = stored.take("select");
        recipe.steps.iter_mut().for_each(|step| step.select.extend(selected.iter().cloned()));
        let mut given = Given::default();
        if let Some(folder) = folder() {
            given.set("base-dir", &folder.display().to_string()).map_err(Failure::Usage)?;
        }
        scope.ids.iter().try_for_each(|id| given.set("select", &format!("[id={id}]"))).map_err(Failure::Usage)?;
        let given = given.overridden_by(&stored);
        let reading = given.read()?.reading;
        watch::begin(reading.limits);
        let _watched = watch::InBatch::begin();
        meter::count_input(svg.len());
        reading.check()?;
        if let Some(guides) = guides {
            guides.look_up(self, &mut recipe)?;
        }
        references::resolve_files(self.registry, &mut recipe, &reading)?;
        // The drawing is open with its page, which stays.
        let path = (&*self.call.file, Destination::Back);
        let (bytes, warped) = warp_bytes(self.registry, &recipe, &given, None, path, svg.as_bytes())?;
        let FileReport { frame, baseline, warnings, skipped, .. } = warped.report;
        let skipped = skipped.iter().map(ToString::to_string);
        Ok(Outcome {
            svg: String::from_utf8(bytes).map_err(|e| Failure::Input(e.to_string()))?,
            frame,
            baseline,
            remarks: warnings.into_iter().chain(skipped).collect(),
            partial: warped.partial || warped.page.is_blank,
        })
    }

    /// Reports objects that were left out: as an error if nothing else happened, else on request.
    pub(super) fn report_left_out(&self, before: &str, outcome: &Outcome) -> Result<(), Failure> {
        if outcome.partial && outcome.svg == before {
            return Err(Failure::Geometry(outcome.remarks.join("\n")));
        }
        if self.call.is_on(WARNINGS) {
            outcome.remarks.iter().for_each(|r| terminal::warning(&labelled(r)));
        }
        Ok(())
    }

    /// Removes the name of Inkscape's temporary file from a failure.
    pub(super) fn without_file(&self, failure: &Failure) -> Failure {
        let file = self.call.file.display().to_string();
        let message = failure.message(&Flags::of(self.registry));
        Failure::Input(message.replace(&format!("{file}: "), "").replace(&file, "the drawing"))
    }

    /// Converts the file to another format on standard output.
    pub(super) fn convert(&self, format: &str) -> Result<Status, Failure> {
        let mut given = Given::default();
        given.set("format", format).map_err(Failure::Usage)?;
        if !self.call.is_on(WARNINGS) {
            given.set("quiet", "true").map_err(Failure::Usage)?;
        }
        let mut values = self.call.values.iter().filter(|(name, value)| name != WARNINGS && !value.is_empty());
        values.try_for_each(|(name, value)| given.set(name, value)).map_err(Failure::Usage)?;
        let options = given.read()?;
        watch::begin(options.reading.limits);
        (self.convert)(&self.call.file, None, &options, false, false)
    }

    /// Reads a drawing.
    pub(super) fn read(&self, svg: &str) -> Result<Document, Failure> {
        let options = ReadOptions::default().with_turned(Some(Picture::turned)).with_limits(self.limits());
        Ok(Document::read(svg.as_bytes(), "the drawing", &options)?)
    }
}

/// Copies of guides that an object stores, with a test for those that replace the drawing's guides.
pub(super) struct GuidePaths<'a> {
    pub(super) guides: &'a Guides,
    pub(super) has: &'a dyn Fn(&str) -> bool,
}

impl GuidePaths<'_> {
    /// Looks up the references of a recipe to these guides.
    fn look_up(&self, stage: &Stage<'_>, recipe: &mut Recipe) -> Result<(), Failure> {
        let copies = LazyCell::new(|| stage.read(&self.guides.file()));
        let look_up = |reference: &str| match reference.strip_prefix('#').filter(|id| (self.has)(id)) {
            None => Ok(None),
            Some(id) => match &*copies {
                Ok(copies) => Ok(Some(copies.path(id)?.outline)),
                Err(_) => Err(Error::input(reference, "is kept as a copy that cannot be read")),
            },
        };
        for step in &mut recipe.steps {
            let params = stage.registry.get(&step.deformation).map_or(&[][..], |e| e.info().params);
            step.args.resolve_paths(params, look_up).map_err(Failure::of_recipe)?;
        }
        Ok(())
    }
}

/// Returns the folder of the drawing on the screen; links to pictures are relative to it.
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

/// An action that Inkscape requests.
pub(super) enum Job {
    Deformation(String),
    Edit,
    Release,
    /// Open the editor's page.
    EditByHand,
    /// Convert the file to this format, or open it if that is `svg`.
    Convert(String),
}

impl Call {
    /// Parses the arguments, the first of which is the program.
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
                // Parameters of the dialog as a whole and of the node tool.
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

    /// Returns the value of a parameter; `None` if it is empty.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        let value = self.values.iter().find(|(n, _)| n == name).map(|(_, v)| v.trim());
        value.filter(|v| !v.is_empty())
    }

    /// Returns `true` if a switch is on.
    pub(super) fn is_on(&self, name: &str) -> bool {
        self.value(name) == Some("true")
    }
}

/// Parses the value of [`ACTION`].
fn action(value: &str) -> Result<Job, Failure> {
    match value {
        "edit" => Ok(Job::Edit),
        "release" => Ok(Job::Release),
        "hand" => Ok(Job::EditByHand),
        _ => {
            let format = value.strip_prefix("to-").map(|format| Job::Convert(format.to_owned()));
            format.ok_or_else(|| Failure::usage(format!("there is no effect `{value}` for Inkscape")))
        }
    }
}
