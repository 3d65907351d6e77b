//! Group codes: a DXF file is a list of pairs of a code and a value, each on a line.

use pathwarp::decimal::push_trimmed;
use pathwarp::kurbo::Point;
use std::fmt::Write as _;

/// Decimals of coordinates: a millionth of a micrometre.
const DECIMALS: usize = 9;

/// Decimals of angles, parameters and ratios, so that a point at a hundred metres is off by less than that.
const FINE: usize = 14;

/// The first handle that tables do not use.
const FIRST_HANDLE: u64 = 0x100;

/// The text of a file under construction.
pub(crate) struct Codes {
    text: String,
    next: u64,
}

impl Codes {
    pub(crate) fn new() -> Self {
        Self { text: String::new(), next: FIRST_HANDLE }
    }

    /// A text.
    pub(crate) fn text(&mut self, code: u16, value: &str) -> &mut Self {
        let _ = write!(self.text, "{code:>3}\n{value}\n");
        self
    }

    /// A whole number.
    pub(crate) fn whole(&mut self, code: u16, value: i64) -> &mut Self {
        let _ = write!(self.text, "{code:>3}\n{value}\n");
        self
    }

    /// A length.
    pub(crate) fn length(&mut self, code: u16, value: f64) -> &mut Self {
        self.number(code, value, DECIMALS)
    }

    /// An angle, parameter or ratio.
    pub(crate) fn fine(&mut self, code: u16, value: f64) -> &mut Self {
        self.number(code, value, FINE)
    }

    /// A point with x, y and z.
    pub(crate) fn point(&mut self, code: u16, p: Point) -> &mut Self {
        self.length(code, p.x).length(code + 10, p.y).length(code + 20, 0.0)
    }

    /// A handle.
    pub(crate) fn handle(&mut self, code: u16, handle: u64) -> &mut Self {
        let _ = write!(self.text, "{code:>3}\n{handle:X}\n");
        self
    }

    /// The handle of a new object.
    pub(crate) fn new_handle(&mut self) -> u64 {
        self.next += 1;
        self.next - 1
    }

    fn number(&mut self, code: u16, value: f64, decimals: usize) -> &mut Self {
        let _ = writeln!(self.text, "{code:>3}");
        let from = self.text.len();
        push_trimmed(&mut self.text, value, decimals);
        // A real number has a point, by which some readers tell it from a whole one.
        if !self.text[from..].contains('.') {
            self.text.push_str(".0");
        }
        self.text.push('\n');
        self
    }

    /// The text, in which `$HANDSEED` gets the first free handle.
    pub(crate) fn finish(mut self) -> String {
        let (seed, next) = (Self::SEED, self.next);
        if let Some(at) = self.text.find(seed) {
            self.text.replace_range(at..at + seed.len(), &format!("{next:X}"));
        }
        self.text
    }

    /// Stands for the first free handle until all are known.
    pub(crate) const SEED: &str = "{first free handle}";
}
