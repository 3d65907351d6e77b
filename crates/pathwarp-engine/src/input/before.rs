//! Edits of a drawing before it is bent: `--simplify` and `--outset`.

use crate::edits;
use crate::failure::Failure;
use crate::options::{CommonOptions, measurable};
use crate::readable::listed;
use crate::units::units_per_px;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp::map::AffineMap;
use pathwarp::param::{Axis, Frame, Length};
use pathwarp::refit;
use pathwarp_svg::{Document, PageFit, ReadOptions, Selection, WarpOptions};
use std::collections::HashSet;

/// What is done to a drawing, and to what of it.
#[derive(Debug, PartialEq)]
pub(super) struct Wanted {
    lengths: [Option<Length>; 2],
    /// What is bent at all.
    whole: Selection,
    /// What each step bends; empty if all bend everything.
    steps: Vec<Selection>,
}

/// A drawing as it was read, while an edited one stands in for it.
pub(super) struct Original {
    pub(super) document: Document,
    pub(super) wanted: Wanted,
    /// The page that the edits need, if that is larger.
    pub(super) grown: Option<Rect>,
    pub(super) warnings: Vec<String>,
}

/// An edited drawing on the page of its source.
pub(super) struct Edited {
    pub(super) document: Document,
    /// The page that it needs, if that is larger.
    pub(super) grown: Option<Rect>,
    pub(super) warnings: Vec<String>,
}

impl Wanted {
    pub(super) fn new(
        document: &Document,
        options: &CommonOptions,
        whole: Selection,
        steps: Vec<Selection>,
    ) -> Result<Self, Failure> {
        steps.iter().try_for_each(|s| document.check_selection(s))?;
        Ok(Self { lengths: [options.simplify, options.outset], whole, steps })
    }

    /// What is bent at all.
    pub(super) fn whole(&self) -> &Selection {
        &self.whole
    }

    /// What any step bends.
    fn concerned(&self, document: &Document) -> Selection {
        let whole = self.steps.len();
        if whole == 0 {
            return self.whole.clone();
        }
        let all: Vec<Selection> = self.steps.iter().chain([&self.whole]).cloned().collect();
        let mut parts = document.divide(&all);
        parts.retain(|p| p.among.len() > 1 && p.among.last() == Some(&whole));
        document.united(parts.iter().map(|p| &p.selection))
    }

    /// A selector names an element without an id by its place.
    fn names_places(&self) -> bool {
        let selectors = |s: &Selection| s.select.iter().chain(&s.exclude).any(|name| is_place(name));
        self.steps.iter().chain([&self.whole]).any(selectors)
    }

    /// The drawing with its edits, in which all selectors find the same as in the source.
    pub(super) fn done(
        &self,
        source: &Document,
        name: &str,
        read: &ReadOptions,
        options: &CommonOptions,
    ) -> Result<Edited, Failure> {
        const NAMED: usize = 5;
        let (mut warnings, mut grown) = (Vec::new(), None);
        // Places shift.
        let text = if self.names_places() { source.with_ids().into() } else { source.source().to_vec() };
        let mut document = Document::read(&text, name, read)?;
        for (option, length) in ["simplify", "outset"].into_iter().zip(self.lengths) {
            let Some(length) = length else { continue };
            let selection = self.concerned(&document);
            let bounds = document.seen_box(&selection).unwrap_or_else(|| document.view_box());
            let frame = Frame::new(bounds).with_units_per_px(units_per_px(&document));
            let distance = length.in_units(Axis::Diagonal, &frame);
            let painted = document.painted_box(&selection);
            measurable(option, distance.abs(), painted)?;
            let usual = options.tolerance_for(painted, &frame)?;
            let (edit, tolerance, suited) = match option {
                "simplify" => (edits::simplifying(), distance, false),
                _ => (edits::growing(distance), usual, options.tolerance.is_none()),
            };
            let refit = refit::Options::new(tolerance).with_suited(suited).with_budget(document.budget().clone());
            let warp = WarpOptions::new(refit)
                .with_selection(selection)
                .with_text(options.text)
                .with_structure(options.structure)
                .with_clones(options.clones)
                .with_on_error(options.on_failure.of_shapes())
                .with_page(PageFit::Auto)
                .with_same_view(true)
                .editing(edit);
            let warped = document.warp(&AffineMap(Affine::IDENTITY), &warp)?;
            grown = warped.page.map(|[_, after]| after);
            warnings.extend(warped.warnings.iter().map(ToString::to_string));
            let gone = warped.shapes.iter().filter(|s| s.path.segments_in > 0 && s.path.segments_out == 0);
            let gone: Vec<&str> = gone.map(|s| s.id.as_str()).collect();
            if !gone.is_empty() {
                warnings.push(format!("nothing is left of {}: narrower than the distance", listed(&gone, NAMED)));
            }
            document = Document::read(warped.svg.as_bytes(), name, read)?;
        }
        Ok(Edited { document, grown, warnings })
    }
}

impl Original {
    /// A result without the ids that the edited drawing has and the source has not.
    pub(super) fn without_ids(&self, svg: &str) -> String {
        let own: HashSet<&str> = ids(self.document.text()).map(|(_, id)| id).collect();
        let (mut out, mut done) = (String::with_capacity(svg.len()), 0);
        for (at, id) in ids(svg).filter(|(_, id)| is_place(id) && !own.contains(id)) {
            out.push_str(&svg[done..at]);
            done = at + ID.len() + id.len() + 1;
        }
        out.push_str(&svg[done..]);
        out
    }
}

const ID: &str = " id=\"";

/// The ids in a text, and where their attributes begin.
fn ids(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.match_indices(ID).filter_map(|(at, _)| Some((at, text[at + ID.len()..].split_once('"')?.0)))
}

/// Returns `true` for the name of an element without an id: its place.
fn is_place(id: &str) -> bool {
    let numbers = id.rsplit_once(" at ").and_then(|(_, place)| place.split_once(':'));
    numbers.is_some_and(|(line, column)| [line, column].iter().all(|n| n.parse::<usize>().is_ok()))
}
