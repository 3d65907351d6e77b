//! Divides the selection into guides and artwork.

use super::line::{option_name, word};
use super::names::{AUTOMATIC, GUIDES};
use super::stage::Call;
use pathwarp::deform::Info;
use pathwarp::param::{Kind, Param};
use pathwarp_engine::failure::Failure;
use pathwarp_svg::objects::Object;
use std::collections::HashSet;

/// Labels that mark the first guide of any deformation.
const LABELS: [&str; 3] = ["cage", "skeleton", "guide"];

/// A selection divided into guides and artwork.
pub(super) struct Sorted {
    /// The parameters that take guides, with the guides' ids.
    pub(super) guides: Vec<(&'static str, String)>,
    /// The ids of the objects to warp, without guides in them.
    pub(super) artwork: Vec<String>,
}

impl Sorted {
    /// Returns the words of a command line that name the guides.
    pub(super) fn words(&self) -> impl Iterator<Item = String> {
        self.guides.iter().map(|(param, id)| word(param, &format!("#{id}")))
    }
}

/// Divides the selection of a call. `given` has the words for the deformation's parameters from the dialog.
pub(super) fn divide(info: &Info, objects: &[Object], call: &Call, given: &[String]) -> Result<Sorted, Failure> {
    let is_given = |p: &Param| given.iter().any(|word| option_name(word) == Some(p.name));
    let open: Vec<&Param> = info.params.iter().filter(|p| p.kind == Kind::Path && !is_given(p)).collect();
    let selected: Vec<&Object> = objects.iter().filter(|o| call.ids.contains(&o.id)).collect();
    let everything = || objects.iter().filter(|o| o.is_top && !o.is_locked).collect();
    let artwork: Vec<&Object> = if call.ids.is_empty() { everything() } else { selected.clone() };

    let mut guides = labelled(info, &open, objects, &selected);
    let wanted = match call.value(GUIDES) {
        None | Some(AUTOMATIC) => None,
        Some(n) => Some(n.parse::<usize>().map_err(|_| Failure::usage(format!("`{n}` is not a number of guides")))?),
    };
    // A path, a file or points given in the dialog replace guides.
    let has_alternative = || info.params.iter().any(|p| is_alternative(p) && is_given(p));
    let count = wanted.unwrap_or(if guides.is_empty() && !has_alternative() { info.guides.usual } else { 0 });
    let is_selected = |o: &Object| (call.ids.is_empty() && !o.is_locked) || call.ids.contains(&o.id);
    let mut paths: Vec<&Object> = objects.iter().filter(|o| o.is_path && is_selected(o)).collect();
    paths.retain(|o| !guides.iter().any(|(_, id)| *id == o.id));
    // At least one object must remain to be warped.
    let spare = if call.ids.is_empty() { paths.len() } else { artwork.len() }.saturating_sub(1);
    let count = count.min(paths.len()).min(spare);
    if wanted.is_some() || count >= info.guides.usual {
        let topmost = paths.iter().rev().take(count);
        let free = info.guides.params.iter().filter(|name| open.iter().any(|p| p.name == **name));
        let free: Vec<&'static str> = free.filter(|name| !guides.iter().any(|(p, _)| p == *name)).copied().collect();
        guides.extend(free.into_iter().zip(topmost.map(|o| o.id.clone())));
    }
    // A deformation that usually has a guide needs one, unless the dialog gives an alternative.
    let usual = info.guides.params.first().filter(|_| info.guides.usual > 0 && wanted.is_none() && !has_alternative());
    let is_needed = |p: &Param| p.needed || (p.default.is_none() && usual == Some(&p.name));
    if let Some(p) = open.iter().find(|p| is_needed(p) && !guides.iter().any(|(name, _)| *name == p.name)) {
        return Err(missing_guide(p, call));
    }
    let ids: HashSet<&str> = guides.iter().map(|(_, id)| id.as_str()).collect();
    let artwork = without(objects, &artwork.iter().map(|o| o.id.as_str()).collect::<Vec<_>>(), &ids);
    if artwork.is_empty() {
        return Err(Failure::usage("there is no artwork beside the guides; select that, too"));
    }
    Ok(Sorted { guides, artwork })
}

/// Finds paths whose label or id is a parameter's name or, for the first guide, one of the general labels. Selected ones take precedence.
fn labelled(info: &Info, open: &[&Param], objects: &[Object], selected: &[&Object]) -> Vec<(&'static str, String)> {
    let first = info.guides.params.first();
    let is_labelled = |o: &Object, p: &Param| {
        let has = |name: &str| o.label.as_deref().is_some_and(|l| l.eq_ignore_ascii_case(name)) || o.id == name;
        has(p.name) || (first == Some(&p.name) && LABELS.iter().any(|label| has(label)))
    };
    let find = |p: &&Param| {
        let mut all = selected.iter().rev().copied().chain(objects.iter().rev());
        Some((p.name, all.find(|o| o.is_path && is_labelled(o, p))?.id.clone()))
    };
    open.iter().filter_map(find).collect()
}

/// Returns `true` for a parameter without a default that gives positions.
fn is_alternative(p: &Param) -> bool {
    let has_positions = matches!(p.kind, Kind::Path | Kind::File | Kind::Point | Kind::Numbers(_) | Kind::Choice(_));
    p.default.is_none() && (p.repeat || has_positions)
}

/// Returns the failure that a parameter lacks its guide.
fn missing_guide(p: &Param, call: &Call) -> Failure {
    let advice =
        if call.ids.is_empty() { "put it above the artwork" } else { "select it together with the artwork, above it" };
    let name = p.name;
    let help = p.help.split(". ").next().unwrap_or(p.help).trim_end_matches('.');
    Failure::usage(format!("this effect needs a path, --{name} ({help}): {advice}, or label it `{name}`"))
}

/// Removes guides from objects; an object that contains a guide is replaced by its other children.
fn without(objects: &[Object], ids: &[&str], guides: &HashSet<&str>) -> Vec<String> {
    let mut out = Vec::new();
    for &id in ids {
        if guides.contains(id) {
            continue;
        }
        let holds = |g: &str| objects.iter().any(|o| o.id == g && o.inside.iter().any(|i| i == id));
        if guides.iter().any(|g| holds(g)) {
            let children = objects.iter().filter(|o| o.inside.first().is_some_and(|p| p == id));
            out.extend(without(objects, &children.map(|o| o.id.as_str()).collect::<Vec<_>>(), guides));
        } else {
            out.push(id.to_owned());
        }
    }
    out
}
