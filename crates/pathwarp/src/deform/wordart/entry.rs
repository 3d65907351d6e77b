//! The registry's entry: reads a [`WordArt`] from text.

use super::{ShapeBox, TextShape, WordArt};
use crate::deform::built::Built;
use crate::deform::entry::{ByHand, Case, Deformation, Example, Gallery, Info, Law};
use crate::error::Error;
use crate::param::{Axis, Kind, Param, Settings};
use std::sync::Arc;

pub(in crate::deform) struct Entry;

/// The names, in the standard's families.
pub(super) const NAMES: &[&str] = &[
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

pub(super) static INFO: Info = Info::new("wordart", "put artwork into one of the forty text shapes of office programs")
    .gallery(Gallery { set: "wordart", title: "text shapes", presets: "preset", bend: None, axis: None })
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Text shape"),
        ..ByHand::NONE
    })
    .with_letters()
    .about("The text effects that word processors and presentations offer under Transform, from their published formulas: \
plain, triangle, chevron, arch-up, ring-inside, wave1, inflate, slant-up, cascade-up and the others below; \
`pathwarp gallery --set wordart` draws them all. The names \
in menus (\"Chevron Up\") and files (textChevron) work too.\n\nThe artwork's box is spanned between the guides; in \
arch-up, arch-down, circle and button it stands on them instead. Shapes are drawn in the artwork's box, but round ones (these four, the pours \
and the rings) in one that suits its proportion: on a single guide, letters keep their size, measured at half their height, in a square that \
the text fills, and short words in one so large that no letter is twice as wide at one end as at the other; between two guides, the box that \
distorts least. Lettering of fewer lines than button has guides takes the first ones, and artwork that is not lettering the first, unless --split divides it. --box artwork draws these in the artwork's box too, and \
--box X,Y,W,H in any box; text on a single guide is then scaled to its length.\n\ndeflate-inflate has two bands, \
deflate-inflate-deflate, button and button-pour have three, for as many lines of text. --split sets the heights at which the artwork is \
divided; by default between as many lines, or evenly.\n\nA shape of your own is a TOML or JSON file of adjust values, formulas over w and h (the \
box) and guides written like path data (`round = true`: the box suits the artwork's proportion):\n\n  name = \"hill\"\n  adj = [{ name = \"adj\", default = 40000, least = 0, most = 80000 }]\n  \
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
            "Spacing along the guides: even by length, or by their parameters.",
        )
        .default("arclength"),
        Param::new(
            "box",
            Kind::Text("BOX"),
            "The box that the shape is drawn in: fit (for round shapes, one that suits the artwork's proportion), artwork (its own), or \
X,Y,W,H (user units or %).",
        )
        .default("fit"),
        Param::new("split", Kind::Text("Y[,Y…]"), "The heights at which artwork is divided between bands, user units or %."),
    ])
    .demo(&[("preset", "wave1"), ("adj", "adj1=15000"), ("adj", "adj2=4000")])
    .examples(&[
        Example { what: "A word as a wave", command: "wordart samples/lettering.svg --preset wave1 -o out.svg" },
        Example {
            what: "A roof by its name in menus, steeper",
            command: "wordart samples/lettering.svg --preset 'Chevron Up' --adj 45% -o out.svg",
        },
        Example {
            what: "On an arch, from low on the left to low on the right",
            command: "wordart samples/logo.svg --preset arch-up --adj 150deg --fit page -o out.svg",
        },
        Example {
            what: "Round a ring, by the curves' parameters",
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
            args: &[("preset", "arch-up"), ("box", "artwork")],
            at: (25.0, 100.0),
            to: (50.0 - 50.0 * R2, 50.0 - 50.0 * R2),
            tolerance: 1e-9,
        },
    ]);

const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let name = s.texts("preset").last().copied().unwrap_or_default();
        let shape = match s.file_if("preset")? {
            Some(file) => TextShape::from_file(&file.name, &file.text)?,
            None => TextShape::named(name).ok_or_else(|| {
                Error::advised(
                    "preset",
                    name,
                    "is not a text shape",
                    format!("; there are {}, and files", NAMES.join(", ")),
                )
            })?,
        };
        let wordart = WordArt {
            frame: s.frame().rect,
            adjusted: adjusted(s, &shape)?,
            shape,
            by_parameter: s.choice("by")? == "parameter",
            split: if s.given("split") { Some(split(s)?) } else { None },
            shape_box: match s.texts("box").last() {
                Some(&"fit") => ShapeBox::Fit,
                _ => s.rect_if("box")?.map_or(ShapeBox::Artwork, ShapeBox::Given),
            },
            letters: Arc::clone(&s.frame().letters),
        };
        wordart.build()
    }
}

/// Reads the adjust values; those not given have their defaults.
fn adjusted(s: &Settings<'_>, shape: &TextShape) -> Result<Vec<f64>, Error> {
    let mut values: Vec<f64> = shape.adj.iter().map(|a| a.default).collect();
    let texts = if s.given("adj") { s.texts("adj") } else { Vec::new() };
    for (n, text) in texts.into_iter().enumerate() {
        let (at, value) = match text.split_once('=') {
            None => (n, text),
            Some((name, value)) => {
                (shape.adj.iter().position(|a| a.name == name.trim()).unwrap_or(usize::MAX), value.trim())
            }
        };
        let a = shape.adj.get(at).ok_or_else(|| super::no_adjust_value(shape, text))?;
        let v = if value.ends_with('%') {
            s.number_in("adj", value)? * 1e5
        } else if value.ends_with(|c: char| c.is_alphabetic() || c == '°') {
            s.angle_in("adj", value)? * 6e4
        } else {
            s.number_in("adj", value)?
        };
        a.check(v, &shape.name)?;
        values[at] = v;
    }
    Ok(values)
}

/// Reads the heights between bands.
fn split(s: &Settings<'_>) -> Result<Vec<f64>, Error> {
    let text = s.texts("split").last().copied().unwrap_or_default();
    let height = |t: &str| {
        let y = s.length_in("split", t, Axis::Y)?;
        Ok(if t.ends_with('%') { s.frame().rect.y0 + y } else { y })
    };
    text.split([',', ' ']).filter(|t| !t.is_empty()).map(height).collect()
}
