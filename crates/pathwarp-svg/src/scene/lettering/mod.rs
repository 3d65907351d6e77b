//! Lettering in a drawing: lines with their baselines, and the letters that stand on them.
//!
//! It is known of two kinds of drawings, which behave alike: text (usvg's layout tells where each glyph stands), and outlines
//! that say so themselves, as [`crate::write_lettering`] makes them:
//!
//! ```xml
//! <g data-ascent="57" data-descent="16" data-cap-height="38" data-x-height="29">
//!   <g data-baseline="20 80 220 80">
//!     <path aria-label="W" data-glyph="20 80 51.5" d="…"/>
//!   </g>
//! </g>
//! ```
//!
//! `data-baseline` holds the line's start and end, `data-glyph` a letter's origin on the baseline and its advance, all in the
//! element's own user units; the heights count from the baseline.

mod marked;
mod shaped;

pub(crate) use marked::lines as marked_lines;
pub(crate) use shaped::lines as shaped_lines;

use crate::document::Document;
use crate::scene::model::{Part, Role};
use crate::source::select::Selection;
use crate::source::text::ElementId;
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::param::{self, Frame};
use pathwarp::{Error, Outline};
use std::ops::Range;

/// A letter and the subpaths it owns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Letter {
    pub(crate) name: String,
    /// Root user space.
    pub(crate) origin: Point,
    pub(crate) advance: f64,
    /// Parts, and which of their subpaths.
    pub(crate) owns: Vec<(usize, Range<usize>)>,
}

/// Heights of a line's font above its baseline (the descent below it), in the line's own user units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Heights {
    pub(crate) ascent: f64,
    pub(crate) descent: f64,
    pub(crate) cap_height: f64,
    pub(crate) x_height: f64,
}

/// A line of lettering, root user space.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    /// What it is called in messages.
    pub(crate) name: String,
    /// The element that is its text as a whole, if any.
    pub(crate) owner: Option<ElementId>,
    pub(crate) start: Point,
    pub(crate) end: Point,
    /// Root user units.
    pub(crate) heights: Heights,
    /// Whether its baseline runs level, to the right, with the letters upright on it.
    pub(crate) level: bool,
    pub(crate) letters: Vec<Letter>,
}

impl Line {
    /// A line between two points of a user space that `frame` takes to root user space. `straight`: whether it is a line at all.
    pub(crate) fn new(name: String, from: Point, to: Point, heights: Heights, frame: Affine, straight: bool) -> Self {
        /// A rise over the run up to which rounding to single precision may have tilted a level line.
        const TILT: f64 = 1e-5;
        let (start, end) = (frame * from, frame * to);
        let [a, b, c, d, ..] = frame.as_coeffs();
        let up = |h: f64| (Vec2::new(-c, -d) * h).hypot();
        let heights = Heights {
            ascent: up(heights.ascent),
            descent: up(heights.descent),
            cap_height: up(heights.cap_height),
            x_height: up(heights.x_height),
        };
        let run = end.x - start.x;
        let level = straight && d > 0.0 && run > 0.0 && (end.y - start.y).abs() <= TILT * run && b.abs() <= TILT * a;
        Self { name, owner: None, start, end, heights, level, letters: Vec::new() }
    }
}

/// What of the lettering a frame is laid round. Its left and right are the ends of the lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LetteringFrame {
    /// From the baseline to the font's ascent.
    BaselineAscent,
    /// From the baseline to the height of capitals.
    BaselineCapHeight,
    /// From the baseline to the height of small letters.
    BaselineXHeight,
    /// From the font's descent to its ascent.
    AscentDescent,
    /// The letters' own outlines.
    Ink,
}

/// The lettering that a selection means.
#[derive(Debug, Clone, PartialEq)]
pub struct Lettering {
    lines: Vec<Line>,
    letters: Vec<param::Letter>,
    only: bool,
    file: String,
}

impl Lettering {
    /// The letters, line by line.
    #[must_use]
    pub fn letters(&self) -> &[param::Letter] {
        &self.letters
    }

    /// Whether every baseline runs level, so that frames can be laid round them.
    #[must_use]
    pub fn is_level(&self) -> bool {
        !self.lines.is_empty() && self.lines.iter().all(|l| l.level)
    }

    /// Whether all the artwork is lettering.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self.only
    }

    /// A frame round the lettering: from the lowest line's baseline (or descent) to the highest line's ascent, or whatever
    /// `kind` says; between the leftmost start and the rightmost end of a line.
    ///
    /// # Errors
    /// [`Error::Input`] if there is no lettering, or its baselines are not level.
    pub fn frame(&self, kind: LetteringFrame) -> Result<Frame, Error> {
        if self.lines.is_empty() {
            let problem = "there is no lettering to lay a frame round: only text, and outlines made by `pathwarp text`, tell \
where their baselines are. Give the frame as a box X,Y,W,H, or leave it at artwork";
            return Err(Error::input(&self.file, problem));
        }
        if let Some(l) = self.lines.iter().find(|l| !l.level) {
            let problem = format!(
                "the baseline of `{}` does not run level from left to right: a frame cannot be laid round it. Turn it level \
before, or use --frame artwork",
                l.name
            );
            return Err(Error::input(&self.file, problem));
        }
        let least = |of: &dyn Fn(&Line) -> f64| self.lines.iter().map(of).fold(f64::INFINITY, f64::min);
        let most = |of: &dyn Fn(&Line) -> f64| -least(&|l| -of(l));
        let baseline = most(&|l| l.start.y);
        let above = |of: fn(&Heights) -> f64| least(&|l| l.start.y - of(&l.heights));
        let (top, bottom) = match kind {
            LetteringFrame::BaselineAscent => (above(|h| h.ascent), baseline),
            LetteringFrame::BaselineCapHeight => (above(|h| h.cap_height), baseline),
            LetteringFrame::BaselineXHeight => (above(|h| h.x_height), baseline),
            LetteringFrame::AscentDescent => (above(|h| h.ascent), most(&|l| l.start.y + l.heights.descent)),
            LetteringFrame::Ink => {
                let boxes = self.letters.iter().filter_map(|l| l.outline.bounding_box());
                let ink = boxes.reduce(|a, b| a.union(b));
                let none = || Error::input(&self.file, "the lettering has no outlines to lay a frame round");
                return Ok(Frame::new(ink.ok_or_else(none)?).on_baseline(baseline));
            }
        };
        if bottom - top <= 0.0 {
            let problem = "the font does not tell that height; use --frame baseline-ascent, ink or artwork";
            return Err(Error::input(&self.file, problem));
        }
        Ok(Frame::new(Rect::new(least(&|l| l.start.x), top, most(&|l| l.end.x), bottom)).on_baseline(baseline))
    }
}

impl Document {
    /// The lettering among what is painted and meant by `selection`.
    #[must_use]
    pub fn lettering(&self, selection: &Selection) -> Lettering {
        let meant = self.meant(selection);
        let lines = self.meant_lines(&meant);
        let outline = |l: &Letter| {
            let pieces = l.owns.iter().flat_map(|(i, r)| self.shapes()[*i].outline.subpaths.get(r.clone()));
            Outline { subpaths: pieces.flatten().cloned().collect() }
        };
        let letters = lines.iter().flat_map(|l| &l.letters);
        let letters = letters.map(|l| param::Letter {
            name: l.name.clone(),
            origin: l.origin,
            advance: l.advance,
            outline: outline(l),
        });
        let letters = letters.collect();
        let mut lettered = vec![false; self.shapes().len()];
        for (i, _) in lines.iter().flat_map(|l| &l.letters).flat_map(|l| &l.owns) {
            lettered[*i] = true;
        }
        let owners: Vec<ElementId> = lines.iter().filter_map(|l| l.owner).collect();
        let belongs = |i: usize| lettered[i] || self.scene().parts[i].owner.is_some_and(|o| owners.contains(&o));
        let only = (0..lettered.len()).all(|i| belongs(i) || !meant[i] || !self.shapes()[i].painted)
            && self.scene().bitmaps.is_empty()
            && !lines.is_empty();
        Lettering { lines, letters, only, file: self.name.clone() }
    }

    /// The lines, with the letters whose parts are all painted and meant.
    fn meant_lines(&self, meant: &[bool]) -> Vec<Line> {
        let whole = |l: &Letter| l.owns.iter().all(|(i, _)| meant[*i] && self.shapes()[*i].painted);
        let lines = self
            .scene()
            .lines
            .iter()
            .map(|line| Line { letters: line.letters.iter().filter(|l| whole(l)).cloned().collect(), ..line.clone() });
        lines.filter(|l| !l.letters.is_empty()).collect()
    }

    /// For every part the letters in it, by their number in [`Lettering::letters`], with the subpaths they own.
    pub(crate) fn letters_by_part(&self, selection: &Selection) -> Vec<Vec<(usize, Range<usize>)>> {
        let mut out = vec![Vec::new(); self.scene().parts.len()];
        let lines = self.meant_lines(&self.meant(selection));
        for (k, letter) in lines.iter().flat_map(|l| &l.letters).enumerate() {
            for (i, range) in &letter.owns {
                out[*i].push((k, range.clone()));
            }
        }
        out
    }
}

/// Whether a part can be a letter, or part of one.
fn paints(p: &Part) -> bool {
    p.role == Role::Paint && p.painted()
}
