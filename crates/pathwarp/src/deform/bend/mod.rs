//! Bends artwork along a skeleton.
//!
//! The artwork's levels run along the skeleton curve C, its heights stand on it: F(x, y) = C(u) + v·S(u), u growing with x and v
//! with the height above the baseline. Two kinds of sides S:
//!
//! - **unit normals** ([`piece`]): with u by arc length s, ∂F/∂s = (1 + κd)·T and ∂F/∂d = N, exactly; the strip is as high as
//!   the artwork everywhere and folds beyond the centre of curvature, 1 + κd = 0. At corners S is brought to the mitre, evenly
//!   along both neighbours, so that offsets of a polygon are its offsets;
//! - **handles** ([`casteljau`]): the generalised algorithm of de Casteljau, one handle per leg of the control polygon, deeper
//!   levels on request. F is polynomial in u and v, and the image of a Bézier curve is one again, exactly. By default a handle is
//!   the leg's unit normal, as long as the artwork is high.
//!
//! Source: *A generalized de Casteljau approach to 3D free-form deformation* (Chang & Rockwood, SIGGRAPH 1994), here in the plane;
//! its joint conditions (4) and (5) are checked and told. A skeleton may be given as a B-spline ([`spline`]). Joints of the skeleton are creases: uprights in the artwork.

mod casteljau;
mod letters;
mod map;
mod piece;
mod skeleton;
mod spline;

use super::built::{Built, Role};
use super::entry::{Case, Deformation, Example, Info, Law};
use crate::error::{Error, show};
use crate::param::{Axis, Kind, Param, Settings};
use kurbo::{Affine, Vec2};
use letters::Setting;
use map::{BendMap, Place};
use skeleton::Skeleton;
use std::sync::Arc;

pub(super) struct Bend;

static INFO: Info = Info::new("bend", "bend artwork along a path")
    .baseline("baseline")
    .group("Bends")
    .about("The artwork follows a path, the skeleton: what is level runs along it, what is upright stands on it. The skeleton may \
have any number of lines, curves and arcs, open or closed. Nothing is stretched unless you ask: --stretch scale sizes the artwork \
to the skeleton, fit stretches it lengthwise only. --stretch repeat sets copies of it side by side, as many as the skeleton has \
room for, and spreads them evenly.\n\nAn open skeleton is run left to right and a closed one clockwise, so that up \
is up, or outside; --as-drawn and --reverse overrule that. On a closed skeleton the artwork's middle stands on its highest point. \
Beyond the ends of an open one everything goes straight on. --spline 3 makes a smooth skeleton of a \
few points: it is drawn towards them and has no corners; an open one begins at the first and ends at the last.\n\n\
Lettering (text, or made by `pathwarp text`) stands on the skeleton with its baseline. With --glyphs its letters are set one by \
one instead of bent: rotate turns them, skew keeps their uprights upright, ribbon keeps their levels level, stair only moves them. \
They have their own size then, times --width; --stretch fit spreads them out from end to end, scale sizes them. --spacing even counts distances at \
half the height of the artwork instead of on the skeleton, so that letters do not crowd inside a bend nor drift apart outside.\n\n--by parameter, or --handles, gives the polynomial map of the paper: \
its sides are handles on the control polygon instead of normals of the curve. FILE.json holds {\"pieces\": [{\"levels\": [[[dx,dy], …], \
…]}, …]}: for every piece of degree n the n handles of the first level, then n-1 of the second, and so on (deeper levels may be \
left away). A handle says where the artwork's height goes.")
    .source("Y.-K. Chang and A. Rockwood, A generalized de Casteljau approach to 3D free-form deformation, SIGGRAPH 1994")
    .params(&[
        Param::path("along", "The skeleton: one connected path.").needed(),
        Param::new(
            "stretch",
            Kind::Choice(&["keep", "scale", "fit", "repeat"]),
            "Lengths: keep them, scale the artwork evenly to the skeleton's length, fit its width only, or repeat it all along.",
        )
        .default("keep"),
        Param::new(
            "align",
            Kind::Choice(&["start", "middle", "end"]),
            "What of the artwork comes to what of the skeleton.",
        )
        .default("middle"),
        Param::length("offset", Axis::X, "Shift along the skeleton, user units or % of the artwork's width.")
            .default("0"),
        Param::length("gap", Axis::X, "The least space between repeated artwork, user units or % of its width.").default("0"),
        Param::length("baseline", Axis::Y, "The height of the artwork, from its bottom, that lies on the skeleton; of lettering its own baseline, unless you give another.")
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
            "Take the skeleton's anchors as control points of a uniform B-spline of this degree; its own curves count for nothing.",
        )
        .within(1.0, 3.0),
        Param::new(
            "glyphs",
            Kind::Choice(&["bend", "rotate", "skew", "ribbon", "stair"]),
            "Letters: bend them, or set them one by one: turned, sheared with upright uprights or level levels, or just moved.",
        )
        .default("bend"),
        Param::flag("skew", "The same as --glyphs skew."),
        Param::flag("ribbon", "The same as --glyphs ribbon."),
        Param::new(
            "spacing",
            Kind::Choice(&["baseline", "even"]),
            "Where lengths are counted: on the skeleton, or at half the artwork's height, which evens out letters in a bend.",
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
            command: "bend samples/logo.svg --along 'M60,190 A400,400 0 0 1 604,190' --stretch scale --baseline 0 --fit grow -o out.svg",
        },
        Example {
            what: "A border of logos round a circle",
            command: "bend samples/logo.svg --along 'M100,400 A300,300 0 1 1 700,400 A300,300 0 1 1 100,400 Z' --stretch repeat --gap 10% --baseline 0 --fit page -o out.svg",
        },
        Example {
            what: "Lettering whose letters turn but keep their shape",
            command: "bend samples/headline.svg --along 'M120,220 A120,120 0 0 1 360,220' --glyphs rotate --spacing even --stretch fit -o out.svg",
        },
        Example {
            what: "A grid along a winding path, by the paper's polynomial map",
            command: "bend samples/grid.svg --along 'M10,120 C60,20 90,20 120,120 S180,220 230,120' --by parameter --stretch fit --width 40% --fit grow -o out.svg",
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
const ON_ARC: super::entry::Pairs = &[("along", ARC), ("baseline", "0")];
const CORNER: super::entry::Pairs = &[("along", "0,0 50,0 50,50"), ("align", "start")];
const PARAMETER: super::entry::Pairs = &[("along", "M0,0 Q30,-40 60,0"), ("by", "parameter"), ("stretch", "fit")];
const EIGHTH: f64 = 50.0 + 50.0 * std::f64::consts::FRAC_PI_4;
const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The handles file.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct HandlesFile {
    pieces: Vec<PieceHandles>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct PieceHandles {
    levels: Vec<Vec<[f64; 2]>>,
}

impl Deformation for Bend {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let missing = || Error::Missing { param: "along".into(), hint: "the path to bend the artwork along".into() };
        let mut path = s.path_if("along")?.ok_or_else(missing)?;
        if let Some(degree) = s.number_if("spline")? {
            path = spline::through(&path, degree as usize)?;
        }
        let rect = s.frame().rect;
        let file = s.file_if("handles")?;
        let as_drawn = s.flag("as-drawn")? || file.is_some();
        let skeleton = Skeleton::new(&path, as_drawn, s.flag("reverse")?)?;
        let by_arc_length = s.choice("by")? == "arclength";
        let size = s.frame().extent(Axis::Diagonal).max(skeleton.length);
        let setting = setting(s)?;

        let base = match s.frame().baseline {
            Some(y) if !s.given("baseline") => y,
            _ => rect.y1 - s.number("baseline")?,
        };
        let stretch = s.choice("stretch")?;
        if stretch != "keep" && rect.width() <= 0.0 {
            return Err(Error::usage("stretch", stretch, "cannot stretch artwork that has no width"));
        }
        let skeleton = match s.choice("spacing")? {
            "even" if file.is_some() || !by_arc_length => {
                return Err(Error::usage(
                    "spacing",
                    "even",
                    "goes with lengths (`by arclength`) and without `handles`",
                ));
            }
            "even" => {
                let (width, height) = (s.number("width")?, base - rect.center().y);
                let scale = if stretch == "scale" { skeleton.even_scale(rect.width(), width * height)? } else { 1.0 };
                skeleton.at_height(width * height * scale)?
            }
            _ => skeleton,
        };
        let skeleton = match &file {
            Some(f) if skeleton.has_arcs() => {
                return Err(Error::input(
                    f.name.clone(),
                    "handles stand on lines and Bézier curves; the skeleton has arcs",
                ));
            }
            Some(_) => skeleton,
            None if by_arc_length => skeleton,
            // Arcs become cubics this near, as a share of the whole.
            None => skeleton.polynomial(1e-9 * size, true),
        };
        let (length, closed) = (skeleton.length, skeleton.closed);
        let middle = if closed && !as_drawn { skeleton.top() } else { 0.5 * length };
        // What v = 1 stands for; artwork without height has nothing to stand up.
        let unit = if rect.height() > 0.0 { rect.height() } else { 1.0 };
        let joined = match &file {
            Some(f) => {
                let file: HandlesFile = serde_json::from_str(&f.text)
                    .map_err(|e| Error::input(f.name.clone(), format!("is no file of handles: {e}")))?;
                let vectors = |l: Vec<[f64; 2]>| l.into_iter().map(|[x, y]| Vec2::new(x, y)).collect();
                let given: Vec<Vec<Vec<Vec2>>> =
                    file.pieces.into_iter().map(|p| p.levels.into_iter().map(vectors).collect()).collect();
                skeleton.with_handles(Some(&given), unit, by_arc_length)?
            }
            None if by_arc_length => skeleton.with_normals()?,
            None => skeleton.with_handles(None, unit, false)?,
        };

        let k = if matches!(stretch, "keep" | "repeat") { 1.0 } else { length / rect.width() };
        let row = match stretch {
            "repeat" => Row::new(rect.width(), s.number("gap")?, length, closed)?,
            _ => Row::ONE,
        };
        let (from, to) = match s.choice("align")? {
            // A row that reaches from end to end begins where the skeleton does.
            _ if row.count > 1 && !closed => (rect.x0, 0.0),
            "start" => (rect.x0, 0.0),
            "end" => (rect.x1, length),
            _ => (rect.center().x, middle),
        };
        let place = Place {
            k,
            origin: to + s.number("offset")? - k * from,
            up: s.number("width")? * if stretch == "scale" { k } else { 1.0 },
            base,
        };
        let pieces = joined.pieces.into_iter().map(Arc::new).collect();
        let shift = row.spacing * (row.count - 1) as f64;
        let rect = kurbo::Rect { x1: rect.x1 + shift, ..rect };
        let reach = (rect.x0 - rect.width(), rect.x1 + rect.width());
        let map = BendMap { pieces, length, closed, place, reach };

        let mut built = Built::new(map.simplest());
        built.note(format!("skeleton: length {length:.6}, {}", if closed { "closed" } else { "open" }));
        built.explanation.notes.extend(joined.notes);
        for c in joined.corners {
            built.warn(format!(
                "bend: the skeleton has a corner at {} (it turns by {:.1}°): the artwork is mitred there; round it for a smooth bend",
                show(c.at),
                c.turn.to_degrees().abs()
            ));
        }
        if stretch == "repeat" {
            built.note(format!("artwork repeated: {} times, one every {:.6}", row.count, row.spacing));
            built.placement.copies = (0..row.count).map(|i| Affine::translate((row.spacing * i as f64, 0.0))).collect();
        }
        if k * rect.width() > length * (1.0 + 1e-9) {
            let what = if closed { "runs over itself" } else { "runs straight on beyond its ends" };
            built.warn(format!(
                "bend: the artwork is {:.6} wide, the skeleton only {length:.6} long: it {what}; see `stretch`",
                k * rect.width()
            ));
        }
        match setting {
            Some(setting) => {
                built.placement.letters =
                    letters::places(&map, setting, &s.frame().letters, &built.placement.copies, stretch == "fit");
                built.explanation.warnings.extend(letters::warnings(&s.frame().letters, &built.placement.letters));
            }
            // A frame round lettering says nothing of the letters' own heights.
            None if s.frame().baseline.is_some() && !s.frame().letters.is_empty() => {
                built
                    .explanation
                    .warnings
                    .extend(map.fold(letters::points(&s.frame().letters, &built.placement.copies)));
            }
            None => built.explanation.warnings.extend(map.fold(map::edges(rect).map(|p| (p, None)))),
        }
        built.overlay(Role::Cage, path.outline.to_bez_path(1e-4 * size));
        Ok(built)
    }
}

/// How letters are set one by one, if they are.
fn setting(s: &Settings<'_>) -> Result<Option<Setting>, Error> {
    let mut said: Vec<&str> = if s.given("glyphs") { vec![s.choice("glyphs")?] } else { Vec::new() };
    for name in ["skew", "ribbon"] {
        if s.flag(name)? {
            said.push(name);
        }
    }
    if let [first, rest @ ..] = said.as_slice()
        && rest.iter().any(|r| r != first)
    {
        return Err(Error::usage("glyphs", said.join(", "), "letters can be set in one way only"));
    }
    let name = said.first().copied().unwrap_or("bend");
    let setting = Setting::named(name);
    if setting.is_some() && s.frame().letters.is_empty() {
        let problem = "needs letters on a level baseline: text, or outlines made by `pathwarp text`. Other outlines do not tell where \
a letter begins; `glyphs bend` bends them";
        return Err(Error::usage("glyphs", name, problem));
    }
    Ok(setting)
}

/// Copies of the artwork side by side.
#[derive(Debug, Clone, Copy)]
struct Row {
    count: usize,
    /// From one to the next.
    spacing: f64,
}

impl Row {
    const ONE: Self = Self { count: 1, spacing: 0.0 };

    /// As many copies of `width` as `length` has room for with at least `gap` between them, spread evenly: on an open skeleton
    /// from its start to its end, on a closed one all round.
    fn new(width: f64, gap: f64, length: f64, closed: bool) -> Result<Self, Error> {
        /// More than this on one skeleton is a slip of the unit.
        const MOST: f64 = 10_000.0;
        let period = width + gap;
        if period <= 0.0 {
            return Err(Error::usage(
                "gap",
                gap.to_string(),
                format!("is no more than minus the artwork's width, {width:.6}"),
            ));
        }
        // Rounding must not refuse what just fits.
        let room = ((if closed { length } else { length + gap }) / period * (1.0 + 1e-9)).floor().max(1.0);
        if room > MOST {
            let problem = format!("would take {room} copies of artwork {width:.6} wide; {MOST} are the most");
            return Err(Error::usage("stretch", "repeat", problem));
        }
        let spacing = match (closed, room > 1.0) {
            (true, _) => length / room,
            (false, true) => (length - width) / (room - 1.0),
            (false, false) => 0.0,
        };
        Ok(Self { count: room as usize, spacing })
    }
}

#[cfg(test)]
mod tests;
