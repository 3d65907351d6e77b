//! Replaces strokes in an XCF, adjusting its pointers and keeping every other byte, or makes a new file.

use crate::error::{Error, ErrorKind};
use crate::old_strokes;
use crate::path::{GimpPath, Stroke};
use crate::source::{ByteSource, ReadSeek};
use crate::xcf::model::{MAGIC, PATH_ITEMS, PROP_END, PROP_VECTORS, PathBlock, PathLayout, Xcf};
use crate::xcf::primitives::push_words;
use crate::xcf::{old_paths, read::read, vectors};
use pathwarp::budget::Limits;
use std::collections::{BTreeMap, HashSet};
use std::io::{Read, Seek, SeekFrom, Write};
use std::ops::Range;

/// A replacement of bytes.
struct ByteEdit {
    span: Range<u64>,
    bytes: Vec<u8>,
}

/// Copies the XCF in `from` to `to`, replacing the strokes of the paths given by their index in [`crate::PathFile::paths`]. Names,
/// flags, tattoos and parasites of the paths are kept. Coordinates are rounded to the single precision of XCF.
///
/// # Errors
/// [`ErrorKind::Unsupported`] when the file is compressed or not an XCF, [`ErrorKind::Damaged`] and [`ErrorKind::Truncated`] when it is
/// damaged, [`ErrorKind::Strokes`] when the form of its paths cannot hold the new strokes, [`ErrorKind::Io`].
pub fn rewrite<R: Read + Seek>(mut from: R, to: &mut dyn Write, strokes: &[(usize, Vec<Stroke>)]) -> Result<(), Error> {
    let (edits, end) = {
        let from: &mut dyn ReadSeek = &mut from;
        let mut input = ByteSource::file(from, Limits::none())?;
        if !input.peek(MAGIC.len())?.starts_with(MAGIC) {
            return Err(Error::unsupported(0, "not an uncompressed XCF file; paths can be written to no other kind"));
        }
        let mut xcf = Xcf::default();
        read(&mut input, &mut xcf)?;
        (edits(&mut input, &xcf, strokes)?, input.end)
    };
    copy(&mut from, to, &edits, end)
}

fn edits(input: &mut ByteSource<'_>, xcf: &Xcf, strokes: &[(usize, Vec<Stroke>)]) -> Result<Vec<ByteEdit>, Error> {
    let mut edits = Vec::new();
    let mut appended = ByteEdit { span: input.end..input.end, bytes: Vec::new() };
    for (i, new) in strokes {
        let Some(record) = xcf.records.get(*i) else {
            return Err(Error::new(ErrorKind::Strokes, 0, format!("the file has no path number {i}")));
        };
        // Unchanged strokes keep their bytes, even in forms that are no longer written.
        if record.path.strokes == *new {
            continue;
        }
        match record.layout {
            PathLayout::Old { state_at, tattoo } => {
                if !old_strokes::can_hold(new) {
                    let problem =
                        "this file stores paths in the form of GIMP 1, in which only the last stroke may be open";
                    return Err(Error::new(ErrorKind::Strokes, record.span.start, problem));
                }
                edits.push(ByteEdit { span: state_at..record.span.end, bytes: old_paths::encode(new, tattoo) });
            }
            PathLayout::Vectors { count_at, strokes_at } => {
                edits.push(ByteEdit { span: count_at..count_at + 4, bytes: word(new.len()) });
                edits.push(ByteEdit { span: strokes_at..record.span.end, bytes: vectors::encode(new) });
            }
            PathLayout::Item { pointer_at, size_at, count_at } => {
                let strokes = vectors::encode(new);
                // The size counts from behind its word, and the strokes begin behind their number's word.
                let size = (count_at - size_at) + strokes.len() as u64;
                let fits = record.span.end - size_at - 4 >= size;
                if fits {
                    edits.push(ByteEdit { span: size_at..size_at + 4, bytes: word(size as usize) });
                    edits.push(ByteEdit { span: count_at..count_at + 4, bytes: word(new.len()) });
                    let end = count_at + 4 + strokes.len() as u64;
                    edits.push(ByteEdit { span: count_at + 4..end, bytes: strokes });
                } else {
                    // The path no longer fits; move it to the end of the file.
                    let at = input.end + appended.bytes.len() as u64;
                    edits.push(ByteEdit { span: pointer_at..pointer_at + 8, bytes: at.to_be_bytes().to_vec() });
                    input.seek(record.span.start, "a path")?;
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
    update_lengths(xcf, &mut edits);
    edits.push(appended);
    edits.retain(|e| !e.span.is_empty() || !e.bytes.is_empty());
    edits.sort_by_key(|e| e.span.start);
    if let Some(w) = edits.windows(2).find(|w| w[1].span.start < w[0].span.end) {
        return Err(Error::new(ErrorKind::Strokes, w[1].span.start, "a path is given twice"));
    }
    with_pointers(input, xcf, edits)
}

/// A length or count as a big-endian word. It describes paths, which take far less than four gigabytes.
fn word(n: usize) -> Vec<u8> {
    (n as u32).to_be_bytes().to_vec()
}

/// Returns the growth of the file by the edits before `offset`, in bytes.
fn growth(edits: &[ByteEdit], offset: u64) -> i64 {
    let before = edits.iter().filter(|e| e.span.end <= offset);
    before.map(|e| e.bytes.len() as i64 - (e.span.end - e.span.start) as i64).sum()
}

/// Adds edits for the length words of changed properties.
fn update_lengths(xcf: &Xcf, edits: &mut Vec<ByteEdit>) {
    for PathBlock { span } in &xcf.blocks {
        let grown = growth(edits, span.end) - growth(edits, span.start);
        // The length word of `PROP_PATHS` may have been wrong before; correct it only if the block changes its size.
        if grown != 0 {
            // A block does not shrink below its head of eight bytes.
            let content = (span.end - span.start) as i64 - 8 + grown;
            let bytes = word(content as usize);
            edits.push(ByteEdit { span: span.start + 4..span.start + 8, bytes });
        }
    }
}

/// Adds edits for the pointers to data that the edits move.
fn with_pointers(input: &mut ByteSource<'_>, xcf: &Xcf, mut edits: Vec<ByteEdit>) -> Result<Vec<ByteEdit>, Error> {
    let in_properties = |e: &ByteEdit| e.span.start < xcf.properties_end;
    let resized = edits.iter().filter(|e| in_properties(e)).any(|e| e.bytes.len() as u64 != e.span.end - e.span.start);
    if !resized {
        return Ok(edits);
    }
    if xcf.version >= PATH_ITEMS {
        let problem =
            format!("a file of version {} stores paths as items; the old block in it cannot be resized", xcf.version);
        return Err(Error::unsupported(0, problem));
    }
    // All targets of pointers are after the property list and move by the same amount.
    let by = growth(&edits, xcf.properties_end);
    let mut adjusted = Vec::new();
    for (at, target) in pointers(input, xcf)? {
        let new = target.saturating_add_signed(by);
        let too_large = |_| Error::new(ErrorKind::TooLarge, at, "the file would exceed its 32-bit pointers");
        let bytes = if xcf.wide() {
            new.to_be_bytes().to_vec()
        } else {
            u32::try_from(new).map_err(too_large)?.to_be_bytes().to_vec()
        };
        adjusted.push(ByteEdit { span: at..at + bytes.len() as u64, bytes });
    }
    edits.extend(adjusted);
    edits.sort_by_key(|e| e.span.start);
    if let Some(w) = edits.windows(2).find(|w| w[1].span.start < w[0].span.end) {
        return Err(Error::damaged(w[1].span.start, "pointers overlap: the file is damaged outside its paths"));
    }
    Ok(edits)
}

/// Copies `from` up to `end` with the edits.
fn copy(from: &mut (impl Read + Seek), to: &mut dyn Write, edits: &[ByteEdit], end: u64) -> Result<(), Error> {
    let mut at = 0;
    let failed = |at: u64| move |e: std::io::Error| Error::new(ErrorKind::Io, at, format!("cannot be copied: {e}"));
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

/// The targets of pointers by their offsets.
type Pointers = BTreeMap<u64, u64>;

/// A property whose content is a pointer.
const PROP_FLOATING_SELECTION: u32 = 5;
/// Size of a property without content.
const MIN_PROPERTY: u64 = 8;

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
    /// Maximum number of further pointers. Sound structures do not overlap, so they fit into the file.
    pointers_left: u64,
    /// Maximum number of further properties.
    properties_left: u64,
    /// Lowest valid target.
    lowest: u64,
    /// Structures still to visit.
    pending: Vec<(u64, PointerTarget)>,
    visited: HashSet<u64>,
}

/// Collects all pointers of the file that `xcf` was read from.
fn pointers(input: &mut ByteSource<'_>, xcf: &Xcf) -> Result<Pointers, Error> {
    input.seek(xcf.properties_end, "the property list")?;
    let mut walk = PointerWalk {
        wide: xcf.wide(),
        found: Pointers::new(),
        pointers_left: input.end / if xcf.wide() { 8 } else { 4 },
        properties_left: input.end / MIN_PROPERTY,
        lowest: xcf.properties_end,
        pending: Vec::new(),
        visited: HashSet::new(),
        input,
    };
    walk.read_table(Some(PointerTarget::Layer))?;
    walk.read_table(Some(PointerTarget::Channel))?;
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
                // GIMP reads only the first level. In files with 64-bit pointers, the others have no tiles, and are not visited: a
                // zero of 32 bits ends their lists of tiles.
                if walk.pointer(Some(PointerTarget::Level))? {
                    walk.read_table((!walk.wide).then_some(PointerTarget::Level))?;
                }
            }
            PointerTarget::Level => {
                walk.input.skip(8, "a level")?;
                walk.read_table(None)?;
            }
        }
    }
    Ok(walk.found)
}

impl PointerWalk<'_, '_> {
    fn read_table(&mut self, target: Option<PointerTarget>) -> Result<(), Error> {
        while self.pointer(target)? {}
        Ok(())
    }

    /// Records a pointer. Returns `false` for the zero that ends a table.
    fn pointer(&mut self, to: Option<PointerTarget>) -> Result<bool, Error> {
        let at = self.input.offset();
        let what = "a table of pointers";
        let target = if self.wide { self.input.u64(what)? } else { u64::from(self.input.u32(what)?) };
        if target == 0 {
            return Ok(false);
        }
        if target >= self.input.end {
            let end = self.input.end;
            let problem = format!("a pointer points to byte {target}, outside the file of {end} bytes");
            return Err(Error::damaged(at, problem));
        }
        if target < self.lowest {
            return Err(Error::damaged(at, format!("a pointer points to byte {target}, inside the file's head")));
        }
        self.pointers_left = self
            .pointers_left
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
            let at = self.input.offset();
            self.properties_left = self
                .properties_left
                .checked_sub(1)
                .ok_or_else(|| Error::damaged(at, "the lists of properties overlap or have no end"))?;
            let kind = self.input.u32("a layer's properties")?;
            let length = u64::from(self.input.u32("a layer's properties")?);
            if kind == PROP_END {
                return Ok(());
            }
            let end = self.input.offset() + length;
            if kind == PROP_FLOATING_SELECTION && length == if self.wide { 8 } else { 4 } {
                self.pointer(None)?;
            }
            self.input.skip(end - self.input.offset(), "a layer's property")?;
        }
    }
}

/// Creates an RGB image of this size in pixels, with paths and without layers. It uses version 1 of the format, which every GIMP
/// since 2.0 opens.
#[must_use]
pub fn new_xcf(size: [u32; 2], paths: &[GimpPath]) -> Vec<u8> {
    /// The code for RGB.
    const BASE_TYPE: u32 = 0;
    const PROP_RESOLUTION: u32 = 19;
    const PIXELS_PER_INCH: f32 = 72.0;
    let mut out = MAGIC.to_vec();
    out.extend(b"v001\0");
    push_words(&mut out, &[size[0], size[1], BASE_TYPE, PROP_RESOLUTION, 8]);
    push_words(&mut out, &[PIXELS_PER_INCH.to_bits(); 2]);
    let mut block = Vec::new();
    // Paths in memory have far fewer points than a word counts.
    let count = |n: usize| n as u32;
    // Version, active path, number of paths.
    push_words(&mut block, &[1, 0, count(paths.len())]);
    for (i, p) in paths.iter().enumerate() {
        push_words(&mut block, &[count(p.name.len() + 1)]);
        block.extend(p.name.bytes());
        block.push(0);
        // Tattoo, visible, linked, parasites, strokes.
        push_words(&mut block, &[count(i + 1), u32::from(p.visible), 0, 0, count(p.strokes.len())]);
        block.extend(vectors::encode(&p.strokes));
    }
    push_words(&mut out, &[PROP_VECTORS, count(block.len())]);
    out.extend(block);
    // The end of the properties, whose content has length 0, no layers, no channels.
    push_words(&mut out, &[PROP_END, 0, 0, 0]);
    out
}
