use super::*;
use pathwarp::Seg;

fn read(shape: &str) -> (SourceText, Size) {
    let s =
        SourceText::parse(format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 100'>{shape}</svg>"), "t")
            .unwrap();
    (s, Size::new(200.0, 100.0))
}

fn outline(shape: &str) -> Option<Outline> {
    let (source, page) = read(shape);
    GeometryReader { source: &source, dpi: 96.0, page }.outline(1)
}

#[test]
fn circles_are_four_true_quarters_from_three_oclock() {
    let o = outline("<circle cx='50%' cy='5mm' r='10'/>").unwrap();
    let segs: Vec<_> = o.segs().collect();
    assert_eq!(segs.len(), 4);
    assert!(segs.iter().all(|s| matches!(s, Seg::Arc(_))));
    assert_eq!(segs[0].start(), Point::new(110.0, 5.0 * 96.0 / 25.4));
    assert!(segs[0].end().y > segs[0].start().y);
}

#[test]
fn rect_corners_follow_the_specification() {
    let o = outline("<rect width='40' height='20' rx='30' ry='5'/>").unwrap();
    assert_eq!(o.subpaths[0].start, Point::new(20.0, 0.0));
    let b = o.bounding_box().unwrap();
    assert!((b.x0 + b.y0).abs() < 1e-12 && (b.x1 - 40.0).abs() < 1e-12 && (b.y1 - 20.0).abs() < 1e-12);
    assert_eq!(o.segs().filter(|s| matches!(s, Seg::Arc(_))).count(), 4);
    assert!(outline("<rect width='40' height='-1'/>").is_none());
    assert!(outline("<rect width='4em' height='1'/>").is_none());
}
