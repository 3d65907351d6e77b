//! Parts of a drawing whose coordinates are out of range. They are not warped, and count in no bounding box.

use super::model::Scene;
use super::shape::Shape;
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use pathwarp::Outline;
use pathwarp_reader::LARGEST;
use std::collections::{BTreeSet, HashSet};

/// The parts that are out of range, and the reasons.
#[derive(Debug, Default)]
pub(crate) struct Far {
    /// One for each part; empty if there are none.
    parts: Vec<bool>,
    /// Names of elements, each with the reason.
    pub(crate) reasons: Vec<(String, String)>,
}

impl Far {
    /// Finds the parts.
    pub(super) fn of(source: &SourceText, scene: &Scene, shapes: &[Shape]) -> Self {
        let reach: Vec<bool> = shapes.iter().map(|s| !is_near(&s.outline)).collect();
        if source.far.is_empty() && !reach.contains(&true) {
            return Self::default();
        }
        let numbers = &source.far;
        let named: HashSet<ElementId> = numbers.iter().map(|n| n.0).collect();
        let inside = |e: Option<ElementId>| e.is_some_and(|e| source.ancestors(e).any(|a| named.contains(&a)));
        let mut reasons: Vec<(String, String)> = numbers
            .iter()
            .map(|(e, n)| {
                (source.display_name(*e), format!("its number {n} is out of range, which ends at {LARGEST:e}"))
            })
            .collect();
        let (mut parts, mut told) = (Vec::with_capacity(reach.len()), BTreeSet::new());
        for ((p, shape), far) in scene.parts.iter().zip(shapes).zip(reach) {
            let by_number = inside(p.source) || inside(p.owner) || inside(p.drawn);
            if far && !by_number && told.insert(&shape.id) {
                let why = format!("it extends beyond the range of coordinates, which ends at {LARGEST:e}");
                reasons.push((shape.id.clone(), why));
            }
            parts.push(far || by_number);
        }
        Self { parts, reasons }
    }

    /// Returns `true` if part `i` is out of range.
    pub(crate) fn holds(&self, i: usize) -> bool {
        self.parts.get(i).is_some_and(|far| *far)
    }
}

/// Returns `true` if all points of an outline are in range.
fn is_near(o: &Outline) -> bool {
    o.segs().all(|s| {
        let [a, b] = [s.start(), s.end()];
        // The middle stands for control points. What is not a number is not in range, either.
        let m = s.eval(0.5);
        [a.x, a.y, b.x, b.y, m.x, m.y].iter().all(|v| v.abs() < LARGEST)
    })
}
