//! Every pointer in a file below version 18: what must be mended when the property list changes its length.
//!
//! Tables of layers and channels; each layer leads to a hierarchy and a mask, each channel and mask to a hierarchy, each
//! hierarchy to levels, each level to tiles. One property of layers points as well: a floating selection's, to the layer or
//! channel that it belongs to.

use super::{MOST_PROPERTIES, PROP_END, Xcf};
use crate::error::Error;
use crate::input::Input;
use std::collections::BTreeMap;

/// Where pointers stand, and where they lead.
pub(super) type Pointers = BTreeMap<u64, u64>;

/// Its whole content is a pointer.
const PROP_FLOATING_SELECTION: u32 = 5;
/// As many tiles as 64 GiB of 8-bit RGBA have.
const MOST_POINTERS: u64 = 1 << 22;

/// What a pointer leads to.
#[derive(Clone, Copy)]
enum To {
    Layer,
    Channel,
    Hierarchy,
    Level,
}

struct Walk<'i, 'a> {
    input: &'i mut Input<'a>,
    wide: bool,
    found: Pointers,
    /// How many more there can be.
    left: u64,
    /// Where the first thing that is pointed to can stand.
    first: u64,
    /// What is still to be followed; each place once.
    open: Vec<(u64, To)>,
    followed: std::collections::HashSet<u64>,
}

/// All pointers of the file; `xcf` has been read from the same one.
pub(super) fn all(input: &mut Input<'_>, xcf: &Xcf) -> Result<Pointers, Error> {
    input.go(xcf.properties_end, "the property list")?;
    let input_end = input.end;
    let mut walk = Walk {
        wide: xcf.wide(),
        input,
        found: Pointers::new(),
        left: (input_end / if xcf.wide() { 8 } else { 4 }).min(MOST_POINTERS),
        first: xcf.properties_end,
        open: Vec::new(),
        followed: std::collections::HashSet::new(),
    };
    walk.table(Some(To::Layer))?;
    walk.table(Some(To::Channel))?;
    while let Some((at, what)) = walk.open.pop() {
        if !walk.followed.insert(at) {
            continue;
        }
        walk.input.go(at, "a pointer")?;
        match what {
            To::Layer => {
                walk.input.skip(12, "a layer")?;
                walk.name_and_properties()?;
                walk.pointer(Some(To::Hierarchy))?;
                walk.pointer(Some(To::Channel))?;
            }
            To::Channel => {
                walk.input.skip(8, "a channel")?;
                walk.name_and_properties()?;
                walk.pointer(Some(To::Hierarchy))?;
            }
            To::Hierarchy => {
                walk.input.skip(12, "a hierarchy")?;
                // Only the first level is read by any GIMP. Those behind it are empty since the days of 64-bit pointers,
                // and GIMP ends their tables with a word of 32 bits.
                if walk.pointer(Some(To::Level))? {
                    walk.table((!walk.wide).then_some(To::Level))?;
                }
            }
            To::Level => {
                walk.input.skip(8, "a level")?;
                walk.table(None)?;
            }
        }
    }
    Ok(walk.found)
}

impl Walk<'_, '_> {
    fn table(&mut self, to: Option<To>) -> Result<(), Error> {
        while self.pointer(to)? {}
        Ok(())
    }

    /// Notes a pointer; whether there was one.
    fn pointer(&mut self, to: Option<To>) -> Result<bool, Error> {
        let at = self.input.at();
        let what = "a table of pointers";
        let target = if self.wide { self.input.u64(what)? } else { u64::from(self.input.u32(what)?) };
        if target == 0 {
            return Ok(false);
        }
        if target >= self.input.end {
            let end = self.input.end;
            return Err(Error::at(at, format!("a pointer leads to byte {target}, outside the file of {end}")));
        }
        if target < self.first {
            return Err(Error::at(at, format!("a pointer leads to byte {target}, into the file's head")));
        }
        self.left =
            self.left.checked_sub(1).ok_or_else(|| Error::at(at, "the tables of pointers overlap, or have no end"))?;
        self.found.insert(at, target);
        self.open.extend(to.map(|to| (target, to)));
        Ok(true)
    }

    fn name_and_properties(&mut self) -> Result<(), Error> {
        let name = u64::from(self.input.u32("a name")?);
        self.input.skip(name, "a name")?;
        for _ in 0..MOST_PROPERTIES {
            let kind = self.input.u32("a layer's properties")?;
            let length = u64::from(self.input.u32("a layer's properties")?);
            if kind == PROP_END {
                return Ok(());
            }
            let end = self.input.at() + length;
            if kind == PROP_FLOATING_SELECTION && length == if self.wide { 8 } else { 4 } {
                self.pointer(None)?;
            }
            self.input.skip(end - self.input.at(), "a layer's property")?;
        }
        Err(Error::at(self.input.at(), "a layer's property list has no end"))
    }
}
