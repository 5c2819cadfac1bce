//! The tree of supernodes, cut into independent subtrees that can be worked on beside each other.
//!
//! Columns stand in postorder, so a subtree is a run of supernodes, its columns a run of columns and its numbers one
//! slice of the factor. The cut depends on the work alone, never on the number of threads: a subtree is a task once it
//! holds at most a [`SHARE`]th of all work. What stands above the cut, the *top*, has few supernodes and large ones.

use std::ops::Range;

use crate::sparse::symbolic::{ROOT, Symbolic};

/// A task has at most one over this of the whole work. Fewer, larger tasks leave less to the top, whose supernodes run
/// one by one: on two cores at 183,208 free vertices, tasks and top took 413 + 135 ms at 3, 377 + 213 at 5, 364 + 250 at
/// 8 and 270 + 330 at 24.
const SHARE: f64 = 4.0;

/// The supernodes' tree and its cut.
#[derive(Debug)]
pub(crate) struct Forest {
    /// Runs of supernodes, ascending and without gaps: a task's subtree, or one supernode of the top.
    pub parts: Vec<Part>,
    /// The supernodes' patterns, one after the other as the factor has them, in the coordinates of their part: in a
    /// task its own columns from 0 on, then the rows of its root's pattern; in the top the factor's columns.
    pub places: Vec<u32>,
}

/// One run of supernodes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Part {
    /// A subtree that depends on nothing outside; its last supernode is its root.
    Task(Range<usize>),
    /// A supernode above the cut.
    Top(usize),
}

impl Forest {
    /// Cuts the tree of the factor's supernodes.
    pub fn of(symbolic: &Symbolic) -> Self {
        let count = symbolic.block_count();
        let mut work: Vec<f64> = (0..count).map(|s| symbolic.work(s)).collect();
        let total: f64 = work.iter().sum();
        let mut first: Vec<usize> = (0..count).collect();
        let mut size = vec![1; count];
        let parent = &symbolic.parent;
        for s in (0..count).filter(|&s| parent[s] != ROOT) {
            let above = parent[s] as usize;
            work[above] += work[s];
            first[above] = first[above].min(first[s]);
            size[above] += size[s];
        }
        let small = |s: usize| work[s] * SHARE <= total;
        let mut parts = Vec::new();
        let mut next = 0;
        for s in 0..count {
            let is_root_of_task = small(s) && (parent[s] == ROOT || !small(parent[s] as usize));
            if is_root_of_task && first[s] >= next && size[s] == s + 1 - first[s] {
                // Whatever stands before the subtree and is in no task goes to the top.
                parts.extend((next..first[s]).map(Part::Top));
                parts.push(Part::Task(first[s]..s + 1));
                next = s + 1;
            }
        }
        parts.extend((next..count).map(Part::Top));
        let places = places(symbolic, &parts);
        Self { parts, places }
    }
}

fn places(symbolic: &Symbolic, parts: &[Part]) -> Vec<u32> {
    let mut places = symbolic.rows.clone();
    let mut outside = vec![0; symbolic.column_count()];
    for part in parts {
        let Part::Task(range) = part else { continue };
        let (start, end) = (
            symbolic.columns(range.start).start as u32,
            symbolic.columns(range.end - 1).end as u32,
        );
        for (place, &row) in (end - start..).zip(symbolic.pattern(range.end - 1)) {
            outside[row as usize] = place;
        }
        for s in range.clone() {
            for place in &mut places[symbolic.pattern_range(s)] {
                let row = *place;
                *place = if row < end { row - start } else { outside[row as usize] };
            }
        }
    }
    places
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::Part;
    use crate::sparse::cholesky::tests::factor_of;
    use crate::sparse::symbolic::ROOT;
    use pliant_mesh::shapes;

    #[test]
    fn subtrees_cover_all_and_need_nothing_from_each_other() {
        for (name, drawn) in [
            ("torus", shapes::torus(40, 30)),
            ("two", shapes::together(&[shapes::torus(9, 7), shapes::grid(20, 20)])),
        ] {
            let factor = factor_of(drawn);
            let (symbolic, forest) = factor.parts();
            let mut next = 0;
            let mut tasks = 0;
            for part in &forest.parts {
                let range = match part {
                    Part::Task(range) => range.clone(),
                    Part::Top(s) => *s..s + 1,
                };
                assert_eq!(range.start, next, "{name}");
                next = range.end;
                if matches!(part, Part::Task(_)) {
                    tasks += 1;
                    for s in range.clone() {
                        let parent = symbolic.parent[s];
                        let is_root = s + 1 == range.end;
                        assert!(is_root || (parent as usize) < range.end, "{name}");
                        // Nothing below the columns of another task: what lies outside is in the root's pattern.
                        let outside = symbolic.pattern(range.end - 1);
                        let end = symbolic.columns(range.end - 1).end;
                        let beyond = symbolic.pattern(s).iter().filter(|row| **row as usize >= end);
                        assert!(is_root || beyond.clone().all(|row| outside.contains(row)), "{name}");
                    }
                }
            }
            assert_eq!(next, symbolic.block_count(), "{name}");
            assert!(tasks > 1 && symbolic.parent.contains(&ROOT), "{name}: {tasks}");
            assert!((0..next).all(|s| symbolic.pattern(s).is_sorted()), "{name}");
        }
    }
}
