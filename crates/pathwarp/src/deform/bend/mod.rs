//! Bends artwork along a skeleton.
//!
//! The artwork's horizontals run along the skeleton curve C, its verticals stand on it: F(x, y) = C(u) + v·S(u), u growing with x and v
//! with the height above the baseline. Two kinds of sides S:
//!
//! - **unit normals** ([`piece`]): with u by arc length s, ∂F/∂s = (1 + κd)·T and ∂F/∂d = N, exactly; the strip is as high as
//!   the artwork everywhere and folds beyond the centre of curvature, 1 + κd = 0. At corners S is blended into the mitre,
//!   linearly along both neighbours, so that offsets of a polygon are exact;
//! - **handles** ([`casteljau`]): the generalised algorithm of de Casteljau, one handle per leg of the control polygon, deeper
//!   levels on request. F is polynomial in u and v, and the image of a Bézier curve is one again, exactly. By default a handle is
//!   the leg's unit normal, as long as the artwork is high.
//!
//! Source: *A generalized de Casteljau approach to 3D free-form deformation* (Chang & Rockwood, SIGGRAPH 1994), here in the plane;
//! its joint
//! conditions (4) and (5) are checked and reported. A skeleton may be given as a B-spline ([`spline`]). Joints of the skeleton are
//! creases: verticals in the artwork.

mod casteljau;
mod entry;
#[cfg(feature = "serde")]
mod file;
mod letters;
mod listed;
mod map;
mod piece;
mod repeats;
mod skeleton;
mod spline;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;
pub use letters::LetterSetting;

use super::built::{Built, Role};
use crate::error::{Error, show, within};
use crate::outline::Outline;
use crate::param::{Letter, NamedPath};
use kurbo::{Affine, Rect, Vec2};
use map::{BendMap, ToStrip};
use repeats::Repeats;
use skeleton::{Corner, Joined, Skeleton};
use std::sync::Arc;

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
pub struct Bend {
    frame: Rect,
    along: NamedPath,
    spline: Option<usize>,
    as_drawn: bool,
    reverse: bool,
    stretch: Stretch,
    align: Align,
    offset: f64,
    gap: f64,
    /// The y of the line that lies on the skeleton.
    baseline: f64,
    width: f64,
    by_parameter: bool,
    handles: Option<Vec<Vec<Vec<Vec2>>>>,
    /// The file that the handles are from, for messages.
    handles_name: String,
    even: bool,
    setting: Option<LetterSetting>,
    letters: Arc<[Letter]>,
    /// The frame was laid around the letters, and says nothing about their own heights.
    around_letters: bool,
}

/// The lengths of artwork on a skeleton.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stretch {
    /// Lengths are kept.
    Keep,
    /// The artwork is scaled to the skeleton's length.
    Scale,
    /// The artwork's width is stretched to the skeleton's length.
    Fit,
    /// Copies of the artwork stand side by side, as many as fit, spread evenly.
    Repeat,
}

/// The part of the artwork that comes to the same part of the skeleton.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Left edge to start.
    Start,
    /// Middle to middle; of a closed skeleton, to its highest point, or to its lowest if it is run in reverse.
    Middle,
    /// Right edge to end.
    End,
}

impl Bend {
    /// Creates a bend of the box `frame` along one connected path. An open path is run left to right, a closed one clockwise;
    /// the middle of the box lies on its middle, and nothing is stretched.
    #[must_use]
    pub fn new(frame: Rect, along: &Outline) -> Self {
        Self {
            frame,
            along: NamedPath { name: "along".into(), outline: along.clone() },
            spline: None,
            as_drawn: false,
            reverse: false,
            stretch: Stretch::Keep,
            align: Align::Middle,
            offset: 0.0,
            gap: 0.0,
            baseline: frame.center().y,
            width: 1.0,
            by_parameter: false,
            handles: None,
            handles_name: "handles".into(),
            even: false,
            setting: None,
            letters: Arc::new([]),
            around_letters: false,
        }
    }

    /// Takes the skeleton's anchors as control points of a uniform B-spline of this degree, 1 to 3.
    #[must_use]
    pub fn spline(self, degree: usize) -> Self {
        Self { spline: Some(degree), ..self }
    }

    /// Takes the skeleton in the direction it was drawn, a closed one from its start.
    #[must_use]
    pub fn as_drawn(self, as_drawn: bool) -> Self {
        Self { as_drawn, ..self }
    }

    /// Runs the skeleton the other way.
    #[must_use]
    pub fn reverse(self, reverse: bool) -> Self {
        Self { reverse, ..self }
    }

    /// Sets the lengths of the artwork.
    #[must_use]
    pub fn stretch(self, stretch: Stretch) -> Self {
        Self { stretch, ..self }
    }

    /// Sets the part of the artwork that comes to the same part of the skeleton.
    #[must_use]
    pub fn align(self, align: Align) -> Self {
        Self { align, ..self }
    }

    /// Sets a shift along the skeleton, user units.
    #[must_use]
    pub fn offset(self, offset: f64) -> Self {
        Self { offset, ..self }
    }

    /// Sets the least space between copies, user units.
    #[must_use]
    pub fn gap(self, gap: f64) -> Self {
        Self { gap, ..self }
    }

    /// Sets the y of the line that lies on the skeleton. Default: the middle of the box.
    #[must_use]
    pub fn baseline(self, y: f64) -> Self {
        Self { baseline: y, ..self }
    }

    /// Sets a factor for heights, 1e-6 to 1e6.
    #[must_use]
    pub fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// Runs by the parameter of each piece, with the normals of the control polygon's legs for handles: a polynomial map.
    #[must_use]
    pub fn by_parameter(self, by_parameter: bool) -> Self {
        Self { by_parameter, ..self }
    }

    /// Sets the paper's handles: for every piece of degree n the n handles of the first level, then n−1 of the second, and so
    /// on; deeper levels may be omitted. A handle is the image of the artwork's height. The skeleton is taken as drawn.
    #[must_use]
    pub fn handles(self, pieces: Vec<Vec<Vec<Vec2>>>) -> Self {
        Self { handles: Some(pieces), ..self }
    }

    /// Measures lengths at half the artwork's height instead of on the skeleton.
    #[must_use]
    pub fn even(self, even: bool) -> Self {
        Self { even, ..self }
    }

    /// Sets letters one by one instead of bending them; their places are in
    /// [`Placement::letters`](super::Placement::letters).
    #[must_use]
    pub fn letters(self, letters: Arc<[Letter]>, setting: LetterSetting) -> Self {
        Self { letters, setting: Some(setting), ..self }
    }

    /// Builds the map. Corners, folds and artwork longer than the skeleton give warnings.
    ///
    /// # Errors
    /// [`Error::Geometry`] or [`Error::Usage`] for a skeleton that is not one connected path, has no length or turns back on
    /// itself; [`Error::Usage`] for values out of range or that contradict each other, [`Error::Input`] for handles that do
    /// not fit the skeleton.
    pub fn build(&self) -> Result<Built, Error> {
        let path = match self.spline {
            Some(degree) => {
                within("spline", degree as f64, 1.0, 3.0)?;
                spline::through(&self.along, degree)?
            }
            None => self.along.clone(),
        };
        let rect = self.frame;
        let skeleton = Skeleton::new(&path, self.is_as_drawn(), self.reverse)?;
        let size = rect.width().hypot(rect.height()).max(skeleton.length);
        self.check()?;
        let skeleton = self.measured(skeleton, size)?;
        let (length, closed) = (skeleton.length, skeleton.closed);
        let middle = if closed && !self.is_as_drawn() { skeleton.extreme(self.reverse) } else { 0.5 * length };
        let Joined { pieces, corners, notes } = self.joined(skeleton)?;

        let k = if matches!(self.stretch, Stretch::Keep | Stretch::Repeat) { 1.0 } else { length / rect.width() };
        let repeats = match self.stretch {
            Stretch::Repeat => Repeats::new(rect.width(), self.gap, length, closed)?,
            _ => Repeats::ONE,
        };
        let (from, to) = match self.align {
            // Copies that reach from end to end begin at the start of the skeleton.
            _ if repeats.count > 1 && !closed => (rect.x0, 0.0),
            Align::Start => (rect.x0, 0.0),
            Align::End => (rect.x1, length),
            Align::Middle => (rect.center().x, middle),
        };
        let to_strip = ToStrip {
            k,
            origin: to + self.offset - k * from,
            up: self.width * if self.stretch == Stretch::Scale { k } else { 1.0 },
            base: self.baseline,
        };
        let pieces = pieces.into_iter().map(Arc::new).collect();
        let shift = repeats.spacing * (repeats.count - 1) as f64;
        let rect = Rect { x1: rect.x1 + shift, ..rect };
        let reach = (rect.x0 - rect.width(), rect.x1 + rect.width());
        let map = BendMap { pieces, length, closed, to_strip, reach };

        let mut built = Built::new(map.simplest());
        built.explanation.notes = notes;
        explain(&mut built, &map, &corners, rect);
        if self.stretch == Stretch::Repeat {
            built.note(format!("artwork repeated: {} times, one every {:.6}", repeats.count, repeats.spacing));
            built.placement.copies =
                (0..repeats.count).map(|i| Affine::translate((repeats.spacing * i as f64, 0.0))).collect();
        }
        self.explain_letters(&mut built, &map, rect);
        built.overlay(Role::Cage, path.outline.to_bez_path(1e-4 * size));
        Ok(built)
    }

    /// Handles belong to the pieces in the order they were drawn.
    fn is_as_drawn(&self) -> bool {
        self.as_drawn || self.handles.is_some()
    }

    /// Refuses values out of range, or that contradict each other.
    fn check(&self) -> Result<(), Error> {
        within("width", self.width, 1e-6, 1e6)?;
        if let Some(setting) = self.setting.filter(|_| self.letters.is_empty()) {
            let problem = "needs letters on a level baseline: text, or outlines made by `pathwarp text`. Other outlines do not say \
where a letter begins; `glyphs bend` bends them";
            return Err(Error::usage("glyphs", setting.name(), problem));
        }
        if self.stretch != Stretch::Keep && self.frame.width() <= 0.0 {
            let name = match self.stretch {
                Stretch::Scale => "scale",
                Stretch::Fit => "fit",
                _ => "repeat",
            };
            return Err(Error::usage("stretch", name, "cannot stretch artwork that has no width"));
        }
        if self.even && (self.handles.is_some() || self.by_parameter) {
            return Err(Error::usage("spacing", "even", "goes with lengths (`by arclength`) and without `handles`"));
        }
        Ok(())
    }

    /// Returns the skeleton with its lengths measured at the right height, and its arcs as cubics where handles need them.
    fn measured(&self, skeleton: Skeleton, size: f64) -> Result<Skeleton, Error> {
        /// Distance of the cubics from the arcs, relative to the size of everything.
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
        match &self.handles {
            Some(_) if skeleton.has_arcs() => {
                let problem = "has handles for lines and Bézier curves; the skeleton has arcs";
                Err(Error::input(self.handles_name.clone(), problem))
            }
            Some(_) => Ok(skeleton),
            None if !self.by_parameter => Ok(skeleton),
            None => Ok(skeleton.polynomial(ARC_TOLERANCE * size, true)),
        }
    }

    /// Returns the pieces with their sides.
    fn joined(&self, skeleton: Skeleton) -> Result<Joined, Error> {
        // The height that v = 1 means; for artwork without height any will do.
        let unit = if self.frame.height() > 0.0 { self.frame.height() } else { 1.0 };
        match &self.handles {
            Some(given) => skeleton.with_handles(Some(given), unit, !self.by_parameter),
            None if !self.by_parameter => skeleton.with_normals(),
            None => skeleton.with_handles(None, unit, false),
        }
    }

    /// Places the letters, or warns where the artwork folds.
    fn explain_letters(&self, built: &mut Built, map: &BendMap, rect: Rect) {
        let letters = &self.letters;
        let copies = &built.placement.copies;
        let warnings: Vec<String> = match self.setting {
            Some(setting) => {
                let places = letters::places(map, setting, letters, copies, self.stretch == Stretch::Fit);
                let warnings = letters::warnings(letters, &places);
                built.placement.letters = places;
                warnings
            }
            None if self.around_letters && !letters.is_empty() => {
                map.fold(letters::points(letters, copies)).into_iter().collect()
            }
            None => map.fold(map::edges(rect).map(|p| (p, None))).into_iter().collect(),
        };
        built.explanation.warnings.extend(warnings);
    }
}

/// Describes the skeleton; warns of corners, and of artwork longer than the skeleton. `rect` is the box of all copies.
fn explain(built: &mut Built, map: &BendMap, corners: &[Corner], rect: Rect) {
    let (length, closed) = (map.length, map.closed);
    let skeleton = format!("skeleton: length {length:.6}, {}", if closed { "closed" } else { "open" });
    built.explanation.notes.insert(0, skeleton);
    for c in corners {
        built.warn(format!(
            "bend: the skeleton has a corner at {} (it turns by {:.1}°): the artwork is mitred there; round it for a smooth bend",
            show(c.at),
            c.turn.to_degrees().abs()
        ));
    }
    let width = map.to_strip.k * rect.width();
    if width > length * (1.0 + 1e-9) {
        let what = if closed { "runs over itself" } else { "continues straight beyond its ends" };
        built.warn(format!(
            "bend: the artwork is {width:.6} wide, the skeleton only {length:.6} long: it {what}; see `stretch`"
        ));
    }
}
