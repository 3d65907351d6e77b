//! Reads paths that are items (version 18 and later, GIMP 3), each behind a pointer and with a property list.

use super::model::{MAX_PROPERTIES, PROP_END, PathLayout, PathRecord, Xcf};
use super::primitives::{count, string};
use super::vectors;
use crate::error::Error;
use crate::path::GimpPath;
use crate::source::ByteSource;

const PROP_VISIBLE: u32 = 8;

/// Reads the tables of pointers after the property list, and the paths of the third table.
pub(super) fn read(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    table(input, xcf, "layer")?;
    table(input, xcf, "channel")?;
    let pointers = table(input, xcf, "path")?;
    let tables_end = input.offset();
    // Read in the order of the file, so that compressed data is unpacked once; list in the order of the table.
    let mut order: Vec<usize> = (0..pointers.len()).collect();
    order.sort_by_key(|&i| pointers[i].1);
    let mut records: Vec<Option<PathRecord>> = pointers.iter().map(|_| None).collect();
    let mut used_end = tables_end;
    let read_all = || {
        for i in order {
            let (pointer_at, to) = pointers[i];
            if to < used_end {
                let part = if to < tables_end { "the file's head" } else { "another path" };
                let problem = format!("a path pointer points to byte {to}, inside {part}");
                return Err(Error::damaged(pointer_at, problem));
            }
            input.seek(to, "a path pointer").map_err(|e| Error { offset: pointer_at, ..e })?;
            let record = item(input, pointer_at)?;
            used_end = record.span.end;
            records[i] = Some(record);
        }
        Ok(())
    };
    let result = read_all();
    xcf.records.extend(records.into_iter().flatten());
    result
}

/// Reads a table of pointers up to its zero. Returns the offset and the target of each.
fn table(input: &mut ByteSource<'_>, xcf: &Xcf, kind: &str) -> Result<Vec<(u64, u64)>, Error> {
    let mut out = Vec::new();
    loop {
        let at = input.offset();
        let what = format!("the table of {kind} pointers");
        let to = if xcf.wide() { input.u64(&what)? } else { u64::from(input.u32(&what)?) };
        if to == 0 {
            return Ok(out);
        }
        if to >= input.end {
            let problem = format!("a {kind} pointer points to byte {to}, outside the file of {} bytes", input.end);
            return Err(input.beyond(to, Error::damaged(at, problem)));
        }
        out.push((at, to));
    }
}

/// Reads one item.
fn item(input: &mut ByteSource<'_>, pointer_at: u64) -> Result<PathRecord, Error> {
    let start = input.offset();
    let name = string(input, "a path's name")?;
    let size_at = input.offset();
    let size = u64::from(input.u32("a path")?);
    input.need(size, size_at, || format!("a path needs {size} bytes"))?;
    let end = input.offset() + size;
    let (visible, count_at, strokes) = input.limited(size, &format!("the path `{name}`"), content)?;
    if input.offset() != end {
        let (found, name) = (input.offset() - size_at - 4, &name);
        let problem = format!("the path `{name}` takes {found} bytes, but its size word says {size}");
        return Err(Error::damaged(size_at, problem));
    }
    let layout = PathLayout::Item { pointer_at, size_at, count_at };
    Ok(PathRecord { path: GimpPath { name, visible, strokes }, span: start..end, layout })
}

/// Reads the content of an item. Returns its visibility, the offset of its number of strokes, and its strokes.
fn content(input: &mut ByteSource<'_>) -> Result<(bool, u64, Vec<crate::Stroke>), Error> {
    let mut visible = false;
    for _ in 0..MAX_PROPERTIES {
        let kind = input.u32("a path's properties")?;
        let length = u64::from(input.u32("a path's properties")?);
        match (kind, length) {
            (PROP_END, _) => {
                vectors::version(input)?;
                let count_at = input.offset();
                let n = count(input, vectors::MIN_STROKE, "strokes of a path")?;
                return Ok((visible, count_at, vectors::strokes(input, n)?));
            }
            (PROP_VISIBLE, 4) => visible = input.u32("a path's properties")? != 0,
            _ => input.skip(length, &format!("property {kind} of a path"))?,
        }
    }
    Err(Error::damaged(input.offset(), "a path's property list has no end"))
}
