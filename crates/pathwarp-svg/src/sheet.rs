//! Writes contact sheets: labelled drawings side by side in one SVG, which looks the same everywhere.
//!
//! Every drawing is written in the form resolved by usvg, with prefixed ids, so that drawings cannot refer to one another. Labels
//! are outlines in the bundled font. All drawings have the same scale, at which three quarters of them fit their cells; larger
//! ones are scaled to fit.

use crate::source::read::ReadOptions;
use crate::source::tree;
use pathwarp::Error;
use pathwarp::budget::Limit;
use pathwarp::kurbo::Rect;
use pathwarp_reader::xml::escape_content;
use std::fmt::Write as _;
use usvg::WriteOptions;

/// A drawing with its label.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// The drawing as SVG text.
    pub svg: String,
    /// Label below the drawing.
    pub label: String,
}

/// Layout of a sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetOptions {
    /// Number of columns.
    pub columns: usize,
    /// Width and height of a cell in px, label included.
    pub cell: (f64, f64),
    /// Title at the top.
    pub title: String,
}

/// Space between cells and around them.
const GAP: f64 = 16.0;
/// Space between a cell's border and its content.
const INSET: f64 = 12.0;
/// Height of the title's line.
const TITLE: f64 = 34.0;
/// Font size of the title.
const TITLE_SIZE: f64 = 17.0;
/// Height of a label's line.
const LABEL: f64 = 22.0;
/// Font size of labels; long labels are smaller.
const LABEL_SIZE: f64 = 13.0;
/// Average advance of a letter as a fraction of the font size.
const LETTER: f64 = 0.57;

/// Writes a sheet as SVG text.
///
/// # Errors
/// Returns [`Error::Input`] for a drawing that cannot be read.
pub fn sheet(cells: &[Cell], options: &SheetOptions, read: &ReadOptions) -> Result<String, Error> {
    let (w, h) = options.cell;
    let columns = options.columns.clamp(1, cells.len().max(1));
    let rows = cells.len().div_ceil(columns);
    let corner = |k: usize| {
        let (i, j) = ((k % columns) as f64, (k / columns) as f64);
        (GAP + i * (w + GAP), GAP + TITLE + j * (h + GAP))
    };
    let width = GAP + columns as f64 * (w + GAP);
    let height = GAP + TITLE + rows as f64 * (h + GAP);
    let shared = shared_options(cells, read);
    let drawn = cells.iter().enumerate().map(|(k, c)| embedded(&c.svg, &c.label, &format!("s{k}-"), &shared));
    let drawn: Vec<(Rect, String)> = drawn.collect::<Result<_, _>>()?;
    let room = ((w - 2.0 * INSET).max(1.0), (h - 2.0 * INSET - LABEL).max(1.0));
    // The largest scale at which a drawing fits its cell.
    let scale_to_fit = |b: &Rect| (room.0 / b.width().max(1e-9)).min(room.1 / b.height().max(1e-9));
    let mut scales: Vec<f64> = drawn.iter().map(|(b, _)| scale_to_fit(b)).collect();
    scales.sort_by(f64::total_cmp);
    let common_scale = scales.get(scales.len() / 4).copied().unwrap_or(1.0);

    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" \
         height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    let mut labels = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" font-family=\"Noto Sans\">\n\
         <text x=\"{GAP}\" y=\"{}\" font-size=\"{TITLE_SIZE}\" fill=\"#222\">{}</text>\n",
        GAP + TITLE_SIZE,
        escape_content(&options.title)
    );
    for (k, (seen, content)) in drawn.iter().enumerate() {
        let (x, y) = corner(k);
        let (cx, cy) = (x + 0.5 * w, y + INSET + 0.5 * room.1);
        let (centre, scale) = (seen.center(), common_scale.min(scale_to_fit(seen)));
        let _ = write!(
            out,
            "<g id=\"cell-{k}\">\n<title>{}</title>\n<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" rx=\"6\" fill=\"#f5f5f2\"/>\n\
             <g transform=\"matrix({scale} 0 0 {scale} {} {})\">{content}</g>\n</g>\n",
            escape_content(&cells[k].label),
            cx - scale * centre.x,
            cy - scale * centre.y
        );
        let letters = cells[k].label.chars().count().max(1) as f64;
        let _ = writeln!(
            labels,
            "<text x=\"{cx}\" y=\"{}\" font-size=\"{}\" fill=\"#555\" text-anchor=\"middle\">{}</text>",
            y + h - INSET + 2.0,
            LABEL_SIZE.min(w / (letters * LETTER)),
            escape_content(&cells[k].label)
        );
    }
    labels.push_str("</svg>\n");
    let bundled = ReadOptions { system_fonts: false, ..ReadOptions::default() };
    let outlines = tree::parse(labels.as_bytes(), "labels", &bundled)?.0;
    let prefixed = WriteOptions { id_prefix: Some("label-".into()), ..WriteOptions::default() };
    let _ = write!(out, "<g id=\"labels\">{}</g>\n</svg>\n", inside(&outlines.to_string(&prefixed)));
    Ok(out)
}

/// The box that a drawing paints and its elements, in px of its page, for embedding in another drawing. Texts are outlines, and ids begin
/// with a prefix.
///
/// # Errors
/// Returns [`Error::Input`] for a drawing that cannot be read.
pub fn embedded(svg: &str, name: &str, prefix: &str, read: &ReadOptions) -> Result<(Rect, String), Error> {
    let tree = tree::parse_counted(svg.as_bytes(), name, read)?.0;
    let b = tree.root().abs_layer_bounding_box();
    let (x, y) = (f64::from(b.x()), f64::from(b.y()));
    let seen = Rect::new(x, y, x + f64::from(b.width()), y + f64::from(b.height()));
    let prefixed = WriteOptions { id_prefix: Some(prefix.to_owned()), ..WriteOptions::default() };
    Ok((seen, inside(&tree.to_string(&prefixed)).to_owned()))
}

/// Options with one budget for all cells: the largest cell's, but with more elements and work, as many small drawings need.
fn shared_options(cells: &[Cell], read: &ReadOptions) -> ReadOptions {
    /// Factor for elements and work. Within it, the cells together take as long as a large drawing.
    const DRAWINGS: f64 = 6.0;
    let sizes = || cells.iter().map(|c| c.svg.len());
    let largest = read.limits.for_input(sizes().max().unwrap_or_default());
    let counted = [Limit::Elements, Limit::Work];
    let limits = counted.into_iter().fold(largest, |limits, l| limits.with(l, DRAWINGS * largest.of(l)));
    let limits = limits.with(Limit::Bytes, read.limits.for_input(sizes().sum()).of(Limit::Bytes));
    read.clone().with_limits(limits).begin(0)
}

/// Content of the root element.
fn inside(svg: &str) -> &str {
    let start = svg.find("<svg").and_then(|i| svg[i..].find('>').map(|j| i + j + 1)).unwrap_or(0);
    let end = svg.rfind("</svg>").unwrap_or(svg.len()).max(start);
    &svg[start..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50\"><defs><linearGradient id=\"g\">\
    <stop stop-color=\"red\"/><stop offset=\"1\" stop-color=\"blue\"/></linearGradient></defs>\
    <rect width=\"100\" height=\"50\" fill=\"url(#g)\"/></svg>";

    /// Ids are unique, labels are outlines, and drawings are inside their cells.
    #[test]
    fn drawings_lie_in_their_cells_and_keep_to_themselves() {
        let half = ONE.replace("<rect width=\"100\"", "<rect width=\"50\"").replace("red", "lime");
        let cells = [(ONE, "whole & all"), (&half, "half"), (ONE, "again")]
            .map(|(s, l)| Cell { svg: s.into(), label: l.into() });
        let options = SheetOptions { columns: 2, cell: (124.0, 96.0), title: "Title".into() };
        let svg = sheet(&cells, &options, &ReadOptions::default()).unwrap();
        assert!(!svg.contains("<text") && svg.contains("<title>whole &amp; all</title>"));
        let doc = usvg::roxmltree::Document::parse(&svg).unwrap();
        let mut ids: Vec<&str> = doc.descendants().filter_map(|n| n.attribute("id")).collect();
        let count = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), count);
        for k in 0..3 {
            assert!(svg.contains(&format!("url(#s{k}-")), "{k}");
        }
        let tree = tree::parse(svg.as_bytes(), "sheet", &ReadOptions::default()).unwrap().0;
        assert_eq!((tree.size().width(), tree.size().height()), (296.0, 274.0));
        let gradients: Vec<usvg::Rect> = filled(tree.root());
        // 124 − 24 = 100 wide: the largest fits exactly; the half one has half the width and is centred.
        let sizes: Vec<(f32, f32, f32)> = gradients.iter().map(|r| (r.x(), r.width(), r.height())).collect();
        let near =
            |a: (f32, f32, f32), b: (f32, f32, f32)| (a.0 - b.0).abs() + (a.1 - b.1).abs() + (a.2 - b.2).abs() < 1e-2;
        assert!(
            near(sizes[0], (28.0, 100.0, 50.0)) && near(sizes[1], (193.0, 50.0, 50.0)) && near(sizes[2], sizes[0]),
            "{sizes:?}"
        );
    }

    fn filled(g: &usvg::Group) -> Vec<usvg::Rect> {
        let of = |n: &usvg::Node| match n {
            usvg::Node::Group(g) => filled(g),
            usvg::Node::Path(p) if p.fill().is_some_and(|f| matches!(f.paint(), usvg::Paint::LinearGradient(_))) => {
                vec![p.abs_bounding_box()]
            }
            _ => Vec::new(),
        };
        g.children().iter().flat_map(of).collect()
    }
}
