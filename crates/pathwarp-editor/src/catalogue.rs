//! The deformations with their parameters as a page needs them: everything follows from the registry's tables.

use pathwarp::deform::{Info, Registry};
use pathwarp::param::{Axis, Kind, Param};
use serde_json::{Value, json};

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
        "label": info.by_hand.label,
        "title": info.title,
        "group": info.group,
        "about": info.about,
        "params": params.map(|p| param(info, p)).collect::<Value>(),
        "variants": info.by_hand.variants.iter().map(|v| json!({ "label": v.label, "param": v.param })).collect::<Value>(),
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
        Kind::Path if info.by_hand.rows => out["points"] = json!("rows"),
        Kind::Path if !info.by_hand.fixed.contains(&p.name) => out["points"] = json!("any"),
        _ => {}
    }
    if let Some((_, label)) = info.by_hand.labels.iter().find(|(name, _)| *name == p.name) {
        out["label"] = json!(label);
    }
    if let Some(i) = info.by_hand.instead.iter().find(|i| i.param == p.name) {
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
        for info in registry.entries().iter().map(|e| e.info()) {
            let (hand, has) = (info.by_hand, |name: &str| info.params.iter().any(|p| p.name == name));
            let pairs = [hand.labels, hand.neutral, hand.showing].concat();
            let instead =
                hand.instead.iter().flat_map(|i| i.others.iter().copied().chain([i.param]).chain(i.with.map(|w| w.0)));
            let variants = hand.variants.iter().map(|v| v.param);
            let all =
                pairs.iter().map(|(name, _)| *name).chain(hand.fixed.iter().copied()).chain(instead).chain(variants);
            all.for_each(|name| assert!(has(name), "{} {name}", info.name));
        }
        assert_eq!(all.as_array().unwrap().len(), registry.entries().len());
    }
}
