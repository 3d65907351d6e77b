//! Writes the line around artwork as a new layer, with the bleed and the marks that printers and cutters need, and the marks for the
//! position of an anamorphosis's viewer.

use super::fragment::Writer;
use super::input::WriteInput;
use super::markup::{data_url, svg};
use crate::bend::line::{Bleed, Line};
use crate::bend::outcome::{Notes, Skipped};
use crate::scene::geometry::stretch;
use crate::source::number::{path_data, rectangle, single};
use pathwarp::deform::SightMark;
use pathwarp::kurbo::{Point, Rect, Shape};
use std::fmt::Write as _;

/// A millimetre in px.
const MM: f64 = 96.0 / 25.4;
/// Width of a hairline in px: a quarter of a point.
const HAIRLINE: f64 = 0.25 * 96.0 / 72.0;

/// Distance of the marks from the bleed, in millimetres.
const GAP: f64 = 2.0;
/// Length of the marks, in millimetres.
const ARM: f64 = 5.0;
/// Radius of register marks, in millimetres.
const RADIUS: f64 = 1.5;

/// The box of the line with its bleed and marks.
pub(super) fn bounds(input: &WriteInput<'_>, line: &Line) -> Rect {
    let bounds = line.bled.as_ref().map_or(line.bounds, |b| b.bounds);
    let marks = if input.options.line.marks { (GAP + ARM) * MM * px_in_user_units(input) } else { 0.0 };
    let half_width = 0.5 * HAIRLINE * px_in_user_units(input);
    bounds.inflate(marks + half_width, marks + half_width)
}

fn px_in_user_units(input: &WriteInput<'_>) -> f64 {
    1.0 / stretch(input.scene.to_px)
}

/// The layers beneath and above the artwork.
pub(super) fn layers(w: &mut Writer<'_>) -> [String; 2] {
    let sight = w.input.options.sight.clone().map_or(String::new(), |s| sight(w, &s));
    let Some(line) = w.input.line else { return [String::new(), sight] };
    let style = &w.input.options.line;
    let beneath = bleed(w, line).unwrap_or_default();
    let name = style.spot.as_deref().unwrap_or("Contour");
    let mut above = sight + &layer(w, name, ("#ec008c", &line.data), style.spot.as_deref());
    if style.marks {
        let bled = line.bled.as_ref().map_or(line.bounds, |b| b.bounds);
        // Every plate of a print has the marks.
        let data = marks(line.bounds, bled, MM * px_in_user_units(&w.input));
        above.push_str(&layer(w, "Marks", ("#000", &data), Some("All")));
    }
    [beneath, above]
}

/// The box of the marks for the viewer's position, with some room around them.
pub(super) fn sight_bounds(sight: &SightMark) -> Rect {
    /// The width of a letter, as a fraction of its height.
    const LETTER: f64 = 0.6;
    let ((middle, text), size) = (&sight.label, sight.size);
    let half = 0.5 * LETTER * size * text.chars().count() as f64;
    // Letters descend by about three tenths of their size.
    let text = Rect::new(middle.x - half, middle.y - size, middle.x + half, middle.y + 0.3 * size);
    sight.path.bounding_box().union(text).inflate(size, size)
}

/// The layer of the marks for the viewer's position.
fn sight(w: &mut Writer<'_>, sight: &SightMark) -> String {
    let path = w.markup.element("path").with("d", &path_data(&sight.path, 4));
    let path = path.with("style", &format!("fill:none;stroke:#000;stroke-width:{}", single(0.04 * sight.size)));
    let (position, text) = &sight.label;
    let label = w.markup.element("text").with("x", &single(position.x)).with("y", &single(position.y));
    let label = label.with(
        "style",
        &format!("font-family:sans-serif;font-size:{}px;text-anchor:middle;fill:#000", single(sight.size)),
    );
    let group = w.markup.element("g").with("id", &w.defs.new_id("sight-mark"));
    group.around(&(path.empty() + &label.around(text))) + "\n"
}

/// A hairline in a layer as Inkscape has them. `data-spot` tells the PDF writer its ink, `data-knockout` to leave out the inks beneath.
fn layer(w: &mut Writer<'_>, name: &str, (color, data): (&str, &str), spot: Option<&str>) -> String {
    let id: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let group = w.defs.new_id(&id);
    let width = single(HAIRLINE * px_in_user_units(&w.input));
    let path = w.markup.element("path").with("id", &w.defs.new_id(&format!("{id}-line"))).with("d", data);
    let path = path.with("style", &format!("fill:none;stroke:{color};stroke-width:{width}"));
    let path = path.with_all(spot.map(|name| ("data-spot", name)));
    let path = if w.input.options.line.knockout { path.with("data-knockout", "true") } else { path };
    let inkscape = " xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" inkscape:groupmode=\"layer\"";
    let group = w.markup.element("g").with("id", &group).with("data-contour", name).raw(inkscape);
    group.with("inkscape:label", name).around(&path.empty()) + "\n"
}

/// Crop marks at the corners of the line's box, and register marks in the middles of its sides, beyond the bleed.
fn marks(line: Rect, bled: Rect, mm: f64) -> String {
    let (near, far) = (bled.inflate(GAP * mm, GAP * mm), bled.inflate((GAP + ARM) * mm, (GAP + ARM) * mm));
    let mut out = String::new();
    let mut stroke = |p: Point, q: Point| {
        let [x0, y0, x1, y1] = [p.x, p.y, q.x, q.y].map(single);
        let _ = write!(out, "M{x0},{y0} L{x1},{y1} ");
    };
    for (x, [from, to]) in [(line.x0, [near.x0, far.x0]), (line.x1, [near.x1, far.x1])] {
        for (y, [above, below]) in [(line.y0, [near.y0, far.y0]), (line.y1, [near.y1, far.y1])] {
            stroke(Point::new(from, y), Point::new(to, y));
            stroke(Point::new(x, above), Point::new(x, below));
        }
    }
    let (middle, half, r) = (line.center(), 0.5 * ARM * mm, RADIUS * mm);
    let around = near.inflate(half, half);
    let centers = [(around.x0, middle.y), (around.x1, middle.y), (middle.x, around.y0), (middle.x, around.y1)];
    for (x, y) in centers {
        stroke(Point::new(x - half, y), Point::new(x + half, y));
        stroke(Point::new(x, y - half), Point::new(x, y + half));
    }
    for (x, y) in centers {
        let [left, right, y, r] = [x - r, x + r, y, r].map(single);
        let _ = write!(out, "M{left},{y} A{r} {r} 0 0 1 {right} {y} A{r} {r} 0 0 1 {left} {y} Z ");
    }
    out.trim_end().to_owned()
}

/// A picture of the artwork's colours, continued beyond its edge.
fn bleed(w: &mut Writer<'_>, line: &Line) -> Option<String> {
    let (input, Bleed { data, bounds: area }) = (w.input, line.bled.as_ref()?);
    let (mut skipped, mut notes) = (Vec::new(), Notes::default());
    let in_source = false;
    let mut plain = Writer::new(WriteInput { line: None, ..input }, in_source, &mut skipped, &mut notes);
    let body: String = input.scene.root.children.iter().map(|n| plain.node(n)).collect();
    let text = svg(*area).around(&format!("<defs>{}</defs>{body}", plain.defs.text));
    let size = area.size() / px_in_user_units(&input);
    let png = match input.options.painter.as_ref()?.continued(&text, [size.width, size.height]) {
        Ok(png) => png,
        Err(why) => {
            w.skipped.push(Skipped { id: "the bleed".into(), why: why.to_string() });
            return None;
        }
    };
    let id = w.defs.new_id("bleed-edge");
    let clip = w.markup.element("clipPath").with("id", &id).around(&w.markup.element("path").with("d", data).empty());
    let url = data_url("image/png", &png);
    let image = w.markup.element("image").with_all(rectangle(*area)).with("preserveAspectRatio", "none");
    let image = image.raw(&format!(" {}=\"{url}\"", w.markup.link())).empty();
    let group = w.markup.element("g").with("id", &w.defs.new_id("Bleed")).with("clip-path", &format!("url(#{id})"));
    Some(group.around(&(clip + &image)) + "\n")
}
