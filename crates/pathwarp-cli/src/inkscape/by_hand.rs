//! Bends objects by hand: opens the editor on them, and converts its steps to words of a command line.

use super::line::{exclusions, option_name, referred, with_resulting_frame};
use super::names::{CHAIN, joined, split};
use super::restoring::{Restoration, restore, with_changes_by_hand, with_sources};
use super::stage::{Scope, Stage, folder};
use crate::watch;
use pathwarp::recipe::Recipe;
use pathwarp_editor::{EngineHost, Options, Purpose, selectors};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::{Given, OPTIONS};
use pathwarp_engine::steps::INVERSE;
use pathwarp_engine::temporaries::Temporary;
use pathwarp_svg::objects::{Guides, Object, objects};
use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;

/// The option for objects without a warp, as in the dialogs.
const USUAL: &str = "--clones=follow";

/// Opens the editor on the selected objects, or else on all, and warps them by the steps that the user confirms. Returns the new drawing,
/// without an earlier warp if there are no steps, or an empty text if the user confirms nothing.
pub(super) fn by_hand(stage: &Stage<'_>) -> Result<String, Failure> {
    let drawing = stage.drawing()?;
    let all = objects(&drawing, &stage.limits())?;
    let takes_all = stage.call.ids.is_empty();
    let is_chosen = |o: &&Object| match takes_all {
        true => o.is_top && !o.is_locked,
        false => stage.call.ids.contains(&o.id),
    };
    let artwork: Vec<String> = all.iter().filter(is_chosen).map(|o| o.id.clone()).collect();
    if artwork.is_empty() {
        return Err(Failure::usage("there is nothing to bend in the drawing"));
    }
    let earlier = common_recipe(&all, &artwork);
    // Objects whose nodes were moved by hand since their warp cannot be restored without loss, and are bent as they are.
    let discard = false;
    let (Restoration { svg, objects: restored }, earlier) =
        match restore(stage, &drawing, if earlier.is_some() { &artwork } else { &[] }, discard) {
            Ok(restoration) => (restoration, earlier),
            Err(_) => (restore(stage, &drawing, &[], discard)?, None),
        };

    let mut options = earlier.as_ref().map_or_else(|| vec![USUAL.to_owned()], |line| options_of(line));
    if takes_all && earlier.is_none() {
        options.extend(exclusions(&all));
    }
    let scope = Scope { ids: if takes_all { &[] } else { &artwork } };
    let opened = match &earlier {
        // The editor opens a result that contains its source and recipe with its steps.
        Some(line) => stage.warp(&svg, &[&line[..], &["--embed-recipe".to_owned()]].concat(), &scope, None)?.svg,
        None => svg.clone(),
    };
    let Some(recipe) = edit(stage, &opened, &options, &scope)? else { return Ok(String::new()) };
    if recipe.steps.is_empty() {
        return Ok(svg);
    }
    let line = [words_of(stage, &recipe), options].concat();
    let outcome = stage.warp(&svg, &line, &scope, None)?;
    stage.report_left_out(&svg, &outcome)?;
    let guides = Guides::of(&svg, &referred(&line), &stage.limits())?;
    let recipe = joined(&with_resulting_frame(stage, line, &outcome));
    let result = with_sources(stage, &svg, &outcome.svg, &artwork, &recipe, &guides)?;
    with_changes_by_hand(stage, &drawing, result, &restored)
}

/// Returns the recipe of these objects, if all have the same and its guides still exist.
fn common_recipe(all: &[Object], ids: &[String]) -> Option<Vec<String>> {
    let mut recipes = all.iter().filter(|o| ids.contains(&o.id)).map(|o| o.recipe.as_ref());
    let first = recipes.next()??;
    let line = split(first);
    let is_there = |id: &String| all.iter().any(|o| o.id == *id);
    (recipes.all(|r| r == Some(first)) && referred(&line).iter().all(is_there)).then_some(line)
}

/// Opens the editor on a drawing. Returns the steps that the user confirms; `None` if the user cancels.
fn edit(stage: &Stage<'_>, svg: &str, options: &[String], scope: &Scope<'_>) -> Result<Option<Recipe>, Failure> {
    let mut given = Given::default();
    let mut set = |name: &str, value: &str| given.set(name, value).map_err(Failure::Usage);
    for word in options {
        let option = word.trim_start_matches("--");
        let (name, value) = option.split_once('=').unwrap_or((option, "true"));
        set(name, value)?;
    }
    for id in scope.ids {
        set("select", &format!("[id={id}]"))?;
    }
    if let Some(folder) = folder() {
        set("base-dir", &folder.display().to_string())?;
    }
    let file = temporary(svg.as_bytes())?;
    let document = std::env::var_os("DOCUMENT_PATH").filter(|p| !p.is_empty());
    let name = document.and_then(|p| Some(Path::new(&p).file_name()?.to_string_lossy().into_owned()));
    let drawing = name.unwrap_or_else(|| "Drawing".into());
    let options = Options {
        file: file.path().to_owned(),
        purpose: Purpose::Program { name: "Inkscape".into(), drawing },
        port: None,
        open: true,
    };
    let host = Arc::new(EngineHost::new(stage.registry.clone(), Given::default().keeping_pages(), given));
    watch::pause();
    pathwarp_editor::serve(host, &options, |_| ()).map_err(Failure::Input)
}

/// Converts a recipe's steps to words of a command line.
fn words_of(stage: &Stage<'_>, recipe: &Recipe) -> Vec<String> {
    let mut line = Vec::new();
    for step in &recipe.steps {
        if !line.is_empty() {
            line.push(CHAIN.to_owned());
        }
        line.push(step.deformation.clone());
        let params = stage.registry.get(&step.deformation).map_or(&[][..], |e| e.info().params);
        let word = |(name, value): (&str, Option<&str>)| match value {
            Some(value) => format!("--{name}={value}"),
            None => format!("--{name}"),
        };
        line.extend(step.options(params).map(word));
        if step.inverse {
            line.push(format!("--{INVERSE}"));
        }
        line.extend(selectors(recipe, step).map(|(name, selector)| format!("--{name}={selector}")));
    }
    line
}

/// Returns the common options among the words of a recipe.
fn options_of(line: &[String]) -> Vec<String> {
    let is_option = |word: &&String| OPTIONS.iter().any(|o| option_name(word) == Some(o.name));
    line.iter().filter(is_option).cloned().collect()
}

/// Creates a temporary file with this content.
fn temporary(content: &[u8]) -> Result<Temporary, Failure> {
    let folder = std::env::temp_dir();
    let failed = |e: std::io::Error| Failure::output(&folder, format!("a temporary file cannot be written: {e}"));
    let (temporary, mut file) = Temporary::create_in(&folder).map_err(failed)?;
    file.write_all(content).map_err(failed)?;
    Ok(temporary)
}
