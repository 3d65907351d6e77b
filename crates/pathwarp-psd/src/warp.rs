//! The descriptors of warps.

use crate::descriptor::{self, ByteReader, Error, Items, Value, get};
use serde::Serialize;

/// Reads `SoLd`: identifier, version, and a descriptor that includes the warp.
pub(crate) fn smart_object(input: &mut ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    input.take(8)?;
    let items = versioned(input)?;
    let warp_of = |key: &str| get(&items, key).and_then(Value::items).map_or(Ok(None), |w| warp(w, input));
    match warp_of("quiltWarp")? {
        Some(quilt) => Ok(Some(quilt)),
        None => warp_of("warp"),
    }
}

/// Reads `PlLd`: identifier, version, unique name, pages and corners, and the descriptor of the warp.
pub(crate) fn placed(input: &mut ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    input.take(8)?;
    let n = usize::from(input.u8()?);
    input.take(n + 16 + 64 + 4)?;
    warp(&versioned(input)?, input)
}

/// Reads `TySh`: a transform, the descriptor of the text, and the descriptor of the warp, each with its version.
pub(crate) fn text(input: &mut ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    input.take(2 + 48 + 2)?;
    versioned(input)?;
    input.take(2)?;
    warp(&versioned(input)?, input)
}

/// Reads a descriptor and the version before it.
fn versioned(input: &mut ByteReader<'_>) -> Result<Items, Error> {
    match input.u32()? {
        16 => descriptor::read(input),
        other => Err(input.error(format!("descriptor version {other} is unknown"))),
    }
}

/// Converts the descriptor of a warp; `None` if it has no style.
fn warp(items: &Items, input: &ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    let Some(style) = get(items, "warpStyle").and_then(Value::word) else { return Ok(None) };
    let number = |key: &str| get(items, key).and_then(Value::number).unwrap_or(0.0);
    let custom = get(items, "customEnvelopeWarp").and_then(Value::items);
    let mesh = match custom {
        Some(points) if style == "warpCustom" => Some(mesh(items, points).map_err(|problem| input.error(problem))?),
        _ => None,
    };
    Ok(Some(LayerWarp {
        layer: String::new(),
        style: style.to_owned(),
        value: number("warpValue"),
        perspective: number("warpPerspective"),
        perspective_other: number("warpPerspectiveOther"),
        vertical: get(items, "warpRotate").and_then(Value::word) == Some("Vrtc"),
        mesh,
    }))
}

/// Converts the points of a custom warp: sixteen, or more for a quilt.
fn mesh(items: &Items, custom: &Items) -> Result<WarpMesh, String> {
    let points = get(custom, "meshPoints").and_then(Value::items).ok_or("a custom warp has no points")?;
    let coordinates = |key: &str| get(points, key).and_then(Value::numbers).ok_or(format!("the points have no {key}"));
    let (x, y) = (coordinates("Hrzn")?, coordinates("Vrtc")?);
    if x.len() != y.len() {
        return Err(format!("the points have {} x and {} y coordinates", x.len(), y.len()));
    }
    let whole = |key: &str| get(items, key).and_then(Value::number).map(|n| n as usize);
    // The sizes count points or patches, of which n have 3n + 1 points; take those that match the number of points.
    let points_of = |patches: usize| patches.saturating_mul(3).saturating_add(1);
    let sizes = match (whole("deformNumRows"), whole("deformNumCols")) {
        (Some(r), Some(c)) => vec![(r, c), (points_of(r), points_of(c))],
        _ => vec![(4, 4)],
    };
    let fits =
        |&(r, c): &(usize, usize)| r.checked_mul(c) == Some(x.len()) && r % 3 == 1 && c % 3 == 1 && r > 1 && c > 1;
    let (rows, columns) =
        sizes.into_iter().find(fits).ok_or(format!("{} points do not form patches of 4 by 4", x.len()))?;
    let bounds = get(items, "bounds").and_then(Value::items).ok_or("a custom warp has no bounds")?;
    let side = |key: &str| get(bounds, key).and_then(Value::number).ok_or(format!("the bounds have no {key}"));
    let (top, left, bottom, right) = (side("Top")?, side("Left")?, side("Btom")?, side("Rght")?);
    // A list of boundaries may lie in a descriptor of the same name, and may include the two sides of the box.
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
    let point = |j: usize, i: usize| [x[j * columns + i], y[j * columns + i]];
    Ok(WarpMesh {
        region: [left, top, right - left, bottom - top],
        fit: true,
        x: slices("quiltSliceX", (columns - 1) / 3, left, right),
        y: slices("quiltSliceY", (rows - 1) / 3, top, bottom),
        points: (0..rows).map(|j| (0..columns).map(|i| point(j, i)).collect()).collect(),
    })
}

/// All warps of a file in the order of its layers, from bottom to top.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LayerWarps {
    /// A warp for each smart object and text layer; its style is `warpNone` if the layer is not warped.
    pub warps: Vec<LayerWarp>,
}

/// The warp of a layer.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LayerWarp {
    /// Name of the layer.
    pub layer: String,
    /// Name of the style, such as `warpArc`; `warpCustom` for control points.
    pub style: String,
    /// Bend in percent.
    pub value: f64,
    /// Horizontal distortion in percent.
    pub perspective: f64,
    /// Vertical distortion in percent.
    pub perspective_other: f64,
    /// `true` if the style acts vertically.
    pub vertical: bool,
    /// Control points of a custom warp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<WarpMesh>,
}

/// Control points of bicubic patches.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WarpMesh {
    /// x, y, width and height of the warped box, in the units of the points.
    pub region: [f64; 4],
    /// Always `true`: the mesh is fitted to the artwork, whatever its position.
    pub fit: bool,
    /// Boundaries between patches along x, as fractions of the width; `None` if they are even.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<Vec<f64>>,
    /// Boundaries between patches along y, as fractions of the height.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<Vec<f64>>,
    /// Rows of control points from the top.
    pub points: Vec<Vec<[f64; 2]>>,
}

/// Reads the layer records; the pixels after them are ignored.
pub(crate) fn layers(input: &mut ByteReader<'_>, wide: bool, out: &mut Vec<LayerWarp>) -> Result<(), Error> {
    if input.left() < 2 {
        return Ok(());
    }
    // A negative count means that the first alpha channel is the transparency of the merged picture.
    let count = input.u16()?.cast_signed().unsigned_abs();
    for _ in 0..count {
        // The box, then for each channel its id and length, then the blend mode with its flags.
        input.take(16)?;
        let channels = usize::from(input.u16()?);
        input.take(channels * if wide { 10 } else { 6 })?;
        input.take(12)?;
        let n = input.u32()? as usize;
        let mut extra = input.window(n)?;
        // Skip the layer mask and the blending ranges.
        for _ in 0..2 {
            let n = extra.u32()? as usize;
            extra.take(n)?;
        }
        let length = usize::from(extra.u8()?);
        let mut name = String::from_utf8_lossy(extra.take(length)?).into_owned();
        // The name with its length byte is padded to a multiple of four.
        extra.take((length + 1).next_multiple_of(4) - (length + 1))?;
        let mut warp: Option<LayerWarp> = None;
        blocks(&mut extra, wide, 1, &mut |key, mut block| {
            match key {
                b"luni" => name = descriptor::text(&mut block)?,
                b"SoLd" | b"SoLE" => warp = smart_object(&mut block)?.or(warp.take()),
                // The older form of `SoLd`, which has precedence.
                b"PlLd" if warp.is_none() => warp = placed(&mut block)?,
                b"TySh" => warp = text(&mut block)?,
                _ => {}
            }
            Ok(())
        })?;
        if let Some(warp) = warp {
            out.push(LayerWarp { layer: name, ..warp });
        }
    }
    Ok(())
}

/// Handles a block, given its key and content.
type BlockHandler<'f, 'a> = dyn FnMut(&[u8; 4], ByteReader<'a>) -> Result<(), Error> + 'f;

/// Reads the blocks of additional information, which are padded to `unit` bytes.
pub(crate) fn blocks<'a>(
    input: &mut ByteReader<'a>,
    wide: bool,
    unit: usize,
    each: &mut BlockHandler<'_, 'a>,
) -> Result<(), Error> {
    /// Keys of blocks with 64-bit lengths in large documents.
    const WIDE: [&[u8; 4]; 13] = [
        b"LMsk", b"Lr16", b"Lr32", b"Layr", b"Mt16", b"Mt32", b"Mtrn", b"Alph", b"FMsk", b"lnk2", b"FEid", b"FXid",
        b"PxSD",
    ];
    while input.left() >= 12 {
        let signature = input.tag()?;
        if &signature != b"8BIM" && &signature != b"8B64" {
            // Only padding follows.
            return Ok(());
        }
        let key = input.tag()?;
        let n = input.length(wide && WIDE.contains(&&key))?;
        each(&key, input.window(n)?)?;
        let padding = n.next_multiple_of(unit) - n;
        input.take(padding.min(input.left()))?;
    }
    Ok(())
}
