//! Parameters, declared once: from one table per deformation come the command line, recipes, help, schema and editors.
//!
//! [`Param`] describes, [`Args`] holds what was typed, [`Frame`] gives `%` a meaning, [`Settings`] brings the three together
//! with typed getters.

mod args;
mod settings;
mod unit;

pub use args::{Args, NamedPath, NamedText, is_inline};
pub use settings::Settings;

use kurbo::{Point, Rect};

/// Which length 100 % of a [`Kind::Length`] stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The frame's width.
    X,
    /// The frame's height.
    Y,
    /// The frame's diagonal.
    Diagonal,
}

/// What kind of value a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Present or not; takes no value.
    Flag,
    /// A plain number, or a percentage (50% = 0.5).
    Number,
    /// Several numbers separated by commas or spaces: how many.
    Numbers(usize),
    /// A length in user units, with a CSS unit (mm, cm, in, pt, pc, q, px), or in % of the frame.
    Length(Axis),
    /// An angle in degrees, or with a unit (deg, rad, grad, turn).
    Angle,
    /// A whole number.
    Count,
    /// A place `x,y`; each coordinate a length, % from the frame's left and top.
    Point,
    /// A path reference: `FILE#NAME`, `FILE`, `#NAME`, `M …` or `x,y x,y …`.
    Path,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Any text: the deformation reads it itself. The words say what, e.g. `I,J:DX,DY`.
    Text(&'static str),
    /// One of these words or another spelling that the deformation knows, or a file whose text it reads: what holds a dot or a
    /// slash is a file.
    NameOrFile(&'static [&'static str]),
    /// A file whose text the deformation reads.
    File,
    /// A file that the deformation's data is saved to.
    Save,
}

/// One parameter of a deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Param {
    /// Its name, kebab-case: `--name` on the command line, the key in recipes.
    pub name: &'static str,
    /// The kind of value.
    pub kind: Kind,
    /// The default, as a user would type it. `None`: none, the parameter may stay away unless [`needed`](Self::needed).
    pub default: Option<&'static str>,
    /// Whether it must be given.
    pub needed: bool,
    /// Whether it may be given several times.
    pub repeat: bool,
    /// The values that are legal, both ends included (numbers, lengths in user units, angles in degrees, counts).
    pub range: (f64, f64),
    /// The values an editor's slider should offer.
    pub ui: (f64, f64),
    /// One or more sentences for help; the first says it all.
    pub help: &'static str,
}

/// No limit.
const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl Param {
    /// A parameter without default and limits.
    #[must_use]
    pub const fn new(name: &'static str, kind: Kind, help: &'static str) -> Self {
        Self { name, kind, default: None, needed: false, repeat: false, range: ANY, ui: (0.0, 1.0), help }
    }

    /// A switch.
    #[must_use]
    pub const fn flag(name: &'static str, help: &'static str) -> Self {
        Self::new(name, Kind::Flag, help)
    }

    /// A path reference.
    #[must_use]
    pub const fn path(name: &'static str, help: &'static str) -> Self {
        Self::new(name, Kind::Path, help)
    }

    /// A length.
    #[must_use]
    pub const fn length(name: &'static str, axis: Axis, help: &'static str) -> Self {
        Self::new(name, Kind::Length(axis), help)
    }

    /// A number.
    #[must_use]
    pub const fn number(name: &'static str, help: &'static str) -> Self {
        Self::new(name, Kind::Number, help)
    }

    /// An angle.
    #[must_use]
    pub const fn angle(name: &'static str, help: &'static str) -> Self {
        Self { ui: (-180.0, 180.0), ..Self::new(name, Kind::Angle, help) }
    }

    /// The same with a default, as typed.
    #[must_use]
    pub const fn default(self, text: &'static str) -> Self {
        Self { default: Some(text), ..self }
    }

    /// The same, but it must be given.
    #[must_use]
    pub const fn needed(self) -> Self {
        Self { needed: true, ..self }
    }

    /// The same, but it may be given several times.
    #[must_use]
    pub const fn repeated(self) -> Self {
        Self { repeat: true, ..self }
    }

    /// The same with legal limits, both ends included.
    #[must_use]
    pub const fn within(self, least: f64, most: f64) -> Self {
        Self { range: (least, most), ui: (least, most), ..self }
    }

    /// The same with a slider range of its own.
    #[must_use]
    pub const fn slider(self, from: f64, to: f64) -> Self {
        Self { ui: (from, to), ..self }
    }

    /// How help shows the value, e.g. `PATH`.
    #[must_use]
    pub fn value_name(&self) -> String {
        match self.kind {
            Kind::Flag => String::new(),
            Kind::Number => "NUMBER".into(),
            Kind::Numbers(n) => {
                let names = ["a", "b", "c", "d", "e", "f", "g", "h", "i"];
                names[..n.min(names.len())].join(",")
            }
            Kind::Length(_) => "LENGTH".into(),
            Kind::Angle => "ANGLE".into(),
            Kind::Count => "N".into(),
            Kind::Point => "X,Y".into(),
            Kind::Path => "PATHREF".into(),
            Kind::Choice(words) => words.join("|"),
            Kind::Text(what) => what.into(),
            Kind::NameOrFile(_) => "NAME|FILE".into(),
            Kind::File | Kind::Save => "FILE".into(),
        }
    }

    /// Whether `value`, typed for this parameter, names a file to be read.
    #[must_use]
    pub fn reads_file(&self, value: &str) -> bool {
        match self.kind {
            Kind::File => true,
            Kind::NameOrFile(_) => value.contains(['.', '/', '\\']),
            _ => false,
        }
    }
}

/// The box that gives `%` a meaning: the artwork's, the view box, or one the user names. Root user units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The box.
    pub rect: Rect,
}

impl Frame {
    /// A frame on `rect`.
    #[must_use]
    pub fn new(rect: Rect) -> Self {
        Self { rect: rect.abs() }
    }

    /// 100 % along `axis`.
    #[must_use]
    pub fn extent(&self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.rect.width(),
            Axis::Y => self.rect.height(),
            Axis::Diagonal => self.rect.width().hypot(self.rect.height()),
        }
    }

    /// The four corners: bottom left, bottom right, top right, top left on the screen (y down).
    #[must_use]
    pub fn corners(&self) -> [Point; 4] {
        let r = self.rect;
        [Point::new(r.x0, r.y1), Point::new(r.x1, r.y1), Point::new(r.x1, r.y0), Point::new(r.x0, r.y0)]
    }
}
