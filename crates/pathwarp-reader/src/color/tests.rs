use super::paint;

#[test]
fn what_usvg_reads_stays() {
    for css in ["#123", "url(#a) red", "context-fill", "currentColor", "hsl(120 50% 40% / 60%)"] {
        assert_eq!(paint(css).as_deref(), Some(css));
    }
}

/// As Chromium 156 paints them, within a level.
#[test]
fn other_spaces() {
    for (css, wanted) in [
        ("oklch(0.7 0.1 150)", [111, 176, 125]),
        ("lab(50% 40 30)", [187, 88, 70]),
        ("color(srgb 1 .5 0)", [255, 128, 0]),
        ("color(display-p3 0.5 0.5 0.5)", [127, 128, 128]),
        ("color(display-p3 0.4 60% 0.4 / 1)", [85, 155, 97]),
    ] {
        let found = paint(css).unwrap();
        let channels = found.strip_prefix("rgba(").unwrap().split(',').take(3);
        let channels: Vec<i32> = channels.map(|c| c.parse().unwrap()).collect();
        assert!(channels.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= 1), "{css}: {found}");
    }
    for none in ["color(display-p3 1 0)", "color-mix(in srgb, red, blue)", "oklch(x)", ""] {
        assert_eq!(paint(none), None, "{none}");
    }
}
