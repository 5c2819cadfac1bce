//! Joins equal positions.
//!
//! Positions are sorted along a Morton curve, which the welded vertices need anyway. Equal positions share a cell, so a
//! walk along the sorted list finds them. A hash grid took twice as long, because every look-up missed the cache.

use glam::DVec3;
use rayon::prelude::*;

use super::morton::MortonGrid;
use crate::Bounds;

/// A position's Morton code and its index, packed into twelve bytes because a scan has millions of them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    code_high: u32,
    code_low: u32,
    index: u32,
}

impl Entry {
    fn new(code: u64, index: u32) -> Self {
        Self {
            code_high: (code >> 32) as u32,
            code_low: code as u32,
            index,
        }
    }

    fn code(self) -> u64 {
        u64::from(self.code_high) << 32 | u64::from(self.code_low)
    }
}

/// Positions in groups. A group is identified by its representative's place in Morton order.
pub(crate) struct Joined {
    /// Indices of the positions that took part, in Morton order; equal codes by ascending index.
    pub(crate) order: Vec<u32>,
    /// For each place in `order`, the place of its representative. A representative points at itself.
    pub(crate) representative: Vec<u32>,
}

/// Groups the `positions` whose indices are in `members` (ascending, all finite, inside `bounds`): equal ones are one
/// (−0 equals 0), represented by the lowest index.
pub(crate) fn join_equal(positions: &[DVec3], members: Vec<u32>, bounds: &Bounds) -> Joined {
    let grid = MortonGrid::over(bounds);
    let mut entries: Vec<Entry> = members
        .par_iter()
        .map(|&i| Entry::new(grid.code(positions[i as usize]), i))
        .collect();
    drop(members);
    entries.par_sort_unstable();
    let mut representative: Vec<u32> = (0..entries.len() as u32).collect();
    join_within_cells(positions, &entries, &mut representative);
    // Collecting reuses the entries' allocation; shrinking frees the rest of it.
    let mut order: Vec<u32> = entries.into_iter().map(|entry| entry.index).collect();
    order.shrink_to_fit();
    Joined { order, representative }
}

/// Runs at least this long are joined by sorting.
const CROWD: usize = 32;

/// Joins entries of equal code, in parallel over pieces that end at cell boundaries.
fn join_within_cells(positions: &[DVec3], entries: &[Entry], representative: &mut [u32]) {
    let mut pieces = Vec::new();
    let (mut rest, mut start) = (representative, 0);
    while start < entries.len() {
        let mut end = (start + 16_384).min(entries.len());
        while end < entries.len() && entries[end].code() == entries[end - 1].code() {
            end += 1;
        }
        let (piece, tail) = rest.split_at_mut(end - start);
        pieces.push((start, piece));
        (rest, start) = (tail, end);
    }
    pieces.into_par_iter().for_each(|(piece_start, piece)| {
        let mut first = 0;
        while first < piece.len() {
            let code = entries[piece_start + first].code();
            let mut last = first + 1;
            while last < piece.len() && entries[piece_start + last].code() == code {
                last += 1;
            }
            if last - first > 1 {
                let run = piece_start + first..piece_start + last;
                join_run(
                    positions,
                    &entries[run.clone()],
                    run.start as u32,
                    &mut piece[first..last],
                );
            }
            first = last;
        }
    });
}

/// Joins the entries of one cell, which are in ascending order of index; `offset` is the place of the first.
fn join_run(positions: &[DVec3], run: &[Entry], offset: u32, representative: &mut [u32]) {
    let position = |place: usize| positions[run[place].index as usize];
    if run.len() >= CROWD {
        join_by_sorting(run.len(), position, offset, representative);
        return;
    }
    for place in 1..run.len() {
        let here = position(place);
        if let Some(first) = (0..place).find(|&other| position(other) == here) {
            representative[place] = offset + first as u32;
        }
    }
}

/// Points each of `count` places at the first place with the same position.
fn join_by_sorting(count: usize, position: impl Fn(usize) -> DVec3, offset: u32, representative: &mut [u32]) {
    // Adding zero turns −0 into 0, so that both sort equally.
    let key = |place: usize| (position(place) + DVec3::ZERO).to_array().map(ordered_bits);
    let mut places: Vec<([u64; 3], usize)> = (0..count).map(|place| (key(place), place)).collect();
    places.sort_unstable();
    let mut first = places[0];
    for &(key, place) in &places[1..] {
        if key == first.0 {
            representative[place] = offset + first.1 as u32;
        } else {
            first = (key, place);
        }
    }
}

/// Bits that compare in the same order as the finite numbers.
fn ordered_bits(number: f64) -> u64 {
    let bits = number.to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}
