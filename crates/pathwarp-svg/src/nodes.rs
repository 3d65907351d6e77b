//! Draws nodes and handles over a drawing, in the style of curve editors.

use crate::document::Document;
use crate::source::select::Selection;
use pathwarp::Seg;
use pathwarp::kurbo::{BezPath, Circle, Point, Rect, Shape as _};

/// Half the side of a node, as a fraction of the drawing's diagonal.
const NODE: f64 = 2.4e-3;

impl Document {
    /// Returns the drawing as SVG text with the nodes of its painted shapes on top: squares, with lines to round handles.
    #[must_use]
    pub fn with_nodes_shown(&self) -> String {
        let everything = Selection::default();
        let area = self.artwork_box(&everything).map_or(self.view_box(), |artwork| self.view_box().union(artwork));
        let size = NODE * area.width().hypot(area.height());
        let (mut lines, mut knobs, mut nodes) = (BezPath::new(), BezPath::new(), BezPath::new());
        let mut handle = |from: Point, to: Point| {
            if from != to {
                lines.move_to(from);
                lines.line_to(to);
                knobs.extend(Circle::new(to, 0.7 * size).path_elements(0.1 * size));
            }
        };
        for sub in self.selected(&everything).flat_map(|s| &s.outline.subpaths) {
            for seg in &sub.segs {
                match seg {
                    Seg::Quad(q) => [q.p0, q.p2].into_iter().for_each(|p| handle(p, q.p1)),
                    Seg::Cubic(c) => [(c.p0, c.p1), (c.p3, c.p2)].into_iter().for_each(|(p, q)| handle(p, q)),
                    Seg::Line(_) | Seg::Arc(_) => {}
                }
            }
            for p in std::iter::once(sub.start).chain(sub.segs.iter().map(Seg::end)) {
                nodes.extend(Rect::from_center_size(p, (2.0 * size, 2.0 * size)).path_elements(0.0));
            }
        }
        let mut text = self.decoded().into_owned();
        if let Some(end) = text.rfind("</") {
            let width = 0.35 * size;
            let (lines, knobs, nodes) = (lines.to_svg(), knobs.to_svg(), nodes.to_svg());
            text.insert_str(
                end,
                &format!(
                    "<g style=\"fill:#0072b2;stroke:#0072b2;stroke-width:{width};opacity:1\"><path style=\"fill:none\" d=\"{lines}\"/>\
                     <path d=\"{knobs}\"/><path style=\"fill:#fff\" d=\"{nodes}\"/></g>"
                ),
            );
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use crate::{Document, ReadOptions};

    #[test]
    fn nodes_and_handles_lie_over_the_drawing() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><g transform='translate(10 20)'>\
                   <path d='M0,0C0,9 10,30 40,30L0,60Z'/></g></svg>";
        let shown = Document::read(svg.as_bytes(), "a.svg", &ReadOptions::default()).unwrap().with_nodes_shown();
        assert!(shown.starts_with(svg.trim_end_matches("</svg>")) && shown.ends_with("</g></svg>"), "{shown}");
        let over = Document::read(shown.as_bytes(), "b.svg", &ReadOptions::default()).unwrap();
        let boxes: Vec<_> = over.shapes().iter().map(|s| s.outline.bounding_box().unwrap()).collect();
        let [path, lines, knobs, nodes] = boxes[..] else { panic!("{boxes:?}") };
        // A handle ends at (10, 29), and the other one at (20, 50).
        assert!((lines.x0, lines.y0, lines.x1, lines.y1) == (10.0, 20.0, 50.0, 50.0), "{lines:?}");
        assert!((knobs.center().x - 15.0).abs() < 1e-3 && (knobs.center().y - 39.5).abs() < 1e-3, "{knobs:?}");
        assert!(nodes.center().distance(path.center()) < 1e-9 && nodes.width() > path.width(), "{nodes:?}");
    }
}
