use super::*;

#[test]
fn names_of_fonts() {
    assert_eq!(plain("Noto Sans-Regular"), "notosans");
    let of = |name| named(&METRIC_COMPATIBLE, name).map(|(families, weight, style)| (families[0], weight.0, style));
    assert_eq!(of("Arial"), Some(("Liberation Sans", 400, fontdb::Style::Normal)));
    assert_eq!(of("Helvetica-BoldOblique"), Some(("Nimbus Sans", 700, fontdb::Style::Italic)));
    assert_eq!(of("TimesNewRomanPS-ItalicMT"), Some(("Liberation Serif", 400, fontdb::Style::Italic)));
    assert_eq!(of("Courier New"), Some(("Liberation Mono", 400, fontdb::Style::Normal)));
    assert_eq!([of("Helvetica Neue"), of("Arial Black"), of("Timeless")], [None; 3]);
    for (name, kind) in [
        ("Helvetica Neue", Some(FontFamily::SansSerif)),
        ("Segoe UI", Some(FontFamily::SansSerif)),
        ("PublicSans-Regular", Some(FontFamily::SansSerif)),
        ("Noto Serif Display", Some(FontFamily::Serif)),
        ("Century Gothic", Some(FontFamily::SansSerif)),
        ("MinionPro-Bold", Some(FontFamily::Serif)),
        ("Fira Mono", Some(FontFamily::Monospace)),
        ("Brush Script MT", Some(FontFamily::Cursive)),
        ("Nowhere", None),
    ] {
        assert_eq!(kind_of(name), kind, "{name}");
    }
}
