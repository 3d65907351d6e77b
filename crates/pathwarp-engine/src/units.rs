//! User units of a drawing.

use pathwarp_svg::Document;

/// Millimetres per px.
pub const MM_PER_PX: f64 = 25.4 / 96.0;

/// User units per px along x and y.
pub(crate) fn units_per_px(doc: &Document) -> [f64; 2] {
    let [a, b, c, d, ..] = doc.user_to_px().as_coeffs();
    let usable = |px: f64| if px > 0.0 && px.is_finite() { 1.0 / px } else { 1.0 };
    [usable(a.hypot(b)), usable(c.hypot(d))]
}
