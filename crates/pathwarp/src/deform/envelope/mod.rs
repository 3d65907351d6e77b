//! Artwork put into a shape: an envelope of four sides, each a curve of any number of pieces.
//!
//! The map is the Coons patch of the sides ([`Coons`](crate::map::Coons)), which equals the shaper's if every side is one cubic
//! (Koppinen, *A plane transformation from 16 control points*, equation 7); or it fills a closed shape in columns, rows or lines of
//! lettering. [`Chooser`] decides among them. The four sides, bottom, right, top and left, make a [`Ring`].

mod columns;
mod corners;
mod distortion;
mod fit;
mod lines;
#[cfg(test)]
mod tests;

use super::entry::{Built, ByHand, Case, Entry, Example, Gallery, Info, Law, Pairs, Role, Variant};
use crate::error::{Error, show};
use crate::map::{Coons, Jet, Map, Pace, Side, Sides, TileRow, Tiled};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Axis, Choice as _, Kind, Letter, NamedPath, Settings, Value as _, choice, parameters};
use columns::{Columns, Margins, Region, bisect, fill, no_room};
use distortion::{distortion, grid, stretches, turning_cost};
use fit::{Corners, SIDES, bounds, double_area, is_curved, preview, reversed};
use kurbo::{Affine, Line, Point, Rect, Vec2};
use std::sync::Arc;

pub use fit::{Keep, Spread};

pub(super) use fit::{Ring, fit};

/// Lettering ends where a shape is lower than this share of its greatest height.
const ENDS: f64 = 0.25;

choice! {
    /// What becomes of several lines of lettering in a closed shape.
    pub enum Lines {
        /// Each line is as wide as the shape at its height, with upright stems.
        Fit = "fit",
        /// One map bends them all together.
        Together = "together",
    }
}

parameters! {
    /// An envelope: the artwork's box put into a shape with four sides, each a curve of any number of pieces.
    ///
    /// The map is the Coons patch of the sides, F(u, v) = (1−v)·B(u) + v·T(u) + (1−u)·L(v) + u·R(v) less the bilinear map of the
    /// corners, or a ruled or projective map if lines are [kept](Self::keep).
    ///
    /// ```
    /// use pathwarp::{Outline, deform::Envelope, kurbo::{Point, Rect}, map::Map};
    ///
    /// let hill = Outline::from_svg("M0,100 A50,50 0 0 1 100,100")?;
    /// let arch = Envelope::between(Rect::new(0.0, 0.0, 100.0, 100.0)).bottom(&hill).height(40.0).build()?;
    /// assert!(arch.map.point(Point::new(50.0, 0.0)).distance(Point::new(50.0, 10.0)) < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[derive(Debug, Clone, PartialEq)]
    pub struct Envelope(s) {
        /// The closed path to put the artwork into, or a shape such as heart, or heart,ratio=1.2 (width to height).
        shape: Option<NamedPath> = path("envelope");
        /// Instead of --envelope, the bottom side, an open curve.
        param = path("bottom");
        /// The top side.
        param = path("top");
        /// The left side. Default: as --sides says.
        param = path("left");
        /// The right side. Default: as --sides says.
        param = path("right");
        /// With --bottom or --top alone: distance of the facing side, which is the same curve again. Default: the artwork's height.
        height: Option<f64> = length("height", Axis::Y).within(1e-9, 1e9).slider(1.0, 500.0);
        /// The sides between the ends of two curves: straight lines, or curves that meet both at right angles.
        square: bool = either("sides", &["straight", "square"]);
        /// The spacing along a side: even by length, by the curve's parameter, or by steps across the screen.
        param = new("by", Kind::Choice(Spread::WORDS)).default("length");
        /// The closed path's corners: four numbers of its nodes, or four points near it. Default: found.
        param = new("corners", Kind::Text("N,N,N,N|X,Y…"));
        /// The closed path's side that is the bottom: 1 to 4, from its first corner on as drawn. Default: the lowest.
        bottom_side: Option<usize> = new("bottom-side", Kind::Count).within(1.0, 4.0);
        /// Run the bottom the other way: the result is mirrored.
        reverse: bool = flag("reverse");
        /// Lines that stay straight.
        keep: Keep = new("keep", Kind::Choice(Keep::WORDS)).default("auto");
        /// Several lines of lettering in a closed path with --keep auto or verticals: fit sets each to the width of the shape at its height,
        /// together bends the block as a whole.
        lines: Lines = new("lines", Kind::Choice(Lines::WORDS)).default("fit");
        /// In columns or rows: the artwork ends where the shape is still this share of its greatest height (width). Default: 25% for
        /// lettering, else 0.
        ends: Option<f64> = number("ends").within(0.0, 0.99).slider(0.0, 0.5);
        /// Distance that the artwork keeps from the shape's outline.
        padding: f64 = length("padding", Axis::Y).default("0").within(0.0, 1e9).slider(0.0, 50.0);
        let frame: Rect = s.frame().rect;
        // Bottom, right, top, left.
        let curves: [Option<NamedPath>; 4] = curves(s)?;
        let spread: Option<Spread> = if s.given("by") { Some(Spread::read(s, "by")?) } else { None };
        let corners: Option<Corners> = corners(s)?;
        let lettering: bool = !s.frame().letters.is_empty();
        let letters: Arc<[Letter]> = Arc::clone(&s.frame().letters);
        let ink: Arc<[Point]> = Arc::clone(&s.frame().ink);
    }
}

impl Envelope {
    /// Puts the box `frame` into a closed path. The path's corners and its bottom are found, unless they are set.
    #[must_use]
    pub fn new(frame: Rect, shape: &Outline) -> Self {
        Self::between(frame).shape(shape)
    }

    /// Puts the box `frame` between curves: [`bottom`](Self::bottom) and [`top`](Self::top), [`left`](Self::left) and
    /// [`right`](Self::right), all four, or bottom or top alone.
    #[must_use]
    pub fn between(frame: Rect) -> Self {
        Self::defaults(frame)
    }

    fn side(mut self, k: usize, curve: &Outline) -> Self {
        self.curves[k] = Some(NamedPath { name: SIDES[k].into(), outline: curve.clone() });
        self
    }

    /// Sets the bottom side, an open curve.
    #[must_use]
    pub fn bottom(self, curve: &Outline) -> Self {
        self.side(0, curve)
    }

    /// Sets the right side, an open curve.
    #[must_use]
    pub fn right(self, curve: &Outline) -> Self {
        self.side(1, curve)
    }

    /// Sets the top side, an open curve.
    #[must_use]
    pub fn top(self, curve: &Outline) -> Self {
        self.side(2, curve)
    }

    /// Sets the left side, an open curve.
    #[must_use]
    pub fn left(self, curve: &Outline) -> Self {
        self.side(3, curve)
    }

    setters! {
        /// Sets the spacing along the sides. Default: even by length.
        spread(spread: Spread) => spread: Some(spread);
        /// Sets the corners of a closed path: the points nearest to these.
        corners(points: [impl Into<Point>; 4]) => corners: Some(Corners::Points(points.map(Into::into)));
        /// Sets the corners of a closed path by the numbers of its nodes, from 1.
        corner_nodes(nodes: [usize; 4]) => corners: Some(Corners::Nodes(nodes));
        /// Sets `true` for lettering, which has stems to be kept upright.
        lettering(lettering: bool);
        /// Gives the letters of the artwork, which may be several lines.
        letters(letters: impl Into<Arc<[Letter]>>) => letters: letters.into(), lettering: true;
        /// Gives points of the artwork, where its distortion is visible. Default: the whole box.
        artwork(ink: impl Into<Arc<[Point]>>) => ink: ink.into();
    }

    /// Builds the map. Sides that cross, and folds, give warnings.
    ///
    /// # Errors
    /// [`Error::Geometry`] when the shape is not closed or the box is flat; [`Error::Usage`] when curves do not meet, corners cannot be
    /// found, sides are too curved to keep lines, or values contradict each other.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        self.check_together()?;
        let mut shape = match &self.shape {
            Some(path) => Some((&*path.name, corners::closed_path(path)?)),
            None => None,
        };
        // Options about the four sides of a closed path ask for the patch between them.
        let divided = self.corners.is_some() || self.bottom_side.is_some() || self.reverse || self.spread.is_some();
        let mut tips = Vec::new();
        if let Some((_, path)) =
            shape.as_mut().filter(|_| !divided && !matches!(self.keep, Keep::Nothing | Keep::Lines))
        {
            (*path, tips) = corners::without_tails(path);
        }
        let lines = match self.lines {
            Lines::Fit => lines::divide(&self.letters, &self.ink),
            Lines::Together => Vec::new(),
        };
        let chooser = Chooser {
            frame: self.frame,
            keep: self.keep,
            spread: self.spread,
            margins: Margins {
                ends: self.ends.unwrap_or(if self.lettering { ENDS } else { 0.0 }),
                padding: self.padding,
            },
            lettering: self.lettering,
            lines: &lines,
            letter_count: self.letters.len(),
            ink: &self.ink,
        };
        let ring = self.ring(shape.as_ref());
        let mut built = chooser.build(shape.map(|s| s.1).filter(|_| !divided), ring)?;
        if !tips.is_empty() {
            let tips = tips.into_iter().map(show).collect::<Vec<_>>().join(" ");
            built.note(format!("left free: what sticks out at {tips}"));
        }
        Ok(built)
    }

    /// Returns a few points of the artwork, in the unit square with v upwards. Every choice of corners is judged at all of them.
    fn sample_points(&self) -> Vec<Point> {
        /// Points along an axis, if the artwork is unknown.
        const SAMPLES: u32 = 5;
        let step = (self.ink.len() / (2 * SAMPLES * SAMPLES) as usize).max(1);
        let points: Vec<Point> = self.ink.iter().step_by(step).map(|p| fit::to_unit(self.frame) * *p).collect();
        if points.is_empty() { grid(SAMPLES).collect() } else { points }
    }

    /// Refuses values that contradict each other.
    fn check_together(&self) -> Result<(), Error> {
        let drawn = self.curves.iter().any(Option::is_some);
        match &self.shape {
            Some(path) if drawn => {
                let problem = "cannot go with `bottom`, `top`, `left` and `right`: a closed path has all four";
                Err(Error::usage("envelope", path.name.clone(), problem))
            }
            Some(_) => match self.height {
                Some(height) => Err(Error::usage("height", height.to_string(), "goes with `bottom` or `top` alone")),
                None => Ok(()),
            },
            None if drawn => {
                let given = [("corners", self.corners.is_some()), ("bottom-side", self.bottom_side.is_some())];
                let problem = "goes with `envelope`: here the sides are drawn one by one";
                given.iter().find(|g| g.1).map_or(Ok(()), |g| Err(Error::usage(g.0, "", problem)))
            }
            None => {
                let hint =
                    "the closed path to put the artwork into (or `bottom` and `top`: the curves below and above)";
                Err(Error::missing("envelope", hint))
            }
        }
    }

    /// Returns the four sides: of a closed path with its name, or as drawn one by one.
    fn ring(&self, shape: Option<&(&str, Subpath)>) -> Result<Ring, Error> {
        if let Some((name, path)) = shape {
            return corners::ring(
                name,
                path,
                self.corners.as_ref(),
                self.bottom_side,
                self.reverse,
                &self.sample_points(),
            );
        }
        let (drawn, height, frame_height) = (&self.curves, self.height, self.frame.height());
        corners::Curves { drawn, height, frame_height, square: self.square, reverse: self.reverse }.ring()
    }
}

static INFO: Info = Info::new("envelope", "put artwork into any closed shape, or between curves")
    .group("Envelopes")
    .by_hand(ByHand {
        neutral: &[
            ("top", "M0,0 C33.3333,0 66.6667,0 100,0"),
            ("bottom", "M0,100 C33.3333,100 66.6667,100 100,100"),
        ],
        variants: &[Variant {
            label: "Closed shape",
            param: "envelope",
            neutral: "M0,100 L50,100 L100,100 L100,50 L100,0 L50,0 L0,0 L0,50 Z",
            showing: "M10,95 L50,120 L90,95 L100,50 L90,5 L50,-20 L10,5 L0,50 Z",
        }],
        ..ByHand::NONE
    })
    // In a drawing program, the topmost selected path is the shape.
    .guides(&["envelope"], 1)
    .with_letters()
    .about("The artwork's box is laid onto a shape, and the artwork follows. Name a closed path (--envelope, for instance an object of \
the drawing itself), or draw the sides one by one: --bottom and --top, with --left and --right if they are to be curves as well, or \
--bottom alone with a --height.\n\nHow a closed path is filled is chosen (--keep auto). A path with four corners of its own (a flag, a \
banner, a trapezoid) bends the artwork between its four sides. Lettering in any other shape stands in columns between the lower and \
the upper outline, its stems upright; other artwork takes whatever distorts it less: columns, rows or four sides. Tails, such as a speech \
bubble's, and thin ends stay free. In columns, lettering ends where the shape is still a quarter of its greatest height (--ends). \
--explain says what was chosen.\n\nSeveral lines of lettering, told by their baselines, are each set to the width of the shape at their \
height (--lines fit): the gaps between them are even, only tops and bottoms are bent, and a line under a notch parts around it or starts \
below it. What else is drawn between two lines goes along with the nearer one. --lines together bends all lines as one block.\n\nA closed path's corners are its nodes, if it has just four and one lies in each quarter of its box. \
Otherwise they are those of its nodes that turn by 20° or more which distort the artwork least; for a quarter of the box without such \
a node, the point nearest to its corner stands in. --corners overrules that; where another choice is hardly worse, a warning names it. \
The bottom is the lowest side on the screen that can be read from left to right, so that lettering is never mirrored; --bottom-side and \
--reverse overrule that.\n\nAlong a side the artwork is spread evenly by length. --by parameter follows the curve's parameter instead \
(pieces share a side by their lengths); with one cubic for every side that is the shaper's map. --by extent goes by even steps across the \
screen.\n\n--keep verticals fills a closed path in columns, and makes verticals straight lines between --bottom and --top, exactly vertical \
where both span the same width; --keep horizontals does the same in rows. --keep lines keeps every line, which needs four straight sides: \
a projective map. --keep nothing bends artwork between four sides, whatever the shape.")
    .source("S. A. Coons, Surfaces for Computer-Aided Design of Space Forms, MIT 1967; Markku Koppinen, A plane transformation from 16 control points, equation (7)")
    .params(Envelope::PARAMS)
    .gallery(Gallery { set: "shapes", title: "shapes", presets: "envelope", bend: None, axis: None })
    .demo(&[("envelope", "M8,78 Q30,96 50,84 T95,85 C85,60 105,40 90,15 L70,6 C50,-5 30,30 5,10 C15,40 0,60 8,78 Z"), ("corners", "1,3,4,6")])
    .examples(&[
        Example {
            what: "A logo in a swallow-tailed pennant: the shape's corners and its bottom are found",
            command: "envelope samples/logo.svg --envelope samples/envelopes.svg#pennant --explain -o out.svg",
        },
        Example {
            what: "A word between two curves of several pieces, its verticals kept vertical",
            command: "envelope samples/lettering.svg --bottom samples/envelopes.svg#valley --top samples/envelopes.svg#hill --keep verticals --fit page -o out.svg --preview out.png",
        },
        Example {
            what: "The same curve above and below, typed in place",
            command: "envelope samples/lettering.svg --bottom 'M0,160 C120,100 260,220 400,150' --height 90 -o out.svg",
        },
        Example {
            what: "Text whose baseline lies on the lower curve and whose capitals reach the upper one",
            command: "envelope samples/headline.svg --frame baseline-capheight --bottom 'M30,200 Q240,90 450,200' --height 80 -o out.svg",
        },
        Example {
            what: "A word in a leaf: its stems stay upright",
            command: "envelope samples/headline.svg --envelope leaf --fit page -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("envelope", "0,0 100,0 100,100 0,100")]),
        Law::Identity(&[("bottom", "0,100 100,100"), ("top", "0,0 30,0 100,0")]),
        Law::Identity(&[("bottom", "0,100 100,100")]),
        // The start and the direction of a closed path do not matter.
        Law::Same(
            &[("envelope", "M10,90 Q40,110 95,85 L90,15 50,30 5,10 Z"), ("corners", "10,90 95,85 90,15 5,10")],
            &[("envelope", "M50,30 L90,15 95,85 Q40,110 10,90 L5,10 Z"), ("corners", "10,90 95,85 90,15 5,10")],
        ),
        // A circle's corners are found on its diagonals.
        Law::Same(
            &[("envelope", CIRCLE)],
            &[("envelope", CIRCLE), ("corners", "14.6446609406726,85.3553390593274 85.3553390593274,85.3553390593274 85.3553390593274,14.6446609406726 14.6446609406726,14.6446609406726")],
        ),
        // Sides one by one are the closed path.
        Law::Same(
            &[("bottom", "M0,90 Q50,110 100,90"), ("top", "M0,0 Q40,20 100,10"), ("right", "M100,90 Q80,50 100,10"), ("left", "0,0 0,90")],
            &[("envelope", "M0,90 Q50,110 100,90 Q80,50 100,10 Q40,20 0,0 Z")],
        ),
        Law::KeepsLinesAlong(&[("bottom", "M0,90 C30,130 60,60 100,95"), ("top", "M5,10 Q60,-30 90,5"), ("by", "parameter")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("bottom", "M0,90 C30,130 60,60 100,95 L140,100"), ("top", "M5,10 Q60,-30 90,5"), ("keep", "verticals")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("left", "M0,90 C30,60 -30,40 0,0"), ("right", "M100,110 L80,50 110,5"), ("keep", "horizontals")], (1.0, 0.0)),
        Law::KeepsLines(&[("envelope", "0,90 100,80 80,10 10,0"), ("keep", "lines")]),
    ])
    .cases(&[
        // Half a circle of radius 50, and the same 40 higher: quarter of the way along is 45° round.
        Case { args: ARCH, at: (25.0, 100.0), to: (50.0 - 50.0 * SIN_45, 100.0 - 50.0 * SIN_45), tolerance: 1e-10 },
        Case { args: ARCH, at: (50.0, 0.0), to: (50.0, 10.0), tolerance: 1e-10 },
        Case { args: ARCH, at: (75.0, 50.0), to: (50.0 + 50.0 * SIN_45, 80.0 - 50.0 * SIN_45), tolerance: 1e-10 },
        // The middle of the Coons patch, as for the shaper.
        Case { args: CAGE, at: (50.0, 50.0), to: (46.875, 55.625), tolerance: 1e-12 },
        // y = 100 − 1.6·x·(100−x)/100: at x = 20 the curve is 25.6 higher.
        Case { args: UPRIGHT, at: (20.0, 100.0), to: (20.0, 74.4), tolerance: 1e-10 },
        Case { args: UPRIGHT, at: (20.0, 0.0), to: (20.0, 24.4), tolerance: 1e-10 },
    ]);

const CIRCLE: &str = "M100,50 A50,50 0 1 1 0,50 A50,50 0 1 1 100,50 Z";
const ARCH: Pairs = &[("bottom", "M0,100 A50,50 0 0 1 100,100"), ("height", "40")];
const CAGE: Pairs = &[("envelope", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z"), ("by", "parameter")];
const UPRIGHT: Pairs = &[("bottom", "M0,100 Q50,20 100,100"), ("height", "50"), ("keep", "verticals")];
const SIN_45: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Envelope::read(s)?.build());

fn curves(s: &Settings<'_>) -> Result<[Option<NamedPath>; 4], Error> {
    let [bottom, right, top, left] = SIDES.map(|name| s.path_if(name));
    Ok([bottom?, right?, top?, left?])
}

/// Reads the corners: four numbers of nodes, or points.
fn corners(s: &Settings<'_>) -> Result<Option<Corners>, Error> {
    let Some(text) = s.texts("corners").pop() else { return Ok(None) };
    let words: Vec<&str> = text.split([',', ' ', ';']).filter(|w| !w.is_empty()).collect();
    let numbers: Option<Vec<usize>> = words.iter().map(|w| w.parse().ok()).collect();
    if let Some(Ok(nodes)) = numbers.map(<[usize; 4]>::try_from) {
        return Ok(Some(Corners::Nodes(nodes)));
    }
    let points = s.points_in("corners", text).ok().and_then(|p| p.try_into().ok());
    let problem = "is neither four numbers of nodes (1,4,7,9) nor four points x,y";
    points.map(|p| Some(Corners::Points(p))).ok_or_else(|| Error::usage("corners", text, problem))
}

/// Columns that hold at least this share of a shape's area fill it.
const FILLS: f64 = 0.8;
/// Samples along each axis of a box.
const GRID: u32 = 24;

/// The settings and the artwork that decide on the map: the patch of four sides, columns, rows or lines.
#[derive(Clone, Copy)]
struct Chooser<'a> {
    frame: Rect,
    keep: Keep,
    spread: Option<Spread>,
    margins: Margins,
    lettering: bool,
    /// The lines of lettering.
    lines: &'a [lines::Line],
    letter_count: usize,
    /// Points of the artwork; empty if they are not known.
    ink: &'a [Point],
}

impl Chooser<'_> {
    /// Builds the map. `closed` is the shape, unless the user divided it; `ring` is its division into four sides.
    fn build(&self, closed: Option<Subpath>, ring: Result<Ring, Error>) -> Result<Built, Error> {
        // Curves that meet enclose a shape.
        let closed = closed.or_else(|| ring.as_ref().ok().filter(|r| r.bottom_meets_top()).map(Ring::closed));
        match (self.keep, closed) {
            (Keep::Verticals, Some(shape)) if self.lines.len() > 1 => self.in_lines(&shape),
            (Keep::Verticals | Keep::Horizontals, Some(shape)) => {
                fill(self.frame, &shape, self.keep == Keep::Verticals, &self.margins)
            }
            (Keep::Auto, Some(shape)) => self.most_suitable(&shape, ring.ok()),
            (keep, _) => {
                let ring = ring?;
                // Between curved sides, only columns and rows keep lines.
                let kept_sides = match keep {
                    Keep::Verticals => [1, 3],
                    Keep::Horizontals => [0, 2],
                    _ => return self.patch(&ring, keep),
                };
                if kept_sides.iter().any(|k| is_curved(&ring, *k)) {
                    return fill(self.frame, &ring.closed(), keep == Keep::Verticals, &self.margins);
                }
                self.patch(&ring, keep)
            }
        }
    }

    /// Builds the patch of four sides.
    fn patch(&self, ring: &Ring, keep: Keep) -> Result<Built, Error> {
        let keep = if keep == Keep::Auto { Keep::Nothing } else { keep };
        fit(with_padding(self.frame, ring, self.margins.padding)?, ring, keep, self.spread)
    }

    /// Builds the map that suits the shape and the artwork best.
    fn most_suitable(&self, shape: &Subpath, ring: Option<Ring>) -> Result<Built, Error> {
        let has_corners = ring.as_ref().is_some_and(|ring| has_four_corners(shape, ring));
        if self.lines.len() > 1 {
            let built = ring.as_ref().filter(|_| has_corners).and_then(|ring| self.in_rows(ring, shape));
            return built.map_or_else(|| self.in_lines(shape), Ok);
        }
        let (ring, frame) = match ring {
            Some(ring) if has_corners && self.lettering => {
                let (ring, frame) = between_notches(ring, shape, self.frame);
                (Some(ring), frame)
            }
            ring => (ring, self.frame),
        };
        let patch = || Chooser { frame, ..*self }.patch(ring.as_ref()?, Keep::Nothing).ok();
        if has_corners && let Some(built) = patch() {
            return Ok(built);
        }
        if self.lettering {
            return fill(self.frame, shape, true, &self.margins).or_else(|e| patch().ok_or(e));
        }
        let fills = |upright: bool| Columns::new(shape, upright, &Margins::default()).map_or(0.0, |c| c.coverage);
        let in_columns = [true, false].into_iter().filter(|upright| fills(*upright) >= FILLS);
        let in_columns = in_columns.filter_map(|upright| fill(self.frame, shape, upright, &self.margins).ok());
        let scored = patch().into_iter().chain(in_columns).map(|built| (self.distortion(&*built.map), built));
        let best = scored.reduce(|a, b| if b.0 < a.0 { b } else { a });
        best.map(|b| b.1).ok_or_else(|| no_room(shape))
    }

    /// Fits the lines one by one.
    fn in_lines(&self, shape: &Subpath) -> Result<Built, Error> {
        let region = Region::new(shape, Affine::IDENTITY, self.margins.padding).ok_or_else(|| no_room(shape))?;
        let mut strips = lines::Strips::new(self.lines, self.letter_count);
        let (map, notes) = lines::fit_lines(self.lines, &region, &mut strips)?;
        let mut built = Built::new(map);
        built.explanation.notes = notes;
        built.overlay(Role::Cage, preview(shape));
        Ok(with_placement(built, &strips))
    }

    /// Puts the lines into rows of the patch of four sides.
    fn in_rows(&self, ring: &Ring, shape: &Subpath) -> Option<Built> {
        let length = |k: usize| Side::new(&ring.sides[k], Pace::Length).map_or(0.0, |s| s.length());
        // The mean lengths of bottom and top, and of both other sides.
        let size = [0, 1].map(|k| 0.5 * (length(k) + length(k + 2)));
        let mut strips = lines::Strips::new(self.lines, self.letter_count);
        let row = |frame: Rect| {
            let (ring, frame) = between_notches(ring.clone(), shape, frame);
            Chooser { frame, ..*self }.patch(&ring, Keep::Nothing)
        };
        let rows = strips.frames(self.lines, size)?.into_iter().map(row).collect::<Result<Vec<Built>, _>>().ok()?;
        let tiles = rows.iter().map(|b| TileRow { cuts: Vec::new(), maps: vec![Arc::clone(&b.map)] }).collect();
        let map = Tiled::over(self.frame, strips.cuts.clone(), tiles)?;
        Some(with_placement(Built { map, ..rows.into_iter().next()? }, &strips))
    }

    /// Returns the distortion of the artwork by a map, in the units of [`distortion`].
    fn distortion(&self, map: &dyn Map) -> f64 {
        let f = self.frame;
        let grid: Vec<Point> = grid(GRID).map(|p| f.origin() + Vec2::new(p.x * f.width(), p.y * f.height())).collect();
        let points = if self.ink.is_empty() { &grid } else { self.ink };
        let corners = [(f.x0, f.y1), (f.x1, f.y1), (f.x1, f.y0), (f.x0, f.y0)].map(|p| map.point(p.into()));
        distortion(&points.iter().map(|p| map.jet(*p)).collect::<Vec<_>>()) + turning_cost(corners)
    }
}

/// Adds the maps that take letters into the strips before they are bent.
fn with_placement(mut built: Built, strips: &lines::Strips) -> Built {
    built.placement.letters = strips.letter_maps();
    built.placement.before = !built.placement.letters.is_empty();
    built
}

/// Returns `true` if a shape clearly has four corners: no other sharp node points outwards, the bottom runs to the right and the
/// sides upwards, and the patch folds nowhere and is nowhere stretched much more in one direction than in the other.
fn has_four_corners(shape: &Subpath, ring: &Ring) -> bool {
    /// The largest angle of the bottom and of the sides with the screen's axes, as a tangent.
    const MAX_LEAN: f64 = 0.9;
    /// The largest ratio of both stretches, relative to their means, in nine tenths of the samples.
    const MAX_RATIO: f64 = 2.2;
    let around: f64 = shape.segs.iter().map(double_area).sum();
    let tips: Vec<Point> = corners::sharp_nodes(shape, around.signum()).map(|i| shape.segs[i].start()).collect();
    let size = bounds(shape).size().max_side();
    let is_corner =
        |p: &Point| ring.sides.iter().flat_map(|s| s.first()).any(|s| s.start().distance(*p) <= 1e-9 * size);
    if tips.len() != 4 || !tips.iter().all(is_corner) {
        return false;
    }
    let [bottom, right, top, left] = &ring.sides;
    let sides = [bottom, right, &reversed(top), &reversed(left)].map(|s| Side::new(s, Pace::Length));
    let [Some(bottom), Some(right), Some(top), Some(left)] = sides else { return false };
    let map = Coons::new(Sides { bottom, right, top, left }, Affine::IDENTITY);
    let jets: Vec<Jet> = grid(GRID).map(|p| map.jet(p)).collect();
    let [right, up] = [jets.iter().map(|j| j.dx).sum::<Vec2>(), jets.iter().map(|j| j.dy).sum::<Vec2>()];
    let is_upright = right.y.abs() <= MAX_LEAN * right.x && up.x.abs() <= -MAX_LEAN * up.y;
    let screen: Vec<Jet> = jets.iter().map(|j| Jet { dy: -j.dy, ..*j }).collect();
    let mut ratios: Vec<f64> =
        stretches(&screen).iter().map(|[a, b]| if *b > 0.0 { a / b } else { f64::INFINITY }).collect();
    ratios.sort_by(f64::total_cmp);
    is_upright && ratios[ratios.len() - 1] < f64::INFINITY && ratios[ratios.len() * 9 / 10] <= MAX_RATIO
}

/// Ends lettering at the notches of a swallow-tailed banner: a side with a notch becomes straight, and the box is widened so that
/// the letters end at the upright through the notch.
fn between_notches(mut ring: Ring, shape: &Subpath, frame: Rect) -> (Ring, Rect) {
    let around: f64 = shape.segs.iter().map(double_area).sum();
    let notches: Vec<Point> = corners::sharp_nodes(shape, -around.signum()).map(|i| shape.segs[i].start()).collect();
    let (Some(bottom), Some(top)) =
        (Side::new(&ring.sides[0], Pace::Length), Side::new(&reversed(&ring.sides[2]), Pace::Length))
    else {
        return (ring, frame);
    };
    // The share of the width between a side and the upright through a notch. Uprights nearer to the side lie outside of the notch.
    let share = |notch: Point, right: bool| {
        let outside = |t: f64| {
            let u = if right { 1.0 - t } else { t };
            let (from, to) = (bottom.at(u).0, top.at(u).0);
            ((to - from).cross(notch - from) > 0.0) != right
        };
        (outside(0.0) && !outside(0.5)).then(|| bisect(0.5, 0.0, |t| if outside(t) { 1.0 } else { -1.0 }))
    };
    let [mut left, mut right] = [0.0_f64; 2];
    for (k, is_right, share_cut) in [(3, false, &mut left), (1, true, &mut right)] {
        let side = &ring.sides[k];
        let nodes: Vec<Point> = side.iter().skip(1).map(Seg::start).filter(|p| notches.contains(p)).collect();
        let Some(deepest) = nodes.iter().filter_map(|p| share(*p, is_right)).reduce(f64::max) else { continue };
        let (from, to) = (side[0].start(), side[side.len() - 1].end());
        ring.notes.push(format!("the letters end at {}", nodes.iter().map(|p| show(*p)).collect::<Vec<_>>().join(" ")));
        ring.sides[k] = vec![Seg::Line(Line::new(from, to))];
        *share_cut = deepest;
    }
    let width = frame.width() / (1.0 - left - right);
    (ring, Rect::new(frame.x0 - left * width, frame.y0, frame.x1 + right * width, frame.y1))
}

/// Returns a larger box, whose map into the sides keeps `frame` a distance of `padding` away from them.
fn with_padding(frame: Rect, ring: &Ring, padding: f64) -> Result<Rect, Error> {
    if padding == 0.0 {
        return Ok(frame);
    }
    let length = |k: usize| Side::new(&ring.sides[k], Pace::Length).map_or(0.0, |s| s.length());
    let share = |a: usize, b: usize| padding / length(a).min(length(b));
    let (x, y) = (share(0, 2), share(1, 3));
    if !(x < 0.5 && y < 0.5) {
        return Err(Error::usage("padding", padding.to_string(), "leaves nothing of the shape"));
    }
    Ok(frame.inflate(frame.width() * x / (1.0 - 2.0 * x), frame.height() * y / (1.0 - 2.0 * y)))
}
