//! Calls by Inkscape, which starts the program for every effect with ids, parameters and the drawing's file: `--id=path1
//! --inkscape-deformation=warp --bend_percent=40 … /tmp/ink_ext_XXXXXX.svg`. The result goes to standard output; text on standard error
//! opens a window.
//!
//! A call is converted to the words of an ordinary command line (`line.rs`), which are applied to the drawing in memory (`stage.rs`).

mod by_hand;
mod guides;
pub(crate) mod inx;
mod line;
mod names;
mod restoring;
mod stage;

use crate::ending::Status;
use crate::plugins;
use guides::divide;
use line::{
    change, check_recipe, exclusions, referred, with_ids, with_resulting_frame, without_missing, words_of_deformation,
    words_of_options,
};
use names::{ADD, AGAIN, CHAIN, CHANGES, DISCARD, REPLACE, SHOW, is_job, joined, split};
use pathwarp::deform::Registry;
use pathwarp_engine::advice::{self, Flags};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::{output, readable};
use pathwarp_svg::objects::{self, Guides, Object, objects};
use restoring::{Restoration, Restored, restore, with_changes_by_hand, with_sources};
use stage::{Call, Convert, GuidePaths, Job, Scope, Stage};
use std::collections::{BTreeMap, HashSet};
use std::ffi::OsString;

/// Returns `true` if Inkscape started the program.
pub(crate) fn is_call(args: &[OsString]) -> bool {
    args.iter().skip(1).any(|a| is_job(&a.to_string_lossy()))
}

/// Executes a call by Inkscape.
pub(crate) fn run(registry: &Registry, args: &[OsString], convert: Convert) -> Result<Status, Failure> {
    let call = Call::read(args)?;
    // A command that needs the same plug-ins: a recipe may name any deformation.
    let command = match &call.job {
        Job::Deformation(name) => name,
        Job::Edit | Job::EditByHand => "list",
        Job::Release | Job::Convert(_) => "convert",
    };
    let (_, plugins) = plugins::load(registry, &["pathwarp".into(), command.into()], &[])?;
    let stage = Stage { registry: &plugins.added_to(registry), convert, call: &call };
    let result = match &call.job {
        Job::Deformation(name) => warp(&stage, name),
        Job::Edit => edit_again(&stage),
        Job::Release => release(&stage),
        Job::EditByHand => by_hand::by_hand(&stage),
        Job::Convert(format) => return stage.convert(format).map_err(|f| in_a_window(&stage, &f)),
    };
    let svg = result.map_err(|f| in_a_window(&stage, &f))?;
    output::to_stdout(svg.as_bytes())?;
    Ok(Status::Complete)
}

/// Prepares a message for Inkscape's window: with the dialog's labels of parameters, and without the temporary file.
fn in_a_window(stage: &Stage<'_>, failure: &Failure) -> Failure {
    let plain = stage.without_file(failure);
    Failure::Input(inx::labelled(&plain.message(&Flags::of(stage.registry))))
}

/// Warps the selected objects. Returns the drawing.
fn warp(stage: &Stage<'_>, name: &str) -> Result<String, Failure> {
    let call = stage.call;
    let known = stage.registry.entries().iter().map(|e| e.info().name);
    let entry = stage.registry.get(name).ok_or_else(|| Failure::usage(advice::unknown("deformation", name, known)))?;
    let drawing = stage.drawing()?;
    let all = objects(&drawing, &stage.limits())?;
    let given = words_of_deformation(entry.info(), call);
    let chosen = divide(entry.info(), &all, call, &given)?;

    let mode = call.value(AGAIN).unwrap_or_default();
    let starts_again = |o: &&Object| {
        let is_of_this_kind = |recipe: &str| {
            // A recipe of several steps is of no one kind.
            let line = split(recipe);
            line.first().is_some_and(|w| w == name) && !line.iter().any(|w| w == CHAIN)
        };
        let is_replaced = |recipe: &str| mode == REPLACE || (mode != ADD && is_of_this_kind(recipe));
        chosen.artwork.contains(&o.id) && o.recipe.as_deref().is_some_and(is_replaced)
    };
    let again: Vec<String> = all.iter().filter(starts_again).map(|o| o.id.clone()).collect();
    let Restoration { svg, objects: restored } = restore(stage, &drawing, &again, call.is_on(DISCARD))?;

    let mut line: Vec<String> = std::iter::once(name.to_owned()).chain(given).chain(chosen.words()).collect();
    line = with_ids(line, &all);
    line.extend(words_of_options(call));
    // Without a selection, locked objects are excluded.
    let is_whole_page = call.ids.is_empty();
    if is_whole_page {
        line.extend(exclusions(&all));
    }
    let outcome = stage.warp(&svg, &line, &Scope { ids: if is_whole_page { &[] } else { &chosen.artwork } }, None)?;
    stage.report_left_out(&svg, &outcome)?;

    let guides = Guides::of(&svg, &referred(&line), &stage.limits())?;
    let recipe = joined(&with_resulting_frame(stage, line, &outcome));
    let result = with_sources(stage, &svg, &outcome.svg, &chosen.artwork, &recipe, &guides)?;
    with_changes_by_hand(stage, &drawing, result, &restored)
}

/// Replaces the selected objects by their sources. Returns the drawing.
fn release(stage: &Stage<'_>) -> Result<String, Failure> {
    let drawing = stage.drawing()?;
    let ids = warped_targets(stage, &objects(&drawing, &stage.limits())?)?;
    Ok(objects::restore(&drawing, &ids, &stage.limits())?.svg)
}

/// Warps the sources of the selected objects by their recipes, with changes. Returns the drawing, or nothing to only show settings.
fn edit_again(stage: &Stage<'_>) -> Result<String, Failure> {
    let call = stage.call;
    let drawing = stage.drawing()?;
    let all = objects(&drawing, &stage.limits())?;
    let ids = warped_targets(stage, &all)?;
    if call.is_on(SHOW) {
        anstream::eprintln!("{}", readable::safe_message(&settings(&all, &ids)));
        return Ok(String::new());
    }
    let Restoration { mut svg, objects: restored } = restore(stage, &drawing, &ids, call.is_on(DISCARD))?;
    let mut runs: BTreeMap<String, Vec<&Restored>> = BTreeMap::new();
    for r in &restored {
        let mut line = split(&r.object.recipe);
        change(&mut line, call.value(CHANGES).unwrap_or_default()).map_err(Failure::Usage)?;
        check_recipe(stage, &line)?;
        runs.entry(joined(&line)).or_default().push(r);
    }
    for (line, members) in runs {
        let line = without_missing(split(&line), &all);
        let ids: Vec<String> = members.iter().map(|r| r.object.id.clone()).collect();
        let referred = referred(&line);
        let is_there = |id: &String| all.iter().any(|o| o.id == *id);
        // If a guide is missing, the copies that the first object stores are the guides of all.
        let guides = match members.first() {
            Some(member) if !referred.iter().all(is_there) => member.object.guides.clone(),
            _ => Guides::of(&svg, &referred, &stage.limits())?,
        };
        let copies = GuidePaths { guides: &guides, has: &|id| !all.iter().any(|o| o.id == id) };
        let outcome = stage.warp(&svg, &line, &Scope { ids: &ids }, Some(&copies))?;
        stage.report_left_out(&svg, &outcome)?;
        let recipe = joined(&with_resulting_frame(stage, line, &outcome));
        svg = with_sources(stage, &svg, &outcome.svg, &ids, &recipe, &guides)?;
    }
    with_changes_by_hand(stage, &drawing, svg, &restored)
}

/// Returns the warped objects that a selection concerns: those selected, or else inside it, or else around it.
fn warped_targets(stage: &Stage<'_>, all: &[Object]) -> Result<Vec<String>, Failure> {
    let mut out: Vec<String> = Vec::new();
    let warped = || all.iter().filter(|o| o.recipe.is_some());
    for id in &stage.call.ids {
        let itself = warped().find(|o| o.id == *id).map(|o| vec![o.id.clone()]);
        // The source of an outer warped object includes the inner ones.
        let inside = || {
            let outermost = |o: &&Object| o.inside.contains(id) && !warped().any(|p| o.inside.contains(&p.id));
            let ids: Vec<String> = warped().filter(outermost).map(|o| o.id.clone()).collect();
            (!ids.is_empty()).then_some(ids)
        };
        let around = || {
            let object = all.iter().find(|o| o.id == *id)?;
            let container = object.inside.iter().find(|i| warped().any(|o| o.id == **i))?;
            Some(vec![container.clone()])
        };
        out.extend(itself.or_else(inside).or_else(around).unwrap_or_default());
    }
    let mut seen = HashSet::new();
    out.retain(|id| seen.insert(id.clone()));
    // The source of an outer object restores the objects inside of it.
    let chosen = out.clone();
    out.retain(|id| !all.iter().any(|o| o.id == *id && o.inside.iter().any(|i| chosen.contains(i))));
    if out.is_empty() {
        let is_empty = stage.call.ids.is_empty();
        let problem = if is_empty { "nothing is selected" } else { "the selected objects were not warped" };
        return Err(Failure::usage(format!("{problem}; select objects that one of these effects has warped")));
    }
    Ok(out)
}

/// Returns the settings of warped objects, for display.
fn settings(all: &[Object], ids: &[String]) -> String {
    let settings = |o: &Object| {
        let line = split(o.recipe.as_deref().unwrap_or_default());
        let (name, rest) = line.split_first().map_or(("", &[][..]), |(n, r)| (n.as_str(), r));
        let values = rest.iter().map(|w| {
            let Some(w) = w.strip_prefix("--") else { return format!("\n{w}") };
            if w.contains('=') { format!("\n{w}") } else { format!("\n{w}=true") }
        });
        format!("{} ({name}):{}\n", o.label.as_ref().unwrap_or(&o.id), values.collect::<String>())
    };
    all.iter().filter(|o| ids.contains(&o.id)).map(settings).collect::<Vec<_>>().join("\n")
}
