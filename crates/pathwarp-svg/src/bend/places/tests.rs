use super::*;
use pathwarp::kurbo::Shape as _;

/// Agrees with kurbo's winding numbers, computed point by point.
#[test]
fn places_inside_are_inside_and_evenly_spread() {
    for data in [
        "M0,0 H100 V80 H0 Z M20,20 V60 H80 V20 Z",
        "M50,0 C110,10 90,100 40,90 S-20,10 50,0 Z M30,30 h20 v20 h-20 Z",
        "M0,50 A50,50 0 1 1 100,50 A50,50 0 1 1 0,50 Z",
        "M0,0 L100,0 L0,70 L100,70",
    ] {
        let outline = Outline::from_svg(data).unwrap();
        let path = Outline::from_svg(&format!("{data} Z")).unwrap().to_bez_path(1e-6);
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let filled = |p: Point| {
                let w = path.winding(p);
                if rule == FillRule::EvenOdd { w % 2 != 0 } else { w != 0 }
            };
            let bounds = outline.bounding_box().unwrap();
            let every = lattice(&[], bounds, rule, TRIED);
            assert!(every.is_empty());
            let found = inside(&outline, rule, false);
            let wrong = found.iter().filter(|p| !filled(**p)).count();
            assert!(wrong <= found.len() / 100, "{data}: {wrong} of {}", found.len());
            // Their share is that of the area.
            let fine = 200 * 200;
            let at = |k: u32| {
                bounds.origin()
                    + Vec2::new(
                        bounds.width() * (f64::from(k % 200) + 0.5) / 200.0,
                        bounds.height() * (f64::from(k / 200) + 0.5) / 200.0,
                    )
            };
            let area = f64::from((0..fine).filter(|k| filled(at(*k))).count() as u32) / f64::from(fine);
            let share = found.len() as f64 / TRIED as f64;
            assert!((share - area).abs() < 0.02, "{data}: {share} for {area}");
        }
    }
}

#[test]
fn thin_shapes_are_sampled_more_densely() {
    let sliver = Outline::from_svg("M0,0 L100,100 L100,101 L0,1 Z").unwrap();
    let found = inside(&sliver, FillRule::NonZero, false);
    assert!(found.len() > 40, "{}", found.len());
    assert!(found.iter().all(|p| p.y - p.x > -0.01 && p.y - p.x < 1.01));
}

#[test]
fn strokes_are_sampled_along_their_path() {
    let path = Outline::from_svg("M0,0 H100 V50").unwrap();
    let found = along(&path, 4.0);
    assert_eq!(found.len(), ALONG);
    assert!(found.iter().all(|p| (p.y.abs() <= 2.0 && p.x <= 100.0) || (p.x - 100.0).abs() <= 2.0));
    let down = found.iter().filter(|p| p.y > 2.0).count();
    assert!((down as f64 / ALONG as f64 - 48.0 / 150.0).abs() < 0.03, "{down}");
    assert!(along(&Outline::from_svg("M5,5").unwrap(), 1.0).is_empty());
}
