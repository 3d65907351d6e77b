//! A deformation, applied from its dialog.

use super::guides::sorted;
use super::line::{by_id, exclusions, referred, settled};
use super::names::{ADD, AGAIN, CHAIN, DISCARD, REPLACE};
use super::restoring::{Restoration, as_by_hand, remembering, restored};
use super::stage::{Scope, Stage};
use super::{quoting, words};
use crate::advice;
use crate::failure::Failure;
use pathwarp_svg::objects::{Guides, Object, objects};

/// Warps the selected objects. Returns the drawing.
pub(super) fn run(stage: &Stage<'_>, name: &str) -> Result<String, Failure> {
    let call = stage.call;
    let known = stage.registry.entries().iter().map(|e| e.info().name);
    let entry = stage.registry.get(name).ok_or_else(|| Failure::usage(advice::unknown("deformation", name, known)))?;
    let drawing = stage.drawing()?;
    let all = objects(&drawing, &stage.limits())?;
    let given = words::of_deformation(entry.info(), call);
    let sorted = sorted(entry.info(), &all, call, &given)?;

    let mode = call.value(AGAIN).unwrap_or_default();
    let starts_again = |o: &&Object| {
        let is_same = |r: &String| {
            let line = quoting::split(r);
            line.first().is_some_and(|w| w == name) && !line.iter().any(|w| w == CHAIN)
        };
        sorted.artwork.contains(&o.id)
            && o.recipe.as_ref().is_some_and(|r| mode == REPLACE || mode != ADD && is_same(r))
    };
    let again: Vec<String> = all.iter().filter(starts_again).map(|o| o.id.clone()).collect();
    let Restoration { svg, objects: returned } = restored(stage, &drawing, &again, call.is_on(DISCARD))?;

    let mut line: Vec<String> = std::iter::once(name.to_owned()).chain(given).chain(sorted.words()).collect();
    line = by_id(line, &all);
    line.extend(words::of_options(call));
    // Of the whole page, what is locked stays.
    let whole = call.ids.is_empty();
    if whole {
        line.extend(exclusions(&all));
    }
    let outcome = stage.warp(&svg, &line, &Scope { ids: if whole { &[] } else { &sorted.artwork } })?;
    stage.check(&svg, &outcome)?;

    let guides = Guides::of(&svg, &referred(&line), &stage.limits())?;
    let recipe = quoting::joined(&settled(stage, line, &outcome));
    let result = remembering(stage, &svg, &outcome.svg, &sorted.artwork, &recipe, &guides)?;
    as_by_hand(stage, &drawing, result, &returned)
}
