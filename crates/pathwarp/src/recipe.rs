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

use crate::ambiguity::{SAMPLES, ambiguity};
use crate::budget::{Budget, Limit, Limits};
use crate::deform::{Built, Deformation, Overlay, Placement, Registry, Role, Seam};
use crate::error::{Error, GeometryError, show};
use crate::map::{Chain, Map, NewtonInverse, metered};
use crate::meter::Meter;
use crate::outline::Outline;
use crate::param::{Args, Frame, Kind, Letter, Param};
use kurbo::{Affine, Point, Rect, Vec2};
use std::cell::LazyCell;
use std::sync::Arc;

/// A deformation with its arguments.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The deformation's name.
    pub deformation: String,
    /// Its arguments, with path references resolved.
    pub args: Args,
    /// Applies the inverse map.
    pub inverse: bool,
}

impl Step {
    /// Creates a step that is not inverted.
    #[must_use]
    pub fn new(deformation: impl Into<String>, args: Args) -> Self {
        Self { deformation: deformation.into(), args, inverse: false }
    }

    /// The given values with their names, as a command line takes them: a flag that is set has no value, one that is not is left out.
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
#[derive(Clone)]
pub struct BuiltRecipe {
    /// All steps composed.
    pub map: Chain,
    /// The steps one by one.
    pub steps: Vec<Built>,
    /// Copies of the artwork and letters placed one by one, by the first step.
    pub placement: Placement,
    /// The steps after the first, composed: the map for letters that were placed.
    pub after: Chain,
    /// For every step, the frame that its percentages refer to.
    pub frames: Vec<Frame>,
    /// Counts the searches of inverses.
    meter: Arc<Meter>,
}

impl Recipe {
    /// Builds every step within a budget, which counts the segments of the paths that control the steps, and the
    /// evaluations that find out where the artwork is after each step. Inverses that search count in it what each search takes beyond
    /// [`Map::work`], for as long as they are used: once that exceeds the limit they are undefined everywhere, and
    /// [`BuiltRecipe::failure`] says so. See [`Recipe::build`].
    ///
    /// # Errors
    /// As for [`Recipe::build`], and [`GeometryError::Limit`] if the budget does not allow so many.
    pub fn build_within<'a>(
        &self,
        registry: &Registry,
        frame: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
        budget: &Arc<Budget>,
    ) -> Result<BuiltRecipe, Error> {
        let paths: usize = self.steps.iter().map(|s| s.args.path_segments()).sum();
        budget.spend(Limit::Evaluations, MEASURED * paths as u64).map_err(GeometryError::Limit)?;
        let samples = LazyCell::new(|| (artwork.clone().flat_map(Outline::segs).count() * (PER_SEGMENT + 1)) as f64);
        let count = |out: &BuiltRecipe| {
            let places = out.placement.copies.len().max(1) as f64;
            let work = SAMPLE * places * *samples * out.map.work();
            budget.spend_cut(Limit::Evaluations, work as u64).map_err(GeometryError::Limit)
        };
        self.counted(registry, frame, artwork, (&count, &Meter::new(Arc::clone(budget))))
    }

    /// Builds every step. Percentages refer to `frame` in the first step, and in later ones to the bounding box of `artwork`
    /// as it is by then.
    ///
    /// A recipe of inverse steps alone undoes its reverse ([`Recipe::inverted`]): `artwork` is a result, `frame` that of its source, and
    /// the frames of the other steps are the boxes of the artwork on its way back. Those depend on the inverses, and these on them: they
    /// are found by turns. A warning says so if they do not settle.
    ///
    /// # Errors
    /// An unknown deformation, a step that only the first can be, or any error from building a step.
    pub fn build<'a>(
        &self,
        registry: &Registry,
        frame: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
    ) -> Result<BuiltRecipe, Error> {
        let unlimited = Arc::new(Budget::new(Limits::none()));
        self.counted(registry, frame, artwork, (&|_| Ok(()), &Meter::new(unlimited)))
    }

    /// Builds every step.
    fn counted<'a>(
        &self,
        registry: &Registry,
        frame: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
        counting: Counting<'_>,
    ) -> Result<BuiltRecipe, Error> {
        if self.steps.len() < 2 || !self.steps.iter().all(|s| s.inverse) {
            return self.built(registry, frame, artwork, counting, None);
        }
        let (frames, off) = self.frames_on_the_way_back(registry, frame.clone(), artwork, counting)?;
        let mut out = self.built(registry, frame, artwork, counting, Some(&frames))?;
        if let Some(step) = out.steps.last_mut().filter(|_| off > SETTLED) {
            step.warn(format!(
                "the boxes that percentages of the later steps refer to were not found again, and differ by {off:.1e} of their size: \
                 the result is not the source; give those steps lengths instead"
            ));
        }
        Ok(out)
    }

    /// The frames of inverse steps, in their order, for artwork that is a result; and by how much the last turn moved them, as a share of
    /// their size.
    fn frames_on_the_way_back<'a>(
        &self,
        registry: &Registry,
        source: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
        counting: Counting<'_>,
    ) -> Result<(Vec<Frame>, f64), Error> {
        let Rect { x0, y0, x1, y1 } = source.rect;
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(Point::from);
        let page = Outline::from_points(&corners, true);
        let there = self.inverted().built(registry, source, &std::iter::once(&page), counting, None)?;
        let mut frames: Vec<Frame> = there.frames.into_iter().rev().collect();
        let (count, meter) = counting;
        let mut off = f64::INFINITY;
        for _ in 0..TURNS {
            let mut back = BuiltRecipe::new(frames.len(), meter);
            off = 0.0;
            // The source's frame, the last, is known.
            for (i, step) in self.steps.iter().enumerate().take(frames.len() - 1) {
                let built = entry(registry, i, step)?.build_from(&step.args, &frames[i])?;
                back.map.push(inverse(&built, &frames[i], meter));
                count(&back)?;
                let Some(found) = image_box(artwork.clone(), &[], &back.map) else { continue };
                let known = frames[i].rect;
                let moved =
                    (found.origin() - known.origin()).hypot().max((found.size() - known.size()).to_vec2().hypot());
                off = f64::max(off, moved / known.size().to_vec2().hypot());
                frames[i] = Frame::new(found).with_units_per_px(frames[i].units_per_px);
            }
            if off <= SETTLED {
                break;
            }
        }
        Ok((frames, off))
    }

    /// Builds every step, with the frames that are found for them or those of the artwork on its way.
    fn built<'a>(
        &self,
        registry: &Registry,
        frame: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
        counting: Counting<'_>,
        found: Option<&[Frame]>,
    ) -> Result<BuiltRecipe, Error> {
        let (count, meter) = counting;
        let mut out = BuiltRecipe::new(self.steps.len(), meter);
        let letters = Arc::clone(&frame.letters);
        let mut frame = frame;
        for (i, step) in self.steps.iter().enumerate() {
            let entry = entry(registry, i, step)?;
            if let Some(found) = found.and_then(|f| f.get(i)) {
                frame = found.clone();
            } else if i > 0 {
                count(&out)?;
                let units_per_px = frame.units_per_px;
                let image = out.image_box(artwork.clone(), &letters);
                frame = image.map_or(frame, |b| Frame::new(b).with_units_per_px(units_per_px));
            }
            let mut built = entry.build_from(&step.args, &frame)?;
            check_placement(&built.placement, i, step)?;
            if i == 0 {
                out.placement.clone_from(&built.placement);
            }
            if step.inverse {
                count(&out)?;
                if let Some(warning) = out.torn_seam(artwork.clone(), &built, &step.deformation) {
                    built.warn(warning);
                }
                built = inverted(built, &frame, &step.deformation, meter)?;
            }
            if i > 0 {
                out.after.push(Arc::clone(&built.map));
            }
            out.map.push(Arc::clone(&built.map));
            out.steps.push(built);
            out.frames.push(frame.clone());
        }
        Ok(out)
    }

    /// Returns the recipe that undoes this one: the steps' inverses, the last first.
    #[must_use]
    pub fn inverted(&self) -> Self {
        let turned = |s: &Step| Step { inverse: !s.inverse, ..s.clone() };
        Self { steps: self.steps.iter().rev().map(turned).collect() }
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

/// Refuses copies and placed letters in all but a first step that is not inverted.
fn check_placement(placement: &Placement, i: usize, step: &Step) -> Result<(), Error> {
    let effect = match placement {
        p if !p.copies.is_empty() => "repeats the artwork",
        p if !p.letters.is_empty() => "places letters",
        _ => return Ok(()),
    };
    let problem = match (i, step.inverse) {
        (0, false) => return Ok(()),
        (_, true) => "has no inverse",
        _ => "only the first step can do; put it first, or in a separate run",
    };
    Err(Error::input(format!("step {}, {}", i + 1, step.deformation), format!("{effect}, which {problem}")))
}

impl BuiltRecipe {
    fn new(steps: usize, meter: &Arc<Meter>) -> Self {
        Self {
            map: Chain::default(),
            steps: Vec::with_capacity(steps),
            placement: Placement::default(),
            after: Chain::default(),
            frames: Vec::with_capacity(steps),
            meter: Arc::clone(meter),
        }
    }

    /// Returns the failure of a step's map, if one has failed, or the limit that searches for an inverse have exceeded. Results computed
    /// with it are not to be used.
    #[must_use]
    pub fn failure(&self) -> Option<Error> {
        let failed = self.steps.iter().find_map(|s| s.failure.as_ref().and_then(|failed| failed()));
        failed.or_else(|| self.meter.exceeded().map(|e| GeometryError::Limit(e).into()))
    }

    /// Stops counting the searches of inverses in the budget that the recipe was built within: for maps that are used on and on.
    pub fn stop_counting(&self) {
        self.meter.release();
    }

    /// Returns the bounding box of the artwork's image under the steps so far, which percentages of a further step would refer to.
    /// `letters` are those of the first frame. `None` if nothing of the artwork is in the map's domain.
    #[must_use]
    pub fn image_box<'a>(&self, artwork: impl Iterator<Item = &'a Outline>, letters: &[Letter]) -> Option<Rect> {
        if self.placement.letters.is_empty() {
            return image_box(artwork, &self.placement.copies, &self.map);
        }
        let placed = letters.iter().zip(&self.placement.letters).map(|(l, p)| (&l.outline, p.as_slice()));
        placed.filter_map(|(o, p)| image_box(std::iter::once(o), p, &self.after)).reduce(|a, b| a.union(b))
    }

    /// Warns if the image under the steps so far crosses the seam of a deformation to be inverted.
    fn torn_seam<'a>(
        &self,
        artwork: impl Iterator<Item = &'a Outline>,
        built: &Built,
        deformation: &str,
    ) -> Option<String> {
        let Seam { end, through } = built.seam?;
        let at = first_across(artwork, &self.placement.copies, &self.map, end, through - end)?;
        Some(format!(
            "{deformation}: undoing it cuts along the ray from {} through {}: artwork that crosses the cut, as at {}, is torn apart; \
             turn the map or cut the artwork there",
            show(end),
            show(through),
            show(at)
        ))
    }
}

/// What is called before the artwork's image under the steps so far is sampled, and the meter of the inverses.
type Counting<'a> = (&'a dyn Fn(&BuiltRecipe) -> Result<(), GeometryError>, &'a Arc<Meter>);

/// The inverse of a map: its closed form, or Newton's method over the frame.
fn inverse(built: &Built, frame: &Frame, meter: &Arc<Meter>) -> Arc<dyn Map> {
    /// Distance beyond the frame at which a solution is accepted, as a share of its diagonal: strokes and handles extend past it.
    const REACH: f64 = 0.25;
    let newton = || Arc::new(NewtonInverse::over(Arc::clone(&built.map), frame.rect, REACH)) as Arc<dyn Map>;
    metered(built.map.inverse().unwrap_or_else(newton), meter)
}

/// Inverts a deformation, with a warning if it folds.
fn inverted(mut built: Built, frame: &Frame, deformation: &str, meter: &Arc<Meter>) -> Result<Built, GeometryError> {
    let map = inverse(&built, frame, meter);
    let work = INVERTED * built.map.work() + SAMPLES as f64 * map.work();
    meter.budget().spend_cut(Limit::Evaluations, work as u64).map_err(GeometryError::Limit)?;
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

/// Intervals between the samples of a segment.
const PER_SEGMENT: usize = 16;

/// Frames on the way back that move by less than this share of their size are found.
const SETTLED: f64 = 1e-9;

/// Turns in which they are looked for; what takes more is taken not to settle.
const TURNS: usize = 64;

/// The work of building a map with a segment of a path that controls it, in evaluations of the budget: most maps measure its length.
const MEASURED: u64 = 4000;

/// The work of building an inverse, in evaluations of the map: its starting points.
const INVERTED: f64 = 150.0;

/// The work of a sample, which is taken in a batch, in evaluations of the budget.
const SAMPLE: f64 = 0.25;

/// Samples the image of every segment of the artwork: accurate enough for percentages and warnings, not for proofs.
fn images<'a>(
    artwork: impl Iterator<Item = &'a Outline>,
    copies: &[Affine],
    map: &dyn Map,
) -> impl Iterator<Item = [Point; PER_SEGMENT + 1]> {
    let places = if copies.is_empty() { &[Affine::IDENTITY][..] } else { copies };
    artwork.flat_map(Outline::segs).flat_map(|s| places.iter().map(move |m| (s, *m))).map(|(seg, place)| {
        let ps: [Point; PER_SEGMENT + 1] = std::array::from_fn(|i| place * seg.eval(i as f64 / PER_SEGMENT as f64));
        let mut image = [Point::ORIGIN; PER_SEGMENT + 1];
        map.points(&ps, &mut image);
        image
    })
}

/// Returns the bounding box of the artwork's image.
fn image_box<'a>(artwork: impl Iterator<Item = &'a Outline>, copies: &[Affine], map: &dyn Map) -> Option<Rect> {
    let points = images(artwork, copies, map).flatten().filter(|p| p.is_finite());
    points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))
}

/// Returns the first point where the artwork's image crosses the ray from `end` in the direction `along`.
fn first_across<'a>(
    artwork: impl Iterator<Item = &'a Outline>,
    copies: &[Affine],
    map: &dyn Map,
    end: Point,
    along: Vec2,
) -> Option<Point> {
    let side = |p: Point| along.cross(p - end);
    let cross = |a: Point, b: Point| {
        let (s, t) = (side(a), side(b));
        let at = a.lerp(b, s / (s - t));
        ((s < 0.0) != (t < 0.0) && along.dot(at - end) > 0.0).then_some(at)
    };
    images(artwork, copies, map).find_map(|ps| ps.windows(2).find_map(|w| cross(w[0], w[1])))
}

#[cfg(test)]
mod tests {
    use super::*;
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

    /// Percentages of the later steps refer to boxes that the result alone does not show.
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
            let off = back.map.point(there.map.point(p)).distance(p);
            // Boxes are sampled.
            assert!(off < 0.02, "{p:?} comes back {off} away");
        }
    }
}
