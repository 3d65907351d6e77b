//! The command line with the same effect as the steps.

use pathwarp::deform::Registry;
use pathwarp::recipe::Recipe;
use std::fmt::Write as _;
use std::path::Path;

/// Writes the command line that bends `source` by the recipe into `out`, with these common options, for a POSIX shell.
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
        let params = registry.get(&step.deformation).map_or(&[][..], |e| e.info().params);
        for (name, value) in step.options(params) {
            let _ = write!(line, " --{name}");
            if let Some(value) = value {
                let _ = write!(line, " {}", quoted(value));
            }
        }
        if step.inverse {
            line.push_str(" --inverse");
        }
        let selectors = step.select.iter().map(|s| ("select", s)).chain(step.exclude.iter().map(|s| ("exclude", s)));
        for (name, selector) in selectors {
            let _ = write!(line, " --{name} {}", quoted(selector));
        }
        if first {
            for (name, value) in options {
                let _ = write!(line, " --{name} {}", quoted(value));
            }
            let _ = write!(line, " -o {}", quoted(&out.display().to_string()));
        }
    }
    line
}

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
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
    use pathwarp::recipe::Step;

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
}
