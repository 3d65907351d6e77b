//! Recipes in space: deformations one after another, composed into one map.

use crate::box3::Box3;
use crate::deform::{Built3, Registry3};
use crate::map::{Chain3, Creases3, Map3, NewtonInverse3};
use crate::settings::Frame3;
use glam::DVec3;
use pathwarp::Error;
use pathwarp::recipe::Recipe;
use std::sync::Arc;

/// A recipe with every parameter settled.
#[derive(Clone)]
pub struct BuiltRecipe3 {
    /// All steps composed.
    pub map: Chain3,
    /// The steps one by one.
    pub steps: Vec<Built3>,
}

/// Distance beyond the frame at which a solution of Newton's method is accepted, as a share of its diagonal.
const REACH: f64 = 0.25;
/// Smooth pieces of a map along an axis that Newton's method is prepared for.
const PIECES: [usize; 3] = [4; 3];

/// A place of a box where a map turns space inside out, if it does not everywhere.
fn fold(map: &dyn Map3, bounds: &Box3) -> Option<DVec3> {
    const GRID: usize = 12;
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let at = |i: usize| i as f64 / (GRID - 1) as f64;
    let place = |k: usize| DVec3::new(at(k % GRID), at(k / GRID % GRID), at(k / (GRID * GRID)));
    let all = (0..GRID.pow(3)).map(|k| bounds.min + place(k) * bounds.size()).filter(|p| creases.defined_at(*p));
    let signs: Vec<(DVec3, f64)> = all.map(|p| (p, map.jet(p).det())).collect();
    let first = signs.iter().find(|(_, det)| *det < 0.0)?;
    signs.iter().any(|(_, det)| *det > 0.0).then_some(first.0)
}

/// Builds every step of a recipe. Percentages refer to `frame` in the first step, and in later ones to the bounding box of
/// `points` as they are by then.
///
/// # Errors
/// An unknown deformation, or any error from building a step.
pub fn build(recipe: &Recipe, registry: &Registry3, frame: Frame3, points: &[DVec3]) -> Result<BuiltRecipe3, Error> {
    let mut out = BuiltRecipe3 { map: Chain3::default(), steps: Vec::with_capacity(recipe.steps.len()) };
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
            if let Some(at) = fold(&*built.map, &frame.bounds) {
                let DVec3 { x, y, z } = at;
                built.warn(format!(
                    "the map that is inverted folds space over itself, first at {x:.6},{y:.6},{z:.6}: places there have several \
                     sources, and one of them is taken"
                ));
            }
            let newton = || -> Arc<dyn Map3> {
                let reach = REACH * frame.bounds.diagonal();
                Arc::new(NewtonInverse3::new(Arc::clone(&built.map), frame.bounds, reach, PIECES))
            };
            built.map = built.map.inverse().unwrap_or_else(newton);
        }
        if i + 1 < recipe.steps.len() {
            built.map.points(&mut images);
        }
        out.map.push(Arc::clone(&built.map));
        out.steps.push(built);
    }
    Ok(out)
}
