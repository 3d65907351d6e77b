//! Bends mesh gradients. A mesh is cut along lines of constant u and v until the Coons patch over the bent sides of each piece is within
//! the tolerance of the piece's image. Each bent side is the Hermite cubic with the ends and derivatives of the image.

use super::pictures::PictureError;
use super::task::PartTask;
use crate::source::mesh::{MeshGradient, coons};
use pathwarp::budget::cost;
use pathwarp::kurbo::Point;
use pathwarp::map::{Jet, Map};

/// Limit on the patches that cuts add to a mesh.
const MAX_PATCHES: usize = 4096;
/// Parameters of a patch at which it is compared with the image.
const SAMPLES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Work of a patch, whose samples are compared and whose sides are computed and written.
const PATCH_WORK: f64 = (SAMPLES.len() * SAMPLES.len()) as f64 + 4.0 * cost::SEGMENT;
/// Largest difference of bilinear colours from smooth ones: half of a noticeable one.
const COLOR_TOLERANCE: f64 = 4.0 / 255.0;

/// The image of a mesh gradient on a part, in the part's user space as written.
pub(super) fn bend_mesh(t: &PartTask<'_>, mesh: &MeshGradient) -> Result<MeshGradient, PictureError> {
    let bounds = t.part.local.bounding_box().unwrap_or_default();
    let source = mesh.on(bounds).transformed(t.part.frame);
    let spend = |work: f64| t.options().refit.budget.spend(work).is_ok();
    image(&source, t.context.map, t.finest, spend).map(|m| m.transformed(t.back))
}

/// The image of a mesh within a tolerance. `spend` takes work from the budget and returns `true` if it may be done.
fn image(
    source: &MeshGradient,
    map: &dyn Map,
    tolerance: f64,
    spend: impl Fn(f64) -> bool,
) -> Result<MeshGradient, PictureError> {
    let limit = MAX_PATCHES + source.rows() * source.columns();
    let mut grid = Grid { source, u: cuts(source.columns()), v: cuts(source.rows()) };
    loop {
        let patches = grid.columns() * grid.rows();
        if patches > limit || !spend(patches as f64 * PATCH_WORK) {
            return Err("its mesh would take too many patches".into());
        }
        // Once it is cut, a mesh of smooth colours gets bilinear ones that look alike.
        let cut = patches > source.rows() * source.columns();
        let image = MeshGradient { smooth: source.smooth && !cut, ..grid.image(map) };
        let Some([u, v]) = grid.too_coarse(&image, map, tolerance) else {
            return Err("the map is not defined on all of its mesh".into());
        };
        if !u.contains(&true) && !v.contains(&true) {
            return Ok(image);
        }
        (grid.u, grid.v) = (halve(&grid.u, &u), halve(&grid.v, &v));
    }
}

/// A mesh with its cuts: parameters of the whole mesh, in which each patch of the source has length 1.
struct Grid<'a> {
    source: &'a MeshGradient,
    u: Vec<f64>,
    v: Vec<f64>,
}

impl Grid<'_> {
    fn columns(&self) -> usize {
        self.u.len() - 1
    }

    fn rows(&self) -> usize {
        self.v.len() - 1
    }

    /// The image, with a Hermite cubic for each side.
    fn image(&self, map: &dyn Map) -> MeshGradient {
        self.source.cut(&self.u, &self.v, |ends| {
            // The ends of all sides, each with the handle there.
            let points: Vec<Point> = ends.iter().map(|e| e.0).collect();
            let mut jets = vec![Jet::UNDEFINED; points.len()];
            map.jets(&points, &mut jets);
            jets.iter().zip(ends).map(|(jet, end)| (jet.p, jet.push(end.1))).collect()
        })
    }

    /// For each column and each row of an image, `true` if it is too coarse. Returns `None` where the map is undefined.
    fn too_coarse(&self, image: &MeshGradient, map: &dyn Map, tolerance: f64) -> Option<[Vec<bool>; 2]> {
        let lattice = || SAMPLES.iter().flat_map(|y| SAMPLES.iter().map(|x| (*x, *y)));
        let cells = || (0..self.rows()).flat_map(|i| (0..self.columns()).map(move |k| (i, k)));
        let between = |c: &[f64], t: f64| c[0] + t * (c[1] - c[0]);
        let in_cell = |(i, k): (usize, usize), (x, y)| [between(&self.u[k..], x), between(&self.v[i..], y)];
        let point = |cell: (usize, usize), xy| {
            let [u, v] = in_cell(cell, xy);
            // The corner of the cell selects the patch of the source, where u or v is on a crease between two.
            self.source.point(u, v, [self.u[cell.1], self.v[cell.0]]).at
        };
        let point = &point;
        let points: Vec<Point> = cells().flat_map(|cell| lattice().map(move |xy| point(cell, xy))).collect();
        let mut images = points.clone();
        map.points(&points, &mut images);
        let (mut columns, mut rows) = (vec![false; self.columns()], vec![false; self.rows()]);
        for ((i, k), exact) in cells().zip(images.chunks_exact(SAMPLES.len().pow(2))) {
            let sides = [image.across[i][k], image.down[i][k + 1], image.across[i + 1][k], image.down[i][k]];
            // Largest errors of the sides along u and along v, and inside; 1 is the limit.
            let [mut along_u, mut along_v, mut inside] = [0.0_f64; 3];
            for ((x, y), exact) in lattice().zip(exact) {
                let mut error = coons(sides, x, y).at.distance(*exact) / tolerance;
                if !error.is_finite() {
                    return None;
                }
                if self.source.smooth && !image.smooth {
                    let [u, v] = in_cell((i, k), (x, y));
                    let colors = [image.color(k as f64 + x, i as f64 + y), self.source.color(u, v)];
                    error = (0..4).map(|n| (colors[0][n] - colors[1][n]).abs() / COLOR_TOLERANCE).fold(error, f64::max);
                }
                let is_rim = |t: f64| t == 0.0 || t == 1.0;
                let worst = match (is_rim(x), is_rim(y)) {
                    (_, true) => &mut along_u,
                    (true, false) => &mut along_v,
                    (false, false) => &mut inside,
                };
                *worst = worst.max(error);
            }
            let only_inside = inside > 1.0 && along_u.max(along_v) <= 1.0;
            columns[k] |= only_inside || along_u > 1.0;
            rows[i] |= only_inside || along_v > 1.0;
        }
        Some([columns, rows])
    }
}

fn cuts(patches: usize) -> Vec<f64> {
    (0..=patches).map(|i| i as f64).collect()
}

/// The cuts with another one in the middle of each interval that is too coarse.
fn halve(cuts: &[f64], too_coarse: &[bool]) -> Vec<f64> {
    let mut all = cuts.to_vec();
    all.extend(cuts.windows(2).zip(too_coarse).filter(|(_, coarse)| **coarse).map(|(c, _)| 0.5 * (c[0] + c[1])));
    all.sort_by(f64::total_cmp);
    all
}
