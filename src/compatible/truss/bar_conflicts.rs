//! Which bars meet away from a common node, and which of them to keep.

use super::error::TrussError;
use crate::geometry::{DVec2, SourceTarget, orient2d, segments_touch};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Cancelled, Progress, still_wanted};

/// Two bars that cannot both stay; short, since all bars may cross all others.
pub(super) type BarConflict = [u32; 2];

/// Pairs of bars, the smaller index first, that cross, touch or lie on each
/// other in at least one of the designs, other than by ending at one node.
pub(super) fn find_conflicts(
    bars: &[[u32; 2]],
    nodes: SourceTarget<&[DVec2]>,
    progress: &dyn Progress,
) -> Result<Vec<BarConflict>, TrussError> {
    let mut conflicts = in_one(bars, nodes.source, progress)?;
    conflicts.extend(in_one(bars, nodes.target, progress)?);
    conflicts.sort_unstable();
    conflicts.dedup();
    Ok(conflicts)
}

/// Bars sorted by their left ends, each tested against those that begin
/// before it ends.
fn in_one(
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
    let mut found = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        still_wanted(progress)?;
        WorkloadKind::CrossingBars.allow(found.len(), progress)?;
        let right = range(i).1;
        let rest = order[place + 1..].iter();
        for &j in rest.take_while(|&&j| range(j).0 <= right) {
            // Most that overlap along x still lie above each other: the test's
            // boxes tell that before its exact signs do.
            if meet(bars[i], bars[j], nodes) {
                found.push([i.min(j), i.max(j)].map(|bar| bar as u32));
            }
        }
    }
    Ok(found)
}

fn meet(first: [u32; 2], second: [u32; 2], nodes: &[DVec2]) -> bool {
    let at = |node: u32| nodes[node as usize];
    if let Some(&shared) = first.iter().find(|node| second.contains(node)) {
        let other = |bar: [u32; 2]| at(if bar[0] == shared { bar[1] } else { bar[0] });
        let (n, p, q) = (at(shared), other(first), other(second));
        // Two bars of one node meet again only if they lie on each other.
        return orient2d(n, p, q) == 0.0 && (p - n).dot(q - n) > 0.0;
    }
    segments_touch(first.map(at), second.map(at))
}

/// Keeps as many bars as the greedy rule leaves: the one with the most
/// conflicts goes first, of equal ones the last.
pub(super) fn remove_greedily(
    bars: usize,
    conflicts: &[BarConflict],
    progress: &dyn Progress,
) -> Result<Vec<bool>, Cancelled> {
    let mut against: Vec<Vec<u32>> = vec![Vec::new(); bars];
    for &[i, j] in conflicts {
        against[i as usize].push(j);
        against[j as usize].push(i);
    }
    let mut kept = vec![true; bars];
    let mut open: Vec<usize> = against.iter().map(Vec::len).collect();
    while let Some(worst) = (0..bars).max_by_key(|&bar| (open[bar], bar))
        && open[worst] > 0
    {
        still_wanted(progress)?;
        kept[worst] = false;
        open[worst] = 0;
        for &other in &against[worst] {
            // What went before has none left.
            let open = &mut open[other as usize];
            *open = open.saturating_sub(1);
        }
    }
    Ok(kept)
}

/// Keeps the bars without any conflict.
pub(super) fn keep_uncrossed(bars: usize, conflicts: &[BarConflict]) -> Vec<bool> {
    let mut kept = vec![true; bars];
    for &bar in conflicts.iter().flatten() {
        kept[bar as usize] = false;
    }
    kept
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
            let (one, other) = (meet(a, b, &nodes), meet(b, a, &nodes));
            assert_eq!(one, other);
            one
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
        assert_eq!(keep_uncrossed(3, &[[0, 2]]), [false, true, false]);
    }
}
