//! Arrays of points under a map: read and written in place, block by block, with any strides.

use numpy::ndarray::{ArrayView2, ArrayViewMut2, ArrayViewMut3, Axis};
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp_engine::PointMap;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Points mapped by one call of the map: few enough for the first cache.
const BLOCK: usize = 256;
/// Points that a thread takes at a time.
const CHUNK: usize = 16 * 1024;

/// An array of points.
pub(crate) type View<'a> = ArrayView2<'a, f64>;

/// Returns the bounding box of the finite points.
pub(crate) fn bounds(points: View<'_>) -> Option<Rect> {
    let mut all: Option<[f64; 4]> = None;
    for p in points.rows() {
        let (x, y) = (p[0], p[1]);
        if x.is_finite() && y.is_finite() {
            let [x0, y0, x1, y1] = all.unwrap_or([x, y, x, y]);
            all = Some([x0.min(x), y0.min(y), x1.max(x), y1.max(y)]);
        }
    }
    all.map(|[x0, y0, x1, y1]| Rect::new(x0, y0, x1, y1))
}

/// Maps `from` to `to`, which has its shape, or `to` in place without `from`. Points are left unmapped once `stop` is `true`.
pub(crate) fn map(map: &PointMap, from: Option<View<'_>>, mut to: ArrayViewMut2<'_, f64>, stop: &AtomicBool) {
    let to: Vec<_> = to.axis_chunks_iter_mut(Axis(0), CHUNK).collect();
    match from {
        Some(from) => {
            let from: Vec<_> = from.axis_chunks_iter(Axis(0), CHUNK).collect();
            from.into_par_iter().zip(to).for_each(|(from, to)| map_chunk(map, Some(from), to, stop));
        }
        None => to.into_par_iter().for_each(|to| map_chunk(map, None, to, stop)),
    }
}

/// Maps a chunk block by block.
fn map_chunk(map: &PointMap, from: Option<View<'_>>, mut to: ArrayViewMut2<'_, f64>, stop: &AtomicBool) {
    // A function of Python gets as many points as possible at once.
    let block = if map.prefers_batches() { CHUNK } else { BLOCK }.min(to.nrows().max(1));
    let (mut source, mut image) = (vec![Point::ORIGIN; block], vec![Point::ORIGIN; block]);
    for start in (0..to.nrows()).step_by(block) {
        if stop.load(Ordering::Relaxed) {
            return;
        }
        let rows = start..(start + block).min(to.nrows());
        let (source, image) = (&mut source[..rows.len()], &mut image[..rows.len()]);
        match &from {
            Some(from) => read(from.slice_axis(Axis(0), rows.clone().into()), source),
            None => read(to.slice_axis(Axis(0), rows.clone().into()), source),
        }
        map.points(source, image);
        let mut to = to.slice_axis_mut(Axis(0), rows.into());
        if let Some(flat) = to.as_slice_mut() {
            for (out, p) in flat.as_chunks_mut().0.iter_mut().zip(image) {
                *out = [p.x, p.y];
            }
        } else {
            for (mut out, p) in to.rows_mut().into_iter().zip(image) {
                (out[0], out[1]) = (p.x, p.y);
            }
        }
    }
}

fn read(from: View<'_>, points: &mut [Point]) {
    if let Some(flat) = from.as_slice() {
        for ([x, y], p) in flat.as_chunks().0.iter().zip(points) {
            *p = Point::new(*x, *y);
        }
    } else {
        for (row, p) in from.rows().into_iter().zip(points) {
            *p = Point::new(row[0], row[1]);
        }
    }
}

/// Writes the Jacobians at `points`: `out[i]` is [[∂x'/∂x, ∂x'/∂y], [∂y'/∂x, ∂y'/∂y]].
pub(crate) fn jacobian(map: &PointMap, points: View<'_>, mut out: ArrayViewMut3<'_, f64>, stop: &AtomicBool) {
    let block = if map.prefers_batches() { CHUNK } else { BLOCK };
    let out: Vec<_> = out.axis_chunks_iter_mut(Axis(0), block).collect();
    let points: Vec<_> = points.axis_chunks_iter(Axis(0), block).collect();
    points.into_par_iter().zip(out).for_each(|(points, mut out)| {
        if stop.load(Ordering::Relaxed) {
            return;
        }
        let (mut source, mut columns) = (vec![Point::ORIGIN; points.nrows()], vec![[Vec2::ZERO; 2]; points.nrows()]);
        read(points, &mut source);
        map.jacobians(&source, &mut columns);
        for (mut m, [dx, dy]) in out.outer_iter_mut().zip(&columns) {
            (m[[0, 0]], m[[0, 1]], m[[1, 0]], m[[1, 1]]) = (dx.x, dy.x, dx.y, dy.y);
        }
    });
}
