//! Creates an XCF that holds paths only.

use super::model::{MAGIC, PROP_END, PROP_VECTORS};
use super::vectors;
use crate::path::GimpPath;

/// Creates an RGB image of this size in pixels, without layers, with these paths. It has version 1 of the format, which every
/// GIMP since 2.0 opens.
#[must_use]
pub fn new_xcf(size: [u32; 2], paths: &[GimpPath]) -> Vec<u8> {
    /// The code for RGB.
    const BASE_TYPE: u32 = 0;
    const PROP_RESOLUTION: u32 = 19;
    const PIXELS_PER_INCH: f32 = 72.0;
    let mut out = MAGIC.to_vec();
    let push = |out: &mut Vec<u8>, words: &[u32]| words.iter().for_each(|w| out.extend(w.to_be_bytes()));
    out.extend(b"v001\0");
    push(&mut out, &[size[0], size[1], BASE_TYPE, PROP_RESOLUTION, 8]);
    push(&mut out, &[PIXELS_PER_INCH.to_bits(); 2]);
    let mut block = Vec::new();
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    push(&mut block, &[1, 0, count(paths.len())]);
    for (i, p) in paths.iter().enumerate() {
        push(&mut block, &[count(p.name.len() + 1)]);
        block.extend(p.name.bytes());
        block.push(0);
        // Tattoo, visible, linked, parasites, strokes.
        push(&mut block, &[count(i + 1), u32::from(p.visible), 0, 0, count(p.strokes.len())]);
        block.extend(vectors::encode(&p.strokes));
    }
    push(&mut out, &[PROP_VECTORS, count(block.len())]);
    out.extend(block);
    // The end of the properties, no layers, no channels.
    push(&mut out, &[PROP_END, 0, 0, 0]);
    out
}
