//! Copies of the artwork along a skeleton.

use crate::error::Error;

/// Copies of the artwork side by side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Repeats {
    pub(super) count: usize,
    /// Distance from one to the next.
    pub(super) spacing: f64,
}

impl Repeats {
    pub(super) const ONE: Self = Self { count: 1, spacing: 0.0 };

    /// Returns as many copies of `width` as fit on `length` with at least `gap` between them, spread evenly: on an open skeleton
    /// from its start to its end, on a closed one all the way around.
    pub(super) fn new(width: f64, gap: f64, length: f64, closed: bool) -> Result<Self, Error> {
        /// More copies on one skeleton are a slip of the unit.
        const MAX: f64 = 10_000.0;
        let period = width + gap;
        if period <= 0.0 {
            return Err(Error::usage(
                "gap",
                gap.to_string(),
                format!("is so negative that copies of artwork {width:.6} wide would not advance"),
            ));
        }
        // Rounding must not exclude a copy that just fits.
        let room = ((if closed { length } else { length + gap }) / period * (1.0 + 1e-9)).floor().max(1.0);
        if room > MAX {
            let problem = format!("would take {room} copies of artwork {width:.6} wide; the limit is {MAX}");
            return Err(Error::usage("stretch", "repeat", problem));
        }
        let spacing = match (closed, room > 1.0) {
            (true, _) => length / room,
            (false, true) => (length - width) / (room - 1.0),
            (false, false) => 0.0,
        };
        Ok(Self { count: room as usize, spacing })
    }
}
