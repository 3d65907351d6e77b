use super::*;
use std::f64::consts::PI;

const UNITS: Units = Units { font: 10.0, root_font: 10.0, window: (100.0, 100.0), viewport: (100.0, 100.0) };

#[test]
fn lengths() {
    for (tag, attributes, wanted) in [
        ("rect", &[("width", "30"), ("height", "20")][..], 100.0),
        ("rect", &[("width", "30"), ("height", "20"), ("rx", "5")], 60.0 + 10.0 * PI),
        ("circle", &[("r", "10%")], 20.0 * PI),
        ("line", &[("x2", "3"), ("y1", "4")], 5.0),
        ("polyline", &[("points", "0,0 3 4 3,0")], 9.0),
        ("polygon", &[("points", "0,0 3 4 3,0")], 12.0),
        ("path", &[("d", "M0 0H10V10z A5 5 0 0 1 10 0")], 10.0 + 10.0 + 200_f64.sqrt() + 5.0 * PI),
    ] {
        let attr = |name: &str| attributes.iter().find(|a| a.0 == name).map(|a| a.1);
        let found = shape_length(tag, attr, &UNITS).unwrap();
        assert!((found - wanted).abs() < 1e-4, "{tag} {attributes:?}: {found}, not {wanted}");
    }
}
