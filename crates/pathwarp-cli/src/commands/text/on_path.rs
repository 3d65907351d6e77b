//! `--on` sets lines on a path, each bent onto it by the deformation `bend`.
//!
//! The upper line stands with its baseline on the path, on the outer side of a closed path, centred at the top. The lower line hangs from
//! the path by the height of its capitals, centred at the bottom, and also reads from left to right, so that both lie in one ring.
//! `--inside` swaps the edges that touch the path, which puts the ring inside of it.

use super::style::Em;
use crate::commands::args::switch;
use crate::steps;
use clap::{Arg, ArgAction, ArgMatches};
use pathwarp::budget::Budget;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, Point, Rect, Shape as _, Vec2};
use pathwarp::map::{AffineMap, Map};
use pathwarp::outline::EllipticArc;
use pathwarp::param::{Args, Axis, Frame, Kind, Letter, NamedPath, Param, Settings};
use pathwarp::recipe::{Recipe, Step};
use pathwarp::{Error, GeometryError, Outline, Seg, Subpath, refit};
use pathwarp_engine::advice::Flags;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::input::{self, PlainArtwork};
use pathwarp_engine::options::{CommonOptions, Given};
use pathwarp_engine::references::{self, HERE};
use pathwarp_engine::session::Session;
use pathwarp_svg::engine::{SetGroup, SetPath};
use pathwarp_text::{Cluster, OutlinedText};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The deformation that bends the lines, and its parameters that are options here.
const BEND: &str = "bend";
const BEND_OPTIONS: [&str; 5] = ["glyphs", "stretch", "spacing", "offset", "reverse"];

const HEADING: &str = "On a path or in a shape";
const ON: &str = "on";
const AT: &str = "at";
const KEEP: &str = "keep-path";
/// Width of a kept path, as a share of the size.
const LINE: f64 = 0.05;
const PARAMS: &[Param] = &[Param::path(ON, ""), Param::new(AT, Kind::Angle, "")];

/// Centres of lines on a circle, in degrees clockwise from the right: its top and bottom.
const TOP: f64 = 270.0;
const BOTTOM: f64 = 90.0;

/// A text-valued option on paths and shapes.
pub(super) fn text_arg(name: &'static str, value: &'static str) -> Arg {
    Arg::new(name).long(name).value_name(value).allow_hyphen_values(true).help_heading(HEADING)
}

/// Draws a path as it is: filled, or as a line of the width `line`.
pub(super) fn unbent_path(
    path: &Outline,
    label: &str,
    line: Option<f64>,
    options: &CommonOptions,
) -> Result<SetPath, Failure> {
    let tolerance = options.tolerance_for(path.bounding_box(), &Frame::new(path.bounding_box().unwrap_or_default()))?;
    let refit = refit::Options::new(tolerance).with_nodes(refit::Nodes::Source);
    let path = pathwarp_svg::warp_path(path, &AffineMap(Affine::IDENTITY), &refit, options.precision);
    Ok(SetPath { label: label.to_owned(), path: path.map_err(Error::from)?, line })
}

pub(super) fn args(registry: &Registry) -> Vec<Arg> {
    let mut all = vec![
        text_arg(ON, "PATHREF").help(
            "Set the text on this path, such as circle:r=60mm, arc:r=60mm,from=180,to=360, spiral:turns=3,inner=20mm,outer=80mm or \
             FILE#NAME: its baseline lies on the path, at the top of a closed one. The middle of a circle is at 0,0",
        ),
        text_arg("below", "WORDS").requires(ON).help(
            "A line on the lower side of the path, in one ring with the other: the height of its capitals lies on the path, its \
             middle at the bottom of a closed one",
        ),
        switch("inside", "Set the lines within the path: the height of capitals lies on it above, the baseline below")
            .requires(ON)
            .help_heading(HEADING),
        switch(KEEP, "Leave the path in the drawing, as a line a twentieth of the size wide")
            .requires(ON)
            .help_heading(HEADING),
        text_arg(AT, "ANGLE").requires(ON).action(ArgAction::Append).help(
            "Middle of the line on a circle or an arc, clockwise from the right, as in arc: [default: 270, the top]; --below is \
             opposite, or where a second --at says",
        ),
    ];
    let bend_args = registry.get(BEND).into_iter().flat_map(|e| steps::args(e.info()));
    let bend_args = bend_args.filter(|a| BEND_OPTIONS.contains(&a.get_id().as_str()));
    all.extend(bend_args.map(|a| a.requires(ON).help_heading(HEADING)));
    all
}

/// Returns `true` if the text is set on a path.
pub(super) fn is_asked_for(m: &ArgMatches) -> bool {
    m.contains_id(ON)
}

/// The lines as set, and warnings.
#[derive(Default)]
pub(super) struct SetLines {
    pub(super) lines: Vec<SetGroup>,
    pub(super) warnings: Vec<String>,
}

/// Sets an upper and a lower text on the path given by `--on`.
pub(super) fn set(
    registry: &Registry,
    m: &ArgMatches,
    [above, below]: [Option<&OutlinedText>; 2],
    em: &Em,
    options: &CommonOptions,
) -> Result<SetLines, Failure> {
    let texts: Vec<(bool, &OutlinedText)> =
        above.map(|t| (false, t)).into_iter().chain(below.map(|t| (true, t))).collect();
    let frames: Vec<Frame> = texts.iter().map(|(_, t)| frame(t, em)).collect();
    let (path, angles) = path_and_angles(m, frames.first().map_or(0.0, |f| f.rect.width()), em, options)?;
    let curve = Curve::new(&path.outline);
    let stretches = m.get_one::<String>("stretch").is_some_and(|s| s != "keep");
    let are_two = texts.len() > 1;
    curve.check(m, are_two, stretches)?;

    // A lower line alone takes the first angle.
    let first = angles.first().copied();
    let second = angles.get(1).copied().or(first.map(|a| a + 180.0));
    let middles = if above.is_some() { [first, second] } else { [first, None] };
    let mut out = SetLines::default();
    if m.get_flag(KEEP) {
        let paths = vec![unbent_path(&path.outline, "", Some(LINE * em.size), options)?];
        out.lines.push(SetGroup { id: Some("path"), label: path.name.clone(), paths, ..SetGroup::default() });
    }
    if let ([a, b], false) = (&frames[..], stretches) {
        let middles = [middles[0].unwrap_or(TOP), middles[1].unwrap_or(BOTTOM)];
        out.warnings.extend(curve.crowded(middles, [a.rect.width(), b.rect.width()]));
    }
    for (((is_below, text), frame), middle) in texts.into_iter().zip(frames).zip(middles) {
        // Two stretched lines take a half of the circle each, less a gap of the letters' size.
        let gap_of_halves = (are_two && stretches).then_some(em.size);
        let placement = curve.place(is_below, m.get_flag("reverse"), middle, gap_of_halves);
        let mut args = placement.args;
        if is_below != m.get_flag("inside") {
            args.push("baseline", (frame.rect.y1 - cap_height(text)).to_string());
        }
        if !curve.closed {
            args.push("align", align(m, text));
        }
        for name in BEND_OPTIONS.iter().filter(|n| !["reverse", "offset"].contains(n)) {
            m.get_one::<String>(name).into_iter().for_each(|value| args.push(name, value));
        }
        if let Some(gap) = em.length(m, "gap")? {
            args.push("gap", gap.to_string());
        }
        let offset = m.get_one::<String>("offset").map_or(Ok(0.0), |t| length(&frame, "offset", t))?;
        args.push("offset", (placement.offset + offset).to_string());
        let (line, warnings) = bend_line(registry, &text.text, frame, args, &placement.path, options)?;
        out.lines.push(line);
        out.warnings.extend(warnings);
    }
    Ok(out)
}

/// A path for lines, with its circle if it is round.
struct Curve<'a> {
    path: &'a Outline,
    round: Option<Round>,
    closed: bool,
}

/// A circle or an arc of one.
struct Round {
    centre: Point,
    radius: f64,
    /// The angle of an open arc's midpoint, in radians.
    middle: f64,
    /// The direction in which `bend` runs an open arc, which is from left to right: 1 if clockwise, −1 if not.
    direction: f64,
}

/// A path adapted to a line, and the values of `bend` for it except for its offset along the path.
struct Placement {
    path: Outline,
    args: Args,
    offset: f64,
}

impl<'a> Curve<'a> {
    fn new(path: &'a Outline) -> Self {
        let closed = matches!(&path.subpaths[..], [only] if only.closed);
        Self { path, round: Round::from_path(path), closed }
    }

    /// Refuses options that do not suit this path. `are_two` is `true` for an upper and a lower line.
    fn check(&self, m: &ArgMatches, are_two: bool, stretches: bool) -> Result<(), Failure> {
        let problem = if self.round.is_none() && m.contains_id(AT) {
            "--at goes with circles and arcs; on another path --offset moves the line along"
        } else if are_two && !self.closed && m.get_flag("inside") {
            "--inside with --below goes with closed paths: on an open one both lines would be on the wrong side"
        } else if are_two && stretches && self.closed && self.round.is_none() {
            "--stretch of two lines goes with circles and open paths: here both would take the whole path"
        } else {
            return Ok(());
        };
        Err(Failure::usage(format!("{problem} (--{ON} {})", m.get_one::<String>(ON).map_or("", String::as_str))))
    }

    /// Warns if two lines of these widths overlap.
    fn crowded(&self, middles: [f64; 2], widths: [f64; 2]) -> Option<String> {
        let half = 0.5 * (widths[0] + widths[1]);
        let room = match &self.round {
            _ if !self.closed => return None,
            Some(r) => r.radius * normalized((middles[0] - middles[1]).to_radians()).abs(),
            None => 0.5 * self.path.to_bez_path(1e-6 * half).perimeter(1e-6 * half),
        };
        (half > room * (1.0 + 1e-9)).then(|| {
            format!(
                "the lines run into each other: half of both is {half:.6} long, and their middles are {room:.6} apart on the path; make \
                 it longer, or --size smaller"
            )
        })
    }

    /// Places a line. On a circle, its path is the whole circle from the point opposite to `middle` (degrees), or with a `gap` the half of
    /// it around `middle`, shortened by the gap.
    fn place(&self, is_below: bool, reverse: bool, middle: Option<f64>, gap: Option<f64>) -> Placement {
        let mut args = Args::new();
        let (mut path, mut offset) = (self.path.clone(), 0.0);
        match &self.round {
            Some(r) if self.closed => {
                let middle = middle.unwrap_or(if is_below { BOTTOM } else { TOP }).to_radians();
                let direction = if is_below == reverse { 1.0 } else { -1.0 };
                path = r.around(middle, direction, gap);
                // Without this, `bend` would choose the direction and the start.
                args.push("as-drawn", "true");
            }
            _ => {
                // `bend` runs closed paths clockwise and open ones from left to right. On a closed path, a lower line reads against that.
                if reverse != (is_below && self.closed) {
                    args.push("reverse", "true");
                }
                if let (Some(r), Some(middle)) = (&self.round, middle) {
                    let direction = if reverse { -r.direction } else { r.direction };
                    offset = direction * r.radius * normalized(middle.to_radians() - r.middle);
                }
            }
        }
        Placement { path, args, offset }
    }
}

impl Round {
    /// Recognizes a path of arcs that are parts of one circle.
    fn from_path(path: &Outline) -> Option<Self> {
        /// Relative difference of radii and centres that counts as zero.
        const SAME: f64 = 1e-9;
        let [only] = &path.subpaths[..] else { return None };
        let arcs = only.segs.iter().map(|s| if let Seg::Arc(a) = s { Some(a) } else { None });
        let arcs: Vec<&EllipticArc> = arcs.collect::<Option<_>>()?;
        let (first, last) = (*arcs.first()?, *arcs.last()?);
        let (centre, radius) = (first.center, first.a.hypot());
        let is_zero = |d: f64| d.abs() <= SAME * radius;
        let is_on_circle = |a: &&EllipticArc| {
            is_zero(a.center.distance(centre))
                && is_zero(a.a.hypot() - radius)
                && is_zero(a.b.hypot() - radius)
                && is_zero(a.a.dot(a.b) / radius)
        };
        if !arcs.iter().all(is_on_circle) {
            return None;
        }
        // The sweep, positive if clockwise.
        let turn = |a: &EllipticArc| a.sweep.copysign(a.sweep * a.a.cross(a.b));
        let sweep: f64 = arcs.iter().map(|a| turn(a)).sum();
        let middle = (first.p0 - centre).atan2() + 0.5 * sweep;
        let direction = if (last.p1.x < first.p0.x) == (sweep < 0.0) { 1.0 } else { -1.0 };
        Some(Self { centre, radius, middle, direction })
    }

    /// Returns the circle around `middle` (radians), or with a `gap` the half of it, shortened by the gap.
    fn around(&self, middle: f64, direction: f64, gap: Option<f64>) -> Outline {
        /// Largest part of a half circle that stays free at each end, in radians.
        const MOST_FREE: f64 = PI / 6.0;
        let half = gap.map_or(PI, |g| 0.5 * PI - (0.5 * g / self.radius).min(MOST_FREE));
        let (u, v) = (Vec2::new(self.radius, 0.0), Vec2::new(0.0, self.radius));
        let arc = EllipticArc::new(self.centre, u, v, middle - direction * half, 2.0 * direction * half);
        Outline { subpaths: vec![Subpath { start: arc.p0, segs: vec![Seg::Arc(arc)], closed: gap.is_none() }] }
    }
}

/// Reduces an angle to between −π and π.
fn normalized(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Returns the part of an open path at which a line is aligned, as a word of `bend`. Lines to `justify` or `fill` are centred.
fn align(m: &ArgMatches, text: &OutlinedText) -> &'static str {
    match m.get_one::<String>("align").map(String::as_str) {
        Some("start") if text.rtl => "end",
        Some("start" | "left") => "start",
        Some("right") => "end",
        _ => "middle",
    }
}

/// Parses a length for the option `name`, of which percentages refer to the frame's width.
fn length(frame: &Frame, name: &str, text: &str) -> Result<f64, Failure> {
    Ok(Settings::new(&[], &Args::new(), frame)?.length_in(name, text, Axis::X)?)
}

/// Returns the path given by `--on`, and the angles of `--at`. Percentages in the path refer to `width`.
fn path_and_angles(
    m: &ArgMatches,
    width: f64,
    em: &Em,
    options: &CommonOptions,
) -> Result<(NamedPath, Vec<f64>), Failure> {
    let mut args = Args::new();
    args.push(ON, m.get_one::<String>(ON).map_or("", String::as_str));
    args.resolve_paths(PARAMS, |reference| on_page(reference, em, options)).map_err(Failure::of_recipe)?;
    let frame = Frame::new(Rect::from_center_size(Point::ORIGIN, (width, width)));
    let frame = frame.with_units_per_px(em.units_per_px());
    let settings = Settings::new(PARAMS, &args, &frame).map_err(Failure::of_recipe)?;
    let angles = m.get_many::<String>(AT).into_iter().flatten().map(|t| settings.angle_in(AT, t));
    let angles: Vec<f64> = angles.collect::<Result<_, _>>()?;
    if angles.len() > 2 {
        return Err(Failure::usage("--at: give two angles at most, one for each line"));
    }
    let path = settings.path_if(ON).map_err(Failure::of_recipe)?;
    let path = path.ok_or_else(|| Failure::usage("--on: name a path, such as circle:r=60mm"))?;
    Ok((path, angles))
}

/// Reads the path of a file that a reference names. The text has its real size on paper, so the path is scaled to its real size, too.
pub(super) fn on_page(reference: &str, em: &Em, options: &CommonOptions) -> Result<Option<Outline>, Error> {
    let [x, y] = em.units_per_px();
    match reference.strip_prefix('#') {
        Some(name) => Err(input::no_document(name)),
        None if !references::names_file(reference, HERE.as_ref()) => Ok(None),
        None => Ok(Some(references::in_px(reference, &options.reading)?.transformed(Affine::scale_non_uniform(x, y)))),
    }
}

/// Returns the box from the lowest baseline to the highest ascent, with the letters.
fn frame(text: &OutlinedText, em: &Em) -> Frame {
    let (top, bottom) = (text.lines.first(), text.lines.last());
    let y = bottom.map_or(0.0, |l| l.start.y);
    let lines = text.line_box();
    let rect = Rect::new(lines.x0, top.map_or(0.0, |l| l.start.y) - text.metrics.ascent, lines.x1, y);
    Frame::new(rect).on_baseline(y).with_letters(as_letters(text)).with_units_per_px(em.units_per_px())
}

/// Converts the letters of a text for deformations.
pub(super) fn as_letters(text: &OutlinedText) -> Arc<[Letter]> {
    let letters = text.lines.iter().flat_map(|l| &l.clusters).filter(|c| !c.outline.is_empty());
    let letter = |c: &Cluster| Letter {
        name: c.text.clone(),
        origin: c.origin,
        advance: c.advance,
        outline: Outline::from(&c.outline),
    };
    letters.map(letter).collect()
}

/// Returns the y coordinate (not the height) of the top of capitals in the first line.
fn cap_height(text: &OutlinedText) -> f64 {
    text.lines.first().map_or(0.0, |l| l.start.y) - text.metrics.cap_height
}

/// Bends a text onto a path.
pub(super) fn bend_line(
    registry: &Registry,
    label: &str,
    frame: Frame,
    mut args: Args,
    path: &Outline,
    options: &CommonOptions,
) -> Result<(SetGroup, Vec<String>), Failure> {
    let params = registry.get(BEND).map_or(&[][..], |e| e.info().params);
    args.push("along", ON);
    args.resolve_paths(params, |_| Ok(Some(path.clone()))).map_err(Failure::of_recipe)?;
    bend_letters(registry, BEND, label, frame, args, options)
}

/// Bends the letters of a frame by one deformation.
pub(super) fn bend_letters(
    registry: &Registry,
    deformation: &str,
    label: &str,
    frame: Frame,
    args: Args,
    options: &CommonOptions,
) -> Result<(SetGroup, Vec<String>), Failure> {
    let letters = Arc::clone(&frame.letters);
    let ink = letters.iter().filter_map(|l| l.outline.bounding_box()).reduce(|a, b| a.union(b));
    let tolerance = options.tolerance_for(ink, &frame)?;
    let budget = Arc::new(Budget::new(options.reading.limits));
    let recipe = Recipe { steps: vec![Step::new(deformation, args)] };
    let session = Session { registry, recipe: &recipe, options, given: &Given::default() };
    let outlines = letters.iter().map(|l| &l.outline).collect();
    let artwork = &mut PlainArtwork { outlines, frame, budget: Arc::clone(&budget) };
    let built = session.ready(artwork, None)?.built.whole;

    let refit = refit::Options::new(tolerance).with_certify(options.certify).with_nodes(options.nodes);
    let refit = refit.with_budget(budget);
    let (copies, places) = (&built.placement.copies, &built.placement.letters);
    let identity = AffineMap(Affine::IDENTITY);
    let set = |(i, letter): (usize, &Letter)| {
        let diagonal = letter.outline.bounding_box().map_or(0.0, |b| b.size().to_vec2().hypot());
        // By default, a letter is held to the tolerance for its size.
        let tolerance = if options.tolerance.is_none() { refit::suited(tolerance, diagonal) } else { tolerance };
        let refit = refit.clone().with_tolerance(tolerance);
        // Letters are placed one by one, before the map (`before`) or instead of it; or they take the copies of the line, and the map.
        let (placed, map): (_, &dyn Map) = match places.get(i) {
            Some(places) if !built.placement.before => (letter.outline.repeated(places), &identity),
            Some(places) => (letter.outline.repeated(places), &built.map),
            None if copies.is_empty() => (letter.outline.clone(), &built.map),
            None => (letter.outline.repeated(copies), &built.map),
        };
        let path = pathwarp_svg::warp_path(&placed, map, &refit, options.precision)?;
        Ok(SetPath { label: letter.name.clone(), path, line: None })
    };
    let paths = letters.iter().enumerate().map(set).collect::<Result<_, GeometryError>>().map_err(Error::from)?;
    let (flags, prefix) = (Flags::of(registry), format!("{deformation}: "));
    // Here, `--size` determines heights and widths.
    let adapted = |w: &String| flags.in_text(w).replacen(&prefix, "", 1).replace("--width", "--size");
    let warnings = built.steps.iter().flat_map(|s| &s.explanation.warnings).map(adapted);
    Ok((SetGroup { label: label.to_owned(), paths, ..SetGroup::default() }, warnings.collect()))
}
