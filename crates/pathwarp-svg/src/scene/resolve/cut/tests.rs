use super::*;
use pathwarp::kurbo::Shape as _;

/// Winding numbers are unchanged inside and zero outside.
#[test]
fn the_inside_keeps_its_windings() {
    let area = Rect::new(2.0, 1.0, 9.0, 8.0);
    for d in [
        "M5,4 m-6,0 a6,6 0 1 1 12,0 a6,6 0 1 1 -12,0 Z",
        "M0,0 L10,0 L10,10 L0,10 Z M3,3 L3,20 L20,20 L20,3 Z M4,4 L5,4 L5,5 Z",
        "M-3,5 C20,-30 -12,40 14,4 Q4,20 5,-5 L-9,2",
        "M2,1 L9,1 L9,8 L2,8 Z M0,1 L12,1 L12,8 L0,8 Z",
        "M20,20 L30,20 L30,30 Z",
    ] {
        let outline = Outline::from_svg(d).unwrap();
        let cut = within(&outline, area, 1e-9).to_bez_path(1e-9);
        let mut whole = outline.to_bez_path(1e-9);
        if !d.ends_with('Z') {
            whole.close_path();
        }
        let mut seen = 0;
        for k in 0..60 * 60 {
            let p = Point::new(f64::from(k % 60) * 0.2031 - 1.0, f64::from(k / 60) * 0.1973 - 1.0);
            let wanted = if area.contains(p) { whole.winding(p) } else { 0 };
            assert_eq!(cut.winding(p), wanted, "{d} at {p:?}");
            seen += usize::from(wanted != 0);
        }
        assert!(seen > 50 || d.starts_with("M20"), "{d}");
        let b = cut.bounding_box();
        assert!(
            cut.elements().is_empty()
                || area.union(b) == area
                || area.inflate(1e-9, 1e-9).union(b) == area.inflate(1e-9, 1e-9)
        );
    }
}

/// Outlines inside the box are unchanged, arcs included.
#[test]
fn nothing_to_cut() {
    let o = Outline::from_svg("M4,4 a2,2 0 1 1 4,0 Z").unwrap();
    assert_eq!(within(&o, Rect::new(0.0, 0.0, 10.0, 10.0), 1e-9), o);
}
