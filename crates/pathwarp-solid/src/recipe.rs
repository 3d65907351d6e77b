//! Recipes of deformations of space: steps that are applied one after another and composed into one map.

use crate::deform::{Built3, Registry3};
use crate::map::{Chain3, Creases3, Map3, NewtonInverse3};
use crate::settings::{Box3, Frame3, grid};
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
    fn new(budget: &Arc<Budget>) -> Self {
        Self { map: Chain3::default(), steps: Vec::new(), frames: Vec::new(), budget: Arc::clone(budget) }
    }

    fn push(&mut self, step: Built3, frame: Frame3) {
        self.map.push(Arc::clone(&step.map));
        self.steps.push(step);
        self.frames.push(frame);
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
fn grid_points(bounds: &Box3) -> impl Iterator<Item = DVec3> {
    let (from, size) = (bounds.min, bounds.size());
    grid([GRID; 3]).map(move |n| from + DVec3::from_array(n.map(|i| i as f64 / (GRID - 1) as f64)) * size)
}

/// Returns a point of a box at which a map turns space inside out, unless it does so everywhere.
fn find_fold(map: &dyn Map3, bounds: &Box3) -> Option<DVec3> {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let points = grid_points(bounds).filter(|p| creases.defined_at(*p));
    let determinants: Vec<(DVec3, f64)> = points.map(|p| (p, map.jet(p).det())).collect();
    let first = determinants.iter().find(|(_, det)| *det < 0.0)?;
    determinants.iter().any(|(_, det)| *det > 0.0).then_some(first.0)
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
    let builder = Builder { registry, frame, budget };
    let out = if recipe.steps.len() > 1 && recipe.steps.iter().all(|s| s.inverse) {
        builder.build_inverse(&recipe.inverted(), points)?
    } else {
        builder.build(recipe, points)?
    };
    charge(budget, &out.map, points.len())?;
    Ok(out)
}

/// Charges the budget for evaluations of a map at `points` points.
fn charge(budget: &Budget, map: &dyn Map3, points: usize) -> Result<(), GeometryError> {
    budget.spend(points as f64 * map.work()).map_err(GeometryError::Limit)
}

/// The surroundings in which recipes are built.
struct Builder<'a> {
    registry: &'a Registry3,
    frame: Frame3,
    budget: &'a Arc<Budget>,
}

impl Builder<'_> {
    fn build(&self, recipe: &Recipe, points: &[DVec3]) -> Result<BuiltRecipe3, Error> {
        let Self { registry, mut frame, budget } = *self;
        let mut out = BuiltRecipe3::new(budget);
        let mut images = if recipe.steps.len() > 1 { points.to_vec() } else { Vec::new() };
        for (i, step) in recipe.steps.iter().enumerate() {
            let entry = registry.get(&step.deformation).ok_or_else(|| {
                let known = registry.entries().iter().map(|e| e.about().info.name).collect::<Vec<_>>().join(", ");
                let problem = format!("there is no deformation of space `{}`; known are {known}", step.deformation);
                Error::input(format!("step {}", i + 1), problem)
            })?;
            if i > 0 {
                frame.bounds = Box3::around(images.iter().copied()).unwrap_or(frame.bounds);
            }
            let mut built = entry.build_from(&step.args, &frame)?;
            if step.inverse {
                built = invert_step(built, &frame.bounds, budget)?;
            }
            if i + 1 < recipe.steps.len() {
                charge(budget, &*built.map, points.len())?;
                built.map.points(&mut images);
            }
            out.push(built, frame);
        }
        Ok(out)
    }

    /// Builds the inverse of a recipe of several steps. The steps' boxes depend on the points of the source, which depend on the boxes:
    /// both are computed in turn until the boxes settle.
    fn build_inverse(&self, recipe: &Recipe, images: &[DVec3]) -> Result<BuiltRecipe3, Error> {
        /// Boxes that differ by less than this fraction of their size count as equal.
        const SETTLED: f64 = 1e-12;
        const MAX_ROUNDS: usize = 64;
        // The distance between the corners of two boxes, as a fraction of their size.
        let distance = |a: &Box3, b: &Box3| a.min.distance(b.min).max(a.max.distance(b.max)) / b.diagonal();
        let Self { frame, budget, .. } = *self;
        let mut forward = self.build(recipe, &grid_points(&frame.bounds).collect::<Vec<_>>())?;
        let mut change = f64::INFINITY;
        for _ in 0..MAX_ROUNDS {
            if change <= SETTLED {
                break;
            }
            let mut sources = images.to_vec();
            for (step, frame) in forward.steps.iter().zip(&forward.frames).rev() {
                let back = inverse(&step.map, &frame.bounds, budget);
                charge(budget, &*back, sources.len())?;
                back.points(&mut sources);
            }
            sources.retain(|p| p.is_finite());
            let next = self.build(recipe, &sources)?;
            let frames = next.frames.iter().zip(&forward.frames);
            change = frames.map(|(a, b)| distance(&a.bounds, &b.bounds)).fold(0.0, f64::max);
            forward = next;
        }
        let mut out = BuiltRecipe3::new(budget);
        for (step, frame) in forward.steps.into_iter().zip(forward.frames).rev() {
            out.push(invert_step(step, &frame.bounds, budget)?, frame);
        }
        if let Some(step) = out.steps.last_mut().filter(|_| change > SETTLED) {
            step.warn(format!(
                "the boxes that percentages of later steps refer to could not be restored, and are off by {change:.1e} of their size: the result \
                 differs from the source; give those steps lengths instead"
            ));
        }
        Ok(out)
    }
}

/// Inverts a step over its box. Warns if the step folds space there.
fn invert_step(mut built: Built3, bounds: &Box3, budget: &Arc<Budget>) -> Result<Built3, GeometryError> {
    charge(budget, &*built.map, GRID.pow(3))?;
    if let Some(DVec3 { x, y, z }) = find_fold(&*built.map, bounds) {
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
    let newton = || NewtonInverse3::new(Arc::clone(map), *bounds, REACH * bounds.diagonal(), PIECES);
    let inverse = map.inverse().unwrap_or_else(|| Arc::new(newton()));
    inverse.within(budget).unwrap_or(inverse)
}
