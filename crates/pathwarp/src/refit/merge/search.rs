//! The fewest pieces over the places of a grid.
//!
//! After c pieces only the furthest place matters, nearly: what one cubic covers from some place it also covers from a later
//! one. So the search keeps one place for each number of pieces, extends it as far as one cubic reaches, and compares with
//! the segments' own pieces, which lead from joint to joint.

use super::leg::Leg;
use super::limits::MERGE_GRID;
use super::reach::Reaches;
use kurbo::Point;

/// The furthest place found for some number of pieces.
#[derive(Debug, Clone, Copy)]
struct Furthest {
    place: usize,
    /// The start of the last leg, and `true` if it is merged. `None` if one piece less leads as far.
    leg: Option<(usize, bool)>,
}

/// The way through the grid with the fewest pieces. `None` if there are not fewer than the segments have.
pub(super) fn fewest_legs(reaches: &mut Reaches<'_, '_>) -> Result<Option<Vec<Leg>>, Point> {
    let last = reaches.last();
    let mut furthest = vec![Furthest { place: 0, leg: None }];
    // (number of pieces, joint) that a segment's own pieces lead to.
    let mut by_own = Vec::new();
    for count in 0.. {
        // A segment has at least one piece.
        if count + 1 >= reaches.own.segments() && count + 1 >= reaches.own.total()? {
            break;
        }
        let Furthest { place: k, leg } = furthest[count];
        let joint = k - k % MERGE_GRID;
        let mut best = Furthest { place: reaches.furthest(k)?, leg: Some((k, true)) };
        if let Some((from, true)) = leg
            && let Some(place) = beyond(reaches, [from, joint, k], best.place)?
        {
            best = Furthest { place, leg: Some((joint, true)) };
        }
        // The segment's own pieces matter only if no cubic leads as far. The leg to k may end at the joint before it as well.
        let at_joint = best.place <= joint + MERGE_GRID
            && best.place < last
            && joint < last
            && (joint == k
                || match leg {
                    Some((from, true)) if from < joint => reaches.fits(from, joint)?,
                    _ => false,
                });
        if at_joint {
            by_own.push((count + reaches.own.count(joint / MERGE_GRID)?, joint + MERGE_GRID));
        }
        for &(pieces, to) in &by_own {
            if pieces == count + 1 && to >= best.place && to > k {
                best = Furthest { place: to, leg: Some((to - MERGE_GRID, false)) };
            }
        }
        furthest.push(if best.place > k { best } else { Furthest { place: k, leg: None } });
        if best.place == last {
            return legs(&furthest, reaches).map(Some);
        }
    }
    Ok(None)
}

/// The place that a cubic from `joint` reaches beyond `best`, if it does. The joint lies before `k`, and the cubic that begins at `from`
/// can be shortened to it: its tangent may suit what follows better.
fn beyond(reaches: &mut Reaches<'_, '_>, [from, joint, k]: [usize; 3], best: usize) -> Result<Option<usize>, Point> {
    let limit = reaches.limit(joint);
    let possible = from < joint && joint < k && best < limit;
    if !(possible && reaches.fits(joint, best + 1)? && reaches.fits(from, joint)?) {
        return Ok(None);
    }
    let mut place = best + 1;
    while place < limit && reaches.fits(joint, place + 1)? {
        place += 1;
    }
    Ok(Some(place))
}

/// Follows the legs back from the end.
fn legs(furthest: &[Furthest], reaches: &mut Reaches<'_, '_>) -> Result<Vec<Leg>, Point> {
    let mut legs = Vec::new();
    let mut count = furthest.len() - 1;
    let mut to = reaches.last();
    while to > 0 {
        let Some((from, merged)) = furthest[count].leg else {
            count -= 1;
            continue;
        };
        legs.push(Leg { from, to, merged });
        count -= if merged { 1 } else { reaches.own.count(from / MERGE_GRID)? };
        to = from;
    }
    legs.reverse();
    Ok(legs)
}
