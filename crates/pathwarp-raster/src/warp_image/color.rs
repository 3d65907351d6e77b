//! Arithmetic on colours.

use super::block::BYTES;
use tiny_skia::PremultipliedColorU8;

/// Four premultiplied channels, 0 to 255.
pub(super) type Channels = [f32; 4];

#[inline]
pub(super) fn channels(p: PremultipliedColorU8) -> Channels {
    [f32::from(p.red()), f32::from(p.green()), f32::from(p.blue()), f32::from(p.alpha())]
}

/// Rounds to the nearest valid colour, clipping the overshoots of the cubic.
#[inline]
pub(super) fn color(c: Channels) -> PremultipliedColorU8 {
    let level = |v: f32, most: u8| ((v + 0.5) as u8).min(most);
    let alpha = level(c[3], 255);
    PremultipliedColorU8::from_rgba(level(c[0], alpha), level(c[1], alpha), level(c[2], alpha), alpha)
        .unwrap_or(PremultipliedColorU8::TRANSPARENT)
}

#[inline]
pub(super) fn bytes(p: PremultipliedColorU8) -> [u8; BYTES] {
    [p.red(), p.green(), p.blue(), p.alpha()]
}

/// Adds a weighted pixel to a sum.
#[inline]
pub(super) fn add(sum: &mut Channels, pixel: Channels, weight: f32) {
    for (s, c) in sum.iter_mut().zip(pixel) {
        *s += weight * c;
    }
}
