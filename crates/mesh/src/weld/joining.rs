//! Joins positions that are equal to within a tolerance.
//!
//! Positions are sorted along a Morton curve, which the welded vertices need anyway. Equal positions share a fine cell,
//! so a walk along the sorted list finds them. That leaves pairs on either side of a cell's wall. They are found in the
//! same list read with coarser cells, sized so that nearly every position is alone in its cell and few are close to a
//! wall: few neighbouring cells have to be looked up. A hash grid took twice as long, because every look-up missed the
//! cache.
//!
//! Joining is greedy, not transitive. By ascending index, each position joins the lowest representative within the
//! tolerance, or becomes a representative itself. So no position moves further than the tolerance (twice that across a
//! cell's wall), and a row of positions closer to each other than the tolerance does not collapse into one.

use glam::DVec3;
use rayon::prelude::*;

use super::morton::{self, MortonGrid};
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

/// Groups the `positions` whose indices are in `members` (ascending, all finite, inside `bounds`). `tolerance` is a
/// length: zero joins only equal positions (−0 equals 0), and `None` joins none.
pub(crate) fn join(positions: &[DVec3], members: Vec<u32>, bounds: &Bounds, tolerance: Option<f64>) -> Joined {
    let grid = MortonGrid::over(bounds);
    let mut entries: Vec<Entry> = members
        .par_iter()
        .map(|&i| Entry::new(grid.code(positions[i as usize]), i))
        .collect();
    drop(members);
    entries.par_sort_unstable();
    let mut representative: Vec<u32> = (0..entries.len() as u32).collect();
    if let Some(tolerance) = tolerance {
        join_within_cells(positions, &entries, tolerance, &mut representative);
        if tolerance > 0.0 {
            join_across_cells(positions, &entries, &grid, tolerance, &mut representative);
        }
    }
    // Collecting reuses the entries' allocation; shrinking gives the rest of it back.
    let mut order: Vec<u32> = entries.into_iter().map(|entry| entry.index).collect();
    order.shrink_to_fit();
    Joined { order, representative }
}

/// Runs at least this long are first reduced to distinct positions by sorting.
const CROWD: usize = 32;

/// Joins entries of equal code, in parallel over pieces that end at cell boundaries.
fn join_within_cells(positions: &[DVec3], entries: &[Entry], tolerance: f64, representative: &mut [u32]) {
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
                    tolerance,
                    &mut piece[first..last],
                );
            }
            first = last;
        }
    });
}

/// Joins the entries of one cell, which are in ascending order of index; `offset` is the place of the first.
fn join_run(positions: &[DVec3], run: &[Entry], offset: u32, tolerance: f64, representative: &mut [u32]) {
    let position = |place: usize| positions[run[place].index as usize];
    if run.len() >= CROWD {
        join_equal_by_sorting(run.len(), position, offset, representative);
        if tolerance == 0.0 {
            return;
        }
    }
    let tolerance_squared = tolerance * tolerance;
    let mut standing: Vec<usize> = Vec::with_capacity(8);
    for place in 0..run.len() {
        if representative[place] != offset + place as u32 {
            // Equal to an earlier one, which already has its representative.
            representative[place] = representative[(representative[place] - offset) as usize];
            continue;
        }
        let here = position(place);
        let near = |&&other: &&usize| {
            let there = position(other);
            there == here || there.distance_squared(here) <= tolerance_squared
        };
        match standing.iter().find(near) {
            Some(&other) => representative[place] = offset + other as u32,
            None => standing.push(place),
        }
    }
}

/// Points each of `count` places at the first place with the same position.
fn join_equal_by_sorting(count: usize, position: impl Fn(usize) -> DVec3, offset: u32, representative: &mut [u32]) {
    // Adding zero turns −0 into 0, so that both sort alike.
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

/// Joins representatives that lie in different fine cells.
fn join_across_cells(
    positions: &[DVec3],
    entries: &[Entry],
    grid: &MortonGrid,
    tolerance: f64,
    representative: &mut [u32],
) {
    let standing: Vec<u32> = (0..entries.len() as u32)
        .filter(|&place| representative[place as usize] == place)
        .collect();
    let level = coarse_level(entries, &standing, grid.length_in_cells(tolerance));
    let near = NearPairs {
        positions,
        entries,
        standing: &standing,
        grid,
        level,
        tolerance,
    };
    let mut pairs: Vec<[u32; 2]> = near.find();
    // The greedy order: by ascending index of the higher one, then of the lower one.
    let index = |place: u32| entries[place as usize].index;
    for pair in &mut pairs {
        pair.sort_unstable_by_key(|&place| index(place));
    }
    pairs.sort_unstable_by_key(|&[low, high]| (index(high), index(low)));
    for [low, high] in pairs {
        if representative[low as usize] == low && representative[high as usize] == high {
            representative[high as usize] = low;
        }
    }
    // The members of a fine cell follow their representative. One hop is enough, because no representative moves twice.
    for place in 0..representative.len() {
        representative[place] = representative[representative[place] as usize];
    }
}

/// Bits per coordinate of the coarsest cells that are not crowded, or else of the finest cells that are still wider
/// than the tolerance.
fn coarse_level(entries: &[Entry], standing: &[u32], tolerance_in_cells: f64) -> u32 {
    let finest = (0..morton::BITS)
        .find(|&bits| f64::from(1u32 << bits) > tolerance_in_cells)
        .map_or(1, |bits| morton::BITS - bits);
    for level in 14.min(finest)..finest {
        let cell = |place: u32| entries[place as usize].code() >> (3 * (morton::BITS - level));
        if standing
            .windows(CROWD)
            .all(|window| cell(window[0]) != cell(window[CROWD - 1]))
        {
            return level;
        }
    }
    finest
}

/// The search for pairs of representatives closer than the tolerance.
struct NearPairs<'a> {
    positions: &'a [DVec3],
    entries: &'a [Entry],
    standing: &'a [u32],
    grid: &'a MortonGrid,
    level: u32,
    tolerance: f64,
}

impl NearPairs<'_> {
    /// All near pairs, each once, as places.
    fn find(&self) -> Vec<[u32; 2]> {
        let found: Vec<Vec<[u32; 2]>> = (0..self.standing.len().div_ceil(8192))
            .into_par_iter()
            .map(|piece| {
                let mut pairs = Vec::new();
                for i in piece * 8192..((piece + 1) * 8192).min(self.standing.len()) {
                    self.pairs_in_cell(i, &mut pairs);
                    self.pairs_over_walls(i, &mut pairs);
                }
                pairs
            })
            .collect();
        found.concat()
    }

    /// The coarse cell of the `i`th representative.
    fn cell(&self, i: usize) -> u64 {
        self.entries[self.standing[i] as usize].code() >> (3 * (morton::BITS - self.level))
    }

    fn position(&self, i: usize) -> DVec3 {
        self.positions[self.entries[self.standing[i] as usize].index as usize]
    }

    /// Pairs of `i` and later representatives in the same coarse cell.
    fn pairs_in_cell(&self, i: usize, pairs: &mut Vec<[u32; 2]>) {
        let cell = self.cell(i);
        for j in i + 1..self.standing.len() {
            if self.cell(j) != cell {
                break;
            }
            self.keep_if_near(i, j, pairs);
        }
    }

    /// Pairs of `i` and later representatives in coarse cells that are within the tolerance.
    fn pairs_over_walls(&self, i: usize, pairs: &mut Vec<[u32; 2]>) {
        let side = f64::from(1u32 << (morton::BITS - self.level));
        let last_cell = f64::from((1u32 << self.level) - 1);
        let in_cells = self.grid.in_cells(self.position(i)) / side;
        // Slightly more than the tolerance, to allow for rounding in the cell coordinates.
        let reach = self.grid.length_in_cells(self.tolerance) / side * (1.0 + 1e-6) + 1e-9;
        let lowest = (in_cells - reach)
            .floor()
            .max(DVec3::ZERO)
            .min(DVec3::splat(last_cell))
            .as_uvec3();
        let highest = (in_cells + reach)
            .floor()
            .max(DVec3::ZERO)
            .min(DVec3::splat(last_cell))
            .as_uvec3();
        if lowest == highest {
            return;
        }
        let own = self.cell(i);
        for z in lowest.z..=highest.z {
            for y in lowest.y..=highest.y {
                for x in lowest.x..=highest.x {
                    let cell = morton::encode([x, y, z]);
                    // Each pair is found from its lower cell.
                    if cell > own {
                        self.pairs_with_cell(i, cell, pairs);
                    }
                }
            }
        }
    }

    fn pairs_with_cell(&self, i: usize, cell: u64, pairs: &mut Vec<[u32; 2]>) {
        let shift = 3 * (morton::BITS - self.level);
        let first = self
            .standing
            .partition_point(|&place| self.entries[place as usize].code() >> shift < cell);
        for j in first..self.standing.len() {
            if self.cell(j) != cell {
                break;
            }
            self.keep_if_near(i, j, pairs);
        }
    }

    fn keep_if_near(&self, i: usize, j: usize, pairs: &mut Vec<[u32; 2]>) {
        if self.position(i).distance_squared(self.position(j)) <= self.tolerance * self.tolerance {
            pairs.push([self.standing[i], self.standing[j]]);
        }
    }
}
