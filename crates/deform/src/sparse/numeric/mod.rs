//! The numeric factorisation, supernode by supernode from the leaves [DR83].
//!
//! A supernode assembles its columns of the matrix and the contributions of its children (extend-add), is factored
//! densely (`front`), and passes its own contribution to its parent. The parts that `assembly_tree` cuts need nothing
//! from each other but the children's contributions, so they run in parallel; several threads work on a large front.

mod front;
pub(crate) mod reuse;
mod tiles;

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use pliant_mesh::Cancel;

use crate::budget::reserved;
use crate::sparse::factor_error::FactorError;
use crate::sparse::line::{LANES, Line, Shape, strips, triangle};
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::numeric::front::{factor_panel, update_matrix};
use crate::sparse::symbolic::Symbolic;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;

/// A part's numbers.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    /// The panels of its supernodes, one after the other.
    pub panels: Arc<Vec<Line>>,
    /// The contribution matrix of its last supernode, for the parent part, if it is kept.
    contribution: Option<Arc<Vec<Line>>>,
}

impl Numbers {
    /// The number of stored entries of its contribution.
    #[cfg(test)]
    pub fn kept(&self) -> usize {
        self.contribution
            .as_ref()
            .map_or(0, |contribution| LANES * contribution.len())
    }
}

/// The input of a factorisation.
struct Job<'a> {
    matrix: &'a ScaledMatrix,
    shift: f64,
    symbolic: &'a Symbolic,
    assembly_tree: &'a AssemblyTree,
    cancel: &'a Cancel,
    done: Vec<OnceLock<Arc<Vec<Line>>>>,
    contributions: Vec<Mutex<Option<Arc<Vec<Line>>>>>,
    /// True if each part's contribution is kept for the next factorisation; none if empty.
    kept: &'a [bool],
    pool: Mutex<Vec<Scratch>>,
}

/// Factors the matrix with `shift` added to its unit diagonal. Reuses the parts that are `known`, one entry per part,
/// and keeps the contributions of the parts in `kept`.
pub(crate) fn factor(
    matrix: &ScaledMatrix,
    shift: f64,
    symbolic: &Symbolic,
    assembly_tree: &AssemblyTree,
    known: &[Option<Numbers>],
    kept: &[bool],
    cancel: &Cancel,
) -> Result<Vec<Numbers>, FactorError> {
    let count = assembly_tree.parts.len();
    // A part's contribution is needed if its parent is not reused.
    let mut is_known = vec![false; count];
    for part in (0..count).rev() {
        let above = assembly_tree.parts[part].parent;
        let own = known.get(part).and_then(Option::as_ref);
        is_known[part] = own.is_some_and(|own| own.contribution.is_some() || above.is_none_or(|above| is_known[above]));
    }
    let known = |part: usize| is_known[part].then(|| known[part].as_ref()).flatten();
    let job = Job {
        matrix,
        shift,
        symbolic,
        assembly_tree,
        cancel,
        done: (0..count)
            .map(|part| known(part).map_or_else(OnceLock::new, |numbers| OnceLock::from(Arc::clone(&numbers.panels))))
            .collect(),
        contributions: (0..count)
            .map(|part| Mutex::new(known(part).and_then(|numbers| numbers.contribution.clone())))
            .collect(),
        kept,
        pool: Mutex::default(),
    };
    let failures = Mutex::new(Vec::new());
    assembly_tree.upwards(|part| {
        if job.done[part].get().is_some() {
            return;
        }
        if let Err(error) = job.part(part) {
            failures.lock().unwrap_or_else(PoisonError::into_inner).push(error);
        }
    });
    // The first failing column, independent of the order of threads.
    let failures = failures.into_inner().unwrap_or_else(PoisonError::into_inner);
    let of = |error: &FactorError| match error {
        FactorError::Pivot(column) => *column,
        FactorError::Memory | FactorError::Budget(_) => usize::MAX - 1,
        FactorError::Cancelled => usize::MAX,
    };
    if let Some(error) = failures.into_iter().min_by_key(of) {
        return Err(error);
    }
    let is_kept = |part: usize| kept.get(part).copied().unwrap_or(false);
    let numbers =
        job.done
            .into_iter()
            .zip(job.contributions)
            .enumerate()
            .filter_map(|(part, (panels, contribution))| {
                let contribution = contribution.into_inner().unwrap_or_else(PoisonError::into_inner);
                let contribution = contribution.filter(|_| is_kept(part));
                Some(Numbers {
                    panels: panels.into_inner()?,
                    contribution,
                })
            });
    Ok(numbers.collect())
}

/// Scratch memory for one supernode after the other.
#[derive(Default)]
struct Scratch {
    /// A row's place in the present supernode.
    place: Vec<u32>,
    /// Contributions of supernodes of this part, each with its supernode: the last ones are the next supernode's.
    pending: Vec<(usize, Vec<Line>)>,
    spare: Vec<Vec<Line>>,
    places: Vec<u32>,
}

impl Scratch {
    /// This many lines with any content, from the smallest spare matrix that is large enough. Sizes are powers of two,
    /// so that allocations are rare.
    fn take(&mut self, lines: usize) -> Result<Vec<Line>, FactorError> {
        let fitting = (0..self.spare.len())
            .filter(|&spare| self.spare[spare].capacity() >= lines)
            .min_by_key(|&spare| self.spare[spare].capacity());
        let mut update = fitting.map_or_else(Vec::new, |spare| self.spare.swap_remove(spare));
        if update.capacity() < lines {
            update.try_reserve_exact(lines.next_power_of_two())?;
        }
        update.resize(lines, Line::ZERO);
        Ok(update)
    }
}

impl Job<'_> {
    fn keeps(&self, part: usize) -> bool {
        self.kept.get(part).copied().unwrap_or(false)
    }

    fn part(&self, part: usize) -> Result<(), FactorError> {
        let children = &self.assembly_tree.parts[part].children;
        if children.iter().any(|&child| self.done[child].get().is_none()) {
            // Its error has been reported.
            return Ok(());
        }
        let given: Vec<(usize, Option<Arc<Vec<Line>>>)> = children
            .iter()
            .map(|&child| {
                let mut contribution = self.contributions[child].lock().unwrap_or_else(PoisonError::into_inner);
                let given = if self.keeps(child) {
                    contribution.clone()
                } else {
                    contribution.take()
                };
                (self.assembly_tree.parts[child].supernodes.end - 1, given)
            })
            .collect();
        let given: Vec<(usize, &[Line])> = given
            .iter()
            .map(|(root, contribution)| {
                (
                    *root,
                    contribution
                        .as_ref()
                        .map_or(&[][..], |contribution| contribution.as_slice()),
                )
            })
            .collect();
        let pooled = self.pool.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut scratch = pooled.unwrap_or_default();
        scratch.place.resize(self.matrix.scale.len(), 0);
        let supernodes = self.assembly_tree.parts[part].supernodes.clone();
        let lines = supernodes.clone().map(|s| self.symbolic.shape(s).lines()).sum();
        let mut panels = reserved(lines)?;
        for s in supernodes.clone() {
            // A part with children is one supernode.
            let contribution = self.supernode(s, &mut panels, &given, &mut scratch)?;
            if s + 1 < supernodes.end {
                scratch.pending.push((s, contribution));
            } else if !contribution.is_empty() {
                // The allocation is larger than its contents.
                let contribution = if self.keeps(part) {
                    let mut exact = reserved(contribution.len())?;
                    exact.extend_from_slice(&contribution);
                    scratch.spare.push(contribution);
                    exact
                } else {
                    contribution
                };
                *self.contributions[part].lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(contribution));
            }
        }
        let _ = self.done[part].set(Arc::new(panels));
        self.pool.lock().unwrap_or_else(PoisonError::into_inner).push(scratch);
        Ok(())
    }

    /// Appends one supernode's panel, given its children's contributions from this part and from other parts; returns
    /// its own.
    fn supernode(
        &self,
        s: usize,
        panels: &mut Vec<Line>,
        given: &[(usize, &[Line])],
        scratch: &mut Scratch,
    ) -> Result<Vec<Line>, FactorError> {
        if self.cancel.is_cancelled() {
            return Err(FactorError::Cancelled);
        }
        let own = self.symbolic.columns(s);
        let below = self.symbolic.pattern(s);
        let shape = self.symbolic.shape(s);
        for (i, column) in own.clone().enumerate() {
            scratch.place[column] = i as u32;
        }
        for (i, &row) in below.iter().enumerate() {
            scratch.place[row as usize] = (own.len() + i) as u32;
        }
        let start = panels.len();
        panels.resize(start + shape.lines(), Line::ZERO);
        let panel = &mut panels[start..];
        for (c, column) in own.clone().enumerate() {
            let (rows, values) = self.matrix.column(column);
            for (&row, &value) in rows.iter().zip(values) {
                let place = scratch.place[row as usize] as usize;
                let (strip, lane) = shape.row(place);
                panel[strip + c].0[lane] += value;
            }
            let (strip, lane) = shape.row(c);
            panel[strip + c].0[lane] += self.shift;
        }
        // In postorder the children are the last ones; in any other order they may be anywhere.
        let mut children = Vec::new();
        let count = self.symbolic.child_counts[s] as usize - given.len();
        for pending in (0..scratch.pending.len()).rev() {
            if children.len() == count {
                break;
            }
            if self.symbolic.parent[scratch.pending[pending].0] as usize == s {
                children.push(scratch.pending.remove(pending));
            }
        }
        let all = given
            .iter()
            .copied()
            .chain(children.iter().map(|(child, update)| (*child, update.as_slice())));
        for (child, update) in all.clone() {
            places_of(self.symbolic.pattern(child), &scratch.place, &mut scratch.places);
            extend_add_to_panel(&scratch.places, update, shape, panel);
        }
        factor_panel(shape, panel, self.cancel).map_err(|error| match error {
            FactorError::Pivot(place) => FactorError::Pivot(own.start + place),
            other => other,
        })?;
        let mut contribution = if shape.below > 0 {
            scratch.take(triangle(strips(shape.below)))?
        } else {
            Vec::new()
        };
        update_matrix(shape, panel, &mut contribution, self.cancel);
        for (child, update) in all {
            places_of(self.symbolic.pattern(child), &scratch.place, &mut scratch.places);
            extend_add_to_contribution(&scratch.places, update, shape.width, &mut contribution);
        }
        scratch.spare.extend(children.into_iter().map(|(_, update)| update));
        Ok(contribution)
    }
}

fn places_of(rows: &[u32], place: &[u32], places: &mut Vec<u32>) {
    places.clear();
    places.extend(rows.iter().map(|&row| place[row as usize]));
}

/// Extend-add of the columns of a child's contribution that are the supernode's own: subtracts them from its panel. The
/// child's rows have the ascending `places` here.
fn extend_add_to_panel(places: &[u32], update: &[Line], shape: Shape, panel: &mut [Line]) {
    let split = places.partition_point(|&place| (place as usize) < shape.width);
    for (strip, rows) in places.chunks(LANES).enumerate() {
        let lines = &update[triangle(strip)..triangle(strip + 1)];
        let mut targets = [(0, 0); LANES];
        for (target, &place) in targets.iter_mut().zip(rows) {
            *target = shape.row(place as usize);
        }
        scatter(lines, 0, &places[..split], strip, rows.len(), |lane, place, value| {
            let (start, target) = targets[lane];
            panel[start + place].0[target & (LANES - 1)] -= value;
        });
    }
}

/// Extend-add of the other columns of a child's contribution to the supernode's own contribution.
fn extend_add_to_contribution(places: &[u32], update: &[Line], width: usize, contribution: &mut [Line]) {
    let split = places.partition_point(|&place| (place as usize) < width);
    for (strip, rows) in places.chunks(LANES).enumerate().skip(split / LANES) {
        let lines = &update[triangle(strip)..triangle(strip + 1)];
        let mut targets = [(0, 0); LANES];
        for (target, &place) in targets.iter_mut().zip(rows) {
            let row = (place as usize).wrapping_sub(width);
            if (place as usize) >= width {
                *target = (triangle(row / LANES), row % LANES);
            }
        }
        scatter(lines, split, places, strip, rows.len(), |lane, place, value| {
            let (start, target) = targets[lane];
            contribution[start + place - width].0[target & (LANES - 1)] += value;
        });
    }
}

/// Goes through a strip's numbers on and below the diagonal, in its columns from `first` on to the end of `places`.
#[inline(always)]
fn scatter(
    lines: &[Line],
    first: usize,
    places: &[u32],
    strip: usize,
    rows: usize,
    mut take: impl FnMut(usize, usize, f64),
) {
    let diagonal = strip * LANES;
    let full = diagonal.min(places.len()).max(first);
    if rows == LANES {
        for c in first..full {
            for lane in 0..LANES {
                take(lane, places[c] as usize, lines[c].0[lane]);
            }
        }
    } else {
        for c in first..full {
            for lane in 0..rows {
                take(lane, places[c] as usize, lines[c].0[lane]);
            }
        }
    }
    for c in full..places.len().min(diagonal + rows) {
        for lane in c - diagonal..rows {
            take(lane, places[c] as usize, lines[c].0[lane]);
        }
    }
}
