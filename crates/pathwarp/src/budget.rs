//! Limits on the size and the work of one input: three sizes, checked when it is read, and one counter of work.
//!
//! A few bytes can ask for any amount of work: references to references, packed text, pictures that announce a size, formulas
//! that oscillate. Sizes that are known beforehand are compared with a limit. Everything else is work: stages count their work before or
//! after they do it, long loops check the budget as they go, and an error names the limit.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use thiserror::Error;

/// A quantity that is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Limit {
    /// Bytes of text, unpacked and with entities expanded, and of embedded fonts. Bytes of pictures count beyond four for each pixel.
    Bytes,
    /// Elements, repeated for every reference to them.
    Elements,
    /// Pixels of pictures that are read or made.
    Pixels,
    /// Work of all kinds, in evaluations of a bicubic net with the work around them: about 50 nanoseconds each.
    Work,
    /// Seconds of processor time: the last resort. They are counted by the program around this library.
    Seconds,
    /// Bytes of memory. The program around this library counts them; layers are compared before they are painted.
    Memory,
}

/// The work that common operations take.
#[doc(hidden)]
pub mod cost {
    /// A comparison of names, of points or of a selector with an element.
    pub const COMPARISON: f64 = 2.0;
    /// An element that is read, styled and written.
    pub const ELEMENT: f64 = 600.0;
    /// A segment that is read, laid out and written. Its memory counts, too.
    pub const SEGMENT: f64 = 40.0;
    /// A letter that is shaped and laid out.
    pub const LETTER: f64 = 200.0;
    /// A pixel that is painted with a little arithmetic.
    pub const PIXEL: f64 = 0.08;
}

/// One mebibyte: the largest size of an input with the base limits.
const BASE_SIZE: f64 = 1_048_576.0;

impl Limit {
    /// All limits, in the order of the help.
    pub const ALL: [Self; 6] = [Self::Bytes, Self::Elements, Self::Pixels, Self::Work, Self::Seconds, Self::Memory];

    /// The name of the limit, as in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bytes => "bytes",
            Self::Elements => "elements",
            Self::Pixels => "pixels",
            Self::Work => "work",
            Self::Seconds => "seconds",
            Self::Memory => "memory",
        }
    }

    /// The limit called `name`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|l| l.name() == name)
    }

    /// The unit in messages, in the plural.
    fn unit(self) -> &'static str {
        match self {
            Self::Work => "units of work",
            Self::Seconds => "seconds of processor time",
            Self::Memory => "bytes of memory",
            Self::Bytes | Self::Elements | Self::Pixels => self.name(),
        }
    }

    /// The value for inputs of up to a mebibyte. All of the work usually takes a few seconds; the limit of seconds is more than ten times
    /// that, since slow or busy machines take longer.
    fn base(self) -> f64 {
        match self {
            Self::Bytes => 32e6,
            Self::Elements => 30e3,
            Self::Pixels => 256e6,
            Self::Work => 100e6,
            Self::Seconds => 130.0,
            Self::Memory => 450e6,
        }
    }

    /// The addition for each pixel of a picture, half of them the source's, half the result's: ten million of each add 80 million units of
    /// work, ten seconds, and 60 MB beyond the decoded picture.
    fn per_pixel(self) -> f64 {
        match self {
            Self::Work => 4.0,
            Self::Seconds => 0.5e-6,
            Self::Memory => 5.0,
            _ => 0.0,
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
/// let limits = Limits::default().with(Limit::Elements, 5e6).for_input(10 << 20);
/// assert_eq!(limits.of(Limit::Elements), 5e6);
/// assert_eq!(limits.of(Limit::Work), 10.0 * Limits::default().of(Limit::Work));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The limits that were set, in the order of [`Limit::ALL`].
    given: [Option<f64>; Limit::ALL.len()],
    /// The factor on the limits that are not given.
    scale: f64,
    /// The number of pixels of the input's pictures.
    pixels: f64,
    /// A switch that makes every limit exceeded.
    stop: Option<Stop>,
}

/// A switch that ends work early. It is static, as limits are copied to all code that counts work.
#[derive(Debug, Clone, Copy)]
struct Stop(&'static AtomicBool);

impl PartialEq for Stop {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self { given: [None; Limit::ALL.len()], scale: 1.0, pixels: 0.0, stop: None }
    }
}

impl Limits {
    /// No limits at all: for trusted input.
    #[must_use]
    pub fn none() -> Self {
        Self { given: [Some(f64::INFINITY); Limit::ALL.len()], ..Self::default() }
    }

    /// Sets a limit, whatever the size of the input.
    #[must_use]
    pub fn with(mut self, limit: Limit, most: f64) -> Self {
        self.given[limit as usize] = Some(most);
        self
    }

    /// Lets a switch end the work: once it is `true`, every limit is exceeded.
    #[must_use]
    pub fn stopped_by(self, switch: &'static AtomicBool) -> Self {
        Self { stop: Some(Stop(switch)), ..self }
    }

    fn is_stopped(&self) -> bool {
        self.stop.is_some_and(|s| s.0.load(Ordering::Relaxed))
    }

    /// The limits for an input of `bytes`: limits that were not set grow in proportion above a mebibyte. They never shrink.
    #[must_use]
    pub fn for_input(self, bytes: usize) -> Self {
        Self { scale: (bytes as f64 / BASE_SIZE).max(self.scale), ..self }
    }

    /// The limits for an input with further pictures of `pixels`, however they are compressed.
    #[must_use]
    pub fn for_pixels(self, pixels: f64) -> Self {
        Self { pixels: self.pixels + pixels, ..self }
    }

    /// The value of a limit. Where other limits are raised, time and memory grow in proportion, unless they are set themselves.
    #[must_use]
    pub fn of(&self, limit: Limit) -> f64 {
        let default = limit.base() * self.scale + limit.per_pixel() * self.pixels;
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

    /// Checks a size.
    ///
    /// # Errors
    /// [`Exceeded`] if the size exceeds the limit.
    pub fn check(&self, limit: Limit, amount: f64) -> Result<(), Exceeded> {
        let most = self.of(limit);
        // An amount that is not a number exceeds every limit.
        if amount <= most && !self.is_stopped() {
            Ok(())
        } else {
            Err(Exceeded { limit, most, needed: amount, cut: false })
        }
    }
}

/// More work than a limit allows.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{}{} {}, and the limit `{limit}` is {}", if *.cut { "at least " } else { "" }, rounded(*.needed), .limit.unit(), rounded(*.most))]
pub struct Exceeded {
    /// The limit that was exceeded.
    pub limit: Limit,
    /// The value of the limit.
    pub most: f64,
    /// The amount that is needed, or was counted when work stopped.
    pub needed: f64,
    /// `true` if the count was cut short at the limit.
    pub cut: bool,
}

impl Exceeded {
    /// Returns this error for a count that was cut short, so that the whole amount is not known.
    #[must_use]
    pub fn cut_short(self) -> Self {
        Self { cut: true, ..self }
    }

    /// A value of the limit that allows the amount, in two figures; ten times the limit if the amount is not known.
    #[must_use]
    pub fn enough(&self) -> f64 {
        if self.cut {
            return 10.0 * self.most.max(self.needed);
        }
        let unit = 10_f64.powf(self.needed.max(1.0).log10().floor() - 1.0);
        (self.needed / unit).ceil() * unit
    }
}

/// Formats a number in three figures from a million on, below with two decimals at most.
fn rounded(v: f64) -> String {
    if v < 1e6 { format!("{}", (v * 100.0).round() / 100.0) } else { format!("{v:.2e}") }
}

/// The largest amount added at once, so that sums stay in range.
const MAX_AMOUNT: f64 = (1_u64 << 52) as f64;

/// The limits of one input and how much of them is used, shared by all threads.
#[derive(Debug, Default)]
pub struct Budget {
    limits: Limits,
    /// Work in sixteenths of a unit: whole numbers, so that the sum does not depend on the order of threads.
    work: AtomicU64,
    /// Bytes, elements and pixels.
    sizes: [AtomicU64; 3],
}

impl Budget {
    /// An unused budget.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self { limits, ..Self::default() }
    }

    /// The limits, raised for the pictures so far.
    #[must_use]
    pub fn limits(&self) -> Limits {
        self.limits.for_pixels(self.taken(Limit::Pixels))
    }

    /// Counts work.
    ///
    /// # Errors
    /// [`Exceeded`] if the sum exceeds the limit.
    pub fn spend(&self, work: f64) -> Result<(), Exceeded> {
        let sixteenths = (16.0 * work).ceil().min(MAX_AMOUNT);
        let before = self.work.fetch_add(sixteenths as u64, Ordering::Relaxed) as f64;
        // The excess over the limit depends on the threads, so the error does not contain it.
        self.limits().check(Limit::Work, (before + sixteenths) / 16.0).map_err(|e| Exceeded {
            needed: e.most,
            cut: true,
            ..e
        })
    }

    /// The work that is left.
    #[must_use]
    pub fn left(&self) -> f64 {
        if self.limits.is_stopped() {
            return 0.0;
        }
        (self.limits().of(Limit::Work) - self.work.load(Ordering::Relaxed) as f64 / 16.0).max(0.0)
    }

    /// Returns the error if more work was counted than the limit allows.
    #[must_use]
    pub fn exceeded(&self) -> Option<Exceeded> {
        self.spend(0.0).err()
    }

    /// Adds to a size: bytes, elements or pixels.
    ///
    /// # Errors
    /// [`Exceeded`] if the sum exceeds the limit.
    pub fn take(&self, limit: Limit, amount: f64) -> Result<(), Exceeded> {
        let amount = amount.min(MAX_AMOUNT);
        let before = self.sizes.get(limit as usize).map_or(0, |n| n.fetch_add(amount as u64, Ordering::Relaxed));
        self.limits.check(limit, before as f64 + amount)
    }

    /// The amount of a size taken so far.
    #[must_use]
    pub fn taken(&self, limit: Limit) -> f64 {
        self.sizes.get(limit as usize).map_or(0.0, |n| n.load(Ordering::Relaxed) as f64)
    }

    /// The amount of a size that is left.
    #[must_use]
    pub fn room(&self, limit: Limit) -> f64 {
        (self.limits.of(limit) - self.taken(limit)).max(0.0)
    }

    /// Checks a size that is not added up.
    ///
    /// # Errors
    /// [`Exceeded`] if the size exceeds the limit.
    pub fn check(&self, limit: Limit, amount: f64) -> Result<(), Exceeded> {
        self.limits().check(limit, amount)
    }
}

/// Budgets are equal if their limits are.
impl PartialEq for Budget {
    fn eq(&self, other: &Self) -> bool {
        self.limits == other.limits
    }
}

/// The work of a jet of a map of work 1, with the step of Newton's method around it.
const JET_WORK: f64 = 0.4;
/// The work of looking at a starting point.
const START_WORK: f64 = 0.01;
/// The number of jets that usually find a preimage; the work of an inverse includes them.
const USUAL_JETS: usize = 12;

/// The work of a search so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct Search {
    /// The number of jets of the inverted map.
    pub jets: usize,
    /// The number of starting points that were looked at.
    pub starts: usize,
}

impl Search {
    /// Adds another search for the same point.
    pub fn add(&mut self, other: Self) {
        self.jets += other.jets;
        self.starts += other.starts;
    }

    /// Charges the work beyond the usual work of `points` points, which callers charge. `work` is the work of a jet.
    pub fn spend(self, budget: Option<&Arc<Budget>>, points: usize, work: f64) {
        let jets = self.jets.saturating_sub(USUAL_JETS * points);
        let beyond = JET_WORK * work * jets as f64 + START_WORK * self.starts as f64;
        if let Some(budget) = budget.filter(|_| beyond >= 1.0) {
            // An exceeded budget ends the next search.
            let _ = budget.spend(beyond);
        }
    }
}

/// Returns `true` once a budget is used up: inverses within it are then undefined everywhere.
#[must_use]
#[doc(hidden)]
pub fn is_over(budget: Option<&Arc<Budget>>) -> bool {
    budget.is_some_and(|b| b.left() <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_add_up_and_the_error_names_the_limit() {
        let budget = Budget::new(Limits::default().with(Limit::Elements, 10.0).with(Limit::Work, 3.0));
        assert!(budget.take(Limit::Elements, 6.0).is_ok() && budget.take(Limit::Elements, 4.0).is_ok());
        assert_eq!(budget.room(Limit::Elements), 0.0);
        let e = budget.take(Limit::Elements, 1.0).unwrap_err();
        assert_eq!((e.limit, e.most, e.needed, e.enough()), (Limit::Elements, 10.0, 11.0, 11.0));
        assert_eq!(e.to_string(), "11 elements, and the limit `elements` is 10");
        assert!(budget.check(Limit::Pixels, f64::NAN).is_err());
        assert!(budget.spend(1.5).is_ok() && budget.spend(1.5).is_ok() && budget.exceeded().is_none());
        let e = budget.spend(0.001).unwrap_err();
        assert_eq!((e.limit, e.enough(), budget.left()), (Limit::Work, 30.0, 0.0));
        assert_eq!(budget.exceeded(), Some(e));
    }

    #[test]
    fn limits_grow_with_the_input_unless_they_are_given() {
        let limits = Limits::default().with(Limit::Bytes, 5.0).for_input(3 << 20);
        assert_eq!(limits.of(Limit::Bytes), 5.0);
        assert_eq!(limits.of(Limit::Elements), 3.0 * Limits::default().of(Limit::Elements));
        assert_eq!(Limits::default().for_input(7), Limits::default());
        let raised = Limits::default().with(Limit::Work, 2.0 * Limit::Work.base());
        assert_eq!(raised.of(Limit::Memory), 2.0 * Limit::Memory.base());
    }

    #[test]
    fn a_switch_ends_the_work() {
        static SWITCH: AtomicBool = AtomicBool::new(false);
        let budget = Budget::new(Limits::none().stopped_by(&SWITCH).for_input(9));
        assert!(budget.spend(1.0).is_ok() && budget.left() > 0.0 && budget.take(Limit::Bytes, 1.0).is_ok());
        SWITCH.store(true, Ordering::Relaxed);
        assert!(budget.exceeded().is_some() && budget.left() == 0.0 && budget.take(Limit::Bytes, 1.0).is_err());
    }

    /// Ten seconds and 60 MB beyond the decoded picture for each ten megapixels.
    #[test]
    fn limits_grow_with_the_pixels() {
        let budget = Budget::default();
        budget.take(Limit::Pixels, 200e6).unwrap();
        let more = |limit| budget.limits().of(limit) - Limits::default().of(limit);
        assert_eq!((more(Limit::Seconds).round(), more(Limit::Memory)), (100.0, 1e9));
        assert!(budget.take(Limit::Pixels, 100e6).is_err());
    }

    #[test]
    fn names_are_found_again() {
        assert!(Limit::ALL.into_iter().all(|l| Limit::named(l.name()) == Some(l)));
        // The order equals the order of declaration, by which limits are stored.
        assert!(Limit::ALL.into_iter().enumerate().all(|(i, l)| l as usize == i));
    }
}
