//! Reads the warps of layers in Photoshop files (PSD, PSB).
//!
//! The warps of smart objects (`SoLd`, `PlLd`) and text (`TySh`) are in the layer records and their additional information (Adobe
//! Photoshop File Formats Specification, *Layer and mask information section*, *Additional layer information*). Everything else in
//! the file is skipped.
//!
//! ```
//! // A file without layers: header, empty colour mode data, empty resources, empty layer section.
//! let mut file = b"8BPS\0\x01".to_vec();
//! file.extend([0; 20]);
//! file.extend([0; 12]);
//! assert!(pathwarp_psd::warps(&file)?.warps.is_empty());
//! # Ok::<(), pathwarp_psd::Error>(())
//! ```

mod descriptor;
mod warp;

use crate::descriptor::ByteReader;

pub use descriptor::Error;
pub use warp::{LayerWarp, LayerWarps, WarpMesh};

/// Reads the warps of a file.
///
/// # Errors
/// [`Error::NotPsd`] for other files; [`Error::Format`] with the byte offset for damaged ones.
pub fn warps(data: &[u8]) -> Result<LayerWarps, Error> {
    let mut input = ByteReader::new(data);
    if input.tag().ok() != Some(*b"8BPS") {
        return Err(Error::NotPsd);
    }
    let wide = match input.u16() {
        Ok(1) => false,
        Ok(2) => true,
        _ => return Err(Error::NotPsd),
    };
    // Skip reserved bytes, channels, height, width, depth and colour mode; then colour mode data and image resources.
    input.take(6 + 2 + 4 + 4 + 2 + 2)?;
    for _ in 0..2 {
        let n = input.u32()? as usize;
        input.take(n)?;
    }
    let n = input.length(wide)?;
    let mut section = input.window(n)?;
    let mut out = Vec::new();
    if section.left() > 0 {
        let n = section.length(wide)?;
        warp::layers(&mut section.window(n)?, wide, &mut out)?;
    }
    // Documents with more than eight bits per channel store their layers after the global mask.
    if section.left() >= 4 {
        let n = section.u32()? as usize;
        section.take(n)?;
        warp::blocks(&mut section, wide, 4, &mut |key, mut block| match key {
            b"Layr" | b"Lr16" | b"Lr32" => warp::layers(&mut block, wide, &mut out),
            _ => Ok(()),
        })?;
    }
    Ok(LayerWarps { warps: out })
}
