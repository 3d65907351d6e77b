//! [`Warper`]: a recipe with its options, applied in memory.

use super::error::{Error, guarded};
use super::names::{check_option, meaning};
use super::points::PointMap;
use crate::failure::Failure;
use crate::input::{Fold, no_document};
use crate::options::{CommonOptions, FrameChoice, Given, Reading};
use crate::steps;
use crate::steps::in_lower_case;
use crate::{pipeline, recipe_file, references};
use pathwarp::Outline;
use pathwarp::budget::Budget;
use pathwarp::deform::Registry;
use pathwarp::fold::Survey;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Frame, Kind};
use pathwarp::recipe::{BuiltRecipe, Recipe, Step};
use pathwarp::refit;
use pathwarp_svg::WarpedPath;
use std::path::Path as FilePath;
use std::sync::Arc;

/// Options of a warp that a path without a drawing can have.
const PATH_OPTIONS: [&str; 6] = ["frame", "tolerance", "certify", "merge", "precision", "limit"];

/// Deformations one after another, with the options of a warp.
#[derive(Clone)]
pub struct Warper {
    registry: Registry,
    /// The values as given.
    typed: Recipe,
    /// The same with the contents of files.
    resolved: Recipe,
    given: Given,
}

/// The image of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The path and its statistics.
    pub path: WarpedPath,
    /// Number of orientation changes along the path if it folds, at least 1; else 0.
    pub folds: usize,
    /// Warnings of the deformations.
    pub warnings: Vec<String>,
}

/// A warped drawing or picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawing {
    /// The file.
    pub bytes: Vec<u8>,
    /// What was done, shape by shape: the entry of this input in the JSON that `--report` writes.
    pub report: String,
    /// The warnings of the report.
    pub warnings: Vec<String>,
    /// The decisions that the option `explain` asks for.
    pub notes: Vec<String>,
}

impl Warper {
    /// One deformation, or a preset such as `arc`, with values as a user would type them. Files that the values name are read.
    ///
    /// # Errors
    /// There is no such deformation or parameter, or a file cannot be read.
    pub fn new(registry: &Registry, name: &str, values: &[(impl AsRef<str>, impl AsRef<str>)]) -> Result<Self, Error> {
        let (info, preset) = meaning(registry, name).map_err(Error::usage)?;
        let mut args = Args::new();
        if let Some((param, value)) = preset {
            args.push(param, value);
        }
        for (param, value) in values {
            let (param, value) = (param.as_ref(), value.as_ref());
            let known = || info.params.iter().map(|p| p.name);
            let Some(declared) = info.params.iter().find(|p| p.name == param) else {
                let names: Vec<&str> = known().collect();
                let unknown = crate::advice::unknown("parameter", param, known());
                return Err(Error::usage(format!("{}: {unknown}; there are {}", info.name, names.join(", "))));
            };
            if declared.kind == Kind::Save {
                return Err(Error::usage(format!("{param} writes a file, which only the program does")));
            }
            if preset.is_some_and(|(p, _)| p == param) {
                return Err(Error::usage(format!("{param}: `{name}` is one already")));
            }
            if !(declared.kind == Kind::Flag && value == "false") {
                args.push(param, in_lower_case(declared, value));
            }
        }
        Self::of(registry, Recipe { steps: vec![Step::new(info.name, args)] }, Given::default())
    }

    /// The recipe in the text of a recipe file. Paths in it refer to `folder`; absolute ones are allowed only if `external`.
    ///
    /// # Errors
    /// The text is not a recipe, or a file cannot be read.
    pub fn from_recipe(registry: &Registry, text: &str, folder: &FilePath, external: bool) -> Result<Self, Error> {
        let saved = guarded(registry, || {
            let parsed = recipe_file::from_text(registry, text, folder, external);
            parsed.map_err(|e| Failure::Input(format!("the recipe: {e}")))
        })?;
        Self::of(registry, saved.recipe, saved.options)
    }

    fn of(registry: &Registry, typed: Recipe, given: Given) -> Result<Self, Error> {
        let mut resolved = typed.clone();
        guarded(registry, || references::resolve_files(registry, &mut resolved, &Reading::default()))?;
        Ok(Self { registry: registry.clone(), typed, resolved, given })
    }

    /// Sets an option of the command line, without its dashes; a switch has the value `true`. An option that may be given several
    /// times gets one more value.
    ///
    /// # Errors
    /// There is no such option, it is one of the program, or the value is wrong.
    pub fn set_option(&mut self, name: &str, value: &str) -> Result<(), Error> {
        check_option(name).map_err(Error::usage)?;
        let mut given = self.given.clone();
        given.set(name, value).map_err(Error::usage)?;
        guarded(&self.registry, || given.read())?;
        self.given = given;
        Ok(())
    }

    /// This recipe and then another. Options of both are kept; the later one's win. If both select, each holds for its own.
    #[must_use]
    pub fn then(&self, later: &Self) -> Self {
        let joined = |a: &Recipe, b: &Recipe| {
            let mut steps = [&a.steps[..], &b.steps[..]].concat();
            let (first, second) = steps.split_at_mut(a.steps.len());
            let (mut of_first, mut of_second) = (self.given.clone(), later.given.clone());
            steps::assign([(first, &mut of_first), (second, &mut of_second)]);
            (Recipe { steps }, of_first.overridden_by(&of_second))
        };
        let (typed, given) = joined(&self.typed, &later.typed);
        let (resolved, _) = joined(&self.resolved, &later.resolved);
        Self { registry: self.registry.clone(), typed, resolved, given }
    }

    /// The recipe that undoes this one. Percentages and defaults need the option `frame`, the box of the source.
    #[must_use]
    pub fn inverted(&self) -> Self {
        Self { typed: self.typed.inverted(), resolved: self.resolved.inverted(), ..self.clone() }
    }

    /// The names of the deformations.
    pub fn steps(&self) -> impl Iterator<Item = &str> {
        self.typed.steps.iter().map(|s| s.deformation.as_str())
    }

    /// The value of the option `frame`, if it is given.
    #[must_use]
    pub fn frame(&self) -> Option<String> {
        self.given.stored().find(|(name, _)| *name == "frame").and_then(|(_, mut values)| values.pop())
    }

    /// The text of a recipe file for `folder`.
    ///
    /// # Errors
    /// The current folder cannot be read.
    pub fn to_recipe(&self, folder: &FilePath) -> Result<String, Error> {
        guarded(&self.registry, || recipe_file::write(&self.registry, &self.typed, &self.given, folder))
    }

    /// Builds the recipe for points. `bounds` returns their box, to which percentages refer unless the option `frame` is given.
    /// Later steps of a chain, and inverses, look at the points themselves, which `cloud` returns as one polyline.
    ///
    /// # Errors
    /// A value is wrong, or the geometry does not allow the deformation.
    pub fn point_map(
        &self,
        bounds: impl FnOnce() -> Option<Rect>,
        cloud: impl FnOnce() -> Outline,
    ) -> Result<PointMap, Error> {
        guarded(&self.registry, || {
            let options = self.given.read()?;
            let frame = plain_frame(&options, bounds)?;
            let alone = self.typed.steps.len() == 1 && !self.typed.steps.iter().any(|s| s.inverse);
            let outline = if alone { Outline::default() } else { cloud() };
            let budget = Arc::new(Budget::new(options.reading.limits));
            let built = self.build(&frame, &outline, &budget)?;
            // Points are mapped as often as the program around this likes.
            Ok(PointMap::new(built.unlimited()))
        })
    }

    /// Bends a path: SVG path data.
    ///
    /// # Errors
    /// The data is malformed, a value is wrong, or the geometry does not allow the deformation.
    pub fn warp_path(&self, data: &str) -> Result<Path, Error> {
        let outline = guarded(&self.registry, || Ok(Outline::from_svg(data).map_err(pathwarp::Error::from)?))?;
        self.warp_outline(&outline)
    }

    /// Bends an outline.
    ///
    /// # Errors
    /// As [`Warper::warp_path`].
    pub fn warp_outline(&self, outline: &Outline) -> Result<Path, Error> {
        guarded(&self.registry, || {
            if let Some(other) = self.given.names().find(|name| !PATH_OPTIONS.contains(name)) {
                let known = PATH_OPTIONS.join(", ");
                return Err(Failure::usage(format!("{other} is not an option of a single path, which has {known}")));
            }
            let options = self.given.read()?;
            let bounds = outline.bounding_box();
            let frame = plain_frame(&options, || bounds)?;
            let tolerance = options.tolerance_for(bounds, &frame)?;
            let budget = Arc::new(Budget::new(options.reading.limits));
            let built = self.build(&frame, outline, &budget)?;
            let refit = refit::Options::new(tolerance).with_certify(options.certify).with_merge(options.merge);
            let refit = refit.with_suited(options.tolerance.is_none());
            let copies = &built.placement.copies;
            let repeated = if copies.is_empty() { outline.clone() } else { outline.repeated(copies) };
            let path = pathwarp_svg::warp_path(&repeated, &built.map, &refit.with_budget(budget), options.precision)
                .map_err(pathwarp::Error::from)?;
            let survey = Survey::new(&built.map, repeated.bounding_box(), repeated.segs().count());
            let orientation = survey.orientation_of_copies(outline, copies, true);
            let folds = Fold::of(&orientation, &orientation).count;
            built.failure().map_or(Ok(()), |e| Err(Failure::of_recipe(e)))?;
            let warnings = built.steps.into_iter().flat_map(|s| s.explanation.warnings).collect();
            Ok(Path { path, folds, warnings })
        })
    }

    /// Warps a drawing (SVG, also compressed) or a picture (PNG, JPEG, WebP). `name` is its name in messages; linked pictures are
    /// looked up beside it. Without a name there are none. The page stays unless the option `fit` is given.
    ///
    /// # Errors
    /// The drawing cannot be read, a value is wrong, or the geometry does not allow the deformation.
    pub fn warp_drawing(&self, bytes: &[u8], name: Option<&FilePath>) -> Result<Drawing, Error> {
        guarded(&self.registry, || {
            self.given.check_conflicts().map_err(Failure::Usage)?;
            let name = name.unwrap_or(FilePath::new(""));
            let done = pipeline::warp_bytes(&self.registry, &self.resolved, &self.given, name, bytes)?;
            let report = serde_json::to_string(&done.report).map_err(|e| Failure::Output(e.to_string()))?;
            Ok(Drawing { bytes: done.bytes, report, warnings: done.report.warnings, notes: done.notes })
        })
    }

    /// Builds the recipe without a drawing.
    fn build(&self, frame: &Frame, outline: &Outline, budget: &Arc<Budget>) -> Result<BuiltRecipe, Failure> {
        if self.resolved.steps.iter().any(Step::is_selective) {
            return Err(Failure::usage("select and exclude are for drawings"));
        }
        let mut recipe = self.resolved.clone();
        references::resolve_names(&self.registry, &mut recipe, |name| Err(no_document(name)))?;
        let outlines = std::iter::once(outline);
        let built = recipe.build_within(&self.registry, frame.clone(), &outlines, budget);
        let built = built.map_err(Failure::of_recipe)?;
        built.failure().map_or(Ok(built.clone()), |e| Err(Failure::of_recipe(e)))
    }
}

/// The frame for artwork that is not a drawing.
fn plain_frame(options: &CommonOptions, bounds: impl FnOnce() -> Option<Rect>) -> Result<Frame, Failure> {
    let rect = match options.frame {
        FrameChoice::Default | FrameChoice::Artwork => bounds().unwrap_or(Rect::ZERO),
        FrameChoice::Rect(typed) => typed.rect([1.0; 2]),
        FrameChoice::ViewBox => return Err(Failure::usage("--frame: there is no drawing that has a viewbox")),
        FrameChoice::Lettering(_) => return Err(Failure::usage("--frame: there is no drawing that holds lettering")),
    };
    Ok(Frame::new(rect))
}
