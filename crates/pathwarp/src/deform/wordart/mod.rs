//! Text warps: the forty shapes that office programs put words into.
//!
//! Each is two guide curves, or several pairs, between which the artwork is spanned (`map::ruled`), or guides
//! that it stands on. The curves and their adjust values are those of ECMA-376, Part 1, *presetTextWarpDefinitions* (the preset
//! text warps of DrawingML, `prstTxWarp`), written anew as data in `presets.json` ([`preset`]).

mod shape;

pub use shape::TextShape;

use super::bend::{Bend, Stretch};
use super::built::{Built, Overlay, Role};
use super::entry::{Case, Deformation, Example, Gallery, Info, Law};
use crate::error::{Error, GeometryError};
use crate::map::{AffineMap, Along, Class, Guide, Map, TileRow, Tiled, ruled};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Axis, Kind, Param, Settings};
use kurbo::{Affine, Rect};
use shape::{GuideError, Guides};
use std::sync::Arc;

pub(super) struct WordArt;

/// The names, in the standard's families.
const NAMES: &[&str] = &[
    "plain",
    "stop",
    "triangle",
    "triangle-inverted",
    "chevron",
    "chevron-inverted",
    "ring-inside",
    "ring-outside",
    "arch-up",
    "arch-down",
    "circle",
    "button",
    "arch-up-pour",
    "arch-down-pour",
    "circle-pour",
    "button-pour",
    "curve-up",
    "curve-down",
    "can-up",
    "can-down",
    "wave1",
    "wave2",
    "double-wave1",
    "wave4",
    "inflate",
    "deflate",
    "inflate-bottom",
    "deflate-bottom",
    "inflate-top",
    "deflate-top",
    "deflate-inflate",
    "deflate-inflate-deflate",
    "fade-right",
    "fade-left",
    "fade-up",
    "fade-down",
    "slant-up",
    "slant-down",
    "cascade-up",
    "cascade-down",
];

static INFO: Info = Info::new("wordart", "put artwork into one of the forty text shapes of office programs")
    .gallery(Gallery { set: "wordart", title: "text shapes", presets: "preset", bend: None, axis: None })
    .group("Envelopes")
    .about("The text effects that word processors and presentations offer under Transform, from their published formulas: \
plain, triangle, chevron, arch-up, ring-inside, wave1, inflate, slant-up, cascade-up and the others below; \
`pathwarp gallery --set wordart` draws them all. The names of \
the menus are known too (\"Chevron Up\"), and those in files (textChevron).\n\nThe artwork's box is spanned between the guides; in \
arch-up, arch-down, circle and button it stands on them instead, scaled to their length. deflate-inflate has two bands, \
deflate-inflate-deflate, button and button-pour have three: made for as many lines of text. --split says where the artwork is \
divided; otherwise it is divided evenly.\n\nA shape of your own is a TOML or JSON file of adjust values, formulas over w and h (the \
box) and guides written like path data:\n\n  name = \"hill\"\n  adj = [{ name = \"adj\", default = 40000, least = 0, most = 80000 }]\n  \
let = [\"y = adj*h/100000\"]\n  bands = [[\"M 0,y Q w/2,-y w,y\", \"M 0,h L w,h\"]]")
    .source("ECMA-376, Office Open XML File Formats, Part 1, presetTextWarpDefinitions (DrawingML prstTxWarp, 20.1.9.19)")
    .params(&[
        Param::new("preset", Kind::NameOrFile(NAMES), "The shape: a name, or a file of your own.").needed(),
        Param::new(
            "adj",
            Kind::Text("[NAME=]VALUE"),
            "An adjust value, such as adj1=15000: in 1/100000 of the box or %, angles in 1/60000 degree or with a unit. Without a name, in \
their order.",
        )
        .repeated(),
        Param::new(
            "by",
            Kind::Choice(&["arclength", "parameter"]),
            "Run evenly along the guides, or by their own parameters.",
        )
        .default("arclength"),
        Param::new("split", Kind::Text("Y[,Y…]"), "The heights at which artwork is divided between bands, user units or %."),
    ])
    .demo(&[("preset", "wave1"), ("adj", "adj1=15000"), ("adj", "adj2=4000")])
    .examples(&[
        Example { what: "A word as a wave", command: "wordart samples/lettering.svg --preset wave1 -o out.svg" },
        Example {
            what: "A roof by the name that menus give it, steeper",
            command: "wordart samples/lettering.svg --preset 'Chevron Up' --adj 45% -o out.svg",
        },
        Example {
            what: "On an arch, from low on the left to low on the right",
            command: "wordart samples/logo.svg --preset arch-up --adj 150deg --fit page -o out.svg",
        },
        Example {
            what: "Round a ring, by the curves' own parameters",
            command: "wordart samples/lettering.svg --preset circle-pour --adj adj2=70% --by parameter -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("preset", "plain")]),
        Law::Identity(&[("preset", "wave2"), ("adj", "0")]),
        Law::Identity(&[("preset", "slant-up"), ("adj", "0")]),
        Law::Identity(&[("preset", "fade-up"), ("adj", "0%"), ("by", "parameter")]),
        Law::Same(&[("preset", "textChevron")], &[("preset", "Chevron: Up"), ("adj", "adj=25%")]),
        Law::Same(&[("preset", "deflate-inflate")], &[("preset", "deflate-inflate"), ("split", "50%")]),
        Law::KeepsLinesAlong(&[("preset", "slant-down")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("preset", "slant-down")], (1.0, 0.0)),
        Law::Area(&[("preset", "slant-up"), ("adj", "40%")], 0.6),
    ])
    .cases(&[
        Case { args: &[("preset", "triangle")], at: (0.0, 0.0), to: (0.0, 50.0), tolerance: 1e-12 },
        Case { args: &[("preset", "triangle")], at: (50.0, 0.0), to: (50.0, 0.0), tolerance: 1e-12 },
        Case { args: &[("preset", "triangle")], at: (75.0, 50.0), to: (75.0, 62.5), tolerance: 1e-12 },
        // Half a circle: a quarter of the way is 45 degrees.
        Case {
            args: &[("preset", "can-up"), ("adj", "70000")],
            at: (50.0, 0.0),
            to: (50.0, 0.0),
            tolerance: 1e-9,
        },
        Case {
            args: &[("preset", "arch-up")],
            at: (25.0, 100.0),
            to: (50.0 - 50.0 * R2, 50.0 - 50.0 * R2),
            tolerance: 1e-9,
        },
    ]);

const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Deformation for WordArt {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let name = s.texts("preset").last().copied().unwrap_or_default();
        let preset = match s.file_if("preset")? {
            Some(file) => TextShape::from_file(&file.name, &file.text)?,
            None => TextShape::builtin().into_iter().find(|p| p.is_called(name)).ok_or_else(|| {
                Error::usage("preset", name, format!("is no text shape; there are {}, and files", NAMES.join(", ")))
            })?,
        };
        let rect = s.frame().rect;
        if !(rect.width() > 0.0 && rect.height() > 0.0) {
            return Err(GeometryError::FlatFrame { width: rect.width(), height: rect.height() }.into());
        }
        let adjusted = adjusted(s, &preset)?;
        let wrong = |e: GuideError| Error::usage("preset", name, e.to_string());
        let guides = preset.guides(rect.width(), rect.height(), &adjusted).map_err(wrong)?;
        let bands = match &guides {
            Guides::Between(b) => b.len(),
            Guides::Along(p) => p.len(),
        };
        let cuts = cuts(s, rect, bands)?;
        let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
        let values = preset.adj.iter().zip(&adjusted).map(|(a, v)| format!("{} {v}", a.name)).collect::<Vec<_>>();
        built.note(format!("text shape {}: {}, {bands} band(s)", preset.name, values.join(", ")));
        let place = Affine::translate(rect.origin().to_vec2());
        let moved = |segs: &[Seg]| -> Vec<Seg> { segs.iter().map(|g| g.transformed(place)).collect() };
        let band = |k: usize| {
            let y0 = if k == 0 { rect.y0 } else { cuts[k - 1] };
            Rect { y0, y1: cuts.get(k).copied().unwrap_or(rect.y1), ..rect }
        };
        let rows: Option<Vec<TileRow>> = match guides {
            Guides::Between(pairs) => {
                let along = if s.choice("by")? == "parameter" { Along::Parameter } else { Along::ArcLength };
                let one = |(k, [top, bottom]): (usize, &[Vec<Seg>; 2])| {
                    let (top, bottom) = (moved(top), moved(bottom));
                    built.explanation.overlays.extend([cage(&top, rect), cage(&bottom, rect)]);
                    ruled::row(band(k), &Guide::new(&top, along)?, &Guide::new(&bottom, along)?)
                };
                pairs.iter().enumerate().map(one).collect()
            }
            Guides::Along(paths) => {
                let mut rows = Vec::with_capacity(paths.len());
                for (k, path) in paths.iter().enumerate() {
                    let path = moved(path);
                    built.explanation.overlays.push(cage(&path, rect));
                    let bent = standing(&path, band(k))?;
                    built.explanation.warnings.extend(bent.explanation.warnings);
                    rows.push(TileRow { cuts: Vec::new(), maps: vec![bent.map] });
                }
                Some(rows)
            }
        };
        let map = rows.and_then(|rows| Tiled::over(rect, cuts.clone(), rows));
        let map = map.ok_or_else(|| {
            Error::usage("preset", name, "has a guide without length in this box: adjust it less far")
        })?;
        built.map = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(crate::anchors::settled(m, s.frame()))),
            Class::Projective(_) | Class::Smooth => map,
        };
        Ok(built)
    }
}

/// The adjust values: given or default.
fn adjusted(s: &Settings<'_>, preset: &TextShape) -> Result<Vec<f64>, Error> {
    let mut values: Vec<f64> = preset.adj.iter().map(|a| a.default).collect();
    let texts = if s.given("adj") { s.texts("adj") } else { Vec::new() };
    for (n, text) in texts.into_iter().enumerate() {
        let wrong = |what: String| Error::usage("adj", text, what);
        let (at, value) = match text.split_once('=') {
            None => (n, text),
            Some((name, value)) => {
                (preset.adj.iter().position(|a| a.name == name.trim()).unwrap_or(usize::MAX), value.trim())
            }
        };
        let a = preset.adj.get(at).ok_or_else(|| {
            let known: Vec<&str> = preset.adj.iter().map(|a| a.name.as_str()).collect();
            wrong(format!("is none of the adjust values of {}: {}", preset.name, known.join(", ")))
        })?;
        let v = if value.ends_with('%') {
            s.number_in("adj", value)? * 1e5
        } else if value.ends_with(|c: char| c.is_alphabetic() || c == '°') {
            s.angle_in("adj", value)? * 6e4
        } else {
            s.number_in("adj", value)?
        };
        if !(a.least..=a.most).contains(&v) {
            return Err(wrong(format!(
                "is out of range: {} of {} goes from {} to {}",
                a.name, preset.name, a.least, a.most
            )));
        }
        values[at] = v;
    }
    Ok(values)
}

/// The heights between bands.
fn cuts(s: &Settings<'_>, rect: Rect, bands: usize) -> Result<Vec<f64>, Error> {
    if !s.given("split") {
        return Ok((1..bands).map(|k| rect.y0 + rect.height() * (k as f64 / bands as f64)).collect());
    }
    let text = s.texts("split").last().copied().unwrap_or_default();
    let mut out = Vec::new();
    for t in text.split([',', ' ']).filter(|t| !t.is_empty()) {
        let y = s.length_in("split", t, Axis::Y)?;
        out.push(if t.ends_with('%') { rect.y0 + y } else { y });
    }
    let inside = out.iter().all(|y| *y > rect.y0 && *y < rect.y1) && out.windows(2).all(|w| w[0] < w[1]);
    if out.len() + 1 == bands && inside {
        return Ok(out);
    }
    let most = bands - 1;
    Err(Error::usage(
        "split",
        text,
        format!("must be {most} height(s) between {} and {}, rising, for this shape", rect.y0, rect.y1),
    ))
}

/// Stands the band of artwork in `frame` on `path`, scaled to its length.
fn standing(path: &[Seg], frame: Rect) -> Result<Built, Error> {
    Bend::new(frame, &outline(path)).stretch(Stretch::Scale).baseline(frame.y1).as_drawn(true).build()
}

fn outline(segs: &[Seg]) -> Outline {
    let start = segs.first().map(Seg::start).unwrap_or_default();
    Outline { subpaths: vec![Subpath { start, segs: segs.to_vec(), closed: false }] }
}

fn cage(segs: &[Seg], rect: Rect) -> Overlay {
    Overlay { role: Role::Cage, path: outline(segs).to_bez_path(1e-4 * (rect.width() + rect.height())) }
}

#[cfg(test)]
mod tests;
