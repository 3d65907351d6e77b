use super::*;

#[test]
fn fonts() {
    let of = |v: &str| font(v).map(|all| all.into_iter().map(|(_, v)| v).collect::<Vec<_>>().join("|"));
    for (from, to) in [
        ("12px/1.5 Arial", "normal|normal|normal|normal|12px|Arial|auto"),
        (
            "italic small-caps bold condensed 1.5em / 2 'A b', serif",
            "italic|small-caps|bold|condensed|1.5em|'A b', serif|auto",
        ),
        ("oblique 10deg 350 larger x", "oblique|normal|350|normal|larger|x|auto"),
        ("120% \"Lucida Grande\"", "normal|normal|normal|normal|120%|\"Lucida Grande\"|auto"),
        ("inherit", "inherit|inherit|inherit|inherit|inherit|inherit|inherit"),
    ] {
        assert_eq!(of(from).as_deref(), Some(to), "{from}");
    }
    for bad in ["caption", "12px", "bold Arial", "", "12px/", "red 12px Arial"] {
        assert_eq!(of(bad), None, "{bad}");
    }
}

#[test]
fn weights_and_widths() {
    let of = |v: &str, parent| weight(v, parent).unwrap();
    assert_eq!([of("bolder", 100), of("bolder", 400), of("bolder", 700), of("bolder", 900)], [400, 700, 900, 900]);
    assert_eq!([of("lighter", 300), of("lighter", 600), of("lighter", 900)], [100, 400, 700]);
    assert_eq!([of("350", 400), of("1000", 400), of("bold", 100)], [400, 900, 700]);
    assert_eq!(weight("0", 400), None);
    assert_eq!(
        [width("75%"), width("95%"), width("300%"), width("wide")],
        [Some("condensed"), Some("normal"), Some("ultra-expanded"), None]
    );
}

#[test]
fn cases() {
    assert_eq!(Case::Upper.of("straße é", None), "STRASSE É");
    assert_eq!(Case::Capitalized.of("it's a d-day ünder", Some('x')), "it's A D-Day Ünder");
    assert_eq!(Case::Capitalized.of("ab", None), "Ab");
    assert_eq!(separated("office fit Th"), "of\u{180b}f\u{180b}ice f\u{180b}it T\u{180b}h");
}
