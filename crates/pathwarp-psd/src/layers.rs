//! Layer records and their additional information.

use crate::bytes::ByteReader;
use crate::descriptor;
use crate::error::Error;
use crate::model::LayerWarp;
use crate::warp::{placed, smart_object, text};

/// Reads the layer records; the pixels after them are ignored.
pub(crate) fn layers(b: &mut ByteReader<'_>, wide: bool, out: &mut Vec<LayerWarp>) -> Result<(), Error> {
    if b.left() < 2 {
        return Ok(());
    }
    // A negative count means that the first alpha channel is the transparency of the merged picture.
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
        let mut warp: Option<LayerWarp> = None;
        blocks(&mut extra, wide, 1, &mut |key, mut block| {
            match key {
                b"luni" => name = descriptor::text(&mut block)?,
                b"SoLd" | b"SoLE" => warp = smart_object(&mut block)?.or(warp.take()),
                // The older form of the same data; the newer one has precedence.
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
    b: &mut ByteReader<'a>,
    wide: bool,
    unit: usize,
    each: &mut BlockHandler<'_, 'a>,
) -> Result<(), Error> {
    /// Keys of blocks with 64-bit lengths in large documents.
    const WIDE: [&[u8; 4]; 13] = [
        b"LMsk", b"Lr16", b"Lr32", b"Layr", b"Mt16", b"Mt32", b"Mtrn", b"Alph", b"FMsk", b"lnk2", b"FEid", b"FXid",
        b"PxSD",
    ];
    while b.left() >= 12 {
        let signature = b.tag()?;
        if &signature != b"8BIM" && &signature != b"8B64" {
            // Only padding follows.
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
