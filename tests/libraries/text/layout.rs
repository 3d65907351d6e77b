//! Lines, spacing, alignment, fallback fonts and errors. Numbers are measures of Noto Sans, at 1000 units per em.

use super::common::{bundled, file};
use pathwarp::kurbo::{BezPath, Point, Shape};
use pathwarp_text::{
    Align, Direction, Error, Font, LetteringLine, Ligatures, OutlinedText, Quantity, TextStyle, Variation, features,
    layout, variations,
};
use proptest::prelude::*;

/// Advances of Noto Sans Regular (table hmtx); `ab c` has no kerning.
const A: f64 = 561.0;
const B: f64 = 615.0;
const C: f64 = 480.0;
const SPACE: f64 = 260.0;
const ASCENT: f64 = 1069.0;
const DESCENT: f64 = 293.0;

fn em() -> TextStyle {
    TextStyle { size: 1000.0, ..TextStyle::default() }
}

#[track_caller]
fn set(text: &str, style: &TextStyle) -> OutlinedText {
    layout(text, &[Font::new(&bundled(), 0).unwrap()], style).unwrap()
}

fn width(line: &LetteringLine) -> f64 {
    line.end.x - line.start.x
}

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-9, "{a} is not {b}");
}

#[test]
fn letters_and_words_are_spaced() {
    near(width(&set("ab c", &em()).lines[0]), A + B + SPACE + C);
    let spaced = set("ab c", &TextStyle { letter_spacing: 50.0, word_spacing: -30.0, ..em() });
    let line = &spaced.lines[0];
    let at: Vec<f64> = line.clusters.iter().map(|c| c.origin.x).collect();
    // Letter spacing follows every letter but the last; spaces also have word spacing.
    let expected = [0.0, A + 50.0, A + B + 100.0, A + B + SPACE + 120.0];
    at.iter().zip(expected).for_each(|(a, b)| near(*a, b));
    near(width(line), A + B + SPACE + C + 3.0 * 50.0 - 30.0);
    // Spacing does not change the shaped advances.
    near(line.clusters[0].advance, A);
    near(line.clusters[2].advance, SPACE);
}

#[test]
fn spaced_letters_form_no_ligature() {
    let glyphs = |style: &TextStyle| set("ffi", style).lines[0].clusters.iter().map(|c| c.glyphs.len()).sum::<usize>();
    let spaced = TextStyle { letter_spacing: 1.0, ..em() };
    assert_eq!(glyphs(&em()), 1);
    assert_eq!(glyphs(&spaced), 3);
    assert_eq!(glyphs(&TextStyle { ligatures: Ligatures::On, ..spaced }), 1);
    assert_eq!(glyphs(&TextStyle { ligatures: Ligatures::Off, ..em() }), 3);
    // Explicit features have precedence.
    let on = TextStyle { ligatures: Ligatures::Off, features: features("liga").unwrap(), ..em() };
    assert_eq!(glyphs(&on), 1);
}

#[test]
fn kerning_can_be_switched_off() {
    let (on, off) = (set("AV", &em()), set("AV", &TextStyle { kerning: false, ..em() }));
    near(width(&off.lines[0]), 639.0 + 600.0);
    near(width(&on.lines[0]), 639.0 + 600.0 - 40.0);
}

#[test]
fn joined_letters_stay_joined() {
    let bytes = file("arabic.ttf");
    let wide = |spacing| {
        let style = TextStyle { letter_spacing: spacing, ..em() };
        width(&layout("سلام عليكم", &[Font::new(&bytes, 0).unwrap()], &style).unwrap().lines[0])
    };
    near(wide(100.0), wide(0.0));
}

#[test]
fn lines_are_stacked() {
    let text = set("ab\r\nc\n\na", &em());
    assert_eq!(text.text, "ab\nc\n\na");
    let baselines: Vec<f64> = text.lines.iter().map(|l| l.start.y).collect();
    let expected: Vec<f64> = (0..4).map(|i| ASCENT + f64::from(i) * (ASCENT + DESCENT)).collect();
    assert_eq!(baselines, expected);
    let tight = set("ab\nc", &TextStyle { line_height: Some(900.0), ..em() });
    near(tight.lines[1].start.y, ASCENT + 900.0);
    near(tight.line_box().y0, 0.0);
    near(tight.line_box().y1, ASCENT + 900.0 + DESCENT);
}

#[test]
fn lines_are_aligned() {
    let text = "ab c\nab\na b c";
    let long = A + B + C + 2.0 * SPACE;
    let (first, short) = (A + B + C + SPACE, A + B);
    for (align, starts) in [
        (Align::Start, [0.0, 0.0, 0.0]),
        (Align::Left, [0.0, 0.0, 0.0]),
        (Align::Center, [(long - first) / 2.0, (long - short) / 2.0, 0.0]),
        (Align::Right, [long - first, long - short, 0.0]),
    ] {
        let lines = set(text, &TextStyle { align, ..em() }).lines;
        for (line, start) in lines.iter().zip(starts) {
            near(line.start.x, start);
            near(line.clusters[0].origin.x, start);
            // The outlines move with the line; the outline of `a` starts 46 units in.
            near(line.clusters[0].outline.bounding_box().x0, start + 46.0);
        }
    }
    let lines = set(text, &TextStyle { align: Align::Justify, ..em() }).lines;
    near(lines[0].end.x, long);
    near(lines[0].clusters[3].origin.x, long - C);
    // A line without spaces cannot be widened.
    near(lines[1].end.x, short);
}

#[test]
fn right_to_left_text_starts_at_the_right() {
    let (hebrew, latin) = (file("hebrew.ttf"), bundled());
    let fonts = || [Font::new(&hebrew, 0).unwrap(), Font::new(&latin, 0).unwrap()];
    let text = layout("שלום\nברכה שלום", &fonts(), &em()).unwrap();
    assert!(text.rtl);
    near(text.lines[0].end.x, text.lines[1].end.x);
    assert!(text.lines[0].start.x > 0.0);
    // The first letter is the rightmost.
    assert_eq!(text.lines[0].clusters.last().unwrap().text, "ש");

    // Latin words keep their direction; the base direction determines the order of words.
    let order = |direction| {
        let style = TextStyle { direction, ..em() };
        let line = layout("ab שלום", &fonts(), &style).unwrap().lines.remove(0);
        line.clusters.iter().map(|c| c.text.as_str()).collect::<String>()
    };
    assert_eq!(order(Direction::Auto), "ab םולש");
    assert_eq!(order(Direction::Rtl), "םולש ab");
}

#[test]
fn missing_characters_come_from_the_next_font() {
    let (hebrew, latin) = (file("hebrew.ttf"), bundled());
    let fonts = [Font::new(&hebrew, 0).unwrap(), Font::new(&latin, 0).unwrap()];
    let text = layout("aש日a", &fonts, &em()).unwrap();
    let from: Vec<(usize, bool)> =
        text.lines[0].clusters.iter().map(|c| (c.glyphs[0].font, c.glyphs[0].id == 0)).collect();
    assert_eq!(from, [(1, false), (0, false), (0, true), (1, false)]);
    assert_eq!(text.missing, ['日']);
    // The heights and the box for missing characters are those of the first font.
    near(text.metrics.ascent, 1068.0);
}

#[test]
fn axes_have_names_and_ranges() {
    let bytes = file("variable.ttf");
    let font = || Font::new(&bytes, 0).unwrap();
    let axes: Vec<(String, f64, f64)> = font().axes().into_iter().map(|a| (a.tag, a.min, a.max)).collect();
    assert_eq!(axes, [("wght".into(), 100.0, 900.0), ("wdth".into(), 62.5, 100.0)]);
    let wrong = |text: &str| font().with_variations(&variations(text).unwrap()).unwrap_err().to_string();
    assert!(wrong("slnt=3").contains("wght (100 to 900)"), "{}", wrong("slnt=3"));
    assert!(wrong("wght=901").contains("100 to 900"), "{}", wrong("wght=901"));
    let plain = bundled();
    let e = Font::new(&plain, 0).unwrap().with_variations(&[Variation::new("wght", 400.0).unwrap()]).unwrap_err();
    assert!(e.to_string().contains("not a variable font"), "{e}");
}

#[test]
fn impossible_requests_are_errors() {
    let bytes = bundled();
    let refused = |text: &str, style: &TextStyle| layout(text, &[Font::new(&bytes, 0).unwrap()], style).unwrap_err();
    for text in ["", "\n", "\n\n"] {
        assert_eq!(refused(text, &em()), Error::Empty, "{text:?}");
    }
    assert!(matches!(refused(&"a".repeat(30_001), &em()), Error::TooLarge { quantity: Quantity::Letters, .. }));
    assert_eq!(layout("a", &[], &em()).unwrap_err(), Error::NoFont);
    for size in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e7] {
        assert!(refused("a", &TextStyle { size, ..em() }).to_string().contains("size"));
    }
    for wrong in [
        TextStyle { letter_spacing: f64::NAN, ..em() },
        TextStyle { word_spacing: 1e9, ..em() },
        TextStyle { line_height: Some(-1.0), ..em() },
    ] {
        assert!(matches!(refused("a", &wrong), Error::Style { .. }), "{wrong:?}");
    }
    assert!(refused("a", &TextStyle { script: Some("Wxyz".into()), ..em() }).to_string().contains("`Wxyz`"));
    assert!(refused("a", &TextStyle { language: Some("s r".into()), ..em() }).to_string().contains("`s r`"));
    // Spaces alone have extent but no outlines.
    assert!(layout("  ", &[Font::new(&bytes, 0).unwrap()], &em()).unwrap().ink().is_none());
}

#[test]
fn other_files_are_errors() {
    for (bytes, message) in
        [(&b""[..], ".ttf"), (b"<svg/>", ".ttf"), (b"wOF2\0\0\0\0", "convert"), (b"%!PS-AdobeFont-1.0", "Type 1")]
    {
        let e = Font::new(bytes, 0).unwrap_err().to_string();
        assert!(e.contains(message), "{e}");
    }
    assert_eq!(Font::new(&bundled(), 2).unwrap_err(), Error::NoSuchFace { index: 2, count: 1 });
}

/// Truncated or altered fonts give an error, or lettering with finite outlines.
#[test]
fn damaged_fonts_are_harmless() {
    let finite = |path: &BezPath| path.iter().all(|el| el.end_point().is_none_or(Point::is_finite));
    let mut random = pathwarp_oracle::Random::new(1);
    let (mut set, mut refused) = (0, 0);
    for (name, text) in [
        ("cff.otf", "Hafilox"),
        ("variable.ttf", "AVo Hx"),
        ("hebrew.ttf", "שָּׁלוֹם"),
        ("arabic.ttf", "سلام عليكم"),
        ("devanagari.ttf", "क्षत्रिय हिन्दी"),
    ] {
        let sound = file(name);
        for i in 0..240 {
            let mut bytes = sound.clone();
            if i % 4 == 0 {
                bytes.truncate(random.below(sound.len()));
            } else {
                for _ in 0..1 << (i % 6) {
                    let at = random.below(bytes.len());
                    bytes[at] = random.below(256) as u8;
                }
            }
            match Font::new(&bytes, 0).and_then(|f| layout(text, &[f], &em())) {
                Ok(text) => {
                    set += 1;
                    assert!(text.lines.iter().flat_map(|l| &l.clusters).all(|c| finite(&c.outline)), "{name} {i}");
                }
                Err(_) => refused += 1,
            }
        }
    }
    assert!(set > 100 && refused > 100, "{set} set, {refused} refused");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// For any text, every character is in exactly one cluster, clusters are adjacent, and the result is reproducible.
    #[test]
    fn clusters_partition_every_line(text in "[a-zA-Z \\n\\täß\u{301}\u{308}éשלاب日\u{200d}\u{1f600}()0-9क्षि]{1,40}") {
        let bytes = bundled();
        let font = || [Font::new(&bytes, 0).unwrap()];
        let Ok(set) = layout(&text, &font(), &em()) else {
            // A joiner alone has no extent, like an empty line.
            let silent = |c: char| c == '\n' || c == '\u{200d}';
            prop_assert!(text.chars().all(silent));
            return Ok(());
        };
        for line in &set.lines {
            let sorted = |all: String| { let mut v: Vec<char> = all.chars().collect(); v.sort_unstable(); v };
            let of_clusters: String = line.clusters.iter().map(|c| c.text.as_str()).collect();
            prop_assert_eq!(sorted(of_clusters), sorted(line.text.clone()));
            let mut x = line.start.x;
            for c in &line.clusters {
                prop_assert!((c.origin.x - x).abs() < 1e-6);
                x += c.advance;
            }
            prop_assert!((line.end.x - x).abs() < 1e-6);
        }
        prop_assert_eq!(&set, &layout(&text, &font(), &em()).unwrap());
    }
}

/// Returns the box of a line's ink.
fn ink(line: &LetteringLine) -> pathwarp::kurbo::Rect {
    line.clusters
        .iter()
        .filter(|c| !c.outline.is_empty())
        .map(|c| c.outline.bounding_box())
        .reduce(|a, b| a.union(b))
        .unwrap()
}

#[test]
fn every_line_fills_the_width_of_the_widest() {
    let plain = set("by\nLOVE MUSIC\n\nI\nyes, it is", &em());
    let style = TextStyle { align: Align::Fill, ..em() };
    let filled = set("by\nLOVE MUSIC\n\nI\nyes, it is", &style);
    let widest = ink(&plain.lines[1]).width();
    for i in [0, 1, 3, 4] {
        let (before, after, line) = (ink(&plain.lines[i]), ink(&filled.lines[i]), &filled.lines[i]);
        near(after.x0, 0.0);
        near(after.x1, widest);
        near(line.start.x, 0.0);
        near(line.end.x, widest);
        // The proportion stays: letters grow as much as the line widens.
        near(line.scale, widest / before.width());
        near(after.height() / before.height(), line.scale);
        for (a, b) in plain.lines[i].clusters.iter().zip(&line.clusters) {
            near(b.advance, line.scale * a.advance);
            near(b.origin.x, line.scale * (a.origin.x - before.x0));
            near(b.origin.y, line.start.y);
        }
    }
    // Boxes of lines follow one another, each at its size; the font has no gap between lines.
    let mut top = 0.0;
    for line in &filled.lines {
        near(line.start.y, top + ASCENT * line.scale);
        top = line.start.y + DESCENT * line.scale;
    }
    near(filled.page().y1, top);
    let fixed = set("by\nLOVE MUSIC", &TextStyle { line_height: Some(900.0), ..style.clone() });
    near(fixed.lines[1].start.y - fixed.lines[0].start.y, 900.0 * fixed.lines[1].scale);
    // One word fills its width.
    let one = set("MUSIC", &style);
    near(one.lines[0].scale, 1.0);
    near(ink(&one.lines[0]).x0, 0.0);
}

#[test]
fn gaps_are_from_ink_to_ink() {
    for align in [Align::Start, Align::Center, Align::Justify, Align::Fill] {
        for gap in [0.0, 60.0, -100.0] {
            let text = set("yearly\nLOVE\nMUSIC, guys\na", &TextStyle { align, gap: Some(gap), ..em() });
            text.lines.windows(2).for_each(|l| near(ink(&l[1]).y0 - ink(&l[0]).y1, gap));
            near(text.lines[0].start.y, ASCENT * text.lines[0].scale);
            text.lines
                .iter()
                .flat_map(|l| &l.clusters)
                .for_each(|c| assert!(text.lines.iter().any(|l| l.start.y == c.origin.y)));
        }
    }
    // A line without ink has no height.
    let empty = set("A\n\nB", &TextStyle { gap: Some(50.0), ..em() });
    near(ink(&empty.lines[2]).y0 - ink(&empty.lines[0]).y1, 100.0);
    assert!(layout("a", &[Font::new(&bundled(), 0).unwrap()], &TextStyle { gap: Some(f64::NAN), ..em() }).is_err());
}
