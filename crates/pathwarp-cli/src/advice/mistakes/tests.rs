use super::*;

#[test]
fn values_are_put_together_again() {
    let whole = |line: &str| {
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        torn(&words).map(|t| t.whole)
    };
    for (line, expected) in [
        ("text A --size 40 mm", "--size 40mm"),
        ("warp a.svg --bend -40 %", "--bend -40%"),
        ("warp a.svg --bend=-40 %", "--bend -40%"),
        ("projective --target 0%,100% 100%,100% 75%,0% a.svg", "--target '0%,100% 100%,100% 75%,0%'"),
        ("bend a.svg --along M0,100 Q150,20 300,100", "--along 'M0,100 Q150,20 300,100'"),
        ("bend a.svg --along M 0,100", "--along 'M 0,100'"),
        ("mls --pair 5,5 6,6 a.svg", "--pair 5,5:6,6"),
        ("mls --pair 5,5:6,6 7,7:8,8", "--pair 5,5:6,6 --pair 7,7:8,8"),
    ] {
        assert_eq!(whole(line).as_deref(), Some(expected), "{line}");
    }
    for line in [
        "text 40 mm",
        "warp a.svg --bend 40% b.svg",
        "affine --scale-x 2 a.svg",
        "mls --pin 0,0 a.svg",
        "text A --size",
    ] {
        assert_eq!(whole(line), None, "{line}");
    }
}

#[test]
fn options_by_their_beginning_and_other_names() {
    let known = ["scale-x", "scale-y", "skew-x", "rotate", "out"];
    let meant = |unknown: &str| option(unknown, &known);
    assert_eq!(meant("--scale"), "use --scale-x or --scale-y");
    assert_eq!(meant("--angle"), "use --rotate");
    assert_eq!(meant("--output"), "use --out");
    assert_eq!(meant("--height"), "use --scale-y 1.5 (a factor)");
    assert_eq!(meant("--skwe-x"), "use --skew-x");
    assert_eq!(meant("--wobble"), "--help lists the options");
}
