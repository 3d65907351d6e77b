//! Artwork that the page cuts: the frame holds what is seen, and the rest follows the map beyond the frame, where many maps grow fast.

use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::Map;

/// Samples of a side of a box.
const SAMPLES: u32 = 16;
/// Shortest length beyond the frame that counts, relative to the frame's diagonal.
const FAR: f64 = 0.02;
/// Smallest ratio that is worth a warning.
const STRETCHED: f64 = 3.0;

/// Compares how much the map stretches the artwork between the frame and the edge of `uncut` with how much it stretches the frame. Returns
/// the ratio if it is large. Does not ask maps that are other programs: they may fail at points that no shape has.
pub(super) fn stretch(map: &dyn Map, frame: Rect, uncut: Rect) -> Option<f64> {
    if map.prefers_batches() {
        return None;
    }
    let size = frame.size().to_vec2().hypot();
    let of_frame = image_size(map, frame)? / size;
    let stretch = edge(uncut).filter_map(|p| {
        let inside = Point::new(p.x.clamp(frame.x0, frame.x1), p.y.clamp(frame.y0, frame.y1));
        let length = p.distance(inside);
        (length > FAR * size).then(|| map.point(p).distance(map.point(inside)) / length / of_frame)
    });
    let most = stretch.filter(|s| s.is_finite()).fold(0.0, f64::max);
    (most > STRETCHED).then_some(most)
}

/// The diagonal of the image of a box.
fn image_size(map: &dyn Map, rect: Rect) -> Option<f64> {
    let image = edge(rect).map(|p| map.point(p)).filter(|p| p.is_finite());
    let bounds = image.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))?;
    Some(bounds.size().to_vec2().hypot()).filter(|d| *d > 0.0)
}

/// Points around a box.
fn edge(r: Rect) -> impl Iterator<Item = Point> {
    (0..SAMPLES).flat_map(move |i| {
        let t = f64::from(i) / f64::from(SAMPLES);
        let (x, y) = (r.x0 + t * r.width(), r.y0 + t * r.height());
        [
            Point::new(x, r.y0),
            Point::new(r.x1, y),
            Point::new(r.x1 - t * r.width(), r.y1),
            Point::new(r.x0, r.y1 - t * r.height()),
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::kurbo::Vec2;
    use pathwarp::map::Jet;

    /// (x, y) ↦ (x, y + x³/100²).
    struct Cubic;

    impl Map for Cubic {
        fn jet(&self, p: Point) -> Jet {
            let steep = 3.0 * p.x * p.x / 1e4;
            Jet { p: Point::new(p.x, p.y + p.x.powi(3) / 1e4), dx: Vec2::new(1.0, steep), dy: Vec2::new(0.0, 1.0) }
        }
    }

    #[test]
    fn only_growth_far_outside_counts() {
        let frame = Rect::new(0.0, 0.0, 100.0, 100.0);
        let beyond = |x1| stretch(&Cubic, frame, Rect { x1, ..frame });
        assert_eq!([beyond(100.0), beyond(102.0)], [None, None]);
        // From 100 to 300 the cubic rises by 2,600; the frame's diagonal grows from 141 to 224.
        let wanted = 200f64.hypot(2600.0) / 200.0 / (100f64.hypot(200.0) / 100f64.hypot(100.0));
        assert!((beyond(300.0).unwrap() - wanted).abs() < 0.1);
        let larger = pathwarp::map::AffineMap(pathwarp::kurbo::Affine::scale(7.0));
        assert_eq!(stretch(&larger, frame, Rect::new(-900.0, -900.0, 900.0, 900.0)), None);
    }
}
