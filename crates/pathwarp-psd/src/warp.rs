//! The descriptors of warps.

use crate::bytes::ByteReader;
use crate::descriptor::{self, Items, Value, get};
use crate::error::Error;
use crate::model::{LayerWarp, WarpMesh};

/// Reads `SoLd`: identifier, version, and a descriptor of everything.
pub(crate) fn smart_object(b: &mut ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    b.take(8)?;
    version(b)?;
    let items = descriptor::read(b)?;
    let quilt = get(&items, "quiltWarp").and_then(Value::items).and_then(|w| warp(w, b).transpose());
    match quilt {
        Some(quilt) => quilt.map(Some),
        None => get(&items, "warp").and_then(Value::items).map_or(Ok(None), |w| warp(w, b)),
    }
}

/// Reads `PlLd`: identifier, version, unique name, pages and corners, and the descriptor of the warp.
pub(crate) fn placed(b: &mut ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    b.take(8)?;
    let n = usize::from(b.u8()?);
    b.take(n + 16 + 64 + 4)?;
    version(b)?;
    let items = descriptor::read(b)?;
    warp(&items, b)
}

/// Reads `TySh`: a transform, the descriptor of the text, and that of the warp.
pub(crate) fn text(b: &mut ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    b.take(2 + 48 + 2)?;
    version(b)?;
    descriptor::read(b)?;
    b.take(2)?;
    version(b)?;
    let items = descriptor::read(b)?;
    warp(&items, b)
}

/// Checks the version of a descriptor.
fn version(b: &mut ByteReader<'_>) -> Result<(), Error> {
    match b.u32()? {
        16 => Ok(()),
        other => Err(b.error(format!("descriptor version {other} is unknown"))),
    }
}

/// Converts the descriptor of a warp; `None` if it has no style.
fn warp(items: &Items, b: &ByteReader<'_>) -> Result<Option<LayerWarp>, Error> {
    let Some(style) = get(items, "warpStyle").and_then(Value::name) else { return Ok(None) };
    let number = |key: &str| get(items, key).and_then(Value::number).unwrap_or(0.0);
    let custom = get(items, "customEnvelopeWarp").and_then(Value::items);
    let mesh = match custom {
        Some(points) if style == "warpCustom" => Some(mesh(items, points).map_err(|problem| b.error(problem))?),
        _ => None,
    };
    Ok(Some(LayerWarp {
        layer: String::new(),
        style: style.to_owned(),
        value: number("warpValue"),
        perspective: number("warpPerspective"),
        perspective_other: number("warpPerspectiveOther"),
        vertical: get(items, "warpRotate").and_then(Value::name) == Some("Vrtc"),
        mesh,
    }))
}

/// Converts the points of a custom warp: sixteen, or those of a quilt.
fn mesh(items: &Items, custom: &Items) -> Result<WarpMesh, String> {
    let points = get(custom, "meshPoints").and_then(Value::items).ok_or("a custom warp has no points")?;
    let of = |key: &str| get(points, key).and_then(Value::numbers).ok_or(format!("the points have no {key}"));
    let (x, y) = (of("Hrzn")?, of("Vrtc")?);
    if x.len() != y.len() {
        return Err(format!("the points have {} x and {} y coordinates", x.len(), y.len()));
    }
    let whole = |key: &str| get(items, key).and_then(Value::number).map(|n| n as usize);
    // The sizes count points or patches; take those that match the number of points.
    let sizes = match (whole("deformNumRows"), whole("deformNumCols")) {
        (Some(r), Some(c)) => {
            vec![(r, c), (r.saturating_mul(3).saturating_add(1), c.saturating_mul(3).saturating_add(1))]
        }
        _ => vec![(4, 4)],
    };
    let fits =
        |&(r, c): &(usize, usize)| r.checked_mul(c) == Some(x.len()) && r % 3 == 1 && c % 3 == 1 && r > 1 && c > 1;
    let (rows, columns) =
        sizes.into_iter().find(fits).ok_or(format!("{} points do not form patches of 4 by 4", x.len()))?;
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
    Ok(WarpMesh {
        region: [left, top, right - left, bottom - top],
        fit: true,
        x: slices("quiltSliceX", (columns - 1) / 3, left, right),
        y: slices("quiltSliceY", (rows - 1) / 3, top, bottom),
        points: (0..rows).map(|j| (0..columns).map(|i| place(j, i)).collect()).collect(),
    })
}
