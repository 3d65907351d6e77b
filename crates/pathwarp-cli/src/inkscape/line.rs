//! Recipes as words of a command line: their references, and the frame that makes them independent of the selection.

use super::names::{CHAIN, FILE, NONE, PERCENT, UNIT, UNITS};
use super::stage::{Call, Outcome, Stage};
use pathwarp::deform::Info;
use pathwarp::param::{Kind, Param};
use pathwarp_engine::advice;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::input::split_reference;
use pathwarp_engine::options::{CommonOption, OPTIONS};
use pathwarp_engine::references::{self, HERE};
use pathwarp_engine::steps::INVERSE;
use pathwarp_svg::objects::Object;

/// Returns the words that exclude locked objects.
pub(super) fn exclusions(all: &[Object]) -> impl Iterator<Item = String> {
    let outer = |o: &&Object| o.is_locked && !all.iter().any(|p| p.is_locked && o.inside.first() == Some(&p.id));
    all.iter().filter(outer).map(|o| format!("--exclude=[id={}]", o.id))
}

/// Adds the resulting frame to a recipe, so that the recipe has the same effect on each object alone.
pub(super) fn with_resulting_frame(stage: &Stage<'_>, mut line: Vec<String>, outcome: &Outcome) -> Vec<String> {
    let Some([x, y, w, h]) = outcome.frame else { return line };
    line.retain(|word| !word.starts_with("--frame="));
    line.push(format!("--frame={x},{y},{w},{h}"));
    let info = line.first().and_then(|name| stage.registry.get(name)).map(|e| e.info());
    if let (Some(param), Some(baseline)) = (info.and_then(|i| i.baseline), outcome.baseline) {
        let option = format!("--{param}=");
        let end_of_step = line.iter().position(|word| word == CHAIN).unwrap_or(line.len());
        if !line.iter().take(end_of_step).any(|word| word.starts_with(&option)) {
            line.insert(end_of_step, format!("{option}{}", y + h - baseline));
        }
    }
    line
}

/// Checks a recipe, which may come from somebody else's drawing: it names deformations, sets parameters and options that shape the result,
/// writes no files, and reads only regular ones.
pub(super) fn check_recipe(stage: &Stage<'_>, line: &[String]) -> Result<(), Failure> {
    line.split(|word| word == CHAIN).try_for_each(|step| check_step(stage, step))
}

fn check_step(stage: &Stage<'_>, line: &[String]) -> Result<(), Failure> {
    let name = line.first().map_or("", String::as_str);
    let known = stage.registry.entries().iter().map(|e| e.info().name);
    let entry = stage.registry.get(name).ok_or_else(|| Failure::usage(advice::unknown("deformation", name, known)))?;
    let params = entry.info().params;
    for word in line.iter().skip(1) {
        let option = option_name(word).unwrap_or_default();
        let value = word.split_once('=').map_or("", |(_, value)| value);
        let param = params.iter().find(|p| p.name == option && p.kind != Kind::Save);
        if param.is_none() && !OPTIONS.iter().any(|o| o.name == option && o.stored) && option != INVERSE {
            let known: Vec<&str> = params.iter().map(|p| p.name).collect();
            return Err(Failure::usage(format!("{name} has no `{option}`; it has {}", known.join(", "))));
        }
        let is_file = || split_reference(value).0.is_file();
        let names_path = || references::names_file(value, HERE.as_ref());
        let reads = |p: &Param| p.reads_file(value) || (p.kind == Kind::Path && names_path());
        if param.is_some_and(reads) && !is_file() {
            return Err(Failure::usage(format!("--{option}: there is no file `{value}`")));
        }
    }
    Ok(())
}

/// Returns the ids that a recipe refers to as `--name=#id`.
pub(super) fn referred(line: &[String]) -> Vec<String> {
    let target = |w: &String| w.split_once("=#").map(|(_, id)| id.to_owned());
    line.iter().filter_map(target).collect()
}

/// Replaces labels of paths in a recipe by their ids, which are unique.
pub(super) fn with_ids(line: Vec<String>, all: &[Object]) -> Vec<String> {
    let by_id = |word: String| {
        let reference = word.split_once("=#").filter(|(_, name)| !all.iter().any(|o| o.id == *name));
        let Some((option, label)) = reference else { return word };
        let path = all.iter().find(|o| o.is_path && o.label.as_deref() == Some(label));
        path.map_or_else(|| word.clone(), |o| format!("{option}=#{}", o.id))
    };
    line.into_iter().map(by_id).collect()
}

/// Removes exclusions of objects that the drawing lacks from a recipe.
pub(super) fn without_missing(mut line: Vec<String>, all: &[Object]) -> Vec<String> {
    line.retain(|w| {
        let id = w.strip_prefix("--exclude=[id=").and_then(|w| w.strip_suffix(']'));
        id.is_none_or(|id| all.iter().any(|o| o.id == id))
    });
    line
}

/// Returns the words for the deformation's parameters: `--bend=40%`.
pub(super) fn words_of_deformation(info: &Info, call: &Call) -> Vec<String> {
    info.params.iter().flat_map(|p| values(p, call).into_iter().map(|v| word(p.name, &v))).collect()
}

/// Returns the words for the common options.
pub(super) fn words_of_options(call: &Call) -> Vec<String> {
    let given = |name: &str| call.value(name).filter(|v| *v != NONE);
    let set = OPTIONS.iter().filter_map(|o| Some((o, given(o.name)?)));
    // In Inkscape, pages stay unless a dialog chooses otherwise.
    let default = |o: &CommonOption| if o.name == "fit" { Some("none") } else { o.default };
    set.filter(|(o, v)| default(o) != Some(*v)).map(|(o, v)| word(o.name, v)).collect()
}

/// Returns the option's name in a word; `None` for other words.
pub(super) fn option_name(word: &str) -> Option<&str> {
    word.strip_prefix("--").map(|w| w.split_once('=').map_or(w, |(name, _)| name))
}

/// Returns the word for an option with its value.
pub(super) fn word(name: &str, value: &str) -> String {
    if value == "true" { format!("--{name}") } else { format!("--{name}={value}") }
}

/// Returns the values of a parameter as typed by a user.
fn values(p: &Param, call: &Call) -> Vec<String> {
    let plain = || call.value(p.name).filter(|v| *v != NONE);
    let value = match p.kind {
        Kind::Flag => return plain().filter(|v| *v == "true").map(ToOwned::to_owned).into_iter().collect(),
        Kind::Number => {
            let percent = call.value(&format!("{}{PERCENT}", p.name)).map(|v| format!("{}%", number(v)));
            percent.or_else(|| plain().map(number))
        }
        Kind::Length(_) => plain().map(|v| {
            let unit = call.value(&format!("{}{UNIT}", p.name));
            let unit = UNITS.iter().find(|(name, ..)| Some(*name) == unit).map_or("", |(_, unit, _)| unit);
            format!("{}{unit}", number(v))
        }),
        Kind::Angle | Kind::Count => plain().map(number),
        Kind::NameOrFile(_) => {
            let file = call.value(&format!("{}{FILE}", p.name));
            file.or_else(plain).map(ToOwned::to_owned)
        }
        // A path is named by its label or id, with or without `#`.
        Kind::Path => plain().map(reference),
        _ if p.repeat => return lines(plain().unwrap_or_default()),
        _ => plain().map(ToOwned::to_owned),
    };
    value.filter(|v| !p.default.is_some_and(|d| is_same(d, v))).into_iter().collect()
}

/// Removes trailing zeros, which Inkscape writes, from a number; other text stays.
fn number(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(v) if v.is_finite() => v.to_string(),
        _ => text.to_owned(),
    }
}

/// Returns `true` for equal texts or numbers.
fn is_same(default: &str, value: &str) -> bool {
    // The number and its unit.
    let split = |t: &str| {
        let (number, unit) = t.split_at(t.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '%').len());
        number.parse::<f64>().ok().map(|v| (v, unit.to_owned()))
    };
    default == value || (split(default).is_some() && split(default) == split(value))
}

/// Completes a path reference from a dialog: a name alone refers to a path of the drawing.
fn reference(text: &str) -> String {
    let is_name =
        !text.contains('#') && references::names_file(text, HERE.as_ref()) && !std::path::Path::new(text).is_file();
    if is_name { format!("#{text}") } else { text.to_owned() }
}

/// Splits the content of a text field into lines. Inkscape passes line ends literally or as `\n`.
fn lines(text: &str) -> Vec<String> {
    let text = text.replace("\\n", "\n");
    text.lines().map(str::trim).filter(|l| !l.is_empty()).map(ToOwned::to_owned).collect()
}

/// Changes a recipe: `bend=30%` sets a value, `bend=` removes it, in the first step that has the setting, or else in the first step.
///
/// # Errors
/// The message that a line, which it quotes, has another form.
pub(super) fn change(words: &mut Vec<String>, changes: &str) -> Result<(), String> {
    for line in lines(changes) {
        let (name, value) = line.split_once('=').ok_or_else(|| format!("`{line}` is not of the form name=value"))?;
        let (name, value) = (name.trim().trim_start_matches('-').replace(' ', "-").to_lowercase(), value.trim());
        let sets_it = |w: &String| option_name(w) == Some(&*name);
        let mut steps: Vec<Vec<String>> = words.split(|w| w == CHAIN).map(<[String]>::to_vec).collect();
        let i = steps.iter().position(|step| step.iter().any(sets_it)).unwrap_or(0);
        if let Some(step) = steps.get_mut(i) {
            // A new setting comes first after the deformation's name.
            let position = step.iter().position(sets_it).unwrap_or(step.len().min(1));
            step.retain(|w| !sets_it(w));
            if !(value.is_empty() || value == "false") {
                step.insert(position.min(step.len()), word(&name, value));
            }
        }
        *words = steps.join(&CHAIN.to_owned());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::deform::Registry;
    use std::ffi::OsString;

    fn call(args: &[&str]) -> Call {
        let all = ["pathwarp", "--inkscape-deformation=warp"].iter().chain(args).chain(&["f.svg"]);
        Call::read(&all.map(OsString::from).collect::<Vec<_>>()).ok().unwrap()
    }

    #[test]
    fn numbers_get_their_units_and_defaults_go() {
        let registry = Registry::builtin();
        let words = |name: &str, args: &[&str]| words_of_deformation(registry.get(name).unwrap().info(), &call(args));
        assert_eq!(
            words("warp", &["--tab=x", "--style=flag", "--bend_percent=40.000", "--horizontal_percent=0"]),
            ["--style=flag", "--bend=40%"]
        );
        assert!(words("warp", &["--style=arc", "--bend_percent=50"]).is_empty());
        assert_eq!(
            words("wave", &["--height=2.50", "--height_unit=mm", "--length=60", "--length_unit=percent"]),
            ["--height=2.5mm"]
        );
        assert_eq!(
            words("mls", &["--pin=1,2\n 3,4 ", "--pair=0,0:1,1\\n5,5:6,6"]),
            ["--pair=0,0:1,1", "--pair=5,5:6,6", "--pin=1,2", "--pin=3,4"]
        );
        assert_eq!(
            words("shaper", &["--shaper=cage", "--reverse-shaper=true", "--net="]),
            ["--shaper=#cage", "--reverse-shaper"]
        );
        assert_eq!(words_of_options(&call(&["--fit=grow", "--text=outline", "--tolerance="])), ["--fit=grow"]);
        assert_eq!(words_of_options(&call(&["--fit=auto"])), ["--fit=auto"]);
        assert!(words_of_options(&call(&["--fit=none"])).is_empty());
    }

    #[test]
    fn changes_replace_add_and_remove() {
        let mut words: Vec<String> = ["warp", "--style=flag", "--bend=40%"].map(ToOwned::to_owned).into();
        change(&mut words, "bend = 30%\nstyle=\nhorizontal=5%").unwrap();
        assert_eq!(words, ["warp", "--horizontal=5%", "--bend=30%"]);
        let mut chain: Vec<String> =
            ["wave", "+", "warp", "--bend=40%", "--frame=0,0,9,9"].map(ToOwned::to_owned).into();
        change(&mut chain, "bend=30%\nheight=2").unwrap();
        assert_eq!(chain, ["wave", "--height=2", "+", "warp", "--bend=30%", "--frame=0,0,9,9"]);
        assert!(change(&mut words, "bend 30").is_err());
    }
}
