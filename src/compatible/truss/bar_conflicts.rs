//! Finds conflicts: pairs of bars that meet anywhere except at a common node. Selects bars without
//! conflicts.

use super::error::TrussError;
use crate::geometry::{DVec2, SourceTarget, orient2d, segments_touch};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Cancelled, Progress, check_cancelled};

/// Indices of two bars that cannot both be edges of the triangulation, the smaller first. Stored as
/// `u32` to save memory: every bar may conflict with every other.
pub(crate) type BarConflict = [u32; 2];

/// Returns the pairs of bars that cross, touch or overlap in at least one of the designs, other
/// than by ending at a common node. Sorted, without duplicates.
pub(super) fn find_conflicts(
    bars: &[[u32; 2]],
    nodes: SourceTarget<&[DVec2]>,
    progress: &dyn Progress,
) -> Result<Vec<BarConflict>, TrussError> {
    let mut conflicts = conflicts_in(bars, nodes.source, progress)?;
    conflicts.extend(conflicts_in(bars, nodes.target, progress)?);
    conflicts.sort_unstable();
    conflicts.dedup();
    Ok(conflicts)
}

/// Returns the conflicts in one design by a sweep along x. The bars are sorted by their left ends;
/// each bar is compared with the later ones that start before it ends.
pub(crate) fn conflicts_in(
    bars: &[[u32; 2]],
    nodes: &[DVec2],
    progress: &dyn Progress,
) -> Result<Vec<BarConflict>, TrussError> {
    let range = |bar: usize| {
        let [a, b] = bars[bar].map(|node| nodes[node as usize].x);
        (a.min(b), a.max(b))
    };
    let mut order: Vec<usize> = (0..bars.len()).collect();
    order.sort_by(|&i, &j| range(i).0.total_cmp(&range(j).0));
    let mut conflicts = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        check_cancelled(progress)?;
        // The number of conflicts may be quadratic in the number of bars, so it is checked against
        // the resource limit.
        WorkloadKind::CrossingBars.check(conflicts.len(), progress)?;
        let right = range(i).1;
        let later = order[place + 1..].iter();
        for &j in later.take_while(|&&j| range(j).0 <= right) {
            // Most bars that overlap along x do not overlap along y. `segments_touch` rejects these
            // by their bounding boxes, before its exact predicates run.
            if bars_meet(bars[i], bars[j], nodes) {
                conflicts.push([i.min(j), i.max(j)].map(|bar| bar as u32));
            }
        }
    }
    Ok(conflicts)
}

/// Returns whether two bars meet anywhere except at a common node.
fn bars_meet(first: [u32; 2], second: [u32; 2], nodes: &[DVec2]) -> bool {
    let at = |node: u32| nodes[node as usize];
    if let Some(&shared) = first.iter().find(|node| second.contains(node)) {
        let other = |bar: [u32; 2]| at(if bar[0] == shared { bar[1] } else { bar[0] });
        let (n, p, q) = (at(shared), other(first), other(second));
        // Two bars with a common node meet elsewhere only if they overlap, in the same direction
        // from that node.
        return orient2d(n, p, q) == 0.0 && (p - n).dot(q - n) > 0.0;
    }
    segments_touch(first.map(at), second.map(at))
}

/// Removes bars until no conflict is left: each step removes the bar with the most remaining
/// conflicts (ties: the one with the largest index). Returns for each bar whether it remains.
pub(super) fn remove_greedily(
    bars: usize,
    conflicts: &[BarConflict],
    progress: &dyn Progress,
) -> Result<Vec<bool>, Cancelled> {
    let mut opponents: Vec<Vec<u32>> = vec![Vec::new(); bars];
    for &[i, j] in conflicts {
        opponents[i as usize].push(j);
        opponents[j as usize].push(i);
    }
    let mut remaining = vec![true; bars];
    let mut open_conflicts: Vec<usize> = opponents.iter().map(Vec::len).collect();
    while let Some(worst) = (0..bars).max_by_key(|&bar| (open_conflicts[bar], bar))
        && open_conflicts[worst] > 0
    {
        check_cancelled(progress)?;
        remaining[worst] = false;
        open_conflicts[worst] = 0;
        for &other in &opponents[worst] {
            // The count of a bar that was removed earlier is already 0.
            let count = &mut open_conflicts[other as usize];
            *count = count.saturating_sub(1);
        }
    }
    Ok(remaining)
}

/// Returns for each bar whether it conflicts with no other bar.
pub(super) fn uncrossed_bars(bars: usize, conflicts: &[BarConflict]) -> Vec<bool> {
    let mut remaining = vec![true; bars];
    for &bar in conflicts.iter().flatten() {
        remaining[bar as usize] = false;
    }
    remaining
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Silent;

    #[test]
    fn bars_meet_when_they_share_a_point_that_is_no_common_node() {
        let nodes = [
            (0, 0),
            (4, 4),
            (0, 4),
            (4, 0),
            (2, 2),
            (8, 8),
            (5, 5),
            (2, 0),
        ]
        .map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        let meets = |a, b| {
            let (there, back) = (bars_meet(a, b, &nodes), bars_meet(b, a, &nodes));
            assert_eq!(there, back);
            there
        };
        assert!(meets([0, 1], [2, 3]), "crossing");
        assert!(meets([0, 1], [4, 7]), "a node on a bar");
        assert!(meets([0, 1], [0, 4]), "one on the other, from one node");
        assert!(meets([0, 1], [4, 5]), "one on the other");
        assert!(!meets([0, 1], [5, 6]), "on one line, apart");
        assert!(!meets([0, 1], [0, 3]), "a common node");
        assert!(!meets([0, 4], [4, 1]), "in line, a common node");
        assert!(!meets([0, 2], [1, 3]), "parallel");
    }

    #[test]
    fn the_bar_with_most_crossings_goes_first() {
        assert_eq!(
            remove_greedily(4, &[[0, 1], [0, 2], [0, 3]], &Silent),
            Ok(vec![false, true, true, true])
        );
        assert_eq!(
            remove_greedily(3, &[[0, 2]], &Silent),
            Ok(vec![true, true, false])
        );
        assert_eq!(uncrossed_bars(3, &[[0, 2]]), [false, true, false]);
    }
}
