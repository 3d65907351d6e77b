//! Writes lettering as an SVG drawing with data attributes for baselines, heights and letters.

use super::markup::number;
use crate::bend::path::WarpedPath;
use crate::source::number::path_data;
use pathwarp::Error;
use pathwarp::kurbo::{Rect, Shape, Vec2};
use pathwarp::param::LengthUnit;
use pathwarp_reader::xml::escape;
use pathwarp_text::OutlinedText;
use std::fmt::Write as _;
use std::str::FromStr as _;

/// Options for writing lettering.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LetteringOptions {
    /// A CSS colour; `None` for the renderer's default, black.
    pub fill: Option<String>,
    /// Margin around ink and lines, in user units, at least 0.
    pub margin: f64,
    /// `true` if the page is around the ink alone, unless there is none.
    pub around_ink: bool,
    /// The unit of the lettering's coordinates and of the page: `Mm`, `Cm`, `In`, `Pt` or `Pc`. Other values mean px.
    pub unit: Option<LengthUnit>,
}

/// The unit in the page's width and height; px need none.
fn page_unit(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::Mm => "mm",
        LengthUnit::Cm => "cm",
        LengthUnit::In => "in",
        LengthUnit::Pt => "pt",
        LengthUnit::Pc => "pc",
        _ => "",
    }
}

/// Significant digits of the largest coordinate on the page.
const DIGITS: i32 = 10;

/// Writes lettering as a drawing, as large as its ink, its lines and the margin around them.
///
/// The text is a group with an `aria-label` and the font's heights in user units: `data-ascent` and `data-descent` (both measured from the
/// baseline, both positive), `data-cap-height`, `data-x-height`. It contains a group for every line with `data-baseline="x0 y0 x1 y1"`,
/// from the line's left end to its right end, and with the line's heights if it is scaled. The group contains a path for every cluster with
/// an outline, with the cluster's text as `aria-label`, and its origin on the baseline and its advance width as `data-glyph="x y advance"`.
///
/// ```
/// use pathwarp_svg::engine::{LetteringOptions, bundled_font, write_lettering};
/// use pathwarp_text::{Font, TextStyle, layout};
///
/// let font = Font::new(bundled_font(), 0)?;
/// let text = layout("Hi", &[font], &TextStyle { size: 100.0, ..TextStyle::default() })?;
/// let svg = write_lettering(&text, &LetteringOptions { fill: Some("#c00".into()), margin: 10.0, ..LetteringOptions::default() })?;
/// assert!(svg.contains(r#"viewBox="-10 -10 119.9 156.2""#));
/// assert!(svg.contains(r#"data-cap-height="71.4""#) && svg.contains(r#"<path aria-label="H" data-glyph="0 106.9 74.1" d="M"#));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Usage`] when the fill is not a colour, or the margin is negative or not finite.
pub fn write_lettering(lettering: &OutlinedText, options: &LetteringOptions) -> Result<String, Error> {
    let page = lettering.ink().filter(|_| options.around_ink).unwrap_or_else(|| lettering.page());
    let mut sheet = Sheet::new(page, &lettering.text, options)?;
    sheet.lettering(lettering, "", None);
    Ok(sheet.finish())
}

/// The group of elements that [`write_lettering`] writes, for a drawing with other content. It is moved by `by` and filled with a CSS
/// colour. Its id is `ID`, its lines have the ids `ID-line-1` and so on, and its letters `ID-1` and so on.
///
/// # Errors
/// [`Error::Usage`] when the fill is not a colour.
pub fn lettering_group(lettering: &OutlinedText, id: &str, fill: &str, by: Vec2) -> Result<String, Error> {
    let options = LetteringOptions { fill: Some(fill.to_owned()), ..LetteringOptions::default() };
    let mut sheet = Sheet::new(lettering.page(), "", &options)?;
    sheet.out.clear();
    let attributes = format!(" id=\"{id}\" transform=\"translate({})\" stroke=\"none\"", sheet.numbers(&[by.x, by.y]));
    sheet.lettering(lettering, &attributes, Some(id));
    Ok(sheet.out)
}

/// A path in its final position.
#[derive(Debug, Clone, PartialEq)]
pub struct SetPath {
    /// Its label, such as the characters of a letter.
    pub label: String,
    /// The path.
    pub path: WarpedPath,
    /// The width of its stroke; `None` if it is filled.
    pub line: Option<f64>,
}

/// Paths in their final position, such as letters without a level baseline, and a drawing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SetGroup {
    /// Its id, if it has one.
    pub id: Option<&'static str>,
    /// Its label, such as the text of lettering.
    pub label: String,
    /// The paths.
    pub paths: Vec<SetPath>,
    /// SVG elements with their colours, after the paths.
    pub drawing: String,
}

/// Writes groups as a drawing with a title, as large as their paths and the margin around them. Each becomes a group with an `aria-label`
/// that holds its paths.
///
/// # Errors
/// [`Error::Usage`] when the fill is not a colour, or the margin is negative or not finite.
pub fn write_set_groups(title: &str, groups: &[SetGroup], options: &LetteringOptions) -> Result<String, Error> {
    let drawn = groups.iter().flat_map(|g| &g.paths).filter(|p| !p.path.path.is_empty());
    let bounds = drawn.map(|p| {
        let half = 0.5 * p.line.unwrap_or_default();
        p.path.path.bounding_box().inflate(half, half)
    });
    let page = bounds.reduce(|a, b| a.union(b)).unwrap_or_default();
    let mut sheet = Sheet::new(page, title, options)?;
    for group in groups {
        let id = group.id.map_or_else(String::new, |id| format!(" id=\"{id}\""));
        sheet.begin(&group.label, &id);
        for p in &group.paths {
            let paint = options.fill.as_deref().unwrap_or("#000");
            let line = p.line.map(|w| {
                format!(" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"", escape(paint), sheet.numbers(&[w]))
            });
            sheet.letter(&p.label, &line.unwrap_or_default(), &p.path.data);
        }
        sheet.out.push_str(&group.drawing);
        sheet.out.push_str("</g>\n");
    }
    Ok(sheet.finish())
}

/// A drawing of lettering while it is written.
struct Sheet {
    out: String,
    /// The attribute `fill` of texts; empty for the renderer's default.
    fill: String,
    decimals: u8,
}

impl Sheet {
    /// Begins the drawing of a page with its title.
    fn new(page: Rect, title: &str, options: &LetteringOptions) -> Result<Self, Error> {
        let fill = match &options.fill {
            Some(fill) if svgtypes::Color::from_str(fill).is_ok() || fill == "none" || fill == "currentColor" => {
                format!(" fill=\"{}\"", escape(fill))
            }
            Some(fill) => {
                let why = "is not a CSS colour such as #c00, navy, rgb(0,0,0) or currentColor";
                return Err(Error::usage("fill", fill, why));
            }
            None => String::new(),
        };
        if !(options.margin >= 0.0 && options.margin.is_finite()) {
            return Err(Error::usage("margin", options.margin.to_string(), "is not valid; a margin is at least 0"));
        }
        let page = page.inflate(options.margin, options.margin);
        let largest = [page.x0, page.y0, page.x1, page.y1].into_iter().fold(0.0, |a: f64, v| a.max(v.abs()));
        let decimals = (DIGITS - largest.log10().ceil() as i32).clamp(0, DIGITS) as u8;
        let [x, y, w, h] = [page.x0, page.y0, page.width(), page.height()].map(|v| number(v, decimals));
        let (unit, title) = (options.unit.map_or("", page_unit), escape(&title.replace('\n', " ")));
        let out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}{unit}\" height=\"{h}{unit}\" viewBox=\"{x} {y} {w} {h}\">\n\
             <title>{title}</title>\n"
        );
        Ok(Self { out, fill, decimals })
    }

    fn numbers(&self, values: &[f64]) -> String {
        values.iter().map(|v| number(*v, self.decimals)).collect::<Vec<_>>().join(" ")
    }

    /// Writes the group of a text, with these attributes, and with ids for its lines and letters if it has one.
    fn lettering(&mut self, lettering: &OutlinedText, attributes: &str, id: Option<&str>) {
        let heights = |sheet: &Self, scale: f64| {
            let m = lettering.metrics.scaled(scale);
            let [ascent, descent, cap, x] =
                [m.ascent, m.descent, m.cap_height, m.x_height].map(|v| number(v, sheet.decimals));
            format!(
                " data-ascent=\"{ascent}\" data-descent=\"{descent}\" data-cap-height=\"{cap}\" data-x-height=\"{x}\""
            )
        };
        let id_attribute = |name: String| id.map_or_else(String::new, |id| format!(" id=\"{id}-{name}\""));
        self.begin(&lettering.text, &(attributes.to_owned() + &heights(self, 1.0)));
        let mut letters = 0;
        for (i, line) in lettering.lines.iter().enumerate() {
            let heights = if line.scale == 1.0 { String::new() } else { heights(self, line.scale) };
            let baseline = self.numbers(&[line.start.x, line.start.y, line.end.x, line.end.y]);
            let id = id_attribute(format!("line-{}", i + 1));
            let _ = writeln!(self.out, "<g{id} data-baseline=\"{baseline}\"{heights}>");
            for c in line.clusters.iter().filter(|c| !c.outline.is_empty()) {
                letters += 1;
                let origin = self.numbers(&[c.origin.x, c.origin.y, c.advance]);
                let attributes = format!("{} data-glyph=\"{origin}\"", id_attribute(letters.to_string()));
                self.letter(&c.text, &attributes, &path_data(&c.outline, self.decimals));
            }
            self.out.push_str("</g>\n");
        }
        self.out.push_str("</g>\n");
    }

    /// Begins the group of a text.
    fn begin(&mut self, text: &str, attributes: &str) {
        let _ = writeln!(self.out, "<g aria-label=\"{}\"{attributes}{}>", escape(text), self.fill);
    }

    fn letter(&mut self, text: &str, attributes: &str, data: &str) {
        let _ = writeln!(self.out, "<path aria-label=\"{}\"{attributes} d=\"{data}\"/>", escape(text));
    }

    fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }
}
