//! Definitions written so far, with their ids.

use crate::scene::model::Scene;
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use crate::source::xml::escape;
use pathwarp::kurbo::Affine;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::ops::Range;

/// Key of a gradient or pattern: its address and the fit applied to it.
pub(super) type ServerKey = (usize, [u64; 6]);

/// Definitions written so far. Each is written once, when it is first referred to.
pub(super) struct Definitions {
    /// Text of the definitions.
    pub(super) text: String,
    /// Ids in use.
    pub(super) taken: HashSet<String>,
    /// Ids of clip paths and masks by index, once they have one.
    pub(super) clip_ids: Vec<Option<String>>,
    pub(super) mask_ids: Vec<Option<String>>,
    /// Ids of gradients and patterns.
    pub(super) servers: HashMap<ServerKey, String>,
    /// Ids of filters by address.
    pub(super) filters: HashMap<usize, String>,
    /// Definitions are added to the source.
    in_source: bool,
    /// The element of the source that is being replaced.
    pub(super) replaced: Option<Replaced>,
}

/// An element of the source that is being replaced, so that its ids become free.
pub(super) struct Replaced {
    range: Range<usize>,
    /// Elements inside whose ids have been written.
    named: BTreeSet<ElementId>,
}

impl Replaced {
    pub(super) fn new(range: Range<usize>) -> Self {
        Self { range, named: BTreeSet::new() }
    }
}

impl Definitions {
    pub(super) fn new(source: &SourceText, scene: &Scene, in_source: bool) -> Self {
        Self {
            text: String::new(),
            taken: if in_source { source.by_id().keys().cloned().collect() } else { HashSet::new() },
            clip_ids: vec![None; scene.clips.len()],
            mask_ids: vec![None; scene.masks.len()],
            servers: HashMap::new(),
            filters: HashMap::new(),
            in_source,
            replaced: None,
        }
    }

    /// Returns `id` if it is free, else with a number appended.
    pub(super) fn new_id(&mut self, id: &str) -> String {
        let mut out = id.to_owned();
        let mut n = 1;
        while !self.taken.insert(out.clone()) {
            n += 1;
            out = format!("{id}-{n}");
        }
        out
    }

    /// The id of a source element as an attribute, for the element that takes its place; empty if the id is not free.
    pub(super) fn id_attribute(&mut self, source: &SourceText, e: ElementId) -> String {
        let Some(id) = source.attr(e, "id").filter(|i| !i.is_empty()) else { return String::new() };
        let free = match &mut self.replaced {
            Some(r) => r.range.contains(&source.elements[e].range.start) && r.named.insert(e),
            None => !self.in_source && self.taken.insert(id.to_string()),
        };
        if free { format!(" id=\"{}\"", escape(&id)) } else { String::new() }
    }

    pub(super) fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }
}

pub(super) fn server_key(address: usize, fit: Affine) -> ServerKey {
    (address, fit.as_coeffs().map(f64::to_bits))
}
