//! A recipe as the words of a command line: what it refers to, and the frame that makes it independent of the selection.

use super::names::CHAIN;
use super::stage::{Outcome, Stage};
use crate::advice;
use crate::failure::Failure;
use crate::input::split_reference;
use crate::options::OPTIONS;
use crate::steps::INVERSE;
use crate::temporaries::Temporary;
use pathwarp::param::{Kind, Param, is_inline};
use pathwarp::recipe::Recipe;
use pathwarp_editor::selectors;
use pathwarp_svg::objects::Object;

/// The words of a recipe's steps.
pub(super) fn words_of(stage: &Stage<'_>, recipe: &Recipe) -> Vec<String> {
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

/// The common options among the words of a recipe.
pub(super) fn options_of(line: &[String]) -> Vec<String> {
    let is_option = |word: &&String| {
        let own = word.strip_prefix("--").map(|w| w.split_once('=').map_or(w, |(name, _)| name));
        own.is_some_and(|name| OPTIONS.iter().any(|o| o.name == name))
    };
    line.iter().filter(is_option).cloned().collect()
}

/// Words that leave out what is locked.
pub(super) fn exclusions(all: &[Object]) -> impl Iterator<Item = String> {
    let outer = |o: &&Object| o.is_locked && !all.iter().any(|p| p.is_locked && o.inside.first() == Some(&p.id));
    all.iter().filter(outer).map(|o| format!("--exclude=[id={}]", o.id))
}

/// The recipe with the frame as it came out, so that it means the same for each object alone.
pub(super) fn settled(stage: &Stage<'_>, mut line: Vec<String>, outcome: &Outcome) -> Vec<String> {
    let Some([x, y, w, h]) = outcome.frame else { return line };
    line.retain(|word| !word.starts_with("--frame="));
    line.push(format!("--frame={x},{y},{w},{h}"));
    let info = line.first().and_then(|name| stage.registry.get(name)).map(|e| e.info());
    if let (Some(param), Some(at)) = (info.and_then(|i| i.baseline), outcome.baseline) {
        let own = format!("--{param}=");
        let first = line.iter().position(|word| word == CHAIN).unwrap_or(line.len());
        if !line.iter().take(first).any(|word| word.starts_with(&own)) {
            line.insert(first, format!("{own}{}", y + h - at));
        }
    }
    line
}

/// Checks a recipe, which may come from a drawing that somebody sent: it names deformations, sets parameters and options that shape the
/// result, and neither writes files nor reads other than regular ones.
pub(super) fn allowed(stage: &Stage<'_>, line: &[String]) -> Result<(), Failure> {
    line.split(|word| word == CHAIN).try_for_each(|step| step_allowed(stage, step))
}

fn step_allowed(stage: &Stage<'_>, line: &[String]) -> Result<(), Failure> {
    let name = line.first().map_or("", String::as_str);
    let known = stage.registry.entries().iter().map(|e| e.info().name);
    let entry = stage.registry.get(name).ok_or_else(|| Failure::usage(advice::unknown("deformation", name, known)))?;
    let params = entry.info().params;
    for word in line.iter().skip(1) {
        let own = word.strip_prefix("--").unwrap_or_default();
        let (option, value) = own.split_once('=').unwrap_or((own, ""));
        let param = params.iter().find(|p| p.name == option && p.kind != Kind::Save);
        if param.is_none() && !OPTIONS.iter().any(|o| o.name == option && o.stored) && option != INVERSE {
            let known: Vec<&str> = params.iter().map(|p| p.name).collect();
            return Err(Failure::usage(format!("{name} has no `{option}`; it has {}", known.join(", "))));
        }
        let is_file = || split_reference(value).0.is_file();
        let reads =
            |p: &Param| p.reads_file(value) || p.kind == Kind::Path && !value.starts_with('#') && !is_inline(value);
        if param.is_some_and(reads) && !is_file() {
            return Err(Failure::usage(format!("--{option}: there is no file `{value}`")));
        }
    }
    Ok(())
}

/// Ids that a recipe refers to as `--name=#id`.
pub(super) fn referred(line: &[String]) -> Vec<String> {
    let target = |w: &String| w.split_once("=#").map(|(_, id)| id.to_owned());
    line.iter().filter_map(target).collect()
}

/// A recipe with labels of paths replaced by their ids, which are unique.
pub(super) fn by_id(line: Vec<String>, all: &[Object]) -> Vec<String> {
    let one = |w: String| {
        let Some((name, label)) = w.split_once("=#").filter(|(_, l)| !all.iter().any(|o| o.id == *l)) else { return w };
        let named = all.iter().find(|o| o.is_path && o.label.as_deref() == Some(label));
        named.map_or_else(|| w.clone(), |o| format!("{name}=#{}", o.id))
    };
    line.into_iter().map(one).collect()
}

/// A recipe without exclusions of what is not in the drawing any more.
pub(super) fn existing(mut line: Vec<String>, all: &[Object]) -> Vec<String> {
    line.retain(|w| {
        let id = w.strip_prefix("--exclude=[id=").and_then(|w| w.strip_suffix(']'));
        id.is_none_or(|id| all.iter().any(|o| o.id == id))
    });
    line
}

/// A recipe with references to paths in a file, for those whose ids satisfy a condition.
pub(super) fn elsewhere(line: Vec<String>, file: &Temporary, condition: impl Fn(&String) -> bool) -> Vec<String> {
    let file = file.path().display().to_string();
    let one = |w: String| match w.split_once("=#") {
        Some((name, id)) if condition(&id.to_owned()) => format!("{name}={file}#{id}"),
        _ => w,
    };
    line.into_iter().map(one).collect()
}
