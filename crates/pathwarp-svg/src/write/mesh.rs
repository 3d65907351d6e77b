//! Writes mesh gradients in the form that Inkscape reads.

use super::markup::{Markup, color, number};
use crate::source::markup::Tag;
use crate::source::mesh::{MeshGradient, Rgba, reversed};
use crate::source::number::short;
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
fn patch(markup: &Markup<'_>, mesh: &MeshGradient, [row, column]: [usize; 2], decimals: u8) -> String {
    let stop = |side: CubicBez, color: Option<Rgba>| stop(markup, side, color, decimals);
    let (is_first_row, is_first_column) = (row == 0, column == 0);
    let mut stops = String::new();
    if is_first_row {
        stops += &stop(mesh.across[0][column], is_first_column.then(|| mesh.colors[0][0]));
    }
    stops += &stop(mesh.down[row][column + 1], is_first_row.then(|| mesh.colors[0][column + 1]));
    stops += &stop(reversed(mesh.across[row + 1][column]), Some(mesh.colors[row + 1][column + 1]));
    if is_first_column {
        stops += &stop(reversed(mesh.down[row][0]), Some(mesh.colors[row + 1][0]));
    }
    markup.element("meshpatch").around(&stops)
}

/// Writes a side of a patch with the colour of the corner at which it begins, if that is new.
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
