//! Descriptions of the deformations and their parameters for the page, derived from the registry's tables.

use pathwarp::Outline;
use pathwarp::deform::{Gallery, Info, Registry};
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::param::{Args, Axis, Frame, Kind, Param, Settings, is_inline, shape_names};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Describes all deformations, in menu order, and then the edits. `foreign` pairs names in other programs with deformations.
pub(crate) fn catalogue(registry: &Registry, edits: &[Info], foreign: &[(&str, &str)]) -> Value {
    let described = |info: &Info| {
        let mut out = deformation(info);
        out["knownAs"] =
            foreign.iter().filter(|(w, name)| *name == info.name && !is_preset(info, w)).map(|(w, _)| *w).collect();
        out
    };
    let edits = edits.iter().map(|info| {
        let mut out = deformation(info);
        out["first"] = json!(true);
        out
    });
    registry.entries().iter().map(|e| described(e.info())).chain(edits).collect()
}

/// Returns `true` if another program's name ends in a preset's name, by which it is found already.
fn is_preset(info: &Info, word: &str) -> bool {
    let presets = info.gallery.and_then(|g| info.params.iter().find(|p| p.name == g.presets));
    let Some(Kind::NameOrFile(names) | Kind::Choice(names)) = presets.map(|p| p.kind) else { return false };
    let last = word.rsplit('›').next().unwrap_or(word).trim().to_lowercase().replace(' ', "-");
    names.iter().any(|n| n.starts_with(&last))
}

fn deformation(info: &Info) -> Value {
    // Presets of a path are offered as variants.
    let presets = |g: &Gallery| info.params.iter().any(|p| p.kind != Kind::Path && p.name == g.presets);
    // The page writes no file but the result.
    let params = info.params.iter().filter(|p| p.kind != Kind::Save);
    let variants = info.by_hand.variants.iter().map(|v| (v.label.to_owned(), v.param));
    let variants = variants.chain(shapes(info).map(|(label, param, _)| (label, param)));
    json!({
        "name": info.name,
        "label": info.by_hand.label,
        "title": info.title,
        "group": info.group,
        "about": info.about,
        "first": false,
        "knownAs": [],
        "params": params.map(|p| param(info, p)).collect::<Value>(),
        "variants": variants.map(|(label, param)| json!({ "label": label, "param": param })).collect::<Value>(),
        "gallery": info.gallery.filter(presets).map(|g| json!({ "title": g.title, "presets": g.presets, "bend": g.bend, "axis": g.axis })),
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

/// Returns the page's word for a kind. Files to save are chosen like files to read.
fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::NameOrFile(_) => "name",
        Kind::Save => Kind::File.name(),
        other => other.name(),
    }
}

/// Lists the named shapes that a deformation may begin with: a label, the parameter and the name.
fn shapes(info: &Info) -> impl Iterator<Item = (String, &'static str, &'static str)> {
    let presets = info.gallery.map(|g| g.presets);
    let param = presets.filter(|n| info.params.iter().any(|p| p.name == *n && p.kind == Kind::Path));
    let label = |name: &str| format!("{}{} shape", name[..1].to_uppercase(), &name[1..]);
    param.into_iter().flat_map(move |param| shape_names().iter().map(move |name| (label(name), param, *name)))
}

/// Returns the values of a variant for artwork in `frame`: values without effect, or an example. A shape becomes draggable path data.
pub(crate) fn variant_values(
    info: &Info,
    label: &str,
    frame: Rect,
    is_example: bool,
) -> Result<BTreeMap<String, Vec<String>>, String> {
    /// Distance of the curves from the shape's arcs, as a share of the frame's width.
    const ARC_TOLERANCE: f64 = 2e-4;
    if let Some(v) = info.by_hand.variants.iter().find(|v| v.label == label) {
        let value = fit_to_frame(if is_example { v.showing } else { v.neutral }, frame);
        return Ok(BTreeMap::from([(v.param.to_owned(), vec![value])]));
    }
    let shape = shapes(info).find(|s| s.0 == label);
    let (_, param, name) = shape.ok_or_else(|| format!("{} has no variant {label}", info.name))?;
    let args = Args::from_pairs(&[(param, name)]);
    let path = Settings::new(info.params, &args, &Frame::new(frame)).and_then(|s| s.path_if(param));
    let path = path.map_err(|e| e.to_string())?;
    // Convert arcs to curves with few nodes.
    let curves = path.map(|p| Outline::from(&p.outline.to_bez_path(ARC_TOLERANCE * frame.width())));
    Ok(curves.map(|c| (param.to_owned(), vec![crate::grips::path_data(&c)])).into_iter().collect())
}

/// Returns the first values of a deformation for artwork in `frame`.
pub(crate) fn opening_values(info: &Info, frame: Rect) -> BTreeMap<String, Vec<String>> {
    let mut out: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (param, value) in info.by_hand.neutral {
        let is_data = info.params.iter().any(|p| p.name == *param && is_path_data(p, value));
        let value = if is_data { fit_to_frame(value, frame) } else { (*value).to_owned() };
        out.entry((*param).to_owned()).or_default().push(value);
    }
    // A preset shows its effect by itself, so the first one serves.
    if let Some((gallery, p)) = info.gallery.and_then(|g| Some((g, info.params.iter().find(|p| p.name == g.presets)?)))
        && p.default.is_none()
        && let Kind::NameOrFile([first, ..]) = p.kind
    {
        out.insert(gallery.presets.to_owned(), vec![(*first).to_owned()]);
        return out;
    }
    if out.is_empty() && !shows_something(info) { example_values(info, frame) } else { out }
}

/// Returns values that show the effect of a deformation on artwork in `frame`.
pub(crate) fn example_values(info: &Info, frame: Rect) -> BTreeMap<String, Vec<String>> {
    if !info.by_hand.showing.is_empty() {
        return info.by_hand.showing.iter().map(|(param, v)| ((*param).to_owned(), vec![(*v).to_owned()])).collect();
    }
    let mut out: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (name, value) in info.demo {
        if let Some(p) = info.params.iter().find(|p| p.name == *name) {
            out.entry((*name).to_owned()).or_default().push(demo_value(p, value, frame));
        }
    }
    out
}

/// Returns `true` if the defaults alone build a map worth looking at: no parameter is needed, and at least one has a default.
fn shows_something(info: &Info) -> bool {
    let has_default = |p: &Param| p.default.is_some() && matches!(p.kind, Kind::Number | Kind::Length(_) | Kind::Angle);
    info.params.iter().all(|p| !p.needed) && info.params.iter().filter(|p| has_default(p)).count() > 1
}

fn is_path_data(p: &Param, value: &str) -> bool {
    p.kind == Kind::Path && is_inline(value) && value.trim_start().starts_with(['M', 'm'])
}

/// Maps path data from the box 0,0,100,100 onto the frame.
fn fit_to_frame(data: &str, frame: Rect) -> String {
    let Ok(outline) = Outline::from_svg(data) else { return data.to_owned() };
    let to_frame = Affine::translate(frame.origin().to_vec2())
        * Affine::scale_non_uniform(0.01 * frame.width(), 0.01 * frame.height());
    crate::grips::path_data(&outline.transformed(to_frame))
}

/// Maps an example value from the box 0,0,100,100 onto this frame: its coordinates become percentages.
fn demo_value(p: &Param, value: &str, frame: Rect) -> String {
    if is_path_data(p, value) {
        return fit_to_frame(value, frame);
    }
    let is_number = |t: &str| t.parse::<f64>().is_ok();
    let percent = |t: &str| if is_number(t) { format!("{t}%") } else { t.to_owned() };
    let points = |v: &str| {
        let words = v.split(' ').map(|word| {
            let pairs = word.split(':').map(|pair| pair.split(',').map(percent).collect::<Vec<_>>().join(","));
            pairs.collect::<Vec<_>>().join(":")
        });
        words.collect::<Vec<_>>().join(" ")
    };
    match p.kind {
        Kind::Point | Kind::Path | Kind::Text("X,Y" | "X,Y:X,Y") | Kind::Length(_) => points(value),
        _ => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::deform::Registry;
    use pathwarp::kurbo::{Point, Shape as _, Vec2};
    use pathwarp::map::Map as _;
    use pathwarp::param::{Args, Frame};
    use pathwarp::recipe::{Recipe, Step};

    /// The named shapes are as wide as the artwork, share its centre, and are closed paths that a page can drag.
    #[test]
    fn shapes_are_variants() {
        let registry = Registry::builtin();
        let info = registry.get("envelope").unwrap().info();
        let frame = Rect::new(10.0, 20.0, 130.0, 60.0);
        let all = deformation(info)["variants"].clone();
        let labels: Vec<&str> = all.as_array().unwrap().iter().map(|v| v["label"].as_str().unwrap()).collect();
        assert!(labels.contains(&"Heart shape") && labels.contains(&"Star shape"), "{labels:?}");
        for label in labels.iter().filter(|l| l.ends_with(" shape") && **l != "Closed shape") {
            let data = &variant_values(info, label, frame, false).unwrap()["envelope"][0];
            assert!(is_inline(data), "{label}: {data}");
            let bounds = Outline::from_svg(data).unwrap().bounding_box().unwrap();
            assert!((bounds.width() - 120.0).abs() < 0.05, "{label}: {bounds:?}");
            assert!(bounds.center().distance(frame.center()) < 0.05, "{label}: {bounds:?}");
        }
        assert!(variant_values(info, "Nose shape", frame, false).is_err());
    }

    #[test]
    fn every_deformation_and_parameter_is_there() {
        let registry = Registry::builtin();
        let all =
            catalogue(&registry, &[], &[("Puppet Warp", "mls"), ("Warp › Arch", "warp"), ("Make with Warp", "warp")]);
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

    const FRAME: Rect = Rect::new(20.0, 30.0, 684.0, 230.0);

    fn build(info: &Info) -> pathwarp::recipe::BuiltRecipe {
        build_with(info, opening_values(info, FRAME))
    }

    fn build_with(info: &Info, values: BTreeMap<String, Vec<String>>) -> pathwarp::recipe::BuiltRecipe {
        build_in(info, values, FRAME)
    }

    fn build_in(info: &Info, values: BTreeMap<String, Vec<String>>, frame: Rect) -> pathwarp::recipe::BuiltRecipe {
        let mut args = Args::new();
        for (name, values) in values {
            args.set(&name, values);
        }
        let art = Outline::from(&frame.to_path(0.1));
        let recipe = Recipe { steps: vec![Step::new(info.name, args)] };
        let built = recipe.build(&Registry::builtin(), Frame::new(frame), &std::iter::once(&art));
        built.unwrap_or_else(|e| panic!("{}: {e}", info.name))
    }

    #[test]
    fn every_deformation_opens() {
        for entry in Registry::builtin().entries() {
            build(entry.info());
        }
    }

    #[test]
    fn neutral_values_move_nothing() {
        let registry = Registry::builtin();
        let infos = || registry.entries().iter().map(|e| e.info());
        let variants = || infos().flat_map(|i| i.by_hand.variants.iter().map(move |v| (i, v)));
        let usual = infos().filter(|i| !i.by_hand.neutral.is_empty()).map(|i| (i.name, build(i)));
        let others =
            variants().map(|(i, v)| (v.label, build_with(i, variant_values(i, v.label, FRAME, false).unwrap())));
        for (name, built) in usual.chain(others) {
            for p in [Point::new(20.0, 30.0), Point::new(333.0, 111.0), Point::new(600.0, 200.0)] {
                let off = built.map.point(p).distance(p);
                assert!(off < 1e-2, "{name} moves {p} by {off}");
            }
        }
        for (info, v) in variants() {
            let p = FRAME.center() + Vec2::new(60.0, 30.0);
            let built = build_with(info, variant_values(info, v.label, FRAME, true).unwrap());
            assert!(built.map.point(p).distance(p) > 5.0, "{} shows nothing", v.label);
        }
    }

    /// No example turns a part of a word over: differences of the map keep their orientation all over the box.
    #[test]
    fn examples_do_not_fold_a_word() {
        const STEP: f64 = 1e-5;
        let registry = Registry::builtin();
        let frames = [FRAME, Rect::new(0.0, 0.0, 600.0, 80.0)];
        for (frame, entry) in frames.iter().flat_map(|f| registry.entries().iter().map(move |e| (*f, e))) {
            let built = build_in(entry.info(), example_values(entry.info(), frame), frame);
            let at =
                |u: f64, v: f64| built.map.point(frame.origin() + Vec2::new(u * frame.width(), v * frame.height()));
            for (u, v) in (1..40).flat_map(|i| (1..40).map(move |j| (f64::from(i) / 40.0, f64::from(j) / 40.0))) {
                let area = (at(u + STEP, v) - at(u - STEP, v)).cross(at(u, v + STEP) - at(u, v - STEP));
                assert!(area >= 0.0 || area.is_nan(), "{} folds a word at {u}, {v}", entry.info().name);
            }
        }
    }
}
