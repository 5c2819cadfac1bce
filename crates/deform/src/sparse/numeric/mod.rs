//! The numeric factorisation, block by block from the leaves (Duff & Reid 1983).
//!
//! A block gathers its columns of the matrix and what its children left, is factored densely (`front`), and leaves to
//! its parent what it takes from the rows below. The parts that `assembly_tree` cuts need nothing from each other but what
//! children leave, so they run beside each other; large fronts are worked on by several threads inside.

mod front;
pub(crate) mod line;
pub(crate) mod reuse;
mod tiles;

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use pliant_mesh::Cancel;

use crate::budget::reserved;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::numeric::front::{factor_panel, square};
use crate::sparse::numeric::line::{LANES, Line, Shape, strips, triangle};
use crate::sparse::symbolic::Symbolic;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;

/// A part's numbers.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    /// The panels of its blocks, one after the other.
    pub panels: Arc<Vec<Line>>,
    /// What its last block leaves to the part above, where that is kept.
    left: Option<Arc<Vec<Line>>>,
}

impl Numbers {
    /// How many numbers are kept of what it leaves.
    #[cfg(test)]
    pub fn kept(&self) -> usize {
        self.left.as_ref().map_or(0, |left| LANES * left.len())
    }
}

/// What is factored.
struct Job<'a> {
    matrix: &'a ScaledMatrix,
    shift: f64,
    symbolic: &'a Symbolic,
    assembly_tree: &'a AssemblyTree,
    cancel: &'a Cancel,
    done: Vec<OnceLock<Arc<Vec<Line>>>>,
    left: Vec<Mutex<Option<Arc<Vec<Line>>>>>,
    /// Of which parts what they leave stays for a factorisation of nearly the same matrix; none if empty.
    kept: &'a [bool],
    rooms: Mutex<Vec<Room>>,
}

/// Factors the matrix, with `shift` added to its unit diagonal; takes over the parts that are `known`, one entry a part,
/// and keeps what the parts in `kept` leave.
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
    // What a part leaves is needed where the part above is not taken over.
    let mut is_known = vec![false; count];
    for part in (0..count).rev() {
        let above = assembly_tree.parts[part].parent;
        let own = known.get(part).and_then(Option::as_ref);
        is_known[part] = own.is_some_and(|own| own.left.is_some() || above.is_none_or(|above| is_known[above]));
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
        left: (0..count)
            .map(|part| Mutex::new(known(part).and_then(|numbers| numbers.left.clone())))
            .collect(),
        kept,
        rooms: Mutex::default(),
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
    // The first column that fails, whoever came to it first.
    let failures = failures.into_inner().unwrap_or_else(PoisonError::into_inner);
    let of = |error: &FactorError| match error {
        FactorError::Pivot(column) => *column,
        FactorError::Memory | FactorError::Budget => usize::MAX - 1,
        FactorError::Cancelled => usize::MAX,
    };
    if let Some(error) = failures.into_iter().min_by_key(of) {
        return Err(error);
    }
    let is_kept = |part: usize| kept.get(part).copied().unwrap_or(false);
    let numbers = job
        .done
        .into_iter()
        .zip(job.left)
        .enumerate()
        .filter_map(|(part, (panels, left))| {
            let left = left.into_inner().unwrap_or_else(PoisonError::into_inner);
            let left = left.filter(|_| is_kept(part));
            Some(Numbers {
                panels: panels.into_inner()?,
                left,
            })
        });
    Ok(numbers.collect())
}

/// Room for one block after the other.
#[derive(Default)]
struct Room {
    /// A row's place in the present block.
    place: Vec<u32>,
    /// What blocks of this part left, each with its block: the last ones are the next block's.
    pending: Vec<(usize, Vec<Line>)>,
    spare: Vec<Vec<Line>>,
    places: Vec<u32>,
}

impl Room {
    /// So many lines of whatever, in the least of the spare squares that holds them. Room is asked for in powers of two,
    /// so that it is asked for seldom.
    fn take(&mut self, lines: usize) -> Result<Vec<Line>, FactorError> {
        let fitting = (0..self.spare.len())
            .filter(|&spare| self.spare[spare].capacity() >= lines)
            .min_by_key(|&spare| self.spare[spare].capacity());
        let mut square = fitting.map_or_else(Vec::new, |spare| self.spare.swap_remove(spare));
        if square.capacity() < lines {
            square.try_reserve_exact(lines.next_power_of_two())?;
        }
        square.resize(lines, Line::ZERO);
        Ok(square)
    }
}

impl Job<'_> {
    fn keeps(&self, part: usize) -> bool {
        self.kept.get(part).copied().unwrap_or(false)
    }

    fn part(&self, part: usize) -> Result<(), FactorError> {
        let children = &self.assembly_tree.parts[part].children;
        if children.iter().any(|&child| self.done[child].get().is_none()) {
            // Whatever befell it has been said.
            return Ok(());
        }
        let given: Vec<(usize, Option<Arc<Vec<Line>>>)> = children
            .iter()
            .map(|&child| {
                let mut left = self.left[child].lock().unwrap_or_else(PoisonError::into_inner);
                let given = if self.keeps(child) { left.clone() } else { left.take() };
                (self.assembly_tree.parts[child].blocks.end - 1, given)
            })
            .collect();
        let given: Vec<(usize, &[Line])> = given
            .iter()
            .map(|(root, left)| (*root, left.as_ref().map_or(&[][..], |left| left.as_slice())))
            .collect();
        let pooled = self.rooms.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut room = pooled.unwrap_or_default();
        room.place.resize(self.matrix.scale.len(), 0);
        let blocks = self.assembly_tree.parts[part].blocks.clone();
        let lines = blocks.clone().map(|s| self.symbolic.shape(s).lines()).sum();
        let mut panels = reserved(lines)?;
        for s in blocks.clone() {
            // A part with children is one block.
            let left = self.block(s, &mut panels, &given, &mut room)?;
            if s + 1 < blocks.end {
                room.pending.push((s, left));
            } else if !left.is_empty() {
                // Rooms are larger than what stands in them.
                let left = if self.keeps(part) {
                    let mut exact = reserved(left.len())?;
                    exact.extend_from_slice(&left);
                    room.spare.push(left);
                    exact
                } else {
                    left
                };
                *self.left[part].lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(left));
            }
        }
        let _ = self.done[part].set(Arc::new(panels));
        self.rooms.lock().unwrap_or_else(PoisonError::into_inner).push(room);
        Ok(())
    }

    /// Appends one block's panel, given what its children left here and in the room; returns what it leaves.
    fn block(
        &self,
        s: usize,
        panels: &mut Vec<Line>,
        given: &[(usize, &[Line])],
        room: &mut Room,
    ) -> Result<Vec<Line>, FactorError> {
        if self.cancel.is_cancelled() {
            return Err(FactorError::Cancelled);
        }
        let own = self.symbolic.columns(s);
        let below = self.symbolic.pattern(s);
        let shape = self.symbolic.shape(s);
        for (i, column) in own.clone().enumerate() {
            room.place[column] = i as u32;
        }
        for (i, &row) in below.iter().enumerate() {
            room.place[row as usize] = (own.len() + i) as u32;
        }
        let start = panels.len();
        panels.resize(start + shape.lines(), Line::ZERO);
        let panel = &mut panels[start..];
        for (c, column) in own.clone().enumerate() {
            let (rows, values) = self.matrix.column(column);
            for (&row, &value) in rows.iter().zip(values) {
                let place = room.place[row as usize] as usize;
                let (strip, lane) = shape.row(place);
                panel[strip + c].0[lane] += value;
            }
            let (strip, lane) = shape.row(c);
            panel[strip + c].0[lane] += self.shift;
        }
        // In postorder the children are the last ones; in any other order they are somewhere.
        let mut children = Vec::new();
        let count = self.symbolic.child_counts[s] as usize - given.len();
        for pending in (0..room.pending.len()).rev() {
            if children.len() == count {
                break;
            }
            if self.symbolic.parent[room.pending[pending].0] as usize == s {
                children.push(room.pending.remove(pending));
            }
        }
        let all = given
            .iter()
            .copied()
            .chain(children.iter().map(|(child, square)| (*child, square.as_slice())));
        for (child, square) in all.clone() {
            places_of(self.symbolic.pattern(child), &room.place, &mut room.places);
            add_to_panel(&room.places, square, shape, panel);
        }
        factor_panel(shape, panel, self.cancel).map_err(|error| match error {
            FactorError::Pivot(place) => FactorError::Pivot(own.start + place),
            other => other,
        })?;
        let mut left = if shape.below > 0 {
            room.take(triangle(strips(shape.below)))?
        } else {
            Vec::new()
        };
        square(shape, panel, &mut left, self.cancel);
        for (child, square) in all {
            places_of(self.symbolic.pattern(child), &room.place, &mut room.places);
            add_to_square(&room.places, square, shape.width, &mut left);
        }
        room.spare.extend(children.into_iter().map(|(_, square)| square));
        Ok(left)
    }
}

fn places_of(rows: &[u32], place: &[u32], places: &mut Vec<u32>) {
    places.clear();
    places.extend(rows.iter().map(|&row| place[row as usize]));
}

/// Subtracts the columns of a child's square that are the block's own, from its panel. The child's rows have the
/// ascending `places` here.
fn add_to_panel(places: &[u32], square: &[Line], shape: Shape, panel: &mut [Line]) {
    let split = places.partition_point(|&place| (place as usize) < shape.width);
    for (strip, rows) in places.chunks(LANES).enumerate() {
        let lines = &square[triangle(strip)..triangle(strip + 1)];
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

/// Adds the other columns of a child's square to the square that the block leaves.
fn add_to_square(places: &[u32], square: &[Line], width: usize, left: &mut [Line]) {
    let split = places.partition_point(|&place| (place as usize) < width);
    for (strip, rows) in places.chunks(LANES).enumerate().skip(split / LANES) {
        let lines = &square[triangle(strip)..triangle(strip + 1)];
        let mut targets = [(0, 0); LANES];
        for (target, &place) in targets.iter_mut().zip(rows) {
            let row = (place as usize).wrapping_sub(width);
            if (place as usize) >= width {
                *target = (triangle(row / LANES), row % LANES);
            }
        }
        scatter(lines, split, places, strip, rows.len(), |lane, place, value| {
            let (start, target) = targets[lane];
            left[start + place - width].0[target & (LANES - 1)] += value;
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
