//! Paints: colours, gradients, patterns, and their opacity.

use crate::file::{File, MaskKind, State};
use crate::gradient::Gradient;
use crate::pattern;
use crate::space::{rect, roomy};
use crate::stream::Stream;
use usvg::{Paint, Path};

/// A use of a paint.
pub(crate) struct Use<'a> {
    pub(crate) paint: &'a Paint,
    pub(crate) opacity: f32,
    /// `true` for a stroke, `false` for a fill.
    pub(crate) strokes: bool,
    /// The path that is painted.
    pub(crate) path: &'a Path,
}

/// Calls `draw` with the paint set.
pub(crate) fn with_paint(file: &mut File<'_>, stream: &mut Stream, painted: &Use<'_>, draw: impl FnOnce(&mut Stream)) {
    let area = roomy(rect(painted.path.stroke_bounding_box()));
    let gradient = Gradient::of(painted.paint, area);
    let mut state = State::default().opacity(painted.opacity);
    if let Some(gradient) = gradient.as_ref().filter(|g| g.is_translucent()) {
        // The same gradient in grey says how much shows.
        let group = file.group(area, stream.shift, |file, stream| {
            let shift = stream.shift;
            let grey = gradient.opacities(file, stream.to_start);
            stream.pattern(grey, false);
            let [x, y, width, height] =
                [area.x0 - shift.x, area.y0 - shift.y, area.width(), area.height()].map(|v| v as f32);
            stream.content.rect(x, y, width, height).fill_nonzero();
        });
        state = state.mask(MaskKind::Luminosity, group);
    }
    // A gradient or pattern is set anew for every path, so that leaving it set does no harm; a state would stay.
    let limited = !state.is_plain();
    if limited {
        stream.save();
        let state = file.state(state);
        stream.state(state);
    }
    match (painted.paint, &gradient) {
        (Paint::Color(c), _) => {
            let [r, g, b] = [c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0);
            if painted.strokes {
                stream.content.set_stroke_rgb(r, g, b);
            } else {
                stream.content.set_fill_rgb(r, g, b);
            }
        }
        (Paint::Pattern(p), _) => {
            let pattern = pattern::add(file, p, stream.to_start);
            stream.pattern(pattern, painted.strokes);
        }
        (_, Some(gradient)) => {
            let colors = gradient.colors(file, stream.to_start);
            stream.pattern(colors, painted.strokes);
        }
        (_, None) => {}
    }
    draw(stream);
    if limited {
        stream.restore();
    }
}
