//! Writes mesh gradients in the form that Inkscape reads.

use super::markup::{Markup, color};
use crate::source::markup::Tag;
use crate::source::mesh::{MeshGradient, Rgba, reversed};
use crate::source::number::{push, short};
use pathwarp::kurbo::{CubicBez, Point};

/// Begins a mesh gradient in user space.
pub(super) fn element(markup: &Markup<'_>, mesh: &MeshGradient, id: &str, decimals: u8) -> Tag {
    let start = mesh.across[0][0].p0;
    let tag = markup.element("meshgradient").with("id", id).with("gradientUnits", "userSpaceOnUse");
    let tag = tag.with("x", &number(start.x, decimals)).with("y", &number(start.y, decimals));
    if mesh.smooth { tag.with("type", "bicubic") } else { tag }
}

/// Writes the rows of a mesh. Sides are absolute, so that rounding does not add up.
pub(super) fn content(markup: &Markup<'_>, mesh: &MeshGradient, decimals: u8) -> String {
    let row = |r: usize| {
        let patches: String = (0..mesh.columns()).map(|c| patch(markup, mesh, [r, c], decimals)).collect();
        markup.element("meshrow").around(&patches)
    };
    (0..mesh.rows()).map(row).collect()
}

/// Writes the sides of a patch that no earlier patch has, clockwise from the top. Each has the colour of the corner at which it begins,
/// unless an earlier patch has that.
fn patch(markup: &Markup<'_>, mesh: &MeshGradient, [r, c]: [usize; 2], decimals: u8) -> String {
    let stop = |side: CubicBez, corner: Option<Rgba>| stop(markup, side, corner, decimals);
    let new = |row: usize, column: usize, is_new: bool| is_new.then(|| mesh.colors[row][column]);
    let mut stops = String::new();
    if r == 0 {
        stops += &stop(mesh.across[0][c], new(0, 0, c == 0));
    }
    stops += &stop(mesh.down[r][c + 1], new(0, c + 1, r == 0));
    stops += &stop(reversed(mesh.across[r + 1][c]), new(r + 1, c + 1, true));
    if c == 0 {
        stops += &stop(reversed(mesh.down[r][0]), new(r + 1, 0, true));
    }
    markup.element("meshpatch").around(&stops)
}

fn stop(markup: &Markup<'_>, side: CubicBez, corner: Option<Rgba>, decimals: u8) -> String {
    let point = |p: Point| format!("{},{}", number(p.x, decimals), number(p.y, decimals));
    let points = [side.p1, side.p2, side.p3].map(point).join(" ");
    let tag = markup.element("stop").with("path", &format!("C{points}"));
    let mut properties = Vec::new();
    if let Some(c) = corner {
        let [r, g, b] = [0, 1, 2].map(|k| (255.0 * c[k]).round() as u8);
        properties.push(("stop-color", color(usvg::Color::new_rgb(r, g, b))));
        if c[3] < 1.0 || markup.styled {
            properties.push(("stop-opacity", short((c[3] * 1e4).round() / 1e4)));
        }
    }
    tag.raw(&markup.attributes(&properties)).empty()
}

fn number(v: f64, decimals: u8) -> String {
    let mut out = String::new();
    push(&mut out, v, decimals);
    out
}
