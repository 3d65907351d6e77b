//! [`Warper`]: a recipe with its options, applied in memory.

use super::error::{Error, guarded};
use super::function::{Function, is_function};
use super::{PointMap, check_option, meaning, option_names};
use crate::edits::{self, EDITS};
use crate::failure::Failure;
use crate::input::{PlainArtwork, hatching, planned};
use crate::links::Destination;
use crate::options::{CommonOptions, FrameChoice, Given, Reading};
use crate::report::Fold;
use crate::session::{Session, check_maps, warp_bytes};
use crate::steps::{self, as_known_name};
use crate::{advice, recipe_file, references};
use pathwarp::Outline;
use pathwarp::budget::Budget;
use pathwarp::check::{self, Check};
use pathwarp::deform::{Deformation as _, Info, Registry};
use pathwarp::engine::{Abilities, Callee};
use pathwarp::fit::{self, Degree};
use pathwarp::fold::Survey;
use pathwarp::kurbo::{PathEl, Rect};
use pathwarp::param::{Args, Frame, Kind, Param, Settings};
use pathwarp::recipe::{BuiltRecipe, Recipe, Step};
use pathwarp::refit::{self, Assurance};
use pathwarp_svg::{Edit, WarpedPath};
use std::fmt;
use std::path::Path as FilePath;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Options that apply to a path without a drawing.
const PATH_OPTIONS: [&str; 6] = ["frame", "tolerance", "certify", "nodes", "precision", "limit"];

/// The part of an error about a missing box.
const NEEDS_FRAME: &str = "which percentages and defaults refer to: give it (--frame X,Y,W,H)";

/// Deformations one after another, with the options of a warp.
#[derive(Clone)]
pub struct Warper {
    registry: Registry,
    /// The steps with their values as given.
    typed: Recipe,
    /// The steps with the contents of the files that values name.
    resolved: Recipe,
    given: Given,
    /// `true` for an inverse, which does not know the source's frame.
    inverted: bool,
    /// Ends the work when it becomes `true`.
    stop: Option<&'static AtomicBool>,
}

impl fmt::Debug for Warper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Warper").field("recipe", &self.typed).finish_non_exhaustive()
    }
}

/// The image of a path.
#[derive(Debug, Clone, PartialEq)]
#[must_use]
pub struct Path {
    /// The path and its statistics.
    pub path: WarpedPath,
    /// Number of orientation changes along the path, at least 1 if it folds; else 0.
    pub folds: usize,
    /// Warnings of the deformations.
    pub warnings: Vec<String>,
    /// The tolerance of the fit.
    pub tolerance: f64,
}

/// A warped drawing or picture.
#[derive(Debug, Clone, PartialEq, Eq)]
#[must_use]
pub struct Drawing {
    /// The file.
    pub bytes: Vec<u8>,
    /// The changes of every shape: the entry of this input in the JSON that `--report` writes.
    pub report: String,
    /// The warnings of the report.
    pub warnings: Vec<String>,
    /// The decisions that the option `explain` reports.
    pub notes: Vec<String>,
}

impl Warper {
    /// Creates a warper from a deformation, or a preset such as `arc`, with values as typed by users. Files that the values name are read.
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) for an unknown deformation or parameter, [`Input`](super::ErrorKind::Input) for an unreadable
    /// file.
    pub fn new(registry: &Registry, name: &str, values: &[(impl AsRef<str>, impl AsRef<str>)]) -> Result<Self, Error> {
        let (info, preset) = meaning(registry, name).map_err(Error::usage)?;
        let mut args = Args::new();
        if let Some((param, value)) = preset {
            args.push(param, value);
            if values.iter().any(|(given, _)| given.as_ref() == param) {
                return Err(Error::usage(format!("{param}: `{name}` is one already")));
            }
        }
        let warper = Self::from_step(registry, name, info, args, values)?;
        warper.check_names()?;
        Ok(warper)
    }

    /// Checks the names of presets by building the deformation, which knows all their spellings.
    fn check_names(&self) -> Result<(), Error> {
        for step in &self.resolved.steps {
            let Some(entry) = self.registry.get(&step.deformation) else { continue };
            let takes_names = |param: &str| {
                entry.info().params.iter().any(|p| p.name == param && matches!(p.kind, Kind::NameOrFile(_)))
            };
            if step.args.iter().any(|(param, _)| takes_names(param))
                && let Err(error) = entry.build_from(&step.args, &check::frame())
                && matches!(&error, pathwarp::Error::Usage { param, .. } if takes_names(param))
            {
                return guarded(&self.registry, || Err(error.into()));
            }
        }
        Ok(())
    }

    /// Creates a warper from a function of the host program, which maps batches of points.
    #[must_use]
    pub fn from_function(registry: &Registry, callee: Arc<dyn Callee>, abilities: Abilities) -> Self {
        let function = Function::new(callee, abilities);
        let recipe = Recipe { steps: vec![Step::new(function.info().name, Args::new())] };
        let (typed, given) = (recipe.clone(), Given::default());
        let registry = registry.clone().with(function);
        Self { registry, typed, resolved: recipe, given, inverted: false, stop: None }
    }

    /// Creates a warper from an edit of shapes, `simplify`, `offset`, `unite`, `contour` or `outline`, with values as typed by users.
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) for an unknown edit or parameter.
    pub fn edit(registry: &Registry, name: &str, values: &[(impl AsRef<str>, impl AsRef<str>)]) -> Result<Self, Error> {
        let missing = || Error::usage(advice::unknown("edit", name, EDITS.iter().map(|e| e.name)));
        Self::from_step(registry, name, edits::info(name).ok_or_else(missing)?, Args::new(), values)
    }

    /// Creates a warper from the text of a recipe file. Paths in it refer to `folder`; absolute ones are allowed only if `external`.
    ///
    /// # Errors
    /// [`Input`](super::ErrorKind::Input) if the text is not a recipe, or a file cannot be read.
    pub fn from_recipe(registry: &Registry, text: &str, folder: &FilePath, external: bool) -> Result<Self, Error> {
        let saved = guarded(registry, || {
            let parsed = recipe_file::from_text(registry, text, folder, external);
            parsed.map_err(|e| Failure::Input(format!("the recipe: {e}")))
        })?;
        Self::from_typed(registry, saved.recipe, saved.options)
    }

    /// Creates a warper from a deformation or edit that the caller calls `name`, with `args` and the values typed.
    fn from_step(
        registry: &Registry,
        name: &str,
        info: &Info,
        mut args: Args,
        values: &[(impl AsRef<str>, impl AsRef<str>)],
    ) -> Result<Self, Error> {
        for (param, value) in values {
            let (param, value) = (param.as_ref(), value.as_ref());
            let Some(declared) = info.params.iter().find(|p| p.name == param) else {
                return Err(
                    Error::usage(format!("{name}: {}", unknown(info.params, param))).with_parameter(param, value)
                );
            };
            if declared.kind == Kind::Save {
                return Err(Error::usage(format!("{param} writes a file, which only the program does")));
            }
            if !(declared.kind == Kind::Flag && value == "false") {
                args.push(param, as_known_name(declared, value));
            }
        }
        // Values are checked as far as possible without the artwork.
        guarded(registry, || Ok(Settings::new(info.params, &args, &check::frame())?.check_values()?))?;
        Self::from_typed(registry, Recipe { steps: vec![Step::new(info.name, args)] }, Given::default())
    }

    /// Creates a warper from steps and options with their values as typed.
    fn from_typed(registry: &Registry, typed: Recipe, given: Given) -> Result<Self, Error> {
        let mut resolved = typed.clone();
        guarded(registry, || references::resolve_files(registry, &mut resolved, &Reading::default()))?;
        Ok(Self { registry: registry.clone(), typed, resolved, given, inverted: false, stop: None })
    }

    /// Sets an option of the command line, without its dashes; a switch has the value `true`. An option that repeats gets one more value.
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) if the option is unknown or only for the program, or if the value is wrong.
    pub fn set_option(&mut self, name: &str, value: &str) -> Result<(), Error> {
        let about = |e: Error| e.with_parameter(name, value);
        check_option(name).map_err(|e| about(Error::usage(e)))?;
        let mut given = self.given.clone();
        given.set(name, value).map_err(|e| about(Error::usage(e)))?;
        guarded(&self.registry, || given.read()).map_err(about)?;
        self.given = given;
        Ok(())
    }

    /// Returns the chain of this recipe and a later one. Later options take precedence; if both recipes select, each keeps its selection.
    #[must_use]
    pub fn then(&self, later: &Self) -> Self {
        let chain = |a: &Recipe, b: &Recipe| {
            let mut steps = [&a.steps[..], &b.steps[..]].concat();
            let (first, second) = steps.split_at_mut(a.steps.len());
            let (mut given_first, mut given_second) = (self.given.clone(), later.given.clone());
            steps::assign([(first, &mut given_first), (second, &mut given_second)]);
            (Recipe { steps }, given_first.overridden_by(&given_second))
        };
        let (typed, given) = chain(&self.typed, &later.typed);
        let (resolved, _) = chain(&self.resolved, &later.resolved);
        let registry = self.registry.joined(&later.registry);
        Self { registry, typed, resolved, given, inverted: self.inverted || later.inverted, ..self.clone() }
    }

    /// Returns the recipe that undoes this one. It needs the option `frame`, the box of the source, before it is used.
    #[must_use]
    pub fn inverted(&self) -> Self {
        Self { typed: self.typed.inverted(), resolved: self.resolved.inverted(), inverted: true, ..self.clone() }
    }

    /// Adds a switch: once it is `true`, work stops with an error of the kind [`Limit`](super::ErrorKind::Limit).
    #[must_use]
    pub fn stopped_by(&self, switch: &'static AtomicBool) -> Self {
        Self { stop: Some(switch), ..self.clone() }
    }

    /// Returns the names of the deformations.
    pub fn steps(&self) -> impl Iterator<Item = &str> {
        self.typed.steps.iter().map(|s| s.deformation.as_str())
    }

    /// Returns the steps with their values as typed.
    pub fn typed_steps(&self) -> impl Iterator<Item = &Step> {
        self.typed.steps.iter()
    }

    /// Returns the value of the option `frame`, if it is given.
    #[must_use]
    pub fn frame(&self) -> Option<String> {
        self.given.stored().find(|(name, _)| *name == "frame").and_then(|(_, mut values)| values.pop())
    }

    /// Returns the text of a recipe file for `folder`.
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) if a step is a function of this program, [`Input`](super::ErrorKind::Input) if the current folder
    /// cannot be read.
    pub fn to_recipe(&self, folder: &FilePath) -> Result<String, Error> {
        if self.steps().any(is_function) {
            return Err(Error::usage("a recipe file cannot hold a function of this program; write it as a plug-in"));
        }
        guarded(&self.registry, || recipe_file::write(&self.registry, &self.typed, &self.given, folder))
    }

    /// Builds the recipe for points. `bounds` returns their box, to which percentages refer unless the option `frame` is given. `artwork`
    /// returns what later steps of a chain, and inverses, examine in it: without a drawing, [`hatching`](crate::input::hatching).
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) for a wrong value, [`Geometry`](super::ErrorKind::Geometry) if no map results.
    pub fn point_map(
        &self,
        bounds: impl FnOnce() -> Option<Rect>,
        artwork: impl FnOnce(Rect) -> Outline,
    ) -> Result<PointMap, Error> {
        guarded(&self.registry, || {
            let options = self.options()?;
            let bounds = match options.frame {
                // Without points, nothing depends on the box.
                FrameChoice::Default | FrameChoice::Artwork => bounds().unwrap_or(Rect::new(0.0, 0.0, 1.0, 1.0)),
                _ => Rect::ZERO,
            };
            let frame = plain_frame(&options, || Some(bounds))?;
            let needs_no_artwork = self.typed.steps.len() == 1 && !self.typed.steps[0].inverse;
            let outline = if needs_no_artwork { Outline::default() } else { artwork(frame.rect) };
            let built_in =
                |frame: &Frame| self.build(&options, frame, &outline, &Arc::new(Budget::new(options.reading.limits)));
            let built = built_in(&frame).map_err(|failure| {
                // If the recipe builds in a larger box, the size is what is missing.
                let larger = Frame::new(bounds.inflate(1.0, 1.0));
                let is_typed = matches!(options.frame, FrameChoice::Rect(_));
                if frame.rect.is_zero_area() && !is_typed && built_in(&larger).is_ok() {
                    Failure::usage(format!("the box of the points has no size, {NEEDS_FRAME}"))
                } else {
                    failure
                }
            })?;
            // The budget does not limit the number of points.
            Ok(PointMap::new(built, &self.registry))
        })
    }

    /// Checks the map over the option `frame`, or else over the box 0,0,100,100, by [`pathwarp::check::map`].
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) for a wrong value, [`Geometry`](super::ErrorKind::Geometry) if no map results, and
    /// [`Input`](super::ErrorKind::Input) if a plug-in or function fails.
    pub fn check(&self) -> Result<Vec<Check>, Error> {
        guarded(&self.registry, || {
            let options = self.options()?;
            let frame = plain_frame(&options, || Some(check::frame().rect))?;
            let budget = Arc::new(Budget::new(options.reading.limits));
            let whole = self.build(&options, &frame, &hatching(frame.rect), &budget)?;
            let mut checks = Vec::new();
            check::map(&whole.as_one(), frame.rect, |check| checks.push(check));
            check_maps(&whole).map(|()| checks)
        })
    }

    /// Bends a path, given as SVG path data.
    ///
    /// # Errors
    /// [`Input`](super::ErrorKind::Input) for malformed data, [`Usage`](super::ErrorKind::Usage) for a wrong value,
    /// [`Geometry`](super::ErrorKind::Geometry) if the map does not suit the path.
    pub fn warp_path(&self, data: &str) -> Result<Path, Error> {
        let outline = guarded(&self.registry, || Ok(Outline::from_svg(data).map_err(pathwarp::Error::from)?))?;
        self.warp_outline(&outline)
    }

    /// Bends an outline.
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) for a wrong value, [`Geometry`](super::ErrorKind::Geometry) if the map does not suit the path.
    pub fn warp_outline(&self, outline: &Outline) -> Result<Path, Error> {
        self.bend(outline, 1.0)
    }

    /// Bends an outline to lines and quadratics, as in TrueType. Half of the tolerance is for fitting cubics, half for replacing them.
    ///
    /// # Errors
    /// [`Usage`](super::ErrorKind::Usage) for a wrong value, [`Geometry`](super::ErrorKind::Geometry) if the map does not suit the path.
    pub fn warp_outline_to_quadratics(&self, outline: &Outline) -> Result<Path, Error> {
        let mut bent = self.bend(outline, 0.5)?;
        let is_cubic = |el: &PathEl| matches!(el, PathEl::CurveTo(..));
        if bent.path.path.elements().iter().any(is_cubic) {
            // Nodes at extremes of the cubics stay points of the curve.
            let are_placed = self.options().is_ok_and(|o| o.nodes.are_placed());
            let nodes = if are_placed { fit::Nodes::Auto } else { fit::Nodes::Fewest };
            // The joints of the cubics are either smooth or corners: there is no noise to smooth.
            let options = fit::Options::new(bent.tolerance).with_degree(Degree::Quadratic).with_nodes(nodes);
            let options = options.with_corner(fit::parts::SMOOTH_JOINT);
            let fitted = fit::simplify(&bent.path.path, &options).map_err(|e| Error::usage(e.to_string()))?;
            bent.path.path = fitted.path;
            bent.path.data = bent.path.path.to_svg();
            let report = &mut bent.path.report;
            report.max_error += fitted.report.max_error;
            report.segments_out = bent.path.path.segments().count();
            report.assurance = report.assurance.min(Assurance::Checked);
        }
        Ok(bent)
    }

    /// Bends an outline, using a share of the tolerance.
    fn bend(&self, outline: &Outline, share_of_tolerance: f64) -> Result<Path, Error> {
        guarded(&self.registry, || {
            if let Some(other) = self.given.names().find(|name| !PATH_OPTIONS.contains(name)) {
                let known = PATH_OPTIONS.join(", ");
                return Err(Failure::usage(format!("{other} is not an option of a single path, which has {known}")));
            }
            let options = self.options()?;
            let bounds = outline.bounding_box();
            let frame = plain_frame(&options, || bounds)?;
            let tolerance = share_of_tolerance * options.tolerance_for(bounds, &frame)?;
            let budget = Arc::new(Budget::new(options.reading.limits));
            let (edits, steps) = edits::divided(&self.resolved)?;
            if edits.len() + usize::from(!steps.steps.is_empty()) > 1 {
                return Err(Failure::usage("a path is edited or bent; do one after the other"));
            }
            let is_last = steps.steps.is_empty();
            let edit = edits.first().map(|e| planned(e, &options, (bounds, &frame), is_last)).transpose()?;
            let tolerance = edit.as_ref().map_or(tolerance, |planned| share_of_tolerance * planned.tolerance);
            let built = self.build(&options, &frame, outline, &budget)?;
            let refit = refit::Options::new(tolerance).with_certify(options.certify).with_nodes(options.nodes);
            // Small contours get smaller tolerances than the default one.
            let refit = refit.with_suited(edit.as_ref().map_or(options.tolerance.is_none(), |planned| planned.suited));
            let (copies, filled) = (&built.placement.copies, true);
            let repeated = if copies.is_empty() { outline.clone() } else { outline.repeated(copies) };
            let (refit, decimals) = (refit.with_budget(budget), options.precision);
            let path = match edit.map(|planned| planned.edit) {
                None => pathwarp_svg::warp_path(&repeated, &built.map, &refit, decimals),
                Some(Edit::Outline) => return Err(Failure::usage("a path has no stroke that could become an outline")),
                Some(edit) => pathwarp_svg::engine::edit_path(outline, edit, &refit, decimals),
            };
            check_maps(&built)?;
            let path = path.map_err(pathwarp::Error::from)?;
            let survey = Survey::new(&built.map, repeated.bounding_box(), repeated.segs().count());
            let orientation = survey.orientation_of_copies(outline, copies, filled);
            let folds = Fold::of(&orientation, &orientation).count;
            check_maps(&built)?;
            let warnings = built.steps.into_iter().flat_map(|s| s.explanation.warnings).collect();
            Ok(Path { path, folds, warnings, tolerance })
        })
    }

    /// Warps a drawing (SVG, also compressed) or a picture (PNG, JPEG, WebP). `name` is its name in messages; linked pictures are looked up
    /// beside it and embedded in the result. Without a name, there are none. The page stays unless the option `fit` is given.
    ///
    /// # Errors
    /// [`Input`](super::ErrorKind::Input) for an unreadable drawing, [`Usage`](super::ErrorKind::Usage) for a wrong value,
    /// [`Geometry`](super::ErrorKind::Geometry) if the map does not suit the drawing.
    pub fn warp_drawing(&self, bytes: &[u8], name: Option<&FilePath>) -> Result<Drawing, Error> {
        guarded(&self.registry, || {
            self.options()?;
            self.given.check_conflicts().map_err(Failure::Usage)?;
            let path = (name.unwrap_or(FilePath::new("")), Destination::Anywhere);
            let (bytes, warped) = warp_bytes(&self.registry, &self.resolved, &self.given, self.stop, path, bytes)?;
            let report = serde_json::to_string(&warped.report).map_err(|e| Failure::Output(e.to_string()))?;
            Ok(Drawing { bytes, report, warnings: warped.report.warnings, notes: warped.notes })
        })
    }

    /// Returns the parsed options with the switch. An inverse needs a frame.
    fn options(&self) -> Result<CommonOptions, Failure> {
        let mut options = self.given.read()?;
        if self.inverted && matches!(options.frame, FrameChoice::Default) {
            return Err(Failure::usage(format!("an inverse does not know the box of the source, {NEEDS_FRAME}")));
        }
        options.reading.stop(self.stop);
        Ok(options)
    }

    /// Builds the recipe for an outline without a drawing.
    fn build(
        &self,
        options: &CommonOptions,
        frame: &Frame,
        outline: &Outline,
        budget: &Arc<Budget>,
    ) -> Result<BuiltRecipe, Failure> {
        let session = Session { registry: &self.registry, recipe: &self.resolved, options, given: &self.given };
        let (frame, budget, framed) = (frame.clone(), Arc::clone(budget), None);
        let ready = session.ready(&mut PlainArtwork { outlines: vec![outline], frame, budget }, framed)?;
        Ok(ready.built.whole)
    }
}

/// Describes an unknown parameter. The name may be that of an option.
fn unknown(params: &[Param], param: &str) -> String {
    if check_option(param).is_ok() {
        return format!("`{param}` is an option, not a parameter; give it as an option");
    }
    let names: Vec<&str> = params.iter().map(|p| p.name).collect();
    let known = names.iter().copied().chain(option_names().map(|(name, _)| name));
    let unknown = advice::unknown("parameter", param, known);
    if unknown.ends_with('?') { unknown } else { format!("{unknown}; there are {}", names.join(", ")) }
}

/// Returns the frame for artwork that is not a drawing.
fn plain_frame(options: &CommonOptions, bounds: impl FnOnce() -> Option<Rect>) -> Result<Frame, Failure> {
    let rect = match options.frame {
        FrameChoice::Default | FrameChoice::Artwork => bounds().unwrap_or(Rect::ZERO),
        FrameChoice::Rect(typed) => typed.rect([1.0; 2]),
        FrameChoice::ViewBox => {
            return Err(Failure::usage("--frame: there is no drawing that has a viewbox; give X,Y,W,H"));
        }
        FrameChoice::Lettering(_) => {
            return Err(Failure::usage("--frame: there is no drawing that holds lettering; give X,Y,W,H"));
        }
    };
    Ok(Frame::new(rect))
}
