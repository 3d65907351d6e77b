//! Limits on the work that one input may cause: plain numbers, and counters for what is used.
//!
//! A few bytes can ask for any amount of work: references to references, packed text, pictures that announce a size, formulas
//! that oscillate. Whoever does such work counts it here first, and stops with an error that names the limit.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use thiserror::Error;

/// A quantity that is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Limit {
    /// Bytes of text, unpacked and with entities expanded.
    Bytes,
    /// Elements, with everything that references show again.
    Elements,
    /// Comparisons: of names, to match selectors and by the XML parser; of places, to measure distances.
    Comparisons,
    /// Segments of outlines: read, laid out, or written.
    Segments,
    /// Letters of text.
    Letters,
    /// Pixels held at the same time: pictures with their copies, and layers painted on each other.
    Pixels,
    /// Pixels painted in total, by layers, masks, filters and pictures.
    Painting,
    /// Bytes of embedded and linked pictures, and of drawings among them.
    ImageBytes,
    /// Evaluations of the map.
    Evaluations,
    /// Seconds of processor time. Counted by the program around this library.
    Seconds,
    /// Bytes of memory. Counted by the program around this library.
    Memory,
}

/// One mebibyte: an input up to this size has the base limits.
const BASE_SIZE: f64 = 1_048_576.0;

impl Limit {
    /// All limits, in the order of the help.
    pub const ALL: [Self; 11] = [
        Self::Bytes,
        Self::Elements,
        Self::Comparisons,
        Self::Segments,
        Self::Letters,
        Self::Pixels,
        Self::Painting,
        Self::ImageBytes,
        Self::Evaluations,
        Self::Seconds,
        Self::Memory,
    ];

    /// The name of the limit, as in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bytes => "bytes",
            Self::Elements => "elements",
            Self::Comparisons => "comparisons",
            Self::Segments => "segments",
            Self::Letters => "letters",
            Self::Pixels => "pixels",
            Self::Painting => "painting",
            Self::ImageBytes => "image-bytes",
            Self::Evaluations => "evaluations",
            Self::Seconds => "seconds",
            Self::Memory => "memory",
        }
    }

    /// The limit called `name`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|l| l.name() == name)
    }

    /// The counted things, in the plural.
    fn things(self) -> &'static str {
        match self {
            Self::Bytes => "bytes of text",
            Self::Elements => "elements",
            Self::Comparisons => "comparisons",
            Self::Segments => "segments",
            Self::Letters => "letters",
            Self::Pixels => "pixels at once",
            Self::Painting => "pixels to paint",
            Self::ImageBytes => "bytes of pictures",
            Self::Evaluations => "evaluations of the map",
            Self::Seconds => "seconds of processor time",
            Self::Memory => "bytes of memory",
        }
    }

    /// The value for inputs of up to a mebibyte. Together they keep a run below 5 seconds on one core and 500 MB; each is
    /// about what takes half of that if nothing else does (`docs/reliability.md` lists measured files).
    fn base(self) -> f64 {
        match self {
            Self::Bytes => 16e6,
            Self::Elements => 30e3,
            Self::Letters => 60e3,
            Self::Comparisons => 15e6,
            Self::Segments => 2e6,
            Self::Pixels => 80e6,
            Self::Painting => 400e6,
            Self::ImageBytes => 64e6,
            Self::Evaluations => 30e6,
            Self::Seconds => 4.5,
            Self::Memory => 450e6,
        }
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The limits of one input.
///
/// ```
/// use pathwarp::budget::{Limit, Limits};
///
/// let limits = Limits::default().with(Limit::Segments, 5e6).for_input(10 << 20);
/// assert_eq!(limits.of(Limit::Segments), 5e6);
/// assert_eq!(limits.of(Limit::Letters), 10.0 * Limits::default().of(Limit::Letters));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    given: [Option<f64>; Limit::ALL.len()],
    /// Factor on the limits that are not given.
    scale: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { given: [None; Limit::ALL.len()], scale: 1.0 }
    }
}

impl Limits {
    /// No limits at all: for trusted input.
    #[must_use]
    pub fn none() -> Self {
        Self { given: [Some(f64::INFINITY); Limit::ALL.len()], scale: 1.0 }
    }

    /// Sets a limit, whatever the size of the input.
    #[must_use]
    pub fn with(mut self, limit: Limit, most: f64) -> Self {
        self.given[limit as usize] = Some(most);
        self
    }

    /// The limits for an input of `bytes`: those that were not set grow in proportion above a mebibyte. They never shrink.
    #[must_use]
    pub fn for_input(self, bytes: usize) -> Self {
        Self { scale: (bytes as f64 / BASE_SIZE).max(self.scale), ..self }
    }

    /// The value of a limit. Where other limits are raised, time and memory grow alike, unless they are set themselves.
    #[must_use]
    pub fn of(&self, limit: Limit) -> f64 {
        let default = limit.base() * self.scale;
        self.given[limit as usize].unwrap_or(match limit {
            Limit::Seconds | Limit::Memory => default * self.raised(),
            _ => default,
        })
    }

    /// The largest factor by which a limit on work is raised.
    fn raised(&self) -> f64 {
        let factors = Limit::ALL.into_iter().zip(self.given).filter_map(|(l, g)| Some(g? / (l.base() * self.scale)));
        factors.fold(1.0, f64::max)
    }

    /// Checks a single amount, which is not counted.
    ///
    /// # Errors
    /// The amount exceeds the limit.
    pub fn check(&self, limit: Limit, amount: f64) -> Result<(), Exceeded> {
        let most = self.of(limit);
        // An amount that is not a number exceeds every limit.
        if amount <= most { Ok(()) } else { Err(Exceeded { limit, most, needed: amount, cut: false }) }
    }
}

/// More work than a limit allows.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{}{} {}, and the limit `{limit}` is {}", if *.cut { "at least " } else { "" }, rounded(*.needed), .limit.things(), rounded(*.most))]
pub struct Exceeded {
    /// The limit.
    pub limit: Limit,
    /// Its value.
    pub most: f64,
    /// The amount that is needed, or was counted when work stopped.
    pub needed: f64,
    /// The count was cut short at the limit.
    pub cut: bool,
}

impl Exceeded {
    /// The same for a count that was cut short, so that the whole amount is not known.
    #[must_use]
    pub fn cut_short(self) -> Self {
        Self { cut: true, ..self }
    }

    /// A value of the limit that allows the amount, in two figures; ten times the limit if the amount is not known.
    #[must_use]
    pub fn enough(&self) -> f64 {
        if self.cut {
            return 10.0 * self.most;
        }
        let unit = 10_f64.powf(self.needed.max(1.0).log10().floor() - 1.0);
        (self.needed / unit).ceil() * unit
    }
}

/// Large numbers in three figures.
fn rounded(v: f64) -> String {
    if v < 1e6 { format!("{}", (v * 100.0).round() / 100.0) } else { format!("{v:.2e}") }
}

/// The limits of one input with what is used of them. Threads share it.
#[derive(Debug, Default)]
pub struct Budget {
    limits: Limits,
    used: [AtomicU64; Limit::ALL.len()],
}

impl Budget {
    /// A budget of which nothing is used.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self { limits, used: Default::default() }
    }

    /// The limits.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Counts an amount.
    ///
    /// # Errors
    /// The sum of all amounts exceeds the limit.
    pub fn spend(&self, limit: Limit, amount: u64) -> Result<(), Exceeded> {
        let before = self.used[limit as usize].fetch_add(amount, Ordering::Relaxed);
        self.limits.check(limit, before.saturating_add(amount) as f64)
    }

    /// Counts an amount whose count was cut short if it exceeds the limit.
    ///
    /// # Errors
    /// The sum of all amounts exceeds the limit.
    pub fn spend_cut(&self, limit: Limit, amount: u64) -> Result<(), Exceeded> {
        self.spend(limit, amount).map_err(Exceeded::cut_short)
    }

    /// Checks a single amount, which is not counted.
    ///
    /// # Errors
    /// The amount exceeds the limit.
    pub fn check(&self, limit: Limit, amount: f64) -> Result<(), Exceeded> {
        self.limits.check(limit, amount)
    }

    /// The amount that is left.
    #[must_use]
    pub fn left(&self, limit: Limit) -> f64 {
        (self.limits.of(limit) - self.used[limit as usize].load(Ordering::Relaxed) as f64).max(0.0)
    }
}

/// Budgets are equal if their limits are.
impl PartialEq for Budget {
    fn eq(&self, other: &Self) -> bool {
        self.limits == other.limits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_add_up_and_the_error_names_the_limit() {
        let budget = Budget::new(Limits::default().with(Limit::Letters, 10.0));
        assert!(budget.spend(Limit::Letters, 6).is_ok() && budget.spend(Limit::Letters, 4).is_ok());
        assert_eq!(budget.left(Limit::Letters), 0.0);
        let e = budget.spend(Limit::Letters, 1).unwrap_err();
        assert_eq!((e.limit, e.most, e.needed, e.enough()), (Limit::Letters, 10.0, 11.0, 11.0));
        assert_eq!(e.to_string(), "11 letters, and the limit `letters` is 10");
        assert!(budget.check(Limit::Pixels, f64::NAN).is_err());
    }

    #[test]
    fn limits_grow_with_the_input_unless_they_are_given() {
        let limits = Limits::default().with(Limit::Bytes, 5.0).for_input(3 << 20);
        assert_eq!(limits.of(Limit::Bytes), 5.0);
        assert_eq!(limits.of(Limit::Elements), 3.0 * Limits::default().of(Limit::Elements));
        assert_eq!(Limits::default().for_input(7), Limits::default());
        let raised = Limits::default().with(Limit::Pixels, 2.0 * Limit::Pixels.base());
        assert_eq!(raised.of(Limit::Memory), 2.0 * Limit::Memory.base());
    }

    #[test]
    fn names_are_found_again() {
        assert!(Limit::ALL.into_iter().all(|l| Limit::named(l.name()) == Some(l)));
        // The order is that of the declaration, by which limits are stored.
        assert!(Limit::ALL.into_iter().enumerate().all(|(i, l)| l as usize == i));
    }
}
