use super::*;

const UNITS: Units = Units { font: 10.0, root_font: 20.0, window: (300.0, 200.0), viewport: (100.0, 50.0) };

fn of(declared: &[(&str, &'static str)]) -> Option<Point> {
    let find = |name: &str| declared.iter().find(|d| d.0 == name).map(|d| d.1);
    let m = matrix(find, &UNITS, Rect::new(10.0, 20.0, 50.0, 100.0), false)?;
    let p = m * Point::new(1.0, 2.0);
    Some(Point::new((p.x * 1e9).round() / 1e9, (p.y * 1e9).round() / 1e9))
}

#[test]
fn transforms() {
    let at = |x, y| Some(Point::new(x, y));
    // About the corner (10, 20).
    assert_eq!(of(&[("transform", "rotate(90deg)")]), at(28.0, 11.0));
    assert_eq!(of(&[("transform", "rotate(0.25turn)"), ("transform-origin", "-10px -20px")]), at(-2.0, 1.0));
    assert_eq!(
        of(&[("transform", "translate(50%, 1em) scale(2)"), ("transform-origin", "-10px -20px")]),
        at(22.0, 14.0)
    );
    assert_eq!(of(&[("scale", "50%"), ("transform-origin", "center")]), at(15.5, 31.0));
    assert_eq!(of(&[("translate", "1px 2px"), ("rotate", "180deg"), ("transform-origin", "left top")]), at(20.0, 40.0));
    assert_eq!(of(&[("transform", "matrix(1 0 0 1 3 4), translateX(1px)")]), at(5.0, 6.0));
    assert_eq!(of(&[("transform", "none"), ("transform-origin", "top")]), at(1.0, 2.0));
    for bad in ["rotateX(3deg)", "scale(a)", "translate()", "perspective(3px)", "rotate(3xyz)", "x"] {
        assert_eq!(of(&[("transform", bad)]), None, "{bad}");
    }
}
