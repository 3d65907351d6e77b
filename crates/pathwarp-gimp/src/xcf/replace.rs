//! An XCF with other strokes in some of its paths: the path data replaced, pointers mended, every other byte kept.

use super::{Block, Layout, PATH_ITEMS, PROP_PATHS, Record, Xcf, old_paths, pointers, vectors};
use crate::error::Error;
use crate::input::{Input, ReadSeek};
use crate::path::Stroke;
use std::io::{Read, Seek, SeekFrom, Write};
use std::ops::Range;

/// Bytes that take the place of others.
struct Edit {
    span: Range<u64>,
    bytes: Vec<u8>,
}

/// Copies the XCF in `from` to `to` with other strokes for the paths named by their place in [`crate::File::paths`]. Names,
/// flags, tattoos and parasites of the paths stay; coordinates are rounded to the single precision that XCF has.
///
/// # Errors
/// The file is damaged, packed or not an XCF; the new strokes do not fit the form in which the file keeps its paths; or reading
/// or writing fails.
pub fn rewrite<R: Read + Seek>(mut from: R, to: &mut dyn Write, strokes: &[(usize, Vec<Stroke>)]) -> Result<(), Error> {
    let (edits, end) = {
        let from: &mut dyn ReadSeek = &mut from;
        let mut input = Input::file(from)?;
        if !input.peek(super::MAGIC.len())?.starts_with(super::MAGIC) {
            return Err(Error::at(0, "this is no plain XCF file; only such a one can be written back to"));
        }
        let mut xcf = Xcf::new();
        super::read(&mut input, &mut xcf)?;
        (edits(&mut input, &xcf, strokes)?, input.end)
    };
    copy(&mut from, to, &edits, end)
}

fn edits(input: &mut Input<'_>, xcf: &Xcf, strokes: &[(usize, Vec<Stroke>)]) -> Result<Vec<Edit>, Error> {
    let mut edits = Vec::new();
    let mut appended = Edit { span: input.end..input.end, bytes: Vec::new() };
    for (i, new) in strokes {
        let Some(record) = xcf.records.get(*i) else {
            return Err(Error::at(0, format!("there is no path number {i} in the file")));
        };
        // What is as it was keeps its bytes, also in forms that are not written any more.
        if record.path.strokes == *new {
            continue;
        }
        match record.layout {
            Layout::Old { state_at, tattoo } => {
                if !old_paths::holds(new) {
                    let problem =
                        "the old form of paths in this file can hold an open stroke only as the last of a path";
                    return Err(Error::at(record.span.start, problem));
                }
                edits.push(Edit { span: state_at..record.span.end, bytes: old_paths::encode(new, tattoo) });
            }
            Layout::Vectors { count_at, strokes_at } => {
                edits.push(Edit { span: count_at..count_at + 4, bytes: word(new.len()) });
                edits.push(Edit { span: strokes_at..record.span.end, bytes: vectors::encode(new) });
            }
            Layout::Item { pointer_at, size_at, count_at } => {
                let strokes = vectors::encode(new);
                let before = count_at + 4 - size_at - 4;
                let size = before + strokes.len() as u64;
                let same = record.span.end - size_at - 4 >= size;
                if same {
                    edits.push(Edit { span: size_at..size_at + 4, bytes: word(size as usize) });
                    edits.push(Edit { span: count_at..count_at + 4, bytes: word(new.len()) });
                    let end = count_at + 4 + strokes.len() as u64;
                    edits.push(Edit { span: count_at + 4..end, bytes: strokes });
                } else {
                    // It has outgrown its place and moves to the end of the file.
                    let at = input.end + appended.bytes.len() as u64;
                    edits.push(Edit { span: pointer_at..pointer_at + 8, bytes: at.to_be_bytes().to_vec() });
                    input.go(record.span.start, "a path")?;
                    let mut head = input.vec(count_at - record.span.start, "a path")?;
                    let size_in_head = (size_at - record.span.start) as usize;
                    head.splice(size_in_head..size_in_head + 4, word(size as usize));
                    appended.bytes.extend(head);
                    appended.bytes.extend(word(new.len()));
                    appended.bytes.extend(strokes);
                }
            }
        }
    }
    lengths(xcf, &mut edits);
    edits.push(appended);
    edits.retain(|e| !e.span.is_empty() || !e.bytes.is_empty());
    edits.sort_by_key(|e| e.span.start);
    if let Some(w) = edits.windows(2).find(|w| w[1].span.start < w[0].span.end) {
        return Err(Error::at(w[1].span.start, "a path is given twice"));
    }
    moved(input, xcf, edits)
}

fn word(n: usize) -> Vec<u8> {
    u32::try_from(n).unwrap_or(u32::MAX).to_be_bytes().to_vec()
}

/// By how much the edits before `place` lengthen the file.
fn shift(edits: &[Edit], place: u64) -> i64 {
    let before = edits.iter().filter(|e| e.span.end <= place);
    before.map(|e| e.bytes.len() as i64 - (e.span.end - e.span.start) as i64).sum()
}

/// New length words for the properties that have changed.
fn lengths(xcf: &Xcf, edits: &mut Vec<Edit>) {
    for Block { span, property } in &xcf.blocks {
        let grown = shift(edits, span.end) - shift(edits, span.start);
        let changed = xcf.records.iter().any(|Record { span: r, .. }| {
            r.start >= span.start && r.end <= span.end && edits.iter().any(|e| r.contains(&e.span.start))
        });
        // An old length word may have been wrong; it is mended only with the block.
        if grown != 0 || (changed && *property != PROP_PATHS) {
            let content = (span.end - span.start) as i64 - 8 + grown;
            let bytes = word(usize::try_from(content).unwrap_or(usize::MAX));
            edits.push(Edit { span: span.start + 4..span.start + 8, bytes });
        }
    }
}

/// The edits with those for the pointers to what they move.
fn moved(input: &mut Input<'_>, xcf: &Xcf, mut edits: Vec<Edit>) -> Result<Vec<Edit>, Error> {
    let in_properties = |e: &Edit| e.span.start < xcf.properties_end;
    let resized = edits.iter().filter(|e| in_properties(e)).any(|e| e.bytes.len() as u64 != e.span.end - e.span.start);
    if !resized {
        return Ok(edits);
    }
    if xcf.version >= PATH_ITEMS {
        let problem =
            format!("a file of version {} keeps paths as items; this old block in it cannot be resized", xcf.version);
        return Err(Error::at(0, problem));
    }
    // All that pointers lead to lies behind the property list, and moves by the same.
    let by = shift(&edits, xcf.properties_end);
    let mut mended = Vec::new();
    for (at, target) in pointers::all(input, xcf)? {
        let new = target.saturating_add_signed(by);
        let bytes = if xcf.wide() {
            new.to_be_bytes().to_vec()
        } else {
            let new = u32::try_from(new);
            new.map_err(|_| Error::at(at, "the file would outgrow its 32-bit pointers"))?.to_be_bytes().to_vec()
        };
        mended.push(Edit { span: at..at + bytes.len() as u64, bytes });
    }
    edits.extend(mended);
    edits.sort_by_key(|e| e.span.start);
    if let Some(w) = edits.windows(2).find(|w| w[1].span.start < w[0].span.end) {
        return Err(Error::at(w[1].span.start, "pointers overlap: the file is damaged beyond its paths"));
    }
    Ok(edits)
}

fn copy(from: &mut (impl Read + Seek), to: &mut dyn Write, edits: &[Edit], end: u64) -> Result<(), Error> {
    let mut at = 0;
    let failed = |at: u64| move |e: std::io::Error| Error::at(at, format!("cannot be copied: {e}"));
    from.seek(SeekFrom::Start(0)).map_err(failed(0))?;
    for e in edits {
        std::io::copy(&mut from.by_ref().take(e.span.start - at), to).map_err(failed(at))?;
        to.write_all(&e.bytes).map_err(failed(e.span.start))?;
        from.seek(SeekFrom::Start(e.span.end)).map_err(failed(e.span.end))?;
        at = e.span.end;
    }
    std::io::copy(&mut from.by_ref().take(end - at), to).map_err(failed(at))?;
    Ok(())
}
