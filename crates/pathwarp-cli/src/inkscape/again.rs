//! Warped objects again: other settings for them, or their sources back.

use super::line::{allowed, elsewhere, existing, referred, settled};
use super::names::{CHANGES, DISCARD, SHOW};
use super::restoring::{Restoration, Returned, as_by_hand, remembering, restored};
use super::stage::{Scope, Stage, temporary};
use super::{quoting, words};
use crate::failure::Failure;
use crate::readable;
use pathwarp_svg::objects::{self, Guides, Object, objects};
use std::collections::{BTreeMap, HashSet};

/// Gives the sources of the selected objects back. Returns the drawing.
pub(super) fn release(stage: &Stage<'_>) -> Result<String, Failure> {
    let drawing = stage.drawing()?;
    let ids = targets(stage, &objects(&drawing, &stage.limits())?)?;
    Ok(objects::restore(&drawing, &ids, &stage.limits())?.svg)
}

/// Warps the sources of the selected objects by their recipes, with changes. Returns the drawing, or nothing if the settings are only
/// to be shown.
pub(super) fn edit(stage: &Stage<'_>) -> Result<String, Failure> {
    let call = stage.call;
    let drawing = stage.drawing()?;
    let all = objects(&drawing, &stage.limits())?;
    let ids = targets(stage, &all)?;
    if call.is_on(SHOW) {
        anstream::eprintln!("{}", readable::message(&settings(&all, &ids)));
        return Ok(String::new());
    }
    let Restoration { mut svg, objects: returned } = restored(stage, &drawing, &ids, call.is_on(DISCARD))?;
    let mut runs: BTreeMap<String, Vec<&Returned>> = BTreeMap::new();
    for r in &returned {
        let mut line = quoting::split(&r.object.recipe);
        words::changed(&mut line, call.value(CHANGES).unwrap_or_default()).map_err(Failure::Usage)?;
        allowed(stage, &line)?;
        runs.entry(quoting::joined(&line)).or_default().push(r);
    }
    for (line, members) in runs {
        let line = existing(quoting::split(&line), &all);
        let ids: Vec<String> = members.iter().map(|r| r.object.id.clone()).collect();
        let referred = referred(&line);
        let is_there = |id: &String| all.iter().any(|o| o.id == *id);
        // A guide that is gone is replaced by the copy that the object carries.
        let gone = !referred.iter().all(is_there);
        let guides = match members.first() {
            Some(m) if gone => m.object.guides.clone(),
            _ => Guides::of(&svg, &referred, &stage.limits())?,
        };
        let copies = temporary(guides.file().as_bytes())?;
        let run = elsewhere(line.clone(), &copies, |id| !is_there(id));
        let outcome = stage.warp(&svg, &run, &Scope { ids: &ids })?;
        stage.check(&svg, &outcome)?;
        let recipe = quoting::joined(&settled(stage, line, &outcome));
        svg = remembering(stage, &svg, &outcome.svg, &ids, &recipe, &guides)?;
    }
    as_by_hand(stage, &drawing, svg, &returned)
}

/// The warped objects that a selection means: those selected, else those inside, else those around.
fn targets(stage: &Stage<'_>, all: &[Object]) -> Result<Vec<String>, Failure> {
    let mut out: Vec<String> = Vec::new();
    let warped = || all.iter().filter(|o| o.recipe.is_some());
    for id in &stage.call.ids {
        let itself = warped().find(|o| o.id == *id).map(|o| vec![o.id.clone()]);
        // Of nested ones, the outer holds the inner in its source.
        let inside = || {
            let outer = warped().filter(|o| o.inside.contains(id));
            let ids: Vec<String> =
                outer.filter(|o| !warped().any(|p| o.inside.contains(&p.id))).map(|o| o.id.clone()).collect();
            (!ids.is_empty()).then_some(ids)
        };
        let around = || {
            let own = all.iter().find(|o| o.id == *id)?;
            let found = own.inside.iter().find(|i| warped().any(|o| o.id == **i))?;
            Some(vec![found.clone()])
        };
        out.extend(itself.or_else(inside).or_else(around).unwrap_or_default());
    }
    let mut seen = HashSet::new();
    out.retain(|id| seen.insert(id.clone()));
    // Objects inside another one come back with it.
    let chosen = out.clone();
    out.retain(|id| !all.iter().any(|o| o.id == *id && o.inside.iter().any(|i| chosen.contains(i))));
    if out.is_empty() {
        let what =
            if stage.call.ids.is_empty() { "nothing is selected" } else { "the selected objects were not warped" };
        return Err(Failure::usage(format!("{what}; select objects that one of these effects has warped")));
    }
    Ok(out)
}

/// The settings of warped objects, for people.
fn settings(all: &[Object], ids: &[String]) -> String {
    let one = |o: &Object| {
        let line = quoting::split(o.recipe.as_deref().unwrap_or_default());
        let (name, rest) = line.split_first().map_or(("", &[][..]), |(n, r)| (n.as_str(), r));
        let values = rest.iter().map(|w| {
            let Some(w) = w.strip_prefix("--") else { return format!("\n{w}") };
            if w.contains('=') { format!("\n{w}") } else { format!("\n{w}=true") }
        });
        format!("{} ({name}):{}\n", o.label.as_ref().unwrap_or(&o.id), values.collect::<String>())
    };
    all.iter().filter(|o| ids.contains(&o.id)).map(one).collect::<Vec<_>>().join("\n")
}
