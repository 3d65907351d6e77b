use super::*;

const UNITS: Units = Units { font: 10.0, root_font: 20.0, window: (300.0, 200.0), viewport: (100.0, 50.0) };

#[test]
fn expressions() {
    let cases = [
        ("calc(2px + 4px)", "6px"),
        ("calc(50% - 10px)", "40px"),
        ("3rem red 4px", "60px red 4px"),
        ("calc((1 + 2) * 1em / 2)", "15px"),
        ("min(3px, 1in) max(2px,1px)", "3px 2px"),
        ("clamp(1px, 10vw, 20px)", "20px"),
        ("calc(1 / 4)", "0.25"),
        ("light-dark(rgb(1,2,3), #fff)", "rgb(1,2,3)"),
        ("url(#a) 'calc(1px)' f(2rem)", "url(#a) 'calc(1px)' f(2rem)"),
        ("40Q 1ch", "37.795275590551185px 5px"),
    ];
    for (from, to) in cases {
        assert_eq!(computed(from, &UNITS, Some(100.0)).as_deref(), Some(to), "{from}");
    }
    for bad in ["calc(1px + 2)", "calc(1px * 1px)", "calc(1px / 0)", "calc()", "min()", "calc(1px 2px)"] {
        assert_eq!(computed(bad, &UNITS, Some(100.0)), None, "{bad}");
    }
    assert_eq!(computed("calc(1%)", &UNITS, None), None);
    assert_eq!(length("25%", &UNITS, 200.0), Some(50.0));
}

#[test]
fn variables() {
    let of = |value: &str| {
        let declared = [("--a", "1px"), ("--b", "var(--a)"), ("--c", "var(--d)"), ("--d", "var(--c)")];
        let declared: Vec<_> = declared.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
        let all = custom(&declared, &Custom::from([("--e".to_owned(), "x".into())]));
        substituted(value, &|n| all.get(n).map(ToString::to_string))
    };
    assert_eq!(of("a var( --b ) var(--e) b").as_deref(), Some("a 1px x b"));
    assert_eq!(of("var(--z, var(--y, f(1, 2)))").as_deref(), Some("f(1, 2)"));
    assert_eq!(of("var(--c)"), None);
    assert_eq!(of("var(--z)"), None);
    assert_eq!(of("var(--b").as_deref(), Some("1px"));
}

#[test]
fn variables_that_multiply_end() {
    let mut declared = vec![("--0".to_owned(), "x".repeat(100))];
    declared.extend((1..40).map(|i| (format!("--{i}"), format!("var(--{0})var(--{0})", i - 1))));
    let all = custom(&declared, &Custom::new());
    assert!(all.values().all(|v| v.len() <= MAX_LEN));
}

#[test]
fn plain_values() {
    for plain in ["red", "12px", "url(#rem)", "#1a2", "M1 2q3 4"] {
        assert!(is_plain(plain), "{plain}");
    }
    for other in ["2rem", "1.5em", "VAR(--x)", "calc(1px)", "10vw", "3.5Q", "1dvh"] {
        assert!(!is_plain(other), "{other}");
    }
}
