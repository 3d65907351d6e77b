//! Builds XCF files of every version from the description of the format, independently of the library.
#![allow(dead_code, reason = "every test file uses a part of this")]

use pathwarp_gimp::{GimpPath, Stroke};
use std::io::{Cursor, Read, Result, Seek, SeekFrom};

/// A file that counts how often it is read.
pub(crate) struct Counted<R> {
    file: R,
    pub(crate) bytes: usize,
    /// Number of reads and seeks.
    pub(crate) calls: usize,
}

impl<R> Counted<R> {
    pub(crate) fn new(file: R) -> Self {
        Self { file, bytes: 0, calls: 0 }
    }
}

impl<'a> Counted<Cursor<&'a [u8]>> {
    pub(crate) fn of(bytes: &'a [u8]) -> Self {
        Self::new(Cursor::new(bytes))
    }

    /// Asserts that reading took a time in proportion to the file: no number in it causes more calls than there are bytes.
    #[track_caller]
    pub(crate) fn assert_little(&self, of: &str) {
        let most = self.file.get_ref().len() + 64;
        assert!(self.calls <= most, "{of}: {} calls for {most} bytes", self.calls);
    }
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, to: &mut [u8]) -> Result<usize> {
        let n = self.file.read(to)?;
        self.bytes += n;
        self.calls += 1;
        Ok(n)
    }
}

impl<R: Seek> Seek for Counted<R> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.calls += 1;
        self.file.seek(to)
    }
}

/// Builds big-endian data.
#[derive(Default, Clone)]
pub(crate) struct XcfBytes(pub(crate) Vec<u8>);

impl XcfBytes {
    pub(crate) fn u32(&mut self, v: u32) -> &mut Self {
        self.0.extend(v.to_be_bytes());
        self
    }
    pub(crate) fn words(&mut self, vs: &[u32]) -> &mut Self {
        for v in vs {
            self.u32(*v);
        }
        self
    }
    pub(crate) fn f32(&mut self, v: f64) -> &mut Self {
        self.0.extend((v as f32).to_be_bytes());
        self
    }
    pub(crate) fn string(&mut self, s: &str) -> &mut Self {
        self.u32(s.len() as u32 + 1);
        self.0.extend(s.bytes());
        self.0.push(0);
        self
    }
    pub(crate) fn raw(&mut self, b: &[u8]) -> &mut Self {
        self.0.extend(b);
        self
    }
    pub(crate) fn property(&mut self, kind: u32, content: &[u8]) -> &mut Self {
        self.u32(kind).u32(content.len() as u32).raw(content)
    }
}

/// The form in which paths are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// PROP_PATHS of this format.
    Old(u32),
    /// PROP_VECTORS with this many axes.
    Vectors(u32),
    /// Items behind pointers.
    Items,
}

fn stroke(out: &mut XcfBytes, s: &Stroke, axes: u32) {
    out.words(&[1, u32::from(s.closed), axes, s.points.len() as u32]);
    for (i, [x, y]) in s.points.iter().enumerate() {
        out.u32(u32::from(i % 3 != 1)).f32(*x).f32(*y);
        for a in 2..axes {
            out.f32(f64::from(a) / 8.0);
        }
    }
}

/// The content of PROP_VECTORS. Every path has a parasite, as some in GIMP do.
pub(crate) fn vectors(paths: &[GimpPath], axes: u32) -> Vec<u8> {
    let mut out = XcfBytes::default();
    out.words(&[1, 0, paths.len() as u32]);
    for (i, p) in paths.iter().enumerate() {
        out.string(&p.name).words(&[i as u32 + 7, u32::from(p.visible), 0, 1, p.strokes.len() as u32]);
        out.string("remark").words(&[1, 5]).raw(b"hello");
        for s in &p.strokes {
            stroke(&mut out, s, axes);
        }
    }
    out.0
}

/// The content of PROP_PATHS.
pub(crate) fn old_paths(paths: &[GimpPath], format: u32) -> Vec<u8> {
    let mut out = XcfBytes::default();
    out.words(&[0, paths.len() as u32]);
    for p in paths {
        let mut points: Vec<(u32, [f64; 2])> = Vec::new();
        for (k, s) in p.strokes.iter().enumerate() {
            let mut own = s.points.clone();
            let first = own.remove(0);
            if s.closed {
                own.push(first);
            }
            for (i, at) in own.into_iter().enumerate() {
                points.push((
                    if i % 3 != 0 {
                        2
                    } else if i == 0 && k > 0 {
                        3
                    } else {
                        1
                    },
                    at,
                ));
            }
        }
        let closed = p.strokes.last().is_none_or(|s| s.closed);
        out.string(&p.name).u32(0).raw(&[if closed { 4 } else { 2 }]).u32(u32::from(closed));
        out.u32(points.len() as u32).u32(format);
        if format >= 2 {
            out.u32(1);
        }
        if format >= 3 {
            out.u32(77);
        }
        for (kind, [x, y]) in points {
            out.u32(kind);
            if format == 1 {
                out.u32(x as i32 as u32).u32(y as i32 as u32);
            } else {
                out.f32(x).f32(y);
            }
        }
    }
    out.0
}

/// A path item: name, size, properties, strokes.
pub(crate) fn item(p: &GimpPath) -> Vec<u8> {
    let mut body = XcfBytes::default();
    body.property(8, &u32::from(p.visible).to_be_bytes());
    body.property(34, &3u32.to_be_bytes());
    body.property(9999, b"something new");
    body.property(0, &[]);
    body.words(&[1, p.strokes.len() as u32]);
    for s in &p.strokes {
        stroke(&mut body, s, 2);
    }
    let mut out = XcfBytes::default();
    out.string(&p.name).u32(body.0.len() as u32).raw(&body.0);
    out.0
}

/// The header of this version and its property list up to the paths.
pub(crate) fn head(version: u32) -> XcfBytes {
    let mut out = XcfBytes::default();
    out.raw(b"gimp xcf ");
    if version == 0 {
        out.raw(b"file\0");
    } else {
        out.raw(format!("v{version:03}\0").as_bytes());
    }
    let indexed = version == 1;
    out.words(&[640, 400, if indexed { 2 } else { 0 }]);
    if version >= 4 {
        out.u32(150);
    }
    if indexed {
        // A colour map of two colours with a wrong length word, as written by old versions of GIMP.
        out.words(&[1, 99, 2]).raw(&[1, 2, 3, 4, 5, 6]);
    }
    out.property(17, &[0]);
    let mut resolution = XcfBytes::default();
    resolution.f32(300.0).f32(150.0);
    out.property(19, &resolution.0);
    out.property(21, b"a parasite that is skipped  ");
    out
}

/// A whole file: a layer with a mask and a tile each, a channel, and the paths.
pub(crate) fn xcf(version: u32, form: Form, paths: &[GimpPath]) -> Vec<u8> {
    let mut out = head(version);
    match form {
        Form::Old(format) => drop(out.property(23, &old_paths(paths, format))),
        Form::Vectors(axes) => drop(out.property(25, &vectors(paths, axes))),
        Form::Items => {}
    }
    out.property(22, &1u32.to_be_bytes());
    out.property(0, &[]);
    rest(out.0, version, if form == Form::Items { paths } else { &[] })
}

/// Offset from the start of a layer to the pointer of its floating selection: three words, the name, and a property header.
const FLOATING: usize = 12 + 4 + "Background".len() + 1 + 8;

/// Appends the tables and their targets to a finished property list.
pub(crate) fn rest(head: Vec<u8>, version: u32, items: &[GimpPath]) -> Vec<u8> {
    let wide = version >= 11;
    let pointer = |v: usize| if wide { (v as u64).to_be_bytes().to_vec() } else { (v as u32).to_be_bytes().to_vec() };
    let size = if wide { 8 } else { 4 };
    let mut out = head;
    let tables = out.len();
    // One layer and the end; one channel and the end; since version 18 the paths and the end.
    let entries = 4 + if version >= 18 { items.len() + 1 } else { 0 };
    out.resize(tables + entries * size, 0);
    let set = |out: &mut Vec<u8>, at: usize, v: usize| out[at..at + size].copy_from_slice(&pointer(v));
    let drawable = |out: &mut Vec<u8>, name: &str, layer: bool, mark: &[u8]| {
        let start = out.len();
        let mut b = XcfBytes::default();
        b.words(&[64, 1]);
        if layer {
            b.u32(0);
        }
        b.string(name);
        if layer {
            // A floating selection points to its owner.
            b.property(5, &vec![0; size]);
        }
        b.property(6, &255u32.to_be_bytes()).property(0, &[]);
        out.extend(&b.0);
        let pointers = out.len();
        out.resize(pointers + if layer { 2 } else { 1 } * size, 0);
        // The hierarchy: size, bytes per pixel, a level, and the empty level that GIMP adds.
        let hierarchy = out.len();
        set(out, pointers, hierarchy);
        let mut b = XcfBytes::default();
        b.words(&[64, 1, 1]);
        out.extend(&b.0);
        let levels = out.len();
        out.resize(levels + 3 * size, 0);
        for (k, has_tile) in [true, false].into_iter().enumerate() {
            let at = out.len();
            set(out, levels + k * size, at);
            let mut b = XcfBytes::default();
            b.words(&[64, 1]);
            out.extend(&b.0);
            let table = out.len();
            // GIMP ends the table of an empty level with 32 bits even if pointers have 64.
            out.resize(table + if has_tile { 2 * size } else { 4 }, 0);
            if has_tile {
                let tile = out.len();
                set(out, table, tile);
                out.extend(mark.iter().cycle().take(64));
            }
        }
        (start, pointers)
    };
    let (layer, pointers) = drawable(&mut out, "Background", true, b"layer ");
    set(&mut out, tables, layer);
    let (mask, _) = drawable(&mut out, "mask", false, b"mask ");
    set(&mut out, pointers + size, mask);
    let (channel, _) = drawable(&mut out, "Channel", false, b"channel ");
    set(&mut out, tables + 2 * size, channel);
    set(&mut out, layer + FLOATING, channel);
    if version >= 18 {
        for (i, p) in items.iter().enumerate() {
            let at = out.len();
            out.extend(item(p));
            set(&mut out, tables + (4 + i) * size, at);
        }
    }
    out
}

/// The three tiles of a file that [`xcf`] made, found by following its pointers: layer, mask, channel.
pub(crate) fn tiles(file: &[u8]) -> [Vec<u8>; 3] {
    let version: u32 =
        if &file[9..13] == b"file" { 0 } else { std::str::from_utf8(&file[10..13]).unwrap().parse().unwrap() };
    let word = |at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let size = if version >= 11 { 8 } else { 4 };
    let pointer = |at: usize| if size == 8 { word(at) << 32 | word(at + 4) } else { word(at) };
    let end_of_properties = |mut at: usize| loop {
        let (kind, length) = (word(at), word(at + 4));
        // The length word of the colour map is deliberately wrong.
        at += 8 + if kind == 1 { 4 + 3 * word(at + 8) } else { length };
        if kind == 0 {
            return at;
        }
    };
    let tables = end_of_properties(14 + 12 + if version >= 4 { 4 } else { 0 });
    let pointers_of = |at: usize, words: usize| {
        let name = at + 4 * words;
        end_of_properties(name + 4 + word(name))
    };
    let tile = |hierarchy: usize| {
        let level = pointer(hierarchy + 12);
        let at = pointer(level + 8);
        file[at..at + 64].to_vec()
    };
    // The floating selection still belongs to the channel.
    assert_eq!(pointer(pointer(tables) + FLOATING), pointer(tables + 2 * size));
    let layer = pointers_of(pointer(tables), 3);
    let mask = pointers_of(pointer(layer + size), 2);
    let channel = pointers_of(pointer(tables + 2 * size), 2);
    [layer, mask, channel].map(|at| tile(pointer(at)))
}

pub(crate) fn stroke_of(closed: bool, points: &[[f64; 2]]) -> Stroke {
    Stroke { closed, points: points.iter().map(|p| p.map(|v| f64::from(v as f32))).collect() }
}

/// Paths that every form can hold: integer coordinates, invisible, open strokes last and their first handle on the anchor.
pub(crate) fn plain_paths() -> Vec<GimpPath> {
    let square: Vec<[f64; 2]> =
        [[10., 10.], [90., 10.], [90., 90.], [10., 90.]].iter().flat_map(|p| [*p, *p, *p]).collect();
    let hill =
        [[5., 60.], [5., 60.], [30., 0.], [60., 0.], [95., 60.], [120., 100.], [120., 5.], [200., -8.], [210., -9.]];
    let ring = [[0., 40.], [20., 40.], [20., 51.], [40., 60.], [50., 40.], [60., 20.]];
    let path = |name: &str, strokes: Vec<Stroke>| GimpPath { name: name.to_owned(), visible: false, strokes };
    vec![
        path("Base", vec![stroke_of(true, &square)]),
        path("Größe & <Pfad> \"q\"", vec![stroke_of(true, &ring), stroke_of(false, &hill)]),
        path("a single anchor", vec![stroke_of(true, &[[7., 8.], [7., 9.], [7., 10.]])]),
    ]
}

/// Paths that only newer forms can hold: fractions, open strokes anywhere, no strokes, visible.
pub(crate) fn rich_paths() -> Vec<GimpPath> {
    let mut out = plain_paths();
    out[0].visible = true;
    let fractions: Vec<[f64; 2]> = (0..30).map(|i| [f64::from(i) / 7.0, f64::from(i * i) * 1e-3 - 1e6]).collect();
    out[1].strokes.insert(0, stroke_of(false, &fractions));
    out.push(GimpPath { name: "empty".to_owned(), visible: true, strokes: Vec::new() });
    out
}

/// Every form written by GIMP, in the versions that used it.
pub(crate) fn forms() -> Vec<(u32, Form)> {
    let old = (0..18).flat_map(|v| (1..=3).map(move |f| (v, Form::Old(f))));
    let vectors = (0..18).flat_map(|v| (2..=6).map(move |a| (v, Form::Vectors(a))));
    let items = (18..=22).map(|v| (v, Form::Items));
    old.chain(vectors).chain(items).collect()
}

/// Paths that the form can hold.
pub(crate) fn paths_for(form: Form) -> Vec<GimpPath> {
    match form {
        Form::Old(1) => plain_paths(),
        Form::Old(_) => {
            let mut out = plain_paths();
            out[0].strokes[0].points[4] = [f64::from(0.1f32), f64::from(-3.7e5f32)];
            out
        }
        _ => rich_paths(),
    }
}
