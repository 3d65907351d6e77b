//! Fonts: any bytes are rejected or are a font that can set text.
//!
//! The fonts of the tests are good seeds: `cp crates/pathwarp-text/tests/fonts/*.?tf fuzz/corpus/font`

#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp_text::{Align, Direction, Font, TextStyle, Variation, layout};

/// Kerning, ligatures, marks, joining and reordered letters, both directions, and a character that no font of the tests has.
const TEXT: &str = "Office AV\nسلام שָׁלוֹם\nहिन्दी क्ष q\u{302} 日";

/// Reads a font of a collection, chooses a variation by `place`, and sets text.
fn set(data: &[u8], index: u32, place: u8) {
    let Ok(font) = Font::new(data, index) else { return };
    let _ = (font.name(), font.has('A'), font.metrics(72.0));
    let at = |a: &pathwarp_text::FontAxis| match place % 3 {
        0 => a.min,
        1 => 0.5 * (a.min + a.max),
        _ => a.max,
    };
    // A damaged font may have invalid axis tags or ranges.
    let places: Vec<Variation> = font.axes().iter().filter_map(|a| Variation::new(&a.tag, at(a)).ok()).collect();
    let Ok(font) = font.with_variations(&places) else { return };
    let style = TextStyle {
        align: if place & 4 == 0 { Align::Start } else { Align::Justify },
        direction: if place & 8 == 0 { Direction::Auto } else { Direction::Rtl },
        ..TextStyle::default()
    };
    let Ok(set) = layout(TEXT, &[font], &style) else { return };
    assert_eq!(set.lines.len(), 3);
    for cluster in set.lines.iter().flat_map(|l| &l.clusters) {
        assert!(cluster.outline.is_finite() && cluster.origin.is_finite() && cluster.advance.is_finite());
    }
}

fuzz_target!(
    // The library turns a panic in the font readers into an error. Replace the default hook so that only escaping panics count.
    init: std::panic::set_hook(Box::new(|panic| eprintln!("{panic}"))),
    |data: &[u8]| {
        let place = data.last().copied().unwrap_or(0);
        set(data, 0, place);
        if data.starts_with(b"ttcf") {
            set(data, 1, place);
        }
    }
);
