//! `pathwarp badge`: two lines of text in a ring, with lines, separators and a drawing in the middle.
//!
//! Everything is parallel to the outline of the badge. The text lies in the band between the ring lines, with half the height of its
//! capitals on the middle of the band. Lengths are measured there, so that letters of both lines have equal distances at half their height,
//! although the upper ones fan out and the lower ones crowd together.

use super::on_path::{as_letters, bend_line, on_page, unbent_path};
use super::style::{Em, style};
use crate::commands::args::{choice, option, switch};
use clap::{Arg, ArgMatches, value_parser};
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, BezPath, Point, Rect, Shape as _, Vec2};
use pathwarp::outline::boundary;
use pathwarp::param::{Args, Frame, Letter, Param, Settings};
use pathwarp::{Outline, Seg, Subpath};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::lettering::laid_out_with_installed;
use pathwarp_engine::options::CommonOptions;
use pathwarp_engine::{Warper, input};
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::SetGroup;
use pathwarp_svg::sheet::embedded;
use pathwarp_text::{Font, OutlinedText};
use std::collections::BTreeSet;
use std::path::PathBuf;

pub(super) const AFTER: &str = "The type, of the bundled heavy condensed face unless --font names another, is as large as the ring allows, and smaller for long lines; --size and --band overrule that. \
The drawing in the middle is as large as the free room allows. Groups of the result are called ring, upper, lower, separators and center.

Examples:
  pathwarp badge 'HARBOUR COFFEE' 'SINCE 1887' --center samples/icons/cup.svg --ring 2 --dots -o badge.svg
  pathwarp badge 'SUMMIT' 'CAMP' --shape shield --stars --ring 3 --font 'DejaVu Serif' -o badge.svg
  pathwarp badge 'Zoë’s' 'bakery' --shape oval --separator heart --fill '#8a1f2b' --width 60mm -o badge.pdf";

/// The option for the size of the badge, which determines the page's unit, and its default in px.
pub(super) const WIDTH: (&str, f64) = ("width", 480.0);
/// The default font: regular type is too thin for a badge.
pub(super) const FONT: &str = "display";
const SEPARATOR: &str = "separator";
const PARAMS: &[Param] = &[Param::path(SEPARATOR, "")];

/// Width of a ring line as a share of half the badge's width.
const LINE: f64 = 0.026;
/// Width of a thin line beside a ring line, and the gap between them, as shares of [`LINE`].
const THIN: f64 = 0.4;
const LINE_GAP: f64 = 0.9;
/// The widest band as a share of half the badge's width, around a circle and around other shapes.
const BAND: [f64; 2] = [0.36, 0.31];
/// The narrowest band, for long lines, as a share of the widest.
const LEAST_BAND: f64 = 0.45;
/// Height of capitals, and the largest distance of any letter from the middle, as shares of the band.
const CAPITALS: f64 = 0.54;
const LETTER_DISTANCE: f64 = 0.44;
/// The narrowest horizontal scale of letters.
const NARROWEST: f64 = 0.85;
/// The most and the least space added between letters, in em, the least around a circle and around other shapes: feet of letters crowd
/// together in a ring, and more so at its corners.
const TRACKING: f64 = 0.12;
const LEAST_TRACKING: [f64; 2] = [0.03, 0.06];
/// Space on both sides of a separator and between lines without one, and heights of a separator and of a dot, as shares of the capitals.
const SPACE: f64 = 0.8;
const LINE_SPACE: f64 = 1.5 * SPACE;
const SEPARATOR_HEIGHT: f64 = 0.75;
const DOT_HEIGHT: f64 = 0.36;
/// Margin around the drawing in the middle, as a share of half the badge's width.
const CENTER_MARGIN: f64 = 0.12;
/// The size of the em at which texts are measured.
const EM: f64 = 100.0;

pub(super) fn args() -> Vec<Arg> {
    let text = |name, value, help| option(name, value, help).allow_hyphen_values(true);
    vec![
        Arg::new("WORDS")
            .value_names(["UPPER", "LOWER"])
            .num_args(1..=2)
            .required(true)
            .help("The text along the upper side, and the one along the lower side"),
        choice("shape", &["circle", "oval", "shield", "hexagon"], "Outline of the badge").default_value("circle"),
        text(
            WIDTH.0,
            "LENGTH",
            "Width of the badge; with a unit such as 60mm, the page has that unit too [default: 480]",
        ),
        option(
            "ring",
            "N",
            "Lines of the ring: 1 is outside, 2 on both sides of the text, 3 doubles the outer one, 4 both",
        )
        .value_parser(value_parser!(u8).range(0..=4))
        .default_value("2"),
        text(
            "band",
            "LENGTH",
            "Width of the ring between its lines; percentages refer to the width [default: 18%, less for long lines]",
        ),
        switch("dots", "Dots between the lines, as --separator circle"),
        switch("stars", "Stars between the lines, as --separator star").conflicts_with("dots"),
        text(
            SEPARATOR,
            "PATHREF",
            "A shape between the lines: its name, such as heart or leaf, FILE#NAME or path data",
        )
        .conflicts_with_all(["dots", "stars"]),
        option("center", "FILE", "A drawing for the middle, as large as the room within the ring allows")
            .visible_alias("centre")
            .value_parser(value_parser!(PathBuf)),
        text("size", "LENGTH", "Size of the em [default: what the ring has room for]"),
    ]
}

/// Options, fonts and size of a badge.
pub(super) struct Badge<'a> {
    pub(super) registry: &'a Registry,
    pub(super) m: &'a ArgMatches,
    pub(super) fonts: &'a [Font<'a>],
    /// The width of the badge is its size.
    pub(super) em: &'a Em,
    pub(super) options: &'a CommonOptions,
    pub(super) read: &'a ReadOptions,
    /// Weight and slant (`true` for italic) of fonts that are not named.
    pub(super) look: (u16, bool),
}

/// A badge as groups of a drawing.
#[derive(Default)]
pub(super) struct BadgeGroups {
    pub(super) groups: Vec<SetGroup>,
    pub(super) warnings: Vec<String>,
    pub(super) missing: BTreeSet<char>,
}

/// Measures of all elements.
struct Layout {
    /// For each ring line, the distance of its middle from the outline, and its width.
    lines: Vec<(f64, f64)>,
    /// The path of the letters' middles, and its length.
    path: Outline,
    length: f64,
    size: f64,
    /// Horizontal scale of letters, and space between them.
    condensed: f64,
    tracking: f64,
    /// Height of the letters' middle above the baseline, and of capitals.
    middle: f64,
    capitals: f64,
    /// Distance between the free area in the middle and the outline.
    free: f64,
}

impl Badge<'_> {
    /// Makes a badge from an upper text and a lower one.
    pub(super) fn draw(&self, texts: &[Option<String>; 2]) -> Result<BadgeGroups, Failure> {
        let texts: Vec<&str> = texts.iter().flatten().map(String::as_str).collect();
        let natural: Vec<OutlinedText> = texts.iter().map(|t| self.typeset(t, EM, 0.0)).collect::<Result<_, _>>()?;
        let separator = self.separator()?;
        let layout = self.layout(&natural, separator.as_ref())?;
        let mut out = BadgeGroups::default();
        let ring_line = |&(inset, width): &_| unbent_path(&self.inset(inset)?, "", Some(width), self.options);
        let paths: Vec<_> = layout.lines.iter().map(ring_line).collect::<Result<_, Failure>>()?;
        if !paths.is_empty() {
            out.groups.push(SetGroup { id: Some("ring"), label: "ring".into(), paths, ..SetGroup::default() });
        }
        let mut widths = Vec::new();
        for (i, text) in texts.iter().enumerate() {
            let set = self.typeset(text, layout.size, layout.tracking)?;
            // Letters from right to left may be joined, and are bent; others are only turned.
            let glyphs = if set.rtl { "bend" } else { "rotate" };
            let narrow = Affine::scale_non_uniform(layout.condensed, 1.0);
            let letters: Vec<Letter> = as_letters(&set).iter().map(|l| narrowed(l, narrow)).collect();
            let (frame, width) = self.letters_frame(letters, set.lines.first().map_or(0.0, |l| l.start.y));
            let (group, warnings) = self.line_on_ring(text, frame, &layout, i == 1, 0.0, glyphs)?;
            out.groups.push(SetGroup { id: Some(["upper", "lower"][i]), ..group });
            // The curvature of the ring is fixed, so letters that touch need space.
            out.warnings.extend(warnings.into_iter().map(|w| match w.split_once(", first near") {
                Some((problem, _)) => format!("{problem}; --letter-spacing 6% sets them apart"),
                None => w,
            }));
            out.missing.extend(&set.missing);
            widths.push(width);
        }
        if let Some(shape) = &separator {
            out.groups.push(self.separators(shape, &layout, &widths)?);
        }
        out.groups.extend(self.center_drawing(&layout)?);
        Ok(out)
    }

    /// Lays out one line of text.
    fn typeset(&self, text: &str, size: f64, tracking: f64) -> Result<OutlinedText, Failure> {
        let mut style = style(self.m, &self.em.resized(size))?;
        style.letter_spacing += tracking;
        let limits = self.options.reading.limits.for_input(text.len());
        let set = laid_out_with_installed(text, self.fonts, &style, self.look, self.read, &limits)?;
        if set.lines.len() > 1 || set.ink().is_none() {
            return Err(Failure::usage(format!("“{}” is not one line of text", text.escape_debug())));
        }
        Ok(set)
    }

    fn half_width(&self) -> f64 {
        0.5 * self.em.size
    }

    fn shape(&self) -> &str {
        self.m.get_one::<String>("shape").map_or("circle", String::as_str)
    }

    /// Returns the outline of the badge, moved inwards.
    fn inset(&self, by: f64) -> Result<Outline, Failure> {
        let half = self.half_width();
        let ellipse = |a: f64, b: f64| {
            let data = format!("M{},0A{a},{b} 0 0 1 {a},0A{a},{b} 0 0 1 {},0Z", -a, -a);
            Outline::from_svg(&data).map_err(|e| pathwarp::Error::from(e).into())
        };
        let data = match self.shape() {
            "oval" => return self.offset(&ellipse(half, OVAL * half)?, by, "inside"),
            "shield" => SHIELD,
            "hexagon" => HEXAGON,
            _ => return ellipse(half - by, half - by),
        };
        let shape = Outline::from_svg(data).map_err(pathwarp::Error::from)?.transformed(Affine::scale(half));
        // The round corners of all lines are concentric.
        let core = self.offset(&shape, half * CORNER, "inside")?;
        let radius = half * CORNER - by;
        self.offset(&core, radius.abs(), if radius > 0.0 { "outside" } else { "inside" })
    }

    /// Returns a path moved to one side.
    fn offset(&self, path: &Outline, by: f64, side: &str) -> Result<Outline, Failure> {
        if by < 1e-9 * self.half_width() {
            return Ok(path.clone());
        }
        let values = [("by", by.to_string()), ("side", side.to_owned())];
        let moved = Warper::edit(self.registry, "offset", &values).and_then(|edit| edit.warp_outline(path));
        let moved = moved.map_err(|e| Failure::Geometry(e.to_string()))?;
        Ok(Outline::from(&moved.path.path))
    }

    /// Returns the middle line of a band between two distances from the outline, and its length.
    fn band_middle(&self, from: f64, to: f64) -> Result<(Outline, f64), Failure> {
        let path = self.inset(0.5 * (from + to))?;
        let fine = 1e-5 * self.half_width();
        let length = path.to_bez_path(fine).perimeter(fine);
        Ok((path, length))
    }
}

/// Returns a closed path that is symmetrical about the y axis, once around: clockwise from its lowest point on the axis, or
/// counterclockwise from the highest.
fn cut_at_axis(path: &Outline, from_top: bool) -> Outline {
    /// Enough for all bits of a parameter.
    const HALVINGS: u32 = 60;
    let fine = 1e-7 * path.extent();
    let path = &Outline::from(&path.to_bez_path(fine));
    let [only] = &path.subpaths[..] else { return path.clone() };
    let segs = &only.segs;
    let crossing = |i: usize| {
        let seg = &segs[i];
        let (a, b) = (seg.eval(0.0).x, seg.eval(1.0).x);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let t = 0.5 * (low + high);
            if (seg.eval(t).x < 0.0) == (a < 0.0) { low = t } else { high = t }
        }
        ((a < 0.0) != (b < 0.0)).then(|| (i, high, seg.eval(high)))
    };
    let depth = |p: Point| if from_top { p.y } else { -p.y };
    let crossings = (0..segs.len()).filter_map(crossing);
    let Some((i, t, start)) = crossings.min_by(|a, b| depth(a.2).total_cmp(&depth(b.2))) else { return path.clone() };
    let (first, last) = (segs[i].part(t, 1.0), segs[i].part(0.0, t));
    let rest = segs[i + 1..].iter().chain(&segs[..i]).copied();
    let segs: Vec<Seg> = first.into_iter().chain(rest).chain(last).collect();
    let mut area = 0.0;
    boundary(path.to_bez_path(fine), 1e4 * fine, |a, b| area += a.to_vec2().cross(b.to_vec2()));
    let cut = Subpath { start, segs, closed: true };
    // Positive areas are clockwise, since y points down.
    let is_clockwise = area > 0.0;
    Outline { subpaths: vec![if is_clockwise == from_top { cut.reversed() } else { cut }] }
}

/// Outlines about the origin, from x = -1 to 1 once corners are round: the height of an oval, a shield with an arched top, and a hexagon.
const OVAL: f64 = 0.76;
const SHIELD: &str = "M-1,-.62 A1.3,1.3 0 0 1 1,-.62 L1,.05 C1,.6 .55,.98 0,1.25 C-.55,.98 -1,.6 -1,.05 Z";
const HEXAGON: &str = "M-1.0928,0 L-.5464,-.9464 L.5464,-.9464 L1.0928,0 L.5464,.9464 L-.5464,.9464 Z";
/// Radius of the outermost corners.
const CORNER: f64 = 0.6;

/// Scales a letter horizontally.
fn narrowed(letter: &Letter, narrow: Affine) -> Letter {
    Letter {
        name: letter.name.clone(),
        origin: narrow * letter.origin,
        advance: letter.advance * narrow.as_coeffs()[0],
        outline: letter.outline.transformed(narrow),
    }
}

/// Returns the centroid and the area of a path; `None` without an area.
fn centroid(path: &BezPath, tolerance: f64) -> Option<(Point, f64)> {
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    boundary(path.elements().iter().copied(), tolerance, |a, b| {
        let cross = a.to_vec2().cross(b.to_vec2());
        area += cross;
        moment = [moment[0] + cross * (a.x + b.x), moment[1] + cross * (a.y + b.y)];
    });
    (area != 0.0).then(|| (Point::new(moment[0] / (3.0 * area), moment[1] / (3.0 * area)), 0.5 * area.abs()))
}

impl Badge<'_> {
    /// Computes the layout with the largest type that fits.
    fn layout(&self, natural: &[OutlinedText], separator: Option<&Outline>) -> Result<Layout, Failure> {
        let (half, rings) = (self.half_width(), self.m.get_one::<u8>("ring").copied().unwrap_or(2));
        let line_width = LINE * half;
        // Outside of the band are a line, or a thin one, a gap and a line.
        let band_start = match rings {
            0 => 0.0,
            1 | 2 => line_width,
            _ => line_width * (THIN + LINE_GAP + 1.0),
        };
        let heights = Heights::of(natural);
        let kind = usize::from(self.shape() != "circle");
        let widest = BAND[kind];
        let (given_band, given_size) = (self.em.length(self.m, "band")?, self.em.length(self.m, "size")?);
        // The share `t` reduces the band, or the size in a band that is given.
        let band_and_size = |t: f64| {
            let band = given_band.or(given_size.map(|s| s * heights.capitals / CAPITALS)).unwrap_or(t * widest * half);
            let share = if given_band.is_some() { t } else { 1.0 };
            let fits = (share * CAPITALS / heights.capitals).min(LETTER_DISTANCE / heights.distance) * band;
            (band, given_size.unwrap_or(fits))
        };
        let separator_width = separator.map_or(0.0, |s| {
            let b = s.bounding_box().unwrap_or_default();
            SEPARATOR_HEIGHT * b.width() / b.height()
        });
        // Lengths without a size are in em.
        let gap = if separator.is_some() { 2.0 * SPACE + separator_width } else { LINE_SPACE } * heights.capitals;
        let letter_gaps: usize =
            natural.iter().flat_map(|t| &t.lines).map(|l| l.clusters.len().saturating_sub(1)).sum();
        let may_space = self.m.get_one::<String>("letter-spacing").is_none();
        let least = if may_space { LEAST_TRACKING[kind] } else { 0.0 };
        let widths: f64 =
            natural.iter().filter_map(|t| Some(t.ink()?.width() / EM)).sum::<f64>() + least * letter_gaps as f64;
        let gaps = gap * natural.len() as f64;
        let layout_at = |t: f64| {
            let (band, size) = band_and_size(t);
            let (path, length) = self.band_middle(band_start, band_start + band)?;
            Ok::<_, Failure>((path, length, band, size))
        };
        // The length of the path that letters and gaps leave.
        let spare = |(_, length, _, size): &(Outline, f64, f64, f64)| length - size * (widths + gaps);
        let mut found = layout_at(1.0)?;
        if spare(&found) < 0.0 && given_size.is_none() {
            let (mut fits, mut too_large) = (LEAST_BAND, 1.0);
            found = layout_at(fits)?;
            while spare(&found) > 0.0 && too_large - fits > 0.01 {
                let t = 0.5 * (fits + too_large);
                let tried = layout_at(t)?;
                if spare(&tried) >= 0.0 {
                    (fits, found) = (t, tried);
                } else {
                    too_large = t;
                }
            }
        }
        let spare = spare(&found);
        let (path, length, band, size) = found;
        let condensed = ((length / size - gaps) / widths).min(1.0);
        if condensed < NARROWEST {
            return Err(Failure::usage(format!(
                "the texts are too long for the ring: they would need {:.0} % more of it; shorten them{}{}",
                100.0 * (NARROWEST * widths + gaps - length / size) * size / length,
                if self.m.contains_id("font") { ", take a narrower font such as --font display" } else { "" },
                if given_size.is_some() { ", or make --size smaller" } else { "" }
            )));
        }
        // Half of the spare length goes between letters, the rest between the lines.
        let more = if may_space && letter_gaps > 0 { 0.5 * spare / letter_gaps as f64 } else { 0.0 };
        let tracking = least * size + more.clamp(0.0, (TRACKING - least) * size);
        let mut lines = Vec::new();
        let band_end = band_start + band;
        lines.extend((rings >= 3).then_some((0.5 * THIN * line_width, THIN * line_width)));
        lines.extend((rings >= 1).then_some((band_start - 0.5 * line_width, line_width)));
        lines.extend((rings >= 2).then_some((band_end + 0.5 * line_width, line_width)));
        lines
            .extend((rings == 4).then_some((band_end + line_width * (1.0 + LINE_GAP + 0.5 * THIN), THIN * line_width)));
        let free = lines.last().filter(|_| rings > 1).map_or(band_end, |(inset, width)| inset + 0.5 * width);
        let (middle, capitals) = (heights.middle * size, heights.capitals * size);
        Ok(Layout { lines, path, length, size, condensed, tracking, middle, capitals, free })
    }

    /// Returns the frame of letters on a baseline, as wide as their ink and higher than any letter, and that width.
    fn letters_frame(&self, letters: Vec<Letter>, baseline: f64) -> (Frame, f64) {
        let ink = letters.iter().filter_map(|l| l.outline.bounding_box()).reduce(|a, b| a.union(b)).unwrap_or_default();
        let rect = Rect::new(ink.x0, baseline - self.em.size, ink.x1, baseline);
        let frame = Frame::new(rect).with_units_per_px(self.em.units_per_px());
        (frame.with_letters(letters.into()), ink.width())
    }

    /// Sets a line in the middle of the upper or lower side, moved along the path by an offset.
    fn line_on_ring(
        &self,
        label: &str,
        frame: Frame,
        layout: &Layout,
        is_lower: bool,
        offset: f64,
        glyphs: &str,
    ) -> Result<(SetGroup, Vec<String>), Failure> {
        let middle = layout.middle.to_string();
        let mut args = Args::from_pairs(&[("as-drawn", "true"), ("glyphs", glyphs), ("baseline", &middle)]);
        args.push("offset", offset.to_string());
        bend_line(self.registry, label, frame, args, &cut_at_axis(&layout.path, is_lower), self.options)
    }

    /// Returns the shape between the lines.
    fn separator(&self) -> Result<Option<Outline>, Failure> {
        let reference = match (self.m.get_flag("dots"), self.m.get_flag("stars")) {
            (true, _) => Some("circle"),
            (false, true) => Some("star"),
            (false, false) => self.m.get_one::<String>(SEPARATOR).map(String::as_str),
        };
        let Some(reference) = reference else { return Ok(None) };
        let mut args = Args::from_pairs(&[(SEPARATOR, reference)]);
        args.resolve_paths(PARAMS, |r| on_page(r, self.em, self.options)).map_err(Failure::of_recipe)?;
        let frame = Frame::new(Rect::new(0.0, 0.0, EM, EM)).with_units_per_px(self.em.units_per_px());
        let path =
            Settings::new(PARAMS, &args, &frame).and_then(|s| s.path_if(SEPARATOR)).map_err(Failure::of_recipe)?;
        let Some(path) = path.map(|p| p.outline) else { return Ok(None) };
        let bounds = path.bounding_box().filter(|b| b.width() > 0.0 && b.height() > 0.0);
        bounds
            .map(|_| Some(path))
            .ok_or_else(|| Failure::usage(format!("--separator: {reference} has no area; choose another shape")))
    }

    /// Sets the separators halfway between the ends of the lines.
    fn separators(&self, shape: &Outline, layout: &Layout, widths: &[f64]) -> Result<SetGroup, Failure> {
        let bounds = shape.bounding_box().unwrap_or_default();
        let height = if self.m.get_flag("dots") { DOT_HEIGHT } else { SEPARATOR_HEIGHT } * layout.capitals;
        let centre = centroid(&shape.to_bez_path(1e-4 * bounds.height()), 1e-4 * bounds.height());
        let placed = Affine::translate((0.0, -layout.middle))
            * Affine::scale(height / bounds.height())
            * Affine::translate(-centre.map_or(bounds.center(), |c| c.0).to_vec2());
        let outline = shape.transformed(placed);
        let half = 0.5 * layout.length;
        let offsets = match widths {
            [upper, lower] => vec![0.5 * (half + 0.5 * (upper - lower)), -0.5 * (half + 0.5 * (upper - lower))],
            _ => vec![half],
        };
        let mut group = SetGroup { id: Some("separators"), label: "separators".into(), ..SetGroup::default() };
        for offset in offsets {
            let letter = Letter { name: String::new(), origin: Point::ORIGIN, advance: 0.0, outline: outline.clone() };
            let (frame, _) = self.letters_frame(vec![letter], 0.0);
            let rect = Rect::new(-height, frame.rect.y0, height, 0.0);
            let (set, _) = self.line_on_ring("", Frame { rect, ..frame }, layout, false, offset, "rotate")?;
            group.paths.extend(set.paths);
        }
        Ok(group)
    }

    /// Returns the drawing in the middle, as large as fits. The midpoint of its centroid and its box's centre is the free area's centroid.
    fn center_drawing(&self, layout: &Layout) -> Result<Option<SetGroup>, Failure> {
        const HALVINGS: u32 = 40;
        /// Strokes enlarge the box of the paths by at most this factor. Shadows enlarge it more, and may overlap.
        const MOST_BEYOND: f64 = 1.2;
        let Some(file) = self.m.get_one::<PathBuf>("center") else { return Ok(None) };
        let (half, reading) = (self.half_width(), &self.options.reading);
        let doc = input::document(file, reading)?;
        let (seen, content) =
            embedded(&doc.decoded(), &input::display(file), "center-", &input::read_options(file, reading))?;
        let inset = layout.free + CENTER_MARGIN * half;
        let room = self.inset(inset)?.to_bez_path(1e-5 * half);
        // A circle that is moved inwards beyond its centre grows again.
        let middle = centroid(&room, 1e-4 * half).filter(|_| inset < half);
        let (middle, _) =
            middle.ok_or_else(|| Failure::usage("--center: the ring leaves no room; make --band smaller"))?;
        let painted = doc.shapes().iter().filter(|s| s.painted);
        let paths = painted.map(|s| (s.outline.transformed(doc.user_to_px()), s.filled));
        let paths: Vec<(Outline, bool)> = paths.collect();
        let fine = 1e-3 * seen.width().max(seen.height());
        let filled = paths.iter().filter(|(_, is_filled)| *is_filled);
        let centroids = filled.filter_map(|(p, _)| centroid(&p.to_bez_path(fine), fine));
        let (sum, area) =
            centroids.fold((Vec2::ZERO, 0.0), |(sum, all), (c, area)| (sum + c.to_vec2() * area, all + area));
        let weight = if area > 0.0 { (sum / area).to_point() } else { seen.center() };
        let anchor = seen.center().midpoint(weight);
        let segs = paths.iter().flat_map(|(p, _)| p.segs());
        let mut points: Vec<Point> = segs.flat_map(|s| [0.0, 0.25, 0.5, 0.75].map(|t| s.eval(t))).collect();
        if points.is_empty() {
            points.extend(Frame::new(seen).corners());
        }
        let ink = points.iter().fold(Rect::from_points(points[0], points[0]), |r, p| r.union_pt(*p));
        let beyond = (seen.width() / ink.width()).max(seen.height() / ink.height()).clamp(1.0, MOST_BEYOND);
        let fits = |scale: f64| points.iter().all(|p| room.contains(middle + (*p - anchor) * (scale * beyond)));
        let (mut small, mut large) = (0.0, 2.0 * half / fine);
        for _ in 0..HALVINGS {
            let scale = 0.5 * (small + large);
            if fits(scale) { small = scale } else { large = scale }
        }
        let Vec2 { x, y } = middle.to_vec2() - anchor.to_vec2() * small;
        let drawing = format!(
            "<g transform=\"matrix({small} 0 0 {small} {x} {y})\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">{content}</g>\n"
        );
        Ok(Some(SetGroup { id: Some("center"), label: "center".into(), drawing, ..SetGroup::default() }))
    }
}

/// Heights of letters, with an em of 1.
struct Heights {
    capitals: f64,
    /// The height of the letters' middle above the baseline.
    middle: f64,
    /// The greatest distance of any point of a letter from the middle.
    distance: f64,
}

impl Heights {
    fn of(texts: &[OutlinedText]) -> Self {
        /// Letters lower than this share of the capitals are small ones without ascenders.
        const SMALL: f64 = 0.85;
        let metrics = texts[0].metrics.scaled(1.0 / EM);
        let ends = texts.iter().filter_map(|t| {
            let (ink, base) = (t.ink()?, t.lines.first()?.start.y);
            Some(((base - ink.y0) / EM, (base - ink.y1) / EM))
        });
        let (top, bottom) = ends.reduce(|a, b| (a.0.max(b.0), a.1.min(b.1))).unwrap_or_default();
        let capitals = if top < SMALL * metrics.cap_height { metrics.x_height } else { metrics.cap_height };
        let middle = 0.5 * capitals;
        Self { capitals, middle, distance: (top - middle).max(middle - bottom).max(middle) }
    }
}
