//! Recipes on command lines: options that may hold for single steps, and names typed in capitals.

use crate::options::Given;
use pathwarp::param::{Kind, Param};
use pathwarp::recipe::Step;

/// The switch that every deformation has.
pub const INVERSE: &str = "inverse";

/// Returns the field of a step that holds the values of an option.
pub(crate) type StepField = fn(&mut Step) -> &mut Vec<String>;

/// Options that apply to the whole chain if one part gives them, and else to the steps of each part that does.
pub const OF_STEPS: [(&str, StepField); 2] = [("select", |s| &mut s.select), ("exclude", |s| &mut s.exclude)];

/// Moves the selection of each part to its steps, if several parts have one.
pub fn assign<'a>(parts: impl IntoIterator<Item = (&'a mut [Step], &'a mut Given)>) {
    let mut parts: Vec<_> = parts.into_iter().collect();
    for (name, field) in OF_STEPS {
        if parts.iter().filter(|(_, options)| options.gives(name)).count() < 2 {
            continue;
        }
        for (steps, options) in &mut parts {
            let values = options.take(name);
            steps.iter_mut().for_each(|step| field(step).extend(values.iter().cloned()));
        }
    }
}

/// Replaces a value that differs from a known name only in case by that name.
pub fn as_known_name(p: &Param, value: &str) -> String {
    let (Kind::NameOrFile(names) | Kind::Choice(names)) = p.kind else { return value.to_owned() };
    names.iter().find(|n| n.eq_ignore_ascii_case(value)).copied().unwrap_or(value).to_owned()
}
