//! The declaration of a parameter: its name, kind of value, default, range and help.

/// The extent of the frame to which percentages of a [`Kind::Length`] refer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The width.
    X,
    /// The height.
    Y,
    /// The diagonal.
    Diagonal,
}

/// The kind of value that a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A switch, which takes no value.
    Flag,
    /// A plain number, or a percentage (50% = 0.5).
    Number,
    /// This many numbers, separated by commas or spaces.
    Numbers(usize),
    /// A length in user units, with a CSS unit (px, mm, cm, m, in, pt, pc, q), or in % of the frame.
    Length(Axis),
    /// An angle in degrees, or with a unit (deg, rad, grad, turn).
    Angle,
    /// An integer.
    Count,
    /// A point `x,y`. Each coordinate is a length; percentages count from the left and top of the frame.
    Point,
    /// A path reference: `FILE#NAME`, `FILE`, `#NAME`, `M …`, `x,y x,y …`, or a shape such as `heart`.
    Path,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Text that the deformation parses, with its notation for help, such as `I,J:DX,DY`.
    Text(&'static str),
    /// One of these words, or another spelling that the deformation knows, or a file whose text it reads. A value with a dot or a
    /// slash names a file.
    NameOrFile(&'static [&'static str]),
    /// A file whose text the deformation reads.
    File,
    /// A file to which the deformation saves its data.
    Save,
}

impl Kind {
    /// Returns the name of the kind, such as `name-or-file`, in lists of parameters and the entries of plug-ins.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flag => "flag",
            Self::Number => "number",
            Self::Numbers(_) => "numbers",
            Self::Length(_) => "length",
            Self::Angle => "angle",
            Self::Count => "count",
            Self::Point => "point",
            Self::Path => "path",
            Self::Choice(_) => "choice",
            Self::Text(_) => "text",
            Self::NameOrFile(_) => "name-or-file",
            Self::File => "file",
            Self::Save => "save",
        }
    }
}

/// One parameter of a deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Param {
    /// The name in kebab case, which is the option on the command line and the key in recipes.
    pub name: &'static str,
    /// The kind of value.
    pub kind: Kind,
    /// The default as a user would type it. Without one, the parameter is optional unless [`needed`](Self::needed).
    pub default: Option<&'static str>,
    /// `true` if the parameter must be given.
    pub needed: bool,
    /// `true` if the parameter may be given several times.
    pub repeat: bool,
    /// The range of legal values, both ends included, for numbers, lengths in user units, angles in degrees and counts.
    pub range: (f64, f64),
    /// The range of a slider in an editor.
    pub ui: (f64, f64),
    /// Help of one or more sentences, the first of which stands alone.
    pub help: &'static str,
}

/// No limits.
const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl Param {
    /// Declares a parameter without a default or limits.
    #[must_use]
    pub const fn new(name: &'static str, kind: Kind, help: &'static str) -> Self {
        Self { name, kind, default: None, needed: false, repeat: false, range: ANY, ui: (0.0, 1.0), help }
    }

    /// Declares a switch.
    #[must_use]
    pub const fn flag(name: &'static str, help: &'static str) -> Self {
        Self::new(name, Kind::Flag, help)
    }

    /// Declares a path reference.
    #[must_use]
    pub const fn path(name: &'static str, help: &'static str) -> Self {
        Self::new(name, Kind::Path, help)
    }

    /// Declares a length.
    #[must_use]
    pub const fn length(name: &'static str, axis: Axis, help: &'static str) -> Self {
        Self::new(name, Kind::Length(axis), help)
    }

    /// Declares a number.
    #[must_use]
    pub const fn number(name: &'static str, help: &'static str) -> Self {
        Self::new(name, Kind::Number, help)
    }

    /// Declares an angle.
    #[must_use]
    pub const fn angle(name: &'static str, help: &'static str) -> Self {
        Self { ui: (-180.0, 180.0), ..Self::new(name, Kind::Angle, help) }
    }

    /// Declares a choice of two words, the first of which is the default.
    #[must_use]
    pub(crate) const fn either(name: &'static str, words: &'static [&'static str; 2], help: &'static str) -> Self {
        Self::new(name, Kind::Choice(words), help).default(words[0])
    }

    setters! {
        const:
        /// Sets the default, as a user would type it.
        default(text: &'static str) => default: Some(text);
        /// Sets the legal range, both ends included, and the slider's range with it.
        within(min: f64, max: f64) => range: (min, max), ui: (min, max);
        /// Sets the range of an editor's slider.
        slider(from: f64, to: f64) => ui: (from, to);
    }

    /// Makes the parameter required.
    #[must_use]
    pub const fn needed(self) -> Self {
        Self { needed: true, ..self }
    }

    /// Allows the parameter to be given several times.
    #[must_use]
    pub const fn repeated(self) -> Self {
        Self { repeat: true, ..self }
    }

    /// Returns the placeholder of the value in help, such as `PATHREF`.
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
            Kind::Text(notation) => notation.into(),
            Kind::NameOrFile(_) => "NAME|FILE".into(),
            Kind::File | Kind::Save => "FILE".into(),
        }
    }

    /// Returns known names for the value; others may be legal.
    #[must_use]
    pub fn names(&self) -> &'static [&'static str] {
        match self.kind {
            Kind::Choice(names) | Kind::NameOrFile(names) => names,
            Kind::Path => super::shape_names(),
            _ => &[],
        }
    }

    /// Returns `true` if `value`, given for this parameter, names a file to be read.
    #[must_use]
    pub fn reads_file(&self, value: &str) -> bool {
        match self.kind {
            Kind::File => true,
            Kind::NameOrFile(_) => value.contains(['.', '/', '\\']),
            _ => false,
        }
    }
}
