//! All pointers in a file before version 18. They must be adjusted when the length of the property list changes.
//!
//! Tables point to layers and channels; each layer points to a hierarchy and a mask, each channel and mask to a hierarchy, each
//! hierarchy to levels, each level to tiles. The property of a floating selection points to the layer or channel that it
//! belongs to.

use super::model::{PROP_END, Xcf};
use crate::error::Error;
use crate::source::ByteSource;
use std::collections::{BTreeMap, HashSet};

/// The targets of pointers by their places.
pub(super) type Pointers = BTreeMap<u64, u64>;

/// A property whose whole content is a pointer.
const PROP_FLOATING_SELECTION: u32 = 5;
/// Size of a property without content.
const LEAST_PROPERTY: u64 = 8;

/// The type of structure that a pointer points to.
#[derive(Clone, Copy)]
enum PointerTarget {
    Layer,
    Channel,
    Hierarchy,
    Level,
}

/// A traversal of the pointers.
struct PointerWalk<'i, 'a> {
    input: &'i mut ByteSource<'a>,
    wide: bool,
    found: Pointers,
    /// Maximum number of further pointers, and of properties: structures that do not overlap fit into the file.
    left: u64,
    properties_left: u64,
    /// Lowest valid target.
    first: u64,
    /// Structures still to be visited.
    pending: Vec<(u64, PointerTarget)>,
    visited: HashSet<u64>,
}

/// Collects all pointers of the file that `xcf` was read from.
pub(super) fn all(input: &mut ByteSource<'_>, xcf: &Xcf) -> Result<Pointers, Error> {
    input.seek(xcf.properties_end, "the property list")?;
    let input_end = input.end;
    let mut walk = PointerWalk {
        wide: xcf.wide(),
        input,
        found: Pointers::new(),
        left: input_end / if xcf.wide() { 8 } else { 4 },
        properties_left: input_end / LEAST_PROPERTY,
        first: xcf.properties_end,
        pending: Vec::new(),
        visited: HashSet::new(),
    };
    walk.table(Some(PointerTarget::Layer))?;
    walk.table(Some(PointerTarget::Channel))?;
    while let Some((at, target)) = walk.pending.pop() {
        if !walk.visited.insert(at) {
            continue;
        }
        walk.input.seek(at, "a pointer")?;
        match target {
            PointerTarget::Layer => {
                walk.input.skip(12, "a layer")?;
                walk.name_and_properties()?;
                walk.pointer(Some(PointerTarget::Hierarchy))?;
                walk.pointer(Some(PointerTarget::Channel))?;
            }
            PointerTarget::Channel => {
                walk.input.skip(8, "a channel")?;
                walk.name_and_properties()?;
                walk.pointer(Some(PointerTarget::Hierarchy))?;
            }
            PointerTarget::Hierarchy => {
                walk.input.skip(12, "a hierarchy")?;
                // GIMP reads only the first level. With 64-bit pointers the others are empty, and GIMP ends their table with a
                // word of 32 bits.
                if walk.pointer(Some(PointerTarget::Level))? {
                    walk.table((!walk.wide).then_some(PointerTarget::Level))?;
                }
            }
            PointerTarget::Level => {
                walk.input.skip(8, "a level")?;
                walk.table(None)?;
            }
        }
    }
    Ok(walk.found)
}

impl PointerWalk<'_, '_> {
    fn table(&mut self, to: Option<PointerTarget>) -> Result<(), Error> {
        while self.pointer(to)? {}
        Ok(())
    }

    /// Records a pointer; returns `false` if it is the zero that ends a table.
    fn pointer(&mut self, to: Option<PointerTarget>) -> Result<bool, Error> {
        let at = self.input.at();
        let what = "a table of pointers";
        let target = if self.wide { self.input.u64(what)? } else { u64::from(self.input.u32(what)?) };
        if target == 0 {
            return Ok(false);
        }
        if target >= self.input.end {
            let end = self.input.end;
            return Err(Error::damaged(
                at,
                format!("a pointer points to byte {target}, outside the file of {end} bytes"),
            ));
        }
        if target < self.first {
            return Err(Error::damaged(at, format!("a pointer points to byte {target}, inside the file's head")));
        }
        self.left = self
            .left
            .checked_sub(1)
            .ok_or_else(|| Error::damaged(at, "the tables of pointers overlap or have no end"))?;
        self.found.insert(at, target);
        self.pending.extend(to.map(|to| (target, to)));
        Ok(true)
    }

    fn name_and_properties(&mut self) -> Result<(), Error> {
        let name = u64::from(self.input.u32("a name")?);
        self.input.skip(name, "a name")?;
        loop {
            let at = self.input.at();
            self.properties_left = self
                .properties_left
                .checked_sub(1)
                .ok_or_else(|| Error::damaged(at, "the lists of properties overlap or have no end"))?;
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
    }
}
