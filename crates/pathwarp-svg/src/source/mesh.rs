//! Reads Inkscape's mesh gradients: grids of Coons patches with a colour at each corner (SVG 2, drafts up to 2016, “Mesh Gradients”).
//!
//! Between the cubics T(u) above, B(u) below, L(v) on the left and R(v) on the right, the patch over [0, 1]² is
//!
//! S(u, v) = (1 − v) T(u) + v B(u) + (1 − u) L(v) + u R(v) − Q(u, v)
//!
//! where Q interpolates the four corners bilinearly. Any rectangle cut out of a patch along lines of constant u and v is the Coons patch
//! over its four sides.

use super::elements::{XLINK, declared, parse_transform};
use pathwarp::kurbo::{Affine, CubicBez, ParamCurve as _, ParamCurveDeriv as _, Point, Rect, Vec2};
use std::collections::HashMap;
use std::str::FromStr as _;
use svgtypes::NumberListParser;
use usvg::roxmltree::{Document, Node};

/// Red, green, blue and opacity, 0 to 1, not premultiplied.
pub(crate) type Rgba = [f64; 4];

/// A Coons patch: the control points of its sides, which lead around it from corner to corner, and the colours of the corners in this
/// order: red, green, blue and opacity, 0 to 1, bilinear between them.
#[cfg(feature = "usvg")]
pub type CoonsPatch = ([Point; 12], [[f64; 4]; 4]);

/// A mesh gradient. The patch in row r and column c lies between `across[r][c]` above and `across[r + 1][c]` below, which lead to the
/// right, and `down[r][c]` and `down[r][c + 1]`, which lead down.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MeshGradient {
    pub(crate) across: Vec<Vec<CubicBez>>,
    pub(crate) down: Vec<Vec<CubicBez>>,
    /// Colours of the corners, by rows.
    pub(crate) colors: Vec<Vec<Rgba>>,
    /// `true` if colours change smoothly from patch to patch (`type="bicubic"`).
    pub(crate) smooth: bool,
    /// `true` if coordinates are fractions of the painted shape's box.
    pub(crate) in_box: bool,
}

/// The point of a patch and its derivatives by u and v.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PatchPoint {
    pub(crate) at: Point,
    pub(crate) du: Vec2,
    pub(crate) dv: Vec2,
}

impl MeshGradient {
    pub(crate) fn rows(&self) -> usize {
        self.down.len()
    }

    pub(crate) fn columns(&self) -> usize {
        self.across[0].len()
    }

    /// The image of the mesh under an affine map.
    pub(crate) fn transformed(&self, by: Affine) -> Self {
        let image = |sides: &[Vec<CubicBez>]| sides.iter().map(|row| row.iter().map(|s| by * *s).collect()).collect();
        Self { across: image(&self.across), down: image(&self.down), colors: self.colors.clone(), ..*self }
    }

    /// The mesh in the user space of a shape with the box `bounds`.
    pub(crate) fn on(&self, bounds: Rect) -> Self {
        if !self.in_box {
            return self.clone();
        }
        let size = Affine::scale_non_uniform(bounds.width(), bounds.height());
        Self { in_box: false, ..self.transformed(Affine::translate(bounds.origin().to_vec2()) * size) }
    }

    /// The point with the parameters `u` and `v` in the patch of a row and column, extrapolated beyond [0, 1].
    fn point_in_patch(&self, row: usize, column: usize, u: f64, v: f64) -> PatchPoint {
        let (top, bottom) = (self.across[row][column], self.across[row + 1][column]);
        let (left, right) = (self.down[row][column], self.down[row][column + 1]);
        coons([top, right, bottom, left], u, v)
    }

    /// The point with the parameters `u` and `v` of the whole mesh, in which each patch has length 1, with the derivatives in the patch
    /// that contains the parameters `column` and `row`: those of neighbours differ on their common side.
    pub(crate) fn point(&self, u: f64, v: f64, [column, row]: [f64; 2]) -> PatchPoint {
        let [column, row] = self.patch_at(column, row);
        self.point_in_patch(row, column, u - column as f64, v - row as f64)
    }

    /// The column and row of the patch that contains the parameters `u` and `v` of the whole mesh.
    fn patch_at(&self, u: f64, v: f64) -> [usize; 2] {
        [(u as usize).min(self.columns() - 1), (v as usize).min(self.rows() - 1)]
    }

    /// The image of the mesh cut at these parameters, with bilinear colours. `image` maps points with vectors at them.
    pub(crate) fn cut(&self, u: &[f64], v: &[f64], image: impl Fn(&[(Point, Vec2)]) -> Vec<(Point, Vec2)>) -> Self {
        // The ends of each side with the vectors from them to its handles, up to sign: first of the sides along u, then along v.
        let mut ends: Vec<(Point, Vec2)> = Vec::new();
        for v in v {
            for pair in u.windows(2) {
                let third = (pair[1] - pair[0]) / 3.0;
                let end = |&u: &f64| self.point(u, *v, [pair[0], *v]);
                ends.extend(pair.iter().map(end).map(|s| (s.at, third * s.du)));
            }
        }
        for pair in v.windows(2) {
            let third = (pair[1] - pair[0]) / 3.0;
            for u in u {
                let end = |&v: &f64| self.point(*u, v, [*u, pair[0]]);
                ends.extend(pair.iter().map(end).map(|s| (s.at, third * s.dv)));
            }
        }
        let images = image(&ends);
        let side = |k: usize| {
            let [from, to] = [images[2 * k], images[2 * k + 1]];
            CubicBez::new(from.0, from.0 + from.1, to.0 - to.1, to.0)
        };
        let (columns, rows) = (u.len() - 1, v.len() - 1);
        let row_of_sides = |first: usize, count: usize| (first..first + count).map(side).collect();
        let across = (0..=rows).map(|i| row_of_sides(i * columns, columns)).collect();
        let first_down = columns * (rows + 1);
        let down = (0..rows).map(|i| row_of_sides(first_down + i * (columns + 1), columns + 1));
        let colors = v.iter().map(|v| u.iter().map(|u| self.color(*u, *v)).collect()).collect();
        Self { across, down: down.collect(), colors, smooth: false, in_box: false }
    }

    /// The patches. Patches with smooth colours are cut until bilinear colours look smooth.
    #[cfg(feature = "usvg")]
    pub(crate) fn patches(&self) -> Vec<CoonsPatch> {
        /// Parts of a patch with smooth colours along each side, as in Inkscape.
        const PARTS: usize = 8;
        if self.smooth {
            let cuts = |n: usize| (0..=n * PARTS).map(|k| k as f64 / PARTS as f64).collect::<Vec<f64>>();
            return self.cut(&cuts(self.columns()), &cuts(self.rows()), <[_]>::to_vec).patches();
        }
        let patch = |r: usize, c: usize| {
            let [below, left] = [self.across[r + 1][c], self.down[r][c]].map(reversed);
            let around = [self.across[r][c], self.down[r][c + 1], below, left].map(|side| [side.p0, side.p1, side.p2]);
            let colors = [(r, c), (r, c + 1), (r + 1, c + 1), (r + 1, c)].map(|(r, c)| self.colors[r][c]);
            (std::array::from_fn(|k| around[k / 3][k % 3]), colors)
        };
        (0..self.rows()).flat_map(|r| (0..self.columns()).map(move |c| (r, c))).map(|(r, c)| patch(r, c)).collect()
    }

    /// The colour at the parameters `u` and `v` of the whole mesh, in which each patch has length 1: bilinear between the corners of a
    /// patch, or bicubic as in Inkscape, in Hermite form with mixed derivatives of zero. Opacity is always bilinear.
    pub(crate) fn color(&self, u: f64, v: f64) -> Rgba {
        let [column, row] = self.patch_at(u, v);
        let (s, t) = (u - column as f64, v - row as f64);
        let linear = ([1.0 - s, s, 0.0, 0.0], [1.0 - t, t, 0.0, 0.0]);
        let (along_u, along_v) = if self.smooth { (hermite(s), hermite(t)) } else { linear };
        let mut out = [0.0; 4];
        // The corner in row `row` + i and column `column` + k.
        for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (r, c) = (row + i, column + k);
            let (wide, high) = (length(self.across[r][column]), length(self.down[row][c]));
            let add = |weight: f64, color: Rgba, out: &mut Rgba| (0..3).for_each(|n| out[n] += weight * color[n]);
            out[3] += linear.0[k] * linear.1[i] * self.colors[r][c][3];
            add(along_u[k] * along_v[i], self.colors[r][c], &mut out);
            if self.smooth {
                let du = slope(self.columns(), c, |n| self.colors[r][n], |n| length(self.across[r][n]));
                let dv = slope(self.rows(), r, |n| self.colors[n][c], |n| length(self.down[n][c]));
                add(along_u[2 + k] * along_v[i] * wide, du, &mut out);
                add(along_u[k] * along_v[2 + i] * high, dv, &mut out);
            }
        }
        out.map(|level| level.clamp(0.0, 1.0))
    }
}

/// The weights of a cubic's values at 0 and 1, and of its derivatives there, in its value at `t`.
fn hermite(t: f64) -> [f64; 4] {
    let rest = 1.0 - t;
    [rest * rest * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t), t * rest * rest, -t * t * rest]
}

/// The distance between a side's ends.
fn length(side: CubicBez) -> f64 {
    side.p0.distance(side.p3)
}

/// The change of colours per unit of length at corner `i` of `last` + 1, as in Inkscape: inside a row, the mean of the steps before and
/// after, at most three times either, and 0 at an extremum; at an end, the value whose mean with the neighbour's is the step between them.
fn slope(last: usize, i: usize, color: impl Fn(usize) -> Rgba, length: impl Fn(usize) -> f64) -> Rgba {
    std::array::from_fn(|n| {
        let step = |k: usize| {
            let length = length(k);
            if length > 0.0 { (color(k + 1)[n] - color(k)[n]) / length } else { 0.0 }
        };
        let inner = |k: usize| monotone(step(k - 1), step(k));
        match (i, last) {
            // In a row of one patch, the ends are neighbours. Inkscape sets the first one while the last is still 0.
            (0, 1) => 2.0 * step(0),
            (_, 1) => 0.0,
            (0, _) => 2.0 * step(0) - inner(1),
            _ if i == last => 2.0 * step(last - 1) - inner(last - 1),
            _ => inner(i),
        }
    })
}

/// The point of a Coons patch with the sides top, right, bottom and left, of which the first and third lead to the right, the others down.
pub(crate) fn coons([top, right, bottom, left]: [CubicBez; 4], u: f64, v: f64) -> PatchPoint {
    let at = |c: CubicBez, t: f64| c.eval(t).to_vec2();
    let slope = |c: CubicBez, t: f64| c.deriv().eval(t).to_vec2();
    let corners = [top.p0, top.p3, bottom.p0, bottom.p3].map(Point::to_vec2);
    let q = |u: f64, v: f64| corners[0].lerp(corners[1], u).lerp(corners[2].lerp(corners[3], u), v);
    let s = at(top, u).lerp(at(bottom, u), v) + at(left, v).lerp(at(right, v), u) - q(u, v);
    let du = slope(top, u).lerp(slope(bottom, u), v) + at(right, v) - at(left, v) - (q(1.0, v) - q(0.0, v));
    let dv = slope(left, v).lerp(slope(right, v), u) + at(bottom, u) - at(top, u) - (q(u, 1.0) - q(u, 0.0));
    PatchPoint { at: s.to_point(), du, dv }
}

/// The slope between two steps of a monotone cubic spline: their mean, at most three times either, and 0 at an extremum.
fn monotone(before: f64, after: f64) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let most = 3.0 * before.abs().min(after.abs());
    (0.5 * (before + after)).clamp(-most, most)
}

/// Returns `true` for the tag of a mesh gradient, which has been spelled in several ways.
pub(crate) fn is_mesh(tag: &str) -> bool {
    matches!(tag, "meshgradient" | "meshGradient" | "mesh")
}

/// Reads the complete mesh gradients of a drawing, by their ids.
pub(super) fn read(doc: &Document<'_>) -> HashMap<String, MeshGradient> {
    /// Limit on the patches of gradients that copy them from others.
    const MAX_COPIED: usize = 100_000;
    /// Limit on the elements in a chain of links, which may form a circle.
    const MAX_CHAIN: usize = 16;
    let mut out = HashMap::new();
    if !doc.input_text().contains("mesh") {
        return out;
    }
    let has_id = |n: &Node<'_, '_>| n.attribute("id").is_some_and(|id| !id.is_empty());
    let all: Vec<Node<'_, '_>> = doc.descendants().filter(|n| is_mesh(n.tag_name().name()) && has_id(n)).collect();
    let by_id: HashMap<&str, Node<'_, '_>> = all.iter().filter_map(|n| Some((n.attribute("id")?, *n))).collect();
    let mut copied = 0;
    for node in &all {
        let mut chain = vec![*node];
        while let Some(next) = chain.last().and_then(|n| by_id.get(link(*n)?)).filter(|_| chain.len() < MAX_CHAIN) {
            chain.push(*next);
        }
        if (chain.len() == 1 || copied < MAX_COPIED)
            && let Some(id) = node.attribute("id")
            && let Some(mesh) = gradient(&chain)
        {
            copied += if chain.len() > 1 { mesh.rows() * mesh.columns() } else { 0 };
            out.insert(id.to_owned(), mesh);
        }
    }
    out
}

/// The id to which an element refers.
fn link<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    node.attribute("href").or_else(|| node.attribute((XLINK, "href")))?.trim().strip_prefix('#')
}

/// Reads a gradient from the chain of elements that begins with it and follows its references.
fn gradient(chain: &[Node<'_, '_>]) -> Option<MeshGradient> {
    let first = *chain.first()?;
    // As in Inkscape, only patches and units come from elements to which the first one refers.
    let length = |name: &str| first.attribute(name).map_or(Some(0.0), |v| v.trim().parse::<f64>().ok());
    let transform = first.attribute("gradientTransform").map_or(Some(Affine::IDENTITY), parse_transform)?;
    let units = chain.iter().find_map(|n| n.attribute("gradientUnits"));
    let rows = chain.iter().map(|n| children(*n, "meshrow")).find(|rows| !rows.is_empty())?;
    let mut mesh = MeshGradient {
        across: Vec::new(),
        down: Vec::new(),
        colors: Vec::new(),
        smooth: first.attribute("type").is_some_and(|t| t.trim() == "bicubic"),
        in_box: units.is_none_or(|u| u.trim() != "userSpaceOnUse"),
    };
    let mut start = Point::new(length("x")?, length("y")?);
    for row in rows {
        start = push_row(&mut mesh, &children(row, "meshpatch"), start)?;
    }
    let columns = mesh.columns();
    let is_grid = columns > 0 && mesh.across.iter().all(|row| row.len() == columns);
    let is_finite = mesh.across.iter().chain(&mesh.down).flatten().all(CubicBez::is_finite);
    (is_grid && is_finite).then(|| mesh.transformed(transform))
}

/// The children with a tag, whose letters may be of either case.
fn children<'a, 'i>(node: Node<'a, 'i>, tag: &str) -> Vec<Node<'a, 'i>> {
    node.children().filter(|c| c.tag_name().name().eq_ignore_ascii_case(tag)).collect()
}

/// Reads a row of patches. Each patch lists the sides that no earlier patch has, clockwise from the top, with the colour of the corner at
/// which a side begins. The first row begins at `start`, others below the last one. Returns the row's lower left corner.
fn push_row(mesh: &mut MeshGradient, patches: &[Node<'_, '_>], start: Point) -> Option<Point> {
    let first_row = mesh.across.is_empty();
    if first_row {
        mesh.across.push(Vec::new());
        mesh.colors.push(Vec::new());
    }
    let above = mesh.across.len() - 1;
    let (mut below, mut down, mut colors) = (Vec::new(), Vec::new(), Vec::new());
    for (c, &patch) in patches.iter().enumerate() {
        let stops = children(patch, "stop");
        let mut stops = stops.into_iter();
        if first_row {
            let stop = stops.next()?;
            let from = mesh.across[0].last().map_or(start, |before: &CubicBez| before.p3);
            mesh.across[0].push(side(stop, from, None)?);
            if c == 0 {
                mesh.colors[0].push(color(stop)?);
            }
        }
        let top = *mesh.across[above].get(c)?;
        let stop = stops.next()?;
        let right = side(stop, top.p3, None)?;
        if first_row {
            mesh.colors[0].push(color(stop)?);
        }
        let stop = stops.next()?;
        let corner = down.last().map(|left: &CubicBez| left.p3);
        let bottom = side(stop, right.p3, corner)?;
        let right_color = color(stop)?;
        if c == 0 {
            let stop = stops.next()?;
            down.push(reversed(side(stop, bottom.p3, Some(top.p0))?));
            colors.push(color(stop)?);
        }
        colors.push(right_color);
        down.push(right);
        below.push(reversed(bottom));
    }
    let next = down.first()?.p3;
    mesh.across.push(below);
    mesh.down.push(down);
    mesh.colors.push(colors);
    Some(next)
}

/// The cubic run through backwards.
pub(crate) fn reversed(c: CubicBez) -> CubicBez {
    CubicBez::new(c.p3, c.p2, c.p1, c.p0)
}

/// Reads the side that a stop describes: a line or a cubic from `from`. The path may omit its end if that is known (`end`).
fn side(stop: Node<'_, '_>, from: Point, end: Option<Point>) -> Option<CubicBez> {
    /// Numbers of a cubic, the longest command.
    const LONGEST: usize = 6;
    let path = stop.attribute("path")?.trim();
    let kind = path.chars().next()?;
    let numbers = NumberListParser::from(&path[kind.len_utf8()..]).take(LONGEST + 1);
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().ok()?;
    let base = if kind.is_ascii_lowercase() { from.to_vec2() } else { Vec2::ZERO };
    let points: Vec<Point> = numbers.chunks_exact(2).map(|p| Point::new(p[0], p[1]) + base).collect();
    let cubic = |a: Point, b: Point, to: Point| CubicBez::new(from, a, b, to);
    let line = |to: Point| cubic(from.lerp(to, 1.0 / 3.0), from.lerp(to, 2.0 / 3.0), to);
    match (kind.to_ascii_lowercase(), points.as_slice(), end) {
        ('l' | 'z', _, Some(end)) | ('l', &[end], None) => Some(line(end)),
        ('c', &[a, b] | &[a, b, _], Some(end)) | ('c', &[a, b, end], None) => Some(cubic(a, b, end)),
        _ => None,
    }
}

/// The colour of a stop, with its opacity.
fn color(stop: Node<'_, '_>) -> Option<Rgba> {
    let inherited = || stop.ancestors().find_map(|a| property(a, "color"));
    let text = match property(stop, "stop-color") {
        Some("currentColor") => inherited(),
        other => other,
    };
    let c = svgtypes::Color::from_str(text.unwrap_or("black")).ok()?;
    let opacity = match property(stop, "stop-opacity") {
        None => 1.0,
        Some(v) => match v.strip_suffix('%') {
            Some(share) => share.parse::<f64>().ok()? / 100.0,
            None => v.parse().ok()?,
        },
    };
    let level = |v: u8| f64::from(v) / 255.0;
    Some([level(c.red), level(c.green), level(c.blue), level(c.alpha) * opacity.clamp(0.0, 1.0)])
}

/// The value of a property that an element declares.
fn property<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let style = node.attribute("style").and_then(|s| declared(s, name));
    style.or_else(|| node.attribute(name)).map(str::trim)
}

/// The markup for usvg in place of a mesh gradient, which it does not know: a gradient with the mesh's id that shows nothing, as in
/// browsers.
pub(super) fn stand_in(prefix: &str, id: &str) -> String {
    let stops = ["", " offset=\"1\""].map(|at| format!("<{prefix}stop{at} stop-opacity=\"0\"/>")).concat();
    let head = format!("id=\"{}\" gradientUnits=\"userSpaceOnUse\" x2=\"1\"", pathwarp_reader::xml::escape(id));
    format!("<{prefix}linearGradient {head}>{stops}</{prefix}linearGradient>")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(inner: &str) -> Option<MeshGradient> {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{inner}</svg>");
        read(&Document::parse(&svg).unwrap()).get("m").cloned()
    }

    const PATCH: &str = "<stop path='c 1,0 2,0 3,0' stop-color='#f00'/><stop path='l 0,3' style='stop-color:#0f0;stop-opacity:50%'/><stop \
                         path='C2,3 1,3 0,3' stop-color='blue'/><stop path='c0,-1 0,-2' stop-color='#fff'/>";

    #[test]
    fn sides_that_neighbours_have_are_left_out() {
        let right =
            "<stop path='l 3,0'/><stop path='l 0,3' stop-color='#111'/><stop path='c -1,0 -2,0' stop-color='#222'/>";
        let below = "<stop path='l 0,3'/><stop path='l -3,0' stop-color='#333'/><stop path='z' stop-color='#444'/>";
        let last = "<stop path='l 0,3'/><stop path='l -3,0' stop-color='#555'/>";
        let rows = [[PATCH, right], [below, last]].map(|row| {
            let patches = row.map(|p| format!("<meshpatch>{p}</meshpatch>")).concat();
            format!("<meshrow>{patches}</meshrow>")
        });
        let m = mesh(&format!("<meshgradient id='m' gradientUnits='userSpaceOnUse'>{}</meshgradient>", rows.concat()))
            .unwrap();
        assert_eq!((m.rows(), m.columns()), (2, 2));
        // The sides are straight, so each patch is a square of 3 units, run through evenly.
        for (row, column, u, v) in [(0, 0, 0.3, 0.7), (0, 1, 0.5, 0.25), (1, 0, 0.0, 1.0), (1, 1, 0.9, 0.1)] {
            let at = m.point_in_patch(row, column, u, v);
            let wanted = Point::new(3.0 * (column as f64 + u), 3.0 * (row as f64 + v));
            assert!(at.at.distance(wanted) < 1e-12, "{row} {column}: {at:?}");
            assert!((at.du - Vec2::new(3.0, 0.0)).hypot() + (at.dv - Vec2::new(0.0, 3.0)).hypot() < 1e-12);
        }
        let grey = |v: u8| [f64::from(v) / 255.0; 3];
        let [red, half, dark] = [m.colors[0][0], m.colors[0][1], m.colors[2][2]];
        assert_eq!((red, half), ([1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.5]));
        assert_eq!(dark[..3], grey(0x55));
        assert_eq!([m.colors[1][0], m.colors[1][1]], [[1.0; 4], [0.0, 0.0, 1.0, 1.0]]);
        assert_eq!(m.colors[2][0][..3], grey(0x44));
    }

    #[test]
    fn what_is_not_whole_is_no_mesh() {
        let whole = |inner: &str| {
            format!("<meshgradient id='m'><meshrow><meshpatch>{inner}</meshpatch></meshrow></meshgradient>")
        };
        assert!(mesh(&whole(PATCH)).is_some());
        for broken in [
            PATCH.replace("l 0,3", "l 0"),
            PATCH.replace("l 0,3", ""),
            PATCH.replace("#f00", "no"),
            PATCH.replace("C2,3", "C2,1e999"),
            PATCH.replacen("<stop", "<other", 1),
            String::new(),
        ] {
            assert!(mesh(&whole(&broken)).is_none(), "{broken}");
        }
        let ragged = format!("<meshpatch>{PATCH}</meshpatch></meshrow><meshrow>");
        assert!(mesh(&format!("<meshgradient id='m'><meshrow>{ragged}</meshrow></meshgradient>")).is_none());
        // A chain of links that ends in itself.
        assert!(mesh("<meshgradient id='m' href='#m'/>").is_none());
    }

    /// Levels that Inkscape 1.2 draws in the middle of a row of patches, whose widths are 100, 50, 150 and 100.
    #[test]
    fn smooth_colours_are_inkscapes() {
        let (widths, levels) = ([100, 50, 150, 100], ["#000", "#333", "#ccc", "#fff", "#999"]);
        let stop = |path: String, color: &str| format!("<stop path='{path}' stop-color='{color}'/>");
        let patch = |k: usize| {
            let (w, next) = (widths[k], levels[k + 1]);
            let sides =
                [stop(format!("l {w},0"), levels[0]), stop("l 0,100".into(), next), stop(format!("l -{w},0"), next)];
            let left = if k == 0 { stop("z".into(), levels[0]) } else { String::new() };
            format!("<meshpatch>{}{left}</meshpatch>", sides.concat())
        };
        let patches: String = (0..4).map(patch).collect();
        let m =
            mesh(&format!("<meshgradient id='m' type='bicubic'><meshrow>{patches}</meshrow></meshgradient>")).unwrap();
        for (u, level) in
            [(0.405, 0.0), (0.755, 20.0), (1.21, 78.0), (1.61, 153.0), (2.0, 204.0), (2.336, 240.0), (2.837, 254.0)]
        {
            let found = 255.0 * m.color(u, 0.5)[0];
            assert!((found - level).abs() < 2.5, "{u}: {found} for {level}");
        }
    }

    /// Opacity that Inkscape draws, which is bilinear even between smooth colours.
    #[test]
    fn opacity_is_not_smooth() {
        let stop =
            |path: &str, opacity: f64| format!("<stop path='{path}' stop-color='#000' stop-opacity='{opacity}'/>");
        let first = [stop("l 160,0", 1.0), stop("l 0,160", 0.2), stop("l -160,0", 0.6), stop("l 0,-160", 0.0)].concat();
        let second = [stop("l 160,0", 0.0), stop("l 0,160", 0.8), stop("l -160,0", 0.4)].concat();
        let row = format!("<meshrow><meshpatch>{first}</meshpatch><meshpatch>{second}</meshpatch></meshrow>");
        let m = mesh(&format!("<meshgradient id='m' type='bicubic'>{row}</meshgradient>")).unwrap();
        for (x, y, drawn) in [(20, 40, 0.69), (80, 80, 0.447), (120, 20, 0.404), (240, 120, 0.502), (60, 120, 0.341)] {
            let [u, v] = [x, y].map(|t| (f64::from(t) + 0.5) / 160.0);
            assert!((m.color(u, v)[3] - drawn).abs() < 0.006, "{x},{y}: {}", m.color(u, v)[3]);
        }
    }
}
