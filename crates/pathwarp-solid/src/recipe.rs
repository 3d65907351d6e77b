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
    /// What percentages of each step referred to.
    pub frames: Vec<Frame3>,
}

/// Distance beyond the frame at which a solution of Newton's method is accepted, as a share of its diagonal.
const REACH: f64 = 0.25;
/// Smooth pieces of a map along an axis that Newton's method is prepared for.
const PIECES: [usize; 3] = [4; 3];

/// Places all over a box, with its corners.
fn places(bounds: &Box3) -> impl Iterator<Item = DVec3> {
    const GRID: usize = 12;
    let at = |i: usize| i as f64 / (GRID - 1) as f64;
    let place = move |k: usize| DVec3::new(at(k % GRID), at(k / GRID % GRID), at(k / (GRID * GRID)));
    let (from, size) = (bounds.min, bounds.size());
    (0..GRID.pow(3)).map(move |k| from + place(k) * size)
}

/// A place of a box where a map turns space inside out, if it does not everywhere.
fn fold(map: &dyn Map3, bounds: &Box3) -> Option<DVec3> {
    let mut creases = Creases3::default();
    map.creases(&mut creases);
    let all = places(bounds).filter(|p| creases.defined_at(*p));
    let signs: Vec<(DVec3, f64)> = all.map(|p| (p, map.jet(p).det())).collect();
    let first = signs.iter().find(|(_, det)| *det < 0.0)?;
    signs.iter().any(|(_, det)| *det > 0.0).then_some(first.0)
}

/// Builds every step of a recipe. Percentages refer to `frame` in the first step, and in later ones to the bounding box of
/// `points` as they are by then. As in the plane, a recipe of inverse steps alone undoes its reverse: `points` are of a result, `frame` is
/// that of its source, and the other boxes are found by turns; a warning says so if they do not settle.
///
/// # Errors
/// An unknown deformation, or any error from building a step.
pub fn build(recipe: &Recipe, registry: &Registry3, frame: Frame3, points: &[DVec3]) -> Result<BuiltRecipe3, Error> {
    let n = recipe.steps.len();
    if n > 1 && recipe.steps.iter().all(|s| s.inverse) {
        return undo(&recipe.inverted(), registry, frame, points);
    }
    let mut out = BuiltRecipe3 { map: Chain3::default(), steps: Vec::with_capacity(n), frames: Vec::with_capacity(n) };
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
            built = inverted(built, &frame.bounds);
        }
        if i + 1 < recipe.steps.len() {
            built.map.points(&mut images);
        }
        out.map.push(Arc::clone(&built.map));
        out.steps.push(built);
        out.frames.push(frame);
    }
    Ok(out)
}

/// Builds the inverse of a recipe of several steps: boxes give the source's points, and these the boxes on their way, until they settle.
fn undo(recipe: &Recipe, registry: &Registry3, frame: Frame3, images: &[DVec3]) -> Result<BuiltRecipe3, Error> {
    /// Boxes that differ by less than this share of their size are the same.
    const SETTLED: f64 = 1e-12;
    const TURNS: usize = 64;
    let mut there = build(recipe, registry, frame, &places(&frame.bounds).collect::<Vec<_>>())?;
    let mut off = f64::INFINITY;
    for _ in 0..TURNS {
        if off <= SETTLED {
            break;
        }
        let mut sources = images.to_vec();
        for (step, frame) in there.steps.iter().zip(&there.frames).rev() {
            inverse(&step.map, &frame.bounds).points(&mut sources);
        }
        sources.retain(|p| p.is_finite());
        let next = build(recipe, registry, frame, &sources)?;
        off = next.frames.iter().zip(&there.frames).map(|(a, b)| apart(&a.bounds, &b.bounds)).fold(0.0, f64::max);
        there = next;
    }
    let mut out = BuiltRecipe3 { map: Chain3::default(), steps: Vec::new(), frames: Vec::new() };
    for (step, frame) in there.steps.into_iter().zip(there.frames).rev() {
        let step = inverted(step, &frame.bounds);
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

/// The distance of two boxes' corners, as a share of their size.
fn apart(a: &Box3, b: &Box3) -> f64 {
    a.min.distance(b.min).max(a.max.distance(b.max)) / b.diagonal()
}

/// Inverts a step over its box, with a warning if it folds.
fn inverted(mut built: Built3, bounds: &Box3) -> Built3 {
    if let Some(at) = fold(&*built.map, bounds) {
        let DVec3 { x, y, z } = at;
        built.warn(format!(
            "the map that is inverted folds space over itself, first at {x:.6},{y:.6},{z:.6}: places there have several \
             sources, and one of them is taken"
        ));
    }
    built.map = inverse(&built.map, bounds);
    built
}

/// The inverse of a map: its own, or by Newton's method over a box.
fn inverse(map: &Arc<dyn Map3>, bounds: &Box3) -> Arc<dyn Map3> {
    let newton = || -> Arc<dyn Map3> {
        Arc::new(NewtonInverse3::new(Arc::clone(map), *bounds, REACH * bounds.diagonal(), PIECES))
    };
    map.inverse().unwrap_or_else(newton)
}
