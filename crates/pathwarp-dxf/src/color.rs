//! The 255 colours of the AutoCAD colour index, which programs take as settings of the machine.

/// The index of black on a light and white on a dark background.
pub(crate) const FOREGROUND: u8 = 7;

/// The named colours 1 to 6.
const PURE: [[u8; 3]; 6] = [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];

/// The greys 8 and 9, and 250 to 254.
const GREYS: [(u8, u8); 7] = [(8, 128), (9, 192), (250, 51), (251, 91), (252, 132), (253, 173), (254, 214)];

/// Brightest channel of the shades of a hue, from the first pair of ten to the last.
const LEVELS: [f64; 5] = [255.0, 165.0, 127.0, 76.0, 38.0];

/// The nearest colour of the index, and whether it is the very colour.
pub(crate) fn nearest(color: [u8; 3]) -> (u8, bool) {
    if color == [0; 3] || color == [255; 3] {
        return (FOREGROUND, true);
    }
    if let Some(i) = (1..).zip(PURE).find(|(_, c)| *c == color) {
        return (i.0, true);
    }
    let distance =
        |c: [u8; 3]| -> i32 { c.iter().zip(color).map(|(a, b)| (i32::from(*a) - i32::from(b)).pow(2)).sum() };
    let greys = GREYS.iter().map(|(i, v)| (*i, [*v; 3]));
    let shades = (10..250).map(|i| (i, shade(i)));
    let foreground = [(FOREGROUND, [0; 3]), (FOREGROUND, [255; 3])];
    let all = (1..).zip(PURE).chain(foreground).chain(greys).chain(shades);
    (all.min_by_key(|(_, c)| distance(*c)).map_or(FOREGROUND, |(i, _)| i), false)
}

/// The colours 10 to 249: 24 hues of ten shades, of which every second is half saturated.
fn shade(index: u8) -> [u8; 3] {
    /// Hues between two pure colours.
    const PER_SIXTH: f64 = 4.0;
    let (hue, place) = ((index - 10) / 10, (index - 10) % 10);
    let level = LEVELS[usize::from(place / 2)];
    let floor = if place % 2 == 0 { 0.0 } else { 0.5 };
    let sixth = f64::from(hue) / PER_SIXTH;
    [0.0, 4.0, 2.0].map(|turn| {
        // The distance from the hue at which the channel is brightest, in sixths of a turn.
        let away = (sixth + turn).rem_euclid(6.0);
        let away = away.min(6.0 - away);
        let strength = (2.0 - away).clamp(0.0, 1.0);
        (level * (floor + (1.0 - floor) * strength)) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colours as AutoCAD shows them.
    #[test]
    fn known_colours() {
        for (index, color) in [
            (10, 0xff_0000),
            (11, 0xff_7f7f),
            (12, 0xa5_0000),
            (15, 0x7f_3f3f),
            (20, 0xff_3f00),
            (30, 0xff_7f00),
            (50, 0xff_ff00),
            (90, 0x00_ff00),
            (130, 0x00_ffff),
            (140, 0x00_bfff),
            (170, 0x00_00ff),
            (200, 0xbf_00ff),
            (210, 0xff_00ff),
            (249, 0x26_1316),
        ] {
            let [_, r, g, b] = u32::to_be_bytes(color);
            let off = shade(index).iter().zip([r, g, b]).map(|(a, b)| a.abs_diff(b)).max();
            assert!(off <= Some(1), "{index}: {:?}", shade(index));
        }
    }

    #[test]
    fn the_nearest_is_found() {
        assert_eq!(nearest([0, 0, 0]), (7, true));
        assert_eq!(nearest([0, 0, 255]), (5, true));
        assert_eq!(nearest([254, 1, 0]).0, 1);
        assert_eq!(nearest([255, 127, 1]), (30, false));
        assert_eq!(nearest([130, 130, 130]).0, 8);
    }
}
