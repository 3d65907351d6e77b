//! The command line that has the same effect as the steps.

use pathwarp::deform::Registry;
use pathwarp::recipe::{Recipe, Step};
use pathwarp_engine::catalogue::Catalogue as _;
use std::fmt::Write as _;
use std::path::Path;

/// Returns the command line, for a POSIX shell, that bends `source` by the recipe into `out` with these common options (flags: no value).
pub(crate) fn command_line(
    registry: &Registry,
    recipe: &Recipe,
    options: &[(String, String)],
    source: &Path,
    out: &Path,
) -> String {
    let mut line = "pathwarp".to_owned();
    for (i, step) in recipe.steps.iter().enumerate() {
        let first = i == 0;
        let _ = write!(line, "{} {}", if first { "" } else { " +" }, step.deformation);
        if first {
            let _ = write!(line, " {}", quoted(&source.display().to_string()));
        }
        let params = registry.info(&step.deformation).map_or(&[][..], |info| info.params);
        for (name, value) in step.options(params) {
            let _ = write!(line, " --{name}");
            if let Some(value) = value {
                let _ = write!(line, " {}", quoted(value));
            }
        }
        if step.inverse {
            line.push_str(" --inverse");
        }
        for (name, selector) in selectors(recipe, step) {
            let _ = write!(line, " --{name} {}", quoted(selector));
        }
        if first {
            for (name, value) in options {
                let _ = write!(line, " --{name}");
                if !value.is_empty() {
                    let _ = write!(line, " {}", quoted(value));
                }
            }
            let _ = write!(line, " -o {}", quoted(&out.display().to_string()));
        }
    }
    line
}

/// Returns the options `select` and `exclude` for a step. In a chain, steps for the whole drawing select it explicitly, because the
/// selection of a single part applies to all.
pub fn selectors<'a>(recipe: &'a Recipe, step: &'a Step) -> impl Iterator<Item = (&'static str, &'a str)> {
    let of_all = step.select.is_empty() && recipe.steps.iter().any(|s| !s.select.is_empty());
    let select = step.select.iter().map(String::as_str).chain(of_all.then_some("svg"));
    select.map(|s| ("select", s)).chain(step.exclude.iter().map(|s| ("exclude", s.as_str())))
}

/// Quotes a word for a shell.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-,:%+=@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::param::Args;

    #[test]
    fn chains_flags_and_quotes() {
        let step = |name: &str, pairs: &[(&str, &str)]| Step::new(name, Args::from_pairs(pairs));
        let recipe = Recipe {
            steps: vec![
                step("warp", &[("style", "flag"), ("bend", "-40%")]),
                Step { inverse: true, ..step("shaper", &[("reverse-shaper", "true"), ("shaper", "M0,0 H9")]) },
            ],
        };
        let options = [("fit".to_owned(), "page".to_owned())];
        let line = command_line(&Registry::builtin(), &recipe, &options, Path::new("it's.svg"), Path::new("out.svg"));
        let expected = r"pathwarp warp 'it'\''s.svg' --bend -40% --style flag --fit page -o out.svg + shaper --reverse-shaper --shaper 'M0,0 H9' --inverse";
        assert_eq!(line, expected);
    }

    #[test]
    fn steps_for_parts_are_told_from_those_for_all() {
        let step = |select: &[&str]| Step {
            select: select.iter().map(|s| (*s).to_owned()).collect(),
            ..Step::new("wave", Args::new())
        };
        let line = |steps: Vec<Step>| {
            command_line(&Registry::builtin(), &Recipe { steps }, &[], Path::new("a.svg"), Path::new("b.svg"))
        };
        assert_eq!(
            line(vec![step(&[".a"]), step(&[])]),
            "pathwarp wave a.svg --select .a -o b.svg + wave --select svg"
        );
        assert_eq!(line(vec![step(&[]), step(&[])]), "pathwarp wave a.svg -o b.svg + wave");
    }
}
