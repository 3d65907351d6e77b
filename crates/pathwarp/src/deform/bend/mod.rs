//! Bends artwork along a skeleton.
//!
//! The artwork's horizontals run along the skeleton curve C, and its verticals stand on it: F(x, y) = C(u) + v·S(u), where u grows with
//! x, and v with the height d above the baseline. There are two kinds of sides S:
//!
//! - **unit normals** ([`map`]): u is given by the arc length s, so that ∂F/∂s = (1 + κd)·T and ∂F/∂d = N with the curvature κ, the unit
//!   tangent T and the unit normal N. The strip is as high as the artwork everywhere, and folds beyond the centre of curvature, where
//!   1 + κd = 0. At corners S turns into the mitre, along a whole curve but only the end of a line, so that offsets of polygons are exact;
//! - **handles** ([`map`]): the generalised algorithm of de Casteljau, with one handle per leg of the control polygon, and deeper
//!   levels on request. F is polynomial in u and v, and the image of a Bézier curve is exactly a Bézier curve. By default a handle is
//!   the leg's normal, as long as the artwork is high. Where pieces meet, and on splines ([`spline`]), handles stand at the control
//!   points instead, which keeps parallels smooth.
//!
//! The paper is *A generalized de Casteljau approach to 3D free-form deformation* (Chang & Rockwood, SIGGRAPH 1994), here in the plane;
//! its joint conditions (4) and (5) are checked and reported. Joints of the skeleton are creases: verticals in the artwork.

#[cfg(feature = "serde")]
mod file;
mod letters;
mod map;
mod skeleton;
mod spline;
#[cfg(test)]
mod tests;

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law, Pairs, Role};
use crate::anchors;
use crate::error::{Error, show};
use crate::outline::Outline;
use crate::param::{Axis, Choice as _, Kind, Letter, NamedPath, NamedText, Settings, choice, is_spiral, parameters};
use kurbo::{Affine, Point, Rect, Vec2};
use map::{BendMap, MAX_DEGREE, ToStrip};
use skeleton::{Corner, Joined, Skeleton};
use spline::Spline;
use std::sync::Arc;

pub use letters::LetterSetting;

parameters! {
    /// A bend along a path, the skeleton: horizontals run along it, verticals stand on it.
    ///
    /// F(x, y) = C(u) + v·S(u) with C the skeleton by arc length, u growing with x, v with the height above the baseline, and S the
    /// unit normal (blended into the mitre at corners), or the paper's handles.
    ///
    /// ```
    /// use pathwarp::{Outline, deform::Bend, kurbo::{Point, Rect}, map::Map};
    ///
    /// let arc = Outline::from_svg("M0,50 A50,50 0 0 1 100,50")?;
    /// let bent = Bend::new(Rect::new(0.0, 0.0, 100.0, 100.0), &arc).baseline(100.0).build()?;
    /// assert!(bent.map.point(Point::new(50.0, 100.0)).distance(Point::new(50.0, 0.0)) < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct Bend(s, along: NamedPath) {
        // `param = …` declares a parameter without a field; fields after `let` follow from the settings `s`.
        /// The skeleton: one connected path, such as circle:r=60mm, arc:r=60mm,from=200,to=340 or
        /// spiral:turns=3,inner=20mm,outer=80mm.
        /// It is needed unless there is a preset.
        param = path("along");
        /// Lengths: keep them, scale the artwork evenly to the skeleton's length, fit its width only, or repeat it all along.
        stretch: Stretch = new("stretch", Kind::Choice(Stretch::WORDS)).default("keep");
        /// Part of the artwork that comes to this part of the skeleton.
        align: Align = new("align", Kind::Choice(Align::WORDS)).default("middle");
        /// Shift along the skeleton, in units or % of the artwork's width.
        offset: f64 = length("offset", Axis::X).default("0");
        /// Set copies side by side, or as many as fit (fill), spread evenly.
        param = new("copies", Kind::Text("N|fill"));
        /// Least space between copies, in units or % of the width.
        gap: f64 = length("gap", Axis::X).default("0");
        /// The height of the artwork, from its bottom, that lies on the skeleton. Default for lettering: the lettering's baseline.
        param = length("baseline", Axis::Y).default("50%");
        /// Heights are multiplied by this.
        width: f64 = number("width").default("100%").within(1e-6, 1e6).slider(0.1, 3.0);
        /// Run evenly along the skeleton, or by its pieces' parameters with handles for sides.
        by_parameter: bool = either("by", &["arclength", "parameter"]);
        /// A JSON file of handles, of the skeleton's pieces or of a spline's points; the skeleton is then taken as drawn.
        param = new("handles", Kind::File);
        /// Take the skeleton's anchors as control points of a uniform B-spline of this degree; the curves between them are ignored.
        spline: Option<usize> = new("spline", Kind::Count).within(1.0, MAX_DEGREE as f64).slider(1.0, 5.0);
        /// Lay a smooth skeleton through the anchors; curves are ignored.
        interpolate: bool = flag("interpolate");
        /// Stretch the artwork lengthwise, let it swell in the middle, or taper it to its right, instead of bending it.
        param = new("preset", Kind::Choice(PRESETS));
        /// The length of a stretch, the height of the middle of a swell, or of the right end of a taper. Default: 150 %, of a taper 50 %.
        param = number("factor").within(0.0, 100.0).slider(0.0, 3.0);
        /// Letters, or without lettering the objects of a drawing: bend them, or set them one by one: turned, sheared with vertical verticals
        /// or horizontal horizontals, or just moved.
        param = new("glyphs", Kind::Choice(&["bend", "rotate", "skew", "ribbon", "stair"])).default("bend");
        /// Set objects one by one, of which a text is one, instead of letters.
        param = flag("objects");
        /// Short for --glyphs skew.
        param = flag("skew");
        /// Short for --glyphs ribbon.
        param = flag("ribbon");
        /// Measure lengths on the skeleton, or at half the artwork's height, where letters are even.
        even: bool = either("spacing", &["baseline", "even"]);
        /// Run the skeleton as drawn, a closed one from its start.
        as_drawn: bool = flag("as-drawn");
        /// Run the skeleton the other way.
        reverse: bool = flag("reverse");
        let frame: Rect = s.frame().rect;
        // The y of the line that lies on the skeleton.
        let baseline: f64 = match s.frame().baseline {
            Some(y) if !s.given("baseline") => y,
            _ => s.frame().rect.y1 - s.number("baseline")?,
        };
        let handles: Option<Handles> = s.file_if("handles")?.map(handles).transpose()?;
        let setting: Option<LetterSetting> = setting(s)?;
        let letters: Arc<[Letter]> = Arc::clone(&s.frame().letters);
        let objects: Arc<[Letter]> = Arc::clone(&s.frame().objects);
        let sets_objects: bool = s.flag("objects")?;
        // Copies of the artwork: so many, or as many as fit.
        let copies: Option<Option<usize>> = copies(s)?;
        // The frame was laid around the letters, and does not show their heights.
        let around_letters: bool = s.frame().baseline.is_some();
        // Points of the artwork; empty if they are not known.
        let ink: Arc<[Point]> = Arc::clone(&s.frame().ink);
    }
}

choice! {
    /// The lengths of artwork on a skeleton.
    #[non_exhaustive]
    pub enum Stretch {
        /// Lengths are kept.
        Keep = "keep",
        /// The artwork is scaled to the skeleton's length.
        Scale = "scale",
        /// The artwork's width is stretched to the skeleton's length.
        Fit = "fit",
        /// Copies of the artwork stand side by side, as many as fit, spread evenly.
        Repeat = "repeat",
    }
}

choice! {
    /// Part of the artwork that comes to this part of the skeleton.
    pub enum Align {
        /// Left edge to start.
        Start = "start",
        /// Middle to middle; of a closed skeleton, to its highest point, or to its lowest if it is run in reverse.
        Middle = "middle",
        /// Right edge to end.
        End = "end",
    }
}

impl Bend {
    /// Creates a bend of the box `frame` along one connected path. An open path is run left to right, a closed one clockwise.
    /// The middle of the box lies on the path's middle, and nothing is stretched.
    #[must_use]
    pub fn new(frame: Rect, along: &Outline) -> Self {
        Self::defaults(frame, NamedPath { name: "along".into(), outline: along.clone() })
    }

    setters! {
        /// Sets the y of the line that lies on the skeleton. Default: the middle of the box.
        baseline(y: f64) => baseline: y;
        /// Sets the paper's handles: for every piece of degree n the n handles of the first level, then n−1 of the second, and so
        /// on; deeper levels may be omitted. A handle is the image of the artwork's height. The skeleton is taken as drawn.
        handles(pieces: Vec<Vec<Vec<Vec2>>>) => handles: Some(Handles::Pieces(pieces));
        /// Sets the handles at the points of a skeleton that is a B-spline or interpolates its points; `None` takes the default.
        handles_at_points(handles: Vec<Option<Vec2>>) => handles: Some(Handles::Points(handles));
        /// Sets letters one by one instead of bending them; their places are in
        /// [`Placement::letters`](crate::deform::Placement::letters).
        letters(letters: Arc<[Letter]>, setting: LetterSetting) => letters: letters, setting: Some(setting);
    }

    /// Builds the map. Folds and artwork longer than the skeleton give warnings.
    ///
    /// # Errors
    /// [`Error::Geometry`] or [`Error::Usage`] for a skeleton that is not one connected path, has no length or turns back on
    /// itself; [`Error::Usage`] for values out of range or that contradict each other, [`Error::Input`] for handles that do
    /// not fit the skeleton.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let rect = self.frame;
        let skeleton = self.skeleton()?;
        let size = rect.width().hypot(rect.height()).max(skeleton.length);
        self.check_together()?;
        let skeleton = self.measured(skeleton, size)?;
        let (length, closed, cage) = (skeleton.length, skeleton.closed, skeleton.path(1e-4 * size));
        let middle = if closed && !self.is_as_drawn() { skeleton.extreme(self.reverse) } else { 0.5 * length };
        let Joined { pieces, corners, notes, warning } = self.joined(skeleton)?;

        let spreads_letters = self.spreads_letters(closed);
        let x_scale = match self.stretch {
            Stretch::Scale | Stretch::Fit if !spreads_letters => length / rect.width(),
            _ => 1.0,
        };
        let sets_objects = self.setting.is_some() && (self.sets_objects || self.letters.is_empty());
        let copies = self.copies.or((self.stretch == Stretch::Repeat).then_some(None));
        let gaps = if sets_objects { self.objects.len().max(1) } else { 1 };
        let width = if sets_objects { self.objects.iter().map(|o| self.width * o.advance).sum() } else { rect.width() };
        let repeats = match copies {
            Some(count) => Repeats::new(count, (width, gaps as f64, self.gap), length, closed)?,
            None => Repeats::ONE,
        };
        // This x of the artwork comes to this distance along the skeleton.
        let (from, to) = match self.align {
            // Copies on an open skeleton begin at its start.
            _ if repeats.count > 1 && !closed => (rect.x0, 0.0),
            Align::Start => (rect.x0, 0.0),
            Align::End => (rect.x1, length),
            Align::Middle => (rect.center().x, middle),
        };
        let strip_scaled = |x_scale: f64, y_scale: f64| {
            let offset = to + self.offset - x_scale * from;
            ToStrip { x_scale, offset, y_scale, baseline: self.baseline }
        };
        let to_strip = strip_scaled(x_scale, self.width * if self.stretch == Stretch::Scale { x_scale } else { 1.0 });
        let ring_strip = spreads_letters.then(|| strip_scaled(length / rect.width(), 1.0));
        let pieces = pieces.into_iter().map(Arc::new).collect();
        let shift = repeats.spacing * (repeats.count - 1) as f64;
        let rect = Rect { x1: rect.x1 + shift, ..rect };
        let crease_range = (rect.x0 - rect.width(), rect.x1 + rect.width()); // Artwork may exceed its frame.
        let map = BendMap { pieces, length, closed, to_strip, crease_range };

        let mut built = Built::new(map.simplest());
        (built.explanation.notes, built.explanation.warnings) = (notes, warning.into_iter().collect());
        // Objects that are spread over the skeleton are never longer than it.
        let spreads_objects = sets_objects && (copies.is_some() || self.stretch == Stretch::Fit);
        let visible = if spreads_objects { [rect.x0; 2] } else { self.visible_range(rect, shift) };
        explain(&mut built, &map, &corners, visible);
        if copies.is_some() {
            built.note(format!("artwork repeated: {} times, one every {:.6}", repeats.count, repeats.spacing));
            let most = Repeats::new(None, (width, gaps as f64, self.gap), length, closed)?.count;
            if repeats.count > most {
                let count = repeats.count;
                built.warn(format!("bend: only {most} copies fit with this gap between them; {count} are nearer"));
            }
        }
        if copies.is_some() && !sets_objects {
            let copy = |i| Affine::translate((repeats.spacing * i as f64, 0.0));
            built.placement.copies = (0..repeats.count).map(copy).collect();
        }
        if sets_objects {
            let count = spreads_objects.then_some(repeats.count);
            let setting = self.setting.unwrap_or(LetterSetting::Rotate);
            let first_at = if closed { middle } else { 0.0 } + self.offset;
            built.placement.letters = letters::object_maps(&map, setting, &self.objects, count, first_at);
            built.placement.of_objects = true;
        } else {
            self.set_letters(&mut built, &map, rect, ring_strip);
        }
        built.overlay(Role::Cage, cage);
        let heights = self.heights(1.0).map(|d| d / self.unit());
        map.first_level(heights).into_iter().for_each(|quads| built.overlay(Role::Cage, quads));
        Ok(built)
    }

    /// Builds the skeleton.
    fn skeleton(&self) -> Result<Skeleton, Error> {
        let sub = anchors::only_subpath(&self.along, "a single connected run of them")?;
        let (closed, given) = (sub.closed, self.handles_at_spline_points()?);
        let parts = match (self.spline, self.interpolate) {
            (None, false) => skeleton::parts_of_segments(sub),
            (None, true) => Spline::Through.parts(&sub, given, self.unit())?,
            (Some(degree), false) => Spline::Near(degree).parts(&sub, given, self.unit())?,
            (Some(n), true) => return Err(Error::usage("spline", n.to_string(), "cannot go with `interpolate`")),
        };
        Skeleton::new((parts, closed, &self.along.name), self.is_as_drawn(), self.reverse)
    }

    /// Returns the height for v = 1; for artwork without height it is arbitrary.
    fn unit(&self) -> f64 {
        if self.frame.height() > 0.0 { self.frame.height() } else { 1.0 }
    }

    /// Returns the heights of the artwork's top and bottom over the skeleton, if the artwork is scaled by `scale`.
    fn heights(&self, scale: f64) -> [f64; 2] {
        [self.frame.y0, self.frame.y1].map(|y| (self.baseline - y) * self.width * scale)
    }

    /// Returns the handles at the points of a spline, if there are any.
    fn handles_at_spline_points(&self) -> Result<&[Option<Vec2>], Error> {
        let Some(Handles::Points(given)) = &self.handles else { return Ok(&[]) };
        let refused = |problem| Err(Error::input("handles", problem));
        if self.spline.is_none() && !self.interpolate {
            return refused("are of a spline's points, and the skeleton is none: it needs `spline` or `interpolate`");
        }
        if self.reverse {
            return refused(
                "say where up is at every point; draw the skeleton the other way instead of using `reverse`",
            );
        }
        Ok(given)
    }

    /// Returns the left and the right edge of the visible artwork in all copies, which have the frame `rect`. The last copy is `shift`
    /// further right. Lettering is taken by its outlines, since the advances in its frame are wider.
    fn visible_range(&self, rect: Rect, shift: f64) -> [f64; 2] {
        let letters = self.letters.iter().filter(|_| self.around_letters).filter_map(|l| l.outline.bounding_box());
        letters.reduce(|a, b| a.union(b)).map_or([rect.x0, rect.x1], |ink| [ink.x0, ink.x1 + shift])
    }

    /// Returns `true` if the skeleton keeps its direction. Given handles belong to the pieces in the order drawn.
    fn is_as_drawn(&self) -> bool {
        self.as_drawn || self.handles.is_some()
    }

    /// Returns `true` if letters on a whole ring keep their widths, and the spaces between them grow.
    fn spreads_letters(&self, closed: bool) -> bool {
        let is_lettering = self.around_letters && !self.letters.is_empty();
        closed && self.stretch == Stretch::Fit && self.setting.is_none() && is_lettering
    }

    /// Refuses values that contradict each other.
    fn check_together(&self) -> Result<(), Error> {
        if let Some(setting) = self.setting.filter(|_| self.letters.is_empty() && self.objects.is_empty()) {
            let problem = "needs letters on a level baseline, or objects; the artwork has neither";
            return Err(Error::usage("glyphs", setting.name(), problem));
        }
        if self.copies.is_some() && matches!(self.stretch, Stretch::Scale | Stretch::Fit) {
            return Err(Error::usage("copies", "N", "are spread evenly, and cannot be stretched as well"));
        }
        if self.stretch != Stretch::Keep && self.frame.width() <= 0.0 {
            return Err(Error::usage("stretch", self.stretch.name(), "cannot stretch artwork that has no width"));
        }
        if self.even && (self.handles.is_some() || self.by_parameter) {
            return Err(Error::usage("spacing", "even", "goes with lengths (`by arclength`) and without `handles`"));
        }
        Ok(())
    }

    /// Returns the skeleton with its lengths measured at the right height, and its arcs as cubics where handles need them.
    fn measured(&self, skeleton: Skeleton, size: f64) -> Result<Skeleton, Error> {
        /// Distance of the cubics from the arcs, relative to the size of the skeleton and the artwork.
        const ARC_TOLERANCE: f64 = 1e-9;
        let skeleton = if self.even {
            let (width, height) = (self.width, self.baseline - self.frame.center().y);
            let scale = match self.stretch {
                Stretch::Scale => skeleton.even_scale(self.frame.width(), width * height)?,
                _ => 1.0,
            };
            skeleton.at_height(width * height * scale)?
        } else {
            skeleton
        };
        if self.handles.is_some() && skeleton.has_arcs() {
            return Err(Error::input("handles", "are of lines and Bézier curves; the skeleton has arcs"));
        }
        let needs_cubics = self.handles.is_none() && self.by_parameter;
        Ok(if needs_cubics { skeleton.polynomial(ARC_TOLERANCE * size) } else { skeleton })
    }

    /// Returns the pieces with their sides.
    fn joined(&self, skeleton: Skeleton) -> Result<Joined, Error> {
        let heights =
            self.heights(if self.stretch == Stretch::Scale { skeleton.length / self.frame.width() } else { 1.0 });
        let given = match &self.handles {
            None if !self.by_parameter => return skeleton.with_normals(heights[0].abs().max(heights[1].abs())),
            Some(Handles::Pieces(given)) => Some(&given[..]),
            _ => None,
        };
        let by_arc_length = !self.by_parameter;
        skeleton.with_handles(given, (self.unit(), heights), by_arc_length)
    }

    /// Sets the letters one by one, or warns where artwork in the box `rect` folds. With a `ring_strip`, letters that are bent stand apart.
    fn set_letters(&self, built: &mut Built, map: &BendMap, rect: Rect, ring_strip: Option<ToStrip>) {
        let letters = &self.letters;
        let copies = &built.placement.copies;
        if let Some(setting) = self.setting {
            let maps = letters::letter_maps(map, setting, letters, copies, self.stretch == Stretch::Fit);
            built.explanation.warnings.extend(letters::warnings(letters, &maps));
            built.placement.letters = maps;
            return;
        }
        let warning = if self.around_letters && !letters.is_empty() {
            if let Some(ring_strip) = ring_strip {
                built.placement.letters = letters::ring_translations(map, letters, ring_strip);
                built.placement.before = true; // The map bends the letters where these put them.
            }
            map.fold_warning(letters::samples(letters, copies))
        } else if self.ink.is_empty() {
            map.fold_warning(map::box_samples(rect).map(|p| (p, None)))
        } else {
            let copies = letters::or_identity(copies);
            // The more copies, the fewer samples of each.
            let points = self.ink.iter().step_by(1 + copies.len() / 64);
            map.fold_warning(points.flat_map(|p| copies.iter().map(move |c| (*c * *p, None))))
        };
        built.explanation.warnings.extend(warning);
    }
}

/// Describes the skeleton and its corners. Warns of artwork longer than the skeleton; with all copies it reaches from `x0` to `x1`.
fn explain(built: &mut Built, map: &BendMap, corners: &[Corner], [x0, x1]: [f64; 2]) {
    /// Excess of length that still fits, as a share of the skeleton's length.
    const CLOSE: f64 = 1e-3;
    let (length, closed) = (map.length, map.closed);
    let skeleton = format!("skeleton: length {length:.6}, {}", if closed { "closed" } else { "open" });
    built.explanation.notes.insert(0, skeleton);
    for c in corners {
        let turn = c.turn.to_degrees().abs();
        built.note(format!("the artwork turns by {turn:.1}° at the corner {} of the skeleton", show(c.at)));
    }
    let [from, to] = [x0, x1].map(|x| map.to_strip.s(x));
    let excess = to - from - length;
    if excess > CLOSE * length {
        let what = if closed { "runs over itself" } else { "continues straight beyond its ends" };
        built.warn(format!(
            "bend: the artwork is longer than the path by {excess:.3} ({:.0} % of the path), and {what}; `stretch scale` makes it fit",
            (100.0 * excess / length).max(1.0)
        ));
    }
}

static INFO: Info = Info::new("bend", "bend artwork along a path")
    .baseline("baseline")
    .group("Bends")
    .by_hand(ByHand {
        neutral: &[("along", "M0,50 C33.3333,50 66.6667,50 100,50")],
        ..ByHand::NONE
    })
    .guides(&["along"], 1)
    .about("The artwork follows a path, the skeleton: horizontals run along it, verticals stand on it. The skeleton may have any \
number of lines, curves and arcs, open or closed; beyond the ends of an open one everything continues straight. --copies fill \
sets as many copies as there is room for: a border closes on a ring.\n\n\
An open skeleton is run left to right and a closed one clockwise, so that the artwork stands on its upper or outer side, with its \
middle on the highest point of a closed one. --reverse runs it the other way: artwork on a closed one stands upright on its lowest \
point, inside. --as-drawn takes it as it was drawn, as is always done with open paths that go around more than once.\n\n\
Lettering (text, or made by `pathwarp text`) stands on the skeleton with its baseline. With --glyphs its letters are set one by one \
instead of bent: rotate turns them, skew keeps verticals vertical, ribbon keeps horizontals horizontal, stair only moves them. They \
keep their size, times --width; --stretch fit spreads them from end to end, scale sizes them. Without lettering, or with --objects, \
--glyphs sets the objects of a drawing: what --select names, or else the members of its outermost group of several, of which those that \
overlap are one. --spacing even measures at half the artwork's height, so that letters neither crowd inside a bend nor drift apart \
outside it.\n\n\
--interpolate lays a smooth skeleton through a few points: a cubic spline with continuous curvature and centripetal parameters (square \
roots of the distances), so that it does not overshoot. --spline 3 is pulled towards the points instead, and waves less.\n\n\
--by parameter, or --handles, gives the polynomial map of the paper: its sides are handles on the control polygon instead of normals of \
the curve. FILE.json holds {\"pieces\": [{\"levels\": [[[dx,dy], …], …]}, …]}: for every piece of degree n the n handles of the first \
level, then n-1 of the second, and so on (deeper levels may be omitted), or {\"points\": [[dx,dy], null, …]}: one for each point of \
--spline or --interpolate, null for its default. A handle is the image of the artwork's height. By default all lines along a smooth \
skeleton are smooth; what has kinks is a warning, and --explain names every joint. --preview shows the control polygon and the first \
level of the algorithm.\n\n\
--preset needs no skeleton: stretch makes the artwork longer by --factor, swell scales its height in the middle, taper at its right end. \
(A twist needs space: `pathwarp solid bend --preset twist`.)")
    .source("Y.-K. Chang and A. Rockwood, A generalized de Casteljau approach to 3D free-form deformation, SIGGRAPH 1994")
    .params(Bend::PARAMS)
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
            what: "On a smooth curve through five points",
            command: "bend samples/lettering.svg --along '20,170 140,110 270,165 390,90 516,130' --interpolate -o out.svg",
        },
        Example {
            what: "Higher in its middle",
            command: "bend samples/logo.svg --preset swell --factor 140% -o out.svg",
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
        Law::Identity(&[("along", "0,50 25,50 50,50 75,50 100,50"), ("interpolate", "true"), ("by", "parameter")]),
        Law::Identity(&[("along", "0,50 50,50 100,50"), ("spline", "2"), ("by", "parameter"), ("stretch", "fit")]),
        Law::Area(&[("preset", "stretch"), ("factor", "1.5")], 1.5),
        Law::KeepsLinesAlong(&[("preset", "swell")], (0.0, 1.0)),
        Law::Same(
            &[("along", "0,60 30,20 70,90 100,50"), ("spline", "3"), ("by", "parameter"), ("reverse", "true")],
            &[("along", "100,50 70,90 30,20 0,60"), ("spline", "3"), ("by", "parameter"), ("as-drawn", "true")],
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
        Case { args: ON_ARC, at: (EIGHTH_TURN, 100.0), to: (50.0 + 50.0 * SIN_45, 50.0 - 50.0 * SIN_45), tolerance: 1e-11 },
        Case { args: ON_ARC, at: (EIGHTH_TURN, 80.0), to: (50.0 + 70.0 * SIN_45, 50.0 - 70.0 * SIN_45), tolerance: 1e-11 },
        // A right angle: the mitre, and beyond it the offset.
        Case { args: CORNER, at: (50.0, 40.0), to: (60.0, -10.0), tolerance: 1e-12 },
        Case { args: CORNER, at: (100.0, 40.0), to: (60.0, 50.0), tolerance: 1e-12 },
        // The polynomial map: C(1/2) + S(1/2)/2 of a quadratic with legs (30,-40) and (30,40), their normals (-.8,-.6), (.8,-.6).
        Case { args: PARAMETER, at: (50.0, 50.0), to: (30.0, -20.0), tolerance: 1e-12 },
        Case { args: PARAMETER, at: (50.0, 0.0), to: (30.0, -50.0), tolerance: 1e-12 },
        // A quadratic B-spline at its only inner knot: the mean of the middle points, and of their mitres (0.5, -1) and (-0.5, -1).
        Case { args: SPLINE, at: (50.0, 50.0), to: (20.0, 0.0), tolerance: 1e-12 },
        Case { args: SPLINE, at: (50.0, 0.0), to: (20.0, -50.0), tolerance: 1e-12 },
    ]);

const ARC: &str = "M0,50 A50,50 0 0 1 100,50";
const CIRCLE: &str = "M100,50 A50,50 0 1 1 0,50 A50,50 0 1 1 100,50 Z";
const ON_ARC: Pairs = &[("along", ARC), ("baseline", "0")];
const CORNER: Pairs = &[("along", "0,0 50,0 50,50"), ("align", "start")];
const PARAMETER: Pairs = &[("along", "M0,0 Q30,-40 60,0"), ("by", "parameter"), ("stretch", "fit")];
const SPLINE: Pairs = &[
    ("along", "-24,32 0,0 40,0 64,32"),
    ("spline", "2"),
    ("by", "parameter"),
    ("stretch", "fit"),
    ("as-drawn", "true"),
];
const EIGHTH_TURN: f64 = 50.0 + 50.0 * std::f64::consts::FRAC_PI_4;
const SIN_45: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let missing = || Error::missing("along", "the path to bend the artwork along");
    if let Some(preset) = preset(s)? {
        return preset.build();
    }
    let bend = Bend::read(s, s.path_if("along")?.ok_or_else(missing)?)?;
    // A spiral is run from its inside or outside, as it is described.
    let spiral = s.texts("along").last().is_some_and(|t| is_spiral(t));
    if spiral { bend.as_drawn(true).build() } else { bend.build() }
});

/// Barr's deformations, except the twist, which needs space.
const PRESETS: &[&str] = &["stretch", "swell", "taper"];

/// Reads a preset: a straight skeleton whose handles differ in length.
fn preset(s: &Settings<'_>) -> Result<Option<Bend>, Error> {
    if !s.given("preset") {
        return match s.texts("factor").last() {
            Some(factor) => Err(Error::usage("factor", *factor, "is for a `preset`, and there is none; omit it")),
            None => Ok(None),
        };
    }
    if let Some(name) = ["along", "stretch", "by", "handles", "spline", "interpolate"].into_iter().find(|n| s.given(n))
    {
        let problem = "cannot go with `preset`, which has its own skeleton";
        return Err(Error::usage(name, s.texts(name).join(" "), problem));
    }
    let name = s.choice("preset")?;
    let factor = s.number_if("factor")?.unwrap_or(if name == "taper" { 0.5 } else { 1.5 });
    // The heights at the skeleton's control points and its length, relative to the artwork's. In a swell, the middle of the quadratic
    // with the control points 1, m, 1 is (1 + m)/2.
    let (heights, length) = match name {
        "stretch" => (vec![1.0, 1.0], factor),
        "taper" => (vec![1.0, factor], 1.0),
        _ => (vec![1.0, 2.0 * factor - 1.0, 1.0], 1.0),
    };
    let bend = Bend::read(s, NamedPath { name: name.into(), outline: Outline::default() })?;
    let (rect, degree) = (bend.frame, heights.len() - 1);
    let point = |i: usize| Point::new(rect.x0 + rect.width() * length * i as f64 / degree as f64, bend.baseline);
    let points: Vec<Point> = (0..=degree).map(point).collect();
    let handles = heights.iter().map(|h| Some(Vec2::new(0.0, -bend.unit()) * *h)).collect();
    Ok(Some(Bend {
        along: NamedPath { name: name.into(), outline: Outline::from_points(&points, false) },
        spline: Some(degree),
        handles: Some(Handles::Points(handles)),
        by_parameter: true,
        stretch: Stretch::Fit,
        ..bend
    }))
}

/// The paper's handles: levels for every piece, or handles at the points of a spline.
#[derive(Debug, Clone, PartialEq)]
enum Handles {
    Pieces(Vec<Vec<Vec<Vec2>>>),
    Points(Vec<Option<Vec2>>),
}

fn handles(file: &NamedText) -> Result<Handles, Error> {
    #[cfg(feature = "serde")]
    return file::read(&file.name, &file.text);
    #[cfg(not(feature = "serde"))]
    Err(crate::error::no_json(&file.name))
}

/// Reads the number of copies: `None` if it is not given, `Some(None)` for as many as fit.
fn copies(s: &Settings<'_>) -> Result<Option<Option<usize>>, Error> {
    match s.texts("copies").last() {
        None => Ok(None),
        Some(&"fill") => Ok(Some(None)),
        Some(n) => match n.parse() {
            Ok(count) if count > 0 => Ok(Some(Some(count))),
            _ => Err(Error::usage("copies", *n, "is neither a number above zero nor `fill`")),
        },
    }
}

/// Reads the setting of letters one by one; `None` if they are bent.
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

/// Copies of the artwork side by side along the skeleton.
#[derive(Debug, Clone, Copy)]
struct Repeats {
    count: usize,
    /// Distance from one copy to the next.
    spacing: f64,
}

impl Repeats {
    const ONE: Self = Self { count: 1, spacing: 0.0 };

    /// Returns `count` copies of `width` with `gaps` gaps each, or as many as fit on `length` if every gap is at least `gap`. They are
    /// spread evenly, on an open skeleton from its start to its end, on a closed one all the way around.
    fn new(
        count: Option<usize>,
        (width, gaps, gap): (f64, f64, f64),
        length: f64,
        closed: bool,
    ) -> Result<Self, Error> {
        /// Limit on the copies. More are probably a mistake in the unit.
        const MAX_COPIES: f64 = 10_000.0;
        let period = width + gaps * gap;
        if period <= 0.0 {
            let problem = format!("is so negative that copies of artwork {width:.6} wide would not advance");
            return Err(Error::usage("gap", gap.to_string(), problem));
        }
        // Rounding must not exclude a copy that just fits.
        let most = ((if closed { length } else { length + gap }) / period * (1.0 + 1e-9)).floor().max(1.0);
        let count = count.map_or(most, |n| n as f64);
        if count > MAX_COPIES {
            let problem = format!("would take {count} copies of artwork {width:.6} wide; the limit is {MAX_COPIES}");
            return Err(Error::usage("stretch", "repeat", problem));
        }
        let spacing = match (closed, count > 1.0) {
            (true, _) => length / count,
            (false, true) => (length - width) / (count - 1.0),
            (false, false) => 0.0,
        };
        Ok(Self { count: count as usize, spacing })
    }
}
