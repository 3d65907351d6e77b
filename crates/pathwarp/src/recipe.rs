//! Recipes: deformations one after another, composed before anything is refitted.

use crate::deform::{Built, Overlay, Placement, Registry, Role, Seam};
use crate::error::{Error, show};
use crate::map::{Chain, Map, NewtonInverse};
use crate::outline::Outline;
use crate::param::{Args, Frame};
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// A deformation with its arguments.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The deformation's name.
    pub deformation: String,
    /// Its arguments, paths looked up.
    pub args: Args,
    /// Whether it is the inverse map that is meant.
    pub inverse: bool,
}

impl Step {
    /// A step forwards.
    #[must_use]
    pub fn new(deformation: impl Into<String>, args: Args) -> Self {
        Self { deformation: deformation.into(), args, inverse: false }
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
}

impl Recipe {
    /// Builds every step. Percentages in the first step mean `frame`, in later ones the box of `artwork` as it is by then.
    ///
    /// # Errors
    /// An unknown deformation, or whatever building a step says.
    pub fn build<'a>(
        &self,
        registry: &Registry,
        mut frame: Frame,
        artwork: &(impl Iterator<Item = &'a Outline> + Clone),
    ) -> Result<BuiltRecipe, Error> {
        let mut map = Chain::default();
        let mut steps = Vec::with_capacity(self.steps.len());
        let mut placement = Placement::default();
        let mut after = Chain::default();
        let first = frame.clone();
        for (i, step) in self.steps.iter().enumerate() {
            let entry = registry.get(&step.deformation).ok_or_else(|| {
                let known: Vec<_> = registry.entries().iter().map(|e| e.info().name).collect();
                Error::Input {
                    place: format!("step {}", i + 1),
                    problem: format!("there is no deformation `{}`; known are {}", step.deformation, known.join(", ")),
                }
            })?;
            if i > 0 {
                let image = if placement.letters.is_empty() {
                    image_box(artwork.clone(), &placement.copies, &map)
                } else {
                    let placed = first.letters.iter().zip(&placement.letters).map(|(l, p)| (&l.outline, p.as_slice()));
                    placed.filter_map(|(o, p)| image_box(std::iter::once(o), p, &after)).reduce(|a, b| a.union(b))
                };
                frame = image.map_or(frame, Frame::new);
            }
            let mut built = entry.build_from(&step.args, &frame)?;
            let first_only = [
                ("repeats the artwork", !built.placement.copies.is_empty()),
                ("places letters", !built.placement.letters.is_empty()),
            ];
            for (what, _) in first_only.into_iter().filter(|(_, there)| *there) {
                let problem = match (i, step.inverse) {
                    (0, false) => continue,
                    (_, true) => "has no inverse",
                    _ => "only the first step can do; put it first, or in a run of its own",
                };
                let place = format!("step {}, {}", i + 1, step.deformation);
                return Err(Error::Input { place, problem: format!("{what}, which {problem}") });
            }
            if i == 0 {
                placement.clone_from(&built.placement);
            }
            if step.inverse {
                if let Some(Seam { end, through }) = built.seam
                    && let Some(at) = first_across(artwork.clone(), &placement.copies, &map, end, through - end)
                {
                    built.warn(format!(
                        "{}: the edges of what is undone meet on the ray from {} through {}: what crosses it, as at {}, is torn apart; \
                         turn the map or cut the artwork there",
                        step.deformation,
                        show(end),
                        show(through),
                        show(at)
                    ));
                }
                built = inverted(built, &frame);
            }
            if i > 0 {
                after.push(Arc::clone(&built.map));
            }
            map.push(Arc::clone(&built.map));
            steps.push(built);
        }
        Ok(BuiltRecipe { map, steps, placement, after })
    }
}

/// The same deformation turned round: by its own inverse, or by Newton's method over the frame.
fn inverted(mut built: Built, frame: &Frame) -> Built {
    /// How far beyond the frame an answer may lie, as a share of its diagonal: strokes and handles reach over it.
    const REACH: f64 = 0.25;
    let newton = || Arc::new(NewtonInverse::over(Arc::clone(&built.map), frame.rect, REACH)) as Arc<dyn Map>;
    let map = built.map.inverse().unwrap_or_else(newton);
    // What was the source is now the result.
    for Overlay { role, .. } in &mut built.explanation.overlays {
        *role = match role {
            Role::Base => Role::Target,
            Role::Target => Role::Base,
            Role::Cage => Role::Cage,
        };
    }
    Built { map, ..built }
}

impl Recipe {
    /// The recipe that undoes this one: the steps' inverses, the last first.
    #[must_use]
    pub fn inverted(&self) -> Self {
        let turned = |s: &Step| Step { inverse: !s.inverse, ..s.clone() };
        Self { steps: self.steps.iter().rev().map(turned).collect() }
    }
}

/// Pieces that a segment is sampled in.
const PER_SEGMENT: usize = 16;

/// Points along the image of every segment of the artwork: what a percentage or a warning needs, not what a proof needs.
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

/// The box of the artwork's image.
fn image_box<'a>(artwork: impl Iterator<Item = &'a Outline>, copies: &[Affine], map: &dyn Map) -> Option<Rect> {
    let points = images(artwork, copies, map).flatten().filter(|p| p.is_finite());
    points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))
}

/// The first place where the artwork's image crosses the ray from `end` in the direction `along`.
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
}
