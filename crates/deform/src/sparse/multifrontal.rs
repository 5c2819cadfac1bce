//! The numeric factorisation, supernode by supernode from the leaves (Duff & Reid 1983).
//!
//! A supernode gathers its columns of the matrix and what its children left, factors them densely (`front`), and leaves
//! to its parent what they take from the rows below. Subtrees need nothing from each other, so they run beside each
//! other; above them the supernodes are few and large and run one by one, each in parallel inside. faer's own
//! factorisation does one supernode after the other, looking left; a second thread inside it made it slower.

use std::sync::{Mutex, PoisonError};

use pliant_mesh::Cancel;
use rayon::prelude::*;

use crate::sparse::aligned::{Aligned, LINE};
use crate::sparse::cholesky::FactorError;
use crate::sparse::forest::{Forest, Part};
use crate::sparse::front::eliminate;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::symbolic::Symbolic;

/// What is factored.
#[derive(Clone, Copy)]
struct Job<'a> {
    plate: &'a ScaledMatrix,
    shift: f64,
    symbolic: &'a Symbolic,
    cancel: &'a Cancel,
}

/// Factors the matrix, with `shift` added to its unit diagonal, into `values`, which are zero.
pub(crate) fn factor(
    plate: &ScaledMatrix,
    shift: f64,
    symbolic: &Symbolic,
    forest: &Forest,
    values: &mut [f64],
    cancel: &Cancel,
) -> Result<(), FactorError> {
    let job = Job {
        plate,
        shift,
        symbolic,
        cancel,
    };
    let rooms = Mutex::new(Vec::new());
    let mut tasks = Vec::new();
    let mut top = Vec::new();
    let mut rest = values;
    let mut take = |first: usize, end: usize| {
        let (slice, tail) = std::mem::take(&mut rest).split_at_mut(symbolic.values(first..end).len());
        rest = tail;
        slice
    };
    for part in &forest.parts {
        match part {
            Part::Task(range) => tasks.push((range.clone(), take(range.start, range.end))),
            Part::Top(s) => top.push((*s, take(*s, s + 1))),
        }
    }
    let left: Vec<Result<Option<Left>, FactorError>> = tasks
        .into_par_iter()
        .with_max_len(1)
        .map(|(range, mut values)| {
            let pooled = rooms.lock().unwrap_or_else(PoisonError::into_inner).pop();
            let mut room = pooled.unwrap_or_else(|| Room::new(plate.scale.len()));
            for s in range {
                let own = symbolic.columns(s).len() * (symbolic.columns(s).len() + symbolic.pattern(s).len());
                let (slice, tail) = values.split_at_mut(own);
                values = tail;
                job.supernode(s, slice, &mut room)?;
            }
            let left = room.pending.pop();
            rooms.lock().unwrap_or_else(PoisonError::into_inner).push(room);
            Ok(left)
        })
        .collect();
    let mut left = left.into_iter();
    let mut top = top.into_iter();
    let mut room = Room::new(plate.scale.len());
    for part in &forest.parts {
        match part {
            Part::Task(_) => room.pending.extend(left.next().transpose()?.flatten()),
            Part::Top(_) => {
                if let Some((s, values)) = top.next() {
                    job.supernode(s, values, &mut room)?;
                }
            }
        }
    }
    Ok(())
}

/// What a supernode leaves to its parent: a square on the rows of its pattern, of which the lower triangle counts.
struct Left {
    supernode: usize,
    square: Aligned,
}

/// Room for one supernode after the other.
struct Room {
    /// A row's place in the present supernode.
    place: Vec<u32>,
    /// What children left, in postorder: the last ones are the next supernode's.
    pending: Vec<Left>,
    spare: Vec<Aligned>,
    places: Vec<u32>,
}

impl Room {
    fn new(column_count: usize) -> Self {
        Self {
            place: vec![0; column_count],
            pending: Vec::new(),
            spare: Vec::new(),
            places: Vec::new(),
        }
    }

    /// `len` zeros, in the least of the spare squares that holds them. Room is asked for in powers of two, so that it
    /// is asked for seldom: growing a square moves its pages, which every thread has to be told.
    fn take(&mut self, len: usize) -> Aligned {
        let fitting = (0..self.spare.len())
            .filter(|&spare| self.spare[spare].room() >= len)
            .min_by_key(|&spare| self.spare[spare].room());
        let mut square = fitting.map_or_else(
            || Aligned::with_room(len.next_power_of_two()),
            |spare| self.spare.swap_remove(spare),
        );
        square.clear(len);
        square
    }
}

/// The distance between a square's columns: each starts on a line.
fn stride(height: usize) -> usize {
    height.next_multiple_of(LINE)
}

impl Job<'_> {
    /// Factors one supernode into its part of the values, given what its children left in the room.
    fn supernode(&self, s: usize, values: &mut [f64], room: &mut Room) -> Result<(), FactorError> {
        if self.cancel.is_cancelled() {
            return Err(FactorError::Cancelled);
        }
        let own = self.symbolic.columns(s);
        let below = self.symbolic.pattern(s);
        let (width, size) = (own.len(), below.len());
        let height = width + size;
        let square_stride = stride(size);
        for (i, &row) in below.iter().enumerate() {
            room.place[row as usize] = (width + i) as u32;
        }
        for (i, column) in own.clone().enumerate() {
            room.place[column] = i as u32;
        }
        let panel = values;
        for (column, target) in own.clone().zip(panel.chunks_mut(height)) {
            let entries = self.plate.lower_offsets[column] as usize..self.plate.lower_offsets[column + 1] as usize;
            for entry in entries {
                let row = self.plate.lower_rows[entry] as usize;
                target[room.place[row] as usize] += self.plate.lower_values[entry];
            }
            target[column - own.start] += self.shift;
        }
        let mut square = room.take(size * square_stride);
        // In postorder they are the last ones; in any other order they are somewhere.
        for pending in (0..room.pending.len()).rev() {
            if self.symbolic.parent[room.pending[pending].supernode] as usize != s {
                continue;
            }
            let child = room.pending.remove(pending);
            let rows = self.symbolic.pattern(child.supernode);
            room.places.clear();
            room.places.extend(rows.iter().map(|&row| room.place[row as usize]));
            add_child(
                &room.places,
                child.square.get(),
                width,
                (panel, height),
                (square.get_mut(), square_stride),
            );
            room.spare.push(child.square);
        }
        eliminate(
            panel,
            height,
            width,
            height,
            square.get_mut(),
            square_stride,
            self.cancel,
        )
        .map_err(|error| match error {
            FactorError::Pivot(place) => FactorError::Pivot(own.start + place),
            other => other,
        })?;
        if size > 0 {
            room.pending.push(Left { supernode: s, square });
        } else {
            room.spare.push(square);
        }
        Ok(())
    }
}

/// Adds a child's square, whose rows have the ascending `places` here, to the panel and to the square beside it.
fn add_child(
    places: &[u32],
    child: &[f64],
    width: usize,
    (panel, panel_stride): (&mut [f64], usize),
    (square, square_stride): (&mut [f64], usize),
) {
    let child_stride = stride(places.len());
    for (c, (&place, column)) in places.iter().zip(child.chunks(child_stride.max(1))).enumerate() {
        let place = place as usize;
        let (target, skipped) = if place < width {
            (&mut panel[place * panel_stride..(place + 1) * panel_stride], 0)
        } else {
            let first = (place - width) * square_stride;
            (&mut square[first..first + square_stride], width)
        };
        for (&row, &value) in places[c..].iter().zip(&column[c..]) {
            target[row as usize - skipped] += value;
        }
    }
}
