//! Definitions written so far, with their ids.

use crate::scene::geometry::rect;
use crate::scene::model::Scene;
use crate::source::elements::ElementId;
use crate::source::text::SourceText;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp_reader::xml::escape;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;
use usvg::filter::Filter;

/// Key of a gradient or pattern: its address and the fit applied to it.
type ServerKey = (usize, [u64; 6]);

/// Key of a filter: its address and its region.
type FilterKey = (usize, [u64; 4]);

/// Definitions written so far. Each one is written once, for the first reference to it.
#[derive(Default)]
pub(super) struct Definitions {
    /// Text of the definitions.
    pub(super) text: String,
    /// Ids in use.
    pub(super) taken: HashSet<String>,
    /// The last numbers appended to ids, by id.
    numbers: HashMap<String, usize>,
    /// Ids of the clip paths that have one so far, by index.
    pub(super) clip_ids: Vec<Option<String>>,
    /// Ids of the masks that have one so far, by index.
    pub(super) mask_ids: Vec<Option<String>>,
    /// Ids of gradients and patterns.
    pub(super) servers: HashMap<ServerKey, String>,
    /// Ids of mesh gradients by their content.
    pub(super) meshes: HashMap<String, String>,
    /// Ids of filters.
    pub(super) filters: HashMap<FilterKey, String>,
    /// New regions of the source's filters, by their ids.
    pub(super) regions: BTreeMap<String, Rect>,
    /// `true` if definitions are added to the source.
    in_source: bool,
    /// The element of the source that is being replaced.
    pub(super) replaced: Option<Replaced>,
}

/// An element of the source that is being replaced, so that its ids become free.
pub(super) struct Replaced {
    pub(super) range: Range<usize>,
    /// Elements in this range whose ids have been written.
    pub(super) named: BTreeSet<ElementId>,
}

impl Definitions {
    pub(super) fn new(source: &SourceText, scene: &Scene, in_source: bool) -> Self {
        let taken = if in_source { source.by_id().keys().cloned().collect() } else { HashSet::new() };
        let (clip_ids, mask_ids) = (vec![None; scene.clips.len()], vec![None; scene.masks.len()]);
        Self { taken, clip_ids, mask_ids, in_source, ..Self::default() }
    }

    /// Returns `id` if it is free, or else with a number appended.
    pub(super) fn new_id(&mut self, id: &str) -> String {
        if self.taken.insert(id.to_owned()) {
            return id.to_owned();
        }
        // Used ids stay in use, so the search starts where the last one ended.
        let n = self.numbers.entry(id.to_owned()).or_insert(1);
        loop {
            *n += 1;
            let numbered = format!("{id}-{n}");
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }

    /// The id of a source element as an attribute, for the element that replaces it; empty if the id is not free.
    pub(super) fn id_attribute(&mut self, source: &SourceText, e: ElementId) -> String {
        let Some(id) = source.attr(e, "id").filter(|i| !i.is_empty()) else { return String::new() };
        let is_free = match &mut self.replaced {
            Some(r) => r.range.contains(&source.elements[e].range.start) && r.named.insert(e),
            None => !self.in_source && self.taken.insert(id.to_string()),
        };
        if is_free { format!(" id=\"{}\"", escape(&id)) } else { String::new() }
    }

    /// Enlarges the region of a filter of the source to contain `region`.
    pub(super) fn grow(&mut self, f: &Filter, region: Rect) {
        let before = rect(f.rect().to_rect());
        if region != before {
            let all = self.regions.entry(f.id().to_owned()).or_insert(before);
            *all = all.union(region);
        }
    }

    pub(super) fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }
}

pub(super) fn filter_key(f: &Arc<Filter>, region: Rect) -> FilterKey {
    (Arc::as_ptr(f) as usize, [region.x0, region.y0, region.x1, region.y1].map(f64::to_bits))
}

pub(super) fn server_key(address: usize, fit: Affine) -> ServerKey {
    (address, fit.as_coeffs().map(f64::to_bits))
}

/// Returns `true` if another gradient can take its `stops` from the source's gradient `id`: the id is unique, its chain of links ends, and
/// the chain's last gradient with stops has as many. The reader adds stops to gradients in linear light, which the source lacks.
pub(super) fn has_usable_stops(source: &SourceText, id: &str, stops: usize) -> bool {
    /// Longest chain of links followed.
    const LONGEST: usize = 16;
    let count = |e| source.descendants(e).filter(|s| *source.elements[*s].tag == *"stop").count();
    let (mut next, mut last_count) = (Some(id.to_owned()), 0);
    for _ in 0..LONGEST {
        let Some(id) = next else { return last_count >= stops };
        match source.by_id().get(&id).map(Vec::as_slice) {
            Some(&[e]) if source.elements[e].tag.ends_with("Gradient") => {
                last_count = Some(count(e)).filter(|n| *n > 0).unwrap_or(last_count);
                next = source.href(e);
            }
            _ => return false,
        }
    }
    // The links may form a cycle, which renderers may follow forever.
    false
}
