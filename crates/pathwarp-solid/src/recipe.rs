//! Recipes of deformations of space: steps that are applied one after another and composed into one map.

use crate::deform::{Built3, Registry3};
use crate::map::{Chain3, Creases3, Map3, NewtonInverse3};
use crate::settings::{Box3, Frame3};
use glam::DVec3;
use pathwarp::budget::{Budget, Exceeded, Limits};
use pathwarp::recipe::Recipe;
use pathwarp::{Error, GeometryError};
use std::fmt;
use std::sync::Arc;

/// A recipe whose steps have been built.
#[derive(Clone)]
pub struct BuiltRecipe3 {
    /// All steps composed.
    pub map: Chain3,
    /// The steps one by one.
    pub steps: Vec<Built3>,
    /// The box of each step, to which its percentages refer.
    pub frames: Vec<Frame3>,
    /// The budget that searches for inverses charge.
    budget: Arc<Budget>,
}

impl fmt::Debug for BuiltRecipe3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BuiltRecipe3").field("map", &self.map).field("frames", &self.frames).finish_non_exhaustive()
    }
}

impl BuiltRecipe3 {
    fn new(steps: usize, budget: &Arc<Budget>) -> Self {
        Self {
            map: Chain3::default(),
            steps: Vec::with_capacity(steps),
            frames: Vec::with_capacity(steps),
            budget: Arc::clone(budget),
        }
    }

    /// Returns the limit that searches for an inverse have exceeded, if any. Results computed with the map must then be discarded.
    #[must_use]
    pub fn exceeded(&self) -> Option<Exceeded> {
        self.budget.exceeded()
    }
}

/// Distance outside the frame up to which solutions of Newton's method are accepted, as a fraction of the diagonal.
const REACH: f64 = 0.25;
/// Smooth pieces of a map along each axis that Newton's method allows for.
const PIECES: [usize; 3] = [4; 3];

/// Grid points along each axis of a box.
const GRID: usize = 12;

/// Returns a grid of points all over a box, corners included.
fn places(bounds: &Box3) -> impl Iterator<Item = DVec3> {
    let at = |i: usize| i as f64 / (GRID - 1) as f64;
    let place = move |k: usize| DVec3::new(at(k % GRID), at(k / GRID % GRID), at(k / (GRID * GRID)));
    let (from, size) = (bounds.min, bounds.size());
    (0..GRID.pow(3)).map(move |k| from + place(k) * size)
}

/// Returns a point of a box at which a map turns space inside out, unless it does so everywhere.
fn fold(map: &dyn Map3, bounds: &Box3) -> Option<DVec3> {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let all = places(bounds).filter(|p| creases.defined_at(*p));
    let signs: Vec<(DVec3, f64)> = all.map(|p| (p, map.jet(p).det())).collect();
    let first = signs.iter().find(|(_, det)| *det < 0.0)?;
    signs.iter().any(|(_, det)| *det > 0.0).then_some(first.0)
}

/// Builds every step of a recipe. Percentages refer to `frame` in the first step, and to the bounding box of the points mapped so far in
/// later ones. If all of several steps are inverse, the recipe undoes its reverse: then `points` belong to a result, `frame` to its source,
/// and the boxes in between are found by iteration, with a warning if they do not settle.
///
/// # Errors
/// [`Error::Input`] when a deformation is unknown, and the error of the first step that cannot be built.
pub fn build(recipe: &Recipe, registry: &Registry3, frame: Frame3, points: &[DVec3]) -> Result<BuiltRecipe3, Error> {
    build_within(recipe, registry, frame, points, &Arc::new(Budget::new(Limits::none())))
}

/// Builds every step of a recipe, as [`build`] does, within a budget. The budget is charged for mapping the points through each step and
/// once more by the whole map. Later, inverses that search charge it for work beyond [`Map3::work`]. Once nothing is left, they are
/// undefined everywhere, and [`BuiltRecipe3::exceeded`] returns the limit.
///
/// # Errors
/// The errors of [`build`], and [`GeometryError::Limit`] when the budget does not allow so many evaluations.
pub fn build_within(
    recipe: &Recipe,
    registry: &Registry3,
    frame: Frame3,
    points: &[DVec3],
    budget: &Arc<Budget>,
) -> Result<BuiltRecipe3, Error> {
    let out = if recipe.steps.len() > 1 && recipe.steps.iter().all(|s| s.inverse) {
        undo(&recipe.inverted(), registry, frame, points, budget)?
    } else {
        built(recipe, registry, frame, points, budget)?
    };
    count(budget, &out.map, points.len())?;
    Ok(out)
}

/// Charges the budget for evaluations of a map at `places` points.
fn count(budget: &Budget, map: &dyn Map3, places: usize) -> Result<(), GeometryError> {
    budget.spend(places as f64 * map.work()).map_err(GeometryError::Limit)
}

fn built(
    recipe: &Recipe,
    registry: &Registry3,
    frame: Frame3,
    points: &[DVec3],
    budget: &Arc<Budget>,
) -> Result<BuiltRecipe3, Error> {
    let mut out = BuiltRecipe3::new(recipe.steps.len(), budget);
    let mut frame = frame;
    let mut images = if recipe.steps.len() > 1 { points.to_vec() } else { Vec::new() };
    for (i, step) in recipe.steps.iter().enumerate() {
        let entry = registry.get(&step.deformation).ok_or_else(|| {
            let known: Vec<_> = registry.entries().iter().map(|e| e.about().info.name).collect();
            let problem =
                format!("there is no deformation of space `{}`; known are {}", step.deformation, known.join(", "));
            Error::input(format!("step {}", i + 1), problem)
        })?;
        if i > 0 {
            frame.bounds = Box3::around(images.iter().copied()).unwrap_or(frame.bounds);
        }
        let mut built = entry.build_from(&step.args, &frame)?;
        if step.inverse {
            built = inverted(built, &frame.bounds, budget)?;
        }
        if i + 1 < recipe.steps.len() {
            count(budget, &*built.map, points.len())?;
            built.map.points(&mut images);
        }
        out.map.push(Arc::clone(&built.map));
        out.steps.push(built);
        out.frames.push(frame);
    }
    Ok(out)
}

/// Builds the inverse of a recipe of several steps. The boxes of the steps depend on the points of the source, which depend on the boxes:
/// both are computed in turn until the boxes settle.
fn undo(
    recipe: &Recipe,
    registry: &Registry3,
    frame: Frame3,
    images: &[DVec3],
    budget: &Arc<Budget>,
) -> Result<BuiltRecipe3, Error> {
    /// Boxes that differ by less than this fraction of their size count as equal.
    const SETTLED: f64 = 1e-12;
    const MAX_ROUNDS: usize = 64;
    let mut there = built(recipe, registry, frame, &places(&frame.bounds).collect::<Vec<_>>(), budget)?;
    let mut off = f64::INFINITY;
    for _ in 0..MAX_ROUNDS {
        if off <= SETTLED {
            break;
        }
        let mut sources = images.to_vec();
        for (step, frame) in there.steps.iter().zip(&there.frames).rev() {
            let back = inverse(&step.map, &frame.bounds, budget);
            count(budget, &*back, sources.len())?;
            back.points(&mut sources);
        }
        sources.retain(|p| p.is_finite());
        let next = built(recipe, registry, frame, &sources, budget)?;
        off = next.frames.iter().zip(&there.frames).map(|(a, b)| apart(&a.bounds, &b.bounds)).fold(0.0, f64::max);
        there = next;
    }
    let mut out = BuiltRecipe3::new(there.steps.len(), budget);
    for (step, frame) in there.steps.into_iter().zip(there.frames).rev() {
        let step = inverted(step, &frame.bounds, budget)?;
        out.map.push(Arc::clone(&step.map));
        out.steps.push(step);
        out.frames.push(frame);
    }
    if let Some(step) = out.steps.last_mut().filter(|_| off > SETTLED) {
        step.warn(format!(
            "the boxes to which percentages of later steps refer were not found again, and differ by {off:.1e} of their size: the \
             result is not the source; give those steps lengths instead"
        ));
    }
    Ok(out)
}

/// Returns the distance between the corners of two boxes, as a fraction of their size.
fn apart(a: &Box3, b: &Box3) -> f64 {
    a.min.distance(b.min).max(a.max.distance(b.max)) / b.diagonal()
}

/// Inverts a step over its box. Warns if the step folds space there.
fn inverted(mut built: Built3, bounds: &Box3, budget: &Arc<Budget>) -> Result<Built3, GeometryError> {
    count(budget, &*built.map, GRID.pow(3))?;
    if let Some(at) = fold(&*built.map, bounds) {
        let DVec3 { x, y, z } = at;
        built.warn(format!(
            "the map that is inverted folds space over itself, first at {x:.6},{y:.6},{z:.6}: places there have several \
             sources, and one of them is taken"
        ));
    }
    built.map = inverse(&built.map, bounds, budget);
    Ok(built)
}

/// Returns the inverse of a map, in closed form if the map has one, or by Newton's method over a box.
fn inverse(map: &Arc<dyn Map3>, bounds: &Box3, budget: &Arc<Budget>) -> Arc<dyn Map3> {
    let newton = || -> Arc<dyn Map3> {
        Arc::new(NewtonInverse3::new(Arc::clone(map), *bounds, REACH * bounds.diagonal(), PIECES))
    };
    let inverse = map.inverse().unwrap_or_else(newton);
    inverse.within(budget).unwrap_or(inverse)
}
