//! Edits of a drawing before it is bent. They shift positions in the document; if selectors use these, elements get ids meanwhile.

use crate::advice;
use crate::bitmap::Bender;
use crate::caption::{captioned, is_caption};
use crate::edits;
use crate::failure::Failure;
use crate::options::{CommonOptions, TOLERANCE_OF_DIAGONAL, distance, measurable};
use crate::units::units_per_px;
use pathwarp::budget::Budget;
use pathwarp::edit::{Contour, Offset, OpenPaths, Side};
use pathwarp::kurbo::{Affine, Join, Rect};
use pathwarp::map::AffineMap;
use pathwarp::param::{Frame, Settings};
use pathwarp::recipe::Step;
use pathwarp::refit;
use pathwarp_svg::engine::CutLine;
use pathwarp_svg::{Document, Edit, PageFit, Painter, ReadOptions, Selection, WarpOptions};
use std::collections::HashSet;
use std::sync::Arc;

/// Default distance of `simplify`, as a fraction of the artwork's diagonal: half a pixel on a screen with a diagonal of a thousand.
const SIMPLIFY_DISTANCE: f64 = 5e-4;

/// An edit with its parameters read.
#[derive(Debug, Clone)]
pub(crate) struct Planned {
    pub(crate) edit: Edit,
    /// The line that the edit `contour` draws.
    pub(crate) line: CutLine,
    /// The tolerance in user units.
    pub(crate) tolerance: f64,
    /// `true` to use smaller tolerances for small contours.
    pub(crate) suited: bool,
}

/// Reads the parameters of an edit for artwork in this frame. If it is the last one of a recipe without further steps, the option
/// `tolerance` is the distance of `simplify`.
pub(crate) fn planned(
    step: &Step,
    options: &CommonOptions,
    (painted, frame): (Option<Rect>, &Frame),
    is_last: bool,
) -> Result<Planned, Failure> {
    let known = edits::info(&step.deformation).map_or(&[][..], |info| info.params);
    let s = Settings::new(known, &step.args, frame)?;
    let tolerance = || distance(options.tolerance, TOLERANCE_OF_DIAGONAL, painted, frame);
    let suited = options.tolerance.is_none();
    let mut line = CutLine::default();
    let (edit, (tolerance, suited)) = match &*step.deformation {
        "simplify" => {
            let corner = s.number_if("corners")?.map(f64::to_radians);
            if let Some(within) = s.number_if("within")? {
                measurable("simplify", within, painted)?;
                (Edit::Simplify { corner }, (within, false))
            } else {
                let given = options.tolerance.filter(|_| is_last);
                let tolerance = distance(given, SIMPLIFY_DISTANCE, painted, frame)?;
                (Edit::Simplify { corner }, (tolerance, given.is_none()))
            }
        }
        "offset" => {
            let join = match s.choice("join")? {
                "miter" => Join::Miter,
                "bevel" => Join::Bevel,
                _ => Join::Round,
            };
            let side = match s.choice("side")? {
                "inside" => Side::Inside,
                "both" => Side::Both,
                _ => Side::Outside,
            };
            let by = s.number("by")?;
            measurable(if is_last { "by" } else { "outset" }, by, painted)?;
            let open = if s.flag("lines")? { OpenPaths::Move } else { OpenPaths::Stay };
            (Edit::Offset(Offset { by, join, side, even_odd: false, open }), (tolerance()?, suited))
        }
        "contour" => {
            line = cut_line(&s)?;
            let (by, holes) = (s.number("by")?, s.choice("holes")? == "keep");
            let contour = Contour { by, holes, join: s.flag("join")? };
            (Edit::Contour(contour), (tolerance()?, suited))
        }
        "caption" => return Err(Failure::usage("a caption is set on a drawing, which a path is not")),
        "unite" => (Edit::Unite { by_fill: s.choice("by")? == "fill" }, (tolerance()?, suited)),
        // The edit `outline`.
        _ => (Edit::Outline, (tolerance()?, suited)),
    };
    Ok(Planned { edit, line, tolerance, suited })
}

/// Reads the settings for the line of a contour.
fn cut_line(s: &Settings<'_>) -> Result<CutLine, Failure> {
    let spot = s.texts("spot").first().map(|name| spot_name(name)).transpose()?;
    let (knockout, only, marks) = (s.flag("knockout")?, s.flag("only")?, s.flag("marks")?);
    if knockout && spot.is_none() {
        return Err(Failure::usage("--knockout is for the ink of --spot"));
    }
    let bleed = s.number_if("bleed")?.unwrap_or(0.0);
    if only && bleed > 0.0 {
        return Err(Failure::usage("--bleed continues the artwork, and --only leaves that out"));
    }
    Ok(CutLine { spot, knockout, only, bleed, marks })
}

/// Returns the name of an ink if PDF can hold it (ISO 32000-1, annex C.2, 7.3.5 and 8.6.6.4).
fn spot_name(name: &str) -> Result<String, Failure> {
    /// Most bytes of a name.
    const LONGEST: usize = 127;
    let needed = match name.trim() {
        "" => "a name of at least one letter",
        n if n.len() > LONGEST => "a name of at most 127 bytes",
        n if n.chars().any(char::is_control) => "a name without control characters",
        "All" | "None" | "Cyan" | "Magenta" | "Yellow" | "Black" => {
            "another name: this one has a meaning of its own in PDF"
        }
        n => return Ok(n.to_owned()),
    };
    Err(Failure::usage(format!("--spot `{name}`: a PDF needs {needed}")))
}

/// Returns the painter that reads the opacity of pictures and continues their edges.
fn painter(budget: &Arc<Budget>) -> Painter {
    Painter::new(Arc::new(Bender::new(Arc::new(AffineMap(Affine::IDENTITY)), None).with_budget(budget.clone())))
}

/// The edits of a drawing, and the selections that they depend on.
#[derive(Debug, PartialEq)]
pub(super) struct Edits {
    pub(super) edits: Vec<Step>,
    /// The selection of everything that is bent.
    pub(super) whole: Selection,
    /// The selection of each step; empty if all steps bend everything.
    pub(super) steps: Vec<Selection>,
}

/// A drawing as it was read, kept while an edited one replaces it.
pub(super) struct Original {
    pub(super) document: Document,
    /// The edits that made the other one.
    pub(super) edits: Edits,
    /// The page that the edits need, if it is larger.
    pub(super) grown: Option<Rect>,
    pub(super) warnings: Vec<String>,
}

/// An edited drawing on the page of its source.
pub(super) struct Edited {
    pub(super) document: Document,
    /// The page that it needs, if it is larger.
    pub(super) grown: Option<Rect>,
    pub(super) warnings: Vec<String>,
}

impl Edits {
    /// Returns the selection of shapes that an edit changes: the edit's, or else the union of the bending steps'.
    fn selection(&self, document: &Document, edit: &Step) -> Selection {
        let exclude = [&self.whole.exclude[..], &edit.exclude].concat();
        let all = Selection { exclude, ..self.whole.clone() };
        let of_edit = [Selection { select: edit.select.clone(), guides: all.guides.clone(), ..Selection::default() }];
        let selections = if edit.select.is_empty() { &self.steps[..] } else { &of_edit };
        let whole = selections.len();
        if whole == 0 {
            return all;
        }
        // Keep the parts in `all`, whose index is `whole`, and in one of the others.
        let mut parts = document.divide(&[selections, &[all]].concat());
        parts.retain(|p| p.among.len() > 1 && p.among.last() == Some(&whole));
        document.united(parts.iter().map(|p| &p.selection))
    }

    /// Returns `true` if a selector names an element without an id by its position.
    fn use_positions(&self) -> bool {
        let of_edits = self.edits.iter().flat_map(|s| s.select.iter().chain(&s.exclude));
        let of_steps = self.steps.iter().chain([&self.whole]).flat_map(|s| s.select.iter().chain(&s.exclude));
        of_edits.chain(of_steps).any(|name| is_position(name))
    }

    /// Returns the drawing with its edits. All selectors match the same elements as in the source.
    pub(super) fn apply(
        &self,
        source: &Document,
        name: &str,
        read: &ReadOptions,
        options: &CommonOptions,
    ) -> Result<Edited, Failure> {
        let (mut warnings, mut grown) = (Vec::new(), None);
        // Edits shift the positions of elements.
        let with_ids =
            self.use_positions().then(|| Document::read(source.with_ids().as_bytes(), name, read)).transpose()?;
        let (captions, edits): (Vec<Step>, Vec<Step>) = self.edits.iter().cloned().partition(is_caption);
        let mut document = match with_ids {
            with_ids if !captions.is_empty() => {
                let (document, lacking) = captioned(with_ids.as_ref().unwrap_or(source), &captions, read, options)?;
                warnings.extend(lacking);
                document
            }
            Some(with_ids) => with_ids,
            None => Document::read(source.source(), name, read)?,
        };
        self.steps.iter().chain([&self.whole]).try_for_each(|s| document.check_selection(s))?;
        for step in &edits {
            let selection = self.selection(&document, step);
            let bounds = document.seen_box(&selection).unwrap_or_else(|| document.view_box());
            let frame = Frame::new(bounds).with_units_per_px(units_per_px(&document));
            let painted = document.painted_box(&selection);
            let Planned { edit, line, tolerance, suited } = planned(step, options, (painted, &frame), false)?;
            let refit = refit::Options::new(tolerance)
                .with_nodes(refit::Nodes::Source)
                .with_suited(suited)
                .with_budget(document.budget().clone());
            let warp = WarpOptions::new(refit)
                .with_selection(selection)
                .with_text(options.text)
                .with_structure(options.structure)
                .with_clones(options.clones)
                .with_on_error(options.on_failure.of_shapes())
                .with_page(PageFit::Auto)
                .with_same_view(true)
                .with_painter(Some(painter(document.budget())))
                .with_line(line)
                .editing(edit);
            let warped = document.warp(&AffineMap(Affine::IDENTITY), &warp)?;
            grown = warped.page.map(|[_, after]| after);
            warnings.extend(warped.warnings.iter().map(ToString::to_string));
            warnings.extend(advice::vanished(warped.shapes.iter()));
            document = Document::read(warped.svg.as_bytes(), name, read)?;
        }
        Ok(Edited { document, grown, warnings })
    }
}

impl Original {
    /// Removes the ids from a result that the edits have added.
    pub(super) fn without_added_ids(&self, svg: &str) -> String {
        let known: HashSet<&str> = ids(self.document.text()).map(|(_, id)| id).collect();
        let (mut out, mut done) = (String::with_capacity(svg.len()), 0);
        for (start, id) in ids(svg).filter(|(_, id)| is_position(id) && !known.contains(id)) {
            out.push_str(&svg[done..start]);
            done = start + ID.len() + id.len() + 1;
        }
        out + &svg[done..]
    }
}

/// The beginning of an attribute that holds an id.
const ID: &str = " id=\"";

/// Finds the ids in a text, with the offsets of their attributes.
fn ids(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.match_indices(ID).filter_map(|(start, _)| Some((start, text[start + ID.len()..].split_once('"')?.0)))
}

/// Returns `true` for the name of an element without an id, which ends with its position, such as `path at 3:5`.
fn is_position(id: &str) -> bool {
    let numbers = id.rsplit_once(" at ").and_then(|(_, position)| position.split_once(':'));
    numbers.is_some_and(|(line, column)| [line, column].iter().all(|n| n.parse::<usize>().is_ok()))
}
