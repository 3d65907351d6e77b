//! Named sets of steps for any drawing, stored in one file in the user's folder for settings.
//!
//! Percentages suit every drawing. Path data is in the units of one drawing, so the box of each step's artwork (its frame) is stored as
//! well, and paths are mapped from it onto the new one.

use crate::draft;
use crate::grips::path_data;
use crate::host::Host;
use crate::protocol::PageStep;
use pathwarp::Outline;
use pathwarp::deform::Registry;
use pathwarp::engine::decimal::trimmed;
use pathwarp::kurbo::{Affine, Point, Rect};
use pathwarp::param::Kind;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The version of the file's format.
const VERSION: u32 = 1;
/// Longest name, in characters.
const LONGEST_NAME: usize = 60;

/// A named set of steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Preset {
    pub(crate) name: String,
    pub(crate) steps: Vec<PageStep>,
    /// The frames of the steps, as x0, y0, x1, y1.
    frames: Vec<[f64; 4]>,
}

#[derive(Debug, Default, Serialize, Deserialize)]
struct PresetFile {
    pathwarp: u32,
    presets: Vec<Preset>,
}

/// Returns the file, if there is a folder for settings.
fn file() -> Option<PathBuf> {
    Some(draft::settings()?.join("presets.json"))
}

/// Reads all presets, sorted by name.
pub(crate) fn all() -> Result<Vec<Preset>, String> {
    let Some(file) = file().filter(|f| f.exists()) else { return Ok(Vec::new()) };
    let wrong = |e: &dyn std::fmt::Display| format!("{}: {e}", file.display());
    let text = std::fs::read_to_string(&file).map_err(|e| wrong(&e))?;
    let read: PresetFile = serde_json::from_str(&text).map_err(|e| wrong(&e))?;
    if read.pathwarp != VERSION {
        return Err(wrong(&format!("has version {}; this program reads version {VERSION}", read.pathwarp)));
    }
    Ok(read.presets)
}

fn write(host: &dyn Host, mut presets: Vec<Preset>) -> Result<(), String> {
    let file = file().ok_or("there is no folder for settings (HOME is not set)")?;
    presets.sort_by_key(|p| p.name.to_lowercase());
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    let text = serde_json::to_string_pretty(&PresetFile { pathwarp: VERSION, presets }).map_err(|e| e.to_string())?;
    host.write(&file, text.as_bytes())
}

/// Stores steps under a name, replacing a preset of this name.
pub(crate) fn keep(host: &dyn Host, name: &str, steps: Vec<PageStep>, frames: &[Rect]) -> Result<(), String> {
    let name = name.trim();
    if name.is_empty() || name.chars().count() > LONGEST_NAME {
        return Err(format!("a preset needs a name of up to {LONGEST_NAME} characters"));
    }
    let frames = frames.iter().map(|r| [r.x0, r.y0, r.x1, r.y1]).collect();
    let mut presets: Vec<Preset> = all()?.into_iter().filter(|p| p.name != name).collect();
    presets.push(Preset { name: name.to_owned(), steps, frames });
    write(host, presets)
}

/// Deletes a preset.
pub(crate) fn forget(host: &dyn Host, name: &str) -> Result<(), String> {
    write(host, all()?.into_iter().filter(|p| p.name != name).collect())
}

impl Preset {
    /// Returns the steps with their frames; `None` where the file lacks one.
    pub(crate) fn steps_with_frames(self) -> impl Iterator<Item = (PageStep, Option<Rect>)> {
        let frames = self.frames.into_iter().map(|[x0, y0, x1, y1]| Some(Rect::new(x0, y0, x1, y1)));
        self.steps.into_iter().zip(frames.chain(std::iter::repeat(None)))
    }
}

/// Maps the path data of a step from one box onto another. Circles and arcs stay: they move only to another drawing ([`adapted`]).
pub(crate) fn fit_to_box(registry: &Registry, mut step: PageStep, from: Rect, to: Rect) -> PageStep {
    let params = registry.get(&step.deformation).map_or(&[][..], |e| e.info().params);
    let map = box_map(from, to);
    for p in params.iter().filter(|p| p.kind == Kind::Path) {
        for value in step.args.get_mut(p.name).into_iter().flatten() {
            if value.trim_start().starts_with(['M', 'm'])
                && let Ok(outline) = Outline::from_svg(value)
            {
                *value = path_data(&outline.transformed(map));
            }
        }
    }
    step
}

/// Adapts a step of another drawing: its paths, circles and arcs are mapped onto a box of this drawing, and its selection is dropped.
pub(crate) fn adapted(registry: &Registry, step: PageStep, from: Option<Rect>, to: Rect) -> PageStep {
    let step = PageStep { select: Vec::new(), exclude: Vec::new(), ..step };
    let Some(from) = from else { return step };
    let mut step = fit_to_box(registry, step, from, to);
    for value in step.args.values_mut().flatten() {
        if let Some(image) = fit_arc(value, box_map(from, to)) {
            *value = image;
        }
    }
    step
}

/// Decimals of circles that were mapped onto another box.
const DECIMALS: usize = 4;

/// Maps the centre and the radius of a circle or an arc. `None` if it is in other units, or the text is something else.
fn fit_arc(text: &str, map: Affine) -> Option<String> {
    let (kind, rest) = text.split_once(':').filter(|(kind, _)| ["circle", "arc"].contains(kind))?;
    let pairs: Vec<(&str, &str)> = rest.split(',').map(|pair| pair.split_once('=')).collect::<Option<_>>()?;
    let number = |name: &str| pairs.iter().find(|(n, _)| *n == name)?.1.parse::<f64>().ok();
    let (centre, r) = (map * Point::new(number("cx")?, number("cy")?), number("r")?);
    let pair = |&(name, value): &(&str, &str)| match name {
        "cx" => format!("cx={}", trimmed(centre.x, DECIMALS)),
        "cy" => format!("cy={}", trimmed(centre.y, DECIMALS)),
        "r" => format!("r={}", trimmed(r * map.determinant().abs().sqrt(), DECIMALS)),
        _ => format!("{name}={value}"),
    };
    Some(format!("{kind}:{}", pairs.iter().map(pair).collect::<Vec<_>>().join(",")))
}

/// Returns the map of one box onto another; a box without width or height is not scaled in that direction.
fn box_map(from: Rect, to: Rect) -> Affine {
    let scale = |from: f64, to: f64| if from > 0.0 && to > 0.0 { to / from } else { 1.0 };
    Affine::translate(to.origin().to_vec2())
        * Affine::scale_non_uniform(scale(from.width(), to.width()), scale(from.height(), to.height()))
        * Affine::translate(-from.origin().to_vec2())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_laid_onto_the_new_frame() {
        let args = [("shaper".to_owned(), vec!["M0,10 L10,10 L10,0 L0,0 Z".to_owned()])];
        let step = PageStep { deformation: "shaper".into(), inverse: false, args: args.into(), ..PageStep::default() };
        let preset = Preset { name: "a".into(), steps: vec![step], frames: vec![[0.0, 0.0, 10.0, 10.0]] };
        let mut all = preset.steps_with_frames();
        let (step, from) = all.next().unwrap();
        let laid = fit_to_box(&Registry::builtin(), step, from.unwrap(), Rect::new(5.0, 5.0, 25.0, 10.0));
        assert_eq!(laid.args["shaper"], ["M5,10 L25,10 L25,5 L5,5 Z"]);
        assert_eq!(all.next(), None);
    }

    #[test]
    fn steps_of_another_drawing_name_none_of_its_parts() {
        let args = [("along".to_owned(), vec!["arc:r=3,cx=5,cy=5,from=90,to=450".to_owned()])];
        let select = vec!["#mark".to_owned()];
        let step = PageStep { deformation: "bend".into(), args: args.into(), select, ..PageStep::default() };
        let [from, to] = [Rect::new(0.0, 0.0, 10.0, 10.0), Rect::new(100.0, 0.0, 140.0, 90.0)];
        let brought = adapted(&Registry::builtin(), step, Some(from), to);
        assert_eq!(brought.args["along"], ["arc:r=18,cx=120,cy=45,from=90,to=450"]);
        assert!(brought.select.is_empty());
    }
}
