//! Folds of warped shapes: their counts for the report, and the warning.

use pathwarp::Outline;
use pathwarp::fold::Orientation;
use pathwarp::kurbo::Point;
use pathwarp::param::Letter;
use std::collections::HashMap;

/// A fold of one shape.
pub(crate) struct Fold {
    /// Number of orientation changes along the shape, at least 1; 0 if it does not fold.
    pub(crate) count: usize,
    /// The first place where it folds.
    pub(crate) at: Option<Point>,
}

impl Fold {
    /// Compares the orientation of one shape with that of all artwork.
    pub(crate) fn of(shape: &Orientation, all: &Orientation) -> Self {
        let at = shape.folded_against(all);
        Self { count: if at.is_some() { shape.changes.max(1) } else { 0 }, at }
    }

    /// The place as the report has it.
    pub(super) fn place(&self) -> Option<[f64; 2]> {
        self.at.map(|p| [p.x, p.y])
    }
}

/// The warning that the shape `id` folds at `at`, with its letters that fold.
pub(super) fn warning(id: &str, letters: &[String], at: Point) -> String {
    let place = format!("near {:.4},{:.4}: the map reverses orientation there", at.x, at.y);
    match letters {
        // An outlined letter has its name in its id.
        [] => format!("{id} folds over {place}"),
        [one] if id.contains(one.as_str()) => format!("{id} folds over {place}"),
        [one] => format!("{id}: the letter “{one}” folds over {place}"),
        _ => format!("{id}: the letters {} fold over, first {place}", listed(letters)),
    }
}

/// Lists letters; of many, the first.
fn listed(letters: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = letters.iter().take(SHOWN).map(|l| format!("“{l}”")).collect();
    let more = letters.len().saturating_sub(SHOWN);
    shown.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

/// The letters of every shape, by its id.
pub(super) fn letters_by_shape<'a>(
    shapes: impl Iterator<Item = (&'a str, &'a Outline)>,
    letters: &'a [Letter],
) -> HashMap<&'a str, Vec<&'a Letter>> {
    let bits = |p: Point| [p.x.to_bits(), p.y.to_bits()];
    // The outline of a letter is a run of the subpaths of its shape.
    let starting = letters.iter().filter_map(|l| Some((bits(l.outline.subpaths.first()?.start), l)));
    let starting: HashMap<[u64; 2], &Letter> = starting.collect();
    let mut out: HashMap<&str, Vec<&Letter>> = HashMap::new();
    for (id, outline) in shapes {
        let own = outline.subpaths.iter().filter_map(|s| starting.get(&bits(s.start)));
        own.for_each(|l| out.entry(id).or_default().push(l));
    }
    out
}

/// The names of the letters that fold against the artwork as a whole.
pub(super) fn folded(
    letters: Option<&Vec<&Letter>>,
    all: &Orientation,
    orientation: impl Fn(&Outline) -> Orientation,
) -> Vec<String> {
    let folded = letters.into_iter().flatten().filter(|l| orientation(&l.outline).folded_against(all).is_some());
    folded.map(|l| l.name.clone()).collect()
}
