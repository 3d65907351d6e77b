use super::*;
use pathwarp::Outline;

#[test]
fn only_stubs_are_dropped() {
    for (d, shortest, segments) in [
        ("M0 0C5 5 9 5 9 0L1e-9 1e-9Z", 1e-6, 2),
        ("M0 0C5 5 9 5 9 0L1e-9 1e-9Z", 1e-10, 3),
        ("M0 0C5 5 9 5 9 0L1e-9 1e-9", 1e-6, 2),
        ("M0 0C5 5 9 5 9 0Z", 1e-6, 2),
        ("M0 0A5 5 0 0 1 9 1A5 5 0 0 1 1e-9 1e-9Z", 1e-6, 2),
        ("M0 0L1e-9 0Z", 1e-6, 1),
    ] {
        let mut s = Outline::from_svg_lossy(d).subpaths.remove(0);
        drop_closing_stub(&mut s, shortest);
        assert_eq!(s.segs.len(), segments, "{d}");
        assert!(!s.closed || s.end() == s.start, "{d}");
    }
}
