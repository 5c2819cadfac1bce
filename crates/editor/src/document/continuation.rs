//! Paint and painted fields in the new triangles of a part that was filled, cut or joined.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use pliant_mesh::{Model, SurfaceVertex};

use super::content::Paint;
use super::fluid::Dye;
use super::matching::Matching;

/// A way to a new vertex: the bits of its length, the vertex, and the one before it.
type Way = Reverse<(u64, SurfaceVertex, SurfaceVertex)>;

/// A shorter edge has the weight of one of this length, in world units.
const SHORTEST: f64 = 1e-150;

/// The vertices of a new mesh without a counterpart in the former one that edges join to vertices with one: its *rims*.
/// Vertices of a part that is new as a whole are not among them.
pub(super) struct Continuation<'a> {
    model: &'a Model,
    /// The new vertices, by their distance from the nearest rim along edges; of equal ones the lower number is first.
    reached: Vec<Reached>,
    /// The place of each vertex in `reached`; of a rim's and of others `None`.
    place: Vec<Option<u32>>,
    /// Whether a vertex has a counterpart.
    is_old: Vec<bool>,
}

/// A new vertex, and the vertex before it on the shortest way from a rim.
struct Reached {
    vertex: SurfaceVertex,
    from: SurfaceVertex,
}

impl<'a> Continuation<'a> {
    pub(super) fn of(matching: &Matching, model: &'a Model) -> Self {
        let is_old: Vec<bool> = matching.of_new.iter().map(Option::is_some).collect();
        let mut own = Self {
            model,
            reached: Vec::new(),
            place: vec![None; is_old.len()],
            is_old,
        };
        own.reach();
        own
    }

    /// Dijkstra's walk from the rims.
    fn reach(&mut self) {
        let mut next: BinaryHeap<Way> = BinaryHeap::new();
        for (vertex, is_old) in (0..).zip(&self.is_old) {
            if *is_old {
                self.offer(SurfaceVertex(vertex), 0.0, &mut next);
            }
        }
        // Distances are not negative, so that their bits have their order.
        while let Some(Reverse((bits, vertex, from))) = next.pop() {
            let place = &mut self.place[vertex.index()];
            if place.is_none() {
                *place = Some(self.reached.len() as u32);
                self.reached.push(Reached { vertex, from });
                self.offer(vertex, f64::from_bits(bits), &mut next);
            }
        }
    }

    /// Offers a way on from a vertex to each new neighbour.
    fn offer(&self, from: SurfaceVertex, distance: f64, next: &mut BinaryHeap<Way>) {
        for &vertex in self.model.topology.neighbours(from) {
            if !self.is_old[vertex.index()] && self.place[vertex.index()].is_none() {
                let distance = distance + self.length(from, vertex);
                next.push(Reverse((distance.to_bits(), vertex, from)));
            }
        }
    }

    fn length(&self, a: SurfaceVertex, b: SurfaceVertex) -> f64 {
        let positions = &self.model.surface.positions;
        positions[a.index()].distance(positions[b.index()])
    }

    /// Continues paint: a vertex beside a rim gets the paint of the nearest vertex there, so that a cut handle keeps its
    /// border. Farther ones get the paint that the whole rim of their patch has, and none where it has several: a tube
    /// between a handle and a fixed region bends.
    pub(super) fn paint(&self, paint: &mut [Paint]) {
        let patches = self.patches();
        let mut of_rim: Vec<Option<Paint>> = vec![None; self.reached.len()];
        let mut is_mixed = vec![false; self.reached.len()];
        for (number, reached) in self.reached.iter().enumerate() {
            let patch = patches[number] as usize;
            let neighbours = self.model.topology.neighbours(reached.vertex).iter();
            for rim in neighbours.filter(|vertex| self.is_old[vertex.index()]) {
                let own = paint[rim.index()];
                is_mixed[patch] |= *of_rim[patch].get_or_insert(own) != own;
            }
        }
        for (number, Reached { vertex, from }) in self.reached.iter().enumerate() {
            let patch = patches[number] as usize;
            paint[vertex.index()] = match is_mixed[patch] && !self.is_old[from.index()] {
                true => Paint::Bare,
                false => paint[from.index()],
            };
        }
    }

    /// For each reached vertex the number of its patch: the connected new vertices around it.
    fn patches(&self) -> Vec<u32> {
        let mut patches = vec![u32::MAX; self.reached.len()];
        let mut left = Vec::new();
        for first in 0..self.reached.len() {
            if patches[first] != u32::MAX {
                continue;
            }
            patches[first] = first as u32;
            left.push(first);
            while let Some(number) = left.pop() {
                for vertex in self.model.topology.neighbours(self.reached[number].vertex) {
                    if let Some(place) = self.place[vertex.index()]
                        && patches[place as usize] == u32::MAX
                    {
                        patches[place as usize] = first as u32;
                        left.push(place as usize);
                    }
                }
            }
        }
        patches
    }

    /// Continues numbers: a vertex gets the mean of its neighbours that are nearer to the rim, the closer ones with more
    /// weight. If one of them is infinite (a rigid part), it gets that of the nearest.
    pub(super) fn numbers(&self, field: &mut [f64]) {
        self.field(field, |values| {
            let nearest = values[0].0;
            let are_finite = values.iter().all(|(value, _)| value.is_finite());
            let differences = values.iter().map(|(value, weight)| (value - nearest, *weight));
            if are_finite {
                nearest + mean(differences)
            } else {
                nearest
            }
        });
    }

    /// Continues dye in the same way.
    pub(super) fn dye(&self, field: &mut [Dye]) {
        self.field(field, |values| {
            let mut own = values[0].0;
            for (channel, own) in own.iter_mut().enumerate() {
                let nearest = *own;
                let difference = |(value, weight): &(Dye, f64)| (f64::from(value[channel] - nearest), *weight);
                *own += mean(values.iter().map(difference)) as f32;
            }
            own
        });
    }

    /// Gives each new vertex a value made of those of its neighbours that have one, which come with their weights, the
    /// nearest first.
    fn field<T: Copy>(&self, field: &mut [T], mixed: impl Fn(&[(T, f64)]) -> T) {
        let mut near: Vec<(T, f64)> = Vec::new();
        for (number, Reached { vertex, from }) in (0..).zip(&self.reached) {
            let is_known = |other: &SurfaceVertex| {
                let place = self.place[other.index()];
                self.is_old[other.index()] || place.is_some_and(|place| place < number)
            };
            let weighted = |other: SurfaceVertex| {
                let length = self.length(*vertex, other);
                (field[other.index()], 1.0 / length.max(SHORTEST))
            };
            near.clear();
            near.push(weighted(*from));
            let others = self.model.topology.neighbours(*vertex).iter().copied();
            near.extend(others.filter(|other| other != from && is_known(other)).map(weighted));
            field[vertex.index()] = mixed(&near);
        }
    }
}

/// The mean of weighted numbers.
fn mean(values: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (sum, weights) = values.fold((0.0, 0.0), |(sum, weights), (value, weight)| {
        (sum + value * weight, weights + weight)
    });
    sum / weights
}

#[cfg(test)]
mod tests;
