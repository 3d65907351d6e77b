//! Edits before bending as steps: the editor lists them before the others, where the command line and recipes have options.

use crate::edits;
use pathwarp::deform::{ByHand, Info};
use pathwarp::param::{Args, Axis, Param};
use pathwarp::recipe::{Recipe, Step};

/// The steps. Each has the name of its option, and one parameter: the option's value.
pub static FIRST: [Info; 2] = [
    Info::new("simplify", "give paths the fewest nodes within a distance")
        .group("Before bending")
        .params(&[Param::length("within", Axis::Diagonal, "Largest distance from the drawing as it was.")
            .within(0.0, 1e9)
            .slider(0.0, 2.0)])
        .by_hand(ByHand { neutral: &[("within", "0.05%")], showing: &[("within", "1%")], ..ByHand::NONE }),
    Info::new("outset", "let areas grow, or shrink by a distance below zero")
        .group("Before bending")
        .params(&[Param::length("by", Axis::Diagonal, "Distance by which outlines move.").slider(-10.0, 10.0)])
        .by_hand(ByHand {
            label: Some("Offset"),
            labels: &[("by", "Distance")],
            neutral: &[("by", "1%")],
            showing: &[("by", "2%")],
            ..ByHand::NONE
        }),
];

/// What they say, as options.
pub type First = Vec<(&'static str, String)>;

/// Takes such steps from the beginning of a recipe. Returns the others, or one that moves nothing, and the options.
pub fn taken(recipe: &Recipe) -> (Recipe, First) {
    let (mut rest, mut options) = (recipe.clone(), Vec::new());
    while let Some(info) = rest.steps.first().and_then(|s| FIRST.iter().find(|i| i.name == s.deformation)) {
        let step = rest.steps.remove(0);
        let value = info.params.first().and_then(|p| step.args.get(p.name).last().cloned());
        options.extend(value.map(|v| (info.name, v)));
        if rest.steps.is_empty() {
            rest = edits::still();
            rest.steps.iter_mut().for_each(|s| s.exclude.clone_from(&step.exclude));
        }
    }
    (rest, options)
}

/// Puts the options before the steps of a recipe.
pub fn put(recipe: &mut Recipe, mut value: impl FnMut(&str) -> Option<String>) {
    let steps = FIRST.iter().filter_map(|info| {
        let mut args = Args::new();
        args.push(info.params.first()?.name, value(info.name)?);
        Some(Step::new(info.name, args))
    });
    let mut steps: Vec<Step> = steps.collect();
    let exclude = recipe.steps.first().map(|s| s.exclude.clone()).unwrap_or_default();
    steps.iter_mut().for_each(|s| s.exclude.clone_from(&exclude));
    let is_still = |s: &Step| Step { exclude: Vec::new(), ..s.clone() } == edits::still().steps[0];
    if !steps.is_empty() && recipe.steps.len() == 1 && recipe.steps.iter().all(is_still) {
        recipe.steps.clear();
    }
    recipe.steps.splice(0..0, steps);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::OPTIONS;

    #[test]
    fn steps_become_options_and_come_back() {
        assert!(FIRST.iter().all(|i| i.params.len() == 1 && OPTIONS.iter().any(|o| o.name == i.name && o.stored)));
        let step = |name: &str, param: &str, value: &str| Step {
            exclude: vec!["#a".into()],
            ..Step::new(name, Args::from_pairs(&[(param, value)]))
        };
        let simplify = step("simplify", "within", "0.2mm");
        for others in [vec![], vec![step("outset", "by", "-1%"), step("wave", "height", "5%")]] {
            let recipe = Recipe { steps: [vec![simplify.clone()], others].concat() };
            let (mut rest, options) = taken(&recipe);
            assert!(rest.steps.iter().all(|s| ["affine", "wave"].contains(&&*s.deformation)));
            put(&mut rest, |name| options.iter().find(|o| o.0 == name).map(|o| o.1.clone()));
            assert_eq!(rest, recipe);
        }
    }
}
