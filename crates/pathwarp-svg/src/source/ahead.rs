//! Outlines of `path` elements, read on another thread while usvg reads the same text, which takes as long.

use super::element::Element;
use super::parallel::map_parallel;
use super::tags::ElementId;
use pathwarp::Outline;
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

/// The outlines, once they are read.
pub(crate) type Ahead = Arc<OnceLock<HashMap<ElementId, Arc<Outline>>>>;

/// Bytes of source text below which starting threads takes longer than reading the outlines.
pub(crate) const WORTH_THREADS: usize = 200_000;

/// Reads the outlines of all `path` elements.
pub(super) fn read(text: &str, elements: &[Element]) -> HashMap<ElementId, Arc<Outline>> {
    let paths: Vec<ElementId> = (0..elements.len()).filter(|e| elements[*e].tag == "path").collect();
    let outline = |i: usize| {
        let d = elements[paths[i]].attr(text, "d")?;
        Some((paths[i], Arc::new(Outline::from_svg_lossy(&d))))
    };
    map_parallel(paths.len(), outline).into_iter().flatten().collect()
}
