//! The elimination tree of a restricted ordering, and its postorder.
//!
//! A supernodal factor wants columns that share their pattern side by side. Minimum degree delivers a postorder, but
//! restricting it to the free vertices breaks that, so the restricted order is put into postorder again: the same
//! fill, the same work, but wide supernodes. Neither needs the matrix: the graph is given as a walk over neighbours.

const NONE: u32 = u32::MAX;

/// The parent of each column in the elimination tree (Liu 1986), `u32::MAX` at a root.
///
/// `visit(column, sink)` calls the sink for each column that shares an entry with `column`, in any order, repeated or
/// not; those not below `column` are ignored.
pub(crate) fn elimination_tree(column_count: usize, mut visit: impl FnMut(u32, &mut dyn FnMut(u32))) -> Vec<u32> {
    let mut parent = vec![NONE; column_count];
    let mut ancestor = vec![NONE; column_count];
    for column in 0..column_count as u32 {
        visit(column, &mut |mut below| {
            while below < column {
                let next = std::mem::replace(&mut ancestor[below as usize], column);
                if next == NONE {
                    parent[below as usize] = column;
                    return;
                }
                below = next;
            }
        });
    }
    parent
}

/// The columns in postorder: children before parents, each subtree in one piece, siblings ascending.
pub(crate) fn postorder(parent: &[u32]) -> Vec<u32> {
    let mut first_child = vec![NONE; parent.len()];
    let mut next_sibling = vec![NONE; parent.len()];
    let mut first_root = NONE;
    for column in (0..parent.len() as u32).rev() {
        let head = match parent[column as usize] {
            NONE => &mut first_root,
            above => &mut first_child[above as usize],
        };
        next_sibling[column as usize] = std::mem::replace(head, column);
    }
    let mut order = Vec::with_capacity(parent.len());
    let mut stack = Vec::new();
    let mut root = first_root;
    while root != NONE {
        stack.push(root);
        while let Some(&column) = stack.last() {
            let child = std::mem::replace(&mut first_child[column as usize], NONE);
            if child == NONE {
                stack.pop();
                order.push(column);
                let sibling = next_sibling[column as usize];
                if sibling != NONE && !stack.is_empty() {
                    stack.push(sibling);
                }
            } else {
                stack.push(child);
            }
        }
        root = next_sibling[root as usize];
    }
    order
}

#[cfg(test)]
mod tests {
    use super::{NONE, elimination_tree, postorder};

    #[test]
    fn an_arrow_pointing_down_is_a_star_and_one_pointing_up_a_chain() {
        let last_with_all = |column: u32, sink: &mut dyn FnMut(u32)| {
            if column == 4 {
                (0..4).for_each(sink);
            } else {
                sink(4);
            }
        };
        assert_eq!(elimination_tree(5, last_with_all), [4, 4, 4, 4, NONE]);
        let first_with_all = |column: u32, sink: &mut dyn FnMut(u32)| {
            if column == 0 {
                (1..5).for_each(sink);
            } else {
                sink(0);
            }
        };
        assert_eq!(elimination_tree(5, first_with_all), [1, 2, 3, 4, NONE]);
    }

    #[test]
    fn children_come_before_parents_and_subtrees_stay_together() {
        let parent = [5, 4, 5, 4, 6, 6, NONE, NONE, 7];
        let order = postorder(&parent);
        assert_eq!(order, [1, 3, 4, 0, 2, 5, 6, 8, 7]);
    }
}
