//! The warps that Photoshop files (PSD, PSB) keep with their layers.
//!
//! Read are, of the layer records and their additional information (Adobe Photoshop File Formats Specification, *Layer and mask
//! information section*, *Additional layer information*): smart objects (`SoLd`, `PlLd`) and text (`TySh`). Nothing else of the
//! file is looked at. No crate that reads PSD files gives these descriptors, hence this small reader.

mod bytes;
mod descriptor;

use bytes::Bytes;
use descriptor::{Items, Value, get};
use serde::Serialize;
use thiserror::Error;

/// Why a file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Error {
    /// It does not begin like one.
    #[error("is no Photoshop file (PSD or PSB)")]
    NotPsd,
    /// It breaks the format.
    #[error("byte {at}: {what}")]
    Format {
        /// Where.
        at: usize,
        /// What is wrong.
        what: String,
    },
}

/// All warps of a file, in the order of its layers, from the bottom.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Warps {
    /// One for each layer that can have one; `warpNone` for those that have none.
    pub warps: Vec<Warp>,
}

/// A layer's warp.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Warp {
    /// The layer's name.
    pub layer: String,
    /// `warpArc`, …; `warpCustom` for points.
    pub style: String,
    /// The bend, percent.
    pub value: f64,
    /// Horizontal distortion, percent.
    pub perspective: f64,
    /// Vertical distortion, percent.
    pub perspective_other: f64,
    /// Whether the style acts sideways.
    pub vertical: bool,
    /// The control points of a custom warp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<Mesh>,
}

/// Control points of bicubic patches.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mesh {
    /// x, y, width and height of the box that is warped, in the units of the points.
    pub region: [f64; 4],
    /// Always true: the mesh is meant for the layer, whatever its place.
    pub fit: bool,
    /// Where patches meet along x, as shares of the width; none: evenly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<Vec<f64>>,
    /// The same along y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<Vec<f64>>,
    /// Rows from the top.
    pub points: Vec<Vec<[f64; 2]>>,
}

/// Reads the warps of a file.
///
/// # Errors
/// [`Error::NotPsd`], or [`Error::Format`] naming the byte.
pub fn warps(data: &[u8]) -> Result<Warps, Error> {
    let mut b = Bytes::new(data);
    if b.tag().ok() != Some(*b"8BPS") {
        return Err(Error::NotPsd);
    }
    let wide = match b.u16() {
        Ok(1) => false,
        Ok(2) => true,
        _ => return Err(Error::NotPsd),
    };
    b.take(6 + 2 + 4 + 4 + 2 + 2)?;
    // Colour mode data, image resources.
    for _ in 0..2 {
        let n = b.u32()? as usize;
        b.take(n)?;
    }
    let n = b.length(wide)?;
    let mut section = b.window(n)?;
    let mut out = Vec::new();
    if section.left() > 0 {
        let n = section.length(wide)?;
        layers(&mut section.window(n)?, wide, &mut out)?;
    }
    // Documents with more than eight bits keep their layers behind the global mask.
    if section.left() >= 4 {
        let n = section.u32()? as usize;
        section.take(n)?;
        blocks(&mut section, wide, 4, &mut |key, mut block| match key {
            b"Layr" | b"Lr16" | b"Lr32" => layers(&mut block, wide, &mut out),
            _ => Ok(()),
        })?;
    }
    Ok(Warps { warps: out })
}

/// Layer info: the records (the pixels behind them are not looked at).
fn layers(b: &mut Bytes<'_>, wide: bool, out: &mut Vec<Warp>) -> Result<(), Error> {
    if b.left() < 2 {
        return Ok(());
    }
    // Negative: the first alpha channel is the merged picture's transparency.
    let count = b.u16()?.cast_signed().unsigned_abs();
    for _ in 0..count {
        b.take(16)?;
        let channels = usize::from(b.u16()?);
        b.take(channels * if wide { 10 } else { 6 })?;
        b.take(12)?;
        let n = b.u32()? as usize;
        let mut extra = b.window(n)?;
        for _ in 0..2 {
            let n = extra.u32()? as usize;
            extra.take(n)?;
        }
        let short = usize::from(extra.u8()?);
        let mut name = String::from_utf8_lossy(extra.take(short)?).into_owned();
        let padding = (4 - (short + 1) % 4) % 4;
        extra.take(padding)?;
        let mut found: Option<Warp> = None;
        blocks(&mut extra, wide, 1, &mut |key, mut block| {
            match key {
                b"luni" => name = descriptor::text(&mut block)?,
                b"SoLd" | b"SoLE" => found = smart_object(&mut block)?.or(found.take()),
                // The older form of the same; the newer one wins.
                b"PlLd" if found.is_none() => found = placed(&mut block)?,
                b"TySh" => found = text(&mut block)?,
                _ => {}
            }
            Ok(())
        })?;
        if let Some(warp) = found {
            out.push(Warp { layer: name, ..warp });
        }
    }
    Ok(())
}

/// What is done with a block: its key and what it holds.
type Block<'f, 'a> = dyn FnMut(&[u8; 4], Bytes<'a>) -> Result<(), Error> + 'f;

/// Additional information: blocks with a key each, the global ones padded to `unit` bytes.
fn blocks<'a>(b: &mut Bytes<'a>, wide: bool, unit: usize, each: &mut Block<'_, 'a>) -> Result<(), Error> {
    const WIDE: [&[u8; 4]; 13] = [
        b"LMsk", b"Lr16", b"Lr32", b"Layr", b"Mt16", b"Mt32", b"Mtrn", b"Alph", b"FMsk", b"lnk2", b"FEid", b"FXid",
        b"PxSD",
    ];
    while b.left() >= 12 {
        let signature = b.tag()?;
        if &signature != b"8BIM" && &signature != b"8B64" {
            // Padding at the end.
            return Ok(());
        }
        let key = b.tag()?;
        let n = b.length(wide && WIDE.contains(&&key))?;
        let block = b.window(n)?;
        each(&key, block)?;
        let padding = (unit - n % unit) % unit;
        b.take(padding.min(b.left()))?;
    }
    Ok(())
}

/// `SoLd`: identifier, version, and a descriptor of everything.
fn smart_object(b: &mut Bytes<'_>) -> Result<Option<Warp>, Error> {
    b.take(8)?;
    version(b)?;
    let items = descriptor::read(b)?;
    let quilt = get(&items, "quiltWarp").and_then(Value::items).and_then(|w| warp(w, b).transpose());
    match quilt {
        Some(quilt) => quilt.map(Some),
        None => get(&items, "warp").and_then(Value::items).map_or(Ok(None), |w| warp(w, b)),
    }
}

/// `PlLd`: identifier, version, unique name, pages and corners, and the warp's descriptor.
fn placed(b: &mut Bytes<'_>) -> Result<Option<Warp>, Error> {
    b.take(8)?;
    let n = usize::from(b.u8()?);
    b.take(n + 16 + 64 + 4)?;
    version(b)?;
    let items = descriptor::read(b)?;
    warp(&items, b)
}

/// `TySh`: a transform, the text's descriptor, and the warp's.
fn text(b: &mut Bytes<'_>) -> Result<Option<Warp>, Error> {
    b.take(2 + 48 + 2)?;
    version(b)?;
    descriptor::read(b)?;
    b.take(2)?;
    version(b)?;
    let items = descriptor::read(b)?;
    warp(&items, b)
}

fn version(b: &mut Bytes<'_>) -> Result<(), Error> {
    match b.u32()? {
        16 => Ok(()),
        other => Err(b.wrong(format!("descriptors of version {other} are not known"))),
    }
}

/// A warp's descriptor.
fn warp(items: &Items, b: &Bytes<'_>) -> Result<Option<Warp>, Error> {
    let Some(style) = get(items, "warpStyle").and_then(Value::name) else { return Ok(None) };
    let number = |key: &str| get(items, key).and_then(Value::number).unwrap_or(0.0);
    let custom = get(items, "customEnvelopeWarp").and_then(Value::items);
    let mesh = match custom {
        Some(points) if style == "warpCustom" => Some(mesh(items, points).map_err(|what| b.wrong(what))?),
        _ => None,
    };
    Ok(Some(Warp {
        layer: String::new(),
        style: style.to_owned(),
        value: number("warpValue"),
        perspective: number("warpPerspective"),
        perspective_other: number("warpPerspectiveOther"),
        vertical: get(items, "warpRotate").and_then(Value::name) == Some("Vrtc"),
        mesh,
    }))
}

/// The points of a custom warp: sixteen, or a quilt's.
fn mesh(items: &Items, custom: &Items) -> Result<Mesh, String> {
    let points = get(custom, "meshPoints").and_then(Value::items).ok_or("a custom warp has no points")?;
    let of = |key: &str| get(points, key).and_then(Value::numbers).ok_or(format!("the points have no {key}"));
    let (x, y) = (of("Hrzn")?, of("Vrtc")?);
    if x.len() != y.len() {
        return Err(format!("the points have {} places across and {} down", x.len(), y.len()));
    }
    let whole = |key: &str| get(items, key).and_then(Value::number).map(|n| n as usize);
    // Counted in points or in patches; what fits the number of points decides.
    let sizes = match (whole("deformNumRows"), whole("deformNumCols")) {
        (Some(r), Some(c)) => {
            vec![(r, c), (r.saturating_mul(3).saturating_add(1), c.saturating_mul(3).saturating_add(1))]
        }
        _ => vec![(4, 4)],
    };
    let fits =
        |&(r, c): &(usize, usize)| r.checked_mul(c) == Some(x.len()) && r % 3 == 1 && c % 3 == 1 && r > 1 && c > 1;
    let (rows, columns) =
        sizes.into_iter().find(fits).ok_or(format!("{} points make no patches of 4 by 4", x.len()))?;
    let bounds = get(items, "bounds").and_then(Value::items).ok_or("a custom warp has no bounds")?;
    let side = |key: &str| get(bounds, key).and_then(Value::number).ok_or(format!("the bounds have no {key}"));
    let (top, left, bottom, right) = (side("Top")?, side("Left")?, side("Btom")?, side("Rght")?);
    let slices = |key: &str, patches: usize, from: f64, to: f64| {
        let found = get(custom, key)?;
        let numbers = found.numbers().or_else(|| get(found.items()?, key)?.numbers())?;
        let shares: Vec<f64> = numbers.iter().map(|v| (v - from) / (to - from)).collect();
        match shares.len() {
            n if n + 1 == patches => Some(shares),
            n if n == patches + 1 => Some(shares[1..patches].to_vec()),
            _ => None,
        }
    };
    let place = |j: usize, i: usize| [x[j * columns + i], y[j * columns + i]];
    Ok(Mesh {
        region: [left, top, right - left, bottom - top],
        fit: true,
        x: slices("quiltSliceX", (columns - 1) / 3, left, right),
        y: slices("quiltSliceY", (rows - 1) / 3, top, bottom),
        points: (0..rows).map(|j| (0..columns).map(|i| place(j, i)).collect()).collect(),
    })
}
