//! The deformations with their parameters as a page needs them: everything follows from the registry's tables.

use crate::openings::variants;
use pathwarp::deform::{Info, Registry};
use pathwarp::param::{Axis, Kind, Param};
use serde_json::{Value, json};

/// Names for people who bend by hand; the registry's own are those of the command line. Others are shown as they are.
const LABELS: [(&str, &str); 15] = [
    ("shaper", "Cage"),
    ("warp", "Style"),
    ("wordart", "Text shape"),
    ("bilinear", "Four corners"),
    ("birational", "Two rows"),
    ("polar", "Ring"),
    ("ffd", "Grid"),
    ("triangle", "Triangle net"),
    ("mls", "Pins"),
    ("projective", "Perspective"),
    ("anamorph", "Anamorphosis"),
    ("mobius", "Möbius"),
    ("expr", "Formula"),
    ("similitude", "Turn and scale"),
    ("affine", "Transform"),
];

/// Paths with a fixed number of points, by deformation and parameter; others, such as skeletons, may have any number.
const FIXED: [(&str, &str); 9] = [
    ("shaper", "shaper"),
    ("shaper", "net"),
    ("shaper", "base"),
    ("shaper", "target"),
    ("mesh", "net"),
    ("bilinear", "target"),
    ("projective", "target"),
    ("projective", "base"),
    ("similitude", "target"),
];
/// A parameter that takes the place of others.
struct Instead {
    deformation: &'static str,
    param: &'static str,
    /// Those that cannot go with it.
    others: &'static [&'static str],
    /// The value of another one that goes with it, unless the user gives one.
    with: Option<(&'static str, &'static str)>,
}

const INSTEAD: [Instead; 3] = [
    // A file's own region is in the units of the drawing that it was made for.
    Instead { deformation: "mesh", param: "mesh", others: &["net", "psd"], with: Some(("region", "artwork")) },
    Instead { deformation: "mesh", param: "psd", others: &["net", "mesh"], with: None },
    Instead { deformation: "ffd", param: "lattice", others: &["degree"], with: None },
];
/// Names of parameters for people, where the registry's own could be taken for something else.
const PARAM_LABELS: [(&str, &str, &str); 4] = [
    ("warp", "horizontal", "Distort horizontally"),
    ("warp", "vertical", "Distort vertically"),
    ("mesh", "mesh", "File of points"),
    ("mesh", "psd", "Photoshop file"),
];
/// The deformation whose rows have equally many points, which are control points of one curve each.
const ROWS: &str = "birational";

/// Describes all deformations, in menu order. `foreign` are names in other programs, with the deformation that each means.
pub(crate) fn catalogue(registry: &Registry, foreign: &[(&str, &str)]) -> Value {
    let described = |info: &Info| {
        let mut out = deformation(info);
        out["knownAs"] =
            foreign.iter().filter(|(w, name)| *name == info.name && !is_preset(info, w)).map(|(w, _)| *w).collect();
        out
    };
    registry.entries().iter().map(|e| described(e.info())).collect()
}

/// Returns `true` if a name of another program ends in that of a preset, which is found by its own.
fn is_preset(info: &Info, word: &str) -> bool {
    let presets = info.gallery.and_then(|g| info.params.iter().find(|p| p.name == g.presets));
    let Some(Kind::NameOrFile(names) | Kind::Choice(names)) = presets.map(|p| p.kind) else { return false };
    let last = word.rsplit('›').next().unwrap_or(word).trim().to_lowercase().replace(' ', "-");
    names.iter().any(|n| n.starts_with(&last))
}

fn deformation(info: &Info) -> Value {
    // A page writes no files but the result.
    let params = info.params.iter().filter(|p| p.kind != Kind::Save);
    json!({
        "name": info.name,
        "label": LABELS.iter().find(|(name, _)| *name == info.name).map(|(_, label)| label),
        "title": info.title,
        "group": info.group,
        "about": info.about,
        "params": params.map(|p| param(info, p)).collect::<Value>(),
        "variants": variants(info.name).map(|v| json!({ "label": v.label, "param": v.param })).collect::<Value>(),
        "gallery": info.gallery.map(|g| json!({ "title": g.title, "presets": g.presets, "bend": g.bend, "axis": g.axis })),
    })
}

fn param(info: &Info, p: &Param) -> Value {
    let mut out = json!({
        "name": p.name,
        "kind": kind(p.kind),
        "needed": p.needed,
        "repeat": p.repeat,
        "help": p.help,
        "slider": [p.ui.0, p.ui.1],
    });
    match p.kind {
        Kind::Choice(words) | Kind::NameOrFile(words) => out["words"] = json!(words),
        Kind::Text(notation) => out["notation"] = json!(notation),
        Kind::Numbers(n) => out["count"] = json!(n),
        Kind::Length(axis) => out["axis"] = json!(axis_word(axis)),
        Kind::Path if info.name == ROWS => out["points"] = json!("rows"),
        Kind::Path if !FIXED.contains(&(info.name, p.name)) => out["points"] = json!("any"),
        _ => {}
    }
    if let Some((.., label)) = PARAM_LABELS.iter().find(|(d, name, _)| (*d, *name) == (info.name, p.name)) {
        out["label"] = json!(label);
    }
    if let Some(i) = INSTEAD.iter().find(|i| (i.deformation, i.param) == (info.name, p.name)) {
        out["instead"] = json!({ "others": i.others, "with": i.with });
    }
    if let Some(default) = p.default {
        out["default"] = json!(default);
    }
    for (key, limit) in [("least", p.range.0), ("most", p.range.1)] {
        if limit.is_finite() {
            out[key] = json!(limit);
        }
    }
    out
}

fn axis_word(axis: Axis) -> &'static str {
    match axis {
        Axis::X => "x",
        Axis::Y => "y",
        Axis::Diagonal => "diagonal",
    }
}

/// The kind as the page knows it: a file that is saved is chosen like one that is read.
fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::NameOrFile(_) => "name",
        Kind::Save => Kind::File.name(),
        other => other.name(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_deformation_and_parameter_is_there() {
        let registry = Registry::builtin();
        let all = catalogue(&registry, &[("Puppet Warp", "mls"), ("Warp › Arch", "warp"), ("Make with Warp", "warp")]);
        let of = |name: &str| all.as_array().unwrap().iter().find(|d| d["name"] == name).unwrap()["knownAs"].clone();
        assert_eq!([of("mls"), of("warp"), of("bend")], [json!(["Puppet Warp"]), json!(["Make with Warp"]), json!([])]);
        for (entry, shown) in registry.entries().iter().zip(all.as_array().unwrap()) {
            let info = entry.info();
            assert_eq!(shown["name"], info.name);
            let names: Vec<_> =
                shown["params"].as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap()).collect();
            let expected: Vec<_> = info.params.iter().filter(|p| p.kind != Kind::Save).map(|p| p.name).collect();
            assert_eq!(names, expected);
        }
        for (name, param) in FIXED {
            let params = registry.get(name).map(|e| e.info().params).unwrap_or_default();
            assert!(params.iter().any(|p| p.name == param && p.kind == Kind::Path), "{name} {param}");
        }
        let named = PARAM_LABELS.iter().map(|(name, param, _)| (*name, *param)).chain(INSTEAD.iter().flat_map(|i| {
            let others = i.others.iter().copied().chain([i.param]).chain(i.with.map(|(param, _)| param));
            others.map(|param| (i.deformation, param))
        }));
        for (name, param) in named {
            let params = registry.get(name).map(|e| e.info().params).unwrap_or_default();
            assert!(params.iter().any(|p| p.name == param), "{name} {param}");
        }
        assert!(registry.get(ROWS).is_some());
        for (name, _) in LABELS {
            assert!(registry.get(name).is_some(), "{name}");
        }
        assert_eq!(all.as_array().unwrap().len(), registry.entries().len());
    }
}
