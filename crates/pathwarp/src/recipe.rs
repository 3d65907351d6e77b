//! Recipes: deformations one after another, composed before anything is refitted.
//!
//! A [`Step`] names a deformation of a [`Registry`] and holds its arguments as text; a [`Recipe`] builds all of them into one
//! [`Chain`]:
//!
//! ```
//! use pathwarp::deform::Registry;
//! use pathwarp::kurbo::Rect;
//! use pathwarp::param::{Args, Frame};
//! use pathwarp::recipe::{Recipe, Step};
//! use pathwarp::{Outline, refit};
//!
//! let square = Outline::from_svg("M0,0 H100 V100 H0 Z")?;
//! let flag = Step::new("warp", Args::from_pairs(&[("style", "flag"), ("bend", "40%")]));
//! let turn = Step::new("affine", Args::from_pairs(&[("rotate", "10")]));
//!
//! let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
//! let recipe = Recipe { steps: vec![flag, turn] };
//! let built = recipe.build(&Registry::builtin(), frame, &std::iter::once(&square))?;
//! let warped = refit::warp_path(&square, &built.map, &refit::Options::new(0.01))?;
//! assert!(warped.report.max_error <= 0.01);
//! # Ok::<(), pathwarp::Error>(())
//! ```

use crate::budget::{Budget, Limits};
use crate::deform::{Built, Deformation, Overlay, Placement, Registry, Role, Seam};
use crate::error::{Error, GeometryError, show};
use crate::map::{Chain, Class, Creases, Map, inverse_of};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Args, Frame, Kind, Param};
use kurbo::{Affine, Point, Rect, Vec2};
use std::collections::HashSet;
use std::sync::Arc;

/// A deformation with its arguments.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The deformation's name.
    pub deformation: String,
    /// Its arguments, with path references resolved.
    pub args: Args,
    /// `true` to apply the inverse map.
    pub inverse: bool,
    /// Selectors of the artwork to which the step applies, in the syntax of whatever reads the artwork. Empty for all artwork.
    pub select: Vec<String>,
    /// Selectors of the artwork that the step leaves out.
    pub exclude: Vec<String>,
}

impl Step {
    /// Creates a step that is not inverted and applies to all artwork.
    #[must_use]
    pub fn new(deformation: impl Into<String>, args: Args) -> Self {
        Self { deformation: deformation.into(), args, inverse: false, select: Vec::new(), exclude: Vec::new() }
    }

    /// Returns `true` if the step has selectors.
    #[must_use]
    pub fn is_selective(&self) -> bool {
        !self.select.is_empty() || !self.exclude.is_empty()
    }

    /// The given values with their names, as on a command line: a flag that is set has no value, a flag that is not set is left out.
    /// `params` are the deformation's parameters.
    pub fn options<'a>(&'a self, params: &'a [Param]) -> impl Iterator<Item = (&'a str, Option<&'a str>)> {
        self.args.iter().flat_map(move |(name, values)| {
            let is_flag = params.iter().any(|p| p.name == name && p.kind == Kind::Flag);
            let values = values.iter().filter(move |v| !is_flag || *v == "true");
            values.map(move |v| (name, (!is_flag).then_some(v.as_str())))
        })
    }
}

/// Steps in order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recipe {
    /// The steps; the first is applied first.
    pub steps: Vec<Step>,
}

/// A recipe with every parameter settled.
#[derive(Debug, Clone)]
pub struct BuiltRecipe {
    /// All steps composed.
    pub map: Chain,
    /// The steps one by one.
    pub steps: Vec<Built>,
    /// The first step's placement of copies of the artwork, or of its letters one by one.
    pub placement: Placement,
    /// The steps after the first, composed: the map for letters that were placed; for letters that it moved
    /// [before](Placement::before) the map, all steps.
    pub after: Chain,
    /// For every step, the frame that its percentages refer to.
    pub frames: Vec<Frame>,
    /// For every step, its index in the recipe.
    pub indices: Vec<usize>,
    /// The budget that searches of inverses are charged to.
    budget: Arc<Budget>,
}

/// A part of the artwork to which the same steps apply.
#[derive(Debug, Clone, PartialEq)]
#[doc(hidden)]
pub struct Portion<'a> {
    /// The indices of the steps that apply to the portion, in order.
    pub steps: Vec<usize>,
    /// The outlines of the portion.
    pub outlines: Vec<&'a Outline>,
}

/// A recipe whose steps apply to parts of the artwork, with every parameter settled.
#[derive(Debug, Clone)]
#[doc(hidden)]
pub struct BuiltParts {
    /// All steps in order, for artwork to which all of them apply.
    pub whole: BuiltRecipe,
    /// For every portion, the steps that apply to it.
    pub parts: Vec<BuiltRecipe>,
}

impl Recipe {
    /// Builds every step within a budget, which is charged for the segments of the paths that control the steps, and for the evaluations
    /// that locate the artwork after each step. Inverses charge to it the work of each search beyond
    /// [`Cost::work`](crate::map::Cost::work), for as long as they are used: once the budget is used up they are undefined everywhere, and
    /// [`BuiltRecipe::failure`] reports it. See [`Recipe::build`].
    ///
    /// # Errors
    /// The errors of [`Recipe::build`], and [`GeometryError::Limit`] if the budget is exceeded.
    pub fn build_within<'a>(
        &self,
        registry: &Registry,
        frame: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
        budget: &Arc<Budget>,
    ) -> Result<BuiltRecipe, Error> {
        // Only the frame of the source is known.
        let mut frames = vec![None; self.steps.len()];
        if let Some(known) = if self.is_inverse() { frames.last_mut() } else { frames.first_mut() } {
            *known = Some(frame);
        }
        let all = Portion { steps: (0..self.steps.len()).collect(), outlines: artwork.clone().collect() };
        self.build_parts(registry, &frames, &[all], budget).map(|b| b.whole)
    }

    /// Builds steps that apply to parts of the artwork, within a budget; see [`Recipe::build_within`]. `start` has the frame of every step
    /// that [starts](Self::starts); the percentages of the others refer to the bounding box of all artwork to which the step applies, after
    /// the earlier steps that apply to each part of it.
    ///
    /// # Errors
    /// The errors of [`Recipe::build_within`].
    pub fn build_parts(
        &self,
        registry: &Registry,
        start: &[Option<Frame>],
        portions: &[Portion<'_>],
        budget: &Arc<Budget>,
    ) -> Result<BuiltParts, Error> {
        let path_segments: usize = self.steps.iter().map(|s| s.args.path_segments()).sum();
        budget.spend(PATH_SEGMENT_WORK * path_segments as f64).map_err(GeometryError::Limit)?;
        if !self.is_inverse() {
            return self.build_in(registry, start, portions, budget);
        }
        let (frames, change) = self.frames_of_inverse_steps(registry, start, portions, budget)?;
        let mut out = self.build_in(registry, &frames, portions, budget)?;
        if let Some(step) = out.whole.steps.last_mut().filter(|_| change > SETTLED) {
            step.warn(format!(
                "the boxes that percentages of later steps refer to could not be restored, and are off by {change:.1e} of their size: the result \
                 differs from the source; give those steps lengths instead"
            ));
        }
        Ok(out)
    }

    /// Returns `true` if no part of the artwork to which step `i` applies has been moved by an earlier step; for a recipe of inverse steps
    /// alone, if none is moved by a later one. The frame of the step is then the source's.
    #[must_use]
    pub fn starts(&self, i: usize, portions: &[Portion<'_>]) -> bool {
        let at_source = |p: &Portion<'_>| if self.is_inverse() { p.steps.last() } else { p.steps.first() }.copied();
        portions.iter().filter(|p| p.steps.contains(&i)).all(|p| at_source(p) == Some(i))
    }

    /// Returns `true` if the recipe has several steps and all are inverse.
    fn is_inverse(&self) -> bool {
        self.steps.len() > 1 && self.steps.iter().all(|s| s.inverse)
    }

    /// Builds every step. Percentages refer to `frame` in the first step, and in later ones to the bounding box of `artwork`
    /// after the earlier steps.
    ///
    /// A recipe of inverse steps alone undoes its reverse ([`Recipe::inverted`]): `artwork` is a result, `frame` that of its source, and
    /// the frames of the other steps are the boxes of the artwork on its way back. The boxes depend on the inverses and the inverses on the
    /// boxes, so both are found by iteration; pathwarp warns if it does not converge.
    ///
    /// # Errors
    /// [`Error::Input`] for an unknown deformation or a step that only the first can be, and any [`Error`] from building a step.
    pub fn build<'a>(
        &self,
        registry: &Registry,
        frame: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
    ) -> Result<BuiltRecipe, Error> {
        self.build_within(registry, frame, artwork, &Arc::new(Budget::new(Limits::none())))
    }

    /// The frames of inverse steps, in their order, for artwork that is a result; and the largest change of a frame in the last iteration,
    /// as a fraction of its size. `start` has the frames of the source. The iteration begins with the frames of the inverted recipe for
    /// artwork that fills the source's box.
    fn frames_of_inverse_steps(
        &self,
        registry: &Registry,
        start: &[Option<Frame>],
        portions: &[Portion<'_>],
        budget: &Arc<Budget>,
    ) -> Result<(Vec<Option<Frame>>, f64), Error> {
        // Portions whose last step has no known frame take that of others.
        let any_frame = || start.iter().flatten().next();
        let source_box = |p: &Portion<'_>| {
            let source = p.steps.last().and_then(|&i| start[i].as_ref()).or_else(any_frame);
            let Rect { x0, y0, x1, y1 } = source.map_or(Rect::ZERO, |f| f.rect);
            Outline::from_points(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(Point::from), true)
        };
        let boxes: Vec<Outline> = portions.iter().map(source_box).collect();
        let forward: Vec<Portion<'_>> = std::iter::zip(portions, &boxes)
            .map(|(p, outline)| Portion {
                steps: p.steps.iter().rev().map(|&i| self.steps.len() - 1 - i).collect(),
                outlines: vec![outline],
            })
            .collect();
        let sources: Vec<Option<Frame>> = start.iter().rev().cloned().collect();
        let forward = self.inverted().build_in(registry, &sources, &forward, budget)?.whole;
        let mut frames: Vec<Frame> = forward.frames.into_iter().rev().collect();
        let mut change = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            let mut back: Vec<BuiltRecipe> = portions.iter().map(|_| BuiltRecipe::new(frames.len(), budget)).collect();
            change = 0.0;
            for (i, step) in self.steps.iter().enumerate() {
                let members: Vec<usize> = members(portions, i).collect();
                // The frames of the source are known, and no step comes after them.
                if start[i].is_some() || members.is_empty() {
                    continue;
                }
                let built = entry(registry, i, step)?.build_from(&step.args, &frames[i])?;
                let map = inverse(&built, &frames[i], budget);
                for &m in &members {
                    back[m].map.push(Arc::clone(&map));
                    back[m].charge_samples(&portions[m])?;
                }
                let images = members.iter().filter_map(|&m| back[m].image_box(portions[m].outlines.iter().copied()));
                let Some(new) = images.reduce(|a, b| a.union(b)) else { continue };
                let old = frames[i].rect;
                let distance = (new.origin() - old.origin()).hypot().max((new.size() - old.size()).to_vec2().hypot());
                change = f64::max(change, distance / old.size().to_vec2().hypot());
                frames[i] = Frame::new(new).with_units_per_px(frames[i].units_per_px);
            }
            if change <= SETTLED {
                break;
            }
        }
        Ok((frames.into_iter().map(Some).collect(), change))
    }

    /// Builds every step in its frame from `start`, or else in the frame of the artwork after the earlier steps.
    fn build_in(
        &self,
        registry: &Registry,
        start: &[Option<Frame>],
        portions: &[Portion<'_>],
        budget: &Arc<Budget>,
    ) -> Result<BuiltParts, Error> {
        let new = || BuiltRecipe::new(self.steps.len(), budget);
        let mut out = BuiltParts { whole: new(), parts: portions.iter().map(|_| new()).collect() };
        let mut frame = Frame::new(Rect::ZERO);
        for (i, step) in self.steps.iter().enumerate() {
            let entry = entry(registry, i, step)?;
            let members: Vec<usize> = members(portions, i).collect();
            let all = || members.iter().map(|&m| (&out.parts[m], &portions[m]));
            if let Some(given) = &start[i] {
                frame = given.clone();
            } else {
                all().try_for_each(|(part, portion)| part.charge_samples(portion))?;
                let units_per_px = frame.units_per_px;
                let images = all().filter_map(|(part, portion)| part.image_box(portion.outlines.iter().copied()));
                let image = images.reduce(|a, b| a.union(b));
                frame = image.map_or(frame, |b| Frame::new(b).with_units_per_px(units_per_px));
            }
            if entry.info().letters || entry.info().baseline.is_some() {
                let points = all().flat_map(|(part, portion)| ink(portion.outlines.iter().copied(), &part.map));
                frame.ink = points.collect();
            }
            let mut built = entry.build_from(&step.args, &frame)?;
            let is_first = all().all(|(part, _)| part.steps.is_empty());
            check_placement(&built.placement, i, is_first, step)?;
            if step.inverse {
                all().try_for_each(|(part, portion)| part.charge_samples(portion))?;
                if let Some(warning) = all().find_map(|(part, portion)| part.torn_seam(portion, &built, step)) {
                    built.warn(warning);
                }
                built = undone(built, &frame, &step.deformation, budget)?;
            }
            members.iter().for_each(|&m| out.parts[m].push(i, built.clone(), &frame));
            out.whole.push(i, built, &frame);
        }
        Ok(out)
    }

    /// Returns the recipe that undoes this one: the steps' inverses, the last first.
    #[must_use]
    pub fn inverted(&self) -> Self {
        let undoing = |s: &Step| Step { inverse: !s.inverse, ..s.clone() };
        Self { steps: self.steps.iter().rev().map(undoing).collect() }
    }
}

/// The entry of step `i`.
fn entry<'a>(registry: &'a Registry, i: usize, step: &Step) -> Result<&'a Arc<dyn Deformation>, Error> {
    registry.get(&step.deformation).ok_or_else(|| {
        let known: Vec<_> = registry.entries().iter().map(|e| e.info().name).collect();
        let problem = format!("there is no deformation `{}`; known are {}", step.deformation, known.join(", "));
        Error::input(format!("step {}", i + 1), problem)
    })
}

/// The indices of the portions to which step `i` applies.
fn members<'p>(portions: &'p [Portion<'_>], i: usize) -> impl Iterator<Item = usize> + use<'p> {
    portions.iter().enumerate().filter(move |(_, p)| p.steps.contains(&i)).map(|(m, _)| m)
}

/// Refuses copies and placed letters in all steps but a first one that is not inverted.
fn check_placement(placement: &Placement, i: usize, is_first: bool, step: &Step) -> Result<(), Error> {
    let effect = match placement {
        p if !p.copies.is_empty() => "repeats the artwork",
        p if p.before => "sets lines of letters one by one",
        p if !p.letters.is_empty() => "places letters",
        _ => return Ok(()),
    };
    let problem = match (is_first, step.inverse) {
        (true, false) => return Ok(()),
        (_, true) if placement.before => "has no inverse; `lines` as `together`, one map for all of them, has one",
        (_, true) => "has no inverse",
        _ => "only the first step can do; put it first, or in a separate run",
    };
    Err(Error::input(format!("step {}, {}", i + 1, step.deformation), format!("{effect}, which {problem}")))
}

impl BuiltRecipe {
    /// Returns the outlines, in the source and by the even-odd rule, of what lies behind other parts of the artwork in a step's image,
    /// within `tolerance` there. `None` if no step hides anything, and after steps that do more than an affine map.
    #[must_use]
    pub fn hidden(&self, tolerance: f64) -> Option<Outline> {
        let step = self.steps.iter().position(|s| s.hidden.is_some())?;
        if self.placement != Placement::default() {
            return None;
        }
        let before = self.steps[..step].iter().try_fold(Affine::IDENTITY, |before, s| match s.map.class() {
            Class::Affine(m) => Some(m * before),
            _ => None,
        })?;
        Some(self.steps[step].hidden.as_ref()?(tolerance).transformed(before.inverse()))
    }

    fn new(steps: usize, budget: &Arc<Budget>) -> Self {
        Self {
            map: Chain::default(),
            steps: Vec::with_capacity(steps),
            placement: Placement::default(),
            after: Chain::default(),
            frames: Vec::with_capacity(steps),
            indices: Vec::with_capacity(steps),
            budget: Arc::clone(budget),
        }
    }

    /// Charges the budget for samples of the portion's image under the steps so far.
    fn charge_samples(&self, portion: &Portion<'_>) -> Result<(), GeometryError> {
        let samples = portion.outlines.iter().flat_map(|o| o.segs()).count() * (PER_SEGMENT + 1);
        let copies = self.placement.copies.len().max(1) as f64;
        let work = SAMPLE_WORK * copies * samples as f64 * self.map.cost().work;
        self.budget.spend(work).map_err(GeometryError::Limit)
    }

    /// Adds step `i` of the recipe.
    fn push(&mut self, i: usize, step: Built, frame: &Frame) {
        if self.steps.is_empty() {
            self.placement.clone_from(&step.placement);
        }
        if !self.steps.is_empty() || step.placement.before {
            self.after.push(Arc::clone(&step.map));
        }
        self.map.push(Arc::clone(&step.map));
        self.steps.push(step);
        self.frames.push(frame.clone());
        self.indices.push(i);
    }

    /// Returns the failure of a step's map, if one has failed, or the limit that searches for an inverse have exceeded. Results computed
    /// so far must not be used then.
    #[must_use]
    pub fn failure(&self) -> Option<Error> {
        let failed = self.steps.iter().find_map(|s| s.failure.as_ref().and_then(|failed| failed()));
        failed.or_else(|| self.budget.exceeded().map(|e| GeometryError::Limit(e).into()))
    }

    /// Returns the map without a limit on the searches of inverses, for long-lived maps.
    #[must_use]
    pub fn unlimited(&self) -> Chain {
        self.map.spending(&Arc::new(Budget::new(Limits::none())))
    }

    /// Returns the steps as one deformation, without copies and letters.
    #[must_use]
    pub fn as_one(&self) -> Built {
        let map = self.unlimited();
        let (values, state) = (map.clone(), self.clone());
        let mut built = Built::new(Arc::new(map));
        if self.steps.iter().any(|s| s.undefined.is_some()) {
            // The steps know reasons for points of their own planes only, so the reason stays empty.
            built.undefined = Some(Arc::new(move |p| (!values.point(p).is_finite()).then(String::new)));
        }
        built.failure = Some(Arc::new(move || state.failure()));
        built
    }

    /// Returns the bounding box of the artwork's image under the steps so far, to which percentages of a further step would refer.
    /// `None` if nothing of the artwork is in the map's domain.
    #[must_use]
    pub fn image_box<'a>(&self, artwork: impl Iterator<Item = &'a Outline>) -> Option<Rect> {
        let Some(first) = self.frames.first().filter(|_| !self.placement.letters.is_empty()) else {
            return image_box(artwork, &self.placement.copies, &self.map);
        };
        // The frame has the letters of all artwork to which the first step applies: those of this artwork are found by where they start.
        let key = |s: &Subpath| [s.start.x.to_bits(), s.start.y.to_bits()];
        let keys: HashSet<[u64; 2]> = artwork.flat_map(|o| &o.subpaths).map(key).collect();
        let letters = first.letters.iter().zip(&self.placement.letters);
        let letters = letters.filter(|(l, _)| l.outline.subpaths.first().is_some_and(|s| keys.contains(&key(s))));
        let boxes = letters.filter_map(|(l, copies)| image_box(std::iter::once(&l.outline), copies, &self.after));
        boxes.reduce(|a, b| a.union(b))
    }

    /// Returns a warning if a portion's image under the steps so far crosses the seam of a deformation to be inverted.
    fn torn_seam(&self, portion: &Portion<'_>, built: &Built, step: &Step) -> Option<String> {
        let Seam { end, through } = built.seam?;
        let artwork = portion.outlines.iter().copied();
        let crossing = first_crossing(artwork, &self.placement.copies, &self.map, end, through - end)?;
        Some(format!(
            "{}: undoing it cuts along the ray from {} through {}: artwork that crosses the cut, as at {}, is torn apart; \
             turn the map or cut the artwork there",
            step.deformation,
            show(end),
            show(through),
            show(crossing)
        ))
    }
}

/// The inverse of a map: its closed form, or Newton's method over the frame.
fn inverse(built: &Built, frame: &Frame, budget: &Arc<Budget>) -> Arc<dyn Map> {
    let inverse = inverse_of(&built.map, frame.rect);
    inverse.within(budget).unwrap_or(inverse)
}

/// Inverts a deformation, with a warning if it folds.
fn undone(mut built: Built, frame: &Frame, deformation: &str, budget: &Arc<Budget>) -> Result<Built, GeometryError> {
    let map = inverse(&built, frame, budget);
    let work = INVERTING_WORK * built.map.work() + SAMPLES as f64 * map.work();
    budget.spend(work).map_err(GeometryError::Limit)?;
    if let Some(a) = ambiguity(&*built.map, &*map, frame.rect) {
        built.warn(format!(
            "{deformation}: undoing it is ambiguous: {} and {} have the same image, {}, of which only one can come back; artwork \
             there, and beyond the fold, may come out wrong",
            show(a.source),
            show(a.returned),
            show(a.image)
        ));
    }
    // Source and result change places.
    for Overlay { role, .. } in &mut built.explanation.overlays {
        *role = match role {
            Role::Base => Role::Target,
            Role::Target => Role::Base,
            Role::Cage => Role::Cage,
        };
    }
    Ok(Built { map, ..built })
}

/// The number of intervals between the samples of a segment.
const PER_SEGMENT: usize = 16;

/// Frames of inverse steps that an iteration changes by no more than this fraction of their size have settled.
const SETTLED: f64 = 1e-9;

/// The number of iterations after which frames count as not settling.
const MAX_ITERATIONS: usize = 64;

/// The work of building a map with a segment of a path that controls it, in evaluations of the budget: most maps measure its length.
const PATH_SEGMENT_WORK: f64 = 4000.0;

/// The work of building an inverse, in evaluations of the map: its starting points.
const INVERTING_WORK: f64 = 150.0;

/// The work of a sample, which is taken in a batch, in evaluations of the budget.
const SAMPLE_WORK: f64 = 0.25;

/// Every segment of the artwork with the position of each copy of it. Without copies, the artwork stays where it is.
fn segs_of_copies<'a>(
    artwork: impl Iterator<Item = &'a Outline>,
    copies: &[Affine],
) -> impl Iterator<Item = (&'a Seg, Affine)> {
    let copies = if copies.is_empty() { &[Affine::IDENTITY][..] } else { copies };
    artwork.flat_map(Outline::segs).flat_map(|s| copies.iter().map(move |m| (s, *m)))
}

/// Samples of the image of a segment: accurate enough for warnings, not for proofs.
fn sample_image(seg: &Seg, copy: Affine, map: &dyn Map) -> [Point; PER_SEGMENT + 1] {
    let ps: [Point; PER_SEGMENT + 1] = std::array::from_fn(|i| copy * seg.eval(i as f64 / PER_SEGMENT as f64));
    let mut image = [Point::ORIGIN; PER_SEGMENT + 1];
    map.points(&ps, &mut image);
    image
}

/// Returns points of the artwork's image, about evenly spaced along the artwork.
fn ink<'a>(artwork: impl Iterator<Item = &'a Outline> + Clone, map: &dyn Map) -> Vec<Point> {
    /// The approximate number of points.
    const POINTS: f64 = 1000.0;
    let length_of = |s: &Seg| {
        let ps = [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| s.eval(t));
        ps.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>()
    };
    let step = artwork.clone().flat_map(Outline::segs).map(length_of).sum::<f64>() / POINTS;
    // The length from the start of the segment to the next point.
    let mut next = 0.5 * step;
    let mut out = Vec::new();
    for s in artwork.flat_map(Outline::segs) {
        let length = length_of(s);
        while next < length {
            out.push(map.point(s.eval(next / length)));
            next += step;
        }
        next -= length;
    }
    out.retain(|p| p.is_finite());
    out
}

/// Returns the bounding box of the artwork's image.
fn image_box<'a>(artwork: impl Iterator<Item = &'a Outline>, copies: &[Affine], map: &dyn Map) -> Option<Rect> {
    /// Right, left, down, up.
    const DIRECTIONS: [Vec2; 4] =
        [Vec2::new(1.0, 0.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(0.0, -1.0)];
    if let Class::Affine(m) = map.class() {
        let images = segs_of_copies(artwork, copies).map(|(seg, copy)| seg.transformed(m * copy).bounding_box());
        return images.filter(Rect::is_finite).reduce(|a, b| a.union(b));
    }
    let mut extremes = [f64::NEG_INFINITY; 4];
    for (seg, copy) in segs_of_copies(artwork, copies) {
        let samples = sample_image(seg, copy, map);
        for (direction, extreme) in DIRECTIONS.iter().zip(&mut extremes) {
            let height = samples.map(|p| if p.is_finite() { direction.dot(p.to_vec2()) } else { f64::NEG_INFINITY });
            *extreme = height.iter().copied().fold(*extreme, f64::max);
            for i in 0..=PER_SEGMENT {
                let (before, after) = (i.saturating_sub(1), (i + 1).min(PER_SEGMENT));
                // Twice the most by which a parabola through three samples rises above them.
                let k = i.clamp(1, PER_SEGMENT - 1);
                let rise = 0.25 * (2.0 * height[k] - height[k - 1] - height[k + 1]).abs();
                if height[i] >= height[before] && height[i] >= height[after] && height[i] + rise > *extreme {
                    let f = |t: f64| direction.dot(map.point(copy * seg.eval(t)).to_vec2());
                    let top = maximum(f, [before, after].map(|k| k as f64 / PER_SEGMENT as f64));
                    *extreme = if top.is_finite() { extreme.max(top) } else { *extreme };
                }
            }
        }
    }
    let [x1, x0, y1, y0] = extremes;
    x1.is_finite().then(|| Rect::new(-x0, -y0, x1, y1))
}

/// The largest value of a function with one maximum between two parameters, by golden-section search.
fn maximum(f: impl Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> f64 {
    /// 2 − φ, where φ is the golden ratio.
    const GOLDEN: f64 = 0.381_966_011_250_105;
    const STEPS: usize = 40;
    for _ in 0..STEPS {
        let (l, r) = (a + GOLDEN * (b - a), b - GOLDEN * (b - a));
        if f(l) < f(r) { a = l } else { b = r }
    }
    f(0.5 * (a + b))
}

/// Returns the first point where the artwork's image crosses the ray from `end` in the direction `along`.
fn first_crossing<'a>(
    artwork: impl Iterator<Item = &'a Outline>,
    copies: &[Affine],
    map: &dyn Map,
    end: Point,
    along: Vec2,
) -> Option<Point> {
    let side = |p: Point| along.cross(p - end);
    let crossing = |a: Point, b: Point| {
        let (s, t) = (side(a), side(b));
        let p = a.lerp(b, s / (s - t));
        ((s < 0.0) != (t < 0.0) && along.dot(p - end) > 0.0).then_some(p)
    };
    let mut images = segs_of_copies(artwork, copies).map(|(seg, copy)| sample_image(seg, copy, map));
    images.find_map(|ps| ps.windows(2).find_map(|w| crossing(w[0], w[1])))
}

// Finds points where undoing a map must go wrong: two points of the source have the same image, and the inverse can return only one
// of them.

/// The number of samples in each direction over the box. Ambiguous areas smaller than the spacing can go unnoticed.
const GRID: usize = 32;
/// The number of all samples.
const SAMPLES: usize = GRID * GRID;
/// A point and the preimage of its image are two points if their distance exceeds this fraction of the box's diagonal, far above the error
/// of Newton's method.
const MIN_DISTANCE: f64 = 1e-6;

/// A point of the source whose image comes back as another point.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ambiguity {
    source: Point,
    returned: Point,
    image: Point,
}

/// Returns the first point inside `frame` that `inverse` does not bring back from its image under `map`. Points without an image
/// or without a preimage are skipped: they cause other errors or warnings.
fn ambiguity(map: &dyn Map, inverse: &dyn Map, frame: Rect) -> Option<Ambiguity> {
    let mut creases = Creases::default();
    map.creases(&mut creases);
    // The middles of cells are sampled, since the two ends of a seam along the box's edge share their image by design.
    let sample = |n: usize| {
        let fraction = |i: usize| (i as f64 + 0.5) / GRID as f64;
        Point::new(frame.x0 + frame.width() * fraction(n % GRID), frame.y0 + frame.height() * fraction(n / GRID))
    };
    let sources: Vec<Point> = (0..SAMPLES).map(sample).filter(|p| creases.defined_at(*p)).collect();
    let mut images = vec![Point::ORIGIN; sources.len()];
    map.points(&sources, &mut images);
    let mut returned = vec![Point::ORIGIN; sources.len()];
    inverse.points(&images, &mut returned);
    let min_distance = MIN_DISTANCE * frame.width().hypot(frame.height());
    let triples = sources.into_iter().zip(images).zip(returned);
    let mut all = triples.map(|((source, image), returned)| Ambiguity { source, returned, image });
    all.find(|a| a.image.is_finite() && a.returned.is_finite() && a.source.distance(a.returned) > min_distance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{AffineMap, Formula, NewtonInverse, Real};
    use crate::refit::{Options, warp_path};

    #[test]
    fn later_percentages_mean_the_box_at_that_step() {
        let art = Outline::from_svg("M0,0 H100 V50 H0 Z").unwrap();
        let step = |name: &str, pairs: &[(&str, &str)]| Step::new(name, Args::from_pairs(pairs));
        let recipe = Recipe {
            steps: vec![step("affine", &[("scale-x", "2"), ("about", "0,0")]), step("affine", &[("move-x", "50%")])],
        };
        let built = recipe
            .build(&Registry::builtin(), Frame::new(art.bounding_box().unwrap()), &std::iter::once(&art))
            .unwrap();
        assert_eq!(built.map.point(Point::new(10.0, 5.0)), Point::new(120.0, 5.0));
        assert_eq!(built.map.steps().len(), 1);
        let frames: Vec<Rect> = built.frames.iter().map(|f| f.rect).collect();
        assert_eq!(frames, [Rect::new(0.0, 0.0, 100.0, 50.0), Rect::new(0.0, 0.0, 200.0, 50.0)]);
        let unknown = Recipe { steps: vec![step("wobble", &[])] };
        let e = unknown.build(&Registry::builtin(), Frame::new(Rect::ZERO), &std::iter::once(&art)).err().unwrap();
        assert!(e.to_string().contains("shaper"), "{e}");
    }

    /// A step that changes nothing, or nearly, leaves the box of the next one unchanged.
    #[test]
    fn the_box_of_a_later_step_is_that_of_the_curves() {
        let art = Outline::from_svg("M17 3A40 23 20 1 1 16 9C-20 60 -30 -70 40 20Q90 170 5 5").unwrap();
        let step = |name: &str, pairs: &[(&str, &str)]| Step::new(name, Args::from_pairs(pairs));
        let frame = |first: Step| {
            let recipe = Recipe { steps: vec![first, step("expr", &[("x", "u*100"), ("y", "v*100")])] };
            let frame = Frame::new(art.bounding_box().unwrap());
            recipe.build(&Registry::builtin(), frame, &std::iter::once(&art)).unwrap().frames[1].rect
        };
        let exact = art.bounding_box().unwrap();
        assert_eq!(frame(step("affine", &[("matrix", "1,0,0,1,0,0")])), exact);
        for step in [step("affine", &[("matrix", "1,0,0,1,1e-9,0")]), step("expr", &[("x", "x+0*y"), ("y", "y")])] {
            let found = frame(step);
            assert!(
                (found.origin() - exact.origin()).hypot() + (found.size() - exact.size()).to_vec2().hypot() < 2e-8,
                "{found:?}"
            );
        }
    }

    #[test]
    fn an_inverted_recipe_undoes_it() {
        let art = Outline::from_svg("M0,0 H100 V50 H0 Z").unwrap();
        let step = |name: &str, pairs: &[(&str, &str)]| Step::new(name, Args::from_pairs(pairs));
        let recipe = Recipe {
            steps: vec![
                step("affine", &[("rotate", "30"), ("about", "10,20")]),
                step("projective", &[("base", "0,50 100,50 100,0 0,0"), ("target", "0,60 110,50 80,5 10,0")]),
            ],
        };
        let frame = Frame::new(art.bounding_box().unwrap());
        let build = |r: &Recipe| r.build(&Registry::builtin(), frame.clone(), &std::iter::once(&art)).unwrap().map;
        let (there, back) = (build(&recipe), build(&recipe.inverted()));
        for p in [Point::new(3.0, 4.0), Point::new(77.0, 31.0)] {
            assert!(back.point(there.point(p)).distance(p) < 1e-12);
        }
        assert_eq!(recipe.inverted().inverted(), recipe);
    }

    /// Percentages of the later steps refer to boxes that the result alone does not determine.
    #[test]
    fn steps_of_percentages_are_undone_from_the_result() {
        let art = Outline::from_svg("M20,20 H180 V80 H20 Z M60,30 C80,90 120,10 140,70").unwrap();
        let step = |name: &str, pairs: &[(&str, &str)]| Step::new(name, Args::from_pairs(pairs));
        let recipe = Recipe {
            steps: vec![
                step("warp", &[("style", "arc"), ("bend", "30%")]),
                step("wave", &[("height", "10%"), ("length", "40%")]),
                step("affine", &[("scale-y", "1.5"), ("move-x", "10%")]),
            ],
        };
        let (registry, frame) = (Registry::builtin(), Frame::new(art.bounding_box().unwrap()));
        let there = recipe.build(&registry, frame.clone(), &std::iter::once(&art)).unwrap();
        let bent = warp_path(&art, &there.map, &Options::new(1e-4)).unwrap();
        let bent = Outline::from(&bent.path);
        let back = recipe.inverted().build(&registry, frame, &std::iter::once(&bent)).unwrap();
        assert!(back.steps.iter().all(|s| s.explanation.warnings.is_empty()));
        for seg in art.segs() {
            let p = seg.eval(0.3);
            let distance = back.map.point(there.map.point(p)).distance(p);
            // Boxes are sampled.
            assert!(distance < 0.02, "{p:?} comes back {distance} away");
        }
    }

    /// A map that folds along x = 0.
    struct Fold;
    impl Formula for Fold {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x * x, y)
        }
    }

    #[test]
    fn a_fold_is_ambiguous_and_one_side_of_it_is_not() {
        let inverse = |frame| NewtonInverse::over(Arc::new(Fold), frame, 0.25);
        let both = Rect::new(-1.0, 0.0, 2.0, 1.0);
        let found = ambiguity(&Fold, &inverse(both), both).unwrap();
        assert!((found.source.x + found.returned.x).abs() < 1e-6, "{found:?}");
        let half = Rect::new(1.0, 0.0, 2.0, 1.0);
        assert_eq!(ambiguity(&Fold, &inverse(half), half), None);
        let turn = Affine::rotate(1.0);
        assert_eq!(ambiguity(&AffineMap(turn), &AffineMap(turn.inverse()), both), None);
    }
}
