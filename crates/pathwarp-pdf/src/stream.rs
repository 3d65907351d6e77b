//! A content stream under construction, with the resources it uses.

use crate::outline;
use crate::space::matrix;
use kurbo::{Affine, BezPath, Vec2};
use pdf_writer::types::ColorSpaceOperand;
use pdf_writer::writers::Resources;
use pdf_writer::{Content, Finish as _, Name, Ref};
use std::collections::BTreeSet;

/// Coordinates beyond this are far from the page's corner: in single precision their last digit is a hundredth.
pub(crate) const FAR: f64 = 1e5;

/// The kinds of resources in use here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// A graphics state: opacity, blend mode, mask.
    State,
    /// A gradient or pattern.
    Pattern,
    /// A picture or a group.
    Object,
}

/// The resources that a content stream uses.
#[derive(Debug, Default)]
pub(crate) struct Used(BTreeSet<(Kind, i32)>);

/// A content stream.
pub(crate) struct Stream {
    pub(crate) content: Content,
    used: Used,
    /// From the current coordinates to those in which the stream starts: patterns are anchored there.
    pub(crate) to_start: Affine,
    /// What is subtracted from the current coordinates before they are written: PDF has single precision, too coarse for maps in
    /// metres. Nothing, as long as the page's corner is not far.
    pub(crate) shift: Vec2,
    outer: Vec<(Affine, Vec2)>,
}

impl Stream {
    pub(crate) fn new() -> Self {
        Self::shifted(Vec2::ZERO)
    }

    /// The content of an object that is drawn in coordinates that are written with this shift.
    pub(crate) fn shifted(shift: Vec2) -> Self {
        let to_start = Affine::translate(-shift);
        Self { content: Content::new(), used: Used::default(), to_start, shift, outer: Vec::new() }
    }

    /// Saves the graphics state.
    pub(crate) fn save(&mut self) {
        self.content.save_state();
        self.outer.push((self.to_start, self.shift));
    }

    /// Restores the graphics state.
    pub(crate) fn restore(&mut self) {
        self.content.restore_state();
        (self.to_start, self.shift) = self.outer.pop().unwrap_or_default();
    }

    /// Changes the coordinates.
    pub(crate) fn transform(&mut self, m: Affine) {
        if m != Affine::IDENTITY {
            let corner = (m.inverse() * self.shift.to_point()).to_vec2();
            let shift = if corner.hypot() > FAR && corner.is_finite() { corner } else { Vec2::ZERO };
            self.content.transform(matrix(Affine::translate(-self.shift) * m * Affine::translate(shift)));
            self.to_start *= m;
            self.shift = shift;
        }
    }

    /// Draws an object of the unit square in an area given by a transform of that.
    pub(crate) fn placed(&mut self, object: Ref, unit: Affine) {
        self.content.save_state();
        self.content.transform(matrix(Affine::translate(-self.shift) * unit));
        self.object(object);
        self.content.restore_state();
    }

    /// Starts a path with these outlines.
    pub(crate) fn outline(&mut self, path: &BezPath) {
        if self.shift == Vec2::ZERO {
            outline::write(&mut self.content, path);
        } else {
            outline::write(&mut self.content, &(Affine::translate(-self.shift) * path));
        }
    }

    /// Restricts drawing to an outline.
    pub(crate) fn clip(&mut self, path: &BezPath, rule: usvg::FillRule) {
        self.outline(path);
        match rule {
            usvg::FillRule::NonZero => self.content.clip_nonzero(),
            usvg::FillRule::EvenOdd => self.content.clip_even_odd(),
        };
        self.content.end_path();
    }

    /// Sets a graphics state.
    pub(crate) fn state(&mut self, state: Ref) {
        let name = self.used.name(Kind::State, state);
        self.content.set_parameters(Name(name.as_bytes()));
    }

    /// Draws a picture or a group.
    pub(crate) fn object(&mut self, object: Ref) {
        let name = self.used.name(Kind::Object, object);
        self.content.x_object(Name(name.as_bytes()));
    }

    /// Takes a pattern as the paint.
    pub(crate) fn pattern(&mut self, pattern: Ref, strokes: bool) {
        let name = self.used.name(Kind::Pattern, pattern);
        let name = Name(name.as_bytes());
        if strokes {
            self.content.set_stroke_color_space(ColorSpaceOperand::Pattern).set_stroke_pattern(None, name);
        } else {
            self.content.set_fill_color_space(ColorSpaceOperand::Pattern).set_fill_pattern(None, name);
        }
    }

    /// The bytes and the resources.
    pub(crate) fn finish(self) -> (Vec<u8>, Used) {
        (self.content.finish().into_vec(), self.used)
    }
}

impl Used {
    /// The name of a resource, which is used from now on.
    fn name(&mut self, kind: Kind, r: Ref) -> String {
        self.0.insert((kind, r.get()));
        name(kind, r.get())
    }

    /// Writes the dictionary of resources.
    pub(crate) fn write(&self, out: &mut Resources<'_>) {
        for kind in [Kind::State, Kind::Pattern, Kind::Object] {
            let mut of_kind = self.0.iter().filter(|(k, _)| *k == kind).peekable();
            if of_kind.peek().is_none() {
                continue;
            }
            let mut dict = match kind {
                Kind::State => out.ext_g_states(),
                Kind::Pattern => out.patterns(),
                Kind::Object => out.x_objects(),
            };
            for (_, r) in of_kind {
                dict.pair(Name(name(kind, *r).as_bytes()), Ref::new(*r));
            }
            dict.finish();
        }
    }
}

fn name(kind: Kind, r: i32) -> String {
    let letter = match kind {
        Kind::State => 'G',
        Kind::Pattern => 'P',
        Kind::Object => 'X',
    };
    format!("{letter}{r}")
}
