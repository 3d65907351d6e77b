//! The registry's entry: reads a [`Bend`] from text.

use super::letters::LetterSetting;
use super::{Align, Bend, Stretch};
use crate::deform::built::Built;
use crate::deform::entry::{ByHand, Case, Deformation, Example, Info, Law, Pairs};
use crate::error::Error;
use crate::param::{Axis, Kind, NamedText, Param, Settings, is_spiral};
use kurbo::Vec2;
use std::sync::Arc;

pub(in crate::deform) struct Entry;

pub(super) static INFO: Info = Info::new("bend", "bend artwork along a path")
    .baseline("baseline")
    .group("Bends")
    .by_hand(ByHand {
        neutral: &[("along", "M0,50 C33.3333,50 66.6667,50 100,50")],
        ..ByHand::NONE
    })
    .guides(&["along"], 1)
    .about("The artwork follows a path, the skeleton: horizontals run along it, verticals stand on it. The skeleton may \
have any number of lines, curves and arcs, open or closed. Nothing is stretched unless you ask: --stretch scale sizes the artwork \
to the skeleton, fit stretches it lengthwise only. --stretch repeat sets copies of it side by side, as many as fit on the skeleton, \
spread evenly.\n\nAn open skeleton is run left to right and a closed one clockwise, so that the artwork \
stands on its upper or outer side, with its middle on the highest point of a closed one. --reverse runs a skeleton the other way: artwork on a closed \
one then stands upright on its lowest point, inside. --as-drawn takes it as it was drawn, as is always done with spirals and \
with open paths that go around more than once. Beyond the ends of an open one everything continues straight. --spline 3 makes a smooth skeleton of a \
few points: it is pulled towards them and has no corners; an open one begins at the first and ends at the last.\n\n\
Lettering (text, or made by `pathwarp text`) stands on the skeleton with its baseline. With --glyphs its letters are set one by \
one instead of bent: rotate turns them, skew keeps their verticals vertical, ribbon keeps their horizontals horizontal, stair only moves them. \
They keep their own size, times --width; --stretch fit spreads them out from end to end, scale sizes them. --spacing even measures distances at \
half the height of the artwork instead of on the skeleton, so that letters neither crowd inside a bend nor drift apart outside it.\n\n--by parameter, or --handles, gives the polynomial map of the paper: \
its sides are handles on the control polygon instead of normals of the curve. FILE.json holds {\"pieces\": [{\"levels\": [[[dx,dy], …], \
…]}, …]}: for every piece of degree n the n handles of the first level, then n-1 of the second, and so on (deeper levels may be \
omitted). A handle is the image of the artwork's height.")
    .source("Y.-K. Chang and A. Rockwood, A generalized de Casteljau approach to 3D free-form deformation, SIGGRAPH 1994")
    .params(&[
        Param::path("along", "The skeleton: one connected path, such as circle:r=60mm, arc:r=60mm,from=200,to=340 or spiral:turns=3,inner=20mm,outer=80mm.").needed(),
        Param::new(
            "stretch",
            Kind::Choice(&["keep", "scale", "fit", "repeat"]),
            "Lengths: keep them, scale the artwork evenly to the skeleton's length, fit its width only, or repeat it all along.",
        )
        .default("keep"),
        Param::new(
            "align",
            Kind::Choice(&["start", "middle", "end"]),
            "The part of the artwork that comes to the same part of the skeleton.",
        )
        .default("middle"),
        Param::length("offset", Axis::X, "Shift along the skeleton, user units or % of the artwork's width.")
            .default("0"),
        Param::length("gap", Axis::X, "The least space between repeated artwork, user units or % of its width.").default("0"),
        Param::length("baseline", Axis::Y, "The height of the artwork, from its bottom, that lies on the skeleton. Default for lettering: the lettering's baseline.")
            .default("50%"),
        Param::number("width", "Heights are multiplied by this.").default("100%").within(1e-6, 1e6).slider(0.1, 3.0),
        Param::new(
            "by",
            Kind::Choice(&["arclength", "parameter"]),
            "Run evenly along the skeleton, or by its pieces' parameters with handles for sides.",
        )
        .default("arclength"),
        Param::new("handles", Kind::File, "A JSON file of handles; the skeleton is then taken as drawn."),
        Param::new(
            "spline",
            Kind::Count,
            "Take the skeleton's anchors as control points of a uniform B-spline of this degree; the curves between them are ignored.",
        )
        .within(1.0, 3.0),
        Param::new(
            "glyphs",
            Kind::Choice(&["bend", "rotate", "skew", "ribbon", "stair"]),
            "Letters: bend them, or set them one by one: turned, sheared with vertical verticals or horizontal horizontals, or just moved.",
        )
        .default("bend"),
        Param::flag("skew", "The same as --glyphs skew."),
        Param::flag("ribbon", "The same as --glyphs ribbon."),
        Param::new(
            "spacing",
            Kind::Choice(&["baseline", "even"]),
            "The line on which lengths are measured: the skeleton, or half the artwork's height, which evens out letters in a bend.",
        )
        .default("baseline"),
        Param::flag("as-drawn", "Take the skeleton in the direction it was drawn, a closed one from its start."),
        Param::flag("reverse", "Run the skeleton the other way."),
    ])
    .demo(&[("along", "M-10,60 Q25,35 50,45 T110,50")])
    .examples(&[
        Example {
            what: "Along a curve, true to size",
            command: "bend samples/lettering.svg --along 'M20,170 C180,60 356,60 516,170' -o out.svg --preview out.png",
        },
        Example {
            what: "On an arc of a circle, scaled to its length",
            command: "bend samples/logo.svg --along 'M60,190 A400,400 0 0 1 604,190' --stretch scale --baseline 0 -o out.svg",
        },
        Example {
            what: "On an arc of 60 mm radius about the middle, from 200° to 340°",
            command: "bend samples/lettering.svg --along arc:r=60mm,from=200,to=340 -o out.svg",
        },
        Example {
            what: "A border of logos round a circle",
            command: "bend samples/logo.svg --along 'M100,400 A300,300 0 1 1 700,400 A300,300 0 1 1 100,400 Z' --stretch repeat --gap 10% --baseline 0 --fit page -o out.svg",
        },
        Example {
            what: "Once round and further out on a spiral, from the inside",
            command: "bend samples/lettering.svg --along spiral:turns=1.5,inner=30mm,outer=60mm --fit page -o out.svg",
        },
        Example {
            what: "Lettering whose letters turn but keep their shape",
            command: "bend samples/headline.svg --along 'M120,220 A120,120 0 0 1 360,220' --glyphs rotate --spacing even --stretch fit -o out.svg",
        },
        Example {
            what: "A grid along a winding path, by the paper's polynomial map",
            command: "bend samples/grid.svg --along 'M10,120 C60,20 90,20 120,120 S180,220 230,120' --by parameter --stretch fit --width 40% -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("along", "0,50 100,50")]),
        Law::Identity(&[("along", "0,50 100,50"), ("by", "parameter")]),
        Law::Identity(&[("along", "100,100 70,100 20,100 0,100"), ("baseline", "0"), ("stretch", "fit")]),
        Law::Area(&[("along", "0,0 30,40"), ("stretch", "scale")], 0.25),
        Law::Area(&[("along", "0,0 30,40"), ("stretch", "fit"), ("width", "3")], 1.5),
        Law::KeepsLines(&[("along", "M10,10 L60,80")]),
        Law::Same(&[("along", "M0,60 Q50,20 100,60")], &[("along", "M100,60 Q50,20 0,60")]),
        Law::Same(
            &[("along", "M0,60 Q50,20 100,60"), ("reverse", "true")],
            &[("along", "M100,60 Q50,20 0,60"), ("as-drawn", "true")],
        ),
        // A B-spline with as many points as its degree asks for is a Bézier curve; points in a row make a line.
        Law::Same(&[("along", "0,60 30,20 70,90 100,50"), ("spline", "3")], &[("along", "M0,60 C30,20 70,90 100,50")]),
        Law::Same(&[("along", "0,60 40,20 90,90"), ("spline", "1")], &[("along", "0,60 40,20 90,90")]),
        // The upper half of a circle, wherever the circle begins and whichever way it was drawn.
        Law::Same(&[("along", ARC), ("baseline", "0")], &[("along", CIRCLE), ("baseline", "0")]),
    ])
    .cases(&[
        // Half a circle of radius 50 about 50,50: 45 degrees from the top, on it and 20 above.
        Case { args: ON_ARC, at: (50.0, 100.0), to: (50.0, 0.0), tolerance: 1e-11 },
        Case { args: ON_ARC, at: (EIGHTH, 100.0), to: (50.0 + 50.0 * R2, 50.0 - 50.0 * R2), tolerance: 1e-11 },
        Case { args: ON_ARC, at: (EIGHTH, 80.0), to: (50.0 + 70.0 * R2, 50.0 - 70.0 * R2), tolerance: 1e-11 },
        // A right angle: the mitre, and beyond it the offset.
        Case { args: CORNER, at: (50.0, 40.0), to: (60.0, -10.0), tolerance: 1e-12 },
        Case { args: CORNER, at: (100.0, 40.0), to: (60.0, 50.0), tolerance: 1e-12 },
        // The polynomial map: C(1/2) + S(1/2)/2 of a quadratic with legs (30,-40) and (30,40), their normals (-.8,-.6), (.8,-.6).
        Case { args: PARAMETER, at: (50.0, 50.0), to: (30.0, -20.0), tolerance: 1e-12 },
        Case { args: PARAMETER, at: (50.0, 0.0), to: (30.0, -50.0), tolerance: 1e-12 },
    ]);

const ARC: &str = "M0,50 A50,50 0 0 1 100,50";
const CIRCLE: &str = "M100,50 A50,50 0 1 1 0,50 A50,50 0 1 1 100,50 Z";
const ON_ARC: Pairs = &[("along", ARC), ("baseline", "0")];
const CORNER: Pairs = &[("along", "0,0 50,0 50,50"), ("align", "start")];
const PARAMETER: Pairs = &[("along", "M0,0 Q30,-40 60,0"), ("by", "parameter"), ("stretch", "fit")];
const EIGHTH: f64 = 50.0 + 50.0 * std::f64::consts::FRAC_PI_4;
const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let missing = || Error::missing("along", "the path to bend the artwork along");
        let frame = s.frame();
        let handles = s.file_if("handles")?.map(handles).transpose()?;
        let bend = Bend {
            frame: frame.rect,
            along: s.path_if("along")?.ok_or_else(missing)?,
            spline: s.number_if("spline")?.map(|d| d as usize),
            as_drawn: s.flag("as-drawn")? || s.texts("along").last().is_some_and(|t| is_spiral(t)),
            reverse: s.flag("reverse")?,
            stretch: match s.choice("stretch")? {
                "scale" => Stretch::Scale,
                "fit" => Stretch::Fit,
                "repeat" => Stretch::Repeat,
                _ => Stretch::Keep,
            },
            align: match s.choice("align")? {
                "start" => Align::Start,
                "end" => Align::End,
                _ => Align::Middle,
            },
            offset: s.number("offset")?,
            gap: s.number("gap")?,
            baseline: match frame.baseline {
                Some(y) if !s.given("baseline") => y,
                _ => frame.rect.y1 - s.number("baseline")?,
            },
            width: s.number("width")?,
            by_parameter: s.choice("by")? == "parameter",
            handles: handles.as_ref().map(|(levels, _)| levels.clone()),
            handles_name: handles.map_or_else(|| "handles".into(), |(_, name)| name),
            even: s.choice("spacing")? == "even",
            setting: setting(s)?,
            letters: Arc::clone(&frame.letters),
            around_letters: frame.baseline.is_some(),
        };
        bend.build()
    }
}

/// For every piece its levels of handles, and the file's name.
type Handles = (Vec<Vec<Vec<Vec2>>>, String);

#[cfg(feature = "serde")]
fn handles(file: &NamedText) -> Result<Handles, Error> {
    Ok((super::file::read(&file.name, &file.text)?, file.name.clone()))
}

#[cfg(not(feature = "serde"))]
fn handles(file: &NamedText) -> Result<Handles, Error> {
    Err(crate::error::no_json(&file.name))
}

/// Reads how letters are set one by one, if they are.
fn setting(s: &Settings<'_>) -> Result<Option<LetterSetting>, Error> {
    let mut given: Vec<&str> = if s.given("glyphs") { vec![s.choice("glyphs")?] } else { Vec::new() };
    for name in ["skew", "ribbon"] {
        if s.flag(name)? {
            given.push(name);
        }
    }
    if let [first, rest @ ..] = given.as_slice()
        && rest.iter().any(|r| r != first)
    {
        return Err(Error::usage("glyphs", given.join(", "), "contradict each other: letters are set in one way only"));
    }
    Ok(given.first().and_then(|name| LetterSetting::named(name)))
}
