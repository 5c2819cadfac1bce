//! Finds positions near each other, and joins each to the nearest that it may join.
//!
//! Runs of positions along the Morton curve are patches, so a tree of boxes around such runs finds the positions within
//! a distance. Each position has a distance of its own, which may differ by orders of magnitude over a scene; cells of
//! one size would be crowded where the scene is finer.

use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;

use glam::DVec3;
use rayon::prelude::*;

use super::joining::Joined;
use super::morton::MortonGrid;
use crate::Bounds;

/// Positions that share a box, and boxes that share a parent.
const RUN: usize = 8;

/// The number of refused neighbours after which a group asks the rule no further. Few have ten; if triangles are spikes
/// across the scene, all of their corners are close to each other.
const MOST_REFUSED: usize = 256;

/// Runs of one Morton code that are longer than this are sorted along a finer curve.
const CROWD: usize = 32;

/// Joins groups of equal positions to others: by ascending index, each joins the nearest representative of lower index
/// that the rule allows (equally near ones: the lowest), or stays a representative itself. So no position moves
/// further than the rule allows, and a row of positions does not collapse into one.
///
/// Two groups are neighbours if their distance is at most the reach of both, which `reach` gives for their
/// representative's place; a group with a reach of zero has no neighbours. `prepare` gets the groups that have
/// neighbours and returns the rule, which decides only about neighbours. Returns whether any were joined.
pub(super) fn join_nearest<J: MayJoin>(
    positions: &[DVec3],
    joined: &mut Joined,
    bounds: &Bounds,
    reach: impl Fn(u32) -> f64 + Sync,
    prepare: impl FnOnce(&[u32]) -> J,
) -> bool {
    let order = &joined.order;
    let position = |place: u32| positions[order[place as usize] as usize];
    let mut standing: Vec<u32> = (0..order.len() as u32)
        .filter(|&place| joined.representative[place as usize] == place)
        .collect();
    spread_crowds(&position, &mut standing, bounds);
    let tree = Tree::over(&position, &standing, &reach);
    // By their numbers in `standing`.
    let mut with_neighbours = tree.with_neighbours(&reach);
    if with_neighbours.is_empty() {
        return false;
    }
    with_neighbours.sort_unstable_by_key(|&number| order[standing[number as usize] as usize]);
    let near: Vec<u32> = with_neighbours.iter().map(|&n| standing[n as usize]).collect();
    let mut rule = prepare(&near);
    let mut representatives = Occupied::none(&tree);
    let mut have_joined = false;
    for (number, place) in with_neighbours.into_iter().zip(near) {
        let here = position(place);
        let (mut nearest, mut refused): (Option<(f64, u32)>, usize) = (None, 0);
        tree.visit(&representatives, here, reach(place), |other, distance| {
            let closer = |(best, of): (f64, u32)| (distance, order[other as usize]) < (best, order[of as usize]);
            if refused > MOST_REFUSED || distance > reach(other) || !nearest.is_none_or(closer) {
                return;
            }
            match rule.may_join(place, other, distance) {
                true => nearest = Some((distance, other)),
                false => refused += 1,
            }
        });
        match nearest {
            Some((_, other)) => {
                joined.representative[place as usize] = other;
                rule.has_joined(place, other);
                have_joined = true;
            }
            None => representatives.add(number as usize),
        }
    }
    // The members of a group follow their representative. One hop is enough, because no representative moves twice.
    for place in 0..joined.representative.len() {
        joined.representative[place] = joined.representative[joined.representative[place] as usize];
    }
    have_joined
}

/// The positions, in Morton order, that have another within the reach of both, by their numbers.
pub(crate) fn with_neighbours(positions: &[DVec3], reach: impl Fn(u32) -> f64 + Sync) -> Vec<u32> {
    let mut places: Vec<u32> = (0..positions.len() as u32).collect();
    let position = |place: u32| positions[place as usize];
    sort_along_curve(&position, &mut places);
    let near = Tree::over(&position, &places, &reach).with_neighbours(&reach);
    near.into_iter().map(|number| places[number as usize]).collect()
}

/// The rule for joining groups.
pub(super) trait MayJoin {
    /// Whether the group at a place may join the one at another, which is this far away.
    fn may_join(&self, place: u32, other: u32, distance: f64) -> bool;

    /// The group at `place` is now part of the one at `other`.
    fn has_joined(&mut self, place: u32, other: u32);
}

/// Sorts runs that fall into one cell of the grid over `bounds` along curves of their own, so that neighbours in the
/// list are neighbours in space even if the box is much larger than most of its contents.
fn spread_crowds(position: &(impl Fn(u32) -> DVec3 + Sync), places: &mut [u32], bounds: &Bounds) {
    let grid = MortonGrid::over(bounds);
    let mut first = 0;
    while first + CROWD < places.len() {
        // Entries that share a cell with the entry CROWD places further on have a run of that length between them.
        if grid.code(position(places[first])) != grid.code(position(places[first + CROWD])) {
            first += CROWD;
            continue;
        }
        let code = grid.code(position(places[first]));
        let before = places[..first].partition_point(|&place| grid.code(position(place)) < code);
        let length = places[first..].partition_point(|&place| grid.code(position(place)) <= code);
        sort_along_curve(position, &mut places[before..first + length]);
        first += length;
    }
}

/// Sorts distinct positions along the curve over their own box.
fn sort_along_curve(position: &(impl Fn(u32) -> DVec3 + Sync), places: &mut [u32]) {
    let Some(bounds) = Bounds::around(places.iter().map(|&place| position(place))) else {
        return;
    };
    let grid = MortonGrid::over(&bounds);
    let code = |place: u32| grid.code(position(place));
    if code_range_is_one(&grid, &bounds) {
        // They are so close together that no number distinguishes their cells.
        return;
    }
    places.par_sort_by_cached_key(|&place| (code(place), place));
    spread_crowds(position, places, &bounds);
}

fn code_range_is_one(grid: &MortonGrid, bounds: &Bounds) -> bool {
    grid.code(bounds.min) == grid.code(bounds.max)
}

/// A tree of boxes around runs of places.
struct Tree<'a, P> {
    position: &'a P,
    places: &'a [u32],
    /// The boxes of runs of places, then those of runs of these, up to a single one.
    levels: Vec<Vec<Bounds>>,
    /// The largest reach of the places in each box: a position further away is not a neighbour of any, whatever its own
    /// reach.
    reaches: Vec<Vec<f64>>,
}

impl<'a, P: Fn(u32) -> DVec3 + Sync> Tree<'a, P> {
    fn over(position: &'a P, places: &'a [u32], reach: &(impl Fn(u32) -> f64 + Sync)) -> Self {
        let of_run = |run: &[u32]| Bounds::around(run.iter().map(|&place| position(place)));
        let mut levels: Vec<Vec<Bounds>> = vec![places.par_chunks(RUN).filter_map(of_run).collect()];
        while let Some(below) = levels.last().filter(|below| below.len() > 1) {
            let parents = below
                .par_chunks(RUN)
                .filter_map(|run| run.iter().copied().reduce(|a, b| a.union(&b)));
            let parents: Vec<Bounds> = parents.collect();
            levels.push(parents);
        }
        let furthest = |reaches: &[f64]| reaches.iter().copied().fold(0.0, f64::max);
        let of_run = |run: &[u32]| run.iter().map(|&place| reach(place)).fold(0.0, f64::max);
        let mut reaches: Vec<Vec<f64>> = vec![places.par_chunks(RUN).map(of_run).collect()];
        while reaches.len() < levels.len() {
            let below = &reaches[reaches.len() - 1];
            reaches.push(below.chunks(RUN).map(furthest).collect());
        }
        Self {
            position,
            places,
            levels,
            reaches,
        }
    }

    /// The places that have another within the reach of both, by their numbers, ascending.
    fn with_neighbours(&self, reach: &(impl Fn(u32) -> f64 + Sync)) -> Vec<u32> {
        let has_neighbour: Vec<AtomicBool> = self.places.iter().map(|_| AtomicBool::new(false)).collect();
        let groups = self.levels[0].len().div_ceil(RUN);
        (0..groups)
            .into_par_iter()
            .with_min_len(64)
            .for_each(|group| self.find_neighbours(group, reach, &has_neighbour));
        let flags = (0..).zip(has_neighbour);
        flags
            .filter_map(|(number, has)| has.into_inner().then_some(number))
            .collect()
    }

    /// Flags the places with neighbours of which one is in a group of runs and the other in no earlier run. The runs
    /// share one descent of the tree, on which a scan without neighbours would otherwise spend its time.
    fn find_neighbours(&self, group: usize, reach: &impl Fn(u32) -> f64, has_neighbour: &[AtomicBool]) {
        let level = 1.min(self.levels.len() - 1);
        let (own, furthest) = (&self.levels[level][group], self.reaches[level][group]);
        if furthest <= 0.0 {
            return;
        }
        let first = group * RUN;
        let mut near = Vec::new();
        self.runs_within(
            &own.grown(furthest),
            &|level, other| (other + 1) * RUN.pow(level as u32) > first && self.reaches_box(level, other, own),
            |run| near.push(run),
        );
        for number in first..(first + RUN).min(self.levels[0].len()) {
            let own = self.levels[0][number].grown(self.reaches[0][number]);
            let run = Run::of(self.run(number), self.position, reach);
            run.find_neighbours_within(self.flags(number, has_neighbour));
            for &other in near.iter().filter(|&&other| other > number) {
                let box_of_other = &self.levels[0][other];
                if own.meets(box_of_other) && self.reaches_box(0, other, &self.levels[0][number]) {
                    let has_neighbour = [number, other].map(|run| self.flags(run, has_neighbour));
                    run.find_neighbours(self.run(other), box_of_other, self.position, reach, has_neighbour);
                }
            }
        }
    }

    /// A run's part of flags for all places.
    fn flags<'f>(&self, run: usize, flags: &'f [AtomicBool]) -> &'f [AtomicBool] {
        &flags[run * RUN..((run + 1) * RUN).min(self.places.len())]
    }

    /// Returns true if a place in a box may be a neighbour of one in another.
    fn reaches_box(&self, level: usize, number: usize, other: &Bounds) -> bool {
        self.levels[level][number]
            .grown(self.reaches[level][number])
            .meets(other)
    }

    /// Calls `found` with the occupied places within `radius` of a point and their distances. All places whose own
    /// reach is that large are among them.
    fn visit(&self, occupied: &Occupied, centre: DVec3, radius: f64, mut found: impl FnMut(u32, f64)) {
        let point = Bounds {
            min: centre,
            max: centre,
        };
        let is_wanted = |level: usize, number: usize| {
            let far = self.levels[level][number].distance(centre);
            occupied.counts[level][number] > 0 && far <= self.reaches[level][number]
        };
        self.runs_within(&point.grown(radius), &is_wanted, |run| {
            for (number, &place) in (run * RUN..).zip(self.run(run)) {
                let distance = (self.position)(place).distance(centre);
                if distance <= radius && occupied.is_occupied[number] {
                    found(place, distance);
                }
            }
        });
    }

    fn run(&self, number: usize) -> &[u32] {
        &self.places[number * RUN..((number + 1) * RUN).min(self.places.len())]
    }

    /// Calls `found` with every run whose box meets `bounds`, leaving out boxes for which `is_wanted` is false, by
    /// level and number.
    fn runs_within(&self, bounds: &Bounds, is_wanted: &impl Fn(usize, usize) -> bool, mut found: impl FnMut(usize)) {
        self.descend(self.levels.len() - 1, 0, bounds, is_wanted, &mut found);
    }

    fn descend(
        &self,
        level: usize,
        first: usize,
        bounds: &Bounds,
        is_wanted: &impl Fn(usize, usize) -> bool,
        found: &mut impl FnMut(usize),
    ) {
        let boxes = &self.levels[level];
        for number in first..(first + RUN).min(boxes.len()) {
            if boxes[number].meets(bounds) && is_wanted(level, number) {
                match level.checked_sub(1) {
                    None => found(number),
                    Some(below) => self.descend(below, number * RUN, bounds, is_wanted, found),
                }
            }
        }
    }
}

/// A run's positions and their reaches.
struct Run {
    length: usize,
    positions: [DVec3; RUN],
    reaches: [f64; RUN],
}

impl Run {
    fn of(places: &[u32], position: &impl Fn(u32) -> DVec3, reach: &impl Fn(u32) -> f64) -> Self {
        let mut run = Self {
            length: places.len(),
            positions: [DVec3::ZERO; RUN],
            reaches: [0.0; RUN],
        };
        for (k, &place) in places.iter().enumerate() {
            run.positions[k] = position(place);
            run.reaches[k] = reach(place);
        }
        run
    }

    /// Flags the places that have a neighbour in the same run.
    fn find_neighbours_within(&self, has_neighbour: &[AtomicBool]) {
        for k in 0..self.length {
            for l in k + 1..self.length {
                let reach = self.reaches[k].min(self.reaches[l]);
                if are_within(self.positions[k], self.positions[l], reach) {
                    set_both([&has_neighbour[k], &has_neighbour[l]]);
                }
            }
        }
    }

    /// Flags the places that have a neighbour among the `others` of another run, which are in a box, and these
    /// neighbours.
    fn find_neighbours(
        &self,
        others: &[u32],
        box_of_others: &Bounds,
        position: &impl Fn(u32) -> DVec3,
        reach: &impl Fn(u32) -> f64,
        [has_neighbour, of_others]: [&[AtomicBool]; 2],
    ) {
        for k in 0..self.length {
            let (here, own_reach) = (self.positions[k], self.reaches[k]);
            if box_of_others.distance(here) > own_reach {
                continue;
            }
            for (&other, of_other) in others.iter().zip(of_others) {
                let both = [&has_neighbour[k], of_other];
                if !both.iter().all(|has| has.load(Relaxed))
                    && are_within(position(other), here, own_reach.min(reach(other)))
                {
                    set_both(both);
                }
            }
        }
    }
}

/// Sets two flags. Threads only ever set them, so their order does not matter.
fn set_both(flags: [&AtomicBool; 2]) {
    flags.iter().for_each(|flag| flag.store(true, Relaxed));
}

/// Returns true if two positions are at most `distance` apart. Nearly all pairs are further apart, by far more than the
/// square's rounding, so nearly none needs a square root.
fn are_within(a: DVec3, b: DVec3, distance: f64) -> bool {
    let squared = a.distance_squared(b);
    squared <= distance * distance * (1.0 + 1e-12) && squared.sqrt() <= distance
}

/// Some of a tree's places, and the number of them in each box.
struct Occupied {
    is_occupied: Vec<bool>,
    counts: Vec<Vec<u32>>,
}

impl Occupied {
    fn none<P>(tree: &Tree<'_, P>) -> Self {
        Self {
            is_occupied: vec![false; tree.places.len()],
            counts: tree.levels.iter().map(|level| vec![0; level.len()]).collect(),
        }
    }

    /// Adds the place of this number.
    fn add(&mut self, number: usize) {
        self.is_occupied[number] = true;
        let mut number = number;
        for counts in &mut self.counts {
            number /= RUN;
            counts[number] += 1;
        }
    }
}
