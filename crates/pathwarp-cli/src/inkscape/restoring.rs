//! Sources in place of warped objects, with what was done to the objects by hand.

use super::affine::{Move, Nodes};
use super::line::{allowed, elsewhere, existing, referred};
use super::quoting;
use super::stage::{Scope, Stage, temporary};
use crate::failure::Failure;
use pathwarp::Subpath;
use pathwarp::kurbo::{Affine, Point};
use pathwarp_svg::objects::{self, Guides, Memory, RestoredObject};
use pathwarp_svg::{Document, Selection};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Areas that change by less than this share keep their size: coordinates are rounded to eight digits.
const UNSCALED: f64 = 1e-3;

/// A drawing with sources in place of warped objects.
pub(super) struct Restoration {
    pub(super) svg: String,
    pub(super) objects: Vec<Returned>,
}

/// An object that is its source again.
pub(super) struct Returned {
    pub(super) object: RestoredObject,
    /// The transform, of root user space, that the object was given by hand since it was warped.
    by_hand: Affine,
    /// The drawing as the warp left it.
    then: Rc<str>,
}

/// Puts the sources of objects in place, and finds out how each was moved by hand since it was warped.
///
/// # Errors
/// An object was changed by hand otherwise, unless such changes are to be given up.
pub(super) fn restored(
    stage: &Stage<'_>,
    drawing: &str,
    ids: &[String],
    discard: bool,
) -> Result<Restoration, Failure> {
    let back = objects::restore(drawing, ids, &stage.limits())?;
    let mut objects = Vec::new();
    let mut runs: BTreeMap<&str, Vec<&RestoredObject>> = BTreeMap::new();
    for o in &back.objects {
        runs.entry(&o.recipe).or_default().push(o);
    }
    let now = if runs.is_empty() { None } else { Some(read(stage, drawing)?) };
    let all = objects::objects(&back.svg, &stage.limits())?;
    for (recipe, members) in runs {
        // The warp as it was: by the guides of that time.
        let guides = members.first().map(|m| m.guides.file()).unwrap_or_default();
        let file = temporary(guides.as_bytes())?;
        let line = quoting::split(recipe);
        allowed(stage, &line)?;
        let line = elsewhere(existing(line, &all), &file, |_| true);
        let ids: Vec<String> = members.iter().map(|m| m.id.clone()).collect();
        let text: Rc<str> = stage.warp(&back.svg, &line, &Scope { ids: &ids })?.svg.into();
        for m in members {
            let was = Nodes::read(&m.nodes).unwrap_or_default();
            let is = now.as_ref().map(|now| nodes(now, &m.id)).unwrap_or_default();
            let by_hand = match was.moved_to(&is) {
                Move::By(a) => a,
                Move::Otherwise if discard => Affine::IDENTITY,
                Move::Otherwise => return Err(changed_by_hand(&m.id)),
            };
            // Artwork follows guides that are still there.
            let guided = referred(&quoting::split(recipe)).iter().any(|id| all.iter().any(|o| o.id == *id));
            let by_hand = if guided { Affine::IDENTITY } else { by_hand };
            objects.push(Returned { object: m.clone(), by_hand, then: Rc::clone(&text) });
        }
    }
    Ok(Restoration { svg: back.svg, objects })
}

fn changed_by_hand(id: &str) -> Failure {
    Failure::usage(format!(
        "the shape of {id} was changed by hand after it was warped, and the change would be lost; allow that, or warp the result \
         instead"
    ))
}

/// Does to objects again what had been done to them by hand since they were warped: colours, labels, places. `now` is the drawing
/// as it was before their sources came back.
pub(super) fn as_by_hand(
    stage: &Stage<'_>,
    now: &str,
    mut svg: String,
    objects: &[Returned],
) -> Result<String, Failure> {
    for r in objects {
        // An editor that scales an object scales its stroke width, too; the transform below does so again.
        let is_scaled = (r.by_hand.determinant().abs() - 1.0).abs() > UNSCALED;
        let except: &[&str] = if is_scaled { &["stroke-width", "stroke-dasharray", "stroke-dashoffset"] } else { &[] };
        svg = objects::restyled([&r.then, now, &svg], &r.object.id, except, &stage.limits())?;
    }
    for r in objects.iter().filter(|r| r.by_hand != Affine::IDENTITY) {
        svg = objects::moved(&svg, &r.object.id, r.by_hand, &stage.limits())?;
    }
    Ok(svg)
}

/// Reads a drawing.
pub(super) fn read(stage: &Stage<'_>, svg: &str) -> Result<Document, Failure> {
    let options = pathwarp_svg::ReadOptions::default().with_limits(stage.limits());
    Ok(Document::read(svg.as_bytes(), "the drawing", &options)?)
}

/// The nodes of an object in root user space.
pub(super) fn nodes(doc: &Document, id: &str) -> Nodes {
    let selection = Selection { select: vec![format!("[id={id}]")], ..Selection::default() };
    let subpaths = |s: &pathwarp_svg::Shape| s.outline.subpaths.iter().flat_map(Subpath::anchors).collect::<Vec<_>>();
    Nodes::of(&doc.selected(&selection).flat_map(subpaths).collect::<Vec<Point>>())
}

/// Makes objects of a result remember their sources, in `before`.
pub(super) fn remembering(
    stage: &Stage<'_>,
    before: &str,
    result: &str,
    ids: &[String],
    recipe: &str,
    guides: &Guides,
) -> Result<String, Failure> {
    let doc = read(stage, result)?;
    let memory = |id: &String| {
        let nodes = nodes(&doc, id).text();
        Memory { id: id.clone(), recipe: recipe.to_owned(), guides: guides.clone(), nodes }
    };
    let memories: Vec<Memory> = ids.iter().map(memory).collect();
    Ok(objects::remember(before, result, &memories, &stage.limits())?)
}
