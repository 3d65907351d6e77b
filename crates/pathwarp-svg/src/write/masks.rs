//! Regions of masks after the warp.

use super::input::WriteInput;
use super::values::{part_box, stroke_scale};
use crate::bend::bends::Bend;
use crate::source::number::{path_data, short};
use pathwarp::kurbo::{Point, Rect, Shape as _};
use pathwarp::outline::Builder;
use pathwarp::refit;

/// Decimals of a region's warped border.
const DECIMALS: u8 = 9;

/// Points on each side of a region whose images are looked at.
const SAMPLES: usize = 16;

/// Attributes for the region of a mask, which covers all of its content after the warp.
pub(super) fn region(input: &WriteInput<'_>, i: usize) -> Vec<(&'static str, String)> {
    let m = &input.scene.masks[i];
    let mut area = m.rect;
    if input.changes(m.parts.clone()) {
        let from_root = input.written(m.slot, m.frame).inverse();
        for i in m.parts.clone() {
            let p = input.part(i);
            let to_frame = from_root * input.written(p.slot, p.frame);
            let warped = input.warped(i);
            let covered = match (&p.stroke, warped.and_then(|w| w.stroke.outline())) {
                (_, Some(outline)) => outline.bounding_box().abs(),
                (Some(s), None) => {
                    let width = f64::from(s.width().get()) * stroke_scale(warped);
                    let reach = width * f64::from(s.miterlimit().get());
                    part_box(p, warped).inflate(reach, reach)
                }
                (None, None) => part_box(p, warped),
            };
            area = area.union(to_frame.transform_rect_bbox(covered));
        }
        // A filter in the mask may fill the region.
        if let Some(Bend { map, .. }) = input.bend(m.parts.clone()) {
            let along = |i: usize, side: usize| {
                let a = i as f64 / SAMPLES as f64;
                let [x, y] = [[a, 0.0], [1.0, a], [a, 1.0], [0.0, a]][side];
                Point::new(m.rect.x0 + x * m.rect.width(), m.rect.y0 + y * m.rect.height())
            };
            let border = (0..4).flat_map(|side| (0..=SAMPLES).map(move |i| (i, side)));
            let seen = border.map(|(i, side)| from_root * map.point(m.frame * along(i, side)));
            area = seen.filter(|p| p.is_finite()).fold(area, |area, p| area.union_pt(p));
        }
        // A region larger than necessary only costs rendering time.
        let margin = 0.01 * area.width().max(area.height());
        area = area.inflate(margin, margin);
    }
    vec![
        ("maskUnits", "userSpaceOnUse".into()),
        ("x", short(area.x0)),
        ("y", short(area.y0)),
        ("width", short(area.width())),
        ("height", short(area.height())),
    ]
}

/// Path data for the warped border of a mask's region, if the border clips the content.
pub(super) fn edge(input: &WriteInput<'_>, i: usize) -> Option<String> {
    let m = &input.scene.masks[i];
    let inside = m.rect.union(m.content) == m.rect;
    if inside || !input.changes(m.parts.clone()) {
        return None;
    }
    let Bend { map, options } = input.bend(m.parts.clone())?;
    let border = border(m.rect).finish().transformed(m.frame).repeated(&options.copies);
    let warped = refit::warp_path(&border, *map, &options.refit).ok()?;
    let mut path = warped.path;
    path.apply_affine(input.written(m.slot, m.frame).inverse());
    Some(path_data(&path, DECIMALS))
}

fn border(r: Rect) -> Builder {
    let mut out = Builder::default();
    out.move_to((r.x0, r.y0).into());
    for p in [(r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)] {
        out.line_to(p.into());
    }
    out.close();
    out
}
