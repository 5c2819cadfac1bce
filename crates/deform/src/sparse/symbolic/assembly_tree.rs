//! The assembly tree of supernodes, cut into parts that can be processed in parallel.
//!
//! Columns are in postorder, so a subtree is a run of supernodes and its columns are a run of columns. A subtree of
//! little work is one part; each supernode above, in the *top*, is a separate part. The cut depends only on the work
//! below: neither on the number of threads nor on the rest of the surface.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::Scope;

use crate::sparse::symbolic::{ROOT, Symbolic};

/// The number of multiplications and additions of a subtree that is one part.
const PART: f64 = 3e7;

/// The supernodes' tree and its cut.
#[derive(Clone, Debug)]
pub(crate) struct AssemblyTree {
    /// Runs of supernodes, ascending and without gaps, children before parents.
    pub parts: Vec<Part>,
    /// The supernodes' patterns, one after the other in the factor's order, in the coordinates of their part: its own
    /// columns from 0 on, then the rows of its last supernode's pattern.
    pub places: Vec<u32>,
}

/// One run of supernodes: a subtree whose last supernode is its root, or one supernode above the cut.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Part {
    pub supernodes: Range<usize>,
    pub columns: Range<usize>,
    /// The part that receives this one's contribution.
    pub parent: Option<usize>,
    /// The parts whose contributions this one assembles, ascending.
    pub children: Vec<usize>,
    /// The rows of its last supernode's pattern in the coordinates of the parent.
    pub outside: Vec<u32>,
}

impl AssemblyTree {
    /// Cuts the tree of the factor's supernodes.
    pub fn of(symbolic: &Symbolic) -> Self {
        let count = symbolic.supernode_count();
        let mut work: Vec<f64> = (0..count).map(|s| symbolic.work(s)).collect();
        let mut first: Vec<usize> = (0..count).collect();
        let mut size = vec![1; count];
        let parent = &symbolic.parent;
        for s in (0..count).filter(|&s| parent[s] != ROOT) {
            let above = parent[s] as usize;
            work[above] += work[s];
            first[above] = first[above].min(first[s]);
            size[above] += size[s];
        }
        let small = |s: usize| work[s] <= PART;
        let mut runs = Vec::new();
        let mut next = 0;
        for s in 0..count {
            let is_root_of_part = small(s) && (parent[s] == ROOT || !small(parent[s] as usize));
            if is_root_of_part && first[s] >= next && size[s] == s + 1 - first[s] {
                // Supernodes before the subtree that are in no part yet are separate parts.
                runs.extend((next..first[s]).map(|s| s..s + 1));
                runs.push(first[s]..s + 1);
                next = s + 1;
            }
        }
        runs.extend((next..count).map(|s| s..s + 1));
        Self {
            places: places(symbolic, &runs),
            parts: parts(symbolic, runs),
        }
    }

    /// Visits every part, children before parents; unrelated parts run in parallel.
    pub fn upwards(&self, visit: impl Fn(usize) + Sync) {
        let left: Vec<AtomicUsize> = self
            .parts
            .iter()
            .map(|part| AtomicUsize::new(part.children.len()))
            .collect();
        let climb = |mut part: usize| {
            loop {
                visit(part);
                match self.parts[part].parent {
                    Some(above) if left[above].fetch_sub(1, Ordering::AcqRel) == 1 => part = above,
                    _ => break,
                }
            }
        };
        let climb = &climb;
        let leaves = (0..self.parts.len()).filter(|&part| self.parts[part].children.is_empty());
        if self.parts.len() == 1 {
            return leaves.for_each(climb);
        }
        // The first are processed first, and other threads steal from the other end: another side of the tree.
        rayon::scope(|scope| leaves.rev().for_each(|part| scope.spawn(move |_| climb(part))));
    }

    /// Visits every part, parents before children; unrelated parts run in parallel.
    pub fn downwards(&self, visit: impl Fn(usize) + Sync) {
        if self.parts.len() == 1 {
            return visit(0);
        }
        let visit = &visit;
        let roots = (0..self.parts.len()).filter(|&part| self.parts[part].parent.is_none());
        rayon::scope(|scope| roots.for_each(|part| scope.spawn(move |scope| self.descend(part, scope, visit))));
    }

    fn descend<'scope>(&'scope self, part: usize, scope: &Scope<'scope>, visit: &'scope (impl Fn(usize) + Sync)) {
        visit(part);
        for &child in &self.parts[part].children {
            scope.spawn(move |scope| self.descend(child, scope, visit));
        }
    }
}

fn parts(symbolic: &Symbolic, runs: Vec<Range<usize>>) -> Vec<Part> {
    let mut part_of = vec![0; symbolic.supernode_count()];
    for (part, run) in runs.iter().enumerate() {
        part_of[run.clone()].fill(part);
    }
    let mut parts: Vec<Part> = Vec::with_capacity(runs.len());
    for run in runs {
        let root = run.end - 1;
        let above = symbolic.parent[root];
        parts.push(Part {
            columns: symbolic.columns(run.start).start..symbolic.columns(root).end,
            supernodes: run,
            parent: (above != ROOT).then(|| part_of[above as usize]),
            children: Vec::new(),
            outside: Vec::new(),
        });
    }
    for part in 0..parts.len() {
        let Some(above) = parts[part].parent else { continue };
        parts[above].children.push(part);
        // There is only one supernode above a part.
        let (own, pattern) = (
            parts[above].columns.clone(),
            symbolic.pattern(parts[above].supernodes.end - 1),
        );
        let mut place = 0;
        let places = symbolic.pattern(parts[part].supernodes.end - 1).iter().map(|&row| {
            if (row as usize) < own.end {
                return row - own.start as u32;
            }
            while pattern[place] < row {
                place += 1;
            }
            (own.len() + place) as u32
        });
        parts[part].outside = places.collect();
    }
    parts
}

fn places(symbolic: &Symbolic, runs: &[Range<usize>]) -> Vec<u32> {
    let mut places = symbolic.rows.clone();
    let mut outside = vec![0; symbolic.column_count()];
    for run in runs {
        let root = run.end - 1;
        let (start, end) = (
            symbolic.columns(run.start).start as u32,
            symbolic.columns(root).end as u32,
        );
        let own = symbolic.pattern(root);
        if run.len() == 1 {
            for (place, target) in (end - start..).zip(&mut places[symbolic.pattern_range(root)]) {
                *target = place;
            }
            continue;
        }
        for (place, &row) in (end - start..).zip(own) {
            outside[row as usize] = place;
        }
        for s in run.clone() {
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
    use crate::sparse::cholesky::tests::factor_of;
    use crate::sparse::symbolic::ROOT;
    use pliant_mesh::shapes;
    use std::sync::Mutex;

    #[test]
    fn parts_cover_all_and_subtrees_need_nothing_from_each_other() {
        for (name, drawn) in [
            ("torus", shapes::torus(60, 50)),
            ("two", shapes::together(&[shapes::torus(70, 50), shapes::grid(40, 40)])),
        ] {
            let factor = factor_of(drawn);
            let (symbolic, assembly_tree) = factor.parts();
            let mut next = 0;
            for part in &assembly_tree.parts {
                let range = part.supernodes.clone();
                assert_eq!(range.start, next, "{name}");
                next = range.end;
                let outside = symbolic.pattern(range.end - 1);
                for s in range.clone() {
                    let parent = symbolic.parent[s];
                    let is_root = s + 1 == range.end;
                    assert!(is_root || (parent as usize) < range.end, "{name}");
                    // All rows outside the part are in the pattern of its root.
                    let mut beyond = symbolic
                        .pattern(s)
                        .iter()
                        .filter(|row| **row as usize >= part.columns.end);
                    assert!(is_root || beyond.all(|row| outside.contains(row)), "{name}");
                }
                if let Some(above) = part.parent.map(|above| &assembly_tree.parts[above]) {
                    let pattern = symbolic.pattern(above.supernodes.end - 1);
                    for (&row, &place) in outside.iter().zip(&part.outside) {
                        let found = match (place as usize).checked_sub(above.columns.len()) {
                            Some(place) => pattern[place] as usize,
                            None => above.columns.start + place as usize,
                        };
                        assert_eq!(found, row as usize, "{name}");
                    }
                }
            }
            assert_eq!(next, symbolic.supernode_count(), "{name}");
            assert!(
                assembly_tree.parts.len() > 1 && symbolic.parent.contains(&ROOT),
                "{name}"
            );
            assert!((0..next).all(|s| symbolic.pattern(s).is_sorted()), "{name}");
        }
    }

    #[test]
    fn children_come_before_parents_on_the_way_up_and_after_them_on_the_way_down() {
        let factor = factor_of(shapes::torus(60, 50));
        let assembly_tree = factor.parts().1;
        let seen = Mutex::new(Vec::new());
        assembly_tree.upwards(|part| seen.lock().unwrap().push(part));
        let up = std::mem::take(&mut *seen.lock().unwrap());
        assembly_tree.downwards(|part| seen.lock().unwrap().push(part));
        let down = std::mem::take(&mut *seen.lock().unwrap());
        for order in [&up, &down] {
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..assembly_tree.parts.len()));
        }
        let place = |order: &[usize], part: usize| order.iter().position(|&other| other == part);
        for (part, above) in assembly_tree.parts.iter().enumerate() {
            let Some(above) = above.parent else { continue };
            assert!(place(&up, part) < place(&up, above));
            assert!(place(&down, part) > place(&down, above));
        }
    }
}
