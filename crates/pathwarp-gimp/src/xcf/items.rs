//! Paths as items (version 18 on, GIMP 3): each behind a pointer, with a property list of its own.

use super::{Layout, MOST_PROPERTIES, PROP_END, Record, Xcf, count, string, vectors};
use crate::error::Error;
use crate::input::Input;
use crate::path::GimpPath;
use std::collections::HashMap;

const PROP_VISIBLE: u32 = 8;
/// A stroke without points.
const LEAST_STROKE: u64 = 16;
/// More layers, channels or paths than any image has.
const MOST_POINTERS: u64 = 1 << 20;

/// Reads the pointers after the property list, and the paths that the third table leads to.
pub(super) fn read(input: &mut Input<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    table(input, xcf, "layer")?;
    table(input, xcf, "channel")?;
    let pointers = table(input, xcf, "path")?;
    let tables_end = input.at();
    // In the file's order, so that packed data is run through once; listed in the table's.
    let mut order: Vec<usize> = (0..pointers.len()).collect();
    order.sort_by_key(|&i| pointers[i].1);
    let mut found: HashMap<usize, Record> = HashMap::new();
    let mut fault = None;
    let mut free = tables_end;
    for &i in &order {
        let (pointer_at, to) = pointers[i];
        let one = if to < free {
            let what = if to < tables_end { "the file's head" } else { "another path" };
            Err(Error::at(pointer_at, format!("a path pointer leads to byte {to}, into {what}")))
        } else {
            input
                .go(to, "a path pointer")
                .map_err(|e| Error { offset: pointer_at, ..e })
                .and_then(|()| item(input, pointer_at))
        };
        match one {
            Ok(record) => {
                free = record.span.end;
                found.insert(i, record);
            }
            Err(e) => {
                fault = Some(e);
                break;
            }
        }
    }
    xcf.records.extend((0..pointers.len()).filter_map(|i| found.remove(&i)));
    fault.map_or(Ok(()), Err)
}

/// A table of pointers up to its zero: where each stands and where it leads.
fn table(input: &mut Input<'_>, xcf: &Xcf, of: &str) -> Result<Vec<(u64, u64)>, Error> {
    let mut out = Vec::new();
    loop {
        let at = input.at();
        let what = format!("the table of {of} pointers has no end");
        let to = if xcf.wide() { input.u64(&what)? } else { u64::from(input.u32(&what)?) };
        if to == 0 {
            return Ok(out);
        }
        if to >= input.end {
            return Err(Error::at(at, format!("a {of} pointer leads to byte {to}, outside the file of {}", input.end)));
        }
        out.push((at, to));
        if out.len() as u64 > MOST_POINTERS {
            return Err(Error::at(at, format!("more than {MOST_POINTERS} {of} pointers: their table has no end")));
        }
    }
}

fn item(input: &mut Input<'_>, pointer_at: u64) -> Result<Record, Error> {
    let start = input.at();
    let name = string(input, "a path's name")?;
    let size_at = input.at();
    let size = u64::from(input.u32("a path")?);
    if size > input.left() {
        return Err(Error::short(size_at, &format!("a path is said to have {size} bytes"), input.left()));
    }
    let end = input.at() + size;
    let file_end = std::mem::replace(&mut input.end, end);
    let read = content(input);
    input.end = file_end;
    let (visible, count_at, strokes) =
        read.map_err(|e| if end < file_end { e.within(size, &format!("the path `{name}`")) } else { e })?;
    if input.at() != end {
        let (found, name) = (input.at() - size_at - 4, &name);
        let problem = format!("the path `{name}` has {found} bytes, but its size word says {size}");
        return Err(Error::at(size_at, problem));
    }
    let layout = Layout::Item { pointer_at, size_at, count_at };
    Ok(Record { path: GimpPath { name, visible, strokes }, span: start..end, layout })
}

fn content(input: &mut Input<'_>) -> Result<(bool, u64, Vec<crate::Stroke>), Error> {
    let mut visible = false;
    for _ in 0..MOST_PROPERTIES {
        let kind = input.u32("a path's properties")?;
        let length = u64::from(input.u32("a path's properties")?);
        match (kind, length) {
            (PROP_END, _) => {
                vectors::version(input)?;
                let count_at = input.at();
                let n = count(input, LEAST_STROKE, "strokes of a path")?;
                return Ok((visible, count_at, vectors::strokes(input, n)?));
            }
            (PROP_VISIBLE, 4) => visible = input.u32("a path's properties")? != 0,
            _ => input.skip(length, &format!("property {kind} of a path"))?,
        }
    }
    Err(Error::at(input.at(), "a path's property list has no end"))
}
